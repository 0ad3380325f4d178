"""The energy of rational blends: by quadrature, its free rows stationary, its gradient in the fair search exact."""

from types import SimpleNamespace

import numpy as np
import pytest

from helpers.rational import QUARTER, cylinder, meridian
from semispline import Base, BlendOptions, BSplineSurface, transform
from semispline.solver.blending.fair_objective import FairObjective, make_unknowns
from semispline.solver.blending.fairness_grid import across, along
from semispline.solver.blending.fairness_table import FairnessTable
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.measured_energy import measure_energy, thin_plate_energy
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.blending.rational_energy import RationalForm, RationalSystem, free_weights
from semispline.solver.errors import ComputationError
from semispline.solver.splines import Basis


def stated(**named):
    tilted = np.array([[0.9, 0, 0.3], [0, 1, 0], [-0.3, 0, 0.9]])
    a = cylinder(5.0, 0.0, 4.0, QUARTER)
    b = transform(meridian(2.0, (4.0, 12.0), (-0.4, 1.0), QUARTER), tilted, (1.0, 0.0, 2.0))
    return state_problem(Base(a, "u1"), Base(b, "u0"), BlendOptions(**named)).problem


def made_form(weights):
    u = Basis(3, np.array([0, 0, 0, 0, 0.4, 1, 1, 1, 1.0]))
    rows = tuple(Basis(3, np.array([0, 0, 0, 0, *inner, 2, 2, 2, 2.0])) for inner in ([], [0.7], [0.7], [], [1.1, 1.5]))
    size = sum(row.size for row in rows)
    return RationalForm(u, rows, np.ones(size) if weights is None else weights(size))


def test_with_weights_of_one_it_is_the_polynomial_form():
    form, rng = made_form(None), np.random.default_rng(4)
    plain = EnergyForm(form.u, form.rows)
    points = rng.normal(size=(3, form.offsets[-1], 3))
    assert form.products(points) == pytest.approx(plain.products(points), rel=1e-12)
    rows = range(1, 4)
    low, high = form.offsets[1], form.offsets[4]
    dense = plain.matrix().toarray()
    assert form.system(rows).toarray() == pytest.approx(dense[low:high, low:high], rel=1e-10, abs=1e-9)
    assert form.gradient(points[0], rows) == pytest.approx((dense @ points[0])[low:high], rel=1e-9, abs=1e-8)


def test_gradient_and_matrix_are_those_of_the_energy():
    form = made_form(lambda n: 1 + np.random.default_rng(1).uniform(0, 0.6, n))
    points = np.random.default_rng(2).normal(size=(form.offsets[-1], 3))
    rows = range(1, 3)
    gradient, matrix = form.gradient(points, rows), form.system(rows).toarray()

    def energy(x):
        return form.products(x[None])[0, 0]

    for k, c in ((0, 0), (4, 1), (9, 2)):
        step = np.zeros_like(points)
        step[form.offsets[1] + k, c] = 1e-3
        # A quadratic form: differences of any step are exact but for rounding.
        slope = (energy(points + step) - energy(points - step)) / 2e-3
        assert 2 * gradient[k, c] == pytest.approx(slope, rel=1e-8)
        bend = (energy(points + step) + energy(points - step) - 2 * energy(points)) / 1e-6
        assert 2 * matrix[k, k] == pytest.approx(bend, rel=1e-5)


