"""Deciding a paper: every check is run anew, and its verdict compared with the recorded one."""

from __future__ import annotations

import signal
import threading
import time
from collections import Counter
from collections.abc import Callable, Generator, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from math import isfinite
from pathlib import Path
from typing import Any, Protocol, TypeAlias, TypeVar

from sympy import preorder_traversal

from semispline.papers.ledger.loading import RECORDS, claims_of, load_paper, paper_folder, record_files
from semispline.papers.ledger.mistakes import found_text, place_of_error, place_of_text
from semispline.papers.ledger.mutation import MutationResult, try_mutants
from semispline.papers.ledger.records import (
    Case,
    Cause,
    Check,
    CheckFailedError,
    Claim,
    Consequence,
    Formula,
    Paper,
    Reading,
    Strength,
    Verdict,
    decided_cases,
)
from semispline.solver.errors import ComputationError, InputError
from semispline.solver.workers import in_pool


@dataclass(frozen=True)
class ReadingDecision:
    """What one reading came to.

    Attributes
    ----------
    label, condition : str
        As in the record.
    verdict : Verdict
    strength : Strength
        The weakest among the parts.
    proof : bool
        Every part is proved, not only checked on instances.
    method : str
    cases : int
    residual : sympy.Expr or None
        What the first false case leaves.
    false_case, true_case : str
        One instance on each side; empty where there is none.
    """

    label: str
    condition: str
    verdict: Verdict
    strength: Strength
    proof: bool
    method: str
    cases: int
    residual: Any
    false_case: str
    true_case: str

    @property
    def proved(self) -> bool:
        """Whether the verdict is proved: a single exact instance disproves, and so does a contradiction in print."""
        return self.proof or (self.verdict is Verdict.FAILS and self.strength is not Strength.FLOAT)

    @property
    def consistent(self) -> bool:
        """Whether it rests on nothing but that what is printed agrees."""
        return self.strength is Strength.CONSISTENT and not self.proved


@dataclass(frozen=True)
class Decision:
    """One record, decided anew.

    Attributes
    ----------
    id : str
    recorded : Verdict or None
        None for a draft, which is never `ok`.
    verdict : Verdict or None
        None where a check gave no answer.
    problem : str
        Why there is no verdict; empty where all is well.
    mistake : bool
        There is none since something in the files of the paper is wrong; `problem` begins with the place.
    vacuous : bool
        Some check had no instance.
    readings : tuple of ReadingDecision
    counterexample : str
    correction : ReadingDecision or None
        Decided like a reading; it must hold.
    consequence : Consequence or None
    mutation : MutationResult
        Of all printed and corrected formulas.
    seconds : float
    """

    id: str
    recorded: Verdict | None
    verdict: Verdict | None
    problem: str
    vacuous: bool
    readings: tuple[ReadingDecision, ...]
    counterexample: str
    correction: ReadingDecision | None
    consequence: Consequence | None
    mutation: MutationResult
    seconds: float
    mistake: bool = False

    @property
    def ok(self) -> bool:
        """The verdict is the recorded one and nothing is missing."""
        answered = self.verdict is not None and not self.problem and not self.vacuous
        return answered and self.verdict is self.recorded and not self.mutation.survivors

    @property
    def proved(self) -> bool:
        """Proved, or disproved by an exact instance: nothing rests on floating point or on a sample."""
        return bool(self.readings) and self.verdict is not None and all(reading.proved for reading in self.readings)

    @property
    def consistent(self) -> bool:
        """Some reading rests on nothing but that what is printed agrees, or that something of the kind exists."""
        return any(reading.consistent for reading in self.readings)

    @property
    def false_case(self) -> str:
        """The first instance of a failing reading."""
        return next((r.false_case for r in self.readings if r.verdict is Verdict.FAILS), "")


class VacuousError(CheckFailedError):
    """A check without a single instance."""


class OutOfTimeError(BaseException):
    """Raised in the middle of a check by its limit: no `except Exception` on the way out may take it for an answer."""


# Where a record of no file stands.
_NO_FOLDER = Path("/nowhere")
# What is no mistake of the one who wrote a check, wherever it comes from.
_NOT_OF_FILES = (ComputationError, MemoryError, RecursionError)
# Of processor time, in seconds; no check of a paper that ships takes a fiftieth of this.
TIME_LIMIT = 600.0


