"""Contacts moved towards holes that lie between the few paths of which limits are told: the answers are d - r."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

from helpers.parts import written
from helpers.solids import cut
from helpers.sweeps import examples, first_ones
from semispline import BSplineCurve, EdgeError, list_edges, plane, revolve
from semispline.solver.splines import EdgeName
from semispline.solver.topology import moved_edges
from semispline.solver.topology.cuts import Cut, moved_contact
from semispline.solver.topology.outlines import border
from semispline.solver.topology.swept import finer

# Said with four digits: of the distances below half of the last one is 0.0005.
SAID = 0.0006


def ring(middle, radius, points=120):
    """A circle as the polyline that an outline has."""
    t = np.linspace(0, 2 * np.pi, points + 1)
    t[-1] = 0.0
    return np.asarray(middle) + np.column_stack([np.cos(t), np.sin(t)]) * radius


def floor(length=40.0, width=20.0):
    """A plane whose parameters are lengths, as far as its domain has them."""
    surface = plane([0, 0, 0], [length, 0, 0], [0, width, 0])
    return surface, np.array([np.ptp(domain) for domain in surface.domain]) / (length, width)


def asked(surface, name, holes, cut, **more):
    """What is said to be the largest distance; None where the cut is done."""
    outline = replace(border(surface, name), holes=holes, **more)
    try:
        moved_contact(surface, name, cut, outline, 1e-9, "cut", "e0")
    except EdgeError as error:
        return float(str(error).rpartition(" ")[2])
    return None


@pytest.mark.slow
@examples(25)
@given(st.floats(0.02, 0.98), st.floats(0.05, 0.75), st.floats(2.0, 9.0), st.sampled_from([1.02, 2.0, 50.0]))
def test_a_hole_beside_a_straight_edge_wherever_it_is(place, radius, away, times):
    """Of 41 paths along 40 units the holes of radius below 0.49 slip through."""
    surface, scale = floor()
    hole = ring((40 * place, away), min(radius, 40 * min(place, 1 - place) - 0.01)) * scale
    largest = away - np.ptp(hole[:, 0]) / scale[0] / 2
    found = asked(surface, EdgeName("v", 0), [hole], Cut(distance=times * largest))
    assert found == pytest.approx(largest, abs=SAID)


@pytest.mark.parametrize("place", first_ones(1, [0.4, 20.49, 20.0, 39.2]))
def test_both_sides_of_the_limit(place):
    surface, scale = floor()
    holes, name = [ring((place, 6.85), 0.25) * scale], EdgeName("v", 0)
    assert asked(surface, name, holes, Cut(distance=6.5999)) is None
    assert asked(surface, name, holes, Cut(distance=6.6001)) == 6.6


@pytest.mark.parametrize("place", [0.3, 13.17, 20.49])
def test_a_parameter_beyond_a_hole(place):
    surface, scale = floor()
    holes, name = [ring((place, 6.85), 0.25) * scale], EdgeName("v", 0)
    assert asked(surface, name, holes, Cut(direction="v", parameter=6.5999 * scale[1])) is None
    found = asked(surface, name, holes, Cut(direction="v", parameter=6.6001 * scale[1]))
    assert found == pytest.approx(6.6 * scale[1], rel=1e-5)


@pytest.mark.slow
def test_the_nearest_of_several_holes_that_lie_between_paths():
    surface, scale = floor()
    holes = [ring(at, 0.4) * scale for at in ((5.36, 7.0), (20.49, 6.9), (31.2, 6.95), (36.1, 12.0))]
    assert asked(surface, EdgeName("v", 0), holes, Cut(distance=15.0)) == 6.5


def test_a_hole_behind_an_edge_that_ends_the_face_is_none():
    """A triangle below the line from (0, 4) to (40, 4 + 10): a ring above it is no part of the face."""
    surface, scale = floor()
    slope = [np.array([[0.0, 4.0], [40.0, 14.0]]) * scale]
    ring_above = [ring((10.2, 7.5), 0.3) * scale]
    sides = [np.array([[x, 0.0], [x, 20.0]]) * scale for x in (0.0, 40.0)]
    name = EdgeName("v", 0)
    assert asked(surface, name, ring_above, Cut(distance=9.0), ends=[*sides, *slope], others=[]) is None
    assert asked(surface, name, ring_above, Cut(distance=9.0), ends=sides, others=[]) == 7.2


@pytest.mark.slow
@pytest.mark.parametrize("seam", [0.0, 85.0, 92.0])
def test_a_hole_over_a_seam_of_a_tube(seam):
    """From a line of a tube of radius 5, at 0 degrees: a hole, 90 degrees on, of radius 0.2 in the rolled-out sheet."""
    t, radius = np.radians(seam), 5.0
    line = BSplineCurve(1, [0, 0, 1, 1], [[radius * np.cos(t), radius * np.sin(t), z] for z in (0.0, 30.0)])
    surface = revolve(line, (0, 0, 0), (0, 0, 1))
    low, high = surface.domain[0]
    u = np.linspace(low, high, 200001)
    x, y, _ = surface.evaluate(u, np.full(len(u), 0.5)).T
    angles = np.unwrap(np.arctan2(y, x))
    rolled = ring((radius * np.pi / 2, 10.6), 0.2)
    at = np.interp((rolled[:, 0] / radius - angles[0]) % (2 * np.pi) + angles[0], angles, u)
    at = np.unwrap(at, period=high - low)
    at[-1] = at[0]
    hole = np.column_stack([at, rolled[:, 1] / 30.0 * np.ptp(surface.domain[1])])
    start = np.interp((-angles[0]) % (2 * np.pi) + angles[0], angles, u)
    name = EdgeName("u", 0, start) if seam else EdgeName("u", 0, low + 0.0 * high)
    for distance in (8.0, 20.0):
        found = asked(surface, name, [hole], Cut(distance=distance))
        assert found == pytest.approx(radius * np.pi / 2 - 0.2, abs=SAID)
    assert asked(surface, name, [hole], Cut(distance=7.65)) is None


def test_a_line_is_made_finer_along_its_curve_but_not_over_its_corners():
    circle = ring((1.0, 2.0), 3.0)
    fine = finer(circle, circle[0], np.zeros(2))
    # Of degree 5 through points 0.05 radians apart: 0.05^6 of the radius, over 720.
    assert np.hypot(*(fine - (1.0, 2.0)).T) == pytest.approx(3.0, abs=1e-9)
    assert len(fine) > 90
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]])
    assert finer(square, square[2], np.zeros(2)).tolist() == square.tolist()


@pytest.mark.long
@pytest.mark.usefixtures("read_here")
def test_a_drilled_hole_in_a_file(tmp_path):
    """The hole that was passed: of diameter 1, 6.35 away from an edge 40 long."""
    axes = gp_Ax2(gp_Pnt(20.49, 6.85, -1.0), gp_Dir(0, 0, 1))
    drill = BRepPrimAPI_MakeCylinder(axes, 0.5, 9.0).Shape()
    path = written(cut(BRepPrimAPI_MakeBox(40.0, 20.0, 5.0).Shape(), drill), tmp_path / "drilled.brep")
    faces = [list_edges(path, k) for k in range(7)]
    top, edge = next(
        (face, e) for face in faces for e in face.edges
        if len(face.edges) == 5 and e.start[2] == e.end[2] == 5.0 and e.start[1] == e.end[1] == 0.0
    )  # fmt: skip
    words = (f"{path}#{top.face}", f"{path}#{edge.neighbour}"), (None, None)
    for asked_for in ("6.36", "9"):
        with pytest.raises(EdgeError, match=r"beyond the face, expected a distance below 6\.35$"):
            moved_edges(*words, (asked_for, None))
    assert moved_edges(*words, ("6.34", None))[0].curve is None
