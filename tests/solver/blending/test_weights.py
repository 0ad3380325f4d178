"""The representative of a rational base: means of its weights, the surface it stands for, and the blend's rows."""

from fractions import Fraction
from math import comb

import numpy as np
import pytest

from semispline.solver.blending.weights import is_separable, normalised_rows, spline_mean
from semispline.solver.generated import contact_numpy
from semispline.solver.splines import Basis, clamped

# Knots across, from the edge; the base may have a lower degree than the order of contact.
ACROSS = {1: (0.7, 1.9, 1.9, 1.9), 2: (0.7, 1.3, 2.0, 2.0), 3: (0.8, 0.8, 1.1, 1.4), 5: (1.5, 1.5, 1.5, 1.5)}


def along_basis(rng, degree=2):
    return Basis(degree, clamped(np.sort(rng.uniform(0.1, 1.9, 2)), degree, 0.0, 2.0))


def random_rows(rng, order, degree, along, separable=False):
    """Homogeneous rows; a base of low degree repeats its last one, as `Side.rows` does."""
    count = min(order, degree + 2) + 1
    across, v = rng.uniform(0.5, 1.5, count), rng.uniform(0.5, 1.5, along.size)
    weights = np.outer(across, v) if separable else rng.uniform(0.8, 1.25, (count, along.size))
    points = rng.uniform(-1, 1, (count, along.size, 3))
    rows = np.concatenate([points * weights[..., None], weights[..., None]], axis=-1)
    return rows[[min(i, count - 1) for i in range(order + 1)]]


def exact_derivatives(rows, degree, spans):
    """Derivatives at the start by Cox-de Boor's differences, in fractions: rows (K, 4) of one place along."""
    level = [[Fraction(x) for x in row] for row in rows.tolist()]
    knots = [Fraction(0)] * (degree + 1) + [Fraction(x) for x in spans]
    result = []
    for d in range(len(rows)):
        result.append(level[0])
        p, below = degree - d, level
        if p <= 0:
            return result + [[Fraction(0)] * 4 for _ in range(len(rows) - 1 - d)]
        level = []
        for i in range(len(below) - 1):
            # An empty support lies away from the start: what is put there does not reach it.
            width = knots[i + degree + 1] - knots[i + d + 1] or Fraction(1)
            level.append([p * (b - a) / width for a, b in zip(below[i], below[i + 1], strict=True)])
        below = level
    return result


def quotient_jets(jets):
    """Derivatives of X / om from those of (X, om), in fractions."""
    known = []
    for k, jet in enumerate(jets):
        known.append(
            [
                (jet[d] - sum(comb(k, j) * jets[j][3] * known[k - j][d] for j in range(1, k + 1))) / jets[0][3]
                for d in range(3)
            ]
        )
    return known


@pytest.mark.parametrize("separable", [True, False])
@pytest.mark.parametrize("order", [0, 1, 2, 3, 4])
@pytest.mark.parametrize("degree", list(ACROSS))
def test_the_surface_stays_and_the_mean_weights_are_one_and_none(degree, order, separable):
    rng = np.random.default_rng(10 * degree + order)
    along = along_basis(rng)
    rows = random_rows(rng, order, degree, along, separable)
    new, new_degree = normalised_rows(rows, along, degree, ACROSS[degree])
    weights = []
    for j in range(along.size):
        old, now = (exact_derivatives(r[:, j], d, ACROSS[degree]) for r, d in ((rows, degree), (new, new_degree)))
        # The factor depends on w alone, so each column of control points has its own quotient.
        for one, other in zip(quotient_jets(old), quotient_jets(now), strict=True):
            assert [float(x) for x in other] == pytest.approx([float(x) for x in one], rel=1e-9, abs=1e-10)
        weights.append([float(jet[3]) for jet in now])
    means = spline_mean(along, np.array(weights).T)
    assert means == pytest.approx([1] + [0] * order, abs=1e-11)
    if separable:
        assert np.abs(np.array(weights)[:, 1:]).max(initial=0) < 1e-10


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("degree", list(ACROSS))
def test_rows_of_separable_weights_have_the_weights_of_the_edge_for_every_alpha(degree, order):
    rng = np.random.default_rng(degree + 7 * order)
    along, spans = along_basis(rng), ACROSS[degree]
    rows = random_rows(rng, order, degree, along, separable=True)
    assert is_separable(rows[: degree + 1, :, 3])
    new, new_degree = normalised_rows(rows, along, degree, spans)
    contact = getattr(contact_numpy, f"contact_rows_{order}")
    for a in (0.25, 1.0, 4.0):
        matrix = contact(a, 2 * order + 1, *[1.0] * order, new_degree, *spans[:order])
        weights = matrix @ new[:, :, 3]
        assert np.abs(weights - new[0, :, 3]).max() < 1e-12 * np.abs(matrix).sum(axis=1).max()


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_contact_rows_of_other_weights_are_polynomials_in_alpha(order):
    rng = np.random.default_rng(order)
    along, spans = along_basis(rng), ACROSS[3]
    rows = random_rows(rng, order, 3, along)
    assert not is_separable(rows[:, :, 3])
    new, degree = normalised_rows(rows, along, 3, spans)
    contact = getattr(contact_numpy, f"contact_rows_{order}")
    at = np.linspace(0.25, 4, order + 4)
    found = np.array([contact(a, 9, *[1.0] * order, degree, *spans[:order]) @ new[:, :, 3] for a in at])
    # Differences of order k + 1 of a polynomial of degree k vanish; those of order k of row k do not.
    for k in range(1, order + 1):
        assert np.abs(np.diff(found[:, k], k + 1, axis=0)).max() < 1e-11
        assert np.abs(np.diff(found[:, k], k, axis=0)).max() > 1e-6


def test_polynomial_rows_and_multiples_of_rows():
    rng = np.random.default_rng(3)
    along, spans = along_basis(rng), (1e-6, 1.0, 1.0, 1.0)
    rows = random_rows(rng, 4, 4, along)
    rows[:, :, 3] = 1
    assert np.array_equal(normalised_rows(rows, along, 4, spans)[0], rows)
    weighted = random_rows(rng, 4, 4, along)
    one, other = (normalised_rows(factor * weighted, along, 4, ACROSS[5])[0] for factor in (1.0, 3.0))
    assert other == pytest.approx(one, rel=1e-12, abs=1e-12)


def test_separability_is_told_to_a_limit():
    weights = np.outer([1, 2, 3], [1, 0.5, 0.25, 1])
    assert is_separable(weights[:1])
    for change, told in ((1e-13, True), (1e-10, False)):
        assert is_separable(weights + change * np.eye(3, 4)) is told
