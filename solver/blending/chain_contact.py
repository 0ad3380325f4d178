"""How a blend meets each face of a chain: measured on the faces themselves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.band_contact import BandContact
from semispline.solver.blending.chain_coefficients import CLOSED, Joint
from semispline.solver.blending.chain_joints import KINK
from semispline.solver.blending.chains import Chain, Strip
from semispline.solver.errors import ContactError
from semispline.solver.judge import (
    Base,
    Contact,
    Crease,
    edge_length,
    in_cad_limits,
    is_closed,
    measure_contact,
    shortfalls,
    untold,
)
from semispline.solver.options import Continuity, Limits
from semispline.solver.splines import (
    BSplineCurve,
    NaturalEdge,
    SemiStructuredSurface,
    boundary_curve,
    bounding_box,
    closest_point,
)

# Of the size of the blend: a line that ends nearer to a joint ends there.
_AT_A_JOINT = 1e-6
# Of the range along the contact: shorter stretches are none.
_SHORT = 1e-7
# Of it too: a joint of faces that meet within a tolerance lies so near to the knot that it became.
_NEAR_A_KNOT = 1e-6


@dataclass(frozen=True)
class FaceOfChain:
    """How a blend meets one face of a chain.

    Attributes
    ----------
    edge : str
    range : (float, float)
        Where along the blend's edge, in its own parameter.
    contact : Contact
        Of the face, or of the band along a free curve of it, as a, and the blend.
    band : BandContact or None
        How the blend meets the face of that band.
    """

    edge: str
    range: tuple[float, float]
    contact: Contact
    band: BandContact | None = None


@dataclass(frozen=True)
class ChainContact:
    """How a blend meets a chain.

    Attributes
    ----------
    edges : tuple of str
    faces : tuple of FaceOfChain
        In the order of the blend's parameter; a face across whose edge the blend's seam runs is there twice.
    joints : tuple of Joint
    places : tuple of float
        Where along the blend's edge, in its own parameter, each of them lies.
    closed : bool
    limits : {"exact", "cad"}
        Which the contact was held to.
    degree, control_points : int
        Along, of the base that the chain makes.
    fades : bool
        The other side does not have its corners: their creases fade out on the way there.
    """

    edges: tuple[str, ...]
    faces: tuple[FaceOfChain, ...]
    joints: tuple[Joint, ...]
    places: tuple[float, ...]
    closed: bool
    limits: Limits
    degree: int
    control_points: int
    fades: bool = False

    def __str__(self) -> str:
        smooth = sum(joint.kind == "smooth" for joint in self.joints)
        kind = "closed" if self.closed else "open"
        return (
            f"chain of {len(self.edges)} edges, {kind}, C1 at {smooth} of {len(self.joints)} joints; degree "
            f"{self.degree}, {self.control_points} points"
        )

    def notes(self) -> tuple[str, ...]:
        """Return what there is to say of the joints."""
        return tuple(note for k, joint in enumerate(self.joints) for note in _notes(k, joint, fades=self.fades))

    @property
    def corners(self) -> int:
        """How many corners it has."""
        return sum(joint.kind == "corner" for joint in self.joints)

    def worst(self, name: str) -> float:
        """Return the largest of a measure of `Contact` over the faces."""
        return max(float(getattr(face.contact, name)) for face in self.faces)


def _notes(k: int, joint: Joint, *, fades: bool) -> Iterator[str]:
    x, y, z = joint.point
    title = f"joint {k} at ({x:.5g}, {y:.5g}, {z:.5g})"
    if joint.kind == "corner":
        ends = ", the other side has none there: it fades out" if fades else ""
        yield f"{title}: corner of {joint.turn_degrees:.3g} degrees, the blend is split there{ends}"
    elif joint.kind == "creased":
        sharp = max(joint.turn_degrees, joint.crease_degrees)
        yield f"{title}: the faces are creased by {sharp:.2g} degrees, the blend inherits it"
    if joint.kind != "corner" and joint.bends:
        before, after = joint.curvatures
        yield f"{title}: curvature along the contact jumps from {before:.4g} to {after:.4g}, the blend inherits it"
    if joint.moved:
        yield f"{title}: the edges meet within {joint.moved:.2g}, each was moved by half of it"
    if joint.apart > CLOSED:
        yield f"{title}: the faces leave the contact {joint.apart:.2g} of their speed apart, the blend takes the mean"


def chain_contact(
    chain: Chain,
    strip: Strip,
    surface: SemiStructuredSurface,
    which: str,
    wanted: Continuity,
    limits: Limits | Literal["auto"],
    whole: Contact,
) -> ChainContact:
    """Measure how a blend meets each face of a chain, and refuse what misses its limits.

    Parameters
    ----------
    chain : Chain
    strip : Strip
        The base that it was blended as.
    surface : SemiStructuredSurface
        The blend: at u = 0 for `which` "a", at u = 1 for "b".
    which : {"a", "b"}
    wanted : str
    limits : {"auto", "exact", "cad"}
        "auto" is exact, but where the faces meet within a tolerance only.
    whole : Contact
        Of the strip and the blend: it says what rounding does where faces are small beside the chain.

    Raises
    ------
    ContactError
        Naming the edge.
    """
    order = max(2, int(wanted[1]))
    edge_of_blend: NaturalEdge = "u0" if which == "a" else "u1"
    curve = boundary_curve(surface, edge_of_blend)
    joints = tuple(joint for joint in strip.joints if joint is not None)
    places = tuple(_at_a_knot(_parameter(curve, joint.point), curve) for joint in joints)
    exact = all(joint.is_exact for joint in joints)
    kind: Limits = "exact" if exact and limits == "auto" else "cad" if limits == "auto" else limits
    found = []
    for edge, span, face in stretches_along(chain, curve, places):
        own = Base(surface, f"{edge_of_blend}[{span[0]!r},{span[1]!r}]")
        contact = measure_contact(face, own, flip="auto", order=order)
        if kind == "cad":
            contact = in_cad_limits(contact, edge_length(face))
        name = chain.names[edge]
        misses = [f"{measure} is {value:.3g}, expected at most {limit:.3g}" for measure, value, limit in
                  shortfalls(contact, wanted)]  # fmt: skip
        if lacking := [*untold(contact, wanted), *misses]:
            raise ContactError(
                f"contact {which}: edge {edge} ({name}) of the chain: {'; '.join(lacking)} for {wanted}"
                + _remedy(whole, wanted)
            )
        found.append(FaceOfChain(name, span, contact))
    along = strip.surface
    return ChainContact(
        edges=chain.names,
        faces=tuple(found),
        joints=joints,
        places=places,
        closed=chain.closed,
        limits=kind,
        degree=along.degree_v,
        control_points=along.control_points.shape[1],
    )


def _remedy(whole: Contact, wanted: Continuity) -> str:
    hidden = untold(whole, wanted)
    if not hidden:
        return ""
    return f"; over the whole chain {hidden[0]}: ask for a lower continuity, or take faces that reach further inwards"


def told_apart(
    creases: Sequence[Crease], surface: SemiStructuredSurface, joints: Sequence[Joint]
) -> tuple[list[Crease], list[Crease]]:
    """Return the blend's own creases, and those that lie at a joint where faces, or the contact, are no smoother."""
    within = _AT_A_JOINT * float(np.ptp(bounding_box(surface), axis=0).max())
    rough = [joint.point for joint in joints if joint.kind != "smooth"]
    bent = [joint.point for joint in joints if joint.kind == "smooth" and joint.bends]

    def lies_at(crease: Crease, points: list[tuple[float, float, float]]) -> bool:
        if crease.parameter == "u" or not points:
            return False
        ends = surface.evaluate(np.array(surface.domain[0]), np.full(2, crease.at))
        return bool(np.linalg.norm(np.array(points)[:, None] - ends, axis=2).min() <= within)

    own: list[Crease] = []
    inherited: list[Crease] = []
    for crease in creases:
        explained = lies_at(crease, rough + bent if crease.angle_degrees <= KINK else rough)
        (inherited if explained else own).append(crease)
    return own, inherited


