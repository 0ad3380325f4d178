"""The listed properties of the surface: general proofs, and exact decisions for one knot vector at a time."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from semispline.derivations.properties import (
    Proof,
    basis_table,
    contact_orders,
    least_bernstein_coefficient,
    partition_residuals,
    proofs,
    supports,
)
from semispline.derivations.splines import X

T = sp.Symbol("t")


def two_spans(degree, multiplicity):
    return [0] * (degree + 1) + ["h"] * multiplicity + [1] * (degree + 1)


@st.composite
def rational_knots(draw, max_degree=4):
    degree = draw(st.integers(1, max_degree))
    inner = draw(st.lists(st.integers(1, 7), max_size=4, unique=True))
    knots = [Fraction(0)] * (degree + 1)
    for value in sorted(inner):
        knots += [Fraction(value, 8)] * draw(st.integers(1, degree))
    return degree, knots + [Fraction(1)] * (degree + 1)


def test_every_general_proof_stands():
    names = [proof.name for proof in proofs()]
    assert names == [
        "partition of unity",
        "non-negative",
        "convex hull",
        "affine invariance",
        "locality",
        "derivative",
        "continuity",
        "u-derivative",
    ]
    assert all(proof.proved for proof in proofs())


def test_a_proof_with_a_false_identity_or_none_does_not_stand():
    proof = proofs()[0]
    assert not replace(proof, identities={**proof.identities, "wrong": sp.Symbol("x")}).proved
    assert not Proof("empty", "", "", {}).proved


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_partition_of_unity_over_symbolic_knots(degree):
    # Every knot a symbol of its own: no end is clamped.
    residuals = partition_residuals(degree, [f"t{i}" for i in range(2 * degree + 3)])
    assert len(residuals) == 2
    assert all(residual.is_zero for residual in residuals)


@pytest.mark.long
@settings(max_examples=30, deadline=None)
@given(rational_knots())
def test_laws_over_rational_knots_with_multiplicities(case):
    degree, knots = case
    assert all(residual.is_zero for residual in partition_residuals(degree, knots))
    assert least_bernstein_coefficient(degree, knots) >= 0
    for i, spans in enumerate(supports(degree, knots)):
        # Not zero on every non-empty span of its support, zero on every other one.
        assert spans == tuple(k for k in range(i, i + degree + 1) if knots[k] < knots[k + 1])


@pytest.mark.parametrize(("degree", "multiplicity"), [(p, r) for p in range(1, 7) for r in range(1, p + 1)])
def test_contact_at_a_knot_is_degree_minus_multiplicity_and_no_better(degree, multiplicity):
    orders = contact_orders(degree, two_spans(degree, multiplicity), "h")
    found = [order for order in orders if order is not None]
    assert min(found) == degree - multiplicity


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_contact_at_a_knot_among_symbolic_neighbours(degree):
    knots = [f"t{i}" for i in range(2 * degree + 3)]
    assert set(contact_orders(degree, knots, f"t{degree + 1}")) == {degree - 1}


@pytest.mark.parametrize("degree", [2, 3, 4, 5])
def test_derivative_formula_over_symbolic_knots(degree):
    knots = two_spans(degree, 1)
    values = [sp.sympify(k) if isinstance(k, str) else sp.Integer(k) for k in knots]
    lower = basis_table(degree - 1, knots[1:-1])
    for k, pieces in basis_table(degree, knots).items():
        below = [sp.Integer(0), *(piece.as_expr() for piece in lower[k - 1]), sp.Integer(0)]
        for i, piece in enumerate(pieces):
            claimed = sp.Integer(0)
            if values[i + degree] != values[i]:
                claimed += degree * below[i] / (values[i + degree] - values[i])
            if values[i + degree + 1] != values[i + 1]:
                claimed -= degree * below[i + 1] / (values[i + degree + 1] - values[i + 1])
            assert sp.cancel(piece.diff().as_expr() - claimed) == 0


@pytest.mark.long
def test_one_curve_alone_carries_a_kink():
    # Four cubic curves in v blended by cubics in u; curve 1 has a triple knot h, the others a simple one.
    u_pieces = basis_table(3, [0, 0, 0, 0, 1, 1, 1, 1])[3]
    jumps = []
    for i, multiplicity in enumerate((1, 3, 1, 1)):
        knots = two_spans(3, multiplicity)
        spans = list(basis_table(3, knots).values())
        coefficients = [Fraction((7 * j * j + 3 * i) % 11) for j in range(len(knots) - 4)]
        before, after = (sum((c * piece.as_expr() for c, piece in zip(coefficients, s, strict=True)), 0) for s in spans)
        jumps.append([sp.cancel(sp.diff(after - before, X, d).subs(X, sp.Symbol("h"))) for d in range(4)])
    # Value and, away from curve 1, first and second derivative do not jump; the kink is N_1(u) times that of curve 1.
    assert [jump[:3] == [0, 0, 0] for jump in jumps] == [True, False, True, True]
    assert jumps[1][0] == 0
    assert jumps[1][1] != 0
    surface_jump = sum(u_pieces[i].as_expr().subs(X, T) * jumps[i][1] for i in range(4))
    assert sp.cancel(surface_jump / (3 * T * (1 - T) ** 2) - jumps[1][1]) == 0


def test_u_derivative_has_curves_over_merged_knots():
    # (P_1 - P_0) with P_0 over knot a, P_1 over knot b: kinks at both, so both knots are needed.
    h0 = basis_table(1, [0, 0, Fraction(1, 3), 1, 1])
    h1 = basis_table(1, [0, 0, Fraction(1, 2), 1, 1])
    slopes0 = [pieces[1].diff().as_expr() for pieces in h0.values()]
    slopes1 = [pieces[1].diff().as_expr() for pieces in h1.values()]
    difference = [slopes1[0] - slopes0[0], slopes1[0] - slopes0[1], slopes1[1] - slopes0[1]]
    assert difference == [-1, Fraction(7, 2), Fraction(-1, 2)]


def test_a_knot_that_is_not_inner_is_refused():
    with pytest.raises(ValueError, match="expected an inner knot"):
        contact_orders(1, [0, 0, 1, 1], 1)
