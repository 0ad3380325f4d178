"""Knot lines where a base is only continuous: told apart; smoothed, as the same surface, where rows share the jump."""

import numpy as np
import pytest

from helpers.cases import CASES
from helpers.conics import standard_arcs
from helpers.knot_lines import least_continuity
from helpers.same_surface import departure
from semispline import read_surface
from semispline.solver.blending.jumps import jumps, smoothed
from semispline.solver.blending.knot_lines import KnotLine
from semispline.solver.splines import Basis, basis_matrix, clamped, refinement_matrix
from semispline.solver.splines.products import multiply

SPANS = (1.0, 1.5, 2.0)
CUTS = np.array([0.0, 0.3, 0.55, 1.0])


def smooth_base(rng, *, rational=False, closed=False, count=3):
    """C2 cubic rows with knots at the cuts, and between them."""
    along = Basis(3, clamped([0.1, 0.3, 0.55, 0.7, 0.9], 3, 0, 1))
    v = np.array([along.knots[j + 1 : j + 4].mean() for j in range(along.size)])
    rows = np.stack([np.stack([np.cos(5 * v), np.sin(5 * v), 0 * v + k], axis=-1) * (1 + k / 3) for k in range(count)])
    rows += rng.uniform(-0.05, 0.05, rows.shape)
    if rational:
        weights = np.exp(rng.uniform(-0.2, 0.2, rows.shape[:2]))
        rows = np.concatenate([rows * weights[..., None], weights[..., None]], axis=-1)
    if closed:
        # Equal derivatives at both ends, whose spans are equal.
        rows[:, -1] = rows[:, 0]
        rows[:, -2] = 2 * rows[:, 0] - rows[:, 1]
    return rows, along


def with_jumps(rows, along, factors, weights=None):
    """The same surface with each piece between cuts stretched by a factor, and times a broken line over the cuts."""
    full = clamped(np.repeat(along.knots[4:-4], [3 if v in CUTS else 1 for v in along.knots[4:-4]]), 3, 0, 1)
    matrix = refinement_matrix(3, along.knots, full)
    rows, basis = np.array([matrix @ row for row in rows]), Basis(3, full)
    if weights is not None:
        line = Basis(1, clamped(CUTS[1:-1], 1, 0, 1))
        found = [multiply(basis, row, line, np.array(weights)[:, None]) for row in rows]
        basis, rows = found[0][0], np.array([points for _, points in found])
    places = np.concatenate([[0], np.cumsum(np.diff(CUTS) * factors)])
    segment = np.clip(np.searchsorted(CUTS, basis.knots, side="right") - 1, 0, len(CUTS) - 2)
    knots = places[segment] + (basis.knots - CUTS[segment]) * np.array(factors)[segment]
    for cut, place in zip(CUTS, places, strict=True):
        knots[basis.knots == cut] = place
    return rows, Basis(basis.degree, knots)


def test_the_case_whose_speed_jumps():
    surface = read_surface(CASES / "speeds_straight.json")
    rows, along = surface.control_points[::-1], Basis(surface.degree_v, surface.knots_v)
    (jump,) = jumps(rows, along, surface.degree_u, SPANS)
    assert (jump.kind, jump.v, jump.degrees) == ("shared", 0.5, 0.0)
    assert jump.speed == pytest.approx(3, abs=1e-12)
    new, basis = smoothed(rows, along, (jump,))
    assert basis.knots[4:-4] == pytest.approx([0.25, 0.25], abs=1e-15)
    assert least_continuity(new, basis) >= 1
    assert departure((rows, along), (new, basis)) < 1e-13


