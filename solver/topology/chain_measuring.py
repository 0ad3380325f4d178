"""How an edge meets edges that run end to end: measured on each of their faces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from semispline.solver.blending import Chain, stretches_along
from semispline.solver.errors import EdgeError
from semispline.solver.judge import (
    Base,
    Contact,
    FaceContact,
    edge_length,
    face_shortfalls,
    in_cad_limits,
    measure_contact,
    measure_face_contact,
    shortfalls,
)
from semispline.solver.options import Auto, Continuity, Limits
from semispline.solver.splines import boundary_curve, closest_point
from semispline.solver.topology.bases import edge_bases
from semispline.solver.topology.chain_edges import ResolvedChain
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_limits import default_limits, face_limits
from semispline.solver.topology.face_edges import ResolvedEdge

# Of the length of the other edge: ends of edges that are nearer to it lie on it.
_ON_EDGE = 1e-3


@dataclass(frozen=True, eq=False)
class StretchContact:
    """How an edge meets one edge of a chain.

    Attributes
    ----------
    edge : str
        Of the chain.
    other : str
        The other edge.
    range : (float, float)
        Where along that, in its own parameter.
    contact : Contact or FaceContact
        FaceContact along a free curve of a face.
    allowed : dict
        For each measure its limit.
    limits : {"exact", "cad"}
    """

    edge: str
    other: str
    range: tuple[float, float]
    contact: Contact | FaceContact
    allowed: dict[str, float]
    limits: Limits

    def misses(self, required: Continuity) -> list[tuple[str, float, float]]:
        """Return name, value and limit of each measure that falls short of a continuity."""
        if isinstance(self.contact, FaceContact):
            return list(face_shortfalls(self.contact, self.allowed, required))
        return shortfalls(self.contact, required)


def measure_chain_contact(
    a: ResolvedEdge | ResolvedChain, b: ResolvedEdge | ResolvedChain, *, limits: Limits | Auto = "auto", order: int = 4
) -> tuple[StretchContact, ...]:
    """Measure how edges meet of which one, or both, are several that run end to end.

    Parameters
    ----------
    a, b : ResolvedEdge or ResolvedChain
        Of two chains a's faces are measured along the edges of b.
    limits : {"auto", "exact", "cad"}
        "auto" is exact, but along free curves of faces that are no planes.
    order : {2, 3, 4}

    Returns
    -------
    tuple of StretchContact
        For each edge of the chain, wherever the other edges run along it.

    Raises
    ------
    EdgeError
        Neither is a chain, the other edge is a free curve, or it runs on beyond the chain.
    """
    sides = [side[0] for side in edge_bases([a, b], f"G{order}")]  # type: ignore[arg-type]
    own, other = sides if isinstance(sides[0].base, Chain) else sides[::-1]
    if not isinstance(own.base, Chain):
        raise EdgeError(
            f"edges: found {own.name} and {other.name}, expected a chain, as e3+e4; measure_contact takes others"
        )
    if any(part.band is not None for part in other.parts):
        raise EdgeError(f"edge: found {other.name}, a free curve, beside a chain; expected edges of the blend, as u0")
    found: list[StretchContact] = []
    for part in other.parts:
        for base in part.bases:
            found += _along(own, own.base, part.name, base, limits, order)
    return tuple(found)


def _along(
    own: EdgeBase, chain: Chain, name: str, base: Base, limits: Limits | Auto, order: int
) -> Iterator[StretchContact]:
    """Yield how a base meets each edge of a chain that it runs along."""
    curve = boundary_curve(base.surface, base.side)
    points = [x for edge in chain.edges for x in edge.derivative(np.array(edge.range_along), 0, 0)]
    feet = [closest_point(curve, x) for x in points]
    near = _ON_EDGE * edge_length(base)
    places = [float(np.ravel(foot.parameters)[0]) for foot in feet if foot.distance <= near]
    parts = {part.name: part for part in own.parts}
    try:
        stretches = list(stretches_along(chain, curve, places))
    except EdgeError:
        raise EdgeError(f"{name}: it runs on beyond {own.name}; name all edges that it meets") from None
    for k, span, face in stretches:
        stretch = Base(base.surface, f"{base.side}[{span[0]!r},{span[1]!r}]")
        part = parts.get(chain.names[k], own)
        if part.band is None or part.curve is None:
            contact = measure_contact(face, stretch, flip="auto", order=order)
            if limits == "cad":
                contact = in_cad_limits(contact, edge_length(face))
            kind: Limits = "cad" if limits == "cad" else "exact"
            yield StretchContact(chain.names[k], name, span, contact, dict(contact.allowed), kind)
            continue
        kind = default_limits(part.curve) if limits == "auto" else limits
        on_face = measure_face_contact(stretch, part.curve.free_edge(part.band.source), order=order)
        allowed = face_limits(part.curve, stretch, kind, length=part.band.length, order=order)
        yield StretchContact(chain.names[k], name, span, on_face, allowed, kind)


def worst_of(found: Sequence[StretchContact], measure: str) -> float | None:
    """Return the largest of a measure; None where no contact has it."""
    values = [value for one in found if (value := getattr(one.contact, measure)) is not None]
    return max(values, default=None)
