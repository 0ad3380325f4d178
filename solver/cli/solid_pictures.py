"""A picture of a solid with its new faces coloured.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

# What was there before; and by how much one looks from beside, of the way from the new faces to the eye.
_OLD = "#c9c9c9"
_BESIDE = (0.35, -0.55, 0.45)


def check_solid_picture(folder: str) -> None:
    """Refuse what cannot be drawn or written, before the work.

    Raises
    ------
    FileError
    """
    from semispline.solver.io import check_folder
    from semispline.solver.pictures import check_picture

    check_folder(folder)
    check_picture("solid.png", None)


def solid_picture(path: str | Path, faces: Sequence[int]) -> bytes:
    """Return a picture of a file with some of its faces red, named, and towards the eye."""
    import numpy as np

    from semispline.solver.pictures import BLEND_COLOR, Drawn, render
    from semispline.solver.topology import outward_at_border, read_drawn

    drawn, _ = read_drawn([str(path)])
    eye = outward_at_border(path, faces) + np.array(_BESIDE)
    with TemporaryDirectory() as folder:
        target = Path(folder, "solid.png")
        render(
            [
                Drawn(
                    face.surface,
                    color=BLEND_COLOR if face.number in faces else _OLD,
                    mesh=face.mesh,
                    edges=face.edges,
                    label=f"#{face.number}" if face.number in faces else "",
                )
                for face in drawn
            ],
            target,
            towards_eye=eye,
        )
        return target.read_bytes()
