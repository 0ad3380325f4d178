"""Statements in the language of PARI/GP: the same text runs in `gp` and in the library.

Each statement is a function without arguments that returns 1 if PARI finds what is stated. `CHECKER` holds what these
functions call; all that PARI is asked is in there, in thirty lines.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from semispline.papers.recheck.arithmetic import divisors
from semispline.papers.recheck.statements import (
    Coefficient,
    Contained,
    Identity,
    Knots,
    Matrices,
    Matrix,
    Minimum,
    Number,
    Positive,
    Rank,
    Statement,
    Term,
)

CONTROLS = "controls"
CHECKER = r"""\\ What PARI is asked. same: both sides are the same rational function.
same(a, b) = (a - b) == 0;
\\ A polynomial in r, where r^q stands for A: numerators are compared, one root after another, the last one first.
\\ A quotient of two letters is to PARI a polynomial in the one over the other: `numerator` alone leaves it there.
under(n) = {
  my(d = 1);
  if(type(n) == "t_RFRAC", return(under(numerator(n))));
  if(type(n) != "t_POL", return(1));
  foreach(Vec(n), c, d = lcm(d, if(type(c) == "t_RFRAC", denominator(c) * under(numerator(c)), under(c))));
  d };
cleared(n) = {
  my(d);
  n = numerator(n); d = under(n);
  while(d != 1, n = numerator(n * d); d = under(n));
  n };
put_in(n, r, A, q) = {
  my(d = poldegree(n, r));
  if(d < q, n, cleared(sum(k = 0, d, polcoef(n, k, r) * r^(k % q) * A^(k \ q)))) };
rooted(n, roots) = {
  forstep(i = #roots, 1, -1, n = put_in(n, roots[i][1], roots[i][2], roots[i][3]));
  n == 0 };
same_over(a, b, roots) = rooted(cleared(a - b), roots);
\\ A number is computed with a hundred digits; half of them count.
default(realprecision, 100);
real_root(p, k) = polrootsreal(p)[k];
between(x, low, high) = if(type(x) == "t_COMPLEX", 0, low - 1e-50 <= x && x <= high + 1e-50);
outside(x, low, high) = type(x) != "t_COMPLEX" && (x < low - 1e-50 || high + 1e-50 < x);
\\ Every divisor of a text is a product of the factors that must not vanish, so that x/x is not taken for 1 unseen.
is_number(x) = type(simplify(x)) == "t_INT" || type(simplify(x)) == "t_FRAC";
covered(ds, fs) = {
  my(all = vecprod(fs), n, g);
  for(i = 1, #ds, foreach([numerator(ds[i]), denominator(ds[i])], p,
    n = p; g = gcd(n, all);
    while(!is_number(n) && !is_number(g), n = n / g; g = gcd(n, all));
    if(!is_number(n) || n == 0, return(0))));
  1 };
