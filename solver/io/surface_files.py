"""One way in and out for surfaces of every file format.

The module of a format waits inside the functions until a file of that format is named.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from warnings import warn

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError, TrimError
from semispline.solver.io.disk import atomic_path, check_output, require_file, shown
from semispline.solver.io.face_boundary import FaceBoundary, edge_offset
from semispline.solver.io.faces import MILLIMETRES, Face, Model, SurfaceEntry, describe, picked, without_equal_weights
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface, Surface

OCC_SUFFIXES = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
_READABLE = (".json", *OCC_SUFFIXES, ".3dm")
_MESHES = (".obj", ".stl", ".ply", ".gltf", ".glb")
_WRITABLE = (*_READABLE, *_MESHES)
_SEVERAL = (*OCC_SUFFIXES, ".3dm", *_MESHES)
# Formats that name a unit get this one for a surface whose own is not known.
_DEFAULT_UNIT = "mm"
# What writing and reading back may change: rounding of a few products (weights, units of length).
_ROUNDING = 16 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True, eq=False)
class LoadedSurface:
    """A surface as a file holds it.

    Attributes
    ----------
    surface : BSplineSurface or SemiStructuredSurface
    unit : str or None
        Of the coordinates, a key of `MILLIMETRES`; None where the file does not say.
    boundary : FaceBoundary or None
        The edges of the face that the file cuts out of it; None where that is the whole surface.
    kind : str
        What the file holds.
    deviation : float or None
        Where that has no exact B-spline form: how far `surface` is from it at the worst place that was found.
    """

    surface: Surface
    unit: str | None
    boundary: FaceBoundary | None = None
    kind: str = ""
    deviation: float | None = None


def read_surface(spec: str | Path) -> Surface:
    """Read a surface from a file.

    Parameters
    ----------
    spec : str
        PATH, or PATH#N where the file holds more than one surface; N as `list_surfaces` numbers them. Formats by
        suffix: .json, .step, .stp, .iges, .igs, .brep, .brp, .3dm.

    Returns
    -------
    BSplineSurface or SemiStructuredSurface
        The whole surface, without trimming, in the unit of the file. Unclamped and periodic ones are clamped, planes,
        cylinders and the like converted, all exactly.

    Warns
    -----
    UserWarning
        It has no exact B-spline form, as most offsets, and was approximated: by how much.

    Raises
    ------
    FileError
        Missing, broken, no such number, several surfaces and no number, or no B-spline form.
    KnotError, ControlPointError
        Values that make no surface.
    """
    (loaded,) = read_surfaces([spec])
    approximated = approximation_warning(spec, loaded)
    if approximated:
        warn(approximated, stacklevel=2)
    return loaded.surface


def read_surfaces(specs: Sequence[str | Path]) -> list[LoadedSurface]:
    """Read several surfaces, each file once; all in the unit of the first that names one.

    Raises
    ------
    FileError, KnotError, ControlPointError
        As `read_surface`.
    """
    wanted = [split_spec(spec) for spec in specs]
    models: dict[str, Model] = {}
    loaded = []
    for path, number in wanted:
        if path not in models:
            # Without a number there is but one face, or none will be picked.
            models[path] = open_model(path, sorted({n or 0 for other, n in wanted if other == path}))
        model = models[path]
        face = picked(model, number)
        loaded.append(_loaded(face, model.unit, face.boundary()))
    return in_one_unit(loaded)


def _loaded(face: Face, unit: str | None, boundary: FaceBoundary | None = None) -> LoadedSurface:
    return LoadedSurface(face.surface(), unit, boundary, face.kind, face.deviation())


def approximation_warning(spec: str | Path, loaded: LoadedSurface) -> str | None:
    """Return a warning where a surface is not exactly what its file holds.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> approximation_warning("a.step#2", LoadedSurface(square, "mm", kind="offset", deviation=4.123e-6))
    'a.step#2 (offset) has no exact B-spline form: the surface taken for it is about 4.12e-06 mm off at worst'
    """
    if loaded.deviation is None:
        return None
    off = f"about {loaded.deviation:.3g} {loaded.unit or 'model units'} off at worst"
    return f"{spec} ({loaded.kind}) has no exact B-spline form: the surface taken for it is {off}"


def trimmed_edge_warning(spec: str | Path, edge: str, loaded: LoadedSurface) -> str | None:
    """Return a warning where a natural edge of a surface is not an edge of its face.

    Parameters
    ----------
    spec : str
        What the user calls the surface.
    edge : str
        As `Base` takes it.
    loaded : LoadedSurface
        As `read_surfaces` returned it.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> trimmed_edge_warning("square.json", "u1", LoadedSurface(square, None)) is None
    True
    """
    if loaded.boundary is None:
        return None
    if not len(loaded.boundary.pieces):
        return (
            f"whether the edge {edge} of {spec} is an edge of the face cannot be told: its own boundary is unreadable"
        )
    offset = edge_offset(loaded.surface, edge, loaded.boundary)
    if not offset.distance:
        return None
    unit = loaded.unit or "model units"
    part = "in part, by up to" if offset.in_part else "up to"
    if "=" in edge:
        # A line of constant parameter may run through the face.
        return (
            f"the edge {edge} of {spec} is no edge of the face, {part} {offset.distance:.3g} {unit} from the face's "
            f"own boundary: it runs through the face, or beyond it; {_listing(spec)} names its own edges"
        )
    return (
        f"the edge {edge} of {spec} lies outside of the face, {part} {offset.distance:.3g} {unit} from the face's own "
        f"boundary: the face is trimmed, its surface goes on; {_listing(spec)} names its own edges"
    )


def _listing(spec: str | Path) -> str:
    path, number = split_spec(spec)
    return f"`semispline list {path} --edges {number or 0}`"


def face_warnings(*edges: tuple[str | Path, str, LoadedSurface], strict: bool = False) -> tuple[str, ...]:
    """Return the warnings of edges, each given as to `trimmed_edge_warning`, and of the surfaces that they belong to.

    Raises
    ------
    TrimError
        There are some, and `strict` allows none.
    """
    surfaces = dict.fromkeys(warning for spec, _, loaded in edges if (warning := approximation_warning(spec, loaded)))
    trims = [warning for edge in edges if (warning := trimmed_edge_warning(*edge))]
    found = (*surfaces, *trims)
    if strict and found:
        remedy = "name one of its own edges, give the untrimmed surface, or leave out strict"
        if not trims:
            remedy = "make the face a B-spline where it was drawn, or leave out strict"
        raise TrimError(f"{'; '.join(found)}; {remedy}")
    return found


def in_one_unit(loaded: Sequence[LoadedSurface]) -> list[LoadedSurface]:
    """Return the surfaces in the unit of the first that names one; those that name none are taken as they are.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> in_one_unit([LoadedSurface(square, "mm"), LoadedSurface(square, "in")])[1].surface.evaluate([1], [1])
    array([[25.4, 25.4,  0. ]])
    """
    unit = next((item.unit for item in loaded if item.unit), None)
    if unit is None:
        return list(loaded)
    same = []
    for item in loaded:
        factor = MILLIMETRES[item.unit or unit] / MILLIMETRES[unit]
        if factor == 1:
            same.append(replace(item, unit=unit))
            continue
        boundary = None if item.boundary is None else item.boundary.scaled(factor)
        deviation = None if item.deviation is None else item.deviation * factor
        surface = _scaled(item.surface, factor)
        same.append(replace(item, surface=surface, unit=unit, boundary=boundary, deviation=deviation))
    return same


def list_surfaces(path: str | Path) -> list[SurfaceEntry]:
    """Return what a file holds: every face, in order, of whatever kind.

    Raises
    ------
    FileError
        Missing, broken, or of an unknown format.
    """
    return list_file(path)[0]


def list_file(path: str | Path) -> tuple[list[SurfaceEntry], Mapping[str, int]]:
    """Return every surface of a file, and what else it holds, from which no surface is taken: kind -> how many.

    Raises
    ------
    FileError
        As `list_surfaces`.
    """
    model = open_model(path)
    return [describe(number, face) for number, face in enumerate(model.faces)], model.others


def write_surface(path: str | Path, surface: Surface, unit: str | None = None) -> None:
    """Write a surface, whole or not at all, in the format of the suffix.

    Parameters
    ----------
    path : str or Path
        .json keeps a semi-structured surface as it is; .step, .stp, .iges, .igs, .brep, .brp and .3dm hold its exact
        B-spline form; .obj, .stl, .ply, .gltf and .glb a mesh of samples.
    surface : BSplineSurface or SemiStructuredSurface
    unit : str, optional
        Unit of the coordinates, a key of `MILLIMETRES`; millimetres where the format names one and this does not.

    Raises
    ------
    FileError
        Unknown suffix, the file cannot be written, the format cannot hold the surface (what was written is read back
        and compared), or an extra that is not installed.
    """
    write_surfaces(path, [surface], unit)


def write_surfaces(path: str | Path, surfaces: Sequence[Surface], unit: str | None = None) -> None:
    """Write some surfaces into one file, in their order, as `write_surface` does one; of .json there can be one only.

    Raises
    ------
    FileError
        As `write_surface`.
    """
    suffix = check_surface_output(path, len(surfaces))
    if suffix == ".json":
        from semispline.solver.io.json_files import write_json_surface

        write_json_surface(path, surfaces[0])
        return
    with atomic_path(path) as temporary:
        if suffix in _MESHES:
            from semispline.solver.io.meshes import write_mesh

            write_mesh(temporary, surfaces)
            return
        splines = [x.to_bspline() if isinstance(x, SemiStructuredSurface) else x for x in surfaces]
        if suffix == ".3dm":
            from semispline.solver.io.rhino import write_3dm

            write_3dm(temporary, splines, unit or _DEFAULT_UNIT)
        else:
            from semispline.solver.io.occ_writing import occ_bytes

            temporary.write_bytes(occ_bytes(splines, suffix, unit or _DEFAULT_UNIT))
        _check_written(temporary, splines, str(path))


def check_surface_output(path: str | Path, count: int = 1) -> str:
    """Return the suffix if so many surfaces can be written to `path`; long work calls this first.

    Raises
    ------
    FileError
        Unknown suffix, no such folder, or no right to write.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in _WRITABLE:
        raise FileError(
            f"{shown(path)}: suffix {shown(suffix)!r} cannot be written, expected one of {' '.join(_WRITABLE)}"
        )
    if suffix == ".json" and count > 1:
        raise FileError(f"{shown(path)}: .json holds one surface, expected {' '.join(_SEVERAL)} for {count}")
    check_output(path)
    return suffix


