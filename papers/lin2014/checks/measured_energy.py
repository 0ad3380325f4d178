"""What the errors of sections 3 and 4, in energy and system, do to a surface, measured on blends of the made pair."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TypeAlias

import numpy as np

from semispline.papers.ledger import Consequence
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.energy import printed_system
from semispline.papers.lin2014.checks.measured_rows import made_blend
from semispline.papers.lin2014.examples.made_pair import made_pair
from semispline.papers.lin2014.examples.stand_ins import cylinders
from semispline.solver.arrays import FloatArray
from semispline.solver.blending import BlendResult, blend, thin_plate_energy
from semispline.solver.judge import local_geometry, surface_points
from semispline.solver.options import Continuity
from semispline.solver.splines import (
    SemiStructuredSurface,
    affine_knots,
    basis_matrix,
    derivative_matrix,
    gauss_rule,
)


def parameter_dependence() -> Consequence:
    """Measure the integral of squared principal curvatures over the parameters, for two parametrisations."""
    surface = made_blend().surface
    doubled = replace(
        surface,
        control_curves=tuple(replace(c, knots=affine_knots(c.knots, 0.0, 2.0)) for c in surface.control_curves),
    )
    measured = {}
    for name, version in (("v in [0, 1]", surface), ("v in [0, 2]", doubled)):
        over_parameters, over_area = _strain(version)
        measured[f"over the parameters, {name}"] = over_parameters
        measured[f"over the surface, {name}"] = over_area
    return on_surface("The G2 blend of the made pair, one and the same surface, in two parametrisations", measured)


def _strain(surface: SemiStructuredSurface) -> tuple[float, float]:
    """Return the integral of k1^2 + k2^2 over the parameters and over the surface, by a Gauss rule on each cell."""
    (u, wu), (v, wv) = (_nodes(x) for x in surface.breakpoints)
    grid_u, grid_v = (x.ravel() for x in np.meshgrid(u, v, indexing="ij"))
    weights = np.outer(wu, wv).ravel()
    geometry = local_geometry(surface, grid_u, grid_v)
    squares = 4 * geometry.mean**2 - 2 * geometry.gaussian
    area = np.linalg.norm(np.cross(geometry.tangent_u, geometry.tangent_v), axis=1)
    return float(weights @ squares), float(weights @ (squares * area))


@cache
def least_energy(continuity: Continuity, middle_curves: int, *, all_knots: bool = False) -> tuple[float, int]:
    """Return the energy of a blend of the made pair, and how many control points it has.

    Middle curves have the rule's knots, or all knots of both contacts.
    """
    knots = [_knots_of_both()] * middle_curves if all_knots else "paper"
    result = blend(*made_pair(), continuity=continuity, middle_curves=middle_curves, middle_knots=knots, alpha="energy")
    return result.energy, result.surface.n_control_points


def _knots_of_both() -> list[float]:
    a, b = (side.surface for side in made_pair())
    return sorted({*a.knots_v[4:-4].tolist(), *b.knots_v[4:-4].tolist()})  # type: ignore[union-attr]


def union_knots() -> Consequence:
    """Measure the energy of a C2 blend whose middle curve has the rule's knots, and one that has all knots of both."""
    own = made_blend("C2")
    refined = blend(*made_pair(), continuity="C2", alpha="energy", middle_knots=[_knots_of_both()])
    measured = {
        f"energy (11), {own.surface.n_control_points} control points": own.energy,
        f"energy (11) on the union of knots, {refined.surface.n_control_points} control points": refined.energy,
    }
    return on_surface("C2 blends of the made pair, the middle curve by the paper's rule and on all knots", measured)


def other_direction() -> Consequence:
    """Blend the cylinders of Fig. 8 with the middle knot that the rule gives in one direction of v and in the other."""
    there, back = (blend(*cylinders(), continuity="C2", alpha="energy", middle_knots=[[knot]]) for knot in (0.4, 0.6))
    measured = {
        "energy (11), middle knot 0.4": there.energy,
        "energy (11), middle knot 0.6, as from the other end": back.energy,
        "largest displacement": _largest_change(there.surface, back.surface),
    }
    return on_surface("C2 blends of the cylinders with the knots of Fig. 8, the last knot dropped", measured)


