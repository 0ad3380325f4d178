"""What the pieces of a chain need to be one smooth strip: at each joint values, spans, weights and slopes, in turn.

On piece k the strip is lambda(u, v) R(w(u, v), v + q(u, v)), homogeneous where there are weights; lambda, w and q are
power series in u whose coefficients are cubic in v, given by values and slopes at both ends of the piece. At a joint,
order by order in u, the values of both sides have to agree, and their derivatives along v. What is left of these is a
crease of the faces themselves.

Source: `semispline.derivations.chains`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_coefficients import (
    CLOSED,
    LAMBDA,
    Coefficients,
    JoinedPieces,
    Joint,
    Q,
    W,
)
from semispline.solver.blending.chain_pieces import Piece, cartesian_slope, with_equal_ends, with_faster_end
from semispline.solver.blending.end_faces import EndFace, steered
from semispline.solver.blending.reparametrisation import Reparametrisation, composed, slopes_along
from semispline.solver.errors import EdgeError
from semispline.solver.splines import basis_matrix

# Angles in degrees: contacts that turn by more have a corner; by more than the second, a kink that is no one's wish.
CORNER, KINK = 1.0, 1e-6
# Ends that lie apart by less than this part of their coordinates are one point.
_MOVED = 1e-13
# What rounding leaves of it asks for nothing; nor what noise of the file does, as seen where derivatives across do not
# agree either: so many times that, and so much at most, a crease of 2e-9 degree.
_ROUNDING = 1e-13
_OF_NOISE, _MOST_NOISE = 10.0, 4e-11
# A contact that is slower than this part of its size stands still: the judge sees no normal there.
_STILL = 1e-9
# Speeds of a closed chain that come back to the first one, and weights that are flat, to this.
_SAME = 1e-9
EndFaces: TypeAlias = tuple[EndFace | None, EndFace | None]


def joined_pieces(
    pieces: list[Piece], *, closed: bool, tolerance: float, ends_on: EndFaces = (None, None)
) -> JoinedPieces:
    """Return what makes the pieces one strip.

    Parameters
    ----------
    pieces : list of Piece
    closed : bool
    tolerance : float
        Within which the faces meet, model units: so far derivatives across may differ that cannot be made to agree.
    ends_on : pair of EndFace or None
        On which faces the lines across the ends of an open chain are to lie.

    Raises
    ------
    EdgeError
        A contact that runs along an end face, or stands still at a joint; or there the faces do not meet along one
        curve that leaves the contact, or lie on different sides.
    """
    turns = [_turn(pieces[k - 1], pieces[k]) if k or closed else None for k in range(len(pieces))]
    for k, turn in enumerate(turns):
        if turn is not None:
            _check_speeds(pieces[k - 1], pieces[k], k)
    smooth = [turn is not None and turn <= CORNER for turn in turns]
    pieces = _of_even_weights(pieces, closed=closed, tolerance=tolerance)
    if closed and all(smooth):
        pieces = _closing_speeds(pieces)
    ends = [piece.at_ends() for piece in pieces]
    spans = _spans(pieces)
    found, apart = _with_values(pieces, ends, closed=closed, tolerance=tolerance)
    _flatten_weights(ends, spans, found, smooth, closed=closed)
    _steer(ends, found, ends_on)
    joints: list[Joint | None] = [None] * len(pieces)
    straight = [piece.is_straight for piece in pieces]
    noise = max(_ROUNDING, min(_OF_NOISE * max(apart), _MOST_NOISE))
    for k, turn in enumerate(turns):
        if turn is not None:
            rounding = (
                pieces[k - 1].rounding_of_slopes()[1] / spans[k - 1] + pieces[k].rounding_of_slopes()[0] / spans[k]
            )
            joint = _with_slopes(ends, spans, found, straight, k, turn, rounding, noise)
            joints[k] = replace(joint, apart=apart[k])
    continuity = tuple(int(joint is not None and joint.kind == "smooth") for joint in joints)
    return JoinedPieces(tuple(pieces), spans, tuple(found), tuple(joints), continuity)


def only_continuous(pieces: list[Piece], joined: JoinedPieces, *, closed: bool, tolerance: float = 0.0) -> JoinedPieces:
    """Return the same pieces with nothing but their values made to agree."""
    found, _ = _with_values(pieces, [piece.at_ends() for piece in pieces], closed=closed, tolerance=tolerance)
    return JoinedPieces(tuple(pieces), _spans(pieces), tuple(found), joined.joints, (0,) * len(pieces))


def _spans(pieces: list[Piece]) -> FloatArray:
    """Return how long each piece is to be, so that the contact has one speed at both sides of each joint."""
    speeds = [piece.end_speeds() for piece in pieces]
    return np.asarray(np.cumprod([1.0, *(speeds[k + 1][0] / speeds[k][1] for k in range(len(pieces) - 1))]))


def _of_even_weights(pieces: list[Piece], *, closed: bool, tolerance: float) -> list[Piece]:
    """Return the pieces with equal weights at their ends, but for those that go on smoothly as they are."""
    if pieces[0].jets.shape[2] == 3:
        return pieces
    ends, spans = [piece.at_ends() for piece in pieces], _spans(pieces)
    found, _ = _with_values(pieces, ends, closed=closed, tolerance=tolerance)
    count, order = len(pieces), pieces[0].order
    smooth = [(k == 0 and not closed) or _goes_on(ends, spans, found, k, order) for k in range(count)]
    return [
        piece if smooth[k] and (smooth[(k + 1) % count] or (k + 1 == count and not closed)) else with_equal_ends(piece)
        for k, piece in enumerate(pieces)
    ]


def _goes_on(ends: list[FloatArray], spans: FloatArray, found: list[Coefficients], k: int, order: int) -> bool:
    sides = ends[k - 1][:, :, 1], ends[k][:, :, 0], found[k - 1], found[k]
    return all(_left_over(*sides, spans[[k - 1, k]], j).relative <= _SAME for j in range(order + 1))


def _turn(before: Piece, after: Piece) -> float:
    """Return the angle between the tangents of the contact at a joint, degrees."""
    (one, other) = (piece.at_ends()[0] for piece in (before, after))
    return _degrees(cartesian_slope(one[0, 1], one[1, 1]), cartesian_slope(other[0, 0], other[1, 0]))


def _check_speeds(before: Piece, after: Piece, joint: int) -> None:
    for piece, end in ((before, 1), (after, 0)):
        # Control points say nothing of it: that of a half circle is at infinity.
        points = basis_matrix(piece.along.degree, piece.along.knots, np.linspace(0, 1, 5)) @ piece.jets[0]
        speed, size = piece.end_speeds()[end], float(np.ptp([_place(x) for x in points], axis=0).max())
        if speed <= _STILL * size:
            raise EdgeError(
                f"joint {joint}: the contact stands still there, its derivative is {speed:.1e} where it is {size:.3g} "
                "long; use a face with another parameter along its edge"
            )


def _degrees(one: FloatArray, other: FloatArray) -> float:
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other)))


def _closing_speeds(pieces: list[Piece]) -> list[Piece]:
    """Return pieces of a closed smooth chain whose speeds come back to the first one."""
    excess = float(np.prod([end / start for start, end in (piece.end_speeds() for piece in pieces)]))
    if abs(excess - 1) <= _SAME:
        return pieces
    taking = [piece.is_straight for piece in pieces]
    if not any(taking):
        taking = [True] * len(pieces)
    times = excess ** (-1 / sum(taking))
    return [with_faster_end(x, times) if takes else x for x, takes in zip(pieces, taking, strict=True)]


def _with_values(
    pieces: list[Piece], ends: list[FloatArray], *, closed: bool, tolerance: float
) -> tuple[list[Coefficients], list[float]]:
    """Return coefficients that are constant along each piece and make values agree; the last of a ring is cubic.

    With them, for each joint, by how much derivatives differ all the same, relative to what they compare.
    """
    order = pieces[0].order
    start = np.zeros((3, order + 1))
    start[LAMBDA, 0] = 1.0
    start[W, 1] = 1.0
    found, apart = [], [0.0] * len(pieces)
    for k in range(len(pieces)):
        if k:
            wanted = end_values(ends[k - 1][:, :, 1], start)
            start, apart[k] = _matching(ends[k][:, :, 0], wanted, k, tolerance, pieces[k].width)
        breaks = np.unique(pieces[k].along.knots)
        found.append(
            Coefficients(np.stack([start, start]), np.zeros((2, 3, order + 1)), float(breaks[1]), float(breaks[-2]))
        )
    if closed:
        first = end_values(ends[0][:, :, 0], found[0].values[0])
        last, apart[0] = _matching(ends[-1][:, :, 1], first, 0, tolerance, pieces[-1].width)
        if np.abs(last - start).max() > _SAME * np.abs(start).max():
            found[-1] = replace(found[-1], values=np.stack([start, last]))
    return found, apart


def end_values(derivatives: FloatArray, by: FloatArray) -> FloatArray:
    """Return the derivatives by u at an end, shape (order + 1, d)."""
    return composed(derivatives[:, :, None], Reparametrisation.of(by))[:, 0]


def end_slopes(derivatives: FloatArray, by: FloatArray, slopes: FloatArray) -> FloatArray:
    """Return the derivatives by u, and once along v, at an end, shape (order + 1, d)."""
    return slopes_along(derivatives[:, :, None], Reparametrisation.of(by), Reparametrisation.of(slopes))[:, 0]


def _matching(
    derivatives: FloatArray, wanted: FloatArray, joint: int, tolerance: float, width: float
) -> tuple[FloatArray, float]:
    """Return lambda and w at the end of a piece by which its values are `wanted`, order by order; and what is left.

    Raises
    ------
    EdgeError
        No such values: the faces do not share the curve along which they leave the contact.
    """
    order, rational = len(wanted) - 1, wanted.shape[1] == 4
    by, apart = np.zeros((3, order + 1)), 0.0
    by[LAMBDA, 0] = wanted[0, 3] / derivatives[0, 0, 3] if rational else 1.0
    extent = float(np.abs(wanted[0]).max()) or 1.0
    per_u = float(np.linalg.norm(wanted[min(1, order)])) / extent
    if per_u == 0:
        raise EdgeError(
            f"joint {joint}: a derivative across the contact vanishes there, expected faces that leave it; use faces "
            "that have no pole at the joint"
        )
    for j in range(1, order + 1):
        rest = wanted[j] - end_values(derivatives, by)[j]
        columns = {W: by[LAMBDA, 0] * derivatives[1, 0]} | ({LAMBDA: derivatives[0, 0]} if rational else {})
        solved, left = _solved(list(columns.values()), rest)
        for name, value in zip(columns, solved, strict=True):
            by[name, j] = value
        scale = max(float(np.linalg.norm(wanted[j])), extent * per_u**j)
        apart = max(apart, left / scale)
        # A face that is off by the tolerance along its width is turned by that much.
        if left > max(CLOSED * scale, tolerance * (by[W, 1] / width) ** j):
            raise EdgeError(
                f"joint {joint}: derivatives of order {j} across the contact differ by {left / scale:.1e} of "
                f"themselves, expected {CLOSED:g}; both faces have to leave the contact along one curve there"
            )
        if j == 1 and by[W, 1] <= 0:
            raise EdgeError(f"joint {joint}: the faces lie on different sides of the chain, expected one side")
    return by, apart


def _solved(columns: list[FloatArray], rest: FloatArray) -> tuple[FloatArray, float]:
    """Return the least-squares solution and the length of what is left."""
    sizes = np.array([float(np.linalg.norm(column)) or 1.0 for column in columns])
    matrix = np.column_stack(columns) / sizes
    solved = np.linalg.lstsq(matrix, rest, rcond=None)[0]
    return solved / sizes, float(np.linalg.norm(rest - matrix @ solved))


def _flatten_weights(
    ends: list[FloatArray], spans: FloatArray, found: list[Coefficients], smooth: list[bool], *, closed: bool
) -> None:
    """Give lambda slopes that make the weight flat at both sides of each joint where its slope jumps."""
    if ends[0].shape[-1] == 3:
        return
    count = len(ends)
    flat = np.zeros((count, 2), dtype=bool)
    slopes = np.array([[x[0, 1, end, 3] / x[0, 0, end, 3] for end in (0, 1)] for x in ends]) / spans[:, None]
    for k in range(count):
        if smooth[k] and abs(slopes[k, 0] - slopes[k - 1, 1]) > _SAME:
            flat[k, 0] = flat[k - 1, 1] = True
    # A free end takes part, or the factor of its piece would be cubic.
    if not closed:
        flat[0, 0] |= flat[0, 1] and not smooth[0]
        flat[-1, 1] |= flat[-1, 0]
    for k, end in zip(*np.nonzero(flat), strict=True):
        own = found[k]
        own.slopes[end, LAMBDA, 0] = -slopes[k, end] * spans[k] * own.values[end, LAMBDA, 0]


def _steer(ends: list[FloatArray], found: list[Coefficients], ends_on: EndFaces) -> None:
    """Bend the ends of a chain onto their faces: q linear along a chain of one piece, else fading out on the last."""
    for end, face in enumerate(ends_on):
        if face is not None:
            own = found[-end]
            own.values[end] = steered(ends[-end][:, :, end], own.values[end], face)
    first, last = found[0], found[-1]
    if first is last:
        change = first.values[1, Q] - first.values[0, Q]
        first.slopes[:, Q] = change
    else:
        first.slopes[0, Q] = -2 * first.values[0, Q]
        last.slopes[1, Q] = 2 * last.values[1, Q]


def _with_slopes(
    ends: list[FloatArray],
    spans: FloatArray,
    found: list[Coefficients],
    straight: list[bool],
    k: int,
    turn: float,
    rounding: FloatArray,
    noise: float,
) -> Joint:
    """Make the derivatives along v agree at joint k, as far as they can; the slopes are set in `found`."""
    left, right = ends[k - 1][:, :, 1], ends[k][:, :, 0]
    order = len(left) - 1
    one, other = found[k - 1], found[k]
    crease = _degrees(_normal(left), _normal(right))
    # A straight face takes all of it: where R_vv = 0 the degree hardly rises.
    share = 0.5 if straight[k] == straight[k - 1] else float(straight[k])
    if straight[k] and straight[k - 1]:
        share = 1.0
    residuals = []
    for j in range(order + 1):
        left_over = _left_over(left, right, one, other, spans[[k - 1, k]], j)
        if j and turn <= CORNER and left_over.relative > max(noise, rounding[j] / left_over.scale):
            least = noise * left_over.scale
            if share:
                _take(other, 0, right, spans[k], share * left_over.rest, j, least)
            if share < 1:
                _take(one, 1, left, spans[k - 1], (share - 1) * left_over.rest, j, least)
            left_over = _left_over(left, right, one, other, spans[[k - 1, k]], j)
        residuals.append(left_over.relative)
    smooth = turn <= KINK and max(residuals) <= CLOSED
    kind = "corner" if turn > CORNER else "smooth" if smooth else "creased"
    points = [_place(x[0, 0]) for x in (left, right)]
    middle = (points[0] + points[1]) / 2
    return Joint(
        (float(middle[0]), float(middle[1]), float(middle[2])),
        kind,
        turn,
        crease,
        tuple(residuals),
        _beyond_rounding(*points),
        (_curvature(left[0]), _curvature(right[0])),
    )


@dataclass(frozen=True, eq=False)
class _LeftOver:
    """By how much the derivatives along v of one order differ at a joint, and relative to what they compare."""

    rest: FloatArray
    scale: float

    @property
    def relative(self) -> float:
        return float(np.linalg.norm(self.rest)) / self.scale


def _left_over(
    left: FloatArray, right: FloatArray, one: Coefficients, other: Coefficients, spans: FloatArray, order: int
) -> _LeftOver:
    before = end_slopes(left, one.values[1], one.slopes[1]) / spans[0]
    after = end_slopes(right, other.values[0], other.slopes[0]) / spans[1]
    values = end_values(left, one.values[1])
    rest = before[order] - after[order]
    along = float(np.linalg.norm(before[0]))
    # Derivatives that vanish, as of extrusions, are rounding: what they would be of a face as bent as it is wide.
    scale = max(
        float(np.linalg.norm(before[order])),
        float(np.linalg.norm(after[order])),
        float(np.linalg.norm(values[order])) / float(spans.min()),
        along * (float(np.linalg.norm(values[1])) / along) ** order,
    )
    return _LeftOver(rest, scale or 1.0)


def _take(
    piece: Coefficients, end: int, derivatives: FloatArray, span: float, wanted: FloatArray, order: int, least: float
) -> None:
    """Set the slopes of one order at an end so that the derivative along v changes as wanted, but for the `least`."""
    lam = piece.values[end, LAMBDA, 0]
    columns = {W: lam * derivatives[1, 0] / span, Q: lam * derivatives[0, 1] / span}
    if derivatives.shape[-1] == 4:
        columns[LAMBDA] = derivatives[0, 0] / span
    solved, _ = _solved(list(columns.values()), wanted)
    for (name, column), value in zip(columns.items(), solved, strict=True):
        # A slope of noise would cost the degree of a cubic.
        if abs(value) * np.linalg.norm(column) > max(_ROUNDING * np.linalg.norm(wanted), least):
            piece.slopes[end, name, order] += value


def _normal(derivatives: FloatArray) -> FloatArray:
    point = derivatives[0, 0]
    return np.cross(cartesian_slope(point, derivatives[1, 0]), cartesian_slope(point, derivatives[0, 1]))


def _curvature(derivatives: FloatArray) -> float:
    """Return the curvature of the contact from its derivatives along v."""
    point, first, second = derivatives[:3]
    if len(point) == 4:
        position, slope = _place(point), cartesian_slope(point, first)
        second = (second[:3] - second[3] * position - 2 * first[3] * slope) / point[3]
        first = slope
    speed = float(np.linalg.norm(first))
    return float(np.linalg.norm(np.cross(first, second))) / speed**3


def _beyond_rounding(one: FloatArray, other: FloatArray) -> float:
    apart = float(np.linalg.norm(other - one))
    return 0.0 if apart <= _MOVED * max(float(np.abs(one).max()), float(np.abs(other).max())) else apart


def _place(point: FloatArray) -> FloatArray:
    return point if len(point) == 3 else np.asarray(point[:3] / point[3])
