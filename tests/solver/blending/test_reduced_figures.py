"""How exactly the reduced method asks for a proof, and how often it begins anew; what a side needs beside its edge."""

import numpy as np
import pytest

from helpers.bases import facing_pair
from helpers.papers_set import state_problem
from semispline import Base, BSplineSurface, ComputationError, EdgeError
from semispline.solver.blending import reduced
from semispline.solver.blending.shape_parameters import Found
from semispline.solver.blending.sides import make_side
from semispline.solver.blending.warnings import remedy
from semispline.solver.judge import rounding_causes

LINE = [0.0, 0.0, 1.0, 1.0]


@pytest.fixture(scope="module")
def problem():
    return state_problem(*facing_pair(np.random.default_rng(0))).problem


def test_four_centres_are_tried(problem, monkeypatch):
    centres = []
    right = reduced.shape_polynomial

    def off(of, centre):
        centres.append(centre)
        return right(of, centre) * (1 + 1e-6)

    monkeypatch.setattr(reduced, "shape_polynomial", off)
    with pytest.raises(ComputationError, match="is proved only to"):
        reduced.solve_reduced(problem)
    # One to find out where the minimum is.
    assert len(centres) == 1 + 4


def test_the_search_may_leave_a_quarter_of_what_is_promised(problem, monkeypatch):
    asked = []
    right = reduced.least_point

    def told(table, box, tolerance):
        asked.append(tolerance / table[0, 0])
        return right(table, box, tolerance)

    monkeypatch.setattr(reduced, "least_point", told)
    reduced.solve_reduced(problem)
    assert asked == pytest.approx([0.25e-10], rel=1e-12)


@pytest.mark.parametrize(("part", "is_refused"), [(0.9e-10, True), (1.1e-10, False)])
@pytest.mark.parametrize("edge", ["u0", "u1", "v0", "v1"])
def test_a_span_beside_the_edge_of_a_ten_billionth_is_none(part, is_refused, edge):
    across = [0, 0, 0, part * 5, 5, 5, 5] if edge[1] == "0" else [0, 0, 0, 5 - part * 5, 5, 5, 5]
    net = np.array([[[x, y, 0.0] for y in (0, 1)] for x in (0, 1, 2, 3)])
    surface = (
        BSplineSurface(2, 1, across, LINE, net)
        if edge[0] == "u"
        else BSplineSurface(1, 2, LINE, across, net.transpose(1, 0, 2))
    )
    for continuity in ("C1", "G2"):
        if is_refused:
            with pytest.raises(EdgeError, match=f"knots_{edge[0]} leave a span of .* beside the edge"):
                make_side(Base(surface, edge), continuity)
        else:
            assert make_side(Base(surface, edge), continuity).spans[0] == pytest.approx(part * 5, rel=1e-5)
    # For position alone it does not matter.
    assert make_side(Base(surface, edge), "G0").order == 0


@pytest.mark.parametrize(("weights", "columns"), [((1, 1), 3), ((3, 3), 3), ((1, 1 + 1e-12), 4)])
def test_equal_weights_are_none(weights, columns):
    net = np.array([[[x, y, 0.0] for y in (0, 1)] for x in (0, 1)])
    base = Base(BSplineSurface(1, 1, LINE, LINE, net, weights=np.array([weights, weights], dtype=float)), "u0")
    rows = make_side(base, "G1").rows
    assert rows.shape == (3, 2, columns)
    np.testing.assert_allclose(rows[0, :, :3], net[0], atol=1e-11)


@pytest.mark.parametrize(
    ("order", "said"), [(None, "derivatives across the edge"), (1, "across"), (2, "across"), (3, "of order 3")]
)
def test_what_is_said_of_derivatives_that_round(order, said):
    net = np.array([[[x, y, 0.0] for y in (0, 1)] for x in (0, 1)])
    surface = BSplineSurface(1, 1, LINE, LINE, net)
    base = Base(surface, "u0")
    text = remedy(base, rounding_causes(base, base, 2), [], None, *([] if order is None else [order]))
    assert said in text


def test_what_was_found_without_a_search_took_no_iterations():
    assert Found(1.0, 1.0, "linear").iterations == 0


@pytest.mark.parametrize(("slope", "least", "most"), [(1.0, 0.0, 5e-11), (3e-5, 0.0, 5e-11), (3e-7, 1e-10, 1e-8)])
def test_an_energy_counts_as_zero_below_a_million_millionth_of_its_terms(slope, least, most):
    # It goes with the square of the slope; the bound is an eighth of 1e-10 of it below, or of 1e-22 of the terms.
    a, b = (
        BSplineSurface(1, 1, LINE, LINE, [[[x + t, y, s * t * (1 + y)] for y in (0, 1)] for t in (0, 1)])
        for x, s in ((0, 0.0), (3, slope))
    )
    options = {"continuity": "G1", "alpha": "energy", "degree_u": 3, "middle_curves": 0, "v_scale": "length"}
    problem = state_problem(Base(a, "u1"), Base(b, "u0"), **options).problem
    found = reduced.solve_reduced(problem)
    energy = float(problem.energy_products(problem.control_points(found.a, found.b)[None])[0, 0])
    assert least <= (energy - found.certificate.bound) / energy <= most
    assert 0 < found.gap < 5e-11
