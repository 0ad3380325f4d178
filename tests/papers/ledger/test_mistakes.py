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
        (
            "printed.py",
            "RIGHT =",
            "(STEP,) = ()\nRIGHT =",
            "(STEP,) =",
            "values that .* as many as there are names",
        ),
        ("claims.py", "pr.RIGHT", "pr.RIHGT", "pr.RIHGT", "module 'printed' has no attribute 'RIHGT'"),
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


PRINTED = """from sympy import Eq, symbols
from semispline.papers.checks import Digits
from semispline.papers.ledger import formula
x = symbols("x")
RELATION = Eq(x + x, 2 * x, evaluate=False)
DOUBLE = formula(RELATION)
"""
CLAIMS = """from semispline.papers.checks import identity
from semispline.papers.ledger import corrected, fails, formula, holds, part, reading
from . import printed as pr
CLAIMS = (
    {},
)
"""


@pytest.mark.parametrize(
    ("record", "message"),
    [
        ('holds("eq-1", "here", "so", pr.DOUBLE)', r"a part is a Formula, expected part\(check, formula\)"),
        ('holds("eq-1", "here", "so", identity())', r"a part is a Check, expected part\(check, formula\)"),
        ('holds("eq-1", "here", "so", part(pr.DOUBLE, identity()))', r"check is a Formula, expected a check"),
        ('holds("eq-1", "here", "so", part(identity, pr.DOUBLE))', r"check is a function, expected a check"),
        ('holds("eq-1", "here", "so", part(identity(), pr.RELATION))', r"formula is .*Equality.*expected formula\(Eq"),
        ('holds(1, "here", "so")', r"id is 1 \(int\), expected a text"),
        ('holds("eq-1", "here", "so", printed="2x")', r"printed is '2x' \(str\), expected Print"),
        ('fails("eq-1", "here", "so", correction="x")', r"correction is 'x' \(str\), expected corrected"),
        ('fails("eq-1", "here", "so", correction=corrected("x", pr.DOUBLE))', r"corrected: a part is a Formula"),
        ('fails("eq-1", "here", "so", consequence=3)', r"consequence 3, expected a function without arguments"),
        ("reading(part(identity(), pr.DOUBLE))", r"label is a Part, expected a text"),
        ("formula(pr.x == 2)", r"found False \(bool\), expected a relation such as Eq"),
        ("pr.Digits(0.5500)", r"Digits\(0.55\): expected a decimal number as text"),
    ],
)
def test_what_is_of_another_kind_is_told_where_it_is_written(tmp_path, record, message):
    """It is a mistake in the files: it neither reads as a fault of the engine nor goes unnoticed."""
    folder = tmp_path / "paper"
    folder.mkdir()
    (folder / "printed.py").write_text(PRINTED)
    (folder / "claims.py").write_text(CLAIMS.format(record))
    with pytest.raises(MistakeError, match=message) as error:
        load_paper(str(folder))
    assert str(error.value).startswith(f"{folder / 'claims.py'}:5: ")
