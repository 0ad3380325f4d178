import textwrap

import pytest

from helpers.small_report import small_results

PRINTED = '''
"""A made-up paper: the sum of the first n numbers, once right and once wrong."""

import sympy as sp

from semispline.papers.ledger.records import Formula

n = sp.Symbol("n", integer=True, positive=True)
total = sp.Symbol("T", integer=True)
RIGHT = Formula(sp.Eq(total, n * (n + 1) / 2), (n, total), (n >= 1,))
WRONG = Formula(sp.Eq(total, n**2 / 2), (n, total), (n >= 1,))
'''
CLAIMS = '''
from functools import partial

import sympy as sp

from semispline.papers.ledger.records import (
    Case, Check, Claim, Consequence, Correction, Counterexample, Formula, Part, Reading, Strength, Verdict,
)
from semispline.papers.ledger.search import smallest_assignment

from . import printed as pr


def cases(formula):
    """Add up, for n = 1 .. 9."""
    for n in range(1, 10):
        residual = (formula.relation.rhs - formula.relation.lhs).subs({pr.n: n, pr.total: sum(range(n + 1))})
        yield Case(f"n = {n}", residual == 0, residual=residual)


def counterexample(formula):
    def wrong(at):
        return formula.relation.rhs.subs(at) != sum(range(int(at[pr.n]) + 1))

    at = smallest_assignment([pr.n], wrong)
    n = at[pr.n]
    return Counterexample((("n", str(n)),), str(formula.relation.rhs.subs(at)), str(sum(range(int(n) + 1))))


CHECK = Check(cases, Strength.RATIONAL, "addition")
CLAIMS = (
    Claim("eq-1", "Section 1", "The sum is n(n+1)/2.", Verdict.HOLDS, (Reading((Part(CHECK, pr.RIGHT),)),)),
    Claim(
        "eq-2", "Section 1", "The sum is n^2/2.", Verdict.RECORDED, (Reading((Part(CHECK, pr.WRONG),)),),
        Correction("n(n+1)/2", (Part(CHECK, pr.RIGHT),)),
        partial(counterexample, pr.WRONG),
        lambda: Consequence("on nothing", {"gap": 0.5}),
    ),
)
'''


@pytest.fixture
def made_up_paper(tmp_path):
    """Return a function that writes the made-up paper, with the verdict recorded for its wrong formula."""

    def write(recorded="FAILS", claims=CLAIMS):
        return write_made_up_paper(tmp_path, recorded, claims)

    return write


@pytest.fixture(scope="session")
def made_up_paper_once(tmp_path_factory):
    """Return the folder of the made-up paper, for tests that only read it."""
    return write_made_up_paper(tmp_path_factory.mktemp("paper"))


@pytest.fixture(scope="session")
def small_report(made_up_paper_once, tmp_path_factory):
    """Return what the small study came to, and what its progress was told."""
    steps = {}
    return small_results(made_up_paper_once, tmp_path_factory.mktemp("report"), steps), steps


def write_made_up_paper(parent, recorded="FAILS", claims=CLAIMS):
    folder = parent / "madeup"
    folder.mkdir(exist_ok=True)
    (folder / "printed.py").write_text(textwrap.dedent(PRINTED))
    (folder / "claims.py").write_text(textwrap.dedent(claims).replace("Verdict.RECORDED", f"Verdict.{recorded}"))
    return folder
