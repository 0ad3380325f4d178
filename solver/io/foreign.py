"""Files of other programs are read by a process of their own, with limits that fit the size of the file.

On a damaged file Open CASCADE may run into a segmentation fault or an endless loop, and openNURBS asks for gigabytes
where one byte is wrong. A process of its own turns that into a message; it hands over plain arrays.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from semispline.solver.errors import ComputationError, FileError
from semispline.solver.io.disk import require_file
from semispline.solver.workers import End, WorkerError, call

# Open CASCADE reads some megabytes a minute at the slowest, and takes some bytes of memory for each of the file.
_SECONDS, _BYTES_PER_SECOND = 5.0, 20_000
_MEGABYTES, _BYTES_PER_BYTE = 1024, 64


def limits(path: str | Path) -> tuple[float, float]:
    """Return seconds of processor time, and megabytes of memory, within which the file has to be read."""
    size = Path(path).stat().st_size
    return round(_SECONDS + size / _BYTES_PER_SECOND), round(_MEGABYTES + size * _BYTES_PER_BYTE / 2**20)


def read_apart(path: str | Path, module: str, kernel: str, more: Iterable[str] = (), times: float = 1.0) -> Any:
    """Return what `work(path, *more)` of a module returns, called in a process of its own.

    Where it does more than read, its limit of time is so many `times` that of reading.

    Raises
    ------
    FileError
        Missing, or `kernel` cannot read it, breaks down, or needs more than the limits.
    ComputationError
        The process was killed from outside, or failed through a fault of ours: the file may be good.
    """
    require_file(path)
    seconds, megabytes = limits(path)
    seconds *= times
    try:
        return call(module, [str(path), *more], seconds, megabytes)
    except WorkerError as error:
        size = Path(path).stat().st_size
        damaged = "the file is damaged or too complex; export it anew"
        if error.end is End.TIME:
            message = f"{kernel} needed more than {seconds:.0f} s of processor time for {size} bytes; {damaged}"
        elif error.end is End.MEMORY:
            message = f"{kernel} needed more than {megabytes:.0f} MB of memory for {size} bytes; {damaged}"
        elif error.end is End.CRASH:
            message = (
                f"{kernel} broke down while reading it ({error.detail}); the file is damaged, or needs more than "
                f"{megabytes:.0f} MB of memory; export it anew"
            )
        else:
            raise ComputationError(f"{path}: {error}") from None
        raise FileError(f"{path}: {message}") from None
