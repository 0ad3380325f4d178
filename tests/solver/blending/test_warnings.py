"""What a user should look at is a warning: shape parameters at their bounds, from both sides, and rounding."""

import re
from dataclasses import replace

import numpy as np
import pytest

from helpers.bases import turned
from helpers.papers_set import blend
from semispline import Base, BlendOptions, BSplineSurface, ContactError, FoldError
from semispline import blend as blend_by_default
from semispline.papers.reproduction.families.suite import shape_problem
from semispline.solver.blending.fair_search import FairSolution
from semispline.solver.blending.shape_parameters import Found
from semispline.solver.blending.warnings import contact_warnings, remedy, stopped_warning, strained_by
from semispline.solver.judge import NoNormal, RoundingCauses, rounding_causes
from semispline.solver.reports import print_result
from semispline.solver.splines import greville

LINE = [0, 0, 1, 1]
FLOOR = Base(BSplineSurface(1, 1, LINE, LINE, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]), "u1")
WALL = Base(BSplineSurface(1, 1, LINE, LINE, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]]), "u0")
# By hand, as the energy in test_rounding_of_close_knots: a quarter of the sum of M^-1 c, over c' M^-1 c.
BEST = 64 / 39
# Near the origin, without weights.
NO_CAUSE = RoundingCauses(1.0, 1.0, (1.0, 1.0), 1.0)
# Natural size: a gap of sqrt(2) over a speed of 1.
NATURAL = np.sqrt(2)


@pytest.mark.parametrize("method", ["reduced", "casadi"])
@pytest.mark.parametrize(("low", "high", "which"), [(0.9, 0.99, "upper"), (1.01, 1.1, "lower"), (0.99, 1.01, None)])
def test_a_shape_parameter_at_its_bound_is_a_warning(method, low, high, which):
    box = (BEST / NATURAL * low, BEST / NATURAL * high)
    result = blend(FLOOR, WALL, box=box, method=method)
    if which is None:
        assert not result.active_bounds
        assert not result.warnings
        assert result.alpha2 == pytest.approx(BEST, rel=1e-6)
        return
    assert result.active_bounds == (f"alpha2 {which}", f"beta2 {which}")
    bound = BEST * (high if which == "upper" else low)
    assert [re.match(rf"(\w+) is at its {which} bound {bound:.3g}", w).group(1) for w in result.warnings] == [
        "alpha2",
        "beta2",
    ]
    with pytest.raises(FoldError, match=f"alpha2 is at its {which} bound"):
        blend(FLOOR, WALL, box=box, method=method, strict=True)


def test_shape_parameters_that_are_not_searched_have_no_bound_to_meet():
    for options in ({"alpha": "natural"}, {"alpha": 1.5}, {"continuity": "C2"}, {"continuity": "G0"}):
        result = blend(FLOOR, WALL, **options)
        assert not result.active_bounds
        assert not [w for w in result.warnings if "bound" in w]


def flat_with(knots_u, y=(0.0, 1.0)):
    x = greville(np.array(knots_u, float), 3)
    net = np.stack(np.broadcast_arrays(x[:, None], np.array(y), 0.0), axis=2)
    along = [0.0] * len(y) + [1.0] * len(y)
    return Base(BSplineSurface(3, len(y) - 1, knots_u, along, net), "u1")


@pytest.mark.parametrize("continuity", ["C2", "G2"])
def test_rounding_beside_the_edge_names_the_knots(continuity):
    base = flat_with([0, 0, 0, 0, 1 - 1e-9, 1, 1, 1, 1])
    with pytest.raises(ContactError, match=r"knots_u of the base leave a span of 1\.0e-09 beside the edge") as error:
        blend(base, WALL, continuity=continuity)
    assert "shape parameter" not in str(error.value)
    other = Base(FLOOR.surface, "u1")
    said = [remedy(one, NO_CAUSE, [], shape) for one in (base, other) for shape in (None, 1e-8)]
    assert ["beside the edge" in text for text in said] == [True, True, False, False]
    assert ["shape parameter" in text for text in said] == [False, False, False, True]


def test_a_base_without_a_normal_is_named():
    bare = NoNormal("a", 0.0, (1.0, 0.0, 0.0), "the derivative along the edge vanishes", 1e-9)
    said = remedy(FLOOR, NO_CAUSE, [bare], 1.0)
    assert "the base has no proper normal at parameter 0" in said
    assert "shape parameter" not in said


