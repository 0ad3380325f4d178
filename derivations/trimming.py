"""A square with a hole bounded by four Bezier functions: the eight pieces around the hole tile the rest exactly.

    u = left(v), u = right(v), v = bottom(u), v = top(u)

each over its own interval, meet in four corners. Left of `left`, right of `right`, below `bottom` and above `top` lies
one piece each, a Bezier patch divided by a Bezier function; four rectangles fill the corners of the square.

Why this is a tiling: no side touches the edge of the square (`inside_square`), so the boundary of each piece is a
simple closed curve, and the piece is where its winding number is 1. `boundary_residual` adds the eight boundaries;
where the sum is the boundary of the square minus that of the hole, the pieces cover every point as often as (1 -
winding number of the hole's boundary), almost everywhere. `crossings` finds every common point of two sides of the
hole; where these are the four corners alone, the boundary of the hole is simple and that number is 1 outside the hole
and 0 inside. All of it is exact.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any

import sympy as sp

from semispline.derivations.bezier import blossom, division_rows

Point = tuple[Any, Any]
Net = tuple[tuple[Any, ...], ...]
_T = sp.Symbol("t", real=True)
SIDES = ("left", "right", "bottom", "top")


@dataclass(frozen=True)
class Side:
    """One side of the hole: a Bezier function over [start, end].

    Examples
    --------
    >>> Side.decimal("0.2", "0.5", "0.8", "0.75").value(Fraction(7, 20))
    Fraction(31, 40)
    """

    start: Fraction
    end: Fraction
    coefficients: tuple[Fraction, ...]

    def __post_init__(self) -> None:
        if not self.start < self.end:
            raise ValueError(f"side: found the interval [{self.start}, {self.end}], expected start < end")

    @classmethod
    def decimal(cls, start: str, end: str, *coefficients: str) -> Side:
        """Return the side whose numbers are these decimals, exactly."""
        return cls(Fraction(start), Fraction(end), tuple(map(Fraction, coefficients)))

    def value(self, t: Any) -> Any:
        """Return the value at t, a `Fraction` or a SymPy expression."""
        x = (t - self.start) / (self.end - self.start)
        return blossom(self.coefficients, [x] * (len(self.coefficients) - 1))

    @property
    def polynomial(self) -> sp.Poly:
        """The function as a polynomial in t."""
        return sp.Poly(self.value(_T), _T, domain=sp.QQ)

    @property
    def mean(self) -> Fraction:
        """The mean value over the interval."""
        return sum(self.coefficients, Fraction(0)) / len(self.coefficients)


@dataclass(frozen=True)
class Hole:
    """The four sides: u = left(v), u = right(v), v = bottom(u), v = top(u)."""

    left: Side
    right: Side
    bottom: Side
    top: Side


def corners(hole: Hole) -> dict[str, tuple[Point, Point]]:
    """Return each corner as (end of the left or right side, end of the bottom or top side), points (u, v)."""
    ends = _ends(hole)
    return {
        "lower left": (ends["left"][0], ends["bottom"][0]),
        "lower right": (ends["right"][0], ends["bottom"][1]),
        "upper right": (ends["right"][1], ends["top"][1]),
        "upper left": (ends["left"][1], ends["top"][0]),
    }


def boundary_residual(hole: Hole) -> dict[tuple[Any, ...], int]:
    """Return what is left of the eight boundaries less those of the square and the hole: empty for a tiling.

    A chain of segments on one axis-parallel line is known by the multiplicities of its ends; a side of the hole by
    its name and direction.
    """
    total: Counter[tuple[Any, ...]] = Counter()
    for loop in _piece_boundaries(hole):
        _add(total, loop, 1)
    _add(total, [(0, 0), (1, 0), (1, 1), (0, 1)], -1)
    # The hole counterclockwise: bottom and right forwards, top and left backwards.
    _add(total, [("bottom", 1), ("right", 1), ("top", -1), ("left", -1)], 1)
    return {key: count for key, count in total.items() if count}


def crossings(hole: Hole) -> dict[tuple[str, str], list[Point]]:
    """Return every common point (u, v) of each two sides of the hole, by exact root isolation.

    Raises
    ------
    ValueError
        Two sides coincide along a stretch.
    """
    found: dict[tuple[str, str], list[Point]] = {}
    for one, other in combinations(SIDES, 2):
        a, b = getattr(hole, one), getattr(hole, other)
        if {one, other} in ({"left", "right"}, {"bottom", "top"}):
            roots = _roots(a.polynomial - b.polynomial, max(a.start, b.start), min(a.end, b.end))
            found[one, other] = [_point(one, t, a.value(t)) for t in roots]
        else:
            # u = a(v) meets v = b(u) at the roots of a(b(u)) - u where b(u) lies in the interval of a.
            roots = _roots(a.polynomial.compose(b.polynomial) - sp.Poly(_T, _T), b.start, b.end)
            found[one, other] = [_point(other, t, b.value(t)) for t in roots if a.start <= b.value(t) <= a.end]
    return found


def inside_square(hole: Hole) -> bool:
    """Tell whether the hole stays strictly inside the unit square, by the signs of its Bernstein coefficients."""
    sides = [getattr(hole, name) for name in SIDES]
    return all(0 < x < 1 for side in sides for x in (*side.coefficients, side.start, side.end))


def areas(hole: Hole) -> dict[str, Fraction]:
    """Return the areas of the eight pieces in the parameter domain, and that of the hole by Green's formula.

    The hole's area is half the integral of u dv - v du around it, found apart from the others: all nine sum to 1 for a
    tiling.
    """
    left, right, bottom, top = hole.left, hole.right, hole.bottom, hole.top
    result = {
        "left": (left.end - left.start) * left.mean,
        "right": (right.end - right.start) * (1 - right.mean),
        "bottom": (bottom.end - bottom.start) * bottom.mean,
        "top": (top.end - top.start) * (1 - top.mean),
        "lower left": bottom.start * left.start,
        "lower right": (1 - bottom.end) * right.start,
        "upper right": (1 - top.end) * (1 - right.end),
        "upper left": top.start * (1 - left.end),
    }
    # Counterclockwise: bottom and right forwards, top and left backwards.
    turning = {name: _moment(name, getattr(hole, name)) for name in SIDES}
    result["hole"] = (turning["bottom"] + turning["right"] - turning["top"] - turning["left"]) / 2
    return result


def trimmed_rows(points: Sequence[Sequence[Any]], hole: Hole) -> dict[str, Net]:
    """Return exact control points of the eight pieces of a Bezier patch P_ij over the unit square.

    Each value is a sequence of rows. For a piece beside the hole the rows run along its side of the hole and are
    blended across, from the edge of the square or towards it, in the direction in which the parameter grows; for a
    rectangle, row i column j as in the patch.
    """
    net = tuple(tuple(row) for row in points)
    columns = _transpose(net)
    left, right, bottom, top = hole.left, hole.right, hole.bottom, hole.top
    rectangles = {
        "lower left": ((0, bottom.start), (0, left.start)),
        "lower right": ((bottom.end, 1), (0, right.start)),
        "upper right": ((top.end, 1), (right.end, 1)),
        "upper left": ((0, top.start), (left.end, 1)),
    }
    return {
        "left": division_rows(segment(columns, left.start, left.end), left.coefficients, "bottom"),
        "right": division_rows(segment(columns, right.start, right.end), right.coefficients, "top"),
        "bottom": division_rows(segment(net, bottom.start, bottom.end), bottom.coefficients, "bottom"),
        "top": division_rows(segment(net, top.start, top.end), top.coefficients, "top"),
        **{name: _transpose(segment(_transpose(segment(net, *us)), *vs)) for name, (us, vs) in rectangles.items()},
    }


def segment(points: Sequence[Sequence[Any]], start: Any, end: Any) -> Net:
    """Return the control points of the part start <= first parameter <= end of a patch, over the unit square.

    Examples
    --------
    >>> segment([[0], [1]], Fraction(1, 4), Fraction(1, 2))
    ((Fraction(1, 4),), (Fraction(1, 2),))
    """
    degree = len(points) - 1
    return tuple(
        tuple(blossom(column, [start] * (degree - i) + [end] * i) for column in zip(*points, strict=True))
        for i in range(degree + 1)
    )


def seam_residuals(pieces: dict[str, Net]) -> dict[tuple[str, str], list[Any]]:
    """Return, for the eight straight seams, the differences of the control points that two pieces have there."""
    start = {name: [row[0] for row in pieces[name]] for name in pieces}
    end = {name: [row[-1] for row in pieces[name]] for name in pieces}
    seams = {
        ("lower left", "left"): (end["lower left"], start["left"]),
        ("lower left", "bottom"): (pieces["lower left"][-1], start["bottom"]),
        ("lower right", "bottom"): (pieces["lower right"][0], end["bottom"]),
        ("lower right", "right"): (end["lower right"], start["right"]),
        ("upper right", "right"): (start["upper right"], end["right"]),
        ("upper right", "top"): (pieces["upper right"][0], end["top"]),
        ("upper left", "top"): (pieces["upper left"][-1], start["top"]),
        ("upper left", "left"): (start["upper left"], end["left"]),
    }
    return {key: [a - b for a, b in zip(one, other, strict=True)] for key, (one, other) in seams.items()}


def _piece_boundaries(hole: Hole) -> list[list[tuple[Any, Any]]]:
    """Counterclockwise boundaries: points (u, v), and between two of them a side of the hole as (name, direction)."""
    left, right, bottom, top = (getattr(hole, name) for name in SIDES)
    ends = _ends(hole)
    return [
        [(0, left.start), ends["left"][0], ("left", 1), ends["left"][1], (0, left.end)],
        [(1, right.start), (1, right.end), ends["right"][1], ("right", -1), ends["right"][0]],
        [(bottom.start, 0), (bottom.end, 0), ends["bottom"][1], ("bottom", -1), ends["bottom"][0]],
        [ends["top"][0], ("top", 1), ends["top"][1], (top.end, 1), (top.start, 1)],
        _rectangle(0, bottom.start, 0, left.start),
        _rectangle(bottom.end, 1, 0, right.start),
        _rectangle(top.end, 1, right.end, 1),
        _rectangle(0, top.start, left.end, 1),
    ]


def _rectangle(u0: Any, u1: Any, v0: Any, v1: Any) -> list[tuple[Any, Any]]:
    return [(u0, v0), (u1, v0), (u1, v1), (u0, v1)]


def _add(total: Counter[tuple[Any, ...]], loop: list[tuple[Any, Any]], sign: int) -> None:
    """Add a closed boundary to a chain; a segment counts as its end minus its start on the line that it lies on."""
    for start, end in zip(loop, [*loop[1:], loop[0]], strict=True):
        if isinstance(start[0], str):
            total[start[0],] += sign * start[1]
        elif not isinstance(end[0], str):
            axis = 0 if start[0] == end[0] else 1
            total["uv"[axis], start[axis], end[1 - axis]] += sign
            total["uv"[axis], start[axis], start[1 - axis]] -= sign


def _ends(hole: Hole) -> dict[str, tuple[Point, Point]]:
    """Return the first and the last point (u, v) of each side."""
    sides = {name: getattr(hole, name) for name in SIDES}
    return {
        name: (_point(name, side.start, side.coefficients[0]), _point(name, side.end, side.coefficients[-1]))
        for name, side in sides.items()
    }


def _point(side: str, t: Any, value: Any) -> Point:
    return (value, t) if side in ("left", "right") else (t, value)


def _roots(polynomial: sp.Poly, start: Fraction, end: Fraction) -> list[Any]:
    """All distinct roots in [start, end], exact."""
    if polynomial.is_zero:
        raise ValueError("two sides of the hole coincide along a stretch")
    return [r for r in sorted(set(polynomial.real_roots())) if start <= r <= end]


def _moment(name: str, side: Side) -> Fraction:
    """Integrate u dv - v du along a side."""
    ends = side.end * side.coefficients[-1] - side.start * side.coefficients[0]
    twice = 2 * (side.end - side.start) * side.mean
    return twice - ends if name in ("left", "right") else ends - twice


def _transpose(rows: Sequence[Sequence[Any]]) -> Net:
    return tuple(zip(*rows, strict=True))
