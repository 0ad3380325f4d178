"""What a display says: statements line by line, and to which of them a condition belongs.

A line that begins with a relation continues the last chain that is no condition; one that begins with a sign, or
follows a line that ends in one, continues the sum before it. `where` gives a name from its own line on, `when` limits
the statement right before it. What looks like columns of a picture is refused.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.expressions import side_of
from semispline.papers.latex.names import Names
from semispline.papers.latex.tokens import LAYOUTS, WORDS, Item, Items, split
from semispline.papers.latex.trees import Condition, Number, Statement, Tree


def statements(items: Items, names: Names) -> tuple[Statement, ...]:
    """Read a display.

    Raises
    ------
    UnreadableError
    """
    display = _Display(names)
    for line in _sums_joined(_lines(items)):
        display.line(_with_words(line, names))
    if not display.done:
        raise UnreadableError(Trouble.TEX, "found nothing, expected a formula", 0)
    return tuple(draft.made() for draft in display.done)


def _lines(items: Items) -> list[Items]:
    """Return the lines of a display: rows of the environment that it is, cells joined."""
    if len(items) == 1 and items[0].kind == "rows" and items[0].text in LAYOUTS:
        return [line for row in items[0].rows for line in _lines(_joined(row))]
    return [items] if items else []


def _joined(row: tuple[Items, ...]) -> Items:
    """Return the cells of a row as one line; between `+` and `& +3` the column mark makes one sign of two."""
    line: list[Item] = []
    for cell in row:
        rest = list(cell)
        if line and rest and line[-1].kind == rest[0].kind == "sign":
            first, second = line[-1].text, rest[0].text
            if first not in "+-" or second not in "+-":
                raise UnreadableError(Trouble.TEX, f"found {first} before {second}", rest[0].at)
            line[-1] = Item("sign", "+" if first == second else "-", line[-1].at)
            rest = rest[1:]
        line += rest
    return tuple(line)


def _sums_joined(lines: list[Items]) -> list[Items]:
    """Return the lines with those joined that one sum runs over."""
    done: list[Items] = []
    for line in lines:
        open_sum = bool(done) and done[-1][-1].kind == "sign"
        after_arrow = bool(done) and done[-1][-1].kind == "arrow"
        if done and (open_sum or (line[0].kind == "sign" and not after_arrow)):
            if open_sum and line[0].kind == "sign":
                raise UnreadableError(Trouble.TEX, "found a sign after a sign", line[0].at)
            if any(item.kind == "relation" for item in line):
                raise UnreadableError(
                    Trouble.LAYOUT, "a line that continues a sum has a relation of its own", line[0].at
                )
            if any(item.kind in ("comma", "word", "arrow") for item in done[-1]):
                raise UnreadableError(Trouble.LAYOUT, "which sum this line continues is not clear", line[0].at)
            done[-1] += line
        else:
            done.append(line)
    return done


def _with_words(line: Items, names: Names) -> Items:
    return tuple(
        Item("word", WORDS[item.text.lower()], item.at)
        if item.kind == "run" and item.text.lower() in WORDS and item.text not in names.by_head
        else item
        for item in line
    )


@dataclass
class _Draft:
    """A statement while its lines are read."""

    sides: list[Tree]
    relations: list[str]
    continues: bool
    after: str
    since: int = 0
    conditions: list[tuple[str, int, _Draft]] = field(default_factory=list)

    def made(self) -> Statement:
        # What limits this statement comes first: behind a condition, `when` would be said of that.
        ordered = sorted(self.conditions, key=lambda condition: condition[0] != "when")
        conditions = tuple(Condition(word, since, draft.made()) for word, since, draft in ordered)
        return Statement(tuple(self.sides), tuple(self.relations), self.continues, self.after, conditions)


class _Display:
    """The statements read so far."""

    def __init__(self, names: Names) -> None:
        self.names = names
        self.done: list[_Draft] = []
        # Conditions that stand before the statement they belong to.
        self.given: list[_Draft] = []
        self.arrow = ""

    def line(self, line: Items) -> None:
        """Read one line: clauses between commas, arrows and words."""
        mode, last = "", None
        clause: list[Item] = []
        separator = ""
        for item in (*line, Item("end", "", line[-1].at + 1)):
            if item.kind not in ("comma", "arrow", "word", "end"):
                clause.append(item)
                continue
            if clause:
                last = self._clause(tuple(clause), mode, last)
            elif item.kind == "arrow" and self.arrow:
                raise UnreadableError(Trouble.TEX, "found two arrows without anything between", item.at)
            elif item.kind == "comma" and (separator != "" or not self.done):
                raise UnreadableError(Trouble.TEX, "found a comma with nothing before it", item.at)
            elif item.kind == "end" and separator in ("word", "arrow") and len(line) > 1:
                raise UnreadableError(Trouble.TEX, "found nothing at the end of a line, expected a statement", item.at)
            elif item.kind == "word" and separator == "word":
                raise UnreadableError(Trouble.WORD, f"found the word {item.text!r} after a word", item.at)
            mode = self._mode(item, mode, last)
            separator = item.kind
            clause = []

    def _mode(self, item: Item, mode: str, last: _Draft | None) -> str:
        if item.kind == "arrow":
            self.arrow = item.text
            return ""
        if item.kind == "comma":
            # Behind `when i = 0,` only a word tells whether a condition or a statement follows.
            return {"given": "", "when": "unclear"}.get(mode, mode)
        if item.kind == "word":
            if item.text == "and":
                return "unclear" if mode == "when" else mode
            if item.text == "otherwise":
                raise UnreadableError(Trouble.WORD, "found `otherwise` outside of cases", item.at)
            if item.text != "given" and last is None:
                raise UnreadableError(Trouble.WORD, f"found {item.text!r} with no statement before it", item.at)
            return item.text
        return mode

    def _clause(self, items: Items, mode: str, last: _Draft | None) -> _Draft | None:
        if mode == "unclear":
            raise UnreadableError(Trouble.LAYOUT, "a condition or a statement, behind a condition", items[0].at)
        if len(items) == 1 and items[0].kind == "fence" and items[0].text == "\\{.":
            return self._system(items[0], mode, last)
        if items[0].kind == "fence" and items[0].text == ".\\}":
            self._givens(items[0])
            items = items[1:]
            if not items:
                raise UnreadableError(
                    Trouble.LAYOUT, "a closing brace with no statement behind it", self.given[0].since
                )
        if items and _is_conditions(items[-1]):
            if len(items) > 1:
                last = self._statement(items[:-1], mode, last)
            if last is None:
                raise UnreadableError(
                    Trouble.LAYOUT, "conditions in braces with no statement before them", items[-1].at
                )
            for part in split(items[-1].parts[0]):
                sides = split(part, "relation")
                # { a = 3b } gives a name, { x <= 1 } is a limit.
                gives = len(sides) == 2 and len(sides[0]) <= 2 and any(x.text == "=" for x in part)
                self._attach("where" if gives else "when", part, last)
            return last
        return self._statement(items, mode, last)

    def _system(self, fence: Item, mode: str, last: _Draft | None) -> _Draft | None:
        for line in _sums_joined(_lines(fence.parts[0])):
            words = _with_words(line, self.names)
            if mode:
                last = self._statement(words, mode, last)
            else:
                self.line(words)
                last = self.done[-1] if self.done else None
        return last

    def _givens(self, fence: Item) -> None:
        for line in _lines(fence.parts[0]):
            self.given.append(self._chain(line, allow_continuing=False))

    def _attach(self, word: str, items: Items, to: _Draft) -> _Draft:
        draft = self._chain(items, allow_continuing=False)
        if not draft.relations:
            raise UnreadableError(Trouble.LAYOUT, "a condition without a relation", items[0].at if items else 0)
        to.conditions.append((word, to.since, draft))
        return draft

    def _statement(self, items: Items, mode: str, last: _Draft | None) -> _Draft | None:
        if mode == "given":
            self.given.append(self._chain(items, allow_continuing=False))
            return None
        if mode:
            assert last is not None
            # `when` belongs to what stands right before it, `where` to the statement of the line.
            to = last if mode == "when" else self.done[-1]
            return self._attach(mode, items, to)
        draft = self._chain(items, allow_continuing=True)
        if draft.continues and self.done and not self.arrow:
            chain = self.done[-1]
            chain.since = len(chain.sides)
            chain.sides += draft.sides
            chain.relations += draft.relations
            return chain
        if draft.continues and self.done:
            raise UnreadableError(Trouble.LAYOUT, "found an arrow before a line that continues a chain", items[0].at)
        draft.after, self.arrow = self.arrow, ""
        draft.conditions = [("where", 0, given) for given in self.given]
        self.given = []
        self.done.append(draft)
        return draft

    def _chain(self, items: Items, allow_continuing: bool) -> _Draft:
        sides = split(items, "relation")
        relations = [item for item in items if item.kind == "relation"]
        at = items[0].at if items else 0
        continues = len(sides) > 1 and (not sides[0] or _is_dots(sides[0]))
        if continues:
            if not allow_continuing:
                raise UnreadableError(Trouble.LAYOUT, "a condition that begins with a relation", at)
            sides = sides[1:]
        # `a = ... = b` leaves steps out.
        kept = [k for k, side in enumerate(sides) if not (_is_dots(side) and k + continues > 0 and k < len(sides) - 1)]
        texts = [relation.text for relation in relations]
        for k in range(len(sides)):
            if k not in kept and {texts[k - 1 + continues], texts[k + continues]} != {"="}:
                raise UnreadableError(Trouble.ELLIPSIS, "dots between relations that are not both =", at)
        trees = [side_of(sides[k], texts[k - 1 + continues] if k + continues else "", self.names, at) for k in kept]
        texts = [texts[k + continues - 1] for k in kept if k + continues]
        if len(trees) == 1 and not texts and isinstance(trees[0], Number) and self.done:
            raise UnreadableError(Trouble.NUMERAL, "a number that stands alone behind a comma", at)
        return _Draft(trees, texts, continues, "", since=0)


def _is_dots(side: Items) -> bool:
    return len(side) == 1 and side[0].kind == "dots"


def _is_conditions(item: Item) -> bool:
    """Whether braces hold relations, such as { x <= 1 } behind a formula."""
    if item.kind != "fence" or item.text != "\\{\\}":
        return False
    return all(any(x.kind == "relation" for x in part) for part in split(item.parts[0]))
