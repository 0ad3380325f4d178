"""What a band has to know of its face along a curve: the frame, the second form, the section square to the curve.

At a point of the curve, T is its unit tangent, N the normal S_s x S_t of the face, and D = sign * N x T the direction
into the part of the face that is kept. The section of the face with the plane of D and N is the graph of a height over
its tangent line; the height's derivatives there are 0, 0, h_2 = II(D, D), h_3, h_4.

Source: `semispline.derivations.bands`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import factorial
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import BSplineSurface, Jet, bounding_box, surface_jet

# Of the size: so near to a parallelogram the corners of one are in doubles.
_EVEN = 1e-14
# Borders that are as near as this to each other, of the size, are one line: the surface is closed.
_CLOSED = 1e-9
# Sines: a surface goes on smoothly where its tangent planes at both sides of the seam are as near as this.
_SMOOTH, _SEAM_PLACES = 1e-6, 17
# So far beside the curve, in fractions of the domain, lies the point that chooses the side of a knot line.
_BESIDE = 1e-9
_STEPS = 12
# Of the domain: the longest step to a foot, and how far one may lie beyond a border.
_LONGEST, _BEYOND = 0.1, 1e-3


@dataclass(frozen=True, eq=False)
class Face:
    """A surface whose parameters may run on over its seams, where it is closed.

    Attributes
    ----------
    surface : BSplineSurface
    """

    surface: BSplineSurface

    @cached_property
    def size(self) -> float:
        """The largest extent of the control points."""
        return float(np.ptp(bounding_box(self.surface), axis=0).max())

    @cached_property
    def low(self) -> FloatArray:
        """Where both ranges start, shape (2,)."""
        return np.array([start for start, _ in self.surface.domain])

    @cached_property
    def widths(self) -> FloatArray:
        """The lengths of both ranges, shape (2,)."""
        return np.array([end - start for start, end in self.surface.domain])

    @cached_property
    def closed(self) -> NDArray[np.bool_]:
        """Whether the surface is closed in either direction, shape (2,)."""
        net = self.surface.homogeneous
        away = (np.abs(net[0] - net[-1]).max(), np.abs(net[:, 0] - net[:, -1]).max())
        return np.asarray(np.array(away) <= _CLOSED * np.abs(net - net[0, 0]).max())

    @cached_property
    def periods(self) -> FloatArray:
        """After how much of each parameter the surface goes on smoothly in itself; 0 where it does not, shape (2,)."""
        return np.array([self.widths[axis] if self._is_smooth(axis) else 0.0 for axis in (0, 1)])

    @cached_property
    def is_affine(self) -> bool:
        """Whether the surface is a plane whose parameters run evenly over it: a parallelogram, up to rounding."""
        surface, net = self.surface, self.surface.homogeneous
        if surface.weights is not None or (surface.degree_u, surface.degree_v) != (1, 1) or net.shape[:2] != (2, 2):
            return False
        return float(np.abs(net[0, 0] - net[0, 1] - net[1, 0] + net[1, 1]).max()) <= _EVEN * self.size

    def _is_smooth(self, axis: int) -> bool:
        if not self.closed[axis]:
            return False
        at = np.empty((2, _SEAM_PLACES, 2))
        at[..., axis] = (self.low[axis] + np.array([0.0, self.widths[axis]]))[:, None]
        at[..., 1 - axis] = self.low[1 - axis] + self.widths[1 - axis] * np.linspace(0, 1, _SEAM_PLACES)
        jets = [surface_jet(self.surface, x[:, 0], x[:, 1], 1) for x in at]
        one, other = (unit(np.cross(jet[1, 0], jet[0, 1])) for jet in jets)
        # A pole has no normal.
        apart = np.nan_to_num(np.linalg.norm(np.cross(one, other), axis=1))
        return bool(apart.max() <= _SMOOTH and (np.nan_to_num(dot(one, other), nan=1.0) > 0).all())

    def jet(self, at: FloatArray, order: int, beside: FloatArray | None = None) -> Jet:
        """Return derivatives at parameters, shape (K, 2), in the spans of the points `beside` them."""
        beside = at if beside is None else beside
        turns = np.where(self.closed, np.floor((beside - self.low) / self.widths), 0.0)
        shift = turns * self.widths
        (u, v), (u_in, v_in) = (at - shift).T, (beside - shift).T
        return surface_jet(self.surface, u, v, order, (u_in, v_in))

    def beside(self, at: FloatArray, slope: FloatArray, sign: float) -> FloatArray:
        """Return points a hair to the kept side of a curve in the parameters with these slopes, shape (K, 2)."""
        turned = sign * np.stack([-slope[:, 1], slope[:, 0]], axis=1)
        # Of a curve that is nearly straight along a parameter line the other component is noise.
        longest = np.maximum(np.abs(turned).max(axis=1), 1e-300)[:, None]
        return np.asarray(at + _BESIDE * self.widths * turned / longest)

    def feet(
        self, points: FloatArray, at: FloatArray, beside: FloatArray | None, order: int
    ) -> tuple[FloatArray, Jet, FloatArray]:
        """Return the parameters of the feet of points near `at`, the face's jet there, and the vectors foot to point.

        Spans stay those of `beside`, or without it follow the foot. Newton's method, Gauss-Newton where it fails.
        """
        at = np.array(at)
        for _ in range(_STEPS):
            jet = self.jet(at, max(order, 2), beside)
            away = points - jet[0, 0]
            step, plain = parameters_of(jet, away, away), parameters_of(jet, away)
            # Far from the face the Hessian may not be positive.
            wild = ~np.isfinite(step).all(axis=1) | (np.abs(step) > 4 * np.abs(plain) + 1e-15).any(axis=1)
            step = np.where(np.asarray(wild)[:, None], plain, step)
            # In a pole no step leads away.
            step = np.where(np.isfinite(step), step, 0.0)
            moved = at + np.clip(step, -_LONGEST * self.widths, _LONGEST * self.widths)
            # Beyond a border that is not closed the face goes on by its last spans, but not far.
            low, high = self.low - _BEYOND * self.widths, self.low + (1 + _BEYOND) * self.widths
            moved = np.where(self.closed, moved, np.clip(moved, low, high))
            done = bool((np.abs(moved - at) <= 4e-15 * (np.abs(at) + self.widths)).all())
            at = moved
            if done:
                break
        jet = self.jet(at, order, beside)
        return at, jet, points - jet[0, 0]


# a, b, c of symmetric matrices with the rows (a, b) and (b, c), each of shape (K,).
Symmetric: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]


def metric(jet: Jet) -> Symmetric:
    """Return J^T J."""
    s, t = jet[1, 0], jet[0, 1]
    return dot(s, s), dot(s, t), dot(t, t)


def _hessian(jet: Jet, away: FloatArray) -> Symmetric:
    """Return the Hessian of half the squared distance of points, `away` from the face."""
    a, b, c = metric(jet)
    return a - dot(jet[2, 0], away), b - dot(jet[1, 1], away), c - dot(jet[0, 2], away)


@dataclass(frozen=True, eq=False)
class Sections:
    """Frame and curvature of a surface at points of a curve on it; of K points.

    Attributes
    ----------
    point, along, into, normal : ndarray, shape (K, 3)
        The point, T, D and N.
    bends : ndarray, shape (3, K)
        II(T, T), II(T, D), II(D, D) with respect to N.
    heights : ndarray, shape (order - 1, K)
        h_2 (the last of the bends), h_3, .. of the section of D and N.
    """

    point: FloatArray
    along: FloatArray
    into: FloatArray
    normal: FloatArray
    bends: FloatArray
    heights: FloatArray


def sections(jet: Jet, tangent: FloatArray, sign: float, order: int, normal_like: FloatArray | None = None) -> Sections:
    """Return the frame along tangents in space, shape (K, 3), and curvature up to what contact of `order` asks for.

    The tangents are made tangent to the surface; `normal_like` turns the normal to its side.
    """
    normal = unit(np.cross(jet[1, 0], jet[0, 1]))
    if normal_like is not None:
        turn = np.where(dot(normal, normal_like) < 0, -1.0, 1.0)
        normal, side = normal * turn[:, None], sign * np.ones(len(turn))
    else:
        side = np.full(len(normal), sign)
    along = unit(tangent - dot(tangent, normal)[:, None] * normal)
    into = side[:, None] * np.cross(normal, along)
    inverse = metric(jet)
    ahead, inside = (_solved(inverse, jet, x) for x in (along, into))
    second = (dot(jet[2, 0], normal), dot(jet[1, 1], normal), dot(jet[0, 2], normal))
    bends = np.stack([_form(second, x, y) for x, y in ((ahead, ahead), (ahead, inside), (inside, inside))])
    heights = _heights(jet, inside, normal, inverse, order)
    return Sections(jet[0, 0], along, into, normal, bends, heights)


def _heights(jet: Jet, inside: FloatArray, normal: FloatArray, inverse: Symmetric, order: int) -> FloatArray:
    """Return h_2 .. h_order, shape (order - 1, K), by truncated power series of the path above the tangent line.

    With the path c + x_1 w + x_2 w^2 + .. in the parameters, A_k = [w^k] S(c + x_1 w + .. + x_(k-1) w^(k-1)) has the
    height h_k / k!, and x_k takes its tangential part away.
    """
    count = len(normal)
    path = np.zeros((order + 1, count, 2))
    path[1] = inside
    found = []
    for k in range(2, order + 1):
        known = _coefficient(jet, path, k)
        found.append(factorial(k) * dot(known, normal))
        if k < order:
            path[k] = -_solved(inverse, jet, known)
    return np.array(found)


def _coefficient(jet: Jet, path: FloatArray, k: int) -> FloatArray:
    """Return [w^k] S(c + path), shape (K, 3); the path has no term of order 0."""
    powers_s, powers_t = _powers(path[..., 0], k), _powers(path[..., 1], k)
    total = np.zeros_like(jet[0, 0])
    for i in range(k + 1):
        for j in range(k + 1 - i):
            if i + j:
                factor = sum(powers_s[i][m] * powers_t[j][k - m] for m in range(k + 1))
                total += (factor / (factorial(i) * factorial(j)))[:, None] * jet[i, j]
    return total


def _powers(series: FloatArray, k: int) -> list[FloatArray]:
    """Return powers 0 .. k of a power series, truncated after order k, each of shape (k + 1, K)."""
    one = np.zeros((k + 1, series.shape[1]))
    one[0] = 1.0
    found = [one]
    for _ in range(k):
        last, product = found[-1], np.zeros_like(one)
        for m in range(k + 1):
            for n in range(min(m, len(series) - 1) + 1):
                product[m] += series[n] * last[m - n]
        found.append(product)
    return found


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return scalar products along the last axis."""
    return np.asarray(np.einsum("...d,...d->...", a, b))


