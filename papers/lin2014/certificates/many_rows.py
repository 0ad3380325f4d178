"""What becomes of the least energy when rows, or knots along them, are added."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives
from semispline.papers.checks import clamped
from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014.certificates.counts import union_of_knots
from semispline.papers.lin2014.certificates.knot_vectors import nested_pairs
from semispline.papers.lin2014.certificates.least_energies import QUADRATIC, least_blend, least_strip
from semispline.papers.lin2014.certificates.minima import NO_ENERGY, one_minimum
from semispline.papers.lin2014.certificates.spline_steps import INDUCTION, SPACES, insertion, spaces
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.checks import fewer_control_points as fewer
from semispline.papers.lin2014.checks.printed_pairs import (
    PRINTED_PAIRS,
    WITH_MIDDLE_CURVE,
    inner_knots,
    merged,
    printed_pair,
)
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Statement,
    Term,
    Text,
    as_text,
    identity,
    integral_text,
    not_zero,
    positive,
    text,
    total,
)

CUBICS = (
    "of all functions with given values and slopes at both ends the cubic has the least energy: the integral of "
    "H'' (f - H)'' is zero, by parts, since H'''' is"
)
LAYER = "middle rows give nothing in a direction that is orthogonal to all splines over the averaged knots"


def fewer_rows(claim: Claim) -> Draft:
    """Return least energies without and with a middle curve, and their difference as a sum of two squares."""
    few, more = fewer.least_energies(*fewer.DATA).values()
    cases: list[Statement] = [
        *least_strip("no middle curve", 5, fewer.DATA, few),
        *least_strip("one middle curve", 6, fewer.DATA, more),
    ]
    for label, data in (
        ("a step at rest", (0, 0, 0, 1, 0, 0)),
        ("a slope that stops", (0, 1, 0, 0, 0, 0)),
        ("curvature at both ends", (0, 0, 1, 0, 0, 1)),
    ):
        where = tuple((text(letter), str(number)) for letter, number in zip(fewer.DATA, data, strict=True))
        gain = as_text(few) - as_text(more)
        if (few - more).subs(dict(zip(fewer.DATA, data, strict=True))) > 0:
            cases.append(positive(f"{label}: 6 rows cost more than 7", gain, where=where, affirmed=False))
        else:
            cases.append(positive(f"{label}: 6 rows cost no more than 7", 1 - gain, where=where))
    squares, nested = claim.corrected_formulas
    correction: list[Statement] = [
        identity("any contact data", squares.relation.rhs, as_text(few) - as_text(more)),
        positive("which is never negative", squares.relation.rhs, over=_squares(squares.relation.rhs), strict=False),
    ]
    value = "c + 2*g*x + h*x^2"
    correction.append(
        identity(
            "one control point more: value at 0 less value at -g/h",
            nested.relation.rhs,
            Text(f"c - ({value})", 1),
            where=(("x", "-g/h"),),
        )
    )
    return Draft([cases], correction, (QUADRATIC,))


def _squares(expression: Any) -> list[Term]:
    return [
        Term(coefficient=text(c), squares=(text(sp.Mul(*rest).base),))
        for c, rest in (term.as_coeff_mul() for term in sp.Add.make_args(expression))
    ]


def fairness(_: Claim) -> Draft:
    """Return knot lines in the printed pairs, and least energies over the rule's knots and over all."""
    lines: list[Statement] = [*union_of_knots()]
    for name, keys in PRINTED_PAIRS.items():
        vectors = [set(inner_knots(key)) for key in keys]
        both = len(set.union(*vectors))
        lines += [
            positive(f"{name}: {both} inner knots against {len(v)}", Text(f"{both} - {len(v)}", 1)) for v in vectors
        ]
    less: list[Statement] = []
    energies = []
    for label, (blend, points, energy_) in zip(("5/12", "1/3, 1/2"), energy.middle_knot_blends(), strict=True):
        free = [n for n, (i, _) in enumerate(blend.index) if i == 3]
        less += least_blend(f"middle curve over {label}", blend, points, free, energy_)
        energies.append(as_text(energy_))
    label = "orders 4, 2, inner knots 1/2 and 1/3: less energy on all knots"
    less.append(positive(label, energies[0] - energies[1], affirmed=False))
    return Draft([lines, [*less, *insertion(), *nested_pairs()]], believed=(QUADRATIC, INDUCTION, SPACES))


# A clamped cubic with spans of length 1; those of length h have h times the integrals of functions over spans.
_UNIT = [Fraction(max(i - 3, 0)) for i in range(11)]
# The cubic with the values a, c and slopes b, d at 0 and at l.
_CUBIC = (
    ("c_2", "(3*(c - a) - l*(2*b + d))/l^2"),
    ("c_3", "(2*(a - c) + l*(b + d))/l^3"),
)
_CUBIC_ENERGY = Text("4*c_2^2*l + 12*c_2*c_3*l^2 + 12*c_3^2*l^3", 1)


def least_cubic() -> Iterator[Statement]:
    """Yield that the cubic has its values and slopes, and that its energy is what is integrated from it."""
    yield identity("the cubic at the far end", Text("a + b*l + c_2*l^2 + c_3*l^3", 1), "c", where=_CUBIC, own=False)
    yield identity("its slope there", Text("b + 2*c_2*l + 3*c_3*l^2", 1), "d", where=_CUBIC, own=False)
    square = Text("(2*c_2)^2*l + 2*(2*c_2)*(6*c_3)*l^2/2 + (6*c_3)^2*l^3/3", 1)
    yield identity("the integral of the square of 2 c_2 + 6 c_3 x", square, _CUBIC_ENERGY, own=False)


