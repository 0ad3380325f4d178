"""What counts as one derivative on both sides of a knot line, and which jumps both sides of a blend share."""

from types import SimpleNamespace

import numpy as np
import pytest

from semispline.solver.blending import candidates, fair_search, representative, shape_parameters
from semispline.solver.blending.candidates import _may_want_a_middle_curve, _pays_without_p2
from semispline.solver.blending.facing import _coincide
from semispline.solver.blending.fair_objective import FairObjective
from semispline.solver.blending.fairness_table import LOOPS
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.jumps import _lambda, _without_joint, jumps
from semispline.solver.blending.knot_lines import knot_lines
from semispline.solver.blending.layout import (
    _check_carries,
    _every_fourth,
    _paired_means,
    fourth_basis,
    middle_bases,
    middle_basis,
    middle_degree,
)
from semispline.solver.blending.problem import BlendProblem, _check_bends_continuously
from semispline.solver.blending.representative import (
    _is_closed,
    _jump_alike,
    has_free_rows,
    needs_constant_weights,
    read_rows,
)
from semispline.solver.blending.rounding import EnergyRounding, _weight_spread
from semispline.solver.blending.smooth_rows import smooth_rows
from semispline.solver.blending.warnings import strained_by
from semispline.solver.blending.weights import normalised_rows, rows_from_derivatives
from semispline.solver.blending.windows import second_weight
from semispline.solver.errors import OptionError
from semispline.solver.options import BlendOptions
from semispline.solver.splines import Basis

EPS = float(np.finfo(float).eps)
UNEVEN = Basis(1, np.array([0, 0, 1, 3, 3.0]))


@pytest.mark.parametrize("size", [1.0, 1e-9])
def test_sixteen_roundings_of_the_largest_coordinate_over_the_shorter_span(size):
    inner, seam = knot_lines(size * np.array([[[0.0], [1.0], [3.0]]]), UNEVEN, 1, closed=True)
    # A slope is a difference of two control points over a span of 1, or 2.
    expected = 16 * EPS * 3 * size * np.array([1, 2])
    assert inner.rounding == pytest.approx(expected, rel=1e-12, abs=0)
    assert seam.rounding == pytest.approx(expected, rel=1e-12, abs=0)


def test_rows_that_were_larger_are_rounded_more():
    (line,) = knot_lines(np.array([[[0.0], [1.0], [3.0]]]), UNEVEN, 0, largest=12.0)
    assert line.rounding == pytest.approx([16 * EPS * 12], rel=1e-12, abs=0)


@pytest.mark.parametrize(("excess", "continuity"), [(1e-10, 1), (1e-8, 0)])
def test_slopes_are_one_up_to_a_billionth(excess, continuity):
    (line,) = knot_lines(np.array([[[0.0], [1.0], [3.0 + 2 * excess]]]), UNEVEN, 1)
    assert line.continuity == continuity


def test_a_kink_in_a_plane_is_no_crease_where_there_is_a_second_row():
    edge = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0.0]])
    inwards = edge + np.array([-0.5, 0.5, 0])
    (alone,) = jumps(edge[None], UNEVEN, 1, (1.0,))
    (together,) = jumps(np.stack([edge, inwards]), UNEVEN, 1, (1.0,))
    assert (alone.kind, alone.degrees) == ("creased", pytest.approx(90, abs=1e-12))
    assert (together.kind, together.degrees) == ("G1", pytest.approx(0, abs=1e-12))


def test_ends_that_are_apart_share_nothing():
    straight = np.array([[[0, 0, 0], [1, 0, 0], [3, 0, 0.0]]])
    (seam,) = jumps(straight, UNEVEN, 1, (1.0,), closed=True)
    assert seam.kind != "shared"


def sides(**change):
    """A side over a domain of length 2, and what both sides have: one shared jump each, the second one's changed."""
    one = {"kind": "shared", "v": 0.5, "speed": 4.0, "slope": 3.0}
    found = [SimpleNamespace(conic=None, found=(SimpleNamespace(**jump),)) for jump in (one, one | change)]
    return SimpleNamespace(along=Basis(1, np.array([0, 0, 2.0, 2]))), *found


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("name", "value", "unit"), [("v", 0.5, 2.0), ("speed", 4.0, 4.0), ("slope", 3.0, 0.5)])
@pytest.mark.parametrize(("times", "alike"), [(1e-10, True), (1e-8, False)])
def test_jumps_are_alike_up_to_a_billionth(name, value, unit, times, alike, sign):
    assert _jump_alike(*sides(**{name: value + sign * times * unit})) is alike


