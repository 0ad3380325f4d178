"""Our own bases for the examples of section 5: stand-ins, since the paper prints no control points.

They match the description in the text, the printed knots of the contact curves and the sizes of Table 1. Everything
else is ours: shape, units (read them as millimetres), and the knots across the contact. Both bases have their contact
at u = 0, as in the paper, and run away from each other. What follows from control points (energies, times, curvatures)
is therefore ours and not the paper's; see `section5`.

`python -m semispline.papers.lin2014.examples.bases` writes the files in `examples/` anew.
"""

from __future__ import annotations

from math import pi, radians
from pathlib import Path

import numpy as np

from semispline.papers.lin2014.examples.section5 import (
    DEGREE,
    FIGURE_5_COMMON_KNOTS,
    FIGURES,
    FOLDER,
    PRINTED,
    example_path,
    usable_knots,
)
from semispline.solver.arrays import FloatArray
from semispline.solver.io import StoredProblem, write_problem
from semispline.solver.options import BlendOptions
from semispline.solver.splines import (
    BSplineSurface,
    basis_matrix,
    clamp_knots,
    clamped,
    greville,
    insert_knots,
    transform,
)

_X, _Y, _Z = np.eye(3)
# Of the complete cylinders: radius, and length along x from the contact.
CYLINDERS = ((40.0, -80.0), (26.0, 80.0))
# Of the cone: radius at the contact and at its end, length along x from the contact, opening in degrees.
CONE = (34.0, 60.0, -70.0, 200.0)


def stand_in(figure: int) -> StoredProblem:
    """Return the blend problem that stands for one figure."""
    make = {
        5: _planes,
        6: _plane_and_curved,
        8: _part_cylinders,
        9: _part_cylinders,
        10: _cylinders,
        11: _cone_and_free,
    }
    a, b = make[figure]() if figure != 9 else _part_cylinders(second_posture=True)
    printed = PRINTED[figure]
    options = BlendOptions(continuity=printed.continuity, middle_curves=printed.middle_curves, alpha="energy")
    return StoredProblem(a, "u0", b, "u0", options)


def write_examples(folder: Path = FOLDER) -> None:
    """Write one file for each example."""
    for figure in FIGURES:
        write_problem(folder / example_path(figure).name, stand_in(figure))


def figure_5_on_common_knots() -> tuple[BSplineSurface, BSplineSurface]:
    """Return both planar patches of Fig. 5 on the vector that the paper gives them for (d) to (f); exact for ours."""
    first, second = (_bezier_plane(i) for i in range(2))
    inner = FIGURE_5_COMMON_KNOTS[DEGREE + 1 : -DEGREE - 1]
    return insert_knots(first, knots_v=inner), insert_knots(second, knots_v=inner)


def _knots(figure: int) -> tuple[FloatArray, FloatArray]:
    knots = usable_knots(figure)
    if knots is None:
        raise ValueError(f"figure: found {figure}, expected one whose knots are printed")
    first, second = (np.array(k, dtype=np.float64) for k in knots)
    return first, second


def _across(count: int, power: float) -> FloatArray:
    """Return our knots across the contact on [0, 1]: graded, so that no formula holds by equal spans alone."""
    spans = count - DEGREE
    return clamped((np.arange(1, spans) / spans) ** power, DEGREE, 0.0, 1.0)


def _swept(edge: FloatArray, knots_v: FloatArray, along: FloatArray, knots_u: FloatArray) -> BSplineSurface:
    """Return edge(v) + u along; edge has shape (n_v, 3)."""
    net = edge[None] + greville(knots_u, DEGREE)[:, None, None] * along
    return BSplineSurface(DEGREE, DEGREE, knots_u, knots_v, net)


def _turned(surface: BSplineSurface, axis: FloatArray, degrees: float, shift: tuple[float, ...]) -> BSplineSurface:
    angle = radians(degrees)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    matrix = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return transform(surface, matrix, shift)


def _bezier_plane(which: int) -> BSplineSurface:
    """Return a planar patch of Fig. 5 with no inner knots in v: a horizontal one, and one that climbs."""
    knots_v = clamped([], DEGREE, 0.0, 1.0)
    v = greville(knots_v, DEGREE)
    if which == 0:
        edge = np.stack([0 * v, 100 * v, 0 * v], axis=1)
        return _swept(edge, knots_v, np.array([-85.0, 0, 0]), _across(6, 1.2))
    # Bowed within its own plane.
    edge = np.stack([np.array([0.0, 16, 10, 0]), 100 * v, 0 * v], axis=1)
    flat = _swept(edge, knots_v, np.array([85.0, 0, 0]), _across(6, 0.9))
    return _turned(_turned(flat, -_Y, 58, (0, 0, 0)), _Z, 12, (85.0, -6, 42))


def _planes() -> tuple[BSplineSurface, BSplineSurface]:
    inner = [knots[DEGREE + 1 : -DEGREE - 1] for knots in _knots(5)]
    return insert_knots(_bezier_plane(0), knots_v=inner[0]), insert_knots(_bezier_plane(1), knots_v=inner[1])


