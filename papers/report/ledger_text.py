"""A decided ledger as a table on the terminal, as JSON, and as a section of HTML; `erratum` has the Markdown."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

from semispline.papers.ledger import Claim, Consequence, Decision, Ledger, ReadingDecision, Strength, Verdict
from semispline.papers.report.mathml import mathml, text_html

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
    return "; ".join(reading_text(reading) for reading in decision.readings)


def reading_text(reading: ReadingDecision) -> str:
    """Return in words what the verdict of one reading stands on."""
    label = f"[{reading.label}: {reading.verdict}] " if reading.label else ""
    return label + _words(reading)


def checked_text(reading: ReadingDecision) -> str:
    """Return whether the reading is proved, or how many cases were checked."""
    cases = f"{reading.cases} {'case' if reading.cases == 1 else 'cases'}"
    if reading.proof:
        return f"proof, {cases}"
    exact = f"{cases} in floating point" if reading.strength is Strength.FLOAT else f"{cases} checked exactly"
    return f"disproved, {exact}" if reading.proved else exact


def strength_text(decision: Decision) -> str:
    """Return the strength of the evidence in words, that of the weakest reading; empty where nothing was checked."""
    return max(reading.strength for reading in decision.readings).text if decision.readings else ""


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
                "strength": strength_text(decision) or None,
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
                "corrected": correction_text(claim),
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


def correction_text(claim: Claim) -> str:
    """Return what is true instead, in words; empty where there is no correction."""
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
        table.add_row(claim.id, claim.statement, verdict, _short_evidence(claim, decision), mutants_text(decision))
    return table


def _short_evidence(claim: Claim, decision: Decision) -> str:
    if decision.problem:
        return decision.problem
    if not decision.readings:
        return claim.reason
    return "; ".join(dict.fromkeys(f"{kind_text(r)}, {checked_text(r)}" for r in decision.readings))


def mutants_text(decision: Decision) -> str:
    """Return how many mutants were noticed, of how many; empty where there is no formula."""
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
    kinds = ", ".join(f"{number} {kind}" for kind, number in sorted(ledger.mutants_by_kind().items()))
    return (
        f"{n['printed']} printed claims, {n['decided']} decided, {n['proved']} of them proved or disproved exactly: "
        f"{verdicts}; {n['vacuous']} vacuous, {n['changed']} changed.\n"
        f"{n['mutants']} mutants of printed and corrected formulas tried ({kinds}): {n['mutants_survived']} survived "
        f"without a reason, {n['mutants_equivalent']} say the same as the formula, {n['mutants_undecidable']} change "
        "printed data on which nothing else printed depends (each with its reason)."
    )


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


def _words(reading: ReadingDecision) -> str:
    return f"{kind_text(reading)}, {checked_text(reading)}: {reading.method}"


def kind_text(reading: ReadingDecision) -> str:
    """Return the strength of the evidence in words; instances that are all there is are no sample."""
    complete = reading.proof and reading.strength is Strength.RATIONAL
    return "exact rational arithmetic" if complete else reading.strength.text


def _mutants_and_reasons(decision: Decision) -> str:
    """Return how many mutants were noticed, and why the others were not."""
    reasons = dict.fromkeys(why for _, why in decision.mutation.equivalent + decision.mutation.undecidable)
    return "; ".join((f"{mutants_text(decision)} noticed", *reasons)) if decision.mutation.tried else ""


def _claim_html(claim: Claim, decision: Decision) -> str:
    verdict = str(decision.verdict or "no answer")
    rows: list[tuple[str, str]] = [("where", escape(claim.where))]
    rows += [("printed", mathml(f.relation)) for f in claim.formulas]
    residual = residual_of(decision)
    rows += [("residual", mathml(residual))] if residual is not None else []
    rows += [("correct", mathml(f.relation)) for f in claim.corrected_formulas]
    texts = [
        ("correction", correction_text(claim)),
        ("counterexample", decision.counterexample),
        ("consequence", consequence_text(decision.consequence)),
        *(("holds if", r.condition) for r in decision.readings if r.condition),
        *((f"read as {r.label}" if r.label else "evidence", f"{r.verdict}: {_words(r)}") for r in decision.readings),
        ("reason", claim.reason),
        ("remark", claim.remark),
        ("mutants", _mutants_and_reasons(decision)),
        ("problem", decision.problem),
    ]
    rows += [(name, text_html(text)) for name, text in texts if text]
    body = "".join(f"<tr><th>{name}</th><td>{content}</td></tr>" for name, content in rows)
    return (
        f"<details class='claim {verdict}' id='claim-{escape(claim.id)}'><summary><b>{escape(claim.id)}</b> "
        f"<span class='verdict'>{verdict}</span> {text_html(claim.statement)}</summary><table>{body}</table></details>"
    )
