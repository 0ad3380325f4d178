"""Section 5 run with every method: which contact each reaches, and the numbers that the report states."""

from __future__ import annotations

import importlib.util
import json

import numpy as np
import pytest

from helpers.sweeps import first_ones
from semispline import blend
from semispline.papers.baselines.registry import method, methods
from semispline.papers.lin2014.examples.section5 import FIGURES, example
from semispline.papers.lin2014.paper_as_printed import METHODS
from semispline.papers.reproduction.comparison import compare, run

# Energy (11), integral of k1^2 + k2^2, control points. Recorded from this code; what they must satisfy among each
# other is asserted below.
NUMBERS = {
    5: {
        "paper-as-printed": (165598.3, 7.44652, 38),
        "paper-corrected": (23921.77, 1.42468, 38),
        "semistructured-reduced": (21248.79, 1.48241, 38),
        "semistructured-casadi": (21248.79, 1.48241, 38),
        "semistructured-bfgs": (21248.79, 1.48241, 38),
        "same-knots-g1": (15985.94, 1.2333, 49),
        "same-knots-g2": (21232.15, 1.48246, 49),
        "quintic-hermite": (20785.53, 1.42545, 33),
        "quintic-hermite-least": (20523.61, 1.48406, 33),
        "hartmann-inside": (972704.8, None, None),
        "hartmann-extended": (71267.92, 4.48572, None),
        "triharmonic": (23118.6, 1.63016, 77),
        "thin-plate-refined": (18232.24, 1.3352, 77),
    },
    6: {
        "paper-as-printed": (144098.8, 9.61237, 63),
        "paper-corrected": (68269.92, 5.47322, 63),
        "semistructured-reduced": (68269.92, 5.47321, 63),
        "semistructured-casadi": (68269.92, 5.47321, 63),
        "semistructured-bfgs": (68269.92, 5.47322, 63),
        "same-knots-g1": (45748.27, 4.20858, 98),
        "same-knots-g2": (68234.31, 5.47178, 98),
        "quintic-hermite": (72058.05, 5.17659, 54),
        "quintic-hermite-least": (70530.78, 4.98543, 54),
        "hartmann-inside": (953161.8, None, None),
        "hartmann-extended": (143009.8, 12.3013, None),
        "triharmonic": (83227.42, 5.78069, 154),
        "thin-plate-refined": (55096.99, 4.61864, 154),
    },
    8: {
        "paper-as-printed": (148375.2, 5.70751, 38),
        "paper-corrected": (56274.85, 6.40522, 38),
        "semistructured-reduced": (55741.52, 6.23696, 38),
        "semistructured-casadi": (55741.52, 6.23696, 38),
        "semistructured-bfgs": (55741.52, 6.23696, 38),
        "same-knots-g1": (42159.42, 5.02957, 49),
        "same-knots-g2": (54913.29, 6.07703, 49),
        "quintic-hermite": (61414.02, 7.37661, 33),
        "quintic-hermite-least": (61329.09, 7.34093, 33),
        "hartmann-inside": (745976.4, None, None),
        "hartmann-extended": (77221.16, 8.62242, None),
        "triharmonic": (65467.42, 6.47777, 77),
        "thin-plate-refined": (46934.9, 5.43799, 77),
    },
    9: {
        "paper-as-printed": (202741.8, 11.2186, 38),
        "paper-corrected": (73412.93, 7.78729, 38),
        "semistructured-reduced": (65669.63, 8.252, 38),
        "semistructured-casadi": (65669.63, 8.252, 38),
        "semistructured-bfgs": (65669.63, 8.252, 38),
        "same-knots-g1": (50082.64, 6.45806, 49),
        "same-knots-g2": (64881.72, 8.13531, 49),
        "quintic-hermite": (71196.28, 8.84676, 33),
        "quintic-hermite-least": (70744.43, 9.00269, 33),
        "hartmann-inside": (990305.6, None, None),
        "hartmann-extended": (112117.8, 10.8455, None),
        "triharmonic": (69937.07, 8.11291, 77),
        "thin-plate-refined": (55934.15, 6.98045, 77),
    },
    10: {
        "paper-as-printed": (1864018, 20.09, 54),
        "paper-corrected": (1777405, 21.0218, 54),
        "semistructured-reduced": (1777405, 21.0218, 54),
        "semistructured-casadi": (1777405, 21.0218, 54),
        "semistructured-bfgs": (1777405, 21.0218, 54),
        "same-knots-g1": (1144779, 49.3767, 84),
        "same-knots-g2": (1777405, 21.0218, 84),
        "quintic-hermite": (1755878, 18.8463, 54),
        "quintic-hermite-least": (1755829, 19.0339, 54),
        "hartmann-inside": (2628942, None, None),
        "hartmann-extended": (1832638, 35.6538, None),
        "bloor-wilson-4": (1606722, 19.3637, None),
        "bloor-wilson-6": (1745699, 18.7761, None),
        "triharmonic": (1435085, 28.3727, 154),
        "thin-plate-refined": (1270325, 45.4199, 154),
    },
    11: {
        "paper-as-printed": (554336.5, 13.4946, 222),
        "paper-corrected": (530795.8, 15.7146, 222),
        "semistructured-reduced": (530795.8, 15.7146, 222),
        "semistructured-casadi": (530795.8, 15.7146, 222),
        "semistructured-bfgs": (530795.8, 15.7146, 222),
        "same-knots-g1": (256622.8, 10.1212, 420),
        "same-knots-g2": (530795.8, 15.7146, 420),
        "quintic-hermite": (517884.1, 17.1063, 222),
        "quintic-hermite-least": (513264.7, 14.4287, 222),
        "hartmann-inside": (1056526, None, None),
        "hartmann-extended": (582509.9, 25.5086, None),
        "triharmonic": (388495.1, 15.1266, 770),
        "thin-plate-refined": (261280.4, 10.4726, 770),
    },
}
# Methods of other packages: their numbers may change with them.
PROGRAMS = ("open-cascade-filling", "smlibpy")
# On folded surfaces curvature has no bound, and samples of it no meaning.
FOLDED = ("hartmann-inside",)
G2 = (
    "semistructured-fair", "semistructured-reduced", "semistructured-casadi", "semistructured-bfgs", "same-knots-g2",
    "quintic-hermite", "quintic-hermite-least", "hartmann-extended", "bloor-wilson-6", "triharmonic",
    "thin-plate-refined",
)  # fmt: skip
G1 = ("same-knots-g1", "bloor-wilson-4")
# Figures 8 and 9 ask for C2 and are as large as figure 5; figure 11 takes as long as the three others together, and is
# curved across at one edge, as figure 6.
QUICK = (5, 6, 10)
EACH_FIGURE = [pytest.param(f, marks=[] if f in QUICK else pytest.mark.slow) for f in FIGURES]


