"""Surfaces of Open CASCADE as B-splines: exact where they have such a form, measured where the kernel approximates.

The kernel's own conversion says nothing where it loses a face: a cylinder over a hair more than a full turn comes
without points, or as a sliver. So ranges are snapped before, and what comes is compared with what was asked for.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError
from semispline.solver.io.faces import surface_from_net, without_equal_weights
from semispline.solver.judge import surface_points
from semispline.solver.splines import BSplineSurface

KINDS = {
    "Geom_BSplineSurface": "B-spline",
    "Geom_BezierSurface": "Bezier",
    "Geom_Plane": "plane",
    "Geom_CylindricalSurface": "cylinder",
    "Geom_ConicalSurface": "cone",
    "Geom_SphericalSurface": "sphere",
    "Geom_ToroidalSurface": "torus",
    "Geom_SurfaceOfRevolution": "revolution",
    "Geom_SurfaceOfLinearExtrusion": "extrusion",
    "Geom_OffsetSurface": "offset",
}
_EXTRUSION, _REVOLUTION = "Geom_SurfaceOfLinearExtrusion", "Geom_SurfaceOfRevolution"
_SWEPT = (_EXTRUSION, _REVOLUTION)
_EXACT_CURVES = ("BSplineCurve", "BezierCurve", "Line", "Circle", "Ellipse", "Parabola", "Hyperbola")
# These turn about their axis as u goes.
_TURNED = (
    "Geom_CylindricalSurface",
    "Geom_ConicalSurface",
    "Geom_SphericalSurface",
    "Geom_ToroidalSurface",
    _REVOLUTION,
)
# Files write angles with some 10 to 16 digits: ends of a range that are this near, in fractions of a turn of 2 pi or
# of the range, are meant to be the same.
_SNAP = 2e-9
# Spacings of its ends that a turn is shortened by where it begins anywhere; twice what is needed.
_ROUNDINGS = 2
# The kernel's word for infinity.
_INFINITE = 1e100
# What was converted exactly agrees to this fraction of the size.
_EXACT = 1e-9
# What has no exact form is approximated to this fraction of the size; ten times as much still counts as done, and
# what is further off than the last is another surface.
_WANTED, _LARGEST = 1e-7, 1e-4
_MOST_SPANS, _DEGREE = 200, 14
# Places along each parameter at which an approximation is measured, at most; an error of a high degree has many waves.
_PLACES = 200
# Around so many of the worst ones it is then sought on grids of so many places across, so often.
_REFINED, _ACROSS, _ZOOMS = 3, 7, 3
Ends = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class Conversion:
    """A converted surface.

    Attributes
    ----------
    surface : BSplineSurface
        Clamped, without trimming.
    deviation : float or None
        How far it is from what the file holds at the worst place that was found, in the unit of the file; None where
        it is exact. No bound: another place may be a little worse.
    """

    surface: BSplineSurface
    deviation: float | None


def kind_of(geometry: Any) -> str:
    """Return in a word what a resolved surface is."""
    name = type(geometry).__name__
    return KINDS.get(name, name.removeprefix("Geom_"))


def resolved(geometry: Any) -> Any:
    """Return the surface without its trimming; an offset that is a plane, cylinder, ... again as what it is."""
    while True:
        name = type(geometry).__name__
        if name == "Geom_RectangularTrimmedSurface":
            geometry = geometry.BasisSurface()
        elif name == "Geom_OffsetSurface" and _is_offset(geometry, geometry.Surface()):
            geometry = geometry.Surface()
        else:
            return geometry


def snapped_ends(geometry: Any, ends: Ends) -> Ends:
    """Return the range of a face as it was meant: a full turn, from a pole on, from 0 on, within its surface."""
    low_u, high_u, low_v, high_v = ends
    first_u, last_u, first_v, last_v = geometry.Bounds()
    return (
        *_snapped(low_u, high_u, first_u, last_u, geometry.IsUPeriodic()),
        *_snapped(low_v, high_v, first_v, last_v, geometry.IsVPeriodic()),
    )


def _snapped(low: float, high: float, first: float, last: float, periodic: bool) -> tuple[float, float]:
    tolerance = _SNAP * (last - first) / (2 * np.pi if periodic else 1.0)
    if periodic:
        turns = round((low - first) / (last - first))
        start = first + turns * (last - first)
        low = start if abs(low - start) <= tolerance else low
        # Counted modulo a turn, a hair more than one became a sliver.
        full = high - low >= last - first - tolerance or high - low <= tolerance
        return low, (low + (last - first) if full else high)
    if abs(first) < _INFINITE:
        low = first if low <= first + tolerance else low
    if abs(last) < _INFINITE:
        high = last if high >= last - tolerance else high
    return low, high


def converted(geometry: Any, ends: Ends) -> Conversion:
    """Return a resolved surface over a range as a B-spline.

    Parameters
    ----------
    geometry : Geom_Surface
        As `resolved` returns it.
    ends : tuple of float
        Ranges of u and v, as `snapped_ends` returns them; B-splines and Bezier surfaces are taken whole.

    Raises
    ------
    FileError
        The range is infinite, or the kernel's form of it is another surface.
    KnotError, ControlPointError
        Values that make no surface.
    """
    name = type(geometry).__name__
    if name == "Geom_BSplineSurface":
        return Conversion(_read_out(geometry.Copy()), None)
    if name == "Geom_BezierSurface":
        return Conversion(_read_out(_as_spline(geometry)), None)
    if max(map(abs, ends)) >= _INFINITE:
        raise FileError(f"the {kind_of(geometry)} has no end; trim the face where it was drawn")
    if name == "Geom_OffsetSurface" and geometry.Surface() is not None:
        # The kernel evaluates it as its simple form, which is mirrored.
        raise FileError("an offset by more than its radius, which Open CASCADE turns inside out; draw what it became")
    if _is_exact(geometry):
        surface = _exact(geometry, ends)
        away = _distance_at_knots(surface, geometry)
        if not away <= _EXACT * _size(surface):
            raise FileError(
                f"Open CASCADE's B-spline form of the {kind_of(geometry)} is off by {away:.2g}; "
                "make the face a B-spline where it was drawn"
            )
        return Conversion(surface, None)
    return _approximated(geometry, ends)


def _exact(geometry: Any, ends: Ends) -> BSplineSurface:
    low_u, high_u, low_v, high_v = ends
    first_u, last_u, first_v, last_v = geometry.Bounds()
    # A range from elsewhere is a turn up to rounding.
    turn_u, turn_v = ((1 - _SNAP) * x for x in (last_u - first_u, last_v - first_v))
    full_u = bool(geometry.IsUPeriodic()) and high_u - low_u >= turn_u
    full_v = bool(geometry.IsVPeriodic()) and high_v - low_v >= turn_v
    name = type(geometry).__name__
    if name in _SWEPT and ((full_u and low_u != first_u) if name == _EXTRUSION else (full_v and low_v != first_v)):
        geometry = _begun_at(geometry, low_u if name == _EXTRUSION else low_v)
        first_u, last_u, first_v, last_v = geometry.Bounds()
        low_v = first_v if full_v else low_v
    shift = 0.0
    if full_u and name in _TURNED and low_u != first_u:
        # From 0 on the kernel makes three equal arcs of a circle, and from elsewhere four unequal ones.
        shift = low_u - first_u
        geometry = geometry.Rotated(geometry.Axis(), shift)
    # A full turn from the start of the period on is not a trimming: the kernel refuses to cut a period out of itself.
    cut_v = not (full_v and low_v == first_v)
    if full_v and cut_v:
        # A turn that rounds up beyond one is none to the kernel, which adds and subtracts once more.
        high_v -= _ROUNDINGS * np.spacing(max(abs(low_v), abs(high_v)))
    spline = _as_spline(_trimmed(geometry, (low_u, high_u, low_v, high_v), not full_u, cut_v))
    surface = _read_out(spline, shift)
    widths = [x[1] - x[0] for x in surface.domain]
    if not np.allclose(widths, [high_u - low_u, high_v - low_v], rtol=_SNAP, atol=0):
        raise FileError(f"Open CASCADE makes a B-spline of another range of the {kind_of(geometry)}; export it anew")
    return surface


def _begun_at(geometry: Any, start: float) -> Any:
    """Return a surface swept from a closed curve that begins elsewhere: the kernel leaves its seam where it was."""
    from OCP.Geom import Geom_SurfaceOfLinearExtrusion, Geom_SurfaceOfRevolution, Geom_TrimmedCurve

    curve = geometry.BasisCurve()
    curve = Geom_TrimmedCurve(curve, start, start + (curve.LastParameter() - curve.FirstParameter()))
    if type(geometry).__name__ == _EXTRUSION:
        return Geom_SurfaceOfLinearExtrusion(curve, geometry.Direction())
    return Geom_SurfaceOfRevolution(curve, geometry.Axis())


def _trimmed(geometry: Any, ends: Ends, cut_u: bool, cut_v: bool) -> Any:
    from OCP.Geom import Geom_RectangularTrimmedSurface

    # Python's integers would choose the constructor for one parameter, whose other arguments are flags.
    low_u, high_u, low_v, high_v = map(float, ends)
    if cut_u and cut_v:
        return Geom_RectangularTrimmedSurface(geometry, low_u, high_u, low_v, high_v)
    if cut_u:
        return Geom_RectangularTrimmedSurface(geometry, low_u, high_u, True)
    if cut_v:
        return Geom_RectangularTrimmedSurface(geometry, low_v, high_v, False)
    return geometry


def _as_spline(geometry: Any) -> Any:
    from OCP.GeomConvert import GeomConvert

    return GeomConvert.SurfaceToBSplineSurface_s(geometry)


def _is_exact(geometry: Any) -> bool:
    """Tell whether the kernel converts a surface exactly."""
    name = type(geometry).__name__
    if name not in _SWEPT:
        return name in KINDS and name != "Geom_OffsetSurface"
    curve = geometry.BasisCurve()
    while type(curve).__name__ == "Geom_TrimmedCurve":
        curve = curve.BasisCurve()
    return type(curve).__name__.removeprefix("Geom_") in _EXACT_CURVES


def _is_offset(geometry: Any, simple: Any) -> bool:
    """Tell whether the kernel's simple form of an offset is the offset, in the same parameters."""
    from OCP.gp import gp_Pnt, gp_Vec

    if simple is None:
        return False
    basis = geometry.BasisSurface()
    first_u, last_u, first_v, last_v = (min(max(x, -1.0), 1.0) if abs(x) >= _INFINITE else x for x in basis.Bounds())
    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    for s, t in ((0.2, 0.3), (0.7, 0.6)):
        u, v = first_u + s * (last_u - first_u), first_v + t * (last_v - first_v)
        basis.D1(u, v, point, along_u, along_v)
        normal = np.cross(_coordinates(along_u), _coordinates(along_v))
        expected = _coordinates(point) + geometry.Offset() * normal / np.linalg.norm(normal)
        size = max(abs(geometry.Offset()), float(np.linalg.norm(expected)))
        if not np.linalg.norm(_coordinates(simple.Value(u, v)) - expected) <= _EXACT * size:
            return False
    return True


