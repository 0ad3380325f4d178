"""Places without a proper normal along an edge: cusps of the edge, vanishing and parallel cross derivatives."""

import numpy as np
import pytest

from helpers.bases import patch, turned
from semispline import Base, BSplineSurface, EdgeError, insert_knots, measure_contact
from semispline.solver.judge import check_regular_edge
from semispline.solver.judge.edge_normals import places_without_normal

K1, K3 = [0, 0, 1, 1], [0, 0, 0, 0, 1, 1, 1, 1]


def cusp(at, least=0.0):
    """The edge u0 runs along y with a speed of (v - at)^2 + least: a cubic in Bezier form; straight and even in u."""
    # y = (v - at)^3 / 3 + least v + constant; powers to Bezier by blossoms.
    powers = np.array([0.0, at**2 + least, -at, 1 / 3])
    bezier = [powers[0], powers[1] / 3, 2 * powers[1] / 3 + powers[2] / 3, powers.sum()]
    return BSplineSurface(1, 3, K1, K3, [[[x, y, 0.0] for y in bezier] for x in (0.0, 1.0)])


def fan(at, least=0.0):
    """Rows from the edge x = 0 along x, as long as |v - at| or so: a square, so that it is polynomial."""
    v, q = np.array([0.0, 0.5, 1.0]), np.array([at**2, at**2 - at, (1 - at) ** 2]) + least
    net = [[[x * length, y, 0.0] for y, length in zip(v, q, strict=True)] for x in (0.0, 1.0)]
    return BSplineSurface(1, 2, K1, [0, 0, 0, 1, 1, 1], net)


@pytest.mark.parametrize("at", [0.0, 0.211, 0.5, 0.77, 1.0])
@pytest.mark.parametrize(("surface", "what"), [(cusp, "along the edge vanishes"), (fan, "across the edge vanishes")])
def test_the_place_is_found_between_samples_too(surface, what, at):
    (place,) = places_without_normal(Base(surface(at), "u0"), "a")
    assert place.reason.endswith(what)
    # Where a speed has a double zero the place is known to the root of what the speed is.
    assert place.parameter == pytest.approx(at, abs=1e-4)
    assert place.fraction <= 1e-7
    with pytest.raises(EdgeError, match="no normal at parameter"):
        check_regular_edge(Base(surface(at), "u0"))


def test_parallel_derivatives():
    # Across the edge x runs with y, and turns away on both sides of the middle.
    heights = np.array([1.0, -1.0, 1.0])
    net = [[[0.0, y, 0.0] for y in (0, 0.5, 1)], [[x, 1 + y, 0.0] for x, y in zip(heights, (0, 0.5, 1), strict=True)]]
    surface = BSplineSurface(1, 2, K1, [0, 0, 0, 1, 1, 1], net)
    # x_w = ((2 v - 1)^2, 1, 0).
    (place,) = places_without_normal(Base(surface, "u0"), "b")
    assert place.surface == "b"
    assert place.parameter == pytest.approx(0.5, abs=1e-3)
    assert "parallel" in place.reason


# The mean of (v - 1/2)^2 + least is 1/12 + least, over samples a little more.
@pytest.mark.parametrize(("part", "found"), [(0.7e-3, 1), (1.4e-3, 0)])
@pytest.mark.parametrize("surface", [cusp, fan])
def test_a_thousandth_of_the_mean_counts_as_none(surface, part, found):
    assert len(places_without_normal(Base(surface(0.43, part * 0.088), "u0"), "a")) == found


@pytest.mark.parametrize(("part", "refused"), [(1e-11, True), (5e-10, True), (2e-9, False), (5e-4, False)])
def test_only_what_vanishes_altogether_is_refused(part, refused):
    base = Base(fan(0.4375, part * 0.088), "u0")
    assert len(places_without_normal(base, "a")) == 1
    if refused:
        with pytest.raises(EdgeError, match="no normal at parameter"):
            check_regular_edge(base)
    else:
        check_regular_edge(base)


def test_sines_of_a_thousandth_count_as_none():
    for sine, found in ((0.7e-3, 1), (1.4e-3, 0)):
        net = [[[0.0, 0, 0], [0, 1, 0]], [[sine, 1.0, 0], [1, 1, 0]]]
        assert len(places_without_normal(Base(BSplineSurface(1, 1, K1, K1, net), "u0"), "a")) == found


