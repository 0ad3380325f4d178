"""Figures 4 to 11 of the paper, remade on our own bases (`example_bases`): rendering, mean curvature, zebra.

Colours are those of the paper's captions: bases green, blends red.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from semispline.papers.baselines import BlendTask, as_spline, method
from semispline.papers.lin2014.checks.exact_blends import FIGURES_OWN, blended, task_of
from semispline.papers.lin2014.examples.bases import figure_5_on_common_knots
from semispline.papers.lin2014.examples.exact import EXACT_FIGURES
from semispline.papers.lin2014.examples.section5 import FIGURES, PRINTED, example
from semispline.papers.lin2014.figures.panels import DPI, save, show
from semispline.papers.reproduction import Drawing
from semispline.solver.blending import BlendResult, blend
from semispline.solver.io import check_output
from semispline.solver.judge import Base
from semispline.solver.pictures import BASE_COLOR, BLEND_COLOR, CURVE_COLORS
from semispline.solver.splines import SemiStructuredSurface, Surface, greville

_RENDERED = (1200, 900)
# Near enough for some stripes on a plane.
_EYE = 1.2
# Fig. 7: nearly along the contact, from both ends of it.
_VIEWS_7 = ((-0.1, -1.0, 0.14), (0.25, 1.0, 0.3))
_COLORS = (BASE_COLOR, BASE_COLOR, BLEND_COLOR)


@cache
def figure_blend(figure: int) -> BlendResult:
    """Return the blend that the figure shows: C2 or G2 as there, and with as many middle curves."""
    task = example(figure)
    return blend(task.a, task.b, continuity=task.continuity, middle_curves=task.middle_curves, alpha="energy")


def common_knots_task() -> BlendTask:
    """Return Fig. 5 (d) to (f): the bases of Fig. 5 on the common knot vector that the paper gives them."""
    first, second = figure_5_on_common_knots()
    title = "Fig. 5 (d) to (f): two planar patches on one knot vector"
    return BlendTask("figure-5-common", title, Base(first, "u0"), Base(second, "u0"), "C2", 1)


def drawings() -> list[Drawing]:
    """Return figures 4 to 11, and 10 and 11 with exact surfaces: names, captions, what draws each into a file."""
    made = [Drawing("figure-4", "Fig. 4: a semi-structured blend between two bases, and its knots", draw_figure_4)]
    for figure in FIGURES:
        printed = PRINTED[figure]
        caption = f"Fig. {figure}: {printed.description}, blended with {printed.continuity}; bases of our own"
        draw: Callable[[Path], None] = draw_figure_5 if figure == 5 else partial(draw_example, figure)
        made.append(Drawing(f"figure-{figure}", caption, draw))
        if figure == 6:
            text = "Fig. 7: the pair of Fig. 6 by Hartmann's method with pieces inside the bases: it runs backwards"
            made.append(Drawing("figure-7", text, draw_figure_7))
    for figure in EXACT_FIGURES:
        printed = PRINTED[figure]
        caption = (
            f"Fig. {figure}: {printed.description}, blended with {printed.continuity}; exact surfaces of revolution"
        )
        made.append(Drawing(f"figure-{figure}-exact", caption, partial(draw_exact, figure)))
    return made


def draw_example(figure: int, path: str | Path) -> None:
    """Draw the three panels of Fig. 6, 8, 9, 10 or 11."""
    check_output(path)
    task = example(figure)
    rows = [_scene(task, figure_blend(figure).surface)]
    _draw_rows(path, rows, [""])


def draw_exact(figure: int, path: str | Path) -> None:
    """Draw the three panels of Fig. 10 or 11 with exact surfaces."""
    check_output(path)
    bases = "exact, in arcs"
    _draw_rows(path, [_scene(task_of(figure, bases), blended(figure, FIGURES_OWN, bases).result.surface)], [""])


def draw_figure_5(path: str | Path) -> None:
    """Draw the six panels of Fig. 5: our blend above, the same-knots method with tangent contact below."""
    check_output(path)
    other = common_knots_task()
    rival, _ = as_spline(method("same-knots-g1").run(other).surface)
    rows = [_scene(example(5), figure_blend(5).surface), _scene(other, rival)]
    _draw_rows(path, rows, ["semi-structured, $C^2$: ", "same knots, $G^1$: "])


def draw_figure_7(path: str | Path) -> None:
    """Draw both views of Fig. 7, and one parameter line, which shows the two turns best."""
    check_output(path)
    task = example(6)
    backwards, _ = as_spline(method("hartmann-inside").run(task).surface)
    figure = Figure(figsize=(11, 6.2), dpi=DPI)
    panels = [(0.01, 0.6, 0.48, 0.38), (0.51, 0.6, 0.48, 0.38), (0.06, 0.12, 0.88, 0.37)]
    for panel, view in zip(panels[:2], _VIEWS_7, strict=True):
        show(figure.add_axes(panel), _scene(task, backwards), _RENDERED, towards_eye=view, colors=_COLORS)
    line = figure.add_axes(panels[2])
    t = np.linspace(0, 1, 400)
    for surface, color, width in zip(_scene(task, backwards), _COLORS, (5.0, 5.0, 1.8), strict=True):
        points = surface.evaluate(surface.domain[0][0] + t * np.diff(surface.domain[0]), np.full_like(t, 0.5))
        line.plot(points[:, 0], points[:, 2], color=color, lw=width, solid_capstyle="butt")
    line.set_aspect("equal")
    line.set_xlabel("$x$", labelpad=0)
    line.set_ylabel("$z$", rotation=0)
    line.spines[["top", "right"]].set_visible(False)
    _caption(figure, panels[:2], ["one side", "the other side"], 0.565)
    text = "the lines $v = 1/2$ of all three: the blend leaves both contacts backwards, on the bases"
    _caption(figure, panels[2:], [text], 0.02, first=2)
    save(figure, path)


def draw_figure_4(path: str | Path) -> None:
    """Draw a blend with its control curves, and below it the domains: which knots each row has."""
    check_output(path)
    task, result = example(6), figure_blend(6)
    figure = Figure(figsize=(10, 9), dpi=DPI)
    space = figure.add_axes((0.02, 0.47, 0.96, 0.51))
    show(space, _scene(task, result.surface), _RENDERED, colors=_COLORS, control_points=(False, False, True))
    for x, y, text in ((0.12, 0.66, r"$\mathbf{R}(w, v)$"), (0.83, 0.86, r"$\mathbf{S}(t, v)$")):
        space.text(x, y, text, transform=space.transAxes, fontsize=16, color="white", ha="center")
    _draw_domains(figure.add_axes((0.05, 0.05, 0.9, 0.38)), task, result.surface)
    save(figure, path)


def _scene(task: BlendTask, surface: Surface) -> list[Surface]:
    return [task.a.surface, task.b.surface, surface]


def _draw_rows(path: str | Path, rows: Sequence[list[Surface]], names: Sequence[str]) -> None:
    """Draw rendering, mean curvature and zebra of each scene in a row of its own."""
    height = 1 / len(rows)
    figure = Figure(figsize=(14, 3.7 * len(rows)), dpi=DPI)
    fields: tuple[dict[str, Any], ...] = (
        {"colors": _COLORS},
        {"field": "curvature"},
        {"field": "zebra", "colors": _COLORS, "eye_distance": _EYE},
    )
    for i, (scene, name) in enumerate(zip(rows, names, strict=True)):
        bottom = 1 - (i + 1) * height
        panels = [(0.005 + j / 3, bottom + 0.1 * height, 0.323, 0.88 * height) for j in range(3)]
        for panel, options in zip(panels, fields, strict=True):
            show(figure.add_axes(panel), scene, _RENDERED, **options)
        titles = [name + text for text in ("rendering", "mean curvature", "zebra")]
        _caption(figure, panels, titles, bottom + 0.04 * height, first=3 * i)
    save(figure, path)


def _draw_domains(axes: Any, task: BlendTask, surface: SemiStructuredSurface) -> None:
    """Draw the three domains side by side: knots of the bases as lines, those of each row as dots on it."""
    left, right = (-1.15, -0.15), (1.15, 2.15)
    for (x0, x1), base, text in ((left, task.a, r"$\mathbf{R}(w, v)$"), (right, task.b, r"$\mathbf{S}(t, v)$")):
        axes.add_patch(Rectangle((x0, 0), x1 - x0, 1, facecolor=BASE_COLOR, alpha=0.25))
        for v in base.surface.breakpoints[1]:
            axes.plot((x0, x1), (v, v), color=BASE_COLOR, lw=1.2)
        axes.plot((x0, x0, x1, x1, x0), (0, 1, 1, 0, 0), color="black", lw=1.2)
        axes.text((x0 + x1) / 2, 1.07, text, ha="center", fontsize=14)
    axes.add_patch(Rectangle((0, 0), 1, 1, facecolor=BLEND_COLOR, alpha=0.15))
    axes.plot((0, 0, 1, 1, 0), (0, 1, 1, 0, 0), color="black", lw=1.2)
    axes.text(0.5, 1.17, r"$\mathbf{P}(u, v)$", ha="center", fontsize=14)
    places = np.linspace(0, 1, len(surface.control_curves))
    for i, (x, curve) in enumerate(zip(places, surface.control_curves, strict=True)):
        color = CURVE_COLORS[i % len(CURVE_COLORS)]
        axes.plot((x, x), (0, 1), color=color, lw=1.4)
        knots = np.unique(curve.knots)
        axes.plot(np.full_like(knots, x), knots, "o", color=color, ms=5, clip_on=False, zorder=3)
        axes.text(x, 1.05, f"$\\mathbf{{P}}_{i}$", ha="center", fontsize=11, color=color)
        axes.text(x, -0.07, str(len(greville(curve.knots, curve.degree))), ha="center", va="center", fontsize=11)
    axes.text(-0.03, -0.15, "control points in each row", fontsize=10, va="center")
    for (x0, x1), word in ((left, "$w_s$"), (right, "$t_s$")):
        at_contact = x1 if x0 < 0 else x0
        axes.text(at_contact, -0.07, word, ha="center", va="center", fontsize=12)
        axes.text(x1 if x0 > 0 else x0, -0.07, "$w_e$" if x0 < 0 else "$t_e$", ha="center", va="center", fontsize=12)
    axes.text(left[0] - 0.08, 0.5, "$v$", fontsize=14, va="center")
    axes.set_xlim(-1.3, 2.25)
    axes.set_ylim(-0.2, 1.28)
    axes.axis("off")


def _caption(
    figure: Figure, panels: Sequence[tuple[float, ...]], titles: Sequence[str], height: float, first: int = 0
) -> None:
    for i, (panel, title) in enumerate(zip(panels, titles, strict=True), start=first):
        text = f"({ascii_lowercase[i]}) {title}"
        figure.text(panel[0] + panel[2] / 2, height, text, ha="center", va="center", fontsize=11)
