"""Measured continuity along a shared edge, by the de Boor referee alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError, OptionError
from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.contact import Contact, Place
from semispline.solver.judge.correspondence import Correspondence, correspond, corresponding
from semispline.solver.judge.curvature_rates import curvature_rates
from semispline.solver.judge.de_boor import EdgeCurves, edge_curves
from semispline.solver.judge.edge_normals import places_without_normal
from semispline.solver.judge.limits import GAP_LIMIT, allowed_measures
from semispline.solver.judge.pairs import Pace, Pairs, affine_pairs, foot_pairs, places_between
from semispline.solver.judge.rounding import EdgeNoises, edge_noises
from semispline.solver.judge.square_section import section_noises, square_section
from semispline.solver.options import Flip
from semispline.solver.scalars import whole_number
from semispline.solver.splines import Surface, bounding_box

# Samples that are measured at once.
_AT_ONCE = 8192
# A curvature below this, over the size of the model, is none; of its rates, over the square and the cube of the size.
_STRAIGHT = 1e-3
# Edges are one curve with two parametrisations where feet remove a gap, or leave no more than this part of it.
_REMOVED = 1e-3


def measure_contact(
    a: Base, b: Base, flip: Flip = "auto", correspondence: Correspondence | None = None, order: int = 2
) -> Contact:
    """Measure how edge a and edge b meet.

    Parameters along the edges correspond affinely; where that leaves a gap, and the edges are one curve all the same,
    each point corresponds to its foot on the other edge. The worst is sought between samples too.

    Parameters
    ----------
    a, b : Base
    flip : {"auto", "yes", "no"}
        Whether the edges run in opposite directions; "auto" takes the closer way.
    correspondence : Correspondence, optional
        How the edges correspond, where that is known.
    order : {2, 3, 4}
        Up to which order of contact to measure: 3 adds the rate of curvature, 4 its second rate.

    Returns
    -------
    Contact

    Raises
    ------
    EdgeError
        `flip` is not one of auto, yes, no; or both surfaces are one point.
    OptionError
        An order that is not measured.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> left = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> right = BSplineSurface(1, 1, k, k, [[[1, 0, 0], [1, 1, 0]], [[2, 0, 1], [2, 1, 1]]])
    >>> round(measure_contact(Base(left, "u1"), Base(right, "u0")).angle_degrees, 12)
    45.0
    """
    if whole_number(order, "order", 2, OptionError) > 4:
        raise OptionError(f"order: found {order!r}, expected 2, 3 or 4")
    size = model_size(a.surface, b.surface)
    if not size > 0:
        raise EdgeError("surfaces: all control points are one point, expected surfaces")
    matched = correspondence or correspond(a, b, flip)
    # Far from the origin each operation would round by the distance, and hide what the surfaces themselves do.
    origin = local_origin(a.surface, b.surface)
    edges = _Edges(a, b, matched, origin, order)
    affine = edges.affine_pairs()
    sampled = edges.measured(affine.s_a, affine.s_b)
    noises = [noise.derivatives[:, 0].tolist() for noise in edges.noises]
    of_gap = noises[0][0] + noises[1][0]
    pairs, found = affine, sampled
    worst_gap = float(sampled.values[0].max())
    if worst_gap > GAP_LIMIT * size + of_gap:
        # Perhaps one curve with two parametrisations.
        feet = edges.foot_pairs(max(GAP_LIMIT * size + of_gap, _REMOVED * worst_gap))
        if feet is not None:
            pairs, found = feet, edges.measured(feet.s_a, feet.s_b, feet.pace)
    (c1, c2), (first, second) = found.differences, found.derivatives
    found = _with_worst_between(edges, pairs, found, of_gap)
    worst = [found.worst(k, origin) for k in range(len(found.values))]
    gap, angle, jump = worst[:3]
    largest = max(found.curvature, _STRAIGHT / size)
    # Flat: what bends by the size of the model is the measure; and nearly so, as of curvatures.
    bent = first * first / size
    second = bent if second <= noises[0][2] + noises[1][2] else max(second, _STRAIGHT * bent)
    rounding = {
        "gap": of_gap,
        "angle_degrees": float(np.degrees(found.noises[0])),
        "curvature_jump_relative": found.noises[1] / largest,
        "c1_residual": _over(noises[0][1] + noises[1][1], first),
        "c2_residual": _over(noises[0][2] + noises[1][2], second),
    }
    rates, rates_rounding = _rate_measures(worst[3:], found, size)
    rounding |= rates_rounding
    return Contact(
        gap=gap.value,
        angle_degrees=angle.value,
        curvature_jump=jump.value,
        curvature_jump_relative=jump.value / largest,
        c1_residual=_over(c1, first),
        c2_residual=_over(c2, second),
        size=size,
        rounding=rounding,
        allowed=allowed_measures(size, rounding),
        no_normal=(*places_without_normal(a, "a"), *places_without_normal(b, "b")),
        gap_at=gap.place,
        angle_at=angle.place,
        curvature_at=jump.place,
        flipped=matched.flipped,
        shift=matched.shift,
        corresponds=pairs.corresponds,
        **rates,
    )


def corresponding_points(a: Base, b: Base, matched: Correspondence, s: FloatArray) -> FloatArray:
    """Return the parameters along edge b that belong to `s` along edge a as `measure_contact` has it, by feet too."""
    contact = measure_contact(a, b, correspondence=matched)
    if contact.corresponds == "affine":
        return corresponding(a, b, matched, s)
    curves = tuple(edge_curves(base.surface, base.side, 1, local_origin(a.surface, b.surface)) for base in (a, b))
    pairs = foot_pairs(a, b, matched, (curves[0], curves[1]), 2 * max(contact.gap, contact.allowed["gap"]))
    assert pairs is not None
    return pairs.along_b(s)


@dataclass(frozen=True)
class _Worst:
    """The largest of some values, or the first that is not a number, and where it is."""

    value: float
    place: Place


@dataclass(frozen=True, eq=False)
class _Samples:
    """What samples contribute to a `Contact`.

    Attributes
    ----------
    s_a : ndarray, shape (K,)
    points : ndarray, shape (K, 3)
        On edge a, counted from the origin of the edges.
    values : ndarray, shape (3, K) and more
        Gap, angle (degrees) and jump; and of the rates of curvature, as far as they are asked for.
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

    def worst(self, k: int, origin: FloatArray) -> _Worst:
        """Return the largest of one kind of values."""
        i = int(self.values[k].argmax())
        x, y, z = (self.points[i] + origin).tolist()
        return _Worst(float(self.values[k, i]), Place(float(self.s_a[i]), (x, y, z)))

    @staticmethod
    def joined(parts: Sequence[_Samples]) -> _Samples:
        """Return the samples of all parts, in order."""
        if len(parts) == 1:
            return parts[0]

        def largest(name: str) -> tuple[float, ...]:
            return tuple(np.max([getattr(part, name) for part in parts], axis=0).tolist())

        return _Samples(
            np.concatenate([part.s_a for part in parts]),
            np.concatenate([part.points for part in parts]),
            np.concatenate([part.values for part in parts], axis=1),
            float(np.max([part.curvature for part in parts])),
            float(np.max([part.bend for part in parts])),
            *(largest(name) for name in ("differences", "derivatives", "noises", "rates")),
        )


