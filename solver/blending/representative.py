"""Rational sides: which homogeneous representative of a base near its edge the rows of a blend are built on."""

from __future__ import annotations

from dataclasses import dataclass, replace

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import seam_order
from semispline.solver.blending.conics import Conic, recognised_conic, same_arcs
from semispline.solver.blending.knot_lines import least_continuity
from semispline.solver.blending.sides import Side, of_one_degree
from semispline.solver.blending.weights import is_separable, normalised_rows
from semispline.solver.options import BlendOptions

# Rows that are less smooth along than this in homogeneous coordinates may crease a blend.
_SMOOTH = 2


@dataclass(frozen=True)
class Representative:
    """How a rational side was made fit for a blend.

    Attributes
    ----------
    rung : {"mean"}
        "mean": divided by the mean weight.
    ratio : float
        Largest over smallest weight of the contact curve.
    constant : bool
        The weights of the prescribed rows do not depend on alpha.
    cure : str or None
        What was done about knots where the rows are rough in homogeneous coordinates.
    """

    rung: str
    ratio: float
    constant: bool
    cure: str | None

    def __str__(self) -> str:
        words = [f"{self.rung}, ratio {self.ratio:.3g}"]
        if not self.constant:
            words.append("not certified: they depend on alpha")
        return "; ".join([*words, *([f"cured: {self.cure}"] if self.cure else [])])


def has_free_rows(options: BlendOptions) -> bool:
    """Tell whether a blend may have rows that no contact prescribes."""
    chosen = options.decided()
    return chosen.middle_curves != 0 or any(int(c[1]) < 2 for c in chosen.continuities)


def represented(a: Side, b: Side, options: BlendOptions) -> tuple[tuple[Side, Side], tuple[Representative | None, ...]]:
    """Return both sides with tame weights, smooth along where they can be, and of one degree along.

    To the order of contact they are the same surfaces; polynomial sides stay as they are.
    """
    if not a.is_rational:
        return of_one_degree(a, b), (None, None)
    cured = _cured(a, b, free_rows=has_free_rows(options))
    found = [_tame(side, cure) for side, cure in cured]
    return of_one_degree(found[0][0], found[1][0]), tuple(report for _, report in found)


def _cured(a: Side, b: Side, *, free_rows: bool) -> list[tuple[Side, str | None]]:
    """Replace rims that are conics by smooth ones, where rows would crease the blend else."""
    rough = [_is_rough(side) for side in (a, b)]
    of_a, of_b = (recognised_conic(_read(side), side.along) if any(rough) else None for side in (a, b))
    if of_a is not None and of_b is not None and same_arcs(of_a, of_b) and not free_rows:
        return [(a, None), (b, None)]
    order = max(a.order, b.order)
    return [(side, None) if conic is None else _smooth(side, conic, order) for side, conic in ((a, of_a), (b, of_b))]


def _smooth(side: Side, conic: Conic, order: int) -> tuple[Side, str | None]:
    rows, along = conic.smooth_rows(order)
    if not (rows[0, :, 3] > 0).all():
        return side, None
    return replace(side, rows=rows, along=along), f"circle reparametrised, degree {along.degree}, corresponds by angle"


def _is_rough(side: Side) -> bool:
    rows = _read(side)
    closed = seam_order(side.along, rows, side.largest) >= 0
    # Less than its own degree: a single line or arc has no knots to be rough at.
    return least_continuity(rows, side.along, closed=closed) < min(_SMOOTH, side.along.degree)


def _tame(side: Side, cure: str | None) -> tuple[Side, Representative]:
    rows, degree = normalised_rows(_read(side), side.along, side.degree, side.spans)
    constant = is_separable(rows[: side.order + 1, :, 3])
    weights = rows[0, :, 3]
    ratio = float(weights.max() / weights.min())
    return replace(side, rows=rows, degree=degree), Representative("mean", ratio, constant, cure)


def _read(side: Side) -> FloatArray:
    """Return the rows that contact reads, the second one always."""
    return side.rows[: max(side.order, 1) + 1]
