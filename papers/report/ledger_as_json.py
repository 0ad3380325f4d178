"""A decided ledger as the file format has it."""

from __future__ import annotations

from typing import Any

from semispline.papers.ledger import Ledger
from semispline.papers.recheck import Recheck
from semispline.papers.report.ledger_words import (
    consequence_text,
    correction_text,
    evidence_text,
    residual_of,
    strength_text,
)


def ledger_record(ledger: Ledger, second: Recheck | None = None) -> dict[str, Any]:
    """Return the ledger as the file format has it, with what a second system says of it where it was asked."""
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
                "consistent": decision.consistent,
                "cause": claim.cause,
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
                "measured_corrected": dict(decision.consequence.corrected) if decision.consequence else {},
                "remark": claim.remark,
                "mutants": {
                    "tried": decision.mutation.tried,
                    "kinds": dict(sorted(decision.mutation.kinds.items())),
                    "equivalent": [{"mutant": m, "reason": why} for m, why in decision.mutation.equivalent],
                    "undecidable": [{"mutant": m, "reason": why} for m, why in decision.mutation.undecidable],
                    "survivors": list(decision.mutation.survivors),
                },
                "seconds": round(decision.seconds, 3),
                **({"recheck": second.record(claim.id)} if second else {}),
            }
        )  # fmt: skip
    return {
        "format": "semispline/1",
        "kind": "ledger",
        "paper": ledger.paper.name,
        "claims": claims,
        "causes": [
            {"key": cause.key, "title": cause.title, "text": cause.text, "misprint": cause.misprint,
             "records": [decision.id for decision in decisions]}
            for cause, decisions in ledger.causes()
        ],
        "counts": ledger.counts() | (second.counts() if second else {}),
    }  # fmt: skip