def open_model(path: str | Path, bounded: Sequence[int] = ()) -> Model:
    """Open a file of any readable format; `bounded` are the numbers of the faces whose boundaries are wanted.

    Raises
    ------
    FileError
        Missing, broken, or of an unknown format.
    KnotError, ControlPointError
        A JSON file whose values make no surface.
    """
    require_file(path)
    suffix = Path(path).suffix.lower()
    reader = _reader(suffix)
    if reader is None:
        raise FileError(
            f"{shown(path)}: suffix {shown(suffix)!r} cannot be read, expected one of {' '.join(_READABLE)}"
        )
    return reader(path, bounded)


def split_spec(spec: str | Path) -> tuple[str, int | None]:
    """Split PATH#N; a file whose whole name is `spec` wins.

    Raises
    ------
    FileError
        What follows # is not a number from 0 on.

    Examples
    --------
    >>> split_spec("parts.step#12"), split_spec("parts.step")
    (('parts.step', 12), ('parts.step', None))
    """
    text = str(spec)
    path, separator, number = text.rpartition("#")
    if not separator or _exists(text):
        return text, None
    if not re.fullmatch("[0-9]{1,9}", number):
        raise FileError(f"{text}: found {number!r} after #, expected the number of a surface, from 0")
    return path, int(number)


