"""Printed lines as tokens: comments left out, lines joined that go on, how far each is indented."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from semispline.papers.pseudocode.errors import CodeError

# Longest first.
_SIGNS = (
    "===", "!==", "...", "<->",
    "**", "==", "!=", "<=", ">=", "<-", "->", ":=", "+=", "-=", "*=", "/=", "^=", "++", "--", "&&", "||", "..",
    *"+-*/%^=<>!?:;,.()[]{}·×≤≥≠←→",
)  # fmt: skip
_TOKEN = re.compile(
    r"(?P<number>\d+\.\d+(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+(?![A-Za-z_])|\d+|\.\d+)"
    r"|(?P<name>[^\W\d]\w*'*)"
    r"|(?P<text>\"[^\"\n]*\"|'[^'\n]*')"
    r"|(?P<sign>" + "|".join(map(re.escape, _SIGNS)) + ")"
)
# What is said with other signs.
_SAME = {"≤": "<=", "≥": ">=", "≠": "!=", "←": "<-", "→": "->", ":=": "<-", "**": "^", "===": "==", "!==": "!="}
_OPENING, _CLOSING = "([", ")]"
# A line that ends in one of these goes on in the next one.
_GOES_ON = {"+", "-", "*", "/", "^", "·", "×", "=", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "?", ",", "(", "["}
# And one that begins with one of these continues the line before.
_CONTINUES = {"+", "*", "/", "·", "×", "&&", "||", "?", "."}


@dataclass(frozen=True)
class Token:
    """One token.

    Attributes
    ----------
    kind : str
        "number", "name", "text" or "sign".
    text : str
    line : int
        Printed line, from 1.
    column : int
        From 0.
    glued : bool
        Nothing stands between it and the token before.
    """

    kind: str
    text: str
    line: int
    column: int
    glued: bool = False


@dataclass(frozen=True)
class Line:
    """A printed line, with those that it goes on in."""

    number: int
    indent: int
    tokens: tuple[Token, ...]


def lines_of(text: str) -> list[Line]:
    """Return the lines of printed code.

    Raises
    ------
    CodeError
        A character that is no part of any rule, or a bracket without its partner.
    """
    found: list[Line] = []
    waiting: list[Token] = []
    indent = depth = 0
    for number, line in enumerate(_without_comments(text).split("\n"), start=1):
        tokens = list(_tokens(line, number))
        if not tokens:
            continue
        continues = found and not waiting and tokens[0].text in _CONTINUES
        if continues:
            last = found.pop()
            waiting, indent = list(last.tokens), last.indent
        if not waiting:
            indent = len(line.expandtabs(4)) - len(line.expandtabs(4).lstrip())
        waiting += tokens
        depth += sum((t.text in _OPENING) - (t.text in _CLOSING) for t in tokens if t.kind == "sign")
        if depth < 0:
            raise CodeError(f"line {number}: found a closing bracket without its partner")
        if depth == 0 and not (waiting[-1].kind == "sign" and waiting[-1].text in _GOES_ON):
            found.append(Line(waiting[0].line, indent, tuple(waiting)))
            waiting = []
    if waiting:
        raise CodeError(f"line {waiting[0].line}: found an end within it, expected the rest of it")
    return found


def _without_comments(text: str) -> str:
    """Blank what is said to readers: // to the end of a line, # after a space, /* .. */."""

    def blank(match: re.Match[str]) -> str:
        return re.sub(r"[^\n]", " ", match[0])

    text = re.sub(r"/\*.*?\*/", blank, text.expandtabs(4), flags=re.DOTALL)
    return re.sub(r"//[^\n]*|(?m:(?:^|(?<=\s))#[^\n]*)", blank, text)


def _tokens(line: str, number: int) -> Iterator[Token]:
    end = 0
    while True:
        start = end + len(line[end:]) - len(line[end:].lstrip())
        if start == len(line):
            return
        match = _TOKEN.match(line, start)
        if match is None or match.lastgroup is None:
            raise CodeError(f"line {number}: found {line[start]!r}, expected code")
        text = _SAME.get(match[0], match[0])
        yield Token(match.lastgroup, text, number, start, glued=start == end and start > 0)
        end = match.end()
