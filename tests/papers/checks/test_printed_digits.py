"""Printed decimals: rounded, cut off, or wrong; a digit more or less is seen."""

from fractions import Fraction

import pytest
import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError
from semispline.papers.checks.printed_digits import Digits, as_digits, digits
from semispline.papers.ledger.mutation import try_mutants
from semispline.papers.ledger.records import Part
from semispline.papers.ledger.writing import formula
from semispline.papers.recheck.by_fractions import agrees

x = sp.Symbol("x")


def printed(exact, text):
    return formula(sp.Eq(exact, Digits(text), evaluate=False))


@pytest.mark.parametrize(
    ("exact", "text", "rounded", "cut"),
    [
        (sp.pi, "3.1416", True, False),
        (sp.pi, "3.1415", False, True),
        (sp.pi, "3.1414", False, False),
        (-sp.pi, "-3.1415", False, True),
        (-sp.pi, "-3.1416", True, False),
        (4 * (sp.sqrt(2) - 1) / 3, "0.55228", True, True),
        (sp.Rational(1, 8), "0.13", True, False),
        (sp.Rational(1, 8), "0.12", True, True),
        (sp.Rational(1, 8), "0.125", True, True),
        (sp.Rational(1, 8), "0.1250", True, True),
        (sp.Rational(27253, 10**8), "2.7253e-4", True, True),
        (sp.Rational(27253, 10**8), "2.7e-4", True, True),
        (sp.Integer(1234), "1.2E3", True, True),
        (sp.Rational(1, 3000), "0.000", True, True),
        (sp.Rational(-1, 3000), "0.00", True, True),
        (sp.pi, "-3.1416", False, False),
        (sp.cos(1), ".5403", True, True),
        (sp.CRootOf(sp.legendre_poly(5, x), 4), "0.906179845938664", True, False),
        (sp.CRootOf(sp.legendre_poly(5, x), 4), "0.906179845938663", False, True),
    ],
)
def test_rounded_and_cut_off_are_told_apart(exact, text, rounded, cut):
    for ending, wanted in (("rounded", rounded), ("cut", cut)):
        check = digits(ending)
        (case,) = check.cases(printed(exact, text))
        assert case.true is wanted, ending
        assert (check.search(printed(exact, text)) is None) is wanted
        (statement,) = check.export(printed(exact, text))
        assert statement.true is wanted
        assert agrees(statement)


def test_what_would_be_right_is_said():
    (case,) = digits().cases(printed(sp.pi, "3.1415"))
    assert case.label == "3.1415 for 3.14159265359... (rounded 3.1416, cut off 3.1415)"
    assert str(digits().search(printed(sp.pi, "3.1415"))) == "digits = 3.1415: printed 3.1415, true 3.14159265359..."


def test_a_table_has_a_case_for_each_number():
    roots = sp.Tuple(*(sp.CRootOf(sp.legendre_poly(3, x), j) for j in range(3)))
    table = formula(sp.Eq(roots, sp.Tuple(*map(Digits, ("-0.7746", "0.0000", "0.7747"))), evaluate=False))
    assert [case.true for case in digits().cases(table)] == [True, True, False]
    assert str(digits().search(table)).startswith("digits = 0.7747")
    short = formula(sp.Eq(roots, sp.Tuple(Digits("1")), evaluate=False))
    with pytest.raises(UnsuitableError, match="found 3 numbers and 1"):
        list(digits().cases(short))


def test_each_digit_is_mistaken_in_turn():
    result = try_mutants(Part(digits(), printed(sp.Symbol("c"), "0.55228")))
    assert result.kinds["digit"] == 6
    meant = digits(where={sp.Symbol("c"): 4 * (sp.sqrt(2) - 1) / 3})
    assert try_mutants(Part(meant, printed(sp.Symbol("c"), "0.55228"))).survivors == ()


def test_the_unit_is_that_of_the_last_place():
    assert [Digits(text).unit for text in ("1", "1.0", "12e2", "1.2e-3", "0.550")] == [
        1, sp.Rational(1, 10), 100, sp.Rational(1, 10**4), sp.Rational(1, 1000),
    ]  # fmt: skip
    assert as_digits(sp.Integer(12345), sp.Integer(10)) == "12350"
    assert as_digits(sp.Rational(Fraction(1, 30000)), sp.Rational(1, 10**6)) == "0.000033"


@pytest.mark.parametrize("text", ["", "1.2.3", "0.5x", "1/3", "three", "1,5"])
def test_what_is_no_decimal_is_refused(text):
    with pytest.raises(UnsuitableError, match="expected a decimal number"):
        Digits(text)


def test_a_number_with_letters_is_refused():
    with pytest.raises(UnsuitableError, match="found the letters x"):
        list(digits().cases(printed(2 * x, "1.0")))
    with pytest.raises(UnsuitableError, match="found 'up'"):
        digits("up")
