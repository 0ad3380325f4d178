"""Formulas with one change each, which a second system has to refuse: some of every kind of change."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import islice
from typing import Any

from semispline.papers.ledger import Formula, mutants
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as figures
from semispline.papers.lin2014.certificates.bezier import patch_cases
from semispline.papers.lin2014.certificates.contact import row_cases
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_3_1
from semispline.papers.recheck import Statement, knots

_EACH = 3


def controls() -> Iterator[Statement]:
    """Yield changed conditions, sums and printed data."""
    for formula, row in ((pr.COND_2_1, 1), (TRUE_3_1, 2)):
        for kind in ("sign", "factor", "exponent", "index"):
            for changed in _of_kind(formula, kind):
                yield from _named(kind, islice(row_cases(changed, "start", row, equal=False), 2))
    for kind in ("limit", "sign", "factor"):
        for changed in _of_kind(pr.EQ_4, kind):
            yield from _named(kind, islice(patch_cases(changed, equal=False), 2))
    vector = figures.VECTORS["fig-5.first"]
    for mutant in (m for m in mutants(vector) if m.kind == "knot"):
        found: Any = mutant.relation.rhs
        yield knots(
            "knot changed in the vector that is printed twice", found, "equal", other=vector.relation.rhs, holds=False
        )
    for mutant in (m for m in mutants(figures.CONE_COUNTS_11) if m.kind == "number"):
        yield knots(
            "number changed in the counts of Fig. 11",
            mutant.relation.rhs,
            "equal",
            other=figures.CONE_COUNTS,
            holds=False,
        )


def _named(kind: str, cases: Iterable[Statement]) -> Iterator[Statement]:
    return (replace(case, label=f"{kind} changed: {case.label}") for case in cases)


def _of_kind(formula: Formula, kind: str) -> Iterator[Formula]:
    found = (m for m in mutants(formula) if m.kind == kind and m.text not in formula.equivalent)
    for mutant in islice(found, _EACH):
        yield Formula(mutant.relation, formula.variables, formula.assumptions)
