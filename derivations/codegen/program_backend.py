"""Program -> text of a NumPy function that works on arrays, one input or output a plane."""

from __future__ import annotations

from collections.abc import Sequence

from sympy import Expr, Pow, Rational, Symbol, count_ops

from semispline.derivations.codegen.expressions import expression_text
from semispline.derivations.codegen.python_backends import LINE_LENGTH, assignment_lines
from semispline.derivations.fairness import Program, reversed_program


def program_function(name: str, summary: str, source: str, program: Program) -> str:
    """Return the text of one function: `name(planes)` for planes of one shape gives an array (outputs, ...).

    Examples
    --------
    >>> from sympy import Symbol
    >>> x, y = Symbol("x"), Symbol("y")
    >>> text = program_function("f", "Square.", "none", Program((x,), ((y, x**2),), (y,)))
    >>> text.splitlines()[-2:]
    ['    y = x**2', '    return np.stack([y])']
    """
    inputs, outputs = _names(program.inputs), _names(program.outputs)
    lines = [
        f"def {name}(planes: Iterable[FloatArray]) -> FloatArray:",
        *_docstring(summary, (("In", inputs), ("Out", outputs)), source, operations(program)),
        *_unpacked(inputs, "planes", ""),
    ]
    for symbol, value in program.steps:
        lines += _step(symbol.name, value, "")
    lines += _returned("return np.stack(", outputs, ")", "")
    return "\n".join(lines) + "\n"


def pullback_function(name: str, summary: str, source: str, program: Program) -> str:
    """Return the text of one function: `name(planes)` gives the outputs, and what turns their seeds into adjoints.

    Seeds may depend on the outputs; the steps of the program are carried out once.

    Examples
    --------
    >>> from sympy import Symbol
    >>> x, y = Symbol("x"), Symbol("y")
    >>> text = pullback_function("f", "Square.", "none", Program((x,), ((y, x**2),), (y,)))
    >>> print(text[text.index("    y =") :].rstrip())
        y = x**2
    <BLANKLINE>
        def pullback(seeds: Iterable[FloatArray]) -> FloatArray:
            (seed_y,) = seeds
            d_x = 2 * seed_y * x
            return np.stack([d_x])
    <BLANKLINE>
        return np.stack([y]), pullback
    """
    gradient = reversed_program(program)
    inputs, outputs, adjoints = _names(program.inputs), _names(program.outputs), _names(gradient.outputs)
    seeds = _names(gradient.inputs[len(inputs) :])
    known = {symbol for symbol, _ in program.steps}
    back = [(symbol, value) for symbol, value in gradient.steps if symbol not in known]
    total = operations(program) + operations(Program(program.inputs, tuple(back), ()))
    named = (("In", inputs), ("Out", outputs), ("Seeds", seeds), ("Adjoints", adjoints))
    lines = [
        f"def {name}(",
        "    planes: Iterable[FloatArray],",
        ") -> tuple[FloatArray, Callable[[Iterable[FloatArray]], FloatArray]]:",
        *_docstring(summary, named, source, total),
        *_unpacked(inputs, "planes", ""),
    ]
    for symbol, value in program.steps:
        lines += _step(symbol.name, value, "")
    lines += ["", "    def pullback(seeds: Iterable[FloatArray]) -> FloatArray:", *_unpacked(seeds, "seeds", "    ")]
    for symbol, value in back:
        lines += _step(symbol.name, value, "    ")
    lines += [*_returned("return np.stack(", adjoints, ")", "    "), ""]
    lines += _returned("return np.stack(", outputs, "), pullback", "")
    return "\n".join(lines) + "\n"


def operations(program: Program) -> int:
    """Count the operations of a program, each step's as it is printed."""
    return sum(int(count_ops(value)) for _, value in program.steps)


def program_module(title: str, source: str, functions: Sequence[str]) -> str:
    """Return the text of one generated file that holds the functions."""
    body = "\n\n".join(functions)
    # Each function says in its docstring how many it has.
    total = sum(int(text.partition("Operations: ")[2].partition(".")[0]) for text in functions)
    return (
        f'"""{title} (NumPy).\n\n'
        f"Written by `semispline generate` from {source}.\n"
        "Do not edit: change the derivation and generate again.\n"
        f'Operations: {total} in {len(functions)} functions.\n"""\n\n'
        "from __future__ import annotations\n\nfrom collections.abc import Callable, Iterable\n\n"
        "import numpy as np\nfrom numpy.typing import NDArray\n\n"
        f"FloatArray = NDArray[np.float64]\n\n\n{body}"
    )


def _names(symbols: Sequence[Symbol]) -> list[str]:
    return [symbol.name for symbol in symbols]


def _docstring(summary: str, named: Sequence[tuple[str, list[str]]], source: str, total: int) -> list[str]:
    lists = [line for head, names in named for line in _wrapped(head, names)]
    return [f'    """{summary}', "", *lists, "", f"    Source: {source}. Operations: {total}.", '    """']


def _unpacked(names: list[str], what: str, margin: str) -> list[str]:
    line = f"{margin}    ({', '.join(names)}{',' * (len(names) == 1)}) = {what}"
    if len(names) == 1:
        return [line]
    line = f"{margin}    {', '.join(names)} = {what}"
    if len(line) <= LINE_LENGTH:
        return [line]
    return [f"{margin}    (", *_one_a_line(names, margin + "        "), f"{margin}    ) = {what}"]


def _returned(before: str, names: list[str], after: str, margin: str) -> list[str]:
    line = f"{margin}    {before}[{', '.join(names)}]{after}"
    if len(line) <= LINE_LENGTH:
        return [line]
    inner = margin + " " * 8
    return [
        f"{margin}    {before}",
        f"{inner}[",
        *_one_a_line(names, inner + "    "),
        f"{inner}]",
        f"{margin}    {after}",
    ]


def _step(name: str, value: Expr, margin: str) -> list[str]:
    if isinstance(value, Pow) and value.exp == Rational(1, 2):
        return [f"{margin}    {name} = np.sqrt({expression_text(value.base)})"]
    return assignment_lines(name, value, margin + "    ")


def _one_a_line(names: Sequence[str], margin: str) -> list[str]:
    return [f"{margin}{name}," for name in names]


def _wrapped(head: str, names: Sequence[str]) -> list[str]:
    lines, line = [], f"    {head}: "
    for i, name in enumerate(names):
        word = name + ("." if i == len(names) - 1 else ", ")
        if len(line) + len(word) > LINE_LENGTH:
            lines.append(line.rstrip())
            line = "        "
        line += word
    return [*lines, line.rstrip()]
