"""The commands blend, check, list, show and convert; `semispline.papers.cli` mounts them beside its own.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, replace
from math import isnan
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from semispline.solver.errors import ContactError, EdgeError
from semispline.solver.exit_status import ANSWER_IS_NO, reports_errors
from semispline.solver.option_flags import takes_blend_options
from semispline.solver.options import BlendOptions, Continuity, continuity_name
from semispline.solver.reports import (
    contact_record,
    print_contact,
    print_entries,
    print_result,
    print_warnings,
    report_record,
)

if TYPE_CHECKING:
    from semispline.solver.judge import Base, Contact

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)

_EDGES = ("u0", "u1", "v0", "v1")
_SURFACE_HELP = "PATH, or PATH#N as `semispline list PATH` numbers it (JSON, STEP, IGES, BREP, 3dm)."
_EDGE_HELP = "Edge of {}: u0, u1, v0 or v1, the parameter that is constant along it and at which end."
_CONTINUITY_HELP = "C0, C1, C2, G0, G1, G2, G3 or G4."

SurfaceA = Annotated[str, typer.Argument(metavar="A", help=_SURFACE_HELP)]
SurfaceB = Annotated[str, typer.Argument(metavar="B", help="The same for the other surface.")]
EdgeA = Annotated[str, typer.Option("--edge-a", metavar="EDGE", help=_EDGE_HELP.format("A"))]
EdgeB = Annotated[str, typer.Option("--edge-b", metavar="EDGE", help=_EDGE_HELP.format("B"))]


@app.command("blend")
@reports_errors
@takes_blend_options
def blend_command(
    a: SurfaceA,
    b: SurfaceB,
    edge_a: EdgeA,
    edge_b: EdgeB,
    out: Annotated[str, typer.Option("-o", "--out", metavar="OUT", help="File to write; the suffix says the format.")],
    options: BlendOptions,
    report: Annotated[str | None, typer.Option(metavar="FILE", help="JSON with all that is known of it.")] = None,
) -> None:
    """Join an edge of A and an edge of B by a semi-structured surface of fairest shape, or as the options say."""
    from semispline.solver.io import (
        atomic_path,
        check_surface_output,
        face_warnings,
        read_surfaces,
        to_text,
        write_surface,
    )

    _check_edges(edge_a, edge_b)
    check_surface_output(out)
    _check_outputs({"--out": out, "--report": report}, [a, b])
    with _progress("reading"):
        first, second = read_surfaces([a, b])
    trims = face_warnings((a, edge_a, first), (b, edge_b, second), strict=options.strict)
    with _progress("blending"):
        from semispline.solver.blending import blend
        from semispline.solver.judge import Base

        result = blend(Base(first.surface, cast(Any, edge_a)), Base(second.surface, cast(Any, edge_b)), options)
    result = replace(result, warnings=(*trims, *result.warnings))
    with ExitStack() as stack:
        # The report first, into its temporary file: neither file is touched unless both can be written.
        if report is not None:
            temporary = stack.enter_context(atomic_path(report))
            temporary.write_text(to_text(report_record(result)))
        write_surface(out, result.surface, first.unit)
    print_result(result)


@app.command("check")
@reports_errors
def check_command(
    a: SurfaceA,
    b: SurfaceB,
    edge_a: EdgeA,
    edge_b: EdgeB,
    require: Annotated[
        str | None, typer.Option(metavar="C", help=f"Exit status 1 if they do not meet with {_CONTINUITY_HELP}")
    ] = None,
    json_file: Annotated[
        str | None, typer.Option("--json", metavar="FILE", help="Write the figures; - is standard output.")
    ] = None,
) -> None:
    """Measure how an edge of A and an edge of B meet: gap, angle, jumps of curvature and its rates, and where."""
    from semispline.solver.io import face_warnings, read_surfaces
    from semispline.solver.judge import Base, measure_contact

    _check_edges(edge_a, edge_b)
    required = None if require is None else continuity_name(require, "--require")
    _check_outputs({"--json": _file(json_file)}, [a, b])
    with _progress("reading"):
        first, second = read_surfaces([a, b])
    with _progress("measuring"):
        bases = Base(first.surface, cast(Any, edge_a)), Base(second.surface, cast(Any, edge_b))
        contact = measure_contact(*bases, order=4)
    misses = _misses(contact, required)
    doubts = _doubts(*bases, contact, required, misses)
    warnings = face_warnings((a, edge_a, first), (b, edge_b, second))
    if json_file is not None:
        record = {"a": a, "edge_a": edge_a, "b": b, "edge_b": edge_b, "unit": first.unit, **contact_record(contact)}
        record["warnings"] = list(warnings)
        if require is not None:
            record |= {"require": required, "meets": not misses, "misses": misses, "doubts": doubts}
        _write_json(json_file, {"format": "semispline/1", "kind": "contact", **record})
    if json_file != "-":
        print_contact(contact, first.unit)
        if require is not None:
            reasons = "; ".join([*misses, *doubts])
            typer.echo(f"{required}: " + ("no: " if misses else "yes, but " if doubts else "yes") + reasons)
    print_warnings(warnings)
    if misses:
        raise typer.Exit(ANSWER_IS_NO)


@app.command("list")
@reports_errors
def list_command(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A CAD file: STEP, IGES, BREP or 3dm.")],
    pairs: Annotated[
        bool,
        typer.Option("--pairs", help="Propose places to blend instead: fillets, gaps, chamfers, sharp edges."),
    ] = False,
    json_file: Annotated[
        str | None, typer.Option("--json", metavar="FILE", help="Write the list; - is standard output.")
    ] = None,
) -> None:
    """List the surfaces of a file: number, kind, degrees, control points, rational, trimmed, closed."""
    from semispline.solver.io import check_outputs, list_file

    check_outputs({"--json": _file(json_file)}, [file])
    if pairs:
        _list_pairs(file, json_file)
        return
    with _progress("reading"):
        entries, others = list_file(file)
    if json_file is not None:
        record = {"path": file, "surfaces": [asdict(entry) for entry in entries], "others": dict(others)}
        _write_json(json_file, {"format": "semispline/1", "kind": "surface_list", **record})
    if json_file != "-":
        print_entries(entries, others)


def _list_pairs(file: str, json_file: str | None) -> None:
    from semispline.solver.topology import find_places, place_lines, places_record

    with _progress("reading"):
        places = find_places(file)
    if json_file is not None:
        _write_json(json_file, {"format": "semispline/1", "kind": "place_list", **places_record(places)})
    if json_file != "-":
        for line in place_lines(places):
            typer.echo(line)


@app.command("show")
@reports_errors
def show_command(
    files: Annotated[list[str], typer.Argument(metavar="FILE...", help=f"{_SURFACE_HELP} Without #N all surfaces.")],
    out: Annotated[str, typer.Option("-o", "--out", metavar="PNG", help="Picture to write.")],
    color: Annotated[
        str | None, typer.Option(metavar="COLOR", help="curvature, gaussian, zebra or isophotes; without, shaded.")
    ] = None,
    control_points: Annotated[
        bool,
        typer.Option("--control-points", help="Of semi-structured surfaces; of all where there is none."),
    ] = False,
) -> None:
    """Draw surfaces into a PNG file, whole, without the trimming of their faces; needs no display."""
    from semispline.solver.io import in_one_unit, read_all
    from semispline.solver.pictures import check_picture, render
    from semispline.solver.splines import SemiStructuredSurface

    check_picture(out, color)
    _check_outputs({"--out": out}, files)
    with _progress("reading"):
        loaded, problems = read_all(files)
    for problem in problems:
        typer.echo(f"left out: {problem}", err=True)
    with _progress("drawing"):
        surfaces = [item.surface for item in in_one_unit(loaded)]
        blends = [isinstance(surface, SemiStructuredSurface) for surface in surfaces]
        shown = [control_points and (is_blend or not any(blends)) for is_blend in blends]
        render(surfaces, out, control_points=shown, field=cast(Any, color))


@app.command("convert")
@reports_errors
def convert_command(
    source: Annotated[str, typer.Argument(metavar="IN", help=_SURFACE_HELP)],
    target: Annotated[
        str, typer.Argument(metavar="OUT", help="File to write: .json .step .iges .brep .3dm .obj .stl .ply .gltf .glb")
    ],
) -> None:
    """Write a surface in another format: exactly, or as a mesh."""
    from semispline.solver.io import approximation_warning, check_surface_output, read_surfaces, write_surface

    check_surface_output(target)
    _check_outputs({"OUT": target}, [source])
    with _progress("converting"):
        (loaded,) = read_surfaces([source])
        write_surface(target, loaded.surface, loaded.unit)
    warning = approximation_warning(source, loaded)
    print_warnings([warning] if warning else [])


def _check_edges(edge_a: str, edge_b: str) -> None:
    for name, edge in (("--edge-a", edge_a), ("--edge-b", edge_b)):
        if edge not in _EDGES:
            raise EdgeError(f"{name}: found {edge!r}, expected one of {', '.join(_EDGES)}")


def _check_outputs(outputs: Mapping[str, str | None], specs: Sequence[str]) -> None:
    from semispline.solver.io import check_outputs, split_spec

    check_outputs(outputs, [split_spec(spec)[0] for spec in specs])


def _file(path: str | None) -> str | None:
    """Return the path of an option that may be - for standard output, where it is a file."""
    return None if path == "-" else path


def _write_json(path: str, record: dict[str, Any]) -> None:
    from semispline.solver.io import to_text, write_text

    if path == "-":
        typer.echo(to_text(record), nl=False)
    else:
        write_text(path, to_text(record))


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


@contextmanager
def _progress(what: str) -> Iterator[None]:
    """Show on a terminal that something is going on; on standard error, so that output stays clean."""
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    with console.status(what):
        yield
