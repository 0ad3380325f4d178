"""A decided ledger as Markdown: an erratum with each failure in five lines, then every record and what it stands on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

from sympy import Equality

from semispline.papers.ledger import Claim, Decision, Formula, Ledger, Notation, ReadingDecision, Verdict
from semispline.papers.report.formulas import latex
from semispline.papers.report.ledger_words import (
    checked_text,
    consequence_text,
    correction_text,
    counts_text,
    kind_text,
    mutants_text,
    print_lines,
    words,
)

# Heads what a study adds after the ledger in the same file.
STUDY_HEADING = "# What the study finds"


def with_study_kept(ledger: str, before: str) -> str:
    r"""Return the Markdown of a ledger with what a study has found, as it stands at the end of an earlier version.

    Examples
    --------
    >>> with_study_kept("new ledger\n", "old ledger\n\n# What the study finds: x\nmuch\n")
    'new ledger\n\n# What the study finds: x\nmuch\n'
    """
    _, heading, found = before.partition(f"\n{STUDY_HEADING}")
    return f"{ledger}\n{heading.lstrip()}{found}" if heading else ledger


def ledger_markdown(ledger: Ledger) -> str:
    """Return the report: counts, each failure in five lines, conditions, readings, remarks, all records; no timings."""
    lines = [
        f"# {ledger.paper.title}: every printed claim decided",
        "",
        f"Written by `semispline verify {ledger.paper.name} --markdown`; every verdict is computed anew at each run.",
        "",
        *counts_text(ledger).splitlines(),
        "",
        *(f"- {line}" for line in words()),
        "",
        *([ledger.paper.legend, ""] if ledger.paper.legend else []),
        *_changed(ledger),
        *_causes(ledger),
        *_erratum(ledger),
        *_section(ledger, Verdict.HOLDS_IF, "True only under an unstated condition", _conditional_lines),
        *_section(ledger, Verdict.AMBIGUOUS, "Can be read in more than one way", _ambiguous_lines),
        *_section(ledger, Verdict.HOLDS, "True as printed, with a remark", _proof_lines, remarked=True),
        *_section(ledger, Verdict.DEFINITION, "Definitions, which cannot fail", _reason_lines),
        *_section(ledger, Verdict.NOT_CHECKABLE, "Not checkable", _reason_lines),
        *_survivors(ledger),
        *_records(ledger),
    ]
    return "\n".join(lines) + "\n"


def _records(ledger: Ledger) -> Iterator[str]:
    """Yield a table with one row a reading: what the verdict stands on, and how it was found."""
    yield from ("## All records", "")
    yield (
        "Noticed: changes of the record's formulas that were told apart, of those that were tried: by the check "
        "itself, or, after two of each kind, by exact residuals at rational numbers where the check has such a probe."
    )
    known = _repeated_methods(ledger)
    yield from ("", *(f"- {name}: {method}" for method, name in known.items()))
    yield from ("", "| id | claim | verdict | evidence | checked | method | noticed |", "|---|---|---|---|---|---|---|")
    for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True):
        verdict = str(decision.verdict) if decision.verdict else f"no answer: {decision.problem}"
        if decision.verdict is not decision.recorded:
            verdict = f"**CHANGED** {verdict} (recorded: {decision.recorded})"
        head, mutants = (claim.id, claim.statement, verdict), mutants_text(decision)
        if not decision.readings:
            yield _row(*head, "", "", claim.reason, mutants)
        for reading in decision.readings:
            label = f"as {reading.label} ({reading.verdict}): " if reading.label else ""
            method = "; ".join(known.get(part, part) for part in reading.method.split("; "))
            yield _row(*head, kind_text(reading), checked_text(reading), label + method, mutants)
            head, mutants = ("", "", ""), ""
    yield ""


# A method that stands in more rows of the table than this is told once, in front.
_FEW = 2


def _repeated_methods(ledger: Ledger) -> dict[str, str]:
    """Return a name for each method that many readings share."""
    readings = (reading for decision in ledger.decisions for reading in decision.readings)
    found = Counter(part for reading in readings for part in reading.method.split("; "))
    repeated = [method for method, count in found.items() if count > _FEW]
    return {method: f"M{number}" for number, method in enumerate(repeated, start=1)}


def _row(*cells: str) -> str:
    return f"| {' | '.join(map(_cell, cells))} |"


def _survivors(ledger: Ledger) -> Iterator[str]:
    """Yield the mutants that no check tells from their formula, counted by reason."""
    yield from ("## Changes that no check can see, and why", "")
    for decision in ledger.decisions:
        for survivors, what in (
            (decision.mutation.equivalent, "say the same"),
            (decision.mutation.undecidable, "cannot be told from what is printed"),
        ):
            for reason, count in Counter(reason for _, reason in survivors).items():
                yield f"- **{decision.id}**: {count} {what}: {reason}."
    yield ""


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def _pairs(ledger: Ledger, verdict: Verdict) -> list[tuple[Claim, Decision]]:
    pairs = zip(ledger.paper.claims, ledger.decisions, strict=True)
    return [(claim, decision) for claim, decision in pairs if decision.verdict is verdict]


def _changed(ledger: Ledger) -> Iterator[str]:
    changed = [decision for decision in ledger.decisions if decision.verdict is not decision.recorded]
    if changed:
        yield from ("## Changed: found now is not what is recorded", "")
        for decision in changed:
            found = decision.verdict or f"no answer ({decision.problem})"
            yield f"- **{decision.id}**: found {found}, recorded {decision.recorded}."
        yield ""


def _causes(ledger: Ledger) -> Iterator[str]:
    """Yield each cause once, with the records under it."""
    if not ledger.causes():
        return
    yield from ("## Causes", "")
    for cause, decisions in ledger.causes():
        kind = "a misprint, or lost by the scan" if cause.misprint else "mathematics"
        named = ", ".join(f"{decision.id} ({decision.verdict})" for decision in decisions)
        yield f"- **{cause.title}** ({kind}). {cause.text} Records: {named}."
    named_above = {decision.id for _, decisions in ledger.causes() for decision in decisions}
    alone = [d.id for d in ledger.decisions if d.verdict in _OTHERS and d.id not in named_above]
    if alone:
        yield f"- **None of these**: true in one way to read it, or under a condition. Records: {', '.join(alone)}."
    yield ""


# Verdicts on what does not hold as it stands.
_OTHERS = (Verdict.HOLDS_IF, Verdict.FAILS, Verdict.AMBIGUOUS)


def _erratum(ledger: Ledger) -> Iterator[str]:
    """Yield what fails, in the order of its causes: what weighs most comes first."""
    yield from ("## Erratum", "")
    order = [cause.key for cause in ledger.paper.causes]

    def weight(pair: tuple[Claim, Decision]) -> int:
        return order.index(pair[0].cause) if pair[0].cause in order else len(order)

    for claim, decision in sorted(_pairs(ledger, Verdict.FAILS), key=weight):
        yield from (f"### {claim.id} ({claim.where})", "")
        for heading, text in _failure_lines(claim, decision, ledger.paper.notation):
            yield from (line.rstrip() for line in f"- **{heading}** {text}".split("\n"))
        yield ""


def _failure_lines(claim: Claim, decision: Decision, notation: Notation) -> Iterator[tuple[str, str]]:
    """Yield what is printed, what is wrong, where it shows first, what is true, and what it does if measured."""
    yield "Printed:", f"{claim.statement} {_formulas(claim.formulas, notation)}".rstrip()
    for heading, text in print_lines(claim):
        yield f"{heading.capitalize()}:", _verbatim(text)
    minus = (
        "printed minus true" if all(isinstance(f.relation, Equality) for f in claim.formulas) else "left minus right"
    )
    several = len(decision.readings) > 1
    wrong = "; ".join(_residual_text(reading, minus, several, notation) for reading in decision.readings)
    yield "Wrong:", f"{wrong}. {claim.remark}".rstrip()
    yield "Smallest counterexample:", decision.counterexample + "."
    yield "Correct:", _correction(claim, decision, notation)
    if decision.consequence:
        yield "What it does:", consequence_text(decision.consequence)


def _correction(claim: Claim, decision: Decision, notation: Notation) -> str:
    """Return what is true instead, without the formulas that stay as they are printed, and how it was shown."""
    printed = {formula.relation for formula in claim.formulas}
    changed = tuple(formula for formula in claim.corrected_formulas if formula.relation not in printed)
    shown = decision.correction
    proof = f" ({kind_text(shown)}, {checked_text(shown)}.)" if shown else ""
    return f"{correction_text(claim)} {_formulas(changed or claim.corrected_formulas, notation)}{proof}"


def _formulas(formulas: tuple[Formula, ...], notation: Notation) -> str:
    return "; ".join(dict.fromkeys(_code(formula.relation, notation) for formula in formulas))


def _residual_text(reading: ReadingDecision, minus: str, labelled: bool, notation: Notation) -> str:
    label = f"read with {reading.label}: " if labelled else ""
    if reading.residual is None:
        return f"{label}violated by {reading.false_case} (compared: {reading.method})"
    return f"{label}{minus} leaves {_code(reading.residual, notation)} ({reading.false_case})"


def _verbatim(text: str) -> str:
    """Return a text as it stands; one of several lines as a block of its own within an item of a list."""
    if "\n" not in text:
        return f"`{text}`"
    return "\n".join(["", "", "  ```text", *(f"  {line}".rstrip() for line in text.split("\n")), "  ```"])


def _code(relation: Any, notation: Notation) -> str:
    return f"$`{latex(relation, notation)}`$"


def _section(ledger: Ledger, verdict: Verdict, heading: str, lines: Any, *, remarked: bool = False) -> Iterator[str]:
    """Yield the records of one verdict; with `remarked` only those that have a remark."""
    pairs = [pair for pair in _pairs(ledger, verdict) if pair[0].remark or not remarked]
    if not pairs:
        return
    yield from (f"## {heading}", "")
    for claim, decision in pairs:
        yield f"- **{claim.id}** ({claim.where}): {claim.statement}"
        yield from (f"  - {line}" for line in lines(claim, decision, ledger.paper.notation))
        if claim.remark:
            yield f"  - {claim.remark}"
    yield ""


def _conditional_lines(claim: Claim, decision: Decision, notation: Notation) -> Iterable[str]:
    for reading in decision.readings:
        yield f"Holds if {reading.condition}: true for {reading.true_case}, false for {reading.false_case}."
    if decision.counterexample:
        yield f"Smallest counterexample otherwise: {decision.counterexample}."
    if decision.consequence:
        yield f"What it does: {consequence_text(decision.consequence)}"
    if claim.correction:
        yield f"In general: {claim.correction.statement} {_formulas(claim.corrected_formulas, notation)}".rstrip()


def _ambiguous_lines(claim: Claim, decision: Decision, notation: Notation) -> Iterable[str]:
    for reading in decision.readings:
        verdict = f"holds if {reading.condition}" if reading.verdict is Verdict.HOLDS_IF else str(reading.verdict)
        extra = f"; leaves {_code(reading.residual, notation)}" if reading.residual not in (None, 0) else ""
        wrong = f" false: {reading.false_case}{extra}" if reading.false_case else ""
        yield f"Read as {reading.label}: **{verdict}**.{wrong} ({kind_text(reading)}, {checked_text(reading)})"
    if decision.counterexample:
        yield f"Smallest counterexample: {decision.counterexample}."
    if claim.correction:
        yield f"Correct: {_correction(claim, decision, notation)}"
    if decision.consequence:
        yield f"What it does: {consequence_text(decision.consequence)}"


def _proof_lines(_claim: Claim, decision: Decision, _notation: Notation) -> Iterable[str]:
    for reading in decision.readings:
        label = f"Read as {reading.label}: " if reading.label else ""
        yield f"{label}{kind_text(reading)}, {checked_text(reading)}."


def _reason_lines(claim: Claim, _decision: Decision, _notation: Notation) -> Iterable[str]:
    return (claim.reason,)
