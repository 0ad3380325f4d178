"""Measured continuity along a shared edge, by the de Boor referee alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError, OptionError
from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.contact import Contact, Place
from semispline.solver.judge.correspondence import Correspondence, correspond, corresponding_samples
from semispline.solver.judge.curvature_rates import curvature_rates
from semispline.solver.judge.de_boor import EdgeCurves, edge_curves
from semispline.solver.judge.edge_normals import places_without_normal
from semispline.solver.judge.limits import allowed_measures
from semispline.solver.judge.rounding import EdgeNoises, edge_noises
from semispline.solver.judge.square_section import section_noises, square_section
from semispline.solver.options import Flip
from semispline.solver.scalars import whole_number
from semispline.solver.splines import Surface, bounding_box

# Samples that are measured at once.
_AT_ONCE = 8192
# A curvature below this, over the size of the model, is none; of its rates, over the square and the cube of the size.
_STRAIGHT = 1e-3


def measure_contact(
    a: Base, b: Base, flip: Flip = "auto", correspondence: Correspondence | None = None, order: int = 2
) -> Contact:
    """Measure how edge a and edge b meet; parameters along the edges correspond affinely.

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
    edges = _Edges(a, b, matched.flipped, origin, order)
    s_a, s_b = corresponding_samples(a, b, matched)
    # Part by part: a long edge has more samples than memory should hold at once.
    starts = range(0, len(s_a), _AT_ONCE)
    parts = [edges.measured(s_a[i : i + _AT_ONCE], s_b[i : i + _AT_ONCE]) for i in starts]
    gap, angle, jump = (_first_worst([getattr(part, name) for part in parts]) for name in ("gap", "angle", "jump"))
    largest = float(np.maximum(np.max([part.curvature for part in parts]), _STRAIGHT / size))
    (c1, c2), (first, second) = (
        np.max([getattr(part, name) for part in parts], 0).tolist() for name in ("differences", "derivatives")
    )
    angle_noise, curvature_noise = np.max([part.noises for part in parts], axis=0).tolist()
    noises = [noise.derivatives[:, 0].tolist() for noise in edges.noises]
    # Flat: what bends by the size of the model is the measure; and nearly so, as of curvatures.
    bent = first * first / size
    second = bent if second <= noises[0][2] + noises[1][2] else max(second, _STRAIGHT * bent)
    rounding = {
        "gap": noises[0][0] + noises[1][0],
        "angle_degrees": float(np.degrees(angle_noise)),
        "curvature_jump_relative": curvature_noise / largest,
        "c1_residual": _over(noises[0][1] + noises[1][1], first),
        "c2_residual": _over(noises[0][2] + noises[1][2], second),
    }
    rates, rates_rounding = _rate_measures(
        [part.rates for part in parts], float(np.max([part.bend for part in parts])), size
    )
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
        **rates,
    )


@dataclass(frozen=True)
class _Worst:
    """The largest of some values, or the first that is not a number, and where it is."""

    value: float
    place: Place


@dataclass(frozen=True)
class _Part:
    """What some of the samples contribute to a `Contact`.

    Attributes
    ----------
    gap, angle, jump : _Worst
    curvature : float
        Largest of either side, across the edge.
    bend : float
        Largest of either side, across the edge or along it.
    differences, derivatives : (float, float)
        Largest difference of first and second cross derivatives, and largest such derivative of either side.
    noises : (float, float)
        The most that rounding may do to the angle (radians) and to the jump.
    rates : tuple of _Rate
        Of the rate of curvature and of its second rate, as far as they are asked for.
    """

    gap: _Worst
    angle: _Worst
    jump: _Worst
    curvature: float
    bend: float
    differences: tuple[float, float]
    derivatives: tuple[float, float]
    noises: tuple[float, float]
    rates: tuple[_Rate, ...]


@dataclass(frozen=True)
class _Rate:
    """What some of the samples say of a rate of curvature: its jump, its largest value, and its rounding."""

    jump: _Worst
    largest: float
    noise: float


