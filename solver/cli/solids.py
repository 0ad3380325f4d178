"""What the command blend does where a solid comes back.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from semispline.solver.cli.words import progress
from semispline.solver.options import BlendOptions
from semispline.solver.reports import print_result, reports_record

if TYPE_CHECKING:
    from semispline.solver.cli.wanted_bases import WantedBases
    from semispline.solver.topology import SolidBlend


def write_solid(wanted: WantedBases, out: str, options: BlendOptions, report: str | None) -> None:
    """Write the solid with the blend in it, and the report: both or none."""
    from semispline.solver.io import atomic_path, to_text
    from semispline.solver.topology import solid_with_blend

    assert wanted.replaced is not None
    with progress("blending"):
        found = solid_with_blend(
            wanted.a, wanted.replaced, Path(out).suffix.lower(), options, wanted.edge_a, wanted.edge_b
        )
    with ExitStack() as stack:
        # Each lies in its temporary file before the first takes its place.
        if report is not None:
            record = reports_record([found.blend]) | found.record()
            stack.enter_context(atomic_path(report)).write_text(to_text(record))
        stack.enter_context(atomic_path(out)).write_bytes(found.content)
    _print(found)
    print_result(found.blend)


def no_solid(path: str, out: str) -> str:
    """Say why a face was replaced and no solid came back."""
    from semispline.solver.topology import can_hold_a_solid

    which = out if can_hold_a_solid(path) else path
    where = f"{'in' if which == out else 'from'} {Path(which).suffix.lower() or which}"
    return f"no solid can come back {where}: the blend is written as a surface; STEP and BREP hold solids"


def _print(found: SolidBlend) -> None:
    report = found.gate
    had, has = report.volume
    kind = "solid" if report.solids[1] else "shell"
    count = report.solids[1] or report.shells[1] or 1
    typer.echo(found.said)
    typer.echo(
        f"{f'one sound {kind}' if count == 1 else f'{count} sound {kind}s'} of {report.faces[1]} faces: "
        f"{found.face} is the blend, {', '.join(map(str, found.touched))} have new borders, all else is as it was"
    )
    typer.echo(f"volume {had:.9g} -> {has:.9g}, by {has - had:.4g} of at most {report.volume_limit:.4g}")
    before = max((edge.was or 0.0 for edge in report.border), default=0.0)
    typer.echo(
        f"largest tolerance at the blend {before:.2g} -> {report.largest_tolerance:.2g}, read back "
        f"{found.read_back.largest_tolerance:.2g}; largest gap {max(edge.gap for edge in report.border):.2g}"
    )
    for note in found.notes:
        typer.echo(note)
