"""What a printed formula does to a surface: a checked blend whose rows are set anew by the formula, then measured.

The pair is the made one of `examples`, unless another is given.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import sympy as sp

from semispline.papers.ledger import Consequence, Formula
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.contact_rows import Side, t_ks1, u_before, u_last, w_kr1
from semispline.papers.lin2014.examples.made_pair import made_pair
from semispline.papers.reproduction import cad_verdict, turn_between
from semispline.solver.blending import BlendResult, blend, make_side
from semispline.solver.judge import Base, measure_contact
from semispline.solver.options import Continuity
from semispline.solver.splines import BSplineCurve, BSplineSurface, SemiStructuredSurface, insert_knots

ROWS_BY_SIDE = {"start": (pr.P_0, pr.P_1, pr.P_2), "end": (pr.P_m, pr.P_m1, pr.P_m2)}


@cache
def made_blend(continuity: Continuity = "G2") -> BlendResult:
    """Return the blend of the made pair with one middle curve, whose contact the referee has confirmed."""
    return _blend_of(made_pair, continuity)


@cache
def _blend_of(pair: Callable[[], tuple[Base, Base]], continuity: Continuity) -> BlendResult:
    return blend(*pair(), continuity=continuity, alpha="energy")


def with_printed_rows(
    pair: tuple[Base, Base], result: BlendResult, side: Side, formulas: Mapping[int, Formula]
) -> SemiStructuredSurface:
    """Return the blend of a pair with some rows next to one contact set by formulas.

    Parameters
    ----------
    pair : (Base, Base)
    result : BlendResult
        Gives alpha, beta, knots and the rows that are kept.
    side : {"start", "end"}
    formulas : mapping
        Row, counted from the contact -> formula whose right-hand side gives it. Taken in ascending order, so that a
        formula sees the rows that the one before it has set.
    """
    surface = result.surface
    base = make_side(pair[0 if side == "start" else 1], "C2")
    values = _numbers(result, side, base.degree, base.spans)
    rows = [np.array(curve.control_points) for curve in surface.control_curves]
    place = (lambda i: i) if side == "start" else (lambda i: len(rows) - 1 - i)
    base_symbols = (pr.R_0, pr.R_1, pr.R_2) if side == "start" else (pr.S_0, pr.S_1, pr.S_2)
    for row, formula in sorted(formulas.items()):
        right = formula.relation.rhs
        points = dict(zip(base_symbols, base.rows, strict=True))
        points |= {symbol: rows[place(i)] for i, symbol in enumerate(ROWS_BY_SIDE[side])}
        used = sorted(right.free_symbols, key=str)
        evaluate = sp.lambdify(used, right, "numpy")
        rows[place(row)] = evaluate(*(points[s] if s in points else values[s] for s in used))
    curves = [BSplineCurve(c.degree, c.knots, points) for c, points in zip(surface.control_curves, rows, strict=True)]
    return replace(surface, control_curves=tuple(curves))


def _numbers(result: BlendResult, side: Side, base_degree: int, spans: tuple[float, ...]) -> dict[Any, float]:
    """Return the number that each printed letter stands for in this blend."""
    surface = result.surface
    k, m = surface.degree_u + 1, len(surface.control_curves) - 1
    # The paper counts the inner knots of U as u_1 .. u_(m-k+1); past them come the ones of the clamped end.
    u = {i: float(surface.knots_u[k - 1 + i]) for i in range(-k + 1, m + 2)}
    a, b = result.alpha2, result.beta2
    if not isinstance(a, float) or not isinstance(b, float):
        raise ValueError("result: no shape parameters, expected a blend with C or G contact of order 1 or more")
    common = {pr.k: k, pr.u_1: u[1], pr.u_2: u[2], pr.u_m3: u[m - 3], u_last: u[m - k + 1], u_before: u[m - k]}
    if side == "start":
        start = {pr.k_r: base_degree + 1, pr.alpha: a**0.5, pr.w_s: 0.0, pr.w_kr: spans[0], w_kr1: spans[1]}
        return common | start
    return common | {pr.k_s: base_degree + 1, pr.beta: b**0.5, pr.t_s: 0.0, pr.t_ks: spans[0], t_ks1: spans[1]}


def measured_rows(
    side: Side,
    formulas: Mapping[int, Formula],
    what: str,
    continuity: Continuity = "G2",
    pair: Callable[[], tuple[Base, Base]] = made_pair,
) -> Consequence:
    """Set rows of a checked blend by formulas and measure what contact is left; for C2 the parametric residuals too."""
    result = _blend_of(pair, continuity)
    base_a, base_b = pair()
    surface = with_printed_rows((base_a, base_b), result, side, formulas)
    if side == "start":
        ends, flipped = (base_a, Base(surface, "u0")), False
        kept = result.contact_a
    else:
        ends, flipped = (Base(surface, "u1"), base_b), result.flipped
        kept = result.contact_b
    contact = measure_contact(*ends, flip="yes" if flipped else "no")
    measured = {
        "gap": contact.gap,
        "angle between tangent planes [degrees]": contact.angle_degrees,
        "turn of the normal across the contact [degrees]": turn_between(*ends, flipped=flipped),
        "curvature jump [1/length]": contact.curvature_jump,
        "relative curvature jump": contact.curvature_jump_relative,
    }
    corrected = {"relative curvature jump": kept.curvature_jump_relative}
    if continuity == "C2":
        measured["relative C1 residual"] = contact.c1_residual
        measured["relative C2 residual"] = contact.c2_residual
        corrected["relative C2 residual"] = kept.c2_residual
    return on_surface(what, measured, corrected, {"Open CASCADE": cad_verdict(*ends, flipped=flipped)})


def rewritten_base(formulas: Mapping[int, Formula]) -> Consequence:
    """Set rows at one base of the made pair, written in three ways, by formulas, and measure the curvature jumps."""
    result = _blend_of(made_pair, "G2")
    base, other = made_pair()
    if not isinstance(base.surface, BSplineSurface) or not isinstance(result.alpha2, float):
        raise ValueError("made pair: expected a B-spline surface and one alpha")
    across = f"knots_{base.edge[0]}"
    knots = getattr(base.surface, across)
    first, second = np.unique(knots)[:2] if base.edge[1] == "0" else np.unique(knots)[-2:]
    inserted = insert_knots(base.surface, **{across: [(first + second) / 2]})
    measured = {}
    for name, surface, factor in (
        ("as it is", base.surface, 1.0),
        ("in units half as long", replace(base.surface, **{across: 2 * knots}), 2.0),
        ("with one knot inserted", inserted, 1.0),
    ):
        written = Base(surface, base.edge)
        same = replace(result, alpha2=factor * result.alpha2)
        blended = with_printed_rows((written, other), same, "start", formulas)
        contact = measure_contact(written, Base(blended, "u0"), flip="no")
        measured[f"relative curvature jump, the base {name}"] = contact.curvature_jump_relative
    return on_surface("The made pair with rows 1 and 2 as printed; one base, written in three ways", measured)
