"""The eight pieces around a hole with four sides: the tiling is exact, and each condition of the proof can fail."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from math import comb

import numpy as np
import pytest
import sympy as sp

from semispline.derivations.bezier import generic_patch
from semispline.derivations.trimming import (
    Hole,
    Side,
    areas,
    boundary_residual,
    corners,
    crossings,
    inside_square,
    seam_residuals,
    segment,
    trimmed_rows,
)

# The curves c1 to c4 below Fig. 3 of the paper, typed from its text: left, right, bottom, top.
PRINTED = Hole(
    Side.decimal("0.4", "0.6", "0.3", "0.1", "0.25"),
    Side.decimal("0.2", "0.5", "0.8", "0.75"),
    Side.decimal("0.3", "0.8", "0.4", "0.7", "0.1", "0.2"),
    Side.decimal("0.25", "0.75", "0.6", "0.8", "0.3", "0.5"),
)


def test_the_printed_curves_tile():
    assert all(one == other for one, other in corners(PRINTED).values())
    assert boundary_residual(PRINTED) == {}
    assert inside_square(PRINTED)
    corner = {name: (sp.Rational(p[0]), sp.Rational(p[1])) for name, (p, _) in corners(PRINTED).items()}
    assert crossings(PRINTED) == {
        ("left", "right"): [],
        ("left", "bottom"): [corner["lower left"]],
        ("left", "top"): [corner["upper left"]],
        ("right", "bottom"): [corner["lower right"]],
        ("right", "top"): [corner["upper right"]],
        ("bottom", "top"): [],
    }


def test_areas_of_the_printed_pieces_sum_to_one():
    result = areas(PRINTED)
    assert result["hole"] == Fraction(5, 48)
    assert result["left"] == Fraction(13, 300)
    assert sum(result.values()) == 1


def outline(hole, samples):
    """The hole's boundary as a polygon, counterclockwise, in floats: knows nothing of the pieces."""

    def run(side, swap):
        t = np.linspace(float(side.start), float(side.end), samples)
        x = (t - t[0]) / (t[-1] - t[0])
        k = len(side.coefficients) - 1
        value = sum(float(c) * comb(k, r) * x**r * (1 - x) ** (k - r) for r, c in enumerate(side.coefficients))
        return np.stack([value, t] if swap else [t, value], axis=1)[:-1]

    def back(side, swap):
        mirrored = Side(1 - side.end, 1 - side.start, side.coefficients[::-1])
        points = run(mirrored, swap)
        points[:, 1 if swap else 0] = 1 - points[:, 1 if swap else 0]
        return points

    return np.concatenate(
        [run(hole.bottom, False), run(hole.right, True), back(hole.top, False), back(hole.left, True)]
    )


def test_area_of_the_hole_is_that_of_its_polygon():
    x, y = outline(PRINTED, 400).T
    area = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2
    # A polygon's error falls with the square of the step, 1/400.
    assert area == pytest.approx(float(areas(PRINTED)["hole"]), abs=1e-5)


def test_every_point_off_the_hole_lies_in_exactly_one_piece():
    x, y = outline(PRINTED, 400).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    found = []
    for i, j in product(range(23), repeat=2):
        u, v = Fraction(3 * i + 1, 69), Fraction(3 * j + 1, 69)
        # The ray to the right crosses the outline an odd number of times from inside.
        height = float(v)
        straddles = (y > height) != (y1 > height)
        at = x[straddles] + (height - y[straddles]) / (y1 - y)[straddles] * (x1 - x)[straddles]
        in_hole = np.count_nonzero(at > float(u)) % 2 == 1
        pieces = pieces_that_hold(PRINTED, u, v)
        assert len(pieces) == (0 if in_hole else 1)
        found += pieces
    assert len(set(found)) == 8


def pieces_that_hold(hole, u, v):
    left, right, bottom, top = hole.left, hole.right, hole.bottom, hole.top
    holds = {
        "left": left.start < v < left.end and u < left.value(v),
        "right": right.start < v < right.end and u > right.value(v),
        "bottom": bottom.start < u < bottom.end and v < bottom.value(u),
        "top": top.start < u < top.end and v > top.value(u),
        "lower left": u < bottom.start and v < left.start,
        "lower right": u > bottom.end and v < right.start,
        "upper right": u > top.end and v > right.end,
        "upper left": u < top.start and v > left.end,
    }
    return [name for name, inside in holds.items() if inside]


@pytest.mark.parametrize("name", ["left", "right", "bottom", "top"])
@pytest.mark.parametrize("end", ["start", "end"])
def test_an_interval_that_is_off_leaves_a_boundary(name, end):
    side = getattr(PRINTED, name)
    moved = replace(side, **{end: getattr(side, end) + Fraction(1, 100)})
    assert boundary_residual(replace(PRINTED, **{name: moved})) != {}


@pytest.mark.parametrize("name", ["left", "right", "bottom", "top"])
@pytest.mark.parametrize("index", [0, -1])
def test_a_corner_that_is_off_leaves_a_boundary(name, index):
    side = getattr(PRINTED, name)
    coefficients = list(side.coefficients)
    coefficients[index] += Fraction(1, 100)
    moved = replace(side, coefficients=tuple(coefficients))
    hole = replace(PRINTED, **{name: moved})
    assert boundary_residual(hole) != {}
    assert sum(areas(hole).values()) != 1


def test_a_bulge_makes_sides_cross_though_the_corners_meet():
    bulge = replace(PRINTED.bottom, coefficients=tuple(map(Fraction, ("0.4", "0.99", "0.99", "0.2"))))
    hole = replace(PRINTED, bottom=bulge)
    assert boundary_residual(hole) == {}
    assert len(crossings(hole)["bottom", "top"]) > 0


def test_sides_that_coincide_are_refused():
    with pytest.raises(ValueError, match="coincide"):
        crossings(replace(PRINTED, right=PRINTED.left))


def test_a_side_that_leaves_the_square_is_seen():
    outside = replace(PRINTED.top, coefficients=tuple(map(Fraction, ("0.6", "1.1", "0.3", "0.5"))))
    assert not inside_square(replace(PRINTED, top=outside))


def test_an_empty_interval_is_refused():
    with pytest.raises(ValueError, match="start < end"):
        Side.decimal("0.5", "0.5", "0")


def test_seams_are_one_curve_for_every_bicubic_patch():
    _, _, net, _ = generic_patch(3, 3, 0)
    pieces = trimmed_rows(net, PRINTED)
    seams = seam_residuals(pieces)
    assert len(seams) == 8
    assert all(difference == 0 for seam in seams.values() for difference in seam)
    counts = {name: [len(row) for row in pieces[name]] for name in ("left", "right", "bottom", "top")}
    assert counts == {"left": [4, 6, 8, 10], "right": [7, 6, 5, 4], "bottom": [4, 7, 10, 13], "top": [13, 10, 7, 4]}


def test_segment_of_a_known_polynomial():
    # x^2 over [1/2, 1]: 1/4, 1/2, 1.
    assert segment([[0], [0], [1]], Fraction(1, 2), Fraction(1)) == ((Fraction(1, 4),), (Fraction(1, 2),), (1,))
