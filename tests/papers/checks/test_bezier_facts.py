"""What any paper may need of Bezier curves: facts for every degree turn red at a wrong polynomial or share."""

import sympy as sp

from semispline.papers.checks.bezier_facts import bernstein_polynomial, casteljau_cases, elevation_cases, is_one


def truths(cases):
    return [case.true for case in cases]


def test_polynomials_that_are_not_bernsteins_are_seen():
    right = bernstein_polynomial
    assert all(truths(casteljau_cases()))
    for wrong in (
        lambda i, n, x, rest: x**i * rest ** (n - i),
        lambda i, n, x, rest: right(i, n, rest, x),
        lambda i, n, x, rest: 2 * right(i, n, x, rest),
    ):
        assert not all(truths(casteljau_cases(wrong)))


def test_a_wrong_share_is_seen():
    assert truths(elevation_cases()) == [True]
    assert truths(elevation_cases(lambda r, d: (r + 1) / (d + 2))) == [False]


def test_one_is_told_from_what_is_nearly_one():
    n, x = sp.symbols("n x", positive=True)
    assert is_one(sp.binomial(n + 1, 1) / (n + 1))
    assert not is_one(x ** (n + 1) / x**n)
