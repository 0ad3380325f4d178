"""Parts made by Open CASCADE for tests of edges and places, and their tables without a file."""

from pathlib import Path

from OCP.BRepTools import BRepTools

from semispline.solver.io.occ import OccFace, _faces
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.occ_edges import edge_tables


def graph_of(shape, path="part.brep"):
    """The edges of a shape that stands in memory."""
    faces = [OccFace(face, f"{path}#{n}") for n, face in enumerate(_faces(shape))]
    return EdgeGraph(path, None, *edge_tables(faces), {})


def written(shape, path: Path):
    BRepTools.Write_s(shape, str(path))
    return path
