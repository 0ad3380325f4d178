"""Ends of blends moved onto a curve: contact stays G1 there, and nothing changes further on."""

from dataclasses import replace

import numpy as np
import pytest

from semispline import Base, BSplineCurve, BSplineSurface, EdgeError, chain, extrude
from semispline.solver.blending.chain_runs import run_back
from semispline.solver.blending.end_faces import EndFace
from semispline.solver.blending.kept_ends import end_on_curve
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
