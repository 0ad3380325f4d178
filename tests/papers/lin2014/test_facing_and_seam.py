"""Where (11) is least between plates that face each other, and whether it closes a seam: by routes of their own."""

from fractions import Fraction

import numpy as np
import pytest
from scipy.interpolate import BSpline

from semispline.papers.checks.spline_values import clamped, de_boor
from semispline.papers.lin2014.checks import closed_seam
from semispline.papers.lin2014.checks.facing_bases import BEST_ALPHA, PLATES, _best_of, facing_shares
from semispline.papers.lin2014.claims.section_4 import CLAIMS
from semispline.solver.blending import blend
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineSurface


def plate(start, direction, inwards):
    """A flat strip of unit speed and width 1 along y, the contact at u = 0."""
    ends = [np.array(start), np.array(start) + inwards * np.array(direction)]
    net = [[[x, 0.0, z], [x, 1.0, z]] for x, z in ends]
    return Base(BSplineSurface(1, 1, [0.0, 0, 1, 1], [0.0, 0, 1, 1], net), "u0")


@pytest.mark.parametrize("name", PLATES)
def test_the_best_alpha_of_plates_by_the_solver(name):
    """The energy that the solver measures is quadratic in alpha^2 and beta^2: six values give it, and its minimum."""
    (c, s), (c_2, s_2) = ((float(x), float(y)) for x, y in PLATES[name])
    pair = plate((0.0, 0.0), (c, s), -1), plate((1.0, 0.0), (c_2, s_2), 1)

    def energy(a, b):
        options = {"continuity": "G2", "middle_curves": 1, "degree_u": 3, "v_scale": "paper", "middle_knots": "paper"}
        return blend(*pair, alpha=(a**0.5, b**0.5), p2="zero", flip="no", **options).energy

    points = [(1, 1), (2, 1), (1, 2), (3, 1), (1, 3), (2, 2)]
    rows = [[1, a, b, a * a, a * b, b * b] for a, b in points]
    _, ga, gb, aa, ab, bb = np.linalg.solve(rows, [energy(*point) for point in points])
    best = np.linalg.solve([[2 * aa, ab], [ab, 2 * bb]], [-ga, -gb])
    # Second differences of energies near 100 with 13 digits, solved by a matrix of condition 100.
    assert best == pytest.approx([float(x) for x in _best_of(BEST_ALPHA.relation, PLATES[name])], abs=1e-9)


def test_the_share_of_facing_pairs_is_that_of_a_fine_count():
    """By hand, one middle curve: alpha^2 <= 0 exactly where cos(theta - 2 phi) >= 53/25 cos theta."""
    shares = list(facing_shares().measured.values())
    n = 1000
    angles = np.pi * ((np.arange(n) + 0.5) / n - 0.5)
    theta, phi = np.meshgrid(angles, angles, indexing="ij")
    bad = np.cos(theta - 2 * phi) >= 53 / 25 * np.cos(theta)
    # Midpoints miss the border of a set by a cell at the most, over a length of some 10: 10 / 400.
    assert shares[1] == pytest.approx(float(np.mean(bad | bad.T)), abs=0.005)
    assert 0.15 < shares[1] < shares[0] < 0.25


def test_the_crease_at_alpha_zero_by_least_squares():
    """Rows 0 to 2 at the origin, the last three by beta^2; row 3 and beta^2 by SciPy and NumPy alone."""
    knots = np.concatenate([[0.0] * 4, [0.25, 0.5, 0.75], [1.0] * 4])
    functions = [BSpline(knots, row, 3).derivative(2) for row in np.eye(7)]
    # Second derivatives are linear on each span: two Gauss points are exact for their squares.
    offset = np.array([-1, 1]) / np.sqrt(3)
    u = np.concatenate([(2 * s + 1 + offset) / 8 for s in range(4)])
    bend = np.array([f(u) for f in functions]).T
    # Row 4 is 1 - c_4 beta^2 along the way into S, row 5 1 - c_5 beta^2: P_u = beta^2, P_uu = 0 at u = 1.
    way, exit_ = np.array([0.8, 0.6]), np.array([0.28, 0.96])
    shift = -(bend[:, 4] * 0.25 + bend[:, 5] / 12)
    fixed = bend[:, 4:].sum(axis=1)
    columns = np.zeros((2 * len(u), 3))
    columns[: len(u), 0], columns[len(u) :, 1] = bend[:, 3], bend[:, 3]
    columns[: len(u), 2], columns[len(u) :, 2] = shift * way[0], shift * way[1]
    (x, y, _), *_ = np.linalg.lstsq(columns, -np.concatenate([fixed, 0 * fixed]), rcond=None)
    crease = np.degrees(np.arccos((x * exit_[0] + y * exit_[1]) / np.hypot(x, y)))
    measured = facing_shares().measured["crease at alpha = 0 between plates at 74 and 37 degrees [degrees]"]
    assert measured == pytest.approx(crease, abs=1e-9)


def test_the_condition_of_the_record_is_that_of_its_formula():
    (claim,) = [claim for claim in CLAIMS if claim.id == "sec-4.facing"]
    assert "39 cos theta > 25 cos phi cos(theta - phi)" in claim.readings[0].condition


@pytest.mark.parametrize("inner", closed_seam._INNER)
def test_the_closed_curves_close_with_two_derivatives(inner):
    points = closed_seam.closed_points(inner, [2, 5, -1, 4][: len(inner) + 1])
    knots = clamped(4, *inner)
    assert len(points) == len(knots) - 4

    def ends(low, high):
        step = (high - low) / 3
        f0, f1, f2, f3 = (de_boor(4, knots, points, low + i * step) for i in range(4))
        first = [(-11 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 6, (-2 * f0 + 9 * f1 - 18 * f2 + 11 * f3) / 6]
        second = [2 * f0 - 5 * f1 + 4 * f2 - f3, -f0 + 4 * f1 - 5 * f2 + 2 * f3]
        return (f0, first[0] / step, second[0] / step**2), (f3, first[1] / step, second[1] / step**2)

    assert ends(Fraction(0), inner[0])[0] == ends(inner[-1], Fraction(1))[1]


@pytest.mark.long
def test_least_energy_leaves_the_middle_curve_open_and_rows_of_bases_closed():
    start, end = closed_seam.middle_ends()
    assert start != end
    assert not any(case.true for case in closed_seam.free_middle_cases())
    without, with_one = closed_seam.seam_gap().measured.values()
    assert without == 0
    assert with_one > 0.1
