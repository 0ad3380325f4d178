"""Divided and trimmed Bezier patches in floats: against the referee on the undivided patch and against exact rows."""

from __future__ import annotations

from fractions import Fraction
from math import comb

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from semispline.derivations.bezier import division_rows
from semispline.derivations.trimming import Hole, Side, trimmed_rows
from semispline.solver.errors import InputError, OptionError
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines.bezier import BezierFunction, bezier_patch, divide_bezier, trim_bezier
from semispline.solver.splines.surfaces import BSplineSurface, SemiStructuredSurface

SIDES = {
    "left": BezierFunction([0.3, 0.1, 0.25], 0.4, 0.6),
    "right": BezierFunction([0.8, 0.75], 0.2, 0.5),
    "bottom": BezierFunction([0.4, 0.7, 0.1, 0.2], 0.3, 0.8),
    "top": BezierFunction([0.6, 0.8, 0.3, 0.5], 0.25, 0.75),
}
# Convex combinations throughout: a few roundings of the largest control point for each level of the triangle.
TOLERANCE = 1e-13


def random_patch(seed, m=3, n=3):
    return bezier_patch(np.random.default_rng(seed).uniform(-1, 1, (m + 1, n + 1, 3)))


@st.composite
def cuts(draw):
    m, n, k = draw(st.integers(1, 6)), draw(st.integers(1, 6)), draw(st.integers(0, 6))
    # An arbitrary domain, and coefficients anywhere in the range that is divided.
    u0, v0 = draw(st.floats(-10, 10)), draw(st.floats(-10, 10))
    u1, v1 = u0 + draw(st.floats(0.1, 10)), v0 + draw(st.floats(0.1, 10))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    knots = [u0] * (m + 1) + [u1] * (m + 1), [v0] * (n + 1) + [v1] * (n + 1)
    patch = BSplineSurface(m, n, *knots, rng.uniform(-1, 1, (m + 1, n + 1, 3)))
    direction = draw(st.sampled_from(["u", "v"]))
    lo, hi = (u0, u1) if direction == "u" else (v0, v1)
    fractions = draw(st.lists(st.floats(0, 1), min_size=k + 1, max_size=k + 1))
    return patch, np.clip(lo + (hi - lo) * np.array(fractions), lo, hi), direction, rng


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(cuts())
def test_both_parts_are_the_patch(cut):
    patch, coefficients, direction, rng = cut
    along, across = patch.domain[::-1] if direction == "u" else patch.domain
    lower, upper = divide_bezier(patch, coefficients, direction)
    s, x = rng.random(20), rng.random(20)
    t = along[0] + x * (along[1] - along[0])
    # The cut as a plain sum of Bernstein polynomials, not by de Casteljau.
    k = len(coefficients) - 1
    f = sum(c * comb(k, r) * x**r * (1 - x) ** (k - r) for r, c in enumerate(coefficients))
    for part, target in ((lower, across[0] + s * (f - across[0])), (upper, f + s * (across[1] - f))):
        y = np.clip(target, *across)
        expected = surface_points(patch, y, t) if direction == "u" else surface_points(patch, t, y)
        # Rounding of a parameter of size 20 over a range of 0.1 moves it by 1e-13 of the range, times the degree.
        np.testing.assert_allclose(part.evaluate(s, t), expected, atol=1e-11)
        np.testing.assert_allclose(surface_points(part, s, t), expected, atol=1e-11)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 4), st.integers(1, 3), st.integers(0, 3), st.integers(0, 2**32 - 1))
def test_control_points_are_the_exact_ones(m, n, k, seed):
    rng = np.random.default_rng(seed)
    net = rng.integers(-20, 20, (m + 1, n + 1, 3))
    numerators = rng.integers(0, 17, k + 1)
    parts = divide_bezier(bezier_patch(net), numerators / 16)
    for part, name in zip(parts, ("bottom", "top"), strict=True):
        for d in range(3):
            rows = division_rows(
                [[Fraction(int(x)) for x in row] for row in net[..., d]],
                [Fraction(int(x), 16) for x in numerators],
                name,
            )
            for curve, row in zip(part.control_curves, rows, strict=True):
                expected = [float(x) for x in row]
                np.testing.assert_allclose(curve.control_points[:, d], expected, rtol=0, atol=20 * TOLERANCE)


