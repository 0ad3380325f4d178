"""What a formula says: trees that keep what is printed, and neither commute, cancel nor calculate.

Brackets that print and change nothing are gone, those that group are nodes of their own: `a + (b + c)` is a sum in a
sum.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any, TypeAlias


@dataclass(frozen=True, slots=True)
class Number:
    """A numeral, with its digits as printed."""

    text: str


@dataclass(frozen=True, slots=True)
class Named:
    """A declared name.

    Attributes
    ----------
    name : str
        Its pattern, as the table has it.
    slots : tuple of Tree
        What stands for its indices, those above after those below.
    arguments : tuple of Tree or None
        None where the name has none, or is a function without its bracket.
    derivative : int
        How often it is differentiated by its only argument that is not an integer: primes.
    """

    name: str
    slots: tuple[Tree, ...] = ()
    arguments: tuple[Tree, ...] | None = None
    derivative: int = 0


@dataclass(frozen=True, slots=True)
class Sum:
    r"""Terms with their signs: +, -, \pm, \mp."""

    terms: tuple[tuple[str, Tree], ...]


@dataclass(frozen=True, slots=True)
class Product:
    """Factors in their order: matrices do not commute."""

    factors: tuple[Tree, ...]


@dataclass(frozen=True, slots=True)
class Quotient:
    """One over another."""

    numerator: Tree
    denominator: Tree


@dataclass(frozen=True, slots=True)
class Power:
    """A power; with the exponent -1 of a matrix its inverse."""

    base: Tree
    exponent: Tree


@dataclass(frozen=True, slots=True)
class Transpose:
    """A matrix, transposed."""

    matrix: Tree


@dataclass(frozen=True, slots=True)
class Factorial:
    """n!."""

    argument: Tree


@dataclass(frozen=True, slots=True)
class Binomial:
    """n over k."""

    above: Tree
    below: Tree


@dataclass(frozen=True, slots=True)
class Call:
    """A function that all know: sin, sqrt of no degree, abs (bars), norm (double bars)."""

    function: str
    argument: Tree


@dataclass(frozen=True, slots=True)
class Root:
    """A root of a degree."""

    degree: Tree
    radicand: Tree


@dataclass(frozen=True, slots=True)
class Matrix:
    """Rows of entries."""

    rows: tuple[tuple[Tree, ...], ...]


@dataclass(frozen=True, slots=True)
class Listing:
    """Things in a row, in round brackets (a point by its components) or in braces (a list)."""

    brackets: str
    entries: tuple[Tree, ...]


@dataclass(frozen=True, slots=True)
class Components:
    """A column whose entries are named: x = .. above y = .. ."""

    entries: tuple[tuple[Tree, Tree], ...]


@dataclass(frozen=True, slots=True)
class Labelled:
    """Something with a word below its bracket that says in which sense it is meant."""

    content: Tree
    label: str


@dataclass(frozen=True, slots=True)
class Elided:
    """Terms of a sum, or entries of a row, written with dots: from the first to the last, one step at a time.

    Attributes
    ----------
    first, last : Tree
        They differ in one integer expression only.
    start, end : Tree
        That expression in the first, and in the last.
    printed : tuple of Tree
        What stands before the dots, the first one among them.
    """

    first: Tree
    last: Tree
    start: Tree
    end: Tree
    printed: tuple[Tree, ...]


@dataclass(frozen=True, slots=True)
class BigSum:
    """A sum over an index, both ends included."""

    index: Named
    lower: Tree
    upper: Tree
    body: Tree


@dataclass(frozen=True, slots=True)
class Integral:
    """A definite integral."""

    variable: Named
    lower: Tree
    upper: Tree
    body: Tree


@dataclass(frozen=True, slots=True)
class Derived:
    """A derivative written with d or ∂."""

    body: Tree
    variable: Tree
    order: Tree


@dataclass(frozen=True, slots=True)
class Interval:
    """An interval, with its brackets."""

    brackets: str
    lower: Tree
    upper: Tree


@dataclass(frozen=True, slots=True)
class Cases:
    """Values with their conditions; None is otherwise."""

    cases: tuple[tuple[Tree, Statement | None], ...]


@dataclass(frozen=True, slots=True)
class Condition:
    """What is said of a statement.

    Attributes
    ----------
    word : str
        where: it gives a name, from there on to the end of the display; when: it limits this statement alone.
    since : int
        The side of the statement with which the line begins that the condition stands in.
    statement : Statement
    """

    word: str
    since: int
    statement: Statement


@dataclass(frozen=True, slots=True)
class Statement:
    """A chain of sides with relations between them, or one side alone.

    Attributes
    ----------
    sides : tuple of Tree
    relations : tuple of str
        One between two sides, and one before the first where the chain continues the display before.
    continues : bool
        Whether its first side is the last one of the display before.
    after : str
        The arrow that leads to it.
    conditions : tuple of Condition
    """

    sides: tuple[Tree, ...]
    relations: tuple[str, ...] = ()
    continues: bool = False
    after: str = ""
    conditions: tuple[Condition, ...] = ()


Tree: TypeAlias = (
    Number
    | Named
    | Sum
    | Product
    | Quotient
    | Power
    | Transpose
    | Factorial
    | Binomial
    | Call
    | Root
    | Matrix
    | Listing
    | Components
    | Labelled
    | Elided
    | BigSum
    | Integral
    | Derived
    | Interval
    | Cases
)


def parts(node: Any) -> Iterator[Any]:
    """Yield the nodes right below a tree, a statement or a condition.

    Examples
    --------
    >>> list(parts(Quotient(Number("1"), Number("2"))))
    [Number(text='1'), Number(text='2')]
    """
    for name in _field_names(node.__class__):
        yield from _nodes(getattr(node, name))


def walk(node: Any) -> Iterator[Any]:
    """Yield a tree and all that is in it."""
    yield node
    for part in parts(node):
        yield from walk(part)


@cache
def _field_names(kind: Any) -> tuple[str, ...]:
    return tuple(f.name for f in fields(kind))


def _nodes(value: Any) -> Iterator[Any]:
    if isinstance(value, tuple):
        for entry in value:
            yield from _nodes(entry)
    elif hasattr(value, "__dataclass_fields__"):
        yield value


def substituted(node: Any, one: Any, other: Any) -> Any:
    """Return a tree with one subtree replaced wherever it stands.

    Examples
    --------
    >>> substituted(Quotient(Named("s"), Number("2")), Named("s"), Number("1"))
    Quotient(numerator=Number(text='1'), denominator=Number(text='2'))
    """
    if node == one:
        return other
    if isinstance(node, tuple):
        return tuple(substituted(entry, one, other) for entry in node)
    if hasattr(node, "__dataclass_fields__"):
        return replace(node, **{f: substituted(getattr(node, f), one, other) for f in _field_names(node.__class__)})
    return node
