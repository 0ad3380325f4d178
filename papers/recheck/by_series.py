"""Power series at 0 with Python's `fractions` alone: lists of coefficients, the constant one first."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from fractions import Fraction
from math import isqrt

from semispline.papers.recheck.arithmetic import TextError, parsed

Series = list[Fraction]


def series_of(text: str, variable: str, count: int, at: Mapping[str, Fraction]) -> Series:
    """Return the first coefficients of an expression of one variable, with numbers for all other names.

    Raises
    ------
    TextError
        It has no such series with rational coefficients, or no rule here.

    Examples
    --------
    >>> [str(c) for c in series_of("sin(x)/(1 - x)", "x", 4, {})]
    ['0', '1', '1', '5/6']
    """
    return _Rules(variable, count, at).of(parsed(text))


class _Rules:
    """Arithmetic of series up to a length."""

    def __init__(self, variable: str, count: int, at: Mapping[str, Fraction]) -> None:
        self.variable, self.count, self.at = variable, count, at

    def of(self, node: ast.expr) -> Series:  # one for each kind of node
        if isinstance(node, ast.Constant) and isinstance(node.value, int):
            return self._constant(Fraction(node.value))
        if isinstance(node, ast.Name):
            if node.id == self.variable:
                return (self._constant(Fraction(0))[:1] + [Fraction(1)] + [Fraction(0)] * self.count)[: self.count]
            return self._constant(self.at[node.id])
        if isinstance(node, ast.UnaryOp):
            inner = self.of(node.operand)
            return [-c for c in inner] if isinstance(node.op, ast.USub) else inner
        if isinstance(node, ast.BinOp):
            return self._operated(node)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            rule = _FUNCTIONS.get(node.func.id)
            if rule is not None:
                return rule(self, self.of(node.args[0]))
        raise TextError(f"series: found {ast.unparse(node)}, expected arithmetic and elementary functions")

    def _constant(self, number: Fraction) -> Series:
        return [number] + [Fraction(0)] * (self.count - 1)

    def _operated(self, node: ast.BinOp) -> Series:
        left = self.of(node.left)
        if isinstance(node.op, ast.Pow):
            power = self.of(node.right)
            if any(power[1:]) or power[0].denominator != 1:
                raise TextError(f"series: found the power {ast.unparse(node.right)}, expected a whole number")
            product = self._constant(Fraction(1))
            for _ in range(abs(int(power[0]))):
                product = self.product(product, left)
            return product if power[0] >= 0 else self.quotient(self._constant(Fraction(1)), product)
        right = self.of(node.right)
        if isinstance(node.op, ast.Add):
            return [a + b for a, b in zip(left, right, strict=True)]
        if isinstance(node.op, ast.Sub):
            return [a - b for a, b in zip(left, right, strict=True)]
        return self.product(left, right) if isinstance(node.op, ast.Mult) else self.quotient(left, right)

    def product(self, one: Series, other: Series) -> Series:
        """Return a product."""
        return [sum((one[i] * other[n - i] for i in range(n + 1)), Fraction(0)) for n in range(self.count)]

    def quotient(self, one: Series, other: Series) -> Series:
        """Return a quotient by a series that does not vanish at 0."""
        if other[0] == 0:
            raise TextError("series: found a division by a series that vanishes at 0")
        found: Series = []
        for n in range(self.count):
            rest = one[n] - sum((found[i] * other[n - i] for i in range(n)), Fraction(0))
            found.append(rest / other[0])
        return found

    def primitive(self, slope: Series, first: Fraction) -> Series:
        """Return the series with this derivative, and this value at 0."""
        return ([first] + [c / (n + 1) for n, c in enumerate(slope)])[: self.count]

    def slope(self, one: Series) -> Series:
        """Return the derivative; its last coefficient, which is not known, is 0."""
        return [*(n * c for n, c in enumerate(one) if n), Fraction(0)]

    def exponential(self, one: Series) -> Series:
        """Return exp, by its own derivative."""
        self._vanishes(one, "exp")
        found = [Fraction(1)]
        for n in range(1, self.count):
            found.append(sum((k * one[k] * found[n - k] for k in range(1, n + 1)), Fraction(0)) / n)
        return found

    def sine_and_cosine(self, one: Series) -> tuple[Series, Series]:
        """Return both, each by the derivative of the other."""
        self._vanishes(one, "sin or cos")
        sine, cosine = [Fraction(0)], [Fraction(1)]
        for n in range(1, self.count):
            terms = [(k * one[k], n - k) for k in range(1, n + 1)]
            sine.append(sum((c * cosine[i] for c, i in terms), Fraction(0)) / n)
            cosine.append(-sum((c * sine[i] for c, i in terms), Fraction(0)) / n)
        return sine, cosine

    def logarithm(self, one: Series) -> Series:
        """Return log of a series that begins with 1."""
        if one[0] != 1:
            raise TextError("series: found the logarithm of something that is not 1 at 0")
        return self.primitive(self.quotient(self.slope(one), one), Fraction(0))

    def arctangent(self, one: Series) -> Series:
        """Return atan, by its derivative."""
        self._vanishes(one, "atan")
        square = self.product(one, one)
        return self.primitive(self.quotient(self.slope(one), [square[0] + 1, *square[1:]]), Fraction(0))

    def arcsine(self, one: Series) -> Series:
        """Return asin, by its derivative."""
        self._vanishes(one, "asin")
        square = [-c for c in self.product(one, one)]
        return self.primitive(self.quotient(self.slope(one), self.root([square[0] + 1, *square[1:]])), Fraction(0))

    def root(self, one: Series) -> Series:
        """Return the square root of a series that begins with a square."""
        over, under = isqrt(max(one[0].numerator, 0)), isqrt(one[0].denominator)
        first = Fraction(over, under)
        if first * first != one[0] or first == 0:
            raise TextError(f"series: found the root of a series that is {one[0]} at 0, expected a square")
        found = [first]
        for n in range(1, self.count):
            rest = one[n] - sum((found[i] * found[n - i] for i in range(1, n)), Fraction(0))
            found.append(rest / (2 * first))
        return found

    @staticmethod
    def _vanishes(one: Series, name: str) -> None:
        if one[0] != 0:
            raise TextError(f"series: found {name} of a series that is {one[0]} at 0, expected 0")


_FUNCTIONS: dict[str, Callable[[_Rules, Series], Series]] = {
    "exp": _Rules.exponential,
    "log": _Rules.logarithm,
    "sin": lambda rules, one: rules.sine_and_cosine(one)[0],
    "cos": lambda rules, one: rules.sine_and_cosine(one)[1],
    "tan": lambda rules, one: rules.quotient(*rules.sine_and_cosine(one)),
    "atan": _Rules.arctangent,
    "asin": _Rules.arcsine,
    "sqrt": _Rules.root,
}
