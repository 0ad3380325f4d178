"""The division of a Bezier patch by a Bezier function: proved over symbols, checked by plain de Casteljau in Q."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from semispline.derivations.bezier import (
    PARTS,
    blossom,
    division_curve,
    division_lemmas,
    division_residuals,
    division_rows,
    expanded_rows,
    row_degrees,
)

fractions = st.fractions(min_value=-5, max_value=5, max_denominator=12)
unit_fractions = st.fractions(min_value=0, max_value=1, max_denominator=12)


def de_casteljau(points, t):
    level = [Fraction(p) for p in points]
    while len(level) > 1:
        level = [a + t * (b - a) for a, b in pairwise(level)]
    return level[0]


def patch_value(net, u, v):
    return de_casteljau([de_casteljau(row, v) for row in net], u)


def test_every_lemma_of_the_general_proof_is_zero():
    lemmas = division_lemmas()
    assert set(lemmas) == {"product", "subdivision", "collect", "mirror", "affine", "symmetric"}
    assert all(value == 0 for value in lemmas.values())


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("degrees", [(1, 1, 1), (2, 1, 3), (1, 3, 2), (2, 2, 2), (3, 3, 1), (3, 3, 3), (4, 2, 0)])
def test_closed_form_is_the_expansion_over_symbols(degrees, part):
    m, n, k = degrees
    residuals = division_residuals(m, n, k, part)
    assert len(residuals) == sum(d + 1 for d in row_degrees(m, n, k, part))
    assert all(r == 0 for r in residuals)


def test_each_row_needs_its_degree():
    # `expanded_rows` finds the degrees from the polynomial and refuses any other than m + s k.
    assert [len(row) - 1 for row in expanded_rows(2, 3, 2, "bottom")] == [2, 4, 6, 8]
    assert [len(row) - 1 for row in expanded_rows(2, 3, 2, "top")] == [8, 6, 4, 2]


@st.composite
def patches(draw):
    m, n, k = draw(st.integers(0, 3)), draw(st.integers(0, 3)), draw(st.integers(0, 3))
    net = draw(st.lists(st.lists(fractions, min_size=n + 1, max_size=n + 1), min_size=m + 1, max_size=m + 1))
    return net, draw(st.lists(unit_fractions, min_size=k + 1, max_size=k + 1))


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(patches(), unit_fractions, unit_fractions)
def test_parts_are_the_patch_below_and_above_the_cut(patch, u, w):
    net, function = patch
    cut = de_casteljau(function, u)
    for part, v in (("bottom", cut * w), ("top", cut + (1 - cut) * w)):
        rows = division_rows(net, function, part)
        value = de_casteljau([de_casteljau(row, u) for row in rows], w)
        assert value == patch_value(net, u, v)


@settings(max_examples=40, deadline=None)
@given(st.lists(fractions, min_size=1, max_size=6), st.data())
def test_blossom_is_symmetric_affine_and_the_polynomial_on_its_diagonal(points, data):
    s = len(points) - 1
    arguments = data.draw(st.lists(fractions, min_size=s, max_size=s))
    t, other = data.draw(fractions), data.draw(fractions)
    assert blossom(points, [t] * s) == de_casteljau(points, t)
    assert blossom(points, data.draw(st.permutations(arguments))) == blossom(points, arguments)
    if s:
        rest = arguments[1:]
        mixed = blossom(points, [t * arguments[0] + (1 - t) * other, *rest])
        assert mixed == t * blossom(points, [arguments[0], *rest]) + (1 - t) * blossom(points, [other, *rest])


def test_straight_cut_of_a_curve_is_known():
    # x^2 over [0, 1/2]: control points 0, 0, 1/4.
    rows = division_rows([[0, 0, 1]], [Fraction(1, 2)], "bottom")
    assert rows == ((0,), (0,), (Fraction(1, 4),))


def test_a_cut_along_the_diagonal_of_a_plane_is_known():
    # z = v cut by v(u) = u: the last row of the bottom is z = u, of degree 2 although linear.
    rows = division_rows([[0, 1], [0, 1]], [0, 1], "bottom")
    assert rows == ((0, 0), (0, Fraction(1, 2), 1))


def test_symbols_are_accepted():
    a, b, v = sp.symbols("a b v")
    assert sp.expand(division_curve([[a, b]], [v], 0, 1)[0] - (a + v * (b - a))) == 0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: blossom([0, 1], []), "expected 1 for 2 points"),
        (lambda: blossom([0, 0.5], [1]), "float 0.5"),
        (lambda: division_curve([[0, 1]], [0], 1, 1), r"found \(1, 1\)"),
        (lambda: division_rows([[0, 1], [0]], [0], "top"), r"points\[1\]"),
        (lambda: division_rows([[0, 1]], [], "top"), "at least one"),
        (lambda: division_rows([[0, 1]], [0], "left"), "expected 'bottom' or 'top'"),
    ],
)
def test_bad_input_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