def test_jumps_of_other_kinds_are_not_alike():
    assert _jump_alike(*sides())
    assert not _jump_alike(*sides(kind="G1"))


@pytest.mark.parametrize(
    ("continuities", "middle", "free"),
    [(("G2", "G2"), 0, False), (("G3", "G2"), 0, False), (("G2", "G1"), 0, True), (("G2", "G2"), 1, True)],
)
def test_rows_are_free_below_second_order_and_between(continuities, middle, free):
    assert has_free_rows(BlendOptions(continuity=continuities, middle_curves=middle)) is free


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (2 * (1 + 1e-10), ("x lower",)),
        (2 * (1 + 1e-8), ()),
        (8 * (1 - 1e-8), ()),
        (8 * (1 - 1e-10), ("x upper",)),
    ],
)
def test_a_bound_is_met_up_to_a_billionth(monkeypatch, value, said):
    monkeypatch.setattr(shape_parameters, "shape_unknowns", lambda problem, found: [("x", value, 2.0, 8.0)])
    assert shape_parameters.alpha_bounds(None, None) == said


@pytest.mark.parametrize(
    ("named", "constant"),
    [
        ({}, False),
        ({"alpha": ("energy", 1.0)}, True),
        ({"alpha": ((1.0, 2.0), 1.0)}, True),
        ({"alpha": ("fair", "fair"), "alpha_v": "linear"}, True),
        ({"alpha": ("fair", "fair"), "alpha_v": "constant"}, False),
        ({"middle_curves": 1}, True),
    ],
)
def test_weights_are_constant_where_alpha_is_minimised_linear_or_rows_are_free(named, constant):
    options = BlendOptions(**{"continuity": ("G2", "G2"), "middle_curves": 0, "alpha": (1.0, 2.0)} | named)
    assert needs_constant_weights(options) is constant


@pytest.mark.parametrize(("share", "matters"), [(5e-4, False), (2e-3, True)])
def test_rounding_of_a_thousandth_matters(share, matters):
    assert EnergyRounding(1.0, share).matters is matters


def test_weights_spread_over_all_rows():
    curves = [SimpleNamespace(weights=w) for w in (np.array([1.0, 2.0]), None, np.array([4.0, 3.0]))]
    assert _weight_spread(SimpleNamespace(control_curves=curves)) == 4
    assert _weight_spread(SimpleNamespace(control_curves=curves[1:2])) == 1


def test_position_alone_has_no_derivatives():
    assert rows_from_derivatives(0, 3, (1.0,)).tolist() == [[1]]


@pytest.mark.parametrize(("degrees", "degree"), [((2, 2), 2), ((2, 5), 3), ((4, 6), 4), ((6, 4), 4), ((1, 2), 3)])
def test_middle_curves_have_the_lower_degree_and_are_cubic_at_least(degrees, degree):
    a, b = (Basis(p, np.repeat([0.0, 1.0], p + 1)) for p in degrees)
    assert middle_degree(a, b) == degree


def simple(degree, times=1):
    return Basis(degree, np.concatenate([np.zeros(degree + 1), [0.5] * times, np.ones(degree + 1)]))


@pytest.mark.parametrize(("degree", "order", "is_carried"), [(4, 3, True), (3, 3, False), (2, 2, True)])
def test_a_knot_of_a_blend_carries_the_order_of_its_contacts(degree, order, is_carried):
    if is_carried:
        _check_carries(simple(degree), order, 8)
    else:
        with pytest.raises(OptionError, match="carries at most G2"):
            _check_carries(simple(degree), order, 8)


@pytest.mark.parametrize(
    ("degree", "times", "name"),
    [(3, 1, None), (4, 2, None), (2, 1, "degree_u"), (2, 2, "degree_u"), (3, 2, "u_knots"), (4, 3, "u_knots")],
)
def test_curvature_is_continuous_across_knots_for_the_fairest_shape(degree, times, name):
    if name is None:
        _check_bends_continuously(simple(degree, times))
    else:
        with pytest.raises(OptionError, match=f"^{name}: "):
            _check_bends_continuously(simple(degree, times))


