"""Measured continuity along a shared edge, by the de Boor referee alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError, OptionError
from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.contact import Contact
from semispline.solver.judge.correspondence import Correspondence, correspond, corresponding
from semispline.solver.judge.de_boor import edge_curves
from semispline.solver.judge.edge_normals import places_without_normal
from semispline.solver.judge.edge_samples import Edges, Samples, Worst, most
from semispline.solver.judge.limits import CEILINGS, GAP_LIMIT, allowed_measures
from semispline.solver.judge.pairs import Pairs, foot_pairs, places_between
from semispline.solver.judge.rounding import rounding_causes
from semispline.solver.options import Flip
from semispline.solver.scalars import whole_number
from semispline.solver.splines import Surface, bounding_box

# A curvature below this, over the size of the model, is none; of its rates, over the square and the cube of the size.
_STRAIGHT = 1e-3
# Edges are one curve with two parametrisations where feet remove a gap, or leave no more than this part of it.
_REMOVED = 1e-3
# Measures of which rounding may be looked at, as `Samples` numbers them; at so many of the worst samples of each, and
# as many others. Floating values elsewhere may be so many times as far off as there.
_KINDS = {
    "angle_degrees": 1,
    "curvature_jump_relative": 2,
    "rate_jump_relative": 3,
    "second_rate_jump_relative": 4,
}
_LOOKED_AT, _SURELY = 8, 10.0


def measure_contact(
    a: Base, b: Base, flip: Flip = "auto", correspondence: Correspondence | None = None, order: int = 2
) -> Contact:
    """Measure how edge a and edge b meet.

    Parameters along the edges correspond affinely; where that leaves a gap, and the edges are one curve all the same,
    each point corresponds to its foot on the other edge. The worst is sought between samples too.

    Parameters
    ----------
    a, b : Base
    flip : {"auto", "yes", "no"}
        Whether the edges run in opposite directions; "auto" takes the closer way.
    correspondence : Correspondence, optional
        How the edges correspond, where that is known.
    order : {2, 3, 4}
        Up to which order of contact to measure: 3 adds the rate of curvature, 4 its second rate.

    Returns
    -------
    Contact

    Raises
    ------
    EdgeError
        `flip` is not one of auto, yes, no; or both surfaces are one point.
    OptionError
        An order that is not measured.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> left = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> right = BSplineSurface(1, 1, k, k, [[[1, 0, 0], [1, 1, 0]], [[2, 0, 1], [2, 1, 1]]])
    >>> round(measure_contact(Base(left, "u1"), Base(right, "u0")).angle_degrees, 12)
    45.0
    """
    if whole_number(order, "order", 2, OptionError) > 4:
        raise OptionError(f"order: found {order!r}, expected 2, 3 or 4")
    size = model_size(a.surface, b.surface)
    if not size > 0:
        raise EdgeError("surfaces: all control points are one point, expected surfaces")
    matched = correspondence or correspond(a, b, flip)
    # Far from the origin each operation would round by the distance, and hide what the surfaces themselves do.
    edges = Edges(a, b, matched, local_origin(a.surface, b.surface), order)
    pairs, sampled = _paired(edges, size)
    found = _with_worst_between(edges, pairs, sampled, edges.noise_of_gap)
    result = _contact(edges, pairs, sampled, found, size)
    hidden = [
        name
        for name in _KINDS
        if name in result.rounding
        and result.rounding[name] > CEILINGS[name][1]
        # What is more than rounding needs no second look.
        and getattr(result, name) <= result.allowed[name]
    ]
    # The bound is wide where weights are uneven; far from the origin it is what the stored points may be off by.
    if not hidden or (causes := rounding_causes(a, b, order)).by_weights <= causes.by_distance:
        return result
    return _told(edges, pairs, found, result, hidden)


def _paired(edges: Edges, size: float) -> tuple[Pairs, Samples]:
    """Return parameters that belong together, and what is measured there."""
    affine = edges.affine_pairs()
    found = edges.measured(affine.s_a, affine.s_b)
    worst_gap, allowed = float(found.values[0].max()), GAP_LIMIT * size + edges.noise_of_gap
    if worst_gap > allowed:
        # Perhaps one curve with two parametrisations.
        feet = edges.foot_pairs(max(allowed, _REMOVED * worst_gap))
        if feet is not None:
            return feet, edges.measured(feet.s_a, feet.s_b, feet.pace)
    return affine, found


def _contact(edges: Edges, pairs: Pairs, sampled: Samples, found: Samples, size: float) -> Contact:
    """Put together what was measured: residuals at the samples, all else between them too."""
    noises = [noise.derivatives[:, 0].tolist() for noise in edges.noises]
    (c1, c2), (first, second) = sampled.differences, sampled.derivatives
    worst = [found.worst(k, edges.origin) for k in range(len(found.values))]
    gap, angle, jump = worst[:3]
    largest = max(found.curvature, _STRAIGHT / size)
    # Flat: what bends by the size of the model is the measure; and nearly so, as of curvatures.
    bent = first * first / size
    second = bent if second <= noises[0][2] + noises[1][2] else max(second, _STRAIGHT * bent)
    rounding = {
        "gap": edges.noise_of_gap,
        "angle_degrees": float(np.degrees(found.noises[0])),
        "curvature_jump_relative": found.noises[1] / largest,
        "c1_residual": _over(noises[0][1] + noises[1][1], first),
        "c2_residual": _over(noises[0][2] + noises[1][2], second),
    }
    rates, rates_rounding = _rate_measures(worst[3:], found, size)
    rounding |= rates_rounding
    return Contact(
        gap=gap.value,
        angle_degrees=angle.value,
        curvature_jump=jump.value,
        curvature_jump_relative=jump.value / largest,
        c1_residual=_over(c1, first),
        c2_residual=_over(c2, second),
        size=size,
        rounding=rounding,
        allowed=allowed_measures(size, rounding),
        no_normal=(*places_without_normal(edges.a, "a"), *places_without_normal(edges.b, "b")),
        gap_at=gap.place,
        angle_at=angle.place,
        curvature_at=jump.place,
        flipped=edges.matched.flipped,
        shift=edges.matched.shift,
        corresponds=pairs.corresponds,
        **rates,
    )


def _told(edges: Edges, pairs: Pairs, found: Samples, result: Contact, hidden: Sequence[str]) -> Contact:
    """Return the contact with the rounding of hidden measures as it is, where precise values are within the limits.

    The bound on rounding supposes the worst everywhere. At the samples where a measure is largest, and at some others,
    derivatives to many digits show what the surfaces as they are stored do: where that is within the limit itself,
    with nothing allowed for rounding, it is what counts, and floating values may differ from it by what they do there.
    """
    kinds = [_KINDS[name] for name in hidden]
    # Between samples stands only what is more than rounding.
    sampled = np.flatnonzero(np.isfinite(found.values[kinds]).all(axis=0))
    worst = np.argsort(-found.values[kinds][:, sampled], axis=1)[:, :_LOOKED_AT].ravel()
    spread = np.linspace(0, len(sampled) - 1, _LOOKED_AT).astype(int)
    chosen = sampled[np.unique(np.concatenate([worst, spread]))]
    s_a = found.s_a[chosen]
    precise = edges.measured_precisely(s_a, pairs.along_b(s_a), pairs.pace)
    rounding, limits = dict(result.rounding), allowed_measures(result.size, dict.fromkeys(hidden, 0.0))
    for name, kind in zip(hidden, kinds, strict=True):
        # Angles are degrees and their noise is radians; jumps are absolute, and the measure is relative.
        unit = result.rounding[name] / found.noises[kind - 1]
        of_values, left = (1.0 if name == "angle_degrees" else unit), precise.noises[kind - 1] * unit
        values, floating = precise.values[kind] * of_values, found.values[kind, chosen] * of_values
        if values.max() + left <= limits[name]:
            rounding[name] = _SURELY * float(np.abs(values - floating).max() + left)
    return replace(result, rounding=rounding, allowed=allowed_measures(result.size, rounding))


def corresponding_points(a: Base, b: Base, matched: Correspondence, s: FloatArray) -> FloatArray:
    """Return the parameters along edge b that belong to `s` along edge a as `measure_contact` has it, by feet too."""
    contact = measure_contact(a, b, correspondence=matched)
    if contact.corresponds == "affine":
        return corresponding(a, b, matched, s)
    curves = tuple(edge_curves(base.surface, base.side, 1, local_origin(a.surface, b.surface)) for base in (a, b))
    pairs = foot_pairs(a, b, matched, (curves[0], curves[1]), 2 * max(contact.gap, contact.allowed["gap"]))
    assert pairs is not None
    return pairs.along_b(s)


def _with_worst_between(edges: Edges, pairs: Pairs, found: Samples, of_gap: float) -> Samples:
    """Return the samples with the worst places between them, for values that are more than rounding."""
    noises = (of_gap, float(np.degrees(found.noises[0])), *found.noises[1:])
    telling = [k for k, noise in enumerate(noises) if most(found.values[k]) > noise]
    if not telling:
        return found

    def values(s_a: FloatArray) -> FloatArray:
        return edges.values(s_a, pairs.along_b(s_a), telling)

    s_a = places_between(values, found.s_a, found.values[telling], pairs.breaks)
    if not len(s_a):
        return found
    more = edges.measured(s_a, pairs.along_b(s_a), pairs.pace)
    if not np.isfinite(more.values).all():
        # Beside a place without a normal.
        return found
    # What is rounding stays as it was sampled.
    worse = np.full_like(more.values, -np.inf)
    worse[telling] = more.values[telling]
    return replace(Samples.joined([found, replace(more, values=worse)]), noises=found.noises)


def _rate_measures(worst: Sequence[Worst], found: Samples, size: float) -> tuple[dict[str, Any], dict[str, float]]:
    """Return what `Contact` holds of the rates of curvature, and what rounding may do to it.

    What bends along the edge counts too: a pipe is straight across its rim, and a jump is small or large beside its
    radius, not beside its length.
    """
    result: dict[str, Any] = {}
    rounding = {}
    for name, power, jump, largest, noise in zip(
        ("rate", "second_rate"), (2, 3), worst, found.rates, found.noises[2:], strict=False
    ):
        scale = max(largest, found.bend**power, _STRAIGHT / size**power)
        result |= {f"{name}_jump": jump.value, f"{name}_jump_relative": jump.value / scale, f"{name}_at": jump.place}
        rounding[f"{name}_jump_relative"] = noise / scale
    return result, rounding


def model_size(*surfaces: Surface) -> float:
    """Return the largest extent of the control points of all surfaces, model units."""
    boxes = np.stack([bounding_box(surface) for surface in surfaces])
    return float((boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)).max())


def _over(value: float, largest: float) -> float:
    """Return a value over a derivative; where both are zero nothing is known of it, and that is left to rounding."""
    if largest > 0:
        return value / largest
    return 0.0 if value == 0 else np.inf