def _approximated(geometry: Any, ends: Ends) -> Conversion:
    """Return the smoothest approximation that is near enough, else the nearest.

    Demanded smoother than the surface is, the kernel's approximation may be far off, and its word of the error is
    not to be trusted: so it is measured.
    """
    from OCP.GeomAbs import GeomAbs_Shape
    from OCP.GeomConvert import GeomConvert_ApproxSurface

    low_u, high_u, low_v, high_v = ends
    first_u, last_u, first_v, last_v = geometry.Bounds()
    part = _trimmed(geometry, ends, (low_u, high_u) != (first_u, last_u), (low_v, high_v) != (first_v, last_v))
    corners = [_coordinates(geometry.Value(float(u), float(v))) for u in (low_u, high_u) for v in (low_v, high_v)]
    middle = _coordinates(geometry.Value((low_u + high_u) / 2, (low_v + high_v) / 2))
    size = float(np.ptp([*corners, middle], axis=0).max())
    best: Conversion | None = None
    for smooth in (GeomAbs_Shape.GeomAbs_C2, GeomAbs_Shape.GeomAbs_C1, GeomAbs_Shape.GeomAbs_C0):
        maker = GeomConvert_ApproxSurface(part, _WANTED * size, smooth, smooth, _DEGREE, _DEGREE, _MOST_SPANS, 0)
        if not maker.HasResult():
            continue
        surface = _read_out(maker.Surface())
        found = Conversion(surface, _deviation(surface, geometry, ends))
        if best is None or found.deviation < best.deviation:  # type: ignore[operator]
            best = found
        if found.deviation <= 10 * _WANTED * size:  # type: ignore[operator]
            return found
    if best is None or not best.deviation <= _LARGEST * size:  # type: ignore[operator]
        off = "" if best is None else f", and approximates it no better than to {best.deviation:.2g}"
        raise FileError(
            f"Open CASCADE knows no exact B-spline form of the {kind_of(geometry)}{off}; "
            "make the face a B-spline where it was drawn"
        )
    return best


