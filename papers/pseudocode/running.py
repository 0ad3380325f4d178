"""An interpreter for printed code: exact values, limits of steps, depth and size, no way to anything of Python's."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.papers.pseudocode.parsing import parsed
from semispline.papers.pseudocode.tree import (
    Assign,
    Call,
    Choice,
    Evaluate,
    Expression,
    Field,
    ForEach,
    Function,
    If,
    Index,
    Items,
    Leave,
    Loop,
    Name,
    Number,
    Operation,
    Record,
    Return,
    Statement,
    Word,
)
from semispline.papers.pseudocode.values import (
    FaultError,
    Limits,
    OpenError,
    SizeError,
    as_given,
    elementary,
    is_number,
    is_true,
    operate,
    power,
    shown,
    square_root,
    whole,
)


class CodeFaultError(Exception):
    """A program that did what it must not; the message names the printed line."""


class CodeLimitError(CodeFaultError):
    """A program that was stopped at a limit of steps, depth or size: that it never ends is not known."""


class OpenConditionError(CodeFaultError):
    """A condition that letters leave open: the program runs with numbers only."""


@dataclass(frozen=True)
class Outcome:
    """What a run comes to.

    Attributes
    ----------
    value : object
        Of the call; None where nothing is returned.
    variables : mapping
        All that was assigned outside of functions.
    steps : int
    """

    value: Any
    variables: Mapping[str, Any]
    steps: int


def run_code(
    text: str, call: str = "", given: Mapping[str, Any] | None = None, limits: Limits | None = None
) -> Outcome:
    r"""Run printed code, then what calls it.

    Parameters
    ----------
    text : str
        As printed.
    call : str
        Code that is run after it, and whose last expression is the outcome: "f(n, t)", or several lines.
    given : mapping, optional
        Name -> number, list, record or function that the code uses and does not define. Functions get and give values
        as the interpreter has them: `Fraction` or SymPy expressions, lists, dictionaries.
    limits : Limits, optional

    Raises
    ------
    CodeError
        It cannot be read.
    CodeFaultError
        It did what it must not: an index outside of a list, a name without a value, a division by zero.
    CodeLimitError
        It took more steps, depth or digits than the limits allow.
    OpenConditionError
        Letters leave a condition open.

    Examples
    --------
    >>> run_code("f(n):\n  s = 0\n  for(k=1; k<=n; k++):\n    s += k^2\n  return s", "f(4)").value
    Fraction(30, 1)
    """
    machine = _Machine(given or {}, limits or Limits())
    machine.run_all(_parsed(text))
    machine.last = None
    machine.run_all(_parsed(call) if call else ())
    return Outcome(machine.last, machine.scope, machine.steps)


_parsed = cache(parsed)


def _told(error: FaultError, line: int) -> CodeFaultError:
    """Return a fault with its printed line."""
    kinds: dict[type, type[CodeFaultError]] = {SizeError: CodeLimitError, OpenError: OpenConditionError}
    return kinds.get(type(error), CodeFaultError)(f"line {line}: {error}")


class _LeaveError(Exception):
    """A `break` or `continue` on its way to its loop."""


class _ReturnError(Exception):
    """A value on its way to the call."""

    def __init__(self, value: Any) -> None:
        self.value = value


@dataclass
class _Machine:
    """Variables, functions, and how much has been used."""

    given: Mapping[str, Any]
    limits: Limits
    steps: int = 0
    depth: int = 0
    last: Any = None
    scopes: list[dict[str, Any]] = field(default_factory=lambda: [{}])
    functions: dict[str, list[Function]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.given = {name: as_given(value) for name, value in self.given.items()}

    @property
    def scope(self) -> dict[str, Any]:
        return self.scopes[-1]

    def run_all(self, statements: tuple[Statement, ...]) -> None:
        """Run a program; its functions are known before its first line."""
        for statement in statements:
            if isinstance(statement, Function):
                self.functions.setdefault(statement.name, []).append(statement)
        try:
            self.block(statements)
        except _ReturnError:
            return
        except _LeaveError:
            raise CodeFaultError(f"line {statements[0].line}: found break or continue outside of a loop") from None

    def block(self, statements: tuple[Statement, ...]) -> None:
        for statement in statements:
            self._tick(statement.line)
            _RUN[type(statement)](self, statement)

    def value(self, expression: Expression) -> Any:
        self._tick(expression.line)
        try:
            return _VALUE[type(expression)](self, expression)
        except FaultError as error:
            raise _told(error, expression.line) from None

    def _tick(self, line: int) -> None:
        self.steps += 1
        if self.steps > self.limits.steps:
            raise CodeLimitError(f"line {line}: found more than {self.limits.steps} steps, expected an end before")

    # Statements.

    def _assign(self, statement: Assign) -> None:
        if statement.value is None:
            self._declare(statement.target)
            return
        value = self.value(statement.value)
        if statement.sign:
            value = self._operated(statement, statement.sign, [self.value(statement.target), value])
        self._store(statement.target, value)

    def _declare(self, target: Expression) -> None:
        """Make a variable of a name on its own; of one that has a value that value is what counts."""
        if not isinstance(target, Name):
            return
        for where in (self.scope, self.scopes[0], self.given):
            if target.name in where:
                self.last = where[target.name]
                return
        self.scope[target.name] = None

    def _operated(self, at: Any, sign: str, values: list[Any]) -> Any:
        try:
            return operate(sign, values, self.limits)
        except FaultError as error:
            raise _told(error, at.line) from None

    def _store(self, target: Expression, value: Any) -> None:
        if isinstance(target, Name):
            outer = self.scopes[0]
            # A name of the whole program that a function assigns to stays that.
            where = outer if target.name not in self.scope and target.name in outer else self.scope
            where[target.name] = value
            return
        if isinstance(target, Index):
            whole_list = self.value(target.whole)
            at = self.value(target.at)
            if isinstance(whole_list, dict):
                whole_list[str(at)] = value
                return
            whole_list[self._place(whole_list, at, target.line)] = value
            return
        if isinstance(target, Field):
            record = self.value(target.whole)
            if isinstance(record, dict):
                record[target.name] = value
                return
        raise CodeFaultError(f"line {target.line}: found a value for something that is no variable")

    def _place(self, items: Any, at: Any, line: int) -> int:
        if not isinstance(items, list):
            raise CodeFaultError(f"line {line}: found an index of {shown(items)}, expected a list")
        try:
            place = whole(at, "an index")
        except FaultError as error:
            raise _told(error, line) from None
        if not 0 <= place < len(items):
            raise CodeFaultError(f"line {line}: found the index {place}, expected 0 .. {len(items) - 1}")
        return place

    def _evaluate(self, statement: Evaluate) -> None:
        self.last = self.value(statement.value)

    def _if(self, statement: If) -> None:
        self.block(statement.yes if self._holds(statement.condition) else statement.no)

    def _holds(self, condition: Expression) -> bool:
        try:
            return is_true(self.value(condition))
        except FaultError as error:
            raise _told(error, condition.line) from None

    def _loop(self, statement: Loop) -> None:
        self.block(statement.first)
        again = statement.body_first
        while again or self._holds(statement.condition):
            again = False
            self._tick(statement.line)
            if self._body(statement.body):
                return
            self.block(statement.step)

    def _body(self, body: tuple[Statement, ...]) -> bool:
        """Run a body once; return whether the loop is left."""
        try:
            self.block(body)
        except _LeaveError as leave:
            return str(leave) == "break"
        return False

    def _for_each(self, statement: ForEach) -> None:
        items = self.value(statement.among)
        if not isinstance(items, list):
            raise CodeFaultError(f"line {statement.line}: found {shown(items)}, expected a list")
        for item in list(items):
            self._tick(statement.line)
            self.scope[statement.name] = item
            if self._body(statement.body):
                return

    def _leave(self, statement: Leave) -> None:
        raise _LeaveError(statement.how)

    def _return(self, statement: Return) -> None:
        raise _ReturnError(None if statement.value is None else self.value(statement.value))

    def _define(self, statement: Function) -> None:
        known = self.functions.setdefault(statement.name, [])
        if statement not in known:
            known.append(statement)

    # Expressions.

    def _number(self, e: Number) -> Any:
        return e.value

    def _word(self, e: Word) -> Any:
        return e.value

    def _name(self, e: Name) -> Any:
        for where in (self.scope, self.scopes[0], self.given):
            if e.name in where:
                return where[e.name]
        if e.name in self.functions:
            return _Closure(self, e.name)
        if e.name in _BUILT_IN:
            return _BUILT_IN[e.name]
        raise FaultError(f"found {e.name}, which has no value")

    def _operation(self, e: Operation) -> Any:
        if e.sign in ("and", "or"):
            first = self._holds(e.operands[0])
            return first if first == (e.sign == "or") else self._holds(e.operands[1])
        if e.sign == "not":
            return not self._holds(e.operands[0])
        return operate(e.sign, [self.value(operand) for operand in e.operands], self.limits)

    def _choice(self, e: Choice) -> Any:
        return self.value(e.yes if self._holds(e.condition) else e.no)

    def _index(self, e: Index) -> Any:
        items, at = self.value(e.whole), self.value(e.at)
        if isinstance(items, dict):
            if str(at) not in items:
                raise FaultError(f"found the key {shown(at)}, expected one of {', '.join(items)}")
            return items[str(at)]
        return items[self._place(items, at, e.line)]

    def _field(self, e: Field) -> Any:
        owner = self.value(e.whole)
        if isinstance(owner, list):
            if e.name in ("length", "size", "count"):
                return Fraction(len(owner))
            if e.name in ("last", "first") and owner:
                return owner[-1 if e.name == "last" else 0]
        if isinstance(owner, dict) and e.name in owner:
            return owner[e.name]
        raise FaultError(f"found the field {e.name} of {shown(owner)}, which has none of that name")

    def _call(self, e: Call) -> Any:
        arguments = [self.value(argument) for argument in e.arguments]
        if isinstance(e.function, Field):
            owner = self.value(e.function.whole)
            if isinstance(owner, list):
                return self._method(owner, e.function.name, arguments)
        if isinstance(e.function, Name) and e.function.name in self.functions and e.function.name not in self.scope:
            return self.call(e.function.name, arguments, e.line)
        function = self.value(e.function)
        if not callable(function):
            raise FaultError(f"found a call of {shown(function)}, expected a function")
        if not _takes(function, len(arguments)):
            raise FaultError(f"found {len(arguments)} arguments, which the function does not take")
        return as_given(function(*arguments))

    def call(self, name: str, arguments: list[Any], line: int) -> Any:
        """Call a function of the program: that of a number for which alone it is meant, where there is one."""
        fitting = [function for function in self.functions[name] if _fits(function, arguments)]
        if not fitting:
            raise FaultError(f"found {name} of {', '.join(map(shown, arguments))}, for which it is not defined")
        function = max(fitting, key=lambda f: sum(not isinstance(p, str) for p in f.parameters))
        if self.depth >= self.limits.depth:
            raise CodeLimitError(f"line {line}: found calls {self.limits.depth} deep, expected an end before")
        named = {p: a for p, a in zip(function.parameters, arguments, strict=True) if isinstance(p, str)}
        self.depth += 1
        self.scopes.append(named)
        try:
            self.block(function.body)
            result = self.scope.get(function.gives)
        except _ReturnError as returned:
            result = returned.value
        except _LeaveError:
            raise CodeFaultError(f"line {function.line}: found break or continue outside of a loop") from None
        finally:
            self.depth -= 1
            self.scopes.pop()
        return result

    def _method(self, items: list[Any], name: str, arguments: list[Any]) -> Any:
        if name in ("add", "push", "append"):
            if len(items) + len(arguments) > self.limits.items:
                raise SizeError(f"found a list of more than {self.limits.items} items")
            items.extend(arguments)
            return None
        if name == "pop" and items and not arguments:
            return items.pop()
        if name == "filter" and len(arguments) == 1 and callable(arguments[0]):
            return [item for item in items if is_true(arguments[0](item))]
        raise FaultError(f"found {name} of a list, expected add, push, append, pop or filter")

    def _items(self, e: Items) -> Any:
        return [self.value(item) for item in e.items]

    def _record(self, e: Record) -> Any:
        return {name: self.value(value) for name, value in e.fields}


class _Closure:
    """A function of the program as a value."""

    def __init__(self, machine: _Machine, name: str) -> None:
        self.machine, self.name = machine, name

    def __call__(self, *arguments: Any) -> Any:
        return self.machine.call(self.name, list(arguments), 0)


def _takes(function: Callable[..., Any], count: int) -> bool:
    """Tell whether a function of Python's takes so many arguments, as far as it says."""
    try:
        inspect.signature(function).bind(*range(count))
    except TypeError:
        return False
    except ValueError:
        pass
    return True


