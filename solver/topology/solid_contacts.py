"""How the new faces of a solid meet those around them, measured on the true faces as they stand in a file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.io import read_surfaces
from semispline.solver.judge import Base, FaceContact, measure_face_contact, required_face_measures
from semispline.solver.splines import parse_edge
from semispline.solver.topology.edge_limits import default_limits, face_limits
from semispline.solver.topology.face_edges import resolved_use
from semispline.solver.topology.half_edges import NONE
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.relations import relate
from semispline.solver.topology.trim_curves import read_trim_curves

Stretch: TypeAlias = Literal["", "beside a kept end", "kept end"]

# Degrees: where a new face meets another one at more it ends there, and was not to be smooth.
_ENDS = 2.0


@dataclass(frozen=True, eq=False)
class SolidContact:
    """An edge of a new face along which it goes on smoothly in an old one.

    Attributes
    ----------
    edge : str
        "6:e0": of the new face.
    face : int
        The old one.
    contact : FaceContact
    allowed : dict
        For each measure its limit.
    stretch : {"", "beside a kept end", "kept end"}
        Which part of the edge; where an end edge was kept contact is G1, and no limit holds for curvature.
    """

    edge: str
    face: int
    contact: FaceContact
    allowed: dict[str, float]
    stretch: Stretch = ""

    def record(self) -> dict[str, Any]:
        """Return what a report holds of it."""
        own = {"edge": self.edge, "face": self.face, "stretch": self.stretch}
        return {**own, **asdict(self.contact), "allowed": self.allowed}


def contacts_in_solid(
    path: str | Path,
    faces: Sequence[int],
    orders: tuple[int, int] = (2, 2),
    faded: Sequence[tuple[float, float]] = (),
) -> list[SolidContact]:
    """Return how new faces of a file meet the others, edge by edge.

    Parameters
    ----------
    path : str or Path
    faces : sequence of int
        N of `PATH#N`, of the new ones.
    orders : (int, int)
        Of contact, that are asked for on both sides.
    faded : sequence of (float, float)
        The parameters v of the blend beside end edges that were kept, where contact is G1 alone: these stretches of
        contacts are measured by themselves.

    Raises
    ------
    FileError, EdgeError, ComputationError
        As `resolve_edge` and `measure_face_contact`.
    """
    measured = measured_edges(path)
    graph = measured.graph
    uses, relations = graph.uses, relate(graph)
    rows = [row for n in faces for row in range(*uses.of_face(n).indices(len(uses)))]
    rows = [
        row for row in rows
        if (other := int(relations.partner[row])) != NONE
        and int(uses.face[other]) not in faces and relations.median[row] < _ENDS
    ]  # fmt: skip
    own = [int(uses.face[row]) for row in rows]
    others = [int(relations.partner[row]) for row in rows]
    each = list(dict.fromkeys(own))
    loaded = dict(zip(each, read_surfaces([f"{path}#{n}" for n in each]), strict=True))
    asked = [(int(uses.face[row]), int(uses.number[row])) for row in others]
    curves = read_trim_curves(path, asked) if asked else []
    order = max(2, *orders)
    found: list[SolidContact] = []
    for row, face, curve, (beyond, _) in zip(rows, own, curves, asked, strict=True):
        name = uses.name(row)
        end = resolved_use(measured, row, f"{path}#{face}", replace(loaded[face], boundary=None), name, name)
        for base, stretch in _stretches(Base(end.surface, end.edge), faded):
            contact = measure_face_contact(base, curve.free_edge(), order=order)
            allowed = face_limits(curve, base, default_limits(curve), length=contact.length, order=order)
            if stretch:
                allowed = {key: limit for key, limit in allowed.items() if key in required_face_measures("G1")}
            found.append(SolidContact(f"{face}:{name}", beyond, contact, allowed, stretch))
    return found


def _stretches(base: Base, faded: Sequence[tuple[float, float]]) -> Iterator[tuple[Base, Stretch]]:
    """Yield the parts of an edge of a blend where contact is as asked for, and where it is G1 alone."""
    if not faded:
        yield base, ""
        return
    if parse_edge(base.edge).direction == "v":
        yield base, "kept end"
        return
    low, high = base.range_along
    places = sorted({low, high, *(v for ends in faded for v in ends if low < v < high)})
    for start, end in pairwise(places):
        within = any(a <= (start + end) / 2 <= b for a, b in faded)
        yield Base(base.surface, f"{base.side}[{start!r},{end!r}]"), "beside a kept end" if within else ""


def outward_at_border(path: str | Path, faces: Sequence[int]) -> FloatArray:
    """Return the mean outward unit normal along the borders of some faces of a file; a vector of length 1 at most."""
    uses = measured_edges(path).graph.uses
    rows = [row for n in faces for row in range(*uses.of_face(n).indices(len(uses)))]
    return np.asarray(uses.normal[rows].reshape(-1, 3).mean(axis=0))
