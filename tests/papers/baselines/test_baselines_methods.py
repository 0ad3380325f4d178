"""Each rival method by itself: what defines it holds, checked without its own code."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from helpers.papers_set import blend
from semispline import Base, BSplineSurface, SemiStructuredSurface, measure_contact
from semispline.papers.baselines import open_cascade_filling
from semispline.papers.baselines.contacts import contact_sides, on_common_knots, oriented_bases
from semispline.papers.baselines.interface import BlendTask, NotApplicableError
from semispline.papers.baselines.quadratic_forms import THIN_PLATE, TRIHARMONIC, energy_matrix
from semispline.papers.baselines.quintic_hermite import hermite_rows
from semispline.papers.baselines.registry import method, methods
from semispline.papers.baselines.rows_of_least_energy import contact_rule, least_energy
from semispline.papers.baselines.surfaces_from_rows import semistructured_surface, u_basis
from semispline.papers.lin2014 import paper_as_printed
from semispline.papers.lin2014.examples.section5 import example
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines.operations import insert_knots, reverse_u, reverse_v, swap_directions
from semispline.solver.splines.quadrature import Basis


def test_every_method_is_found_once_and_can_be_named():
    found = methods()
    assert len({m.name for m in found}) == len(found) >= 16
    assert [m.place for m in found] == sorted(m.place for m in found)
    assert all(method(m.name) is m for m in found)
    assert all(m.title and m.source for m in found)


# ---------------------------------------------------------------- both bases, turned


@pytest.mark.parametrize("edge", ["u0", "u1", "v0", "v1"])
@pytest.mark.parametrize("against", [False, True])
def test_bases_are_turned_so_that_contact_is_at_u0_and_v_runs_along(edge, against):
    task = example(6)
    b = task.b.surface
    moved = reverse_v(b) if against else b
    moved = reverse_u(moved) if edge[1] == "1" else moved
    moved = swap_directions(moved) if edge[0] == "v" else moved
    turned = oriented_bases(BlendTask("t", "t", task.a, Base(moved, edge)))
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 1, 7)))
    for found, expected in zip(turned, (task.a.surface, b), strict=True):
        np.testing.assert_allclose(surface_points(found, u, v), surface_points(expected, u, v), atol=1e-12)


def test_contact_sides_point_out_of_the_bases():
    for side in contact_sides(example(6)):
        v = np.linspace(0, 1, 9)
        for order in range(3):
            for along in range(3):
                expected = (-1) ** order * surface_points(side.surface, np.zeros_like(v), v, order, along)
                np.testing.assert_allclose(side.derivatives(v, order, along), expected, rtol=0, atol=1e-9)


def test_common_knots_are_the_union_and_change_nothing():
    sides = contact_sides(example(6))
    refined = on_common_knots(*sides)
    inner = sorted([0.15, 0.28, 0.48, 0.55, 0.70, 0.86, 0.22, 0.39, 0.61, 0.76])
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 1, 23)))
    for old, new in zip(sides, refined, strict=True):
        np.testing.assert_array_equal(new.along.knots, [0, 0, 0, 0, *inner, 1, 1, 1, 1])
        np.testing.assert_allclose(surface_points(new.surface, u, v), surface_points(old.surface, u, v), atol=1e-12)


# ---------------------------------------------------------------- the paper as printed


def test_printed_rows_are_the_printed_ones():
    """The relations, typed once more from the text, with the numbers of Fig. 6."""
    a, b = contact_sides(example(6))
    u = u_basis(7)
    first, last, alpha2 = 0.25, 0.75, 1.7
    for side, span, at_end in ((a, first, False), (b, 1 - last, True)):
        R0, R1, R2 = side.surface.control_points[:3]
        width = side.surface.knots_u[4] - side.surface.knots_u[3]
        P1 = alpha2 * span * 3 / (width * 3) * (R0 - R1) + R0
        P2 = alpha2**2 * span * 3 * 2 / (width * 3 * 2) * (R0 - 2 * R1 + R2) + 2 * P1 - R0
        found = paper_as_printed.printed_rule(side, u, at_end=at_end)(alpha2)
        np.testing.assert_allclose(found, np.stack([R0, P1, P2]), rtol=1e-14, atol=1e-12)


def test_printed_rows_scale_the_second_derivative_along_the_normal():
    """Along the normal the blend gets (w_(k_r+1) - w_s) / u_2 times what G2 asks: here 1 / 0.5."""
    b = contact_sides(example(6))[1]
    alpha2, rows = 1.3, [np.zeros((8, 3))] * 4
    rule = paper_as_printed.printed_rule(b, u_basis(7), at_end=True)
    surface = semistructured_surface(u_basis(7), (b.along,) * 7, [*rows, *rule(alpha2)[::-1]])
    v = np.linspace(0, 1, 11)
    normal = np.cross(b.derivatives(v, 1), b.derivatives(v, 0, 1))
    found = np.sum(surface_points(surface, np.ones_like(v), v, 2, 0) * normal, axis=1)
    wanted = alpha2**2 * np.sum(b.derivatives(v, 2) * normal, axis=1)
    assert b.surface.knots_u[5] == 1.0
    np.testing.assert_allclose(found, 2 * wanted, rtol=1e-9)


# ---------------------------------------------------------------- quadratic energies


def random_rows(seed, u, bases):
    rng = np.random.default_rng(seed)
    return semistructured_surface(u, bases, [rng.uniform(-1, 1, (b.size, 3)) for b in bases])


def integral(surface, squares):
    """Gauss quadrature of squared sums of derivatives, by evaluation."""
    x, w = np.polynomial.legendre.leggauss(5)
    axes = []
    for breaks in surface.breakpoints:
        half = np.diff(breaks)[:, None] / 2
        axes.append((((breaks[1:] + breaks[:-1])[:, None] / 2 + half * x).ravel(), (half * w).ravel()))
    (u, wu), (v, wv) = axes
    uu, vv = (z.ravel() for z in np.meshgrid(u, v, indexing="ij"))
    total = 0.0
    for factor, terms in squares:
        values = sum(surface_points(surface, uu, vv, *term) for term in terms)
        total += factor * np.sum(np.multiply.outer(wu, wv).ravel() * np.sum(values**2, axis=1))
    return total


# Written out once more: (11), and |grad Laplace p|^2.
PLATE = [(1, [(2, 0)]), (2, [(1, 1)]), (1, [(0, 2)])]
GRADIENT = [(1, [(3, 0), (1, 2)]), (1, [(2, 1), (0, 3)])]


@pytest.mark.parametrize(("squares", "written"), [(THIN_PLATE, PLATE), (TRIHARMONIC, GRADIENT)])
def test_energy_matrices_are_the_integrals(squares, written):
    u = u_basis(6)
    one, two = Basis(3, np.array([0, 0, 0, 0, 0.3, 0.7, 1, 1, 1, 1])), Basis(4, np.array([0.0] * 5 + [0.55] + [1] * 5))
    bases = (one, one, two, one, two, two)
    surface = random_rows(3, u, bases)
    p = np.concatenate([curve.control_points for curve in surface.control_curves])
    found = np.sum(p * (energy_matrix(u, bases, squares) @ p))
    np.testing.assert_allclose(found, integral(surface, written), rtol=1e-11)


def test_third_derivatives_that_are_none_are_refused():
    double = Basis(3, np.array([0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1]))
    with pytest.raises(NotApplicableError, match="v-knots: an inner knot leaves C1"):
        energy_matrix(u_basis(6), (double,) * 6, TRIHARMONIC)
    task = example(8)
    creased = insert_knots(task.a.surface, knots_v=[0.3])
    with pytest.raises(NotApplicableError, match="C1"):
        method("triharmonic").run(BlendTask("t", "t", Base(creased, "u0"), task.b))


@pytest.mark.parametrize(("name", "written", "free"), [("triharmonic", GRADIENT, 3), ("thin-plate-refined", PLATE, 3)])
@pytest.mark.parametrize("figure", [8, 10])
def test_free_rows_are_stationary(name, written, free, figure):
    """A random change of the free rows has no first-order effect on the integral, and a positive second-order one."""
    task = example(figure)
    surface = method(name).run(task).surface
    assert isinstance(surface, BSplineSurface)
    rng = np.random.default_rng(figure)
    change = np.zeros_like(surface.control_points)
    change[free:-free] = rng.uniform(-1, 1, change[free:-free].shape)
    if task.closed:
        # Only control points that take no part in the seam: all changes of these are closed and C2.
        change[:, :3] = 0
        change[:, -3:] = 0
    energies = []
    for step in (-1.0, 0.0, 1.0):
        energies.append(
            integral(
                BSplineSurface(3, 3, surface.knots_u, surface.knots_v, surface.control_points + step * change), written
            )
        )
    low, middle, high = energies
    assert low > middle < high
    assert abs(high - low) < 1e-7 * (high + low - 2 * middle) + 1e-9 * middle


def test_least_energy_agrees_with_the_proved_minimum():
    """Another search, another assembly, the same rows of knots."""
    task = example(6)
    proved = blend(task.a, task.b, continuity="G2", middle_curves=1)
    u = Basis(3, proved.surface.knots_u)
    bases = [Basis(c.degree, c.knots) for c in proved.surface.control_curves]
    a, b = contact_sides(task)
    rules = contact_rule(a, 2, u), contact_rule(b, 2, u)
    found = least_energy(energy_matrix(u, bases, THIN_PLATE), bases, rules, (a.bounds, b.bounds))
    np.testing.assert_allclose(found.energy, proved.energy, rtol=1e-10)
    np.testing.assert_allclose([found.a, found.b], [proved.alpha2, proved.beta2], rtol=1e-6)
    for row, curve in zip(found.rows, proved.surface.control_curves, strict=True):
        np.testing.assert_allclose(row, curve.control_points, atol=1e-4)


def test_least_energy_finds_the_lower_of_two_minima():
    """A quartic in alpha^2 alone with two valleys: the one with fewer points of the grid is the lower one."""
    basis = Basis(1, np.array([0.0, 0, 1, 1]))

    def rule(a):
        # One row; x = (a - 0.2)(a - 3), y = 0.3 (a - 3): the valley at 3 is the lower one.
        return np.array([[[(a - 0.2) * (a - 3), 0.3 * (a - 3), 0.0]] * 2])

    still = lambda _: np.zeros((1, 2, 3))
    matrix = energy_matrix(Basis(1, np.array([0.0, 0, 1, 1])), (basis, basis), [(1.0, ((0, 0),))])
    found = least_energy(matrix, (basis, basis), (rule, still), ((0.1, 8.0), (1.0, 1.0)))
    np.testing.assert_allclose(found.a, 3, rtol=1e-6)


# ---------------------------------------------------------------- quintic Hermite


def test_hermite_rows_are_those_of_a_quintic():
    rng = np.random.default_rng(2)
    R, T, A = rng.uniform(-1, 1, (3, 4, 3))
    rows = hermite_rows(np.stack([R, T, A]), 1.7)
    knots = np.repeat([0.0, 1.0], 6)
    along = np.repeat([0.0, 1.0], 4)
    surface = BSplineSurface(5, 3, knots, along, np.concatenate([rows, np.zeros((3, 4, 3))]))
    v = np.linspace(0, 1, 5)
    for order, wanted in enumerate((R, 1.7 * T, 1.7**2 * A)):
        expected = surface_points(BSplineSurface(1, 3, [0, 0, 1, 1], along, np.stack([wanted] * 2)), 0 * v, v)
        np.testing.assert_allclose(surface_points(surface, 0 * v, v, order, 0), expected, atol=1e-13)


# ---------------------------------------------------------------- same knots


@pytest.mark.parametrize("figure", [10, 11])
def test_without_middle_curves_the_same_knots_give_the_same_surface(figure):
    """All rows of a G2 blend are prescribed then: the semi-structured form saves control points and changes nothing."""
    task = example(figure)
    rival = method("same-knots-g2").run(task)
    ours = method("semistructured-reduced").run(task)
    assert isinstance(ours.surface, SemiStructuredSurface)
    assert rival.control_points > 1.5 * ours.control_points
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 31)))
    # alpha and beta come from two searches.
    difference = surface_points(rival.surface, u, v) - surface_points(ours.surface, u, v)
    assert np.abs(difference).max() < 1e-5


def test_free_rows_of_closed_blends_close_c2():
    surface = method("same-knots-g1").run(example(10)).surface
    u = np.linspace(0, 1, 9)
    for order in range(3):
        ends = [surface_points(surface, u, np.full_like(u, v), 0, order) for v in (0.0, 1.0)]
        np.testing.assert_allclose(*ends, rtol=0, atol=1e-9 * np.abs(ends[0]).max())


# ---------------------------------------------------------------- programs


def test_a_filling_keeps_near_to_its_four_edges():
    task = example(6)
    surface = method("open-cascade-filling").run(task).surface
    a, b = contact_sides(task)
    v, u = np.linspace(0, 1, 21), np.linspace(0, 1, 21)
    for end, side in enumerate((a, b)):
        assert np.linalg.norm(surface.evaluate(0 * v + end, v) - side.derivatives(v, 0), axis=1).max() < 0.05
    for end, curve in zip((0.0, 1.0), open_cascade_filling.side_curves(a, b), strict=True):
        # The side edges as cubic Bezier curves, by the referee.
        edge = BSplineSurface(3, 1, np.repeat([0.0, 1], 4), [0, 0, 1, 1], np.stack([curve, curve], axis=1))
        wanted = surface_points(edge, u, 0 * u)
        np.testing.assert_allclose(surface.evaluate(u, 0 * u + end), wanted, atol=0.05)
        # They leave both bases tangentially.
        v_end = np.array([end])
        np.testing.assert_allclose(
            surface_points(edge, [0], [0], 1)[0], a.natural * a.derivatives(v_end, 1)[0], atol=1e-9
        )
        np.testing.assert_allclose(
            surface_points(edge, [1], [0], 1)[0], -b.natural * b.derivatives(v_end, 1)[0], atol=1e-9
        )


def test_closest_parameters():
    surface = example(6).b.surface
    rng = np.random.default_rng(5)
    u, v = rng.uniform(0.1, 0.9, (2, 30))
    normal = np.cross(surface_points(surface, u, v, 1, 0), surface_points(surface, u, v, 0, 1))
    points = surface_points(surface, u, v) + 0.5 * normal / np.linalg.norm(normal, axis=1)[:, None]
    np.testing.assert_allclose(open_cascade_filling.closest_parameters(surface, points), np.stack([u, v], 1), atol=1e-8)


def test_what_cannot_be_used_says_why(monkeypatch):
    with pytest.raises(NotApplicableError, match="closed"):
        method("open-cascade-filling").run(example(10))
    monkeypatch.setitem(sys.modules, "smlibpy", None)
    with pytest.raises(NotApplicableError, match=r"pip install 'semispline\[bench\]'"):
        method("smlibpy").run(example(6))


def test_smlibpy_meets_open_contacts():
    pytest.importorskip("smlibpy")
    task = example(6)
    surface = method("smlibpy").run(task).surface
    assert isinstance(surface, BSplineSurface)
    found = measure_contact(Base(task.a.surface, "u0"), Base(surface, "u0"))
    assert found.gap < 1e-9
    assert found.angle_degrees < 0.01
