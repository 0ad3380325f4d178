"""The same place more than once in a file: mirror images and copies in an assembly fall together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import floor, log

from semispline.solver.topology.entries import Entry
from semispline.solver.topology.place import Place

# Lengths that agree to this fraction of the larger, and angles to this many degrees, are those of a repeated part.
_SAME_LENGTH, _SAME_ANGLE = 1e-4, 0.1


def without_repeats(entries: Iterable[Entry]) -> list[Place]:
    """Return each place once, with the faces of those that repeat it."""
    found: list[tuple[Entry, list[tuple[int, ...]]]] = []
    # By the words and the first length on a scale of which one step is what may differ.
    shelves: dict[tuple[tuple[str, ...], int], list[int]] = {}
    for entry in entries:
        shelf = floor(log(entry.lengths[0]) / _SAME_LENGTH)
        near = [n for step in (-1, 0, 1) for n in shelves.get((entry.words, shelf + step), ())]
        first = min((n for n in near if _same(entry, found[n][0])), default=None)
        if first is None:
            shelves.setdefault((entry.words, shelf), []).append(len(found))
            found.append((entry, []))
        else:
            found[first][1].append(entry.place.where)
    return [replace(entry.place, repeats=tuple(repeats)) for entry, repeats in found]


def _same(one: Entry, two: Entry) -> bool:
    lengths = zip(one.lengths, two.lengths, strict=True)
    angles = zip(one.angles, two.angles, strict=True)
    return all(abs(x - y) <= _SAME_LENGTH * max(x, y) for x, y in lengths) and all(
        abs(x - y) <= _SAME_ANGLE for x, y in angles
    )
