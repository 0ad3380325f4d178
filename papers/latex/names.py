"""The table of names of a paper: which names its formulas use, and what each may stand for.

Each line is `PATTERN, PATTERN : KIND`, patterns in LaTeX; `#` begins a remark. Lines before any heading hold for the
whole document, those under `[chapter]` for all ids `chapter.N`, those under `[id]` for one formula. `- PATTERN` takes
a name away.

    n, i, k : integer >= 0
    t : real in [0,1]
    P_i, A', C_{start} : point
    N_{i,k}(t), B^n_i(t) : function
    sin, cos : standard function
    TMC : product

A letter in an index that is a declared integer stands for any integer expression; any other text there is a label.
`P_{ij}` with integers i and j has two indices.

Kinds: `integer`, `real`, `constant` (such as π); `point` (read coordinate by coordinate), `plane point` (two
coordinates), `matrix` or `matrix 3x3`, `list`; `function`, `function point` and so on for other values, `function
bare` where its bracket may be missing; `standard function` for words such as sin. Behind a kind stand a range (`>=
0`, `> 0`, `in [0,1]`) and `word`, for a name whose letters are all names too. Of what is no name: `label` (a word
below a bracket), `colour` (a word whose bracket only colours), `product` (three letters or more that are one),
`postfix derivative` (d/dt may stand last).
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

from semispline.papers.latex.errors import NamesError, UnreadableError
from semispline.papers.latex.tokens import Item, Items, nest, split

KINDS = (
    "integer", "real", "constant", "point", "plane point", "matrix", "list", "function", "function bare",
    "standard function", "label", "colour", "product", "postfix derivative",
)  # fmt: skip
_VALUES = ("real", "integer", "point", "plane point", "matrix", "list")


@dataclass(frozen=True)
class Slot:
    """A place in an index: a letter that stands for an integer expression, or the text of a label."""

    text: str
    is_index: bool


@dataclass(frozen=True)
class Declaration:
    """One name of the table.

    Attributes
    ----------
    pattern : str
        As the table has it.
    head : str
        The name without indices: letters, a macro, an accent with its letter, a word.
    below, above, after : tuple of tuples of Slot
        Scripts, each with its slots; `after` are those below behind the arguments.
    primes : int
    arguments : tuple of str or None
        Letters of the arguments.
    bracket : bool
        Whether an index in square brackets follows, as in `knots[i]`.
    kind : str
        Of a function: function.
    value : str
        Kind of the value: of a function what it gives.
    bare : bool
        Whether a function may stand without its arguments.
    word : bool
        Whether the name is meant although all its letters are declared too.
    size : tuple of str
        Of a matrix: rows and columns, numbers or letters.
    range : str
        What the table says behind the kind, such as `>= 0` or `in [0,1]`.
    line : int
        Line of the table.
    """

    pattern: str
    head: str
    kind: str
    value: str
    line: int
    below: tuple[tuple[Slot, ...], ...] = ()
    above: tuple[tuple[Slot, ...], ...] = ()
    after: tuple[tuple[Slot, ...], ...] = ()
    primes: int = 0
    arguments: tuple[str, ...] | None = None
    bracket: bool = False
    bare: bool = False
    word: bool = False
    size: tuple[str, ...] = ()
    range: str = ""

    @property
    def shape(self) -> tuple[object, ...]:
        """What two names of one table may not share."""
        slots = tuple(
            tuple(tuple("" if s.is_index else s.text for s in group) for group in groups)
            for groups in (self.below, self.above, self.after)
        )
        return self.head, slots, self.primes, len(self.arguments) if self.arguments is not None else -1, self.bracket


@dataclass(frozen=True)
class Names:
    """The names that hold for one formula.

    Attributes
    ----------
    declarations : tuple of Declaration
    colours, labels, products : sets of str
        Words that only colour, labels below brackets, runs of three or more letters that are products.
    postfix : bool
        Whether `d/dt` may stand behind what it differentiates.
    """

    declarations: tuple[Declaration, ...]
    colours: frozenset[str] = frozenset()
    labels: frozenset[str] = frozenset()
    products: frozenset[str] = frozenset()
    postfix: bool = False

    @cached_property
    def by_head(self) -> dict[str, tuple[Declaration, ...]]:
        """Head -> its declarations."""
        found: dict[str, tuple[Declaration, ...]] = {}
        for declaration in self.declarations:
            found[declaration.head] = (*found.get(declaration.head, ()), declaration)
        return found

    @cached_property
    def by_pattern(self) -> dict[str, Declaration]:
        """Pattern -> its declaration."""
        return {declaration.pattern: declaration for declaration in self.declarations}


@dataclass(frozen=True)
class _Line:
    number: int
    section: str
    patterns: str
    kind: str
    removed: bool = False


@dataclass(frozen=True)
class NamesTable:
    """A table of names, as `read_names` gives it."""

    lines: tuple[_Line, ...]
    source: str = ""
    _made: dict[str, Names] = field(default_factory=dict, repr=False, compare=False)

    @property
    def sections(self) -> tuple[str, ...]:
        """Headings of the table, in their order."""
        return tuple(dict.fromkeys(line.section for line in self.lines if line.section))

    def of(self, identifier: str) -> Names:
        """Return the names that hold for a formula.

        Raises
        ------
        NamesError
            A pattern that is no name, an unknown kind, one shape twice in a section.
        """
        if identifier not in self._made:
            self._made[identifier] = self._names(identifier)
        return self._made[identifier]

    def _names(self, identifier: str) -> Names:
        wanted = ("", identifier.rpartition(".")[0], identifier)
        lines = [line for section in dict.fromkeys(wanted) for line in self.lines if line.section == section]
        kept: list[tuple[_Line, str, Items]] = []
        for line in lines:
            for text, items in _patterns(line, self.source):
                kept = [
                    entry
                    for entry in kept
                    if entry[1] != text or (not line.removed and entry[0].section == line.section)
                ]
                if not line.removed:
                    kept.append((line, text, items))
        integers = {text for line, text, _ in kept if line.kind.split()[0] == "integer" and len(text) == 1}
        return _names(kept, integers, self.source)


def read_names(text: str, source: str = "") -> NamesTable:
    r"""Return a table of names.

    Parameters
    ----------
    text : str
    source : str
        Its file, for messages.

    Raises
    ------
    NamesError
        A line that is none of the table, an unknown kind, a pattern that is no name.

    Examples
    --------
    >>> table = read_names("n : integer >= 0\nP_n(x) : function\nx : real")
    >>> [d.pattern for d in table.of("eq-1").declarations]
    ['n', 'P_n(x)', 'x']
    """
    lines: list[_Line] = []
    section = ""
    for number, raw in enumerate(text.splitlines(), 1):
        line = re.sub(r"(^|\s)#.*", "", raw).strip()
        if not line:
            continue
        if heading := re.fullmatch(r"\[([\w.-]+)\]", line):
            section = heading[1]
        elif line.startswith("- "):
            lines.append(_Line(number, section, line[2:].strip(), "", removed=True))
        else:
            patterns, colon, kind = line.rpartition(" : ")
            if not colon:
                raise _error(source, number, f"found {line!r}, expected `PATTERN, PATTERN : KIND`")
            lines.append(_Line(number, section, patterns.strip(), kind.strip()))
    table = NamesTable(tuple(lines), source)
    for heading_ in ("", *table.sections):
        table.of(heading_ if "." in heading_ else f"{heading_}.")
    return table


def _error(source: str, line: int, reason: str) -> NamesError:
    return NamesError(f"{source or 'names'}:{line}: {reason}")


def _patterns(line: _Line, source: str) -> Iterable[tuple[str, Items]]:
    try:
        for items in split(nest(line.patterns)):
            if not items:
                raise _error(source, line.number, "found a comma without a name")
            yield _printed(line.patterns, items), items
    except UnreadableError as error:
        raise _error(source, line.number, f"{line.patterns!r}: {error.reason}") from error


def _printed(text: str, items: Items) -> str:
    """Return the text of one of several patterns, without spaces."""
    start = items[0].at
    depth = 0
    for k in range(start, len(text)):
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(text[k], 0)
        if text[k] == "," and not depth:
            return re.sub(r"\s", "", text[start:k])
    return re.sub(r"\s", "", text[start:])


def _names(kept: list[tuple[_Line, str, Items]], integers: set[str], source: str) -> Names:
    declarations: list[Declaration] = []
    words: dict[str, set[str]] = {"colour": set(), "label": set(), "product": set()}
    postfix = False
    for line, text, items in kept:
        kind, options = _kind(line, source)
        if kind in words:
            words[kind].add(text)
        elif kind == "postfix derivative":
            postfix = True
        else:
            declarations.append(_declaration(line, text, items, kind, options, integers, source))
    seen: dict[tuple[object, ...], Declaration] = {}
    for declaration in declarations:
        other = seen.setdefault(declaration.shape, declaration)
        if other is not declaration:
            raise _error(
                source, declaration.line, f"{declaration.pattern}: looks like {other.pattern} of line {other.line}"
            )
    colours, labels, products = (frozenset(words[kind]) for kind in ("colour", "label", "product"))
    return Names(tuple(declarations), colours, labels, products, postfix)


def _kind(line: _Line, source: str) -> tuple[str, str]:
    for kind in sorted(KINDS, key=len, reverse=True):
        if line.kind == kind or line.kind.startswith(f"{kind} "):
            return kind, line.kind[len(kind) :].strip()
    raise _error(source, line.number, f"unknown kind {line.kind!r}, expected one of {', '.join(KINDS)}")


def _declaration(
    line: _Line, text: str, items: Items, kind: str, options: str, integers: set[str], source: str
) -> Declaration:
    bare = kind == "function bare"
    word = bool(re.search(r"\bword\b", options))
    options = re.sub(r"\bword\b", "", options).strip()
    value = kind
    if kind.startswith("function"):
        kind, value = "function", "real"
        for name in _VALUES:
            if options == name:
                value, options = name, ""
    size: tuple[str, ...] = ()
    if value == "matrix" and (found := re.fullmatch(r"(\w+)\s*x\s*(\w+)", options)):
        size, options = (found[1], found[2]), ""
    shape = _shape(line, text, items, integers, source)
    if (kind == "function") != (shape.arguments is not None):
        raise _error(source, line.number, f"{text}: found {kind}, expected a function just where arguments are named")
    return replace(shape, kind=kind, value=value, bare=bare, word=word, size=size, range=options)


def head_of(item: Item) -> str:
    r"""Return the head that an item begins a name with, or nothing.

    Examples
    --------
    >>> print(head_of(nest(r"\hat{x} + 1")[0]))
    \hat{x}
    """
    if item.kind in ("run", "upright", "letter"):
        return item.text
    if item.kind == "text":
        return f"\\text{{{item.text}}}"
    if item.kind == "accent" and len(item.parts[0]) == 1:
        inner = item.parts[0][0]
        return f"{item.text}{{{inner.text}}}" if isinstance(inner, Item) and inner.kind in ("run", "letter") else ""
    return ""


def _shape(line: _Line, text: str, items: Items, integers: set[str], source: str) -> Declaration:
    """Return a pattern with its head, scripts, primes, arguments and bracket; its kind is not known yet."""
    below: list[tuple[Slot, ...]] = []
    above: list[tuple[Slot, ...]] = []
    after: list[tuple[Slot, ...]] = []
    primes, bracket = 0, False
    arguments: tuple[str, ...] | None = None
    # `{P_i}_x`: what stands in braces comes first.
    while items and items[0].kind == "group":
        items = (*items[0].parts[0], *items[1:])
    head = head_of(items[0]) if items else ""
    if not head:
        raise _error(source, line.number, f"{line.patterns!r} is no name")
    for item in items[1:]:
        if item.kind in ("sub", "sup"):
            slots = _slots(item.parts[0], integers)
            (above if item.kind == "sup" else below if arguments is None else after).append(slots)
        elif item.kind == "prime":
            primes += 1
        elif item.kind == "fence" and item.text == "()" and arguments is None:
            arguments = tuple(label_of(part) for part in split(item.parts[0]))
        elif item.kind == "fence" and item.text == "[]":
            bracket = True
        else:
            raise _error(source, line.number, f"{line.patterns!r} is no name")
    scripts = tuple(below), tuple(above), tuple(after)
    return Declaration(text, head, "", "", line.number, *scripts, primes, arguments, bracket)


def label_of(items: Items) -> str:
    """Return the text of an index that is a label."""
    return "".join(item.text for item in items)


def _slots(content: Items, integers: set[str]) -> tuple[Slot, ...]:
    found: list[Slot] = []
    for part in split(content):
        text = label_of(part)
        if text in integers:
            found.append(Slot(text, True))
        elif len(part) == 1 and part[0].kind == "run" and len(text) > 1 and all(letter in integers for letter in text):
            found += [Slot(letter, True) for letter in text]
        else:
            found.append(Slot(text, False))
    return tuple(found)
