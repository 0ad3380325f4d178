"""From LaTeX to tokens and their nesting: braces, fences, fractions, environments.

TeX's own rule is kept: `^` and `_` take one token. What only moves or names things in print (spaces, labels under
braces, colours, column letters) carries nothing and is dropped here. A hand-written scanner, since tokens are what is
changed one at a time in the tests, thousands of formulas a second would not go through a general parser of TeX.
"""

from __future__ import annotations

import re
import unicodedata
from typing import NamedTuple

from semispline.papers.latex.errors import Trouble, UnreadableError


class Token(NamedTuple):
    """What one scan finds: kind, text, offset."""

    kind: str
    text: str
    at: int


class Item(NamedTuple):
    """A token with its meaning in a formula, or what is nested.

    Attributes
    ----------
    kind : str
        number, run (of letters), upright (word), letter (by macro), function, sign, dot, slash, relation, comma, arrow,
        dots, prime, bang, word, big (sum, integral), partial; and with parts: sub, sup, group, fence, fraction, root,
        binomial, accent, text, rows.
    text : str
        As printed; of a fence its delimiters, of rows the name of the environment.
    at : int
        Offset in the formula.
    parts : tuple of Items
        Of what is nested.
    rows : tuple of tuples of Items
        Of rows: their cells.
    """

    kind: str
    text: str
    at: int
    parts: tuple[tuple[Item, ...], ...] = ()
    rows: tuple[tuple[tuple[Item, ...], ...], ...] = ()


Items = tuple[Item, ...]

