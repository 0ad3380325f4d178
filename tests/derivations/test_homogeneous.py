"""Contact in homogeneous coordinates: the quotient has the contact, whatever the weights; tame representatives."""

from fractions import Fraction
from math import comb, factorial

import pytest
from sympy import Matrix, Poly, Rational, Symbol, cancel, diff, expand, eye, symbols

from semispline.derivations.circles import half_turns
from semispline.derivations.contact import A, contact_conditions, contact_rows, contact_rows_from_pieces
from semispline.derivations.fairness import DERIVATIVES, reversed_program
from semispline.derivations.homogeneous import (
    contact_residuals,
    homogeneous_conditions,
    homogeneous_symbol,
    jet,
    last_rung,
    leibniz,
    quotient_program,
    reciprocal_jet,
)
from semispline.derivations.splines import end_derivatives, end_derivatives_from_pieces, span_symbols

ORDERS = range(5)
T = Symbol("t")


def quotient_jet(points, weights):
    """Derivatives of X / W at one place, by solving X = W S for each order in turn: no rule of ours."""
    found = []
    for k in range(len(points)):
        rest = sum(comb(k, j) * weights[j] * found[k - j] for j in range(1, k + 1))
        found.append((points[k] - rest) / weights[0])
    return found


@pytest.mark.parametrize("order", ORDERS)
def test_the_quotient_has_the_contact_of_the_base_for_every_lambda(order):
    residuals = contact_residuals(order)
    assert len(residuals) == order + 1
    assert all(residual == 0 for residual in residuals)


def test_the_residual_sees_a_wrong_weight():
    order = 2
    point, weight = jet("X", order), jet("omega", order)
    right = homogeneous_conditions(order, point, weight)
    # The base's own weights kept: what row formulas on Cartesian points would do.
    wrong = [Matrix([[row[0], weight[0] if k == 0 else 0]]) for k, row in enumerate(right)]
    values = {s: Rational(k + 2, 3 * k + 5) for k, s in enumerate(sorted(right[2].free_symbols, key=str))}
    own = quotient_jet([x.subs(values) for x in point], [x.subs(values) for x in weight])
    conditions = [c.subs({Symbol(f"q{k}"): 0 for k in (1, 2)}) for c in contact_conditions(order)]
    at = dict(zip(symbols("R R_w R_ww"), own, strict=True)) | values
    for rows, agrees in ((right, True), (wrong, False)):
        found = quotient_jet([row[0].subs(values) for row in rows], [row[1].subs(values) for row in rows])
        assert (found == [c.subs(at) for c in conditions]) is agrees


@pytest.mark.parametrize("order", ORDERS)
def test_a_polynomial_base_is_a_special_case(order):
    ones = [1, *([0] * order)]
    at = dict(zip(jet("l", order), ones, strict=True))
    rows = homogeneous_conditions(order, jet("X", order), ones)
    conditions = contact_conditions(order)
    own = {Symbol("R" + "_" * bool(k) + "w" * k): Symbol(f"X{k}") for k in range(order + 1)}
    own |= {Symbol(f"q{k}"): 0 for k in range(1, order + 1)}
    for row, condition in zip(rows, conditions, strict=True):
        assert expand(row[0].subs(at) - condition.subs(own)) == 0
    assert [row[1].subs(at) for row in rows] == ones


@pytest.mark.parametrize("order", range(1, 5))
def test_the_reciprocal_is_a_derivative(order):
    m = sum((Symbol(f"m{k}") * T**k / factorial(k) for k in range(order + 1)), 0)
    for k, value in enumerate(reciprocal_jet(jet("m", order))):
        assert cancel(diff(1 / m, T, k).subs(T, 0) - value) == 0
    product = leibniz(reciprocal_jet(jet("m", order))) * leibniz(jet("m", order))
    assert product.applyfunc(cancel) == eye(order + 1)


@pytest.mark.parametrize("order", ORDERS)
def test_the_last_rung_is_a_polynomial_representative_of_the_base(order):
    jets, weights = last_rung(order)
    x, om = jet("X", order), jet("omega", order)
    assert all(Poly(value, *x, *om).is_homogeneous for value in jets)
    # om^(n+1) R and om^(n+1), 0, ..: the quotient of these jets is that of the base.
    own = quotient_jet(x, om)
    for value, wanted in zip(quotient_jet(jets, weights), own, strict=True):
        assert cancel(value - wanted) == 0


