"""Closest points: never farther than a fine grid or Open CASCADE, with all ties, to the last digits."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeVertex
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.gp import gp_Pnt

from helpers.closed import circle, cylinder, sphere, torus
from helpers.occ import to_geom
from helpers.splines import bspline_surfaces, curves, semistructured_surfaces
from helpers.sweeps import first_ones
from semispline import BSplineCurve, BSplineSurface, SemiStructuredSurface, closest_point, revolve, swap_directions
from semispline.solver.errors import ControlPointError, InputError
from semispline.solver.judge.de_boor import curve_points, surface_points
from semispline.solver.splines.closest import _bounds

points = st.tuples(*[st.floats(-2, 2)] * 3)


def grid_of(surface, n=161):
    (u0, u1), (v0, v1) = surface.domain
    u, v = np.linspace(u0, u1, n), np.linspace(v0, v1, n)
    return surface_points(surface, np.repeat(u, n), np.tile(v, n))


def wavy(seed, rational, shape=(6, 7)):
    """A sheet that doubles back on itself here and there."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(*(np.linspace(0, 1, n) for n in shape), indexing="ij")
    net = np.dstack([x, y, 0 * x]) + rng.uniform(-0.25, 0.25, (*shape, 3))
    knots = [np.concatenate([[0] * 4, np.sort(rng.uniform(0, 1, n - 4)), [1] * 4]) for n in shape]
    return BSplineSurface(3, 3, *knots, net, rng.uniform(0.4, 2.5, shape) if rational else None)


@pytest.mark.parametrize("seed", first_ones(1, range(6)))
def test_no_point_of_a_grid_is_nearer(seed):
    surface = wavy(seed, seed % 2)
    grid = grid_of(surface)
    for target in np.random.default_rng(seed).uniform([-0.5, -0.5, -1], [1.5, 1.5, 1], (25, 3)):
        found = closest_point(surface, target)
        assert found.distance <= np.linalg.norm(grid - target, axis=1).min() + 1e-15
        at = surface_points(surface, *found.parameters.T)
        assert np.abs(at - found.points).max() <= 1e-14
        assert np.abs(np.linalg.norm(at - target, axis=1) - found.distance).max() <= 1e-9


@pytest.mark.long
@settings(max_examples=25)
@given(bspline_surfaces(most=2), points)
def test_no_point_of_a_grid_is_nearer_whatever_the_knots(surface, target):
    assert (
        closest_point(surface, target).distance <= np.linalg.norm(grid_of(surface, 41) - target, axis=1).min() + 1e-15
    )


@pytest.mark.long
@settings(max_examples=15)
@given(semistructured_surfaces(degrees=(1, 3)), points)
def test_semistructured_surfaces_too(surface, target):
    assert (
        closest_point(surface, target).distance <= np.linalg.norm(grid_of(surface, 41) - target, axis=1).min() + 1e-13
    )


@pytest.mark.long
@settings(max_examples=25)
@given(curves(), points, st.booleans(), st.integers(0, 2**32 - 1))
def test_no_sample_of_a_curve_is_nearer(curve, target, rational, seed):
    weights = np.random.default_rng(seed).uniform(0.4, 2.5, len(curve.control_points)) if rational else None
    curve = BSplineCurve(curve.degree, curve.knots, curve.control_points, weights)
    net = (
        curve.control_points if weights is None else np.column_stack([curve.control_points * weights[:, None], weights])
    )
    values = curve_points(curve.degree, curve.knots, net, np.linspace(0, 1, 2001))
    samples = values if weights is None else values[:, :3] / values[:, 3:]
    found = closest_point(curve, target)
    assert found.distance <= np.linalg.norm(samples - target, axis=1).min() + 1e-14
    assert found.parameters.ndim == 1
    assert np.abs(curve.evaluate(found.parameters) - found.points).max() <= 1e-12


@pytest.mark.parametrize("seed", range(3))
def test_open_cascade_finds_no_other_distance(seed):
    surface = wavy(seed + 10, seed % 2)
    face = BRepBuilderAPI_MakeFace(to_geom(surface), 1e-9).Face()
    for target in np.random.default_rng(seed).uniform([-0.5, -0.5, -1], [1.5, 1.5, 1], (20, 3)):
        theirs = BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(gp_Pnt(*target.tolist())).Vertex(), face)
        assert theirs.IsDone()
        # Where theirs is the larger one it has missed the nearest place.
        assert closest_point(surface, target).distance <= theirs.Value() + 1e-9


@pytest.mark.long
@settings(max_examples=30)
@given(points)
def test_distances_to_a_sphere_a_torus_and_a_circle_are_known(target):
    x, y, z = target
    around = np.hypot(x, y)
    assert abs(closest_point(sphere(1.5), target).distance - abs(np.hypot(around, z) - 1.5)) <= 1e-14
    assert abs(closest_point(torus(3.0, 0.5), target).distance - abs(np.hypot(around - 3, z) - 0.5)) <= 1e-14
    assert abs(closest_point(circle(), target).distance - np.hypot(around - 1, z)) <= 1e-14


