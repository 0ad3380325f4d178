"""Deciding the printed sums of sections 2 and 3, surfaces, curves and bases, against de Boor's triangle.

The triangle knows no basis functions, so that it judges sums over them; basis functions come from Cox-de Boor. Each
check decides its formula for every order, knot vector and count first, and then runs it at instances.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.papers.checks import (
    SAME,
    WITHIN,
    clamped,
    coefficient,
    de_boor,
    net_ring,
    rational_points,
    spline_basis,
    triangle_cases,
)
from semispline.papers.ledger import (
    Case,
    Check,
    Formula,
    Meaning,
    Strength,
    UndefinedError,
    difference_case,
    given,
    indexed,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.samples import Sample, samples
from semispline.papers.lin2014.printed import CUBIC

THIRD = Fraction(1, 3)


@cache
def _all_samples() -> tuple[tuple[Sample, dict[tuple[int, int], Any]], ...]:
    return tuple((sample, net_ring(*sample.sizes)) for sample in samples())


# Indices of one control point.
_A, _B = sp.symbols("a b", integer=True, nonnegative=True)


def _coefficient_case(formula: Formula | None, unit: Any, true: Any) -> Case:
    """Decide a printed sum for every order, knots and counts: what multiplies one control point."""
    residual = sp.factor_terms(coefficient(given(formula).relation.rhs, unit) - true)
    return Case(f"every order, knots and count: factor of {unit}", bool(residual == 0), residual=residual)


def _curve_factor(i: Any) -> Any:
    """Return what the triangle multiplies P_ib by, on curve i."""
    return WITHIN(0, _B, pr.N(i)) * pr.B(_B, pr.ell, pr.v, pr.V(i))


def surface_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (1), (3) or (13): the printed sum against the triangle, for all control points at once."""
    by_curves = given(formula).relation.rhs.has(pr.C)
    across = WITHIN(0, _A, pr.m) * pr.B(_A, pr.k, pr.u, pr.U)
    true = across if by_curves else across * _curve_factor(_A)
    yield _coefficient_case(formula, pr.C(_A, pr.v) if by_curves else pr.P[_A, _B], true)
    yield from triangle_cases()
    yield from surface_instances(formula)


def surface_instances(formula: Formula | None) -> Iterator[Case]:
    """Run (1), (3) or (13) against the triangle on small surfaces."""
    for sample, net in _all_samples():
        knots: dict[Any, Any] = {"U": sample.U} | dict(enumerate(sample.V))
        for u, v in zip(rational_points(0, 1, 4), reversed(list(rational_points(0, 1, 4))), strict=True):
            meaning = Meaning(
                {pr.u: u, pr.v: v, pr.U: "U", pr.k: sample.k, pr.ell: sample.l, pr.m: sample.m},
                {
                    "P": indexed("P", net),
                    "B": spline_basis(knots),
                    "V": indexed("V", {(i,): i for i in range(sample.m + 1)}),
                    "n": lambda i, s=sample: s.sizes[int(i)] - 1,
                    "C": lambda i, v, s=sample, net=net: s.curve(net, _within(i, s.m), v),
                    "Y": lambda u, v, s=sample, net=net: s.value(net, u, v),
                },
            )
            label = f"orders {sample.k}, {sample.l} at u = {u}, v = {v}"
            yield difference_case(given(formula), label, meaning, own=sample.k == sample.l == CUBIC)


