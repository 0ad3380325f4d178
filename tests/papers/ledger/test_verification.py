"""Deciding: the made-up paper, and every way in which a check may fail to decide."""

import signal
import time
from dataclasses import replace

import pytest
import sympy as sp

from semispline.papers.ledger.mutation import mutants, try_mutants
from semispline.papers.ledger.records import (
    Case,
    Cause,
    Check,
    Claim,
    Consequence,
    Correction,
    Counterexample,
    Formula,
    Paper,
    Part,
    Reading,
    Strength,
    Verdict,
)
from semispline.papers.ledger.verification import Ledger, decide, verify
from semispline.solver.errors import ComputationError

x, y = sp.symbols("x y", real=True)


def check_of(*cases, proof=False, strength=Strength.RATIONAL):
    return Check(lambda formula: iter(cases), strength, "given cases", proof)


def claim_of(*cases, verdict=Verdict.HOLDS, condition="", proof=False):
    part = Part(check_of(*cases, proof=proof))
    return Claim("sec-1.x", "Section 1", "Something.", verdict, (Reading((part,), condition=condition),))


TRUE, FALSE = Case("a", True), Case("b", False)
ELSEWHERE = Case("c", False, own=False, meets=False)
EVIDENCE = {
    "correction": Correction("Something else.", (Part(check_of(TRUE)),)),
    "counterexample": lambda: Counterexample((("n", "2"),), "2", "3"),
    "consequence": lambda: Consequence("a blend", {"gap": 1.0}),
}


def test_a_made_up_paper_in_a_folder_is_decided(made_up_paper):
    ledger = verify(str(made_up_paper()), workers=1)
    assert [d.verdict for d in ledger.decisions] == [Verdict.HOLDS, Verdict.FAILS]
    assert ledger.ok
    assert ledger.decisions[1].counterexample == "n = 1: printed 1/2, true 1"
    assert ledger.decisions[1].readings[0].residual == sp.Rational(-1, 2)
    counts = ledger.counts()
    assert (counts["printed"], counts["decided"], counts["holds"], counts["fails"], counts["changed"]) == (
        2,
        2,
        1,
        1,
        0,
    )
    assert counts["mutants"] > 10
    assert counts["mutants_survived"] == 0


@pytest.mark.long
def test_workers_decide_the_same(made_up_paper):
    ledger = verify(str(made_up_paper()), workers=2)
    assert [str(d.verdict) for d in ledger.decisions] == ["holds", "fails"]
    assert ledger.ok


def test_a_changed_verdict_is_noticed(made_up_paper):
    ledger = verify(str(made_up_paper(recorded="HOLDS")), workers=1)
    assert ledger.decisions[1].verdict is Verdict.FAILS
    assert not ledger.ok
    assert ledger.counts()["changed"] == 1


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        (claim_of(TRUE), Verdict.HOLDS),
        (replace(claim_of(TRUE, FALSE, verdict=Verdict.FAILS), **EVIDENCE), Verdict.FAILS),
        (claim_of(TRUE, ELSEWHERE, verdict=Verdict.HOLDS_IF, condition="k = 4"), Verdict.HOLDS_IF),
        (Claim("c", "w", "s", Verdict.NOT_CHECKABLE, reason="no data"), Verdict.NOT_CHECKABLE),
        (Claim("c", "w", "s", Verdict.DEFINITION, reason="the rows"), Verdict.DEFINITION),
    ],
)
def test_verdicts_follow_from_the_cases(claim, verdict):
    decision = decide(claim)
    assert decision.verdict is verdict
    assert decision.ok


def ledger_of(*claims, causes=()):
    return Ledger(Paper("p", "t", "", claims, causes), tuple(decide(claim) for claim in claims))


def test_what_is_printed_agreeing_is_counted_apart_and_definitions_are_not_decided():
    agrees, contradicts = (
        replace(claim_of(case), readings=(Reading((Part(replace(check_of(case), strength=Strength.CONSISTENT)),)),))
        for case in (TRUE, FALSE)
    )
    contradicts = replace(contradicts, verdict=Verdict.FAILS, **EVIDENCE)
    name = Claim("c", "w", "s", Verdict.DEFINITION, reason="the rows")
    counts = ledger_of(agrees, contradicts, claim_of(TRUE, proof=True), name).counts()
    assert counts["printed"] == 4
    assert (counts["decided"], counts["proved"], counts["consistent"], counts["definition"]) == (3, 2, 1, 1)


def test_one_fault_is_counted_once():
    failing = replace(claim_of(FALSE, verdict=Verdict.FAILS), **EVIDENCE, cause="sign")
    causes = (Cause("sign", "A sign", "It is plus."), Cause("index", "An index", "It is 2."))
    holding = replace(claim_of(TRUE), cause="index")
    ledger = ledger_of(replace(failing, id="one"), replace(failing, id="two"), holding, causes=causes)
    assert [(cause.key, [d.id for d in found]) for cause, found in ledger.causes()] == [("sign", ["one", "two"])]
    assert ledger.counts()["causes"] == 1