class _Edges:
    """Both edges, their points counted from an origin."""

    def __init__(self, a: Base, b: Base, matched: Correspondence, origin: FloatArray, order: int) -> None:
        self.a, self.b, self.matched, self.order = a, b, matched, order
        self.curves_a, self.curves_b = (edge_curves(base.surface, base.side, order, origin) for base in (a, b))
        self.noises = [edge_noises(base, origin, order) for base in (a, b)]

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

    def measured(self, s_a: FloatArray, s_b: FloatArray, pace: Pace | None = None) -> _Samples:
        """Measure at parameters along a and along b that correspond, affinely where no pace is given."""
        # Part by part: a long edge has more samples than memory should hold at once.
        return _Samples.joined(
            [self._part(s_a[i : i + _AT_ONCE], s_b[i : i + _AT_ONCE], pace) for i in range(0, len(s_a), _AT_ONCE)]
        )

    def values(self, s_a: FloatArray, s_b: FloatArray, kinds: Sequence[int]) -> FloatArray:
        """Return some kinds of values, numbered as in `_Samples`, shape (kinds, K)."""
        order = max(2, *kinds)
        sides = self._sides(s_a, s_b, order)
        found = _values(*sides)
        if order > 2:
            found += [rate.jumps for rate in self._rates(*sides, order)]
        return np.stack([found[kind] for kind in kinds])

    def _sides(self, s_a: FloatArray, s_b: FloatArray, order: int) -> tuple[_Side, _Side]:
        side_a = _Side(self.curves_a, self.a.side, s_a, 1.0, order)
        return side_a, _Side(self.curves_b, self.b.side, s_b, 1.0 if self.matched.flipped else -1.0, order)

    @property
    def _sign(self) -> float:
        """One side is left backwards: odd derivatives change sign unless the edges are at opposite ends."""
        return -1.0 if self.a.side[1] == self.b.side[1] else 1.0

    def _part(self, s_a: FloatArray, s_b: FloatArray, pace_at: Pace | None) -> _Samples:
        side_a, side_b = self._sides(s_a, s_b, self.order)
        k_a, k_b = side_a.section.curvature, side_b.section.curvature
        pace: Any = self.affine_pace if pace_at is None else pace_at(s_a, s_b)
        first, second = _apart_along(side_a, side_b, pace)
        of_angle, of_curvature = np.add(
            side_a.noises(self.noises[0], (first, second)),
            side_b.noises(self.noises[1], (first / abs(pace), second / pace**2)),
        )
        rates = self._rates(side_a, side_b, self.order)
        return _Samples(
            s_a,
            side_a.point,
            np.stack([*_values(side_a, side_b), *(rate.jumps for rate in rates)]),
            curvature=float(np.max(np.abs([k_a, k_b]))),
            bend=float(np.max(np.abs([k_a, k_b, side_a.curvature_along(), side_b.curvature_along()]))),
            differences=(_longest(side_a.x_w - self._sign * side_b.x_w), _longest(side_a.x_ww - side_b.x_ww)),
            derivatives=(_longest(side_a.x_w, side_b.x_w), _longest(side_a.x_ww, side_b.x_ww)),
            noises=(float(of_angle.max()), float(of_curvature.max()), *(rate.noise for rate in rates)),
            rates=tuple(rate.largest for rate in rates),
        )

    def _rates(self, side_a: _Side, side_b: _Side, order: int) -> list[_Rate]:
        if order == 2:
            return []
        rates_a, rates_b = (
            curvature_rates(side.at, side.normal, noises.derivatives, order)
            for side, noises in zip((side_a, side_b), self.noises, strict=True)
        )
        found = []
        # The first rate is an odd derivative, the second an even one.
        for k, turn in enumerate((self._sign, 1.0)[: order - 2]):
            rate_a, rate_b = rates_a.values[k], rates_b.values[k]
            noise = float(np.max(rates_a.noises[k] + rates_b.noises[k]))
            found.append(_Rate(np.abs(rate_a - turn * rate_b), float(np.max(np.abs([rate_a, rate_b]))), noise))
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


