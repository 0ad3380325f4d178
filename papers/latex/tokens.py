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
        number, run (of letters), letter (by macro), function, sign, dot, slash, relation, comma, arrow, dots, prime,
        bang, word, big (sum, integral), partial; and with parts: sub, sup, group, fence, fraction, root, binomial,
        accent, text, rows.
    text : str
        As printed; of a fence its delimiters, of rows the name of the environment.
    at : int
        Offset in the formula.
    parts : tuple
        Of what is nested: tuples of items; of rows: rows of cells of items.
    """

    kind: str
    text: str
    at: int
    parts: tuple[tuple[Item, ...], ...] | tuple[tuple[tuple[Item, ...], ...], ...] = ()


Items = tuple[Item, ...]

_RAISED = {raised: str(k) for k, raised in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")}
_SCAN = re.compile(
    r"(?P<space>(?:\s|%[^\n]*\n?|~)+)"
    r"|(?P<macro>\\(?:[A-Za-z]+|.|\n))"
    r"|(?P<number>\d+(?:\.\d+)?)"
    r"|(?P<dots>\.\.+|…)"
    r"|(?P<raised>[" + "".join(_RAISED) + r"]+)"
    r"|(?P<run>[^\W\d_" + "".join(_RAISED) + r"]+\d*)"
    r"|(?P<bars>\|\|?)"
    r"|(?P<other>.)",
    re.DOTALL,
)

# Greek by code point is one letter, whichever way it is typed: φ is \phi.
_GREEK = {chr(c): name.split()[3].lower() for c in range(0x3B1, 0x3CA) if (name := unicodedata.name(chr(c)))} | {
    chr(c): name.split()[3].capitalize() for c in range(0x391, 0x3AA) if (name := unicodedata.name(chr(c), ""))
}
_GREEK = {code: name for code, name in _GREEK.items() if name not in ("final", "Final")}
_GREEK_NAMES = frozenset(_GREEK.values()) | {"varepsilon", "vartheta", "varphi", "varrho", "varpi", "varsigma"}
_SPACES = frozenset(", ; : ! quad qquad enspace displaystyle textstyle limits nolimits".split()) | {" ", "\n"}
_MACROS = (
    {name: "dot" for name in ("cdot", "times")}
    | {name: "sign" for name in ("pm", "mp")}
    | {
        name: "relation"
        for name in ("leq le geq ge neq ne lt gt simeq approx equiv in bot perp propto sim cong ll gg".split())
    }
    | {name: "arrow" for name in ("Rightarrow", "rightarrow", "implies", "to", "Leftrightarrow", "iff", "Downarrow")}
    | {name: "dots" for name in ("dots", "ldots", "cdots", "vdots", "ddots")}
    | {name: "big" for name in ("sum", "int")}
    | {name: "function" for name in "sin cos tan cot sec csc arcsin arccos arctan sinh cosh tanh exp ln log".split()}
    | {name: "accent" for name in "hat vec bar tilde mathbf mathbb mathcal mathrm boldsymbol mathfrak".split()}
    | {name: "text" for name in "text textit textrm textbf operatorname mbox".split()}
    | {"prime": "prime", "partial": "partial", "infty": "letter"}
)
_SAME = {"le": "leq", "ge": "geq", "ne": "neq", "lt": "<", "gt": ">", "perp": "bot", "implies": "Rightarrow"}
_SAME |= {"to": "rightarrow", "iff": "Leftrightarrow"}
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
_OPERANDS = frozenset(
    ("number", "run", "letter", "prime", "bang", "sub", "sup", "group", "fence", "fraction", "root", "binomial", "rows")
)


def scan(latex: str) -> list[Token]:
    """Return all tokens of a formula, spaces among them: their texts, joined, are the formula.

    Examples
    --------
    >>> [token.text for token in scan(r"x_12 \\cdot at")]
    ['x', '_', '12', ' ', '\\\\cdot', ' ', 'at']
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
    items, end = _Nesting(latex, tokens, colours).level(0, "")
    if end != len(tokens):
        raise UnreadableError(Trouble.DELIMITERS, f"found {tokens[end].text!r} that nothing opens", tokens[end].at)
    return items
