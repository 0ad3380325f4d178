"""What a paper's certificates are written as, and how they become those of its records."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from semispline.papers.ledger import Claim, LedgerError, Paper, Part, mutants
from semispline.papers.recheck.statements import Certificate, Export, Reading, Statement, Theory
from semispline.papers.recheck.texts import NotExpressibleError
from semispline.solver.errors import InputError


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
# Changed formulas of each kind that are handed on.
_EACH = 3


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
    """Return the export of a paper.

    A decided record with neither a draft nor a reason gets what its checks export, or else `UNWRITTEN` for a reason.

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
    exportable = [claim for claim in decided if reasons.get(claim.id) == UNWRITTEN and _exports(claim)]
    for claim in exportable:
        try:
            certificates.append(_certificate(claim, _of_checks(claim)))
            del reasons[claim.id]
        except NotExpressibleError as error:
            reasons[claim.id] = str(error)
    places = {claim.id: n for n, claim in enumerate(paper.claims)}
    certificates.sort(key=lambda certificate: places[certificate.id])
    every_control = (*controls(), *_changed(exportable))
    return Export(paper.name, tuple(certificates), every_control, reasons, dict(theorems or {}), tuple(theories()))


def _exports(claim: Claim) -> bool:
    return all(part.check.export for part in (*claim.parts, *claim.correction_parts))


def _of_checks(claim: Claim) -> Draft:
    """Return what the checks of a record export."""

    def of(parts: Iterable[Part]) -> list[Statement]:
        return [case for part in parts if part.check.export for case in part.check.export(part.formula)]

    parts = (*claim.parts, *claim.correction_parts)
    believed = tuple(dict.fromkeys(part.check.believed for part in parts if part.check.believed))
    return Draft([of(reading.parts) for reading in claim.readings], of(claim.correction_parts), believed)


def _changed(claims: Iterable[Claim]) -> Iterator[Statement]:
    """Yield changed formulas of records that their checks export: some of each kind of change."""
    made: Counter[str] = Counter()
    for part in (part for claim in claims for part in claim.parts):
        if part.formula is None or part.check.export is None:
            continue
        for mutant in mutants(part.formula):
            if made[mutant.kind] < _EACH and mutant.text not in part.formula.equivalent:
                changed = replace(part.formula, relation=mutant.relation, equivalent={}, undecidable={})
                try:
                    wrong = next((s for s in part.check.export(changed) if not s.true), None)
                except (InputError, ZeroDivisionError):
                    continue
                if wrong is not None:
                    made[mutant.kind] += 1
                    yield replace(wrong, label=f"{mutant.kind} changed: {wrong.label}")


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
