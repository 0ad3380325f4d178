"""The measures of contact, where the answer is known, and against Open CASCADE."""

import numpy as np
import pytest

from helpers.bases import facing_pair, moved
from helpers.occ import analyse, edge_point
from solver import Base, BSplineSurface, EdgeError, blend, measure_contact, measure_regularity
from solver.continuity import check_regular_edge
from solver.operations import reverse_u, reverse_v, swap_directions
from solver.regularity import area_bound

BEZIER_1, BEZIER_2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]


def parabola(curvature, *, bend=1.0, offset=0.0, tilt=0.0):
    """X = (bend u, v, curvature u^2 / 2 + tilt u + offset): normal curvature at u = 0 is curvature where bend is 1."""
    heights = (offset, offset + tilt / 2, offset + tilt + curvature / 2)
    net = [[[bend * u, v, z] for v in (0, 1)] for u, z in zip((0, 0.5, 1), heights, strict=True)]
    return BSplineSurface(2, 1, BEZIER_2, BEZIER_1, net)


def test_gap_angle_and_curvature_of_parabolas():
    a, b = parabola(2.0), parabola(-1.0, bend=-1.0, offset=0.25)
    contact = measure_contact(Base(a, "u0"), Base(b, "u0"))
    assert contact.gap == pytest.approx(0.25, rel=1e-14)
    assert contact.angle_degrees == pytest.approx(0, abs=1e-12)
    # Seen with one normal, the curvatures are 2 and -1.
    assert contact.curvature_jump == pytest.approx(3.0, rel=1e-13)
    assert contact.curvature_jump_relative == pytest.approx(1.5, rel=1e-13)
    assert contact.c1_residual == pytest.approx(0.0, abs=1e-15)
    assert contact.c2_residual == pytest.approx(1.5, rel=1e-14)


@pytest.mark.parametrize("degrees", [1e-7, 1e-3, 30.0, 89.0])
def test_small_and_large_angles(degrees):
    tilted = parabola(0.0, bend=-1.0, tilt=np.tan(np.radians(degrees)))
    contact = measure_contact(Base(parabola(0.0), "u0"), Base(tilted, "u0"))
    assert contact.angle_degrees == pytest.approx(degrees, rel=1e-7)


def test_speeds_differ_but_geometry_agrees():
    slow, fast = (
        parabola(2.0),
        BSplineSurface(2, 1, [0, 0, 0, 0.25, 0.25, 0.25], BEZIER_1, parabola(2.0).control_points),
    )
    back = moved(fast, np.diag([-1.0, 1, 1]))
    contact = measure_contact(Base(slow, "u0"), Base(back, "u0"))
    assert contact.curvature_jump_relative == pytest.approx(0, abs=1e-12)
    assert contact.c1_residual == pytest.approx(0.75, rel=1e-12)
    assert contact.c2_residual == pytest.approx(15 / 16, rel=1e-12)


def test_the_worst_place_is_named():
    bent = parabola(0.0, bend=-1.0).control_points.copy()
    bent[0, 1, 2] = 0.5
    contact = measure_contact(
        Base(parabola(0.0), "u0"), Base(BSplineSurface(2, 1, BEZIER_2, BEZIER_1, bent), "u0"), flip="no"
    )
    assert contact.gap == pytest.approx(0.5)
    assert contact.gap_at.parameter == 1.0
    assert contact.gap_at.point == (0.0, 1.0, 0.0)


