"""What every reader returns: the faces of a file in order, converted when asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError, InputError
from semispline.solver.io.face_boundary import FaceBoundary
from semispline.solver.judge import extent
from semispline.solver.splines import (
    MERGE_TOLERANCE,
    BSplineCurve,
    BSplineSurface,
    SemiStructuredSurface,
    Surface,
    clamped_surface,
)

# Weights that agree to this relative tolerance (rounding of a product and a quotient) are one weight.
_EQUAL_WEIGHTS = 8 * np.finfo(np.float64).eps
# A surface is closed if its first and last rows agree to this fraction of its size (what CAD systems sew together).
_CLOSED = 1e-9

# Millimetres in each unit of length that IGES knows; the other formats know these too.
MILLIMETRES = {
    "in": 25.4,
    "mm": 1.0,
    "ft": 304.8,
    "mi": 1609344.0,
    "m": 1000.0,
    "km": 1e6,
    "mil": 0.0254,
    "um": 1e-3,
    "cm": 10.0,
    "uin": 2.54e-5,
}


class Face(Protocol):
    """A surface in a file, not yet read out."""

    @property
    def kind(self) -> str:
        """What the file holds: "B-spline", "plane", and so on."""

    def trimmed(self) -> bool | None:
        """Whether curves cut the face out of its surface; None if the format does not tell."""

    def boundary(self) -> FaceBoundary | None:
        """Return the edges that bound the face; None where it is the whole surface that `surface` returns.

        A reader in a process of its own knows them of those faces only whose numbers `open_model` was given.
        """

    def surface(self) -> Surface:
        """Return the clamped (rational) B-spline surface, without trimming: exact, or as near as `deviation` says."""

    def deviation(self) -> float | None:
        """Return how far `surface` was found from what the file holds, in its unit; None where it is exact."""


@dataclass(frozen=True)
class Model:
    """An opened file.

    Parameters
    ----------
    path : str
    unit : str or None
        Key of `MILLIMETRES`: the unit of the coordinates; None where the file does not say.
    faces : sequence of Face
        In the order of their numbers.
    others : mapping
        What else the file holds, from which no surface is taken: kind ("mesh", "edge", ...) -> how many.
    """

    path: str
    unit: str | None
    faces: Sequence[Face]
    others: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class SurfaceEntry:
    """One line of `list_surfaces`.

    Parameters
    ----------
    number : int
        N of `PATH#N`.
    kind : str
    degree_u, degree_v : int or None
        None where the face cannot be read out.
    n_u, n_v : int or None
        Control points; n_v is None for a semi-structured surface whose curves differ.
    rational, closed_u, closed_v : bool or None
    trimmed : bool or None
        None where the file does not tell.
    deviation : float or None
        Where the face has no exact B-spline form: how far the one that is read out is from it at the worst place that
        was found, in the unit of the file.
    problem : str or None
        Why the face cannot be read out.
    """

    number: int
    kind: str
    degree_u: int | None = None
    degree_v: int | None = None
    n_u: int | None = None
    n_v: int | None = None
    rational: bool | None = None
    trimmed: bool | None = None
    closed_u: bool | None = None
    closed_v: bool | None = None
    deviation: float | None = None
    problem: str | None = None


def describe(number: int, face: Face) -> SurfaceEntry:
    """Return the entry of a face, read out for the purpose."""
    try:
        surface = face.surface()
    except InputError as error:
        return SurfaceEntry(number, face.kind, trimmed=face.trimmed(), problem=str(error))
    if isinstance(surface, SemiStructuredSurface):
        curves = surface.control_curves
        counts = {len(curve.control_points) for curve in curves}
        n_u, n_v = len(curves), counts.pop() if len(counts) == 1 else None
        first, last = curves[0], curves[-1]
        size = extent(np.concatenate([curve.control_points for curve in curves]))
        same = first.degree == last.degree and np.array_equal(first.knots, last.knots)
        closed_u = same and _same(_with_weights(first), _with_weights(last), size)
        ends = np.stack([_with_weights(curve)[[0, -1]] for curve in curves])
    else:
        net = surface.control_points
        n_u, n_v = net.shape[:2]
        size = extent(net)
        ends = _with_weights(surface)
        closed_u = _same(ends[0], ends[-1], size)
    closed_v = _same(ends[:, 0], ends[:, -1], size)
    return SurfaceEntry(
        number=number,
        kind=face.kind,
        degree_u=surface.degree_u,
        degree_v=surface.degree_v,
        n_u=n_u,
        n_v=n_v,
        rational=surface.is_rational,
        trimmed=face.trimmed(),
        closed_u=closed_u,
        closed_v=closed_v,
        deviation=face.deviation(),
    )


def picked(model: Model, number: int | None) -> Face:
    """Return the face of that number; without one, the only face.

    Raises
    ------
    FileError
        No such face, or several and no number.
    """
    count = len(model.faces)
    if count == 0:
        raise FileError(f"{model.path}: holds {without_surfaces(model.others)}")
    if number is None:
        if count > 1:
            raise FileError(
                f"{model.path}: holds {count} surfaces; choose one as {model.path}#N, "
                f"N as `semispline list {model.path}` numbers them"
            )
        return model.faces[0]
    if number >= count:
        raise FileError(f"{model.path}#{number}: no such surface; the file holds {count}, numbered 0 to {count - 1}")
    return model.faces[number]


def counted(others: Mapping[str, int]) -> str:
    """Return what a file holds besides surfaces, in words.

    Examples
    --------
    >>> counted({"mesh": 2, "SubD": 1})
    '2 meshes, 1 SubD'
    """
    plural = {"mesh": "meshes", "vertex": "vertices"}
    return ", ".join(f"{n} {kind if n == 1 else plural.get(kind, f'{kind}s')}" for kind, n in others.items())


def without_surfaces(others: Mapping[str, int]) -> str:
    """Return what is said of a file without surfaces.

    Examples
    --------
    >>> without_surfaces({"mesh": 2, "SubD": 1})
    'no surfaces: 2 meshes, 1 SubD; only surfaces, faces of Breps and extrusions can be used'
    """
    if not others:
        return "no surfaces, and nothing else that is known here"
    return f"no surfaces: {counted(others)}; only surfaces, faces of Breps and extrusions can be used"


def without_equal_weights(weights: FloatArray) -> FloatArray | None:
    """Return None if all weights are one number up to rounding: such a surface is polynomial."""
    return None if np.ptp(weights) <= _EQUAL_WEIGHTS * np.abs(weights).max() else weights


def surface_from_net(
    degree_u: int,
    degree_v: int,
    knots_u: FloatArray,
    knots_v: FloatArray,
    points: FloatArray,
    weights: FloatArray | None,
) -> BSplineSurface:
    """Return the surface, clamped by exact knot insertion where the knots of the file are not.

    Parameters
    ----------
    knots_u, knots_v : ndarray, shapes (n_u + degree_u + 1,), (n_v + degree_v + 1,)
    points : ndarray, shape (n_u, n_v, 3)
        Euclidean.
    weights : ndarray, shape (n_u, n_v), or None

    Raises
    ------
    KnotError, ControlPointError
        Values that make no surface.
    """
    knots_u, knots_v = _snapped_ends(knots_u, degree_u), _snapped_ends(knots_v, degree_v)
    if _is_clamped(knots_u, degree_u) and _is_clamped(knots_v, degree_v):
        return BSplineSurface(degree_u, degree_v, knots_u, knots_v, points, weights)
    return clamped_surface(degree_u, degree_v, knots_u, knots_v, points, weights)


def _snapped_ends(knots: FloatArray, degree: int) -> FloatArray:
    """Give knots within 1e-12 of the domain from one of its ends the value of that end."""
    if len(knots) < 2 * degree + 2:
        return knots
    start, end = knots[degree], knots[-degree - 1]
    tolerance = MERGE_TOLERANCE * (end - start)
    near_start, near_end = np.abs(knots - start) <= tolerance, np.abs(knots - end) <= tolerance
    return np.where(near_start, start, np.where(near_end, end, knots))


def _is_clamped(knots: FloatArray, degree: int) -> bool:
    return bool(knots[0] == knots[degree] and knots[-1] == knots[-degree - 1])


def _with_weights(spline: BSplineCurve | BSplineSurface) -> FloatArray:
    """Return (x, y, z, w) for each control point."""
    weights = np.ones(spline.control_points.shape[:-1]) if spline.weights is None else spline.weights
    return np.concatenate([spline.control_points, weights[..., None]], axis=-1)


def _same(a: FloatArray, b: FloatArray, size: float) -> bool:
    """Tell whether two rows (x, y, z, w) over the same knots are one curve: equal points, weights in one proportion."""
    weights = np.abs(a[:, 3] / a[0, 3] - b[:, 3] / b[0, 3])
    return bool(np.abs(a[:, :3] - b[:, :3]).max() <= _CLOSED * size and (weights <= _CLOSED * a[:, 3] / a[0, 3]).all())
