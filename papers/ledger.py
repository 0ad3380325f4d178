"""The ledger: what a paper prints, as records that a machine can decide again.

A paper is a folder. Every module `claims*.py` in it has a tuple `CLAIMS`; `printed.py` is the only module in which a
printed formula can run. Records are checked when they are loaded; `papers.verification` decides them.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from pathlib import Path
from types import ModuleType
from typing import Any

import sympy as sp

from papers.search import smallest_assignment
from solver.errors import InputError


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
    NOT_CHECKABLE = "not-checkable"


class Strength(IntEnum):
    """How strong the evidence is, the strongest first."""

    SYMBOLIC_ORDER = 1
    EACH_ORDER = 2
    RATIONAL = 3
    FLOAT = 4

    @property
    def text(self) -> str:
        """In words."""
        return _STRENGTH_TEXT[self]


_STRENGTH_TEXT = {
    Strength.SYMBOLIC_ORDER: "exact identity, symbolic order and knots",
    Strength.EACH_ORDER: "exact identity over symbolic knots, order by order",
    Strength.RATIONAL: "exact rational instances",
    Strength.FLOAT: "floating point with a stated tolerance",
}


@dataclass(frozen=True)
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
    """

    relation: Any
    variables: tuple[sp.Symbol, ...]
    assumptions: tuple[Any, ...] = ()
    neighbours: tuple[tuple[Any, ...], ...] = ()
    equivalent: Mapping[str, str] = field(default_factory=dict)


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


@dataclass(frozen=True)
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
        One, or more where the text can be read in more than one way; none where it is not checkable.
    correction : Correction, optional
    counterexample, consequence : callables, optional
        Search and measurement, run with the check.
    reason : str
        Why it is not checkable.
    remark : str
        Special cases, possible misreads of the scan.
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

    @property
    def formulas(self) -> tuple[Formula, ...]:
        """All printed formulas of the record."""
        return tuple(part.formula for part in self.parts if part.formula is not None)

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts of all readings."""
        return tuple(part for reading in self.readings for part in reading.parts)


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
    """

    name: str
    title: str
    legend: str
    claims: tuple[Claim, ...]

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


def paper_names() -> list[str]:
    """Return the papers that ship with the package: folders with a `printed.py`."""
    return sorted(path.parent.name for path in Path(__file__).parent.glob("*/printed.py"))


def load_paper(name: str) -> Paper:
    """Load a paper by its folder name under `papers/`, or by the path of a folder, and check every record.

    Raises
    ------
    LedgerError
        There is no such paper, a module has no CLAIMS, an id occurs twice, or a record is not well formed.
    """
    package = _package(name)
    folder = Path(str(package.__file__)).parent
    claims: list[Claim] = []
    for path in sorted(folder.glob("claims*.py")):
        module = importlib.import_module(f"{package.__name__}.{path.stem}")
        found = getattr(module, "CLAIMS", None)
        if not isinstance(found, tuple) or not all(isinstance(c, Claim) for c in found):
            raise LedgerError(f"{path.name}: CLAIMS is {type(found).__name__}, expected a tuple of Claim")
        claims += found
    if not claims:
        raise LedgerError(f"{folder}: no claims*.py with records, expected at least one")
    for i, claim in enumerate(claims):
        if claim.id in {c.id for c in claims[:i]}:
            raise LedgerError(f"claim {claim.id}: the id occurs twice, expected once")
        check_record(claim)
    title, _, legend = inspect.cleandoc(package.__doc__ or folder.name).partition("\n\n")
    return Paper(name, title.rstrip("."), legend, tuple(claims))


def _package(name: str) -> ModuleType:
    if name in paper_names():
        return importlib.import_module(f"papers.{name}")
    folder = Path(name)
    if not (folder / "printed.py").is_file():
        known = ", ".join(paper_names())
        raise LedgerError(f"paper: found {name!r}, expected one of {known}, or a folder with printed.py and claims*.py")
    folder = folder.resolve()
    alias = f"_semispline_paper_{folder.name}_{abs(hash(str(folder)))}"
    if alias not in sys.modules:
        # A folder is a package even without __init__.py, so that its modules can import `printed` from it.
        init = folder / "__init__.py"
        loader_path = init if init.is_file() else folder / "printed.py"
        spec = importlib.util.spec_from_file_location(alias, loader_path, submodule_search_locations=[str(folder)])
        if spec is None or spec.loader is None:
            raise LedgerError(f"paper: {folder} cannot be imported, expected Python modules")
        module = importlib.util.module_from_spec(spec)
        sys.modules[alias] = module
        spec.loader.exec_module(module)
    return sys.modules[alias]


