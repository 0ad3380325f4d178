"""Which tests a mutant is shown: those that run its lines, found by coverage."""

from __future__ import annotations

import ast
import json
import re
import resource
import shutil
import time
from collections import defaultdict, deque
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import coverage
import pytest

from mutants.running import Job, Slot, run_all
from mutants.sites import Mutant

# Doctests of the solver count as tests of it.
TESTS = ("tests/solver", "semispline/solver")
QUICK = "not (compiler or browser or slow)"
_MEASURED = "solver"
_SECONDS_OF_A_FILE = 1800.0
_STATIC = re.compile(r" \((setup|call|teardown)\)$")


@dataclass(frozen=True)
class Table:
    """Processor time of each test that passes, tests by file and line, and what failed without any mutant."""

    seconds: dict[str, float]
    lines: dict[str, dict[int, set[str]]]
    failed: list[str]


def measure(root: Path, folder: Path, slots: list[Slot]) -> Table:
    """Run each test file once under coverage; a measure holds as long as the file and what it ran stay the same."""
    folder.mkdir(parents=True, exist_ok=True)
    queue: deque[Job] = deque()
    results = []
    for file in _test_files(root, folder, slots[0]):
        known = folder / f"{sha256(file.encode()).hexdigest()[:24]}.json"
        results.append(known)
        if not _holds(root, file, known):
            known.unlink(missing_ok=True)
            queue.append(
                Job(["--maxfail=1000", file, "-m", QUICK], _Measure(known), _SECONDS_OF_A_FILE, file, None, True)
            )
    count = len(queue)
    for done, (job, outcome) in enumerate(run_all(queue, slots), 1):
        print(f"coverage {done}/{count}: {job.subject}, {outcome.seconds:.0f} s, {outcome.status}", flush=True)
        path = job.plugin.path
        if not path.exists():
            print(f"{job.subject}: no coverage, so none of its tests takes part; see {folder.parent}/slot-*/log")
            continue
        found = json.loads(path.read_text())
        path.write_text(json.dumps({"rests_on": digest(root, [job.subject, *sorted(found["lines"])])} | found))
    return _joined([json.loads(path.read_text()) for path in results if path.exists()])


def _holds(root: Path, file: str, known: Path) -> bool:
    if not known.exists():
        return False
    found = json.loads(known.read_text())
    return bool(found.get("rests_on") == digest(root, [file, *sorted(found["lines"])]))


def _test_files(root: Path, folder: Path, slot: Slot) -> list[str]:
    path = folder / "collected.json"
    path.unlink(missing_ok=True)
    job = Job(["--collect-only", "-m", QUICK, *TESTS], _Collected(path), _SECONDS_OF_A_FILE, None, None, True)
    (_, outcome), *_ = run_all(deque([job]), [slot])
    if outcome.status != "passed" or not path.exists():
        raise SystemExit(f"the tests cannot be collected; see {slot.folder / 'log'}")
    return [file for file in json.loads(path.read_text()) if (root / file).exists()]


class _Collected:
    def __init__(self, path: Path) -> None:
        self.path = path

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self.path.write_text(json.dumps(sorted({item.nodeid.split("::")[0] for item in session.items})))