def _distance_at_knots(surface: BSplineSurface, geometry: Any) -> float:
    """Return the largest distance at knots and middles of spans, where the parameters of both forms are the same."""
    u, v = (np.unique(np.concatenate([x, (x[1:] + x[:-1]) / 2])) for x in surface.breakpoints)
    pairs = [(a, b) for a in u.tolist() for b in v.tolist()]
    # By the referee, for which no SciPy has to be loaded.
    found = surface_points(surface, *np.array(pairs).T)
    expected = np.array([_coordinates(geometry.Value(a, b)) for a, b in pairs])
    return float(np.linalg.norm(found - expected, axis=-1).max())


def _deviation(surface: BSplineSurface, geometry: Any, ends: Ends) -> float:
    """Return the largest distance from points of an approximation to the surface itself, as far as a search finds it.

    On a grid, and then around its worst places on finer and finer ones.
    """
    degrees = surface.degree_u, surface.degree_v
    u, v = (_places(x, degree) for x, degree in zip(surface.breakpoints, degrees, strict=True))
    grid = surface.evaluate_grid(u, v)
    away = grid - np.array([[_coordinates(geometry.Value(a, b)) for b in v.tolist()] for a in u.tolist()])
    at_same = np.linalg.norm(away, axis=-1)
    found: dict[tuple[int, int], float] = {}
    # The foot is no farther than the point with the same parameters.
    for place in np.argsort(-at_same, axis=None).tolist():
        i, j = divmod(place, len(v))
        if at_same[i, j] <= max(found.values(), default=-1.0):
            break
        found[i, j] = _foot_distance(grid[i, j], geometry, ends, (u[i], v[j]), float(at_same[i, j]))
    worst = sorted(found, key=lambda key: -found[key])[:_REFINED]
    return max(found[worst[0]], *(_zoomed(surface, geometry, ends, (u, v), place) for place in worst))


