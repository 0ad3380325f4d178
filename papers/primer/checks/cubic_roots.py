"""Cubic polynomials with known zeros, for code that looks for them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case, Check, Formula

_t = sp.Symbol("t")
_Q = sp.Rational


@dataclass(frozen=True)
class Known:
    """A polynomial of degree 3 at most, and its real zeros between 0 and 1, in the order of the code.

    Attributes
    ----------
    polynomial : sympy.Expr
        In t.
    zeros : tuple of sympy.Expr
    real : bool
        False: a quadratic polynomial that has no real zeros.
    """

    polynomial: Any
    zeros: tuple[Any, ...]
    real: bool = True

    @property
    def points(self) -> tuple[Any, ...]:
        """Its control points as a cubic curve."""
        c0, c1, c2, c3 = (sp.Poly(self.polynomial, _t).coeff_monomial(_t**k) for k in range(4))
        return c0, c0 + c1 / 3, c0 + 2 * c1 / 3 + c2 / 3, c0 + c1 + c2 + c3


def _three(k: Any, middle: Any, factor: Any) -> Known:
    """Return a polynomial with three zeros round `middle`: x^3 - 6 k^2 x - 4 k^3 has -2 k and k (1 +- sqrt 3)."""
    zeros = [middle + x for x in (-2 * k, k * (1 + sp.sqrt(3)), k * (1 - sp.sqrt(3)))]
    x = _t - middle
    return Known(factor * (x**3 - 6 * k**2 * x - 4 * k**3), tuple(z for z in zeros if 0 <= z <= 1))


def _one(u: Any, v: Any, middle: Any, factor: Any) -> Known:
    """Return a polynomial with one real zero: x^3 + 3 u v x - u^3 + v^3 has u - v."""
    x, zero = _t - middle, middle + u - v
    return Known(factor * (x**3 + 3 * u * v * x - u**3 + v**3), (zero,) if 0 <= zero <= 1 else ())


def _product(factor: Any, *zeros: Any) -> Any:
    return factor * sp.prod(_t - zero for zero in zeros)


HALF, QUARTER = _Q(1, 2), _Q(1, 4)
KNOWN = (
    # First what is quick: most changes of code show there.
    _one(HALF, _Q(1, 8), QUARTER, 1),
    _one(-HALF, _Q(-1, 8), HALF, -2),
    _one(HALF, _Q(-1, 8), 0, 1),
    _one(1, _Q(1, 3), HALF, 5),
    # Two of three zeros are the same: the single one first.
    Known(_product(2, QUARTER, _Q(3, 4), _Q(3, 4)), (QUARTER, _Q(3, 4))),
    Known(_product(-1, _Q(3, 4), QUARTER, QUARTER), (_Q(3, 4), QUARTER)),
    Known(_product(1, 2, 0, 0), (0,)),
    # All are the same: given twice.
    Known(_product(4, HALF, HALF, HALF), (HALF, HALF)),
    Known(_product(3, QUARTER, HALF), (HALF, QUARTER)),
    Known(_product(-2, _Q(1, 3), 2), (_Q(1, 3),)),
    Known(_product(1, -1, 1), (1,)),
    Known(3 * _t - 1, (_Q(1, 3),)),
    Known(2 * _t + 1, ()),
    Known(sp.Integer(5), ()),
    _three(_Q(1, 8), HALF, 1),
    _three(_Q(-1, 8), HALF, -3),
    _three(_Q(1, 4), HALF, 2),
    _three(_Q(-1, 2), _Q(1, 5), 1),
    Known(_t**2 - _t + 1, (), real=False),
)


def real_zeros_meet(check: Check, labels: frozenset[str]) -> Check:
    """Return a check whose cases of these labels do not meet the condition."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        for case in check.cases(formula):
            out = any(case.label == label or case.label.startswith(f"{label},") for label in labels)
            yield replace(case, own=not out, meets=not out)

    return replace(check, cases=cases)


def power_sums(zeros: tuple[Any, ...]) -> Mapping[str, Any]:
    """Return what tells lists of at most three numbers apart but for their order: their number and sums of powers.

    Examples
    --------
    >>> power_sums((1, 2))
    {'count': 2, 's1': 3, 's2': 5, 's3': 9}
    """
    sums = {f"s{k}": sp.expand(sp.Add(*(sp.sympify(z) ** k for z in zeros))) for k in (1, 2, 3)}
    return {"count": sp.Integer(len(zeros)), **sums}
