"""Measured continuity along a shared edge, by the de Boor referee alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.contact import Contact, Place
from semispline.solver.judge.correspondence import Correspondence, correspond, corresponding_samples
from semispline.solver.judge.de_boor import EdgeCurves, edge_curves
from semispline.solver.judge.edge_normals import places_without_normal
from semispline.solver.judge.limits import allowed_measures
from semispline.solver.options import Flip
from semispline.solver.splines import BSplineSurface, Surface, bounding_box

# Samples that are measured at once.
_AT_ONCE = 8192
# A curvature below this, over the size of the model, is none.
_STRAIGHT = 1e-3
# The bound on rounding counts each control point once; a few operations follow before it is measured.
_ROUNDINGS = 8.0


def measure_contact(a: Base, b: Base, flip: Flip = "auto", correspondence: Correspondence | None = None) -> Contact:
    """Measure how edge a and edge b meet; parameters along the edges correspond affinely.

    Parameters
    ----------
    a, b : Base
    flip : {"auto", "yes", "no"}
        Whether the edges run in opposite directions; "auto" takes the closer way.
    correspondence : Correspondence, optional
        How the edges correspond, where that is known.

    Returns
    -------
    Contact

    Raises
    ------
    EdgeError
        `flip` is not one of auto, yes, no; or both surfaces are one point.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> left = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> right = BSplineSurface(1, 1, k, k, [[[1, 0, 0], [1, 1, 0]], [[2, 0, 1], [2, 1, 1]]])
    >>> round(measure_contact(Base(left, "u1"), Base(right, "u0")).angle_degrees, 12)
    45.0
    """
    size = model_size(a.surface, b.surface)
    if not size > 0:
        raise EdgeError("surfaces: all control points are one point, expected surfaces")
    matched = correspondence or correspond(a, b, flip)
    # Far from the origin each operation would round by the distance, and hide what the surfaces themselves do.
    origin = local_origin(a.surface, b.surface)
    edges = _Edges(a, b, matched.flipped, origin)
    s_a, s_b = corresponding_samples(a, b, matched)
    # Part by part: a long edge has more samples than memory should hold at once.
    starts = range(0, len(s_a), _AT_ONCE)
    parts = [edges.measured(s_a[i : i + _AT_ONCE], s_b[i : i + _AT_ONCE]) for i in starts]
    gap, angle, jump = (_first_worst([getattr(part, name) for part in parts]) for name in ("gap", "angle", "jump"))
    largest = float(np.maximum(np.max([part.curvature for part in parts]), _STRAIGHT / size))
    (c1, c2), (first, second) = (
        np.max([getattr(part, name) for part in parts], 0).tolist() for name in ("differences", "derivatives")
    )
    speeds = np.min([part.speeds for part in parts], axis=0).tolist()
    noises = [_noises(base, origin) for base in (a, b)]
    # Flat: what bends by the size of the model is the measure; and nearly so, as of curvatures.
    bent = first * first / size
    second = bent if second <= noises[0][2] + noises[1][2] else max(second, _STRAIGHT * bent)
    geometric = [_geometric_noise(noise, speed, largest) for noise, speed in zip(noises, speeds, strict=True)]
    rounding = {
        "gap": noises[0][0] + noises[1][0],
        "angle_degrees": float(np.degrees(geometric[0][0] + geometric[1][0])),
        "curvature_jump_relative": (geometric[0][1] + geometric[1][1]) / largest,
        "c1_residual": _over(noises[0][1] + noises[1][1], first),
        "c2_residual": _over(noises[0][2] + noises[1][2], second),
    }
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
    differences, derivatives : (float, float)
        Largest difference of first and second cross derivatives, and largest such derivative of either side.
    speeds : (float, float)
        Least speed across the edge, of a and of b.
    """

    gap: _Worst
    angle: _Worst
    jump: _Worst
    curvature: float
    differences: tuple[float, float]
    derivatives: tuple[float, float]
    speeds: tuple[float, float]


