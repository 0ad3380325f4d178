"""Exact arithmetic on texts with `fractions`, and what they divide by."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

from semispline.solver.errors import InputError


class TextError(InputError):
    """An expression that is not one of names, whole numbers, + - * / ^ and brackets."""


# What a number may be a value of; `real_root(p, k)` is the k-th real root, from 1, of a polynomial in x_.
FUNCTIONS = ("sqrt", "sqrtn", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "real_root")


@cache
def parsed(text: str) -> ast.expr:
    """Return the tree of an expression.

    Raises
    ------
    TextError
        Anything else stands in it.
    """
    try:
        tree = ast.parse(text.replace("^", "**"), mode="eval").body
    except SyntaxError:
        raise TextError(f"expression: found {text!r}, expected names, whole numbers, + - * / ^ and brackets") from None
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and not node.keywords and isinstance(node.func, ast.Name):
            if node.func.id in FUNCTIONS:
                continue
            raise TextError(f"expression: found {node.func.id}, expected one of {', '.join(FUNCTIONS)}")
        whole = isinstance(node, ast.Constant) and isinstance(node.value, int)
        if not whole and not isinstance(
            node, ast.Name | ast.Load | ast.BinOp | ast.UnaryOp | ast.operator | ast.USub | ast.UAdd
        ):
            raise TextError(f"expression: found {type(node).__name__} in {text!r}, expected arithmetic")
    return tree


def value(text: str, at: Mapping[str, Any], number: Callable[[int], Any] = Fraction) -> Any:
    """Return the value of an expression; `number` makes of a whole one what it is computed with.

    Examples
    --------
    >>> value("(x + 1)^2 / 3", {"x": Fraction(1, 2)})
    Fraction(3, 4)
    """
    return _value(parsed(text), at, number)


def _value(node: ast.expr, at: Mapping[str, Any], number: Callable[[int], Any]) -> Any:
    if isinstance(node, ast.Constant):
        return number(node.value)  # type: ignore[arg-type]  # `parsed` lets whole numbers through alone
    if isinstance(node, ast.Name):
        return at[node.id]
    if isinstance(node, ast.UnaryOp):
        inner = _value(node.operand, at, number)
        return -inner if isinstance(node.op, ast.USub) else inner
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        return _OPERATORS[type(node.op)](*(_value(side, at, number) for side in (node.left, node.right)))
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
        return _value(node.left, at, number) ** int(_value(node.right, {}, Fraction))
    raise TextError(f"expression: found {ast.unparse(node)}, expected + - * / or a power with a whole number")


_OPERATORS: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}


def names(text: str) -> set[str]:
    """Return the names in an expression."""
    return {node.id for node in ast.walk(parsed(text)) if isinstance(node, ast.Name)} - set(FUNCTIONS)


def divisors(text: str) -> Iterator[str]:
    """Yield everything that an expression divides by.

    Examples
    --------
    >>> list(divisors("a / (b * (c - 1)) + d^-2"))
    ['b * (c - 1)', 'd']
    """
    source = text.replace("^", "**")
    for node in ast.walk(parsed(text)):
        found = None
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div) and not isinstance(node.right, ast.Constant):
            found = node.right
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and isinstance(node.right, ast.UnaryOp):
            found = node.left
        if found is not None:
            yield str(ast.get_source_segment(source, found)).replace("**", "^")


def instance(at: Sequence[tuple[str, str]], where: Sequence[tuple[str, str]]) -> dict[str, Fraction]:
    """Return the values of all names at an instance."""
    values = {name: Fraction(number) for name, number in at}
    for name, text in where:
        values[name] = value(text, values)
    return values


def satisfied(condition: str, at: Mapping[str, Fraction]) -> bool:
    """Tell whether a condition such as "u_1 > 0" holds at an instance."""
    for sign, holds in _RELATIONS.items():
        if sign in condition:
            left, right = condition.split(sign)
            return bool(holds(value(left.strip(), at), value(right.strip(), at)))
    raise TextError(f"condition: found {condition!r}, expected one with >, >=, <, <= or !=")


# Those of two characters first.
_RELATIONS: dict[str, Callable[[Any, Any], Any]] = {
    ">=": operator.ge,
    "<=": operator.le,
    "!=": operator.ne,
    ">": operator.gt,
    "<": operator.lt,
}
