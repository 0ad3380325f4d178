"""Texts of expressions: put together without being simplified, read again by `fractions`."""

from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from semispline.papers.recheck.arithmetic import TextError, divisors, names, satisfied, value
from semispline.papers.recheck.texts import NotExpressibleError, Text, as_text, name_of, text

AT = {"x": Fraction(2, 3), "y": Fraction(-5, 7), "z": Fraction(11)}


def operators(children):
    return st.one_of(
        st.tuples(st.sampled_from("+-*/"), children, children),
        st.tuples(st.just("^"), children, st.integers(-1, 2)),
        st.tuples(st.just("neg"), children),
    )


TREES = st.recursive(
    st.one_of(st.sampled_from(sorted(AT)), st.fractions(-3, 3, max_denominator=5)), operators, max_leaves=8
)


def built(tree, leaf):
    """Put a tree together in any number type."""
    if not isinstance(tree, tuple):
        return leaf(tree)
    if tree[0] == "neg":
        return -built(tree[1], leaf)
    if tree[0] == "^":
        return built(tree[1], leaf) ** tree[2]
    one, other = built(tree[1], leaf), built(tree[2], leaf)
    return {"+": lambda: one + other, "-": lambda: one - other, "*": lambda: one * other, "/": lambda: one / other}[
        tree[0]
    ]()


@given(TREES)
def test_a_text_has_the_value_of_what_it_was_put_together_from(tree):
    written = str(built(tree, as_text))
    try:
        wanted = Fraction(built(tree, lambda leaf: AT.get(leaf, leaf)))
    except ZeroDivisionError:
        with pytest.raises(ZeroDivisionError):
            value(written, AT)
        return
    assert value(written, AT) == wanted


@given(TREES)
def test_sympy_is_written_with_its_value(tree):
    try:
        expression = built(tree, lambda leaf: sp.Symbol(leaf) if isinstance(leaf, str) else sp.Rational(leaf))
        wanted = expression.subs({name: sp.Rational(x) for name, x in AT.items()})
    except ZeroDivisionError:
        return
    if wanted.is_Rational and expression.is_finite is not False and not expression.has(sp.zoo, sp.nan):
        assert value(text(expression), AT) == Fraction(int(wanted.p), int(wanted.q))


def test_nothing_is_simplified():
    x = Text("x")
    assert str(x / x + 0 * x) == "x/x + 0*x"
    assert text(sp.Symbol("u_{m-3}") ** -1) == "1/u_m_less_3"


def test_every_divisor_is_found():
    assert sorted(divisors("a/(b*(c - 1)) + 1/3 + d^-2/e")) == ["b*(c - 1)", "d", "e"]
    assert list(divisors("0 - -h/(0 - -g)")) == ["0 - -g"]


@pytest.mark.parametrize("wrong", ["f(x)", "x y", "1.5", "x = 1", "[x]", "'x'", "x if y else z"])
def test_what_is_no_arithmetic_is_refused(wrong):
    with pytest.raises(TextError):
        value(wrong, AT)


@pytest.mark.parametrize("condition", ["x > 0", "y <= x", "x >= 2/3", "z != x", "y < 0"])
def test_conditions(condition):
    assert satisfied(condition, AT)
    assert not satisfied(condition, {"x": Fraction(-1), "y": Fraction(1), "z": Fraction(-1)})


def test_names_are_no_words_of_other_systems():
    assert names("P_m_less_1_j + u_1") == {"P_m_less_1_j", "u_1"}
    assert (name_of("I"), name_of("same"), name_of("V^r")) == ("I_", "same_", "V_r")


@pytest.mark.parametrize("expression", [sp.sqrt(2), sp.sin(sp.Symbol("x")), sp.Symbol("x") ** sp.Symbol("n"), 0.5])
def test_what_is_not_rational_is_refused(expression):
    with pytest.raises(NotExpressibleError):
        text(expression)
