"""Controls that must fail, where a curve is cut, and what is said where no band meets its limits."""

from dataclasses import replace
from itertools import pairwise
from math import comb

import numpy as np
import pytest

from helpers.free_curves import (
    WAVE,
    bent_face,
    cone,
    cubic,
    cylinder,
    ellipse_on_cylinder,
    free_form,
    line,
    loop,
    sphere,
)
from semispline import (
    BandError,
    Base,
    BSplineCurve,
    BSplineSurface,
    EdgeError,
    OptionError,
    blend,
    interpolate_curve,
    plane,
    reverse_curve,
)
from semispline.solver.judge import measure_creases, measure_face_contact
from semispline.solver.topology import curve_pieces
from semispline.solver.topology.band_measures import measured
from semispline.solver.topology.band_search import band_limits, fit_band
from semispline.solver.topology.bands import band_along
from semispline.solver.topology.curve_pieces import pieces
from semispline.solver.topology.face_curves import curve_on_face, edge_on_face
from semispline.solver.topology.face_jets import Face

ACROSS = cubic((-0.8, 0.2), (-0.3, 0.8), (0.3, 0.3), (0.8, 0.7))


def piece_of(face, curve, sign=1.0, away=1e-6):
    (piece,), _ = pieces(curve_on_face(Face(face), curve), sign, away)
    return piece


def test_a_band_without_its_second_row_misses_the_curvature_across():
    face = free_form(np.random.default_rng(1), 5, 6)
    (band,) = band_along(face, WAVE)
    points = np.array(band.surface.control_points)
    points[2] = 2 * points[1] - points[0]
    flat = replace(band.surface, control_points=points)
    seen = measure_face_contact(Base(flat, "u0"), face, same_side=True)
    assert seen.angle_degrees <= 0.01
    assert seen.curvature_jump_relative > 0.9


@pytest.mark.long
def test_a_reversed_direction_is_seen_by_no_figure_of_contact():
    """Why the direction has a test of its own."""
    face = free_form(np.random.default_rng(1), 5, 6)
    (left,), (right,) = band_along(face, WAVE, "left"), band_along(face, WAVE, "right")
    for band in (left, right):
        seen = measure_face_contact(band.base, face, same_side=True)
        assert seen.curvature_jump_relative <= 0.02
    v = np.linspace(0, left.length, 20)
    one, other = (b.surface.evaluate(np.zeros(20), v, 1, 0) for b in (left, right))
    assert (np.sum(one * other, axis=1) < -0.9).all()


def test_a_jump_of_curvature_is_where_the_curve_is_cut():
    bands = band_along(bent_face(0.3), ACROSS)
    assert len(bands) == 2
    first, second = bands
    assert (first.cut_at_start, second.cut_at_end) == ("", "")
    assert first.cut_at_end == second.cut_at_start
    # 0.3 of 1/10, over the largest, 1.3 / 10, about.
    assert "the face's curvature jumps by 2" in first.cut_at_end
    assert first.range[1] == second.range[0]
    assert ACROSS.evaluate([first.range[1]])[0, 0] == pytest.approx(0.0, abs=1e-12)
    for band in bands:
        seen = measure_face_contact(band.base, bent_face(0.3), same_side=True)
        # Both ends lie on the line, and the referee looks from within the domain.
        assert seen.angle_degrees <= 0.01


@pytest.mark.parametrize(("jump", "count"), [(0.008, 1), (0.014, 2)])
def test_the_limit_of_a_jump_from_both_sides(jump, count):
    assert len(band_along(bent_face(jump), ACROSS)) == count


@pytest.mark.long
def test_one_band_over_a_jump_misses_its_limits(monkeypatch):
    monkeypatch.setattr(curve_pieces, "JUMP", np.inf)
    with pytest.raises(BandError, match=r"the face's curvature jumps by 2\d %.*split the edge at 0\.\d+"):
        band_along(bent_face(0.3), ACROSS)


