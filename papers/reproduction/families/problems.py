"""A pair of bases with its name, and how it lies: gap, exit angles, speeds, domains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import Base, correspond, corresponding
from semispline.solver.splines import BSplineSurface, NaturalEdge, map_domain, reverse_u, reverse_v, swap_directions

Family: TypeAlias = Literal["facing", "u-turn", "closed rims", "rough", "real"]

# Places along the contacts over which a pair is measured.
_PLACES = 256


@dataclass(frozen=True)
class PairMeasures:
    """How two bases lie to each other; means over the contact, a and b in turn.

    Attributes
    ----------
    gap : float
        Mean distance of corresponding points over the mean length of both contacts.
    exit_degrees : (float, float)
        Mean angle between the way out of the base, along its own parameter, and the straight way across.
    least_exit_to_edge_degrees : float
        Least angle anywhere between the way out and the contact curve: at 0 a base has no normal.
    speeds : (float, float)
        Mean speed across the contact, in mean contact lengths over the base's own parameter.
    domains : (float, float)
        Lengths of the parameter ranges along the contacts.
    bends : (float, float)
        Largest normal curvature across the contact times the mean gap: with G2 a blend begins with that bend.
    edge_turn_degrees : (float, float)
        How far the normal turns in all along the contact.
    """

    gap: float
    exit_degrees: tuple[float, float]
    least_exit_to_edge_degrees: float
    speeds: tuple[float, float]
    domains: tuple[float, float]
    bends: tuple[float, float]
    edge_turn_degrees: tuple[float, float]


@dataclass(frozen=True, eq=False)
class ShapeProblem:
    """A pair of bases that is to be blended.

    Attributes
    ----------
    name : str
        Family and seed, or the file and its faces.
    family : {"facing", "u-turn", "closed rims", "rough", "real"}
    kind : str
        What it is within its family.
    seed : int
        Makes the same pair again; the place in the list for real ones.
    a, b : Base
    measures : PairMeasures
    """

    name: str
    family: Family
    kind: str
    seed: int
    a: Base
    b: Base
    measures: PairMeasures


def measure_pair(a: Base, b: Base) -> PairMeasures:
    """Measure how two bases lie to each other, by the referee's evaluation.

    Examples
    --------
    >>> k = [0, 0, 1, 1]
    >>> floor = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 2, 0]], [[1, 0, 0], [1, 2, 0]]])
    >>> wall = BSplineSurface(1, 1, k, k, [[[2, 0, 0], [2, 2, 0]], [[2, 0, 2], [2, 2, 2]]])
    >>> pair = measure_pair(Base(floor, "u1"), Base(wall, "u0"))
    >>> pair.gap, pair.exit_degrees, pair.speeds
    (0.5, (0.0, 90.0), (0.5, 1.0))
    """
    start, end = a.range_along
    s = start + (end - start) * (np.arange(_PLACES) + 0.5) / _PLACES
    places = s, corresponding(a, b, correspond(a, b), s)
    (p, across_p, along_p), (q, across_q, along_q) = (
        [base.derivative(t, *orders) for orders in ((0, 0), (1, 0), (0, 1))]
        for base, t in zip((a, b), places, strict=True)
    )
    domains = [float(base.range_along[1] - base.range_along[0]) for base in (a, b)]
    lengths = [float(_norm(x).mean()) * domain for x, domain in zip((along_p, along_q), domains, strict=True)]
    length, gap = (lengths[0] + lengths[1]) / 2, float(_norm(q - p).mean())
    exits = (-_inwards(base) * across for base, across in zip((a, b), (across_p, across_q), strict=True))
    exit_a, exit_b = (float(_degrees(x, way).mean()) for x, way in zip(exits, (q - p, p - q), strict=True))
    to_edge = np.stack([_degrees(across_p, along_p), _degrees(across_q, along_q)])
    (bend_a, turn_a), (bend_b, turn_b) = (_bend_and_turn(base) for base in (a, b))
    return PairMeasures(
        gap / length,
        (exit_a, exit_b),
        float(np.minimum(to_edge, 180 - to_edge).min()),
        (float(_norm(across_p).mean() / length), float(_norm(across_q).mean() / length)),
        (domains[0], domains[1]),
        (bend_a * gap, bend_b * gap),
        (turn_a, turn_b),
    )


def _inwards(base: Base) -> int:
    return 1 if base.side[1] == "0" else -1


def _bend_and_turn(base: Base) -> tuple[float, float]:
    """Return the largest normal curvature across an edge, and how far the normal turns along it in degrees."""
    s = np.linspace(*base.range_along, _PLACES)
    across, second, along = (base.derivative(s, *orders) for orders in ((1, 0), (2, 0), (0, 1)))
    normal = np.cross(across, along)
    normal /= _norm(normal)[:, None]
    curvature = np.abs(np.sum(second * normal, axis=1)) / np.sum(across**2, axis=1)
    return float(curvature.max()), float(_degrees(normal[1:], normal[:-1]).sum())


def on_edge(rng: np.random.Generator, surface: BSplineSurface, decades: float) -> Base:
    """Return a surface, met along its edge u0, so that it is met along any edge, run either way, in other parameters.

    The logarithms of the lengths of both domains spread evenly over so many decades about 0.
    """
    edges: tuple[NaturalEdge, ...] = get_args(NaturalEdge)
    edge = edges[int(rng.integers(len(edges)))]
    lengths = 10.0 ** rng.uniform(-decades / 2, decades / 2, 2)
    starts = rng.uniform(-1, 1, 2) * lengths
    backwards = rng.random() < 0.5
    u_range, v_range = ((float(x), float(x + length)) for x, length in zip(starts, lengths, strict=True))
    turned = map_domain(surface, u_range, v_range)
    turned = reverse_v(turned) if backwards else turned
    turned = reverse_u(turned) if edge[1] == "1" else turned
    if edge[0] == "v":
        turned = swap_directions(turned)
    return Base(turned, edge)


def _norm(x: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(x, axis=-1))


def _degrees(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.asarray(np.degrees(np.arctan2(_norm(np.cross(x, y)), np.sum(x * y, axis=-1))))
