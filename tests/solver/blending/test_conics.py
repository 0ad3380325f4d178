"""Rims that are conics: recognised whatever made them, put into a smooth form that is the same surface; others not."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.circles import arcs, cylinder
from helpers.conics import occ_net, standard_arcs
from helpers.knot_lines import least_continuity
from helpers.same_surface import departure
from semispline import Base
from semispline.derivations.circles import circle_points
from semispline.solver.blending.conics import Conic, _boost, cured_conic, recognised_conic, same_arcs
from semispline.solver.blending.knot_lines import knot_lines
from semispline.solver.blending.matching import matched_edges
from semispline.solver.splines import Basis, clamped, elevation_matrix, refinement_matrix
from semispline.solver.splines.refinement import elevated_knots

TURN = 2 * np.pi
# Some thousand roundings of coordinates of a few units: the order in which a kernel sums products shows in the
# fourteenth digit. Another circle, or another parametrisation, is off by 1e-2 and more.
ROUNDING = 1e-12
CIRCLES = {
    "9 points": np.linspace(0, TURN, 5),
    "7 points": np.linspace(0, TURN, 4),
    "5 arcs": np.linspace(0, TURN, 6),
    "unequal arcs": np.array([0.2, 1.0, 3.4, 4.1, 0.2 + TURN]),
    "turned back": np.linspace(1.0, 1.0 - TURN, 5),
}


def basis_of(knots, degree=2):
    return Basis(degree, knots)


def images(points, frames):
    """Rows that are images of a curve, shape (K, n, 4)."""
    return np.einsum("nc,kcd->knd", points, frames)


def random_frames(rng, count, at=(0.0, 0.0, 0.0), size=1.0):
    """Ellipses of all sizes and places, one for each row, weights positive."""
    frames = np.zeros((count, 3, 4))
    frames[:, :, :3] = size * rng.uniform(-1, 1, (count, 3, 3))
    frames[:, 2, 3] = rng.uniform(0.5, 2, count)
    frames[:, 2, :3] += frames[:, 2, 3:] * np.array(at)
    return frames


@pytest.mark.parametrize("name", list(CIRCLES))
def test_a_circle_of_any_arcs_is_the_eleven_points(name):
    knots, points = standard_arcs(CIRCLES[name])
    frame = np.zeros((1, 3, 4))
    frame[0, [0, 1, 2], [0, 1, 3]] = 5, 5, 1
    rows = images(points, frame)
    new, along = cured_conic(rows, basis_of(knots), 2)
    start, sense = CIRCLES[name][0], np.sign(CIRCLES[name][1] - CIRCLES[name][0])
    x, y, w = np.array(circle_points(3), dtype=float).T
    expected = np.exp(1j * start) * (x + 1j * sense * y)
    new = new[0] / new[0, 0, 3]
    assert new[:, 0] == pytest.approx(5 * expected.real, abs=ROUNDING)
    assert new[:, 1] == pytest.approx(5 * expected.imag, abs=ROUNDING)
    assert new[:, 3] == pytest.approx(w, abs=ROUNDING)
    middle = knots[-1] / 2
    assert along.knots.tolist() == [0.0] * 7 + [middle] * 4 + [knots[-1]] * 7


@st.composite
def rims(draw):
    """Rows on one conic: any arcs, any part, any images, reparametrised, elevated, refined, far from the origin."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    arcs = draw(st.integers(1, 5))
    full = draw(st.booleans()) and arcs > 1
    turn = TURN if full else draw(st.floats(0.3, 0.9)) * min(np.pi, TURN / arcs) * arcs
    shares = rng.uniform(0.6, 1.4, arcs)
    if arcs == 2 and full:
        shares = np.array([0.9, 1.1])
    cuts = rng.uniform(0, TURN) + np.concatenate([[0], np.cumsum(shares / shares.sum() * turn)])
    if np.diff(cuts).max() > 3.0:
        cuts = np.linspace(cuts[0], cuts[-1], arcs + 2)
    cuts = cuts * draw(st.sampled_from([1, -1]))
    knots, points = standard_arcs(cuts, rng.uniform(0.8, 1.25, len(cuts)) if draw(st.booleans()) else None)
    degree = draw(st.sampled_from([2, 2, 3, 5]))
    points = elevation_matrix(2, knots, degree) @ points
    knots = elevated_knots(knots, degree - 2)
    if draw(st.booleans()):
        more = np.sort(np.append(knots, [0.3, 0.31]))
        points, knots = refinement_matrix(degree, knots, more) @ points, more
    far = draw(st.sampled_from([0.0, 0.0, 1e3]))
    count = draw(st.integers(1, 5))
    return images(points, random_frames(rng, count, rng.uniform(-1, 1, 3) * far)), Basis(degree, knots), full, abs(turn)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(rims(), st.sampled_from([1, 2, 3, 4]))
