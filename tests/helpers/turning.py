"""Work that does not end, for tests of what ends it."""

import os
import re
import signal
import sys
import time
from pathlib import Path

from semispline.solver.errors import FileError


def hold_the_lock():
    """Turn for years inside one call of compiled code that holds the lock of the interpreter, as Open CASCADE does."""
    re.match(r"(a+)+$", "a" * 64 + "b")


def work(what, *more):
    """Be the worker of `semispline.solver.workers.call`."""
    if more:
        Path(more[0]).write_text(str(os.getpid()))
    return TASKS[what]()


def fill_memory():
    found = []
    while True:
        found.append(bytearray(2**24))


def refuse():
    raise FileError("bad file")


def run_out():
    found = []
    try:
        while True:
            found.append(bytearray(2**24))
    except MemoryError:
        raise FileError("says something else") from None


def print_and_return():
    os.write(1, b"noise")
    sys.stdout.write("more noise")
    return {"numbers": list(range(100000))}


def end_by(number):
    os.kill(os.getpid(), number)
    time.sleep(60)


TASKS = {
    "turn": hold_the_lock,
    "fill": fill_memory,
    "refuse": refuse,
    "run out": run_out,
    "print": print_and_return,
    "fault": lambda: 1 / 0,
    "exit": lambda: sys.exit(0),
    "segmentation fault": lambda: end_by(signal.SIGSEGV),
    "kill": lambda: end_by(signal.SIGKILL),
    "terminate": lambda: end_by(signal.SIGTERM),
}
