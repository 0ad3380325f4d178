"""Area element, and what is proved of it: known answers, and in parts as at once."""

import numpy as np
import pytest
from hypothesis import given

from helpers.bases import facing_pair
from helpers.papers_set import blend
from helpers.splines import surfaces
from helpers.sweeps import examples
from semispline import BSplineCurve, BSplineSurface, SemiStructuredSurface, elevate_degree, measure_regularity, revolve
from semispline.solver.judge import bezier_pieces, regularity
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.judge.regularity import area_bound
from semispline.solver.splines.knots import clamped, greville

BEZIER_1, BEZIER_2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]


def test_nothing_is_proved_of_a_fold():
    flat = BSplineSurface(2, 1, BEZIER_2, BEZIER_1, [[[u, v, 0.0] for v in (0, 1)] for u in (0, 0.5, 1)])
    assert measure_regularity(flat).least_area_ratio == pytest.approx(1)
    assert measure_regularity(flat).proved_area_ratio == pytest.approx(1)
    net = [[[u, v, 0.0] for v in (0, 1)] for u in (0, 1, 0.2)]
    folded = measure_regularity(BSplineSurface(2, 1, BEZIER_2, BEZIER_1, net))
    # Samples miss where the area element vanishes.
    assert folded.least_area_ratio < 0.2
    assert folded.proved_area_ratio is None


@pytest.mark.parametrize("seed", range(8))
def test_a_proved_bound_is_below_every_sample(seed):
    surface = blend(*facing_pair(np.random.default_rng(seed), planar=seed == 0), alpha="natural").surface
    bound = area_bound(surface)
    u, v = (np.linspace(*ends, 41) for ends in surface.domain)
    cross = np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
    assert bound <= np.linalg.norm(cross, axis=2).min() * (1 + 1e-12)
    if seed == 0:
        assert bound > 0


def test_the_bound_is_exact_for_a_bilinear_patch():
    # X = (u (1 + v), v, 0): P_u x P_v = (0, 0, 1 + v), least 1 and linear.
    net = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [2, 1, 0]]]
    assert area_bound(BSplineSurface(1, 1, BEZIER_1, BEZIER_1, net)) == pytest.approx(1, rel=1e-14)


def test_nothing_is_proved_where_a_piece_has_no_mean_normal():
    # There and back: P_u = 2 - 4 u.
    net = [[[x, v, 0.0] for v in (0, 1)] for x in (0, 1, 0)]
    assert area_bound(BSplineSurface(2, 1, BEZIER_2, BEZIER_1, net)) == 0
    # In the second of two pieces.
    net = [[[x, v, 0.0] for v in (0, 1)] for x in (0, 1, 2, 3, 2)]
    assert area_bound(BSplineSurface(2, 1, [0, 0, 0, 1, 1, 2, 2, 2], BEZIER_1, net)) == 0
    # A bound below 1 is one as well.
    small = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, 0.1 * np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]))
    assert area_bound(small) == pytest.approx(0.01)
    assert measure_regularity(small).proved_area_ratio == pytest.approx(1)


@pytest.mark.parametrize("heights", [(0, 0.5, 0.7), (0, 0.2, 0.7)])
def test_the_bound_is_that_of_the_least_part(monkeypatch, heights):
    monkeypatch.setattr(bezier_pieces, "_PIECES_AT_ONCE", 1)
    net = [[[x, y, 0] for y in heights] for x in (0, 1)]
    assert area_bound(BSplineSurface(1, 1, BEZIER_1, [0, 0, 1, 2, 2], net)) == pytest.approx(0.2)


def by_referee(surface):
    """The measure from the referee, at the samples that `Regularity` promises: 8 in every span and the ends."""
    u, v = (
        np.append((x[:-1, None] + np.diff(x)[:, None] * np.arange(8) / 8).ravel(), x[-1]) for x in surface.breakpoints
    )
    uu, vv = (x.ravel() for x in np.meshgrid(u, v, indexing="ij"))
    cross = np.cross(surface_points(surface, uu, vv, 1, 0), surface_points(surface, uu, vv, 0, 1))
    area = np.linalg.norm(cross, axis=1)
    return area.min() / area.mean()


@examples(40)
@given(surfaces())
def test_the_measure_is_that_of_the_referee_at_every_sample(surface):
    with np.errstate(all="ignore"):
        least = by_referee(surface)
    found = measure_regularity(surface)
    if not least > 1e-9:
        # No normal there, to rounding: nothing to compare but the refusal to call it regular.
        assert found.least_area_ratio <= 1e-8
        return
    # Rounding of P_u x P_v, next to its mean, is enlarged by narrow spans.
    assert found.least_area_ratio == pytest.approx(least, rel=1e-6)


