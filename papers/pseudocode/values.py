"""Exact values of running code: fractions, expressions of SymPy, truth, lists and records, and what operators do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from math import factorial, isqrt
from numbers import Number
from typing import Any

import sympy as sp

from semispline.papers.pseudocode.errors import CodeFaultError, CodeLimitError, OpenConditionError


class Unset(Enum):
    """What a place holds that was made and given no value."""

    UNSET = "no value yet"


@dataclass(frozen=True)
class Limits:
    """How far a program may go.

    Attributes
    ----------
    steps : int
        Parts of the code that are worked out.
    depth : int
        Calls within calls.
    bits : int
        Of a numerator or a denominator.
    exponent : int
    items : int
        Of a list.
    parts : int
        Of an expression.
    """

    steps: int = 20_000
    depth: int = 60
    bits: int = 20_000
    exponent: int = 1_000
    items: int = 10_000
    parts: int = 10_000


def is_number(value: Any) -> bool:
    """Tell whether a value is a number: exact, an expression, or something that computes as one."""
    return not isinstance(value, bool | str | list | dict | Unset | type(None)) and not callable(value)


def as_number(value: Any) -> Any:
    """Return a number of Python or SymPy as the interpreter has it.

    Raises
    ------
    CodeFaultError
        A float, an expression with one, or what does not compute.
    """
    if isinstance(value, bool | str | Fraction | Unset | type(None)) or callable(value):
        return value
    if isinstance(value, int):
        return Fraction(value)
    if isinstance(value, sp.Rational):
        return Fraction(int(value.p), int(value.q))
    if (
        isinstance(value, Number)
        or not hasattr(value, "__add__")
        or (isinstance(value, sp.Basic) and value.has(sp.Float))
    ):
        raise CodeFaultError(f"found {type(value).__name__} {shown(value)}, expected an exact number")
    return value


def as_given(value: Any) -> Any:
    """Return a value of Python's as the interpreter has it: tuples are lists, mappings records."""
    if isinstance(value, list | tuple | sp.Tuple):
        return [as_given(item) for item in value]
    if isinstance(value, Mapping):
        return {str(name): as_given(item) for name, item in value.items()}
    return as_number(value)


def whole(value: Any, what: str) -> int:
    """Return a whole number.

    Raises
    ------
    CodeFaultError
        It is none.
    """
    if isinstance(value, sp.Basic) or not is_number(value) or value != int(value):
        raise CodeFaultError(f"found {shown(value)} for {what}, expected a whole number")
    return int(value)


