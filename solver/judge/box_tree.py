"""Pairs of boxes that overlap, found by a tree: for triangles in space and segments in the plane."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray

IndexArray = NDArray[np.intp]

# Bits of each coordinate by which boxes are ordered, and how many pairs are worked on at once.
_BITS, _AT_ONCE = 10, 2**13


@dataclass(frozen=True, eq=False)
class BoxTree:
    """Boxes around boxes, two by two.

    Attributes
    ----------
    order : ndarray of int, shape (n,)
        The box of each leaf; neighbours in the tree are neighbours in space.
    levels : tuple of (low, high), each of shape (2^k, d)
        Corners, from the root to the leaves; leaves without a box are empty.
    """

    order: IndexArray
    levels: tuple[tuple[FloatArray, FloatArray], ...]


def box_tree(low: FloatArray, high: FloatArray) -> BoxTree:
    """Build the tree of boxes with corners `low` and `high`, shape (n, d), n at least 1."""
    n, d = low.shape
    order = np.argsort(_morton(low + high), kind="stable")
    size = 1 << (n - 1).bit_length()
    lows, highs = np.full((size, d), np.inf), np.full((size, d), -np.inf)
    lows[:n], highs[:n] = low[order], high[order]
    levels = [(lows, highs)]
    while len(levels[-1][0]) > 1:
        lows, highs = levels[-1]
        levels.append((np.minimum(lows[::2], lows[1::2]), np.maximum(highs[::2], highs[1::2])))
    return BoxTree(order, tuple(reversed(levels)))


def overlapping(a: BoxTree, b: BoxTree) -> Iterator[tuple[IndexArray, IndexArray]]:
    """Yield indices of boxes of a and of b that overlap, part by part; of one tree with itself each pair once.

    Examples
    --------
    >>> low = np.array([[0.0], [1.0], [5.0]])
    >>> tree = box_tree(low, low + 1.5)
    >>> [(i.tolist(), j.tolist()) for i, j in overlapping(tree, tree)]
    [([0], [1])]
    """
    root = np.zeros(1, dtype=np.intp)
    waiting = [(0, root, root)]
    last = max(len(a.levels), len(b.levels)) - 1
    while waiting:
        level, i, j = waiting.pop()
        (low_a, high_a), (low_b, high_b) = (t.levels[min(level, len(t.levels) - 1)] for t in (a, b))
        # One coordinate after the other: there are two or three, and many pairs.
        near = reduce(np.logical_and, ((low_a[i] <= high_b[j]) & (low_b[j] <= high_a[i])).T)
        i, j = i[near], j[near]
        if level == last:
            apart = i != j if a is b else np.ones(len(i), dtype=bool)
            first, second = a.order[i[apart]], b.order[j[apart]]
            if a is b:
                first, second = np.minimum(first, second), np.maximum(first, second)
            if len(first):
                yield first, second
            continue
        i, j = _children(i, j, *(level + 1 < len(t.levels) for t in (a, b)))
        if a is b:
            once = i <= j
            i, j = i[once], j[once]
        waiting += [(level + 1, i[at : at + _AT_ONCE], j[at : at + _AT_ONCE]) for at in range(0, len(i), _AT_ONCE)]


def _children(i: IndexArray, j: IndexArray, of_a: bool, of_b: bool) -> tuple[IndexArray, IndexArray]:
    """Return the pairs of children; a tree that has none stays where it is."""
    first = [2 * i, 2 * i + 1] if of_a else [i]
    second = [2 * j, 2 * j + 1] if of_b else [j]
    return (
        np.concatenate([x for x in first for _ in second]),
        np.concatenate([y for _ in first for y in second]),
    )


def _morton(centres: FloatArray) -> NDArray[np.int64]:
    """Return numbers along a curve that fills space: the bits of the coordinates in turn."""
    span = np.ptp(centres, axis=0)
    whole = ((centres - centres.min(axis=0)) / np.where(span > 0, span, 1.0) * (2**_BITS - 1)).astype(np.int64)
    d = centres.shape[1]
    code = np.zeros(len(centres), dtype=np.int64)
    for bit in range(_BITS):
        for axis in range(d):
            code |= ((whole[:, axis] >> bit) & 1) << (d * bit + axis)
    return code
