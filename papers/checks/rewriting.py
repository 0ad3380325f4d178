"""Printed expressions as rational functions of letters: roots, angles, factorials and powers become letters.

A root is a letter whose power is known, a cosine and a sine two letters on the unit circle, a factorial of n + 2 is
(n + 1)(n + 2) times the letter n!, a power x^(n+1) is x times the letter x^n. What is zero as a rational function of
such letters is zero, whatever the letters are; what is not may still be zero, which only values can tell.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import lcm
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from semispline.papers.checks.carrying_out import UnsuitableError
from semispline.papers.checks.instances import as_letters

_FACTORIALS = (sp.factorial, sp.binomial, sp.gamma)
_ANGLES = (sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc)
# Functions that stay letters: two are the same where their arguments are.
_OPAQUE = (sp.log, sp.asin, sp.acos, sp.atan, sp.atan2, sp.sinh, sp.cosh, sp.tanh)


@dataclass(frozen=True)
class Root:
    """A letter whose power is known.

    Attributes
    ----------
    letter : sympy.Symbol
    radicand : sympy.Expr
        In letters that were made before.
    degree : int
        letter**degree = radicand.
    """

    letter: Any
    radicand: Any
    degree: int


@dataclass
class Rewriting:
    """Letters that stand for parts of some expressions; `rational` makes new ones as it meets such parts.

    Attributes
    ----------
    meaning : dict
        Letter -> the part that it stands for.
    roots : list of Root
        Those of the letters whose power is known, in the order in which they were made.
    """

    meaning: dict[Any, Any] = field(default_factory=dict)
    roots: list[Root] = field(default_factory=list)
    _letters: dict[Any, Any] = field(default_factory=dict)
    # Angle -> the whole number that it is divided by, so that all angles met are multiples.
    _divisors: dict[Any, int] = field(default_factory=dict)

    @property
    def is_free(self) -> bool:
        """Whether no letter stands for anything that another one may determine.

        Indexed letters, and values of functions of which nothing is known, are as free as letters.
        """
        return all(isinstance(part, sp.Indexed | AppliedUndef) for part in self.meaning.values())

    def prepare(self, expressions: Iterable[Any]) -> None:
        """Look at all expressions that are to be compared, so that their angles become multiples of the same ones."""
        for expression in expressions:
            for node in expression.atoms(*_ANGLES):
                for angle, multiple in _multiples(node.args[0]).items():
                    self._divisors[angle] = lcm(self._divisors.get(angle, 1), int(multiple.q))

    def rational(self, expression: Any) -> Any:  # noqa: PLR0911  # one for each kind of node
        """Return an expression as a rational function of letters.

        Raises
        ------
        UnsuitableError
            A float, or a function that is none of these.
        """
        e = expression
        if e.is_Float:
            raise UnsuitableError(f"found the float {e}, expected exact numbers: Rational(1, 3), Rational('0.25')")
        if e.is_Rational or e.is_Symbol:
            return e
        if e.is_Add or e.is_Mul:
            return e.func(*map(self.rational, e.args))
        if isinstance(e, sp.exp):
            return self._power(sp.E, e.args[0])
        if e.is_Pow:
            return self._power(e.base, e.exp)
        if isinstance(e, _ANGLES):
            return self._angle_function(e)
        if isinstance(e, _FACTORIALS):
            return self._factorial_function(e)
        if isinstance(e, sp.Abs):
            return self._root(e, self.rational(e.args[0]) ** 2, 2)
        if e is sp.I:
            return self._root(e, sp.Integer(-1), 2)
        if isinstance(e, sp.Indexed | AppliedUndef):
            letter = as_letters(e)
            self.meaning[letter] = e
            return letter
        if isinstance(e, sp.Derivative) or e in (sp.pi, sp.E) or isinstance(e, _OPAQUE):
            return self._letter(e, e)
        raise UnsuitableError(
            f"found {e} ({type(e).__name__}), expected sums, products, quotients, powers, roots, factorials and "
            "functions of angles; or say what it stands for (where=...)"
        )

    def back(self, expression: Any) -> Any:
        """Put the parts back for which letters stand."""
        return expression.xreplace(self.meaning)

    def _letter(self, key: Any, meaning: Any, name: str = "l") -> Any:
        if key not in self._letters:
            letter = sp.Symbol(f"{name}{len(self._letters) + 1}'")
            self._letters[key] = letter
            self.meaning[letter] = meaning
        return self._letters[key]

    def _root(self, meaning: Any, radicand: Any, degree: int, name: str = "r") -> Any:
        key = ("root", radicand, degree)
        if key not in self._letters:
            letter = self._letter(key, meaning, name)
            self.roots.append(Root(letter, radicand, degree))
        return self._letters[key]

    def _power(self, base: Any, exponent: Any) -> Any:  # noqa: PLR0911  # one for each kind of power
        if exponent.is_Integer:
            return self.rational(base) ** exponent
        if exponent.is_Rational:
            if base is sp.E:
                base = self._letter(sp.E, sp.E)
                return self._root(sp.E ** sp.Rational(1, exponent.q), base, int(exponent.q)) ** exponent.p
            if base.is_Rational and base > 1 and not sp.isprime(base):
                # The root of 6 is that of 2 times that of 3.
                primes = sp.factorrat(base).items()
                return sp.Mul(*(self._power(sp.Integer(prime), n * exponent) for prime, n in primes))
            radicand = self.rational(base)
            return self._root(base ** sp.Rational(1, exponent.q), radicand, int(exponent.q)) ** exponent.p
        if exponent.is_integer and base.is_Mul:
            return sp.Mul(*(self._power(factor, exponent) for factor in base.args))
        if exponent.is_integer and base.is_Rational and base not in (-1, 1) and base != 0:
            return self._power_of_number(base, exponent)
        return self._power_of_letters(base, exponent)

    def _power_of_number(self, base: Any, exponent: Any) -> Any:
        primes = {sp.Integer(p): n for p, n in sp.factorrat(abs(base)).items()}
        sign = self._power_of_letters(sp.Integer(-1), exponent) if base < 0 else sp.Integer(1)
        return sp.Mul(sign, *(self._power_of_letters(p, n * exponent) for p, n in primes.items()))

    def _power_of_letters(self, base: Any, exponent: Any) -> Any:
        """Return b^(2n + m + 3) as (b^n)^2 b^m b^3; of -1 the square of such a letter is 1."""
        product: Any = sp.Integer(1)
        for part, multiple in _multiples(exponent).items():
            if part == 1:
                product *= self._power(base, multiple)
                continue
            unit = part / multiple.q
            if base == -1 and multiple.q == 1 and part.is_integer:
                letter = self._sign(unit)
            else:
                letter = self._letter(("power", self.rational(base), unit), base**unit, "p")
            product *= letter**multiple.p
        return product

    def _sign(self, exponent: Any) -> Any:
        key = ("sign", exponent)
        if key not in self._letters:
            self.roots.append(Root(self._letter(key, (-1) ** exponent, "s"), sp.Integer(1), 2))
        return self._letters[key]

    def _factorial_function(self, e: Any) -> Any:
        if isinstance(e, sp.factorial):
            return self._factorial(e.args[0])
        if isinstance(e, sp.gamma):
            return self._factorial(e.args[0] - 1)
        n, k = e.args
        return self._factorial(n) / (self._factorial(k) * self._factorial(n - k))

    def _factorial(self, argument: Any) -> Any:
        argument = sp.expand(argument)
        whole = sp.floor(argument.as_coeff_Add()[0])
        rest = argument - whole
        if rest == 0:
            return sp.factorial(whole)
        letter = self._letter(("factorial", rest), sp.factorial(rest), "f")
        if whole >= 0:
            return letter * sp.Mul(*(rest + j for j in range(1, int(whole) + 1)))
        return letter / sp.Mul(*(rest + j for j in range(int(whole) + 1, 1)))

    def _angle_function(self, e: Any) -> Any:
        cosine, sine = self._cosine_and_sine(e.args[0])
        if isinstance(e, sp.cos):
            return cosine
        if isinstance(e, sp.sin):
            return sine
        if isinstance(e, sp.tan):
            return sine / cosine
        if isinstance(e, sp.cot):
            return cosine / sine
        return 1 / cosine if isinstance(e, sp.sec) else 1 / sine

    def _cosine_and_sine(self, argument: Any) -> tuple[Any, Any]:
        """Return both of a sum of multiples of angles, by the formula for sums."""
        cosine: Any = sp.Integer(1)
        sine: Any = sp.Integer(0)
        for angle, multiple in _multiples(argument).items():
            if angle == sp.pi:
                more = sp.cos(angle * multiple), sp.sin(angle * multiple)
                c, s = (self.rational(x) if not isinstance(x, _ANGLES) else self._letter(x, x) for x in more)
            else:
                divisor = self._divisors.get(angle, int(multiple.q))
                c, s = self._multiple(angle / divisor, int(multiple * divisor))
            cosine, sine = cosine * c - sine * s, cosine * s + sine * c
        return cosine, sine

    def _multiple(self, angle: Any, times: int) -> tuple[Any, Any]:
        c = self._letter(("cosine", angle), sp.cos(angle), "c")
        key = ("sine", angle)
        if key not in self._letters:
            self.roots.append(Root(self._letter(key, sp.sin(angle), "s"), 1 - c**2, 2))
        s = self._letters[key]
        n = abs(times)
        cosine = sum((-1) ** (j // 2) * sp.binomial(n, j) * c ** (n - j) * s**j for j in range(0, n + 1, 2))
        sine = sum((-1) ** (j // 2) * sp.binomial(n, j) * c ** (n - j) * s**j for j in range(1, n + 1, 2))
        return cosine, sine if times >= 0 else -sine


def _multiples(expression: Any) -> dict[Any, Any]:
    """Return a sum as rational multiples of products of letters; the number alone is a multiple of 1.

    Examples
    --------
    >>> n, m = sp.symbols("n m")
    >>> _multiples(2 * (n - m / 3) + 1) == {n: 2, m: -sp.Rational(2, 3), sp.Integer(1): 1}
    True
    """
    found: dict[Any, Any] = {}
    for term in sp.Add.make_args(sp.expand(expression)):
        multiple, rest = term.as_coeff_Mul(rational=True)
        found[rest] = found.get(rest, 0) + multiple
    return {rest: multiple for rest, multiple in found.items() if multiple != 0}
