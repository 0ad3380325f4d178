"""Least values as theorems of Coq: of a polynomial over a box, by sums of squares, and of a quadratic form.

Nothing of the search is believed: the file holds whole numbers, and two identities that the kernel checks.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import comb, lcm

from flint import fmpq, fmpq_mat

from semispline.papers.recheck.coq_lemmas import numbers
from semispline.papers.recheck.roots import NotForCoqError, remainder, whole_root
from semispline.papers.recheck.statements import Theory
from semispline.solver.proof import NoSquares, gram_matrices

Table = list[list[Fraction]]
Range = tuple[Fraction, Fraction]
# s and t run from -1 to 1 over the box; z of Q0, and of Q1 and Q2.
_MONOMIALS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
# Bits of the matrices below their largest entry; what is cut off is given back to one entry for each monomial.
_BITS = 90


def least_over_a_box(
    name: str, title: str, table: Table, box: tuple[Range, Range], at: tuple[Fraction, Fraction], gap: Fraction
) -> Theory:
    """Return the theorem that a quartic f(a, b) is nowhere in a box below (1 - gap) times its value at a point.

    Parameters
    ----------
    name, title : str
        Of the theorem, and what it is about.
    table : rows of numbers
        [i, j] multiplies x^i y^j, where x and y run from -1 to 1 over the box.
    box : pair of (low, high)
        Of a and b.
    at : (number, number)
        The point, as x and y.
    gap : number

    Raises
    ------
    NotForCoqError
        No sums of squares were found.
    """
    least = (1 - gap) * _value(table, at)
    rest = [list(row) for row in table]
    rest[0][0] -= least
    grams = gram_matrices(fmpq_mat(len(rest), len(rest[0]), [_flint(x) for row in rest for x in row]))
    if isinstance(grams, NoSquares):
        raise NotForCoqError(f"{name}: found no sums of squares over the whole box")
    return Theory(name, title, ("Squares",), _file(name, rest, least, _shortened(rest, grams), box, at, table, gap))


def _value(table: Table, at: tuple[Fraction, Fraction]) -> Fraction:
    return sum((c * at[0] ** i * at[1] ** j for i, row in enumerate(table) for j, c in enumerate(row)), Fraction(0))


def rescaled(table: Table, box: tuple[Range, Range]) -> Table:
    """Return a polynomial of x and y over a box as one of parameters that run from -1 to 1 over it.

    Examples
    --------
    >>> rescaled([[Fraction(0)], [Fraction(1)]], ((Fraction(2), Fraction(6)), (Fraction(0), Fraction(0))))
    [[Fraction(4, 1)], [Fraction(2, 1)]]
    """
    rows = _moved(table, *box[0])
    columns = _moved([list(column) for column in zip(*rows, strict=True)], *box[1])
    return [list(row) for row in zip(*columns, strict=True)]


def _moved(rows: Table, low: Fraction, high: Fraction) -> Table:
    middle, half = (low + high) / 2, (high - low) / 2
    return [
        [
            sum((comb(m, k) * middle ** (m - k) * half**k * rows[m][j] for m in range(k, len(rows))), Fraction(0))
            for j in range(len(rows[0]))
        ]
        for k in range(len(rows))
    ]


def _shortened(rest: Table, grams: Sequence[Sequence[Sequence[Fraction]]]) -> list[Table]:
    """Return the matrices with short entries that stand for the same polynomial."""
    largest = max(abs(x) for gram in grams for row in gram for x in row)
    unit = Fraction(2) ** (largest.numerator.bit_length() - largest.denominator.bit_length() - _BITS)
    short = [[[round(x / unit) * unit for x in row] for row in gram] for gram in grams]
    missing = {(i, j): c for i, row in enumerate(rest) for j, c in enumerate(row)}
    for gram, factor in zip(short, ({(0, 0): 1}, {(0, 0): 1, (2, 0): -1}, {(0, 0): 1, (0, 2): -1}), strict=True):
        for i, row in enumerate(gram):
            for j, x in enumerate(row):
                for power, sign in factor.items():
                    exponents = _product(_MONOMIALS[i], _MONOMIALS[j], power)
                    missing[exponents] = missing.get(exponents, Fraction(0)) - sign * x
    places = {_product(a, b): (i, j) for i, a in enumerate(_MONOMIALS) for j, b in enumerate(_MONOMIALS) if i <= j}
    for exponents, x in missing.items():
        if x:
            i, j = places[exponents]
            share = x if i == j else x / 2
            short[0][i][j] += share
            if i != j:
                short[0][j][i] += share
    return short


def _product(*exponents: tuple[int, int]) -> tuple[int, int]:
    return sum(e[0] for e in exponents), sum(e[1] for e in exponents)


def _squares(gram: Table) -> list[tuple[Fraction, dict[int, int]]]:
    """Return positive numbers and whole coefficients of what is squared: z' A z is their sum."""
    scale, root = whole_root(gram)
    size = len(gram)
    found = [(Fraction(1, scale), {i: root[i][k] for i in range(k, size) if root[i][k]}) for k in range(size)]
    for i, (own, others) in enumerate(remainder(gram, scale, root)):
        found.append(((own - sum(map(abs, others))) / scale, {i: 1}))
        for j, x in enumerate(others[i:], start=i + 1):
            if x:
                found.append((abs(x) / scale, {i: 1, j: 1 if x > 0 else -1}))
    return found