def test_a_position_tolerance_alone_is_not_enough():
    curve = edge_on_face(Face(cylinder()), ellipse_on_cylinder(), None, 0.0)
    (piece,), _ = pieces(curve, 1.0, 1e-6)
    loose = replace(band_limits(piece.length, 0.0, None), angle_degrees=90.0, curvature=1e3)
    fit = fit_band(piece, loose, 2, 3)
    assert fit.is_good
    assert fit.largest("gap") <= 1e-5 * piece.length
    # The research text has 0.022 degree for these.
    assert fit.largest("angle_degrees") > 0.01


@pytest.mark.long
def test_a_curve_into_a_pole_keeps_away_from_it():
    curve = cubic((0.1, 0.2), (0.15, 0.5), (0.2, 0.8), (0.25, 1.0))
    for run in (curve, reverse_curve(curve)):
        (band,) = band_along(sphere(), run)
        assert 0 < band.left_out < 1e-4 * band.length
        assert measure_face_contact(band.base, sphere(), same_side=True).angle_degrees <= 0.01
    with pytest.raises(BandError, match="no proper normal at the end"):
        # Without keeping away.
        band_error_along(sphere(), curve)


def band_error_along(face, curve):
    from semispline.solver.topology.band_refusals import refusal

    piece = piece_of(face, curve, away=0.0)
    fit = fit_band(replace(piece, left_out=1e-300), band_limits(piece.length, 0.0, None), 2)
    if not fit.is_good:
        raise BandError(refusal(fit, "the curve", np.zeros(3), 0.0))


@pytest.mark.long
def test_a_curve_into_the_tip_of_a_cone_is_refused():
    with pytest.raises(BandError, match="edge e7: the face has no normal at the end of it"):
        band_along(cone(), cubic((0.1, 0.5), (0.15, 0.4), (0.2, 0.1), (0.25, 0.0)), name="edge e7")


@pytest.mark.parametrize(("degrees", "count"), [(4.0, 1), (6.0, 2)])
def test_a_corner_is_where_the_curve_is_cut(degrees, count):
    turn = np.radians(degrees)
    corner = line((0.1, 0.5), (0.5, 0.5), (0.5 + 0.4 * np.cos(turn), 0.5 + 0.4 * np.sin(turn)))
    flat = plane([0, 0, 0], [6, 0, 0], [0, 6, 0])
    bands = band_along(flat, corner)
    assert len(bands) == count
    if count == 2:
        assert "a corner of" in bands[0].cut_at_end


@pytest.mark.long
def test_a_corner_in_one_band_misses_its_limits(monkeypatch):
    monkeypatch.setattr(curve_pieces, "CORNER_DEGREES", 90.0)
    face = free_form(np.random.default_rng(1), 5, 6)
    turn = np.radians(30.0)
    corner = BSplineCurve(2, [0, 0, 0, 0.5, 0.5, 1, 1, 1], [
        (0.1, 0.5), (0.3, 0.5), (0.5, 0.5), (0.5 + 0.2 * np.cos(turn), 0.5 + 0.2 * np.sin(turn)),
        (0.5 + 0.4 * np.cos(turn), 0.5 + 0.4 * np.sin(turn)),
    ])  # fmt: skip
    with pytest.raises(BandError, match=r"the curve has a corner of 30 degrees there; split it at 0\.5"):
        band_along(face, corner)


def test_a_square_is_four_pieces_and_its_corner_at_the_seam_counts():
    square = line((0.3, 0.3), (0.6, 0.3), (0.6, 0.6), (0.3, 0.6), (0.3, 0.3))
    bands = band_along(cylinder(), square)
    assert [b.cut_at_start for b in bands] == ["a corner of 90 degrees"] * 4
    assert [b.cut_at_end for b in bands] == ["a corner of 90 degrees"] * 4


