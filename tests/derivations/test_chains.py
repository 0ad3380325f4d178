"""Strips of a chain: contact whatever runs through a face, values and slopes at a joint, and what no choice removes."""

from fractions import Fraction

import numpy as np
import pytest
from sympy import Matrix, Poly, Rational, Symbol, diff, expand, factorial, lambdify, symbols

from helpers.sweeps import first_ones
from semispline.derivations import chains
from semispline.derivations.chains import (
    NORMAL,
    crease_left,
    inherited_share,
    joint_columns,
    joint_slopes,
    joint_values,
    slope,
    slope_jumps,
    slope_unknowns,
    solved_in_turn,
    strip_derivatives,
    strip_residuals,
    strip_slopes,
    value_jumps,
    value_unknowns,
)
from semispline.derivations.contact import base_derivative, contact_jets
from semispline.derivations.energy import Basis
from semispline.derivations.splines import span_symbols
from semispline.solver.blending.reparametrisation import Reparametrisation, composed, slopes_along

ORDERS = range(5)
U, V, W = symbols("u v w")


def polynomial(rng, letters, degree):
    """A polynomial with small random fractions."""
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    terms = (Rational(int(rng.integers(-9, 10)), int(rng.integers(1, 6))) * letters[0] ** i * letters[1] ** j
             for i, j in powers)  # fmt: skip
    return sum(terms, Rational(0))


def strip_of(rng, order):
    """A surface and what runs through it, as polynomials; w and q vanish at u = 0."""
    face = Matrix([polynomial(rng, (W, V), order + 1) for _ in range(3)])
    lam, w, q = (polynomial(rng, (U, V), order + 1) for _ in range(3))
    w, q = w - w.subs(U, 0), q - q.subs(U, 0)
    at = {Symbol(f"{x}{k}"): diff(f, U, k).subs({U: 0, V: 0}) for x, f in zip("lpq", (lam, w, q), strict=True)
          for k in range(order + 1)}  # fmt: skip
    at |= {slope(x, k): diff(f, U, k, V).subs({U: 0, V: 0}) for x, f in zip("lpq", (lam, w, q), strict=True)
           for k in range(order + 1)}  # fmt: skip
    return face, (lam, w, q), at


def series_in_u(value):
    """The derivatives by u of a polynomial at u = v = 0, from its coefficients."""
    coefficients = Poly(value.subs(V, 0), U).all_coeffs()[::-1]
    return [*(factorial(j) * x for j, x in enumerate(coefficients)), *[0] * 9]


def jets_of(face, order):
    """The derivatives of a surface at w = v = 0."""
    places = [(i, j) for i in range(order + 2) for j in range(order + 2 - i)]
    return {base_derivative(i, j): face.diff(W, i, V, j).subs({W: 0, V: 0}) for i, j in places}


def in_coordinates(value, jets, at, d):
    return expand(value.xreplace({symbol: vector[d] for symbol, vector in jets.items()} | at))


@pytest.mark.parametrize("order", first_ones(2, [1, 2, 3, 4]))
def test_derivatives_of_a_strip_are_those_of_the_composed_surface(order):
    face, (lam, w, q), at = strip_of(np.random.default_rng(order), order)
    jets = jets_of(face, order)
    for d in range(3):
        whole = lam * face[d].subs({W: w, V: V + q}, simultaneous=True)
        values, slopes = series_in_u(whole), series_in_u(diff(whole, V))
        for j, (value, along) in enumerate(zip(strip_derivatives(order), strip_slopes(order), strict=True)):
            assert in_coordinates(value, jets, at, d) == values[j]
            assert in_coordinates(along, jets, at, d) == slopes[j]


@pytest.mark.parametrize("order", ORDERS)
def test_contact_is_exact_whatever_runs_through_the_face(order):
    residuals = strip_residuals(order)
    assert len(residuals) == order + 1
    assert all(residual == 0 for residual in residuals)


def test_the_residuals_see_a_wrong_strip(monkeypatch):
    right = strip_derivatives(2)
    # lambda of the point and of the weight, but not its product rule.
    wrong = (right[0], right[1], right[2] - Symbol("l1") * Symbol("q1") * base_derivative(0, 1))
    monkeypatch.setattr(chains, "strip_derivatives", lambda _: wrong)
    assert strip_residuals(2)[2] != 0


@pytest.mark.parametrize("order", ORDERS)
def test_unknowns_of_each_order_have_three_columns(order):
    point, across, along = base_derivative(0, 0), base_derivative(1, 0), base_derivative(0, 1)
    l0 = Symbol("l0")
    strip, slopes = strip_derivatives(order), strip_slopes(order)
    for j, columns in enumerate(joint_columns(order)):
        assert columns == {"l": point, **({"p": l0 * across, "q": l0 * along} if j else {})}
        for x, column in columns.items():
            assert slopes[j].diff(slope(x, j)) == column
            # They are in no lower order.
            assert all(strip[i].diff(Symbol(f"{x}{j}")) == 0 for i in range(j))
            assert all(slopes[i].diff(slope(x, j)) == 0 for i in range(j))


