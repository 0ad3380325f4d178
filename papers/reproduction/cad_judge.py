"""Open CASCADE as a second judge of contact, where the `cad` extra is installed."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np

from semispline.solver.io import occ_surface
from semispline.solver.judge import Base, Correspondence, corresponding_points
from semispline.solver.splines import BSplineSurface, reverse_v

# Limits of the kernel's own analysis: a length, and an angle in radians.
_GAP, _ANGLE = 1e-9, 1e-9
_SAMPLES = np.linspace(0.07, 0.93, 5)


def cad_verdict(a: Base, b: Base, *, flipped: bool = False) -> str:
    """Return what `LocalAnalysis_SurfaceContinuity` says at five points of a common edge.

    Parameters
    ----------
    a, b : Base
        Points along the edges correspond as the referee has it; semi-structured surfaces are converted exactly.
    flipped : bool
        Whether b's edge runs against a's.

    Returns
    -------
    str
        Such as "G1 at 5 of 5 points, G2 at 0 of 5"; "not installed" without the extra.
    """
    if find_spec("OCP") is None:
        return "not installed"
    g0, g1, g2 = 0, 0, 0
    (a_0, a_1), (b_0, b_1) = a.range_along, b.range_along
    along_b = corresponding_points(a, b, Correspondence(flipped), a_0 + _SAMPLES * (a_1 - a_0))
    for s, t in zip(_SAMPLES.tolist(), ((along_b - b_0) / (b_1 - b_0)).tolist(), strict=True):
        done, first, second = _analyse(a, s, b, t)
        g0, g1, g2 = g0 + done, g1 + first, g2 + second
    total = len(_SAMPLES)
    return f"touches at {g0}, G1 at {g1}, G2 at {g2} of {total} points"


def _analyse(a: Base, s: float, b: Base, t: float) -> tuple[bool, bool, bool]:
    # An extra, which need not be installed, and takes a second to load.
    from OCP.GeomAbs import GeomAbs_G2
    from OCP.LocalAnalysis import LocalAnalysis_SurfaceContinuity

    surface_a, surface_b = (_plain(side) for side in (a, b))
    uv_a, uv_b = _point(surface_a, a.side, s), _point(surface_b, b.side, t)
    normals = [
        np.cross(x.evaluate([u], [v], 1, 0)[0], x.evaluate([u], [v], 0, 1)[0])
        for x, (u, v) in ((surface_a, uv_a), (surface_b, uv_b))
    ]
    if normals[0] @ normals[1] < 0:
        # The analysis compares curvatures with their signs, so both normals must look the same way.
        v0, v1 = surface_b.domain[1]
        surface_b, uv_b = reverse_v(surface_b), (uv_b[0], v0 + v1 - uv_b[1])
    limits = {"EpsNul": _GAP, "EpsC0": _GAP, "EpsG1": _ANGLE}
    geometry_a, geometry_b = occ_surface(surface_a), occ_surface(surface_b)
    result = LocalAnalysis_SurfaceContinuity(geometry_a, *uv_a, geometry_b, *uv_b, GeomAbs_G2, **limits)
    if not result.IsDone():
        return False, False, False
    return bool(result.IsC0()), bool(result.IsG1()), bool(result.IsG2())


def _plain(base: Base) -> BSplineSurface:
    surface = base.surface
    return surface if isinstance(surface, BSplineSurface) else surface.to_bspline()


def _point(surface: BSplineSurface, edge: str, s: float) -> tuple[float, float]:
    (u0, u1), (v0, v1) = surface.domain
    if edge[0] == "u":
        return (u1 if edge[1] == "1" else u0), v0 + s * (v1 - v0)
    return u0 + s * (u1 - u0), (v1 if edge[1] == "1" else v0)