def test_any_rim_on_a_conic_is_cured(rim, order):
    rows, along, full, turn = rim
    conic = recognised_conic(rows, along)
    assert conic is not None
    assert conic.turn == (TURN if full else pytest.approx(turn, abs=1e-8))
    new, basis = cured_conic(rows, along, order)
    smooth = max(order, 2)
    assert basis.degree == 2 * (smooth + 1)
    assert least_continuity(new, basis, closed=full) >= smooth
    assert departure((rows, along), (new, basis)) < ROUNDING
    size = np.abs(new).max()
    # Both ends stay.
    for end in (0, -1):
        at = new[0, end, :3] / new[0, end, 3] - rows[0, end, :3] / rows[0, end, 3]
        assert np.abs(at).max() < ROUNDING * size
    if full:
        assert np.array_equal(new[:, 0], new[:, -1])


def occ_surfaces():
    from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface, Geom_SphericalSurface, Geom_ToroidalSurface
    from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

    axis = gp_Ax3(gp_Pnt(1.0, -2.0, 0.5), gp_Dir(0.3, 0.4, 1.0), gp_Dir(1.0, 0.2, -0.1))
    return {
        "cylinder": (Geom_CylindricalSurface(axis, 2.0), (0.0, 3.0)),
        "cone to its apex": (Geom_ConicalSurface(axis, 0.5, 2.0), (0.0, -2.0 / np.sin(0.5))),
        "sphere to its pole": (Geom_SphericalSurface(axis, 2.0), (0.3, np.pi / 2)),
        "torus": (Geom_ToroidalSurface(axis, 3.0, 1.0), (-0.5, 2.0)),
    }


@pytest.mark.parametrize("u_range", [(0, TURN), (0.3, 0.3 + TURN), (0, np.pi), (0.2, 5.0)])
@pytest.mark.parametrize("name", ["cylinder", "cone to its apex", "sphere to its pole", "torus"])
def test_elementary_surfaces_of_a_kernel(name, u_range):
    pytest.importorskip("OCP")
    surface, v_range = occ_surfaces()[name]
    (degree, knots), _, net = occ_net(surface, u_range, (min(v_range), max(v_range)))
    net = net.transpose(1, 0, 2)
    net = net[::-1] if v_range[0] > v_range[1] else net
    rows, along = net[: min(3, len(net))], Basis(degree, knots)
    full = u_range[1] - u_range[0] == TURN
    assert least_continuity(rows, along, closed=full) == (0 if len(np.unique(knots)) > 2 else 2)
    new, basis = cured_conic(rows, along, 2)
    assert (basis.degree, basis.size) == (6, 7 if u_range[1] == np.pi else 11)
    assert least_continuity(new, basis, closed=full) >= 2
    assert departure((rows, along), (new, basis)) < ROUNDING
    weights = new[0, :, 3]
    assert weights.min() / weights.max() > (0.85 if full else 0.89)


def test_the_angle_is_the_euclidean_one_on_circles():
    # Arcs whose weights make the parameter most uneven; the affine image of a circle has the angle of the circle.
    cuts = np.linspace(0, TURN, 5)
    knots, points = standard_arcs(cuts, [1, 2, 0.5, 1.5, 1])
    rows = images(points, random_frames(np.random.default_rng(0), 3))
    new, _ = cured_conic(rows, basis_of(knots), 2)
    weights = new[:, :, 3] / new[:, :1, 3]
    exact = np.array([float(w) for _, _, w in circle_points(3)])
    assert weights == pytest.approx(np.tile(exact, (3, 1)), abs=ROUNDING)


@pytest.mark.parametrize("kind", ["parabola", "hyperbola"])
def test_open_conics_that_are_no_ellipse(kind):
    # Middle weights of 1 and above 1.
    w = 1.0 if kind == "parabola" else 1.5
    points = np.array([[1, 0, 1], [1, 1, w], [0, 1, 1], [-1, 1, w], [-1.0, 0, 1]])
    points[:, :2] *= points[:, 2:]
    knots = np.array([0, 0, 0, 1, 1, 2.0, 2, 2])
    frames = random_frames(np.random.default_rng(1), 2)
    # Two arcs of different conics.
    assert recognised_conic(images(points, frames), basis_of(knots)) is None
    one = images(points[:3], frames)
    cured = cured_conic(one, basis_of(knots[[0, 0, 0, 3, 3, 3]]), 2)
    assert cured is not None
    assert departure((one, basis_of(np.array([0, 0, 0, 1, 1, 1.0]))), cured) < ROUNDING


