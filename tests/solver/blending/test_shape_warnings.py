"""What a user should look at in a shape: each warning from both sides, by shapes whose measures are known."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import semispline
from helpers.bases import facing_pair
from helpers.cases import CASES
from helpers.papers_set import blend
from helpers.shapes import arc, extruded, line, revolved, sheets, torus
from semispline import (
    Base,
    BlendOptions,
    BSplineCurve,
    BSplineSurface,
    ComputationError,
    FoldError,
    SemiStructuredSurface,
    measure_exits,
    measure_regularity,
    measure_shape,
    read_surface,
    swap_directions,
)
from semispline.papers.reproduction.families.suite import shape_problem
from semispline.solver.blending.shape_warnings import _bent, _creased, shape_warnings
from semispline.solver.judge import Crease, measure_creases

K1 = [0, 0, 1, 1]


def warnings_of(surface, *, creases=None, **asked):
    """The warnings of a surface; a rational one has no creases to be asked for."""
    found = creases if creases is not None else ()
    return shape_warnings(measure_shape(surface, **asked), measure_regularity(surface), found)


def kinds(warnings):
    """The first words of each warning."""
    return [warning.split(":")[0] for warning in warnings]


def roof(*angles):
    """Strips of degree 1 along v, each turned further down by an angle in degrees; straight and even in u."""
    turns = np.radians(np.cumsum([0.0, *angles]))
    steps = np.stack([np.zeros_like(turns), np.cos(turns), -np.sin(turns)], axis=1)
    ridge = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    knots = [0, 0, *np.arange(1, len(turns)) / len(turns), 1, 1]
    curves = [BSplineCurve(1, knots, ridge + np.array([x, 0, 0])) for x in (0, 1)]
    return SemiStructuredSurface(1, K1, curves)


def bent(degrees, radius=0.005):
    """Two flaps of length 2 with a narrow bend between them."""
    t = np.radians(degrees)
    end = radius * np.array([np.sin(t), 1 - np.cos(t)])
    bend = arc((0, radius), radius, -90, degrees - 90)
    return extruded([*line((-2, 0), (0, 0)), *bend, *line(end, end + 2 * np.array([np.cos(t), np.sin(t)]))], 1.0)


def ess(degrees):
    """Two arcs, one after the other, bent to opposite sides."""
    t = np.radians(degrees)
    return extruded([*arc((0, 0), 1.0, 0, degrees), *arc((2 * np.cos(t), 2 * np.sin(t)), 1.0, degrees + 180, 180)], 1.0)


def wave(degrees):
    """A line, a wave that turns by four times an angle in all, and the line again."""
    s, c = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    rise = [*line((-2, 0), (0, 0)), *arc((0, 1), 1.0, -90, degrees - 90)]
    top = arc((2 * s, 1 - 2 * c), 1.0, 90 + degrees, 90 - degrees)
    fall = [*arc((4 * s, 1), 1.0, -90 - degrees, -90), *line((4 * s, 0), (4 * s + 2, 0))]
    return extruded([*rise, *top, *fall], 1.0)


def hourglass(part):
    """A turned arc whose waist is this part of its rims' radius."""
    centre = (1 - part / np.sqrt(2)) / (1 - part)
    return revolved(arc((centre, 0), 1.0, 225, 135))


def test_good_sheets_are_silent():
    for surface in sheets(7, 4):
        assert warnings_of(surface) == ()


@pytest.mark.parametrize(
    ("degrees", "said"),
    [
        (59.0, []),
        (61.0, ["the blend turns steeply"]),
        (89.0, ["the blend turns steeply"]),
        (91.0, ["the blend folds"]),
        (130.0, ["the blend folds"]),
    ],
)
def test_a_turn_of_60_degrees_is_steep_and_one_beyond_a_right_angle_a_fold(degrees, said):
    found = warnings_of(bent(degrees))
    assert kinds(found) == said
    for text in found:
        assert f"by {degrees:.0f} degrees within 0.08" in text
        assert "near (" in text
        assert "try alpha fair" in text


@pytest.mark.parametrize(
    ("turn", "bend", "said"),
    [
        (60.0, 0.0, []),
        (60.001, 0.0, ["the blend turns steeply"]),
        (90.0, 0.0, ["the blend turns steeply"]),
        (90.001, 0.0, ["the blend folds"]),
        # A crease explains the rest.
        (100.0, 40.0, []),
        (100.0, 39.99, ["the blend turns steeply"]),
        (150.0, 59.99, ["the blend folds"]),
    ],
)
def test_a_turn_that_a_crease_explains_is_no_fold(turn, bend, said):
    surface = sheets(7, 1)[0]
    shape = measure_shape(surface)
    shape = replace(shape, turn=replace(shape.turn, degrees=turn))
    creases = (Crease("v", 0.5, bend),) if bend else ()
    found = [text for text in shape_warnings(shape, measure_regularity(surface), creases) if "creased" not in text]
    assert kinds(found) == said


