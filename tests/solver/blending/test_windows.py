"""What a rational side is made fit for: windows of alpha^2 and of p2, by known geometry."""

import pytest

from semispline import Base, BSplineSurface
from semispline.solver.blending import windows
from semispline.solver.blending.pipeline import state_problem

LINE = [0.0, 0.0, 1.0, 1.0]


def strips():
    """Two strips of unit speed, one long and one wide, 2 apart, with weights of 1 and 2 along the edge."""
    nets = ([[[at, y, 0.0] for y in (0, 1)] for at in (x, x + 1)] for x in (0, 3))
    first, second = (BSplineSurface(1, 1, LINE, LINE, net, weights=[[1, 2], [1, 2]]) for net in nets)
    return Base(first, "u1"), Base(second, "u0")


def windows_of(monkeypatch, options):
    """The windows that both sides are made fit for."""
    asked = []

    def tame(side, u, spans, window):
        asked.append(window)
        return tamed(side, u, spans, window)

    tamed = windows.tame_side
    monkeypatch.setattr(windows, "tame_side", tame)
    state_problem(*strips(), degree_u=5, middle_curves=0, **options)
    return asked


@pytest.mark.parametrize(
    ("options", "ends"),
    [
        # Natural is 2; a window may be made to begin at half its lower end.
        ({"box": (0.5, 4.0)}, (0.5, 8.0)),
        # What is given is not searched.
        ({"alpha": 1.5}, (2.25, 2.25)),
        # The first row goes with the bulge, in both directions.
        ({"box": (0.5, 4.0), "bulge": (0.25, 1.0)}, (0.25, 8.0)),
        ({"box": (0.5, 4.0), "bulge": (0.75, 1.0)}, (0.5, 8.0)),
        ({"box": (0.5, 4.0), "bulge": (1.5, 1.0)}, (0.5, 12.0)),
        ({"alpha": 1.5, "bulge": (0.75, 1.0)}, (0.75 * 2.25, 2.25)),
        ({"alpha": 1.5, "bulge": (1.5, 1.0)}, (2.25, 1.5 * 2.25)),
    ],
)
def test_weights_of_a_rational_side_are_positive_over_what_may_be_searched(monkeypatch, options, ends):
    assert windows_of(monkeypatch, options)[0].a == pytest.approx(ends, rel=1e-12)


@pytest.mark.parametrize(("bulge", "times"), [(0.5, 1.0), (3.0, 9.0)])
def test_p2_reaches_as_much_farther_as_the_square_of_the_bulge(monkeypatch, bulge, times):
    (plain, _) = windows_of(monkeypatch, {})[:2]
    (more, _) = windows_of(monkeypatch, {"bulge": (bulge, 1.0)})[:2]
    assert plain.p2[1] > 0
    assert more.p2 == pytest.approx((times * plain.p2[0], times * plain.p2[1]), rel=1e-12)
