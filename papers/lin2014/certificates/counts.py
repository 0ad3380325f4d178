"""Counts of knots, functions, rows and control points, for every order and number."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.derivations.bezier import row_degrees
from semispline.derivations.counts import domain_ends, functions_of_order, last_knot, support_end
from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as figures
from semispline.papers.lin2014.certificates.contact import INDUCTION, induction
from semispline.papers.lin2014.certificates.untouched_bases import contact_curve, three_rows
from semispline.papers.lin2014.checks.bezier_patch import DEGREES
from semispline.papers.lin2014.checks.construction import contact_matrix, set_rows
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.printed_pairs import inner_knots
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Lets,
    Statement,
    Text,
    derivative,
    end_jets,
    identity,
    knots,
    not_zero,
    positive,
    rank,
    text,
)

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


def row_counts(part: str) -> Callable[[Claim], Draft]:
    """Return the draft of the number of control points of each row of a sub-patch."""

    def draft(claim: Claim) -> Draft:
        formula = claim.formulas[0]
        return Draft([row_count_cases(formula, part)], believed=(DEGREE,))

    return draft


DEGREE = "a sum of products of m + s k factors of degree 1 in u has degree m + s k at the most"


def row_count_cases(formula: Formula, part: str) -> Iterator[Statement]:
    """Yield degrees: the patch u^m v^s over v(u) = u^k needs as many points as printed, and the derived rows have."""
    printed = formula.relation.rhs
    powers = pr.s if part == "bottom" else pr.n - pr.s
    yield identity("every m, n, k, s", printed, Text(f"m + ({text(powers)})*k + 1", 1))
    for m, n, k in DEGREES:
        derived = row_degrees(m, n, k, "bottom" if part == "bottom" else "top")
        for r in range(n + 1):
            points = printed.subs({pr.s: r, pr.m: m, pr.n: n, pr.k: k})
            power = r if part == "bottom" else n - r
            label = f"degrees {m}, {n}, {k}, row {r}"
            yield identity(
                f"{label}: the patch u^m v^{power}", f"u^{m}*(u^{k})^{power}", f"u^{points - 1}", own=m == n == 3
            )
            yield identity(f"{label}: the derived row", points, Text(f"{derived[r]} + 1", 1), own=m == n == 3)


def last_row(claim: Claim) -> Draft:
    """Return the name of the last row of the top sub-patch."""

    def case(formula: Formula, *, equal: bool) -> Statement:
        j, s = formula.relation.lhs.args
        return identity(
            f"every m, n, k: Q_j^s with j = {j}, s = {s}",
            Text(f"m + ({text(s)})*k + 1", 1),
            formula.relation.rhs,
            equal=equal,
            conditions=("n > 0", "k > 0"),
        )

    return Draft([[case(claim.formulas[0], equal=False)]], [case(claim.corrected_formulas[0], equal=True)], (DEGREE,))


def averaging(claim: Claim) -> Draft:
    """Return the averages by pairs, the last of which may not exist, and those of all neighbours."""
    relation = given(claim.readings[0].parts[0].formula).relation
    pair = [entry.indices[0] for entry in sorted(relation.rhs.atoms(sp.Indexed), key=str)]
    before = Text("2*(i - 1)", 2)
    used: list[Statement] = [
        identity("every pair: its first knot", min(pair, key=lambda e: e.subs(pr.i, 1)), before + 1),
        identity("every pair: its second knot", max(pair, key=lambda e: e.subs(pr.i, 1)), before + 2),
    ]
    last = text(max(pair, key=lambda e: e.subs(pr.i, 1)))
    missing = positive(
        "n = 2 q + 1, i = q + 1: the second knot would have an index above n",
        Text(f"({last}) - (2*q + 1)", 1),
        where=((text(pr.i), "q + 1"),),
        nonnegative=("q",),
        affirmed=False,
    )
    complete = [
        identity("n = 2 q or 2 q + 1, i = q: its last knot is v_2q", last, Text("2*q", 2), where=((text(pr.i), "q"),)),
    ]
    first, second = Text("(v + (v + g))/2", 2), Text("((v + g) + (v + g + h))/2", 2)
    sliding: list[Statement] = [
        positive("neighbours: a mean lies above the first knot", first - "v", positive=("g", "h", "v")),
        positive("and the next one above it", second - first, positive=("g", "h", "v")),
        positive("and below the last knot", Text("v + g + h", 1) - second, positive=("g", "h", "v")),
    ]
    return Draft([[*used, missing], [*used, *complete], sliding])


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
    "sec-3.m-bound": bound_of_m,
    "sec-3.three-curves": three_curves,
    "sec-3.two-kinds": two_kinds,
    "sec-3.averaging": averaging,
    "sec-3.middle-ends": middle_ends,
    "sec-4.unknowns": unknowns,
    "sec-4.no-middle-curve": no_middle_curve,
    "sec-1.superfluous-knots": superfluous,
    "sec-1.different-counts": different_counts,
    "sec-2.bottom-counts": row_counts("bottom"),
    "sec-2.top-counts": row_counts("top"),
    "sec-2.top-last-row": last_row,
}