def test_degrees_and_control_points_per_curve():
    lower, upper = divide_bezier(random_patch(0, 2, 3), [0.2, 0.9, 0.4])
    assert [c.degree for c in lower.control_curves] == [2, 4, 6, 8]
    assert [c.degree for c in upper.control_curves] == [8, 6, 4, 2]
    assert lower.degree_u == upper.degree_u == 3
    # An ordinary patch would need 9 in each of its four rows.
    assert lower.n_control_points == 3 + 5 + 7 + 9


def test_a_straight_cut_is_ordinary_subdivision():
    patch = random_patch(1)
    lower, upper = divide_bezier(patch, [0.25], "u")
    assert [c.degree for c in lower.control_curves] == [3, 3, 3, 3]
    np.testing.assert_allclose(lower.evaluate([1.0], [0.3]), upper.evaluate([0.0], [0.3]), atol=TOLERANCE)
    np.testing.assert_allclose(upper.evaluate([0.5], [0.3]), surface_points(patch, np.array([0.625]), np.array([0.3])))


def test_a_cut_that_touches_the_boundary_has_no_width_there():
    lower, upper = divide_bezier(random_patch(2), [0.0, 1.0])
    np.testing.assert_allclose(np.ptp(lower.evaluate([0, 0.5, 1], [0, 0, 0]), axis=0), 0, atol=TOLERANCE)
    np.testing.assert_allclose(np.ptp(upper.evaluate([0, 0.5, 1], [1, 1, 1]), axis=0), 0, atol=TOLERANCE)


def test_derivatives_follow_the_chain_rule():
    # d/ds of patch(t, s f(t)) is f P_v, and d/dt is P_u + s f' P_v; f(t) = 0.2 + 0.4 t.
    patch = random_patch(3)
    lower, _ = divide_bezier(patch, [0.2, 0.6])
    s, t = np.array([0.3, 0.8]), np.array([0.1, 0.7])
    f = 0.2 + 0.4 * t
    p_u, p_v = surface_points(patch, t, s * f, 1, 0), surface_points(patch, t, s * f, 0, 1)
    np.testing.assert_allclose(lower.evaluate(s, t, 1, 0), f[:, None] * p_v, atol=1e-12)
    np.testing.assert_allclose(lower.evaluate(s, t, 0, 1), p_u + (0.4 * s)[:, None] * p_v, atol=1e-12)


def test_the_eight_pieces_are_the_exact_ones():
    net = np.random.default_rng(4).integers(-9, 9, (4, 4, 3))
    pieces = trim_bezier(bezier_patch(net), **SIDES)
    exact_sides = {
        "left": Side.decimal("0.4", "0.6", "0.3", "0.1", "0.25"),
        "right": Side.decimal("0.2", "0.5", "0.8", "0.75"),
        "bottom": Side.decimal("0.3", "0.8", "0.4", "0.7", "0.1", "0.2"),
        "top": Side.decimal("0.25", "0.75", "0.6", "0.8", "0.3", "0.5"),
    }
    for d in range(3):
        rows = trimmed_rows([[Fraction(int(x)) for x in row] for row in net[..., d]], Hole(**exact_sides))
        assert set(rows) == set(pieces)
        for name, piece in pieces.items():
            if isinstance(piece, SemiStructuredSurface):
                found = [curve.control_points[:, d] for curve in piece.control_curves]
            else:
                found = list(piece.control_points[..., d])
            for row, expected in zip(found, rows[name], strict=True):
                np.testing.assert_allclose(row, [float(x) for x in expected], rtol=0, atol=9 * TOLERANCE)


def test_the_eight_pieces_are_the_patch():
    patch = random_patch(5)
    pieces = trim_bezier(patch, **SIDES)
    rng = np.random.default_rng(6)
    s, x = rng.random(30), rng.random(30)
    for name, piece in pieces.items():
        if isinstance(piece, SemiStructuredSurface):
            side = SIDES[name]
            t = side.start + x * (side.end - side.start)
            c = side.evaluate(t)
            across = s * c if name in ("left", "bottom") else c + s * (1 - c)
            u, v = (across, t) if name in ("left", "right") else (t, across)
            found = piece.evaluate(s, t)
        else:
            (u0, u1), (v0, v1) = piece.domain
            u, v = u0 + s * (u1 - u0), v0 + x * (v1 - v0)
            found = piece.evaluate(u, v)
        np.testing.assert_allclose(found, surface_points(patch, u, v), atol=1e-12)


