"""Running the conditions as printed on bases like those of section 5: k = k_r = 4, uniform u_i.

The paper prints no control points, nor knots across the contact. What can be decided is for which bases a printed
condition is right, exactly; the figures may show such bases.

(3.1) as printed gives the blend the second derivative across the contact that the base has, along the normal, times
(w_{k_r+1} - w_s) / u_2. So curvature stays continuous where the base is straight across the contact (zero times
anything), or where that factor is 1. Parametric continuity takes a base that is straight across and changes its
speed at the contact by just the right amount; at constant speed, the usual parametrisation, it is never reached.

For C2 the coordinates are decided one by one, so that one symbolic letter a row stands for any control points. For G2
only the coordinate along the normal counts: there R_0 and R_1 agree, since R_w is a multiple of R_1 - R_0 and tangent,
and R_2 is apart from them by as much as the base is curved.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from typing import Any, Literal

import sympy as sp

from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import (
    Case,
    Check,
    Counterexample,
    Formula,
    Meaning,
    Strength,
    UndefinedError,
    given,
    interpret,
    smallest_assignment,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_rows import Side, difference_form, t_ks1, u_before, u_last, w_kr1
from semispline.papers.lin2014.printed import CUBIC

# What a base is like across the contact. All coordinates are decided for any rows, for rows that step on straight lines
# as a condition says, as one example has them, or at constant speed (R_ww = 0); for the others the one along the
# normal, on bases that are curved across, with any knots or with spans as a condition says, or straight.
Kind = Literal[
    "any", "step", "step of squares", "faster", "turning back", "constant speed", "curved", "spans of U", "equal spans",
    "straight",
]  # fmt: skip

_BLEND = {"start": (pr.P_0, pr.P_1, pr.P_2), "end": (pr.P_m, pr.P_m1, pr.P_m2)}
_BASE = {"start": (pr.R_0, pr.R_1, pr.R_2), "end": (pr.S_0, pr.S_1, pr.S_2)}
_FIRST_ROW = {"start": pr.COND_2_1, "end": pr.COND_2_2}
_SHAPE = {"start": pr.alpha, "end": pr.beta}
_BASE_H = span_symbols(2, "H")


def _uniform(m: int) -> tuple[Any, Any]:
    """Return the distances of the first two inner knots from the contact, the same at both ends."""
    return sp.Rational(1, m - 2), sp.Rational(2, m - 2)


def at_figure(formula: Formula, m: int, *, parametric: bool) -> Formula:
    """Return a condition for k = k_r = k_s = 4 and uniform u_i, m + 1 curves; with alpha = beta = 1 if `parametric`."""
    h = _uniform(m)
    numbers = {pr.k: CUBIC, pr.k_r: CUBIC, pr.k_s: CUBIC, pr.u_1: h[0], pr.u_2: h[1]}
    numbers |= {pr.u_m3: 1 - h[0], u_last: 1 - h[0], u_before: 1 - h[1]}
    if parametric:
        numbers |= {pr.alpha: 1, pr.beta: 1}
    relation = formula.relation.subs(numbers)
    assumptions = tuple(a for a in formula.assumptions if not a.free_symbols & set(numbers))
    used = relation.free_symbols.union(*(a.free_symbols for a in assumptions))
    return Formula(relation, tuple(sorted(used, key=str)), assumptions, formula.neighbours)


def row_2_check(side: Side, m: int, kind: Kind, *, parametric: bool) -> Check:
    """Return the check of a condition for row 2 of a figure: P_uu against alpha^4 R_ww, for all rows of a kind."""
    what = "all coordinates" if kind == "any" else "the coordinate along the normal"
    method = (
        f"P_uu by row 2 against the base's second derivative, {what}; k = k_r = 4, uniform u_i as in the figure, any "
        "control points and knots of the base"
    )
    return _check(((f"any rows, {m + 1} curves", kind, True),), method, side, m, parametric)


def for_which_bases(side: Side, m: int, *, parametric: bool, squares: bool) -> Check:
    """Return the check of a printed condition for row 2 on the bases for which it is right, and on others.

    For C2 (`parametric`) all coordinates are compared, for G2 the one along the normal.
    """
    curves = f"{m + 1} curves"
    if parametric:
        step: Kind = "step of squares" if squares else "step"
        kinds: tuple[tuple[str, Kind, bool], ...] = (
            (f"rows that step as the condition says, any knots, {curves}", step, True),
            (f"any rows and knots, {curves}", "any", False),
            (f"rows of constant speed, any knots, {curves}", "constant speed", False),
        )
        if not squares:
            on_lines = "on a line, knots {} after the contact, " + curves
            kinds += ((f"rows 0, 1, 11 {on_lines.format('1/5 and 2/5')}", "faster", True),)
            kinds += ((f"rows 0, 3, 1 {on_lines.format('1 and 2')}", "turning back", True),)
    else:
        kinds = (
            (f"any rows, spans as the condition says, {curves}", "equal spans" if squares else "spans of U", True),
            (f"rows straight across, any knots, {curves}", "straight", True),
            (f"any other rows and knots, {curves}", "curved", False),
        )
    what = "all coordinates" if parametric else "the coordinate along the normal"
    method = (
        f"P_uu by row 2 against the base's second derivative, {what}, on the bases for which it is right and on all; "
        "k = k_r = 4, uniform u_i as in the figure, any control points and knots"
    )
    return _check(kinds, method, side, m, parametric)


def _check(kinds: tuple[tuple[str, Kind, bool], ...], method: str, side: Side, m: int, parametric: bool) -> Check:
    """Return the check of row 2 on bases of some kinds: label, kind, and whether the condition admits it."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        for label, kind, meets in kinds:
            case = _row_2_case(label, formula, side, m, kind, parametric)
            yield replace(case, own=meets, meets=meets)

    def probe(formula: Formula) -> Any:
        try:
            return [_residual(formula.relation.rhs, side, m, kind, parametric) for _, kind, _ in kinds]
        except UndefinedError as error:
            return str(error)

    return Check(cases, Strength.GENERAL, method, proof=True, probe=probe)


