"""Identities: both sides are the same rational function of all letters, matrices and roots, angles and factorials too.

What is printed is carried out and compared in normal form: with all letters as letters, or where it depends on whole
numbers (a degree, a number of terms) for each of a range of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError, carried_out
from semispline.papers.checks.counterexamples import smallest_difference
from semispline.papers.checks.exports import equation_statement, matrix_statement
from semispline.papers.checks.instances import (
    Each,
    Meanings,
    as_letters,
    instances,
    label_of,
    letters_of,
    meanings_at,
    spread_values,
)
from semispline.papers.checks.normal_form import difference
from semispline.papers.checks.probing import quick_value
from semispline.papers.ledger import (
    Case,
    Check,
    CheckFailedError,
    Counterexample,
    Formula,
    Meaning,
    Strength,
    UndefinedError,
    given,
    interpret,
)
from semispline.papers.recheck import NotExpressibleError, Statement

_GENERAL = "both sides carried out and compared in normal form, for all letters"
_EACH = "both sides carried out and compared in normal form, for all other letters and each of {}"


def identity(
    *,
    where: Meanings | None = None,
    each: Each | None = None,
    complete: bool = False,
    own: Callable[[Mapping[Any, Any]], bool] | None = None,
    meets: Callable[[Mapping[Any, Any]], bool] | None = None,
    method: str = "",
) -> Check:
    """Return the check that both sides of an equation are the same.

    Parameters
    ----------
    where : mapping, or callable of an instance, optional
        What letters stand for: symbol, indexed letter, applied function or matrix symbol -> expression; `IndexedBase`
        or `Function` -> callable of indices or arguments.
    each : mapping or iterable of mappings, optional
        Letter -> whole numbers that are tried, where a formula depends on them.
    complete : bool
        Whether these numbers are all that the claim speaks of; then the cases prove it.
    own : callable, optional
        Instance -> whether it belongs to the paper's own setting; all do where this is not given.
    meets : callable, optional
        Instance -> whether it meets the condition of a claim that holds under one.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> n, k, x = sp.symbols("n k x")
    >>> square = formula(sp.Eq((1 + x) ** n, sp.Sum(sp.binomial(n, k) * x**k, (k, 0, n)), evaluate=False))
    >>> [(case.label, case.true) for case in identity(each={n: range(3)}).cases(square)]
    [('n = 0', True), ('n = 1', True), ('n = 2', True)]
    """
    tried = None if each is None else list(instances(each))
    rules = _Rules(where, tried if tried is not None else [{}], own, meets)
    return Check(
        rules.cases,
        Strength.GENERAL if tried is None or complete else Strength.EACH,
        method or (_GENERAL if tried is None else _EACH.format(ranges_text(tried))),
        proof=tried is None or complete,
        probe=rules.probe,
        search=rules.search,
        export=rules.export,
    )


def ranges_text(tried: list[dict[Any, Any]]) -> str:
    """Return which numbers are tried, in words."""
    letters = list(dict.fromkeys(letter for instance in tried for letter in instance))
    texts = []
    for letter in letters:
        values = sorted({int(instance[letter]) for instance in tried if letter in instance})
        consecutive = values == list(range(values[0], values[-1] + 1)) and len(values) > 2
        texts.append(f"{letter} = {f'{values[0]} .. {values[-1]}' if consecutive else ', '.join(map(str, values))}")
    return " and ".join(texts)


class _Rules:
    """What an identity is decided by, at each of its instances."""

    def __init__(
        self,
        where: Meanings | None,
        tried: list[dict[Any, Any]],
        own: Callable[[Mapping[Any, Any]], bool] | None,
        meets: Callable[[Mapping[Any, Any]], bool] | None,
    ) -> None:
        self.where, self.tried = where, tried
        self.own, self.meets = own, meets

    def cases(self, formula: Formula | None) -> Iterator[Case]:
        """Decide a formula at each instance."""
        for instance in self.tried:
            flags = {
                "own": self.own is None or self.own(instance),
                "meets": self.meets is None or self.meets(instance),
            }
            yield self._case(given(formula), instance, flags)

    def export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return the cases as statements, matrices with their products as they stand."""
        for instance, case in zip(self.tried, self.cases(formula), strict=True):
            flags = {"own": case.own, "meets": case.meets}
            try:
                yield from self._statements(given(formula), instance, case, flags)
            except UndefinedError as error:
                raise NotExpressibleError(f"{case.label}: {error}, which is no statement about numbers") from None

    def _statements(
        self, formula: Formula, instance: Mapping[Any, Any], case: Case, flags: Mapping[str, bool]
    ) -> Iterator[Statement]:
        sides = formula.relation.args
        entries = list(self._entries(formula, instance))
        where = meanings_at(self.where, instance)
        if len(entries) > 1:
            one, other = (side.xreplace(instance) for side in sides)
            try:
                yield matrix_statement(case.label, one, other, where, equal=bool(case.true), **flags)
                return
            except NotExpressibleError:
                # Then entry by entry, as they come out of the products.
                pass
        for place, one, other in entries:
            label = f"{label_of(instance)}{place}"
            if case.true or label == case.label:
                printed = (one, other) if place else (sides[0], sides[1])
                yield equation_statement(label, printed, (one, other), where, formula.assumptions, instance, **flags)

    def _case(self, formula: Formula, instance: Mapping[Any, Any], flags: Mapping[str, bool]) -> Case:
        label = label_of(instance)
        try:
            for place, one, other in self._entries(formula, instance):
                found = difference(one, other)
                if found.zero:
                    continue
                if not found.decided and smallest_difference(one, other, formula.assumptions, instance) is None:
                    raise CheckFailedError(
                        f"{label}{place}: neither proved nor refuted; what is left, {found.residual}, is zero at all "
                        "numbers that were tried; compare squares, or say what letters stand for (where=...)"
                    )
                return Case(f"{label}{place}", False, residual=-found.residual, **flags)
        except UndefinedError as error:
            return Case(label, False, residual=sp.Symbol(f"undefined: {error}"), **flags)
        return Case(label, True, residual=sp.Integer(0), **flags)

    def _sides(self, formula: Formula, instance: Mapping[Any, Any]) -> tuple[Any, Any]:
        if not isinstance(formula.relation, sp.Equality):
            raise UnsuitableError(f"{formula.relation}: found no equation, expected one; inequality() decides others")
        where = meanings_at(self.where, instance)
        one, other = (carried_out(side.xreplace(instance), where) for side in formula.relation.args)
        return one, other

    def _entries(self, formula: Formula, instance: Mapping[Any, Any]) -> Iterator[tuple[str, Any, Any]]:
        """Yield what is compared: numbers, or the entries of matrices and where they stand."""
        one, other = self._sides(formula, instance)
        shapes = [side.shape if isinstance(side, sp.MatrixBase) else (1, 1) for side in (one, other)]
        if shapes[0] != shapes[1]:
            raise UndefinedError(f"matrices of sizes {shapes[0]} and {shapes[1]}")
        if not any(isinstance(side, sp.MatrixBase) for side in (one, other)):
            yield "", one, other
            return
        entries = [list(side) if isinstance(side, sp.MatrixBase) else [side] for side in (one, other)]
        for n, (a, b) in enumerate(zip(*entries, strict=True)):
            row, column = divmod(n, shapes[0][1])
            yield f", entry ({row + 1}, {column + 1})", a, b

    def probe(self, formula: Formula) -> Any:
        """Return exact values of the difference at some numbers; None where there are no exact ones."""
        found: list[Any] = []
        for instance in self.tried[-2:]:
            try:
                where = meanings_at(self.where, instance)
                one, other = (quick_value(side, instance, where) for side in formula.relation.args)
                found.append(other - one)
                continue
            except UndefinedError:
                found.append("undefined")
                continue
            except (TypeError, ValueError, ZeroDivisionError, AttributeError):
                # Then as it is carried out.
                pass
            try:
                for _, one, other in self._entries(formula, instance):
                    left = as_letters(other - one)
                    found.append(interpret(left, Meaning(spread_values(letters_of(left)))))
            except UndefinedError:
                found.append("undefined")
            except (TypeError, ZeroDivisionError, UnsuitableError):
                return None
        return found

    def search(self, formula: Formula) -> Counterexample | None:
        """Return the smallest numbers at which both sides differ, at the first instance where they do."""
        for instance in self.tried:
            try:
                for place, one, other in self._entries(formula, instance):
                    if not difference(one, other).zero:
                        found = smallest_difference(one, other, formula.assumptions, instance)
                        if found is not None:
                            return _at(found, place)
            except UndefinedError as error:
                return Counterexample(_named(instance), "nothing", str(error))
        return None


def _named(instance: Mapping[Any, Any]) -> tuple[tuple[str, str], ...]:
    return tuple((str(letter), str(value)) for letter, value in instance.items()) or (("any letters", "any numbers"),)


def _at(found: Counterexample, place: str) -> Counterexample:
    if not place:
        return found
    return Counterexample(found.values, f"{place.removeprefix(', ')} {found.printed}", found.true)