def test_middle_curves_alone_are_smoother_across_the_seam_than_the_contacts():
    rows = [simple(5, 3)] * 5
    problem = SimpleNamespace(
        seam_order=1, form=SimpleNamespace(rows=rows), a=SimpleNamespace(count=2), b=SimpleNamespace(count=2), rows=rows
    )
    # Degree 5, nine control points: as smooth as eight of them at both ends allow.
    assert [BlendProblem.seam_order_of(problem, row) for row in range(5)] == [1, 1, 3, 1, 1]


@pytest.mark.parametrize(("order", "is_tried"), [(-1, True), (0, True), (1, True), (2, False), (3, False)])
def test_rows_without_close_knots_keep_points_for_their_seam(order, is_tried):
    # Four points are left where two knots were close.
    row = Basis(3, np.array([0, 0, 0, 0, 1e-9, 2, 2, 2, 2.0]))
    form = EnergyForm(Basis(2, np.array([0, 0, 0, 1.0, 1, 1])), (row,) * 3)
    found = smooth_rows(form, range(1, 2), [order])
    assert (found is not None) is is_tried
    if found is not None:
        step, _ = found.correction(np.random.default_rng(0).normal(size=(row.size, 3)))
        assert bool(np.abs(step[0] - step[-1]).max() < 1e-10) is (order >= 0)


@pytest.mark.parametrize(("off", "degree"), [(5e-15, 1), (1e-12, 2)])
def test_means_that_differ_by_rounding_change_no_rows(off, degree):
    line = Basis(1, np.array([0, 0, 1, 1.0]))
    rows = np.ones((3, 2, 4))
    rows[1:, :, 3] += off * np.array([1, 3])[:, None]
    assert normalised_rows(rows, line, 1, (1.0, 1.0))[1] == degree


@pytest.mark.parametrize(("end", "closed"), [((3.0, 0, 0), False), ((0.0, 0, 0), True)])
def test_a_ring_with_a_corner_is_closed(end, closed):
    row = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], end])
    along = Basis(1, np.array([0, 0, 1, 2, 3, 3.0]))
    side = SimpleNamespace(rows=row[None].repeat(3, axis=0), order=0, along=along, largest=3.0)
    assert _is_closed(side) is closed
    # The second row is read whatever the order is.
    assert [len(read_rows(SimpleNamespace(rows=side.rows, order=order))) for order in (0, 1, 2)] == [2, 2, 3]


def test_p2_moves_the_third_row_by_both_spans_over_two_degrees():
    assert second_weight(3, (2.0, 6.0)) == 2


@pytest.mark.parametrize(
    ("names", "cured"), [((None, None), False), ((None, "none"), False), (("none", "spans"), True)]
)
def test_what_a_cure_changed_is_cured(names, cured):
    cures = tuple(name and SimpleNamespace(name=name) for name in names)
    assert BlendProblem.is_cured.fget(SimpleNamespace(cures=cures)) is cured


@pytest.mark.parametrize(("bulge", "said"), [(1.5, "bulge of side b is 1.5: try one nearer to 1"), (1.0, "")])
def test_a_bulge_that_strains_is_named(bulge, said):
    found = SimpleNamespace(a=1.0, b=1.0, p2=(0.0, 1e9))
    assert strained_by(BlendOptions(bulge=(1.0, bulge)), found, 1) == said


def test_middle_knots_are_those_of_the_paper_or_every_fourth():
    a, b = (Basis(1, np.array([0, 0, *inner, 1, 1])) for inner in ([0.5], [0.1, 0.2, 0.8, 0.9]))
    for name, one in (("paper", middle_basis(a, b)), ("fourth", fourth_basis(a, b))):
        (found,) = middle_bases(a, b, 1, name)
        assert found.knots.tolist() == one.knots.tolist()
    assert middle_basis(a, b).size != fourth_basis(a, b).size


