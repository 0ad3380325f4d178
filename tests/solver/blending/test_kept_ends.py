"""Ends of blends moved onto a curve: contact stays G1 there, and nothing changes further on."""

import re
from dataclasses import replace

import numpy as np
import pytest

from semispline import Base, BSplineCurve, BSplineSurface, EdgeError, chain, extrude
from semispline.solver.blending import kept_ends
from semispline.solver.blending.chain_runs import run_back
from semispline.solver.blending.end_faces import EndFace
from semispline.solver.blending.kept_ends import EndOnCurve, end_on_curve
from semispline.solver.splines import surface_jet

TURN = np.linspace(0.0, np.pi / 2, 129)
ARC = np.stack([1 - np.sin(TURN), 1 - np.cos(TURN), np.zeros_like(TURN)], axis=1)[::-1]
# From the wall x = 0 to the floor y = 0, as long as the arc is.
TANGENTS = np.pi / 2 * np.array([[0.0, -1, 0], [1, 0, 0]])


def quintic(length=10.0, weights=None):
    """Straight rows between a wall and a floor, of no curvature at both."""
    row = np.array([[0.0, 1], [0, 0.75], [0, 0.5], [0.5, 0], [0.75, 0], [1, 0]])
    net = np.stack([np.column_stack([row, np.full(6, z)]) for z in (0.0, length)], axis=1)
    knots = [0.0] * 6 + [1.0] * 6
    return BSplineSurface(5, 1, knots, [0.0, 0, 1, 1], net, weights)


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize("weights", [None, "along", "across"])
def test_the_end_lies_on_the_curve_and_the_rest_is_what_it_was(end, weights):
    given = {
        None: None,
        "along": np.repeat([[1.0, 1.3]], 6, axis=0),
        # One row beside a contact has weights of its own along.
        "across": np.array([[1.0, 1.0], [1.0, 1.2], [1, 1], [1, 1], [1.1, 1.0], [1, 1]]),
    }[weights]
    surface = quintic(weights=given)
    curve = ARC + np.array([0.0, 0.0, 10.0 * end])
    found = end_on_curve(surface, end, curve, TANGENTS, 0.25, 1e-9)
    assert found.distance <= 1e-9
    u = np.linspace(0.0, 1.0, len(curve))
    np.testing.assert_allclose(found.surface.evaluate(u, np.full_like(u, float(end))), curve, rtol=0, atol=1e-9)
    # A quarter of the range on nothing has changed: values are exact to rounding of the products.
    grid = np.linspace(0.0, 1.0, 21)
    far = np.linspace(0.25, 1.0, 13) if end == 0 else np.linspace(0.0, 0.75, 13)
    np.testing.assert_allclose(
        found.surface.evaluate_grid(grid, far), surface.evaluate_grid(grid, far), rtol=0, atol=1e-11
    )
    # Contacts are where they were, and met in their planes: x = 0 and y = 0.
    v = np.linspace(0.0, 1.0, 41)
    for at, flat in ((0.0, 0), (1.0, 1)):
        jets = surface_jet(found.surface, np.full_like(v, at), v, 1)
        for key in ((0, 0), (1, 0), (0, 1)):
            assert np.abs(jets[key][:, flat]).max() <= 1e-11


def test_the_step_begins_and_ends_without_slope_and_bend():
    """The face beyond the edge is met smoothly by straight rows, and the blend is G2 inside."""
    surface = quintic()
    found = end_on_curve(surface, 0, ARC, TANGENTS, 0.25, 1e-9).surface
    u = np.linspace(0.0, 1.0, 9)
    at_end = surface_jet(found, u, np.zeros_like(u), 2)
    # Along v the rows go straight on: 10 per unit of v, and do not bend.
    np.testing.assert_allclose(at_end[0, 1], np.tile([0.0, 0, 10], (9, 1)), rtol=0, atol=1e-9)
    np.testing.assert_allclose(at_end[0, 2], 0.0, rtol=0, atol=1e-7)
    knots = np.full_like(u, 0.25)
    sides = [surface_jet(found, u, knots, 2, (u, knots + step)) for step in (-0.01, 0.01)]
    for key, value in sides[0].items():
        np.testing.assert_allclose(value, sides[1][key], rtol=0, atol=1e-7)


def test_a_curve_beside_the_blend_is_refused():
    with pytest.raises(EdgeError, match="beside the old end edge"):
        end_on_curve(quintic(), 0, ARC, TANGENTS + np.array([0.0, 0.0, 0.2]), 0.25, 1e-9)


@pytest.mark.parametrize("size", [0.1, 1.0, 40.0])
@pytest.mark.parametrize("contact", [0, 1])
@pytest.mark.parametrize(
    ("degrees", "told"), [(0.05, None), (0.0573 + 0.0005, "0.058"), (60.0, "60"), (90.0, "90"), (180.0, "1.8e+02")]
)
def test_a_blend_leaves_its_contact_within_a_thousandth_of_where_the_curve_begins(size, contact, degrees, told):
    """Whatever the units are: 0.001 is 0.0573 degrees."""
    net = quintic().control_points * size
    surface = replace(quintic(), control_points=net)
    x = np.radians(degrees)
    tangents = size * TANGENTS
    tangents[contact] = np.cos(x) * tangents[contact] + np.sin(x) * np.array([0, 0, np.pi / 2 * size])
    if told is None:
        assert end_on_curve(surface, 0, size * ARC, tangents, 0.25, 0.01 * size).distance < 0.01 * size
    else:
        with pytest.raises(EdgeError, match=rf"leaves its contact {re.escape(told)} degrees beside"):
            end_on_curve(surface, 0, size * ARC, tangents, 0.25, 0.01 * size)


