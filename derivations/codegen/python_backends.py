"""Routine -> text of a NumPy or CasADi function; list of routines -> text of a module.

Both go through `_function`; a backend says only how arguments are checked and how a result is put together.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from sympy import Expr

from semispline.derivations.codegen.expressions import expression_text, summands
from semispline.derivations.codegen.routines import Argument, Routine, routine_steps

LINE_LENGTH = 120


@dataclass(frozen=True)
class Backend:
    """What differs between the two Python targets.

    Parameters
    ----------
    title : str
        For the first line of the module.
    imports : str
    types : dict
        Argument kind to its annotation; "result" to that of one array.
    checks : dict
        Argument kind to the text of the helper that checks it.
    shapes : dict
        Argument kind to the words of the docstring.
    matrix : callable
        Rows of entries to the name of a function and the arguments to call it with.
    total : callable
        Name of a vector to the text of the sum over its coordinates.
    """

    title: str
    imports: str
    types: dict[str, str]
    checks: dict[str, str]
    shapes: dict[str, str]
    matrix: Callable[[list[list[str]]], tuple[str, list[str]]]
    total: Callable[[str], str]


_SHAPES = {
    "number": "a number",
    "degree": "a number, at least {least}",
    "span": "a positive number",
    "block": "a number or a matrix, the same shape for all matrices",
}

_NUMPY_CHECKS = {
    "number": """\
def _number(name: str, value: float) -> float:
    if np.shape(value) != ():
        raise ValueError(f"{name}: shape {np.shape(value)}, expected a single number of shape ()")
    return float(value)
""",
    "degree": """\
def _degree(name: str, value: float, least: int) -> float:
    degree = _number(name, value)
    if not degree >= least:
        raise ValueError(f"{name}: found {value}, expected a degree of at least {least}")
    return degree
""",
    "span": """\
def _span(name: str, value: float) -> float:
    span = _number(name, value)
    if not span > 0:
        raise ValueError(f"{name}: found {value}, expected a positive distance of knots")
    return span
""",
    "vector": """\
def _vector(name: str, value: ArrayLike, like: FloatArray | None = None) -> FloatArray:
    vector = np.asarray(value, dtype=np.float64)
    if vector.shape[-1:] != (3,) or (like is not None and vector.shape != like.shape):
        raise ValueError(f"{name}: shape {vector.shape}, expected {'(..., 3)' if like is None else like.shape}")
    return vector
""",
    "function": """\
def _function(name: str, value: ArrayLike, like: FloatArray) -> FloatArray:
    function = np.asarray(value, dtype=np.float64)
    if function.shape not in ((), like.shape[:-1]):
        raise ValueError(f"{name}: shape {function.shape}, expected () or {like.shape[:-1]}")
    return function[..., None]
""",
    "block": """\
def _same_shape(**blocks: Any) -> None:
    shapes = {name: np.shape(block) for name, block in blocks.items()}
    expected = max(shapes.values(), key=len)
    for name, shape in shapes.items():
        if shape not in ((), expected):
            raise ValueError(f"{name}: shape {shape}, expected () or {expected}")
""",
}

_CASADI_CHECKS = {
    "number": """\
def _number(name: str, value: Any) -> Any:
    shape = tuple(getattr(value, "shape", ()))
    if shape not in ((), (1, 1)):
        raise ValueError(f"{name}: shape {shape}, expected a single number of shape () or (1, 1)")
    return value
""",
    "degree": """\
def _degree(name: str, value: Any, least: int) -> Any:
    degree = _number(name, value)
    if not isinstance(degree, (casadi.SX, casadi.MX)) and not float(degree) >= least:
        raise ValueError(f"{name}: found {value}, expected a degree of at least {least}")
    return degree
""",
    "span": """\
def _span(name: str, value: Any) -> Any:
    span = _number(name, value)
    if not isinstance(span, (casadi.SX, casadi.MX)) and not float(span) > 0:
        raise ValueError(f"{name}: found {value}, expected a positive distance of knots")
    return span
""",
    "vector": """\
def _vector(name: str, value: Any) -> Any:
    vector = value if isinstance(value, (casadi.SX, casadi.MX, casadi.DM)) else casadi.DM(value)
    if tuple(vector.shape) != (3, 1):
        raise ValueError(f"{name}: shape {tuple(vector.shape)}, expected (3, 1)")
    return vector
""",
    "function": """\
def _function(name: str, value: Any) -> Any:
    shape = tuple(getattr(value, "shape", ()))
    if shape not in ((), (1, 1)):
        raise ValueError(f"{name}: shape {shape}, expected a single number of shape () or (1, 1)")
    return value
""",
    "block": """\
