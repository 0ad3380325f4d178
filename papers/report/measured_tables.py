"""What was measured, as tables for readers: every method on one example, blends of one solver side by side."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from semispline.papers.baselines import Outcome
from semispline.papers.report.table_text import cell
from semispline.papers.reproduction import Comparison, Measures, Table, reached


def _remark(outcome: Outcome, measures: Measures) -> str:
    seam = measures.seam
    if seam is None:
        return outcome.note
    text = f"seam: gap {cell(seam.gap)}, angle {cell(seam.angle_degrees)}°, curvature jump {cell(seam.curvature_jump)}"
    return f"{text}; {outcome.note}" if outcome.note else text


_METHODS_HEAD = (
    "#", "method", "contact", "control points", "energy (11)", "fairness", "∫ κ₁²+κ₂²", "gap", "angle [°]",
    "curvature jump", "C2 residual", "folds", "turn inside [°]", "least area / mean", "|H|", "α²", "β²", "iterations",
    "seconds", "note",
)  # fmt: skip


def methods_table(comparisons: Sequence[Comparison]) -> Table:
    """Return one line a method for one example; methods that cannot be used stand below with their reason."""
    rows, reasons = [], []
    for number, comparison in enumerate(comparisons, start=1):
        outcome, m = comparison.outcome, comparison.measures
        if outcome is None or m is None:
            reasons.append(f"{comparison.method.title}: {comparison.reason}.")
            continue
        values = (
            number, comparison.method.title, reached(comparison.task, m), outcome.control_points, m.energy, m.fairness,
            m.bending, m.gap, m.angle_degrees, m.curvature_jump_relative, m.c2_residual, m.folds, m.turn_degrees,
            m.least_area_ratio, m.mean_curvature, outcome.alpha2, outcome.beta2, outcome.iterations, m.seconds,
            _remark(outcome, m),
        )  # fmt: skip
        rows.append(tuple(map(cell, values)))
    task = comparisons[0].task
    note = f"Not used here: {' '.join(reasons)}" if reasons else ""
    return Table(f"{task.name}-methods", f"{task.title}: every method", _METHODS_HEAD, tuple(rows), note)


METHODS_NOTE = (
    "Contact: what both edges meet up to rounding (angle below 1e-9 degrees, relative curvature jump below 1e-9). Gap "
    "in model units; the jump is that of the normal curvature across the contact, relative to the largest one there; "
    "the C2 residual that of second derivatives, each in its own parameter. Energy is (11) in the blend's parameters. "
    "Fairness is area times ∫ |grad H|², jumps of the mean curvature H included; it and ∫ κ₁²+κ₂² are over the "
    "surface, so they do not depend on parameters (– where they do not settle, and for fairness where the blend "
    "folds inside). |H|: least and largest mean curvature of the blend, 1/length. Folds: the normal turns by more than "
    "90 degrees at a contact, or inside within 1/50 of the blend's length: that is the turn inside. Seconds: the "
    "method alone, one run on this machine."
)

_SIDE_HEAD = (
    "pair", "blend", "largest turn inside [°]", "fairness", "energy (11)", "α²", "β²", "gap a", "angle a [°]",
    "curvature jump a", "gap b", "angle b [°]", "curvature jump b", "least area / mean", "control points", "seconds",
    "bounds hit",
)  # fmt: skip


def blends_table(chosen: Iterable[tuple[str, Comparison]]) -> Table:
    """Return one column a blend, given as (what it is, comparison): its shape, and each edge as the referee sees it."""
    rows = []
    for title, comparison in chosen:
        outcome, m = comparison.outcome, comparison.measures
        if outcome is None or m is None:
            continue
        a, b = m.contact_a, m.contact_b
        values = (
            comparison.task.name, title, m.turn_degrees, m.fairness, m.energy, outcome.alpha2, outcome.beta2, a.gap,
            a.angle_degrees, a.curvature_jump_relative, b.gap, b.angle_degrees, b.curvature_jump_relative,
            m.least_area_ratio, outcome.control_points, m.seconds, outcome.note or "none",
        )  # fmt: skip
        rows.append(tuple(map(cell, values)))
    columns = tuple(zip(_SIDE_HEAD, *rows, strict=True))
    note = (
        "Contact is judged by the de Boor referee; gap in model units, the curvature jump relative. The largest turn "
        "is that of the normal within 1/50 of the blend's length, a fold above 90 degrees; fairness is area times "
        "∫ |grad H|² (– where the blend folds)."
    )
    return Table("edges", "Blends, measured", columns[0], columns[1:], note)
