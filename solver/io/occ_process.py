"""STEP, IGES and BREP files read by a process of their own.

On a damaged file Open CASCADE may run into a segmentation fault or an endless loop; half an IGES file is enough. A
process of its own turns that into a message. It converts all faces and hands over plain arrays.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from semispline.solver.errors import FileError, InputError
from semispline.solver.io.disk import require_file
from semispline.solver.io.face_boundary import FaceBoundary
from semispline.solver.io.faces import Model
from semispline.solver.io.occ_kernel import require_kernel
from semispline.solver.splines import BSplineSurface

# Open CASCADE reads some megabytes a minute at the slowest.
_SECONDS, _BYTES_PER_SECOND = 120.0, 20_000


@dataclass(frozen=True, eq=False)
class _ReadFace:
    """A face as the other process converted it: arguments of `BSplineSurface`, or the error."""

    kind: str
    is_trimmed: bool | None
    edges: FaceBoundary | None
    content: tuple[Any, ...] | InputError

    def trimmed(self) -> bool | None:
        return self.is_trimmed

    def boundary(self) -> FaceBoundary | None:
        return self.edges

    def surface(self) -> BSplineSurface:
        if isinstance(self.content, InputError):
            raise self.content
        return BSplineSurface(*self.content)


def open_occ(path: str | Path, bounded: Collection[int] = ()) -> Model:
    """Open a STEP, IGES or BREP file; `bounded` are the numbers of the faces whose boundaries are wanted.

    Raises
    ------
    FileError
        Missing, not readable by Open CASCADE, or the extra `cad` is not installed.
    """
    require_file(path)
    require_kernel(path)
    with tempfile.TemporaryDirectory(prefix="semispline-") as folder:
        result = Path(folder) / "faces"
        # The other process finds its modules where this one does, and not in the folder that it is started in (-P).
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
        command = [sys.executable, "-P", "-m", "semispline.solver.io.occ_process", str(path), str(result)]
        command += map(str, bounded)
        seconds = _SECONDS + os.path.getsize(path) / _BYTES_PER_SECOND
        try:
            ended = subprocess.run(command, env=environment, capture_output=True, check=False, timeout=seconds)
        except subprocess.TimeoutExpired:
            raise FileError(f"{path}: Open CASCADE found no end in {seconds:.0f} s; export the file anew") from None
        if ended.returncode or not result.is_file():
            raise FileError(
                f"{path}: Open CASCADE broke down while reading it (status {ended.returncode}); the file is damaged, "
                "export it anew"
            )
        # Our own process wrote this, out of numbers and strings.
        found = pickle.loads(result.read_bytes())
    if isinstance(found, InputError):
        raise found
    unit, faces = found
    return Model(str(path), unit, [_ReadFace(*face) for face in faces])


def main(path: str, result: str, *bounded: str) -> None:
    """Read the file at `path` and leave unit and faces, or the error, in the file `result`."""
    from semispline.solver.io.occ import read_occ

    found: Any
    try:
        model = read_occ(path)
        # A boundary takes as long as many surfaces: only of the faces for which it is wanted.
        edges = {int(n): model.faces[int(n)].boundary() for n in bounded if int(n) < len(model.faces)}
        faces = [(face.kind, face.trimmed(), edges.get(n), _content(face)) for n, face in enumerate(model.faces)]
        found = (model.unit, faces)
    except InputError as error:
        found = error
    Path(result).write_bytes(pickle.dumps(found))
    # Nothing is left to do: the kernel's way out has crashed after damaged files too.
    sys.stdout.flush()
    os._exit(0)


def _content(face: Any) -> tuple[Any, ...] | InputError:
    try:
        surface = face.surface()
    except InputError as error:
        return error
    arrays = (surface.knots_u, surface.knots_v, surface.control_points, surface.weights)
    return (surface.degree_u, surface.degree_v, *arrays)


if __name__ == "__main__":
    main(*sys.argv[1:])
