"""What `check` prints and stores of a contact: the table that checkers of CAD systems print, and the run of measures.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from semispline.solver.options import Continuity
from semispline.solver.reports import finite, print_table

if TYPE_CHECKING:
    from semispline.solver.judge import Contact, Profile

# Words, measure, its unit (or as which power of 1/length), and what its worst place is called.
_ROWS = (
    ("gap", "gap", -1, "gap_at"),
    ("angle", "angle_degrees", "degrees", "angle_at"),
    ("curvature jump", "curvature_jump", 1, "curvature_at"),
    ("curvature jump, relative", "curvature_jump_relative", "1", "curvature_at"),
    ("rate jump", "rate_jump", 2, "rate_at"),
    ("rate jump, relative", "rate_jump_relative", "1", "rate_at"),
    ("second rate jump", "second_rate_jump", 3, "second_rate_at"),
    ("second rate jump, relative", "second_rate_jump_relative", "1", "second_rate_at"),
)
# Surfaces that differ in lower order do so in these.
_COUNTS_ONLY_WITH: dict[str, Continuity] = {"rate_jump_relative": "G2", "second_rate_jump_relative": "G3"}


def profile_record(profile: Profile) -> dict[str, Any]:
    """Return what a JSON file holds of how measures run along the edge: their means, and values over the length."""
    values = {name: value.tolist() for name, value in profile.values.items()}
    record = {"parameter": profile.parameter.tolist(), "length": profile.length.tolist(), **values}
    return {"mean": finite(profile.means), "left_out": profile.left_out, "profile": finite(record)}


def plot_limits(contact: Contact) -> dict[str, float]:
    """Return the limits that count: none of an order of which a lower one does not hold."""
    return {name: limit for name, limit in contact.allowed.items() if _counts(contact, name)}


def print_contact(contact: Contact, profile: Profile, unit: str | None, required: Continuity | None = None) -> None:
    """Print what was measured of a contact: the largest value and the mean, where, and whether that is allowed."""
    from semispline.solver.judge import required_limits

    asked = {} if required is None else {name: (x, most) for name, x, most in required_limits(contact, required)}
    means = profile.means
    rows = [("measure", "maximum", "mean", "limit", *(["met"] if asked else []), "unit", "at parameter", "at point")]
    for words, measure, unit_of, at in _ROWS:
        place = getattr(contact, at)
        if place is None:
            continue
        limit = contact.allowed.get(measure)
        if not _counts(contact, measure):
            allowed = f"counts only with {_COUNTS_ONLY_WITH[measure]}"
        else:
            allowed = "see below" if limit is None else f"{limit:.3g}"
        met = []
        if asked:
            value, most = asked.get(measure, (0.0, None))
            met = ["-" if most is None else "yes" if value <= most else "no"]
        point = ", ".join(f"{x:.5g}" for x in place.point)
        figures = (f"{getattr(contact, measure):.3g}", f"{means[measure]:.3g}", allowed)
        rows.append((words, *figures, *met, _unit(unit_of, unit), f"{place.parameter:.5g}", f"({point})"))
    print_table(rows)
    if contact.corresponds == "foot points":
        typer.echo(
            "the edges are one curve with two parametrisations: each point is compared with its foot on the other"
        )
    if profile.left_out:
        typer.echo(f"left out: {profile.left_out} of {len(profile.length)} places, where a side has no proper normal")
    for bare in contact.no_normal:
        typer.echo(f"{bare.surface.upper()}: {bare}")


def _counts(contact: Contact, measure: str) -> bool:
    from semispline.solver.judge import shortfalls

    below = _COUNTS_ONLY_WITH.get(measure)
    return below is None or not shortfalls(contact, below)


def _unit(of: int | str, unit: str | None) -> str:
    if isinstance(of, str):
        return of
    if of < 0:
        return unit or "model units"
    return f"1/{unit or '(model units)'}" + ("", "\u00b2", "\u00b3")[of - 1]
