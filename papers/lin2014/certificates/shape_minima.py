"""Where (11) is least over alpha and beta."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.papers.ledger import Claim
from semispline.papers.lin2014.certificates.contact import INDUCTION
from semispline.papers.lin2014.certificates.general_contact import PLANES
from semispline.papers.lin2014.certificates.many_rows import LEAST
from semispline.papers.lin2014.certificates.minima import NO_ENERGY, one_minimum
from semispline.papers.lin2014.certificates.special_choice import special_contact
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.checks import facing_bases as facing
from semispline.papers.recheck import Draft, Statement, Text, as_text, identity, minimum, positive, text


def plates() -> Iterator[Statement]:
    """Yield the energy of strips between plates as a quadratic in a, b around its least point, and where that lies."""
    a, b = sp.symbols("a b", real=True)
    gap = sp.Symbol("d", positive=True)
    for label, distance, into, meets in (
        ("plates that face each other, over every gap", gap, 1, True),
        ("plates that face each other over a gap of 2", sp.Integer(2), 1, True),
        ("plates that face each other over a gap of 1", sp.Integer(1), 1, True),
        ("parallel plates, the blend turns round by 180 degrees", sp.Integer(0), -1, False),
    ):
        strip = energy.end_energy(4, 6, (0, a, 0, distance, into * b, 0))
        best = sp.solve([sp.diff(strip, a), sp.diff(strip, b)], [a, b], dict=True)[0]
        form = sp.hessian(strip, (a, b)) / 2
        moved = as_text(strip.subs({a: best[a] + sp.Symbol("x"), b: best[b] + sp.Symbol("y")}, simultaneous=True))
        least = as_text(strip.subs(best, simultaneous=True))
        square = Text(f"({text(form[0, 0])})*x^2 + 2*({text(form[0, 1])})*x*y + ({text(form[1, 1])})*y^2", 1)
        yield identity(f"{label}: the energy around its least point", moved - least, square, own=False)
        yield minimum(f"{label}: which is one", form, own=False)
        for letter in (a, b):
            if meets:
                yield positive(f"{label}: {letter} is positive there", best[letter], positive=("d",))
            else:
                yield identity(
                    f"{label}: {letter} is 0 there",
                    Text(f"{text(best[letter])} + 0", 1),
                    0,
                    wanted=False,
                    own=False,
                    meets=False,
                )


def problem(_: Claim) -> Draft:
    """Return both readings of the minimisation."""
    shape = [*special_contact(1), *plates()]
    return Draft([one_minimum(2), shape], believed=(INDUCTION, NO_ENERGY, PLANES))


def unconstrained(_: Claim) -> Draft:
    """Return where alpha, beta of the least energy lie."""
    return Draft([[*special_contact(1), *plates()]], believed=(PLANES,))


def facing_pairs(claim: Claim) -> Draft:
    """Return where the energy over alpha^2, beta^2 is least between straight plates, every gap and pair of angles."""
    relation = claim.formulas[0].relation
    total_, _, (a, b) = facing.strip_energy()
    exchanged = {facing.COS_THETA: facing.COS_PHI, facing.COS_PHI: facing.COS_THETA}
    where = (
        ("a_least", text(relation.rhs)),
        ("b_least", text(relation.rhs.subs(exchanged, simultaneous=True))),
    )
    least = [sp.Symbol("a_least"), sp.Symbol("b_least")]
    moved = total_.subs({a: least[0] + sp.Symbol("x"), b: least[1] + sp.Symbol("y")}, simultaneous=True)
    there = total_.subs({a: least[0], b: least[1]}, simultaneous=True)
    form = sp.hessian(total_, (a, b)) / 2
    around = Text(f"({text(form[0, 0])})*x^2 + 2*({text(form[0, 1])})*x*y + ({text(form[1, 1])})*y^2", 1)
    determinant = Text(f"({text(form[0, 0])})*({text(form[1, 1])}) - ({text(form[0, 1])})^2", 1)
    angle = (("c_between", "(1 - t^2)/(1 + t^2)"),)
    cases: list[Statement] = [
        identity("the energy around its least point", as_text(moved) - as_text(there), around, where=where, own=False),
        positive(
            "which is one, at every angle between the two ways", determinant, where=angle, nonnegative=("t",), own=False
        ),
        positive("along alpha^2 too", form[0, 0], own=False),
    ]
    for label, angles in facing.PLATES.items():
        cases += _plates(label, where, angles)
    return Draft([cases], believed=(LEAST,))


def _plates(label: str, least: Any, angles: Any) -> Iterator[Statement]:
    """Yield the signs of alpha^2 and beta^2 at one pair of angles, given by cosines and sines, over a gap of 1."""
    (c, s), (c_2, s_2) = angles
    names = (facing.COS_THETA, facing.COS_PHI, facing.COS_BETWEEN, facing.GAP)
    cosines = tuple((text(n), text(x)) for n, x in zip(names, (c, c_2, c * c_2 + s * s_2, 1), strict=True))
    meets = all(39 * one > 25 * other * (c * c_2 + s * s_2) for one, other in ((c, c_2), (c_2, c)))
    flags: dict[str, Any] = {"own": meets, "meets": meets}
    for number in (c, c_2):
        yield positive(f"{label}: an acute angle", number, own=False)
    for name, letter in (("a_least", "alpha^2"), ("b_least", "beta^2")):
        where = (*cosines, *least)
        if meets:
            yield positive(f"{label}: {letter} is positive", name, where=where)
        elif name == "a_least":
            yield positive(f"{label}: {letter} is negative", Text(f"-{name}", 1), where=where, affirmed=False, **flags)


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-12": problem,
    "sec-4.unconstrained": unconstrained,
    "sec-4.facing": facing_pairs,
}
