"""Two pages for a reader of the text: what is wrong in it, what is right, and what that does to a curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from semispline.papers.ledger import Claim, Consequence, Decision, Ledger, Verdict
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
    for number, (cause, decisions) in enumerate(ledger.causes(), start=1):
        yield from ("", f"**{number}. {cause.title}.** {cause.text}", "")
        yield from _failures([pairs[decision.id] for decision in decisions])
    yield from ("", "**Right only under a condition, or in one reading**", "")
    conditions: dict[str, list[str]] = {}
    for decision in ledger.decisions:
        if decision.verdict in (Verdict.HOLDS_IF, Verdict.AMBIGUOUS):
            conditions.setdefault(_condition(decision), []).append(decision.id)
    for condition, identifiers in conditions.items():
        yield f"- **{', '.join(identifiers)}** {condition}"


def _failures(pairs: list[tuple[Claim, Decision]]) -> Iterator[str]:
    """Yield a line for each measured consequence, with all that is put right by it, and one for each other failure."""
    lines: dict[str, list[tuple[str, str]]] = {}
    for claim, decision in pairs:
        assert claim.correction is not None
        measured = _consequence(decision.consequence)
        lines.setdefault(measured or claim.id, []).append((claim.id, _sentence(claim.correction.statement)))
    for measured, told in lines.items():
        identifiers = ", ".join(identifier for identifier, _ in told)
        right = " ".join(dict.fromkeys(sentence for _, sentence in told))
        yield f"- **{identifiers}** {right}{measured if measured.startswith(' ') else ''}"


def _consequence(found: Consequence | None) -> str:
    """Return what was measured; empty where nothing was."""
    if found is None:
        return ""
    numbers = ", ".join(_measured(name, value, found.corrected) for name, value in found.measured.items())
    return f" *Measured* ({found.text}): {numbers}."


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
