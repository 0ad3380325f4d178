"""Deciding how many knots and control points a blend has after conversion, and what the rule for middle knots gives.

Conversion brings all rows onto the knots of all of them. Direct insertion, which the paper rejects, brings them onto
the knots of both contact curves alone. An average lies strictly between two neighbours of v_1 .. v_n, the inner knots
of both curves, each once; so it is a knot of neither, and each pair adds one, whatever the two vectors share.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case, Check, Consequence, Counterexample, Formula, Strength, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.printed_pairs import inner_knots
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.lin2014.printed_figures import MIDDLE_CURVES

# Inner knots of the converted blend with one middle curve: N of both contact curves together, q complete pairs.
N_UNION, PAIRS, N_CONVERTED = (sp.Symbol(name, integer=True, nonnegative=True) for name in ("N_u", "q", "N_c"))
CONVERTED = Formula(sp.Eq(N_CONVERTED, N_UNION + PAIRS), (N_CONVERTED, N_UNION, PAIRS))
# Control points with rows on their own knots, less those on the knots of both: s shared inner knots, r and t of one
# curve alone, one middle curve or none (c = 1, 0) with d of the knots in it.
SHARED, ALONE_R, ALONE_S, IN_MIDDLE = (sp.Symbol(n, integer=True, nonnegative=True) for n in ("s", "r", "t", "d"))
MIDDLE, SAVED = sp.Symbol("c", integer=True, nonnegative=True), sp.Symbol("D", integer=True)
SAVED_OWN = Formula(
    sp.Eq(SAVED, 3 * (ALONE_R + ALONE_S) + MIDDLE * (SHARED + ALONE_R + ALONE_S - IN_MIDDLE)),
    (SAVED, MIDDLE, SHARED, ALONE_R, ALONE_S, IN_MIDDLE),
)

Vector = Sequence[Fraction]
_EIGHTHS = [Fraction(i, 8) for i in range(9)]
# Inner knots of two contact curves, beside those that are printed.
PAIRS_OF_VECTORS: dict[str, tuple[Vector, Vector]] = {
    "no knot is shared": (_EIGHTHS[1:3], _EIGHTHS[5:7]),
    "one knot is shared": (_EIGHTHS[1:3], _EIGHTHS[2:4]),
    "one vector within the other": (_EIGHTHS[2:3], _EIGHTHS[1:5]),
    "equal vectors": (_EIGHTHS[2:5], _EIGHTHS[2:5]),
    "double knots": ([*_EIGHTHS[2:3] * 2, _EIGHTHS[5]], [_EIGHTHS[2], *_EIGHTHS[6:7] * 3]),
    "one knot in all": (_EIGHTHS[4:5], _EIGHTHS[4:5]),
    "no inner knot": ([], []),
}


def merged_once(first: Vector, second: Vector) -> list[Fraction]:
    """Return v_1 .. v_n: the inner knots of both, each once."""
    return sorted({*first, *second})


def pair_means(v: Vector) -> list[Fraction]:
    """Return the averages of complete pairs."""
    return [(v[i] + v[i + 1]) / 2 for i in range(0, len(v) - 1, 2)]


# What becomes of the last of an odd number of knots: each a reading of the rule, or what our own examples do.
UNPAIRED: dict[str, Callable[[Vector], list[Fraction]]] = {
    "dropped": pair_means,
    "kept": lambda v: [*pair_means(v), *v[len(v) - len(v) % 2 :]],
    "averaged with v_e": lambda v: [*pair_means(v), *((x + 1) / 2 for x in v[len(v) - len(v) % 2 :])],
    "the last three averaged": lambda v: (
        [*pair_means(v[:-3]), sum(v[-3:], Fraction(0)) / 3] if len(v) % 2 and len(v) > 1 else pair_means(v)
    ),
    "each with the next": lambda v: [(a + b) / 2 for a, b in pairwise(v)],
}


def together(*vectors: Vector) -> Counter[Fraction]:
    """Return each knot of some vectors with its largest multiplicity."""
    found: Counter[Fraction] = Counter()
    for vector in vectors:
        found |= Counter(vector)
    return found


def _all_pairs() -> dict[str, tuple[Vector, Vector]]:
    printed = {figure: (inner_knots(first), inner_knots(second)) for figure, (first, second) in CONTACTS.items()}
    return printed | PAIRS_OF_VECTORS


def converted_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the number of inner knots after conversion: a mean is no knot of either curve; counted on vectors."""
    relation = given(formula).relation
    place, gap = sp.symbols("v g", positive=True)
    mean = (place + (place + gap)) / 2
    yield Case(
        "a mean lies between its two knots", bool((mean - place).is_positive and (place + gap - mean).is_positive)
    )
    residual = sp.expand(relation.rhs - relation.lhs + N_CONVERTED - (N_UNION + PAIRS))
    yield Case("every pair of vectors: one knot for each pair", bool(residual == 0), residual=residual)
    for label, (first, second) in _all_pairs().items():
        v = merged_once(first, second)
        both = together(first, second)
        all_rows = together(first, second, pair_means(v)).total()
        values = {N_CONVERTED: all_rows, N_UNION: both.total(), PAIRS: len(v) // 2}
        off = (relation.rhs - relation.lhs).subs(values)
        yield Case(f"{label}: {both.total()} and {all_rows}", bool(off == 0), own=label in CONTACTS, residual=off)


CONVERTED_CHECK = Check(
    converted_cases,
    Strength.GENERAL,
    "where a mean of two knots lies, for every pair of vectors; multiplicities counted on printed and other vectors",
    proof=True,
)


def no_more_cases(_: Formula | None) -> Iterator[Case]:
    """Yield figures, true where the converted blend has no more inner knots than both contact curves together."""
    counts = dict(zip(pr.SIZES, MIDDLE_CURVES.relation.rhs, strict=True))
    for figure in CONTACTS:
        both, rows = _inner_knots(figure, "dropped")
        more = sp.Integer(max(rows - both, 0))
        yield Case(f"{figure}, {counts[figure]} middle curves: {both} and {rows}", rows <= both, residual=more)


def _inner_knots(figure: str, unpaired: str) -> tuple[int, int]:
    """Return how many inner knots both contact curves have together, and the converted blend."""
    first, second = (inner_knots(key) for key in CONTACTS[figure])
    middle = dict(zip(pr.SIZES, MIDDLE_CURVES.relation.rhs, strict=True))[figure]
    averages = UNPAIRED[unpaired](merged_once(first, second)) if middle else []
    return together(first, second).total(), together(first, second, averages).total()


def saved_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide what own knots save for every number of knots, and that it is nothing only for equal vectors."""
    relation = given(formula).relation
    order = pr.ell
    union = SHARED + ALONE_R + ALONE_S + order
    own = 3 * (SHARED + ALONE_R + order) + 3 * (SHARED + ALONE_S + order) + MIDDLE * (IN_MIDDLE + order)
    residual = sp.expand(relation.rhs - relation.lhs + SAVED - ((6 + MIDDLE) * union - own))
    yield Case("every order and number of knots", bool(residual == 0), residual=residual)
    # The rule gives the middle curve no more knots than there are: d = n - e.
    spare, one = sp.Symbol("e", integer=True, nonnegative=True), sp.Symbol("a", integer=True, positive=True)
    fewer = {IN_MIDDLE: SHARED + ALONE_R + ALONE_S - spare}
    least = sp.expand((relation.rhs - relation.lhs + SAVED).subs(fewer).subs(ALONE_R, one))
    yield Case("a knot that one curve has alone: something is saved", bool(least.is_positive))


def saving_consequence() -> Consequence:
    """Count control points figure by figure: rows on their own knots, on the knots of both, and after conversion."""
    counts = dict(zip(pr.SIZES, MIDDLE_CURVES.relation.rhs, strict=True))
    measured: dict[str, float] = {}
    for figure, pair in CONTACTS.items():
        name = figure.replace("fig-", "Fig. ")
        first, second = (inner_knots(key) for key in pair)
        rows = 6 + int(counts[figure])
        of_contacts = 3 * (len(first) + len(second) + 2 * CUBIC)
        averages = {word: len(rule(merged_once(first, second))) for word, rule in UNPAIRED.items()}
        own = {word: of_contacts + (rows - 6) * (number + CUBIC) for word, number in averages.items()}
        converted = {word: rows * (_inner_knots(figure, word)[1] + CUBIC) for word in UNPAIRED}
        measured |= _by_reading(f"{name}, own knots", own)
        measured[f"{name}, knots of both"] = rows * (together(first, second).total() + CUBIC)
        measured |= _by_reading(f"{name}, converted", converted)
    return on_surface("Control points with the printed knots, by what becomes of an unpaired knot", measured)


def _by_reading(name: str, found: dict[str, int]) -> dict[str, int]:
    """Return a count, or one for each of those that the readings of the rule give."""
    kinds: dict[int, list[str]] = {}
    for word, number in found.items():
        kinds.setdefault(number, []).append(word)
    if len(kinds) == 1:
        return {name: next(iter(kinds))}
    # Where no knot is left without a partner all readings that pair are one.
    pairing = [word for word in UNPAIRED if word != "each with the next"]
    said = {number: "in pairs" if words == pairing else " or ".join(words) for number, words in kinds.items()}
    return {f"{name} ({words})": number for number, words in said.items()}


def converted_counterexample() -> Counterexample:
    """Return Fig. 6, whose two vectors have ten knots between them."""
    both, rows = _inner_knots("fig-6", "dropped")
    first, second = (inner_knots(key) for key in CONTACTS["fig-6"])
    values = (("figure", "6"), ("inner knots of the curves", f"{len(first)} and {len(second)}, none shared"))
    return Counterexample(values, f"at most {both} inner knots after conversion", str(rows))


def few_knots_cases() -> Iterator[Case]:
    """Yield every number of knots from 2 on, then pairs of vectors, true where the rule gives a knot."""
    place, gap = sp.symbols("v g", positive=True)
    mean = pair_means((place, place + gap))[0]
    inside = bool((mean - place).is_positive and (place + gap - mean).is_positive)
    yield Case("every n from 2 on: v_1 and v_2 are a pair, and their mean lies between them", inside)
    for label, (first, second) in _all_pairs().items():
        v = merged_once(first, second)
        yield Case(f"{label}: n = {len(v)}", bool(pair_means(v)), own=len(v) >= 2, meets=len(v) >= 2)


def mirrored_pair_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide whether the rule, read in the other direction of v, gives the same knots, mirrored.

    With w_i = 1 - v_{n+1-i}, the knots in the other direction, mean i of the w is 1 less a mean of two of the v.
    """
    relation = given(formula).relation
    i = relation.lhs.args[0]
    half = sp.Symbol("q", integer=True, positive=True)
    for n, label in ((2 * half, "n even"), (2 * half + 1, "n odd, the last knot without a partner")):
        there = relation.rhs.replace(lambda x: isinstance(x, sp.Indexed), lambda x, n=n: 1 - pr.x[n + 1 - x.indices[0]])
        # Mean i counted from the other end, of q in all.
        back = 1 - there.subs(i, half + 1 - i, simultaneous=True)
        here, back = (sp.expand(side.replace(_is_entry, _sorted_entry)) for side in (relation.rhs, back))
        residual = sp.expand(back - here)
        yield Case(label, bool(residual == 0), residual=residual)


def mirrored_counterexample() -> Counterexample:
    """Return Fig. 5: the mean of its first two knots, and that of the last two."""
    first, second = (inner_knots(key) for key in CONTACTS["fig-5"])
    v = merged_once(first, second)
    (there,), (mirrored,) = pair_means(v), pair_means([1 - x for x in reversed(v)])
    values = (("v_1, v_2, v_3", ", ".join(map(str, v))),)
    return Counterexample(values, f"{there} in one direction", f"{1 - mirrored} in the other")


def _is_entry(expression: object) -> bool:
    return isinstance(expression, sp.Indexed)


def _sorted_entry(entry: sp.Indexed) -> sp.Indexed:
    return pr.x[sp.expand(entry.indices[0])]


# Of a knot and of the next one.
_WEIGHTS = (sp.Rational(1, 2), sp.Rational(1, 2))


def mirrored_neighbour_cases(_: Formula | None) -> Iterator[Case]:
    """Yield the other reading, each knot with the next one, in the other direction: mean i is mean n - i, mirrored."""
    n, i = sp.symbols("n i", integer=True, positive=True)

    def mean(knot: Callable[[Any], Any], at: Any) -> Any:
        return sum(weight * knot(at + step) for step, weight in enumerate(_WEIGHTS))

    there = mean(lambda at: 1 - pr.x[sp.expand(n + 1 - at)], n - i)
    residual = sp.expand(1 - there - mean(lambda at: pr.x[at], i))
    yield Case("every n", bool(residual == 0), residual=residual)