def unit(vectors: FloatArray) -> FloatArray:
    """Return unit vectors; not a number where there is no direction."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(np.divide(vectors, length, out=np.full_like(vectors, np.nan), where=length > 0))


def _solved(matrix: Symmetric, jet: Jet, vectors: FloatArray) -> FloatArray:
    """Return x of matrix x = J^T vectors, shape (K, 2); not a number where it has no inverse."""
    a, b, c = matrix
    right_s, right_t = dot(jet[1, 0], vectors), dot(jet[0, 1], vectors)
    determinant = a * c - b * b
    found = np.full((len(determinant), 2), np.nan)
    known = determinant != 0
    np.divide(c * right_s - b * right_t, determinant, out=found[:, 0], where=known)
    np.divide(a * right_t - b * right_s, determinant, out=found[:, 1], where=known)
    return found


def _form(second: Symmetric, x: FloatArray, y: FloatArray) -> FloatArray:
    a, b, c = second
    return a * x[:, 0] * y[:, 0] + b * (x[:, 0] * y[:, 1] + x[:, 1] * y[:, 0]) + c * x[:, 1] * y[:, 1]


def parameters_of(jet: Jet, vectors: FloatArray, away: FloatArray | None = None) -> FloatArray:
    """Return how parameters of feet move as points move by vectors, shape (K, 2); `away` from foot to point."""
    return _solved(metric(jet) if away is None else _hessian(jet, away), jet, vectors)
