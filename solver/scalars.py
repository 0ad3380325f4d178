"""Single numbers, checked; without NumPy, so that the command line answers before it is loaded."""

from __future__ import annotations

import reprlib
from numbers import Integral, Real
from typing import TypeGuard

from semispline.solver.errors import InputError


def real_number(value: object, name: str, error: type[InputError]) -> float:
    """Return a real number as a float (it may be NaN or infinite); True, strings and arrays are refused."""
    if not isinstance(value, bool) and isinstance(value, Real):
        try:
            return float(value)
        except OverflowError:
            pass
    raise error(f"{name}: found {reprlib.repr(value)}, expected a real number")


def whole_number(value: object, name: str, least: int, error: type[InputError]) -> int:
    """Return an integer of at least `least`; True, floats and strings are refused."""
    if is_whole(value) and value >= least:
        return int(value)
    raise error(f"{name}: found {reprlib.repr(value)}, expected a whole number of at least {least}")


def is_whole(value: object) -> TypeGuard[int]:
    """Tell whether a value is an integer of Python or NumPy; True and False are not."""
    return isinstance(value, Integral) and not isinstance(value, bool)