def _row_2_case(label: str, formula: Formula | None, side: Side, m: int, kind: Kind, parametric: bool) -> Case:
    try:
        residual = _residual(given(formula).relation.rhs, side, m, kind, parametric)
    except UndefinedError as error:
        return Case(label, False, residual=sp.Symbol(f"undefined: {error}"))
    if residual == 0:
        return Case(label, True, residual=sp.Integer(0))
    expression = residual.as_expr()
    shown = difference_form(expression, _BASE[side]) if kind == "any" else sp.factor(expression)
    return Case(label, False, residual=shown)


def _residual(row: Any, side: Side, m: int, kind: Kind, parametric: bool) -> Any:
    second, base, _ = _seconds(row, side, m, kind, parametric)
    return second - base


def _seconds(row: Any, side: Side, m: int, kind: Kind, parametric: bool) -> tuple[Any, Any, dict[Any, Any]]:
    """Return P_uu by row 2, alpha^4 R_ww, and what each letter stands for."""
    values, base = _letters(side, m, kind, parametric)
    values = dict(values)
    values[_BLEND[side][0]] = values[_BASE[side][0]]
    first = at_figure(_FIRST_ROW[side], m, parametric=parametric).relation.rhs
    values[_BLEND[side][1]] = interpret(first, Meaning(values))
    rows = [*(values[p] for p in _BLEND[side][:2]), interpret(row, Meaning(values))]
    ends = end_derivatives(2, CUBIC - 1, _uniform(m))
    second = sum(row * int(ends[2, i].p) / int(ends[2, i].q) for i, row in enumerate(rows))
    return second, base, values


