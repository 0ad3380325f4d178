"""Bands along free curves of faces of every kind, judged by the referee and by Open CASCADE on its own surfaces."""

import numpy as np
import pytest

from helpers.free_curves import (
    ELEMENTARY,
    cubic,
    cylinder,
    ellipse_on_cylinder,
    free_form,
    in_space,
    line,
    loop,
    open_curve,
    seen_by_open_cascade,
    sphere,
    torus,
)
from helpers.sweeps import first_ones
from semispline import Base, blend, iso_curve, plane, transform
from semispline.solver.judge import measure_creases, measure_face_contact
from semispline.solver.topology.bands import band_along

# Points between those that the search looked at; what it accepts is 0.92 of a limit at 30 points a span.
LIMITS = {"angle_degrees": 0.01, "curvature": 0.02}


def bands_of(face, curve, **options):
    return band_along(face, None, edge=curve, **options) if in_space(curve) else band_along(face, curve, **options)


def check_on_face(band, face, order=2):
    """The referee sees what the band says of itself, within the limits."""
    seen = measure_face_contact(band.base, face, order=order, same_side=True)
    size = np.ptp(face.control_points.reshape(-1, 3), axis=0).max()
    # Neither looks at all points: a tenth of what was found, and rounding of coordinates of this size.
    assert seen.gap == pytest.approx(band.gap, rel=0.1, abs=1e-13 * size)
    assert seen.angle_degrees == pytest.approx(band.angle_degrees, rel=0.1, abs=1e-9)
    assert seen.curvature_jump_relative == pytest.approx(band.curvature, rel=0.1, abs=1e-6)
    assert band.off <= 1e-5 * band.length
    assert seen.gap <= 1e-5 * band.length
    assert seen.angle_degrees <= 0.01
    assert seen.curvature_jump_relative <= 0.02
    return seen


@pytest.mark.parametrize("kind", first_ones(1, ELEMENTARY))
def test_all_limits_are_met_on_elementary_faces(kind):
    face, geometry, curve = ELEMENTARY[kind]
    (band,) = bands_of(face, curve)
    check_on_face(band, face)
    seen = seen_by_open_cascade(band.surface, geometry)
    # At the same 97 places the referee and the kernel find less than the worst.
    assert 0.5 * band.gap - 1e-12 <= seen.gap <= 1.05 * band.gap + 1e-12
    assert seen.angle_degrees <= 1.05 * band.angle_degrees + 1e-7
    assert seen.curvature <= 1.05 * band.curvature + 1e-6
    assert band.points <= 50
    assert (
        max(
            np.unique(band.surface.knots_v[band.surface.degree_v + 1 : -band.surface.degree_v - 1], return_counts=True)[
                1
            ],
            default=1,
        )
        == 1
    )


def test_a_band_of_a_plane_is_exact():
    face = transform(
        plane([0, 0, 0], [10, 0, 0], [0, 10, 0]), np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    )
    (band,) = band_along(face, loop(np.random.default_rng(2)))
    assert band.is_plane
    seen = measure_face_contact(band.base, face, same_side=True)
    # The limits of natural edges; a curve on it is what is approximate.
    assert seen.gap <= 1e-11 * 10
    assert seen.angle_degrees <= 1e-9
    # Over the floor 1e-3 / size; with what some roundings of coordinates of 10 are in second derivatives along.
    narrow = np.diff(band.surface.breakpoints[1]).min()
    rounding = 8 * np.finfo(float).eps * 10 * (2 * band.surface.degree_v / narrow) ** 2 / (1e-3 / 10)
    assert seen.curvature_jump_relative <= 1e-9 + rounding
    assert rounding < 1e-6
    assert 0 < band.off <= 1e-5 * band.length


def test_a_parallel_of_a_cylinder_has_rows_in_closed_form():
    (band,) = band_along(cylinder(10.0, -20.0, 20.0), line((0, 0.5), (1, 0.5)))
    v = np.linspace(0, band.length, 40)
    assert band.length == pytest.approx(20 * np.pi, rel=1e-9)
    width = band.surface.domain[0][1]
    assert width == pytest.approx(band.length / 10, rel=1e-12)
    rows = [band.surface.evaluate(np.zeros(40), v, k, 0) for k in range(3)]
    angle = v / 10
    round_ = np.stack([np.cos(angle), np.sin(angle), 0 * v], axis=1)
    assert np.abs(rows[0] - 10 * round_).max() <= 1e-5 * band.length
    # S_s runs round, S_t up, and what is left of the curve is above it: D = (0, 0, 1); the section is a ruling.
    assert np.abs(rows[1] - [0, 0, 1]).max() <= np.radians(0.01)
    assert np.abs(rows[2]).max() <= 0.02 * 1e-3 / 40


