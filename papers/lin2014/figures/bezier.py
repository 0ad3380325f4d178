"""Figures 1 to 3 of the paper, remade: semi-structured surfaces, a divided and a trimmed Bezier patch.

The paper prints no control points; the geometry is our own. The curves c1 to c4 and all numbers of control points are
those of the paper.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from semispline.derivations.trimming import Hole, Side
from semispline.papers.lin2014.figures.panels import DPI, save, show
from semispline.solver.arrays import FloatArray
from semispline.solver.io import check_output
from semispline.solver.pictures import CURVE_COLORS, PALETTE
from semispline.solver.splines import (
    BezierFunction,
    BSplineCurve,
    BSplineSurface,
    SemiStructuredSurface,
    Surface,
    bezier_patch,
    clamped,
    divide_bezier,
    greville,
    trim_bezier,
)

# Below Fig. 3: c1 (left), c2 (right), c3 (bottom), c4 (top).
TRIMMING_CURVES = Hole(
    left=Side.decimal("0.4", "0.6", "0.3", "0.1", "0.25"),
    right=Side.decimal("0.2", "0.5", "0.8", "0.75"),
    bottom=Side.decimal("0.3", "0.8", "0.4", "0.7", "0.1", "0.2"),
    top=Side.decimal("0.25", "0.75", "0.6", "0.8", "0.3", "0.5"),
)
# In Fig. 1: numbers of control points of the seven v-control curves.
FIGURE_1_COUNTS = (5, 5, 5, 7, 6, 6, 6)
# The paper's names of the pieces; which corner has which number is our choice.
PIECES = {
    "left": "Q1", "right": "Q2", "bottom": "Q3", "top": "Q4",
    "lower left": "P1", "lower right": "P2", "upper right": "P3", "upper left": "P4",
}  # fmt: skip
_DIVIDING = (0.3, 0.95, 0.2, 0.6)
_PLAIN = "#c9d3dc"
_RENDERED = (1600, 1200)


def figure_1_surface() -> SemiStructuredSurface:
    """Return a bicubic semi-structured surface with the numbers of control points of Fig. 1."""
    curves = []
    knots_u = clamped(np.arange(1, 4) / 4, 3, 0.0, 1.0)
    for i, (u, count) in enumerate(zip(greville(knots_u, 3), FIGURE_1_COUNTS, strict=True)):
        inner = (np.arange(1, count - 3) + 0.12 * np.cos(2.0 * i)) / (count - 3)
        knots = clamped(inner, 3, 0.0, 1.0)
        v = greville(knots, 3)
        height = 0.55 * np.sin(np.pi * u) * (1 + 0.5 * np.cos(2 * np.pi * v + 3 * u)) + 0.18 * np.sin(3 * np.pi * v) * u
        curves.append(BSplineCurve(3, knots, np.stack([np.full_like(v, 2.6 * u), 1.9 * v, height], axis=1)))
    return SemiStructuredSurface(3, knots_u, tuple(curves))


def bicubic_patch() -> BSplineSurface:
    """Return the bicubic Bezier patch that stands for those of Figs. 2 and 3."""
    heights = np.array([[0.0, 0.5, 0.1, 0.4], [0.5, 1.5, 0.3, 0.8], [0.2, -0.4, 1.5, 0.7], [0.6, 0.4, 0.9, 0.0]])
    u, v = np.meshgrid(np.arange(4) / 3, np.arange(4) / 3, indexing="ij")
    return bezier_patch(np.stack([2.4 * u, 2.0 * v, 0.6 * heights], axis=2))


def trimmed_patch() -> dict[str, Surface]:
    """Return the eight pieces of the patch trimmed by the printed curves, by the paper's names Q1..Q4, P1..P4."""
    sides = {name: _bezier_function(getattr(TRIMMING_CURVES, name)) for name in ("left", "right", "bottom", "top")}
    return {PIECES[name]: piece for name, piece in trim_bezier(bicubic_patch(), **sides).items()}


def draw_figure_1(path: str | Path) -> None:
    """Draw Fig. 1: the surface and the control points of each v-control curve, in a colour of its own."""
    check_output(path)
    surface = figure_1_surface()
    figure = Figure(figsize=(8, 5.4), dpi=DPI)
    axes = figure.add_axes((0.0, 0.09, 1.0, 0.91))
    show(axes, [surface], _RENDERED, colors=[_PLAIN], control_points=[True])
    for i, count in enumerate(FIGURE_1_COUNTS):
        x = 0.08 + 0.13 * i
        figure.text(x, 0.045, "●", color=CURVE_COLORS[i], fontsize=13, va="center", ha="right")
        figure.text(x + 0.006, 0.045, f"$P_{i}(v)$: {count}", fontsize=11, va="center")
    save(figure, path)


