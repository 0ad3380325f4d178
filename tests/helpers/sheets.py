"""Curved sheets that face each other, and the options that search them with the quintic alone."""

from pathlib import Path

import numpy as np

from semispline import Base, BSplineSurface, read_surface, transform

CASES = Path(__file__).parents[1] / "cases"
QUINTIC = {"degree_u": 5, "middle_curves": 0}
FAIR = QUINTIC | {"alpha": "fair"}


def case(name, edge):
    return Base(read_surface(CASES / f"{name}.json"), edge)


def sheet(x, height, slope, *, bend=0.3, inner=(), degree=3):
    """A curved sheet from x on whose edge u0 rises by `slope`; knots along v as given."""
    n = degree + 1 + len(inner)
    v = np.linspace(0, 2, n)
    rows = [[[x + i * 0.5, y, height + slope * i * 0.5 + bend * np.sin(2 * y + i)] for y in v] for i in range(4)]
    knots = [0.0] * (degree + 1) + list(inner) + [1.0] * (degree + 1)
    return BSplineSurface(3, degree, [0, 0, 0, 0, 1, 1, 1, 1], knots, rows)


def sheets(**more):
    """Two sheets that face each other: the first one turned round."""
    first = transform(sheet(0.0, 0.0, 0.2, **more), np.diag([-1.0, 1.0, 1.0]))
    return Base(first, "u0"), Base(sheet(1.2, 0.6, 0.4, bend=0.2, inner=(0.4,)), "u0")
