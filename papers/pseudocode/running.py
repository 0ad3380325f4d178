"""Running a program: every step is counted, every value exact, and nothing of Python can be reached."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.papers.pseudocode.errors import FaultError, LimitError
from semispline.papers.pseudocode.nodes import (
    Array,
    Assign,
    Binary,
    CallOf,
    Choice,
    Evaluate,
    Expression,
    Fields,
    Function,
    If,
    Index,
    Jump,
    Line,
    Literal,
    Loop,
    Member,
    Name,
    Return,
    Unary,
)
from semispline.papers.pseudocode.parsing import Program
from semispline.papers.pseudocode.values import (
    Vector,
    compare,
    factorial_of,
    function_of,
    index_of,
    operate,
    taken,
)

_KNOWN = ("sqrt", "cos", "sin", "tan", "acos", "abs", "pow")
_COMPARED = ("==", "!=", "<", ">", "<=", ">=")
_COMPONENTS = "xyz"
_ENTRIES = 10_000


@dataclass(frozen=True)
class Limits:
    """What a run may take: steps (parts of expressions and lines looked at), and calls in each other."""

    steps: int = 20_000
    depth: int = 60


@dataclass(frozen=True)
class Outcome:
    """What a run leaves.

    Attributes
    ----------
    value : object
        What the called function gives; None where nothing was called, or it gives nothing. Numbers are `Fraction`s, or
        SymPy expressions where symbols or roots are in them; points are `Vector`s.
    variables : mapping
        Variables outside of functions at the end.
    steps : int
    """

    value: Any
    variables: Mapping[str, Any]
    steps: int


def run(
    program: Program,
    call: str = "",
    arguments: Sequence[Any] = (),
    given: Mapping[str, Any] | None = None,
    limits: Limits = Limits(),
) -> Outcome:
    r"""Run the lines outside of functions, then call a function.

    Parameters
    ----------
    program : Program
    call : str
        Which function; none for code without functions.
    arguments : sequence
        Whole numbers, `Fraction`s, SymPy symbols or expressions, lists, `Vector`s, dictionaries (records, or things
        with methods: name -> callable).
    given : mapping, optional
        Variables and functions that the text takes for granted: name -> value, or a callable of values.
    limits : Limits

    Raises
    ------
    FaultError
        The code does not come to its end; the message names the printed line.

    Examples
    --------
    >>> from semispline.papers.pseudocode.parsing import load
    >>> run(load("function half(x):\n  return x/2\n"), "half", [3]).value
    Fraction(3, 2)
    """
    machine = _Machine(program, limits, {name: taken(value) for name, value in (given or {}).items()})
    values = [taken(argument) for argument in arguments]
    try:
        ended = machine.lines(program.lines, machine.outside)
        value = ended.value if isinstance(ended, _Given) else None
        if call:
            value = machine.call(Name(call), values, machine.outside)
    except RecursionError:
        raise LimitError("too many calls and brackets in each other", machine.line) from None
    return Outcome(value, dict(machine.outside), machine.steps)


@dataclass(frozen=True)
class _Given:
    """A line that ends its function."""

    value: Any


class _Machine:
    def __init__(self, program: Program, limits: Limits, given: dict[str, Any]) -> None:
        self.program, self.limits, self.given = program, limits, given
        self.outside: dict[str, Any] = {}
        self.steps = self.depth = self.line = 0

    def count(self) -> None:
        self.steps += 1
        if self.steps > self.limits.steps:
            raise LimitError(f"more than {self.limits.steps} steps", self.line)

    def lines(self, lines: Sequence[Line], local: dict[str, Any]) -> _Given | Jump | None:
        for line in lines:
            ended = self.one(line, local)
            if ended is not None:
                return ended
        return None

    def one(self, line: Line, local: dict[str, Any]) -> _Given | Jump | None:
        self.line = line.line
        self.count()
        try:
            match line:
                case Assign():
                    self.assign(line, local)
                case Evaluate(_, expression):
                    self.value(expression, local)
                case Return(_, value):
                    return _Given(None if value is None else self.value(value, local))
                case Jump():
                    return line
                case If(_, condition, body, other):
                    return self.lines(body if self.truth(condition, local) else other, local)
                case Loop():
                    return self.loop(line, local)
        except FaultError as fault:
            if fault.line:
                raise
            raise type(fault)(fault.reason, self.line) from None
        return None

    def loop(self, loop: Loop, local: dict[str, Any]) -> _Given | None:
        while True:
            self.line = loop.line
            self.count()
            if not self.truth(loop.condition, local):
                return None
            ended = self.lines(loop.body, local)
            if isinstance(ended, _Given):
                return ended
            if ended is not None and ended.word == "break":
                return None
            self.lines(loop.steps, local)

    def assign(self, line: Assign, local: dict[str, Any]) -> None:
        value = None if line.value is None else self.value(line.value, local)
        if line.operator:
            value = operate(line.operator, self.value(line.target, local), value)
        match line.target:
            case Name(text):
                # A variable from outside is meant where one has that name, unless the line makes its own.
                own = line.local or text in local or text not in self.outside
                (local if own else self.outside)[text] = value
            case Index(values, index):
                entries = self.value(values, local)
                if not isinstance(entries, list):
                    raise FaultError("an index of what is no list")
                entries[index_of(self.value(index, local), len(entries))] = value
            case Member(thing, name):
                record = self.value(thing, local)
                if not isinstance(record, dict):
                    raise FaultError(f".{name} of what is no record")
                record[name] = value

    def truth(self, condition: Expression, local: dict[str, Any]) -> bool:
        value = self.value(condition, local)
        if not isinstance(value, bool):
            raise FaultError("a condition that is neither true nor false")
        return value

    def value(self, e: Expression, local: dict[str, Any]) -> Any:
        self.count()
        match e:
            case Literal(value):
                return value
            case Name(text):
                return self.named(text, local)
            case Unary("not", operand):
                return not self.truth(operand, local)
            case Unary("!", operand):
                return factorial_of(self.value(operand, local))
            case Unary(_, operand):
                return operate("*", Fraction(-1), self.value(operand, local))
            case Binary("and", left, right):
                return self.truth(left, local) and self.truth(right, local)
            case Binary("or", left, right):
                return self.truth(left, local) or self.truth(right, local)
            case Binary(sign, left, right):
                one, other = self.value(left, local), self.value(right, local)
                return compare(sign, one, other) if sign in _COMPARED else operate(sign, one, other)
            case Choice(condition, one_, other_):
                return self.value(one_ if self.truth(condition, local) else other_, local)
            case Array(entries):
                return [self.value(entry, local) for entry in entries]
            case Fields(fields):
                return {name: self.value(entry, local) for name, entry in fields}
            case Index(values, index):
                found = self.value(values, local)
                if not isinstance(found, list):
                    raise FaultError("an index of what is no list")
                return self.known(found[index_of(self.value(index, local), len(found))])
            case Member(thing, name):
                return self.known(self.member(self.value(thing, local), name))
            case CallOf(function, arguments):
                return self.call(function, [self.value(a, local) for a in arguments], local)
        raise FaultError("what is no expression")

    def known(self, value: Any) -> Any:
        if value is None:
            raise FaultError("a place of a list or a record that has no value yet")
        return value

    def named(self, text: str, local: dict[str, Any]) -> Any:
        for scope in (local, self.outside, self.given):
            if text in scope:
                if scope[text] is None:
                    raise FaultError(f"{text} has no value yet")
                return scope[text]
        if text in self.program.functions:
            return self.program.functions[text][0]
        if text == "pi":
            return sp.pi
        raise FaultError(f"{text} has no value")

    def member(self, thing: Any, name: str) -> Any:
        if isinstance(thing, list):
            if name in ("length", "size"):
                return Fraction(len(thing))
            if name == "last":
                if not thing:
                    raise FaultError("the last one of an empty list")
                return thing[-1]
        if isinstance(thing, Vector) and name in _COMPONENTS and _COMPONENTS.index(name) < len(thing.entries):
            return thing.entries[_COMPONENTS.index(name)]
        if isinstance(thing, dict) and name in thing:
            return thing[name]
        raise FaultError(f".{name} of what has none")

    def call(self, function: Expression, arguments: list[Any], local: dict[str, Any]) -> Any:
        if isinstance(function, Member):
            thing = self.value(function.thing, local)
            if isinstance(thing, list):
                return self.on_list(thing, function.name, arguments)
            return self.python(self.known(self.member(thing, function.name)), arguments)
        if not isinstance(function, Name):
            raise FaultError("a call of what has no name")
        name = function.text
        if name in self.program.functions:
            return self.printed(name, arguments)
        if name in self.given or name in local or name in self.outside:
            return self.python(self.named(name, local), arguments)
        if name in _KNOWN:
            return function_of(name, arguments)
        if name == "point":
            return Vector(tuple(arguments))
        if name == "array" and len(arguments) == 1:
            return [None] * index_of(arguments[0], _ENTRIES)
        if name == "copy" and len(arguments) == 1 and isinstance(arguments[0], list):
            return list(arguments[0])
        raise FaultError(f"{name} is no function that is printed or given")

    def python(self, function: Callable[..., Any] | Any, arguments: list[Any]) -> Any:
        """Call what the claim gives."""
        if isinstance(function, Function):
            return self.printed(function.name, arguments)
        if not callable(function):
            raise FaultError("a call of what is no function")
        return taken(function(*arguments))

    def on_list(self, values: list[Any], name: str, arguments: list[Any]) -> Any:
        if name in ("add", "push"):
            if len(values) >= _ENTRIES:
                raise LimitError(f"a list of more than {_ENTRIES}")
            # `push[a, b]` appends one entry, the list of both.
            values.append(arguments[0] if len(arguments) == 1 else arguments)
            return None
        if name == "filter" and len(arguments) == 1:
            return [value for value in values if self.kept(arguments[0], value)]
        raise FaultError(f".{name} of a list")

    def kept(self, function: Any, value: Any) -> bool:
        answer = self.python(function, [value])
        if not isinstance(answer, bool):
            raise FaultError("a filter that is neither true nor false")
        return answer

    def printed(self, name: str, arguments: list[Any]) -> Any:
        """Call a printed function: the variant for these numbers, or the one for all."""
        variants = [f for f in self.program.functions[name] if _fits(f, arguments)]
        if not variants:
            raise FaultError(f"{name} is not printed for these {len(arguments)} values")
        # A number among the parameters says more than a letter.
        function = max(variants, key=lambda f: sum(isinstance(p, Fraction) for p in f.parameters))
        if self.depth >= self.limits.depth:
            raise LimitError(f"more than {self.limits.depth} calls in each other", self.line)
        local = {p: a for p, a in zip(function.parameters, arguments, strict=True) if isinstance(p, str)}
        if function.result:
            local[function.result] = []
        self.depth += 1
        line = self.line
        ended = self.lines(function.body, local)
        self.depth -= 1
        self.line = line
        if function.result and ended is None:
            return local[function.result]
        return ended.value if isinstance(ended, _Given) else None


def _fits(function: Function, arguments: list[Any]) -> bool:
    return len(function.parameters) == len(arguments) and all(
        isinstance(p, str) or p == a for p, a in zip(function.parameters, arguments, strict=True)
    )
