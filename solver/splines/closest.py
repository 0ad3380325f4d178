"""The point of a curve or surface nearest to a point: parts of spans left out by proof, then Newton's method.

All is done on Bezier patches, the spans of the spline: on one of them there is no knot where a derivative could jump.
The control points of a part lie beyond a plane across the line of sight, hence the part does (convex hull property).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import comb

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semispline.solver.arrays import FloatArray, require, space_points
from semispline.solver.errors import ControlPointError
from semispline.solver.splines.evaluation import euclidean, quotient
from semispline.solver.splines.knots import breakpoints, clamped
from semispline.solver.splines.refinement import combined, refinement_matrix
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, Surface

# Spans are halved so often, unless more parts than MOST_PARTS are left: as near as that, they are all equal.
LEVELS = 6
MOST_PARTS = 2000
# The lowest parts that Newton's method starts from.
MOST_STARTS = 32
# Distances closer than this fraction of the size are equal; parameters closer than that of the domain are one.
TIE = 1e-10
SAME_PARAMETER = 1e-6
# Of a span: a longer step could leave the valley that the start lies in.
LONGEST_STEP = 1 / 16
# In sizes of the shape: from farther away rounding hides a thousandth of it.
FARTHEST = 1e12
# Below this part of the metric the distance does not bend; others as near are sought so far beside, in spans.
FLAT, BESIDE = 1e-4, 1 / 32
# Places on the line between two parameters that may be one pole.
_BETWEEN = 7
STEPS = 60
HALVINGS = 40
POLISHES = 3

IndexArray = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class ClosestPoint:
    """The nearest point, or all that were found where several are equally near.

    Attributes
    ----------
    distance : float
    parameters : ndarray, shape (K, 2) or (K,)
        (u, v) on a surface, v on a curve.
    points : ndarray, shape (K, 3)
    continuum : bool
        Infinitely many are equally near, as for a point on the axis of a cylinder: those above are some of them.
    """

    distance: float
    parameters: FloatArray
    points: FloatArray
    continuum: bool = False


def closest_point(shape: BSplineCurve | Surface, point: ArrayLike) -> ClosestPoint:
    """Return the point of a curve or surface that is nearest to a point, with its parameters.

    The boundary counts: the line to the nearest point need not be normal to the surface. Where several points are
    equally near, to 1e-10 of the size or to what distances round, each is returned, and so is a point of a seam with
    both its parameters; a pole has infinitely many, of which one is returned. Where infinitely many points are, these
    are some of them, and `continuum` says so.

    Spans are halved, and parts that are proved to be farther away than a point that was found are left out, until
    parts of 1/64 of a span remain. From each lowest one of them Newton's method with bounds, Gauss-Newton where the
    Hessian is not positive, steps halved.

    Parameters
    ----------
    shape : BSplineCurve, BSplineSurface or SemiStructuredSurface
        Rational too.
    point : array_like, shape (3,) or (2,)
        In the plane z = 0 where there are two coordinates.

    Raises
    ------
    ControlPointError
        A point of another shape, not finite, or more than 1e12 sizes of the shape away, where all of it is equally
        near.

    Source: Y. Ma, W. Hewitt, Point inversion and projection for NURBS curve and surface: control polygon approach,
    2003; D. Bertsekas, Projected Newton methods for optimization problems with simple constraints, 1982.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> found = closest_point(square, [0.25, 2, 1])
    >>> found.parameters, round(float(found.distance) ** 2, 12)
    (array([[0.25, 1.  ]]), 2.0)
    """
    require(shape, "shape", BSplineCurve, BSplineSurface, SemiStructuredSurface)
    target = space_points(point, 1, "point", ControlPointError)
    every = _all_points(shape)
    # To size 1, which rounds nothing: squares of what is huge or tiny would overflow or vanish.
    scale = 2.0 ** np.ceil(np.log2(max(float(np.abs(every).max()), np.finfo(float).tiny)))
    low, high = every.min(axis=0) / scale, every.max(axis=0) / scale
    size, away = float(np.linalg.norm(high - low)), float(np.abs(target / scale - low).max())
    if not away <= FARTHEST * (size or 1.0):
        raise ControlPointError(
            f"point: found {tuple(target.tolist())}, {away / (size or 1.0):.0e} sizes of the shape away, where all its "
            f"points are equally near; expected at most {FARTHEST:.0e}"
        )
    patches = _bezier_patches(shape, scale)
    tie = max(TIE * size, 4 * float(np.finfo(float).eps) * away)
    target = target / scale
    patch, at = _starts(patches, target, tie)
    at, distances, points = _descended(patches.nets[patch], target, at)
    # 1 gives the end itself.
    parameters = np.where(at == 1, patches.high[patch], patches.low[patch] + at * (patches.high - patches.low)[patch])
    width = patches.high.max(axis=0) - patches.low.min(axis=0)
    chosen = _distinct(parameters, distances, width, tie)
    chosen = _one_for_each_pole(shape, parameters, points * scale, chosen, SAME_PARAMETER * size * scale)
    found = parameters[chosen]
    return ClosestPoint(
        float(distances.min()) * scale,
        found[:, 0] if isinstance(shape, BSplineCurve) else found,
        points[chosen] * scale,
        _is_continuum(patches.nets[patch[chosen]], target, at[chosen], tie, SAME_PARAMETER * size),
    )


@dataclass(frozen=True, eq=False)
class _Patches:
    """The spans of a spline in d parameters.

    Attributes
    ----------
    nets : ndarray, shape (K, p + 1, .., 3 or 4)
        Bezier control points, homogeneous where there are four.
    low, high : ndarray, shape (K, d)
        The ends of the spans.
    """

    nets: FloatArray
    low: FloatArray
    high: FloatArray


def _all_points(shape: BSplineCurve | Surface) -> FloatArray:
    """Return all control points, shape (n, 3)."""
    if isinstance(shape, SemiStructuredSurface):
        return np.concatenate([curve.control_points for curve in shape.control_curves])
    return shape.control_points.reshape(-1, 3)


def _bezier_patches(shape: BSplineCurve | Surface, scale: float) -> _Patches:
    degrees: tuple[int, ...]
    vectors: tuple[FloatArray, ...]
    if isinstance(shape, BSplineCurve):
        degrees, vectors, net = (shape.degree,), (shape.knots,), shape.homogeneous
    else:
        plain = shape.to_bspline() if isinstance(shape, SemiStructuredSurface) else shape
        degrees, vectors = (plain.degree_u, plain.degree_v), (plain.knots_u, plain.knots_v)
        net = plain.homogeneous
    net = np.concatenate([net[..., :3] / scale, net[..., 3:]], axis=-1)
    for axis, (p, knots) in enumerate(zip(degrees, vectors, strict=True)):
        spans = breakpoints(knots)
        full = clamped(np.repeat(spans[1:-1], p), p, spans[0], spans[-1])
        fine = combined(refinement_matrix(p, knots, full), np.moveaxis(net, axis, 0))
        net = np.moveaxis(fine, 0, axis)
    breaks = [breakpoints(knots) for knots in vectors]
    nets, low, high = [], [], []
    for index in product(*(range(len(b) - 1) for b in breaks)):
        nets.append(net[tuple(slice(i * p, i * p + p + 1) for i, p in zip(index, degrees, strict=True))])
        low.append([b[i] for i, b in zip(index, breaks, strict=True)])
        high.append([b[i + 1] for i, b in zip(index, breaks, strict=True)])
    return _Patches(np.stack(nets), np.array(low), np.array(high))


def _starts(patches: _Patches, target: FloatArray, tie: float) -> tuple[IndexArray, FloatArray]:
    """Return the patch and the place on it, in [0, 1]^d, of the lowest parts that may hold the nearest point."""
    d = patches.low.shape[1]
    nets, owner = patches.nets, np.arange(len(patches.nets))
    cell = np.zeros((len(nets), d), dtype=np.intp)
    best, level = np.inf, 0
    while True:
        bound, corners = _bounds(nets, target)
        best = min(best, float(corners.min()))
        kept = bound <= best + tie
        nets, owner, cell, corners = nets[kept], owner[kept], cell[kept], corners[kept]
        if level == LEVELS or len(nets) > MOST_PARTS:
            break
        for axis in range(d):
            nets = _halved(nets, axis)
            owner, cell = np.tile(owner, 2), np.tile(cell, (2, 1))
            cell[:, axis] = 2 * cell[:, axis] + np.repeat([0, 1], len(cell) // 2)
        level += 1
    nearest = corners.argmin(axis=1)
    ends = euclidean(_corners(nets))[0].reshape(len(nets), -1, 3)[np.arange(len(nets)), nearest]
    lowest = _local_minima(owner, cell, corners.min(axis=1), ends, tie)
    # From the nearest corner: what is found is then no farther than any corner that was looked at.
    place = cell[lowest] + np.array(list(product((0, 1), repeat=d)))[nearest[lowest]]
    starts = np.unique(np.column_stack([owner[lowest], place]), axis=0)
    return starts[:, 0], starts[:, 1:] / 2**level


def _bounds(nets: FloatArray, target: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return for each patch a distance that none of its points is nearer than, and those of its corners."""
    points = (euclidean(nets)[0] - target).reshape(len(nets), -1, 3)
    corners = euclidean(_corners(nets))[0] - target
    sight = corners.reshape(len(nets), -1, 3).mean(axis=1)
    length = np.linalg.norm(sight, axis=1)
    unit = sight / np.where(length > 0, length, 1.0)[:, None]
    bound = np.maximum(0.0, np.einsum("kid,kd->ki", points, unit).min(axis=1))
    return bound, np.linalg.norm(corners, axis=-1).reshape(len(nets), -1)