def _fits(function: Function, arguments: list[Any]) -> bool:
    return len(function.parameters) == len(arguments) and all(
        isinstance(p, str) or p == a for p, a in zip(function.parameters, arguments, strict=True)
    )


# What there is, and nothing else.
_RUN: Mapping[type, Callable[[_Machine, Any], None]] = {
    Assign: _Machine._assign,
    Evaluate: _Machine._evaluate,
    If: _Machine._if,
    Loop: _Machine._loop,
    ForEach: _Machine._for_each,
    Leave: _Machine._leave,
    Return: _Machine._return,
    Function: _Machine._define,
}
_VALUE: Mapping[type, Callable[[_Machine, Any], Any]] = {
    Number: _Machine._number,
    Word: _Machine._word,
    Name: _Machine._name,
    Operation: _Machine._operation,
    Choice: _Machine._choice,
    Index: _Machine._index,
    Field: _Machine._field,
    Call: _Machine._call,
    Items: _Machine._items,
    Record: _Machine._record,
}


def _array(*sizes: Any) -> list[Any]:
    """Return a list of that many places without values."""
    if not sizes:
        return []
    size = whole(sizes[0], "a size")
    if not 0 <= size <= Limits().items:
        raise SizeError(f"found the size {size}, expected 0 .. {Limits().items}")
    return [_array(*sizes[1:]) if len(sizes) > 1 else None for _ in range(size)]