# Greek by code point is one letter, whichever way it is typed: φ is \phi.
_GREEK = {
    letter: name.lower() if letter.islower() else name.capitalize()
    for letter in map(chr, (*range(0x391, 0x3AA), *range(0x3B1, 0x3CA)))
    if (name := unicodedata.name(letter, "").rpartition(" ")[2]) and "FINAL" not in unicodedata.name(letter)
}
_RAISED = {raised: str(k) for k, raised in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")}
_NO_LETTER = "".join((*_RAISED, *_GREEK))
_SCAN = re.compile(
    r"(?P<space>(?:\s|%[^\n]*\n?|~)+)"
    r"|(?P<macro>\\(?:[A-Za-z]+|.|\n))"
    r"|(?P<number>\d+(?:\.\d+)?)"
    r"|(?P<dots>\.\.+|…)"
    r"|(?P<raised>[" + "".join(_RAISED) + r"]+)"
    r"|(?P<run>[^\W\d_" + _NO_LETTER + r"]+\d*)"
    r"|(?P<bars>\|\|?)"
    r"|(?P<other>.)",
    re.DOTALL,
)

_GREEK_NAMES = frozenset(_GREEK.values()) | {"varepsilon", "vartheta", "varphi", "varrho", "varpi", "varsigma"}
_SPACES = frozenset((",", ";", ":", "!", " ", "\n", "quad", "qquad", "enspace", "displaystyle", "limits", "nolimits"))
_FUNCTIONS = "sin cos tan cot sec csc arcsin arccos arctan sinh cosh tanh exp ln log"
_MACROS_OF_KIND = {
    "dot": "cdot times",
    "sign": "pm mp",
    "relation": "leq le geq ge neq ne lt gt simeq approx equiv in bot perp propto sim cong ll gg",
    "arrow": "Rightarrow rightarrow implies to Leftrightarrow iff Downarrow",
    "dots": "dots ldots cdots vdots ddots",
    "big": "sum int",
    "function": _FUNCTIONS,
    "accent": "hat vec bar tilde mathbf mathbb mathcal mathrm boldsymbol mathfrak",
    "text": "text textit textrm textbf operatorname mbox",
    "prime": "prime",
    "partial": "partial",
    "letter": "infty",
}
_MACROS = {name: kind for kind, names in _MACROS_OF_KIND.items() for name in names.split()}
# Functions that all know.
FUNCTIONS = frozenset(_FUNCTIONS.split())
# Macros that print the same.
_SAME = {
    "le": "\\leq", "ge": "\\geq", "ne": "\\neq", "lt": "<", "gt": ">", "perp": "\\bot", "implies": "\\Rightarrow",
    "to": "\\rightarrow", "iff": "\\Leftrightarrow", "times": "\\cdot",
}  # fmt: skip
_STRUCTURES = frozenset(("frac", "dfrac", "tfrac", "binom", "choose", "sqrt", "left", "begin", "{", "|"))
_CLOSERS = frozenset((")", "]", "}", "&", "\\right", "\\end", "\\\\", "\\}"))
_OTHERS = {
    "+": ("sign", "+"), "-": ("sign", "-"), "−": ("sign", "-"), "±": ("sign", "\\pm"),
    "·": ("dot", "\\cdot"), "⋅": ("dot", "\\cdot"), "×": ("dot", "\\cdot"),
    "/": ("slash", "/"), "!": ("bang", "!"), "'": ("prime", "'"), "’": ("prime", "'"), "′": ("prime", "'"),
    ",": ("comma", ","), ";": ("comma", ","), "=": ("relation", "="), "<": ("relation", "<"), ">": ("relation", ">"),
    "≃": ("relation", "\\simeq"), "≈": ("relation", "\\approx"), "≤": ("relation", "\\leq"),
    "≥": ("relation", "\\geq"), "≠": ("relation", "\\neq"), "∈": ("relation", "\\in"),
    "→": ("arrow", "\\rightarrow"), "⇒": ("arrow", "\\Rightarrow"), "⇓": ("arrow", "\\Downarrow"),
}  # fmt: skip
# Words that join statements: what they attach is decided in `statements`.
WORDS = {
    "with": "where", "where": "where", "when": "when", "if": "when", "for": "when", "and": "and", "given": "given",
    "otherwise": "otherwise",
}  # fmt: skip
LAYOUTS = frozenset(("aligned", "align", "align*", "split", "array", "matrix", "gathered", "cases"))
MATRICES = frozenset(("bmatrix", "pmatrix", "matrix", "array"))
_CLOSING = {"(": ")", "[": "]", "\\{": "\\}", "|": "|", "||": "||"}
# What a bar may close behind.
_OPERANDS = frozenset(
    ("number", "run", "upright", "letter", "prime", "bang", "sub", "sup", "group", "fence", "fraction", "root", "rows")
) | {"binomial"}


def scan(latex: str) -> list[Token]:
    r"""Return all tokens of a formula, spaces among them: their texts, joined, are the formula.

    Examples
    --------
    >>> [token.text for token in scan(r"x_12 \cdot at")]
    ['x', '_', '12', ' ', '\\cdot', ' ', 'at']
    """
    return [Token(found.lastgroup or "", found[0], found.start()) for found in _SCAN.finditer(latex)]


def nest(latex: str, colours: frozenset[str] = frozenset()) -> Items:
    """Return the items of a formula, nested.

    Parameters
    ----------
    latex : str
    colours : set of str
        Words whose bracket only colours what is in it, such as BLUE in `BLUE[+ 35]`.

    Raises
    ------
    UnreadableError
        Braces, fences or environments that are not closed, or an unknown macro.
    """
    tokens = [token for token in scan(latex) if token.kind != "space"]
    items, end = _Nesting(latex, tokens, colours).level(0)
    if end != len(tokens):
        raise UnreadableError(Trouble.DELIMITERS, f"found {tokens[end].text!r} that nothing opens", tokens[end].at)
    return items


def split(items: Items, kind: str = "comma") -> list[Items]:
    """Return what stands between the items of one kind.

    Examples
    --------
    >>> [len(part) for part in split(nest("a, b + c"))]
    [1, 3]
    """
    parts: list[Items] = []
    start = 0
    for k, item in enumerate(items):
        if item.kind == kind:
            parts.append(items[start:k])
            start = k + 1
    return [*parts, items[start:]]


class _Nesting:
    """One pass over the tokens of a formula; each method takes the index where it begins and gives the one behind."""

    def __init__(self, latex: str, tokens: list[Token], colours: frozenset[str]) -> None:
        self.latex, self.tokens, self.colours = latex, tokens, colours

    def level(self, i: int) -> tuple[Items, int]:
        """Return the items up to what closes this level, and the index of that."""
        items: list[Item] = []
        while i < len(self.tokens) and self.tokens[i].text not in _CLOSERS:
            kind = self.tokens[i].kind
            if kind == "macro":
                i = self._macro(i, items)
            elif kind == "other":
                i = self._mark(i, items)
            else:
                i = self._plain(i, items)
        found = tuple(items)
        return (_bars_paired(found) if any(item.kind == "bars" for item in found) else found), i

    def _plain(self, i: int, items: list[Item]) -> int:
        """Read a number, a run of letters, raised digits, dots, bars."""
        kind, text, at = self.tokens[i]
        if kind == "run" and text in self.colours and self._is(i + 1, "["):
            inner, i = self.level(i + 2)
            items += inner
            return self._closed(i, "]", at)
        if kind == "raised":
            number = "".join(_RAISED[c] for c in text)
            items.append(Item("sup", "^", at, ((_number(number, at),),)))
        elif kind == "number":
            items.append(_number(text, at))
        else:
            items.append(Item(kind, "..." if kind == "dots" else text, at))
        return i + 1

    def _mark(self, i: int, items: list[Item]) -> int:
        """Read a script, a bracket, a sign, a Greek letter."""
        text, at = self.tokens[i].text, self.tokens[i].at
        if text in "^_":
            content, i = self._argument(i + 1, text, at)
            items.append(Item("sup" if text == "^" else "sub", text, at, (content,)))
            return i
        if text == "{":
            inner, i = self._group(i)
            items += inner
            return i
        if text in "([":
            return self._bracket(i, items)
        if text in _OTHERS:
            items.append(Item(*_OTHERS[text], at))
        elif text in _GREEK:
            items.append(Item("letter", f"\\{_GREEK[text]}", at))
        elif text != "." or i < len(self.tokens) - 1:
            raise UnreadableError(Trouble.TEX, f"found {text!r}, which means nothing here", at)
        return i + 1

    def _bracket(self, i: int, items: list[Item]) -> int:
        text, at = self.tokens[i].text, self.tokens[i].at
        inner, i = self.level(i + 1)
        closing = self.tokens[i].text if i < len(self.tokens) else "nothing"
        # `[a, b)` is an interval where a relation asks for one.
        half_open = bool(items) and items[-1].text == "\\in"
        if closing not in (")", "]") or (closing != _CLOSING[text] and not half_open):
            raise UnreadableError(Trouble.DELIMITERS, f"found {closing!r}, expected {_CLOSING[text]!r}", at)
        items.append(Item("fence", text + closing, at, (inner,)))
        return i + 1

    def _is(self, i: int, text: str) -> bool:
        return i < len(self.tokens) and self.tokens[i].text == text

    def _closed(self, i: int, closing: str, at: int) -> int:
        if not self._is(i, closing):
            found = repr(self.tokens[i].text) if i < len(self.tokens) else "the end"
            raise UnreadableError(Trouble.DELIMITERS, f"found {found}, expected {closing!r}", at)
        return i + 1

    def _macro(self, i: int, items: list[Item]) -> int:
        _, text, at = self.tokens[i]
        name = text[1:]
        i += 1
        kind = "letter" if name in _GREEK_NAMES else _MACROS.get(name, "")
        if kind == "text":
            raw, i = self._raw(i, at)
            items += [_text(raw, at)] if raw else []
        elif kind == "accent":
            content, i = self._argument(i, text, at)
            is_word = name == "mathrm" and len(content) == 1 and content[0].kind == "run" and len(content[0].text) > 1
            items.append(Item("upright", content[0].text, at) if is_word else Item("accent", text, at, (content,)))
        elif kind:
            items.append(Item(kind, "..." if kind == "dots" else _SAME.get(name, text), at))
        elif name in _STRUCTURES:
            i = self._structure(name, i, items, at)
        elif name in ("underset", "underbrace", "overbrace"):
            i = self._brace(name, i, items, at)
        elif name in ("hspace", "kern", "color"):
            i = self._width(name, i, at)
        elif name not in _SPACES:
            raise self._unknown(name, at)
        return i

    def _unknown(self, name: str, at: int) -> UnreadableError:
        if name == "middle":
            return UnreadableError(Trouble.SLASH, "found \\middle: a slash behind it has two readings", at)
        if name.lower() in ("big", "bigl", "bigr", "bigg", "biggl", "biggr"):
            return UnreadableError(Trouble.DELIMITERS, f"found \\{name}, expected \\left and \\right", at)
        return UnreadableError(Trouble.TEX, f"unknown macro \\{name}", at)

    def _structure(self, name: str, i: int, items: list[Item], at: int) -> int:
        if name in ("frac", "dfrac", "tfrac", "binom"):
            above, i = self._argument(i, "\\" + name, at, cut=True)
            below, i = self._argument(i, "\\" + name, at, cut=True)
            items.append(Item("binomial" if name == "binom" else "fraction", "\\" + name, at, (above, below)))
        elif name == "choose":
            items.append(Item("choose", "\\choose", at))
        elif name == "sqrt":
            degree: Items = ()
            if self._is(i, "["):
                degree, i = self.level(i + 1)
                i = self._closed(i, "]", at)
            radicand, i = self._argument(i, "\\sqrt", at)
            items.append(Item("root", "\\sqrt", at, (degree, radicand)))
        elif name == "{":
            inner, i = self.level(i)
            i = self._closed(i, "\\}", at)
            items.append(Item("fence", "\\{\\}", at, (inner,)))
        elif name == "left":
            opening = self._delimiter(i, at)
            inner, i = self.level(i + 1)
            i = self._closed(i, "\\right", at)
            closing = self._delimiter(i, at)
            half = (opening, closing) in ((".", "\\}"), ("\\{", "."))
            half_open = opening in "([" and closing in ")]" and bool(items) and items[-1].text == "\\in"
            if closing != _CLOSING.get(opening) and not half and not half_open:
                raise UnreadableError(Trouble.DELIMITERS, f"found \\left{opening} with \\right{closing}", at)
            items.append(Item("fence", opening + closing, at, (inner,)))
            i += 1
        elif name == "begin":
            rows, i = self._environment(i, at)
            items.append(rows)
        else:
            raise UnreadableError(Trouble.DELIMITERS, f"found \\{name}, expected bars", at)
        return i

    def _delimiter(self, i: int, at: int) -> str:
        text = self.tokens[i].text if i < len(self.tokens) else "nothing"
        if text not in ("(", ")", "[", "]", "\\{", "\\}", "|", "||", "."):
            raise UnreadableError(Trouble.DELIMITERS, f"found {text!r} after \\left or \\right, expected a bracket", at)
        return text

    def _environment(self, i: int, at: int) -> tuple[Item, int]:
        name, i = self._raw(i, at)
        if name not in LAYOUTS | MATRICES:
            raise UnreadableError(Trouble.TEX, f"unknown environment {name!r}", at)
        if name == "array":
            _, i = self._raw(i, at)
        rows: list[tuple[Items, ...]] = []
        cells: list[Items] = []
        while True:
            cell, i = self.level(i)
            cells.append(cell)
            if self._is(i, "&"):
                i += 1
                continue
            rows.append(tuple(cells))
            cells = []
            if not self._is(i, "\\\\"):
                break
            i = self._row_skip(i + 1)
        i = self._closed(i, "\\end", at)
        ending, i = self._raw(i, at)
        if ending != name:
            raise UnreadableError(Trouble.DELIMITERS, f"found \\end{{{ending}}}, expected \\end{{{name}}}", at)
        # A row that ends the last line is none.
        return Item("rows", name, at, rows=tuple(rows if any(rows[-1]) else rows[:-1])), i

    def _row_skip(self, i: int) -> int:
        after = "".join(token.text for token in self.tokens[i : i + 4])
        return i + 4 if re.fullmatch(r"\[[\d.]+(em|ex|pt|mm|cm)\]", after) else i

    def _raw(self, i: int, at: int) -> tuple[str, int]:
        """Return the text of a braced argument as it stands."""
        if not self._is(i, "{"):
            raise UnreadableError(Trouble.TEX, "found no brace after a macro that needs one", at)
        depth, k = 1, i + 1
        while k < len(self.tokens) and depth:
            depth += {"{": 1, "}": -1}.get(self.tokens[k].text, 0)
            k += 1
        if depth:
            raise UnreadableError(Trouble.DELIMITERS, "a brace is not closed", self.tokens[i].at)
        return self.latex[self.tokens[i].at + 1 : self.tokens[k - 1].at].strip(), k

    def _argument(self, i: int, macro: str, at: int, cut: bool = False) -> tuple[Items, int]:
        """Return the argument of a macro or a script: a braced group, or one token."""
        if i >= len(self.tokens):
            raise UnreadableError(Trouble.TEX, f"found nothing after {macro}", at)
        kind, text, place = self.tokens[i]
        if text == "{":
            content, end = self.level(i + 1)
            return _chosen(content, place), self._closed(end, "}", place)
        if kind in ("number", "run") and len(text) > 1:
            if not cut:
                raise UnreadableError(
                    Trouble.SCRIPT, f"{macro} takes one token, and {text!r} has {len(text)}: braces are missing", place
                )
            # TeX takes one: \frac12 is one half.
            self.tokens[i] = Token(kind, text[1:], place + 1)
            return (Item(kind, text[0], place),), i
        if kind in ("number", "run"):
            return (Item(kind, text, place),), i + 1
        if kind == "macro" and text[1:] in _GREEK_NAMES:
            return (Item("letter", text, place),), i + 1
        if kind == "macro" and text in ("\\prime", "\\infty"):
            return (Item("prime" if text == "\\prime" else "letter", text, place),), i + 1
        if text in _GREEK:
            return (Item("letter", f"\\{_GREEK[text]}", place),), i + 1
        raise UnreadableError(Trouble.SCRIPT, f"{macro} takes one token, found {text!r}: braces are missing", place)

    def _group(self, i: int) -> tuple[list[Item], int]:
        """Return what stands in braces, which print nothing: the items themselves, where that is the same."""
        at = self.tokens[i].at
        content, i = self.level(i + 1)
        i = self._closed(i, "}", at)
        content = _chosen(content, at)
        script = i < len(self.tokens) and self.tokens[i].text in ("^", "_", "'", "\\prime")
        return _without_braces(content, at, script), i

    def _brace(self, name: str, i: int, items: list[Item], at: int) -> int:
        if name == "underset":
            # The label below.
            _, i = self._raw(i, at)
            if not (self._is(i, "{") and self._is(i + 1, "\\underbrace") and self._is(i + 2, "{")):
                raise UnreadableError(Trouble.TEX, "found \\underset without \\underbrace", at)
            content, i = self.level(i + 3)
            i = self._closed(self._closed(i, "}", at), "}", at)
        else:
            content, i = self._argument(i, "\\" + name, at)
            if self._is(i, "_" if name == "underbrace" else "^"):
                _, i = self._raw(i + 1, at)
        items += _without_braces(content, at, script=False)
        return i

    def _width(self, name: str, i: int, at: int) -> int:
        if name != "kern":
            return self._raw(i, at)[1]
        i += self._is(i, "-")
        if not (i + 1 < len(self.tokens) and self.tokens[i].kind == "number" and self.tokens[i + 1].kind == "run"):
            raise UnreadableError(Trouble.TEX, "found \\kern without a width", at)
        unit = self.tokens[i + 1].text
        if unit not in ("em", "ex", "pt", "mm", "cm"):
            raise UnreadableError(Trouble.TEX, f"found \\kern with the unit {unit!r}", at)
        return i + 2


def _number(text: str, at: int) -> Item:
    if len(text) > 1 and text[0] == "0" and text[1] != ".":
        raise UnreadableError(Trouble.NUMERAL, f"found {text}, a numeral that begins with 0", at)
    return Item("number", text, at)


def _text(raw: str, at: int) -> Item:
    word = WORDS.get(raw.lower())
    return Item("word", word, at) if word else Item("text", raw, at)


def _chosen(content: Items, at: int) -> Items:
    r"""Return `n \choose k` as a binomial."""
    if not any(item.kind == "choose" for item in content):
        return content
    parts = split(content, "choose")
    if len(parts) != 2:
        raise UnreadableError(Trouble.TEX, "found \\choose twice in one group", at)
    return (Item("binomial", "\\binom", at, (parts[0], parts[1])),)


def _without_braces(content: Items, at: int, script: bool) -> list[Item]:
    kinds = {item.kind for item in content}
    if not content or kinds == {"prime"}:
        return list(content)
    if content[0].kind in ("sub", "sup"):
        raise UnreadableError(Trouble.SCRIPT, "a script on nothing, in braces of its own", content[0].at)
    if script or (content[0].kind != "comma" and kinds & {"sign", "relation", "arrow", "word"}):
        return [Item("group", "{}", at, (content,))]
    if "comma" in kinds and content[0].kind != "comma":
        return [Item("fence", "{}", at, (content,))]
    return list(content)


def _bars_paired(items: Items) -> Items:
    """Return the items with bars as fences; where a bar may open or close, there are two readings."""
    done: list[Item] = []
    opened: tuple[int, Item] | None = None
    for k, item in enumerate(items):
        if item.kind in ("relation", "comma", "arrow") and opened:
            raise UnreadableError(Trouble.DELIMITERS, f"{opened[1].text} is not closed", opened[1].at)
        if item.kind != "bars":
            done.append(item)
            continue
        after = items[k + 1].kind if k + 1 < len(items) else ""
        if opened is None:
            opened = len(done), item
            continue
        start, bar = opened
        ahead = [other.kind for other in items[k + 1 :]]
        closes = start < len(done) and done[-1].kind in _OPERANDS
        unclear = "bars" in ahead and after not in ("sign", "dot", "slash", "relation", "comma", "arrow")
        if bar.text != item.text or not closes or unclear:
            raise UnreadableError(Trouble.DELIMITERS, f"{item.text} may open or close", item.at)
        content = tuple(done[start:])
        del done[start:]
        done.append(Item("fence", bar.text + item.text, bar.at, (content,)))
        opened = None
    if opened:
        raise UnreadableError(Trouble.DELIMITERS, f"{opened[1].text} is not closed", opened[1].at)
    return tuple(done)
