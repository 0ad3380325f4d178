"""Numbers between two fractions, with Python's `fractions` alone: series and bisection, each with its error."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import isqrt

from semispline.papers.recheck.arithmetic import TextError, parsed

# Ends are rounded outward to this many binary places, so that fractions stay short.
_PLACES = 200
_UNIT = Fraction(1, 2**_PLACES)


@dataclass(frozen=True)
class Interval:
    """All numbers from low to high."""

    low: Fraction
    high: Fraction

    def __add__(self, other: Interval) -> Interval:
        return Interval(self.low + other.low, self.high + other.high)

    def __neg__(self) -> Interval:
        return Interval(-self.high, -self.low)

    def __sub__(self, other: Interval) -> Interval:
        return self + (-other)

    def __mul__(self, other: Interval) -> Interval:
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return _outward(min(ends), max(ends))

    def __truediv__(self, other: Interval) -> Interval:
        if other.low <= 0 <= other.high:
            raise TextError(f"division by {other}, which may be 0")
        return self * Interval(1 / other.high, 1 / other.low)

    def __pow__(self, power: int) -> Interval:
        product = Interval(Fraction(1), Fraction(1))
        for _ in range(abs(power)):
            product = product * self
        return product if power >= 0 else Interval(Fraction(1), Fraction(1)) / product


def enclosed(text: str) -> Interval:
    """Return an interval that holds the number that a text is.

    Examples
    --------
    >>> found = enclosed("sqrt(2)*cos(Pi/4)")
    >>> found.low <= 1 <= found.high, found.high - found.low < Fraction(1, 10**50)
    (True, True)
    """
    return _of(parsed(text))


def _of(node: ast.expr) -> Interval:  # noqa: PLR0911  # one for each kind of node
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return Interval(Fraction(node.value), Fraction(node.value))
    if isinstance(node, ast.Name) and node.id == "Pi":
        return _PI
    if isinstance(node, ast.UnaryOp):
        inner = _of(node.operand)
        return -inner if isinstance(node.op, ast.USub) else inner
    if isinstance(node, ast.BinOp):
        left = _of(node.left)
        if isinstance(node.op, ast.Pow):
            power = _of(node.right)
            if power.low != power.high or power.low.denominator != 1:
                raise TextError(f"power: found {ast.unparse(node.right)}, expected a whole number")
            return left ** int(power.low)
        right = _of(node.right)
        if isinstance(node.op, ast.Add):
            return left + right
        if isinstance(node.op, ast.Sub):
            return left - right
        return left * right if isinstance(node.op, ast.Mult) else left / right
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        if node.func.id == "real_root":
            return _real_root(node.args[0], int(_of(node.args[1]).low))
        if node.func.id == "sqrtn":
            return _root(_of(node.args[0]), int(_of(node.args[1]).low))
        return _FUNCTIONS[node.func.id](_of(node.args[0]))
    raise TextError(f"number: found {ast.unparse(node)}, expected whole numbers, Pi, + - * / ^ and functions")


def _outward(low: Fraction, high: Fraction) -> Interval:
    return Interval(Fraction(low // _UNIT) * _UNIT, -Fraction(-high // _UNIT) * _UNIT)


def _monotone(function: Callable[[Fraction], Interval], x: Interval) -> Interval:
    return Interval(function(x.low).low, function(x.high).high)


def _root(x: Interval, degree: int) -> Interval:
    if x.low < 0:
        raise TextError(f"root of {x}, which may be negative")

    def of(number: Fraction) -> Interval:
        scaled = int(number * 2 ** (degree * _PLACES))
        root = _whole_root(scaled, degree)
        return Interval(root * _UNIT, (root + 1) * _UNIT)

    return _monotone(of, x)


def _whole_root(number: int, degree: int) -> int:
    """Return the largest whole number whose power is not above another one."""
    if degree == 2:
        return isqrt(number)
    low, high = 0, 1 << (number.bit_length() // degree + 1)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if middle**degree <= number else (low, middle)
    return low


def _summed(first: Fraction, ratio: Callable[[int], Fraction]) -> Interval:
    """Sum terms up to where each is at most half as large as the one before."""
    total, term, n = Fraction(0), first, 0
    while abs(term) > _UNIT or n < 4 or abs(ratio(n)) > Fraction(1, 2):
        total += term
        term = term * ratio(n)
        term = Fraction(term // (_UNIT / 2**40)) * (_UNIT / 2**40)
        n += 1
    # Each of n terms is off by less than a small part of a unit; what follows is below twice the last one.
    return Interval(total - 4 * _UNIT, total + 4 * _UNIT)


def _exp(x: Interval) -> Interval:
    return _monotone(lambda a: _summed(Fraction(1), lambda n: a / (n + 1)), x)


def _sine(a: Fraction) -> Interval:
    return _summed(a, lambda n: -a * a / ((2 * n + 2) * (2 * n + 3)))


def _cosine(a: Fraction) -> Interval:
    return _summed(Fraction(1), lambda n: -a * a / ((2 * n + 1) * (2 * n + 2)))


def _near(function: Callable[[Fraction], Interval], x: Interval) -> Interval:
    """Return the values of a function whose slope is at most 1."""
    middle, half = (x.low + x.high) / 2, (x.high - x.low) / 2
    middle = Fraction(middle // _UNIT) * _UNIT
    found = function(middle)
    return _outward(found.low - half - _UNIT, found.high + half + _UNIT)


def _atan(x: Interval) -> Interval:
    return _near(_arctangent, x)


def _arctangent(a: Fraction) -> Interval:
    if abs(a) > Fraction(1, 2):
        # atan a = 2 atan(a / (1 + sqrt(1 + a^2)))
        square = Interval(1 + a * a, 1 + a * a)
        half = Interval(a, a) / (Interval(Fraction(1), Fraction(1)) + _root(square, 2))
        return Interval(Fraction(2), Fraction(2)) * _atan(half)
    return _summed(a, lambda n: -a * a * Fraction(2 * n + 1, 2 * n + 3))


def _log(x: Interval) -> Interval:
    """By log x = k log 2 + 2 artanh((y - 1)/(y + 1)), x = 2^k y, y from 2/3 to 4/3."""
    if x.low <= 0:
        raise TextError(f"logarithm of {x}, which may not be positive")

    def of(number: Fraction) -> Interval:
        power = 0
        while number > Fraction(4, 3):
            number, power = number / 2, power + 1
        while number < Fraction(2, 3):
            number, power = number * 2, power - 1
        twos = _TWO_ARTANH_OF_THIRD * Interval(Fraction(power), Fraction(power))
        return twos + _two_artanh((number - 1) / (number + 1))

    return _monotone(of, x)


def _two_artanh(a: Fraction) -> Interval:
    return _summed(2 * a, lambda n: a * a * Fraction(2 * n + 1, 2 * n + 3))


def _asin(x: Interval) -> Interval:
    """By the arctangent: asin x = atan(x / sqrt(1 - x^2)), between -1 and 1."""
    one = Interval(Fraction(1), Fraction(1))
    return _atan(x / _root(one - x * x, 2))


def _acos(x: Interval) -> Interval:
    return _PI / Interval(Fraction(2), Fraction(2)) - _asin(x)


def _tangent(x: Interval) -> Interval:
    return _near(_sine, x) / _near(_cosine, x)


def _real_root(polynomial: ast.expr, number: int) -> Interval:
    """Bisect between numbers where the signs of a polynomial in x_ and the numbers of its roots differ (Sturm)."""
    chain = _sturm(_coefficients(polynomial))
    bound = 1 + max(abs(c) for c in chain[0]) / abs(chain[0][-1])
    low, high = -bound, bound

    def below(at: Fraction) -> int:
        return _changes(chain, -bound) - _changes(chain, at)

    if not 1 <= number <= below(high):
        raise TextError(f"real_root: found number {number}, expected 1 .. {below(high)}")
    while high - low > _UNIT:
        middle = (low + high) / 2
        low, high = (low, middle) if below(middle) >= number else (middle, high)
    return Interval(low, high)


def _coefficients(node: ast.expr) -> list[Fraction]:  # noqa: PLR0911  # one for each kind of node
    """Return the coefficients of a polynomial in x_, the lowest power first."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return [Fraction(node.value)]
    if isinstance(node, ast.Name) and node.id == "x_":
        return [Fraction(0), Fraction(1)]
    if isinstance(node, ast.UnaryOp):
        return [-c if isinstance(node.op, ast.USub) else c for c in _coefficients(node.operand)]
    if isinstance(node, ast.BinOp):
        left, right = _coefficients(node.left), _coefficients(node.right)
        if isinstance(node.op, ast.Pow):
            product = [Fraction(1)]
            for _ in range(int(right[0])):
                product = _multiplied(product, left)
            return product
        if isinstance(node.op, ast.Mult):
            return _multiplied(left, right)
        if isinstance(node.op, ast.Div):
            return [c / right[0] for c in left]
        size = max(len(left), len(right))
        padded = [[*side, *[Fraction(0)] * (size - len(side))] for side in (left, right)]
        sign = 1 if isinstance(node.op, ast.Add) else -1
        return [a + sign * b for a, b in zip(*padded, strict=True)]
    raise TextError(f"polynomial: found {ast.unparse(node)}, expected one in x_")


