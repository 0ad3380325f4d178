"""The commands show and convert.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from typing import Annotated, Any, cast

import typer

from semispline.solver.cli.words import SURFACE_HELP, check_outputs, progress
from semispline.solver.exit_status import reports_errors
from semispline.solver.reports import print_warnings


@reports_errors
def show_command(
    files: Annotated[list[str], typer.Argument(metavar="FILE...", help=f"{SURFACE_HELP} Without #N all surfaces.")],
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
    check_outputs({"--out": out}, files)
    with progress("reading"):
        loaded, problems = read_all(files)
    for problem in problems:
        typer.echo(f"left out: {problem}", err=True)
    with progress("drawing"):
        surfaces = [item.surface for item in in_one_unit(loaded)]
        blends = [isinstance(surface, SemiStructuredSurface) for surface in surfaces]
        shown = [control_points and (is_blend or not any(blends)) for is_blend in blends]
        render(surfaces, out, control_points=shown, field=cast(Any, color))


@reports_errors
def convert_command(
    source: Annotated[str, typer.Argument(metavar="IN", help=SURFACE_HELP)],
    target: Annotated[
        str, typer.Argument(metavar="OUT", help="File to write: .json .step .iges .brep .3dm .obj .stl .ply .gltf .glb")
    ],
) -> None:
    """Write a surface in another format: exactly, or as a mesh."""
    from semispline.solver.io import approximation_warning, check_surface_output, read_surfaces, write_surface

    check_surface_output(target)
    check_outputs({"OUT": target}, [source])
    with progress("converting"):
        (loaded,) = read_surfaces([source])
        write_surface(target, loaded.surface, loaded.unit)
    warning = approximation_warning(source, loaded)
    print_warnings([warning] if warning else [])
