"""What all figures share: panels with renderings, and files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imread

from semispline.solver.io import atomic_path
from semispline.solver.pictures import Drawn, render
from semispline.solver.splines import Surface

DPI = 200


def show(
    axes: Any,
    scene: Sequence[Surface],
    size: tuple[int, int],
    colors: Sequence[str] | None = None,
    control_points: Sequence[bool] | None = None,
    **options: Any,
) -> None:
    """Put a rendering of so many pixels into a panel, its white margin cut off."""
    of_colors: Sequence[str | None] = colors or [None] * len(scene)
    nets = control_points or [False] * len(scene)
    drawn = [Drawn(*item) for item in zip(scene, of_colors, nets, strict=True)]
    with TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"
        render(drawn, picture, size=size, **options)
        image = np.asarray(imread(picture))[..., :3]
    inked = np.any(image < 0.99, axis=2)
    rows, columns = np.flatnonzero(inked.any(axis=1)), np.flatnonzero(inked.any(axis=0))
    axes.imshow(image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1], interpolation="antialiased")
    axes.axis("off")


def save(figure: Figure, path: str | Path) -> None:
    """Write a PNG file that says nothing of what made it."""
    with atomic_path(path) as temporary:
        FigureCanvasAgg(figure).print_png(str(temporary), metadata={"Software": None})