def _same_shape(**blocks: Any) -> None:
    shapes = {name: tuple(getattr(block, "shape", ())) for name, block in blocks.items()}
    expected = max(shapes.values(), key=lambda shape: (len(shape), shape))
    for name, shape in shapes.items():
        if shape not in ((), (1, 1), expected):
            raise ValueError(f"{name}: shape {shape}, expected () or {expected}")
""",
}

NUMPY = Backend(
    title="NumPy",
    imports="from typing import Any\n\nimport numpy as np\nfrom numpy.typing import ArrayLike, NDArray",
    types={
        **dict.fromkeys(("number", "degree", "span"), "float"),
        **dict.fromkeys(("vector", "function"), "ArrayLike"),
        "block": "Any",
        "result": "FloatArray",
    },
    checks=_NUMPY_CHECKS,
    shapes=_SHAPES | {"vector": "shape (..., 3), the same for all", "function": "a number, or shape (...)"},
    matrix=lambda rows: (
        "np.array",
        ["[" + ", ".join(f"[{', '.join(row)}]" for row in rows) + "]", "dtype=np.float64"],
    ),
    total=lambda name: f"np.asarray(np.sum({name}, axis=-1))",
)

CASADI = Backend(
    title="CasADi",
    imports="from typing import Any\n\nimport casadi",
    types=dict.fromkeys(("number", "degree", "span", "vector", "function", "block", "result"), "Any"),
    checks=_CASADI_CHECKS,
    shapes=_SHAPES | {"vector": "shape (3, 1)", "function": "a number"},
    matrix=lambda rows: ("casadi.vertcat", [f"casadi.horzcat({', '.join(row)})" for row in rows]),
    total=lambda name: f"casadi.sum1({name})",
)


def python_function(routine: Routine, backend: Backend) -> str:
    """Return the text of one function.

    Parameters
    ----------
    routine : Routine
    backend : Backend
        `NUMPY` or `CASADI`.
    """
    steps = routine_steps(routine)
    lines = [_signature(routine, backend)]
    lines += _docstring(routine, backend, steps.operations)
    lines += _check_lines(routine.arguments, backend)
    for name, value in steps.temporaries:
        lines += assignment_lines(name, value)
    lines += _result(routine, backend, steps.entries)
    return "\n".join(lines) + "\n"


def python_text(routines: Sequence[Routine], backend: Backend) -> str:
    """Return imports, the helpers that check arguments, and the functions: runnable as it stands.

    Parameters
    ----------
    routines : sequence of Routine
    backend : Backend
        `NUMPY` or `CASADI`.
    """
    functions = [python_function(routine, backend) for routine in routines]
    helpers = [text for text in backend.checks.values() if _called(text, functions)]
    # A helper may call another.
    helpers = [text for text in backend.checks.values() if _called(text, [*functions, *helpers])]
    body = "\n\n".join([*helpers, *functions])
    return f"{_needed_imports(backend, body)}\n\n\n{body}"


def python_module(title: str, sources: Sequence[str], routines: Sequence[Routine], backend: Backend) -> str:
    """Return the text of one generated file.

    Parameters
    ----------
    title : str
        What the file holds.
    sources : sequence of str
        Paths of the derivations, relative to the checkout.
    routines : sequence of Routine
    backend : Backend
    """
    operations = sum(routine_steps(routine).operations for routine in routines)
    return (
        f'"""{title} ({backend.title}).\n\n'
        f"Written by `semispline generate` from {' and '.join(sources)}.\n"
        "Do not edit: change the derivation and generate again.\n"
        f'Operations: {operations} in {len(routines)} functions.\n"""\n\n'
        f"from __future__ import annotations\n\n{python_text(routines, backend)}"
    )


def _called(helper: str, texts: Sequence[str]) -> bool:
    name = helper.removeprefix("def ").split("(")[0]
    return any(f" {name}(" in text.replace(f"def {name}(", "") for text in texts)


def _needed_imports(backend: Backend, body: str) -> str:
    lines = [
        line.replace("ArrayLike, ", "") if "ArrayLike" not in body else line
        for line in backend.imports.splitlines()
        if line != "from typing import Any" or "Any" in body
    ]
    text = "\n".join(lines).lstrip("\n")
    if "FloatArray" in body:
        text += "\n\nFloatArray = NDArray[np.float64]"
    return text


def _signature(routine: Routine, backend: Backend) -> str:
    arguments = [f"{argument.name}: {backend.types[argument.kind]}" for argument in routine.arguments]
    single = backend.types["result"]
    result = f"tuple[{', '.join([single] * len(routine.names))}]" if len(routine.names) > 1 else single
    if routine.form == "block":
        result = "Any"
    return _call(f"def {routine.name}", arguments, f" -> {result}:")


