"""The second document's code runs as printed, to its end or to a fault that names the line.

Whether it is right is decided by the records; here stand values that any reader can check by hand.
"""

from fractions import Fraction
from math import comb

import pytest
import sympy as sp

from semispline.papers.primer.printed import run
from semispline.papers.pseudocode import CodeFaultError


def point(*entries):
    return dict(zip("xyz", entries, strict=False))


THIRD = Fraction(1, 3)
POINTS = [point(0, 0), point(1, 2), point(3, 1), point(4, 4)]
# By hand: (0, 0) 8/27 + (1, 2) 12/27 + (3, 1) 6/27 + (4, 4) 1/27.
AT_THIRD = point(Fraction(34, 27), Fraction(34, 27))


def binomial(n, k):
    return comb(int(n), int(k))


def curve(x, y):
    return {"getXValue": x, "getYValue": y}


def result(identifier, call="", arguments=(), **given):
    return outcome_of(identifier, call, arguments, **given).value


def outcome_of(identifier, call, arguments, **given):
    names = [f"argument{n}" for n in range(len(arguments))]
    return run(identifier, f"{call}({', '.join(names)})", dict(zip(names, arguments, strict=True)) | given)


@pytest.mark.parametrize("identifier", ["decasteljau.1", "decasteljau.2", "splitting.1"])
def test_de_casteljau_draws_one_point(identifier):
    drawn = []
    outcome = outcome_of(identifier, "drawCurve", [POINTS, THIRD], draw=drawn.append)
    assert drawn == [AT_THIRD]
    if identifier == "splitting.1":
        left, right = outcome.variables["left"], outcome.variables["right"]
        assert (left[0], left[-1], right[-1], right[0]) == (POINTS[0], AT_THIRD, AT_THIRD, POINTS[3])
        assert len(left) == len(right) == 4


def test_the_table_of_binomials_grows():
    assert [result("explanation.11", "binomial", [n, k]) for n, k in ((6, 3), (7, 0), (9, 4))] == [20, 1, 126]


def test_sums_and_their_shortcuts():
    assert result("explanation.12", "Bezier", [3, THIRD], binomial=binomial) == 1
    assert [result("explanation.13", "Bezier", [n, THIRD]) for n in (2, 3)] == [1, 1]
    assert result("control.4", "Bezier", [2, THIRD, [1, 2, 3]]) == Fraction(5, 3)
    # One term short of the sum that it stands for.
    assert result("explanation.10", "Bezier", [3, THIRD]) == Fraction(26, 27)
    assert result("control.3", "Bezier", [1, THIRD, [3, 3]], binomial=binomial) == 2


def test_lines_meet():
    assert result("intersections.1", "lli8", [0, 0, 2, 2, 0, 2, 2, 0]) == point(1, 1)
    assert result("intersections.1", "lli8", [0, 0, 2, 2, 1, 1, 2, 2]) is False
    crossing = [{"p1": point(0, 0), "p2": point(2, 2)}, {"p1": point(0, 2), "p2": point(2, 0)}]
    assert result("intersections.1", "lli", crossing) == point(1, 1)


def test_flattening():
    parabola = curve(lambda t: t, lambda t: t * t)
    flat = result("flattening.1", "flattenCurve", [parabola, 2])
    # A list of numbers: printed brackets are missing that would make each two of them a point.
    assert flat == [0, 0, Fraction(1, 2), Fraction(1, 4), 1, 1]
    drawn = []
    result(
        "flattening.2",
        "drawFlattenedCurve",
        [parabola, 2],
        flattenCurve=lambda c, n: [1, 2, 3],
        line=lambda *a: drawn.append(a),
    )
    assert drawn == [(1, 2), (2, 3)]


def test_roots_of_a_cubic():
    exactly = {"approximately": lambda a, b: a == b}
    # t = 1/2 alone: control values of (t - 1/2)(t^2 + 1).
    (root,) = result("extremities.7", "getCubicRoots", [Fraction(-1, 2), Fraction(-1, 6), 0, 1], **exactly)
    # Roots of roots: equal to 40 digits is all that is asked here.
    assert abs(sp.N(root - sp.Rational(1, 2), 50)) < sp.Float("1e-40")


def test_the_section_of_a_knot_vector():
    outcome = run("bsplines.8", given={"domain": [3, 5], "knots": list(range(9)), "t": Fraction(9, 2)})
    assert outcome.variables == {"s": 4}


def test_de_boor_reads_below_its_list():
    given = {"s": 3, "order": 4, "t": Fraction(7, 2), "knots": list(range(9)), "points": [0, 1, 2, 3, 4]}
    assert run("bsplines.9", given=given).variables["v"][3] == Fraction(3, 2)


def test_a_curvature_in_symbols():
    second = {"getX": lambda t: 0, "getY": lambda t: 2}
    first = {"getX": lambda t: 1, "getY": lambda t: 0, "getDerivative": lambda: second}
    assert result("curvature.3", "kappa", [0, {"getDerivative": lambda: first}]) == 2


def test_a_name_without_a_value_is_named_with_its_line():
    frame = {"o": point(0, 0, 0), "t": point(1, 0, 0), "r": point(0, 0, 1), "n": point(0, 1, 0)}
    given = {
        "getFrenetFrame": lambda s: frame,
        "getPoint": lambda s: point(s, 0, 0),
        "getDerivative": lambda s: None,
    }
    with pytest.raises(CodeFaultError, match=r"^line 13: found t, which has no value$"):
        result("pointvectors3d.2", "generateRMFrames", [2], **given)
