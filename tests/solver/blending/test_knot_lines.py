"""What counts as one derivative on both sides of a knot line, and which jumps both sides of a blend share."""

from types import SimpleNamespace

import numpy as np
import pytest

from semispline.solver.blending import shape_parameters
from semispline.solver.blending.jumps import jumps
from semispline.solver.blending.knot_lines import knot_lines
from semispline.solver.blending.representative import _jump_alike, has_free_rows
from semispline.solver.options import BlendOptions
from semispline.solver.splines import Basis

EPS = float(np.finfo(float).eps)
UNEVEN = Basis(1, np.array([0, 0, 1, 3, 3.0]))


@pytest.mark.parametrize("size", [1.0, 1e-9])
def test_sixteen_roundings_of_the_largest_coordinate_over_the_shorter_span(size):
    inner, seam = knot_lines(size * np.array([[[0.0], [1.0], [3.0]]]), UNEVEN, 1, closed=True)
    # A slope is a difference of two control points over a span of 1, or 2.
    expected = 16 * EPS * 3 * size * np.array([1, 2])
    assert inner.rounding == pytest.approx(expected, rel=1e-12)
    assert seam.rounding == pytest.approx(expected, rel=1e-12)


def test_rows_that_were_larger_are_rounded_more():
    (line,) = knot_lines(np.array([[[0.0], [1.0], [3.0]]]), UNEVEN, 0, largest=12.0)
    assert line.rounding == pytest.approx([16 * EPS * 12], rel=1e-12)


@pytest.mark.parametrize(("excess", "continuity"), [(1e-10, 1), (1e-8, 0)])
def test_slopes_are_one_up_to_a_billionth(excess, continuity):
    (line,) = knot_lines(np.array([[[0.0], [1.0], [3.0 + 2 * excess]]]), UNEVEN, 1)
    assert line.continuity == continuity


def test_a_kink_in_a_plane_is_no_crease_where_there_is_a_second_row():
    edge = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0.0]])
    inwards = edge + np.array([-0.5, 0.5, 0])
    (alone,) = jumps(edge[None], UNEVEN, 1, (1.0,))
    (together,) = jumps(np.stack([edge, inwards]), UNEVEN, 1, (1.0,))
    assert (alone.kind, alone.degrees) == ("creased", pytest.approx(90, abs=1e-12))
    assert (together.kind, together.degrees) == ("G1", pytest.approx(0, abs=1e-12))


def test_ends_that_are_apart_share_nothing():
    straight = np.array([[[0, 0, 0], [1, 0, 0], [3, 0, 0.0]]])
    (seam,) = jumps(straight, UNEVEN, 1, (1.0,), closed=True)
    assert seam.kind != "shared"


def sides(**change):
    """Two sides with one shared jump each, over a domain of length 2, the second one's changed."""
    one = {"kind": "shared", "v": 0.5, "speed": 4.0, "slope": 3.0}
    found = [SimpleNamespace(cure="spans", found=(SimpleNamespace(**jump),)) for jump in (one, one | change)]
    side = SimpleNamespace(along=Basis(1, np.array([0, 0, 2.0, 2])))
    return side, side, *found


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("name", "value", "unit"), [("v", 0.5, 2.0), ("speed", 4.0, 4.0), ("slope", 3.0, 0.5)])
@pytest.mark.parametrize(("times", "alike"), [(1e-10, True), (1e-8, False)])
def test_jumps_are_alike_up_to_a_billionth(name, value, unit, times, alike, sign):
    assert _jump_alike(*sides(**{name: value + sign * times * unit})) is alike


def test_jumps_of_other_kinds_are_not_alike():
    assert _jump_alike(*sides())
    assert not _jump_alike(*sides(kind="G1"))


@pytest.mark.parametrize(
    ("continuities", "middle", "free"),
    [(("G2", "G2"), 0, False), (("G3", "G2"), 0, False), (("G2", "G1"), 0, True), (("G2", "G2"), 1, True)],
)
def test_rows_are_free_below_second_order_and_between(continuities, middle, free):
    assert has_free_rows(BlendOptions(continuity=continuities, middle_curves=middle)) is free


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (2 * (1 + 1e-10), ("x lower",)),
        (2 * (1 + 1e-8), ()),
        (8 * (1 - 1e-8), ()),
        (8 * (1 - 1e-10), ("x upper",)),
    ],
)
def test_a_bound_is_met_up_to_a_billionth(monkeypatch, value, said):
    monkeypatch.setattr(shape_parameters, "shape_unknowns", lambda problem, found: [("x", value, 2.0, 8.0)])
    assert shape_parameters.alpha_bounds(None, None) == said
