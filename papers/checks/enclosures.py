"""Values of expressions at numbers: a fraction where there is one, else a ball of FLINT's that holds the value."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from functools import reduce
from math import comb
from operator import add, mul
from typing import Any

import flint
import sympy as sp
from flint import arb, fmpq

from semispline.papers.checks.carrying_out import UnsuitableError
from semispline.papers.ledger import Meaning, UndefinedError, interpret

# Of a first try; each further one takes twice as many.
BITS, MOST_BITS = 128, 4096


def value_at(expression: Any, at: Mapping[Any, Any]) -> Any:
    """Return the exact value of an expression as a `Fraction`, or a ball with the value in it.

    Parameters
    ----------
    expression : sympy.Expr
        Carried out.
    at : mapping
        Letter -> rational number.

    Raises
    ------
    UndefinedError
        It has no value there.
    UnsuitableError
        A function without a value here.
    """
    exact = exact_value(expression, at)
    if exact is not None:
        return exact
    with precision(BITS):
        return enclosure(expression, at)


def exact_value(expression: Any, at: Mapping[Any, Any]) -> Fraction | None:
    """Return the value as a fraction; None where an expression has none, such as a root.

    Raises
    ------
    UndefinedError
        It has no value at all.
    """
    if expression.has(sp.CRootOf):
        return None
    try:
        return Fraction(interpret(expression, Meaning(at)))
    except TypeError:
        return None


def differ_at(one: Any, other: Any, at: Mapping[Any, Any]) -> bool | None:
    """Tell whether two expressions have different values; None where they are the same as far as the balls can tell."""
    exact = [exact_value(side, at) for side in (one, other)]
    if None in exact:
        bits = BITS
        while bits <= MOST_BITS:
            with precision(bits):
                if not enclosure(one, at).overlaps(enclosure(other, at)):
                    return True
            bits *= 4
        return None
    return bool(exact[0] != exact[1])


@contextmanager
def precision(bits: int) -> Iterator[None]:
    """Compute with balls of so many bits; FLINT keeps that for the whole process."""
    before = flint.ctx.prec
    flint.ctx.prec = bits
    try:
        yield
    finally:
        flint.ctx.prec = before


def enclosure(expression: Any, at: Mapping[Any, Any] | None = None) -> Any:
    """Return a ball that holds the value of an expression that is carried out.

    Raises
    ------
    UndefinedError
        It has no real value, or none that can be told at this precision.
    UnsuitableError
        A letter without a number, or a function without a value here.

    Examples
    --------
    >>> bool(enclosure(sp.sqrt(2) * sp.cos(sp.pi / 4)).contains(1))
    True
    """
    found = _ball(expression, dict(at or {}))
    if not found.is_finite():
        raise UndefinedError(f"{expression} has no real value at {_shown(at)}")
    return found


def _ball(e: Any, at: Mapping[Any, Any]) -> Any:
    if e in at:
        return _of_number(at[e])
    if e.is_Rational:
        return arb(fmpq(int(e.p), int(e.q)))
    if e in _CONSTANTS:
        return _CONSTANTS[e]()
    if isinstance(e, sp.CRootOf | sp.polys.rootoftools.ComplexRootOf):
        return _of_root(e)
    if e.is_Pow:
        return _power(e, at)
    rule = next((rule for kind, rule in _RULES.items() if isinstance(e, kind)), None)
    if rule is None:
        what = "a letter without a number" if not e.args else f"the function {type(e).__name__}"
        raise UnsuitableError(f"value of {e}: found {what}, expected numbers and elementary functions")
    return rule(*(_ball(argument, at) for argument in e.args))


def _of_number(number: Any) -> Any:
    if isinstance(number, arb):
        return number
    fraction = Fraction(int(number.p), int(number.q)) if isinstance(number, sp.Rational) else Fraction(number)
    return arb(fmpq(fraction.numerator, fraction.denominator))


def _power(e: Any, at: Mapping[Any, Any]) -> Any:
    base, exponent = e.base, e.exp
    if base is sp.E:
        return _ball(exponent, at).exp()
    value = _ball(base, at)
    if exponent.is_Integer:
        if exponent < 0 and value.contains(0):
            raise UndefinedError(f"division by zero in {e}, or by what cannot be told from zero")
        return value ** int(exponent)
    if exponent.is_Rational:
        # A ball of something that is zero may reach below it.
        root = value.nonnegative_part() if value.contains(0) else value
        return root.root(int(exponent.q)) ** int(exponent.p)
    return value ** _ball(exponent, at)


def _of_root(e: Any) -> Any:
    """Return a real root of a polynomial, narrowed to twice as many digits as the balls have."""
    if not e.is_real:
        raise UnsuitableError(f"value of {e}: found a complex number, expected a real one")
    width = sp.Rational(1, 2 ** (flint.ctx.prec + 8))
    middle = e.eval_rational(dx=width)
    return _of_number(middle - width).union(_of_number(middle + width))


def _whole(ball: Any) -> int:
    number = ball.unique_fmpz()
    if number is None:
        raise UndefinedError(f"found {ball}, expected a whole number")
    return int(number)


def _factorial(ball: Any) -> Any:
    number = _whole(ball)
    if number < 0:
        raise UndefinedError(f"the factorial of {number}")
    return arb(number).gamma() * number if number else arb(1)


def _binomial(n: Any, k: Any) -> Any:
    n, k = _whole(n), _whole(k)
    return arb(comb(n, k)) if 0 <= k <= n else arb(0)


_CONSTANTS: Mapping[Any, Callable[[], Any]] = {sp.pi: arb.pi, sp.E: arb.const_e, sp.EulerGamma: arb.const_euler}
_RULES: Mapping[Any, Callable[..., Any]] = {
    sp.Add: lambda *terms: reduce(add, terms),
    sp.Mul: lambda *factors: reduce(mul, factors),
    sp.Abs: abs,
    sp.sin: arb.sin,
    sp.cos: arb.cos,
    sp.tan: arb.tan,
    sp.cot: arb.cot,
    sp.sec: arb.sec,
    sp.csc: arb.csc,
    sp.asin: arb.asin,
    sp.acos: arb.acos,
    sp.atan: arb.atan,
    sp.atan2: arb.atan2,
    sp.sinh: arb.sinh,
    sp.cosh: arb.cosh,
    sp.tanh: arb.tanh,
    sp.exp: arb.exp,
    sp.log: arb.log,
    sp.gamma: arb.gamma,
    sp.erf: arb.erf,
    sp.factorial: _factorial,
    sp.binomial: _binomial,
    sp.Max: lambda *values: reduce(lambda a, b: a.max(b), values),
    sp.Min: lambda *values: reduce(lambda a, b: a.min(b), values),
}


def _shown(at: Mapping[Any, Any] | None) -> str:
    return ", ".join(f"{letter} = {number}" for letter, number in (at or {}).items()) or "these numbers"
