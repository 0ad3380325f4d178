"""Bases that are G1 at a knot line of their own: the blend has no crease there, and keeps its contact."""

from math import comb

import numpy as np
import pytest
from scipy.interpolate import BSpline

from helpers.array_blends import SPANS as BLEND_SPANS
from helpers.array_blends import Blend
from helpers.knot_lines import least_continuity
from semispline.solver.blending.jumps import jumps
from semispline.solver.blending.knot_lines import knot_lines
from semispline.solver.blending.own_lines import closed_lines, line_series
from semispline.solver.blending.weights import end_derivatives, normalised_rows
from semispline.solver.splines import Basis, basis_matrix, clamped, elevation_matrix, refinement_matrix
from semispline.solver.splines.refinement import elevated_knots

SPANS = (1.0, 1.0, 1.0, 1.0)
TURN = 2 * np.pi


def bezier_points(function, degree, start, end):
    """Bezier points of a polynomial function over a span, by interpolation; they go along the first axis."""
    t = (1 - np.cos(np.linspace(0, np.pi, degree + 1))) / 2
    matrix = np.stack([comb(degree, k) * t**k * (1 - t) ** (degree - k) for k in range(degree + 1)], axis=1)
    values = np.array([function(start + (end - start) * x) for x in t])
    return np.linalg.solve(matrix, values.reshape(degree + 1, -1)).reshape(values.shape)


def sheet(x, y):
    return np.array([x, y, 0.3 * x * y + 0.2 * y * y - 0.1 * x * x + 5.0])


def two_pieces(speed=0.6, bend=0.5, lean=0.7, fold=0.0, rational=False, spans=1, weight=0.3):
    """One smooth sheet in two pieces: degree 6 across, 4 along; at v = 1 speeds s = speed + bend w, r = lean w."""

    def before(w, v):
        return sheet(w, v), 1 + 0.1 * w + 0.2 * v

    def after(w, v):
        place = sheet(w + lean * w * (v - 1), 1 + (v - 1) * (speed + bend * w))
        place[2] += fold * w * (v - 1)
        return place, 1.2 + 0.1 * w + (v - 1) * (weight + 0.2 * w)

    def piece(function, start, end):
        def point(w, v):
            place, weight = function(w, v)
            return np.append(place * weight, weight) if rational else place

        return bezier_points(lambda v: bezier_points(lambda w: point(w, v), 6, 0, 1), degree, start, end)

    degree = 4
    rows = np.concatenate([piece(before, 0, 1), piece(after, 1, 2)[1:]]).transpose(1, 0, 2)
    knots = clamped(np.ones(degree), degree, 0, 2)
    if spans > 1:
        more = np.sort(np.concatenate([knots, 1 + np.arange(1, spans) / spans]))
        rows, knots = np.array([refinement_matrix(degree, knots, more) @ row for row in rows]), more
    return rows, Basis(degree, knots)


@pytest.mark.parametrize("rational", [False, True])
def test_series_of_a_line(rational):
    rows, along = two_pieces(rational=rational)
    jets = np.einsum("dk,knc->dnc", end_derivatives(3, 6, SPANS), rows[:4])
    (series,) = line_series(jets, along)
    assert series.v == 1
    assert series.speed == pytest.approx([0.6, 0.5, 0, 0], abs=1e-9)
    assert series.across == pytest.approx([0, 0.7, 0, 0], abs=1e-8)
    if not rational:
        assert (series.slope == 0).all()


@pytest.mark.parametrize("spans", [1, 2])
@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_the_line_is_closed(order, rational, spans):
    rows, along = two_pieces(rational=rational, spans=spans)
    (jump,) = jumps(rows[: order + 1], along, 6, SPANS)
    assert jump.kind == "G1"
    new, basis, degree = closed_lines(rows[: order + 1], along, 6, SPANS)
    assert degree == 6
    assert basis.degree == 4 + (order + rational) * (2 if spans == 1 else 4)
    lines = knot_lines(new, basis, 2)
    assert [line.continuity >= 1 for line in lines] == [True] * spans
    # A knot inside the smooth second piece stays C2, by its multiplicity.
    assert [line.continuity for line in lines[1:]] == [2] * (spans - 1)
    assert [int(np.sum(basis.knots == line.v)) for line in lines[1:]] == [basis.degree - 2] * (spans - 1)
    # The edge, and the surface beside the other end, stay.
    for end, at in ((0, 0), (-1, -1)):
        one, other = new[:, end], rows[: order + 1, at]
        assert one == pytest.approx(other, abs=1e-9)


@pytest.mark.parametrize("spans", [1, 2])
@pytest.mark.parametrize("rational", [False, True])
def test_blends_have_no_crease_and_keep_their_contact(rational, spans):
    rows, along = two_pieces(rational=rational, spans=spans)
    other, other_along = two_pieces(speed=1.0, bend=0.0, lean=0.0)
    other[..., 0] = -2 - other[..., 0]
    if not rational:
        rows = np.concatenate([rows, np.ones((*rows.shape[:2], 1))], axis=-1)
    other = np.concatenate([other, np.ones((*other.shape[:2], 1))], axis=-1)

    def side(found):
        new, basis, degree = found
        return (*normalised_rows(new, basis, degree, BLEND_SPANS)[:1], basis, degree)

    far = side((other[:3], other_along, 6))
    raw = Blend(side((rows[:3], along, 6)), far, (0.5, 0.5))
    assert raw.inside(closed=False)[0] > 0.3
    found = closed_lines(rows[:3], along, 6, SPANS)
    blend = Blend(side(found), far, (0.5, 0.5))
    assert blend.inside(closed=False)[0] < 1e-9
    gap, angle, curvature = blend.contact(0, rows, along, 6)
    assert gap < 1e-12
    assert angle < 1e-9
    assert curvature < 1e-9