def check_record(claim: Claim) -> None:
    """Refuse a record that is not well formed.

    Raises
    ------
    LedgerError
        Naming the record, what was found, and what would be right.
    """
    for problem in _problems(claim):
        raise LedgerError(f"claim {claim.id}: {problem}")


def _problems(claim: Claim) -> Iterator[str]:
    if claim.verdict not in list(Verdict):
        yield f"verdict {claim.verdict!r}, expected one of {', '.join(Verdict)}"
    if not claim.statement.strip() or not claim.where.strip():
        yield "statement or place is empty, expected both"
    for formula in claim.formulas + tuple(p.formula for p in _correction_parts(claim) if p.formula is not None):
        yield from _formula_problems(formula)
    for part in claim.parts + _correction_parts(claim):
        if not part.check.method.strip():
            yield "a check without a method, expected what is compared with what"
    yield from _missing_evidence(claim)


def _correction_parts(claim: Claim) -> tuple[Part, ...]:
    return claim.correction.parts if claim.correction else ()


def _formula_problems(formula: Formula) -> Iterator[str]:
    relation = formula.relation
    if not isinstance(relation, sp.core.relational.Relational):
        yield f"formula is {relation!r} ({type(relation).__name__}), expected a relation such as Eq"
        return
    used = {s for part in (relation, *formula.assumptions) for s in part.free_symbols if isinstance(s, sp.Symbol)}
    declared = set(formula.variables)
    if used != declared:
        undeclared, unused = sorted(map(str, used - declared)), sorted(map(str, declared - used))
        yield f"free symbols do not match the declared variables: undeclared {undeclared}, unused {unused}"
    elif formula.assumptions and assumption_instance(formula) is None:
        yield f"no instance found that satisfies the assumptions {formula.assumptions}, expected at least one"


def assumption_instance(formula: Formula) -> dict[sp.Symbol, sp.Rational] | None:
    """Return the smallest rational instance of the assumptions, or None where a bounded search finds none."""
    symbols = sorted({s for a in formula.assumptions for s in a.free_symbols}, key=str)
    tests = [(sorted(a.free_symbols, key=str), a) for a in formula.assumptions]
    compiled = [(used, sp.lambdify(used, a, "math")) for used, a in tests]
    return smallest_assignment(symbols, lambda at: all(test(*(at[s] for s in used)) for used, test in compiled))


def _missing_evidence(claim: Claim) -> Iterator[str]:
    verdict = claim.verdict
    if verdict is Verdict.NOT_CHECKABLE:
        if not claim.reason.strip():
            yield "not-checkable without a reason"
        if claim.readings:
            yield "not-checkable with readings, expected none"
        return
    if claim.reason:
        yield f"{verdict} with a reason for not being checkable"
    if not claim.readings or any(not reading.parts for reading in claim.readings):
        yield f"{verdict} without a check"
    if verdict is Verdict.AMBIGUOUS and len(claim.readings) < 2:
        yield f"ambiguous with {len(claim.readings)} reading, expected at least 2"
    if len(claim.readings) > 1 and not all(reading.label for reading in claim.readings):
        yield "several readings, one without a label"
    if verdict is Verdict.HOLDS_IF and not all(reading.condition for reading in claim.readings):
        yield "holds-if without its condition"
    if verdict is Verdict.FAILS:
        missing = [name for name in ("correction", "counterexample", "consequence") if getattr(claim, name) is None]
        if missing:
            yield f"fails without {', '.join(missing)}"
        if claim.correction and not claim.correction.parts:
            yield "fails with a correction that has no proof"
        if claim.correction and not claim.correction.statement.strip():
            yield "fails with a correction that says nothing, expected what is true instead"
