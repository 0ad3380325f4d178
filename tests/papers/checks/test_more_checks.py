"""Inductions, sums letter by letter, points, series and inequalities: right is proved, wrong refuted, unknown told."""

import pytest
import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError
from semispline.papers.checks.inductions import induction
from semispline.papers.checks.inequalities import inequality, not_sharp
from semispline.papers.checks.points import at_random_points, on_a_grid
from semispline.papers.checks.power_series import series
from semispline.papers.checks.sums_by_letter import linear_sums
from semispline.papers.ledger.mutation import try_mutants
from semispline.papers.ledger.records import CheckFailedError, Part, Strength
from semispline.papers.ledger.writing import formula
from semispline.papers.recheck.by_fractions import agrees

i, n = sp.symbols("i n", integer=True, positive=True)
x, y, t = sp.symbols("x y t")
P, B, w = sp.Function("P"), sp.Function("B"), sp.IndexedBase("w")
LEGENDRE = {P: sp.legendre}
RECURRENCE = {P: lambda m, s: ((2 * m - 1) * s * P(m - 1, s) - (m - 1) * P(m - 2, s)) / m}
BERNSTEIN = {B: lambda j, d, s: sp.binomial(d, j) * s**j * (1 - s) ** (d - j)}


def equation(left, right, *assumptions):
    return formula(sp.Eq(left, right, evaluate=False), *assumptions)


def outcome(check, relation):
    """Truths of the cases; what is exported agrees with them."""
    truths = [case.true for case in check.cases(relation)]
    statements = list(check.export(relation))
    assert all(map(agrees, statements))
    assert all(statement.true for statement in statements) == all(truths)
    return truths


def total(term, first=1, last=n):
    return sp.Sum(term, (i, first, last))


@pytest.mark.parametrize(
    ("check", "left", "right"),
    [
        (induction(n, start=1), total(i**2), n * (n + 1) * (2 * n + 1) / 6),
        (induction(n), total(x**i, 0), (1 - x ** (n + 1)) / (1 - x)),
        (induction(n, start=2), sp.Product(1 - 1 / i**2, (i, 2, n)), (n + 1) / (2 * n)),
        (induction(n, start=2), total(i, 1, n) - total(i, 1, n - 1), n),
        (induction(n, depth=2, recurrences=RECURRENCE, where=LEGENDRE), P(n, 1), sp.Integer(1)),
        (induction(n, depth=2, recurrences=RECURRENCE, where=LEGENDRE), P(n, -x), (-1) ** n * P(n, x)),
    ],
)
def test_an_induction_proves_what_is_true_for_every_n(check, left, right):
    truths = outcome(check, equation(left, right))
    assert len(truths) >= 2
    assert all(truths)
    wrong = equation(left, right + 1)
    assert not any(outcome(check, wrong)[:1])
    assert check.search(wrong) is not None


def test_a_step_that_does_not_follow_refutes_nothing():
    # True for the first eight n alone.
    late = total(1, 1) + sp.Mul(*(n - j for j in range(1, 9)))
    with pytest.raises(CheckFailedError, match="neither proved nor refuted"):
        list(induction(n, start=1).cases(equation(late, n)))
    # Right, but the step needs another equation.
    cubes = equation(total(i**3), total(i) ** 2)
    with pytest.raises(CheckFailedError, match="combination"):
        list(induction(n, start=1, combination=[1]).cases(cubes))


def test_a_recurrence_that_is_not_that_of_the_function_is_seen():
    wrong = {P: lambda m, s: s * P(m - 1, s)}
    cases = list(induction(n, recurrences=wrong, where=LEGENDRE).cases(equation(P(n, 1), sp.Integer(1))))
    assert [case.true for case in cases if not case.own].count(False) == 2
    with pytest.raises(UnsuitableError, match="found no values of P"):
        list(induction(n, recurrences=wrong).cases(equation(P(n, 1), P(n, 1))))


def test_each_change_of_a_sum_is_noticed_by_induction():
    assert (
        try_mutants(Part(induction(n, start=1), equation(total(i**2), n * (n + 1) * (2 * n + 1) / 6))).survivors == ()
    )


ELEVATED = total((n + 1 - i) * w[i] / (n + 1) * B(i, n + 1, t), 0) + total(
    i * w[i - 1] / (n + 1) * B(i, n + 1, t), 1, n + 1
)
SLOPE = (
    total(w[i] * n * (B(i - 1, n - 1, t) - B(i, n - 1, t)), 1, n - 1)
    - n * B(0, n - 1, t) * w[0]
    + n * B(n - 1, n - 1, t) * w[n]
)


