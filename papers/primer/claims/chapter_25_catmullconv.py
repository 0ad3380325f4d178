"""Catmull-Rom splines as Bezier curves, and back."""

from __future__ import annotations

from itertools import pairwise
from math import dist
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import Consequence, Part, corrected, formula, part, parts
from semispline.papers.primer.checks.curves import column
from semispline.papers.primer.checks.following import entry_by_entry, of_changed
from semispline.papers.primer.printed import letter, steps, terms_of
from semispline.papers.primer.writing import equations, fails, holds

_t, _tau = letter("catmullconv.5", "t"), letter("catmullconv.5", "\\tau")
_P = [letter("catmullconv.5", f"P_{i}") for i in range(1, 5)]
_V = [letter("catmullconv.1", name) for name in ("V_1", "V_2", "V'_1", "V'_2")]
_POINTS = sp.MatrixSymbol("points", 4, 1)
_SEGMENT = sp.Function("segment", real=True)(_t)


def _ends(tangent: Any) -> list[Any]:
    """Return both ends of a segment and the derivatives there: `tangent` times the step from before to after each."""
    return [_P[1], _P[2], tangent * (_P[2] - _P[0]), tangent * (_P[3] - _P[1])]


def _bezier(ends: list[Any]) -> list[Any]:
    """Return the control points of the cubic curve with these ends: a derivative is 3 times a step of the polygon."""
    return [ends[0], ends[0] + ends[2] / 3, ends[1] - ends[3] / 3, ends[1]]


def _matrix(values: list[Any]) -> Any:
    """Return the matrix that makes values of the four points."""
    return sp.ImmutableMatrix(sp.Matrix(values).jacobian(_P))


# As the text introduces it: the derivative is half of the step over the tension. Its matrices have the tension itself.
_WITH_TENSION, _AS_IN_MATRICES = _ends(1 / (2 * _tau)), _ends(_tau / 2)
_CURVE = identity(
    where={
        sp.Function("CatmullRom(t)", real=True)(_t): de_casteljau(_bezier(_V), _t),
        _SEGMENT: de_casteljau(_bezier(_V), _t),
    }
)


def _with_tangents(tangent: Any) -> Any:
    """Return the check with V for ends and derivatives, and T for the matrix that makes them."""
    ends = _ends(tangent)
    where = dict(zip(_V, ends, strict=True))
    return identity(where={**where, letter("catmullconv.2", "T"): _matrix(ends)})


_SOUGHT = identity(
    where={
        letter("catmullconv.7", "A"): _matrix(_bezier(_AS_IN_MATRICES)),
        letter("catmullconv.9", "I"): sp.ImmutableMatrix(sp.eye(4)),
        _SEGMENT: de_casteljau(_bezier(_AS_IN_MATRICES), _t),
    },
    method="A from the control points of the segment, derivatives as in the matrices, against the print in normal form",
)
# A, set right: once as printed but for one entry, once with the tension where the text has it.
_ENTRY = _matrix(_bezier(_AS_IN_MATRICES))
_BOTH = _matrix(_bezier(_WITH_TENSION))


def _of(left: Any, right: Any) -> Any:
    return formula(sp.Eq(left, right, evaluate=False))


def _in_powers(identifier: str) -> Any:
    """Return a display without a relation, which is a number."""
    return terms_of(identifier)[0][0][0, 0]


def _turned(relation: Any) -> Any:
    """Return that the Bezier points of the spline that is printed are those at the start."""
    q = list(relation.rhs)
    ends = [q[1], q[2], (q[2] - q[0]) / 2, (q[3] - q[1]) / 2]
    return sp.Eq(relation.lhs, column(*_bezier(ends)), evaluate=False)


def _curves_apart(printed: list[Any], right: list[Any]) -> float:
    ways = ((0, 50, 100, 150), (0, 100, 100, 0))

    def curve(points: list[Any]) -> list[list[float]]:
        values = []
        for way in ways:
            here = dict(zip(_P, way, strict=True)) | {_tau: sp.Rational(1, 2)}
            values.append([float(sp.sympify(point).subs(here)) for point in points])
        return values

    one, other = curve(printed), curve(right)
    return max(dist(*([_point(way, n / 100) for way in ways] for ways in (one, other))) for n in range(101))


def _point(points: list[float], t: float) -> float:
    """Return a point of a curve in floating point."""
    while len(points) > 1:
        points = [a + t * (b - a) for a, b in pairwise(points)]
    return points[0]


_ON = "points (0, 0), (50, 100), (100, 100) and (150, 0), tension 1/2: largest distance at the same parameter"


def _of_tension() -> Consequence:
    return Consequence(
        f"the segment with the tension on the wrong side of the fraction; {_ON}",
        {"distance": _curves_apart(_bezier(_AS_IN_MATRICES), _bezier(_WITH_TENSION))},
    )


def _of_entry() -> Consequence:
    wrong = _bezier(_AS_IN_MATRICES)
    wrong[2] -= _P[2]
    return Consequence(
        f"the segment with a third control point that has lost its P_3; {_ON}",
        {"distance": _curves_apart(wrong, _bezier(_AS_IN_MATRICES))},
    )