def test_a_sphere_bends_across_as_it_does_along():
    (band,) = bands_of(sphere(10.0), ELEMENTARY["sphere"][2])
    v = np.linspace(0, band.length, 60)
    rows = [band.surface.evaluate(np.zeros(60), v, k, 0) for k in range(3)]
    outwards = rows[0] / 10
    assert np.abs(np.sum(rows[2] * outwards, axis=1) + 0.1).max() <= 0.02 * 0.1
    assert np.abs(np.linalg.norm(rows[1], axis=1) - 1).max() <= 0.02


@pytest.mark.parametrize("keep", ["left", "right"])
@pytest.mark.parametrize("kind", [kind for kind in ELEMENTARY if not in_space(ELEMENTARY[kind][2])])
def test_the_direction_leads_into_the_part_that_is_kept(kind, keep):
    """By points of the face beside the curve, in its parameters: contact figures cannot see a reversed direction."""
    face, _, curve = ELEMENTARY[kind]
    (band,) = band_along(face, curve, keep)
    t = np.linspace(0.03, 0.97, 25)
    at, slope = curve.evaluate(t)[:, :2], curve.evaluate(t, 1)[:, :2]
    left = np.stack([-slope[:, 1], slope[:, 0]], axis=1) * (1 if keep == "left" else -1)
    beside = at + 1e-4 * left / np.linalg.norm(left, axis=1)[:, None]
    inside = face.evaluate(*beside.T) - face.evaluate(*at.T)
    points = band.surface.evaluate(np.zeros(4001), np.linspace(*band.surface.domain[1], 4001))
    nearest = np.linalg.norm(points[:, None] - face.evaluate(*at.T), axis=2).argmin(axis=0)
    v = np.linspace(*band.surface.domain[1], 4001)[nearest]
    assert (np.sum(band.surface.evaluate(np.zeros(25), v, 1, 0) * inside, axis=1) > 0).all()


@pytest.mark.long
def test_a_closed_curve_makes_a_smooth_rim():
    for seed in range(3):
        rng = np.random.default_rng(seed)
        (band,) = band_along(free_form(rng), loop(rng))
        degree = band.surface.degree_v
        for i in range(3):
            row = band.surface.control_points[i]
            assert (row[0] == row[-1]).all()
        # All derivatives below the degree go on over the seam; each order costs some h / L of digits.
        ends = [band.surface.evaluate(np.zeros(2), np.array(band.surface.domain[1]), 0, k) for k in range(degree)]
        narrow = np.diff(band.surface.breakpoints[1]).min()
        for k, (start, end) in enumerate(ends):
            assert np.abs(start - end).max() <= 1e-11 * (degree / narrow) ** k * 10


@pytest.mark.parametrize("seed", first_ones(4, range(20)))
@pytest.mark.parametrize("curve", [open_curve, loop])
def test_all_limits_are_met_on_random_free_forms(curve, seed):
    rng = np.random.default_rng(seed)
    face = free_form(rng, (3, 5)[seed % 2], int(rng.integers(6, 10)))
    (band,) = band_along(face, curve(rng), ("left", "right")[seed % 2])
    check_on_face(band, face)
    seen = seen_by_open_cascade(band.surface, face, 41)
    assert seen.gap <= 1.05 * band.gap + 1e-12
    assert seen.angle_degrees <= 0.01
    assert seen.curvature <= 0.02


@pytest.mark.long
def test_a_blend_to_a_band_has_the_error_of_the_band_and_no_crease():
    face = free_form(np.random.default_rng(5), 3, 8)
    (band,) = band_along(face, cubic((0.2, 0.45), (0.4, 0.3), (0.6, 0.6), (0.8, 0.5)))
    other = transform(plane([1, 12, 6], [9, 0, 0], [0, 6, 1]), np.eye(3))
    result = blend(band.base, Base(other, "v0"))
    seen = measure_face_contact(Base(result.surface, "u0"), face)
    of_band = measure_face_contact(band.base, face, same_side=True)
    # Contact with the band is exact; some roundings of coordinates of size 10 are between.
    assert seen.gap == pytest.approx(of_band.gap, abs=1e-11)
    assert seen.angle_degrees == pytest.approx(of_band.angle_degrees, abs=1e-8)
    assert seen.curvature_jump_relative == pytest.approx(of_band.curvature_jump_relative, abs=1e-8)
    kernel = seen_by_open_cascade(result.surface.to_bspline(), face)
    assert kernel.gap <= 1.05 * band.gap
    assert kernel.angle_degrees <= 0.01
    assert kernel.curvature <= 0.02
    assert all(crease.angle_degrees < 2e-4 for crease in measure_creases(result.surface))


