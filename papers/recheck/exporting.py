"""Making statements: their variables, the factors of their denominators, and an instance for `fractions`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from itertools import chain
from typing import Any

import sympy as sp
from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix

from semispline.papers.recheck.arithmetic import TextError, divisors, instance, names, satisfied, value
from semispline.papers.recheck.by_series import series_of
from semispline.papers.recheck.rooted import defined_with_roots
from semispline.papers.recheck.statements import (
    Coefficient,
    Contained,
    Identity,
    Knots,
    Matrices,
    Minimum,
    Number,
    Positive,
    Rank,
    Term,
)
from semispline.papers.recheck.texts import NotExpressibleError, Spelled, function_text, lets, number_text, text

Where = Mapping[Any, Any] | Sequence[tuple[str, str]]


def identity(
    label: str,
    left: Any,
    right: Any,
    *,
    equal: bool = True,
    where: Where = (),
    conditions: Sequence[str] = (),
    roots: Sequence[tuple[Any, Any, int]] = (),
    meaning: Mapping[Any, Any] | None = None,
    **flags: Any,
) -> Identity:
    """Return the statement that both sides are the same, or are not.

    Parameters
    ----------
    left, right : SymPy expression, text or number
    equal : bool
    where : mapping or pairs
        What letters stand for; later ones may use earlier ones.
    conditions : sequence of str
        What an instance has to satisfy, such as "u_1 > 0".
    roots : sequence of (letter, expression, int)
        Letters of which a power is known, and which power; for sides that are equal.
    meaning : mapping, optional
        Letter -> what it stands for, for a reader.
    flags
        own, meets, wanted.

    Raises
    ------
    NotExpressibleError
        The variables have no instance at which all denominators are defined.
    """
    pairs = _needed(_pairs(where), [text(left), text(right), *_condition_sides(conditions)])
    sides = text(left), text(right)
    known = tuple((text(letter), text(radicand), degree) for letter, radicand, degree in roots)
    variables, nonzero = _read(pairs, (*sides, *_condition_sides(conditions), *(r for _, r, _ in known)))
    conditions = tuple(conditions)

    def fits(at: Mapping[str, Fraction]) -> bool:
        if known and not defined_with_roots(*sides, known, at):
            return False
        return all(satisfied(c, at) for c in conditions) and (equal or value(sides[0], at) != value(sides[1], at))

    at = _instance(label, variables, pairs, nonzero, fits)
    return Identity(
        label=label,
        left=sides[0],
        right=sides[1],
        equal=equal,
        variables=variables,
        where=pairs,
        nonzero=nonzero,
        conditions=conditions,
        roots=known,
        meaning=tuple((text(letter), str(what)) for letter, what in (meaning or {}).items()),
        at=at,
        **flags,
    )


def different(label: str, left: Any, right: Any, **more: Any) -> Identity:
    """Return the statement that both sides differ, which makes the case false unless `wanted` says otherwise."""
    return identity(label, left, right, equal=False, **more)


def not_zero(label: str, expression: Any, **more: Any) -> Identity:
    """Return the statement that an expression is not zero, which makes the case true."""
    return identity(label, expression, 0, equal=False, wanted=False, **more)


def positive(
    label: str,
    expression: Any,
    *,
    positive: Sequence[Any] = (),
    nonnegative: Sequence[Any] = (),
    over: Sequence[Term] = (),
    under: Sequence[Term] = (Term(coefficient="1"),),
    where: Where = (),
    strict: bool = True,
    among: Mapping[Any, Any] | None = None,
    **flags: Any,
) -> Positive:
    """Return the statement that an expression is positive, or not negative, for letters with these signs.

    Without `over`, numerator and denominator have no negative coefficient. `among` is an instance, where the signs
    hold for few numbers.
    """
    used = {name for term in (*over, *under) for name, _ in term.powers}
    pairs = _needed(_pairs(where), [text(expression), *sorted(used)])
    if not over:
        numerator, denominator = sp.fraction(sp.cancel(_in_sympy(text(expression), pairs)))
        parts = [_terms(numerator), _terms(denominator)]
        if any(Fraction(term.coefficient) <= 0 for term in parts[1]):
            parts = [_terms(-numerator), _terms(-denominator)]
        over, under = tuple(parts[0]), tuple(parts[1])
    squares = [square for term in (*over, *under) for square in term.squares]
    powers = {name for term in (*over, *under) for name, _ in term.powers}
    variables, nonzero = _read(pairs, (text(expression), *squares, *sorted(powers)))
    signs = tuple(map(text, positive)), tuple(map(text, nonnegative))
    known = [*signs[0], *signs[1]]

    def fits(at: Mapping[str, Fraction]) -> bool:
        return all(at[name] > 0 for name in known if name in at)

    at = (
        _instance(label, variables, pairs, nonzero, fits)
        if among is None
        else tuple((text(letter), str(Fraction(number))) for letter, number in among.items())
    )
    return Positive(
        label=label,
        left=text(expression),
        over=tuple(over),
        under=tuple(under),
        positive=signs[0],
        nonnegative=signs[1],
        strict=strict,
        variables=variables,
        where=pairs,
        nonzero=nonzero,
        at=at,
        affirmed=flags.pop("affirmed", True),
        **flags,
    )


def _terms(polynomial: Any) -> list[Term]:
    polynomial = sp.sympify(polynomial)
    letters = sorted(polynomial.free_symbols, key=str)
    if not letters:
        return [Term(coefficient=text(polynomial))]
    return [
        Term(
            coefficient=text(coefficient),
            powers=tuple((letter.name, int(n)) for letter, n in zip(letters, powers, strict=True) if n),
        )
        for powers, coefficient in sp.Poly(polynomial, *letters).terms()
    ]


def rank(label: str, matrix: Any, *, affirmed: bool = True, **flags: Any) -> Rank:
    """Return the statement of the rank of a matrix of rational numbers or functions."""
    matrix = sp.Matrix(matrix)
    entries = tuple(tuple(map(text, matrix.row(i))) for i in range(matrix.rows))
    _, columns = matrix.rref()
    _, rows = matrix[:, list(columns)].T.rref()
    free = tuple(j for j in range(matrix.cols) if j not in columns)
    kernel = [[sp.Integer(0)] * len(free) for _ in range(matrix.cols)]
    reduced = matrix.rref()[0]
    for place, j in enumerate(free):
        kernel[j][place] = sp.Integer(1)
        for r, i in enumerate(columns):
            kernel[i][place] = -reduced[r, j]
    vectors = tuple(tuple(map(text, row)) for row in kernel) if free else ()
    texts = [entry for row in (*entries, *vectors) for entry in row]
    variables, nonzero = _read((), texts)
    at = _instance(label, variables, (), nonzero, lambda _: True)
    return Rank(
        label=label,
        matrix=entries,
        rank=len(columns),
        rows=tuple(rows),
        columns=tuple(columns),
        kernel=vectors,
        free=free,
        affirmed=affirmed,
        variables=variables,
        nonzero=nonzero,
        at=at,
        **flags,
    )


def contained(label: str, outer: Any, inner: Any, *, wanted: bool = True, **flags: Any) -> Contained:
    """Return the statement whether columns of numbers are combinations of others."""
    one, other = (_domain(x) for x in (outer, inner))
    texts = tuple(tuple(tuple(map(text, row)) for row in x.to_Matrix().tolist()) for x in (one, other))
    whole = one.hstack(other)
    reduced, pivots = whole.rref()
    size = one.shape[1]
    if all(pivot < size for pivot in pivots):
        solution = [["0"] * other.shape[1] for _ in range(size)]
        for r, pivot in enumerate(pivots):
            for j in range(other.shape[1]):
                solution[pivot][j] = text(_rational(reduced[r, size + j].element))
        return Contained(
            label=label, outer=texts[0], inner=texts[1], solution=tuple(map(tuple, solution)), wanted=wanted, **flags
        )
    # A row that sends the first columns to zero, and not all of the second ones.
    for row in one.transpose().nullspace().to_Matrix().tolist():
        if any(
            sum(a * b for a, b in zip(row, column, strict=True)) for column in other.transpose().to_Matrix().tolist()
        ):
            separator = tuple(map(text, row))
            return Contained(label=label, outer=texts[0], inner=texts[1], separator=separator, wanted=wanted, **flags)
    raise NotExpressibleError(f"{label}: found neither a solution nor what separates the columns")


def minimum(label: str, matrix: Any, **flags: Any) -> Minimum:
    """Return the statement that a symmetric matrix of numbers is positive definite."""
    rows = [[_rational(x.element) for x in row] for row in _elements(_domain(matrix))]
    size = len(rows)
    lower = [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]
    pivots = []
    work = [list(row) for row in rows]
    for n in range(size):
        pivots.append(work[n][n])
        for r in range(n + 1, size):
            factor = work[r][n] / work[n][n]
            lower[r][n] = factor
            work[r] = [a - factor * b for a, b in zip(work[r], work[n], strict=True)]
    as_texts = [tuple(tuple(map(text, row)) for row in x) for x in (rows, lower)]
    return Minimum(label=label, matrix=as_texts[0], lower=as_texts[1], pivots=tuple(map(text, pivots)), **flags)


def matrices(
    label: str, left: str, right: str, named: Mapping[str, Any], *, equal: bool = True, **flags: Any
) -> Matrices:
    """Return the statement that two expressions of matrices are the same, or are not.

    Parameters
    ----------
    left, right : str
        Texts of names, such as "m1^-1*m2*m1".
    named : mapping
        Name -> explicit matrix.
    equal : bool
    """
    entries = {
        name: tuple(tuple(map(text, matrix.row(i))) for i in range(matrix.rows)) for name, matrix in named.items()
    }
    texts = [entry for rows in entries.values() for row in rows for entry in row]
    variables, nonzero = _read((), texts)
    inverted = {d for side in (left, right) for d in divisors(side) if d in named}
    sides = [value(side, named, sp.Integer) for side in (left, right)]
    apart = sides[0] - sides[1]

    def fits(at: Mapping[str, Fraction]) -> bool:
        exact = {sp.Symbol(name): sp.Rational(number.numerator, number.denominator) for name, number in at.items()}
        there = {name: named[name].xreplace(_by_text(named[name], exact)) for name in inverted}
        if any(matrix.det() == 0 for matrix in there.values()):
            return False
        return equal or not apart.xreplace(_by_text(apart, exact)).is_zero_matrix

    at = _instance(label, variables, (), nonzero, fits)
    return Matrices(
        label=label,
        matrices=tuple(entries.items()),
        left=left,
        right=right,
        equal=equal,
        variables=variables,
        nonzero=nonzero,
        at=at,
        **flags,
    )


def _by_text(matrix: Any, values: Mapping[Any, Any]) -> dict[Any, Any]:
    """Return what letters of a matrix are, by the text that stands for them."""
    return {letter: values[sp.Symbol(text(letter))] for letter in matrix.free_symbols}


def number(label: str, expression: Any, low: Any, high: Any, *, inside: bool = True, **flags: Any) -> Number:
    """Return the statement that a number is between two fractions, or outside of them.

    Raises
    ------
    NotExpressibleError
        The number has letters, or functions that are not known.
    """
    return Number(label=label, left=number_text(expression), low=text(low), high=text(high), inside=inside, **flags)


def series(
    label: str, left: Any, right: Any, variable: Any, power: int, *, equal: bool = True, **flags: Any
) -> Coefficient:
    """Return the statement that a power of a variable has the same factor in two power series at 0, or another one.

    Raises
    ------
    NotExpressibleError
        A side has no such series with rational coefficients.
    """
    sides = [function_text(side) for side in (left, right)]
    others = sorted(set().union(*(names(side) for side in sides)) - {text(variable)})

    def fits(at: Mapping[str, Fraction]) -> bool:
        try:
            one, other = (series_of(side, text(variable), power + 1, at)[-1] for side in sides)
        except TextError as error:
            raise NotExpressibleError(f"{label}: {error}") from None
        return equal or one != other

    at = _instance(label, others, (), (), fits)
    return Coefficient(
        label=label,
        left=sides[0],
        right=sides[1],
        variable=text(variable),
        power=power,
        equal=equal,
        variables=tuple(others),
        at=at,
        **flags,
    )


def knots(label: str, numbers: Iterable[Any], fact: str, *, holds: bool = True, **more: Any) -> Knots:
    """Return the statement of a fact about printed numbers."""
    other = tuple(map(text, more.pop("other", ())))
    return Knots(label=label, numbers=tuple(map(text, numbers)), fact=fact, other=other, holds=holds, **more)


def _domain(matrix: Any) -> DomainMatrix:
    if isinstance(matrix, DomainMatrix):
        return matrix.convert_to(QQ)
    return DomainMatrix.from_Matrix(sp.Matrix(matrix)).convert_to(QQ)


def _elements(matrix: DomainMatrix) -> list[list[Any]]:
    return [[matrix[i, j] for j in range(matrix.shape[1])] for i in range(matrix.shape[0])]


def _rational(element: Any) -> Fraction:
    return Fraction(int(element.numerator), int(element.denominator))


def _pairs(where: Where) -> tuple[tuple[str, str], ...]:
    return lets(where) if isinstance(where, Mapping) else tuple(where)


def _condition_sides(conditions: Iterable[str]) -> list[str]:
    return [side.strip() for condition in conditions for side in re.split("[<>=!]+", condition)]


def _needed(pairs: tuple[tuple[str, str], ...], texts: Iterable[str]) -> tuple[tuple[str, str], ...]:
    """Return those pairs that the texts use, directly or by way of others."""
    used = set().union(*(names(x) for x in texts))
    kept = []
    for name, meaning in reversed(pairs):
        if name in used:
            kept.append((name, meaning))
            used |= names(meaning)
    return tuple(reversed(kept))


def _read(pairs: Sequence[tuple[str, str]], texts: Iterable[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the variables of texts, and the irreducible factors of all that they divide by."""
    every = [meaning for _, meaning in pairs] + list(texts)
    defined = {name for name, _ in pairs}
    found: dict[str, None] = {}
    seen: set[str] = set()
    for name, meaning in pairs:
        found.update(dict.fromkeys(sorted(names(meaning) - seen)))
        seen.add(name)
    found.update(dict.fromkeys(sorted(set().union(*(names(x) for x in texts)) - defined)))
    factors: dict[str, None] = {}
    for divisor in dict.fromkeys(chain.from_iterable(map(divisors, every))):
        factors.update(dict.fromkeys(_irreducible(divisor, _needed(tuple(pairs), [divisor]))))
    # One and the same factor up to its sign stands once.
    once: list[str] = []
    for factor in factors:
        if _negative(factor) not in once:
            once.append(factor)
    return tuple(found), tuple(once)