def stretches_along(
    chain: Chain, curve: BSplineCurve, places: Sequence[float]
) -> Iterator[tuple[int, tuple[float, float], Base]]:
    """Yield each edge with the range of a curve's parameter along it, and the part of it that lies there.

    Parameters
    ----------
    chain : Chain
    curve : BSplineCurve
        That runs along the chain, as the edge of a blend does.
    places : sequence of float
        Where edges of the chain end along it.

    Raises
    ------
    EdgeError
        The curve runs on beyond the chain.
    """
    first, last = float(curve.knots[0]), float(curve.knots[-1])
    breaks = np.array(sorted({first, last, *places}))
    breaks = breaks[np.append(True, np.diff(breaks) > _SHORT * (last - first))]
    breaks[-1] = last
    edges = [boundary_curve(base.surface, base.side) for base in chain.edges]
    for low, high in zip(breaks[:-1].tolist(), breaks[1:].tolist(), strict=True):
        middle = curve.evaluate(np.array([(low + high) / 2]))[0]
        k = int(np.argmin([closest_point(one, middle).distance for one in edges]))
        base = chain.edges[k]
        part = _part(base, edges[k], curve.evaluate(np.array([low, high])), middle)
        yield k, (low, high), Base(base.surface, f"{base.side}[{part[0]!r},{part[1]!r}]")


def _part(base: Base, edge: BSplineCurve, ends: FloatArray, middle: FloatArray) -> tuple[float, float]:
    """Return the range of an edge between two points on it that goes through a third one."""
    start, end = base.range_along
    places = sorted(_snapped(_parameter(edge, x), start, end) for x in ends)
    if not is_closed(base):
        return places[0], places[1]
    # A point on the seam is both of its ends.
    at = _parameter(edge, middle)
    return max([start, *(x for x in places if x < at)]), min([end, *(x for x in places if x > at)])


def _parameter(curve: BSplineCurve, point: ArrayLike) -> float:
    return float(np.ravel(closest_point(curve, point).parameters)[0])


def _at_a_knot(x: float, curve: BSplineCurve) -> float:
    """Return the knot that a parameter is meant to be: what lies between both would be a span of nothing."""
    nearest = float(curve.knots[np.abs(curve.knots - x).argmin()])
    return nearest if abs(nearest - x) < _NEAR_A_KNOT * float(curve.knots[-1] - curve.knots[0]) else x


def _snapped(x: float, start: float, end: float) -> float:
    for place in (start, end):
        if abs(x - place) < _SHORT * (end - start):
            return float(place)
    return x
