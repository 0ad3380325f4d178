"""Settings that all tests share."""

import random

import pytest
from hypothesis import settings

# The clock decides nothing here, and the same examples are tried at every run: a red test can be repeated.
settings.register_profile("repeatable", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("repeatable")


def pytest_addoption(parser):
    parser.addoption("--order-seed", type=int, metavar="N", help="run the tests in another order, the same for each N")


def pytest_report_header(config):
    seed = config.getoption("order_seed")
    return None if seed is None else f"order of tests: --order-seed={seed}"


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    seed = config.getoption("order_seed")
    if seed is not None:
        items[:] = reordered(items, seed)


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
