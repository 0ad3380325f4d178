"""What multiplies one control point in a printed sum."""

import pytest
import sympy as sp

from semispline.papers.checks.symbolic_sums import SAME, WITHIN, coefficient


def test_what_multiplies_a_control_point():
    i, j, a, b, n = sp.symbols("i j a b n", integer=True)
    P, f = sp.IndexedBase("P"), sp.Function("f")
    assert coefficient(sp.Sum(2 * P[i + 1] * f(i), (i, 1, n)), P[a]) == 2 * f(a - 1) * WITHIN(1, a - 1, n)
    double = sp.Sum(sp.Sum(P[i, j] * f(i, j), (j, 0, i)), (i, 0, n))
    assert coefficient(double, P[a, b]) == f(a, b) * WITHIN(0, b, a) * WITHIN(0, a, n)
    assert coefficient(sp.Sum(P[i, i], (i, 0, n)), P[a, b]) == SAME(a, b) * WITHIN(0, a, n)
    for wrong in (f(i), P[i] ** 2, P[i] * P[j]):
        with pytest.raises(ValueError, match="expected sums and products linear"):
            coefficient(wrong, P[a])
    with pytest.raises(ValueError, match="found i as the index of a sum"):
        coefficient(sp.Sum(P[i] * f(i), (i, 0, n)), P[i])
