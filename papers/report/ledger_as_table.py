"""A decided ledger as a table on the terminal."""

from __future__ import annotations

from rich.table import Table
from rich.text import Text

from semispline.papers.ledger import Claim, Decision, Ledger, Verdict
from semispline.papers.report.ledger_words import checked_text, kind_text, mutants_text

_COLORS = {
    Verdict.HOLDS: "green",
    Verdict.HOLDS_IF: "yellow",
    Verdict.FAILS: "red",
    Verdict.AMBIGUOUS: "magenta",
    Verdict.DEFINITION: "dim",
    Verdict.NOT_CHECKABLE: "dim",
}


def ledger_table(ledger: Ledger) -> Table:
    """Return a rich table with one line a record."""
    table = Table(title=ledger.paper.title, title_justify="left")
    for heading in ("id", "claim", "verdict", "evidence", "mutants"):
        table.add_column(heading, overflow="fold")
    for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True):
        verdict = Text("no answer", style="bold red")
        if decision.verdict:
            verdict = Text(str(decision.verdict), style=_COLORS[decision.verdict])
            if decision.verdict is not decision.recorded:
                verdict.append(f" (recorded: {decision.recorded})", style="bold red")
        table.add_row(claim.id, claim.statement, verdict, _short_evidence(claim, decision), mutants_text(decision))
    return table


def _short_evidence(claim: Claim, decision: Decision) -> str:
    if decision.problem:
        return decision.problem
    if not decision.readings:
        return claim.reason
    return "; ".join(dict.fromkeys(f"{kind_text(r)}, {checked_text(r)}" for r in decision.readings))
