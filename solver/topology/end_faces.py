"""The faces at both ends of a face that is replaced, on which the end curves of the blend have to lie."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending import EndFace
from semispline.solver.errors import EdgeError
from semispline.solver.io import read_surfaces
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineSurface, Surface, closest_point
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations

# Degrees: where an end edge is met at less the fillet goes on beyond it.
_GOES_ON = 2.0


def end_edges(graph: EdgeGraph, face: int, contacts: tuple[Sequence[int], Sequence[int]]) -> list[int]:
    """Return the uses of a face at the ends of its contacts; none where these are closed."""
    uses = graph.uses
    rows = range(*uses.of_face(face).indices(len(uses)))
    beside = {*contacts[0], *contacts[1]}
    return [row for row in rows if row not in beside and uses.twin[row] == NONE and not uses.seam[row]]


def going_on(graph: EdgeGraph, relations: Relations, ends: Sequence[int]) -> list[int]:
    """Return those ends of a face beyond which it goes on smoothly."""
    partner, median = relations.partner, relations.median
    return [row for row in ends if partner[row] != NONE and median[row] < _GOES_ON]


def check_ends(graph: EdgeGraph, relations: Relations, face: int, ends: Sequence[int]) -> None:
    """Refuse a face that goes on into others beyond its end edges.

    Raises
    ------
    EdgeError
        With the faces that belong together.
    """
    smooth = going_on(graph, relations, ends)
    if not smooth:
        return
    beyond = list(dict.fromkeys(int(graph.uses.face[relations.partner[row]]) for row in smooth))
    over = " and ".join(graph.uses.name(row) for row in smooth)
    which = "face" if len(beyond) == 1 else "faces"
    raise EdgeError(
        f"--replace {face}: it goes on into {which} {' and '.join(map(str, beyond))} over {over}: a blend that bends "
        "less than a round at its contacts cannot keep these edges, and the faces have to be replaced together; "
        "--surfaces writes the blend alone"
    )


def faces_at_ends(graph: EdgeGraph, relations: Relations, ends: Sequence[int]) -> list[tuple[FloatArray, int]]:
    """Return the points at which end edges begin and end, each with a use of the edge by the face beyond.

    Raises
    ------
    EdgeError
        No other face has the edge.
    """
    found = []
    for row in ends:
        partner = int(relations.partner[row])
        if partner == NONE:
            raise EdgeError(
                f"{graph.uses.name(row)} of {graph.path}#{graph.uses.face[row]}: no other face lies beyond this end of "
                "the fillet"
            )
        found += [(graph.uses.points[row, sample], partner) for sample in (0, -1)]
    return found


def ends_of_bases(
    graph: EdgeGraph, bases: Sequence[Base], at: Sequence[tuple[FloatArray, int]]
) -> list[tuple[EndFace, EndFace]]:
    """Return, for each base, the end faces where it starts and where it ends.

    Parameters
    ----------
    graph : EdgeGraph
    bases : sequence of Base
    at : sequence of (ndarray, int)
        Points near which bases end, and a use of an edge there by the face on which the end curve has to lie.
    """
    faces = list(dict.fromkeys(int(graph.uses.face[row]) for _, row in at))
    curved = [n for n in faces if graph.faces.kind[n] != "plane"]
    loaded = read_surfaces([f"{graph.path}#{n}" for n in curved]) if curved else []
    surfaces = {n: one.surface for n, one in zip(curved, loaded, strict=True)}
    places = np.array([point for point, _ in at])
    found = []
    for base in bases:
        own = []
        for point in base.derivative(np.array(base.range_along), 0, 0):
            row = at[int(np.linalg.norm(places - point, axis=1).argmin())][1]
            face = int(graph.uses.face[row])
            own.append(
                end_face_at(surfaces[face], point) if face in surfaces else EndFace.plane(graph.uses.normal[row, 0])
            )
        found.append((own[0], own[1]))
    return found


def end_face_at(surface: Surface, point: FloatArray) -> EndFace:
    """Return how a surface lies and bends near a point of it."""
    u, v = (np.array([x]) for x in np.ravel(closest_point(surface, point).parameters))
    shape = surface.to_bspline() if not isinstance(surface, BSplineSurface) else surface

    def derivative(a: int, b: int) -> FloatArray:
        return np.asarray(shape.evaluate(u, v, a, b)[0])

    tangents = np.stack([derivative(1, 0), derivative(0, 1)])
    normal = np.cross(*tangents)
    normal /= np.linalg.norm(normal)
    second = np.array([[derivative(2, 0), derivative(1, 1)], [derivative(1, 1), derivative(0, 2)]]) @ normal
    # Of a tangent vector x the components along S_u and S_v are dual . x.
    dual = np.linalg.pinv(tangents.T)
    return EndFace(normal, dual.T @ second @ dual)
