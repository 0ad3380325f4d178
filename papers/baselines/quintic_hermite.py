"""Quintic Hermite rows: position, first and second cross derivative on both sides, and nothing free between them."""

from __future__ import annotations

import time

import numpy as np

from semispline.papers.baselines.contacts import polynomial_sides
from semispline.papers.baselines.interface import BlendTask, Method, Outcome
from semispline.papers.baselines.semistructured import outcome_of
from semispline.papers.baselines.surfaces_from_rows import semistructured_surface, u_basis
from semispline.solver.arrays import FloatArray
from semispline.solver.blending import blend


def hermite_rows(outwards: FloatArray, a: float) -> FloatArray:
    """Return B_0, B_1, B_2 from position and cross derivatives, T = a R_w and A = a^2 R_ww, shape (3, n, 3)."""
    position, tangent, second = outwards[0], a * outwards[1], a**2 * outwards[2]
    return np.stack([position, position + tangent / 5, position + 2 * tangent / 5 + second / 20])


def blend_natural(task: BlendTask) -> Outcome:
    """Blend with alpha^2 and beta^2 of natural size."""
    a, b = polynomial_sides(task)
    started = time.perf_counter()
    rows = [*hermite_rows(a.outwards, a.natural), *hermite_rows(b.outwards, b.natural)[::-1]]
    surface = semistructured_surface(u_basis(6, 5), (a.along,) * 3 + (b.along,) * 3, rows)
    return Outcome(surface, surface.n_control_points, None, time.perf_counter() - started, a.natural, b.natural)


def blend_least_energy(task: BlendTask) -> Outcome:
    """Blend with the alpha and beta of least energy."""
    return outcome_of(blend(task.a, task.b, continuity="G2", middle_curves=0, degree_u=5, alpha="energy"))


METHODS = (
    Method(
        "quintic-hermite",
        "quintic Hermite, natural size",
        "in the way of reference [11] of the paper: quintic in u, no free rows",
        30,
        blend_natural,
    ),
    Method(
        "quintic-hermite-least",
        "quintic Hermite, least energy",
        "the same with alpha and beta of least energy",
        31,
        blend_least_energy,
    ),
)
