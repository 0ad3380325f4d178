"""How far a surface between two closed rims is pinched: the least distance of opposite points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import closed_directions, least_on_grid, spread

# Samples in u and along half of v altogether, and the least in each span.
_TOTAL, _LEAST = (40, 30), (4, 2)


@dataclass(frozen=True)
class Waist:
    """The least distance of opposite points, in model units.

    Attributes
    ----------
    distance : float
        Between P(u, v) and P(u, v + half a period).
    u, v : float
        Where.
    points : pair of tuples of float
        The two points.
    of_rulings : float
        The same for the straight lines between P(0, v) and P(1, v): where these themselves come close, as for tilted
        rims, a small distance says nothing against the surface.
    of_rims : float
        The same at the two rims alone.
    """

    distance: float
    u: float
    v: float
    points: tuple[tuple[float, float, float], tuple[float, float, float]]
    of_rulings: float
    of_rims: float


def measure_waist(surface: ParametricSurface) -> Waist | None:
    """Return the waist of a surface that is closed in v; None where it is open.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> square = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1], [1, 1]])
    >>> net = [[[x * r, y * r, z] for x, y in square] for r, z in ((1, 0), (0.5, 1), (1, 2))]
    >>> box = BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 0.25, 0.5, 0.75, 1, 1], net)
    >>> waist = measure_waist(box)
    >>> round(waist.distance, 9), waist.u, round(waist.of_rulings, 9)
    (1.0, 0.5, 2.0)
    """
    if not closed_directions(surface)[1]:
        return None
    (u_start, u_end), (start, end) = surface.domain
    u_breaks, v_breaks = surface.breakpoints
    half = (end - start) / 2
    # Knots on the other side are knots of the distance, too.
    breaks = np.unique(np.concatenate([start + (v_breaks - start) % half, [start, start + half]]))
    u, v = spread(u_breaks, _TOTAL[0], _LEAST[0]), spread(breaks, _TOTAL[1], _LEAST[1])
    rims = np.array([u_start, u_end])

    def across(u: FloatArray, v: FloatArray) -> FloatArray:
        return surface.evaluate_grid(u, v) - surface.evaluate_grid(u, np.minimum(v + half, end))

    def between_rims(u: FloatArray, v: FloatArray) -> FloatArray:
        share = ((u - u_start) / (u_end - u_start))[:, None, None]
        first, last = across(rims, v)
        return np.asarray((1 - share) * first + share * last)

    distance, at_u, at_v = least_on_grid(lambda u, v: np.linalg.norm(across(u, v), axis=-1), u, v)
    of_rulings = least_on_grid(lambda u, v: np.linalg.norm(between_rims(u, v), axis=-1), u, v)[0]
    of_rims = min(
        least_on_grid(lambda u, v: np.linalg.norm(across(u, v), axis=-1), rim, v)[0] for rim in (rims[:1], rims[1:])
    )
    (x0, y0, z0), (x1, y1, z1) = surface.evaluate_grid(np.array([at_u]), np.array([at_v, min(at_v + half, end)]))[
        0
    ].tolist()
    return Waist(distance, at_u, at_v, ((x0, y0, z0), (x1, y1, z1)), of_rulings, of_rims)
