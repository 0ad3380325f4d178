"""`BRepOffsetAPI_MakeFilling` of Open CASCADE (the extra `cad`): a plate through four edges, tangent to both bases.

The two side edges are cubic Hermite curves with the natural cross derivatives at the four corners, so that they leave
both bases tangentially. The result is a trimmed piece of a plate in parameters of its own: it gets parameters over the
unit square by a Coons map of its four edges, so that it is measured like the others.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import lru_cache
from itertools import product
from math import comb
from typing import Any, TypeAlias

import numpy as np

from semispline.papers.baselines.contacts import ContactSide, contact_sides
from semispline.papers.baselines.interface import BlendTask, FormulaSurface, Method, NotApplicableError, Outcome
from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError
from semispline.solver.io import occ_surface, require_kernel
from semispline.solver.splines import BSplineSurface, Jet, interpolate_grid, surface_jet

# (u, v, du, dv) -> shape (K, 3)
Evaluation: TypeAlias = Callable[[FloatArray, FloatArray, int, int], FloatArray]

_ALONG, _ACROSS = 97, 33
_STEPS = 40
# The highest derivatives that a FormulaSurface is asked for.
_HIGHEST = 3


def blend_filling(task: BlendTask) -> Outcome:
    """Fill the gap with Open CASCADE; G1, since G2 raises in this kernel.

    Raises
    ------
    NotApplicableError
        Open CASCADE is not installed, the contact curves are closed, or the filling failed.
    """
    if task.closed:
        raise NotApplicableError("contact curves: closed, but a filling has one outer boundary")
    a, b = contact_sides(task)
    try:
        require_kernel("MakeFilling")
    except FileError as error:
        raise NotApplicableError(str(error)) from None
    plate, seconds = _plate(a, b)
    surface = _on_unit_square(plate, a, b)
    note = "a trimmed plate, its own parameters replaced by a Coons map; energy (11) is in those"
    return Outcome(surface, plate.n_control_points, None, seconds, note=note)


def side_curves(a: ContactSide, b: ContactSide) -> FloatArray:
    """Return Bezier control points of the two side edges, shape (2, 4, 3)."""
    ends = np.array(a.surface.domain[1])
    first, second = ((side.derivatives(ends, 0), side.derivatives(ends, 1) * side.natural / 3) for side in (a, b))
    return np.stack([first[0], first[0] + first[1], second[0] + second[1], second[0]], axis=1)


def _plate(a: ContactSide, b: ContactSide) -> tuple[BSplineSurface, float]:
    """Return the plate, larger than the blend, and the time that it took, imports aside."""
    # An extra, which need not be installed, and takes a second to load.
    from OCP.BRep import BRep_Tool
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
    from OCP.BRepLib import BRepLib
    from OCP.BRepOffsetAPI import BRepOffsetAPI_MakeFilling
    from OCP.collections import Array1_gp_Pnt
    from OCP.Geom import Geom_BezierCurve
    from OCP.Geom2d import Geom2d_Line
    from OCP.GeomAbs import GeomAbs_C0, GeomAbs_G1
    from OCP.gp import gp_Dir2d, gp_Pnt, gp_Pnt2d
    from OCP.TopAbs import TopAbs_FACE
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    started = time.perf_counter()
    filling = BRepOffsetAPI_MakeFilling()
    for side in (a, b):
        geometry = occ_surface(side.surface)
        face = BRepBuilderAPI_MakeFace(geometry, 1e-7).Face()
        line = Geom2d_Line(gp_Pnt2d(side.surface.domain[0][0], 0.0), gp_Dir2d(0.0, 1.0))
        edge = BRepBuilderAPI_MakeEdge(line, geometry, *side.surface.domain[1]).Edge()
        BRepLib.BuildCurves3d_s(edge)
        filling.Add(edge, face, GeomAbs_G1, True)
    for curve in side_curves(a, b):
        poles = Array1_gp_Pnt(1, len(curve))
        for i, point in enumerate(curve.tolist(), start=1):
            poles.SetValue(i, gp_Pnt(*point))
        filling.Add(BRepBuilderAPI_MakeEdge(Geom_BezierCurve(poles)).Edge(), GeomAbs_C0, True)
    try:
        filling.Build()
    except Exception as error:
        raise NotApplicableError(f"Open CASCADE cannot fill the gap: {str(error).splitlines()[0]}") from None
    if not filling.IsDone():
        raise NotApplicableError("Open CASCADE cannot fill the gap")
    face = TopoDS.Face(TopExp_Explorer(filling.Shape(), TopAbs_FACE).Current())
    return _read_out(BRep_Tool.Surface_s(face)), time.perf_counter() - started


def _read_out(spline: Any) -> BSplineSurface:
    points = [
        [(p.X(), p.Y(), p.Z()) for p in (spline.Pole(i + 1, j + 1) for j in range(spline.NbVPoles()))]
        for i in range(spline.NbUPoles())
    ]
    knots = [
        np.repeat([knot(i + 1) for i in range(count)], [multiplicity(i + 1) for i in range(count)])
        for count, knot, multiplicity in (
            (spline.NbUKnots(), spline.UKnot, spline.UMultiplicity),
            (spline.NbVKnots(), spline.VKnot, spline.VMultiplicity),
        )
    ]
    return BSplineSurface(spline.UDegree(), spline.VDegree(), knots[0], knots[1], np.array(points))


def _on_unit_square(plate: BSplineSurface, a: ContactSide, b: ContactSide) -> FormulaSurface:
    """Return the part of the plate between its four edges, over [0, 1] x the v-domain of a's edge."""
    start, end = a.surface.domain[1]
    v = start + (end - start) * np.linspace(0, 1, _ALONG)
    u = np.linspace(0, 1, _ACROSS)
    bernstein = np.stack([comb(3, i) * u**i * (1 - u) ** (3 - i) for i in range(4)], axis=1)
    contacts = [closest_parameters(plate, side.derivatives(v, 0)) for side in (a, b)]
    sides = [closest_parameters(plate, bernstein @ curve) for curve in side_curves(a, b)]
    s = ((v - start) / (end - start))[None, :, None]
    t = u[:, None, None]
    net = (1 - t) * contacts[0][None] + t * contacts[1][None] + (1 - s) * sides[0][:, None] + s * sides[1][:, None]
    corners = [[contacts[0][0], contacts[0][-1]], [contacts[1][0], contacts[1][-1]]]
    for i, across in enumerate((1 - t, t)):
        for j, along in enumerate((1 - s, s)):
            net = net - across * along * corners[i][j]
    flat = np.concatenate([net, np.zeros((*net.shape[:2], 1))], axis=2)
    parameters = interpolate_grid(flat, u=u, v=v)

    # The plate knows nothing of the knots of the contacts: a few smooth pieces are enough.
    at = _composed(plate, parameters)
    return FormulaSurface(at, np.linspace(0, 1, 5), np.linspace(start, end, 25))


