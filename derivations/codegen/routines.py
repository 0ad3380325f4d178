"""What is generated: a routine is a name, checked arguments and expressions, in no language yet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from sympy import Expr, Symbol, count_ops, cse, numbered_symbols

Kind = Literal["number", "degree", "span", "vector", "function", "block"]
Form = Literal["matrix", "vectors", "density", "block"]


@dataclass(frozen=True)
class Argument:
    """One argument of a routine.

    Parameters
    ----------
    name : str
    kind : str
        "number"; "degree", a number of at least `least`; "span", a positive distance of knots; "vector", one vector or
        many, last axis 3; "function", a number for each vector; "block", a number or a matrix, one shape for all.
    meaning : str
        Half a line for the docstring.
    least : int
        Smallest degree.
    """

    name: str
    kind: Kind
    meaning: str
    least: int = 1


@dataclass(frozen=True)
class Routine:
    """A function to generate.

    Parameters
    ----------
    name : str
    summary : str
        First line of the docstring.
    source : str
        Which derivation, which equation.
    arguments : tuple of Argument
    form : str
        "matrix": `values` row by row; "vectors": one vector for each value; "density": the one value summed over the
        coordinates; "block": the one value, elementwise.
    values : tuple of tuple of Expr
    names : tuple of str
        Names of the returned values, for the docstring.
    """

    name: str
    summary: str
    source: str
    arguments: tuple[Argument, ...]
    form: Form
    values: tuple[tuple[Expr, ...], ...]
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        known = {Symbol(argument.name) for argument in self.arguments}
        for row in self.values:
            for value in row:
                unknown = sorted(str(symbol) for symbol in value.free_symbols - known)
                if unknown:
                    raise ValueError(f"{self.name}: no argument for the symbol(s) {', '.join(unknown)}")


@dataclass(frozen=True)
class Steps:
    """The body of a routine: temporaries in order, then the entries of the result, then their operations."""

    temporaries: tuple[tuple[str, Expr], ...]
    entries: tuple[tuple[Expr, ...], ...]
    operations: int


def routine_steps(routine: Routine) -> Steps:
    """Return the body with common subexpressions computed once; the same at every run."""
    flat = [value for row in routine.values for value in row]
    taken = {Symbol(argument.name) for argument in routine.arguments}
    # `order="canonical"` sorts arguments before looking for what they share.
    shared, reduced = cse(flat, symbols=numbered_symbols("x", exclude=taken), order="canonical")
    entries, rest = [], list(reduced)
    for row in routine.values:
        entries.append(tuple(rest[: len(row)]))
        rest = rest[len(row) :]
    operations = sum(count_ops(value) for _, value in shared) + sum(count_ops(value) for value in reduced)
    return Steps(tuple((symbol.name, value) for symbol, value in shared), tuple(entries), int(operations))


def plain_symbols(expressions: Sequence[Expr], rename: dict[str, str] | None = None) -> tuple[Expr, ...]:
    """Return expressions over symbols without assumptions, renamed where asked, so that names alone identify them."""
    names = rename or {}
    return tuple(
        expression.subs({s: Symbol(names.get(s.name, s.name)) for s in expression.free_symbols}, simultaneous=True)
        for expression in expressions
    )