def test_the_energy_of_a_rational_surface_is_that_of_its_points():
    """Finite differences of evaluated points, on a fine midpoint rule: nothing of quotients."""
    surface = meridian(2.0, (4.0, 12.0), (-0.4, 1.0), QUARTER)
    n, h = 120, 1e-4
    x = (np.arange(n) + 0.5) / n
    at = {(i, j): surface.evaluate_grid(x + i * h, x + j * h) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    uu = (at[1, 0] + at[-1, 0] - 2 * at[0, 0]) / h**2
    vv = (at[0, 1] + at[0, -1] - 2 * at[0, 0]) / h**2
    uv = (at[1, 1] + at[-1, -1] - at[1, -1] - at[-1, 1]) / (4 * h**2)
    wanted = np.sum(uu**2 + 2 * uv**2 + vv**2) / n**2
    found = measure_energy(surface)
    assert found.value == pytest.approx(wanted, rel=3e-4)
    assert 0 < found.quadrature_error < 1e-3 * found.value
    # Numbers of its parts do not depend on where it is.
    moved = transform(surface, np.eye(3), (1e4, -3e4, 0.0))
    assert thin_plate_energy(moved) == pytest.approx(found.value, rel=1e-8)


def test_equal_weights_do_not_change_the_energy():
    net = np.random.default_rng(3).normal(size=(4, 5, 3))
    plain = BSplineSurface(3, 2, [0] * 4 + [1] * 4, [0, 0, 0, 0.3, 0.6, 1, 1, 1], net)
    weighted = BSplineSurface(3, 2, plain.knots_u, plain.knots_v, net, np.full((4, 5), 0.7))
    assert measure_energy(plain).quadrature_error is None
    assert thin_plate_energy(weighted) == pytest.approx(thin_plate_energy(plain), rel=1e-12)


@pytest.mark.parametrize(
    "named", [{"middle_curves": 1}, {"continuity": "G1"}, {"continuity": "C1", "middle_curves": 2}]
)
def test_free_rows_have_least_energy(named):
    problem = stated(**named)
    points = problem.control_points(*problem.start)
    system = problem.free_system
    assert system.size > 0
    assert system.excess(points) < 1e-20
    fine = RationalForm(problem.form.u, problem.form.rows, points[:, 3], finer=3)
    least = fine.products(points[None, :, :3])[0, 0]
    rng = np.random.default_rng(5)
    for _ in range(5):
        other = points[:, :3].copy()
        other[system.plain.free] += 1e-3 * rng.normal(size=(system.size, 3))
        assert fine.products(other[None])[0, 0] > least
    assert (points[:, 3] > 0).all()


def test_the_energy_is_a_polynomial_in_both_shape_parameters():
    """15 coefficients from 25 values predict others: weights do not depend on alpha here."""
    problem = stated(alpha="energy")
    natural = np.array(problem.natural)

    def energy(x):
        points = problem.control_points(*(natural * x))
        return problem.energy_products(points[None])[0, 0]

    places = [(x, y) for x in np.linspace(0.2, 3, 5) for y in np.linspace(0.2, 3, 5)]

    def terms(x):
        return [x[0] ** i * x[1] ** j for i in range(5) for j in range(5 - i)]

    solution = np.linalg.lstsq(np.array([terms(x) for x in places]), np.array([energy(x) for x in places]), rcond=None)[
        0
    ]
    for x in ((0.5, 0.7), (1.9, 2.2), (2.8, 0.3)):
        assert terms(x) @ solution == pytest.approx(energy(x), rel=1e-9)


def test_the_gradient_of_the_fair_search_is_its_own():
    problem = stated()
    layers, exponents = problem.shape_layers()
    assert layers.shape[2] == 4
    unknowns = make_unknowns(problem, exponents)
    table = FairnessTable(problem, layers, across(problem.form.u, 20), along(problem.rows))
    objective = FairObjective(unknowns, table)
    middle = (unknowns.low + unknowns.high) / 2 + 0.05 * (unknowns.high - unknowns.low)
    value, gradient = objective(middle)
    assert np.isfinite(value)
    for k in np.flatnonzero(unknowns.low < unknowns.high):
        step = np.zeros_like(middle)
        step[k] = 1e-5
        slope = (objective(middle + step)[0] - objective(middle - step)[0]) / 2e-5
        assert gradient[k] == pytest.approx(slope, rel=1e-5, abs=1e-7)


@pytest.mark.parametrize(("filled", "is_tame"), [(0.6, True), (0.4, False), (1.9, True), (2.1, False)])
def test_free_weights_are_tame_from_half_the_least_to_twice_the_largest(filled, is_tame):
    line = Basis(1, np.array([0, 0, 1, 1.0]))
    weights = np.array([1.0, 1, 0, 0, 1, 1])
    free = slice(2, 4)

    def completed(given):
        found = given.copy()
        found[free] = filled
        return found

    plain = SimpleNamespace(completed=completed, size=2, offsets=[0, 2, 4, 6], free=free, rows=range(1, 2))
    found = free_weights(plain, Basis(2, np.array([0, 0, 0, 1.0, 1, 1])), (line,) * 3, weights)
    assert found.tolist() == [1, 1, *[filled if is_tame else 1.0] * 2, 1, 1]


@pytest.mark.parametrize("order", [-1, 0, 1])
def test_free_rational_rows_close_up_as_smoothly_as_they_should(order):
    form = made_form(lambda n: 1 + np.random.default_rng(1).uniform(0, 0.6, n))
    low, high = form.offsets[1], form.offsets[2]
    plain = SimpleNamespace(rows=range(1, 2), size=high - low, free=slice(low, high))
    points = np.random.default_rng(2).normal(size=(form.offsets[-1], 4))
    points[:, 3] = form.weights
    # Where it starts it is closed up.
    points[low:high] = 0
    filled = RationalSystem(form, plain, [order]).completed(points)[low:high, :3]
    basis = form.rows[1]
    start, end = (np.array([filled[0], filled[1] - filled[0]]), np.array([filled[-1], filled[-1] - filled[-2]]))
    speed = [basis.degree / (basis.knots[k + 4] - basis.knots[k + 1]) for k in (0, basis.size - 2)]
    apart = [np.abs(start[0] - end[0]).max(), np.abs(speed[0] * start[1] - speed[1] * end[1]).max()]
    assert [bool(x < 1e-10) for x in apart] == [order >= 0, order >= 1]


@pytest.mark.parametrize(("part", "is_weight"), [(1e-8, False), (1e-4, True)])
def test_weights_of_a_millionth_are_none(part, is_weight):
    form = made_form(None)
    low, high = form.offsets[1], form.offsets[2]
    plain = SimpleNamespace(rows=range(1, 2), size=high - low, free=slice(low, high))
    points = np.zeros((form.offsets[-1], 8))
    points[:, [3, 7]] = 1, part
    filled = RationalSystem(form, plain, [-1]).completed(points)[low:high]
    assert (filled[:, 3] == 1).all()
    assert (filled[:, 7] == is_weight).all()


def test_excess_is_the_part_of_the_energy_that_a_step_to_the_least_takes():
    form = made_form(lambda n: 1 + np.random.default_rng(1).uniform(0, 0.6, n))
    low, high = form.offsets[1], form.offsets[2]
    plain = SimpleNamespace(rows=range(1, 2), size=high - low, free=slice(low, high))
    points = np.random.default_rng(2).normal(size=(form.offsets[-1], 4))
    points[:, 3] = form.weights
    system = RationalSystem(form, plain, [-1])
    energy, least = (form.products(p[None, :, :3])[0, 0] for p in (points, system.completed(points)))
    assert system.excess(points) == pytest.approx((energy - least) / energy, rel=1e-9)


def free_row(points=None):
    form = made_form(None)
    low, high = form.offsets[1], form.offsets[2]
    return RationalSystem(form, SimpleNamespace(rows=range(1, 2), size=high - low, free=slice(low, high)), [-1])


def test_one_point_that_does_not_settle_is_enough_to_refuse(monkeypatch):
    system = free_row()
    step = np.zeros((system.size, 3))
    step[0] = 1.0
    monkeypatch.setattr(system, "_step", lambda numerators: step)
    with pytest.raises(ComputationError, match="too ill-conditioned"):
        system.completed(np.ones((system.form.offsets[-1], 4)))


def test_a_coordinate_that_is_zero_everywhere_is_no_trouble():
    system = free_row()
    points = np.random.default_rng(3).normal(size=(system.form.offsets[-1], 4))
    points[:, 2:] = 0, 1
    assert (system.completed(points)[:, 2] == 0).all()
