"""How a command ends: 0 done and true, 1 the answer is no, 2 wrong input or call, 3 the computation failed."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

import typer

from semispline.solver.errors import InputError, SemisplineError

ANSWER_IS_NO, WRONG_INPUT, FAILED = 1, 2, 3

_P = ParamSpec("_P")
_T = TypeVar("_T")


def reports_errors(command: Callable[_P, _T]) -> Callable[_P, _T]:
    """Let a command end with one line on standard error and its exit status where it raises an error of ours.

    Stands between `@app.command()` and the function, in every command line that mounts commands of this package.
    """

    @functools.wraps(command)
    def run(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        try:
            return command(*args, **kwargs)
        except SemisplineError as error:
            # A message may quote a path or a kernel that has line breaks in it.
            typer.echo(f"error: {' '.join(str(error).split())}", err=True)
            raise typer.Exit(WRONG_INPUT if isinstance(error, InputError) else FAILED) from None

    return run
