"""Short ways to write a check: of a question without a formula, of a premise, of a part without its condition."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cache

from semispline.papers.ledger.records import Case, Check, Formula, Strength


def premises(cases: Iterable[Case]) -> Iterator[Case]:
    """Yield cases on which an argument stands: instances of nothing, and where one is false there is no verdict."""
    yield from (replace(case, own=False) for case in cases)


def question(cases: Callable[[], Iterator[Case]], method: str, strength: Strength = Strength.RATIONAL) -> Check:
    """Return a check of a question without a formula."""
    return Check(lambda _: cases(), strength, method)


def proved(cases: Callable[[], Iterator[Case]], method: str, strength: Strength = Strength.GENERAL) -> Check:
    """Return a check of a question whose cases prove the answer."""
    return Check(lambda _: cases(), strength, method, proof=True)


def consistent(cases: Callable[[Formula | None], Iterator[Case]], method: str) -> Check:
    """Return a check that finds what is printed to agree, or that something of the kind exists; it proves nothing."""
    return Check(cases, Strength.CONSISTENT, method)


def of_data(cases: Callable[[Formula | None], Iterator[Case]], method: str) -> Check:
    """Return a check that decides a claim which is on printed numbers and nothing else, all of them."""
    return Check(cases, Strength.RATIONAL, method, proof=True)


@cache
def unconditional(check: Check) -> Check:
    """Return the check of a part that needs nothing of the condition of its claim: every instance must be true."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield from (replace(case, meets=True) for case in check.cases(formula))

    return replace(check, cases=cases)