def test_a_creased_roof_is_creased_and_not_folded():
    surface = roof(100.0)
    assert kinds(warnings_of(surface, creases=measure_creases(surface))) == [
        "the blend is creased at v = 0.5, by up to 1e+02 degrees"
    ]
    # Were it no crease it would be a fold.
    assert kinds(warnings_of(surface)) == ["the blend folds"]


@pytest.mark.parametrize(("angle", "creased"), [(0.5e-3, False), (0.9e-3, False), (1.1e-3, True), (2e-3, True)])
def test_a_thousandth_of_a_degree_is_a_crease(angle, creased):
    surface = roof(angle)
    found = warnings_of(surface, creases=measure_creases(surface))
    assert any("creased at v = 0.5" in text for text in found) is creased


@pytest.mark.parametrize(("creases", "more"), [(5, ""), (7, " and 2 more")])
def test_five_creases_are_named(creases, more):
    surface = roof(*[1.0] * creases)
    (warning,) = warnings_of(surface, creases=measure_creases(surface))
    named = ", ".join(f"v = {i / (creases + 1):g}" for i in range(1, 6))
    assert f"creased at {named}{more}, by up to 1 degrees" in warning


@pytest.mark.parametrize(("part", "pinched"), [(0.5e-3, True), (0.9e-3, True), (1.1e-3, False), (2e-3, False)])
def test_an_area_element_of_a_thousandth_is_a_pinch(part, pinched):
    # A trapezoid from 2 wide down to `width`: the area element falls evenly, so that its mean is half way.
    width = part / (1 - part / 2)
    surface = BSplineSurface(1, 1, K1, K1, [[[0, 0, 0], [0, 2, 0]], [[1, 0, 0], [1, width, 0]]])
    assert measure_regularity(surface).least_area_ratio == pytest.approx(part, rel=1e-9)
    assert any("pinched" in text for text in warnings_of(surface)) is pinched


@pytest.mark.parametrize(("part", "pinched"), [(0.4, True), (0.49, True), (0.51, False), (0.8, False)])
def test_half_the_waist_of_straight_rulings_is_a_pinch(part, pinched):
    surface = hourglass(part)
    waist = measure_shape(surface).waist
    assert waist.distance / waist.of_rulings == pytest.approx(part, rel=1e-9)
    assert kinds(warnings_of(surface)) == ["the blend is pinched between its rims"] * pinched


@pytest.mark.parametrize(("degrees", "loops"), [(14.9, False), (15.1, True), (40.0, True)])
def test_sixty_degrees_beyond_the_exits_are_a_loop(degrees, loops):
    found = warnings_of(wave(degrees))
    assert kinds(found) == ["the blend loops or waves"] * loops
    for text in found:
        assert f"turns by {4 * degrees:.0f} degrees, and its exits need 0" in text


def hairpin(degrees, radius):
    """Two legs of length 1, joined by an arc that turns by `degrees`."""
    ends = [np.radians(90 - degrees / 2), np.radians(90 + degrees / 2)]
    first, last = (radius * np.array([np.cos(t), np.sin(t)]) for t in ends)
    leave, arrive = (np.array([np.sin(ends[0]), -np.cos(ends[0])]), np.array([-np.sin(ends[1]), np.cos(ends[1])]))
    way = [*line(first + leave, first), *arc((0, 0), radius, *np.degrees(ends)), *line(last, last + arrive)]
    return extruded(way, 1.0)


@pytest.mark.parametrize(
    ("degrees", "radius", "is_named"),
    [(185, 0.1, False), (185, 0.08, True), (175, 0.08, False)],
)
def test_a_u_turn_with_a_sharp_tip_is_named(degrees, radius, is_named):
    # A fiftieth of the length, 0.046, turns by 26 and by 33 degrees.
    assert kinds(warnings_of(hairpin(degrees, radius))) == ["the blend is a U-turn"] * is_named


@pytest.mark.parametrize("degrees", [181, 250])
def test_a_u_turn_of_even_bend_is_what_was_asked_for(degrees):
    surface = extruded(arc((0, 0), 1.0, 0, degrees), 1.0)
    assert measure_exits(surface).is_u_turn
    assert warnings_of(surface) == ()


@pytest.mark.parametrize(("degrees", "said"), [(100, []), (179, []), (270, ["the blend is a U-turn that has to loop"])])
def test_exits_to_opposite_sides_are_named(degrees, said):
    found = warnings_of(ess(degrees))
    assert kinds(found) == said
    assert all("opposite sides of the line that joins the contacts" in text for text in found)