@pytest.mark.long
def test_eight_degrees_are_added_at_most_and_no_more_than_needed(monkeypatch):
    """Each halves the distance: what is sought is met exactly."""
    tried = []

    def halved(surface, *_):
        tried.append(surface.degree_u - 5)
        return EndOnCurve(surface, 0.5 ** tried[-1])

    monkeypatch.setattr(kept_ends, "_moved", halved)
    for raised in (0, 1, 8):
        tried.clear()
        assert end_on_curve(quintic(), 0, ARC, TANGENTS, 0.25, 0.5**raised).distance == 0.5**raised
        assert tried == list(range(raised + 1))
    tried.clear()
    with pytest.raises(EdgeError, match=r"stays 0\.0039 off"):
        end_on_curve(quintic(), 0, ARC, TANGENTS, 0.25, 0.0039)
    assert tried == list(range(9))


@pytest.mark.parametrize(("times", "degree"), [(0.0, 6), (0.5, 6), (2.0, 7), (1e4, 7)])
@pytest.mark.parametrize("row", [1, -2])
def test_a_step_is_of_degree_five_more_and_of_twice_the_degree_where_weights_are_not_even(row, times, degree):
    weights = np.ones((6, 2))
    weights[row, 1] += times * 1e-12
    found = end_on_curve(quintic(weights=weights), 0, ARC, TANGENTS, 0.25, 1e-9).surface
    assert found.degree_v == degree
    # C2 where it ends.
    assert np.count_nonzero(found.knots_v == 0.25) == degree - 2


@pytest.mark.parametrize("degree", [20, 21])
def test_degrees_along_up_to_25(degree):
    net = np.stack([quintic().control_points[:, 0] + [0, 0, z] for z in np.linspace(0, 10, degree + 1)], axis=1)
    knots = [0.0] * (degree + 1) + [1.0] * (degree + 1)
    surface = BSplineSurface(5, degree, quintic().knots_u, knots, net)
    if degree == 20:
        assert end_on_curve(surface, 0, ARC, TANGENTS, 0.25, 1e-9).surface.degree_v == 25
    else:
        with pytest.raises(EdgeError, match="degree 26 along, expected at most 25"):
            end_on_curve(surface, 0, ARC, TANGENTS, 0.25, 1e-9)


def kinked(place, x=0.2):
    """As `quintic`, in two stretches along: its middle rows have a kink between them."""
    rows = quintic().control_points[:, 0]
    net = np.stack([rows + np.array([0, 0, z]) for z in (0.0, 10 * place, 10.0)], axis=1)
    net[2:4, 1, :2] += x
    return BSplineSurface(5, 1, quintic().knots_u, [0, 0, place, 1, 1], net)


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize("place", [0.1, 0.25, 0.25 - 5e-10, 0.25 + 5e-10, 0.25 + 2e-9, 0.6])
def test_a_kink_stays_where_it_is_wherever_the_step_ends(end, place):
    """And where it ends at a knot, to a part in 1e9, there is one knot."""
    surface = kinked(place if end == 0 else 1 - place)
    points = ARC + np.array([0.0, 0.0, 10.0 * end])
    found = end_on_curve(surface, end, points, TANGENTS, 0.25, 1e-9).surface
    inner = np.unique(found.knots_v)[1:-1]
    assert len(inner) == (1 if abs(place - 0.25) < 1e-9 else 2)
    far = np.linspace(0.25 + 2e-9, 1.0, 40)
    far = np.append(far, [place] if place > 0.25 else [])
    far = far if end == 0 else 1 - far
    grid = np.linspace(0.0, 1.0, 9)
    np.testing.assert_allclose(found.evaluate_grid(grid, far), surface.evaluate_grid(grid, far), rtol=0, atol=1e-11)
    at = surface.knots_v[2]
    assert np.count_nonzero(np.abs(found.knots_v - at) < 1e-12) == found.degree_v


def test_a_curve_that_the_rows_cannot_follow_is_refused():
    wild = ARC + 0.05 * np.sin(40 * TURN)[:, None] * np.sin(2 * TURN)[:, None] ** 2
    with pytest.raises(EdgeError, match=r"it stays .* off the old end edge, expected at most 1e-09"):
        end_on_curve(quintic(), 0, wild, TANGENTS, 0.25, 1e-9)


def test_a_chain_that_is_run_back_keeps_each_face_at_its_end():
    """Bent at one end alone: onto a plane askew to the walls; the other end is square."""
    corners = [[0.0, 0, 0], [4, 0, 0], [8, 0, 0]]
    lines = [BSplineCurve(1, [0, 0, 1, 1], pair) for pair in (corners[:2], corners[1:])]
    walls = chain([Base(extrude(line, [0, 0, -2.0]), "u0") for line in lines])
    askew = EndFace.plane(np.array([1.0, 0.0, 0.4]))
    bent = replace(walls, ends_on=(askew, None))
    for one, x in ((bent, 0.0), (run_back(bent), 8.0)):
        surface = one.strip(2).shown
        across = surface.evaluate_grid([0.0, 1e-3], list(surface.domain[1]))
        leaves = np.diff(across, axis=0)[0]
        leaves /= np.linalg.norm(leaves, axis=1)[:, None]
        # The first end of the chain is at x = 0, whichever way it is run through.
        at = int(np.abs(across[0, :, 0] - 0.0).argmin())
        assert across[0, 0, 0] == pytest.approx(x, abs=1e-12)
        assert abs(leaves[at] @ askew.normal) <= 1e-9
        assert abs(leaves[1 - at] @ [1.0, 0, 0]) <= 1e-9