@pytest.mark.parametrize(
    ("start", "left", "right"),
    [
        (0, total(w[i] * B(i, n, t), 0), ELEVATED),
        (1, SLOPE, total(n * (w[i + 1] - w[i]) * B(i, n - 1, t), 0, n - 1)),
        (0, total(w[i] * x**i, 0), total(w[i - 1] * x ** (i - 1), 1, n + 1)),
        # A term more that is none.
        (0, total((n + 1 - i) * w[i], 0), total((n + 1 - i) * w[i], 0, n + 1)),
    ],
)
def test_sums_are_the_same_letter_by_letter(start, left, right):
    check = linear_sums(w[i], n, start=start, where=BERNSTEIN)
    truths = outcome(check, equation(left, right))
    assert all(truths)
    assert len(truths) > 5
    assert not all(outcome(check, equation(left, 2 * right)))


def test_a_sum_that_runs_one_term_too_far_is_seen_at_that_letter():
    check = linear_sums(w[i], n)
    assert not all(outcome(check, equation(total(w[i] * i, 0), total(w[i] * i, 0, n + 1))))
    # For the first n nothing is wrong: x vanishes at each of them.
    late = sp.Mul(*(n - j for j in range(5)))
    cases = list(check.cases(equation(total(w[i], 0), total(w[i], 0) + late * w[n + 1])))
    assert [case.label for case in cases if not case.true] == ["w[n + 1]"]


def test_the_letter_of_an_index_may_be_that_of_the_sums():
    j, m = sp.symbols("j m", integer=True)
    check = linear_sums(w[j], m)
    one = sp.Sum(x**j * w[j], (j, 0, m))
    assert all(outcome(check, equation(one, sp.Sum(x ** (j - 1) * w[j - 1], (j, 1, m + 1)))))
    wrong = list(check.cases(equation(one, sp.Sum(x**j * w[j - 1], (j, 1, m + 1)))))
    assert [case.true for case in wrong] == [False] * 5
    labels = [case.label for case in check.cases(equation(one, one))]
    assert "w[j], every j that all sums have" in labels


def test_sums_of_another_kind_are_refused():
    for left, right in ((total(w[i] ** 2), total(w[i] ** 2)), (total(w[i], 1, 2 * n), total(w[i], 1, 2 * n))):
        with pytest.raises(UnsuitableError):
            list(linear_sums(w[i], n).cases(equation(left, right)))
    with pytest.raises(UnsuitableError, match="expected an indexed letter"):
        linear_sums(x, n)


FRACTIONS = equation((x + y) ** 5 / (x - y), (x + y) ** 6 / (x**2 - y**2))


@pytest.mark.parametrize("check", [at_random_points(), on_a_grid()])
def test_points_decide_quotients_without_dividing(check):
    assert all(outcome(check, FRACTIONS))
    wrong = equation(FRACTIONS.relation.lhs, FRACTIONS.relation.rhs + x**7 - x)
    assert not all(outcome(check, wrong))
    assert str(check.search(wrong)).startswith("x = 0, y = 1") is False
    assert try_mutants(Part(check, FRACTIONS)).survivors == ()


def test_what_vanishes_on_a_smaller_grid_is_seen():
    # Zero at 0, 1 and 2 for each letter, as a careless grid would have it.
    sly = sp.Mul(*(x - j for j in range(3))) * sp.Mul(*(y - j for j in range(3)))
    for check in (on_a_grid(), at_random_points()):
        assert not all(case.true for case in check.cases(equation(sly, sp.Integer(0))))


def test_random_points_say_how_sure_they_are():
    check = at_random_points(certainty=200)
    assert (check.strength, check.proof) == (Strength.RANDOM, False)
    assert "2^-200" in check.method
    # Degree 7 takes 3 of 64 bits.
    assert len(list(check.cases(FRACTIONS))) == 4
    with pytest.raises(UnsuitableError, match="whole powers of letters"):
        list(check.cases(equation(sp.sin(x), x)))
    with pytest.raises(UnsuitableError, match="expected at most"):
        list(on_a_grid().cases(equation((x + y) ** 500, sp.Integer(0))))


@pytest.mark.parametrize(
    ("check", "left", "right", "truths"),
    [
        (series(x), sp.sin(x), x - x**3 / 6 + sp.O(x**5), [True] * 5),
        (series(x, 3), sp.exp(y * x) / (1 - x), 1 + (y + 1) * x + (y**2 / 2 + y + 1) * x**2, [True] * 3),
        (series(x, 3, at=1), sp.log(x), (x - 1) - (x - 1) ** 2 / 2, [True] * 3),
        (series(x, 3), sp.sqrt(4 + x), 2 + x / 4 - x**2 / 64, [True] * 3),
        (series(x, 4), sp.tan(x), x + x**3 / 2, [True, True, True, False]),
        (series(x, 4), sp.asin(x) + sp.atan(x), 2 * x - x**3 / 6, [True] * 4),
    ],
)
def test_the_terms_of_a_series_are_compared(check, left, right, truths):
    assert [case.true for case in check.cases(equation(left, right))] == truths
    statements = list(check.export(equation(left, right)))
    assert [statement.true for statement in statements] == truths
    assert all(map(agrees, statements))


