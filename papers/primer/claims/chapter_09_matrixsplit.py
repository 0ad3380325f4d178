"""The points of both parts of a curve, by matrices."""

from __future__ import annotations

from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import Consequence, corrected, formula, part, parts
from semispline.papers.primer.checks.curves import basis, column, greatest_distance, part_of_curve
from semispline.papers.primer.checks.general import said_again
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import equations, fails, holds

_t, _z = (letter("matrixsplit.3", name) for name in "tz")
_POINTS = [letter("matrixsplit.3", f"P_{i}") for i in range(1, 5)]


def _curve(n: int, start: Any, end: Any) -> dict[str, Any]:
    """Return B(t) as the part of a curve of order n between two parameters, run through from 0 to 1."""
    return {"B(t)": lambda t: de_casteljau(_POINTS[: n + 1], start + (end - start) * t)}


def _powers_to_basis(n: int) -> Any:
    """Return the matrix by which powers of t become the polynomials of order n."""
    return sp.ImmutableMatrix(n + 1, n + 1, lambda i, j: sp.Poly(basis(n, j, _t), _t).coeff_monomial(_t**i))


_M = _powers_to_basis(2)
_Z = sp.diag(1, _z, _z**2).as_immutable()
# What becomes of the powers of t when z + (1 - z) t is put in.
_Z_REST = sp.ImmutableMatrix(3, 3, lambda i, j: sp.Poly((_z + (1 - _z) * _t) ** j, _t).coeff_monomial(_t**i))


def _mixing(start: Any, end: Any) -> Any:
    """Return the matrix that gives the points of a part of a quadratic curve, from values of the blossom."""
    unit = sp.eye(3)
    return sp.ImmutableMatrix(3, 3, lambda i, j: part_of_curve(list(unit.row(j)), start, end)[i])


_Q, _Q_REST = _mixing(0, _z), _mixing(_z, 1)
_FIRST = {**_curve(2, 0, _z), "M": _M, "Z": _Z, "Q": _Q}
_SECOND = {**_curve(2, _z, 1), "M": _M, "Z'": _Z_REST, "Q": _Q, "Q'": _Q_REST}


def _points(identifier: str, n: int, start: Any, end: Any) -> tuple[Any, ...]:
    """Return what a display of new points claims: that its sides are equal, and what they are."""
    [step] = steps(identifier)
    true = column(*part_of_curve(_POINTS[: n + 1], start, end))
    return (
        *parts(identity(), *equations(identifier)),
        part(identity(), formula(sp.Eq(true, step.right, evaluate=False))),
    )


def _chain(identifier: str, given: dict[str, Any]) -> tuple[Any, ...]:
    return parts(identity(), *equations(identifier, given))


_RIGHT_18 = tuple(
    formula(sp.Eq(_SECOND["B(t)"](_t), side[0, 0], evaluate=False))
    for side in (steps("matrixsplit.18", {**_SECOND, "Q": _Q_REST})[0].right, steps("matrixsplit.18", _SECOND)[1].right)
)

# The curve of control.2 without its last point.
_SAMPLE = ((120, 160), (35, 200), (220, 260))


def _consequence() -> Consequence:
    """Return what comes of M Q P where M Q' P is meant: the first part in the place of the second."""
    half = sp.Rational(1, 2)
    first, second = (
        list(zip(*(part_of_curve([p[c] for p in _SAMPLE], *ends) for c in (0, 1)), strict=True))
        for ends in ((0, half), (half, 1))
    )
    return Consequence(
        "second half of the quadratic curve with the points (120, 160), (35, 200), (220, 260), drawn with Q: distance "
        "to the true one at the same parameter, at 101 parameters, in units of the coordinates",
        {"greatest distance": greatest_distance(first, second)},
        {"greatest distance": 0.0},
    )