def _corners(nets: FloatArray) -> FloatArray:
    """Return the control points at the corners of patches, two along each axis."""
    for axis in range(1, nets.ndim - 1):
        nets = np.take(nets, [0, -1], axis=axis)
    return nets


def _halved(nets: FloatArray, axis: int) -> FloatArray:
    """Return the first halves of all patches along an axis, then the second ones."""
    p = nets.shape[axis + 1] - 1
    first = np.array([[comb(i, j) / 2**i for j in range(p + 1)] for i in range(p + 1)])
    both = np.stack([first, first[::-1, ::-1]])
    halves = np.moveaxis(np.tensordot(both, nets, axes=([2], [axis + 1])), 1, axis + 2)
    return np.asarray(halves.reshape(-1, *nets.shape[1:]))


def _local_minima(owner: IndexArray, cell: IndexArray, nearest: FloatArray, ends: FloatArray, tie: float) -> IndexArray:
    """Return the parts that are no farther than their neighbours on the same patch, the nearest first.

    Of neighbours whose nearest corners `ends` are one point there is one: those around a pole would leave no place.
    """
    places = {(k, *place): i for i, (k, place) in enumerate(zip(owner.tolist(), cell.tolist(), strict=True))}
    around = [step for step in product((-1, 0, 1), repeat=cell.shape[1]) if any(step)]

    def beside(i: int) -> list[int]:
        keys = ((int(owner[i]), *(cell[i] + step).tolist()) for step in around)
        return [places[key] for key in keys if key in places]

    lowest: list[int] = []
    met: set[int] = set()
    for i in np.argsort(nearest, kind="stable").tolist():
        if i in met or any(nearest[j] < nearest[i] for j in beside(i)):
            continue
        lowest.append(i)
        if len(lowest) == MOST_STARTS:
            break
        front = [i]
        while front:
            near = np.array([j for j in beside(front.pop()) if j not in met], dtype=np.intp)
            alike = near[np.abs(ends[near] - ends[i]).max(axis=1, initial=0.0) <= tie].tolist()
            met.update(alike)
            front += alike
    return np.array(lowest)


