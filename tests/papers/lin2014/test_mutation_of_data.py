"""Printed numbers are perturbed like formulas: each change is noticed, or is one that nothing printed can tell."""

from fractions import Fraction

import pytest
import sympy as sp

from semispline.papers.ledger.loading import load_paper
from semispline.papers.ledger.mutation import mutants, try_mutants
from semispline.papers.ledger.number_lists import Knots, Numbers, inner_moves, knot_changes, number_changes
from semispline.papers.ledger.records import Case, Check, Formula, Part, Strength
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as printed
from semispline.papers.lin2014.checks import other_methods, printed_numbers, trimming
from semispline.papers.lin2014.checks.fewer_control_points import (
    FEWER_COSTS_MORE,
    difference_cases,
    fewer_cases,
    least_energies,
)

V = sp.Symbol("V")


def of(data):
    return Formula(sp.Eq(V, data, evaluate=False), (V,))


def test_the_changes_of_a_knot_vector():
    half, quarter = sp.Rational(1, 2), sp.Rational(1, 4)
    changes = set(knot_changes(Knots(0, 0, half, 1, 1)))
    assert {Knots(0, half, 1, 1), Knots(0, 0, 1, 1), Knots(0, 0, half, 1)} <= changes  # lost
    assert {Knots(0, 0, 0, half, 1, 1), Knots(0, 0, half, half, 1, 1)} <= changes  # doubled
    assert {Knots(0, 0, quarter, 1, 1), Knots(0, 0, 3 * quarter, 1, 1)} <= changes  # moved, still increasing
    assert {Knots(0, quarter, half, 1, 1), Knots(0, half, 0, 1, 1), Knots(0, 0, 1, half, 1)} <= changes  # out of order
    assert {mutant.kind for mutant in mutants(of(Knots(0, 0, half, 1, 1)))} == {"knot"}


def test_the_changes_of_numbers():
    assert set(number_changes(Numbers(6, 5))) == {Numbers(7, 5), Numbers(5, 5), Numbers(6, 6), Numbers(6, 4)}
    kinds = {mutant.relation.rhs: mutant.kind for mutant in mutants(of(Numbers(6, 5)))}
    assert kinds[Numbers(5, 6)] == "index"
    assert kinds[Numbers(6, 4)] == "number"
    x = sp.Symbol("x")
    found = {m.relation.rhs: m.kind for m in mutants(Formula(sp.Eq(V, sp.Rational(3, 10) * x), (V, x)))}
    assert found[sp.Rational(31, 100) * x] == "number"
    bare = {m.relation.rhs: m.kind for m in mutants(Formula(sp.Ge(V, 5), (V,)))}
    assert (bare[sp.Integer(6)], bare[sp.Integer(4)]) == ("number", "number")


def test_a_reason_is_counted_apart_and_only_for_its_own_mutant():
    def cases(formula):
        yield Case("length", len(formula.relation.rhs) == 5)

    check = Check(cases, Strength.RATIONAL, "length")
    knots = Knots(0, 0, sp.Rational(1, 2), 1, 1)
    plain = try_mutants(Part(check, of(knots)))
    assert plain.survivors
    reasons = {str(sp.Eq(V, moved, evaluate=False)): "printed once" for moved in inner_moves(knots)}
    explained = try_mutants(Part(check, Formula(of(knots).relation, (V,), undecidable=reasons)))
    assert {text for text, _ in explained.undecidable} == set(reasons)
    assert len(explained.survivors) == len(plain.survivors) - len(reasons)
    assert explained.noticed == plain.noticed


@pytest.mark.parametrize("key", sorted(pr.KNOTS))
def test_of_a_printed_vector_only_moved_inner_knots_go_unnoticed(key):
    cases = {"fig-5.first": printed_numbers.first_vector_5_cases, "fig-10.first": printed_numbers.first_vector_10_cases}
    formula = printed.VECTORS[key]
    check = Check(cases.get(key, printed_numbers.knot_cases(key)), Strength.RATIONAL, "x")
    assert all(case.true for case in check.cases(formula)) == (key != "fig-10.first")
    result = try_mutants(Part(check, formula))
    assert result.survivors == ()
    assert result.tried >= 2 * len(set(pr.KNOTS[key]))
    moved = {str(sp.Eq(formula.relation.lhs, x, evaluate=False)) for x in inner_moves(formula.relation.rhs)}
    assert {text for text, _ in result.undecidable} == (set() if key in cases else moved)


