"""The ledger: what a paper prints, as records that a machine can decide again.

`loading` finds the records of a paper, `record_checks` refuses those that are not well formed, `verification` decides
them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from pathlib import Path
from typing import Any, TypeAlias

import sympy as sp

from semispline.solver.errors import InputError


class LedgerError(InputError):
    """A paper that cannot be found, or a record that is not well formed."""


class CheckFailedError(LedgerError):
    """A check gave no answer, or an answer that its record does not account for."""


class EndlessError(CheckFailedError):
    """What a check runs was stopped since it did not end: no answer, but one that a change may well cause."""


class Verdict(StrEnum):
    """What is known of a claim."""

    HOLDS = "holds"
    HOLDS_IF = "holds-if"
    FAILS = "fails"
    AMBIGUOUS = "ambiguous"
    DEFINITION = "definition"
    NOT_CHECKABLE = "not-checkable"

    @property
    def text(self) -> str:
        """What it means, and what a record of it has to carry."""
        return _VERDICT_TEXT[self]


_VERDICT_TEXT = {
    Verdict.HOLDS: "true as printed, under the paper's own assumptions",
    Verdict.HOLDS_IF: "true only under a condition that the paper does not state and that its own setting (its orders, "
    "its choice of knots) meets, or, where the condition is one on data that are not printed, may meet; with an exact "
    "instance on each side of the condition",
    Verdict.FAILS: "false as printed, or false in the paper's own setting; with what it leaves, the smallest rational "
    "counterexample, what is right instead and the proof of that, and what the error does, where it can be measured",
    Verdict.AMBIGUOUS: "can be read in more than one way; each reading is decided",
    Verdict.DEFINITION: "says what a name means, and cannot be false",
    Verdict.NOT_CHECKABLE: "data are missing, or nothing in it can be computed; with the reason",
}


class Strength(IntEnum):
    """How strong the evidence is, the strongest first.

    In general: for all that the claim speaks of (orders, degrees, counts, knots, control points), left as symbols. For
    each of a range: the same, but for some whole numbers (orders, degrees), which are tried one after another. At
    random points: as many and of such size that a false formula of its degree would have passed with a probability that
    is stated.
    The last one is no evidence for a claim: what is printed agrees, or something of the kind exists. It is counted
    apart; only where what is printed contradicts itself is anything shown.
    """

    GENERAL = 1
    EACH = 2
    RANDOM = 3
    RATIONAL = 4
    FLOAT = 5
    CONSISTENT = 6

    @property
    def text(self) -> str:
        """In words."""
        return _STRENGTH_TEXT[self]


_STRENGTH_TEXT = {
    Strength.GENERAL: "exact, in general",
    Strength.EACH: "exact, for each of a range",
    Strength.RANDOM: "exact, at random points",
    Strength.RATIONAL: "exact rational instances",
    Strength.FLOAT: "floating point with a stated tolerance",
    Strength.CONSISTENT: "consistent with what is printed",
}


@dataclass(frozen=True, eq=False)
class Formula:
    """A relation with its declared variables.

    Attributes
    ----------
    relation : sympy.Rel
        A relation between points that holds coordinate by coordinate is one between scalar symbols.
    variables : tuple of sympy.Symbol
        Exactly the free symbols of the relation and the assumptions.
    assumptions : tuple of sympy.Rel
        What the paper presupposes of them. Some rational instance must satisfy them all.
    neighbours : tuple of tuples of sympy.Expr
        Chains in which an index or a letter may be mistaken for the next one; the mutation check walks along them.
    equivalent : mapping
        Text of a mutant -> why that mutant says the same as the formula.
    undecidable : mapping
        Text of a mutant -> why nothing printed can tell it from the formula; for printed data, such as a number that
        nothing else of the paper depends on.
    equivalent_if : callable, optional
        Mutant -> why it says the same as the formula, empty where it does not; asked of those that survive.
    """

    relation: Any
    variables: tuple[sp.Symbol, ...]
    assumptions: tuple[Any, ...] = ()
    neighbours: tuple[tuple[Any, ...], ...] = ()
    equivalent: Mapping[str, str] = field(default_factory=dict)
    undecidable: Mapping[str, str] = field(default_factory=dict)
    equivalent_if: Callable[[Any], str] | None = None


@dataclass(frozen=True)
class Case:
    """One instance of a claim, decided.

    Attributes
    ----------
    label : str
        Which instance.
    true : bool or None
        None: no answer, which fails the check.
    own : bool
        Whether the instance belongs to the paper's own setting (what it presupposes, its orders or degrees).
    meets : bool
        Whether the instance meets the condition of a claim that holds under one.
    residual : sympy.Expr or None
        What printed minus true leaves, in a normal form.
    """

    label: str
    true: bool | None
    own: bool = True
    meets: bool = True
    residual: Any = None


@dataclass(frozen=True, eq=False)
class Check:
    """A way to decide a formula, or a question without one.

    Attributes
    ----------
    cases : callable
        Formula or None -> cases, one after another.
    strength : Strength
    method : str
        What is compared with what.
    proof : bool
        Whether the cases prove the claim, or are exact instances of it.
    probe : callable, optional
        Formula -> exact residuals at a few rational instances. Where two formulas differ in it, their residuals
        differ; the mutation check asks it first, since it is fast.
    search : callable, optional
        Formula -> its smallest counterexample, or None where a bounded search finds none. A record that fails needs no
        counterexample of its own where a check has this.
    export : callable, optional
        Formula or None -> the same cases in the same order, as statements that a second system can repeat.
    believed : str
        What no system is asked: a sentence of induction, a theorem.
    """

    cases: Callable[[Formula | None], Iterable[Case]]
    strength: Strength
    method: str
    proof: bool = False
    probe: Callable[[Formula], Any] | None = None
    search: Callable[[Formula], Counterexample | None] | None = None
    export: Callable[[Formula | None], Iterable[Any]] | None = None
    believed: str = ""


@dataclass(frozen=True)
class Part:
    """One formula (or question) and the check that decides it."""

    check: Check
    formula: Formula | None = None


@dataclass(frozen=True)
class Reading:
    """One way to read a claim: all its parts must hold.

    Attributes
    ----------
    parts : tuple of Part
    label : str
        How this reading differs from the others.
    condition : str
        Under which unstated condition it holds, if it does not always.
    """

    parts: tuple[Part, ...]
    label: str = ""
    condition: str = ""


@dataclass(frozen=True)
class Correction:
    """What is true instead: its parts are decided like a reading, and must hold."""

    statement: str
    parts: tuple[Part, ...]


@dataclass(frozen=True)
class Counterexample:
    """The smallest rational instance at which a claim is false.

    Attributes
    ----------
    values : tuple of (str, str)
        Names and exact values.
    printed, true : str
        What the claim gives there, and what is true.
    own : str
        The smallest instance within the paper's own setting, where that is another one.
    also : str
        One more instance.
    """

    values: tuple[tuple[str, str], ...]
    printed: str
    true: str
    own: str = ""
    also: str = ""

    def __str__(self) -> str:
        where = ", ".join(f"{name} = {value}" for name, value in self.values)
        # A reader knows the paper's own setting best.
        own = f"in the paper's own setting {self.own}; the smallest of all: " if self.own else ""
        more = f"; {self.also}" if self.also else ""
        return f"{own}{where}: printed {self.printed}, true {self.true}{more}"


@dataclass(frozen=True)
class Consequence:
    """What an error does, measured: what is measured, and on what, is the paper's affair.

    Attributes
    ----------
    text : str
        On what, and how it was measured.
    measured : mapping
        Name (with unit) -> number. A whole number is a count.
    corrected : mapping
        The same with the corrected formula, where that was measured too.
    rounding : float
        A smaller number is nothing but rounding.
    judges : mapping
        Name of a judge -> what it says.
    """

    text: str
    measured: Mapping[str, float]
    corrected: Mapping[str, float] = field(default_factory=dict)
    rounding: float = 0.0
    judges: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Cause:
    """Why records fail or need a condition: one fault of a paper, however many of its sentences it reaches.

    Attributes
    ----------
    key : str
        How records name it.
    title : str
        In a few words.
    text : str
        What is wrong, and what is right.
    misprint : bool
        One sign, index or digit that a printer or a scan may have lost; otherwise mathematics.
    """

    key: str
    title: str
    text: str
    misprint: bool = False


@dataclass(frozen=True)
class Print:
    """What is printed of a claim as LaTeX or as lines of code, and what was read of it: its formulas are made of that.

    Attributes
    ----------
    text : str
        As printed.
    echo : str
        What was read of LaTeX, with every product and bracket; empty where nothing was.
    by_hand : str
        Why and where it was not read: then the formulas are transcribed by hand. Or which words of code were replaced.
    """

    text: str
    echo: str = ""
    by_hand: str = ""


@dataclass(frozen=True)
class Claim:
    """One record.

    Attributes
    ----------
    id : str
        As the paper numbers it: eq-2.3, thm-1, lemma-2, alg-1, eq-A.1, table-2; else one of your own.
    where : str
        Where in the paper.
    statement : str
        What is claimed, in our own words.
    verdict : Verdict or None
        As recorded; every run decides anew and compares. None: a draft, which runs but is not decided.
    readings : tuple of Reading
        One, or more where the text can be read in more than one way; none for a definition and where it is not
        checkable.
    correction : Correction, optional
    counterexample : callable, optional
        Search, run with the check; where there is none the searches of the checks are run.
    consequence : callable, optional
        Measurement of what an error does, where it does something that can be measured.
    reason : str
        Why it is not checkable, or what a definition gives a name to.
    remark : str
        Special cases, possible misreads of the scan.
    cause : str
        Key of the cause of what is wrong in it, where something is.
    printed : Print, optional
        What a report shows beside the formulas; where there is none, lines of code in them.
    """

    id: str
    where: str
    statement: str
    verdict: Verdict | None
    readings: tuple[Reading, ...] = ()
    correction: Correction | None = None
    counterexample: Callable[[], Counterexample | None] | None = None
    consequence: Callable[[], Consequence] | None = None
    reason: str = ""
    remark: str = ""
    cause: str = ""
    printed: Print | None = None

    @property
    def formulas(self) -> tuple[Formula, ...]:
        """All printed formulas of the record."""
        return tuple(part.formula for part in self.parts if part.formula is not None)

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts of all readings."""
        return tuple(part for reading in self.readings for part in reading.parts)

    @property
    def correction_parts(self) -> tuple[Part, ...]:
        """The parts of the correction; none where there is no correction."""
        return self.correction.parts if self.correction else ()

    @property
    def corrected_formulas(self) -> tuple[Formula, ...]:
        """All corrected formulas of the record."""
        return tuple(part.formula for part in self.correction_parts if part.formula is not None)


