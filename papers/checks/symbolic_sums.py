"""Printed sums for every order, knot vector and count: what multiplies one control point, with symbolic indices.

A sum that is linear in control points is known by its coefficients. Basis functions stay letters with their index,
order, parameter and knots, so that nothing is assumed of any of these.
"""

from __future__ import annotations

from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

# 1 where low <= index <= high, else 0; 1 where both indices are the same, else 0.
WITHIN, SAME = sp.Function("within"), sp.Function("same")


def coefficient(expression: Any, unit: Any) -> Any:
    """Return what multiplies a control point in nested sums, with `within` for the range that each sum allows.

    Parameters
    ----------
    expression : Expr
        Sums and products; linear in the letter of `unit`. Terms without that letter count for nothing.
    unit : Indexed or applied function
        One control point (or curve), with symbols of its own as indices, which no sum binds.

    Raises
    ------
    ValueError
        The letter does not occur, or not as a factor.

    Examples
    --------
    >>> P, f = sp.IndexedBase("P"), sp.Function("f")
    >>> i, a, n = sp.symbols("i a n", integer=True)
    >>> coefficient(sp.Sum(P[i] * f(i), (i, 0, n)), P[a])
    f(a)*within(0, a, n)
    """
    if isinstance(expression, sp.Sum):
        bound = {limit[0] for limit in expression.limits} & set(_indices(unit))
        if bound:
            raise ValueError(f"sum: found {bound.pop()} as the index of a sum and of {unit}, expected another letter")
        found = coefficient(expression.function, unit)
        # SymPy lists the innermost limit first.
        for index, low, high in expression.limits:
            found = _summed(found, index, low, high)
        return found
    if isinstance(expression, sp.Add):
        return sp.Add(*(coefficient(term, unit) for term in expression.args if _occurs(term, unit)))
    if isinstance(expression, sp.Mul):
        holding = [factor for factor in expression.args if _occurs(factor, unit)]
        if len(holding) == 1:
            others = [factor for factor in expression.args if factor is not holding[0]]
            return sp.Mul(coefficient(holding[0], unit), *others)
    if _is_letter(expression, unit):
        pairs = zip(_indices(expression), _indices(unit), strict=True)
        return sp.Mul(*(SAME(index, place) for index, place in pairs if index != place))
    raise ValueError(f"expression: found {expression}, expected sums and products linear in {unit}")


def _summed(term: Any, index: Any, low: Any, high: Any) -> Any:
    """Carry out a sum in which one factor of each term says which index counts."""
    if isinstance(term, sp.Add):
        return sp.Add(*(_summed(part, index, low, high) for part in term.args))
    for factor in sp.Mul.make_args(term):
        if isinstance(factor, SAME) and factor.args[0].has(index):
            (at,) = sp.roots(sp.Poly(factor.args[0] - factor.args[1], index))
            rest = sp.Mul(*(other for other in sp.Mul.make_args(term) if other is not factor))
            return rest.xreplace({index: at}) * WITHIN(low, at, high)
    raise ValueError(f"sum: nothing in {term} fixes {index}")


def _indices(letter: Any) -> tuple[Any, ...]:
    return tuple(letter.indices if isinstance(letter, sp.Indexed) else letter.args)


def _is_letter(expression: Any, unit: Any) -> bool:
    if isinstance(unit, sp.Indexed):
        return isinstance(expression, sp.Indexed) and expression.base == unit.base
    return isinstance(expression, AppliedUndef) and expression.func == unit.func


def _occurs(expression: Any, unit: Any) -> bool:
    return any(_is_letter(part, unit) for part in sp.preorder_traversal(expression))
