"""Drafts: what the checks of a record find that is not complete, and what it still lacks."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from semispline.papers.ledger.loading import load_drafts
from semispline.papers.ledger.mistakes import mistake_text
from semispline.papers.ledger.mutation import MutationResult, try_mutants
from semispline.papers.ledger.record_checks import missing
from semispline.papers.ledger.records import (
    Case,
    CheckFailedError,
    Claim,
    Part,
    Reading,
    Strength,
    Verdict,
    decided_cases,
)
from semispline.papers.ledger.verification import (
    TIME_LIMIT,
    Decision,
    Ledger,
    OutOfTimeError,
    decide,
    limited,
    of_each,
    verdict_of_cases,
)


@dataclass(frozen=True)
class PartFinding:
    """What one check finds.

    Attributes
    ----------
    formula : sympy.Rel or None
        As printed.
    method : str
    strength : Strength
    proof : bool
    true, false : tuple of str
        Labels of the cases.
    residual : sympy.Expr or None
        What the first false case leaves.
    counterexample : str
        The smallest one, where the check can search; else empty.
    mutation : MutationResult
    problem : str
        Why there is no answer; empty where there is one.
    """

    formula: Any
    method: str
    strength: Strength
    proof: bool
    true: tuple[str, ...] = ()
    false: tuple[str, ...] = ()
    residual: Any = None
    counterexample: str = ""
    mutation: MutationResult = MutationResult()
    problem: str = ""


@dataclass(frozen=True)
class ReadingFinding:
    """What the checks of one reading find, and what that amounts to; `amounts_to` is None where it is nothing."""

    label: str
    parts: tuple[PartFinding, ...]
    amounts_to: Verdict | None
    problem: str = ""


@dataclass(frozen=True)
class DraftFinding:
    """What the checks of a draft find.

    Attributes
    ----------
    id : str
    recorded : Verdict or None
    readings : tuple of ReadingFinding
    correction : ReadingFinding or None
    amounts_to : Verdict or None
        The verdict that the cases amount to; None where they amount to none.
    missing : tuple of str
        What the record lacks for that verdict, or for the recorded one.
    seconds : float
    """

    id: str
    recorded: Verdict | None
    readings: tuple[ReadingFinding, ...]
    correction: ReadingFinding | None
    amounts_to: Verdict | None
    missing: tuple[str, ...]
    seconds: float


def is_draft(claim: Claim) -> bool:
    """Tell whether a record lacks something."""
    return next(missing(claim), None) is not None


def examine(claim: Claim, folder: Path = Path(), time_limit: float = TIME_LIMIT) -> DraftFinding:
    """Run every check of a record that need not be complete; nothing that a check does is raised."""
    started = time.perf_counter()
    readings = tuple(_examined(reading, folder, time_limit) for reading in claim.readings)
    correction = (
        _examined(Reading(claim.correction_parts), folder, time_limit) if claim.correction is not None else None
    )
    verdicts = {reading.amounts_to for reading in readings}
    amounts_to = None
    if verdicts and None not in verdicts:
        amounts_to = verdicts.pop() if len(verdicts) == 1 else Verdict.AMBIGUOUS
    return DraftFinding(
        claim.id,
        claim.verdict,
        readings,
        correction,
        amounts_to,
        tuple(_lacking(claim, amounts_to, correction)),
        time.perf_counter() - started,
    )


def verify_drafts(
    name: str, *, workers: int = 2, progress: Callable[[Decision | DraftFinding], None] | None = None
) -> tuple[Ledger, tuple[DraftFinding, ...]]:
    """Load a paper, decide its complete records, and see what the checks of the others find.

    Parameters
    ----------
    name : str
        Folder name under `papers/`, or the path of a folder.
    workers : int
        Processes; 1 works in this one.
    progress : callable, optional
        Told of each record as it is done.

    Returns
    -------
    Ledger
        Of the complete records.
    tuple of DraftFinding
        Of the others.

    Raises
    ------
    LedgerError
        The paper cannot be found, or a record is not well formed.
    WorkerError
        A process was killed, or needed more than its limits.
    """
    paper = load_drafts(name)
    found = of_each(_decided_or_examined, paper, workers, progress)
    decisions = tuple(one for one in found if isinstance(one, Decision))
    complete = {decision.id for decision in decisions}
    claims = tuple(claim for claim in paper.claims if claim.id in complete)
    return Ledger(replace(paper, claims=claims), decisions), tuple(o for o in found if isinstance(o, DraftFinding))


def _decided_or_examined(claim: Claim, folder: Path) -> Decision | DraftFinding:
    return examine(claim, folder) if is_draft(claim) else decide(claim, folder)


def _lacking(claim: Claim, amounts_to: Verdict | None, correction: ReadingFinding | None) -> list[str]:
    """Return what is missing: for the recorded verdict, or where there is none for what the cases amount to."""
    lacking = list(missing(claim))
    if claim.verdict is None and amounts_to is not None:
        lacking += missing(replace(claim, verdict=amounts_to))
    if claim.verdict is None and not claim.readings:
        lacking.append("a check; or what it names, for a definition; or the reason why it is not checkable")
    if claim.verdict is not None and amounts_to not in (None, claim.verdict):
        lacking.append(f"checks that amount to {claim.verdict}: they amount to {amounts_to}")
    if correction is not None and correction.amounts_to is not Verdict.HOLDS:
        lacking.append("a correction that holds")
    return list(dict.fromkeys(lacking))


def _examined(reading: Reading, folder: Path, time_limit: float) -> ReadingFinding:
    found, cases = [], []
    for part in reading.parts:
        finding, of_part = _of_part(part, folder, time_limit)
        found.append(finding)
        cases += of_part
    amounts_to, problem = None, ""
    if cases and not any(finding.problem for finding in found):
        try:
            amounts_to = verdict_of_cases(cases, reading.condition) if reading.condition else _without_condition(cases)
        except CheckFailedError as error:
            problem = str(error)
    return ReadingFinding(reading.label, tuple(found), amounts_to, problem)


def _without_condition(cases: list[Case]) -> Verdict:
    """Decide cases to which a condition may still be missing."""
    if all(case.true for case in cases):
        return Verdict.HOLDS
    return Verdict.FAILS if any(case.own and not case.true for case in cases) else Verdict.HOLDS_IF


def _of_part(part: Part, folder: Path, time_limit: float) -> tuple[PartFinding, list[Case]]:
    check, formula = part.check, part.formula
    finding = PartFinding(formula.relation if formula else None, check.method, check.strength, check.proof)
    cases: list[Case] = []
    try:
        with limited(time_limit):
            # One by one, so that those are shown that come before the one that fails.
            for case in decided_cases(check, formula):
                cases.append(case)
            wrong = [case for case in cases if not case.true]
            finding = replace(
                finding,
                true=tuple(case.label for case in cases if case.true),
                false=tuple(case.label for case in wrong),
                residual=wrong[0].residual if wrong else None,
                problem="" if cases else "no instance satisfies the assumptions",
            )
            if wrong and formula is not None and check.search:
                searched = check.search(formula)
                finding = replace(finding, counterexample=str(searched) if searched else "")
            finding = replace(finding, mutation=try_mutants(part, cases))
    except OutOfTimeError:
        finding = replace(finding, problem=f"no answer within {time_limit:g} s of processor time")
    except Exception as error:
        finding = replace(finding, problem=mistake_text(error, folder))
    return finding, cases
