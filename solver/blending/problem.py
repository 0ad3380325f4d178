"""The blend as a minimisation: energy, prescribed rows, free rows, admissible shape parameters."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import periodic_points, seam_order, with_least_size
from semispline.solver.blending.exits import Exits, measure_exits
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.layout import ROWS_PER_SIDE, blend_u_basis, middle_bases
from semispline.solver.blending.sides import Side
from semispline.solver.blending.smooth_rows import SmoothRows, smooth_rows
from semispline.solver.errors import ComputationError, EdgeError
from semispline.solver.options import BlendOptions, Shape
from semispline.solver.splines import (
    Basis,
    affine_knots,
    basis_matrix,
    breakpoints,
    derivative_points,
    gauss_rule,
    greville,
    merge_breakpoints,
)

# A correction by this fraction is rounding; a larger one asks for refinement, and at the end must be below the second.
ROUNDING_CORRECTION = 1e-12
TRUSTED_CORRECTION = 1e-8
_MOST_REFINEMENTS = 20
# Admissible alpha^2: for least energy in units of its natural size; for the fairest shape in units of an arc's, wider
# where exits and chords disagree (a U-turn).
ENERGY_BOX, WINDOW, WIDE_WINDOW = (1 / 8, 8.0), (1 / 4, 4.0), (1 / 4, 16.0)
# Lengths below this fraction of the model count as zero.
VANISHING = 1e-10
# Means over v: points of the whole contact, and degree of the rule on each span where spans are many.
_MOST_POINTS = 512
_LEAST_RULE = 3


@dataclass(frozen=True, eq=False)
class BlendProblem:
    """A blend to be found, in coordinates of size 1 around the origin.

    Attributes
    ----------
    form : EnergyForm
        U and V_i of the m + 1 rows, the v-domain scaled to the length that the energy takes it for.
    rows : tuple of Basis, length m + 1
        V_i on the v-domain of the blend itself.
    a, b : Side
        Contact at u = 0 and u = 1.
    natural : (float, float)
        Natural sizes of alpha^2 and beta^2: mean gap between the contact curves over mean cross speed of the base.
    bounds : pair of (float, float)
        Boxes of alpha^2 and beta^2; low = high where the parameter is fixed.
    seam_order : int
        How many derivatives both bases keep across the seam of closed contact curves; -1 where these are open.
    exits : Exits
    """

    form: EnergyForm
    rows: tuple[Basis, ...]
    a: Side
    b: Side
    natural: tuple[float, float]
    bounds: tuple[tuple[float, float], tuple[float, float]]
    seam_order: int
    exits: Exits

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether alpha^2 and beta^2 are unknowns."""
        (low_a, high_a), (low_b, high_b) = self.bounds
        return low_a < high_a, low_b < high_b

    @property
    def start(self) -> tuple[float, float]:
        """Natural alpha^2 and beta^2, or the nearest admissible ones."""
        a, b = (min(max(n, low), high) for n, (low, high) in zip(self.natural, self.bounds, strict=True))
        return a, b

    @property
    def contacts(self) -> tuple[tuple[Side, range, tuple[float, float]], ...]:
        """For each contact the side, the rows counted from it, and the distances of the two nearest knots of U."""
        U, p = self.form.u.knots, self.form.u.degree
        from_end = U[-1] - U[::-1]
        m = len(self.form.rows) - 1
        return (
            (self.a, range(m + 1), (float(U[p + 1]), float(U[p + 2]))),
            (self.b, range(m, -1, -1), (float(from_end[p + 1]), float(from_end[p + 2]))),
        )

    @property
    def free_rows(self) -> range:
        """Indices of the rows that no contact prescribes."""
        return range(self.a.order + 1, len(self.rows) - self.b.order - 1)

    def seam_order_of(self, row: int) -> int:
        """How many derivatives a free row keeps across the seam, if it has control points for as many.

        A middle curve is as smooth there as at its other knots: the blend does not show where the seam is.
        """
        if self.seam_order < 0:
            return -1
        basis = self.form.rows[row]
        middle = ROWS_PER_SIDE <= row < len(self.rows) - ROWS_PER_SIDE
        return min(basis.degree - 1 if middle else self.seam_order, basis.size // 2 - 1)

    @cached_property
    def free_system(self) -> FreeSystem:
        """What has to be solved for the free rows."""
        return FreeSystem(self.form, self.free_rows, [self.seam_order_of(i) for i in self.free_rows])

    def control_points(self, a: float, b: float, p2: tuple[float, float] = (0.0, 0.0)) -> FloatArray:
        """Return p for alpha^2, beta^2 and p2, shape (N, 3): one linear solve for the free rows, of least energy."""
        points = np.zeros((self.form.offsets[-1], 3))
        for (side, rows, spans), value, second in zip(self.contacts, (a, b), p2, strict=True):
            prescribed_rows = side.contact_rows(value, self.form.u.degree, spans, second)
            for row, prescribed in zip(rows, prescribed_rows, strict=False):
                points[self.form.offsets[row] : self.form.offsets[row + 1]] = prescribed
        return self.completed(points)

    def shape_layers(self) -> tuple[FloatArray, list[FloatArray]]:
        """Return Z_k of P = sum_k m_k Z_k, shape (K, N, 3), with alpha^2 and p2 in units of their natural sizes.

        The monomials are 1, then those of side a without 1, then those of side b; their exponents come with them.
        """
        offsets, degree = self.form.offsets, self.form.u.degree
        layers = [np.zeros((offsets[-1], 3))]
        exponents = []
        for (side, rows, spans), unit, is_free, fixed in zip(
            self.contacts, self.natural, self.free, self.start, strict=True
        ):
            powers, monomials = side.monomial_rows(degree, spans)
            if not is_free:
                powers, monomials = np.zeros((1, 2)), side.contact_rows(fixed, degree, spans)[None]
            exponents.append(powers)
            for k, (power, monomial) in enumerate(zip(powers, monomials, strict=True)):
                if k:
                    layers.append(np.zeros((offsets[-1], 3)))
                for row, values in zip(rows, monomial, strict=False):
                    layers[0 if k == 0 else -1][offsets[row] : offsets[row + 1]] = values * unit ** power.sum()
        completed = self.completed(np.concatenate(layers, axis=1))
        return np.stack(np.split(completed, len(layers), axis=1)), exponents

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), so that the energy is least.

        Raises
        ------
        ComputationError
            The stationarity system is singular or too ill-conditioned to be trusted.
        """
        return self.free_system.completed(points)


class FreeSystem:
    """The stationarity system of the free rows, factorised once.

    Free control points are Z y: Z is the identity, but for closed rows that are to be smooth across their seam.

    Attributes
    ----------
    size : int
        Number of free control points; where it is 0 there is nothing else.
    free : slice
        Their place in p.
    blocks : dict of sparse matrices
        Those of H that couple free rows i with any row j.
    z : sparse matrix or None
        None is the identity.
    order : ndarray of int
        Sorts y along v.
    matrix : sparse matrix
        The system for the sorted y: symmetric, positive definite, banded.
    smooth : SmoothRows or None
        What knots close together hide from the system; None where there are none.
    """

    def __init__(self, form: EnergyForm, rows: range, seam_orders: list[int]) -> None:
        self.form = form
        self.rows = rows
        self.offsets = form.offsets
        self.free = slice(form.offsets[rows.start], form.offsets[rows.stop])
        self.size = self.free.stop - self.free.start
        if self.size == 0:
            return
        self.blocks = form.blocks(rows)
        matrix = form.assembled(self.blocks, rows)
        self.z = None
        along = [greville(form.rows[i].knots, form.rows[i].degree) for i in rows]
        if max(seam_orders) >= 0:
            self.z = sp.block_diag(
                [periodic_points(form.rows[i], order) for i, order in zip(rows, seam_orders, strict=True)], format="csr"
            )
            along = [x[: len(x) - order - 1] for x, order in zip(along, seam_orders, strict=True)]
            matrix = self.z.T @ matrix @ self.z
        self.smooth: SmoothRows | None = smooth_rows(form, rows, seam_orders)
        # Sorting by the place along v, rows side by side, makes the matrix banded; row by row where rows are many.
        places = np.concatenate(along)
        self.order = np.argsort(places, kind="stable") if len(rows) ** 2 <= len(places) else np.arange(len(places))
        self.matrix = matrix[self.order][:, self.order].tocsc()
        try:
            self.factor = splu(
                self.matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except RuntimeError:
            raise ComputationError(
                "the stationarity system is singular; try fewer middle curves or knots that are not so close"
            ) from None

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), so that the energy is least."""
        if self.size == 0:
            return points
        right = self._right(points)
        x = self.factor.solve(right)
        correction = self.factor.solve(right - self.matrix @ x)
        x += correction
        left = _fraction(correction, x)
        if left > ROUNDING_CORRECTION:
            x, left = self._refined(x, points)
        if self.smooth is not None:
            filled, left = self._smoothed(self._with_free(points, x), left, self.smooth)
        else:
            filled = self._with_free(points, x)
        # The last correction shows how many digits there are.
        if not left <= TRUSTED_CORRECTION:
            raise ComputationError(
                f"the stationarity system of {self.size} unknowns is too ill-conditioned to be trusted; try v_scale "
                "unit or length, knots that are not so close, fewer control points, or a parameter v that grows with "
                "their number"
            )
        return filled

    def solved_at_once(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), by one solve without refinement, as exported code does."""
        return points if self.size == 0 else self._with_free(points, self.factor.solve(self._right(points)))

    def _right(self, points: FloatArray) -> FloatArray:
        """Return the right side for the sorted y, shape (size of y, d)."""
        # What the prescribed rows do to the gradient of the energy.
        right = np.zeros((self.offsets[-1], points.shape[1]))
        for (i, j), block in self.blocks.items():
            if j not in self.rows:
                right[self._part(i)] -= block @ points[self._part(j)]
        right = right[self.free]
        return np.asarray((right if self.z is None else self.z.T @ right)[self.order])

    def _refined(self, x: FloatArray, points: FloatArray) -> tuple[FloatArray, float]:
        """Refine with the gradient taken from second derivatives, which H x loses by cancellation.

        Source: corrected seminormal equations; A. Bjorck, Numerical Methods for Least Squares Problems, 1996, ch. 6.
        """
        before = np.inf
        for _ in range(_MOST_REFINEMENTS):
            correction = self._correction(self.form.gradient(self._with_free(points, x)))
            x = x - correction
            change = _fraction(correction, x)
            if change <= ROUNDING_CORRECTION or change >= before / 2:
                break
            before = change
        return x, change

    def _smoothed(self, points: FloatArray, left: float, smooth: SmoothRows) -> tuple[FloatArray, float]:
        """Refine p by steps of the whole system and of the smooth rows in turn, where the latter show the need.

        Returns
        -------
        points : ndarray, shape (N, d)
        left : float
            The last correction of either kind as a fraction; or of the energy, where rounding moves points but not it.
        """
        step, _ = smooth.correction(self.form.gradient(points)[self.free])
        if left <= TRUSTED_CORRECTION and _fraction(step, points) <= TRUSTED_CORRECTION:
            return points, left
        before, points = np.inf, points.copy()
        # What is there may be nothing but rounding.
        points[self.free] = 0.0
        for _ in range(_MOST_REFINEMENTS):
            gradient = self.form.gradient(points)
            correction = self._correction(gradient)
            move = self._with_free(np.zeros_like(points), -correction)[self.free]
            saved = -float(np.sum(move * gradient[self.free]))
            points[self.free] += move
            gradient = self.form.gradient(points)
            step, lower = smooth.correction(gradient[self.free])
            points[self.free] += step
            change = max(_fraction(move, points), _fraction(step, points))
            if change <= ROUNDING_CORRECTION or change >= before / 2:
                break
            before = change
        layers = np.stack(np.split(points, points.shape[1] // 3, axis=1))
        energy = float(np.trace(self.form.products(layers)))
        return points, min(change, max(abs(saved), abs(lower)) / max(energy, 1e-300))

    def _correction(self, gradient: FloatArray) -> FloatArray:
        """Return the change of the sorted y that a gradient, shape (N, d), asks for."""
        gradient = gradient[self.free]
        return np.asarray(self.factor.solve((gradient if self.z is None else self.z.T @ gradient)[self.order]))

    def _with_free(self, points: FloatArray, x: FloatArray) -> FloatArray:
        free = np.empty(x.shape)
        free[self.order] = x
        filled = points.copy()
        filled[self.free] = free if self.z is None else self.z @ free
        return filled

    def _part(self, row: int) -> slice:
        return slice(self.offsets[row], self.offsets[row + 1])


def _fraction(change: FloatArray, x: FloatArray) -> float:
    return float(np.abs(change).max()) / max(float(np.abs(x).max()), 1e-300)


def make_problem(a: Side, b: Side, options: BlendOptions) -> BlendProblem:
    """Lay out the knots of the blend and its admissible shape parameters.

    Raises
    ------
    OptionError
        A number of middle curves or a degree out of range.
    EdgeError
        The contact curves coincide, one of them is a point, or a cross derivative that contact needs vanishes.
    """
    u = blend_u_basis(options.degree_u, options.middle_curves, options.u_knots)
    orders = [seam_order(side.along, side.rows[: side.order + 1], side.largest) for side in (a, b)]
    closed = min(orders)
    middle = middle_bases(a.along, b.along, options.middle_curves, options.middle_knots, closed=closed >= 0)
    if closed >= 0 and options.middle_knots is None:
        middle = [with_least_size(basis, 2 * basis.degree) for basis in middle]
    rows = ((a.along,) * ROWS_PER_SIDE) + tuple(middle) + ((b.along,) * ROWS_PER_SIDE)
    means = _means(a, b)
    natural_a, natural_b = (
        means.gap / speed if _checked_speed(side, speed, name) else 1.0
        for name, side, speed in zip("ab", (a, b), means.cross_speeds, strict=True)
    )
    exits = measure_exits(a, b)
    bounds_a, bounds_b = (
        (1.0, 1.0) if not side.has_shape_parameter else _bounds(size, alpha, options.box, exits)
        for side, size, alpha in zip((a, b), (natural_a, natural_b), options.alphas, strict=True)
    )
    form = EnergyForm(u, rows)
    if options.v_scale != "paper":
        length = 1.0 if options.v_scale == "unit" else sum(means.lengths) / 2 / means.gap
        form = EnergyForm(u, tuple(Basis(row.degree, affine_knots(row.knots, 0.0, length)) for row in rows))
    return BlendProblem(form, rows, a, b, (natural_a, natural_b), (bounds_a, bounds_b), closed, exits)


def _bounds(natural: float, alpha: Shape, box: tuple[float, float] | None, exits: Exits) -> tuple[float, float]:
    """Return the admissible ends of alpha^2; they are equal where it is given."""
    if alpha == "energy":
        low, high = box or ENERGY_BOX
        return natural * low, natural * high
    if alpha == "fair":
        low, high = box or (WIDE_WINDOW if exits.u_turn else WINDOW)
        return natural * exits.arc * low, natural * exits.arc * high
    fixed = natural if alpha == "natural" else float(alpha) ** 2
    return fixed, fixed


@dataclass(frozen=True)
class _Means:
    """Means over v of two contacts that face each other, in coordinates of size 1."""

    gap: float
    lengths: tuple[float, float]
    cross_speeds: tuple[float, float]


def _means(a: Side, b: Side) -> _Means:
    """Measure by quadrature over the spans of both sides: neither where the seam is nor their order matters.

    Raises
    ------
    EdgeError
        A contact curve has zero length, or both coincide.
    """
    breaks = merge_breakpoints(breakpoints(a.along.knots), breakpoints(b.along.knots))
    nodes, weights = gauss_rule(breaks, max(_LEAST_RULE, _MOST_POINTS // len(breaks)))
    x, weights = nodes.ravel(), weights.ravel()
    domain = float(breaks[-1] - breaks[0])
    curves, lengths, speeds = [], [], []
    for name, side in (("a", a), ("b", b)):
        degree, knots = side.along.degree, side.along.knots
        values = basis_matrix(degree, knots, x)
        along = basis_matrix(degree - 1, knots[1:-1], x) @ derivative_points(degree, knots, side.rows[0])
        across = values @ (side.rows[1] - side.rows[0]) * (side.degree / side.spans[0])
        curves.append(values @ side.rows[0])
        lengths.append(float(weights @ np.linalg.norm(along, axis=1)))
        speeds.append(float(weights @ np.linalg.norm(across, axis=1)) / domain)
        if lengths[-1] < VANISHING:
            raise EdgeError(f"base {name}: the contact curve has zero length; choose another edge")
    if _coincide(a, b):
        raise EdgeError("bases: the contact curves coincide, there is nothing to blend; choose another edge")
    gap = float(weights @ np.linalg.norm(curves[0] - curves[1], axis=1)) / domain
    return _Means(gap, (lengths[0], lengths[1]), (speeds[0], speeds[1]))


def _coincide(a: Side, b: Side) -> bool:
    start, end = a.along.knots[0], a.along.knots[-1]
    x = start + (end - start) * np.arange(129) / 128
    curves = [basis_matrix(side.along.degree, side.along.knots, x) @ side.rows[0] for side in (a, b)]
    return _largest_distance(curves[0], curves[1], b) < VANISHING


def _largest_distance(points: FloatArray, samples: FloatArray, side: Side) -> float:
    """Return how far a point is at most from the contact curve of a side, whatever the curve's parametrisation.

    From the nearest sample on, Gauss-Newton on the parameter finds the foot; far curves need no more than samples.
    """
    degree, knots = side.along.degree, side.along.knots
    distances = np.linalg.norm(points[:, None] - samples, axis=2)
    if distances.min(axis=1).max() > np.linalg.norm(np.diff(samples, axis=0), axis=1).max():
        return float(distances.min(axis=1).max())
    x = knots[0] + (knots[-1] - knots[0]) * distances.argmin(axis=1) / (len(samples) - 1)
    slopes = derivative_points(degree, knots, side.rows[0])
    for _ in range(8):
        off = basis_matrix(degree, knots, x) @ side.rows[0] - points
        slope = basis_matrix(degree - 1, knots[1:-1], x) @ slopes
        squared = np.maximum(np.sum(slope**2, axis=1), np.finfo(float).tiny)
        x = np.clip(x - np.sum(off * slope, axis=1) / squared, knots[0], knots[-1])
    return float(np.linalg.norm(basis_matrix(degree, knots, x) @ side.rows[0] - points, axis=1).max())


def _checked_speed(side: Side, speed: float, name: str) -> float:
    """Return the mean speed across the contact, refused where contact needs it and it vanishes."""
    if side.order > 0 and speed * side.spans[0] < VANISHING:
        raise EdgeError(f"base {name}: the cross derivative vanishes along the contact curve; choose another edge")
    return speed
