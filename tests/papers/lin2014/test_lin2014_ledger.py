"""The paper decided anew, once, as a whole: every verdict, every piece of evidence, the report."""

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from semispline.papers.ledger import mutation
from semispline.papers.ledger.records import Strength, Verdict
from semispline.papers.ledger.verification import verify
from semispline.papers.report.erratum import erratum_of
from semispline.papers.report.ledger_as_html import ledger_html
from semispline.papers.report.ledger_as_json import ledger_record
from semispline.papers.report.ledger_as_markdown import STUDY_HEADING, ledger_markdown
from semispline.solver.io.json_text import to_text

PAPER = Path(__file__).parents[3] / "papers" / "lin2014"
RECORDS, REPORT = PAPER / "RECORDS.md", PAPER / "REPORT.md"

# Decided by hand as well, by reading the derivation.
KNOWN = {
    "def-1": "holds-if",
    "eq-1": "holds",
    "eq-6": "holds",
    "eq-11": "holds-if",
    "eq-12": "ambiguous",
    "eq-14": "fails",
    "eq-15": "holds-if",
    "eq-16": "holds-if",
    "eq-17": "ambiguous",
    "eq-18": "holds",
    "cond-1.1": "holds",
    "cond-1.2": "holds",
    "cond-2.1": "holds",
    "cond-2.2": "holds-if",
    "cond-3.1": "fails",
    "cond-3.2": "fails",
    "app-d1": "holds",
    "app-d2": "fails",
    "sec-2.top-last-row": "fails",
    "sec-3.m-bound": "holds-if",
    "sec-3.averaging": "ambiguous",
    "sec-3.sufficient-g1": "holds-if",
    "sec-1.quintic": "ambiguous",
    "sec-1.fairness": "ambiguous",
    "sec-4.no-middle-curve": "holds",
    "sec-4.g1-degree": "holds",
    "sec-4.g2-degree": "holds-if",
    "sec-2.subpatch-kind": "ambiguous",
    "sec-5.cylinders": "ambiguous",
    "sec-5.validation": "ambiguous",
    **dict.fromkeys(("fig-5.c2", "fig-6.g2", "fig-8.c2", "fig-9.c2", "fig-11.g2"), "ambiguous"),
    "fig-5.revealed": "not-checkable",
    "fig-7.reverse": "holds",
    "fig-7.inference": "ambiguous",
    "fig-10.g2": "ambiguous",
    "fig-10.first-knots": "fails",
    "fig-11.counts": "holds",
    "fig-10.seam": "ambiguous",
    "sec-1.after-conversion": "ambiguous",
    "sec-2.evaluation-order": "ambiguous",
    "sec-3.averaging-direction": "ambiguous",
    "sec-3.fewer-better": "ambiguous",
    "sec-3.minimum-over-rows": "ambiguous",
    "sec-3.one-surface": "fails",
    "sec-3.sides": "definition",
    "sec-4.facing": "holds-if",
    "sec-4.initial-value": "ambiguous",
    "sec-A.special-choice": "ambiguous",
}


def erratum(text):
    return text[text.index("## Erratum") : text.index("## True only")]


def rows(text):
    """Cells of the table of all records, by id."""
    lines = text[text.index("## All records") :].splitlines()
    return {row.split(" | ")[0].strip("| "): row.split(" | ") for row in lines if row.startswith("| ")}


@pytest.fixture
def few_mutants(monkeypatch):
    """One mutant of each kind of each formula; all of them are tried by .ci/run."""
    every = mutation.mutants
    monkeypatch.setattr(mutation, "mutants", lambda formula: list({m.kind: m for m in every(formula)}.values()))
    mutation._RESULTS.clear()
    yield
    mutation._RESULTS.clear()


@pytest.mark.long
@pytest.mark.usefixtures("few_mutants")
def test_every_claim_is_decided_as_recorded():
    ledger = verify("lin2014", workers=1)
    _verdicts_are_known(ledger)
    _evidence_is_complete(ledger)
    _outputs_are_complete(ledger)
    _report_reads_as_an_erratum(ledger)
    # The stored report says so too; how many mutants were tried is for the test below.
    stored, text = RECORDS.read_text(encoding="utf-8"), ledger_markdown(ledger)
    assert erratum(stored) == erratum(text)
    before, now = ({name: cells[:-1] for name, cells in rows(one).items()} for one in (stored, text))
    assert {name: before[name] for name in now} == now
    fresh = erratum_of(ledger).text
    assert REPORT.read_text(encoding="utf-8") == fresh, (
        "run `semispline verify lin2014 --erratum papers/lin2014/REPORT.md`"
    )


@pytest.mark.slow
def test_every_mutant_is_noticed_and_the_report_is_fresh():
    ledger = verify("lin2014", workers=2)
    _verdicts_are_known(ledger)
    assert ledger.counts()["mutants"] > 3000
    _evidence_is_complete(ledger)
    _outputs_are_complete(ledger)
    _report_reads_as_an_erratum(ledger)
    stored = RECORDS.read_text(encoding="utf-8")
    text = ledger_markdown(ledger)
    # What the study found stands after it.
    part = stored[: stored.index(STUDY_HEADING)]
    assert part.strip() == text.strip(), "run `semispline verify lin2014 --markdown papers/lin2014/RECORDS.md`"


