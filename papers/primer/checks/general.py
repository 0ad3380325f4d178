"""An identity for letters of any size, shown at some sizes first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain
from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import Case, Check, Formula


def in_general(where: Mapping[Any, Any], *tried: Mapping[Any, int]) -> Check:
    """Return the check that both sides are the same for all letters, orders and indices too.

    Parameters
    ----------
    where : mapping
        As of `identity`.
    tried : mappings
        Letter -> whole number, the smallest first: orders at which it is decided before that. Where a formula is false
        they say so with a counterexample, and what is false in general alone is told from what has no answer.
    """
    some, every = identity(where=where, each=tried), identity(where=where)

    def cases(formula: Formula | None) -> Iterator[Case]:
        return chain(some.cases(formula), every.cases(formula))

    def export(formula: Formula | None) -> Iterator[Any]:
        assert some.export
        assert every.export
        return chain(some.export(formula), every.export(formula))

    return replace(every, cases=cases, probe=some.probe, search=some.search, export=export)


def with_empty_terms(formula: Formula, basis: Any) -> Formula:
    """Return a formula whose sums may begin later or end earlier where the term that is lost is zero.

    Parameters
    ----------
    formula : Formula
    basis : sympy.Function
        Of index, order and parameter: zero where the index is below 0 or above the order.
    """

    def reason(mutant: Any) -> str:
        lost = mutant.kind == "limit" and _lost(formula.relation, mutant.relation, basis) == 0
        return "the term that is lost is zero" if lost else ""

    return replace(formula, equivalent_if=reason)


def said_again(formula: Formula, at: Mapping[Any, Any], reason: str) -> Formula:
    """Return a formula with those mutants explained whose sides are the same polynomials as its own.

    Parameters
    ----------
    formula : Formula
    at : mapping
        Letter -> what stands for it wherever the formula is meant.
    reason : str
        Why they say the same.
    """

    def same(one: Any, other: Any) -> bool:
        apart = (one - other).xreplace(at)
        return bool(apart.expand().is_zero_matrix) if isinstance(apart, sp.MatrixBase) else sp.expand(apart) == 0

    def again(relation: Any) -> bool:
        return all(a == b or same(a, b) for a, b in zip(relation.args, formula.relation.args, strict=True))

    kinds = ("sign", "factor", "entry")
    return replace(formula, equivalent_if=lambda m: reason if m.kind in kinds and again(m.relation) else "")


def _lost(printed: Any, changed: Any, basis: Any) -> Any:
    [(before, after)] = [(a, b) for a, b in zip(printed.args, changed.args, strict=True) if a != b]
    [one], [other] = (a.atoms(sp.Sum) - b.atoms(sp.Sum) for a, b in ((before, after), (after, before)))
    [(index, low, high)], [(_, later, _)] = one.limits, other.limits
    term = one.function.xreplace({index: low if later != low else high})

    def empty(e: Any) -> bool:
        return e.func == basis and bool(e.args[0].is_negative or (e.args[0] - e.args[1]).is_positive)

    return sp.expand(term.replace(empty, lambda _: sp.Integer(0)))