def test_a_kink_inside_a_closed_curve_does_not_cut_it_at_its_seam():
    """Two halves, cut at two corners: the piece that runs over the seam is one."""
    to_the_right, back, rest = np.linspace(0.5, 0.8, 16), np.linspace(0.8, 0.2, 31), np.linspace(0.2, 0.5, 16)
    x = np.concatenate([to_the_right, back[1:], rest[1:]])
    height = 0.15 * (1 - ((x - 0.5) / 0.3) ** 2)
    y = 0.5 + np.where((np.arange(len(x)) > 15) & (np.arange(len(x)) < 45), height, -height)
    t = np.linspace(0, 1, len(x))
    around = BSplineCurve(1, np.concatenate([[0], t, [1]]), np.stack([x, y], axis=1))
    flat = plane([0, 0, 0], [6, 0, 0], [0, 6, 0])
    bands = band_along(flat, around, tolerance=0.02)
    assert len(bands) == 2
    assert sum(b.range[1] > 1 for b in bands) == 1


@pytest.mark.parametrize("pieces_", [32, 128])
@pytest.mark.parametrize("closed", [False, True])
def test_polylines_are_made_smooth_first(pieces_, closed):
    face = free_form(np.random.default_rng(1), 5, 6)
    x = np.linspace(0, 1, pieces_ + 1)
    smooth = loop(np.random.default_rng(1)) if closed else WAVE
    polyline = BSplineCurve(1, np.concatenate([[0], x, [1]]), smooth.evaluate(x)[:, :2])
    (band,) = band_along(face, polyline)
    (direct,) = band_along(face, smooth)
    # The sagitta of so many chords, of a length of 10 to 17 and turns of some 2 pi in all.
    assert 0 < band.smoothed_by <= 4 * band.length / pieces_**2
    assert band.points <= 1.5 * direct.points


@pytest.mark.long
def test_noise_within_the_tolerance_is_made_smooth():
    rng = np.random.default_rng(3)
    face = free_form(rng, 5, 6)
    noisy = WAVE.evaluate(np.linspace(0, 1, 120))[:, :2] + 2e-4 * rng.normal(size=(120, 2))
    curve = interpolate_curve(noisy)
    (band,) = band_along(face, curve, tolerance=1e-2)
    assert band.gap <= 1e-5 * band.length
    assert band.angle_degrees <= 0.01
    assert 0 < band.smoothed_by + band.off <= 2e-2
    with pytest.raises(BandError, match=r"band of \d+ points reaches .*limit.* at \("):
        band_along(face, curve)


@pytest.mark.long
def test_a_rate_that_jumps_refuses_g3():
    face = free_form(np.random.default_rng(2), 3, 8, 0.5)
    band_along(face, WAVE)
    with pytest.raises(
        BandError, match=r"% of the rate of curvature \(limit 10\).*rate of curvature jumps by .*ask for G2"
    ):
        band_along(face, WAVE, continuity="G3")


@pytest.mark.long
def test_rows_that_copy_the_face_where_it_is_only_c2_crease_the_blend():
    """Exact composition has multiple knots at crossings; a smooth band over the same curve has none, and no crease."""
    face = free_form(np.random.default_rng(6), 3, 7)
    curve = line((0.3, 0.2), (0.62, 0.8))
    (band,) = band_along(face, curve)
    other = Base(plane([12, 0, 5], [3, 0, 1], [2, 9, 0]), "u0")
    smooth = blend(band.base, other)
    assert max((c.angle_degrees for c in measure_creases(smooth.surface)), default=0.0) < 2e-4
    copied = blend(Base(copied_band(face, curve), "u0"), other)
    assert max(c.angle_degrees for c in measure_creases(copied.surface)) > 0.005


