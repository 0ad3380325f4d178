"""What is true of Bezier curves of every degree, as cases on which a check of any paper can stand."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case

# A parameter and one minus it; apart, since products of their powers are compared.
_X, _X_REST = sp.symbols("x x'", positive=True)


def bernstein_polynomial(index: Any, degree: Any, x: Any, rest: Any) -> Any:
    """Return a Bernstein polynomial of any degree, `rest` standing for 1 - x."""
    return sp.binomial(degree, index) * x**index * rest ** (degree - index)


def is_one(ratio: Any) -> bool:
    """Tell whether a quotient of binomials and powers, with symbols in both, is 1."""
    return bool(sp.gammasimp(sp.powsimp(sp.expand_power_base(ratio))) == 1)


def casteljau_cases(function: Any = bernstein_polynomial) -> Iterator[Case]:
    """Yield that the factors of control points in de Casteljau's triangle are Bernstein polynomials, for every degree.

    By induction over the degree: a step of the triangle gives point r the factor (1 - x) c_r^(k-1) + x c_(r-1)^(k-1).
    So the polynomials, which are made of such steps, are not negative and sum to 1, as the one of degree 0 does.
    """
    k, r = sp.symbols("k r", integer=True, positive=True)

    def residual(index: Any) -> Any:
        lower = _X_REST * function(index, k - 1, _X, _X_REST) + _X * function(index - 1, k - 1, _X, _X_REST)
        common = _X**index * _X_REST ** (k - index)
        return sp.gammasimp(sp.powsimp(sp.expand((function(index, k, _X, _X_REST) - lower) / common)))

    for name, index in (("inner", r), ("first", sp.Integer(0)), ("last", k)):
        left = residual(index)
        yield Case(f"a step of the triangle, every degree, {name} index", bool(left == 0), residual=left)
    yield Case("degree 0", bool(function(sp.Integer(0), sp.Integer(0), _X, _X_REST) == 1))


def elevation_cases(share: Any = None) -> Iterator[Case]:
    """Yield that a Bezier curve of any degree d is one of degree d + 1.

    B_r^d = (1 - (r+1)/(d+1) + 1/(d+1)) B_r^(d+1) + (r+1)/(d+1) B_(r+1)^(d+1).
    """
    share = share or (lambda r, d: (r + 1) / (d + 1))
    d, r = sp.symbols("d r", integer=True, nonnegative=True)
    kept, raised = 1 - share(r - 1, d), share(r, d)
    own = bernstein_polynomial(r, d, _X, _X_REST)
    shares = (
        kept * bernstein_polynomial(r, d + 1, _X, _X_REST) / own,
        raised * bernstein_polynomial(r + 1, d + 1, _X, _X_REST) / own,
    )
    total = sum(sp.gammasimp(sp.powsimp(x)) for x in shares)
    residual = sp.expand(sp.cancel(total).subs(_X_REST, 1 - _X) - 1)
    yield Case("every degree: one degree more", bool(residual == 0), residual=residual)
