"""Whether rows over different parameters are rows of one surface."""

import numpy as np
from scipy.optimize import brentq

from semispline.solver.splines import basis_matrix


def stacked(along, rows, v):
    if rows.shape[-1] == 3:
        rows = np.concatenate([rows, np.ones((*rows.shape[:2], 1))], axis=-1)
    return np.einsum("vn,knd->vkd", basis_matrix(along.degree, along.knots, np.atleast_1d(v)).toarray(), rows).reshape(
        len(np.atleast_1d(v)), -1
    )


def departure(old, new):
    """The largest angle between all rows of the new form and those of the old at the nearest place of row 0."""
    start, end = old[1].knots[0], old[1].knots[-1]
    assert (new[1].knots[0], new[1].knots[-1]) == (start, end)
    grid = np.linspace(start, end, 401)
    step = grid[1] - grid[0]

    def direction(curve, v):
        points = stacked(curve[1], curve[0], np.clip(v, start, end))
        return points / np.linalg.norm(points, axis=1)[:, None]

    at_grid = direction(old, grid)
    worst = 0.0
    for found in direction(new, np.linspace(start, end, 23)[1:-1]):

        def slope(v, found=found):
            before, at, after = direction(old, np.array([v - step / 100, v, v + step / 100]))
            return float((after - before) @ (at - found))

        near = grid[int(np.argmin(np.linalg.norm(at_grid - found, axis=1)))]
        v = brentq(slope, near - step, near + step, xtol=1e-15)
        worst = max(worst, float(np.linalg.norm(direction(old, np.array([v]))[0] - found)))
    return worst
