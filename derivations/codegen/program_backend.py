"""Program -> text of a NumPy function that works on arrays, one input or output a plane."""

from __future__ import annotations

from collections.abc import Sequence

from sympy import Expr, Pow, Rational, count_ops

from semispline.derivations.codegen.expressions import expression_text
from semispline.derivations.codegen.python_backends import LINE_LENGTH, assignment_lines
from semispline.derivations.fairness import Program


def program_function(name: str, summary: str, source: str, program: Program) -> str:
    """Return the text of one function: `name(planes)` for an array of shape (inputs, ...) gives (outputs, ...).

    Examples
    --------
    >>> from sympy import Symbol
    >>> x, y = Symbol("x"), Symbol("y")
    >>> text = program_function("f", "Square.", "none", Program((x,), ((y, x**2),), (y,)))
    >>> text.splitlines()[-2:]
    ['    y = x**2', '    return np.stack([y])']
    """
    inputs, outputs = ([symbol.name for symbol in symbols] for symbols in (program.inputs, program.outputs))
    lines = [f"def {name}(planes: FloatArray) -> FloatArray:", f'    """{summary}', ""]
    lines += [
        *_wrapped("In", inputs),
        *_wrapped("Out", outputs),
        "",
        f"    Source: {source}. Operations: {operations(program)}.",
        '    """',
    ]
    if len(inputs) == 1:
        lines.append(f"    ({inputs[0]},) = planes")
    else:
        lines += ["    (", *_one_a_line(inputs, "        "), "    ) = planes"]
    for symbol, value in program.steps:
        lines += _step(symbol.name, value)
    line = f"    return np.stack([{', '.join(outputs)}])"
    if len(line) <= LINE_LENGTH:
        lines.append(line)
    else:
        lines += ["    return np.stack(", "        [", *_one_a_line(outputs, " " * 12), "        ]", "    )"]
    return "\n".join(lines) + "\n"


def operations(program: Program) -> int:
    """Count the operations of a program, each step's as it is printed."""
    return sum(int(count_ops(value)) for _, value in program.steps)


def program_module(title: str, source: str, programs: Sequence[tuple[str, str, Program]]) -> str:
    """Return the text of one generated file; a program is given with the name and summary of its function."""
    body = "\n\n".join(program_function(name, summary, source, program) for name, summary, program in programs)
    total = sum(operations(program) for _, _, program in programs)
    return (
        f'"""{title} (NumPy).\n\n'
        f"Written by `semispline generate` from {source}.\n"
        "Do not edit: change the derivation and generate again.\n"
        f'Operations: {total} in {len(programs)} functions.\n"""\n\n'
        "from __future__ import annotations\n\nimport numpy as np\nfrom numpy.typing import NDArray\n\n"
        f"FloatArray = NDArray[np.float64]\n\n\n{body}"
    )


def _step(name: str, value: Expr) -> list[str]:
    if isinstance(value, Pow) and value.exp == Rational(1, 2):
        return [f"    {name} = np.sqrt({expression_text(value.base)})"]
    return assignment_lines(name, value)


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