def draw_figure_2(path: str | Path) -> None:
    """Draw Fig. 2: a divided domain, the numbers of control points of both parts, and the parts in space."""
    check_output(path)
    lower, upper = divide_bezier(bicubic_patch(), _DIVIDING)
    figure = Figure(figsize=(11, 8.2), dpi=DPI)
    panels = [(0.06, 0.555, 0.38, 0.42), (0.54, 0.545, 0.43, 0.43), (0.02, 0.05, 0.47, 0.42), (0.51, 0.05, 0.47, 0.42)]
    axes = [figure.add_axes(panel) for panel in panels]
    _draw_division(axes[0])
    _draw_rows(axes[1], lower, upper)
    show(axes[2], [lower], _RENDERED, colors=[_tint(PALETTE[2])], control_points=[True])
    show(axes[3], [upper], _RENDERED, colors=[_tint(PALETTE[3])], control_points=[True])
    lists = (", ".join(str(len(curve.control_points)) for curve in part.control_curves) for part in (lower, upper))
    titles = ["domain, cut by $v = v(u)$ of degree 3", "control points in each row"]
    titles += [
        f"${name}(u, v)$, control points per curve: {counts}"
        for name, counts in zip(("P_1", "P_2"), lists, strict=True)
    ]
    _caption(figure, panels, titles, (0.495, 0.015))
    save(figure, path)


def draw_trimmed_patch(path: str | Path) -> None:
    """Draw Fig. 3: the patch, its domain with c1 to c4, the eight pieces, and the control points of each curve."""
    check_output(path)
    pieces = trimmed_patch()
    colors = [PALETTE[i] for i in range(len(pieces))]
    figure = Figure(figsize=(12, 9.6), dpi=DPI)
    panels = [(0.01, 0.545, 0.46, 0.44), (0.55, 0.57, 0.40, 0.41), (0.01, 0.045, 0.46, 0.44), (0.51, 0.045, 0.47, 0.44)]
    axes = [figure.add_axes(panel) for panel in panels]
    show(axes[0], [bicubic_patch()], _RENDERED, colors=[_PLAIN], control_points=[True])
    _draw_trimmed_domain(axes[1], dict(zip(pieces, colors, strict=True)))
    show(axes[2], list(pieces.values()), _RENDERED, colors=colors, control_points=None)
    curved = [isinstance(piece, SemiStructuredSurface) for piece in pieces.values()]
    show(axes[3], list(pieces.values()), _RENDERED, colors=[_tint(color) for color in colors], control_points=curved)
    titles = [
        "bicubic Bézier patch with its control points",
        "domain with trimming curves",
        "the eight pieces; Q1 to Q4 are semi-structured",
        "control points of each curve of Q1 to Q4",
    ]
    _caption(figure, panels, titles, (0.51, 0.015))
    save(figure, path)


