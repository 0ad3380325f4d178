"""Measures: known answers, and the route for formulas against the referee's for splines."""

from __future__ import annotations

import numpy as np
import pytest

from helpers.papers_set import blend
from semispline import Base, BSplineCurve, BSplineSurface, measure_contact
from semispline.papers.baselines.contacts import contact_sides
from semispline.papers.baselines.interface import BlendTask, FormulaSurface, Outcome
from semispline.papers.lin2014.examples.section5 import example
from semispline.papers.reproduction.contact_measures import (
    contact_measure,
    corresponding,
    measured_by_formula,
    oriented_turn,
    seam_measure,
    turn_between,
)
from semispline.papers.reproduction.measures import (
    bending_and_area,
    mean_curvature_range,
    measure,
    plate_energy,
    settled_fairness,
)
from semispline.solver.splines.construction import plane
from semispline.solver.splines.operations import reverse_u
from semispline.solver.splines.revolution import revolve


def as_formula(surface):
    """The same surface without anything that tells it is a spline."""
    u, v = surface.breakpoints
    return FormulaSurface(surface.evaluate, u, v)


@pytest.fixture(scope="module")
def curved():
    task = example(6)
    return task, contact_sides(task), blend(task.a, task.b, continuity="G1", middle_curves=1).surface


@pytest.mark.parametrize("end", [0, 1])
def test_formulas_are_measured_as_the_referee_measures_splines(curved, end):
    _, sides, surface = curved
    judged = contact_measure(sides[end], surface, end)
    v, _ = corresponding(sides[end], as_formula(surface), end)
    # The referee looks between samples, too.
    ends = Base(sides[end].surface, "u0"), Base(surface, "u1" if end else "u0")
    v = np.append(v, measure_contact(*ends, flip="no").curvature_at.parameter)
    found = measured_by_formula(sides[end], as_formula(surface), end, v, v, 0.0)
    # A G1 blend: the jump is what there is to compare.
    assert judged.curvature_jump_relative > 0.1
    np.testing.assert_allclose(found.curvature_jump, judged.curvature_jump, rtol=1e-9)
    np.testing.assert_allclose(found.curvature_jump_relative, judged.curvature_jump_relative, rtol=1e-6)
    assert found.gap < 1e-12
    assert found.angle_degrees < 1e-9


@pytest.mark.parametrize(("end", "turn"), [(2.0, 0.0), (0.0, 180.0), ((1.0, 1.0), 90.0)])
@pytest.mark.parametrize("flipped", [False, True])
def test_a_strip_that_goes_on_turns_off_or_runs_back(end, turn, flipped):
    """From (0, y, 0) to (1, y, 0), then on to x = 2, back to 0, or straight up; v of the second may run backwards."""
    x, z = end if isinstance(end, tuple) else (end, 0.0)
    ys = (1.0, 0.0) if flipped else (0.0, 1.0)
    knots = [0, 0, 1, 1]
    first = BSplineSurface(1, 1, knots, knots, [[[i, y, 0.0] for y in (0.0, 1.0)] for i in (0.0, 1.0)])
    second = BSplineSurface(
        1, 1, knots, knots, [[[*p, q] for p, q in (((a, y), c) for y in ys)] for a, c in ((1.0, 0.0), (x, z))]
    )
    found = turn_between(Base(first, "u1"), Base(second, "u0"), flipped=flipped)
    np.testing.assert_allclose(found, turn, atol=1e-12)


def test_energy_of_formulas_is_that_of_splines(curved):
    surface = curved[2]
    np.testing.assert_allclose(plate_energy(as_formula(surface)), plate_energy(surface), rtol=1e-12)


def test_fairness_of_formulas_is_that_of_splines(curved):
    surface = curved[2]
    np.testing.assert_allclose(settled_fairness(as_formula(surface)), settled_fairness(surface), rtol=1e-9)


