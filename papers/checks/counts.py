"""Checks of relations between counts: for every order and number of functions, then counted at instances."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case, Check, Formula, Meaning, Strength, difference_case, given


@dataclass(frozen=True)
class Counting:
    """Counts for every order and number of functions, and the same counted at instances.

    Attributes
    ----------
    exact : mapping
        Letter -> its value in the other letters, derived.
    instances : callable
        Yields a label, the counted letters, and own.
    """

    exact: dict[Any, Any]
    instances: Callable[[], Iterable[tuple[str, dict[Any, Any], bool]]]


def count_check(counting: Counting, method: str) -> Check:
    """Return a check of a relation between counts."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        relation = given(formula).relation
        residual = sp.expand((relation.rhs - relation.lhs).subs(counting.exact))
        yield Case("every order and count", residual == 0, residual=residual)
        for label, values, own in counting.instances():
            yield difference_case(given(formula), label, Meaning(values), own=own)

    return Check(cases, Strength.GENERAL, method, proof=True)