@pytest.mark.parametrize("order", ORDERS)
def test_values_close_where_both_faces_leave_along_one_curve(order):
    jumps, closed = value_jumps(order), joint_values(order)
    assert all(expand(jump.xreplace(closed)) == 0 for jump in jumps)
    solved, left = solved_in_turn(jumps, value_unknowns(order))
    assert solved == closed
    assert left == [0] * (order + 1)


@pytest.mark.parametrize("order", ORDERS)
def test_slopes_close_where_the_faces_are_smooth_across_the_side_edge(order):
    jumps, closed = slope_jumps(order), joint_slopes(order)
    assert all(expand(jump.xreplace(closed)) == 0 for jump in jumps)
    solved, left = solved_in_turn(jumps, slope_unknowns(order))
    assert solved == closed
    assert left == [0] * (order + 1)


@pytest.mark.parametrize(("jumps", "closed"), [(value_jumps, joint_values), (slope_jumps, joint_slopes)])
def test_each_of_the_unknowns_is_needed(jumps, closed):
    order = 2
    found, wanted = closed(order), jumps(order)
    for name, value in found.items():
        # The formula broken by hand: each of its terms left out in turn.
        for term in value.as_ordered_terms():
            broken = found | {name: value - term}
            assert any(expand(jump.xreplace(broken)) != 0 for jump in wanted), (name, term)


def test_a_side_edge_that_is_not_shared_does_not_close():
    # The face behind has R_ww of its own: what is left is that, and it is in no column.
    jumps = list(value_jumps(2))
    jumps[2] = jumps[2] - Symbol("R_else")
    _, left = solved_in_turn(jumps, value_unknowns(2))
    assert left[2] == -Symbol("R_else")


@pytest.mark.parametrize("order", ORDERS)
def test_what_stays_is_the_crease_of_the_faces(order):
    l0, p1 = symbols("l0 p1")
    assert crease_left(order) == tuple(-l0 * p1**j * Symbol(f"e{j}") * NORMAL for j in range(order + 1))
    # Whatever l, p and q are: the part along N has no unknown of its order.
    for j, jump in enumerate(slope_jumps(order, creased=True)):
        flat = {Symbol(f"e{k}"): Rational(0) for k in range(j)}
        assert jump.xreplace(flat).coeff(NORMAL) == -l0 * p1**j * Symbol(f"e{j}")


@pytest.mark.long
@pytest.mark.parametrize("order", first_ones(2, [1, 2, 3, 4]))
def test_two_faces_of_one_sheet_meet_in_exact_fractions(order):
    """A sheet F in two pieces, the second one bent in its parameters and in its weight; plain differentiation only."""
    rng = np.random.default_rng(order)
    sheet = Matrix([W, V, polynomial(rng, (W, V), 3), 1 + W / 4 - V / 3])
    s = Rational(3, 5) + W / 2 - W**2 / 7
    r, c = W / 3 + 2 * W**2 / 5, Rational(1, 4) - W / 6
    first = sheet
    # To first order in v: R_v = s F_v + r F_w + c F on the side edge v = 0.
    second = (1 + c * V) * sheet.subs({W: W + r * V, V: s * V}, simultaneous=True)
    lam = 1 + U / 3 - U**2 / 5
    w = 2 * U / 3 + U**2 / 4 - U**3 / 9
    before = {"l": lam * (1 + V * (2 - U)), "p": w + V * (U / 4 - U**2), "q": V * (U / 5 + U**2 / 3)}
    values = {Symbol(f"{x}{k}"): diff(f, U, k).subs(U, 0) for x, f in (("l", lam), ("p", w)) for k in range(order + 1)}
    values |= {Symbol(f"{x}{k}"): diff(f, W, k).subs(W, 0) for x, f in zip("src", (s, r, c), strict=True)
               for k in range(order + 1)}  # fmt: skip
    values |= {slope(x.upper(), k): diff(f, U, k, V).subs({U: 0, V: 0}) for x, f in before.items()
               for k in range(order + 1)}  # fmt: skip
    found = {name: value.xreplace(values) for name, value in joint_slopes(order).items()}

    def rise(x):
        return sum((found.get(slope(x, k), 0) * U**k / factorial(k) for k in range(order + 1)), Rational(0))

    behind = {"l": lam + V * rise("l"), "p": w + V * rise("p"), "q": V * rise("q")}

    def slopes_of(face, by):
        """dJ_j/dv at v = 0."""
        whole = [by["l"] * x.subs({W: by["p"], V: V + by["q"]}, simultaneous=True) for x in face]
        return [series_in_u(diff(x, V))[: order + 1] for x in whole]

    one, other = slopes_of(first, before), slopes_of(second, behind)
    s0 = values[Symbol("s0")]
    assert [[s0 * x for x in row] for row in one] == other
    # Without q the second face's own bend of its parameters stays in the derivative of order 1.
    plain = slopes_of(second, behind | {"q": Rational(0)})
    assert [row[0] for row in plain] == [row[0] for row in other]
    assert [row[1] for row in plain] != [row[1] for row in other]