def test_known_fairness():
    def torus(u, v, du, dv):
        def wave(x, order):
            return np.cos(x + order * np.pi / 2)

        # A tube of radius 1 round a circle of radius 3, u along the circle and v round the tube.
        tube = wave(v, dv) + (3 if dv == 0 else 0)
        return np.stack(
            [wave(u, du) * tube, wave(u - np.pi / 2, du) * tube, (du == 0) * wave(v - np.pi / 2, dv) + 0 * u], 1
        )

    half = FormulaSurface(torus, np.array([0.0, 1.0]), np.array([0.0, np.pi]))
    # H = (3 + 2 cos v) / (2 (3 + cos v)), dH/dv = -3 sin v / (2 (3 + cos v)^2), dA = (3 + cos v) du dv.
    x, w = np.polynomial.legendre.leggauss(60)
    v = np.pi / 2 * (1 + x)
    integral = np.pi / 2 * float(w @ (9 * np.sin(v) ** 2 / (4 * (3 + np.cos(v)) ** 3)))
    np.testing.assert_allclose(settled_fairness(half), 3 * np.pi * integral, rtol=1e-6)


def test_fairness_of_a_fold_is_not_told():
    # A strip that runs to x = 1 and back: a hairpin turns by more than 90 degrees within its window.
    def strip(height):
        net = [[[x, y, z] for y in (0, 1)] for x, z in ((0, 0), (1, 0), (1, height), (0, height))]
        return BSplineSurface(3, 1, [0] * 4 + [1] * 4, [0, 0, 1, 1], net)

    for height, folds in ((0.1, True), (0.3, False)):
        found = measure(planes_task(), outcome(strip(height)))
        assert (found.turn_degrees > 90) == folds
        # It could be told.
        assert settled_fairness(strip(height)) > 1e3
        assert (found.fairness is None) == folds


def test_known_energy():
    # x = u^2, y = u v, z = v^2: second derivatives 2, 1, 2, so (11) is 4 + 2 * 1 + 4.
    surface = FormulaSurface(
        lambda u, v, du, dv: {
            (0, 0): np.stack([u**2, u * v, v**2], 1),
            (1, 0): np.stack([2 * u, v, 0 * u], 1),
            (0, 1): np.stack([0 * u, u, 2 * v], 1),
            (2, 0): np.stack([2 + 0 * u, 0 * u, 0 * u], 1),
            (1, 1): np.stack([0 * u, 1 + 0 * u, 0 * u], 1),
            (0, 2): np.stack([0 * u, 0 * u, 2 + 0 * u], 1),
        }[du, dv],
        np.array([0.0, 1]),
        np.array([0.0, 1]),
    )
    np.testing.assert_allclose(plate_energy(surface), 10.0, rtol=1e-14)


def test_bending_of_a_cylinder_and_of_a_sphere():
    line = BSplineCurve(1, [0, 0, 1, 1], [[2, 0, 0], [2, 0, 5]])
    cylinder = revolve(line, [0, 0, 0], [0, 0, 1], 90)
    bending, area = bending_and_area(cylinder)
    np.testing.assert_allclose(area, 5 * np.pi, rtol=1e-10)
    np.testing.assert_allclose(bending, area / 4, rtol=1e-10)
    np.testing.assert_allclose(mean_curvature_range(cylinder), (0.25, 0.25), rtol=1e-12)

    def sphere(u, v, du, dv):
        def wave(x, order):
            return np.cos(x + order * np.pi / 2)

        # Radius 3, u the latitude and v the longitude.
        return 3 * np.stack(
            [wave(u, du) * wave(v, dv), wave(u, du) * wave(v - np.pi / 2, dv), wave(u - np.pi / 2, du) * (dv == 0)], 1
        )

    zone = FormulaSurface(sphere, np.array([-0.5, 0.7]), np.array([0.0, 1.5]))
    bending, area = bending_and_area(zone)
    np.testing.assert_allclose(area, 9 * 1.5 * (np.sin(0.7) + np.sin(0.5)), rtol=1e-10)
    np.testing.assert_allclose(bending, 2 * area / 9, rtol=1e-10)
    np.testing.assert_allclose(mean_curvature_range(zone), (1 / 3, 1 / 3), rtol=1e-12)