@pytest.fixture(scope="module")
def compared():
    """Each example's comparison, made when it is first asked for."""
    made = {}

    def get(figure):
        if figure not in made:
            task = example(figure)
            chosen = [m for m in methods(METHODS) if m.name not in PROGRAMS]
            made[figure] = {m.name: run(task, m) for m in chosen}
        return made[figure]

    return get


@pytest.mark.parametrize("figure", first_ones(1, FIGURES))
def test_numbers_and_contact(figure, compared):
    rows = compared(figure)
    reasons = {name for name, row in rows.items() if row.reason}
    assert reasons == (set() if figure == 10 else {"bloor-wilson-4", "bloor-wilson-6"})
    size = max(float(np.ptp(b.surface.control_points, axis=(0, 1)).max()) for b in (rows["triharmonic"].task.a,))
    for name, (energy, bending, points) in NUMBERS[figure].items():
        found = rows[name].measures
        # The paper's search stops where its finite differences do: its energy is good to some 1e-6.
        np.testing.assert_allclose(found.energy, energy, rtol=1e-5, err_msg=name)
        assert found.control_points == points, name
        if bending is None:
            assert found.bending is None, name
        else:
            np.testing.assert_allclose(found.bending, bending, rtol=1e-4, err_msg=name)
        # Every contact is exact in position.
        assert found.gap < 1e-12 * size, name
        assert found.folds == (name in FOLDED), name
    for name in G2:
        found = rows[name].measures
        if found is not None:
            assert found.angle_degrees < 1e-9, name
            assert found.curvature_jump_relative < 1e-8, name
    for name in G1:
        found = rows[name].measures
        if found is not None:
            assert found.angle_degrees < 1e-9, name
            assert found.curvature_jump_relative > 0.1, name
    for row in rows.values():
        if figure == 10 and row.measures is not None:
            assert row.measures.seam.gap < 1e-12 * size
            assert row.measures.seam.angle_degrees < 1e-9
            assert row.measures.seam.curvature_jump < 1e-10


@pytest.mark.long
@pytest.mark.parametrize("figure", EACH_FIGURE)
def test_printed_rows_keep_g2_only_where_bases_are_straight_across(figure, compared):
    rows = compared(figure)
    printed, corrected = rows["paper-as-printed"].measures, rows["paper-corrected"].measures
    assert printed.gap == corrected.gap == 0
    assert max(printed.angle_degrees, corrected.angle_degrees) < 1e-9
    # A plane, a cylinder and a cone are straight across; the curved shell and the collar are not.
    jumps = [m.curvature_jump_relative for m in (printed.contact_a, printed.contact_b)]
    assert jumps[0] < 1e-8
    assert (jumps[1] > 0.2) == (figure in (6, 11))
    assert corrected.curvature_jump_relative < 1e-8
    if example(figure).continuity == "C2":
        # What is left of C2: nothing. The corrected rows have it.
        assert min(printed.contact_a.c2_residual, printed.contact_b.c2_residual) > 0.9
        assert max(corrected.contact_a.c2_residual, corrected.contact_b.c2_residual) < 1e-10
    # And the printed rows cost energy.
    assert printed.energy > 1.04 * corrected.energy


