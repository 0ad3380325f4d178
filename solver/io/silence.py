"""Keeping compiled libraries from printing on our standard output."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress


@contextmanager
def silenced(*descriptors: int) -> Iterator[None]:
    """Send what the process prints on the file descriptors (1 if none is given) to nowhere.

    The IGES and STEP translators of Open CASCADE print from C++, past `sys.stdout`; only the descriptor itself
    stops them. It belongs to the whole process: what other threads print meanwhile is lost too.
    """
    with ExitStack() as stack:
        _flush()
        nowhere = os.open(os.devnull, os.O_WRONLY)
        stack.callback(os.close, nowhere)
        for descriptor in descriptors or (1,):
            # A closed descriptor has nothing to silence.
            with suppress(OSError):
                saved = os.dup(descriptor)
                stack.callback(os.close, saved)
                os.dup2(nowhere, descriptor)
                stack.callback(os.dup2, saved, descriptor)
        # C buffers its output into a pipe: empty the buffer before the descriptor is given back.
        stack.callback(_flush)
        yield


def _flush() -> None:
    for stream in (sys.stdout, sys.stderr):
        # None without a console; ValueError once closed.
        with suppress(AttributeError, ValueError, OSError):
            stream.flush()
    with suppress(OSError, AttributeError):
        ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)
