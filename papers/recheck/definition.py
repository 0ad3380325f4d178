"""B-splines by their definition, as text: the recursion of Cox and de Boor, unrolled, and nothing derived from it.

A polynomial next to a point is the list of its coefficients, up to an order, with the point as origin. No code is
shared with `derivations`: these are the witnesses for what is derived there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import factorial
from typing import Any

from semispline.papers.recheck.texts import Text, as_text, total


@dataclass
class Lets:
    """Names for intermediate results, so that texts stay short; `pairs` says what they stand for."""

    letter: str
    pairs: list[tuple[str, str]] = field(default_factory=list)

    def named(self, value: Any) -> Text:
        """Return a name for a value, or the value itself where it is a number or a name."""
        found = as_text(value)
        if found.binding == 4:
            return found
        name = f"{self.letter}{len(self.pairs) + 1}"
        self.pairs.append((name, str(found)))
        return Text(name)


Jet = list[Any]


def basis_jets(lets: Lets, degree: int, knots: Sequence[Any], span: int, order: int) -> list[Jet]:
    """Return coefficients 0 .. order of functions span - degree .. span on one span, the origin being x = 0.

    By N_i,p = (x - t_i)/(t_(i+p) - t_i) N_i,p-1 + (t_(i+p+1) - x)/(t_(i+p+1) - t_(i+1)) N_i+1,p-1. On its span one
    function of degree 0 is 1, the others are 0.
    """
    knots = [as_text(knot) for knot in knots]
    level: dict[int, Jet] = {span: [Text("1"), *[None] * order]}
    for p in range(1, degree + 1):
        above: dict[int, Jet] = {}
        for i in range(span - p, span + 1):
            parts: list[list[Any]] = [[] for _ in range(order + 1)]
            if i in level:
                _multiply(parts, level[i], -1, knots[i], 1, knots[i + p] - knots[i])
            if i + 1 in level:
                _multiply(parts, level[i + 1], 1, knots[i + p + 1], -1, knots[i + p + 1] - knots[i + 1])
            above[i] = [lets.named(total(terms)) if terms else None for terms in parts]
        level = above
    return [level[i] for i in range(span - degree, span + 1)]


def _multiply(parts: list[list[Any]], jet: Jet, sign: int, knot: Text, slope: int, width: Text) -> None:
    """Add (sign * knot + slope * x) / width times a polynomial."""
    for d, coefficient in enumerate(jet):
        if coefficient is None:
            continue
        if knot.text != "0":
            parts[d].append((knot if sign > 0 else -knot) * coefficient / width)
        if d + 1 < len(parts):
            parts[d + 1].append((coefficient if slope > 0 else -coefficient) / width)


def end_jets(lets: Lets, degree: int, spans: Sequence[Any], order: int, end: str = "start") -> list[Jet]:
    """Return coefficients at a clamped end of the functions next to it, the one of the end first.

    `spans` are the distances of the first inner knots from the end; where there are fewer than the degree, letters
    stand for the others. At "end" x runs towards the end, so that it is negative inside.
    """
    distances = [as_text(x) for x in spans[:degree]]
    distances += [Text(f"{lets.letter}_far{r}") for r in range(len(distances) + 1, degree + 1)]
    clamped = [Text("0")] * (degree + 1)
    if end == "start":
        return basis_jets(lets, degree, [*clamped, *distances], degree, order)
    return basis_jets(lets, degree, [*(-x for x in reversed(distances)), *clamped], degree - 1, order)[::-1]


def curve_jet(jets: Sequence[Jet], points: Sequence[Any]) -> Jet:
    """Return the coefficients of a spline whose first control points are given, the others zero."""
    order = len(jets[0]) - 1
    return [
        total(jet[d] * point for jet, point in zip(jets, points, strict=False) if jet[d] is not None)
        for d in range(order + 1)
    ]


def derivative(jet: Jet, d: int) -> Text:
    """Return a derivative at the origin."""
    return as_text(jet[d]) * factorial(d) if d > 1 else as_text(jet[d])


def span_value(lets: Lets, order: int, knots: Sequence[Any], i: int, x: Any, span: int) -> Text:
    """Return B_i of an order at a letter x on one span of numbers or letters, all of them different knots there."""
    if not i <= span < i + order:
        return Text("0")
    x = as_text(x)
    values: dict[int, Text] = {span: Text("1")}
    for p in range(1, order):
        above = {}
        for j in range(span - p, span + 1):
            terms = []
            if j in values:
                terms.append((x - knots[j]) / (as_text(knots[j + p]) - knots[j]) * values[j])
            if j + 1 in values:
                terms.append(
                    (as_text(knots[j + p + 1]) - x) / (as_text(knots[j + p + 1]) - knots[j + 1]) * values[j + 1]
                )
            above[j] = lets.named(total(terms))
        values = above
    return values[i]


def triangle(lets: Lets, order: int, knots: Sequence[Any], points: Sequence[Any], x: Any, span: int) -> Text:
    """Return a spline at a letter x on one span by de Boor's triangle, which knows no basis functions."""
    x = as_text(x)
    level = {j: as_text(points[j]) for j in range(span - order + 1, span + 1)}
    for step in range(1, order):
        for j in range(span, span - order + step, -1):
            width = as_text(knots[j + order - step]) - knots[j]
            weight = (x - knots[j]) / width
            level[j] = lets.named(level[j - 1] * (1 - weight) + level[j] * weight)
    return level[span]


