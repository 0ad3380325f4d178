"""Places from what was measured, each with the figures by which its repeats are known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import prod

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.between import Between
from semispline.solver.topology.chamfers import Chamfer, chamfer_parts
from semispline.solver.topology.clearance import clearance
from semispline.solver.topology.fillets import bases_of, score_parts
from semispline.solver.topology.gaps import Gap, gap_parts
from semispline.solver.topology.half_edges import NONE, EdgeGraph, Integers, Uses
from semispline.solver.topology.place import Place, PlaceSide
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.sides import Side


@dataclass(frozen=True)
class Entry:
    """A place, and what it has in common with its repeats: words, lengths and angles in degrees."""

    place: Place
    words: tuple[str, ...]
    lengths: tuple[float, ...]
    angles: tuple[float, ...]


def fillet_entry(graph: EdgeGraph, relations: Relations, between: Between, on_ends: int) -> Entry:
    """Return the place of a fillet."""
    return _between_entry(graph, relations, between, "fillet", score_parts(between, on_ends), {})


def round_end_entry(graph: EdgeGraph, relations: Relations, between: Between) -> Entry:
    """Return the place of a round end."""
    parts = score_parts(between, 0)
    return _between_entry(graph, relations, between, "round end", {**parts, "turn": 1.0}, {})


def chamfer_entry(graph: EdgeGraph, relations: Relations, chamfer: Chamfer) -> Entry:
    """Return the place of a chamfer."""
    angles = {"angle_a": chamfer.angle_a, "angle_b": chamfer.angle_b}
    return _between_entry(graph, relations, chamfer.between, "chamfer", chamfer_parts(chamfer), angles)


def chain_entry(graph: EdgeGraph, relations: Relations, members: Sequence[Between]) -> Entry:
    """Return the place of a chain of fillets; its score is the mean of its members', by length."""
    singles = [fillet_entry(graph, relations, member, 0).place for member in members]
    lengths = [single.measures["length"] for single in singles]
    longest = singles[int(np.argmax(lengths))]
    score = float(np.average([single.score for single in singles], weights=lengths))
    width = float(np.average([single.measures["width"] for single in singles], weights=lengths))
    place = Place(
        kind="chain",
        faces=tuple(sorted(member.face for member in members)),
        a=longest.a,
        b=longest.b,
        contacts=((), ()),
        score=score,
        parts={"members": score},
        measures={"length": sum(lengths), "width": width, "members": float(len(members))},
    )
    kinds = tuple(sorted(graph.faces.kind[member.face] for member in members))
    return Entry(place, ("chain", *kinds), (sum(lengths), width), ())


def gap_entry(graph: EdgeGraph, gap: Gap) -> Entry:
    """Return the place of a gap."""
    parts = gap_parts(gap)
    a, b = _naked_sides(graph, gap)
    measures = {
        "length": gap.length,
        "width": gap.width,
        "even": gap.even,
        "facing_a": gap.facing_a,
        "facing_b": gap.facing_b,
    }
    place = Place("gap", (), a, b, ((), ()), prod(parts.values()), parts, measures, gap.a.closed)
    facing = sorted(float(np.degrees(np.arccos(np.clip(x, -1, 1)))) for x in (gap.facing_a, gap.facing_b))
    lengths = (*sorted((gap.a.length, gap.b.length)), gap.width)
    return Entry(place, ("gap", *_kinds(graph, a.face, b.face)), lengths, tuple(facing))


def sharp_entry(graph: EdgeGraph, relations: Relations, use: int) -> Entry:
    """Return the place of a sharp edge."""
    uses, partner = graph.uses, int(relations.partner[use])
    angle, length = float(relations.median[use]), float(relations.length[use])
    convex = bool(relations.convex[use])
    # The whole size would be the longest edge that there can be.
    parts = {"angle": min(1.0, angle / 30), "length": min(1.0, float(np.sqrt(length / graph.size)))}
    first, second = (PlaceSide(int(uses.face[row]), uses.name(row)) for row in (use, partner))
    measures = {"length": length, "angle": angle, "convex": float(convex), "clearance": clearance(graph, use, partner)}
    closed = bool(np.linalg.norm(uses.points[use, 0] - uses.points[use, -1]) <= 1e-6 * length)
    place = Place("sharp edge", (), first, second, ((), ()), prod(parts.values()), parts, measures, closed)
    words = ("sharp edge", *_kinds(graph, first.face, second.face), str(convex))
    return Entry(place, words, (length,), (angle,))


