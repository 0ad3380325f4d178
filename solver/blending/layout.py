"""Where the knots of a blend lie: U, and V_i of every v-control curve."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray, finite_array
from semispline.solver.errors import InputError, OptionError
from semispline.solver.options import ROWS_PER_SIDE
from semispline.solver.scalars import whole_number
from semispline.solver.splines import (
    MERGE_TOLERANCE,
    Basis,
    breakpoints,
    checked_knots,
    clamped,
    crowded_knots,
    inner_knots,
    merge_breakpoints,
    uniform_knots,
)

# More than any blend needs; the energy in u is held in full.
MOST_MIDDLE_CURVES = 1000
# Below it second derivatives in u vanish: creases across would cost nothing, and free rows would be undetermined.
_LEAST_DEGREE = 2
_CUBIC = 3


def blend_u_basis(
    degree_u: int, middle_curves: int, inner: Sequence[float] | None = None, orders: tuple[int, int] = (2, 2)
) -> Basis:
    """Return U: clamped on [0, 1], for the rows of both contacts and `middle_curves`; inner knots uniform unless given.

    Parameters
    ----------
    degree_u, middle_curves : int
    inner : sequence of float, optional
    orders : (int, int)
        Orders of contact: a contact has order + 1 rows, 3 at least.

    Raises
    ------
    OptionError
        A negative number of middle curves, a degree below 2 or too high for the number of rows, knots that do not fit,
        or across which less than third or fourth order goes where that is asked for.

    Source: section 3 of the paper, with u_i = i / (m - k + 2).

    Examples
    --------
    >>> blend_u_basis(3, 0).knots[4:-4]
    array([0.33333333, 0.66666667])
    """
    middle_curves = whole_number(middle_curves, "middle_curves", 0, OptionError)
    if middle_curves > MOST_MIDDLE_CURVES:
        raise OptionError(f"middle_curves: found {middle_curves}, expected at most {MOST_MIDDLE_CURVES}")
    degree_u = whole_number(degree_u, "degree_u", 1, OptionError)
    rows = sum(max(ROWS_PER_SIDE, order + 1) for order in orders) + middle_curves
    least = max(orders) + 1 if max(orders) > 2 else _LEAST_DEGREE
    if not _LEAST_DEGREE <= degree_u < rows:
        raise OptionError(
            f"degree_u: found {degree_u}, expected {least} to {rows - 1} with {middle_curves} middle curve(s)"
        )
    if inner is None:
        basis = Basis(degree_u, uniform_knots(degree_u, rows - degree_u))
    else:
        given = np.sort(finite_array(inner, 1, "u_knots", OptionError))
        if len(given) != rows - degree_u - 1:
            raise OptionError(
                f"u_knots: found {len(given)} inner knots, expected {rows - degree_u - 1} for {rows} rows"
            )
        basis = Basis(degree_u, _clamped_inside(given, degree_u, 0.0, 1.0, "u_knots"))
    _check_carries(basis, max(orders), rows)
    return basis


def _check_carries(u: Basis, order: int, rows: int) -> None:
    """Refuse inner knots across which the blend is less smooth than at its contacts, for orders that promise more."""
    inner = u.knots[u.degree + 1 : -u.degree - 1]
    most = max((int(np.sum(inner == knot)) for knot in inner), default=0)
    if order <= 2 or not most or u.degree - most >= order:
        return
    degrees = [f"{p} with {rows - 1 - p or 'no'} inner knot(s)" for p in range(order + 1, rows)]
    raise OptionError(
        f"degree_u: found {u.degree} with inner knots of multiplicity {most}, which carries at most "
        f"G{u.degree - most} through the blend; G{order} needs simple knots and degree {', '.join(degrees)}"
    )


def middle_bases(
    a: Basis,
    b: Basis,
    count: int,
    given: Literal["fourth", "paper"] | Sequence[Sequence[float]] = "paper",
    *,
    closed: bool = False,
) -> list[Basis]:
    """Return degree and knots of the middle curves: as given, or all of them by a rule.

    Closed contact curves keep all knots of both: another choice would depend on where the seam is.

    Raises
    ------
    OptionError
        Given knots that are not one list of inner knots for each middle curve.
    """
    degree = middle_degree(a, b)
    if isinstance(given, str):
        if closed:
            merged = merge_breakpoints(breakpoints(a.knots), breakpoints(b.knots))
            basis = Basis(degree, clamped(merged[1:-1], degree, merged[0], merged[-1]))
        else:
            basis = middle_basis(a, b) if given == "paper" else fourth_basis(a, b)
        return [with_corners(basis, common_corners(a, b))] * count
    if len(given) != count:
        raise OptionError(
            f"middle_knots: found {len(given)} lists of inner knots, expected {count}, one for each curve"
        )
    start, end = float(a.knots[0]), float(a.knots[-1])
    bases = []
    for i, inner in enumerate(given):
        name = f"middle_knots[{i}]"
        values = np.sort(finite_array(inner, 1, name, OptionError))
        bases.append(Basis(degree, _clamped_inside(values, degree, start, end, name)))
    return bases


def common_corners(a: Basis, b: Basis) -> FloatArray:
    """Return inner knots of full multiplicity that both have: what bends there does so from one side to the other."""
    full = [knots[counts >= x.degree] for x in (a, b) for knots, counts in [_inner_counts(x)]]
    same = np.abs(full[0][:, None] - full[1]) <= MERGE_TOLERANCE * (a.knots[-1] - a.knots[0])
    return np.asarray(full[0][same.any(axis=1)])


def with_corners(basis: Basis, corners: FloatArray) -> Basis:
    """Return the basis with knots of full multiplicity at the corners."""
    if not len(corners):
        return basis
    inner, counts = _inner_counts(basis)
    apart = np.abs(inner[:, None] - corners).min(axis=1) > MERGE_TOLERANCE * (basis.knots[-1] - basis.knots[0])
    kept = np.concatenate([np.repeat(inner[apart], counts[apart]), np.repeat(corners, basis.degree)])
    return Basis(basis.degree, clamped(np.sort(kept), basis.degree, basis.knots[0], basis.knots[-1]))


def _inner_counts(basis: Basis) -> tuple[FloatArray, NDArray[np.intp]]:
    return np.unique(inner_knots(basis.knots, basis.degree), return_counts=True)


def middle_degree(a: Basis, b: Basis) -> int:
    """Return the degree of middle curves: that of both contacts, or else the lower one, but cubic at least."""
    return a.degree if a.degree == b.degree else max(_CUBIC, min(a.degree, b.degree))


def _clamped_inside(inner: FloatArray, degree: int, start: float, end: float, name: str) -> FloatArray:
    if len(inner) and not (start < inner[0] and inner[-1] < end):
        raise OptionError(f"{name}: found {inner[0]} to {inner[-1]}, expected values inside ({start}, {end})")
    knots = clamped(inner, degree, start, end)
    checked = checked_knots(knots, degree, len(knots) - degree - 1, name)
    check_knots_apart(checked, degree, name, OptionError)
    return checked


def check_knots_apart(knots: FloatArray, degree: int, name: str, error: type[InputError]) -> None:
    """Refuse knots that are distinct but count as one, of more than full multiplicity.

    Such a curve may jump within a span that no integral counts, and its basis has functions that live there alone.

    Raises
    ------
    InputError
        Of the given kind, naming the knots.
    """
    crowded = crowded_knots(knots, degree)
    if len(crowded):
        low, high = crowded[0], crowded[-1]
        at_end = low == knots[0] or high == knots[-1]
        raise error(
            f"{name}: {len(crowded)} knots from {low} to {high} are within {MERGE_TOLERANCE:g} of the domain and count "
            f"as one, expected at most {degree + at_end} for degree {degree}{' at an end' if at_end else ''}; leave "
            "out some, or take them further apart"
        )


def middle_basis(a: Basis, b: Basis) -> Basis:
    """Return degree and knots of a middle curve: neighbouring inner knots of both contacts, averaged in pairs.

    The inner knots of both are merged and made single: v_1 .. v_n. With n even they are averaged in pairs from one
    end. With n odd the paper leaves the rule open; we pair from both ends, so that the result does not depend on the
    direction of v: the middle knot stays alone, or with its two neighbours makes one mean of three.

    Source: section 3 of the paper, made total; several middle curves all take these knots.

    Examples
    --------
    >>> a, b = Basis(1, clamped([0.5], 1, 0, 1)), Basis(1, clamped([0.25, 0.75], 1, 0, 1))
    >>> inner = middle_basis(a, b).knots[2:-2]
    >>> inner
    array([0.5])
    """
    merged = merge_breakpoints(breakpoints(a.knots), breakpoints(b.knots))
    degree = middle_degree(a, b)
    return Basis(degree, clamped(_paired_means(merged[1:-1]), degree, merged[0], merged[-1]))


def fourth_basis(a: Basis, b: Basis) -> Basis:
    """Return degree and knots of a middle curve: every fourth of the knots of both contacts, alike from both ends.

    An ordinary B-spline has all knots of both anyway: these cost nothing once the blend is converted.

    Examples
    --------
    >>> a, b = Basis(1, clamped([0.5], 1, 0, 1)), Basis(1, clamped([0.1, 0.2, 0.8, 0.9], 1, 0, 1))
    >>> fourth_basis(a, b).knots[2:-2]
    array([0.2, 0.8])
    >>> a = Basis(1, clamped([0.3, 0.7], 1, 0, 1))
    >>> fourth_basis(a, b).knots[2:-2]
    array([0.2, 0.8])
    """
    merged = merge_breakpoints(breakpoints(a.knots), breakpoints(b.knots))
    degree = middle_degree(a, b)
    return Basis(degree, clamped(_every_fourth(merged[1:-1]), degree, merged[0], merged[-1]))


def _every_fourth(v: FloatArray) -> FloatArray:
    n = len(v)
    count = -(-n // 4)
    # An even number of knots has no middle one.
    count += n % 2 == 0 and count % 2 == 1
    left = [int((j + 0.5) * n / count) for j in range(count // 2)]
    return v[[*left, *[n // 2] * (count % 2), *(n - 1 - i for i in reversed(left))]]


def _paired_means(v: FloatArray) -> FloatArray:
    n = len(v)
    if n % 2 == 0:
        return np.asarray(v.reshape(-1, 2).mean(axis=1))
    # n = 1, 5, 9 ...: the middle one alone; n = 3, 7, 11 ...: the middle three together.
    in_centre = 1 if n % 4 == 1 else 3
    left = (n - in_centre) // 2
    centre = v[left : n - left].mean(keepdims=True)
    return np.concatenate([v[:left].reshape(-1, 2).mean(axis=1), centre, v[n - left :].reshape(-1, 2).mean(axis=1)])
