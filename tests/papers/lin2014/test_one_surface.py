"""(3.1) and how a base is written: exact splines with the rows from the print, by an evaluator of their own."""

from fractions import Fraction

import pytest

from semispline.papers.checks.spline_values import clamped, de_boor
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import one_surface
from semispline.papers.lin2014.checks.one_surface import one_surface_check, one_surface_counterexample, same_base_cases
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_3_1

# Heights over the tangent plane; the first knots after the contact are 1 and 3.
HEIGHTS = [Fraction(x) for x in (0, 0, 1, -2, 5, 3)]
KNOTS = clamped(4, Fraction(1), Fraction(3), end=4)


def row_2(heights, knots, alpha_squared, power):
    return alpha_squared**2 * (Fraction(1, 4) / knots[4]) ** power * (heights[0] - 2 * heights[1] + heights[2])


def inserted(heights, knots, x):
    """Boehm's rule for one knot in one of the first two spans."""
    span = 3 if x < knots[4] else 4
    rows = [
        (1 - t) * heights[i - 1] + t * heights[i]
        for i in range(span - 2, span + 1)
        for t in [(x - knots[i]) / (knots[i + 3] - knots[i])]
    ]
    return [*heights[: span - 2], *rows, *heights[span:]], (*knots[: span + 1], x, *knots[span + 1 :])


@pytest.mark.parametrize("place", [Fraction(1, 2), Fraction(2)])
def test_the_base_stays_when_a_knot_is_inserted(place):
    new, knots = inserted(HEIGHTS, KNOTS, place)
    for at in (Fraction(1, 3), Fraction(3, 4), Fraction(2)):
        assert de_boor(4, knots, new, at) == de_boor(4, KNOTS, HEIGHTS, at)


@pytest.mark.parametrize(("power", "passes_units"), [(1, False), (2, True)])
def test_one_base_has_several_rows_2_as_printed(power, passes_units):
    as_it_is = row_2(HEIGHTS, KNOTS, Fraction(1), power)
    in_units = row_2(HEIGHTS, [4 * x for x in KNOTS], Fraction(4), power)
    with_knot, beyond = (row_2(*inserted(HEIGHTS, KNOTS, x), Fraction(1), power) for x in (Fraction(1, 2), Fraction(2)))
    assert (in_units == as_it_is) == passes_units
    assert as_it_is not in {with_knot, beyond}
    told = one_surface_counterexample().printed.removeprefix("height of P_2 ").split("; with ")[power - 1]
    assert told.removeprefix("squares ") == f"{as_it_is}, {in_units}, {with_knot}, {beyond}"


@pytest.mark.parametrize("power", range(-3, 6))
def test_no_power_passes_a_knot_in_the_second_span(power):
    new, knots = inserted(HEIGHTS, KNOTS, Fraction(2))
    assert new[:2] == HEIGHTS[:2]
    assert knots[:5] == KNOTS[:5]
    assert row_2(new, knots, Fraction(1), power) * 3 == row_2(HEIGHTS, KNOTS, Fraction(1), power) * 2
    assert one_surface_counterexample().printed.endswith("any powers, as it is and with the knot at 2, g, 2*g/3")


@pytest.mark.long
def test_only_the_corrected_row_depends_on_the_surface_alone():
    assert all(case.true for case in one_surface_check(flat=False).cases(TRUE_3_1))
    printed, squared, powers = (
        [c.true for c in one_surface_check(flat=True, any_powers=some).cases(f)]
        for some, f in ((False, pr.COND_3_1), (False, pr.COND_3_1_SQUARES), (True, pr.COND_3_1_ANY_POWERS))
    )
    assert printed[-4:] == [False, False, False, True]
    assert squared[-4:] == [True, False, False, True]
    assert powers[-2:] == [False, True]


@pytest.mark.long
def test_a_knot_inserted_wrongly_changes_the_base(monkeypatch):
    unremembered = same_base_cases.__wrapped__
    assert all(case.true for case in unremembered())
    for label in list(one_surface._CHANGES)[1:]:
        with monkeypatch.context() as patch:
            patch.setitem(one_surface._CHANGES, label, one_surface._CHANGES[label] | {pr.R_2: pr.R_1})
            assert not all(case.true for case in unremembered())
