"""Deciding whether a semi-structured surface has to be evaluated first along v: what the other way gives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

from semispline.papers.checks import clamped, de_boor, net_ring, sharp_continuity_cases, union
from semispline.papers.ledger import Case, premises
from semispline.papers.lin2014.checks.samples import Sample

_AT = (Fraction(2, 7), Fraction(3, 7))


def _surfaces(order: int) -> Iterator[tuple[str, Sample]]:
    """Yield surfaces with as many control points in each row: over different knots, and over one vector."""
    U = clamped(4, Fraction(1, 2))
    different = tuple(clamped(order, Fraction(i, 7)) for i in range(1, 6))
    yield "different knot vectors", Sample(4, order, U, different)
    yield "one knot vector", Sample(4, order, U, different[:1] * 5)


def columns_first_cases() -> Iterator[Case]:
    """Yield surfaces, true where de Boor's triangle first along u, on columns as they stand, gives another point.

    First along u, any one vector V serves for the last step. Clamped vectors of one length that differ have each some
    knot more often than the other one has; so where some V_i is not V some spline over it is rougher at such a knot
    than all splines over V, for every order. With it for P_i, the other rows zero, the surface is N_i times that
    spline, and what was found is N_i times one over V.
    """
    yield from premises(sharp_continuity_cases())
    for order in (2, 3, 4):
        for label, sample in _surfaces(order):
            net = net_ring(*sample.sizes)
            u, v = _AT
            columns = [
                de_boor(sample.k, sample.U, [net[i, j] for i in range(sample.m + 1)], u) for j in range(sample.sizes[0])
            ]
            # Any one of the vectors along v: the first.
            found = de_boor(sample.l, sample.V[0], columns, v)
            differs = bool(found != sample.value(net, u, v))
            meets = len(set(sample.V)) > 1
            yield Case(f"order {order}, {label}", differs, own=meets, meets=meets)


def inserted(order: int, knots: Sequence[Fraction], points: Sequence[Any], x: Fraction) -> tuple[list[Any], list[Any]]:
    """Return knots and control points with one knot more, by Boehm's rule."""
    span = max(i for i, knot in enumerate(knots) if knot <= x < max(knots))
    new = []
    for i in range(len(points) + 1):
        if i <= span - order + 1:
            new.append(points[i])
        elif i > span:
            new.append(points[i - 1])
        else:
            t = (x - knots[i]) / (knots[i + order - 1] - knots[i])
            new.append((1 - t) * points[i - 1] + t * points[i])
    return [*knots[: span + 1], x, *knots[span + 1 :]], new


def merged_first_cases() -> Iterator[Case]:
    """Yield surfaces over different knots, true where starting along u is wrong even after the knots are merged."""
    for order in (2, 3, 4):
        _, sample = next(_surfaces(order))
        net = net_ring(*sample.sizes)
        merged = sample.V[0]
        for vector in sample.V[1:]:
            merged = union(order, merged, vector)
        rows = []
        for i, vector in enumerate(sample.V):
            knots, points = list(vector), [net[i, j] for j in range(sample.sizes[i])]
            for x in merged:
                if x not in knots:
                    knots, points = inserted(order, knots, points, x)
            rows.append(points)
        u, v = _AT
        columns = [de_boor(sample.k, sample.U, list(column), u) for column in zip(*rows, strict=True)]
        found = de_boor(order, merged, columns, v)
        yield Case(f"order {order}, first along u over the merged knots", bool(found != sample.value(net, u, v)))