def test_a_place_where_it_meets_itself_is_named():
    way = [*line((-2, 0), (0, 0)), *arc((0, 1), 1.0, -90, 180), *line((-1, 1), (-1, -2))]
    surface = extruded(way, 1.0)
    asked = [text for text in warnings_of(surface, search_meets=True) if "meets itself" in text]
    assert asked[0].startswith("the blend meets itself at (-1, ")
    # Not asked for, it is not searched, and nothing is said.
    assert not [text for text in warnings_of(surface) if "meets itself" in text]


@pytest.mark.long
def test_a_base_that_is_passed_through_is_named():
    wall = revolved(line((1, -4), (1, 0)))
    # From the rim outwards, down outside, and inwards through the wall.
    way = [*arc((2, 0), 1.0, 180, 0), *line((3, 0), (3, -1)), *line((3, -1), (0.5, -1))]
    found = warnings_of(revolved(way), a=Base(wall, "u1"), search_meets=True)
    assert [text for text in found if text.startswith("the blend passes through base a at ")]
    outside = [*arc((2, 0), 1.0, 180, 0), *line((3, 0), (3, -1))]
    found = warnings_of(revolved(outside), a=Base(wall, "u1"), search_meets=True)
    assert not [text for text in found if "passes through" in text]


def test_a_pipe_and_an_elbow_are_silent_and_measured():
    pipe = measure_shape(revolved(line((5, 0), (5, 10))))
    bends = sorted([pipe.curvatures.least.value, pipe.curvatures.largest.value], key=abs)
    assert bends == pytest.approx([0, np.sign(bends[1]) / 5], abs=1e-12)
    assert (pipe.waist.distance, pipe.waist.of_rulings) == (pytest.approx(10), pytest.approx(10))
    assert pipe.fairness.value < 1e-8
    bend = swap_directions(torus(3.0, 1.0, around=(0, 90)))
    assert warnings_of(bend) == ()
    elbow = measure_shape(bend)
    assert elbow.waist.distance == pytest.approx(2, rel=1e-9)
    assert elbow.waist.of_rulings == pytest.approx(np.sqrt(2), rel=1e-9)
    assert [elbow.exits.theta_0, elbow.exits.theta_1] == pytest.approx([45, 45])


def test_a_blend_that_turns_steeply_is_warned_of_and_strict_refuses_it():
    a, b = facing_pair(np.random.default_rng(3))
    options = {"alpha": 3.5}
    result = blend(a, b, **options)
    assert result.shape.turn.degrees > 60
    assert result.warnings
    with pytest.raises(FoldError, match=r"the blend (turns steeply|folds)"):
        blend(a, b, **options, strict=True)


@pytest.mark.long
def test_pipe_and_cap():
    a, b = (
        Base(read_surface(CASES / name), edge) for name, edge in (("pipe_poly.json", "v1"), ("dome_poly.json", "v0"))
    )
    pinched = blend(a, b)
    assert pinched.shape.waist.distance < 0.5 * pinched.shape.waist.of_rulings
    assert "the blend is pinched between its rims" in kinds(pinched.warnings)
    fair = blend(a, b, alpha="fair", degree_u=5, middle_curves=0, v_scale="length")
    assert fair.shape.waist.distance > 0.9 * fair.shape.waist.of_rulings
    assert not [text for text in fair.warnings if "pinched" in text]
    # Searched only where asked for.
    assert (fair.shape.meets.searched, fair.shape.meets.answer("itself")) == ((), None)
    asked = blend(a, b, alpha="fair", degree_u=5, middle_curves=0, v_scale="length", search_meets=True)
    assert asked.shape.meets.searched == ("itself", "a", "b")
    assert asked.shape.meets.answer("itself") is None


def test_a_blend_that_is_no_surface_is_refused():
    # Both contacts on one line, and nothing beside it.
    strips = [
        BSplineSurface(1, 1, K1, K1, [[[0, y, 0] for y in ys], [[1, y, 0] for y in ys]]) for ys in ((0, 1), (2, 3))
    ]
    with pytest.raises(ComputationError, match="the blend is no surface: surface: has no tangent plane anywhere"):
        blend(Base(strips[0], "u0"), Base(strips[1], "u0"), continuity="G0")


