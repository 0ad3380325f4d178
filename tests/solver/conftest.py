import pytest

from helpers.reading_here import called_here
from semispline.solver.io import foreign


@pytest.fixture
def read_here(monkeypatch):
    """Read files of other programs in this process: to start one and load a CAD kernel there takes a second each time.

    For sound files alone, and what they hold. What the processes themselves do: io/test_io_foreign,
    test_reading_apart.
    """
    monkeypatch.setattr(foreign, "call", called_here)


@pytest.fixture(scope="module")
def reads_here():
    """The same for all tests of a file, and for what they share."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(foreign, "call", called_here)
        yield