def _jet(nets: FloatArray, at: FloatArray, order: int) -> tuple[FloatArray, ...]:
    """Return points of patches, one each, (K, 3); as asked first derivatives (K, d, 3) and second ones (K, d, d, 3)."""
    d = at.shape[1]
    known: dict[tuple[int, int], FloatArray] = {}

    def raw(a: int, b: int) -> FloatArray:
        if (a, b) not in known:
            values = nets
            for axis, times in zip(range(d), (a, b), strict=False):
                values = _bezier_derivative(values, at[:, axis], times)
            known[a, b] = values
        return known[a, b]

    def value(*directions: int) -> FloatArray:
        a, b = directions.count(0), directions.count(1)
        return quotient(raw, a, b) if nets.shape[-1] == 4 else raw(a, b)

    result = [value()]
    if order >= 1:
        result.append(np.stack([value(i) for i in range(d)], axis=1))
        second = {(i, j): value(i, j) for i in range(d) for j in range(i, d)}
        rows = [np.stack([second[min(i, j), max(i, j)] for j in range(d)], axis=1) for i in range(d)]
        result.append(np.stack(rows, axis=1))
    return tuple(result)


def _bezier_derivative(nets: FloatArray, at: FloatArray, order: int) -> FloatArray:
    """Return derivatives along axis 1 at one parameter for each patch, that axis taken away."""
    for _ in range(order):
        degree = nets.shape[1] - 1
        nets = np.diff(nets, axis=1) * degree if degree else np.zeros_like(nets)
    p = nets.shape[1] - 1
    basis = np.stack([comb(p, i) * at**i * (1 - at) ** (p - i) for i in range(p + 1)], axis=1)
    return np.asarray(np.einsum("ki,ki...->k...", basis, nets))


