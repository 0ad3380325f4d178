"""Every problem of the suite, by family and seed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from semispline.papers.reproduction.families.closed_rims import closed_rims
from semispline.papers.reproduction.families.open_pairs import open_pair
from semispline.papers.reproduction.families.problems import Family, ShapeProblem
from semispline.papers.reproduction.families.real_pairs import REAL_PAIRS, real_pair

# The seeds of each family are 0, 1, ... below its size.
SIZES: dict[Family, int] = {"facing": 400, "u-turn": 100, "closed rims": 112, "rough": 60, "real": len(REAL_PAIRS)}


def shape_problem(family: Family, seed: int, shared: Path | None = None) -> ShapeProblem | None:
    """Return a pair of bases; None for a real one whose file is not here.

    Parameters
    ----------
    family : {"facing", "u-turn", "closed rims", "rough", "real"}
    seed : int
        The same seed gives the same pair.
    shared : Path, optional
        Where the files of real pairs are.

    Examples
    --------
    >>> shape_problem("facing", 7).name
    'facing-007'
    """
    if family == "real":
        return real_pair(seed, shared)
    return closed_rims(seed) if family == "closed rims" else open_pair(family, seed)


def suite() -> Iterator[tuple[Family, int]]:
    """Yield family and seed of every problem."""
    for family in get_args(Family):
        yield from ((family, seed) for seed in range(SIZES[family]))
