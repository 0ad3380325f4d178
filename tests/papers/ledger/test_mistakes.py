"""Mistakes in the files of a paper: file and line, what was found and what would be right, and never a verdict."""

import re

import pytest

from semispline.papers.ledger.loading import load_paper
from semispline.papers.ledger.mistakes import MistakeError
from semispline.papers.ledger.verification import verify


def line_of(path, text):
    return 1 + path.read_text()[: path.read_text().index(text)].count("\n")


@pytest.mark.parametrize(
    ("file", "old", "new", "at", "message"),
    [
        ("claims.py", "CLAIMS = (", "CLAIMS = ((", None, "SyntaxError: .* expected Python"),
        ("printed.py", "total = sp", "totel = sp", "RIGHT =", "'total' is not defined.*expected a name"),
        ("claims.py", "from . import printed", "from . import prented", "from . import prented", "expected a module"),
        ("claims.py", "Case, Check, Claim", "Cose, Check, Claim", "from semispline.papers.ledger.records", "'Cose'"),
        ("claims.py", 'Check(cases, Strength.RATIONAL, "addition")', 'Check("addition")', "CHECK =", "missing 2"),
        ("claims.py", "CLAIMS = (", "exit(3)\nCLAIMS = (", "exit(3)", "SystemExit.*expected files that do not end"),
        ("claims.py", "CLAIMS = (", "CLEIMS = (", None, "CLAIMS is nothing, expected a tuple of Claim"),
        ("claims.py", '"eq-2"', '"eq-1"', '"eq-1"', "claim eq-1: found the id twice"),
        ("claims.py", '"eq-2"', '"eq 2"', '"eq 2"', "claim eq 2: id 'eq 2', expected letters"),
        ("claims.py", '"The sum is n^2/2."', '" "', '"eq-2"', "claim eq-2: statement or place is empty"),
        ("claims.py", "Verdict.FAILS", "None", '"eq-2"', "claim eq-2: no verdict, expected one of holds"),
        ("printed.py", "(n, total), (n >= 1,))\nW", "(n,), (n >= 1,))\nW", '"eq-1"', r"undeclared \['T'\]"),
    ],
)
def test_a_paper_that_does_not_load_says_where(made_up_paper, file, old, new, at, message):
    folder = made_up_paper()
    path = folder / file
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(MistakeError, match=message) as error:
        load_paper(str(folder))
    assert str(error.value).startswith(str(folder)), "the file comes first"
    if at is not None:
        where = path if at in path.read_text() else folder / "claims.py"
        assert str(error.value).startswith(f"{where}:{line_of(where, at)}: ")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("residual = (formula", "residual = (formola", "NameError: name 'formola' is not defined.*expected a name"),
        ("residual = (formula.relation.rhs", "residual = (formula.right", "AttributeError: .*'right'"),
        ("range(1, 10)", "range(1, 10, 0)", "ValueError"),
    ],
)
def test_a_check_that_is_written_wrong_is_a_mistake_and_no_verdict(made_up_paper, old, new, message):
    path = made_up_paper() / "claims.py"
    path.write_text(path.read_text().replace(old, new, 1))
    ledger = verify(str(path.parent), workers=1)
    assert ledger.mistaken == ("eq-1", "eq-2")
    for decision in ledger.decisions:
        assert decision.verdict is None
        assert decision.problem.startswith(f"{path}:{line_of(path, new)}: ")
    assert re.search(message, ledger.decisions[0].problem)


def test_a_check_that_gives_no_answer_is_no_mistake(made_up_paper):
    path = made_up_paper() / "claims.py"
    path.write_text(path.read_text().replace("residual == 0,", "None,"))
    ledger = verify(str(path.parent), workers=1)
    assert (ledger.mistaken, ledger.unanswered) == ((), ("eq-1", "eq-2"))


def test_a_folder_that_was_mended_is_read_again(made_up_paper):
    """Nothing of a module that did not run is kept."""
    folder = made_up_paper()
    (folder / "__init__.py").write_text('"""A title."""\n1 / 0\n')
    with pytest.raises(MistakeError, match=r"__init__.py:2: found ZeroDivisionError"):
        load_paper(str(folder))
    (folder / "__init__.py").write_text('"""A title."""\n')
    assert load_paper(str(folder)).title == "A title"