@pytest.mark.long
def test_every_reason_belongs_to_a_mutant_that_is_made():
    """A reason without its mutant would explain nothing, and might hide a check that has become stronger."""
    for claim in load_paper("lin2014").claims:
        for formula in claim.formulas + claim.corrected_formulas:
            if reasons := set(formula.equivalent) | set(formula.undecidable):
                assert reasons <= {mutant.text for mutant in mutants(formula)}, claim.id


def test_a_size_of_table_1_is_tied_to_the_knots():
    check = Check(printed_numbers.size_cases("fig-6", 1), Strength.RATIONAL, "x")
    assert all(case.true for case in check.cases(printed.SIZE["fig-6"][1]))
    for wrong in (Numbers(5, 9), Numbers(5, 7), Numbers(3, 8), Numbers(8, 5)):
        assert not all(case.true for case in check.cases(of(wrong))), wrong


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(printed.SIDE_CURVES))
def test_a_curve_of_fig_3_that_misses_its_neighbours_is_noticed(name):
    formula = printed.SIDE_CURVES[name]
    check = Check(trimming.curve_cases(name), Strength.RATIONAL, "x")
    assert all(case.true for case in check.cases(formula))
    terms = trimming.bezier_terms(formula)
    ends = {0, max(terms)}
    for text, _ in try_mutants(Part(check, formula)).undecidable:
        changed = trimming.bezier_terms(Formula(sp.sympify(text, locals={"B": pr.B}), ()))
        assert all(changed[i] == terms[i] for i in ends)


def test_fig_3_as_it_was_printed():
    """The numbers once more, typed from the paper: left, right, bottom, top."""
    hole = trimming.hole()
    found = [(s.start, s.end, *s.coefficients) for s in (hole.left, hole.right, hole.bottom, hole.top)]
    typed = ("0.4 0.6 0.3 0.1 0.25", "0.2 0.5 0.8 0.75", "0.3 0.8 0.4 0.7 0.1 0.2", "0.25 0.75 0.6 0.8 0.3 0.5")
    assert found == [tuple(map(Fraction, numbers.split())) for numbers in typed]


def test_fewer_control_points_cost_more_by_a_sum_of_two_squares():
    assert [case.true for case in difference_cases(FEWER_COSTS_MORE)] == [True, True]
    assert not any(case.true for case in fewer_cases(pr.FEWER_IS_BETTER))
    # A step at rest: 17/3 more, so that the second square is zero there.
    energies = least_energies(*map(sp.Integer, (0, 0, 0, 1, 0, 0)))
    assert energies[pr.energy_6] - energies[pr.energy_7] == sp.Rational(17, 3)
    # A parabola, which both spaces contain: its energy is 4 in both.
    parabola = least_energies(*map(sp.Integer, (0, 0, 2, 1, 2, 2)))
    assert set(parabola.values()) == {4}


def test_a_quintic_is_needed_and_enough():
    cases = list(other_methods.hermite_cases(pr.QUINTIC))
    assert [case.label for case in cases if case.true] == [case.label for case in cases]
    weaker = Formula(sp.Ge(pr.degree, 4), (pr.degree,))
    assert [case.label for case in other_methods.hermite_cases(weaker) if not case.true] == ["degree 4"]


def test_the_section_of_a_canal_surface_at_numbers():
    """r = 5, r' = 3, s = 5: the section has radius 4, three back along the spine."""
    values = {other_methods.RADIUS: 5, other_methods.RADIUS_SLOPE: 3, other_methods.SPEED: 5}
    assert other_methods.SECTION_SQUARED.relation.rhs.subs(values) == 16
    assert all(case.true for case in other_methods.canal_cases(other_methods.SECTION_SQUARED))
    wrong = Formula(sp.Eq(other_methods.SECTION, other_methods.RADIUS), (other_methods.SECTION, other_methods.RADIUS))
    assert not all(case.true for case in other_methods.canal_cases(wrong))