@pytest.mark.parametrize(("width", "named"), [(0.9e-3, True), (1.1e-3, False)])
@pytest.mark.parametrize("edge", ["u0", "u1", "v0", "v1"])
@pytest.mark.parametrize("start", [0.0, 300.0])
def test_a_span_is_narrow_below_a_thousandth_of_the_base(width, named, edge, start):
    domain = 400.0
    surface = flat_with(start + domain * np.array([0, 0, 0, 0, 1 - width, 1, 1, 1, 1])).surface
    base = Base(turned(turned(surface, "u1", False), edge, False), edge)
    assert remedy(FLOOR, NO_CAUSE, [], 1.0, 3).startswith("derivatives of order 3 round: ask for G2")
    assert remedy(FLOOR, NO_CAUSE, [], 1.0, 4).startswith("derivatives of order 4 round: ask for G3")
    said = remedy(base, NO_CAUSE, [], None)
    assert (f"knots_{edge[0]} of the base leave a span of {width * domain:.1e} beside the edge" in said) is named
    # Nobody asks for what is narrow elsewhere.
    other = Base(base.surface, edge[0] + {"0": "1", "1": "0"}[edge[1]])
    assert "beside the edge" not in remedy(other, NO_CAUSE, [], None)


def moved(base, distance, weights=None):
    surface = base.surface
    points = surface.control_points + np.array([0.0, distance, 0.0])
    return Base(BSplineSurface(1, 1, LINE, LINE, points, weights), base.edge)


