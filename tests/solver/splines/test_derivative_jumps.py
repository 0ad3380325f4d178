"""Which derivatives exist: jumps are told from rounding at each knot by itself, whatever happens elsewhere."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import semispline
from helpers.splines import knot_vectors, scale
from helpers.sweeps import examples
from semispline import derivative_surface
from semispline.solver.errors import InputError
from semispline.solver.judge.de_boor import curve_points
from semispline.solver.splines.curves import elevate_curve, insert_curve_knots
from semispline.solver.splines.derivatives import derivative_curve
from semispline.solver.splines.operations import insert_knots, swap_directions
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

EPS = np.finfo(float).eps


def raised_at_half(gaps, height, base):
    """A parabola with a double knot at 1/2 whose point there is raised: the slope jumps by 8 `height`."""
    knots = np.array([0, 0, 0, *gaps, 0.5, 0.5, 1, 1, 1])
    points = np.zeros((len(knots) - 3, 3)) + base
    points[len(gaps) + 2, 2] += height
    return BSplineCurve(2, knots, points)


def forms(curve):
    """The curve, and surfaces (with the order of derivative that meets it) whose rows are the curve."""
    net = np.stack([curve.control_points, curve.control_points + np.array([1.0, 0, 0])])
    surface = BSplineSurface(1, curve.degree, [0, 0, 1, 1], curve.knots, net)
    across = SemiStructuredSurface(
        curve.degree,
        curve.knots,
        [BSplineCurve(1, [0, 0, 1, 1], [p, p + np.array([0, 1, 0])]) for p in curve.control_points],
    )
    return [
        lambda order: derivative_curve(curve, order),
        lambda order: derivative_surface(surface, 0, order),
        lambda order: derivative_surface(swap_directions(surface), order, 0),
        lambda order: derivative_surface(surface.to_semistructured(), 0, order),
        lambda order: derivative_surface(across, order, 0),
    ]


@pytest.mark.parametrize("gaps", [(), (1e-3,), (1e-6,)])
@pytest.mark.parametrize("form", range(5))
def test_rounding_of_the_control_points_is_forgiven_and_sixteen_times_it_is_not(gaps, form):
    # Nothing else than a constant of size 1 (2 where a surface shifts it): what may be off is its rounding alone.
    forms(raised_at_half(gaps, 6 * EPS, [1.0, 0, 0]))[form](1)
    with pytest.raises(InputError, match="jumps by"):
        forms(raised_at_half(gaps, 60 * EPS, [1.0, 0, 0]))[form](1)


@pytest.mark.parametrize(
    ("form", "cure"),
    list(enumerate(["split_curve the curve", *["split_v the surface", "split_u the surface"] * 2])),
)
def test_the_message_names_a_cure_for_what_was_given(form, cure):
    """The cure is public, takes the knot that the message names, and leaves pieces that have the derivative."""
    curve = raised_at_half((), 1.0, [0.0, 0, 0])
    with pytest.raises(InputError, match=rf"at [uv] = 0\.5; {cure} there"):
        forms(curve)[form](1)
    assert hasattr(semispline, cure.split()[0])
    for piece in semispline.split_curve(curve, 0.5):
        forms(piece)[form](1)


@pytest.mark.parametrize("form", range(5))
@pytest.mark.parametrize("gaps", [(), (1e-3,)])
def test_a_jump_is_refused_by_its_size_next_to_the_derivative_there(form, gaps):
    # Slope 1 along x on both sides, and a jump of its share along z.
    def curve(jump):
        flat = raised_at_half(gaps, jump / 8, [0.0, 0, 0])
        greville = np.convolve(flat.knots[1:-1], [0.5, 0.5], mode="valid")
        return BSplineCurve(2, flat.knots, flat.control_points + np.outer(greville, [0, 1.0, 0]))

    forms(curve(3e-11))[form](1)
    with pytest.raises(InputError, match=r"jumps by 3e-10 at [uv] = 0.5"):
        forms(curve(3e-10))[form](1)


@pytest.mark.parametrize(("degree", "order", "jump"), [(3, 2, 5e-8), (5, 3, 1e-5), (6, 4, 1e-3)])
def test_a_narrow_span_elsewhere_does_not_hide_a_jump(degree, order, jump):
    knots = [0] * (degree + 1) + [1] * (degree + 1)
    line = np.column_stack([np.linspace(0, 1, degree + 1)] * 2 + [np.zeros(degree + 1)])
    curve = insert_curve_knots(BSplineCurve(degree, knots, line), [1e-3] + [0.5] * (degree - order + 1))
    points = curve.control_points.copy()
    at = int(np.argmin([abs(curve.knots[j + 1 : j + degree + 1].mean() - 0.5) for j in range(len(points))]))

    def bent(height):
        moved = points + np.eye(len(points))[at][:, None] * [0, 0, height]
        sides = np.array([np.nextafter(0.5, 0), 0.5])
        below, above = curve_points(degree, curve.knots, moved, sides, order)
        return BSplineCurve(degree, curve.knots, moved), abs(above - below)[2]

    _, unit = bent(1.0)
    creased, found = bent(jump / unit)
    assert found == pytest.approx(jump, rel=1e-3)
    with pytest.raises(InputError, match=rf"derivative of order {order}.* jumps by"):
        derivative_curve(creased, order)


@examples(60)
@given(
    st.integers(2, 5).flatmap(lambda p: st.tuples(st.just(p), knot_vectors(p))),
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.0, 1.0, 1e6]),
    st.integers(0, 2),
)
def test_knots_that_can_be_removed_never_stop_a_derivative(given, seed, offset, by):
    degree, knots = given
    rng = np.random.default_rng(seed)
    inner = np.unique(knots[degree + 1 : -degree - 1])
    simple = np.concatenate([knots[: degree + 1], inner, knots[-degree - 1 :]])
    curve = BSplineCurve(degree, simple, rng.uniform(-1, 1, (len(simple) - degree - 1, 3)) + offset)
    at, beside = rng.uniform(0.01, 0.99), rng.uniform(0.01, 0.99)
    finer = insert_curve_knots(elevate_curve(curve, degree + by), [at] * (degree + by) + [beside])
    rows = [BSplineCurve(finer.degree, finer.knots, finer.control_points + np.array([0, x, 0])) for x in range(3)]
    surface = SemiStructuredSurface(2, [0, 0, 0, 1, 1, 1], rows)
    x = rng.uniform(0, 1, 9)
    for order in range(1, degree):
        expected = curve_points(degree, simple, curve.control_points - offset, x, order)
        limit = 1e-12 * scale(BSplineSurface(1, degree, [0, 0, 1, 1], simple, [curve.control_points] * 2), 0, order)
        # Rounding of what was inserted, through the spans that the new knots made.
        narrow = np.diff(np.unique(finer.knots)).min()
        limit += 100 * EPS * (1 + offset) * (2 * finer.degree / narrow) ** order
        assert np.abs(derivative_curve(finer, order).evaluate(x) - expected).max() <= limit
        assert derivative_surface(surface, 0, order).degree_v == max(finer.degree - order, 1)
        derivative_surface(insert_knots(surface, [at, at]), 1, order)