\\ A minor that is not zero, and independent vectors that the matrix sends to zero: together the rank.
ranked(M, minor, K, free, r) = {
  #minor == r && (r == 0 || matdet(minor) != 0) && #K == matsize(M)[2] - r &&
    (#K == 0 || (same(M * K, 0 * (M * K)) && matrix(#K, #K, i, j, K[free[i], j]) == matid(#K))) };
definite(A, L, d) = {
  my(n = #d);
  same(A, L * matdiagonal(d) * L~) && A == A~ && vecmin(d) > 0 && sum(i = 1, n, L[i, i] == 1) == n &&
    sum(i = 1, n, sum(j = i + 1, n, L[i, j] != 0)) == 0 };
\\ Odd powers are taken of names alone that are positive, or not negative.
signed(used, known) = setminus(Set(used), Set(known)) == [];
increasing(v) = vecsort(v) == v;
inner(v, k) = v[k + 1 .. #v - k];
clamped(v, k) = v[1 .. k] == vector(k) && v[#v - k + 1 .. #v] == vector(k, i, 1);
single(v, k) = {
  my(w = inner(v, k));
  #Set(w) == #w && (#w == 0 || (vecmin(w) > 0 && vecmax(w) < 1)) };
asked = 0; agreed = 0; refused = List();
check(id, f) = {
  my(found = iferr(f(), e, Str(e)));
  asked++;
  if(found === 1, agreed++; return());
  listput(refused, id);
  print("DIFFERENT ", id, if(type(found) == "t_STR", Str(": ", found), "")) };
"""


def code(statement: Statement) -> str:
    """Return a statement as a function of PARI/GP without arguments."""
    return f"()->if(1, {'; '.join([*_lets(statement.where), _BY_FORM[statement.form](statement)])})"


def _lets(where: Iterable[tuple[str, str]]) -> list[str]:
    return [f"my({name} = {text})" for name, text in where]


def _covered(statement: Statement) -> str:
    texts = [text for _, text in statement.where] + list(statement.texts)
    found = list(dict.fromkeys(divisor for text in texts for divisor in divisors(text)))
    return f"covered({vector(found)}, {vector(statement.nonzero)})" if found else "1"


def _identity(statement: Identity) -> str:
    if statement.roots:
        roots = vector([f"[{name}, {radicand}, {degree}]" for name, radicand, degree in statement.roots])
        compared = f"same_over({statement.left}, {statement.right}, {roots})"
        return f"{_covered(statement)} && {'' if statement.equal else '!'}{compared}"
    both = f"{_covered(statement)} && same({statement.left}, {statement.right})"
    if statement.equal:
        return both
    # Different as functions, and at the instance.
    there = [*statement.conditions, *(f"({factor}) != 0" for factor in statement.nonzero)]
    there.append(f"({statement.left}) != ({statement.right})")
    at = [*_lets(statement.at), *_lets(statement.where), " && ".join(there)]
    return f"{_covered(statement)} && !same({statement.left}, {statement.right}) && (()->if(1, {'; '.join(at)}))()"


def _matrices(statement: Matrices) -> str:
    names = {name for name, _ in statement.matrices}
    lets = [f"my({name} = {matrix(rows)})" for name, rows in statement.matrices]
    texts = [text for _, text in statement.where] + list(statement.texts)
    found = list(dict.fromkeys(d for text in texts for d in divisors(text)))
    # What is taken to a negative power must have an inverse.
    inverted = [f"matdet({d}) != 0" for side in (statement.left, statement.right) for d in divisors(side) if d in names]
    covered = f"covered({vector(found)}, {vector(statement.nonzero)})" if found else "1"
    same = f"same({statement.left}, {statement.right})"
    if not statement.equal:
        at = [*_lets(statement.at), *_lets(statement.where), *lets, f"!({same})"]
        same = f"!({same}) && (()->if(1, {'; '.join(at)}))()"
    return "; ".join([*lets, " && ".join([covered, *dict.fromkeys(inverted), same])])


def _number(statement: Number) -> str:
    return f"{'between' if statement.inside else 'outside'}({statement.left}, {statement.low}, {statement.high})"


def _coefficient(statement: Coefficient) -> str:
    x, order = statement.variable, statement.power + 1
    both = statement.left, statement.right
    sides = [f"polcoef({side} + O('{x}^{order}), {statement.power}, '{x})" for side in both]
    compared = f"simplify({sides[0]} - {sides[1]}) == 0"
    return f"my({x} = '{x} + O('{x}^{order})); {compared if statement.equal else f'!({compared})'}"


def _positive(statement: Positive) -> str:
    terms = (*statement.over, *statement.under)
    signs = " && ".join(f"{term.coefficient} > 0" for term in terms)
    used = {name for term in terms for name, power in term.powers if power % 2}
    known = _strings([*statement.positive, *statement.nonnegative])
    signs += f" && signed({_strings(sorted(used))}, {known})"
    sums = [" + ".join(map(term_text, part)) for part in (statement.over, statement.under)]
    return f"{_covered(statement)} && {signs} && same(({statement.left}) * ({sums[1]}), {sums[0]})"


def _strings(words: Iterable[str]) -> str:
    return vector([f'"{word}"' for word in words])


def term_text(term: Term) -> str:
    """Return a term as an expression."""
    factors = [f"({term.coefficient})"]
    factors += [f"{name}^{power}" for name, power in term.powers]
    factors += [f"({square})^2" for square in term.squares]
    return " * ".join(factors)


def _rank(statement: Rank) -> str:
    minor = tuple(tuple(statement.matrix[i][j] for j in statement.columns) for i in statement.rows)
    free = vector([str(i + 1) for i in statement.free])
    kernel = matrix(statement.kernel) if statement.kernel and statement.kernel[0] else "matrix(0, 0)"
    small = matrix(minor) if minor else "matrix(0, 0)"
    return f"{_covered(statement)} && ranked({matrix(statement.matrix)}, {small}, {kernel}, {free}, {statement.rank})"


def _contained(statement: Contained) -> str:
    outer, inner = matrix(statement.outer), matrix(statement.inner)
    if statement.solution:
        return f"{outer} * {matrix(statement.solution)} == {inner}"
    return (
        f"my(y = {vector(statement.separator)}); y * {outer} == 0 * (y * {outer}) && y * {inner} != 0 * (y * {inner})"
    )


def _knots(statement: Knots) -> str:
    v, k = vector(statement.numbers), statement.order
    name, _, number = statement.fact.partition(" ")
    asked = {
        "points": f"#{v} - {k} == {number}",
        "increasing": f"increasing({v})",
        "clamped": f"clamped({v}, {k})",
        "single": f"single({v}, {k})",
        "equal": f"{v} == {vector(statement.other)}",
    }[name]
    return asked if statement.holds else f"!({asked})"


def _minimum(statement: Minimum) -> str:
    return f"definite({matrix(statement.matrix)}, {matrix(statement.lower)}, {vector(statement.pivots)})"


_BY_FORM: dict[str, Callable[[Any], str]] = {
    "identity": _identity,
    "positive": _positive,
    "rank": _rank,
    "contained": _contained,
    "minimum": _minimum,
    "knots": _knots,
    "matrices": _matrices,
    "number": _number,
    "coefficient": _coefficient,
}


def vector(entries: Sequence[str]) -> str:
    """Return a row vector."""
    return f"[{', '.join(entries)}]"


def matrix(rows: Matrix) -> str:
    """Return a matrix."""
    return (
        f"[{'; '.join(', '.join(row) for row in rows)}]"
        if len(rows[0]) > 1 or len(rows) > 1
        else f"Mat([{rows[0][0]}])"
    )


def statement_id(identifier: str, number: int, statement: Statement) -> str:
    """Return how a statement is named when PARI disagrees."""
    label = statement.label.replace('"', "'").replace("\\", "/")
    return f"{identifier} #{number}: {label}"


def check_lines(identifier: str, statements: Sequence[Statement]) -> list[str]:
    """Return the checks of some statements, one a line."""
    return [
        f'check("{statement_id(identifier, number, statement)}", {code(statement)});'
        for number, statement in enumerate(statements, start=1)
    ]
