"""Which form of a base near its edge the rows of a blend are built on: smooth along, and with tame weights."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import seam_order
from semispline.solver.blending.conics import Conic, recognised_conic, same_arcs
from semispline.solver.blending.jumps import Jump, jumps, smoothed
from semispline.solver.blending.knot_lines import least_continuity
from semispline.solver.blending.ladder import Rung, Window, tamed
from semispline.solver.blending.sides import Side
from semispline.solver.blending.weights import is_separable
from semispline.solver.options import BlendOptions
from semispline.solver.splines import Basis

# Rows that are less smooth along than this in homogeneous coordinates may crease a blend.
_SMOOTH = 2
# Jumps of both sides that agree to this are one.
SAME_JUMP = 1e-9


@dataclass(frozen=True)
class Representative:
    """How a rational side was made fit for a blend.

    Attributes
    ----------
    rung : {"mean", "fitted", "om^(n+1)"}
        What its weights were made tame by: division by their mean, a fitted factor, or the factor that leaves none but
        those of the edge.
    degree : int
        Along the edge.
    ratio : float
        Largest over smallest control weight, whatever alpha may be.
    constant : bool
        The weights of the rows do not depend on alpha.
    """

    rung: str
    degree: int
    ratio: float
    constant: bool

    def __str__(self) -> str:
        depends = "" if self.constant else "; they depend on alpha"
        return f"{self.rung}, degree {self.degree}, ratio {self.ratio:.3g}{depends}"


def has_free_rows(options: BlendOptions) -> bool:
    """Tell whether a blend has rows that no contact prescribes."""
    return options.middle_curves != 0 or any(int(c[1]) < _SMOOTH for c in options.continuities)


def needs_constant_weights(options: BlendOptions) -> bool:
    """Tell whether row weights must not depend on alpha: energy and free rows are polynomials in it only then."""
    is_linear = options.alpha_v == "linear" or any(isinstance(alpha, tuple) for alpha in options.alphas)
    return is_linear or "energy" in options.alphas or has_free_rows(options)


def smooth_along(a: Side, b: Side, options: BlendOptions) -> tuple[tuple[Side, str | None], tuple[Side, str | None]]:
    """Make rows smooth along where they would crease the blend else; and say what was done.

    Rims that are conics are run through by a smooth circle; where all rows of a side share a jump of speed (and of
    weight) at a knot, the spans are scaled by it. To the order of contact they are the same surfaces. What both sides
    share is left, unless there are rows that do not.
    """
    if not (_may_be_rough(a) or _may_be_rough(b)):
        return (a, None), (b, None)
    order, free_rows = max(a.order, b.order), has_free_rows(options)
    of_a, of_b = _conics(a, b)
    if of_a is not None and of_b is not None and same_arcs(of_a, of_b) and not free_rows:
        return (a, None), (b, None)
    first, second = ((s, None) if c is None else _smooth(s, c, order) for s, c in ((a, of_a), (b, of_b)))
    jumps_a, jumps_b = (() if cure else _shared_jumps(side) for side, cure in (first, second))
    if not free_rows and _are_same(jumps_a, jumps_b, a.along, b.along):
        return first, second
    return _even(*first, jumps_a), _even(*second, jumps_b)


def _may_be_rough(side: Side) -> bool:
    """Tell from the knots alone whether rows may be less than C1 somewhere."""
    inner = side.along.knots[side.along.degree + 1 : -side.along.degree - 1]
    full = len(inner) and int(np.unique(inner, return_counts=True)[1].max()) >= side.along.degree
    return bool(full) or (side.is_rational and _is_rough(side)) or _has_corner_at_seam(side)


def _has_corner_at_seam(side: Side) -> bool:
    return seam_order(side.along, read_rows(side), side.largest) == 0


def _is_rough(side: Side) -> bool:
    # A single line or arc has no knots to be rough at.
    return least_continuity(read_rows(side), side.along, closed=_is_closed(side)) < min(_SMOOTH, side.along.degree)


def _conics(a: Side, b: Side) -> tuple[Conic | None, Conic | None]:
    """Return the conics that the rims are, where they are to be made smooth."""
    if not a.is_rational:
        return None, None
    rough = [_is_rough(side) for side in (a, b)]
    # A conic without such knots is made smooth too, for both to run alike, where that does not spoil its weights.
    first, second = (
        recognised_conic(read_rows(side), side.along)
        if own or (any(rough) and is_separable(read_rows(side)[..., 3]))
        else None
        for own, side in zip(rough, (a, b), strict=True)
    )
    return first, second


def _smooth(side: Side, conic: Conic, order: int) -> tuple[Side, str | None]:
    rows, along = conic.smooth_rows(order)
    if not (rows[0, :, 3] > 0).all():
        return side, None
    return replace(side, rows=rows, along=along), f"circle reparametrised, degree {along.degree}, corresponds by angle"


def _shared_jumps(side: Side) -> tuple[Jump, ...]:
    if not _may_be_rough(side):
        return ()
    return jumps(read_rows(side), side.along, side.degree, side.spans, closed=_is_closed(side))


def _are_same(one: tuple[Jump, ...], other: tuple[Jump, ...], a: Basis, b: Basis) -> bool:
    """Tell whether both sides jump alike at the same places."""
    if len(one) != len(other):
        return False
    # Both have one domain.
    length = float(a.knots[-1] - a.knots[0])
    return all(
        x.kind == y.kind == "shared"
        and abs(x.v - y.v) <= SAME_JUMP * length
        and abs(x.speed - y.speed) <= SAME_JUMP * x.speed
        and abs(x.slope - y.slope) * length <= SAME_JUMP
        for x, y in zip(one, other, strict=True)
    )


def _even(side: Side, cure: str | None, found: tuple[Jump, ...]) -> tuple[Side, str | None]:
    """Scale the spans of a side by its jumps of speed."""
    if cure is not None or not any(jump.kind == "shared" for jump in found):
        return side, cure
    rows, along = smoothed(read_rows(side), side.along, found, closed=_is_closed(side))
    if along is side.along:
        return side, None
    places = ", ".join(f"{jump.v:.5g}" for jump in found if jump.kind == "shared")
    return replace(side, rows=rows, along=along), f"spans scaled by the jump of speed at v = {places}"


def tame_side(
    side: Side, blend_u: Basis, spans: tuple[float, ...], window: Window | None
) -> tuple[Side, Representative]:
    """Return a side whose weights are positive over the window of alpha, or do not depend on it where that is None.

    Parameters
    ----------
    side : Side
    blend_u : Basis
    spans : tuple of float
        Distances of the nearest knots of U from the contact.
    window : Window or None
    """
    found = tamed(
        read_rows(side),
        side.along,
        side.degree,
        side.spans,
        order=side.order,
        blend_degree=blend_u.degree,
        blend_spans=spans,
        window=window,
        closed=_is_closed(side),
    )
    tame = replace(side, rows=found.rows, along=found.along, degree=found.degree)
    rung: Rung = found.rung
    constant = rung.name == "om^(n+1)" or is_separable(found.rows[: side.order + 1, :, 3])
    return tame, Representative(rung.name, rung.degree, rung.ratio, constant)


def read_rows(side: Side) -> FloatArray:
    """Return the rows that contact reads, the second one always."""
    return side.rows[: max(side.order, 1) + 1]


def _is_closed(side: Side) -> bool:
    return seam_order(side.along, read_rows(side), side.largest) >= 0
