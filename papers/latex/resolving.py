"""Names in a formula: which declaration fits what is printed. None, or two, is refused."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.names import Declaration, Names, Slot, label_of
from semispline.papers.latex.tokens import Item, Items, split
from semispline.papers.latex.trees import Binomial, Factorial, Named, Number, Product, Sum, Tree

Read = Callable[[Items, int], Tree]


@dataclass(frozen=True)
class Scripts:
    """What follows a head: contents of scripts, and primes.

    Attributes
    ----------
    below, above : tuple of Items
    primes : int
    end : int
        Index of the item behind them.
    """

    below: tuple[Items, ...]
    above: tuple[Items, ...]
    primes: int
    end: int


def scripts_after(items: Sequence[Item], i: int, layered: bool = False) -> Scripts:
    """Return the scripts and primes that stand from `items[i]` on; two of a kind are refused as TeX does."""
    below: list[Items] = []
    above: list[Items] = []
    primes = 0
    while i < len(items):
        item = items[i]
        if item.kind == "prime":
            primes += 1
        elif item.kind == "sup" and all(inner.kind == "prime" for inner in item.parts[0]):
            primes += len(item.parts[0])
        elif item.kind in ("sub", "sup"):
            scripts = below if item.kind == "sub" else above
            if scripts and not layered:
                raise UnreadableError(Trouble.TEX, f"found a second {item.text}, which TeX refuses", item.at)
            scripts.append(item.parts[0])
        else:
            break
        i += 1
    return Scripts(tuple(below), tuple(above), primes, i)


def cut(run: Item, names: Names) -> list[str]:
    """Return the heads that a run of letters is made of.

    Raises
    ------
    UnreadableError
        It is no name, and no product of names either; or it may be both.
    """
    text = run.text
    letters_known = len(text) > 1 and all(letter in names.by_head for letter in text)
    if text in names.by_head:
        if letters_known and not any(d.word for d in names.by_head[text]):
            raise UnreadableError(Trouble.TWO_NAMES, f"{text!r} is a name, and so are all its letters", run.at)
        return [text]
    if letters_known and (len(text) == 2 or text in names.products):
        return list(text)
    if len(text) == 1:
        raise UnreadableError(Trouble.UNDECLARED, f"no name is declared with {text!r}", run.at)
    known = " (more than two letters are a product only where the table says so)" if letters_known else ""
    raise UnreadableError(Trouble.WORD, f"{text!r} is no declared name{known}", run.at)


def resolve(
    head: str, at: int, items: Items, scripts: Scripts, names: Names, read: Read
) -> tuple[Tree, Items | None, int]:
    """Return the name that a head with its scripts is, a superscript that is left over, and the index behind it.

    Raises
    ------
    UnreadableError
        No declared name fits, or two do; or what is in an index or a bracket is not read.
    """
    fits: list[tuple[Declaration, Tree, int]] = []
    inner: UnreadableError | None = None
    declared = names.by_head.get(head, ())
    for declaration in declared:
        try:
            found = _fit(declaration, items, scripts, names, read)
        except UnreadableError as error:
            inner = inner or error
            continue
        if found is not None:
            fits.append((declaration, *found))
    if len(fits) > 1:
        both = " and ".join(f"{d.pattern} (line {d.line})" for d, *_ in fits)
        raise UnreadableError(Trouble.TWO_NAMES, f"fits {both}", at)
    if fits:
        declaration, tree, end = fits[0]
        return tree, _left_over(declaration, scripts), end
    if inner is not None:
        raise inner
    known = ", ".join(f"{d.pattern} (line {d.line})" for d in declared) or "none"
    reason = f"no declared name fits {head!r} as it stands here; declared with it: {known}"
    raise UnreadableError(Trouble.UNDECLARED, reason, at)


def _left_over(d: Declaration, scripts: Scripts) -> Items | None:
    """Return the exponent: what stands above a name that has no index there."""
    return scripts.above[len(d.above)] if len(scripts.above) > len(d.above) else None


def _fit(d: Declaration, items: Items, scripts: Scripts, names: Names, read: Read) -> tuple[Tree, int] | None:
    """Return a name and the index behind it, or None where the declaration does not fit."""
    derivative = scripts.primes - d.primes
    if len(d.below) != len(scripts.below) or len(d.above) > len(scripts.above) or derivative < 0:
        return None
    slots = _slots((*d.below, *d.above), (*scripts.below, *scripts.above[: len(d.above)]), names, read)
    if slots is None:
        return None
    if d.arguments is not None:
        return _function(d, slots, items, scripts, names, read)
    if derivative or not _may_stand(d, items, scripts.end):
        return None
    if d.bracket:
        slots = (*slots, _index(items[scripts.end].parts[0], names, read))
    return Named(d.pattern, slots), scripts.end + d.bracket


def _may_stand(d: Declaration, items: Items, end: int) -> bool:
    """Whether a name that is no function may stand before what follows it."""
    following = items[end] if end < len(items) else Item("", "", 0)
    if d.bracket:
        return following.kind == "fence" and following.text == "[]"
    # A bracket that holds a list, or takes an index, is no factor.
    takes_index = end + 1 < len(items) and items[end + 1].kind == "sub"
    is_bracket = following.kind == "fence" and following.text == "()"
    return not (is_bracket and (takes_index or len(split(following.parts[0])) > 1))


def _function(
    d: Declaration, slots: tuple[Tree, ...], items: Items, scripts: Scripts, names: Names, read: Read
) -> tuple[Tree, int] | None:
    derivative, end = scripts.primes - d.primes, scripts.end
    following = items[end] if end < len(items) else Item("", "", items[end - 1].at)
    if following.kind != "fence" or following.text != "()":
        if not d.bare or d.after:
            return None
        _variable_place(d, names, derivative, following.at)
        return Named(d.pattern, slots, None, derivative), end
    arguments = split(following.parts[0])
    behind = scripts_after(items, end + 1)
    if len(arguments) != len(d.arguments or ()) or len(behind.below) != len(d.after):
        return None
    if _left_over(d, scripts) is not None:
        reason = f"a power of {d.pattern} before its bracket may be a power, an index, an iterate"
        raise UnreadableError(Trouble.FUNCTION_POWER, reason, following.at)
    more = _slots(d.after, behind.below, names, read)
    if more is None:
        return None
    _variable_place(d, names, derivative, following.at)
    values = tuple(read(argument, following.at) for argument in arguments)
    # What stands above behind the bracket is an exponent.
    return Named(d.pattern, (*slots, *more), values, derivative), end + 1 + len(behind.below)


def _variable_place(d: Declaration, names: Names, derivative: int, at: int) -> None:
    if derivative and derivative_place(d, names) is None:
        raise UnreadableError(Trouble.OPERATOR, f"a prime on {d.pattern}: by which argument is not told", at)


def derivative_place(d: Declaration, names: Names) -> int | None:
    """Return the place of the only argument that is not a declared integer, by which primes differentiate."""
    places = [
        k
        for k, letter in enumerate(d.arguments or ())
        if not any(other.kind == "integer" for other in names.by_head.get(letter, ()) if other.pattern == letter)
    ]
    return places[0] if len(places) == 1 else None


def _slots(
    patterns: tuple[tuple[Slot, ...], ...], contents: tuple[Items, ...], names: Names, read: Read
) -> tuple[Tree, ...] | None:
    """Return what stands for the index letters of some scripts, or None where one does not fit."""
    values: list[Tree] = []
    for pattern, content in zip(patterns, contents, strict=True):
        found = _slot_values(pattern, content, names, read)
        if found is None:
            return None
        values += found
    return tuple(values)


def _slot_values(pattern: tuple[Slot, ...], content: Items, names: Names, read: Read) -> list[Tree] | None:
    if not any(slot.is_index for slot in pattern):
        return [] if label_of(content) == ",".join(slot.text for slot in pattern) else None
    entries = split(content)
    only = content[0] if len(content) == 1 else Item("", "", 0)
    if len(entries) < len(pattern) == len(only.text) and only.kind in ("run", "number"):
        # Several indices without commas: one letter or digit each.
        entries = [(Item(only.kind, c, only.at + k),) for k, c in enumerate(only.text)]
    if len(entries) != len(pattern):
        return None
    if any(label_of(e) != slot.text for slot, e in zip(pattern, entries, strict=True) if not slot.is_index):
        return None
    return [_index(entry, names, read) for slot, entry in zip(pattern, entries, strict=True) if slot.is_index]


def _index(content: Items, names: Names, read: Read) -> Tree:
    at = content[0].at if content else 0
    value = read(content, at)
    if not is_integer(value, names):
        raise UnreadableError(Trouble.KINDS, "an index that is no expression of declared integers", at)
    return value


def is_integer(tree: Tree, names: Names) -> bool:
    """Tell whether a tree is made of whole numbers and declared integers."""
    match tree:
        case Number(text):
            return "." not in text
        case Named(name):
            return names.by_pattern[name].value == "integer"
        case Sum(terms):
            return all(is_integer(term, names) for _, term in terms)
        case Product(factors):
            return all(is_integer(factor, names) for factor in factors)
    return isinstance(tree, Factorial | Binomial)
