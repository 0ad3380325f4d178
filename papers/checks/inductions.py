"""Sums, products and recurrences for every number of terms, by induction: first values, and one step."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from semispline.papers.checks.carrying_out import UnsuitableError, Where, carried_out
from semispline.papers.checks.exports import equation_statement
from semispline.papers.checks.identities import identity
from semispline.papers.checks.normal_form import difference
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

# Numbers at which a recurrence is compared with the function that it is said to be of, beside the first values.
_PREMISES = 3
# Numbers at which a formula that fails is searched for a counterexample.
_SEARCHED = 6


def induction(
    n: Any,
    *,
    start: int = 0,
    depth: int = 1,
    recurrences: Mapping[Any, Callable[..., Any]] | None = None,
    where: Where | None = None,
    combination: Sequence[Any] | None = None,
    method: str = "",
) -> Check:
    """Return the check that an equation holds for every n from a first one.

    The first values are carried out. In the step the equation for n + depth is reduced: a sum or product up to n + 1 is
    that up to n and one term more, a function with a recurrence is what that says; then what is left is zero by the
    equation for n .. n + depth - 1. Where the left side is one sum, product or function, it is put in; else a
    combination of these equations is subtracted.

    Parameters
    ----------
    n : sympy.Symbol
        An integer.
    start : int
        The first n.
    depth : int
        How many equations before the step uses.
    recurrences : mapping, optional
        `Function` -> callable of its arguments, the first of which is n + depth or larger, that returns what the
        function is there by values of it at smaller numbers.
    where : mapping, optional
        What letters and functions stand for; a function with a recurrence needs its values at numbers.
    combination : sequence, optional
        Factors of the equations for n .. n + depth - 1 that are subtracted.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> i, n = sp.symbols("i n", integer=True, positive=True)
    >>> odd = formula(sp.Eq(sp.Sum(2 * i - 1, (i, 1, n)), n**2, evaluate=False))
    >>> [(case.label, case.true) for case in induction(n, start=1).cases(odd)]
    [('n = 1', True), ('the step from n to n + 1', True)]
    """
    rules = _Rules(n, start, depth, recurrences or {}, where or {}, combination)
    return Check(
        rules.cases,
        Strength.GENERAL,
        method or f"induction over {n}: the first values carried out, the step in normal form",
        proof=True,
        probe=rules.probe,
        search=rules.search,
        export=rules.export,
        believed=f"that what holds for {n} = {start} and goes over from {n} to {n} + 1 holds for all",
    )


class _Rules:
    """What an induction is decided by."""

    def __init__(
        self,
        n: Any,
        start: int,
        depth: int,
        recurrences: Mapping[Any, Callable[..., Any]],
        where: Where,
        combination: Sequence[Any] | None,
    ) -> None:
        self.n, self.start, self.depth = n, start, depth
        self.recurrences, self.where, self.combination = recurrences, where, combination
        self.first = identity(where=where, each={n: range(start, start + depth)})
        self.more = identity(where=where, each={n: range(start, start + depth + _SEARCHED)})

    def cases(self, formula: Formula | None) -> Iterator[Case]:
        """Decide the first values and the step; where one fails, more values: only numbers refute."""
        first = list(self.first.cases(formula))
        left = self._left_of_step(given(formula)) if all(case.true for case in first) else None
        if left == 0:
            yield from first
            yield from self._premises()
            yield Case(self._label, True, residual=sp.Integer(0))
            return
        more = list(self.more.cases(formula))
        if all(case.true for case in more):
            raise CheckFailedError(
                f"{self._label}: neither proved nor refuted; what is left of the step is {left}, and the first "
                f"{len(more)} values are right; say which equations to subtract (combination=...)"
            )
        yield from more

    def _left_of_step(self, formula: Formula) -> Any:
        """Return what is left of the step: 0 where it follows."""
        try:
            found = difference(*self._step(formula))
        except UndefinedError as error:
            return sp.Symbol(f"undefined: {error}")
        return found.residual

    @property
    def _label(self) -> str:
        before = str(self.n) if self.depth == 1 else f"{self.n} .. {self.n} + {self.depth - 1}"
        return f"the step from {before} to {self.n} + {self.depth}"

    def _premises(self) -> Iterator[Case]:
        """Yield that recurrences are true of the functions that they are said to be of, at some numbers."""
        for function, recurrence in self.recurrences.items():
            meaning = self.where.get(function)
            if meaning is None:
                raise UnsuitableError(f"induction: found no values of {function}, expected them in `where`")
            for k in range(self.start + self.depth, self.start + self.depth + _PREMISES):
                arguments = [sp.Integer(k), *(sp.Symbol(f"a{j}") for j in range(1, _arguments(recurrence)))]
                one, other = (carried_out(x, self.where) for x in (function(*arguments), recurrence(*arguments)))
                found = difference(one, other)
                yield Case(f"the recurrence of {function} at {k}", found.zero, own=False, residual=found.residual)

    def _step(self, formula: Formula) -> tuple[Any, Any]:
        """Return both sides of the equation for n + depth, reduced by those before."""
        reduce = _Reduction(self.n, self.depth, formula.relation.args, self.recurrences, self.where)
        one, other = (reduce.at(side, self.depth) for side in formula.relation.args)
        before = [[reduce.at(side, j) for side in formula.relation.args] for j in range(self.depth)]
        if self.combination is None and all(left.is_Symbol or isinstance(left, AppliedUndef) for left, _ in before):
            known = dict(before)
            return one.xreplace(known), other.xreplace(known)
        factors = self.combination if self.combination is not None else [sp.Integer(1)] * self.depth
        for factor, (left, right) in zip(factors, before, strict=True):
            one, other = one - factor * left, other - factor * right
        return one, other

    def probe(self, formula: Formula) -> Any:
        """Return exact values at some numbers."""
        return self.more.probe(formula) if self.more.probe else None

    def search(self, formula: Formula) -> Counterexample | None:
        """Return the smallest n at which the equation fails, with the smallest other letters."""
        return self.more.search(formula) if self.more.search else None

    def export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return the first values and the step; of a formula that fails the value at which it does."""
        formula = given(formula)
        cases = list(self.cases(formula))
        if not all(case.true for case in cases):
            assert self.more.export is not None
            yield from self.more.export(formula)
            return
        assert self.first.export is not None
        yield from self.first.export(formula)
        for function, recurrence in self.recurrences.items():
            for k in range(self.start + self.depth, self.start + self.depth + _PREMISES):
                arguments = [sp.Integer(k), *(sp.Symbol(f"a{j}") for j in range(1, _arguments(recurrence)))]
                printed = function(*arguments), recurrence(*arguments)
                carried = tuple(carried_out(side, self.where) for side in printed)
                label = f"the recurrence of {function} at {k}"
                yield equation_statement(label, printed, carried, self.where, (), {}, own=False)
        sides = self._step(formula)
        yield equation_statement(self._label, sides, sides, {}, (), {})


