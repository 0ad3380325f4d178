import importlib
import pickle

import pytest

from semispline.solver.errors import SemisplineError
from semispline.solver.io import foreign


@pytest.fixture
def read_here(whole, monkeypatch):
    """Read files of other programs in this process: to start one and load a CAD kernel there takes a second each time.

    For sound files alone, and what they hold; .ci/run lets each be read by a process of its own.
    """
    if not whole:
        monkeypatch.setattr(foreign, "call", called_here)


@pytest.fixture(scope="module")
def reads_here(whole):
    """The same for all tests of a file, and for what they share."""
    with pytest.MonkeyPatch.context() as patch:
        if not whole:
            patch.setattr(foreign, "call", called_here)
        yield


def called_here(module, arguments, seconds, megabytes):
    """Do what `workers.call` does, without its process: what is found goes through pickle all the same."""
    assert min(seconds, megabytes) > 0
    try:
        found = importlib.import_module(module).work(*arguments)
    except SemisplineError as error:
        found = error
    found = pickle.loads(pickle.dumps(found, protocol=pickle.HIGHEST_PROTOCOL))
    if isinstance(found, SemisplineError):
        raise found
    return found
