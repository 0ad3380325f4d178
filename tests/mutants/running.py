"""Runs of pytest in forks of this process, a few at a time, each in a copy of the tree of its own."""

from __future__ import annotations

import contextlib
import ctypes
import fcntl
import importlib
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import traceback
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import pytest

# Loaded once, before the forks.
_LIBRARIES = (
    "numpy", "scipy.interpolate", "scipy.optimize", "scipy.sparse.linalg", "scipy.integrate", "casadi", "flint",
    "hypothesis.strategies", "hypothesis.extra.numpy", "geomdl.NURBS", "splipy", "typer.testing", "rich.console",
    "pydantic", "matplotlib.pyplot", "PIL.Image", "lazy_loader",
)  # fmt: skip
_MEMORY = 8 << 30
# The clock ends only what waits for something that never comes, and then nothing is decided.
_PATIENCE = 20
# By this exit status a child says that it could not do what was to be changed.
UNTOUCHED = 100


@dataclass
class Job:
    """Words for pytest, a plugin for it, the processor time that it may take, and a change of one file."""

    words: Sequence[str]
    plugin: Any
    seconds: float
    subject: Any = None
    change: tuple[str, bytes] | None = None
    writes_bytecode: bool = False


@dataclass(frozen=True)
class Outcome:
    """How a run ended: "passed", "failed", "timeout", "stuck" or "untouched"; what failed first; processor time."""

    status: str
    failed: str
    seconds: float


@dataclass
class Slot:
    """A copy of the tree, and what runs in it."""

    folder: Path
    job: Job | None = None
    pid: int = 0
    started: float = 0.0
    original: tuple[Path, bytes, int] | None = field(default=None, repr=False)
    lock: IO[str] | None = None

    @property
    def tree(self) -> Path:
        """The copy."""
        return self.folder / "tree"

    @property
    def failed(self) -> Path:
        """Where the name of what failed first is written down."""
        return self.folder / "failed"

    def watch(self) -> Watch:
        """Return the plugin that writes it."""
        return Watch(self.failed)


def load_libraries() -> None:
    """Import what is slow to import and not ours."""
    for name in _LIBRARIES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)


def make_slots(root: Path, folder: Path, count: int) -> list[Slot]:
    """Copy what git knows or would add, links as links, `count` times."""
    words = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(words, cwd=root, capture_output=True, check=True).stdout.decode().split("\0")
    slots = [Slot(folder / f"slot-{i}") for i in range(count)]
    folder.mkdir(parents=True, exist_ok=True)
    lock = (folder / "lock").open("w")  # held as long as the slots are
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise SystemExit(f"{folder}: another run is at work here") from None
    slots[0].lock = lock
    for slot in slots:
        shutil.rmtree(slot.folder, ignore_errors=True)
        for name in filter(None, names):
            source, target = root / name, slot.tree / name
            if source.is_symlink() or source.exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, target, follow_symlinks=False)
    return slots


Child = Callable[[Slot, Job], int]


def run_all(queue: deque[Job], slots: list[Slot], child: Child | None = None) -> Iterator[tuple[Job, Outcome]]:
    """Run the jobs; whoever takes the outcomes may add further jobs to the queue in between."""
    try:
        while queue or any(slot.job for slot in slots):
            for slot in slots:
                if slot.job is None and queue:
                    _start(slot, queue.popleft(), child or _new_pytest)
            time.sleep(0.02 if child is None else 0.002)
            for slot in slots:
                if slot.job and (outcome := _ended(slot)):
                    job, slot.job = slot.job, None
                    yield job, outcome
    finally:
        for slot in slots:
            if slot.job:
                _kill(slot)
                os.waitpid(slot.pid, 0)


def _start(slot: Slot, job: Job, child: Child) -> None:
    if job.change:
        path = slot.tree / job.change[0]
        stat = path.stat()
        slot.original = path, path.read_bytes(), stat.st_mtime_ns
        path.write_bytes(job.change[1])
        # No file of bytecode fits this time.
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns + 3600 * 10**9))
    slot.failed.unlink(missing_ok=True)
    slot.job, slot.started = job, time.monotonic()
    sys.stdout.flush()
    slot.pid = os.fork()
    if slot.pid == 0:
        code = 3
        try:
            code = child(slot, job)
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)


