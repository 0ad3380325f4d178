"""The interactive view of the report: sampled surfaces packed for a small WebGL2 viewer (`viewer.js`).

Plotly was the other choice. Its library alone is some 5 MB in a page, every view takes one of the browser's few WebGL
contexts, it shades by the normals of triangles, and its colours sit on vertices, so that stripes could not follow the
eye. Here a page with a hundred surfaces takes a few megabytes, one context serves all views, and stripes are drawn for
each pixel from exact normals.
"""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import ParametricSurface, geometry_grid
from semispline.solver.pictures.plotting import BASE_COLOR, BLEND_COLOR
from semispline.solver.pictures.views import line_of_sight
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface

# Samples along each parameter, at least; every breakpoint is one of them.
_SAMPLES = 44
_SHORT, _SIGNED_SHORT = 65535, 32767
_MARGIN = 1.08


@dataclass(frozen=True, eq=False)
class Piece:
    """One sampled surface.

    Attributes
    ----------
    label, caption : str
        For the list of blends, and the line below the view.
    color : str
    points, normals : ndarray, shape (rows, columns, 3)
        Exact ones; where the surface is degenerate the normal is zero.
    mean : ndarray, shape (rows, columns)
        Mean curvature, 1/length, positive where the surface bends towards its normal; zero where it is degenerate.
    area : ndarray, shape (rows, columns)
        Area element.
    polygons : tuple of ndarray, shape (n, 3)
        Control points of each v-control curve, or row of the net.
    """

    label: str
    caption: str
    color: str
    points: FloatArray
    normals: FloatArray
    mean: FloatArray
    area: FloatArray
    polygons: tuple[FloatArray, ...] = ()


@dataclass(frozen=True, eq=False)
class Model:
    """Two bases and what some methods put between them; the first blend is the one that is shown at first."""

    name: str
    title: str
    bases: tuple[Piece, Piece]
    blends: tuple[Piece, ...]


def model(
    name: str,
    title: str,
    bases: Sequence[ParametricSurface],
    blends: Sequence[tuple[str, str, ParametricSurface]],
) -> Model:
    """Sample the bases, and the blends, given as (label, caption, surface)."""
    first, second = (piece("base", "", BASE_COLOR, surface) for surface in bases)
    between = (piece(label, caption, BLEND_COLOR, surface) for label, caption, surface in blends)
    return Model(name, title, (first, second), tuple(between))


def piece(label: str, caption: str, color: str, surface: ParametricSurface) -> Piece:
    """Sample a surface with its exact normals and mean curvature."""
    u, v = (_samples(breaks) for breaks in surface.breakpoints)
    local = geometry_grid(surface, u, v)
    polygons: tuple[FloatArray, ...] = ()
    if isinstance(surface, SemiStructuredSurface):
        polygons = tuple(curve.control_points for curve in surface.control_curves)
    elif isinstance(surface, BSplineSurface):
        polygons = tuple(surface.control_points)
    area = np.linalg.norm(np.cross(local.tangent_u, local.tangent_v), axis=2)
    normals, mean = np.nan_to_num(local.normal), np.nan_to_num(local.mean)
    return Piece(label, caption, color, local.point, normals, mean, area, polygons)


def _samples(breaks: FloatArray) -> FloatArray:
    each = max(2, -(-_SAMPLES // (len(breaks) - 1)))
    inner = np.linspace(0, 1, each, endpoint=False)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])


