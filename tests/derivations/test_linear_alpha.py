"""alpha^2 linear along the contact: its powers, the product of a spline with it, conditions and rows at both ends."""

from fractions import Fraction

import pytest
from sympy import Matrix, Symbol, cancel, expand, symbols

from semispline.derivations import linear_alpha
from semispline.derivations.contact import (
    A,
    base_derivative,
    chain_table,
    contact_conditions,
    contact_rows_from_pieces,
    rows_from_derivatives,
)
from semispline.derivations.linear_alpha import (
    A0,
    A1,
    S,
    conditions_residual,
    linear_powers,
    linear_product,
    power_residual,
    product_residuals,
    raised_knots,
    row_degrees,
)
from semispline.derivations.splines import end_derivatives_from_pieces, evaluate_exact, span_symbols

T = symbols("t1 t2")
# Every degree with a simple knot; double and full ones, and two, where the time allows it.
KNOTS = [
    (1, [0, 0, T[0], 1, 1]),
    (1, [0, 0, T[0], T[1], 1, 1]),
    (2, [0, 0, 0, T[0], 1, 1, 1]),
    (2, [0, 0, 0, T[0], T[0], 1, 1, 1]),
    (2, [0, 0, 0, T[0], T[1], 1, 1, 1]),
    (3, [0, 0, 0, 0, 1, 1, 1, 1]),
    (3, [0, 0, 0, 0, T[0], 1, 1, 1, 1]),
    (3, [0, 0, 0, 0, T[0], T[0], 1, 1, 1, 1]),
    (3, [0, 0, 0, 0, T[0], T[0], T[0], 1, 1, 1, 1]),
    (4, [0, 0, 0, 0, 0, T[0], 1, 1, 1, 1, 1]),
]


@pytest.mark.long
@pytest.mark.parametrize(("degree", "knots"), KNOTS)
@pytest.mark.parametrize("values", [(1, 0), (0, 1)], ids=["1 - s", "s"])
def test_the_product_is_the_product_on_each_span(degree, knots, values):
    residuals = product_residuals(degree, knots, *values)
    assert residuals
    assert all(residual == 0 for residual in residuals)


def test_both_products_together_raise_the_degree():
    knots = KNOTS[6][1]
    falling, rising, raised = (linear_product(3, knots, *values) for values in ((1, 0), (0, 1), (1, 1)))
    assert (falling + rising - raised).applyfunc(cancel).is_zero_matrix
    # A constant stays itself.
    assert (raised * Matrix([1] * 5)).applyfunc(cancel) == Matrix([1] * 7)


@pytest.mark.long
def test_a_blossom_at_other_arguments_is_seen(monkeypatch):
    blossom = linear_alpha._blossom_weights
    monkeypatch.setattr(
        linear_alpha, "_blossom_weights", lambda q, t, k, x: blossom(q, t, k, [*x[:-1], x[-1] + Fraction(1, 7)])
    )
    assert any(x != 0 for x in product_residuals(2, KNOTS[2][1], 0, 1))


@pytest.mark.parametrize("order", range(5))
def test_powers_and_conditions(order):
    assert power_residual(order) == 0
    assert conditions_residual(order).is_zero_matrix is True
    assert len({row[:3] for row in linear_powers(order)}) == len(linear_powers(order))


@pytest.mark.parametrize("order", range(1, 5))
def test_functions_of_v_need_no_further_condition(order):
    # The conditions hold for functions p_k(v): put in p1(v) and p2, they are the table with a = -p1(v).
    value = -(A0 * (1 - S) + A1 * S)
    unused = {Symbol(f"{c}{k}"): 0 for c, least in (("p", 3), ("q", 1)) for k in range(least, order + 1)}
    for k, condition in enumerate(contact_conditions(order)):
        stated = sum(
            (
                (A**i * Symbol("p2") ** j).subs(A, -value) * table[k, d] * base_derivative(d, 0)
                for (i, j), table in chain_table(order).items()
                for d in range(order + 1)
            ),
            0 * S,
        )
        assert expand(condition.subs(unused).subs(Symbol("p1"), value) - stated) == 0


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("order", range(1, 4))
def test_the_rows_at_both_ends_have_these_derivatives(order, end):
    # At each s the rows of the constant a: their derivatives at either end are D_k, whatever a is.
    degree, h = order + 1, span_symbols(order)
    table = sum((matrix * A**i for (i, j), matrix in chain_table(order).items() if j == 0), Matrix.zeros(order + 1))
    rows = rows_from_derivatives(order, degree, h) * table
    sign = 1 if end == "start" else -1
    found = end_derivatives_from_pieces(order, degree, end) * rows
    wanted = Matrix(order + 1, order + 1, lambda k, d: sign**k * table[k, d])
    assert (found - wanted).subs(A, A0 * (1 - S) + A1 * S).applyfunc(cancel).is_zero_matrix
    # And they are those that the Cox-de Boor pieces of both give for a constant.
    base = end_derivatives_from_pieces(order, 3).subs(dict(zip(h, span_symbols(order, "H"), strict=True)))
    assert (rows * base - contact_rows_from_pieces(order, degree, 3)).applyfunc(cancel).is_zero_matrix


def test_row_degrees_are_needed():
    assert row_degrees(0) == (0,)
    assert row_degrees(3) == (0, 1, 2, 3)
    # (a0 (1 - s) + a1 s)^2 is no linear function.
    assert expand((A0 * (1 - S) + A1 * S) ** 2).coeff(S, 2) != 0


def test_the_product_of_numbers_at_a_point():
    knots = [0, 0, 0, Fraction(1, 3), Fraction(1, 3), 2, 2, 2]
    points = [Fraction(k * k - 3, k + 2) for k in range(5)]
    product = linear_product(2, knots, 3, -1) * Matrix(points)
    for x in (Fraction(0), Fraction(1, 5), Fraction(1, 3), Fraction(7, 5), Fraction(2)):
        value = evaluate_exact(2, knots, points, x) * (3 - 4 * x / 2)
        assert evaluate_exact(3, raised_knots(knots), list(product), x) == value
