"""How an edge of a surface lies on a face that it meets along a free curve: by feet on the face itself.

The face knows nothing of the curve, so each point of the edge belongs to its foot, and both sides are compared in the
frame of the edge. Whether both run on at the same side can be seen only where the edge of the face is known: the face
itself goes on beyond a curve on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from semispline.solver.arrays import FloatArray, require
from semispline.solver.errors import EdgeError
from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.contact import Place
from semispline.solver.judge.curvature_rates import curvature_rates
from semispline.solver.judge.de_boor import edge_curves, surface_points
from semispline.solver.judge.free_edge import FreeEdge
from semispline.solver.judge.profile import Profile, chord_lengths
from semispline.solver.splines import BSplineSurface, bounding_box, transform

# Points of each span of the edge; of the face, each way, from the nearest of which a foot is sought.
_PER_SPAN, _GRID = 30, 80
_STEPS = 30
# So far beside a foot, of the domain, lies the point whose derivatives are those of the kept side of a knot line.
_BESIDE = 1e-9
# Ends of an edge nearer than this, of its length, are one point.
_SAME_POINT = 1e-6
# An edge that is farther from the face than this, of its length, is not one of it.
_NOT_ON_IT = 0.05

Jet = Mapping[tuple[int, int], FloatArray]
OwnJet = dict[tuple[int, int], FloatArray]


@dataclass(frozen=True)
class FaceContact:
    """How an edge of a surface meets a face along a free curve; the worst over points in every span of the edge.

    Attributes
    ----------
    gap : float
        Largest distance of the edge from the face, model units.
    angle_degrees : float
        Largest angle between the tangent planes; above 90 where an edge was given and the surface folds back at it.
    curvature_jump_relative : float
        Largest difference of normal curvature: across the edge over the largest one across it of the face, along it
        and of the mixed one over the largest of all; scales not below 1e-3 / size.
    rate_jump_relative, second_rate_jump_relative : float or None
        As `Contact` has them, where asked for.
    off : float or None
        Largest distance across from the edge of the face, model units; None where no edge was given.
    length : float
        Of the edge.
    at : dict
        For each measure the `Place` where it is largest.
    """

    gap: float
    angle_degrees: float
    curvature_jump_relative: float
    rate_jump_relative: float | None
    second_rate_jump_relative: float | None
    off: float | None
    length: float
    at: dict[str, Place]


def measure_face_contact(
    base: Base | FreeEdge, face: BSplineSurface | FreeEdge, *, order: int = 2, same_side: bool = False
) -> FaceContact:
    """Measure how an edge of a surface meets a face: anywhere on it, or along a free edge of it.

    Parameters
    ----------
    base : Base or FreeEdge
        A blend and its edge, say, or the edge of another face.
    face : BSplineSurface or FreeEdge
        Rational too; untrimmed. Of an edge what lies across it is told, too: how far `base` is off it, and whether it
        folds back over the face.
    order : {2, 3, 4}
        3 and 4 measure rates of curvature.
    same_side : bool
        The surface lies on the kept part of the face, as a band does, instead of beyond the edge. It matters where the
        edge runs along a line at which the face is not smooth.

    Raises
    ------
    EdgeError
        The edge is not near the face.

    Examples
    --------
    >>> from semispline.solver.splines.construction import plane
    >>> floor = plane([0, 0, 0], [4, 0, 0], [0, 4, 0])
    >>> wall = plane([1, 1, 0], [1, 2, 0], [0, 0, 1])
    >>> measure_face_contact(Base(wall, "v0"), floor).angle_degrees
    90.0
    """
    return worst_of_face(measure_face_profile(base, face, order=order, same_side=same_side))


def worst_of_face(found: Profile) -> FaceContact:
    """Return the worst of what `measure_face_profile` found."""
    worst = {name: int(np.where(np.isnan(x), np.inf, x).argmax()) for name, x in found.values.items()}
    where = {name: Place(float(found.parameter[k]), tuple(found.points[k].tolist())) for name, k in worst.items()}
    most = {name: float(found.values[name][k]) for name, k in worst.items()}
    return FaceContact(
        gap=most["gap"],
        off=most.get("off"),
        angle_degrees=most["angle_degrees"],
        curvature_jump_relative=most["curvature_jump_relative"],
        rate_jump_relative=most.get("rate_jump_relative"),
        second_rate_jump_relative=most.get("second_rate_jump_relative"),
        length=float(found.length[-1]),
        at=where,
    )


def measure_face_profile(
    base: Base | FreeEdge, face: BSplineSurface | FreeEdge, *, order: int = 2, same_side: bool = False
) -> Profile:
    """Measure along an edge what `measure_face_contact` finds the worst of; its arguments and its errors."""
    require(base, "base", Base, FreeEdge)
    require(face, "face", BSplineSurface, FreeEdge)
    other = face.face if isinstance(face, FreeEdge) else face
    origin = local_origin(base.face if isinstance(base, FreeEdge) else base.surface, other)
    moved = transform(other, np.eye(3), -origin)
    own = _edge_side(base.moved(-origin), order) if isinstance(base, FreeEdge) else _base_side(base, order, origin)
    points, length = own.jet[0, 0], chord_lengths(own.jet[0, 0])
    feet = surface_feet(moved, points)
    to_foot = points - surface_points(moved, feet[:, 0], feet[:, 1])
    away = np.linalg.norm(to_foot, axis=1)
    if away.max() > _NOT_ON_IT * length[-1]:
        k = int(away.argmax())
        x, y, z = points[k] + origin
        raise EdgeError(
            f"face: the edge is {away[k]:.3g} away from it at ({x:.5g}, {y:.5g}, {z:.5g}), expected an edge on it"
        )
    towards = own.into / np.maximum(np.linalg.norm(own.into, axis=1), 1e-300)[:, None] * (1 if same_side else -1)
    if np.linalg.norm(points[0] - points[-1]) > _SAME_POINT * length[-1]:
        # An end may lie on a knot line across the edge: the side of it is that of the edge.
        towards[0], towards[-1] = towards[0] + own.along[0], towards[-1] - own.along[-1]
    of_face = _face_jet(moved, feet, towards, order)
    normal, side = _normal(of_face), _normal(own.jet)
    # Of two ways to look at a surface that which agrees.
    side *= np.where(np.sum(side * normal, axis=1) < 0, -1.0, 1.0)[:, None]
    jets = [_in_frame(jet, own.along, n, order) for jet, n in ((own.jet, side), (of_face, normal))]
    sine = np.linalg.norm(np.cross(side, normal), axis=1)
    angle = np.degrees(np.arctan2(sine, np.sum(side * normal, axis=1)))
    values = {"gap": away, "angle_degrees": angle}
    if isinstance(face, FreeEdge):
        edge = face.moved(-origin)
        nearest, slope = edge.nearest(points)
        apart = points - nearest
        # An edge that touches the end of its surface is as far beyond it as it is off: that is no gap.
        at_end = _at_an_end(moved, feet)
        values["gap"] = np.where(at_end, np.abs(np.sum(to_foot * normal, axis=1)), away)
        values["off"] = np.linalg.norm(apart - np.sum(apart * normal, axis=1)[:, None] * normal, axis=1)
        # At a corner of the edge the nearest point may be on the part beyond: that it runs the same way holds for all.
        along = own.along * (1.0 if np.sum(slope * own.along) > 0 else -1.0)
        ahead = np.sum(np.cross(normal, along) * own.into, axis=1) * (1.0 if edge.keep == "left" else -1.0)
        values["angle_degrees"] = np.where((ahead > 0) == same_side, angle, 180.0 - angle)
    size = float(np.ptp(bounding_box(other), axis=0).max())
    values |= _curvature_jumps(jets, (side, normal), size, order)
    return Profile(own.s, points + origin, length, values)


@dataclass(frozen=True, eq=False)
class _Side:
    """One side of a contact at places along its edge: parameters, derivatives, unit tangents, and a way into it."""

    s: FloatArray
    jet: Jet
    along: FloatArray
    into: FloatArray


def _base_side(base: Base, order: int, origin: FloatArray) -> _Side:
    s = _places(base.breakpoints_along())
    at = edge_curves(base.surface, base.side, order, origin).points(s, order)
    return _Side(s, at, _unit(at[0, 1]), (1.0 if base.side[1] == "0" else -1.0) * at[1, 0])


def _edge_side(edge: FreeEdge, order: int) -> _Side:
    """Return the side of a face along an edge of it: at the feet of points of the edge."""
    s = _places(np.unique(edge.curve.knots))
    points, slope = edge.at(s)
    feet = surface_feet(edge.face, points)
    normal = _normal(_face_jet(edge.face, feet, np.zeros_like(points), 1))
    into = np.cross(normal, slope) * (1.0 if edge.keep == "left" else -1.0)
    # Beside a knot line derivatives are those of the kept side, and the points are still on the edge.
    jet = _face_jet(edge.face, feet, into, order) | {(0, 0): surface_points(edge.face, feet[:, 0], feet[:, 1])}
    return _Side(s, jet, _unit(slope), into)


def _at_an_end(face: BSplineSurface, feet: FloatArray) -> NDArray[np.bool_]:
    """Tell which feet lie at an end of the surface, shape (K,)."""
    return np.asarray((feet[:, :, None] == np.array(face.domain)).any(axis=(1, 2)))


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])


def _places(breaks: FloatArray) -> FloatArray:
    shares = (np.arange(_PER_SPAN) + 0.5) / _PER_SPAN
    inside = breaks[:-1, None] + np.diff(breaks)[:, None] * shares
    return np.concatenate([breaks[:1], inside.ravel(), breaks[-1:]])


def surface_feet(face: BSplineSurface, points: FloatArray) -> FloatArray:
    """Return the parameters of the feet of points on a face, shape (K, 2).

    Source: Gauss-Newton steps from the nearest of many points of the face, halved where they lead away.
    """
    grids = []
    for breaks in face.breakpoints:
        each = -(-_GRID // (len(breaks) - 1))
        # None at a border: from a pole no step leads away.
        grids.append((breaks[:-1, None] + np.diff(breaks)[:, None] * ((np.arange(each) + 0.5) / each)).ravel())
    u, v = (x.ravel() for x in np.meshgrid(*grids, indexing="ij"))
    nearest = KDTree(surface_points(face, u, v)).query(points)[1]
    at = np.stack([u[nearest], v[nearest]], axis=1)
    low, high = np.array(face.domain).T
    closed = _closed(face)
    distance = np.linalg.norm(points - surface_points(face, at[:, 0], at[:, 1]), axis=1)
    share = np.ones(len(at))
    for _ in range(_STEPS):
        s, t = surface_points(face, at[:, 0], at[:, 1], 1, 0), surface_points(face, at[:, 0], at[:, 1], 0, 1)
        away = points - surface_points(face, at[:, 0], at[:, 1])
        step = np.stack(_solved(s, t, away), axis=1)
        trial = at + share[:, None] * np.nan_to_num(step)
        trial = np.where(closed, low + np.mod(trial - low, high - low), np.clip(trial, low, high))
        found = np.linalg.norm(points - surface_points(face, trial[:, 0], trial[:, 1]), axis=1)
        closer = found <= distance
        at[closer], distance[closer] = trial[closer], found[closer]
        share = np.where(closer, 1.0, share / 2)
        if np.abs(step).max() <= 1e-15 * (high - low).max() or share.max() < 1e-6:
            break
    return at


def _closed(face: BSplineSurface) -> NDArray[np.bool_]:
    net = face.homogeneous
    largest = np.abs(net - net[0, 0]).max()
    away = [np.abs(net[0] - net[-1]).max(), np.abs(net[:, 0] - net[:, -1]).max()]
    return np.asarray(np.array(away) <= 1e-9 * largest)


def _solved(s: FloatArray, t: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return x, y with x s + y t = right, in the plane of s and t."""
    e, f, g = (np.sum(a * b, axis=1) for a, b in ((s, s), (s, t), (t, t)))
    a, b = np.sum(s * right, axis=1), np.sum(t * right, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        area = e * g - f * f
        return (g * a - f * b) / area, (e * b - f * a) / area


def _face_jet(face: BSplineSurface, feet: FloatArray, towards: FloatArray, order: int) -> OwnJet:
    """Return derivatives of the face at feet, of the side of a knot line that lies in a direction in space."""
    low, high = np.array(face.domain).T
    s, t = surface_points(face, feet[:, 0], feet[:, 1], 1, 0), surface_points(face, feet[:, 0], feet[:, 1], 0, 1)
    step = np.nan_to_num(np.stack(_solved(s, t, towards), axis=1))
    step *= _BESIDE / np.maximum(np.abs(step / (high - low)).max(axis=1), 1e-300)[:, None]
    # Elsewhere a step would only cost digits.
    lines = [breaks if closed else breaks[1:-1] for breaks, closed in zip(face.breakpoints, _closed(face), strict=True)]
    on_line = [
        np.abs(feet[:, d, None] - breaks).min(axis=1, initial=np.inf) <= 2 * _BESIDE * (high - low)[d]
        for d, breaks in enumerate(lines)
    ]
    step = np.where(np.stack(on_line, axis=1), step, 0.0)
    at = np.clip(feet + step, low, high)
    keys = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
    return {(i, j): surface_points(face, at[:, 0], at[:, 1], i, j) for i, j in keys}


def _normal(jet: Jet) -> FloatArray:
    cross = np.cross(jet[1, 0], jet[0, 1])
    length = np.linalg.norm(cross, axis=1)[:, None]
    return np.asarray(np.divide(cross, length, out=np.full_like(cross, np.nan), where=length > 0))


def _in_frame(jet: Jet, along: FloatArray, normal: FloatArray, order: int) -> OwnJet:
    """Return derivatives in parameters whose first derivatives are unit vectors across the edge and along it."""
    along = along - np.sum(along * normal, axis=1)[:, None] * normal
    along = along / np.linalg.norm(along, axis=1)[:, None]
    w, s = (_solved(jet[1, 0], jet[0, 1], x) for x in (np.cross(normal, along), along))
    found = {}
    for i, j in product(range(order + 1), repeat=2):
        if i + j > order:
            continue
        # A symmetric form of i steps across and j along.
        values = [jet[i + j - k, k] for k in range(i + j + 1)]
        for a, b in [w] * i + [s] * j:
            values = [a[:, None] * first + b[:, None] * second for first, second in pairwise(values)]
        found[i, j] = values[0]
    return found


def _curvature_jumps(
    sides: list[OwnJet], normals: tuple[FloatArray, FloatArray], size: float, order: int
) -> dict[str, FloatArray]:
    """Return what `FaceContact` holds of curvature and its rates, each of shape (K,)."""
    bends = [
        {key: np.sum(jet[key] * normal, axis=1) for key in ((2, 0), (1, 1), (0, 2))}
        for jet, normal in zip(sides, normals, strict=True)
    ]
    across = max(float(np.nanmax(np.abs(bends[1][2, 0]))), 1e-3 / size)
    largest = max(*(float(np.nanmax(np.abs(x))) for x in bends[1].values()), 1e-3 / size)
    scales = {(2, 0): across, (1, 1): largest, (0, 2): largest}
    jumps = [np.abs(bends[0][key] - bends[1][key]) / scale for key, scale in scales.items()]
    values = {"curvature_jump_relative": np.max(jumps, axis=0)}
    if order > 2:
        nothing = np.zeros((order + 1, order + 1))
        rates = [curvature_rates(jet, n, nothing, order).values for jet, n in zip(sides, normals, strict=True)]
        for k, name in enumerate(("rate_jump_relative", "second_rate_jump_relative")[: order - 2]):
            own, other = rates[0][k], rates[1][k]
            power = k + 2
            scale = max(float(np.nanmax(np.abs([own, other]))), largest**power, 1e-3 / size**power)
            values[name] = np.abs(own - other) / scale
    return values