def curve_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (2), a v-control curve, against the triangle."""
    i = given(formula).relation.lhs.args[0]
    yield _coefficient_case(formula, pr.P[_A, _B], SAME(i, _A) * _curve_factor(i))
    yield from triangle_cases()
    yield from curve_instances(formula)


def curve_instances(formula: Formula | None) -> Iterator[Case]:
    """Run (2) against the triangle."""
    for sample, net in _all_samples():
        for i, v in zip((0, sample.m, 1), rational_points(0, 1, 3), strict=True):
            meaning = Meaning(
                {pr.v: v, pr.i: i, pr.ell: sample.l},
                {
                    "P": indexed("P", net),
                    "B": spline_basis(dict(enumerate(sample.V))),
                    "V": indexed("V", {(i,): i for i in range(sample.m + 1)}),
                    "n": lambda i, s=sample: s.sizes[_within(i, s.m)] - 1,
                    "C": lambda i, v, s=sample, net=net: s.curve(net, int(i), v),
                },
            )
            label = f"curve {i}, order {sample.l}, {sample.sizes[i]} points, at v = {v}"
            yield difference_case(given(formula), label, meaning, own=sample.l == CUBIC)


def base_cases(letter: str) -> Callable[[Formula | None], Iterator[Case]]:
    """Return the check of (7) for letter R, of (9) for letter S: a tensor product against the triangle."""
    x, knots_x, knots_v, order, last_x, last_v = (
        (pr.w, pr.W, pr.V_r, pr.k_r, pr.m_r, pr.n_r) if letter == "R" else (pr.t, pr.T, pr.V_s, pr.k_s, pr.m_s, pr.n_s)
    )

    points = pr.R if letter == "R" else pr.S

    def cases(formula: Formula | None) -> Iterator[Case]:
        of_row = WITHIN(0, _A, last_x) * pr.B(_A, order, x, knots_x)
        of_column = WITHIN(0, _B, last_v) * pr.B(_B, pr.ell, pr.v, knots_v)
        yield _coefficient_case(formula, points[_A, _B], of_row * of_column)
        yield from triangle_cases()
        for k, length in ((2, 3), (3, 2), (4, 4)):
            across = clamped(k, THIRD, start=-1, end=2)
            along = clamped(length, Fraction(1, 4), Fraction(3, 5))
            rows, columns = len(across) - k, len(along) - length
            net = net_ring(*[columns] * rows, letter=letter)
            for at, v in zip(rational_points(-1, 2, 3), (Fraction(2, 7), Fraction(0), Fraction(4, 5)), strict=True):
                value = _tensor(net, (k, across), (length, along), at, v)
                meaning = Meaning(
                    {
                        **{x: at, pr.v: v, knots_x: "across", knots_v: "along"},
                        **{order: k, pr.ell: length, last_x: rows - 1, last_v: columns - 1},
                    },
                    {
                        letter: indexed(letter, net),
                        "B": spline_basis({"across": across, "along": along}),
                        "Y": lambda *_, value=value: value,
                    },
                )
                yield difference_case(given(formula), f"orders {k}, {length} at {at}, {v}", meaning)

    return cases


def _tensor(net: dict[tuple[int, int], Any], across: Any, along: Any, x: Fraction, v: Fraction) -> Any:
    (k, knots), (length, knots_v) = across, along
    rows = max(i for i, _ in net) + 1
    columns = max(j for _, j in net) + 1
    curves = [de_boor(length, knots_v, [net[i, j] for j in range(columns)], v) for i in range(rows)]
    return de_boor(k, knots, curves, x)


def _within(i: Any, m: int) -> int:
    if not 0 <= i <= m:
        raise UndefinedError(f"curve {i} of 0..{m}")
    return int(i)


SUM_METHOD = (
    "what multiplies one control point, with symbolic indices, orders, counts and knots, against de Boor's triangle, "
    "whose coefficients are the basis functions by induction on the order; run at rational parameters and knots of "
    "orders 2 to 4 as well"
)
SURFACE_CHECK = Check(surface_cases, Strength.GENERAL, SUM_METHOD, proof=True)
CURVE_CHECK = Check(curve_cases, Strength.GENERAL, SUM_METHOD, proof=True)


def base_check(letter: str) -> Check:
    """Return the check of (7) or (9)."""
    return Check(base_cases(letter), Strength.GENERAL, SUM_METHOD, proof=True)
