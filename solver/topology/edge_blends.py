"""Blends of edges of faces, free curves too; through bands, and then measured on the faces themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

from semispline.solver.blending import BandContact, BlendResult, Chain, ChainContact, EndFaces, blend, chain
from semispline.solver.errors import ComputationError, ContactError, EdgeError
from semispline.solver.judge import (
    Base,
    Contact,
    cad_measures,
    edge_length,
    face_shortfalls,
    measure_face_contact,
)
from semispline.solver.options import BlendOptions, Continuity, named_options
from semispline.solver.topology.bands import Band
from semispline.solver.topology.bases import edge_bases, paired_bases
from semispline.solver.topology.chain_edges import ResolvedChain
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_limits import default_limits, face_limits
from semispline.solver.topology.face_edges import ResolvedEdge, split_part
from semispline.solver.topology.trim_curves import TrimCurve

# What `BandContact` calls the measures of `FaceContact`.
_SHORT = {
    "curvature_jump_relative": "curvature",
    "rate_jump_relative": "rate",
    "second_rate_jump_relative": "second_rate",
}


def blend_edges(
    a: ResolvedEdge | ResolvedChain, b: ResolvedEdge | ResolvedChain, options: BlendOptions | None = None, **named: Any
) -> tuple[BlendResult, ...]:
    """Blend an edge of a face with another, of whatever kind: one blend, or one for each part of a free curve.

    A free curve is cut at its corners and where the face's curvature jumps across it. Edges that run end to end are
    one base.

    Parameters
    ----------
    a, b : ResolvedEdge or ResolvedChain
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
    try:
        said = _for_bands(options, [*a.parts, *b.parts], chained=bool(a.members or b.members))
        if ends_on is None:
            result = blend(a.base, b.base, said)
        else:
            result = blend(_ended(a.base, ends_on[0]), _ended(b.base, ends_on[1]), said)
        band_a, band_b = (
            None if side.band is None else _band_contact(result, side, side.band, edge, options)
            for side, edge in ((a, "u0"), (b, "u1"))
        )
        chain_a, chain_b = (
            None if met is None else _with_bands(result, met, side, edge, options)
            for met, side, edge in ((result.chain_a, a, "u0"), (result.chain_b, b, "u1"))
        )
        if options.limits == "cad" and not any((a.band, b.band, a.members, b.members)):
            result = replace(
                result,
                contact_a=_in_unit(result.contact_a, a, "a"),
                contact_b=_in_unit(result.contact_b, b, "b"),
            )
    except ComputationError as error:
        if several:
            raise type(error)(f"{a.name} to {b.name}: {error}") from None
        raise
    except EdgeError as error:
        if not (a.members or b.members):
            raise
        raise EdgeError(f"{a.name} to {b.name}: {error}; blend the edges one by one") from None
    contacts = [band_a, band_b, *(face.band for met in (chain_a, chain_b) if met is not None for face in met.faces)]
    return replace(
        result,
        edges=(a.name, b.name),
        options=replace(result.options, limits=_said(options, contacts)),
        band_a=band_a,
        band_b=band_b,
        chain_a=chain_a,
        chain_b=chain_b,
    )


def _for_bands(options: BlendOptions, parts: Sequence[EdgeBase], *, chained: bool) -> BlendOptions:
    """Return the options for a blend with bands: to these contact is as exact as to any base.

    Bands of one chain meet within the limits to which they were fitted.
    """
    bands = [part.band for part in parts if part.band is not None]
    if not bands:
        return options
    return replace(options, limits="cad" if chained and not all(band.is_plane for band in bands) else "auto")


def _with_bands(
    result: BlendResult, met: ChainContact, side: EdgeBase, edge: str, options: BlendOptions
) -> ChainContact:
    """Return how a blend meets a chain, with the faces of bands measured themselves."""
    parts = {part.name: part for part in side.parts}
    faces = []
    for face in met.faces:
        part, (low, high) = parts.get(face.edge, side), face.range
        if part.band is None:
            faces.append(face)
        else:
            band = _band_contact(result, part, part.band, f"{edge}[{low!r},{high!r}]", options)
            faces.append(replace(face, band=band))
    return replace(met, faces=tuple(faces))


def _in_unit(contact: Contact, side: EdgeBase, which: str) -> Contact:
    """Return a contact within cad limits whose gap is held to 0.001 mm too: `blend` knows of no unit."""
    (base,) = side.bases
    length = edge_length(base)
    wide, gap = cad_measures(length)["gap"], cad_measures(length, side.millimetres)["gap"]
    if contact.allowed["gap"] > wide or gap == wide:
        return contact
    if not contact.gap <= gap:
        raise ContactError(f"contact {which}: gap is {contact.gap:.3g}, expected at most {gap:.3g} within cad limits")
    return replace(contact, allowed=contact.allowed | {"gap": gap})


def _ended(base: Base | Chain, ends_on: EndFaces) -> Base | Chain:
    if ends_on == (None, None):
        return base
    return replace(base if isinstance(base, Chain) else chain([base]), ends_on=ends_on)


def _said(options: BlendOptions, contacts: Sequence[BandContact | None]) -> Literal["exact", "cad"]:
    """Return the wider limits that were used."""
    if options.limits != "auto":
        return options.limits
    return "cad" if any(x is not None and x.limits == "cad" for x in contacts) else "exact"


def _band_contact(result: BlendResult, side: EdgeBase, band: Band, edge: str, options: BlendOptions) -> BandContact:
    """Measure how an edge of a blend meets the face of a band, and refuse what misses its limits."""
    curve = side.curve
    assert curve is not None
    which = "a" if edge.startswith("u0") else "b"
    wanted = options.continuities["ab".index(which)]
    own = Base(result.surface, edge)
    order = max(2, int(wanted[1]))
    contact = measure_face_contact(own, curve.free_edge(band.source), order=order)
    kind = default_limits(curve) if options.limits == "auto" else options.limits
    allowed = face_limits(curve, own, kind, length=band.length, smoothed_by=band.smoothed_by, order=order)
    title = curve.name if split_part(side.name)[1] is None else f"{side.name}, part of {curve.name}"
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
