"""Knot lines of a base where its rows are only continuous: told apart, and smoothed where all rows share one jump.

Where R_v after the line is s R_v + c R before it, for the rows 0 to the order of contact (R homogeneous; c is 0 where
there are no weights), the rows become C1 by spans after the line that are s times as long, and a factor lambda(v) whose
slope jumps by -c / s: the same surface with another speed along. A line where the base has one tangent plane, but its
rows share no jump, is G1; any other is creased in the base itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import comb, factorial, prod
from typing import Literal, TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.knot_lines import LINE_TOLERANCE, KnotLine, knot_lines
from semispline.solver.blending.spans import bezier_pieces, joined_spans
from semispline.solver.blending.weights import end_derivatives
from semispline.solver.splines import Basis, clamped, inner_knots, multiply

JumpKind: TypeAlias = Literal["shared", "G1", "creased"]
# Tangent planes nearer than this, in degrees, are one.
SMOOTH_DEGREES = 1e-6


@dataclass(frozen=True)
class Jump:
    """A knot line where rows are not C1 in their own form.

    Attributes
    ----------
    v : float
        The knot; for the seam of closed rows the start of the domain.
    kind : {"shared", "G1", "creased"}
    speed, slope : float
        s and c of the shared jump; 1 and 0 for the other kinds.
    degrees : float
        Angle between the base's tangent planes on both sides of the line, at the edge.
    """

    v: float
    kind: JumpKind
    speed: float
    slope: float
    degrees: float


def jumps(
    rows: FloatArray,
    along: Basis,
    degree: int,
    spans: tuple[float, ...],
    *,
    closed: bool = False,
    largest: float = 0.0,
) -> tuple[Jump, ...]:
    """Return the lines where the rows are not C1, the seam of closed rows last.

    Parameters
    ----------
    rows : ndarray, shape (order + 1, n, 3) or (order + 1, n, 4)
        From the edge inwards; homogeneous where they have four columns.
    along : Basis
    degree : int
        Of the base, across.
    spans : tuple of float
        Distances from the edge to the next knots across.
    closed : bool
    largest : float
        As in `knot_lines`.

    Examples
    --------
    >>> rows = np.array([[[0, 0, 0], [1, 0, 0], [3.0, 0, 0]], [[0, 1, 0], [1, 1, 0], [3.0, 1, 0]]])
    >>> jumps(rows, Basis(1, np.array([0, 0, 1, 2, 2.0])), 1, (1.0,))
    (Jump(v=1.0, kind='shared', speed=2.0, slope=0.0, degrees=0.0),)
    """
    inner = inner_knots(along.knots, along.degree)
    if not closed and np.unique(inner, return_counts=True)[1].max(initial=0) < along.degree:
        return ()
    largest = max(largest, float(np.abs(rows[..., :3]).max()))
    lines = knot_lines(_centred(rows), along, 1, closed=closed, largest=largest)
    return tuple(_judged(line, degree, spans) for line in lines if line.continuity < 1)


def _centred(rows: FloatArray) -> FloatArray:
    """Return the rows in coordinates around their middle."""
    points = rows[..., :3] / rows[..., 3:] if rows.shape[-1] == 4 else rows
    centre = (points.min(axis=(0, 1)) + points.max(axis=(0, 1))) / 2
    if rows.shape[-1] == 3:
        return np.asarray(rows - centre)
    return np.concatenate([rows[..., :3] - rows[..., 3:] * centre, rows[..., 3:]], axis=-1)


def _judged(line: KnotLine, degree: int, spans: tuple[float, ...]) -> Jump:
    angle = _turn(line, degree, spans)
    shared = _shared(line)
    if shared is not None:
        return Jump(line.v, "shared", *shared, angle)
    return Jump(line.v, "G1" if angle < SMOOTH_DEGREES else "creased", 1.0, 0.0, angle)


def _shared(line: KnotLine) -> tuple[float, float] | None:
    """Return s and c of R_v after = s (R_v before) + c R for all rows, or None."""
    if line.continuity < 0:
        return None
    before, after, place = line.before[1].ravel(), line.after[1].ravel(), line.before[0].ravel()
    if line.before.shape[-1] == 4:
        speed, slope = np.linalg.lstsq(np.column_stack([before, place]), after, rcond=None)[0].tolist()
    else:
        size = float(before @ before)
        speed, slope = float(before @ after) / size if size else 0.0, 0.0
    rest = after - speed * before - slope * place
    allowed = LINE_TOLERANCE * max(np.abs(before).max() * speed, np.abs(after).max()) + line.rounding[1]
    if speed <= 0 or np.abs(rest).max() > allowed:
        return None
    return speed, slope


def _turn(line: KnotLine, degree: int, spans: tuple[float, ...]) -> float:
    """Return the angle between both tangent planes at the edge in degrees; of both tangents where there is one row."""
    normals = []
    for side in (line.before, line.after):
        tangent = _cartesian(side[0, 0], side[1, 0])
        if side.shape[1] > 1:
            inwards = end_derivatives(1, degree, spans)[1] @ side[0, :2]
            tangent = np.cross(_cartesian(side[0, 0], inwards), tangent)
        normals.append(tangent)
    one, other = normals
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other)))


def _cartesian(point: FloatArray, derivative: FloatArray) -> FloatArray:
    """Return the direction of the derivative of X / om, from (X, om) and its derivative."""
    if len(point) == 3:
        return derivative
    return np.asarray(derivative[:3] * point[3] - derivative[3] * point[:3])


def smoothed(
    rows: FloatArray, along: Basis, found: tuple[Jump, ...], *, closed: bool = False
) -> tuple[FloatArray, Basis]:
    """Return rows of the same surface that are C1 at the lines with a shared jump, over the same domain.

    Without weights the degree stays, and the multiplicity of these knots falls by one; with them the degree rises by
    two or three. Where the speeds of closed rows do not come back to the first one, each segment is run through by a
    quadratic function of the new parameter: the degree doubles. Rows whose lambda would not be positive are returned as
    they are.

    Parameters
    ----------
    rows : ndarray, shape (order + 1, n, 3) or (order + 1, n, 4)
    along : Basis
    found : tuple of Jump
        What `jumps` returns for them.
    closed : bool
    """
    shared = [jump for jump in found if jump.kind == "shared"]
    if not shared:
        return rows, along
    start, end = float(along.knots[0]), float(along.knots[-1])
    inner = sorted((jump for jump in shared if jump.v > start), key=lambda jump: jump.v)
    cuts = np.array([start, *(jump.v for jump in inner), end])
    seam = next((jump for jump in shared if jump.v == start), Jump(start, "shared", 1.0, 0.0, 0.0))
    # A seam that is creased, or G1, has no speed to come back to.
    meets = closed and all(jump.kind == "shared" for jump in found if jump.v == start)
    excess = float(np.prod([jump.speed for jump in shared])) if meets else 1.0
    # Each segment ends at `faster` times the speed that it begins with.
    faster = excess ** (1 / (len(cuts) - 1))
    new, basis = rows, along
    if abs(excess - 1) > LINE_TOLERANCE:
        new, basis = sped_up(rows, along, cuts, faster)
    else:
        faster = 1.0
    # Derivatives before a line are now 2 f / (1 + f) times as large, those after it 2 / (1 + f) times, f = `faster`.
    factors = np.cumprod([1.0, *(jump.speed / faster for jump in inner)])
    ends = np.concatenate([[0.0], np.cumsum(np.diff(cuts) * factors)])
    scale = (end - start) / ends[-1]
    ends, factors = start + ends * scale, factors * scale
    ends[-1] = end
    basis = Basis(basis.degree, _moved(basis.knots, cuts, ends))
    # In the new parameter R_v jumps by this times R.
    slopes = np.array([seam.slope, *(jump.slope for jump in inner), seam.slope])
    slopes *= 2 / (1 + faster) / np.append(factors, factors[0])
    if np.abs(slopes).max() * (end - start) > LINE_TOLERANCE:
        factor = _lambda(ends, slopes, closed)
        if factor is None:
            return rows, along
        products = [multiply(*factor, basis, row) for row in new]
        basis, new = products[0][0], np.stack([points for _, points in products])
    for place in ends[1:-1]:
        new, basis = _without_joint(new, basis, float(place))
    return new, basis


def _moved(knots: FloatArray, cuts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the knots with each segment between cuts mapped onto that between `ends`; the cuts are met exactly."""
    segment = np.clip(np.searchsorted(cuts, knots, side="right") - 1, 0, len(cuts) - 2)
    moved = ends[segment] + (knots - cuts[segment]) * (np.diff(ends) / np.diff(cuts))[segment]
    for cut, place in zip(cuts, ends, strict=True):
        moved[knots == cut] = place
    return np.asarray(moved)


