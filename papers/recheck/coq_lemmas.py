"""Statements in the language of Coq: each one a lemma over the rational numbers, with its proof.

What lemmas are stated with, and the tactics that close them, is in `derivations/coq`, Rational.v and Matrices.v. A
condition on denominators is a hypothesis; what is refuted is the negation of the statement, at its instance.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

from semispline.papers.recheck.arithmetic import instance, value
from semispline.papers.recheck.gp import term_text
from semispline.papers.recheck.roots import NotForCoqError, Rows, whole_root
from semispline.papers.recheck.statements import (
    Contained,
    Identity,
    Knots,
    Minimum,
    Positive,
    Rank,
    Statement,
    Term,
)


def lemma(statement: Statement) -> str:
    """Return what follows the name of a lemma: its statement and its proof.

    Raises
    ------
    NotForCoqError
        The proof needs what could not be found.

    Examples
    --------
    >>> print(lemma(Identity(label="a", left="x/x", right="1", variables=("x",), nonzero=("x",))))
    forall (x : number), ~ x == 0 ->
      x/x == 1.
    Proof. rational. Qed.
    """
    if statement.form not in _BY_FORM:
        raise NotForCoqError(_WITHOUT[statement.form])
    if isinstance(statement, Identity) and statement.roots:
        raise NotForCoqError("a root: no rational number is one")
    stated, proof = _BY_FORM[statement.form](statement)
    return f"{stated}.\nProof. {proof} Qed."


def met(statement: Statement) -> str | None:
    """Return the lemma that numbers fulfil the premises of another lemma, so that it says something; None without any.

    Examples
    --------
    >>> print(met(Identity(label="a", left="x/x", right="1", variables=("x",), nonzero=("x",), at=(("x", "2"),))))
    exists (x : number), ~ x == 0.
    Proof. exists (2#1). repeat split; by_numbers. Qed.
    """
    premises = [*_signs(statement), *_not_zero(statement)] if isinstance(statement, Positive) else _not_zero(statement)
    if not premises or (isinstance(statement, Identity) and not statement.equal):
        return None
    numbers_ = ", ".join(number(Fraction(x)) for _, x in statement.at)
    stated = f"exists ({' '.join(statement.variables)} : number), " + " /\\ ".join(premises)
    return f"{stated}.\nProof. exists {numbers_}. repeat split; by_numbers. Qed."


def _expression(text: str) -> str:
    return re.sub(r"\^(-\d+)", r"^(\1)", text)


def _variables(statement: Statement) -> str:
    return f"forall ({' '.join(statement.variables)} : number), " if statement.variables else ""


def _premises(premises: Iterable[str]) -> str:
    return "".join(f"{premise} ->\n  " for premise in premises)


def _not_zero(statement: Statement) -> list[str]:
    return [f"~ {_bracketed(factor)} == 0" for factor in statement.nonzero]


def _bracketed(text: str) -> str:
    return text if re.fullmatch(r"\w+", text) else f"({_expression(text)})"


def _lets(statement: Statement) -> str:
    return "".join(f"let {name} := {_expression(meaning)} in\n  " for name, meaning in statement.where)


def _identity(statement: Identity) -> tuple[str, str]:
    sides = f"{_expression(statement.left)} == {_expression(statement.right)}"
    if statement.equal:
        stated = _variables(statement) + _premises(_not_zero(statement)) + _lets(statement) + sides
        return stated, "rational." if statement.variables else "by_numbers."
    conditions = _premises(_condition(c) for c in statement.conditions)
    stated = f"~ ({_variables(statement)}{_premises(_not_zero(statement))}{_lets(statement)}{conditions}{sides})"
    if not statement.variables and not conditions:
        return stated, "by_numbers."
    numbers = " ".join(number(Fraction(x)) for _, x in statement.at)
    met = " ".join(["ltac:(by_numbers)"] * (len(statement.nonzero) + len(statement.conditions)))
    return stated, f"intro H. generalize (H {numbers} {met}). by_numbers."


def _condition(condition: str) -> str:
    left, sign, right = re.split(r"(>=|<=|!=|>|<)", condition)
    left, right = _expression(left.strip()), _expression(right.strip())
    return f"~ {left} == {right}" if sign == "!=" else f"{left} {sign} {right}"


def _positive(statement: Positive) -> tuple[str, str]:
    sign = "<" if statement.strict else "<="
    premises = _premises([*_signs(statement), *_not_zero(statement)])
    stated = f"{_variables(statement)}{premises}{_lets(statement)}0 {sign} {_expression(statement.left)}"
    if not statement.variables:
        return stated, "by_numbers."
    rule, tactic = ("quotient_positive", "positive") if statement.strict else ("quotient_nonneg", "nonneg")
    over, under = (_sum(part) for part in (statement.over, statement.under))
    return stated, f"intros. apply ({rule} _ ({over}) ({under})); [rational|{tactic}|positive]."


def _signs(statement: Positive) -> list[str]:
    signs = [f"0 < {name}" for name in statement.positive if name in statement.variables]
    return signs + [f"0 <= {name}" for name in statement.nonnegative if name in statement.variables]


def _sum(terms: Sequence[Term]) -> str:
    return " + ".join(_expression(term_text(term)) for term in terms)


def _rank(statement: Rank) -> tuple[str, str]:
    rows, columns = len(statement.matrix), len(statement.matrix[0])
    at = instance(statement.at, statement.where)
    entries = [[value(entry, at) for entry in row] for row in statement.matrix]
    minor = [[entries[i][j] for j in statement.columns] for i in statement.rows]
    inverse = _inverse(minor)
    left = [[Fraction(0)] * rows for _ in statement.rows]
    for row, line in zip(left, inverse, strict=True):
        for i, number_ in zip(statement.rows, line, strict=True):
            row[i] = number_
    picked = [[entries[i][j] for j in range(columns)] for i in statement.rows]
    combinations = _product(inverse, picked)
    stated = f"rank_is {rows} {columns} {numbers(entries)} {statement.rank}"
    indices = "[" + "; ".join(f"{j}%nat" for j in statement.columns) + "]"
    proof = f"apply (rank_by _ _ _ _ {indices} {numbers(left)} {numbers(combinations)}); by_numbers."
    if not statement.variables:
        return stated, proof
    # A matrix of functions: the rank at the instance, and what sends its columns to zero everywhere.
    sums = []
    for texts in statement.matrix:
        for free in range(len(statement.free)):
            pairs = zip(texts, statement.kernel, strict=True)
            terms = (f"({_expression(a)})*({_expression(k[free])})" for a, k in pairs)
            sums.append(f"{' + '.join(terms)} == 0")
    everywhere = _variables(statement) + _premises(_not_zero(statement)) + " /\\\n  ".join(sums or ["True"])
    return f"({everywhere}) /\\\n  {stated}", f"split; [repeat split; rational|{proof[:-1]}]."


def _contained(statement: Contained) -> tuple[str, str]:
    outer, inner = (_numbers(x) for x in (statement.outer, statement.inner))
    shape = f"{len(outer)} {len(outer[0])} {len(inner[0])}"
    stated = f"contained {shape} {numbers(outer)} {numbers(inner)}"
    if statement.solution:
        return stated, f"apply (contained_by _ _ _ _ _ {numbers(_numbers(statement.solution))}). by_numbers."
    row = [Fraction(x) for x in statement.separator]
    found = _product([row], inner)[0]
    column = next((j for j, x in enumerate(found) if x), None)
    if column is None:
        raise NotForCoqError(f"{statement.label}: found no column that the separator tells apart, expected one")
    line = numbers([row])[1:-1]
    return f"~ {stated}", f"apply (not_contained_by _ _ _ _ _ {line} {column}); [repeat constructor|by_numbers]."


def _minimum(statement: Minimum) -> tuple[str, str]:
    entries = _numbers(statement.matrix)
    scale, factor = whole_root(entries)
    whole = "[" + ";\n ".join("[" + "; ".join(f"({x})%Z" for x in row) + "]" for row in factor) + "]"
    stated = f"positive_definite {len(entries)} {numbers(entries)}"
    return stated, f"apply (definite_by _ {scale} _ {whole}). by_numbers."


def _knots(statement: Knots) -> tuple[str, str]:
    name, _, count = statement.fact.partition(" ")
    v, k = numbers([[Fraction(x) for x in statement.numbers]])[1:-1], statement.order
    fact = {
        "points": f"points {k} {count} {v}",
        "increasing": f"increasing {v}",
        "clamped": f"clamped {k} {v}",
        "single": f"single {k} {v}",
        "equal": f"equal_lists {v} {numbers([[Fraction(x) for x in statement.other]])[1:-1]}",
    }[name]
    return f"{fact} = {'true' if statement.holds else 'false'}", "by_numbers."


_BY_FORM: dict[str, Callable[[Any], tuple[str, str]]] = {
    "identity": _identity,
    "positive": _positive,
    "rank": _rank,
    "contained": _contained,
    "minimum": _minimum,
    "knots": _knots,
}


_WITHOUT = {
    "matrices": "products and inverses of matrices",
    "number": "a number of elementary functions, enclosed by intervals",
    "coefficient": "a coefficient of a power series",
}


def number(x: Fraction) -> str:
    """Return a rational number."""
    return f"({x.numerator}#{x.denominator})"


def numbers(rows: Rows) -> str:
    """Return rows of rational numbers."""
    lines = ("[" + "; ".join(map(_short, row)) + "]" for row in rows)
    return "[" + ";\n ".join(lines) + "]"


def _short(x: Fraction) -> str:
    if x.denominator == 1:
        return str(x.numerator) if x >= 0 else f"({x.numerator})"
    return number(x)


def _numbers(rows: Sequence[Sequence[str]]) -> list[list[Fraction]]:
    return [[Fraction(entry) for entry in row] for row in rows]


def _product(one: Rows, other: Rows) -> list[list[Fraction]]:
    columns = list(zip(*other, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in one]


def _inverse(rows: Rows) -> list[list[Fraction]]:
    """Return the inverse of a regular matrix.

    Raises
    ------
    NotForCoqError
        It has none.
    """
    size = len(rows)
    work = [[*row, *(Fraction(int(i == j)) for j in range(size))] for i, row in enumerate(rows)]
    for n in range(size):
        pivot = next((r for r in range(n, size) if work[r][n]), None)
        if pivot is None:
            raise NotForCoqError("rank: found a minor that is zero")
        work[n], work[pivot] = work[pivot], work[n]
        work[n] = [x / work[n][n] for x in work[n]]
        for r in range(size):
            if r != n and work[r][n]:
                work[r] = [a - work[r][n] * b for a, b in zip(work[r], work[n], strict=True)]
    return [row[size:] for row in work]
