"""What the process of its own does that reads a STEP, IGES or BREP file: it converts all faces to plain arrays."""

from __future__ import annotations

from typing import Any

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.errors import InputError
from semispline.solver.io.occ import read_occ


def work(path: str, *bounded: str) -> tuple[Any, ...]:
    """Return unit, faces and what else the file holds, as `occ.open_occ` takes them; edges of the faces `bounded`."""
    model = read_occ(path)
    # A boundary takes as long as many surfaces: only of the faces for which it is wanted.
    edges = {int(n): model.faces[int(n)].boundary() for n in bounded if int(n) < len(model.faces)}
    faces = [(face.kind, face.trimmed(), edges.get(n), *_content(face)) for n, face in enumerate(model.faces)]
    return model.unit, faces, model.others


def _content(face: Any) -> tuple[float | None, tuple[Any, ...] | InputError]:
    try:
        surface = face.surface()
    except InputError as error:
        return None, error
    arrays = (surface.knots_u, surface.knots_v, surface.control_points, surface.weights)
    return face.deviation(), (surface.degree_u, surface.degree_v, *arrays)
