"""The tool that breaks the solver: what it finds to break, and its verdicts on a small project of our own."""

import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from mutants.choice import Table, chosen_for, digest_of_test, texts_of_tests
from mutants.in_memory import break_in_memory
from mutants.records import Record, basis, is_to_confirm, still_to_show
from mutants.sites import mutants_of

TOOL = Path(__file__).parent


def changes(source, *, complete):
    return {m.change for m in mutants_of("f.py", source.encode()) if m.complete == complete}


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("LIMIT = 1e-9", {"1e-9 -> (1e-9 * 1000)", "1e-9 -> (1e-9 / 1000)"}),
        ("MOST = 20", {"20 -> 2", "20 -> 200"}),
        ("MOST, FEW = 20, 2", {"20 -> 2", "20 -> 200", "2 -> 3", "2 -> (1)", "2 -> 20"}),
        ("TABLE = {2: ((1, 1),)}", set()),
        ("GRID, FINER = (40, 30), (4, 3)", set()),
        ("LIMITS = {'gap': (1e-6, 1e-5)}", {f"1e-{n} -> (1e-{n} {by} 1000)" for n in (5, 6) for by in "*/"}),
        ("def f(x): return x < y", {"< -> <=", "< -> >="}),
        ("def f(x): return x == 2", set()),
        ("def f(x): return 0 <= (x)", {"<= -> <", "<= -> >", "0 -> 1", "0 -> (-1)"}),
        ("def f(x): return np.abs(x).max()", set()),
        ("def f(x): return max(x, LEAST)", {"max -> min"}),
        ("def f(x): return np.minimum(x, y.limit)", {"minimum -> maximum"}),
        ("def f(x): return a and b or not c", set()),
        ("def f(x, most=3): pass", {"3 -> 4", "3 -> (2)"}),
        ("def f(x): return g(x, tol=0.5)", {"0.5 -> (0.5 * 1000)", "0.5 -> (0.5 / 1000)"}),
        ("def f(x): return x + 1e-14", {"1e-14 -> (1e-14 * 1000)", "1e-14 -> (1e-14 / 1000)"}),
        ("def f(x): rounding = 8.0 * x", {"8.0 -> (8.0 * 1000)", "8.0 -> (8.0 / 1000)"}),
        ("def f(x): return x is None", set()),
        ("def f(x: 'a < b'): raise E(f'{x < 1}', x < 1)", set()),
    ],
)
def test_limits_and_their_comparisons_are_complete(source, expected):
    assert changes(source, complete=True) == expected


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("def f(x): return x + 2", {"return x + 2 -> return None", "+ -> -", "2 -> 3"}),
        ("def f(x): return x[0:-1]", {"return x[0:-1] -> return None", "0 -> 1", "- -> ", "1 -> 2"}),
        ("def f(x): g(x)", {"g(x) -> pass"}),
        ("def f(x): x -= 0.5", {"x -= 0.5 -> pass", "- -> +", "0.5 -> (0.5 * 2)"}),
        ("def f(x): raise E(1)", {"raise E(1) -> pass"}),
        ("def f(x): return x is None", {"return x is None -> return None", "is -> is not"}),
        ("def f(x): return x == 2", {"return x == 2 -> return None", "== -> !=", "2 -> 3"}),
        ("def f(x): return np.abs(x).max()", {"return np.abs(x).max() -> return None", "np.abs -> ", "max -> min"}),
        ("def f(x): return a & ~b", {"return a & ~b -> return None", "& -> |", "~ -> "}),
        ("def f(x): g.y = a and b or not c", {"g.y = a and b or not c -> pass", "and -> or", "or -> and", "not -> "}),
        ("def f(x):\n  if x: g.y = True", {"x -> (not (x))", "g.y = True -> pass", "True -> False"}),
    ],
)
def test_the_rest_is_words_kinds_arithmetic_numbers_results_and_statements(source, expected):
    assert changes(source, complete=False) == expected


def test_a_mutant_changes_one_place_and_keeps_its_key_when_other_lines_move():
    source = b"def f(x):\n    return x < 1 or x < 1\n"
    first, second = [m for m in mutants_of("f.py", source) if m.change == "< -> <="]
    assert first.apply(source) == b"def f(x):\n    return x <= 1 or x < 1\n"
    assert second.apply(source) == b"def f(x):\n    return x < 1 or x <= 1\n"
    assert first.key != second.key
    moved = [m.key for m in mutants_of("f.py", b"import os\n\n" + source) if m.change == "< -> <="]
    assert moved == [first.key, second.key]