def end_with_parent() -> None:
    """Let the system end this process when its parent ends."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


def confine(slot: Slot, job: Job) -> None:
    """Give this process, a child, a group and a log of its own, and limits."""
    # No session of its own: on Linux the priority of the run (its autogroup's) would not hold for it.
    os.setpgid(0, 0)
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    limit = int(job.seconds) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    log = os.open(slot.folder / "log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)


def enter(slot: Slot, *, writes_bytecode: bool = False) -> None:
    """Let this process, a child, import what is ours from the copy."""
    os.chdir(slot.tree)
    sys.path[:] = [str(slot.tree), *(p for p in sys.path if p and not _is_ours(Path(p)))]
    os.environ["PYTHONPATH"] = str(slot.tree)
    os.environ.pop("PYTEST_CURRENT_TEST", None)  # of a test that tests this tool
    if not writes_bytecode:
        sys.dont_write_bytecode = True
        os.environ["PYTHONDONTWRITEBYTECODE"] = "1"


def pytest_words(slot: Slot) -> list[str]:
    """Return the words that every run of pytest gets."""
    # The libraries are loaded already, so pytest cannot rewrite the asserts of its plugins.
    words = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-W", "ignore::pytest.PytestAssertRewriteWarning"]
    return [*words, f"--basetemp={slot.folder / 'temporary'}"]


def _new_pytest(slot: Slot, job: Job) -> int:
    confine(slot, job)
    enter(slot, writes_bytecode=job.writes_bytecode)
    plugins = [p for p in (slot.watch(), job.plugin) if p]
    code = int(pytest.main([*pytest_words(slot), "-x", *job.words], plugins=plugins))
    ours = sys.modules.get("semispline")
    if code == 0 and ours and not Path(str(ours.__file__)).is_relative_to(slot.tree):
        raise RuntimeError(f"{ours.__file__} was tested, expected a file of {slot.tree}")
    return code


def _is_ours(path: Path) -> bool:
    root = Path(__file__).resolve().parents[2]
    return path.resolve() in {root, root / "tests"}


class Watch:
    """Writes down what failed first. How slow a machine is makes nothing red."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def pytest_collection(self) -> None:
        from hypothesis import HealthCheck, settings

        settings.register_profile("mutants", parent=settings(), suppress_health_check=[HealthCheck.too_slow])
        settings.load_profile("mutants")

    def pytest_collectreport(self, report: Any) -> None:
        self.pytest_runtest_logreport(report)

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed and not self.path.exists():
            self.path.write_text(report.nodeid)


def _ended(slot: Slot) -> Outcome | None:
    assert slot.job is not None
    pid, status, usage = os.wait4(slot.pid, os.WNOHANG)
    stuck = not pid and time.monotonic() - slot.started > 600 + _PATIENCE * slot.job.seconds
    if not pid and not stuck:
        return None
    _kill(slot)
    if stuck:
        _, status, usage = os.wait4(slot.pid, 0)
    if slot.original:
        path, content, mtime = slot.original
        path.write_bytes(content)
        os.utime(path, ns=(mtime, mtime))
        slot.original = None
    failed = slot.failed.read_text() if slot.failed.exists() else ""
    seconds = usage.ru_utime + usage.ru_stime
    if stuck:
        return Outcome("stuck", failed, seconds)
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) in {signal.SIGXCPU, signal.SIGKILL}:
        return Outcome("timeout", failed, seconds)
    if os.WIFEXITED(status) and os.WEXITSTATUS(status) == UNTOUCHED:
        return Outcome("untouched", failed, seconds)
    return Outcome("failed" if status else "passed", failed, seconds)


def _kill(slot: Slot) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(slot.pid, signal.SIGKILL)
