"""A face between two of its sides: width, turn, curvature across, and the faces beyond; what decides what it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.half_edges import EdgeGraph, Flags, Uses
from semispline.solver.topology.relations import Relations, to_polyline
from semispline.solver.topology.sides import Side, stacked

# A contact's curvature that is this fraction of the other sign says that the face turns over along its rims.
_WAVERS = 0.1


@dataclass(frozen=True, eq=False)
class Between:
    """A face between two opposite sides of it.

    Attributes
    ----------
    face : int
    a, b : Side
    width : float
        Median distance from side to side.
    even : float
        How even the width is, from 0 to 1: its quantile 0.1 divided by its quantile 0.9.
    turn : float
        Median angle between the normals of the face at both sides, in degrees.
    curvature : float
        Turn over arc, 1 / radius of a round; 0 where the face does not turn.
    sign : float
        -1 where the face bends away from its normal, as a convex round does.
    neighbour : float
        Curvature of the faces beyond at the contacts, across, of the same sign; not below 0.
    jump : float
        The lesser jump of curvature at both contacts, in fractions of `curvature`: near 0 at G2 contacts, 1 at rounds
        between planes.
    length : float
        Mean of both sides.
    smooth : float
        Smooth share of the side that has less of it.
    angle : float
        The larger median of the angles at both contacts, in degrees.
    wavers : bool
        The curvature across changes its sign along the rims, as in the bend of a pipe.
    """

    face: int
    a: Side
    b: Side
    width: float
    even: float
    turn: float
    curvature: float
    sign: float
    neighbour: float
    jump: float
    length: float
    smooth: float
    angle: float
    wavers: bool

    @property
    def radius(self) -> float:
        """The radius of the round that turns as much over the same width."""
        return 1 / self.curvature if self.curvature else float("inf")


def share(flags: Flags, length: FloatArray, side: Side) -> float:
    """Return the share of the length of a side for which edges have a flag."""
    rows = list(side.uses)
    total = float(length[rows].sum())
    return float(length[rows][flags[rows]].sum()) / total if total else 0.0


def meet_in_a_corner(uses: Uses, a: Side, b: Side) -> bool:
    """Tell whether two open sides have a common end; an edge that is a point lies between them at most."""
    if a.closed or b.closed:
        return False
    for one, two in ((a, b), (b, a)):
        after = int(uses.following[one.uses[-1]])
        while uses.degenerate[after]:
            after = int(uses.following[after])
        if after == two.uses[0]:
            return True
    return False


def width_of(graph: EdgeGraph, a: Side, b: Side) -> tuple[float, float]:
    """Return the median distance between two sides, and how even it is."""
    lines = [stacked(graph.uses.points, graph.uses, side.uses) for side in (a, b)]
    away = np.concatenate([to_polyline(lines[0], lines[1]), to_polyline(lines[1], lines[0])])
    low, middle, high = np.quantile(away, (0.1, 0.5, 0.9)).tolist()
    return middle, low / high if high else 0.0


def measure(graph: EdgeGraph, relations: Relations, face: int, a: Side, b: Side) -> Between:
    """Return what is said of a face between two of its sides."""
    uses, length = graph.uses, relations.length
    width, even = width_of(graph, a, b)
    turn, away = _turn(uses, a, b)
    half = np.radians(turn) / 2
    curvature = 2 * float(np.sin(half)) / width if width else 0.0
    sign = -1.0 if away > 0 else 1.0
    contacts = [_contact(uses, relations, side, sign) for side in (a, b)]
    own = np.concatenate([sign * uses.across[list(side.uses)].ravel() for side in (a, b)])
    return Between(
        face=face,
        a=a,
        b=b,
        width=width,
        even=even,
        turn=turn,
        curvature=curvature,
        sign=sign,
        neighbour=max(0.0, *(contact[1] for contact in contacts)),
        jump=min(contact[0] - contact[1] for contact in contacts) / curvature if curvature else 0.0,
        length=(a.length + b.length) / 2,
        smooth=min(share(relations.smooth, length, side) for side in (a, b)),
        angle=max(contact[2] for contact in contacts),
        wavers=bool(own.min() < -_WAVERS * curvature and own.max() > _WAVERS * curvature),
    )


def opposite(uses: Uses, a: Side, b: Side) -> tuple[Sequence[int], FloatArray, FloatArray]:
    """Return of each sample of a the nearest of b, and the points of both."""
    p, q = stacked(uses.points, uses, a.uses), stacked(uses.points, uses, b.uses)
    away = p[:, None] - q
    nearest = np.argmin(np.einsum("ksd,ksd->ks", away, away), axis=1)
    return nearest.tolist(), p, q


def _turn(uses: Uses, a: Side, b: Side) -> tuple[float, float]:
    """Return the median angle of the normals at samples of a and the nearest of b, and how much they part."""
    nearest, p, q = opposite(uses, a, b)
    n, m = stacked(uses.normal, uses, a.uses), stacked(uses.normal, uses, b.uses)[nearest]
    angles = np.arctan2(np.linalg.norm(np.cross(n, m), axis=1), np.sum(n * m, axis=1))
    return float(np.degrees(np.median(angles))), float(np.median(np.sum((m - n) * (q[nearest] - p), axis=1)))


def _contact(uses: Uses, relations: Relations, side: Side, sign: float) -> tuple[float, float, float]:
    """Return medians along a side: signed curvatures of the face and of its neighbours across, angle in degrees."""
    rows = [use for use in side.uses if np.isfinite(relations.median[use])]
    if not rows:
        return 0.0, 0.0, np.inf
    own, bend = (sign * float(np.median(x[rows])) for x in (uses.across, relations.bend))
    weight = np.repeat(relations.length[rows], 1)
    order = np.argsort(relations.median[rows])
    half = np.searchsorted(np.cumsum(weight[order]), weight.sum() / 2)
    return own, bend, float(relations.median[rows][order][min(int(half), len(rows) - 1)])
