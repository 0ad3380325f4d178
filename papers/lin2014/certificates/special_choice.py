"""(17) and (18): what p_1 = alpha^2 and p_1 = -alpha^2 make of (15) and (16)."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import sympy as sp

from semispline.derivations.contact import A, special_conditions
from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.general_contact import (
    _V,
    _W,
    FORMS,
    PLANES,
    dot,
    first_order,
    instances,
    joined,
    named_vector,
    second_order,
    vector,
)
from semispline.papers.recheck import Draft, Statement, Text, as_text, different, identity, text


def special(formula: Formula, order: int, *, equal: bool = True) -> list[Statement]:
    """Return (17) or (18) against the chain rule, and against R(w_s - a u) itself."""
    letter = pr.R_w if order == 1 else pr.R_ww
    derived = special_conditions(order)[order].subs(sp.Symbol(letter.name), letter)
    where = ((text(A), text(pr.alpha**2)),)
    right = formula.relation.rhs
    return [
        identity(f"every alpha and {letter}: the derived condition", right, derived, equal=equal, where=where),
        identity(
            f"every alpha and {letter}: derivative {order} of R(w_s - a u)",
            right,
            Text(f"(-a)^{order}") * as_text(letter),
            equal=equal,
            where=where,
        ),
    ]


def special_contact(order: int) -> Iterator[Statement]:
    """Yield that P_u = -alpha^2 R_w, and P_uu = alpha^4 R_ww, are contact of an order, any regular R."""
    chosen = ((text(pr.p_1), text(-(pr.alpha**2))), (text(pr.q_1), "0"), (text(pr.p_2), "0"), (text(pr.q_2), "0"))
    for n in range(1, order + 1):
        letter = pr.R_w if n == 1 else pr.R_ww
        printed = (pr.EQ_15, pr.EQ_16)[n - 1].relation.rhs
        right = Text(f"(-alpha^2)^{n}") * as_text(letter)
        yield identity(f"the condition of order {n} with p_1 = -alpha^2", printed, right, where=chosen, own=False)
    yield from first_order(pr.EQ_15.relation.rhs, own=False)
    if order == 2:
        yield from second_order(pr.EQ_16.relation.rhs, own=False)


def shape_parameters(sign: int = -1) -> Iterator[Statement]:
    """Yield values of alpha: the patch by p_1 = -alpha^2 touches the base, and is regular unless alpha is 0.

    With `sign` 1 the one by p_1 = alpha^2, as (17) has it.
    """
    if sign < 0:
        yield from special_contact(1)
    else:
        yield from first_order(pr.EQ_15.relation.rhs, own=False)
    third, half = sp.Rational(1, 3), sp.Rational(1, 2)
    x, y = _W + third * _W**2 + half * _W * _V, _V + _W**2 / 5 + third * _V**2
    base = [x, y, x**2 - x * y / 2 + y**3 / 3 + y / 7]
    for alpha in (sp.Integer(1), half, sp.Integer(-2), sp.Integer(0)):
        functions = (sign * alpha**2, 0, 0, 0)
        yield from joined(f"alpha = {alpha}", 1, base, functions, pr.EQ_15.relation.rhs, meets=alpha != 0)
    flat = [_W**2, _V, sp.Integer(0)]
    yield from joined("alpha = 1, a base with R_w = 0", 1, flat, (sign, 0, 0, 0), pr.EQ_15.relation.rhs, meets=False)


def sides() -> Iterator[Statement]:
    """Yield on which side of the contact P_u points: P_u . n = p_1 n . n, n = R_w less its part along the contact."""
    across, along = vector(pr.R_w), vector(pr.R_v)
    share = dot(across, along) / dot(along, along)
    inwards: list[tuple[str, str]] = []
    n = named_vector(inwards, "n", [a - share * b for a, b in zip(across, along, strict=True)])
    slope = [Text("p_1") * a + Text("q_1") * b for a, b in zip(across, along, strict=True)]
    yield identity("P_u . n = p_1 n . n, any R", dot(slope, n), Text("p_1") * dot(n, n), where=inwards, own=False)


def equation_17(claim: Claim) -> Draft:
    """Return (17) as tangent planes see it, and as a blend that goes on from R."""
    first, second = (given(reading.parts[0].formula) for reading in claim.readings)
    chosen = ((text(pr.p_1), text(pr.alpha**2)), (text(pr.q_1), "0"))
    planes: list[Statement] = [
        identity("(15) with p_1 = alpha^2", first.relation.rhs, pr.EQ_15.relation.rhs, where=chosen, own=False),
        *shape_parameters(1),
    ]
    join = [*sides(), *special(second, 1, equal=False)]
    return Draft([planes, join], [*sides(), *special(claim.corrected_formulas[0], 1)], (PLANES,))


def special_choice(_: Claim) -> Draft:
    """Return that the special choice suffices, and blends with contact of order 2 that it does not have."""
    others = [*instances(2, pr.EQ_16.relation.rhs, admitted=True)]
    for letter, value in (("p_2", "1"), ("q_2", "-1/3"), ("q_1", "1/2")):
        others.append(different(f"one of them has {letter} = {value}", Text(value, 2), 0))
    return Draft([special_contact(2), others], believed=(PLANES, FORMS))


def substitution(claim: Claim) -> Draft:
    """Return that p_1 = alpha^2, the rest zero, turns (15), (16) into (17), (18)."""
    chosen = ((text(pr.p_1), text(pr.alpha**2)), (text(pr.q_1), "0"), (text(pr.p_2), "0"), (text(pr.q_2), "0"))
    general_ = (pr.EQ_15, pr.EQ_16)
    return Draft(
        [
            [
                identity(f"({17 + n}), all alpha", formula.relation.rhs, general_[n].relation.rhs, where=chosen)
                for n, formula in enumerate(claim.formulas)
            ]
        ]
    )


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-17": equation_17,
    "eq-18": lambda claim: Draft([special(claim.formulas[0], 2)]),
    "sec-A.substitution": substitution,
    "sec-A.special-choice": special_choice,
}
