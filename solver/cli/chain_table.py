"""What `check` prints and stores of contacts with edges that run end to end.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import typer

from semispline.solver.options import Continuity
from semispline.solver.reports import contact_record, finite, print_table

if TYPE_CHECKING:
    from semispline.solver.topology import StretchContact

_MEASURES = (
    ("gap", "gap"),
    ("angle, degrees", "angle_degrees"),
    ("curvature jump, relative", "curvature_jump_relative"),
    ("rate", "rate_jump_relative"),
    ("second rate", "second_rate_jump_relative"),
)


def chain_contact_record(found: Sequence[StretchContact]) -> dict[str, Any]:
    """Return what a JSON file holds: the worst of each measure, and each face by itself."""
    from semispline.solver.topology import worst_of

    faces = [
        {"edge": one.edge, "other": one.other, "range": list(one.range), "limits": one.limits}
        | {"contact": contact_record(one.contact), "allowed": finite(one.allowed)}
        for one in found
    ]
    return {**{name: finite(worst_of(found, name)) for _, name in _MEASURES}, "faces": faces}


def print_chain_contact(found: Sequence[StretchContact], unit: str | None, required: Continuity | None = None) -> None:
    """Print a row for each face, with the limits that were asked for, and where it lies."""
    rows = [("edge", "along", *(words for words, _ in _MEASURES), *(["met"] if required else []))]
    for one in found:
        figures = [
            "-" if (value := getattr(one.contact, name)) is None else f"{value:.3g} ({one.allowed[name]:.2g})"
            for _, name in _MEASURES
        ]
        met = [] if required is None else ["no" if one.misses(required) else "yes"]
        low, high = one.range
        rows.append((one.edge, f"{one.other} [{low:.5g}, {high:.5g}]", *figures, *met))
    print_table(rows)
    typer.echo(f"lengths in {unit or 'model units'}; limits in brackets")


def chain_misses(found: Sequence[StretchContact], required: Continuity | None) -> list[str]:
    """Return, of each measure of a face that falls short, its name, value and limit."""
    if required is None:
        return []
    return [
        f"{one.edge}: {name.replace('_', ' ')} is {value:.3g}, at most {limit:.3g} allowed"
        for one in found
        for name, value, limit in one.misses(required)
    ]