def basis_number(order: int, knots: Sequence[Fraction], i: int, x: Fraction) -> Fraction:
    """Return B_i of an order at a number, by the recursion with its 0/0 = 0; the last span is closed.

    Examples
    --------
    >>> basis_number(2, [Fraction(t) for t in (0, 0, 1, 1)], 1, Fraction(1, 3))
    Fraction(1, 3)
    """
    return _number(order, tuple(knots), i, x)


@cache
def _number(order: int, knots: tuple[Fraction, ...], i: int, x: Fraction) -> Fraction:
    if order == 1:
        closed = x == knots[-1] == knots[i + 1] and knots[i] < x
        return Fraction(int(knots[i] <= x < knots[i + 1] or closed))

    def share(above: Fraction, width: Fraction, j: int) -> Fraction:
        return above / width * _number(order - 1, knots, j, x) if width else Fraction(0)

    rising = share(x - knots[i], knots[i + order - 1] - knots[i], i)
    return rising + share(knots[i + order] - x, knots[i + order] - knots[i + 1], i + 1)


def span_of(knots: Sequence[Fraction], x: Fraction) -> int:
    """Return the span that holds a number."""
    return max(j for j in range(len(knots) - 1) if knots[j] <= x and knots[j] < knots[j + 1])


def basis_polynomial(order: int, knots: Sequence[Fraction], i: int, span: int) -> list[Fraction]:
    """Return the coefficients of B_i of an order on one span, by the recursion; the lowest power first.

    Examples
    --------
    >>> [str(c) for c in basis_polynomial(2, [Fraction(t) for t in (0, 0, 2, 2)], 0, 1)]
    ['1', '-1/2']
    """
    if order == 1:
        return [Fraction(int(i == span))]
    found = [Fraction(0)] * order
    for j, knot, slope, width in (
        (i, knots[i], 1, knots[i + order - 1] - knots[i]),
        (i + 1, knots[i + order], -1, knots[i + order] - knots[i + 1]),
    ):
        if not width:
            continue
        for d, c in enumerate(basis_polynomial(order - 1, knots, j, span)):
            found[d] -= slope * knot * c / width
            found[d + 1] += slope * c / width
    return found


def integral(
    order: int, one: tuple[Sequence[Fraction], int, int], other: tuple[Sequence[Fraction], int, int] | None = None
) -> Fraction:
    """Return the integral of a derivative of a function, or of the product of two: knots, index, derivative of each.

    Examples
    --------
    >>> hat = [Fraction(t) for t in (0, 0, 1, 1)]
    >>> integral(2, (hat, 0, 0)), integral(2, (hat, 0, 1), (hat, 1, 1))
    (Fraction(1, 2), Fraction(-1, 1))
    """
    return sum(integrals(order, one, other), Fraction(0))


def integrals(
    order: int, one: tuple[Sequence[Fraction], int, int], other: tuple[Sequence[Fraction], int, int] | None = None
) -> list[Fraction]:
    """Return `integral` span by span."""
    return [
        sum((c * (end ** (n + 1) - start ** (n + 1)) / (n + 1) for n, c in enumerate(piece)), Fraction(0))
        for start, end, piece in _pieces(order, one, other)
    ]


def integral_text(
    order: int, one: tuple[Sequence[Fraction], int, int], other: tuple[Sequence[Fraction], int, int] | None = None
) -> Text:
    """Return `integral` as it stands: for each power of x in each span, what its primitive gains there.

    Examples
    --------
    >>> hat = [Fraction(t) for t in (0, 0, 2, 2)]
    >>> str(integral_text(2, (hat, 0, 0)))
    '1*2 + (-1/2)*2^2/2'
    """
    terms = []
    for start, end, piece in _pieces(order, one, other):
        for n, c in enumerate(piece, start=1):
            gain = as_text(end) ** n - as_text(start) ** n if start else as_text(end) ** n
            if c:
                terms.append(as_text(c) * gain / n if n > 1 else as_text(c) * gain)
    return total(terms)


def _pieces(
    order: int, one: tuple[Sequence[Fraction], int, int], other: tuple[Sequence[Fraction], int, int] | None
) -> Iterator[tuple[Fraction, Fraction, list[Fraction]]]:
    """Yield the spans, and the coefficients of what is integrated there."""
    factors = [one] if other is None else [one, other]
    points = sorted({knot for knots, _, _ in factors for knot in knots})
    for start, end in pairwise(points):
        product = [Fraction(1)]
        for knots, i, d in factors:
            piece = basis_polynomial(order, knots, i, span_of(knots, start))
            for _ in range(d):
                piece = [n * c for n, c in enumerate(piece)][1:]
            terms = [Fraction(0)] * (len(product) + len(piece))
            for m, a in enumerate(product):
                for n, b in enumerate(piece):
                    terms[m + n] += a * b
            product = terms
        yield start, end, product