def sped_up(rows: FloatArray, along: Basis, cuts: FloatArray, faster: float) -> tuple[FloatArray, Basis]:
    """Return the rows with each segment run through by v = (1 - e) s + e s^2, s over the same segment.

    Their derivative at its end is then `faster` times as large, measured by that at its start, as it was.
    """
    e = (faster - 1) / (faster + 1)
    q = along.degree
    breaks, pieces = bezier_pieces(rows, along)
    segment = np.clip(np.searchsorted(cuts, breaks[:-1], side="right") - 1, 0, len(cuts) - 2)
    left, width = cuts[segment], np.diff(cuts)[segment]

    def place(v: FloatArray) -> FloatArray:
        # s of v; the stable root, since e is between -1 and 1.
        return np.asarray(2 * v / (1 - e + np.sqrt((1 - e) ** 2 + 4 * e * v)))

    new, points = breaks.copy(), []
    for k, piece in enumerate(pieces):
        low, high = ((breaks[k : k + 2] - left[k]) / width[k]).tolist()
        one, other = place(np.array([low, high])).tolist()
        new[k] = left[k] + width[k] * one
        # The blossom of the quadratic at (one, other), as a share of the span.
        middle = ((1 - e) * (one + other) / 2 + e * one * other - low) / (high - low)
        points.append(_composed(piece, (0.0, middle, 1.0)))
    for cut in cuts:
        new[breaks == cut] = cut
    # Inside the segments the rows are as smooth as they were.
    smooth = [q - int(np.count_nonzero(along.knots == v)) for v in breaks[1:-1]]
    return joined_spans(points, new, smooth)


