"""Names in a formula: which declaration fits what is printed. None, or two, is refused."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.names import Declaration, Names, Slot, head_of, label_of
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
        elif item.kind == "sup" and all(inner.kind == "prime" for inner in item.parts[0]):  # type: ignore[union-attr]
            primes += len(item.parts[0])
        elif item.kind in ("sub", "sup"):
            scripts = below if item.kind == "sub" else above
            if scripts and not layered:
                raise UnreadableError(Trouble.TEX, f"found a second {item.text}, which TeX refuses", item.at)
            scripts.append(item.parts[0])  # type: ignore[arg-type]
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
    """
    fits: list[tuple[Declaration, Tree, Items | None, int]] = []
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
        _, tree, left, end = fits[0]
        return tree, left, end
    if inner is not None:
        raise inner
    known = ", ".join(f"{d.pattern} (line {d.line})" for d in declared)
    raise UnreadableError(
        Trouble.UNDECLARED, f"no declared name fits {head!r} as it stands here; declared: {known or 'none'}", at
    )


def _fit(
    d: Declaration, items: Items, scripts: Scripts, names: Names, read: Read
) -> tuple[Tree, Items | None, int] | None:
    if len(d.below) != len(scripts.below) or len(d.above) > len(scripts.above):
        return None
    is_function = d.arguments is not None
    derivative = scripts.primes - d.primes
    if derivative < 0 or (derivative and not is_function):
        return None
    slots: list[Tree] = []
    for pattern, content in zip((*d.below, *d.above), (*scripts.below, *scripts.above), strict=False):
        values = _slot_values(pattern, content, names, read)
        if values is None:
            return None
        slots += values
    # What is above a name without indices there is an exponent, and what is above some of them is not known.
    left = scripts.above[len(d.above)] if len(scripts.above) > len(d.above) else None
    end = scripts.end
    following = items[end] if end < len(items) else None
    if d.bracket:
        if following is None or following.kind != "fence" or following.text != "[]":
            return None
        slots.append(_index(following.parts[0], names, read))  # type: ignore[arg-type]
        return Named(d.pattern, tuple(slots)), left, end + 1
    if not is_function:
        # A bracket that holds a list, or takes an index, is no factor.
        if following is not None and following.kind == "fence" and following.text == "()":
            is_list = len(split(following.parts[0])) > 1  # type: ignore[arg-type]
            if is_list or (end + 1 < len(items) and items[end + 1].kind == "sub"):
                return None
        return Named(d.pattern, tuple(slots)), left, end
    if following is None or following.kind != "fence" or following.text != "()":
        if not d.bare or d.after:
            return None
        _variable_place(d, names, derivative, items[end - 1].at)
        return Named(d.pattern, tuple(slots), None, derivative), left, end
    arguments = split(following.parts[0])  # type: ignore[arg-type]
    assert d.arguments is not None
    if len(arguments) != len(d.arguments):
        return None
    if left is not None:
        raise UnreadableError(
            Trouble.FUNCTION_POWER,
            f"a power of {d.pattern} before its bracket may be a power, an index, an iterate",
            following.at,
        )
    end += 1
    if d.after:
        behind = scripts_after(items, end)
        if len(behind.below) != len(d.after) or behind.above or behind.primes:
            return None
        for pattern, content in zip(d.after, behind.below, strict=True):
            values = _slot_values(pattern, content, names, read)
            if values is None:
                return None
            slots += values
        end = behind.end
    elif end < len(items) and items[end].kind == "sub":
        return None
    _variable_place(d, names, derivative, following.at)
    values_ = tuple(read(argument, following.at) for argument in arguments)
    return Named(d.pattern, tuple(slots), values_, derivative), left, end


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


def _slot_values(pattern: tuple[Slot, ...], content: Items, names: Names, read: Read) -> list[Tree] | None:
    """Return what stands for the index letters of one script, or None where it does not fit."""
    if not any(slot.is_index for slot in pattern):
        return [] if label_of(content) == ",".join(slot.text for slot in pattern) else None
    parts = split(content)
    if len(parts) != len(pattern) and len(parts) == 1 and len(content) == 1:
        # Several indices without commas: one letter or digit each.
        only = content[0]
        if only.kind in ("run", "number") and len(only.text) == len(pattern):
            kind = only.kind
            parts = [(Item(kind, c, only.at + k),) for k, c in enumerate(only.text)]
    if len(parts) != len(pattern):
        return None
    values: list[Tree] = []
    for slot, part in zip(pattern, parts, strict=True):
        if not slot.is_index:
            if label_of(part) != slot.text:
                return None
        else:
            values.append(_index(part, names, read))
    return values


def _index(content: Items, names: Names, read: Read) -> Tree:
    at = content[0].at if content else 0
    value = read(content, at)
    if not is_integer(value, names):
        raise UnreadableError(Trouble.KINDS, "an index that is no expression of declared integers", at)
    return value


def is_integer(tree: Tree, names: Names) -> bool:
    """Tell whether a tree is made of whole numbers and declared integers."""
    if isinstance(tree, Number):
        return "." not in tree.text
    if isinstance(tree, Named):
        declaration = names.by_pattern.get(tree.name)
        return declaration is not None and declaration.value == "integer"
    if isinstance(tree, Sum):
        return all(is_integer(term, names) for _, term in tree.terms)
    if isinstance(tree, Product):
        return all(is_integer(factor, names) for factor in tree.factors)
    return isinstance(tree, Factorial | Binomial)


__all__ = ["Scripts", "cut", "derivative_place", "head_of", "is_integer", "resolve", "scripts_after"]
