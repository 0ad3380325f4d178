"""Rational sides: which homogeneous representative of a base near its edge the rows of a blend are built on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.blending.sides import Side
from semispline.solver.blending.weights import is_separable, normalised_rows
from semispline.solver.options import BlendOptions


@dataclass(frozen=True)
class Representative:
    """How the weights of a side were made tame.

    Attributes
    ----------
    rung : {"mean"}
        "mean": divided by the mean weight.
    ratio : float
        Largest over smallest weight of the prescribed rows.
    constant : bool
        The weights of the prescribed rows do not depend on alpha.
    """

    rung: str
    ratio: float
    constant: bool


def needs_constant_weights(options: BlendOptions) -> bool:
    """Tell whether a blend needs row weights that do not depend on alpha: for its energy, or for its free rows."""
    chosen = options.decided()
    return "energy" in chosen.alphas or chosen.middle_curves != 0 or any(int(c[1]) < 2 for c in chosen.continuities)


def represented(side: Side, *, constant: bool) -> tuple[Side, Representative | None]:
    """Return a side with tame weights; to the order of contact it is the same surface. None for polynomial sides."""
    if not side.is_rational:
        return side, None
    count = max(side.order, 1) + 1
    rows, degree = normalised_rows(side.rows[:count], side.along, side.degree, side.spans)
    constant = is_separable(rows[: side.order + 1, :, 3])
    weights = rows[0, :, 3]
    tame = replace(side, rows=rows, degree=degree)
    return tame, Representative("mean", float(weights.max() / weights.min()), constant)
