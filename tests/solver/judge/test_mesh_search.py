"""What touches, what lies in one plane and what is too much to look at: each figure of the search from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.shapes import line, revolved
from semispline import BSplineSurface
from semispline.solver.judge import mesh_search
from semispline.solver.judge.box_tree import box_tree, overlapping
from semispline.solver.judge.mesh_search import crossings, grid_mesh

K1 = [0, 0, 1, 1]
# Twice the area and all extents are 1.
FLOOR = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def pierces(start, end):
    hit, where = mesh_search._pierces(column(start), column(end), FLOOR[..., None])
    return hit.tolist() == [0], where.T.ravel()


def column(point):
    return np.array(point, dtype=float)[:, None]


@pytest.mark.parametrize(("off", "touches"), [(-0.1, True), (0.5e-9, True), (2e-9, False), (0.1, False)])
def test_a_segment_may_miss_a_triangle_by_a_billionth(off, touches):
    # Beside each edge; and before each end of the segment.
    for x, y in ((0.3, -off), (-off, 0.3), (0.5 + off, 0.5)):
        assert pierces((x, y, -1), (x, y, 2))[0] is touches
    for start, end in ((off, 1.0), (1.0, off), (-off, -1.0), (-1.0, -off)):
        assert pierces((0.2, 0.2, start), (0.2, 0.2, end))[0] is touches


def test_where_a_segment_pierces():
    hit, where = pierces((0.2, 0.3, -1), (0.2, 0.3, 3))
    assert hit
    assert where == pytest.approx([0.2, 0.3, 0], abs=1e-15)
    # Whole segments on one side, also where their lines pierce it far away.
    for start, end in ((1.0, 3.0), (3.0, 1.0), (-3.0, -1.0)):
        assert not pierces((0.2, 0.2, start), (0.2, 0.2, end))[0]


@pytest.mark.parametrize(("height", "reaches"), [(0.5e-9, True), (2e-9, False)])
def test_triangles_reach_a_plane_within_a_billionth_of_their_size(height, reaches):
    for side in (1, -1):
        above = FLOOR + np.array([0, 0, side * height])
        assert mesh_search._reaches(FLOOR[..., None], above[..., None]).tolist() == [reaches]
        # On the other side of its first corner as well.
        beyond = np.array([0, 0, side * height]) - FLOOR
        assert mesh_search._reaches(FLOOR[..., None], beyond[..., None]).tolist() == [reaches]


def overlap(q):
    hit, where = mesh_search._overlap_in_plane(FLOOR[..., None], np.array(q)[..., None])
    return bool(hit[0]), where[:, 0]


@pytest.mark.parametrize(("height", "flat"), [(0.5e-9, True), (2e-9, False)])
def test_triangles_lie_in_one_plane_within_a_billionth(height, flat):
    inner = np.array([[0.2, 0.2, 0.0], [1.0, 0.2, 0.0], [0.2, 1.0, 0.0]])
    for side in (1, -1):
        assert overlap(inner + np.array([0, 0, side * height]))[0] is flat


@pytest.mark.parametrize(("depth", "hit"), [(0.5e-9, False), (4e-9, True), (-0.1, False)])
def test_a_corner_that_is_inside_by_more_than_a_billionth(depth, hit):
    # Over the long side, and its edges go through that side.
    corner, out = np.array([0.5 - depth, 0.5, 0.0]), np.array([1.0, 1.0, 0.0])
    assert overlap([corner, corner + out + [0.5, -0.5, 0], corner + out + [-0.5, 0.5, 0]])[0] is hit


def test_edges_that_cross_without_a_corner_inside():
    centre = FLOOR.mean(axis=0)
    # The star of two triangles.
    hit, where = overlap(2 * centre - FLOOR)
    assert hit
    x, y, _ = where
    assert min(x, y, 1 - x - y) >= -1e-12
    # A needle through it; and the same beside it, where the lines of both go on to cross.
    needle = np.array([[-1.0, 0.3, 0.0], [2.0, 0.25, 0.0], [2.0, 0.35, 0.0]])
    assert overlap(needle)[0]
    for away in ([-3.5, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -0.5, 0.0]):
        assert not overlap(needle + away)[0]


def test_in_a_plane_triangles_that_only_touch_do_not_overlap():
    """Two sheets of a flat surface have their edges in common as points, not as vertices."""
    for q in (FLOOR[[1, 0]] * 1.0, FLOOR[[0, 2]], FLOOR[[2, 1]]):
        beyond = q.mean(axis=0) + (q.mean(axis=0) - FLOOR.mean(axis=0))
        assert not overlap([q[0], q[1], beyond])[0]


def crossing_pair(size=1.0):
    """Two sheets that cross, on one cell each, as two meshes over the points of both."""
    sheets = (
        [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]],
        [[[0.3, 0.2, -1], [0.3, 0.3, 1]], [[0.6, 0.2, -1], [0.6, 0.3, 1]]],
    )
    ends = np.array([0.0, 1.0])
    first, second = (
        grid_mesh(BSplineSurface(1, 1, K1, K1, size * np.array(net)), ends, ends, (False, False)) for net in sheets
    )
    points = np.concatenate([first.points, second.points])
    return first, replace(second, points=points, triangles=second.triangles + 4, vertex=second.vertex + 4)


@pytest.mark.parametrize("size", [1.0, 1e-100, 1e100])
def test_units_do_not_matter(size):
    a, b = crossing_pair(size)
    hits, expected = crossings(a, b), crossings(*crossing_pair())
    assert len(hits.first) > 1
    np.testing.assert_allclose(hits.first, expected.first, atol=1e-9)
    np.testing.assert_allclose(hits.second, expected.second, atol=1e-9)


def test_what_is_one_point_crosses_nothing():
    a, b = crossing_pair()
    nothing = replace(b, points=np.zeros_like(b.points))
    assert len(crossings(replace(a, points=a.points * 0), nothing).first) == 0


def test_the_search_ends_at_20000_hits(monkeypatch):
    a, b = crossing_pair()
    i, j = next(iter(overlapping(box_tree(*box(a, b.points)), box_tree(*box(b, b.points)))))
    hit, _ = mesh_search._crossing(b.points.T, a.triangles[i], b.triangles[j])
    one, other = (np.full(10_000, index[hit][0]) for index in (i, j))
    monkeypatch.setattr(mesh_search, "overlapping", lambda *_: iter([(one, other)] * 4))
    assert len(crossings(a, b).first) == 20_000


def box(mesh, points):
    corners = points[mesh.triangles]
    return corners.min(axis=1), corners.max(axis=1)


def test_a_pole_is_an_edge_within_a_billionth_of_the_surface():
    """A cone over a rim of radius 2, cut off near its tip."""
    for radius, is_pole in ((1.9e-9, True), (2.1e-9, False)):
        surface = revolved(line((radius, 0), (2, 1)))
        mesh = grid_mesh(surface, np.linspace(0, 1, 3), np.linspace(0, 4, 9), (False, True))
        assert mesh.poles == (is_pole, False, False, False)


def test_boxes_that_touch_overlap():
    """Sheets in one plane have flat boxes."""
    low = np.array([[0.0, 0.0], [1.0, 0.0], [2.5, 0.0]])
    tree = box_tree(low, low + np.array([1.0, 0.0]))
    assert [(i.tolist(), j.tolist()) for i, j in overlapping(tree, tree)] == [([0], [1])]
    # And the other way round: a above b.
    first, second = box_tree(low[:1], low[:1] + 1), box_tree(low[1:2], low[1:2] + 1)
    for a, b in ((first, second), (second, first)):
        assert [(i.tolist(), j.tolist()) for i, j in overlapping(a, b)] == [([0], [0])]


def test_how_far_a_mesh_is_off():
    """z = x^2 in one cell: 1/4 in the middle, where the corners have 1/2."""
    net = [[[x, y, z] for y in (0, 1)] for x, z in ((0, 0), (0.5, 0), (1, 1))]
    ends = np.array([0.0, 1.0])
    mesh = grid_mesh(BSplineSurface(2, 1, [0, 0, 0, 1, 1, 1], K1, net), ends, ends, (False, False))
    assert mesh.deflection == pytest.approx(0.25)
