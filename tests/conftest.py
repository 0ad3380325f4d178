"""Settings that all tests share."""

import gc
import os
import random
import sys
from pathlib import Path

import pytest
from hypothesis import settings

from helpers.sweeps import IS_WHOLE, examples

# The clock decides nothing here, and the same examples are tried at every run: a red test can be repeated.
settings.register_profile("repeatable", examples(), deadline=None, derandomize=True, print_blob=True)
settings.load_profile("repeatable")

# Two things that take a tenth of a run and change no result: SymPy forgets what it simplified after a thousand entries,
# and Python looks through everything for rings that nobody holds, thousands of collected tests among it.
os.environ.setdefault("SYMPY_CACHE_SIZE", "10000")
gc.set_threshold(100_000, 50, 100)

NO_SHARED = "shared files not found; set SEMISPLINE_SHARED"


@pytest.fixture(scope="session")
def shared():
    """Return the folder of files that are not in the repository: SEMISPLINE_SHARED, or `shared` beside it."""
    said = os.environ.get("SEMISPLINE_SHARED")
    folder = Path(said or Path(__file__).parents[2] / "shared")
    if not folder.is_dir():
        # Who named a folder meant it.
        (pytest.fail if said else pytest.skip)(f"{NO_SHARED} (looked for {folder})")
    return folder


def pytest_addoption(parser):
    parser.addoption("--order-seed", type=int, metavar="N", help="run the tests in another order, the same for each N")


def pytest_report_header(config):
    seed = config.getoption("order_seed")
    return None if seed is None else f"order of tests: --order-seed={seed}"


def reordered(items, seed):
    """Return the tests file by file, files and the tests of each in another order: what a file shares is made once."""
    of_file = {}
    for item in items:
        of_file.setdefault(item.path, []).append(item)
    files = list(of_file.values())
    chance = random.Random(seed)
    chance.shuffle(files)
    for tests in files:
        chance.shuffle(tests)
    return [item for tests in files for item in tests]


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    seed = config.getoption("order_seed")
    if seed is not None:
        items[:] = reordered(items, seed)


def pytest_collection_finish():
    # What is imported and collected stays to the end.
    gc.freeze()


@pytest.fixture(scope="session")
def whole():
    """Whether all cases of a sweep are asked for, or a few of each kind."""
    return IS_WHOLE


def pytest_itemcollected(item):
    """Mark the tests that ask for the folder, or for the size of their sweep, so that `-m` finds them."""
    asked = getattr(item, "fixturenames", ())
    for name, mark in (("shared", pytest.mark.shared), ("whole", pytest.mark.sweep)):
        if name in asked:
            item.add_marker(mark)


# pytest-xdist has only its workers count what was left out, and says nothing of it.
LEFT_OUT = pytest.StashKey()


def pytest_deselected(items):
    output = getattr(items[0].config, "workeroutput", {})
    output["left_out"] = output.get("left_out", 0) + len(items)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    node.config.stash[LEFT_OUT] = getattr(node, "workeroutput", {}).get("left_out", 0)


def pytest_terminal_summary(terminalreporter):
    """Say aloud how many tests were left out, and how many had no files to work on."""
    left_out = terminalreporter.config.stash.get(LEFT_OUT, 0)
    if left_out:
        terminalreporter.write_line(f"{left_out} tests left out by their marks")
    skipped = [r for r in terminalreporter.stats.get("skipped", []) if NO_SHARED in str(r.longrepr)]
    if skipped:
        terminalreporter.write_line(f"{len(skipped)} tests skipped: {NO_SHARED}", yellow=True)


@pytest.fixture(scope="session", autouse=True)
def only_public_names():
    """Fail at the end of a run where a hall was imported by its bare name: each of its classes would exist twice."""
    yield
    assert sorted({name.partition(".")[0] for name in sys.modules} & {"solver", "papers", "derivations"}) == []
