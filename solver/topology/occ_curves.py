"""What the process of its own does that reads edges of a face as curves: it hands over plain arrays."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError, InputError
from semispline.solver.io import read_occ
from semispline.solver.splines import BSplineCurve, BSplineSurface
from semispline.solver.topology.face_curves import parameters_on, spread
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.occ_edges import wires

# Kinds whose parameters are the file's own.
_OWN_PARAMETERS = ("B-spline", "Bezier")
# A pcurve is taken over to other parameters through so many points.
_PLACES, _DEGREE = 400, 5
# Of a period: a range that misses it by less is a whole turn.
_TURN = 1e-8
# Arguments of `BSplineCurve`.
Content = tuple[int, FloatArray, FloatArray, FloatArray | None]


def work(path: str, *asked: str) -> tuple[str | None, list[Any]]:
    """Return the unit, and for each "FACE NUMBER" what `TrimCurve` holds of it, or what is wrong with it."""
    model = read_occ(path)
    wanted = [tuple(map(int, text.split())) for text in asked]
    found: dict[tuple[int, ...], Any] = {}
    for face in dict.fromkeys(face for face, _ in wanted):
        numbers = [number for other, number in wanted if other == face]
        if not 0 <= face < len(model.faces):
            content: Any = FileError(f"{path}#{face}: the file has {len(model.faces)} faces, counted from 0")
            curves = [content] * len(numbers)
        else:
            try:
                content, curves = face_curves(model.faces[face], numbers)
            except InputError as error:
                curves = [error] * len(numbers)
        for number, curve in zip(numbers, curves, strict=True):
            found[face, number] = (content, *curve) if isinstance(curve, tuple) else curve
    return model.unit, [found[key] for key in wanted]


def face_curves(item: Any, numbers: list[int]) -> tuple[tuple[Any, ...], list[Any]]:
    """Return arguments of the surface of an `OccFace`, and of each of its edges what `edge_curve` returns.

    Raises
    ------
    FileError
        The surface cannot be read out.
    """
    surface = item.surface()
    edges = [edge for wire, _ in wires(item.face) for edge in wire]
    found: list[Any] = []
    for number in numbers:
        if not 0 <= number < len(edges):
            found.append(f"the face has {len(edges)} edges, e0 to e{len(edges) - 1}")
            continue
        try:
            found.append(edge_curve(edges[number], item.face, surface if item.kind not in _OWN_PARAMETERS else None))
        except Exception as error:
            # Each failure of the kernel has a class of its own.
            found.append(f"Open CASCADE cannot convert it ({str(error).strip() or type(error).__name__})")
    content = (
        surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, surface.control_points, surface.weights
    )  # fmt: skip
    return content, found


def edge_curve(
    edge: Any, face: Any, converted: BSplineSurface | None
) -> tuple[Content | None, Content | None, str, float] | str:
    """Return the edge in space, its pcurve, the side of the face, the tolerance; or what is wrong with it.

    Where the surface is a converted one, with other parameters than the file's, the pcurve is taken over.
    """
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
    from OCP.Geom import Geom_BSplineCurve, Geom_TrimmedCurve
    from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_TrimmedCurve
    from OCP.Geom2dConvert import Geom2dConvert
    from OCP.GeomConvert import GeomConvert
    from OCP.TopAbs import TopAbs_Orientation

    if BRep_Tool.Degenerated_s(edge):
        return "it is a point; choose another edge"
    geometry = BRep_Tool.Curve_s(edge, 0.0, 0.0)
    in_space: Content | None = None
    if geometry is not None:
        adaptor = BRepAdaptor_Curve(edge)
        cut = Geom_TrimmedCurve(geometry, *_range(geometry, adaptor, Geom_BSplineCurve))
        in_space = _content(GeomConvert.CurveToBSplineCurve_s(cut), lambda p: (p.X(), p.Y(), p.Z()))
    flat = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0)
    pcurve: Content | None = None
    if flat is not None:
        plane = BRepAdaptor_Curve2d(edge, face)
        flat = Geom2d_TrimmedCurve(flat, *_range(flat, plane, Geom2d_BSplineCurve))
        pcurve = _content(Geom2dConvert.CurveToBSplineCurve_s(flat), lambda p: (p.X(), p.Y()))
        if converted is not None:
            pcurve = _taken_over(pcurve, face, converted)
    elif in_space is None:
        return "it has no curve, neither in space nor in the parameters of the face"
    turned = TopAbs_Orientation.TopAbs_REVERSED
    # The face lies left of an edge that runs forward in a face taken forward, and each reversal swaps the sides.
    keep = "left" if (edge.Orientation() == turned) == (face.Orientation() == turned) else "right"
    return in_space, pcurve, keep, BRep_Tool.Tolerance_s(edge)


def _range(curve: Any, adaptor: Any, periodic: Any) -> tuple[float, float]:
    """Return the range of an edge on its curve; a whole turn of a periodic spline to the last digit.

    The kernel cuts a spline that is a rounding short of a turn at the wrong knot: its last pieces are lost.
    """
    first, last = adaptor.FirstParameter(), adaptor.LastParameter()
    if not isinstance(curve, periodic) or not curve.IsPeriodic():
        return first, last
    start, end = curve.FirstParameter(), curve.LastParameter()
    near = _TURN * (end - start)
    if abs(last - first - (end - start)) > near:
        return first, last
    return (start, end) if abs(first - start) <= near else (first, first + (end - start))


def _taken_over(pcurve: Content, face: Any, converted: BSplineSurface) -> Content:
    """Return a curve in the parameters of a converted surface, through the feet of many of its points.

    Each piece between corners has points of its own: what goes through a corner would swing.
    """
    from OCP.BRepAdaptor import BRepAdaptor_Surface

    curve, surface = BSplineCurve(*pcurve), BRepAdaptor_Surface(face, False)
    breaks, counts = np.unique(curve.knots, return_counts=True)
    x = spread(breaks, _PLACES, _DEGREE + 1)
    points = [surface.Value(float(s), float(t)) for s, t, _ in curve.evaluate(x)]
    at = parameters_on(Face(converted), np.array([(p.X(), p.Y(), p.Z()) for p in points]))
    # Can wait: few surfaces are converted to others.
    from scipy.interpolate import make_interp_spline

    ends = np.searchsorted(x, breaks[counts >= curve.degree])
    parts = [make_interp_spline(x[i : j + 1], at[i : j + 1], _DEGREE) for i, j in pairwise(ends)]
    # One spline of them all: where two meet there is one point.
    knots = [*(part.t[: -_DEGREE - 1][k > 0 :] for k, part in enumerate(parts)), parts[-1].t[-_DEGREE - 1 :]]
    net = [part.c[k > 0 :] for k, part in enumerate(parts)]
    return _DEGREE, np.concatenate(knots), np.concatenate(net), None


def _content(spline: Any, coordinates: Any) -> Content:
    if spline.IsPeriodic():
        spline.SetNotPeriodic()
    indices = range(1, spline.NbKnots() + 1)
    knots = np.repeat([spline.Knot(i) for i in indices], [spline.Multiplicity(i) for i in indices])
    n = spline.NbPoles()
    points = np.array([coordinates(spline.Pole(i + 1)) for i in range(n)])
    weights = np.array([spline.Weight(i + 1) for i in range(n)]) if spline.IsRational() else None
    return spline.Degree(), knots, points, weights
