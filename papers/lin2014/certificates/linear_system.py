"""The entries of (14): integrals of products, by the recursion, against what is printed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from math import prod
from typing import Any

import sympy as sp

from semispline.derivations.energy import energy_matrix, gram_block, thin_plate_density
from semispline.papers.ledger import Claim, Formula, as_expression, as_fraction
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION, induction
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Statement,
    Text,
    identity,
    integral,
    integral_text,
    integrals,
    rank,
    text,
    total,
)

FUBINI = "the integral of a function of u times one of v is a product of integrals"
_PAIRS = (((3, 0), (3, 0)), ((3, 1), (3, 1)), ((3, 2), (3, 2)), ((3, 1), (3, 3)), ((3, 2), (2, 1)), ((3, 3), (4, 2)))


Integrand = tuple[int, Any, Any]


@cache
def _true_entries() -> dict[tuple[tuple[int, int], tuple[int, int]], tuple[Any, dict[Any, tuple[Integrand, ...]]]]:
    """Return entries of the derived matrix, and which integrals by the recursion the letters of (14) stand for.

    Each letter is a product of integrals, each of them of one function or of a product of two.
    """
    surface = energy.layout()
    matrix = energy_matrix(surface)
    index = list(surface.index)
    u = [as_fraction(x) for x in surface.u.knots]
    vectors = [[as_fraction(x) for x in curve.knots] for curve in surface.curves]
    found = {}
    for one, other in _PAIRS:
        (i, j), (k, at) = one, other
        mine, theirs = vectors[i], vectors[k]
        values: dict[Any, tuple[Integrand, ...]] = {}
        for letter, d, e in ((pr.A_0, 0, 0), (pr.A_1, 1, 1), (pr.A_2, 2, 2), (pr.A_10, 1, 0)):
            values[letter] = ((CUBIC, (u, i, d), (u, k, e)),)
        for letter, d, e in ((pr.G_0, 0, 0), (pr.G_1, 1, 1), (pr.G_2, 2, 2), (pr.G_12, 1, 2)):
            values[letter] = ((CUBIC, (mine, j, d), (theirs, at, e)),)
        for (row, point, knots), letters in (
            ((i, j, mine), (pr.a_1, pr.b_1, pr.c_1)),
            ((k, at, theirs), (pr.a_2, pr.b_2, pr.c_2)),
        ):
            for letter, (d, e) in zip(letters, ((2, 0), (0, 2), (1, 1)), strict=True):
                values[letter] = (CUBIC, (u, row, d), None), (CUBIC, (knots, point, e), None)
        found[one, other] = matrix[index.index(one), index.index(other)], values
    return found


def entry_cases(formula: Formula, *, equal: bool) -> Iterator[Statement]:
    """Yield entries over the knots of Fig. 5: by the formula, with integrals by the recursion, and as derived."""
    for (one, other), (true, values) in _true_entries().items():
        where = tuple((text(letter), _spelled(factors)) for letter, factors in values.items())
        label = f"control points {one[0]},{one[1]} and {other[0]},{other[1]}"
        numbers = {letter: as_expression(prod(integral(*x) for x in factors)) for letter, factors in values.items()}
        holds = equal or formula.relation.rhs.subs(numbers) == true
        yield identity(label, formula.relation.rhs, true, where=where, equal=holds)


def _spelled(factors: tuple[Integrand, ...]) -> str:
    first, *more = (integral_text(*factor) for factor in factors)
    for factor in more:
        first = first * factor
    return str(first)


def gram_general(formula: Formula, *, equal: bool = True) -> Iterator[Statement]:
    """Yield an entry for any two control points: half the mixed difference of the density, which is quadratic."""
    products = (
        ("A_0", "N0*M0"),
        ("A_1", "N1*M1"),
        ("A_2", "N2*M2"),
        ("A_10", "N1*M0"),
        ("G_0", "B0*D0"),
        ("G_1", "B1*D1"),
        ("G_2", "B2*D2"),
        ("G_12", "B1*D2"),
    )
    mixed: Text | None = None
    for sign, x, y in ((1, "1", "1"), (-1, "1", "0"), (-1, "0", "1"), (1, "0", "0")):
        parts = {
            f"P_{name}": f"({x}*N{d}*B{e} + {y}*M{d}*D{e})" for name, d, e in (("uu", 2, 0), ("uv", 1, 1), ("vv", 0, 2))
        }
        value = text(thin_plate_density())
        for name, part in parts.items():
            value = value.replace(name, part)
        term = Text(f"({value})", 4)
        mixed = term if mixed is None else mixed + term if sign > 0 else mixed - term
    assert mixed is not None
    names = {"A0": pr.A_0, "A1": pr.A_1, "A2": pr.A_2, "G0": pr.G_0, "G1": pr.G_1, "G2": pr.G_2}
    block = gram_block().subs({sp.Symbol(name): letter for name, letter in names.items()})
    yield identity(
        "any two basis functions of any orders and knots", formula.relation.rhs, mixed / 2, where=products, equal=equal
    )
    yield identity("the derived entry", formula.relation.rhs, block, equal=equal)


def corrected_entry(claim: Claim) -> list[Statement]:
    """Return the entry of A and B that is right."""
    formula = claim.corrected_formulas[0]
    return [*gram_general(formula), *entry_cases(formula, equal=True)]


def equation_14(claim: Claim) -> Draft:
    """Return (14) as printed: entries, what is left of them where a_ij = c_ij = 0, and why that is so."""
    formula = claim.formulas[0]
    zero = tuple((text(letter), "0") for letter in (pr.a_1, pr.a_2, pr.c_1, pr.c_2))
    cases: list[Statement] = [*entry_cases(formula, equal=False)]
    cases.append(identity("every entry of A where a_ij = c_ij = 0", formula.relation.rhs, 0, where=zero, wanted=False))
    size = len([1 for i, _ in energy.layout().index if i == 3])
    cases.append(rank(f"{size} unknown control points, rank 0", sp.zeros(size, size), affirmed=False))
    u = [as_fraction(x) for x in energy.layout().u.knots]
    for d in (1, 2):
        spans = total(x for x in integrals(4, (u, 3, d)) if x)
        cases.append(identity(f"derivative {d} of function 3 integrates to zero, span by span", spans, 0, own=False))
    return Draft([[*cases, *induction()]], corrected_entry(claim), (INDUCTION, FUBINI))


def printed_entries(*, general: bool) -> Callable[[Claim], Draft]:
    """Return the draft of another reading of (14)."""

    def draft(claim: Claim) -> Draft:
        formula = claim.formulas[0]
        cases: list[Statement] = [*entry_cases(formula, equal=False)]
        if general:
            cases += gram_general(formula, equal=False)
        return Draft([cases], corrected_entry(claim), (FUBINI,))

    return draft


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-14": equation_14,
    "sec-4.single-integrals": printed_entries(general=False),
    "sec-4.third-term": printed_entries(general=True),
}
