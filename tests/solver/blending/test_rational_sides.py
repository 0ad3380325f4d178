"""Blends put together from rows alone: contact with the base as it was given, and no crease inside."""

import numpy as np
import pytest

from helpers.array_blends import SPANS, Blend
from helpers.conics import standard_arcs
from semispline.solver.blending.conics import cured_conic
from semispline.solver.blending.ladder import Window, tamed
from semispline.solver.blending.weights import normalised_rows
from semispline.solver.splines import Basis, clamped

TURN = 2 * np.pi


def round_base(rng, cuts, height, lean):
    """A ring of a rational quadratic meridian over ellipses: 3 rows, each with weights of its own factor."""
    knots, points = standard_arcs(cuts)
    knots = knots / knots[-1]
    frames = np.zeros((3, 3, 4))
    for k in range(3):
        radii = rng.uniform(0.8, 1.2, 2) * (1 + 0.2 * k)
        weight = rng.uniform(0.8, 1.2)
        frames[k, 0, :3] = radii[0] * np.array([1, 0, lean]) * weight
        frames[k, 1, :3] = radii[1] * np.array([0, 1, 0.3 * lean]) * weight
        frames[k, 2] = np.array([0.1 * k, 0, height * (1 + 0.5 * k), 1]) * weight
    return np.einsum("nc,kcd->knd", points, frames), Basis(2, knots)


@pytest.mark.parametrize(
    ("cuts_a", "cuts_b", "least"),
    [
        (np.linspace(0, TURN, 5), np.linspace(0.4, 0.4 + TURN, 4), 1.0),
        (np.linspace(0, TURN, 4), np.array([0.2, 1.0, 3.4, 4.1, 0.2 + TURN]), 3.0),
        (np.linspace(0, 3.0, 3), np.array([0.1, 0.8, 3.2]), 0.3),
        (np.linspace(0, 5.0, 4), np.array([0.1, 2.8, 5.0]), 0.3),
        (np.linspace(0, TURN, 5), np.linspace(0, TURN, 6), 1.0),
    ],
)
def test_rims_of_other_arcs_make_no_crease_once_cured(cuts_a, cuts_b, least):
    rng = np.random.default_rng(4)
    closed = cuts_a[-1] - cuts_a[0] == pytest.approx(TURN)
    a, b = round_base(rng, cuts_a, 1.0, 0.2), round_base(rng, cuts_b, -1.0, -0.1)
    raw = Blend(*((*normalised_rows(*side, 2, SPANS)[:1], side[1], 2) for side in (a, b)))
    assert raw.inside(closed)[0] > least
    cured = []
    for side in (a, b):
        rows, along = cured_conic(*side, 2)
        rows, degree = normalised_rows(rows, along, 2, SPANS)
        assert np.ptp(rows[:, :, 3], axis=0).max() < 1e-14
        cured.append((rows, along, degree))
    blend = Blend(*cured)
    crease, jump = blend.inside(closed)
    assert crease < 1e-10
    assert jump < 1e-10
    for end, side in enumerate((a, b)):
        gap, angle, curvature = blend.contact(end, *side, 2)
        assert gap < 1e-13
        assert angle < 1e-10
        assert curvature < 1e-10


@pytest.mark.parametrize(("lean", "most", "rung"), [(0.05, 0.5, "mean"), (0.25, 4.0, "fitted")])
def test_rings_whose_weights_are_not_separable(lean, most, rung):
    sides, bases = [], []
    for sign, cuts in ((1, np.linspace(0, TURN, 5)), (-1, np.linspace(0.3, 0.3 + TURN, 4))):
        rng = np.random.default_rng(sign + 1)
        knots, points = standard_arcs(cuts)
        frames = np.zeros((3, 3, 4))
        frames[:, 0, 0] = frames[:, 1, 1] = 1
        for k in range(3):
            frames[k, :, 3] = *rng.uniform(-lean, lean, 2), 1
            frames[k, 2, 2] = sign * (1 + 0.5 * k)
        base = np.einsum("nc,kcd->knd", points, frames), Basis(2, knots / knots[-1])
        rows, along = cured_conic(*base, 2)
        found = tamed(
            rows,
            along,
            2,
            SPANS,
            order=2,
            blend_degree=5,
            blend_spans=SPANS,
            window=Window((most / 4, most)),
            closed=True,
        )
        sides.append(found)
        bases.append(base)
    assert rung in {side.rung.name for side in sides}
    blend = Blend(*((side.rows, side.along, side.degree) for side in sides), alpha=(most, most / 2))
    crease, jump = blend.inside(closed=True)
    assert crease < 1e-9
    assert jump < 1e-8
    for end, base in enumerate(bases):
        gap, angle, curvature = blend.contact(end, *base, 2)
        assert gap < 1e-12
        assert angle < 1e-9
        assert curvature < 1e-9


@pytest.mark.parametrize(("spread", "most", "rung"), [(0.1, 0.5, "mean"), (0.3, 4.0, "fitted"), (0.8, 8.0, "om^(n+1)")])
def test_sheets_on_each_rung_are_in_contact_and_smooth(spread, most, rung):
    rng = np.random.default_rng(11)
    along = Basis(3, clamped([0.3, 0.5, 0.8], 3, 0, 1))
    v = np.linspace(0, 1, along.size)
    sheets = []
    for sign in (1, -1):
        points = np.stack(
            [np.stack([v, 0 * v + sign * (1 + 0.4 * k), np.sin(3 * v) + 0.2 * k * k], -1) for k in range(4)]
        )
        weights = np.exp(rng.uniform(-spread, spread, points.shape[:2]))[..., None]
        sheets.append(np.concatenate([points * weights, weights], axis=-1))
    window = Window((most / 4, most))
    sides = [tamed(s[:3], along, 3, SPANS, order=2, blend_degree=5, blend_spans=SPANS, window=window) for s in sheets]
    assert rung in {side.rung.name for side in sides}
    blend = Blend(*((side.rows, side.along, side.degree) for side in sides), alpha=(most, most / 2))
    assert min(rows[:, :, 3].min() for rows, _ in blend.sides) > 0
    crease, jump = blend.inside(closed=False)
    assert crease < 1e-9
    assert jump < 1e-8
    for end, sheet in enumerate(sheets):
        gap, angle, curvature = blend.contact(end, sheet, along, 3)
        assert gap < 1e-12
        assert angle < 1e-9
        assert curvature < 1e-9
