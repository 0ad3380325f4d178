"""The global minimum of the energy over the box of admissible shape parameters, with a certificate.

The energy is a polynomial of bidegree at most (4, 4) in x = (a - a0) / natural a and y likewise. Its float coefficients
are taken as exact rationals. A box is discarded when its Bernstein coefficients, in integers, prove that the polynomial
stays above the bound, or when they prove it convex there and its tangent plane at a point stays above the bound. Along
a curve of equal minima neither ever happens: there, sums of squares prove the bound.
"""

from __future__ import annotations

from functools import cache, lru_cache, partial
from math import comb
from typing import Any

import numpy as np
from flint import fmpq, fmpq_mat, fmpz_mat

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import ComputationError
from semispline.solver.proof.certificates import Box, Certificate, Leaf
from semispline.solver.proof.squares import NoSquares, gram_matrices

# Boxes after which sums of squares are tried, and the proof is given up; most problems need less than a hundred boxes,
# and a sum of squares takes the time of thousands of them.
_PLAIN_BOXES = 300
_MOST_SQUARES = 20
# Each point found is lower than the one before.
_MOST_POINTS = 100
_NEWTON_STEPS = 60


def least_point(coefficients: FloatArray, box: Box, tolerance: float) -> Certificate:
    """Return a point where the polynomial is least over the box, with the proof that it is least up to `tolerance`.

    Parameters
    ----------
    coefficients : ndarray, shape (n + 1, n' + 1)
    box : pair of (low, high)
    tolerance : float
        Positive.

    Raises
    ------
    ComputationError
        No proof within 300 boxes, nor by 20 sums of squares; or a tolerance that floats cannot express.

    Examples
    --------
    >>> proof = least_point(np.array([[1.0], [0.0], [-2.0], [0.0], [1.0]]), ((-2.0, 3.0), (0.0, 0.0)), 1e-9)
    >>> round(abs(proof.point[0]), 9), round(proof.bound, 12)
    (1.0, -5e-10)
    """
    point = best_of_grid(coefficients, box)
    for _ in range(_MOST_POINTS):
        value = _exact_value(coefficients, point)
        # Half of the tolerance is for the proof, the rest for the rounding of the bound itself.
        bound = _float_below(value - _rational(tolerance) / 2)
        if value - _rational(bound) > _rational(tolerance):
            raise ComputationError(
                f"tolerance: found {tolerance:.1e}, expected more than the spacing of floats at {float(value):.3g}"
            )
        found = _prove(coefficients, box, bound, point, squares=False)
        if found is None:
            found = _prove(coefficients, box, bound, point, squares=True)
        if isinstance(found, list):
            return Certificate(coefficients, box, point, tolerance, bound, tuple(found))
        if found is None:
            break
        # Where the search in floats has come to its end, the point found is the lower one.
        point = min(_descend(coefficients, box, found), found, key=partial(_exact_value, coefficients))
    raise ComputationError(
        f"no proof of the least energy within {_PLAIN_BOXES} boxes, nor by {_MOST_SQUARES} sums of squares; try method "
        "casadi, or set alpha and beta yourself"
    )


def _float_below(x: fmpq) -> float:
    nearest = int(x.p) / int(x.q)
    return nearest if _rational(nearest) <= x else float(np.nextafter(nearest, -np.inf))


def best_of_grid(c: FloatArray, box: Box) -> tuple[float, float]:
    """Return the best end of Newton searches from the local minima of a grid, spaced geometrically: no proof."""
    axes: list[Any] = []
    for low, high in box:
        t = np.linspace(0, 1, 41)
        # From 1/8 to 8 of natural: equal ratios; the origin of x lies anywhere inside.
        axes.append(low + (high - low) * (64**t - 1) / 63 if high > low else np.array([low]))
    values = np.polynomial.polynomial.polygrid2d(axes[0], axes[1], c)
    padded = np.pad(values, 1, constant_values=np.inf)
    lowest = np.ones(values.shape, dtype=bool)
    for i in (0, 1, 2):
        for j in (0, 1, 2):
            lowest &= values <= padded[i : i + values.shape[0], j : j + values.shape[1]]
    starts = np.argwhere(lowest)
    starts = starts[np.argsort(values[lowest])][:4]
    points = [_descend(c, box, (float(axes[0][i]), float(axes[1][j]))) for i, j in starts]
    return min(points, key=lambda p: float(np.polynomial.polynomial.polyval2d(p[0], p[1], c)))


