"""The commands blend and problem.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast, get_args

import typer

from semispline.solver.cli.solids import (
    SolidOutputs,
    WantedEdge,
    WantedJoin,
    no_solid,
    write_added,
    write_joined,
    write_rounded,
    write_solid,
)
from semispline.solver.cli.wanted_bases import WantedBases, face_numbers
from semispline.solver.cli.words import (
    EDGE_HELP,
    SURFACE_HELP,
    EdgeA,
    EdgeB,
    SurfaceA,
    SurfaceB,
    asked,
    check_outputs,
    check_words,
    edges_of,
    print_resolved,
    progress,
    resolved,
)
from semispline.solver.errors import OptionError
from semispline.solver.exit_status import reports_errors
from semispline.solver.option_flags import takes_blend_options
from semispline.solver.options import BlendOptions
from semispline.solver.reports import print_result, reports_record

if TYPE_CHECKING:
    from semispline.solver.blending import Split
    from semispline.solver.splines import Surface

_CUT_HELP = (
    "Move the contact from the edge into {}: a distance along the surface, square to the edge, or a parameter, u=0.3. "
    "Two faces of one file that share an edge need no --edge."
)


@reports_errors
@takes_blend_options
def blend_command(
    out: Annotated[str, typer.Option("-o", "--out", metavar="OUT", help="File to write; the suffix says the format.")],
    options: BlendOptions,
    a: Annotated[
        str | None,
        typer.Argument(
            metavar="[A]",
            help=f"{SURFACE_HELP} With --replace and --round the file alone; none with --from and --to.",
        ),
    ] = None,
    b: Annotated[str | None, typer.Argument(metavar="[B]", help="The same for the other surface.")] = None,
    edge_a: Annotated[str | None, typer.Option(metavar="EDGE", help=EDGE_HELP.format("A, or of FACE"))] = None,
    edge_b: Annotated[str | None, typer.Option(metavar="EDGE", help=EDGE_HELP.format("B, or another of FACE"))] = None,
    replace_face: Annotated[
        str | None,
        typer.Option(
            "--replace",
            metavar="FACE[,FACE..]",
            help="Take this face out of its solid and put a blend of its neighbours in; several that go on into each "
            "other together.",
        ),
    ] = None,
    keep_ends: Annotated[
        bool,
        typer.Option(
            "--keep-ends", help="Keep end edges over which FACE goes on into others: contact falls to G1 near them."
        ),
    ] = False,
    round_edge: Annotated[
        str | None,
        typer.Option("--round", metavar="FACE:EDGE", help="Round this sharp edge, as 12:e3: the solid comes back."),
    ] = None,
    distance: Annotated[
        float | None, typer.Option(metavar="D", help="How far from the edge --round begins, along both faces.")
    ] = None,
    from_face: Annotated[
        str | None,
        typer.Option(
            "--from",
            metavar="FILE#FACE",
            help="Take this planar face off its solid and join its outline to that of --to: one solid comes back.",
        ),
    ] = None,
    to_face: Annotated[
        str | None,
        typer.Option("--to", metavar="FILE#FACE", help="The other, of this file or of another; FILE:FACE will do."),
    ] = None,
    cut_a: Annotated[str | None, typer.Option(metavar="D", help=_CUT_HELP.format("A"))] = None,
    cut_b: Annotated[str | None, typer.Option(metavar="D", help=_CUT_HELP.format("B"))] = None,
    surfaces: Annotated[
        bool, typer.Option("--surfaces", help="Write the blend alone, as a surface: the default without a solid.")
    ] = False,
    with_bases: Annotated[
        bool, typer.Option("--with-bases", help="Write the bases, cut to their edges, as surfaces beside the blend.")
    ] = False,
    split: Annotated[
        str,
        typer.Option(
            metavar="WHERE",
            help="Cut the blend of several edges into faces: at corners, or at all joints. JSON keeps it whole.",
        ),
    ] = "corners",
    report: Annotated[str | None, typer.Option(metavar="FILE", help="JSON with all that is known of it.")] = None,
    plots: Annotated[
        str | None, typer.Option(metavar="DIR", help="Draw the solid with its new faces red, into solid.png there.")
    ] = None,
) -> None:
    """Join an edge of A and an edge of B by a semi-structured surface of fairest shape, or as the options say."""
    from semispline.solver.io import check_surface_output

    if from_face is not None or to_face is not None:
        join = WantedJoin(from_face, to_face, (a, b, edge_a, edge_b, replace_face, round_edge, distance, cut_a, cut_b))
        join.check(out)
        check_outputs({"--out": out, "--report": report}, join.specs)
        write_joined(join, SolidOutputs(out, report, plots), options, split_name(split))
        return
    if a is None:
        raise OptionError("blend: A missing, expected a surface or a file; with --from and --to there is none")
    if round_edge is not None or distance is not None:
        wanted_edge = WantedEdge(a, round_edge, distance, (b, edge_a, edge_b, replace_face, cut_a, cut_b))
        wanted_edge.check(out)
        check_outputs({"--out": out, "--report": report}, [a])
        write_rounded(wanted_edge, SolidOutputs(out, report, plots), options)
        return
    wanted = WantedBases(a, b, edge_a, edge_b, face_numbers(replace_face), (cut_a, cut_b))
    wanted.check()
    if keep_ends and (surfaces or with_bases or not wanted.gives_solid(out)):
        raise OptionError(
            "--keep-ends: found it where no solid comes back, expected --replace from STEP or BREP to such"
        )
    if surfaces and with_bases:
        raise OptionError("--surfaces: found it together with --with-bases, expected one of them")
    at = split_name(split)
    check_surface_output(out, 3 if with_bases else 1)
    check_outputs({"--out": out, "--report": report}, wanted.specs)
    sharp = None if surfaces or with_bases else wanted.sharp_edge()
    if not (surfaces or with_bases) and (wanted.gives_solid(out) or (sharp and wanted.holds_solids(out))):
        write_solid(wanted, sharp, SolidOutputs(out, report, plots), options, keep_ends=keep_ends)
        return
    if plots is not None:
        raise OptionError(
            "--plots: found it without a solid, expected --replace, --round or cuts of a solid's edge; "
            f"`semispline show {out} -o PNG` draws surfaces"
        )
    _write_blends(wanted, out, options, at, report, alone=surfaces, with_bases=with_bases, is_sharp=sharp is not None)


def _write_blends(
    wanted: WantedBases,
    out: str,
    options: BlendOptions,
    at: Split,
    report: str | None,
    *,
    alone: bool,
    with_bases: bool,
    is_sharp: bool,
) -> None:
    """Write blends as surfaces, alone or with their bases, and the report; say why no solid came back."""
    from semispline.solver.io import face_warnings, split_spec

    with progress("reading"):
        ends, said = wanted.resolved()
    trims = face_warnings(*edges_of(ends), strict=options.strict)
    with progress("blending"):
        from semispline.solver.blending import faces_of_blend
        from semispline.solver.topology import blend_bases, edge_bases, paired_bases

        pairs = paired_bases(*edge_bases(ends, options.continuities))
        files = part_files(out, len(pairs))
        check_outputs({f"--out {file}": file for file in files} | {"--report": report}, wanted.specs)
        results = [blend_bases(*pair, options, several=len(pairs) > 1) for pair in pairs]
    results[0] = replace(results[0], warnings=(*trims, *results[0].warnings))
    record = reports_record(results) | {"a": ends[0].spec, "b": ends[1].spec} | asked(ends) | wanted.record
    whole = Path(out).suffix.lower() == ".json"
    # Of a 3dm file no solid comes back: what would be in it is added to a copy.
    added = wanted.is_added(out) and not alone
    of_parts = [
        [
            *((result.surface,) if whole else faces_of_blend(result, at)),
            *(base.surface for side in pair if with_bases or added for base in side.bases),
        ]
        for result, pair in zip(results, pairs, strict=True)
    ]
    if added:
        write_added(ends[0].spec, out, [x for part in of_parts for x in part], report, record)
    else:
        _write(files, of_parts, ends[0].loaded.unit, report, record)
    if said:
        typer.echo(said)
    print_resolved(ends)
    if (wanted.replaced is not None or is_sharp or added) and not (alone or with_bases):
        typer.echo(no_solid(split_spec(wanted.a)[0], out, added=added))
    for k, result in enumerate(results):
        if len(results) > 1:
            typer.echo(f"part {k + 1} of {len(results)}, in {files[k] if len(files) > 1 else out}:")
        print_result(result)


def split_name(word: str) -> Split:
    """Return where the blend of several edges is cut.

    Raises
    ------
    OptionError
    """
    from semispline.solver.blending import Split

    if word not in get_args(Split):
        raise OptionError(f"--split: found {word!r}, expected corners or joints")
    return cast("Split", word)


def _write(
    files: Sequence[str],
    surfaces: Sequence[Sequence[Surface]],
    unit: str | None,
    report: str | None,
    record: Mapping[str, Any],
) -> None:
    """Write the surfaces of each part, into one file or each into its own, and the report: all of them or none."""
    from semispline.solver.io import atomic_path, to_text, write_surfaces

    in_files = [list(chain.from_iterable(surfaces))] if len(files) == 1 else surfaces
    with ExitStack() as stack:
        # Each lies in its temporary file before the first takes its place.
        if report is not None:
            stack.enter_context(atomic_path(report)).write_text(to_text(record))
        for file, content in zip(files, in_files, strict=True):
            write_surfaces(stack.enter_context(atomic_path(file)), content, unit)


def part_files(out: str, parts: int) -> list[str]:
    """Return the files for the blends of so many parts: one where the format holds several surfaces, else numbered.

    Examples
    --------
    >>> part_files("blend.step", 3), part_files("a/blend.json", 2), part_files("blend.json", 1)
    (['blend.step'], ['a/blend-0.json', 'a/blend-1.json'], ['blend.json'])
    """
    path = Path(out)
    if parts == 1 or path.suffix.lower() != ".json":
        return [out]
    return [str(path.with_name(f"{path.stem}-{k}{path.suffix}")) for k in range(parts)]


@reports_errors
@takes_blend_options
def problem_command(
    a: SurfaceA,
    b: SurfaceB,
    edge_a: EdgeA,
    edge_b: EdgeB,
    out: Annotated[str, typer.Option("-o", "--out", metavar="JSON", help="File to write.")],
    options: BlendOptions,
) -> None:
    """Write what blend would be asked as a problem file, which `generate --c` and scripts read; solve nothing."""
    from semispline.solver.io import StoredProblem, relative_spec, write_problem
    from semispline.solver.judge import Base
    from semispline.solver.topology import ResolvedEdge

    check_words(edge_a, edge_b)
    check_outputs({"--out": out}, [a, b])
    ends = resolved(a, edge_a, b, edge_b)
    # A name that the surface does not have is refused here; a free curve and a chain have names in their file alone.
    first, second = (
        Base(end.surface, end.edge).edge if isinstance(end, ResolvedEdge) and not end.is_free else end.edge
        for end in ends
    )
    specs = [relative_spec(end.spec, out) for end in ends]
    write_problem(out, StoredProblem(specs[0], first, specs[1], second, options, ends[0].asked, ends[1].asked))
    print_resolved(ends)
