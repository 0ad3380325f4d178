"""Printed series: whether the terms shown are those of the function, up to the order shown."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError, Where, carried_out
from semispline.papers.checks.instances import as_letters, letters_of
from semispline.papers.checks.normal_form import difference
from semispline.papers.ledger import (
    Case,
    Check,
    CheckFailedError,
    Counterexample,
    Formula,
    Strength,
    given,
)
from semispline.papers.recheck import Statement
from semispline.papers.recheck import series as series_statement


def series(x: Any, order: int = 0, *, at: Any = 0, where: Where | None = None, method: str = "") -> Check:
    """Return the check that both sides of an equation have the same power series, up to an order.

    Parameters
    ----------
    x : sympy.Symbol
    order : int
        Powers of x - at below it are compared; where it is 0 the order is that of the printed O(..).
    at : number
        Around what.
    where : mapping, optional
        What letters stand for.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> x = sp.Symbol("x")
    >>> sine = formula(sp.Eq(sp.sin(x), x - x**3 / 6 + sp.O(x**5), evaluate=False))
    >>> [case.true for case in series(x).cases(sine)]
    [True, True, True, True, True]
    """
    rules = _Rules(x, order, sp.sympify(at), where or {})
    around = "" if at == 0 else f" around {at}"
    return Check(
        rules.cases,
        Strength.GENERAL,
        method or f"the coefficients of both power series in {x}{around}",
        proof=True,
        search=rules.search,
        export=rules.export,
    )


class _Rules:
    """What series are decided by."""

    def __init__(self, x: Any, order: int, at: Any, where: Where) -> None:
        self.x, self.order, self.at, self.where = x, order, at, where

    def _coefficients(self, formula: Formula) -> tuple[list[Any], list[Any]]:
        one, other = self._shifted(formula)
        order = self._order(formula)
        return self._series(one, order), self._series(other, order)

    def _order(self, formula: Formula) -> int:
        if self.order:
            return self.order
        found = [o.getn() for side in formula.relation.args for o in side.atoms(sp.Order)]
        if not found or not all(getattr(n, "is_Integer", False) and n > 0 for n in found):
            raise UnsuitableError(f"{formula.relation}: found no O(..), expected one, or an order (series(x, order))")
        return int(min(found))

    def _shifted(self, formula: Formula) -> list[Any]:
        """Return both sides as functions of the distance, without their O(..)."""
        if not isinstance(formula.relation, sp.Equality):
            raise UnsuitableError(f"{formula.relation}: found no equation, expected one")
        sides = [side.removeO() if hasattr(side, "removeO") else side for side in formula.relation.args]
        return [as_letters(carried_out(side, self.where)).xreplace({self.x: self.at + self.x}) for side in sides]

    def _series(self, side: Any, order: int) -> list[Any]:
        try:
            found = sp.expand(sp.series(side, self.x, 0, order).removeO())
        except (NotImplementedError, ValueError, sp.PoleError) as error:
            raise UnsuitableError(f"{side}: found no power series ({error}), expected one") from None
        if any(not power.is_Integer or power < 0 for power in _powers(found, self.x)):
            raise UnsuitableError(f"{side}: found a power of {self.x} that is negative or no whole number")
        return [found.coeff(self.x, n) for n in range(order)]

    def cases(self, formula: Formula | None) -> Iterator[Case]:
        """Compare coefficient by coefficient."""
        for n, (one, other) in enumerate(zip(*self._coefficients(given(formula)), strict=True)):
            found = difference(one, other)
            if not found.zero and not found.decided and letters_of(one, other):
                raise CheckFailedError(f"coefficient {n}: neither proved nor refuted; left is {found.residual}")
            yield Case(f"coefficient of {self.x}^{n}", found.zero, residual=-found.residual)

    def search(self, formula: Formula) -> Counterexample | None:
        """Return the first coefficient that differs."""
        for n, (one, other) in enumerate(zip(*self._coefficients(formula), strict=True)):
            if not difference(one, other).zero:
                return Counterexample(((f"power of {self.x}", str(n)),), str(other), str(one))
        return None

    def export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return, for each power, that both series are the same up to it, or are not."""
        formula = given(formula)
        one, other = self._shifted(formula)
        for n, case in enumerate(self.cases(formula)):
            yield series_statement(case.label, one, other, self.x, n, equal=bool(case.true))


def _powers(expression: Any, x: Any) -> set[Any]:
    return {term.as_coeff_exponent(x)[1] for term in sp.Add.make_args(expression) if term != 0}
