"""What a parameter of Open CASCADE is on the B-spline that its surface is converted to.

An arc of a conic becomes rational pieces of degree 2, on which the parameter no longer is the angle: on a circle in
three pieces points at equal parameters are up to 4 % of the radius apart. Lines of constant parameter stay such lines;
only the number changes.
"""

from __future__ import annotations

from typing import Any, Literal, TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray

ParameterKind: TypeAlias = Literal["same", "angle", "hyperbolic angle"]

_ANGLES: dict[str, tuple[ParameterKind, ParameterKind]] = {
    "Geom_CylindricalSurface": ("angle", "same"),
    "Geom_ConicalSurface": ("angle", "same"),
    "Geom_SphericalSurface": ("angle", "angle"),
    "Geom_ToroidalSurface": ("angle", "angle"),
}
_CURVES: dict[str, ParameterKind] = {
    "Geom_Circle": "angle",
    "Geom_Ellipse": "angle",
    "Geom_Hyperbola": "hyperbolic angle",
}


def parameter_kinds(geometry: Any) -> tuple[ParameterKind, ParameterKind]:
    """Return of which kind u and v of a surface are, as `occ_conversion.resolved` returns it."""
    name = type(geometry).__name__
    if name == "Geom_SurfaceOfRevolution":
        return "angle", _kind_along(geometry.BasisCurve())
    if name == "Geom_SurfaceOfLinearExtrusion":
        return _kind_along(geometry.BasisCurve()), "same"
    return _ANGLES.get(name, ("same", "same"))


def _kind_along(curve: Any) -> ParameterKind:
    while type(curve).__name__ == "Geom_TrimmedCurve":
        curve = curve.BasisCurve()
    return _CURVES.get(type(curve).__name__, "same")


def converted_parameters(kind: ParameterKind, breaks: FloatArray, values: FloatArray) -> FloatArray:
    """Return the parameters on the converted surface of points with given parameters on the kernel's.

    Parameters
    ----------
    kind : {"same", "angle", "hyperbolic angle"}
    breaks : ndarray, shape (B,)
        Ends of the spans of the converted surface: there both parameters are the same.
    values : ndarray, shape (K,)
        Within the breaks, but for rounding.

    Source: an arc from a to b, of half opening h = (b - a) / 2, is a rational curve of degree 2 with weights 1, cos h,
    1; at angle a + t with x = tan(t / 2) its parameter from 0 to 1 is x / (sin h + x (1 - cos h)). On a hyperbola all
    of these functions are the hyperbolic ones.

    Examples
    --------
    >>> turn = 2 * np.pi
    >>> converted_parameters("angle", np.array([0, turn / 3, 2 * turn / 3, turn]), np.array([0, turn / 6, 1.0]))
    array([0.        , 1.04719755, 1.00438616])
    """
    values = np.asarray(values, dtype=np.float64)
    if kind == "same":
        return values
    span = np.clip(np.searchsorted(breaks, values, side="right") - 1, 0, len(breaks) - 2)
    start, width = breaks[span], np.diff(breaks)[span]
    sin, tan = (np.sin, np.tan) if kind == "angle" else (np.sinh, np.tanh)
    x, h = tan((values - start) / 2), width / 2
    # 1 - cos h without loss for small arcs.
    sagitta = 2 * sin(h / 2) ** 2 * (1 if kind == "angle" else -1)
    at = np.asarray(start + width * x / (sin(h) + x * sagitta))
    # An end of a span is an end, to the last bit.
    return np.where(values == breaks[span + 1], breaks[span + 1], at)
