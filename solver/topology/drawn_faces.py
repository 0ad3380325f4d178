"""Surfaces of files as they are drawn: trimmed where the file trims them, with the names of their edges."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from semispline.solver.errors import FileError, InputError
from semispline.solver.io import (
    MILLIMETRES,
    OCC_SUFFIXES,
    LoadedSurface,
    RhinoFace,
    in_one_unit,
    open_3dm,
    read_apart,
    read_surfaces,
    require_file,
    require_kernel,
    split_spec,
    without_surfaces,
)
from semispline.solver.splines import BSplineSurface, Surface
from semispline.solver.topology.face_meshes import EdgeLine, FaceMesh
from semispline.solver.topology.rhino_meshes import edge_lines_of, mesh_of

# Points of a natural edge in each span, and at the least.
_PER_SPAN, _LEAST = 8, 120


@dataclass(frozen=True, eq=False)
class DrawnFace:
    """A surface of a file as it is drawn.

    Attributes
    ----------
    spec : str
        PATH, or PATH#N where the file holds more than one.
    loaded : LoadedSurface
        The whole surface.
    mesh : FaceMesh or None
        The face; None where that is the whole surface, or where it is drawn so.
    edges : tuple of EdgeLine
        Those of the face, e0, e1, ..; the natural edges u0, u1, v0, v1 where the file has none.
    """

    spec: str
    loaded: LoadedSurface
    mesh: FaceMesh | None
    edges: tuple[EdgeLine, ...]

    @property
    def surface(self) -> Surface:
        """The whole surface."""
        return self.loaded.surface

    @property
    def path(self) -> str:
        """The file."""
        return split_spec(self.spec)[0]

    @property
    def number(self) -> int | None:
        """N of `PATH#N`."""
        return split_spec(self.spec)[1]


def read_drawn(specs: Sequence[str]) -> tuple[list[DrawnFace], list[str]]:
    """Read, of each file, the surface PATH#N or, without a number, all surfaces; all in one unit.

    Returns
    -------
    list of DrawnFace
    list of str
        Why faces of a file without a number were left out, and which ones are drawn without their trims.

    Raises
    ------
    FileError, KnotError, ControlPointError
        As `read_surface`; also where no face of a file can be read out.
    ComputationError
        The process that read the file was killed.
    """
    wanted = [split_spec(spec) for spec in specs]
    found: list[DrawnFace] = []
    said: list[str] = []
    for path in dict.fromkeys(path for path, _ in wanted):
        numbers = [number for other, number in wanted if other == path]
        whole = None in numbers
        for item in _faces_of(path, None if whole else sorted({n for n in numbers if n is not None}), said):
            if isinstance(item, DrawnFace):
                found.append(item)
            elif whole:
                said.append(f"left out: {item}")
            else:
                raise item
        if not any(split_spec(item.spec)[0] == path for item in found):
            raise FileError(f"{path}: none of its surfaces can be used; the first: {said[-1]}")
    return _in_one_unit(found), said


def read_true_face(spec: str, others: Sequence[LoadedSurface] = ()) -> DrawnFace:
    """Read one face with its border, in the unit of others.

    Raises
    ------
    FileError, KnotError, ControlPointError, ComputationError
        As `read_surfaces` and `read_drawn`.
    """
    (loaded,) = read_surfaces([spec])
    (face,), _ = read_drawn([spec])
    return replace(face, loaded=in_one_unit([*others, loaded])[-1])


def _in_one_unit(faces: Sequence[DrawnFace]) -> list[DrawnFace]:
    same = []
    for face, loaded in zip(faces, in_one_unit([face.loaded for face in faces]), strict=True):
        unit = loaded.unit or "mm"
        factor = MILLIMETRES[face.loaded.unit or unit] / MILLIMETRES[unit]
        edges = face.edges if factor == 1 else tuple(edge.scaled(factor) for edge in face.edges)
        same.append(replace(face, loaded=loaded, edges=edges))
    return same


def _faces_of(path: str, numbers: Sequence[int] | None, said: list[str]) -> Iterator[DrawnFace | InputError]:
    """Yield some or all faces of a file; `said` grows by what is drawn without its trims."""
    require_file(path)
    suffix = Path(path).suffix.lower()
    if suffix in OCC_SUFFIXES:
        yield from _of_occ(path, numbers, said)
    elif suffix == ".3dm":
        yield from _of_3dm(path, numbers, said)
    else:
        spec = path if numbers is None else f"{path}#{numbers[0]}"
        (loaded,) = read_surfaces([spec])
        yield DrawnFace(path, loaded, None, natural_edges(loaded.surface))


def _of_occ(path: str, numbers: Sequence[int] | None, said: list[str]) -> Iterator[DrawnFace | InputError]:
    require_kernel(path)
    chosen = [] if numbers is None else [str(n) for n in numbers]

    def read(how: str) -> Any:
        return read_apart(path, "semispline.solver.topology.occ_meshes", "Open CASCADE", [how, *chosen])

    try:
        unit, count, others, faces = read("trimmed")
    except FileError as error:
        # Perhaps it is the mesher that broke down.
        unit, count, others, faces = read("whole")
        said.append(f"{path}: drawn without the trims of its faces, which cannot be meshed ({error})")
    _check_numbers(path, numbers, count, others)
    for n, kind, content, off, mesh, edges in faces:
        if isinstance(content, InputError):
            yield content
            continue
        surface = BSplineSurface(*content)
        if mesh is None and not any(text.startswith(f"{path}: drawn without") for text in said):
            said.append(f"{path}#{n}: drawn without its trims: Open CASCADE has no triangles for it")
        spec = path if count == 1 else f"{path}#{n}"
        yield DrawnFace(spec, LoadedSurface(surface, unit, None, kind, off), mesh, edges or natural_edges(surface))


def _of_3dm(path: str, numbers: Sequence[int] | None, said: list[str]) -> Iterator[DrawnFace | InputError]:
    model = open_3dm(path)
    _check_numbers(path, numbers, len(model.faces), model.others)
    for n in range(len(model.faces)) if numbers is None else numbers:
        face = model.faces[n]
        assert isinstance(face, RhinoFace)
        try:
            surface, trimmed = face.surface(), face.trimmed()
            mesh = mesh_of(face) if trimmed else None
        except InputError as error:
            yield error
            continue
        if trimmed is not False and mesh is None:
            said.append(f"{path}#{n}: drawn without its trims: its edges are not found on its surface")
        spec = path if len(model.faces) == 1 else f"{path}#{n}"
        edges = edge_lines_of(face) or natural_edges(surface)
        yield DrawnFace(spec, LoadedSurface(surface, model.unit, None, face.kind), mesh, edges)


def _check_numbers(path: str, numbers: Sequence[int] | None, count: int, others: Mapping[str, int]) -> None:
    if not count:
        raise FileError(f"{path}: holds {without_surfaces(others)}")
    for number in numbers or ():
        if number >= count:
            raise FileError(f"{path}#{number}: no such surface; the file holds {count}, numbered 0 to {count - 1}")


def natural_edges(surface: Surface) -> tuple[EdgeLine, ...]:
    """Return the edges u0, u1, v0 and v1 of a surface; those that are points are left out."""
    lines = []
    for name in ("u0", "u1", "v0", "v1"):
        across = 0 if name[0] == "u" else 1
        breaks = surface.breakpoints[1 - across]
        each = max(_PER_SPAN, -(-_LEAST // (len(breaks) - 1)))
        along = np.interp(np.arange(each * (len(breaks) - 1) + 1) / each, np.arange(len(breaks)), breaks)
        line = np.full_like(along, surface.domain[across][int(name[1])])
        points = surface.evaluate(*((line, along) if across == 0 else (along, line)))
        if np.ptp(points, axis=0).max() > 0:
            lines.append(EdgeLine(name, points))
    return tuple(lines)
