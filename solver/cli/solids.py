"""What the command blend does where a solid comes back.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import typer

from semispline.solver.cli.solid_pictures import check_solid_picture, solid_picture
from semispline.solver.cli.words import progress
from semispline.solver.errors import OptionError
from semispline.solver.options import BlendOptions
from semispline.solver.reports import print_result, print_table, reports_record

if TYPE_CHECKING:
    from semispline.solver.blending import Split
    from semispline.solver.cli.wanted_bases import WantedBases
    from semispline.solver.splines import Surface
    from semispline.solver.topology import SolidBlend, SolidContact


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


@dataclass(frozen=True)
class WantedJoin:
    """What was said of two outlines to be joined; `others` belong to other ways to say what is blended."""

    start: str | None
    end: str | None
    others: tuple[object, ...]

    @property
    def specs(self) -> tuple[str, str]:
        """Both as "PATH#N"; `PATH:N` is read so too.

        Raises
        ------
        OptionError
        """
        from semispline.solver.io import split_spec

        found = []
        for name, said in (("--from", self.start), ("--to", self.end)):
            if said is None:
                raise OptionError(f"{name}: missing, expected --from FILE#FACE and --to FILE#FACE together")
            spec = said if split_spec(said)[1] is not None else re.sub(r":(\d{1,9})$", r"#\1", said)
            if split_spec(spec)[1] is None:
                raise OptionError(f"{name}: found {said!r}, expected a file and its face, as part.step#12")
            found.append(spec)
        return found[0], found[1]

    def check(self, out: str) -> None:
        """Refuse what does not go together before a file is read.

        Raises
        ------
        OptionError
        """
        from semispline.solver.io import split_spec
        from semispline.solver.topology import can_hold_a_solid

        if any(other is not None for other in self.others):
            raise OptionError(
                "--from and --to: found together with A, B, --replace, --round, --distance, --edge-a, --edge-b, "
                "--cut-a or --cut-b"
            )
        paths = [split_spec(spec)[0] for spec in self.specs]
        if not all(map(can_hold_a_solid, paths)) or not can_hold_a_solid(out, written=True):
            raise OptionError(
                f"--from and --to: found {', '.join(paths)} and {out}, expected STEP, IGES or BREP files and one of "
                "STEP or BREP to write: no solid can come back otherwise"
            )


@dataclass(frozen=True)
class SolidOutputs:
    """What is written of a solid: the file, a report, a folder of pictures."""

    out: str
    report: str | None
    plots: str | None

    @property
    def suffix(self) -> str:
        """Of the file."""
        return Path(self.out).suffix.lower()


def write_joined(wanted: WantedJoin, outputs: SolidOutputs, options: BlendOptions, split: Split) -> None:
    """Write the joined solid, the report and the picture: all or none."""
    from semispline.solver.topology import joined_solid

    _check(outputs)
    with progress("blending"):
        found = joined_solid(wanted.specs, outputs.suffix, options, split)
    _write(found, outputs)


def write_rounded(wanted: WantedEdge, outputs: SolidOutputs, options: BlendOptions) -> None:
    """Write the solid with its edge rounded, the report and the picture: all or none."""
    from semispline.solver.topology import solid_with_round

    _check(outputs)
    cut = repr(wanted.distance)
    with progress("blending"):
        found = solid_with_round(wanted.path, *wanted.names, (cut, cut), outputs.suffix, options)
    _write(found, outputs)


def write_solid(
    wanted: WantedBases,
    sharp: tuple[str, int, str] | None,
    outputs: SolidOutputs,
    options: BlendOptions,
    *,
    keep_ends: bool,
) -> None:
    """Write the solid with faces replaced, or with a sharp edge rounded; the report and the picture: all or none."""
    from semispline.solver.topology import solid_with_blend, solid_with_round

    _check(outputs)
    with progress("blending"):
        if sharp is not None:
            cut_a, cut_b = wanted.cuts
            assert cut_a is not None
            assert cut_b is not None
            title = f"--cut-a {cut_a} --cut-b {cut_b} from edge {sharp[2]} of face {sharp[1]}"
            found = solid_with_round(*sharp, (cut_a, cut_b), outputs.suffix, options, title)
        else:
            assert wanted.replaced is not None
            found = solid_with_blend(
                wanted.a,
                wanted.replaced,
                outputs.suffix,
                options,
                wanted.edge_a,
                wanted.edge_b,
                keep_ends=keep_ends,
            )
    _write(found, outputs)


def _check(outputs: SolidOutputs) -> None:
    if outputs.plots is not None:
        check_solid_picture(outputs.plots)


def _write(found: SolidBlend, outputs: SolidOutputs) -> None:
    from semispline.solver.io import atomic_path, to_text, write_files
    from semispline.solver.topology import contacts_in_solid

    orders = int(found.blend.continuity[0][1]), int(found.blend.continuity[1][1])
    with TemporaryDirectory() as folder:
        written = Path(folder, f"solid{outputs.suffix}")
        written.write_bytes(found.content)
        with progress("measuring"):
            contacts = contacts_in_solid(written, found.faces, orders, [end.range for end in found.kept])
        pictures = {} if outputs.plots is None else {"solid.png": solid_picture(written, found.faces)}
    with ExitStack() as stack:
        # Each lies in its temporary file before the first takes its place.
        if outputs.report is not None:
            record = reports_record([found.blend]) | found.record()
            record["contacts_in_solid"] = [contact.record() for contact in contacts]
            stack.enter_context(atomic_path(outputs.report)).write_text(to_text(record))
        stack.enter_context(atomic_path(outputs.out)).write_bytes(found.content)
        if outputs.plots is not None:
            write_files(outputs.plots, pictures)
    _print(found)
    print_contacts(contacts)
    if found.kept:
        typer.echo("the blend along its whole contacts, with the ends that were kept, where contact is G1 alone:")
    print_result(found.blend)


def write_added(
    spec: str, out: str, surfaces: Sequence[Surface], report: str | None, record: Mapping[str, Any]
) -> None:
    """Write a 3dm file with surfaces added to it on the layer of a face, and the report: both or none."""
    from semispline.solver.io import atomic_path, split_spec, to_text, with_surfaces
    from semispline.solver.splines import SemiStructuredSurface

    path, number = split_spec(spec)
    splines = [x.to_bspline() if isinstance(x, SemiStructuredSurface) else x for x in surfaces]
    content = with_surfaces(path, number or 0, splines)
    with ExitStack() as stack:
        if report is not None:
            stack.enter_context(atomic_path(report)).write_text(to_text(record))
        stack.enter_context(atomic_path(out)).write_bytes(content)


def no_solid(path: str, out: str, *, added: bool = False) -> str:
    """Say why a face was replaced, or an edge cut, and no solid came back."""
    from semispline.solver.topology import can_hold_a_solid

    which = out if can_hold_a_solid(path) else path
    where = f"{'in' if which == out else 'from'} {Path(which).suffix.lower() or which}"
    what = "the blend is written as a surface"
    if added:
        what = "the blend and its bases are added to the file as surfaces, on the layer of A"
    return f"no solid can come back {where}: {what}; STEP and BREP hold solids"


def _print(found: SolidBlend) -> None:
    report = found.gate
    had, has = report.volume
    kind = "solid" if report.solids[1] else "shell"
    count = report.solids[1] or report.shells[1] or 1
    typer.echo(found.said)
    typer.echo(
        f"{f'one sound {kind}' if count == 1 else f'{count} sound {kind}s'} of {report.faces[1]} faces: "
        f"{_blends(found.faces)}, {', '.join(map(str, found.touched))} have new borders, all else is as it was"
    )
    about = f"{report.volume_expected:.4g}, give or take" if report.volume_expected else "at most"
    typer.echo(f"volume {had:.9g} -> {has:.9g}, by {has - had:.4g} of {about} {report.volume_limit:.4g}")
    were = [edge.was for edge in report.border if edge.was is not None]
    before = f"{max(were):.2g} -> " if were else ""
    typer.echo(
        f"largest tolerance at the blend {before}{report.largest_tolerance:.2g}, read back "
        f"{found.read_back.largest_tolerance:.2g}; largest gap {max(edge.gap for edge in report.border):.2g}; of all "
        f"edges {report.tolerance[0]:.2g} -> {report.tolerance[1]:.2g}, read back {found.read_back.tolerance[1]:.2g}"
    )
    for note in found.notes:
        typer.echo(note)


def _blends(faces: tuple[int, ...]) -> str:
    return f"{faces[0]} is the blend" if len(faces) == 1 else f"{', '.join(map(str, faces))} are the blend"


def print_contacts(contacts: Sequence[SolidContact]) -> None:
    """Print how the new faces meet the others, measured on these as they stand in the solid."""
    rows = [("edge", "on face", "gap", "angle, degrees", "curvature jump", "rate jump", "where")]
    for x in contacts:
        found = x.contact
        rate = "" if found.rate_jump_relative is None else f"{found.rate_jump_relative:.2g}"
        figures = (f"{found.gap:.2g}", f"{found.angle_degrees:.2g}", f"{found.curvature_jump_relative:.2g}", rate)
        where = ""
        if x.stretch:
            place = found.at["curvature_jump_relative"].point
            where = "{}: G1, the jump at ({:.6g}, {:.6g}, {:.6g})".format(x.stretch, *place)
        rows.append((x.edge, str(x.face), *figures, where))
    typer.echo("contacts of the blend as it stands in the solid, measured on the faces themselves:")
    shown = [k for k in range(len(rows[0])) if any(row[k] for row in rows[1:])]
    print_table([tuple(row[k] for k in shown) for row in rows])
    if any(x.stretch for x in contacts):
        typer.echo(
            "curvature jumps are over the largest curvature of the face there; a flat one counts as bent with a radius "
            "of a thousand times its size"
        )
