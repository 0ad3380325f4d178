"""Rows next to a contact, end derivatives, and what figures and appendix make of them.

Each row is stated three times: by what its derivative has to be, with end derivatives in closed form, for every order;
as the row that `derivations` gives; and by Cox and de Boor's recursion itself for some pairs of orders. There a
contact is that of P(u) and R(w_s - a u), or of P(1 + x) and S(t_s + b x): no sign is chosen anywhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.contact import contact_rows, contact_rows_from_pieces
from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_rows import (
    BASE_H,
    BASE_ROWS,
    BLEND_H,
    ROWS,
    Mode,
    Side,
    base_order,
    t_ks1,
    u_before,
    u_last,
    w_kr1,
)
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_2_2, TRUE_3_1, TRUE_3_2
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Identity,
    Lets,
    Statement,
    Text,
    as_text,
    curve_jet,
    derivative,
    end_jets,
    identity,
    text,
    total,
)

INDUCTION = (
    "the closed form of end derivatives holds for every degree, since it does for degree 0 and passes from one degree "
    "to the next (base and step are stated)"
)
# Orders of blend and base at which the recursion is unrolled.
PAIRS = ((4, 4), (3, 4), (5, 3))
TRUE_ROWS = {"start": (pr.COND_1_1, pr.COND_2_1, TRUE_3_1), "end": (pr.COND_1_2, TRUE_2_2, TRUE_3_2)}
Pairs = tuple[tuple[str, str], ...]

_ASCENDING = {
    "start": ("u_1 > 0", "u_2 >= u_1", "w_k_r > w_s", "w_k_r_plus_1 >= w_k_r"),
    "end": ("u_m_less_k_plus_1 < 1", "u_m_less_k <= u_m_less_k_plus_1", "t_k_s > t_s", "t_k_s_plus_1 >= t_k_s"),
}


@cache
def induction() -> tuple[Statement, ...]:
    """Return base and step of the closed form of end derivatives, and that it is the recursion's for degrees 1 to 4."""
    p = sp.Symbol("p", positive=True)
    h = span_symbols(3)
    known, following = end_derivatives(2, p, h), end_derivatives(2, p + 1, h)
    found = []
    for d in range(3):
        for i in range(3):
            # The d-th derivative at x = 0 of (x / h_i) f_(i-1) + (1 - x / h_(i+1)) f_i.
            step = as_text(known[d, i])
            if d:
                step = step - d * as_text(known[d - 1, i]) / as_text(h[i])
            if d and i:
                step = step + d * as_text(known[d - 1, i - 1]) / as_text(h[i - 1])
            entry = f"derivative {d} of function {i}"
            found.append(identity(f"base, degree 0: {entry}", known[d, i], int(d == i == 0), where={p: 0}, own=False))
            found.append(identity(f"step, from degree p to p + 1: {entry}", following[d, i], step, own=False))
            for degree in range(1, 5):
                unrolled = Lets("c")
                jets = end_jets(unrolled, degree, h, 2)
                true = derivative(jets[i], d) if i < len(jets) and jets[i][d] is not None else 0
                label = f"degree {degree} by the recursion: {entry}"
                where = (("p", str(degree)), *unrolled.pairs)
                found.append(identity(label, known[d, i], true, where=where, own=False))
    return tuple(found)


@cache
def closed_derivative(side: Side, of: str, d: int) -> Text:
    """Return a derivative of the blend or of the base into it, in closed form, by its rows."""
    degree, h, rows = (
        (pr.k - 1, BLEND_H[:2], ROWS[side]) if of == "blend" else (base_order(side) - 1, BASE_H, BASE_ROWS[side])
    )
    ends = end_derivatives(2, degree, h)
    return total(as_text(ends[d, i]) * as_text(row) for i, row in enumerate(rows) if ends[d, i] != 0)


@cache
def derived_rows(side: Side) -> sp.Matrix:
    """Return the rows of `derivations`, for symbolic orders."""
    return contact_rows(2, pr.k - 1, BLEND_H[:2], base_order(side) - 1, BASE_H)


