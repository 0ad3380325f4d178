"""The outlines of two planar faces joined by a blend: of two solids one valid solid."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from semispline.solver.blending import BlendResult, Split, faces_of_blend
from semispline.solver.errors import ComputationError, EdgeError, FileError
from semispline.solver.io import check_outputs, split_spec, write_bytes
from semispline.solver.options import BlendOptions, named_options
from semispline.solver.splines import reverse_u
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
    made = _blended(ends, options)
    result = made.result
    surfaces = tuple(as_spline(one) for one in faces_of_blend(result, split))
    if made.turned:
        surfaces = tuple(map(reverse_u, surfaces))
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
        notes=(*made.notes, *notes_of(outcome)),
        content=outcome.content,
    )


def _named(spec: str, name: str) -> tuple[str, int]:
    path, number = split_spec(spec)
    if number is None:
        raise FileError(f"{name}: found {spec!r}, expected a file and the number of its face, as part.step#12")
    return path, number


@dataclass(frozen=True, eq=False)
class _Blended:
    """A blend of both outlines; `turned` where a of it is the second one."""

    result: BlendResult
    turned: bool = False
    notes: tuple[str, ...] = ()


def _blended(ends: list[Resolved], options: BlendOptions) -> _Blended:
    """Return the fairer one of the blends from the first outline to the second and back.

    What faces what is told from the first, and the fairest shape is sought from there: where the outlines are of
    different kinds the other order gives another blend, and which was named first is to be no matter. What is asked
    along v is meant along the first.
    """
    (a,), (b,) = _single(close_bases(ends, options.continuities), ends)
    found: list[_Blended] = []
    errors: list[ComputationError] = []
    along_v = not isinstance(options.middle_knots, str | None) or any(isinstance(x, tuple) for x in options.alphas)
    for turned in (False,) if along_v else (False, True):
        try:
            result = blend_bases(b, a, _turned(options)) if turned else blend_bases(a, b, options)
            found.append(_Blended(result, turned))
        except ComputationError as error:
            errors.append(error)
    if not found:
        raise errors[0]
    best = min(found, key=lambda x: (bool(x.result.warnings), x.result.shape.fairness.value))
    if not best.turned:
        return best
    why = "the other does not do" if errors else "that is the fairer order"
    return replace(best, notes=(f"A is the outline of {NAMES[1]}, B that of {NAMES[0]}: {why}",))


def _turned(options: BlendOptions) -> BlendOptions:
    """Return what is asked of b at a, and the other way round."""
    both: dict[str, Any] = {"continuity": options.continuities[::-1], "bulge": options.bulges[::-1]}
    if options.alpha is not None:
        both["alpha"] = options.alphas[::-1]
    if not isinstance(options.p2, str):
        both["p2"] = options.p2[::-1]
    if not isinstance(options.match, str):
        both["match"] = tuple(pair[::-1] for pair in options.match)
    if options.u_knots is not None:
        both["u_knots"] = tuple(1 - x for x in options.u_knots[::-1])
    return replace(options, **both)


def _single(sides: list[Any], ends: list[Resolved]) -> list[Any]:
    for side, end, name in zip(sides, ends, NAMES, strict=True):
        if len(side) != 1:
            raise EdgeError(f"{name}: along {end.edge} of {end.spec} no one blend runs, it has {len(side)} parts")
    return sides
