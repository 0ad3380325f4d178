"""(15) and (16): the chain rule, and vectors coordinate by coordinate, for any surfaces with a common curve."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.contact import contact_conditions
from semispline.papers.ledger import Claim
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import Pairs
from semispline.papers.recheck import Draft, Statement, Text, as_text, contained, identity, not_zero, text, total

Vector = list[Text]
_AXES = ("x", "y", "z")
PLANES = (
    "at a point where R_w and R_v are independent the tangent planes are one exactly if P_u x P_v is a multiple of "
    "R_w x R_v"
)
FORMS = "curvatures agree exactly if the second fundamental forms do, with one normal, in all directions du, dv"


def vector(letter: Any) -> Vector:
    """Return the coordinates of a letter."""
    return [Text(f"{text(letter)}_{axis}") for axis in _AXES]


def dot(a: Vector, b: Vector) -> Text:
    """Return the product of two vectors."""
    return total(x * y for x, y in zip(a, b, strict=True))


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product."""
    return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]


def named_vector(pairs: list[tuple[str, str]], name: str, values: Vector) -> Vector:
    """Return letters for the coordinates of a vector; `pairs` gets what they stand for."""
    named = [Text(f"{name}_{axis}") for axis in _AXES]
    pairs += [(str(n), str(v)) for n, v in zip(named, values, strict=True)]
    return named


_BASE = (pr.R_w, pr.R_v, pr.R_ww, pr.R_wv, pr.R_vv)


def _at_coordinate(expression: Any, c: int) -> Text:
    """Return a combination of derivatives of R with vectors' letters for one coordinate."""
    return as_text(expression.xreplace({s: sp.Symbol(f"{s.name}_{_AXES[c]}") for s in _BASE}))


@cache
def _frame() -> tuple[Pairs, Vector, Vector, Vector, Text]:
    pairs: list[tuple[str, str]] = []
    across, along = vector(pr.R_w), vector(pr.R_v)
    normal = named_vector(pairs, "N", cross(across, along))
    pairs.append(("NN", str(dot(normal, normal))))
    return tuple(pairs), across, along, normal, Text("NN")


def _solved(free: Vector, names: tuple[Any, Any]) -> Pairs:
    """Return the coordinates of a vector's part within the tangent plane, as lets."""
    _, across, along, normal, square = _frame()
    values = dot(cross(free, along), normal) / square, dot(cross(across, free), normal) / square
    return tuple((text(name), str(value)) for name, value in zip(names, values, strict=True))


def first_order(right: Any, **flags: Any) -> Iterator[Statement]:
    """Yield that P_u = `right` for some p_1, q_1 exactly if the tangent planes are one, for any R and P."""
    pairs, _, along, normal, square = _frame()
    slope = [_at_coordinate(right, c) for c in range(3)]
    free = vector("P_u")
    product = cross(slope, along)
    for c, axis in enumerate(_AXES):
        yield identity(
            f"sufficiency, any R and P: P_u x P_v, {axis}", product[c], Text("p_1") * normal[c], where=pairs, **flags
        )
        yield identity(
            f"necessity, any R and P: {axis}",
            free[c] - slope[c].at(2),
            dot(free, normal) / square * normal[c],
            where=(*pairs, *_solved(free, (pr.p_1, pr.q_1))),
            **flags,
        )


