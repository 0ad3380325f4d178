"""Open CASCADE as a judge: our surfaces as Geom_BSplineSurface, continuity by LocalAnalysis."""

import numpy as np
from OCP.collections import Array1_double, Array1_int, Array2_double, Array2_gp_Pnt
from OCP.Geom import Geom_BSplineSurface
from OCP.GeomAbs import GeomAbs_G2
from OCP.gp import gp_Pnt
from OCP.LocalAnalysis import LocalAnalysis_SurfaceContinuity

from semispline import BSplineSurface
from semispline.solver.splines.operations import reverse_v


def _knots(knots):
    values, counts = np.unique(knots, return_counts=True)
    knot_array, mult_array = Array1_double(1, len(values)), Array1_int(1, len(values))
    for i, (value, count) in enumerate(zip(values, counts, strict=True), start=1):
        knot_array.SetValue(i, float(value))
        mult_array.SetValue(i, int(count))
    return knot_array, mult_array


def to_geom(surface: BSplineSurface):
    n_u, n_v = surface.control_points.shape[:2]
    poles = Array2_gp_Pnt(1, n_u, 1, n_v)
    weights = Array2_double(1, n_u, 1, n_v)
    for i in range(n_u):
        for j in range(n_v):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*map(float, surface.control_points[i, j])))
            weights.SetValue(i + 1, j + 1, 1.0 if surface.weights is None else float(surface.weights[i, j]))
    (ku, mu), (kv, mv) = _knots(surface.knots_u), _knots(surface.knots_v)
    return Geom_BSplineSurface(poles, weights, ku, kv, mu, mv, surface.degree_u, surface.degree_v)


def edge_point(surface: BSplineSurface, edge, s):
    """(u, v) on an edge at the fraction s of its own parameter."""
    (u0, u1), (v0, v1) = surface.domain
    if edge[0] == "u":
        return (u1 if edge[1] == "1" else u0), v0 + s * (v1 - v0)
    return u0 + s * (u1 - u0), (v1 if edge[1] == "1" else v0)


def analyse(a: BSplineSurface, uv_a, b: BSplineSurface, uv_b):
    """LocalAnalysis of two surfaces at a common point; their normals are made to agree in sign first."""
    normals = [
        np.cross(s.evaluate([u], [v], 1, 0)[0], s.evaluate([u], [v], 0, 1)[0]) for s, (u, v) in ((a, uv_a), (b, uv_b))
    ]
    if normals[0] @ normals[1] < 0:
        (v0, v1) = b.domain[1]
        b, uv_b = reverse_v(b), (uv_b[0], v0 + v1 - uv_b[1])
    limits = {"EpsNul": 1e-9, "EpsC0": 1e-9, "EpsG1": 1e-9}
    result = LocalAnalysis_SurfaceContinuity(to_geom(a), *uv_a, to_geom(b), *uv_b, GeomAbs_G2, **limits)
    assert result.IsDone(), result.StatusError()
    return result
