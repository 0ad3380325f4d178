import numpy as np
import pytest
import rhino3dm

from semispline.solver.io.rhino import open_3dm
from semispline.solver.io.surface_files import list_surfaces, read_surface


def save(path, *geometries, unit=rhino3dm.UnitSystem.Millimeters):
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = unit
    for geometry in geometries:
        if isinstance(geometry, rhino3dm.Brep):
            file.Objects.AddBrep(geometry)
        elif isinstance(geometry, rhino3dm.Surface):
            file.Objects.AddSurface(geometry)
        else:
            file.Objects.AddPoint(geometry)
    assert file.Write(str(path), 0)


def spline(knots_u, knots_v, rational, degrees=(3, 2), shift=0.0):
    rng = np.random.default_rng(3)
    p, q = degrees
    n_u, n_v = len(knots_u) - p + 1, len(knots_v) - q + 1
    surface = rhino3dm.NurbsSurface.Create(3, rational, p + 1, q + 1, n_u, n_v)
    for target, knots in ((surface.KnotsU, knots_u), (surface.KnotsV, knots_v)):
        for i, knot in enumerate(knots):
            target[i] = float(knot)
    for i in range(n_u):
        for j in range(n_v):
            w = float(rng.uniform(0.5, 2)) if rational else 1.0
            x, y, z = (float(c) for c in rng.normal(size=3) + shift)
            surface.Points[(i, j)] = rhino3dm.Point4d(x * w, y * w, z * w, w)
    return surface


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize(
    "knots_u",
    [[0, 0, 0, 1, 2, 2, 2], [-2, -1, 0, 1, 2, 3, 4], [0, 0, 0, 0.5, 1.5, 2, 2.5], [-1, 0, 0, 0.5, 2, 2, 2]],
    ids=["clamped", "uniform", "clamped at the start", "half clamped"],
)
def test_any_knots_are_read_as_the_same_surface(tmp_path, knots_u, rational):
    source = spline(knots_u, [0, 0, 1, 1, 3, 3], rational)
    save(tmp_path / "s.3dm", source)
    found = read_surface(tmp_path / "s.3dm")
    assert (found.weights is not None) == rational
    (u0, u1), (v0, v1) = found.domain
    assert (u0, u1) == (source.Domain(0).T0, source.Domain(0).T1)
    u, v = np.meshgrid(np.linspace(u0, u1, 9), np.linspace(v0, v1, 7), indexing="ij")
    values = [source.PointAt(float(a), float(b)) for a, b in zip(u.ravel(), v.ravel(), strict=True)]
    expected = np.array([(p.X, p.Y, p.Z) for p in values])
    np.testing.assert_allclose(found.evaluate(u.ravel(), v.ravel()), expected, rtol=0, atol=1e-13)


def test_end_knots_that_differ_by_rounding_are_snapped(tmp_path):
    source = spline([0, 1e-16, 1e-15, 1, 2, 2 + 4e-16, 2], [0, 0, 1, 1], False)
    save(tmp_path / "s.3dm", source)
    found = read_surface(tmp_path / "s.3dm")
    assert found.knots_u.tolist() == [1e-15] * 4 + [1.0] + [2.0] * 4
    assert found.control_points.shape == (5, 3, 3)


def test_equal_weights_are_polynomial(tmp_path):
    source = spline([0, 0, 0, 1, 1, 1], [0, 0, 1, 1], False)
    source.MakeRational()
    for i in range(4):
        for j in range(3):
            p = source.Points[(i, j)]
            source.Points[(i, j)] = rhino3dm.Point4d(3 * p.X, 3 * p.Y, 3 * p.Z, 3.0)
    save(tmp_path / "s.3dm", source)
    assert source.IsRational
    assert read_surface(tmp_path / "s.3dm").weights is None


@pytest.mark.long
def test_surfaces_of_breps_are_numbered_in_file_order_and_other_objects_do_not_count(tmp_path):
    first = spline([0, 0, 0, 1, 1, 1], [0, 0, 1, 1], False)
    last = spline([0, 0, 0, 1, 1, 1], [0, 0, 1, 1], True, shift=10.0)
    box = rhino3dm.Brep.CreateFromBoundingBox(
        rhino3dm.BoundingBox(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 2, 3))
    )
    save(tmp_path / "s.3dm", rhino3dm.Point3d(0, 0, 0), first, box, last, unit=rhino3dm.UnitSystem.Inches)
    model = open_3dm(tmp_path / "s.3dm")
    entries = list_surfaces(tmp_path / "s.3dm")
    assert model.unit == "in"
    assert [e.number for e in entries] == list(range(8))
    assert [(e.degree_u, e.degree_v) for e in entries] == [(3, 2)] + [(1, 1)] * 6 + [(3, 2)]
    assert [e.rational for e in entries] == [False] * 7 + [True]
    assert [e.trimmed for e in entries] == [False] * 8
    assert read_surface(f"{tmp_path / 's.3dm'}#7").control_points.mean() > 5


def test_a_trimmed_plane_is_trimmed(tmp_path):
    plane = rhino3dm.PlaneSurface(rhino3dm.Plane.WorldXY(), rhino3dm.Interval(0, 4), rhino3dm.Interval(0, 4))
    circle = rhino3dm.Circle(rhino3dm.Point3d(2, 2, 0), 1.0).ToNurbsCurve()
    cut = rhino3dm.Brep.CreateTrimmedPlane(rhino3dm.Plane.WorldXY(), circle)
    save(tmp_path / "s.3dm", plane, cut)
    entries = list_surfaces(tmp_path / "s.3dm")
    assert [e.trimmed for e in entries] == [False, True]


@pytest.mark.long
def test_closed_surfaces_are_marked(tmp_path):
    cylinder = rhino3dm.NurbsSurface.CreateFromCylinder(rhino3dm.Cylinder(rhino3dm.Circle(2.0), 3.0))
    save(tmp_path / "s.3dm", cylinder)
    (entry,) = list_surfaces(tmp_path / "s.3dm")
    assert sorted((entry.closed_u, entry.closed_v)) == [False, True]
    found = read_surface(tmp_path / "s.3dm")
    (u0, u1), (v0, v1) = found.domain
    points = found.evaluate_grid(np.linspace(u0, u1, 9), np.linspace(v0, v1, 9))
    np.testing.assert_allclose(np.hypot(points[..., 0], points[..., 1]), 2.0, rtol=1e-15)


@pytest.mark.long
def test_surfaces_of_breps_are_called_by_their_shape(tmp_path):
    axis = rhino3dm.Circle(rhino3dm.Point3d(1, 2, 3), 2.0)
    box = rhino3dm.BoundingBox(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 2, 3))
    breps = {
        "cylinder": rhino3dm.Cylinder(axis, 3.0).ToBrep(False, False),
        "sphere": rhino3dm.Sphere(rhino3dm.Point3d(1, 2, 3), 2.0).ToBrep(),
        "plane": rhino3dm.Brep.CreateFromBoundingBox(box),
        "surface": rhino3dm.Brep.CreateFromSurface(spline([0, 0, 0, 1, 1, 1], [0, 0, 1, 1], True)),
    }
    for kind, brep in breps.items():
        save(tmp_path / "s.3dm", brep)
        assert {entry.kind for entry in list_surfaces(tmp_path / "s.3dm")} == {kind}
