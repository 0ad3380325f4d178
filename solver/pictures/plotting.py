"""Pictures of surfaces, off-screen, through pyvista (the extra `view`).

Shading and every colour follow the exact normals and curvatures of the surface, not those of the triangles.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import OptionError
from semispline.solver.io import atomic_path, pyvista_module, sampled, shown, triangle_mesh
from semispline.solver.judge import LocalGeometry, isophote_angle, mirror_angle
from semispline.solver.splines import SemiStructuredSurface, Surface

Field: TypeAlias = Literal["curvature", "gaussian", "zebra", "isophotes"]

BASE_COLOR, BLEND_COLOR = "#3f9b4f", "#d1402f"
# For surfaces side by side: Okabe and Ito's palette, which colour-blind readers tell apart.
PALETTE = ("#3f9b4f", "#d1402f", "#0072b2", "#e69f00", "#56b4e9", "#cc79a7", "#8c6d31", "#7f7f7f")
# For v-control curves on top of red and green.
CURVE_COLORS = ("#0b3c8c", "#e8a200", "#6a0dad", "#00a0b0", "#111111", "#c2185b", "#5d4037", "#ffe14d")

# Samples along each parameter, for one surface and at the least; and over all surfaces.
_FINEST, _COARSEST, _TOTAL = 240, 24, 600_000
# Bands over 180 (light and dark ones of `zebra`) and over 90 degrees; even numbers.
_STRIPES, _ISOPHOTES = 40, 18
_MARGIN = 1.06
# A direction whose horizontal part is smaller than this counts as vertical.
_STEEP = 1e-6
_BAR = {
    "vertical": False,
    "color": "black",
    "title_font_size": 28,
    "label_font_size": 24,
    "n_labels": 5,
    "fmt": "{:.3g}",
    "width": 0.6,
    "height": 0.11,
    "position_x": 0.2,
    "position_y": 0.01,
}


@dataclass(frozen=True, eq=False)
class _View:
    """Where the camera looks from; unit vectors, and the eye that sees stripes, at infinity unless given."""

    towards_eye: FloatArray
    right: FloatArray
    up: FloatArray
    eye: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class _Sampled:
    geometry: LocalGeometry
    normal: FloatArray


def render(
    surfaces: Sequence[Surface],
    path: str | Path,
    *,
    colors: Sequence[str] | None = None,
    control_points: Sequence[bool] | None = None,
    field: Field | None = None,
    towards_eye: ArrayLike | None = None,
    eye_distance: float = np.inf,
    size: tuple[int, int] = (1600, 1200),
) -> None:
    """Draw surfaces into a PNG file.

    Parameters
    ----------
    surfaces : sequence of BSplineSurface or SemiStructuredSurface
    path : str or Path
        Written whole or not at all.
    colors : sequence of str, optional
        One for each surface; with stripes or bands the colour of the dark ones, black unless given; not used with
        curvatures.
    control_points : sequence of bool, optional
        For which surfaces the control points are drawn, those of each v-control curve (or row of the net) in a colour
        of its own and joined by a polygon.
    field : {"curvature", "gaussian", "zebra", "isophotes"}, optional
        Mean or Gaussian curvature with a scale in 1/length or 1/length^2 (the mean one positive where the surface
        bulges towards the eye); stripes mirrored in the surface; bands of equal angle to the light, 5 degrees each.
        Without, the surfaces are shaded.
    towards_eye : array_like, shape (3,), optional
        Direction from the model to the eye, z upwards; chosen from the surfaces unless given.
    eye_distance : float
        From where the stripes are seen, in extents of the model: from far away a plane shows one stripe, from near by
        several. The projection is parallel in any case.
    size : (int, int)
        Width and height in pixels.

    Raises
    ------
    OptionError
        No surface, another field, lists of different lengths, or a direction of length zero.
    FileError
        pyvista is not installed, or the file cannot be written.
    """
    check_picture(path, field)
    _check_lists(surfaces, colors=colors, control_points=control_points)
    pyvista = pyvista_module(path)
    count = int(np.clip(np.sqrt(_TOTAL / len(surfaces)), _COARSEST, _FINEST))
    samples = [_Sampled(*sampled(surface, count)) for surface in surfaces]
    if _extent(samples) == 0:
        raise OptionError("surfaces: all points coincide, so there is nothing to draw; give a surface with an extent")
    view = _view(samples) if towards_eye is None else _view_from(np.asarray(towards_eye, dtype=np.float64))
    if np.isfinite(eye_distance):
        middle = _all_points(samples).mean(axis=0)
        view = replace(view, eye=middle + eye_distance * _extent(samples) * view.towards_eye)
    shown = control_points or [False] * len(surfaces)
    polygons = [_polygons(surface) if show else [] for surface, show in zip(surfaces, shown, strict=True)]
    with atomic_path(path) as temporary, _quiet_vtk():
        plotter = pyvista.Plotter(off_screen=True, window_size=size)
        try:
            plotter.set_background("white")
            if field is None:
                palette = colors or [PALETTE[i % len(PALETTE)] for i in range(len(surfaces))]
                for item, color in zip(samples, palette, strict=True):
                    _add_shaded(plotter, item, color)
            else:
                _add_field(plotter, samples, field, view, colors)
            _add_outlines(plotter, pyvista, samples)
            points = [_all_points(samples), *_add_lifted(plotter, pyvista, samples, polygons, view)]
            width = 0.84 if field in ("curvature", "gaussian") else 1.0
            _aim(plotter, np.concatenate(points), view, size, width)
            plotter.enable_anti_aliasing("ssaa")
            plotter.screenshot(str(temporary))
        finally:
            plotter.close()


def _check_lists(surfaces: Sequence[Surface], **lists: Sequence[object] | None) -> None:
    """Refuse no surface, and lists that do not have one entry for each."""
    if not surfaces:
        raise OptionError("surfaces: found none, expected at least one")
    for name, given in lists.items():
        if given is not None and len(given) != len(surfaces):
            raise OptionError(f"{name}: found {len(given)}, expected {len(surfaces)}, one for each surface")


def _add_lifted(
    plotter: Any, pyvista: Any, samples: Sequence[_Sampled], polygons: Sequence[list[FloatArray]], view: _View
) -> list[FloatArray]:
    """Add control polygons in front of all surfaces, and return their rows where they are."""
    # In parallel projection a shift towards the eye changes nothing but what hides what: no control point is hidden by
    # a surface.
    lift = 2 * float(np.ptp(_all_points(samples) @ view.towards_eye)) * view.towards_eye
    for rows in polygons:
        _add_polygons(plotter, pyvista, [row + lift for row in rows], _extent(samples))
    return [row for rows in polygons for row in rows]


def check_picture(path: str | Path, field: str | None) -> None:
    """Refuse what `render` cannot draw; long work calls this first.

    Raises
    ------
    OptionError
        A suffix other than .png, or an unknown field.
    FileError
        pyvista is not installed.
    """
    if field is not None and field not in get_args(Field):
        raise OptionError(f"color: found {field!r}, expected one of {', '.join(get_args(Field))}")
    if Path(path).suffix.lower() != ".png":
        raise OptionError(f"{shown(path)}: suffix {shown(Path(path).suffix)!r} cannot be drawn, expected .png")
    pyvista_module(path)


@contextmanager
def _quiet_vtk() -> Iterator[None]:
    """Keep VTK from warning, on a machine without a display, that it has none: it then draws without one."""
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)


def _view(samples: Sequence[_Sampled]) -> _View:
    right, up, towards_eye = line_of_sight([(item.geometry.point, item.normal, _area(item)) for item in samples])
    return _View(towards_eye, right, up)


def line_of_sight(surfaces: Sequence[tuple[FloatArray, FloatArray, FloatArray]]) -> FloatArray:
    """Return unit rows right, up, towards the eye, from where surfaces are seen well.

    The eye looks along the normal that most of the area shares, a little from above and from the right. The sign of a
    normal does not matter: the dominant eigenvector of the sum of n n^T over the area is taken.

    Parameters
    ----------
    surfaces : sequence of (points, normals, area elements)
        Samples of each surface, shapes (n_u, n_v, 3), (n_u, n_v, 3) and (n_u, n_v).
    """
    spread = np.zeros((3, 3))
    for _, normals, area in surfaces:
        share = area / max(float(area.sum()), np.finfo(np.float64).tiny)
        spread += np.einsum("ij,ija,ijb->ab", share, normals, normals)
    normal = _signed(np.linalg.eigh(spread)[1][:, -1])
    points = np.concatenate([p.reshape(-1, 3) for p, _, _ in surfaces])
    across = (points - points.mean(axis=0)) @ (np.eye(3) - np.outer(normal, normal))
    # The longest extent lies across the picture.
    right = _signed(np.linalg.eigh(across.T @ across)[1][:, -1])
    up = np.cross(normal, right)
    towards_eye = _unit(normal - 0.55 * up + 0.35 * right)
    right = _unit(np.cross(up, towards_eye))
    return np.stack([right, np.cross(towards_eye, right), towards_eye])


def _view_from(direction: FloatArray) -> _View:
    """Look from a direction, with z upwards, or y where the direction is that of z."""
    if direction.shape != (3,) or not 0 < np.linalg.norm(direction) < np.inf:
        raise OptionError(f"towards_eye: found {direction.tolist()}, expected three numbers that are not all zero")
    towards_eye = _unit(direction)
    upwards = np.eye(3)[2 if np.hypot(*towards_eye[:2]) > _STEEP else 1]
    right = _unit(np.cross(upwards, towards_eye))
    return _View(towards_eye, right, np.cross(towards_eye, right))


def _signed(vector: FloatArray) -> FloatArray:
    """Of the two directions of an eigenvector, the one whose largest component is positive."""
    return vector if vector[np.argmax(np.abs(vector))] > 0 else -vector


def _unit(vector: FloatArray) -> FloatArray:
    return vector / np.linalg.norm(vector)


def _extent(samples: Sequence[_Sampled]) -> float:
    return float(np.ptp(_all_points(samples), axis=0).max())


def _all_points(samples: Sequence[_Sampled]) -> FloatArray:
    return np.concatenate([item.geometry.point.reshape(-1, 3) for item in samples])


def _area(item: _Sampled) -> FloatArray:
    """Return the area element at each sample, shape (len(u), len(v))."""
    return np.asarray(np.linalg.norm(np.cross(item.geometry.tangent_u, item.geometry.tangent_v), axis=-1))


def _aim(plotter: Any, points: FloatArray, view: _View, size: tuple[int, int], share: float) -> None:
    """Fit the points into the picture, in parallel projection; `share` of the height is theirs, from the top."""
    x, y, z = points @ view.right, points @ view.up, points @ view.towards_eye
    width, height = float(np.ptp(x)), float(np.ptp(y))
    scale = _MARGIN * max(width * size[1] / size[0], height / share, 1e-300) / 2
    middle_x, middle_y = (x.min() + x.max()) / 2, (y.min() + y.max()) / 2
    middle_y -= (1 - share) * scale
    focus = middle_x * view.right + middle_y * view.up + (z.min() + z.max()) / 2 * view.towards_eye
    distance = 4 * (scale + float(np.ptp(z)))
    plotter.camera_position = [focus + distance * view.towards_eye, focus, view.up]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = scale
    plotter.reset_camera_clipping_range()


def _add_shaded(plotter: Any, item: _Sampled, color: str) -> None:
    mesh = triangle_mesh(item.geometry, item.normal)
    actor = plotter.add_mesh(mesh, color=color, ambient=0.25, diffuse=0.75, specular=0.25, specular_power=20)
    actor.prop.interpolation = "Phong"


def _add_outlines(plotter: Any, pyvista: Any, samples: Sequence[_Sampled]) -> None:
    """Draw the four edges of every surface."""
    edges = [edge for p in (item.geometry.point for item in samples) for edge in (p[0], p[-1], p[:, 0], p[:, -1])]
    starts = np.cumsum([0, *(len(edge) for edge in edges)])
    lines = [[len(edge), *range(start, start + len(edge))] for start, edge in zip(starts, edges, strict=False)]
    outline = pyvista.PolyData(np.concatenate(edges), lines=np.concatenate(lines))
    plotter.add_mesh(outline, color="#202020", line_width=2, lighting=False)


def _add_field(
    plotter: Any, samples: Sequence[_Sampled], field: Field, view: _View, dark: Sequence[str] | None
) -> None:
    values = [_field_values(item, field, view) for item in samples]
    options: dict[str, Any] = {"interpolate_before_map": True, "ambient": 0.6, "diffuse": 0.4}
    if field in ("curvature", "gaussian"):
        power = 1 if field == "curvature" else 2
        limit = _color_limit(values, samples, _extent(samples) ** -power)
        title = "mean curvature, 1/length\n" if power == 1 else "Gaussian curvature, 1/length\u00b2\n"
        options |= {"cmap": "coolwarm", "clim": (-limit, limit), "scalar_bar_args": {"title": title, **_BAR}}
    else:
        bands = _STRIPES if field == "zebra" else _ISOPHOTES
        usual, light = ("#101010", "#ffffff") if field == "zebra" else ("#1f4e79", "#f2f2f2")
        end = 180 if field == "zebra" else 90
        options |= {"n_colors": bands, "clim": (0, end), "show_scalar_bar": False}
    for i, (item, value) in enumerate(zip(samples, values, strict=True)):
        if field in ("zebra", "isophotes"):
            options["cmap"] = [dark[i] if dark else usual, light] * (bands // 2)
        mesh = triangle_mesh(item.geometry, item.normal)
        mesh.point_data["field"] = np.nan_to_num(value).ravel()
        actor = plotter.add_mesh(mesh, scalars="field", **options)
        actor.prop.interpolation = "Phong"


def _field_values(item: _Sampled, field: Field, view: _View) -> FloatArray:
    if field == "gaussian":
        return item.geometry.gaussian
    if field == "curvature":
        # Towards the normal is positive in `curvature`; bulging towards the eye is what a reader sees, point by point:
        # of a whole tube the outside of one part is seen, and the inside of another.
        return item.geometry.mean * np.where(item.normal @ view.towards_eye >= 0, -1.0, 1.0)
    if field == "isophotes":
        angle = isophote_angle(item.normal, _unit(view.towards_eye + view.up))
        # Either side of a surface may be the outer one.
        return np.minimum(angle, 180 - angle)
    # The pattern of `zebra` about an axis across the picture, so that stripes cross edges of either direction.
    seen_from = view.towards_eye if view.eye is None else view.eye - item.geometry.point
    return mirror_angle(item.normal, seen_from, view.right + view.up)


def _color_limit(values: Sequence[FloatArray], samples: Sequence[_Sampled], natural: float) -> float:
    """Return the end of a symmetric scale that holds 98 % of the area; not below rounding."""
    found = np.concatenate([np.abs(value).ravel() for value in values])
    area = np.concatenate([(_area(item) / item.geometry.point[..., 0].size).ravel() for item in samples])
    kept = np.isfinite(found)
    order = np.argsort(found[kept])
    share = np.cumsum(area[kept][order])
    if not len(share) or share[-1] <= 0:
        return natural
    limit = float(found[kept][order][np.searchsorted(share, 0.98 * share[-1])])
    return limit if limit > 1e-9 * natural else natural


def _polygons(surface: Surface) -> list[FloatArray]:
    if isinstance(surface, SemiStructuredSurface):
        return [curve.control_points for curve in surface.control_curves]
    return list(surface.control_points)


def _add_polygons(plotter: Any, pyvista: Any, rows: Sequence[FloatArray], extent: float) -> None:
    for i, row in enumerate(rows):
        color = CURVE_COLORS[i % len(CURVE_COLORS)]
        if np.ptp(row, axis=0).max() > 0:
            line = pyvista.lines_from_points(row)
            plotter.add_mesh(line.tube(radius=0.0015 * extent, n_sides=12), color=color, ambient=0.4)
        balls = pyvista.PolyData(row).glyph(geom=pyvista.Sphere(radius=0.0055 * extent), scale=False, orient=False)
        plotter.add_mesh(balls, color=color, ambient=0.4)
