"""What was read, written as LaTeX again: every product with its dot, every bracket that groups, nothing else.

The echo stands beside the printed formula and is read in its place: read again it gives the same tree.
"""

from __future__ import annotations

from semispline.papers.latex.names import Declaration, Names, Slot
from semispline.papers.latex.tokens import FUNCTIONS
from semispline.papers.latex.trees import (
    BigSum,
    Binomial,
    Call,
    Cases,
    Components,
    Condition,
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
)

_BARS = {"abs": (r"\left|", r"\right|"), "norm": (r"\left||", r"\right||")}


def echo(statements: tuple[Statement, ...], names: Names) -> str:
    r"""Return a display that reads as these statements, a line for each side.

    Examples
    --------
    >>> from semispline.papers.latex.names import read_names
    >>> from semispline.papers.latex.reading import read_formula
    >>> names = read_names("a, b, x : real").of("eq-1")
    >>> print(echo(read_formula("x = 2ab", names).statements, names))
    x = 2 \cdot a \cdot b
    """
    rows: list[list[str]] = []
    for statement in statements:
        rows += _rows(statement, names, is_first=not rows)
    # In a line of its own a relation needs no column mark before it.
    if len(rows) == 1:
        return "".join(rows[0])
    return "\\begin{aligned}\n" + " \\\\\n".join("&".join(row) for row in rows) + "\n\\end{aligned}"


def echo_statement(statement: Statement, names: Names) -> str:
    """Return one statement in one line, without its conditions."""
    offset = 0 if statement.continues else 1
    text = ""
    for k, side in enumerate(statement.sides):
        if k or statement.continues:
            text += f"{' ' if k else ''}{statement.relations[k - offset]} "
        text += _text(side, names)
    return text


def _rows(statement: Statement, names: Names, is_first: bool) -> list[list[str]]:
    """Return a statement line by line, in cells; a condition stands in the line that it holds from."""
    rows = [["", f" {statement.after}"]] if statement.after else []
    starts = {c.since for c in statement.conditions}
    offset = 0 if statement.continues else 1
    row = [""]
    since = 0
    for k, side in enumerate(statement.sides):
        if k == 0 and not statement.continues:
            # A line that began with a sign would continue a sum.
            signed = isinstance(side, Sum) and side.terms[0][0] != "+" and not is_first and not statement.after
            row = [_bracketed(side, names) if signed else _text(side, names)]
            continue
        if k > 1 or (k and (k in starts or statement.continues)):
            rows.append([*row[:-1], row[-1] + _conditions(statement, since, names)])
            row, since = [""], k
        space = " " if row[0] else ""
        row = [row[0] + space, f"{statement.relations[k - offset]} {_text(side, names)}"]
    rows.append([*row[:-1], row[-1] + _conditions(statement, since, names)])
    return rows


def _conditions(statement: Statement, since: int, names: Names) -> str:
    return "".join(_condition(c, names) for c in statement.conditions if c.since == since)


def _condition(condition: Condition, names: Names) -> str:
    within = "".join(_condition(inner, names) for inner in condition.statement.conditions)
    return f",\\ \\text{{{condition.word}}}\\ {echo_statement(condition.statement, names)}{within}"


def echo_tree(tree: Tree, names: Names) -> str:
    """Return one expression."""
    return _text(tree, names)


def _text(tree: Tree, names: Names) -> str:
    match tree:
        case Number(text):
            return text
        case Named():
            return _named(tree, names)
        case Sum(terms):
            return _sum(terms, names)
        case Product(factors):
            return " \\cdot ".join(_factor(factor, names, k + 1 == len(factors)) for k, factor in enumerate(factors))
        case Quotient(numerator, denominator):
            return f"\\frac{{{_text(numerator, names)}}}{{{_text(denominator, names)}}}"
        case Power(base, exponent):
            return f"{_base(base, names)}^{{{_text(exponent, names)}}}"
        case Transpose(matrix):
            return _transposed(matrix, names)
        case Factorial(argument):
            return f"{_base(argument, names)}!"
        case Binomial(above, below):
            return f"\\binom{{{_text(above, names)}}}{{{_text(below, names)}}}"
        case Call(function, argument):
            return _call(function, _text(argument, names))
        case Root(degree, radicand):
            return f"\\sqrt[{_text(degree, names)}]{{{_text(radicand, names)}}}"
        case _:
            return _structure(tree, names)


