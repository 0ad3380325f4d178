"""What the process of its own does that reads a STEP, IGES or BREP file to draw it: trimmed faces in triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import InputError
from semispline.solver.io import converted_parameters, read_occ
from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.face_meshes import EdgeLine, FaceMesh
from semispline.solver.topology.occ_edges import wires

# The triangles keep to the face within this fraction of the part's diagonal, and turn by no more than this, in radians.
_DEFLECTION, _TURN = 2e-4, 0.1
# Points on an edge that bounds no triangles.
_ON_EDGE = 48


def work(path: str, how: Literal["trimmed", "whole"], *numbers: str) -> tuple[Any, ...]:
    """Return the unit, how many faces there are, and of some or all what `drawn_faces` takes: a mesh where trimmed."""
    model = read_occ(path)
    chosen = [int(n) for n in numbers if int(n) < len(model.faces)] if numbers else range(len(model.faces))
    faces: list[Any] = [model.faces[n] for n in chosen]
    if how == "trimmed":
        mesh_faces([face.face for face in faces])
    found = [(n, face.kind, *_drawn(face, how)) for n, face in zip(chosen, faces, strict=True)]
    return model.unit, len(model.faces), dict(model.others), found


def mesh_faces(faces: Sequence[Any]) -> None:
    """Have the kernel mesh faces, edges that they share alike."""
    from OCP.Bnd import Bnd_Box
    from OCP.BRep import BRep_Builder
    from OCP.BRepBndLib import BRepBndLib
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools
    from OCP.TopoDS import TopoDS_Compound

    shape, builder, box = TopoDS_Compound(), BRep_Builder(), Bnd_Box()
    builder.MakeCompound(shape)
    for face in faces:
        builder.Add(shape, face)
    # A mesh that the file holds may be as coarse as can be.
    BRepTools.Clean_s(shape)
    BRepBndLib.Add_s(shape, box)
    diagonal = 1.0 if box.IsVoid() else float(np.sqrt(box.SquareExtent()))
    BRepMesh_IncrementalMesh(shape, _DEFLECTION * diagonal, False, _TURN, False)


def _drawn(item: Any, how: str) -> tuple[Any, ...]:
    """Return arguments of the surface or the error, how far it is off, mesh or None, and edges of an `OccFace`."""
    try:
        surface = item.surface()
    except InputError as error:
        return error, None, None, ()
    content = (
        surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, surface.control_points, surface.weights
    )  # fmt: skip
    mesh = None
    if how == "trimmed":
        try:
            mesh = face_mesh(item, surface)
        except Exception:
            # Each failure of the kernel has a class of its own.
            mesh = None
    return content, item.deviation(), mesh, edge_lines(item)


def face_mesh(item: Any, surface: BSplineSurface) -> FaceMesh | None:
    """Return the triangles of a meshed `OccFace` in the parameters of the surface read out for it; None without."""
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    found = BRep_Tool.Triangulation_s(item.face, TopLoc_Location())
    if found is None or not found.HasUVNodes() or not found.NbTriangles():
        return None
    nodes = np.array([found.UVNode(k + 1).Coord() for k in range(found.NbNodes())])
    triangles = np.array([found.Triangle(k + 1).Get() for k in range(found.NbTriangles())]) - 1
    closed = Face(surface).closed
    own = []
    for axis in range(2):
        first, last = item.ends[2 * axis : 2 * axis + 2]
        x = _in_range(nodes[:, axis], first, last)
        turned = nodes[:, axis] - x if closed[axis] else 0.0
        start = surface.domain[axis][0]
        # An end is the same number on both, or both are counted from it.
        values = converted_parameters(item.parameter_kinds[axis], surface.breakpoints[axis], x - first + start)
        own.append(values + turned)
    return FaceMesh(np.stack(own, axis=1), triangles)


def _in_range(x: FloatArray, first: float, last: float) -> FloatArray:
    near = 1e-9 * (last - first)
    beyond = (x < first - near) | (x > last + near)
    return np.clip(np.where(beyond, first + np.mod(x - first, last - first), x), first, last)


def edge_lines(item: Any) -> tuple[EdgeLine, ...]:
    """Return the edges of an `OccFace`, those of its triangles where it has some; points have a number, and no line."""
    found, k = [], 0
    for edges, _ in wires(item.face):
        for edge in edges:
            try:
                points = _points(edge, item.face)
            except Exception:
                # Each failure of the kernel has a class of its own: the edge has no curve.
                points = None
            if points is not None:
                found.append(EdgeLine(f"e{k}", points))
            k += 1
    return tuple(found)


def _points(edge: Any, face: Any) -> FloatArray | None:
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.TopLoc import TopLoc_Location

    if BRep_Tool.Degenerated_s(edge):
        return None
    here = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, here)
    along = None if mesh is None else BRep_Tool.PolygonOnTriangulation_s(edge, mesh, here)
    if mesh is not None and along is not None:
        placed = here.Transformation()
        nodes = (mesh.Node(along.Node(k + 1)).Transformed(placed) for k in range(along.NbNodes()))
        return np.array([node.Coord() for node in nodes])
    curve = BRepAdaptor_Curve(edge, face)
    at = np.linspace(curve.FirstParameter(), curve.LastParameter(), _ON_EDGE)
    return np.array([curve.Value(float(t)).Coord() for t in at])
