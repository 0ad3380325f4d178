"""What the checks of a draft find, for its author."""

from __future__ import annotations

from collections.abc import Iterator

from semispline.papers.ledger import Claim, DraftFinding, PartFinding, ReadingFinding

# Labels of cases that are shown of each kind.
_SHOWN = 3


def draft_text(claim: Claim, finding: DraftFinding) -> str:
    """Return some lines: what each check finds, what that amounts to, and what is missing."""
    recorded = f"recorded as {finding.recorded}" if finding.recorded else "no verdict yet"
    return "\n".join(
        [
            f"{claim.id} ({claim.where}): draft, {recorded}",
            f"  {claim.statement}",
            *_readings(finding),
            f"  amounts to: {finding.amounts_to or 'nothing yet'}",
            *(f"  missing: {what}" for what in finding.missing),
        ]
    )


def _readings(finding: DraftFinding) -> Iterator[str]:
    for reading in finding.readings:
        yield from _reading(reading, f"read as {reading.label}" if reading.label else "")
    if finding.correction is not None:
        yield from _reading(finding.correction, "correction")


def _reading(reading: ReadingFinding, heading: str) -> Iterator[str]:
    if heading:
        yield f"  {heading}: {reading.amounts_to or 'nothing yet'}"
    for part in reading.parts:
        yield from (f"    {line}" for line in _part(part))
    if reading.problem:
        yield f"    {reading.problem}"


def _part(part: PartFinding) -> Iterator[str]:
    yield f"{part.formula if part.formula is not None else 'a question'} -- {part.method}"
    if part.problem:
        yield f"no answer: {part.problem}"
    proof = "proof" if part.proof else "no proof"
    if part.true or part.false:
        yield f"{len(part.true)} true, {len(part.false)} false ({part.strength.text}, {proof})"
    if part.true:
        yield f"true: {_listed(part.true)}"
    if part.false:
        yield f"false: {_listed(part.false)}"
    if part.residual is not None:
        yield f"residual of the first: {part.residual}"
    if part.counterexample:
        yield f"smallest counterexample: {part.counterexample}"
    if part.mutation.tried:
        survivors = f"; not noticed: {_listed(part.mutation.survivors)}" if part.mutation.survivors else ""
        yield f"mutants: {part.mutation.noticed} of {part.mutation.tried} noticed{survivors}"


def _listed(labels: tuple[str, ...]) -> str:
    more = f"; and {len(labels) - _SHOWN} more" if len(labels) > _SHOWN else ""
    return "; ".join(labels[:_SHOWN]) + more
