"""Sums that are linear in letters with an index, for every number of terms: both sides are the same letter by letter.

What multiplies one letter is compared where all sums have it, and at each index near both ends where some have it and
others do not. So a sum that runs one term too far is told from one that does not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError, Where, carried_out
from semispline.papers.checks.exports import equation_statement
from semispline.papers.checks.identities import identity
from semispline.papers.checks.normal_form import difference
from semispline.papers.checks.symbolic_sums import SAME, WITHIN, coefficient
from semispline.papers.ledger import (
    Case,
    Check,
    CheckFailedError,
    Counterexample,
    Formula,
    Strength,
    UndefinedError,
    given,
)
from semispline.papers.recheck import Statement

# For fewer terms than that the ends of sums may meet: they are carried out one by one.
_SMALL = 5
# Further than that from its end no letter is looked for.
_MOST_AT_AN_END = 8


@dataclass(frozen=True)
class _Piece:
    """What multiplies one letter in some sums: a factor where low <= index <= high."""

    factor: Any
    low: Any
    high: Any


def linear_sums(letter: Any, n: Any, *, start: int = 0, where: Where | None = None, method: str = "") -> Check:
    """Return the check that both sides have the same factor of each indexed letter, for every n.

    Parameters
    ----------
    letter : sympy.Indexed
        Such as w[i] with a symbol of its own as index; both sides are linear in w.
    n : sympy.Symbol
        What the sums run to: their ends are whole numbers, or n and a whole number.
    start : int
        The first n.
    where : mapping, optional
        What other letters and functions stand for.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> i, n, x = sp.symbols("i n x", integer=True)
    >>> w = sp.IndexedBase("w")
    >>> one, other = sp.Sum(w[i], (i, 0, n)), sp.Sum(w[i - 1], (i, 1, n + 1))
    >>> linear_sums(w[i], n).strength.name
    'GENERAL'
    """
    rules = _Rules(letter, n, start, where or {})
    return Check(
        rules.cases,
        Strength.GENERAL,
        method or f"what multiplies {letter}, for every {letter.indices[0]} and {n}; the first {n} carried out",
        proof=True,
        probe=rules.probe,
        search=rules.search,
        export=rules.export,
    )


class _Rules:
    """What sums are decided by."""

    def __init__(self, letter: Any, n: Any, start: int, where: Where) -> None:
        if not isinstance(letter, sp.Indexed) or len(letter.indices) != 1:
            raise UnsuitableError(f"linear_sums: found {letter}, expected an indexed letter such as w[i]")
        # An index of its own, which no sum binds, whatever the letter of theirs is.
        self.letter, self.index = letter, sp.Dummy(f"{letter.indices[0]}", integer=True)
        self.unit = letter.base[self.index]
        self.n, self.where = n, where
        self.small = identity(where=where, each={n: range(start, start + _SMALL)})

    def cases(self, formula: Formula | None) -> Iterator[Case]:
        """Decide the first n, then every index."""
        small = list(self.small.cases(formula))
        yield from small
        if not all(case.true for case in small):
            return
        for label, one, other in self._compared(given(formula)):
            try:
                found = difference(one, other)
            except UndefinedError as error:
                yield Case(label, False, residual=sp.Symbol(f"undefined: {error}"))
                continue
            if not found.zero and not found.decided:
                raise CheckFailedError(
                    f"{label}: neither proved nor refuted; what is left is {found.residual}, and the first n are right"
                )
            yield Case(label, found.zero, residual=-found.residual)

    def _compared(self, formula: Formula) -> Iterator[tuple[str, Any, Any]]:
        """Yield what multiplies a letter on both sides: where all sums have it, and near the ends."""
        sides = [self._pieces(side) for side in formula.relation.args]
        every = [piece for side in sides for piece in side]
        lows, highs = (
            [self._offset(end) for end in ends] for ends in zip(*((p.low, p.high) for p in every), strict=True)
        )
        # Below `bottom` and from `top` on, one index after another; between them all that reach from one to the other.
        first = [at for at, at_n in lows if not at_n]
        bottom = max([at - 1 for at in first] + [at for at, at_n in highs if not at_n], default=-1)
        last = [at for at, at_n in highs if at_n]
        top = min([at + 1 for at in last] + [at for at, at_n in lows if at_n], default=1)
        if not first or not last:
            raise UnsuitableError(f"{formula.relation}: found no sum to {self.n}, expected one")
        if bottom - min(first) > _MOST_AT_AN_END or max(last) - top > _MOST_AT_AN_END:
            raise UnsuitableError(
                f"{formula.relation}: found ends that are far apart, expected {_MOST_AT_AN_END} at most"
            )

        def between(low: tuple[int, bool], high: tuple[int, bool]) -> bool:
            return not low[1] and high[1]

        yield self._at(sides, self.index, between, f"{self.letter}, every {self.letter.indices[0]} that all sums have")
        for at in range(min(first), bottom + 1):
            yield self._at(sides, sp.Integer(at), lambda low, high, at=at: _has(low, high, at))
        for at in range(top, max(last) + 1):
            yield self._at(sides, self.n + at, lambda low, high, at=at: _reaches(low, high, at))

    def _at(
        self, sides: list[list[_Piece]], place: Any, has: Callable[..., bool], label: str = ""
    ) -> tuple[str, Any, Any]:
        """Return what multiplies the letter at a place, by the pieces that have it."""
        sums = []
        for side in sides:
            factors = [p.factor for p in side if has(self._offset(p.low), self._offset(p.high))]
            sums.append(carried_out(sp.Add(*factors).xreplace({self.index: place}), self.where))
        return label or f"{self.unit.base}[{place}]", *sums

    def _pieces(self, side: Any) -> list[_Piece]:
        try:
            found = coefficient(_spread(side), self.unit)
        except ValueError as error:
            raise UnsuitableError(f"{side}: {error}") from None
        pieces = []
        for term in sp.Add.make_args(found):
            low, high, factors = None, None, []
            for factor in sp.Mul.make_args(term):
                if isinstance(factor, WITHIN):
                    low, high = (self._solved(factor.args[1], end) for end in (factor.args[0], factor.args[2]))
                elif isinstance(factor, SAME):
                    one, other = factor.args if factor.args[0].has(self.index) else factor.args[::-1]
                    low = high = self._solved(one, other)
                else:
                    factors.append(factor)
            if low is None:
                raise UnsuitableError(f"{side}: found {self.letter} outside of a sum, expected it inside")
            pieces.append(_Piece(sp.Mul(*factors), low, high))
        return pieces

    def _solved(self, place: Any, end: Any) -> Any:
        """Return the index at which a place, the index and a whole number, is an end."""
        shift = sp.expand(place - self.index)
        if shift.free_symbols:
            raise UnsuitableError(f"index {place}: found more than a whole number beside {self.index}")
        return sp.expand(end - shift)

    def _offset(self, end: Any) -> tuple[int, bool]:
        """Return an end as a whole number, and whether n is added to it."""
        if end.is_Integer:
            return int(end), False
        beyond = sp.expand(end - self.n)
        if not beyond.is_Integer:
            raise UnsuitableError(f"end of a sum: found {end}, expected a whole number, or {self.n} and one")
        return int(beyond), True

    def probe(self, formula: Formula) -> Any:
        """Return exact values at some numbers."""
        return self.small.probe(formula) if self.small.probe else None

    def search(self, formula: Formula) -> Counterexample | None:
        """Return the smallest n and letters at which both sides differ."""
        return self.small.search(formula) if self.small.search else None

    def export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return the first n, then each index that is compared."""
        assert self.small.export is not None
        small = list(self.small.export(formula))
        yield from small
        if all(statement.true for statement in small):
            for label, one, other in self._compared(given(formula)):
                yield equation_statement(label, (one, other), (one, other), {}, (), {})


def _has(low: tuple[int, bool], high: tuple[int, bool], at: int) -> bool:
    """Tell whether a whole number is between two ends; n and a whole number are above all of these."""
    return not low[1] and low[0] <= at and (high[1] or high[0] >= at)


def _reaches(low: tuple[int, bool], high: tuple[int, bool], at: int) -> bool:
    """Tell whether n + at is between two ends; a whole number is below all of these."""
    return (not low[1] or low[0] <= at) and high[1] and high[0] >= at


def _spread(side: Any) -> Any:
    """Return a sum of sums: products with sums are spread over their terms."""
    side = sp.expand(side, deep=False)
    if isinstance(side, sp.Add):
        return sp.Add(*map(_spread, side.args))
    if isinstance(side, sp.Sum):
        return side.func(sp.expand(_spread(side.function)), *side.limits)
    return side
