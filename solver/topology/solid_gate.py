"""The gate before a changed solid is written: what it was and what it became are measured and compared.

It knows nothing of how the change was made, but for which faces were taken out and put in. Open CASCADE's own check is
only one of its points: that one accepts open shells, inner faces, any tolerance, faces that cross, and folds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from semispline.solver.errors import SemisplineError
from semispline.solver.io import OccFace
from semispline.solver.judge import measure_regularity, measure_turn
from semispline.solver.topology.gate_border import check_creases, check_tolerances
from semispline.solver.topology.gate_edges import EdgeTable, loose_area
from semispline.solver.topology.gate_measures import area_of, crossings, middle_of, triple, volume_of
from semispline.solver.topology.gate_report import Change, GateReport
from semispline.solver.topology.gate_sides import TOLERANCE, Both, NotSoundError
from semispline.solver.topology.occ_shapes import box_of, boxes_meet, extent, parts

# Of the area of the old face times its width.
_OF_VOLUME = 0.25
# Of the mean area element of the new face, for a pinch.
_PINCHED = 1e-9
# Of the square of the size: areas that differ by less are the same.
_SAME_AREA = 1e-9


def gate(
    before: Any,
    after: Any,
    change: Change,
    *,
    millimetres: float | None = None,
    read_back: bool = False,
    first: tuple[int, int] = (0, 0),
) -> GateReport:
    """Return what was measured of a changed shape, and the first thing that is wrong with it.

    Parameters
    ----------
    before, after : TopoDS_Shape
        Neither is changed.
    change : Change
    millimetres : float, optional
        The unit of length, where it is known.
    read_back : bool
        The shape comes from a file that was written: its reader measured tolerances anew.
    first : (int, int)
        What the first face is called in a file, before and after.
    """
    report = GateReport(None)
    try:
        report = _counts(before, after, change, report)
        tables = EdgeTable.of(before, first[0]), EdgeTable.of(after, first[1])
        both = Both(before, after, change, *tables, extent(before), first)
        for part in (_uses, _validity, _volumes):
            report = part(both, report)
        report = check_tolerances(both, report, millimetres, read_back=read_back)
        report = _unchanged(both, report, read_back=read_back)
        for part in (check_creases, _folds, _interferences):
            report = part(both, report)
    except NotSoundError as found:
        return replace(report, reason=found.reason, place=found.place)
    return report


def _counts(before: Any, after: Any, change: Change, report: GateReport) -> GateReport:
    kinds = {"SOLID": "solids", "SHELL": "shells", "FACE": "faces"}
    counts = {name: (len(parts(before, kind)), len(parts(after, kind))) for kind, name in kinds.items()}
    report = replace(report, **counts)  # type: ignore[arg-type]
    more = len(change.new) - len(change.old)
    for name, (had, has) in counts.items():
        if name == "shells" and not had:
            # Loose faces become one.
            continue
        expected = had + (more if name == "faces" else -change.joined)
        if has != expected:
            raise NotSoundError(f"{has} {name} came out, expected {expected}")
    return report


def _uses(both: Both, report: GateReport) -> GateReport:
    """Every edge of a shell is used twice, one against the other, but for those that were not so before."""
    olds, news = both.olds, both.news
    for k in news.loose():
        was = both.known[k]
        if was is None or olds.uses[was] != news.uses[k]:
            count = len(news.uses[k])
            said = "would stay open" if count == 1 else f"is used {count} times, not twice, one against the other"
            raise NotSoundError(f"the edge {news.names[k]} {said}", triple(news.middles[k]))
    shells = [parts(shape, "SHELL") for shape in (both.before, both.after)]
    had, has = (sum(not shell.Closed() for shell in own) for own in shells)
    # Of loose faces there are none before.
    if shells[0] and has > had:
        # The flag alone says little, but who reads it takes the shell for open.
        raise NotSoundError("a shell is no longer marked as closed")
    return replace(report, open_edges=tuple(news.names[k] for k, uses in enumerate(news.uses) if len(uses) == 1))


def _validity(both: Both, report: GateReport) -> GateReport:
    from OCP.BRepCheck import BRepCheck_Analyzer

    check, earlier = BRepCheck_Analyzer(both.after, True), BRepCheck_Analyzer(both.before, True)
    if check.IsValid():
        return report
    # A file that was not valid before may stay so elsewhere.
    bad = {both.kept.get(n) for n, face in enumerate(both.faces[0]) if not earlier.IsValid(face)}
    for number, face in enumerate(both.faces[1]):
        if number not in bad and not check.IsValid(face):
            raise NotSoundError(f"Open CASCADE's check fails on face {both.first[1] + number}", triple(middle_of(face)))
    if earlier.IsValid():
        raise NotSoundError("Open CASCADE's check fails on the whole")
    return replace(report, was_invalid=True)


def _volumes(both: Both, report: GateReport) -> GateReport:
    change = both.change
    about = box_of(both.before).mean(axis=0)
    had, has = volume_of(both.before, about), volume_of(both.after, about)
    limit = _OF_VOLUME * change.volume
    report = replace(report, volume=(had, has), volume_expected=change.expected, volume_limit=limit)
    if parts(both.before, "SOLID") and had * has <= 0:
        raise NotSoundError(f"the solid is turned inside out: its volume was {had:.6g} and became {has:.6g}")
    if not abs(has - had - np.sign(had) * change.expected) <= limit:
        about = f"{change.expected:.4g}, give or take {limit:.4g}" if change.expected else f"at most {limit:.4g}"
        raise NotSoundError(f"the volume changes by {has - had:.4g}, expected {about}")
    if change.grows is not None and (has - had > 0) != (change.grows == (had > 0)):
        which = "inner corner adds" if change.grows else "edge takes away"
        raise NotSoundError(f"the volume changes by {has - had:.4g}, but rounding this {which} some")
    return report


def _unchanged(both: Both, report: GateReport, *, read_back: bool) -> GateReport:
    """Faces that were not touched have their areas and their places.

    A reader may make the curves of edges in the parameters of a face anew from those in space: where a file holds both
    apart, the borders move by that much.
    """
    for old, new in both.kept.items():
        if old in both.change.touched:
            continue
        before, after = both.faces[0][old], both.faces[1][new]
        (area, at), (area_now, at_now) = area_of(before), area_of(after)
        change, moved = abs(area_now - area), float(np.linalg.norm(at_now - at))
        allowed, far = _SAME_AREA * both.size**2, TOLERANCE * both.size
        if read_back and (change > allowed or moved > far):
            loose = loose_area(before) + loose_area(after)
            allowed, far = allowed + loose, far + loose / max(area, loose) * extent(before)
        if change > allowed or moved > far:
            raise NotSoundError(f"face {both.first[0] + old} was not to be changed, and is not what it was", triple(at))
    return report


def _folds(both: Both, report: GateReport) -> GateReport:
    for number in both.change.new:
        surface = OccFace(both.faces[1][number], f"face {number}").surface()
        try:
            turn, pinch = measure_turn(surface), measure_regularity(surface)
        except SemisplineError as error:
            raise NotSoundError(f"the new face cannot be measured: {error}") from None
        report = replace(report, turn_degrees=max(report.turn_degrees or 0.0, turn.degrees))
        if turn.is_fold:
            raise NotSoundError(f"the new face folds: it turns by {turn.degrees:.3g} degrees at once", turn.point)
        if pinch.least_area_ratio <= _PINCHED:
            raise NotSoundError("the new face is pinched to nothing somewhere")
    return report


def _interferences(both: Both, report: GateReport) -> GateReport:
    """No faces near the new ones cross that did not before."""
    near = _near_new(both)
    olds, news = both.faces
    found = crossings([news[n] for n in near])
    if found:
        kept = [old for old, new in both.kept.items() if new in near]
        were = crossings([olds[n] for n in (*kept, *both.change.old)])
        if len(found) > len(were):
            numbers = [both.first[1] + n for n, face in enumerate(news) if any(x.IsSame(face) for x, _ in found[0])]
            said = " and ".join(str(n) for n in numbers)
            raise NotSoundError(f"faces {said} cross" if said else "edges or faces cross", found[0][0][1])
    return report


def _near_new(both: Both) -> list[int]:
    """Return the numbers of the new faces and of those whose boxes meet theirs."""
    news = both.faces[1]
    around = [box_of(news[n]) for n in both.change.new]
    return [
        number for number, face in enumerate(news)
        if number in both.change.new or any(boxes_meet(box_of(face), box) for box in around)
    ]  # fmt: skip