def test_readings_that_differ_are_ambiguous_and_those_that_agree_are_not():
    one, other = (Reading((Part(check_of(case)),), label=case.label) for case in (TRUE, FALSE))
    claim = Claim("c", "w", "s", Verdict.AMBIGUOUS, (one, other))
    assert decide(claim).verdict is Verdict.AMBIGUOUS
    agreed = decide(replace(claim, readings=(one, replace(one, label="again"))))
    assert agreed.verdict is Verdict.HOLDS
    assert not agreed.ok


@pytest.mark.parametrize(
    ("claim", "problem"),
    [
        (claim_of(TRUE, Case("b", None)), "no answer for b"),
        (claim_of(TRUE, ELSEWHERE), "expected a stated condition"),
        (claim_of(TRUE, replace(ELSEWHERE, meets=True), condition="k = 4"), "does not separate"),
        (claim_of(replace(TRUE, own=False), ELSEWHERE, condition="k = 4"), "no instance of the paper's own setting"),
        (replace(claim_of(FALSE), **{**EVIDENCE, "counterexample": lambda: None}), "no counterexample"),
        (
            replace(claim_of(FALSE), **{**EVIDENCE, "correction": Correction("Wrong too.", (Part(check_of(FALSE)),))}),
            "correction",
        ),
        (replace(claim_of(TRUE), consequence=lambda: 1 / 0), "ZeroDivisionError"),
    ],
)
def test_no_answer_is_never_a_pass(claim, problem):
    decision = decide(claim)
    assert decision.verdict is None
    assert problem in decision.problem
    assert not decision.ok


def test_a_check_without_an_instance_is_vacuous():
    decision = decide(claim_of())
    assert decision.vacuous
    assert decision.verdict is None
    assert not decision.ok


def undecided(cases, time_limit=0.2):
    part = Part(Check(cases, Strength.RATIONAL, "given cases"))
    return decide(Claim("c", "w", "s", Verdict.HOLDS, (Reading((part,)),)), time_limit=time_limit)


def test_a_check_that_does_not_end_is_stopped_and_is_neither_a_pass_nor_a_no():
    def cases(_):
        yield FALSE
        while True:
            pass

    decision = undecided(cases)
    assert decision.verdict is None
    assert decision.problem == "undecided: out of time, no answer within 0.2 s of processor time"
    assert not decision.ok
    assert not decision.vacuous


@pytest.mark.parametrize("taken", [Exception, BaseException])
def test_a_check_that_takes_the_end_of_its_time_for_something_else_is_undecided(taken):
    def cases(_):
        try:
            while True:
                pass
        except taken:
            yield FALSE

    assert undecided(cases).problem.startswith("undecided: out of time")


def test_time_that_a_check_waits_does_not_count():
    def cases(_):
        time.sleep(0.5)
        yield TRUE

    assert undecided(cases).ok


def test_no_limit_is_left_when_a_claim_is_decided():
    for claim in (claim_of(TRUE), claim_of(TRUE, Case("b", None))):
        decide(claim)
        assert signal.getitimer(signal.ITIMER_PROF) == (0, 0)
        assert signal.getsignal(signal.SIGPROF) is signal.SIG_DFL


def test_a_ledger_names_what_gave_no_answer(made_up_paper):
    claims = made_up_paper(recorded="HOLDS") / "claims.py"
    claims.write_text(claims.read_text().replace("residual == 0,", "None if n == 4 else residual == 0,"))
    assert verify(str(claims.parent), workers=1).unanswered == ("eq-1", "eq-2")


def test_a_verdict_that_differs_is_an_answer(made_up_paper):
    ledger = verify(str(made_up_paper(recorded="HOLDS")), workers=1)
    assert not ledger.ok
    assert ledger.unanswered == ()


@pytest.mark.long
def test_a_worker_that_is_ended_is_a_failed_computation(made_up_paper):
    claims = made_up_paper() / "claims.py"
    claims.write_text(claims.read_text().replace('"""Add up, for n = 1 .. 9."""', "__import__('os')._exit(9)"))
    with pytest.raises(ComputationError, match="ended without a result: status 9"):
        verify(str(claims.parent), workers=2)


def test_only_exact_evidence_counts_as_proof():
    assert decide(claim_of(TRUE, proof=True)).proved
    assert not decide(claim_of(TRUE)).proved
    failing = replace(claim_of(FALSE, verdict=Verdict.FAILS), **EVIDENCE)
    assert decide(failing).proved
    in_floats = replace(failing, readings=(Reading((Part(check_of(FALSE, strength=Strength.FLOAT)),)),))
    assert not decide(in_floats).proved


def sum_cases(formula):
    residual = formula.relation.rhs - 2 * x
    yield Case("all x", sp.expand(residual) == 0, residual=sp.expand(residual))


