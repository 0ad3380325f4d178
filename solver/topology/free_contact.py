"""How two edges meet of which one at least is a free curve: measured on the face itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from semispline.solver.errors import EdgeError
from semispline.solver.judge import Base, FaceContact, FreeEdge, Profile, measure_face_profile, worst_of_face
from semispline.solver.options import Auto, Limits
from semispline.solver.topology.bases import free_curves
from semispline.solver.topology.edge_limits import default_limits, face_limits
from semispline.solver.topology.face_edges import ResolvedEdge
from semispline.solver.topology.trim_curves import TrimCurve


@dataclass(frozen=True, eq=False)
class FreeContact:
    """A contact along a free edge of a face.

    Attributes
    ----------
    contact : FaceContact
        The worst of it.
    profile : Profile
        Along the edge of the other surface; of two free edges along a's.
    along : {"a", "b"}
        Which edge that is.
    face : str
        The edge of which face it is measured against: "edge e3 of face 12".
    length : float
        Of that edge, model units; that of what was measured is in `contact`.
    allowed : dict
        For each measure its limit.
    limits : {"exact", "cad"}
        Of which kind these are.
    """

    contact: FaceContact
    profile: Profile
    along: Literal["a", "b"]
    face: str
    length: float
    allowed: dict[str, float]
    limits: Literal["exact", "cad"]


def measure_free_contact(
    a: ResolvedEdge, b: ResolvedEdge, *, limits: Limits | Auto = "auto", order: int = 4
) -> FreeContact:
    """Measure how two edges meet, one of which, or both, is a free curve of a face.

    No band takes part: points of the other edge are compared with their feet on the face.

    Parameters
    ----------
    a, b : ResolvedEdge
    limits : {"auto", "exact", "cad"}
        "auto" is exact for planes, else cad.
    order : {2, 3, 4}

    Raises
    ------
    EdgeError
        Neither is free, only a part of one was named, or the edges do not lie on each other.
    FileError, ComputationError
        As `read_trim_curves`.
    """
    for name, end in (("a", a), ("b", b)):
        if end.is_free and end.part is not None:
            raise EdgeError(
                f"edge {name}: found {end.edge}, a part; the whole curve is measured wherever the other edge runs: "
                f"name {end.edge.partition('[')[0]}"
            )
    curves = free_curves([a, b])
    if curves[0] is None and curves[1] is None:
        raise EdgeError(f"edges: found {a.edge} and {b.edge}, expected a free curve; measure_contact takes others")
    along: Literal["a", "b"] = "a" if curves[1] is not None else "b"
    (own, end), curve = ((curves[0], a), curves[1]) if along == "a" else ((curves[1], b), curves[0])
    assert curve is not None
    base = Base(end.surface, end.edge) if own is None else own.free_edge()
    edge = curve.free_edge()
    try:
        profile = measure_face_profile(base, edge, order=order)
    except EdgeError as error:
        raise EdgeError(f"edge {end.edge} against {curve.name}: {error}") from None
    contact = worst_of_face(profile)
    free = [x for x in curves if x is not None]
    kind = _kind(free) if limits == "auto" else limits
    each = [face_limits(x, _rounded(base), kind, length=contact.length, order=order) for x in free]
    allowed = {name: max(limits[name] for limits in each) for name in each[0]}
    return FreeContact(contact, profile, along, curve.name, edge.length, allowed, kind)


def _kind(curves: Sequence[TrimCurve]) -> Limits:
    return "cad" if any(default_limits(curve) == "cad" for curve in curves) else "exact"


def _rounded(base: Base | FreeEdge) -> Base:
    """Return what rounds as one side does: of a face any edge of its surface."""
    return Base(base.face, "u0") if isinstance(base, FreeEdge) else base
