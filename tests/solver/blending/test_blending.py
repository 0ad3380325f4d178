"""The whole solve on random and degenerate bases, judged by the referee and by Open CASCADE."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.bases import FACING, facing_pair, moved, patch, turned
from helpers.occ import analyse, edge_point
from helpers.papers_set import blend
from helpers.sweeps import examples
from semispline import Base, BSplineSurface, ContactError, EdgeError, OptionError, measure_turn
from semispline.solver.judge.de_boor import surface_points

EDGES = ("u0", "u1", "v0", "v1")


def base_at(surface, edge="u0", backwards=False):
    return Base(turned(surface, edge, backwards), edge)


@pytest.mark.long
@examples(40)
@given(
    st.integers(0, 10**6),
    st.tuples(st.sampled_from(EDGES), st.sampled_from(EDGES)),
    st.tuples(st.booleans(), st.booleans()),
    st.integers(0, 2),
    st.booleans(),
)
def test_contact_of_random_bases(seed, edges, backwards, middle_curves, planar):
    a, b = facing_pair(np.random.default_rng(seed), edges=edges, backwards=backwards, planar=planar)
    c2 = blend(a, b, continuity="C2", middle_curves=middle_curves)
    assert c2.flipped == (backwards[0] != backwards[1])
    for contact in (c2.contact_a, c2.contact_b):
        assert contact.gap <= 1e-14
        assert contact.c1_residual < 1e-11
        assert contact.c2_residual < 1e-11
    for method in ("reduced", "casadi"):
        g2 = blend(a, b, continuity="G2", middle_curves=middle_curves, method=method)
        for contact in (g2.contact_a, g2.contact_b):
            assert contact.angle_degrees < 1e-9
            assert contact.curvature_jump_relative < 1e-9
    c0 = blend(a, b, continuity="C0", middle_curves=middle_curves)
    for contact in (c0.contact_a, c0.contact_b):
        assert contact.gap <= 1e-14
    assert c0.energy <= g2.energy * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_open_cascade_confirms_g2(seed):
    a, b = facing_pair(np.random.default_rng(seed), planar=seed == 0)
    result = blend(a, b)
    surface = result.surface.to_bspline()
    for s in (0.0, 0.013, 0.37, 0.71, 1.0):
        for base, edge, t in ((a, "u0", s), (b, "u1", 1 - s if result.flipped else s)):
            judged = analyse(
                base.surface, edge_point(base.surface, base.edge, t), surface, edge_point(surface, edge, s)
            )
            assert judged.IsG2()
            assert np.degrees(judged.G1Angle()) < 1e-9
            # Its gap is absolute, 1/length; the bases are of size 1 and curvature of order 1.
            assert judged.G2CurvatureGap() < 1e-9


def test_open_cascade_would_see_a_miss():
    a, b = facing_pair(np.random.default_rng(1))
    surface = blend(a, b, continuity="C1").surface.to_bspline()
    judged = analyse(a.surface, edge_point(a.surface, a.edge, 0.37), surface, edge_point(surface, "u0", 0.37))
    assert judged.IsG1()
    assert not judged.IsG2()


def test_blend_leaves_the_bases_outwards():
    a, b = facing_pair(np.random.default_rng(7), edges=("u0", "u0"), backwards=(False, False))
    result = blend(a, b)
    # Bases occupy x > 0 and x < -1; the blend leaves both into the gap.
    x = surface_points(result.surface, [0.02, 0.98], [np.mean(result.surface.domain[1])] * 2)[:, 0]
    on_a, on_b = (surface_points(result.surface, [u], [np.mean(result.surface.domain[1])])[0, 0] for u in (0, 1))
    assert x[0] < on_a
    assert x[1] > on_b


def test_the_contact_curves_are_the_bases_own_to_the_last_bit():
    a, b = facing_pair(np.random.default_rng(11), edges=("u0", "u1"), backwards=(False, False))
    curves = blend(a, b).surface.control_curves
    np.testing.assert_array_equal(curves[0].control_points, a.surface.control_points[0])
    np.testing.assert_array_equal(curves[-1].control_points, b.surface.control_points[-1])
    np.testing.assert_array_equal(curves[1].knots, a.surface.knots_v)
    assert len(curves[5].control_points) == b.surface.control_points.shape[1]


def test_no_knot_is_inserted_in_either_base():
    a, b = facing_pair(np.random.default_rng(11), edges=("u0", "u0"))
    result = blend(a, b, middle_curves=0)
    surfaces = [base.surface for base in (a, b)]
    degree = max(s.degree_v for s in surfaces)
    # The lower degree is elevated: one more control point for each of its spans.
    counts = [s.control_points.shape[1] + (degree - s.degree_v) * (len(np.unique(s.knots_v)) - 1) for s in surfaces]
    assert result.surface.n_control_points == 3 * sum(counts)


@pytest.mark.parametrize("degree_across", [1, 2])
def test_a_base_of_low_degree_and_few_rows_is_no_special_case(degree_across):
    rng = np.random.default_rng(2)
    a = patch(rng, degrees=(degree_across, 3), counts=(degree_across + 1, 6))
    b = moved(patch(rng, degrees=(1, 3), counts=(2, 8)), FACING, (-1, 0, 0.3))
    for continuity in ("C2", "G2"):
        result = blend(Base(a, "u0"), Base(b, "u0"), continuity=continuity)
        assert result.contact_a.curvature_jump_relative < 1e-9
        assert result.contact_b.curvature_jump_relative < 1e-9


@pytest.mark.parametrize("degree_u", [2, 3, 4, 5])
def test_degree_of_the_blend(degree_u):
    a, b = facing_pair(np.random.default_rng(4))
    result = blend(a, b, degree_u=degree_u)
    assert result.surface.degree_u == degree_u
    assert result.contact_a.angle_degrees < 1e-9


def test_collinear_planes_need_no_bending():
    # Two pieces of one plane, straight parameter lines: the flat blend has no curvature.
    k = [0, 0, 1, 1]
    a = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    b = BSplineSurface(1, 1, k, k, [[[2, 0, 0], [2, 1, 0]], [[3, 0, 0], [3, 1, 0]]])
    result = blend(Base(a, "u1"), Base(b, "u0"))
    assert result.energy == pytest.approx(0, abs=1e-12)
    assert result.alpha2 == pytest.approx(1, rel=1e-5)
    assert result.contact_a.curvature_jump == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("factor", [1e-4, 1e3])
def test_parameter_speed_of_the_bases_does_not_matter(factor):
    a, b = facing_pair(np.random.default_rng(9), edges=("u0", "u0"), backwards=(False, False))
    s = a.surface
    fast = BSplineSurface(s.degree_u, s.degree_v, s.knots_u * factor, s.knots_v, s.control_points)
    plain, scaled = blend(a, b), blend(Base(fast, "u0"), b)
    # R_w is divided by the factor, so alpha^2 is multiplied by it.
    assert scaled.alpha2 == pytest.approx(plain.alpha2 * factor, rel=1e-6)
    assert scaled.energy == pytest.approx(plain.energy, rel=1e-9)


@pytest.mark.long
def test_an_active_bound_is_reported():
    found = [blend(*facing_pair(np.random.default_rng(seed))) for seed in range(9, 15)]
    active = [result for result in found if result.active_bounds]
    assert active
    for result in active:
        for bound in result.active_bounds:
            name, end = bound.split()
            low, high = getattr(result, f"{name}_bounds")
            assert getattr(result, name) == pytest.approx(low if end == "lower" else high, rel=1e-5)


def test_mixed_continuity():
    a, b = facing_pair(np.random.default_rng(6))
    result = blend(a, b, continuity=("G2", "C1"))
    assert result.alpha2_bounds is not None
    assert result.beta2_bounds is None
    assert result.beta2 == 1
    assert result.contact_a.curvature_jump_relative < 1e-9
    assert result.contact_b.c1_residual < 1e-11


def test_forced_direction_twists():
    a, b = facing_pair(np.random.default_rng(6), backwards=(False, False))
    straight, twisted = blend(a, b), blend(a, b, flip="yes")
    assert not straight.flipped
    assert twisted.flipped
    assert twisted.energy > straight.energy


def test_free_rows_are_stationary_for_the_referee():
    a, b = facing_pair(np.random.default_rng(8), edges=("u0", "u0"), backwards=(False, False))
    surface = blend(a, b, continuity="C2").surface
    x, w = np.polynomial.legendre.leggauss(5)
    (u, w_u), (v, w_v) = (
        (
            ((k[:-1, None] + k[1:, None]) / 2 + np.diff(k)[:, None] / 2 * x).ravel(),
            (np.diff(k)[:, None] / 2 * w).ravel(),
        )
        for k in surface.breakpoints
    )
    uu, vv = (g.ravel() for g in np.meshgrid(u, v, indexing="ij"))
    weights = np.outer(w_u, w_v).ravel()
    middle = surface.control_curves[3]
    for j in range(len(middle.control_points)):
        # First variation of (11) in the direction of one control point of the middle curve, by plain quadrature.
        direction = np.zeros_like(middle.control_points)
        direction[j, 2] = 1.0
        bump = _with_curve(surface, 3, direction)
        terms = [
            f * np.sum(surface_points(surface, uu, vv, du, 2 - du) * surface_points(bump, uu, vv, du, 2 - du), axis=1)
            for f, du in ((1, 2), (2, 1), (1, 0))
        ]
        total = float(weights @ sum(terms))
        magnitude = float(weights @ sum(np.abs(t) for t in terms))
        assert abs(total) < 1e-11 * magnitude


def _with_curve(surface, index, points):
    """The same spaces with all control points zero but those of one curve."""
    from semispline import BSplineCurve, SemiStructuredSurface

    curves = [
        BSplineCurve(c.degree, c.knots, points if i == index else np.zeros_like(c.control_points))
        for i, c in enumerate(surface.control_curves)
    ]
    return SemiStructuredSurface(surface.degree_u, surface.knots_u, curves)


def flat(x0=0.0, z=0.0):
    k = [0, 0, 1, 1]
    return BSplineSurface(1, 1, k, k, [[[x0, 0, z], [x0, 1, z]], [[x0 + 1, 0, z], [x0 + 1, 1, z]]])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"continuity": "C3"}, "continuity: found 'C3'"),
        ({"continuity": ("G2", "G2", "G2")}, "continuity: found 3 values, expected one or a pair"),
        ({"middle_curves": -1}, "middle_curves: found -1"),
        ({"middle_curves": 1.5}, "middle_curves: found 1.5"),
        ({"middle_curves": 10**6}, "middle_curves: found 1000000, expected at most 1000"),
        ({"continuity": None}, "continuity: found None"),
        ({"box": "ab"}, "box: found 'ab'"),
        ({"alpha": 1e300}, "alpha: found 1e"),
        ({"alpha": True}, "alpha: found True"),
        ({"method": "magic"}, "method: found 'magic'"),
        ({"degree_u": 9}, "degree_u: found 9"),
        ({"degree_u": 1}, "degree_u: found 1"),
        ({"alpha": -1.0}, "alpha: found -1, expected 1e-15 to"),
        ({"alpha": 10**400}, "alpha: found 1000"),
        ({"alpha": 1e80}, "alpha: found 1e+80"),
        ({"alpha": np.array([1.0, -2.0])}, "alpha: found -2"),
        ({"box": (1e-300, 1e300)}, "box: found (1e-300, 1e+300), expected 1e-20"),
        ({"box": (True, 8)}, "box[0]: found True"),
        ({"box": (1, 10**400)}, "box[1]: found 1000"),
        ({"method": np.array(["reduced", "casadi"])}, "method: found"),
        ({"strict": "yes"}, "strict: found 'yes'"),
        ({"strict": None}, "strict: found None"),
        ({"alpha": "wild"}, "alpha: found 'wild'"),
        ({"alpha": ("energy", 1.0, 1.0)}, "alpha: found 3 values"),
        ({"box": (0.0, 1.0)}, "box: found"),
        ({"box": (2.0, 1.0)}, "box: found"),
    ],
)
def test_options_are_refused(options, message):
    with pytest.raises(OptionError, match=re.escape(message)):
        blend(Base(flat(), "u1"), Base(flat(3, 1), "u0"), **options)


def test_bases_are_refused():
    same_weights = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], flat().control_points, np.full((2, 2), 3.0))
    assert blend(Base(same_weights, "u1"), Base(flat(3, 1), "u0")).contact_a.angle_degrees < 1e-9
    with pytest.raises(EdgeError, match="coincide"):
        blend(Base(flat(), "u1"), Base(flat(1), "u0"))
    with pytest.raises(OptionError, match="flip: found 'maybe'"):
        blend(Base(flat(), "u1"), Base(flat(3), "u0"), flip="maybe")
    point = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[3, 0, 0], [3, 0, 0]], [[4, 0, 0], [4, 1, 0]]])
    with pytest.raises(EdgeError, match="zero length"):
        blend(Base(flat(), "u1"), Base(point, "u0"))
    stuck = BSplineSurface(
        2, 1, [0, 0, 0, 1, 1, 1], [0, 0, 1, 1], [[[3, y, 0] for y in (0, 1)]] * 2 + [[[4, y, 0] for y in (0, 1)]]
    )
    with pytest.raises(EdgeError, match="cross derivative vanishes"):
        blend(Base(flat(), "u1"), Base(stuck, "u0"))


def test_a_missed_contact_raises(monkeypatch):
    # Break the generated contact rows: the referee must notice.
    from semispline.solver.generated import contact_numpy

    right = contact_numpy.contact_rows_2

    def wrong(*args):
        rows = right(*args).copy()
        rows[2, 0] += 1e-6
        rows[2, 1] -= 1e-6
        return rows

    monkeypatch.setattr(contact_numpy, "contact_rows_2", wrong)
    with pytest.raises(ContactError, match="contact a: c2_residual"):
        blend(*facing_pair(np.random.default_rng(0)), continuity="C2")


def test_a_blend_that_leaves_into_the_base_raises(monkeypatch):
    # The sign of (17) as printed: tangent planes and curvatures agree, but the blend folds back over the base.
    from semispline.solver.generated import contact_numpy

    right = contact_numpy.contact_rows_2
    monkeypatch.setattr(contact_numpy, "contact_rows_2", lambda a, *spans: right(-a, *spans))
    with pytest.raises(ContactError, match="contact a: angle_degrees is 180"):
        blend(*facing_pair(np.random.default_rng(0)), alpha=1.0)


def test_a_smooth_blend_turns_little():
    a, b = facing_pair(np.random.default_rng(0), planar=True)
    assert measure_turn(blend(a, b).surface).degrees < 20
