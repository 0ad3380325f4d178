"""The integrand of (11), and of the strain energy that it stands for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.derivations.energy import gram_matrix, thin_plate_density
from semispline.papers.ledger import Claim, Formula, as_fraction, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.minima import NO_ENERGY, line
from semispline.papers.lin2014.certificates.spline_steps import INDUCTION as RECURRENCE
from semispline.papers.lin2014.certificates.spline_steps import sharp_continuity
from semispline.papers.lin2014.checks import energy
from semispline.papers.recheck import Draft, Statement, Text, as_text, different, identity, integral_text, rank, text

CURVATURES = "principal curvatures are the eigenvalues of [P_uu, P_uv; P_uv, P_vv] where lengths and angles are kept"


def density(claim: Claim) -> Draft:
    """Return the integrand of (11), and where zero energy means no bend."""
    printed = claim.formulas[0].relation.rhs
    turned = (
        ("c", "(1 - t^2)/(1 + t^2)"),
        ("s", "2*t/(1 + t^2)"),
        ("A_uu", "c^2*P_uu - 2*c*s*P_uv + s^2*P_vv"),
        ("A_uv", "c*s*P_uu + (c^2 - s^2)*P_uv - c*s*P_vv"),
        ("A_vv", "s^2*P_uu + 2*c*s*P_uv + c^2*P_vv"),
    )
    there = printed.subs({s: sp.Symbol(f"A_{s.name[2:]}") for s in (pr.P_uu, pr.P_uv, pr.P_vv)}, simultaneous=True)
    cases: list[Statement] = [
        identity("the derived density", printed, thin_plate_density()),
        *curvatures(Text("kappa_1^2 + kappa_2^2", 1), printed),
        identity("rotation by every angle, t the tangent of its half", there, printed, where=turned),
        *sharp_continuity(own=False),
        line(),
    ]
    half = Fraction(1, 2)
    for label, space, meets in (
        ("cubic, single knot 1/2", energy.basis(4, half), True),
        ("cubic, double knot 1/2", energy.basis(4, half, half), True),
        ("cubic, triple knot 1/2 (a crease is possible)", energy.basis(4, half, half, half), False),
        ("linear, knot 1/2 (a roof)", energy.basis(2, half), False),
    ):
        gram = gram_matrix(2, space, space)
        own: dict[str, Any] = {"own": meets, "meets": meets}
        cases += gram_entries(label, 2, space, own=False) if meets else ()
        cases.append(
            rank(f"{label}: what costs nothing has dimension {2 if meets else 3}", gram, affirmed=meets, **own)
        )
    return Draft([cases], believed=(RECURRENCE, NO_ENERGY, CURVATURES))


def gram_entries(label: str, d: int, space: Any, **flags: Any) -> Iterator[Statement]:
    """Yield entries of a derived Gram matrix against integrals of the recursion's polynomials."""
    gram = gram_matrix(d, space, space)
    knots = [as_fraction(knot) for knot in space.knots]
    order = len(knots) - space.size
    for i in range(space.size):
        for j in range(i, space.size):
            true = integral_text(order, (knots, i, d), (knots, j, d))
            yield identity(f"{label}: entry {i}, {j} by the recursion", gram[i, j], true, **flags)


def strain(claim: Claim) -> Draft:
    """Return the integrand of the strain energy, without and with the area element."""

    def cases(formula: Formula, *, equal: bool) -> list[Statement]:
        printed = formula.relation.rhs
        scaled = as_text(printed.subs(pr.area, sp.Symbol("c") * pr.area))
        return [
            identity("u replaced by u / c", scaled / Text("c"), printed, equal=equal),
            identity("unit area element", printed, Text("kappa_1^2 + kappa_2^2", 1), where=((text(pr.area), "1"),)),
        ]

    first, second = (given(reading.parts[0].formula) for reading in claim.readings)
    return Draft([cases(first, equal=False), cases(second, equal=True)], cases(claim.corrected_formulas[0], equal=True))


def curvatures(squares: Any, plate: Any, **flags: Any) -> list[Statement]:
    """Return the sum of squared curvatures by their sum and product, which are trace and determinant."""
    where = (("S", "P_uu + P_vv"), ("Q", "P_uu*P_vv - P_uv^2"))
    both = Text("(kappa_1 + kappa_2)^2 - 2*(kappa_1*kappa_2)", 1)
    return [
        identity("by sum and product of the curvatures", squares, both, **flags),
        identity("which are trace and determinant", Text("S^2 - 2*Q", 1), plate, where=where, **flags),
    ]


def thin_plate(claim: Claim) -> Draft:
    """Return (11) as the strain energy where lengths and angles are kept, and plane pieces where they are not."""
    relation = given(claim.readings[0].parts[0].formula).relation
    kept = curvatures(relation.lhs, relation.rhs)
    flat: list[Statement] = [
        different(
            "the square as (u + c u^2, v, 0): P_uu = 2 c",
            relation.rhs,
            0,
            where=(("P_uu", "2*c"), ("P_uv", "0"), ("P_vv", "0")),
        ),
        different(
            "the square as (u, v + c u v, 0): P_uv = c",
            relation.rhs,
            0,
            where=(("P_uu", "0"), ("P_uv", "c"), ("P_vv", "0")),
        ),
    ]
    return Draft([kept, flat], believed=(CURVATURES,))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-11": density,
    "sec-3.strain-energy": strain,
    "sec-3.thin-plate": thin_plate,
}
