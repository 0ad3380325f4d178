"""Printed decimals: whether a number is right to the digits shown, rounded or cut off, which are told apart."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any, Literal, TypeAlias

import sympy as sp
from flint import arb, fmpq

from semispline.papers.checks.carrying_out import UnsuitableError, carried_out
from semispline.papers.checks.counterexamples import shown_value
from semispline.papers.checks.enclosures import BITS, MOST_BITS, enclosure, exact_value, precision, value_at
from semispline.papers.checks.instances import Meanings, meanings_at
from semispline.papers.ledger import (
    Case,
    Check,
    CheckFailedError,
    Counterexample,
    Formula,
    Strength,
    UndefinedError,
    given,
)
from semispline.papers.recheck import Statement, number

# How the last digit comes about.
Ending: TypeAlias = Literal["rounded", "cut"]

# Of what is left where digits are wrong.
_PLACES = 12
_NUMERAL = re.compile(r"[+-]?\d+(\.\d*)?([eE][+-]?\d+)?|[+-]?\.\d+([eE][+-]?\d+)?")


class Digits(sp.Basic):
    """A number as it is printed, with all its digits: Digits("0.55228"), Digits("2.7253e-4").

    Raises
    ------
    UnsuitableError
        It is no decimal number.

    Examples
    --------
    >>> str(Digits("0.5500").exact), Digits("0.5500").unit
    ('11/20', 1/10000)
    """

    def __new__(cls, text: str | Any) -> Digits:
        """Return the number with this text."""
        text = str(text)
        if not _NUMERAL.fullmatch(text):
            raise UnsuitableError(f"Digits({text!r}): expected a decimal number as text, such as '0.55228' or '2.7e-4'")
        return super().__new__(cls, sp.core.symbol.Str(text))

    @property
    def text(self) -> str:
        """As printed."""
        return str(self.args[0])

    @property
    def exact(self) -> Any:
        """The number that the digits are, as a SymPy rational."""
        return sp.Rational(self.text)

    @property
    def unit(self) -> Any:
        """One in the last place shown."""
        mantissa, _, exponent = self.text.lower().partition("e")
        places = len(mantissa.partition(".")[2])
        return sp.Integer(10) ** (int(exponent or 0) - places)

    def changes(self) -> Iterator[tuple[str, Digits]]:
        """Yield numbers with one digit one more: what a misprint may be."""
        mantissa, mark, exponent = self.text.lower().partition("e")
        for i, digit in enumerate(mantissa):
            if digit.isdecimal():
                changed = str((int(digit) + 1) % 10)
                yield "digit", Digits(f"{mantissa[:i]}{changed}{mantissa[i + 1 :]}{mark}{exponent}")

    def _sympystr(self, _printer: Any) -> str:
        return self.text

    def _latex(self, _printer: Any) -> str:
        return self.text

    def _mathml(self, printer: Any) -> Any:
        leaf = printer.dom.createElement("mn")
        leaf.appendChild(printer.dom.createTextNode(self.text))
        return leaf


def digits(ending: Ending = "rounded", *, where: Meanings | None = None, method: str = "") -> Check:
    """Return the check that printed decimals are right to the last digit shown.

    A formula is an equation between an exact number and `Digits`, or between tuples of both.

    Parameters
    ----------
    ending : str
        "rounded": the number is at most half a unit of its last place away from the exact one. "cut": it is what is
        left of the exact one when later digits are dropped.
    where : mapping, optional
        What letters stand for.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> printed = formula(sp.Eq(sp.pi, Digits("3.1415"), evaluate=False))
    >>> [[case.true for case in digits(ending).cases(printed)] for ending in ("rounded", "cut")]
    [[False], [True]]
    """
    if ending not in _IS_RIGHT:
        raise UnsuitableError(f"digits: found {ending!r}, expected one of {', '.join(_IS_RIGHT)}")

    def cases(formula: Formula | None) -> Iterator[Case]:
        for exact, printed in _pairs(given(formula), where):
            yield _case(exact, printed, ending)

    def search(formula: Formula) -> Counterexample | None:
        for exact, printed in _pairs(formula, where):
            if not _case(exact, printed, ending).true:
                return Counterexample((("digits", printed.text),), printed.text, _shown(exact))
        return None

    def export(formula: Formula | None) -> Iterator[Statement]:
        for exact, printed in _pairs(given(formula), where):
            case = _case(exact, printed, ending)
            low, high = _limits(exact, printed, ending)
            yield number(case.label, exact, low, high, inside=bool(case.true))

    standard = f"an enclosure of the exact number against the digits shown, the last one {_WORDS[ending]}"
    return Check(cases, Strength.RATIONAL, method or standard, proof=True, search=search, export=export)


_WORDS = {"rounded": "rounded", "cut": "cut off"}


def _pairs(formula: Formula, where: Meanings | None) -> Iterator[tuple[Any, Digits]]:
    """Yield exact numbers and the digits that are printed for them."""
    one, other = formula.relation.args
    if isinstance(one, Digits) or (isinstance(one, sp.Tuple) and one.has(Digits)):
        one, other = other, one
    ones, others = ([*side] if isinstance(side, sp.Tuple) else [side] for side in (one, other))
    if len(ones) != len(others):
        raise UnsuitableError(f"{formula.relation}: found {len(ones)} numbers and {len(others)}, expected as many")
    for exact, printed in zip(ones, others, strict=True):
        if not isinstance(printed, Digits) or isinstance(exact, Digits):
            raise UnsuitableError(f"{formula.relation}: found {printed}, expected Digits on one side")
        value = carried_out(exact, meanings_at(where, {}))
        if value.free_symbols:
            letters = ", ".join(sorted(map(str, value.free_symbols)))
            raise UnsuitableError(f"{exact}: found the letters {letters}, expected a number (where=... says which)")
        yield value, printed


def _case(exact: Any, printed: Digits, ending: Ending) -> Case:
    try:
        right = _is_right(exact, printed, ending)
        shown = _shown(exact)
    except UndefinedError as error:
        return Case(printed.text, False, residual=sp.Symbol(f"undefined: {error}"))
    if right:
        return Case(f"{printed.text} for {shown}", True)
    better = [f"{_WORDS[e]} {as_digits(exact, printed.unit, e)}" for e in _IS_RIGHT]
    return Case(f"{printed.text} for {shown} ({', '.join(better)})", False, residual=_apart(exact, printed))


def _apart(exact: Any, printed: Digits) -> Any:
    """Return how far the digits are from the number, as a fraction or with the digits that are certain."""
    value = exact_value(exact, {})
    if value is not None:
        return printed.exact - sp.Rational(value.numerator, value.denominator)
    with precision(MOST_BITS):
        return Digits((_ball(printed.exact) - enclosure(exact)).str(_PLACES, radius=False))


def _is_right(exact: Any, printed: Digits, ending: Ending) -> bool:
    """Decide with balls that get smaller, or exactly where the number is rational."""
    number, unit = printed.exact, printed.unit
    value = exact_value(exact, {})
    if value is not None:
        return bool(_IS_RIGHT[ending](sp.Rational(value), number, unit))
    bits = BITS
    while bits <= MOST_BITS:
        with precision(bits):
            found = _IS_RIGHT[ending](enclosure(exact), _ball(number), _ball(unit))
        if found is not None:
            return found
        bits *= 2
    raise CheckFailedError(f"{printed.text}: cannot be told from the limit of what is right, {exact}")


def _limits(exact: Any, printed: Digits, ending: Ending) -> tuple[Any, Any]:
    """Return the numbers between which the exact one is where the digits are right."""
    number, unit = printed.exact, printed.unit
    if ending == "rounded":
        return number - unit / 2, number + unit / 2
    if number == 0:
        return -unit, unit
    return (number, number + unit) if number > 0 else (number - unit, number)


def _ball(number: Any) -> Any:
    return arb(fmpq(int(number.p), int(number.q)))


def _rounded(value: Any, number: Any, unit: Any) -> bool | None:
    return _at_most(2 * abs(value - number), unit)


def _cut(value: Any, number: Any, unit: Any) -> bool | None:
    """Tell whether a number is between 0 and the value, and less than a unit from it."""
    same_side = _at_most(abs(number), abs(value)), _at_most(0 * value, value * number)
    near = _at_most(abs(number) + unit, abs(value))
    if False in same_side or near is True:
        return False
    return None if None in same_side or near is None else True


def _at_most(one: Any, other: Any) -> bool | None:
    """Compare numbers or balls; None where balls overlap."""
    if one <= other:
        return True
    return False if one > other else None


_IS_RIGHT: dict[Ending, Callable[[Any, Any, Any], bool | None]] = {"rounded": _rounded, "cut": _cut}


def _shown(exact: Any) -> str:
    return shown_value(value_at(exact, {}))


def as_digits(exact: Any, unit: Any, ending: Ending = "rounded") -> str:
    """Return an exact number as a decimal with a last place.

    Examples
    --------
    >>> as_digits(sp.pi, sp.Rational(1, 1000)), as_digits(-sp.pi, sp.Rational(1, 1000), "cut")
    ('3.142', '-3.141')
    """
    with precision(MOST_BITS):
        scaled = enclosure(exact) / _ball(unit)
        middle = Fraction(str(scaled.mid().fmpq()))
    whole = abs(middle)
    number = int(whole + Fraction(1, 2)) if ending == "rounded" else int(whole)
    places = max(0, -round(sp.log(unit, 10)))
    text = str(number).rjust(places + 1, "0")
    shown = f"{text[:-places]}.{text[-places:]}" if places else str(number * int(unit))
    return f"-{shown}" if middle < 0 and number else shown
