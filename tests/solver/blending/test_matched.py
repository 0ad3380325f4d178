"""What answers what: equal shares of length, named points; exact in contact, monotone, moved as a known map says."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import cumulative_simpson

from helpers.chains import (
    arc,
    box,
    circle,
    flanges,
    line,
    lines_inside,
    moved,
    oval,
    rounded_square,
    run_through,
    seen_on_faces,
    walls,
)
from helpers.facing import random_facing
from helpers.sweeps import examples, first_ones, first_rows
from semispline import Base, OptionError, blend, chain
from semispline.solver.blending.matched_maps import point_map
from semispline.solver.splines import Basis, boundary_curve, closest_point

PLAIN = {"alpha": "natural", "p2": "zero"}
TILT = np.array([[1, 0, 0], [0, np.cos(0.2), -np.sin(0.2)], [0, np.sin(0.2), np.cos(0.2)]])
PROFILE = rounded_square((4.0, 3.0), (1.0, 1.4, 1.2, 0.8))
TUBE = moved(walls(circle(2.5, (0, 90, 180, 270, 360)), height=2.0), TILT, (0, 0, 4.0))
OPEN = [line((-6, 0), (-2, 0)), arc((-2, 2), 2.0, -90, 0), line((0, 2), (0, 6))]
# Roundings of points of size 10, of maps and of feet on them.
MET = 1e-11
# Shares of the length, as the design has them.
SHARES = 1e-3


def ends(result):
    return boundary_curve(result.surface, "u0"), boundary_curve(result.surface, "u1")


def place(faces, x):
    """The point of a chain at the share x - k of its edge k."""
    k = min(int(x), len(faces) - 1)
    curve = boundary_curve(faces[k].surface, "u0")
    low, high = curve.knots[[0, -1]]
    return curve.evaluate(np.array([low + (x - k) * (high - low)]))[0]


def missed(result, faces, others, pairs):
    """How far the section that begins at the first place of each pair ends from the second one."""
    first, last = ends(result)
    found = []
    for x, y in pairs:
        v = np.ravel(closest_point(first, place(faces, x)).parameters)[:1]
        found.append(float(np.linalg.norm(last.evaluate(v)[0] - place(others, y))))
    return max(found)


def shares(curve, v):
    """Shares of the length before each v, by a rule of SciPy on speeds."""
    dense = np.linspace(*curve.knots[[0, -1]], 8001)
    speed = np.linalg.norm(np.gradient(curve.evaluate(dense), dense, axis=0, edge_order=2), axis=1)
    length = cumulative_simpson(speed, x=dense, initial=0)
    return np.interp(v, dense, length / length[-1])


def unequal(result):
    v = np.linspace(*result.surface.domain[1], 201)
    return float(np.abs(np.subtract(*(shares(curve, v) for curve in ends(result)))).max())


@pytest.mark.parametrize("continuity", first_ones(1, ["G3", "G2", "G4"]))
@pytest.mark.parametrize("skew", [0.3, -0.4])
def test_a_known_map_is_what_is_blended(skew, continuity):
    """Two pairs and the ends say a cubic: the blend is that of the base run through by it."""
    a, b = (Base(base.surface, "u0") for base in random_facing(np.random.default_rng(7)))
    (low, high), (start, end) = a.range_along, b.range_along

    def cubic(t):
        return t + skew * t * (1 - t) * (1.3 - t)

    stations = np.array([0.3, 0.7])
    # Edge b runs against edge a, or with it: asked of the blend itself.
    flipped = blend(a, b, continuity=continuity, **PLAIN).flipped
    answers = 1 - cubic(stations) if flipped else cubic(stations)
    pairs = [(low + (high - low) * s, start + (end - start) * t) for s, t in zip(stations, answers, strict=True)]
    found = blend(a, b, continuity=continuity, match=pairs, **PLAIN)
    known = run_through(b, (lambda t: 1 - cubic(1 - t)) if flipped else cubic)
    expected = blend(a, known, continuity=continuity, **PLAIN)
    v = np.linspace(*found.surface.domain[1], 61)
    for u in (0.0, 0.3, 0.8, 1.0):
        apart = found.surface.evaluate(np.full(61, u), v) - expected.surface.evaluate(np.full(61, u), v)
        assert np.abs(apart).max() < MET
    assert found.contact_b.angle_degrees < 1e-9
    # Control: affinely it is another blend.
    plain = blend(a, b, continuity=continuity, **PLAIN)
    assert np.abs(found.surface.evaluate(np.ones(61), v) - plain.surface.evaluate(np.ones(61), v)).max() > 0.02


@pytest.mark.long
@pytest.mark.parametrize(
    ("faces", "others", "pairs"),
    first_rows(
        1,
        [
            # Rings to a tube, to an oval; one pair; open chains.
            (walls(circle(3.0, (0, 100, 230, 360))), TUBE, [(0.5, 0.25), (1.4, 1.7), (2.0, 2.5)]),
            (walls(OPEN), moved(walls(OPEN, height=2.0), None, (1, 0.3, 4)), [(0.5, 0.3), (1.5, 1.7), (2.5, 2.4)]),
            (walls(PROFILE), moved(flanges(oval(), width=1.0), None, (0, 0, 4)), [(0.5, 0.5), (2.5, 1.3), (6.5, 4.2)]),
            (walls(PROFILE), TUBE, [(2.5, 0.9)]),
            (walls(PROFILE), TUBE, [(0.5, 0.25), (3.5, 1.3), (6.0, 2.5)]),
            (walls(OPEN), moved(walls(OPEN, height=2.0), None, (1, 0.3, 4)), [(1.5, 0.4)]),
        ],
    ),
)
def test_named_points_answer_each_other(faces, others, pairs):
    a, b = chain(faces), chain(others)
    result = blend(a, b, match=pairs, **PLAIN)
    assert missed(result, faces, others, pairs) < MET
    if len(faces) != len(others):
        assert missed(blend(a, b, **PLAIN), faces, others, pairs) > 0.01
    assert lines_inside(result.surface).crease < 1e-9
    for edge, own in (("u0", faces), ("u1", others)):
        gap, angle, bend = seen_on_faces(result.surface, edge, own, count=1)
        assert gap < 1e-13
        assert angle < 1e-7
        assert bend < 1e-5
    # Forwards all the way, and nowhere at rest.
    v = np.linspace(*result.surface.domain[1], 401)
    speeds = np.linalg.norm(ends(result)[1].evaluate(v[1:]) - ends(result)[1].evaluate(v[:-1]), axis=1)
    assert speeds.min() > 0.02 * speeds.mean()


@pytest.mark.parametrize(
    ("faces", "others"),
    first_rows(
        1,
        [
            (walls(OPEN), moved(walls([line((-6, -1), (2, 6))], height=2.0), None, (0, 0, 4))),
            (walls(PROFILE)[:3], TUBE[:2]),
            (walls(PROFILE), TUBE),
            (walls(PROFILE), moved(flanges(oval(), width=1.0), None, (0, 0, 4))),
        ],
    ),
)
def test_equal_shares_of_length(faces, others):
    a, b = chain(faces), chain(others)
    result = blend(a, b, match="length", **PLAIN)
    assert unequal(result) < SHARES
    assert unequal(blend(a, b, **PLAIN)) > 2 * SHARES
    assert lines_inside(result.surface).crease < 1e-9
    gap, angle, _ = seen_on_faces(result.surface, "u1", others, count=1)
    assert gap < 1e-13
    assert angle < 1e-7


@pytest.mark.long
def test_between_corners_each_side_has_shares_of_its_own():
    faces = walls(box())
    others = [
        Base(run_through(x, lambda t: t + 0.4 * t * (1 - t)).surface, "u0") for x in walls(box(2, 1.5), height=2.0)
    ]
    others = moved(others, TILT, (0, 0, 4.0))
    a, b = chain(faces), chain(others)
    result = blend(a, b, match="length", **PLAIN)
    first, last = ends(result)
    corners = np.unique(first.knots)
    for low, high in pairwise(corners):
        v = np.linspace(low, high, 33)
        lengths = []
        for curve in (first, last):
            # All edges are straight.
            from_start = np.linalg.norm(curve.evaluate(v) - curve.evaluate(v[:1]), axis=1)
            lengths.append(from_start / from_start[-1])
        assert np.abs(lengths[0] - lengths[1]).max() < 2 * SHARES
    plain = blend(a, b, **PLAIN)
    middle = [curve.evaluate(np.array([(corners[0] + corners[1]) / 2]))[0] for curve in ends(plain)]
    edge = ends(plain)[1].evaluate(corners[:2])
    assert np.linalg.norm(middle[1] - edge[0]) / np.linalg.norm(edge[1] - edge[0]) == pytest.approx(0.6, abs=0.2)


@given(st.lists(st.tuples(st.floats(0.05, 0.95), st.floats(0.05, 0.95)), min_size=1, max_size=5), st.booleans())
@examples(150)
def test_maps_go_through_their_points_and_rise(pairs, closed):
    basis = Basis(1, np.array([0.0, 0.0, 1.0, 1.0]))
    x, y = (np.sort(np.unique(values)) for values in zip(*pairs, strict=True))
    count = min(len(x), len(y))
    x, y = x[:count], y[:count]
    if (np.diff(x) < 1e-3).any() or (np.diff(y) < 1e-3).any():
        return
    # Around the seam too, where the sides are closed.
    named = list(zip(x, np.mod(y + 0.4, 1.0) if closed else y, strict=True))
    function = point_map(named, basis, closed=closed).function
    t = np.linspace(0, 1, 501)
    values = function(t)
    assert (np.diff(values) > 0).all()
    assert function.derivative()(t).min() > 1e-3 * np.diff(values).min() / np.diff(t).max()
    assert values[-1] - values[0] == pytest.approx(1.0, abs=1e-12)
    for s, answer in named:
        apart = float(function(s)) - answer
        assert abs(apart - round(apart) if closed else apart) < 1e-12
    if closed:
        # As smooth at its seam as inside: C1.
        assert function.derivative()(0.0) == pytest.approx(float(function.derivative()(1.0)), rel=1e-7, abs=1e-9)


@pytest.mark.long
def test_what_is_refused():
    a, b = chain(walls(PROFILE)), chain(TUBE)
    with pytest.raises(OptionError, match="found 9 along a chain of 8 edges"):
        blend(a, b, match=[(9, 0.5)], **PLAIN)
    with pytest.raises(OptionError, match="cross or coincide"):
        blend(a, b, match=[(1.0, 0.1), (1.0, 0.2)], **PLAIN)
    with pytest.raises(OptionError, match="corners answer each other"):
        blend(
            chain(walls(box())),
            chain(moved(walls(box(2, 1.5), height=2.0), None, (0, 0, 4))),
            match=[(0.5, 0.25)],
            **PLAIN,
        )
    one, other = random_facing(np.random.default_rng(1))
    low, high = one.range_along
    with pytest.raises(OptionError, match=r"match\[0\]: found .* along edge a"):
        blend(one, other, match=[(high + 1, other.range_along[0])], **PLAIN)
    start, end = other.range_along
    crossing = [(low + (high - low) * s, start + (end - start) * t) for s, t in ((0.3, 0.7), (0.7, 0.3))]
    with pytest.raises(OptionError, match="cross or coincide"):
        blend(one, other, match=crossing, flip="no", **PLAIN)
