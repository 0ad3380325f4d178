"""What a verdict rests on, as plain text that another system can read: statements, and how they stand in a file.

Expressions are texts of names, whole numbers, + - * / ^ and brackets, as they stand before any simplification. Names
in `where` stand for their expression in all that follows. No SymPy here: the process that rechecks imports this.
Only in a `Number` or a `Coefficient` there are functions, and only in `Matrices` names of matrices.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, ClassVar

Matrix = tuple[tuple[str, ...], ...]


@dataclass(frozen=True, kw_only=True)
class Statement:
    """One case of a reading.

    Attributes
    ----------
    label : str
        Which one.
    own, meets : bool
        As in the ledger: whether it belongs to the paper's own setting, and meets the condition of the reading.
    variables : tuple of str
    where : tuple of (str, str)
        Names and what they stand for, one after another.
    nonzero : tuple of str
        What must not vanish: factors of all denominators.
    at : tuple of (str, str)
        A rational instance, at which `fractions` decides too.
    """

    label: str
    own: bool = True
    meets: bool = True
    variables: tuple[str, ...] = ()
    where: tuple[tuple[str, str], ...] = ()
    nonzero: tuple[str, ...] = ()
    at: tuple[tuple[str, str], ...] = ()
    form: ClassVar[str] = ""

    @property
    def true(self) -> bool:
        """What the case is, if all that is stated is right."""
        return True

    @property
    def texts(self) -> tuple[str, ...]:
        """All expressions, those of `where` apart."""
        return ()


@dataclass(frozen=True, kw_only=True)
class Identity(Statement):
    """Both sides are equal wherever `nonzero` holds, or differ at the instance `at`.

    Attributes
    ----------
    left, right : str
    equal : bool
    wanted : bool
        Whether the case is true if the sides are equal (else if they differ).
    conditions : tuple of str
        What the instance satisfies besides, such as "u_1 > 0".
    roots : tuple of (str, str, int)
        Variables of which a power is known: name, what its power is (of names before), and which power.
    meaning : tuple of (str, str)
        Variables that stand for something else, and for what: to be believed.
    """

    left: str
    right: str
    equal: bool = True
    wanted: bool = True
    conditions: tuple[str, ...] = ()
    roots: tuple[tuple[str, str, int], ...] = ()
    meaning: tuple[tuple[str, str], ...] = ()
    form: ClassVar[str] = "identity"

    @property
    def true(self) -> bool:
        """Whether the sides are as wanted."""
        return self.equal == self.wanted

    @property
    def texts(self) -> tuple[str, ...]:
        """Both sides."""
        return (self.left, self.right)


@dataclass(frozen=True, kw_only=True)
class Term:
    """A positive number times powers of names times squares of expressions."""

    coefficient: str
    powers: tuple[tuple[str, int], ...] = ()
    squares: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Positive(Statement):
    """`left` is positive, or not negative, since it is one sum of positive terms over another one.

    Attributes
    ----------
    left : str
    over, under : tuple of Term
        Each is the sum of its terms: left * under = over.
    positive, nonnegative : tuple of str
        Names that are.
    strict : bool
        Some term of `over` has no square and powers of positive names alone.
    affirmed : bool
        Whether the case is true by this.
    """

    left: str
    over: tuple[Term, ...]
    under: tuple[Term, ...]
    positive: tuple[str, ...] = ()
    nonnegative: tuple[str, ...] = ()
    strict: bool = True
    affirmed: bool = True
    form: ClassVar[str] = "positive"

    @property
    def true(self) -> bool:
        """Whether the sign affirms the case."""
        return self.affirmed

    @property
    def texts(self) -> tuple[str, ...]:
        """The expression and all that is squared."""
        return (self.left, *(square for term in (*self.over, *self.under) for square in term.squares))


@dataclass(frozen=True, kw_only=True)
class Rank(Statement):
    """A matrix has this rank: a minor of that size is not zero at `at`, and a kernel has the dimension that is left.

    Attributes
    ----------
    matrix : rows of str
    rank : int
    rows, columns : tuple of int
        Of the minor, from 0.
    kernel : rows of str
        Column vectors, with an identity matrix in the columns `free`.
    free : tuple of int
    affirmed : bool
        Whether the case is true by this.
    """

    matrix: Matrix
    rank: int
    rows: tuple[int, ...] = ()
    columns: tuple[int, ...] = ()
    kernel: Matrix = ()
    free: tuple[int, ...] = ()
    affirmed: bool = True
    form: ClassVar[str] = "rank"

    @property
    def true(self) -> bool:
        """Whether the rank affirms the case."""
        return self.affirmed

    @property
    def texts(self) -> tuple[str, ...]:
        """All entries."""
        return tuple(entry for row in (*self.matrix, *self.kernel) for entry in row)


@dataclass(frozen=True, kw_only=True)
class Contained(Statement):
    """The columns of one matrix of numbers are combinations of those of another one, or are not.

    Attributes
    ----------
    outer, inner : rows of str
    solution : rows of str
        outer * solution = inner; empty where they are not.
    separator : tuple of str
        A row y with y * outer = 0 and y * inner other than 0; empty where they are.
    wanted : bool
        Whether the case is true if they are.
    """

    outer: Matrix
    inner: Matrix
    solution: Matrix = ()
    separator: tuple[str, ...] = ()
    wanted: bool = True
    form: ClassVar[str] = "contained"

    @property
    def true(self) -> bool:
        """Whether they are as wanted."""
        return bool(self.solution) == self.wanted


@dataclass(frozen=True, kw_only=True)
class Minimum(Statement):
    """A symmetric matrix of numbers is positive definite: it is L D L^T, L with ones on its diagonal, D positive."""

    matrix: Matrix
    lower: Matrix
    pivots: tuple[str, ...]
    form: ClassVar[str] = "minimum"


@dataclass(frozen=True, kw_only=True)
class Knots(Statement):
    """What printed numbers are.

    Attributes
    ----------
    numbers : tuple of str
    order : int
    fact : str
        "points N" (as many control points), "increasing", "clamped", "single" (inner knots), "equal" (to `other`).
    other : tuple of str
    holds : bool
    """

    numbers: tuple[str, ...]
    fact: str
    order: int = 1
    other: tuple[str, ...] = ()
    holds: bool = True
    form: ClassVar[str] = "knots"

    @property
    def true(self) -> bool:
        """Whether the fact holds."""
        return self.holds


@dataclass(frozen=True, kw_only=True)
class Matrices(Statement):
    """Both sides are equal as matrices wherever `nonzero` holds, or differ at the instance `at`.

    Attributes
    ----------
    matrices : tuple of (str, rows of str)
        Names that stand for matrices in both sides, and their entries.
    left, right : str
    equal : bool
    wanted : bool
        Whether the case is true if the sides are equal (else if they differ).
    """

    matrices: tuple[tuple[str, Matrix], ...]
    left: str
    right: str
    equal: bool = True
    wanted: bool = True
    form: ClassVar[str] = "matrices"

    @property
    def true(self) -> bool:
        """Whether the sides are as wanted."""
        return self.equal == self.wanted

    @property
    def texts(self) -> tuple[str, ...]:
        """All entries."""
        return tuple(entry for _, rows in self.matrices for row in rows for entry in row)


@dataclass(frozen=True, kw_only=True)
class Number(Statement):
    """A number is between two fractions, or outside of them.

    Attributes
    ----------
    left : str
        The number: an expression with the functions of `arithmetic.FUNCTIONS`.
    low, high : str
        Fractions.
    inside : bool
        Whether it is between them, the ends included; else it is outside.
    wanted : bool
        Whether the case is true if it is inside.
    """

    left: str
    low: str
    high: str
    inside: bool = True
    wanted: bool = True
    form: ClassVar[str] = "number"

    @property
    def true(self) -> bool:
        """Whether it is where it is wanted."""
        return self.inside == self.wanted


@dataclass(frozen=True, kw_only=True)
class Coefficient(Statement):
    """A power of a variable has the same factor in the power series of both sides, or another one.

    Attributes
    ----------
    left, right : str
        Expressions with the functions of `arithmetic.FUNCTIONS`, which have power series at 0.
    variable : str
    power : int
    equal : bool
    wanted : bool
        Whether the case is true if the factors are equal (else if they differ).
    """

    left: str
    right: str
    variable: str
    power: int
    equal: bool = True
    wanted: bool = True
    form: ClassVar[str] = "coefficient"

    @property
    def true(self) -> bool:
        """Whether the factors are as wanted."""
        return self.equal == self.wanted


_KINDS = (Identity, Positive, Rank, Contained, Minimum, Knots, Matrices, Number, Coefficient)
FORMS: dict[str, type[Statement]] = {kind.form: kind for kind in _KINDS}


@dataclass(frozen=True)
class Reading:
    """The cases of one reading, or of the correction."""

    cases: tuple[Statement, ...]
    label: str = ""
    condition: str = ""


@dataclass(frozen=True)
class Certificate:
    """What a record rests on.

    Attributes
    ----------
    id, verdict : str
        As recorded.
    readings : tuple of Reading
    correction : Reading or None
    believed : tuple of str
        What no system was asked: sentences of induction, theorems of analysis.
    left_out : str
        What of the verdict is not in here; empty where all is.
    """

    id: str
    verdict: str
    readings: tuple[Reading, ...]
    correction: Reading | None = None
    believed: tuple[str, ...] = ()
    left_out: str = ""

    @property
    def statements(self) -> tuple[Statement, ...]:
        """All cases."""
        readings = (*self.readings, self.correction) if self.correction else self.readings
        return tuple(case for reading in readings for case in reading.cases)


@dataclass(frozen=True)
class Theory:
    """A theorem that is generated as a whole, with the lemmas that it needs.

    Attributes
    ----------
    name, title : str
        Of the theorem, and what it is about.
    needed : tuple of str
        Modules of `derivations/coq` that it imports.
    text : str
        In the language of Coq.
    over_reals : bool
        Whether it rests on the axioms of the real numbers.
    """

    name: str
    title: str
    needed: tuple[str, ...]
    text: str
    over_reals: bool = True


@dataclass(frozen=True)
class Export:
    """Everything of one paper.

    Attributes
    ----------
    paper : str
    certificates : tuple of Certificate
    controls : tuple of Statement
        Changed formulas, one of each kind of change at the least, which must be refused.
    not_expressible : mapping
        Decided record -> why nothing of it is here.
    theorems : mapping
        What is believed, or a record -> theorems of the sources in `derivations/coq` that say so.
    theories : tuple of Theory
    """

    paper: str
    certificates: tuple[Certificate, ...]
    controls: tuple[Statement, ...] = ()
    not_expressible: Mapping[str, str] = field(default_factory=dict)
    theorems: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    theories: tuple[Theory, ...] = ()


def as_record(statement: Statement) -> dict[str, Any]:
    """Return a statement as it stands in a file."""
    return {"form": statement.form, **{key: value for key, value in asdict(statement).items() if value != ()}}


def from_record(record: Mapping[str, Any]) -> Statement:
    """Return a statement from a file."""
    values = {key: _frozen(value) for key, value in record.items() if key != "form"}
    for key in ("over", "under"):
        if key in values:
            values[key] = tuple(Term(**{k: _frozen(v) for k, v in term.items()}) for term in record[key])
    return FORMS[record["form"]](**values)


def certificate_record(certificate: Certificate) -> dict[str, Any]:
    """Return a certificate as it stands in a file."""

    def reading(one: Reading) -> dict[str, Any]:
        return {"label": one.label, "condition": one.condition, "cases": [as_record(case) for case in one.cases]}

    return {
        "format": "semispline/1",
        "kind": "certificate",
        "id": certificate.id,
        "verdict": certificate.verdict,
        "believed": list(certificate.believed),
        "left_out": certificate.left_out,
        "readings": [reading(one) for one in certificate.readings],
        "correction": reading(certificate.correction) if certificate.correction else None,
    }


def certificate_from(record: Mapping[str, Any]) -> Certificate:
    """Return a certificate from a file."""

    def reading(one: Mapping[str, Any]) -> Reading:
        return Reading(tuple(map(from_record, one["cases"])), one["label"], one["condition"])

    return Certificate(
        record["id"],
        record["verdict"],
        tuple(map(reading, record["readings"])),
        reading(record["correction"]) if record["correction"] else None,
        tuple(record["believed"]),
        record["left_out"],
    )


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list | tuple) else value
