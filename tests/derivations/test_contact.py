"""Contact: the chain rule against composed polynomials, the rows against Cox-de Boor at all four pairs of ends."""

from fractions import Fraction
from itertools import combinations, pairwise
from math import prod
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import Matrix, Poly, Rational, Symbol, cancel, diag, diff, expand, factorial, interpolate, symbols
from sympy.polys.constructor import construct_domain

from helpers.sweeps import first_ones
from semispline.derivations.contact import (
    A,
    base_derivative,
    chain_monomials,
    chain_table,
    contact_conditions,
    contact_jets,
    contact_rows,
    contact_rows_from_pieces,
    rows_from_derivatives,
    special_conditions,
)
from semispline.derivations.splines import end_derivatives, end_derivatives_from_pieces, evaluate_exact, span_symbols

P, Q = symbols("p q", positive=True)


def residual(order, rows, blend, base, sign=1):
    """blend C - diag((-sign a)^d) base in the field of rational functions: zero there means identical."""
    factors = diag(*((-sign * A) ** d for d in range(order + 1)))
    matrices = (blend, rows, factors * base)
    domain, flat = construct_domain([entry for m in matrices for entry in m], field=True)
    n = order + 1
    left, middle, right = (flat[k * n * n : (k + 1) * n * n] for k in range(3))
    return [
        sum((left[d * n + i] * middle[i * n + j] for i in range(n)), domain.zero) - right[d * n + j]
        for d in range(n)
        for j in range(n)
    ]


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_conditions_are_derivatives_of_a_composed_surface(seed):
    # Known answer: compose polynomials and differentiate by u; no chain rule is used.
    u, v, w = symbols("u v w")
    random = Random(seed)

    def polynomial(x, y, degree):
        return sum(random.randint(-5, 5) * x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i))

    base = polynomial(w, v, 4)
    p = [polynomial(v, v, 2) for _ in range(3)]
    q = [polynomial(v, v, 2) for _ in range(3)]
    w_of = Rational(2, 3) + p[0] * u + p[1] * u**2 / 2 + p[2] * u**3 / 6
    v_of = v + q[0] * u + q[1] * u**2 / 2 + q[2] * u**3 / 6
    composed = expand(base.subs({w: w_of, v: v_of}, simultaneous=True))
    values = {Symbol(f"{name}{k + 1}"): f[k] for name, f in (("p", p), ("q", q)) for k in range(3)}
    for i in range(4):
        for j in range(4 - i):
            values[base_derivative(i, j)] = diff(base, (w, i), (v, j)).subs(w, Rational(2, 3))
    for d, condition in enumerate(contact_conditions(3)):
        expected = diff(composed, (u, d)).subs(u, 0)
        assert expand(condition.subs(values, simultaneous=True) - expected) == 0


def test_second_condition_has_the_five_known_terms():
    p1, q1, p2, q2 = symbols("p1 q1 p2 q2")
    w, v, ww, wv, vv = symbols("R_w R_v R_ww R_wv R_vv")
    expected = p2 * w + q2 * v + p1**2 * ww + 2 * p1 * q1 * wv + q1**2 * vv
    assert expand(contact_conditions(2)[2] - expected) == 0


def test_special_choice_leaves_the_base_backwards():
    assert [str(condition) for condition in special_conditions(3)] == ["R", "-R_w*a", "R_ww*a**2", "-R_www*a**3"]


@pytest.mark.parametrize("order", range(4))
def test_rows_solve_the_conditions_for_symbolic_degrees(order):
    h, H = span_symbols(order), span_symbols(order, "H")
    rows = contact_rows(order, P, h, Q, H)
    assert not any(residual(order, rows, end_derivatives(order, P, h), end_derivatives(order, Q, H)))


def test_residual_sees_the_printed_second_row():
    # The paper's (3.1) takes u_1 once and the width w_(k_r) - w_s once; the residual must not vanish.
    h, H = span_symbols(2), span_symbols(2, "H")
    wrong = contact_rows(2, P, [h[0], h[0]], Q, [H[0], H[0]])
    assert any(residual(2, wrong, end_derivatives(2, P, h), end_derivatives(2, Q, H)))


def sweep(order, degrees, base_degrees, end, base_end):
    """Pairs of degrees at which the rows miss the conditions read off the Cox-de Boor pieces."""
    n = order + 1
    h, H = span_symbols(order), span_symbols(order, "H")
    rows = contact_rows(order, P, h, Q, H)
    renamed = dict(zip(h, H, strict=True))
    blends = {p: end_derivatives_from_pieces(order, p, end) for p in degrees}
    bases = {q: end_derivatives_from_pieces(order, q, base_end).subs(renamed) for q in base_degrees}
    sign = 1 if end == base_end else -1
    return [
        (p, q)
        for p, blend in blends.items()
        for q, base in bases.items()
        if any(residual(order, rows.subs({P: p, Q: q}), blend[:n, :n], base[:n, :n], sign))
    ]