@pytest.mark.parametrize(("order", "degree", "base_degree"), [(1, 2, 2), (2, 3, 2), (2, 5, 3), (3, 4, 3)])
def test_rows_of_the_blend_follow_from_four_columns(order, degree, base_degree):
    """Rows from the Cox-de Boor pieces on homogeneous control points: the quotients' derivatives agree by (-a)^k."""
    spans = [Fraction(1, 2) + Fraction(k, 7) for k in range(order)]
    base_spans = [Fraction(2, 3) + Fraction(k, 5) for k in range(order)]
    values = dict(zip(span_symbols(order), map(Rational, map(str, spans)), strict=True))
    values |= dict(zip(span_symbols(order, "H"), map(Rational, map(str, base_spans)), strict=True))
    values[A] = Rational(3, 4)
    weights = [Rational(3, 2), Rational(2, 3), Rational(5, 4), Rational(7, 5)][: order + 1]
    points = [Rational(k * k - 2, k + 1) for k in range(order + 1)]
    base = Matrix([[w * x, w] for x, w in zip(points, weights, strict=True)])
    rows = contact_rows_from_pieces(order, degree, base_degree).subs(values) * base
    blend_end = end_derivatives_from_pieces(order, degree).subs(values)
    base_end = end_derivatives_from_pieces(order, base_degree)
    base_end = base_end.subs(dict(zip(span_symbols(order), span_symbols(order, "H"), strict=True)), simultaneous=True)
    of_blend, of_base = blend_end * rows, base_end.subs(values) * base
    found = quotient_jet(list(of_blend[:, 0]), list(of_blend[:, 1]))
    wanted = quotient_jet(list(of_base[:, 0]), list(of_base[:, 1]))
    assert found == [(-values[A]) ** k * x for k, x in enumerate(wanted)]
    # On Cartesian points, with the base's weights, the same rows miss the second derivative.
    plain = contact_rows_from_pieces(order, degree, base_degree).subs(values) * Matrix(points)
    weighted = Matrix([w * x for x, w in zip(plain, weights, strict=True)])
    kept = quotient_jet(list(blend_end * weighted), list(blend_end * Matrix(weights)))
    assert (kept == found) is (order == 1)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_a_torus_is_met_in_exact_fractions(order):
    """A quarter meridian of rational weights, turned about the z axis by the circle of eleven points; no float."""
    meridian = [(Rational(4), Rational(0), 1), (Rational(4), Rational(1), 1), (Rational(3), Rational(1), 2)]
    h = [Rational(k + 1, 3) for k in range(order)]
    rows_of = contact_rows(order, 2 * order + 1, h, 2, [1, 1, 1, 1][:order], Rational(3, 4))
    blend_end = end_derivatives(order, 2 * order + 1, h)
    base_end = end_derivatives(order, 2, [1] * order)
    # A span as a Bezier curve at two places, so that the points are those of the circle itself.
    for place in (Rational(1, 3), Rational(5, 7)):
        binomials = [comb(6, j) * place**j * (1 - place) ** (6 - j) for j in range(7)]
        x, y, w = (sum(b * p[d] for b, p in zip(binomials, half_turns(3, 2)[0], strict=True)) for d in range(3))
        assert x**2 + y**2 == w**2
        # Rows that the base of degree 2 lacks count nothing.
        padded = [*meridian, *([meridian[-1]] * (order - 2))]
        base = Matrix([[weight * r * x, weight * r * y, weight * z * w, weight * w] for r, z, weight in padded])
        rows = rows_of * base
        found, wanted = blend_end * rows, base_end * base
        for d in range(3):
            jets = quotient_jet(list(found[:, d]), list(found[:, 3]))
            assert jets == [
                Rational(-3, 4) ** k * value
                for k, value in enumerate(quotient_jet(list(wanted[:, d]), list(wanted[:, 3])))
            ]


@pytest.mark.long
def test_the_quotient_program_gives_derivatives():
    u, v = symbols("u v")
    weight = 2 + u + v * u - v**3 / 4
    tops = {"x": 1 + 2 * u - v + 3 * u * v**2 - u**3, "y": u**2 * v - v**3, "z": 3 + u - u**2 * v, "w": weight}
    place = {u: Rational(1, 3), v: Rational(2, 5)}

    def at(value, name):
        for letter in name:
            value = value.diff({"u": u, "v": v}[letter])
        return value.subs(place)

    program = quotient_program()
    known = {homogeneous_symbol(name, c): at(tops[c], name) for name in ("", *DERIVATIVES) for c in "xyzw"}
    for symbol, value in program.steps:
        known[symbol] = value.xreplace(known)
    for symbol, (name, c) in zip(program.outputs, ((n, c) for n in DERIVATIVES for c in "xyz"), strict=True):
        assert known[symbol] == at(tops[c] / weight, name)


def test_its_pullback_is_its_gradient():
    program = quotient_program()
    gradient = reversed_program(program)
    values = {s: Rational(3 * k % 11 + 1, 7) for k, s in enumerate(program.inputs)}
    seeds = {s: Rational(k % 5 - 2, 3) for k, s in enumerate(gradient.inputs[len(program.inputs) :])}

    def run(steps, known):
        known = dict(known)
        for symbol, value in steps:
            known[symbol] = value.xreplace(known)
        return known

    whole, found = run(program.steps, values), run(gradient.steps, values | seeds)

    def slope(s):
        """The slope of the sum of seeds times outputs, forwards by the chain rule."""
        slopes = {s: Rational(1)}
        for symbol, value in program.steps:
            slopes[symbol] = sum(value.diff(x).xreplace(whole) * slopes[x] for x in value.free_symbols if x in slopes)
        return sum(seeds[Symbol(f"seed_{x.name}")] * slopes.get(x, 0) for x in program.outputs)

    for name, c in (("", "w"), ("uv", "w"), ("", "x"), ("uuu", "z")):
        s = homogeneous_symbol(name, c)
        assert slope(s) == found[Symbol(f"d_{s.name}")]
