"""Rungs of the ladder: the same surface on each, positive weights over the whole window, smooth inside."""

from math import comb

import numpy as np
import pytest
from scipy.interpolate import BPoly

from helpers.bases import random_knots
from helpers.knot_lines import least_continuity
from semispline.solver.blending import ladder
from semispline.solver.blending.ladder import Window, power_jets, tamed, weight_range
from semispline.solver.blending.weights import normalised_rows
from semispline.solver.generated import contact_numpy, rows_numpy
from semispline.solver.splines import Basis, basis_matrix, clamped, uniform_knots

SPANS = (0.8, 1.0, 1.3, 1.3)
V = np.linspace(0.003, 0.997, 41)


def base(rng, order, spread, *, degree=3, closed=False, separable=False):
    along = Basis(degree, random_knots(rng, degree, degree + 3))
    weights = np.exp(rng.uniform(-spread, spread, (order + 1, along.size)))
    if separable:
        weights = np.outer(np.exp(rng.uniform(-spread, spread, order + 1)), weights[0])
    v = np.linspace(0, 1, along.size)
    points = np.stack(
        [np.tile(np.arange(order + 1) / 4, (along.size, 1)).T, np.tile(v, (order + 1, 1)), 0 * weights], axis=-1
    )
    points += rng.uniform(-0.1, 0.1, points.shape)
    rows = np.concatenate([points * weights[..., None], weights[..., None]], axis=-1)
    if closed:
        along = Basis(degree, uniform_knots(degree, along.size - degree))
        rows[:, -1] = rows[:, 0]
        rows[:, -2] = 2 * rows[:, 0] - rows[:, 1]
        # The second derivative at both ends of a uniform cubic.
        rows[:, -3] = rows[:, 2] + 3 * (rows[:, -2] - rows[:, 1])
    return rows, along


def quotient_jets(rows, along, degree, v=V):
    """Derivatives across of X / om at the edge, shape (order + 1, V, 3)."""
    order = len(rows) - 1
    matrix = getattr(contact_numpy, f"end_derivatives_{order}")(degree, *SPANS[:order])
    values = np.array([basis_matrix(along.degree, along.knots, v) @ row for row in rows])
    jets = np.einsum("dk,kvc->dvc", matrix, values)
    known = []
    for k in range(order + 1):
        rest = sum((comb(k, j) * jets[j, :, 3:] * known[k - j] for j in range(1, k + 1)), 0.0)
        known.append((jets[k, :, :3] - rest) / jets[0, :, 3:])
    return np.array(known)


def contact_rows(rows, degree, a, blend_degree, spans, p2=0.0):
    """Rows of a blend by the chain rule, written out from the generated tables."""
    order = len(rows) - 1
    monomials = getattr(rows_numpy, f"chain_monomials_{order}")()
    tables = getattr(rows_numpy, f"chain_table_{order}")().reshape(-1, order + 1, order + 1)
    chain = sum(a**i * p2**j * table for (i, j), table in zip(monomials, tables, strict=True))
    inverse = np.linalg.inv(getattr(contact_numpy, f"end_derivatives_{order}")(blend_degree, *spans[:order]))
    matrix = inverse @ chain @ getattr(contact_numpy, f"end_derivatives_{order}")(degree, *SPANS[:order])
    return np.einsum("ij,jnc->inc", matrix, rows)


# Rung, spread of the weights, largest alpha^2.
CASES = [("mean", 0.2, 0.3), ("fitted", 0.3, 2.5), ("om^(n+1)", 0.8, 6.0)]


