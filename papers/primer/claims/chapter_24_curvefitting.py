"""The curve that comes nearest to some points, by least squares."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from math import dist
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import Check, Consequence, corrected, formula, part, parts
from semispline.papers.primer.checks.curves import basis, column, row
from semispline.papers.primer.checks.following import entry_by_entry, of_changed
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import definition, equations, fails, holds

_t = letter("curvefitting.1", "t")
_WEIGHTS = [letter("curvefitting.7", name) for name in "abcde"]
_NAMES = {2: ("quadratic", "curvefitting.3"), 3: ("cubic", "curvefitting.6"), 4: ("quartic", "curvefitting.7")}


@cache
def _powers_to_basis(degree: int) -> Any:
    """Return the matrix whose column j has the coefficients of the j-th basis function, from the constant on."""
    return sp.ImmutableMatrix(
        degree + 1, degree + 1, lambda i, j: sp.Poly(basis(degree, int(j), _t), _t).coeff_monomial(_t**i)
    )


def _curve(degree: int) -> Any:
    """Return the check of a curve with the weights a, b, c .. and of its matrices."""
    name, identifier = _NAMES[degree]
    matrices = {
        letter(identifier, "T"): row(*(_t**i for i in range(degree + 1))),
        letter(identifier, "M"): _powers_to_basis(degree),
        letter(identifier, "C"): column(*_WEIGHTS[: degree + 1]),
    }
    value = de_casteljau(_WEIGHTS[: degree + 1], _t)
    return identity(where={letter("curvefitting.1", f"B_{{{name}}}"): value, **matrices})


_QUADRATIC, _CUBIC, _QUARTIC = (_curve(degree) for degree in (2, 3, 4))


def _as_rows(relation: Any) -> Any:
    """Return both sides as rows of three: a product of matrices is compared with one of another size."""
    sides = [side if getattr(side, "shape", (1, 1)) == (1, 3) else _first_of_three(side) for side in relation.args]
    return sp.Eq(*sides, evaluate=False)


def _first_of_three(side: Any) -> Any:
    return side * row(1, 0, 0) if getattr(side, "shape", ()) == (1, 1) else row(side, 0, 0)


def _weakened() -> Consequence:
    """Measure how far the cubic without its factor 3 is from the curve."""
    points = [(0, 0), (20, 100), (110, 90), (150, 0)]

    def at(t: float, third: int) -> list[float]:
        shares = (1 - t) ** 3, 3 * t * (1 - t) ** 2, third * t**2 * (1 - t), t**3
        return [sum(s * p[k] for s, p in zip(shares, points, strict=True)) for k in (0, 1)]

    apart = max(dist(at(n / 300, 1), at(n / 300, 3)) for n in range(301))
    return Consequence(
        "a cubic curve 150 wide with its first point in the origin: largest distance at the same parameter",
        {"distance": apart},
    )


# n points, and as many weights of a curve; p and s, the parameters, are letters.
_n, _weights = sp.symbols("n weights", integer=True)
_SIZES = [{_n: 2, _weights: 2}, {_n: 3, _weights: 2}, {_n: 3, _weights: 3}, {_n: 4, _weights: 3}]


def _letters(name: str, count: int) -> list[Any]:
    return [sp.Symbol(f"{name}_{i + 1}", real=True) for i in range(count)]


@cache
def _fit(count: int, weights: int) -> Mapping[str, Any]:
    """Return what the names of matrices stand for, the sum of squares, its gradient, and a column of zeros."""
    p, c = _letters("p", count), _letters("c", weights)
    # The first parameter is 0 and the last one 1 (curvefitting.9, curvefitting.10).
    s = [sp.Integer(0), *_letters("s", count)[1:-1], sp.Integer(1)]
    error = sum((point - de_casteljau(c, at)) ** 2 for point, at in zip(p, s, strict=True))
    gradient = [sp.expand(error.diff(weight)) for weight in c]
    return {
        "P": column(*p),
        "T": sp.ImmutableMatrix(count, weights, lambda i, j: s[i] ** j),
        "M": _powers_to_basis(weights - 1),
        "C": column(*c),
        "error": error,
        "gradient": column(*gradient),
        "nothing": sp.ImmutableMatrix(sp.zeros(weights, 1)),
    }


def _where(identifier: str, powers: str) -> Any:
    """Return what the letters of a display stand for, for any number of points and weights."""
    names = {"P": "P", "M": "M", "C": "C", powers: "T"}

    def at(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
        fit = _fit(int(instance[_n]), int(instance[_weights]))
        found = {letter(identifier, name): fit[what] for name, what in names.items()}
        error = sp.Function("E(C)", real=True)(letter(identifier, "C"))
        return {**found, error: fit["error"], _GRADIENT: fit["gradient"], _NOTHING: fit["nothing"]}

    return at


_SQUARE = letter("curvefitting.16", "P").shape
_GRADIENT = sp.MatrixSymbol("G", *_SQUARE)
_NOTHING = sp.MatrixSymbol("O", *letter("curvefitting.18", "C").shape)


def _least_squares(identifier: str, powers: str) -> Check:
    """Return the check of a display in which a letter stands for the matrix of powers."""
    return identity(
        where=_where(identifier, powers),
        each=_SIZES,
        method="sums over 2 to 4 points, 2 or 3 weights, by de Casteljau's triangle, first parameter 0, last 1",
    )


def _as_sum_of_squares(relation: Any) -> Any:
    squares = {power: power.base.T * power.base for power in relation.rhs.atoms(sp.MatPow)}
    return sp.Eq(relation.lhs, relation.rhs.xreplace(squares), evaluate=False)


def _at_weights(relation: Any) -> Any:
    """Return that half of the gradient, its sign changed, is nothing at the weights that are printed."""
    powers, to_basis, points = (letter("curvefitting.18", name) for name in ("𝕋", "M", "P"))
    return sp.Eq(_NOTHING, to_basis.T * powers.T * (points - powers * to_basis * relation.rhs), evaluate=False)


def _gradient(side: Any) -> Any:
    return formula(sp.Eq(_GRADIENT, side, evaluate=False))


_P, _M, _C, _T = (letter("curvefitting.17", name) for name in ("P", "M", "C", "𝕋"))
_last, _s, _count = sp.Symbol("last"), sp.Symbol("s", positive=True), letter("curvefitting.8", "n")

CLAIMS = (
    holds(
        "curvefitting.1",
        "The quadratic curve with the weights a, b and c, and its expansion.",
        *parts(_QUADRATIC, *equations("curvefitting.1")),
    ),
    holds(
        "curvefitting.2",
        "The expansion, arranged by powers of t and by weights.",
        *parts(_QUADRATIC, *equations("curvefitting.2")),
    ),
    fails(
        "curvefitting.3",
        "The curve is the powers of t times a matrix with the weights in its entries, and that is the powers times a "
        "matrix of numbers times the column of weights.",
        *parts(
            of_changed(
                entry_by_entry(_QUADRATIC, 1, 3),
                _as_rows,
                "a number as the row of it and two zeros, where the other side is a row",
            ),
            *equations("curvefitting.3"),
        ),
        correction=corrected(
            "with the weights in the matrix a column of ones is missing behind it: without, the product is a row of "
            "three",
            part(
                _QUADRATIC,
                formula(
                    sp.Eq(
                        letter("curvefitting.1", "B_{quadratic}"),
                        (row(1, _t, _t**2) * (_powers_to_basis(2) * sp.diag(*_WEIGHTS[:3])) * column(1, 1, 1))[0, 0],
                        evaluate=False,
                    )
                ),
            ),
        ),
        remark="The last product is right.",
    ),
    fails(
        "curvefitting.4",
        "The cubic curve with the weights a, b, c and d.",
        *parts(_CUBIC, *equations("curvefitting.4", None, _t >= 0, _t <= 1)),
        correction=corrected(
            "the third term has the factor 3",
            part(
                _CUBIC,
                formula(
                    sp.Eq(
                        letter("curvefitting.4", "B_{cubic}"),
                        sum(
                            n * w * (1 - _t) ** (3 - k) * _t**k
                            for k, (n, w) in enumerate(zip((1, 3, 3, 1), _WEIGHTS, strict=False))
                        ),
                        evaluate=False,
                    )
                ),
            ),
        ),
        consequence=_weakened,
    ),
    holds(
        "curvefitting.5",
        "The cubic curve, expanded and arranged by powers of t and by weights.",
        *parts(_CUBIC, *equations("curvefitting.5")),
        remark="It is not the expansion of curvefitting.4 as printed.",
    ),
    holds(
        "curvefitting.6",
        "The cubic curve as the powers of t times a matrix times its weights.",
        *parts(_CUBIC, *equations("curvefitting.6")),
    ),
    holds(
        "curvefitting.7",
        "The same for degree 4.",
        *parts(_QUARTIC, *equations("curvefitting.7")),
    ),
    definition("curvefitting.8", "The points in a column.", "the points that are to be fitted"),
    definition(
        "curvefitting.9",
        "The distance along the polygon: 0 at the first point, and at each further one longer by the step to it.",
        "the distances along the polygon",
    ),
    definition(
        "curvefitting.10",
        "Each distance divided by the last one, so that the last parameter is 1.",
        "the parameters of the points",
        "That the last one is 1 follows, unless all points are the same.",
    ),
    definition(
        "curvefitting.11", "The squared distance of a point from the curve at its parameter.", "the error there"
    ),
    definition("curvefitting.12", "The sum of these over all points.", "the error of a curve"),
    holds(
        "curvefitting.13",
        "The error is the square of the points less the product of powers, matrix and weights.",
        *parts(
            of_changed(
                _least_squares("curvefitting.13", "T"),
                _as_sum_of_squares,
                "the square of a column as the sum of the squares in it, T with a row for each point",
            ),
            *equations("curvefitting.13"),
        ),
        remark="A column has no square, and T as it was printed has one row: both are shorthand, which the text itself "
        "replaces in curvefitting.14 and curvefitting.15.",
    ),
    holds(
        "curvefitting.14",
        "The same, the square as a product of the transposed with itself.",
        *parts(
            _least_squares("curvefitting.14", "T"),
            *equations("curvefitting.14"),
        ),
        remark="With T for the matrix that has a row for each point, as the text goes on to say.",
    ),
    fails(
        "curvefitting.15",
        "For n points, and so a curve of order n - 1, the matrix of powers has a row for each point, from 1 to the "
        "n-th "
        "power of its parameter.",
        part(
            identity(where={_last: _s ** (_count - 1)}, method="the last power against the order of the curve"),
            formula(sp.Eq(_last, _s**_count, evaluate=False)),
        ),
        correction=corrected(
            "the last power is n - 1: as printed the matrix has n + 1 columns, and M, of n rows, does not fit behind "
            "it",
            part(
                identity(where={_last: _s ** (_count - 1)}), formula(sp.Eq(_last, _s ** (_count - 1), evaluate=False))
            ),
        ),
    ),
    holds(
        "curvefitting.16",
        "The error with the matrix of powers at the parameters.",
        *parts(
            _least_squares("curvefitting.16", "𝕋"),
            *equations("curvefitting.16"),
        ),
        remark="With n columns in that matrix, and not n + 1 as in curvefitting.15.",
    ),
    fails(
        "curvefitting.17",
        "The derivative of the error by the weights, which is to be 0, is -2 times the transposed matrix of powers "
        "times "
        "what is left at the points.",
        part(
            _least_squares("curvefitting.17", "𝕋"),
            _gradient(steps("curvefitting.17")[1].right),
        ),
        correction=corrected(
            "the transposed of M is missing in front of it",
            part(
                _least_squares("curvefitting.17", "𝕋"),
                _gradient(-2 * _M.T * _T.T * (_P - _T * _M * _C)),
            ),
        ),
        remark="M has an inverse, so that both vanish together: curvefitting.18, which is made of it, is right.",
    ),
    holds(
        "curvefitting.18",
        "The weights with the least error are the inverse of M times that of the squared matrix of powers times the "
        "transposed matrix of powers times the points.",
        *parts(
            of_changed(
                _least_squares("curvefitting.18", "𝕋"),
                _at_weights,
                "the gradient of curvefitting.17, corrected, at the weights that are printed",
            ),
            *equations("curvefitting.18"),
        ),
        remark="The inverse exists where there are at least as many different parameters as weights; with "
        "curvefitting.10 "
        "two points in the same place in succession have the same one.",
    ),
)
