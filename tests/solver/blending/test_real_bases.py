"""Bases as CAD has them: other degrees, closed curves with seams anywhere, knots of full multiplicity, units of v."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.bases import circle, cylinder, facing_pair, patch, turned
from helpers.papers_set import blend, state_problem
from helpers.sweeps import examples
from semispline import Base, BSplineSurface, EdgeError, FoldError, OptionError, SemiStructuredSurface, thin_plate_energy
from semispline.solver.blending.closing import periodic_points, reseamed, seam_order
from semispline.solver.judge.de_boor import curve_points, surface_points
from semispline.solver.splines.operations import insert_knots, map_domain
from semispline.solver.splines.quadrature import Basis


@pytest.mark.parametrize("order", [0, 1, 2])
def test_periodic_points_span_the_smooth_closed_curves(order):
    knots, points = circle(7)
    basis = Basis(3, knots)
    z = periodic_points(basis, order).toarray()
    assert z.shape == (basis.size, basis.size - order - 1)
    # The circle is one of them, and every one of them is closed and smooth.
    y = points[: basis.size - order - 1]
    np.testing.assert_allclose(z @ y, points, atol=1e-12)
    random = z @ np.random.default_rng(0).standard_normal((z.shape[1], 2))
    for d in range(order + 1):
        ends = curve_points(3, knots, random, np.array([0.0, 1.0]), d)
        np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-11 * 50**d)


@given(st.integers(4, 12), st.floats(0.05, 0.95))
def test_reseaming_keeps_the_curve(n_spans, shift):
    knots, points = circle(n_spans)
    rows = np.stack([np.column_stack([points, np.full(len(points), z)]) for z in (0.0, 1.0)])
    along, moved = reseamed(Basis(3, knots), rows, shift, 1.0)
    assert along.knots[0] == pytest.approx(shift)
    assert along.knots[-1] == pytest.approx(1 + shift)
    # The old seam is smooth, so it costs one knot, as any other.
    assert np.count_nonzero(np.abs(along.knots - 1.0) < 1e-12) == 1
    v = np.linspace(shift, 1 + shift, 97)
    for old, new in zip(rows, moved, strict=True):
        expected = curve_points(3, knots, old, np.mod(v, 1.0))
        np.testing.assert_allclose(curve_points(3, along.knots, new, v), expected, atol=1e-11)
    assert seam_order(along, moved, 1.0) == 2


@pytest.mark.parametrize("continuity", ["C0", "C1", "C2", "G1", "G2"])
@pytest.mark.parametrize("middle_curves", [0, 1, 2])
def test_closed_cylinders_blend_smoothly_across_the_seam(continuity, middle_curves):
    a = cylinder(7, 1.0, (0.0, 1.0))
    b = cylinder(5, 0.7, (-1.5, -2.5), seam=0.31, offset=(0.2, 0.0))
    for method in ("reduced", "casadi"):
        result = blend(Base(a, "u0"), Base(b, "u0"), continuity=continuity, middle_curves=middle_curves, method=method)
        assert result.seam_shift != 0
        assert result.seam.gap < 1e-13
        assert result.seam.angle_degrees < 1e-8
        assert result.seam.curvature_jump_relative < 1e-8
        assert result.seam.c2_residual < 1e-8


def test_seams_face_each_other():
    a = cylinder(7, 1.0, (0.0, 1.0))
    b = cylinder(5, 0.7, (-1.0, -2.0), seam=0.4)
    result = blend(Base(a, "u0"), Base(b, "u0"))
    # 0.4 of a turn ahead, so the seam of a faces b at the parameter 0.6.
    assert result.seam_shift == pytest.approx(0.6, abs=1e-3)
    ends = surface_points(result.surface, [0.0, 1.0], [0.0, 0.0])
    angles = np.arctan2(ends[:, 1], ends[:, 0])
    assert angles[0] == pytest.approx(angles[1], abs=1e-2)
    straight = blend(Base(a, "u0"), Base(cylinder(5, 0.7, (-1.0, -2.0)), "u0"))
    assert straight.seam_shift == 0
    assert result.energy == pytest.approx(straight.energy, rel=0.02)


@pytest.mark.parametrize("backwards", [False, True])
def test_closed_and_turned_round(backwards):
    a = cylinder(7, 1.0, (0.0, 1.0))
    b = turned(cylinder(5, 0.7, (-1.0, -2.0), seam=0.23), "v1", backwards)
    result = blend(Base(a, "u0"), Base(b, "v1"))
    assert result.flipped == backwards
    assert result.contact_b.curvature_jump_relative < 1e-9
    assert result.shape.turn.degrees < 30


def test_a_smooth_seam_has_a_lower_bound_in_the_open_problem():
    # The same blend without the seam condition has no more energy: a constraint cannot help.
    a, b = cylinder(7, 1.0, (0.0, 1.0)), cylinder(7, 0.6, (-1.0, -2.0))
    closed = blend(Base(a, "u0"), Base(b, "u0"), continuity="C0")
    cut = a.control_points.copy()
    cut[0, -1] += 1e-6
    opened = blend(Base(BSplineSurface(3, 3, a.knots_u, a.knots_v, cut), "u0"), Base(b, "u0"), continuity="C0")
    assert opened.seam is None
    assert opened.energy < closed.energy


@pytest.mark.parametrize("degrees", [(2, 3), (3, 5), (1, 4)])
def test_the_lower_degree_along_the_contact_is_elevated(degrees):
    rng = np.random.default_rng(1)
    bases = []
    for q, sign in zip(degrees, (1, -1), strict=True):
        s = patch(rng, degrees=(3, q), counts=(5, q + 4))
        net = s.control_points * np.array([sign, 1, 1]) + np.array([-0.5 + 0.5 * sign, 0, 0])
        bases.append(Base(BSplineSurface(3, q, s.knots_u, s.knots_v, net), "u0"))
    result = blend(*bases)
    assert {curve.degree for curve in result.surface.control_curves} == {max(degrees)}
    for contact in (result.contact_a, result.contact_b):
        assert contact.curvature_jump_relative < 1e-9


@pytest.mark.parametrize("multiplicity", [2, 3])
def test_inner_knots_of_any_multiplicity(multiplicity):
    rng = np.random.default_rng(0)
    knots = np.concatenate([[0.0] * 4, [0.4] * multiplicity, [0.7], [1.0] * 4])
    s = patch(rng, degrees=(3, 3), counts=(5, len(knots) - 4))
    a = BSplineSurface(3, 3, s.knots_u, knots, s.control_points)
    _, b = facing_pair(rng, edges=("u0", "u0"), backwards=(False, False))
    for continuity in ("C2", "G2"):
        result = blend(Base(a, "u0"), b, continuity=continuity)
        assert result.contact_a.curvature_jump_relative < 1e-9
        # Full multiplicity lets the blend crease for nothing; the result says so, lower multiplicity does not.
        assert any("creased at v = 0.4" in w for w in result.warnings) == (multiplicity == 3)
    if multiplicity == 3:
        with pytest.raises(FoldError, match="creased"):
            blend(Base(a, "u0"), b, strict=True)


def test_a_fold_is_a_warning_and_an_error_if_strict():
    a, b = facing_pair(np.random.default_rng(0), edges=("u0", "u0"), backwards=(False, False))
    folded = blend(a, b, continuity="C2", flip="yes")
    if not any("folds" in w for w in folded.warnings):
        folded = blend(a, b, alpha=12.0)
        assert any("folds" in w for w in folded.warnings)
        with pytest.raises(FoldError, match="folds"):
            blend(a, b, alpha=12.0, strict=True)


@pytest.mark.long
@pytest.mark.parametrize("v_scale", ["unit", "length"])
@given(seed=st.integers(0, 10**6))
@examples(15)
def test_units_of_v_and_order_of_bases_do_not_matter(v_scale, seed):
    a, b = facing_pair(np.random.default_rng(seed), edges=("u0", "u0"), backwards=(False, False))
    plain = blend(a, b, v_scale=v_scale)
    stretched = Base(map_domain(a.surface, v_range=(3.0, 21.0)), "u0")
    other = blend(stretched, b, v_scale=v_scale)
    assert other.alpha2 == pytest.approx(plain.alpha2, rel=1e-6)
    swapped = blend(b, a, v_scale=v_scale)
    assert swapped.beta2 == pytest.approx(plain.alpha2, rel=1e-6)
    (v0, v1), (w0, w1) = plain.surface.domain[1], swapped.surface.domain[1]
    u, t = np.linspace(0, 1, 9), np.linspace(0, 1, 9)
    here = plain.surface.evaluate_grid(u, v0 + t * (v1 - v0))
    stretched_grid = other.surface.evaluate_grid(u, 3.0 + 18.0 * t)
    there = swapped.surface.evaluate_grid(1 - u, w0 + t * (w1 - w0))
    # Points agree to the accuracy with which a flat minimum fixes alpha.
    np.testing.assert_allclose(stretched_grid, here, atol=1e-6)
    np.testing.assert_allclose(there, here, atol=1e-6)


@pytest.mark.long
def test_paper_scale_does_depend_on_units_of_v():
    a, b = facing_pair(np.random.default_rng(0), edges=("u0", "u0"), backwards=(False, False))
    plain = blend(a, b)
    other = blend(Base(map_domain(a.surface, v_range=(0.0, 100.0)), "u0"), b)
    assert other.alpha2 != pytest.approx(plain.alpha2, rel=1e-3)


def test_knots_can_be_given():
    a, b = facing_pair(np.random.default_rng(4), edges=("u0", "u0"), backwards=(False, False))
    (v0, v1) = a.range_along
    middle = [[v0 + 0.3 * (v1 - v0), v0 + 0.6 * (v1 - v0)]]
    result = blend(a, b, u_knots=[0.2, 0.5, 0.8], middle_knots=middle)
    assert isinstance(result.surface, SemiStructuredSurface)
    np.testing.assert_allclose(result.surface.knots_u[4:-4], [0.2, 0.5, 0.8])
    curve = result.surface.control_curves[3]
    np.testing.assert_allclose(curve.knots[curve.degree + 1 : -curve.degree - 1], middle[0])
    assert result.contact_b.curvature_jump_relative < 1e-9


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"u_knots": [0.5]}, "u_knots: found 1 inner knots, expected 3"),
        ({"u_knots": [0.2, 0.5, 1.5]}, "u_knots: found"),
        ({"middle_knots": []}, "middle_knots: found 0 lists"),
        ({"middle_knots": [[1e9]]}, r"middle_knots\[0\]: found"),
        ({"v_scale": "metric"}, "v_scale: found 'metric'"),
    ],
)
def test_knots_that_do_not_fit_are_refused(options, message):
    a, b = facing_pair(np.random.default_rng(4), edges=("u0", "u0"))
    with pytest.raises(OptionError, match=message):
        blend(a, b, **options)


@pytest.mark.long
def test_orientation_is_the_same_every_time_and_either_way(whole):
    for seed in range(10 if whole else 3):
        a, b = facing_pair(np.random.default_rng(seed))
        assert blend(a, b).flipped == blend(b, a).flipped == blend(a, b).flipped


@pytest.mark.parametrize("length", [1e-3, 0.005, 200.0])
def test_length_of_the_v_domain(length):
    # A part of a few millimetres in metres: the terms of (11) differ by length^-4, and the solve must still be true.
    a, b = facing_pair(np.random.default_rng(3), edges=("u0", "u0"), backwards=(False, False))
    plain = blend(a, b, continuity="C0", v_scale="unit")
    scaled = blend(Base(map_domain(a.surface, v_range=(0.0, length)), "u0"), b, continuity="C0")
    # The minimum of the paper's energy is no worse there than any other blend of the same kind.
    other = map_domain(plain.surface, v_range=(0.0, length))
    assert scaled.energy <= thin_plate_energy(other) * (1 + 1e-9)


def test_a_degenerate_corner_does_not_stop_parametric_contact():
    rng = np.random.default_rng(0)
    s = patch(rng, degrees=(3, 3), counts=(5, 6))
    net = s.control_points.copy()
    net[1, 0] = net[0, 0]
    a = Base(BSplineSurface(3, 3, s.knots_u, s.knots_v, net), "u0")
    _, b = facing_pair(rng, edges=("u0", "u0"), backwards=(False, False))
    for continuity in ("C0", "C1", "C2"):
        result = blend(a, b, continuity=continuity)
        assert {place.parameter for place in result.contact_a.no_normal} == {0.0}
        assert result.contact_a.gap < 1e-14
        # Told away from the corner, near which derivatives across are rounding: what C0 leaves open, C1 and C2 meet.
        assert result.contact_a.angle_degrees < (180 if continuity == "C0" else 1e-6)
    with pytest.raises(EdgeError, match="edge u0: no normal"):
        blend(a, b, continuity="G1")


def square_tube(size, heights, corner=0):
    """Degree 1 along v, closed, creased at its corners; the seam is at one of them."""
    corners = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)], dtype=float)
    ring = np.roll(corners, -corner, axis=0)
    ring = size * np.vstack([ring, ring[:1]])
    rows = [np.column_stack([ring, np.full(5, z)]) for z in np.linspace(*heights, 4)]
    return BSplineSurface(3, 1, [0, 0, 0, 0, 1, 1, 1, 1], [0, 0, 0.25, 0.5, 0.75, 1, 1], np.array(rows))


@pytest.mark.parametrize("corner", [0, 1, 2])
def test_closed_and_creased(corner):
    a, b = square_tube(1.0, (0.0, 1.0)), square_tube(0.7, (-1.5, -2.5), corner)
    result = blend(Base(a, "u0"), Base(b, "u0"))
    assert result.contact_b.angle_degrees < 1e-9
    # The tube has corners of 90 degrees, also at its seam; the blend has no others.
    assert result.shape.turn.degrees < 120
    assert result.seam.gap < 1e-13


def flat(x, y, height=0.0, v_range=(0.0, 1.0)):
    """The rectangle over [x0, x1] x [y0, y1]."""
    k = [0, 0, 1, 1]
    knots_v = np.repeat(v_range, 2)
    return BSplineSurface(1, 1, k, knots_v, [[[a, b, height] for b in y] for a in x])


def energy_length(a, b, v_scale):
    """Length of the v-domain that the energy is taken over."""
    knots = state_problem(a, b, v_scale=v_scale).problem.form.rows[0].knots
    return knots[-1] - knots[0]


def test_length_is_mean_contact_length_over_mean_gap():
    # Straight and parallel, 3 long, 0.5 apart.
    a = Base(flat((0, 1), (0, 3), v_range=(0, 7)), "u1")
    b = Base(flat((1.5, 3), (0, 3)), "u0")
    assert energy_length(a, b, "length") == pytest.approx(6, rel=1e-12)
    assert energy_length(a, b, "unit") == 1
    assert energy_length(a, b, "paper") == 7
    # In one plane, the gap from 0.5 to 2.5, lengths 3 and the root of 13.
    k = [0, 0, 1, 1]
    slanted = BSplineSurface(1, 1, k, k, [[[1.5, 0, 0], [3.5, 3, 0]], [[4, 0, 0], [4, 3, 0]]])
    assert energy_length(a, Base(slanted, "u0"), "length") == pytest.approx((3 + 13**0.5) / 2 / 1.5, rel=1e-12)


def test_length_of_circles():
    # Coaxial, radii 1 and 2, planes 1.5 apart: every distance is the root of 1 + 1.5^2, mean length 3 pi.
    a, b = Base(cylinder(40, 1.0, (0, -1)), "u0"), Base(cylinder(40, 2.0, (1.5, 3)), "u0")
    # A cubic spline through 40 points of a circle is about (2 pi / 40)^4 / 400 off.
    assert energy_length(a, b, "length") == pytest.approx(3 * np.pi / 3.25**0.5, rel=1e-5)


def test_natural_size_is_mean_gap_over_mean_cross_speed():
    # Base a is 1 wide over a range of 1, base b 1.5 wide over a range of 1; the gap is 0.5.
    a, b = Base(flat((0, 1), (0, 3)), "u1"), Base(flat((1.5, 3), (0, 3)), "u0")
    assert state_problem(a, b).problem.natural == pytest.approx((0.5, 1 / 3), rel=1e-12)
    # Cross speed from 1 to 2, linear along v, is 1.5 in the mean, wherever the control points are.
    k = [0, 0, 1, 1]
    wider = BSplineSurface(1, 1, k, k, [[[-1, 0, 0], [-2, 3, 0]], [[0, 0, 0], [0, 3, 0]]])
    knotted = insert_knots(wider, knots_v=[0.1, 0.2, 0.3])
    c = Base(flat((0.5, 2), (0, 3)), "u0")
    for surface in (wider, knotted):
        assert state_problem(Base(surface, "u1"), c).problem.natural[0] == pytest.approx(0.5 / 1.5, rel=1e-12)


def test_a_closed_and_an_open_contact_curve_are_warned_of():
    a, b = cylinder(7, 1.0, (0.0, 1.0)), patch(np.random.default_rng(0), degrees=(3, 3), counts=(4, 7))
    b = BSplineSurface(3, 3, b.knots_u, b.knots_v, b.control_points + np.array([0, 0, -3.0]))
    assert any("closed, the other is open" in w for w in blend(Base(a, "u0"), Base(b, "u0")).warnings)


def test_a_pinched_blend_is_warned_of():
    k = [0, 0, 1, 1]
    a = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    b = BSplineSurface(1, 1, k, k, [[[3, 0, 0.5], [3, 1, 0.5]], [[4, 0, 0.5], [4, 1, 0.5]]])
    assert any("pinched" in w for w in blend(Base(a, "u1"), Base(b, "u0"), alpha=0.03).warnings)


def test_contact_curves_that_coincide_in_another_parametrisation_are_refused():
    k, k3 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]
    a = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    # The same edge, run through as (v + v^2) / 2.
    b = BSplineSurface(1, 2, k, k3, [[[x, y, 0] for y in (0, 0.25, 1)] for x in (1, 2)])
    for flip in ("auto", "no", "yes"):
        with pytest.raises(EdgeError, match="contact curves coincide"):
            blend(Base(a, "u1"), Base(b, "u0"), flip=flip)
    near = BSplineSurface(1, 2, k, k3, b.control_points + np.array([1e-6, 0, 0]))
    assert blend(Base(a, "u1"), Base(near, "u0")).contact_a.gap < 1e-15