def shown(value: Any) -> str:
    """Return a value as text, not too long."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        inner = ", ".join(shown(item) for item in value[:5])
        return f"[{inner}{', ..' if len(value) > 5 else ''}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {shown(item)}" for name, item in value.items()) + "}"
    text = "nothing" if value is None else value.value if isinstance(value, Unset) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def is_true(value: Any) -> bool:
    """Return a condition.

    Raises
    ------
    CodeFaultError
        It is neither true nor false: SymPy cannot decide it, or it is something else.
    """
    if isinstance(value, sp.logic.boolalg.BooleanAtom):
        return bool(value)
    if not isinstance(value, bool):
        raise (OpenConditionError if isinstance(value, sp.Basic) else CodeFaultError)(
            f"found {shown(value)} as a condition, expected true or false"
        )
    return value


def operate(sign: str, values: list[Any], limits: Limits) -> Any:
    """Return what an operator makes of its operands.

    Raises
    ------
    CodeFaultError
        It does not apply to them, they divide by zero, or the result is too large.
    """
    if sign in _COMPARISONS:
        return _compared(sign, *values)
    if any(isinstance(value, list | dict) for value in values):
        return _of_vectors(sign, values, limits)
    for value in values:
        if not is_number(value):
            raise CodeFaultError(f"found {shown(value)} with {sign}, expected numbers")
    try:
        return bounded(power(values[0], values[1], limits) if sign == "^" else _ON_NUMBERS[sign](*values), limits)
    except KeyError:
        raise CodeFaultError(f"found {sign} between numbers, expected vectors") from None


def bounded(value: Any, limits: Limits) -> Any:
    """Refuse a number that is too large, an expression of too many parts, and one with such a number in it."""
    if isinstance(value, Fraction):
        _check_bits(value.numerator, value.denominator, limits)
    if not isinstance(value, sp.Basic):
        return value
    if value.has(sp.nan, sp.zoo, sp.oo):
        raise CodeFaultError("found a division by 0")
    for count, part in enumerate(sp.preorder_traversal(value)):
        if count == limits.parts:
            raise CodeLimitError(f"found an expression of more than {limits.parts} parts")
        if isinstance(part, sp.Rational):
            _check_bits(int(part.p), int(part.q), limits)
        if isinstance(part, sp.Pow) and part.exp.is_Rational and abs(part.exp) > limits.exponent:
            raise CodeLimitError(f"found the exponent {shown(part.exp)}, expected at most {limits.exponent}")
    return value


def _check_bits(numerator: int, denominator: int, limits: Limits) -> None:
    bits = numerator.bit_length() + denominator.bit_length()
    if bits > limits.bits:
        raise CodeLimitError(f"found a number of {bits} bits, expected at most {limits.bits}")


def power(base: Any, exponent: Any, limits: Limits) -> Any:
    """Return a power: exact for whole exponents, a root for fractions of them."""
    if isinstance(exponent, Fraction) and abs(exponent) > limits.exponent:
        raise CodeLimitError(f"found the exponent {shown(exponent)}, expected at most {limits.exponent}")
    if isinstance(exponent, Fraction) and exponent.denominator == 1:
        if exponent < 0 and base == 0:
            raise CodeFaultError("found 0 to a negative power")
        if isinstance(base, Fraction) and base not in (0, 1, -1):
            # A number is not made that would be refused.
            bits = max(base.numerator.bit_length(), base.denominator.bit_length()) - 1
            if bits * abs(exponent) > limits.bits:
                raise CodeLimitError(f"found a power of more than {limits.bits} bits")
        return base ** int(exponent)
    if not isinstance(base, Fraction | sp.Basic):
        raise CodeFaultError(f"found the exponent {shown(exponent)}, expected a whole number")
    if base == 0:
        if isinstance(exponent, Fraction) and exponent > 0:
            return Fraction(0)
        raise CodeFaultError(f"found 0 to the power {shown(exponent)}")
    if isinstance(base, Fraction) and base < 0 and isinstance(exponent, Fraction):
        raise CodeFaultError(f"found {base} to the power {exponent}, expected a base that is not negative")
    return as_number(sp.Pow(_symbolic(base), _symbolic(exponent)))


def square_root(value: Any) -> Any:
    """Return the root of a number that is not negative: a fraction where it is one."""
    if isinstance(value, Fraction):
        if value < 0:
            raise CodeFaultError(f"found the root of {value}, expected a number that is not negative")
        over, under = isqrt(value.numerator), isqrt(value.denominator)
        if over * over == value.numerator and under * under == value.denominator:
            return Fraction(over, under)
    return as_number(sp.sqrt(_symbolic(value)))


def elementary(function: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a function of SymPy's for values of running code."""
    return lambda value: as_number(function(_symbolic(value)))


def _symbolic(value: Any) -> Any:
    if isinstance(value, Fraction):
        return sp.Rational(value.numerator, value.denominator)
    if not isinstance(value, sp.Basic):
        raise CodeFaultError(f"found {shown(value)}, expected a number")
    return value


def _divided(a: Any, b: Any) -> Any:
    if b == 0:
        raise CodeFaultError(f"found {shown(a)} divided by 0")
    return a / b


def _remainder(a: Any, b: Any) -> Any:
    if b == 0:
        raise CodeFaultError(f"found the remainder of {shown(a)} divided by 0")
    return a % b


def _factorial(value: Any) -> Any:
    if isinstance(value, sp.Basic):
        return sp.factorial(value)
    number = whole(value, "a factorial")
    if number < 0:
        raise CodeFaultError(f"found the factorial of {number}, expected 0 .. {_FACTORIAL}")
    if number > _FACTORIAL:
        raise CodeLimitError(f"found the factorial of {number}, expected 0 .. {_FACTORIAL}")
    return Fraction(factorial(number))


# Its factorial has 8530 bits.
_FACTORIAL = 1000
_ON_NUMBERS: dict[str, Callable[..., Any]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "·": lambda a, b: a * b,
    "/": _divided,
    "%": _remainder,
    "div": lambda a, b: _divided(a - _remainder(a, b), b),
    "negative": lambda a: -a,
    "!": _factorial,
}
_COMPARISONS = {"==", "!=", "<", "<=", ">", ">="}


