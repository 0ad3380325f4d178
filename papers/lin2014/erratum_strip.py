"""The example of the erratum: a strip of a parabolic cylinder, cut out and blended back, by (3.1) in each reading.

The section is z = (x - x^2)/2, cut out between x = 0 and x = 1. k = k_r = k_s = 4, U uniform without a middle curve, so
that all six rows are set by the contacts, and alpha = beta = 1. Both bases have inner knots at distances 1 and 3 from
their contacts. The blend that goes on with both bases is the cylinder itself, in the parameter x.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Literal

import numpy as np
import sympy as sp
from scipy.interpolate import BSpline

from semispline.papers.ledger import as_fraction
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_rows import t_ks1, u_before, u_last, w_kr1
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_3_1, TRUE_3_2
from semispline.papers.lin2014.printed import CUBIC

ReadingOf31 = Literal["printed", "squared", "right"]
GAP, SLOPE, BEND = 1, Fraction(1, 2), Fraction(1, 2)
SPANS = (1, 3)
KNOTS = (*[Fraction(0)] * 4, Fraction(1, 3), Fraction(2, 3), *[Fraction(1)] * 4)
_ROW_2 = {
    "printed": (pr.COND_3_1, pr.COND_3_2),
    "squared": (pr.COND_3_1_SQUARES, pr.COND_3_2_SQUARES),
    "right": (TRUE_3_1, TRUE_3_2),
}
Point = tuple[Fraction, Fraction]
# x of the picture.
_SHOWN = (-0.4, 1.4)


def height(x: Fraction) -> Fraction:
    """Return z of the section."""
    return SLOPE * x - BEND * x**2


def base_rows() -> tuple[Point, ...]:
    """Return R_0, R_1, R_2 as (x, z): blossoms of the section, whose parameter is w = -x."""
    triples = ((0, 0, 0), (0, 0, SPANS[0]), (0, *SPANS))
    found = []
    for a, b, c in triples:
        mean, product = Fraction(a + b + c, 3), Fraction(a * b + a * c + b * c, 3)
        found.append((-mean, -SLOPE * mean - BEND * product))
    return tuple(found)


def blend_rows(reading: ReadingOf31) -> list[Point]:
    """Return all six rows of the blend as (x, z), by the conditions of section 3 with (3.1), (3.2) in a reading."""
    at_r = base_rows()
    at_s = tuple((GAP - x, z) for x, z in at_r)
    numbers: dict[Any, Any] = {pr.k: CUBIC, pr.k_r: CUBIC, pr.k_s: CUBIC, pr.alpha: 1, pr.beta: 1, pr.w_s: 0, pr.t_s: 0}
    numbers |= {pr.u_1: sp.Rational(1, 3), pr.u_2: sp.Rational(2, 3), pr.w_kr: SPANS[0], w_kr1: SPANS[1]}
    numbers |= {pr.u_m3: sp.Rational(2, 3), u_last: sp.Rational(2, 3), u_before: sp.Rational(1, 3)}
    numbers |= {pr.t_ks: SPANS[0], t_ks1: SPANS[1]}
    second = _ROW_2[reading]
    sides = (
        ((pr.R_0, pr.R_1, pr.R_2), at_r, (pr.COND_1_1, pr.COND_2_1, second[0])),
        ((pr.S_0, pr.S_1, pr.S_2), at_s, (pr.COND_1_2, pr.COND_2_2, second[1])),
    )
    rows = []
    for letters, points, conditions in sides:
        coordinates = []
        for c in range(2):
            values = numbers | {s: sp.Rational(str(p[c])) for s, p in zip(letters, points, strict=True)}
            for condition in conditions:
                values[condition.relation.lhs] = condition.relation.rhs.subs(values)
            coordinates.append([as_fraction(values[condition.relation.lhs]) for condition in conditions])
        rows.append(list(zip(*coordinates, strict=True)))
    return [*rows[0], *rows[1][::-1]]


def curvature_ratio(reading: ReadingOf31) -> Fraction:
    """Return P_uu over alpha^4 R_ww along the normal at the contact, exactly."""
    (_, z_0), (_, z_1), (x_2, z_2) = blend_rows(reading)[:3]
    x_1 = blend_rows(reading)[1][0]
    # Second derivative of a clamped cubic with its first knots at 1/3 and 2/3.
    second = [18 * (Fraction(3, 2) * (c - b) - 3 * (b - a)) for a, b, c in ((Fraction(0), x_1, x_2), (z_0, z_1, z_2))]
    # Less its part along P_u, which is (1, 1/2): the height over the tangent.
    return (second[1] - SLOPE * second[0]) / (-2 * BEND)


def picture() -> str:
    """Return the section and its curvature as SVG."""
    left, right = _Panel(40, 330, _SHOWN, (-0.32, 0.22)), _Panel(390, 680, _SHOWN, (-2.0, 4.0))
    parts = [left.frame("x", "z", "the section"), right.frame("x", "", "its curvature, downwards")]
    for panel, values in ((left, _section), (right, _bend)):
        for ends in ((_SHOWN[0], 0.0), (1.0, _SHOWN[1])):
            parts.append(panel.line(*values(np.linspace(*ends, 25)), "#2b7a3b", 4.0))
    for reading, colour, width in (("printed", "#b03a2e", 2.0), ("squared", "#d99a00", 2.0), ("right", "#1f5fa8", 2.0)):
        curve, bend = _blend_lines(blend_rows(reading))  # type: ignore[arg-type]
        parts += [left.line(*curve, colour, width), right.line(*bend, colour, width)]
    for panel in (left, right):
        parts += [panel.mark(0.0), panel.mark(1.0)]
    legend = (
        ("#2b7a3b", "both bases"),
        ("#b03a2e", "(3.1), (3.2) as printed"),
        ("#d99a00", "with squares"),
        ("#1f5fa8", "right: the cylinder"),
    )
    for n, (colour, words) in enumerate(legend):
        x = 40 + 165 * n
        parts.append(f"<line x1='{x}' x2='{x + 22}' y1='238' y2='238' stroke='{colour}' stroke-width='3'/>")
        parts.append(f"<text x='{x + 28}' y='242'>{words}</text>")
    title = "A strip of a parabolic cylinder, blended back by three versions of (3.1)"
    return (
        f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 700 252' role='img' aria-label='{title}' "
        "font-family='sans-serif' font-size='12'><rect width='700' height='252' fill='white'/>"
        f"{''.join(parts)}</svg>\n"
    )


Line = tuple[Sequence[float], Sequence[float]]


def _section(x: Any) -> Line:
    return x, float(SLOPE) * x - float(BEND) * x**2


def _bend(x: Any) -> Line:
    slope = float(SLOPE) - 2 * float(BEND) * x
    return x, 2 * float(BEND) / (1 + slope**2) ** 1.5


def _blend_lines(rows: Sequence[Point]) -> tuple[Line, Line]:
    u = np.linspace(0.0, 1.0, 91)
    spline = BSpline([float(t) for t in KNOTS], np.array([[float(c) for c in row] for row in rows]), CUBIC - 1)
    (x, z), (x_1, z_1), (x_2, z_2) = (spline(u, d).T for d in range(3))
    return (x, z), (x, (z_1 * x_2 - x_1 * z_2) / np.hypot(x_1, z_1) ** 3)


class _Panel:
    """A frame with a linear scale each way."""

    def __init__(self, start: int, end: int, x: tuple[float, float], y: tuple[float, float]) -> None:
        self.start, self.end, self.x, self.y = start, end, x, y
        self.top, self.bottom = 24, 198

    def _across(self, x: float) -> float:
        return self.start + (x - self.x[0]) / (self.x[1] - self.x[0]) * (self.end - self.start)

    def _up(self, y: float) -> float:
        return self.bottom - (y - self.y[0]) / (self.y[1] - self.y[0]) * (self.bottom - self.top)

    def line(self, x: Sequence[float], y: Sequence[float], colour: str, width: float) -> str:
        """Return a curve."""
        points = " ".join(f"{self._across(a):.1f},{self._up(b):.1f}" for a, b in zip(x, y, strict=True))
        return (
            f"<svg x='{self.start}' y='{self.top}' width='{self.end - self.start}' height='{self.bottom - self.top}' "
            f"viewBox='{self.start} {self.top} {self.end - self.start} {self.bottom - self.top}' overflow='hidden'>"
            f"<polyline points='{points}' fill='none' stroke='{colour}' stroke-width='{width}'/></svg>"
        )

    def mark(self, x: float) -> str:
        """Return the place of a contact."""
        at = self._across(x)
        return (
            f"<line x1='{at:.1f}' x2='{at:.1f}' y1='{self.top}' y2='{self.bottom}' stroke='#999' "
            f"stroke-dasharray='3 3'/><text x='{at:.1f}' y='{self.bottom + 14}' text-anchor='middle'>{x:g}</text>"
        )

    def frame(self, across: str, up: str, title: str) -> str:
        """Return the frame with its names and the line of zero."""
        zero = self._up(0.0)
        return (
            f"<text x='{(self.start + self.end) / 2:g}' y='15' text-anchor='middle' font-weight='bold'>{title}</text>"
            f"<rect x='{self.start}' y='{self.top}' width='{self.end - self.start}' height='{self.bottom - self.top}' "
            f"fill='none' stroke='#ccc'/><line x1='{self.start}' x2='{self.end}' y1='{zero:.1f}' y2='{zero:.1f}' "
            f"stroke='#ccc'/><text x='{self.start - 8}' y='{zero + 4:.1f}' text-anchor='end'>0</text>"
            f"<text x='{self.end}' y='{self.bottom + 14}' text-anchor='end'>{across}</text>"
            f"<text x='{self.start - 8}' y='{self.top + 10}' text-anchor='end'>{up}</text>"
        )