@dataclass(frozen=True)
class Places:
    """Where the arguments of a function stand: as indices below and above, and between brackets; texts as they are."""

    lower: tuple[Any, ...] = ()
    upper: tuple[Any, ...] = ()
    arguments: tuple[Any, ...] = ()


# Name of a function -> where its arguments stand; None for the usual brackets.
Notation: TypeAlias = Mapping[str, Callable[[tuple[Any, ...]], Places | None]]


@dataclass(frozen=True)
class Paper:
    """A loaded paper.

    Attributes
    ----------
    name : str
        Or path.
    title, legend : str
        First paragraph of its docstring, and the rest.
    claims : tuple of Claim
    causes : tuple of Cause
        In the order in which a report tells them; none where the paper's records name none.
    folder : Path
        Where its files are.
    notation : mapping
        Name of a function -> where its arguments stand in print.
    """

    name: str
    title: str
    legend: str
    claims: tuple[Claim, ...]
    causes: tuple[Cause, ...] = ()
    folder: Path = Path()
    notation: Notation = field(default_factory=dict)

    def claim(self, identifier: str) -> Claim:
        """Return the record with this id."""
        for claim in self.claims:
            if claim.id == identifier:
                return claim
        raise LedgerError(f"claim: found {identifier!r}, expected one of {', '.join(c.id for c in self.claims)}")


def natural_key(identifier: str) -> tuple[tuple[int, str], ...]:
    """Return what ids, and names of files, sort by: numbers by their size, letters whether small or large.

    Examples
    --------
    >>> sorted(["eq-2.10", "eq-A.1", "eq-2.9", "lemma-1"], key=natural_key)
    ['eq-2.9', 'eq-2.10', 'eq-A.1', 'lemma-1']
    """
    parts = re.findall(r"\d+|\D+", identifier.casefold())
    return tuple((int(part), "") if part.isdecimal() else (-1, part) for part in parts)


def decided_cases(check: Check, formula: Formula | None) -> Iterator[Case]:
    """Yield the cases of a check, and refuse an answer that contradicts itself.

    Raises
    ------
    CheckFailedError
        A case is neither true nor false, is true and leaves a residual, or is false and leaves none.
    """
    for case in check.cases(formula):
        if not isinstance(case.true, bool):
            raise CheckFailedError(f"no answer for {case.label}: found {case.true!r}, expected True or False")
        if case.residual is not None and case.true != bool(case.residual == 0):
            raise CheckFailedError(
                f"{case.label}: found {case.true} with residual {case.residual}, expected True with 0 or none, False "
                "with one that is not 0"
            )
        yield case