def test_an_integral_that_does_not_settle_has_no_value():
    # A cone down to its apex: k^2 dA is dr / r.
    line = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [1, 0, 1]])
    bending, area = bending_and_area(revolve(line, [0, 0, 0], [0, 0, 1], 90))
    assert bending is None
    np.testing.assert_allclose(area, np.pi * np.sqrt(2) / 4, rtol=1e-9)


def planes_task():
    first = plane([0, 0, 0], [-1, 0, 0], [0, 1, 0], 3, 3)
    second = plane([1, 0, 0], [1, 0, 0], [0, 1, 0], 3, 3)
    return BlendTask("planes", "planes", Base(first, "u0"), Base(second, "u0"))


def outcome(surface):
    return Outcome(surface, surface.n_control_points, None, 0.0)


def test_a_flat_blend_between_flat_bases_measures_zero():
    found = measure(planes_task(), outcome(plane([0, 0, 0], [1, 0, 0], [0, 1, 0], 3, 3)))
    assert max(found.gap, found.angle_degrees, found.curvature_jump_relative) < 1e-12
    assert found.energy < 1e-20
    assert found.bending == pytest.approx(0, abs=1e-20)
    assert found.area == pytest.approx(1)
    assert not found.folds


def test_gap_angle_and_turn_are_told_apart():
    task = planes_task()
    # Lifted by 0.1 and sloping by 45 degrees at a; the same at b.
    sloping = plane([0, 0, 0.1], [1, 0, 1], [0, 1, 0], 3, 3)
    found = measure(task, outcome(sloping)).contact_a
    np.testing.assert_allclose([found.gap, found.angle_degrees, found.turn_degrees], [0.1, 45, 45], rtol=1e-12)
    # Runs back over the base: one tangent plane, but a fold.
    back = plane([0, 0, 0], [-1, 0, 0], [0, 1, 0], 3, 3)
    found = measure(task, outcome(back))
    np.testing.assert_allclose([found.contact_a.angle_degrees, found.contact_a.turn_degrees], [0, 180], atol=1e-9)
    assert found.folds
    sides = contact_sides(task)
    v, w = corresponding(sides[1], reverse_u(back), 1)
    np.testing.assert_allclose(oriented_turn(sides[1], reverse_u(back), 1, v, w), 0.0, atol=1e-12)


@pytest.mark.long
def test_other_parameters_along_the_contact_need_the_closest_point(curved):
    task, sides, _ = curved
    surface = blend(task.a, task.b, continuity="G2", middle_curves=1).surface

    def other(u, v, du, dv):
        # v is replaced by w = v + v (1 - v) / 2, which runs over the same interval.
        w, w1, w2 = v + v * (1 - v) / 2, 1.5 - v, -1.0
        if dv == 0:
            return surface.evaluate(u, w, du, 0)
        if dv == 1:
            return surface.evaluate(u, w, du, 1) * w1[:, None]
        return surface.evaluate(u, w, du, 2) * w1[:, None] ** 2 + w2 * surface.evaluate(u, w, du, 1)

    moved = FormulaSurface(other, *surface.breakpoints)
    for end in (0, 1):
        found = contact_measure(sides[end], moved, end, aligned=False)
        assert found.gap < 1e-10
        assert found.angle_degrees < 1e-6
        assert found.curvature_jump_relative < 1e-6
        assert contact_measure(sides[end], moved, end, aligned=True).gap > 1


def test_seams_are_measured():
    points = np.array([[1, 0, 0], [2, 1, 0], [-1, 2, 0], [-1, -2, 0], [2, -1, 0], [1, 0, 0]], dtype=float)
    knots = [0, 0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1, 1]
    net = np.stack([points + np.array([0, 0, z]) for z in (0, 1, 2, 3)])
    kinked = BSplineSurface(3, 3, [0, 0, 0, 0, 1, 1, 1, 1], knots, net)
    found = seam_measure(kinked)
    # Tangents at the seam run along (1, 1) and (-1, 1): normals meet at 90 degrees.
    np.testing.assert_allclose(found.angle_degrees, 90, rtol=1e-9)
    assert found.gap < 1e-12
    net[:, -1] += [0.25, 0, 0]
    np.testing.assert_allclose(seam_measure(BSplineSurface(3, 3, kinked.knots_u, knots, net)).gap, 0.25)
