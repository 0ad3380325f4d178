"""A curve as a product of powers, a matrix of numbers and its points."""

from __future__ import annotations

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import formula, part, parts
from semispline.papers.primer.checks.curves import basis, row
from semispline.papers.primer.printed import letter, terms_of
from semispline.papers.primer.writing import equations, holds

_t = letter("matrix.1", "t")
_POINTS = [letter("matrix.1", f"P_{i}") for i in range(1, 5)]
_BASES = row(*(basis(3, i, _t) for i in range(4)))
_CUBIC, _QUADRATIC = ({"B(t)": lambda t, n=n: de_casteljau(_POINTS[:n], t)} for n in (4, 3))


def _four(terms: tuple[object, ...]) -> sp.Rel:
    """Return that four terms are the four polynomials, one by one."""
    return sp.Eq(_BASES, row(*terms), evaluate=False)


def _lines(identifier: str) -> sp.Rel:
    """Return that four lines of four terms each are the four polynomials, from the third power down to the constant."""
    [terms] = terms_of(identifier)
    # Each line is to stand for a polynomial, its terms in the order of falling powers.
    printed = sp.ImmutableMatrix(4, 4, list(terms))
    true = sp.ImmutableMatrix(4, 4, lambda i, j: sp.Poly(_BASES[i], _t).coeff_monomial(_t ** (3 - j)) * _t ** (3 - j))
    return sp.Eq(true, printed, evaluate=False)


# matrix.4, transcribed by hand: what each line is before and after it is expanded.
_FACTORS = row((1 - _t) * (1 - _t) * (1 - _t), 3 * (1 - _t) * (1 - _t) * _t, 3 * (1 - _t) * _t * _t, _t * _t * _t)
_EXPANDED = row(-(_t**3) + 3 * _t**2 - 3 * _t + 1, 3 * _t**3 - 6 * _t**2 + 3 * _t, -3 * _t**3 + 3 * _t**2, _t**3)

CLAIMS = (
    holds(
        "matrix.1",
        "The cubic curve with four points.",
        *parts(identity(), *equations("matrix.1", _CUBIC)),
    ),
    holds(
        "matrix.2",
        "Without the points: the four polynomials of the cubic curve.",
        part(identity(), formula(_four(*terms_of("matrix.2")))),
        remark="B(t) stands here for the row of its terms, not for the curve; their sum is 1.",
    ),
    holds(
        "matrix.3",
        "The same four polynomials, a line each.",
        part(identity(), formula(_four(*terms_of("matrix.3")))),
    ),
    holds(
        "matrix.4",
        "Each polynomial as a product of factors t and 1 - t, and expanded in powers of t.",
        part(identity(), formula(_four(tuple(_FACTORS)))),
        part(identity(), formula(sp.Eq(_FACTORS, _EXPANDED, evaluate=False))),
    ),
    holds(
        "matrix.5",
        "The same with all coefficients 0 and 1 written down, each line from the third power to the constant.",
        part(identity(), formula(_lines("matrix.5"))),
    ),
    holds(
        "matrix.6",
        "Each polynomial as the powers t^3, t^2, t, 1 times a column of coefficients.",
        part(identity(), formula(_four(tuple(term[0, 0] for term in terms_of("matrix.6")[0])))),
    ),
    holds(
        "matrix.7",
        "The row of the four polynomials as the powers of t times one matrix.",
        part(identity(), formula(_four(tuple(terms_of("matrix.7")[0][0])))),
    ),
    holds(
        "matrix.8",
        "The same with rising powers of t: the rows of the matrix in the opposite order.",
        part(identity(), formula(_four(tuple(terms_of("matrix.8")[0][0])))),
    ),
    holds(
        "matrix.9",
        "The cubic curve as powers of t, times the matrix, times its points.",
        *parts(identity(), *equations("matrix.9", _CUBIC)),
    ),
    holds(
        "matrix.10",
        "The quadratic curve as powers of t, times a matrix of size 3, times its points.",
        *parts(identity(), *equations("matrix.10", _QUADRATIC)),
        remark="The text behind it says that the determinant is the product of the coordinates. It is 2 here, and 9 in "
        "matrix.9: the product of the diagonal, with no coordinates in it.",
    ),
)
