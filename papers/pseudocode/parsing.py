"""From tokens to a program: blocks by braces or by indentation, and expressions by the usual order of operators.

The rules take what papers print: heads of functions in four ways, loops in five, `=` in a condition for equality, `^`
for powers, `n!`, numbers before names. What fits none of them is refused; what was used of them is kept with its line.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from semispline.papers.pseudocode.errors import CodeError
from semispline.papers.pseudocode.tokens import Line, Token, lines_of
from semispline.papers.pseudocode.tree import (
    Assign,
    Call,
    Choice,
    Evaluate,
    Expression,
    Field,
    ForEach,
    Function,
    If,
    Index,
    Items,
    Leave,
    Loop,
    Name,
    Number,
    Operation,
    Program,
    Record,
    Return,
    Statement,
    Word,
)

_HEADS = {"function", "def", "procedure", "algorithm", "func"}
# Names behind these are the function's own; `set` says nothing of whose they are.
_OWN = {"var", "let", "const", "float", "int", "double"}
_DECLARE = _OWN | {"set"}
_ENDS = {"end", "endif", "endfor", "endwhile", "done", "fi", "od"}
_WORDS: dict[str, str | bool | None] = {"true": True, "True": True, "false": False, "False": False, "null": None}
_WORDS |= {"None": None, "nil": None, "undefined": None}
_ASSIGN = {"=": "", "<-": "", "+=": "+", "-=": "-", "*=": "*", "/=": "/", "^=": "^"}
# From those that bind least.
_LEVELS: tuple[dict[str, str], ...] = (
    {"||": "or", "or": "or"},
    {"&&": "and", "and": "and"},
    {"==": "==", "=": "==", "!=": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="},
    {"+": "+", "-": "-"},
    {"*": "*", "/": "/", "%": "%", "mod": "%", "div": "div"},
    # Of two vectors: before other products, so that v * 2/c * v · w is a multiple of v.
    {"·": "·", "×": "×"},
)
_COMPARE = 2


def read_code(text: str, replace: Mapping[str, str] | None = None) -> Program:
    r"""Return printed code, read.

    Parameters
    ----------
    text : str
        As printed.
    replace : mapping, optional
        Printed words that are no code -> code; each must occur once.

    Raises
    ------
    CodeError
        Naming the printed line.

    Examples
    --------
    >>> program = read_code("f(n):\n  return n!\nx = f(3)")
    >>> [type(statement).__name__ for statement in program.statements], program.rules
    (['Function', 'Assign'], ((2, '! is a factorial'),))
    """
    rules: set[tuple[int, str]] = set()
    for printed, meant in (replace or {}).items():
        if text.count(printed) != 1:
            raise CodeError(f"found {printed!r} {text.count(printed)} times, expected it once, to be replaced")
        rules.add((text[: text.index(printed)].count("\n") + 1, f"{printed!r} is replaced by {meant!r}"))
        text = text.replace(printed, meant)
    lines = lines_of(text)
    if not lines:
        raise CodeError("found no line, expected code")
    try:
        statements = _Blocks(lines, _Context(_names_with_digits(lines), rules)).block(0, len(lines))
    except RecursionError:
        raise CodeError("found brackets or signs too deep in each other, expected fewer") from None
    return Program(statements, tuple(sorted(rules)))


@dataclass(frozen=True)
class _Context:
    """What is known of a whole text: names such as 2a, and the rules that were used, with their lines."""

    digit_names: frozenset[str]
    rules: set[tuple[int, str]] = field(default_factory=set)


def _names_with_digits(lines: Sequence[Line]) -> frozenset[str]:
    """Return names such as 2a that something is assigned to; others are products."""
    return frozenset(
        a.text + b.text
        for line in lines
        for a, b, c in zip(line.tokens, line.tokens[1:], line.tokens[2:], strict=False)
        if a.kind == "number" and b.kind == "name" and b.glued and c.text in _ASSIGN
    )


def _with_ends(lines: Sequence[Line]) -> Iterator[Token]:
    """Yield the tokens of lines, and where each line ends."""
    for line in lines:
        yield from line.tokens
        yield Token("sign", "\n", line.tokens[-1].line, line.tokens[-1].column)


class _Blocks:
    """Lines as statements with blocks."""

    def __init__(self, lines: Sequence[Line], context: _Context) -> None:
        self.lines = list(lines)
        self.context = context

    def block(self, start: int, end: int) -> tuple[Statement, ...]:
        """Read lines from start to end, all of one block."""
        tokens = [token for line in self.lines[start:end] for token in line.tokens]
        braces = [token for token in tokens if token.kind == "sign" and token.text in "{}"]
        if braces and not self._only_records(tokens):
            self.context.rules.add((braces[0].line, "blocks are told by braces where there are some"))
            return _Braces(self.lines[start:end], self.context).statements()
        found: list[Statement] = []
        indent = self.lines[start].indent if start < end else 0
        while start < end:
            if self.lines[start].indent != indent and self.lines[start].tokens[0].text not in _ENDS:
                raise CodeError(f"line {self.lines[start].number}: found an indentation that no line above has")
            start = self._statement(start, end, found)
        return tuple(found)

    @staticmethod
    def _only_records(tokens: Sequence[Token]) -> bool:
        """Tell whether all braces are of records: {name: .."""
        return all(
            len(tokens) > i + 2 and tokens[i + 1].kind == "name" and tokens[i + 2].text == ":"
            for i, token in enumerate(tokens)
            if token.text == "{"
        )

    def _statement(self, at: int, end: int, found: list[Statement]) -> int:
        """Read the statement that begins in a line, with the lines that are indented below it."""
        line = self.lines[at]
        after = at + 1
        while after < end and self.lines[after].indent > line.indent:
            after += 1
        reader = _Reader(line.tokens, self.context)
        if reader.at("else", "elif", "elseif", "until"):
            raise CodeError(f"line {line.number}: found {reader.token.text}, expected the {_partner(reader)} before it")
        if reader.at("{"):
            raise CodeError(f"line {line.number}: found a brace that opens no block")
        if reader.token.text in _ENDS and len(line.tokens) <= 2:
            return after

        def below(first: int = at + 1, last: int = after) -> tuple[Statement, ...]:
            return self.block(first, last)

        head = reader.head(has_block=after > at + 1)
        if head is not None:
            made, after = self._with_block(head, reader, below, at, after, end)
            found.append(made)
            return after
        if after > at + 1:
            raise CodeError(f"line {self.lines[at + 1].number}: found it indented, expected that below a head only")
        found += reader.statements()
        return after

    def _with_block(
        self, head: _Head, reader: _Reader, below: Callable[[], tuple[Statement, ...]], at: int, after: int, end: int
    ) -> tuple[Statement, int]:
        # What follows the head in its own line is the whole block.
        body = tuple(reader.statements()) if not reader.is_at_end else below()
        if not body:
            raise CodeError(f"line {self.lines[at].number}: found nothing below {head.kind}, expected a block")
        if head.kind == "if":
            no, after = self._else(after, end, self.lines[at].indent)
            return head.made(body, no), after
        if head.kind == "repeat":
            if after >= end or self.lines[after].tokens[0].text not in ("until", "while"):
                raise CodeError(f"line {self.lines[at].number}: found no `until` after repeat, expected one")
            closing = _Reader(self.lines[after].tokens, self.context)
            return _repeat(head.line, body, closing), after + 1
        return head.made(body, ()), after

    def _else(self, at: int, end: int, indent: int) -> tuple[tuple[Statement, ...], int]:
        """Read what follows an `if` in lines of the same indentation."""
        if at >= end or self.lines[at].indent != indent:
            return (), at
        line = self.lines[at]
        reader = _Reader(line.tokens, self.context)
        if not reader.at("else", "elif", "elseif"):
            return (), at
        after = at + 1
        while after < end and self.lines[after].indent > indent:
            after += 1
        condition = reader.else_condition()
        body = tuple(reader.statements()) if not reader.is_at_end else self.block(at + 1, after)
        if condition is None:
            return body, after
        no, after = self._else(after, end, indent)
        return (If(line.number, condition, body, no),), after


def _partner(reader: _Reader) -> str:
    return "repeat" if reader.at("until") else "if"


def _repeat(line: int, body: tuple[Statement, ...], closing: _Reader) -> Loop:
    word = closing.take().text
    condition = closing.expression(condition=True)
    closing.skip(";")
    closing.expect_end()
    if word == "until":
        condition = Operation(line, "not", (condition,))
    return Loop(line, (), condition, (), body, body_first=True)


class _Head:
    """A line that opens a block, and what is made of it with the block."""

    def __init__(
        self, kind: str, line: int, made: Callable[[tuple[Statement, ...], tuple[Statement, ...]], Statement]
    ) -> None:
        self.kind, self.line, self.made = kind, line, made


class _Braces:
    """Lines of a block with braces as statements; behind a colon, indentation tells a block."""

    def __init__(self, lines: Sequence[Line], context: _Context) -> None:
        self.reader = _Reader(list(_with_ends(lines)), context)
        self.indents = {line.number: line.indent for line in lines}
        self.first = {(line.number, line.tokens[0].column) for line in lines}
        # Of heads whose lines go on in others.
        self.starts = {token.line: line.number for line in lines for token in line.tokens}

    def statements(self) -> tuple[Statement, ...]:
        """Read all of them."""
        found = self._until_brace()
        if not self.reader.is_at_end:
            raise self.reader.error("the end")
        return found

    def _until_brace(self, *, below: int = -1) -> tuple[Statement, ...]:
        """Read statements up to the end, a closing brace, or a line that is not indented more than `below`."""
        reader = self.reader
        found: list[Statement] = []
        while True:
            while reader.skip(";", "\n"):
                pass
            if reader.is_at_end or reader.at("}") or (self._begins_line and self._indent <= below):
                return tuple(found)
            found += self._one()

    @property
    def _begins_line(self) -> bool:
        return (self.reader.token.line, self.reader.token.column) in self.first

    @property
    def _indent(self) -> int:
        return self.indents[self.starts[self.reader.token.line]]

    def _one(self) -> list[Statement]:
        reader = self.reader
        if reader.at("{"):
            raise CodeError(f"line {reader.token.line}: found a brace that opens no block")
        indent = self._indent
        head = reader.head(has_block=None)
        if head is None:
            found = reader.simple()
            if not reader.is_at_end and not reader.at(";", "}", "\n"):
                raise reader.error("the end of the statement")
            return found
        body, closed = self._block(indent)
        if head.kind == "if":
            return [head.made(body, self._else(indent, closed))]
        if head.kind == "repeat":
            self._newlines()
            if not reader.at("until", "while"):
                raise reader.error("until or while")
            word = reader.take().text
            condition = reader.expression(condition=True)
            if word == "until":
                condition = Operation(head.line, "not", (condition,))
            return [Loop(head.line, (), condition, (), body, body_first=True)]
        return [head.made(body, ())]

    def _newlines(self) -> None:
        while self.reader.skip("\n"):
            pass

    def _block(self, indent: int) -> tuple[tuple[Statement, ...], bool]:
        """Read what is below a head that is indented so far; return whether braces stood around it."""
        reader = self.reader
        colon = reader.tokens[reader.place - 1].text == ":"
        line = reader.token.line
        same_line = not reader.at("\n")
        self._newlines()
        if reader.skip("{"):
            found = self._until_brace()
            reader.take("}")
            return found, True
        if reader.is_at_end or reader.at("}") or (not same_line and self._indent <= indent):
            raise CodeError(f"line {line}: found nothing below a head, expected a block")
        if colon and not same_line:
            return self._until_brace(below=indent), False
        body = self._one()
        while colon and reader.skip(";"):
            body += [] if reader.at("\n") else self._one()
        self._newlines()
        again = not reader.is_at_end and not reader.at("}", "else", "elif", "elseif", "until", ";")
        if again and not same_line and self._indent > indent:
            raise CodeError(f"line {reader.token.line}: found a second line below a head without braces or a colon")
        return tuple(body), False

    def _else(self, indent: int, closed: bool) -> tuple[Statement, ...]:
        reader = self.reader
        while reader.at("\n") or (reader.at(";") and not closed):
            reader.take()
        if not reader.at("else", "elif", "elseif"):
            return ()
        if not closed and self._begins_line and self._indent < indent:
            # Of an `if` further out.
            return ()
        line = reader.token.line
        condition = reader.else_condition()
        body, closed = self._block(indent)
        return body if condition is None else (If(line, condition, body, self._else(indent, closed)),)


class _Reader:
    """A row of tokens, read from the left."""

    def __init__(self, tokens: Sequence[Token], context: _Context) -> None:
        self.tokens = tokens
        self.reads_target = False
        self.context = context
        self.place = 0

    # Moving along.

    @property
    def is_at_end(self) -> bool:
        return self.place >= len(self.tokens)

    @property
    def token(self) -> Token:
        if self.is_at_end:
            last = self.tokens[-1]
            return Token("end", "the end", last.line, last.column)
        return self.tokens[self.place]

    def ahead(self, count: int = 1) -> str:
        place = self.place + count
        return self.tokens[place].text if place < len(self.tokens) else ""

    def at(self, *texts: str) -> bool:
        return not self.is_at_end and self.token.kind in ("sign", "name") and self.token.text in texts

    def skip(self, *texts: str) -> bool:
        if self.at(*texts):
            self.place += 1
            return True
        return False

    def take(self, *texts: str) -> Token:
        token = self.token
        if self.is_at_end or (texts and not self.at(*texts)):
            raise self.error(" or ".join(texts) or "more")
        self.place += 1
        return token

    def error(self, expected: str) -> CodeError:
        return CodeError(f"line {self.token.line}: found {self.token.text!r}, expected {expected}")

    def note(self, rule: str, line: int) -> None:
        """Keep a rule that is used on a line."""
        self.context.rules.add((line, rule))

    def expect_end(self) -> None:
        if not self.is_at_end:
            raise self.error("the end of the line")

    # Heads.

    def head(self, *, has_block: bool | None) -> _Head | None:
        """Read a line that opens a block, up to where the block begins; None where it is none.

        `has_block` says whether lines are indented below it; None where braces say it.
        """
        line = self.token.line
        for word, read in (("if", self._if), ("while", self._while), ("for", self._for), ("foreach", self._for_each)):
            if self.at(word):
                return read(line)
        if self.at("repeat", "do") and self.ahead() in ("", ":", "{", "\n"):
            self.take()
            self.skip(":")
            return _Head("repeat", line, lambda body, _: Evaluate(line, Word(line, None)))
        return self._function(line, has_block)

    def _opens(self, *words: str) -> None:
        self.skip(*words)
        self.skip(":")

    def _condition(self) -> Expression:
        return self.expression(condition=True)

    def _if(self, line: int) -> _Head:
        self.take()
        condition = self._condition()
        self._opens("then")
        return _Head("if", line, lambda yes, no: If(line, condition, yes, no))

    def else_condition(self) -> Expression | None:
        """Read `else`, `else if`, `elif`; return the condition."""
        word = self.take().text
        condition = None
        if word != "else" or self.skip("if"):
            condition = self._condition()
            self.skip("then")
        self.skip(":")
        return condition

    def _while(self, line: int) -> _Head:
        self.take()
        condition = self._condition()
        self._opens("do")
        return _Head("while", line, lambda body, _: Loop(line, (), condition, (), body))

    def _for(self, line: int) -> _Head:
        self.take()
        if self.at("each"):
            return self._for_each(line)
        bracket = self.at("(") and self._closes_before_block()
        if bracket:
            self.take()
        own = self.at(*_OWN)
        self.skip(*_DECLARE)
        if self.token.kind == "name" and self.ahead() in ("in", "from", "∈"):
            return self._for_range(line, bracket)
        first = self._for_part(own=own)
        if self.at("to", "downto"):
            return self._counted(line, first, bracket)
        self.take(";", ",")
        condition = self._condition()
        self.take(";", ",")
        step = self._for_part()
        if bracket:
            self.take(")")
        self._opens("do")
        return _Head("for", line, lambda body, _: Loop(line, first, condition, step, body))

    def _closes_before_block(self) -> bool:
        """Tell whether the bracket at hand is that of a whole head, and not of its first expression."""
        depth = 0
        for place in range(self.place, len(self.tokens)):
            text = self.tokens[place].text
            depth += (text in "([") - (text in ")]")
            if depth == 0:
                return (
                    place + 1 == len(self.tokens)
                    or self.tokens[place + 1].text in ("{", ":", "do", "\n")
                    or any(t.text == ";" for t in self.tokens[self.place : place])
                )
        return False

    def _for_part(self, *, own: bool = False) -> tuple[Statement, ...]:
        """Read assignments between commas, up to what separates the parts of a head."""
        if self.at(";", ")"):
            return ()
        found = self._assignment(own=own)
        # A comma goes on with assignments where semicolons separate the parts.
        while self.at(",") and self._has_semicolons:
            self.take()
            found += self._assignment(own=own)
        return tuple(found)

    @property
    def _has_semicolons(self) -> bool:
        """Whether the head at hand is one with semicolons: one is left, or the last one was passed."""
        start = next(i for i in range(self.place, -1, -1) if self.tokens[i].text == "for")
        head = self.tokens[start:]
        end = next((i for i, t in enumerate(head) if t.text in ("{", ":", "\n")), len(head))
        return any(t.text == ";" for t in head[:end])

    def _counted(self, line: int, first: tuple[Statement, ...], bracket: bool) -> _Head:
        """Read for i = a to b step c."""
        down = self.take().text == "downto"
        self.note("a loop to a number includes that", line)
        last = self.expression()
        by: Expression = Number(line, Fraction(1))
        if self.skip("step", "by"):
            by = self.expression()
        if bracket:
            self.take(")")
        self._opens("do")
        start = first[-1]
        if not isinstance(start, Assign):
            raise self.error("for name = first to last")
        condition = Operation(line, ">=" if down else "<=", (start.target, last))
        step = (Assign(line, start.target, by, "-" if down else "+"),)
        return _Head("for", line, lambda body, _: Loop(line, first, condition, step, body))

    def _for_range(self, line: int, bracket: bool) -> _Head:
        """Read for i in a..b, for i from a to b, for x in list."""
        name = self.take().text
        word = self.take().text
        low = self.expression()
        if word == "from" or self.at(".."):
            self.take("to", "..")
            self.note("a loop to a number includes that", line)
            high = self.expression()
            first: tuple[Statement, ...] = (Assign(line, Name(line, name), low),)
            condition = Operation(line, "<=", (Name(line, name), high))
            step = (Assign(line, Name(line, name), Number(line, Fraction(1)), "+"),)
            if bracket:
                self.take(")")
            self._opens("do")
            return _Head("for", line, lambda body, _: Loop(line, first, condition, step, body))
        if bracket:
            self.take(")")
        self._opens("do")
        return _Head("for", line, lambda body, _: ForEach(line, name, low, body))

    def _for_each(self, line: int) -> _Head:
        self.take()
        bracket = self.skip("(")
        name = self.take()
        if name.kind != "name":
            raise self.error("for each name in list")
        self.take("in", "of")
        among = self.expression()
        if bracket:
            self.take(")")
        self._opens("do")
        return _Head("for", line, lambda body, _: ForEach(line, name.text, among, body))

    def _function(self, line: int, has_block: bool | None) -> _Head | None:
        """Read function f(a, b), f = function(a, b), f(a, b): with a block, f(a, b) -> c:."""
        begin = self.place
        name = ""
        if self.token.text in _HEADS and self.token.kind == "name":
            self.take()
            name = self.take().text
        elif self.token.kind == "name" and self.ahead() in ("=", "<-") and self.ahead(2) in _HEADS:
            name = self.take().text
            self.take()
            self.take()
        elif self.token.kind == "name" and self.ahead() == "(" and has_block is not False and self._is_head():
            name = self.take().text
        if not name:
            self.place = begin
            return None
        parameters = self._parameters()
        gives = self.take().text if self.skip("->") else ""
        if gives:
            self.note(f"{gives} begins empty and is what the function gives", line)
        for number in (p for p in parameters if not isinstance(p, str)):
            self.note(f"{name} is given for the value {number}", line)
        self.skip(":")
        return _Head("function", line, lambda body, _: Function(line, name, parameters, body, gives))

    def _is_head(self) -> bool:
        """Tell whether name(..) is followed by what opens a block."""
        depth = 0
        for place in range(self.place + 1, len(self.tokens)):
            text = self.tokens[place].text
            depth += (text == "(") - (text == ")")
            if depth == 0:
                rest = [t.text for t in self.tokens[place + 1 :]]
                return rest[:1] in ([":"], ["{"]) or (rest[:1] == ["->"] and rest[2:3] in ([":"], ["{"]))
        return False

    def _parameters(self) -> tuple[str | Fraction, ...]:
        self.take("(")
        found: list[str | Fraction] = []
        while not self.skip(")"):
            token = self.take()
            if token.kind not in ("name", "number"):
                raise CodeError(f"line {token.line}: found {token.text!r}, expected the name of a parameter")
            found.append(Fraction(token.text) if token.kind == "number" else token.text)
            if self.skip("["):
                self.take("]")
            if not self.at(")"):
                self.take(",")
        return tuple(found)

    # Statements without blocks.

    def statements(self) -> list[Statement]:
        """Read the statements of one line."""
        found: list[Statement] = []
        while not self.is_at_end:
            if self.skip(";"):
                continue
            found += self.simple()
            if not self.is_at_end:
                self.take(";")
        return found

    def simple(self) -> list[Statement]:
        """Read one statement, or several assignments between commas."""
        line = self.token.line
        if self.at("return"):
            self.take()
            value = None if self.is_at_end or self.at(";", "}", "\n") else self.expression()
            return [Return(line, value)]
        if self.at("break", "continue"):
            return [Leave(line, self.take().text)]
        if self.at("if", "for", "while"):
            head = self.head(has_block=False)
            assert head is not None
            return [head.made(tuple(self.simple()), ())]
        own = self.at(*_OWN)
        declares = self.skip(*_DECLARE)
        found = self._assignment(own=own)
        while self.skip(","):
            declares = True
            found += self._assignment(own=own)
        only = found[0]
        if not declares and isinstance(only, Assign) and only.value is None:
            # A name on its own is an expression.
            return [Evaluate(line, only.target)]
        return found

    def _assignment(self, *, own: bool = False) -> list[Statement]:
        line = self.token.line
        if self.at("++", "--"):
            sign = self.take().text[0]
            return [Assign(line, self._postfix(), Number(line, Fraction(1)), sign)]
        self.reads_target = True
        target = self.expression(assigned=True)
        self.reads_target = False
        if self.at(*_ASSIGN):
            if not isinstance(target, Name | Index | Field):
                raise self.error("a variable before it")
            if self.at("<-"):
                self.note("an arrow or := assigns", line)
            sign = _ASSIGN[self.take().text]
            value = self.expression()
            chained: list[Statement] = []
            if self.at("=") and not sign:
                # a = b = c
                self.take()
                if not isinstance(value, Name | Index | Field):
                    raise self.error("a variable before it")
                last = self.expression()
                chained = [Assign(line, value, last, own=own)]
            return [*chained, Assign(line, target, value, sign, own and not sign)]
        if self.at("++", "--"):
            if not isinstance(target, Name | Index | Field):
                raise self.error("a variable before it")
            return [Assign(line, target, Number(line, Fraction(1)), self.take().text[0])]
        if isinstance(target, Name):
            return [Assign(line, target, None, own=own)]
        return [Evaluate(line, self._choice(target, False) if self.at("?") else target)]

    # Expressions.

    def expression(self, *, condition: bool = False, assigned: bool = False) -> Expression:
        """Read an expression; in a condition `=` is equality, else it ends one."""
        found = self._level(0, condition)
        return found if assigned or not self.at("?") else self._choice(found, condition)

    def _choice(self, found: Expression, condition: bool) -> Expression:
        line = self.take().line
        yes = self.expression(condition=condition)
        self.take(":")
        return Choice(line, found, yes, self.expression(condition=condition))

    def _level(self, level: int, condition: bool) -> Expression:
        if level == len(_LEVELS):
            return self._signed(condition)
        signs = _LEVELS[level]
        found = self._level(level + 1, condition)
        compared: list[Expression] = []
        if level == _COMPARE and self.at("<-") and not self.reads_target:
            # t<-1 in an expression is t < -1.
            arrow = self.token
            parts = [Token("sign", sign, arrow.line, arrow.column + i) for i, sign in enumerate("<-")]
            self.tokens = [*self.tokens[: self.place], *parts, *self.tokens[self.place + 1 :]]
        while self.at(*signs) and (self.token.text != "=" or condition):
            token = self.take()
            if token.text == "=":
                self.note("= in a condition compares", token.line)
            if token.text in ("·", "×"):
                self.note(f"{token.text} is taken before other products", token.line)
            other = self._level(level + 1, condition)
            operation = Operation(token.line, signs[token.text], (found, other))
            if level == _COMPARE:
                # a <= b <= c is two conditions.
                compared.append(operation)
                found = other
            else:
                found = operation
        if len(compared) > 1:
            self.note("of comparisons in a row all must hold", compared[0].line)
        for one in reversed(compared[:-1]):
            compared[-1] = Operation(one.line, "and", (one, compared[-1]))
        return compared[-1] if compared else found

    def _signed(self, condition: bool) -> Expression:
        line = self.token.line
        if self.skip("!", "not"):
            return Operation(line, "not", (self._signed(condition),))
        if self.skip("-"):
            return Operation(line, "negative", (self._signed(condition),))
        if self.skip("+"):
            return self._signed(condition)
        return self._power()

    def _power(self) -> Expression:
        base = self._postfix()
        if not self.at("^"):
            return base
        line = self.take().line
        self.note("^ is a power", line)
        exponent = Operation(line, "negative", (self._power(),)) if self.skip("-") else self._power()
        return Operation(line, "^", (base, exponent))

    def _postfix(self) -> Expression:
        found = self._atom()
        while not self.is_at_end:
            line = self.token.line
            if self.at("(") and isinstance(found, Number):
                # 2(a + b) is a product.
                found = Operation(line, "*", (found, self._atom()))
            elif self.at("("):
                found = Call(line, found, self._arguments())
            elif self.at("["):
                found = self._index(found, line)
            elif self.at(".") and self.ahead() and self.ahead() not in "([":
                self.take()
                found = Field(line, found, self.take().text)
            elif self.at("!") and self.ahead() != "=":
                self.take()
                self.note("! is a factorial", line)
                found = Operation(line, "!", (found,))
            else:
                return found
        return found

    def _index(self, whole: Expression, line: int) -> Expression:
        """Read whole[i], whole[i, j], or a method whose arguments stand in square brackets."""
        self.take("[")
        items = self._list("]")
        if isinstance(whole, Field) and (len(items) != 1 or whole.name in ("push", "add", "append")):
            self.note(f"{whole.name}[..] is {whole.name}(..)", line)
            return Call(line, whole, items)
        if not items:
            raise self.error("an index")
        if len(items) > 1:
            self.note("[i, j] is [i][j]", line)
        for item in items:
            whole = Index(line, whole, item)
        return whole

    def _arguments(self) -> tuple[Expression, ...]:
        self.take("(")
        return self._list(")")

    def _list(self, end: str) -> tuple[Expression, ...]:
        found: list[Expression] = []
        named = False
        while not self.skip(end):
            if self.token.kind == "name" and self.ahead() == "=" and end == ")":
                self.note(f"{self.token.text}= only names an argument", self.token.line)
                self.take()
                self.take()
                named = True
            found.append(self.expression())
            if named and len(found) > 1:
                raise self.error("a named argument alone: the order of others is not known")
            if not self.at(end):
                self.take(",")
        return tuple(found)

    def _atom(self) -> Expression:  # noqa: PLR0911  # one for each kind of token
        token = self.take()
        if token.kind == "number":
            return self._numeral(token)
        if token.kind == "text":
            return Word(token.line, token.text[1:-1])
        if token.kind == "name":
            if token.text == "new":
                self.note("new is dropped", token.line)
                return self._atom()
            if token.text in _WORDS:
                return Word(token.line, _WORDS[token.text])
            return Name(token.line, token.text)
        if token.text == "(":
            found = self.expression(condition=True)
            self.take(")")
            return found
        if token.text == "[":
            return Items(token.line, self._list("]"))
        if token.text == "{":
            return self._record(token.line)
        self.place -= 1
        raise self.error("a number, a name or a bracket")

    def _numeral(self, token: Token) -> Expression:
        number = Number(token.line, Fraction(token.text))
        following = self.token
        if following.kind != "name" or not following.glued or self.is_at_end:
            return number
        self.take()
        if token.text + following.text in self.context.digit_names:
            return Name(token.line, token.text + following.text)
        # 2x is a product, and 2x[i] and 2f(x) are products of 2 and all that.
        self.place -= 1
        self.note("a number before a name multiplies it", token.line)
        return Operation(token.line, "*", (number, self._power()))

    def _record(self, line: int) -> Expression:
        fields: list[tuple[str, Expression]] = []
        while not self.skip("}"):
            if self.skip("\n"):
                continue
            name = self.take().text
            self.take(":")
            fields.append((name, self.expression()))
            if not self.at("}", "\n"):
                self.take(",")
        return Record(line, tuple(fields))