def _tension_in(*relations: Any) -> tuple[Part, ...]:
    """Return the steps with one over the tension in the place of the tension."""
    return parts(
        _with_tangents(1 / (2 * _tau)),
        *(_of(r.lhs, r.rhs.xreplace({_tau: 1 / _tau})) for r in relations),
    )


_SET = _tau > 0, _t > 0, _t < 1
_STEP_3 = equations("catmullconv.3", None, _tau > 0)
_STEP_5 = equations("catmullconv.5", None, *_SET)
_BACK = terms_of("catmullconv.14")[1][0]

CLAIMS = (
    holds(
        "catmullconv.1",
        "A segment with given ends and derivatives there, as powers of t times a matrix times these four.",
        *parts(_CURVE, *equations("catmullconv.1")),
    ),
    holds(
        "catmullconv.2",
        "Ends and derivatives are a matrix T times the four points: the ends are the middle ones, the derivatives half "
        "the steps from the point before to the one after.",
        *parts(_with_tangents(sp.Rational(1, 2)), *equations("catmullconv.2")),
    ),
    fails(
        "catmullconv.3",
        "With a tension, the derivatives are half these steps over the tension; so the last two rows of T, but for the "
        "factor 1/2, have the tension in them.",
        *parts(_with_tangents(1 / (2 * _tau)), *_STEP_3),
        correction=corrected(
            "these two rows of T have one over the tension in them", *_tension_in(_STEP_3[1].relation)
        ),
        consequence=_of_tension,
        remark="Both are the same at tension 1 alone. All matrices up to catmullconv.11 have the tension where one "
        "over "
        "it belongs; catmullconv.12 and catmullconv.13 have it right.",
    ),
    holds(
        "catmullconv.4",
        "The segment of catmullconv.1 again.",
        part(_CURVE, _of(_SEGMENT, _in_powers("catmullconv.4"))),
    ),
    fails(
        "catmullconv.5",
        "The same with T times the four points for ends and derivatives.",
        *parts(_with_tangents(1 / (2 * _tau)), *_STEP_5),
        correction=corrected("with one over the tension in T", *_tension_in(_STEP_5[0].relation)),
        consequence=_of_tension,
    ),
    holds(
        "catmullconv.6",
        "Both matrices multiplied.",
        *parts(identity(), *equations("catmullconv.6")),
        remark="As a product; it has the tension of catmullconv.5 in it.",
    ),
    holds(
        "catmullconv.7",
        "The same curve is powers of t times the matrix of cubic Bezier curves times A times the four points.",
        *parts(_SOUGHT, *equations("catmullconv.7")),
    ),
    holds(
        "catmullconv.8",
        "So the matrices are the same.",
        *parts(_SOUGHT, *equations("catmullconv.8")),
    ),
    holds(
        "catmullconv.9",
        "A is the inverse of the Bezier matrix times the other one.",
        *parts(_SOUGHT, *equations("catmullconv.9")),
    ),
    fails(
        "catmullconv.10",
        "The entries of A.",
        part(
            entry_by_entry(_SOUGHT, 4, 4),
            formula(sp.Eq(letter("catmullconv.10", "A"), steps("catmullconv.10")[0].left, evaluate=False), _tau > 0),
        ),
        correction=corrected(
            "the third entry of the third row is 6 (before the factor 1/6)",
            part(_SOUGHT, _of(letter("catmullconv.10", "A"), _ENTRY)),
        ),
        consequence=_of_entry,
    ),
    fails(
        "catmullconv.11",
        "The segment as powers of t times the Bezier matrix times A, entry by entry, times the four points.",
        part(_SOUGHT, formula(sp.Eq(_SEGMENT, _in_powers("catmullconv.11"), evaluate=False), *_SET)),
        correction=corrected(
            "the same entry is 6 here too",
            part(
                _SOUGHT,
                _of(
                    _SEGMENT,
                    _in_powers("catmullconv.11") + sp.expand(3 * (1 - _t) * _t**2) * _P[2],
                ),
            ),
        ),
        consequence=_of_entry,
    ),
    fails(
        "catmullconv.12",
        "A and the points multiplied.",
        *parts(identity(), *equations("catmullconv.12", None, *_SET)),
        correction=corrected(
            "the points on the right are right; on the left A needs its entry 6, and one over the tension for the "
            "tension",
            part(
                identity(),
                _of(de_casteljau(list(_BOTH * column(*_P)), _t), equations("catmullconv.12")[0].relation.rhs),
            ),
        ),
        consequence=_of_tension,
    ),
    holds(
        "catmullconv.13",
        "The control points of the segment between the second and the third of four points of a Catmull-Rom spline "
        "with "
        "a tension.",
        part(
            identity(where={_POINTS: column(*_bezier(_WITH_TENSION))}),
            _of(_POINTS, terms_of("catmullconv.13")[1][0]),
        ),
    ),
    holds(
        "catmullconv.14",
        "The four points of a Catmull-Rom spline, tension 1, whose segment is a given cubic curve.",
        part(
            of_changed(
                identity(where={_POINTS: column(*_P)}), _turned, "the control points of the segment that is printed"
            ),
            _of(_POINTS, _BACK),
        ),
    ),
)