@pytest.mark.parametrize("edge", ["u0", "u1", "v0", "v1"])
@pytest.mark.parametrize("backwards", [False, True])
def test_on_every_edge(edge, backwards):
    surface = turned(cusp(0.211), edge, backwards)
    (place,) = places_without_normal(Base(surface, edge), "a")
    assert place.parameter == pytest.approx(1 - 0.211 if backwards else 0.211, abs=1e-4)


def test_two_places_are_named_in_order_and_a_stretch_once():
    wide = fan(0.3).control_points.copy()
    stuck = BSplineSurface(1, 2, K1, [0, 0, 0, 1, 1, 1], np.stack([wide[0], wide[0]]))
    (place,) = places_without_normal(Base(stuck, "u0"), "a")
    assert place.fraction == 0
    # (v - 0.2) (v - 0.8) changes its sign twice.
    q = [0.16, 0.16 - 0.5, 0.16]
    net = [[[x * length, y, 0.0] for y, length in zip((0, 0.5, 1), q, strict=True)] for x in (0.0, 1.0)]
    found = places_without_normal(Base(BSplineSurface(1, 2, K1, [0, 0, 0, 1, 1, 1], net), "u0"), "a")
    assert [place.parameter for place in found] == pytest.approx([0.2, 0.8], abs=1e-6)


@pytest.mark.long
def test_regular_edges_have_none():
    for seed in range(20):
        surface = patch(np.random.default_rng(seed), degrees=(3, 3), counts=(5, 7))
        for edge in ("u0", "u1", "v0", "v1"):
            assert places_without_normal(Base(surface, edge), "a") == ()
            check_regular_edge(Base(surface, edge))


def test_a_place_in_one_span_of_many_is_found():
    surface = insert_knots(cusp(0.4567), knots_v=np.linspace(0, 1, 400)[1:-1])
    (place,) = places_without_normal(Base(surface, "u0"), "a")
    assert place.parameter == pytest.approx(0.4567, abs=1e-4)


def test_contact_names_the_places_of_both_sides():
    a, b = cusp(0.211), turned(cusp(0.211), "u1", False)
    contact = measure_contact(Base(b, "u1"), Base(a, "u0"), flip="no")
    assert contact.angle_degrees == 180
    assert [place.surface for place in contact.no_normal] == ["a", "b"]


@pytest.mark.parametrize("narrow", [1e-1, 1e-3, 1e-4])
@pytest.mark.parametrize(("surface", "what"), [(cusp, "along the edge vanishes"), (fan, "across the edge vanishes")])
def test_the_place_is_found_in_and_beside_a_narrow_span(surface, what, narrow):
    for first in (0.43 - 0.3 * narrow, 0.43 - 1.3 * narrow):
        base = Base(insert_knots(surface(0.43), knots_v=[first, first + narrow]), "u0")
        (place,) = places_without_normal(base, "a")
        assert place.reason.endswith(what)
        assert place.parameter == pytest.approx(0.43, abs=1e-4)
        assert place.fraction <= 1e-7


@pytest.mark.parametrize("width", [1e-3, 1e-5])
def test_a_zero_in_a_span_that_is_narrow_beside_its_neighbour_is_found(width):
    # Across the edge 0.9, 0.4, then -9: zero a little after the knot, before the first sample of the narrow span.
    s, across = [0, 0.5, 0.5 + width, 1], [0.9, 0.4, -9.0, -9.0]
    net = [[[x, 0, 0] for x in s], [[x, y, 0] for x, y in zip(s, across, strict=True)]]
    base = Base(BSplineSurface(1, 1, [0, 0, 1, 1], [0, *s, 1], net), "u0")
    (place,) = places_without_normal(base, "a")
    assert place.parameter == pytest.approx(0.5 + width * 0.4 / 9.4, abs=1e-4 * width)


def test_a_simple_zero_is_found_to_a_billionth_wherever_it_is():
    """The edge runs along y and back, its speed v - at: what sections find there is less than counts as nothing."""
    for at in np.linspace(0.05, 0.95, 37):
        net = [[[x, y, 0.0] for y in (0.0, -at, 1 - 2 * at)] for x in (0.0, 1.0)]
        with pytest.raises(EdgeError, match="no normal at parameter"):
            check_regular_edge(Base(BSplineSurface(1, 2, K1, [0, 0, 0, 1, 1, 1], net), "u0"))