@cache
def _letters(side: Side, m: int, kind: Kind, parametric: bool) -> tuple[dict[Any, Any], Any]:
    """Return what each letter stands for, in a field of rational functions, and alpha^4 R_ww."""
    spans = _spans_of(kind, m)
    start = pr.w_s if side == "start" else pr.t_s
    knots = (pr.w_kr, w_kr1) if side == "start" else (pr.t_ks, t_ks1)
    shape, base, last = _SHAPE[side], _BASE[side], _BLEND[side][2]
    field = sp.QQ.frac_field(*base, last, *_BASE_H, shape, start)
    of = {s: field.from_sympy(s) for s in (*base, last, shape, start)}
    if kind in ("curved", "straight", "equal spans", "spans of U"):
        of[base[1]] = of[base[0]]
    if kind == "straight":
        of[base[2]] = of[base[0]]
    if (step := _step_of(kind, m)) is not None:
        of[base[2]] = of[base[1]] + field.from_sympy(sp.sympify(step)) * (of[base[1]] - of[base[0]])
    if parametric:
        of[shape] = field.one
    of |= {knot: field.from_sympy(start + h) for knot, h in zip(knots, spans, strict=True)}
    ends = end_derivatives(2, CUBIC - 1, spans)
    second = sum((field.from_sympy(ends[2, i]) * of[base[i]] for i in range(3)), field.zero)
    return of, of[shape] ** 4 * second


def _spans_of(kind: Kind, m: int) -> tuple[Any, Any]:
    """Return the distances of the first two inner knots of a base from the contact."""
    if kind == "equal spans":
        return _BASE_H[0], 2 * _BASE_H[0]
    if kind == "spans of U":
        return _BASE_H[0], _uniform(m)[1]
    examples = {"faster": (sp.Rational(1, 5), sp.Rational(2, 5)), "turning back": (sp.Integer(1), sp.Integer(2))}
    return examples.get(kind, tuple(_BASE_H))


def _step_of(kind: Kind, m: int) -> Any:
    """Return the factor of R_1 - R_0 in R_2 - R_1, for rows on straight lines; None where they are any."""
    (u_1, u_2), (h_1, h_2) = _uniform(m), _BASE_H
    return {
        "step": u_2 * h_2 / (h_1 * (u_2 - h_2)),
        "step of squares": h_2 * (u_1 + h_1) / (u_1 * (2 * h_1 - h_2)),
        "faster": sp.Integer(10),
        "turning back": sp.Rational(-2, 3),
        "constant speed": h_2 / h_1,
    }.get(kind)


# P_uu - R_ww by (3.1) as printed and with squares, alpha = 1: zero exactly where R_2 - R_1 is the multiple of R_1 - R_0
# that the conditions below name, in every control point.
_D1, _D2 = pr.R_1 - pr.R_0, pr.R_2 - pr.R_1
_H1, _H2 = pr.w_kr - pr.w_s, w_kr1 - pr.w_s
_EXCESS_LETTERS = (pr.P_uu, pr.R_ww, pr.R_0, pr.R_1, pr.R_2, pr.w_kr, w_kr1, pr.w_s)
_EXCESS_CHAINS = (*pr.COND_3_1.neighbours, (pr.w_kr, w_kr1))


def excess_of_c2(m: int, *, squares: bool) -> Formula:
    """Return what (3.1) leaves of C2 in a figure, for any rows and knots of the base."""
    u_1, u_2 = _uniform(m)
    left = (
        3 * (_D1 * (u_1 + _H1) / u_1 - _D2 * (2 * _H1 - _H2) / _H2) / _H1**2
        if squares
        else 6 * (_D2 * (_H2 - u_2) / (u_2 * _H2) + _D1 / _H1) / _H1
    )
    return Formula(
        sp.Eq(pr.P_uu - pr.R_ww, left, evaluate=False), _EXCESS_LETTERS, (_H1 > 0, w_kr1 >= pr.w_kr), _EXCESS_CHAINS
    )