@cache
def _irreducible(divisor: str, pairs: tuple[tuple[str, str], ...]) -> tuple[str, ...]:
    """Return the irreducible factors of a divisor, those of its own denominator too."""
    parts = sp.fraction(sp.cancel(_in_sympy(divisor, pairs)))
    return tuple(text(factor) for part in parts for factor, _ in sp.factor_list(part)[1])


@cache
def _negative(factor: str) -> str:
    return text(-_in_sympy(factor, ()))


def _in_sympy(expression: str, pairs: Sequence[tuple[str, str]]) -> Any:
    """Return a text as a SymPy expression of its variables."""
    meaning = dict(pairs)

    def letter(name: str) -> Any:
        return read(meaning[name]) if name in meaning else Spelled(name)

    def read(source: str) -> Any:
        return value(source, {name: letter(name) for name in names(source)}, sp.Integer)

    return read(expression)


# Small numbers in an order in which neighbours differ; what is searched is how far along each variable starts.
_SMALL = [Fraction(n) for n in (1, 2, 3, 5, 4, 7, 6, 9, 11, 8)]
_SHARES = [Fraction(1, n) for n in (2, 3, 5, 4, 7)] + [Fraction(2, 3), Fraction(3, 5), Fraction(5, 7)]


def _instance(
    label: str,
    variables: Sequence[str],
    pairs: Sequence[tuple[str, str]],
    nonzero: Sequence[str],
    fits: Callable[[Mapping[str, Fraction]], bool],
) -> tuple[tuple[str, str], ...]:
    """Return rational values of the variables at which nothing vanishes that must not, and `fits` holds.

    Where none fits but some are allowed, those are returned: that what is stated is wrong is found by who decides it.
    """
    allowed = None
    for values in _candidates(len(variables)):
        at = tuple((name, str(number)) for name, number in zip(variables, values, strict=True))
        try:
            every = instance(at, pairs)
            if all(value(factor, every) != 0 for factor in nonzero):
                allowed = allowed or at
                if fits(every):
                    return at
        except ZeroDivisionError:
            continue
    if allowed is None:
        raise NotExpressibleError(f"{label}: found no instance for {', '.join(variables)}, expected one")
    return allowed


def _candidates(count: int) -> Iterator[list[Fraction]]:
    """Yield values: ascending ones, descending ones, shares of one, and mixtures."""
    numbers = [*_SMALL, *(Fraction(n) for n in range(12, 12 + count))]
    shares = [*_SHARES, *(Fraction(n, n + 1) for n in range(7, 7 + count))]
    yield from ([*line[:count]] for line in (numbers, numbers[::-1][-count:] if count else numbers, shares))
    state = 1
    for _ in range(1000):
        line = []
        for _ in range(count):
            # A small linear congruence: the same instances at each run.
            state = (state * 1103515245 + 12345) % 2**31
            pick = (state >> 8) % 24
            line.append(shares[pick % 8] if pick < 12 else numbers[pick % 10] * (-1 if pick > 21 else 1))
        yield line
