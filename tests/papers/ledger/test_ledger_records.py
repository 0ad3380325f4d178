"""A record is refused when it is loaded unless it is well formed, and every kind of fault is named."""

from dataclasses import replace

import pytest
import sympy as sp

from semispline.papers.ledger.loading import load_paper, paper_names
from semispline.papers.ledger.record_checks import check_causes, check_complete, check_record, same_ids
from semispline.papers.ledger.records import (
    Case,
    Cause,
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
    natural_key,
)

x, y = sp.symbols("x y", real=True)
CHECK = Check(lambda formula: [Case("one", True)], Strength.RATIONAL, "one instance")
FORMULA = Formula(sp.Eq(y, 2 * x), (x, y))
GOOD = Claim("eq-1", "Section 1", "y is twice x.", Verdict.HOLDS, (Reading((Part(CHECK, FORMULA),)),))


def test_a_good_record_passes():
    check_record(GOOD)


def with_formula(formula):
    return replace(GOOD, readings=(Reading((Part(CHECK, formula),)),))


def with_check(**changes):
    return replace(GOOD, readings=(Reading((Part(replace(CHECK, **changes), FORMULA),)),))


def labelled(*labels):
    return tuple(replace(GOOD.readings[0], label=label) for label in labels)


@pytest.mark.parametrize(
    ("claim", "message"),
    [
        (replace(GOOD, verdict="true"), "verdict 'true'"),
        *(
            (replace(GOOD, id=name), "id .*expected letters, digits and")
            for name in ("", " ", "eq 1", "-1", "eq/1", "../eq", "eq-1.", "Satz\u00e4", "a" * 81)
        ),
        (with_check(strength=9), "strength 9, expected one of GENERAL"),
        (with_check(strength=Strength.FLOAT, proof=True), "a proof in floating point"),
        (with_check(strength=Strength.CONSISTENT, proof=True), "a proof by what is printed agreeing"),
        (replace(GOOD, readings=labelled("one", "one"), verdict=Verdict.AMBIGUOUS), "with one label"),
        (replace(GOOD, readings=GOOD.readings * 2), "without a label"),
        (with_formula(replace(FORMULA, equivalent={"Eq(y, 3*x)": "why"})), "which is not made"),
        (with_formula(replace(FORMULA, undecidable={"Eq(y, 3*x)": "why"})), "which is not made"),
        (with_formula(replace(FORMULA, equivalent={"Eq(y, -2*x)": " "})), "without a reason"),
        (
            with_formula(replace(FORMULA, equivalent={"Eq(y, -2*x)": "a"}, undecidable={"Eq(y, -2*x)": "b"})),
            "both equivalent and undecidable",
        ),
        (with_formula(Formula(y - 2 * x, (x, y))), "expected a relation"),
        (with_formula(Formula(sp.Eq(y, 2 * x), (x,))), r"undeclared \['y'\]"),
        (with_formula(Formula(sp.Eq(y, 2), (x, y))), r"unused \['x'\]"),
        (with_formula(Formula(sp.Eq(y, 2 * x), (x, y), (x > 1, x < 0))), "no instance"),
        (replace(GOOD, readings=(Reading((Part(replace(CHECK, method="")),)),)), "without a method"),
    ],
)
def test_a_bad_record_is_refused(claim, message):
    with pytest.raises(LedgerError, match=message):
        check_record(claim)


