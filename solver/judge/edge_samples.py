"""Two edges side by side: what the referee reads of them at samples that belong together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.base import Base
from semispline.solver.judge.contact import Place
from semispline.solver.judge.correspondence import Correspondence
from semispline.solver.judge.curvature_rates import curvature_rates
from semispline.solver.judge.de_boor import edge_curves
from semispline.solver.judge.pairs import Pace, Pairs, affine_pairs, foot_pairs
from semispline.solver.judge.precise import precise_derivatives
from semispline.solver.judge.rounding import EdgeNoises, edge_noises, noises_of_derivatives
from semispline.solver.judge.square_section import section_noises, square_section
from semispline.solver.splines import NaturalEdge

# Samples that are measured at once.
_AT_ONCE = 8192
# Derivatives at parameters along an edge, each of shape (K, 3); the keys are (order across, order along).
Jet: TypeAlias = Mapping[tuple[int, int], FloatArray]


@dataclass(frozen=True)
class Worst:
    """The largest of some values, and where it is."""

    value: float
    place: Place


@dataclass(frozen=True, eq=False)
class Samples:
    """What samples contribute to a `Contact`.

    Attributes
    ----------
    s_a : ndarray, shape (K,)
    points : ndarray, shape (K, 3)
        On edge a, counted from the origin of the edges.
    values : ndarray, shape (3, K) and more
        Gap, angle (degrees) and jump; and of the rates of curvature, as far as they are asked for. All but the gap are
        not a number where a side has no normal; what follows is of the other samples.
    curvature : float
        Largest of either side, across the edge.
    bend : float
        Largest of either side, across the edge or along it.
    differences, derivatives : (float, float)
        Largest difference of first and second cross derivatives, and largest such derivative of either side.
    noises : tuple of float
        The most that rounding may do to the angle (radians), to the jump, and to those of rates.
    rates : tuple of float
        Largest rate of curvature of either side, and largest second rate.
    """

    s_a: FloatArray
    points: FloatArray
    values: FloatArray
    curvature: float
    bend: float
    differences: tuple[float, ...]
    derivatives: tuple[float, ...]
    noises: tuple[float, ...]
    rates: tuple[float, ...]

    def worst(self, k: int, origin: FloatArray) -> Worst:
        """Return the largest of one kind of values; one that is not a number only where all are."""
        i = int(np.nan_to_num(self.values[k], nan=-np.inf).argmax())
        x, y, z = (self.points[i] + origin).tolist()
        return Worst(float(self.values[k, i]), Place(float(self.s_a[i]), (x, y, z)))

    @staticmethod
    def joined(parts: Sequence[Samples]) -> Samples:
        """Return the samples of all parts, in order."""
        if len(parts) == 1:
            return parts[0]

        def largest(name: str) -> tuple[float, ...]:
            return tuple(most(x) for x in np.array([getattr(part, name) for part in parts]).T)

        return Samples(
            np.concatenate([part.s_a for part in parts]),
            np.concatenate([part.points for part in parts]),
            np.concatenate([part.values for part in parts], axis=1),
            most([part.curvature for part in parts]),
            most([part.bend for part in parts]),
            *(largest(name) for name in ("differences", "derivatives", "noises", "rates")),
        )


class Edges:
    """Both edges, their points counted from an origin."""

    def __init__(self, a: Base, b: Base, matched: Correspondence, origin: FloatArray, order: int) -> None:
        self.a, self.b, self.matched, self.origin, self.order = a, b, matched, origin, order
        self.curves_a, self.curves_b = (edge_curves(base.surface, base.side, order, origin) for base in (a, b))
        self.noises = [edge_noises(base, origin, order) for base in (a, b)]

    @property
    def noise_of_gap(self) -> float:
        """What rounding may do to the distance of two points that belong together."""
        return float(sum(noise.derivatives[0, 0] for noise in self.noises))

    @property
    def affine_pace(self) -> float:
        """How fast b is run through as a is, where parameters correspond affinely."""
        (a_0, a_1), (b_0, b_1) = self.a.range_along, self.b.range_along
        return (b_1 - b_0) / (a_1 - a_0) * (-1.0 if self.matched.flipped else 1.0)

    def affine_pairs(self) -> Pairs:
        """Return parameters that correspond affinely."""
        return affine_pairs(self.a, self.b, self.matched)

    def foot_pairs(self, most: float) -> Pairs | None:
        """Return parameters of points and their feet, where the edges are nowhere more than `most` apart."""
        return foot_pairs(self.a, self.b, self.matched, (self.curves_a, self.curves_b), most)

    def measured(self, s_a: FloatArray, s_b: FloatArray, pace: Pace | None = None) -> Samples:
        """Measure at parameters along a and along b that correspond, affinely where no pace is given."""
        # Part by part: a long edge has more samples than memory should hold at once.
        return Samples.joined(
            [self._part(s_a[i : i + _AT_ONCE], s_b[i : i + _AT_ONCE], pace) for i in range(0, len(s_a), _AT_ONCE)]
        )

    def measured_precisely(self, s_a: FloatArray, s_b: FloatArray, pace: Pace | None = None) -> Samples:
        """Measure so that derivatives are rounded but once: of the surfaces as they are stored; slow."""
        jets = [precise_derivatives(base, self.origin, s, self.order) for base, s in ((self.a, s_a), (self.b, s_b))]
        return self._of_jets(s_a, s_b, jets, [noises_of_derivatives(jet, self.order) for jet in jets], pace)

    def values(self, s_a: FloatArray, s_b: FloatArray, kinds: Sequence[int]) -> FloatArray:
        """Return some kinds of values, numbered as in `Samples`, shape (kinds, K)."""
        order = max(2, *kinds)
        sides = self._sides(self._jets(s_a, s_b, order))
        found = _values(*sides)
        if order > 2:
            found += [rate.jumps for rate in self._rates(*sides, self.noises, order)]
        return np.stack([found[kind] for kind in kinds])

    def _jets(self, s_a: FloatArray, s_b: FloatArray, order: int) -> list[Jet]:
        return [self.curves_a.points(s_a, order), self.curves_b.points(s_b, order)]

    def _sides(self, jets: Sequence[Jet]) -> tuple[_Side, _Side]:
        side_a = _Side(jets[0], self.a.side, 1.0)
        return side_a, _Side(jets[1], self.b.side, 1.0 if self.matched.flipped else -1.0)

    @property
    def _sign(self) -> float:
        """One side is left backwards: odd derivatives change sign unless the edges are at opposite ends."""
        return -1.0 if self.a.side[1] == self.b.side[1] else 1.0

    def _part(self, s_a: FloatArray, s_b: FloatArray, pace: Pace | None) -> Samples:
        return self._of_jets(s_a, s_b, self._jets(s_a, s_b, self.order), self.noises, pace)

    def _of_jets(
        self, s_a: FloatArray, s_b: FloatArray, jets: Sequence[Jet], noises: Sequence[EdgeNoises], pace_at: Pace | None
    ) -> Samples:
        side_a, side_b = self._sides(jets)
        k_a, k_b = side_a.section.curvature, side_b.section.curvature
        pace: Any = self.affine_pace if pace_at is None else pace_at(s_a, s_b)
        first, second = _apart_along(side_a, side_b, pace)
        of_angle, of_curvature = np.add(
            side_a.noises(noises[0], (first, second)),
            side_b.noises(noises[1], (first / abs(pace), second / pace**2)),
        )
        rates = self._rates(side_a, side_b, noises, self.order)
        return Samples(
            s_a,
            side_a.point,
            np.stack([*_values(side_a, side_b), *(rate.jumps for rate in rates)]),
            curvature=most(np.abs([k_a, k_b])),
            bend=most(np.abs([k_a, k_b, side_a.curvature_along(), side_b.curvature_along()])),
            differences=(_longest(side_a.x_w - self._sign * side_b.x_w), _longest(side_a.x_ww - side_b.x_ww)),
            derivatives=(_longest(side_a.x_w, side_b.x_w), _longest(side_a.x_ww, side_b.x_ww)),
            noises=(most(of_angle), most(of_curvature), *(rate.noise for rate in rates)),
            rates=tuple(rate.largest for rate in rates),
        )

    def _rates(self, side_a: _Side, side_b: _Side, noises: Sequence[EdgeNoises], order: int) -> list[_Rate]:
        if order == 2:
            return []
        rates_a, rates_b = (
            curvature_rates(side.at, side.normal, of.derivatives, order)
            for side, of in zip((side_a, side_b), noises, strict=True)
        )
        found = []
        # The first rate is an odd derivative, the second an even one.
        for k, turn in enumerate((self._sign, 1.0)[: order - 2]):
            rate_a, rate_b = rates_a.values[k], rates_b.values[k]
            noise = most(rates_a.noises[k] + rates_b.noises[k])
            found.append(_Rate(np.abs(rate_a - turn * rate_b), most(np.abs([rate_a, rate_b])), noise))
        return found


@dataclass(frozen=True, eq=False)
class _Rate:
    """What some of the samples say of a rate of curvature: its jumps, its largest value, and its rounding."""

    jumps: FloatArray
    largest: float
    noise: float


def _apart_along(side_a: _Side, side_b: _Side, pace: Any) -> tuple[FloatArray, FloatArray]:
    """Return how far first and second derivatives along the edges differ; b is run through at a pace, of a's."""
    if isinstance(pace, float):
        return (
            np.linalg.norm(side_a.x_s - pace * side_b.x_s, axis=1),
            np.linalg.norm(side_a.x_ss - pace**2 * side_b.x_ss, axis=1),
        )
    first = side_a.x_s - pace[:, None] * side_b.x_s
    second = side_a.x_ss - (pace**2)[:, None] * side_b.x_ss
    # The pace may change on the way.
    change = np.sum(second * side_b.x_s, axis=1) / np.sum(side_b.x_s**2, axis=1)
    return np.linalg.norm(first, axis=1), np.linalg.norm(second - change[:, None] * side_b.x_s, axis=1)


