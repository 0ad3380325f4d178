"""Least triharmonic energy: the integral of |grad Laplace p|^2, with position and two cross derivatives fixed.

Unlike thin-plate energy it is one order above what curvature contact prescribes, so that refinement in u does not lose
the curvature. Both energies are minimised over the same refined space here: the union of knots in v, and more rows.

Source: P. Kiciak, Bicubic B-spline blending patches with optimized shape, CAD 43 (2011).
"""

from __future__ import annotations

import time
from functools import partial

from semispline.papers.baselines.contacts import on_common_knots, polynomial_sides
from semispline.papers.baselines.interface import BlendTask, Method, Outcome
from semispline.papers.baselines.quadratic_forms import THIN_PLATE, TRIHARMONIC, energy_matrix
from semispline.papers.baselines.rows_of_least_energy import contact_rule, least_energy
from semispline.papers.baselines.surfaces_from_rows import tensor_product, u_basis

ROWS = 11


def blend_refined(energy: str, task: BlendTask) -> Outcome:
    """Blend with G2 rows of natural size and the least triharmonic or thin-plate energy over the same space."""
    sides = polynomial_sides(task)
    started = time.perf_counter()
    a, b = on_common_knots(*sides)
    u, v = u_basis(ROWS), a.along
    matrix = energy_matrix(u, (v,) * ROWS, TRIHARMONIC if energy == "triharmonic" else THIN_PLATE)
    rules = contact_rule(a, 2, u), contact_rule(b, 2, u)
    natural = ((a.natural, a.natural), (b.natural, b.natural))
    found = least_energy(matrix, (v,) * ROWS, rules, natural, task.closed)
    surface = tensor_product(u, v, found.rows)
    return Outcome(surface, surface.n_control_points, None, time.perf_counter() - started, found.a, found.b)


METHODS = (
    Method(
        "triharmonic",
        f"triharmonic energy, {ROWS} rows",
        "P. Kiciak, CAD 43 (2011): rows over the union of knots, G2, natural size",
        60,
        partial(blend_refined, "triharmonic"),
    ),
    Method(
        "thin-plate-refined",
        f"thin-plate energy, {ROWS} rows",
        "the same space and rows with energy (11), to compare with",
        61,
        partial(blend_refined, "thin-plate"),
    ),
)
