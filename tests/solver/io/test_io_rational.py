"""Rational surfaces, tensor-product and semi-structured, in every format."""

import json
import math
import re

import numpy as np
import pytest
import rhino3dm
from OCP.BRep import BRep_Tool
from typer.testing import CliRunner

from helpers.cases import CASES
from semispline import (
    BSplineCurve,
    BSplineSurface,
    ControlPointError,
    FileError,
    InputError,
    SemiStructuredSurface,
    list_surfaces,
    read_surface,
    write_surface,
)
from semispline.solver.c_export import write_c
from semispline.solver.cli import app
from semispline.solver.io.json_files import StoredProblem, surface_from_record, surface_record, write_problem
from semispline.solver.io.occ import read_occ
from semispline.solver.io.occ_writing import occ_bytes

EDGES = ("--edge-a", "u0", "--edge-b", "u0")
EXACT = (".step", ".igs", ".brep", ".3dm")
# What reading and writing back may move, in fractions of the size: 3dm holds points times weights.
MOVED = {".step": 1e-12, ".igs": 1e-9, ".brep": 0.0, ".3dm": 4e-16}


def free_form(scale=1.0, spread=0.6):
    rng = np.random.default_rng(21)
    knots_u, knots_v = [0, 0, 0, 1 / 3, 1 / 3, 0.5, 1, 1, 1], [-2, -2, -2, -2, 0.1, 0.7, 2, 2, 2, 2]
    weights = np.exp(rng.uniform(-spread, spread, (6, 6)))
    return BSplineSurface(2, 3, knots_u, knots_v, scale * rng.normal(size=(6, 6, 3)), weights)


def lofted_circles(columns, knots, degree, scale=1.0):
    """Return circles of radii 2, 3, 1 at heights 0, 1, 2 lofted; columns x, y, w are those of the unit circle."""
    x, y, w = np.array(columns, dtype=float).T
    net = [np.stack([r * x / w, r * y / w, z + 0 * x], axis=1) for r, z in ((2, 0), (3, 1), (1, 2))]
    return BSplineSurface(2, degree, [0, 0, 0, 1, 1, 1], knots, scale * np.array(net), np.tile(w, (3, 1)))


def nine_points(scale=1.0):
    c = math.sqrt(0.5)
    corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    columns = [(x * w, y * w, w) for (x, y), w in zip(corners, [1, c] * 4 + [1], strict=True)]
    return lofted_circles(columns, [0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1], 2, scale)


def eleven_points(scale=1.0):
    """The circle of degree 6 that is C2 at its seam too."""
    half = [(1, 0.5, 1), (0.65, 1, 0.95), (0, 1.225, 0.9), (-0.65, 1, 0.95)]
    lower = [(x, -y, w) for x, y, w in reversed(half)]
    columns = [(1, 0, 1), *half, (-1.35, 0, 1.05), *lower, (1, 0, 1)]
    return lofted_circles(columns, [0] * 7 + [0.5] * 4 + [1] * 7, 6, scale)


def rational_rows():
    """Rows of different degrees and knots, the first and the third with weights of their own."""
    rng = np.random.default_rng(22)
    knots = ([0, 0, 1, 1], [0, 0, 0, 0, 0.3, 1, 1, 1, 1], [0, 0, 0, 0.3, 0.6, 1, 1, 1])
    curves = []
    for q, k, rational in zip((1, 3, 2), knots, (True, False, True), strict=True):
        n = len(k) - q - 1
        weights = rng.uniform(0.5, 2, n) if rational else None
        curves.append(BSplineCurve(q, k, rng.normal(size=(n, 3)), weights))
    return SemiStructuredSurface(2, [0, 0, 0, 1, 1, 1], tuple(curves))


def read_here(path):
    """In this process: what we wrote ourselves breaks nothing."""
    return read_surface(path) if path.suffix in (".3dm", ".json") else read_occ(path).faces[0].surface()


def assert_near(found, expected, moved):
    assert (found.degree_u, found.degree_v) == (expected.degree_u, expected.degree_v)
    np.testing.assert_array_equal(found.knots_u, expected.knots_u)
    np.testing.assert_allclose(found.knots_v, expected.knots_v, rtol=0, atol=moved)
    size = np.ptp(expected.control_points.reshape(-1, 3), axis=0).max()
    np.testing.assert_allclose(found.control_points, expected.control_points, rtol=0, atol=moved * size)
    np.testing.assert_allclose(found.weights, expected.weights, rtol=moved, atol=0)


@pytest.mark.parametrize("suffix", EXACT)
@pytest.mark.parametrize("scale", [1.0, 1e-4, 1e6])
@pytest.mark.parametrize("make", [free_form, nine_points, eleven_points])
def test_net_and_weights_come_back(tmp_path, make, scale, suffix):
    path, surface = tmp_path / f"s{suffix}", make(scale=scale)
    write_surface(path, surface)
    assert_near(read_here(path), surface, MOVED[suffix])