def _docstring(routine: Routine, backend: Backend, operations: int) -> list[str]:
    lines = [f'    """{routine.summary}', ""]
    if routine.arguments:
        lines += ["    Parameters", "    ----------"]
    for argument in routine.arguments:
        shape = backend.shapes[argument.kind].format(least=argument.least)
        lines += [f"    {argument.name} : {shape}", f"        {argument.meaning}"]
    if routine.arguments:
        lines += [""]
    lines += ["    Returns", "    -------"]
    for name in routine.names:
        lines.append(f"    {name} : {_result_shape(routine, backend)}")
    if routine.arguments:
        lines += [
            "",
            "    Raises",
            "    ------",
            "    ValueError",
            "        Naming the argument and what it should be.",
        ]
    lines += ["", f"    Source: {routine.source}. Operations: {operations}.", '    """']
    return lines


def _result_shape(routine: Routine, backend: Backend) -> str:
    if routine.form == "matrix":
        return f"matrix, shape ({len(routine.values)}, {len(routine.values[0])})"
    if routine.form == "density":
        return "shape (...)" if backend is NUMPY else "a number"
    return backend.shapes["vector" if routine.form == "vectors" else "block"]


def _check_lines(arguments: Sequence[Argument], backend: Backend) -> list[str]:
    lines = []
    vectors = [argument.name for argument in arguments if argument.kind == "vector"]
    blocks = [argument.name for argument in arguments if argument.kind == "block"]
    for argument in arguments:
        extra = {"degree": f", {argument.least}"}.get(argument.kind, "")
        if backend is NUMPY and argument.kind in ("vector", "function") and argument.name != vectors[0]:
            extra = f", {vectors[0]}"
        if argument.kind != "block":
            helper = f"_{argument.kind}"
            lines.append(f'    {argument.name} = {helper}("{argument.name}", {argument.name}{extra})')
    if blocks:
        lines.append(f"    _same_shape({', '.join(f'{name}={name}' for name in blocks)})")
    return lines


def assignment_lines(name: str, value: Expr, margin: str = "    ") -> list[str]:
    """Return an assignment on one line, or broken the way `ruff format` breaks it."""
    line = f"{margin}{name} = {expression_text(value)}"
    terms = summands(value)
    if len(line) <= LINE_LENGTH or len(terms) == 1:
        return [line]
    packed = f"{margin}    {' '.join(terms)}"
    inside = [packed] if len(packed) <= LINE_LENGTH else [f"{margin}    {term}" for term in terms]
    return [f"{margin}{name} = (", *inside, f"{margin})"]


def _result(routine: Routine, backend: Backend, entries: Sequence[Sequence[Expr]]) -> list[str]:
    if routine.form == "block":
        return [f"    return {expression_text(entries[0][0])}"]
    if routine.form == "density":
        return [*assignment_lines(routine.names[0], entries[0][0]), f"    return {backend.total(routine.names[0])}"]
    if routine.form == "vectors":
        lines = []
        for name, (value,) in zip(routine.names, entries, strict=True):
            lines += assignment_lines(name, value)
        return [*lines, f"    return {', '.join(routine.names)}"]
    lines, rows = [], []
    for i, row in enumerate(entries):
        names = []
        for j, value in enumerate(row):
            if value.is_Atom:
                names.append(f"{value}.0" if value.is_Integer else expression_text(value))
            else:
                names.append(f"c{i}_{j}")
                lines += assignment_lines(f"c{i}_{j}", value)
        rows.append(names)
    name, arguments = backend.matrix(rows)
    return [*lines, _call(f"    return {name}", arguments, "")]


def _call(head: str, arguments: Sequence[str], tail: str) -> str:
    """Return `head(arguments)tail` on one line, or broken the way `ruff format` breaks it."""
    line = f"{head}({', '.join(arguments)}){tail}"
    if len(line) <= LINE_LENGTH:
        return line
    margin = " " * (len(head) - len(head.lstrip()))
    packed = f"{margin}    {', '.join(arguments)}"
    if len(packed) > LINE_LENGTH:
        packed = "\n".join(f"{_item(argument, margin + '    ')}," for argument in arguments)
    return f"{head}(\n{packed}\n{margin}){tail}"


def _item(text: str, margin: str) -> str:
    """Return one item of a broken call; a list of lists that does not fit on its line goes row by row."""
    if len(margin) + len(text) + 1 <= LINE_LENGTH or not text.startswith("[["):
        return margin + text
    rows = text[2:-2].split("], [")
    return "\n".join([f"{margin}[", *(f"{margin}    [{row}]," for row in rows), f"{margin}]"])
