"""Deciding what becomes of the least energy (11) when middle curves are added, ever more of them.

A strip is a blend that does not vary along v, f its height over u. Let H be the cubic with the values and slopes that
f has at both ends. Of all f with these H has the least energy, since the integral of H'' (f - H)'' is zero. But f''
is prescribed too. With U uniform, spans h, the third function B_2 vanishes at u = 0 with its slope, and B_2'' is 3 /
h^2 there: H plus a multiple of (h^2 / 3) B_2 has any second derivative that is asked for, and the energy of that
multiple is h / 2 times the square of what H lacks. So the least energy tends to that of H as rows are added, and
never reaches it: the prescribed curvature is left in a layer of three spans.

With rows over averaged knots it is the other way round. Let e(v) be orthogonal to all splines over the averaged knots,
of length one, and f(u) the integral of P e over v. Middle rows give f nothing, so that f vanishes from the third span
on; at u = 0 it is what the contact curve has in e, which is not zero unless the curve is a spline over the averaged
knots. To come down to zero within three spans costs more, the shorter these are.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.splines import X, basis_pieces, end_derivatives
from semispline.papers.checks import clamped, contained
from semispline.papers.ledger import (
    Case,
    Check,
    Consequence,
    Formula,
    Strength,
    given,
)
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.converted_blends import pair_means
from semispline.papers.lin2014.checks.measured_energy import least_energy
from semispline.papers.lin2014.checks.printed_pairs import WITH_MIDDLE_CURVE, merged, printed_pair
from semispline.papers.lin2014.printed import CUBIC

SPAN, LENGTH = sp.symbols("h ell", positive=True)
# What H lacks of the prescribed second derivatives, and the energy that this takes at the most, beyond that of H.
LACK_0, LACK_1, EXTRA = sp.symbols("delta_0 delta_1 E_x", real=True)
EXTRA_ENERGY = Formula(sp.Eq(EXTRA, SPAN * (LACK_0**2 + LACK_1**2) / 2), (EXTRA, SPAN, LACK_0, LACK_1))
# Least energy of f over a length, from value and slope at one end to zero with its slope at the other.
VALUE, SLOPE, LEAST = sp.symbols("d_0 d_1 E_l", real=True)
TO_ZERO = Formula(
    sp.Eq(LEAST, (3 * VALUE**2 + (3 * VALUE + 2 * LENGTH * SLOPE) ** 2) / LENGTH**3), (LEAST, VALUE, SLOPE, LENGTH)
)


@cache
def _cubic_energy(length: Any, ends: tuple[Any, ...]) -> Any:
    """Return the energy of the cubic with value and slope at 0, then at `length`."""
    coefficients = sp.symbols("c_0:4")
    cubic = sum(c * X**i for i, c in enumerate(coefficients))
    slope = cubic.diff(X)
    given_ends = [cubic.subs(X, 0), slope.subs(X, 0), cubic.subs(X, length), slope.subs(X, length)]
    solved = sp.solve([a - b for a, b in zip(given_ends, ends, strict=True)], coefficients, dict=True)[0]
    return sp.factor(sp.integrate(sp.expand(cubic.subs(solved).diff(X, 2) ** 2), (X, 0, length)))


@cache
def _third_function() -> tuple[tuple[Any, Any, Any], ...]:
    """Return start, end and piece of B_2 of a clamped cubic basis with uniform spans."""
    spans = basis_pieces(CUBIC - 1, [0] * CUBIC + [i * SPAN for i in range(1, 8)])
    return tuple(
        (span.start, span.end, span.pieces[2 - span.first].as_expr())
        for span in spans
        if 0 <= 2 - span.first < len(span.pieces)
    )


def extra_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the energy of H plus multiples of the third function at each end, and that least energies lie between."""
    relation = given(formula).relation
    pieces = _third_function()
    ends = end_derivatives(2, CUBIC - 1, (SPAN, 2 * SPAN))[:, 2]
    yield Case("B_2 at u = 0: no value, no slope, second derivative 3 / h^2", list(ends) == [0, 0, 3 / SPAN**2])
    cubic = sum(c * X**i for i, c in enumerate(sp.symbols("c_0:4")))
    mixed = sum(sp.integrate(sp.expand(cubic.diff(X, 2) * piece.diff(X, 2)), (X, a, b)) for a, b, piece in pieces)
    yield Case("every cubic H: the integral of H'' B_2'' is zero", bool(sp.expand(mixed) == 0))
    own = sum(sp.integrate(sp.expand(piece.diff(X, 2) ** 2), (X, a, b)) for a, b, piece in pieces)
    true = (SPAN**2 / 3) ** 2 * own * (LACK_0**2 + LACK_1**2)
    residual = sp.expand(relation.rhs - relation.lhs + EXTRA - true)
    yield Case("every h and both ends", bool(residual == 0), residual=residual)
    for data in ((0, 0, 1, 0, 0, 1), (0, 1, 2, 3, -1, 0)):
        least = _cubic_energy(sp.Integer(1), (*data[:2], *data[3:5]))
        lacks = dict(zip((LACK_0, LACK_1), _lacks(data), strict=True))
        for m in (8, 12):
            above = (relation.rhs - relation.lhs + EXTRA).subs(lacks | {SPAN: sp.Rational(1, m - 2)})
            found = energy.end_energy(CUBIC, m, data)
            yield Case(f"{m + 1} rows, end data {data}", bool(least < found <= least + above))


