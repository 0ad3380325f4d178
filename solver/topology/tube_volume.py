"""What a tube between two plane outlines may add, told from these alone: by that the gate measures a blend."""

from __future__ import annotations

import numpy as np

from semispline.solver.arrays import FloatArray

_SAMPLES = 200


def tube_volume(a: tuple[FloatArray, FloatArray], b: tuple[FloatArray, FloatArray]) -> tuple[float, float]:
    """Return the volume of a tube between two outlines, and its area times its width.

    Its middle line leaves both squarely, as long as they are apart; its section is between both.

    Parameters
    ----------
    a, b : (ndarray, ndarray)
        Points along the closed outline, shape (K, 3), and the unit normal towards the tube.

    Examples
    --------
    >>> square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]], dtype=float)
    >>> up = np.array([0, 0, 1.0])
    >>> [round(x, 9) for x in tube_volume((square, up), (square[::-1] + 3 * up, -up))]
    [3.0, 12.0]
    """
    (area_a, at_a), (area_b, at_b) = (_section(line, normal) for line, normal in (a, b))
    t = np.linspace(0.0, 1.0, _SAMPLES + 1)[:, None]
    way = at_b - at_a
    apart = float(np.linalg.norm(way))
    middle = at_a + (3 - 2 * t) * t**2 * way + apart * t * (1 - t) * ((1 - t) * a[1] + t * b[1])
    length = float(np.linalg.norm(np.diff(middle, axis=0), axis=1).sum())
    around = float(np.mean([np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line, _ in (a, b)]))
    section = (area_a + np.sqrt(area_a * area_b) + area_b) / 3
    # Four times the area over the way round is the width of a circle, or of a square.
    return float(section * length), float(around * length * min(length, 4 * section / around))


def _section(line: FloatArray, normal: FloatArray) -> tuple[float, FloatArray]:
    """Return area and centre of what an outline encloses."""
    corners = line - line[0]
    triangles = 0.5 * np.cross(corners[:-1], corners[1:]) @ normal
    area = float(triangles.sum())
    centre = (triangles[:, None] * (corners[:-1] + corners[1:]) / 3).sum(axis=0) / area
    return abs(area), line[0] + centre
