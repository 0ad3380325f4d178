"""That a blend leaves its bases as they are: its first row is the contact curve, two more are made of the base's."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import sympy as sp

from semispline.derivations.contact import A, contact_rows
from semispline.derivations.splines import span_symbols
from semispline.papers.ledger import Claim
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION, induction
from semispline.papers.lin2014.checks.contact_rows import Side
from semispline.papers.recheck import Draft, Lets, Statement, as_text, end_jets, identity, positive


def undisturbed(claim: Claim) -> Draft:
    """Return that the contact curve is the first row, and that rows of the blend are made of three of the base."""
    return Draft([[*contact_curve(), *three_rows()]], believed=(INDUCTION,))


def contact_curve() -> Iterator[Statement]:
    """Yield that at a clamped end the first function is 1 and the others are 0, at both ends."""
    yield from (case for case in induction() if "derivative 0" in case.label)
    ends: tuple[Side, Side] = ("start", "end")
    for end in ends:
        for degree in range(1, 6):
            unrolled = Lets("c")
            jets = end_jets(unrolled, degree, span_symbols(degree), 0, end)
            for i, jet in enumerate(jets):
                yield identity(
                    f"degree {degree}, by the recursion, at the {end}: function {i}",
                    jet[0] if jet[0] is not None else 0,
                    int(i == 0),
                    where=unrolled.pairs,
                    own=degree == 3,
                )


def three_rows() -> Iterator[Statement]:
    """Yield that R_2 has a factor in row 2, which is a^2 times a positive number, for every order from 3 on."""
    every = contact_rows(2, pr.k - 1, span_symbols(2), pr.k_r - 1, span_symbols(2, "H"))
    over = {pr.k: sp.Symbol("r") + 3, pr.k_r: sp.Symbol("s") + 3}
    yield positive(
        "every order from 3 on: R_2 has a factor in row 2",
        every[2, 2].subs(over),
        positive=(A, *span_symbols(2), *span_symbols(2, "H")),
        nonnegative=("r", "s"),
    )
    for row in range(3):
        for j in range(row + 1, 3):
            yield identity(f"R_{j} has none in row {row}", every[row, j], 0)
    for row in range(3):
        total = as_text(every[row, 0])
        for j in range(1, row + 1):
            total = total + as_text(every[row, j])
        yield identity(f"row {row} is a combination whose factors sum to 1", total, 1)


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-0.undisturbed": undisturbed,
    "sec-3.contact-knots": lambda _: Draft([contact_curve()], believed=(INDUCTION,)),
}
