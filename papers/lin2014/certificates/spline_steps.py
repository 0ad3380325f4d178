"""What holds of B-splines of every order: steps from one order to the next, and spaces over knot vectors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Lets,
    Statement,
    Text,
    basis_number,
    contained,
    identity,
    positive,
    span_value,
    total,
)

INDUCTION = (
    "the recurrence carries what is stated of one order to the next one, and functions of order 1 are 1 on one span"
)
SPACES = "splines that agree at more points of each span than a polynomial of their order has coefficients are the same"


def partition() -> Iterator[Statement]:
    """Yield that functions sum to 1: the step for every order, and orders 2 to 5 over a symbolic inner knot."""
    yield identity(
        "partition of unity: the step", Text("(x - t_i)/(t_ip - t_i) + (t_ip - x)/(t_ip - t_i)", 1), 1, own=False
    )
    n, inner = [Text(f"N_{i}") for i in range(4)], [Text(f"S_{i}") for i in range(4)]
    where = [*((str(s), "1") for s in inner), ("N_3", "1 - N_0 - N_1 - N_2")]
    yield identity(
        "partition of unity: the surface",
        total(a * s for a, s in zip(n, inner, strict=True)),
        1,
        where=where,
        own=False,
    )
    for order in range(2, 6):
        vector = [*["0"] * order, "h", *["1"] * order]
        for span in (order - 1, order):
            lets = Lets("c")
            values = [span_value(lets, order, [Text(t) for t in vector], i, "x", span) for i in range(order + 1)]
            yield identity(
                f"order {order}, any inner knot h, span {span - order + 2}: sum of all functions",
                total(values),
                1,
                where=lets.pairs,
                own=order == CUBIC,
            )


def signs() -> Iterator[Statement]:
    """Yield that both factors of the recurrence are not negative inside the support."""
    where = [("t_ip", "t_i + a + b"), ("x", "t_i + a")]
    for name, factor in (("rising", "(x - t_i)/(t_ip - t_i)"), ("falling", "(t_ip - x)/(t_ip - t_i)")):
        yield positive(f"non-negative: {name}", factor, where=where, positive=("a", "b"), own=False)


def insertion() -> Iterator[Statement]:
    """Yield the step of knot insertion, for every order, knots and place of the new knot z."""

    def rising(start: str, end: str) -> str:
        return f"(x - {start})/({end} - {start})"

    def falling(start: str, end: str) -> str:
        return f"({end} - x)/({end} - {start})"

    first = f"({rising('s0', 'before')}*A + {falling('s1', 'sk')}*B)"
    second = f"({rising('s1', 'sk')}*B + {falling('s2', 'after')}*C)"
    claimed = f"(z - s0)/(sk - s0)*{first} + (after - z)/(after - s1)*{second}"
    left = "((z - s0)/(before - s0)*A + (sk - z)/(sk - s1)*B)"
    right = "((z - s1)/(sk - s1)*B + (after - z)/(after - s2)*C)"
    for label, place, lower, start, end in (
        ("z inside", (), (left, right), "s1", "sk"),
        ("z right after the start", (("s1", "z"),), (left, "C"), "s2", "sk"),
        ("z right before the end", (("sk", "z"),), ("A", right), "s1", "before"),
    ):
        old = Text(f"{rising('s0', end)}*{lower[0]} + {falling(start, 'after')}*{lower[1]}", 1)
        yield identity(f"knot insertion, every order and knots, {label}", old, Text(claimed, 1), where=place, own=False)


def spaces(label: str, order: int, inner: Sequence[Fraction], outer: Sequence[Fraction], **flags: Any) -> Statement:
    """Return whether splines over one knot vector are splines over another, by values at points of each span."""
    knots = sorted({*inner, *outer})
    points = [a + (b - a) * Fraction(r, order + 1) for a, b in pairwise(knots) for r in range(order + 1)]
    values = [
        [[basis_number(order, vector, i, x) for i in range(len(vector) - order)] for x in points]
        for vector in (outer, inner)
    ]
    return contained(label, *values, **flags)


def derivative_steps() -> Iterator[Statement]:
    """Yield base and step of the derivative formula, and its sum over a curve's control points."""
    hat = "(x - t0)/(t1 - t0)", "(t2 - x)/(t2 - t1)"
    moved = "(x + e - t0)/(t1 - t0)", "(t2 - (x + e))/(t2 - t1)"
    for name, now, then, slope in zip(("rising", "falling"), hat, moved, ("1/(t1 - t0)", "-1/(t2 - t1)"), strict=True):
        yield identity(f"derivative, base, {name}: over e", Text(f"({then} - ({now}))/e", 2), Text(slope, 1), own=False)
    low, high = (
        "((x - t0)/(t_pm - t0)*A + (t_p - x)/(t_p - t1)*B)",
        "((x - t1)/(t_p - t1)*B + (t_pp - x)/(t_pp - t2)*C)",
    )
    low_slope = "((p - 1)*(A/(t_pm - t0) - B/(t_p - t1)))"
    high_slope = "((p - 1)*(B/(t_p - t1) - C/(t_pp - t2)))"
    left = (
        f"{low}/(t_p - t0) + (x - t0)/(t_p - t0)*{low_slope} - {high}/(t_pp - t1) + (t_pp - x)/(t_pp - t1)*{high_slope}"
    )
    yield identity(
        "derivative, step, every degree and knots",
        Text(left, 1),
        Text(f"p*({low}/(t_p - t0) - {high}/(t_pp - t1))", 2),
        own=False,
    )
    terms = [f"P_{i}*p*(N_{i}/d_{i} - N_{i + 1}/d_{i + 1})" for i in range(3)]
    claimed = [f"p*(P_{i} - P_{i - 1})/d_{i}*N_{i}" for i in (1, 2)]
    ends = "p*(P_0/d_0*N_0 - P_2/d_3*N_3)"
    yield identity(
        "derivative of a curve: summation by parts",
        Text(" + ".join(terms), 1),
        Text(" + ".join([*claimed, ends]), 1),
        own=False,
    )


def sharp_continuity(**flags: Any) -> Iterator[Statement]:
    """Yield that across an r-fold knot splines of degree p are C^(p-r), some no smoother."""
    for label, left, right, where in (
        ("kept from the right", "(near - x)/(near - t_i)", 1, (("t_i", "x"),)),
        ("lost from the right", "(x - t_i)/(near - t_i)", 0, (("t_i", "x"),)),
        ("kept from the left", "(x - near)/(t_i - near)", 1, (("t_i", "x"),)),
        ("lost from the left", "(t_i - x)/(t_i - near)", 0, (("t_i", "x"),)),
    ):
        yield identity(f"continuity, base, {label}", Text(left, 2), right, where=where, **flags)
    yield from derivative_steps()
    yield positive(
        "full multiplicity: the slope jumps by minus this", Text("p/g + p/h", 1), positive=("p", "g", "h"), **flags
    )
    yield identity(
        "a spline of one degree more has it as derivative", Text("p*((P_i + d*Q_i/p) - P_i)/d", 2), Text("Q_i"), **flags
    )