def packed(model: Model) -> dict[str, Any]:
    """Return what `viewer.js` reads: numbers of 16 bits in base64, and how to scale them."""
    shown = (*model.bases, *model.blends)
    points = np.concatenate([p.points.reshape(-1, 3) for p in shown])
    low, box = points.min(axis=0), np.maximum(np.ptp(points, axis=0), 1e-12 * np.ptp(points))
    lead = (*model.bases, model.blends[0])
    limit = curvature_limit(lead)
    seen = np.concatenate([p.points.reshape(-1, 3) for p in lead])
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    size = float(np.linalg.norm(seen - middle, axis=1).max())
    turn = line_of_sight([(p.points, p.normals, p.area) for p in lead])
    projected = (seen - middle) @ turn.T
    # The width of the view is 1.6 times its height.
    fit = size / (_MARGIN * max(float(np.abs(projected[:, 0]).max()), 1.6 * float(np.abs(projected[:, 1]).max())))
    return {
        "camera": np.round(turn, 6).tolist(),
        "middle": ((middle - low) / size).tolist(),
        "box": (box / size).tolist(),
        "fit": fit,
        "bases": [_packed_piece(p, low, box, size, limit) for p in model.bases],
        "blends": [_packed_piece(p, low, box, size, limit) for p in model.blends],
    }


def _packed_piece(piece: Piece, low: FloatArray, box: FloatArray, size: float, limit: float) -> dict[str, Any]:
    rows, columns = piece.mean.shape
    vertices = np.zeros((rows, columns, 8), dtype="<i2")
    vertices[..., :3] = np.rint((piece.points - low) / box * _SHORT).astype("<u2").view("<i2")
    vertices[..., 3] = np.rint(np.clip(piece.mean / limit, -1, 1) * _SIGNED_SHORT)
    vertices[..., 4:7] = np.rint(piece.normals * _SIGNED_SHORT)
    record: dict[str, Any] = {
        "caption": piece.caption,
        "color": piece.color,
        "rows": rows,
        "columns": columns,
        "vertices": _base64(vertices),
    }
    if piece.polygons:
        control_points = (np.concatenate(piece.polygons) - low) / size
        counts = [len(polygon) for polygon in piece.polygons]
        record["polygons"] = {"counts": counts, "points": _base64(control_points.astype("<f4"))}
    return record


def curvature_limit(pieces: Sequence[Piece]) -> float:
    """Return the end of a symmetric scale of mean curvature that holds 98 % of the area, 1/length."""
    bend = np.concatenate([np.abs(p.mean).ravel() for p in pieces])
    area = np.concatenate([p.area.ravel() / p.area.size for p in pieces])
    order = np.argsort(bend)
    share = np.cumsum(area[order])
    found = float(bend[order][np.searchsorted(share, 0.98 * share[-1])])
    flat = 1e-9 / float(np.ptp(np.concatenate([p.points.reshape(-1, 3) for p in pieces]), axis=0).max())
    return max(found, flat)


def _base64(array: Any) -> str:
    return b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")


def viewer_html(model: Model) -> str:
    """Return the view of a model with its data; the page needs `viewer_script` once, at its end."""
    options = "".join(f"<option value='{i}'>{escape(blend.label)}</option>" for i, blend in enumerate(model.blends))
    limit = curvature_limit((*model.bases, model.blends[0]))
    modes = (("shaded", "shaded"), ("curvature", "mean curvature"), ("zebra", "zebra"))
    buttons = "".join(f"<button type='button' data-mode='{mode}'>{text}</button>" for mode, text in modes)
    # No text may end the script element.
    data = json.dumps(packed(model), allow_nan=False).replace("<", "\\u003c")
    return f"""<div class="viewer" id="view-{escape(model.name)}">
<div class="bar"><label>blend <select>{options}</select></label><span class="modes">{buttons}</span>
<label><input type="checkbox"> control points</label><button type="button" data-reset>reset</button></div>
<canvas tabindex="0" role="img" aria-label="interactive view: {escape(model.title)}"></canvas>
<p class="scale" hidden>{-limit:.3g} <span></span> +{limit:.3g} mean curvature, 1/length, positive where the surface
bulges towards the eye</p>
<p class="numbers"></p>
<p class="hint">Drag or arrow keys turn, wheel (after a click) or + and − zoom, shift and drag move.</p>
<script type="application/json">{data}</script></div>"""


def viewer_script() -> str:
    """Return the script that brings every view of a page to life."""
    return files("semispline.solver.pictures").joinpath("viewer.js").read_text(encoding="utf-8")
