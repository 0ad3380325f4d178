"""Fillets: faces that turn from one neighbour into another, more sharply than these bend; and chains of them.

The rules, their order and their limits were found on public CAD files, whose proposals were looked at as pictures;
`refused` names the first that speaks against a face.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from semispline.solver.topology.between import Between, measure, meet_in_a_corner, share
from semispline.solver.topology.half_edges import NONE, EdgeGraph, Flags
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.sides import Side, sides_of

ROUND_END = "turns by {turn:.0f} degrees: a round end"
FLAT = "turns by {turn:.1f} degrees only"
BENT_NEIGHBOUR = "a neighbour bends as much as the face"
ONE_HULL = "a patch of one smooth hull: no jump of curvature at a contact"
TOO_SHORT = "its sides are shorter than the way between them"
UNEVEN = "runs out: the width varies from {even:.2f} to 1"
CORNER_PATCH = "both contacts are ends of fillets: a corner or a link between them"
WALL = "a wall between two narrower rounds"
MANY_BASES = "{count} faces along one side, not smooth into each other: no single base"
PINCHED = "its rims meet in a point: three-sided"
NOT_SMOOTH = "no two opposite sides are smooth into their neighbours"
# What a refusal is called where it is counted.
SHORT_NAMES = {
    ROUND_END: "round ends",
    FLAT: "almost flat",
    BENT_NEIGHBOUR: "neighbour bends as much",
    ONE_HULL: "smooth patches",
    TOO_SHORT: "shorter than wide",
    UNEVEN: "running out",
    CORNER_PATCH: "corners and links",
    WALL: "walls between rounds",
    MANY_BASES: "no single base",
    PINCHED: "rims meet in a point",
    NOT_SMOOTH: "no smooth opposite sides",
}

_SMOOTH_SHARE = 0.6
_LEAST_TURN, MOST_TURN = 8.0, 150.0
_EVEN = 0.25
# Half of a side that is an end of another candidate makes the side one.
_END_SHARE = 0.5
_MOST_BASES = 2


@dataclass(frozen=True)
class Refusal:
    """Why a face is no fillet: one of `SHORT_NAMES`, and what was found."""

    rule: str
    found: Mapping[str, float]

    def __str__(self) -> str:
        return self.rule.format(**self.found)


@dataclass(frozen=True, eq=False)
class Fillets:
    """What was decided about the faces that are not planes.

    Attributes
    ----------
    accepted : dict
        Face -> how it lies between its bases.
    on_ends : dict
        Face -> how many of its contacts lie on ends of other fillets.
    round_ends : dict
    refused : dict
        Face -> the reason of the pair of sides that came furthest; round ends among them.
    """

    accepted: dict[int, Between]
    on_ends: dict[int, int]
    round_ends: dict[int, Between]
    refused: dict[int, Refusal]


def find_fillets(graph: EdgeGraph, relations: Relations) -> Fillets:
    """Return which faces are fillets, and why the others are not."""
    candidates: dict[int, Between] = {}
    round_ends: dict[int, Between] = {}
    refused: dict[int, Refusal] = {}
    sides: dict[int, list[Side]] = {}
    for face, kind in enumerate(graph.faces.kind):
        # A face that the file names twice is looked at once.
        if kind == "plane" or graph.faces.same[face] != face:
            continue
        sides[face] = sides_of(graph, relations, face)
        found, refusal = _best_pair(graph, relations, face, sides[face])
        if refusal is None and found is not None:
            candidates[face] = found
        elif refusal is not None:
            refused[face] = refusal
            if refusal.rule == ROUND_END and found is not None:
                round_ends[face] = found
    ends = np.zeros(len(graph.uses), dtype=bool)
    for between in candidates.values():
        ends[_ends(graph, relations, between)] = True
    on_ends = {face: _contacts_on(ends, relations, between) for face, between in candidates.items()}
    for face, between in candidates.items():
        if on_ends[face] == 2 and not between.a.closed:
            refused[face] = Refusal(CORNER_PATCH, {})
    left = {face: between for face, between in candidates.items() if face not in refused}
    rounds = {**round_ends, **left}
    for face, between in left.items():
        if refusal := _beyond(graph, relations, between, rounds):
            refused[face] = refusal
    accepted = {face: between for face, between in left.items() if face not in refused}
    return Fillets(accepted, on_ends, round_ends, refused)


def fillet_ends(graph: EdgeGraph, relations: Relations, betweens: Iterable[Between]) -> Flags:
    """Return which uses lie across the end of a fillet, in the fillet or in the face beyond; shape (U,)."""
    ends = np.zeros(len(graph.uses), dtype=bool)
    for between in betweens:
        own = _own_ends(graph, between)
        ends[own] = True
        ends[_partners(relations, own)] = True
    return ends


def chains(graph: EdgeGraph, relations: Relations, accepted: Mapping[int, Between]) -> list[list[int]]:
    """Return groups of fillets of which each goes on smoothly, over an end of both, in another."""
    root = {face: face for face in accepted}

    def find(face: int) -> int:
        while root[face] != face:
            root[face] = root[root[face]]
            face = root[face]
        return face

    own = {face: set(_own_ends(graph, between)) for face, between in accepted.items()}
    for face, ends in own.items():
        for use in ends:
            partner = int(relations.partner[use])
            if partner == NONE or not relations.smooth[use]:
                continue
            beyond = int(graph.faces.same[graph.uses.face[partner]])
            if beyond in own and partner in own[beyond]:
                root[max(find(face), find(beyond))] = min(find(face), find(beyond))
    groups: dict[int, list[int]] = {}
    for face in accepted:
        groups.setdefault(find(face), []).append(face)
    return [sorted(group) for group in groups.values() if len(group) > 1]


def bases_of(graph: EdgeGraph, relations: Relations, side: Side) -> dict[int, float]:
    """Return the faces along a side with the length that each has of it, the longest first."""
    found: dict[int, float] = {}
    for use in side.uses:
        partner = int(relations.partner[use])
        if partner != NONE:
            face = int(graph.uses.face[partner])
            found[face] = found.get(face, 0.0) + float(relations.length[use])
    return dict(sorted(found.items(), key=lambda item: (-item[1], item[0])))


def score_parts(between: Between, on_ends: int) -> dict[str, float]:
    """Return the factors of the score of a fillet."""
    bent = between.curvature / (3 * between.neighbour) if between.neighbour else 1.0
    return {
        "smooth": float(np.exp(-((between.angle / 6) ** 2))) * between.smooth,
        "curvature": min(1.0, bent),
        "turn": min(1.0, between.turn / 30 + 0.3) * (0.7 if between.turn > 120 else 1.0),
        "even": 0.5 + 0.5 * between.even,
        "length": min(1.0, float(np.sqrt(between.length / between.width))),
        "wavers": 0.5 if between.wavers else 1.0,
        "on_end": 0.6 if on_ends else 1.0,
    }


def _best_pair(
    graph: EdgeGraph, relations: Relations, face: int, sides: list[Side]
) -> tuple[Between | None, Refusal | None]:
    """Return the pair of sides with the largest curvature that no rule refuses, else the one that came furthest."""
    smooth = [side for side in sides if share(relations.smooth, relations.length, side) >= _SMOOTH_SHARE]
    best: Between | None = None
    furthest: tuple[int, Between | None, Refusal] = (0, None, Refusal(NOT_SMOOTH, {}))
    for a, b in combinations(smooth, 2):
        if a.closed != b.closed:
            continue
        if meet_in_a_corner(graph.uses, a, b):
            if furthest[0] == 0 and _is_pinched(sides):
                furthest = (0, None, Refusal(PINCHED, {}))
            continue
        between = measure(graph, relations, face, a, b)
        stage, refusal = _refusal(between)
        if refusal is None:
            best = between if best is None or between.curvature > best.curvature else best
        elif stage > furthest[0]:
            furthest = (stage, between, refusal)
    return (best, None) if best is not None else furthest[1:]


def _is_pinched(sides: list[Side]) -> bool:
    return len(sides) <= 3


def _refusal(between: Between) -> tuple[int, Refusal | None]:
    """Return the number of the first rule that speaks against a pair of sides, and what it says."""
    turn, k, kn, jump = between.turn, between.curvature, between.neighbour, between.jump
    certain = k > 10 * kn and jump > 0.5
    rules: tuple[tuple[str, Callable[[], bool]], ...] = (
        (FLAT, lambda: turn < _LEAST_TURN),
        (ROUND_END, lambda: turn > MOST_TURN),
        (BENT_NEIGHBOUR, lambda: k < 1.5 * kn),
        (ONE_HULL, lambda: jump < 0.4 and (turn < 30 or k < 3 * kn)),
        (TOO_SHORT, lambda: between.length < (0.05 if certain else 0.5) * between.width),
        (UNEVEN, lambda: between.even < _EVEN),
    )
    for stage, (rule, speaks) in enumerate(rules, start=1):
        if speaks():
            return stage, Refusal(rule, {"turn": turn, "even": between.even})
    return len(rules) + 1, None


def _own_ends(graph: EdgeGraph, between: Between) -> list[int]:
    """Return the edges of a fillet across its ends."""
    uses = graph.uses
    sides = {*between.a.uses, *between.b.uses}
    rows = range(*uses.of_face(between.face).indices(len(uses)))
    return [row for row in rows if row not in sides and not (uses.seam[row] or uses.degenerate[row])]


def _partners(relations: Relations, rows: list[int]) -> list[int]:
    return [int(partner) for partner in relations.partner[rows] if partner != NONE]


def _ends(graph: EdgeGraph, relations: Relations, between: Between) -> list[int]:
    """Return the uses, in the faces beyond, of the edges across the ends of a fillet."""
    return _partners(relations, _own_ends(graph, between))


def _contacts_on(ends: Flags, relations: Relations, between: Between) -> int:
    return sum(share(ends, relations.length, side) >= _END_SHARE for side in (between.a, between.b))


def _beyond(graph: EdgeGraph, relations: Relations, between: Between, rounds: Mapping[int, Between]) -> Refusal | None:
    """Return what speaks against a fillet once its neighbours are known."""
    bases = [bases_of(graph, relations, side) for side in (between.a, between.b)]
    longest = [next(iter(found), NONE) for found in bases]
    if all(base in rounds and rounds[base].width < between.width for base in longest):
        return Refusal(WALL, {})
    counts = [_not_smooth_into_each_other(graph, relations, list(found)) for found in bases]
    if max(counts) > _MOST_BASES:
        return Refusal(MANY_BASES, {"count": max(counts)})
    return None


def _not_smooth_into_each_other(graph: EdgeGraph, relations: Relations, faces: list[int]) -> int:
    """Return how many groups there are of faces that go on smoothly in each other."""
    if len(faces) <= _MOST_BASES:
        return len(faces)
    uses, groups = graph.uses, {face: {face} for face in faces}
    for face in faces:
        for use in range(*uses.of_face(face).indices(len(uses))):
            beyond = int(uses.face[relations.partner[use]]) if relations.partner[use] != NONE else NONE
            if relations.smooth[use] and beyond in groups and groups[beyond] is not groups[face]:
                joined = groups[face] | groups[beyond]
                groups |= dict.fromkeys(joined, joined)
    return len({id(group) for group in groups.values()})
