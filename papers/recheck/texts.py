"""From SymPy to text, and texts that are put together without being simplified."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
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
_RESERVED |= {"put_in", "rooted", "same_over", "real_root"}
_RESERVED |= {"inner", "clamped", "single", "asked", "agreed", "check", "if", "my", "for", "x_", "fun", "let", "in"}
# Words of small letters may be functions of PARI, of which there are a thousand; these letters are none.
_WORD = re.compile(r"[a-z][a-z0-9]*[a-z][a-z0-9]*")
_GREEK = {
    "alpha",
    "beta",
    "delta",
    "epsilon",
    "iota",
    "kappa",
    "mu",
    "nu",
    "xi",
    "rho",
    "tau",
    "phi",
    "chi",
    "pi",
    "ell",
}
_SPELLED = {"+": "_plus_", "-": "_less_", "'": "_prime", "^": "_", ",": "_", " ": "_", ".": "_dot_"}


class NotExpressibleError(InputError):
    """An expression that is not a rational function of its letters."""


class Spelled(sp.Symbol):  # type: ignore[misc]  # SymPy has no types
    """A letter that came from a text, where its name is one that all systems read."""


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


def number_text(number: Any) -> str:
    """Return a SymPy expression without letters as text, with the functions of `arithmetic.FUNCTIONS`.

    Raises
    ------
    NotExpressibleError
        It has a letter, or another function.

    Examples
    --------
    >>> number_text(sp.sqrt(2) * sp.cos(sp.pi / 8) - sp.E)
    'sqrt(2)*sqrt(sqrt(2)/4 + 1/2) - exp(1)'
    >>> number_text(sp.CRootOf(sp.Symbol("t") ** 3 - 2, 0))
    'real_root(x_^3 - 2, 1)'
    """
    if number.free_symbols:
        raise NotExpressibleError(f"number: found the letters {number.free_symbols}, expected none")
    return str(_number_written(number))


def function_text(expression: Any) -> str:
    """Return a SymPy expression with letters as text, with the functions of `arithmetic.FUNCTIONS`.

    Raises
    ------
    NotExpressibleError
        It has another function.

    Examples
    --------
    >>> a, x = sp.symbols("a x")
    >>> function_text(sp.sin(a * x) / sp.sqrt(1 + x))
    '1/sqrt(x + 1)*sin(a*x)'
    """
    return str(_number_written(expression))


def _number_written(e: Any) -> Text:  # noqa: PLR0911  # one for each kind of node
    if e.is_Rational:
        return _number(Fraction(int(e.p), int(e.q)))
    if e.is_Symbol:
        return Text(name_of(_letter(e)))
    if e in (sp.pi, sp.E):
        return Text("Pi") if e is sp.pi else Text("exp(1)")
    if e.is_Add:
        return _sum(e, _number_written)
    if e.is_Mul:
        return _product(e, _number_written)
    if e.is_Pow and e.exp.is_Integer:
        return _number_written(e.base) ** int(e.exp)
    if e.is_Pow and e.base is sp.E:
        return Text(f"exp({function_text(e.exp)})")
    if e.is_Pow and e.exp.is_Rational:
        base, degree = function_text(e.base), int(e.exp.q)
        root = Text(f"sqrt({base})" if degree == 2 else f"sqrtn({base}, {degree})")
        return root ** int(e.exp.p)
    if isinstance(e, sp.CRootOf) and e.is_real:
        # SymPy counts real roots from 0, before the others.
        polynomial = e.poly.as_expr().xreplace({e.poly.gen: _ROOT})
        return Text(f"real_root({_written_with(polynomial)}, {e.index + 1})")
    name = _FUNCTION_NAMES.get(type(e))
    if name is None:
        raise NotExpressibleError(f"number: found {e}, expected one without letters, of elementary functions")
    return Text(f"{name}({function_text(e.args[0])})")


_ROOT = sp.Symbol("x_")
_FUNCTION_NAMES = {kind: kind.__name__ for kind in (sp.exp, sp.log, sp.sin, sp.cos, sp.tan, sp.asin, sp.acos, sp.atan)}


def _written_with(polynomial: Any) -> str:
    """Return a polynomial in x_, whose name no letter of a paper has."""
    return str(_written(polynomial)).replace(name_of("x_"), "x_")


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
    taken = spelled in _RESERVED or (_WORD.fullmatch(spelled) and spelled not in _GREEK)
    return spelled + "_" if taken else spelled


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
    return Text(expression.name if isinstance(expression, Spelled) else name_of(_letter(expression)))


def _letter(expression: Any) -> str:
    """Return the letter of a symbol, of a value of a function or of an entry."""
    if expression.is_Symbol:
        return str(expression.name)
    if isinstance(expression, sp.core.function.AppliedUndef):
        return "_".join([expression.func.__name__, *(name_of(str(a)) for a in expression.args)])
    if isinstance(expression, sp.Indexed):
        return "_".join([str(expression.base), *(name_of(str(a)) for a in expression.indices)])
    raise NotExpressibleError(f"expression: found {expression}, expected a rational function")


def _sum(expression: Any, written: Callable[[Any], Text] | None = None) -> Text:
    written = written or _written
    # Positive terms first and numbers last, as one writes them.
    terms = sorted(expression.args, key=lambda term: (term.could_extract_minus_sign(), bool(term.is_Number)))
    found = written(terms[0])
    for term in terms[1:]:
        found = found - written(-term) if term.could_extract_minus_sign() else found + written(term)
    return found


def _product(expression: Any, written: Callable[[Any], Text] | None = None) -> Text:
    written = written or _written
    over, under = [], []
    for factor in expression.args:
        if factor.is_Pow and factor.exp.is_Integer and factor.exp < 0:
            under.append(written(factor.base ** (-factor.exp)))
        elif factor.is_Rational and not factor.is_Integer:
            over += [] if factor.p == 1 else [_number(Fraction(int(factor.p)))]
            under.append(_number(Fraction(int(factor.q))))
        else:
            over.append(written(factor))
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