def to_zero(formula: Formula) -> Iterator[Statement]:
    """Yield the least energy from a value and a slope down to zero, and that it is 3 d_0^2 / l^3 at the least."""
    yield from least_cubic()
    right = formula.relation.rhs
    where = (("l", "ell"), ("a", "d_0"), ("b", "d_1"), ("c", "0"), ("d", "0"), *_CUBIC)
    yield identity("every length, value and slope", right, _CUBIC_ENERGY, where=where)
    more = (as_text(right) - Text("3*d_0^2/ell^3", 2)) * Text("ell^3", 3)
    square = (Term(coefficient="1", squares=("3*d_0 + 2*ell*d_1",)),)
    yield positive("what is above 3 d_0^2 / l^3 is a square over l^3", more, over=square, strict=False)


def outside() -> Iterator[Statement]:
    """Yield figures with a middle curve: contact curves are no splines over the averaged knots."""
    for figure in WITH_MIDDLE_CURVE:
        v = merged(figure)
        averages = clamped(CUBIC, *((v[2 * i] + v[2 * i + 1]) / 2 for i in range(len(v) // 2)))
        for number, vector in enumerate(printed_pair(figure), start=1):
            yield spaces(f"{figure}, curve {number}: not over the averages", CUBIC, vector, averages, wanted=False)


def fewer_better(claim: Claim) -> Draft:
    """Return both readings: without a middle curve and with one; ever more rows over averaged knots."""
    few = fewer_rows(claim)
    formula = given(claim.readings[1].parts[0].formula)
    (first,) = few.readings
    believed = QUADRATIC, CUBICS, LAYER, INDUCTION, SPACES
    return Draft([first, [*to_zero(formula), *outside()]], few.correction, believed)


def layer(formula: Formula) -> Iterator[Statement]:
    """Yield the energy of the cubic H and multiples of the third function at both ends, for every span h."""
    yield from least_cubic()
    ends = end_derivatives(2, CUBIC - 1, (sp.Symbol("h"), 2 * sp.Symbol("h")))[:, 2]
    for d, wanted in enumerate(("0", "0", "3/h^2")):
        yield identity(f"B_2 at u = 0: derivative {d}", ends[d], Text(wanted, 2), own=False)
    third = (_UNIT, 2, 2)
    yield identity("the integral of B_2'' is 0", integral_text(CUBIC, third), 0, own=False)
    # x is the spline with its Greville abscissae for control points.
    means = [sum(_UNIT[i + 1 : i + 4], Fraction(0)) / 3 for i in range(6)]
    parts = [as_text(mean) * integral_text(CUBIC, (_UNIT, i, 0), third) for i, mean in enumerate(means)]
    yield identity(
        "the integral of x B_2'' is 0, so that of H'' B_2'' is for every cubic H", total(parts), 0, own=False
    )
    square = integral_text(CUBIC, third, third)
    true = Text("(h^2/3)^2*(delta_0^2 + delta_1^2)", 2) * square / Text("h^3", 3)
    yield identity("every h and both ends", formula.relation.rhs, true)
    for data in ((0, 0, 1, 0, 0, 1), (0, 1, 2, 3, -1, 0)):
        for m in (8, 12):
            found = energy.end_energy(CUBIC, m, data)
            where = (*_ends(data), ("h", f"1/{m - 2}"), *_lacks(data))
            label = f"{m + 1} rows, end data {data}"
            yield from least_strip(label, m, data, found)
            yield positive(f"{label}: more than the cubic", Text(f"{text(found)} - (e_H)", 1), where=where)
            above = Text(f"e_H + {as_text(formula.relation.rhs).at(2)} - {as_text(found).at(2)}", 1)
            yield positive(f"{label}: no more than that", above, where=where)


def _ends(data: tuple[int, ...]) -> tuple[tuple[str, str], ...]:
    names = zip("abcd", (data[0], data[1], data[3], data[4]), strict=True)
    return (*((name, str(value)) for name, value in names), ("l", "1"), *_CUBIC, ("e_H", str(_CUBIC_ENERGY)))


def _lacks(data: tuple[int, ...]) -> tuple[tuple[str, str], ...]:
    """Return the prescribed second derivatives less those of the cubic."""
    return (("delta_0", f"{data[2]} - 2*c_2"), ("delta_1", f"{data[5]} - (2*c_2 + 6*c_3)"))


def over_rows(claim: Claim) -> Draft:
    """Return that there is a minimum for each number of rows, and none over all numbers."""
    never: list[Statement] = []
    for label, data in (
        ("curvature at both ends", (0, 0, 1, 0, 0, 1)),
        ("a step at rest, straight at both ends", (0, 0, 0, 1, 0, 0)),
    ):
        where = (*_ends(data), *_lacks(data))
        for m in (6, 10, 18):
            found = energy.end_energy(CUBIC, m, data)
            never += least_strip(f"{label}, {m + 1} rows", m, data, found)
            more = Text(f"{text(found)} - (e_H)", 1)
            never.append(positive(f"{label}: {m + 1} rows cost more than the cubic", more, where=where, affirmed=False))
        never.append(not_zero(f"{label}: the cubic has another second derivative", "delta_0", where=where, own=False))
    correction = layer(claim.corrected_formulas[0])
    return Draft([one_minimum(2), never], correction, (INDUCTION, NO_ENERGY, QUADRATIC, CUBICS))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-1.fairness": fairness,
    "sec-3.fewer-better": fewer_better,
    "sec-3.minimum-over-rows": over_rows,
}