class _Measure:
    """Coverage by test, other processes that a test starts included."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.seconds: dict[str, float] = {}
        self.failed: set[str] = set()
        self.passed: set[str] = set()

    def pytest_sessionstart(self) -> None:
        # The child of the fork is here alone: nobody else's coverage is disturbed.
        self.folder = self.path.with_suffix("")
        # What an interrupted run left there has paths of another copy.
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir()
        settings = self.folder / "settings"
        settings.write_text(
            f"[run]\ndata_file = {self.folder / 'data'}\nparallel = true\ninclude = {Path.cwd() / _MEASURED}/*\n"
            "context = ${PYTEST_CURRENT_TEST-}\npatch = subprocess\n[report]\n"
        )
        self.coverage = coverage.Coverage(config_file=str(settings))
        self.coverage.start()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Iterator[None]:
        self.coverage.switch_context(item.nodeid)
        before = _processor_time()
        result = yield
        self.seconds[item.nodeid] = _processor_time() - before
        return result

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed:
            self.failed.add(report.nodeid)
        elif report.when == "call" and report.passed:
            self.passed.add(report.nodeid)

    def pytest_sessionfinish(self, exitstatus: int) -> None:
        self.coverage.stop()
        self.coverage.save()
        if exitstatus not in {0, 1}:  # tests passed, or some failed
            return
        self.coverage.combine()
        data = self.coverage.get_data()
        good = sorted(self.passed - self.failed)
        number = {test: i for i, test in enumerate(good)}
        lines: dict[str, dict[int, list[int]]] = {}
        for path in data.measured_files():
            of_file = lines[Path(path).relative_to(Path.cwd()).as_posix()] = {}
            for line, contexts in data.contexts_by_lineno(path).items():
                names = {_STATIC.sub("", c) for c in contexts}
                # What runs while tests are collected belongs to all of them.
                of_file[line] = sorted(range(len(good)) if "" in names else (number[n] for n in names if n in number))
        found = {"seconds": {t: self.seconds[t] for t in good}, "lines": lines, "failed": sorted(self.failed)}
        self.path.write_text(json.dumps(found))
        shutil.rmtree(self.folder)


def _processor_time() -> float:
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def _joined(parts: list[dict[str, Any]]) -> Table:
    seconds: dict[str, float] = {}
    lines: dict[str, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
    failed: list[str] = []
    for part in parts:
        seconds |= part["seconds"]
        failed += part["failed"]
        tests = list(part["seconds"])
        for file, of_file in part["lines"].items():
            for line, numbers in of_file.items():
                lines[file][int(line)] |= {tests[i] for i in numbers}
    return Table(seconds, lines, failed)


def chosen_for(mutant: Mutant, table: Table, root: Path, bound: float) -> list[str]:
    """Return the tests to show, most promising first: those of the file, of its room, and others.

    They take `bound` seconds together (one test at the least, and the file's own doctests always).
    """
    path = Path(mutant.file)
    room, doctests = f"tests/{path.parent.as_posix()}/", f"semispline/{mutant.file}"

    def rank(test: str) -> tuple[int, float]:
        is_of_file = test.startswith((f"{room}test_{path.stem}", doctests))
        return 0 if is_of_file else 1 if test.startswith(room) else 2, table.seconds[test]

    direct = _running(mutant, table, root)
    files = {test.split("::")[0] for test in direct}
    same_files = {test for test in table.seconds if test.split("::")[0] in files} - direct
    own = sorted((test for test in direct if rank(test)[0] == 0), key=rank)
    chosen: list[str] = []
    total = 0.0

    def choose(tests: list[str], most: float) -> None:
        nonlocal total
        for test in tests:
            if not chosen or total + table.seconds[test] <= most or test.startswith(doctests):
                chosen.append(test)
                total += table.seconds[test]

    # Long tests of its own do not leave out the quick ones of others.
    choose(own, bound / 2)
    choose([*sorted(direct - set(own), key=rank), *sorted(same_files, key=rank)], bound)
    choose([test for test in own if test not in chosen], bound)
    return chosen


def _running(mutant: Mutant, table: Table, root: Path) -> set[str]:
    """Return the tests that run the lines of the mutant, or those that use the names that it defines."""
    first, last = mutant.lines
    if first:
        return _at(table, mutant.file, first, last)
    found: set[str] = set()
    for name in mutant.names:
        for file, start, end in _uses(root, mutant.file, name):
            found |= _at(table, file, start, end)
    return found or _at(table, mutant.file, 1, 10**6)


def _at(table: Table, file: str, first: int, last: int) -> set[str]:
    return {t for line, tests in table.lines.get(file, {}).items() if first <= line <= last for t in tests}


@cache
def _uses(root: Path, file: str, name: str) -> list[tuple[str, int, int]]:
    """Return the statements of functions that use a module's name; those of names defined by it, too."""
    files = [file, *_importers(root, file, name)]
    found = []
    for path in files:
        for statement, is_inner, last, names in _statements(root / path):
            if name not in names:
                continue
            if is_inner:
                found.append((path, statement.lineno, last))
            elif isinstance(statement, ast.Assign | ast.AnnAssign):
                targets = getattr(statement, "targets", [getattr(statement, "target", None)])
                others = {t.id for t in targets if isinstance(t, ast.Name)} - {name}
                found += [use for other in sorted(others) for use in _uses(root, path, other)]
            else:
                found.append((path, 1, 10**6))
    return found


def _importers(root: Path, file: str, name: str) -> list[str]:
    """Return the other files that import a name from a file, or from its room's face."""
    if name.startswith("_"):
        return []
    module, paths = Path(file), [p.relative_to(root).as_posix() for p in _sources(root)]
    homes = {module.stem, module.parent.name}
    return [path for path in paths if path != file and homes & _imported(root / path).get(name, set())]


@cache
def _imported(path: Path) -> dict[str, set[str]]:
    """Return the last parts of the modules that each name is imported from."""
    found: dict[str, set[str]] = defaultdict(set)
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                found[alias.name].add(node.module.rpartition(".")[2])
    return found


@cache
def _sources(root: Path) -> list[Path]:
    return sorted((root / _MEASURED).rglob("*.py"))


@cache
def _statements(path: Path) -> list[tuple[Any, bool, int, set[str]]]:
    """Statements of a file, whether a function holds them, their last line without a body, and the names used there."""
    found: list[tuple[Any, bool, int, set[str]]] = []

    def visit(node: ast.AST, is_inner: bool) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.stmt):
                body = getattr(child, "body", None)
                last = body[0].lineno - 1 if body else child.end_lineno or 0
                loaded = [x for x in ast.walk(child) if isinstance(getattr(x, "ctx", None), ast.Load)]
                names = {getattr(x, "id", getattr(x, "attr", "")) for x in loaded if getattr(x, "lineno", 0) <= last}
                found.append((child, is_inner, last, names))
            visit(child, is_inner or isinstance(child, ast.FunctionDef))

    visit(ast.parse(path.read_bytes()), False)
    return found


@cache
def texts_of_tests(path: Path) -> dict[str, str]:
    """Return the code of the functions of a test file by their names, and its docstrings under no name."""
    tree = ast.parse(path.read_bytes())
    texts: dict[str, str] = defaultdict(str)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            texts[node.name] += ast.unparse(node)
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Module):
            texts[""] += ast.get_docstring(node) or ""
    return texts


def digest_of_test(root: Path, test: str) -> str:
    """Return a hash of a test's name and code; of a doctest, of the docstrings of its file."""
    file, _, name = test.partition("::")
    path = root / file
    texts = texts_of_tests(path) if path.is_file() else {}
    text = texts.get(name.partition("[")[0].rpartition("::")[2], texts.get("", ""))
    return sha256(f"{test}\0{text}".encode()).hexdigest()[:8]


def digest(root: Path, files: list[str]) -> str:
    """Return a hash of the files' contents."""
    total = sha256()
    for file in files:
        path = root / file
        total.update(file.encode() + b"\0" + (path.read_bytes() if path.is_file() else b"") + b"\0")
    return total.hexdigest()[:16]