def _descended(nets: FloatArray, target: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Improve every start by Newton's method within [0, 1]^d; return parameters, distances and points."""
    points, first, second = _jet(nets, at, 2)
    value = _half_square(points, target)
    active = np.ones(len(at), dtype=bool)
    for _ in range(STEPS):
        step = _newton_steps(points - target, first, second, at)
        trying = active & (np.abs(np.clip(at + step, 0, 1) - at) > np.finfo(float).eps).any(axis=1)
        active = np.zeros(len(at), dtype=bool)
        for _ in range(HALVINGS):
            if not trying.any():
                break
            tried = np.clip(at + step, 0, 1)
            lower = trying & (_half_square(_jet(nets, tried, 0)[0], target) < value)
            at = np.where(lower[:, None], tried, at)
            active |= lower
            trying &= ~lower
            step = step / 2
        if not active.any():
            break
        points, first, second = _jet(nets, at, 2)
        value = _half_square(points, target)
    return _polished(nets, target, at)


def _polished(nets: FloatArray, target: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Take Newton's steps that the distance is too flat to judge, as long as they make the slope smaller."""
    points, first, second = _jet(nets, at, 2)
    steepness = _steepness(points - target, first, at)
    slack = 16 * np.finfo(float).eps * max(np.abs(points).max(), np.abs(target).max())
    for _ in range(POLISHES):
        tried = np.clip(at + _newton_steps(points - target, first, second, at), 0, 1)
        jet = _jet(nets, tried, 2)
        flatter = _steepness(jet[0] - target, jet[1], tried)
        longer = np.linalg.norm(jet[0] - target, axis=1) - np.linalg.norm(points - target, axis=1)
        good = (flatter < steepness) & (longer <= slack)
        if not good.any():
            break
        at, steepness = np.where(good[:, None], tried, at), np.where(good, flatter, steepness)
        points, first, second = _jet(nets, at, 2)
    return at, np.asarray(np.linalg.norm(points - target, axis=1)), points


def _steepness(away: FloatArray, first: FloatArray, at: FloatArray) -> FloatArray:
    """Return the length of the slope but for parameters that stay at their bound."""
    slope = np.einsum("kid,kd->ki", first, away)
    return np.asarray(np.linalg.norm(np.where(_pressed(slope, at), 0.0, slope), axis=1))


def _pressed(slope: FloatArray, at: FloatArray) -> NDArray[np.bool_]:
    """Tell which parameters are at a bound that the slope presses them against."""
    return np.asarray(((at <= 0) & (slope >= 0)) | ((at >= 1) & (slope <= 0)))


def _half_square(points: FloatArray, target: FloatArray) -> FloatArray:
    return np.asarray(0.5 * np.sum((points - target) ** 2, axis=-1))


def _newton_steps(away: FloatArray, first: FloatArray, second: FloatArray, at: FloatArray) -> FloatArray:
    """Return the step of each start; a parameter at a bound that the slope presses against stays."""
    slope = np.einsum("kid,kd->ki", first, away)
    free = ~_pressed(slope, at)
    slope = np.where(free, slope, 0.0)
    both = free[:, :, None] & free[:, None, :]
    square = np.where(both, np.einsum("kid,kjd->kij", first, first), 0.0)
    hessian = square + np.where(both, np.einsum("kijd,kd->kij", second, away), 0.0)
    # A parameter that stays has a slope of zero: any positive entry will do for it.
    fixed = np.eye(at.shape[1]) * ~free[:, :, None]
    trace = np.trace(square, axis1=1, axis2=2)[:, None, None]
    fixed = fixed * np.where(trace > 0, trace, 1.0)
    values, vectors = np.linalg.eigh(hessian + fixed)
    newton = values[:, 0] > 1e-10 * np.maximum(values[:, -1], trace[:, 0, 0])
    simple, frame = np.linalg.eigh(square + fixed)
    values, vectors = np.where(newton[:, None], values, simple), np.where(newton[:, None, None], vectors, frame)
    # At a pole or a cusp: along what is left.
    values = np.maximum(values, np.maximum(1e-10 * values[:, -1:], np.finfo(float).tiny))
    step = -np.einsum("kij,kj->ki", vectors, np.einsum("kij,ki->kj", vectors, slope) / values)
    # What a bound cuts off goes uphill (such a parameter is free, its slope points inward): the rest goes downhill.
    step = np.where(((at <= 0) & (step < 0)) | ((at >= 1) & (step > 0)), 0.0, step)
    return np.asarray(step / np.maximum(1.0, np.abs(step).max(axis=1, keepdims=True) / LONGEST_STEP))


def _is_continuum(nets: FloatArray, target: FloatArray, at: FloatArray, tie: float, same: float) -> bool:
    """Tell whether a nearest point has others beside it that are as near: Newton's steps do not lead back to it.

    They do where it is alone, however flat the distance is, and from around a pole, which is one point.
    """
    points, first, second = _jet(nets, at, 2)
    square = np.einsum("kid,kjd->kij", first, first)
    bent = np.linalg.eigvalsh(square + np.einsum("kijd,kd->kij", second, points - target))[:, 0]
    flat = bent <= FLAT * np.trace(square, axis1=1, axis2=2)
    steps = np.array([step for step in product((-1, 0, 1), repeat=at.shape[1]) if any(step)]) * BESIDE
    starts = np.clip((at[flat][:, None] + steps).reshape(-1, at.shape[1]), 0, 1)
    if not len(starts):
        return False
    own = np.repeat(np.flatnonzero(flat), len(steps))
    moved = np.linalg.norm(_jet(nets[own], starts, 0)[0] - points[own], axis=1)
    _, distances, ends = _descended(nets[own], target, starts)
    apart = np.linalg.norm(ends - points[own], axis=1)
    near = distances <= np.linalg.norm(points[own] - target, axis=1) + tie
    return bool((near & (apart > np.maximum(moved / 4, same))).any())


def _distinct(parameters: FloatArray, distances: FloatArray, width: FloatArray, tie: float) -> list[int]:
    """Return the indices of the nearest points, one for each place in the domain, in the order of their parameters."""
    order = np.argsort(distances, kind="stable")
    chosen: list[int] = []
    for k in order[distances[order] <= distances[order[0]] + tie].tolist():
        if (np.abs(parameters[chosen] - parameters[k]) > SAME_PARAMETER * width).any(axis=1).all():
            chosen.append(k)
    return sorted(chosen, key=lambda k: tuple(parameters[k].tolist()))


def _one_for_each_pole(
    shape: BSplineCurve | Surface, parameters: FloatArray, points: FloatArray, chosen: list[int], same: float
) -> list[int]:
    """Leave out what is one point with an earlier one all along the line between their parameters, as at a pole.

    Two parameters of a seam are one point too, but the line between them leads around.
    """
    kept: list[int] = []
    for k in chosen:
        alike = [i for i in kept if np.abs(points[i] - points[k]).max() <= same]
        if not any(_is_one_point(shape, parameters[i], parameters[k], points[k], same) for i in alike):
            kept.append(k)
    return kept


def _is_one_point(
    shape: BSplineCurve | Surface, first: FloatArray, last: FloatArray, point: FloatArray, same: float
) -> bool:
    """Tell whether all the line between two parameters is one point."""
    between = first + (last - first) * (np.arange(1, _BETWEEN + 1) / (_BETWEEN + 1))[:, None]
    return bool(np.abs(shape.evaluate(*between.T) - point).max() <= same)