class _Edges:
    """Both edges, their points counted from an origin."""

    def __init__(self, a: Base, b: Base, flipped: bool, origin: FloatArray) -> None:
        self.a, self.b, self.flipped, self.origin = a, b, flipped, origin
        self.curves_a, self.curves_b = (edge_curves(base.surface, base.edge, origin=origin) for base in (a, b))

    def measured(self, s_a: FloatArray, s_b: FloatArray) -> _Part:
        """Measure at parameters along a and along b that correspond."""
        side_a = _Side(self.curves_a, self.a.edge, s_a, 1.0)
        side_b = _Side(self.curves_b, self.b.edge, s_b, 1.0 if self.flipped else -1.0)

        def worst(values: FloatArray) -> _Worst:
            i = int(values.argmax())
            x, y, z = (side_a.point[i] + self.origin).tolist()
            return _Worst(float(values[i]), Place(float(s_a[i]), (x, y, z)))

        sine = np.linalg.norm(_cross(side_a.normal, side_b.normal), axis=1)
        angle = np.degrees(np.arctan2(sine, np.sum(side_a.normal * side_b.normal, axis=1)))
        k_a, k_b = side_a.curvature(), side_b.curvature()
        # One side is left backwards: odd derivatives change sign unless the edges are at opposite ends.
        sign = -1.0 if self.a.edge[1] == self.b.edge[1] else 1.0
        return _Part(
            gap=worst(np.linalg.norm(side_a.point - side_b.point, axis=1)),
            angle=worst(angle),
            jump=worst(np.abs(k_a - k_b)),
            curvature=float(np.max(np.abs([k_a, k_b]))),
            differences=(_longest(side_a.x_w - sign * side_b.x_w), _longest(side_a.x_ww - side_b.x_ww)),
            derivatives=(_longest(side_a.x_w, side_b.x_w), _longest(side_a.x_ww, side_b.x_ww)),
            speeds=(side_a.least_cross_speed(), side_b.least_cross_speed()),
        )


def _first_worst(found: list[_Worst]) -> _Worst:
    return found[int(np.argmax([one.value for one in found]))]


class _Side:
    """Referee's values along one edge: w runs across, s along.

    The normal is that of the direction into the surface and the direction along the edge, times `sign`: so two sides
    that continue each other, one taken with the opposite sign, have one normal, and a fold back turns it over.
    """

    def __init__(self, curves: EdgeCurves, edge: str, s: FloatArray, sign: float) -> None:
        at = curves.points(s)
        self.point, self.x_w, self.x_s = at[0, 0], at[1, 0], at[0, 1]
        self.x_ww, self.x_ws, self.x_ss = at[2, 0], at[1, 1], at[0, 2]
        cross = _cross(self.x_w, self.x_s)
        length = np.linalg.norm(cross, axis=1)
        scale = np.linalg.norm(self.x_w, axis=1) * np.linalg.norm(self.x_s, axis=1)
        inwards = -sign if edge[1] == "1" else sign
        regular = (length > 1e-12 * scale)[:, None]
        self.normal = np.divide(inwards * cross, length[:, None], out=np.full_like(cross, np.nan), where=regular)

    def across(self) -> tuple[FloatArray, FloatArray]:
        """Return y and d = x_w + y x_s, d perpendicular to the edge; not a number where there is no normal."""
        squared = np.where(np.isnan(self.normal[:, 0]), np.nan, np.sum(self.x_s**2, axis=1))
        y = -np.sum(self.x_w * self.x_s, axis=1) / squared
        return y, self.x_w + y[:, None] * self.x_s

    def curvature(self) -> FloatArray:
        """Return normal curvature in the direction of the tangent plane perpendicular to the edge, shape (K,)."""
        y, d = self.across()
        second = self.x_ww + 2 * y[:, None] * self.x_ws + (y**2)[:, None] * self.x_ss
        return np.asarray(np.sum(second * self.normal, axis=1) / np.sum(d**2, axis=1))

    def least_cross_speed(self) -> float:
        """Return the least speed across the edge."""
        return float(np.linalg.norm(self.across()[1], axis=1).min())


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


def _noises(base: Base, origin: FloatArray) -> list[float]:
    """Bound what rounding may do to cross derivatives of order 0, 1, 2.

    That of storing the control points, once, and that of some operations with them, which are counted from `origin`.
    """
    eps = float(np.finfo(float).eps)
    box = bounding_box(base.surface)
    stored = eps / 2 * float(np.linalg.norm(np.abs(box).max(axis=0)))
    worked = _ROUNDINGS * eps * float(np.abs(box - origin).max())
    return [(stored + worked) * _derivative_factor(base, order) for order in range(3)]


def _geometric_noise(noises: list[float], speed: float, largest_curvature: float) -> tuple[float, float]:
    """Bound what that rounding may do to the angle (radians) and to the curvature across the edge (1/length)."""
    angle = noises[1] / speed
    return angle, noises[2] / speed / speed + 2 * largest_curvature * angle


def _derivative_factor(base: Base, order: int) -> float:
    """How much the `order`-th cross derivative at the edge may magnify an error of the control points."""
    across_u = base.edge[0] == "u"
    surface = base.surface
    if across_u:
        knots, degree = surface.knots_u, surface.degree_u
    elif isinstance(surface, BSplineSurface):
        knots, degree = surface.knots_v, surface.degree_v
    else:
        curve = max(surface.control_curves, key=lambda c: c.degree)
        knots, degree = curve.knots, curve.degree
    if order > degree:
        return 0.0
    at_end = base.edge[1] == "1"
    steps = np.abs(knots[::-1] - knots[-1]) if at_end else knots - knots[0]
    factor = 1.0
    for s in range(order):
        factor *= 2 * (degree - s) / float(steps[degree + 1])
    return factor