@dataclass(frozen=True, eq=False)
class _JsonFace:
    content: Surface

    @property
    def kind(self) -> str:
        return "B-spline" if isinstance(self.content, BSplineSurface) else "semi-structured"

    def trimmed(self) -> bool:
        return False

    def boundary(self) -> None:
        return None

    def deviation(self) -> None:
        return None

    def surface(self) -> Surface:
        return self.content


def _open_json(path: str | Path, bounded: Sequence[int]) -> Model:
    from semispline.solver.io.json_files import read_json_surface

    return Model(str(path), None, [_JsonFace(read_json_surface(path))])


def relative_spec(spec: str, target: str | Path) -> str:
    """Return PATH or PATH#N as a problem file that is written to `target` holds it: relative to its folder.

    Examples
    --------
    >>> relative_spec("parts/a.step#3", "problems/p.json")
    '../parts/a.step#3'
    """
    path, number = split_spec(spec)
    relative = Path(os.path.relpath(path, Path(target).parent)).as_posix()
    return relative if number is None else f"{relative}#{number}"


def _reader(suffix: str) -> Callable[[str | Path, Sequence[int]], Model] | None:
    if suffix == ".json":
        return _open_json
    if suffix == ".3dm":
        from semispline.solver.io.rhino import open_3dm

        return open_3dm
    if suffix in OCC_SUFFIXES:
        from semispline.solver.io.occ import open_occ

        return open_occ
    return None


