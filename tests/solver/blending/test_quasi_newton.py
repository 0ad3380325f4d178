"""What the paper's search may end at."""

from types import SimpleNamespace

import pytest

from semispline import ContactError
from semispline.solver.blending.quasi_newton import _require_leaving


@pytest.mark.parametrize(
    ("free", "found", "named"),
    [
        ((True, True), (2.2e-8, 5.5e-8), []),
        ((True, True), (1.8e-8, 5.5e-8), ["contact a"]),
        ((True, True), (2.2e-8, 4.5e-8), ["contact b"]),
        ((True, True), (0.0, float("nan")), ["contact a", "contact b"]),
        # What is given does not run anywhere.
        ((False, True), (0.0, 5.5e-8), []),
    ],
)
def test_below_a_hundred_millionth_of_natural_a_parameter_is_degenerate(free, found, named):
    problem = SimpleNamespace(free=free, natural=(2.0, 5.0))
    if not named:
        _require_leaving(problem, found)
        return
    with pytest.raises(ContactError) as refusal:
        _require_leaving(problem, found)
    assert [side for side in ("contact a", "contact b") if side in str(refusal.value)] == named
