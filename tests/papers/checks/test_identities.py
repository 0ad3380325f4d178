"""Identities: what is the same is proved, what differs refuted by numbers, and what is neither gives no answer."""

import pytest
import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError, carried_out
from semispline.papers.checks.counterexamples import smallest_difference
from semispline.papers.checks.enclosures import differ_at, enclosure, value_at
from semispline.papers.checks.identities import identity
from semispline.papers.checks.normal_form import difference
from semispline.papers.ledger.exact import UndefinedError
from semispline.papers.ledger.mutation import mutants, try_mutants
from semispline.papers.ledger.records import CheckFailedError, Part
from semispline.papers.ledger.verification import decide
from semispline.papers.ledger.writing import corrected, fails, formula, holds, part
from semispline.papers.recheck.by_fractions import agrees

n, k, i = sp.symbols("n k i", integer=True)
m = sp.Symbol("m", integer=True, positive=True)
x, y, t, phi = sp.symbols("x y t phi")
P, w, B = sp.Function("P"), sp.IndexedBase("w"), sp.Function("B")


def equation(left, right, *assumptions, **more):
    return formula(sp.Eq(left, right, evaluate=False), *assumptions, **more)


def truths(check, *sides):
    return [case.true for case in check.cases(equation(*sides))]


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ((x**2 - 1) / (x - 1), x + 1),
        (sp.sqrt(x + 1) ** 3, (x + 1) * sp.sqrt(x + 1)),
        ((1 - sp.cos(phi)) / sp.sin(phi), sp.tan(phi / 2)),
        (sp.Rational(1, 4) * (3 + sp.cos(phi)) - sp.cos(phi / 2), 2 * sp.sin(phi / 4) ** 4),
        (sp.cos(x + y), sp.cos(x) * sp.cos(y) - sp.sin(x) * sp.sin(y)),
        (sp.cos(x) + sp.cos(x + 2 * sp.pi / 3) + sp.cos(x + 4 * sp.pi / 3), 0),
        (1 / sp.cot(x) * sp.sec(x), sp.sin(x) / sp.cos(x) ** 2),
        (k * sp.binomial(m, k), m * sp.binomial(m - 1, k - 1)),
        (sp.factorial(m + 2) / sp.factorial(m - 1), m * (m + 1) * (m + 2)),
        (t ** (m + 1) * t ** (2 - m), t**3),
        ((-1) ** (m + 1) * 4**m, -((-1) ** m) * 2 ** (2 * m)),
        (sp.Abs(x) ** 2, x**2),
        (sp.exp(2 * x) * sp.exp(-x), sp.exp(x)),
        (w[1] + w[2], w[2] + w[1]),
    ],
)
def test_both_sides_are_the_same(one, other):
    assert difference(one, other).zero
    # A term more is seen, whatever the letters stand for.
    assert not difference(one + x / 1000, other).zero
    assert all(map(agrees, identity().export(equation(one, other))))


@pytest.mark.parametrize(
    ("one", "other", "at"),
    [
        (x**2, 2 * x, "x = 1: printed 2, true 1"),
        (sp.sin(2 * x), 2 * sp.sin(x), "x = 1: printed 1.682"),
        (sp.sqrt(x**2), x, "x = -1: printed -1, true 1"),
        (sp.binomial(m, 2), m**2 / 2, "m = 1: printed 1/2, true 0"),
        (P(1) + P(2), 2 * P(1), "P(1) = 0, P(2) = 1"),
    ],
)
def test_what_differs_is_refuted_by_the_smallest_numbers(one, other, at):
    check = identity()
    wrong = equation(one, other)
    assert truths(check, one, other) == [False]
    assert str(check.search(wrong)).startswith(at)
    assert all(not statement.true and agrees(statement) for statement in check.export(wrong))