def _zoomed(
    surface: BSplineSurface, geometry: Any, ends: Ends, places: tuple[FloatArray, FloatArray], worst: tuple[int, int]
) -> float:
    """Return the largest distance around one of the places, on grids that are each as wide as two steps before."""
    low = [float(x[max(i - 1, 0)]) for x, i in zip(places, worst, strict=True)]
    high = [float(x[min(i + 1, len(x) - 1)]) for x, i in zip(places, worst, strict=True)]
    largest = 0.0
    for _ in range(_ZOOMS):
        u, v = (np.linspace(a, b, _ACROSS) for a, b in zip(low, high, strict=True))
        grid = surface.evaluate_grid(u, v)
        off = [
            [_foot_distance(point, geometry, ends, (a, b)) for point, b in zip(row, v.tolist(), strict=True)]
            for row, a in zip(grid, u.tolist(), strict=True)
        ]
        at = np.unravel_index(int(np.argmax(off)), (_ACROSS, _ACROSS))
        largest = max(largest, off[at[0]][at[1]])
        low, high = (
            [float(x[np.clip(i + k, 0, _ACROSS - 1)]) for x, i in zip((u, v), at, strict=True)] for k in (-1, 1)
        )
    return largest


def _foot_distance(
    target: FloatArray, geometry: Any, ends: Ends, start: tuple[float, float], nearest: float = np.inf
) -> float:
    """Return the distance of a point from a surface near some parameters.

    Source: Gauss-Newton steps to the foot point, within the range of the face.
    """
    from OCP.gp import gp_Pnt, gp_Vec

    point, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    at = np.array(start)
    for _ in range(4):
        geometry.D1(float(at[0]), float(at[1]), point, along_u, along_v)
        offset = target - _coordinates(point)
        nearest = min(nearest, float(np.linalg.norm(offset)))
        slopes = np.stack([_coordinates(along_u), _coordinates(along_v)], axis=1)
        at = np.clip(at + np.linalg.lstsq(slopes, offset)[0], ends[::2], ends[1::2])
    return nearest


