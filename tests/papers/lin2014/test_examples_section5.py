"""The examples of section 5: what is printed of them is in the files, and the geometry is what the text describes."""

from __future__ import annotations

import numpy as np
import pytest

from semispline.papers.lin2014.examples.bases import figure_5_on_common_knots, stand_in
from semispline.papers.lin2014.examples.section5 import (
    DEPARTURES,
    FIGURES,
    PRINTED,
    example,
    example_path,
    usable_knots,
)
from semispline.solver.io.json_files import read_problem
from semispline.solver.judge.de_boor import surface_points

SEVENTHS = [0.142857, 0.285714, 0.428571, 0.571429, 0.714286, 0.857143]
# Inner knots of the contact curves and sizes of Table 1, typed from the text once more.
INNER = {
    5: ([1 / 2], [1 / 3, 2 / 3]),
    6: ([0.15, 0.28, 0.48, 0.55, 0.70, 0.86], [0.22, 0.39, 0.61, 0.76]),
    8: ([0.3, 0.7], [0.5]),
    9: ([0.3, 0.7], [0.5]),
    10: (SEVENTHS, [0.2, 0.4, 0.6, 0.8]),
}
SIZES = {
    5: ((6, 5), (6, 6)),
    6: ((5, 10), (5, 8)),
    8: ((6, 6), (6, 5)),
    9: ((6, 6), (6, 5)),
    10: ((10, 10), (8, 8)),
    11: ((4, 10), (5, 64)),
}


def bases(figure):
    task = example(figure)
    return task.a.surface, task.b.surface


@pytest.mark.parametrize("figure", FIGURES)
def test_files_are_what_the_builder_makes(figure):
    made, stored = stand_in(figure), read_problem(example_path(figure))
    assert stored.options == made.options
    assert (stored.edge_a, stored.edge_b) == (made.edge_a, made.edge_b) == ("u0", "u0")
    for new, old in ((made.a, stored.a), (made.b, stored.b)):
        # Sine and cosine may differ in the last digit between machines; knots are decimals.
        np.testing.assert_array_equal(new.knots_v, old.knots_v)
        np.testing.assert_allclose(new.knots_u, old.knots_u, rtol=1e-15)
        np.testing.assert_allclose(new.control_points, old.control_points, rtol=0, atol=1e-12)


@pytest.mark.parametrize("figure", FIGURES)
def test_sizes_and_knots_are_the_printed_ones(figure):
    pair = bases(figure)
    assert tuple(s.control_points.shape[:2] for s in pair) == SIZES[figure] == PRINTED[figure].sizes
    assert [(s.degree_u, s.degree_v) for s in pair] == [(3, 3)] * 2
    for surface, inner in zip(pair, INNER.get(figure, ()), strict=False):
        np.testing.assert_array_equal(surface.knots_v, [0, 0, 0, 0, *inner, 1, 1, 1, 1])
    task = example(figure)
    assert task.middle_curves == (0 if figure in (10, 11) else 1)
    assert task.continuity == ("C2" if figure in (5, 8, 9) else "G2")
    assert task.closed == (figure == 10)


def test_only_figure_10_is_repaired_and_every_departure_says_why():
    for figure in FIGURES:
        printed = PRINTED[figure].knots
        assert (usable_knots(figure) == printed) == (figure != 10)
    assert len(PRINTED[10].knots[0]) == 13
    assert usable_knots(10)[0] == (0, *PRINTED[10].knots[0])
    assert {d.figure for d in DEPARTURES} == {5, 10, 11}
    assert all(d.why and d.used and d.printed for d in DEPARTURES)


def plane_residual(points):
    flat = points.reshape(-1, 3) - points.reshape(-1, 3).mean(axis=0)
    return np.linalg.svd(flat, compute_uv=False)[2] / np.linalg.norm(flat)


def test_planes_are_planes_and_the_curved_patch_is_not():
    for surface in bases(5):
        assert plane_residual(surface.control_points) < 1e-15
    plane, curved = bases(6)
    assert plane_residual(plane.control_points) < 1e-15
    assert plane_residual(curved.control_points) > 0.02
    first, second = bases(5)
    corners = [s.control_points[[0, -1, 0], [0, 0, -1]] for s in (first, second)]
    normals = [np.cross(across - corner, along - corner) for corner, across, along in corners]
    assert np.linalg.norm(np.cross(*normals)) > 0.3 * np.prod(np.linalg.norm(normals, axis=1))


