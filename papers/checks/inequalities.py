"""Inequalities between rational functions on a box: proved by signs of exact Bernstein coefficients, or refuted.

A polynomial of degree 2 is completed to squares. Else it is written in Bernstein polynomials of the box; where no
coefficient is negative it is not negative there, and else the box is halved. Factors that occur an even number of times
are squares and are set aside first, so that zeros inside the box do not go on for ever. Squares may also be given.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from math import comb, prod
from typing import Any, TypeAlias

import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError, Where, carried_out
from semispline.papers.checks.instances import as_letters, letters_of
from semispline.papers.ledger import (
    Case,
    Check,
    CheckFailedError,
    Counterexample,
    Formula,
    Meaning,
    Strength,
    UndefinedError,
    given,
    interpret,
    mutants,
    smallest_assignment,
)
from semispline.papers.recheck import NotExpressibleError, Statement, Term, different, identity, positive, text

# Letter -> from where to where; None where there is no end.
Box: TypeAlias = Mapping[Any, tuple[Any, Any]]
_Interval: TypeAlias = tuple[Fraction | None, Fraction | None]
# Powers of the letters -> coefficient.
_Terms: TypeAlias = dict[tuple[int, ...], Fraction]

_MOST_BOXES = 1_000
# Largest numerator and denominator together of the numbers that a counterexample is searched among.
_HEIGHT = 14
# The same before anything is proved, by the number of letters.
_NEAR = (8, 12, 8, 5, 4, 3, 2)


def inequality(
    box: Box,
    *,
    where: Where | None = None,
    attained: Mapping[Any, Any] | None = None,
    squares: Sequence[tuple[Any, Any]] = (),
    method: str = "",
) -> Check:
    """Return the check that an inequality holds at all points of a box.

    Parameters
    ----------
    box : mapping
        Letter -> (low, high), rational numbers, both ends included; None for no end.
    where : mapping, optional
        What other letters stand for.
    attained : mapping, optional
        Letter -> number: a point at which both sides are said to be equal, so that no stronger inequality is true.
    squares : sequence of (number, expression), optional
        Numbers that are not negative, times squares of these expressions, which the difference of both sides is the
        sum of: that is all that is checked then.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> t = sp.Symbol("t")
    >>> bound = formula(sp.Le(t * (1 - t), sp.Rational(1, 4), evaluate=False))
    >>> [case.true for case in inequality({t: (0, 1)}).cases(bound)]
    [True]
    """
    rules = _Rules(box, where or {}, attained, squares)
    return Check(
        rules.cases,
        Strength.GENERAL,
        method or f"squares, or signs of exact Bernstein coefficients, on the box {_box_text(rules.box)}",
        proof=True,
        search=rules.search,
        export=rules.export,
    )


def not_sharp(formula: Formula, check: Check, reason: str) -> Formula:
    """Return an inequality with those changes explained that leave a true one: it is not claimed to be the best.

    Parameters
    ----------
    formula : Formula
        True by the check.
    check : Check
        That of `inequality`.
    reason : str
        Why a weaker or stronger true inequality is no other claim.
    """
    same = {}
    for mutant in mutants(formula):
        changed = replace(formula, relation=mutant.relation, equivalent={}, undecidable={})
        try:
            if all(case.true for case in check.cases(changed)):
                same[mutant.text] = reason
        except (CheckFailedError, UnsuitableError):
            continue
    return replace(formula, undecidable={**formula.undecidable, **same})


def _box_text(box: Mapping[Any, _Interval]) -> str:
    parts = [
        f"{'-oo' if low is None else low} .. {'oo' if high is None else high} for {letter}"
        for letter, (low, high) in box.items()
    ]
    return ", ".join(parts) or "of no letter"


@dataclass(frozen=True)
class _Leaf:
    """A part of the box on which no coefficient is negative, and these coefficients."""

    box: tuple[_Interval, ...]
    coefficients: _Terms


@dataclass(frozen=True)
class _Sign:
    """What was found of a polynomial: squares or leaves that prove it, or a point where it is negative."""

    leaves: tuple[_Leaf, ...] = ()
    squares: tuple[tuple[Any, Any], ...] = ()
    point: tuple[Fraction, ...] | None = None


class _Rules:
    """What an inequality is decided by."""

    def __init__(
        self, box: Box, where: Where, attained: Mapping[Any, Any] | None, squares: Sequence[tuple[Any, Any]]
    ) -> None:
        self.box: dict[Any, _Interval] = {}
        for letter, (low, high) in box.items():
            ends = tuple(None if end is None else _fraction(end) for end in (low, high))
            if None not in ends and not ends[0] < ends[1]:  # type: ignore[operator]  # neither is None
                raise UnsuitableError(f"box of {letter}: found {low} .. {high}, expected the smaller number first")
            self.box[letter] = (ends[0], ends[1])
        self.where = where
        self.attained = None if attained is None else {x: sp.Rational(number) for x, number in attained.items()}
        self.squares = [(sp.Rational(number), sp.sympify(root)) for number, root in squares]

    def cases(self, formula: Formula | None) -> Iterator[Case]:
        """Decide the inequality on the box."""
        parts = self._parts(given(formula))
        found = self._found(parts)
        if found.point is None:
            yield Case(f"all points of {_box_text(self.box)}", True)
            if self.attained is not None:
                apart = self._apart(given(formula), {x: _fraction(number) for x, number in self.attained.items()})
                yield Case(self._attained_text, bool(apart == 0), residual=-apart)
            return
        at = dict(zip(parts.letters, found.point, strict=True))
        where = ", ".join(f"{letter} = {value}" for letter, value in at.items())
        yield Case(where or "no letter", False, residual=-self._apart(given(formula), at) or sp.Symbol("equal"))

    @property
    def _attained_text(self) -> str:
        return "both sides are equal at " + ", ".join(f"{x} = {n}" for x, n in (self.attained or {}).items())

    def _apart(self, formula: Formula, at: Mapping[Any, Fraction]) -> Any:
        """Return by how much the larger side is larger."""
        larger, smaller = self._sides(formula)
        exact = {letter: sp.Rational(value.numerator, value.denominator) for letter, value in at.items()}
        return sp.Rational(larger.xreplace(exact)) - sp.Rational(smaller.xreplace(exact))

    def _sides(self, formula: Formula) -> tuple[Any, Any]:
        """Return the side that is claimed to be larger, and the other one."""
        relation = formula.relation
        if not isinstance(relation, sp.Ge | sp.Gt | sp.Le | sp.Lt):
            raise UnsuitableError(f"{relation}: found no inequality, expected one with >=, >, <= or <")
        sides = [as_letters(carried_out(side, self.where)) for side in relation.args]
        return (sides[0], sides[1]) if isinstance(relation, sp.Ge | sp.Gt) else (sides[1], sides[0])

    def _parts(self, formula: Formula) -> _Parts:
        larger, smaller = self._sides(formula)
        letters = letters_of(larger, smaller)
        missing = [letter for letter in letters if letter not in self.box]
        if missing:
            raise UnsuitableError(f"{formula.relation}: found no box for {missing[0]}, expected one (box=...)")
        if not (larger - smaller).is_rational_function(*letters):
            raise UnsuitableError(f"{formula.relation}: found other functions, expected rational ones")
        over, under = sp.fraction(sp.cancel(larger - smaller))
        if self._sign(under, letters, strict=True).point is not None:
            over, under = -over, -under
            if self._sign(under, letters, strict=True).point is not None:
                raise UnsuitableError(f"{formula.relation}: found a divisor that changes its sign, or is 0, on the box")
        return _parted(letters, over, under, strict=isinstance(formula.relation, sp.Gt | sp.Lt))

    def _found(self, parts: _Parts) -> _Sign:
        """Return what was found of the numerator; of given squares that they add up to it."""
        if not self.squares:
            return self._sign(parts.odd, parts.letters, strict=parts.strict)
        total = sp.Add(*(number * root**2 for number, root in self.squares))
        if parts.under.free_symbols or any(number < 0 for number, _ in self.squares):
            raise UnsuitableError("squares: found a divisor, or a negative factor, expected a polynomial as their sum")
        if sp.expand(total - parts.over) != 0:
            point = self._near_point(parts.odd, parts.letters, parts.strict)
            if point is None:
                raise CheckFailedError(f"the squares leave {sp.expand(parts.over - total)}, expected 0")
            return _Sign(point=point)
        if parts.strict and not any(number > 0 and root.is_number and root != 0 for number, root in self.squares):
            raise CheckFailedError("the squares may all be 0, expected a positive number among them")
        return _Sign(squares=tuple(self.squares))

    def _sign(self, polynomial: Any, letters: list[Any], *, strict: bool) -> _Sign:
        point = self._near_point(polynomial, letters, strict)
        if point is not None:
            return _Sign(point=point)
        squares = _completed(polynomial, letters, strict)
        if squares is not None:
            return _Sign(squares=squares)
        return _sign_on_box(_terms(polynomial, letters), tuple(self.box[x] for x in letters), strict)

    def _near_point(self, polynomial: Any, letters: list[Any], strict: bool) -> tuple[Fraction, ...] | None:
        """Return a point of small numbers at which a polynomial has the wrong sign: what is false shows early."""

        def wrong(at: Mapping[Any, Fraction]) -> bool:
            value = interpret(polynomial, Meaning(at)) if self._holds(at) else Fraction(1)
            return bool(value < 0 or (strict and value == 0))

        found = smallest_assignment(letters, wrong, _NEAR[min(len(letters), len(_NEAR) - 1)])
        return None if found is None else tuple(_fraction(found[letter]) for letter in letters)

    def _holds(self, at: Mapping[Any, Fraction]) -> bool:
        """Tell whether a point is in the box."""
        return all(
            (low is None or low <= at[x]) and (high is None or at[x] <= high)
            for x, (low, high) in self.box.items()
            if x in at
        )

    def search(self, formula: Formula) -> Counterexample | None:
        """Return the smallest rational point of the box at which the inequality fails."""
        larger, smaller = self._sides(formula)
        parts = self._parts(formula)

        def fails(at: Mapping[Any, Fraction]) -> bool:
            if not self._holds(at):
                return False
            try:
                apart = interpret(larger - smaller, Meaning(at))
            except UndefinedError:
                return False
            return bool(apart < 0 or (parts.strict and apart == 0))

        found = smallest_assignment(parts.letters, fails, _HEIGHT)
        if found is None:
            sign = self._sign(parts.odd, parts.letters, strict=parts.strict)
            if sign.point is None:
                return None
            found = {x: sp.Rational(v.numerator, v.denominator) for x, v in zip(parts.letters, sign.point, strict=True)}
        values = tuple((str(letter), str(value)) for letter, value in found.items())
        sides = [str(side.xreplace(found)) for side in (formula.relation.lhs, formula.relation.rhs)]
        signs = {"<=": ">", "<": ">=", ">=": "<", ">": "<="}
        sign_text = formula.relation.rel_op
        return Counterexample(values, f"{sides[0]} {sign_text} {sides[1]}", f"{sides[0]} {signs[sign_text]} {sides[1]}")

    def export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return one statement for each part of the box; of a false inequality the point at which it fails."""
        formula = given(formula)
        parts = self._parts(formula)
        found = self._found(parts)
        if found.point is not None:
            larger, smaller = self._sides(formula)
            values = [sp.Rational(v.numerator, v.denominator) for v in found.point]
            at = dict(zip(parts.letters, values, strict=True))
            yield self._false_at(next(iter(self.cases(formula))).label, larger, smaller, at)
            return
        box = _box_text(self.box)
        one = sp.Integer(1)
        if parts.under.free_symbols:
            divisor = self._sign(parts.under, parts.letters, strict=True)
            yield from _statements(f"the divisor on {box}", divisor, parts.letters, parts.under, one, strict=True)
        square = one if self.squares else parts.square
        yield from _statements(box, found, parts.letters, parts.over, square, strict=parts.strict)

        if self.attained is not None:
            one, other = (side.xreplace(self.attained) for side in self._sides(formula))
            yield (identity if one == other else different)(self._attained_text, one, other)

    @staticmethod
    def _false_at(label: str, larger: Any, smaller: Any, at: Mapping[Any, Any]) -> Statement:
        apart = sp.Rational(smaller.xreplace(at)) - sp.Rational(larger.xreplace(at))
        if apart == 0:
            return different(label, larger.xreplace(at), smaller.xreplace(at) + 1)
        return positive(f"{label}: the other side is larger", apart, affirmed=False)


