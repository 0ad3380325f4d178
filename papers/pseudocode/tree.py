"""What printed code is made of. There is nothing else, so that nothing else can run."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias


@dataclass(frozen=True)
class Number:
    """A numeral, exact."""

    line: int
    value: Fraction


@dataclass(frozen=True)
class Word:
    """A text between quotes, or true, false and nothing."""

    line: int
    value: str | bool | None


@dataclass(frozen=True)
class Name:
    """A variable."""

    line: int
    name: str


@dataclass(frozen=True)
class Operation:
    """An operator with one operand, or two."""

    line: int
    sign: str
    operands: tuple[Expression, ...]


@dataclass(frozen=True)
class Choice:
    """condition ? yes : no."""

    line: int
    condition: Expression
    yes: Expression
    no: Expression


@dataclass(frozen=True)
class Index:
    """whole[at]."""

    line: int
    whole: Expression
    at: Expression


@dataclass(frozen=True)
class Field:
    """whole.name."""

    line: int
    whole: Expression
    name: str


@dataclass(frozen=True)
class Call:
    """function(arguments)."""

    line: int
    function: Expression
    arguments: tuple[Expression, ...]


@dataclass(frozen=True)
class Items:
    """[a, b, ..]."""

    line: int
    items: tuple[Expression, ...]


@dataclass(frozen=True)
class Record:
    """{a: .., b: ..}."""

    line: int
    fields: tuple[tuple[str, Expression], ...]


Expression: TypeAlias = Number | Word | Name | Operation | Choice | Index | Field | Call | Items | Record


@dataclass(frozen=True)
class Assign:
    """target = value; `sign` is + where it is +=; a value of None declares and no more; `own` where `var` says so."""

    line: int
    target: Expression
    value: Expression | None
    sign: str = ""
    own: bool = False


@dataclass(frozen=True)
class Evaluate:
    """An expression on its own, for what it does."""

    line: int
    value: Expression


@dataclass(frozen=True)
class If:
    """if, else."""

    line: int
    condition: Expression
    yes: tuple[Statement, ...]
    no: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class Loop:
    """While a condition holds: a body, then a step that a `continue` does not leave out; `first` runs once before."""

    line: int
    first: tuple[Statement, ...]
    condition: Expression
    step: tuple[Statement, ...]
    body: tuple[Statement, ...]
    body_first: bool = False


@dataclass(frozen=True)
class ForEach:
    """for each name in a list."""

    line: int
    name: str
    among: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class Leave:
    """break, continue."""

    line: int
    how: str


@dataclass(frozen=True)
class Return:
    """return, with or without a value."""

    line: int
    value: Expression | None


@dataclass(frozen=True)
class Function:
    """A definition. A parameter is a name, or a number for which alone it is meant.

    Attributes
    ----------
    line : int
    name : str
    parameters : tuple of str or Fraction
    body : tuple of statements
    gives : str
        A variable that begins as an empty list and is what it returns where no `return` has a value; empty where there
        is none.
    """

    line: int
    name: str
    parameters: tuple[str | Fraction, ...]
    body: tuple[Statement, ...]
    gives: str = ""


Statement: TypeAlias = Assign | Evaluate | If | Loop | ForEach | Leave | Return | Function


@dataclass(frozen=True)
class Program:
    """Code that can be run.

    Attributes
    ----------
    statements : tuple of statements
    rules : tuple of (int, str)
        Printed line, and the rule beyond the usual grammar that was used on it.
    """

    statements: tuple[Statement, ...]
    rules: tuple[tuple[int, str], ...]
