"""One knot vector for all rows: both bases refined to the union of their knots, and an ordinary B-spline blend.

With G1 rows it stands for the paper's [13], of which only its properties are known: equal knots and tangent contact.
With G2 rows it is the honest rival of the semi-structured blend: the same contact and energy, more control points.
"""

from __future__ import annotations

import time
from functools import partial

from semispline.papers.baselines.contacts import on_common_knots, polynomial_sides
from semispline.papers.baselines.interface import BlendTask, Method, Outcome
from semispline.papers.baselines.quadratic_forms import THIN_PLATE, energy_matrix
from semispline.papers.baselines.rows_of_least_energy import contact_rule, least_energy
from semispline.papers.baselines.surfaces_from_rows import tensor_product, u_basis


def blend_same_knots(order: int, task: BlendTask) -> Outcome:
    """Blend with G1 or G2 rows over the union of all knots, as many rows as the semi-structured blend has."""
    sides = polynomial_sides(task)
    started = time.perf_counter()
    a, b = on_common_knots(*sides)
    u, v = u_basis(6 + task.middle_curves), a.along
    bases = (v,) * u.size
    matrix = energy_matrix(u, bases, THIN_PLATE)
    rules = contact_rule(a, order, u), contact_rule(b, order, u)
    found = least_energy(matrix, bases, rules, (a.bounds, b.bounds), task.closed)
    surface = tensor_product(u, v, found.rows)
    seconds = time.perf_counter() - started
    return Outcome(surface, surface.n_control_points, None, seconds, found.a, found.b)


METHODS = (
    Method(
        "same-knots-g1",
        "same knots, G1",
        "stands for reference [13] of the paper: tensor product over the union of knots, tangent contact",
        20,
        partial(blend_same_knots, 1),
    ),
    Method(
        "same-knots-g2",
        "same knots, G2",
        "tensor product over the union of knots, curvature rows too",
        21,
        partial(blend_same_knots, 2),
    ),
)
