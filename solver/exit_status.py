"""How a command ends: 0 done and true, 1 the answer is no, 2 wrong input or call, 3 the computation failed.

As in a shell, 130 is Ctrl-C and 141 is a reader of our output that left.
"""

from __future__ import annotations

import functools
import os
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress
from typing import ParamSpec, TypeVar

import typer

from semispline.solver.errors import InputError, SemisplineError

ANSWER_IS_NO, WRONG_INPUT, FAILED, INTERRUPTED, NO_READER = 1, 2, 3, 130, 141

# Set to anything, it shows where an error was raised.
TRACEBACK = "SEMISPLINE_TRACEBACK"

_P = ParamSpec("_P")
_T = TypeVar("_T")


def reports_errors(command: Callable[_P, _T]) -> Callable[_P, _T]:
    """Let a command end with one line on standard error and its exit status, whatever it raises.

    Stands between `@app.command()` and the function, in every command line that mounts commands of this package.
    """

    @functools.wraps(command)
    def run(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        try:
            return command(*args, **kwargs)
        except typer.Exit:
            raise
        except BaseException as error:
            raise typer.Exit(_reported(error)) from None

    return run


def _reported(error: BaseException) -> int:
    """Print what a user needs to know of an error; return the exit status."""
    if os.environ.get(TRACEBACK):
        traceback.print_exception(error)
    if isinstance(error, BrokenPipeError):
        # Python would fail once more when it empties its buffer at the end.
        with suppress(OSError, ValueError, AttributeError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NO_READER
    if isinstance(error, KeyboardInterrupt):
        _print_line("interrupted")
        return INTERRUPTED
    if isinstance(error, SemisplineError):
        _print_line(f"error: {error}")
        return WRONG_INPUT if isinstance(error, InputError) else FAILED
    if isinstance(error, MemoryError):
        _print_line("error: out of memory; close other programs, or give smaller surfaces or fewer middle curves")
        return FAILED
    _print_line(
        f"error: {type(error).__name__}: {error}; this is a fault of semispline, please report it "
        f"({TRACEBACK}=1 in the environment shows where it comes from)"
    )
    return FAILED


def _print_line(text: str) -> None:
    # A message may quote a path or a kernel that has line breaks in it.
    with suppress(OSError, ValueError):
        typer.echo(" ".join(text.split()), err=True)
