"""The gate before a changed solid is written: what it was and what it became are measured and compared.

It knows nothing of how the change was made, but for which faces were taken out and put in. Open CASCADE's own check is
only one of its points: that one accepts open shells, inner faces, any tolerance, faces that cross, and folds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import SemisplineError
from semispline.solver.io import OccFace
from semispline.solver.judge import cad_measures, measure_regularity, measure_turn
from semispline.solver.topology.gate_edges import Border, EdgeTable, loose_area, measured_border
from semispline.solver.topology.occ_shapes import box_of, boxes_meet, extent, forward, parts, point_of

Point = tuple[float, float, float]

# Of the size: what a tolerance may be without a reason, and how far an end curve may lie off a plane; off another face.
_TOLERANCE, _OFF_FACE = 1e-6, 1e-5
# Of a gap that was measured there.
_OF_GAP = 3.0
# Of the area of the old face times its width.
_OF_VOLUME = 0.25
# Of the mean area element of the new face, for a pinch.
_PINCHED = 1e-9
# Files are written with 17 digits, and their readers measure tolerances anew.
_AS_BEFORE, _READ_BACK = 1 + 1e-9, 2.0
_SAME_AREA = 1e-9
# Of the volume under each face.
_VOLUME_ERROR = 1e-6


@dataclass(frozen=True)
class Change:
    """What is meant to have happened to a shape.

    Attributes
    ----------
    old : tuple of int
        Faces that were taken out, by their numbers before.
    new : tuple of int
        Faces that were put in, by their numbers after.
    touched : tuple of int
        Faces whose borders were changed, by their numbers before.
    volume : float
        Area times width of what was there: a quarter of it is what the volume may change by.
    contacts : tuple of int
        Faces beyond the contacts, by their numbers before.
    grows : bool or None
        Whether the volume has to become more, or less; None where either is right.
    joined : int
        How many solids, and shells, were joined to others.
    expected : float
        By what the volume grows, as far as it is known beforehand; `volume` is about the rest.
    kept : dict or None
        The number after of each face that was not taken out, by that before; None where they follow each other.
    like : tuple of int
        Of faces that are put in beside others, by whose colours, by their numbers before.
    """

    old: tuple[int, ...]
    new: tuple[int, ...]
    touched: tuple[int, ...]
    volume: float
    contacts: tuple[int, ...]
    grows: bool | None = None
    joined: int = 0
    expected: float = 0.0
    kept: Mapping[int, int] | None = None
    like: tuple[int, ...] = ()


@dataclass(frozen=True)
class GateReport:
    """What the gate measured; what it did not come to is None.

    Attributes
    ----------
    reason : str or None
        Why the result is not sound; None where it is.
    place : (float, float, float) or None
        Where, as far as that can be said.
    solids, shells, faces : (int, int)
        Before and after.
    volume : (float, float)
        Before and after.
    volume_expected, volume_limit : float
        By how much it changes where that is known beforehand, and by how much more or less it may.
    border : tuple of Border
        The edges of the new faces, with their tolerances and gaps.
    turn_degrees : float or None
        Of the new faces; above 90 they are folded.
    open_edges : int
        Edges of one face alone, before as after.
    """

    reason: str | None
    place: Point | None = None
    solids: tuple[int, int] = (0, 0)
    shells: tuple[int, int] = (0, 0)
    faces: tuple[int, int] = (0, 0)
    volume: tuple[float, float] = (0.0, 0.0)
    volume_expected: float = 0.0
    volume_limit: float = 0.0
    border: tuple[Border, ...] = field(default=())
    turn_degrees: float | None = None
    open_edges: int = 0
    was_invalid: bool = False

    @property
    def is_sound(self) -> bool:
        """Whether the result may be written."""
        return self.reason is None

    @property
    def largest_tolerance(self) -> float:
        """Of the edges of the new faces."""
        return max((edge.tolerance for edge in self.border), default=0.0)


class _NotSoundError(Exception):
    def __init__(self, reason: str, place: Point | None = None) -> None:
        super().__init__(reason)
        self.reason, self.place = reason, place


def gate(
    before: Any, after: Any, change: Change, *, millimetres: float | None = None, read_back: bool = False
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
    """
    report = GateReport(None)
    try:
        report = _counts(before, after, change, report)
        both = _Both(before, after, change, EdgeTable.of(before), EdgeTable.of(after), extent(before))
        for part in (_uses, _validity, _volumes):
            report = part(both, report)
        report = _tolerances(both, report, millimetres, read_back=read_back)
        report = _unchanged(both, report, read_back=read_back)
        for part in (_folds, _interferences):
            report = part(both, report)
    except _NotSoundError as found:
        return replace(report, reason=found.reason, place=found.place)
    return report


