"""Least energies when rows are added: by hand, and by solving small systems with plain fractions."""

from fractions import Fraction
from itertools import pairwise

import pytest

from semispline.papers.checks.spline_values import clamped, de_boor
from semispline.papers.lin2014.checks.many_rows import SPAN, _cubic_energy, _lacks, _third_function, rows_over_averages


def bending(knots, points):
    """Integral of f'' squared of a cubic spline: f'' is linear on each span, so that three values of it will do."""

    def second(at, low, high):
        step = (high - low) / 3
        f0, f1, f2, f3 = (de_boor(4, knots, points, low + i * step) for i in range(4))
        start, end = (2 * f0 - 5 * f1 + 4 * f2 - f3) / step**2, (-f0 + 4 * f1 - 5 * f2 + 2 * f3) / step**2
        return start + (end - start) * (at - low) / (high - low)

    total = Fraction(0)
    breaks = sorted(set(knots))
    for low, high in pairwise(breaks):
        values = [second(at, low, high) for at in (low, (low + high) / 2, high)]
        total += (high - low) / 6 * (values[0] ** 2 + 4 * values[1] ** 2 + values[2] ** 2)
    return total


@pytest.mark.parametrize("m", [8, 11])
def test_the_third_function_alone_gives_the_second_derivative_for_h_over_2(m):
    knots = clamped(4, *(Fraction(i, m - 2) for i in range(1, m - 2)))
    h = Fraction(1, m - 2)
    points = [Fraction(0)] * (m + 1)
    points[2] = h**2 / 3
    assert bending(knots, points) == h / 2
    # f'' = 1 at u = 0, from the first piece, which begins with x^2 / 2.
    start, end, piece = _third_function()[0]
    assert (start, end) == (0, SPAN)
    assert (SPAN**2 / 3 * piece).diff("x", 2).subs("x", 0) == 1


def test_the_cubic_of_least_energy_by_hand():
    """Hermite: 12 for a unit step at rest, 4 for a unit slope that ends at rest; second derivatives 6 and -6."""
    assert _cubic_energy(Fraction(1), (0, 0, 1, 0)) == 12
    assert _cubic_energy(Fraction(1), (0, 1, 0, 0)) == 4
    assert _lacks((0, 0, 0, 1, 0, 0)) == (-6, 6)


def test_rows_over_averages_cost_more_in_the_end():
    """Measured, as proved: the energy falls with a few rows, and rises with many."""
    energies = list(rows_over_averages().measured.values())
    assert energies[0] > energies[1] > energies[2]
    assert energies[5] > energies[3] > energies[4]
