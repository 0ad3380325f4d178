"""The commands blend and problem.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from typing import Annotated

import typer

from semispline.solver.cli.wanted_bases import WantedBases
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
    print_resolved,
    progress,
    resolved,
)
from semispline.solver.exit_status import reports_errors
from semispline.solver.option_flags import takes_blend_options
from semispline.solver.options import BlendOptions
from semispline.solver.reports import print_result, report_record

_CUT_HELP = (
    "Move the contact from the edge into {}: a distance along the surface, square to the edge, or a parameter, u=0.3. "
    "Two faces of one file that share an edge need no --edge."
)


@reports_errors
@takes_blend_options
def blend_command(
    a: Annotated[str, typer.Argument(metavar="A", help=f"{SURFACE_HELP} With --replace the file alone.")],
    out: Annotated[str, typer.Option("-o", "--out", metavar="OUT", help="File to write; the suffix says the format.")],
    options: BlendOptions,
    b: Annotated[str | None, typer.Argument(metavar="[B]", help="The same for the other surface.")] = None,
    edge_a: Annotated[str | None, typer.Option(metavar="EDGE", help=EDGE_HELP.format("A, or of FACE"))] = None,
    edge_b: Annotated[str | None, typer.Option(metavar="EDGE", help=EDGE_HELP.format("B, or another of FACE"))] = None,
    replace_face: Annotated[
        int | None,
        typer.Option("--replace", metavar="FACE", min=0, help="Blend the faces beside this one, as if it were away."),
    ] = None,
    cut_a: Annotated[str | None, typer.Option(metavar="D", help=_CUT_HELP.format("A"))] = None,
    cut_b: Annotated[str | None, typer.Option(metavar="D", help=_CUT_HELP.format("B"))] = None,
    with_bases: Annotated[
        bool, typer.Option("--with-bases", help="Write the bases, cut to their edges, as surfaces beside the blend.")
    ] = False,
    report: Annotated[str | None, typer.Option(metavar="FILE", help="JSON with all that is known of it.")] = None,
) -> None:
    """Join an edge of A and an edge of B by a semi-structured surface of fairest shape, or as the options say."""
    from semispline.solver.io import atomic_path, check_surface_output, face_warnings, to_text, write_surfaces

    wanted = WantedBases(a, b, edge_a, edge_b, replace_face, (cut_a, cut_b))
    wanted.check()
    check_surface_output(out, 3 if with_bases else 1)
    check_outputs({"--out": out, "--report": report}, wanted.specs)
    with progress("reading"):
        ends, said = wanted.resolved()
    trims = face_warnings(*((end.spec, end.edge, end.loaded) for end in ends), strict=options.strict)
    with progress("blending"):
        from semispline.solver.blending import blend
        from semispline.solver.judge import Base

        first, second = (Base(end.surface, end.edge) for end in ends)
        result = blend(first, second, options)
    result = replace(result, warnings=(*trims, *result.warnings))
    with ExitStack() as stack:
        # The report first, into its temporary file: neither file is touched unless both can be written.
        if report is not None:
            temporary = stack.enter_context(atomic_path(report))
            temporary.write_text(to_text(report_record(result) | asked(ends) | wanted.record))
        surfaces = [result.surface, first.surface, second.surface] if with_bases else [result.surface]
        write_surfaces(out, surfaces, ends[0].loaded.unit)
    if said:
        typer.echo(said)
    print_resolved(ends)
    print_result(result)


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

    check_words(edge_a, edge_b)
    check_outputs({"--out": out}, [a, b])
    ends = resolved(a, edge_a, b, edge_b)
    # A name that the surface does not have is refused here.
    first, second = (Base(end.surface, end.edge).edge for end in ends)
    specs = [relative_spec(end.spec, out) for end in ends]
    write_problem(out, StoredProblem(specs[0], first, specs[1], second, options, ends[0].asked, ends[1].asked))
    print_resolved(ends)