def _values(side_a: _Side, side_b: _Side) -> list[FloatArray]:
    """Return gaps, angles in degrees and jumps of curvature, each of shape (K,)."""
    sine = np.linalg.norm(_cross(side_a.normal, side_b.normal), axis=1)
    angle = np.degrees(np.arctan2(sine, np.sum(side_a.normal * side_b.normal, axis=1)))
    gap = np.linalg.norm(side_a.point - side_b.point, axis=1)
    return [gap, angle, np.abs(side_a.section.curvature - side_b.section.curvature)]


class _Side:
    """Referee's values along one edge: w runs across, s along.

    The normal is that of the direction into the surface and the direction along the edge, times `sign`: so two sides
    that continue each other, one taken with the opposite sign, have one normal, and a fold back turns it over.
    """

    def __init__(self, at: Jet, edge: NaturalEdge, sign: float) -> None:
        self.at = at
        self.point, self.x_w, self.x_s = at[0, 0], at[1, 0], at[0, 1]
        self.x_ww, self.x_ss = at[2, 0], at[0, 2]
        cross = _cross(self.x_w, self.x_s)
        length = np.linalg.norm(cross, axis=1)
        scale = np.linalg.norm(self.x_w, axis=1) * np.linalg.norm(self.x_s, axis=1)
        inwards = -sign if edge[1] == "1" else sign
        regular = (length > 1e-12 * scale)[:, None]
        self.normal = np.divide(inwards * cross, length[:, None], out=np.full_like(cross, np.nan), where=regular)
        self.section = square_section(at, self.normal)

    def curvature_along(self) -> FloatArray:
        """Return normal curvature in the direction of the edge, shape (K,)."""
        return np.asarray(np.sum(self.x_ss * self.normal, axis=1) / np.sum(self.x_s**2, axis=1))

    def noises(self, noises: EdgeNoises, apart: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
        """Return what rounding may do to the normal (radians) and to the curvature across, from that of derivatives."""
        return section_noises(self.at, self.normal, self.section, noises, apart)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross product of vectors along axis 1, in memory one coordinate after the other."""
    (x, y, z), (u, v, w) = a.T, b.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u]).T


def most(values: ArrayLike) -> float:
    """Return the largest value that is a number, as where a surface has a normal; else not a number."""
    known = np.asarray(values, dtype=np.float64)
    known = known[~np.isnan(known)]
    return float(known.max()) if known.size else float("nan")


def _longest(*vectors: FloatArray) -> float:
    return max(float(np.linalg.norm(x, axis=1).max()) for x in vectors)
