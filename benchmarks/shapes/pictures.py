"""Contact sheets: the worst and some random fair blends of each family, zebra stripes over blend and bases."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt

from semispline import SemisplineError, blend
from semispline.papers.reproduction.families.suite import shape_problem
from semispline.papers.reproduction.shape_measures import ENERGY_SET, FAIR_SET, Refused
from semispline.papers.reproduction.shape_suite import Row
from semispline.solver.pictures import BASE_COLOR, BLEND_COLOR, Drawn, render

WORST, RANDOM, COLUMNS = 12, 12, 4
TILE = (480, 400)


def sheets(rows: Sequence[Row], shared: Path, folder: Path) -> Iterator[Path]:
    """Draw a sheet of the worst and one of random blends for each family; of real pairs all, beside those of energy."""
    rng = np.random.default_rng(0)
    for family in dict.fromkeys(row.family for row in rows):
        of = sorted((row for row in rows if row.family == family), key=badness, reverse=True)
        chosen = {"worst": of[:WORST], "random": [of[i] for i in rng.permutation(len(of))[:RANDOM]]}
        for name, some in ({"all": of} if family == "real" else chosen).items():
            path = folder / f"{family.replace(' ', '-')}-{name}.png"
            sheet(some, shared, path, energy=family == "real")
            yield path


def badness(row: Row) -> float:
    """Return what orders blends: how far they turn, refused ones first."""
    return 180.0 if isinstance(row.fair, Refused) else row.fair.turn_degrees


def sheet(rows: Sequence[Row], shared: Path, path: Path, *, energy: bool) -> None:
    """Draw one sheet."""
    sets = (("fair", FAIR_SET), ("energy", ENERGY_SET)) if energy else (("fair", FAIR_SET),)
    tiles = [(row, name, options) for row in rows for name, options in sets]
    count = -(-len(tiles) // COLUMNS)
    figure, axes = plt.subplots(count, COLUMNS, figsize=(4 * COLUMNS, 3.6 * count), squeeze=False)
    with TemporaryDirectory() as folder:
        for axis in axes.flat:
            axis.axis("off")
        for axis, (row, name, options) in zip(axes.flat, tiles, strict=False):
            shape = getattr(row, name)
            said = "refused" if isinstance(shape, Refused) else f"turn {shape.turn_degrees:.0f}, {shape.fairness:.3g}"
            axis.set_title(f"{row.name} ({row.kind})\n{name}: {said}", fontsize=8)
            problem = shape_problem(row.family, row.seed, shared)
            assert problem is not None
            surfaces = [problem.a.surface, problem.b.surface]
            with suppress(SemisplineError):
                surfaces.append(blend(problem.a, problem.b, **options).surface)
            picture = Path(folder) / "tile.png"
            colors = BASE_COLOR, BASE_COLOR, BLEND_COLOR
            drawn = [Drawn(surface, color) for surface, color in zip(surfaces, colors, strict=False)]
            render(drawn, picture, field="zebra", size=TILE)
            axis.imshow(plt.imread(picture))
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)
