"""Values of running code: exact numbers, symbols, lists, records, points; operations keep numbers within bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import Any

import sympy as sp

from semispline.papers.pseudocode.errors import FaultError, LimitError

_BITS = 20_000
_EXPONENT = 1_000
_SYMBOLIC = 2_000


@dataclass(frozen=True)
class Vector:
    """A point or a vector, by its components.

    Examples
    --------
    >>> (Vector((1, 2)) + Vector((3, 4))).entries
    (Fraction(4, 1), Fraction(6, 1))
    """

    entries: tuple[Any, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "entries", tuple(taken(entry) for entry in self.entries))

    def __add__(self, other: Vector) -> Vector:
        return self._with(other, "+")

    def __sub__(self, other: Vector) -> Vector:
        return self._with(other, "-")

    def _with(self, other: Vector, sign: str) -> Vector:
        if len(self.entries) != len(other.entries):
            raise FaultError(f"points of {len(self.entries)} and {len(other.entries)} components")
        return Vector(tuple(operate(sign, a, b) for a, b in zip(self.entries, other.entries, strict=True)))

    def times(self, factor: Any) -> Vector:
        """Return the multiple."""
        return Vector(tuple(operate("*", entry, factor) for entry in self.entries))

    def over(self, divisor: Any) -> Vector:
        """Return the vector, divided."""
        return Vector(tuple(operate("/", entry, divisor) for entry in self.entries))

    def dot(self, other: Vector) -> Any:
        """Return the scalar product."""
        total: Any = Fraction(0)
        for a, b in zip(self.entries, other.entries, strict=True):
            total = operate("+", total, operate("*", a, b))
        return total

    def cross(self, other: Vector) -> Vector:
        """Return the vector product of two vectors in space."""
        if len(self.entries) != 3 or len(other.entries) != 3:
            raise FaultError("a vector product of vectors that have not three components")
        a, b = self.entries, other.entries
        minors = [(a[i], b[j], a[j], b[i]) for i, j in ((1, 2), (2, 0), (0, 1))]
        return Vector(tuple(operate("-", operate("*", p, q), operate("*", r, s)) for p, q, r, s in minors))


def is_number(value: Any) -> bool:
    """Tell whether a value is a fraction or an expression of SymPy."""
    return isinstance(value, Fraction | sp.Expr)


def taken(value: Any) -> Any:
    """Return what a caller gives as a value of the program: whole numbers as fractions, lists as own copies.

    Raises
    ------
    FaultError
        A float, or anything else that is not exact.
    """
    if isinstance(value, bool) or value is None or isinstance(value, Fraction):
        return value
    if isinstance(value, int):
        return Fraction(value)
    if isinstance(value, sp.Rational):
        return Fraction(int(value.p), int(value.q))
    if isinstance(value, sp.Expr):
        return value
    if isinstance(value, Vector):
        return value
    if isinstance(value, dict):
        return {key: taken(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [taken(entry) for entry in value]
    if callable(value):
        return value
    raise FaultError(f"found {type(value).__name__} {value!r}, expected an exact number, a list, a point, a record")


def operate(sign: str, left: Any, right: Any) -> Any:
    """Return the result of an operation on numbers or points.

    Raises
    ------
    FaultError
        Values that have no such operation, a division by zero, numbers that grow too large.
    """
    if isinstance(left, Vector) or isinstance(right, Vector):
        return _on_points(sign, left, right)
    if not (is_number(left) and is_number(right)):
        raise FaultError(f"{sign} of {_kind(left)} and {_kind(right)}")
    if sign == "/" and _is_zero(right):
        raise FaultError("a division by zero")
    if sign == "^":
        return _power(left, right)
    if isinstance(left, Fraction) and isinstance(right, Fraction):
        if sign == "%":
            return left % right if right else _zero()
        exact = {"+": Fraction.__add__, "-": Fraction.__sub__, "*": Fraction.__mul__, "/": Fraction.__truediv__}
        return _bounded(exact[sign](left, right))
    if sign == "%":
        raise FaultError("% of symbols")
    a, b = _symbolic(left), _symbolic(right)
    return _bounded({"+": a.__add__, "-": a.__sub__, "*": a.__mul__, "/": a.__truediv__}[sign](b))


def _zero() -> Any:
    raise FaultError("a division by zero")


def _on_points(sign: str, left: Any, right: Any) -> Any:
    both = isinstance(left, Vector) and isinstance(right, Vector)
    if both and sign in "+-·×":
        return {"+": left.__add__, "-": left.__sub__, "·": left.dot, "×": left.cross}[sign](right)
    if sign == "*" and isinstance(left, Vector) and is_number(right):
        return left.times(right)
    if sign == "*" and isinstance(right, Vector) and is_number(left):
        return right.times(left)
    if sign == "/" and isinstance(left, Vector) and is_number(right):
        return left.over(right)
    raise FaultError(f"{sign} of {_kind(left)} and {_kind(right)}")


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(exponent, Fraction) and abs(exponent) > _EXPONENT:
        raise LimitError(f"an exponent above {_EXPONENT}")
    if isinstance(base, Fraction) and isinstance(exponent, Fraction) and exponent.denominator == 1:
        if base == 0 and exponent < 0:
            raise FaultError("a division by zero")
        bits = max(base.numerator.bit_length(), base.denominator.bit_length()) * abs(exponent)
        if bits > 2 * _BITS:
            raise LimitError(f"a number of more than {_BITS} bits")
        return _bounded(Fraction(base**exponent.numerator))
    if not isinstance(exponent, Fraction):
        raise FaultError("an exponent that is no number")
    return _bounded(_simple(_symbolic(base) ** _symbolic(exponent)))


def factorial_of(value: Any) -> Fraction:
    """Return n!."""
    if not isinstance(value, Fraction) or value.denominator != 1 or value < 0:
        raise FaultError(f"the factorial of {value}, which is no whole number from 0 on")
    if value > _EXPONENT:
        raise LimitError(f"the factorial of a number above {_EXPONENT}")
    return Fraction(factorial(int(value)))


def function_of(name: str, arguments: Sequence[Any]) -> Any:
    """Return a function that all know, exactly: sqrt, cos, sin, acos, abs, pow."""
    if not all(is_number(a) for a in arguments) or len(arguments) != (2 if name == "pow" else 1):
        raise FaultError(f"{name} of {', '.join(map(_kind, arguments))}")
    if name == "pow":
        return _power(*arguments)
    functions = {"sqrt": sp.sqrt, "cos": sp.cos, "sin": sp.sin, "tan": sp.tan, "acos": sp.acos, "abs": sp.Abs}
    return _bounded(_simple(functions[name](_symbolic(arguments[0]))))


def compare(sign: str, left: Any, right: Any) -> bool:
    """Decide a comparison.

    Raises
    ------
    FaultError
        It is not decided: symbols are in it.
    """
    if sign in ("==", "!=") and not (is_number(left) and is_number(right)):
        return (left == right) == (sign == "==")
    if not (is_number(left) and is_number(right)):
        raise FaultError(f"{sign} of {_kind(left)} and {_kind(right)}")
    if isinstance(left, Fraction) and isinstance(right, Fraction):
        order = (left > right) - (left < right)
    else:
        order = _order(_symbolic(left) - _symbolic(right))
    return {"==": order == 0, "!=": order != 0, "<": order < 0, ">": order > 0, "<=": order <= 0, ">=": order >= 0}[
        sign
    ]


def _order(difference: Any) -> int:
    if difference.free_symbols:
        if sp.expand(difference) == 0:
            return 0
        raise FaultError(f"a condition that is not decided: the sign of {difference}")
    if difference.equals(0):
        return 0
    if difference.is_positive:
        return 1
    if difference.is_negative:
        return -1
    raise FaultError(f"a condition that is not decided: the sign of {difference}")


def index_of(value: Any, length: int) -> int:
    """Return an index into a list.

    Raises
    ------
    FaultError
        It is no whole number from 0 to the length less one.
    """
    if not isinstance(value, Fraction) or value.denominator != 1 or not 0 <= value < length:
        raise FaultError(f"the index {value} of a list of {length}")
    return int(value)


def _is_zero(value: Any) -> bool:
    return bool(value == 0)


def _symbolic(value: Any) -> Any:
    return sp.Rational(value.numerator, value.denominator) if isinstance(value, Fraction) else value


def _simple(value: Any) -> Any:
    return Fraction(int(value.p), int(value.q)) if isinstance(value, sp.Rational) else value


def _bounded(value: Any) -> Any:
    if isinstance(value, Fraction):
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > _BITS:
            raise LimitError(f"a number of more than {_BITS} bits")
        return value
    if value.has(sp.nan, sp.zoo, sp.oo):
        raise FaultError("a division by zero")
    for size, node in enumerate(sp.preorder_traversal(value)):
        if size == _SYMBOLIC:
            raise LimitError(f"an expression of more than {_SYMBOLIC} parts")
        if isinstance(node, sp.Rational) and max(int(node.p).bit_length(), int(node.q).bit_length()) > _BITS:
            raise LimitError(f"a number of more than {_BITS} bits")
        if isinstance(node, sp.Pow) and node.exp.is_Rational and abs(node.exp) > _EXPONENT:
            raise LimitError(f"an exponent above {_EXPONENT}")
    return _simple(value)


def _kind(value: Any) -> str:
    if value is None:
        return "nothing"
    names = {bool: "a truth value", list: "a list", dict: "a record", Vector: "a point", Fraction: "a number"}
    return names.get(type(value), "a function" if callable(value) else "an expression")
