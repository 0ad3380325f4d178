"""Dots: read only where their two ends say what is between.

First and last differ in exactly one integer expression. One term before the dots is enough where only indices of
names change, as in `w_1 + ... + w_n`; otherwise there are two or more, and each follows the one before it: `1 + 2 +
... + n`.
"""

from __future__ import annotations

from typing import Any

from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.names import Names
from semispline.papers.latex.resolving import is_integer
from semispline.papers.latex.trees import Elided, Named, Number, Sum, Tree, parts


def elided(before: tuple[Tree, ...], last: Tree, names: Names, at: int) -> Elided:
    """Read dots between terms, or between entries of a row.

    Raises
    ------
    UnreadableError
        What is between does not follow from the ends.
    """
    if not before:
        raise UnreadableError(Trouble.ELLIPSIS, "dots without a beginning", at)
    found = _one_difference(before[0], last)
    if found is None or not all(is_integer(side, names) for side in found):
        raise UnreadableError(Trouble.ELLIPSIS, "first and last do not differ in one integer alone", at)
    start, end = found
    steps = [_one_difference(before[0], term) for term in before[1:]]
    if any(step is None or step[1] != _plus(start, k) for k, step in enumerate(steps, 1)):
        raise UnreadableError(Trouble.ELLIPSIS, "what stands before the dots does not go on one by one", at)
    if len(before) == 1 and not _differ_in_slots(before[0], last):
        raise UnreadableError(Trouble.ELLIPSIS, "one term before the dots, and not only indices change", at)
    return Elided(before[0], last, start, end, before)


def _one_difference(one: Tree, other: Tree) -> tuple[Tree, Tree] | None:
    """Return the only pair in which two trees differ, however often; None where there is no such pair."""
    found = set(_differences(one, other))
    return next(iter(found)) if len(found) == 1 else None


def _differences(one: Any, other: Any) -> list[tuple[Tree, Tree]]:
    if one == other:
        return []
    mine, yours = list(parts(one)), list(parts(other))
    same = type(one) is type(other) and not isinstance(one, Number) and len(mine) == len(yours) > 0
    if isinstance(one, Named) and isinstance(other, Named):
        same = same and one.name == other.name and one.derivative == other.derivative
    if isinstance(one, Sum) and isinstance(other, Sum):
        same = same and [sign for sign, _ in one.terms] == [sign for sign, _ in other.terms]
    if not same:
        return [(one, other)]
    return [pair for a, b in zip(mine, yours, strict=True) for pair in _differences(a, b)]


def _differ_in_slots(one: Any, other: Any) -> bool:
    """Whether two trees differ only within the indices of names."""
    if one == other:
        return True
    if isinstance(one, Named) and isinstance(other, Named) and one.name == other.name:
        mine, yours = one.arguments or (), other.arguments or ()
        return all(_differ_in_slots(a, b) for a, b in zip(mine, yours, strict=True))
    mine, yours = tuple(parts(one)), tuple(parts(other))
    return type(one) is type(other) and len(mine) == len(yours) > 0 and all(map(_differ_in_slots, mine, yours))


def _plus(tree: Tree, k: int) -> Tree:
    return Number(str(int(tree.text) + k)) if isinstance(tree, Number) else Sum((("+", tree), ("+", Number(str(k)))))