def _descend(c: FloatArray, box: Box, start: tuple[float, float]) -> tuple[float, float]:
    """Projected Newton: steps in the free directions, damped until the polynomial falls."""
    low, high = np.transpose(box)
    tables = _jet_tables(c.tobytes(), c.shape)
    magnitudes = np.abs(c)

    def evaluate(z: FloatArray) -> list[float]:
        px, py = z[0] ** np.arange(c.shape[0]), z[1] ** np.arange(c.shape[1])
        values = (tables @ py) @ px
        return [*values.tolist(), float(np.abs(px) @ magnitudes @ np.abs(py))]

    z = np.clip(np.array(start), low, high)
    f, *rest, magnitude = evaluate(z)
    for _ in range(_NEWTON_STEPS):
        gradient, hessian = np.array(rest[:2]), np.array([[rest[2], rest[3]], [rest[3], rest[4]]])
        free = ~(((z <= low) & (gradient >= 0)) | ((z >= high) & (gradient <= 0)))
        if not (free & (gradient != 0)).any():
            break
        values, vectors = np.linalg.eigh(hessian[np.ix_(free, free)])
        # |eigenvalues| turn a saddle into descent; flat directions stay where they are.
        scale = np.abs(values).max()
        inverse = np.divide(1.0, np.abs(values), out=np.zeros_like(values), where=np.abs(values) > 1e-14 * scale)
        step = np.zeros(2)
        step[free] = -(vectors * inverse) @ (vectors.T @ gradient[free])
        # What the step may gain is less than the rounding of a value, which could not confirm it: this is the minimum.
        if -float(gradient @ step) <= 1e-15 * magnitude:
            z = np.clip(z + step, low, high)
            break
        for _halving in range(30):
            trial = np.clip(z + step, low, high)
            f_trial, *rest_trial, magnitude_trial = evaluate(trial)
            if f_trial < f:
                break
            step /= 2
        else:
            break
        z, f, rest, magnitude = trial, f_trial, rest_trial, magnitude_trial
    return float(z[0]), float(z[1])


@lru_cache(maxsize=4)
def _jet_tables(raw: bytes, shape: tuple[int, int]) -> FloatArray:
    """Coefficients of the polynomial and its derivatives x, y, xx, xy, yy, shape (6, n + 1, n' + 1)."""
    c = np.frombuffer(raw).reshape(shape)
    c_x, c_y = _derivative(c, 0), _derivative(c, 1)
    tables = np.zeros((6, *shape))
    for table, d in zip(
        tables, (c, c_x, c_y, _derivative(c_x, 0), _derivative(c_x, 1), _derivative(c_y, 1)), strict=True
    ):
        table[: d.shape[0], : d.shape[1]] = d
    return tables


def _derivative(c: FloatArray, axis: int) -> FloatArray:
    return np.asarray(np.polynomial.polynomial.polyder(c, axis=axis))


