"""Knots of converted blends: counted on surfaces that are converted by the solver, and the rule by hand."""

from fractions import Fraction

import pytest

from semispline.papers.lin2014.checks import converted_blends
from semispline.papers.lin2014.checks.converted_blends import (
    PAIRS_OF_VECTORS,
    UNPAIRED,
    merged_once,
    pair_means,
    saving_consequence,
    together,
)
from semispline.papers.lin2014.examples.section5 import example
from semispline.solver.blending import blend


def thirds_and_half():
    return [Fraction(1, 3), Fraction(1, 2), Fraction(2, 3)]


def test_what_becomes_of_an_unpaired_knot():
    """By hand, for Fig. 5."""
    found = {word: rule(thirds_and_half()) for word, rule in UNPAIRED.items()}
    twelfth = Fraction(1, 12)
    assert found == {
        "dropped": [5 * twelfth],
        "kept": [5 * twelfth, 8 * twelfth],
        "averaged with v_e": [5 * twelfth, 10 * twelfth],
        "the last three averaged": [6 * twelfth],
        "each with the next": [5 * twelfth, 7 * twelfth],
    }


@pytest.mark.parametrize("name", PAIRS_OF_VECTORS)
def test_each_pair_adds_one_knot_whatever_is_shared(name):
    first, second = PAIRS_OF_VECTORS[name]
    v = merged_once(first, second)
    assert not set(pair_means(v)) & {*first, *second}
    added = together(first, second, pair_means(v)).total() - together(first, second).total()
    assert added == len(v) // 2


@pytest.mark.parametrize(("figure", "converted"), [(5, 49), (6, 133), (8, 49), (10, 84)])
def test_control_points_of_converted_surfaces(figure, converted):
    """Our own examples average the last three knots of an odd number."""
    task = example(figure)
    surface = blend(task.a, task.b, continuity="C2", middle_curves=task.middle_curves, alpha="energy").surface
    rows, columns, _ = surface.to_bspline().control_points.shape
    assert rows * columns == converted
    counted = saving_consequence().measured
    own = [n for name, n in counted.items() if name.startswith(f"Fig. {figure}, own knots")]
    assert surface.n_control_points in own
    names = [name for name in counted if name.startswith(f"Fig. {figure}, converted")]
    (told,) = [name for name in names if len(names) == 1 or "the last three averaged" in name or "in pairs" in name]
    assert counted[told] == converted


def test_blends_without_averages_would_have_no_more_knots(monkeypatch):
    """Figs. 5, 6, 8 and 9 have a middle curve, Fig. 10 has none."""
    assert [case.true for case in converted_blends.no_more_cases(None)] == [False] * 4 + [True]
    monkeypatch.setitem(converted_blends.UNPAIRED, "dropped", lambda v: [])
    assert all(case.true for case in converted_blends.no_more_cases(None))
