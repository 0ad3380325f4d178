"""Figs. 10 and 11 with exact surfaces: the bases are exact, and what the study says of their blends is so."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from semispline import blend, closest_point
from semispline.papers.baselines.contacts import contact_sides
from semispline.papers.baselines.interface import NotApplicableError
from semispline.papers.baselines.registry import methods
from semispline.papers.lin2014.checks.exact_blends import blended, exact_contact
from semispline.papers.lin2014.exact_surfaces import exact_findings, exact_tables
from semispline.papers.lin2014.examples.exact import exact_example
from semispline.papers.lin2014.examples.section5 import example
from semispline.papers.lin2014.findings import findings
from semispline.papers.lin2014.paper_as_printed import METHODS as PRINTED_METHODS
from semispline.papers.report.table_text import cell
from semispline.papers.reproduction.comparison import run
from semispline.papers.reproduction.measures import reached
from semispline.solver.judge.de_boor import surface_points

STORED = (Path(__file__).parents[3] / "papers" / "lin2014" / "RECORDS.md").read_text(encoding="utf-8")
ASKED = {
    "least energy, no middle curve, as the figure": {
        "continuity": "G2", "alpha": "energy", "middle_curves": 0, "degree_u": 3, "v_scale": "paper",
    },
    "least energy, one middle curve": {
        "continuity": "G2", "alpha": "energy", "middle_curves": 1, "degree_u": 3, "v_scale": "paper",
    },
    "fairest shape (the default)": {},
}  # fmt: skip


def circles(surface):
    """Points of a surface and their circle: squared distance from the axis over the squared radius there."""
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 1, 40)))
    return surface_points(surface, u, v), u


@pytest.mark.parametrize("circle", ["arcs", "smooth"])
def test_bases_are_exact_and_stand_where_the_stand_ins_do(circle):
    task = exact_example(10, circle)
    points, _ = circles(task.a.surface)
    np.testing.assert_allclose(np.hypot(points[:, 1], points[:, 2]), 40, rtol=1e-14)
    # The second one: its axis runs from (75, 0, 30), 40 degrees upwards.
    points, _ = circles(task.b.surface)
    axis = np.array([np.cos(np.radians(40)), 0, np.sin(np.radians(40))])
    np.testing.assert_allclose(np.linalg.norm(np.cross(points - [75, 0, 30], axis), axis=1), 26, rtol=1e-13)
    cone, _ = circles(exact_example(11, circle).a.surface)
    np.testing.assert_allclose(np.hypot(cone[:, 1], cone[:, 2]), 34 - 26 * cone[:, 0] / 70, rtol=1e-13)
    for figure in (10, 11):
        for name in ("a", "b"):
            true, other = (getattr(made(figure), name).surface for made in (exact_example, example))
            first, second = (surface_points(s, np.zeros(9), np.linspace(0, 1, 9)) for s in (true, other))
            assert np.linalg.norm(first - second, axis=1).max() < 0.35
    assert exact_example(10, circle).closed


def test_stand_ins_are_not():
    points, _ = circles(example(10).a.surface)
    assert 1e-4 < np.ptp(np.hypot(points[:, 1], points[:, 2])) / 40 < 0.012


def test_another_figure_is_refused():
    with pytest.raises(ValueError, match="found 9"):
        exact_example(9)


# ---------------------------------------------------------------- what the study says


def stubs(*figures):
    """Comparisons of which only the names and the reasons count."""
    used, refused = SimpleNamespace(outcome=1, reason=""), SimpleNamespace(outcome=None, reason="polynomial only")
    return {f"figure-{figure}-exact": [used, refused, refused] for figure in figures}


@pytest.fixture(scope="module")
def table():
    (made,) = exact_tables(stubs(10, 11))
    return made


def energy_by_hand(surface, n=14):
    """(11) over the blend's own parameters, by Gauss and de Boor."""
    x, w = np.polynomial.legendre.leggauss(n)
    axes = []
    for breaks in surface.breakpoints:
        half = np.diff(breaks)[:, None] / 2
        axes.append((((breaks[:-1, None] + breaks[1:, None]) / 2 + half * x).ravel(), (half * w).ravel()))
    (u, wu), (v, wv) = axes
    uu, vv = (g.ravel() for g in np.meshgrid(u, v, indexing="ij"))
    total = sum(
        factor * np.sum(surface_points(surface, uu, vv, du, dv) ** 2, axis=1)
        for factor, du, dv in ((1, 2, 0), (2, 1, 1), (1, 0, 2))
    )
    return float(np.outer(wu, wv).ravel() @ total)


