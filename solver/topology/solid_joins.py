"""The outlines of two planar faces joined by a blend: of two solids one valid solid."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from semispline.solver.blending import BlendResult, Split, faces_of_blend
from semispline.solver.errors import EdgeError, FileError
from semispline.solver.io import check_outputs, split_spec, write_bytes
from semispline.solver.options import BlendOptions, named_options
from semispline.solver.topology.caps import outline_of
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.end_faces import as_spline
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.resolving import Resolved, resolve_edges
from semispline.solver.topology.solid_blends import SolidBlend, check_suffixes, close_bases, notes_of, operated
from semispline.solver.topology.solid_orders import Joining

NAMES = ("--from", "--to")


def join_faces(
    a: str | Path,
    b: str | Path,
    out: str | Path,
    options: BlendOptions | None = None,
    *,
    split: Split = "corners",
    **named: Any,
) -> SolidBlend:
    """Join the outlines of two planar faces by a blend, and write the one solid that comes of it.

    Both faces are taken out. All others stay as they are; the blend begins on the walls around the first face and ends
    on those around the second.

    Parameters
    ----------
    a, b : str
        "PATH#N" of each face, at the end of a solid of a STEP, IGES or BREP file; of one file or of two.
    out : str or Path
        A STEP or BREP file, in the unit of the first.
    options : BlendOptions, optional
        Or its fields by name, as `blend` has them.
    split : {"corners", "joints"}
        Where the blend is cut into faces, as `faces_of_blend` has it.

    Raises
    ------
    SolidError
        The result is not sound, and nothing was written: why, and where.
    EdgeError
        A face is no planar one with one outline at the end of a solid; the outlines cannot be blended.
    BandError, ContactError, FoldError, OptionError, ComputationError, FileError
        As `blend_edges`.
    """
    paths = [split_spec(spec)[0] for spec in (a, b)]
    for path in paths:
        check_suffixes(path, out)
    check_outputs({"out": out}, paths)
    found = joined_solid((str(a), str(b)), Path(out).suffix.lower(), named_options(options, named), split)
    write_bytes(out, found.content)
    return found


def joined_solid(specs: tuple[str, str], suffix: str, options: BlendOptions, split: Split = "corners") -> SolidBlend:
    """Return what `join_faces` writes, in the format of a suffix; its errors."""
    (path, face), (other, beyond) = (_named(spec, name) for spec, name in zip(specs, NAMES, strict=True))
    is_same = Path(path).resolve() == Path(other).resolve()
    if is_same and face == beyond:
        raise EdgeError(f"--to: found {specs[1]!r} as at --from, expected another face")
    paths = path, path if is_same else other
    measured = {name: measured_edges(name) for name in dict.fromkeys(paths)}
    words = [
        outline_of(measured[name].graph, number, said)
        for name, number, said in zip(paths, (face, beyond), NAMES, strict=True)
    ]
    ends = resolve_edges(list(zip(paths, words, strict=True)), NAMES, measured)
    result = _blended(ends, options)
    surfaces = tuple(as_spline(one) for one in faces_of_blend(result, split))
    order = Joining(face, None if is_same else other, beyond, surfaces)
    outcome = operated(path, order, suffix, f"--from {specs[0]} --to {specs[1]}")
    assert outcome.content is not None
    assert outcome.read_back is not None
    counts = [word.count("+") + 1 for word in words]
    return SolidBlend(
        blend=result,
        said=f"outline of {specs[0]} ({counts[0]} edges) joined to that of {specs[1]} ({counts[1]} edges)",
        faces=outcome.new,
        gate=outcome.report,
        read_back=outcome.read_back,
        touched=outcome.touched,
        notes=notes_of(outcome),
        content=outcome.content,
    )


def _named(spec: str, name: str) -> tuple[str, int]:
    path, number = split_spec(spec)
    if number is None:
        raise FileError(f"{name}: found {spec!r}, expected a file and the number of its face, as part.step#12")
    return path, number


def _blended(ends: list[Resolved], options: BlendOptions) -> BlendResult:
    (a,), (b,) = _single(close_bases(ends, options.continuities), ends)
    return blend_bases(a, b, options)


def _single(sides: list[Any], ends: list[Resolved]) -> list[Any]:
    for side, end, name in zip(sides, ends, NAMES, strict=True):
        if len(side) != 1:
            raise EdgeError(f"{name}: along {end.edge} of {end.spec} no one blend runs, it has {len(side)} parts")
    return sides
