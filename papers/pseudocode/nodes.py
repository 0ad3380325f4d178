"""What the lines of pseudo-code are translated to. There is nothing else that could run."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias


@dataclass(frozen=True)
class Literal:
    """A number, by its digits, or a truth value."""

    value: Fraction | bool


@dataclass(frozen=True)
class Name:
    """A variable or a function."""

    text: str


@dataclass(frozen=True)
class Unary:
    """-, not, or ! behind a number: factorial."""

    operator: str
    operand: Expression


@dataclass(frozen=True)
class Binary:
    """Two operands; `and` and `or` look at the second only where it counts."""

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True)
class Choice:
    """condition ? one : other."""

    condition: Expression
    one: Expression
    other: Expression


@dataclass(frozen=True)
class Array:
    """A list of values."""

    entries: tuple[Expression, ...]


@dataclass(frozen=True)
class Fields:
    """A record: {o: .., t: ..}."""

    entries: tuple[tuple[str, Expression], ...]


@dataclass(frozen=True)
class Index:
    """values[index]."""

    values: Expression
    index: Expression


@dataclass(frozen=True)
class Member:
    """thing.name."""

    thing: Expression
    name: str


@dataclass(frozen=True)
class CallOf:
    """function(arguments)."""

    function: Expression
    arguments: tuple[Expression, ...]


Expression: TypeAlias = Literal | Name | Unary | Binary | Choice | Array | Fields | Index | Member | CallOf


@dataclass(frozen=True)
class Assign:
    """target = value, or with an operator before the sign; without a value the name only begins to exist."""

    line: int
    target: Name | Index | Member
    operator: str
    value: Expression | None
    local: bool = False


@dataclass(frozen=True)
class Evaluate:
    """A call that stands alone."""

    line: int
    expression: Expression


@dataclass(frozen=True)
class Return:
    """return value."""

    line: int
    value: Expression | None


@dataclass(frozen=True)
class Jump:
    """break or continue."""

    line: int
    word: str


@dataclass(frozen=True)
class If:
    """Two branches, the other one maybe empty."""

    line: int
    condition: Expression
    body: tuple[Line, ...]
    other: tuple[Line, ...]


@dataclass(frozen=True)
class Loop:
    """while; and for, whose steps run after each pass, but not after `break`."""

    line: int
    condition: Expression
    body: tuple[Line, ...]
    steps: tuple[Line, ...]


Line: TypeAlias = Assign | Evaluate | Return | Jump | If | Loop


@dataclass(frozen=True)
class Function:
    """A printed function.

    Attributes
    ----------
    line : int
    name : str
    parameters : tuple of str or Fraction
        A number stands for that value alone: `f(2,t)` is what f does at 2.
    body : tuple of Line
    result : str
        The variable that the head names as the result; empty where `return` says it.
    """

    line: int
    name: str
    parameters: tuple[str | Fraction, ...]
    body: tuple[Line, ...]
    result: str = ""