@pytest.mark.parametrize("base_end", ["start", "end"])
@pytest.mark.parametrize("end", ["start", "end"])
def test_one_matrix_serves_all_pairs_of_ends(end, base_end):
    # Order 2 contains orders 0 and 1: rows P_0..P_n do not depend on later ones.
    assert sweep(1, [1], range(1, 6), end, base_end) == []
    assert sweep(2, range(2, 6), range(1, 6), end, base_end) == []


@pytest.mark.long
def test_order_three_and_degrees_up_to_seven():
    assert sweep(3, range(3, 8), range(1, 8), "end", "start") == []


@pytest.mark.parametrize(("end", "base_end"), [("start", "start"), ("end", "start"), ("start", "end"), ("end", "end")])
def test_rows_solved_from_the_pieces_are_the_closed_form(end, base_end):
    for p, q in ((2, 1), (3, 3), (5, 2), (4, 5)):
        solved = contact_rows_from_pieces(2, p, q, end, base_end)
        closed = contact_rows(2, p, span_symbols(2), q, span_symbols(2, "H"))
        assert (solved - closed).applyfunc(cancel).is_zero_matrix


def test_a_wrong_end_is_noticed():
    solved = contact_rows_from_pieces(2, 3, 3, "end", "start")
    forwards = contact_rows(2, 3, span_symbols(2), 3, span_symbols(2, "H"), a=-A)
    assert not (solved - forwards).applyfunc(cancel).is_zero_matrix


@pytest.mark.parametrize("order", range(4))
def test_rows_are_affine_and_triangular(order):
    rows = contact_rows(order, P, span_symbols(order), Q, span_symbols(order, "H"))
    assert rows.is_lower
    for i in range(order + 1):
        assert cancel(sum(rows.row(i))) == 1


@pytest.mark.parametrize("order", range(4))
def test_rows_are_blossoms_of_the_taylor_polynomial(order):
    # Another way to the same rows: the blossom of x^d in degree p is the mean of the products of d of its arguments.
    h = span_symbols(order)
    jets = contact_jets(order, P, h)
    for i in range(order + 1):
        for d in range(order + 1):
            symmetric = sum(prod(chosen) for chosen in combinations(h[:i], d))
            falling = prod(P - k for k in range(d))
            assert cancel(jets[i, d] - (-A) ** d * symmetric / falling) == 0
    base = end_derivatives(order, Q, span_symbols(order, "H"))
    rows = contact_rows(order, P, h, Q, span_symbols(order, "H"))
    assert (jets * base - rows).applyfunc(cancel).is_zero_matrix


@pytest.mark.parametrize("q", [1, 2])
def test_a_base_of_low_degree_needs_neither_rows_nor_knots_that_it_lacks(q):
    H = span_symbols(3, "H")
    rows = contact_rows(3, 5, span_symbols(3), q, H)
    assert rows[:, q + 1 :].is_zero_matrix
    assert not rows.free_symbols & set(H[q:])


def test_degree_below_the_order_is_refused():
    with pytest.raises(ValueError, match="degree: found 1, expected at least 2"):
        contact_rows(2, 1, [1, 1], 3, [1, 1])


@st.composite
def contacts(draw):
    """A base across the contact and the u-knots of a blend, over rational knots with any inner multiplicity."""

    def knots(degree):
        inner = draw(st.lists(st.fractions(Fraction(1, 9), Fraction(8, 9), max_denominator=9), max_size=2, unique=True))
        repeated = [x for x in sorted(inner) for _ in range(draw(st.integers(1, degree)))]
        return [Fraction(0)] * (degree + 1) + repeated + [Fraction(1)] * (degree + 1)

    order = draw(st.integers(0, 3))
    p, q = draw(st.integers(max(order, 1), 7)), draw(st.integers(1, 7))
    U, W = knots(p), knots(q)
    rows = draw(st.lists(st.fractions(-5, 5, max_denominator=3), min_size=len(W) - q - 1, max_size=len(W) - q - 1))
    a = draw(st.fractions(Fraction(1, 4), 4, max_denominator=5))
    return order, p, U, q, W, rows, a


@pytest.mark.long
@given(contacts(), st.booleans(), st.booleans())
@settings(max_examples=60)
def test_a_blend_with_these_rows_has_the_derivatives_of_the_base(contact, blend_reversed, base_reversed):
    # Judged by exact evaluation of both splines, which knows neither closed form nor chain rule.
    order, p, U, q, W, rows, a = contact

    def counted(knots, backwards):
        return [1 - knot for knot in reversed(knots)] if backwards else knots

    def spans(knots, degree):
        return [Rational(knots[min(degree + r, len(knots) - 1)]) for r in range(1, order + 1)]

    matrix = contact_rows(
        order, p, spans(counted(U, blend_reversed), p), q, spans(counted(W, base_reversed), q), Rational(a)
    )
    near = rows[::-1] if base_reversed else rows
    near = [Rational(x) for x in near] + [Rational(0)] * (order + 1)
    prescribed = list(matrix * Matrix(near[: order + 1]))
    free = len(U) - p - 1 - len(prescribed)
    control = prescribed + [Rational(7)] * free
    if blend_reversed:
        control.reverse()
    for d in range(order + 1):
        at_blend = evaluate_exact(p, U, control, 1 if blend_reversed else 0, d)
        at_base = evaluate_exact(q, W, rows, 1 if base_reversed else 0, d)
        sign = (-1 if blend_reversed else 1) * (-1 if base_reversed else 1)
        assert at_blend == (-sign * Rational(a)) ** d * at_base


