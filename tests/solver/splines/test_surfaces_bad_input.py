"""What the constructors refuse: each message names the value at fault by its index, and what would be right."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from semispline.solver.errors import ControlPointError, InputError, KnotError, SemisplineError
from semispline.solver.splines.refinement import clamp_knots
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

UNIT = [0, 0, 1, 1]
SQUARE = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]
LINE = [[0, 0, 0], [0, 1, 0]]


def surface(**changes):
    arguments = {
        "degree_u": 1, "degree_v": 1, "knots_u": UNIT, "knots_v": UNIT, "control_points": SQUARE, "weights": None,
    }  # fmt: skip
    return BSplineSurface(**(arguments | changes))


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"knots_u": [0, 0, 1]}, KnotError, r"knots_u: 3 knots for 2 control points of degree 1, expected 4"),
        ({"knots_v": [0, 0, 1, float("nan")]}, KnotError, r"knots_v\[3\]: found nan, expected a finite number"),
        ({"knots_v": [0, 0.5, 1, 1]}, KnotError, r"knots_v\[0\]: found 0.0, expected 0.5: the first 2 knots"),
        ({"knots_v": [0, 0, 1, 2]}, KnotError, r"knots_v\[3\]: found 2.0, expected 1.0: the last 2 knots"),
        ({"knots_u": [0, 1, 0, 1]}, KnotError, r"knots_u\[2\]: 0.0 after 1.0, expected a non-decreasing"),
        ({"knots_u": [1, 1, 1, 1]}, KnotError, r"knots_u: the domain \[1.0, 1.0\] is empty"),
        ({"knots_u": [0, 0, "x", 1]}, KnotError, r"knots_u\[2\]: found 'x', expected a real number"),
        ({"knots_u": "abcd"}, KnotError, r"knots_u\[0\]: found 'a'"),
        ({"knots_u": None}, KnotError, r"knots_u: has 0 dimension"),
        ({"degree_u": 0}, KnotError, r"knots_u: degree is 0, expected a whole number of at least 1"),
        ({"degree_v": 1.0}, KnotError, r"knots_v: degree is 1.0, expected a whole number"),
        ({"degree_v": True}, KnotError, r"knots_v: degree is True"),
        ({"degree_v": None}, KnotError, r"knots_v: degree is None"),
        ({"degree_u": 10**30}, KnotError, r"knots_u: 2 control point\(s\) for degree 1000"),
        ({"control_points": []}, ControlPointError, r"control_points: has 1 dimension\(s\), expected 3"),
        ({"control_points": np.zeros((2, 2, 4))}, ControlPointError, r": 4 coordinate\(s\), expected 3, or 2"),
        ({"control_points": np.zeros((0, 2, 3))}, KnotError, r"knots_u: 0 control point\(s\)"),
        ({"control_points": [SQUARE[0], [[1, 0, 0]]]}, ControlPointError, r"control_points\[1\]: 1 entries"),
        ({"control_points": [SQUARE[0], [[1, 0, 0], [1, 0]]]}, ControlPointError, r"control_points\[1, 1\]: 2 entries"),
        ({"control_points": [SQUARE[0], [[1, 0, 0], 7]]}, ControlPointError, r"control_points\[1, 1\]: found 7"),
        ({"control_points": [SQUARE[0], [[1, 0, 0], [1, 1, 1j]]]}, ControlPointError, r"control_points\[1, 1, 2\]"),
        ({"control_points": [SQUARE[0], [[1, 0, 0], [1, 10**400, 1]]]}, ControlPointError, r"\[1, 1, 1\]: found 1000"),
        ({"control_points": np.full((2, 2, 3), np.inf)}, ControlPointError, r"control_points\[0, 0, 0\]: found inf"),
        ({"weights": [[1, 1]]}, ControlPointError, r"weights: shape \(1, 2\), expected \(2, 2\)"),
        ({"weights": [[1, 1], [1, 0]]}, ControlPointError, r"weights\[1, 1\]: found 0.0, expected a positive"),
        ({"weights": [[1, -2], [1, 0]]}, ControlPointError, r"weights\[0, 1\]: found -2.0"),
        ({"weights": [[1, 1], [1, float("inf")]]}, ControlPointError, r"weights\[1, 1\]: found inf"),
    ],
)  # fmt: skip
def test_a_surface_says_what_is_wrong_and_where(changes, error, message):
    with pytest.raises(error, match=message):
        surface(**changes)


def test_inner_multiplicities_are_limited_by_the_degree():
    points = np.zeros((5, 3))
    assert BSplineCurve(1, [0, 0, 0.3, 0.5, 0.7, 1, 1], points).degree == 1
    with pytest.raises(KnotError, match=r"knots\[3\]: knot 0.5 has multiplicity 2, expected at most 1 \(split"):
        BSplineCurve(1, [0, 0, 0.3, 0.5, 0.5, 1, 1], points)
    with pytest.raises(KnotError, match=r"knots\[4\]: knot 1.0 has multiplicity 3, expected at most 2 \(clamped_"):
        BSplineCurve(1, [0, 0, 0.3, 0.5, 1, 1, 1], points)
    # What the hint names does take them.
    knots, net = clamp_knots(1, [0, 0, 0.3, 0.5, 1, 1, 1], np.column_stack([np.arange(5.0), np.ones((5, 2))]))
    assert (knots.tolist(), net[:, 0].tolist()) == ([0, 0, 0.3, 0.5, 1, 1], [0, 1, 2, 3])


def test_curves_of_a_semistructured_surface_are_named():
    line = BSplineCurve(1, UNIT, LINE)
    with pytest.raises(ControlPointError, match=r"control_curves\[1\]: found a list, expected a BSplineCurve"):
        SemiStructuredSurface(1, UNIT, (line, LINE))
    with pytest.raises(
        ControlPointError, match=r"control_curves\[1\]: v-domain \(0.0, 2.0\), expected that of curve 0"
    ):
        SemiStructuredSurface(1, UNIT, (line, BSplineCurve(1, [0, 0, 2, 2], LINE)))
    with pytest.raises(KnotError, match=r"knots_u: 4 knots for 3 control points"):
        SemiStructuredSurface(1, UNIT, (line, line, line))
    with pytest.raises(KnotError, match=r"knots_u: 0 control point"):
        SemiStructuredSurface(1, UNIT, ())
    with pytest.raises(ControlPointError, match=r"control_curves\[7\].control_points\[1, 2\]: found nan"):
        BSplineCurve(1, UNIT, [[0, 0, 0], [0, 1, np.nan]], name="control_curves[7]")


@pytest.mark.parametrize(
    ("u", "v", "message"),
    [
        ([0.5, 1.1], [0.5, 0.5], r"u\[1\]: found 1.1, expected a parameter in \[0.0, 1.0\]"),
        ([0.5], [float("nan")], r"v\[0\]: found nan"),
        ([0.5, 0.5], [0.5, 0.5, 0.5], r"v: 3 parameters, expected as many as u has, 2"),
        ([[0.5]], [0.5], r"u: 2 dimensions, expected a one-dimensional"),
        (["a"], [0.5], r"u: found .'a'., not an array of real numbers"),
    ],
)
def test_parameters_are_checked(u, v, message):
    with pytest.raises(InputError, match=message):
        surface().evaluate(u, v)


def test_values_cannot_be_changed_afterwards():
    made = surface()
    with pytest.raises(AttributeError):
        made.degree_u = 2
    with pytest.raises(ValueError, match="read-only"):
        made.control_points[0, 0, 0] = 1
    net = np.array(SQUARE, dtype=float)
    made = surface(control_points=net)
    net[:] = 9
    assert made.control_points.max() == 1


JUNK = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=3)),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=2), inner, max_size=2),
    max_leaves=12,
)


@pytest.mark.long
@settings(max_examples=200, deadline=None)
@given(st.sampled_from(["degree_u", "knots_u", "control_points", "weights"]), JUNK)
def test_junk_is_refused_or_makes_a_surface_but_never_breaks(field, junk):
    try:
        made = surface(**{field: junk})
    except SemisplineError:
        return
    assert made.control_points.shape == (2, 2, 3)