def decide(claim: Claim, folder: Path = _NO_FOLDER, time_limit: float = TIME_LIMIT) -> Decision:
    """Run every check of one record, which stands in a folder.

    A check without an answer does not raise: it leaves a decision without a verdict, which is never `ok`. So does one
    that takes more than `time_limit` seconds of processor time, on systems with an interval timer (Linux, macOS).
    """
    started = time.perf_counter()
    readings: tuple[ReadingDecision, ...] = ()
    verdict, problem, vacuous, mistake = None, "", False, False
    counterexample, correction, consequence = "", None, None
    mutation = MutationResult()
    known: _Known = {}
    try:
        with limited(time_limit):
            readings = tuple(_decide_reading(reading, known) for reading in claim.readings)
            verdict = _combined(readings) if readings else _without_check(claim)
            counterexample = _counterexample(claim, verdict, known)
            if claim.correction:
                correction = _decide_reading(Reading(claim.correction.parts), known)
                if correction.verdict is not Verdict.HOLDS:
                    raise CheckFailedError(f"the correction {correction.verdict}, expected a formula that holds")
                if not correction.true_case:
                    raise CheckFailedError("the correction has no true instance, expected at least one")
            if claim.consequence:
                consequence = claim.consequence()
            _require_evidence(verdict, readings, counterexample, consequence)
            mutation = _mutation(claim, known)
    except OutOfTimeError:
        verdict, problem = None, f"undecided: out of time, no answer within {time_limit:g} s of processor time"
    except VacuousError as error:
        verdict, problem, vacuous = None, str(error), True
    except CheckFailedError as error:
        verdict, problem = None, str(error)
    except Exception as error:  # a check may fail in any way; none may pass for it
        where = place_of_error(error, folder)
        mistake = isinstance(error, InputError) or bool(where and not isinstance(error, _NOT_OF_FILES))
        where = where or place_of_text(claim.id, folder, *RECORDS)
        verdict, problem = None, f"{where}: {found_text(error)}" if where else found_text(error)
    return Decision(
        claim.id,
        claim.verdict,
        verdict,
        problem,
        vacuous,
        readings,
        counterexample,
        correction,
        consequence,
        mutation,
        time.perf_counter() - started,
        mistake,
    )


def _counterexample(claim: Claim, verdict: Verdict, known: _Known) -> str:
    """Search for a counterexample as the record says, or where it says nothing and fails as its checks say."""
    if claim.counterexample:
        found = claim.counterexample()
        if found is None or not found.values:
            raise CheckFailedError("the search found no counterexample, expected one with its values")
        return str(found)
    if verdict is not Verdict.FAILS:
        return ""
    for part in claim.parts:
        wrong = any(not case.true for case in known[part.check, part.formula])
        if wrong and part.formula is not None and part.check.search:
            found = part.check.search(part.formula)
            if found is not None:
                return str(found)
    raise CheckFailedError("fails, and the searches of its checks found no counterexample, expected one")


