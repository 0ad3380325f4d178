"""The process that rechecks: its limits are of processor time, so that a busy machine decides nothing."""

import pytest

from semispline.papers.recheck import Export, identity, rechecked, rechecking, write_certificates
from semispline.papers.recheck.statements import Certificate, Reading
from semispline.solver.errors import ComputationError

FOUND = Export("p", (Certificate("eq-1", "holds", (Reading((identity("a", "(x + 1)^2", "x^2 + 2*x + 1"),)),)),))


@pytest.fixture
def folder(tmp_path):
    pytest.importorskip("cypari")
    write_certificates(tmp_path, FOUND)
    return tmp_path


@pytest.mark.long
def test_it_agrees(folder):
    assert rechecked(FOUND, folder).verdicts == {"eq-1": "holds"}
    assert rechecked(FOUND).agrees


@pytest.mark.long
def test_an_endless_statement_ends_by_processor_time(folder, monkeypatch):
    monkeypatch.setattr(rechecking, "_SECONDS", 1)
    path = folder / "gp" / "eq-1.gp"
    path.write_text(path.read_text().replace("same(", "same(while(1, ) + ", 1))
    with pytest.raises(ComputationError, match=r"^recheck: .*limit of processor time"):
        rechecked(FOUND, folder)


def test_a_process_that_breaks_down_is_no_answer(folder):
    (folder / "statements" / "eq-1.json").write_text("{}")
    with pytest.raises(ComputationError, match=r"^recheck: .*KeyError"):
        rechecked(FOUND, folder)
