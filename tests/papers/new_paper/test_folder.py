"""`semispline new-paper`: what is written can be verified as it is, and nothing that is there is touched."""

import json

import pytest
from typer.testing import CliRunner

from semispline.papers.cli import app
from semispline.papers.ledger.loading import load_paper
from semispline.papers.ledger.verification import verify


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_a_new_paper_holds_fails_and_is_ambiguous(tmp_path):
    folder = tmp_path / "deep" / "my.paper 1"
    result = run("new-paper", folder, "--title", 'On "sums" \\ and\n more.', "--doi", "10.1000/182")
    assert result.exit_code == 0, result.output
    assert {path.name for path in folder.iterdir()} == {"__init__.py", "printed.py", "claims.py"}
    ledger = verify(str(folder), workers=1)
    assert ledger.paper.title == 'On "sums" \\ and more (doi 10.1000/182)'
    assert [str(d.verdict) for d in ledger.decisions] == ["holds", "fails", "ambiguous", "holds"]
    assert ledger.ok
    assert ledger.decisions[1].counterexample == "n = 1: printed 1/2, true 1"
    assert all(decision.mutation.tried for decision in ledger.decisions)
    assert ledger.paper.claims[3].printed.echo == r"\sum_{i = 1}^{n} \left( 2 \cdot i - 1 \right) = n^{2}"


def test_a_new_paper_without_a_title_is_the_sample(tmp_path):
    assert run("new-paper", tmp_path / "a").exit_code == 0
    assert load_paper(str(tmp_path / "a")).title == "Sums of powers, a sample"
    assert run("new-paper", tmp_path / "b", "--doi", "10.1/2").exit_code == 0
    assert load_paper(str(tmp_path / "b")).title == "Sums of powers, a sample (doi 10.1/2)"


def test_every_verdict_of_a_new_paper_is_repeated_by_pari(tmp_path):
    pytest.importorskip("cypari")
    run("new-paper", tmp_path / "a")
    result = run("verify", tmp_path / "a", "--recheck", "pari", "--json", tmp_path / "l.json")
    assert result.exit_code == 0, result.output
    counts = json.loads((tmp_path / "l.json").read_text())["counts"]
    assert counts["rechecked"] == 4
    assert counts["identities_agreed"] == counts["identities_exported"] > 10


@pytest.mark.parametrize("content", ["mine", None])
def test_nothing_that_is_there_is_touched(tmp_path, content):
    place = tmp_path / "a"
    if content is None:
        place.mkdir()
        (place / "notes.txt").write_text("mine")
    else:
        place.write_text(content)
    result = run("new-paper", place)
    assert result.exit_code == 2
    assert "there is something already" in result.stderr
    assert (place if content else place / "notes.txt").read_text() == "mine"
    assert list(tmp_path.iterdir()) == [place]


def test_an_empty_folder_is_filled_and_one_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "empty").mkdir()
    assert run("new-paper", tmp_path / "empty").exit_code == 0
    (tmp_path / "file").write_text("")
    result = run("new-paper", tmp_path / "file" / "x")
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert "give another folder" in result.stderr