def _lacks(data: tuple[int, ...]) -> tuple[Any, Any]:
    """Return the prescribed second derivatives less those of the cubic H."""
    f0, d0, s0, f1, d1, s1 = map(sp.Integer, data)
    return s0 - (6 * (f1 - f0) - 4 * d0 - 2 * d1), s1 - (6 * (f0 - f1) + 2 * d0 + 4 * d1)


EXTRA_CHECK = Check(
    extra_cases,
    Strength.GENERAL,
    "the energy of a strip that has the prescribed second derivatives, for every span h; least energies of strips",
    proof=True,
)


def attained_cases() -> Iterator[Case]:
    """Yield end data of strips, true where the least energy over all numbers of rows belongs to one of them.

    It is that of H, to which the least energies tend; a strip with that energy is H, whose second derivative at the
    ends is another one.
    """
    for label, data in (
        ("curvature at both ends", (0, 0, 1, 0, 0, 1)),
        ("a step at rest, straight at both ends", (0, 0, 0, 1, 0, 0)),
    ):
        least = _cubic_energy(sp.Integer(1), (*data[:2], *data[3:5]))
        found = [energy.end_energy(CUBIC, m, data) for m in (6, 10, 18)]
        reached = any(lack == 0 for lack in _lacks(data)) or min(found) <= least
        above = ", ".join(str(sp.Rational(value).limit_denominator(1000)) for value in found)
        yield Case(f"{label}: {above} with 7, 11, 19 rows, never {least}", bool(reached))


def to_zero_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the least energy from a value and a slope down to zero, and that it is no less than 3 d_0^2 / l^3."""
    relation = given(formula).relation
    right = relation.rhs - relation.lhs + LEAST
    residual = sp.expand(right - _cubic_energy(LENGTH, (VALUE, SLOPE, sp.Integer(0), sp.Integer(0))))
    yield Case("every length, value and slope", bool(sp.cancel(residual) == 0), residual=sp.cancel(residual))
    rest = sp.factor(right - 3 * VALUE**2 / LENGTH**3)
    yield Case("what is above 3 d_0^2 / l^3 is a square over l^3", bool(rest.is_nonnegative))


TO_ZERO_CHECK = Check(
    to_zero_cases, Strength.GENERAL, "the cubic between two ends, which has the least energy", proof=True
)


def outside_cases() -> Iterator[Case]:
    """Yield figures with a middle curve: contact curves that are no splines over the averaged knots."""
    for figure in WITH_MIDDLE_CURVE:
        averages = clamped(CUBIC, *pair_means(merged(figure)))
        outside = not any(contained(CUBIC, vector, averages) for vector in printed_pair(figure))
        yield Case(f"{figure}: neither contact curve has its knots among the averages", outside)


def rows_over_averages() -> Consequence:
    """Measure blends of the made pair with no, one and more middle curves, over the averaged knots."""
    measured: dict[str, float] = {}
    for continuity, counts in (("C2", (0, 1, 4)), ("C1", (4, 16, 64))):
        for count in counts:
            value, points = least_energy(continuity, count)
            measured[f"energy (11), {continuity}, {count} middle curves, {points} control points"] = value
    return on_surface("Blends of the made pair, every middle curve over the averaged knots", measured)


def curvature_is_lost() -> Consequence:
    """Measure C2 blends of the made pair with ever more middle curves over all knots, beside a C1 blend."""
    measured: dict[str, float] = {}
    for continuity, count in (("C2", 1), ("C2", 8), ("C2", 32), ("C1", 32)):
        value, _ = least_energy(continuity, count, all_knots=True)
        measured[f"energy (11), {continuity}, {count} middle curves"] = value
    return on_surface("Blends of the made pair, middle curves over the knots of both contacts", measured)
