"""Curves joined end to end."""

from __future__ import annotations

from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import part
from semispline.papers.primer.checks.curves import column
from semispline.papers.primer.checks.following import of_changed
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import definition, equations, holds

_A, _B = (column(*(letter("polybezier.2", f"{name}_{axis}") for axis in "xy")) for name in "AB")
_MIDDLE = sp.MatrixSymbol("middle", 2, 1)


def _middle(relation: Any) -> Any:
    return sp.Eq(_MIDDLE, (relation.rhs + _A) / 2, evaluate=False)


_MIRROR, _SAME = equations("polybezier.2")

CLAIMS = (
    definition(
        "polybezier.1",
        "The derivative at the end of a curve is that at the start of the next one.",
        "how two curves are to be joined",
    ),
    holds(
        "polybezier.2",
        "A point mirrored in another one: as far beyond it, twice the one less the other.",
        part(of_changed(identity(where={_MIDDLE: _B}), _middle, "the middle between both is the mirror"), _MIRROR),
        part(identity(), _SAME),
    ),
)
