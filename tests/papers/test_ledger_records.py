"""A record is refused when it is loaded unless it is well formed, and every kind of fault is named."""

from dataclasses import replace

import pytest
import sympy as sp

from papers.ledger import (
    Case,
    Check,
    Claim,
    Consequence,
    Correction,
    Counterexample,
    Formula,
    LedgerError,
    Part,
    Reading,
    Strength,
    Verdict,
)
from papers.loading import load_paper, paper_names
from papers.record_checks import check_record

x, y = sp.symbols("x y", real=True)
CHECK = Check(lambda formula: [Case("one", True)], Strength.RATIONAL, "one instance")
FORMULA = Formula(sp.Eq(y, 2 * x), (x, y))
GOOD = Claim("eq-1", "Section 1", "y is twice x.", Verdict.HOLDS, (Reading((Part(CHECK, FORMULA),)),))


def test_a_good_record_passes():
    check_record(GOOD)


def with_formula(formula):
    return replace(GOOD, readings=(Reading((Part(CHECK, formula),)),))


@pytest.mark.parametrize(
    ("claim", "message"),
    [
        (replace(GOOD, verdict="true"), "verdict 'true'"),
        (replace(GOOD, statement=" "), "empty"),
        (with_formula(Formula(y - 2 * x, (x, y))), "expected a relation"),
        (with_formula(Formula(sp.Eq(y, 2 * x), (x,))), r"undeclared \['y'\]"),
        (with_formula(Formula(sp.Eq(y, 2), (x, y))), r"unused \['x'\]"),
        (with_formula(Formula(sp.Eq(y, 2 * x), (x, y), (x > 1, x < 0))), "no instance"),
        (replace(GOOD, readings=()), "without a check"),
        (replace(GOOD, readings=(Reading(()),)), "without a check"),
        (replace(GOOD, readings=(Reading((Part(replace(CHECK, method="")),)),)), "without a method"),
        (replace(GOOD, verdict=Verdict.HOLDS_IF), "without its condition"),
        (replace(GOOD, verdict=Verdict.FAILS), "fails without correction, counterexample, consequence"),
        (replace(GOOD, verdict=Verdict.AMBIGUOUS), "at least 2"),
        (replace(GOOD, readings=GOOD.readings * 2), "without a label"),
        (replace(GOOD, readings=(), verdict=Verdict.NOT_CHECKABLE), "without a reason"),
        (replace(GOOD, reason="why"), "with a reason"),
        (
            replace(
                GOOD,
                verdict=Verdict.FAILS,
                correction=Correction("y is 2x", ()),
                counterexample=lambda: Counterexample((), "1", "2"),
                consequence=lambda: Consequence("a surface", {}),
            ),
            "no proof",
        ),
        (
            replace(
                GOOD,
                verdict=Verdict.FAILS,
                correction=Correction(" ", (Part(CHECK, FORMULA),)),
                counterexample=lambda: Counterexample((("x", "1"),), "1", "2"),
                consequence=lambda: Consequence("a surface", {"gap": 1.0}),
            ),
            "says nothing",
        ),
        (
            replace(
                GOOD,
                verdict=Verdict.FAILS,
                correction=Correction("y is 2x", (Part(CHECK),)),
                counterexample=lambda: Counterexample((("x", "1"),), "1", "2"),
                consequence=lambda: Consequence("a surface", {"gap": 1.0}),
            ),
            "no formula",
        ),
    ],
)
def test_a_bad_record_is_refused(claim, message):
    with pytest.raises(LedgerError, match=message):
        check_record(claim)


def test_the_corrected_formula_is_checked_too():
    claim = replace(GOOD, correction=Correction("", (Part(CHECK, Formula(sp.Eq(y, 2), (x,))),)))
    with pytest.raises(LedgerError, match="free symbols"):
        check_record(claim)


def test_lin2014_ships_and_every_record_is_well_formed():
    assert "lin2014" in paper_names()
    ids = [claim.id for claim in load_paper("lin2014").claims]
    assert len(ids) == len(set(ids))
    assert {f"cond-{i}.{k}" for i in (1, 2, 3) for k in (1, 2)} <= set(ids)
    assert {"eq-15", "eq-16", "eq-17", "eq-18", "app-d1", "app-d2"} <= set(ids)


def test_a_paper_that_is_not_there():
    with pytest.raises(LedgerError, match=r"found 'nowhere', expected one of .*lin2014"):
        load_paper("nowhere")
