"""Edges of faces of 3dm files as curves.

rhino3dm shows no curves in the parameters of a face: there is the edge in space alone, whose feet are taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from semispline.solver.errors import FileError, InputError
from semispline.solver.io import Model, RhinoFace, without_equal_weights
from semispline.solver.topology.rhino_edges import distance_from, edges_in_order


def curves_of_3dm(model: Model, edges: Sequence[tuple[int, int]]) -> tuple[str | None, list[Any]]:
    """Return the unit, and for each face and number what `TrimCurve` holds of the edge, or what is wrong with it."""
    return model.unit, [_curve(model, face, number) for face, number in edges]


def _curve(model: Model, face: int, number: int) -> Any:
    if not 0 <= face < len(model.faces):
        return FileError(f"{model.path}#{face}: the file has {len(model.faces)} faces, counted from 0")
    item = model.faces[face]
    assert isinstance(item, RhinoFace)
    try:
        surface = item.surface()
    except InputError as error:
        return error
    walked = edges_in_order(item)
    if not 0 <= number < len(walked):
        return f"the face has {len(walked)} edges" + (f", e0 to e{len(walked) - 1}" if walked else "")
    edge, place, against = walked[number]
    if edge < 0 or item.curves is None:
        return "it is a point; choose another edge"
    degree, knots, net = item.curves[place]
    weights = without_equal_weights(net[:, 3])
    in_space = (degree, knots, net[:, :3] / net[:, 3:], weights)
    content = (
        surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, surface.control_points, surface.weights
    )  # fmt: skip
    # Loops run so that the face lies left of them in its parameters.
    return content, in_space, None, "right" if against else "left", distance_from(surface, item.curves[place])