def test_assumptions_limit_counterexamples():
    assert smallest_difference(sp.sqrt(x**2), x, [x >= 0]) is None
    with pytest.raises(CheckFailedError, match="neither proved nor refuted"):
        list(identity().cases(equation(sp.sqrt(x**2), x, x >= 0)))
    with pytest.raises(UnsuitableError, match="where"):
        smallest_difference(x, y, [sp.Eq(x, y)])


def test_a_formula_is_decided_for_each_of_a_range():
    square = ((1 + x) ** n, sp.Sum(sp.binomial(n, k) * x**k, (k, 0, n)))
    check = identity(each={n: range(4)})
    assert truths(check, *square) == [True] * 4
    assert truths(check, square[0], square[1].subs(n, n - 1)) == [False] * 4
    assert not check.proof
    assert identity(each={n: range(4)}, complete=True).proof
    assert "n = 0 .. 3" in check.method
    pairs = identity(each=[{n: a, k: b} for a in range(3) for b in range(a + 1)])
    assert truths(pairs, sp.binomial(n, k), sp.binomial(n, n - k)) == [True] * 6


def test_letters_and_functions_have_the_meaning_that_is_said():
    bernstein = {B: lambda j, d, s: sp.binomial(d, j) * s**j * (1 - s) ** (d - j)}
    ends = {w: lambda j: w[j] if 0 <= j <= 2 else sp.Integer(0)}
    raised = sp.Sum(((3 - i) * w[i] + i * w[i - 1]) / 3 * B(i, 3, t), (i, 0, 3))
    curve = sp.Sum(w[i] * B(i, 2, t), (i, 0, 2))
    assert truths(identity(where=bernstein | ends), curve, raised) == [True]
    by_instance = identity(each={n: (2, 3)}, where=lambda at: {x: at[n] * t})
    assert truths(by_instance, x, n * t) == [True, True]


@pytest.mark.parametrize(
    ("left", "right", "problem"),
    [
        (1 / (x - x), x, "undefined"),
        (sp.Sum(w[i], (i, 0, 2)), sp.Sum(w[i], (i, -1, 2)), "no such weight"),
        (1 / sp.Function("f")(x), x, "is not defined"),
        (sp.factorial(x - 3), x, "is not defined"),
    ],
)
def test_what_is_not_defined_is_false_and_says_so(left, right, problem):
    def weight(j):
        if j < 0:
            raise UndefinedError("no such weight")
        return w[j]

    where = (
        {x: sp.Integer(0)} if problem == "undefined" else {x: sp.Integer(1), w: weight, sp.Function("f"): lambda a: 0}
    )
    (case,) = identity(where=where).cases(equation(left, right))
    assert not case.true
    assert problem in str(case.residual)


@pytest.mark.parametrize(
    ("left", "right", "message"),
    [
        (sp.Sum(x**i, (i, 0, n)), x, "expected whole numbers"),
        (sp.Float("0.5") * x, x / 2, "found the float"),
        (sp.gamma(x) * sp.zeta(x), x, "expected sums, products"),
        (sp.Integral(sp.sin(x), (x, 0, 1)), x, "integral of a polynomial"),
    ],
)
def test_what_the_check_is_not_for_is_refused(left, right, message):
    with pytest.raises(UnsuitableError, match=message):
        list(identity().cases(equation(left, right)))
    with pytest.raises(UnsuitableError, match="no equation"):
        list(identity().cases(formula(x > y)))


def test_sums_derivatives_and_integrals_are_carried_out():
    assert carried_out(sp.Sum(sp.Sum(i * k, (k, 0, i)), (i, 1, 3))) == 1 + 6 + 18
    assert carried_out(sp.Derivative(sp.Sum(w[i] * t**i, (i, 0, 2)), t)) == w[1] + 2 * t * w[2]
    assert carried_out(sp.Integral(t**2, (t, 0, x))) == x**3 / 3
    assert carried_out(sp.Product(i + x, (i, 1, 2))) == (1 + x) * (2 + x)


