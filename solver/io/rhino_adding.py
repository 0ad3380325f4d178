"""Surfaces added to a 3dm file that is there, on the layer of one of its faces; all else stays as it was."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from semispline.solver.errors import FileError
from semispline.solver.io.foreign import read_apart
from semispline.solver.io.rhino import nurbs_surface
from semispline.solver.splines import BSplineSurface


def with_surfaces(path: str | Path, face: int, surfaces: Sequence[BSplineSurface]) -> bytes:
    """Return a 3dm file with more surfaces in it; a process of its own reads and writes.

    Parameters
    ----------
    path : str or Path
    face : int
        N of `PATH#N`: on the layer of its object they come.
    surfaces : sequence of BSplineSurface
        In the unit of the file.

    Raises
    ------
    FileError, ComputationError
        As `open_3dm`; openNURBS could not write it.
    """
    with TemporaryDirectory() as folder:
        order = Path(folder, "order")
        order.write_bytes(pickle.dumps((face, list(surfaces))))
        return bytes(read_apart(path, "semispline.solver.io.rhino_adding", "openNURBS", [str(order)]))


def work(path: str, order: str) -> bytes:
    """Return the file with more surfaces; `order` is a file of our own with a face and the surfaces."""
    import rhino3dm

    face, surfaces = pickle.loads(Path(order).read_bytes())
    file: Any = rhino3dm.File3dm.Read(path)
    if file is None:
        raise FileError(f"{path}: openNURBS cannot read it")
    attributes: Any = rhino3dm.ObjectAttributes()
    attributes.LayerIndex = _layer(rhino3dm, file, face)
    for surface in surfaces:
        file.Objects.AddSurface(nurbs_surface(rhino3dm, surface), attributes)
    with TemporaryDirectory() as folder:
        target = Path(folder, "written.3dm")
        if not file.Write(str(target), 0):
            raise FileError("3dm: openNURBS could not write the file; check the disk, or try .json or .step")
        return target.read_bytes()


def _layer(rhino3dm: Any, file: Any, face: int) -> int:
    """Return the layer of the object that a face belongs to; faces are numbered as `rhino_worker` does."""
    first = 0
    for item in file.Objects:
        geometry = item.Geometry
        if isinstance(geometry, rhino3dm.Brep):
            first += len(geometry.Surfaces)
        elif isinstance(geometry, rhino3dm.Surface):
            first += 1
        if face < first:
            return int(item.Attributes.LayerIndex)
    raise FileError(f"#{face}: no such surface; the file holds {first}")