@pytest.mark.parametrize("degrees", [70.0, 100.0])
@pytest.mark.parametrize(
    ("asked", "first"),
    [
        ({}, "a smaller alpha"),
        ({"box": (1.0, 1.0)}, "a smaller alpha"),
        ({"alpha": "natural"}, "alpha fair, a smaller alpha"),
        ({"alpha": ("fair", 0.5)}, "alpha fair, a smaller alpha"),
        ({"bulge": 2}, "a smaller bulge, a smaller alpha"),
        ({"bulge": (0.5, 1.1)}, "a smaller bulge, a smaller alpha"),
        ({"bulge": (0.5, 1.0)}, "a larger bulge, a smaller alpha"),
        ({"bulge": 2, "alpha": 0.5}, "a smaller bulge, alpha fair, a smaller alpha"),
        ({"p2": (0.0, -3.0)}, "p2 nearer to zero, a smaller alpha"),
        ({"p2": (0.0, 0.0)}, "a smaller alpha"),
    ],
)
def test_what_was_asked_for_is_tried_first(asked, first, degrees):
    report, regular = measure_shape(sheets(1, 1)[0]), measure_regularity(sheets(1, 1)[0])
    report = replace(report, turn=replace(report.turn, degrees=degrees))
    for options in (BlendOptions(**asked), BlendOptions(**asked).decided()):
        (said,) = shape_warnings(report, regular, (), options=options)
        assert f"; try {first}, " in said


def test_a_bulge_that_folds_is_said_to_be_too_large():
    problem = shape_problem("facing", 7)
    said = semispline.blend(problem.a, problem.b, bulge=2).warnings
    assert any(text.startswith("the blend folds") for text in said)
    assert all("; try a smaller bulge, " in text for text in said)


@pytest.mark.parametrize("section", ["u", "v"])
def test_where_a_surface_folds_is_told_by_both_parameters(section):
    report = measure_shape(sheets(1, 1)[0])
    turn = replace(report.turn, degrees=95.0, section=section, at=0.25, between=(0.5, 0.75))
    regular = measure_regularity(sheets(1, 1)[0])
    (said,) = shape_warnings(replace(report, turn=turn), regular, ())
    assert {"u": "at u = 0.25, v = 0.5,", "v": "at v = 0.25, u = 0.5,"}[section] in said
    # The sharpest crease may explain it, and a slight one beside it takes nothing away.
    for angles, kind in (((40.0, 10.0), []), ((10.0, 40.0), []), ((10.0, 20.0), ["the blend turns steeply"])):
        creases = tuple(Crease("v", 0.5, angle) for angle in angles)
        found = kinds(shape_warnings(replace(report, turn=turn), regular, creases))
        assert [one for one in found if "creased" not in one] == kind


@pytest.mark.parametrize(("places", "more"), [(4, None), (5, None), (6, 1), (9, 4)])
def test_five_places_where_it_meets_something_are_named(places, more):
    report, regular = measure_shape(sheets(1, 1)[0]), measure_regularity(sheets(1, 1)[0])
    found = tuple(f"meets itself at place {i}" for i in range(places))
    said = shape_warnings(replace(report, meets=replace(report.meets, found=found)), regular, ())
    named = [f"the blend {place}; try" for place in found[:5]]
    assert [text.startswith(start) for text, start in zip(said, named, strict=False)] == [True] * len(named)
    assert list(said[len(named) :]) == (
        [f"the blend meets itself or its bases in {more} more place(s)"] if more else []
    )


def test_the_sharpest_crease_is_told():
    report, regular = measure_shape(sheets(1, 1)[0]), measure_regularity(sheets(1, 1)[0])
    (said,) = shape_warnings(report, regular, tuple(Crease("v", 0.1, angle) for angle in (2.0, 30.0, 4.0)))
    assert "by up to 30 degrees" in said


@pytest.mark.parametrize(
    ("jump", "said"), [(0.019, []), (0.021, ["G1 inside: curvature jumps by up to 2.1 % at v = 2"])]
)
def test_a_jump_of_curvature_of_two_percent_is_said(jump, said):
    found = list(_bent([Crease("v", 2.0, 0.0, 1.0, jump), Crease("v", 3.0, 0.0, 1.0, jump / 2)]))
    assert [text.split(",")[0] for text in found] == said


@pytest.mark.parametrize(("degrees", "said"), [(9e-4, 1), (1.1e-3, 2)])
def test_a_crease_of_the_base_itself_is_said(degrees, said):
    cure = SimpleNamespace(left=(SimpleNamespace(degrees=degrees, v=0.5),))
    assert len(list(_creased([Crease("v", 0.5, 1.0)], (cure, None)))) == said
    assert list(_creased([], (cure, None))) == []


@pytest.mark.parametrize(
    ("angle", "said"), [(9e-4, "G1 inside"), (1.1e-3, "the blend is creased at v = 0.5, by up to")]
)
def test_curvature_jumps_where_there_is_no_crease(angle, said):
    (warning,) = warnings_of(roof(0.0), creases=[Crease("v", 0.5, angle, 1.0, 0.5)])
    assert warning.startswith(said)