def _composed(piece: FloatArray, inner: tuple[float, float, float]) -> FloatArray:
    """Return the Bezier points, shape (K, 2 q + 1, d), of a Bezier curve of degree q run through by a quadratic one."""
    q = piece.shape[1] - 1
    result = np.zeros((piece.shape[0], 2 * q + 1, piece.shape[2]))
    for times in product(range(q + 1), repeat=3):
        if sum(times) != q:
            continue
        level = piece
        for x in np.repeat(inner, times).tolist():
            level = (1 - x) * level[:, :-1] + x * level[:, 1:]
        index = times[1] + 2 * times[2]
        ways = factorial(q) // prod(map(factorial, times)) * 2 ** times[1]
        result[:, index] += ways / comb(2 * q, index) * level[:, 0]
    return result


def _lambda(cuts: FloatArray, slopes: FloatArray, closed: bool) -> tuple[Basis, FloatArray] | None:
    """Return the factor: 1 at the cuts, where its slope falls by `slopes`; shape (n, 1), None if not positive.

    Half of each jump is before the line, half after it. A free end takes the slope that keeps its span quadratic.
    """
    before, after = slopes[1:] / 2, -slopes[:-1] / 2
    if not closed:
        after[0], before[-1] = -before[0], -after[-1]
    widths = np.diff(cuts)
    even = np.abs(before + after).max() <= LINE_TOLERANCE * np.abs(slopes).max()
    degree = 2 if even else 3
    points = [1.0]
    for h, one, other in zip(widths, after, before, strict=True):
        points += [1 + h * one / 2, 1.0] if even else [1 + h * one / 3, 1 - h * other / 3, 1.0]
    if min(points) <= 0:
        return None
    return Basis(degree, clamped(np.repeat(cuts[1:-1], degree), degree, cuts[0], cuts[-1])), np.array(points)[:, None]


def _without_joint(rows: FloatArray, basis: Basis, v: float) -> tuple[FloatArray, Basis]:
    """Return the rows, C1 at a knot of full multiplicity, with one copy of it less: its own control point goes."""
    at = int(np.searchsorted(basis.knots, v))
    if np.count_nonzero(basis.knots == v) < basis.degree:
        return rows, basis
    return np.delete(rows, at - 1, axis=1), Basis(basis.degree, np.delete(basis.knots, at))
