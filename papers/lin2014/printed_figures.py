"""Printed knots, sizes and curves of the figures and of Table 1, as relations that the mutation check can perturb.

As in `printed`, nothing here is trusted. Where nothing else printed depends on a number, its changes are listed with
that reason: no check could tell them from what is printed.
"""

from __future__ import annotations

from typing import Any

from sympy import Add, Eq, Integer, Mul, Pow, Rational, symbols

from semispline.papers.ledger import Formula, Knots, Numbers, data_formula, inner_moves, near, number_changes
from semispline.papers.lin2014.printed import KNOTS, SIZES, B, u, v

# Fig. 11: control points of the contact curves on the cone and on the free-form surface, as the text has them.
CONE_COUNTS = (10, 64)


_ONCE = "the position of this inner knot is printed once, and no printed number depends on it: "
_MIDDLE = "only the knots of the middle curve follow from it, which are not printed"
_DEPENDS = {
    "fig-5.second": "the text changes this patch to {1/2} without saying how, and prints no control points",
    "fig-6.planar": _MIDDLE,
    "fig-6.curved": _MIDDLE,
    "fig-8.larger": _MIDDLE,
    "fig-8.smaller": _MIDDLE,
    "fig-10.second": "the blend has no middle curve, and that the knots are fifths is not said",
}


def _vector(key: str, knots: Knots) -> Formula:
    name = "V^r" if key in ("fig-5.first", "fig-6.planar", "fig-8.larger", "fig-10.first") else "V^s"
    if key not in _DEPENDS:
        return data_formula(name, knots)
    return data_formula(name, knots, _ONCE + _DEPENDS[key], inner_moves(knots))


VECTORS = {key: _vector(key, Knots(*knots)) for key, knots in KNOTS.items()}
BICUBIC = data_formula("k", Integer(4))
# Printed once more, in the comparison with [13].
COMMON_VECTOR_5 = data_formula("V", Knots(0, 0, 0, 0, Rational(1, 2), 1, 1, 1, 1))
SEVENTHS = data_formula("V_inner", Knots(*KNOTS["fig-10.first"][3:-4]))

_ROWS = (
    "how many rows of control points a base has across the contact is printed in Table 1 alone; (3.1) and cubics "
    "need no more than four"
)


def _size(figure: str, name: str, rows: int, columns: int) -> Formula:
    size = Numbers(rows, columns)
    # Figs. 8 and 9 share their bases, so that each size is printed twice.
    free = () if figure in ("fig-8", "fig-9") else [x for x in number_changes(size) if x[1] == columns and x[0] >= 4]
    return data_formula(name, size, _ROWS, free)


SIZE = {
    figure: tuple(_size(figure, name, *size) for name, size in zip(("N_r", "N_s"), pair, strict=True))
    for figure, pair in SIZES.items()
}
CONE_COUNTS_11 = data_formula("N", Numbers(*CONE_COUNTS))
# Middle curves of Figs. 5, 6, 8 to 11, as section 5 begins; for Figs. 10 and 11 their own paragraphs say it again.
_COUNTS = Numbers(1, 1, 1, 1, 0, 0)
NO_MIDDLE_CURVE_AGAIN = ("fig-10", "fig-11")
MIDDLE_CURVES = data_formula(
    "N",
    _COUNTS,
    "that this figure has a middle curve is said once, and no printed number depends on it",
    [x for x in number_changes(_COUNTS) if set(x) <= {0, 1} and x[4:] == _COUNTS[4:]],
)

# Fig. 3: x is the argument of the Bernstein polynomials. Control values between the first and the last one only bend a
# curve.
_INNER = "a control value that is neither the first nor the last: others enclose a region just as well"


def _argument(parameter: Any, offset: str, width: str) -> Any:
    # As printed, (v - 0.4)/0.2, not 5 v - 2.
    shifted = Add(parameter, -Rational(offset), evaluate=False)
    return Mul(shifted, Pow(Rational(width), -1, evaluate=False), evaluate=False)


def _bezier_function(value: Any, argument: Any, *coefficients: str) -> Formula:
    degree = len(coefficients) - 1
    given = list(map(Rational, coefficients))

    def relation(at: int = 0, changed: Any = given[0]) -> Any:
        values = [*given[:at], changed, *given[at + 1 :]]
        return Eq(value, Add(*(c * B(r, degree, argument) for r, c in enumerate(values))), evaluate=False)

    inner = [(r, changed) for r in range(1, degree) for changed in (*near(given[r]), 2 * given[r]) if changed < 1]
    undecidable = {str(relation(r, changed)): _INNER for r, changed in inner}
    return Formula(relation(), (value, *argument.free_symbols), undecidable=undecidable)


_SIDES = {
    # Name: value, parameter, offset and width of the argument, interval, control values.
    "left": (u, v, "0.4", "0.2", ("0.4", "0.6"), ("0.3", "0.1", "0.25")),
    "right": (u, v, "0.2", "0.3", ("0.2", "0.5"), ("0.8", "0.75")),
    "bottom": (v, u, "0.3", "0.5", ("0.3", "0.8"), ("0.4", "0.7", "0.1", "0.2")),
    "top": (v, u, "0.25", "0.5", ("0.25", "0.75"), ("0.6", "0.8", "0.3", "0.5")),
}
SIDE_CURVES = {name: _bezier_function(s[0], _argument(*s[1:4]), *s[5]) for name, s in _SIDES.items()}
SIDE_PARAMETERS = {
    name: Formula(Eq(symbols("x"), _argument(*s[1:4]), evaluate=False), (symbols("x"), s[1]))
    for name, s in _SIDES.items()
}
SIDE_INTERVALS = {name: data_formula(str(s[1]), Knots(*map(Rational, s[4]))) for name, s in _SIDES.items()}
# Semi-structured and ordinary pieces of the trimmed patch.
PIECES = data_formula("N", Numbers(4, 4))
# The patch is first divided at these values of v.
FIRST_SPLIT = data_formula("v", Knots(Rational("0.4"), Rational("0.6")))