def on_rung(name, order, seed=0, closed=False, **options):
    spread, most = next((s, a) for n, s, a in CASES if n == name)
    for attempt in range(40):
        rng = np.random.default_rng(100 * seed + attempt)
        rows, along = base(rng, order, spread, closed=closed, **options)
        window = Window((most / 10, most))
        found = tamed(
            rows,
            along,
            3,
            SPANS,
            order=len(rows) - 1,
            blend_degree=2 * order + 1,
            blend_spans=SPANS,
            window=window,
            closed=closed,
        )
        if found.rung.name == name:
            return rows, along, found, window
    raise AssertionError("no such base")


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("name", [name for name, _, _ in CASES])
def test_the_surface_stays_and_its_weights_are_positive(name, order):
    rows, along, found, window = on_rung(name, order)
    expected = quotient_jets(rows, along, 3)
    jets = quotient_jets(found.rows, found.along, found.degree)
    for one, other in zip(jets, expected, strict=True):
        assert np.abs(one - other).max() < 1e-11 * np.abs(other).max()
    assert found.degree == max(3, order)
    assert found.along.degree == found.rung.degree == {"mean": 3, "fitted": 6, "om^(n+1)": 3 * (order + 1)}[name]
    for a in np.linspace(*window.a, 7):
        weights = contact_rows(found.rows, found.degree, a, 2 * order + 1, SPANS)[:, :, 3]
        assert weights.min() > 0
        assert weights.max() / weights.min() <= found.rung.ratio * (1 + 1e-9)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_separable_weights_need_the_first_rung_alone(order):
    rng = np.random.default_rng(order)
    rows, along = base(rng, order, 0.8, separable=True)
    found = tamed(
        rows,
        along,
        3,
        SPANS,
        order=len(rows) - 1,
        blend_degree=9,
        blend_spans=SPANS,
        window=Window((0.01, 100.0), (-9.0, 9.0)),
    )
    assert found.rung.name == "mean"
    own = rows[0, :, 3]
    assert found.rung.ratio == pytest.approx(own.max() / own.min(), rel=1e-6)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("per_a", [0.0, 0.5])
def test_the_bounds_hold_over_the_window(order, per_a):
    rng = np.random.default_rng(order)
    rows, along = base(rng, order, 0.4)
    rows, degree = normalised_rows(rows, along, 3, SPANS)
    window = Window((0.2, 1.7), (-0.3, 0.4), per_a)
    least, most = weight_range(rows[:, :, 3], degree, SPANS, 9, SPANS, window)
    seen = [
        contact_rows(rows, degree, a, 9, SPANS, per_a * a + t)[:, :, 3]
        for a in np.linspace(0.2, 1.7, 9)
        for t in np.linspace(-0.3, 0.4, 5)
    ]
    found = np.min(seen), np.max(seen)
    assert least <= found[0] + 1e-12
    assert most >= found[1] - 1e-12
    if order == 1:
        # Row 1 is linear: its bounds are met.
        assert (least, most) == pytest.approx(found, abs=1e-12)
    else:
        assert found[0] - least < 0.5 * (most - least)


@pytest.mark.parametrize("degree", [1, 2, 4])
def test_bernstein_coefficients_are_those_of_the_polynomial(degree):
    powers = np.random.default_rng(degree).uniform(-1, 1, degree + 1)
    coefficients = ladder._bernstein(degree, -0.5, 1.5) @ powers
    x = np.linspace(-0.5, 1.5, 9)
    expected = np.polynomial.polynomial.polyval(x, powers)
    assert BPoly(coefficients[:, None], [-0.5, 1.5])(x) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_weights_are_tame_to_a_limit(factor):
    # Weights at the edge 1; inside, the mean is 1 and one control weight falls so that row 1 has w - a (v - w).
    along = Basis(1, np.array([0, 0, 0.5, 1, 1]))
    rows = np.zeros((2, 3, 4))
    rows[:, :, 3] = 1
    rows[1, :, 3] = 1.5, 1.0, 0.5
    # Row 1 of the blend is (1 + a) w_0 - a w_1: for the first column 1 - a / 2.
    most = 2 * (1 - 0.1 * factor)
    found = tamed(
        rows, along, 1, (1.0,), order=len(rows) - 1, blend_degree=3, blend_spans=(3.0,), window=Window((0.1, most))
    )
    assert (found.rung.name == "mean") is (factor > 1)


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("name", ["mean", "fitted", "om^(n+1)"])
def test_no_rung_is_rougher_than_the_base(name, closed):
    rows, along, found, _ = on_rung(name, 2, closed=closed)
    own = least_continuity(rows, along, closed=closed)
    assert own in ((2,) if closed else (1, 2))
    assert least_continuity(found.rows, found.along, closed=closed) == own


