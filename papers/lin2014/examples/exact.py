"""The complete cylinders of Fig. 10 and the cone of Fig. 11 as exact rational surfaces, beside polynomial stand-ins.

Axes, radii, lengths, openings and speeds across the contact are those of the stand-ins; the circles are true ones.
Knots and sizes of Table 1 no longer apply: a circle takes weights, and its knots are those of its arcs.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import cos, radians, sin
from typing import Literal, TypeAlias

import numpy as np

from semispline.papers.baselines import BlendTask
from semispline.papers.lin2014.examples.bases import CONE, CYLINDERS, tilted
from semispline.papers.lin2014.examples.section5 import PRINTED, example
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineCurve, BSplineSurface, revolve, revolve_smooth, swap_directions

# How a circle is run through: in arcs, as CAD programs write it, of degree 2 and continuous only in homogeneous
# coordinates; or as one curve of degree 6 that is C2 in them.
Circle: TypeAlias = Literal["arcs", "smooth"]
_REVOLVE: dict[Circle, Callable[..., BSplineSurface]] = {"arcs": revolve, "smooth": revolve_smooth}
EXACT_FIGURES = (10, 11)


@cache
def exact_example(figure: int, circle: Circle = "arcs") -> BlendTask:
    """Return the example of Fig. 10 or 11 with exact surfaces of revolution; the free form of Fig. 11 stays.

    Examples
    --------
    >>> task = exact_example(10)
    >>> task.name, task.closed, task.a.surface.control_points.shape
    ('figure-10-exact', True, (2, 9, 3))
    """
    if figure == 10:
        (radius, length), (other_radius, other_length) = CYLINDERS
        a = _revolved(circle, (radius, radius), length, 360.0)
        b = tilted(_revolved(circle, (other_radius, other_radius), other_length, 360.0))
    elif figure == 11:
        start, end, length, opening = CONE
        a, other = _revolved(circle, (start, end), length, opening), example(11).b.surface
        if not isinstance(other, BSplineSurface):
            raise TypeError("figure-11.json: expected two B-spline surfaces")
        b = other
    else:
        raise ValueError(f"figure: found {figure}, expected one of {EXACT_FIGURES}")
    printed = PRINTED[figure]
    title = f"Fig. {figure} with exact surfaces of revolution: {printed.description}"
    return BlendTask(
        f"figure-{figure}-exact", title, Base(a, "u0"), Base(b, "u0"), printed.continuity, printed.middle_curves
    )


def _revolved(circle: Circle, radii: tuple[float, float], length: float, opening: float) -> BSplineSurface:
    """Return a ruling from x = 0 to x = length, turned about x: contact at u = 0, v around, as the stand-ins run.

    A whole turn begins at the bottom and rises at the side of +y; a part of one has its middle on top.
    """
    whole = opening == 360.0
    angle = radians(180.0 if whole else -opening / 2)
    ends = np.array(
        [(x, r * (0.0 if whole else sin(angle)), r * cos(angle)) for x, r in zip((0.0, length), radii, strict=True)]
    )
    ruling = BSplineCurve(1, np.array([0.0, 0.0, 1.0, 1.0]), ends)
    axis = (1.0 if whole else -1.0, 0.0, 0.0)
    return swap_directions(_REVOLVE[circle](ruling, (0.0, 0.0, 0.0), axis, opening))
