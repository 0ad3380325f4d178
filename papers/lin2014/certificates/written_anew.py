"""One base written in other ways, surfaces evaluated in the other order, blends that close at their seam."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.derivations.contact import contact_rows
from semispline.derivations.energy import energy_matrix
from semispline.derivations.splines import span_symbols
from semispline.papers.checks import clamped, union
from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION, closed_derivative, induction, row_cases
from semispline.papers.lin2014.certificates.least_energies import QUADRATIC, entries, least_blend
from semispline.papers.lin2014.certificates.linear_system import FUBINI
from semispline.papers.lin2014.certificates.spline_steps import INDUCTION as RECURRENCE
from semispline.papers.lin2014.certificates.spline_steps import sharp_continuity
from semispline.papers.lin2014.certificates.sums import UNROLLED, triangle_step
from semispline.papers.lin2014.checks import closed_seam as seam
from semispline.papers.lin2014.checks.contact_rows import w_kr1
from semispline.papers.lin2014.checks.samples import Sample
from semispline.papers.recheck import (
    Draft,
    Lets,
    Statement,
    Text,
    as_text,
    different,
    identity,
    span_of,
    text,
    total,
    triangle,
)

BOEHM = "a knot inserted by Boehm's rule leaves the surface as it is"

Lines = tuple[tuple[str, str], ...]
# w counted in other units, w' = d^2 w, alpha' = d alpha; a knot inserted at w_s + x in the first span, by Boehm's rule;
# one inserted at w_s + y in the second.
# The names on the left are those of the base as it is written then.
_UNITS: Lines = (("alpha_n", "d*alpha"), ("H1_n", "d^2*H1"), ("H2_n", "d^2*H2"), ("R_1n", "R_1j"), ("R_2n", "R_2j"))
_INSERTED: Lines = (
    ("alpha_n", "alpha"),
    ("H1_n", "x"),
    ("H2_n", "H1"),
    ("R_1n", "R_0j + x/H1*(R_1j - R_0j)"),
    ("R_2n", "R_1j + x/H2*(R_2j - R_1j)"),
)
_INSERTED_2: Lines = (
    *(("alpha_n", "alpha"), ("H1_n", "H1"), ("H2_n", "y"), ("R_1n", "R_1j")),
    ("R_2n", "R_1j + y/H2*(R_2j - R_1j)"),
)
_BEYOND = "a knot inserted into the second span"
_CHANGES = {"w in other units": _UNITS, "a knot inserted": _INSERTED, _BEYOND: _INSERTED_2}


def _written(expression: Any, *, anew: bool) -> Any:
    """Return an expression with distances for knots, in the letters of the base as it is, or as it is written anew."""
    new = "_n" if anew else ""
    start, *h = sp.symbols(f"w_s H1{new} H2{new}")
    values = {pr.w_s: start, pr.w_kr: start + h[0], w_kr1: start + h[1]}
    if anew:
        values |= dict(zip((pr.R_1, pr.R_2, pr.alpha), sp.symbols("R_1n R_2n alpha_n"), strict=True))
    return sp.sympify(expression).subs(values, simultaneous=True)


def same_base() -> Iterator[Statement]:
    """Yield that alpha^2 R_w, alpha^4 R_ww and row 1 by (2.1) stay as they are."""
    yield from induction()
    for label, change in _CHANGES.items():
        for d in (1, 2):
            value = str(closed_derivative("start", "base", d))
            before = as_text(value)
            after = value
            for name, new in (("H1", "H1_n"), ("H2", "H2_n"), ("R_1j", "R_1n"), ("R_2j", "R_2n")):
                after = after.replace(name, new)
            yield identity(
                f"{label}: alpha^{2 * d} times derivative {d} of the base stays",
                Text(f"alpha_n^{2 * d}*({after})", 2),
                Text(f"alpha^{2 * d}*({before})", 2),
                where=change,
                own=False,
            )
        row = pr.COND_2_1.relation.rhs
        where = change
        yield identity(
            f"{label}: row 1 stays", _written(row, anew=True), _written(row, anew=False), where=where, own=False
        )


def one_row(formula: Formula | None, stays: dict[str, bool], *, flat: bool) -> Iterator[Statement]:
    """Yield row 2 before and after changes; along the normal R_0 and R_1 agree, and so do P_0 and P_1."""
    row = given(formula).relation.rhs
    along: Lines = ((text(pr.R_1), text(pr.R_0)), (text(pr.P_0), text(pr.P_1))) if flat else ()
    for label, same in stays.items():
        change = _CHANGES[label]
        yield identity(
            f"{label}: row 2",
            _written(row, anew=True),
            _written(row, anew=False),
            equal=same,
            where=(*along, *change),
        )
    point = tuple((text(letter), "q") for letter in (pr.R_0, pr.R_1, pr.R_2, pr.P_0, pr.P_1))
    yield identity("all rows one point: row 2 is that point", row, "q", where=point)


def one_surface(claim: Claim) -> Draft:
    """Return row 2 by (3.1), as printed, with squares and with any powers, for one base in four ways of writing it."""
    printed, squared, powers = (given(reading.parts[0].formula) for reading in claim.readings)
    neither = dict.fromkeys(_CHANGES, False)
    readings = [
        [*same_base(), *one_row(printed, neither, flat=True)],
        [*same_base(), *one_row(squared, neither | {"w in other units": True}, flat=True)],
        [*same_base(), *one_row(powers, {_BEYOND: False}, flat=True)],
    ]
    (true,) = claim.corrected_formulas
    correction = [*same_base(), *one_row(true, dict.fromkeys(_CHANGES, True), flat=False), *row_cases(true, "start", 2)]
    return Draft(readings, correction, (INDUCTION, BOEHM))


U, V = Text("u"), Text("v")
_AT = (Fraction(2, 7), Fraction(3, 7))


def _sample(order: int, *, one_vector: bool) -> Sample:
    vectors = tuple(clamped(order, Fraction(i, 7)) for i in range(1, 6))
    return Sample(4, order, clamped(4, Fraction(1, 2)), vectors[:1] * 5 if one_vector else vectors)


def _points(sample: Sample) -> list[list[Text]]:
    return [[Text(f"P_{i}_{j}") for j in range(size)] for i, size in enumerate(sample.sizes)]


def _along_first(lets: Lets, sample: Sample) -> Text:
    rows = [
        triangle(lets, sample.l, vector, row, V, span_of(vector, _AT[1]))
        for vector, row in zip(sample.V, _points(sample), strict=True)
    ]
    return triangle(lets, sample.k, sample.U, rows, U, span_of(sample.U, _AT[0]))


def _across_first(lets: Lets, sample: Sample, vector: Sequence[Fraction], rows: Sequence[Sequence[Any]]) -> Text:
    columns = [
        triangle(lets, sample.k, sample.U, list(column), U, span_of(sample.U, _AT[0]))
        for column in zip(*rows, strict=True)
    ]
    return triangle(lets, sample.l, vector, columns, V, span_of(vector, _AT[1]))


def _with_knot(lets: Lets, order: int, vector: list[Fraction], points: list[Text], x: Fraction) -> list[Text]:
    """Return control points with one knot more; `vector` gets it too."""
    span = span_of(vector, x)
    new = []
    for i in range(len(points) + 1):
        if i <= span - order + 1:
            new.append(points[i])
        elif i > span:
            new.append(points[i - 1])
        else:
            share = as_text((x - vector[i]) / (vector[i + order - 1] - vector[i]))
            new.append(lets.named((1 - share) * points[i - 1] + share * points[i]))
    vector.insert(span + 1, x)
    return new


def order_of_evaluation(_: Claim) -> Draft:
    """Return triangles first along u: on the columns as they stand, and after all rows have been given all knots."""
    as_they_are: list[Statement] = [*triangle_step(), *sharp_continuity(own=False)]
    merged_first: list[Statement] = [*triangle_step()]
    for order in (2, 3, 4):
        for one_vector in (False, True):
            sample = _sample(order, one_vector=one_vector)
            one, other = Lets("c"), Lets("d")
            sides = _along_first(one, sample), _across_first(other, sample, sample.V[0], _points(sample))
            label = f"order {order}, {'one knot vector' if one_vector else 'different knot vectors'}"
            where = [*one.pairs, *other.pairs]
            if one_vector:
                case = identity(label, *sides, where=where, wanted=False, own=False, meets=False)
            else:
                case = different(label, *sides, where=where, wanted=False)
            as_they_are.append(case)
        sample = _sample(order, one_vector=False)
        merged = union(order, *sample.V)
        one, other = Lets("c"), Lets("d")
        rows = []
        for vector, row in zip(sample.V, _points(sample), strict=True):
            knots = list(vector)
            for x in sorted(set(merged) - set(vector)):
                row = _with_knot(other, order, knots, row, x)  # noqa: PLW2901
            rows.append(row)
        sides = _along_first(one, sample), _across_first(other, sample, merged, rows)
        label = f"order {order}, over the merged knots"
        merged_first.append(identity(label, *sides, where=[*one.pairs, *other.pairs], wanted=False))
    return Draft([as_they_are, merged_first], believed=(UNROLLED, RECURRENCE))


def closing(formula: Formula) -> Iterator[Statement]:
    """Yield what jumps at the seam in row 1, and that rows 0 to 2 jump only where R_0 to R_2 do."""
    jumps = (("J_0", "E_0 - S_0"), ("J_1", "E_1 - S_1"))
    row = pr.COND_2_1.relation.rhs
    ends = {letter: row.subs({pr.P_0: sp.Symbol(f"{letter}_0"), pr.R_0: sp.Symbol(f"{letter}_0"),
                              pr.R_1: sp.Symbol(f"{letter}_1")}, simultaneous=True) for letter in "ES"}  # fmt: skip
    yield identity(
        "row 1 at v_e less row 1 at v_s", formula.relation.rhs, as_text(ends["E"]) - as_text(ends["S"]), where=jumps
    )
    matrix = contact_rows(2, pr.k - 1, span_symbols(2), pr.k_r - 1, span_symbols(2, "H"))
    spans = (("h1", text(pr.u_1)), ("H1", text(pr.w_kr - pr.w_s)), ("a", "alpha^2"))
    derived = total(as_text(matrix[1, j]) * Text(f"(E_{j} - S_{j})") for j in range(2))
    yield identity("row 1, by the derived rows", formula.relation.rhs, derived, where=(*jumps, *spans))
    closed = tuple((f"E_{j}", f"S_{j}") for j in range(3))
    for i in range(3):
        across = total(as_text(matrix[i, j]) * Text(f"(E_{j} - S_{j})") for j in range(i + 1))
        yield identity(f"row {i}, of bases that close", across, 0, where=closed)


def free_middle() -> Iterator[Statement]:
    """Yield the middle curve of least energy between two closed contacts: its equations, and its ends, which differ."""
    blend, points = seam.middle_curve()
    free = [n for n, (i, _) in enumerate(blend.index) if i == 3]
    yield from least_blend("a middle curve", blend, [(point,) for point in points], free)
    derived = energy_matrix(blend)
    matrix, letters = entries(blend)
    for n in free:
        place = blend.index[n]
        yield identity(
            f"the derived entry of control point {place[1]} with itself",
            derived[n, n],
            matrix[place, place][0],
            where=letters,
            own=False,
        )
    ends = [points[n] for n in (free[0], free[-1])]
    yield different("ends of the middle curve", *ends)


def closed_blend(claim: Claim) -> Draft:
    """Return the seam without a middle curve, and with one that (11) alone has found."""
    formula = given(claim.readings[0].parts[0].formula)
    return Draft([closing(formula), free_middle()], believed=(FUBINI, QUADRATIC))


DRAFTS = {
    "sec-3.one-surface": one_surface,
    "sec-2.evaluation-order": order_of_evaluation,
    "fig-10.seam": closed_blend,
}
