"""The commands show and convert.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from semispline.solver.cli.words import SURFACE_HELP, check_outputs, progress
from semispline.solver.errors import OptionError
from semispline.solver.exit_status import reports_errors
from semispline.solver.reports import print_warnings

if TYPE_CHECKING:
    from semispline.solver.topology import DrawnFace

# Names in a message; more surfaces than these are a part, which has an upright position.
_SHOWN, _MANY = 12, 6


@reports_errors
def show_command(
    files: Annotated[list[str], typer.Argument(metavar="FILE...", help=f"{SURFACE_HELP} Without #N all surfaces.")],
    out: Annotated[str, typer.Option("-o", "--out", metavar="PNG", help="Picture to write.")],
    color: Annotated[
        str | None, typer.Option(metavar="COLOR", help="curvature, gaussian, zebra or isophotes; without, shaded.")
    ] = None,
    deviation_from: Annotated[
        str | None,
        typer.Option(
            metavar="PATH#N",
            help="Color by the distance from this face, as of a blend from the face that it replaces. Its file, given "
            "without #N, stands around in gray.",
        ),
    ] = None,
    views: Annotated[
        str | None,
        typer.Option(
            metavar="VIEWS", help="Some of iso,front,back,left,right,top,bottom in one picture; without, one is chosen."
        ),
    ] = None,
    labels: Annotated[
        bool,
        typer.Option(
            "--labels",
            help="Name faces, as `semispline list` numbers them; and edges, of a single face or with --edges.",
        ),
    ] = False,
    edges: Annotated[
        bool, typer.Option("--edges", help="Draw edges broad; with --labels, name those of every face.")
    ] = (False),
    control_points: Annotated[
        bool,
        typer.Option("--control-points", help="Of semi-structured surfaces; of all where there is none."),
    ] = False,
) -> None:
    """Draw surfaces into a PNG file, trimmed faces as they are trimmed; needs no display."""
    from semispline.solver.pictures import Drawn, TrueFace, check_picture, parsed_views, render
    from semispline.solver.splines import SemiStructuredSurface
    from semispline.solver.topology import read_drawn, read_true_face

    if color is not None and deviation_from is not None:
        raise OptionError("--color: found it together with --deviation-from, expected one of them")
    chosen = () if views is None else parsed_views(views)
    check_picture(out, color)
    check_outputs({"--out": out}, [*files, *([] if deviation_from is None else [deviation_from])])
    with progress("reading"):
        faces, said = read_drawn(files)
        true = None if deviation_from is None else read_true_face(deviation_from, [face.loaded for face in faces])
    for sentence in said:
        typer.echo(sentence, err=True)
    with progress("drawing"):
        blends = [isinstance(face.surface, SemiStructuredSurface) for face in faces]
        names = _labels(faces) if labels else [""] * len(faces)
        kept = [
            k
            for k, face in enumerate(faces)
            if true is None or (face.path, face.number or 0) != (true.path, true.number or 0)
        ]
        drawn = [
            Drawn(
                faces[k].surface,
                control_points=control_points and (blends[k] or not any(blends)),
                mesh=faces[k].mesh,
                edges=faces[k].edges,
                label=names[k],
                name_edges=labels and (edges or len(faces) == 1),
                around=true is not None and faces[k].path == true.path and faces[k].path in files,
            )
            for k in kept
        ]
        if true is not None and all(item.around for item in drawn):
            raise OptionError(
                f"--deviation-from: found nothing but {true.path} itself to measure from {deviation_from}; give "
                "another file, or other faces as PATH#N"
            )
        picture = render(
            drawn,
            out,
            field=cast(Any, color),
            true_face=None if true is None else TrueFace(true),
            views=chosen or (("iso",) if len(drawn) > _MANY else ()),
            heavy_edges=edges,
        )
    if true is not None and picture.deviation is not None:
        unit, found = true.loaded.unit or "model units", picture.deviation
        place = ", ".join(f"{x:.5g}" for x in found.at)
        typer.echo(f"distance from {deviation_from}: largest {found.largest:.3g} {unit} at ({place}), ", nl=False)
        measured = [k for k, item in zip(kept, drawn, strict=True) if not item.around]
        others = (
            f"; of {len(measured)} surfaces the largest is on {faces[measured[found.of]].spec}" if measured[1:] else ""
        )
        typer.echo(f"mean {found.mean:.3g} {unit}{others}")
    if picture.unnamed_edges:
        typer.echo(
            f"edges not named, since no view shows them or leaves room: {picture.unnamed_edges}; "
            "`semispline show PATH#N --labels` names those of one face, --views has other sides",
            err=True,
        )
    if picture.unseen:
        shown = ", ".join(picture.unseen[:_SHOWN]) + (", .." if len(picture.unseen) > _SHOWN else "")
        typer.echo(f"not named, since no view shows them or leaves room: {len(picture.unseen)}: {shown}", err=True)


def _labels(faces: Sequence[DrawnFace]) -> list[str]:
    """Return what each face is called: #N, with the name of its file where there are several files."""
    several = len({face.path for face in faces}) > 1
    return [
        (Path(face.path).stem if several or face.number is None else "")
        + ("" if face.number is None else f"#{face.number}")
        for face in faces
    ]


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