def _prove(
    c: FloatArray, box: Box, bound: float, best: tuple[float, float], *, squares: bool
) -> list[Leaf] | tuple[float, float] | None:
    """Return parts that prove the bound, or a point where the polynomial is below it, or None: given up."""
    threshold = _rational(bound)
    exact = fmpq_mat(*c.shape, [_rational(x) for x in c.ravel().tolist()])
    root, denominator = (
        _to_bernstein(box[0], c.shape[0]) * exact * _to_bernstein(box[1], c.shape[1]).transpose()
    ).numer_denom()
    leaves: list[Leaf] = []
    stack: list[tuple[fmpz_mat, tuple[int, int], tuple[int, int]]] = [(root, (0, 0), (0, 0))]
    attempts = 0
    for _ in range(_PLAIN_BOXES):
        if not stack:
            return leaves
        net, x, y = stack.pop()
        shift = x[1] * (c.shape[0] - 1) + y[1] * (c.shape[1] - 1)
        entries = [int(e) for e in net.entries()]
        least = min(entries)
        if least * threshold.q >= threshold.p * (denominator << shift):
            leaves.append(Leaf(x, y))
            continue
        part = _part(box[0], x), _part(box[1], y)
        columns = c.shape[1]
        rows = [entries[i : i + columns] for i in range(0, len(entries), columns)]
        inside = (min(max(best[0], part[0][0]), part[0][1]), min(max(best[1], part[1][0]), part[1][1]))
        if _is_convex(rows):
            point = _descend(c, part, inside)
            local = _local_point(point, part)
            if _tangent_bound(c, (_exact_part(box[0], x), _exact_part(box[1], y)), local) >= threshold:
                leaves.append(Leaf(x, y, tangent_at=local))
                continue
        else:
            point = (part[0][0] + part[0][1]) / 2, (part[1][0] + part[1][1]) / 2
        if _exact_value(c, point) < threshold:
            return point
        if squares:
            attempts += 1
            grams = gram_matrices(_powers_above(net, denominator << shift, threshold))
            if not isinstance(grams, NoSquares):
                leaves.append(Leaf(x, y, squares=grams))
                continue
            point = _global_point(grams.lowest, part)
            if _exact_value(c, point) < threshold:
                return point
            if attempts == _MOST_SQUARES:
                return None
        stack += _halves(net, x, y, rows)
    return None


def _powers_above(net: fmpz_mat, denominator: int, bound: fmpq) -> fmpq_mat:
    """Return the polynomial minus the bound, in powers of parameters that run from -1 to 1 over a part."""
    along, across = (_to_bernstein((-1.0, 1.0), n).inv() for n in (net.nrows(), net.ncols()))
    table = along * fmpq_mat(net) * across.transpose() / fmpq(denominator)
    table[0, 0] -= bound
    return table


def _global_point(point: tuple[float, float], part: Box) -> tuple[float, float]:
    """Return the point of a part whose parameters, from -1 to 1, are given."""
    x, y = (min(max(low + (high - low) * (t + 1) / 2, low), high) for t, (low, high) in zip(point, part, strict=True))
    return x, y


def _part(whole: tuple[float, float], part: tuple[int, int]) -> tuple[float, float]:
    low, high = whole
    i, s = part
    return low + (high - low) * (i / 2**s), low + (high - low) * ((i + 1) / 2**s)


def _exact_part(whole: tuple[float, float], part: tuple[int, int]) -> tuple[fmpq, fmpq]:
    """Low end and width."""
    low, width = _rational(whole[0]), _rational(whole[1]) - _rational(whole[0])
    return low + width * fmpq(part[0], 2 ** part[1]), width / 2 ** part[1]


def _local_point(point: tuple[float, float], part: Box) -> tuple[float, float]:
    s, t = (
        min(max((z - low) / (high - low), 0.0), 1.0) if high > low else 0.0
        for z, (low, high) in zip(point, part, strict=True)
    )
    return s, t


def _rational(x: float) -> fmpq:
    return fmpq(*float(x).as_integer_ratio())


@cache
def _bernstein_of_powers(n: int) -> fmpq_mat:
    """Bernstein coefficients on [0, 1] of the powers up to degree n - 1."""
    return fmpq_mat(n, n, [fmpq(comb(i, k), comb(n - 1, k)) if k <= i else fmpq(0) for i in range(n) for k in range(n)])


def _to_bernstein(interval: tuple[float, float], n: int) -> fmpq_mat:
    """Coefficients of powers of x to Bernstein coefficients over the interval."""
    low, width = _rational(interval[0]), _rational(interval[1]) - _rational(interval[0])
    shift = [comb(m, k) * low ** (m - k) * width**k if k <= m else fmpq(0) for k in range(n) for m in range(n)]
    return _bernstein_of_powers(n) * fmpq_mat(n, n, shift)


