"""Where a source file can be broken, and how: one small change of its text for each mutant."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from hashlib import sha256
from typing import Any

_COMPARISONS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "is": ("is not",), "is not": ("is",), "in": ("not in",), "not in": ("in",),
}  # fmt: skip
_ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "**": "*", "//": "/", "%": "*"}
_UNTOUCHED = (ast.MatMult, ast.LShift, ast.RShift, ast.BitAnd, ast.BitOr, ast.BitXor)
_SWAPS = [("min", "max"), ("minimum", "maximum"), ("argmin", "argmax"), ("any", "all"), ("floor", "ceil")]
_SWAPPED = dict(_SWAPS) | {b: a for a, b in _SWAPS}
_BOUNDING = {"min", "max", "minimum", "maximum"}
_TRANSPARENT = {"min", "max", "minimum", "maximum", "abs", "sqrt"}
_COMPARISON = re.compile(rb"<=|>=|==|!=|<|>|\bis\s+not\b|\bnot\s+in\b|\bis\b|\bin\b")
_OPERATOR = re.compile(rb"\*\*|//|[-+*/%&|]")
_BOOLEAN = re.compile(rb"\band\b|\bor\b")
# What allows for rounding is a limit too, though no comparison stands beside it.
_ALLOWANCE = re.compile(rb"tol|limit|round|noise|\beps\b|factor|thresh|allow", re.IGNORECASE)
# Counts up to this many are broken by one, larger ones by a factor.
_FEW = 10
# A float below this, or one over it and more, is taken for a tolerance wherever it stands.
_TINY = 1e-3


@dataclass(frozen=True)
class Mutant:
    """One change of one file: `source[start:end]` becomes `new`.

    `complete` tells limits, thresholds and their comparisons from the rest, which is sampled.
    `names` are the module's names that the changed statement defines, where it belongs to no function; `around` is the
    code of the function, or of the statement, without its comments.
    """

    file: str
    function: str
    line: int
    text: str
    change: str
    complete: bool
    start: int
    end: int
    new: bytes
    lines: tuple[int, int]
    names: tuple[str, ...] = ()
    around: str = field(default="", repr=False)
    occurrence: int = 0

    @property
    def key(self) -> str:
        """What stays when other lines of the file change."""
        parts = (self.file, self.function, self.text, self.change, str(self.occurrence))
        return sha256("\0".join(parts).encode()).hexdigest()[:16]

    def apply(self, source: bytes) -> bytes:
        """Return the broken source."""
        return source[: self.start] + self.new + source[self.end :]


def mutants_of(file: str, source: bytes) -> list[Mutant]:
    """Return all mutants of a file, in the order of its lines."""
    tree = ast.parse(source)
    parents = {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}
    offsets = [0]
    for row in source.split(b"\n"):
        offsets.append(offsets[-1] + len(row) + 1)
    rows = source.decode().split("\n")
    place = _Place(source, offsets, parents)
    seen: Counter[tuple[str, ...]] = Counter()
    texts: dict[ast.AST, str] = {}
    found = []
    for node in ast.walk(tree):
        if not hasattr(node, "lineno") or _is_left_alone(node, parents):
            continue
        function, lines, names = _where(node, parents)
        scope = _scope(node, parents)
        around = texts.get(scope) or texts.setdefault(scope, ast.unparse(scope))
        for start, end, new, complete in _edits(node, place):
            row = source.count(b"\n", 0, start)
            change = f"{_short(source[start:end])} -> {_short(new)}"
            text = rows[row].strip()
            mutant = Mutant(file, function, row + 1, text, change, complete, start, end, new, lines, names, around)
            seen[function, text, change] += 1
            found.append(replace(mutant, occurrence=seen[function, text, change]))
    return sorted(found, key=lambda m: (m.start, m.change))


def _short(text: bytes) -> str:
    words = " ".join(text.decode().split())
    return words if len(words) <= 60 else words[:57] + "..."


@dataclass(frozen=True)
class _Place:
    source: bytes
    offsets: list[int]
    parents: dict[ast.AST, ast.AST]

    def start(self, node: Any) -> int:
        return self.offsets[node.lineno - 1] + int(node.col_offset)

    def end(self, node: Any) -> int:
        return self.offsets[node.end_lineno - 1] + int(node.end_col_offset)

    def between(self, left: ast.AST, right: ast.AST, pattern: re.Pattern[bytes]) -> tuple[int, int, str]:
        """Return the operator that stands between two nodes."""
        found = pattern.search(self.source, self.end(left), self.start(right))
        assert found is not None
        return (*found.span(), " ".join(found.group().decode().split()))


def _ancestors(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> Iterator[tuple[ast.AST, ast.AST]]:
    """Pairs of a node and its parent, upwards."""
    while node in parents:
        yield node, parents[node]
        node = parents[node]


def _is_left_alone(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> bool:
    """Messages, annotations, decorators, and `strict=` of zip."""
    for child, parent in _ancestors(node, parents):
        if isinstance(parent, ast.JoinedStr | ast.Raise | ast.Import | ast.ImportFrom):
            return True
        if child in (getattr(parent, "annotation", None), getattr(parent, "returns", None)):
            return True
        if child in getattr(parent, "decorator_list", ()):
            return True
        if isinstance(parent, ast.keyword) and parent.arg == "strict":
            return True
    return False


def _statement(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> Any:
    """Return the innermost statement that the node belongs to."""
    while not isinstance(node, ast.stmt):
        node = parents[node]
    return node


def _where(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> tuple[str, tuple[int, int], tuple[str, ...]]:
    """Return the function's qualified name, the lines that must run for the change to count, the names defined."""
    statement = _statement(node, parents)
    scopes = [
        x for x in (p for _, p in _ancestors(statement, parents)) if isinstance(x, ast.FunctionDef | ast.ClassDef)
    ]
    if isinstance(statement, ast.FunctionDef):  # the default of an argument
        function = ".".join(x.name for x in (*reversed(scopes), statement))
        return function, (statement.body[0].lineno, statement.end_lineno or 0), ()
    function = ".".join(x.name for x in reversed(scopes))
    if scopes and isinstance(scopes[0], ast.FunctionDef):
        body = getattr(statement, "body", None)
        last = body[0].lineno - 1 if body else statement.end_lineno
        return function, (statement.lineno, max(last, statement.lineno)), ()
    targets = getattr(statement, "targets", [getattr(statement, "target", None)])
    defined = tuple(t.id for target in targets if target for t in ast.walk(target) if isinstance(t, ast.Name))
    # The fields of a class are used wherever its module is.
    return function, (0, 0), () if scopes else defined


