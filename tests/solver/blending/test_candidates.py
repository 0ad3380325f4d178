"""Which layouts a fair blend tries, and which it takes."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.facing import random_facing
from helpers.sweeps import first_rows
from semispline import Base, BlendOptions, BSplineSurface, FoldError, OptionError, blend, measure_fairness
from semispline.papers.reproduction.families.suite import shape_problem
from semispline.solver.blending import candidates, pipeline, shape_parameters
from semispline.solver.blending.chain_bases import StatedBases
from semispline.solver.blending.fair_search import FairSolution, solve_fair
from semispline.solver.blending.linear_problem import gap_ratio
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.blending.shape_parameters import Found, found_fair
from semispline.solver.blending.warnings import bound_warnings

CUBIC = [0, 0, 0, 0, 1, 1, 1, 1]


def wedge(ratio, *, gap=1.0):
    """Two bent sheets whose gap grows by a factor along v."""
    v, w = np.linspace(0, 1, 4), np.linspace(0, 1, 4)
    lower = [[[-0.8 * x, y, 0.1 * x * x - 0.3 * x] for y in v] for x in w]
    upper = [[[gap * (1 + (ratio - 1) * y) + 0.8 * x, y, 0.1 * x * x - 0.4 * x] for y in v] for x in w]
    return tuple(Base(BSplineSurface(3, 3, CUBIC, CUBIC, net), "u0") for net in (lower, upper))


def facing(seed):
    problem = shape_problem("facing", seed)
    return problem.a, problem.b


def tried(result):
    return [(c.degree_u, c.middle_curves, c.alpha_v) for c in result.candidates]


def test_of_an_even_gap_the_quintic_is_tried_without_and_with_a_middle_curve():
    result = blend(*wedge(1.1))
    assert tried(result) == [(5, 0, "constant"), (5, 1, "constant")]
    assert result.candidates[0].verdict == "chosen"
    assert result.candidates[0].fairness == result.objective.value
    assert tried(blend(*wedge(1.1), middle_curves=0)) == [(5, 0, "constant")]


@pytest.mark.long
def test_a_middle_curve_that_is_fairer_by_a_twentieth_is_taken():
    a, b = facing(103)
    result = blend(a, b)
    *without, one = (c for c in result.candidates if c.degree_u == 5)
    assert (one.middle_curves, one.verdict) == (1, "chosen")
    assert one.fairness == result.objective.value < 0.95 * min(c.fairness for c in without)
    assert result.shape.turn.degrees < blend(a, b, middle_curves=0).shape.turn.degrees


# Each ends at its window without a middle curve; with one the third is fairer by a third alone.
@pytest.mark.parametrize(
    ("seed", "searched"),
    [
        (4, [(5, 0, "constant"), (5, 1, "constant")]),
        (103, [(5, 0, "constant"), (5, 1, "constant"), (5, 1, "constant")]),
        (159, [(5, 0, "constant"), (5, 1, "constant"), (5, 0, "constant")]),
    ],
)
def test_beside_a_middle_curve_that_is_much_fairer_no_lower_window_is_searched(seed, searched):
    result = blend(*facing(seed))
    assert tried(result) == searched
    assert result.options.middle_curves == 1
    first, middle = result.candidates[:2]
    assert (middle.fairness < 0.5 * first.fairness) is (seed != 159)
    assert not result.active_bounds


@pytest.mark.long
def test_a_little_fairness_is_not_worth_a_warning():
    a, b = facing(265)
    result, middle = blend(a, b), blend(a, b, middle_curves=1)
    (text,) = middle.warnings
    assert "loops or waves" in text
    assert not result.warnings
    assert result.options.middle_curves == 0
    assert 0.9 * result.objective.value < middle.objective.value < 0.95 * result.objective.value
    chosen, left = result.candidates
    assert chosen.verdict == "chosen"
    assert left.middle_curves == 1
    assert left.verdict == f"fairness {middle.objective.value:.4g} is less, but {text}"
    assert result.edges == middle.edges
    assert result.flipped == middle.flipped


@pytest.mark.parametrize(("seed", "is_fairer"), [(1, True), (2, False)])
def test_only_a_fairer_middle_curve_is_led_away_from_its_ends(monkeypatch, seed, is_fairer):
    asked, away = [], candidates._away_from_ends

    def watched(best, search):
        asked.append(best.options.middle_curves)
        return away(best, search)

    monkeypatch.setattr(candidates, "_away_from_ends", watched)
    result = blend(*facing(seed))
    without, middle = (c.fairness for c in result.candidates)
    assert (middle < without) is is_fairer
    assert asked == ([0, 1] if is_fairer else [0])


@pytest.mark.long
def test_what_is_warned_of_either_way_keeps_its_middle_curve():
    # A pair of whatever shape, and a warning that both of them carry.
    a, b = facing(103)
    one = blend(a, b)
    warned = replace(one, warnings=("loud",))
    assert pipeline._unwarned(StatedBases(a, b, BlendOptions()), one) is one
    assert pipeline._unwarned(StatedBases(a, b, BlendOptions()), warned).options.middle_curves == 0
    assert pipeline._unwarned(StatedBases(a, b, BlendOptions(middle_curves=1)), warned) is warned
    # That of least energy was not chosen for its fairness.
    energy = replace(blend(a, b, alpha="energy"), warnings=("loud",))
    assert pipeline._unwarned(StatedBases(a, b, BlendOptions(alpha="energy")), energy) is energy
    # Too small a box leaves both at its end.
    assert pipeline._unwarned(StatedBases(a, b, BlendOptions(box=(1.3, 1.4))), warned) is warned


@pytest.mark.parametrize("options", [{"degree_u": 4}, {"degree_u": 3}, {"continuity": "G3"}, {"continuity": "G4"}])
def test_other_degrees_are_tried_without_where_the_gap_is_even(options):
    assert [c.middle_curves for c in blend(*wedge(1.1), **options).candidates] == [0]


@pytest.mark.parametrize(
    ("middle", "best", "pays"),
    [
        ({"value": 0.949}, {}, True),
        ({"value": 0.951}, {}, False),
        # What folds with it is not gone to, and what folds without it is left at any price.
        ({"value": 0.1, "condoned": ("folds",)}, {}, False),
        ({"value": 9.0}, {"condoned": ("folds",)}, True),
        # Nor what ends at a bound, or does not settle, where the other does not.
        ({"value": 0.1, "at_end": (True, False)}, {}, False),
        ({"value": 0.1, "at_end": (True, False)}, {"at_end": (False, True)}, True),
        ({"value": 0.1, "settled": False}, {}, False),
        ({"value": 0.1, "settled": False}, {"settled": False}, True),
        # Where a refusal stopped the other one it only has to be fairer.
        ({"value": 0.999}, {"stopped_by": "loop"}, True),
        ({"value": 1.001}, {"stopped_by": "loop"}, False),
        ({"value": 0.951, "stopped_by": "loop"}, {"stopped_by": "loop"}, False),
    ],
)
def test_what_a_middle_curve_has_to_gain(middle, best, pays):
    problem = state_problem(*wedge(1.0)).problem

    def layout(**fields):
        fair = FairSolution(1.0, 1.0, (0.0, 0.0), **{"value": 1.0, "slope": 0.0, "tried": 1, "refused": {}} | fields)
        return candidates.Layout(None, problem, Found(1.0, 1.0, "reduced", fair=fair))

    assert candidates._pays_with_a_middle_curve(layout(**middle), layout(**best)) is pays


@pytest.mark.long
def test_what_could_only_be_let_pass_is_not_searched_where_something_else_need_not_be(monkeypatch):
    asked = []

    def search(problem, options, known=None, most_condoned=2):
        asked.append(most_condoned)
        return shape_parameters.find_shape_parameters(problem, options, known, most_condoned)

    monkeypatch.setattr(candidates, "find_shape_parameters", search)
    problem = shape_problem("u-turn", 75)
    result = blend(problem.a, problem.b)
    # The first one folds, in a lower window it does not, so that the quartic may not.
    assert asked == [2, 1, 0]
    assert [c.verdict for c in result.candidates] == [
        "every cell that was tried folds",
        "chosen",
        "no candidate is left: 64 fold",
    ]


@pytest.mark.parametrize(("ratio", "is_tried"), [(1.5 - 1e-6, False), (1.5 + 1e-6, True)])
def test_a_linear_alpha_is_tried_from_a_ratio_on(ratio, is_tried):
    assert ((5, 0, "linear") in tried(blend(*wedge(ratio)))) == is_tried


@pytest.mark.long
def test_a_wide_wedge_takes_a_linear_alpha_and_says_what_it_costs():
    result, constant = blend(*wedge(5.0)), blend(*wedge(5.0), alpha_v="constant")
    # A loop stops the search for a constant one: it would stop the quartic's as well.
    assert tried(result) == [(5, 0, "constant"), (5, 0, "linear")]
    assert [c.verdict == "chosen" for c in result.candidates] == [False, True]
    assert result.objective.value < 0.7 * constant.objective.value
    assert result.rows_converted > constant.rows_converted
    low, high = result.alpha2
    assert high > 1.5 * low > 0


@pytest.mark.parametrize("ratio", [2 - 1e-6, 2 + 1e-6])
def test_with_other_degrees_a_middle_curve_is_tried_where_alpha_is_constant_and_the_gap_varies(ratio):
    pair = wedge(ratio)
    assert (gap_ratio(state_problem(*pair).problem) >= candidates.MIDDLE_RATIO) == (ratio > 2)
    result = blend(*pair, alpha_v="constant", degree_u=4)
    assert tried(result)[0] == (4, 0, "constant")
    assert ((5, 1, "constant") in tried(result) or (4, 1, "constant") in tried(result)) == (ratio > 2)
    # Said to be without, it is without.
    assert tried(blend(*pair, alpha_v="constant", middle_curves=0)) == [(5, 0, "constant")]


def stated(ratio, *, at_end=(False, False), **options):
    """A layout of a wedge, as if it were found."""
    fair = FairSolution(1.0, 1.0, (0.0, 0.0), 1.0, 0.0, 1, {}, at_end=at_end)
    said = BlendOptions(**({"degree_u": 5, "alpha_v": "constant"} | options))
    return candidates.Layout(said, state_problem(*wedge(ratio)).problem, Found(1.0, 1.0, "reduced", fair=fair))


@pytest.mark.parametrize(("ratio", "degree", "wanted"), [(1.9, 4, False), (2.1, 4, True), (1.9, 5, True)])
def test_a_middle_curve_is_wanted_of_quintics_and_elsewhere_where_the_gap_doubles(ratio, degree, wanted):
    assert candidates._may_want_a_middle_curve(stated(ratio, degree_u=degree)) is wanted
    assert not candidates._may_want_a_middle_curve(stated(ratio, degree_u=degree, alpha_v="linear"))


@pytest.mark.parametrize(
    ("ratio", "alpha_v", "wanted"),
    [
        (1.4, "auto", True),
        (1.6, "auto", False),
        (1.6, "constant", True),
        (1.4, "linear", False),
    ],
)
def test_a_middle_curve_comes_first_at_an_end_unless_a_linear_alpha_is_tried(ratio, alpha_v, wanted):
    assert candidates._wants_a_middle_curve_first(stated(ratio, at_end=(False, True)), alpha_v) is wanted
    assert not candidates._wants_a_middle_curve_first(stated(ratio), alpha_v)


def test_a_candidate_whose_folds_were_let_pass_is_not_called_less_fair():
    problem = state_problem(*wedge(1.0)).problem
    values = ((5.0, ()), (1.0, ("folds",)), (5.0, ()), (6.0, ()), (4.9, ()))
    solutions = [FairSolution(1.0, 1.0, (0.0, 0.0), value, 0.0, 1, {}, condoned) for value, condoned in values]
    solutions.append(replace(solutions[0], value=2.0, settled=False))
    best, *others = (candidates.Layout(None, problem, Found(1.0, 1.0, "reduced", fair=one)) for one in solutions)
    said = [candidates._loser(layout, best) for layout in others]
    assert said == [
        "every cell that was tried folds",
        "fairness 5 is no less",
        "fairness 6 is more",
        "fairness 4.9 is less, by less than the 5% that a middle curve has to gain",
        "fairness 2 is less, but does not settle",
    ]


# Seed, fairness without p2 or with one of the two at most, and the least in a window that begins lower.
@pytest.mark.parametrize(("seed", "was", "least"), [(57, 634, 492), (218, 386, 118), (234, 745, 566), (250, 142, 133)])
def test_where_alpha_and_p2_are_traded_until_the_window_ends_p2_stays_in_a_lower_window(seed, was, least):
    a, b = facing(seed)
    # In the window itself it ends there.
    assert any(solve_fair(state_problem(a, b).problem).at_end)
    result = blend(a, b, middle_curves=0)
    assert result.shape.fairness.value < least < was
    assert all(result.p2)
    assert not result.active_bounds
    assert not result.warnings
    first, second = result.candidates
    assert first.verdict.endswith(" is more, in another window")
    assert second.verdict == "chosen"


def test_p2_is_left_out_where_that_leaves_an_end_for_little_fairness():
    # A box is not widened, and here one p2 costs 7 %.
    a, b = facing(250)
    result = blend(a, b, box=(1 / 4, 4), middle_curves=0)
    assert result.p2[0] != 0
    assert result.p2[1] == 0
    assert not result.active_bounds
    with_p2, without = result.candidates
    assert with_p2.verdict == f"fairness {with_p2.fairness:.4g} is less, at an end of its window"
    assert without.verdict == "chosen"
    assert 1.0 < without.fairness / with_p2.fairness < 1.1


@pytest.mark.long
def test_p2_stays_where_it_is_worth_more_than_an_end_that_is_not_met():
    # Without it fairness is 1.28 times as much.
    a, b = facing(4)
    result = blend(a, b, box=(1 / 4, 4), degree_u=5, middle_curves=0)
    assert all(result.p2)
    assert result.active_bounds == ("beta2 lower",)
    assert any("beta2 is at its lower bound" in text for text in result.warnings)
    # One side goes without, then both.
    first, *others = (c.verdict for c in result.candidates)
    assert first == "chosen"
    assert [text.split(":")[0] for text in others] == ["without p2 of b", "without p2 of a and b"]


@pytest.mark.parametrize(
    ("fairness", "condoned", "ends", "pays"),
    [
        (1.1, (), (False, False), True),
        (1.1 + 1e-9, (), (False, False), False),
        (0.9, (), (True, False), False),
        # What folds with p2 is left, at any price; what folds without it is not gone to.
        (1.0, ("folds",), (False, False), False),
    ],
)
def test_what_a_blend_without_p2_may_cost(fairness, condoned, ends, pays):
    problem = state_problem(*wedge(1.0)).problem

    def layout(value, condoned, at_end):
        fair = FairSolution(1.0, 1.0, (0.0, 0.0), value, 0.0, 1, {}, condoned, at_end)
        return candidates.Layout(None, problem, Found(1.0, 1.0, "reduced", fair=fair))

    without = layout(fairness, condoned, ends)
    assert candidates._pays_without_p2(without, layout(1.0, (), (True, False))) is pays
    assert candidates._pays_without_p2(layout(9.0, (), (True, True)), layout(1.0, ("folds",), (True, False)))


@pytest.mark.long
def test_a_u_turn_at_an_end_is_searched_in_lower_windows_too():
    problem = shape_problem("u-turn", 20)
    result = blend(problem.a, problem.b)
    # It folded by 136 degrees, with both at their lower ends.
    assert result.shape.turn.degrees < 70
    assert not result.active_bounds
    assert not any("folds" in text for text in result.warnings)
    low, _ = state_problem(problem.a, problem.b).problem.bounds[0]
    assert result.alpha2_bounds[0] == pytest.approx(low / 4, rel=1e-12)
    # The quartic is tried as before.
    assert tried(result) == [(5, 0, "constant")] * 3 + [(4, 0, "constant")]


def test_the_quartic_of_a_u_turn_at_an_end_goes_to_lower_windows_if_it_wins():
    problem = shape_problem("u-turn", 62)
    result = blend(problem.a, problem.b)
    chosen = next(c for c in result.candidates if c.verdict == "chosen")
    assert chosen.degree_u == 4
    assert chosen.fairness == min(c.fairness for c in result.candidates)
    assert not result.active_bounds


# What was said to be worse in a wider box: by far, or where every cell of six by six folds.
@pytest.mark.parametrize(
    ("family", "seed", "box"),
    first_rows(
        1,
        [
            ("rough", 17, (0.01, 4)),
            ("u-turn", 44, (1 / 64, 16)),
            ("u-turn", 12, (1 / 64, 16)),
            ("rough", 51, (1 / 8, 4)),
        ],
    ),
)
def test_a_wider_box_is_never_worse(family, seed, box):
    problem = shape_problem(family, seed)
    # Of one layout: which ones are tried depends on what is found.
    layout = {"degree_u": 5, "middle_curves": 0, "alpha_v": "constant"}
    narrow, wide = (
        state_problem(problem.a, problem.b, **layout).problem,
        blend(problem.a, problem.b, box=box, **layout),
    )
    assert "let pass" not in wide.objective.known
    assert wide.objective.value <= 1.01 * solve_fair(narrow).value


@pytest.mark.long
def test_what_is_known_is_a_start_where_every_cell_folds():
    problem = shape_problem("rough", 17)
    narrow, wide = (state_problem(problem.a, problem.b, **more).problem for more in ({}, {"box": (1 / 8, 4)}))
    known = solve_fair(narrow)
    assert solve_fair(wide).condoned == ("folds",)
    again = solve_fair(wide, known)
    assert again.condoned == ()
    assert again.value < known.value


@pytest.mark.long
def test_where_the_lower_end_stops_the_search_the_window_begins_lower():
    a, b = facing(96)
    result = blend(a, b, middle_curves=0)
    window = state_problem(a, b).problem.bounds
    assert result.active_bounds == ()
    for found, (low, high) in zip((result.alpha2_bounds, result.beta2_bounds), window, strict=True):
        assert found == pytest.approx((low / 2, high), rel=1e-12)
    assert result.alpha2 < window[0][0]
    assert tried(result) == [(5, 0, "constant")] * 2
    # A box that was asked for stays.
    natural = state_problem(a, b).problem.natural
    arc = state_problem(a, b).problem.exits.arc
    boxed = blend(a, b, box=(1 / 4, 4), middle_curves=0)
    assert boxed.alpha2_bounds == pytest.approx((natural[0] * arc / 4, natural[0] * arc * 4))
    assert "alpha2 lower" in boxed.active_bounds


@pytest.mark.parametrize(("seed", "side", "end"), [(4, 1, "upper"), (13, 0, "upper"), (8, 1, "lower")])
def test_p2_at_the_end_of_its_range_is_named_and_warned_of(seed, side, end):
    problem = shape_problem("u-turn", seed)
    result = blend(problem.a, problem.b)
    name = "ab"[side]
    assert result.active_bounds == (f"p2 of {name} {end}",)
    (text,) = (w for w in result.warnings if w.startswith("p2"))
    assert text.startswith(f"p2 of side {name} at its {end} end {result.p2[side]:.3g}, where it moves the third row")
    assert text.endswith("; set p2, or alpha")
    # Its range is that of the third row: by at most an arc's length, in the parameter of the base.
    stated = state_problem(problem.a, problem.b).problem
    first, second = stated.contacts[side][2][:2]
    most = stated.exits.arc * stated.natural[side] * 5 * 4 / (first * second)
    assert result.p2[side] == pytest.approx(most if end == "upper" else -most, rel=1e-9)
    # Nobody is told of an end that is not met.
    assert not bound_warnings(stated, replace(found_fair(solve_fair(stated), "reduced"), fair=None))


@pytest.mark.long
@pytest.mark.parametrize(("seed", "side"), [(4, 1), (13, 0)])
def test_beyond_the_end_of_p2_the_blend_is_fairer(seed, side):
    problem = shape_problem("u-turn", seed)
    result = blend(problem.a, problem.b)

    def measured(factor):
        p2 = [value * (factor if k == side else 1.0) for k, value in enumerate(result.p2)]
        alpha = np.sqrt(result.alpha2), np.sqrt(result.beta2)
        return measure_fairness(blend(problem.a, problem.b, alpha=alpha, p2=tuple(p2)).surface).value

    assert measured(1.1) < 0.98 * measured(1.0) < 0.98 * 0.98 * measured(0.9)


@pytest.mark.long
def test_where_nothing_is_searched_there_are_no_candidates():
    a, b = random_facing(np.random.default_rng(0))
    for options in ({"alpha": "energy"}, {"alpha": 0.7}, {"continuity": "C2"}, {"method": "casadi"}):
        assert blend(a, b, **options).candidates == ()


@pytest.mark.long
def test_a_search_that_a_refusal_stopped_tries_other_layouts_and_says_what_is_left():
    rough = shape_problem("rough", 13)
    result = blend(rough.a, rough.b)
    # Its gap varies too little for a linear alpha to be tried otherwise.
    assert gap_ratio(state_problem(rough.a, rough.b).problem) < 1.5
    assert tried(result) == [(5, 0, "constant"), (5, 0, "linear")]
    assert result.options.alpha_v == "linear"
    assert result.shape.fairness.value < 0.7 * result.candidates[0].fairness
    (text,) = result.warnings
    assert text.startswith("the fairest shape was not reached: beside this blend lie fairer ones that loop")
    with pytest.raises(FoldError, match="the fairest shape was not reached"):
        blend(rough.a, rough.b, strict=True)


@pytest.mark.long
def test_a_linear_alpha_that_no_refusal_stops_is_taken_if_it_is_fairer():
    a, b = facing(217)
    result, constant = blend(a, b), blend(a, b, alpha_v="constant")
    assert 0.7 * result.candidates[0].fairness < result.objective.value < result.candidates[0].fairness
    assert result.options.alpha_v == "linear"
    assert not result.warnings
    # A constant one is stopped, and says so.
    assert any("the fairest shape was not reached" in text for text in constant.warnings)


@pytest.mark.long
def test_a_middle_curve_is_tried_where_a_refusal_stopped_a_constant_alpha():
    rough = shape_problem("rough", 51)
    assert gap_ratio(state_problem(rough.a, rough.b).problem) < candidates.MIDDLE_RATIO
    result = blend(rough.a, rough.b, alpha_v="constant")
    assert tried(result) == [(5, 0, "constant"), (5, 1, "constant")]
    assert result.options.middle_curves == 1
    assert not result.warnings


@pytest.mark.long
def test_lower_windows_start_from_what_is_known(monkeypatch):
    asked = []

    def search(problem, known, most_condoned):
        asked.append((problem, known, solve_fair(problem, known, most_condoned)))
        return asked[-1][-1]

    monkeypatch.setattr(shape_parameters, "solve_fair", search)
    problem = shape_problem("u-turn", 20)
    blend(problem.a, problem.b, degree_u=5)
    assert [known for _, known, _ in asked] == [None, asked[0][2], asked[1][2]]
    lows = [stated.bounds[0][0] for stated, *_ in asked]
    assert lows == pytest.approx([lows[0], lows[0] / 2, lows[0] / 4], rel=1e-12)


def test_closed_rims_refuse_a_linear_alpha():
    ring = np.array([[1.0, 0], [1, 1], [-1, 1], [-1, 0], [-1, -1], [1, -1], [1, 0]])
    knots = [0, 0, 0, 0.2, 0.4, 0.6, 0.8, 1, 1, 1]
    rows = [[[*(r * p), z] for p in ring] for r, z in ((1.0, 0.0), (1.2, -0.5), (1.3, -1.0))]
    tube = BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], knots, rows)
    above = BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], knots, np.array(rows) * [1.5, 1.5, -1] + [0, 0, 1.5])
    with pytest.raises(OptionError, match="alpha_v: found linear on closed contacts, expected auto or constant"):
        blend(Base(tube, "u0"), Base(above, "u0"), alpha_v="linear")


@pytest.mark.parametrize(
    ("at_end", "searched"), [((True, True), [(False, False)]), ((False, True), [(True, False), (False, False)])]
)
def test_no_search_without_p2_is_made_twice(at_end, searched):
    problem = state_problem(*facing(57)).problem
    assert [second.free for second in problem.p2] == [True, True]
    fair = FairSolution(1.0, 1.0, (0.0, 0.0), value=1.0, slope=0.0, tried=1, refused={}, at_end=at_end)
    layout = candidates.Layout(BlendOptions(box=(0.5, 2.0)), problem, Found(1.0, 1.0, "reduced", fair=fair))
    asked = []

    def search(options, problem, known, remark):
        asked.append(tuple(second.free for second in problem.p2))

    # What finds nothing leaves the layout as it is.
    assert candidates._away_from_ends(layout, search) is layout
    assert asked == searched