@cache
def _halving(n: int) -> tuple[fmpz_mat, fmpz_mat]:
    """Bernstein coefficients of both halves, times 2^(n - 1)."""
    d = n - 1
    left = [comb(i, k) << (d - i) if k <= i else 0 for i in range(n) for k in range(n)]
    right = [comb(d - i, k - i) << i if k >= i else 0 for i in range(n) for k in range(n)]
    return fmpz_mat(n, n, left), fmpz_mat(n, n, right)


def _halves(
    net: fmpz_mat, x: tuple[int, int], y: tuple[int, int], rows: list[list[int]]
) -> list[tuple[fmpz_mat, tuple[int, int], tuple[int, int]]]:
    """Split the box across the direction in which the net varies more."""
    n, m = len(rows), len(rows[0])
    vary_x = max((abs(rows[i + 1][j] - rows[i][j]) for i in range(n - 1) for j in range(m)), default=-1)
    vary_y = max((abs(rows[i][j + 1] - rows[i][j]) for i in range(n) for j in range(m - 1)), default=-1)
    if vary_x >= vary_y:
        left, right = _halving(n)
        parts = [((2 * x[0] + k, x[1] + 1), y) for k in (0, 1)]
        return [(half * net, *part) for half, part in zip((left, right), parts, strict=True)]
    left, right = _halving(m)
    parts = [(x, (2 * y[0] + k, y[1] + 1)) for k in (0, 1)]
    return [(net * half.transpose(), *part) for half, part in zip((left, right), parts, strict=True)]


def _is_convex(b: list[list[int]]) -> bool:
    """Prove from the Bernstein net that the Hessian is positive semidefinite on the box."""
    n, m = len(b) - 1, len(b[0]) - 1
    # Derivatives by the local parameters: n (n - 1) second differences, n m mixed ones.
    xx = [n * (n - 1) * (b[i + 2][j] - 2 * b[i + 1][j] + b[i][j]) for i in range(n - 1) for j in range(m + 1)]
    yy = [m * (m - 1) * (b[i][j + 2] - 2 * b[i][j + 1] + b[i][j]) for i in range(n + 1) for j in range(m - 1)]
    xy = [n * m * (b[i + 1][j + 1] - b[i + 1][j] - b[i][j + 1] + b[i][j]) for i in range(n) for j in range(m)]
    least_xx, least_yy = min(xx, default=0), min(yy, default=0)
    largest_xy = max((abs(e) for e in xy), default=0)
    return least_xx >= 0 and least_yy >= 0 and least_xx * least_yy >= largest_xy**2


def _exact_value(c: FloatArray, point: tuple[float, float]) -> fmpq:
    return _exact_jet(c, (_rational(point[0]), _rational(point[1])))[0]


def _exact_jet(c: FloatArray, point: tuple[fmpq, fmpq]) -> tuple[fmpq, fmpq, fmpq]:
    """Value and both first derivatives, by Horner's scheme on pairs."""
    x, y = point
    value = by_x = by_y = fmpq(0)
    for row in reversed(c.tolist()):
        inner = inner_y = fmpq(0)
        for coefficient in reversed(row):
            inner_y = inner_y * y + inner
            inner = inner * y + _rational(coefficient)
        by_x = by_x * x + value
        by_y = by_y * x + inner_y
        value = value * x + inner
    return value, by_x, by_y


def _tangent_bound(
    c: FloatArray, part: tuple[tuple[fmpq, fmpq], tuple[fmpq, fmpq]], local: tuple[float, float]
) -> fmpq:
    """Return the least value over the part of the tangent plane at a point of it, exactly."""
    at = [_rational(t) for t in local]
    point = part[0][0] + part[0][1] * at[0], part[1][0] + part[1][1] * at[1]
    value, *slopes = _exact_jet(c, point)
    for slope, t, (_, width) in zip(slopes, at, part, strict=True):
        value += min(-slope * width * t, slope * width * (1 - t))
    return value
