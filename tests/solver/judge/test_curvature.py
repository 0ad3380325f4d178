"""Curvature with known answers, its laws, and degenerate points."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.splines import semistructured_surfaces
from helpers.sweeps import examples
from semispline import insert_row_knot
from semispline.solver.errors import InputError
from semispline.solver.judge.curvature import (
    gaussian_curvature,
    isophote_angle,
    local_geometry,
    local_geometry_grid,
    mean_curvature,
    mirror_angle,
    normal_curvature,
    normals,
    principal_curvatures,
    zebra,
)
from semispline.solver.splines.operations import (
    elevate_degree,
    insert_knots,
    map_domain,
    reverse_u,
    swap_directions,
    transform,
)
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

# The limit of the issue: second derivatives of these shapes have a few roundings of numbers of size 1.
TOLERANCE = 1e-12
BEZIER_1, BEZIER_2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]
ROOT = np.sqrt(0.5)
# Quarter of the unit circle as a rational parabola: homogeneous points (w x, w y, w).
QUARTER = np.array([[1, 0, 1], [ROOT, ROOT, ROOT], [0, 1, 1]])


def quarter_cylinder(radius, height):
    x, y, w = QUARTER.T
    net = [[[radius * a / c, radius * b / c, z] for z in (0, height)] for a, b, c in zip(x, y, w, strict=True)]
    return BSplineSurface(2, 1, BEZIER_2, BEZIER_1, net, np.column_stack([w, w]))


def turned(profile):
    """Quarter turn about z of a rational profile (w r, w z, w)."""
    net = [[[a * r / (c * w), b * r / (c * w), z / w] for r, z, w in profile] for a, b, c in QUARTER]
    weights = np.outer(QUARTER[:, 2], [w for _, _, w in profile])
    return BSplineSurface(2, 2, BEZIER_2, BEZIER_2, net, weights)


def octant(radius):
    return turned([(radius * a, radius * b, w) for a, b, w in QUARTER])


def torus(big, small):
    return turned([(big * w + small * a, small * b, w) for a, b, w in QUARTER])


def saddle():
    return BSplineSurface(1, 1, BEZIER_1, BEZIER_1, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]])


def points(count=50, below=1.0, seed=0):
    return np.random.default_rng(seed).uniform(0, below, (2, count))


def close(found, expected):
    assert np.abs(found - expected).max() <= TOLERANCE * max(1, np.abs(expected).max())


def test_a_plane_has_no_curvature_in_any_form():
    plane = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, [[[1, 2, 3], [1, 5, 4]], [[3, 2, 2], [3, 5, 3]]])
    surface = insert_knots(elevate_degree(plane, 3, 4), [0.2, 0.2, 0.7], [0.31])
    u, v = points()
    for form in (plane, surface, surface.to_semistructured()):
        close(local_geometry(form, u, v).principal, np.zeros((50, 2)))
        normal = np.array([3, -2, 6]) / 7
        assert np.abs(np.abs(normals(form, u, v) @ normal) - 1).max() <= 1e-15


def test_a_rational_quarter_cylinder_is_exact():
    surface = quarter_cylinder(2.5, 4.0)
    u, v = points()
    p, geometry = surface.evaluate(u, v), local_geometry(surface, u, v)
    assert np.abs(np.hypot(p[:, 0], p[:, 1]) - 2.5).max() <= 1e-15 * 2.5
    # P_u x P_v points outwards here (u turns, v climbs), and the surface bends away from it.
    close(geometry.normal, p * [0.4, 0.4, 0])
    close(geometry.mean, np.full(50, -0.2))
    close(geometry.gaussian, np.zeros(50))
    close(geometry.principal, np.tile([0.0, -0.4], (50, 1)))
    close(np.abs(geometry.principal_directions[:, 0]), np.tile([0, 0, 1], (50, 1)))
    close(geometry.normal_curvature([0, 0, 1]), np.zeros(50))
    # Euler: at 45 degrees to the axis half of the curvature is left.
    around = np.cross([0, 0, 1], geometry.normal)
    close(geometry.normal_curvature(around + np.array([0, 0, 1])), np.full(50, -0.2))
    close(normal_curvature(surface, u, v, around), np.full(50, -0.4))


def test_a_sphere_octant_has_one_curvature_everywhere_but_at_its_pole():
    surface = octant(3.0)
    u, v = points(below=0.999)
    p = surface.evaluate(u, v)
    assert np.abs(np.linalg.norm(p, axis=1) - 3).max() <= 1e-14
    close(gaussian_curvature(surface, u, v), np.full(50, 1 / 9))
    close(mean_curvature(surface, u, v), np.full(50, -1 / 3))
    close(normals(surface, u, v), p / 3)
    # v = 1 is the pole for every u: one point, no P_u.
    pole = local_geometry(surface, [0.3, 0.3], [1.0, 0.9])
    assert pole.regular.tolist() == [False, True]
    assert np.isnan(pole.normal[0]).all()
    assert np.isnan([pole.mean[0], pole.gaussian[0], *pole.principal[0]]).all()
    assert np.isnan(pole.principal_directions[0]).all()
    assert np.isfinite(pole.first_form).all()
    assert np.isnan(pole.normal_curvature([1, 0, 0])[0])
    assert np.isfinite(pole.mean[1])


def test_a_bilinear_saddle():
    # z = x y: K = -1 / (1 + x^2 + y^2)^2, H = -x y / (1 + x^2 + y^2)^(3/2).
    u, v = points()
    s = 1 + u**2 + v**2
    classical = elevate_degree(saddle(), 2, 3)
    semi = insert_row_knot(insert_row_knot(classical.to_semistructured(), 0, 0.4), 2, 0.6, 3)
    for surface in (saddle(), classical, semi):
        geometry = local_geometry(surface, u, v)
        close(geometry.gaussian, -1 / s**2)
        close(geometry.mean, -u * v / s**1.5)
        assert np.abs(np.linalg.det(geometry.first_form) - s).max() <= 1e-14
        close(geometry.second_form[:, 0, 1], 1 / np.sqrt(s))
        close(geometry.second_form[:, 0, 0], np.zeros(50))
        # The rulings are asymptotic lines.
        close(geometry.normal_curvature(geometry.tangent_u), np.zeros(50))


def test_a_torus():
    big, small = 3.0, 0.75
    surface = torus(big, small)
    u, v = points()
    p = surface.evaluate(u, v)
    cosine = (np.hypot(p[:, 0], p[:, 1]) - big) / small
    assert np.abs((np.hypot(p[:, 0], p[:, 1]) - big) ** 2 + p[:, 2] ** 2 - small**2).max() <= 1e-14
    around = cosine / (big + small * cosine)
    geometry = local_geometry(surface, u, v)
    outwards = np.sign(np.einsum("kd,kd->k", geometry.normal, p * [1, 1, 0]))
    assert np.abs(outwards).min() == 1
    close(geometry.gaussian, around / small)
    close(geometry.mean * outwards, -(around + 1 / small) / 2)
    close(principal_curvatures(surface, u, v)[:, 1] * outwards, np.full(50, -1 / small))


def test_a_paraboloid_at_its_vertex():
    # z = 2 x^2 + y^2 over [-1, 1]^2: principal curvatures 4 and 2 at the origin, along x and y.
    x, y = np.meshgrid([-1, 0, 1], [-1, 0, 1], indexing="ij")
    # Bezier points of t^2 on [-1, 1]: 1, -1, 1.
    square = np.array([1, -1, 1])
    z = 2 * square[:, None] + square[None, :]
    surface = BSplineSurface(2, 2, BEZIER_2, BEZIER_2, np.dstack([x, y, z]))
    geometry = local_geometry(surface, [0.5], [0.5])
    close(geometry.principal, np.array([[4.0, 2.0]]))
    close(np.abs(geometry.principal_directions[0]), np.array([[1, 0, 0], [0, 1, 0]]))


@examples(30)
@given(semistructured_surfaces(degrees=(2, 5), most=1), st.integers(0, 2**32 - 1))
def test_curvature_belongs_to_the_shape_not_to_its_form(surface, seed):
    rng = np.random.default_rng(seed)
    u, v = (rng.uniform(*r, 6) for r in surface.domain)
    geometry = local_geometry(surface, u, v)
    size = np.abs(geometry.principal).max()
    spread = np.linalg.cond(geometry.first_form).max()
    limit = 1e-12 * spread * max(1.0, size)
    classical = surface.to_bspline()
    (u0, u1), _ = surface.domain
    angle = rng.uniform(0, 2 * np.pi)
    rotation = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    for same, (a, b), sign in (
        (classical, (u, v), 1),
        (transform(surface, rotation, [1, 2, 3]), (u, v), 1),
        (reverse_u(surface), (u0 + u1 - u, v), -1),
        (swap_directions(classical), (v, u), -1),
    ):
        assert np.abs(sign * local_geometry(same, a, b).mean - geometry.mean).max() <= limit
        assert np.abs(local_geometry(same, a, b).gaussian - geometry.gaussian).max() <= limit * max(1.0, size)
    twice = local_geometry(transform(surface, 2 * np.eye(3)), u, v)
    assert np.abs(2 * twice.mean - geometry.mean).max() <= limit
    product = geometry.principal.prod(axis=1)
    assert np.abs(product - geometry.gaussian).max() <= 1e-12 * size**2


def test_units_of_the_parameters_do_not_matter():
    surface = elevate_degree(saddle(), 3, 3)
    u, v = points()
    stretched = map_domain(surface, (0, 1e6), (5, 5 + 1e-3))
    close(local_geometry(stretched, u * 1e6, 5 + v * 1e-3).gaussian, -1 / (1 + u**2 + v**2) ** 2)


def test_grids_are_points_one_by_one():
    surface = torus(2, 1)
    u, v = np.array([0.1, 0.5]), np.array([0.2, 0.4, 0.9])
    grid = local_geometry_grid(surface, u, v)
    assert grid.principal.shape == (2, 3, 2)
    uu, vv = (x.ravel() for x in np.meshgrid(u, v, indexing="ij"))
    close(grid.mean.ravel(), mean_curvature(surface, uu, vv))


@pytest.mark.parametrize(
    "net",
    [
        np.zeros((2, 2, 3)),
        [[[0, 0, 0], [1, 0, 0]], [[2, 0, 0], [3, 0, 0]]],
        [[[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [1, 0, 0]]],
    ],
    ids=["a point", "a line", "collapsed v"],
)
def test_surfaces_without_area_are_degenerate_and_say_so(net):
    surface = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, net)
    geometry = local_geometry(surface, [0.0, 0.5], [0.5, 1.0])
    assert not geometry.regular.any()
    assert np.isnan(geometry.mean).all()
    assert np.isnan(geometry.gaussian).all()


def test_a_direction_along_the_normal_is_refused():
    plane = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    with pytest.raises(InputError, match="direction: has no part in the tangent plane"):
        normal_curvature(plane, [0.5], [0.5], [0, 0, 1])
    with pytest.raises(InputError, match=r"direction: shape \(2,\)"):
        normal_curvature(plane, [0.5], [0.5], [0, 1])


def test_isophotes_of_a_sphere_are_circles_around_the_light():
    surface = octant(1.0)
    u, v = points(below=0.99)
    p = surface.evaluate(u, v)
    close(isophote_angle(normals(surface, u, v), [0, 0, 5]), np.degrees(np.arccos(p[:, 2])))


def test_zebra_stripes_on_a_plane_follow_the_mirror_image():
    plane = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, [[[-1, -1, 0], [-1, 1, 0]], [[1, -1, 0], [1, 1, 0]]])
    # Seen from 1 above the centre, the ray mirrored at distance r leaves at the angle arctan(r) to the normal. Two
    # light stripes: from 45 to 90 and from 135 to 180 degrees to the axis.
    u, v = np.array([0.5, 0.9, 0.9, 0.5]), np.array([0.9, 0.5, 0.1, 0.95])
    p, n = plane.evaluate(u, v), normals(plane, u, v)
    close(mirror_angle(n, [0, 0, 1] - p, [0, 0, 1]), np.degrees(np.arctan(np.hypot(p[:, 0], p[:, 1]))))
    assert zebra(p, n, [0, 0, 1], stripes=2).tolist() == [0, 0, 1, 0]
    x = np.array([[-0.9, 0, 0], [-1.1, 0, 0], [0.9, 0, 0], [1.1, 0, 0]])
    up = np.tile([0.0, 0, 1], (4, 1))
    assert zebra(x, up, [0, 0, 1], stripes=2, axis=[1, 0, 0]).tolist() == [0, 1, 1, 0]
    # Either side of a surface is mirrored alike.
    assert zebra(x, -up, [0, 0, 1], stripes=2, axis=[1, 0, 0]).tolist() == [0, 1, 1, 0]
    assert np.isnan(zebra([[0, 0, 0]], [[np.nan] * 3], [0, 0, 3])).all()


def test_twenty_light_stripes_from_pole_to_pole():
    # The middle of each stripe: the eye is far away along x, and the mirrored ray at an angle to the axis z.
    angles = np.radians((np.arange(40) + 0.5) * 4.5)
    eye, rays = np.array([1e9, 0, 0]), np.stack([np.sin(angles), np.zeros(40), np.cos(angles)], axis=1)
    normals = rays + np.array([1.0, 0, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    assert zebra(np.zeros((40, 3)), normals, eye).tolist() == [0, 1] * 20


@pytest.mark.parametrize(("eye", "axis"), [([1, 2], [0, 0, 1]), ([[0, 0, 1]] * 2, [0, 0, 1]), ([0, 0, 1], [0, 0, 0])])
def test_a_mirror_without_eye_or_axis_is_refused(eye, axis):
    with pytest.raises(InputError, match=r"towards_eye: shape|axis: found"):
        mirror_angle([[0, 0, 1]], eye, axis)


def test_a_semistructured_sphere_like_patch_is_measured_directly():
    # Rows with knots of their own, compared with the classical form at the same points.
    rng = np.random.default_rng(2)
    curves = [
        BSplineCurve(3, [0, 0, 0, 0, t, 1, 1, 1, 1], rng.uniform(0, 0.1, (5, 3)) + [[x, y, 0] for y in range(5)])
        for x, t in enumerate((0.2, 0.5, 0.7, 0.4))
    ]
    surface = SemiStructuredSurface(3, [0, 0, 0, 0, 1, 1, 1, 1], curves)
    u, v = points()
    close(mean_curvature(surface, u, v), mean_curvature(surface.to_bspline(), u, v))


@pytest.mark.parametrize("surface", [octant(3.0), octant(1e-3), turned([(2 * a, 2 * b, w) for a, b, w in QUARTER])])
def test_at_umbilics_the_first_direction_is_that_of_the_first_tangent(surface):
    u, v = points(200, below=0.95)
    geometry = local_geometry(surface, u, v)
    along = geometry.tangent_u / np.linalg.norm(geometry.tangent_u, axis=1)[:, None]
    assert np.abs(geometry.principal_directions[:, 0] - along).max() <= 1e-15


def test_a_point_that_is_nearly_umbilic_has_its_own_directions():
    # Curvatures 2 and 2 + 4e-6 at the origin, the greater along y, P_u along x.
    x, y = np.meshgrid([-1, 0, 1], [-1, 0, 1], indexing="ij")
    square = np.array([1, -1, 1])
    surface = BSplineSurface(2, 2, BEZIER_2, BEZIER_2, np.dstack([x, y, square[:, None] + (1 + 2e-6) * square[None]]))
    directions = local_geometry(surface, [0.5], [0.5]).principal_directions[0]
    assert np.abs(np.abs(directions) - [[0, 1, 0], [1, 0, 0]]).max() <= 1e-9


@pytest.mark.parametrize("away", [1e-2, 1e-4, 1e-6])
def test_the_digits_lost_next_to_a_pole_are_those_that_are_stated(away):
    u = np.linspace(0.05, 0.95, 40)
    geometry = local_geometry(octant(1.0), u, [1 - away])
    assert geometry.regular.all()
    error = np.abs(np.abs(geometry.mean) - 1).max()
    # "Some" 1e-15 / r^2: within a factor of ten, and lost indeed.
    assert error <= 1e-14 / away**2
    assert error > 1e-20 / away**2


@pytest.mark.parametrize(("width", "regular"), [(1e-13, False), (1e-11, True)])
def test_the_limit_of_degenerate_points(width, regular):
    # A strip of extent 1 over the unit square: |P_u| is its width; and two tangents at that angle.
    strip = [[[0, 0, 0], [0, 1, 0]], [[width, 0, 0], [width, 1, 0]]]
    slanted = [[[0, 0, 0], [0, 1, 0]], [[width, 1, 0], [width, 2, 0]]]
    for net in (strip, slanted):
        surface = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, net)
        assert local_geometry(surface, [0.5], [0.5]).regular.tolist() == [regular]
        # Wherever the parameters are.
        moved = map_domain(surface, (10, 11), (-6, -5))
        assert local_geometry(moved, [10.5], [-5.5]).regular.tolist() == [regular]