@settings(max_examples=20)
@given(st.floats(0, 2 * np.pi), st.floats(0.3, 4), st.floats(0, 1))
def test_the_foot_on_a_cylinder_is_exact_to_the_last_digits(angle, radius, height):
    found = closest_point(cylinder(1.0, 1.0), [radius * np.cos(angle), radius * np.sin(angle), height])
    # Coordinates of the target round by 1e-16 of the radius, and so does the foot.
    allowed = 16 * np.finfo(float).eps * max(1.0, radius)
    assert np.abs(found.points - [np.cos(angle), np.sin(angle), height]).max() <= allowed


def test_ties_and_both_parameters_of_a_seam_are_returned():
    seam = closest_point(cylinder(2.0, 5.0), [3, 0, 1])
    assert np.array_equal(seam.parameters.round(14), [[0, 0.2], [1, 0.2]])
    # Between two parallel walls.
    channel = BSplineSurface(
        1,
        1,
        [0, 0, 1, 2, 3, 3],
        [0, 0, 1, 1],
        [[[x, y, z] for y in (0, 1)] for x, z in ((0, 3), (0, 0), (2, 0), (2, 3))],
    )
    walls = closest_point(channel, [1, 0.5, 2])
    assert (walls.distance, walls.points.tolist()) == (1.0, [[0, 0.5, 2], [2, 0.5, 2]])
    assert np.abs(walls.parameters - [[1 / 3, 0.5], [2 + 2 / 3, 0.5]]).max() <= 1e-15
    # In the middle of a sphere every point is as near.
    middle = closest_point(sphere(2.0), [0, 0, 0])
    assert len(middle.points) > 4
    assert abs(middle.distance - 2) <= 1e-15


def test_a_nearest_point_at_a_crease_an_end_and_a_corner():
    corner = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[0, 0], [1, 1], [2, 0]])
    ridge = closest_point(corner, [1, 3])
    assert (ridge.distance, ridge.parameters.tolist()) == (2.0, [0.5])
    assert closest_point(corner, [-1, -1]).parameters.tolist() == [0.0]
    square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0], [0, 1]], [[1, 0], [1, 1]]])
    assert closest_point(square, [4, 5]).parameters.tolist() == [[1.0, 1.0]]
    # At a pole the derivative along u is zero.
    assert closest_point(sphere(1.0), [0, 0, 3]).points.tolist()[0] == [0, 0, 1]


def test_the_nearest_of_many_waves_is_found():
    x = np.linspace(0, 10, 400)
    depth = np.where(np.arange(400) % 2, 1.0, -1.0)
    depth[251], depth[399] = 1.01, -1.0
    curve = BSplineCurve(2, np.concatenate([[0, 0], np.linspace(0, 1, 399), [1, 1]]), np.column_stack([x, depth]))
    found = closest_point(curve, [5, 1e6])
    assert abs(found.points[0, 0] - x[251]) <= 1e-3


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), points, st.booleans())
def test_the_bound_of_a_part_is_one_and_is_near(seed, target, rational):
    rng = np.random.default_rng(seed)
    net = rng.uniform(-1, 1, (4, 3, 3))
    patch = BSplineSurface(
        3, 2, [0] * 4 + [1] * 4, [0] * 3 + [1] * 3, net, rng.uniform(0.5, 2, (4, 3)) if rational else None
    )
    bound, corner = _bounds(patch.homogeneous[None], np.array(target))
    distances = np.linalg.norm(grid_of(patch, 21) - target, axis=1)
    assert bound[0] <= distances.min()
    assert distances.min() <= corner[0].min()
    assert corner[0].max() <= distances.max()
    far = np.array([1e3, 0, 0])
    assert _bounds(patch.homogeneous[None], far)[0][0] >= 1e3 - 1.01


def test_units_and_place_do_not_matter():
    surface, target = wavy(3, True), np.array([0.3, 0.4, 0.9])
    found = closest_point(surface, target)
    for size, shift in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)):
        net = size * surface.control_points + shift
        other = BSplineSurface(3, 3, surface.knots_u, surface.knots_v, net, surface.weights)
        moved = closest_point(other, size * target + shift)
        assert np.abs(moved.parameters - found.parameters).max() <= 1e-8
        assert abs(moved.distance / size - found.distance) <= 1e-9


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: closest_point(circle(), [1, 2, 3, 4]), ControlPointError, r"point: 4 coordinate\(s\), expected 3"),
        (lambda: closest_point(circle(), [1, np.nan, 3]), ControlPointError, r"point\[1\]: found nan"),
        (lambda: closest_point([1], [1, 2, 3]), InputError, "shape: found a list"),
    ],
)
def test_what_is_no_point_or_shape_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_rational_rows_count():
    rows = [BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[1, 0, z], [1, 1, z], [0, 1, z]], [1, 1, 2]) for z in (0, 1)]
    quarter = SemiStructuredSurface(1, [0, 0, 1, 1], rows)
    assert abs(closest_point(quarter, [2, 2, 0.5]).distance - (np.sqrt(8) - 1)) <= 1e-15


def far_sheet():
    """Off the origin; nearest to points far away to the right and above in its corner u = v = 1."""
    return BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[3, 0, 0], [3, 1, 0]], [[4, 0, 0], [4, 1, 0.5]]])


