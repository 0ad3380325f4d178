"""Every Python example of the README runs, and the figures of its first table are of this code."""

import re
from pathlib import Path

import pytest

from helpers.sweeps import first_ones
from semispline import blend
from semispline.papers.lin2014.examples.made_pair import made_pair

README = Path(__file__).parents[1] / "README.md"
TEXT = README.read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def test_there_are_examples():
    assert len(BLOCKS) >= 5


@pytest.mark.parametrize("block", first_ones(1, BLOCKS), ids=range(len(BLOCKS)))
def test_example_runs(block, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(block, str(README), "exec"), names)
    # An example that leaves nothing behind has shown nothing.
    assert len(names) > 2


@pytest.mark.parametrize(("column", "alpha"), [(0, "fair"), (1, "energy")])
def test_the_table_of_blends_is_of_this_code(column, alpha):
    found = blend(*made_pair(), alpha=alpha)
    measured = {
        "largest turn inside [°]": found.shape.turn.degrees,
        "fairness": found.shape.fairness.value,
        "energy (11)": found.energy,
        "control points": found.rows_stored,
    }
    for name, value in measured.items():
        (row,) = re.findall(rf"(?m)^    {re.escape(name)}  +(.*)", TEXT)
        # As many digits as are printed, and what another processor rounds otherwise.
        assert float(re.split(r"  +", row)[column]) == pytest.approx(value, rel=1e-3), name
