"""The limits of matched maps from both sides: how well shares are met, what counts as one, how smooth lines are."""

import numpy as np
import pytest
from scipy.interpolate import BSpline, PPoly

from semispline import OptionError
from semispline.solver.blending.matched_maps import (
    VMap,
    _length_stations,
    _rises,
    _seam_order,
    _through,
    length_map,
    point_map,
    run_by,
)
from semispline.solver.blending.sides import Side
from semispline.solver.splines import Basis, clamped

LINE = Basis(1, np.array([0.0, 0.0, 1.0, 1.0]))
# Roundings of values of size 1.
ROUNDED = 1e-12


def side(along, x):
    """A side whose rows have the given coordinates x, one beside the other."""
    rows = np.stack([np.stack([x, np.full(len(x), k), np.zeros(len(x))], axis=1) for k in range(3)])
    return Side("G2", 3, (1.0, 1.0), along, rows.astype(float), 1.0)


def straight(skew, start=0.0):
    """A straight contact of length 1 along which x = t + skew t (1 - t), t from 0 to 1."""
    knots = start + np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    return side(Basis(2, knots), np.array([0, (1 + skew) / 2, 1]))


def cubic(*coefficients, low=0.0, high=1.0, order=2):
    """A map of one piece, coefficients of powers of v - low from the third down."""
    return VMap(PPoly(np.array(coefficients, dtype=float)[:, None], np.array([low, high])), order)


def values(found, v):
    """Rows at v, by SciPy."""
    return np.stack([BSpline(found.along.knots, row, found.along.degree)(v) for row in found.rows])


def inner_counts(found):
    """Distinct inner knots, and how often each stands there."""
    knots, q = found.along.knots, found.along.degree
    return np.unique(knots[q + 1 : -q - 1], return_counts=True)


def test_shares_are_met_to_a_thousandth():
    """Affinely the shares miss each other by a quarter of the skew: below 1e-3 the map stays affine."""
    for skew, pieces in ((0.0039, 1), (0.0041, 2), (-0.0039, 1), (-0.0041, 2)):
        found = length_map(straight(0.0), straight(skew), closed=False)
        assert len(found.function.x) == pieces + 1


def test_spans_are_halved_four_times_at_most():
    """Speed jumps by a factor of a hundred at a knot of a, where b has none: no C1 map comes near it."""
    a = side(Basis(1, np.array([0.0, 0.0, 0.3, 1.0, 1.0])), np.array([0.0, 0.004, 1.0]))
    found = length_map(a, side(LINE, np.array([0.0, 1.0])), closed=False)
    assert len(found.function.x) == 2**4 + 1
    # Control: it is not met by then.
    assert abs(float(found.function(0.3)) - 0.004) > 1e-3


def test_closed_sides_without_corners_go_around():
    """The map of a closed side is as smooth where it comes back as inside; of an open one it need not be."""
    along = Basis(2, clamped([0.3, 0.6], 2, 0, 1))
    sides = side(along, np.array([0, 0.1, 0.5, 0.8, 1])), side(along, np.array([0, 0.2, 0.4, 0.9, 1]))
    around = length_map(*sides, closed=True)
    assert around.order == 2
    for found, agree in ((around, True), (length_map(*sides, closed=False), False)):
        slopes = found.function.derivative()([0.0, 1.0])
        assert bool(abs(slopes[0] - slopes[1]) < 1e-9) is agree
    # A corner that both have is one inner stop: there is an end, and corners answer each other.
    corner = Basis(1, clamped([0.25], 1, 0, 1))
    a, b = side(corner, np.array([0, 0.3, 1])), side(corner, np.array([0, 0.2, 1]))
    found = length_map(a, b, closed=True)
    assert found.order == 0
    assert found.function([0, 0.25, 1]) == pytest.approx([0, 0.25, 1], abs=ROUNDED)


@pytest.mark.parametrize("start", [0.0, 10.0])
def test_stations_within_a_millionth_of_a_stop_are_none(start):
    """Wherever the domain begins: of the stretch between the stops, not of v."""
    stations = start + np.array([0.0, 7e-7, 1.5e-6, 0.5, 1 - 1.5e-6, 1 - 7e-7, 1.0])
    _, found = _length_stations(straight(0.0, start), straight(0.0, start), start + np.array([0.0, 1.0]), stations)
    assert np.array_equal(found, stations[[0, 2, 3, 4, 6]])


def test_points_within_a_millionth_are_one():
    """Pairs need a millionth of the domain between them, on either side; those as near to an end are the end's."""
    for apart, refused in ((7e-7, True), (1.5e-6, False)):
        for pairs in ([(0.5, 0.4), (0.5 + apart, 0.6)], [(0.4, 0.5), (0.6, 0.5 + apart)]):
            for scale in (1.0, 8.0):
                basis = Basis(1, scale * LINE.knots)
                named = [(scale * x, scale * y) for x, y in pairs]
                for closed in (False, True):
                    if refused:
                        with pytest.raises(OptionError, match="cross or coincide"):
                            point_map(named, basis, closed=closed)
                    else:
                        function = point_map(named, basis, closed=closed).function
                        assert [float(function(x)) for x, _ in named] == pytest.approx([y for _, y in named], abs=1e-9)
    for near, count in ((7e-7, 2), (1.5e-6, 3)):
        for x in (near, 1 - near):
            assert len(point_map([(x, x)], LINE, closed=False).function.x) == count