def _plane_and_curved() -> tuple[BSplineSurface, BSplineSurface]:
    first, second = _knots(6)
    v = greville(first, DEGREE)
    edge = np.stack([8 * np.sin(2 * pi * v), 120 * v, 0 * v], axis=1)
    plane = _swept(edge, first, np.array([-80.0, 0, 0]), _across(5, 1.2))
    knots_u = _across(5, 0.8)
    u, v = np.meshgrid(greville(knots_u, DEGREE), greville(second, DEGREE), indexing="ij")
    # A shell that bends along both parameters.
    x = 75 + 70 * u + 9 * np.cos(2 * pi * v) * (1 - 0.5 * u)
    z = 34 + 42 * u - 38 * u**2 + (20 - 9 * u) * np.sin(pi * v) + 5 * np.sin(3 * pi * v) * u
    return plane, BSplineSurface(DEGREE, DEGREE, knots_u, second, np.stack([x, 4 + 112 * v, z], axis=2))


def _arc(knots_v: FloatArray, opening: float) -> FloatArray:
    """Return control points of a circular arc of radius 1 about x, its middle on top: interpolated at n parameters."""
    v = greville(knots_v, DEGREE)
    angle = radians(opening) * (v - 0.5)
    points = np.stack([0 * v, np.sin(angle), np.cos(angle)], axis=1)
    return np.linalg.solve(basis_matrix(DEGREE, knots_v, v).toarray(), points)


def _part_cylinders(second_posture: bool = False) -> tuple[BSplineSurface, BSplineSurface]:
    large, small = _knots(8)
    first = _swept(40 * _arc(large, 150), large, np.array([-75.0, 0, 0]), _across(6, 1.2))
    second = _swept(24 * _arc(small, 150), small, np.array([75.0, 0, 0]), _across(6, 0.9))
    if second_posture:
        return first, _turned(_turned(second, _Y, 40, (0, 0, 0)), _Z, 25, (70.0, 14, -22))
    return first, transform(second, np.eye(3), (70.0, 0, 26))


def _circle(knots_v: FloatArray) -> FloatArray:
    """Return control points of a closed curve of radius about 1 about x: a periodic spline, clamped exactly.

    Its periodic control points are the corners of a regular polygon, so the clamped curve is C2 across the seam; the
    first and the last control point agree to the last bit.
    """
    breaks = knots_v[DEGREE:-DEGREE]
    n = len(breaks) - 1
    period = breaks[-1] - breaks[0]
    periodic = np.concatenate([breaks[-DEGREE - 1 : -1] - period, breaks, breaks[1 : DEGREE + 1] + period])
    # Seen from the axis the middles of the supports, on average, where a polygon has its corners.
    angle = 2 * pi * (np.arange(n + DEGREE) - 1) / n
    corners = np.stack([0 * angle, np.sin(angle), -np.cos(angle)], axis=1)
    corners[n:] = corners[:DEGREE]
    corners /= (2 + np.cos(2 * pi / n)) / 3
    clamped_knots, points = clamp_knots(DEGREE, periodic, corners)
    if not np.array_equal(clamped_knots, knots_v):
        raise ValueError("knots: clamping a periodic spline gave other knots than the printed ones")
    points[-1] = points[0]
    return points


def _cylinders() -> tuple[BSplineSurface, BSplineSurface]:
    first, second = _knots(10)
    (radius, length), (other_radius, other_length) = CYLINDERS
    large = _swept(radius * _circle(first), first, np.array([length, 0, 0]), _across(10, 1.1))
    small = _swept(other_radius * _circle(second), second, np.array([other_length, 0, 0]), _across(8, 0.9))
    return large, tilted(small)


def tilted(cylinder: BSplineSurface) -> BSplineSurface:
    """Return the second cylinder of Fig. 10, made along x, where it stands."""
    return _turned(cylinder, -_Y, 40, (75.0, 0, 30))


def _cone_and_free() -> tuple[BSplineSurface, BSplineSurface]:
    (rows, count), (free_rows, free_count) = PRINTED[11].sizes
    first = clamped((np.arange(1, count - DEGREE) / (count - DEGREE)) ** 1.15, DEGREE, 0.0, 1.0)
    steps = 1 + 0.35 * np.cos(1.7 * np.arange(free_count - DEGREE))
    second = clamped(np.cumsum(steps)[:-1] / steps.sum(), DEGREE, 0.0, 1.0)
    knots_u = _across(rows, 1.0)
    g = greville(knots_u, DEGREE)[:, None, None]
    # Straight along its rulings, so that interpolating the arc once is enough.
    at_contact, at_end, length, opening = CONE
    cone = (at_contact + (at_end - at_contact) * g) * _arc(first, opening) + g * np.array([length, 0, 0])
    knots_free = _across(free_rows, 1.1)
    u, v = np.meshgrid(greville(knots_free, DEGREE), greville(second, DEGREE), indexing="ij")
    angle = radians(190) * (v - 0.5)
    # A fluted collar that opens outwards: waves along the contact, which lessen away from it.
    radius = 46 + 30 * u + np.cos(11 * angle) * (1 - 0.3 * u)
    x = 62 + 44 * u - 14 * u**2 + 5 * np.sin(2 * angle)
    net = np.stack([x, radius * np.sin(angle), radius * np.cos(angle) + 6], axis=2)
    return BSplineSurface(DEGREE, DEGREE, knots_u, first, cone), BSplineSurface(DEGREE, DEGREE, knots_free, second, net)


if __name__ == "__main__":
    write_examples()