def _verdicts_are_known(ledger):
    wrong = {d.id: (str(d.verdict), d.problem, d.vacuous, d.mutation.survivors) for d in ledger.decisions if not d.ok}
    assert wrong == {}
    verdicts = {d.id: str(d.verdict) for d in ledger.decisions}
    assert {f"eq-{n}" for n in range(1, 19)} <= set(verdicts)
    assert {name: verdicts[name] for name in KNOWN} == KNOWN
    counts = ledger.counts()
    assert counts["printed"] >= 100
    assert counts["decided"] == counts["printed"] - counts["not-checkable"] - counts["definition"]
    # Proved, or told to be less: sampled, or consistent with what is printed and no more.
    assert counts["proved"] + counts["consistent"] <= counts["decided"]
    assert counts["causes"] == len(ledger.paper.causes) == 7
    assert (counts["vacuous"], counts["changed"], counts["mutants_survived"]) == (0, 0, 0)
    text = ledger_markdown(ledger)
    changed = replace(ledger, decisions=(replace(ledger.decisions[0], verdict=Verdict.FAILS), *ledger.decisions[1:]))
    assert "## Changed" not in text
    assert "**CHANGED**" not in text
    assert f"found fails, recorded {ledger.decisions[0].recorded}" in ledger_markdown(changed)


def _evidence_is_complete(ledger):
    for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True):
        if decision.verdict is Verdict.FAILS:
            assert decision.counterexample, claim.id
            assert decision.correction.verdict is Verdict.HOLDS, claim.id
            assert decision.consequence.measured, claim.id
            assert decision.readings[0].false_case, claim.id
            assert claim.corrected_formulas, claim.id
        if decision.verdict is Verdict.HOLDS_IF:
            reading = decision.readings[0]
            assert reading.true_case, claim.id
            assert reading.false_case, claim.id
        # Every formula claim was perturbed.
        assert bool(claim.formulas) <= (decision.mutation.tried > 0), claim.id


def _report_reads_as_an_erratum(ledger):
    text = ledger_markdown(ledger)
    causes = text[text.index("## Causes") : text.index("## Erratum")]
    for cause in ledger.paper.causes:
        assert cause.title in causes
        assert cause.text in causes
    assert all(f"{d.id} (fails)" in causes for d in ledger.decisions if d.verdict is Verdict.FAILS)
    failures = erratum(text).split("\n### ")[1:]
    assert len(failures) == ledger.counts()["fails"]
    for failure in failures:
        lines = [line for line in failure.splitlines()[1:] if line]
        heads = [line.split("**")[1] for line in lines]
        assert heads == ["Printed:", "Wrong:", "Smallest counterexample:", "Correct:", "What it does:"], failure
        assert "$`" in lines[3], failure
    cells = rows(text)
    for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True):
        _, _, verdict, evidence, checked, method, noticed = cells[claim.id]
        assert verdict == str(decision.verdict)
        if decision.verdict not in (Verdict.NOT_CHECKABLE, Verdict.DEFINITION):
            assert any(word in evidence for word in ("exact", "floating", "consistent with what is printed")), claim.id
            assert "case" in checked, claim.id
        assert method.strip(), claim.id
        assert bool(decision.mutation.tried) == any(c.isdigit() for c in noticed), claim.id
    # Remarks are read, whatever the verdict.
    assert all(claim.remark in text for claim in ledger.paper.claims)
    survivors = [*(s for d in ledger.decisions for s in d.mutation.equivalent + d.mutation.undecidable)]
    assert all(reason in text for _, reason in survivors)


def _outputs_are_complete(ledger):
    record = ledger_record(ledger)
    assert len(record["claims"]) == len(ledger.paper.claims)
    assert '"kind": "ledger"' in to_text(record)
    strengths = {claim["strength"] for claim in record["claims"] if claim["strength"]}
    assert strengths <= {strength.text for strength in Strength}
    for claim in record["claims"]:
        assert bool(claim["corrected_formulas"]) or claim["verdict"] != "fails", claim["id"]
        tried = claim["mutants"]["tried"]
        assert sum(claim["mutants"]["kinds"].values()) == tried
    assert set(ledger.mutants_by_kind()) == {"sign", "factor", "exponent", "index", "limit", "number", "knot"}
    html = ledger_html(ledger)
    assert html.count("<details class='claim") == len(ledger.paper.claims)
    formulas = re.findall("<math>.*?</math>", html)
    assert len(formulas) > 60
    for formula in formulas:
        ElementTree.fromstring(formula)
    # Nothing is fetched from a network.
    assert "http" not in html
    # No timings in what is kept under version control.
    assert "seconds" not in ledger_markdown(ledger).replace("5.54 seconds", "")
