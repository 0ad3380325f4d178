"""What a check finds, as statements that a second system repeats from what is printed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import sympy as sp

from semispline.papers.checks.carrying_out import Where, carried_out
from semispline.papers.checks.counterexamples import smallest_difference
from semispline.papers.checks.instances import as_letters
from semispline.papers.checks.normal_form import difference
from semispline.papers.checks.rewriting import Rewriting
from semispline.papers.recheck import (
    NotExpressibleError,
    Statement,
    Text,
    as_text,
    different,
    identity,
    matrices,
    number,
    text,
    total,
)


def equation_statement(
    label: str,
    printed: tuple[Any, Any],
    carried: tuple[Any, Any],
    where: Where,
    assumptions: Iterable[Any],
    instance: Mapping[Any, Any],
    **flags: Any,
) -> Statement:
    """Return that two expressions are the same, or are not: as they stand, sums term by term.

    Parameters
    ----------
    label : str
    printed, carried : pairs of sympy.Expr
        Both sides as they are printed (or as text), and carried out at the instance.
    where : mapping
        What letters stand for.
    assumptions : iterable of sympy.Rel
    instance : mapping
        Letter -> number.

    Raises
    ------
    NotExpressibleError
        They differ at no numbers that a search finds, or have no form as text.
    """
    one, other = carried
    found = difference(one, other)
    if found.zero or found.decided:
        texts = _Texts(where, instance, carried)
        left, right = (texts.of(side) for side in printed)
        if found.zero:
            roots = [(root.letter, root.radicand, root.degree) for root in texts.rewriting.roots]
            return identity(label, left, right, roots=roots, meaning=texts.rewriting.meaning, **flags)
        return different(label, left, right, conditions=_conditions(assumptions, instance), **flags)
    counterexample = smallest_difference(one, other, assumptions, instance)
    if counterexample is None:
        raise NotExpressibleError(f"{label}: found no numbers at which both sides differ")
    values = {sp.Symbol(name): sp.Rational(value) for name, value in counterexample.values}
    apart = _at_names(as_letters(one - other), values)
    size = abs(sp.Rational(str(sp.N(apart, 20)))) / 2
    return number(f"{label}, at {counterexample}", apart, -size, size, inside=False, **flags)


class _Texts:
    """Expressions as text: what is printed is put together and nothing in it is worked out."""

    def __init__(self, where: Where, numbers: Mapping[Any, Any], carried: Iterable[Any]) -> None:
        self.where = where
        self.numbers = dict(numbers)
        self.rewriting = Rewriting()
        self.rewriting.prepare(carried)

    def of(self, e: Any) -> Text:  # noqa: PLR0911  # one for each kind of node
        """Return an expression as text."""
        if isinstance(e, Text):
            return e
        if e in self.numbers:
            return as_text(self.numbers[e])
        if e in self.where:
            return self.of(self.where[e])
        if isinstance(e, sp.Sum | sp.Product):
            return self._sum(e)
        if e.is_Add:
            return total(self.of(term) for term in e.args)
        if e.is_Mul:
            return self._product(e)
        if e.is_Pow:
            exponent = self._carried(e.exp)
            if exponent.is_Integer:
                return self.of(e.base) ** int(exponent)
        if isinstance(e, sp.Indexed):
            carried = self._carried(e)
            return as_text(as_letters(carried)) if isinstance(carried, sp.Indexed) else self.of(carried)
        if isinstance(e, sp.binomial | sp.factorial):
            numbers = [self._carried(a) for a in e.args]
            if all(n.is_Integer and n >= 0 for n in numbers) and (len(numbers) == 1 or numbers[1] <= numbers[0]):
                return _falling(*map(int, numbers))
        # Functions, roots and angles: what they are, and the letters that stand for them.
        return as_text(self.rewriting.rational(self._carried(e)))

    def _carried(self, e: Any) -> Any:
        return carried_out(e.xreplace(self.numbers), self.where)

    def _sum(self, e: Any) -> Text:
        *inner, (index, low, high) = e.limits
        first, last = (int(self._carried(end)) for end in (low, high))
        body = e.func(e.function, *inner) if inner else e.function
        terms = []
        outside = self.numbers
        for n in range(first, last + 1):
            self.numbers = {**outside, index: sp.Integer(n)}
            terms.append(self.of(body))
        self.numbers = outside
        return total(terms) if isinstance(e, sp.Sum) else _multiplied(terms)

    def _product(self, e: Any) -> Text:
        over, under = [], []
        for factor in e.args:
            exponent = self._carried(factor.exp) if factor.is_Pow else None
            if exponent is not None and exponent.is_Integer and exponent < 0:
                under.append(self.of(factor.base) ** -int(exponent))
            else:
                over.append(self.of(factor))
        return _multiplied(over) / _multiplied(under) if under else _multiplied(over)


def _multiplied(factors: Iterable[Text]) -> Text:
    product: Text | None = None
    for factor in factors:
        product = factor if product is None else product * factor
    return product if product is not None else Text("1")


def _falling(n: int, k: int | None = None) -> Text:
    """Return a factorial or a binomial of numbers as the products that they are."""
    count = n if k is None else k
    over = _multiplied(as_text(n - j) for j in range(count))
    return over if k is None else over / _multiplied(as_text(j) for j in range(1, k + 1))


def _at_names(expression: Any, values: Mapping[Any, Any]) -> Any:
    """Put in numbers by the names of letters, whatever is assumed of these."""
    return expression.xreplace({s: values[sp.Symbol(str(s))] for s in expression.free_symbols})


def _conditions(assumptions: Iterable[Any], instance: Mapping[Any, Any]) -> list[str]:
    """Return what is presupposed of letters that are left, as texts."""
    found = []
    for assumption in assumptions:
        left = assumption.xreplace(dict(instance))
        if left not in (sp.true, sp.false) and isinstance(left, sp.core.relational.Relational):
            found.append(f"{text(left.lhs)} {left.rel_op} {text(left.rhs)}")
    return found


def matrix_statement(label: str, one: Any, other: Any, where: Where, *, equal: bool, **flags: Any) -> Statement:
    """Return that two expressions of matrices are the same, or are not: products and inverses as they stand.

    Raises
    ------
    NotExpressibleError
        An entry has roots, angles, factorials or powers with letters: what they stand for is not said of matrices.
    """
    texts = _MatrixTexts(where)
    return matrices(label, str(texts.of(one)), str(texts.of(other)), texts.named, equal=equal, **flags)


class _MatrixTexts:
    """Names of explicit matrices, made as they are met."""

    def __init__(self, where: Where) -> None:
        self.where = where
        self.named: dict[str, Any] = {}

    def of(self, e: Any) -> Text:
        """Return an expression of matrices as text."""
        if e in self.where:
            return self.of(self.where[e])
        if isinstance(e, sp.MatMul):
            return self._product(e)
        if isinstance(e, sp.MatAdd):
            first, *others = map(self.of, e.args)
            for term in others:
                first = first + term
            return first
        if isinstance(e, sp.MatPow):
            base = self.of(e.base)
            power = int(carried_out(e.exp, self.where))
            return Text(f"{base.at(4)}^{power}", 3)
        found = carried_out(e, self.where)
        if not isinstance(found, sp.MatrixBase):
            return as_text(_plain(found))
        return self._name(found)

    def _product(self, e: Any) -> Text:
        factors = [self.of(factor) for factor in e.args]
        product = factors[0]
        for factor in factors[1:]:
            product = product * factor
        return product

    def _name(self, matrix: Any) -> Text:
        entries = sp.ImmutableDenseMatrix(matrix.rows, matrix.cols, list(map(_plain, matrix)))
        for name, known in self.named.items():
            if known == entries:
                return Text(name)
        name = f"m{len(self.named) + 1}_"
        self.named[name] = entries
        return Text(name)


def _plain(entry: Any) -> Any:
    rewriting = Rewriting()
    rewriting.prepare([entry])
    found = rewriting.rational(as_letters(entry))
    if not rewriting.is_free:
        raise NotExpressibleError(f"matrix: found the entry {entry}, expected a rational function of letters")
    return found