@pytest.mark.parametrize(
    ("claim", "message"),
    [
        (replace(GOOD, verdict=None), "no verdict, expected one of holds, .*--draft"),
        (replace(GOOD, statement=" "), "empty"),
        (replace(GOOD, readings=(replace(GOOD.readings[0], condition="x > 0"),)), "holds with a condition"),
        (replace(GOOD, readings=()), "without a check"),
        (replace(GOOD, readings=(Reading(()),)), "without a check"),
        (replace(GOOD, verdict=Verdict.HOLDS_IF), "without its condition"),
        (replace(GOOD, verdict=Verdict.FAILS), "fails without a counterexample"),
        (replace(with_check(search=lambda formula: None), verdict=Verdict.FAILS), "fails without a correction"),
        (replace(GOOD, verdict=Verdict.AMBIGUOUS), "at least 2"),
        (replace(GOOD, readings=(), verdict=Verdict.NOT_CHECKABLE), "without a reason"),
        (replace(GOOD, readings=(), verdict=Verdict.DEFINITION), "definition without what it names"),
        (replace(GOOD, reason="the rows", verdict=Verdict.DEFINITION), "definition with readings"),
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
def test_what_is_missing_is_told_before_it_is_decided(claim, message):
    check_record(claim)
    with pytest.raises(LedgerError, match=message):
        check_complete(claim)


def test_what_an_error_does_need_not_be_measured():
    correction = Correction("y is 2x", (Part(CHECK, FORMULA),))
    failing = replace(with_check(search=lambda formula: None), verdict=Verdict.FAILS, correction=correction)
    check_complete(failing)


@pytest.mark.parametrize("names", [("eq-1", "eq-1"), ("eq-1", "Eq-1"), ("eq-2", "lemma-1", "eq-02")])
def test_ids_that_sort_as_one_are_seen(names):
    assert same_ids([replace(GOOD, id=name) for name in names])
    assert same_ids([replace(GOOD, id=name) for name in ("eq-2.3", "eq-2.30", "eq-23", "eq-A.1", "table-2")]) is None


def test_ids_sort_as_papers_number_things():
    names = ["app-A.1", "eq-1", "eq-2", "eq-2.3", "eq-2.10", "eq-2.10b", "eq-10", "thm-1"]
    assert sorted(set(names), key=natural_key) == names


@pytest.mark.parametrize(
    "claim",
    [
        *(
            replace(GOOD, id=name)
            for name in ("eq-2.3", "thm-1", "lemma-2", "alg-1", "eq-A.1", "table-2", "17", "sec-A.17-gives-2.1", "2a")
        ),
        with_formula(replace(FORMULA, equivalent={"Eq(y, -2*x)": "why"})),
        with_check(strength=Strength.FLOAT),
        with_check(strength=Strength.CONSISTENT),
        replace(GOOD, readings=(), reason="the rows", verdict=Verdict.DEFINITION),
        replace(GOOD, readings=labelled("one", "other"), verdict=Verdict.AMBIGUOUS),
    ],
)
def test_what_is_well_formed_passes(claim):
    check_record(claim)
    check_complete(claim)


SIGN = Cause("sign", "A sign", "It is plus.")


def test_causes_belong_to_records_and_records_that_fail_have_one():
    failing = replace(GOOD, verdict=Verdict.FAILS)
    check_causes((GOOD,), ())
    check_causes((failing,), ())
    check_causes((replace(failing, cause="sign"), GOOD), (SIGN,))
    for claims, causes, message in (
        ((replace(GOOD, cause="sign"),), (), "cause 'sign', expected one of none"),
        ((GOOD,), (SIGN,), "no record has it"),
        ((failing, replace(GOOD, cause="sign")), (SIGN,), "fails without a cause, expected one of sign"),
        ((replace(GOOD, cause="sign"),), (SIGN, SIGN), "found twice"),
        ((replace(GOOD, cause="sign"),), (replace(SIGN, text=" "),), "without title or text"),
    ):
        with pytest.raises(LedgerError, match=message):
            check_causes(claims, causes)


def test_the_corrected_formula_is_checked_too():
    claim = replace(GOOD, correction=Correction("", (Part(CHECK, Formula(sp.Eq(y, 2), (x,))),)))
    with pytest.raises(LedgerError, match="free symbols"):
        check_record(claim)


@pytest.mark.long
def test_lin2014_ships_and_every_record_is_well_formed():
    assert "lin2014" in paper_names()
    ids = [claim.id for claim in load_paper("lin2014").claims]
    assert len(ids) == len(set(ids))
    assert {f"cond-{i}.{k}" for i in (1, 2, 3) for k in (1, 2)} <= set(ids)
    assert {"eq-15", "eq-16", "eq-17", "eq-18", "app-d1", "app-d2"} <= set(ids)


def test_a_paper_that_is_not_there():
    with pytest.raises(LedgerError, match=r"found 'nowhere', expected one of .*lin2014"):
        load_paper("nowhere")
