"""A curve of one order more, and the nearest one of one order less."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import corrected, formula, part, parts
from semispline.papers.primer.checks.curves import ORDERS, basis, curve_of
from semispline.papers.primer.checks.general import in_general, with_empty_terms
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import definition, equations, fails, holds

_n, _k, _i, _t = (letter("reordering.1", name) for name in ("n", "k", "i", "t"))
_w, _p = (sp.IndexedBase(f"{name}_i", real=True) for name in "wp")
_CURVE = sp.Function("Bézier(n,t)", real=True)
_SAME_CURVE = sp.Function("B(n,t)", real=True)
_BASIS = sp.Function("B^n_i(t)", real=True)

# A function of any order, from what the text says of it in explanation.9; only where the order is a letter.
_ANY = {_BASIS: lambda i, n, t: sp.factorial(n) / (sp.factorial(i) * sp.factorial(n - i)) * (1 - t) ** (n - i) * t**i}
_KNOWN = {
    _BASIS: lambda i, n, t: basis(int(n), int(i), t),
    _CURVE: curve_of(lambda i: _p[i]),
    _SAME_CURVE: curve_of(lambda i: _p[i]),
}
_RAISED = {_CURVE: lambda k, t: curve_of(lambda i: _w[i])(k - 1, t)}
_EACH = {_n: ORDERS}
_GENERAL = in_general(_ANY, {_n: 1, _i: 0}, {_n: 3, _i: 1}, {_n: 4, _i: 2})
_INSIDE = (_t >= 0, _t <= 1)

# reordering.6, transcribed by hand: its third line says t^(i+1) without the braces that would raise it.
_SHARE = _t * sp.factorial(_n) / (sp.factorial(_n - _i) * sp.factorial(_i)) * (1 - _t) ** (_n - _i) * _t**_i
_POWERS = (1 - _t) ** (_n - _i) * _t ** (_i + 1)


def _written(k: Any, below: Any) -> Any:
    return (_i + 1) / k * (sp.factorial(k) / (below * sp.factorial(_i + 1))) * _POWERS


_LAST = (_i + 1) / (_n + 1) * _BASIS(_i + 1, _n + 1, _t)


def _lines(below: Any) -> tuple[Any, ...]:
    """Return the steps with a factorial below the second and third line, which are one line: k is n + 1."""
    sides = _t * _BASIS(_i, _n, _t), _SHARE, _written(_n + 1, below), _LAST
    return tuple(formula(sp.Eq(a, b, evaluate=False), *_INSIDE) for a, b in pairwise(sides))


def _elevation(n: int) -> Any:
    """Return the matrix of reordering.9 for one n, by the pattern of its rows, transcribed by hand."""
    k = n + 1
    rows = [[0] * (n + 1) for _ in range(n + 2)]
    rows[0][0] = 1
    for i in range(1, n + 1):
        rows[i][i - 1], rows[i][i] = sp.Rational(i, k), sp.Rational(k - i, k)
    rows[k][n] = 1
    return sp.ImmutableMatrix(rows)


def _points(name: str, n: int) -> list[Any]:
    return list(sp.symbols(f"{name}:{n + 1}"))


def _raised_matrix(n: int) -> Any:
    """Return the matrix whose columns are the curves of the single points of order n, in the basis of order n + 1."""
    k = n + 1
    powers = sp.ImmutableMatrix(k + 1, k + 1, lambda i, j: sp.Poly(basis(k, j, _t), _t).coeff_monomial(_t**i))
    curves = sp.ImmutableMatrix(k + 1, n + 1, lambda i, j: sp.Poly(basis(n, j, _t), _t).coeff_monomial(_t**i))
    return (powers.inv() * curves).as_immutable()


_MATRICES = tuple(formula(sp.Eq(_raised_matrix(n), _elevation(n), evaluate=False)) for n in ORDERS)


def _by_matrix(n: int) -> dict[str, Any]:
    """Return the meanings of reordering.8 and .10: B_n are any points, B_k those of the same curve of order k."""
    low = sp.ImmutableMatrix(_points("b", n))
    high = sp.ImmutableMatrix(_raised_matrix(n) * low)
    return {
        "M": _elevation(n),
        "B_n": lambda order: low if order == _n else high,
        "I": sp.eye(n + 1).as_immutable(),
    }


CLAIMS = (
    holds(
        "reordering.1",
        "A curve of order n is the curve of order k = n + 1 with the weights ((k - i) w_i + i w_{i-1}) / k.",
        *parts(identity(where=_RAISED, each=_EACH), *equations("reordering.1")),
        remark="Bézier(k, t) is the curve of order n, said in order k. No value of w_{-1} and w_{n+1} matters.",
    ),
    definition("reordering.2", "The sum of the weights times the functions of order n.", "the curve of order n"),
    holds(
        "reordering.3",
        "Any number is 1 - t times and t times itself.",
        *parts(identity(), *equations("reordering.3")),
    ),
    holds(
        "reordering.4",
        "A curve is 1 - t times and t times itself, sum by sum.",
        *parts(identity(where=_KNOWN, each=_EACH), *equations("reordering.4")),
    ),
    holds(
        "reordering.5",
        "1 - t times a function of order n is (k - i) / k times the one of order k = n + 1 with the same index.",
        *parts(_GENERAL, *equations("reordering.5")),
    ),
    fails(
        "reordering.6",
        "t times a function of order n is (i + 1) / k times the next one of order k = n + 1, through factorials.",
        *parts(_GENERAL, *_lines(sp.factorial(_n + 1))),
        correction=corrected(
            "(n - i)! in the place of (n + 1)! and of k! below the second and third line",
            *parts(_GENERAL, *_lines(sp.factorial(_n - _i))),
        ),
        remark="First and last line agree with each other; the second and third do not with them. t^(i+1) of the "
        "third line is meant as a power.",
    ),
    holds(
        "reordering.7",
        "Both sums in order k = n + 1, the second one moved by one index, and put together.",
        *parts(
            identity(where=_KNOWN, each={_n: ORDERS[:3]}),
            *(with_empty_terms(e, _BASIS) for e in equations("reordering.7")),
        ),
        remark="No value of p_{-1} and p_{n+1} matters: their factors are zero.",
    ),
    holds(
        "reordering.8",
        "The points of order k are a matrix times those of order n.",
        *(part(identity(), equation) for n in ORDERS for equation in equations("reordering.8", _by_matrix(n))),
        remark="B_n and B_k are columns of points, of n + 1 and n + 2.",
    ),
    holds(
        "reordering.9",
        "The matrix has 1 in its first and last place, and i / k and (k - i) / k beside each other in row i between.",
        *parts(identity(), *_MATRICES),
        remark="It has n + 2 rows and n + 1 columns; the text about it says n + 1 and n.",
    ),
    holds(
        "reordering.10",
        "Where points of order k come from such of order n, these are the inverse of M^T M times M^T times them.",
        *(part(identity(), equation) for n in ORDERS for equation in equations("reordering.10", _by_matrix(n))),
        remark="For other points of order k the last line makes the sum of squares between points the least, not that "
        "between curves.",
    ),
)
