"""Hartmann's parametric G^n blending: a weighted mean of pieces of the two bases.

X(v, t) = f(t) S1(v, t) + (1 - f(t)) S2(v, t), with f(t) = mu (1-t)^(n+1) / (mu (1-t)^(n+1) + (1-mu) t^(n+1)).
S1 has the contact with a at t = 0, S2 the one with b at t = 1. All derivatives of f up to order n vanish at both ends,
where f is 1 and 0, so X agrees with S1 and S2 there up to order n.

Source: E. Hartmann, Parametric G^n blending of curves and surfaces, The Visual Computer 17 (2001); reference [17] of
the paper.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from math import comb, factorial

import numpy as np
from numpy.polynomial import Polynomial

from semispline.papers.baselines.contacts import ContactSide, contact_sides
from semispline.papers.baselines.interface import BlendTask, FormulaSurface, Method, Outcome
from semispline.solver.arrays import FloatArray
from semispline.solver.splines import merge_breakpoints

# (t, v, dt, dv) -> shape (K, 3)
Piece = Callable[[FloatArray, FloatArray, int, int], FloatArray]

# How much of a base the piece inside it takes.
INSIDE = 0.5
# The weight is no polynomial; integrals over t are taken piece by piece.
_PIECES = np.arange(9) / 8


def weight(t: FloatArray, n: int, mu: float, order: int = 0) -> FloatArray:
    """Return f or a derivative of it.

    Examples
    --------
    >>> weight(np.array([0.0, 0.5, 1.0]), 2, 0.5)
    array([1. , 0.5, 0. ])
    """
    above = mu * Polynomial([1.0, -1.0]) ** (n + 1)
    below = above + (1 - mu) * Polynomial([0.0, 1.0]) ** (n + 1)
    N = [above.deriv(d)(t) if d else above(t) for d in range(order + 1)]
    D = [below.deriv(d)(t) if d else below(t) for d in range(order + 1)]
    f = [N[0] / D[0]]
    # From N = f D by Leibniz, order by order.
    for d in range(1, order + 1):
        f.append((N[d] - sum(comb(d, i) * f[i] * D[d - i] for i in range(d))) / D[0])
    return np.asarray(f[order])


def extended(side: ContactSide, scale: float) -> Piece:
    """Return the base continued past its contact by its Taylor polynomial of order 2; t = 0 on the contact."""

    def piece(t: FloatArray, v: FloatArray, dt: int, dv: int) -> FloatArray:
        total = np.zeros((len(t), 3))
        for k in range(dt, 3):
            power = scale**k * t ** (k - dt) / factorial(k - dt)
            total += power[:, None] * side.derivatives(v, k, dv)
        return total

    return piece


def inside(side: ContactSide, share: float) -> Piece:
    """Return a part of the base itself; t = 0 on the contact."""
    start, end = side.surface.domain[0]
    length = share * (end - start)

    def piece(t: FloatArray, v: FloatArray, dt: int, dv: int) -> FloatArray:
        return length**dt * side.surface.evaluate(start + length * t, v, dt, dv)

    return piece


def combined(first: Piece, second: Piece, n: int, mu: float) -> Piece:
    """Return X from two pieces that both have t = 0 on their contact; X has t = 1 on the second."""

    def blended(t: FloatArray, v: FloatArray, dt: int, dv: int) -> FloatArray:
        total = np.zeros((len(t), 3))
        for i in range(dt + 1):
            f = weight(t, n, mu, i)
            rest = 1 - f if i == 0 else -f
            j = dt - i
            one, two = first(t, v, j, dv), (-1.0) ** j * second(1 - t, v, j, dv)
            total += comb(dt, i) * (f[:, None] * one + rest[:, None] * two)
        return total

    return blended


def blend_hartmann(variant: str, task: BlendTask, n: int = 2, mu: float = 0.5) -> Outcome:
    """Blend pieces inside the bases, or the bases continued past their contacts.

    Parameters
    ----------
    variant : {"inside", "extended"}
    task : BlendTask
    n : int
        Order of contact; at most 2 for extended pieces.
    mu : float
        Between 0 and 1: which piece has more weight.
    """
    a, b = contact_sides(task)
    started = time.perf_counter()
    breaks = [_PIECES]
    if variant == "inside":
        pieces = inside(a, INSIDE), inside(b, INSIDE)
        for side, turned in ((a, False), (b, True)):
            start, end = side.surface.domain[0]
            inner = (side.surface.breakpoints[0] - start) / (INSIDE * (end - start))
            inner = inner[inner < 1]
            breaks.append(1 - inner if turned else inner)
    else:
        pieces = extended(a, a.natural), extended(b, b.natural)
    surface = FormulaSurface(
        combined(*pieces, n, mu),
        merge_breakpoints(_PIECES, *breaks),
        merge_breakpoints(a.surface.breakpoints[1], b.surface.breakpoints[1]),
    )
    scales = (None, None) if variant == "inside" else (a.natural, b.natural)
    return Outcome(surface, None, None, time.perf_counter() - started, *scales)


METHODS = (
    Method(
        "hartmann-inside",
        "Hartmann G2, pieces inside the bases",
        "reference [17] of the paper, as its Fig. 7 shows it",
        40,
        partial(blend_hartmann, "inside"),
    ),
    Method(
        "hartmann-extended",
        "Hartmann G2, bases continued",
        "reference [17] of the paper, each base continued by its Taylor polynomial of order 2",
        41,
        partial(blend_hartmann, "extended"),
    ),
)
