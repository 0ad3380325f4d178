"""Carrying out what a printed expression prescribes, letter by letter and without any simplification rule.

Sums and products with numbers for limits become terms, products of matrices become entries, derivatives and integrals
of polynomials are taken; letters and functions of the paper get their meaning.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import sympy as sp
from sympy.core.function import AppliedUndef

from semispline.papers.ledger import UndefinedError
from semispline.solver.errors import InputError

# A letter, an applied function or a matrix -> what it is; an indexed letter or a function -> what it is of its indices.
Where: TypeAlias = Mapping[Any, Any]

_UNDEFINED = (sp.zoo, sp.nan, sp.oo, -sp.oo)
# More terms than that are no sum that a paper prints for a person to check.
_MOST_TERMS = 10_000


class UnsuitableError(InputError):
    """A formula to which a check does not apply; the message says to which it does."""


def carried_out(expression: Any, where: Where | None = None) -> Any:
    """Return an expression, or a matrix, without sums, derivatives and products of matrices.

    Parameters
    ----------
    expression : sympy.Basic
    where : mapping, optional
        Symbol, indexed letter, applied function or matrix symbol -> expression; `IndexedBase` or `Function` -> callable
        of the indices or arguments, which may raise `UndefinedError`.

    Raises
    ------
    UndefinedError
        A division by zero, a factorial of a negative number, an index outside of its range.
    UnsuitableError
        A sum whose limits are no numbers, or an integral of something other than a polynomial.

    Examples
    --------
    >>> i, x = sp.symbols("i x")
    >>> B = sp.Function("B")
    >>> carried_out(sp.Sum(B(i) * x**i, (i, 0, 2)), {B: lambda n: sp.factorial(n)})
    2*x**2 + x + 1
    """
    return _Carrying(where or {}).out(sp.sympify(expression))


class _Carrying:
    """The rules, with the meanings of letters."""

    def __init__(self, where: Where) -> None:
        self.where = where

    def out(self, e: Any) -> Any:
        if e in self.where:
            return carried_out(self.where[e])
        if e in _UNDEFINED:
            raise UndefinedError("division by zero")
        if isinstance(e, sp.MatrixBase):
            return sp.ImmutableDenseMatrix(e.rows, e.cols, [self.out(entry) for entry in e])
        for kinds, rule in self._RULES.items():
            if isinstance(e, kinds):
                return self._defined(e, rule(self, e))
        if e in _UNDEFINED:
            raise UndefinedError("a division by zero")
        if not e.args or isinstance(e, sp.CRootOf):
            return e
        return self._defined(e, e.func(*map(self.out, e.args)))

    @staticmethod
    def _defined(before: Any, after: Any) -> Any:
        # Not `has`: an infinity that is divided by would be gone one node further up.
        if after in _UNDEFINED:
            raise UndefinedError(f"{before} is not defined")
        return after

    def _sum(self, e: Any) -> Any:
        *inner, (index, low, high) = e.limits
        first, last = self.out(low), self.out(high)
        if not (first.is_Integer and last.is_Integer):
            raise UnsuitableError(
                f"{e}: found limits {first} and {last}, expected whole numbers; say which numbers the letters are "
                "(each=...), or take a check for sums with any limits"
            )
        if last - first > _MOST_TERMS:
            raise UnsuitableError(f"{e}: found {last - first + 1} terms, expected at most {_MOST_TERMS}")
        combine = sp.Add if isinstance(e, sp.Sum) else sp.Mul
        body = e.func(e.function, *inner) if inner else e.function
        return combine(*(self.out(body.xreplace({index: sp.Integer(n)})) for n in range(int(first), int(last) + 1)))

    def _indexed(self, e: Any) -> Any:
        indices = [self.out(i) for i in e.indices]
        meaning = self.where.get(e.base)
        made = meaning(*indices) if meaning is not None else e.base[tuple(indices)]
        return carried_out(made) if meaning is not None else self.where.get(made, made)

    def _applied(self, e: Any) -> Any:
        arguments = [self.out(a) for a in e.args]
        meaning = self.where.get(e.func)
        if meaning is not None:
            return carried_out(meaning(*arguments))
        made = e.func(*arguments)
        return carried_out(self.where[made]) if made in self.where else made

    def _derivative(self, e: Any) -> Any:
        function = self.out(e.expr)
        for variable, count in e.variable_count:
            if not count.is_Integer:
                raise UnsuitableError(f"{e}: found a derivative of order {count}, expected a whole number")
            function = function.diff((variable, count))
        return function

    def _integral(self, e: Any) -> Any:
        function = self.out(e.function)
        for variable, *ends in e.limits:
            if len(ends) != 2 or not function.is_polynomial(variable):
                raise UnsuitableError(f"{e}: expected the integral of a polynomial between two limits")
            primitive = sp.integrate(sp.expand(function), variable)
            low, high = map(self.out, ends)
            function = primitive.subs(variable, high) - primitive.subs(variable, low)
        return function

    def _matrix_symbol(self, e: Any) -> Any:
        rows, columns = map(self.out, e.shape)
        if not (rows.is_Integer and columns.is_Integer):
            raise UnsuitableError(f"matrix {e}: found the size {rows} x {columns}, expected whole numbers")
        return sp.ImmutableDenseMatrix(int(rows), int(columns), lambda i, j: sp.Symbol(f"{e.name}_{{{i + 1},{j + 1}}}"))

    def _matrix_product(self, e: Any) -> Any:
        product: Any = sp.Integer(1)
        for factor in map(self.out, e.args):
            both = isinstance(product, sp.MatrixBase) and isinstance(factor, sp.MatrixBase)
            # A product of size 1 x 1 counts as the number in it, as in print.
            if both and product.cols != factor.rows:
                product, factor = _number_in(product), _number_in(factor)  # noqa: PLW2901
                both = isinstance(product, sp.MatrixBase) and isinstance(factor, sp.MatrixBase)
            if both and product.cols != factor.rows:
                raise UndefinedError(f"{e}: {product.shape} times {factor.shape}")
            product = product * factor
        return product

    def _matrix_sum(self, e: Any) -> Any:
        first, *others = map(self.out, e.args)
        for other in others:
            if getattr(other, "shape", ()) != getattr(first, "shape", ()):
                raise UndefinedError(f"{e}: matrices of different sizes")
            first = first + other
        return first

    def _matrix_power(self, e: Any) -> Any:
        base = self.out(e.base)
        power = self.out(e.exp)
        if not power.is_Integer:
            raise UnsuitableError(f"{e}: found the power {power}, expected a whole number")
        if base.rows != base.cols or (power < 0 and base.det() == 0):
            raise UndefinedError(f"{e}: a matrix without this power")
        return (base.inv(method="ADJ") ** -power if power < 0 else base**power).as_immutable()

    def _transpose(self, e: Any) -> Any:
        return self.out(e.arg).T

    def _identity_matrix(self, e: Any) -> Any:
        return sp.ImmutableDenseMatrix(sp.eye(int(self.out(e.rows))))

    _RULES: Mapping[Any, Callable[[_Carrying, Any], Any]] = {
        (sp.Sum, sp.Product): _sum,
        sp.Indexed: _indexed,
        AppliedUndef: _applied,
        sp.Derivative: _derivative,
        sp.Integral: _integral,
        sp.MatrixSymbol: _matrix_symbol,
        sp.MatMul: _matrix_product,
        sp.MatAdd: _matrix_sum,
        sp.MatPow: _matrix_power,
        sp.Transpose: _transpose,
        sp.Identity: _identity_matrix,
    }


def _number_in(value: Any) -> Any:
    return value[0, 0] if isinstance(value, sp.MatrixBase) and value.shape == (1, 1) else value
