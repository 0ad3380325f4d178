"""From trees to SymPy. Symbols come from the table of names, so that formula, oracle and check share them.

SymPy cancels, commutes and reorders while it builds: what was read is asked of the tree, what is true of this. Both
sides of a step stay apart, never an `Eq`, which may collapse while it is made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from semispline.papers.latex.errors import ConversionError
from semispline.papers.latex.names import Declaration, Names
from semispline.papers.latex.reading import Formula, Step
from semispline.papers.latex.resolving import derivative_place
from semispline.papers.latex.trees import (
    BigSum,
    Binomial,
    Call,
    Cases,
    Components,
    Derived,
    Elided,
    Factorial,
    Integral,
    Interval,
    Labelled,
    Listing,
    Matrix,
    Named,
    Number,
    Power,
    Product,
    Quotient,
    Root,
    Statement,
    Sum,
    Transpose,
    Tree,
    substituted,
    walk,
)

_FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "sin": sp.sin, "cos": sp.cos, "tan": sp.tan, "cot": sp.cot, "sec": sp.sec, "csc": sp.csc, "arcsin": sp.asin,
    "arccos": sp.acos, "arctan": sp.atan, "sinh": sp.sinh, "cosh": sp.cosh, "tanh": sp.tanh, "exp": sp.exp,
    "ln": sp.log, "log": sp.log, "sqrt": sp.sqrt, "abs": sp.Abs,
}  # fmt: skip
_RELATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "=": sp.Eq, "<": sp.Lt, ">": sp.Gt, "\\leq": sp.Le, "\\geq": sp.Ge, "\\neq": sp.Ne,
}  # fmt: skip
_CONSTANTS = {"\\pi": sp.pi, "e": sp.E}


def to_sympy(tree: Tree, names: Names, given: Mapping[str, Any] | None = None, branch: int = 1) -> Any:
    r"""Return a tree as a SymPy expression.

    Parameters
    ----------
    tree : Tree
    names : Names
        Those that it was read against.
    given : mapping, optional
        Pattern of a name -> what stands for it: an expression, or for a name with indices or arguments a callable of
        their values, indices first.
    branch : int
        1 or -1, which sign `\pm` stands for.

    Raises
    ------
    ConversionError
        The formula has no such form: shapes that do not fit, a division by zero, a kind of thing that SymPy has not.

    Examples
    --------
    >>> from semispline.papers.latex.names import read_names
    >>> from semispline.papers.latex.reading import read_formula
    >>> names = read_names("n, i : integer >= 0\nx : real\nw_i : real").of("eq-1")
    >>> to_sympy(read_formula(r"x^2 + w_{n+1}", names).statements[0].sides[0], names)
    x**2 + w_i[n + 1]
    """
    try:
        return _Conversion(names, given or {}, branch).of(tree)
    except (TypeError, ValueError, AttributeError, NotImplementedError, ZeroDivisionError) as error:
        if isinstance(error, ConversionError):
            raise
        raise ConversionError(f"{type(tree).__name__}: {error}") from error


def symbol(pattern: str, names: Names) -> Any:
    """Return what a declared name without indices and arguments converts to.

    Examples
    --------
    >>> from semispline.papers.latex.names import read_names
    >>> symbol("n", read_names("n : integer >= 0").of("eq-1")).is_nonnegative
    True
    """
    return to_sympy(Named(pattern), names)


@dataclass(frozen=True)
class Relation:
    """One step of a formula in SymPy, its two sides kept apart.

    Attributes
    ----------
    left, right : sympy.Expr or sympy.Matrix
        Names that the formula gives to expressions (`where s = i/k`) are put in; left is None where the formula
        continues a display that is not known.
    relation : str
    step : Step
        What was read.
    """

    left: Any
    relation: str
    right: Any
    step: Step


def relations(
    formula: Formula, previous: Formula | None = None, given: Mapping[str, Any] | None = None, branch: int = 1
) -> tuple[Relation, ...]:
    r"""Return the steps of a formula in SymPy.

    Parameters
    ----------
    formula : Formula
    previous : Formula, optional
        The display before, whose last side is the first one of a formula that begins with a relation.
    given, branch
        As in `to_sympy`.

    Raises
    ------
    ConversionError

    Examples
    --------
    >>> from semispline.papers.latex.names import read_names
    >>> from semispline.papers.latex.reading import read_formula
    >>> names = read_names("x, s : real").of("eq-1")
    >>> [step] = relations(read_formula(r"x = 2s, \text{where } s = x/2", names))
    >>> step.left, step.right
    (x, x)
    """
    found: list[Relation] = []
    for step in formula.steps:
        left, names = step.left, formula.names
        if left is None and previous is not None:
            left, names = previous.statements[-1].sides[-1], previous.names
        known, right = (
            None if side is None else to_sympy(_with_names_put_in(side, step.conditions), of, given, branch)
            for side, of in ((left, names), (step.right, formula.names))
        )
        found.append(Relation(known, step.relation, right, step))
    return tuple(found)


def terms(formula: Formula, given: Mapping[str, Any] | None = None, branch: int = 1) -> tuple[tuple[Any, ...], ...]:
    """Return the terms of the last side of each statement in SymPy, one by one: added up they might cancel.

    Names that the formula gives to expressions stay.

    Parameters
    ----------
    formula : Formula
    given, branch
        As in `to_sympy`.

    Raises
    ------
    ConversionError

    Examples
    --------
    >>> from semispline.papers.latex.names import read_names
    >>> from semispline.papers.latex.reading import read_formula
    >>> names = read_names("x, y : real").of("eq-1")
    >>> terms(read_formula(r"y = (1 - x) + x", names))
    ((1 - x, x),)
    """
    found = []
    for statement in formula.statements:
        side = statement.sides[-1]
        parts = side.terms if isinstance(side, Sum) else (("+", side),)
        found.append(tuple(to_sympy(Sum(((sign, part),)), formula.names, given, branch) for sign, part in parts))
    return tuple(found)


def _with_names_put_in(tree: Tree, conditions: tuple[Statement, ...]) -> Tree:
    """Return a tree with each name replaced that a condition gives; inside of sums too, before SymPy sees it."""
    given: Any = tree
    meanings = [condition.sides for condition in conditions if _gives_name(condition)]
    # A meaning may have names in it that others give, before it or after it.
    for _ in meanings:
        for name, meaning in meanings:
            given = substituted(given, name, meaning)
    return given


def _gives_name(condition: Statement) -> bool:
    name = condition.sides[0]
    is_name = isinstance(name, Named) and not name.slots and name.arguments is None
    is_equation = condition.relations == ("=",) and not condition.conditions
    return is_name and is_equation and name not in walk(condition.sides[1])


class _Conversion:
    def __init__(self, names: Names, given: Mapping[str, Any], branch: int) -> None:
        self.names, self.given, self.branch = names, given, branch

    def of(self, tree: Tree) -> Any:
        match tree:
            case Number(text):
                return sp.Rational(text)
            case Named():
                return self._named(tree)
            case Sum(terms):
                return self._sum(terms)
            case Product(factors):
                product = self.of(factors[0])
                for factor in factors[1:]:
                    product = product * self.of(factor)
                return product
            case Quotient(numerator, denominator):
                below = self.of(denominator)
                if below == 0:
                    raise ConversionError("a division by zero")
                return self.of(numerator) / below
            case Power(base, exponent):
                return self.of(base) ** self.of(exponent)
            case Transpose(matrix):
                return self.of(matrix).T
            case Factorial(argument):
                return sp.factorial(self.of(argument))
            case Binomial(above, below_):
                return sp.binomial(self.of(above), self.of(below_))
            case Call(function, argument):
                return self._call(function, self.of(argument))
            case Root(degree, radicand):
                return sp.root(self.of(radicand), self.of(degree))
            case _:
                return self._structure(tree)

    def _structure(self, tree: Tree) -> Any:
        match tree:
            case Matrix(rows):
                return self._matrix(rows)
            case Listing(brackets, entries):
                values = [self.of(entry) for entry in entries]
                return sp.ImmutableMatrix(values) if brackets == "()" else sp.Tuple(*values)
            case Components(entries_):
                return sp.ImmutableMatrix([self.of(value) for _, value in entries_])
            case Labelled(content, _):
                return self.of(content)
            case Elided(_, _, start, end, _):
                k = sp.Dummy("k", integer=True)
                return sp.Sum(self._term_of(tree, k), (k, self.of(start), self.of(end)))
            case BigSum(index, lower, upper, body):
                limits = self.of(index), self.of(lower), self.of(upper)
                return _each(self.of(body), lambda term: sp.Sum(term, limits))
            case Integral(variable, lower, upper, body):
                limits = self.of(variable), self.of(lower), self.of(upper)
                return _each(self.of(body), lambda term: sp.Integral(term, limits))
            case Derived(body, variable, order):
                by = self.of(variable), self.of(order)
                return _each(self.of(body), lambda term: sp.Derivative(term, by))
            case Interval(brackets, lower, upper):
                return sp.Interval(self.of(lower), self.of(upper), brackets[0] == "(", brackets[1] == ")")
            case Cases(cases):
                return sp.Piecewise(*((self.of(v), True if c is None else self._condition(c)) for v, c in cases))
        raise ConversionError(f"{type(tree).__name__} has no form in SymPy")

    def _condition(self, statement: Statement) -> Any:
        sides = [self.of(side) for side in statement.sides]
        found = []
        for k, relation in enumerate(statement.relations):
            if relation == "\\in" and isinstance(sides[k + 1], sp.Interval):
                found.append(sides[k + 1].as_relational(sides[k]))
            elif relation in _RELATIONS:
                found.append(_RELATIONS[relation](sides[k], sides[k + 1]))
            else:
                raise ConversionError(f"the relation {relation} is no condition")
        return sp.And(*found)

    def _sum(self, terms: tuple[tuple[str, Tree], ...]) -> Any:
        factor = {"+": 1, "-": -1, "\\pm": self.branch, "\\mp": -self.branch}
        total: Any = None
        for sign, term in terms:
            value = self.of(term) if factor[sign] == 1 else -self.of(term)
            total = value if total is None else total + value
        return total

    def _call(self, function: str, argument: Any) -> Any:
        if function == "norm":
            if isinstance(argument, sp.MatrixBase):
                return sp.sqrt(sum(entry**2 for entry in argument))
            return sp.Function("norm")(argument)
        if function not in _FUNCTIONS:
            raise ConversionError(f"{function} is a standard function of the table, and not known to SymPy")
        return _FUNCTIONS[function](argument)

    def _matrix(self, rows: tuple[tuple[Tree, ...], ...]) -> Any:
        only = rows[0][0]
        if isinstance(only, Elided):
            start, end = self.of(only.start), self.of(only.end)
            i, j = sp.Dummy("i", integer=True), sp.Dummy("j", integer=True)
            return sp.FunctionMatrix(1, end - start + 1, sp.Lambda((i, j), self._term_of(only, start + j)))
        values = [[self.of(cell) for cell in row] for row in rows]
        if any(isinstance(value, sp.MatrixBase | sp.MatrixExpr) for row in values for value in row):
            raise ConversionError("a matrix within a matrix")
        return sp.ImmutableMatrix(values)

    def _term_of(self, elided: Elided, k: Any) -> Any:
        """Return the term of an elided sum or row for any value of what changes."""
        place = Named("")
        return _Conversion(self.names, {**self.given, "": k}, self.branch).of(
            _template(elided.first, elided.last, place)
        )

    def _named(self, tree: Named) -> Any:
        name = tree.name
        slots = [self.of(slot) for slot in tree.slots]
        if not name:
            return self.given[""]
        d = self.names.by_pattern[name]
        letters = d.arguments
        if letters is None:
            if name in self.given:
                return self.given[name](*slots) if slots else self.given[name]
            return _value(d, slots)
        arguments = (
            [self.of(Named(letter)) for letter in letters]
            if tree.arguments is None
            else [self.of(a) for a in tree.arguments]
        )

        def applied(values: list[Any]) -> Any:
            return self.given[name](*slots, *values) if name in self.given else _applied(d, [*slots, *values])

        if not tree.derivative:
            return applied(arguments)
        place = derivative_place(d, self.names)
        assert place is not None
        argument = arguments[place]
        variable = argument if isinstance(argument, sp.Symbol) else sp.Dummy(letters[place], real=True)
        value = applied([*arguments[:place], variable, *arguments[place + 1 :]])
        derivative = _each(value, lambda entry: sp.Derivative(entry, (variable, tree.derivative)))
        return (
            derivative if variable is argument else _each(derivative, lambda entry: sp.Subs(entry, variable, argument))
        )


def _each(value: Any, change: Callable[[Any], Any]) -> Any:
    return value.applyfunc(change) if isinstance(value, sp.MatrixBase) else change(value)


def _assumptions(d: Declaration) -> dict[str, bool]:
    found = {"integer": True} if d.value == "integer" else {"real": True}
    if d.range == ">= 0":
        found["nonnegative"] = True
    elif d.range in ("> 0", ">= 1"):
        found["positive"] = True
    return found


def _value(d: Declaration, slots: list[Any]) -> Any:
    if d.kind == "constant":
        if d.pattern not in _CONSTANTS:
            raise ConversionError(f"{d.pattern} is a constant of the table, and not known to SymPy")
        return _CONSTANTS[d.pattern]
    if d.value == "plane point":
        return sp.ImmutableMatrix([_letter(f"{d.pattern}.{c}", slots, {"real": True}) for c in "xy"])
    if d.value == "matrix":
        rows, columns = (
            (sp.Integer(s) if s.isdigit() else sp.Symbol(s, integer=True, positive=True) for s in d.size)
            if d.size
            else [sp.Symbol("rows", integer=True, positive=True)] * 2
        )
        text = f"{d.pattern}{slots}" if slots else d.pattern
        return sp.MatrixSymbol(text, rows, columns)
    if d.value == "list":
        return sp.Symbol(d.pattern)
    return _letter(d.pattern, slots, _assumptions(d))


def _letter(name: str, slots: list[Any], assumptions: dict[str, bool]) -> Any:
    return sp.IndexedBase(name, **assumptions)[tuple(slots)] if slots else sp.Symbol(name, **assumptions)


def _applied(d: Declaration, arguments: list[Any]) -> Any:
    if d.value == "plane point":
        return sp.ImmutableMatrix([sp.Function(f"{d.pattern}.{c}", real=True)(*arguments) for c in "xy"])
    return sp.Function(d.pattern, real=True)(*arguments)


def _template(one: Any, other: Any, place: Named) -> Any:
    """Return the first of two trees with a place where they differ."""
    if one == other:
        return one
    if isinstance(one, tuple):
        return tuple(_template(a, b, place) for a, b in zip(one, other, strict=True))
    others = isinstance(one, Number) or (isinstance(one, Named) and one.name != other.name)
    if type(one) is not type(other) or others:
        return place
    return replace(one, **{f: _template(getattr(one, f), getattr(other, f), place) for f in one.__dataclass_fields__})
