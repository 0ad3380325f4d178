"""Whether the four sides of a hole form a simple loop: decided by subdivision, without samples.

Two Bezier curves are apart where a line separates their control points (convex hull property). Where none of a few
lines does, the longer curve is halved. Sides that share a corner are apart, but for it, where a line through the corner
separates all their other control points.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from semispline.solver.arrays import FloatArray

# Pieces of sides shorter than this fraction of the domain that no line separates count as touching.
APART = 1e-9
# Far more pairs than sides need that are apart by APART; reached by sides that nearly coincide along their length.
MOST_PAIRS = 20_000
# Rounding of coordinates in the unit square.
ROUNDING = 1e-15


def crossing_sides(sides: dict[str, FloatArray]) -> tuple[str, str] | None:
    """Return the names of two sides that meet elsewhere than in their common corner, or None.

    Parameters
    ----------
    sides : dict of ndarray, shapes (k + 1, 2)
        Bezier control points in the unit square, counterclockwise; each side ends where the next one starts.
    """
    names = list(sides)
    for one, other in combinations(names, 2):
        steps = (names.index(other) - names.index(one)) % 4
        a, b = sides[one], sides[other]
        # The common corner last in the first curve and first in the second.
        pair = (a, b, True) if steps == 1 else (b, a, True) if steps == 3 else (a, b, False)
        if not _apart(*pair):
            return one, other
    return None


def signed_area(sides: dict[str, FloatArray]) -> float:
    """Return the area inside the loop, positive where it runs counterclockwise; exact for Bezier curves."""
    total = 0.0
    for points in sides.values():
        k = len(points) - 1
        if k == 0:
            continue
        x, y = points.T
        # x dy is a polynomial of degree 2 k - 1, which k + 1 Gauss points integrate exactly.
        t, weight = np.polynomial.legendre.leggauss(k + 1)
        total += float(np.sum(0.5 * weight * _values(x, (t + 1) / 2) * k * _values(np.diff(y), (t + 1) / 2)))
    return total


def _values(coefficients: FloatArray, t: FloatArray) -> FloatArray:
    level = np.repeat(coefficients[:, None], len(t), axis=1)
    while len(level) > 1:
        level = (1 - t) * level[:-1] + t * level[1:]
    return np.asarray(level[0])


def _apart(a: FloatArray, b: FloatArray, corner: bool) -> bool:
    """Tell whether two Bezier curves do not meet, but where the first one ends and the second one starts."""
    todo = [(a, b, corner)]
    for _ in range(MOST_PAIRS):
        if not todo:
            return True
        a, b, corner = todo.pop()
        if _separated(a, b, corner):
            continue
        long_a, long_b = (float(np.ptp(x, axis=0).max()) for x in (a, b))
        if max(long_a, long_b) < APART:
            return False
        if long_a >= long_b:
            first, second = _halves(a)
            todo += [(first, b, False), (second, b, corner)]
        else:
            first, second = _halves(b)
            todo += [(a, second, False), (a, first, corner)]
    return False


def _separated(a: FloatArray, b: FloatArray, corner: bool) -> bool:
    """Tell whether one of a few lines separates two sets of control points."""
    chords = [x[-1] - x[0] for x in (a, b)]
    units = [c / (np.hypot(*c) or 1.0) for c in chords]
    directions = np.array(
        [[1, 0], [0, 1], *(_turned(c) for c in units), units[0] + units[1], _turned(units[1] - units[0])]
    )
    # The bisector of the corner, and what is perpendicular to it, are among them.
    directions = np.concatenate([directions, -directions])
    if corner:
        below = (a[:-1] - a[-1]) @ directions.T
        above = (b[1:] - b[0]) @ directions.T
        strict = (below.max(axis=0) < -ROUNDING) & (above.min(axis=0) > ROUNDING)
        return bool(strict.any())
    gaps = (b @ directions.T).min(axis=0) - (a @ directions.T).max(axis=0)
    return bool((gaps > ROUNDING).any())


def _turned(vector: FloatArray) -> FloatArray:
    return np.array([-vector[1], vector[0]])


def _halves(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the control points of both halves, by de Casteljau's triangle."""
    level, first, second = points, [points[0]], [points[-1]]
    while len(level) > 1:
        level = 0.5 * (level[:-1] + level[1:])
        first.append(level[0])
        second.append(level[-1])
    return np.stack(first), np.stack(second[::-1])
