"""What joined pieces of a chain are: what runs through each, and what was found at the joints."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_pieces import Piece
from semispline.solver.blending.reparametrisation import bernstein

# What is left of a condition, relative to what it compares, where it counts as met.
CLOSED = 1e-8
# Curvatures at both sides that differ by this, over the larger one, jump.
BENT = 1e-6
# Of the size of coefficients: changes along a piece below it are none.
_NO_CHANGE = 1e-12
LAMBDA, W, Q = range(3)


@dataclass(frozen=True, eq=False)
class Coefficients:
    """lambda, w and q along a piece: cubic in v.

    But for q on a piece with inner knots: it brings in derivatives of R along v, which are less smooth there. It fades
    out to third order within the first and the last span.

    Attributes
    ----------
    values, slopes : ndarray, shape (2, 3, order + 1)
        At the start and the end; of lambda, w and q; by order in u.
    first, last : float
        Where the first span ends and the last one begins, the piece being [0, 1].
    """

    values: FloatArray
    slopes: FloatArray
    first: float
    last: float

    def at(self, low: float, high: float, t: FloatArray) -> FloatArray:
        """Return them at places t in [0, 1] of the span from `low` to `high`, shape (3, order + 1, T)."""
        places = low + (high - low) * t
        found = np.asarray(np.tensordot(self.bezier, bernstein(3, places), axes=(0, 1)))
        if self.first < 1:
            found[Q] = self._fading(0, places / self.first, self.first) if high <= self.first else 0.0
            if low >= self.last:
                found[Q] = self._fading(1, (1 - places) / (1 - self.last), self.last - 1)
        return found

    def _fading(self, end: int, s: FloatArray, span: float) -> FloatArray:
        value, slope = self.values[end, Q, :, None], self.slopes[end, Q, :, None]
        return np.asarray((1 - s) ** 3 * (value + (slope * span + 3 * value) * s))

    @property
    def bezier(self) -> FloatArray:
        """Their Bezier points, shape (4, 3, order + 1)."""
        (one, other), (rise, fall) = self.values, self.slopes
        return np.stack([one, one + rise / 3, other - fall / 3, other])

    @property
    def degrees(self) -> FloatArray:
        """Degrees in v, shape (3, order + 1); -inf for zero."""
        (one, other), (rise, fall) = self.values, self.slopes
        size = np.maximum(np.abs(self.values).max(axis=0), np.abs(self.slopes).max(axis=0))
        within = _NO_CHANGE * size
        change = other - one
        cubic = np.abs(rise + fall - 2 * change) > within
        quadratic = np.abs(rise - change) > within
        linear = np.abs(change) > within
        found = np.where(cubic, 3.0, np.where(quadratic, 2.0, np.where(linear, 1.0, 0.0)))
        found = np.where(size > 0, found, -np.inf)
        if self.first < 1:
            found[Q] = np.where(size[Q] > 0, 4.0, -np.inf)
        return found


@dataclass(frozen=True, eq=False)
class Joint:
    """Where two faces of a chain meet.

    Attributes
    ----------
    point : (float, float, float)
    kind : {"smooth", "creased", "corner"}
        "smooth": the strip is C1 there. "creased": the faces themselves are. "corner": the contact turns.
    turn_degrees : float
        Between the tangents of the contact.
    crease_degrees : float
        Between the tangent planes of the faces.
    residuals : tuple of float
        Of the derivatives along v, by order in u: what is left, relative to what they compare.
    moved : float
        How far apart the edges end, beyond rounding; each was moved by half of it.
    curvatures : (float, float)
        Of the contact, before and after.
    apart : float
        By how much derivatives across differ, relative to themselves, that nothing makes agree: the faces meet within a
        tolerance. The strip takes their mean.
    """

    point: tuple[float, float, float]
    kind: str
    turn_degrees: float
    crease_degrees: float
    residuals: tuple[float, ...]
    moved: float
    curvatures: tuple[float, float]
    apart: float = 0.0

    @property
    def is_exact(self) -> bool:
        """Whether the faces meet to rounding."""
        return self.moved == 0 and self.apart <= CLOSED

    def moved_by(self, offset: FloatArray) -> Joint:
        """Return the joint in other coordinates."""
        x, y, z = (np.array(self.point) + offset).tolist()
        return replace(self, point=(x, y, z))

    @property
    def bends(self) -> bool:
        """Whether the contact's own curvature jumps."""
        return bool(abs(self.curvatures[1] - self.curvatures[0]) > BENT * max(self.curvatures))


@dataclass(frozen=True, eq=False)
class JoinedPieces:
    """Pieces, the spans that each gets, what runs through each, and what is found at the joints.

    Joint k is where piece k begins; of an open chain there is no joint 0.

    Attributes
    ----------
    pieces : tuple of Piece
    spans : ndarray, shape (K,)
    coefficients : tuple of Coefficients
    joints : tuple of Joint or None
    continuity : tuple of int
        Along, at each joint, of what comes out.
    """

    pieces: tuple[Piece, ...]
    spans: FloatArray
    coefficients: tuple[Coefficients, ...]
    joints: tuple[Joint | None, ...]
    continuity: tuple[int, ...]