class _Edges:
    """Both edges, their points counted from an origin."""

    def __init__(self, a: Base, b: Base, flipped: bool, origin: FloatArray, order: int) -> None:
        self.a, self.b, self.flipped, self.origin, self.order = a, b, flipped, origin, order
        self.curves_a, self.curves_b = (edge_curves(base.surface, base.edge, order, origin) for base in (a, b))
        self.noises = [edge_noises(base, origin, order) for base in (a, b)]

    def measured(self, s_a: FloatArray, s_b: FloatArray) -> _Part:
        """Measure at parameters along a and along b that correspond."""
        side_a = _Side(self.curves_a, self.a.edge, s_a, 1.0, self.order)
        side_b = _Side(self.curves_b, self.b.edge, s_b, 1.0 if self.flipped else -1.0, self.order)

        def worst(values: FloatArray) -> _Worst:
            i = int(values.argmax())
            x, y, z = (side_a.point[i] + self.origin).tolist()
            return _Worst(float(values[i]), Place(float(s_a[i]), (x, y, z)))

        sine = np.linalg.norm(_cross(side_a.normal, side_b.normal), axis=1)
        angle = np.degrees(np.arctan2(sine, np.sum(side_a.normal * side_b.normal, axis=1)))
        k_a, k_b = side_a.section.curvature, side_b.section.curvature
        (a_0, a_1), (b_0, b_1) = self.a.range_along, self.b.range_along
        # How fast b is run through as a is.
        pace = (b_1 - b_0) / (a_1 - a_0) * (-1.0 if self.flipped else 1.0)
        first = np.linalg.norm(side_a.x_s - pace * side_b.x_s, axis=1)
        second = np.linalg.norm(side_a.x_ss - pace**2 * side_b.x_ss, axis=1)
        of_angle, of_curvature = np.add(
            side_a.noises(self.noises[0], (first, second)),
            side_b.noises(self.noises[1], (first / abs(pace), second / pace**2)),
        )
        # One side is left backwards: odd derivatives change sign unless the edges are at opposite ends.
        sign = -1.0 if self.a.edge[1] == self.b.edge[1] else 1.0
        return _Part(
            gap=worst(np.linalg.norm(side_a.point - side_b.point, axis=1)),
            angle=worst(angle),
            jump=worst(np.abs(k_a - k_b)),
            curvature=float(np.max(np.abs([k_a, k_b]))),
            bend=float(np.max(np.abs([k_a, k_b, side_a.curvature_along(), side_b.curvature_along()]))),
            differences=(_longest(side_a.x_w - sign * side_b.x_w), _longest(side_a.x_ww - side_b.x_ww)),
            derivatives=(_longest(side_a.x_w, side_b.x_w), _longest(side_a.x_ww, side_b.x_ww)),
            noises=(float(of_angle.max()), float(of_curvature.max())),
            rates=self._rates(side_a, side_b, sign, worst),
        )

    def _rates(
        self, side_a: _Side, side_b: _Side, sign: float, worst: Callable[[FloatArray], _Worst]
    ) -> tuple[_Rate, ...]:
        if self.order == 2:
            return ()
        rates_a, rates_b = (
            curvature_rates(side.at, side.normal, noises.derivatives, self.order)
            for side, noises in zip((side_a, side_b), self.noises, strict=True)
        )
        found = []
        # The first rate is an odd derivative, the second an even one.
        for k, turn in enumerate((sign, 1.0)[: self.order - 2]):
            rate_a, rate_b = rates_a.values[k], rates_b.values[k]
            noise = float(np.max(rates_a.noises[k] + rates_b.noises[k]))
            found.append(_Rate(worst(np.abs(rate_a - turn * rate_b)), float(np.max(np.abs([rate_a, rate_b]))), noise))
        return tuple(found)


def _rate_measures(
    parts: Sequence[tuple[_Rate, ...]], bend: float, size: float
) -> tuple[dict[str, Any], dict[str, float]]:
    """Return what `Contact` holds of the rates of curvature, and what rounding may do to it.

    What bends along the edge counts too: a pipe is straight across its rim, and a jump is small or large beside its
    radius, not beside its length.
    """
    found: dict[str, Any] = {}
    rounding = {}
    for name, power, of_parts in zip(("rate", "second_rate"), (2, 3), zip(*parts, strict=True), strict=False):
        jump = _first_worst([part.jump for part in of_parts])
        scale = max(float(np.max([part.largest for part in of_parts])), bend**power, _STRAIGHT / size**power)
        found |= {f"{name}_jump": jump.value, f"{name}_jump_relative": jump.value / scale, f"{name}_at": jump.place}
        rounding[f"{name}_jump_relative"] = float(np.max([part.noise for part in of_parts])) / scale
    return found, rounding


def _first_worst(found: list[_Worst]) -> _Worst:
    return found[int(np.argmax([one.value for one in found]))]


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