def test_the_tests_of_a_file_come_first_then_those_of_its_room_and_its_doctest_is_never_left_out():
    (mutant,) = mutants_of("solver/judge/gauge.py", b"def f(x):\n    x.y = a\n")
    seconds = {
        "tests/solver/io/test_read.py::test_quick": 0.1,
        "tests/solver/judge/test_other.py::test_quick": 0.2,
        "tests/solver/judge/test_gauge_limits.py::test_slow": 9.0,
        "tests/solver/judge/test_gauge.py::test_quick": 0.5,
        "semispline/solver/judge/gauge.py::semispline.solver.judge.gauge.f": 1.5,
        "tests/solver/judge/test_gauge.py::test_of_another_line": 0.1,
    }
    *direct, _ = seconds
    table = Table(seconds, {"solver/judge/gauge.py": {2: set(direct)}}, [])
    other, near, slow, quick, doctest, beside = seconds
    assert chosen_for(mutant, table, Path(), 100.0) == [quick, doctest, slow, near, other, beside]
    assert chosen_for(mutant, table, Path(), 1.0) == [quick, doctest]
    # Half of the time is for others, and what is left of it for its own.
    assert chosen_for(mutant, table, Path(), 12.0) == [quick, doctest, near, other, beside, slow]


def test_a_name_of_another_file_is_another_name(tmp_path):
    files = {
        "judge/gauge.py": "LIMIT = 1e-9\n",
        "judge/other.py": "LIMIT = 1e-6\ndef f(x):\n    return x < LIMIT\n",
        "judge/near.py": "from semispline.solver.judge.gauge import LIMIT\ndef f(x):\n    return x < LIMIT\n",
        "io/far.py": "from semispline.solver.judge import LIMIT\ndef f(x):\n    return x < LIMIT\n",
        "io/else.py": "from semispline.solver.judge.other import LIMIT\ndef f(x):\n    return x < LIMIT\n",
    }
    for name, text in files.items():
        path = tmp_path / "solver" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    mutant, _ = mutants_of("solver/judge/gauge.py", files["judge/gauge.py"].encode())
    lines = {f"solver/{name}": {3: {f"tests/test.py::test_{name}"}} for name in files}
    table = Table({test: 0.1 for by_line in lines.values() for tests in by_line.values() for test in tests}, lines, [])
    table.lines["solver/judge/gauge.py"].clear()
    shown = chosen_for(mutant, table, tmp_path, 0.2)
    assert set(shown) == {"tests/test.py::test_judge/near.py", "tests/test.py::test_io/far.py"}


def test_a_survivor_is_shown_what_is_new_and_a_killed_one_rests_on_its_function_and_its_killer(tmp_path):
    tests = tmp_path / "test_f.py"
    tests.write_text("def test_a():\n    assert f(1)\n\n\ndef test_b():\n    assert f(2)\n")
    names = [f"test_f.py::test_{letter}" for letter in "abc"]
    mutant, *_ = mutants_of("f.py", b"def f(x):\n    return x < 1  # why\n\n\ndef g(x): pass\n")
    (moved, *_), (other, *_) = (
        mutants_of("f.py", source) for source in (b"A = B\ndef f(x):\n    return x < 1", b"def f(x):\n    return x < 2")
    )
    shown = tuple(digest_of_test(tmp_path, name) for name in names[:2])
    survived = Record("survived", "", 2, 0.1, basis(tmp_path, mutant, ""), shown)
    assert still_to_show(tmp_path, moved, survived, names[:2]) is None
    assert still_to_show(tmp_path, moved, survived, names) == names[2:]
    assert still_to_show(tmp_path, other, survived, names[:2]) == names[:2]
    killed = Record("killed", names[0], 2, 0.1, basis(tmp_path, mutant, names[0]))
    assert still_to_show(tmp_path, moved, killed, names) is None
    assert still_to_show(tmp_path, other, killed, names) == names
    assert still_to_show(tmp_path, mutant, Record("undecided", "", 2, 0.1, survived.rests_on), names) == names
    untouched = Record("untouched", "", 2, 0.1, survived.rests_on)
    assert still_to_show(tmp_path, mutant, untouched, names) is None
    alive = Record("alive", "", 2, 0.1, survived.rests_on, shown)
    assert still_to_show(tmp_path, mutant, alive, names) == names[2:]
    # Who is alive for a reason needs no process of its own; whom the quick way did not break needs one.
    assert [is_to_confirm(alive, explained=e) for e in (True, False)] == [False, True]
    assert [is_to_confirm(untouched, explained=e) for e in (True, False)] == [True, True]
    assert not any(is_to_confirm(r, explained=False) for r in (killed, survived, None))
    tests.write_text("def test_a():\n    assert f(3)\n\n\ndef test_b():\n    assert f(2)\n")
    texts_of_tests.cache_clear()
    assert still_to_show(tmp_path, mutant, killed, names) == names
    assert still_to_show(tmp_path, mutant, survived, names[:2]) == names[:1]


