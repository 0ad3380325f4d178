"""Read-only float64 arrays, checked when they are made."""

from __future__ import annotations

import reprlib
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from solver.errors import InputError

FloatArray: TypeAlias = NDArray[np.float64]
# scipy ships no types; sparse matrices are CSR unless said otherwise.
SparseMatrix: TypeAlias = Any


def finite_array(values: ArrayLike, ndim: int, name: str, error: type[InputError]) -> FloatArray:
    """Return a read-only float64 copy of `values`, refused if not numeric, of another dimension, or not finite.

    Raises
    ------
    InputError
        Of the class `error`; the message names the first index at fault.
    """
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError):
        raise error(_fault(values, ndim, name)) from None
    if array.ndim != ndim:
        raise error(f"{name}: has {array.ndim} dimension(s), expected {ndim}")
    if not np.isfinite(array).all():
        index = tuple(np.argwhere(~np.isfinite(array))[0].tolist())
        where = ", ".join(map(str, index))
        raise error(f"{name}[{where}]: found {array[index]}, expected a finite number")
    array.setflags(write=False)
    return array


def _fault(values: Any, ndim: int, name: str) -> str:
    """Say where nested sequences first stop being a rectangular array of real numbers."""

    def at(index: tuple[int, ...]) -> str:
        return f"{name}[{', '.join(map(str, index))}]" if index else name

    def search(entry: Any, depth: int, index: tuple[int, ...]) -> str | None:
        try:
            if depth == 0:
                float(entry)
                return None
            inner = list(entry)
        except (TypeError, ValueError, OverflowError):
            expected = "a list" if depth else "a real number"
            return f"{at(index)}: found {reprlib.repr(entry)}, expected {expected}"
        for i, item in enumerate(inner):
            found = search(item, depth - 1, (*index, i))
            if found:
                return found
            if depth > 1 and len(item) != len(inner[0]):
                return f"{at((*index, i))}: {len(item)} entries, expected {len(inner[0])} as before"
        return None

    return search(values, ndim, ()) or f"{name}: not a rectangular array of real numbers with {ndim} dimension(s)"


def is_whole(value: object) -> bool:
    """Tell whether a value is an integer of Python or NumPy; True and False are not."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool)
