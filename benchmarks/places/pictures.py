"""Parts with their proposals marked: fillets green, chamfers blue, round ends yellow, gaps red, sharp edges black."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv

from semispline.solver.io import read_occ
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.place import Places

COLORS = {"fillet": "limegreen", "chamfer": "dodgerblue", "round end": "gold"}
VIEWS = ((1, -1.3, 0.8), (-1, 1.1, -0.9))
_DEFLECTION = 0.002


def draw(path: Path, graph: EdgeGraph, places: Places, target: Path) -> None:
    """Draw a part from two sides."""
    kinds = {
        face: place.kind
        for place in places.found
        if place.kind in COLORS
        for where in (place.where, *place.repeats)
        for face in where
    }
    plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1800, 900), border=False)
    meshes = _meshes(path, graph.size)
    for column, view in enumerate(VIEWS):
        plotter.subplot(0, column)
        for face, mesh in meshes.items():
            plotter.add_mesh(mesh, color=COLORS.get(kinds.get(face, ""), "lightgray"), smooth_shading=False)
        _edges(plotter, graph, places)
        chosen = [place for place in places.found if place.kind in COLORS]
        labels = [place.faces[0] for place in chosen if place.faces[0] in meshes]
        if labels:
            points = np.array([meshes[face].points[len(meshes[face].points) // 2] for face in labels])
            plotter.add_point_labels(points, [f"#{face}" for face in labels], font_size=14, always_visible=True)
        plotter.view_vector(view)
        plotter.enable_parallel_projection()
    plotter.screenshot(str(target))
    plotter.close()


def _edges(plotter: pv.Plotter, graph: EdgeGraph, places: Places) -> None:
    uses = graph.uses
    for k in range(len(uses)):
        if uses.pcurve[k] != "none" and not uses.degenerate[k] and k < 6000:
            plotter.add_mesh(pv.lines_from_points(uses.points[k]), color="dimgray", line_width=1)
    for place in places.of_kind("gap")[:12]:
        ends = []
        for side in (place.a, place.b):
            row = uses.of_face(side.face).start + int(side.edge[1:])
            plotter.add_mesh(pv.lines_from_points(uses.points[row]), color="red", line_width=5)
            ends.append(uses.points[row, 4])
        plotter.add_mesh(pv.Line(*ends), color="red", line_width=2)


def _meshes(path: Path, size: float) -> dict[int, pv.PolyData]:
    """Return a mesh of each face that the kernel can mesh."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopLoc import TopLoc_Location

    found = {}
    for number, item in enumerate(read_occ(path).faces):
        face = item.face  # type: ignore[attr-defined]
        BRepMesh_IncrementalMesh(face, _DEFLECTION * size, False, 0.3)
        location = TopLoc_Location()
        mesh = BRep_Tool.Triangulation_s(face, location)
        if mesh is None:
            continue
        points = [mesh.Node(i + 1).Transformed(location.Transformation()) for i in range(mesh.NbNodes())]
        corners = [mesh.Triangle(i + 1).Get() for i in range(mesh.NbTriangles())]
        faces = np.array([(3, a - 1, b - 1, c - 1) for a, b, c in corners]).ravel()
        found[number] = pv.PolyData(np.array([(p.X(), p.Y(), p.Z()) for p in points]), faces)
    return found