def _structure(tree: Tree, names: Names) -> str:
    match tree:
        case Matrix(rows):
            return _matrix(rows, names)
        case Listing(brackets, entries):
            inner = ", ".join(_text(entry, names) for entry in entries)
            return f"\\left({inner}\\right)" if brackets == "()" else f"\\left\\{{{inner}\\right\\}}"
        case Components(entries_):
            rows_ = " \\\\ ".join(f"{_text(name, names)} = {_text(value, names)}" for name, value in entries_)
            return f"\\begin{{bmatrix}} {rows_} \\end{{bmatrix}}"
        case Labelled(content, label):
            return f"{_text(content, names)}_{{{label}}}"
        case Elided(_, last, _, _, printed):
            return " + ".join([*(_term(term, names) for term in printed), "...", _term(last, names)])
        case BigSum(index, lower, upper, body):
            limits = f"\\sum_{{{_text(index, names)} = {_text(lower, names)}}}^{{{_text(upper, names)}}}"
            return f"{limits} {_behind(body, names)}"
        case Integral(variable, lower, upper, body):
            limits = f"\\int_{{{_text(lower, names)}}}^{{{_text(upper, names)}}}"
            return f"{limits} {_behind(body, names)}\\, d{_text(variable, names)}"
        case Derived(body, variable, order):
            return _derived(body, variable, order, names)
        case Interval(brackets, lower, upper):
            return f"{brackets[0]}{_text(lower, names)}, {_text(upper, names)}{brackets[1]}"
        case Cases(cases):
            rows_ = " \\\\ ".join(
                f"{_text(value, names)} & "
                + (f"\\text{{if }} {echo_statement(c, names)}" if c else "\\text{otherwise}")
                for value, c in cases
            )
            return f"\\left\\{{ \\begin{{matrix}} {rows_} \\end{{matrix}} \\right."
    raise TypeError(f"{type(tree).__name__} is no tree")


def _sum(terms: tuple[tuple[str, Tree], ...], names: Names) -> str:
    text = ""
    for k, (sign, term) in enumerate(terms):
        lead = "" if k == 0 and sign == "+" else sign if k == 0 else f" {sign} "
        text += f"{lead}{_term(term, names)}"
    return text


def _term(term: Tree, names: Names) -> str:
    # A sum of signed terms needs its bracket, and so do dots, which are one.
    return _bracketed(term, names) if isinstance(term, Sum | Elided) else _text(term, names)


def _factor(factor: Tree, names: Names, is_last: bool) -> str:
    closed = not isinstance(factor, Sum | Product | Elided | Integral) and (is_last or not isinstance(factor, BigSum))
    if isinstance(factor, Derived) and _is_operator(factor):
        closed = is_last
    return _text(factor, names) if closed else _bracketed(factor, names)


def _behind(body: Tree, names: Names) -> str:
    return _bracketed(body, names) if isinstance(body, Sum | Elided) else _text(body, names)


def _base(base: Tree, names: Names) -> str:
    if isinstance(base, Number | Matrix):
        return f"{{{_text(base, names)}}}" if isinstance(base, Matrix) else _text(base, names)
    if isinstance(base, Named):
        declaration = names.by_pattern[base.name]
        # A script above that is part of the name leaves no room for an exponent.
        return _bracketed(base, names) if declaration.above and declaration.arguments is None else _text(base, names)
    return _bracketed(base, names)


