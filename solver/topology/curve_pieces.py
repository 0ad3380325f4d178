"""Pieces of a curve on a face, each fit for one band: cut at corners and where the face's second form jumps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.face_curves import FaceCurve, spread
from semispline.solver.topology.face_jets import Face, Sections, sections, unit

# A curve that turns by more, in degrees, has a corner there.
CORNER_DEGREES = 5.0
# Where the second form jumps by more than this fraction of its largest value along the edge no one row follows it.
JUMP = 0.01
# Normals that differ by more, in degrees, are a crease of the face.
_CREASE_DEGREES = 0.005
# A side of the face shorter than this fraction of its largest along the curve is degenerate.
_DEGENERATE = 1e-6
# Of the range of the curve: beside a place.
_BESIDE = 1e-8
_GAUSS = np.polynomial.legendre.leggauss(6)
_NODES = 400


@dataclass(frozen=True, eq=False)
class CurvePiece:
    """A piece of a curve on a face, run through by arc length.

    Attributes
    ----------
    curve : FaceCurve
    start, end : float
        In the curve's own parameter; the end may lie beyond the seam of a closed curve.
    closed : bool
        The piece is the whole of a closed smooth curve.
    sign : float
        1 where the kept part lies left of the curve in the parameters, -1 right.
    left_out : float
        The length that was kept away from degenerate ends, model units.
    """

    curve: FaceCurve
    start: float
    end: float
    closed: bool
    sign: float
    left_out: float = 0.0

    @property
    def face(self) -> Face:
        """The face."""
        return self.curve.face

    @property
    def length(self) -> float:
        """Model units."""
        return float(self._arcs[1][-1])

    @cached_property
    def _arcs(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Nodes, the lengths up to them, and the speeds at both ends of each interval, shape (2, n)."""
        breaks = self.curve.breaks
        if self.curve.is_closed:
            breaks = np.concatenate([breaks, breaks[1:] + (breaks[-1] - breaks[0])])
        inner = breaks[(breaks > self.start) & (breaks < self.end)]
        nodes = spread(np.concatenate([[self.start], inner, [self.end]]), _NODES)
        half, middle = np.diff(nodes) / 2, (nodes[:-1] + nodes[1:]) / 2
        x = middle + half * _GAUSS[0][:, None]
        speed = np.linalg.norm(self.curve.tangents(x.ravel())[1], axis=1).reshape(x.shape)
        lengths = np.concatenate([[0.0], np.cumsum(half * (_GAUSS[1] @ speed))])
        inside = _BESIDE * half
        ends = [
            np.linalg.norm(self.curve.tangents(at, beside)[1], axis=1)
            for at, beside in ((nodes[:-1], nodes[:-1] + inside), (nodes[1:], nodes[1:] - inside))
        ]
        return nodes, lengths, np.array(ends)

    def parameters(self, v: FloatArray) -> FloatArray:
        """Return the curve's own parameters at lengths: the cubic of each interval with the right speeds at its ends.

        It misses the length by 1e-9 of it or less, which moves points along the curve and not off it.
        """
        nodes, lengths, speeds = self._arcs
        i = np.clip(np.searchsorted(lengths, v, side="right") - 1, 0, len(nodes) - 2)
        width, rise = np.diff(lengths)[i], np.diff(nodes)[i]
        z = (v - lengths[i]) / width
        first, last = width / speeds[0][i], width / speeds[1][i]
        return np.asarray(nodes[i] + z * (first + z * (3 * rise - 2 * first - last + z * (first + last - 2 * rise))))

    def at(self, v: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (s, t) and slopes at lengths, and points in the spans that are meant there; shapes (K, 2)."""
        x = self.parameters(v)
        margin = _BESIDE * (self.end - self.start)
        inner = np.clip(x, self.start + margin, self.end - margin) if not self.closed else x
        at, slope = self.curve.at(x)
        near = at
        if not self.closed:
            ends = inner != x
            if ends.any():
                near = np.array(at)
                near[ends], slope[ends] = self.curve.at(inner[ends])
        return at, slope, self.face.beside(near, slope, self.sign)

    def sections(self, v: FloatArray, order: int) -> Sections:
        """Return the face's frame and curvature at lengths along the piece."""
        at, slope, beside = self.at(v)
        jet = self.face.jet(at, order, beside)
        return sections(jet, jet[1, 0] * slope[:, :1] + jet[0, 1] * slope[:, 1:], self.sign, order)


@dataclass(frozen=True)
class Break:
    """Where a curve was cut: why, at which parameter, and the point."""

    reason: str
    parameter: float
    point: tuple[float, float, float]


def pieces(curve: FaceCurve, sign: float, away: float) -> tuple[list[CurvePiece], list[Break]]:
    """Return the pieces of a curve between corners and jumps, and what cut them.

    `away` is the part of the range that is kept off degenerate ends.
    """
    cuts = {x: f"a corner of {angle:.3g} degrees" for x, angle in corners(curve)}
    for x, jump, crease in jumps(curve, sign):
        if crease > _CREASE_DEGREES:
            cuts[x] = f"the face's normal turns by {crease:.2g} degrees"
        elif jump > JUMP:
            cuts[x] = f"the face's curvature jumps by {100 * jump:.2g} %"
    start, end = curve.ends
    # Each crossing may be found beside a break of the curve.
    at = sorted(cuts)
    at = [x for k, x in enumerate(at) if k == 0 or x - at[k - 1] > 1e-7 * (end - start)]
    points = curve.tangents(np.array(at))[0] if at else np.zeros((0, 3))
    found = [Break(cuts[x], x, (p[0], p[1], p[2])) for x, p in zip(at, points.tolist(), strict=True)]
    inner = [x for x in at if start < x < end]
    if curve.is_closed:
        if not at:
            return [CurvePiece(curve, start, end, True, sign)], found
        whole = [*at] if at[0] == start else inner
        ends = [*whole, whole[0] + end - start]
    else:
        ends = [start, *inner, end]
    made = [CurvePiece(curve, a, b, False, sign) for a, b in pairwise(ends)]
    return [_kept_away(piece, away) for piece in made], found


def corners(curve: FaceCurve) -> list[tuple[float, float]]:
    """Return parameters where the curve turns by more than 5 degrees, and by how much; the start where closed."""
    x, turns = turns_at_breaks(curve)
    limit = np.full(len(x), CORNER_DEGREES)
    if curve.degree == 1 and len(x) > 1:
        # A vertex of a polyline that stands for a smooth curve turns as its neighbours do.
        before, after = np.roll(turns, 1), np.roll(turns, -1)
        if not curve.is_closed:
            before[0] = after[-1] = 0.0
        beside = np.maximum(before, after)
        limit = np.where(turns > 30.0, CORNER_DEGREES, np.maximum(limit, 2.5 * beside))
    return [(float(a), float(b)) for a, b in zip(x[turns > limit], turns[turns > limit], strict=True)]


def turns_at_breaks(curve: FaceCurve) -> tuple[FloatArray, FloatArray]:
    """Return the inner breaks of a curve, its start too where it is closed, and its turns there in degrees."""
    start, end = curve.ends
    x = curve.breaks[:-1] if curve.is_closed else curve.breaks[1:-1]
    if not len(x):
        return x, np.zeros(0)
    narrow = np.diff(curve.breaks).min()
    after = curve.tangents(x, x + 1e-6 * narrow)[1]
    before_at = np.where(x == start, end, x)
    before = curve.tangents(before_at, before_at - 1e-6 * narrow)[1]
    a, b = unit(before), unit(after)
    sine = np.linalg.norm(np.cross(a, b), axis=1)
    return x, np.degrees(np.arctan2(sine, np.einsum("kd,kd->k", a, b)))


def jumps(curve: FaceCurve, sign: float, order: int = 2) -> list[tuple[float, float, float]]:
    """Return where the curve crosses lines of low smoothness of its face: parameter, jump, turn of the normal.

    Jumps of curvature (order 2: knots of multiplicity p - 1 and more), or of the rate h_order, are fractions of the
    largest value along the curve; turns are in degrees.
    """
    face = curve.face
    x, direction = _crossings(curve, order)
    if not len(x):
        return []
    at, slope = curve.at(x)
    step = np.zeros_like(at)
    step[np.arange(len(x)), direction] = (1e-9 * face.widths * np.sign(slope))[np.arange(len(x)), direction]
    sides = []
    for beside in (at - step, at + step):
        jet = face.jet(at, order, beside)
        sides.append(sections(jet, jet[1, 0] * slope[:, :1] + jet[0, 1] * slope[:, 1:], sign, order))
    before, after = sides
    sine = np.linalg.norm(np.cross(before.normal, after.normal), axis=1)
    largest = largest_values(curve, sign, order)
    if order == 2:
        jump = np.abs(before.bends - after.bends).max(axis=0) / largest
    else:
        jump = np.abs(before.heights[-1] - after.heights[-1]) / largest
    return [(float(a), float(b), float(c)) for a, b, c in zip(x, jump, np.degrees(np.arcsin(sine)), strict=True)]


def largest_values(curve: FaceCurve, sign: float, order: int) -> float:
    """Return the largest |II| along a curve, or the largest |h_order|, with the floors 1e-3 / size^(order - 1)."""
    x = curve.places[1:-1]
    at, slope = curve.at(x)
    jet = curve.face.jet(at, order, curve.face.beside(at, slope, sign))
    found = sections(jet, jet[1, 0] * slope[:, :1] + jet[0, 1] * slope[:, 1:], sign, order)
    bend = float(np.nanmax(np.abs(found.bends), initial=0.0))
    if order == 2:
        return max(bend, 1e-3 / curve.face.size)
    rate = float(np.nanmax(np.abs(found.heights[-1]), initial=0.0))
    return max(rate, bend ** (order - 1), 1e-3 / curve.face.size ** (order - 1))


def _crossings(curve: FaceCurve, order: int) -> tuple[FloatArray, FloatArray]:
    """Return where a curve crosses knot lines at which derivatives of `order` may jump, and the direction, 0 or 1."""
    surface, face = curve.face.surface, curve.face
    nodes = curve.places
    at, _ = curve.at(nodes)
    found: list[tuple[float, float, int, float]] = []
    for d, (degree, knots) in enumerate(((surface.degree_u, surface.knots_u), (surface.degree_v, surface.knots_v))):
        values, counts = np.unique(knots, return_counts=True)
        rough = (counts > degree - order) & (counts <= degree)
        lines = values[rough]
        if face.closed[d]:
            turns = np.arange(-2, 3) * face.widths[d]
            lines = np.unique(np.concatenate([lines, values[:1]])[:, None] + turns)
        for line in lines.tolist():
            above = at[:, d] - line
            k = np.flatnonzero(above[:-1] * above[1:] < 0)
            found += [(float(nodes[i]), float(nodes[i + 1]), d, line) for i in k]
            touched = np.flatnonzero((above[1:-1] == 0) & (above[:-2] * above[2:] < 0)) + 1
            found += [(float(nodes[i]), float(nodes[i]), d, line) for i in touched]
    if not found:
        return np.zeros(0), np.zeros(0, dtype=np.intp)
    low, high, direction, line = (np.array(x) for x in zip(*found, strict=True))
    direction = direction.astype(np.intp)
    rows = np.arange(len(low))
    rising = np.sign(curve.at(high)[0][rows, direction] - line)
    for _ in range(60):
        middle = (low + high) / 2
        above = (curve.at(middle)[0][rows, direction] - line) * rising > 0
        low, high = np.where(above, low, middle), np.where(above, middle, high)
        if np.all(high - low <= 4e-16 * np.abs(high) + 1e-300):
            break
    return (low + high) / 2, direction


def _kept_away(piece: CurvePiece, away: float) -> CurvePiece:
    """Return the piece without a bit at each end where the face is degenerate."""
    curve, width = piece.curve, piece.end - piece.start
    x = np.linspace(piece.start, piece.end, 41)
    at, _ = curve.at(x)
    jet = curve.face.jet(at, 1, curve.at(np.clip(x, piece.start + 1e-9 * width, piece.end - 1e-9 * width))[0])
    sizes = np.array([np.linalg.norm(jet[key], axis=1) for key in ((1, 0), (0, 1))])
    poor = (sizes < _DEGENERATE * sizes.max(axis=1, keepdims=True)).any(axis=0)
    area = np.linalg.norm(np.cross(jet[1, 0], jet[0, 1]), axis=1)
    poor |= area < _DEGENERATE * sizes.max(axis=1).prod()
    start = piece.start + away * width if poor[0] else piece.start
    end = piece.end - away * width if poor[-1] else piece.end
    if not (poor[0] or poor[-1]):
        return piece
    shorter = replace(piece, start=start, end=end)
    return replace(shorter, left_out=max(piece.length - shorter.length, 0.0))