def excess_of_c2_check(m: int, *, squares: bool) -> Check:
    """Return the check of what (3.1) leaves of C2 in a figure."""
    printed = (pr.COND_3_1, pr.COND_3_1_SQUARES)[squares]
    row = at_figure(printed, m, parametric=True).relation.rhs
    second, base, values = _seconds(row, "start", m, "any", True)

    def difference(formula: Formula) -> Any:
        left, right = (interpret(x, Meaning(values | {pr.P_uu: second, pr.R_ww: base})) for x in formula.relation.args)
        return right - left

    def cases(formula: Formula | None) -> Iterator[Case]:
        residual = difference(given(formula))
        yield Case("any rows and knots", residual == 0, residual=residual.as_expr() if residual else sp.Integer(0))

    method = "P_uu by the printed row less R_ww, both by end derivatives, any rows and knots"
    return Check(cases, Strength.GENERAL, method, proof=True, probe=difference)


_STEP = "the control points of each base step as R_2 - R_1 = s (R_1 - R_0) all along the contact, at S alike, s = "
_SPEED = (
    ": the base is straight across there and its speed changes by just that much, upwards if s > 0; if s < 0 its "
    "control points turn back"
)
# Under which condition a printed row 2 is right in a figure, m = 6 for C2; H_1, H_2 are the distances of the first two
# inner knots of the base from the contact.
STEPS = {
    False: _STEP + "H_2 / (2 H_1 (1/2 - H_2)), H_2 other than u_2 = 1/2" + _SPEED,
    True: _STEP + "4 H_2 (1/4 + H_1) / (2 H_1 - H_2), H_2 other than 2 H_1" + _SPEED,
}
SPANS = {
    False: "the first two spans of the base across the contact are together as long as those of the blend, or the base "
    "is straight across",
    True: "the first two spans of the base across the contact have one length, or the base is straight across",
}


# As printed, and with the squares that the scan may have lost.
_SECOND_ROWS = {"start": (pr.COND_3_1, pr.COND_3_1_SQUARES), "end": (pr.COND_3_2, pr.COND_3_2_SQUARES)}


def _printed_derivatives(
    rows: tuple[sp.Matrix, ...],
    m: int,
    spans: tuple[Any, Any],
    alpha: Any = 1,
    side: Side = "start",
    squares: bool = False,
) -> Any:
    """Return P_u and P_uu at the contact when rows 1 and 2 are set as printed, k = k_r = 4, uniform u_i.

    `rows` are R_0, R_1, R_2 (or S_0, S_1, S_2) as vectors, `spans` the distances of the first two inner knots of the
    base from the contact; with `squares` both distances of row 2 are squared.
    """
    h = _uniform(m)
    knots = (pr.w_s, pr.w_kr) if side == "start" else (pr.t_s, pr.t_ks)
    values = {knots[0]: 0, knots[1]: spans[0], _SHAPE[side]: alpha}
    own, next_row, _ = _BLEND[side]
    first_row, second_row = (
        at_figure(formula, m, parametric=False).relation.rhs
        for formula in (_FIRST_ROW[side], _SECOND_ROWS[side][squares])
    )
    coordinates = []
    for c in range(3):
        at = values | {symbol: row[c] for symbol, row in zip(_BASE[side], rows, strict=True)} | {own: rows[0][c]}
        first = first_row.subs(at)
        second = second_row.subs(at | {next_row: first})
        coordinates.append(end_derivatives(2, CUBIC - 1, h) * sp.Matrix([rows[0][c], first, second]))
    return tuple(sp.Matrix([column[d] for column in coordinates]) for d in (1, 2))


def _rows_across(kind: str) -> tuple[tuple[sp.Matrix, ...], sp.Matrix]:
    """Return R_0, R_1, R_2 at a point of the contact curve, symbolic, and the direction of the contact curve."""
    x = sp.symbols("x1 x2 y0 y1 y2 z2", real=True)
    along = sp.Matrix([0, 1, 0])
    if kind == "straight":  # planes, cylinders and cones along their rulings: all three on one line
        direction = sp.Matrix(sp.symbols("d_x d_y d_z", real=True))
        return (sp.zeros(3, 1), x[0] * direction, x[1] * direction), along
    if kind == "plane":
        return (sp.zeros(3, 1), sp.Matrix([x[0], x[3], 0]), sp.Matrix([x[1], x[4], 0])), along
    return (sp.zeros(3, 1), sp.Matrix([x[0], 0, 0]), sp.Matrix([x[1], 0, x[5]])), along


