"""Least energies without the derivations: functions by the recursion, rows by contact, and the slope of the energy.

Where the derivations have solved for free control points, what they found is put in: the energy does not change to
first order there, the form of the free ones is positive definite, and its value is the one that was claimed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

import sympy as sp

from semispline.derivations.energy import ExactSurface
from semispline.papers.checks import clamped
from semispline.papers.ledger import as_expression, as_fraction
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Lets,
    Statement,
    Text,
    as_text,
    curve_jet,
    derivative,
    end_jets,
    identity,
    integral,
    integral_text,
    minimum,
    text,
    total,
)

QUADRATIC = "where the slope of a positive definite form vanishes, it is least"


def least_strip(label: str, m: int, data: Sequence[Any], claimed: Any) -> Iterator[Statement]:
    """Yield that a cubic strip of m + 1 rows, uniform u_i, has the claimed least energy.

    `data` are its value, first and second derivative at u = 0, then at u = 1: numbers or letters.
    """
    spans = Fraction(1, m - 2), Fraction(2, m - 2)
    knots = clamped(CUBIC, *(Fraction(i, m - 2) for i in range(1, m - 2)))
    near = [(i, j) for i in range(m + 1) for j in range(i, min(i + CUBIC, m + 1))]
    entries = [(f"G_{i}_{j}", str(integral_text(CUBIC, (knots, i, 2), (knots, j, 2)))) for i, j in near]
    numbers = {(i, j): integral(CUBIC, (knots, i, 2), (knots, j, 2)) for i, j in near}

    def entry(i: int, j: int) -> Fraction:
        return numbers.get((min(i, j), max(i, j)), Fraction(0))

    set_rows = [0, 1, 2, m - 2, m - 1, m]
    free = range(3, m - 2)
    rows = _rows("P_0", "P_1", "P_2", data[:3], spans, 1)
    rows += _rows(f"P_{m}", f"P_{m - 1}", f"P_{m - 2}", data[3:], spans, -1)
    block = sp.Matrix(len(free), len(free), lambda r, c: as_expression(entry(free[r], free[c])))
    right = sp.Matrix(len(free), len(set_rows), lambda r, c: as_expression(-entry(free[r], set_rows[c])))
    factors = block.LUsolve(right) if free else right
    for r, i in enumerate(free):
        rows.append((f"P_{i}", str(total(as_text(factors[r, c]) * Text(f"P_{j}") for c, j in enumerate(set_rows)))))
    where = [*rows, *entries]
    yield from _contact(label, m, data, spans, rows)

    def slope(i: int) -> Text:
        return total(Text(f"G_{min(i, j)}_{max(i, j)}") * Text(f"P_{j}") for j in range(m + 1) if entry(i, j))

    for i in free:
        yield identity(f"{label}: the energy is stationary in row {i}", slope(i), 0, where=where, own=False)
    if free:
        yield minimum(f"{label}: and has one minimum", block, own=False)
    parts = [(f"E_{i}", str(Text(f"P_{i}") * slope(i))) for i in range(m + 1)]
    yield identity(
        f"{label}: its value", total(Text(name) for name, _ in parts), claimed, where=[*where, *parts], own=False
    )


def _rows(
    end: str, first: str, second: str, data: Sequence[Any], spans: tuple[Fraction, Fraction], sign: int
) -> list[tuple[str, str]]:
    """Return the three rows next to an end of a cubic strip, by its value and derivatives there."""
    h, h_2 = spans
    value, slope, bend = (as_text(x) for x in data)
    along = slope if sign > 0 else -slope
    return [
        (end, str(value)),
        (first, str(Text(end) + along * h / 3)),
        (second, str(Text(first) + (bend * h / 6 + (Text(first) - Text(end)) / h) * h_2)),
    ]


def _contact(
    label: str, m: int, data: Sequence[Any], spans: tuple[Fraction, Fraction], rows: Sequence[tuple[str, str]]
) -> Iterator[Statement]:
    """Yield that the rows have the data for value and derivatives, by the recursion."""
    for end, places, wanted in (("start", (0, 1, 2), data[:3]), ("end", (m, m - 1, m - 2), data[3:])):
        unrolled = Lets("c")
        jet = curve_jet(end_jets(unrolled, CUBIC - 1, spans, 2, end), [Text(f"P_{i}") for i in places])
        for d, value in enumerate(wanted):
            yield identity(
                f"{label}: derivative {d} at the {end}, by the recursion",
                derivative(jet, d),
                value,
                where=[*rows, *unrolled.pairs],
                own=False,
            )


Place = tuple[int, int]


def entries(blend: ExactSurface) -> tuple[dict[tuple[Place, Place], tuple[Text, Fraction]], list[tuple[str, str]]]:
    """Return the energy's matrix, A_2 G_0 + 2 A_1 G_1 + A_0 G_2 where it is not zero, and what its letters stand for.

    A_d and G_d are integrals of products of two functions by the recursion, in u and in v.
    """
    u = [as_fraction(x) for x in blend.u.knots]
    vectors = [tuple(as_fraction(x) for x in curve.knots) for curve in blend.curves]
    k, order = blend.u.degree + 1, blend.curves[0].degree + 1
    rows = range(len(vectors))
    letters: dict[str, Fraction] = {}
    for d, i, other in product(range(3), rows, rows):
        letters[f"A_{d}_{i}_{other}"] = integral(k, (u, i, d), (u, other, d))
    # Rows over one vector share their integrals: a vector is named by the first row that has it.
    kinds = sorted({vectors.index(vector) for vector in vectors})
    for d, one, other in product(range(3), kinds, kinds):
        for j, at in product(range(blend.curves[one].size), range(blend.curves[other].size)):
            letters[f"G_{d}_{one}_{j}_{other}_{at}"] = integral(order, (vectors[one], j, d), (vectors[other], at, d))
    found = {}
    for (i, j), (other, at) in product(blend.index, blend.index):
        along = f"{vectors.index(vectors[i])}_{j}_{vectors.index(vectors[other])}_{at}"
        names = [(factor, f"A_{d}_{i}_{other}", f"G_{2 - d}_{along}") for factor, d in ((1, 2), (2, 1), (1, 0))]
        terms = [(factor, a, g) for factor, a, g in names if letters[a] and letters[g]]
        if terms:
            number = sum((factor * letters[a] * letters[g] for factor, a, g in terms), Fraction(0))
            found[(i, j), (other, at)] = total(factor * Text(a) * Text(g) for factor, a, g in terms), number
    return found, [(name, text(number)) for name, number in letters.items() if number]


def least_blend(
    label: str, blend: ExactSurface, points: Sequence[Sequence[Any]], free: Sequence[int], claimed: Any = None
) -> Iterator[Statement]:
    """Yield that the free control points of a blend have least energy, the others given, and its value if claimed.

    Parameters
    ----------
    points : sequence, shape (N, up to 3)
        Coordinates of all control points, in the order of the surface's index.
    free : sequence of int
        Places of the free ones in it.
    """
    matrix, letters = entries(blend)
    coordinates = "xyz"[: len(points[0])]
    known = [
        (f"P_{i}_{j}_{axis}", text(number))
        for (i, j), point in zip(blend.index, points, strict=True)
        for axis, number in zip(coordinates, point, strict=True)
    ]

    def slope(place: Place, axis: str) -> Text:
        pairs = ((matrix.get((place, other)), other) for other in blend.index)
        return total(entry[0] * Text(f"P_{i}_{j}_{axis}") for entry, (i, j) in pairs if entry is not None)

    for n, axis in product(free, coordinates):
        place = blend.index[n]
        name = f"{label}: the energy is stationary in control point {place[1]} of row {place[0]}, {axis}"
        yield identity(name, slope(place, axis), 0, where=[*letters, *known], own=False)
    zero = Text("0"), Fraction(0)
    block = [[as_expression(matrix.get((blend.index[r], blend.index[c]), zero)[1]) for c in free] for r in free]
    yield minimum(f"{label}: and has one minimum", block, own=False)
    if claimed is None:
        return
    parts = [
        (f"E_{i}_{j}_{axis}", str(Text(f"P_{i}_{j}_{axis}") * slope((i, j), axis)))
        for (i, j), axis in product(blend.index, coordinates)
    ]
    rows = [
        (f"E_{i}", str(total(Text(name) for name, _ in parts if name.startswith(f"E_{i}_"))))
        for i in range(len(blend.curves))
    ]
    where = [*letters, *known, *parts, *rows]
    yield identity(f"{label}: its value", total(Text(name) for name, _ in rows), claimed, where=where, own=False)