LOADED = """
from dataclasses import dataclass
from functools import cache, cached_property

LIMIT = 2.0
TWICE = (2 * LIMIT, LIMIT)
UNSEEN = object()


def plain(x, most=3, *, least=1):
    return x < 1, most, least


@cache
def cached():
    return LIMIT


@dataclass(frozen=True)
class Thing:
    size: float = 5.0

    def method(self):
        return self.size + 6

    @property
    def asked(self):
        return 7

    @cached_property
    def kept(self):
        return 8

    @staticmethod
    def static():
        return 9
"""


@pytest.fixture
def loaded(tmp_path, monkeypatch):
    """A module under a name of ours, and another one that has imported from it."""
    path = tmp_path / "loaded.py"
    path.write_text(LOADED)
    module, user = ModuleType("semispline.loaded"), ModuleType("user")
    module.__file__ = str(path)
    for m in (module, user):
        monkeypatch.setitem(sys.modules, m.__name__, m)
    exec(compile(LOADED, path, "exec"), module.__dict__)
    exec("from semispline.loaded import *; a_thing = Thing(5.0)", user.__dict__)
    return path, user


@pytest.mark.parametrize(
    ("old", "new", "asked", "expected"),
    [
        ("x < 1", "x <= 1", "plain(1)", (True, 3, 1)),
        ("most=3", "most=4", "plain(1)", (False, 4, 1)),
        ("least=1", "least=2", "plain(1)", (False, 3, 2)),
        ("LIMIT = 2.0", "LIMIT = 3.0", "LIMIT, TWICE, cached()", (3.0, (6.0, 3.0), 3.0)),
        ("size: float = 5.0", "size: float = 6.0", "Thing().size", 6.0),
        ("self.size + 6", "self.size - 6", "a_thing.method()", -1.0),
        ("return 7", "return 8", "a_thing.asked", 8),
        ("return 8", "return 9", "a_thing.kept", 9),
        ("return 9", "return None", "Thing.static()", None),
    ],
)
def test_what_is_loaded_changes_in_memory_wherever_it_was_imported(loaded, old, new, asked, expected):
    path, user = loaded
    assert eval(asked, user.__dict__) != expected
    vars(user.a_thing).pop("kept", None)
    assert LOADED.count(old) == 1
    assert break_in_memory(path, LOADED.replace(old, new).encode())
    assert eval(asked, user.__dict__) == expected


@pytest.mark.parametrize("new", ["UNSEEN = object()", "UNSEEN = [object()]"])
def test_what_cannot_be_told_apart_in_memory_is_said(loaded, new):
    assert not break_in_memory(loaded[0], LOADED.replace("UNSEEN = object()", new).encode())


