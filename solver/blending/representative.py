"""Rational sides: which homogeneous representative of a base near its edge the rows of a blend are built on."""

from __future__ import annotations

from dataclasses import dataclass, replace

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import seam_order
from semispline.solver.blending.conics import Conic, recognised_conic, same_arcs
from semispline.solver.blending.knot_lines import least_continuity
from semispline.solver.blending.ladder import Rung, Window, tamed
from semispline.solver.blending.sides import Side
from semispline.solver.blending.weights import is_separable
from semispline.solver.options import BlendOptions
from semispline.solver.splines import Basis

# Rows that are less smooth along than this in homogeneous coordinates may crease a blend.
_SMOOTH = 2


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
    cure : str or None
        What was done about knots where the rows are rough in homogeneous coordinates.
    """

    rung: str
    degree: int
    ratio: float
    constant: bool
    cure: str | None

    def __str__(self) -> str:
        words = [f"{self.rung}, degree {self.degree}, ratio {self.ratio:.3g}"]
        if not self.constant:
            words.append("they depend on alpha")
        return "; ".join([*words, *([f"cured: {self.cure}"] if self.cure else [])])


def has_free_rows(options: BlendOptions) -> bool:
    """Tell whether a blend has rows that no contact prescribes."""
    return options.middle_curves != 0 or any(int(c[1]) < _SMOOTH for c in options.continuities)


def needs_constant_weights(options: BlendOptions) -> bool:
    """Tell whether row weights must not depend on alpha: energy and free rows are polynomials in it only then."""
    is_linear = options.alpha_v == "linear" or any(isinstance(alpha, tuple) for alpha in options.alphas)
    return is_linear or "energy" in options.alphas or has_free_rows(options)


def smooth_along(a: Side, b: Side, options: BlendOptions) -> tuple[tuple[Side, str | None], tuple[Side, str | None]]:
    """Replace rims that are conics by smooth ones, where rows would crease the blend else; and say so.

    To the order of contact they are the same surfaces.
    """
    rough = [_is_rough(side) for side in (a, b)]
    # A conic without such knots is made smooth too, for both to run alike, where that does not spoil its weights.
    wanted = [
        r or (any(rough) and is_separable(read_rows(side)[..., 3])) for r, side in zip(rough, (a, b), strict=True)
    ]
    of_a, of_b = (
        recognised_conic(read_rows(side), side.along) if w else None for w, side in zip(wanted, (a, b), strict=True)
    )
    if of_a is not None and of_b is not None and same_arcs(of_a, of_b) and not has_free_rows(options):
        return (a, None), (b, None)
    order = max(a.order, b.order)
    first, second = ((s, None) if c is None else _smooth(s, c, order) for s, c in ((a, of_a), (b, of_b)))
    return first, second


def _smooth(side: Side, conic: Conic, order: int) -> tuple[Side, str | None]:
    rows, along = conic.smooth_rows(order)
    if not (rows[0, :, 3] > 0).all():
        return side, None
    return replace(side, rows=rows, along=along), f"circle reparametrised, degree {along.degree}, corresponds by angle"


def _is_rough(side: Side) -> bool:
    # A single line or arc has no knots to be rough at.
    return least_continuity(read_rows(side), side.along, closed=_is_closed(side)) < min(_SMOOTH, side.along.degree)


def tame_side(
    side: Side, cure: str | None, blend_u: Basis, spans: tuple[float, ...], window: Window | None
) -> tuple[Side, Representative]:
    """Return a side whose weights are positive over the window of alpha, or do not depend on it where that is None.

    Parameters
    ----------
    side : Side
    cure : str or None
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
    return tame, Representative(rung.name, rung.degree, rung.ratio, constant, cure)


def read_rows(side: Side) -> FloatArray:
    """Return the rows that contact reads, the second one always."""
    return side.rows[: max(side.order, 1) + 1]


def _is_closed(side: Side) -> bool:
    return seam_order(side.along, read_rows(side), side.largest) >= 0
