"""Drafts: what is not complete runs, what it lacks is said, and nothing that is wrong passes for a finding."""

from dataclasses import replace

import pytest
import sympy as sp

from semispline.papers.ledger.drafts import examine, is_draft, verify_drafts
from semispline.papers.ledger.records import Case, Check, Claim, Correction, Counterexample, Formula, Strength, Verdict
from semispline.papers.ledger.writing import corrected, draft, fails, holds, holds_if, part, parts, reading

x, y = sp.symbols("x y", real=True)
RIGHT, WRONG = (Formula(sp.Eq(y, n * x), (x, y)) for n in (2, 3))


def cases(formula):
    for value in (0, 1, 2):
        residual = formula.relation.rhs.subs(x, value) - 2 * value
        yield Case(f"x = {value}", bool(residual == 0), residual=residual)


def search(formula):
    return Counterexample((("x", "1"),), str(formula.relation.rhs.subs(x, 1)), "2")


CHECK = Check(cases, Strength.RATIONAL, "doubling", search=search)


def test_a_claim_without_a_verdict_shows_what_it_amounts_to():
    found = examine(draft("eq-1", "here", "y is three times x.", part(CHECK, WRONG)))
    (finding,) = found.readings[0].parts
    assert (finding.true, finding.false) == (("x = 0",), ("x = 1", "x = 2"))
    assert (finding.residual, finding.counterexample) == (1, "x = 1: printed 3, true 2")
    assert finding.mutation.tried > 0
    assert found.amounts_to is Verdict.FAILS
    assert found.missing == (
        "no verdict, expected one of holds, holds-if, fails, ambiguous, definition, not-checkable",
        "fails without a correction, expected what is true instead, with its check",
    )


def test_a_failing_claim_is_complete_with_its_correction_and_the_search_of_its_check():
    failing = fails("eq-1", "here", "y is three times x.", part(CHECK, WRONG))
    assert is_draft(failing)
    assert examine(failing).amounts_to is Verdict.FAILS
    assert not is_draft(replace(failing, correction=corrected("y is twice x", part(CHECK, RIGHT))))
    wrong = examine(replace(failing, correction=corrected("y is thrice x", part(CHECK, WRONG))))
    assert "a correction that holds" in wrong.missing


def test_a_verdict_that_its_checks_do_not_amount_to_is_told():
    found = examine(holds("eq-1", "", "y is three times x.", *parts(CHECK, RIGHT, WRONG)))
    assert "checks that amount to holds: they amount to fails" in found.missing


def test_readings_that_differ_are_ambiguous():
    one, other = reading("twice", part(CHECK, RIGHT)), reading("thrice", part(CHECK, WRONG))
    found = examine(Claim("eq-1", "here", "A multiple.", None, (one, other)))
    assert [r.amounts_to for r in found.readings] == [Verdict.HOLDS, Verdict.FAILS]
    assert found.amounts_to is Verdict.AMBIGUOUS


def test_a_condition_may_still_be_missing():
    elsewhere = Check(lambda _: [Case("a", True), Case("b", False, own=False, meets=False)], Strength.RATIONAL, "given")
    found = examine(draft("eq-1", "here", "Something.", part(elsewhere)))
    assert found.amounts_to is Verdict.HOLDS_IF
    assert "holds-if without its condition" in found.missing
    with_one = examine(replace(holds_if("eq-1", "here", "Something.", "a", part(elsewhere)), verdict=None))
    assert with_one.amounts_to is Verdict.HOLDS_IF
    assert len(with_one.missing) == 1


@pytest.mark.parametrize(
    ("check", "problem"),
    [
        (Check(lambda _: [], Strength.RATIONAL, "nothing"), "no instance"),
        (Check(lambda _: [Case("a", None)], Strength.RATIONAL, "silent"), "no answer for a"),
        (Check(lambda _: 1 / 0, Strength.RATIONAL, "broken"), "ZeroDivisionError"),
    ],
)
def test_a_check_without_an_answer_amounts_to_nothing(check, problem):
    found = examine(draft("eq-1", "here", "Something.", part(check), part(CHECK, RIGHT)))
    assert problem in found.readings[0].parts[0].problem
    assert found.amounts_to is None


def test_a_draft_without_a_check_says_what_it_may_become():
    found = examine(draft("eq-1", "here", "Something."))
    assert any("definition" in what for what in found.missing)


def test_a_check_that_does_not_end_is_stopped():
    def endless(_):
        while True:
            pass
        yield

    found = examine(draft("eq-1", "here", "Something.", part(Check(endless, Strength.RATIONAL, "-"))), time_limit=0.2)
    assert "no answer within 0.2 s" in found.readings[0].parts[0].problem


def test_complete_records_are_decided_beside_drafts(made_up_paper):
    claims = made_up_paper() / "claims.py"
    text = claims.read_text()
    # The second one loses its correction.
    assert 'Correction("n(n+1)/2", (Part(CHECK, pr.RIGHT),)),' in text
    claims.write_text(text.replace('Correction("n(n+1)/2", (Part(CHECK, pr.RIGHT),)),', "None,"))
    ledger, drafts = verify_drafts(str(claims.parent), workers=1)
    assert ([d.id for d in ledger.decisions], [d.id for d in drafts]) == (["eq-1"], ["eq-2"])
    assert ledger.ok
    assert drafts[0].amounts_to is Verdict.FAILS


def test_the_correction_of_a_draft_needs_no_formula_to_run():
    failing = fails("eq-1", "here", "y is three times x.", part(CHECK, WRONG))
    found = examine(replace(failing, correction=Correction("", (part(CHECK),))))
    assert found.correction is not None
    assert found.correction.amounts_to is None