class _Reduction:
    """Sums, products and functions at n + j by those at smaller numbers; sums that are left become letters."""

    def __init__(
        self,
        n: Any,
        depth: int,
        sides: Sequence[Any],
        recurrences: Mapping[Any, Callable[..., Any]],
        where: Where,
    ) -> None:
        self.n, self.depth, self.recurrences = n, depth, recurrences
        self.where = {key: value for key, value in where.items() if key not in recurrences}
        # Of sums of the same terms, the one that ends first.
        self.ends: dict[Any, Any] = {}
        for e in (e for side in sides for e in side.atoms(sp.Sum, sp.Product)):
            beyond = self._beyond(e)
            if beyond is not None:
                key = self._terms(e)
                self.ends[key] = min(self.ends.get(key, beyond), beyond)

    def at(self, side: Any, ahead: int) -> Any:
        """Return a side for n + ahead."""
        found = side.replace(
            lambda e: isinstance(e, sp.Sum | sp.Product) and self._beyond(e) is not None,
            lambda e: self._split(e, ahead),
        )
        # A sum that is left does not depend on n as its end: it is carried out, or it is none for this check.
        found = found.xreplace({self.n: self.n + ahead})
        for _ in range(ahead + 1):
            found = found.replace(self._can_be_reduced, lambda e: self.recurrences[e.func](*e.args))
        return carried_out(found, self.where)

    def _beyond(self, e: Any) -> Any:
        """Return how far beyond n a sum goes; None where its end is no such number, or its terms depend on n."""
        if len(e.limits) != 1 or len(e.limits[0]) != 3 or e.function.has(self.n) or e.limits[0][1].has(self.n):
            return None
        beyond = sp.expand(e.limits[0][2] - self.n)
        return beyond if beyond.is_Integer else None

    @staticmethod
    def _terms(e: Any) -> Any:
        index, low, _ = e.limits[0]
        return e.func, e.function.xreplace({index: _INDEX}), low

    def _split(self, e: Any, ahead: int) -> Any:
        """Return what a sum is for n + ahead: the letter of the one that ends first, and the terms beyond."""
        end = self.ends[self._terms(e)]
        index, low, _ = e.limits[0]
        letter = sp.Symbol(f"{e.func.__name__}({e.function}, {index} = {low} .. {self.n + end})")
        # Terms for n itself: what follows shifts n, and must not shift these.
        terms = [
            e.function.xreplace({index: self.n - ahead + j})
            for j in range(int(end) + 1, int(self._beyond(e)) + ahead + 1)
        ]
        return letter + sp.Add(*terms) if isinstance(e, sp.Sum) else letter * sp.Mul(*terms)

    def _can_be_reduced(self, e: Any) -> bool:
        if not isinstance(e, AppliedUndef) or e.func not in self.recurrences:
            return False
        return bool(sp.expand(e.args[0] - self.n - self.depth).is_nonnegative)


_INDEX = sp.Dummy("index")


def _arguments(function: Callable[..., Any]) -> int:
    """Return how many arguments a recurrence takes."""
    return len(inspect.signature(function).parameters)