def _base_derivatives(rows: tuple[sp.Matrix, ...], spans: Any) -> tuple[sp.Matrix, sp.Matrix]:
    matrix = end_derivatives(2, CUBIC - 1, spans)
    return tuple(sum((matrix[d, i] * rows[i] for i in range(3)), sp.zeros(3, 1)) for d in (1, 2))


def row_counterexample(side: Side, kind: str, m: int) -> Any:
    """Return a search for the smallest rows at which P_uu misses along the normal, as printed and with squares.

    The base has five rows over [0, 1], its one inner knot at 1/3: with squares, 1/2 gives the right value.
    """

    def search() -> Counterexample | None:
        rows, along = _rows_across(kind)
        spans = (sp.Rational(1, 3), sp.Integer(1))
        seconds = [_printed_derivatives(rows, m, spans, side=side, squares=squares)[1] for squares in (False, True)]
        r_first, r_second = _base_derivatives(rows, spans)
        misses_by = [second - r_second for second in seconds]
        symbols = sorted(set().union(*(row.free_symbols for row in rows)), key=str)

        def misses(at: dict[Any, Any]) -> bool:
            normal = r_first.subs(at).cross(along)
            return not normal.is_zero_matrix and all(miss.subs(at).dot(normal) != 0 for miss in misses_by)

        found = smallest_assignment(symbols, misses)
        if found is None:
            return None
        base, parameter, start, shape = ("R", "w", "w_s", "alpha") if side == "start" else ("S", "t", "t_s", "beta")
        spell = ", ".join(f"{base}_{i} = {tuple(row.subs(found))}" for i, row in enumerate(rows))
        wrong, squared, true = (tuple(x.subs(found)) for x in (*seconds, r_second))
        values = (("rows", spell), ("contact curve along", str(tuple(along))),
                  (f"knots of {base} after {start}", f"{start} + 1/3, {start} + 1"), (shape, "1"),
                  ("m", str(m)))  # fmt: skip
        return Counterexample(
            values, f"P_uu = {wrong}, with squares {squared}", f"{base}_{parameter}{parameter} = {true}"
        )

    return search


def straight_counterexample(m: int) -> Any:
    """Return the search for rows on a straight line at which the printed C2 conditions miss, natural ones first.

    Rows at the Greville abscissae run along the line at constant speed; evenly spaced rows are what a user draws. The
    base has six rows over [0, 1] and uniform knots, for which squares would give G2: C2 they do not give.
    """

    def search() -> Counterexample | None:
        missed = []
        for name, places in (("at the Greville abscissae, constant speed", (0, sp.Rational(1, 9), sp.Rational(1, 3))),
                             ("evenly spaced", (0, 1, 2))):  # fmt: skip
            rows = tuple(sp.Matrix([place, 0, 0]) for place in places)
            spans = (sp.Rational(1, 3), sp.Rational(2, 3))
            printed, squared = (_printed_derivatives(rows, m, spans, squares=s)[1][0] for s in (False, True))
            true = _base_derivatives(rows, spans)[1][0]
            if true not in (printed, squared):
                wrong = f"{printed}, with squares {squared}"
                missed.append((f"R_0, R_1, R_2 = {', '.join(map(str, places))} ({name})", wrong, true))
        if not missed:
            return None
        (label, printed, true), *others = missed
        also = "; ".join(f"with {name} printed {wrong}, true {right}" for name, wrong, right in others)
        first = str(sp.Rational(1, m - 2))
        spans_of_r = ("knots of R after w_s", "w_s + 1/3, w_s + 2/3")
        values = (("rows on a line", label), spans_of_r, ("u_1", first), ("alpha", "1"))
        return Counterexample(values, f"P_uu = {printed}", f"R_ww = {true}", also=also)

    return search