def test_a_rational_surface_is_measured_and_proved():
    profile = BSplineCurve(2, BEZIER_2, [[2, 0, 0], [3, 0, 1], [2, 0, 2]])
    vase = revolve(profile, [0, 0, 0], [0, 0, 1], 90)
    found = measure_regularity(vase)
    assert found.least_area_ratio == pytest.approx(by_referee(vase), rel=1e-12)
    assert 0.4 * found.least_area_ratio < found.proved_area_ratio <= found.least_area_ratio
    assert area_bound(vase) > 0


def long_strip(spans, dent=(0, 0), depth=0.0):
    """A waved semi-structured strip, spans of length 1; a control point of its middle row is moved along v."""
    inner = (np.arange(1.0, spans), np.arange(0.5, spans), np.arange(1.0, spans))
    curves = []
    for x, knots in enumerate(inner):
        vector = clamped(knots, 3, 0.0, float(spans))
        y = greville(vector, 3)
        curves.append(np.column_stack([np.full_like(y, x), y, np.sin(y + x)]))
    curves[1][dent] += depth
    vectors = [clamped(knots, 3, 0.0, float(spans)) for knots in inner]
    return SemiStructuredSurface(
        2, BEZIER_2, [BSplineCurve(3, vector, row) for vector, row in zip(vectors, curves, strict=True)]
    )


@pytest.mark.parametrize("at_once", [1, 7, 64])
def test_measured_in_parts_as_measured_at_once(monkeypatch, at_once):
    surface = long_strip(60, (30, 1), 0.4)
    found = []
    for size in (10**9, at_once):
        monkeypatch.setattr(bezier_pieces, "_PIECES_AT_ONCE", size)
        monkeypatch.setattr(regularity, "_SAMPLES_AT_ONCE", 17 * size)
        found.append(measure_regularity(surface))
    whole, parts = found
    # The same arithmetic but for the order of a sum, and for how BLAS takes the last few numbers.
    assert parts.least_area_ratio == pytest.approx(whole.least_area_ratio, rel=1e-12)
    assert parts.proved_area_ratio == pytest.approx(whole.proved_area_ratio, rel=1e-12)
    assert whole.proved_area_ratio > 0


@pytest.mark.parametrize("at_once", [1, 7, 1024])
@pytest.mark.parametrize("place", [(0, 1), (-1, 1)])
def test_a_fold_at_either_end_of_a_long_strip_is_seen(monkeypatch, at_once, place):
    monkeypatch.setattr(bezier_pieces, "_PIECES_AT_ONCE", at_once)
    spans = 2500 if at_once == 1024 else 50
    assert measure_regularity(long_strip(spans)).proved_area_ratio > 0
    folded = measure_regularity(long_strip(spans, place, 3.0 if place[0] == 0 else -3.0))
    assert folded.proved_area_ratio is None


def test_knots_that_nearly_agree_are_one_span():
    # Row 0 has a knot 2e-13 after that of row 1: the merged span begins at the earlier one, inside row 0's last piece.
    rng = np.random.default_rng(1)
    curves = [
        BSplineCurve(2, [0, 0, 0, t, 1, 1, 1], [[x, y, 0.3 * rng.uniform()] for y in range(4)])
        for x, t in enumerate((0.5 + 2e-13, 0.5))
    ]
    near = measure_regularity(SemiStructuredSurface(1, BEZIER_1, curves))
    exact = [BSplineCurve(2, [0, 0, 0, 0.5, 1, 1, 1], c.control_points) for c in curves]
    same = measure_regularity(SemiStructuredSurface(1, BEZIER_1, exact))
    assert near.least_area_ratio == pytest.approx(same.least_area_ratio, rel=1e-11)
    assert near.proved_area_ratio == pytest.approx(same.proved_area_ratio, rel=1e-11)


@pytest.mark.parametrize("degrees", [(9, 10), (9, 15), (9, 20), (9, 25)])
def test_high_degrees_do_not_overflow(degrees):
    """A flat square, elevated: its area element is 1, and whole numbers of 64 bits would not hold the products."""
    square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    found = measure_regularity(elevate_degree(square, *degrees).to_semistructured())
    assert found.proved_area_ratio == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("bound", "proved"), [(-0.5, None), (0.5, 0.5)])
def test_a_bound_that_is_not_positive_proves_nothing(monkeypatch, bound, proved):
    monkeypatch.setattr(regularity, "area_bound", lambda surface: bound)
    flat = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[x, y, 0] for y in (0, 1)] for x in (0, 1)])
    assert regularity.measure_regularity(flat).proved_area_ratio == proved
