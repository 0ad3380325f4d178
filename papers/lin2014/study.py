"""The paper's examples, and two pairs of our own: what `semispline reproduce lin2014` runs, draws and compares."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path

from semispline.papers.baselines import BlendTask
from semispline.papers.lin2014.exact_surfaces import exact_tables
from semispline.papers.lin2014.examples.exact import EXACT_FIGURES, exact_example
from semispline.papers.lin2014.examples.made_pair import made_pair
from semispline.papers.lin2014.examples.section5 import DEPARTURES, FIGURES, PRINTED, example
from semispline.papers.lin2014.figures import blends as figures_blends
from semispline.papers.lin2014.figures.bezier import draw_figure_1, draw_figure_2, draw_trimmed_patch
from semispline.papers.lin2014.findings import AS_PRINTED, CORRECTED, findings, meets_demand
from semispline.papers.lin2014.paper_as_printed import METHODS as PRINTED_METHODS
from semispline.papers.report import cell
from semispline.papers.reproduction import Comparison, Comparisons, Drawing, Example, Study, Table, impeller_path
from semispline.solver.blending import blend
from semispline.solver.io import read_surfaces
from semispline.solver.judge import Base
from semispline.solver.pictures import BASE_COLOR, BLEND_COLOR, Drawn, render

IMPELLER_FACES = (102, 131)
# From where both blades and the whole blend are seen.
_TOWARDS_EYE = {"impeller": (-1.0, -1.0, 0.4)}
PREFACE = (
    "The paper prints no control points. The bases below are our own stand-ins: they match its descriptions, its knot "
    "vectors and its model sizes. Energies, times and curvatures can therefore not be compared digit by digit with "
    "Table 1; sizes, knots, the contact that is reached, and the order in which methods stand can. The complete "
    "cylinders of Fig. 10 and the cone of Fig. 11 run as exact rational surfaces too."
)
PRIOR_ART = (
    "J. Gravesen, semi-regular B-spline surfaces (generalised lofting): rows over knot vectors of their own.",
    "X. Yang and J. Zheng, approximate T-spline surface skinning, CAD 44 (2012): one global knot vector and an "
    "individual one for each row.",
    "E. Hartmann, parametric G^n blending of curves and surfaces (the paper's [17]); M. Bloor and M. Wilson, blends by "
    "partial differential equations ([14, 15]); P. Kiciak, bicubic B-spline blending patches with optimized shape, CAD "
    "43 (2011).",
)


def study() -> Study:
    """Return everything; the real pair only where the package `pyiges`, which brings the model, is installed."""
    pairs = [pair(name) for name in pair_names()]
    return Study(
        (*(_example(figure) for figure in FIGURES), *map(_exact_example, EXACT_FIGURES), *pairs),
        (*_section_2(), *figures_blends.drawings(), *(d for name in pair_names() for d in _pair_drawings(name))),
        tables,
        findings,
        methods=PRINTED_METHODS,
        preface=PREFACE,
        prior_art=PRIOR_ART,
    )


def _example(figure: int) -> Example:
    departures = (d for d in DEPARTURES if d.figure == figure)
    notes = tuple(f"Printed: {d.printed}. Used: {d.used}. Why: {d.why}." for d in departures)
    pictures = (f"figure-{figure}", *(("figure-4", "figure-7") if figure == 6 else ()))
    return Example(example(figure), notes, pictures)


def _exact_example(figure: int) -> Example:
    note = (
        "Exact, rational: circles by `revolve`, in arcs of degree 2. Axes, radii, lengths and speeds across the "
        f"contact are those of the stand-in for Fig. {figure}; knots and sizes are not those of Table 1."
    )
    return Example(exact_example(figure), (note,), (f"figure-{figure}-exact",))


def pair_names() -> tuple[str, ...]:
    """Return the names of the pairs that can be had here."""
    return ("made", "impeller") if impeller_path() else ("made",)


@cache
def pair(name: str) -> Example:
    """Return the made pair or the real one."""
    pictures = tuple(drawing.name for drawing in _pair_drawings(name))
    if name == "made":
        title = "Made pair: two bicubic patches with mismatched, non-uniform knots"
        note = "Ours (examples/made-pair.json): 3 inner knots on one contact curve, 4 others on the other one."
        return Example(BlendTask(name, title, *made_pair()), (note,), pictures)
    title = f"Real pair: impeller.igs, faces {IMPELLER_FACES[0]} and {IMPELLER_FACES[1]}, edges u0 and u0"
    note = (
        "Two neighbouring blades of an impeller, from the model that the package pyiges ships, joined along edges of "
        "their untrimmed surfaces: real data, whose parameter speeds and knots nobody chose for us."
    )
    return Example(BlendTask(name, title, *_impeller()), (note,), pictures)


def _impeller() -> tuple[Base, Base]:
    loaded = read_surfaces([f"{impeller_path()}#{face}" for face in IMPELLER_FACES])
    first, second = (Base(surface.surface, "u0") for surface in loaded)
    return first, second


def _section_2() -> tuple[Drawing, ...]:
    return (
        Drawing("figure-1", "Fig. 1: control points of each v-control curve", draw_figure_1),
        Drawing("figure-2", "Fig. 2: a Bézier patch divided by a Bézier function", draw_figure_2),
        Drawing(
            "figure-3", "Fig. 3: the trimmed patch as four semi-structured and four Bézier patches", draw_trimmed_patch
        ),
    )


def _pair_drawings(name: str) -> tuple[Drawing, ...]:
    return (
        Drawing(
            f"{name}-shaded",
            "The fairest G2 blend: bases green, blend red, control points of each v-control curve joined",
            partial(draw_pair, name, False),
        ),
        Drawing(f"{name}-zebra", "The fairest G2 blend: zebra", partial(draw_pair, name, True)),
    )


def draw_pair(name: str, zebra: bool, path: Path) -> None:
    """Draw the blend of a pair between its bases: shaded with its control points, or with zebra stripes."""
    task = pair(name).task
    result = blend(task.a, task.b)
    surfaces = [task.a.surface, task.b.surface, result.surface]
    view = _TOWARDS_EYE.get(name)
    if zebra:
        render(surfaces, path, field="zebra", towards_eye=view)
    else:
        bases = [Drawn(surface, BASE_COLOR) for surface in surfaces[:2]]
        render([*bases, Drawn(result.surface, BLEND_COLOR, control_points=True)], path, towards_eye=view)


_TABLE_1_HEAD = (
    "example", "what", "model 1", "model 2", "contact met", "curvature jump", "C2 residual", "iterations", "seconds",
    "energy (11)", "mean curvature",
)  # fmt: skip


def tables(comparisons: Comparisons) -> tuple[Table, ...]:
    """Return Table 1: printed, and measured here with formulas as printed and as corrected; then exact surfaces."""
    rows = []
    for figure in FIGURES:
        printed = PRINTED[figure]
        sizes = [f"{rows_} × {columns}" for rows_, columns in printed.sizes]
        asked = f"{printed.continuity} (claimed)"
        # Digits as they are printed.
        bends = " to ".join(f"{bend:.4f}" for bend in printed.mean_curvature)
        numbers = (cell(printed.iterations), f"{printed.seconds:.4f}", f"{printed.energy / 1e6:.2f}e6", bends)
        rows.append((f"Fig. {figure}", "printed", *sizes, asked, "–", "–", *numbers))
        found = {c.method.name: c for c in comparisons.get(f"figure-{figure}", ())}
        for name, what in ((AS_PRINTED, "ours, formulas as printed"), (CORRECTED, "ours, formulas corrected")):
            if name in found:
                rows.append((f"Fig. {figure}", what, *_table_1_row(found[name])))
    note = (
        "Sizes of control nets across × along the contact. Ours are stand-ins, so energies and curvatures are not the "
        "paper's; the least |H| over bases and blend is near 0 wherever a base is flat or H changes its sign. Times: "
        "the paper on a Core2 Quad of 2.66 GHz with Matlab and C++, ours on the machine below."
    )
    first = Table("table-1", "Table 1, printed and measured", _TABLE_1_HEAD, tuple(rows), note)
    return (first, *exact_tables(comparisons))


def _table_1_row(comparison: Comparison) -> tuple[str, ...]:
    task, outcome, m = comparison.task, comparison.outcome, comparison.measures
    sizes = [" × ".join(map(str, base.surface.control_points.shape[:2])) for base in (task.a, task.b)]  # type: ignore[union-attr]
    if outcome is None or m is None:
        return (*sizes, *("–",) * 7)
    met = f"{task.continuity}: {'yes' if meets_demand(comparison) else 'no'}"
    values = (
        m.curvature_jump_relative, m.c2_residual, outcome.iterations, m.seconds, m.energy,
        m.mean_curvature_with_bases,
    )  # fmt: skip
    return (*sizes, met, *map(cell, values))
