"""Deciding whether a blend of closed contact curves closes at its seam, where v_s and v_e are one place.

Without a middle curve every row is a combination of rows of one base, with factors that do not depend on v: what closes
in the bases closes in the blend. A middle curve has ends of its own; (11) does not ask that they meet.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import sympy as sp

from semispline.derivations.contact import contact_rows
from semispline.derivations.energy import ExactSurface
from semispline.derivations.problem import ExactBase, blend_problem, exact_minimum
from semispline.derivations.splines import span_symbols
from semispline.papers.ledger import Case, Consequence, Formula, as_expression, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.converted_blends import pair_means
from semispline.papers.lin2014.checks.energy import basis, u_basis
from semispline.papers.lin2014.checks.measured_energy import COMMON_TERMS, with_normal_equation
from semispline.papers.lin2014.examples.section5 import example
from semispline.papers.lin2014.printed import CUBIC
from semispline.solver.blending import blend
from semispline.solver.judge import surface_points

# Jumps at the seam, from v_e to v_s, of a derivative by v: of rows of R and of row 1 of the blend, H and h first spans.
_J_0, _J_1, _J = sp.symbols("J_0 J_1 J", real=True)
JUMP_OF_ROW_1 = Formula(
    sp.Eq(_J, _J_0 + pr.alpha**2 * pr.u_1 * (pr.k_r - 1) / ((pr.w_kr - pr.w_s) * (pr.k - 1)) * (_J_0 - _J_1)),
    (_J, _J_0, _J_1, pr.alpha, pr.u_1, pr.k, pr.k_r, pr.w_kr, pr.w_s),
    (pr.u_1 > 0, pr.w_kr > pr.w_s, pr.k >= 2, pr.k_r >= 2),
)


def closing_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide what jumps at the seam in row 1, by the derived rows, and that rows 0 to 2 jump only where R does."""
    relation = given(formula).relation
    v, a = sp.symbols("v a", positive=True)
    matrix = contact_rows(2, pr.k - 1, span_symbols(2), pr.k_r - 1, span_symbols(2, "H"), a)
    yield Case("factors of rows do not depend on v", not matrix.has(v))
    rows = [sp.Function(f"R_{i}")(v) for i in range(3)]
    jumps = [sp.Function(f"R_{i}")(1) - sp.Function(f"R_{i}")(0) for i in range(3)]
    combined = list(matrix * sp.Matrix(rows))
    names = dict(zip(jumps, (_J_0, _J_1, sp.Symbol("J_2")), strict=True))
    across = [sp.expand(row.subs(v, 1) - row.subs(v, 0)) for row in combined]
    ends = {sp.Function(f"R_{i}")(1): jump + sp.Function(f"R_{i}")(0) for i, jump in enumerate(names.values())}
    of_rows = [sp.expand(row.subs(ends)) for row in across]
    closed = dict.fromkeys(names.values(), 0)
    yield Case(
        "rows 0 to 2 close where R_0 to R_2 do, in every derivative by v", all(row.subs(closed) == 0 for row in of_rows)
    )
    values = {a: pr.alpha**2, span_symbols(1)[0]: pr.u_1, span_symbols(1, "H")[0]: pr.w_kr - pr.w_s}
    residual = sp.cancel((relation.rhs - relation.lhs + _J) - of_rows[1].subs(values))
    yield Case("row 1, every order and knots", bool(residual == 0), residual=residual)


_INNER = ((Fraction(1, 3), Fraction(2, 3)), (Fraction(1, 4), Fraction(1, 2), Fraction(3, 4)))


def closed_points(inner: tuple[Fraction, ...], free: list[int]) -> list[Fraction]:
    """Return control points of a cubic over clamped knots that closes with two derivatives; the last three follow.

    Differences over the first two and the last two spans are set equal, backwards.
    """
    first, second = inner[0], inner[1]
    last, before = 1 - inner[-1], 1 - inner[-2]
    c = [Fraction(x) for x in free]
    slope = (c[1] - c[0]) / first
    bend = ((c[2] - c[1]) / second - slope) / first
    point_1 = c[0] - slope * last
    # (slope - (c_{n-1} - c_{n-2}) / before) / last is the second derivative at the end, over the same factor.
    point_2 = point_1 - before * (slope - bend * last)
    return [*c, point_2, point_1, c[0]]


@cache
def middle_curve() -> tuple[ExactSurface, tuple[Any, ...]]:
    """Return the bases of a blend with one middle curve between two closed contacts, and its heights of least energy.

    One coordinate square to the axes of two cylinders, so that no row differs from the contact curve: R_w has none.
    """
    curves = [basis(CUBIC, *inner) for inner in _INNER]
    middle = basis(CUBIC, *pair_means(sorted({*_INNER[0], *_INNER[1]})))
    surface = ExactSurface(u_basis(CUBIC, 6), (*[curves[0]] * 3, middle, *[curves[1]] * 3))
    across = basis(CUBIC)
    nets = (closed_points(_INNER[0], [0, 3, 1]), closed_points(_INNER[1], [1, 4, 0, -2]))
    sides = [
        ExactBase(across, tuple(tuple((as_expression(z), 0, i) for z in heights) for i in range(3))) for heights in nets
    ]
    _, points = exact_minimum(blend_problem(2, surface, *sides), 1, 1)
    return surface, tuple(point[0] for point in points)


def middle_ends() -> tuple[Any, Any]:
    """Return first and last control point of the middle curve of least energy between two closed contact curves."""
    surface, points = middle_curve()
    of_middle = [point for (i, _), point in zip(surface.index, points, strict=True) if i == 3]
    return of_middle[0], of_middle[-1]


def free_middle_cases() -> Iterator[Case]:
    """Yield a blend with a middle curve between closed contacts, true where least energy closes it."""
    start, end = middle_ends()
    yield Case(f"ends of the middle curve of least energy: {float(start):.4f} and {float(end):.4f}", bool(start == end))


def seam_gap() -> Consequence:
    """Measure the seam of blends between the closed curves that stand for Fig. 10, without and with a middle curve."""
    task = example(10)
    measured = {}
    for count in (0, 1):
        result = blend(task.a, task.b, continuity="C2", middle_curves=count, alpha="energy")
        surface = with_normal_equation(result, (*COMMON_TERMS, (1, (0, 2), (0, 2)))) if count else result.surface
        u = np.linspace(0.0, 1.0, 21)
        low, high = surface.domain[1]
        ends = [surface_points(surface, u, np.full_like(u, v)) for v in (low, high)]
        gap = float(np.linalg.norm(ends[0] - ends[1], axis=1).max())
        measured[f"gap at the seam, {count} middle curves [radius of the first cylinder]"] = gap / 40.0
    return on_surface("C2 blends between the closed curves that stand for Fig. 10, least energy (11) alone", measured)
