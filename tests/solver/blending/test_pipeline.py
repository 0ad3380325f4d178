"""One blend on its way: which direction is stated."""

from types import SimpleNamespace

import pytest

from semispline import Base, BSplineSurface
from semispline.solver.blending import pipeline

LINE = [0.0, 0.0, 1.0, 1.0]


@pytest.mark.parametrize("flipped", [True, False])
def test_of_two_directions_that_tie_the_less_turning_one_is_stated(monkeypatch, flipped):
    a, b = (BSplineSurface(1, 1, LINE, LINE, [[[at, y, 0.0] for y in (0, 1)] for at in (x, x + 1)]) for x in (0, 3))
    monkeypatch.setattr(pipeline, "_tied", lambda a, b, flip: ("yes", "no") if not flipped else ("no", "yes"))
    monkeypatch.setattr(pipeline, "blend", lambda a, b, said: SimpleNamespace(flipped=flipped))
    assert pipeline.state_problem(Base(a, "u1"), Base(b, "u0")).matched.flipped is flipped
