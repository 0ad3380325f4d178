"""Generated energy code: NumPy against CasADi and exact values; the whole Lagrangian against SymPy's derivatives."""

from itertools import pairwise

import casadi as ca
import numpy as np
import pytest
import scipy.sparse as sp

from semispline.derivations.energy import Basis, ExactSurface, gram_matrix
from semispline.derivations.problem import ExactBase, blend_problem, derivatives_at, lagrangian
from semispline.solver.generated import contact_casadi, energy_casadi, energy_numpy

# Dyadic knots and points are exact in floats; Gram entries are then rounded once each.
U = Basis(3, (0, 0, 0, 0, "1/4", "1/2", "3/4", 1, 1, 1, 1))
LEFT, MIDDLE, RIGHT = (Basis(2, (0, 0, 0, knot, 1, 1, 1)) for knot in ("1/4", "1/2", "5/8"))
SURFACE = ExactSurface(U, (LEFT, LEFT, LEFT, MIDDLE, RIGHT, RIGHT, RIGHT))
ACROSS_A, ACROSS_B = Basis(2, (0, 0, 0, "1/2", 1, 1, 1)), Basis(1, (0, 0, 2, 2))


def test_density_is_the_sum_of_squares_over_coordinates():
    rng = np.random.default_rng(0)
    uu, uv, vv = rng.integers(-9, 9, (3, 2, 5, 3)) / 4
    found = energy_numpy.thin_plate_density(uu, uv, vv)
    assert found.shape == (2, 5)
    expected = np.einsum("...d,...d", uu, uu) + 2 * np.einsum("...d,...d", uv, uv) + np.einsum("...d,...d", vv, vv)
    np.testing.assert_array_equal(found, expected)
    for k in np.ndindex(2, 5):
        assert float(energy_casadi.thin_plate_density(uu[k], uv[k], vv[k])) == found[k]


def test_gram_block_takes_numbers_arrays_and_sparse_matrices():
    dense = [np.arange(6.0).reshape(2, 3) + d for d in range(3)]
    expected = 5 * dense[0] + 2 * 3 * dense[1] + 2 * dense[2]
    np.testing.assert_array_equal(energy_numpy.gram_block(2, 3, 5, *dense), expected)
    sparse = energy_numpy.gram_block(2, 3, 5, *map(sp.csr_array, dense))
    assert sp.issparse(sparse)
    np.testing.assert_array_equal(sparse.toarray(), expected)
    assert energy_numpy.gram_block(2, 3, 5, 7, 11, 13) == 5 * 7 + 2 * 3 * 11 + 2 * 13
    np.testing.assert_array_equal(np.array(energy_casadi.gram_block(2, 3, 5, *map(ca.DM, dense))), expected)


@pytest.mark.parametrize("module", [energy_numpy, energy_casadi])
def test_arguments_are_checked(module):
    with pytest.raises(ValueError, match=r"G1: shape \(2, 3\), expected \(\) or \(3, 3\)"):
        module.gram_block(1, 1, 1, np.ones((3, 3)), np.ones((2, 3)), np.ones((3, 3)))
    with pytest.raises(ValueError, match=r"A1: shape \(2,\), expected a single number"):
        module.gram_block(1, np.ones(2), 1, 1, 1, 1)
    with pytest.raises(ValueError, match="p_uv: shape"):
        module.thin_plate_density(np.ones(3), np.ones(2), np.ones(3))


@pytest.fixture(scope="module")
def lagrangians():
    """The same G2 Lagrangian in CasADi, from generated code, and in exact polynomials, with a point."""
    rng = np.random.default_rng(5)
    rows_a = rng.integers(-8, 9, (ACROSS_A.size, LEFT.size, 3)) / 4
    rows_b = rng.integers(-8, 9, (ACROSS_B.size, RIGHT.size, 3)) / 4
    bases = [
        ExactBase(b, tuple(tuple(map(tuple, row)) for row in r.tolist()))
        for b, r in ((ACROSS_A, rows_a), (ACROSS_B, rows_b))
    ]
    exact = blend_problem(2, SURFACE, *bases)

    x = ca.SX.sym("x", len(exact.unknowns))
    offsets = np.cumsum([0, *(3 * curve.size for curve in SURFACE.curves)])
    points = [ca.reshape(x[s:e], 3, -1).T for s, e in pairwise(offsets)]
    across = [np.array(gram_matrix(d, U, U), float) for d in range(3)]
    energy = 0
    for i, one in enumerate(SURFACE.curves):
        for k, other in enumerate(SURFACE.curves):
            along = [np.array(gram_matrix(d, one, other), float) for d in range(3)]
            block = energy_numpy.gram_block(*(across[d][i, k] for d in range(3)), *along)
            energy += ca.trace(points[i].T @ ca.DM(block) @ points[k])
    constraints = []
    sides = ((rows_a, (2, 0.5, 1), range(3), x[-2]), (rows_b, (1, 2, 2), range(6, 3, -1), x[-1]))
    for rows, (q, H1, H2), places, shape in sides:
        matrix = contact_casadi.contact_rows_2(shape**2, 3, 0.25, 0.5, q, H1, H2)
        for i, place in enumerate(places):
            target = sum((matrix[i, j] * ca.DM(rows[j]) for j in range(min(3, len(rows)))), ca.SX.zeros(*rows[0].shape))
            constraints.append(ca.vec((points[place] - target).T))
    multipliers = rng.integers(-8, 9, len(exact.constraints)) / 4
    function = energy + ca.dot(ca.DM(multipliers), ca.vertcat(*constraints))
    hessian, gradient = ca.hessian(function, x)
    point = np.concatenate([rng.integers(-8, 9, len(exact.unknowns) - 2) / 4, [1.25, 0.75]])
    return ca.Function("L", [x], [function, gradient, hessian]), lagrangian(exact, multipliers.tolist()), point


@pytest.mark.long
def test_gradient_and_hessian_are_those_of_sympy(lagrangians):
    function, exact, point = lagrangians
    value, gradient, hessian = (np.array(v, dtype=float) for v in function(point))
    expected = [np.array(v, dtype=float) for v in derivatives_at(exact, point.tolist())]
    for found, wanted in zip((value.item(), gradient.ravel(), hessian), expected, strict=True):
        # Sums of some hundred terms, each rounded once.
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * np.abs(wanted).max())
    # Both know the coupling of alpha with the multipliers, not only the quadratic part.
    assert expected[2][-2, -2] != 0


def test_taylor_remainders_have_slopes_two_and_three(lagrangians):
    function, _, point = lagrangians
    direction = np.random.default_rng(6).uniform(-1, 1, len(point))
    value, gradient, hessian = (np.array(v, dtype=float) for v in function(point))
    steps = 2.0 ** -np.arange(2, 7)
    linear, quadratic = [], []
    for step in steps:
        change = (
            float(function(point + step * direction)[0]) - float(value.ravel()[0]) - step * gradient.ravel() @ direction
        )
        linear.append(abs(change))
        quadratic.append(abs(change - step**2 / 2 * direction @ hessian @ direction))
    assert np.polyfit(np.log(steps), np.log(linear), 1)[0] == pytest.approx(2, abs=0.1)
    # Only alpha and beta enter beyond the square, to the fourth power.
    assert np.polyfit(np.log(steps), np.log(quadratic), 1)[0] == pytest.approx(3, abs=0.2)
