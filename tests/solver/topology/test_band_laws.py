"""Laws of bands: orders of convergence, motions, scale, direction, names of the parameters."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.free_curves import cubic, cylinder, ellipse_on_cylinder, free_form, open_curve, sphere, torus
from helpers.sweeps import first_ones
from semispline import BSplineCurve, reverse_curve, swap_directions, transform
from semispline.derivations.bands import section_heights
from semispline.solver.topology.band_measures import measured, row_jet
from semispline.solver.topology.band_search import band_limits
from semispline.solver.topology.bands import band_along
from semispline.solver.topology.curve_pieces import pieces
from semispline.solver.topology.face_curves import curve_on_face, edge_on_face
from semispline.solver.topology.face_jets import Face, sections
from semispline.solver.topology.row_fit import closed_space, fitted_rows, scales


def even_fit(piece, degree, spans, limits=None):
    """Rows over even spans, and what is measured of them."""
    limits = band_limits(piece.length, 0.0, None) if limits is None else limits
    of = scales(piece.sections(np.linspace(0, piece.length, 201), 2), piece.face.size)
    knots, rows = fitted_rows(piece, degree, np.linspace(0, piece.length, spans + 1), limits, of, 2)
    return knots, rows, measured(piece, degree, knots, rows, 30)


def closed_piece(degrees=45.0):
    curve = edge_on_face(Face(cylinder()), ellipse_on_cylinder(degrees), None, 0.0)
    (piece,), cuts = pieces(curve, 1.0, 1e-6)
    assert piece.closed
    assert not cuts
    return piece


@pytest.mark.parametrize("degree", [3, 5])
def test_orders_of_convergence_on_even_knots(degree):
    piece = closed_piece()
    coarse, fine = (even_fit(piece, degree, spans)[2] for spans in (32, 64))
    for name, order in (("gap", degree + 1), ("angle_degrees", degree), ("along", degree - 1), ("mixed", degree)):
        ratio = np.log2(coarse.worst(name)[0] / fine.worst(name)[0])
        # A higher-order remainder is still seen at 32 spans.
        assert order - 0.7 <= ratio <= order + 1.3, name


@pytest.mark.parametrize("degree", [3, 5])
def test_the_angle_over_the_gap_is_that_of_the_bernoulli_polynomial(degree):
    """The error of a spline fit on even knots is B_(q+1) locally: its slope is about 6 times its size over h."""
    piece, spans = closed_piece(30.0), 48
    # Fitted by position alone: weights of the other equations that are next to nothing.
    position = replace(band_limits(piece.length, 0.0, None), angle_degrees=1e4, curvature=1e6)
    knots, rows, _ = even_fit(piece, degree, spans, position)
    v = np.linspace(0, piece.length, 4001)
    at = piece.sections(v, 2)
    jet = row_jet(degree, knots, rows, v, 2)
    gap = np.sum((jet[0, 0] - at.point) * at.normal, axis=1)
    angle = np.sum(jet[0, 1] * at.normal, axis=1)
    ratio = np.abs(angle).max() * piece.length / spans / np.abs(gap).max()
    assert 4.8 <= ratio <= 6.3


@pytest.mark.parametrize(("face", "curve"), [
    (cylinder(), cubic((0.1, 0.3), (0.3, 0.5), (0.4, 0.3), (0.6, 0.7))),
    (torus(), cubic((0.1, 0.1), (0.15, 0.3), (0.3, 0.2), (0.4, 0.8))),
    (free_form(np.random.default_rng(2), 5, 7), cubic((0.2, 0.2), (0.4, 0.7), (0.6, 0.2), (0.85, 0.8))),
])  # fmt: skip
def test_the_jet_leaves_the_face_by_its_first_missing_term(face, curve):
    """C + w D + sum h_k w^k / k! N leaves the face by O(w^(K + 1)), for K = 2, 3, 4."""
    (piece,), _ = pieces(curve_on_face(Face(face), curve), 1.0, 1e-6)
    v = np.linspace(0.1, 0.9, 7) * piece.length
    at, slope, beside = piece.at(v)
    for order in (2, 3, 4):
        jet = piece.sections(v, order)
        rest = []
        for w in (0.04 * piece.length, 0.02 * piece.length):
            points = jet.point + w * jet.into
            for k, height in enumerate(jet.heights, start=2):
                points = points + (height * w**k / np.prod(range(1, k + 1)))[:, None] * jet.normal
            rest.append(np.linalg.norm(piece.face.feet(points, at, None, 2)[2], axis=1))
        ratio = np.log2(rest[0] / rest[1])
        # Where the next term vanishes the remainder is smaller; a knot line may lie between.
        assert np.median(ratio) > order + 0.6
    assert slope.shape == beside.shape


@pytest.mark.parametrize("seed", first_ones(2, range(10)))
def test_heights_are_those_of_the_derivation(seed):
    """The solver's power series against SymPy's on rational polynomial surfaces."""
    import sympy as sp

    rng = np.random.default_rng(seed)
    s, t = sp.symbols("s t", real=True)
    c = rng.integers(-4, 5, (3, 3, 3)) / 8
    net = np.stack([*np.meshgrid([0, 0.5, 1], [0, 0.5, 1], indexing="ij"), np.zeros((3, 3))], axis=-1) + c / 8
    from semispline import BSplineSurface

    surface = BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1], net)
    bernstein = [[(1 - x) ** 2, 2 * x * (1 - x), x**2] for x in (s, t)]
    exact = [
        sum(sp.Rational(float(net[i, j, d])) * bernstein[0][i] * bernstein[1][j] for i in range(3) for j in range(3))
        for d in range(3)
    ]
    at, slope = (sp.Rational(3, 8), sp.Rational(1, 2)), (2, -1)
    expected = [float(sp.N(x, 30)) for x in section_heights_of(exact, (s, t), at, slope)]
    face = Face(surface)
    jet = face.jet(np.array([[0.375, 0.5]]), 4)
    tangent = jet[1, 0] * slope[0] + jet[0, 1] * slope[1]
    found = sections(jet, tangent, 1.0, 4).heights[:, 0]
    # Each order divides by the metric once more; it is above 0.3 here.
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9)


def section_heights_of(exact, parameters, at, slope):
    """Numbers, so that nothing has to be simplified: floats of 40 digits in place of roots."""
    import sympy as sp

    return section_heights([sp.N(x, 40) for x in map(sp.expand, exact)], parameters, at, slope, 4)


def figures(bands):
    return [(b.points, b.gap / b.length, b.off / b.length, b.angle_degrees, b.curvature) for b in bands]


def check_same(one, other, rel=1e-3):
    """Knots follow the errors, so that rounding moves them a little, and the figures with them."""
    for a, b in zip(figures(one), figures(other), strict=True):
        assert a[0] == b[0]
        assert a[1:] == pytest.approx(b[1:], rel=rel, abs=1e-9)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_motion_and_a_scale_change_nothing(seed):
    rng = np.random.default_rng(seed)
    face, curve = free_form(rng, 5, 6), open_curve(rng)
    bands = band_along(face, curve)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    check_same(bands, band_along(transform(face, turn, [3.0, -40.0, 7.0]), curve))
    for factor in (1e-3, 1e3):
        check_same(bands, band_along(transform(face, factor * np.eye(3)), curve))
    # Far from the origin rounding of coordinates is larger, and so is that of curvature.
    check_same(bands, band_along(transform(face, np.eye(3), [1e4, 0.0, 0.0]), curve), rel=1e-2)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_reversed_curve_with_the_other_side_is_the_same_band(seed):
    rng = np.random.default_rng(seed)
    face, curve = free_form(rng, 5, 6), open_curve(rng)
    one, other = band_along(face, curve), band_along(face, reverse_curve(curve), "right")
    check_same(one, other, rel=0.02)
    v = np.linspace(0, 1, 50)
    a, b = (x[0].surface for x in (one, other))
    w = np.full(50, a.domain[0][1])
    length = one[0].length
    away = a.evaluate(w, v * length) - b.evaluate(w, (1 - v) * length)
    # Both lie on the face within the limits of the rows at the far side: 2 % of curvature over L / 10.
    assert np.abs(away).max() <= 1e-3 * length


def test_swapped_parameters_turn_the_normal_and_the_side():
    rng = np.random.default_rng(4)
    face, curve = free_form(rng, 5, 6), open_curve(rng)
    swapped = replace(curve, control_points=curve.control_points[:, [1, 0, 2]])
    check_same(band_along(face, curve), band_along(swap_directions(face), swapped, "right"))


def test_another_speed_of_the_curve_changes_nothing():
    face = sphere()
    curve = cubic((0.1, 0.3), (0.2, 0.6), (0.3, 0.3), (0.4, 0.6))
    # The same curve, run through by x = t / (2 - t).
    faster = BSplineCurve(3, curve.knots, curve.control_points, [8.0, 4.0, 2.0, 1.0])
    check_same(band_along(face, curve), band_along(face, faster), rel=0.02)


def test_functions_of_a_closed_space_are_smooth_at_the_seam():
    breaks = np.array([0.0, 0.7, 1.1, 2.0, 2.2, 3.0, 4.0])
    for degree in (2, 3, 5, 7):
        space = closed_space(degree, breaks)
        knots = np.concatenate([np.zeros(degree), breaks, np.full(degree, breaks[-1])])
        assert space.shape == (len(breaks) - 1 + degree, len(breaks) - 1)
        assert np.linalg.matrix_rank(space) == len(breaks) - 1
        assert space.sum(axis=1) == pytest.approx(np.ones(len(space)), abs=1e-14)
        for k in range(space.shape[1]):
            rows = np.zeros((1, len(space), 3))
            rows[0, :, 0] = space[:, k]
            for order in range(degree):
                jet = row_jet(degree, knots, np.repeat(rows, order + 1, axis=0), np.array([0.0, 4.0]), order)
                first, last = jet[0, order][:, 0]
                # Some roundings of 1 over the narrowest span to the power of the order.
                assert abs(first - last) <= 1e-14 * (2 * degree / 0.2) ** order
