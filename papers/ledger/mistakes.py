"""Mistakes in the files of a paper: told with file and line, what was found and what would be right."""

from __future__ import annotations

import ast
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from semispline.papers.ledger.records import LedgerError
from semispline.solver.errors import InputError


class MistakeError(LedgerError):
    """A mistake in the files of a paper; the message begins with file and line."""


# What would be right, where Python does not say it.
_EXPECTED = {
    SyntaxError: "Python",
    NameError: "a name that is defined or imported above",
    ImportError: "a module that exists, and names that are in it",
    AttributeError: "a name that the object has",
    TypeError: "arguments of the number and kind that the call takes",
    KeyError: "a key that is there",
    IndexError: "an index that is there",
    ZeroDivisionError: "a divisor other than 0",
    SystemExit: "files that do not end the process",
}


@contextmanager
def placed(folder: Path) -> Iterator[None]:
    """Turn whatever the files of a paper raise into a `MistakeError` that says where.

    Raises
    ------
    MistakeError
    """
    try:
        yield
    except MistakeError:
        raise
    except (Exception, SystemExit) as error:
        raise MistakeError(mistake_text(error, folder)) from error


def mistake_text(error: BaseException, folder: Path) -> str:
    """Return what is wrong in the files of a paper, with the innermost place of theirs that led to it.

    Without a place where nothing of theirs is on the way, such as in a check of the engine that refuses a formula.
    """
    where = place_of_error(error, folder)
    return f"{where}: {found_text(error)}" if where else found_text(error)


def place_of_error(error: BaseException, folder: Path) -> str:
    """Return file and line of a paper where an error was raised or led to it; empty where it was somewhere else."""
    folder = folder.resolve()
    if isinstance(error, SyntaxError) and error.filename and _within(error.filename, folder):
        return f"{_shown(error.filename, folder)}:{error.lineno or 1}"
    frames = traceback.extract_tb(error.__traceback__)
    for frame in reversed(frames):
        if _within(frame.filename, folder):
            return f"{_shown(frame.filename, folder)}:{frame.lineno}"
    return ""


def place_of_text(text: str, folder: Path, *names: str) -> str:
    """Return file and line where a text stands between quotes, in files of these patterns; empty where it does not."""
    for path in (path for name in names for path in sorted(folder.glob(name))):
        try:
            tree = ast.parse(path.read_text(encoding="utf-8"))
        except (OSError, ValueError, SyntaxError):
            continue
        lines = [node.lineno for node in ast.walk(tree) if isinstance(node, ast.Constant) and node.value == text]
        if lines:
            return f"{_shown(path, folder)}:{min(lines)}"
    return ""


def found_text(error: BaseException) -> str:
    """Return what was found and what would be right, without the place."""
    if isinstance(error, InputError):
        return str(error)
    # What Python prints last, with its guess at a name that was meant.
    said = traceback.TracebackException.from_exception(error).format_exception_only()
    expected = next((text for kind, text in _EXPECTED.items() if isinstance(error, kind)), "no error")
    return f"found {' '.join(list(said)[-1].split())}; expected {expected}"


def _within(file: str | Path, folder: Path) -> bool:
    return Path(file).is_relative_to(folder) or Path(file).resolve().is_relative_to(folder)


def _shown(file: str | Path, folder: Path) -> str:
    """Return a path as a reader finds it: from where the command was run, else whole."""
    path = Path(file).resolve()
    here = Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else str(path)
