"""Pictures of surfaces, off-screen, through pyvista (the extra `view`).

Shading and every colour follow the exact normals and curvatures of the surface, not those of the triangles.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image, ImageDraw

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import OptionError
from semispline.solver.io import atomic_path, pyvista_module, shown
from semispline.solver.pictures.deviation import Deviation, TrueFace, measure_deviation
from semispline.solver.pictures.fields import (
    Field,
    Scale,
    curvature_scale,
    distance_scale,
    field_values,
    mesh_options,
)
from semispline.solver.pictures.labels import (
    NOTHING,
    Seen,
    draw_labels,
    edge_anchor,
    face_anchors,
    font,
    placed,
)
from semispline.solver.pictures.samples import Sampled, all_points, extent_of, sample
from semispline.solver.pictures.views import (
    TITLE,
    Frame,
    View,
    ViewName,
    cells,
    framed,
    line_of_sight,
    named_view,
    view_from,
)
from semispline.solver.splines import SemiStructuredSurface, Surface
from semispline.solver.topology import EdgeLine, FaceMesh

BASE_COLOR, BLEND_COLOR = "#3f9b4f", "#d1402f"
# For surfaces side by side: Okabe and Ito's palette, which colour-blind readers tell apart.
PALETTE = ("#3f9b4f", "#d1402f", "#0072b2", "#e69f00", "#56b4e9", "#cc79a7", "#8c6d31", "#7f7f7f")
# For v-control curves on top of red and green.
CURVE_COLORS = ("#0b3c8c", "#e8a200", "#6a0dad", "#00a0b0", "#111111", "#c2185b", "#5d4037", "#ffe14d")
# What is drawn around that of which distances are shown.
_AROUND = "#c9c9c9"
_SIZE, _SIZE_OF_SEVERAL = (1600, 1200), (1200, 900)
# Of the height of a picture: its scale; of a view: names of faces and edges.
_SCALE, _NAMES = 0.1, 0.024
# Edges of one face among many are named where it has so much room, in half heights of a name.
_ROOM = 2.5
# Widths of lines, in pixels of the finer picture that each is made from.
_NARROW, _BROAD = 2, 12
# Lines lie this much before their surface, of the extent: they are on it, and half of them would be hidden.
_BEFORE = 2e-3


@dataclass(frozen=True, eq=False)
class Drawn:
    """A surface in a picture.

    Attributes
    ----------
    surface : BSplineSurface or SemiStructuredSurface
    color : str, optional
        With stripes or bands that of the dark ones, black unless given; not used with scales.
    control_points : bool
        Draw them, those of each v-control curve (or row of the net) in a colour of its own and joined by a polygon.
    mesh : FaceMesh, optional
        The part that is drawn; without, all of it.
    edges : tuple of EdgeLine
        The lines around it; without, the four sides of the surface.
    label : str
        Its name, if it is to be seen.
    name_edges : bool
    around : bool
        Of distances from a face: it only stands around what is measured.
    """

    surface: Surface
    color: str | None = None
    control_points: bool = False
    mesh: FaceMesh | None = None
    edges: tuple[EdgeLine, ...] = ()
    label: str = ""
    name_edges: bool = False
    around: bool = False


@dataclass(frozen=True)
class Picture:
    """What a picture shows.

    Attributes
    ----------
    unseen : tuple of str
        Names of surfaces that no view shows, or for which there was no room.
    unnamed_edges : int
        Edges that were to be named, and are not for the same reasons.
    deviation : Deviation or None
        Where distances from a face were drawn.
    """

    unseen: tuple[str, ...]
    unnamed_edges: int
    deviation: Deviation | None


def render(
    surfaces: Sequence[Surface | Drawn],
    path: str | Path,
    *,
    field: Field | None = None,
    true_face: TrueFace | None = None,
    views: Sequence[ViewName] = (),
    heavy_edges: bool = False,
    towards_eye: ArrayLike | None = None,
    eye_distance: float = np.inf,
    size: tuple[int, int] | None = None,
) -> Picture:
    """Draw surfaces into a PNG file.

    Parameters
    ----------
    surfaces : sequence of BSplineSurface, SemiStructuredSurface or Drawn
    path : str or Path
        Written whole or not at all.
    field : {"curvature", "gaussian", "zebra", "isophotes"}, optional
        Mean or Gaussian curvature with a scale in 1/length or 1/length^2 (the mean one positive where the surface
        bulges towards the eye); stripes mirrored in the surface; bands of equal angle to the light, 5 degrees each.
        Without, the surfaces are shaded.
    true_face : TrueFace, optional
        Instead: colour by the distance from this face, with a scale.
    views : sequence of {"iso", "front", "back", "left", "right", "top", "bottom"}
        Side by side, each with its name; z upwards. Without, one view that is chosen from the surfaces.
    heavy_edges : bool
        Draw edges broad.
    towards_eye : array_like, shape (3,), optional
        Direction from the model to the eye, z upwards, instead of views.
    eye_distance : float
        From where the stripes are seen, in extents of the model: from far away a plane shows one stripe, from near by
        several. The projection is parallel in any case.
    size : (int, int), optional
        Width and height in pixels, of each of several views; 1600 x 1200 for one, 1200 x 900 for each of several.

    Returns
    -------
    Picture

    Raises
    ------
    OptionError
        No surface, another field, or a direction of length zero.
    FileError
        pyvista is not installed, or the file cannot be written.
    """
    check_picture(path, field)
    if not surfaces:
        raise OptionError("surfaces: found none, expected at least one")
    items = [item if isinstance(item, Drawn) else Drawn(item) for item in surfaces]
    samples = sample([item.surface for item in items], [item.mesh for item in items])
    if views:
        seen_from = [named_view(name) for name in views]
    elif towards_eye is not None:
        seen_from = [view_from(towards_eye)]
    else:
        right, up, towards = line_of_sight([(s.geometry.point, s.normal, s.area) for s in samples])
        seen_from = [View(towards, right, up)]
    size = size or (_SIZE_OF_SEVERAL if len(seen_from) > 1 else _SIZE)
    if np.isfinite(eye_distance):
        middle, away = all_points(samples).mean(axis=0), eye_distance * extent_of(samples)
        seen_from = [replace(view, eye=middle + away * view.towards_eye) for view in seen_from]
    deviation, distances = None, None
    scale = None if field is None else curvature_scale(field, samples)
    if true_face is not None:
        distances = [
            None if item.around else true_face.distances(s.points) for item, s in zip(items, samples, strict=True)
        ]
        inside = [(s, d) for s, d in zip(samples, distances, strict=True) if d is not None]
        deviation = measure_deviation(*map(list, zip(*inside, strict=True)))
        scale = distance_scale(true_face.name, true_face.unit, deviation.largest)
    scene = _Scene(items, samples, field, scale, distances, heavy_edges)
    rows, columns = cells(len(seen_from))
    # The scale takes its place below a single view from the view itself.
    strip = 0 if scale is None else round(_SCALE * size[1] * rows)
    cell = size if len(seen_from) > 1 else (size[0], size[1] - strip)
    whole = Image.new("RGB", (columns * cell[0], rows * cell[1] + strip), "white")
    named: set[tuple[int, str]] = set()
    with _quiet_vtk():
        for k, view in enumerate(seen_from):
            image, texts = scene.picture(view, cell)
            whole.paste(image, (k % columns * cell[0], k // columns * cell[1]))
            named |= texts
    if scale is not None:
        whole.paste(scale.strip((whole.width, strip)), (0, rows * cell[1]))
    with atomic_path(path) as temporary:
        whole.save(temporary, format="PNG")
    unseen = tuple(item.label for k, item in enumerate(items) if item.label and (k, item.label) not in named)
    of_edges = {(k, line.name) for k, item in enumerate(items) if item.name_edges for line in item.edges}
    return Picture(unseen, len(of_edges - named), deviation)


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


class _Scene:
    """What is drawn in every view."""

    def __init__(
        self,
        items: Sequence[Drawn],
        samples: Sequence[Sampled],
        field: Field | None,
        scale: Scale | None,
        distances: Sequence[FloatArray | None] | None,
        heavy_edges: bool,
    ) -> None:
        self.items, self.samples, self.field, self.scale = items, samples, field, scale
        self.distances, self.heavy_edges = distances, heavy_edges
        self.meshes = [item.polydata() for item in samples]
        self.extent = extent_of(samples)
        self.polygons = [_polygons(item.surface) if item.control_points else [] for item in items]
        self.lines = [
            [line.points for line in item.edges] or sampled.borders
            for item, sampled in zip(items, samples, strict=True)
        ]

    def picture(self, view: View, size: tuple[int, int]) -> tuple[Image.Image, set[tuple[int, str]]]:
        """Return one view, and the names that it shows, each with the number of its surface."""
        rows = [row for polygon in self.polygons for row in polygon]
        frame = framed(np.concatenate([all_points(self.samples), *rows]), view, size)
        plotter = _plotter(size)
        try:
            for k, mesh in enumerate(self.meshes):
                self._add(plotter, k, mesh, view)
            self._add_lines(plotter, view)
            self._add_lifted(plotter, view)
            frame.aim(plotter)
            plotter.enable_anti_aliasing("ssaa")
            image = Image.fromarray(np.asarray(plotter.screenshot(return_img=True))[..., :3])
        finally:
            plotter.close()
        names: set[tuple[int, str]] = set()
        if any(item.label or item.name_edges for item in self.items):
            names = self._name(image, frame)
        if view.name:
            height = round(TITLE * size[1])
            ImageDraw.Draw(image).text((height / 2, height / 2), view.name, fill="#404040", font=font(height))
        return image, names

    def _add(self, plotter: Any, k: int, mesh: Any, view: View) -> None:
        item, sampled = self.items[k], self.samples[k]
        values = None if self.distances is None else self.distances[k]
        if self.field is not None:
            values = np.nan_to_num(field_values(sampled, self.field, view)).ravel()
        if values is None:
            color = _AROUND if self.distances is not None else item.color or PALETTE[k % len(PALETTE)]
            actor = plotter.add_mesh(mesh, color=color, ambient=0.35, diffuse=0.7, specular=0.2, specular_power=20)
        else:
            mesh.point_data["field"] = values
            actor = plotter.add_mesh(mesh, scalars="field", **mesh_options(self.field, self.scale, item.color))
        actor.prop.interpolation = "Phong"

    def _add_lines(self, plotter: Any, view: View) -> None:
        lines = [line + _BEFORE * self.extent * view.towards_eye for of_one in self.lines for line in of_one]
        if not lines:
            return
        starts = np.cumsum([0, *(len(line) for line in lines)])
        joined = [[len(line), *range(start, start + len(line))] for start, line in zip(starts, lines, strict=False)]
        outline = pyvista_module("mesh").PolyData(np.concatenate(lines), lines=np.concatenate(joined))
        plotter.add_mesh(outline, color="#202020", line_width=_BROAD if self.heavy_edges else _NARROW, lighting=False)

    def _add_lifted(self, plotter: Any, view: View) -> None:
        """Add control polygons in front of all surfaces."""
        # In parallel projection a shift towards the eye changes nothing but what hides what: no control point is hidden
        # by a surface.
        lift = 2 * float(np.ptp(all_points(self.samples) @ view.towards_eye)) * view.towards_eye
        for rows in self.polygons:
            _add_polygons(plotter, [row + lift for row in rows], self.extent)

    def _name(self, image: Image.Image, frame: Frame) -> set[tuple[int, str]]:
        """Draw the names of what is seen; return them, each with the number of its surface."""
        seen, heights = self._seen(frame)
        height = max(round(_NAMES * frame.size[1]), 9)
        anchors = list(face_anchors(seen, [item.label for item in self.items], height).values())
        alone = len(self.items) == 1
        for face in list(anchors):
            # Among many, a face that has no room for its own name has none for those of its edges.
            if not self.items[face.surface].name_edges or not (alone or face.room > _ROOM):
                continue
            for line in self.items[face.surface].edges:
                at = frame.pixels(line.points)
                anchor = edge_anchor(seen, heights, face.surface, at, line.name, height)
                anchors += [] if anchor is None else [replace(anchor, nearby=not alone)]
        labels = placed(anchors, frame.size, height)
        draw_labels(image, labels, height)
        return {(label.anchor.surface, label.anchor.text) for label in labels}

    def _seen(self, frame: Frame) -> tuple[Seen, FloatArray]:
        """Return the number of the surface at each pixel, and how near to the eye it is there, in pixels."""
        counts = [len(item.points) for item in self.samples]
        starts = np.cumsum([0, *counts[:-1]])
        triangles = np.concatenate([s.triangles + start for s, start in zip(self.samples, starts, strict=True)])
        numbers = np.repeat(np.arange(len(self.samples)), [len(s.triangles) for s in self.samples])
        faces = np.hstack([np.full((len(triangles), 1), 3), triangles]).ravel()
        mesh = pyvista_module("mesh").PolyData(all_points(self.samples), faces)
        mesh.cell_data["number"] = np.stack([numbers % 256, numbers // 256 % 256, numbers // 65536], 1).astype(np.uint8)
        plotter = _plotter(frame.size)
        try:
            plotter.add_mesh(mesh, scalars="number", rgb=True, lighting=False)
            plotter.disable_anti_aliasing()
            frame.aim(plotter)
            pixels = np.asarray(plotter.screenshot(return_img=True))[..., :3].astype(np.int64)
            heights = frame.heights(plotter)
        finally:
            plotter.close()
        found = pixels @ np.array([1, 256, 65536])
        return np.where(found < len(self.samples), found, NOTHING), heights


def _plotter(size: tuple[int, int]) -> Any:
    plotter = pyvista_module("picture").Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    return plotter


def _polygons(surface: Surface) -> list[FloatArray]:
    if isinstance(surface, SemiStructuredSurface):
        return [curve.control_points for curve in surface.control_curves]
    return list(surface.control_points)


def _add_polygons(plotter: Any, rows: Sequence[FloatArray], extent: float) -> None:
    pyvista = pyvista_module("picture")
    for i, row in enumerate(rows):
        color = CURVE_COLORS[i % len(CURVE_COLORS)]
        if np.ptp(row, axis=0).max() > 0:
            line = pyvista.lines_from_points(row)
            plotter.add_mesh(line.tube(radius=0.0015 * extent, n_sides=12), color=color, ambient=0.4)
        balls = pyvista.PolyData(row).glyph(geom=pyvista.Sphere(radius=0.0055 * extent), scale=False, orient=False)
        plotter.add_mesh(balls, color=color, ambient=0.4)
