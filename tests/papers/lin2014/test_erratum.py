"""REPORT.md: two pages for a reader of the paper, its picture, its version."""

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest

import semispline
from semispline.papers.ledger import Consequence, LedgerError, Verdict, collected
from semispline.papers.lin2014 import erratum as written
from semispline.papers.lin2014 import erratum_strip as strip

ROOT = Path(__file__).parents[3]
PAPER = ROOT / "papers" / "lin2014"
STORED = (PAPER / "REPORT.md").read_text(encoding="utf-8")


def made_ledger(verdicts=()):
    """Return a ledger as recorded, with made-up measures of all records that have any."""

    class Measures(dict):
        def __missing__(self, key):
            return 0.5

        def items(self):
            found = {f"energy (11), C2, {m} middle curves, 45 control points": 2.0 for m in (0, 1)}
            kinds = ("own knots", "knots of both", "converted (dropped)", "converted (kept)")
            found |= {"(11) saved by functions p_2 [%]": 0.5}
            return (found | {f"Fig. {n}, {kind}": 40 for n in (5, 6, 8, 9, 10) for kind in kinds}).items()

        def values(self):
            return [0.5]

    paper = collected("lin2014")
    decisions = [
        SimpleNamespace(
            id=c.id,
            recorded=c.verdict,
            verdict=dict(verdicts).get(c.id, c.verdict),
            consequence=Consequence("made up", Measures()),
        )
        for c in paper.claims
    ]
    named = {d.id: d for d in decisions}
    causes = tuple((cause, tuple(named[c.id] for c in paper.claims if c.cause == cause.key)) for cause in paper.causes)
    counts = {"printed": 1, "decided": 2, "consistent": 3, **dict.fromkeys(Verdict, 4)}
    return SimpleNamespace(paper=paper, decisions=tuple(decisions), counts=lambda: counts, causes=lambda: causes)


def blossom(*u):
    """Return the control point of the section x -> (x, (x - x^2)/2) that belongs to three knots of U."""
    a, b, c = u
    mean = Fraction(a + b + c) / 3
    return mean, (mean - Fraction(a * b + a * c + b * c) / 3) / 2


def test_the_right_rows_give_the_cylinder_again():
    knots = strip.KNOTS
    assert strip.blend_rows("right") == [blossom(*knots[i + 1 : i + 4]) for i in range(6)]


def test_the_rows_of_the_base_are_those_of_the_cylinder():
    # The same section, its parameter running backwards, knots 1 and 3.
    for triple, row in zip(((0, 0, 0), (0, 0, 1), (0, 1, 3)), strip.base_rows(), strict=True):
        assert row == blossom(*(-w for w in triple))


@pytest.mark.parametrize(("reading", "ratio"), [("printed", "9/2"), ("squared", "3/2"), ("right", "1")])
def test_the_blend_bends_so_many_times_as_much(reading, ratio):
    assert strip.curvature_ratio(reading) == Fraction(ratio)


def test_both_contacts_are_alike():
    for reading in ("printed", "squared"):
        rows = strip.blend_rows(reading)
        assert rows == [(1 - x, z) for x, z in reversed(rows)]


def test_the_picture_is_svg_and_shows_each_reading():
    picture = strip.picture()
    ElementTree.fromstring(picture)
    # Two panels: both bases, and three blends.
    assert picture.count("<polyline") == 2 * (2 + 3)
    assert "nan" not in picture


def test_the_stored_picture_is_fresh():
    assert (PAPER / "one-strip.svg").read_text(encoding="utf-8") == strip.picture()


def test_the_stored_text_has_no_gaps_and_speaks_to_a_reader_of_the_paper():
    assert not re.search(r"<<|>>|\[\[|\]\]", STORED)
    assert "not as recorded" not in STORED.lower()
    # Two pages at 10 points with the picture; formulas and tables apart.
    prose = re.sub(r"\$`.*?`\$|^\|.*$", "", STORED, flags=re.MULTILINE)
    assert len(prose.split()) < 1550
    for word in ("claim", "ledger", "mutant", "oracle", "semi-structured-reduced"):
        assert word not in prose
    for heading in ("Mathematics", "Misprints, or losses of the scan", "What stays"):
        assert f"## {heading}\n" in STORED


def test_each_number_of_the_text_is_filled_in():
    text = written.erratum(made_ledger(), "9.8.7").text
    assert "semispline 9.8.7" in text
    assert not re.search(r"<<|\[\[", text)


def test_a_run_that_found_another_verdict_says_so_at_the_top():
    text = written.erratum(made_ledger({"cond-3.1": Verdict.HOLDS}), "1").text
    assert text.index("Not as recorded in this run: cond-3.1") < text.index("In short")


def test_a_cause_that_the_text_does_not_tell_is_refused():
    ledger = made_ledger()
    (cause, decisions), *others = ledger.causes()
    ledger.causes = lambda: ((replace(cause, key="another"), decisions), *others)
    with pytest.raises(LedgerError, match="found causes another"):
        written.erratum(ledger, "1")


def test_the_version_to_quote_is_that_of_the_program():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r'^version: "(.+)"$', citation, re.MULTILINE)[1] == semispline.__version__
    assert f"semispline {semispline.__version__}." in STORED
