"""The exact reduction: the energy of the best blend as a polynomial in alpha^2 and beta^2, minimised with proof."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.errors import ComputationError
from semispline.solver.generated import shape_numpy
from semispline.solver.proof import Certificate, best_of_grid, least_point

# The proven bound lies within this fraction of the energy; an energy below 1e-12 of its terms counts as zero.
PROOF_TOLERANCE = 1e-10
ZERO_ENERGY = 1e-12
_CENTRES = 4
# Beyond it the fourth powers of the box leave the range of floats.
_MOST_ENERGY = 1e200


@dataclass(frozen=True, eq=False)
class ReducedSolution:
    """The global minimum over the box, and its proof.

    Attributes
    ----------
    a, b : float
        alpha^2 and beta^2, in the parameters of the bases.
    certificate : Certificate
        Of the energy in coordinates of size 1, in x = (a - a0) / natural a and y likewise.
    gap : float
        Energy minus proven bound, over the energy (or over 1e-12 of its terms' magnitudes where that is larger).
    """

    a: float
    b: float
    certificate: Certificate
    gap: float


def shape_polynomial(problem: BlendProblem, centre: tuple[float, float]) -> FloatArray:
    """Return the least energy as a polynomial about a centre: [i, j] multiplies x^i y^j, in units of natural size.

    Source: generated from `semispline.derivations.shape`.
    """
    points = _monomial_points(problem, centre)
    products = problem.energy_products(points)
    powers = [side.order * is_free for side, is_free in zip((problem.a, problem.b), problem.free, strict=True)]
    function = getattr(shape_numpy, f"shape_polynomial_{powers[0]}{powers[1]}")
    table = np.asarray(function(*products[np.triu_indices(len(products))]))
    if not (np.abs(table) <= _MOST_ENERGY).all():
        raise ComputationError(
            f"the energy reaches {np.abs(table).max():.0e} in coordinates of size 1, expected at most "
            f"{_MOST_ENERGY:.0e}; knots or shape parameters are too far from the size of the gap"
        )
    return table


def _monomial_points(problem: BlendProblem, centre: tuple[float, float]) -> FloatArray:
    """Return the control points Z_k of P = sum_k m_k Z_k, m = (1, x, .., y, ..), shape (K, N, 3)."""
    offsets, degree = problem.form.offsets, problem.form.u.degree
    layers = [np.zeros((offsets[-1], problem.dimension))]
    for (side, rows, spans), at, unit, is_free in zip(
        problem.contacts, centre, problem.natural, problem.free, strict=True
    ):
        powers = side.row_powers(at, degree, spans) if is_free else [side.contact_rows(at, degree, spans)]
        for k, power in enumerate(powers):
            if k:
                layers.append(np.zeros((offsets[-1], problem.dimension)))
            for row, values in zip(rows, power, strict=False):
                layers[0 if k == 0 else -1][offsets[row] : offsets[row + 1]] = values * unit**k
    completed = problem.completed(np.concatenate(layers, axis=1))
    return np.stack(np.split(completed, len(layers), axis=1))


def solve_reduced(problem: BlendProblem) -> ReducedSolution:
    """Find the shape parameters of least energy over the admissible box, and prove it.

    Raises
    ------
    ComputationError
        The proof did not succeed, or the energy is out of the range of floats.
    """
    # Where a parameter is fixed, the centre carries its value; the polynomial does not depend on it.
    first, second = (0.0 if f else fixed for f, fixed in zip(problem.free, problem.start, strict=True))
    centre = first, second
    table = shape_polynomial(problem, centre)
    x, y = best_of_grid(table, _box(problem, centre))
    terms = float(np.polynomial.polynomial.polyval2d(abs(x), abs(y), np.abs(table)))
    centre = _moved(problem, centre, (x, y))
    gap = np.inf
    for _ in range(_CENTRES):
        # About its minimum the polynomial has the energy itself as constant term: nothing cancels there.
        table = shape_polynomial(problem, centre)
        scale = max(float(table[0, 0]), ZERO_ENERGY * terms)
        certificate = least_point(table, _box(problem, centre), PROOF_TOLERANCE / 4 * scale)
        found = _moved(problem, centre, certificate.point)
        points = problem.control_points(*found)
        energy = float(problem.energy_products(points[None])[0, 0])
        gap = (energy - certificate.bound) / max(energy, ZERO_ENERGY * terms)
        # A bound above the energy would mean that the polynomial is not the energy.
        if abs(gap) <= PROOF_TOLERANCE:
            return ReducedSolution(*found, certificate, gap)
        centre = found
    raise ComputationError(
        f"the least energy is proved only to {gap:.1e} of itself, expected {PROOF_TOLERANCE:.0e}; "
        "try method casadi, or knots that are further apart"
    )


def _box(problem: BlendProblem, centre: tuple[float, float]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the admissible box in x and y."""
    x, y = (
        ((low - at) / unit, (high - at) / unit)
        for (low, high), at, unit in zip(problem.bounds, centre, problem.natural, strict=True)
    )
    return x, y


def _moved(problem: BlendProblem, centre: tuple[float, float], point: tuple[float, float]) -> tuple[float, float]:
    """Return alpha^2 and beta^2 at x and y, inside their bounds."""
    a, b = (
        min(max(at + x * unit, low), high)
        for at, x, unit, (low, high) in zip(centre, point, problem.natural, problem.bounds, strict=True)
    )
    return a, b
