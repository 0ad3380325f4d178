"""The blend that takes the place of a run of faces, cut into a surface for each of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.blending import BlendResult
from semispline.solver.errors import BandError, EdgeError
from semispline.solver.judge import Base
from semispline.solver.options import BlendOptions, Continuity
from semispline.solver.splines import BSplineSurface, boundary_curve, closest_point, merge_knots
from semispline.solver.topology.bases import edge_bases
from semispline.solver.topology.between import Between
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.end_faces import blend_onto, faces_at_ends, going_on
from semispline.solver.topology.face_runs import FaceRun
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.kept_edges import KeptEdge, KeptEnd, ended_on_edges, kept_edges, measured_again
from semispline.solver.topology.panels import panels_of
from semispline.solver.topology.relations import relate
from semispline.solver.topology.replaced_runs import ReplacedRun
from semispline.solver.topology.resolving import Resolved
from semispline.solver.topology.run_ends import check_ends
from semispline.solver.topology.sides import entering
from semispline.solver.topology.solid_orders import NewFace

# Of their limits bands use so much: then they lie within 1e-7 of their length, and no tolerance grows.
_SHARE = 1e-2
# Of the length of a rim: nearer points are one. Of the width of a ring: so far its lines across may lean.
_ONE_POINT, _LEANING = 1e-9, 0.1
# Of the range of v: knots of both sides that are nearer are one, where nothing moves by more than this part of a limit.
_SAME_KNOT, _OF_LIMITS = 1e-7, 0.1


@dataclass(frozen=True, eq=False)
class BlendedRun:
    """The blend of both sides of a run, cut into what takes the place of each face; and how it meets kept ends."""

    result: BlendResult
    news: tuple[NewFace, ...]
    kept: tuple[KeptEnd, ...] = ()


def blended_run(found: ReplacedRun, options: BlendOptions, *, keep_ends: bool) -> BlendedRun:
    """Return the blend of both sides of a run, its end curves on the end faces or on edges that are kept.

    Raises
    ------
    EdgeError
        The faces go on into others that belong to them; along a side no one blend runs; rims do not face each other.
    BandError, ContactError, FoldError, OptionError, ComputationError
        As `blend_bases`.
    """
    graph, run = found.measured.graph, found.run
    relations = relate(graph)
    a, b = (_one_base(run, side, name) for side, name in zip(_bases(found, options), "AB", strict=True))
    numbers = [
        tuple(tuple(int(graph.uses.number[row]) for row in side.uses) for side in (m.a, m.b)) for m in run.members
    ]
    if run.closed:
        if len(run.members) == 1:
            result = _from_seam_to_seam(graph, run.members[0], a, b, options)
            surface = result.surface.to_bspline()
            return BlendedRun(result, (NewFace(run.faces[0], (numbers[0][0], numbers[0][1]), surface),))
        result = blend_bases(a, b, options)
        surface = one_spline(result, [*a.parts, *b.parts])
        kept: list[KeptEdge] = []
        ends: tuple[KeptEnd, ...] = ()
    else:
        rows = run.ends(graph)
        smooth = going_on(graph, relations, rows) if keep_ends else []
        rest = [row for row in rows if row not in smooth]
        at = faces_at_ends(graph, relations, rest)
        check_ends(graph, relations, run, rest)
        kept = kept_edges(graph, relations, smooth)
        result, surface = blend_onto(graph, a, b, options, at, kept)
        surface, made = ended_on_edges(surface, kept)
        ends = tuple(made)
        if ends:
            result = measured_again(result, surface, a, b)
    panels = panels_of(graph, run, surface)
    news = tuple(
        NewFace(
            face,
            (contacts[0], contacts[1]),
            panel.surface,
            panel.a,
            panel.b,
            tuple(edge.number for edge in kept if edge.face == face),
        )
        for face, contacts, panel in zip(run.faces, numbers, panels, strict=True)
    )
    return BlendedRun(result, news, ends)


def _from_seam_to_seam(
    graph: EdgeGraph, member: Between, a: EdgeBase, b: EdgeBase, options: BlendOptions
) -> BlendResult:
    """Return the blend between two rims that begins where the old face had its seam, on both of them.

    What faces what best may be a little elsewhere: then the old seam says it, or a sliver of the rim would be left.

    Raises
    ------
    EdgeError
        It had none, and the rims begin where they do not face each other.
    """
    result = blend_bases(a, b, options)
    uses, surface = graph.uses, result.surface.to_bspline()
    vertex = entering(uses, member.b.uses[0])[0]
    border = boundary_curve(surface, "u1")
    # A band may be off the rim; what counts is how far it begins from there along it.
    foot, start = closest_point(border, vertex).points[0], border.evaluate(border.knots[:1])[0]
    away = float(np.linalg.norm(foot - start))
    if away <= _ONE_POINT * member.length:
        return result
    has_seam = bool(uses.seam[uses.of_face(member.face)].any())
    if not isinstance(a.base, Base) or not isinstance(b.base, Base) or options.match != "affine":
        return result
    if not has_seam and away > _LEANING * member.width:
        raise EdgeError(
            f"--replace {member.face}: it has no seam, and its rims begin where they do not face each other, "
            f"{away:.4g} apart along the second: no blend begins at both; --surfaces writes the blend alone"
        )
    place = closest_point(boundary_curve(b.base.surface, b.base.side), vertex).parameters
    pair = float(a.base.range_along[0]), float(np.ravel(place)[0])
    return blend_bases(a, b, replace(options, match=(pair,)))


def _bases(found: ReplacedRun, options: BlendOptions) -> list[tuple[EdgeBase, ...]]:
    return close_bases([found.a, found.b], options.continuities)


def _one_base(run: FaceRun, side: Sequence[EdgeBase], name: str) -> EdgeBase:
    if len(side) != 1:
        raise EdgeError(
            f"--replace {','.join(map(str, run.faces))}: along contact {name} no one blend runs, it has {len(side)} "
            "parts; --surfaces writes their blends"
        )
    return side[0]


def one_spline(result: BlendResult, parts: Sequence[EdgeBase]) -> BSplineSurface:
    """Return a blend as an ordinary B-spline, where bands have joints that nearly are at one v with one knot for them.

    What bands are off by sets them apart, and the span between would be too short to have curvature.
    """
    limits = [part.band.limits.gap for part in parts if part.band is not None and not part.band.is_plane]
    merged = merge_knots(result.surface, _SAME_KNOT) if limits else None
    if merged is None or merged.change > _OF_LIMITS * min(limits):
        return result.surface.to_bspline()
    return merged.surface.to_bspline()


def close_bases(ends: Sequence[Resolved], continuities: Sequence[Continuity]) -> list[tuple[EdgeBase, ...]]:
    """Return the bases along both contacts, as close to their faces as bands come."""
    try:
        return edge_bases(ends, continuities, _SHARE)
    except BandError:
        return edge_bases(ends, continuities)