def _with_worst_between(edges: _Edges, pairs: Pairs, found: _Samples, of_gap: float) -> _Samples:
    """Return the samples with the worst places between them, for values that are more than rounding."""
    noises = (of_gap, float(np.degrees(found.noises[0])), *found.noises[1:])
    telling = [k for k, noise in enumerate(noises) if found.values[k].max() > noise]
    if not telling:
        return found

    def values(s_a: FloatArray) -> FloatArray:
        return edges.values(s_a, pairs.along_b(s_a), telling)

    s_a = places_between(values, found.s_a, found.values[telling], pairs.breaks)
    if not len(s_a):
        return found
    more = edges.measured(s_a, pairs.along_b(s_a), pairs.pace)
    if not np.isfinite(more.values).all():
        # Beside a place without a normal.
        return found
    # What is rounding stays as it was sampled.
    worse = np.full_like(more.values, -np.inf)
    worse[telling] = more.values[telling]
    return replace(_Samples.joined([found, replace(more, values=worse)]), noises=found.noises)


def _values(side_a: _Side, side_b: _Side) -> list[FloatArray]:
    """Return gaps, angles in degrees and jumps of curvature, each of shape (K,)."""
    sine = np.linalg.norm(_cross(side_a.normal, side_b.normal), axis=1)
    angle = np.degrees(np.arctan2(sine, np.sum(side_a.normal * side_b.normal, axis=1)))
    gap = np.linalg.norm(side_a.point - side_b.point, axis=1)
    return [gap, angle, np.abs(side_a.section.curvature - side_b.section.curvature)]


def _rate_measures(worst: Sequence[_Worst], found: _Samples, size: float) -> tuple[dict[str, Any], dict[str, float]]:
    """Return what `Contact` holds of the rates of curvature, and what rounding may do to it.

    What bends along the edge counts too: a pipe is straight across its rim, and a jump is small or large beside its
    radius, not beside its length.
    """
    result: dict[str, Any] = {}
    rounding = {}
    for name, power, jump, largest, noise in zip(
        ("rate", "second_rate"), (2, 3), worst, found.rates, found.noises[2:], strict=False
    ):
        scale = max(largest, found.bend**power, _STRAIGHT / size**power)
        result |= {f"{name}_jump": jump.value, f"{name}_jump_relative": jump.value / scale, f"{name}_at": jump.place}
        rounding[f"{name}_jump_relative"] = noise / scale
    return result, rounding


class _Side:
    """Referee's values along one edge: w runs across, s along.

    The normal is that of the direction into the surface and the direction along the edge, times `sign`: so two sides
    that continue each other, one taken with the opposite sign, have one normal, and a fold back turns it over.
    """

    def __init__(self, curves: EdgeCurves, edge: str, s: FloatArray, sign: float, order: int) -> None:
        self.at = at = curves.points(s, order)
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


def model_size(*surfaces: Surface) -> float:
    """Return the largest extent of the control points of all surfaces, model units."""
    boxes = np.stack([bounding_box(surface) for surface in surfaces])
    return float((boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)).max())


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross product of vectors along axis 1, in memory one coordinate after the other."""
    (x, y, z), (u, v, w) = a.T, b.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u]).T


def _longest(*vectors: FloatArray) -> float:
    return max(float(np.linalg.norm(x, axis=1).max()) for x in vectors)


def _over(value: float, largest: float) -> float:
    """Return a value over a derivative; where both are zero nothing is known of it, and that is left to rounding."""
    if largest > 0:
        return value / largest
    return 0.0 if value == 0 else np.inf
