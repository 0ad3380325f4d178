"""Arithmetic with roots, with Python's `fractions` alone: polynomials in letters whose powers are known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from semispline.papers.recheck.arithmetic import value

# Powers of the roots -> coefficient.
Terms = dict[tuple[int, ...], Fraction]


@dataclass(frozen=True)
class Rooted:
    """A quotient of two polynomials in roots; nothing is divided out, so that no inverse of a root is needed.

    Attributes
    ----------
    over, under : dict
        Powers of the roots -> coefficient.
    """

    over: Terms
    under: Terms

    def __add__(self, other: Any) -> Rooted:
        other = _rooted(other, self)
        over = _sum(_product(self.over, other.under), _product(other.over, self.under))
        return Rooted(over, _product(self.under, other.under))

    def __radd__(self, other: Any) -> Rooted:
        return self.__add__(other)

    def __neg__(self) -> Rooted:
        return Rooted({powers: -c for powers, c in self.over.items()}, self.under)

    def __sub__(self, other: Any) -> Rooted:
        return self + (-_rooted(other, self))

    def __rsub__(self, other: Any) -> Rooted:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Rooted:
        other = _rooted(other, self)
        return Rooted(_product(self.over, other.over), _product(self.under, other.under))

    def __rmul__(self, other: Any) -> Rooted:
        return self.__mul__(other)

    def __truediv__(self, other: Any) -> Rooted:
        other = _rooted(other, self)
        return self * Rooted(other.under, other.over)

    def __rtruediv__(self, other: Any) -> Rooted:
        return _rooted(other, self) / self

    def __pow__(self, power: int) -> Rooted:
        base = self if power >= 0 else Rooted(self.under, self.over)
        product = _rooted(Fraction(1), self)
        for _ in range(abs(power)):
            product = product * base
        return product


def _rooted(number: Any, like: Rooted) -> Rooted:
    if isinstance(number, Rooted):
        return number
    zero = (0,) * len(next(iter(like.under)))
    return Rooted({zero: Fraction(number)} if number else {}, {zero: Fraction(1)})


def _sum(one: Terms, other: Terms) -> Terms:
    found = dict(one)
    for powers, coefficient in other.items():
        found[powers] = found.get(powers, Fraction(0)) + coefficient
    return {powers: c for powers, c in found.items() if c}


def _product(one: Terms, other: Terms) -> Terms:
    found: Terms = {}
    for p, a in one.items():
        for q, b in other.items():
            powers = tuple(x + y for x, y in zip(p, q, strict=True))
            found[powers] = found.get(powers, Fraction(0)) + a * b
    return {powers: c for powers, c in found.items() if c}


def equal_with_roots(left: str, right: str, roots: Sequence[tuple[str, str, int]], at: Mapping[str, Fraction]) -> bool:
    """Tell whether two texts are the same at an instance, whatever the roots are of which it gives the powers.

    Examples
    --------
    >>> equal_with_roots("(r + 1)*(r - 1)", "x - 1", [("r", "x", 2)], {"x": Fraction(2)})
    True
    """
    sides = _values(left, right, roots, at)
    every = _every(roots, at)
    if any(not _reduced(side.under, roots, every) for side in sides):
        return False
    return not _reduced((sides[0] - sides[1]).over, roots, every)


def defined_with_roots(
    left: str, right: str, roots: Sequence[tuple[str, str, int]], at: Mapping[str, Fraction]
) -> bool:
    """Tell whether nothing in two texts is divided by zero at an instance, the roots being what they are there.

    Examples
    --------
    >>> [defined_with_roots("1/r", "r/x", [("r", "1 - x", 2)], {"x": Fraction(n)}) for n in (1, 2)]
    [False, True]
    """
    every = _every(roots, at)
    return all(_reduced(side.under, roots, every) for side in _values(left, right, roots, at))


def _every(roots: Sequence[tuple[str, str, int]], at: Mapping[str, Fraction]) -> dict[str, Any]:
    """Return the numbers of an instance, and the roots as themselves."""
    names = [name for name, _, _ in roots]
    unit = {(0,) * len(names): Fraction(1)}
    every: dict[str, Any] = {name: number for name, number in at.items() if name not in names}
    for i, name in enumerate(names):
        every[name] = Rooted({tuple(int(i == j) for j in range(len(names))): Fraction(1)}, unit)
    return every


def _values(left: str, right: str, roots: Sequence[tuple[str, str, int]], at: Mapping[str, Fraction]) -> list[Any]:
    every = _every(roots, at)
    # A number among roots, so that all that is computed is one of them.
    return [_rooted(0, every[roots[0][0]]) + value(side, every) for side in (left, right)]


def _reduced(terms: Terms, roots: Sequence[tuple[str, str, int]], at: Mapping[str, Any]) -> Terms:
    """Put in what is known of the roots, the last one first; what it is divided by is left out."""
    for i in reversed(range(len(roots))):
        _, radicand, degree = roots[i]
        known = _rooted(0, next(x for x in at.values() if isinstance(x, Rooted))) + value(radicand, at)
        while terms and max(powers[i] for powers in terms) >= degree:
            low = {powers: c for powers, c in terms.items() if powers[i] < degree}
            high = {(*p[:i], p[i] - degree, *p[i + 1 :]): c for p, c in terms.items() if p[i] >= degree}
            terms = _sum(_product(low, known.under), _product(high, known.over))
    return terms
