"""Plane geometry that the text takes for granted: turning, circles, crossing lines."""

from __future__ import annotations

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
