"""Blends of degree 5 from the rows of two sides, measured without the code that made the rows."""

from functools import cache

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import brentq

from semispline.solver.generated import contact_numpy

# One Bezier span across in all bases; the blend has degree 5 and none inside.
SPANS = (1.0, 1.0)


def derivatives(across, sides, u, v, before=False):
    """Homogeneous derivatives X[i, j] of sum N_i(u) H_i(v), i + j <= 2; at knots from above or from below."""
    result = {}
    for rows, along in sides:
        knots = along.knots
        # One-sided at a knot: the spline of the span that ends or begins there.
        at = int(np.searchsorted(knots, v, side="left" if before else "right")) - 1
        at = min(max(at, along.degree), len(knots) - along.degree - 2)
        local = knots[at - along.degree : at + along.degree + 2]
        points = rows[:, at - along.degree : at + 1]
        curve = BSpline(local, points.transpose(1, 0, 2).reshape(along.degree + 1, -1), along.degree)
        weights = [across(u, i, rows) for i in range(3)]
        for j in range(3):
            values = curve(v, nu=j, extrapolate=True).reshape(len(rows), 4)
            for i in range(3 - j):
                result[i, j] = result.get((i, j), 0) + weights[i] @ values
    return result


def cartesian(h):
    """Derivatives of the quotient."""
    w = {k: x[3] for k, x in h.items()}
    x = {k: value[:3] for k, value in h.items()}
    p = {(0, 0): x[0, 0] / w[0, 0]}
    for k in ((1, 0), (0, 1)):
        p[k] = (x[k] - w[k] * p[0, 0]) / w[0, 0]
    p[2, 0] = (x[2, 0] - 2 * w[1, 0] * p[1, 0] - w[2, 0] * p[0, 0]) / w[0, 0]
    p[0, 2] = (x[0, 2] - 2 * w[0, 1] * p[0, 1] - w[0, 2] * p[0, 0]) / w[0, 0]
    p[1, 1] = (x[1, 1] - w[1, 0] * p[0, 1] - w[0, 1] * p[1, 0] - w[1, 1] * p[0, 0]) / w[0, 0]
    return p


def plane_and_curvature(p):
    """Unit normal, and the curvature as a symmetric 3 x 3 matrix: neither knows the parameters."""
    normal = np.cross(p[1, 0], p[0, 1])
    normal /= np.linalg.norm(normal)
    jacobian = np.column_stack([p[1, 0], p[0, 1]])
    second = np.array([[p[2, 0] @ normal, p[1, 1] @ normal], [p[1, 1] @ normal, p[0, 2] @ normal]])
    back = np.linalg.pinv(jacobian)
    return normal, back.T @ second @ back


def difference(one, other):
    """Angle in degrees and relative difference of curvature."""
    (n, k), (m, c) = plane_and_curvature(cartesian(one)), plane_and_curvature(cartesian(other))
    if n @ m < 0:
        m, c = -m, -c
    angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(n, m)), n @ m))
    return angle, np.linalg.norm(k - c) / max(np.linalg.norm(k), np.linalg.norm(c))


@cache
def bernstein_polynomials(degree):
    return BSpline(np.repeat([0.0, 1.0], degree + 1), np.eye(degree + 1), degree)


def bernstein(degree, u, order, count):
    """Derivatives of the first `count` Bernstein polynomials."""
    return bernstein_polynomials(degree)(u, nu=order)[:count]


class Blend:
    """G2 at both edges, degree 5, from the rows of two sides."""

    def __init__(self, a, b, alpha=(0.8, 1.3)):
        self.sides, self.flipped = [], (False, True)
        for (rows, along, degree), factor in zip((a, b), alpha, strict=True):
            matrix = contact_numpy.contact_rows_2(factor, 5, *SPANS, degree, *SPANS)
            self.sides.append((np.einsum("ij,jnc->inc", matrix, rows), along))

    def at(self, u, v, before=False):
        def across(x, i, rows):
            values = bernstein(5, x, i, 6)
            return values[:3] if rows is self.sides[0][0] else values[::-1][:3]

        return derivatives(across, self.sides, u, v, before)

    def inside(self, closed):
        """Worst crease and jump of curvature at knot lines, the seam with them."""
        knots = np.unique(np.concatenate([np.unique(along.knots) for _, along in self.sides]))
        lines = [(v, v) for v in knots[1:-1]] + ([(knots[-1], knots[0])] if closed else [])
        found = [
            difference(self.at(u, before, True), self.at(u, after))
            for before, after in lines
            for u in np.linspace(0.05, 0.95, 7)
        ]
        # An arc of less than half a turn has no line left.
        return np.max(np.reshape(found, (-1, 2)), axis=0, initial=0.0)

    def contact(self, end, rows, along, degree):
        """Worst gap, angle and jump of curvature to a base at the nearest places of its edge."""
        base = (rows, along)
        start, stop = along.knots[0], along.knots[-1]
        grid = np.linspace(start, stop, 401)

        def edge(v):
            return cartesian(derivatives(lambda u, i, r: bernstein(degree, u, i, len(r)), [base], 0.0, v))

        places = np.array([edge(v)[0, 0] for v in grid])
        worst = np.zeros(3)
        for v in np.linspace(start, stop, 13)[1:-1]:
            mine = self.at(float(end), v)
            point = cartesian(mine)[0, 0]
            near = int(np.clip(np.argmin(np.linalg.norm(places - point, axis=1)), 1, 399))

            def slope(x, point=point):
                there = edge(np.clip(x, start, stop))
                return (there[0, 0] - point) @ there[0, 1]

            foot = brentq(slope, grid[near - 1], grid[near + 1], xtol=1e-15)
            theirs = derivatives(lambda u, i, r: bernstein(degree, u, i, len(r)), [base], 0.0, foot)
            gap = np.linalg.norm(cartesian(theirs)[0, 0] - point)
            worst = np.maximum(worst, [gap, *difference(mine, theirs)])
        return worst
