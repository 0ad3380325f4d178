"""The ledger: what a paper prints, as records that a machine can decide again.

`loading` finds the records of a paper, `record_checks` refuses those that are not well formed, `verification` decides
them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from typing import Any

import sympy as sp

from semispline.solver.errors import InputError


class LedgerError(InputError):
    """A paper that cannot be found, or a record that is not well formed."""


class CheckFailedError(LedgerError):
    """A check gave no answer, or an answer that its record does not account for."""


class Verdict(StrEnum):
    """What is known of a claim; see the table in the README of the project's design."""

    HOLDS = "holds"
    HOLDS_IF = "holds-if"
    FAILS = "fails"
    AMBIGUOUS = "ambiguous"
    DEFINITION = "definition"
    NOT_CHECKABLE = "not-checkable"


class Strength(IntEnum):
    """How strong the evidence is, the strongest first.

    In general: for all that the claim speaks of (orders, degrees, counts, knots, control points), left as symbols.
    The last one is no evidence for a claim: what is printed agrees, or something of the kind exists. It is counted
    apart; only where what is printed contradicts itself is anything shown.
    """

    SYMBOLIC_ORDER = 1
    EACH_ORDER = 2
    RATIONAL = 3
    FLOAT = 4
    CONSISTENT = 5

    @property
    def text(self) -> str:
        """In words."""
        return _STRENGTH_TEXT[self]


_STRENGTH_TEXT = {
    Strength.SYMBOLIC_ORDER: "exact, in general",
    Strength.EACH_ORDER: "exact, for each order from 2 to 8",
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
        Control points are scalar symbols: every relation of the paper holds coordinate by coordinate.
    variables : tuple of sympy.Symbol
        Exactly the free symbols of the relation and the assumptions.
    assumptions : tuple of sympy.Rel
        What the paper presupposes of them. Some rational instance must satisfy them all.
    neighbours : tuple of tuples of sympy.Expr
        Chains in which an index or a knot may be mistaken for the next one; the mutation check walks along them.
    equivalent : mapping
        Text of a mutant -> why that mutant says the same as the formula.
    undecidable : mapping
        Text of a mutant -> why nothing printed can tell it from the formula; for printed data, such as a knot that no
        other number of the paper depends on.
    """

    relation: Any
    variables: tuple[sp.Symbol, ...]
    assumptions: tuple[Any, ...] = ()
    neighbours: tuple[tuple[Any, ...], ...] = ()
    equivalent: Mapping[str, str] = field(default_factory=dict)
    undecidable: Mapping[str, str] = field(default_factory=dict)


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
        Whether the instance belongs to the paper's own setting (its orders, its choice of knots).
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
    """

    cases: Callable[[Formula | None], Iterable[Case]]
    strength: Strength
    method: str
    proof: bool = False
    probe: Callable[[Formula], Any] | None = None


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
        also = f"; in the paper's own setting {self.own}" if self.own else ""
        more = f"; {self.also}" if self.also else ""
        return f"{where}: printed {self.printed}, true {self.true}{also}{more}"


@dataclass(frozen=True)
class Consequence:
    """What an error does to a surface, measured.

    Attributes
    ----------
    text : str
        On what, and how it was measured.
    measured : mapping
        Name (with unit) -> number.
    judges : mapping
        Name of a judge -> what it says.
    """

    text: str
    measured: Mapping[str, float]
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
    """What is printed of a claim as LaTeX, and what was read of it: its formulas are made of that.

    Attributes
    ----------
    latex : str
        As printed.
    echo : str
        What was read, as LaTeX with every product and bracket; empty where nothing was.
    by_hand : str
        Why and where it was not read: then the formulas are transcribed by hand.
    """

    latex: str
    echo: str = ""
    by_hand: str = ""


@dataclass(frozen=True)
class Claim:
    """One record.

    Attributes
    ----------
    id : str
        The paper's own number, else `sec-N.slug`.
    where : str
        Where in the paper.
    statement : str
        What is claimed, in our own words.
    verdict : Verdict
        As recorded; every run decides anew and compares.
    readings : tuple of Reading
        One, or more where the text can be read in more than one way; none for a definition and where it is not
        checkable.
    correction : Correction, optional
    counterexample, consequence : callables, optional
        Search and measurement, run with the check.
    reason : str
        Why it is not checkable, or what a definition gives a name to.
    remark : str
        Special cases, possible misreads of the scan.
    cause : str
        Key of the cause of what is wrong in it, where something is.
    printed : Print, optional
        What a report shows beside the formulas.
    """

    id: str
    where: str
    statement: str
    verdict: Verdict
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
    """

    name: str
    title: str
    legend: str
    claims: tuple[Claim, ...]
    causes: tuple[Cause, ...] = ()

    def claim(self, identifier: str) -> Claim:
        """Return the record with this id."""
        for claim in self.claims:
            if claim.id == identifier:
                return claim
        raise LedgerError(f"claim: found {identifier!r}, expected one of {', '.join(c.id for c in self.claims)}")


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