def _file(
    name: str,
    rest: Table,
    least: Fraction,
    grams: Sequence[Table],
    box: tuple[Range, Range],
    at: tuple[Fraction, Fraction],
    table: Table,
    gap: Fraction,
) -> str:
    sums = [_squares(gram) for gram in grams]
    factor = lcm(*(w.denominator for part in sums for w, _ in part), *(x.denominator for row in rest for x in row))
    whole = [(int(c * factor), i, j) for i, row in enumerate(rest) for j, c in enumerate(row) if c]
    parts = [_sum(part, factor) for part in sums]
    (a_low, a_high), (b_low, b_high) = box
    a, b = ((low + high) / 2 + (high - low) / 2 * x for (low, high), x in zip(box, at, strict=True))
    polynomial = " + ".join(
        f"{_real(c)}{_monomial(i, j)}" for i, row in enumerate(table) for j, c in enumerate(row) if c
    )
    return f"""Definition {name}_polynomial (s t : R) : R :=
  {polynomial}.
Definition {name}_middle_a := {_real((a_low + a_high) / 2)}.
Definition {name}_half_a := {_real((a_high - a_low) / 2)}.
Definition {name}_middle_b := {_real((b_low + b_high) / 2)}.
Definition {name}_half_b := {_real((b_high - b_low) / 2)}.
Definition {name}_energy (a b : R) : R :=
  {name}_polynomial ((a - {name}_middle_a) / {name}_half_a) ((b - {name}_middle_b) / {name}_half_b).
Definition {name}_whole (s t : R) : R :=
  {" + ".join(f"{_whole(c)}{_monomial(i, j)}" for c, i, j in whole)}.
Definition {name}_0 (s t : R) : R :=
  {parts[0]}.
Definition {name}_1 (s t : R) : R :=
  {parts[1]}.
Definition {name}_2 (s t : R) : R :=
  {parts[2]}.

Lemma {name}_scaled s t : {name}_polynomial s t - {_real(least)} = {name}_whole s t / {_whole(factor)}.
Proof. unfold {name}_polynomial, {name}_whole. field. Qed.

Lemma {name}_squares s t : {name}_whole s t = {name}_0 s t + (1 - s ^ 2) * {name}_1 s t + (1 - t ^ 2) * {name}_2 s t.
Proof. unfold {name}_whole, {name}_0, {name}_1, {name}_2. ring. Qed.

Lemma {name}_0_positive s t : 0 <= {name}_0 s t. Proof. unfold {name}_0. squares. Qed.
Lemma {name}_1_positive s t : 0 <= {name}_1 s t. Proof. unfold {name}_1. squares. Qed.
Lemma {name}_2_positive s t : 0 <= {name}_2 s t. Proof. unfold {name}_2. squares. Qed.

Lemma {name}_there : {_real(least)} = (1 - {_real(gap)}) * {name}_energy {_real(a)} {_real(b)}.
Proof.
  unfold {name}_energy, {name}_polynomial, {name}_middle_a, {name}_half_a, {name}_middle_b, {name}_half_b. field.
Qed.

Theorem {name} a b : {_real(a_low)} <= a <= {_real(a_high)} -> {_real(b_low)} <= b <= {_real(b_high)} ->
  (1 - {_real(gap)}) * {name}_energy {_real(a)} {_real(b)} <= {name}_energy a b.
Proof.
  intros Ha Hb. rewrite <- {name}_there. apply Rge_le, Rminus_ge, Rle_ge. unfold {name}_energy.
  rewrite {name}_scaled, {name}_squares. apply Rmult_le_pos.
  - apply by_squares; auto using {name}_0_positive, {name}_1_positive, {name}_2_positive;
      apply within; unfold {name}_middle_a, {name}_half_a, {name}_middle_b, {name}_half_b; lra.
  - apply Rlt_le, Rinv_0_lt_compat, (IZR_lt 0). reflexivity.
Qed.
"""


