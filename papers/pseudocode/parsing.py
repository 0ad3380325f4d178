"""From printed lines to a program, by rules. Which rules were used is kept with each line.

Blocks are told by indentation; braces are dropped where they agree with it. `^` is a power, `n!` a factorial, `·` and
`×` bind before other products, `=` in a condition compares.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from semispline.papers.pseudocode.errors import UnreadableCodeError
from semispline.papers.pseudocode.nodes import (
    Array,
    Assign,
    Binary,
    CallOf,
    Choice,
    Evaluate,
    Expression,
    Fields,
    Function,
    If,
    Index,
    Jump,
    Line,
    Literal,
    Loop,
    Member,
    Name,
    Return,
    Unary,
)

_TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+(?:\.\d+)?(?![\w.]))|(?P<name>\w+)"
    r"|(?P<sign>===|!==|->|==|!=|<=|>=|&&|\|\||\+\+|--|\+=|-=|\*=|/=|[-+*/%^·×<>=!?:.,;()\[\]{}]))"
)
_HEADS = (
    re.compile(r"function\s+(\w+)\s*\((.*?)\)\s*[:{]?$"),
    re.compile(r"(\w+)\s*=\s*function\s*\((.*?)\)\s*[:{]?$"),
    re.compile(r"(\w+)\s*\((.*?)\)\s*->\s*(\w+)\s*:$"),
    re.compile(r"(?!if\b|for\b|while\b|else\b)(\w+)\s*\((.*?)\)\s*:$"),
)
_RESERVED = frozenset(("function", "if", "for", "while", "else", "return", "var", "let", "break", "continue"))
_SAME = {"===": "==", "!==": "!=", "&&": "and", "||": "or"}
_LEVELS = (("or",), ("and",), ("==", "!=", "<", ">", "<=", ">="), ("+", "-"), ("*", "/", "%"))


@dataclass(frozen=True)
class Program:
    """Code that can be run.

    Attributes
    ----------
    functions : mapping
        Name -> its variants, those for a number among the parameters and the one for all others.
    lines : tuple of Line
        What stands outside of functions.
    rules : tuple of (int, str)
        Printed line, and the rule that was used on it.
    """

    functions: Mapping[str, tuple[Function, ...]]
    lines: tuple[Line, ...]
    rules: tuple[tuple[int, str], ...]


@dataclass(frozen=True)
class _Row:
    """A printed line, with those that continue it."""

    number: int
    indent: int
    text: str


def load(text: str, replacements: Mapping[str, str] | None = None) -> Program:
    r"""Translate printed pseudo-code.

    Parameters
    ----------
    text : str
        As printed.
    replacements : mapping, optional
        What no rule translates -> what stands for it; each must occur once.

    Raises
    ------
    UnreadableCodeError
        A line that no rule translates; the message has its number.

    Examples
    --------
    >>> program = load("function double(x):\n  return 2 * x\n")
    >>> list(program.functions)
    ['double']
    """
    rules: list[tuple[int, str]] = []
    for printed, meant in (replacements or {}).items():
        if text.count(printed) != 1:
            raise UnreadableCodeError(f"replacement of {printed!r}: found {text.count(printed)} times, expected once")
        rules.append((text[: text.index(printed)].count("\n") + 1, f"{printed!r} is replaced by {meant!r}"))
        text = text.replace(printed, meant)
    rows = _rows(text, rules)
    try:
        return _program(rows, rules)
    except RecursionError:
        raise UnreadableCodeError("found too many brackets or signs in each other") from None


def _program(rows: list[_Row], rules: list[tuple[int, str]]) -> Program:
    reader = _Reader(rules)
    functions: dict[str, tuple[Function, ...]] = {}
    lines: list[Line] = []
    k = 0
    while k < len(rows):
        if rows[k].indent != rows[0].indent:
            raise UnreadableCodeError(f"line {rows[k].number}: found an indentation that no line above opens")
        head = next((found for pattern in _HEADS if (found := pattern.match(rows[k].text))), None)
        if head is None:
            more, k = reader.statement(rows, k)
            lines += more
            continue
        function, k = reader.function(head, rows, k)
        functions[function.name] = (*functions.get(function.name, ()), function)
    return Program(functions, tuple(lines), tuple(sorted(rules)))


def _rows(text: str, rules: list[tuple[int, str]]) -> list[_Row]:
    """Return the lines without comments, those that are continued joined, braces of blocks checked and dropped."""
    rows: list[_Row] = []
    opened: list[tuple[int, int]] = []
    pending: list[str] = []
    start = indent = 0
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.split("//")[0].rstrip()
        if not line.strip():
            continue
        if not pending:
            start, indent = number, len(line) - len(line.lstrip())
        pending.append(line.strip())
        joined = " ".join(pending)
        depth = sum(joined.count(c) for c in "([") - sum(joined.count(c) for c in ")]")
        if depth > 0 or (joined.endswith((",", "+", "*", "=")) and not joined.endswith("++")):
            continue
        pending = []
        while joined.startswith("}"):
            if not opened or opened[-1][0] != indent:
                raise UnreadableCodeError(f"line {number}: found a brace that does not agree with the indentation")
            opened.pop()
            joined = joined[1:].strip(" ;")
        if joined.endswith("{"):
            if joined == "{":
                raise UnreadableCodeError(f"line {number}: found a brace that opens no block")
            opened.append((indent, number))
            joined = joined[:-1].rstrip() + ":"
            rules.append((number, "braces are dropped: blocks are told by indentation"))
        if joined:
            rows.append(_Row(start, indent, joined))
    if pending:
        raise UnreadableCodeError(f"line {start}: found a line that does not end")
    if opened:
        raise UnreadableCodeError(f"line {opened[-1][1]}: found a brace that is not closed")
    if not rows:
        raise UnreadableCodeError("found no code")
    return rows


@dataclass
class _Reader:
    """Statements and expressions of one program; notes the rules that it uses."""

    rules: list[tuple[int, str]]
    tokens: list[tuple[str, str]] = field(default_factory=list)
    at: int = 0
    line: int = 0
    condition: bool = False

    def function(self, head: re.Match[str], rows: list[_Row], k: int) -> tuple[Function, int]:
        name, parameters, *result = head.groups()
        found: list[str | Fraction] = []
        for parameter in filter(None, (p.strip() for p in parameters.split(","))):
            plain = parameter.removesuffix("[]")
            if re.fullmatch(r"\d+", plain):
                self.rules.append((rows[k].number, f"{name} is given for the value {plain}"))
                found.append(Fraction(plain))
            elif re.fullmatch(r"\w+", plain):
                found.append(plain)
            else:
                raise UnreadableCodeError(f"line {rows[k].number}: found the parameter {parameter!r}")
        body, end = self.block(rows, k + 1, rows[k].indent)
        if result:
            self.rules.append((rows[k].number, f"{result[0]} begins empty and is what the function gives"))
        return Function(rows[k].number, name, tuple(found), body, result[0] if result else ""), end

    def block(self, rows: list[_Row], k: int, indent: int) -> tuple[tuple[Line, ...], int]:
        lines: list[Line] = []
        if k == len(rows) or rows[k].indent <= indent:
            raise UnreadableCodeError(f"line {rows[k - 1].number}: found no indented line below")
        own = rows[k].indent
        while k < len(rows) and rows[k].indent > indent:
            if rows[k].indent != own:
                raise UnreadableCodeError(f"line {rows[k].number}: found an indentation that no line above has")
            found, k = self.statement(rows, k)
            lines += found
        return tuple(lines), k

    def statement(self, rows: list[_Row], k: int) -> tuple[list[Line], int]:
        """Return the lines that one printed line stands for, with its block."""
        row = rows[k]
        self.begin(row)
        word = self.peek()
        if word not in ("if", "while", "for"):
            if word == "else":
                raise self.wrong("else without if")
            return self.simple_lines(("", ";")), k + 1
        self.take()
        before, condition, steps = self.for_head() if word == "for" else ([], self.condition_of(word), [])
        body, k = self.body(rows, k, row.indent)
        if word != "if":
            return [*before, Loop(row.number, condition, body, tuple(steps))], k
        other: tuple[Line, ...] = ()
        if k < len(rows) and rows[k].indent == row.indent and re.match(r"else\b", rows[k].text):
            rest = _Row(rows[k].number, row.indent, rows[k].text[4:].strip())
            if re.match(r"if\b", rest.text):
                lines, k = self.statement([*rows[:k], rest, *rows[k + 1 :]], k)
                other = tuple(lines)
            else:
                self.begin(rest)
                other, k = self.body(rows, k, row.indent)
        return [If(row.number, condition, body, other)], k

    def body(self, rows: list[_Row], k: int, indent: int) -> tuple[tuple[Line, ...], int]:
        """Read the block behind a head: the rest of its line, or the indented lines below."""
        if self.peek() == ":":
            self.take()
        if self.peek():
            return tuple(self.simple_lines(("", ";"))), k + 1
        return self.block(rows, k + 1, indent)

    def begin(self, row: _Row) -> None:
        self.line, self.at, self.tokens = row.number, 0, []
        place = 0
        text = row.text.rstrip()
        while place < len(text):
            found = _TOKEN.match(text, place)
            if found is None:
                raise UnreadableCodeError(f"line {row.number}: found {text[place:].strip()[:20]!r}")
            kind = found.lastgroup or ""
            self.tokens.append((kind, _SAME.get(found[kind], found[kind])))
            place = found.end()

    def peek(self, ahead: int = 0) -> str:
        return self.tokens[self.at + ahead][1] if self.at + ahead < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        text = self.peek()
        if not text or (wanted and text != wanted):
            raise self.wrong(f"found {text or 'the end'!r}, expected {wanted or 'more'!r}")
        self.at += 1
        return text

    def wrong(self, reason: str) -> UnreadableCodeError:
        return UnreadableCodeError(f"line {self.line}: {reason}")

    def note(self, rule: str) -> None:
        if (self.line, rule) not in self.rules:
            self.rules.append((self.line, rule))

    def condition_of(self, word: str) -> Expression:
        self.condition = True
        bracket = self.peek() == "("
        try:
            found = self.expression()
        finally:
            self.condition = False
        if not bracket and self.peek() != ":":
            raise self.wrong(f"found {word} without a bracket or a colon")
        return found

    def for_head(self) -> tuple[list[Line], Expression, list[Line]]:
        """Read `for(a; c; s)` or `for a, c, s:`."""
        bracket = self.peek() == "("
        if bracket:
            self.take()
        separator = ";" if bracket else ","
        before = [self.simple()]
        while bracket and self.peek() == ",":
            self.take()
            before.append(self.simple())
        self.take(separator)
        self.condition = True
        try:
            condition = self.expression()
        finally:
            self.condition = False
        self.take(separator)
        steps = [self.simple()]
        while bracket and self.peek() == ",":
            self.take()
            steps.append(self.simple())
        if bracket:
            self.take(")")
        elif self.peek() != ":":
            raise self.wrong("found a loop without a colon")
        return before, condition, steps

    def simple_lines(self, ends: tuple[str, ...]) -> list[Line]:
        """Read assignments and calls, several of them between commas."""
        word = self.peek()
        if word in ("return", "break", "continue"):
            self.take()
            value = self.expression() if word == "return" and self.peek() not in ends else None
            self.finish()
            return [Return(self.line, value) if word == "return" else Jump(self.line, word)]
        local = word in ("var", "let")
        if local:
            self.take()
        lines = [self.simple(local)]
        while self.peek() == ",":
            self.take()
            lines.append(self.simple(local or True))
        self.finish()
        return lines

    def finish(self) -> None:
        while self.peek() == ";":
            self.take()
        if self.peek():
            raise self.wrong(f"found {self.peek()!r}, expected the end of the line")

    def simple(self, local: bool = False) -> Line:
        """Read one assignment, step or call."""
        if self.peek() in ("var", "let"):
            self.take()
            local = True
        target = self.postfix()
        sign = self.peek()
        if sign in ("=", "+=", "-=", "*=", "/=", "++", "--"):
            if not isinstance(target, Name | Index | Member):
                raise self.wrong("found an assignment to what is no variable")
            self.take()
            if sign in ("++", "--"):
                return Assign(self.line, target, sign[0], Literal(Fraction(1)))
            value = self.expression()
            return Assign(self.line, target, sign[:-1], value, local and sign == "=")
        if local and isinstance(target, Name):
            return Assign(self.line, target, "", None, local=True)
        if not isinstance(target, CallOf):
            raise self.wrong("found neither an assignment nor a call")
        return Evaluate(self.line, target)

    def expression(self, level: int = 0) -> Expression:
        if level == len(_LEVELS):
            return self.unary()
        left = self.expression(level + 1)
        while True:
            sign = self.peek()
            if level == 2 and sign == "=" and self.condition:
                self.note("= in a condition compares")
                sign = "=="
            if sign not in _LEVELS[level]:
                break
            self.take()
            left = Binary(sign, left, self.expression(level + 1))
            if level == 2 and self.peek() in _LEVELS[2]:
                raise self.wrong("found two comparisons in one")
        if level == 0 and self.peek() == "?":
            self.take()
            one = self.expression()
            self.take(":")
            return Choice(left, one, self.expression())
        return left

    def unary(self) -> Expression:
        if self.peek() in ("-", "+"):
            sign = self.take()
            operand = self.unary()
            return Unary("-", operand) if sign == "-" else operand
        if self.peek() == "!":
            self.take()
            return Unary("not", self.unary())
        left = self.power()
        while self.peek() in ("·", "×"):
            self.note(f"{self.peek()} is taken before other products")
            left = Binary(self.take(), left, self.power())
        return left

    def power(self) -> Expression:
        base = self.postfix()
        if self.peek() != "^":
            return base
        self.take()
        self.note("^ is a power")
        exponent = Unary("-", self.power()) if self.peek() == "-" and self.take() else self.power()
        return Binary("^", base, exponent)

    def postfix(self) -> Expression:
        tree = self.atom()
        while True:
            sign = self.peek()
            if sign == "!":
                self.take()
                self.note("! is a factorial")
                tree = Unary("!", tree)
            elif sign == ".":
                self.take()
                if self.tokens[self.at : self.at + 1] and self.tokens[self.at][0] != "name":
                    raise self.wrong("found no name behind a dot")
                name = self.take()
                tree = Member(tree, name)
                if name == "push" and self.peek() == "[":
                    self.note("push[..] is push(..)")
                    self.take()
                    tree = CallOf(tree, (Array(self.list_until("]")),))
            elif sign == "(":
                self.take()
                tree = CallOf(tree, self.list_until(")"))
            elif sign == "[":
                self.take()
                entries = self.list_until("]")
                if len(entries) != 1:
                    raise self.wrong("found an index that is no single number")
                tree = Index(tree, entries[0])
            else:
                return tree

    def list_until(self, closing: str) -> tuple[Expression, ...]:
        entries: list[Expression] = []
        before, self.condition = self.condition, False
        named = False
        while self.peek() != closing:
            if entries:
                self.take(",")
            if self.tokens[self.at : self.at + 1] and self.tokens[self.at][0] == "name" and self.peek(1) == "=":
                self.note(f"{self.peek()}= only names an argument")
                self.at += 2
                named = True
            entries.append(self.expression())
            if named and len(entries) > 1:
                raise self.wrong("found a named argument beside others: their order is not known")
        self.take()
        self.condition = before
        return tuple(entries)

    def atom(self) -> Expression:
        if self.at == len(self.tokens):
            raise self.wrong("found the end of the line, expected a value")
        kind, text = self.tokens[self.at]
        self.at += 1
        if kind == "number" or text in ("true", "false"):
            return Literal(Fraction(text) if kind == "number" else text == "true")
        if text == "new":
            self.note("new is dropped")
            return self.postfix()
        if kind == "name" and text not in _RESERVED:
            return Name(text)
        if text == "(":
            inner = self.expression()
            self.take(")")
            return inner
        if text in ("[", "{"):
            return Array(self.list_until("]")) if text == "[" else self.record()
        raise self.wrong(f"found {text!r}, expected a value")

    def record(self) -> Expression:
        entries: list[tuple[str, Expression]] = []
        while self.peek() != "}":
            if entries:
                self.take(",")
            name = self.take()
            self.take(":")
            entries.append((name, self.expression()))
        self.take()
        return Fields(tuple(entries))
