"""RECORDS.md says what the study finds, and the study still finds it."""

from pathlib import Path

import pytest

from semispline.papers.baselines.registry import methods
from semispline.papers.lin2014.study import study
from semispline.papers.reproduction.comparison import run

STORED = (Path(__file__).parents[3] / "papers" / "lin2014" / "RECORDS.md").read_text(encoding="utf-8")


def test_the_document_has_the_erratum_first_then_findings_and_prior_art():
    assert STORED.index("## Erratum") < STORED.index("What the study finds") < STORED.index("Prior art:")
    for work in study().prior_art:
        assert f"- {work}" in STORED


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
