"""The page for authors of papers: its code runs in the order in which it stands, and what it names is there."""

import re
from pathlib import Path

import pytest

from semispline.papers.ledger.drafts import examine
from semispline.papers.ledger.records import Claim, Formula, Part, Verdict

PAGE = (Path(__file__).parents[3] / "docs" / "your-own-paper.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def names():
    """What the page's code defines."""
    scope = {}
    for block in re.findall(r"(?m)(?:^    .*\n(?:\n(?=    ))?)+", PAGE):
        if "semispline " not in block.replace("semispline.", ""):
            exec("\n".join(line[4:] for line in block.splitlines()), scope)  # the page itself
    return scope


def test_the_code_of_the_page_runs(names):
    assert isinstance(names["SQUARES"], Formula)
    (claim,) = names["CLAIMS"]
    assert isinstance(claim, Claim)
    assert examine(claim).amounts_to is Verdict.HOLDS
    powers = names["DECIDES"].cases(names["POWER"])
    assert [case.true for case in powers] == [True] * 6
    odd = names["draft"]("eq-3", "Section 1", "so", names["part"](names["SUMS"], names["ODD"]))
    assert examine(odd).amounts_to is Verdict.HOLDS
    assert names["SHOWN"].echo.endswith("= n^{2}")
    assert list(names["ROOT"].equivalent) == ["Eq(y, -x)"]


def test_every_verdict_and_check_of_the_page_can_be_called(names):
    called = set(re.findall(r"^\| `(\w+)\(", PAGE, re.M))
    assert {"holds", "fails", "ambiguous", "identity", "code", "inequality"} <= called
    assert [name for name in called if not callable(names.get(name))] == []


def test_a_record_of_each_kind_is_made_as_the_page_says(names):
    part = Part(names["SUMS"], names["SQUARES"])
    assert names["holds"]("eq-1", "here", "so", part).verdict is Verdict.HOLDS
    assert names["holds_if"]("eq-1", "here", "so", "n > 1", part).readings[0].condition == "n > 1"
    readings = [names["reading"](label, part) for label in ("a", "b")]
    assert len(names["ambiguous"]("eq-1", "here", "so", *readings).readings) == 2
    assert names["definition"]("eq-1", "here", "so", "a name").reason == "a name"
    assert names["not_checkable"]("eq-1", "here", "so", "a picture").reason == "a picture"
    correction = names["corrected"]("better", part)
    assert names["fails"]("eq-1", "here", "so", part, correction=correction).correction_parts == (part,)