def _require_evidence(
    verdict: Verdict,
    readings: tuple[ReadingDecision, ...],
    counterexample: str,
    consequence: Consequence | None,
) -> None:
    """Raise `CheckFailedError` where a verdict lacks what it has to stand on, whatever the record promised."""
    if verdict is Verdict.FAILS and not counterexample and all(reading.residual is None for reading in readings):
        raise CheckFailedError("fails with neither residual nor counterexample, expected one of them")
    if consequence is not None:
        numbers = consequence.measured.values()
        if not consequence.text.strip() or not numbers or not all(isfinite(number) for number in numbers):
            raise CheckFailedError(
                f"the consequence measured {dict(consequence.measured)}, expected a text and finite numbers"
            )
    if verdict is Verdict.HOLDS_IF and not all(reading.true_case and reading.false_case for reading in readings):
        raise CheckFailedError("holds-if without an instance on each side of its condition")


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise `OutOfTimeError` in the body when this process has used some seconds of processor time.

    Time that passes while the process waits for its turn does not count, so that a busy machine decides nothing; what
    the system does for it counts (ITIMER_PROF, not ITIMER_VIRTUAL), so that a check that only fills memory ends too.
    Does nothing outside the main thread of a process, where Python hears no signals.
    """
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return
    met = False

    def stop(_number: int, _frame: object) -> None:
        nonlocal met
        met = True
        raise OutOfTimeError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
        # Where something took the error all the same, neither an answer nor an error that came after it counts.
        if met:
            raise OutOfTimeError


# What the checks of one record found: readings may share a part, and mutants are compared with it.
_Known: TypeAlias = dict[tuple[Check, Formula | None], list[Case]]


def _decide_reading(reading: Reading, known: _Known) -> ReadingDecision:
    cases: list[Case] = []
    for part in reading.parts:
        key = part.check, part.formula
        if key not in known:
            known[key] = list(decided_cases(*key))
        found = known[key]
        if not found:
            raise VacuousError(f"no instance satisfies the assumptions of: {part.check.method}")
        cases += found
    wrong = [case for case in cases if not case.true]
    right = [case for case in cases if case.true]
    # The residual shown is that of the paper's own setting where it has one.
    shown = next((c for c in wrong if c.own), wrong[0] if wrong else None)
    return ReadingDecision(
        reading.label,
        reading.condition,
        verdict_of_cases(cases, reading.condition),
        max(part.check.strength for part in reading.parts),
        all(part.check.proof for part in reading.parts),
        "; ".join(dict.fromkeys(part.check.method for part in reading.parts)),
        len(cases),
        shown.residual if shown else None,
        shown.label if shown else "",
        next((c.label for c in right if c.own), right[0].label if right else ""),
    )


def verdict_of_cases(cases: list[Case], condition: str) -> Verdict:
    """Decide one reading: false in the paper's own setting is `fails`, false only outside it needs a condition."""
    if all(case.true for case in cases):
        return Verdict.HOLDS
    if any(case.own and not case.true for case in cases):
        return Verdict.FAILS
    if not condition:
        raise CheckFailedError(f"false for {next(c.label for c in cases if not c.true)}, expected a stated condition")
    for case in cases:
        if case.true != case.meets:
            raise CheckFailedError(f"the condition «{condition}» does not separate true from false at {case.label}")
    if not any(case.own for case in cases):
        raise CheckFailedError("no instance of the paper's own setting, expected one that meets the condition")
    return Verdict.HOLDS_IF


def _combined(readings: tuple[ReadingDecision, ...]) -> Verdict:
    """Combine readings: where they differ the claim is ambiguous, else it is what they all are."""
    verdicts = {reading.verdict for reading in readings}
    return verdicts.pop() if len(verdicts) == 1 else Verdict.AMBIGUOUS


def _without_check(claim: Claim) -> Verdict:
    """Return the verdict on a claim with nothing to decide: a name that is given, or nothing that can be checked."""
    return Verdict.DEFINITION if claim.verdict is Verdict.DEFINITION else Verdict.NOT_CHECKABLE


def _mutation(claim: Claim, known: _Known) -> MutationResult:
    parts = claim.parts + claim.correction_parts
    return sum((try_mutants(part, known[part.check, part.formula]) for part in parts), MutationResult())


@dataclass(frozen=True)
class Ledger:
    """A paper, decided: the records and their decisions in the same order."""

    paper: Paper
    decisions: tuple[Decision, ...]

    @property
    def ok(self) -> bool:
        """Every verdict is the recorded one, nothing vacuous, no mutant survived without a reason."""
        return all(decision.ok for decision in self.decisions)

    @property
    def mistaken(self) -> tuple[str, ...]:
        """The records of which something in the files of the paper is wrong."""
        return tuple(decision.id for decision in self.decisions if decision.mistake)

    @property
    def unanswered(self) -> tuple[str, ...]:
        """The records whose checks gave no answer: a failure of the check, neither a pass nor a "no"."""
        return tuple(decision.id for decision in self.decisions if decision.verdict is None)

    def counts(self) -> dict[str, int]:
        """Return how many records are printed, decided, proved, consistent; each verdict; causes; mutants and more."""
        decided = [d for d in self.decisions if d.verdict not in (None, Verdict.NOT_CHECKABLE, Verdict.DEFINITION)]
        return {
            "printed": len(self.decisions),
            "decided": len(decided),
            "proved": sum(d.proved for d in decided),
            "consistent": sum(d.consistent for d in decided),
            **{str(v): sum(d.verdict is v for d in self.decisions) for v in Verdict},
            "causes": len(self.causes()),
            "vacuous": sum(d.vacuous for d in self.decisions),
            "changed": sum(d.verdict is not d.recorded for d in self.decisions),
            "mutants": sum(d.mutation.tried for d in self.decisions),
            "mutants_equivalent": sum(len(d.mutation.equivalent) for d in self.decisions),
            "mutants_undecidable": sum(len(d.mutation.undecidable) for d in self.decisions),
            "mutants_undefined": sum(d.mutation.undefined for d in self.decisions),
            "mutants_survived": sum(len(d.mutation.survivors) for d in self.decisions),
        }

    def causes(self) -> list[tuple[Cause, list[Decision]]]:
        """Return each cause with the decisions on its records that found something wrong; none where all hold."""
        sound = (Verdict.HOLDS, Verdict.DEFINITION, Verdict.NOT_CHECKABLE)
        wrong = [
            (claim.cause, decision)
            for claim, decision in zip(self.paper.claims, self.decisions, strict=True)
            if decision.verdict not in sound
        ]
        found = [(cause, [d for key, d in wrong if key == cause.key]) for cause in self.paper.causes]
        return [(cause, decisions) for cause, decisions in found if decisions]

    def mutants_by_kind(self) -> dict[str, int]:
        """Return how many mutants of each kind were tried."""
        total: Counter[str] = Counter()
        for decision in self.decisions:
            total.update(decision.mutation.kinds)
        return dict(total)