@dataclass(frozen=True, eq=False)
class _Both:
    """A shape before and after, with the tables of their edges and the size."""

    before: Any
    after: Any
    change: Change
    olds: EdgeTable
    news: EdgeTable
    size: float

    @cached_property
    def known(self) -> list[int | None]:
        """Which edge from before each one is."""
        return self.olds.matching(self.news, _TOLERANCE * self.size)

    @cached_property
    def border_before(self) -> float:
        """The largest tolerance of the edges of what was taken out."""
        edges = [k for k, faces in enumerate(self.olds.faces) if set(faces) & set(self.change.old)]
        return max((self.olds.tolerance[k] for k in edges), default=0.0)

    @cached_property
    def faces(self) -> tuple[list[Any], list[Any]]:
        """Before and after."""
        return parts(self.before, "FACE"), parts(self.after, "FACE")

    @cached_property
    def kept(self) -> dict[int, int]:
        """The number after of each face that was not taken out, by that before."""
        if self.change.kept is not None:
            return dict(self.change.kept)
        rest = [n for n in range(len(self.faces[1])) if n not in self.change.new]
        return dict(zip((n for n in range(len(self.faces[0])) if n not in self.change.old), rest, strict=True))


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
            raise _NotSoundError(f"{has} {name} came out, expected {expected}")
    return report


def _uses(both: _Both, report: GateReport) -> GateReport:
    """Every edge of a shell is used twice, one against the other, but for those that were not so before."""
    olds, news = both.olds, both.news
    for k in news.loose():
        was = both.known[k]
        if was is None or olds.uses[was] != news.uses[k]:
            count = len(news.uses[k])
            said = "would stay open" if count == 1 else f"is used {count} times, not twice, one against the other"
            raise _NotSoundError(f"the edge {news.names[k]} {said}", _triple(news.middles[k]))
    shells = [parts(shape, "SHELL") for shape in (both.before, both.after)]
    had, has = (sum(not shell.Closed() for shell in own) for own in shells)
    # Of loose faces there are none before.
    if shells[0] and has > had:
        # The flag alone says little, but who reads it takes the shell for open.
        raise _NotSoundError("a shell is no longer marked as closed")
    return replace(report, open_edges=sum(len(uses) == 1 for uses in news.uses))


def _validity(both: _Both, report: GateReport) -> GateReport:
    from OCP.BRepCheck import BRepCheck_Analyzer

    check, earlier = BRepCheck_Analyzer(both.after, True), BRepCheck_Analyzer(both.before, True)
    if check.IsValid():
        return report
    # A file that was not valid before may stay so elsewhere.
    bad = {both.kept.get(n) for n, face in enumerate(both.faces[0]) if not earlier.IsValid(face)}
    for number, face in enumerate(both.faces[1]):
        if number not in bad and not check.IsValid(face):
            raise _NotSoundError(f"Open CASCADE's check fails on face {number}", _triple(_middle_of(face)))
    if earlier.IsValid():
        raise _NotSoundError("Open CASCADE's check fails on the whole")
    return replace(report, was_invalid=True)


def _volumes(both: _Both, report: GateReport) -> GateReport:
    change = both.change
    about = box_of(both.before).mean(axis=0)
    had, has = volume_of(both.before, about), volume_of(both.after, about)
    limit = _OF_VOLUME * change.volume
    report = replace(report, volume=(had, has), volume_expected=change.expected, volume_limit=limit)
    if parts(both.before, "SOLID") and had * has <= 0:
        raise _NotSoundError(f"the solid is turned inside out: its volume was {had:.6g} and became {has:.6g}")
    if not abs(has - had - np.sign(had) * change.expected) <= limit:
        about = f"{change.expected:.4g}, give or take {limit:.4g}" if change.expected else f"at most {limit:.4g}"
        raise _NotSoundError(f"the volume changes by {has - had:.4g}, expected {about}")
    if change.grows is not None and (has - had > 0) != (change.grows == (had > 0)):
        which = "inner corner adds" if change.grows else "edge takes away"
        raise _NotSoundError(f"the volume changes by {has - had:.4g}, but rounding this {which} some")
    return report


