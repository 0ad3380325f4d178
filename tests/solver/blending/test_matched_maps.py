"""What answers what along two contacts: by shares of length and by pairs of points, exactly, and wherever it begins."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from helpers.chains import circle, lines_inside, oval, walls
from semispline import Base, BSplineSurface, OptionError, blend, boundary_curve, chain, closest_point
from semispline.solver.blending.matched_maps import point_map
from semispline.solver.splines import Basis

PLAIN = {"alpha": "natural", "p2": "zero"}
# Degrees, as for all chains; and places of size 6, found by Newton on curves of degree 18.
CREASE, PLACE = 1e-9, 1e-9
# Shares of the whole length that are to be equal are met to a thousandth.
SHARE = 1e-3
LINE = [0.0, 0.0, 1.0, 1.0]
CUBIC = [0.0] * 4 + [1.0] * 4


def strip(x, y, way):
    """A strip that leaves the line from (x, 0) to (x, 3), whose control points lie at the given y."""
    return Base(BSplineSurface(1, 3, LINE, CUBIC, [[[z, v, 0.2 * abs(z)] for v in y] for z in (x, x + way)]), "u0")


EVEN = strip(0.0, [0, 1, 2, 3], -1)
# y(v) = 0.9 v + 1.8 v^2 + 0.3 v^3, on paper.
UNEVEN = strip(4.0, [0, 0.3, 1.2, 3], 1)


def ends(result, v):
    surface = result.surface
    return [surface.evaluate(np.full(len(v), u), v) for u in surface.domain[0]]


def answer(result, point):
    """The place on b that a place on a leads to."""
    found = np.ravel(closest_point(boundary_curve(result.surface, "u0"), point).parameters)
    return ends(result, found)[1][0]


def shares(points):
    lengths = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    return lengths / lengths[-1]


@pytest.mark.parametrize("continuity", ["G1", "G2", "G3", "G4", "C2"])
def test_length_makes_the_lines_of_a_skewed_pair_parallel(continuity):
    skewed, straight = (blend(EVEN, UNEVEN, match=x, continuity=continuity, **PLAIN) for x in ("affine", "length"))
    v = np.linspace(0, 1, 41)
    a, b = ends(skewed, v)
    assert b[:, 1] == pytest.approx(0.9 * v + 1.8 * v**2 + 0.3 * v**3, abs=1e-12)
    assert np.abs(a[:, 1] - b[:, 1]).max() > 0.5
    a, b = ends(straight, v)
    assert np.abs(a[:, 1] - b[:, 1]).max() < 3 * SHARE
    # It costs three times the degree.
    assert straight.surface.control_curves[-1].degree == 3 * skewed.surface.control_curves[-1].degree == 9


@pytest.mark.parametrize("continuity", ["G1", "G2", "G4", "C2"])
def test_pairs_answer_each_other(continuity):
    pairs = [(0.25, 0.5), (0.75, 0.8)]
    result = blend(EVEN, UNEVEN, match=pairs, continuity=continuity, **PLAIN)
    for x, y in pairs:
        expected = [4, 0.9 * y + 1.8 * y**2 + 0.3 * y**3, 0.8]
        assert answer(result, [0, 3 * x, 0]) == pytest.approx(expected, abs=PLACE)
    assert np.diff(ends(result, np.linspace(0, 1, 200))[1][:, 1]).min() > 0


ROUND = walls(circle(2.5, np.arange(5) * 90.0), base=5.0, height=2.0)
OVAL = walls(oval())
RIMS = {"a chain of arcs": chain(ROUND), "turned": chain(ROUND[::-1])}


@pytest.mark.parametrize("rim", sorted(RIMS))
@pytest.mark.parametrize("continuity", ["G2", "G3"])
def test_pairs_answer_each_other_around_a_circle_that_is_cured(rim, continuity):
    """A smooth circle in the place of arcs runs by angle: what is matched is matched on that."""
    far = RIMS[rim]
    result = blend(chain(OVAL), far, match=[(0.5, 0.25), (3.5, 2.2)], continuity=continuity, flip="auto", **PLAIN)
    for x, y in ((0.5, 0.25), (3.5, 2.2)):
        places = []
        for one, at in ((chain(OVAL), x), (far, y)):
            k, back = int(at), one.turned[int(at)]
            v = at - k if not back else 1 - (at - k)
            places.append(one.edges[k].surface.evaluate([0.0], [v])[0])
        assert np.linalg.norm(answer(result, places[0]) - places[1]) < PLACE
    # The seam is as smooth as any other place.
    assert lines_inside(result.surface).crease < CREASE
    assert result.seam.angle_degrees < CREASE
    assert result.chain_a.limits == result.chain_b.limits == "exact"


def test_length_is_shared_around_a_circle_that_is_cured():
    affine, length = (blend(chain(OVAL), chain(ROUND), match=x, **PLAIN) for x in ("affine", "length"))
    v = np.linspace(*affine.surface.domain[1], 801)
    off = [np.abs(np.subtract(*map(shares, ends(result, v)))).max() for result in (affine, length)]
    assert off[0] > 10 * SHARE
    assert off[1] < SHARE
    assert lines_inside(length.surface).crease < CREASE


INCREASING = st.lists(st.floats(0.02, 0.98), min_size=1, max_size=4, unique=True).map(sorted)


@given(st.data(), st.booleans())
def test_maps_go_through_their_pairs_and_rise(data, closed):
    """Nowhere, ends included, do they stand still; around a seam they are smooth."""
    x = data.draw(INCREASING)
    y = data.draw(st.lists(st.floats(0.02, 0.98), min_size=len(x), max_size=len(x), unique=True).map(sorted))
    assume(min(np.diff([0, *x, 1])) > 0.01 and min(np.diff([0, *y, 1])) > 0.01)
    by, shift = point_map(list(zip(x, y, strict=True)), Basis(1, np.array(LINE)), closed=closed)
    assert np.mod(by.function(np.array(x)) + shift, 1.0) == pytest.approx(np.mod(y, 1.0), abs=1e-12)
    assert by.function(np.array([0.0, 1.0])) == pytest.approx([0, 1], abs=1e-12)
    slope = by.function.derivative()
    assert slope(np.linspace(0, 1, 1001)).min() > 0
    if closed:
        assert slope(1.0) == pytest.approx(slope(0.0), rel=1e-9)


def test_pairs_that_cross_are_refused():
    with pytest.raises(OptionError, match="pairs that cross or coincide"):
        blend(EVEN, UNEVEN, match=[(0.25, 0.8), (0.75, 0.3)], **PLAIN)
