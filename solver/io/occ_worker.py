"""What the process of its own does that reads a STEP, IGES or BREP file: it converts all faces to plain arrays."""

from __future__ import annotations

from typing import Any

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.errors import InputError
from semispline.solver.io.occ import read_occ


def work(path: str) -> tuple[Any, ...]:
    """Return unit, faces and what else the file holds, as `occ.open_occ` takes them."""
    model = read_occ(path)
    return model.unit, [(face.kind, face.trimmed(), _content(face)) for face in model.faces], model.others


def _content(face: Any) -> tuple[Any, ...] | InputError:
    try:
        surface = face.surface()
    except InputError as error:
        return error
    arrays = (surface.knots_u, surface.knots_v, surface.control_points, surface.weights)
    return (surface.degree_u, surface.degree_v, *arrays)