def test_every_fourth_knot_is_alike_from_both_ends():
    places = {n: _every_fourth(np.arange(float(n))).tolist() for n in (1, 4, 5, 9, 11)}
    assert places == {1: [0], 4: [1, 2], 5: [1, 3], 9: [1, 4, 7], 11: [1, 5, 9]}


def test_knots_are_averaged_in_pairs_from_both_ends():
    means = {n: _paired_means(np.arange(float(n)) ** 2).tolist() for n in (1, 3, 4, 5, 7)}
    assert means == {1: [0], 3: [5 / 3], 4: [0.5, 6.5], 5: [0.5, 4, 12.5], 7: [0.5, 29 / 3, 30.5]}


@pytest.mark.parametrize(("octaves", "more"), [(0.45, 0), (0.55, 1), (-0.45, 0)])
def test_cells_of_a_scan_are_of_one_size(octaves, more):
    problem = SimpleNamespace(bounds=((1.0, 2.0), (0.5, 8 * 2**octaves)), exits=SimpleNamespace(u_turn=False))
    assert fair_search._cells(problem) == fair_search._CELLS + more


@pytest.mark.parametrize(("p2", "end"), [(-1 + 1e-10, "lower"), (-1 + 1e-8, ""), (1 - 1e-8, ""), (1 - 1e-10, "upper")])
def test_an_end_of_p2_is_met_up_to_a_billionth(p2, end):
    unknowns = SimpleNamespace(ends=(slice(0, 1),), low=np.array([0, -1.0]), high=np.array([0, 1.0]))
    assert fair_search._p2_end(unknowns, np.array([0, p2]), 0) == end


@pytest.mark.parametrize(
    ("condoned", "ends", "fairness", "pays"),
    [
        ((0, 1), (True, True), 9.0, True),
        ((1, 0), (False, False), 0.0, False),
        ((0, 0), (False, True), 1.0, True),
        ((0, 0), (False, True), 9.0, False),
        ((0, 0), (True, True), 0.5, False),
    ],
)
def test_a_side_goes_without_p2_for_less_to_let_pass_or_an_end_that_is_left(condoned, ends, fairness, pays):
    def layout(count, at_end, value):
        fair = SimpleNamespace(at_end=at_end)
        return SimpleNamespace(found=SimpleNamespace(condoned=(0,) * count, fair=fair, fairness=value))

    without, best = layout(condoned[0], ends, fairness), layout(condoned[1], (True, True), 1.0)
    assert _pays_without_p2(without, best) is pays


@pytest.mark.parametrize("fall", [0.3, -0.3])
def test_a_factor_whose_slopes_fall_alike_is_quadratic(fall):
    basis, points = _lambda(np.array([0, 1.0, 2]), np.full(3, fall), closed=False)
    assert basis.degree == 2
    assert points.ravel() == pytest.approx([1, 1 - fall / 4, 1, 1 - fall / 4, 1], abs=1e-15)


@pytest.mark.parametrize(("times", "left"), [(1, 1), (2, 1), (0, 0)])
def test_only_a_knot_of_full_multiplicity_loses_a_copy(times, left):
    basis = simple(2, times)
    rows, found = _without_joint(np.zeros((2, basis.size, 3)), basis, 0.5)
    assert (np.count_nonzero(found.knots == 0.5), rows.shape[1]) == (left, found.size)


@pytest.mark.parametrize(
    ("bulges", "a", "b", "p2"), [((3.0, 5.0), 6.0, 5.0, (9.0, 50.0)), ((1.0, 1.0), 2.0, 1.0, (1.0, 2.0))]
)
def test_a_bulge_scales_alpha_and_twice_p2(bulges, a, b, p2):
    found = shape_parameters.bulged(shape_parameters.Found(2.0, 1.0, method="linear", p2=(1.0, 2.0)), bulges)
    assert (found.a, found.b, found.p2) == (a, b, p2)


@pytest.mark.parametrize("free", [(True, False), (False, True), (True, True), (False, False)])
def test_one_free_shape_parameter_is_searched(monkeypatch, free):
    monkeypatch.setattr(shape_parameters, "solve_fair", lambda *_: "solution")
    monkeypatch.setattr(shape_parameters, "found_fair", lambda solution, method: "found")
    second = SimpleNamespace(at=lambda a: 0.0)
    problem = SimpleNamespace(free=free, given=(1.0, 1.0), p2=(second, second))
    found = shape_parameters.find_shape_parameters(problem, BlendOptions(alpha="fair"))
    assert (found == "found") is any(free)


