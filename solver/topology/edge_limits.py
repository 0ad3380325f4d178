"""What a contact with a face along a free edge of it is held to."""

from __future__ import annotations

from semispline.solver.judge import Base, cad_measures, exact_face_limits
from semispline.solver.options import Limits
from semispline.solver.topology.trim_curves import TrimCurve


def default_limits(curve: TrimCurve) -> Limits:
    """Return the limits of what meets a face through a band: bands of planes are exact, others are fitted."""
    return "exact" if curve.is_plane else "cad"


def face_limits(
    curve: TrimCurve,
    base: Base,
    kind: Limits,
    *,
    length: float,
    smoothed_by: float = 0.0,
    order: int = 2,
) -> dict[str, float]:
    """Return the limit of each measure of `FaceContact` for a surface that meets a face along a free edge of it.

    Parameters
    ----------
    curve : TrimCurve
    base : Base
        The surface, for what rounding does to it.
    kind : {"exact", "cad"}
        How far off the edge it may be is the same for both: the tolerance of the edge, at the least what a gap may be.
    length : float
        Of what is met of the edge.
    smoothed_by : float
        So far the edge was moved to make it smooth.
    order : int
        Of contact.
    """
    cad = cad_measures(length, curve.millimetres)
    off = max(cad["gap"], curve.tolerance) + smoothed_by
    return (cad if kind == "cad" else exact_face_limits(base, curve.surface, order)) | {"off": off}
