"""The edges of a file with what only its reader can measure: exact lengths, and distances from a point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from semispline.solver.arrays import FloatArray
from semispline.solver.io import OCC_SUFFIXES, open_3dm, read_apart, require_file, require_kernel
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.near import point_of
from semispline.solver.topology.reading import read_edges
from semispline.solver.topology.rhino_edges import edges_of_3dm
from semispline.solver.topology.rhino_measures import distances, lengths_of


@dataclass(frozen=True, eq=False)
class MeasuredEdges:
    """Faces and edges of a file, measured where it was asked for.

    Attributes
    ----------
    graph : EdgeGraph
    lengths : dict
        Face -> length of each of its edges.
    nearest : dict
        ("near=x,y,z", face or None) -> row and distance of the edges that may be meant, the nearest first.
    """

    graph: EdgeGraph
    lengths: dict[int, list[float]]
    nearest: dict[tuple[str, int | None], list[tuple[int, float]]]


def measured_edges(
    path: str | Path, faces: Sequence[int] = (), near: Sequence[tuple[str, int | None]] = ()
) -> MeasuredEdges:
    """Return the edges of a file, lengths of those of some faces, and which lie near some points.

    Raises
    ------
    EdgeError
        A word that is no point.
    FileError, ComputationError
        As `read_edges`.
    """
    points: list[FloatArray] = [point_of(word) for word, _ in near]
    require_file(path)
    suffix = Path(path).suffix.lower()
    if suffix == ".3dm":
        model = open_3dm(path)
        graph = edges_of_3dm(model)
        found = [distances(model, graph, x, face) for x, (_, face) in zip(points, near, strict=True)]
        lengths = {n: lengths_of(model.faces[n]) for n in faces if n < len(model.faces)}  # type: ignore[arg-type]
        return MeasuredEdges(graph, lengths, dict(zip(near, found, strict=True)))
    if suffix not in OCC_SUFFIXES:
        # It says why not.
        return MeasuredEdges(read_edges(path), {}, {})
    require_kernel(path)
    texts = {
        key: " ".join(["near", ",".join(map(repr, x.tolist())), *([] if key[1] is None else [str(key[1])])])
        for key, x in zip(near, points, strict=True)
    }
    asked = [*(f"lengths {n}" for n in faces), *texts.values()]
    graph, answers = read_apart(path, "semispline.solver.topology.occ_measuring_worker", "Open CASCADE", asked)
    assert isinstance(graph, EdgeGraph)
    return MeasuredEdges(
        graph,
        {n: answers[f"lengths {n}"] for n in faces if f"lengths {n}" in answers},
        {key: answers[text] for key, text in texts.items()},
    )