def _sum(part: Sequence[tuple[Fraction, dict[int, int]]], factor: int) -> str:
    terms = []
    for weight, line in part:
        inside = " + ".join(f"{_whole(c)}{_monomial(*_MONOMIALS[i])}" for i, c in line.items())
        if weight:
            terms.append(f"{_whole(int(weight * factor))} * ({inside}) ^ 2")
    return "\n  + ".join(terms)


def _monomial(i: int, j: int) -> str:
    return "".join(f" * {x} ^ {n}" if n > 1 else f" * {x}" for x, n in (("s", i), ("t", j)) if n)


def _whole(x: int) -> str:
    """Return a whole number; long ones are read faster in hexadecimal."""
    text = hex(abs(x)) if abs(x) >= 2**32 else str(abs(x))
    return f"({'-' if x < 0 else ''}{text})"


def _real(x: Fraction) -> str:
    return _whole(x.numerator) if x.denominator == 1 else f"({_whole(x.numerator)} / {_whole(x.denominator)})"


def minimiser(name: str, title: str, entries: Sequence[Sequence[Fraction]], right: Sequence[Fraction]) -> Theory:
    """Return the theorem that x' A x + 2 b' x is least at the solution of A x = -b, and there alone.

    Parameters
    ----------
    name, title : str
    entries : rows of numbers
        Of A, positive definite.
    right : sequence of numbers
        b.

    Raises
    ------
    NotForCoqError
        A is not positive definite.
    """
    scale, root = whole_root(entries)
    size = len(entries)
    at = fmpq_mat(size, size, [_flint(x) for row in entries for x in row]).solve(
        fmpq_mat(size, 1, [-_flint(x) for x in right])
    )
    point = [[Fraction(int(at[i, 0].p), int(at[i, 0].q)) for i in range(size)]]
    whole = "[" + ";\n ".join("[" + "; ".join(f"({x})%Z" for x in row) + "]" for row in root) + "]"
    text = f"""Definition {name}_form := {numbers(entries)}.
Definition {name}_linear := {numbers([right])[1:-1]}.
Definition {name}_row := {numbers(point)[1:-1]}.
Theorem {name} : forall d, (exists i, (i < {size})%nat /\\ ~ d i == 0) ->
  energy {size} {name}_form (point {name}_linear) (point {name}_row)
  < energy {size} {name}_form (point {name}_linear) (fun i => point {name}_row i + d i).
Proof.
  apply (minimiser {size} {scale} {whole}); by_numbers.
Qed.
"""
    return Theory(name, title, ("Rational", "Matrices"), text, over_reals=False)


def _flint(x: Fraction) -> fmpq:
    return fmpq(x.numerator, x.denominator)