def second_order(right: Any, **flags: Any) -> Iterator[Statement]:
    """Yield that P_uu = `right` for some p_2, q_2 exactly if curvatures agree, for any R and P that satisfy (15)."""
    pairs, across, along, normal, square = _frame()
    steps = Text("p_1") * Text("du"), Text("q_1") * Text("du") + Text("dv")
    slope = [_at_coordinate(pr.EQ_15.relation.rhs, c) for c in range(3)]
    second, bends = vector("P_uu"), [vector(s) for s in _BASE[2:]]
    # P_uv is the derivative of (15) along the contact.
    mixed = [
        Text("p_1_prime") * across[c]
        + Text("p_1") * bends[1][c]
        + Text("q_1_prime") * along[c]
        + Text("q_1") * bends[2][c]
        for c in range(3)
    ]
    for c, axis in enumerate(_AXES):
        left = slope[c] * Text("du") + along[c] * Text("dv")
        yield identity(
            f"one direction in both parametrisations, {axis}", left, steps[0] * across[c] + steps[1] * along[c], **flags
        )
    forms = [
        second[c] * Text("du^2", 3)
        + 2 * mixed[c] * Text("du", 4) * Text("dv")
        + bends[2][c] * Text("dv^2", 3)
        - (bends[0][c] * steps[0] ** 2 + 2 * bends[1][c] * steps[0] * steps[1] + bends[2][c] * steps[1] ** 2)
        for c in range(3)
    ]
    seconds = [_at_coordinate(_chain_rule(2).subs({pr.p_2: 0, pr.q_2: 0}), c) for c in range(3)]
    excess = [second[c] - seconds[c] for c in range(3)]
    yield identity(
        "the second fundamental forms differ by the normal part of P_uu",
        dot(forms, normal),
        dot(excess, normal) * Text("du^2", 3),
        where=pairs,
        **flags,
    )
    printed = tuple((f"P_uu_{axis}", str(_at_coordinate(right, c))) for c, axis in enumerate(_AXES))
    yield identity("sufficiency: the forms agree", dot(forms, normal), 0, where=(*pairs, *printed), **flags)
    free = vector("X")
    where = (*pairs, *_solved(free, (pr.p_2, pr.q_2)))
    for c, axis in enumerate(_AXES):
        yield identity(
            f"necessity: {axis}",
            seconds[c] + free[c] - _at_coordinate(right, c),
            dot(free, normal) / square * normal[c],
            where=where,
            **flags,
        )


def _chain_rule(order: int) -> Any:
    """Return the derived condition in the paper's letters."""
    names = {sp.Symbol(str(s)): s for s in _BASE}
    names |= {sp.Symbol(str(s).replace("_", "")): s for s in (pr.p_1, pr.q_1, pr.p_2, pr.q_2)}
    return contact_conditions(order)[order].xreplace(names)


def _composed(order: int) -> Text:
    """Return the derivative of R(w_s + p_1 u + p_2 u^2/2, v + q_1 u + q_2 u^2/2), from the Taylor polynomial of R."""
    if order == 1:
        return Text("R_w") * Text("p_1") + Text("R_v") * Text("q_1")
    # Twice the coefficient of u^2, term by term.
    w, v = (Text(p) / 2 for p in ("p_2", "q_2"))
    products = (
        Text("R_ww") / 2 * (Text("p_1") * Text("p_1")),
        Text("R_wv") * (Text("p_1") * Text("q_1")),
        Text("R_vv") / 2 * (Text("q_1") * Text("q_1")),
    )
    return 2 * total((Text("R_w") * w, Text("R_v") * v, *products))


_W, _V, _U = sp.symbols("w v u")


def instances(order: int, condition: Any, *, admitted: bool = False) -> Iterator[Statement]:
    """Yield blends off the graph z = x^2 - x y/2 + y^3/3 + y/7, and off a plane with R_w = 0, judged by F = 0.

    With `admitted` those alone whose functions satisfy the condition of (15) and (16).
    """
    third, half = sp.Rational(1, 3), sp.Rational(1, 2)
    x, y = _W + third * _W**2 + half * _W * _V, _V + _W**2 / 5 + third * _V**2
    curved = [x, y, x**2 - x * y / 2 + y**3 / 3 + y / 7]
    flat = [_W**2, _V, sp.Integer(0)]
    for label, base, functions, meets in (
        ("p_1 = -1", curved, (-1, 0, 0, 0), True),
        ("p_1 = -2/3, q_1 = 1/2, p_2 = 1, q_2 = -1/3", curved, (-2 * third, half, 1, -third), True),
        ("p_1 = 1: a fold, but of one tangent plane", curved, (1, 0, 0, 0), True),
        ("p_1 = -1-v, q_1 = v, p_2 = v^2, q_2 = 1-v", curved, (-1 - _V, _V, _V**2, 1 - _V), True),
        ("p_1 = 0, the rest zero", curved, (0, 0, 0, 0), False),
        ("p_1 = 0, q_1 = 1", curved, (0, 1, 0, 0), False),
        ("p_1 = v - 1/2, zero at one point", curved, (_V - half, 0, 0, 0), False),
        ("R_w = 0 on the contact", flat, (-1, 0, 0, 0), False),
    ):
        if meets or not admitted:
            yield from joined(f"order {order}, {label}", order, base, functions, condition, meets=meets)


