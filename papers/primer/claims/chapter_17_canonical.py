"""A cubic curve brought to three points (0, 0), (0, 1) and (1, 1): the fourth one says what it is like."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import formula, part, parts, reading
from semispline.papers.primer.checks.curves import column
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import ambiguous, equations, holds, holds_if

_x, _y, _z, _a, _b, _S = (letter("canonical.4", name) for name in ("x", "y", "z", "a", "b", "S"))
# A parameter, and the one at which the curve comes back to where it was.
_s = sp.Symbol("s", positive=True)


def _fourth(*conditions: Any) -> dict[Any, Any]:
    """Return the fourth point, from two equations between its coordinates."""
    [found] = sp.linsolve([sp.numer(sp.together(c)) for c in conditions], _x, _y)
    return {_x: sp.factor(found[0]), _y: sp.factor(found[1])}


def _coordinates(t: Any) -> tuple[Any, Any]:
    return tuple(de_casteljau(list(points), t) for points in ((0, 0, 1, _x), (0, 1, 1, _y)))


# No speed at s; the end once more at s; the start once more at s, where s is left out that solves each of them.
_CUSP = _fourth(*(c.diff(_s) for c in _coordinates(_s)))
_AT_END = _fourth(*(sp.cancel((c - end) / (1 - _s)) for c, end in zip(_coordinates(_s), (_x, _y), strict=True)))
_AT_START = _fourth(*(sp.cancel(c / _s) for c in _coordinates(_s)))


def _limit(identifier: str, place: int) -> Any:
    """Return a number of the condition that is printed behind a boundary."""
    side: Any = steps(identifier)[0].step.conditions[0].sides[place]
    return sp.Rational(side.text)


def _range(limit: Any, known: Any, rest: Any) -> Any:
    """Return that a limit minus the coordinate x is something that runs from 0 on as s runs from 1 or to it."""
    return part(identity(), formula(sp.Eq(limit - known[_x], rest, evaluate=False), _s <= 1))


_ROOT = equations("canonical.2")[0].relation
# Both sides without the root, which says the same up to its sign, and that sign at three points.
_SQUARES = formula(sp.Eq((2 * _y + _x) ** 2, (2 * _ROOT.rhs + _x) ** 2, evaluate=False))


def _at(value: Any) -> dict[Any, Any]:
    return {name: known.xreplace({_s: value}) for name, known in _AT_END.items()}


_P1, _U2, _V3, _W3 = (
    tuple(letter("canonical.7", f"{{{name}}}_{c}") for c in "xy" if (name, c) != ("V_3", "y"))
    for name in ("P_1", "U_2", "V_3", "W_3")
)
_V2 = letter("canonical.8", "{V_2}_y")
_V3_Y = sp.Symbol("{V_3}_y", real=True)


def _product(*factors: Any) -> Any:
    return sp.MatMul(*factors, evaluate=False)


# canonical.4 and .5, transcribed by hand: 01 stands where 1 is meant, and z = 1 within a column.
def _moved(by: tuple[Any, Any]) -> Any:
    return sp.ImmutableMatrix([[1, 0, by[0]], [0, 1, by[1]], [0, 0, 1]])


_MOVE = (
    _product(_moved((_a, _b)), column(_x, _y, _z)),
    column(1 * _x + 0 * _y + _a * _z, 0 * _x + 1 * _y + _b * _z, 0 * _x + 0 * _y + 1 * _z),
    column(_x + _a * 1, _y + _b * 1, 1 * _z),
    column(_x + _a, _y + _b, 1),
)
_MOVE_FIRST = (
    _product(_moved((-_P1[0], -_P1[1])), column(_x, _y, 1)),
    column(1 * _x + 0 * _y - _P1[0] * 1, 0 * _x + 1 * _y - _P1[1] * 1, 0 * _x + 0 * _y + 1 * 1),
    column(_x - _P1[0], _y - _P1[1], 1),
)


def _steps(sides: tuple[Any, ...]) -> tuple[Any, ...]:
    return tuple(formula(sp.Eq(a, b, evaluate=False)) for a, b in pairwise(sides))


def _takes(identifier: str, points: tuple[Any, ...], to: tuple[Any, ...]) -> Any:
    """Return that a printed matrix takes plane points to others; all have 1 for a third coordinate."""
    [step] = steps(identifier)
    before, after = (sp.ImmutableMatrix([[p[0] for p in q], [p[1] for p in q], [1] * len(q)]) for q in (points, to))
    return formula(sp.Eq(after, _product(step.right, before), evaluate=False))


_X, _Y = ([letter("canonical.10", f"{c}_{i}") for i in range(1, 5)] for c in "xy")


def _mapped() -> Any:
    """Return where the fourth point comes to lie, by its coordinates along the sides of the triangle of the others."""
    share, other = sp.symbols("α β")
    sides = [c[0] + share * (c[2] - c[0]) + other * (c[1] - c[0]) - c[3] for c in (_X, _Y)]
    [found] = sp.linsolve(sides, share, other)
    return column(found[0], found[0] + found[1])


_ORIGIN = {_X[0]: sp.Integer(0), _Y[0]: sp.Integer(0)}
_MAPPED = _mapped()
_FROM_ORIGIN = _MAPPED.xreplace(_ORIGIN)
_FLAT = {_Y[0]: 0, _Y[1]: 0}


def _unless(*excluded: dict[Any, int], where: Any = None) -> Any:
    """Return the check that sides are the same but where something printed is divided by zero."""
    return identity(
        where=where,
        each=[{}, *excluded],
        complete=True,
        own=lambda at: not at,
        meets=lambda at: not at,
        method="both sides carried out and compared in normal form, for all letters; where what is printed divides by "
        "zero it gives nothing",
    )


# canonical.11, transcribed by hand: the slash in the middle may divide all before it by all behind it, or as it stands.
_ABOVE, _BELOW = _X[3], _X[2]
_FOUR, _THREE = (_X[1] * _Y[i] / _Y[1] for i in (3, 2))
_WHOLE, _AS_IT_STANDS = (_ABOVE - _FOUR) / (_BELOW - _THREE), _ABOVE - _FOUR / _BELOW - _THREE


def _eleven(quotient: Any) -> Any:
    printed = column(quotient, _Y[3] / _Y[1] + (1 - _Y[2] / _Y[1]) * quotient)
    return formula(sp.Eq(_FROM_ORIGIN, printed, evaluate=False))


_F = [letter("canonical.12", f"f_{{{n}}}") for n in (32, 42)]
_TWELVE = formula(sp.Eq(_FROM_ORIGIN, steps("canonical.12")[0].right, evaluate=False))
_IN_TWELVE = {_F[0]: _Y[2] / _Y[1], _F[1]: _Y[3] / _Y[1], _x: _FROM_ORIGIN[0, 0]}

CLAIMS = (
    holds(
        "canonical.1",
        "With the fourth point (x, y) on this parabola, x at most 1, the curve has a cusp, and nowhere else.",
        *parts(identity(where=_CUSP), *equations("canonical.1")),
        _range(_limit("canonical.1", 1), _CUSP, 2 / _s - 2),
    ),
    holds(
        "canonical.2",
        "With the fourth point on this arc of an ellipse, x from 0 to 1, the curve passes through its own end.",
        part(identity(where=_AT_END), _SQUARES),
        *(part(identity(where=_at(sp.Rational(n, 3))), equations("canonical.2")[0]) for n in (1, 2)),
        _range(_limit("canonical.2", 0), _AT_END, -3 * _s**2 / (1 + _s + _s**2)),
        _range(_limit("canonical.2", 2), _AT_END, (1 - _s) * (1 + 2 * _s) / (1 + _s + _s**2)),
    ),
    holds(
        "canonical.3",
        "With the fourth point on this parabola, x at most 0, the curve passes through its own start.",
        *parts(identity(where=_AT_START), *equations("canonical.3")),
        _range(_limit("canonical.3", 1), _AT_START, 3 / _s - 3),
    ),
    holds(
        "canonical.4",
        "A plane point with a third coordinate 1 is moved by a matrix of size 3, and keeps that coordinate.",
        *parts(identity(where={_z: sp.Integer(1)}), *_steps(_MOVE)),
    ),
    holds(
        "canonical.5",
        "The matrix that moves the first point to the origin.",
        *parts(identity(), *_steps(_MOVE_FIRST)),
        part(
            identity(),
            formula(sp.Eq(column(0, 0, 1), _product(_moved((-_P1[0], -_P1[1])), column(*_P1, 1)), evaluate=False)),
        ),
        remark="T_1 names the matrix, not its product with the point that stands behind it.",
    ),
    holds(
        "canonical.6",
        "A matrix that adds to x a multiple of y.",
        *parts(identity(), *equations("canonical.6")),
    ),
    holds_if(
        "canonical.7",
        "The matrix of that kind that brings the second point, moved, above or below the origin.",
        "the first two points differ in y",
        part(_unless({_U2[1]: 0}), _takes("canonical.7", ((0, 0), _U2), ((0, 0), (0, _U2[1])))),
    ),
    holds_if(
        "canonical.8",
        "The matrix that then brings the second point to (0, 1), and the third one to x = 1.",
        "the first two points differ in y, and the first three are not on one line",
        part(
            _unless({_V2: 0}, {_V3[0]: 0}),
            _takes("canonical.8", ((0, 0), (0, _V2), (_V3[0], _V3_Y)), ((0, 0), (0, 1), (1, _V3_Y / _V2))),
        ),
    ),
    holds(
        "canonical.9",
        "The matrix that then brings the third point to (1, 1) and leaves the first two.",
        part(identity(), _takes("canonical.9", ((0, 0), (0, 1), _W3), ((0, 0), (0, 1), (_W3[0], 1)))),
        remark="The third point has x = 1 already, so that nothing is divided by zero.",
    ),
    holds_if(
        "canonical.10",
        "Where the fourth point comes to lie, for any four points.",
        "the first two points differ in y, and the first three are not on one line",
        part(_unless(_FLAT), formula(sp.Eq(_MAPPED, equations("canonical.10")[0].relation.rhs, evaluate=False))),
        remark="The curve is asked not to lie on one line, which is less. Where the first two points have one y and "
        "the first three are on no line, there is such a point, and the formula divides by zero.",
    ),
    ambiguous(
        "canonical.11",
        "The same with the first point in the origin.",
        reading(
            "all before the slash is divided by all behind it",
            part(_unless({_Y[1]: 0}), _eleven(_WHOLE)),
            condition="the first two points differ in y, and the first three are not on one line",
        ),
        reading("the slash divides what stands beside it", part(identity(), _eleven(_AS_IT_STANDS))),
        remark="canonical.10 and .12 have the first of both.",
    ),
    holds_if(
        "canonical.12",
        "The same with names for two quotients.",
        "the first two points differ in y, and the first three are not on one line",
        part(_unless({_Y[1]: 0}, where=lambda at: {k: v.xreplace(at) for k, v in _IN_TWELVE.items()}), _TWELVE),
    ),
)
