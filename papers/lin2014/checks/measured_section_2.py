"""What the misprints of section 2 do to a surface: exactly on a patch that stands for Fig. 3, and on the made pair."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from semispline.derivations.bezier import de_casteljau, division_curve, division_rows
from semispline.papers.ledger import Consequence
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.measured_rows import made_blend
from semispline.solver.judge import curve_points

# A bicubic patch over the unit square, one number a coordinate, and the Bezier function that divides it.
_HEIGHTS = ((0, 50, 10, 40), (50, 150, 30, 80), (20, -40, 150, 70), (60, 40, 90, 0))
_FUNCTION = tuple(Fraction(x) for x in ("0.3", "0.95", "0.2", "0.6"))
_PATCH = "The bicubic patch that stands for Fig. 3 (extent 2.4), divided by a cubic Bezier function"


@cache
def _nets() -> tuple[list[list[Fraction]], ...]:
    return (
        [[Fraction(8 * i, 10)] * 4 for i in range(4)],
        [[Fraction(2 * j, 3) for j in range(4)] for _ in range(4)],
        [[Fraction(3 * z, 500) for z in row] for row in _HEIGHTS],
    )


def _largest_change(wrong: Any, true: Any) -> float:
    """Return the largest distance of two versions of the top sub-patch; each gives rows for a net of one coordinate."""
    worst = 0.0
    rows = [(wrong(net), true(net)) for net in _nets()]
    for u in (Fraction(r, 12) for r in range(13)):
        across = [(_points_at(a, u), _points_at(b, u)) for a, b in rows]
        for w in (Fraction(r, 12) for r in range(13)):
            distance = [float(de_casteljau(a, w) - de_casteljau(b, w)) for a, b in across]
            worst = max(worst, float(np.linalg.norm(distance)))
    return worst


def _points_at(rows: Any, u: Fraction) -> list[Fraction]:
    return [de_casteljau(row, u) if row else Fraction(0) for row in rows]


def top_last_row() -> Consequence:
    """Take the printed name of the last row of the top sub-patch at its word."""

    def wrong(net: Any) -> Any:
        return [*division_rows(net, _FUNCTION, "top")[:-1], division_curve(net, _FUNCTION, 0, 3)]

    change = _largest_change(wrong, lambda net: division_rows(net, _FUNCTION, "top"))
    return on_surface(
        f"{_PATCH}: with Q_0^n as last row the far edge of the top sub-patch falls on the dividing curve",
        {"largest displacement": change},
    )


def missing_first_row() -> Consequence:
    """Take for rows with s = 0, which the printed range does not define, what a reader takes: those of the patch."""

    def read(net: Any) -> Any:
        return [*division_rows(net, _FUNCTION, "top")[:-1], [column[-1] for column in net]]

    change = _largest_change(read, lambda net: division_rows(net, _FUNCTION, "top"))
    # Exact, so that zero is no rounding: a whole number.
    return on_surface(
        f"{_PATCH}: a reader takes the edge v = 1 of the patch for Q_n^0, with its m + 1 points, and loses nothing",
        {"largest displacement": change or 0},
    )


def one_function_for_all() -> Consequence:
    """Evaluate a v-control curve with the family B_{i,l}, j = 0 .. n_i: one function for all control points."""
    curve = made_blend().surface.control_curves[3]
    v = np.linspace(curve.knots[0], curve.knots[-1], 41)
    unit = np.eye(len(curve.control_points))[3]
    function = curve_points(curve.degree, curve.knots, unit[:, None], v)
    wrong = function * curve.control_points.sum(axis=0)
    change = np.linalg.norm(wrong - curve_points(curve.degree, curve.knots, curve.control_points, v), axis=1).max()
    return on_surface(
        "The middle curve of the made pair's blend (extent 8), each control point weighted by B_3",
        {"largest displacement": float(change)},
    )
