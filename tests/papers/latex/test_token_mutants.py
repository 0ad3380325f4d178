"""One token changed: the formula is refused, or says something else, or the token stood where nothing is said.

What is compared are trees. SymPy cancels and commutes: to it some changed formulas are the same.
"""

import random
from collections import Counter
from dataclasses import replace

import pytest

from helpers.token_mutants import mutants, neutral
from semispline.papers.latex import UnreadableError, expressions, read_formula, resolving, statements
from semispline.papers.primer.printed import blocks, formula

FORMULAS = {}
for block in blocks().values():
    if block.kind == "math":
        try:
            FORMULAS[block.id] = formula(block.id)
        except UnreadableError:
            continue
SHARE = 0.1


def outcomes(identifiers, share=1.0):
    """Yield (id, offset, kind, outcome) of changed formulas: refused, other, or same where the tree did not change."""
    chosen = random.Random(27)
    for identifier in identifiers:
        printed = FORMULAS[identifier]
        for at, kind, text in mutants(printed.latex, identifier):
            if chosen.random() >= share:
                continue
            try:
                same = read_formula(text, printed.names).statements == printed.statements
            except UnreadableError:
                yield identifier, at, kind, "refused"
            else:
                yield identifier, at, kind, "same" if same else "other"


def unnoticed(found):
    """Changes after which the tree is the same, at places that say something."""
    return [
        (identifier, at, kind, FORMULAS[identifier].latex[at : at + 12])
        for identifier, at, kind, outcome in found
        if outcome == "same" and not neutral(FORMULAS[identifier].latex, at, kind)
    ]


@pytest.mark.long
def test_a_changed_token_is_noticed_wherever_it_says_something(whole):
    found = list(outcomes(FORMULAS, 1.0 if whole else SHARE))
    assert unnoticed(found) == []
    counts = Counter(outcome for *_, outcome in found)
    assert counts["refused"] > 5 * counts["other"] > 10 * counts["same"] > 0


# Readers that are broken on purpose.


def read_by_it(monkeypatch, identifier):
    """What a broken reader makes of a formula takes the place of what was read."""
    printed = FORMULAS[identifier]
    monkeypatch.setitem(FORMULAS, identifier, read_formula(printed.latex, printed.names))


def test_a_reader_that_drops_primes_is_found_out(monkeypatch):
    assert unnoticed(outcomes(["pointvectors.1"])) == []
    true = resolving.scripts_after

    def without_primes(*args, **kwargs):
        return replace(true(*args, **kwargs), primes=0)

    monkeypatch.setattr(resolving, "scripts_after", without_primes)
    monkeypatch.setattr(expressions, "scripts_after", without_primes)
    read_by_it(monkeypatch, "pointvectors.1")
    assert {FORMULAS["pointvectors.1"].latex[at] for _, at, *_ in unnoticed(outcomes(["pointvectors.1"]))} >= {"'"}


def test_a_reader_that_joins_lines_blindly_is_found_out(monkeypatch):
    assert unnoticed(outcomes(["extremities.5"])) == []
    true = statements._lines
    monkeypatch.setattr(statements, "_lines", lambda items: [tuple(item for line in true(items) for item in line)])
    read_by_it(monkeypatch, "extremities.5")
    assert {text[:2] for *_, text in unnoticed(outcomes(["extremities.5"]))} == {r"\\"}