CLAIMS = (
    holds(
        "matrixsplit.1",
        "The quadratic curve as powers of t, times a matrix, times its points.",
        *_chain("matrixsplit.1", _curve(2, 0, 1)),
    ),
    holds(
        "matrixsplit.2",
        "The cubic curve as powers of t, times a matrix, times its points.",
        *_chain("matrixsplit.2", _curve(3, 0, 1)),
    ),
    holds(
        "matrixsplit.3",
        "The part of a quadratic curve up to z: z t in the place of t, and the powers of z as a matrix of their own.",
        *_chain("matrixsplit.3", _FIRST),
        remark="B(t) names the curve that is sought, which is the old one at z t.",
    ),
    holds(
        "matrixsplit.4",
        "The part of a cubic curve up to z, in the same way.",
        *_chain("matrixsplit.4", _curve(3, 0, _z)),
        remark="B(t) names the curve that is sought, which is the old one at z t.",
    ),
    holds("matrixsplit.5", "The part of a quadratic curve up to z, once more.", *_chain("matrixsplit.5", _FIRST)),
    holds("matrixsplit.6", "The same with letters for both matrices.", *_chain("matrixsplit.6", _FIRST)),
    holds(
        "matrixsplit.7",
        "The same with M times its inverse put before it, which changes nothing.",
        *_chain("matrixsplit.7", _FIRST),
    ),
    holds(
        "matrixsplit.8",
        "The same as powers of t, times M, times a matrix Q.",
        *_chain("matrixsplit.8", _FIRST),
    ),
    holds(
        "matrixsplit.9",
        "Q is the inverse of M times Z times M, which is the product of three matrices of numbers and z, which is one "
        "with entries in z - 1 and z.",
        *_chain("matrixsplit.9", _FIRST),
    ),
    holds(
        "matrixsplit.10",
        "Q may be applied to the points first.",
        *_chain("matrixsplit.10", _FIRST),
    ),
    holds("matrixsplit.11", "The same with numbers for M and Q.", *_chain("matrixsplit.11", _FIRST)),
    holds("matrixsplit.12", "The same with the new points written out.", *_chain("matrixsplit.12", _FIRST)),
    holds(
        "matrixsplit.13",
        "The part up to z as the part from 0 to z.",
        *_chain("matrixsplit.13", _FIRST),
    ),
    holds("matrixsplit.14", "Its powers of z as a matrix of their own.", *_chain("matrixsplit.14", _FIRST)),
    holds(
        "matrixsplit.15",
        "The part of a quadratic curve from z on: z + (1 - z) t in the place of t.",
        *_chain("matrixsplit.15", _SECOND),
    ),
    holds("matrixsplit.16", "Its powers as a matrix of their own.", *_chain("matrixsplit.16", _SECOND)),
    holds(
        "matrixsplit.17",
        "Q' is the inverse of M times Z' times M, which is the product of three matrices, which is one with entries in "
        "z - 1 and z.",
        part(identity(), equations("matrixsplit.17", _SECOND)[0]),
        *parts(
            identity(),
            *(said_again(e, {}, "what is changed is zero") for e in equations("matrixsplit.17", _SECOND)[1:]),
        ),
    ),
    fails(
        "matrixsplit.18",
        "The part from z on is given by M Q applied to the points, and Q' may be applied to them first.",
        *parts(identity(), *equations("matrixsplit.18", _SECOND, _t >= 0, _t <= 1, _z > 0, _z < 1)),
        correction=corrected(
            "Q' in both places: B(t) = (1, t, t^2) M Q' P = (1, t, t^2) M (Q' P)", *parts(identity(), *_RIGHT_18)
        ),
        consequence=_consequence,
        remark="The prime is missing on the left: as printed both sides are the two parts of the curve, one each.",
    ),
    holds("matrixsplit.19", "The part from z on with numbers for M and Q'.", *_chain("matrixsplit.19", _SECOND)),
    holds("matrixsplit.20", "The same with the new points written out.", *_chain("matrixsplit.20", _SECOND)),
    holds(
        "matrixsplit.21",
        "The points of the part of a quadratic curve up to z.",
        *_points("matrixsplit.21", 2, 0, _z),
    ),
    holds(
        "matrixsplit.22",
        "The points of the part of a quadratic curve from z on.",
        *_points("matrixsplit.22", 2, _z, 1),
    ),
    holds(
        "matrixsplit.23",
        "The points of the part of a cubic curve up to z.",
        *_points("matrixsplit.23", 3, 0, _z),
    ),
    holds(
        "matrixsplit.24",
        "The points of the part of a cubic curve from z on.",
        *_points("matrixsplit.24", 3, _z, 1),
    ),
)