def framed(x, y, weight=(0.0, 0.0, 1.0)):
    """Images of (cos, sin, 1) with given radii and weight, far from the origin."""
    frame = np.zeros((1, 3, 4))
    frame[0, 0, :3], frame[0, 1, :3], frame[0, :, 3] = x, y, weight
    frame[0, :, :3] += np.multiply.outer(weight, [30.0, -20.0, 10.0])
    return frame


@pytest.mark.parametrize(
    ("frame", "kind"),
    [
        (framed([3, 0, 4], [0, 5, 0]), "circle"),
        (framed([3, 0, 4], [0, 5 * (1 + 1e-10), 0]), "circle"),
        (framed([3, 0, 4], [0, 5 * (1 + 1e-6), 0]), "ellipse"),
        (framed([3, 0, 4], [3e-6, 5, 4e-6]), "ellipse"),
        (framed([1, 0, 0], [0, 2, 0]), "ellipse"),
        # A circle seen from aside, the line at infinity of its plane left alone, is an ellipse: x' = x / (1 + x / 2).
        (framed([1, 0, 0], [0, 1, 0], (0.5, 0, 1)), "ellipse"),
        # And with radii in that proportion a circle again: of radius 1 / sqrt(1 - 1/4).
        (framed([1, 0, 0], [0, np.sqrt(4 / 3), 0], (0.5, 0, 1)), "circle"),
        (framed([1, 0, 0], [0, 1, 0], (1, 0, 1)), "parabola"),
        (framed([1, 0, 0], [0, 1, 0], (0, 1.5, 1)), "hyperbola"),
    ],
)
def test_a_conic_is_named_by_what_it_is(frame, kind):
    # Where the weight is positive, in two arcs that a factor makes uneven.
    knots, points = standard_arcs([0.3, 0.9, 2.0], [1, 2, 0.5])
    conic = recognised_conic(images(points, frame), basis_of(knots))
    assert conic.kind == kind


# A hundred-millionth of the squares of both radii, 2: as much as twice their product, or as the squares differ.
@pytest.mark.parametrize(("times", "kind"), [(0.9, "circle"), (-0.9, "circle"), (1.1, "ellipse"), (-1.1, "ellipse")])
@pytest.mark.parametrize("skew", [True, False])
def test_radii_make_a_circle_up_to_their_last_digits(skew, times, kind):
    y = [times * 1e-8, 1, 0] if skew else [0, 1 - times * 1e-8, 0]
    conic = Conic(basis_of(np.array([0, 0, 0, 1, 1, 1.0])), np.zeros((3, 3)), TURN, framed([1, 0, 0], y))
    assert conic.kind == kind


@pytest.mark.parametrize(("weight", "is_cured"), [(0.9, True), (1.1, False)])
def test_a_rim_whose_new_weights_are_not_positive_is_not_cured(weight, is_cured):
    # At the ends of the arc the weight of the rim is 1 - weight.
    frame = framed([1, 0, 0], [0, 1, 0], (-weight, 0, 1))
    conic = Conic(basis_of(np.array([0, 0, 0, 1, 1, 1.0])), np.zeros((3, 3)), TURN, frame)
    assert (conic.cured_rows(2) is not None) is is_cured


@pytest.mark.parametrize("turn", [0.5, -0.5, 2.0, -2.0])
@pytest.mark.parametrize("start", [0.0, 2.0, 4.0])
def test_short_arcs_are_recognised_in_both_directions(start, turn):
    conic = recognised_conic(*ellipse([start, start + turn]))
    assert conic.turn == pytest.approx(abs(turn), rel=1e-9)
    assert conic.smooth_rows(1)[1].degree == conic.smooth_rows(2)[1].degree == 6


def nine_points():
    knots, points = standard_arcs(np.linspace(0, TURN, 5))
    frames = random_frames(np.random.default_rng(7), 3)
    return images(points, frames), basis_of(knots)


@pytest.mark.parametrize("change", [1e-13, 1e-7])
@pytest.mark.parametrize("where", [(0, 3, 2), (1, 4, 0), (2, 5, 1), (0, 1, 3), (2, 0, 3)])
def test_a_perturbed_net_is_refused(where, change):
    rows, along = nine_points()
    rows[where] += change
    assert (recognised_conic(rows, along) is not None) is (change < 1e-10)


