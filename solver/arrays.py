"""Read-only float64 arrays, checked when they are made."""

from __future__ import annotations

import reprlib
from dataclasses import fields
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semispline.solver.errors import InputError

FloatArray: TypeAlias = NDArray[np.float64]
# scipy ships no types; sparse matrices are CSR unless said otherwise.
SparseMatrix: TypeAlias = Any


def finite_array(values: ArrayLike, ndim: int | None, name: str, error: type[InputError]) -> FloatArray:
    """Return a read-only float64 copy of `values`, refused if not real, of another dimension, or not finite.

    `ndim` None takes any dimension of at least 1.

    Raises
    ------
    InputError
        Of the class `error`; the message names the first index at fault.
    """
    array = real_array(values, name, error, ndim)
    if array.ndim != ndim and (ndim is not None or array.ndim == 0):
        raise error(f"{name}: has {array.ndim} dimension(s), expected {'at least 1' if ndim is None else ndim}")
    if not np.isfinite(array).all():
        index = tuple(np.argwhere(~np.isfinite(array))[0].tolist())
        where = ", ".join(map(str, index))
        raise error(f"{name}[{where}]: found {array[index]}, expected a finite number")
    array.setflags(write=False)
    return array


def space_points(values: ArrayLike, ndim: int, name: str, error: type[InputError]) -> FloatArray:
    """Return points as a read-only array, shape (..., 3); those of two coordinates lie in the plane z = 0.

    Raises
    ------
    InputError
        Of the class `error`: as `finite_array`, or another number of coordinates.

    Examples
    --------
    >>> space_points([[1, 2], [3, 4]], 2, "points", InputError)
    array([[1., 2., 0.],
           [3., 4., 0.]])
    """
    points = finite_array(values, ndim, name, error)
    if points.shape[-1] == 3:
        return points
    if points.shape[-1] != 2:
        raise error(f"{name}: {points.shape[-1]} coordinate(s), expected 3, or 2 for what lies in the plane z = 0")
    points = np.concatenate([points, np.zeros((*points.shape[:-1], 1))], axis=-1)
    points.setflags(write=False)
    return points


def real_array(values: ArrayLike, name: str, error: type[InputError], ndim: int | None = None) -> FloatArray:
    """Return a float64 copy of `values`, refused if they are not real numbers in a rectangular array."""
    try:
        if isinstance(values, np.ndarray | np.generic) and np.iscomplexobj(values):
            raise error(f"{name}: found complex numbers, expected real ones")
        return np.array(values, dtype=np.float64, order="C")
    except (TypeError, OverflowError):
        pass
    except ValueError as reason:
        if isinstance(reason, InputError):
            raise
    if ndim is None:
        raise error(f"{name}: found {reprlib.repr(values)}, not an array of real numbers")
    raise error(_fault(values, ndim, name))


def exact_origin(points: FloatArray) -> FloatArray:
    """Return a point from which each of the points, shape (n, d), has an exact difference, shape (d,).

    A difference of floats within a factor of two of each other has no rounding (Sterbenz). A coordinate in which the
    points come too near to zero for that keeps its own zero: there is no more than a digit to be gained.

    Source: P. H. Sterbenz, Floating-Point Computation, 1974, theorem 4.3.1.

    Examples
    --------
    >>> exact_origin(np.array([[1e9, 0, -4], [1e9 + 4, 1, -6]]))
    array([ 1.e+09,  0.e+00, -5.e+00])
    """
    low, high = points.min(axis=0), points.max(axis=0)
    nearest, farthest = np.minimum(np.abs(low), np.abs(high)), np.maximum(np.abs(low), np.abs(high))
    return np.where((low * high > 0) & (farthest <= 3 * nearest), low + (high - low) / 2, 0.0)


def require(value: object, name: str, *kinds: type) -> None:
    """Refuse a value that is none of the classes.

    Raises
    ------
    InputError
    """
    if not isinstance(value, kinds):
        expected = " or a ".join(kind.__name__ for kind in kinds)
        raise InputError(f"{name}: found a {type(value).__name__}, expected a {expected}")


def rebuilt(value: Any) -> tuple[Any, ...]:
    """Return what `__reduce__` needs so that copies are made by the constructor: checked, and read-only again."""
    return type(value), tuple(getattr(value, field.name) for field in fields(value))


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
