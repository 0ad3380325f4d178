"""Blends of edges of faces, free curves too; through bands, and then measured on the faces themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

from semispline.solver.blending import BandContact, BlendResult, Chain, EndFaces, blend, chain
from semispline.solver.errors import ComputationError, ContactError
from semispline.solver.judge import Base, face_shortfalls, measure_face_contact
from semispline.solver.options import BlendOptions, Continuity, named_options
from semispline.solver.topology.bases import EdgeBase, edge_bases, paired_bases
from semispline.solver.topology.edge_limits import default_limits, face_limits
from semispline.solver.topology.face_edges import ResolvedEdge
from semispline.solver.topology.trim_curves import TrimCurve

# What `BandContact` calls the measures of `FaceContact`.
_SHORT = {
    "curvature_jump_relative": "curvature",
    "rate_jump_relative": "rate",
    "second_rate_jump_relative": "second_rate",
}


def blend_edges(
    a: ResolvedEdge, b: ResolvedEdge, options: BlendOptions | None = None, **named: Any
) -> tuple[BlendResult, ...]:
    """Blend an edge of a face with another, of whatever kind: one blend, or one for each part of a free curve.

    A free curve is cut at its corners and where the face's curvature jumps across it.

    Parameters
    ----------
    a, b : ResolvedEdge
        As `resolve_edge` returns them.
    options : BlendOptions, optional
        Or its fields by name, as `blend` has them.

    Returns
    -------
    tuple of BlendResult
        In the order of the parts of a.

    Raises
    ------
    BandError
        A free curve whose face no band meets within its limits.
    EdgeError
        The parts of both edges do not correspond.
    ContactError
        Measured on the true face the contact misses its limits.
    OptionError, ComputationError, FoldError, FileError
        As `blend` and `resolve_edge`.
    """
    said = named_options(options, named)
    pairs = paired_bases(*edge_bases([a, b], said.continuities))
    return tuple(blend_bases(one, other, said, several=len(pairs) > 1) for one, other in pairs)


def blend_bases(
    a: EdgeBase,
    b: EdgeBase,
    options: BlendOptions,
    *,
    several: bool = False,
    ends_on: tuple[EndFaces, EndFaces] | None = None,
) -> BlendResult:
    """Blend two bases, and measure on the true face what a band stands for; errors as `blend_edges`.

    Messages name the parts where there are several. `ends_on` are the faces where a starts and ends, and those of b,
    on which the end curves of the blend are to lie.
    """
    through_band = a.band is not None or b.band is not None
    try:
        # To a band contact is as exact as to any base.
        said = replace(options, limits="exact") if through_band else options
        if ends_on is None:
            result = blend(a.base, b.base, said)
        else:
            result = blend(_ended(a.base, ends_on[0]), _ended(b.base, ends_on[1]), said)
        contacts = [_band_contact(result, side, which, options) for which, side in (("a", a), ("b", b))]
    except ComputationError as error:
        if several:
            raise type(error)(f"{a.name} to {b.name}: {error}") from None
        raise
    return replace(
        result,
        edges=(a.name, b.name),
        options=replace(result.options, limits=_said(options, contacts)),
        band_a=contacts[0],
        band_b=contacts[1],
    )


def _ended(base: Base, ends_on: EndFaces) -> Chain:
    return replace(chain([base]), ends_on=ends_on)


def _said(options: BlendOptions, contacts: Sequence[BandContact | None]) -> Literal["exact", "cad"]:
    """Return the wider limits that were used."""
    if options.limits != "auto":
        return options.limits
    return "cad" if any(x is not None and x.limits == "cad" for x in contacts) else "exact"


def _band_contact(result: BlendResult, side: EdgeBase, which: str, options: BlendOptions) -> BandContact | None:
    """Measure how a blend meets the face of a band, and refuse what misses its limits."""
    band, curve = side.band, side.curve
    if band is None or curve is None:
        return None
    wanted = options.continuities["ab".index(which)]
    own = Base(result.surface, "u0" if which == "a" else "u1")
    order = max(2, int(wanted[1]))
    contact = measure_face_contact(own, curve.free_edge(band.source), order=order)
    kind = default_limits(curve) if options.limits == "auto" else options.limits
    allowed = face_limits(curve, own, kind, length=band.length, smoothed_by=band.smoothed_by, order=order)
    title = curve.name if side.name == curve.word else f"{side.name}, part of {curve.name}"
    for name, value, limit in face_shortfalls(contact, allowed, wanted):
        x, y, z = contact.at[name].point
        raise ContactError(
            f"contact {which}: on {title}, {name} is {value:.3g} at ({x:.6g}, {y:.6g}, {z:.6g}), expected at most "
            f"{limit:.3g} for {wanted} within {kind} limits; {_remedy(curve, kind, wanted)}"
        )
    return BandContact(
        edge=title,
        gap=contact.gap,
        off=contact.off or 0.0,
        angle_degrees=contact.angle_degrees,
        curvature=contact.curvature_jump_relative,
        rate=contact.rate_jump_relative,
        second_rate=contact.second_rate_jump_relative,
        at={_SHORT.get(name, name): place for name, place in contact.at.items()},
        allowed={_SHORT.get(name, name): limit for name, limit in allowed.items()},
        limits=kind,
        source=band.source,
        edge_to_face=band.edge_to_face,
        edge_to_pcurve=band.edge_to_pcurve,
        length=band.length,
        left_out=band.left_out,
        smoothed_by=band.smoothed_by,
        control_points=band.points,
    )


def _remedy(curve: TrimCurve, kind: str, wanted: Continuity) -> str:
    if kind == "exact" and not curve.is_plane:
        return "along a free curve of a face that is no plane contact is within cad limits: leave out exact"
    return "ask for G2" if wanted in ("G3", "G4") else "blend a part of the edge, or another edge"