def _between_entry(
    graph: EdgeGraph,
    relations: Relations,
    between: Between,
    kind: str,
    parts: Mapping[str, float],
    more: Mapping[str, float],
) -> Entry:
    a, b = (_beyond(graph, relations, side) for side in (between.a, between.b))
    measures = {
        "length": between.length,
        "width": between.width,
        "even": between.even,
        "turn": between.turn,
        "radius": between.radius,
        "angle": between.angle,
        **more,
    }
    if kind == "chamfer":
        for name in ("turn", "radius", "angle"):
            del measures[name]
    contacts = tuple(tuple(graph.uses.name(use) for use in side.uses) for side in (between.a, between.b))
    place = Place(
        kind=kind,
        faces=(between.face,),
        a=a,
        b=b,
        contacts=(contacts[0], contacts[1]),
        score=prod(parts.values()),
        parts=parts,
        measures=measures,
        closed=between.a.closed,
    )
    words = (kind, graph.faces.kind[between.face], *_kinds(graph, a.face, b.face), f"{between.sign:+.0f}")
    lengths = (*sorted((between.a.length, between.b.length)), between.width)
    return Entry(place, words, lengths, (between.turn, *sorted(more.values())))


def _beyond(graph: EdgeGraph, relations: Relations, side: Side) -> PlaceSide:
    """Return the faces beyond a side, that with the most of it first, each with its longest edge there."""
    uses = graph.uses
    rows = sorted((int(x) for x in relations.partner[list(side.uses)] if x != NONE), key=lambda x: -relations.length[x])
    edges: dict[int, int] = {}
    for row in rows:
        edges.setdefault(int(uses.face[row]), row)
    faces = list(bases_of(graph, relations, side))
    first, *others = [(face, uses.name(edges[face])) for face in faces]
    return PlaceSide(*first, more=tuple(others))


def _naked_sides(graph: EdgeGraph, gap: Gap) -> tuple[PlaceSide, PlaceSide]:
    """Return both sides of a gap, of each the edge that is named first: the longest of the side with more edges.

    The first edges face each other. Of as many edges on both sides all do, one by one; else those of a side follow in
    the order of their lengths.
    """
    uses = graph.uses
    lines = [uses.points[list(side.uses)] for side in (gap.a, gap.b)]
    order_a, order_b = (
        np.argsort(-np.linalg.norm(np.diff(x, axis=1), axis=2).sum(axis=1), kind="stable") for x in lines
    )
    if max(len(order_a), len(order_b)) > 1:
        apart = _apart(*lines)
        if len(order_a) == len(order_b):
            order_b = linear_sum_assignment(apart)[1][order_a]
        elif len(order_a) > len(order_b):
            order_b = _with_first(order_b, int(np.argmin(apart[order_a[0]])))
        else:
            order_a = _with_first(order_a, int(np.argmin(apart[:, order_b[0]])))
    a, b = ([side.uses[k] for k in order] for side, order in ((gap.a, order_a), (gap.b, order_b)))
    return _side_of(uses, a), _side_of(uses, b)


def _apart(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return how far edges lie apart, of every second sample the mean to the nearest of the other; shape (n_a, n_b).

    Parameters
    ----------
    a, b : ndarray, shapes (n_a, N, 3) and (n_b, N, 3)
    """
    a, b = a[:, ::2], b[:, ::2]
    away = cdist(a.reshape(-1, 3), b.reshape(-1, 3)).reshape(*a.shape[:2], *b.shape[:2])
    return np.asarray(away.min(axis=3).mean(axis=1) + away.min(axis=1).mean(axis=2))


def _with_first(order: Integers, first: int) -> Integers:
    return np.concatenate([[first], order[order != first]])


def _side_of(uses: Uses, rows: Sequence[int]) -> PlaceSide:
    (face, edge), *more = [(int(uses.face[row]), uses.name(row)) for row in rows]
    return PlaceSide(face, edge, tuple(more))


def _kinds(graph: EdgeGraph, *faces: int) -> tuple[str, ...]:
    return tuple(sorted(graph.faces.kind[face] for face in faces))