def test_a_jump_of_the_contact_fades():
    u = Symbol("u")
    for order in (1, 2, 3, 4):
        degree = 2 * order + 1
        share = inherited_share(order, degree)
        assert share.subs(u, 0) == 1
        assert share.subs(u, 1) == 0
        # Falling all the way, flat at both ends: the derivative by hand.
        slope_of = -factorial(degree) / factorial(order) ** 2 * u**order * (1 - u) ** (degree - order - 1)
        assert expand(diff(share, u) - slope_of) == 0
    found = [float(inherited_share(2, 5).subs(u, x)) for x in (Rational(1, 4), Rational(1, 2), Rational(3, 4))]
    assert found == pytest.approx([0.90, 0.50, 0.10], abs=5e-3)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_every_row_of_a_contact_has_the_jump_of_the_contact(order):
    # P_i = sum_k J[i, k] d^k R / dw^k: of a jump of R alone each row has all.
    rows = contact_jets(order, Symbol("p"), span_symbols(order))
    assert list(rows[:, 0]) == [1] * (order + 1)


def test_with_knots_the_share_is_that_of_the_basis():
    # Degree 4 with a knot in the middle, as the fairest blends of G2 at both ends may have: sums of three functions.
    basis = Basis(4, tuple(["0"] * 5 + ["1/2"] + ["1"] * 5))
    x = Symbol("x")
    found = []
    for place in (Rational(1, 4), Rational(1, 2), Rational(3, 4)):
        span = basis.spans[0 if place <= Rational(1, 2) else 1]
        values = {span.first + k: piece.as_expr().subs(x, place) for k, piece in enumerate(span.pieces)}
        found.append(float(sum(value for k, value in values.items() if k <= 2)))
    assert found == pytest.approx([0.91, 0.50, 0.09], abs=5e-3)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_the_solver_computes_what_is_derived(order):
    """`composed` and `slopes_along` in floats, against the formulas in exact fractions at the same dyadic numbers."""
    rng = np.random.default_rng(order)
    derivatives = rng.integers(-64, 65, (order + 1, order + 2, 2, 4)) / 16.0
    values, slopes = rng.integers(-64, 65, (2, 3, order + 1, 2)) / 32.0
    values[1:, 0] = slopes[1:, 0] = 0.0
    # To order n the formulas read no derivatives of order above n + 1 in all.
    found = composed(derivatives[:, : order + 1], Reparametrisation.of(values))
    along = slopes_along(derivatives, Reparametrisation.of(values), Reparametrisation.of(slopes))
    names = [
        *(f"{x}{k}" for x in "lpq" for k in range(order + 1)),
        *(str(slope(x, k)) for x in "lpq" for k in range(order + 1)),
    ]
    symbols_of = [*map(Symbol, names), *(base_derivative(a, b) for a in range(order + 1) for b in range(order + 2))]
    for formulas, ours in ((strip_derivatives(order), found), (strip_slopes(order), along)):
        computed = lambdify(symbols_of, formulas, modules="math")
        for t in range(2):
            numbers = [*values[..., t].ravel(), *slopes[..., t].ravel()]
            for d in range(4):
                at = [*map(Fraction, [*numbers, *derivatives[:, :, t, d].ravel()])]
                # All coefficients are positive: this is the sum of the sizes of all terms, each of which is rounded a
                # few times, and added.
                sizes = computed(*map(abs, at))
                for j, exact in enumerate(computed(*at)):
                    assert abs(float(exact) - ours[j, t, d]) <= 100 * np.finfo(float).eps * float(sizes[j])


def test_the_comparison_sees_a_wrong_order():
    # Broken by hand: q taken for w.
    derivatives = np.arange(24.0).reshape(2, 3, 1, 4)
    values = np.array([[[1.0], [0.5]], [[0.0], [2.0]], [[0.0], [3.0]]])
    right = composed(derivatives[:, :2], Reparametrisation.of(values))
    wrong = composed(derivatives[:, :2], Reparametrisation.of(values[[0, 2, 1]]))
    assert np.abs(right - wrong).max() > 1
    # By hand: J_1 = l_1 R + l_0 (p_1 R_w + q_1 R_v), of the first coordinate R = 0, R_v = 4, R_w = 12.
    assert right[1, 0, 0] == 0.5 * 0 + 2 * 12 + 3 * 4
