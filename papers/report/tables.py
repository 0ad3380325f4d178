"""What was measured, as tables for readers: every method on one example, blends of one solver side by side."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from semispline.papers.baselines import BlendTask, Outcome
from semispline.papers.reproduction import Comparison, Measures, Table
from semispline.solver.judge import model_size

# What counts as met: degrees, fraction of the curvature, fraction of the size of the model.
LIMIT = 1e-9


def cell(value: Any) -> str:
    """Return the text of a value: four significant digits, or all digits in front of the point.

    Examples
    --------
    >>> [cell(value) for value in (None, True, 123456.78, 2.5e-13, 0.0817, (1e-18, 0.25), 7)]
    ['–', 'yes', '123457', '2.5e-13', '0.0817', '0 to 0.25', '7']
    """
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        largest = max(map(abs, value))
        # Far below the other end of a range is rounding.
        return " to ".join(cell(x if abs(x) > 1e-9 * largest else 0.0) for x in value)
    if not isinstance(value, float):
        return str(value)
    if 1e4 <= abs(value) < 1e9:
        return f"{value:.0f}"
    return f"{value:.4g}" if value == 0 or abs(value) >= 1e-3 else f"{value:.1e}"


def reached(task: BlendTask, measures: Measures) -> str:
    """Return the continuity that both contacts meet up to rounding: G2, G1, G0, or "none"."""
    if measures.gap > LIMIT * max(model_size(base.surface) for base in (task.a, task.b)):
        return "none"
    if measures.angle_degrees > LIMIT:
        return "G0"
    return "G1" if measures.curvature_jump_relative > LIMIT else "G2"


def c2_residual(measures: Measures) -> float | None:
    """Return the larger difference of second derivatives across the contacts, relative; None where there is none."""
    found = (measures.contact_a.c2_residual, measures.contact_b.c2_residual)
    return None if found[0] is None or found[1] is None else max(found[0], found[1])


def _remark(outcome: Outcome, measures: Measures) -> str:
    seam = measures.seam
    if seam is None:
        return outcome.note
    text = f"seam: gap {cell(seam.gap)}, angle {cell(seam.angle_degrees)}°, curvature jump {cell(seam.curvature_jump)}"
    return f"{text}; {outcome.note}" if outcome.note else text


_METHODS_HEAD = (
    "#", "method", "contact", "control points", "energy (11)", "∫ κ₁²+κ₂²", "gap", "angle [°]", "curvature jump",
    "C2 residual", "folds", "turn inside [°]", "least area / mean", "|H|", "α²", "β²", "iterations", "seconds", "note",
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
            number, comparison.method.title, reached(comparison.task, m), outcome.control_points, m.energy, m.bending,
            m.gap, m.angle_degrees, m.curvature_jump_relative, c2_residual(m), m.folds, m.largest_turn_degrees,
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
    "the C2 residual that of second derivatives, each in its own parameter. Energy is (11) in the blend's parameters; "
    "∫ κ₁²+κ₂² is over the surface, so it does not depend on them (– where it does not settle). |H|: least and largest "
    "mean curvature of the blend, 1/length. Folds: the normal turns by more than 90 degrees at a contact or between "
    "neighbouring samples inside. Seconds: the method alone, one run on this machine."
)

_SIDE_HEAD = (
    "pair", "contact", "energy", "α²", "β²", "gap a", "angle a [°]", "curvature jump a", "gap b", "angle b [°]",
    "curvature jump b", "largest turn inside [°]", "least area / mean", "control points", "seconds", "bounds hit",
)  # fmt: skip


def blends_table(chosen: Iterable[tuple[str, Comparison]]) -> Table:
    """Return one column a blend, given as (contact, comparison): what the referee says of each edge."""
    rows = []
    for contact, comparison in chosen:
        outcome, m = comparison.outcome, comparison.measures
        if outcome is None or m is None:
            continue
        a, b = m.contact_a, m.contact_b
        values = (
            comparison.task.name, contact, m.energy, outcome.alpha2, outcome.beta2, a.gap, a.angle_degrees,
            a.curvature_jump_relative, b.gap, b.angle_degrees, b.curvature_jump_relative, m.largest_turn_degrees,
            m.least_area_ratio, outcome.control_points, m.seconds, outcome.note or "none",
        )  # fmt: skip
        rows.append(tuple(map(cell, values)))
    columns = tuple(zip(_SIDE_HEAD, *rows, strict=True))
    note = "Contact is judged by the de Boor referee; gap in model units, the curvature jump relative."
    return Table("edges", "Blends, measured", columns[0], columns[1:], note)


def text_lines(table: Table) -> list[str]:
    """Return the table for a terminal."""
    columns = list(zip(table.head, *table.rows, strict=True))
    widths = [max(map(len, column)) for column in columns]
    lines = (table.head, *table.rows)
    return ["  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)).rstrip() for line in lines]


def markdown_lines(table: Table) -> list[str]:
    """Return the table in Markdown, with its title and its note."""
    lines = (table.head, ("---",) * len(table.head), *table.rows)
    body = ["| " + " | ".join(c.replace("|", "\\|").replace("\n", " ") for c in line) + " |" for line in lines]
    return [f"### {table.title}", "", *body, "", *([table.note, ""] if table.note else [])]