# Closed rows end where they begin.
@pytest.mark.parametrize(
    ("weights", "closed"),
    [
        (None, False),
        (None, True),
        ([1.0, 1.3, 0.9, 1.0], False),
        ([1.0, 1.3, 0.9, 1.0], True),
        ([1.0, 1.3, 0.9, 1.2], False),
    ],
)
@pytest.mark.parametrize("factors", [(1.0, 1.0, 1.0), (1.0, 0.4, 1.0), (1.0, 2.0, 0.7)])
def test_shared_jumps_are_smoothed(factors, weights, closed):
    rng = np.random.default_rng(1)
    smooth, smooth_along = smooth_base(rng, rational=weights is not None, closed=closed)
    assert jumps(smooth, smooth_along, 3, SPANS, closed=closed) == ()
    rows, along = with_jumps(smooth, smooth_along, factors, weights)
    found = jumps(rows, along, 3, SPANS, closed=closed)
    if factors == (1.0, 1.0, 1.0) and weights is None:
        assert found == ()
        return
    assert all(jump.kind == "shared" for jump in found)
    assert max(jump.degrees for jump in found) < 1e-9
    by_place = {jump.v: jump for jump in found}
    for k in (1, 2):
        if weights is None and factors[k] == factors[k - 1]:
            continue
        jump = by_place[along.knots[np.argmin(np.abs(along.knots - np.cumsum(np.diff(CUTS) * factors)[k - 1]))]]
        assert jump.speed == pytest.approx(factors[k - 1] / factors[k], rel=1e-9)
    new, basis = smoothed(rows, along, found, closed=closed)
    assert jumps(new, basis, 3, SPANS, closed=closed) == ()
    assert least_continuity(new, basis, closed=closed) >= 1
    assert departure((rows, along), (new, basis)) < 1e-12
    assert (basis.knots[0], basis.knots[-1]) == (along.knots[0], along.knots[-1])
    if weights is None:
        # The same knots again, each cut of them one more than before.
        assert basis.degree == 3
        assert basis.size == smooth_along.size + 2
    else:
        assert basis.degree - along.degree in (2, 3)
        assert new[:, :, 3].min() > 0


@pytest.mark.parametrize("rational", [False, True])
def test_a_closed_profile_whose_speeds_do_not_come_back(rational):
    # Both pieces begin slower than they end: the product of the jumps is not 1.
    quarter = np.array([[1, 0, 0], [1, 0.5, 0], [0.6, 1, 0], [-0.3, 1, 0]])
    other = np.array([[-0.3, 1, 0], [-0.7, 1, 0], [-3, -4.0, 0], [1, -1.5, 0], [1, -1.0, 0], [1, 0, 0]])
    # Degree 3 and 5: both as one cubic spline of two and three spans.
    second = Basis(3, clamped([0.3, 0.6], 3, 0, 1))
    knots = np.concatenate([[0] * 4, [1] * 3, 1 + second.knots[4:]])
    profile = np.concatenate([quarter, other[1:]])
    up = np.array([0, 0, 1.0])
    rows = np.stack([profile, profile + up, 1.1 * profile + 2 * up])
    along = Basis(3, knots)
    if rational:
        weights = np.array([1, 1.2, 0.9, 0.8, 0.9, 1.1, 1.2, 0.9, 1])[:, None] * np.ones((3, 1, 1))
        rows = np.concatenate([rows * weights, weights], axis=-1)
    found = jumps(rows, along, 3, SPANS, closed=True)
    assert [jump.kind for jump in found] == ["shared"] * 2
    product = found[0].speed * found[1].speed
    assert abs(np.log(product)) > 0.5
    new, basis = smoothed(rows, along, found, closed=True)
    assert basis.degree == (9 if rational else 6)
    assert jumps(new, basis, 3, SPANS, closed=True) == ()
    assert departure((rows, along), (new, basis)) < 1e-12
    # The spline's own knots stay as smooth as they were.
    inner, counts = np.unique(basis.knots[basis.degree + 1 : -basis.degree - 1], return_counts=True)
    assert counts.tolist() == ([8, 7, 7] if rational else [5, 4, 4])
    assert np.isin(inner, along.knots).sum() == 0


@pytest.mark.parametrize(("middle", "cured"), [(1.9, True), (2.1, False)])
def test_weights_that_rise_too_steeply_stay(middle, cured):
    # Weights 1, m, 1, m, 1: lambda falls to 1 - (m - 1) between them.
    weights = np.array([1, middle, 1, middle, 1])[:, None]
    points = np.array([[-2, 1, 0], [-1, 0, 0], [0, 0, 0], [1, 0, 0], [2.0, 1, 0]])
    rows = np.stack([np.concatenate([weights * (points + np.array([0, 0, k])), weights], axis=1) for k in range(2)])
    along = Basis(2, clamped([1.0, 1.0], 2, 0, 2))
    found = jumps(rows, along, 1, SPANS)
    assert [jump.kind for jump in found] == ["shared"]
    new, basis = smoothed(rows, along, found)
    assert (basis.degree == 4) is cured
    assert (new is rows) is not cured