def copied_band(face, curve):
    """The band with the same rows, each span between knot lines of the face exact: knots of full multiplicity."""
    crossings = sorted({
        float((k - curve.control_points[0, d]) / (curve.control_points[1, d] - curve.control_points[0, d]))
        for d in range(2) for k in face.breakpoints[d][1:-1]
    })  # fmt: skip
    cuts = [0.0, *(x for x in crossings if 0 < x < 1), 1.0]
    whole = piece_of(face, curve)
    degree, points, knots, start = 9, [], [], 0.0
    for a, b in pairwise(cuts):
        part = curve_pieces.CurvePiece(whole.curve, a, b, False, 1.0)
        x = part.length * (0.5 - 0.5 * np.cos(np.pi * np.arange(degree + 1) / degree))
        jet = part.sections(x, 2)
        rows = np.stack([jet.point, jet.into, jet.heights[0][:, None] * jet.normal], axis=1)
        z = x / part.length
        basis = np.stack([comb(degree, j) * z**j * (1 - z) ** (degree - j) for j in range(degree + 1)], axis=1)
        found = np.linalg.solve(basis, rows.reshape(degree + 1, -1)).reshape(degree + 1, 3, 3)
        points.append(found if not points else found[1:])
        knots.append(start)
        start += part.length
    rows = np.concatenate(points).transpose(1, 0, 2)
    inner = np.repeat(knots[1:], degree)
    v = np.concatenate([np.zeros(degree + 1), inner, np.full(degree + 1, start)])
    width = start / 10
    net = np.stack([rows[0], rows[0] + width / 2 * rows[1], rows[0] + width * rows[1] + width**2 / 2 * rows[2]])
    return BSplineSurface(2, degree, np.repeat([0.0, width], 3), v, net)


def test_what_is_no_curve_on_the_face_is_refused():
    face = cylinder()
    with pytest.raises(EdgeError, match=r"found \(s, t\) = \(.*, 1\.2\), expected a point in"):
        band_along(face, line((0.2, 0.5), (0.4, 1.2)))
    with pytest.raises(EdgeError, match="one point of the face"):
        band_along(sphere(), line((0.2, 1.0), (0.4, 1.0)))
    with pytest.raises(EdgeError, match="it is not an edge of it"):
        band_along(face, None, edge=line([0, 0, 0], [1, 0, 0]))
    with pytest.raises(EdgeError, match="neither"):
        band_along(face, None)
    with pytest.raises(EdgeError, match="off the plane z = 0"):
        band_along(face, line([0.1, 0.1, 0], [0.2, 0.2, 1]))
    with pytest.raises(OptionError, match="keep: found 'inside'"):
        band_along(face, WAVE, "inside")
    with pytest.raises(OptionError, match="continuity"):
        band_along(face, WAVE, continuity="C1")
    with pytest.raises(OptionError, match=r"tolerance: found -1\.0, expected .* at least 0"):
        band_along(face, WAVE, tolerance=-1.0)
    with pytest.raises(OptionError, match=r"millimetres: found 0\.0, expected a finite number above 0"):
        band_along(face, WAVE, millimetres=0.0)


def test_a_seam_is_no_end_of_a_closed_face():
    (band,) = band_along(cylinder(), line((0.8, 0.3), (1.3, 0.6)))
    assert band.points <= 40
    assert band.gap <= 1e-5 * band.length


def test_limits_follow_the_unit_and_the_tolerance():
    assert band_limits(1000.0, 0.0, 1.0).gap == 1e-3
    assert band_limits(1000.0, 0.0, None).gap == 1e-2
    loose = band_limits(10.0, 0.5, 1.0)
    assert (loose.gap, loose.off) == (1e-4, 0.5)


def test_a_wrong_row_is_seen():
    piece = piece_of(sphere(), cubic((0.1, 0.2), (0.15, 0.5), (0.2, 0.8), (0.25, 0.9)))
    fit = fit_band(piece, band_limits(piece.length, 0.0, None), 2)
    rows = np.array(fit.rows)
    rows[1, 3:6] = 0.0
    found = measured(piece, fit.degree, fit.knots, rows, 11)
    assert found.worst("angle_degrees")[0] > 0.1


@pytest.mark.long
def test_an_edge_in_space_into_a_pole_is_followed():
    """No pcurve says where the foot in the pole is, and one that has no step does not stop the others."""
    t = np.linspace(0, 1, 201)
    up, round_ = np.pi / 2 * t, 0.4 * t**2
    points = 10 * np.stack([np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)], axis=1)
    (band,) = band_along(sphere(), None, edge=interpolate_curve(points, 5, t))
    assert band.source == "foot"
    assert 0 < band.left_out < 1e-4 * band.length
    assert measure_face_contact(band.base, sphere(), same_side=True).gap <= 1e-5 * band.length