@pytest.mark.parametrize("change", [1e-13, 1e-7])
@pytest.mark.parametrize(("column", "factor"), [(0, 1), (1, 1), (2, 1), (1, 1e-4), (1, 1e4)])
def test_a_plane_curve_that_is_no_conic_is_refused(column, factor, change):
    # All rows stay images of one curve: rank 3.
    knots, points = standard_arcs(np.linspace(0, TURN, 5))
    points[3, column] += change
    rows = factor * images(points, random_frames(np.random.default_rng(7), 3))
    assert (recognised_conic(rows, basis_of(knots)) is not None) is (change < 1e-10)


@pytest.mark.parametrize("change", [1e-13, 1e-7])
def test_a_circle_that_leaves_its_plane_is_refused(change):
    knots, points = standard_arcs(np.linspace(0, TURN, 5))
    rows = np.insert(points, 2, 0.0, axis=1)[None]
    rows[0, 3, 2] = change
    assert (recognised_conic(rows, basis_of(knots)) is not None) is (change < 1e-10)


def test_other_curves_are_refused():
    rng = np.random.default_rng(2)
    along = Basis(3, clamped([0.5] * 3, 3, 0, 1))
    frames = random_frames(rng, 2)
    assert recognised_conic(images(rng.uniform(0.5, 1, (7, 3)), frames), along) is None
    line = np.column_stack([np.linspace(0, 1, 7), np.linspace(0, 2, 7), np.ones(7)])
    assert recognised_conic(images(line, frames), along) is None
    corner = images(np.array([[1.0, 0, 1], [0, 0, 1], [0, 1, 1]]), frames)
    assert recognised_conic(corner, Basis(1, np.array([0, 0, 0.5, 1, 1]))) is None
    # There and back on one circle.
    knots, points = standard_arcs([0, 1.5, 0.0])
    assert recognised_conic(images(points, frames), basis_of(knots)) is None
    # One and a half times round it.
    knots, points = standard_arcs(np.linspace(0, 3 * np.pi, 6))
    assert recognised_conic(images(points, frames), basis_of(knots)) is None


def test_the_same_arcs_are_told():
    rng = np.random.default_rng(3)

    def conic(cuts, weights=None, degree=2, scale=1.0):
        knots, points = standard_arcs(cuts, weights)
        points = elevation_matrix(2, knots, degree) @ points
        along = Basis(degree, scale * elevated_knots(knots, degree - 2) + scale)
        return recognised_conic(images(points, random_frames(rng, 3)), along)

    quarters = np.linspace(0, TURN, 5)
    one = conic(quarters)
    assert same_arcs(one, conic(quarters + 1.0, scale=3.0))
    assert same_arcs(one, conic(-quarters))
    assert not same_arcs(one, conic(np.linspace(0, TURN, 4)))
    assert not same_arcs(one, conic([0, 1.0, 3.0, 5.0, TURN]))
    assert not same_arcs(one, conic(quarters, [1, 1.1, 1, 1, 1]))
    assert not same_arcs(one, conic(quarters, degree=3))
    assert not same_arcs(one, conic(quarters * 0.9))


def ellipse(cuts, weights=None, flat=1.0, far=0.0):
    """One row: an ellipse whose second axis is `flat`, moved by `far`."""
    knots, points = standard_arcs(cuts, weights)
    frame = np.zeros((1, 3, 4))
    frame[0, [0, 1, 2], [0, 1, 3]] = 1, flat, 1
    frame[0, 2, :3] = far
    return images(points, frame), basis_of(knots)


@pytest.mark.parametrize(("flat", "is_one"), [(1e-4, True), (1e-8, False)])
def test_an_ellipse_that_is_nearly_straight_is_a_straight_rim(flat, is_one):
    assert (recognised_conic(*ellipse(np.linspace(0, TURN, 5), flat=flat)) is not None) is is_one


def test_a_straight_rim_of_two_points_is_no_conic():
    assert recognised_conic(np.array([[[0.0, 0, 0, 1], [1, 0, 0, 1]]]), Basis(1, np.array([0, 0, 1.0, 1]))) is None


@pytest.mark.parametrize(("weight", "is_one"), [(100, True), (1e4, False)])
def test_arcs_whose_weights_hide_the_conic_are_refused(weight, is_one):
    assert (recognised_conic(*ellipse(np.linspace(0, TURN, 5), [1, weight, 1, weight, 1])) is not None) is is_one


