"""The edges of a shape in a table, for the gate: who uses them, where they are, their tolerances and gaps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.occ_edges import wires
from semispline.solver.topology.occ_shapes import (
    cast,
    ends,
    feet,
    forward,
    parameters_of,
    parts,
    point_of,
    points_of,
    range_of,
    surface_at,
    tolerance_of,
)

# Places along an edge at which its gap is measured.
_PLACES = 65


@dataclass(frozen=True)
class Border:
    """An edge of a new face.

    Attributes
    ----------
    name : str
        "12:e3".
    beyond : int
        The other face, by its number after.
    length, tolerance, gap : float
        The gap is how far the new face's border is from the surface beyond.
    was : float or None
        The tolerance of the edge that was there before.
    allowed : float
        What the tolerance may be.
    is_plane : bool
        The face beyond is one.
    at : (float, float, float)
        Where the gap is largest.
    """

    name: str
    beyond: int
    length: float
    tolerance: float
    gap: float
    was: float | None
    allowed: float
    is_plane: bool
    at: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class EdgeTable:
    """The edges of a shape that are no points.

    Attributes
    ----------
    edges : list of TopoDS_Edge
    names : list of str
        As the first face that uses them has them.
    faces : list of tuple of int
        The numbers of the faces that use each.
    uses : list of tuple of int
        Of each: 1 for a use in its own direction, -1 against it, 0 for one that bounds nothing; sorted.
    places : ndarray, shape (E, 3, 3)
        Start, middle and end.
    tolerance : list of float
    """

    edges: list[Any]
    names: list[str]
    faces: list[tuple[int, ...]]
    uses: list[tuple[int, ...]]
    places: FloatArray
    tolerance: list[float]

    @classmethod
    def of(cls, shape: Any, first: int = 0) -> EdgeTable:
        """Return the table of a shape, of which the first face is called by a number."""
        from OCP.BRep import BRep_Tool
        from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher
        from OCP.TopAbs import TopAbs_Orientation

        ids = IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher()
        signs = {TopAbs_Orientation.TopAbs_FORWARD: 1, TopAbs_Orientation.TopAbs_REVERSED: -1}
        edges: list[Any] = []
        names: list[str] = []
        faces: list[list[int]] = []
        uses: list[list[int]] = []
        for number, face in enumerate(parts(shape, "FACE")):
            walked = [edge for edges_of_wire, _ in wires(face) for edge in edges_of_wire]
            for k, edge in enumerate(walked):
                if BRep_Tool.Degenerated_s(edge):
                    continue
                at = ids.Add(edge) - 1
                if at == len(edges):
                    edges.append(forward(edge))
                    names.append(f"{first + number}:e{k}")
                    faces.append([])
                    uses.append([])
                faces[at].append(number)
                uses[at].append(signs.get(edge.Orientation(), 0))
        places = [points_of(edge, np.linspace(*range_of(edge), 3)) for edge in edges]
        return cls(
            edges,
            names,
            [tuple(dict.fromkeys(x)) for x in faces],
            [tuple(sorted(x)) for x in uses],
            np.array(places).reshape(-1, 3, 3),
            [tolerance_of(edge) for edge in edges],
        )

    @property
    def middles(self) -> FloatArray:
        """Points in the middle of each."""
        return self.places[:, 1]

    def loose(self) -> list[int]:
        """Return the edges that do not lie between two faces that agree on what is outside."""
        return [k for k, uses in enumerate(self.uses) if uses != (-1, 1)]

    def matching(self, others: EdgeTable, within: float) -> list[int | None]:
        """Return for each of other edges the one of these that has the same ends and the same middle."""
        found: list[int | None] = []
        for places in others.places:
            away = [np.linalg.norm(self.places - x, axis=2).max(axis=1) for x in (places, places[::-1])]
            least = np.minimum(*away)
            best = int(least.argmin()) if len(least) else 0
            found.append(best if len(least) and least[best] <= within else None)
        return found

    def at_vertices_of(self, chosen: dict[int, float]) -> list[list[float]]:
        """Return for each edge the values of the chosen ones that end where it does."""
        at_ends = [[self.edges[k], value] for k, value in chosen.items()]
        found = []
        for edge in self.edges:
            own = ends(edge)
            found.append([v for other, v in at_ends if any(x.IsSame(y) for x in own for y in ends(other))])
        return found

    def largest_tolerance(self) -> float:
        """Return the largest tolerance of all edges and their vertices."""
        return max([*self.tolerance, *(tolerance for _, tolerance, _ in self.vertices())], default=0.0)

    def vertices(self) -> list[tuple[FloatArray, float, list[int]]]:
        """Return where each vertex is, its tolerance, and the edges that end there."""
        from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher

        ids = IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher()
        at: list[list[int]] = []
        for k, edge in enumerate(self.edges):
            for vertex in ends(edge):
                number = ids.Add(vertex) - 1
                if number == len(at):
                    at.append([])
                at[number].append(k)
        vertices = [cast(ids.FindKey(n + 1)) for n in range(len(at))]
        return [(point_of(x), tolerance_of(x), edges) for x, edges in zip(vertices, at, strict=True)]


def measured_border(shape: Any, table: EdgeTable, k: int, new: tuple[int, ...], was: float | None) -> Border:
    """Return an edge of a new face, with its gap to the surface beyond; the one allowed is left open."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_SurfaceType

    faces = parts(shape, "FACE")
    own = next(n for n in table.faces[k] if n in new)
    beyond = next((n for n in table.faces[k] if n != own), own)
    edge = table.edges[k]
    t = np.linspace(*range_of(edge), _PLACES)
    points = surface_at(faces[own], parameters_of(edge, faces[own], t))
    there = parameters_of(edge, faces[beyond], t)
    on_surface = np.stack([
        surface_at(faces[beyond], feet(faces[beyond], point[None], start))[0]
        for point, start in zip(points, there, strict=True)
    ])  # fmt: skip
    # A foot that ran away is no foot.
    away = np.minimum(
        np.linalg.norm(on_surface - points, axis=1), np.linalg.norm(surface_at(faces[beyond], there) - points, axis=1)
    )
    worst = int(away.argmax())
    plane = BRepAdaptor_Surface(faces[beyond], False).GetType() == GeomAbs_SurfaceType.GeomAbs_Plane
    x, y, z = points[worst].tolist()
    return Border(
        name=table.names[k],
        beyond=beyond,
        length=float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()),
        tolerance=table.tolerance[k],
        gap=float(away[worst]),
        was=was,
        allowed=0.0,
        is_plane=bool(plane),
        at=(x, y, z),
    )


def loose_area(face: Any) -> float:
    """Return how much area lies between the curves of a face's edges in space and those in its parameters, at most."""
    from OCP.BRep import BRep_Tool

    found = 0.0
    for edge in parts(face, "EDGE"):
        if BRep_Tool.Degenerated_s(edge):
            continue
        t = np.linspace(*range_of(edge), _PLACES)
        points = points_of(edge, t)
        apart = np.linalg.norm(surface_at(face, parameters_of(edge, face, t)) - points, axis=1)
        found += float(np.linalg.norm(np.diff(points, axis=0), axis=1) @ np.maximum(apart[1:], apart[:-1]))
    return found
