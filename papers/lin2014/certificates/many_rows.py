"""What becomes of the least energy when rows are added, and where it lies over alpha and beta between facing bases."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives
from semispline.papers.ledger import Claim, Formula, clamped, given
from semispline.papers.lin2014.certificates.energy import LEAST, NO_ENERGY, fewer_rows, one_minimum
from semispline.papers.lin2014.certificates.surfaces import INDUCTION, SPACES, spaces
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.checks import facing_bases as facing
from semispline.papers.lin2014.checks.printed_pairs import WITH_MIDDLE_CURVE, merged, printed_pair
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Statement,
    Term,
    Text,
    as_text,
    identity,
    integral,
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
    return Draft([first, [*to_zero(formula), *outside()]], few.correction, (LEAST, CUBICS, LAYER, INDUCTION, SPACES))


def layer(formula: Formula) -> Iterator[Statement]:
    """Yield the energy of the cubic H and multiples of the third function at both ends, for every span h."""
    yield from least_cubic()
    ends = end_derivatives(2, CUBIC - 1, (sp.Symbol("h"), 2 * sp.Symbol("h")))[:, 2]
    for d, wanted in enumerate(("0", "0", "3/h^2")):
        yield identity(f"B_2 at u = 0: derivative {d}", Text(f"({text(ends[d])})*1", 2), Text(wanted, 2), own=False)
    third = (_UNIT, 2, 2)
    yield identity("the integral of B_2'' is 0", Text(f"{integral(CUBIC, third)} + 0", 1), 0, own=False)
    # x is the spline with its Greville abscissae for control points.
    means = [sum(_UNIT[i + 1 : i + 4], Fraction(0)) / 3 for i in range(6)]
    parts = [as_text(mean) * as_text(integral(CUBIC, (_UNIT, i, 0), third)) for i, mean in enumerate(means)]
    yield identity(
        "the integral of x B_2'' is 0, so that of H'' B_2'' is for every cubic H", total(parts), 0, own=False
    )
    square = as_text(integral(CUBIC, third, third))
    true = Text("(h^2/3)^2*(delta_0^2 + delta_1^2)", 2) * square / Text("h^3", 3)
    yield identity("every h and both ends", formula.relation.rhs, true)
    for data in ((0, 0, 1, 0, 0, 1), (0, 1, 2, 3, -1, 0)):
        for m in (8, 12):
            found = energy.end_energy(CUBIC, m, data)
            where = (*_ends(data), ("h", f"1/{m - 2}"), *_lacks(data))
            label = f"{m + 1} rows, end data {data}"
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
            more = Text(f"{text(found)} - (e_H)", 1)
            never.append(positive(f"{label}: {m + 1} rows cost more than the cubic", more, where=where, affirmed=False))
        never.append(not_zero(f"{label}: the cubic has another second derivative", "delta_0", where=where, own=False))
    correction = layer(claim.corrected_formulas[0])
    return Draft([one_minimum(2), never], correction, (INDUCTION, NO_ENERGY, LEAST, CUBICS))


def facing_pairs(claim: Claim) -> Draft:
    """Return where the energy over alpha^2, beta^2 is least between straight plates, every gap and pair of angles."""
    relation = claim.formulas[0].relation
    total_, _, (a, b) = facing.strip_energy()
    exchanged = {facing.COS_THETA: facing.COS_PHI, facing.COS_PHI: facing.COS_THETA}
    where = (
        ("a_least", text(relation.rhs)),
        ("b_least", text(relation.rhs.subs(exchanged, simultaneous=True))),
    )
    least = [sp.Symbol("a_least"), sp.Symbol("b_least")]
    moved = total_.subs({a: least[0] + sp.Symbol("x"), b: least[1] + sp.Symbol("y")}, simultaneous=True)
    there = total_.subs({a: least[0], b: least[1]}, simultaneous=True)
    form = sp.hessian(total_, (a, b)) / 2
    around = Text(f"({text(form[0, 0])})*x^2 + 2*({text(form[0, 1])})*x*y + ({text(form[1, 1])})*y^2", 1)
    determinant = Text(f"({text(form[0, 0])})*({text(form[1, 1])}) - ({text(form[0, 1])})^2", 1)
    angle = (("c_between", "(1 - t^2)/(1 + t^2)"),)
    cases: list[Statement] = [
        identity("the energy around its least point", as_text(moved) - as_text(there), around, where=where, own=False),
        positive(
            "which is one, at every angle between the two ways", determinant, where=angle, nonnegative=("t",), own=False
        ),
        positive("along alpha^2 too", form[0, 0], own=False),
    ]
    for label, angles in facing.PLATES.items():
        cases += _plates(label, where, angles)
    return Draft([cases], believed=(LEAST,))


def _plates(label: str, least: Any, angles: Any) -> Iterator[Statement]:
    """Yield the signs of alpha^2 and beta^2 at one pair of angles, given by cosines and sines, over a gap of 1."""
    (c, s), (c_2, s_2) = angles
    names = (facing.COS_THETA, facing.COS_PHI, facing.COS_BETWEEN, facing.GAP)
    cosines = tuple((text(n), text(x)) for n, x in zip(names, (c, c_2, c * c_2 + s * s_2, 1), strict=True))
    meets = all(39 * one > 25 * other * (c * c_2 + s * s_2) for one, other in ((c, c_2), (c_2, c)))
    flags: dict[str, Any] = {"own": meets, "meets": meets}
    for number in (c, c_2):
        yield positive(f"{label}: an acute angle", number, own=False)
    for name, letter in (("a_least", "alpha^2"), ("b_least", "beta^2")):
        where = (*cosines, *least)
        if meets:
            yield positive(f"{label}: {letter} is positive", name, where=where)
        elif name == "a_least":
            yield positive(f"{label}: {letter} is negative", Text(f"-{name}", 1), where=where, affirmed=False, **flags)


DRAFTS = {
    "sec-3.fewer-better": fewer_better,
    "sec-3.minimum-over-rows": over_rows,
    "sec-4.facing": facing_pairs,
}
