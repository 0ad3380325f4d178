"""Grid evaluation against the bare SciPy products for the same work, in the same run.

    python benchmarks/surfaces.py

prints milliseconds and the ratio; the aim is a ratio below 1.5 for 500 x 500 points of a 64 x 64 bicubic net.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
from scipy.interpolate import BSpline

from semispline import BSplineSurface, SemiStructuredSurface
from semispline.solver.arrays import FloatArray
from semispline.solver.splines.knots import uniform_knots


def best_of(work: Callable[[], object], repeats: int = 30) -> float:
    """Return the least time of some runs, in milliseconds."""
    times = []
    for _ in range(repeats):
        start = perf_counter()
        work()
        times.append(perf_counter() - start)
    return 1e3 * min(times)


def bare_products(surface: BSplineSurface, u: FloatArray, v: FloatArray) -> FloatArray:
    """Do the same work by two design matrices and two sparse products; the result is ordered (v, u)."""
    across = BSpline.design_matrix(u, surface.knots_u, surface.degree_u)
    along = BSpline.design_matrix(v, surface.knots_v, surface.degree_v)
    n_u, n_v = surface.control_points.shape[:2]
    rows = (across @ surface.control_points.reshape(n_u, -1)).reshape(len(u), n_v, 3)
    values = along @ rows.transpose(1, 0, 2).reshape(n_v, -1)
    return np.asarray(values.reshape(len(v), len(u), 3))


def main() -> None:
    """Print the times and ratios of a classical, a rational and a semi-structured surface."""
    rng = np.random.default_rng(0)
    n, points = 64, 500
    knots = uniform_knots(3, n - 3)
    net = rng.uniform(-1, 1, (n, n, 3))
    plain = BSplineSurface(3, 3, knots, knots, net)
    rational = BSplineSurface(3, 3, knots, knots, net, rng.uniform(0.5, 2, (n, n)))
    semi: SemiStructuredSurface = plain.to_semistructured()
    rational_semi: SemiStructuredSurface = rational.to_semistructured()
    u = v = np.linspace(0, 1, points)
    assert np.abs(plain.evaluate_grid(u, v).transpose(1, 0, 2) - bare_products(plain, u, v)).max() < 1e-13
    bare = best_of(lambda: bare_products(plain, u, v))
    print(f"{points} x {points} points of a bicubic {n} x {n} net; bare SciPy products: {bare:.2f} ms")
    for name, work in (
        ("B-spline surface", lambda: plain.evaluate_grid(u, v)),
        ("its mixed derivative", lambda: plain.evaluate_grid(u, v, 1, 1)),
        ("rational surface", lambda: rational.evaluate_grid(u, v)),
        ("semi-structured surface", lambda: semi.evaluate_grid(u, v)),
        ("rational one", lambda: rational_semi.evaluate_grid(u, v)),
    ):
        time = best_of(work)
        print(f"{name:25s} {time:8.2f} ms  ratio {time / bare:.2f}")


if __name__ == "__main__":
    main()