@pytest.mark.parametrize(("missing", "is_full"), [(1e-10, True), (-1e-10, True), (1e-7, False)])
def test_what_is_nearly_a_full_turn_is_one(missing, is_full):
    conic = recognised_conic(*ellipse(np.linspace(0, TURN - missing, 5)))
    assert conic.turn == TURN if is_full else conic.turn == pytest.approx(TURN - missing, abs=1e-12)


def test_more_than_a_full_turn_is_refused():
    assert recognised_conic(*ellipse(np.linspace(0, TURN + 1e-7, 5))) is None


@pytest.mark.parametrize(("more", "count"), [(1e-10, 7), (1e-7, 11)])
def test_what_is_nearly_half_a_turn_takes_one_piece(more, count):
    assert recognised_conic(*ellipse(np.linspace(0, np.pi + more, 5))).smooth_rows(2)[1].size == count


@pytest.mark.parametrize(("less", "is_turned"), [(1e-5, True), (1e-8, False)])
def test_a_form_that_nearly_touches_the_conic_is_no_weight_of_an_ellipse(less, is_turned):
    assert (_boost(np.array([1 - less, 0, 1.0])) != np.eye(3)).any() == is_turned


@pytest.mark.parametrize(
    ("far", "change", "is_one"), [(0, 1e-11, True), (0, 1e-8, False), (1e6, 4e-9, True), (1e6, 6e-8, False)]
)
def test_what_coordinates_lose_is_allowed(far, change, is_one):
    rows, along = ellipse(np.linspace(0, TURN, 5), far=far)
    rows[0, 3, 2] += change
    assert (recognised_conic(rows, along) is not None) is is_one


@pytest.mark.parametrize(("by", "is_same"), [(1e-10, True), (1e-7, False)])
def test_arcs_that_differ_by_rounding_are_the_same(by, is_same):
    one = recognised_conic(*ellipse(np.linspace(0, TURN, 5)))
    # Knots are compared in parts of the domain.
    one = replace(one, along=basis_of(100 * one.along.knots))
    points, knots = one.points.copy(), one.along.knots.copy()
    points[3, 0] += by
    knots[3:5] += 100 * by
    for other in (replace(one, turn=one.turn + by), replace(one, points=points), replace(one, along=basis_of(knots))):
        assert same_arcs(one, other) is is_same


def test_derivatives_at_knot_lines():
    rows, along = nine_points()
    lines = knot_lines(rows, along, 1, closed=True)
    assert [line.v for line in lines] == [1, 2, 3, 0]
    for line in lines:
        assert line.continuity == 0
        # One factor for all rows: (R_v)' - (R_v) = c R, c = 4 (cos - 1) for quarters.
        jump = line.after[1] - line.before[1]
        assert jump == pytest.approx(-4 * (1 - np.cos(np.pi / 4)) * line.after[0], abs=ROUNDING)


def test_where_a_rim_starts_on_another_does_not_depend_on_its_domain():
    quarters = np.linspace(0, 1, 5)
    a = Base(cylinder(arcs(TURN * quarters)), "u1")
    # Turned by a tenth of a turn, in quarters that begin at its own start.
    shifts = [
        matched_edges(
            a, Base(cylinder(arcs(TURN * (quarters + 0.1), start + quarters), 2.0, (3.0, 4.0)), "u0"), "no"
        ).shift
        for start in (0.0, 5.0, -5.0)
    ]
    assert 0.85 < shifts[0] < 0.95
    assert shifts == pytest.approx([shifts[0]] * 3, abs=1e-12)


@pytest.mark.parametrize("turned", [0.123, 0.3, 0.61])
@pytest.mark.parametrize("count", [3, 4])
def test_rims_face_each_other_by_angle_wherever_they_start(turned, count):
    a = Base(cylinder(arcs(TURN * np.linspace(0, 1, 5))), "u1")
    b = Base(cylinder(arcs(TURN * (np.linspace(0, 1, count + 1) + turned)), 2.0, (3.0, 4.0)), "u0")
    matched = matched_edges(a, b, "no")
    seam_a = a.derivative(np.array([a.range_along[0]]), 0, 0)[0]
    facing = b.derivative(np.array([b.range_along[0] + matched.shift]), 0, 0)[0]
    # Eleven points run up to 1.2 degrees ahead of the angle; what faces what is found on spans a fourth as long.
    assert np.degrees(np.arctan2(facing[1], facing[0]) - np.arctan2(seam_a[1], seam_a[0])) == pytest.approx(0, abs=1e-3)
