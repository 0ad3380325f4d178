"""Deciding Fig. 3: four printed curves around a region, their parameters, and the eight pieces.

Judge: exact root isolation and winding in `derivations.trimming`. A check of one printed curve takes the other three
as they are printed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.trimming import (
    Hole,
    Side,
    areas,
    boundary_residual,
    corners,
    crossings,
    inside_square,
    trimmed_rows,
)
from semispline.papers.ledger import Case, Formula, as_fraction, given
from semispline.papers.lin2014 import printed_figures as printed


def _interval(name: str) -> tuple[Any, Any]:
    start, end = printed.SIDE_INTERVALS[name].relation.rhs
    return start, end


def bezier_terms(formula: Formula) -> dict[int, Any] | None:
    """Return index -> control value of a printed Bezier function; None where it is none.

    It is one if its Bernstein polynomials all have one degree n and one argument, and each index 0 .. n occurs once.
    """
    found: dict[int, Any] = {}
    shapes = set()
    for term in sp.Add.make_args(formula.relation.rhs):
        value, function = term.as_coeff_Mul()
        if function.func.__name__ != "B":
            return None
        index, degree, argument = function.args
        if index in found:
            return None
        found[int(index)] = value
        shapes.add((degree, sp.expand(argument)))
    if len(shapes) != 1 or set(found) != set(range(int(shapes.pop()[0]) + 1)):
        return None
    return found


def _local_ends(argument: Any, interval: tuple[Any, Any]) -> list[Any]:
    (parameter,) = argument.free_symbols
    return [argument.subs(parameter, end) for end in interval]


def side_of(name: str, formula: Formula) -> Side | None:
    """Return a side of the hole by its printed function; None where the function is none over its interval."""
    terms = bezier_terms(formula)
    interval = _interval(name)
    if terms is None:
        return None
    arguments = {f.args[2] for f in formula.relation.rhs.atoms(sp.core.function.AppliedUndef)}
    if any(_local_ends(argument, interval) != [0, 1] for argument in arguments):
        return None
    start, end = map(as_fraction, interval)
    return Side(start, end, tuple(as_fraction(sp.Rational(terms[r])) for r in range(len(terms))))


@cache
def hole() -> Hole:
    """Return the region of Fig. 3 by the four printed functions.

    Raises
    ------
    ValueError
        A printed function is no Bezier function over its interval.
    """
    sides = {}
    for name, formula in printed.SIDE_CURVES.items():
        side = side_of(name, formula)
        if side is None:
            raise ValueError(f"sides: found no Bezier function for {name}, expected four")
        sides[name] = side
    return Hole(**sides)


def curve_cases(name: str) -> Any:
    """Return the check of one curve: a Bezier function that encloses a region with the other three.

    They meet in four corners, nowhere else, inside the square.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        side = None if formula is None else side_of(name, formula)
        yield Case("a Bezier function over its interval", side is not None)
        if side is None:
            return
        region = replace(hole(), **{name: side})
        met = [one == other for one, other in corners(region).values()]
        yield Case("it ends where its neighbours do", all(met))
        inside = inside_square(region)
        yield Case("strictly inside the unit square", inside)
        if not (all(met) and inside):
            return
        points = {point for found in crossings(region).values() for point in found}
        wanted = {tuple(map(sp.Rational, map(str, pair[0]))) for pair in corners(region).values()}
        yield Case("no other crossing", {tuple(map(sp.Rational, map(str, point))) for point in points} == wanted)

    return cases


def parameter_cases(name: str) -> Any:
    """Return the check that a local parameter, such as (v - 0.4)/0.2, runs over [0, 1] on the printed interval."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        ends = _local_ends(given(formula).relation.rhs, _interval(name))
        yield Case(f"{name}: from {ends[0]} to {ends[1]}", ends == [0, 1])

    return cases


def interval_cases(name: str) -> Any:
    """Return the check that a printed interval is the one on which the printed local parameter runs over [0, 1]."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        interval = given(formula).relation.rhs
        whole = len(interval) == 2 and _local_ends(printed.SIDE_PARAMETERS[name].relation.rhs, interval) == [0, 1]
        yield Case(f"{name}: {interval}", whole)

    return cases


def tiling_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide how many pieces are semi-structured and how many ordinary, and that they cover the trimmed square.

    The rows of an ordinary Bezier patch have equally many control points.
    """
    region = hole()
    bicubic = [[Fraction(i * j) for j in range(4)] for i in range(4)]
    lengths = [{len(row) for row in piece} for piece in trimmed_rows(bicubic, region).values()]
    counts = [sum(len(found) > 1 for found in lengths), sum(len(found) == 1 for found in lengths)]
    yield Case(f"{counts[0]} semi-structured, {counts[1]} ordinary", list(given(formula).relation.rhs) == counts)
    yield Case(
        "boundaries of the eight pieces add up to those of the square and the hole", not boundary_residual(region)
    )
    found = areas(region)
    yield Case("areas of the pieces and the hole sum to 1", sum(found.values()) == 1)
    yield Case("every area is positive", all(area > 0 for area in found.values()))


def first_split_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the construction of Q_1: the strip holds all of c1 and no more, and c1 divides it across u."""
    strip = tuple(given(formula).relation.rhs)
    yield Case("c1 is defined over the whole strip", strip == _interval("left"))
    yield Case("c1 stays inside the strip's range of u", all(0 < c < 1 for c in hole().left.coefficients))