def _tolerances(both: _Both, report: GateReport, millimetres: float | None, *, read_back: bool) -> GateReport:
    border = [*_borders(both, millimetres)]
    report = replace(report, border=tuple(edge for _, edge in border))
    for _, edge in border:
        if edge.tolerance > edge.allowed:
            raise _NotSoundError(
                f"the edge {edge.name} of the new face needs a tolerance of {edge.tolerance:.3g}, expected at most "
                f"{edge.allowed:.3g}",
                edge.at,
            )
    limits = {k: edge.allowed for k, edge in border}
    near = both.news.at_vertices_of(limits)
    wider, floor = (_READ_BACK, _TOLERANCE * both.size) if read_back else (_AS_BEFORE, 0.0)
    for k, was in enumerate(both.known):
        if k in limits:
            continue
        if was is None and not near[k]:
            raise _NotSoundError(
                f"the edge {both.news.names[k]} is new, and not of the new face", _triple(both.news.middles[k])
            )
        own = both.border_before if was is None else both.olds.tolerance[was]
        allowed = max(wider * own, floor, max(near[k], default=0.0) if was is None else 0.0)
        if both.news.tolerance[k] > allowed:
            raise _NotSoundError(
                f"the tolerance of the edge {both.news.names[k]} became {both.news.tolerance[k]:.3g}, expected at most "
                f"{allowed:.3g}",
                _triple(both.news.middles[k]),
            )
    _check_vertices(both, limits, wider, floor)
    return report


def _borders(both: _Both, millimetres: float | None) -> Iterator[tuple[int, Border]]:
    """Yield the edges of the new faces, with what their tolerances may be."""
    contacts = {both.kept[n] for n in both.change.contacts}
    for k, faces in enumerate(both.news.faces):
        if not set(faces) & set(both.change.new):
            continue
        was = None if both.known[k] is None else both.olds.tolerance[both.known[k]]  # type: ignore[index]
        found = measured_border(both.after, both.news, k, both.change.new, was)
        if set(faces) & contacts:
            most = cad_measures(found.length, millimetres)["gap"]
        else:
            most = (_TOLERANCE if found.is_plane else _OFF_FACE) * both.size
        if found.gap > most:
            raise _NotSoundError(
                f"the edge {found.name} of the new face lies {found.gap:.3g} off face {found.beyond}, expected at most "
                f"{most:.3g}",
                found.at,
            )
        yield (
            k,
            replace(found, allowed=max(both.border_before, was or 0.0, _TOLERANCE * both.size, _OF_GAP * found.gap)),
        )


def _check_vertices(both: _Both, limits: dict[int, float], wider: float, floor: float) -> None:
    """Vertices of new edges have at most what these have; others what they had."""
    before = both.olds.vertices()
    places = np.array([point for point, _, _ in before]).reshape(-1, 3)
    had = np.array([tolerance for _, tolerance, _ in before])
    for point, tolerance, edges in both.news.vertices():
        same = had[np.linalg.norm(places - point, axis=1) <= _TOLERANCE * both.size]
        own = float(same.max()) if len(same) else both.border_before
        allowed = max([wider * own, floor, *(limits[k] for k in edges if k in limits)])
        if tolerance > allowed:
            raise _NotSoundError(
                f"a vertex needs a tolerance of {tolerance:.3g}, expected at most {allowed:.3g}", _triple(point)
            )


def _unchanged(both: _Both, report: GateReport, *, read_back: bool) -> GateReport:
    """Faces that were not touched have their areas and their places.

    A reader may make the curves of edges in the parameters of a face anew from those in space: where a file holds both
    apart, the borders move by that much.
    """
    for old, new in both.kept.items():
        if old in both.change.touched:
            continue
        before, after = both.faces[0][old], both.faces[1][new]
        (area, at), (area_now, at_now) = _area(before), _area(after)
        change, moved = abs(area_now - area), float(np.linalg.norm(at_now - at))
        allowed, far = _SAME_AREA * both.size**2, _TOLERANCE * both.size
        if read_back and (change > allowed or moved > far):
            loose = loose_area(before) + loose_area(after)
            allowed, far = allowed + loose, far + loose / max(area, loose) * extent(before)
        if change > allowed or moved > far:
            raise _NotSoundError(f"face {old} was not to be changed, and is not what it was", _triple(at))
    return report