def test_a_hole_on_another_domain():
    small = random_patch(7)
    knots = np.where(small.knots_u > 0, 12.0, 2.0)
    patch = BSplineSurface(3, 3, knots, knots, small.control_points)
    sides = {n: BezierFunction(2 + 10 * f.coefficients, 2 + 10 * f.start, 2 + 10 * f.end) for n, f in SIDES.items()}
    for name, piece in trim_bezier(patch, **sides).items():
        unit = trim_bezier(small, **SIDES)[name]
        if isinstance(piece, SemiStructuredSurface):
            for one, other in zip(piece.control_curves, unit.control_curves, strict=True):
                np.testing.assert_allclose(one.control_points, other.control_points, atol=1e-12)
        else:
            np.testing.assert_allclose(piece.control_points, unit.control_points, atol=1e-12)


def test_a_slanted_square_hole_in_line_with_itself_is_accepted():
    # Corners at 180 degrees: left and bottom lie on one line.
    left, bottom = BezierFunction([0.45, 0.15], 0.35, 0.65), BezierFunction([0.35, 0.05], 0.45, 0.75)
    right, top = BezierFunction([0.75, 0.8], 0.05, 0.7), BezierFunction([0.65, 0.7], 0.15, 0.8)
    assert len(trim_bezier(random_patch(8), left, right, bottom, top)) == 8


def test_rounding_does_not_make_a_straight_side_cross_itself():
    # Found by search: without its tolerance the outline test refuses this quadrilateral.
    left, right = BezierFunction([0.24, 0.12], 0.12, 0.84), BezierFunction([0.87, 0.84], 0.16, 0.85)
    bottom, top = BezierFunction([0.12, 0.16], 0.24, 0.87), BezierFunction([0.84, 0.85], 0.12, 0.84)
    assert len(trim_bezier(random_patch(8), left, right, bottom, top)) == 8


patch = random_patch(9)
curved = BezierFunction([0.4, 0.99, 0.99, 0.2], 0.3, 0.8)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: bezier_patch([[[0, 0, 0], [0, 1, 0]]]), InputError, "1 x 2 of them, expected at least 2 x 2"),
        (lambda: bezier_patch([[[0, 0, float("nan")]] * 2] * 2), InputError, r"control_points\[0, 0, 2\]"),
        (lambda: BezierFunction([]), InputError, "found none"),
        (lambda: BezierFunction([0.5], 1.0, 1.0), InputError, "start < end"),
        (lambda: BezierFunction([0.5], 0.0, float("inf")), InputError, "finite"),
        (lambda: BezierFunction(["x"]), InputError, "coefficients"),
        (lambda: divide_bezier(patch, [0.5, 1.25]), InputError, r"coefficients\[1\]: found 1.25, .* \[0.0, 1.0\]"),
        (lambda: divide_bezier(patch, [-1e-9, 0.5]), InputError, r"coefficients\[0\]"),
        (lambda: divide_bezier(patch, [float("nan")]), InputError, r"coefficients\[0\]: found nan"),
        (lambda: divide_bezier(patch, []), InputError, "found none"),
        (lambda: divide_bezier(patch, [[0.5]]), InputError, "2 dimension"),
        (lambda: divide_bezier(patch, [0.5], "w"), OptionError, "'w', expected 'u' or 'v'"),
        (lambda: divide_bezier(divide_bezier(patch, [0.5])[0], [0.5]), InputError, "found SemiStructuredSurface"),
        (
            lambda: divide_bezier(BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 1, 1], np.zeros((3, 2, 3))), [0.5]),
            InputError,
            "inner knots",
        ),
        (lambda: trim_bezier(patch, **(SIDES | {"bottom": curved})), InputError, "bottom, top: they cross or touch"),
        (
            lambda: trim_bezier(patch, **(SIDES | {"left": BezierFunction([0.3, 0.1, 0.26], 0.4, 0.6)})),
            InputError,
            r"top, left: found ends at \(0.25, 0.6\) and \(0.26, 0.6\)",
        ),
        (
            lambda: trim_bezier(patch, **(SIDES | {"left": BezierFunction([0.3, 0.0, 0.25], 0.4, 0.6)})),
            InputError,
            r"left\[1\]: found 0.0",
        ),
        (
            lambda: trim_bezier(patch, **(SIDES | {"top": BezierFunction([0.6], 0.25, 1.5)})),
            InputError,
            r"top: found the interval \[0.25, 1.5\]",
        ),
    ],
)
def test_bad_input_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()