@pytest.mark.parametrize("far", [1e3, 1e9, 0.9e12])
def test_points_far_away_have_a_nearest_point(far):
    found = closest_point(far_sheet(), np.array([far, far, far]))
    assert found.parameters.tolist()[-1] == [1, 1]
    assert found.distance == pytest.approx(np.sqrt(3) * far, rel=1e-2 if far < 1e4 else 1e-8)


@pytest.mark.parametrize("far", [1e13, 1e100, 1e200, 1e308])
@pytest.mark.parametrize("shape", [far_sheet(), BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [1, 0, 0]])])
def test_points_of_which_rounding_hides_the_nearest_are_refused(far, shape):
    """Infinity was the answer."""
    with pytest.raises(ControlPointError, match="sizes of the shape away, where all its points are equally near"):
        closest_point(shape, [far, 0, 0])


@pytest.mark.parametrize("scale", [2.0**600, 2.0**-600])
def test_huge_and_tiny_shapes_are_measured_as_others(scale):
    """Squares of these coordinates overflow, or vanish."""
    plain, target = wavy(3, True), np.array([0.3, 0.6, 0.8])
    other = BSplineSurface(3, 3, plain.knots_u, plain.knots_v, plain.control_points * scale, plain.weights)
    one, two = closest_point(plain, target), closest_point(other, target * scale)
    assert one.distance * scale == two.distance
    assert np.array_equal(one.parameters, two.parameters)
    assert np.array_equal(one.points * scale, two.points)


def test_a_shape_that_is_one_point_has_no_size_to_be_far_from():
    dot = BSplineCurve(1, [0, 0, 1, 1], [[1, 0, 0], [1, 0, 0]])
    found = closest_point(dot, [4, 4, 0])
    assert (found.distance, found.continuum) == (5.0, False)


FLAT = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
# z = x^2: around (0, 0, 0.5) a circle touches it at (0, 0, 0) to fourth order.
PARABOLA = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[-1, 0, 1], [0, 0, -1], [1, 0, 1]])


@pytest.mark.parametrize(
    ("shape", "target", "continuum"),
    [
        (cylinder(2.0, 3.0), (0, 0, 1), True),
        (cylinder(2.0, 3.0), (0, 0, 9), True),
        (cylinder(2.0, 3.0), (0.01, 0, 1), False),
        (cylinder(2.0, 3.0), (5, 1, 1), False),
        (sphere(2.0), (0, 0, 0), True),
        (sphere(2.0), (0, 0, 0.5), False),
        (sphere(2.0), (0, 0, 7), False),
        (sphere(2.0), (0, 0, 2), False),
        (torus(5.0, 2.0), (0, 0, 0), True),
        (torus(5.0, 2.0), (5, 0, 0), True),
        (torus(5.0, 2.0), (9, 0, 1), False),
        (circle(2.0), (0, 0, 4), True),
        (circle(2.0), (0, 1, 4), False),
        (FLAT, (0.3, 0.4, 2), False),
        (FLAT, (5, 5, 2), False),
        (PARABOLA, (0, 0, 0.5), False),
        (PARABOLA, (0, 0, 0.7), False),
    ],
)
def test_where_infinitely_many_points_are_nearest_it_is_said(shape, target, continuum):
    """Beside an axis by a hundredth one is nearest; at a pole and where curvature touches it is one point."""
    assert closest_point(shape, target).continuum is continuum


def test_two_points_that_are_equally_near_are_no_continuum():
    found = closest_point(PARABOLA, [0, 0, 3])
    assert len(found.parameters) == 2
    assert not found.continuum


@pytest.mark.parametrize(("u", "v"), [(1.0, 3), (0.7, 2.9)])
def test_a_pole_is_one_point_with_one_of_its_parameters(u, v):
    """It came 32 times, once for each start that had ended there."""
    ball = sphere(u)
    for shape in (ball, swap_directions(ball)):
        for end, where in ((-1, [0, 0, -v]), (1, [0, 0, v])):
            found = closest_point(shape, where)
            assert found.points.shape == (1, 3)
            assert np.abs(found.points - [[0, 0, end * u]]).max() <= 1e-15
            assert not found.continuum
    # The whole seam of a sphere is still both its parameters.
    assert len(closest_point(ball, [v, 0, 0]).parameters) == 2


def test_two_poles_in_one_place_and_a_span_that_is_a_point_are_told_apart():
    """A spindle that comes back to where it starts; a curve that stays at its corner for a span."""
    profile = BSplineCurve(3, [0] * 4 + [1] * 4, [[0, 0, 0], [3, 0, 1], [3, 0, -1], [0, 0, 0]])
    spindle = revolve(profile, [0, 0, 0], [0, 0, 1], angle=360)
    assert len(closest_point(spindle, [0, 0, 0]).parameters) == 2
    corner = BSplineCurve(1, [0, 0, 1, 2, 3, 3], [[-1, 1], [0, 0], [0, 0], [1, 1]])
    assert len(closest_point(corner, [0, -1]).parameters) == 1
