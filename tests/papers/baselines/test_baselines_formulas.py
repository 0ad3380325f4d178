"""Methods that give formulas, not splines: Hartmann, Bloor and Wilson; what defines them, without their own code."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from numpy.polynomial import chebyshev

from semispline import BSplineSurface
from semispline.papers.baselines import bloor_wilson, hartmann
from semispline.papers.baselines.contacts import contact_sides
from semispline.papers.baselines.interface import FormulaSurface, NotApplicableError
from semispline.papers.baselines.registry import method
from semispline.papers.baselines.splines import as_spline
from semispline.papers.lin2014.examples.section5 import example
from semispline.solver.judge.de_boor import surface_points

ORDERS = [(du, dv) for du in range(4) for dv in range(4 - du)]


# ---------------------------------------------------------------- Hartmann


@pytest.mark.parametrize(("n", "mu"), [(1, 0.5), (2, 0.5), (2, 0.3), (3, 0.7)])
def test_the_weight_and_its_derivatives(n, mu):
    t = sp.Symbol("t")
    f = mu * (1 - t) ** (n + 1) / (mu * (1 - t) ** (n + 1) + (1 - mu) * t ** (n + 1))
    x = np.linspace(0, 1, 11)
    for order in range(3):
        expected = sp.lambdify(t, sp.diff(f, t, order))(x)
        np.testing.assert_allclose(hartmann.weight(x, n, mu, order), expected, rtol=1e-10, atol=1e-12)
    # 1 - f is flat at t = 0 and f at t = 1, up to order n.
    for end, value in ((0, 1), (1, 0)):
        ends = [sp.diff(f, t, order).subs(t, end) for order in range(n + 1)]
        np.testing.assert_allclose(np.array(ends, dtype=float), [value] + [0] * n, atol=1e-12)


@pytest.mark.parametrize("variant", ["inside", "extended"])
@pytest.mark.parametrize("n", [1, 2])
def test_hartmann_agrees_with_the_bases_up_to_order_n_and_no_further(variant, n):
    task = example(6)
    surface = hartmann.blend_hartmann(variant, task, n).surface
    sides = contact_sides(task)
    v = np.linspace(0.01, 0.99, 13)
    for end, side in enumerate(sides):
        # t runs into a base where the piece lies inside of it, else out of it; at t = 1 the other way round.
        scale = hartmann.INSIDE if variant == "inside" else -side.natural
        scale *= 1 if end == 0 else -1
        for order in range(3):
            found = surface.evaluate(np.full_like(v, end), v, order, 0)
            wanted = scale**order * surface_points(side.surface, np.zeros_like(v), v, order, 0)
            same = np.allclose(found, wanted, rtol=0, atol=1e-9 * np.abs(wanted).max() + 1e-9)
            assert same == (order <= n), (end, order)


# ---------------------------------------------------------------- formulas and their derivatives


@pytest.mark.parametrize(
    ("name", "figure"),
    [("hartmann-inside", 6), ("hartmann-extended", 6), ("bloor-wilson-4", 10), ("bloor-wilson-6", 10),
     ("open-cascade-filling", 6)],
)  # fmt: skip
def test_derivatives_of_formulas_are_derivatives(name, figure):
    surface = method(name).run(example(figure)).surface
    assert isinstance(surface, FormulaSurface)
    rng = np.random.default_rng(1)
    u, v = rng.uniform(0.05, 0.95, (2, 20))
    h = 1e-4
    for du, dv in ORDERS[1:]:
        # Central differences of the derivative one order below.
        step_u, step_v = (h, 0.0) if du else (0.0, h)
        lower = (du - 1, dv) if du else (du, dv - 1)
        difference = (
            surface.evaluate(u + step_u, v + step_v, *lower) - surface.evaluate(u - step_u, v - step_v, *lower)
        ) / (2 * h)
        found = surface.evaluate(u, v, du, dv)
        # Third derivatives times h^2 / 6, or rounding over h; a knot between the two points spoils one or two of them.
        error = np.linalg.norm(difference - found, axis=1) / np.abs(found).max()
        assert np.median(error) < 1e-5, (du, dv)
        assert np.sort(error)[-3] < 1e-3, (du, dv)


def test_a_spline_stands_for_a_formula():
    surface = method("hartmann-extended").run(example(6)).surface
    spline, apart = as_spline(surface)
    assert isinstance(spline, BSplineSurface)
    assert apart < 1e-4
    rng = np.random.default_rng(0)
    u, v = rng.uniform(0, 1, (2, 200))
    np.testing.assert_allclose(surface_points(spline, u, v), surface.evaluate(u, v), atol=2 * apart + 1e-12)
    already = method("quintic-hermite").run(example(6)).surface
    assert as_spline(already) == (already, 0.0)


# ---------------------------------------------------------------- Bloor and Wilson


@pytest.mark.parametrize("k", [2, 3])
@pytest.mark.parametrize("rate", [0.0, 0.7, 6.0, 60.0])
def test_mode_functions_solve_the_equation_with_unit_boundary_values(k, rate):
    u = np.linspace(0, 1, 17)
    # (d^2 - r^2)^k by the binomial theorem, with derivatives up to order 2k.
    residual = sum(
        sp.binomial(k, j) * (-(rate**2)) ** (k - j) * bloor_wilson.fundamental(k, rate, u, 2 * j) for j in range(k + 1)
    )
    size = max(np.abs(bloor_wilson.fundamental(k, rate, u, 2 * k)).max(), 1.0)
    assert np.abs(np.asarray(residual, dtype=float)).max() < 1e-9 * size
    functions = bloor_wilson.mode_functions(k, rate)
    ends = np.array([functions.values(np.array([end]), order)[0] for end in (0.0, 1.0) for order in range(k)])
    np.testing.assert_allclose(ends, np.eye(2 * k), atol=1e-8)


@pytest.mark.parametrize("k", [2, 3])
def test_fundamental_solutions_and_derivatives_are_the_ones_of_the_source(k):
    u, r = sp.symbols("u r")
    ours = [u**j * sp.exp(sign * r * at) for sign, at in ((1, u - 1), (-1, u)) for j in range(k)]
    x = np.linspace(0, 1, 5)
    for order in range(2 * k + 1):
        expected = np.stack([sp.lambdify((u, r), sp.diff(y, u, order))(x, 1.9) + 0 * x for y in ours], axis=1)
        np.testing.assert_allclose(bloor_wilson.fundamental(k, 1.9, x, order), expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(("name", "k"), [("bloor-wilson-4", 2), ("bloor-wilson-6", 3)])
def test_bloor_wilson_solves_its_equation_and_meets_its_boundary(name, k):
    """Modes of the surface by Fourier transform, derivatives in u by a Chebyshev fit: none of the method's own code."""
    task = example(10)
    result = method(name).run(task)
    smoothing = float(result.note.rsplit(" ", 1)[1])
    a, b = contact_sides(task)
    # The parameter itself, from its definition: mean gap over mean radius.
    v = np.arange(512) / 512
    gap = np.linalg.norm(a.derivatives(v, 0) - b.derivatives(v, 0), axis=1).mean()
    radius = np.mean([np.linalg.norm(s.derivatives(v, 0, 1), axis=1).mean() for s in (a, b)]) / (2 * np.pi)
    np.testing.assert_allclose(smoothing, gap / radius, rtol=2e-3)
    smoothing = gap / radius
    nodes = (1 - np.cos(np.pi * (np.arange(49) + 0.5) / 49)) / 2
    modes = np.fft.rfft(result.surface.evaluate_grid(nodes, v), axis=1) / 512
    largest, residuals = 0.0, []
    for n in range(4):
        for part in (modes[:, n].real, modes[:, n].imag):
            fit = chebyshev.chebfit(2 * nodes - 1, part, 40)
            terms = []
            for j in range(k + 1):
                values = chebyshev.chebval(np.linspace(-0.9, 0.9, 9), chebyshev.chebder(fit, 2 * j)) * 2 ** (2 * j)
                terms.append(sp.binomial(k, j) * (-((smoothing * n) ** 2)) ** (k - j) * values)
            largest = max(largest, *(float(np.abs(np.asarray(t, dtype=float)).max()) for t in terms))
            residuals.append(float(np.abs(np.asarray(sum(terms), dtype=float)).max()))
    # Differentiating a fit of degree 40 up to six times costs about eleven digits.
    assert max(residuals) < 1e-3 * largest
    w = np.linspace(0, 1, 41)
    for end, side, sign in ((0, a, 1.0), (1, b, -1.0)):
        for order in range(k):
            wanted = (sign * side.natural) ** order * (-1.0) ** order * surface_points(side.surface, 0 * w, w, order, 0)
            np.testing.assert_allclose(result.surface.evaluate(0 * w + end, w, order, 0), wanted, atol=1e-8)


def test_bloor_wilson_is_refused_for_open_contacts():
    with pytest.raises(NotApplicableError, match="open"):
        method("bloor-wilson-6").run(example(6))
