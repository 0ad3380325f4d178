"""Rational expression -> one line of Python or C, the same text at every run.

Only what the derivations need is printed: sums, products, whole powers, rational numbers, symbols. The spacing is that
of `ruff format`, so that generated files need no formatter.
"""

from __future__ import annotations

from typing import Literal

from sympy import Add, Expr, Integer, Mul, Pow, Rational, Symbol

Dialect = Literal["python", "c"]

# How tightly an expression binds: sum, product, power, atom.
_SUM, _PRODUCT, _POWER, _ATOM = range(4)


def expression_text(expression: Expr, dialect: Dialect = "python") -> str:
    """Return the text of a rational expression.

    Raises
    ------
    ValueError
        Anything but sums, products, whole powers, rational numbers and symbols.

    Examples
    --------
    >>> from sympy.abc import a, h, p
    >>> expression_text(1 - a * h**2 / (p * (p - 1)))
    '1 - a * h**2 / (p * (p - 1))'
    >>> expression_text(1 - a * h**2 / 3, "c")
    '1.0 - a * h * h / 3.0'
    """
    return _text(expression, dialect)[0]


def summands(expression: Expr, dialect: Dialect = "python") -> list[str]:
    """Return the lines of a sum, each but the first with its sign, for breaking a long line.

    Examples
    --------
    >>> from sympy.abc import a, h
    >>> summands(a - 2 * h)
    ['a', '- 2 * h']
    """
    lines: list[str] = []
    for term in _terms(expression):
        text = _parenthesised(term, _SUM, dialect)
        if not lines:
            lines.append(text)
        else:
            lines.append(f"- {text[1:]}" if text.startswith("-") else f"+ {text}")
    return lines


def _terms(expression: Expr) -> list[Expr]:
    """Return the terms in lexicographic order, a positive one first where there is one."""
    terms: list[Expr] = expression.as_ordered_terms()
    return sorted(terms, key=lambda term: bool(term.could_extract_minus_sign()))


def _text(expression: Expr, dialect: Dialect) -> tuple[str, int]:
    if isinstance(expression, Symbol):
        return expression.name, _ATOM
    if isinstance(expression, Rational):
        return _number(expression, dialect)
    if isinstance(expression, Add):
        return " ".join(summands(expression, dialect)), _SUM
    if isinstance(expression, Mul) or (isinstance(expression, Pow) and expression.exp.is_negative):
        return _product(expression, dialect), _PRODUCT
    if isinstance(expression, Pow) and isinstance(expression.exp, Integer):
        return _power(expression, dialect)
    raise ValueError(
        f"expression: found {expression} of type {type(expression).__name__}, expected a rational expression"
    )


def _number(number: Rational, dialect: Dialect) -> tuple[str, int]:
    point = ".0" if dialect == "c" else ""
    if number.q == 1:
        return f"{number.p}{point}", _ATOM if number.p >= 0 else _PRODUCT
    return f"{number.p}{point} / {number.q}{point}", _PRODUCT


def _power(power: Pow, dialect: Dialect) -> tuple[str, int]:
    base = _parenthesised(power.base, _ATOM, dialect)
    exponent = int(power.exp)
    if dialect == "c":
        return " * ".join([base] * exponent), _PRODUCT
    # ruff leaves no spaces around ** between plain names.
    return (f"{base}**{exponent}" if isinstance(power.base, Symbol) else f"{base} ** {exponent}"), _POWER


def _product(product: Expr, dialect: Dialect) -> str:
    coefficient, rest = product.as_coeff_Mul()
    above, below = [], []
    for factor in rest.as_ordered_factors():
        base, exponent = factor.as_base_exp()
        if exponent.is_negative:
            below.append(base ** (-exponent))
        elif factor != 1:
            above.append(factor)
    sign = "-" if coefficient < 0 else ""
    if abs(coefficient.p) != 1 or not above:
        above.insert(0, Integer(abs(coefficient.p)))
    if coefficient.q != 1:
        below.insert(0, Integer(coefficient.q))
    numerator = " * ".join(_parenthesised(factor, _PRODUCT, dialect) for factor in above)
    if not below:
        return sign + numerator
    denominator = " * ".join(_parenthesised(factor, _PRODUCT, dialect) for factor in below)
    if len(below) > 1 or _text(below[0], dialect)[1] == _PRODUCT:
        denominator = f"({denominator})"
    return f"{sign}{numerator} / {denominator}"


def _parenthesised(expression: Expr, least: int, dialect: Dialect) -> str:
    """Return the text, in brackets if it binds less tightly than `least` asks."""
    text, strength = _text(expression, dialect)
    return f"({text})" if strength < least else text