def _scope(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> ast.AST:
    """Return the outermost function around a node, or its statement."""
    functions = [p for _, p in _ancestors(node, parents) if isinstance(p, ast.FunctionDef)]
    return functions[-1] if functions else _statement(node, parents)


Edit = tuple[int, int, bytes, bool]


def _edits(node: ast.AST, place: _Place) -> Iterator[Edit]:
    match node:
        case ast.Constant():
            yield from _of_constant(node, place)
        case ast.Compare() | ast.BoolOp() | ast.BinOp() | ast.UnaryOp():
            yield from _of_operator(node, place)
        case ast.Call():
            yield from _of_call(node, place)
        case ast.IfExp() | ast.If() | ast.While() if not isinstance(node.test, ast.Compare | ast.BoolOp):
            inside = place.source[place.start(node.test) : place.end(node.test)]
            yield place.start(node.test), place.end(node.test), b"(not (" + inside + b"))", False
        case ast.stmt():
            yield from _of_statement(node, place)


def _of_operator(node: ast.Compare | ast.BoolOp | ast.BinOp | ast.UnaryOp, place: _Place) -> Iterator[Edit]:
    match node:
        case ast.Compare():
            for left, right in zip([node.left, *node.comparators[:-1]], node.comparators, strict=True):
                start, end, operator = place.between(left, right, _COMPARISON)
                for other in _COMPARISONS[operator]:
                    yield start, end, other.encode(), operator[0] in "<>"
        case ast.BoolOp():
            for left, right in zip(node.values[:-1], node.values[1:], strict=True):
                start, end, operator = place.between(left, right, _BOOLEAN)
                yield start, end, b"or" if operator == "and" else b"and", False
        case ast.BinOp(op=ast.BitAnd() | ast.BitOr()):
            start, end, operator = place.between(node.left, node.right, _OPERATOR)
            yield start, end, b"|" if operator == "&" else b"&", False
        case ast.BinOp(op=op) if not isinstance(op, _UNTOUCHED):
            start, end, operator = place.between(node.left, node.right, _OPERATOR)
            yield start, end, _ARITHMETIC[operator].encode(), False
        case ast.UnaryOp(op=ast.Not()):
            yield place.start(node), place.start(node) + 3, b"", False
        case ast.UnaryOp():
            yield place.start(node), place.start(node) + 1, b"", False


def _of_constant(node: ast.Constant, place: _Place) -> Iterator[Edit]:
    start, end, value = place.start(node), place.end(node), node.value
    text = place.source[start:end]
    factor = isinstance(getattr(place.parents[node], "op", None), ast.Mult | ast.Div)
    complete = _is_threshold(node, place.parents) or (factor and _is_allowance(node, place))
    news: list[bytes] = []
    if isinstance(value, bool):
        news = [str(not value).encode()]
    elif isinstance(value, int):
        news = [str(value + 1).encode()]
        if complete:
            news += [f"({value - 1})".encode()]
            news += [b"(" + text + b" * 1000)", b"(" + text + b" / 1000)"] if factor and value else []
            if _names_a_module(node, place.parents) and value > 1:
                # One more or less of many is no other limit; ten times as many, or a tenth, is.
                news = [*(news if value <= _FEW else [b"%d" % (value // 10)]), b"%d" % (10 * value)]
    elif isinstance(value, float) and value == 0:
        news = [b"1e-3", b"(-1e-3)"] if complete else [b"1.0"]
    elif isinstance(value, float):
        news = [b"(" + text + b" * 1000)", b"(" + text + b" / 1000)"] if complete else [b"(" + text + b" * 2)"]
    for new in news:
        yield start, end, new, complete


def _names_a_module(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> bool:
    """Say whether the number is (part of) the value of a module's own name: no table, no grid, no formula's numbers."""
    for _, parent in _ancestors(node, parents):
        if isinstance(parent, ast.Assign | ast.AnnAssign):
            return isinstance(parents[parent], ast.Module)
        names_several = isinstance(parent, ast.Tuple) and isinstance(parents[parent], ast.Assign)
        if not (names_several or isinstance(parent, ast.BinOp | ast.UnaryOp)):
            return False
    return False


def _is_threshold(node: ast.Constant, parents: dict[ast.AST, ast.AST]) -> bool:
    """Constants of the module, defaults, tiny floats, tolerances by name, and what stands in a comparison of order."""
    is_tiny = isinstance(node.value, float) and 0 < node.value <= _TINY
    if isinstance(node.value, bool) or is_tiny or _names_a_module(node, parents):
        return not isinstance(node.value, bool)
    for _, parent in _ancestors(node, parents):
        match parent:
            case ast.BinOp() | ast.UnaryOp():
                continue
            case ast.Call() if _called(parent) in _TRANSPARENT:
                continue
            case ast.keyword():
                return "tol" in (parent.arg or "")
            case ast.AnnAssign():
                return isinstance(parents[parent], ast.ClassDef)
            case _:
                return isinstance(parent, ast.arguments) or _is_of_order(parent)
    return False


def _is_of_order(node: ast.AST) -> bool:
    """Say whether the node compares by order: `==` asks for a kind (`ndim == 2`), not for a limit."""
    return isinstance(node, ast.Compare) and any(isinstance(op, ast.Lt | ast.LtE | ast.Gt | ast.GtE) for op in node.ops)


def _is_allowance(node: ast.Constant, place: _Place) -> bool:
    """Say whether the statement, or the name of the function around it, speaks of rounding or limits."""
    statement = _statement(node, place.parents)
    around = [p.name for _, p in _ancestors(statement, place.parents) if isinstance(p, ast.FunctionDef)]
    text = b"" if hasattr(statement, "body") else place.source[place.start(statement) : place.end(statement)]
    return not isinstance(node.value, bool) and _ALLOWANCE.search(text + " ".join(around).encode()) is not None


def _called(node: ast.Call) -> str:
    match node.func:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


def _of_call(node: ast.Call, place: _Place) -> Iterator[Edit]:
    name = _called(node)
    end = place.end(node.func)
    if name in _SWAPPED:
        is_limit = name in _BOUNDING and any(_holds_a_limit(argument) for argument in node.args)
        yield end - len(name), end, _SWAPPED[name].encode(), is_limit
    if name in {"abs", "fabs"} and len(node.args) == 1:
        yield place.start(node.func), end, b"", False


def _holds_a_limit(node: ast.AST) -> bool:
    """Say whether a module's constant, a tolerance by name or a tiny float stands in an expression."""
    for inner in ast.walk(node):
        match inner:
            case ast.Name(id=name) | ast.Attribute(attr=name):
                if (name.isupper() and len(name) > 1) or _ALLOWANCE.search(name.encode()):
                    return True
            case ast.Constant(value=float(value)) if 0 < value <= _TINY:
                return True
    return False


def _of_statement(node: ast.stmt, place: _Place) -> Iterator[Edit]:
    start, end = place.start(node), place.end(node)
    match node:
        case ast.Return(value=value) if value is not None:
            yield start, end, b"return None", False
        case ast.Continue():
            yield start, end, b"break", False
        case ast.Break():
            yield start, end, b"continue", False
        case ast.Expr(value=ast.Call()) | ast.Raise():
            yield start, end, b"pass", False
        case ast.AugAssign():
            yield start, end, b"pass", False
            if not isinstance(node.op, _UNTOUCHED):
                at, after, operator = place.between(node.target, node.value, _OPERATOR)
                yield at, after, _ARITHMETIC[operator].encode(), False
        case ast.Assign(targets=[ast.Subscript() | ast.Attribute()]):
            yield start, end, b"pass", False
