"""Pairs of bases that fit the words and the knots of Figs. 5, 6 and 8: our own geometry, since none is printed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from semispline.papers.lin2014 import printed as pr
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineSurface, greville, uniform_knots

Point = tuple[float, float, float]


def _patch(rows: int, key: str, point: Callable[[float, float], Point]) -> BSplineSurface:
    """Return a bicubic patch with uniform knots across and printed ones along; control points at Greville abscissae."""
    across, along = uniform_knots(3, rows - 3), np.array([float(x) for x in pr.KNOTS[key]])
    net = [[point(w, v) for v in greville(along, 3)] for w in greville(across, 3)]
    return BSplineSurface(3, 3, across, along, np.array(net))


def _pair(
    sizes: tuple[int, int], keys: tuple[str, str], points: tuple[Callable[[float, float], Point], ...]
) -> tuple[Base, Base]:
    first, second = (_patch(n, key, point) for n, key, point in zip(sizes, keys, points, strict=True))
    return Base(first, "u0"), Base(second, "u0")


@cache
def planes() -> tuple[Base, Base]:
    """Return two planar patches with the sizes and knots of Fig. 5, the second one rising by 45 degrees."""
    return _pair(
        (6, 6),
        ("fig-5.first", "fig-5.second"),
        (lambda w, v: (-3 * w, 4 * v, 0.0), lambda t, v: (2 + 2 * t, 4 * v, 1 + 2 * t)),
    )


@cache
def plane_and_curved() -> tuple[Base, Base]:
    """Return a planar and a curved patch with the sizes and knots of Fig. 6."""
    return _pair(
        (5, 5),
        ("fig-6.planar", "fig-6.curved"),
        (
            lambda w, v: (-3 * w, 4 * v, 0.0),
            lambda t, v: (2 + 3 * t, 4 * v, 0.8 + 1.2 * t - 0.9 * t**2 + 0.4 * float(np.sin(3 * v))),
        ),
    )


@cache
def cylinders() -> tuple[Base, Base]:
    """Return parts of two cylinders of radii 2 and 1 with the sizes and knots of Fig. 8, contact along arcs."""

    def arc(radius: float, v: float) -> tuple[float, float]:
        angle = 1.6 * (v - 0.5)
        return radius * float(np.sin(angle)), radius * float(np.cos(angle))

    return _pair(
        (6, 6),
        ("fig-8.larger", "fig-8.smaller"),
        (lambda w, v: (-3 * w, *arc(2.0, v)), lambda t, v: (2 + 3 * t, *arc(1.0, v))),
    )
