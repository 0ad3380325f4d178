"""What the process of its own does that reads a 3dm file: openNURBS's numbers as plain arrays.

It is started for every file, so it loads rhino3dm and NumPy and nothing else; `rhino` makes surfaces of the arrays.
Where one byte is wrong openNURBS asks for gigabytes; refused, it returns no file and does not say why.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import rhino3dm

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError
from semispline.solver.io.foreign import limits

# Degrees, knots in u and v, control points (n_u, n_v, 4) multiplied by their weights, and whether these count.
Net = tuple[int, int, FloatArray, FloatArray, FloatArray, bool]
# Degree, knots and control points (n, 4) multiplied by their weights.
Curve = tuple[int, FloatArray, FloatArray]
# Whether the face looks against its surface; loop by loop, the outer one first, of each trim in the order of the file:
# the edge (the same for all its trims in the file; -1 where it is a point), its place among the curves of the face, and
# whether the trim runs against it.
Trims = tuple[bool, list[list[tuple[int, int, bool]]]]
Found = tuple[str, Net | None, list[Curve] | None, Trims | None]
_SHAPES = {"plane": "IsPlanar", "cylinder": "IsCylinder", "cone": "IsCone", "sphere": "IsSphere", "torus": "IsTorus"}
# How far a surface may be from the shape after which it is called, in the unit of the file.
_SAME = 1e-9
_MAGIC = b"3D Geometry File Format"


def work(path: str) -> tuple[str, list[Found], dict[str, int]]:
    """Return the name of the unit, what `rhino.RhinoFace` takes of each surface, and what else the file holds.

    Raises
    ------
    FileError
        openNURBS cannot read the file.
    """
    try:
        file: Any = rhino3dm.File3dm.Read(path)
        if file is None:
            raise FileError(f"{path}: {_why_not(path)}")
        found: list[Found] = []
        edges = 0
        others: Counter[str] = Counter()
        for item in file.Objects:
            geometry = item.Geometry
            if isinstance(geometry, rhino3dm.Brep):
                found += [(_kind(surface), _net(surface), *of) for surface, of in _brep_surfaces(geometry, edges)]
                edges += len(cast(Any, geometry).Edges)
            elif isinstance(geometry, rhino3dm.Surface):
                found.append((_kind(geometry), _net(geometry), None, None))
            else:
                others["curve" if isinstance(geometry, rhino3dm.Curve) else _kind(geometry)] += 1
        return file.Settings.ModelUnitSystem.name, found, dict(others)
    except (FileError, MemoryError):
        raise
    except Exception as error:
        # openNURBS hands over what a damaged file holds; what comes of it has many classes.
        raise FileError(f"{path}: openNURBS cannot read it ({type(error).__name__}: {error})") from None


def _why_not(path: str) -> str:
    with open(path, "rb") as file:
        if not file.read(len(_MAGIC)).startswith(_MAGIC):
            return "not a 3dm file that openNURBS can read"
    return f"damaged: openNURBS cannot read it, at least not within {limits(path)[1]:.0f} MB of memory; save it anew"


def _kind(geometry: Any) -> str:
    """Return what the file holds, in words; of a surface in a Brep, which has no class of its own, what shape it is."""
    name = type(geometry).__name__
    if name == "Surface":
        return next((word for word, tell in _SHAPES.items() if getattr(geometry, tell)(_SAME)), "surface")
    words = {
        "NurbsSurface": "B-spline",
        "Extrusion": "extrusion",
        "PlaneSurface": "plane",
        "RevSurface": "revolution",
        "Mesh": "mesh",
        "Point": "point",
        "PointCloud": "point cloud",
        "NoneType": "object of unknown kind",
    }
    return words.get(name, name)


def _net(surface: Any) -> Net | None:
    """Return the arrays of its B-spline form; None where openNURBS knows none."""
    spline = surface.ToNurbsSurface()
    if spline is None:
        return None
    n_u, n_v = spline.Points.CountU, spline.Points.CountV
    points = [spline.Points[(i, j)] for i in range(n_u) for j in range(n_v)]
    net = np.array([(p.X, p.Y, p.Z, p.W) for p in points]).reshape(n_u, n_v, 4)
    knots = _with_ends(spline.KnotsU), _with_ends(spline.KnotsV)
    return (spline.Degree(0), spline.Degree(1), *knots, net, spline.IsRational)


def _with_ends(knots: Sequence[float]) -> FloatArray:
    """Return the full vector; the two knots that openNURBS leaves out take part in no span of the domain."""
    inner = [knots[i] for i in range(len(knots))]
    return np.array([inner[0], *inner, inner[-1]])


def _brep_surfaces(brep: Any, first_edge: int) -> list[tuple[Any, tuple[list[Curve] | None, Trims | None]]]:
    """Return surfaces of a Brep with the edges of the face that lies on each; they are numbered from `first_edge` on.

    rhino3dm does not say which face lies on which surface: they are matched by domain and by a few points.
    """
    faces = [brep.Faces[i] for i in range(len(brep.Faces))]
    waiting = {i: _fingerprint(face.UnderlyingSurface()) for i, face in enumerate(faces)}
    found: list[tuple[Any, tuple[list[Curve] | None, Trims | None]]] = []
    for k in range(len(brep.Surfaces)):
        surface = brep.Surfaces[k]
        wanted = _fingerprint(surface)
        match = next((i for i, other in waiting.items() if other == wanted), None)
        of: tuple[list[Curve] | None, Trims | None] = (None, None)
        if match is not None:
            del waiting[match]
            of = _edge_curves(brep, faces[match]), _trims(faces[match], first_edge)
        found.append((surface, of))
    return found


def _fingerprint(surface: Any) -> tuple[float, ...]:
    u, v = surface.Domain(0), surface.Domain(1)
    points = [surface.PointAt(u.T0 + s * (u.T1 - u.T0), v.T0 + t * (v.T1 - v.T0)) for s, t in ((0.2, 0.3), (0.7, 0.6))]
    return (u.T0, u.T1, v.T0, v.T1, *(c for p in points for c in (p.X, p.Y, p.Z)))


def _trims(face: Any, first_edge: int) -> Trims:
    numbers = _edge_numbers(face)
    loops = [face.Loops[i] for i in range(len(face.Loops))]
    loops.sort(key=lambda loop: loop.LoopType != cast(Any, rhino3dm).BrepLoopType.Outer)
    return face.OrientationIsReversed, [
        [
            (-1, -1, False)
            if trim.EdgeIndex < 0
            else (first_edge + trim.EdgeIndex, numbers.index(trim.EdgeIndex), trim.IsReversed)
            for trim in (loop.Trims[k] for k in range(len(loop.Trims)))
        ]
        for loop in loops
    ]


def _edge_numbers(face: Any) -> list[int]:
    # A trim along a singular side has no edge; a seam has two trims.
    trims = [face.Loops[i].Trims for i in range(len(face.Loops))]
    return sorted({loop[k].EdgeIndex for loop in trims for k in range(len(loop))} - {-1})


def _edge_curves(brep: Any, face: Any) -> list[Curve]:
    curves = []
    for number in _edge_numbers(face):
        curve = brep.Edges[number].ToNurbsCurve()
        net = [curve.Points[i] for i in range(len(curve.Points))]
        points = np.array([(p.X, p.Y, p.Z, p.W) for p in net])
        curves.append((curve.Degree, _with_ends(curve.Knots), points))
    return curves
