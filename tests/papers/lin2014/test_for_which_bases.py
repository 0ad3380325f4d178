"""For which bases the printed conditions are right in the figures: exact splines, with nothing of the checks in them.

The blend's rows are set by hand from the print, with plain fractions; derivatives are read off de Boor's triangle, by
differences of a cubic piece.
"""

from fractions import Fraction
from itertools import pairwise

import pytest

from semispline.papers.checks.spline_values import clamped, de_boor
from semispline.papers.ledger.loading import load_paper


def end_derivatives_of(knots, points):
    """First and second derivative of a cubic spline at the start: four values of its first piece tell it."""
    step = (knots[4] - knots[0]) / 3
    f0, f1, f2, f3 = (de_boor(4, knots, points, knots[0] + i * step) for i in range(4))
    first = (-11 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / (6 * step)
    second = (2 * f0 - 5 * f1 + 4 * f2 - f3) / step**2
    return first, second


def contact(rows, spans, m, alpha=Fraction(1), power=1):
    """P_u, P_uu of the blend with rows 1 and 2 as printed (power 2: squared), and R_w, R_ww; one coordinate."""
    u_1 = Fraction(1, m - 2)
    r_0, r_1, r_2 = map(Fraction, rows)
    p_1 = alpha**2 * u_1 / spans[0] * (r_0 - r_1) + r_0
    p_2 = alpha**4 * (u_1 / spans[0]) ** power * (r_0 - 2 * r_1 + r_2) + 2 * p_1 - r_0
    # What comes after row 2 has no part in it.
    blend = [r_0, p_1, p_2, Fraction(7), Fraction(-3), Fraction(5), Fraction(2)][: m + 1]
    base = [r_0, r_1, r_2, Fraction(4), Fraction(9), Fraction(-8)]
    U = clamped(4, *(i * u_1 for i in range(1, m - 2)))
    W = clamped(4, *spans, end=spans[1] + 1)
    return (*end_derivatives_of(U, blend), *end_derivatives_of(W, base))


def test_planes_of_figure_5_may_be_blended_c2_as_printed():
    assert contact((0, 1, 11), (Fraction(1, 5), Fraction(2, 5)), 6) == (-15, 600, 15, 600)


@pytest.mark.parametrize(
    "spans",
    [
        (Fraction(1, 5), Fraction(2, 5)),
        (Fraction(1, 7), Fraction(3, 7)),
        (Fraction(1, 5), Fraction(3, 10)),
        (Fraction(1), Fraction(5, 2)),
    ],
)
@pytest.mark.parametrize("power", [1, 2])
def test_c2_holds_for_one_step_of_the_rows_and_for_no_other(spans, power):
    """The condition that the records name, from both sides; R_1 - R_0 = 1, R_2 turns back if the step is negative."""
    h_1, h_2 = spans
    above, below = (h_2, 2 * h_1 * (Fraction(1, 2) - h_2)) if power == 1 else (h_2 * (1 + 4 * h_1), 2 * h_1 - h_2)
    # Where nothing is to divide by, no step does.
    step = above / below if below else Fraction(1)
    for off in (Fraction(0), Fraction(1, 100), Fraction(-1, 100)):
        _, second, _, true = contact((0, 1, 1 + step + off), spans, 6, power=power)
        assert (second == true) == (off == 0 and below != 0)
    # Constant speed: the base's own second derivative is zero, and the blend's is not.
    _, second, _, true = contact((0, h_1, h_1 + h_2), spans, 6, power=power)
    assert true == 0
    assert second != 0


def test_control_points_that_turn_back_may_be_those_of_a_base_that_runs_on():
    """Rows 0, 3, 1, the next ones far ahead: C2 as printed, and the base never stands still."""
    _, second, _, true = contact((0, 3, 1), (Fraction(1), Fraction(2)), 6)
    assert second == true != 0
    knots, points = clamped(4, Fraction(1), Fraction(2), end=3), [Fraction(x) for x in (0, 3, 1, 40, 80, 120)]
    along = [de_boor(4, knots, points, Fraction(n, 20)) for n in range(61)]
    assert all(x < y for x, y in pairwise(along))


@pytest.mark.parametrize(("m", "length"), [(6, Fraction(1, 2)), (5, Fraction(2, 3))])
def test_a_curved_base_of_five_rows_is_met_with_g2_as_printed_if_it_is_as_long_as_two_spans(m, length):
    """Figs. 6 and 11 along the normal, where R_0 and R_1 are zero: with squares the knot must be in the middle."""
    alpha = Fraction(3, 2)
    for first in (length / 2, length / 3):
        for end in (length, Fraction(1)):
            spans = (first * end / length, end)
            for power, right in ((1, end == length), (2, first == length / 2)):
                slope, second, base_slope, base_second = contact((0, 0, 5), spans, m, alpha, power)
                assert (slope, base_slope) == (0, 0)
                assert (second == alpha**4 * base_second) == right
            # Over [0, 1], as printed, by this factor.
            _, second, _, base_second = contact((0, 0, 5), spans, m, alpha)
            assert second == alpha**4 * base_second * end / length


@pytest.mark.long
def test_the_records_say_so():
    claims = {claim.id: claim for claim in load_paper("lin2014").claims}
    for name in ("fig-5.c2", "fig-8.c2", "fig-9.c2"):
        printed, squared, _ = claims[name].readings
        assert "H_2 / (2 H_1 (1/2 - H_2))" in printed.condition
        assert "4 H_2 (1/4 + H_1) / (2 H_1 - H_2)" in squared.condition
    for name in ("fig-6.g2", "fig-10.g2", "fig-11.g2"):
        printed, squared, _ = claims[name].readings
        assert "together as long as those of the blend" in printed.condition
        assert "have one length" in squared.condition