def _copied(value: Any) -> Any:
    if isinstance(value, list):
        return [_copied(item) for item in value]
    return {name: _copied(item) for name, item in value.items()} if isinstance(value, dict) else value


def _absolute(value: Any) -> Any:
    return sp.Abs(value) if isinstance(value, sp.Basic) else abs(value)


def _whole_part(up: bool) -> Callable[[Any], Any]:
    def of(value: Any) -> Any:
        if not isinstance(value, Fraction):
            raise FaultError(f"found {shown(value)}, expected a fraction")
        return Fraction(-((-value) // 1) if up else value // 1)

    return of


def _power_of(base: Any, exponent: Any) -> Any:
    if not is_number(base) or not is_number(exponent):
        raise FaultError(f"found {shown(base)} and {shown(exponent)}, expected numbers")
    return power(base, exponent, Limits())


# Names that printed code takes for granted; what it assigns itself, or what is given, comes before.
_BUILT_IN: dict[str, Any] = {
    "array": _array,
    "Array": _array,
    "list": _array,
    "copy": _copied,
    "sqrt": square_root,
    "pow": _power_of,
    "abs": _absolute,
    "floor": _whole_part(up=False),
    "ceil": _whole_part(up=True),
    "min": lambda *values: min(values),
    "max": lambda *values: max(values),
    "point": lambda *values: dict(zip("xyz", values, strict=False)),
    "Point": lambda *values: dict(zip("xyz", values, strict=False)),
    "vector": lambda *values: dict(zip("xyz", values, strict=False)),
    **{
        name: elementary(function)
        for name, function in {
            "cos": sp.cos, "sin": sp.sin, "tan": sp.tan, "acos": sp.acos, "asin": sp.asin, "atan": sp.atan,
            "exp": sp.exp, "log": sp.log, "ln": sp.log,
        }.items()
    },
    "pi": sp.pi,
    "PI": sp.pi,
    "π": sp.pi,
}  # fmt: skip