@pytest.mark.long
@pytest.mark.parametrize("figure", [10, 11])
@pytest.mark.parametrize("choice", ASKED)
def test_the_table_is_what_a_fresh_computation_gives(figure, choice, table):
    task = exact_example(figure)
    fresh = blend(task.a, task.b, **ASKED[choice])
    (row,) = (r for r in table.rows if r[:3] == (f"Fig. {figure}", choice, "exact, in arcs"))
    said = dict(zip(table.head, row, strict=True))
    curves = fresh.surface.control_curves
    assert said["control points"] == str(sum(len(c.control_points) for c in curves))
    assert said["converted"] == str(np.size(fresh.surface.to_bspline().control_points) // 3)
    assert (said["α²"], said["β²"]) == (cell(fresh.alpha2), cell(fresh.beta2))
    energy = energy_by_hand(fresh.surface)
    error = float(said["quadrature error / energy"])
    np.testing.assert_allclose(fresh.energy, energy, rtol=max(error, 1e-11))
    np.testing.assert_allclose(float(said["energy (11)"]), energy, rtol=1e-3)
    np.testing.assert_allclose(float(said["fairness"]), fresh.shape.fairness.value, rtol=1e-3)
    assert float(said["gap"]) < 1e-12
    assert max(float(said["angle [°]"]), float(said["curvature jump"])) < 1e-9
    # Both cylinders have the same arcs, so that nothing is cured unless a free row comes between; the collar has none.
    cured = figure == 11 or "one middle" in choice
    assert said["cure"].startswith("circle reparametrised, degree 6") == cured
    assert said["cure"].endswith(" / –") == (figure == 11)
    assert said["weights"].startswith(f"mean, degree {6 if cured else 2}, ratio ")
    assert said["inside"] == ("no such line" if cured else "no crease, no jump (3 lines)")
    ratio = max(np.ptp(np.log(c.weights)) for c in curves if c.weights is not None)
    found = float(re.match(r".*?ratio ([\d.]+)", said["weights"]).group(1))
    np.testing.assert_allclose(found, np.exp(ratio), rtol=0.01)


def test_the_table_has_stand_ins_beside_exact_surfaces(table):
    assert len(table.rows) == 2 * 3 * 3
    for figure in (10, 11):
        task = example(figure)
        fresh = blend(task.a, task.b, **ASKED["least energy, no middle curve, as the figure"])
        (row,) = (r for r in table.rows if r[0] == f"Fig. {figure}" and "no middle" in r[1] and r[2] == "stand-ins")
        said = dict(zip(table.head, row, strict=True))
        assert said["energy (11)"] == cell(fresh.energy)
        assert said["quadrature error / energy"] == said["weights"] == said["cure"] == "–"
    assert exact_tables(stubs()) == ()


def test_two_ways_to_run_through_the_circles_are_one_blend_with_two_energies():
    choice = "least energy, no middle curve, as the figure"
    arcs, smooth = (blended(10, choice, f"exact, {how}").result for how in ("in arcs", "smooth circle"))
    assert arcs.alpha2 == pytest.approx(smooth.alpha2, rel=1e-8)
    u, v = np.array([0.1, 0.35, 0.6, 0.9]), np.array([0.07, 0.4, 0.63, 0.95])
    for point in surface_points(arcs.surface, u, v):
        assert np.linalg.norm(np.ravel(closest_point(smooth.surface, point).points[0]) - point) < 1e-9
    assert 1.04 < arcs.energy / smooth.energy < 1.06


def test_the_finding_says_what_the_blends_have_and_stands_in_the_report():
    (found,) = exact_findings(stubs(10, 11))
    assert "in 12 of 12 blends" in found.short
    assert f"**{found.short}.**" in STORED
    rivals = found.detail.index(" Of 3 methods 1 can be used")
    assert found.detail[:rivals] in STORED
    assert "2 take polynomial bases only" in found.detail[rivals:]
    before, after = (
        blend(t.a, t.b, continuity="G2", alpha="energy", middle_curves=0) for t in (example(10), exact_example(10))
    )
    change = 100 * (energy_by_hand(after.surface) / energy_by_hand(before.surface) - 1)
    assert f"(11) from {before.energy:.4g} to {after.energy:.4g}, {change:+.2g} %" in found.detail
    assert f"converted from {before.rows_converted} to {after.rows_converted}" in found.detail
    assert not list(exact_findings({"figure-10": []}))


@pytest.mark.long
def test_exact_examples_do_not_enter_the_counts_of_the_others():
    comparisons = {"figure-6": [run(example(6), m) for m in methods() if m.name == "paper-corrected"]}
    alone = findings(comparisons)
    # One that would miss its contact and raise every count.
    both = findings(comparisons | {"figure-10-exact": comparisons["figure-6"]})
    assert [f for f in both if not f.short.startswith("With exact")] == list(alone)


def test_records_measure_exact_cylinders():
    found = exact_contact(10, "Exact cylinders")
    assert max(found.measured.values()) < 1e-9
    assert set(found.measured) >= {"gap", "relative curvature jump", "crease inside [degrees]"}


# ---------------------------------------------------------------- methods on rational bases


def test_contact_sides_of_rational_bases_point_out_of_them():
    for side in contact_sides(exact_example(11)):
        v = np.linspace(0, 1, 9)
        for order in range(3):
            for along in range(3):
                expected = (-1) ** order * surface_points(side.surface, np.zeros_like(v), v, order, along)
                np.testing.assert_allclose(side.derivatives(v, order, along), expected, rtol=1e-9, atol=1e-8)
    with pytest.raises(NotApplicableError, match="polynomial"):
        _ = contact_sides(exact_example(11))[0].outwards


POLYNOMIAL = {
    "paper-as-printed", "paper-corrected", "semistructured-casadi", "semistructured-bfgs", "same-knots-g1",
    "same-knots-g2", "quintic-hermite", "triharmonic", "thin-plate-refined",
}  # fmt: skip


@pytest.mark.long
def test_methods_for_polynomial_bases_say_so():
    refused = {}
    for method in methods(PRINTED_METHODS):
        if method.name in ("open-cascade-filling", "smlibpy"):
            continue
        try:
            method.run(exact_example(10))
        except NotApplicableError as error:
            refused[method.name] = str(error)
    assert set(refused) == POLYNOMIAL
    assert all("takes polynomial B-spline surfaces only" in reason for reason in refused.values())


@pytest.mark.long
@pytest.mark.parametrize("name", ["semistructured-reduced", "quintic-hermite-least"])
def test_cured_blends_are_measured_at_foot_points(name):
    (method,) = (m for m in methods() if m.name == name)
    found = run(exact_example(11), method)
    assert not found.outcome.aligned
    assert reached(found.task, found.measures) == "G2"
    assert found.measures.contact_a.turn_degrees < 1e-9
    assert found.measures.energy == pytest.approx(energy_by_hand(found.outcome.surface), rel=1e-9)