def axis_and_radii(surface):
    """The axis of a surface with straight, parallel rulings along u, and the distances of points from it."""
    ruling = surface.control_points[-1] - surface.control_points[0]
    np.testing.assert_allclose(ruling, np.tile(ruling[0], (len(ruling), 1)), atol=1e-11)
    axis = ruling[0] / np.linalg.norm(ruling[0])
    v = np.linspace(0, 1, 400, endpoint=False)
    points = surface_points(surface, np.zeros_like(v), v)
    flat = points - np.outer(points @ axis, axis)
    # Centre of the circle by least squares: |p|^2 = 2 p.c + constant.
    system = np.column_stack([2 * flat, np.ones(len(flat))])
    centre = np.linalg.lstsq(system, np.sum(flat**2, axis=1), rcond=None)[0][:3]
    return axis, np.linalg.norm(flat - centre, axis=1)


@pytest.mark.parametrize(("figure", "error"), [(8, 0.02), (9, 0.02), (10, 0.012)])
def test_cylinders_are_round_and_of_different_radius(figure, error):
    means = []
    for surface in bases(figure):
        _, radii = axis_and_radii(surface)
        # Cubic splines with so few knots are circles up to this error only.
        assert np.ptp(radii) < error * radii.mean()
        means.append(radii.mean())
    assert means[0] > 1.3 * means[1]


def test_figure_9_is_figure_8_in_another_posture():
    (a8, b8), (a9, b9) = bases(8), bases(9)
    np.testing.assert_array_equal(a8.control_points, a9.control_points)
    cloud8, cloud9 = (s.control_points.reshape(-1, 3) for s in (b8, b9))
    distances = [np.linalg.norm(c[:, None] - c, axis=2) for c in (cloud8, cloud9)]
    np.testing.assert_allclose(*distances, atol=1e-11)
    axes = [axis_and_radii(s)[0] for s in (b8, b9)]
    assert abs(axes[0] @ axes[1]) < 0.8


def test_whole_cylinders_close_exactly_and_seams_face_each_other():
    pair = bases(10)
    seams = []
    for surface in pair:
        np.testing.assert_array_equal(surface.control_points[:, 0], surface.control_points[:, -1])
        u = np.linspace(0, 1, 7)
        for order in range(3):
            ends = [surface_points(surface, u, np.full_like(u, v), 0, order) for v in (0.0, 1.0)]
            np.testing.assert_allclose(*ends, rtol=0, atol=1e-9 * np.abs(ends[0]).max())
        seams.append(surface.control_points[0, 0])
    # Of all points of the second contact, that at its seam has the direction from its centre closest to the first's.
    v = np.linspace(0, 1, 721)[:-1]
    contacts = [surface_points(s, np.zeros_like(v), v) for s in pair]
    directions = [c - c.mean(axis=0) for c in contacts]
    directions = [d / np.linalg.norm(d, axis=1)[:, None] for d in directions]
    assert np.argmax(directions[1] @ directions[0][0]) == 0


def test_the_cone_is_a_cone():
    cone, free = bases(11)
    # Rulings are straight and meet in one point.
    net = cone.control_points
    start, ruling = net[0], net[-1] - net[0]
    apexes = (
        start
        + np.linalg.norm(start[:, 1:], axis=1)[:, None]
        / (np.linalg.norm(start[:, 1:], axis=1) - np.linalg.norm(net[-1][:, 1:], axis=1))[:, None]
        * ruling
    )
    np.testing.assert_allclose(apexes, np.tile(apexes[0], (len(apexes), 1)), atol=1e-9)
    spread = np.cross(net[1] - net[0], net[2] - net[0])
    assert np.abs(spread).max() < 1e-9
    assert len(np.unique(free.knots_v)) - 1 == 61


def test_figure_5_has_the_common_vector_exactly():
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 13)))
    for surface, common in zip(bases(5), figure_5_on_common_knots(), strict=True):
        np.testing.assert_array_equal(common.knots_v, [0, 0, 0, 0, 0.5, 1, 1, 1, 1])
        np.testing.assert_allclose(surface_points(common, u, v), surface_points(surface, u, v), atol=1e-12)