def _caption(
    figure: Figure, panels: Sequence[tuple[float, ...]], titles: Sequence[str], heights: tuple[float, float]
) -> None:
    """Put (a) to (d) below two rows of two panels."""
    for i, (panel, title) in enumerate(zip(panels, titles, strict=True)):
        text = f"({'abcd'[i]}) {title}"
        figure.text(panel[0] + panel[2] / 2, heights[i // 2], text, ha="center", va="center", fontsize=11)


def _tint(color: str) -> str:
    """Lighten a colour, so that control points stand out on it."""
    red, green, blue = (0.4 * x + 0.6 for x in to_rgb(color))
    return to_hex((red, green, blue))


def _bezier_function(side: Side) -> BezierFunction:
    return BezierFunction(np.array(side.coefficients, dtype=np.float64), float(side.start), float(side.end))


def _draw_division(axes: Any) -> None:
    function = BezierFunction(np.array(_DIVIDING))
    t = np.linspace(0, 1, 200)
    v = function.evaluate(t)
    axes.fill_between(t, 0, v, color=PALETTE[2], alpha=0.35, lw=0)
    axes.fill_between(t, v, 1, color=PALETTE[3], alpha=0.35, lw=0)
    axes.plot(t, v, color="black", lw=2)
    k = len(_DIVIDING) - 1
    axes.plot(np.arange(k + 1) / k, _DIVIDING, "o--", color="#444444", lw=1, ms=6, clip_on=False, zorder=5)
    offsets = ((8, -14), (8, -10), (-6, -18), (7, 6))
    for i, (value, offset) in enumerate(zip(_DIVIDING, offsets, strict=True)):
        axes.annotate(f"$v_{i}$", (i / k, value), offset, textcoords="offset points", fontsize=12)
    axes.text(0.78, 0.16, "$D_1$", fontsize=16)
    axes.text(0.78, 0.8, "$D_2$", fontsize=16)
    _unit_square(axes)


def _draw_rows(axes: Any, lower: SemiStructuredSurface, upper: SemiStructuredSurface) -> None:
    """Draw each row of both parts as a line of as many points as it has control points."""
    n = len(lower.control_curves)
    for base, part, name, color in ((0.0, lower, "P_1", PALETTE[2]), (n + 0.6, upper, "P_2", PALETTE[3])):
        for s, curve in enumerate(part.control_curves):
            count = len(curve.control_points)
            axes.plot(np.linspace(0, 1, count), np.full(count, base + s), "o-", color=color, ms=6, lw=1.2)
            label = f"$Q_0^{s}$" if name == "P_1" else f"$Q_{s}^{n - 1 - s}$"
            axes.text(-0.05, base + s, label, ha="right", va="center", fontsize=12)
            axes.text(1.05, base + s, str(count), va="center", fontsize=12)
        axes.text(-0.27, base + (n - 1) / 2, f"${name}$", fontsize=15, va="center", color=color)
    axes.set_xlim(-0.3, 1.2)
    axes.set_ylim(-0.6, 2 * n + 0.2)
    axes.axis("off")


def _draw_trimmed_domain(axes: Any, colors: dict[str, str]) -> None:
    sides = {name: getattr(TRIMMING_CURVES, name) for name in ("left", "right", "bottom", "top")}
    curves = {name: _side_points(name, side) for name, side in sides.items()}
    left, right, bottom, top = (sides[name] for name in sides)
    edge = {"left": (0, None), "right": (1, None), "bottom": (None, 0), "top": (None, 1)}
    for name, points in curves.items():
        u, v = edge[name]
        across = points[[-1, 0]].copy()
        across[:, 0 if u is not None else 1] = u if u is not None else v
        _fill(axes, np.concatenate([points, across]), colors[PIECES[name]])
    rectangles = {
        "lower left": (0, bottom.start, 0, left.start),
        "lower right": (bottom.end, 1, 0, right.start),
        "upper right": (top.end, 1, right.end, 1),
        "upper left": (0, top.start, left.end, 1),
    }
    for name, (u0, u1, v0, v1) in rectangles.items():
        corners = np.array([(u0, v0), (u1, v0), (u1, v1), (u0, v1)], dtype=np.float64)
        _fill(axes, corners, colors[PIECES[name]])
        axes.text(*corners.mean(axis=0), f"$P_{PIECES[name][1]}$", ha="center", va="center", fontsize=14)
    for name, at in {"left": (0.1, 0.5), "right": (0.9, 0.35), "bottom": (0.55, 0.15), "top": (0.5, 0.8)}.items():
        axes.text(*at, f"$Q_{PIECES[name][1]}$", ha="center", va="center", fontsize=14)
    labels = {"left": (0.27, 0.5), "right": (0.735, 0.34), "bottom": (0.47, 0.39), "top": (0.54, 0.61)}
    for i, name in enumerate(curves):
        axes.plot(*curves[name].T, color="black", lw=2.2)
        axes.text(*labels[name], f"$c_{i + 1}$", ha="center", va="center", fontsize=13)
    _unit_square(axes)


def _side_points(name: str, side: Side) -> FloatArray:
    t = np.linspace(float(side.start), float(side.end), 100)
    value = _bezier_function(side).evaluate(t)
    return np.stack((value, t) if name in ("left", "right") else (t, value), axis=1)


def _fill(axes: Any, points: FloatArray, color: str) -> None:
    axes.add_patch(Polygon(points, closed=True, facecolor=color, alpha=0.6, edgecolor="black", lw=0.8))


def _unit_square(axes: Any) -> None:
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
    axes.set_aspect("equal")
    axes.set_xlabel("$u$", labelpad=0)
    axes.set_ylabel("$v$", labelpad=0, rotation=0)