def test_mutants_of_each_kind_are_made():
    i, j = sp.symbols("i j", integer=True)
    P = sp.IndexedBase("P")
    formula = Formula(
        sp.Eq(y, x**2 + sp.Sum(P[i, j], (i, 0, 3)) - 3 * x), (x, y, j, P.label), neighbours=((x, sp.Symbol("z")),)
    )
    kinds = {mutant.kind for mutant in mutants(formula)}
    assert kinds == {"sign", "factor", "exponent", "index", "limit"}
    assert all(mutant.relation != formula.relation for mutant in mutants(formula))


def test_a_check_that_sees_everything_leaves_no_survivor():
    result = try_mutants(Part(Check(sum_cases, Strength.GENERAL, "expansion"), Formula(sp.Eq(y, 2 * x), (x, y))))
    assert result.tried >= 2
    assert result.survivors == ()


def test_a_check_that_sees_nothing_is_found_out():
    blind = Part(check_of(TRUE), Formula(sp.Eq(y, 2 * x), (x, y)))
    result = try_mutants(blind)
    assert len(result.survivors) == result.tried > 0
    claim = Claim("c", "w", "s", Verdict.HOLDS, (Reading((blind,)),))
    assert not decide(claim).ok


def test_an_equivalent_mutant_needs_its_reason():
    # |x| = |-x|: the sign mutant says the same.
    def cases(formula):
        value = formula.relation.rhs.subs(x, -3)
        yield Case("x = -3", bool(abs(value) == 3), residual=abs(value) - 3)

    check = Check(cases, Strength.RATIONAL, "one value")
    plain = Formula(sp.Eq(y, x), (x, y))
    assert try_mutants(Part(check, plain)).survivors == ("sign: Eq(y, -x)",)
    explained = replace(plain, equivalent={"Eq(y, -x)": "the magnitude is the same"})
    unexplained = replace(plain, equivalent={"Eq(y, -x)": " "})
    assert try_mutants(Part(check, unexplained)).survivors == ("sign: Eq(y, -x)",)
    result = try_mutants(Part(check, explained))
    assert (result.survivors, result.equivalent) == ((), (("Eq(y, -x)", "the magnitude is the same"),))


@pytest.mark.parametrize(
    ("evidence", "problem"),
    [
        ({"counterexample": lambda: Counterexample((), "2", "3")}, "expected one with its values"),
        ({"consequence": lambda: Consequence("a blend", {})}, "finite numbers"),
        ({"consequence": lambda: Consequence("a blend", {"gap": float("nan")})}, "finite numbers"),
        ({"consequence": lambda: Consequence(" ", {"gap": 1.0})}, "expected a text"),
        ({"correction": Correction("Nothing.", (Part(check_of()),))}, "no instance"),
    ],
)
def test_a_failure_without_its_evidence_is_refused(evidence, problem):
    failing = replace(claim_of(FALSE, verdict=Verdict.FAILS), **EVIDENCE)
    assert decide(failing).ok
    decision = decide(replace(failing, **evidence))
    assert decision.verdict is None
    assert problem in decision.problem


def test_a_made_up_paper_without_evidence_is_refused(made_up_paper):
    claims = made_up_paper() / "claims.py"
    text = claims.read_text()
    assert '{"gap": 0.5}' in text
    claims.write_text(text.replace('{"gap": 0.5}', "{}"))
    ledger = verify(str(claims.parent), workers=1)
    assert not ledger.ok
    assert "finite numbers" in ledger.decisions[1].problem


@pytest.mark.parametrize(
    "case",
    [Case("a", True, residual=x), Case("a", False, residual=sp.Integer(0)), Case("a", sp.Eq(x, y)), Case("a", 1)],
)
def test_an_answer_that_contradicts_itself_is_refused(case):
    decision = decide(claim_of(case))
    assert decision.verdict is None
    assert "CheckFailedError" not in decision.problem.replace("CheckFailedError: ", "", 1)
    assert case.label in decision.problem
    assert not decision.ok


def test_a_residual_that_echoes_the_formula_kills_no_mutant():
    def cases(formula):
        yield Case("all x", True, residual=formula.relation.rhs)

    part = Part(Check(cases, Strength.GENERAL, "nothing"), Formula(sp.Eq(y, 2 * x), (x, y)))
    found = try_mutants(part)
    assert found.tried > 0
    assert len(found.survivors) == found.tried


def test_a_probe_does_not_stand_for_the_check():
    """The probe tells all mutants apart, the check none."""
    check = replace(check_of(TRUE), probe=lambda formula: formula.relation.rhs)
    result = try_mutants(Part(check, Formula(sp.Eq(y, 2 * x), (x, y))))
    assert result.survivors


def test_a_mutant_that_divides_by_zero_is_noticed():
    def cases(formula):
        value = formula.relation.rhs.subs(x, 2)
        if value == -2:
            raise ZeroDivisionError
        yield Case("x = 2", bool(value == 2), residual=value - 2)

    result = try_mutants(Part(Check(cases, Strength.RATIONAL, "one value"), Formula(sp.Eq(y, x), (x, y))))
    assert (result.undefined, result.survivors) == (1, ())
