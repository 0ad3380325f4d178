"""Pairs of closed rims: pipes in line, tilted, of other radii, elbows, pipes with caps, flat rings, bells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from semispline.papers.reproduction.families.problems import ShapeProblem, measure_pair, on_edge
from semispline.solver.arrays import FloatArray
from semispline.solver.splines import BSplineSurface, clamp_knots, clamped, greville

KINDS = ("coaxial", "tilted", "other radius", "elbow", "cap", "rings", "bells")
# Cubic spans around a rim; a harmonic of so much of the radius dents it.
SPANS = (6, 13)
WOBBLE = 0.1
DECADES = 2.0
_NUMBER = 3
_UPRIGHT = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
_KNOTS_U = clamped([0.5], 3, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class _Tube:
    """A profile turned about an axis.

    Attributes
    ----------
    radius, height : ndarray, shape (5,)
        Control points of the profile from the rim on: distance from the axis, and way along it.
    centre, axis : ndarray, shape (3,)
        Of the rim; the axis leads into the base.
    """

    radius: FloatArray
    height: FloatArray
    centre: FloatArray = field(default_factory=lambda: np.zeros(3))
    axis: FloatArray = field(default_factory=lambda: -_UPRIGHT[2])


def closed_rims(seed: int) -> ShapeProblem:
    """Return a pair of closed rims; the kinds take turns by seed, the rim of a has radius 1.

    Cubic, C2 all round, 6 to 13 spans, seams and directions at random, two of three dented by a harmonic of up to 10 %.
    Gap 0.5 to 3 radii; slopes of walls up to 0.5 (coaxial, tilted, other radius); tilts 5 to 50 degrees, radii 0.3 to
    0.8, elbows of 60 to 110 degrees about 1.5 to 3 radii, domes that begin up to 30 degrees above their equator, rings
    up to 0.3 out of one plane, bells that leave outwards by 30 to 60 degrees; lengths of domains over two decades.

    Examples
    --------
    >>> pair = closed_rims(3)
    >>> pair.name, pair.kind
    ('closed rims-003', 'elbow')
    """
    kind = KINDS[seed % len(KINDS)]
    rng = np.random.default_rng([_NUMBER, seed])
    tubes = _MAKERS[kind](rng)
    dented = rng.random() > 1 / 3
    a, b = (on_edge(rng, _surface(rng, tube, WOBBLE if dented else 0.0), DECADES) for tube in tubes)
    return ShapeProblem(f"closed rims-{seed:03d}", "closed rims", kind, seed, a, b, measure_pair(a, b))


def _surface(rng: np.random.Generator, tube: _Tube, wobble: float) -> BSplineSurface:
    """Return the surface, met along u0, its seam anywhere and run either way round."""
    n, degree = int(rng.integers(SPANS[0], SPANS[1] + 1)), 3
    way = 1 if rng.random() < 0.5 else -1
    angle = rng.uniform(0, 2 * np.pi) + way * 2 * np.pi * np.arange(n) / n
    # The curve meets the circle at its knots.
    ring = (
        6
        / (4 + 2 * np.cos(2 * np.pi / n))
        * (1 + rng.uniform(0, wobble) * np.cos(int(rng.integers(2, 4)) * angle + rng.uniform(0, 2 * np.pi)))
    )
    circle = ring * np.stack([np.cos(angle), np.sin(angle)])
    across = _UPRIGHT[0] if abs(tube.axis[0]) < 0.9 else _UPRIGHT[1]
    first = np.cross(tube.axis, across)
    first /= np.linalg.norm(first)
    second = np.cross(tube.axis, first)
    flat = np.outer(circle[0], first) + np.outer(circle[1], second)
    net = tube.centre + tube.radius[:, None, None] * flat + tube.height[:, None, None] * tube.axis
    net = np.concatenate([net, net[:, :degree]], axis=1)
    knots, points = clamp_knots(
        degree, np.arange(-degree, n + degree + 1) / n, net.transpose(1, 0, 2).reshape(n + degree, -1)
    )
    return BSplineSurface(3, degree, _KNOTS_U, knots, points.reshape(n + degree, 5, 3).transpose(1, 0, 2))


def _pipe(rng: np.random.Generator, radius: float, slope: float) -> tuple[FloatArray, FloatArray]:
    """Return radii and heights of a wall of one slope."""
    height = radius * rng.uniform(0.5, 1.5) * greville(_KNOTS_U, 3)
    return radius + slope * height, height


def _slopes(rng: np.random.Generator) -> tuple[float, float]:
    first, second = rng.uniform(-0.5, 0.5, 2).tolist()
    return first, second


def _coaxial(rng: np.random.Generator) -> tuple[_Tube, _Tube]:
    return _two_pipes(rng, 1.0, 0.0)


def _tilted(rng: np.random.Generator) -> tuple[_Tube, _Tube]:
    return _two_pipes(rng, 1.0, float(np.radians(rng.uniform(5, 50))))


def _other_radius(rng: np.random.Generator) -> tuple[_Tube, _Tube]:
    return _two_pipes(rng, float(rng.uniform(0.3, 0.8)), 0.0)


def _two_pipes(rng: np.random.Generator, radius: float, tilt: float) -> tuple[_Tube, _Tube]:
    slope_a, slope_b = _slopes(rng)
    # However far the second rim is tilted, the planes of both do not meet between them.
    gap = rng.uniform(0.5, 3.0) + radius * np.sin(tilt)
    axis = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    return _Tube(*_pipe(rng, 1.0, slope_a)), _Tube(*_pipe(rng, radius, slope_b), np.array([0.0, 0.0, gap]), axis)


def _elbow(rng: np.random.Generator) -> tuple[_Tube, _Tube]:
    angle, bend = np.radians(rng.uniform(60, 110)), rng.uniform(1.5, 3.0)
    centre = bend * np.array([1 - np.cos(angle), 0.0, np.sin(angle)])
    axis = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return _Tube(*_pipe(rng, 1.0, 0.0)), _Tube(*_pipe(rng, 1.0, 0.0), centre, axis)


def _cap(rng: np.random.Generator) -> tuple[_Tube, _Tube]:
    start = np.radians(rng.uniform(0, 30))
    latitude = start + (np.radians(75) - start) * greville(_KNOTS_U, 3)
    radius, height = np.cos(latitude) / np.cos(start), (np.sin(latitude) - np.sin(start)) / np.cos(start)
    dome = _Tube(radius, height, np.array([0.0, 0.0, rng.uniform(0.5, 3.0)]), _UPRIGHT[2])
    return _Tube(*_pipe(rng, 1.0, 0.0)), dome


def _rings(rng: np.random.Generator) -> tuple[_Tube, _Tube]:
    s, inner = greville(_KNOTS_U, 3), rng.uniform(0.3, 0.8)
    outer = _Tube(1 + rng.uniform(0.3, 1.0) * s, np.zeros(5))
    height = float(rng.choice([0.0, rng.uniform(-0.3, 0.3)]))
    return outer, _Tube(inner * (1 - 0.5 * s), np.zeros(5), np.array([0.0, 0.0, height]), _UPRIGHT[2])


def _bells(rng: np.random.Generator) -> tuple[_Tube, _Tube]:
    profiles = []
    for _ in range(2):
        angle, reach = np.radians(rng.uniform(30, 60)), rng.uniform(0.3, 0.8) * greville(_KNOTS_U, 3)
        profiles.append((1 - np.sin(angle) * reach, np.cos(angle) * reach))
    return _Tube(*profiles[0]), _Tube(*profiles[1], np.array([0.0, 0.0, rng.uniform(0.5, 3.0)]), _UPRIGHT[2])


_MAKERS: dict[str, Callable[[np.random.Generator], tuple[_Tube, _Tube]]] = {
    "coaxial": _coaxial,
    "tilted": _tilted,
    "other radius": _other_radius,
    "elbow": _elbow,
    "cap": _cap,
    "rings": _rings,
    "bells": _bells,
}
