"""From trees to SymPy: values that are known, signs, derivatives, dots, shapes that do not fit."""

import pytest
import sympy as sp

from semispline.papers.latex import read_formula, read_names, relations
from semispline.papers.latex.conversion import symbol, to_sympy
from semispline.papers.latex.errors import ConversionError

NAMES = read_names(
    r"""
n, k, i : integer >= 0
x, t, s, a, b : real
w_i : real
P_n(x), f(x) : function
g(x) : function bare
S, E : plane point
N(t) : function plane point
M : matrix 2x2
A : matrix
\pi : constant
\gamma : constant
erf : standard function
"""
).of("eq-1")
n, x, t, a, b = (symbol(letter, NAMES) for letter in ("n", "x", "t", "a", "b"))


def converted(latex, given=None, branch=1):
    (statement,) = read_formula(latex, NAMES).statements
    return to_sympy(statement.sides[-1], NAMES, given, branch)


@pytest.mark.parametrize(
    ("latex", "value"),
    [
        ("0.1 + 1/5", sp.Rational(3, 10)),
        (r"\sqrt[3]{8} + \sqrt{4}", 4),
        (r"\cos(\pi) + \sin\pi", -1),
        (r"\binom{5}{2} + 3!", 16),
        (r"|-3| + \ln(1)", 3),
        (r"\sum_{k=1}^{4} k^2", 30),
        (r"1 + 2 + \dots + 10", 55),
        (r"\int_0^1 x^2\,dx", sp.Rational(1, 3)),
        (r"\frac{d}{dx} (x^3)", 3 * x**2),
        (r"\begin{bmatrix} 1 & 2 \end{bmatrix} \begin{bmatrix} 3 \\ 4 \end{bmatrix}", sp.Matrix([[11]])),
        (r"{\begin{bmatrix} 0 & 1 \\ 2 & 0 \end{bmatrix}}^{-1}", sp.Matrix([[0, sp.Rational(1, 2)], [1, 0]])),
        (r"|| (3, 4) ||", 5),
        (r"x = \left\{ \begin{matrix} 1 & \text{if } 2 \leq 3 \\ 0 & \text{otherwise} \end{matrix} \right.", 1),
        (r"x = \left\{ \begin{matrix} 1 & \text{if } 3 \in [2, 3) \\ 0 & \text{otherwise} \end{matrix} \right.", 0),
    ],
)
def test_known_values(latex, value):
    assert sp.simplify(converted(latex).doit() - value) == (sp.zeros(1) if value == sp.Matrix([[11]]) else 0 * value)


def test_a_double_sign_is_two_formulas():
    assert [converted(r"a \pm b \mp x", branch=branch) for branch in (1, -1)] == [a + b - x, a - b + x]


def test_an_oracle_takes_indices_before_arguments():
    oracle = {"P_n(x)": sp.legendre, "w_i": lambda k: k**2}
    assert converted("P_2(a)", oracle) == (3 * a**2 - 1) / 2
    assert converted("w_{n+1}", oracle) == (n + 1) ** 2
    assert converted(r"w_1 + \dots + w_3", oracle).doit() == 14
    assert converted("P_3'(1)", oracle).doit() == 6


def test_primes_differentiate_by_the_argument_and_then_put_it_in():
    f = {"f(x)": lambda y: y**3}
    assert converted("f'(x)", f).doit() == 3 * x**2
    assert converted("f''(2a)", f).doit() == 12 * a
    assert converted("g' + f'(0)").has(sp.Derivative, sp.Subs)


def test_points_of_the_plane_have_two_coordinates_everywhere():
    assert converted("S + a E - (1, 2)").shape == (2, 1)
    assert converted("N'(t) - S").shape == (2, 1)
    assert [str(s) for s in converted("S")] == ["S.x", "S.y"]


def test_legendre_recurrence_and_rodrigues_vanish_and_a_wrong_one_does_not():
    def difference(latex, order):
        (step,) = relations(read_formula(latex, NAMES), given={"P_n(x)": sp.legendre, "n": sp.Integer(order)})
        return sp.expand((step.left - step.right).doit())

    true = (
        r"(n+1) P_{n+1}(x) = (2n+1) x P_n(x) - n P_{n-1}(x)",
        r"P_n(x) = \frac{1}{2^n n!} \frac{d^n}{dx^n} (x^2-1)^n",
        r"P_n(x) = \frac{1}{2^n} \sum_{k=0}^{n} \binom{n}{k}^2 (x-1)^{n-k} (x+1)^k",
        r"(2n+1) P_n(x) = P_{n+1}'(x) - P_{n-1}'(x)",
    )
    wrong = (true[0].replace("2n+1", "2n-1"), true[1].replace("d^n", "d^2"), true[2].replace("x-1", "x+1"))
    for order in (3, 4, 5):
        assert [difference(latex, order) for latex in true] == [0, 0, 0, 0]
    assert 0 not in [difference(latex, 3) for latex in (wrong[0], wrong[2])]


def test_both_sides_of_a_step_stay_apart():
    steps = relations(read_formula("x = x = a", NAMES))
    assert [(step.left, step.relation, step.right) for step in steps] == [(x, "=", x), (x, "=", a)]


def test_a_continued_display_takes_the_side_before_it():
    before, after = read_formula("x = a", NAMES), read_formula("= b", NAMES)
    assert relations(after)[0].left is None
    assert relations(after, before)[0].left == a


def test_names_that_a_formula_gives_are_put_in_within_sums_too():
    (step,) = relations(read_formula(r"x = \sum_{i=0}^{n} s w_i, \text{where } s = i/k, k = n + 1", NAMES))
    assert step.right.subs(n, 2).doit() == sum(
        sp.Rational(k, 3) * sp.IndexedBase("w_i", real=True)[k] for k in range(3)
    )


@pytest.mark.parametrize(
    ("latex", "message"),
    [
        ("1 / 0", "a division by zero"),
        ("S + a", "Sum: "),
        (r"\begin{bmatrix} 1 & 2 \end{bmatrix} \begin{bmatrix} 3 & 4 \end{bmatrix}", "Product: "),
        (r"\begin{bmatrix} S & 2 \end{bmatrix}", "a matrix within a matrix"),
        (r"\gamma", "a constant of the table, and not known to SymPy"),
        ("erf(x)", "erf is a standard function of the table, and not known to SymPy"),
    ],
)
def test_what_has_no_form_in_sympy_is_said(latex, message):
    with pytest.raises(ConversionError, match=message):
        converted(latex)


def test_matrices_keep_their_order_and_a_size_that_is_not_declared_has_a_letter():
    product = converted("M M^T M^{-1} A")
    assert [str(f) for f in product.args][:1] == ["M"]
    assert str(converted("A").shape) == "(rows, rows)"