GAUGE = '''
LIMIT = 1e-6


def is_small(x):
    """A gauge.

    >>> is_small(0.0)
    True
    """
    return abs(x) < LIMIT


def steps(n):
    taken = 0
    while taken < n:
        taken += 1
    return taken


def at_import():
    return 7
'''
TESTS = """
import subprocess
import sys

from semispline.solver.judge.gauge import at_import, is_small, steps

SEVEN = at_import()


def test_of_what_was_made_at_import():
    assert SEVEN == 7


def test_from_both_sides():
    assert is_small(9e-7) and not is_small(-2e-6)


def test_here():
    assert steps(2) == 2 and steps(0) == 0


def test_in_a_process_of_its_own():
    code = "from semispline.solver.judge.gauge import steps; print(steps(3))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "3\\n"


def test_that_fails_anyway():
    assert is_small(1.0)
"""
EXACT = "\n\ndef test_the_limit_itself():\n    assert not is_small(1e-6)\n"
PROJECT = """
[tool.pytest.ini_options]
addopts = "--import-mode=importlib --doctest-modules"
pythonpath = ["tests"]
markers = ["compiler", "browser", "slow"]
"""
ACCEPTED = """
[[accepted]]
file = "solver/judge/gauge.py"
function = "is_small"
line = "return abs(x) < LIMIT"
change = "< -> <="
reason = "made up"
"""


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project with a good test for everything but the limit itself; the tool has decided all of it once."""
    if not hasattr(os, "fork"):
        pytest.skip("the tool needs forks")
    root = tmp_path_factory.mktemp("project")
    for folder in ("solver/judge", "semispline", "tests/solver/judge"):
        (root / folder).mkdir(parents=True)
    for package in ("solver", "solver/judge", "semispline"):
        (root / package / "__init__.py").touch()
    (root / "semispline/solver").symlink_to("../solver")
    (root / "solver/judge/gauge.py").write_text(GAUGE)
    (root / "tests/solver/judge/test_gauge.py").write_text(TESTS)
    (root / "pyproject.toml").write_text(PROJECT)
    (root / ".gitignore").write_text("build/\n__pycache__/\n")
    (root / "tests/mutants").mkdir()
    for file in TOOL.glob("[!t]*.py"):
        # What never ends is waited for ten seconds: here, two are enough.
        text = file.read_text().replace("_TIMES, _MORE = 5.0, 10.0", "_TIMES, _MORE = 5.0, 2.0")
        (root / "tests/mutants" / file.name).write_text(text)
    subprocess.run(["git", "init", "-q"], cwd=root, check=True)
    return root, run(root)


def run(root, *words):
    environment = os.environ | {"PYTHONPATH": "tests", "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "mutants", "--workers", "1", *words]
    done = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    return done


def decided(done):
    words = ("killed ", "timeout ", "survived ", "alive ", "undecided ")
    return [line for line in done.stdout.splitlines() if line.startswith(words)]


@pytest.mark.slow
def test_the_one_mutant_that_no_test_tells_survives_and_is_named(project):
    root, first = project
    results = [json.loads(line) for line in (root / "build/mutants/results.jsonl").read_text().splitlines()]
    assert {(r["file"], r["text"], r["change"]) for r in results if r["verdict"] == "survived"} == {
        ("solver/judge/gauge.py", "return abs(x) < LIMIT", "< -> <=")
    }
    assert "solver/judge/gauge.py:11: < -> <=" in first.stdout
    assert first.returncode == 1
    # Constants of the module, a link, a process that a test starts, and a loop without an end.
    verdicts = {r["change"]: r["verdict"] for r in results}
    # What tests made when they were collected stays in memory: a process of its own kills it.
    of_seven = [r["verdict"] for r in results if r["text"] == "return 7"]
    assert sorted(of_seven) == ["alive", "alive", "killed", "killed"]
    assert verdicts["1e-6 -> (1e-6 * 1000)"] == verdicts["1e-6 -> (1e-6 / 1000)"] == verdicts["abs -> "] == "killed"
    assert verdicts["1 -> 2"] == "killed"
    assert verdicts["taken += 1 -> pass"] == "timeout"
    assert (
        "left out, fails without any mutant: tests/solver/judge/test_gauge.py::test_that_fails_anyway" in first.stdout
    )


@pytest.mark.slow
def test_the_working_tree_is_left_as_it_was(project):
    assert (project[0] / "solver/judge/gauge.py").read_text() == GAUGE


@pytest.mark.slow
def test_a_second_run_decides_nothing_again(project):
    second = run(project[0])
    assert (decided(second), second.returncode) == ([], 1)


@pytest.mark.slow
def test_an_interrupted_run_goes_on_where_it_ended(project):
    root, first = project
    results = root / "build/mutants/results.jsonl"
    whole = results.read_text()
    lines = whole.splitlines(keepends=True)
    results.write_text("".join(lines[:-3]) + lines[-3][:40])
    assert len(decided(run(root))) == 3
    results.write_text("".join(lines[:2]))
    assert len(decided(run(root))) == len(lines) - 2
    assert len(decided(first)) == len(lines)


@pytest.mark.slow
def test_a_survivor_is_accepted_with_a_reason_until_a_test_kills_it(project):
    root, _ = project
    accepted, tests = root / "tests/mutants/accepted.toml", root / "tests/solver/judge/test_gauge.py"
    accepted.write_text(ACCEPTED)
    explained = run(root, "--report")
    assert "1 accepted" in explained.stdout
    assert explained.returncode == 0
    tests.write_text(TESTS + EXACT)
    killed = run(root)
    assert any("< -> <=" in line and line.startswith("killed") for line in decided(killed))
    assert "nothing of this survives any more" in killed.stdout
    assert killed.returncode == 1
