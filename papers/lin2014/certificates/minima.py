"""The minimum of (11) over the free rows: that there is one, and the linear system that finds it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

from semispline.derivations.energy import ExactSurface, energy_matrix, thin_plate_density
from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import Claim, Meaning, interpret
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION, induction
from semispline.papers.lin2014.checks import energy, objective
from semispline.papers.recheck import Draft, Statement, Term, Text, as_text, identity, minimum, positive

UNROLLED = "the sums are unrolled for three pairs of counts; more terms are alike"
NO_ENERGY = "the integral of a square vanishes only where the function does; basis functions are independent"


def line() -> Statement:
    """Return that lines which meet at a knot with one slope are one."""
    return identity(
        "lines that meet with one slope are one",
        Text("a + b*x", 1),
        Text("c + d*x", 1),
        where=(("b", "d"), ("a", "c + d*h - b*h")),
        own=False,
    )


def squares() -> Statement:
    """Return that (11) is a sum of squares."""
    return positive(
        "(11) is a sum of squares",
        thin_plate_density(),
        strict=False,
        own=False,
        over=[Term(coefficient=c, squares=(s,)) for c, s in (("1", "P_uu"), ("2", "P_uv"), ("1", "P_vv"))],
    )


def one_minimum(order: int) -> Iterator[Statement]:
    """Yield why the free rows have one minimum, and pivots of exact energy matrices."""
    yield squares()
    ends = end_derivatives(1, pr.k - 1, span_symbols(1))
    determinant = as_text(ends[0, 0]) * as_text(ends[1, 1]) - as_text(ends[0, 1]) * as_text(ends[1, 0])
    yield positive(
        "P and P_u at u = 0 determine rows 0 and 1",
        determinant,
        where=(("k", "2 + r"),),
        positive=("h1",),
        nonnegative=("r",),
        own=False,
    )
    yield from induction()
    yield line()
    for m in (6, 7, 8):
        block = _free_block(m, order)
        yield minimum(f"C{order}, {m + 1} rows, {block.rows} unknown control points", block)


@cache
def _free_block(m: int, order: int) -> Any:
    rows = energy.layout().curves
    surface = ExactSurface(energy.u_basis(4, m), (*rows[:3], *[rows[3]] * (m - 5), *rows[-3:]))
    matrix = energy_matrix(surface)
    free = [n for n, (i, _) in enumerate(surface.index) if i in energy.free_rows(m, order)]
    return matrix.extract(free, free)


def normal_equation(order: int) -> Callable[[Claim], Draft]:
    """Return the draft of the linear system: the derivative of the quadratic form, unrolled for some counts."""

    def draft(claim: Claim) -> Draft:
        relation = claim.formulas[0].relation
        cases: list[Statement] = []
        for free, known in ((1, 1), (2, 1), (2, 3)):
            points = [f"x{i}" for i in range(free)] + [f"n{i}" for i in range(known)]

            def entry(i: int, j: int) -> str:
                return f"K_{min(i, j)}_{max(i, j)}"

            for r in range(free):

                def energy_at(shift: str, r: int = r, points: list[str] = points) -> str:
                    values = [f"({p} {shift})" if i == r else p for i, p in enumerate(points)]
                    return " + ".join(
                        f"{entry(i, j)}*{values[i]}*{values[j]}" for i in range(len(values)) for j in range(len(values))
                    )

                slope = Text(f"(({energy_at('+ e')}) - ({energy_at('- e')}))/(4*e)", 2)
                functions = {
                    "A": lambda i, j: Text(entry(int(i), int(j))),
                    "B": lambda i, j, free=free: Text(entry(int(i), free + int(j))),
                    "X": lambda j: Text(f"x{int(j)}"),
                    "N": lambda j: Text(f"n{int(j)}"),
                }
                numbers = {objective.ROW: r, objective.LAST_FREE: free - 1, objective.LAST_KNOWN: known - 1}
                left, right = (interpret(side, Meaning(numbers, functions)) for side in relation.args)
                label = f"{free} free and {known} known control points, row {r}: half the slope of the energy"
                cases.append(identity(label, slope, left - right))
        believed = (INDUCTION, NO_ENERGY, UNROLLED)
        return Draft([[*cases, *one_minimum(order)]], believed=believed)

    return draft


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-4.normal-equation": normal_equation(2),
    "sec-4.c1-similarly": normal_equation(1),
}
