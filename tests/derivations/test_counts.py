"""Counts of functions and knots for every order, at numbers that are known."""

import pytest
import sympy as sp

from semispline.derivations.counts import domain_ends, functions_of_order, functions_on, last_knot, support_end


def test_a_cubic_with_one_inner_knot():
    """5 points, knots 0 .. 8, domain from knot 3 to knot 5; function 2 lives between knots 2 and 6."""
    four = sp.Integer(4)
    assert last_knot(four, four) == 8
    assert domain_ends(four, four) == (3, 5)
    assert support_end(sp.Integer(2), four) == 6


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_functions_counted_by_running_the_recurrence(order):
    for last in range(2 * order - 1, 2 * order + 4):
        assert functions_of_order(sp.Integer(last), sp.Integer(order)) == functions_on(last + 1, order)
    assert functions_on(2 * order - 1, order) == 0