@pytest.mark.parametrize("suffix", [".step", ".igs"])
def test_closed_surfaces_come_back_periodic_and_are_clamped(tmp_path, suffix):
    path = tmp_path / f"s{suffix}"
    write_surface(path, eleven_points())
    geometry = BRep_Tool.Surface_s(read_occ(path).faces[0].face)
    assert (geometry.IsVPeriodic(), geometry.NbVPoles()) == (True, 10)
    assert read_here(path).control_points.shape == (3, 11, 3)


def test_3dm_has_points_times_weights_bit_for_bit(tmp_path):
    surface = free_form()
    write_surface(tmp_path / "s.3dm", surface)
    net = rhino3dm.File3dm.Read(str(tmp_path / "s.3dm")).Objects[0].Geometry
    found = [[(p.X, p.Y, p.Z, p.W) for p in (net.Points[i, j] for j in range(6))] for i in range(6)]
    weights = surface.weights[..., None]
    np.testing.assert_array_equal(found, np.concatenate([surface.control_points * weights, weights], axis=2))
    points = [net.PointAt(u, v) for u, v in ((0.2, -1.0), (0.4, 0.3), (0.9, 1.5))]
    expected = surface.evaluate([0.2, 0.4, 0.9], [-1.0, 0.3, 1.5])
    np.testing.assert_allclose([(p.X, p.Y, p.Z) for p in points], expected, rtol=0, atol=1e-14)


@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize("suffix", EXACT)
def test_rational_rows_are_written_as_the_same_surface(tmp_path, suffix):
    path, surface = tmp_path / f"s{suffix}", rational_rows()
    write_surface(path, surface)
    assert_near(read_here(path), surface.to_bspline(), MOVED[suffix])
    u, v = np.linspace(0, 1, 7), np.linspace(0, 1, 9)
    np.testing.assert_allclose(read_here(path).evaluate_grid(u, v), surface.evaluate_grid(u, v), rtol=0, atol=1e-13)


@pytest.mark.parametrize("make", [free_form, eleven_points, rational_rows])
def test_json_keeps_every_bit(tmp_path, make):
    surface = make()
    write_surface(tmp_path / "s.json", surface)
    assert surface_record(read_surface(tmp_path / "s.json")) == surface_record(surface)
    record = json.loads((tmp_path / "s.json").read_text())
    if make is rational_rows:
        found = [curve.get("weights") for curve in record["control_curves"]]
        assert found == [None if c.weights is None else c.weights.tolist() for c in surface.control_curves]
        assert found[1] is None


@pytest.mark.parametrize(
    ("weights", "words"),
    [
        ([1, 0], "control_curves[0].weights[1]: found 0.0, expected a positive number"),
        ([1, -2], "control_curves[0].weights[1]: found -2.0"),
        ([1, 2, 3], "control_curves[0].weights: shape (3,), expected (2,)"),
        ([1, "x"], "control_curves[0].weights[1]: found 'x', expected a valid number"),
        ([1, math.nan], "control_curves[0].weights[1]"),
        (2.0, "control_curves[0].weights: found 2.0, expected a valid list"),
    ],
)
def test_wrong_weights_name_the_curve_and_the_index(weights, words):
    record = surface_record(rational_rows())
    record["control_curves"][0]["weights"] = weights
    with pytest.raises((ControlPointError, FileError), match=rf"^s.json: {re.escape(words)}"):
        surface_from_record(record, "s.json")


def test_the_list_says_rational_and_closed(tmp_path):
    write_surface(tmp_path / "rows.json", rational_rows())
    write_surface(tmp_path / "tube.json", nine_points().to_semistructured())
    told = CliRunner().invoke(app, ["list", str(tmp_path / "tube.json")]).stdout.splitlines()
    assert re.split(r"  +", told[1]) == ["0", "semi-structured", "2, 2", "3 x 9", "rational", "-", "v"]
    (entry,) = list_surfaces(tmp_path / "rows.json")
    assert (entry.rational, entry.n_u, entry.n_v, entry.closed_u, entry.closed_v) == (True, 3, None, False, False)


def test_equal_points_of_other_weights_are_not_closed(tmp_path):
    surface = nine_points()
    weights = np.array(surface.weights)
    weights[1, -1] *= 2
    open_tube = BSplineSurface(2, 2, surface.knots_u, surface.knots_v, surface.control_points, weights)
    write_surface(tmp_path / "s.json", open_tube)
    assert list_surfaces(tmp_path / "s.json")[0].closed_v is False
    # Weights in one proportion are one curve.
    weights[:, -1] = 3 * surface.weights[:, 0]
    write_surface(
        tmp_path / "s.json", BSplineSurface(2, 2, surface.knots_u, surface.knots_v, surface.control_points, weights)
    )
    assert list_surfaces(tmp_path / "s.json")[0].closed_v is True


