"""Which surfaces carry curves over different knot vectors, and over which domain."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

from semispline.papers.checks import clamped, union
from semispline.papers.ledger import Claim, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as figures
from semispline.papers.lin2014.certificates.spline_steps import (
    INDUCTION,
    SPACES,
    insertion,
    partition,
    sharp_continuity,
    spaces,
)
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.printed_pairs import PRINTED_PAIRS, printed_pair
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import Draft, Statement, Text, basis_number, different, identity, knots, text, total


def nested_pairs() -> Iterator[Statement]:
    """Yield the printed pairs: both lie in the space of the union of their knots."""
    for name in PRINTED_PAIRS:
        pair = printed_pair(name)
        for n, vector in enumerate(pair, start=1):
            yield spaces(f"{name}, vector {n}", CUBIC, vector, union(CUBIC, *pair))


def common_domain(_: Claim) -> Draft:
    """Return that curves are defined where their functions sum to 1, and domains that lack a part of [0, 1]."""
    first = clamped(CUBIC, Fraction(1, 2))
    cases: list[Statement] = [*partition()]
    for label, second, meets in (
        ("V_1 over [0, 1]", clamped(CUBIC, Fraction(1, 3)), True),
        ("V_1 over [-1, 2], which contains [0, 1]", clamped(CUBIC, Fraction(1, 2), start=-1, end=2), True),
        ("V_1 over [0, 3/4]", clamped(CUBIC, Fraction(1, 3), end=Fraction(3, 4)), False),
        ("V_1 over [1/4, 1]", clamped(CUBIC, Fraction(1, 2), start=Fraction(1, 4)), False),
    ):
        for v in [Fraction(n, 8) for n in range(9)] if meets else [Fraction(0), Fraction(1)]:
            for n, vector in enumerate((first, second)):
                values = [basis_number(CUBIC, vector, i, v) for i in range(len(vector) - CUBIC)]
                inside = vector[0] <= v <= vector[-1]
                where = f"{label}: functions of V_{n} at v = {v}"
                total_ = total([Text("0"), *(x for x in values if x)])
                if meets:
                    cases.append(identity(where, total_, 1))
                elif not inside:
                    cases.append(different(where, total_, 1, own=False, meets=False))
    return Draft([cases], believed=(INDUCTION,))


def not_classical(_: Claim) -> Draft:
    """Return the printed pairs, neither of which carries both curves, and a nested pair."""
    half = Fraction(1, 2)
    cases: list[Statement] = [*sharp_continuity(own=False)]
    for name in PRINTED_PAIRS:
        a, b = printed_pair(name)
        for n, (one, other) in enumerate(((a, b), (b, a)), start=1):
            cases.append(spaces(f"{name}, way {n}", CUBIC, one, other, wanted=False))
    nested = clamped(4, half), clamped(4, half / 2, half, 3 * half / 2)
    cases.append(spaces("{1/2} and {1/4, 1/2, 3/4}", CUBIC, *nested, wanted=False, own=False, meets=False))
    return Draft([cases], believed=(INDUCTION, SPACES))


def different_vectors(claim: Claim) -> Draft:
    """Return how many vectors of a blend differ, and a surface with as many as curves."""
    printed = given(claim.readings[0].parts[0].formula).relation.rhs
    counts = dict(zip(pr.SIZES, figures.MIDDLE_CURVES.relation.rhs, strict=True))
    same: list[Statement] = []
    for figure, (a, b) in CONTACTS.items():
        middle = int(counts[figure])
        vectors = [pr.KNOTS[a]] * 3 + ["middle"] * middle + [pr.KNOTS[b]] * 3
        same.append(
            different(
                f"{figure}: {len(set(vectors))} different vectors",
                printed,
                len(set(vectors)),
                where=((text(pr.m), str(5 + middle)),),
            )
        )
    own: list[Statement] = [*partition()]
    for order in (2, 3, 4):
        for i in range(1, 6):
            vector = clamped(order, Fraction(i, 7))
            values = [basis_number(order, vector, j, Fraction(3, 7)) for j in range(len(vector) - order)]
            own.append(
                identity(
                    f"order {order}, knot {i}/7: functions at 3/7", total(x for x in values if x), 1, own=order == CUBIC
                )
            )
    return Draft([same, own], believed=(INDUCTION,))


def insertion_of_pairs(_: Claim) -> Draft:
    """Return that knot insertion makes the printed pairs identical."""
    return Draft([[*insertion(), *nested_pairs()]], believed=(INDUCTION, SPACES))


def same_knots(claim: Claim) -> Draft:
    """Return the patches of Fig. 5 over {1/2}: a polynomial one can be, others cannot."""
    third = Fraction(1, 3)
    polynomial, own, wanted = clamped(CUBIC), clamped(CUBIC, third, 2 * third), clamped(CUBIC, Fraction(1, 2))
    vector = claim.formulas[0].relation.rhs
    return Draft(
        [
            [
                knots("the vector of the first patch", vector, "equal", other=pr.KNOTS["fig-5.first"]),
                spaces("a plane with coordinates polynomial in v", CUBIC, polynomial, wanted),
                spaces("any plane patch over {1/3, 2/3}", CUBIC, own, wanted, own=False, meets=False),
            ]
        ],
        believed=(SPACES,),
    )


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-1.knot-insertion": insertion_of_pairs,
    "def-1": common_domain,
    "sec-3.not-classical": not_classical,
    "sec-2.different-vectors": different_vectors,
    "fig-5.same-knots": same_knots,
}
