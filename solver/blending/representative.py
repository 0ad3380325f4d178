"""Which form of a base near its edge the rows of a blend are built on: smooth along, and with tame weights."""

from __future__ import annotations

from dataclasses import dataclass, replace

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import seam_order
from semispline.solver.blending.conics import recognised_conic, same_arcs
from semispline.solver.blending.cures import Cure, CuredRows, cured_rows
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


def smooth_along(a: Side, b: Side, options: BlendOptions) -> tuple[tuple[Side, Cure | None], tuple[Side, Cure | None]]:
    """Make rows smooth along where they would crease the blend else; and say what was done.

    To the order of contact they are the same surfaces. What both sides share is left, unless there are rows that do
    not share it.
    """
    if a.keeps_lines and b.keeps_lines:
        return (a, a.cure), (b, b.cure)
    return smooth_sides(a, b, shared=not has_free_rows(options))


def smooth_sides(a: Side, b: Side, *, shared: bool) -> tuple[tuple[Side, Cure | None], tuple[Side, Cure | None]]:
    """As `smooth_along`; `shared` says whether what both sides share may stay."""
    order = max(a.order, b.order)
    found_a, found_b = (_cured(side, order) for side in (a, b))
    if found_a.cure == found_b.cure == "none" or (shared and _jump_alike(a, found_a, found_b)):
        return (a, _as_found(found_a)), (b, _as_found(found_b))
    # A conic without such knots is made smooth too, for both to run alike, where that does not spoil its weights.
    if a.is_rational:
        found_a = _as_the_other(a, found_a, found_b, order)
        found_b = _as_the_other(b, found_b, found_a, order)
    by_angle = found_a.cure == found_b.cure == "conic"
    return _with_cure(a, found_a, by_angle), _with_cure(b, found_b, by_angle)


def _cured(side: Side, order: int) -> CuredRows:
    found = cured_rows(
        read_rows(side),
        side.along,
        side.degree,
        side.spans,
        smoothness=order,
        closed=_is_closed(side),
        largest=side.largest,
    )
    if found.cure == "slopes" and side.continuity[0] == "C":
        # Slopes bend w(u, v), which has to be u.
        return replace(found, rows=read_rows(side), along=side.along, degree=side.degree, cure="none", left=found.found)
    return found


def _jump_alike(a: Side, found_a: CuredRows, found_b: CuredRows) -> bool:
    """Tell whether both sides jump by the same factors at the same places: then no row differs, and no crease is."""
    if found_a.conic is not None and found_b.conic is not None:
        return same_arcs(found_a.conic, found_b.conic)
    if len(found_a.found) != len(found_b.found):
        return False
    # Both have one domain.
    length = float(a.along.knots[-1] - a.along.knots[0])
    return all(
        x.kind == y.kind == "shared"
        and abs(x.v - y.v) <= SAME_JUMP * length
        and abs(x.speed - y.speed) <= SAME_JUMP * x.speed
        and abs(x.slope - y.slope) * length <= SAME_JUMP
        for x, y in zip(found_a.found, found_b.found, strict=True)
    )


def _as_the_other(side: Side, found: CuredRows, other: CuredRows, order: int) -> CuredRows:
    if found.cure != "none" or other.cure != "conic" or not is_separable(read_rows(side)[..., 3]):
        return found
    conic = recognised_conic(read_rows(side), side.along)
    if conic is None or (smooth := conic.cured_rows(order)) is None:
        return found
    return replace(found, rows=smooth[0], along=smooth[1], cure="conic", conic=conic)


def _as_found(found: CuredRows) -> Cure | None:
    """Return what is said of a side that stays as it is: lines at which the base itself is creased."""
    left = tuple(jump for jump in found.found if jump.kind != "shared")
    return Cure("none", "", left) if left else None


def _with_cure(side: Side, found: CuredRows, by_angle: bool) -> tuple[Side, Cure | None]:
    """Return the side with its cured rows; circles of both sides run by angle, one alone by its own parameter."""
    if found.cure == "none":
        return side, _as_found(found)
    places = ", ".join(f"{jump.v:.5g}" for jump in found.found if jump not in found.left)
    kind = "conic" if found.conic is None else found.conic.kind
    words = {
        "conic": f"{kind} reparametrised, degree {found.along.degree}"
        + ", corresponds by angle" * (by_angle and kind == "circle"),
        "spans": f"spans scaled by the jump of speed at v = {places}",
        "slopes": f"G1 at v = {places}, closed by slopes of the reparametrisation",
    }[found.cure]
    smooth = replace(side, rows=found.rows, along=found.along, degree=found.degree)
    return smooth, Cure(found.cure, words, found.left)


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
