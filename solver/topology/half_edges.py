"""One record for each use of an edge by a face: a half-edge, sampled, with its neighbours.

All records of a file stand in one table of arrays, which one process can hand to another and which NumPy works on as
a whole. Rows are called *uses* here: the edge between two faces has two of them, a seam has two in one face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray

Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]
# Places along an edge at which it is sampled, at equal parameters, ends included. With 5 wrong fillets are found.
SAMPLES = 9
# Along the two directions of a table of neighbours: there is none.
NONE = -1


@dataclass(frozen=True, eq=False)
class Faces:
    """The faces of a file in the order of their numbers.

    Attributes
    ----------
    kind : tuple of str
        What the file holds, as `semispline list` says it.
    ends : ndarray, shape (F, 4)
        u0, u1, v0, v1 of the surface that is read out for the face, in the kernel's parameters (an angle on a
        cylinder); NaN where the face has no surface.
    reversed : ndarray of bool, shape (F,)
        The face looks against S_u x S_v.
    repeat : ndarray of int, shape (F,)
        The first face that is the same part of the file, perhaps at another place of an assembly.
    same : ndarray of int, shape (F,)
        The first face that is the same, at the same place: a file may name a face more than once.
    walked : ndarray of bool, shape (F,)
        The edges are numbered in walking order; False where the kernel could not walk round a wire.
    """

    kind: tuple[str, ...]
    ends: FloatArray
    reversed: Flags
    repeat: Integers
    same: Integers
    walked: Flags

    def __len__(self) -> int:
        return len(self.kind)


@dataclass(frozen=True, eq=False)
class Uses:
    """The uses of edges by faces: face by face, in the order of the names e0, e1, ..

    The N samples lie at equal parameters of the edge, and in its direction: those of both uses agree by index,
    whichever way their faces walk.

    Attributes
    ----------
    face, wire, number : ndarray of int, shape (U,)
        N of `PATH#N`; wire of the face, the outer one is 0; k of the name "ek".
    edge : ndarray of int, shape (U,)
        The same for all uses of one edge.
    reversed : ndarray of bool, shape (U,)
        The face walks the edge against its direction.
    seam, degenerate : ndarray of bool, shape (U,)
        On both sides of the edge lies this face; the edge is a point.
    parameters : ndarray, shape (U, 2)
        Range of the parameter of the edge.
    tolerance : ndarray, shape (U,)
        How far the edge in space may be from the face, as the file says; as was found where it does not say.
    uv, uv_slope : ndarray, shape (U, N, 2)
        The curve in the parameters of the surface, and its derivative by the parameter of the edge.
    pcurve : ndarray of str, shape (U,)
        Kind of that curve: "line", "B-spline", "Bezier", "circle", ..; "projected" where the file shows none and
        samples of the edge were projected; "none" where there is nothing to evaluate: then all samples are NaN.
    box : ndarray, shape (U, 2, 2)
        Least and greatest (u, v) of the curve: of its poles, which hold all of it, where `proven`, else of its
        samples.
    proven : ndarray of bool, shape (U,)
    points, normal, tangent, inward : ndarray, shape (U, N, 3)
        Points of the surface; outward normal of the face; unit tangent in walking direction; normal x tangent, which
        points into the face. Where the surface has no normal, as in a pole, that of the next sample.
    across, along : ndarray, shape (U, N)
        Normal curvature of the face across and along the edge, negative where it bends away from the normal.
    speed_u, speed_v : ndarray, shape (U, N)
        |S_u| and |S_v|.
    previous, following : ndarray of int, shape (U,)
        Neighbours in the wire, in walking order.
    other : ndarray of int, shape (U,)
        The one use of the edge by another face; -1 where there is none, or more than one.
    twin : ndarray of int, shape (U,)
        The other use of the edge in this face, as of a seam; -1 where there is none.
    naked : ndarray of bool, shape (U,)
        No other face, and not this one again, has the edge.
    """

    face: Integers
    wire: Integers
    number: Integers
    edge: Integers
    reversed: Flags
    seam: Flags
    degenerate: Flags
    parameters: FloatArray
    tolerance: FloatArray
    uv: FloatArray
    uv_slope: FloatArray
    pcurve: NDArray[np.str_]
    box: FloatArray
    proven: Flags
    points: FloatArray
    normal: FloatArray
    tangent: FloatArray
    inward: FloatArray
    across: FloatArray
    along: FloatArray
    speed_u: FloatArray
    speed_v: FloatArray
    previous: Integers
    following: Integers
    other: Integers
    twin: Integers
    naked: Flags

    def __len__(self) -> int:
        return len(self.face)

    def of_face(self, face: int) -> slice:
        """Return the rows of a face: row `start + k` is its edge ek."""
        first, last = np.searchsorted(self.face, [face, face + 1]).tolist()
        return slice(first, last)

    def name(self, use: int) -> str:
        """Return the name of a use within its face."""
        return f"e{self.number[use]}"

    def walked_points(self, use: int) -> FloatArray:
        """Return the samples in walking order, shape (N, 3)."""
        return self.points[use, ::-1] if self.reversed[use] else self.points[use]


@dataclass(frozen=True, eq=False)
class EdgeGraph:
    """Faces, edges and who is whose neighbour.

    Attributes
    ----------
    path : str
    unit : str or None
        Key of `MILLIMETRES`; None where the file does not say.
    faces : Faces
    uses : Uses
    others : dict
        What else the file holds: kind -> how many.
    """

    path: str
    unit: str | None
    faces: Faces
    uses: Uses
    others: dict[str, int]

    @cached_property
    def size(self) -> float:
        """Largest extent of the edges."""
        points = self.uses.points[self.uses.pcurve != "none"]
        return float(np.ptp(points.reshape(-1, 3), axis=0).max()) if len(points) else 0.0


def uses_of(faces: Faces, rows: Sequence[tuple[Any, ...]], records: Sequence[tuple[Any, ...]]) -> Uses:
    """Return the table of uses, with all that follows from what was read.

    Parameters
    ----------
    faces : Faces
    rows : sequence of tuple
        Of each use, face by face in walking order: face, wire, number, edge, reversed, seam, degenerate.
    records : sequence of tuple
        Of each: tolerance; kind of its curve in the parameters; whether its box is proven; range of the parameter; box
        as (u, v, u, v); of each sample (u, v, u', v'); of each sample S, S_u, S_v, S_uu, S_vv, S_uv.
    """
    numbers = np.array([row[:4] for row in rows], dtype=np.int64).reshape(-1, 4)
    flags = np.array([row[4:] for row in rows], dtype=bool).reshape(-1, 3)
    face, wire, number, edge = numbers.T
    turned, seam, degenerate = flags.T
    tolerance, kind, proven, parameters, box, uv, jet = zip(*records, strict=True) if records else [()] * 7
    plane = np.array(uv, dtype=np.float64).reshape(-1, SAMPLES, 4)
    surface = np.array(jet, dtype=np.float64).reshape(-1, SAMPLES, 6, 3)
    return Uses(
        face=face,
        wire=wire,
        number=number,
        edge=edge,
        reversed=turned,
        seam=seam,
        degenerate=degenerate,
        parameters=np.array(parameters, dtype=np.float64).reshape(-1, 2),
        tolerance=np.array(tolerance, dtype=np.float64),
        uv=plane[..., :2],
        uv_slope=plane[..., 2:],
        pcurve=np.array(kind, dtype="<U9"),
        box=np.array(box, dtype=np.float64).reshape(-1, 2, 2),
        proven=np.array(proven, dtype=bool),
        **shape_of(faces.reversed[face], turned, plane[..., 2:], surface),
        **neighbours(face, wire, edge, degenerate, faces.same),
    )


def shape_of(reversed_face: Flags, reversed_edge: Flags, uv_slope: FloatArray, jet: FloatArray) -> dict[str, Any]:
    """Return what `Uses` says of the surface along the edges.

    Parameters
    ----------
    reversed_face, reversed_edge : ndarray of bool, shape (U,)
    uv_slope : ndarray, shape (U, N, 2)
    jet : ndarray, shape (U, N, 6, 3)
        S, S_u, S_v, S_uu, S_vv, S_uv.
    """
    points, s_u, s_v, s_uu, s_vv, s_uv = np.moveaxis(jet, 2, 0)
    cross = np.cross(s_u, s_v)
    area = np.linalg.norm(cross, axis=-1)
    e, f, g = (np.sum(x * y, axis=-1) for x, y in ((s_u, s_u), (s_u, s_v), (s_v, s_v)))
    # In a pole one of the two vanishes, up to rounding.
    regular = area > 1e-9 * np.maximum(e, g).max(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = cross / area[..., None] * np.where(reversed_face, -1.0, 1.0)[:, None, None]
        slope = s_u * uv_slope[..., :1] + s_v * uv_slope[..., 1:]
        speed = np.linalg.norm(slope, axis=-1)
        tangent = slope / speed[..., None] * np.where(reversed_edge, -1.0, 1.0)[:, None, None]
    normal = _from_next(normal, regular)
    tangent = _from_next(tangent, speed > 1e-9 * speed.max(axis=1, initial=0.0, keepdims=True))
    inward = np.cross(normal, tangent)
    second = [np.sum(x * normal, axis=-1) for x in (s_uu, s_uv, s_vv)]

    def curvature(direction: FloatArray) -> FloatArray:
        a, b = np.sum(direction * s_u, axis=-1), np.sum(direction * s_v, axis=-1)
        with np.errstate(divide="ignore", invalid="ignore"):
            du, dv = (a * g - b * f) / area**2, (b * e - a * f) / area**2
        bent = second[0] * du**2 + 2 * second[1] * du * dv + second[2] * dv**2
        return _from_next(bent[..., None], regular)[..., 0]

    return {
        "points": points,
        "normal": normal,
        "tangent": tangent,
        "inward": inward,
        "across": curvature(inward),
        "along": curvature(tangent),
        "speed_u": np.sqrt(e),
        "speed_v": np.sqrt(g),
    }


def neighbours(face: Integers, wire: Integers, edge: Integers, degenerate: Flags, same: Integers) -> dict[str, Any]:
    """Return `previous`, `following`, `other`, `twin` and `naked` of `Uses`.

    Parameters
    ----------
    face, wire, edge, degenerate : ndarray, shape (U,)
        Uses face by face, wire by wire, in walking order.
    same : ndarray of int, shape (F,)
        As in `Faces`.
    """
    count = len(face)
    rows = np.arange(count)
    begins = np.flatnonzero(np.r_[True, (np.diff(face) != 0) | (np.diff(wire) != 0)]) if count else rows
    ends = np.r_[begins[1:], count] - 1 if count else rows
    previous, following = rows - 1, rows + 1
    previous[begins], following[ends] = ends, begins
    other, twin = np.full(count, NONE), np.full(count, NONE)
    naked = np.zeros(count, dtype=bool)
    order = np.argsort(edge, kind="stable")
    for uses in np.split(order, np.flatnonzero(np.diff(edge[order])) + 1):
        if len(uses) == 0 or degenerate[uses[0]]:
            continue
        naked[uses] = len(uses) == 1
        for use in uses.tolist():
            others = [x for x in uses.tolist() if same[face[x]] != same[face[use]]]
            # A face that the file names twice is one neighbour.
            if others and all(same[face[x]] == same[face[others[0]]] for x in others):
                once = [x for x in others if face[x] == face[others[0]]]
                other[use] = once[0] if len(once) == 1 else NONE
            here = [x for x in uses.tolist() if face[x] == face[use] and x != use]
            twin[use] = here[0] if len(here) == 1 else NONE
    return {"previous": previous, "following": following, "other": other, "twin": twin, "naked": naked}


def _from_next(values: FloatArray, good: Flags) -> FloatArray:
    """Replace values along axis 1 that are not good by those of the nearest good sample; none where none is."""
    if good.all():
        return values
    places = np.arange(good.shape[1])
    away = np.abs(places[:, None] - places) + np.where(good, 0, 4 * len(places))[:, None, :]
    found = np.take_along_axis(values, np.argmin(away, axis=2)[..., None], axis=1)
    has_any = np.asarray(good.any(axis=1))
    return np.where(has_any[:, None, None], found, 0.0)
