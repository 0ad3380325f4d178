"""The records of the second document: of what is printed, decided anew."""

from dataclasses import replace

import pytest
import sympy as sp

from semispline.papers.ledger import Verdict, load_drafts, mutants
from semispline.papers.ledger import formula as written
from semispline.papers.ledger.loading import load_paper
from semispline.papers.ledger.verification import decide
from semispline.papers.primer.checks.curves import basis, curve_of, part_of_curve
from semispline.papers.primer.checks.general import in_general, said_again, with_empty_terms
from semispline.papers.primer.printed import blocks, steps, terms_of

PAPER = load_drafts("primer")
# One of each kind that is quick.
QUICK = ("whatis.1", "matrix.7", "aligning.3", "canonical.8", "extremities.1", "reordering.6", "matrixsplit.9")


@pytest.mark.long
def test_the_records_are_complete_and_of_what_is_printed():
    found = [claim.id for claim in load_paper("primer").claims]
    assert set(found) <= set(blocks())
    assert all(claim.printed is not None and claim.printed.text == blocks()[claim.id].text for claim in PAPER.claims)


@pytest.mark.parametrize("identifier", QUICK)
def test_a_verdict_comes_out_as_recorded(identifier):
    assert decide(PAPER.claim(identifier), PAPER.folder).ok


@pytest.mark.slow
@pytest.mark.parametrize("claim", PAPER.claims, ids=lambda claim: claim.id)
def test_each_verdict_comes_out_as_recorded(claim):
    assert decide(claim, PAPER.folder).ok


def test_another_verdict_is_noticed():
    claim = replace(PAPER.claim("matrix.7"), verdict=Verdict.FAILS)
    assert not decide(claim, PAPER.folder).ok


@pytest.mark.parametrize("identifier", ["explanation.6", "matrix.2", "aligning.2"])
def test_terms_add_up_to_what_is_read(identifier):
    rights = [step.right for step in steps(identifier)]
    assert [sp.expand(sum(found) - right) for found, right in zip(terms_of(identifier), rights, strict=True)] == [
        0 for _ in rights
    ]


def test_the_construction_is_that_of_the_polynomials():
    t = sp.Symbol("t")
    for n in range(5):
        true = [sp.binomial(n, i) * t**i * (1 - t) ** (n - i) for i in range(n + 1)]
        assert all(sp.expand(a - basis(n, i, t)) == 0 for i, a in enumerate(true))
    points = list(sp.symbols("p:4"))
    curve = curve_of(lambda i: points[i])
    parts = part_of_curve(points, sp.Rational(1, 3), sp.Rational(1, 2))
    part = curve_of(lambda i: parts[i])
    assert sp.expand(part(3, t) - curve(3, sp.Rational(1, 3) + t / 6)) == 0


def test_only_terms_that_are_zero_may_be_lost():
    n, i = sp.symbols("n i", integer=True, nonnegative=True)
    B = sp.Function("B")
    one_more, exact = (
        with_empty_terms(written(sp.Eq(n, sp.Sum(B(i, n), (i, 0, last)), evaluate=False)), B) for last in (n + 1, n)
    )
    [lost] = [mutant.text for mutant in mutants(one_more) if one_more.equivalent_if(mutant)]
    assert "(i, 0, n)" in lost
    assert not any(exact.equivalent_if(mutant) for mutant in mutants(exact))


def test_what_is_false_in_general_alone_is_found():
    n, x = sp.symbols("n x")
    twice = written(sp.Eq(x**n, n * x, evaluate=False))
    cases = list(in_general({}, {n: 1}).cases(twice))
    assert [case.true for case in cases] == [True, False]


def test_changes_that_change_nothing_are_told_from_others():
    x, y = sp.symbols("x y")
    found = said_again(written(sp.Eq(y, x - x**2, evaluate=False)), {x: sp.Integer(0)}, "x is zero")
    assert "x is zero" in {found.equivalent_if(mutant) for mutant in mutants(found)}
    unsaid = said_again(written(sp.Eq(y, x - x**2, evaluate=False)), {}, "no reason")
    assert not any(unsaid.equivalent_if(mutant) for mutant in mutants(unsaid))