@pytest.mark.parametrize("turn", [lambda s: s, reverse_u, reverse_v, swap_directions])
def test_measures_do_not_depend_on_how_the_surfaces_are_parametrised(turn):
    a, b = parabola(2.0, tilt=0.2), parabola(-1.0, bend=-1.0, offset=0.25, tilt=0.1)
    edge = {reverse_u: "u1", swap_directions: "v0"}.get(turn, "u0")
    plain = measure_contact(Base(a, "u0"), Base(b, "u0"))
    turned = measure_contact(Base(a, "u0"), Base(turn(b), edge))
    assert turned.flipped == (turn is reverse_v)
    for name in ("gap", "angle_degrees", "curvature_jump", "curvature_jump_relative", "c1_residual", "c2_residual"):
        assert getattr(turned, name) == pytest.approx(getattr(plain, name), rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_angle_agrees_with_open_cascade(seed):
    # A base met with itself moved and turned a little: everything is off by a known, measurable amount.
    a, _ = facing_pair(np.random.default_rng(seed), edges=("u0", "u0"), backwards=(False, False))
    turn = np.array([[np.cos(0.01), 0, np.sin(0.01)], [0, 1, 0], [-np.sin(0.01), 0, np.cos(0.01)]])
    b = moved(a.surface, turn @ np.diag([-1.0, 1, 1]))
    contact = measure_contact(a, Base(b, "u0"), flip="no")
    (v0, v1) = a.range_along
    s = (contact.angle_at.parameter - v0) / (v1 - v0)
    judged = analyse(a.surface, edge_point(a.surface, "u0", s), b, edge_point(b, "u0", s))
    # Open CASCADE compares planes, which have no side; the patches here may turn by more than a right angle.
    angle = np.radians(contact.angle_degrees)
    assert min(angle, np.pi - angle) == pytest.approx(judged.G1Angle(), rel=1e-9)


@pytest.mark.parametrize("edge", ["u2", "", "w0", 0])
def test_unknown_edge(edge):
    with pytest.raises(EdgeError, match="expected one of u0, u1, v0, v1"):
        Base(parabola(1.0), edge)


def test_an_edge_without_a_normal_has_no_angle():
    cone = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, [[[0, 0, 1], [0, 0, 1]], [[1, 0, 0], [0, 1, 0]]])
    contact = measure_contact(Base(cone, "u0"), Base(parabola(1.0), "u0"))
    assert np.isnan(contact.angle_degrees)
    assert np.isnan(contact.curvature_jump_relative)
    assert contact.gap > 0
    with pytest.raises(EdgeError, match="no normal at parameter"):
        check_regular_edge(Base(cone, "u0"))


@pytest.mark.parametrize("turn", [lambda s: s, reverse_v])
def test_a_fold_back_is_no_contact(turn):
    # The same parabola twice: the second lies on the first instead of continuing it.
    contact = measure_contact(Base(parabola(2.0), "u0"), Base(turn(parabola(2.0)), "u0"))
    assert contact.angle_degrees == pytest.approx(180)
    assert contact.gap < 1e-15


def test_regularity_sees_a_fold():
    flat = parabola(0.0)
    assert measure_regularity(flat).largest_turn_degrees == 0
    assert measure_regularity(flat).proved_area_ratio == pytest.approx(1)
    net = [[[u, v, 0.0] for v in (0, 1)] for u in (0, 1, 0.2)]
    folded = measure_regularity(BSplineSurface(2, 1, BEZIER_2, BEZIER_1, net))
    assert folded.largest_turn_degrees > 90
    assert folded.proved_area_ratio is None


@pytest.mark.parametrize("seed", range(8))
def test_a_proved_bound_is_below_every_sample(seed):
    surface = blend(*facing_pair(np.random.default_rng(seed), planar=seed == 0), alpha="natural").surface
    bound = area_bound(surface)
    u, v = (np.linspace(*ends, 41) for ends in surface.domain)
    cross = np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
    assert bound <= np.linalg.norm(cross, axis=2).min() * (1 + 1e-12)
    if seed == 0:
        assert bound > 0


def test_the_bound_is_exact_for_a_bilinear_patch():
    # X = (u (1 + v), v, 0): P_u x P_v = (0, 0, 1 + v), least 1 and linear.
    net = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [2, 1, 0]]]
    assert area_bound(BSplineSurface(1, 1, BEZIER_1, BEZIER_1, net)) == pytest.approx(1, rel=1e-14)
