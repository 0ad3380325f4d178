"""Mutants of a formula: one sign, factor, index, exponent, limit, number or knot changed. A check must notice each.

A check that would accept a changed formula decides nothing, so every mutant must change what the check finds; one
that does not is listed with the written reason why it says the same as the formula, or why nothing printed tells the
two apart.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise, zip_longest
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from semispline.papers.ledger.number_lists import near
from semispline.papers.ledger.records import Case, Check, CheckFailedError, EndlessError, Formula, Part, decided_cases
from semispline.solver.errors import InputError


@dataclass(frozen=True)
class Mutant:
    """A formula with one change.

    Attributes
    ----------
    kind : str
        What was changed: sign, factor, exponent, index, limit, number, entry of a matrix, or what printed data say.
    relation : sympy.Rel
    """

    kind: str
    relation: Any

    @property
    def text(self) -> str:
        """How a record names it, to say why it is equivalent."""
        return one_line(self.relation)


@dataclass(frozen=True)
class MutationResult:
    """How the mutants of some formulas fared.

    Attributes
    ----------
    kinds : mapping
        Kind of change -> how many mutants of it were tried.
    survivors : tuple of str
        Mutants that the check did not notice and that nobody explained.
    equivalent, undecidable : tuple of (str, str)
        The other survivors, with the written reason: those that say the same as the formula, and those that nothing
        printed can tell from it.
    undefined : int
        Mutants that were noticed since they divide by zero, or never end.
    """

    kinds: Mapping[str, int] = field(default_factory=dict)
    survivors: tuple[str, ...] = ()
    equivalent: tuple[tuple[str, str], ...] = ()
    undecidable: tuple[tuple[str, str], ...] = ()
    undefined: int = 0

    @property
    def tried(self) -> int:
        """All mutants."""
        return sum(self.kinds.values())

    @property
    def noticed(self) -> int:
        """Those whose change the check found."""
        return self.tried - len(self.survivors) - len(self.equivalent) - len(self.undecidable)

    def __add__(self, other: MutationResult) -> MutationResult:
        return MutationResult(
            Counter(self.kinds) + Counter(other.kinds),
            self.survivors + other.survivors,
            self.equivalent + other.equivalent,
            self.undecidable + other.undecidable,
            self.undefined + other.undefined,
        )


def one_line(relation: Any) -> str:
    """Return a relation as text, matrices too.

    Examples
    --------
    >>> one_line(sp.ImmutableMatrix([[1, 0], [2, 3]]))
    'Matrix([[1, 0], [2, 3]])'
    """
    return re.sub(r"\s*\n\s*", " ", str(relation)).replace("Matrix([ [", "Matrix([[")


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
        for kind, changed in [*(_whole_variants(expression) if side else ()), *_variants(expression, neighbours)]:
            sides = (relation.args[0], changed) if side else (changed, relation.args[1])
            mutant = relation.func(*sides, evaluate=False)
            if changed != expression and mutant not in found:
                found[mutant] = Mutant(kind, mutant)
    return list(found.values())


def explained(formula: Formula, same: Mapping[Any, Any], reason: str) -> Formula:
    """Return the formula with those mutants explained that say the same where some letters are put in.

    Parameters
    ----------
    formula : Formula
    same : mapping
        Letter -> what stands for it wherever the formula is meant.
    reason : str
        Why these mutants are equivalent.

    Examples
    --------
    >>> x, y, z = sp.symbols("x y z")
    >>> list(explained(Formula(sp.Eq(z, x - y), (x, y, z)), {x: y}, "x is y").equivalent)
    ['Eq(z, -x + y)', 'Eq(z, 2*x - 2*y)']
    """
    wanted = formula.relation.rhs.xreplace(same)
    found = {m.text: m.relation.rhs.xreplace(same) for m in mutants(formula)}
    return replace(formula, equivalent={text: reason for text, right in found.items() if _same(right, wanted)})


def _same(one: Any, other: Any) -> bool:
    """Whether two rational expressions are the same: what differs at one rational point is not, and is told at once."""
    letters = sorted(one.free_symbols | other.free_symbols, key=str)
    point = {letter: sp.Rational(sp.prime(i + 5), sp.prime(i + 2)) for i, letter in enumerate(letters)}
    apart = one.xreplace(point) - other.xreplace(point)
    return not (apart.is_Rational and apart != 0) and bool(sp.cancel(one - other) == 0)


def try_mutants(part: Part, decided: list[Case] | None = None) -> MutationResult:
    """Try every mutant of a part's formula against the part's own check.

    A probe only saves time: of the mutants that it tells apart, the first ones of each kind are put to the check too.

    Parameters
    ----------
    part : Part
    decided : list of Case, optional
        What the check finds of the formula itself, where that is known.
    """
    if part.formula is None:
        return MutationResult()
    key = part.check, part.formula
    if key not in _RESULTS:
        _RESULTS[key] = _tried(*key, decided)
    return _RESULTS[key]


# Several records may rest on one formula and its check.
_RESULTS: dict[tuple[Check, Formula], MutationResult] = {}


def _tried(check: Check, formula: Formula, original: list[Case] | None) -> MutationResult:
    probed = check.probe(formula) if check.probe else None
    survivors: list[Mutant] = []
    undefined = 0
    kinds: Counter[str] = Counter()
    probed_of_kind: Counter[str] = Counter()
    for mutant in mutants(formula):
        kinds[mutant.kind] += 1
        changed = Formula(mutant.relation, formula.variables, formula.assumptions)
        try:
            if check.probe and check.probe(changed) != probed:
                probed_of_kind[mutant.kind] += 1
                if probed_of_kind[mutant.kind] > _PROBED_AND_CHECKED:
                    continue
            if original is None:
                original = list(decided_cases(check, formula))
            if not _differs(original, decided_cases(check, changed)):
                survivors.append(mutant)
        except (ZeroDivisionError, EndlessError):
            undefined += 1
        except (CheckFailedError, InputError):
            # No answer is no difference that the check has noticed.
            survivors.append(mutant)
    # A reason that says nothing explains nothing.
    same, open_ = (
        {text: why for text, why in reasons.items() if why.strip()}
        for reasons in (formula.equivalent, formula.undecidable)
    )
    if formula.equivalent_if:
        by_rule = {m.text: formula.equivalent_if(m) for m in survivors if m.text not in same}
        same |= {text: why for text, why in by_rule.items() if why.strip()}
    return MutationResult(
        kinds,
        tuple(f"{m.kind}: {m.text}" for m in survivors if m.text not in same and m.text not in open_),
        tuple((m.text, same[m.text]) for m in survivors if m.text in same),
        tuple((m.text, open_[m.text]) for m in survivors if m.text in open_),
        undefined,
    )


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


def _whole_variants(expression: Any) -> Iterator[tuple[str, Any]]:
    """Yield changes of a whole side."""
    if not isinstance(expression, sp.Expr | sp.MatrixBase | sp.MatrixExpr):
        return
    yield "sign", -expression
    yield "factor", 2 * expression
    if expression.is_Integer:
        yield from (("number", changed) for changed in near(expression))


def _variants(expression: Any, near_by: dict[Any, list[Any]]) -> Iterator[tuple[str, Any]]:
    """Yield (kind, expression with one change), walking through the whole tree."""
    yield from (("index", other) for other in near_by.get(expression, []))
    yield from _node_variants(expression)
    if hasattr(expression, "changes") or isinstance(expression, sp.Indexed | sp.CRootOf):
        return
    if isinstance(expression, sp.MatrixBase):
        yield from _matrix_variants(expression, near_by)
        return
    if isinstance(expression, sp.Sum | sp.Integral):
        for kind, changed in _variants(expression.function, near_by):
            yield kind, expression.func(changed, *expression.limits)
        return
    for i, argument in enumerate(expression.args):
        for kind, changed in _variants(argument, near_by):
            yield kind, _with_arg(expression, i, changed)


def _node_variants(expression: Any) -> Iterator[tuple[str, Any]]:
    """Yield changes of one node of the tree."""
    if hasattr(expression, "changes"):
        # What is printed otherwise than as an expression knows best how it may be mistaken.
        yield from expression.changes()
    elif expression.is_Rational and not expression.is_Integer:
        yield from (("number", changed) for changed in near(expression))
    elif isinstance(expression, sp.Add):
        for i, term in enumerate(expression.args):
            yield "sign", _with_arg(expression, i, -term)
            yield "factor", _with_arg(expression, i, 2 * term)
    elif isinstance(expression, sp.Pow) and expression.exp.is_number:
        yield from (("exponent", expression.base ** (expression.exp + step)) for step in (-1, 1))
    elif isinstance(expression, sp.Indexed):
        for i in range(1, len(expression.args)):
            yield "index", _with_arg(expression, i, expression.args[i] + 1)
    elif isinstance(expression, AppliedUndef):
        for i, argument in enumerate(expression.args):
            if argument.is_integer:
                yield "index", _with_arg(expression, i, argument + 1)
    elif isinstance(expression, sp.Sum):
        yield from _limit_variants(expression)
    elif isinstance(expression, sp.Integral):
        yield "factor", 2 * expression


def _matrix_variants(matrix: Any, near_by: dict[Any, list[Any]]) -> Iterator[tuple[str, Any]]:
    """Yield matrices with one entry changed, or exchanged with the next one of its row."""
    entries = list(matrix)

    def with_entries(changed: list[Any]) -> Any:
        return sp.ImmutableDenseMatrix(matrix.rows, matrix.cols, changed)

    for i, entry in enumerate(entries):
        changes = list(_variants(entry, near_by))
        if entry.is_Integer:
            changes.append(("number", entry + 1))
        if entry != 0:
            changes.append(("sign", -entry))
        for kind, changed in changes:
            yield kind, with_entries([*entries[:i], changed, *entries[i + 1 :]])
        if (i + 1) % matrix.cols and entries[i + 1] != entry:
            yield "entry", with_entries([*entries[:i], entries[i + 1], entry, *entries[i + 2 :]])


def _limit_variants(expression: Any) -> Iterator[tuple[str, Any]]:
    for i, (index, lower, upper) in enumerate(expression.limits):
        for changed in ((index, lower + 1, upper), (index, lower, upper - 1)):
            limits = (*expression.limits[:i], changed, *expression.limits[i + 1 :])
            yield "limit", sp.Sum(expression.function, *limits)


def _with_arg(expression: Any, i: int, changed: Any) -> Any:
    return expression.func(*expression.args[:i], changed, *expression.args[i + 1 :])