@pytest.mark.parametrize(
    ("cures", "alike", "is_left"),
    [(("none", "none"), False, True), (("spans", "none"), False, False), (("spans", "spans"), True, True)],
)
def test_what_both_sides_share_is_left_along(monkeypatch, cures, alike, is_left):
    found = [SimpleNamespace(cure=cure) for cure in cures]
    monkeypatch.setattr(representative, "_cured", lambda side, order: found[side.index])
    monkeypatch.setattr(representative, "_jump_alike", lambda *_: alike)
    monkeypatch.setattr(representative, "_as_found", lambda cured: "left")
    monkeypatch.setattr(representative, "_with_cure", lambda side, cured, by_angle: (side, "cured"))
    a, b = (SimpleNamespace(order=2, index=index, is_rational=False, keeps_lines=False) for index in (0, 1))
    options = BlendOptions(continuity=("G2", "G2"), middle_curves=0)
    said = [cure for _, cure in representative.smooth_along(a, b, options)]
    assert said == ["left" if is_left else "cured"] * 2


@pytest.mark.parametrize(("slope", "coincides"), [(0.0, True), (1.0, False)])
def test_curves_that_touch_at_their_start_alone_do_not_coincide(slope, coincides):
    def side(rise):
        return SimpleNamespace(
            along=Basis(1, np.array([0, 0, 1, 1.0])),
            edge=lambda x: (np.stack([x, rise * x, 0 * x], axis=1), None),
            tangents=lambda x: np.tile([1, rise, 0.0], (len(x), 1)),
        )

    assert _coincide(side(0.0), side(slope)) is coincides


@pytest.mark.parametrize(
    ("refused", "value", "why"), [(0, 1.0, ""), (0, np.inf, "fold"), (3, 1.0, "fold"), (LOOPS, 1.0, "loop")]
)
def test_a_place_without_a_value_says_why(refused, value, why):
    measured = SimpleNamespace(refused=np.array([refused]), values=np.array([value]))
    objective = SimpleNamespace(
        table=SimpleNamespace(measure=lambda monomials: measured),
        unknowns=SimpleNamespace(monomials=lambda y: (y, None)),
    )
    assert FairObjective.refusal(objective, np.zeros(2)) == why


@pytest.mark.parametrize(
    ("change", "wants"),
    [
        ({}, True),
        ({"stopped_by": "fold", "degree_u": 7}, True),
        ({"stopped_by": "fold", "u_turn": True}, True),
        ({"seam_order": 0}, False),
        ({"seam_order": 1}, False),
        ({"has_constant_weights": False}, False),
        ({"alpha_v": "linear"}, False),
    ],
)
def test_open_pairs_of_constant_alpha_and_weights_may_want_a_middle_curve(change, wants):
    one = {"alpha_v": "constant", "degree_u": 5, "seam_order": -1, "has_constant_weights": True, "u_turn": False}
    said = SimpleNamespace(**{"stopped_by": ""} | one | change)
    said.exits = said
    assert _may_want_a_middle_curve(SimpleNamespace(options=said, problem=said, found=said)) is wants


@pytest.mark.parametrize(
    ("wide", "is_known"), [((1.0, 8.0), True), ((0.5, 4.0), True), ((1.0, 4.0), False), ((2.0, 8.0), False)]
)
def test_a_box_that_only_adds_to_the_window_cannot_be_worse(monkeypatch, wide, is_known):
    def problem(a, b, options):
        return SimpleNamespace(bounds=((1.0, 4.0), wide if options.box else (1.0, 4.0)))

    monkeypatch.setattr(candidates, "make_problem", problem)
    monkeypatch.setattr(candidates, "_is_searched", lambda *_: True)
    monkeypatch.setattr(candidates, "find_shape_parameters", lambda *_: SimpleNamespace(fair="known"))
    found = candidates._known_within(None, None, BlendOptions(alpha="fair", box=(0.5, 8.0)))
    assert found == ("known" if is_known else None)