def verify(
    name: str,
    *,
    workers: int = 2,
    progress: Callable[[Decision], None] | None = None,
) -> Ledger:
    """Load a paper and decide all its records.

    Parameters
    ----------
    name : str
        Folder name under `papers/`, or the path of a folder.
    workers : int
        Processes; 1 decides in this one.
    progress : callable, optional
        Told of each decision as it comes.

    Raises
    ------
    LedgerError
        The paper cannot be found, or a record is not well formed.
    WorkerError
        A process was killed, or needed more than its limits.
    """
    paper = load_paper(name)
    return Ledger(paper, of_each(decide, paper, workers, progress))


_T = TypeVar("_T", bound="_OfClaim")


class _OfClaim(Protocol):
    """What is found of one record."""

    @property
    def id(self) -> str:
        """Of the record."""


def of_each(
    find: Callable[[Claim, Path], _T], paper: Paper, workers: int, progress: Callable[[_T], None] | None
) -> tuple[_T, ...]:
    """Return what a function finds of each record of a paper, in the order of the records.

    The function must be one of a module: it travels to the workers by its name.
    """
    found: dict[str, _T] = {}
    with closing(_found(find, paper, workers)) as results:
        for result in results:
            found[result.id] = result
            if progress:
                progress(result)
    return tuple(found[claim.id] for claim in paper.claims)


def _found(find: Callable[[Claim, Path], _T], paper: Paper, workers: int) -> Generator[_T, None, None]:
    if workers == 1:
        yield from (find(claim, paper.folder) for claim in paper.claims)
        return
    # Neighbours share oracles, which each worker derives for itself: so they go to one worker. The largest come first.
    groups = [
        (file, claims[start : start + _GROUP])
        for file in record_files(paper.name)
        for claims in [claims_of(paper.name, file)]
        for start in range(0, len(claims), _GROUP)
    ]
    groups.sort(key=lambda group: -sum(map(_size, group[1])))
    tasks = [partial(_found_of_ids, find, paper.name, file, [c.id for c in claims]) for file, claims in groups]
    with closing(in_pool(tasks, workers, 2 * _GROUP * TIME_LIMIT, _MEGABYTES)) as results:
        for _, found in results:
            yield from found


_GROUP = 6
# No worker takes a tenth of this for a paper that ships.
_MEGABYTES = 4096


def _size(claim: Claim) -> int:
    """Return how much there is to change in the formulas of a record: what mutants take goes with its square."""
    formulas = claim.formulas + claim.corrected_formulas
    return sum(sum(1 for _ in preorder_traversal(formula.relation)) ** 2 for formula in formulas)


def _found_of_ids(find: Callable[[Claim, Path], _T], name: str, file: str, identifiers: list[str]) -> list[_T]:
    """Work on some records in a worker, which imports their file: checks are functions and do not travel."""
    folder = paper_folder(name)
    claims = {claim.id: claim for claim in claims_of(name, file)}
    return [find(claims[identifier], folder) for identifier in identifiers]