@pytest.mark.long
def test_a_g3_blend_to_a_band_has_its_rate_on_the_true_face():
    face = free_form(np.random.default_rng(5), 5, 6)
    (band,) = band_along(face, cubic((0.2, 0.45), (0.4, 0.3), (0.6, 0.6), (0.8, 0.5)), continuity="G3")
    result = blend(band.base, Base(plane([1, 12, 6], [9, 0, 0], [0, 6, 1]), "v0"), continuity="G3")
    seen = measure_face_contact(Base(result.surface, "u0"), face, order=3)
    assert seen.rate_jump_relative <= 0.1
    # Contact of the blend with the band is exact, and rates are known to some 1e-8 of themselves.
    of_band = measure_face_contact(band.base, face, order=3, same_side=True)
    assert seen.rate_jump_relative == pytest.approx(of_band.rate_jump_relative, abs=1e-5)


def test_a_band_along_a_natural_edge_meets_its_jets():
    face = free_form(np.random.default_rng(7), 5, 6)
    (band,) = band_along(face, line((0, 0), (0, 1)), "right")
    seen = check_on_face(band, face)
    assert seen.length == pytest.approx(band.length, rel=1e-4)
    edge = iso_curve(face, u=0.0)
    v = np.linspace(0, 1, 30)
    points = band.surface.evaluate(np.zeros(2001), np.linspace(0, band.length, 2001))
    assert np.linalg.norm(points[:, None] - edge.evaluate(v), axis=2).min(axis=0).max() <= 1e-3 * band.length


@pytest.mark.long
def test_rates_are_followed_where_the_face_has_them():
    rng = np.random.default_rng(3)
    face = free_form(rng, 5, 6)
    (band,) = band_along(face, cubic((0.2, 0.2), (0.4, 0.7), (0.6, 0.2), (0.85, 0.8)), continuity="G4")
    seen = measure_face_contact(band.base, face, order=4, same_side=True)
    assert band.rates[0] <= 0.1
    assert band.rates[1] <= 0.1
    assert seen.rate_jump_relative == pytest.approx(band.rates[0], rel=0.2)
    assert seen.second_rate_jump_relative <= 0.1
    (band,) = band_along(torus(), ELEMENTARY["torus"][2], continuity="G3")
    seen = measure_face_contact(band.base, torus(), order=3, same_side=True)
    # The research text has 1 % on a torus.
    assert seen.rate_jump_relative <= 0.01


@pytest.mark.long
def test_the_feet_of_an_edge_near_the_face_are_taken_and_a_pcurve_of_an_edge_that_is_not():
    face, ellipse = cylinder(), ellipse_on_cylinder()
    moved = transform_curve(ellipse, 1.0 + 1e-5)
    (band,) = band_along(face, None, edge=moved, tolerance=2e-4)
    assert band.source == "foot"
    assert band.edge_to_face == pytest.approx(1e-4, rel=1e-3)
    assert band.edge_to_pcurve is None
    assert band.gap <= 1e-5 * band.length
    pcurve = line((0.1, 0.3), (0.6, 0.7))
    far = plane_curve(face, pcurve, 0.05)
    (band,) = band_along(face, pcurve, edge=far, tolerance=0.01)
    assert band.source == "pcurve"
    assert band.edge_to_face == pytest.approx(0.05, rel=1e-2)
    assert band.edge_to_pcurve == pytest.approx(0.05, rel=1e-2)


def transform_curve(curve, factor):
    from dataclasses import replace

    return replace(curve, control_points=curve.control_points * np.array([factor, factor, 1.0]))


def plane_curve(face, pcurve, height):
    """A curve at a height over a cylinder about the z-axis, by interpolation."""
    from semispline import interpolate_curve

    t = np.linspace(0, 1, 101)
    points = face.evaluate(*pcurve.evaluate(t)[:, :2].T)
    away = points * [1, 1, 0]
    return interpolate_curve(points + height * away / np.linalg.norm(away, axis=1)[:, None], 5, t)
