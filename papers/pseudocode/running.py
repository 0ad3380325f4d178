"""An interpreter for printed code: exact values, limits of steps, depth and size, no way to anything of Python's."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.papers.pseudocode.errors import CodeError, CodeFaultError, CodeLimitError
from semispline.papers.pseudocode.parsing import read_code
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
    Program,
    Record,
    Return,
    Statement,
    Word,
)
from semispline.papers.pseudocode.values import (
    Limits,
    Unset,
    as_given,
    bounded,
    elementary,
    is_number,
    is_true,
    operate,
    power,
    shown,
    smallest,
    square_root,
    whole,
)


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
    text: str,
    call: str = "",
    given: Mapping[str, Any] | None = None,
    limits: Limits | None = None,
    replace: Mapping[str, str] | None = None,
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
    replace : mapping, optional
        As `read_code` has it.

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
    machine = _Machine({}, limits or Limits())
    try:
        machine.given = {name: as_given(value) for name, value in (given or {}).items()}
        machine.run_all(_read(text, tuple((replace or {}).items())).statements)
        if call:
            machine.last, machine.calling = None, True
            machine.run_all(_read_call(call).statements)
        return Outcome(_given_back(machine.last), _given_back(machine.scope), machine.steps)
    except RecursionError:
        reason = "found calls and brackets too deep in each other, expected an end before"
        raise CodeLimitError(reason, machine.place(machine.line)) from None


@cache
def _read(text: str, replace: tuple[tuple[str, str], ...]) -> Program:
    return read_code(text, dict(replace))


@cache
def _read_call(call: str) -> Program:
    try:
        return read_code(call)
    except CodeError as error:
        raise CodeError(f"the call, {error}") from None


def _given_back(value: Any) -> Any:
    """Return a value for Python: a place without a value holds None."""
    if isinstance(value, list):
        return [_given_back(item) for item in value]
    if isinstance(value, dict):
        return {name: _given_back(item) for name, item in value.items()}
    return None if value is Unset.UNSET else value


class _LeaveError(Exception):
    """A `break` or `continue` on its way to its loop."""

    def __init__(self, how: str, line: int) -> None:
        self.how, self.line = how, line


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
    line: int = 0
    calling: bool = False
    last: Any = None
    scopes: list[dict[str, Any]] = field(default_factory=lambda: [{}])
    functions: dict[str, list[Function]] = field(default_factory=dict)

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
        except _ReturnError as returned:
            self.last = returned.value
        except _LeaveError as leave:
            raise self._outside(leave) from None

    def _outside(self, leave: _LeaveError) -> CodeFaultError:
        return CodeFaultError(f"found {leave.how}, expected a loop around it", self.place(leave.line))

    def block(self, statements: tuple[Statement, ...]) -> None:
        for statement in statements:
            self._do(_RUN[type(statement)], statement)

    def value(self, expression: Expression) -> Any:
        return self._do(_VALUE[type(expression)], expression)

    def _do(self, what: Callable[[_Machine, Any], Any], node: Statement | Expression) -> Any:
        """Do one step; a fault in it is one of its line."""
        self.steps += 1
        self.line = node.line
        try:
            if self.steps > self.limits.steps:
                raise CodeLimitError(f"found more than {self.limits.steps} steps, expected an end before")
            value = what(self, node)
            if value is Unset.UNSET:
                raise CodeFaultError("found a place of a list or a record that has no value yet")
            return value
        except CodeFaultError as fault:
            if fault.place:
                raise
            raise type(fault)(fault.reason, self.place(node.line)) from None

    def place(self, line: int) -> str:
        """Return where that is: in the printed lines, or in those of the call."""
        return f"the call, line {line}" if self.calling and not self.depth else f"line {line}"

    # Statements.

    def _assign(self, statement: Assign) -> None:
        if statement.value is None:
            self._declare(statement.target, own=statement.own)
            return
        value = self.value(statement.value)
        if statement.sign:
            value = operate(statement.sign, [self.value(statement.target), value], self.limits)
        self._store(statement.target, value, own=statement.own)

    def _declare(self, target: Expression, *, own: bool) -> None:
        """Make a variable without a value, of a name that has none."""
        if isinstance(target, Name) and not any(
            target.name in where for where in ((self.scope,) if own else (self.scope, self.scopes[0], self.given))
        ):
            self.scope[target.name] = Unset.UNSET

    def _store(self, target: Expression, value: Any, *, own: bool) -> None:
        if isinstance(target, Name):
            outer = self.scopes[0]
            # A name of the whole program that a function assigns to stays that, unless it makes its own.
            where = outer if not own and target.name not in self.scope and target.name in outer else self.scope
            where[target.name] = value
            return
        if isinstance(target, Index):
            whole_list = self.value(target.whole)
            at = self.value(target.at)
            if isinstance(whole_list, dict):
                whole_list[str(at)] = value
                return
            whole_list[_index_of(whole_list, at)] = value
            return
        if isinstance(target, Field):
            record = self.value(target.whole)
            if isinstance(record, dict):
                record[target.name] = value
                return
        raise CodeFaultError("found a value for something that is no variable")

    def _evaluate(self, statement: Evaluate) -> None:
        self.last = self.value(statement.value)

    def _if(self, statement: If) -> None:
        self.block(statement.yes if self._holds(statement.condition) else statement.no)

    def _holds(self, condition: Expression) -> bool:
        return is_true(self.value(condition))

    def _loop(self, statement: Loop) -> None:
        self.block(statement.first)
        again = statement.body_first
        while again or self._holds(statement.condition):
            again = False
            if self._body(statement.body):
                return
            self.block(statement.step)

    def _body(self, body: tuple[Statement, ...]) -> bool:
        """Run a body once; return whether the loop is left."""
        try:
            self.block(body)
        except _LeaveError as leave:
            return leave.how == "break"
        return False

    def _for_each(self, statement: ForEach) -> None:
        items = self.value(statement.among)
        if not isinstance(items, list):
            raise CodeFaultError(f"found {shown(items)}, expected a list")
        for item in list(items):
            self.scope[statement.name] = item
            if self._body(statement.body):
                return

    def _leave(self, statement: Leave) -> None:
        raise _LeaveError(statement.how, statement.line)

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
                if where[e.name] is Unset.UNSET:
                    raise CodeFaultError(f"found {e.name}, which has no value yet")
                return where[e.name]
        if e.name in self.functions:
            return _Closure(self, e.name)
        if e.name in _BUILT_IN:
            return _BUILT_IN[e.name]
        raise CodeFaultError(f"found {e.name}, which has no value")

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
                raise CodeFaultError(f"found the key {shown(at)}, expected one of {', '.join(items)}")
            return items[str(at)]
        return items[_index_of(items, at)]

    def _field(self, e: Field) -> Any:
        owner = self.value(e.whole)
        if isinstance(owner, list):
            if e.name in ("length", "size", "count"):
                return Fraction(len(owner))
            if e.name in ("last", "first") and owner:
                return owner[-1 if e.name == "last" else 0]
        if isinstance(owner, dict) and e.name in owner:
            return owner[e.name]
        raise CodeFaultError(f"found the field {e.name} of {shown(owner)}, which has none of that name")

    def _call(self, e: Call) -> Any:
        arguments = [self.value(argument) for argument in e.arguments]
        if isinstance(e.function, Field):
            owner = self.value(e.function.whole)
            if isinstance(owner, list):
                return self._method(owner, e.function.name, arguments)
        if isinstance(e.function, Name) and e.function.name in self.functions and e.function.name not in self.scope:
            return self.call(e.function.name, arguments)
        function = self.value(e.function)
        if not callable(function):
            raise CodeFaultError(f"found a call of {shown(function)}, expected a function")
        if not _takes(function, len(arguments)):
            raise CodeFaultError(f"found {len(arguments)} arguments, which the function does not take")
        made = function(*arguments)
        # What the program made is its own, and stays the same list.
        return made if isinstance(function, _Closure) else bounded(as_given(made), self.limits)

    def call(self, name: str, arguments: list[Any]) -> Any:
        """Call a function of the program: that of a number for which alone it is meant, where there is one."""
        fitting = [function for function in self.functions[name] if _fits(function, arguments)]
        if not fitting:
            raise CodeFaultError(f"found {name} of {', '.join(map(shown, arguments))}, for which it is not defined")
        function = max(fitting, key=lambda f: sum(not isinstance(p, str) for p in f.parameters))
        if self.depth >= self.limits.depth:
            raise CodeLimitError(f"found calls {self.limits.depth} deep, expected an end before")
        named: dict[str, Any] = {function.gives: []} if function.gives else {}
        named |= {p: a for p, a in zip(function.parameters, arguments, strict=True) if isinstance(p, str)}
        self.depth += 1
        self.scopes.append(named)
        try:
            self.block(function.body)
        except _ReturnError as returned:
            if returned.value is not None:
                return returned.value
        except _LeaveError as leave:
            raise self._outside(leave) from None
        finally:
            self.depth -= 1
            self.scopes.pop()
        return named.get(function.gives)

    def _method(self, items: list[Any], name: str, arguments: list[Any]) -> Any:
        if name in ("add", "push", "append"):
            if len(items) + len(arguments) > self.limits.items:
                raise CodeLimitError(f"found a list of more than {self.limits.items} items")
            items.extend(arguments)
            return None
        if name == "pop" and items and not arguments:
            return items.pop()
        if name == "filter" and len(arguments) == 1 and callable(arguments[0]):
            return [item for item in items if is_true(arguments[0](item))]
        raise CodeFaultError(f"found {name} of a list, expected add, push, append, pop or filter")

    def _items(self, e: Items) -> Any:
        return [self.value(item) for item in e.items]

    def _record(self, e: Record) -> Any:
        return {name: self.value(value) for name, value in e.fields}


class _Closure:
    """A function of the program as a value."""

    def __init__(self, machine: _Machine, name: str) -> None:
        self.machine, self.name = machine, name

    def __call__(self, *arguments: Any) -> Any:
        return self.machine.call(self.name, list(arguments))


def _index_of(items: Any, at: Any) -> int:
    if not isinstance(items, list):
        raise CodeFaultError(f"found an index of {shown(items)}, expected a list")
    place = whole(at, "an index")
    if not 0 <= place < len(items):
        raise CodeFaultError(f"found the index {place}, expected 0 .. {len(items) - 1}")
    return place


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
        raise CodeLimitError(f"found the size {size}, expected 0 .. {Limits().items}")
    return [_array(*sizes[1:]) if len(sizes) > 1 else Unset.UNSET for _ in range(size)]


def _copied(value: Any) -> Any:
    if isinstance(value, list):
        return [_copied(item) for item in value]
    return {name: _copied(item) for name, item in value.items()} if isinstance(value, dict) else value


def _absolute(value: Any) -> Any:
    if not is_number(value):
        raise CodeFaultError(f"found the size of {shown(value)}, expected a number")
    return sp.Abs(value) if isinstance(value, sp.Basic) else abs(value)


def _whole_part(up: bool) -> Callable[[Any], Any]:
    def of(value: Any) -> Any:
        if not isinstance(value, Fraction):
            raise CodeFaultError(f"found {shown(value)}, expected a fraction")
        return Fraction(-((-value) // 1) if up else value // 1)

    return of


def _power_of(base: Any, exponent: Any) -> Any:
    if not is_number(base) or not is_number(exponent):
        raise CodeFaultError(f"found {shown(base)} and {shown(exponent)}, expected numbers")
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
    "min": lambda *values: smallest(values),
    "max": lambda *values: smallest(values, ">"),
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
