"""Read-only float64 arrays, checked when they are made."""

from __future__ import annotations

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
    except (TypeError, ValueError):
        raise error(f"{name}: not a rectangular array of real numbers; give {ndim} nested level(s) of floats") from None
    if array.ndim != ndim:
        raise error(f"{name}: has {array.ndim} dimension(s), expected {ndim}")
    if not np.isfinite(array).all():
        index = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        where = ", ".join(map(str, index))
        raise error(f"{name}[{where}]: found {array[index]}, expected a finite number")
    array.setflags(write=False)
    return array


def is_whole(value: object) -> bool:
    """Tell whether a value is an integer of Python or NumPy; True and False are not."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool)
