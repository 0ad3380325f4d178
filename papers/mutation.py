"""Mutants of a formula: one sign, factor, index, exponent, order or knot changed. A check must notice each.

A check that would accept a changed formula decides nothing, so every mutant must change what the check finds; one
that does not is listed with the written reason why it says the same as the formula.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from papers.ledger import Case, Formula, Part, decided_cases


@dataclass(frozen=True)
class Mutant:
    """A formula with one change.

    Attributes
    ----------
    kind : str
        What was changed: sign, factor, exponent, index, or limit.
    relation : sympy.Rel
    """

    kind: str
    relation: Any

    @property
    def text(self) -> str:
        """How a record names it, to say why it is equivalent."""
        return str(self.relation)


@dataclass(frozen=True)
class MutationResult:
    """How the mutants of one formula fared.

    Attributes
    ----------
    tried, explained : int
        All mutants, and the survivors with a written reason.
    survivors : tuple of str
        Mutants that the check did not notice and that nobody explained.
    undefined : int
        Mutants that were noticed since they divide by zero.
    """

    tried: int
    explained: int
    survivors: tuple[str, ...]
    undefined: int = 0


def mutants(formula: Formula) -> list[Mutant]:
    """Return all mutants of the right-hand side, and of the left one where that is not a single symbol.

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> [(m.kind, m.relation.rhs) for m in mutants(Formula(sp.Eq(y, x**2), (x, y)))]
    [('sign', -x**2), ('factor', 2*x**2), ('exponent', x), ('exponent', x**3)]
    """
    relation = formula.relation
    neighbours = _neighbour_map(formula.neighbours)
    found: dict[Any, Mutant] = {}
    for side in (1, 0):
        expression = relation.args[side]
        if side == 0 and not expression.args:
            continue
        whole = [("sign", -expression), ("factor", 2 * expression)] if side else []
        for kind, changed in [*whole, *_variants(expression, neighbours)]:
            sides = (relation.args[0], changed) if side else (changed, relation.args[1])
            mutant = relation.func(*sides, evaluate=False)
            if changed != expression and mutant not in found:
                found[mutant] = Mutant(kind, mutant)
    return list(found.values())


def try_mutants(part: Part) -> MutationResult:
    """Try every mutant of a part's formula against the part's own check.

    A probe only saves time: of the mutants that it tells apart, the first ones of each kind are put to the check too.
    """
    formula = part.formula
    if formula is None:
        return MutationResult(0, 0, ())
    check = part.check
    original: list[Case] | None = None
    probed = check.probe(formula) if check.probe else None
    tried, explained, undefined, survivors = 0, 0, 0, []
    probed_of_kind: Counter[str] = Counter()
    for mutant in mutants(formula):
        tried += 1
        changed = Formula(mutant.relation, formula.variables, formula.assumptions)
        try:
            if check.probe and check.probe(changed) != probed:
                probed_of_kind[mutant.kind] += 1
                if probed_of_kind[mutant.kind] > _PROBED_AND_CHECKED:
                    continue
            if original is None:
                original = list(decided_cases(check, formula))
            if _differs(original, decided_cases(check, changed)):
                continue
        except ZeroDivisionError:
            undefined += 1
            continue
        if mutant.text in formula.equivalent:
            explained += 1
        else:
            survivors.append(f"{mutant.kind}: {mutant.text}")
    return MutationResult(tried, explained, tuple(survivors), undefined)


# How many mutants of a kind go to the check itself although a probe has told them apart.
_PROBED_AND_CHECKED = 2


def _differs(original: list[Case], other: Any) -> bool:
    """Compare case by case and stop at the first difference: most mutants show in the first case."""
    pairs = zip_longest(original, other)
    return any(a is None or b is None or (a.true, a.residual) != (b.true, b.residual) for a, b in pairs)


def _neighbour_map(chains: tuple[tuple[Any, ...], ...]) -> dict[Any, list[Any]]:
    near: dict[Any, list[Any]] = {}
    for chain in chains:
        for left, right in pairwise(chain):
            near.setdefault(left, []).append(right)
            near.setdefault(right, []).append(left)
    return near


def _variants(expression: Any, near: dict[Any, list[Any]]) -> Iterator[tuple[str, Any]]:
    """Yield (kind, expression with one change), walking through the whole tree."""
    yield from (("index", other) for other in near.get(expression, []))
    if isinstance(expression, sp.Add):
        for i, term in enumerate(expression.args):
            yield "sign", _with_arg(expression, i, -term)
            yield "factor", _with_arg(expression, i, 2 * term)
    elif isinstance(expression, sp.Pow) and expression.exp.is_number:
        yield from (("exponent", expression.base ** (expression.exp + step)) for step in (-1, 1))
    elif isinstance(expression, sp.Indexed):
        for i in range(1, len(expression.args)):
            yield "index", _with_arg(expression, i, expression.args[i] + 1)
        return
    elif isinstance(expression, AppliedUndef):
        for i, argument in enumerate(expression.args):
            if argument.is_integer:
                yield "index", _with_arg(expression, i, argument + 1)
    elif isinstance(expression, sp.Sum):
        yield from _limit_variants(expression)
        yield from (
            (kind, sp.Sum(changed, *expression.limits)) for kind, changed in _variants(expression.function, near)
        )
        return
    elif isinstance(expression, sp.Integral):
        yield "factor", 2 * expression
        yield from (
            (kind, sp.Integral(changed, *expression.limits)) for kind, changed in _variants(expression.function, near)
        )
        return
    for i, argument in enumerate(expression.args):
        for kind, changed in _variants(argument, near):
            yield kind, _with_arg(expression, i, changed)


def _limit_variants(expression: Any) -> Iterator[tuple[str, Any]]:
    for i, (index, lower, upper) in enumerate(expression.limits):
        for changed in ((index, lower + 1, upper), (index, lower, upper - 1)):
            limits = (*expression.limits[:i], changed, *expression.limits[i + 1 :])
            yield "limit", sp.Sum(expression.function, *limits)


def _with_arg(expression: Any, i: int, changed: Any) -> Any:
    return expression.func(*expression.args[:i], changed, *expression.args[i + 1 :])
