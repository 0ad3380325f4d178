"""From SymPy to text, and texts that are put together without being simplified."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.solver.errors import InputError

# What PARI and Coq read as something else.
_RESERVED = {
    "I",
    "O",
    "Pi",
    "Euler",
    "Catalan",
    "same",
    "is_number",
    "covered",
    "ranked",
    "signed",
    "refused",
    "definite",
    "increasing",
}
_RESERVED |= {"inner", "clamped", "single", "asked", "agreed", "check", "if", "my", "for", "x_", "fun", "let", "in"}
_SPELLED = {"+": "_plus_", "-": "_less_", "'": "_prime", "^": "_", ",": "_", " ": "_", ".": "_dot_"}


class NotExpressibleError(InputError):
    """An expression that is not a rational function of its letters."""


@dataclass(frozen=True)
class Text:
    """An expression as text: operators put texts together and simplify nothing.

    Examples
    --------
    >>> str((Text("x") + 1) / (2 * Text("y")) - Text("x") / Text("x"))
    '(x + 1)/(2*y) - x/x'
    """

    text: str
    # How tightly the outermost operator binds: 1 a sum, 2 a product or quotient, 3 a power, 4 a name.
    binding: int = 4

    def __str__(self) -> str:
        return self.text

    def at(self, binding: int) -> str:
        """Return the text, in brackets where its operator binds less than this."""
        return self.text if self.binding >= binding else f"({self.text})"

    def __add__(self, other: Any) -> Text:
        return Text(f"{self.at(1)} + {as_text(other).at(2)}", 1)

    def __radd__(self, other: Any) -> Text:
        return as_text(other) + self

    def __sub__(self, other: Any) -> Text:
        return Text(f"{self.at(1)} - {as_text(other).at(2)}", 1)

    def __rsub__(self, other: Any) -> Text:
        return as_text(other) - self

    def __neg__(self) -> Text:
        return Text(f"-{self.at(2)}", 1)

    def __mul__(self, other: Any) -> Text:
        return Text(f"{self.at(2)}*{as_text(other).at(3)}", 2)

    def __rmul__(self, other: Any) -> Text:
        return as_text(other) * self

    def __truediv__(self, other: Any) -> Text:
        return Text(f"{self.at(2)}/{as_text(other).at(3)}", 2)

    def __rtruediv__(self, other: Any) -> Text:
        return as_text(other) / self

    def __pow__(self, power: int) -> Text:
        if power < 0:
            return Text(f"1/{(self**-power).at(3)}", 2)
        if power == 1:
            return self
        return Text(f"{self.at(4)}^{power}", 3)


def as_text(value: Any) -> Text:
    """Return a number, a SymPy expression, a ring element or a text as text.

    Raises
    ------
    NotExpressibleError
        It is none of these, or not rational.
    """
    if isinstance(value, Text):
        return value
    if isinstance(value, int | Fraction):
        return _number(Fraction(value))
    if isinstance(value, str):
        return Text(value, 0 if re.search(r"\W", value) else 4)
    if isinstance(value, sp.Basic):
        return _written(value)
    if hasattr(value, "as_expr"):
        return _written(value.as_expr())
    raise NotExpressibleError(f"expression: found {type(value).__name__}, expected a rational function")


def text(value: Any) -> str:
    """Return `as_text` as a string."""
    return str(as_text(value))


def _number(number: Fraction) -> Text:
    if number.denominator == 1:
        return Text(str(number.numerator), 4 if number >= 0 else 1)
    return Text(f"{number.numerator}/{number.denominator}", 2 if number >= 0 else 1)


@cache
def name_of(letter: str) -> str:
    """Return a letter as a name that all systems read.

    Examples
    --------
    >>> name_of("u_{m-k+1}"), name_of("P_{m-1,j}"), name_of("f'_0"), name_of("I")
    ('u_m_less_k_plus_1', 'P_m_less_1_j', 'f_prime_0', 'I_')
    """
    spelled = letter.replace("{", "").replace("}", "").replace("\\", "")
    for sign, word in _SPELLED.items():
        spelled = spelled.replace(sign, word)
    spelled = re.sub(r"\W", "_", spelled)
    if not spelled[0].isalpha():
        spelled = "v" + spelled
    return spelled + "_" if spelled in _RESERVED else spelled


def _written(expression: Any) -> Text:
    """Return a SymPy expression as it stands."""
    if expression.is_Rational:
        return _number(Fraction(int(expression.p), int(expression.q)))
    if expression.is_Add:
        return _sum(expression)
    if expression.is_Mul:
        return _product(expression)
    if expression.is_Pow and expression.exp.is_Integer:
        return _written(expression.base) ** int(expression.exp)
    return Text(name_of(_letter(expression)))


def _letter(expression: Any) -> str:
    """Return the letter of a symbol, of a value of a function or of an entry."""
    if expression.is_Symbol:
        return str(expression.name)
    if isinstance(expression, sp.core.function.AppliedUndef):
        return "_".join([expression.func.__name__, *(name_of(str(a)) for a in expression.args)])
    if isinstance(expression, sp.Indexed):
        return "_".join([str(expression.base), *(name_of(str(a)) for a in expression.indices)])
    raise NotExpressibleError(f"expression: found {expression}, expected a rational function")


def _sum(expression: Any) -> Text:
    # Positive terms first and numbers last, as one writes them.
    terms = sorted(expression.args, key=lambda term: (term.could_extract_minus_sign(), bool(term.is_Number)))
    found = _written(terms[0])
    for term in terms[1:]:
        found = found - _written(-term) if term.could_extract_minus_sign() else found + _written(term)
    return found


def _product(expression: Any) -> Text:
    over, under = [], []
    for factor in expression.args:
        if factor.is_Pow and factor.exp.is_Integer and factor.exp < 0:
            under.append(_written(factor.base ** (-factor.exp)))
        elif factor.is_Rational and not factor.is_Integer:
            over += [] if factor.p == 1 else [_number(Fraction(int(factor.p)))]
            under.append(_number(Fraction(int(factor.q))))
        else:
            over.append(_written(factor))
    product = _multiplied(over)
    return product / _multiplied(under) if under else product


def _multiplied(factors: list[Text]) -> Text:
    if not factors:
        return Text("1")
    if len(factors) > 1 and factors[0].text == "-1":
        return -_multiplied(factors[1:])
    product = factors[0]
    for factor in factors[1:]:
        product = product * factor
    return product


def total(terms: Iterable[Any]) -> Text:
    """Return a sum as text, term by term.

    Examples
    --------
    >>> str(total([Text("x"), Text("y") * 2]))
    'x + y*2'
    """
    found: Text | None = None
    for term in terms:
        found = as_text(term) if found is None else found + term
    return found if found is not None else Text("0")


def lets(values: Mapping[Any, Any]) -> tuple[tuple[str, str], ...]:
    """Return letters and what they stand for."""
    return tuple((text(letter), text(value)) for letter, value in values.items())
