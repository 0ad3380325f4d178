"""Counts of knots, functions and control points, for every order and number."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.derivations.counts import domain_ends, functions_of_order, last_knot, support_end
from semispline.papers.ledger import Claim, Formula
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as figures
from semispline.papers.lin2014.certificates.contact import INDUCTION
from semispline.papers.lin2014.certificates.untouched_bases import contact_curve
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.printed_pairs import inner_knots
from semispline.papers.recheck import Draft, Statement, Text, identity, knots, not_zero, positive, text

STEPS = (
    "each step of the recurrence makes one function of two neighbours and takes in one knot more: the counts follow by "
    "induction on the order (base and step are stated)"
)


_R, _L = sp.symbols("r L")


def count_induction() -> Iterator[Statement]:
    """Yield base and step of the number of functions on knots 0 .. L, and of where a function ends."""
    of_order = [functions_of_order(_L, order) for order in (sp.Integer(1), _R, _R + 1)]
    yield identity("functions of order 1 on knots 0 .. L", of_order[0], _L, own=False)
    yield identity("functions of one order more", of_order[2], Text(text(of_order[1]), 1) - 1, own=False)
    first = sp.Symbol("j")
    ends = [support_end(first, order) for order in (sp.Integer(1), _R, _R + 1)]
    yield identity("function j of order 1 ends at knot", ends[0], Text("j + 1", 1), own=False)
    yield identity("one order more ends a knot later", ends[2], Text(text(ends[1]), 1) + 1, own=False)


def last_index(count: Any, order: Any) -> Callable[[Formula], Iterator[Statement]]:
    """Return what decides the index of the last knot of `count` + 1 functions."""

    def cases(formula: Formula) -> Iterator[Statement]:
        yield from count_induction()
        where = ((text(pr.last), text(formula.relation.rhs)),)
        functions = functions_of_order(pr.last, order)
        label = "every order and count: functions on the printed knots"
        yield identity(label, functions, count + 1, where=where)
        yield identity("the derived index", formula.relation.rhs, last_knot(count, order))

    return cases


def run(count: Any, order: Any) -> Callable[[Formula], Iterator[Statement]]:
    """Return what decides the indices of the first and of the last knot of the domain."""

    def cases(formula: Formula) -> Iterator[Statement]:
        yield from count_induction()
        start, end = domain_ends(count, order)
        relation = formula.relation
        if relation.lhs == pr.last:
            yield identity("every order: the derived start", relation.rhs, start)
            true = support_end(sp.Integer(0), order - 1)
            yield identity("every order: where the first function of the order below ends", relation.rhs, true)
        else:
            yield identity("every order and count: the derived end", relation.rhs, end)
            below = Text(text(functions_of_order(last_knot(count, order), order - 1)), 1) - 1
            yield identity(
                "every order and count: where the last function of the order below starts", relation.rhs, below
            )

    return cases


def all_of(*makers: Callable[[Formula], Iterator[Statement]]) -> Callable[[Claim], Draft]:
    """Return the draft of a record with one maker for each of its formulas."""

    def draft(claim: Claim) -> Draft:
        pairs = zip(makers, claim.formulas, strict=True)
        return Draft([[case for maker, formula in pairs for case in maker(formula)]], believed=(STEPS,))

    return draft


def inner_indices(claim: Claim) -> Draft:
    """Return the indices of the first and the last inner knot: next to the ends of the domain."""
    start, end = domain_ends(pr.n_r, pr.ell)
    first, last = claim.formulas
    return Draft(
        [
            [
                *count_induction(),
                identity("every order: the knot after the start", first.relation.rhs, Text(text(start), 1) + 1),
                identity("every order and count: the knot before the end", last.relation.rhs, Text(text(end), 1) - 1),
            ]
        ],
        believed=(STEPS,),
    )


def u_vector(claim: Claim) -> Draft:
    """Return the length of U."""
    relation = claim.formulas[0].relation
    where = ((text(pr.last), text(last_knot(pr.m, pr.k))),)
    return Draft([[*count_induction(), identity("every m, k", *relation.args, where=where)]], believed=(STEPS,))


def uniform_knots(claim: Claim) -> Draft:
    """Return that the inner knots divide [0, 1] evenly."""
    printed = claim.formulas[0].relation.rhs
    inner = functions_of_order(last_knot(pr.m, pr.k), pr.k) - pr.k

    def knot(i: Any) -> Any:
        return Text(text(printed.subs(pr.i, i)), 1)

    middle = Text(f"({text(inner)}) + 1", 1)
    return Draft(
        [
            [
                *count_induction(),
                identity("every m, k: equal spans", knot(pr.i + 1) - knot(pr.i), knot(pr.i) - knot(pr.i - 1)),
                identity("the one before the first is 0", knot(sp.Integer(0)), 0),
                identity("the one after the last is 1", printed, 1, where=((text(pr.i), str(middle)),)),
            ]
        ],
        believed=(STEPS,),
    )


def middle_ends(claim: Claim) -> Draft:
    """Return how often v_s and v_e stand."""
    start, end = domain_ends(pr.n, pr.ell)
    printed = claim.formulas[0].relation.rhs
    return Draft(
        [
            [
                *count_induction(),
                identity("every order: knots up to the start", printed, Text(text(start), 1) + 1),
                identity(
                    "every order: knots from the end",
                    printed,
                    Text(f"{text(last_knot(pr.n, pr.ell))} - ({text(end)}) + 1", 1),
                ),
                *contact_curve(),
            ]
        ],
        believed=(STEPS, INDUCTION),
    )


def union_of_knots() -> Iterator[Statement]:
    """Yield what a union adds to both vectors where a knot stands c + d times in one and c times in the other."""
    both, times, others = Text("c + d", 1), Text("c"), Text("c + d", 1)
    gain = (both - times) + (both - others)
    yield positive("more often in one vector than in the other", gain, positive=("d",), nonnegative=("c",))
    yield identity("as often in both: none is added", (times - times) + (times - times), 0)


def superfluous(_: Claim) -> Draft:
    """Return what the union of two knot vectors adds, for any multiplicities and for the printed pairs."""
    cases: list[Statement] = [*union_of_knots()]
    middles = dict(zip(pr.SIZES, figures.MIDDLE_CURVES.relation.rhs, strict=True))
    for figure, (first, second) in CONTACTS.items():
        n_r, n_s = (size[1] for size in pr.SIZES[figure])
        shared, middle = len({*inner_knots(first), *inner_knots(second)}), int(middles[figure])
        own = f"3*({n_r} + {n_s}) + {middle}*({shared // 2} + 4)"
        cases.append(
            positive(f"{figure}: more control points on the union", Text(f"(6 + {middle})*({shared} + 4) - ({own})", 1))
        )
    return Draft([cases])


def different_counts(_: Claim) -> Draft:
    """Return layouts whose curves have different numbers of knots."""
    cases: list[Statement] = [not_zero("Fig. 1: curves 0 and 3", f"{pr.FIGURE_1_COUNTS[0]} - {pr.FIGURE_1_COUNTS[3]}")]
    for figure, pair in CONTACTS.items():
        lengths = [len(pr.KNOTS[name]) for name in pair]
        cases += [
            knots(f"{figure}: {name}", pr.KNOTS[name], f"points {n}", order=0)
            for name, n in zip(pair, lengths, strict=True)
        ]
        cases.append(not_zero(f"{figure}: the two differ", f"{lengths[0]} - {lengths[1]}"))
    return Draft([cases])


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-8": all_of(last_index(pr.m_r, pr.k_r), last_index(pr.n_r, pr.ell)),
    "eq-10": all_of(last_index(pr.m_s, pr.k_s), last_index(pr.n_s, pr.ell)),
    "sec-2.u-knots": all_of(last_index(pr.m, pr.k)),
    "sec-2.v-knots": all_of(last_index(pr.n_i, pr.ell)),
    "sec-1.classical-grid": all_of(last_index(pr.n_i, pr.ell)),
    "sec-3.bezier-ends": all_of(
        *(
            run(count, order)
            for count, order in ((pr.m_r, pr.k_r), (pr.n_r, pr.ell), (pr.m_s, pr.k_s), (pr.n_s, pr.ell))
            for _ in range(2)
        )
    ),
    "sec-3.contact-domain": all_of(run(pr.n_r, pr.ell), run(pr.n_s, pr.ell)),
    "sec-3.u-vector": u_vector,
    "sec-3.inner-knots": inner_indices,
    "sec-3.uniform-knots": uniform_knots,
    "sec-3.middle-ends": middle_ends,
    "sec-1.superfluous-knots": superfluous,
    "sec-1.different-counts": different_counts,
}