def _compared(sign: str, a: Any, b: Any) -> bool:
    if sign in ("==", "!="):
        symbolic = isinstance(a, sp.Basic) or isinstance(b, sp.Basic)
        same = _sign_of(a, b) == 0 if symbolic else bool(a == b)
        return same == (sign == "==")
    if not is_number(a) or not is_number(b):
        raise CodeFaultError(f"found {shown(a)} {sign} {shown(b)}, expected numbers")
    if isinstance(a, sp.Basic) or isinstance(b, sp.Basic):
        a, b = _sign_of(a, b), 0
    return bool({"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b}[sign])


def _sign_of(a: Any, b: Any) -> int:
    """Return the sign of a - b, as SymPy knows it.

    Raises
    ------
    CodeFaultError
        It depends on letters, or cannot be told.
    """
    apart = sp.expand(_symbolic(a) - _symbolic(b))
    if apart.is_number and apart.is_real:
        # What is far from 0 is told at once; only what may be 0 asks for algebra.
        digits = apart.evalf(_DIGITS)
        if digits.is_Float and abs(digits) > _FAR:
            return 1 if digits > 0 else -1
    if apart.is_zero or (apart.is_number and apart.equals(0)):
        return 0
    if apart.is_positive or (apart.is_number and apart.is_real and (apart > 0) is sp.true):
        return 1
    if apart.is_negative or (apart.is_number and apart.is_real and (apart < 0) is sp.true):
        return -1
    raise OpenConditionError(
        f"found the condition on {shown(a)} and {shown(b)}, which letters leave open; expected numbers"
    )


# Of a number whose sign is asked for, and from where on they show it.
_DIGITS, _FAR = 30, 1e-15


def _of_vectors(sign: str, values: list[Any], limits: Limits) -> Any:
    """Add vectors, take multiples, and products of two."""
    if sign == "negative":
        return _each(lambda a: operate("negative", [a], limits), *values)
    a, b = values
    both = isinstance(a, list | dict) and isinstance(b, list | dict)
    if sign in "+-" and both:
        return _each(lambda x, y: operate(sign, [x, y], limits), a, b)
    if sign == "·" and both:
        parts = list(_parts(_each(lambda x, y: operate("*", [x, y], limits), a, b)))
        total = parts[0]
        for part in parts[1:]:
            total = operate("+", [total, part], limits)
        return total
    if sign == "×" and both:
        return _cross(a, b, limits)
    if sign == "*" and not both:
        return (
            _each(lambda x: operate("*", [a, x], limits), b)
            if is_number(a)
            else _each(lambda x: operate("*", [x, b], limits), a)
        )
    if sign == "/" and is_number(b):
        return _each(lambda x: operate("/", [x, b], limits), a)
    raise CodeFaultError(f"found {shown(a)} {sign} {shown(b)}, expected numbers, or vectors of one size")


def _parts(vector: Any) -> list[Any]:
    return list(vector.values()) if isinstance(vector, dict) else list(vector)


def _each(function: Callable[..., Any], first: Any, *others: Any) -> Any:
    names = list(first) if isinstance(first, dict) else None
    for other in others:
        alike = type(other) is type(first) and len(other) == len(first)
        if not alike or not first or (names is not None and list(other) != names):
            raise CodeFaultError(f"found {shown(first)} and {shown(other)}, expected vectors of one size")
    made = [function(*parts) for parts in zip(_parts(first), *map(_parts, others), strict=True)]
    return dict(zip(names, made, strict=True)) if names is not None else made


def _cross(a: Any, b: Any, limits: Limits) -> Any:
    if len(a) != 3 or len(b) != 3 or type(a) is not type(b):
        raise CodeFaultError(f"found {shown(a)} × {shown(b)}, expected vectors of size 3")
    x, y = _parts(a), _parts(b)

    def minor(i: int, j: int) -> Any:
        return operate("-", [operate("*", [x[i], y[j]], limits), operate("*", [x[j], y[i]], limits)], limits)

    made = [minor(1, 2), minor(2, 0), minor(0, 1)]
    return dict(zip(a, made, strict=True)) if isinstance(a, dict) else made


def smallest(values: Sequence[Any], sign: str = "<") -> Any:
    """Return the smallest number, or the largest one with >.

    Raises
    ------
    CodeFaultError
        There is none, one is no number, or letters leave open which one it is.
    """
    if not values or not is_number(values[0]):
        raise CodeFaultError(f"found {', '.join(map(shown, values)) or 'nothing'}, expected numbers")
    found = values[0]
    for value in values[1:]:
        if _compared(sign, value, found):
            found = value
    return found