def zero_system() -> Consequence:
    """Solve (14) as printed on the layout of Fig. 5, and put its solution into the blend of the made pair."""
    A, B = printed_system()
    # 0 X = 0: the solution of least norm, which a solver returns, is zero.
    result = made_blend("C2")
    curves = list(result.surface.control_curves)
    curves[3] = replace(curves[3], control_points=np.zeros_like(curves[3].control_points))
    surface = replace(result.surface, control_curves=tuple(curves))
    measured = {
        "rank of A": int(A.rank()),
        "rank of B": int(B.rank()),
        "unknown control points": int(A.rows),
        "energy (11) of the made pair's C2 blend with X = 0": thin_plate_energy(surface),
        "least energy": result.energy,
        "largest displacement": _largest_change(result.surface, surface),
    }
    return on_surface("(14) over the printed knots of Fig. 5: A and B are zero, every X solves it", measured)


def single_integrals() -> Consequence:
    """Give the rank of A when only its third term is repaired."""
    A, _ = printed_system("vv")
    result = made_blend("C2")
    measured = {"rank of A": float(A.rank()), "unknown control points": float(A.rows), "least energy": result.energy}
    return on_surface("(14) over the printed knots of Fig. 5 with C_vv^T C_vv: A is singular still", measured)


def third_term() -> Consequence:
    """Solve the stationarity system of the made pair with the printed third term, products integrated last."""
    result = made_blend("C2")
    surface = with_normal_equation(result, (*COMMON_TERMS, (1, (1, 1), (0, 2))))
    measured = {
        "energy (11) with the printed third term": thin_plate_energy(surface),
        "least energy": result.energy,
        "largest displacement": _largest_change(result.surface, surface),
    }
    return on_surface("The middle curve of the made pair's C2 blend from the system with C_uv^T C_vv", measured)


Term: TypeAlias = tuple[int, tuple[int, int], tuple[int, int]]
# Factor, derivatives by u and v of the row's own functions, and of those of all rows: C_uu^T C_uu + 2 C_uv^T C_uv.
COMMON_TERMS: tuple[Term, ...] = ((1, (2, 0), (2, 0)), (2, (1, 1), (1, 1)))


def with_normal_equation(result: BlendResult, terms: tuple[Term, ...]) -> SemiStructuredSurface:
    """Set the middle curve by a normal equation of given terms, the integrals of products taken by a Gauss rule."""
    surface = result.surface
    curves = surface.control_curves
    (u, wu), (v, wv) = (_nodes(x) for x in surface.breakpoints)
    across = [_functions(surface.degree_u, surface.knots_u, u, d) for d in range(3)]
    middle = 3
    own = [_functions(curves[middle].degree, curves[middle].knots, v, d) for d in range(3)]
    size = own[0].shape[1]
    matrix, right = np.zeros((size, size)), np.zeros((size, 3))
    for factor, (du, dv), (eu, ev) in terms:
        for i, curve in enumerate(curves):
            weight = factor * float(np.sum(wu * across[du][:, middle] * across[eu][:, i]))
            left = (own[dv] * wv[:, None]).T * weight
            if i == middle:
                matrix += left @ own[ev]
            else:
                right -= left @ curve.evaluate(v, ev)
    points, *_ = np.linalg.lstsq(matrix, right, rcond=None)
    changed = list(curves)
    changed[middle] = replace(curves[middle], control_points=np.asarray(points, dtype=np.float64))
    return replace(surface, control_curves=tuple(changed))


def _nodes(breaks: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return points and weights of a Gauss rule with eight points in each span."""
    points, weights = gauss_rule(breaks, 15)
    return points.ravel(), weights.ravel()


def _functions(degree: int, knots: FloatArray, x: FloatArray, derivative: int) -> FloatArray:
    """Return a derivative of all basis functions at x, shape (len(x), n)."""
    inner = knots[derivative : len(knots) - derivative]
    matrix = basis_matrix(degree - derivative, inner, x) @ derivative_matrix(degree, knots, derivative)
    return np.asarray(matrix.toarray())


def _largest_change(one: SemiStructuredSurface, other: SemiStructuredSurface) -> float:
    """Return the largest distance of two surfaces on a grid, by the referee."""
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 41), np.linspace(*one.domain[1], 41)))
    return float(np.linalg.norm(surface_points(one, u, v) - surface_points(other, u, v), axis=1).max())


def vector_lengths() -> Consequence:
    """Count the entries that the printed last indices of C_vv give, beside those that the middle curve has."""
    curves = made_blend().surface.control_curves
    lengths = {"of b_3j by the printed index": 2, "of b_{m-3,j} by the printed index": 4, "that row 3 has": 3}
    measured = {f"entries {name}": float(len(curves[i].control_points)) for name, i in lengths.items()}
    return on_surface(
        "The lists C_uu and C_vv for the made pair's blend, m = 6, where rows 3 and m-3 are one", measured
    )
