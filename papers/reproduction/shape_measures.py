"""What shape a blend has, by the judge alone: one pair, one set of options."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from semispline.papers.reproduction.families.problems import ShapeProblem
from semispline.solver.blending import BlendResult, blend, shape_polynomial, state_problem
from semispline.solver.errors import ComputationError, SemisplineError
from semispline.solver.judge import (
    Base,
    measure_exits,
    measure_fairness,
    measure_loop,
    measure_meets,
    measure_turn,
    measure_waist,
)
from semispline.solver.proof import least_point

# The two sets that the suite compares: what a user gets, and the paper's choice.
FAIR_SET: Mapping[str, Any] = {}
ENERGY_SET: Mapping[str, Any] = {"alpha": "energy"}
# What a warning of a fold says.
_SAYS_FOLD = ("fold", "turns")
# Where alpha^2 and beta^2 are sought without a box, in natural units; and, of the energy there, how near to the least
# they have to come.
_WHOLE, _NEAR = (-1024.0, 1024.0), 1e-6


@dataclass(frozen=True)
class Shape:
    """A blend, as the judge sees it.

    Attributes
    ----------
    layout : str
        Degree across, middle curves, and whether alpha^2 is constant or linear along v.
    alpha2, beta2 : float, (float, float) or None
    at_bound : tuple of str
        Bounds of alpha^2 and beta^2.
    warnings : tuple of str
    turn_degrees : float
    fairness : float
        A * integral of |grad H|^2 with the jumps of H; no units.
    fairness_settled : bool
    loop_degrees : float
    is_u_turn, must_loop : bool
        Exits and chord disagree; and lead to opposite sides.
    waist : float or None
        Closed rims: least distance of opposite points over that of the straight rulings.
    meets : tuple of str
        What it was found to meet: itself, a, b.
    search_seconds : float or None
        Processor time of the search for that, on a mesh; None where none was searched, as a direction shows that it
        meets nothing.
    points_stored, points_converted : int
        Control points of its rows, and of the B-spline surface that other programs read.
    seconds : float
        Processor time of `blend`, all its checks included.
    """

    layout: str
    alpha2: Any
    beta2: Any
    at_bound: tuple[str, ...]
    warnings: tuple[str, ...]
    turn_degrees: float
    fairness: float
    fairness_settled: bool
    loop_degrees: float
    is_u_turn: bool
    must_loop: bool
    waist: float | None
    meets: tuple[str, ...]
    search_seconds: float | None
    points_stored: int
    points_converted: int
    seconds: float

    @property
    def folds(self) -> bool:
        """Whether it turns by more than 90 degrees."""
        return self.turn_degrees > 90

    @property
    def is_silent_fold(self) -> bool:
        """Whether it folds, and no warning says so."""
        return self.folds and not any(word in warning for warning in self.warnings for word in _SAYS_FOLD)


@dataclass(frozen=True)
class Refused:
    """A blend that there is none of, and why."""

    reason: str


def judged(
    problem: ShapeProblem, options: Mapping[str, Any], repeats: int = 1
) -> tuple[Shape | Refused, BlendResult | None]:
    """Blend a pair and measure what comes out.

    Parameters
    ----------
    problem : ShapeProblem
    options : mapping
        Such as `FAIR_SET`.
    repeats : int
        The least time of so many blends counts.

    Returns
    -------
    Shape or Refused
    BlendResult or None

    Examples
    --------
    >>> from semispline.papers.reproduction.families.closed_rims import closed_rims
    >>> shape, result = judged(closed_rims(0), FAIR_SET)
    >>> shape.folds, shape.waist > 0.5, shape.points_stored == result.surface.n_control_points
    (False, True, True)
    """
    seconds = float("inf")
    try:
        for _ in range(repeats):
            started = time.process_time()
            result = blend(problem.a, problem.b, **options)
            seconds = min(seconds, time.process_time() - started)
    except SemisplineError as error:
        return Refused(f"{type(error).__name__}: {error}"), None
    return shape_of(result, problem.a, problem.b, seconds), result


def shape_of(result: BlendResult, a: Base, b: Base, seconds: float) -> Shape:
    """Measure a blend of two bases."""
    surface, options = result.surface, result.options
    fairness, exits, waist = measure_fairness(surface), measure_exits(surface), measure_waist(surface)
    n_u, n_v = surface.to_bspline().control_points.shape[:2]
    started = time.process_time()
    meets = measure_meets(surface, a, b)
    search_seconds = time.process_time() - started
    return Shape(
        layout=f"degree {options.degree_u}, {options.middle_curves} middle, {options.alpha_v} alpha",
        alpha2=result.alpha2,
        beta2=result.beta2,
        at_bound=tuple(name for name in result.active_bounds if name.startswith(("alpha2", "beta2"))),
        warnings=result.warnings,
        turn_degrees=measure_turn(surface).degrees,
        fairness=fairness.value,
        fairness_settled=fairness.settled,
        loop_degrees=measure_loop(surface).degrees,
        is_u_turn=exits.is_u_turn,
        must_loop=exits.must_loop,
        waist=None if waist is None else waist.distance / waist.of_rulings,
        meets=tuple(sorted({meeting.what for meeting in meets.found})),
        search_seconds=search_seconds if meets.searched else None,
        points_stored=surface.n_control_points,
        points_converted=n_u * n_v,
        seconds=seconds,
    )


def wanted_by_energy(problem: ShapeProblem) -> tuple[float, float] | None:
    """Return the alpha^2 and beta^2, over their natural sizes, that have the least energy (11) where no box holds them.

    They may be negative: then the blend leaves its base backwards. None where no least point is proved.

    Examples
    --------
    >>> from semispline.papers.reproduction.families.open_pairs import open_pair
    >>> [round(x, 2) for x in wanted_by_energy(open_pair("facing", 0))]
    [0.1, 0.51]
    """
    stated = state_problem(problem.a, problem.b, **ENERGY_SET).problem
    # The energy as a polynomial of both, in natural units.
    table = shape_polynomial(stated, (0.0, 0.0))
    natural = float(stated.form.products(stated.control_points(*stated.start)[None])[0, 0])
    try:
        x, y = least_point(table, (_WHOLE, _WHOLE), _NEAR * natural).point
    except ComputationError:
        return None
    return x, y