def test_the_last_rung_has_the_power_of_the_weight():
    rng = np.random.default_rng(2)
    for order in (1, 2, 3, 4):
        rows, along = base(rng, order, 0.5)
        matrix = getattr(contact_numpy, f"end_derivatives_{order}")(4, *SPANS[:order])
        jets, basis = power_jets(np.einsum("dk,knc->dnc", matrix, rows), along)
        assert (jets[1:, :, 3] == 0).all()
        weight = basis_matrix(basis.degree, basis.knots, V) @ jets[0, :, 3]
        power = (basis_matrix(3, along.knots, V) @ rows[0, :, 3]) ** (order + 1)
        assert weight / weight[0] == pytest.approx(power / power[0], rel=1e-12)
        assert (jets[0, :, 3] > 0).all()
        # As smooth at each knot as before.
        inner, counts = np.unique(along.knots[4:-4], return_counts=True)
        assert (
            basis.knots[basis.degree + 1 : -basis.degree - 1].tolist() == np.repeat(inner, counts + 3 * order).tolist()
        )


def test_rows_of_the_last_rung_do_not_know_alpha():
    found = on_rung("om^(n+1)", 2)[2]
    assert (np.ptp(found.rows[:, :, 3], axis=0) == 0).all()
    assert len(found.rows) == 3
    assert found.rung.ratio == found.rows[0, :, 3].max() / found.rows[0, :, 3].min()
    assert found.along.degree == 9


@pytest.mark.long
def test_beyond_the_degree_of_kernels_finer_splines_come_first(monkeypatch):
    rng = np.random.default_rng(3)
    rows, along = base(rng, 4, 0.3, degree=6)
    options = {"order": 4, "blend_degree": 9, "blend_spans": SPANS, "window": Window((0.25, 4.0))}
    parts = []
    fit = ladder.fitted_jets

    def watched(jets, along, count, **more):
        parts.append(count)
        return fit(jets, along, count, **more)

    monkeypatch.setattr(ladder, "fitted_jets", watched)
    found = tamed(rows, along, 3, SPANS, **options)
    assert found.rung.name == "fitted"
    assert found.rung.degree == 9
    assert parts[-1] > 2
    # Nothing fits this: the last rung is taken, and says its degree.
    rows, along = base(rng, 4, 3.0, degree=6)
    found = tamed(rows, along, 3, SPANS, **options | {"window": Window((0.25, 1e9))})
    assert parts[-4:] == [2, 4, 8, 16]
    assert (found.rung.name, found.rung.degree) == ("om^(n+1)", 30)


def test_position_alone_asks_for_nothing():
    along = Basis(2, clamped([0.5], 2, 0, 1))
    rows = np.zeros((1, 4, 4))
    rows[0, :, 3] = 1.0, 0.5, 2.0, 1.0
    found = tamed(
        rows, along, 2, SPANS, order=len(rows) - 1, blend_degree=3, blend_spans=SPANS, window=Window((1.0, 1.0))
    )
    assert found.rung.name == "mean"
    assert found.rung.ratio == 4


@pytest.mark.parametrize(("degree", "most"), [(5, 2), (6, 16)])
def test_finer_splines_are_tried_where_the_last_rung_passes_degree_25(monkeypatch, degree, most):
    # Order 4: the last rung has degree 25, or 30.
    rows, along = base(np.random.default_rng(3), 4, 3.0, degree=degree)
    parts = []
    fit = ladder.fitted_jets

    def watched(jets, along, count, **more):
        parts.append(count)
        # How well they fit is not the question.
        return fit(jets, along, 1, **more)

    monkeypatch.setattr(ladder, "fitted_jets", watched)
    window = Window((0.25, 1e9))
    assert (window.p2, window.per_a) == ((0, 0), 0)
    tamed(rows, along, 3, SPANS, order=4, blend_degree=9, blend_spans=SPANS, window=window)
    assert max(parts) == most