@pytest.mark.parametrize("figure", EACH_FIGURE)
def test_least_energy_is_least(figure, compared):
    rows = compared(figure)
    energy = {name: row.measures.energy for name, row in rows.items() if row.measures is not None}
    reduced = energy["semistructured-reduced"]
    for name in ("semistructured-casadi", "semistructured-bfgs", "paper-corrected"):
        assert energy[name] >= reduced * (1 - 1e-9), name
    np.testing.assert_allclose(energy["semistructured-casadi"], reduced, rtol=1e-8)
    # The union of knots saves little energy, or none, and takes many more control points.
    rival = energy["same-knots-g2"]
    assert reduced * (1 - 0.016) < rival < reduced * (1 + 1e-9)
    ours, theirs = (rows[name].measures.control_points for name in ("semistructured-reduced", "same-knots-g2"))
    assert theirs > 1.25 * ours
    # Tangent contact costs less than curvature contact, more rows less than fewer.
    assert energy["same-knots-g1"] < rival
    assert energy["thin-plate-refined"] < energy["triharmonic"]
    assert energy["quintic-hermite-least"] <= energy["quintic-hermite"]


@pytest.mark.long
@pytest.mark.parametrize("figure", EACH_FIGURE)
def test_the_fairest_blend_is_fairer_than_each_of_the_papers_with_a_middle_curve_more_at_most(figure, compared):
    rows = {name: row.measures for name, row in compared(figure).items() if row.measures is not None}
    fair = rows["semistructured-fair"]
    for name in ("paper-corrected", "semistructured-c2", "semistructured-reduced"):
        assert fair.fairness < 0.75 * rows[name].fairness, name
        # The figures have none themselves: six rows may become seven.
        assert fair.control_points <= 7 / 6 * rows[name].control_points, name
    assert fair.turn_degrees < 7
    # A cubic of as many rows has the least energy of all cubics, and about that of all quintics.
    least = rows["semistructured-reduced"]
    if fair.control_points > least.control_points:
        task = example(figure)
        least = blend(task.a, task.b, alpha="energy", middle_curves=task.middle_curves + 1)
    assert fair.energy >= least.energy * 0.98


def test_where_rivals_are_better(compared, whole):
    """Findings against our method: they must not be lost when numbers change."""
    for figure, wins in ((5, True), (6, False), (8, False), (9, False), (10, True), (11, True)):
        if figure not in QUICK and not whole:
            continue
        rows = compared(figure)
        quintic, reduced = (rows[n].measures for n in ("quintic-hermite-least", "semistructured-reduced"))
        assert (quintic.energy < reduced.energy) == wins, figure
        assert quintic.control_points <= reduced.control_points
    tubes = compared(10)
    assert tubes["bloor-wilson-6"].measures.energy < tubes["semistructured-reduced"].measures.energy
    assert tubes["bloor-wilson-6"].measures.bending < 0.9 * tubes["semistructured-reduced"].measures.bending


@pytest.mark.long
def test_numbers_are_the_same_from_run_to_run(compared):
    task = example(5)
    for name, row in compared(5).items():
        again = run(task, {m.name: m for m in methods(METHODS)}[name])
        one, two = (json.dumps({k: v for k, v in r.record().items() if k != "seconds"}) for r in (row, again))
        assert one == two, name


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("OCP") is None, reason="the extra cad is not installed")
@pytest.mark.parametrize(
    ("figure", "gap", "angle"), [(6, 0.01, 0.5), pytest.param(11, 0.5, 6.0, marks=pytest.mark.slow)]
)
def test_a_filling_is_rough(figure, gap, angle):
    found = run(example(figure), method("open-cascade-filling")).measures
    assert 1e-5 < found.gap < gap
    assert 1e-2 < found.angle_degrees < angle
    assert found.curvature_jump_relative > 0.5
    assert found.control_points == 529


@pytest.mark.long
@pytest.mark.parametrize(("figure", "least"), [(6, 400), (10, 1000)])
def test_smlibpy_is_accurate_but_large(figure, least):
    pytest.importorskip("smlibpy")
    found = run(example(figure), method("smlibpy")).measures
    assert found.gap < 1e-4
    assert found.angle_degrees < 0.01
    assert found.control_points > least


def test_a_method_that_cannot_be_used_leaves_its_reason():
    (row,) = compare(example(6), [method("bloor-wilson-4")])
    assert row.outcome is None
    assert row.record() == {
        "example": "figure-6",
        "method": "bloor-wilson-4",
        "title": "Bloor-Wilson, fourth order",
        "reason": row.reason,
    }
    assert "open" in row.reason
