"""The suite of shapes: each problem blended with both sets, and what the lot of them come to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, get_args

import numpy as np

from semispline.papers.reproduction.families.problems import Family, PairMeasures
from semispline.papers.reproduction.families.suite import shape_problem
from semispline.papers.reproduction.shape_measures import (
    ENERGY_SET,
    FAIR_SET,
    Refused,
    Shape,
    judged,
    wanted_by_energy,
)

# A * GH below this is what the eye takes for flat or a cylinder: quotients of less say nothing.
INVISIBLE = 0.1
# alpha^2 below this part of its natural size creases the seam.
CREASE = 1 / 8
STEEP, SHARP, NARROW = 30.0, 60.0, 0.5


@dataclass(frozen=True)
class Row:
    """One problem of the suite.

    Attributes
    ----------
    name : str
    family : {"facing", "u-turn", "closed rims", "rough", "real"}
    kind : str
    seed : int
    measures : PairMeasures
    fair, energy : Shape or Refused
        With `FAIR_SET` and `ENERGY_SET`.
    wanted : (float, float) or None
        alpha^2 and beta^2 of least energy (11) without a box, over their natural sizes.
    """

    name: str
    family: Family
    kind: str
    seed: int
    measures: PairMeasures
    fair: Shape | Refused
    energy: Shape | Refused
    wanted: tuple[float, float] | None

    @property
    def quotient(self) -> float | None:
        """A * GH of the fair set over that of the energy set; None where one is refused."""
        if isinstance(self.fair, Refused) or isinstance(self.energy, Refused):
            return None
        return max(self.fair.fairness, INVISIBLE) / max(self.energy.fairness, INVISIBLE)

    def to_json(self) -> dict[str, Any]:
        """Return what a line of a file holds."""
        return asdict(self)

    @classmethod
    def from_json(cls, line: dict[str, Any]) -> Row:
        """Return the row that such a line holds."""
        shapes = {name: _shape(line[name]) for name in ("fair", "energy")}
        wanted = None if line["wanted"] is None else (line["wanted"][0], line["wanted"][1])
        return cls(**{**line, **shapes, "measures": PairMeasures(**_tuples(line["measures"])), "wanted": wanted})


@dataclass(frozen=True)
class Summary:
    """How the blends of some problems came out with one set; numbers of problems unless said otherwise.

    Attributes
    ----------
    problems, refused, at_bound, turns_30, turns_60, folds, silent_folds, loops, meets, warned : int
        `meets`: itself or a base.
    narrow : int or None
        Waist below half that of the straight rulings, of closed rims.
    stored, converted : float
        Control points, median.
    milliseconds : float
        Processor time, median.
    """

    problems: int
    refused: int
    at_bound: int
    turns_30: int
    turns_60: int
    folds: int
    silent_folds: int
    loops: int
    meets: int
    warned: int
    narrow: int | None
    stored: float
    converted: float
    milliseconds: float


def run_problem(family: Family, seed: int, shared: Path | None = None, repeats: int = 2) -> Row | None:
    """Blend and judge one problem of the suite; None where its file is not here."""
    problem = shape_problem(family, seed, shared)
    if problem is None:
        return None
    (fair, _), (energy, _) = (judged(problem, options, repeats) for options in (FAIR_SET, ENERGY_SET))
    wanted = None if isinstance(energy, Refused) else wanted_by_energy(problem)
    return Row(problem.name, family, problem.kind, seed, problem.measures, fair, energy, wanted)


def summary(shapes: Sequence[Shape | Refused]) -> Summary:
    """Count what came out of some problems with one set."""
    found = [shape for shape in shapes if isinstance(shape, Shape)]
    waists = [shape.waist for shape in found if shape.waist is not None]
    return Summary(
        problems=len(shapes),
        refused=len(shapes) - len(found),
        at_bound=sum(bool(shape.at_bound) for shape in found),
        turns_30=sum(shape.turn_degrees > STEEP for shape in found),
        turns_60=sum(shape.turn_degrees > SHARP for shape in found),
        folds=sum(shape.folds for shape in found),
        silent_folds=sum(shape.is_silent_fold for shape in found),
        loops=sum(shape.loop_degrees > SHARP for shape in found),
        meets=sum(bool(shape.meets) for shape in found),
        warned=sum(bool(shape.warnings) for shape in found),
        narrow=sum(waist < NARROW for waist in waists) if waists else None,
        stored=float(np.median([shape.points_stored for shape in found])),
        converted=float(np.median([shape.points_converted for shape in found])),
        milliseconds=float(np.median([1e3 * shape.seconds for shape in found])),
    )


def quotients(rows: Sequence[Row]) -> tuple[float, float, float]:
    """Return the quotient of A * GH, fair over energy, that 10 %, half and 90 % of the problems do not exceed."""
    found = [quotient for row in rows if (quotient := row.quotient) is not None]
    low, median, high = np.quantile(found, [0.1, 0.5, 0.9]).tolist()
    return low, median, high


def wants(rows: Sequence[Row]) -> dict[str, int]:
    """Return what least energy without a box comes to: of how many problems alpha^2 or beta^2 is such.

    Examples
    --------
    >>> wants([])
    {'told': 0, 'not positive': 0, 'below 1/8': 0, 'above 8': 0, 'folds within 1/8 to 8': 0}
    """
    told = [row for row in rows if row.wanted is not None]
    least = [min(row.wanted) for row in told if row.wanted is not None]
    most = [max(row.wanted) for row in told if row.wanted is not None]
    return {
        "told": len(told),
        "not positive": sum(x <= 0 for x in least),
        "below 1/8": sum(0 < x < CREASE for x in least),
        "above 8": sum(low >= CREASE and high > 1 / CREASE for low, high in zip(least, most, strict=True)),
        "folds within 1/8 to 8": sum(isinstance(row.energy, Shape) and row.energy.folds for row in told),
    }


def figures(rows: Sequence[Row]) -> dict[str, Any]:
    """Return what a file holds of the whole suite, by family: counts, quotients, and what least energy wants.

    Times are left out: they are of one machine.
    """
    found: dict[str, Any] = {}
    for family in get_args(Family):
        of = [row for row in rows if row.family == family]
        if of:
            counts = {name: asdict(summary([getattr(row, name) for row in of])) for name in ("fair", "energy")}
            for count in counts.values():
                del count["milliseconds"]
            found[family] = counts | {"quotients": list(quotients(of)), "wants": wants(of)}
    return found


def _shape(line: dict[str, Any]) -> Shape | Refused:
    return Refused(**line) if "reason" in line else Shape(**_tuples(line))


def _tuples(line: dict[str, Any]) -> dict[str, Any]:
    return {name: tuple(x) if isinstance(x, list) else x for name, x in line.items()}
