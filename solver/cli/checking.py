"""The command check.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isnan
from typing import TYPE_CHECKING, Annotated, Any

import typer

from semispline.solver.cli.chain_table import chain_contact_record, chain_misses, print_chain_contact
from semispline.solver.cli.contact_table import plot_limits, print_contact, profile_record
from semispline.solver.cli.face_table import face_contact_record, face_misses, print_face_contact
from semispline.solver.cli.words import (
    CONTINUITY_HELP,
    EdgeA,
    EdgeB,
    SurfaceA,
    SurfaceB,
    asked,
    check_outputs,
    check_words,
    edges_of,
    file_name,
    print_resolved,
    progress,
    resolved,
    write_json,
)
from semispline.solver.errors import ContactError, OptionError
from semispline.solver.exit_status import ANSWER_IS_NO, reports_errors
from semispline.solver.options import Auto, Continuity, Limits, continuity_name, limits_name
from semispline.solver.reports import contact_record, print_warnings

if TYPE_CHECKING:
    from semispline.solver.judge import Base, Contact, Profile
    from semispline.solver.topology import Resolved, ResolvedEdge

_LIMITS_HELP = (
    "exact, cad (as checkers of CAD systems have them), or auto: cad along a free curve of a face that is no plane."
)


@dataclass(frozen=True)
class _Measured:
    """What was measured of two edges: for JSON, for plots and for the terminal, and what a continuity misses."""

    record: dict[str, Any]
    profile: Profile | None
    limits: Mapping[str, float]
    misses: Sequence[str]
    doubts: Sequence[str]
    show: Callable[[], None]


@reports_errors
def check_command(
    a: SurfaceA,
    b: SurfaceB,
    edge_a: EdgeA,
    edge_b: EdgeB,
    require: Annotated[
        str | None, typer.Option(metavar="C", help=f"Exit status 1 if they do not meet with {CONTINUITY_HELP}")
    ] = None,
    limits: Annotated[str, typer.Option(metavar="LIMITS", help=_LIMITS_HELP)] = "auto",
    json_file: Annotated[
        str | None, typer.Option("--json", metavar="FILE", help="Write the figures; - is standard output.")
    ] = None,
    plots: Annotated[
        str | None,
        typer.Option(metavar="DIR", help="Draw each measure along the edge, with its limit, into PNG files there."),
    ] = None,
) -> None:
    """Measure how an edge of A and an edge of B meet: gap, angle, jumps of curvature and its rates, and where."""
    from semispline.solver.io import check_folder, face_warnings, write_files

    check_words(edge_a, edge_b)
    required = None if require is None else continuity_name(require, "--require")
    kind = limits_name(limits, "--limits")
    check_outputs({"--json": file_name(json_file)}, [a, b])
    if plots is not None:
        check_folder(plots)
    ends = resolved(a, edge_a, b, edge_b)
    with progress("measuring"):
        found = _measured(ends, required, kind)
    warnings = face_warnings(*edges_of(ends))
    unit = ends[0].loaded.unit
    if plots is not None and found.profile is None:
        raise OptionError("--plots: found it with several edges at once, expected one at A and one at B")
    if plots is not None and found.profile is not None:
        from semispline.solver.pictures import profile_plots

        write_files(plots, profile_plots(found.profile, found.limits, unit))
    if json_file is not None:
        record: dict[str, Any] = {"a": ends[0].spec, "edge_a": ends[0].edge, "b": ends[1].spec, "edge_b": ends[1].edge}
        record |= {"unit": unit} | asked(ends) | found.record
        record["warnings"] = list(warnings)
        if require is not None:
            answer = {"meets": not found.misses, "misses": list(found.misses), "doubts": list(found.doubts)}
            record |= {"require": required} | answer
        write_json(json_file, {"format": "semispline/1", "kind": "contact", **record})
    if json_file != "-":
        print_resolved(ends)
        found.show()
        if require is not None:
            reasons = "; ".join([*found.misses, *found.doubts])
            answer_is = "no: " if found.misses else "yes, but " if found.doubts else "yes"
            typer.echo(f"{required}: {answer_is}{reasons}")
    print_warnings(warnings)
    if found.misses:
        raise typer.Exit(ANSWER_IS_NO)


def _measured(ends: Sequence[Resolved], required: Continuity | None, kind: Limits | Auto) -> _Measured:
    from semispline.solver.topology import ResolvedEdge

    single = [end for end in ends if isinstance(end, ResolvedEdge)]
    if len(single) < len(ends):
        return _on_chain(ends, required, kind)
    return _on_face(single, required, kind) if any(end.is_free for end in single) else _of_edges(single, required, kind)


def _on_chain(ends: Sequence[Resolved], required: Continuity | None, kind: Limits | Auto) -> _Measured:
    """Measure edges of which one or both are several that run end to end."""
    from semispline.solver.topology import measure_chain_contact

    found = measure_chain_contact(ends[0], ends[1], limits=kind)
    return _Measured(
        chain_contact_record(found),
        None,
        {},
        chain_misses(found, required),
        [],
        lambda: print_chain_contact(found, ends[0].loaded.unit, required),
    )


def _of_edges(ends: Sequence[ResolvedEdge], required: Continuity | None, kind: Limits | Auto) -> _Measured:
    """Measure two edges of which each is one of its surface."""
    from semispline.solver.io import MILLIMETRES
    from semispline.solver.judge import Base, in_cad_limits, measure_contact, measure_profile, with_worse

    first, second = (Base(end.surface, end.edge) for end in ends)
    contact = measure_contact(first, second, order=4)
    profile = measure_profile(first, second, contact)
    contact = with_worse(contact, profile)
    if kind == "cad":
        unit = ends[0].loaded.unit
        contact = in_cad_limits(contact, float(profile.length[-1]), None if unit is None else MILLIMETRES[unit])
    misses = _misses(contact, required)
    return _Measured(
        contact_record(contact) | {"limits": "cad" if kind == "cad" else "exact"} | profile_record(profile),
        profile,
        plot_limits(contact),
        misses,
        _doubts(first, second, contact, required, misses),
        lambda: print_contact(contact, profile, ends[0].loaded.unit, required),
    )


def _on_face(ends: Sequence[ResolvedEdge], required: Continuity | None, kind: Limits | Auto) -> _Measured:
    """Measure two edges of which one at least is a free curve of its face."""
    from semispline.solver.topology import measure_free_contact

    found = measure_free_contact(ends[0], ends[1], limits=kind)
    return _Measured(
        face_contact_record(found),
        found.profile,
        found.allowed,
        face_misses(found, required),
        [],
        lambda: print_face_contact(found, ends[0].loaded.unit, required),
    )


def _misses(contact: Contact, require: Continuity | None) -> list[str]:
    """Return, of each measure that falls short, its name, value and limit."""
    if require is None:
        return []
    from semispline.solver.judge import shortfalls

    return [
        f"{name.replace('_', ' ')} is {value:.3g}, at most {limit:.3g} allowed"
        if not isnan(value)
        else f"{name.replace('_', ' ')} does not exist where there is no normal"
        for name, value, limit in shortfalls(contact, require)
    ]


def _doubts(a: Base, b: Base, contact: Contact, require: Continuity | None, misses: list[str]) -> list[str]:
    """Return what qualifies the answer: places without a normal, and measures of which rounding hides a part.

    Raises
    ------
    ContactError
        Rounding hides so much that there is no answer.
    """
    from semispline.solver.judge import doubtful, rounding_causes, untold

    if require is None:
        return []
    hidden = untold(contact, require)
    if hidden and not misses:
        causes = rounding_causes(a, b, int(require[1])).words(("A", "B"))
        remedy = causes or "choose knots that are further apart, or ask for a lower continuity"
        raise ContactError(f"{require} cannot be told: {'; '.join(hidden)}; {remedy}")
    places = contact.no_normal if require in ("G1", "G2", "G3", "G4") else ()
    return [f"{place.surface.upper()} has {place}" for place in places] + doubtful(contact, require)
