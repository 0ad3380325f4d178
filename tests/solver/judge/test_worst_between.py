"""The worst of a contact between samples: known in closed form, and never less than any sample."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from semispline import Base, BSplineSurface, measure_contact
from semispline.solver.judge.pairs import _vertices, places_between

FLAT = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[x, y, 0] for y in (0, 1)] for x in (0, 1)])
# Highest at 2/3, where it is 4/27: between two samples.
HUMP = Polynomial([0, 0, 1, -1])
TOP, AT = 4 / 27, 2 / 3


def bernstein(polynomial, degree):
    """Bernstein coefficients on [0, 1], by sums of ratios of binomials."""
    from math import comb

    c = [*polynomial.coef, *[0.0] * (degree + 1)]
    return np.array([sum(comb(i, k) / comb(degree, k) * c[k] for k in range(i + 1)) for i in range(degree + 1)])


def bent(*terms, degree=6):
    """X = (-u, v, sum of terms[k](v) u^k): beyond the flat one's edge x = 0."""
    p = max(len(terms) - 1, 1)
    heights = np.stack([bernstein(term, degree) for term in terms] + [np.zeros(degree + 1)] * (p + 1 - len(terms)))
    heights = np.stack([bernstein(Polynomial(column), p) for column in heights.T], axis=1)
    net = [[[-i / p, j / degree, heights[i, j]] for j in range(degree + 1)] for i in range(p + 1)]
    return BSplineSurface(p, degree, np.repeat([0.0, 1.0], p + 1), np.repeat([0.0, 1.0], degree + 1), net)


def test_the_worst_gap_and_angle_lie_between_samples():
    contact = measure_contact(Base(FLAT, "u0"), Base(bent(HUMP * 1e-3), "u0"))
    assert contact.gap == pytest.approx(1e-3 * TOP, rel=1e-9)
    assert contact.gap_at.parameter == pytest.approx(AT, abs=1e-4)
    assert contact.gap_at.point == (0.0, contact.gap_at.parameter, 0.0)
    contact = measure_contact(Base(FLAT, "u0"), Base(bent(0 * HUMP, HUMP), "u0"))
    assert contact.angle_degrees == pytest.approx(np.degrees(np.arctan(TOP)), rel=1e-9)
    assert contact.angle_at.parameter == pytest.approx(AT, abs=1e-4)


def test_the_worst_jumps_lie_between_samples():
    nothing = 0 * HUMP
    contact = measure_contact(
        Base(FLAT, "u0"), Base(bent(nothing, nothing, HUMP / 2, HUMP / 6, HUMP / 24), "u0"), order=4
    )
    assert contact.curvature_jump == pytest.approx(TOP, rel=1e-9)
    assert contact.rate_jump == pytest.approx(TOP, rel=1e-9)
    # The second rate of the section z = h x^2 / 2 + .. is h - 3 h^3.
    assert contact.second_rate_jump == pytest.approx(TOP - 3 * TOP**3, rel=1e-9)
    for place in (contact.curvature_at, contact.rate_at, contact.second_rate_at):
        assert place.parameter == pytest.approx(AT, abs=1e-4)


def test_the_largest_of_several_maxima_need_not_be_beside_the_largest_sample():
    # Two humps: a low one whose top is a sample, and a sharp one, twice as high, between two samples.
    s = np.linspace(0, 1, 11)

    def values(x):
        return np.maximum(np.exp(-(((x - 0.2) / 0.1) ** 2)), 2 * np.exp(-(((x - 0.74) / 0.04) ** 2)))[None]

    sampled = values(s)
    assert sampled.argmax() == 2
    found = places_between(values, s, sampled, np.array([0.0, 1.0]))
    assert values(found).max() == pytest.approx(2, rel=1e-9)


def test_a_worst_place_at_a_knot_is_found():
    # Steepest at the knot 0.3, on both sides.
    surface = BSplineSurface(
        1, 1, [0, 0, 1, 1], [0, 0, 0.3, 1, 1], [[[-i, y, i * (y == 0.3)] for y in (0, 0.3, 1)] for i in range(2)]
    )
    contact = measure_contact(Base(FLAT, "u0"), Base(surface, "u0"))
    assert contact.angle_degrees == pytest.approx(45, abs=1e-6)


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_never_less_than_samples_and_hardly_less_than_the_worst(seed):
    rng = np.random.default_rng(seed)
    terms = [Polynomial(rng.normal(size=6)) * 10.0 ** rng.integers(-4, 1) for _ in range(3)]
    other = bent(*terms)
    contact = measure_contact(Base(FLAT, "u0"), Base(other, "u0"), flip="no")
    v = np.linspace(0, 1, 20001)
    gap = np.abs(terms[0](v))
    # Seen along the edge the surface leaves with these slopes, along v and across.
    along, across = terms[0].deriv()(v), terms[1](v)
    angle = np.degrees(np.arctan(np.hypot(along, across)))
    assert contact.gap >= gap.max() * (1 - 1e-7)
    assert contact.gap <= gap.max() * (1 + 1e-7) + 1e-15
    assert contact.angle_degrees == pytest.approx(angle.max(), rel=1e-6)


def test_nothing_is_sought_below_rounding(monkeypatch):
    monkeypatch.setattr("semispline.solver.judge.continuity.places_between", lambda *_: pytest.fail("sought"))
    contact = measure_contact(Base(FLAT, "u0"), Base(bent(0 * HUMP, 0 * HUMP, 0 * HUMP), "u0"), order=4)
    assert contact.angle_degrees <= 1e-12


def test_the_search_stays_inside_its_span_and_finds_its_way():
    breaks = np.array([0.0, 1.0, 2.0])
    s = np.array([0.0, 0.5, 0.998, 1.002, 1.5, 2.0])

    def values(x):
        # Highest just before the first break, where it jumps down.
        return np.where(x < 1, x, 0.2 * x)[None]

    found = places_between(values, s, values(s), breaks)
    assert (found != 1.0).all()
    assert values(found).max() == pytest.approx(1.0, abs=1e-7)
    # A kind of which one value is not a number has no largest one.
    assert places_between(values, s, np.full((1, 6), np.nan), breaks).size == 0


@pytest.mark.parametrize(
    ("values", "at", "found"),
    [
        ([3, 2, 1], 0, []),
        ([1, 2, 3], 2, []),
        ([1, 1, 1], 1, [1.5]),
        # A parabola through 0, 3 and 2 is highest a quarter of a step beyond the middle.
        ([0, 3, 2], 1, [1.5 + 0.25 * 0.5]),
    ],
)
def test_a_parabola_goes_through_the_highest_value_and_its_neighbours(values, at, found):
    places = _vertices(np.array([[1, 1.5, 2]]), np.array([values], dtype=float), np.array([at]))
    assert places.tolist() == pytest.approx(found, abs=1e-15)
