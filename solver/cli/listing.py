"""The command list: surfaces of a file, edges of a face, places to blend.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated

import typer

from semispline.solver.cli.words import file_name, progress, write_json
from semispline.solver.errors import OptionError
from semispline.solver.exit_status import reports_errors
from semispline.solver.reports import print_entries


@reports_errors
def list_command(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A CAD file: STEP, IGES, BREP or 3dm.")],
    pairs: Annotated[
        bool,
        typer.Option("--pairs", help="Propose places to blend instead: fillets, gaps, chamfers, sharp edges."),
    ] = False,
    edges: Annotated[
        int | None,
        typer.Option(metavar="N", min=0, help="List the edges of face N instead, with the names that --edge-a takes."),
    ] = None,
    json_file: Annotated[
        str | None, typer.Option("--json", metavar="FILE", help="Write the list; - is standard output.")
    ] = None,
) -> None:
    """List the surfaces of a file: number, kind, degrees, control points, rational, trimmed, closed."""
    from semispline.solver.io import check_outputs, list_file

    check_outputs({"--json": file_name(json_file)}, [file])
    if pairs and edges is not None:
        raise OptionError("--pairs: found it together with --edges, expected one of them")
    if pairs:
        _list_pairs(file, json_file)
        return
    if edges is not None:
        _list_edges(file, edges, json_file)
        return
    with progress("reading"):
        entries, others = list_file(file)
    if json_file is not None:
        record = {"path": file, "surfaces": [asdict(entry) for entry in entries], "others": dict(others)}
        write_json(json_file, {"format": "semispline/1", "kind": "surface_list", **record})
    if json_file != "-":
        print_entries(entries, others)


def _list_edges(file: str, face: int, json_file: str | None) -> None:
    from semispline.solver.topology import edge_lines, edges_record, list_edges

    with progress("reading"):
        found = list_edges(file, face)
    if json_file is not None:
        write_json(json_file, {"format": "semispline/1", "kind": "edge_list", **edges_record(found)})
    if json_file != "-":
        for line in edge_lines(found):
            typer.echo(line)


def _list_pairs(file: str, json_file: str | None) -> None:
    from semispline.solver.topology import find_places, place_lines, places_record

    with progress("reading"):
        places = find_places(file)
    if json_file is not None:
        write_json(json_file, {"format": "semispline/1", "kind": "place_list", **places_record(places)})
    if json_file != "-":
        for line in place_lines(places):
            typer.echo(line)
