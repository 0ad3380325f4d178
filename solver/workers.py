"""Processes that work for this one: they end when it does, and have limits of processor time and memory of their own.

A worker watches a pipe whose other end only its parent holds; the pipe closes when the parent ends, however it ends.
What compiled code does inside one call (Open CASCADE holds the interpreter's lock all the while) no thread of Python
can stop, so the system does it:

- Linux: SIGKILL by the pipe (`F_SETSIG`, `O_ASYNC`), and by PR_SET_PDEATHSIG if the parent's main thread started the
  worker; RLIMIT_CPU ends it by SIGXCPU; RLIMIT_DATA limits its memory.
- macOS: a thread waits for the pipe, so that within a compiled call only RLIMIT_CPU ends a worker whose parent is gone;
  no limit of memory is kept.
- Windows: a thread waits for the pipe, and within a compiled call nothing ends a worker whose parent is gone; a parent
  ends a reader that takes too long by the clock; no limit of memory is kept.

Only Linux is tested.
"""

from __future__ import annotations

import importlib
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from enum import Enum
from math import ceil
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

from semispline.solver.errors import ComputationError, SemisplineError

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

_T = TypeVar("_T")

# A worker leaves with this status where Python itself ran out of memory; an unexpected exception leaves with 1.
_OUT_OF_MEMORY = 77
# Wall-clock time for each second of processor time, where the system does not limit the latter.
_PATIENCE = 4
# Whoever failed with this much of the memory in use failed for want of it.
_NEAR_LIMIT = 0.9
_PR_SET_PDEATHSIG = 1
# What compiled code does to its own process; any other signal came from outside.
_CRASHES = {"SIGSEGV", "SIGABRT", "SIGBUS", "SIGFPE", "SIGILL", "SIGTRAP", "SIGSYS"}


class End(Enum):
    """Why a worker ended without a result."""

    TIME = "time"
    MEMORY = "memory"
    CRASH = "crash"
    KILLED = "killed"
    FAULT = "fault"


class WorkerError(ComputationError):
    """A worker ended without a result; `end` says why, `detail` the signal or the exception."""

    def __init__(self, end: End, detail: str) -> None:
        super().__init__(end, detail)
        self.end = end
        self.detail = detail

    def __str__(self) -> str:
        return f"the process that worked on it ended without a result: {_SAID[self.end].format(self.detail)}"


_SAID = {
    End.TIME: "it reached its limit of processor time; give it less to do",
    End.MEMORY: "it reached its limit of memory; give it less to do",
    End.CRASH: "it broke down ({})",
    End.KILLED: "it was killed from outside ({}), as a system out of memory does; close other programs and try again",
    End.FAULT: "{}; this is a fault of semispline, please report it",
}


def call(module: str, arguments: Sequence[str], seconds: float, megabytes: float) -> Any:
    """Return what `work(*arguments)` of a module returns, called in a process of its own.

    What the process prints is dropped.

    Parameters
    ----------
    module : str
        Its function `work` returns what pickle can hand over. What the module imports takes time in every call.
    arguments : sequence of str
    seconds : float
        Processor time of the call; the import of the module does not count.
    megabytes : float

    Raises
    ------
    SemisplineError
        What `work` raised.
    WorkerError
        The process ended without a result.
    """
    # The worker finds its modules where this process does, and not in the folder that it is started in (-P). One thread
    # of BLAS: each takes memory, and a reader has no use for it.
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p), "OPENBLAS_NUM_THREADS": "1"}
    limits = [repr(float(seconds)), repr(float(megabytes)), str(int(_in_main_thread()))]
    command = [sys.executable, "-P", "-m", __name__, module, *limits, *arguments]
    watched, held = os.pipe()
    try:
        try:
            process = subprocess.Popen(
                command, env=environment, stdin=watched, stdout=subprocess.PIPE, stderr=subprocess.PIPE
            )
        except OSError as error:
            raise ComputationError(f"no process could be started: {error.strerror or error}; try again") from None
        finally:
            os.close(watched)
        with process:
            try:
                result, printed = process.communicate(timeout=None if resource else _PATIENCE * seconds)
            except subprocess.TimeoutExpired:
                process.kill()
                raise WorkerError(End.TIME, "") from None
            except BaseException:
                process.kill()
                # After Ctrl-C the block's end does not wait.
                process.wait()
                raise
    finally:
        os.close(held)
    if process.returncode:
        raise _error(process.returncode, printed.decode(errors="replace"))
    # Our own process wrote this.
    found = pickle.loads(result)
    if isinstance(found, SemisplineError):
        raise found
    return found


