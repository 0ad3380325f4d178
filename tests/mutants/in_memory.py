"""Mutants in the memory of a process that holds the collected tests: a fork for each, and no import.

Functions get the code and the defaults of the broken file, names of its module and of its classes the values. What this
does not reach (values that other modules made of these, tests that were parametrised by what broke) a process of its
own decides. The broken file is in the tree as well, for processes that a test starts.
"""

from __future__ import annotations

import os
import sys
import types
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from multiprocessing import Pipe, connection
from pathlib import Path
from typing import Any

import pytest

from mutants.running import UNTOUCHED, Job, Outcome, Slot, confine, end_with_parent, enter, pytest_words, run_all

_PLAIN = (bool, int, float, complex, str, bytes, tuple, list, dict, set, frozenset)


class Host:
    """A process that has collected the tests and runs those of one job at a time."""

    def __init__(self, slot: Slot, files: list[str], words: Sequence[str]) -> None:
        self.job: Job | None = None
        self.pipe, other = Pipe()
        sys.stdout.flush()
        self.pid = os.fork()
        if self.pid == 0:
            try:
                self.pipe.close()
                end_with_parent()
                enter(slot)
                collecting = os.open(slot.folder / "host", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
                os.dup2(collecting, 1)
                os.dup2(collecting, 2)
                pytest.main([*pytest_words(slot), *words, *files], plugins=[slot.watch(), _Serving(slot, other)])
            finally:
                os._exit(0)
        other.close()

    def end(self) -> None:
        """Say that there is nothing left to do."""
        self.pipe.send(None)
        os.waitpid(self.pid, 0)


def run_in_memory(queue: deque[Job], hosts: list[Host]) -> Iterator[tuple[Job, Outcome]]:
    """Run the jobs; whoever takes the outcomes may add further jobs to the queue in between."""
    while queue or any(host.job for host in hosts):
        for host in hosts:
            if host.job is None and queue:
                host.job = queue.popleft()
                host.pipe.send((host.job.words, host.job.seconds, host.job.change))
        ready = connection.wait([host.pipe for host in hosts if host.job])
        for host in [h for h in hosts if h.pipe in ready]:
            job, host.job = host.job, None
            assert job is not None
            try:
                outcome = host.pipe.recv()
            except (EOFError, ConnectionResetError):
                raise SystemExit("the tests cannot be collected; see build/mutants/slot-*/host") from None
            yield job, outcome


class _Serving:
    """Instead of a run of all the tests: those that are asked for, job by job.

    A red test counts if it is green without the change, and a file that cannot be read if the unbroken one can.
    """

    def __init__(self, slot: Slot, pipe: Any) -> None:
        self.slot, self.pipe = slot, pipe
        self.green: set[str] = set()
        self.red: set[str] = set()

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        self.items = {item.nodeid: item for item in session.items}
        import_all(self.slot.tree)
        while (asked := self.pipe.recv()) is not None:
            self.pipe.send(self.outcome(*asked))
        return True

    def outcome(self, tests: list[str], seconds: float, change: tuple[str, bytes]) -> Outcome:
        while True:
            found = self.run([t for t in tests if t in self.items and t not in self.red], seconds, change)
            if found.status != "failed" or found.failed in self.green:
                return found
            if not found.failed:
                unbroken = change[0], (self.slot.tree / change[0]).read_bytes()
                is_read = self.run([], seconds, unbroken).status == "untouched"
                return found if is_read else Outcome("untouched", "", found.seconds)
            passes = self.run([found.failed], seconds, None).status == "passed"
            (self.green if passes else self.red).add(found.failed)

    def run(self, tests: list[str], seconds: float, change: tuple[str, bytes] | None) -> Outcome:
        job = Job(tests, None, seconds, None, change)
        ((_, outcome),) = run_all(deque([job]), [self.slot], self.in_child)
        return outcome

    def in_child(self, slot: Slot, job: Job) -> int:
        confine(slot, job)
        if job.change and not break_in_memory(slot.tree / job.change[0], job.change[1]):
            return UNTOUCHED
        items = [self.items[test] for test in job.words]
        for item, following in zip(items, [*items[1:], None], strict=True):
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if slot.failed.exists():
                return 1
        return 0


def import_all(tree: Path) -> None:
    """Import every module of the tree, so that a mutant finds it here; a test says what cannot be imported."""
    for path in sorted((tree / "semispline/solver").rglob("*.py")):
        name = ".".join(path.relative_to(tree).with_suffix("").parts).removesuffix(".__init__")
        with suppress(Exception):
            __import__(name)


def break_in_memory(path: Path, source: bytes) -> bool:
    """Give what is loaded of a file the code and the values of another source; say whether anything differs."""
    target = path.resolve()
    changed = False
    for name, module in list(sys.modules.items()):
        if (file := getattr(module, "__file__", None)) and Path(file).resolve() == target:
            fresh = types.ModuleType(name)
            fresh.__dict__.update({k: getattr(module, k, None) for k in ("__file__", "__package__", "__path__")})
            sys.modules[name] = fresh  # dataclasses look here
            try:
                exec(compile(source, file, "exec", dont_inherit=True), fresh.__dict__)
            finally:
                sys.modules[name] = module
            changed |= _renew(module, fresh, name) | _rename(module, fresh)
    if changed:
        _forget()
    return changed


def _renew(live: Any, fresh: Any, name: str) -> bool:
    """Renew the functions of a module or a class, and the plain values of a class."""
    changed = False
    for key, new in list(vars(fresh).items()):
        old = vars(live).get(key)
        if isinstance(new, type) and isinstance(old, type):
            changed |= new.__module__ == name and _renew(old, new, name)
        elif (f := _function(old)) and (g := _function(new)) and g.__module__ == name:
            changed |= _renew_function(f, g)
        elif isinstance(live, type) and not key.startswith("__") and _differ(old, new):
            setattr(live, key, new)
            changed = True
    return changed


def _renew_function(live: types.FunctionType, fresh: types.FunctionType) -> bool:
    changed = live.__code__ != fresh.__code__
    if changed:
        live.__code__ = fresh.__code__
    for part in ("__defaults__", "__kwdefaults__"):
        if _differ(getattr(live, part), getattr(fresh, part)):
            setattr(live, part, getattr(fresh, part))
            changed = True
    return changed


def _function(x: Any) -> types.FunctionType | None:
    """Return the function inside a method, a property, or a cache."""
    if isinstance(x, staticmethod | classmethod):
        x = x.__func__
    elif isinstance(x, property):
        x = x.fget
    elif isinstance(x, cached_property):
        x = x.func
    while hasattr(x, "__wrapped__"):
        x = x.__wrapped__
    return x if isinstance(x, types.FunctionType) else None


def _differ(old: Any, new: Any) -> bool:
    """Say whether two values differ, as far as plain ones can be told apart."""
    return _is_plain(old) and _is_plain(new) and repr(old) != repr(new)


def _is_plain(x: Any) -> bool:
    is_array = type(x).__module__ == "numpy"
    return x is None or ((isinstance(x, _PLAIN) or is_array) and " at 0x" not in repr(x))


def _rename(live: types.ModuleType, fresh: types.ModuleType) -> bool:
    """Give the names of a module new values, here and where they were imported."""
    changed = False
    for key, new in vars(fresh).items():
        old = vars(live).get(key)
        if key.startswith("__") or not _differ(old, new):
            continue
        for module in list(sys.modules.values()):
            if isinstance(module, types.ModuleType) and vars(module).get(key) is old:
                setattr(module, key, new)
        changed = True
    return changed


def _forget() -> None:
    """Empty the caches of our functions."""
    for name, module in list(sys.modules.items()):
        if name.startswith("semispline."):
            for value in list(vars(module).values()):
                if hasattr(value, "cache_clear"):
                    value.cache_clear()
