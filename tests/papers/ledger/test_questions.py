"""Short ways to write a check: what each of them changes of the cases that it is given."""

from fractions import Fraction

import sympy as sp

from semispline.papers.checks.counts import Counting, count_check
from semispline.papers.ledger.mutation import explained
from semispline.papers.ledger.questions import premises, proved, question, unconditional
from semispline.papers.ledger.records import Case, Check, Formula, Strength
from semispline.papers.ledger.writing import data_formula

N, LAST = sp.symbols("n L", integer=True, positive=True)


def cases():
    yield Case("one", True, meets=False)
    yield Case("other", False)


def test_premises_are_no_instances_of_a_claim():
    assert [case.own for case in premises(cases())] == [False, False]
    assert [case.true for case in premises(cases())] == [True, False]


def test_a_question_is_no_proof_and_a_proof_is_one():
    assert (question(cases, "-").proof, proved(cases, "-").proof) == (False, True)
    assert [case.label for case in question(cases, "-").cases(None)] == ["one", "other"]


def test_a_part_without_a_condition_needs_every_instance():
    check = unconditional(Check(lambda _: cases(), Strength.RATIONAL, "-"))
    assert [case.meets for case in check.cases(None)] == [True, True]


def test_a_wrong_count_is_seen_in_general_and_at_each_instance():
    """Fence posts: n spans have n + 1 ends."""
    counting = Counting({LAST: N + 1}, lambda: ((f"n = {n}", {N: n, LAST: n + 1}, True) for n in (1, 2)))
    right, wrong = (Formula(sp.Eq(LAST, N + more), (LAST, N)) for more in (1, 2))
    assert [case.true for case in count_check(counting, "-").cases(right)] == [True] * 3
    assert [case.true for case in count_check(counting, "-").cases(wrong)] == [False] * 3


def test_changes_that_nothing_printed_tells_apart_have_their_reason():
    formula = data_formula("x", sp.Rational(1, 2), "printed once", [sp.Rational(1, 3)])
    assert formula.relation.rhs == Fraction(1, 2)
    assert formula.undecidable == {"Eq(x, 1/3)": "printed once"}


def test_only_mutants_that_say_the_same_where_it_is_meant_are_explained():
    x, y, z = sp.symbols("x y z")
    formula = Formula(sp.Eq(z, x - y), (x, y, z))
    assert set(explained(formula, {x: y}, "x is y").equivalent.values()) == {"x is y"}
    assert not explained(formula, {}, "nothing is put in").equivalent