def _composed(plate: BSplineSurface, parameters: BSplineSurface) -> Evaluation:
    """Return plate(parameters(x, y)) and its derivatives, by the chain rule: a term for each way to part directions."""
    (p0, p1), (q0, q1) = plate.domain

    # Who measures asks for one derivative after the other at the same points.
    @lru_cache(maxsize=4)
    def jets(x: bytes, y: bytes) -> tuple[Jet, Jet]:
        inner = surface_jet(parameters, np.frombuffer(x), np.frombuffer(y), _HIGHEST)
        p, q = inner[0, 0][:, :2].T
        # A foot point on an edge of the plate's domain may be off by rounding.
        return inner, surface_jet(plate, np.clip(p, p0, p1), np.clip(q, q0, q1), _HIGHEST)

    def at(x: FloatArray, y: FloatArray, du: int, dv: int) -> FloatArray:
        inner, of_plate = jets(x.tobytes(), y.tobytes())
        total = np.zeros((len(x), 3))
        for groups in partitions("u" * du + "v" * dv):
            parts = [inner[group.count("u"), group.count("v")] for group in groups]
            for axes in product((0, 1), repeat=len(groups)):
                factor = np.prod([part[:, axis] for part, axis in zip(parts, axes, strict=True)], axis=0)
                total += factor[..., None] * of_plate[axes.count(0), axes.count(1)]
        return total

    return at


def partitions(letters: str) -> list[list[str]]:
    """Return all ways to part letters into groups.

    Examples
    --------
    >>> partitions("uv")
    [['uv'], ['u', 'v']]
    """
    if not letters:
        return [[]]
    found = []
    for rest in partitions(letters[1:]):
        found += [[*rest[:i], letters[0] + group, *rest[i + 1 :]] for i, group in enumerate(rest)]
        found.append([letters[0], *rest])
    return found


def closest_parameters(surface: BSplineSurface, points: FloatArray) -> FloatArray:
    """Return (u, v) of the closest points of a surface, shape (K, 2): the best of a grid, then Gauss-Newton."""
    low, high = (np.array(x) for x in zip(*surface.domain, strict=True))
    grid = [np.linspace(low[i], high[i], 101) for i in range(2)]
    net = surface.evaluate_grid(grid[0], grid[1]).reshape(-1, 3)
    nearest = np.array([np.argmin(np.sum((net - p) ** 2, axis=1)) for p in points])
    x = np.stack([grid[0][nearest // 101], grid[1][nearest % 101]], axis=1)
    for _ in range(_STEPS):
        away = points - surface.evaluate(x[:, 0], x[:, 1])
        jacobian = np.stack([surface.evaluate(x[:, 0], x[:, 1], *d) for d in ((1, 0), (0, 1))], axis=2)
        normal = np.einsum("kdi,kdj->kij", jacobian, jacobian)
        step = np.linalg.solve(normal, np.einsum("kdi,kd->ki", jacobian, away)[..., None])[..., 0]
        x = np.clip(x + step, low, high)
        if np.abs(step).max() < 1e-14 * (high - low).max():
            break
    return x


METHODS = (
    Method(
        "open-cascade-filling",
        "Open CASCADE MakeFilling, G1",
        "`BRepOffsetAPI_MakeFilling` with its defaults",
        70,
        blend_filling,
    ),
)
