"""The degree of the objective after the contact conditions have been put in."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from semispline.derivations.contact import contact_rows
from semispline.derivations.energy import thin_plate_density
from semispline.derivations.splines import span_symbols
from semispline.papers.ledger import Claim
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION, closed_derivative, induction
from semispline.papers.lin2014.certificates.minima import NO_ENERGY
from semispline.papers.recheck import Draft, Statement, Text, as_text, different, identity, total


def top_terms(order: int) -> Iterator[Statement]:
    """Yield rows 1 (and 2) as polynomials in a, their top coefficient a multiple of R_w (of R_ww)."""
    yield from induction()
    h, base = span_symbols(order), span_symbols(2, "H")
    rows = contact_rows(order, pr.k - 1, h, pr.k_r - 1, base[:order])
    where = (("R_w", str(closed_derivative("start", "base", 1))), ("R_ww", str(closed_derivative("start", "base", 2))))
    first = "R_0j - a*h1/(k - 1)*R_w"
    second = "R_0j - a*(h1 + h2)/(k - 1)*R_w + a^2*h1*h2/((k - 1)*(k - 2))*R_ww"
    for row, polynomial in list(enumerate((first, second), start=1))[:order]:
        derived = total(
            as_text(rows[row, j]) * as_text(letter) for j, letter in enumerate((pr.R_0, pr.R_1, pr.R_2)[: order + 1])
        )
        yield identity(
            f"row {row} as a polynomial in a = alpha^2, every order", derived, Text(polynomial, 1), where=where
        )


def degree_draft(order: int, *, geometric: bool) -> Callable[[Claim], Draft]:
    """Return the draft of the degree of the objective."""

    def draft(claim: Claim) -> Draft:
        printed = claim.formulas[0].relation.rhs
        seconds = Text("(z*P_uu)^2 + 2*(z*P_uv)^2 + (z*P_vv)^2", 1)
        cases: list[Statement] = [
            identity("(11) is quadratic", seconds, Text("z^2", 3) * as_text(thin_plate_density()), own=False)
        ]
        if not geometric:
            cases += [
                identity("quadratic in points that enter linearly", f.relation.rhs, Text("2*1", 2))
                for f in claim.formulas
            ]
            return Draft([cases])
        cases += top_terms(order)
        cases.append(identity("twice the power of alpha in the rows", printed, Text(f"2*(2*{order})", 2)))
        if order == 2:
            flat = ("R_2j", "R_1j + (R_1j - R_0j)*H2/H1")
            cases.append(
                identity("a base with R_ww = 0", closed_derivative("start", "base", 2), 0, where=(flat,), own=False)
            )
            cases.append(
                different("then the power in the rows is lower", printed, Text("2*(2*1)", 2), own=False, meets=False)
            )
        return Draft([cases], believed=(INDUCTION, NO_ENERGY))

    return draft


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-4.quadratic": degree_draft(2, geometric=False),
    "sec-4.g1-degree": degree_draft(1, geometric=True),
    "sec-4.g2-degree": degree_draft(2, geometric=True),
}