def closed_ring(bend):
    """A smooth ring, quadratic across; its last span is run through by v + bend w (v - 0.9) (1 - v)."""
    angles = np.linspace(0, TURN, 12)[:-1]
    tube = np.stack([np.stack([np.cos(angles), 1.2 * np.sin(angles), 0 * angles + k], -1) for k in range(3)])
    tube *= np.array([1, 1.2, 1.3])[:, None, None]
    periodic = np.concatenate([tube, tube[:, :3]], axis=1)
    uniform = BSpline(np.arange(-3.0, 15.0), periodic.transpose(1, 0, 2), 3)

    def point(w, v):
        v = v + bend * w * (v - 10) * (11 - v) * (v >= 10)
        low, middle, high = uniform(v)
        return low * (1 - w) ** 2 + middle * 2 * w * (1 - w) + high * w * w

    def piece(k):
        # From inside, so that the ends belong to this span.
        return bezier_points(lambda v: bezier_points(lambda w: point(w, v), 5, 0, 1), 6, k, k + 1)

    rows = np.concatenate([piece(0)[:1], *(piece(k)[1:] for k in range(11))]).transpose(1, 0, 2)
    return rows, Basis(6, clamped(np.repeat(np.arange(1, 11), 6), 6, 0, 11))


@pytest.mark.parametrize("order", [1, 2])
def test_a_seam_is_closed_too(order):
    rows, along = closed_ring(0.3)
    rows = rows[: order + 1]
    found = jumps(rows, along, 5, SPANS, closed=True)
    assert [(jump.v, jump.kind) for jump in found] == [(10, "G1"), (0, "G1")]
    new, basis, _ = closed_lines(rows, along, 5, SPANS, closed=True)
    assert least_continuity(new, basis, closed=True) >= 1


@pytest.mark.parametrize("size", [1.0, 1e3])
@pytest.mark.parametrize("fold", [1e-9, 2.5e-8, 1e-5])
def test_a_base_that_is_creased_itself_is_refused(fold, size):
    rows, along = two_pieces(fold=fold)
    rows *= size
    found = closed_lines(rows[:3], along, 6, SPANS)
    assert (found is not None) is (fold < 1e-8)
    # The crease begins at the edge with the angle 0, where `jumps` measures it.
    assert jumps(rows[:3], along, 6, SPANS)[0].degrees < 1e-6


@pytest.mark.parametrize(("lean", "folds"), [(3.0, False), (5.5, True), (9.0, True)])
def test_a_reparametrisation_that_would_fold_is_refused(lean, folds):
    rows, along = two_pieces(lean=lean)
    assert (closed_lines(rows[:2], along, 6, SPANS) is None) is folds


@pytest.mark.parametrize(("weight", "vanishes"), [(0.3, False), (9.0, True)])
def test_a_factor_that_would_vanish_is_refused(weight, vanishes):
    rows, along = two_pieces(rational=True, weight=weight)
    assert (closed_lines(rows[:2], along, 6, SPANS) is None) is vanishes


def test_a_base_that_runs_back_is_refused():
    rows, along = two_pieces(speed=-0.5, bend=0.0)
    assert closed_lines(rows[:2], along, 6, SPANS) is None


def test_two_lines_are_closed_each_by_its_own_speed():
    # Run through at speeds 1, 0.6 + w / 2 and (0.6 + w / 2) (1.4 - 0.3 w), leaning more at each line.
    def point(w, v):
        second, third = 0.6 + 0.5 * w, (0.6 + 0.5 * w) * (1.4 - 0.3 * w)
        x = w * (1 + 0.7 * np.clip(v - 1, 0, 1) + 0.3 * max(v - 2, 0))
        return sheet(x, min(v, 1) + second * np.clip(v - 1, 0, 1) + third * max(v - 2, 0))

    pieces = [bezier_points(lambda v: bezier_points(lambda w: point(w, v), 4, 0, 1), 2, k, k + 1) for k in range(3)]
    rows = np.concatenate([pieces[0], pieces[1][1:], pieces[2][1:]]).transpose(1, 0, 2)[:3]
    along = Basis(2, clamped([1, 1, 2, 2], 2, 0, 3))
    assert [jump.kind for jump in jumps(rows, along, 4, SPANS)] == ["G1", "G1"]
    new, basis, degree = closed_lines(rows, along, 4, SPANS)
    assert least_continuity(new, basis) >= 1
    # To second order it stays on the sheet, whose height less `sheet` is zero.
    values = basis_matrix(basis.degree, basis.knots, np.linspace(0, 3, 40))
    place, first, second = np.einsum("dk,vn,knc->dvc", end_derivatives(2, degree, SPANS), values.toarray(), new)
    x, y, _ = place.T
    slope = np.stack([0.2 * x - 0.3 * y, -0.3 * x - 0.4 * y, np.ones_like(x)], axis=1)
    bend = np.array([[0.2, -0.3, 0], [-0.3, -0.4, 0], [0, 0, 0]])
    assert np.abs(np.sum(slope * first, axis=1)).max() < 1e-9
    assert np.abs(np.sum(slope * second, axis=1) + np.einsum("vi,ij,vj->v", first, bend, first)).max() < 1e-9


def test_smooth_rows_and_rows_of_position_alone():
    rows, along = two_pieces(speed=1.0, bend=0.0, lean=0.0)
    assert least_continuity(rows[:3], along) >= 1
    raised = Basis(5, elevated_knots(along.knots))
    rows = np.array([elevation_matrix(4, along.knots, 5) @ row for row in rows])
    assert line_series(rows[:3], raised) == ()
    assert closed_lines(rows[:1], raised, 6, SPANS) is None
