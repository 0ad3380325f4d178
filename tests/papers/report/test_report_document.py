"""RECORDS.md says what the study finds, and the study still finds it."""

import re
from pathlib import Path

import pytest

from semispline.papers.baselines.registry import methods
from semispline.papers.ledger import Verdict
from semispline.papers.ledger.loading import load_paper
from semispline.papers.lin2014.study import study
from semispline.papers.reproduction.comparison import run

STORED = (Path(__file__).parents[3] / "papers" / "lin2014" / "RECORDS.md").read_text(encoding="utf-8")


@pytest.mark.long
def test_the_document_has_the_erratum_first_then_findings_and_prior_art():
    assert STORED.index("## Erratum") < STORED.index("What the study finds") < STORED.index("Prior art:")
    for work in study().prior_art:
        assert f"- {work}" in STORED


@pytest.mark.long
def test_what_weighs_most_comes_first_and_words_are_explained():
    causes = [cause.key for cause in load_paper("lin2014").causes]
    claims = {claim.id: claim for claim in load_paper("lin2014").claims}
    erratum = STORED.partition("## Erratum")[2].partition("\n## ")[0]
    order = [causes.index(claims[name].cause) for name in re.findall(r"^### (\S+)", erratum, re.MULTILINE)]
    assert order == sorted(order)
    assert len(order) > 10
    for verdict in Verdict:
        assert f"- {verdict}: {verdict.text}." in STORED
    # Each record that does not hold as it stands is under a cause, or named as having none of them.
    told = STORED.partition("## Causes")[2].partition("\n## ")[0]
    for claim in claims.values():
        wanted = claim.verdict in (Verdict.FAILS, Verdict.AMBIGUOUS, Verdict.HOLDS_IF)
        assert (re.search(rf"(?<![\w.-]){re.escape(claim.id)}(?![\w-]|\.\w)", told) is not None) == wanted, claim.id


def test_a_method_of_many_records_is_told_once():
    methods_told = dict(re.findall(r"^- (M\d+): (.+)$", STORED, re.MULTILINE))
    assert methods_told
    table = STORED.partition("| id | claim | verdict |")[2]
    for name, method in methods_told.items():
        assert not re.search(r"[;|] *" + re.escape(method) + r" *[;|]", table)
        assert len(re.findall(rf"\b{name}\b", table)) > 2


@pytest.mark.slow
def test_every_finding_is_found_again():
    everything = study()
    comparisons = {
        e.task.name: [run(e.task, method) for method in methods(everything.methods)] for e in everything.examples
    }
    found = everything.findings(comparisons)
    assert len(found) >= 10
    # The short sentences, with their counts; what is behind them has iteration counts, which differ between machines.
    for finding in found:
        assert f"**{finding.short}.**" in STORED
