"""What a blend needs of one base: the contact, seen from the blend, with all orientation already undone."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import reseamed
from semispline.solver.blending.cures import Cure
from semispline.solver.blending.end_faces import HeldEnd
from semispline.solver.blending.layout import check_knots_apart
from semispline.solver.errors import EdgeError
from semispline.solver.generated import contact_numpy, rows_numpy, shape_numpy
from semispline.solver.judge import Base, Correspondence
from semispline.solver.options import ROWS_PER_SIDE, Continuity
from semispline.solver.splines import (
    Basis,
    BSplineSurface,
    affine_knots,
    basis_matrix,
    combined,
    derivative_points,
    elevated_knots,
    elevation_matrix,
    euclidean,
    reversed_knots,
    same_width,
)

# Across a span beside the edge below this fraction of the base, derivatives are made of rounding.
_LEAST_SPAN = 1e-10


@dataclass(frozen=True, eq=False)
class Side:
    """The contact of the blend with one base, which the blend leaves backwards.

    Attributes
    ----------
    continuity : {"C0", "C1", "C2", "G0", "G1", "G2", "G3", "G4"}
    degree : int
        Degree of the base across the edge.
    spans : tuple of float
        Distances w_(degree+1) - w_s, w_(degree+2) - w_s, .. from the edge, in the base's own parameter: as many as the
        order of contact, two at least.
    along : Basis
        Degree and knots along the edge, in the parameter v of the blend.
    rows : ndarray, shape (order + 1 or 3, n, 3 or 4)
        Control rows from the edge inwards; a base with fewer rows repeats its last one, which contact does not read.
        Where one of the bases is rational they have four columns, (om x, om y, om z, om).
    largest : float
        Largest coordinate of the rows as they were given, in today's units: their rounding goes with it.
    keeps_lines : bool
        Lines at which rows are only continuous are left as they are: the other side has the same, or they are cured.
    cure : Cure or None
        What was done to them, if it was done before.
    held : tuple of HeldEnd
        Planes in which all rows of the blend are to end.
    """

    continuity: Continuity
    degree: int
    spans: tuple[float, ...]
    along: Basis
    rows: FloatArray
    largest: float
    keeps_lines: bool = False
    cure: Cure | None = None
    held: tuple[HeldEnd, ...] = ()

    @property
    def is_rational(self) -> bool:
        """Whether the rows are homogeneous."""
        return bool(self.rows.shape[2] == 4)

    @property
    def order(self) -> int:
        """Order of contact: how many derivatives agree."""
        return int(self.continuity[1])

    @property
    def has_shape_parameter(self) -> bool:
        """Whether a = alpha^2 is free: geometric contact beyond position."""
        return self.continuity[0] == "G" and self.order > 0

    @property
    def count(self) -> int:
        """Number of rows of the blend that are the side's own."""
        return max(ROWS_PER_SIDE, self.order + 1)

    def contact_rows(self, a: float, blend_degree: int, blend_spans: tuple[float, ...], p2: float = 0.0) -> FloatArray:
        """Return the rows P_0 .. P_order of the blend that the contact prescribes, shape (order + 1, n, 3).

        Source: generated from `semispline.derivations.contact`.
        """
        p, q, n = blend_degree, self.degree, self.order
        if n == 0:
            return self.rows[:1]
        matrix = getattr(contact_numpy, f"contact_rows_{n}")(a, p, *blend_spans[:n], q, *self.spans[:n])
        rows = np.asarray(np.einsum("ij,jnd->ind", matrix, self.rows[: n + 1]))
        if p2:
            exponents, monomials = self.monomial_rows(blend_degree, blend_spans)
            factors = [a**i * p2**j if j else 0.0 for i, j in exponents.tolist()]
            rows += np.tensordot(factors, monomials, 1)
        return rows

    def row_powers(self, centre: float, blend_degree: int, blend_spans: tuple[float, ...]) -> FloatArray:
        """Return the prescribed rows as a polynomial in a - centre, shape (order + 1 powers, order + 1, n, 3).

        Only where contact is geometric, order 1 or 2. Source: generated from `semispline.derivations.shape`.
        """
        p, q, order = blend_degree, self.degree, self.order
        if order == 1:
            matrix = shape_numpy.contact_row_powers_1(centre, p, blend_spans[0], q, self.spans[0])
        else:
            matrix = shape_numpy.contact_row_powers_2(
                centre, p, blend_spans[0], blend_spans[1], q, self.spans[0], self.spans[1]
            )
        powers = matrix.reshape(order + 1, order + 1, order + 1)
        return np.asarray(np.einsum("kij,jnd->kind", powers, self.rows[: order + 1]))

    def monomial_rows(self, blend_degree: int, blend_spans: tuple[float, ...]) -> tuple[FloatArray, FloatArray]:
        """Return the prescribed rows as a sum over monomials a^i p2^j, 1 first.

        Returns
        -------
        exponents : ndarray, shape (M, 2)
        rows : ndarray, shape (M, order + 1, n, 3 or 4)

        Source: generated from `semispline.derivations.contact`.
        """
        n = self.order
        if n == 0:
            return np.zeros((1, 2)), self.rows[None, :1]
        spans, base_spans = blend_spans[:n], self.spans[:n]
        exponents = getattr(rows_numpy, f"chain_monomials_{n}")()
        tables = getattr(rows_numpy, f"chain_table_{n}")().reshape(-1, n + 1, n + 1)
        weights = getattr(rows_numpy, f"rows_from_derivatives_{n}")(blend_degree, *spans)
        derivatives = getattr(contact_numpy, f"end_derivatives_{n}")(self.degree, *base_spans)
        rows = np.einsum("ik,mkd,dj,jnc->minc", weights, tables, derivatives, self.rows[: n + 1])
        return exponents, np.asarray(rows)

    def edge(self, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return points of the contact curve, and derivatives across times spans[0] / degree, each of shape (K, 3)."""
        values = basis_matrix(self.along.degree, self.along.knots, v)
        point, inwards = values @ self.rows[0], values @ (self.rows[1] - self.rows[0])
        return euclidean(point)[0], _first_derivative(point, inwards)

    def tangents(self, v: FloatArray) -> FloatArray:
        """Return derivatives of the contact curve along it, shape (K, 3)."""
        degree, knots = self.along.degree, self.along.knots
        slope = basis_matrix(degree - 1, knots[1:-1], v) @ derivative_points(degree, knots, self.rows[0])
        return _first_derivative(basis_matrix(degree, knots, v) @ self.rows[0], np.asarray(slope))

    def moved(self, centre: FloatArray, size: float) -> Side:
        """Return the same side in coordinates (x - centre) / size."""
        if not self.is_rational:
            return replace(self, rows=(self.rows - centre) / size, largest=self.largest / size)
        points, weights = self.rows[..., :3], self.rows[..., 3:]
        rows = np.concatenate([(points - weights * centre) / size, weights], axis=2)
        return replace(self, rows=rows, largest=self.largest / size)

    def points(self) -> FloatArray:
        """Return the points that contact reads, shape (K, 3); of a rational side those of the edge."""
        return euclidean(self.rows[0])[0] if self.is_rational else self.rows.reshape(-1, 3)


def make_side(base: Base, continuity: Continuity, name: str = "base") -> Side:
    """Read the contact of `base`, in the base's own parameter along its edge; messages call it `name`.

    Raises
    ------
    EdgeError
        The base is semi-structured, has too many knots along the edge that count as one, or next to no
        span beside an edge where derivatives are asked for.
    """
    surface = base.surface
    if not isinstance(surface, BSplineSurface):
        raise EdgeError(f"{name}: a semi-structured surface, expected a B-spline surface; convert it with to_bspline()")
    # Equal weights cancel.
    net = surface.control_points if _has_equal_weights(surface) else surface.homogeneous
    across, along = (surface.degree_u, surface.knots_u), (surface.degree_v, surface.knots_v)
    if base.side[0] == "v":
        net, across, along = net.transpose(1, 0, 2), along, across
    check_knots_apart(along[1], along[0], f"{name}: knots_{'v' if base.side[0] == 'u' else 'u'}", EdgeError)
    degree, knots = across
    if base.side[1] == "1":
        net, steps = net[::-1], knots[-1] - knots[::-1]
    else:
        steps = knots - knots[0]
    order = int(continuity[1])
    rows = net[[min(i, len(net) - 1) for i in range(max(ROWS_PER_SIDE, order + 1))]]
    spans = tuple(float(steps[min(degree + i, len(steps) - 1)]) for i in range(1, max(2, order) + 1))
    # So do those that are equal to this order.
    if rows.shape[2] == 4 and np.ptp(rows[: max(order, 1) + 1, :, 3]) == 0:
        rows = rows[..., :3] / rows[0, 0, 3]
    side = Side(continuity, degree, spans, Basis(*along), rows, float(np.abs(euclidean(rows)[0]).max()))
    if side.order > 0 and spans[0] < _LEAST_SPAN * steps[-1]:
        raise EdgeError(
            f"{name}: knots_{base.side[0]} leave a span of {spans[0]:.1e} beside the edge, expected at least "
            f"{_LEAST_SPAN:g} of the domain, or derivatives are made of rounding; remove these knots or take them "
            "further apart, or ask for position only"
        )
    return side


def _has_equal_weights(surface: BSplineSurface) -> bool:
    return surface.weights is None or bool(np.ptp(surface.weights) == 0)


def matched_sides(a: Side, b: Side, matched: Correspondence) -> tuple[Side, Side]:
    """Bring both sides to one parameter v, that of a; all exact up to rounding.

    Side b is re-seamed and turned round as `matched` says. Where one of them is rational both have four columns.
    """
    if a.is_rational or b.is_rational:
        a, b = (replace(side, rows=rows) for side, rows in zip((a, b), same_width(a.rows, b.rows), strict=True))
    along, rows = b.along, b.rows
    if matched.shift:
        along, rows = reseamed(along, rows, matched.shift, b.largest)
    knots = along.knots
    if matched.flipped:
        rows, knots = rows[:, ::-1], reversed_knots(knots)
    knots = affine_knots(knots, float(a.along.knots[0]), float(a.along.knots[-1]))
    return a, replace(b, along=Basis(along.degree, knots), rows=rows)


def of_one_degree(a: Side, b: Side) -> tuple[Side, Side]:
    """Return both sides with the higher of their degrees along the contact; exact up to rounding."""
    degree = max(a.along.degree, b.along.degree)
    return _elevated(a, degree), _elevated(b, degree)


def _elevated(side: Side, degree: int) -> Side:
    own, knots = side.along.degree, side.along.knots
    if own == degree:
        return side
    matrix = elevation_matrix(own, knots, degree)
    rows = np.stack([combined(matrix, row) for row in side.rows])
    return replace(side, along=Basis(degree, elevated_knots(knots, degree - own)), rows=rows)


def _first_derivative(point: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the derivative of the quotient: (X' - W' X / W) / W."""
    position, weight = euclidean(point)
    return slope if weight is None else np.asarray((slope[:, :3] - slope[:, 3:] * position) / weight[:, None])
