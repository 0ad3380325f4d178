"""What is said of the choice of alpha against the table of the suite of shapes."""

import json
from pathlib import Path

from semispline.papers import lin2014
from semispline.papers.lin2014.findings import choice_of_alpha, findings

ROOT = Path(__file__).parents[3]
TABLE = (ROOT / "docs" / "shapes.md").read_text(encoding="utf-8")


def cells(label):
    """The cells of the first line of the tables that begins with a label."""
    line = next(line for line in TABLE.splitlines() if line.startswith(f"| {label} |"))
    return [cell.strip() for cell in line.strip("|").split("|")]


def column(label, title):
    """One cell, by the head of its table."""
    lines = TABLE.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith(f"| {label} |"))
    head = next(lines[i - 1] for i in range(at, 0, -1) if lines[i].startswith("| ---"))
    titles = [cell.strip() for cell in head.strip("|").split("|")]
    return cells(label)[titles.index(title)]


def test_the_finding_quotes_the_table():
    (finding,) = choice_of_alpha()
    text = f"{finding.short} {finding.detail}"
    for label in ("facing", "u-turn", "closed rims"):
        assert f"{column(f'{label}, energy', 'pairs')} " in text
    for name, words in (("fair", "end at a bound, {} turn"), ("energy", "{} end at a bound")):
        assert words.format(column(f"facing, {name}", "turn > 30" if "turn" in words else "at bound")) in text
    assert f"and {column('facing, energy', 'folds')} fold. With" in text
    assert f"and {column('facing, fair', 'folds')} fold; that" in text
    assert f"{column('u-turn, energy', 'folds')} fold with least energy, {column('u-turn, fair', 'folds')} with" in text
    assert f"{column('closed rims, energy', 'waist < 0.5')} are pinched" in text
    told = json.loads((Path(lin2014.__file__).parent / "shapes.json").read_text(encoding="utf-8"))
    wanted = told["facing"]["wants"]
    shown = next(
        line for line in TABLE.split("## What least energy wants")[1].splitlines() if line.startswith("| facing")
    )
    assert [int(cell) for cell in shown.strip("|").split("|")[1:]] == list(wanted.values())
    assert f"{wanted['not positive']} want alpha^2 <= 0" in text
    assert f"{wanted['below 1/8']} more want less" in text


def test_it_is_among_the_findings_of_the_study():
    assert choice_of_alpha().__next__() in findings({})
