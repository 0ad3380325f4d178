"""Two pages for a reader of the text: what is wrong in it, what is right, and what that does to a curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from semispline.papers.ledger import Claim, Decision, Ledger, Verdict
from semispline.papers.report import Erratum


def erratum(ledger: Ledger, version: str) -> Erratum:
    """Return the text; each failure with its correction comes from the decided ledger."""
    return Erratum("\n".join(_lines(ledger, version)) + "\n")


def _lines(ledger: Ledger, version: str) -> Iterator[str]:
    counts = ledger.counts()
    pairs = {decision.id: (c, decision) for c, decision in zip(ledger.paper.claims, ledger.decisions, strict=True)}
    yield from (f"# Errata of: {ledger.paper.title}", "")
    yield (
        f"semispline {version}. Displays are numbered by chapter, in the order of printing. Of {counts['printed']} "
        f"formulas and pieces of code {counts['decided']} claim something: {counts[Verdict.HOLDS]} hold, "
        f"{counts[Verdict.HOLDS_IF]} hold under a condition that is not stated, {counts[Verdict.FAILS]} fail and "
        f"{counts[Verdict.AMBIGUOUS]} can be read in two ways; {counts[Verdict.DEFINITION]} define, "
        f"{counts[Verdict.NOT_CHECKABLE]} cannot be checked. All were decided from first principles, without a look at "
        "other versions of the text or at what readers reported; each correction is decided true by the same checks."
    )
    changed = [d.id for d in ledger.decisions if d.verdict is not d.recorded]
    if changed:
        yield from ("", f"**Not as recorded in this run: {', '.join(changed)}.**")
    told: dict[str, str] = {}
    for number, (cause, decisions) in enumerate(ledger.causes(), start=1):
        yield from ("", f"**{number}. {cause.title}.** {cause.text}", "")
        for decision in decisions:
            yield f"- **{decision.id}** {_failure(*pairs[decision.id], told)}"
    yield from ("", "**Right only under a condition, or in one reading**", "")
    conditions: dict[str, list[str]] = {}
    for decision in ledger.decisions:
        if decision.verdict in (Verdict.HOLDS_IF, Verdict.AMBIGUOUS):
            conditions.setdefault(_condition(decision), []).append(decision.id)
    for condition, identifiers in conditions.items():
        yield f"- **{', '.join(identifiers)}** {condition}"


def _failure(claim: Claim, decision: Decision, told: dict[str, str]) -> str:
    """Return what is right, and what was measured unless it was told of another record: text -> its id."""
    assert claim.correction is not None
    right = _sentence(claim.correction.statement)
    found = decision.consequence
    if found is None:
        return right
    numbers = ", ".join(_measured(name, value, found.corrected) for name, value in found.measured.items())
    measured = f"({found.text}): {numbers}."
    if measured in told:
        return f"{right} *Measured* as for {told[measured]}."
    told[measured] = claim.id
    return f"{right} *Measured* {measured}"


def _measured(name: str, value: float, corrected: Mapping[str, float]) -> str:
    right = f", right {_short(corrected[name])}" if name in corrected else ""
    return f"{name} {_short(value)}{right}"


def _short(value: Any) -> str:
    return f"{0 if abs(value) < _ROUNDING else value:.3g}"


_ROUNDING = 1e-9


def _condition(decision: Decision) -> str:
    return "; ".join(_sentence(r.condition or f"{r.label}: {r.verdict}").rstrip(".") for r in decision.readings) + "."


def _sentence(text: str) -> str:
    """Return a text as a sentence; a letter of a formula at its start stays as it is."""
    text = text.strip()
    first = text.split()[0]
    start = text[:1].upper() if len(first) > 1 and first.isalpha() else text[:1]
    return start + text[1:] + ("" if text.endswith(".") else ".")
