"""Rows that contact sets: which of them enter an end derivative, and which are left free."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import Claim, Formula
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION, induction
from semispline.papers.lin2014.certificates.untouched_bases import three_rows
from semispline.papers.lin2014.checks.construction import contact_matrix, set_rows
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import Draft, Lets, Statement, Text, derivative, end_jets, identity, positive, rank, text


def bound_of_m(claim: Claim) -> Draft:
    """Return that m >= k + 1 leaves six rows for k >= 4, and not for k = 2 and 3."""
    relation = claim.formulas[0].relation
    over, more = sp.symbols("r s")
    admitted = relation.rhs.subs(pr.k, CUBIC + over) + more
    cases: list[Statement] = [
        positive("every k >= 4: rows 2 and m-2 differ", "m - 2 - 2", where={pr.m: admitted}, nonnegative=("r", "s")),
        positive(
            "every k >= 4: enough rows for the order",
            "m + 1 - k",
            nonnegative=("r", "s"),
            where={pr.k: CUBIC + over, pr.m: admitted},
        ),
    ]
    cases += [
        identity(
            f"k = {k}, m = 4, which the bound admits: rows 2 and m-2 are one",
            "m - 2",
            2,
            where=((text(pr.k), str(k)), (text(pr.m), "4")),
            conditions=(f"m >= {text(relation.rhs)}",),
            wanted=False,
            own=False,
            meets=False,
        )
        for k in (2, 3)
    ]
    return Draft([cases])


def rows_set() -> Iterator[Statement]:
    """Yield that derivatives up to 2 at an end see rows 0 .. 2 and determine them, for every order."""
    yield from induction()
    ends = end_derivatives(4, pr.k - 1, span_symbols(4))
    for d in range(3):
        for i in range(3, 5):
            yield identity(f"derivative {d} does not see row {i}", ends[d, i], 0, own=False)
    for d in range(3):
        for i in range(d + 1, 3):
            yield identity(f"derivative {d} does not see row {i}", ends[d, i], 0, own=False)
        diagonal = ends[d, d].subs(pr.k, 3 + sp.Symbol("r"))
        yield positive(
            f"row {d} has a factor in derivative {d}, every order from 3 on",
            diagonal,
            positive=span_symbols(4),
            nonnegative=("r",),
            own=False,
        )


def row_index(formula: Formula, row: Callable[[Any, Any], Any]) -> Iterator[Statement]:
    """Yield the index of a row by the last one that contact sets at u = 0, and the first one at u = 1."""
    start, end = (Text(text(x), 1) for x in set_rows(2))
    yield identity("every m", formula.relation.rhs, row(start, end))


def three_curves(claim: Claim) -> Draft:
    """Return the rows that have the knots of each base."""
    first, last = claim.formulas
    return Draft(
        [[*three_rows(), *rows_set(), *row_index(first, lambda a, _: a), *row_index(last, lambda _, b: b)]],
        believed=(INDUCTION,),
    )


def two_kinds(claim: Claim) -> Draft:
    """Return m with no middle curve and with one, and its index."""
    none, one, row = claim.formulas
    start, end = set_rows(2)
    cases: list[Statement] = [*rows_set()]
    for count, formula in ((0, none), (1, one)):
        where = ((text(pr.m), text(formula.relation.rhs)),)
        between = Text(f"({text(end)}) - 1 - (({text(start)}) + 1) + 1", 1)
        cases.append(identity(f"rows between the two: {count}", between, count, where=where))
    return Draft([[*cases, *row_index(row, lambda a, _: a + 1)]], believed=(INDUCTION,))


def unknowns(claim: Claim) -> Draft:
    """Return the first and the last unknown row."""
    first, last = claim.formulas
    return Draft(
        [[*rows_set(), *row_index(first, lambda a, _: a + 1), *row_index(last, lambda _, b: b - 1)]],
        believed=(INDUCTION,),
    )


def no_middle_curve(claim: Claim) -> Draft:
    """Return that for m = 5 all rows are set, and that six conditions determine them."""
    start, end = set_rows(2)
    between = Text(f"({text(end)}) - ({text(start)}) - 1", 1)
    cases: list[Statement] = [*rows_set(), identity("no row between them", between, 0, where=((text(pr.m), "5"),))]
    matrix = contact_matrix(4, 5, 2)
    spans = [sp.Rational(1, 3), sp.Rational(2, 3), sp.Integer(1)]
    unrolled = Lets("c")
    jets = end_jets(unrolled, 3, spans, 2)
    for d in range(3):
        for i in range(3):
            true = derivative(jets[i], d) if jets[i][d] is not None else 0
            cases.append(
                identity(
                    f"derivative {d} of function {i} at 0, by the recursion",
                    matrix[d, i],
                    true,
                    where=unrolled.pairs,
                    own=False,
                )
            )
            sign = Text(f"(-1)^{d}", 3)
            cases.append(
                identity(
                    f"derivative {d} of function {5 - i} at 1",
                    matrix[3 + d, 5 - i],
                    sign * text(matrix[d, i]),
                    own=False,
                )
            )
    return Draft([[*cases, rank("k = 4: the six conditions have one solution", matrix)]], believed=(INDUCTION,))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-3.m-bound": bound_of_m,
    "sec-3.three-curves": three_curves,
    "sec-3.two-kinds": two_kinds,
    "sec-4.unknowns": unknowns,
    "sec-4.no-middle-curve": no_middle_curve,
}
