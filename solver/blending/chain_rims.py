"""Rims whose joints answer each other one to one, as around a rounded edge: walls and a top face along lines and arcs.

Where both contacts run alike at a joint, square to one plane that holds both side edges and the way between them, rows
that are only continuous make a blend that is G1 there: its derivatives along v are along the common tangent on both
sides. Straight stretches of it are extruded, arcs are revolved, and nothing has to be cured.

Source: `semispline.derivations.chains`.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_coefficients import JoinedPieces
from semispline.solver.blending.chain_joints import end_slopes, end_values
from semispline.solver.blending.chain_runs import begun_at, run_back
from semispline.solver.blending.chains import Chain
from semispline.solver.blending.weights import SEPARABLE
from semispline.solver.options import BlendOptions

# What is square or parallel to this counts as that; a sine.
_SQUARE = 1e-9
_LEAST_ORDER = 2


def facing_rims(a: Chain, b: Chain, options: BlendOptions) -> tuple[Chain, Chain] | None:
    """Return both chains run through alike, where all their joints answer each other as above; else None.

    Free rows would not bend alike on both sides of a joint: there must be none.
    """
    if min(options.orders) < _LEAST_ORDER or options.middle_curves not in ("auto", 0) or options.match != "affine":
        return None
    if a.closed != b.closed or len(a.edges) != len(b.edges) or len(a.edges) < 2:
        return None
    starts = range(len(b.edges)) if b.closed else range(1)
    ways = [
        begun_at(one, k) if one.closed else one
        for turned, k in product((False, True), starts)
        if options.flip == "auto" or (options.flip == "yes") == turned
        for one in [run_back(b) if turned else b]
    ]
    wanted = _stations(a)
    nearest = min(ways, key=lambda way: float(np.sum((_stations(way) - wanted) ** 2)))
    if any(chain.is_steered(order) for chain, order in zip((a, nearest), options.orders, strict=True)):
        return None
    pair = [chain.rim_pieces(order) for chain, order in zip((a, nearest), options.orders, strict=True)]
    return (a, nearest) if _answer(pair[0], pair[1], nearest.origin - a.origin) else None


def _stations(chain: Chain) -> FloatArray:
    """Return where each edge begins, and where the last one ends."""
    ends = [base.derivative(np.array(base.range_along), 0, 0) for base in chain.edges]
    ways = [pair[::-1] if back else pair for pair, back in zip(ends, chain.turned, strict=True)]
    return np.array([*(way[0] for way in ways), ways[-1][1]])


def _answer(a: JoinedPieces, b: JoinedPieces, offset: FloatArray) -> bool:
    """Tell whether at each joint of both nothing but derivatives along one tangent jumps.

    `offset` leads from the origin of a to that of b.
    """
    if len(a.pieces) != len(b.pieces):
        return False
    if any(not _run_alike(one.jets, other.jets) for one, other in zip(a.pieces, b.pieces, strict=True)):
        return False
    joints = [k for k, joint in enumerate(a.joints) if joint is not None]
    return all(_answers(_at_joint(a, k), _at_joint(b, k), offset) for k in joints)


@dataclass(frozen=True, eq=False)
class _AtJoint:
    """A chain at a joint: its place and derivatives across, and their slopes along v before and after it."""

    values: FloatArray
    before: FloatArray
    after: FloatArray
    extent: float

    @property
    def tangent(self) -> FloatArray:
        return np.asarray(self.after[0] / np.linalg.norm(self.after[0]))

    @property
    def is_plain(self) -> bool:
        """Whether it leaves the contact square to it, and nothing but parts along it jump."""
        # What a face that bends as much as it is wide would have: below that all is rounding.
        expected = (float(np.linalg.norm(self.values[1])) / self.extent) ** np.arange(len(self.values))
        rows, speed = zip(self.values, expected, strict=True), float(np.linalg.norm(self.after[0]))
        square = all(_is_square(row, self.tangent, self.extent * size) for row, size in list(rows)[1:])
        jumps = zip(self.before - self.after, self.after, expected, strict=True)
        return square and all(_is_along(jump, self.tangent, one, speed * size) for jump, one, size in jumps)


def _answers(a: _AtJoint, b: _AtJoint, offset: FloatArray) -> bool:
    if not (a.is_plain and b.is_plain) or a.tangent @ b.tangent < 0:
        return False
    if np.linalg.norm(np.cross(a.tangent, b.tangent)) > _SQUARE:
        return False
    return _is_square(b.values[0] + offset - a.values[0], a.tangent, a.extent)


def _at_joint(joined: JoinedPieces, k: int) -> _AtJoint:
    sides = []
    for piece, end in ((k - 1, 1), (k, 0)):
        derivatives, by = joined.pieces[piece].at_ends()[:, :, end], joined.coefficients[piece].values[end]
        values, slopes = end_values(derivatives, by), end_slopes(derivatives, by, np.zeros_like(by))
        if values.shape[1] == 4:
            # The weight does not change across.
            weight, change = values[0, 3], slopes[0, 3]
            slopes = (slopes[:, :3] - change / weight * values[:, :3]) / weight
            values = values[:, :3] / weight
        sides.append((values, slopes / joined.spans[piece]))
    (values, before), (_, after) = sides
    extent = max(float(np.abs(piece.jets[0, :, :3]).max()) for piece in joined.pieces)
    return _AtJoint(values, before, after, extent)


def _run_alike(one: FloatArray, other: FloatArray) -> bool:
    """Tell whether both pieces have the same weights along, and none that change across."""
    if one.shape[2] == 3 or other.shape[2] == 3:
        return one.shape[2] == other.shape[2] == 3 or all(np.ptp(x[0, :, -1]) == 0 for x in (one, other))
    if one.shape[1] != other.shape[1]:
        return False
    shares = [x[0, :, 3] / x[0, 0, 3] for x in (one, other)]
    across = max(float(np.abs(x[1:, :, 3]).max()) for x in (one, other))
    return bool(np.abs(shares[0] - shares[1]).max() <= SEPARABLE and across <= SEPARABLE)


def _is_square(vector: FloatArray, tangent: FloatArray, size: float) -> bool:
    return bool(abs(vector @ tangent) <= _SQUARE * max(float(np.linalg.norm(vector)), size))


def _is_along(jump: FloatArray, tangent: FloatArray, beside: FloatArray, size: float) -> bool:
    rest = float(np.linalg.norm(jump - (jump @ tangent) * tangent))
    return rest <= _SQUARE * max(float(np.linalg.norm(beside)), size)