def _exists(path: str) -> bool:
    try:
        return Path(path).exists()
    except (OSError, ValueError):
        return False


def _scaled(surface: Surface, factor: float) -> Surface:
    if isinstance(surface, BSplineSurface):
        return replace(surface, control_points=surface.control_points * factor)
    curves = (replace(c, control_points=c.control_points * factor) for c in surface.control_curves)
    return replace(surface, control_curves=tuple(curves))


def _check_written(written: Path, surfaces: Sequence[BSplineSurface], where: str) -> None:
    """Read a CAD file back: kernels drop or merge what is small against their tolerances, and do not say so."""
    from semispline.solver.io.occ import read_occ
    from semispline.solver.io.rhino import read_3dm

    try:
        # What this process wrote, it can read without a process of its own.
        read = read_occ if written.suffix.lower() in OCC_SUFFIXES else read_3dm
        found = [face.surface() for face in read(written).faces]
        same = len(found) == len(surfaces) and all(
            isinstance(one, BSplineSurface) and _agree(one, other) for one, other in zip(found, surfaces, strict=True)
        )
    except FileError:
        same = False
    if not same:
        raise FileError(
            f"{where}: {written.suffix[1:]} cannot hold this surface exactly (read back, it differs); "
            "write .json, or a unit of length in which it is larger"
        )


def _agree(a: BSplineSurface, b: BSplineSurface) -> bool:
    def weights(surface: BSplineSurface) -> FloatArray:
        found = None if surface.weights is None else without_equal_weights(surface.weights)
        return np.ones(surface.control_points.shape[:2]) if found is None else found

    if (a.degree_u, a.degree_v) != (b.degree_u, b.degree_v):
        return False
    pairs = [(a.knots_u, b.knots_u), (a.knots_v, b.knots_v), (a.control_points, b.control_points)]
    pairs.append((weights(a), weights(b)))
    return all(x.shape == y.shape and np.abs(x - y).max() <= _ROUNDING * np.abs(y).max() for x, y in pairs)