# ---------------------------------------------------------------- rows from derivatives, conditions by monomials


@pytest.mark.parametrize("order", range(1, 5))
def test_rows_from_derivatives_undo_the_end_derivatives(order):
    h = span_symbols(order)
    product = end_derivatives(order, P, h) * rows_from_derivatives(order, P, h)
    assert product.applyfunc(cancel) == Matrix.eye(order + 1)


@pytest.mark.parametrize("order", range(1, 5))
def test_the_chain_table_is_the_chain_rule_with_p1_and_p2(order):
    # Taylor coefficients of a composition with a polynomial R: nothing of the derivation is used.
    u, w, a, p2 = symbols("u w a p2")
    base = sum(symbols(f"r{d}") * w**d / factorial(d) for d in range(order + 1))
    composed = base.subs(w, -a * u + p2 * u**2 / 2)
    tables = chain_table(order)
    assert tuple(tables) == chain_monomials(order)
    for k in range(order + 1):
        known = composed.diff(u, k).subs(u, 0) if k else composed.subs(u, 0)
        found = sum(
            a**i * p2**j * table[k, d] * symbols(f"r{d}") for (i, j), table in tables.items() for d in range(order + 1)
        )
        assert expand(found - known) == 0


@pytest.mark.parametrize("order", first_ones(1, range(1, 5)))
def test_with_p2_zero_the_rows_are_those_of_contact_rows(order):
    h, H = span_symbols(order), span_symbols(order, "H")
    tables = chain_table(order)
    jets = sum((A**i * table for (i, j), table in tables.items() if j == 0), Matrix.zeros(order + 1, order + 1))
    rows = rows_from_derivatives(order, P, h) * jets * end_derivatives(order, Q, H)
    assert (rows - contact_rows(order, P, h, Q, H)).applyfunc(cancel) == Matrix.zeros(order + 1, order + 1)


def de_boor(degree, knots, points, span, x):
    """Value at x of the piece on one span, by the triangle: no basis functions, no derivatives."""
    level = list(points[span - degree : span + 1])
    for step in range(1, degree + 1):
        level = [
            a + (x - left) / (knots[j + degree + 1 - step] - left) * (b - a)
            for j, (a, b) in enumerate(pairwise(level), start=span - degree + step)
            for left in (knots[j],)
        ]
    return level[0]


def inwards(degree, end, distances, rows, order):
    """Coefficients of a spline by the distance from its end, read off values inside its first span alone."""
    clamped = [Rational(0)] * (degree + 1)
    # One more knot in front at the end, so that the span has the same index; no value depends on it.
    before = [-x for x in distances[degree::-1]]
    knots = [*clamped, *distances[:degree]] if end == "start" else [*before, *clamped]
    points = rows[: degree + 1] if end == "start" else rows[: degree + 1][::-1]
    sign = 1 if end == "start" else -1
    at = [distances[0] * Rational(i, degree + 1) for i in range(degree + 1)]
    x = Symbol("x")
    values = [(y, de_boor(degree, knots, points, degree, sign * y)) for y in at]
    return [Poly(interpolate(values, x), x).coeff_monomial(x**d) for d in range(order + 1)]


@pytest.mark.parametrize(("end", "base_end"), [("start", "start"), ("end", "start"), ("start", "end"), ("end", "end")])
def test_rows_from_the_pieces_join_values_of_both_splines(end, base_end):
    # From the definition of contact: P(x) and R(-a x), x the way out of the base, agree up to x^2; from values alone.
    shape, h, H = Rational(5, 3), list(map(Rational, (2, 5, 6, 9, 10))), list(map(Rational, (3, 4, 8, 11)))
    base_rows = list(map(Rational, (7, -2, 5, 1, 3)))
    for p, q in ((2, 1), (3, 3), (4, 2)):
        known = dict(zip((*span_symbols(2), *span_symbols(2, "H")), (*h[:2], *H[:2]), strict=True))
        matrix = contact_rows_from_pieces(2, p, q, end, base_end).subs({A: shape, **known})
        # A base of degree 1 has two rows next to its end; the third one must not count.
        rows = [*(matrix * Matrix(base_rows[:3])), Rational(4), Rational(-1)]
        blend = inwards(p, end, h, rows, 2)
        base = inwards(q, base_end, H, base_rows, 2)
        assert blend == [(-shape) ** d * c for d, c in enumerate(base)]
