"""The faces of a chain as pieces: derivatives across along each, in a form that joins well."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.jumps import sped_up
from semispline.solver.blending.reparametrisation import bezier_derivatives
from semispline.solver.blending.sides import make_side
from semispline.solver.blending.spans import bezier_pieces
from semispline.solver.blending.weights import SEPARABLE, end_derivatives, spline_mean
from semispline.solver.judge import Base
from semispline.solver.splines import Basis, affine_knots, greville, inner_knots, reversed_knots, same_width

# A piece is straight along where all derivatives across are linear in v to this, relative to each.
_STRAIGHT = 1e-12
# In units of the spacing of floats, of each control point.
_ROUNDINGS = 4
_LINE = np.array([0.0, 0.0, 1.0, 1.0])
_ENDS = np.array([0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Piece:
    """A stretch of a chain on one face: R and its derivatives by w along the contact, over [0, 1].

    Attributes
    ----------
    edge : int
        Of which edge of the chain.
    range : (float, float)
        Of the face's own parameter along; from the larger to the smaller one where the chain runs against it.
    jets : ndarray, shape (order + 1, n, 3 or 4)
    along : Basis
    degrees : tuple of int
        Of each derivative along v; -1 where it is zero.
    rounding : ndarray, shape (order + 1,)
        What rounding of the control points may make of each derivative.
    width : float
        Of the face across, in its own parameter.
    """

    edge: int
    range: tuple[float, float]
    jets: FloatArray
    along: Basis
    degrees: tuple[int, ...]
    rounding: FloatArray
    width: float

    @property
    def is_straight(self) -> bool:
        """Whether all derivatives are linear in v."""
        return max(self.degrees) <= 1

    @property
    def order(self) -> int:
        """Up to which order the derivatives go."""
        return len(self.jets) - 1

    def at_ends(self) -> FloatArray:
        """Return derivatives by w and v at the start and at the end, shape (order + 1, order + 2, 2, d)."""
        breaks, pieces = bezier_pieces(self.jets, self.along)
        first, last = (
            bezier_derivatives(pieces[k], float(breaks[k + 1] - breaks[k]), _ENDS, self.order + 1)
            for k in (0, len(pieces) - 1)
        )
        return np.stack([first[:, :, 0], last[:, :, 1]], axis=2)

    def rounding_of_slopes(self) -> FloatArray:
        """Return what rounding may make of derivatives along v at both ends, shape (2, order + 1)."""
        widths = np.diff(np.unique(self.along.knots))[[0, -1]]
        return np.asarray(self.rounding * 2 * self.along.degree / widths[:, None])

    def end_speeds(self) -> tuple[float, float]:
        """Return |dC/dv| of the contact itself at both ends."""
        ends = self.at_ends()[0]
        start, end = (float(np.linalg.norm(cartesian_slope(ends[0, k], ends[1, k]))) for k in (0, 1))
        return start, end


def cartesian_slope(point: FloatArray, slope: FloatArray) -> FloatArray:
    """Return the derivative of X / om from (X, om) and its derivative; of three columns the derivative itself."""
    if len(point) == 3:
        return slope
    return np.asarray((slope[:3] - slope[3] * point[:3] / point[3]) / point[3])


def read_pieces(bases: tuple[Base, ...], turned: tuple[bool, ...], order: int, origin: FloatArray) -> list[Piece]:
    """Return the pieces of edges that run end to end, cut where rows of a face are only continuous.

    Parameters
    ----------
    bases : tuple of Base
    turned : tuple of bool
        Which of them run against their own parameter.
    order : int
        Of contact, 1 at least.
    origin : ndarray, shape (3,)
        Points are counted from there.
    """
    continuity = f"G{order}"
    sides = [
        make_side(base, continuity, f"edge {k} of the chain").moved(origin, 1.0)  # type: ignore[arg-type]
        for k, base in enumerate(bases)
    ]
    if any(side.is_rational for side in sides):
        sides = [replace(side, rows=same_width(side.rows, np.ones((1, 1, 4)))[0]) for side in sides]
    found = []
    for k, (side, base, back) in enumerate(zip(sides, bases, turned, strict=True)):
        derivatives = end_derivatives(order, side.degree, side.spans)
        jets = np.einsum("dk,knc->dnc", derivatives, side.rows[: order + 1])
        rounding = _ROUNDINGS * np.finfo(float).eps * side.largest * np.abs(derivatives).sum(axis=1)
        low, high = base.surface.domain["uv".index(base.side[0])]
        width = high - low
        knots = side.along.knots
        if back:
            jets, knots = jets[:, ::-1], reversed_knots(knots)
        for piece, basis, ends in _split(jets, Basis(side.along.degree, knots)):
            own = tuple(float(base.range_along[0] + base.range_along[1] - x) if back else float(x) for x in ends)
            found.append(standard(Piece(k, own, piece, basis, (), rounding, width)))  # type: ignore[arg-type]
    return found


def _split(jets: FloatArray, along: Basis) -> list[tuple[FloatArray, Basis, tuple[float, float]]]:
    """Return the stretches between knots of full multiplicity, each over [0, 1], and their own ranges."""
    q = along.degree
    values, counts = np.unique(inner_knots(along.knots, q), return_counts=True)
    cuts = [float(along.knots[0]), *values[counts >= q].tolist(), float(along.knots[-1])]
    found = []
    for low, high in pairwise(cuts):
        first = int(np.searchsorted(along.knots, low, side="right")) - q - 1
        last = int(np.searchsorted(along.knots, high)) - 1
        inside = along.knots[(along.knots > low) & (along.knots < high)]
        knots = affine_knots(np.concatenate([[low] * (q + 1), inside, [high] * (q + 1)]), 0.0, 1.0)
        found.append((jets[:, first : last + 1], Basis(q, knots), (low, high)))
    return found


def standard(piece: Piece) -> Piece:
    """Return the piece with weights of means 1, 0, 0, .. across; and how high its degrees really are."""
    jets = piece.jets
    if jets.shape[2] == 4:
        jets = normalised_jets(jets, piece.along)
    places = greville(piece.along.knots, piece.along.degree)
    line = jets[:, :1] + (jets[:, -1:] - jets[:, :1]) * places[None, :, None]
    sizes = np.abs(jets).max(axis=(1, 2))
    within = _STRAIGHT * np.maximum(sizes, sizes[0])
    if (np.abs(jets - line).max(axis=(1, 2)) > within).any() or not _is_even(jets):
        return replace(piece, jets=jets, degrees=(piece.along.degree,) * len(jets))
    ends = jets[:, [0, -1]]
    ends[np.abs(ends).max(axis=(1, 2)) <= within] = 0.0
    is_constant = np.abs(ends[:, 1] - ends[:, 0]).max(axis=1) <= within
    ends[is_constant, 1] = ends[is_constant, 0]
    degrees = tuple(-1 if not row.any() else int(not same) for row, same in zip(ends, is_constant, strict=True))
    return replace(piece, jets=ends, along=Basis(1, _LINE), degrees=degrees)


def _is_even(jets: FloatArray) -> bool:
    return jets.shape[2] == 3 or bool(np.ptp(jets[..., 3], axis=1).max() <= SEPARABLE * np.abs(jets[0, :, 3]).max())


def with_equal_ends(piece: Piece) -> Piece:
    """Return the piece with equal weights at both ends, where a fractional linear map of v can do that.

    On splines with inner knots it would not be one map: these stay.
    """
    weights, q = piece.jets[0, :, -1], piece.along.degree
    if piece.jets.shape[2] == 3 or weights[0] == weights[-1] or len(weights) > q + 1:
        return piece
    mu = (weights[0] / weights[-1]) ** (1 / q)
    return replace(piece, jets=normalised_jets(piece.jets * (mu ** np.arange(q + 1))[:, None], piece.along))


def normalised_jets(jets: FloatArray, along: Basis) -> FloatArray:
    """Return the jets divided by the mean weight along, as a function of w."""
    means = spline_mean(along, jets[:, :, 3])
    inverse = np.zeros_like(means)
    inverse[0] = 1 / means[0]
    for k in range(1, len(means)):
        inverse[k] = -inverse[0] * sum(comb(k, j) * means[j] * inverse[k - j] for j in range(1, k + 1))
    return np.stack([sum(comb(k, j) * inverse[k - j] * jets[j] for j in range(k + 1)) for k in range(len(jets))])


def with_faster_end(piece: Piece, times: float) -> Piece:
    """Return the piece run through by a quadratic function of v, so that it ends `times` as fast as it begins."""
    rows, along = sped_up(piece.jets, piece.along, _ENDS, times)
    return replace(piece, jets=rows, along=along, degrees=tuple(2 * x if x > 0 else x for x in piece.degrees))