def _bracketed(tree: Tree, names: Names) -> str:
    return f"\\left( {_text(tree, names)} \\right)"


def _call(function: str, argument: str) -> str:
    if function in _BARS:
        opening, closing = _BARS[function]
        return f"{opening} {argument} {closing}"
    if function == "sqrt":
        return f"\\sqrt{{{argument}}}"
    # A name that LaTeX has no macro for is a word of the table.
    return f"{f'{chr(92)}{function}' if function in FUNCTIONS else function}\\left( {argument} \\right)"


def _transposed(matrix: Tree, names: Names) -> str:
    if (
        isinstance(matrix, Matrix)
        and len(matrix.rows) == 1
        and len(matrix.rows[0]) == 1
        and isinstance(matrix.rows[0][0], Elided)
    ):
        elided = matrix.rows[0][0]
        entries = " \\\\ ".join([*(_text(x, names) for x in elided.printed), "...", _text(elided.last, names)])
        return f"\\begin{{bmatrix}} {entries} \\end{{bmatrix}}"
    return f"{_base(matrix, names)}^T"


def _matrix(rows: tuple[tuple[Tree, ...], ...], names: Names) -> str:
    if len(rows) == 1 and len(rows[0]) == 1 and isinstance(rows[0][0], Elided):
        elided = rows[0][0]
        entries = " & ".join([*(_text(x, names) for x in elided.printed), "...", _text(elided.last, names)])
        return f"\\begin{{bmatrix}} {entries} \\end{{bmatrix}}"
    lines = " \\\\ ".join(" & ".join(_text(cell, names) for cell in row) for row in rows)
    return f"\\begin{{bmatrix}} {lines} \\end{{bmatrix}}"


def _is_operator(derived: Derived) -> bool:
    """Whether a derivative is written d/dt before what it differentiates, not as a fraction like dx/dt."""
    return not isinstance(derived.body, Named) or derived.order != Number("1")


def _derived(body: Tree, variable: Tree, order: Tree, names: Names) -> str:
    by = _text(variable, names)
    if not _is_operator(Derived(body, variable, order)):
        return f"\\frac{{\\partial {_text(body, names)}}}{{\\partial {by}}}"
    power = "" if order == Number("1") else f"^{{{_text(order, names)}}}"
    inner = _text(body, names) if isinstance(body, Named) else _bracketed(body, names)
    return f"\\frac{{\\partial{power}}}{{\\partial {by}{power}}} {inner}"


def _named(tree: Named, names: Names) -> str:
    declaration = names.by_pattern[tree.name]
    slots = [_text(slot, names) for slot in tree.slots]
    text = _head(declaration)
    used = 0
    scripts: list[str] = []
    for groups, mark in ((declaration.below, "_"), (declaration.above, "^")):
        for group in groups:
            count = sum(slot.is_index for slot in group)
            scripts.append(f"{mark}{{{_script(group, slots[used : used + count])}}}")
            used += count
    if len(declaration.below) > 1:
        text, scripts = f"{{{text}{scripts[0]}}}", scripts[1:]
    text += "'" * (declaration.primes + tree.derivative) + "".join(scripts)
    if declaration.bracket:
        return f"{text}[{slots[used]}]"
    if tree.arguments is not None:
        text += f"\\left({', '.join(_text(argument, names) for argument in tree.arguments)}\\right)"
        for group in declaration.after:
            count = sum(slot.is_index for slot in group)
            text += f"_{{{_script(group, slots[used : used + count])}}}"
            used += count
    return text


def _head(declaration: Declaration) -> str:
    head = declaration.head
    # Words stand upright, so that they are not taken for products of their letters.
    return f"\\mathrm{{{head}}}" if len(head) > 1 and head.isalnum() else head


def _script(group: tuple[Slot, ...], slots: list[str]) -> str:
    values = iter(slots)
    return ", ".join(next(values) if slot.is_index else slot.text for slot in group)
