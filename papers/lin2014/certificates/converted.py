"""Knots of the blend: after conversion, by the rule for the middle curve, and in the other direction of v."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import zip_longest
from typing import Any

import sympy as sp

from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.converted_blends import PAIRS_OF_VECTORS
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.printed_pairs import PRINTED_PAIRS, inner_knots, printed_pair
from semispline.papers.lin2014.printed_figures import MIDDLE_CURVES
from semispline.papers.recheck import Draft, Statement, Text, identity, knots, not_zero, positive, text

RULE = "v_1 .. v_n are the inner knots of both curves, each once, and the rule pairs 1 and 2, 3 and 4, and so on"

Vector = list[Fraction]


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


def mismatched(_: Claim) -> Draft:
    """Return the first knot in which the two vectors of a printed pair differ, or that one of them is longer."""
    cases: list[Statement] = []
    for name in PRINTED_PAIRS:
        one, other = printed_pair(name)
        pairs = enumerate(zip_longest(one, other, fillvalue=None))
        place, (a, b) = next((i, pair) for i, pair in pairs if pair[0] != pair[1])
        if a is None or b is None:
            cases.append(not_zero(f"{name}: lengths differ", Text(f"{len(one)} - {len(other)}", 1)))
        else:
            cases.append(not_zero(f"{name}: knot {place} differs", Text(f"({text(a)}) - ({text(b)})", 1)))
    return Draft([cases])


def _vectors() -> Iterator[tuple[str, Vector, Vector]]:
    for figure, (first, second) in CONTACTS.items():
        yield figure, inner_knots(first), inner_knots(second)
    for label, (one, other) in PAIRS_OF_VECTORS.items():
        yield label, list(one), list(other)


def _counted(first: Vector, second: Vector, *, averages: bool = True) -> tuple[Vector, Vector, int]:
    """Return the knots of both, those with the means of complete pairs, and the number of pairs, by counting anew."""
    both: Vector = []
    for knot in sorted({*first, *second}):
        both += [knot] * max(first.count(knot), second.count(knot))
    once = sorted(set(both))
    means = [(once[2 * i] + once[2 * i + 1]) / 2 for i in range(len(once) // 2)] if averages else []
    return both, sorted(both + [x for x in means if x not in both]), len(once) // 2


def saved(formula: Formula) -> Iterator[Statement]:
    """Yield the control points on the knots of both less those on own knots, and that a knot alone saves some."""
    rows = "3*(s + r + ell) + 3*(s + t + ell) + c*(d + ell)"
    yield identity(
        "every order and number of knots", formula.relation.rhs, Text(f"(6 + c)*(s + r + t + ell) - ({rows})", 1)
    )
    yield positive(
        "a knot that one curve has alone: something is saved",
        formula.relation.rhs,
        where=(("r", "1 + r_more"), ("d", "s + r + t - e")),
        nonnegative=("s", "t", "c", "e", "r_more"),
    )


def after_conversion(claim: Claim) -> Draft:
    """Return the saving on own knots, the knots of figures after conversion, and how many a conversion adds."""
    counts = dict(zip(pr.SIZES, MIDDLE_CURVES.relation.rhs, strict=True))
    no_more: list[Statement] = []
    for figure, (one, other) in CONTACTS.items():
        both, rows, _ = _counted(inner_knots(one), inner_knots(other), averages=bool(counts[figure]))
        label = f"{figure}, {counts[figure]} middle curves"
        no_more.append(knots(f"{label}: inner knots of the converted blend", rows, f"points {len(rows)}", order=0))
        if len(rows) > len(both):
            no_more.append(
                positive(f"{label}: more than both curves have", Text(f"{len(rows)} - {len(both)}", 1), affirmed=False)
            )
        else:
            no_more.append(identity(f"{label}: as many as both curves have", Text(f"{len(rows)} - {len(both)}", 1), 0))
    converted = claim.corrected_formulas[0].relation.rhs
    correction: list[Statement] = [
        *between(),
        identity("one knot for each pair", converted, Text("N_u + 1*q", 1)),
    ]
    for label, a, b in _vectors():
        both, rows, pairs = _counted(a, b)
        where = (("N_u", str(len(both))), ("q", str(pairs)))
        own: dict[str, Any] = {"own": label in CONTACTS}
        correction.append(identity(f"{label}: counted", converted, len(rows), where=where, **own))
    return Draft([saved(given(claim.readings[0].parts[0].formula)), no_more], correction, (RULE,))


def between() -> Iterator[Statement]:
    """Yield that the mean of two knots lies between them."""
    yield positive("a mean lies above the first of its two knots", Text("(v + (v + g))/2 - v", 1), positive=("g",))
    yield positive("and below the second one", Text("(v + g) - (v + (v + g))/2", 1), positive=("g",))


def few_knots(_: Claim) -> Draft:
    """Return that the rule has a pair for every n >= 2, and for which pairs of vectors it has one."""
    room = Text("2 + r - 2 + 1", 1)
    last = positive("every n = 2 + r: v_2, the second of a pair, is one of v_1 .. v_n", room, nonnegative=("r",))
    cases: list[Statement] = [last, *between()]
    for label, one, other in _vectors():
        n = len({*one, *other})
        if n >= 2:
            cases.append(positive(f"{label}: n = {n}, a pair", Text(f"{n} - 2 + 1", 1)))
        else:
            flags: dict[str, Any] = {"own": False, "meets": False}
            cases.append(positive(f"{label}: n = {n}, no pair", Text(f"2 - {n}", 1), affirmed=False, **flags))
    return Draft([cases], believed=(RULE,))


def direction(claim: Claim) -> Draft:
    """Return the indices of a pair, and those of the pair that the rule makes when v runs the other way.

    There w_i = 1 - v_(n + 1 - i); the q means of pairs are counted from the other end.
    """
    relation = given(claim.readings[0].parts[0].formula).relation
    places = sorted((e.indices[0] for e in relation.rhs.atoms(sp.Indexed)), key=lambda e: e.subs(pr.i, 1))
    first, second = map(text, places)
    i = text(pr.i)

    def mirrored(place: Any, n: str) -> Text:
        return Text(f"{n} + 1 - ({text(place.subs(pr.i, sp.Symbol('q') + 1 - pr.i))})", 1)

    pairs: list[Statement] = []
    for n, equal in (("2*q", True), ("(2*q + 1)", False)):
        for here, there in ((first, places[1]), (second, places[0])):
            label = f"n = {n.strip('()')}: v_{here} in one direction and in the other one"
            pairs.append(identity(label, Text(here, 1), mirrored(there, n), equal=equal))
    neighbours: list[Statement] = [
        identity("neighbours, every n: the first of mean i", Text(i), Text(f"n + 1 - (n - {i} + 1)", 1)),
        identity("neighbours, every n: the second one", Text(f"{i} + 1", 1), Text(f"n + 1 - (n - {i})", 1)),
    ]
    return Draft([pairs, neighbours], believed=(RULE,))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-3.averaging": averaging,
    "sec-1.mismatched": mismatched,
    "sec-1.after-conversion": after_conversion,
    "sec-3.averaging-few": few_knots,
    "sec-3.averaging-direction": direction,
}
