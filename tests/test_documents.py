"""What the documents name is there."""

import importlib
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
# A path has a slash or one of the suffixes below, after a name that is no more than dots.
PATH = re.compile(r"[\w.]+(/[\w.-]*)+|[\w-]+\.(py|pyi|toml|md|txt|json)")
NAME = re.compile(r"[A-Za-z_]\w*")


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


@cache
def code():
    halls = ("derivations", "papers", "semispline", "solver", "tests")
    files = [path for hall in halls for path in (ROOT / hall).rglob("*")]
    files = [path for path in files if path.suffix in (".py", ".pyi")]
    return "\n".join(path.read_text("utf-8") for path in (*files, ROOT / "Makefile"))


def quoted(line):
    """Split what stands between backquotes in a line into paths and names; commands and code are neither."""
    # What a build makes is not there before it.
    spans = [span.removesuffix("()") for span in re.findall(r"`([^`]+)`", line)]
    paths = [span for span in spans if PATH.fullmatch(span) and not span.startswith(("..", "build/"))]
    return paths, [span for span in spans if NAME.fullmatch(span)]


def exists(path):
    """Tell whether a file or folder is there; a name alone may be that of a file in any paper or room."""
    return (ROOT / path).exists() or ("/" not in path.rstrip("/") and any(ROOT.glob(f"[a-z]*/**/{path.rstrip('/')}")))


DOCUMENTS = (
    "CONTRIBUTING.md",
    "README.md",
    "benchmarks/README.md",
    "docs/architecture.md",
    "docs/theory.md",
    "docs/what-has-to-be-believed.md",
    "docs/your-own-paper.md",
)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_each_file_is_there(document):
    assert [path for line in read(document).splitlines() for path in quoted(line)[0] if not exists(path)] == []


@pytest.mark.long
@pytest.mark.parametrize("document", ["CONTRIBUTING.md", "docs/architecture.md"])
def test_each_name_stands_in_the_code(document):
    missing = []
    for line in read(document).splitlines():
        paths, names = quoted(line)
        files = [path for path in paths if path.endswith(".py") and "/" in path]
        # In a line with one file, what has a name like code is what is in that file.
        where = read(files[0]) if len(files) == 1 and line.startswith("|") else code()
        missing += [(name, line) for name in names if not re.search(rf"\b{name}\b", where + " ".join(paths))]
    assert missing == []


@pytest.mark.parametrize("document", ["CONTRIBUTING.md", "README.md"])
def test_each_target_of_make_is_there(document):
    text = read(document)
    named = set(re.findall(r"(?m)^ {4}make ([\w-]+)", text)) | set(re.findall(r"`make ([\w-]+)`", text))
    assert named
    assert named <= set(re.findall(r"(?m)^([\w-]+):", read("Makefile")))


def test_each_target_of_make_that_nothing_else_runs_is_named():
    makefile = read("Makefile")
    targets = set(re.findall(r"(?m)^([\w-]+):", makefile))
    run_by_others = set(re.findall(r"(?m)^make ([\w-]+)", read(".ci/run")))
    run_by_others |= set(re.search(r"(?m)^check: (.*)$", makefile)[1].split())
    assert len(targets) > len(run_by_others) > 5
    for target in targets - run_by_others - {"clean"}:
        assert re.search(rf"(?m)^ {{4}}make {target}\b", read("CONTRIBUTING.md") + read("README.md")), target


def test_the_aims_of_the_benchmarks_are_those_that_the_readme_states(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "benchmarks")
    sizes = importlib.import_module("paper_sizes")
    table = read("README.md").partition("## How fast, how large")[2]
    aims = [line.split(" | ")[1] for line in table.splitlines() if line.startswith("| ")]
    for aim in (
        f"< {1e3 * sizes.REDUCED_LIMIT:g} ms",
        f"< {1e3 * sizes.CASADI_LIMIT:g} ms",
        f"{sizes.SPEED_UP} times faster",
        "{:g} times in the median, {:g} at most".format(*sizes.FAIR_LIMITS),
    ):
        assert aim in aims


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("How good a contact must be", "solver/judge/limits.py"),
        ("row 2 of a contact", "derivations/contact.py"),
        ("file format", "solver/io/surface_files.py"),
        ("rival method", "papers/baselines/"),
        ("claim", "papers/lin2014/claims/"),
    ],
)
def test_a_newcomer_finds_the_file_to_change(question, answer):
    # The items of the list below "Where to change", each on its lines.
    items = re.split(r"(?m)^- ", read("CONTRIBUTING.md").partition("## Where to change")[2].partition("\n## ")[0])
    assert any(question in item and f"`{answer}`" in item for item in items)
