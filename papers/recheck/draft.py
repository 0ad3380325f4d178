"""What a paper's certificates are written as, and how they become those of its records."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from semispline.papers.ledger import Claim, LedgerError, Paper, Verdict
from semispline.papers.recheck.statements import Certificate, Export, Reading, Statement


@dataclass(frozen=True)
class Draft:
    """The cases of the readings of a record, in its order, and of its correction.

    Attributes
    ----------
    readings : sequence of statements
    correction : statements
    believed : tuple of str
        What no system was asked.
    left_out : str
        What of the verdict is not in here.
    """

    readings: Sequence[Iterable[Statement]]
    correction: Iterable[Statement] = ()
    believed: tuple[str, ...] = ()
    left_out: str = ""


Drafts = Mapping[str, Callable[[Claim], Draft]]


def is_decided(claim: Claim) -> bool:
    """Tell whether a record has something to recheck."""
    return claim.verdict is not Verdict.NOT_CHECKABLE


def export_of(
    paper: Paper,
    drafts: Drafts,
    not_expressible: Mapping[str, str],
    controls: Callable[[], Iterable[Statement]] = tuple,
) -> Export:
    """Return the export of a paper.

    Raises
    ------
    LedgerError
        A draft does not fit its record, or a decided record has neither a draft nor a reason.
    """
    decided = [claim for claim in paper.claims if is_decided(claim)]
    known = {claim.id for claim in decided}
    for identifier in (*drafts, *not_expressible):
        if identifier not in known:
            raise LedgerError(f"certificate {identifier}: found no decided record of this id, expected one")
    certificates = [_certificate(claim, drafts[claim.id](claim)) for claim in decided if claim.id in drafts]
    reasons = dict(not_expressible)
    for claim in decided:
        if (claim.id in drafts) == (claim.id in reasons):
            raise LedgerError(f"certificate {claim.id}: expected either statements or a reason why there are none")
    return Export(paper.name, tuple(certificates), tuple(controls()), reasons)


def _certificate(claim: Claim, draft: Draft) -> Certificate:
    readings = tuple(
        Reading(tuple(cases), reading.label, reading.condition)
        for cases, reading in zip(draft.readings, claim.readings, strict=False)
    )
    if len(draft.readings) != len(claim.readings):
        raise LedgerError(
            f"certificate {claim.id}: found {len(draft.readings)} readings, expected {len(claim.readings)} as recorded"
        )
    correction = Reading(tuple(draft.correction))
    if bool(correction.cases) != bool(claim.correction):
        raise LedgerError(f"certificate {claim.id}: expected a correction exactly where the record has one")
    return Certificate(
        claim.id,
        str(claim.verdict),
        readings,
        correction if claim.correction else None,
        draft.believed,
        draft.left_out,
    )
