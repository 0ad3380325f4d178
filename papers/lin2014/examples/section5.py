"""Section 5 of the paper as data: what it prints of each example, and what of it can be used.

The paper prints knot vectors of contact curves, sizes of control nets and a table of results, but no control points.
The bases in `examples/` are our own (`example_bases`): they match the description, the printed knots and the printed
sizes. So energies, times and curvatures cannot be compared digit by digit. What can be compared: sizes, knots, numbers
of control points of the blends, the continuity that is reached, and in which order methods stand.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from semispline.papers.baselines import BlendTask
from semispline.papers.lin2014 import printed as pr
from semispline.solver.io import read_problem
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineSurface

FOLDER = Path(__file__).parent
DEGREE = 3


@dataclass(frozen=True)
class Printed:
    """What the paper prints of one example.

    Attributes
    ----------
    figure : int
    description : str
        In our own words.
    sizes : pair of (int, int)
        Table 1, Model 1 and Model 2: the second number counts control points along the contact.
    knots : pair of tuples or None
        Knots of the two contact curves, digit by digit; None where the text has none.
    continuity : {"C2", "G2"}
    middle_curves : int
    iterations : int or None
        Of fminunc, where the text tells.
    seconds, energy : float
        Table 1; the energy is (11) on the paper's own geometry and in its own units.
    mean_curvature : (float, float)
        Table 1.
    """

    figure: int
    description: str
    sizes: tuple[tuple[int, int], tuple[int, int]]
    knots: tuple[tuple[float, ...], tuple[float, ...]] | None
    continuity: Literal["C2", "G2"]
    middle_curves: int
    iterations: int | None
    seconds: float
    energy: float
    mean_curvature: tuple[float, float]


@dataclass(frozen=True)
class Departure:
    """Something that cannot be used as printed, or is not printed at all: what is used instead, and why."""

    figure: int
    printed: str
    used: str
    why: str


_CYLINDERS = ("fig-8.larger", "fig-8.smaller")


def _printed(
    figure: int,
    description: str,
    knots: tuple[str, str] | None,
    continuity: Literal["C2", "G2"],
    middle_curves: int,
    iterations: int | None,
    *table: Any,
) -> Printed:
    vectors = None
    if knots is not None:
        first, second = (tuple(float(x) for x in pr.KNOTS[key]) for key in knots)
        vectors = (first, second)
    sizes = pr.SIZES[f"fig-{figure}"]
    return Printed(figure, description, sizes, vectors, continuity, middle_curves, iterations, *table)


# Figure, description, knots; continuity, middle curves, iterations; seconds, energy and mean curvature of Table 1.
PRINTED = {
    p.figure: p
    for p in (
        _printed(
            5, "two planar patches", ("fig-5.first", "fig-5.second"),
            "C2", 1, None, 0.4515, 3.09e6, (0.0, 0.0817),
        ),
        _printed(
            6, "a planar patch and a curved one", ("fig-6.planar", "fig-6.curved"),
            "G2", 1, 5, 1.4599, 3.15e6, (0.0, 0.2581),
        ),
        _printed(
            8, "two part cylinders of different radius", _CYLINDERS,
            "C2", 1, None, 0.4520, 2.44e6, (0.0, 0.3822),
        ),
        _printed(
            9, "the part cylinders of Fig. 8 in another posture", _CYLINDERS,
            "C2", 1, None, 0.4331, 3.62e6, (0.0, 0.2834),
        ),
        _printed(
            10, "two complete cylinders", ("fig-10.first", "fig-10.second"),
            "G2", 0, 6, 1.6294, 2.99e6, (0.0, 0.1645),
        ),
        _printed(
            11, "a cone and a free-form surface", None,
            "G2", 0, None, 5.5418, 6.78e6, (0.0, 1.0613),
        ),
    )
}  # fmt: skip

# What Fig. 5 (d) to (f) takes for both bases, so that the method with equal knots can be used at all.
FIGURE_5_COMMON_KNOTS = (0, 0, 0, 0, 1 / 2, 1, 1, 1, 1)

DEPARTURES = (
    Departure(
        5, "both bases are given the v-knots [0,0,0,0,1/2,1,1,1,1] for (d) to (f)",
        "our second base is a cubic in v over all of [0, 1], so it has that form exactly",
        "a base with a free knot at 1/3 or 2/3 is not a spline over the common vector; it would be changed",
    ),
    Departure(
        10, "first contact curve: 13 knots, three zeros in front",
        "four zeros in front, 14 knots",
        "a clamped cubic with the 10 control points of Table 1 has 14 knots and four equal ones at each end; every "
        "other vector in the paper is printed that way",
    ),
    Departure(
        10, "inner knots 0.142857, 0.285714, ...",
        "the six printed digits, not i/7",
        "the vector is used as printed; the spans then differ by 1e-6",
    ),
    Departure(
        11, "no knots; 10 and 64 control points along the contact",
        "our own non-uniform vectors with 10 and 64 control points",
        "the text gives numbers only; they agree with Table 1, whose second number counts along the contact",
    ),
    Departure(
        11, "a conical surface", "part of a cone, open along v",
        "the text does not tell whether the cone is complete",
    ),
)  # fmt: skip
"""Departures that concern one figure. For all of them: control points, and knots across the contact, are not printed;
all of them are ours."""

FIGURES = tuple(PRINTED)


def usable_knots(figure: int) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
    """Return the clamped knots of both contact curves: as printed, with the missing zero of Fig. 10."""
    printed = PRINTED[figure].knots
    if printed is None or figure != 10:
        return printed
    first, second = printed
    return (0, *first), second


def example_path(figure: int) -> Path:
    """Return the file of an example: a `blend_problem`."""
    return FOLDER / f"figure-{figure}.json"


def example(figure: int) -> BlendTask:
    """Return the example of Fig. 5, 6, 8, 9, 10 or 11; Fig. 7 has the pair of Fig. 6.

    Examples
    --------
    >>> task = example(10)
    >>> task.name, task.continuity, task.middle_curves, task.closed
    ('figure-10', 'G2', 0, True)
    """
    problem = read_problem(example_path(figure))
    if not (isinstance(problem.a, BSplineSurface) and isinstance(problem.b, BSplineSurface)):
        raise TypeError(f"{example_path(figure).name}: expected two B-spline surfaces")
    return BlendTask(
        name=f"figure-{figure}",
        title=f"Fig. {figure}: {PRINTED[figure].description}",
        a=Base(problem.a, problem.edge_a),  # checked when the problem was read
        b=Base(problem.b, problem.edge_b),
        continuity=PRINTED[figure].continuity,
        middle_curves=PRINTED[figure].middle_curves,
    )
