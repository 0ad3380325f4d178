"""What a paper's certificates are written as, and how they become those of its records."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from semispline.papers.ledger import Claim, LedgerError, Paper
from semispline.papers.recheck.statements import Certificate, Export, Reading, Statement, Theory


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


# Records that are not decided: they cannot be false, or nothing in them can be computed.
_UNDECIDED = ("not-checkable", "definition")
UNWRITTEN = "no certificate has been written for this record"


def is_decided(claim: Claim) -> bool:
    """Tell whether a record has something to recheck."""
    return str(claim.verdict) not in _UNDECIDED


def export_of(
    paper: Paper,
    drafts: Drafts,
    not_expressible: Mapping[str, str],
    controls: Callable[[], Iterable[Statement]] = tuple,
    theorems: Mapping[str, tuple[str, ...]] | None = None,
    theories: Callable[[], Iterable[Theory]] = tuple,
) -> Export:
    """Return the export of a paper; a decided record with neither a draft nor a reason has `UNWRITTEN` for one.

    `theorems` says which theorems of `derivations/coq` stand for a sentence that is believed, or prove a record;
    `theories` are theorems that are generated as a whole.

    Raises
    ------
    LedgerError
        A draft does not fit its record, or stands beside a reason why there is none.
    """
    decided = [claim for claim in paper.claims if is_decided(claim)]
    certificates = [_certificate(claim, drafts[claim.id](claim)) for claim in decided if claim.id in drafts]
    both = sorted(set(drafts) & set(not_expressible))
    if both:
        raise LedgerError(
            f"certificate {both[0]}: found statements and a reason why there are none, expected one of them"
        )
    reasons = {c.id: not_expressible.get(c.id, UNWRITTEN) for c in decided if c.id not in drafts}
    return Export(paper.name, tuple(certificates), tuple(controls()), reasons, dict(theorems or {}), tuple(theories()))


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