def joined(
    label: str, order: int, base: Sequence[Any], functions: Sequence[Any], condition: Any, *, meets: bool, **flags: Any
) -> Iterator[Statement]:
    """Yield whether a patch by the condition is regular, and that it touches the base to the order."""
    values = dict(zip((pr.p_1, pr.q_1, pr.p_2, pr.q_2), map(sp.sympify, functions), strict=True))
    parts = dict(zip(_BASE, ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)), strict=True))
    at = [{s: sp.diff(part, _W, i, _V, j).subs(_W, 0) for s, (i, j) in parts.items()} for part in base]
    patch, slopes, along = [], [], []
    for c, part in enumerate(base):
        start = part.subs(_W, 0)
        derivatives = [pr.EQ_15.relation.rhs, condition][:: 1 if order == 2 else -1][:order]
        polynomial: Any = as_text(start)
        for d, right in enumerate(derivatives, start=1):
            coefficient = right.subs(values).subs(at[c])
            polynomial = polynomial + Text(f"u^{d}", 3) / d * as_text(coefficient)
            if d == 1:
                slopes.append(as_text(coefficient))
        patch.append(polynomial)
        along.append(as_text(sp.diff(start, _V)))
    names = [(axis, str(value)) for axis, value in zip(_AXES, patch, strict=True)]
    graph = "z - (x^2 - x*y/2 + y^3/3 + y/7)" if base[2] != 0 else "z"
    in_uv = sp.expand(
        sp.sympify(graph.replace("^", "**")).subs({axis: sp.sympify(value.replace("^", "**")) for axis, value in names})
    )
    rest = sp.cancel(in_uv / _U ** (order + 1))
    yield identity(
        f"{label}: F has no power of u up to {order}",
        Text(graph, 1),
        Text(f"u^{order + 1}", 3) * as_text(rest),
        where=names,
        own=False,
    )
    normal = cross(slopes, along)
    if meets:
        for i in range(11):
            where = {_V: sp.Rational(i, 10)}
            square = dot(normal, normal)
            yield not_zero(f"{label}: P is regular at v = {i}/10", square, where=where, meets=True, **flags)
    else:
        singular = {_V: sp.Rational(1, 2)}
        for c, axis in enumerate(_AXES):
            yield identity(
                f"{label}: P is singular at v = 1/2, {axis}",
                normal[c],
                0,
                where=singular,
                own=False,
                meets=False,
                wanted=False,
            )


def general(order: int) -> Any:
    """Return the draft of (15) or (16)."""

    def draft(claim: Claim) -> Draft:
        right = claim.formulas[0].relation.rhs
        cases: list[Statement] = [
            identity("the derived chain rule, all p_i, q_i", right, _chain_rule(order)),
            identity("the chain rule from a Taylor polynomial", right, _composed(order)),
        ]
        if order == 2:
            cases += first_order(pr.EQ_15.relation.rhs)
        cases += (first_order if order == 1 else second_order)(right)
        cases += instances(order, right)
        if order == 1:
            cases.append(
                contained(
                    "necessity, the plane as (w^2, v, 0), continued by (-u, v, 0)",
                    [[0, 0], [0, 1], [0, 0]],
                    [[-1], [0], [0]],
                    own=False,
                    meets=False,
                )
            )
        return Draft([cases], believed=(PLANES, *((FORMS,) if order == 2 else ())))

    return draft


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-15": general(1),
    "eq-16": general(2),
}
