"""The rechecking process's own arithmetic: roots, intervals and series, against known values."""

from fractions import Fraction

import pytest

from semispline.papers.recheck.arithmetic import TextError
from semispline.papers.recheck.by_intervals import enclosed
from semispline.papers.recheck.by_series import series_of
from semispline.papers.recheck.rooted import equal_with_roots

# Twenty digits, from tables.
KNOWN = {
    "Pi": "3.14159265358979323846",
    "exp(1)": "2.71828182845904523536",
    "exp(-3)": "0.04978706836786394297",
    "log(2)": "0.69314718055994530941",
    "log(1/1000)": "-6.90775527898213705205",
    "sqrt(2)": "1.41421356237309504880",
    "sqrtn(2, 3)": "1.25992104989487316476",
    "sin(1)": "0.84147098480789650665",
    "cos(7)": "0.75390225434330463814",
    "tan(1)": "1.55740772465490223050",
    "atan(5)": "1.37340076694501586086",
    "asin(1/3)": "0.33983690945412193709",
    "acos(1/3)": "1.23095941734077468213",
    "real_root(63*x_^5 - 70*x_^3 + 15*x_, 5)": "0.90617984593866399279",
    "real_root((x_ - 1)^2*(x_ + 1)/4, 2)": "1.00000000000000000000",
    "-(2 + 1/3)^2/7^-1": "-38.11111111111111111111",
}


@pytest.mark.parametrize("text", KNOWN)
def test_an_interval_holds_the_number_and_is_narrow(text):
    found = enclosed(text)
    assert found.high - found.low < Fraction(1, 10**40)
    assert abs(found.low - Fraction(KNOWN[text])) < Fraction(1, 10**19)


@pytest.mark.parametrize(
    "text", ["1/(1 - 1)", "sqrt(-1)", "log(0)", "2^(1/2)", "x + 1", "real_root(x_^2 + 1, 1)", "erf(1)"]
)
def test_what_is_no_number_is_refused(text):
    with pytest.raises(TextError):
        enclosed(text)


def test_roots_are_put_in_whatever_they_are():
    at = {"x": Fraction(2)}
    assert equal_with_roots("r^3", "x*r", [("r", "x", 2)], at)
    assert equal_with_roots("1/(r - 1)", "(r + 1)/(x - 1)", [("r", "x", 2)], at)
    assert not equal_with_roots("r", "x", [("r", "x", 2)], at)
    # Nothing is divided by a root that is zero.
    assert not equal_with_roots("1/(r^2 - x)", "1", [("r", "x", 2)], at)


@pytest.mark.parametrize(
    ("text", "coefficients"),
    [
        ("exp(x)", "1 1 1/2 1/6 1/24"),
        ("cos(x)", "1 0 -1/2 0 1/24"),
        ("tan(x)", "0 1 0 1/3 0"),
        ("atan(2*x)", "0 2 0 -8/3 0"),
        ("asin(x)", "0 1 0 1/6 0"),
        ("log(1 + x)", "0 1 -1/2 1/3 -1/4"),
        ("sqrt(4 + x)", "2 1/4 -1/64 1/512 -5/16384"),
        ("(1 - x)^-2*a", "3 6 9 12 15"),
    ],
)
def test_series_have_their_known_coefficients(text, coefficients):
    assert series_of(text, "x", 5, {"a": Fraction(3)}) == list(map(Fraction, coefficients.split()))


@pytest.mark.parametrize("text", ["exp(1 + x)", "log(x)", "sqrt(x)", "1/x", "x^x", "sin(1)", "acos(x)"])
def test_what_has_no_such_series_is_refused(text):
    with pytest.raises(TextError):
        series_of(text, "x", 3, {})
