"""Which cure acts on which base, and what is left."""

import numpy as np
import pytest

from helpers.conics import standard_arcs
from helpers.knot_lines import least_continuity
from semispline.solver.blending import cures
from semispline.solver.blending.cures import cured_rows
from semispline.solver.splines import Basis, clamped

SPANS = (1.0, 1.0)


def strip(points, knots, other=None):
    """Two rows, one above the other; `other` is the second row's plan."""
    rows = np.array([points, points if other is None else other], dtype=float)
    rows[1, :, 2] += 1
    return rows, Basis(2, knots)


TWO = clamped([1.0, 1.0], 2, 0, 2)
SMOOTH = [[0, 0, 0], [1, 0, 0], [2, 0.5, 0], [3, 1, 0], [4, 3, 0]]
FASTER = [[0, 0, 0], [1, 0, 0], [2, 0.5, 0], [4, 1.5, 0], [5, 3, 0]]
CREASED = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1, 0], [5, 3, 0]]
OTHER_SPEED = [[0, 0, 0], [1, 0, 0], [2, 0.5, 0], [2.5, 0.75, 0], [5, 3, 0]]


def test_polynomial_rows():
    smooth = cured_rows(*strip(SMOOTH, TWO), 1, SPANS)
    assert (smooth.cure, smooth.found, smooth.left) == ("none", (), ())
    faster = cured_rows(*strip(FASTER, TWO), 1, SPANS)
    assert (faster.cure, faster.along.degree, faster.left) == ("spans", 2, ())
    assert [jump.v for jump in faster.found] == [1.0]
    slopes = cured_rows(*strip(FASTER, TWO, OTHER_SPEED), 1, SPANS)
    assert (slopes.cure, slopes.left) == ("slopes", ())
    assert least_continuity(slopes.rows, slopes.along) >= 1
    creased = cured_rows(*strip(CREASED, TWO), 1, SPANS)
    assert creased.cure == "none"
    (jump,) = creased.left
    assert (jump.kind, jump.v, jump.degrees) == ("creased", 1.0, pytest.approx(45))


def test_one_line_is_cured_and_another_is_named():
    points = [*FASTER[:-1], [5, 2, 0], [5, 2.5, 0], [5, 4, 0]]
    found = cured_rows(*strip(points, clamped([1, 1, 2, 2], 2, 0, 3)), 1, SPANS)
    assert found.cure == "spans"
    assert [jump.kind for jump in found.found] == ["shared", "creased"]
    assert [jump.kind for jump in found.left] == ["creased"]


@pytest.mark.parametrize("smoothness", [2, 3])
def test_a_circle_is_a_conic_before_it_is_anything_else(smoothness):
    knots, points = standard_arcs(np.linspace(0, 2 * np.pi, 5))
    rows = np.insert(points, 2, 0.0, axis=1)[None].repeat(2, axis=0)
    rows[1, :, 2] = rows[1, :, 3]
    found = cured_rows(rows, Basis(2, knots), 1, SPANS, smoothness=smoothness, closed=True)
    assert (found.cure, found.left, len(found.found)) == ("conic", (), 4)
    assert found.along.size == {2: 11, 3: 14}[smoothness]


def test_two_arcs_with_one_tangent_are_no_conic():
    one, two = standard_arcs([0, np.pi / 2])[1], standard_arcs([0, np.pi / 3])[1]
    points = np.concatenate([one, (two @ np.array([[0, 2, 0], [-2, 0, 0], [0, -1.0, 1]]))[1:]])
    rows = np.insert(points, 2, 0.0, axis=1)[None].repeat(2, axis=0)
    rows[1, :, 2] = rows[1, :, 3]
    found = cured_rows(rows, Basis(2, TWO), 1, SPANS)
    assert (found.cure, found.along.degree, found.left) == ("spans", 4, ())


@pytest.mark.parametrize("columns", [3, 4])
def test_a_parabola_without_weights_stays_one(columns):
    # v^2 over [0, 1] and [1, 2], the second half twice as fast.
    points = [[0, 0, 0], [0.5, 0, 0], [1, 1, 0], [1.5, 2, 0], [2, 4, 0]]
    rows, along = strip(points, clamped([1.0, 1.0], 2, 0, 1.5))
    if columns == 4:
        rows = np.concatenate([rows, np.ones((2, 5, 1))], axis=-1)
    found = cured_rows(rows, along, 1, SPANS)
    assert (found.cure, found.along.degree, found.left) == ("spans", 2, ())
    assert found.along.knots.tolist() == pytest.approx([0, 0, 0, 0.75, 1.5, 1.5, 1.5])


def test_a_conic_is_smooth_to_second_order_where_nothing_else_is_said():
    knots, points = standard_arcs(np.linspace(0, 2 * np.pi, 5))
    rows = np.insert(points, 2, 0.0, axis=1)[None].repeat(2, axis=0)
    rows[1, :, 2] = rows[1, :, 3]
    assert cured_rows(rows, Basis(2, knots), 1, SPANS, closed=True).along.size == 11


@pytest.mark.parametrize(("degree", "cure"), [(25, True), (26, False)])
def test_a_cure_of_a_degree_that_no_kernel_takes_is_none(monkeypatch, degree, cure):
    line = np.linspace(0, 1, degree + 1)[:, None] * [1.0, 0, 0]
    basis = Basis(degree, np.repeat([0.0, 2.0], degree + 1))
    found = np.stack([line, line + np.array([0, 0, 1])]), basis
    monkeypatch.setattr(cures, "closed_lines", lambda *_, **__: (*found, 1))
    monkeypatch.setattr(cures, "smoothed", lambda *_, **__: found)
    slopes = cured_rows(*strip(FASTER, TWO, OTHER_SPEED), 1, SPANS)
    assert (slopes.cure == "slopes") is cure
    spans = cured_rows(*strip(FASTER, TWO), 1, SPANS)
    assert spans.cure == ("spans" if cure else "none")