def test_a_series_needs_an_order():
    with pytest.raises(UnsuitableError, match="found no O"):
        list(series(x).cases(equation(sp.sin(x), x)))
    with pytest.raises(UnsuitableError, match="negative or no whole number"):
        list(series(x, 2).cases(equation(1 / x, x)))


@pytest.mark.parametrize(
    ("relation", "box"),
    [
        (sp.Le(t * (1 - t), sp.Rational(1, 4), evaluate=False), {t: (0, 1)}),
        (sp.Lt(t * (1 - t), sp.Rational(1, 3), evaluate=False), {t: (None, None)}),
        (sp.Ge(x**2 + y**2, 2 * x * y, evaluate=False), {x: (None, None), y: (None, None)}),
        (sp.Gt(x**2 + y**2 + 1, x * y, evaluate=False), {x: (None, None), y: (0, None)}),
        (sp.Le((1 - t) ** 2 / (t**2 + (1 - t) ** 2), 1, evaluate=False), {t: (0, 1)}),
        (sp.Ge(t**3, t**2, evaluate=False), {t: (1, None)}),
        (sp.Ge((t**2 - 2) ** 2 * t, 0, evaluate=False), {t: (0, 5)}),
        (sp.Le(1 / (t - 3), 0, evaluate=False), {t: (0, 2)}),
        (sp.Ge(x**4 + y**4 - 4 * x * y + 3, 0, evaluate=False), {x: (-1, 0), y: (-2, 0)}),
    ],
)
def test_an_inequality_is_proved_on_its_box(relation, box):
    check = inequality(box)
    assert outcome(check, formula(relation)) == [True]
    turned = {sp.Le: sp.Gt, sp.Lt: sp.Ge, sp.Ge: sp.Lt, sp.Gt: sp.Le}
    other = formula(next(turned[k] for k in turned if isinstance(relation, k))(*relation.args, evaluate=False))
    assert outcome(check, other) == [False]
    assert check.search(other) is not None


def test_a_false_inequality_has_its_smallest_point():
    check = inequality({t: (0, 1)})
    wrong = formula(sp.Le(27 * t * (1 - t) ** 2, 3, evaluate=False))
    assert str(check.search(wrong)) == "t = 1/2: printed 27/8 <= 3, true 27/8 > 3"


def test_the_best_bound_is_told_from_any():
    best = formula(sp.Le(t * (1 - t), sp.Rational(1, 4), evaluate=False))
    attained = inequality({t: (0, 1)}, attained={t: sp.Rational(1, 2)})
    assert outcome(attained, best) == [True, True]
    assert try_mutants(Part(attained, best)).survivors == ()
    any_bound = inequality({t: (0, 1)})
    assert try_mutants(Part(any_bound, best)).survivors
    told = not_sharp(best, any_bound, "a bound that is not claimed to be the best")
    result = try_mutants(Part(any_bound, told))
    assert result.survivors == ()
    assert result.undecidable


def test_given_squares_are_added_up():
    relation = formula(sp.Ge(x**4 + y**4, 2 * x**2 * y**2, evaluate=False))
    everywhere = {x: (None, None), y: (None, None)}
    assert outcome(inequality(everywhere, squares=[(1, x**2 - y**2)]), relation) == [True]
    with pytest.raises(CheckFailedError, match="the squares leave"):
        list(inequality(everywhere, squares=[(1, x**2)]).cases(relation))
    with pytest.raises(UnsuitableError, match="a negative factor"):
        list(inequality(everywhere, squares=[(-1, x)]).cases(relation))
    strict = formula(sp.Gt(x**4 + y**4, 2 * x**2 * y**2, evaluate=False))
    with pytest.raises(CheckFailedError, match="may all be 0"):
        list(inequality(everywhere, squares=[(1, x**2 - y**2)]).cases(strict))


@pytest.mark.parametrize(
    ("relation", "box", "message"),
    [
        (sp.Le(t, x, evaluate=False), {t: (0, 1)}, "no box for x"),
        (sp.Le(sp.sin(t), 1, evaluate=False), {t: (0, 1)}, "expected rational ones"),
        (sp.Le(1 / (2 * t - 1), 9, evaluate=False), {t: (0, 1)}, "a divisor that changes its sign"),
        (sp.Eq(t, 1, evaluate=False), {t: (0, 1)}, "found no inequality"),
    ],
)
def test_what_is_no_inequality_on_a_box_is_refused(relation, box, message):
    with pytest.raises(UnsuitableError, match=message):
        list(inequality(box).cases(formula(relation)))
    with pytest.raises(UnsuitableError, match="the smaller number first"):
        inequality({t: (1, 0)})
