"""Counting knots, functions and inner knots of sections 2 and 3: for every order and number, and at instances."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

from semispline.derivations.counts import domain_ends, functions_on, last_knot
from semispline.papers.checks import Counting, clamped
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.printed import CUBIC


def knot_count_instances(count: Any, order: Any) -> Counting:
    """Count: how many knots carry `count` + 1 basis functions of an order; the last index is one less."""

    def instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
        for k in range(1, 7):
            for m in range(k - 1, k + 4):
                if m >= 1:
                    length = next(x for x in range(1, 40) if functions_on(x, k) == m + 1)
                    yield f"order {k}, {m + 1} functions", {pr.last: length - 1, count: m, order: k}, k == CUBIC

    return Counting({pr.last: last_knot(count, order)}, instances)


def _cox_de_boor(i: int, order: int, knots: Sequence[int], x: Fraction) -> Fraction:
    """Return B_i,order(x) by the recurrence alone, on distinct knots."""
    if order == 1:
        return Fraction(knots[i] <= x < knots[i + 1])
    rising = (x - knots[i]) / (knots[i + order - 1] - knots[i])
    falling = (knots[i + order] - x) / (knots[i + order] - knots[i + 1])
    return rising * _cox_de_boor(i, order - 1, knots, x) + falling * _cox_de_boor(i + 1, order - 1, knots, x)


@cache
def _full_spans(order: int, last: int) -> tuple[int, ...]:
    """Return the spans of distinct knots on which the functions 0 .. last sum to 1; once, for all that is counted."""
    knots = range(last + order + 1)
    # One point in each span: there all functions sum to 1, or to less.
    points = [Fraction(2 * c + 1, 2) for c in knots[:-1]]
    sums = [sum(_cox_de_boor(i, order, knots, x) for i in range(last + 1)) for x in points]
    return tuple(c for c, total in enumerate(sums) if total == 1)


def domain_instances(count: Any, order: Any) -> Counting:
    """Count: the indices of the first and the last knot of the domain, where the basis functions sum to 1."""

    def instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
        for k in range(2, 6):
            for m in range(k - 1, k + 3):
                spans = _full_spans(k, m)
                values = {pr.last: spans[0], pr.first: spans[-1] + 1, count: m, order: k}
                yield f"order {k}, {m + 1} functions", values, k == CUBIC

    return Counting(dict(zip((pr.last, pr.first), domain_ends(count, order), strict=True)), instances)


def inner_knots_count() -> Counting:
    """Count: the indices of the first and the last knot strictly inside the domain of a clamped vector."""

    def instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
        for order in range(2, 6):
            for n in range(order, order + 4):
                knots = clamped(order, *(Fraction(r, 10) for r in range(1, n - order + 2)))
                inside = [index for index, knot in enumerate(knots) if 0 < knot < 1]
                values = {pr.first: inside[0], pr.last: inside[-1], pr.ell: order, pr.n_r: n}
                yield f"order {order}, {n + 1} points", values, order == CUBIC

    # The runs of equal knots of a clamped vector reach up to the ends of its domain.
    start, end = domain_ends(pr.n_r, pr.ell)
    return Counting({pr.first: start + 1, pr.last: end - 1}, instances)
