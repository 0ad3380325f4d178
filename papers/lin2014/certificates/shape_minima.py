"""Where (11) is least over alpha and beta."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import Claim
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION
from semispline.papers.lin2014.certificates.degrees import top_terms
from semispline.papers.lin2014.certificates.general_contact import FORMS, PLANES
from semispline.papers.lin2014.certificates.least_energies import QUADRATIC, least_strip
from semispline.papers.lin2014.certificates.minima import NO_ENERGY, line, one_minimum, squares
from semispline.papers.lin2014.certificates.special_choice import special_contact
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.checks import facing_bases as facing
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import Draft, Statement, Text, as_text, identity, minimum, positive, text

LEAST_VALUE = "a polynomial that grows beyond every bound in every direction has a least value on a closed set"


def plates() -> Iterator[Statement]:
    """Yield the energy of strips between plates as a quadratic in a, b around its least point, and where that lies."""
    a, b = sp.symbols("a b", real=True)
    gap = sp.Symbol("d", positive=True)
    for label, distance, into, meets in (
        ("plates that face each other, over every gap", gap, 1, True),
        ("parallel plates, the blend turns round by 180 degrees", sp.Integer(0), -1, False),
    ):
        data = (0, a, 0, distance, into * b, 0)
        found = energy.end_energy(CUBIC, 6, data)
        yield from least_strip(label, 6, data, found)
        form = sp.hessian(found, (a, b)) / 2
        slopes = [-sp.diff(found, letter).subs({a: 0, b: 0}) / 2 for letter in (a, b)]
        where = _least_point(form, slopes)
        yield from _around(label, found, (a, b), form, where)
        yield minimum(f"{label}: which is one", form, own=False)
        for letter in ("a_least", "b_least"):
            if meets:
                yield positive(f"{label}: {letter} is positive", letter, where=where, positive=("d",))
            else:
                zero = f"{label}: {letter} is 0"
                yield identity(zero, letter, 0, where=where, wanted=False, own=False, meets=False)


def _least_point(form: Any, slopes: Any) -> tuple[tuple[str, str], ...]:
    """Return where a quadratic in two letters is least, by Cramer's rule."""
    (p, q, r), (f, g) = (as_text(form[n]) for n in (0, 1, 3)), map(as_text, slopes)
    determinant = p * r - q * q
    return (("a_least", str((f * r - g * q) / determinant)), ("b_least", str((g * p - f * q) / determinant)))


def _around(label: str, found: Any, letters: Any, form: Any, where: Any) -> Iterator[Statement]:
    """Yield a quadratic around its least point."""
    least = [sp.Symbol("a_least"), sp.Symbol("b_least")]
    steps = [point + sp.Symbol(name) for point, name in zip(least, "xy", strict=True)]
    moved, there = (found.subs(dict(zip(letters, at, strict=True)), simultaneous=True) for at in (steps, least))
    square = Text(f"({text(form[0, 0])})*x^2 + 2*({text(form[0, 1])})*x*y + ({text(form[1, 1])})*y^2", 1)
    yield identity(
        f"{label}: the energy around its least point", as_text(moved) - as_text(there), square, where=where, own=False
    )


def some_minimum() -> Iterator[Statement]:
    """Yield why (11) has a least value over alpha and beta, for any regular bases, every order and knots."""
    yield squares()
    yield line()
    values = end_derivatives(1, pr.k - 1, span_symbols(1))
    yield identity("row 0 alone enters the value at u = 0: its factor", values[0, 0], 1, own=False)
    yield identity("and that of row 1", values[0, 1], 0, own=False)
    ends = (("a", "0"), ("b", "0 - a"))
    yield identity("a line that is 0 at u = 0 and u = 1 is zero", Text("a + b*u", 1), 0, where=ends, own=False)
    yield from top_terms(1)
    yield positive(
        "the factor of -alpha^2 R_w in row 1",
        Text("h1/(k - 1)", 2),
        where=(("k", "2 + r"),),
        positive=("h1",),
        nonnegative=("r",),
        own=False,
    )


def problem(_: Claim) -> Draft:
    """Return both readings of the minimisation."""
    shape = [*some_minimum(), *special_contact(2), *plates()]
    return Draft([one_minimum(2), shape], believed=(INDUCTION, NO_ENERGY, PLANES, FORMS, LEAST_VALUE, QUADRATIC))


def unconstrained(_: Claim) -> Draft:
    """Return where alpha, beta of the least energy lie."""
    shape = [*some_minimum(), *special_contact(2), *plates()]
    return Draft([shape], believed=(INDUCTION, NO_ENERGY, PLANES, FORMS, LEAST_VALUE, QUADRATIC))


def facing_pairs(claim: Claim) -> Draft:
    """Return where the energy over alpha^2, beta^2 is least between straight plates, every gap and pair of angles."""
    relation = claim.formulas[0].relation
    whole, _, letters = facing.strip_energy()
    exchanged = {facing.COS_THETA: facing.COS_PHI, facing.COS_PHI: facing.COS_THETA}
    where = (
        ("a_least", text(relation.rhs)),
        ("b_least", text(relation.rhs.subs(exchanged, simultaneous=True))),
    )
    form = sp.hessian(whole, letters) / 2
    determinant = Text(f"({text(form[0, 0])})*({text(form[1, 1])}) - ({text(form[0, 1])})^2", 1)
    angle = (("c_between", "(1 - t^2)/(1 + t^2)"),)
    cases: list[Statement] = [
        *_both_coordinates(whole, letters),
        *_around("every gap and pair of angles", whole, letters, form, where),
        positive(
            "which is one, at every angle between the two ways", determinant, where=angle, nonnegative=("t",), own=False
        ),
        positive("along alpha^2 too", form[0, 0], own=False),
    ]
    for label, angles in facing.PLATES.items():
        cases += _plates(label, where, angles)
    return Draft([cases], believed=(QUADRATIC,))


def _both_coordinates(whole: Any, letters: Any) -> Iterator[Statement]:
    """Yield the energy of one coordinate, and that of both: along the chord, and square to it."""
    p, q, r = sp.symbols("p q r")
    one = energy.end_energy(CUBIC, 6, (0, p, 0, q, r, 0))
    yield from least_strip("one coordinate", 6, (0, p, 0, q, r, 0), one)
    a, b = letters
    (c, s), (c_2, s_2) = (sp.symbols(f"C{n} S{n}") for n in (1, 2))
    along = one.subs({p: a * c, q: facing.GAP, r: b * c_2}, simultaneous=True)
    across = one.subs({p: a * s, q: 0, r: b * s_2}, simultaneous=True)
    circle = tuple(
        pair
        for n in (1, 2)
        for pair in ((f"C{n}", f"(1 - t_{n}^2)/(1 + t_{n}^2)"), (f"S{n}", f"2*t_{n}/(1 + t_{n}^2)"))
    )
    names = (facing.COS_THETA, facing.COS_PHI, facing.COS_BETWEEN)
    cosines = tuple(zip(map(text, names), ("C1", "C2", "C1*C2 + S1*S2"), strict=True))
    both = as_text(along) + as_text(across)
    yield identity("both coordinates, any two angles", both, whole, where=(*circle, *cosines), own=False)


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
