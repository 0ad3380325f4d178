"""What commands share: their words for surfaces and edges, and how they read, write and say that they are at work.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from semispline.solver.io import LoadedSurface
    from semispline.solver.topology import Resolved

SURFACE_HELP = "PATH, or PATH#N as `semispline list PATH` numbers it (JSON, STEP, IGES, BREP, 3dm)."
EDGE_HELP = (
    "Edge of {}: u0, u1, v0 or v1, the parameter that is constant along it and at which end; a part, u1[0.2,0.6]; a "
    "line inside, u=0.3+ (the side of larger u is kept) or u=0.3-; a part of it, u=0.3+[0.2,0.6]; e3, an edge of the "
    "face as `semispline list PATH --edges N` numbers it; near=x,y,z, its edge nearest to a point; several end to end, "
    "e3+e4, 12:e3+13:e1 (of faces 12 and 13 of the file), e3..e9, e3* (all that go on smoothly from e3)."
)
CONTINUITY_HELP = "C0, C1, C2, G0, G1, G2, G3 or G4."

SurfaceA = Annotated[str, typer.Argument(metavar="A", help=SURFACE_HELP)]
SurfaceB = Annotated[str, typer.Argument(metavar="B", help="The same for the other surface.")]
EdgeA = Annotated[str, typer.Option("--edge-a", metavar="EDGE", help=EDGE_HELP.format("A"))]
EdgeB = Annotated[str, typer.Option("--edge-b", metavar="EDGE", help=EDGE_HELP.format("B"))]


def check_words(edge_a: str, edge_b: str) -> None:
    """Refuse what names no edge before a file is read."""
    check_word(edge_a, "--edge-a")
    check_word(edge_b, "--edge-b")


def check_word(word: str, name: str) -> None:
    """Refuse what names no edge; messages call it `name`."""
    from semispline.solver.topology import check_edge_word

    check_edge_word(word, name)


def resolved(a: str, edge_a: str, b: str, edge_b: str) -> list[Resolved]:
    """Return both edges as surfaces and names that `Base` knows; files are read at once."""
    from semispline.solver.topology import resolve_edges

    with progress("reading"):
        return resolve_edges([(a, edge_a), (b, edge_b)])


def asked(ends: Sequence[Resolved]) -> dict[str, Any]:
    """Return the words that were resolved, as a problem file and a report hold them."""
    return {f"asked_{side}": end.asked for side, end in zip("ab", ends, strict=True) if end.asked is not None}


def edges_of(ends: Sequence[Resolved]) -> Iterator[tuple[str, str, LoadedSurface]]:
    """Yield of each edge, of chains too, what `face_warnings` takes."""
    from semispline.solver.topology import members

    for end in ends:
        for edge in members(end):
            yield edge.spec, edge.edge, edge.loaded


def print_resolved(ends: Sequence[Resolved]) -> None:
    """Say which edge a word was found to be."""
    for side, end in zip("AB", ends, strict=True):
        if end.said:
            typer.echo(f"edge of {side}: {end.said}")


def check_outputs(outputs: Mapping[str, str | None], specs: Sequence[str]) -> None:
    """Refuse outputs that cannot be written or that would replace an input, before anything is read."""
    from semispline.solver.io import check_outputs, split_spec

    check_outputs(outputs, [split_spec(spec)[0] for spec in specs])


def file_name(path: str | None) -> str | None:
    """Return the path of an option that may be - for standard output, where it is a file."""
    return None if path == "-" else path


def write_json(path: str, record: dict[str, Any]) -> None:
    """Write a record as JSON; - is standard output."""
    from semispline.solver.io import to_text, write_text

    if path == "-":
        typer.echo(to_text(record), nl=False)
    else:
        write_text(path, to_text(record))


@contextmanager
def progress(what: str) -> Iterator[None]:
    """Show on a terminal that something is going on; on standard error, so that output stays clean."""
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    with console.status(what):
        yield
