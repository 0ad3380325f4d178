"""The lines across the ends of a chain lie on the faces named for them, whatever way the chain is blended."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.chains import LINE, arc, circle, flanges, line, walls
from semispline import Base, BSplineSurface, EdgeError, chain
from semispline.solver.blending.chain_bases import as_bases
from semispline.solver.blending.chain_coefficients import Coefficients, JoinedPieces, Joint, Q
from semispline.solver.blending.chain_runs import run_back
from semispline.solver.blending.chains import _is_steered
from semispline.solver.blending.end_faces import EndFace
from semispline.solver.options import BlendOptions

SLANTED = np.array([0.3, 1.0, 0.6]), np.array([1.0, 0.2, -0.5])
SQUARE = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])


def rims(normals):
    """Walls and a plane beside them, along the x axis, an arc and the y axis, between two planes."""
    ends = tuple(EndFace.plane(x) for x in normals)
    below = [line((2, -3), (2, 0)), arc((0, 0), 2.0, 0, 90), line((0, 2), (-3, 2))]
    above = [line((1.5, -3), (1.5, 0)), arc((0, 0), 1.5, 0, 90), line((0, 1.5), (-3, 1.5))]
    faces = walls(below), flanges(above, base=0.5, width=-0.4)
    return [replace(chain(x), ends_on=ends) for x in faces]


def off(strip, normals):
    """How far control points at the ends are from the planes."""
    net = strip.surface.control_points
    return max(np.abs((net[:, k] - net[0, k]) @ normal).max() for k, normal in zip((0, -1), normals, strict=True))


@pytest.mark.parametrize("cuts", [(0, 90), (0, 45, 90), (0, 20, 60, 90)])
def test_arcs_of_one_circle_end_on_slanted_planes(cuts):
    faces = walls(circle(2.0, cuts))
    one = replace(chain(faces), ends_on=tuple(EndFace.plane(x) for x in SLANTED))
    # Coordinates of 2: roundings of them.
    assert off(one.strip(2), SLANTED) < 1e-13
    assert off(replace(one, ends_on=(None, None)).strip(2), SLANTED) > 0.1


@pytest.mark.parametrize(("normals", "as_they_are"), [(SQUARE, True), (SLANTED, False)])
def test_rims_that_answer_each_other_end_on_planes(normals, as_they_are):
    stated = as_bases(*rims(normals), BlendOptions())
    assert stated.lines_answer is as_they_are
    assert max(off(strip, normals) for strip in stated.strips) < 1e-13


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize(("times", "steered"), [(0.8, False), (1.25, True), (-1.25, True)])
def test_lines_lean_by_more_than_rounding_at_a_free_end(end, times, steered):
    found = [Coefficients(np.zeros((2, 3, 3)), np.zeros((2, 3, 3)), 1.0, 0.0) for _ in (0, 1)]
    found[end].values[end, Q, 2] = times * 1e-12
    one = JoinedPieces((), np.ones(2), tuple(found), (None, None), (0, 0))
    assert _is_steered(one) is steered
    # What is closed has no ends.
    joint = Joint((0.0, 0.0, 0.0), "smooth", 0.0, 0.0, (0.0,), 0.0, (0.0, 0.0))
    assert not _is_steered(replace(one, joints=(joint, joint)))
    # Nor is an end what is inside.
    found[end].values[:] = 0.0
    found[end].values[1 - end, Q, 2] = 1.0
    assert not _is_steered(one)


def test_a_chain_run_back_ends_on_the_same_faces():
    (one, _) = rims(SLANTED)
    back = run_back(one)
    assert back.ends_on == one.ends_on[::-1]
    assert off(back.strip(2), SLANTED[::-1]) < 1e-13


@pytest.mark.parametrize("still", [(0, 1, 1), (1, 1, 2)])
def test_an_edge_that_stands_still_where_it_meets_the_next_is_refused(still):
    """Two control points in one: the speeds of both faces cannot be made to agree."""
    runs = [(0, 0.5, 1), still] if still[0] else [still, (1, 1.5, 2)]
    faces = []
    for xs in runs:
        net = [[[x, 0, z] for x in xs] for z in (0, -1)]
        faces.append(Base(BSplineSurface(1, 2, LINE, [0, 0, 0, 1, 1, 1], net), "u0"))
    with pytest.raises(EdgeError, match="joint 1: the contact stands still there"):
        chain(faces).strip(2)
