"""Planar faces at the ends of bars: the edges of their outlines, as the walls beyond have them."""

from __future__ import annotations

from semispline.solver.errors import EdgeError
from semispline.solver.topology.face_edges import check_face
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import relate


def outline_of(graph: EdgeGraph, face: int, name: str) -> str:
    """Return the word for all edges of the outline of a planar face, as the faces beyond have them.

    Parameters
    ----------
    graph : EdgeGraph
    face : int
    name : str
        What messages call the face.

    Raises
    ------
    EdgeError
        The face is not planar, has holes, or is no end of a bar: beyond an edge there is no one face, or it is no sharp
        outer edge.
    """
    check_face(graph, face, graph.path)
    title = f"{name} {graph.path}#{face}"
    if graph.faces.kind[face] != "plane":
        raise EdgeError(f"{title}: found a {graph.faces.kind[face]}, expected a planar face")
    uses, relations = graph.uses, relate(graph)
    rows = list(range(*uses.of_face(face).indices(len(uses))))
    wires = len(set(uses.wire[rows].tolist()))
    if wires != 1:
        raise EdgeError(
            f"{title}: found a face with {wires} outlines, expected one: with a hole in it the solid would not close; "
            "fill the hole, or blend outer and inner walls as surfaces"
        )
    words = []
    for row in rows:
        edge, beyond = uses.name(row), int(relations.partner[row])
        if beyond == NONE or relations.matched[row] or uses.face[beyond] == face:
            raise EdgeError(f"{title}: beyond its edge {edge} lies no other face of a solid, expected a wall")
        if not relations.sharp[row]:
            raise EdgeError(
                f"{title}: it goes on smoothly into face {uses.face[beyond]} over {edge} (angle "
                f"{relations.median[row]:.2g} degrees), expected a wall that leaves it sharply; name the flat face "
                "before its edges were rounded"
            )
        if not relations.convex[row]:
            raise EdgeError(
                f"{title}: its edge {edge} is an inner one, expected the end of a bar, where the blend goes on outwards"
            )
        words.append(f"{uses.face[beyond]}:{uses.name(beyond)}")
    return "+".join(words)
