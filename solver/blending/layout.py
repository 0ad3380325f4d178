"""Where the knots of a blend lie: U, and V_i of every v-control curve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from semispline.solver.arrays import FloatArray, finite_array
from semispline.solver.errors import InputError, OptionError
from semispline.solver.scalars import whole_number
from semispline.solver.splines import (
    MERGE_TOLERANCE,
    Basis,
    breakpoints,
    checked_knots,
    clamped,
    crowded_knots,
    merge_breakpoints,
    uniform_knots,
)

# More than any blend needs; the energy in u is held in full.
MOST_MIDDLE_CURVES = 1000
# Rows that each contact owns: position, first and second derivative.
ROWS_PER_SIDE = 3
# Below it second derivatives in u vanish: creases across would cost nothing, and free rows would be undetermined.
_LEAST_DEGREE = 2


def blend_u_basis(degree_u: int, middle_curves: int, inner: Sequence[float] | None = None) -> Basis:
    """Return U: clamped on [0, 1], for 6 + `middle_curves` rows; inner knots uniform unless given.

    Raises
    ------
    OptionError
        A negative number of middle curves, a degree below 2 or too high for the number of rows, or knots that do not
        fit.

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
    rows = 2 * ROWS_PER_SIDE + middle_curves
    if not _LEAST_DEGREE <= degree_u < rows:
        raise OptionError(
            f"degree_u: found {degree_u}, expected {_LEAST_DEGREE} to {rows - 1} with {middle_curves} middle curve(s)"
        )
    if inner is None:
        return Basis(degree_u, uniform_knots(degree_u, rows - degree_u))
    given = np.sort(finite_array(inner, 1, "u_knots", OptionError))
    if len(given) != rows - degree_u - 1:
        raise OptionError(f"u_knots: found {len(given)} inner knots, expected {rows - degree_u - 1} for {rows} rows")
    return Basis(degree_u, _clamped_inside(given, degree_u, 0.0, 1.0, "u_knots"))


def middle_bases(
    a: Basis, b: Basis, count: int, given: Sequence[Sequence[float]] | None = None, *, closed: bool = False
) -> list[Basis]:
    """Return degree and knots of the middle curves: as given, else all of them by `middle_basis`.

    Closed contact curves keep all knots of both: pairs would depend on where the seam is.

    Raises
    ------
    OptionError
        Given knots that are not one list of inner knots for each middle curve.
    """
    if given is None and closed:
        merged = merge_breakpoints(breakpoints(a.knots), breakpoints(b.knots))
        return [Basis(a.degree, clamped(merged[1:-1], a.degree, merged[0], merged[-1]))] * count
    if given is None:
        return [middle_basis(a, b)] * count
    if len(given) != count:
        raise OptionError(
            f"middle_knots: found {len(given)} lists of inner knots, expected {count}, one for each curve"
        )
    start, end = float(a.knots[0]), float(a.knots[-1])
    bases = []
    for i, inner in enumerate(given):
        name = f"middle_knots[{i}]"
        values = np.sort(finite_array(inner, 1, name, OptionError))
        bases.append(Basis(a.degree, _clamped_inside(values, a.degree, start, end, name)))
    return bases


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
    return Basis(a.degree, clamped(_paired_means(merged[1:-1]), a.degree, merged[0], merged[-1]))


def _paired_means(v: FloatArray) -> FloatArray:
    n = len(v)
    if n % 2 == 0:
        return np.asarray(v.reshape(-1, 2).mean(axis=1))
    # n = 1, 5, 9 ...: the middle one alone; n = 3, 7, 11 ...: the middle three together.
    in_centre = 1 if n % 4 == 1 else 3
    left = (n - in_centre) // 2
    centre = v[left : n - left].mean(keepdims=True)
    return np.concatenate([v[:left].reshape(-1, 2).mean(axis=1), centre, v[n - left :].reshape(-1, 2).mean(axis=1)])