def _multiplied(one: Sequence[Fraction], other: Sequence[Fraction]) -> list[Fraction]:
    found = [Fraction(0)] * (len(one) + len(other) - 1)
    for i, a in enumerate(one):
        for j, b in enumerate(other):
            found[i + j] += a * b
    return found


def _sturm(p: list[Fraction]) -> list[list[Fraction]]:
    chain = [_trimmed(p), _trimmed([n * c for n, c in enumerate(p)][1:])]
    while len(chain[-1]) > 1:
        rest = list(chain[-2])
        divisor = chain[-1]
        while len(rest) >= len(divisor):
            factor = rest[-1] / divisor[-1]
            for i in range(len(divisor)):
                rest[len(rest) - len(divisor) + i] -= factor * divisor[i]
            rest.pop()
        rest = _trimmed(rest)
        if not rest:
            break
        chain.append([-c for c in rest])
    return chain


def _trimmed(p: list[Fraction]) -> list[Fraction]:
    p = list(p)
    while p and p[-1] == 0:
        p.pop()
    return p


def _changes(chain: Sequence[Sequence[Fraction]], at: Fraction) -> int:
    signs = []
    for p in chain:
        total = Fraction(0)
        for c in reversed(p):
            total = total * at + c
        if total:
            signs.append(total > 0)
    return sum(a != b for a, b in pairwise(signs))


_FUNCTIONS: dict[str, Callable[[Interval], Interval]] = {
    "sqrt": lambda x: _root(x, 2),
    "exp": _exp,
    "log": _log,
    "sin": lambda x: _near(_sine, x),
    "cos": lambda x: _near(_cosine, x),
    "tan": _tangent,
    "asin": _asin,
    "acos": _acos,
    "atan": _atan,
}
# This is log 2.
_TWO_ARTANH_OF_THIRD = _two_artanh(Fraction(1, 3))
# Machin: pi/4 = 4 atan 1/5 - atan 1/239.
_SIXTEEN, _FOUR = Interval(Fraction(16), Fraction(16)), Interval(Fraction(4), Fraction(4))
_PI = _SIXTEEN * _arctangent(Fraction(1, 5)) - _FOUR * _arctangent(Fraction(1, 239))
