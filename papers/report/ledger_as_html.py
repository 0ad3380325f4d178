"""A decided ledger as a section of HTML, with formulas in MathML."""

from __future__ import annotations

from html import escape

from semispline.papers.ledger import Claim, Decision, Ledger, Notation, Verdict
from semispline.papers.report.formulas import mathml, text_html
from semispline.papers.report.ledger_words import (
    consequence_text,
    correction_text,
    counts_text,
    evidence_words,
    mutants_text,
    print_lines,
    residual_of,
    words,
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
    claims = "\n".join(_claim_html(claim, decision, ledger.paper.notation) for claim, decision in pairs)
    meanings = "".join(f"<li>{escape(line)}</li>" for line in words())
    told = f"<details><summary>What the words mean</summary><ul>{meanings}</ul></details>"
    return f"<p>{escape(counts_text(ledger))}</p>{told}<p class='filters'>{filters}</p>\n{claims}"


def _mutants_and_reasons(decision: Decision) -> str:
    """Return how many mutants were noticed, and why the others were not."""
    reasons = dict.fromkeys(why for _, why in decision.mutation.equivalent + decision.mutation.undecidable)
    return "; ".join((f"{mutants_text(decision)} noticed", *reasons)) if decision.mutation.tried else ""


def _claim_html(claim: Claim, decision: Decision, notation: Notation) -> str:
    verdict = str(decision.verdict or "no answer")
    rows: list[tuple[str, str]] = [("where", escape(claim.where))]
    rows += [(heading, f"<pre>{escape(text)}</pre>") for heading, text in print_lines(claim)]
    rows += [("printed", mathml(f.relation, notation)) for f in claim.formulas]
    residual = residual_of(decision)
    rows += [("residual", mathml(residual, notation))] if residual is not None else []
    rows += [("correct", mathml(f.relation, notation)) for f in claim.corrected_formulas]
    texts = [
        ("correction", correction_text(claim)),
        ("counterexample", decision.counterexample),
        ("consequence", consequence_text(decision.consequence)),
        *(("holds if", r.condition) for r in decision.readings if r.condition),
        *(
            (f"read as {r.label}" if r.label else "evidence", f"{r.verdict}: {evidence_words(r)}")
            for r in decision.readings
        ),
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