def in_pool(
    tasks: Sequence[Callable[[], _T]], processes: int, seconds: float, megabytes: float
) -> Generator[tuple[int, _T], None, None]:
    """Yield number and result of each task as it is done, by some processes; closed, it ends them.

    Parameters
    ----------
    tasks : sequence of callables
        What pickle can hand over.
    processes : int
    seconds : float
        Processor time for one task.
    megabytes : float
        Of one process.

    Raises
    ------
    WorkerError
        A process ended before its task.
    """
    # A fresh interpreter for each worker: forking a process with threads is not safe.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(
        max(1, min(processes, len(tasks))), context, initializer=_start_in_pool, initargs=(megabytes, _in_main_thread())
    )
    before = set(multiprocessing.active_children())
    workers: set[BaseProcess] = set()
    waiting: dict[Future[_T], int] = {}
    with pool:
        try:
            for number, task in enumerate(tasks):
                waiting[pool.submit(_limited, seconds, task)] = number
                # A task starts a process where none is idle.
                workers |= set(multiprocessing.active_children()) - before
            for done in as_completed(waiting):
                yield waiting[done], done.result()
        except BrokenProcessPool:
            # Its own thread waits for the processes: two that wait at once may lose a status.
            pool.shutdown(wait=True)
            # The pool ends the others with SIGTERM.
            statuses = [w.exitcode for w in workers if w.exitcode not in (None, 0, -signal.SIGTERM)]
            raise _error(statuses[0] or 0 if statuses else -signal.SIGTERM, "") from None
        finally:
            # Where a task failed or the caller stopped, none of the others is waited for.
            if not all(future.done() for future in waiting):
                for worker in workers:
                    worker.kill()


def _start_in_pool(megabytes: float, started_by_main_thread: bool) -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        _end_with_parent(parent.sentinel, lambda: wait([parent.sentinel]), started_by_main_thread)
    # Ctrl-C goes to the parent, which ends its workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _limit_memory(megabytes)


def _limited(seconds: float, task: Callable[[], _T]) -> _T:
    _limit_processor_time(seconds)
    return task()


def _error(status: int, printed: str) -> WorkerError:
    """Return the error for the status that a worker left with, and what it printed on standard error."""
    if status == _OUT_OF_MEMORY:
        return WorkerError(End.MEMORY, "")
    if 0 < status < 256:
        return WorkerError(End.FAULT, (printed.strip().splitlines() or [f"status {status}"])[-1])
    try:
        name = signal.Signals(-status).name
    except ValueError:
        # Windows gives a number of its own for an access violation and the like.
        return WorkerError(End.CRASH, f"status {status}")
    if name == "SIGXCPU":
        return WorkerError(End.TIME, "")
    return WorkerError(End.CRASH if name in _CRASHES else End.KILLED, name)


def _in_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()


def _end_with_parent(pipe: int, closed: Callable[[], object], started_by_main_thread: bool) -> None:
    """End this process when the other end of the pipe closes; `closed` waits for that."""
    if sys.platform == "linux":
        # Can wait: only workers need it, on this system alone.
        import ctypes
        import fcntl

        if started_by_main_thread:
            # It fires when the starting thread ends.
            ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        # Whoever emulates Linux may lack this: the thread is left.
        with suppress(OSError):
            fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
            fcntl.fcntl(pipe, fcntl.F_SETSIG, signal.SIGKILL)
            fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)

    def watch() -> None:
        closed()
        os._exit(0)

    # It also finds a parent that ended before the signal was asked for.
    threading.Thread(target=watch, daemon=True).start()


def _limit_memory(megabytes: float) -> None:
    if resource:
        _set_limit(resource.RLIMIT_DATA, int(megabytes * 2**20))
        # A kernel that breaks down leaves no core file in the user's folder.
        _set_limit(resource.RLIMIT_CORE, 0)


def _limit_processor_time(seconds: float) -> None:
    """Let this process be ended after some more seconds of processor time."""
    if resource:
        _set_limit(resource.RLIMIT_CPU, ceil(time.process_time() + seconds))


def _memory_taken() -> float:
    """Return the most memory that this program had in use so far, in megabytes, where the system limits it."""
    if sys.platform != "linux":
        return 0.0
    # Not `ru_maxrss`: Linux hands it on from the program that started this one.
    with open("/proc/self/status", encoding="ascii", errors="replace") as file:
        return next((float(line.split()[1]) / 1024 for line in file if line.startswith("VmHWM:")), 0.0)


def _set_limit(which: int, value: int) -> None:
    _, hard = resource.getrlimit(which)
    # A limit set from outside stays; macOS refuses some.
    with suppress(ValueError, OSError):
        resource.setrlimit(which, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))


@contextmanager
def _result_file() -> Iterator[Any]:
    """Give standard output as a file, of which what compiled code prints meanwhile is kept away."""
    with os.fdopen(os.dup(1), "wb") as file:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.close(nowhere)
        yield file


def _main(module: str, seconds: str, megabytes: str, started_by_main_thread: str, *arguments: str) -> None:
    _end_with_parent(0, lambda: os.read(0, 1), bool(int(started_by_main_thread)))
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    status = 0
    try:
        with _result_file() as file:
            work = importlib.import_module(module).work
            _limit_memory(float(megabytes))
            _limit_processor_time(float(seconds))
            try:
                found = work(*arguments)
            except SemisplineError as error:
                # Compiled code does not always say that memory was what it lacked.
                if _memory_taken() > _NEAR_LIMIT * float(megabytes):
                    raise MemoryError from None
                found = error
            pickle.dump(found, file, protocol=pickle.HIGHEST_PROTOCOL)
    except MemoryError:
        status = _OUT_OF_MEMORY
    except BaseException:
        traceback.print_exc()
        status = 1
    # Nothing is left to do: a kernel's way out has crashed after damaged files too.
    sys.stderr.flush()
    os._exit(status)


if __name__ == "__main__":
    _main(*sys.argv[1:])
