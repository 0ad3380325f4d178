"""What `check` prints and stores of a contact along a free edge of a face: the table of `contact_table`.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from math import isnan
from typing import TYPE_CHECKING, Any

import typer

from semispline.solver.cli.contact_table import profile_record
from semispline.solver.options import Continuity
from semispline.solver.reports import finite, print_table

if TYPE_CHECKING:
    from semispline.solver.topology import FreeContact

# Words and unit of each measure; None is that of a length.
_ROWS = (
    ("gap to the face", "gap", None),
    ("off the trim curve", "off", None),
    ("angle", "angle_degrees", "degrees"),
    ("curvature jump, relative", "curvature_jump_relative", "1"),
    ("rate jump, relative", "rate_jump_relative", "1"),
    ("second rate jump, relative", "second_rate_jump_relative", "1"),
)


def face_contact_record(found: FreeContact) -> dict[str, Any]:
    """Return what a JSON file holds of it."""
    record = {name: value for name, value in asdict(found.contact).items() if value is not None}
    record |= {"allowed": found.allowed, "limits": found.limits}
    record |= {"measured_along": found.along, "face": found.face, "face_edge_length": found.length}
    return {name: finite(value) for name, value in record.items()} | profile_record(found.profile)


def print_face_contact(found: FreeContact, unit: str | None, required: Continuity | None = None) -> None:
    """Print what was measured on the face itself, where, and whether that is allowed."""
    from semispline.solver.judge import required_face_measures

    counted = () if required is None else required_face_measures(required)
    means = found.profile.means
    rows = [("measure", "maximum", "mean", "limit", *(["met"] if counted else []), "unit", "at parameter", "at point")]
    for words, measure, of in _ROWS:
        value = getattr(found.contact, measure)
        if value is None:
            continue
        place, limit = found.contact.at[measure], found.allowed[measure]
        met = [] if not counted else ["-" if measure not in counted else "yes" if value <= limit else "no"]
        point = ", ".join(f"{x:.5g}" for x in place.point)
        figures = (f"{value:.3g}", f"{means[measure]:.3g}", f"{limit:.3g}")
        rows.append((words, *figures, *met, of or unit or "model units", f"{place.parameter:.5g}", f"({point})"))
    print_table(rows)
    typer.echo(
        f"measured on the face itself, at {found.face}, along {found.contact.length:.4g} of its {found.length:.4g} "
        f"{unit or 'model units'}, by parameters of edge {found.along.upper()}; {found.limits} limits"
    )
    if required in ("C1", "C2"):
        typer.echo(f"{required}, which is of parameters, counts as G{required[1]}: a free curve has none across it")


def face_misses(found: FreeContact, required: Continuity | None) -> Sequence[str]:
    """Return, of each measure that falls short, its name, value and limit."""
    from semispline.solver.judge import face_shortfalls

    if required is None:
        return []
    return [
        f"{name.replace('_', ' ')} is {value:.3g}, at most {limit:.3g} allowed"
        if not isnan(value)
        else f"{name.replace('_', ' ')} does not exist where there is no normal"
        for name, value, limit in face_shortfalls(found.contact, found.allowed, required)
    ]