@dataclass(frozen=True)
class _Parts:
    """An inequality as over/under >= 0, `under` positive on the box, over = odd * square^2."""

    letters: list[Any]
    over: Any
    under: Any
    odd: Any
    square: Any
    strict: bool


def _parted(letters: list[Any], over: Any, under: Any, *, strict: bool) -> _Parts:
    constant, factors = sp.factor_list(over, *letters) if letters else (over, [])
    # In a strict inequality a square may not vanish either.
    square = sp.Mul(*(f ** (n // 2) for f, n in factors if not strict))
    odd = sp.Mul(constant, *(f**n if strict else f ** (n % 2) for f, n in factors))
    return _Parts(letters, sp.expand(over), sp.expand(under), sp.expand(odd), square, strict)


def _fraction(number: Any) -> Fraction:
    exact = sp.Rational(number)
    return Fraction(int(exact.p), int(exact.q))


def _terms(polynomial: Any, letters: list[Any]) -> _Terms:
    if not letters:
        return {(): _fraction(polynomial)}
    return {powers: _fraction(c) for powers, c in sp.Poly(polynomial, *letters).terms()}


def _sign_on_box(terms: _Terms, box: tuple[_Interval, ...], strict: bool) -> _Sign:
    """Halve a box until no part has a coefficient of the wrong sign, or a corner has."""
    boxes, leaves, seen = _halves_of_lines(box), [], 0
    while boxes:
        seen += 1
        if seen > _MOST_BOXES:
            raise CheckFailedError(f"neither proved nor refuted on {_MOST_BOXES} parts of the box")
        part = boxes.pop()
        coefficients = _bernstein(terms, part)
        corner = _wrong_corner(coefficients, part, strict)
        if corner is not None:
            return _Sign(point=corner)
        least = min(coefficients.values(), default=Fraction(0))
        at_ends = min(_at_ends(coefficients, part).values(), default=Fraction(0))
        if least >= 0 and (at_ends > 0 or not strict):
            leaves.append(_Leaf(part, coefficients))
        else:
            boxes += _halved(part)
    return _Sign(tuple(leaves))


def _halves_of_lines(box: tuple[_Interval, ...]) -> list[tuple[_Interval, ...]]:
    """Cut lines without an end on either side at 0."""
    options = [
        [(None, Fraction(0)), (Fraction(0), None)] if low is None and high is None else [(low, high)]
        for low, high in box
    ]
    return list(product(*options))


def _bernstein(terms: _Terms, box: tuple[_Interval, ...]) -> _Terms:
    """Return coefficients over a box; over a ray those of powers of the distance from its end."""
    for place, (low, high) in enumerate(box):
        degree = max((powers[place] for powers in terms), default=0)
        rows: dict[tuple[int, ...], list[Fraction]] = {}
        for powers, coefficient in terms.items():
            key = (*powers[:place], *powers[place + 1 :])
            rows.setdefault(key, [Fraction(0)] * (degree + 1))[powers[place]] += coefficient
        changed: _Terms = {}
        for key, row in rows.items():
            for i, coefficient in enumerate(_over(row, low, high)):
                changed[(*key[:place], i, *key[place:])] = coefficient
        terms = changed
    return terms


def _over(row: list[Fraction], low: Fraction | None, high: Fraction | None) -> list[Fraction]:
    """Return the Bernstein coefficients of a polynomial over an interval, or its Taylor ones over a ray."""
    degree = len(row) - 1
    start = low if low is not None else high
    assert start is not None
    ray = Fraction(-1 if low is None else 1)
    width = ray if low is None or high is None else high - low
    # Of start + width u.
    taylor = [
        width**i * sum((row[j] * comb(j, i) * start ** (j - i) for j in range(i, degree + 1)), Fraction(0))
        for i in range(degree + 1)
    ]
    if low is None or high is None:
        return taylor
    return [
        sum((Fraction(comb(j, i), comb(degree, i)) * taylor[i] for i in range(j + 1)), Fraction(0))
        for j in range(degree + 1)
    ]


def _at_ends(coefficients: _Terms, box: tuple[_Interval, ...]) -> _Terms:
    """Return those coefficients that count where all rays begin: of a box without rays all."""
    rays = [i for i, (low, high) in enumerate(box) if low is None or high is None]
    return {powers: c for powers, c in coefficients.items() if not any(powers[i] for i in rays)}


def _wrong_corner(coefficients: _Terms, box: tuple[_Interval, ...], strict: bool) -> tuple[Fraction, ...] | None:
    """Return a corner at which the polynomial has the wrong sign: there a coefficient is its value."""
    degrees = [max((powers[i] for powers in coefficients), default=0) for i in range(len(box))]
    ends = []
    for degree, (low, high) in zip(degrees, box, strict=True):
        if low is None or high is None:
            ends.append([(0, low if low is not None else high)])
        else:
            ends.append([(0, low), (degree, high)])
    for corner in product(*ends):
        value = coefficients.get(tuple(i for i, _ in corner), Fraction(0))
        if value < 0 or (strict and value == 0):
            return tuple(x for _, x in corner if x is not None)
    return None


def _halved(box: tuple[_Interval, ...]) -> list[tuple[_Interval, ...]]:
    """Cut the widest edge; a ray where it gets twice as far from its end."""

    def width(interval: _Interval) -> Fraction:
        low, high = interval
        return Fraction(10**9) if low is None or high is None else high - low

    place = max(range(len(box)), key=lambda i: width(box[i]))
    low, high = box[place]
    if low is None:
        assert high is not None
        cut = high - max(Fraction(1), abs(high))
    elif high is None:
        cut = low + max(Fraction(1), abs(low))
    else:
        cut = (low + high) / 2
    return [(*box[:place], part, *box[place + 1 :]) for part in ((low, cut), (cut, high))]


def _completed(polynomial: Any, letters: list[Any], strict: bool) -> tuple[tuple[Any, Any], ...] | None:
    """Complete squares, one letter after another; None where that does not show the sign everywhere."""
    if not letters or sp.Poly(polynomial, *letters).total_degree() > 2:
        return None
    squares = []
    for letter in letters:
        a, b, c = (sp.Poly(polynomial, letter).coeff_monomial(letter**n) for n in (2, 1, 0))
        if a == 0 and b == 0:
            continue
        if not a > 0:
            return None
        squares.append((a, letter + b / (2 * a)))
        polynomial = sp.expand(c - b**2 / (4 * a))
    if polynomial < 0 or (strict and polynomial == 0):
        return None
    return (*squares, (polynomial, sp.Integer(1)))


def _statements(
    label: str, found: _Sign, letters: list[Any], whole: Any, square: Any, *, strict: bool
) -> Iterator[Statement]:
    for leaf in found.leaves:
        yield _leaf_statement(label, leaf, letters, whole, square, strict)
    if found.squares:
        extra = (square,) if square != 1 else ()
        over = [
            Term(coefficient=text(number), squares=tuple(map(text, (*extra, *((root,) if root != 1 else ())))))
            for number, root in found.squares
            if number != 0
        ]
        yield positive(label, whole, over=over, strict=strict)


def _leaf_statement(label: str, leaf: _Leaf, letters: list[Any], whole: Any, square: Any, strict: bool) -> Statement:
    """Return that a polynomial is a sum of products that are not negative on a part of the box."""
    where: dict[str, str] = {}
    names: list[tuple[str, str]] = []
    scale = Fraction(1)
    degrees = [max((powers[i] for powers in leaf.coefficients), default=0) for i in range(len(letters))]
    for n, (letter, (low, high), degree) in enumerate(zip(letters, leaf.box, degrees, strict=True), start=1):
        above, below = f"above{n}_", f"below{n}_"
        if low is not None:
            where[above] = f"{text(letter)} - ({text(low)})"
        if high is not None:
            where[below] = f"{text(high)} - {text(letter)}"
        if low is not None and high is not None:
            scale *= (high - low) ** degree
        names.append((above if low is not None else below, below))
    finite = [low is not None and high is not None for low, high in leaf.box]
    squares = (text(square),) if square != 1 else ()
    ends = _at_ends(leaf.coefficients, leaf.box)
    least = min(ends.values()) if strict else Fraction(0)
    over = []
    for powers, coefficient in leaf.coefficients.items():
        amount = coefficient - (least if powers in ends else 0)
        amount *= prod(comb(d, i) if both else 1 for d, i, both in zip(degrees, powers, finite, strict=True))
        factors: list[tuple[str, int]] = []
        for (first, second), i, degree, both in zip(names, powers, degrees, finite, strict=True):
            factors += [(first, i)] if i else []
            factors += [(second, degree - i)] if both and degree > i else []
        if amount:
            over.append(Term(coefficient=text(amount), powers=tuple(factors), squares=squares))
    if least:
        over.append(Term(coefficient=text(least * scale)))
    part = _box_text(dict(zip(letters, leaf.box, strict=True)))
    if not over:
        raise NotExpressibleError(f"{label}: both sides are the same on {part}")
    return positive(
        f"{label}, part {part}",
        whole,
        nonnegative=list(where),
        over=over,
        under=[Term(coefficient=text(scale))],
        where=tuple(where.items()),
        strict=strict,
        among=dict(zip(letters, map(_inside, leaf.box), strict=True)),
    )


def _inside(interval: _Interval) -> Fraction:
    low, high = interval
    if low is None:
        assert high is not None
        return high - 1
    return low + 1 if high is None else (low + high) / 2
