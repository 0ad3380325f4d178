"""What the command blend does where a solid comes back.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

import re
from contextlib import ExitStack
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from semispline.solver.cli.words import progress
from semispline.solver.errors import OptionError
from semispline.solver.options import BlendOptions
from semispline.solver.reports import print_result, reports_record

if TYPE_CHECKING:
    from semispline.solver.cli.wanted_bases import WantedBases
    from semispline.solver.topology import SolidBlend


# FACE:EDGE.
_EDGE = re.compile(r"(\d+):(e\d+)")


@dataclass(frozen=True)
class WantedEdge:
    """What was said of a sharp edge to be rounded; `others` belong to other ways to say what is blended."""

    path: str
    edge: str | None
    distance: float | None
    others: tuple[object, ...]

    @property
    def names(self) -> tuple[int, str]:
        """The face and its edge.

        Raises
        ------
        OptionError
        """
        found = _EDGE.fullmatch((self.edge or "").strip())
        if found is None:
            raise OptionError(f"--round: found {self.edge!r}, expected a face and its edge, as 12:e3")
        return int(found[1]), found[2]

    def check(self, out: str) -> None:
        """Refuse what does not go together before a file is read.

        Raises
        ------
        OptionError
        """
        from semispline.solver.topology import can_hold_a_solid

        if self.edge is None or self.distance is None:
            missing = "--round" if self.edge is None else "--distance"
            raise OptionError(f"{missing}: missing, expected --round FACE:EDGE and --distance D together")
        if any(other is not None for other in self.others):
            raise OptionError("--round: found together with B, --replace, --edge-a, --edge-b, --cut-a or --cut-b")
        if not (isfinite(self.distance) and self.distance > 0):
            raise OptionError(f"--distance: found {self.distance}, expected a finite number above 0")
        _ = self.names
        if not can_hold_a_solid(self.path) or not can_hold_a_solid(out, written=True):
            raise OptionError(
                f"--round: found {self.path} and {out}, expected a STEP, IGES or BREP file and one of STEP or BREP to "
                "write: no solid can come back otherwise"
            )


def write_rounded(wanted: WantedEdge, out: str, options: BlendOptions, report: str | None) -> None:
    """Write the solid with its edge rounded, and the report: both or none."""
    from semispline.solver.topology import solid_with_round

    cut = repr(wanted.distance)
    with progress("blending"):
        found = solid_with_round(wanted.path, *wanted.names, (cut, cut), Path(out).suffix.lower(), options)
    _write(found, out, report)


def write_solid(wanted: WantedBases, out: str, options: BlendOptions, report: str | None, *, keep_ends: bool) -> None:
    """Write the solid with the blend in it, and the report: both or none."""
    from semispline.solver.topology import solid_with_blend

    assert wanted.replaced is not None
    with progress("blending"):
        found = solid_with_blend(
            wanted.a,
            wanted.replaced,
            Path(out).suffix.lower(),
            options,
            wanted.edge_a,
            wanted.edge_b,
            keep_ends=keep_ends,
        )
    _write(found, out, report)


def _write(found: SolidBlend, out: str, report: str | None) -> None:
    from semispline.solver.io import atomic_path, to_text

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
        f"{', '.join(map(str, found.faces))} {'is' if len(found.faces) == 1 else 'are'} the blend, "
        f"{', '.join(map(str, found.touched))} have new borders, all else is as it was"
    )
    typer.echo(f"volume {had:.9g} -> {has:.9g}, by {has - had:.4g} of at most {report.volume_limit:.4g}")
    before = max((edge.was or 0.0 for edge in report.border), default=0.0)
    typer.echo(
        f"largest tolerance at the blend {before:.2g} -> {report.largest_tolerance:.2g}, read back "
        f"{found.read_back.largest_tolerance:.2g}; largest gap {max(edge.gap for edge in report.border):.2g}"
    )
    for note in found.notes:
        typer.echo(note)
