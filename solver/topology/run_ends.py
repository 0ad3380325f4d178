"""Runs of faces that go on smoothly into others: which belong together, and what to say where these are left out."""

from __future__ import annotations

from collections.abc import Sequence

from semispline.solver.errors import EdgeError
from semispline.solver.topology.end_faces import end_edges, going_on
from semispline.solver.topology.face_runs import FaceRun, face_run, listed, not_one_run
from semispline.solver.topology.fillets import Fillets, find_fillets
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations


def run_of(
    graph: EdgeGraph, relations: Relations, faces: Sequence[int], edge_a: str | None = None, edge_b: str | None = None
) -> FaceRun:
    """Return faces in the order in which they go on into each other.

    Raises
    ------
    EdgeError
        As `face_run`; where they belong to one chain of fillets all of that is named.
    """
    try:
        return face_run(graph, relations, faces, edge_a, edge_b)
    except EdgeError:
        if len(set(faces)) < max(2, len(faces)):
            raise
        fillets = find_fillets(graph, relations)
        if faces[0] in fillets.accepted:
            whole = _grown(graph, relations, face_run(graph, relations, faces[:1]), fillets)
            if set(faces) <= set(whole.faces):
                raise EdgeError(
                    f"{not_one_run(faces)}; they belong to one chain of fillets: replace all of it "
                    f"({_command(graph, relations, whole)})"
                ) from None
        raise


def check_ends(graph: EdgeGraph, relations: Relations, run: FaceRun, rows: Sequence[int]) -> None:
    """Refuse a run that goes on into other faces beyond some of its end edges.

    Raises
    ------
    EdgeError
        With all faces that belong together, or why no others can be replaced with these.
    """
    smooth = going_on(graph, relations, rows)
    if not smooth:
        return
    faces = run.faces
    beyond = list(dict.fromkeys(_beyond(graph, relations, row) for row in smooth))
    over = listed([f"{graph.uses.face[row]}:" * (len(faces) > 1) + graph.uses.name(row) for row in smooth])
    fillets = find_fillets(graph, relations)
    whole = _grown(graph, relations, run, fillets)
    edges = "this edge" if len(smooth) == 1 else "these edges"
    keeping = f"keep {edges}, where contact falls to G1 (--keep-ends)"
    if len(whole.faces) > len(faces):
        ways = f"replace all that belong together ({_command(graph, relations, whole)}), or {keeping}"
    else:
        them = "it" if len(faces) == 1 else "them"
        why = listed([f"face {n} cannot be replaced with {them} ({_reason(graph, fillets, n)})" for n in beyond])
        ways = f"{why}: {keeping}"
    raise EdgeError(
        f"--replace {','.join(map(str, faces))}: {'it goes' if len(faces) == 1 else 'they go'} on into "
        f"{'face' if len(beyond) == 1 else 'faces'} {listed(beyond)} over {over}: a blend that bends less than a round "
        f"at its contacts cannot keep {edges}; {ways}; --surfaces writes the blend alone"
    )


def _command(graph: EdgeGraph, relations: Relations, whole: FaceRun) -> str:
    word = " --keep-ends" if going_on(graph, relations, whole.ends(graph)) else ""
    return f"--replace {','.join(map(str, whole.faces))}{word}"


def _grown(graph: EdgeGraph, relations: Relations, run: FaceRun, fillets: Fillets) -> FaceRun:
    """Return a run with all fillets that it goes on into over ends of both."""
    while True:
        for row in going_on(graph, relations, run.ends(graph)):
            face = _beyond(graph, relations, row)
            between = fillets.accepted.get(face)
            if between is None or face in run.faces:
                continue
            if relations.partner[row] not in end_edges(graph, face, (between.a.uses, between.b.uses)):
                continue
            try:
                run = face_run(graph, relations, [*run.faces, face])
            except EdgeError:
                continue
            break
        else:
            return run


def _reason(graph: EdgeGraph, fillets: Fillets, face: int) -> str:
    """Say why a face is not replaced with the fillet that goes on into it."""
    if face in fillets.refused:
        return str(fillets.refused[face])
    if face in fillets.accepted:
        return "it is a fillet across"
    return f"it is a {graph.faces.kind[face]}"


def _beyond(graph: EdgeGraph, relations: Relations, row: int) -> int:
    partner = int(relations.partner[row])
    assert partner != NONE
    return int(graph.uses.face[partner])