def of_degree(degree):
    rng = np.random.default_rng(degree)
    knots = [0] * (degree + 1) + [1] * (degree + 1)
    return BSplineSurface(1, degree, [0, 0, 1, 1], knots, rng.normal(size=(2, degree + 1, 3)))


@pytest.mark.parametrize("suffix", [".step", ".igs", ".brep"])
def test_degrees_beyond_the_kernel_are_refused_before_it_is_asked(tmp_path, suffix):
    path = tmp_path / f"s{suffix}"
    words = rf"^{suffix}: the surface has degree 26 in v, and Open CASCADE takes at most 25; write .json or .3dm"
    with pytest.raises(FileError, match=words):
        write_surface(path, of_degree(26))
    assert not path.exists()
    write_surface(path, of_degree(25))
    assert_near_points(read_here(path), of_degree(25))


def assert_near_points(found, expected):
    np.testing.assert_allclose(found.control_points, expected.control_points, rtol=0, atol=1e-15)


@pytest.mark.parametrize("suffix", [".json", ".3dm"])
def test_other_formats_take_high_degrees(tmp_path, suffix):
    write_surface(tmp_path / f"s{suffix}", of_degree(27))
    assert_near_points(read_here(tmp_path / f"s{suffix}"), of_degree(27))


@pytest.mark.parametrize("suffix", [".obj", ".glb"])
def test_meshes_of_rational_rows_lie_on_the_surface(tmp_path, suffix):
    pyvista = pytest.importorskip("pyvista")
    tube = eleven_points().to_semistructured()
    write_surface(tmp_path / f"s{suffix}", tube)
    mesh = pyvista.read(tmp_path / f"s{suffix}")
    while isinstance(mesh, pyvista.MultiBlock):
        mesh = mesh[0]
    # Between heights 0 and 2 the radius is 2 (1 - t)^2 + 6 t (1 - t) + t^2 at height 2 t.
    t = mesh.points[:, 2] / 2
    radius = 2 * (1 - t) ** 2 + 6 * t * (1 - t) + t**2
    np.testing.assert_allclose(np.hypot(mesh.points[:, 0], mesh.points[:, 1]), radius, rtol=2e-6)


@pytest.mark.long
@pytest.mark.usefixtures("read_here")
def test_pictures_conversion_and_measuring_take_rational_rows(tmp_path):
    source = tmp_path / "tube.json"
    write_surface(source, nine_points().to_semistructured())
    runner = CliRunner()
    for command in (
        ["show", str(source), "-o", str(tmp_path / "t.png"), "--control-points"],
        ["convert", str(source), str(tmp_path / "t.step")],
        ["check", *map(str, (source, tmp_path / "t.step")), *EDGES, "--require", "C0"],
    ):
        told = runner.invoke(app, command)
        assert told.exit_code == 0, told.output


def test_generated_c_refuses_a_rational_base(tmp_path):
    write_problem(tmp_path / "p.json", StoredProblem(of_degree(2), "v1", nine_points(), "u0"))
    with pytest.raises(InputError, match=r"^b: rational, and generated C minimises the energy \(11\)"):
        write_c(tmp_path / "out", tmp_path / "p.json")
    assert not (tmp_path / "out").exists()


def test_bytes_of_a_rational_surface_say_so():
    assert b"RATIONAL_B_SPLINE_SURFACE" in occ_bytes([nine_points()], ".step", "mm")


@pytest.mark.parametrize(
    ("name", "v", "radius", "closed"),
    [("pipe_rational", 1, 5.0, True), ("dome_rational", 0, 5.0, True), ("duct_ring_rational", 0, 6.0, False)],
)
def test_rational_cases_are_read(name, v, radius, closed):
    (entry,) = list_surfaces(CASES / f"{name}.json")
    assert (entry.rational, entry.closed_u, entry.closed_v, entry.problem) == (True, closed, False, None)
    surface = read_surface(CASES / f"{name}.json")
    rim = surface.evaluate(np.linspace(*surface.domain[0], 41), surface.domain[1][v])
    np.testing.assert_allclose(np.hypot(rim[:, 0], rim[:, 1]), radius, rtol=1e-15)


@pytest.mark.parametrize("path", sorted(CASES.glob("*.json")), ids=lambda path: path.stem)
def test_every_case_in_json_is_read_and_written_back(tmp_path, path):
    surface = read_surface(path)
    write_surface(tmp_path / "s.json", surface)
    assert surface_record(read_surface(tmp_path / "s.json")) == surface_record(surface)
