"""Differences of rational functions in normal form, with FLINT's polynomials: fast enough for hundreds of mutants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly_ctx

from semispline.papers.checks.rewriting import Rewriting, Root
from semispline.papers.ledger import UndefinedError


@dataclass(frozen=True)
class Difference:
    """What is left of two expressions that are compared.

    Attributes
    ----------
    zero : bool
        Whether they are the same, as rational functions of letters and with what is known of roots.
    decided : bool
        Whether no letter stands for something: then what is not zero is different.
    residual : sympy.Expr
        The first less the second, in the paper's letters.
    """

    zero: bool
    decided: bool
    residual: Any


def difference(one: Any, other: Any) -> Difference:
    """Compare two expressions that are carried out.

    Raises
    ------
    UndefinedError
        A divisor is zero.
    UnsuitableError
        A float, or a function that has no letters.

    Examples
    --------
    >>> x, n = sp.symbols("x n", positive=True, integer=True)
    >>> difference((x**2 - 1) / (x - 1), x + 2).residual
    -1
    >>> difference(sp.factorial(n + 1) / sp.factorial(n), n + 1).zero
    True
    >>> difference(sp.cos(x) ** 2 - sp.sin(x) ** 2, sp.cos(2 * x)).zero
    True
    """
    one, other = sp.sympify(one), sp.sympify(other)
    rewriting = Rewriting()
    rewriting.prepare((one, other))
    sides = [rewriting.rational(side) for side in (one, other)]
    forms = _Forms(sides, rewriting.roots)
    (n1, d1), (n2, d2) = (forms.pair(side) for side in sides)
    for side, d in ((one, d1), (other, d2)):
        if forms.reduced(d).is_zero():
            raise UndefinedError(f"division by zero in {side}")
    left = forms.reduced(n1 * d2 - n2 * d1)
    if left.is_zero():
        return Difference(True, rewriting.is_free, sp.Integer(0))
    return Difference(False, rewriting.is_free, rewriting.back(forms.expression(left, d1 * d2)))


class _Forms:
    """Fractions of polynomials over the rational numbers, in the letters of some expressions."""

    def __init__(self, expressions: Sequence[Any], roots: Sequence[Root]) -> None:
        radicands = [root.radicand for root in roots]
        letters = {s for e in (*expressions, *radicands) for s in e.free_symbols} | {root.letter for root in roots}
        self.letters = sorted(letters, key=lambda s: s.sort_key()) or [sp.Dummy()]
        self.context = fmpq_mpoly_ctx.get([f"x{i}" for i in range(len(self.letters))], Ordering.lex)
        self.generators = dict(zip(self.letters, self.context.gens(), strict=True))
        self.roots = roots
        self._pairs: dict[Any, tuple[Any, Any]] = {}

    def pair(self, e: Any) -> tuple[Any, Any]:
        """Return numerator and denominator; nothing that both share is taken from them."""
        if e not in self._pairs:
            self._pairs[e] = self._new_pair(e)
        return self._pairs[e]

    def _new_pair(self, e: Any) -> tuple[Any, Any]:
        one = self.context.constant(1)
        if e.is_Rational:
            return self.context.constant(fmpq(int(e.p), int(e.q))), one
        if e.is_Symbol:
            return self.generators[e], one
        if e.is_Pow:
            n, d = self.pair(e.base)
            power = int(e.exp)
            return (n**power, d**power) if power >= 0 else (d**-power, n**-power)
        numerator, denominator = self.pair(e.args[0])
        for argument in e.args[1:]:
            n, d = self.pair(argument)
            if e.is_Mul:
                numerator, denominator = numerator * n, denominator * d
            elif d == denominator:
                numerator = numerator + n
            else:
                common = denominator.gcd(d)
                here, there = d / common, denominator / common
                numerator, denominator = numerator * here + n * there, denominator * here
        return numerator, denominator

    def reduced(self, polynomial: Any) -> Any:
        """Put what is known of roots into a polynomial, the last root first; its denominators are left out."""
        for root in reversed(self.roots):
            polynomial = self._without_powers(polynomial, root)
        return polynomial

    def _without_powers(self, polynomial: Any, root: Root) -> Any:
        place = self.letters.index(root.letter)
        parts: dict[int, dict[tuple[int, ...], Any]] = {}
        for powers, coefficient in polynomial.to_dict().items():
            times, rest = divmod(powers[place], root.degree)
            kept = (*powers[:place], rest, *powers[place + 1 :])
            part = parts.setdefault(times, {})
            part[kept] = part.get(kept, 0) + coefficient
        highest = max(parts, default=0)
        if highest == 0:
            return polynomial
        n, d = self.pair(root.radicand)
        total = self.context.constant(0)
        for times, part in parts.items():
            total = total + self.context.from_dict(part) * n**times * d ** (highest - times)
        # A radicand may hold roots that were made before, and these powers of their own.
        return total

    def expression(self, numerator: Any, denominator: Any) -> Any:
        """Return a fraction in lowest terms."""
        common = numerator.gcd(denominator)
        return self._expression(numerator / common) / self._expression(denominator / common)

    def _expression(self, polynomial: Any) -> Any:
        return sp.Add(
            *(
                sp.Mul(
                    sp.Rational(int(coefficient.p), int(coefficient.q)),
                    *(letter**power for letter, power in zip(self.letters, powers, strict=True) if power),
                )
                for powers, coefficient in polynomial.to_dict().items()
            )
        )