# One rounding of what is stored against eight of what is worked with: fifty times as much at some 800 sizes.
@pytest.mark.parametrize(("distance", "far"), [(400, False), (2000, True)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_far_from_the_origin_is_where_rounding_is_that_of_the_distance(distance, side, far):
    causes = rounding_causes(moved(FLOOR, side * distance), moved(WALL, side * distance), 2)
    said = remedy(FLOOR, causes, [], None)
    assert ("times the size of the surfaces away: work in coordinates nearer to it" in said) is far


@pytest.mark.parametrize(
    ("least", "distance", "said"),
    [
        (1.0, 0, []),
        (0.9, 0, []),
        (1e-6, 0, ["weights"]),
        (1.0, 1e6, ["origin"]),
        (1e-6, 1e4, ["weights", "origin"]),
        (1e-2, 1e9, ["origin", "weights"]),
    ],
)
def test_the_worse_cause_of_rounding_is_named_first_and_no_other_one_is(least, distance, said):
    weights = None if least == 1.0 else np.array([[1.0, least], [1.0, 1.0]])
    a, b = moved(FLOOR, distance, weights), moved(WALL, distance)
    causes = rounding_causes(a, b, 2)
    assert causes.weight_ratios == (pytest.approx(1 / least), 1.0)
    text = causes.words(("the base", "the blend"))
    assert re.findall("weights|origin", text) == said
    if "weights" in said:
        assert f"weights of the base that act together differ by a factor of {1 / least:.2g}" in text
    # The other side of the contact is named where it is much the worse.
    other = rounding_causes(b, a, 2).words(("the base", "the blend"))
    assert ("weights of the blend" in other) is ("weights" in said)


@pytest.mark.parametrize(
    ("knots", "named"), [(1.0, "weights"), (1e-2, "weights"), (1e-5, "knots_u"), (1e-7, "knots_u")]
)
def test_of_weights_and_narrow_spans_the_worse_is_named(knots, named):
    """A span of 1e-5 or less beside one of 1, to the second power, against weights of ratio 1000, to that power too."""
    base = flat_with([0, 0, 0, 0, 1 - knots / 2, 1, 1, 1, 1])
    causes = RoundingCauses(1.0, 1.0, (1e3, 1.0), 1e6)
    assert named in remedy(base, causes, [], None)


def test_what_strains_is_said_beside_what_rounds():
    causes = RoundingCauses(1.0, 1.0, (1e3, 1.0), 1e6)
    assert remedy(FLOOR, causes, [], None, 2, "p2 is large").endswith("; p2 is large")
    assert remedy(FLOOR, NO_CAUSE, [], None, 2, "p2 is large") == "p2 is large"


@pytest.mark.parametrize(("far", "continuity"), [(0.0, "G3"), (1e6, "G2")])
def test_a_refusal_of_uneven_weights_names_them(far, continuity):
    """It named a missing normal; near the origin many digits show that the surfaces do meet."""
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    x, y = np.meshgrid(np.arange(4.0), np.arange(4.0), indexing="ij")
    net = np.stack([x + far, y, 0.1 * np.sin(3 * x + 5 * y)], axis=-1)
    weights = np.ones((4, 4))
    weights[2:, 1] = 1e-6
    a = Base(BSplineSurface(3, 3, knots, knots, net, weights), "u1")
    b = Base(BSplineSurface(3, 3, knots, knots, net + np.array([6.0, 0, 0])), "u0")
    if not far:
        assert any(
            "no proper normal" in text
            for text in blend_by_default(a, b, continuity=continuity, alpha="natural").warnings
        )
        return
    words = r"weights of the base that act together differ by a factor of 1e\+06.*the origin is 2e\+05 times the size"
    with pytest.raises(ContactError, match=words):
        blend_by_default(a, b, continuity=continuity, alpha="natural")


@pytest.mark.parametrize(("places", "named"), [(4, 4), (5, 5), (7, 5)])
def test_five_places_without_a_normal_are_named(places, named):
    result = blend(FLOOR, WALL, continuity="G1", alpha=1.3)
    bare = tuple(NoNormal("b", i / 8, (2.0, i / 8, 1.0), "the derivative vanishes", 1e-9) for i in range(places))
    contacts = result.contact_a, replace(result.contact_b, no_normal=bare)
    found = Found(1.69, 1.69, "linear")
    said = contact_warnings((FLOOR, WALL), result.surface, contacts, BlendOptions(continuity="G1"), found)
    assert ["base b: " in text and "G1 says nothing there" in text for text in said] == [True] * named
    assert not contact_warnings((FLOOR, WALL), result.surface, contacts, BlendOptions(continuity=("G1", "C1")), found)


def facing(seed, **options):
    problem = shape_problem("facing", seed)
    return blend_by_default(problem.a, problem.b, **options)


@pytest.mark.long
@pytest.mark.parametrize("given", [1e6, -1e6])
def test_a_p2_beyond_all_bounds_is_named_as_the_cause(given):
    with pytest.raises(ContactError, match=r"p2 of side a is -?1e\+06, which is far beyond its alpha\^2") as refused:
        facing(8, p2=(given, given))
    assert "alpha, or" not in str(refused.value)
    assert "degenerate" not in str(refused.value)


@pytest.mark.parametrize(
    ("times", "said"), [(99.0, ""), (-99.0, ""), (101.0, "p2 of side b"), (-101.0, "p2 of side b")]
)
def test_what_strains_is_a_hundred_alpha_squared(times, said):
    found = Found(1.0, (2.0, 3.0), "reduced", p2=(0.0, (0.0, 2.0 * times)))
    assert strained_by(BlendOptions(p2=(0.0, 2.0 * times)), found, 0) == ""
    assert strained_by(BlendOptions(p2=(0.0, 2.0 * times)), found, 1).startswith(said)
    # By a bulge, or by the search itself.
    by_bulge = strained_by(BlendOptions(bulge=(1.0, 20.0)), found, 1)
    assert by_bulge == ("bulge of side b is 20: try one nearer to 1" if said else "")
    assert strained_by(BlendOptions(), found, 1) == ""


@pytest.mark.long
def test_strict_does_not_advise_what_is_worse():
    with pytest.raises(FoldError, match=r"; look at the warnings, or blend without strict$") as refused:
        facing(7, bulge=2, strict=True)
    assert "natural" not in str(refused.value)
    assert "the blend folds: " in str(refused.value)


@pytest.mark.long
def test_what_was_minimised_is_before_the_bulge(capsys):
    for bulge in (1.0, (1.0, 1.2)):
        print_result(facing(7, bulge=bulge))
        (line,) = (line for line in capsys.readouterr().out.splitlines() if line.startswith("minimised"))
        assert (" before the bulge: least of" in line) is (bulge != 1.0)


@pytest.mark.parametrize("reason", ["fold", "loop"])
def test_a_search_that_a_refusal_stopped_is_told_of(reason):
    def found(stopped_by):
        fair = FairSolution(1.0, 1.0, (0.0, 0.0), 1.0, 0.5, 1, {}, stopped_by=stopped_by)
        return Found(1.0, 1.0, "reduced", fair=fair)

    def said(**options):
        (text,) = stopped_warning(found(reason), BlendOptions(**options))
        assert f"beside this blend lie fairer ones that {reason}, which are refused; try " in text
        return text.partition("try ")[2]

    # What was done is not to be tried.
    edges = "or edges that face each other more evenly"
    assert said(alpha_v="constant", middle_curves=0) == f"alpha_v linear, a middle curve, {edges}"
    assert said(alpha_v="linear", middle_curves=0) == f"a middle curve, {edges}"
    assert said(alpha_v="constant", middle_curves=1) == f"alpha_v linear, {edges}"
    for nothing in (found(""), Found(1.0, 1.0, "casadi")):
        assert stopped_warning(nothing, BlendOptions()) == ()
