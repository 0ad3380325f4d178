"""Least energies of the paper's examples as theorems: over the box of alpha^2, beta^2, and of the middle row.

What is proved is about these polynomials and matrices. The polynomials are those of the solver, their floats taken as
exact; the matrices are the derived ones, exact, and the rows next to the contacts the solver's, taken as exact.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np

from semispline.derivations.energy import Basis, ExactSurface, energy_matrix
from semispline.papers.lin2014.examples.section5 import PRINTED, example
from semispline.papers.recheck import Theory, least_over_a_box, minimiser, rescaled
from semispline.solver.blending import BlendResult, blend

# The proven bound is this fraction below the energy that was found.
GAP = Fraction(1, 10**10)
_SHORT = 10**6


def theories() -> Iterator[Theory]:
    """Yield a theorem for each G2 example, and one for each coordinate of the middle row of each C2 example."""
    for figure, printed in PRINTED.items():
        task = example(figure)
        result = blend(
            task.a, task.b, continuity=printed.continuity, middle_curves=printed.middle_curves, alpha="energy"
        )
        if printed.continuity == "G2":
            yield _over_the_box(figure, result)
        else:
            yield from _middle_row(figure, result)


def _over_the_box(figure: int, result: BlendResult) -> Theory:
    """Return that no admissible alpha^2, beta^2 has less than (1 - gap) times the energy that was found."""
    proof = result.certificate
    bounds = result.alpha2_bounds, result.beta2_bounds
    if proof is None or None in bounds:
        raise ValueError(f"figure {figure}: expected a certificate and bounds")
    box = tuple((Fraction(low), Fraction(high)) for low, high in proof.box)
    x, y = ((Fraction(at) * 2 - low - high) / (high - low) for at, (low, high) in zip(proof.point, box, strict=True))
    table = rescaled([[Fraction(c) for c in row] for row in proof.coefficients.tolist()], (box[0], box[1]))
    a, b = map(_ends, bounds)
    title = f"Fig. {figure}: no alpha^2, beta^2 of the box has less energy"
    return least_over_a_box(f"figure_{figure}_least", title, table, (a, b), (x, y), GAP)


def _middle_row(figure: int, result: BlendResult) -> Iterator[Theory]:
    """Yield that the middle row is the one point of least energy, for each coordinate that is not zero throughout."""
    curves = result.surface.control_curves
    surface = ExactSurface(
        _exact_basis(result.surface.degree_u, result.surface.knots_u),
        tuple(_exact_basis(curve.degree, curve.knots) for curve in curves),
    )
    matrix = energy_matrix(surface).tolist()
    middle = len(curves) // 2
    free = [n for n, (i, _) in enumerate(surface.index) if i == middle]
    entries = [[_fraction(matrix[r][c]) for c in free] for r in free]
    points = np.concatenate([curve.control_points for curve in curves])
    for axis, letter in enumerate("xyz"):
        column = [Fraction(float(x)) for x in points[:, axis]]
        others = [n for n in range(len(column)) if n not in free and column[n]]
        right = [sum((_fraction(matrix[r][n]) * column[n] for n in others), Fraction(0)) for r in free]
        if any(right):
            title = f"Fig. {figure}: the middle row has the least energy, coordinate {letter}"
            yield minimiser(f"figure_{figure}_{letter}", title, entries, right)


def _ends(bounds: Any) -> tuple[Fraction, Fraction]:
    """Return the ends of a range of one number; of what is linear in v each end is a pair, which is no fraction."""
    low, high = bounds
    return Fraction(low), Fraction(high)


def _exact_basis(degree: int, knots: Any) -> Basis:
    """Return a basis over knots that are short fractions; other floats are taken as exact."""
    found = []
    for knot in map(float, knots):
        short = Fraction(knot).limit_denominator(_SHORT)
        found.append(short if float(short) == knot else Fraction(knot))
    return Basis(degree, tuple(found))


def _fraction(x: Any) -> Fraction:
    return Fraction(int(x.p), int(x.q))
