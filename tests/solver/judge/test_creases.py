"""Knots of full multiplicity: real creases are measured and warned of, smooth ones are only said."""

import numpy as np
import pytest

from helpers.bases import facing_pair, patch
from helpers.papers_set import blend
from semispline import Base, BSplineCurve, FoldError, SemiStructuredSurface, insert_knots
from semispline.solver.judge import Crease
from semispline.solver.judge.creases import measure_creases, worst_inside


def roof(angles):
    """Strips of degree 1 along v, each turned further down by an angle in degrees; straight and even in u."""
    turns = np.radians(np.cumsum([0.0, *angles]))
    steps = np.stack([np.zeros_like(turns), np.cos(turns), -np.sin(turns)], axis=1)
    ridge = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    inner = np.arange(1, len(turns)) / len(turns)
    knots = [0, 0, *inner, 1, 1]
    curves = [BSplineCurve(1, knots, ridge + np.array([x, 0, 0])) for x in (0, 1)]
    return SemiStructuredSurface(1, [0, 0, 1, 1], curves), inner


def test_angles_of_a_roof():
    angles = [30.0, 0.0, 100.0, 1e-4]
    surface, inner = roof(angles)
    creases = measure_creases(surface)
    assert [(crease.parameter, crease.at) for crease in creases] == [("v", at) for at in inner]
    assert [crease.angle_degrees for crease in creases] == pytest.approx(angles, abs=1e-10)


def test_a_crease_in_one_row_alone_is_seen():
    # A straight row and one with a corner: the surface bends where the corner counts, most at its own edge.
    straight = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 2, 0]])
    bent = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[1, 0, 0], [1, 1, 1], [1, 2, 0]])
    (crease,) = measure_creases(SemiStructuredSurface(1, [0, 0, 1, 1], (straight, bent)))
    assert crease.at == 0.5
    assert 0 < crease.angle_degrees < 90


def smooth_pair(extra_u=(), extra_v=()):
    rng = np.random.default_rng(3)
    a, b = facing_pair(rng, edges=("u0", "u0"), backwards=(False, False))
    degree, (start, end) = a.surface.degree_v, a.surface.domain[1]
    knots = [start + x * (end - start) for x in extra_v for _ in range(degree)]
    return Base(insert_knots(a.surface, extra_u, knots), "u0"), b


def test_joined_patches_that_are_smooth_are_no_crease():
    # Each span of the base along the contact as a file of Bezier patches has it: knots of full multiplicity, no bend.
    a, b = smooth_pair(extra_v=(0.37,))
    result = blend(a, b, middle_curves=0)
    assert not any("creased" in text for text in result.warnings)
    (crease,) = result.creases
    assert crease.parameter == "v"
    assert crease.angle_degrees < 1e-9


def test_a_crease_in_u_is_warned_of_and_strict_refuses_it():
    a, b = facing_pair(np.random.default_rng(3))
    options = {"u_knots": [0.5] * 3}
    result = blend(a, b, **options)
    (crease,) = result.creases
    assert (crease.parameter, crease.at) == ("u", 0.5)
    # By evaluation on both sides of the knot: a jump, however close.
    v = np.linspace(*result.surface.domain[1], 25)[1:-1]
    normals = []
    for u in (0.5 - 1e-9, 0.5 + 1e-9):
        normal = np.cross(*(result.surface.evaluate_grid([u], v, *order)[0] for order in ((1, 0), (0, 1))))
        normals.append(normal / np.linalg.norm(normal, axis=1, keepdims=True))
    seen = np.degrees(np.linalg.norm(np.cross(*normals), axis=1)).max()
    assert crease.angle_degrees > 0.1
    assert seen <= crease.angle_degrees * 1.1
    assert any("creased at u = 0.5" in warning for warning in result.warnings)
    with pytest.raises(FoldError, match=r"creased at u = 0\.5"):
        blend(a, b, strict=True, **options)


def test_without_knots_of_full_multiplicity_there_is_nothing_to_say():
    rng = np.random.default_rng(0)
    assert measure_creases(patch(rng, degrees=(3, 3), counts=(6, 7)).to_semistructured()) == ()


@pytest.mark.parametrize(
    ("angle", "jump", "said", "counts"),
    [
        (1e-5, 0.0, "crease 1e-05 degrees at u = 0.5", True),
        (1e-7, 1e-5, "G1 inside, curvature jump 0.001 % at u = 0.5", True),
        (1e-7, 1e-7, "G2 inside at u = 0.5", False),
    ],
)
def test_a_millionth_of_turn_and_of_curvature_is_smooth(angle, jump, said, counts):
    crease = Crease("u", 0.5, angle, 3.0, jump)
    assert str(crease) == said
    assert worst_inside([crease]) is (crease if counts else None)


def test_a_crease_of_which_no_curvature_is_said_has_none():
    crease = Crease("u", 0.5, 1e-7)
    assert (crease.curvature_jump, crease.curvature_jump_relative) == (0, 0)


@pytest.mark.parametrize(("curvature", "relative"), [(1e-4, 0.05), (0.01, 1.0)])
def test_curvature_below_a_thousandth_of_the_size_is_none(curvature, relative):
    # z = 0, then curvature / 2 (x - 1/4)^2: square to the line at 1/4 curvature jumps from nothing. Size 1/2.
    heights = [0, 0, 0, 0, curvature / 32]
    rows = [[[x, y, z] for y in (0.0, 0.5)] for x, z in zip(np.linspace(0, 0.5, 5), heights, strict=True)]
    knots = [0, 0, 0, 0.5, 0.5, 1, 1, 1]
    surface = SemiStructuredSurface(2, knots, [BSplineCurve(1, [0, 0, 1, 1], row) for row in rows])
    (crease,) = measure_creases(surface)
    assert crease.curvature_jump == pytest.approx(curvature, rel=1e-6)
    assert crease.curvature_jump_relative == pytest.approx(relative, rel=1e-6)


def test_a_line_that_is_a_point_has_no_curvature():
    rows = [[[-1, 0, 0], [-1, 1, 0]], [[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [1, 1, 0]]]
    surface = SemiStructuredSurface(1, [0, 0, 0.5, 1, 1], [BSplineCurve(1, [0, 0, 1, 1], row) for row in rows])
    (crease,) = measure_creases(surface)
    assert crease.curvature_jump == 0
