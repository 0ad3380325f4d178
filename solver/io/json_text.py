"""JSON text that loses no digit, and reading that refuses what JSON leaves open."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from reprlib import Repr
from typing import Any

from semispline.solver.errors import FileError
from semispline.solver.io.disk import read_bytes

_PERHAPS_NOT_FINITE = re.compile(rb"NaN|Infinity|[eE]\+?[0-9]{3}")
_REPR = Repr()
_REPR.maxstring, _REPR.maxother, _REPR.maxlong = 40, 40, 40
_REPR.maxlist, _REPR.maxdict, _REPR.maxlevel = 3, 2, 2


def short(value: Any) -> str:
    """Return the value as a message shows it, cut where it is long."""
    return _REPR.repr(value)


def to_text(record: Mapping[str, Any]) -> str:
    """Return JSON text: one key a line, one row of points a line, floats as their shortest exact decimal.

    Raises
    ------
    FileError
        NaN or infinity, which JSON cannot hold.

    Examples
    --------
    >>> print(to_text({"knots": [0.0, 0.1], "rows": [[1], [2]]}), end="")
    {
     "knots": [0.0, 0.1],
     "rows": [
      [1],
      [2]
     ]
    }
    """
    try:
        return _pretty(record, "") + "\n"
    except ValueError as error:
        raise FileError(f"JSON: {error}; every number must be finite") from None


def load_json(path: str | Path) -> Any:
    """Return the content of a JSON file, keys unique and numbers finite.

    Raises
    ------
    FileError
        Missing, not readable, not JSON, NaN or Infinity, or a key that occurs twice.
    """
    data = read_bytes(path)
    try:
        content = json.loads(data, object_pairs_hook=_unique_keys)
    except RecursionError:
        raise FileError(f"{path}: brackets nested too deeply for this format") from None
    except json.JSONDecodeError as error:
        raise FileError(
            f"{path}: not JSON (line {error.lineno}, column {error.colno}: {error.msg}); write the file anew"
        ) from None
    except UnicodeDecodeError:
        raise FileError(f"{path}: not text in UTF-8; give a JSON file, or a CAD file with its own suffix") from None
    except ValueError as error:
        # Python's own words on a number of thousands of digits name no remedy that a file could follow.
        reason = "a number of too many digits; write at most 17" if "digits" in str(error) else str(error)
        raise FileError(f"{path}: {reason}") from None
    # Python reads NaN, Infinity and 1e999; looking for the place takes time, and is needed for them alone.
    if _PERHAPS_NOT_FINITE.search(data):
        for place, number in _numbers(content):
            if not math.isfinite(number):
                raise FileError(f"{path}: {place}: found {number}, expected a finite number")
    return content


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    record: dict[str, Any] = {}
    for key, value in pairs:
        if key in record:
            raise ValueError(f"key {short(key)} occurs twice, expected once")
        record[key] = value
    return record


def _numbers(content: Any) -> Iterator[tuple[str, float]]:
    """Yield every float with its place, in the order of the file."""
    waiting = [("", content)]
    while waiting:
        place, value = waiting.pop()
        if isinstance(value, float):
            yield place, value
        elif isinstance(value, dict):
            waiting += [(f"{place}.{key}".lstrip("."), item) for key, item in reversed(value.items())]
        elif isinstance(value, list):
            waiting += [(f"{place}[{i}]", item) for i, item in reversed(list(enumerate(value)))]


def _pretty(value: Any, indent: str) -> str:
    inner = indent + " "
    if isinstance(value, Mapping) and value:
        items = [f"{inner}{json.dumps(key)}: {_pretty(item, inner)}" for key, item in value.items()]
        return "{\n" + ",\n".join(items) + f"\n{indent}}}"
    if isinstance(value, list) and value and isinstance(value[0], (list, Mapping)):
        return "[\n" + ",\n".join(inner + _pretty_item(item, inner) for item in value) + f"\n{indent}]"
    return json.dumps(value, allow_nan=False)


def _pretty_item(item: Any, indent: str) -> str:
    return _pretty(item, indent) if isinstance(item, Mapping) else json.dumps(item, allow_nan=False)
