"""Plane geometry that the text takes for granted: turning, circles, crossing lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau


def curvature(x1: Any, y1: Any, x2: Any, y2: Any) -> Any:
    """Return how fast the unit tangent turns towards the left normal, over the speed; derivatives of both coordinates.

    Examples
    --------
    >>> curvature(2, 0, 0, 1)
    1/4
    """
    speed = sp.sqrt(sp.sympify(x1) ** 2 + sp.sympify(y1) ** 2)
    slower = (x1 * x2 + y1 * y2) / speed
    turning = [second / speed - first * slower / speed**2 for first, second in ((x1, x2), (y1, y2))]
    return (turning[0] * -y1 + turning[1] * x1) / speed / speed


def curvature_radius(x1: Any, y1: Any, x2: Any, y2: Any) -> Any:
    """Return how far to the left the centre lies whose squared distance to the curve changes in third order only.

    Half of its second derivative is speed^2 - radius (normal . second derivative of the curve).

    Examples
    --------
    >>> curvature_radius(2, 0, 0, 1)
    4
    """
    speed = sp.sqrt(sp.sympify(x1) ** 2 + sp.sympify(y1) ** 2)
    return speed**2 / ((-y1 * x2 + x1 * y2) / speed)


def quarter_circle(radius: float) -> tuple[tuple[Any, Any], Any]:
    """Return both coordinates of the usual cubic curve for a quarter circle, in floating point, and its parameter."""
    t = sp.Symbol("t")
    f = 4 / 3 * float(sp.tan(sp.pi / 8))
    points = [(1, 0), (1, f), (f, 1), (0, 1)]
    x, y = (radius * sp.expand(de_casteljau([sp.Rational(p[k]) for p in points], t)) for k in (0, 1))
    return (x, y), t


@dataclass(frozen=True)
class Hat:
    """A curve of degree 2 or 3 in the plane, at a parameter.

    Attributes
    ----------
    start, end : pairs
        Of coordinates, as all points.
    tip : pair
        One level of de Casteljau's triangle above the point on the curve, in the middle: A.
    point : pair
        On the curve: B.
    foot : pair
        Where the line from tip through point meets the line from start to end: C.
    share : sympy.Expr
        That of start in foot.
    """

    start: Any
    end: Any
    tip: Any
    point: Any
    foot: Any
    share: Any

    @property
    def ratio(self) -> Any:
        """The part of (point - tip) that (foot - point) is, by the first coordinate: both are along one line."""
        return (self.foot[0] - self.point[0]) / (self.point[0] - self.tip[0])


def hat(points: Sequence[Sequence[Any]], t: Any) -> Hat:
    """Return the points that belong to a parameter, by de Casteljau's triangle and one crossing of lines.

    Examples
    --------
    >>> found = hat([(0, 0), (1, 1), (2, 0)], sp.Rational(1, 2))
    >>> found.foot, found.share, found.ratio if found.tip[0] != found.point[0] else "above each other"
    ((1, 0), 1/2, 'above each other')
    """
    ways = [[sp.sympify(p[k]) for p in points] for k in (0, 1)]
    inner = [way[1:-1] for way in ways]
    tip = tuple(de_casteljau(way, t) for way in inner)
    point = tuple(de_casteljau(way, t) for way in ways)
    start, end = (tuple(way[place] for way in ways) for place in (0, -1))

    def cross(a: Any, b: Any) -> Any:
        return a[0] * b[1] - a[1] * b[0]

    def minus(a: Any, b: Any) -> Any:
        return a[0] - b[0], a[1] - b[1]

    # (end + share (start - end) - tip) x (point - tip) = 0
    down = minus(point, tip)
    share = -cross(minus(end, tip), down) / cross(minus(start, end), down)
    foot = tuple(e + share * (s - e) for s, e in zip(start, end, strict=True))
    return Hat(start, end, tip, point, foot, share)


def any_points(count: int) -> list[tuple[Any, Any]]:
    """Return points of the plane that may be anywhere.

    Examples
    --------
    >>> any_points(2)
    [(x0, y0), (x1, y1)]
    """
    return [(sp.Symbol(f"x{i}", real=True), sp.Symbol(f"y{i}", real=True)) for i in range(count)]


@cache
def along_hat(degree: int, t: Any) -> dict[str, Any]:
    """Return A, B and C of any curve, coordinate by coordinate, the share of the start in C, and the ratio.

    Share and ratio are the same for all control points (abc.1 to abc.3), and so are taken from one choice of them.
    """
    plain = hat({2: [(0, 0), (1, 2), (2, 0)], 3: [(0, 0), (1, 2), (3, 1), (4, 0)]}[degree], t)
    share, ratio = sp.cancel(plain.share), sp.cancel(plain.ratio)
    found = hat(any_points(degree + 1), t)
    foot = share * found.start[0] + (1 - share) * found.end[0]
    return {"A": found.tip[0], "B": found.point[0], "C": foot, "share": share, "ratio": ratio}


@dataclass(frozen=True)
class Arc:
    """An arc of the unit circle from (1, 0) to an angle.

    Attributes
    ----------
    start, end, middle : pairs
    corner : pair
        Where the tangents at both ends meet.
    along_start, along_end : sympy.Expr
        How far from start and end that is, in the direction of rising angles.
    """

    start: Any
    end: Any
    middle: Any
    corner: Any
    along_start: Any
    along_end: Any


def arc(angle: Any) -> Arc:
    """Return the arc; its middle is on the bisector, and the tangents are at right angles to the radii.

    Examples
    --------
    >>> found = arc(sp.pi / 2)
    >>> found.corner, found.along_end
    ((1, 1), -1)
    """
    start, end = (sp.Integer(1), sp.Integer(0)), (sp.cos(angle), sp.sin(angle))
    # (1, a) . end = 1, since the tangent at the end is where the product with the end is 1.
    a = (1 - end[0]) / end[1]
    # (end + b (-sin, cos)) . start = 1.
    b = -(1 - end[0]) / end[1]
    half = angle / 2
    # |start + end| is twice the cosine of half of the angle.
    middle = tuple((s + e) / (2 * sp.cos(half)) for s, e in zip(start, end, strict=True))
    return Arc(start, end, middle, (sp.Integer(1), a), a, b)