def _folds(both: _Both, report: GateReport) -> GateReport:
    for number in both.change.new:
        surface = OccFace(both.faces[1][number], f"face {number}").surface()
        try:
            turn, pinch = measure_turn(surface), measure_regularity(surface)
        except SemisplineError as error:
            raise _NotSoundError(f"the new face cannot be measured: {error}") from None
        report = replace(report, turn_degrees=max(report.turn_degrees or 0.0, turn.degrees))
        if turn.is_fold:
            raise _NotSoundError(f"the new face folds: it turns by {turn.degrees:.3g} degrees at once", turn.point)
        if pinch.least_area_ratio <= _PINCHED:
            raise _NotSoundError("the new face is pinched to nothing somewhere")
    return report


def _interferences(both: _Both, report: GateReport) -> GateReport:
    """No faces near the new ones cross that did not before."""
    near = _near_new(both)
    olds, news = both.faces
    found = crossings([news[n] for n in near])
    if found:
        kept = [old for old, new in both.kept.items() if new in near]
        were = crossings([olds[n] for n in (*kept, *both.change.old)])
        if len(found) > len(were):
            numbers = [n for n, face in enumerate(news) if any(x.IsSame(face) for x, _ in found[0])]
            said = " and ".join(str(n) for n in numbers)
            raise _NotSoundError(f"faces {said} cross" if said else "edges or faces cross", found[0][0][1])
    return report


def crossings(faces: list[Any]) -> list[list[tuple[Any, Point]]]:
    """Return pairs of parts of some faces that cross where they share nothing, each with a place."""
    from OCP.BOPAlgo import BOPAlgo_ArgumentAnalyzer
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for face in faces:
        builder.Add(compound, face)
    analyzer = BOPAlgo_ArgumentAnalyzer()
    analyzer.SetShape1(compound)
    analyzer.ArgumentTypeMode = True
    analyzer.SelfInterMode = True
    for mode in (
        "SmallEdgeMode",
        "RebuildFaceMode",
        "TangentMode",
        "MergeVertexMode",
        "MergeEdgeMode",
        "ContinuityMode",
    ):
        setattr(analyzer, mode, False)
    analyzer.Perform()
    if not analyzer.HasFaulty():
        return []
    found = []
    for result in analyzer.GetCheckResult():
        shapes = list(result.GetFaultyShapes1())
        found.append([(shape, _triple(_middle_of(shape))) for shape in shapes] or [(compound, (0.0, 0.0, 0.0))])
    return found


def volume_of(shape: Any, about: FloatArray) -> float:
    """Return the volume that the faces of a shape enclose; of an open one what lies between them and a point."""
    from OCP.BRepGProp import BRepGProp_Domain, BRepGProp_Face, BRepGProp_Vinert
    from OCP.gp import gp_Pnt

    point, found = gp_Pnt(*about.tolist()), 0.0
    for face in parts(shape, "FACE"):
        # For a whole shape the kernel takes a point of its own, and another one after a vertex has moved.
        one = BRepGProp_Vinert()
        one.SetLocation(point)
        # Without a bound of the error it takes a fixed number of places in each face, whatever knots that has.
        one.Perform(BRepGProp_Face(face), BRepGProp_Domain(face), _VOLUME_ERROR)
        found += float(one.Mass())
    return found


def _near_new(both: _Both) -> list[int]:
    """Return the numbers of the new faces and of those whose boxes meet theirs."""
    news = both.faces[1]
    around = [box_of(news[n]) for n in both.change.new]
    return [
        number for number, face in enumerate(news)
        if number in both.change.new or any(boxes_meet(box_of(face), box) for box in around)
    ]  # fmt: skip


def _area(face: Any) -> tuple[float, Any]:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties)
    return float(properties.Mass()), np.array(properties.CentreOfMass().Coord())


def _middle_of(shape: Any) -> Any:
    vertices = parts(forward(shape), "VERTEX")
    return np.mean([point_of(x) for x in vertices], axis=0) if vertices else np.full(3, np.nan)


def _triple(point: Any) -> Point:
    x, y, z = np.asarray(point, dtype=np.float64).tolist()
    return x, y, z
