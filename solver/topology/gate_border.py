"""The borders of new faces in the gate: tolerances of edges and vertices, gaps, and creases at edges that were kept."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import cad_measures
from semispline.solver.topology.gate_edges import Border, measured_border
from semispline.solver.topology.gate_measures import triple
from semispline.solver.topology.gate_report import GateReport
from semispline.solver.topology.gate_sides import TOLERANCE, Both, NotSoundError
from semispline.solver.topology.occ_shapes import jets_at, parameters_of, range_of

# Of the size: what an end curve may lie off a curved face.
_OFF_FACE = 1e-5
# Of a gap that was measured there.
_OF_GAP = 3.0
# Files are written with 17 digits, and their readers measure tolerances anew.
_AS_BEFORE, _READ_BACK = 1 + 1e-9, 2.0
# Degrees: where faces meet at less, one goes on in the other. Places along an edge at which that is measured.
_GOES_ON, _PLACES = 2.0, 33


def check_tolerances(both: Both, report: GateReport, millimetres: float | None, *, read_back: bool) -> GateReport:
    """Each new or changed edge and vertex has the tolerance that it needs, all others what they had.

    Raises
    ------
    NotSoundError
    """
    border = [*_borders(both, millimetres)]
    tolerance = both.olds.largest_tolerance(), both.news.largest_tolerance()
    report = replace(report, border=tuple(edge for _, edge in border), tolerance=tolerance)
    for _, edge in border:
        if edge.tolerance > edge.allowed:
            raise NotSoundError(
                f"the edge {edge.name} of the new face needs a tolerance of {edge.tolerance:.3g}, expected at most "
                f"{edge.allowed:.3g}",
                edge.at,
            )
    limits = {k: edge.allowed for k, edge in border}
    near = both.news.at_vertices_of(limits)
    wider, floor = (_READ_BACK, TOLERANCE * both.size) if read_back else (_AS_BEFORE, 0.0)
    for k, was in enumerate(both.known):
        if k in limits:
            continue
        if was is None and not near[k]:
            raise NotSoundError(
                f"the edge {both.news.names[k]} is new, and not of the new face", triple(both.news.middles[k])
            )
        own = both.border_before if was is None else both.olds.tolerance[was]
        allowed = max(wider * own, floor, max(near[k], default=0.0) if was is None else 0.0)
        if both.news.tolerance[k] > allowed:
            raise NotSoundError(
                f"the tolerance of the edge {both.news.names[k]} became {both.news.tolerance[k]:.3g}, expected at most "
                f"{allowed:.3g}",
                triple(both.news.middles[k]),
            )
    _check_vertices(both, limits, wider, floor)
    return report


def _borders(both: Both, millimetres: float | None) -> Iterator[tuple[int, Border]]:
    """Yield the edges of the new faces, with what their tolerances may be."""
    contacts = {both.kept[n] for n in both.change.contacts}
    for k, faces in enumerate(both.news.faces):
        if not set(faces) & set(both.change.new):
            continue
        was = both.was[k]
        found = measured_border(both.after, both.news, k, both.change.new, was)
        if set(faces) & contacts:
            most = cad_measures(found.length, millimetres)["gap"]
        else:
            most = (TOLERANCE if found.is_plane else _OFF_FACE) * both.size
        if found.gap > most:
            raise NotSoundError(
                f"the edge {found.name} of the new face lies {found.gap:.3g} off face {both.first[1] + found.beyond}, "
                f"expected at most {most:.3g}",
                found.at,
            )
        allowed = max(both.border_before, was or 0.0, TOLERANCE * both.size, _OF_GAP * found.gap)
        yield k, replace(found, allowed=allowed, beyond=both.first[1] + found.beyond)


def _check_vertices(both: Both, limits: dict[int, float], wider: float, floor: float) -> None:
    """Vertices of new edges have at most what these have; others what they had."""
    before = both.olds.vertices()
    places = np.array([point for point, _, _ in before]).reshape(-1, 3)
    had = np.array([tolerance for _, tolerance, _ in before])
    for point, tolerance, edges in both.news.vertices():
        same = had[np.linalg.norm(places - point, axis=1) <= TOLERANCE * both.size]
        own = float(same.max()) if len(same) else both.border_before
        allowed = max([wider * own, floor, *(limits[k] for k in edges if k in limits)])
        if tolerance > allowed:
            raise NotSoundError(
                f"a vertex needs a tolerance of {tolerance:.3g}, expected at most {allowed:.3g}", triple(point)
            )


def check_creases(both: Both, report: GateReport) -> GateReport:
    """Where a face went on smoothly over an old edge that is still there, the new one does.

    Contacts are left out: how these are met was asked for, and is measured elsewhere.

    Raises
    ------
    NotSoundError
    """
    contacts = {both.kept[n] for n in both.change.contacts}
    worst: float | None = None
    for k, faces in enumerate(both.news.faces):
        old, new = both.known[k], set(faces) & set(both.change.new)
        if old is None or len(new) != 1 or len(faces) != 2 or set(faces) & contacts:
            continue
        before, _ = _crease(both.olds.edges[old], [both.faces[0][n] for n in both.olds.faces[old]])
        if before >= _GOES_ON:
            continue
        (beyond,) = set(faces) - new
        crease, at = _crease(both.news.edges[k], [both.faces[1][n] for n in faces])
        worst = max(worst or 0.0, crease)
        allowed = max(cad_measures(both.size)["angle_degrees"], before)
        if not crease <= allowed:
            raise NotSoundError(
                f"the new face meets face {both.first[1] + beyond} at a crease of {crease:.2g} degrees over "
                f"{both.news.names[k]}, where the old one went on smoothly, expected at most {allowed:.2g}",
                triple(at),
            )
    return replace(report, crease_degrees=worst)


def _crease(edge: Any, faces: list[Any]) -> tuple[float, FloatArray]:
    """Return the largest angle between two faces along an edge, in degrees, and where; its ends may be poles."""
    t = np.linspace(*range_of(edge), _PLACES)[1:-1]
    jets = [jets_at(face, parameters_of(edge, face, t)) for face in faces]
    normals = [np.cross(jet[:, 1], jet[:, 2]) for jet in jets]
    if len(normals) != 2:
        return 180.0, jets[0][0, 0]
    sine = np.linalg.norm(np.cross(normals[0], normals[1]), axis=1)
    # Which way faces look is no matter here.
    angle = np.degrees(np.arctan2(sine, np.abs((normals[0] * normals[1]).sum(axis=1))))
    worst = int(angle.argmax())
    return float(angle[worst]), jets[0][worst, 0]