def test_three_points_are_met_by_a_parabola():
    """A map through one inner point is t + c t (1 - t), C2; between stops each part is on its own, C0."""
    x, y = np.array([0.0, 0.4, 1.0]), np.array([0.0, 0.52, 1.0])
    found = _through(x, y, x[[0, 2]])
    t = np.linspace(0, 1, 11)
    assert found.order == 2
    assert found.function(t) == pytest.approx(t + 0.5 * t * (1 - t), abs=ROUNDED)
    broken = _through(x, y, x)
    assert broken.order == 0
    assert broken.function(t) == pytest.approx(np.interp(t, x, y), abs=ROUNDED)


def test_a_smooth_map_rises_by_a_fifth_of_the_mean_slope():
    """t + c t (1 - t)(1 - 2 t) has the slope 1 + c at its ends and 1 - c / 2 in the middle."""
    ends = np.array([0.0, 1.0])
    for c, rises in ((1.58, True), (1.62, False), (-0.79, True), (-0.81, False)):
        function = cubic(2 * c, -3 * c, 1 + c, 0).function
        assert _rises(function, ends, ends) is rises
    # Where it does not, the map is C1; the parabola through (x, 1/2) has the slope (1 - 2 x) / (2 x (1 - x)) + 1 there.
    for x, order in ((0.37, 2), (0.3, 1), (0.63, 2), (0.7, 1)):
        assert point_map([(x, 0.5)], LINE, closed=False).order == order


def test_slopes_at_a_seam_agree_to_a_billionth():
    """Spans of widths 1 and 3: slopes count, not differences of points."""
    for change, order in ((0.0, 1), (7e-10, 1), (-7e-10, 1), (1.5e-9, 0), (-1.5e-9, 0)):
        slope = 2.0 * (1 + change)
        pieces = np.array([[[[0.0], [2.0]]], [[[5.0], [5 + 3 * slope]]]])
        assert _seam_order(np.array([0.0, 1.0, 4.0]), pieces) == order


def test_the_degree_along_is_25_at_the_most():
    """Three times 8 is 24, three times 9 is 27."""
    same = cubic(0, 0, 1, 0)
    for q in (8, 9):
        own = side(Basis(q, clamped([], q, 0, 1)), np.linspace(0, 1, q + 1))
        if q == 9:
            with pytest.raises(OptionError, match="degree 27 along"):
                run_by(own, same)
        else:
            assert run_by(own, same).along.degree == 24


def test_a_map_that_goes_around_runs_through_all_of_a_closed_side():
    """Rows are those of the side at phi(v), one turn taken off; C1 at its seam where that is C1, else C0."""
    map_around = cubic(0.4, -0.6, 1.2, 0.3)
    for last, smooth in ((0.9, 1), (0.7, 0)):
        own = side(Basis(2, clamped([0.25, 0.5, 0.75], 2, 0, 1)), np.array([0, 0.1, 0.4, 0.5, last - 1, 0]))
        own = own if smooth == 0 else side(own.along, np.array([0, 0.1, 0.4, 0.5, -0.1, 0]))
        found = run_by(own, map_around)
        v = np.linspace(0, 1, 41)
        phi = map_around.function(v)
        assert np.abs(values(found, v) - values(own, np.where(phi > 1, phi - 1, phi))).max() < ROUNDED
        knots, counts = inner_counts(found)
        at_seam = np.abs(map_around.function(knots) - 1) < 1e-9
        assert counts[at_seam].tolist() == [6 - smooth]
        assert set(counts[~at_seam].tolist()) == {5}


def test_lines_are_as_smooth_as_side_and_map_and_c2_at_most():
    """Of degree 4 run through by a map with one break: 12 less the derivatives that agree, knot by knot."""
    q, simple, double, triple = 4, 0.2, 0.4, 0.6
    along = Basis(q, clamped([simple, double, double, triple, triple, triple], q, 0, 1))
    own = side(along, np.linspace(0, 1, along.size) ** 2)
    break_at = 0.8
    for order in (0, 1, 2):
        # The same straight map in two pieces, said to be of that order at its break.
        function = PPoly(np.array([[0, 0], [0, 0], [1, 1], [0, break_at]], dtype=float), np.array([0, break_at, 1]))
        found = run_by(own, VMap(function, order))
        knots, counts = inner_counts(found)
        assert knots == pytest.approx([simple, double, triple, break_at], abs=ROUNDED)
        # Simple knots of degree 4 are C3: C2 is all that is kept.
        assert (12 - counts).tolist() == [2, 2, 1, order]
        v = np.linspace(0, 1, 31)
        assert np.abs(values(found, v) - values(own, v)).max() < ROUNDED


def test_breaks_of_map_and_side_within_1e_12_are_one():
    """A break of the map below a double knot of a cubic side: one line, as rough as both; further off there are two."""
    own = side(Basis(3, clamped([0.5, 0.5], 3, 0, 1)), np.array([0, 0.2, 0.4, 0.6, 0.8, 1]))
    for apart, counts in ((3e-13, [8]), (3e-11, [7, 8])):
        at = 0.5 - apart
        function = PPoly(np.array([[0, 0], [0, 0], [1, 1], [0, at]], dtype=float), np.array([0, at, 1]))
        assert inner_counts(run_by(own, VMap(function, 2)))[1].tolist() == counts
    # A simple knot below a break of a map that is C1 there.
    own = side(Basis(3, clamped([0.5], 3, 0, 1)), np.array([0, 0.2, 0.5, 0.8, 1]))
    for apart, counts in ((3e-13, [8]), (3e-11, [7, 8])):
        at = 0.5 + apart
        function = PPoly(np.array([[0, 0], [0, 0], [1, 1], [0, at]], dtype=float), np.array([0, at, 1]))
        assert inner_counts(run_by(own, VMap(function, 1)))[1].tolist() == counts
