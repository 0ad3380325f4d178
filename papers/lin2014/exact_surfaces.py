"""What changes where the cylinders of Fig. 10 and the cone of Fig. 11 are exact surfaces instead of stand-ins."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from semispline.papers.lin2014.checks.exact_blends import (
    BASES,
    CHOICES,
    CIRCLES,
    FIGURES_OWN,
    STAND_INS,
    Blended,
    all_blended,
    blended,
)
from semispline.papers.lin2014.examples.exact import EXACT_FIGURES
from semispline.papers.report import cell
from semispline.papers.reproduction import Comparisons, Finding, Table
from semispline.solver.blending import BlendResult
from semispline.solver.judge import worst_inside

_WHAT = "What changes from stand-ins to exact surfaces, whose circles run in arcs as CAD programs write them."
# Relative differences of energies below this are rounding.
_ROUNDED = 1e-11

_HEAD = (
    "example", "asked for", "bases", "α²", "β²", "energy (11)", "quadrature error / energy", "fairness",
    "gap", "angle [°]", "curvature jump", "inside", "control points", "converted", "weights", "cure",
)  # fmt: skip


def exact_tables(comparisons: Comparisons) -> tuple[Table, ...]:
    """Return the table of stand-ins and exact surfaces side by side, for the examples that were run."""
    rows = [_row(one) for figure in _figures_of(comparisons) for one in all_blended(figure)]
    note = (
        "The same axes, radii, lengths and speeds across the contact; exact circles by `revolve`, in arcs of degree 2 "
        "as CAD programs write them, or by `revolve_smooth`, one curve of degree 6. Energy is (11), of rational "
        "blends by quadrature; it measures parameters too, so it differs between two ways to run through one circle. "
        "Fairness does not, and is measured to 1 %. Gap, angle and curvature jump: the larger of both contacts, by "
        "the referee. Inside: where arcs meet. Weights and cure: of the first base / of the second one."
    )
    return (Table("exact", "Figs. 10 and 11 with exact surfaces", _HEAD, tuple(rows), note),) if rows else ()


def _row(one: Blended) -> tuple[str, ...]:
    r = one.result
    a, b = r.contact_a, r.contact_b
    error = None if r.quadrature_error is None else r.quadrature_error / r.energy
    values = (
        f"Fig. {one.figure}", one.choice, one.bases, r.alpha2, r.beta2, r.energy, error, r.shape.fairness.value,
        max(a.gap, b.gap), max(a.angle_degrees, b.angle_degrees),
        max(a.curvature_jump_relative, b.curvature_jump_relative), _inside(r), r.rows_stored, r.rows_converted,
        _of_both(r.weights), _of_both(None if cure is None else cure.words for cure in r.cures),
    )  # fmt: skip
    return tuple(map(cell, values))


def _inside(result: BlendResult) -> str:
    worst = worst_inside(result.creases)
    if worst is not None:
        return str(worst)
    lines = len(result.creases)
    return f"no crease, no jump ({lines} lines)" if lines else "no such line"


def _of_both(values: Any) -> str:
    words = [str(value) if value else "–" for value in values]
    return words[0] if words[0] == words[1] else " / ".join(words)


def exact_findings(comparisons: Comparisons) -> Iterator[Finding]:
    """Say what changes with exact surfaces, figure by figure; nothing where those were not run."""
    figures = _figures_of(comparisons)
    if not figures:
        return
    exact = [one for figure in figures for one in all_blended(figure) if one.bases != STAND_INS]
    kept = [one for one in exact if one.is_kept]
    where = " and ".join(f"Fig. {figure}" for figure in figures)
    yield Finding(
        f"With exact circular cylinders and an exact cone {where} are G2 as well, in {len(kept)} of {len(exact)} "
        "blends, smooth inside",
        " ".join([_WHAT, *map(_figure_words, figures), _circle_words(figures), *_rivals(comparisons, figures)]),
    )


def _figure_words(figure: int) -> str:
    """Say what exact surfaces change against the stand-ins in one figure."""
    return " ".join(f"Fig. {figure}, {choice}: {_change(figure, choice)}." for choice in CHOICES)


def _change(figure: int, choice: str) -> str:
    before, after = (blended(figure, choice, bases).result for bases in BASES[:2])
    energy = 100 * (after.energy / before.energy - 1)
    return (
        f"(11) from {before.energy:.4g} to {after.energy:.4g}, {energy:+.2g} % ({_quadrature(after)}), alpha^2 and "
        f"beta^2 from {_pair(before)} to {_pair(after)}, fairness from {before.shape.fairness.value:.3g} to "
        f"{after.shape.fairness.value:.3g}, control points from {before.rows_stored} to {after.rows_stored} (converted "
        f"from {before.rows_converted} to {after.rows_converted}); {_treatment(after)}"
    )


def _quadrature(result: BlendResult) -> str:
    """Say how well (11) of a rational blend is known."""
    error = (result.quadrature_error or 0.0) / result.energy
    return f"by quadrature, error {error:.0e} of it" if error > _ROUNDED else "by quadrature, error rounding"


def _pair(result: BlendResult) -> str:
    return f"{result.alpha2:.3f} and {result.beta2:.3f}"


def _treatment(result: BlendResult) -> str:
    """Say what was done to arcs and weights."""
    cures = {cure.words for cure in result.cures if cure is not None}
    weights = [side for side in result.weights if side is not None]
    cured = ", ".join(sorted(cures)) if cures else "both bases have the same arcs, which stay"
    ratio = max(side.ratio for side in weights)
    return f"{cured}; weights by the rung {' and '.join(sorted({side.rung for side in weights}))}, ratio {ratio:.3g}"


def _circle_words(figures: list[int]) -> str:
    """Compare both ways to run through the circles: one shape, two energies."""
    parts = []
    for figure in figures:
        arcs, smooth = (blended(figure, FIGURES_OWN, bases).result for bases in CIRCLES)
        more = arcs.energy / smooth.energy - 1
        parts.append(f"{100 * more:.2g} % in Fig. {figure}" if abs(more) > _ROUNDED else f"nothing in Fig. {figure}")
    return (
        f"One smooth circle of degree 6 instead of arcs changes no surface, but (11) without a middle curve: arcs have "
        f"more by {' and '.join(parts)}; cured arcs are that circle. So (11) compares blends over one parametrisation "
        "alone; fairness, measured to 1 %, does not know it."
    )


def _rivals(comparisons: Comparisons, figures: list[int]) -> Iterator[str]:
    """Say how many methods can take rational bases at all."""
    for figure in figures:
        found = comparisons[f"figure-{figure}-exact"]
        able = [c for c in found if c.outcome is not None]
        polynomial = [c for c in found if "polynomial" in c.reason]
        yield (
            f"Of {len(found)} methods {len(able)} can be used on exact surfaces in Fig. {figure}; {len(polynomial)} "
            "take polynomial bases only."
        )


def _figures_of(comparisons: Comparisons) -> list[int]:
    return [figure for figure in EXACT_FIGURES if f"figure-{figure}-exact" in comparisons]