def letters(side: Side, mode: Mode = "all") -> Pairs:
    """Return what stands for what at a contact: knots as distances, and what a mode changes."""
    base = BASE_ROWS[side]
    pairs: list[tuple[Any, Any]] = []
    if mode == "normal":
        pairs.append((base[1], base[0]))
    if mode == "parametric":
        pairs.append((pr.alpha if side == "start" else pr.beta, 1))
    pairs += [("a", (pr.alpha if side == "start" else pr.beta) ** 2)]
    if side == "start":
        pairs += [("h1", pr.u_1), ("h2", pr.u_2), ("H1", pr.w_kr - pr.w_s), ("H2", w_kr1 - pr.w_s)]
    else:
        pairs += [("h1", 1 - u_last), ("h2", 1 - u_before), ("H1", pr.t_ks - pr.t_s), ("H2", t_ks1 - pr.t_s)]
    return tuple((text(name), text(value)) for name, value in pairs)


def rows_before(side: Side, row: int) -> Pairs:
    """Return the right rows up to one, as lets."""
    return tuple((text(f.relation.lhs), text(f.relation.rhs)) for f in TRUE_ROWS[side][:row])


def row_cases(
    formula: Formula | None,
    side: Side,
    row: int,
    mode: Mode = "all",
    *,
    equal: bool = True,
    conditions: Sequence[str] = (),
    **flags: Any,
) -> Iterator[Statement]:
    """Yield what decides a condition for a row of the blend."""
    formula = given(formula)
    relation, counted = formula.relation, formula.relation.has(pr.u_m3)
    if equal:
        yield from induction()
    conditions = (*_ASCENDING[side], *conditions)
    own: dict[str, Any] = {"own": not counted, **flags}
    last: Pairs = ((text(pr.u_m3), text(u_last)),) if counted else ()
    where = (*letters(side, mode), *last, *rows_before(side, row), (text(relation.lhs), text(relation.rhs)))
    label = "every order" + (", as if u_{m-3} were the last inner knot" if counted else "")
    left = closed_derivative(side, "blend", row)
    right = Text("-a").at(2)
    yield identity(
        f"{label}: derivative {row} of the blend",
        left,
        Text(f"({right})^{row}") * closed_derivative(side, "base", row),
        equal=equal,
        where=where,
        conditions=conditions,
        **own,
    )
    derived = derived_rows(side)
    by_rows = total(as_text(derived[row, j]) * as_text(BASE_ROWS[side][j]) for j in range(row + 1))
    yield identity(
        f"{label}: the derived row", relation.rhs, by_rows, equal=equal, where=where, conditions=conditions, **own
    )
    for k, k_b in PAIRS:
        if k > row:
            yield defined_case(formula, side, row, mode, (k, k_b), equal=equal, conditions=conditions, **flags)
    if not counted:
        return
    for k in (3, 5):
        yield defined_case(
            formula,
            side,
            row,
            mode,
            (k, 4),
            equal=False,
            conditions=conditions,
            counted=True,
            **{**flags, "own": False, "meets": False},
        )


def defined_case(
    formula: Formula,
    side: Side,
    row: int,
    mode: Mode,
    orders: tuple[int, int],
    *,
    equal: bool,
    conditions: Sequence[str] = (),
    counted: bool = False,
    **flags: Any,
) -> Identity:
    """Return the derivative of one order of P, at two orders, against that of R(w_s - a u), or of S(t_s + b x).

    With `counted` u_{m-3} is counted from the end of the inner knots; past them there are ones.
    """
    k, k_b = orders
    relation = formula.relation
    unrolled = Lets("c")
    blend_jets = end_jets(unrolled, k - 1, [Text("h1"), Text("h2")], row, side)
    base_lets = Lets("d")
    base_jets = end_jets(base_lets, k_b - 1, [Text("H1"), Text("H2")], row, "start")
    blend = derivative(curve_jet(blend_jets, [as_text(x) for x in ROWS[side]]), row)
    base = derivative(curve_jet(base_jets, [as_text(x) for x in BASE_ROWS[side]]), row)
    index: Pairs = ()
    if relation.has(pr.u_m3):
        place = {3: u_before, 2: sp.Symbol("u_first"), 4: u_last}.get(k, sp.Integer(1)) if counted else u_last
        index = ((text(pr.u_m3), text(place)),)
    where = (
        (text(pr.k), str(k)),
        (text(base_order(side)), str(k_b)),
        *letters(side, mode),
        *index,
        *rows_before(side, row),
        (text(relation.lhs), text(relation.rhs)),
        *unrolled.pairs,
        *base_lets.pairs,
    )
    sign = "(-a)" if side == "start" else "a"
    own = flags.pop("own", k == k_b == CUBIC)
    return identity(
        f"orders {k}, {k_b}, by the recursion: derivative {row}" + (", u_{m-3} counted" if counted else ""),
        blend,
        Text(f"{sign}^{row}") * base,
        equal=equal,
        where=where,
        conditions=conditions,
        own=own,
        **flags,
    )


