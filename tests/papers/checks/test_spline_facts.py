"""What any paper may need of splines: facts for every order turn red at a wrong step, spaces are known ones."""

from fractions import Fraction
from types import SimpleNamespace

import pytest
import sympy as sp

from semispline.papers.checks import spline_facts
from semispline.papers.checks.spline_spaces import contact_at_knot, contained, union
from semispline.papers.checks.spline_values import clamped, de_boor

HALF, THIRD = Fraction(1, 2), Fraction(1, 3)


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("z", [Fraction(1, 10), Fraction(1, 2), Fraction(9, 10)])
def test_the_insertion_formula_at_numbers(order, z):
    """B = (z - s_0)/(s_k - s_0) B' + (s_(k+1) - z)/(s_(k+1) - s_1) B'', by de Boor's triangle on both sides."""
    old = clamped(order, Fraction(1, 5), Fraction(2, 5), Fraction(4, 5))
    new = tuple(sorted((*old, z)))
    for i in range(len(old) - order):
        s = sorted((*old[i : i + order + 1], z))
        if not old[i] <= z < old[i + order] or s[order] == s[0] or s[-1] == s[1]:
            continue
        weights = (z - s[0]) / (s[order] - s[0]), (s[-1] - z) / (s[-1] - s[1])
        unit = [Fraction(j == i) for j in range(len(old) - order)]
        both = [Fraction(0)] * (len(new) - order)
        both[i], both[i + 1] = weights
        for x in (Fraction(1, 7), Fraction(3, 7), Fraction(6, 7)):
            assert de_boor(order, old, unit, x) == de_boor(order, new, both, x)


@pytest.mark.long
def test_smoothness_at_a_symbolic_knot():
    assert [contact_at_knot(4, r) for r in (1, 2, 3)] == [2, 1, 0]
    assert [contact_at_knot(7, r) for r in (1, 6)] == [5, 0]


def test_spaces_that_contain_each_other():
    """Decided by hand: a space lies in another where each of its knots is there at least as often."""
    coarse, fine, other = clamped(4, HALF), clamped(4, THIRD, HALF), clamped(4, THIRD)
    assert (contained(4, coarse, fine), contained(4, fine, coarse)) == (True, False)
    assert (contained(4, coarse, other), contained(4, clamped(4), other)) == (False, True)
    assert (contained(4, coarse, clamped(4, HALF, HALF)), contained(4, clamped(4, HALF, HALF), coarse)) == (True, False)
    assert union(4, coarse, other) == fine
    assert union(4, coarse, clamped(4, HALF, HALF)) == clamped(4, HALF, HALF)


@pytest.mark.parametrize(
    "name", ["triangle_cases", "insertion_cases", "sharp_continuity_cases", "locality_induction_cases"]
)
def test_facts_hold(name):
    found = [case.true for case in getattr(spline_facts, name)()]
    assert found
    assert all(found)


def test_a_fact_without_its_step_is_seen(monkeypatch):
    monkeypatch.setattr(spline_facts, "_lower_function", lambda j, order, span: sp.Symbol(f"N_{j}"))
    assert not any(case.true for case in spline_facts.locality_induction_cases())
    broken = SimpleNamespace(name="continuity", identities={"a step": sp.Symbol("x")})
    monkeypatch.setattr(spline_facts, "_proofs", lambda: (broken,))
    assert [case.true for case in spline_facts.identity_cases("continuity")] == [False]
