"""Routine -> text of a C99 function, from the same steps as the Python backends."""

from __future__ import annotations

from sympy import Expr

from semispline.derivations.codegen.expressions import expression_text
from semispline.derivations.codegen.routines import Argument, Routine, routine_steps


def c_function(routine: Routine) -> str:
    """Return the text of one function; it needs no header and checks nothing.

    Matrices are written row by row into `out`, vectors one after another; what is a single number is returned.

    Parameters
    ----------
    routine : Routine

    Examples
    --------
    >>> from sympy.abc import a
    >>> double = Routine("twice", "Twice a.", "none", (Argument("a", "number", "A."),), "block", ((2 * a,),), ("b",))
    >>> print(c_function(double))
    /* Twice a. Source: none. Operations: 1. */
    double twice(double a)
    {
        return 2.0 * a;
    }
    <BLANKLINE>
    """
    steps = routine_steps(routine)
    scalar = routine.form in ("density", "block")
    arguments = [_argument(argument) for argument in routine.arguments]
    if not scalar:
        arguments.append(f"double out[{_result_size(routine)}]")
    lines = [
        f"/* {routine.summary} Source: {routine.source}. Operations: {steps.operations}. */",
        f"{'double' if scalar else 'void'} {routine.name}({', '.join(arguments) or 'void'})",
        "{",
    ]
    lines += [f"    const double {name} = {expression_text(value, 'c')};" for name, value in steps.temporaries]
    if routine.form == "matrix":
        flat = [value for row in steps.entries for value in row]
        lines += [f"    out[{k}] = {expression_text(value, 'c')};" for k, value in enumerate(flat)]
    elif routine.form == "vectors":
        lines += _loop([f"out[{3 * k} + i] = {_component(routine, row[0])};" for k, row in enumerate(steps.entries)])
    elif routine.form == "density":
        loop = _loop([f"total += {_component(routine, steps.entries[0][0])};"])
        lines += ["    double total = 0.0;", *loop, "    return total;"]
    else:
        lines.append(f"    return {expression_text(steps.entries[0][0], 'c')};")
    return "\n".join([*lines, "}", ""])


def _argument(argument: Argument) -> str:
    if argument.kind == "vector":
        return f"const double {argument.name}[3]"
    return f"double {argument.name}"


def _result_size(routine: Routine) -> int:
    if routine.form == "vectors":
        return 3 * len(routine.values)
    return sum(len(row) for row in routine.values)


def _component(routine: Routine, value: Expr) -> str:
    """Return the text for coordinate i: vectors are indexed, functions are not."""
    vectors = {argument.name for argument in routine.arguments if argument.kind == "vector"}
    indexed = {symbol: type(symbol)(f"{symbol.name}[i]") for symbol in value.free_symbols if symbol.name in vectors}
    return expression_text(value.subs(indexed, simultaneous=True), "c")


def _loop(body: list[str]) -> list[str]:
    return ["    for (int i = 0; i < 3; ++i) {", *(f"        {line}" for line in body), "    }"]
