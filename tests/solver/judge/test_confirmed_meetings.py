"""What counts as one place, as reached and as apart, and how much is tried: each figure from both sides."""

import numpy as np
import pytest

from semispline import BSplineSurface
from semispline.solver.judge import confirmed_meetings
from semispline.solver.judge.confirmed_meetings import _Meeting, search_itself
from semispline.solver.judge.mesh_search import Hits, grid_mesh

K1 = [0, 0, 1, 1]


def sheet(height, origin=(0.0, 0.0, 0.0)):
    """The unit square at a height."""
    net = np.array([[[0, 0, height], [0, 1, height]], [[1, 0, height], [1, 1, height]]]) + np.array(origin)
    return BSplineSurface(1, 1, K1, K1, net)


def meeting_of(first, second):
    ends = np.array([0.0, 1.0])
    return _Meeting(first, grid_mesh(first, ends, ends, (False, False)), second, grid_mesh(second, ends, ends, (0, 0)))


@pytest.mark.parametrize(
    ("apart", "distance", "is_reached"),
    # A hundred thousand millionth of the extent, and 64 roundings of what is 1e6 away: 1.4e-8.
    [(5e-12, 0, True), (2e-11, 0, False), (1e-8, 1e6, True), (2e-8, 1e6, False)],
)
def test_points_are_one_within_a_limit_of_extent_and_rounding(apart, distance, is_reached):
    origin = (distance, 0.0, 0.0)
    at = np.array([[0.4, 0.7]])
    _, _, reached = meeting_of(sheet(0.0, origin), sheet(apart, origin))._steps(at, at)
    assert reached.tolist() == [is_reached]


class Watched(BSplineSurface):
    """A surface that keeps where its points are asked for."""

    def evaluate(self, u, v, du=0, dv=0):
        if du == dv == 0:
            self.__dict__.setdefault("asked", []).append(float(np.asarray(u)[0]))
        return super().evaluate(u, v, du, dv)


def test_a_step_goes_no_further_than_a_tenth_of_the_domain():
    """A slope that crosses the sheet at u = 1/2; one step would do."""
    slope = Watched(1, 1, K1, K1, [[[0, 0, -1], [0, 1, -1]], [[1, 0, 1], [1, 1, 1]]])
    start = np.array([[0.9, 0.5]])
    first, _, reached = meeting_of(slope, sheet(0.0))._steps(start, start)
    assert reached.all()
    assert first[0, 0] == pytest.approx(0.5, abs=1e-9)
    steps = np.abs(np.diff(slope.__dict__["asked"]))
    assert steps[:2] == pytest.approx([0.1, 0.1])
    assert steps.max() <= 0.1 + 1e-12


# x = |u - 1/2|: both halves of the sheet are one.
FOLDED = BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], K1, [[[x, 0, 0], [x, 1, 0]] for x in (0.5, 0.0, 0.5)])


@pytest.mark.parametrize(("cells", "count"), [(0.4, 0), (0.49, 0), (0.51, 1), (0.6, 1)])
def test_half_a_cell_apart_parameters_are_of_two_places(monkeypatch, cells, count):
    u = np.linspace(0, 1, 11)
    off = cells / 2 * 0.1
    hits = Hits(np.array([[0.5 - off, 0.33]]), np.array([[0.5 + off, 0.33]]))
    monkeypatch.setattr(confirmed_meetings, "crossings", lambda *_: hits)
    places = search_itself(FOLDED, grid_mesh(FOLDED, u, u, (False, False)))
    assert (len(places.found), places.unconfirmed) == (count, 1 - count)


@pytest.mark.parametrize(("crowds", "each", "tried"), [(1, 100, 12), (1, 5, 5), (400, 8, 400 * 5), (2500, 1, 2000)])
def test_a_dozen_hits_of_each_place_are_tried_and_two_thousand_in_all(crowds, each, tried):
    meeting = meeting_of(sheet(0.0), sheet(0.0))
    at = np.full((crowds * each, 2), 0.5)
    seen = []

    def is_real(first, second):
        seen.append(len(first))
        return np.ones(len(first), dtype=bool)

    places = meeting.places(Hits(at, at), np.repeat(np.arange(crowds), each), "itself", is_real)
    assert seen == [tried]
    # Who was not tried is not confirmed.
    assert len(places.found) == min(crowds, tried)
    assert places.unconfirmed == crowds - len(places.found)


@pytest.mark.parametrize(("cells", "crowds"), [(0.1, 1), (5.5, 1), (6.5, 2)])
def test_hits_in_boxes_of_three_cells_that_touch_are_one_place(cells, crowds):
    u = np.linspace(0, 1, 31)
    mesh = grid_mesh(sheet(0.0), u, u, (False, False))
    at = np.array([[0.5, 0.5], [cells, 0.5]]) / 30
    assert len(np.unique(confirmed_meetings._crowds(mesh, mesh, Hits(at, at)))) == crowds