def excess_cases(formula: Formula | None, side: Side, printed: Formula) -> Iterator[Statement]:
    """Yield what a printed row 2 gives along the normal, less what G2 asks."""
    formula = given(formula)
    shape = letters(side, "normal")
    flat = tuple((text(row), text(BASE_ROWS[side][0])) for row in ROWS[side][:2])
    last: Pairs = ((text(pr.u_m3), text(u_last)),) if printed.relation.has(pr.u_m3) else ()
    second = (text(pr.P_uu), str(closed_derivative(side, "blend", 2)))
    base = (text(pr.R_ww if side == "start" else sp.Symbol("S_tt")), str(closed_derivative(side, "base", 2)))
    row = (text(printed.relation.lhs), text(printed.relation.rhs))
    yield identity(
        "every order, knots and base, along the normal",
        *formula.relation.args,
        where=(*shape, *last, *flat, row, second, base),
    )


def solved_rows(side: Side, row: int) -> Iterator[Identity]:
    """Yield that the rows which the checks solve from the pieces of degree p and q have the derivative that they need.

    The other witness of those rows, in `derivations`, solves them by the same code.
    """
    for k, k_b in PAIRS:
        matrix = contact_rows_from_pieces(row, k - 1, k_b - 1, side)
        rows = (
            (text(letter), str(total(as_text(matrix[i, j]) * as_text(BASE_ROWS[side][j]) for j in range(i + 1))))
            for i, letter in enumerate(ROWS[side][: row + 1])
        )
        blend, base = Lets("c"), Lets("d")
        jets = (
            curve_jet(end_jets(blend, k - 1, [Text("h1"), Text("h2")], row, side), [as_text(x) for x in ROWS[side]]),
            curve_jet(end_jets(base, k_b - 1, [Text("H1"), Text("H2")], row), [as_text(x) for x in BASE_ROWS[side]]),
        )
        found, wanted = (derivative(jet, row) for jet in jets)
        yield identity(
            f"orders {k}, {k_b}: derivative {row} of the rows solved from the pieces",
            found,
            Text(f"{'(-a)' if side == 'start' else 'a'}^{row}") * wanted,
            where=(*rows, *blend.pairs, *base.pairs),
            own=False,
        )


def condition(side: Side, row: int) -> Any:
    """Return the draft of a condition that holds."""

    def draft(claim: Claim) -> Draft:
        cases = [*row_cases(claim.formulas[0], side, row), *solved_rows(side, row)]
        return Draft([cases], believed=(INDUCTION,))

    return draft


def cond_2_2(claim: Claim) -> Draft:
    """Return (2.2), right for k = 4."""
    corrected = [*row_cases(claim.corrected_formulas[0], "end", 1), *solved_rows("end", 1)]
    return Draft([row_cases(claim.formulas[0], "end", 1)], corrected, (INDUCTION,))


def second_row(side: Side) -> Any:
    """Return the draft of (3.1) or (3.2), which fail along the normal in both readings."""

    def draft(claim: Claim) -> Draft:
        printed = [reading.parts[0].formula for reading in claim.readings]
        true, *excesses = claim.corrected_formulas
        correction = [*row_cases(true, side, 2), *solved_rows(side, 2)]
        for excess, formula in zip(excesses, printed, strict=True):
            correction += excess_cases(excess, side, given(formula))
        readings = [row_cases(formula, side, 2, "normal", equal=False) for formula in printed]
        return Draft(readings, correction, (INDUCTION,))

    return draft


DRAFTS = {
    "cond-1.1": condition("start", 0),
    "cond-1.2": condition("end", 0),
    "cond-2.1": condition("start", 1),
    "cond-2.2": cond_2_2,
    "cond-3.1": second_row("start"),
    "cond-3.2": second_row("end"),
}