M = sp.ImmutableMatrix([[1, 0, 0], [-2, 2, 0], [1, -2, 1]])
Z = sp.ImmutableMatrix.diag(1, t, t**2)
Q = sp.ImmutableMatrix([[1, 0, 0], [-(t - 1), t, 0], [(t - 1) ** 2, -2 * (t - 1) * t, t**2]])


def test_matrices_are_multiplied_and_inverted_as_printed():
    product = sp.MatMul(sp.MatPow(M, -1), Z, M)
    check = identity()
    assert truths(check, product, Q) == [True]
    (case,) = check.cases(equation(product, Q.as_mutable().T.as_immutable()))
    assert not case.true
    assert "entry (1, 2)" in case.label
    (statement,) = check.export(equation(product, Q))
    assert (statement.form, statement.left) == ("matrices", "m1_^-1*m2_*m1_")
    assert agrees(statement)
    (wrong,) = check.export(equation(product, Q.as_mutable().T.as_immutable()))
    assert not wrong.true
    assert agrees(wrong)


def test_matrices_of_other_sizes_are_not_the_same():
    (case,) = identity().cases(equation(M, sp.ImmutableMatrix([[1, 2]])))
    assert "sizes" in str(case.residual)
    # A row times a column counts as the number in it.
    row, column = sp.ImmutableMatrix([[1, t]]), sp.ImmutableMatrix([x, y])
    assert truths(identity(), sp.MatMul(row, column), x + t * y) == [True]


def test_each_entry_of_a_matrix_is_mistaken_in_turn():
    printed = equation(
        sp.MatMul(M, sp.ImmutableMatrix([x, y, t])), sp.ImmutableMatrix([x, 2 * y - 2 * x, x - 2 * y + t])
    )
    found = mutants(printed)
    assert {"entry", "number", "sign"} <= {mutant.kind for mutant in found}
    assert len({mutant.text for mutant in found}) == len(found)
    assert not any("\n" in mutant.text for mutant in found)
    assert try_mutants(Part(identity(), printed)).survivors == ()


def test_a_failing_record_needs_no_search_of_its_own():
    wrong, right = equation(sp.Sum(i, (i, 1, n)), n**2 / 2), equation(sp.Sum(i, (i, 1, n)), n * (n + 1) / 2)
    check = identity(each={n: range(1, 5)})
    decision = decide(
        fails("eq-1", "here", "A sum.", part(check, wrong), correction=corrected("Right.", part(check, right)))
    )
    assert decision.ok, decision.problem
    assert decision.counterexample == "n = 1: printed 1/2, true 1"
    assert decide(holds("eq-2", "here", "A sum.", part(check, right))).ok


def test_a_probe_tells_what_the_check_tells():
    check = identity(each={n: (2, 3)}, where={B: lambda j: x**j})
    one = equation(sp.Sum(B(i) * w[i], (i, 0, n)), sp.Sum(x**i * w[i], (i, 0, n)))
    other = equation(sp.Sum(B(i) * w[i], (i, 0, n)), sp.Sum(x**i * w[i + 1], (i, 0, n)))
    assert check.probe(one) == [0, 0]
    assert check.probe(other) != check.probe(one)
    # Where there are no exact values there is no probe.
    assert identity().probe(equation(sp.sin(x), x)) is None


def test_values_are_exact_or_enclosed():
    assert value_at(x**2 / 3, {x: sp.Rational(1, 2)}) == sp.Rational(1, 12)
    assert value_at(sp.sqrt(x), {x: 2}).overlaps(enclosure(sp.sqrt(2)))
    assert differ_at(sp.sqrt(2) * sp.sqrt(3 + x), sp.sqrt(6 + 2 * x), {x: 1}) is None
    assert differ_at(sp.sqrt(x), sp.Rational(141421356, 10**8), {x: 2})
    root = sp.CRootOf(x**5 - x - 1, 0)
    assert enclosure(root**5 - root).contains(1)
    with pytest.raises(UndefinedError, match="no real value"):
        enclosure(sp.sqrt(x), {x: -1})
    with pytest.raises(UnsuitableError, match="a letter without a number"):
        enclosure(x)