def test_unequal_arcs_whose_weights_jump_apart_from_conics():
    # Two arcs of different circles with one tangent: no conic, but a shared jump in each row.
    one, two = standard_arcs([0, np.pi / 2])[1], standard_arcs([0, np.pi / 3])[1]
    turn = np.array([[0, 2, 0], [-2, 0, 0], [0, -1.0, 1]])
    points = np.concatenate([one, (two @ turn)[1:]])
    rows = np.zeros((2, 5, 4))
    rows[..., 0], rows[..., 1], rows[..., 3] = points.T
    rows[1, :, 2] = points[:, 2]
    along = Basis(2, clamped([1.0, 1.0], 2, 0, 2))
    (jump,) = jumps(rows, along, 1, SPANS)
    assert jump.kind == "shared"
    assert jump.degrees < 1e-9
    new, basis = smoothed(rows, along, (jump,))
    assert basis.degree == 4
    assert jumps(new, basis, 1, SPANS) == ()
    assert departure((rows, along), (new, basis)) < 1e-12


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("degrees", [0.0, 1e-4, 1e-8, 5.0])
def test_lines_that_are_g1_or_creased(degrees, rational):
    along = Basis(2, clamped([1.0, 1.0], 2, 0, 2))
    slope = np.tan(np.radians(degrees))
    rows = np.zeros((2, 5, 3))
    # Row 1 turns its speed by another factor than row 0; the sheet folds about the line.
    rows[0] = [[-1, 0, 0], [-0.5, 0, 0], [0, 0, 0], [1, 0, slope], [3, 0, 2 * slope]]
    rows[1] = [[-1, 1, 0], [-0.5, 1, 0], [0, 1, 0], [0.7, 1, 0.7 * slope], [3, 1, 3 * slope]]
    rows += np.array([10.0, -3.0, 4.0])
    if rational:
        weights = 1 + 0.2 * np.sin(np.arange(10)).reshape(2, 5)
        rows = np.concatenate([rows * weights[..., None], weights[..., None]], axis=-1)
    (jump,) = jumps(rows, along, 1, SPANS)
    assert jump.kind == ("G1" if degrees < 1e-6 else "creased")
    assert jump.degrees == pytest.approx(degrees, rel=1e-6, abs=1e-9)
    assert (jump.speed, jump.slope) == (1.0, 0.0)
    assert smoothed(rows, along, (jump,)) == (rows, along)


def test_one_row_has_the_angle_of_its_tangents():
    rows = np.array([[[0, 0, 0], [1, 0, 0], [2, 1.0, 0]]])
    (jump,) = jumps(rows, Basis(1, np.array([0, 0, 1, 2, 2.0])), 1, SPANS)
    assert (jump.kind, jump.degrees) == ("creased", pytest.approx(45))


def test_a_turned_back_speed_is_no_shared_jump():
    rows = np.array([[[0, 0, 0], [1, 0, 0], [0.5, 0.0, 0]], [[0, 0, 1], [1, 0, 1], [0.5, 0.0, 1]]])
    (jump,) = jumps(rows, Basis(1, np.array([0, 0, 1, 2, 2.0])), 1, SPANS)
    assert (jump.kind, jump.degrees) == ("creased", pytest.approx(180))


def test_values_on_a_broken_line_are_those_of_a_line():
    rows = np.array([[[0, 0, 0], [1, 0, 0], [4, 0.0, 0]], [[0, 0, 1], [1, 0, 1], [4, 0.0, 1]]])
    along = Basis(1, np.array([0, 0, 1, 2, 2.0]))
    new, basis = smoothed(rows, along, jumps(rows, along, 1, SPANS))
    assert basis.knots.tolist() == [0, 0, 2, 2]
    assert basis_matrix(1, basis.knots, np.array([0.5])) @ new[1] == pytest.approx(np.array([[1, 0, 1]]))


def test_what_the_multiplicity_of_a_knot_promises_is_not_measured():
    one, other = np.zeros((3, 1, 3)), np.array([[[0.0] * 3], [[1.0] * 3], [[1.0] * 3]])
    assert [KnotLine(0.5, one, other, np.zeros(3), sure).continuity for sure in (-1, 0, 1, 2)] == [0, 0, 1, 2]


def test_rounding_makes_no_jump():
    rng = np.random.default_rng(5)
    # Knots that are simple are smooth, however near the next one is.
    along = Basis(3, clamped([0.5, 0.5 + 1e-9], 3, 0, 1))
    rows = rng.uniform(-1, 1, (3, 6, 3)) + 1e6
    assert jumps(rows, along, 3, SPANS) == ()
    # A seam is as smooth as the rounding of its coordinates tells, wherever they are counted from now.
    rows, along = smooth_base(rng, closed=True)
    far = rows + 1e9
    assert jumps(far, along, 3, SPANS, closed=True) == ()
    assert jumps(far - 1e9, along, 3, SPANS, closed=True) != ()
    assert jumps(far - 1e9, along, 3, SPANS, closed=True, largest=1e9) == ()