def _places(breaks: FloatArray, degree: int) -> FloatArray:
    each = max(2, min(2 * degree, _PLACES // (len(breaks) - 1)))
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * (np.arange(each) / each)).ravel(), breaks[-1])


def _size(surface: BSplineSurface) -> float:
    return float(np.ptp(surface.control_points.reshape(-1, 3), axis=0).max())


def _coordinates(xyz: Any) -> FloatArray:
    return np.array([xyz.X(), xyz.Y(), xyz.Z()])


def _read_out(spline: Any, shift: float = 0.0) -> BSplineSurface:
    """Return a B-spline surface of the kernel, its parameter u moved by `shift`; one that is periodic is changed."""
    # Exact knot insertion at the seam.
    if spline.IsUPeriodic():
        spline.SetUNotPeriodic()
    if spline.IsVPeriodic():
        spline.SetVNotPeriodic()
    n_u, n_v = spline.NbUPoles(), spline.NbVPoles()
    if not n_u * n_v:
        raise FileError("Open CASCADE makes a B-spline surface without points of it; export it anew")
    places = [(i + 1, j + 1) for i in range(n_u) for j in range(n_v)]
    points = np.array([_coordinates(spline.Pole(i, j)) for i, j in places]).reshape(n_u, n_v, 3)
    weights: FloatArray | None = None
    if spline.IsURational() or spline.IsVRational():
        found = np.array([spline.Weight(i, j) for i, j in places])
        weights = without_equal_weights(found.reshape(n_u, n_v))
    knots_u = np.fromiter(_repeated(spline.NbUKnots(), spline.UKnot, spline.UMultiplicity), np.float64) + shift
    knots_v = np.fromiter(_repeated(spline.NbVKnots(), spline.VKnot, spline.VMultiplicity), np.float64)
    return surface_from_net(spline.UDegree(), spline.VDegree(), knots_u, knots_v, points, weights)


def _repeated(count: int, knot: Any, multiplicity: Any) -> Iterator[float]:
    for i in range(1, count + 1):
        yield from [knot(i)] * multiplicity(i)
