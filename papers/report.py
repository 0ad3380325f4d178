"""A decided ledger as a table on the terminal, as JSON, as Markdown (the erratum), and as a section of HTML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import escape
from typing import TYPE_CHECKING, Any

from papers.ledger import Claim, Consequence, Strength, Verdict
from papers.mathml import latex, mathml
from papers.verification import Decision, Ledger, ReadingDecision

if TYPE_CHECKING:
    from rich.table import Table

# Below this a measured miss is rounding: the referee's own limits are 1e-9 degrees and 1e-9 of the curvature.
NOISE = 1e-9
# How a measurement is named that was repeated with the correction.
_CORRECTED = " with the corrected formula"

_COLORS = {
    Verdict.HOLDS: "green",
    Verdict.HOLDS_IF: "yellow",
    Verdict.FAILS: "red",
    Verdict.AMBIGUOUS: "magenta",
    Verdict.NOT_CHECKABLE: "dim",
}


def evidence_text(decision: Decision) -> str:
    """Return in words what the verdict stands on."""
    if not decision.readings:
        return ""
    return "; ".join(_reading_text(reading) for reading in decision.readings)


def _reading_text(reading: ReadingDecision) -> str:
    kind = "proof" if reading.proof else "instances"
    label = f"[{reading.label}: {reading.verdict}] " if reading.label else ""
    cases = f"{reading.cases} case{'s' if reading.cases > 1 else ''}"
    return f"{label}{reading.strength.text}, {kind}, {cases}: {reading.method}"


def consequence_text(consequence: Consequence | None) -> str:
    """Return a measured consequence in one sentence."""
    if consequence is None:
        return ""
    measured = {name: value for name, value in consequence.measured.items() if not name.endswith(_CORRECTED)}
    corrected = {name: value for name, value in consequence.measured.items() if name.endswith(_CORRECTED)}
    # A whole number is a count, and 0 of something is no rounding.
    zero = [name for name, value in measured.items() if abs(value) < NOISE and not isinstance(value, int)]
    seen = [f"{name} {value:.3g}" for name, value in measured.items() if name not in zero]
    left = [f"{name} {value:.3g}" for name, value in corrected.items() if abs(value) >= NOISE]
    parts = [", ".join(seen + left)] if seen or left else []
    if zero:
        parts.append(f"nothing but rounding in {_listed([name.partition(' [')[0] for name in zero])}")
    if corrected and not left:
        what = ("this is" if len(corrected) == 1 else "all of these are") if seen else "it is"
        parts.append(f"with the corrected formula {what} rounding")
    says = "; ".join(parts)
    judges = "; ".join(f"{name}: {says}" for name, says in consequence.judges.items())
    return f"{consequence.text}: {says}." + (f" {judges}." if judges else "")


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def ledger_record(ledger: Ledger) -> dict[str, Any]:
    """Return the ledger as the file format has it."""
    claims = []
    for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True):
        claims.append(
            {
                "id": claim.id,
                "where": claim.where,
                "statement": claim.statement,
                "verdict": str(decision.verdict) if decision.verdict else None,
                "recorded": str(decision.recorded),
                "problem": decision.problem,
                "evidence": evidence_text(decision) or claim.reason,
                "strength": max((r.strength.value for r in decision.readings), default=None),
                "proved": decision.proved,
                "condition": "; ".join(r.condition for r in decision.readings if r.condition),
                "readings": [
                    {"reading": r.label, "verdict": str(r.verdict), "cases": r.cases, "true": r.true_case,
                     "false": r.false_case, "residual": "" if r.residual is None else str(r.residual)}
                    for r in decision.readings
                ],
                "printed": [str(f.relation) for f in claim.formulas],
                "residual": str(residual_of(decision) or ""),
                "counterexample": decision.counterexample,
                "corrected": _correction_text(claim),
                "corrected_formulas": [str(f.relation) for f in claim.corrected_formulas],
                "consequence": consequence_text(decision.consequence),
                "measured": dict(decision.consequence.measured) if decision.consequence else {},
                "remark": claim.remark,
                "mutants": {
                    "tried": decision.mutation.tried,
                    "kinds": dict(sorted(decision.mutation.kinds.items())),
                    "equivalent": [{"mutant": m, "reason": why} for m, why in decision.mutation.equivalent],
                    "undecidable": [{"mutant": m, "reason": why} for m, why in decision.mutation.undecidable],
                    "survivors": list(decision.mutation.survivors),
                },
                "seconds": round(decision.seconds, 3),
            }
        )  # fmt: skip
    return {
        "format": "semispline/1",
        "kind": "ledger",
        "paper": ledger.paper.name,
        "claims": claims,
        "counts": ledger.counts(),
    }


def residual_of(decision: Decision) -> Any:
    """Return what the printed formula leaves, of the first reading that does not hold; None where there is nothing."""
    left = (r.residual for r in decision.readings if r.residual is not None and r.verdict is not Verdict.HOLDS)
    return next(left, None)


def _correction_text(claim: Claim) -> str:
    return claim.correction.statement if claim.correction else ""


def ledger_table(ledger: Ledger) -> Table:
    """Return a rich table with one line a record."""
    from rich.table import Table
    from rich.text import Text

    table = Table(title=ledger.paper.title, title_justify="left")
    for heading in ("id", "claim", "verdict", "evidence", "mutants"):
        table.add_column(heading, overflow="fold")
    for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True):
        verdict = Text("no answer", style="bold red")
        if decision.verdict:
            verdict = Text(str(decision.verdict), style=_COLORS[decision.verdict])
            if decision.verdict is not decision.recorded:
                verdict.append(f" (recorded: {decision.recorded})", style="bold red")
        table.add_row(claim.id, claim.statement, verdict, _short_evidence(claim, decision), _mutants(decision))
    return table


def _short_evidence(claim: Claim, decision: Decision) -> str:
    if decision.problem:
        return decision.problem
    if not decision.readings:
        return claim.reason
    strength = max(reading.strength for reading in decision.readings)
    if strength is not Strength.RATIONAL or not decision.proved:
        return f"{strength.text}{', proved' if decision.proved else ''}"
    if decision.verdict is Verdict.FAILS and not all(reading.proof for reading in decision.readings):
        return "disproved by an exact rational instance"
    return "proved by exact rational arithmetic"


def _mutants(decision: Decision) -> str:
    mutation = decision.mutation
    if not mutation.tried:
        return ""
    explained = ((mutation.equivalent, "equivalent"), (mutation.undecidable, "undecidable"))
    rest = ", ".join(f"{len(found)} {name}" for found, name in explained if found)
    return f"{mutation.noticed}/{mutation.tried}" + (f" ({rest})" if rest else "")


def counts_text(ledger: Ledger) -> str:
    """Return the counts in two lines."""
    n = ledger.counts()
    verdicts = ", ".join(f"{n[verdict]} {verdict}" for verdict in Verdict)
    return (
        f"{n['printed']} printed claims, {n['decided']} decided, {n['proved']} of them proved or disproved exactly: "
        f"{verdicts}; {n['vacuous']} vacuous, {n['changed']} changed.\n"
        f"Mutants: {n['mutants']} tried, {n['mutants_survived']} survived without a reason, "
        f"{n['mutants_equivalent']} say the same as the formula and {n['mutants_undecidable']} differ from it in "
        "printed data that nothing else printed depends on (each with its reason)."
    )


def ledger_markdown(ledger: Ledger) -> str:
    """Return the report: counts, each failure in five lines, conditions, readings, and all records. No timings."""
    lines = [
        f"# {ledger.paper.title}: every printed claim decided",
        "",
        f"Written by `semispline verify {ledger.paper.name} --markdown`; every verdict is computed anew at each run.",
        "",
        *counts_text(ledger).splitlines(),
        "",
        *([ledger.paper.legend, ""] if ledger.paper.legend else []),
        *_changed(ledger),
        *_erratum(ledger),
        *_section(ledger, Verdict.HOLDS_IF, "True only under an unstated condition", _conditional_lines),
        *_section(ledger, Verdict.AMBIGUOUS, "Can be read in more than one way", _ambiguous_lines),
        *_section(ledger, Verdict.NOT_CHECKABLE, "Not checkable", _reason_lines),
        "## All records",
        "",
        "| id | claim | verdict | evidence |",
        "|---|---|---|---|",
    ]
    for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True):
        verdict = str(decision.verdict) if decision.verdict else f"no answer: {decision.problem}"
        if decision.verdict is not decision.recorded:
            verdict = f"**CHANGED** {verdict} (recorded: {decision.recorded})"
        evidence = _short_evidence(claim, decision)
        lines.append("| " + " | ".join(map(_cell, (claim.id, claim.statement, verdict, evidence))) + " |")
    return "\n".join(lines) + "\n"


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


def _erratum(ledger: Ledger) -> Iterator[str]:
    yield from ("## Erratum", "")
    for claim, decision in _pairs(ledger, Verdict.FAILS):
        yield from (f"### {claim.id} ({claim.where})", "")
        for heading, text in _failure_lines(claim, decision):
            yield f"- **{heading}** {text}"
        yield ""


def _failure_lines(claim: Claim, decision: Decision) -> Iterator[tuple[str, str]]:
    formulas = "; ".join(_code(f.relation) for f in claim.formulas)
    yield "Printed:", claim.statement + (f" {formulas}" if formulas else "")
    yield (
        "Residual:",
        "; ".join(_residual_text(reading, len(decision.readings) > 1) for reading in decision.readings) + ".",
    )
    yield "Smallest counterexample:", decision.counterexample + "."
    corrected = "; ".join(_code(f.relation) for f in claim.corrected_formulas)
    correction = decision.correction
    proof = f" ({_reading_text(correction)})" if correction else ""
    yield "Correct:", f"{_correction_text(claim)} {corrected}{proof}"
    remark = f" {claim.remark}" if claim.remark else ""
    yield "What it does:", consequence_text(decision.consequence) + remark


def _residual_text(reading: ReadingDecision, labelled: bool) -> str:
    label = f"read with {reading.label}: " if labelled else ""
    if reading.residual is None:
        return f"{label}violated by {reading.false_case} (compared: {reading.method})"
    return f"{label}printed minus true leaves {_code(reading.residual)} ({reading.false_case})"


def _code(relation: Any) -> str:
    return f"$`{latex(relation)}`$"


def _section(ledger: Ledger, verdict: Verdict, heading: str, lines: Any) -> Iterator[str]:
    pairs = _pairs(ledger, verdict)
    if not pairs:
        return
    yield from (f"## {heading}", "")
    for claim, decision in pairs:
        yield f"- **{claim.id}** ({claim.where}): {claim.statement}"
        yield from (f"  - {line}" for line in lines(claim, decision))
        if claim.remark:
            yield f"  - {claim.remark}"
    yield ""


def _conditional_lines(claim: Claim, decision: Decision) -> Iterable[str]:
    for reading in decision.readings:
        yield f"Holds if {reading.condition}: true for {reading.true_case}, false for {reading.false_case}."
    if decision.counterexample:
        yield f"Smallest counterexample otherwise: {decision.counterexample}."
    if claim.correction:
        formulas = "; ".join(_code(f.relation) for f in claim.corrected_formulas)
        yield f"In general: {claim.correction.statement} {formulas}"


def _ambiguous_lines(_claim: Claim, decision: Decision) -> Iterable[str]:
    for reading in decision.readings:
        extra = f", leaves {_code(reading.residual)}" if reading.residual not in (None, 0) else ""
        verdict = f"holds if {reading.condition}" if reading.verdict is Verdict.HOLDS_IF else str(reading.verdict)
        yield f"Read as {reading.label}: {verdict}{extra}."


def _reason_lines(claim: Claim, _decision: Decision) -> Iterable[str]:
    return (claim.reason,)


def ledger_html(ledger: Ledger) -> str:
    """Return the records as HTML with their formulas set in MathML; it needs no network."""
    counts = ledger.counts()
    shown = [("all", counts["printed"]), *((str(v), counts[v]) for v in Verdict if counts[v])]
    filters = "".join(
        f"<button type='button' data-verdict='{name}' aria-pressed='{'true' if name == 'all' else 'false'}'>"
        f"{name} {count}</button>"
        for name, count in shown
    )
    pairs = zip(ledger.paper.claims, ledger.decisions, strict=True)
    claims = "\n".join(_claim_html(claim, decision) for claim, decision in pairs)
    return f"<p>{escape(counts_text(ledger))}</p><p class='filters'>{filters}</p>\n{claims}"


def _evidence_words(reading: ReadingDecision) -> str:
    kind = "proof" if reading.proof else "instances"
    cases = f"{reading.cases} case{'s' if reading.cases != 1 else ''}"
    return f"{reading.verdict}: {reading.strength.text} ({kind}, {cases}): {reading.method}"


def _claim_html(claim: Claim, decision: Decision) -> str:
    verdict = str(decision.verdict or "no answer")
    rows: list[tuple[str, str]] = [("where", escape(claim.where))]
    rows += [("printed", mathml(f.relation)) for f in claim.formulas]
    residual = residual_of(decision)
    rows += [("residual", mathml(residual))] if residual is not None else []
    rows += [("correct", mathml(f.relation)) for f in claim.corrected_formulas]
    texts = [
        ("correction", _correction_text(claim)),
        ("counterexample", decision.counterexample),
        ("consequence", consequence_text(decision.consequence)),
        *(("holds if", r.condition) for r in decision.readings if r.condition),
        *((f"read as {r.label}" if r.label else "evidence", _evidence_words(r)) for r in decision.readings),
        ("reason", claim.reason),
        ("remark", claim.remark),
        ("problem", decision.problem),
    ]
    rows += [(name, escape(text)) for name, text in texts if text]
    body = "".join(f"<tr><th>{name}</th><td>{content}</td></tr>" for name, content in rows)
    return (
        f"<details class='claim {verdict}' id='claim-{escape(claim.id)}'><summary><b>{escape(claim.id)}</b> "
        f"<span class='verdict'>{verdict}</span> {escape(claim.statement)}</summary><table>{body}</table></details>"
    )
