"""Bloor and Wilson's blends between closed contact curves: solutions of an elliptic equation, mode by mode.

(d_u^2 + s^2 d_v^2)^k X = 0 over u in [0, 1] and the angle v, with k = 2 and X, X_u given at both ends, or k = 3 and
X, X_u, X_uu given. Fourier mode n is a combination of u^j e^(s n (u-1)) and u^j e^(-s n u), j < k; mode 0 a polynomial
of degree 2k - 1. What the modes leave of the boundary data gets one more term of the same form, as the authors do, so
that the contact is exact; that term alone does not satisfy the equation.

Source: M. Bloor, M. Wilson, Generating blend surfaces using partial differential equations, CAD 21 (1989); references
[14, 15] of the paper.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial
from math import factorial, perm, pi

import numpy as np

from semispline.papers.baselines.contacts import ContactSide, contact_sides
from semispline.papers.baselines.interface import BlendTask, FormulaSurface, Method, NotApplicableError, Outcome
from semispline.solver.arrays import FloatArray
from semispline.solver.splines import merge_breakpoints

MODES = 24
_SAMPLES = 1024
# The exponentials fall within a span of about 1 / (s n); integrals over u are taken piece by piece.
_PIECES = np.arange(9) / 8


@dataclass(frozen=True, eq=False)
class ModeFunctions:
    """The 2k solutions of (d_u^2 - r^2)^k y = 0 that have one boundary value 1 and the others 0.

    Attributes
    ----------
    k : int
    rate : float
        r = s n.
    solution : ndarray, shape (2k, 2k)
        Column i gives the i-th of them by the fundamental solutions; boundary values in the order y, y', .. at 0, then
        at 1.
    """

    k: int
    rate: float
    solution: FloatArray

    def values(self, u: FloatArray, order: int) -> FloatArray:
        """Return derivatives of all 2k of them, shape (K, 2k)."""
        return fundamental(self.k, self.rate, u, order) @ self.solution


def fundamental(k: int, rate: float, u: FloatArray, order: int) -> FloatArray:
    """Return derivatives of the fundamental solutions, shape (K, 2k): exponentials, or powers of u where rate is 0."""
    columns = []
    if rate == 0:
        for j in range(2 * k):
            columns.append(perm(j, order) * u ** max(j - order, 0) if j >= order else np.zeros_like(u))
        return np.stack(columns, axis=1)
    for signed, at in ((rate, u - 1), (-rate, u)):
        for j in range(k):
            # Leibniz: derivatives of u^j end at order j.
            total = np.zeros_like(u)
            for i in range(min(j, order) + 1):
                binomial = factorial(order) // (factorial(i) * factorial(order - i))
                total += binomial * perm(j, i) * u ** (j - i) * signed ** (order - i)
            columns.append(total * np.exp(signed * at))
    return np.stack(columns, axis=1)


def mode_functions(k: int, rate: float) -> ModeFunctions:
    """Solve for the functions with unit boundary values."""
    lines = [fundamental(k, rate, np.array([end]), order)[0] for end in (0.0, 1.0) for order in range(k)]
    return ModeFunctions(k, rate, np.linalg.inv(np.stack(lines)))


def boundary_data(a: ContactSide, b: ContactSide, k: int, v: FloatArray, along: int) -> FloatArray:
    """Return X, X_u, .. at u = 0 and then at u = 1, or their derivatives along v, shape (2k, K, 3)."""
    start = [a.natural**d * a.derivatives(v, d, along) for d in range(k)]
    end = [(-b.natural) ** d * b.derivatives(v, d, along) for d in range(k)]
    return np.stack([*start, *end])


def blend_pde(k: int, task: BlendTask) -> Outcome:
    """Blend two closed contact curves; k = 2 is the fourth order, k = 3 the sixth.

    The smoothing parameter s is the mean gap over the mean radius, so that the equation is that of the true lengths;
    cross derivatives are of natural size.

    Raises
    ------
    NotApplicableError
        A contact curve is open.
    """
    if not task.closed:
        raise NotApplicableError("contact curves: open, but the equation is solved for closed ones, by Fourier modes")
    a, b = contact_sides(task)
    started = time.perf_counter()
    start, end = a.surface.domain[1]
    turn = 2 * pi / (end - start)
    v = start + (end - start) * np.arange(_SAMPLES) / _SAMPLES
    data = boundary_data(a, b, k, v, 0)
    speeds = [np.linalg.norm(side.derivatives(v, 0, 1), axis=1).mean() / turn for side in (a, b)]
    gap = float(np.linalg.norm(data[0] - data[k], axis=1).mean())
    smoothing = gap / float(np.mean(speeds))
    coefficients = np.fft.rfft(data, axis=1)[:, : MODES + 1] / _SAMPLES
    coefficients[:, 1:] *= 2
    functions = [mode_functions(k, smoothing * n) for n in range(MODES + 2)]
    surface = FormulaSurface(
        partial(_point, (a, b), k, start, turn, coefficients, functions),
        _PIECES,
        merge_breakpoints(a.surface.breakpoints[1], b.surface.breakpoints[1]),
    )
    seconds = time.perf_counter() - started
    note = f"{MODES} modes and a remainder; smoothing parameter {smoothing:.3g}"
    return Outcome(surface, None, None, seconds, a.natural, b.natural, note=note)


def _point(
    sides: tuple[ContactSide, ContactSide],
    k: int,
    start: float,
    turn: float,
    coefficients: np.ndarray,
    functions: list[ModeFunctions],
    u: FloatArray,
    v: FloatArray,
    du: int,
    dv: int,
) -> FloatArray:
    remainder = boundary_data(*sides, k, v, dv)
    total = np.zeros((len(u), 3))
    for n in range(MODES + 1):
        wave = (1j * n * turn) ** dv * np.exp(1j * n * turn * (v - start))
        boundary = np.real(wave[None, :, None] * coefficients[:, n, None, :])
        remainder -= boundary
        total += np.einsum("ki,ikd->kd", functions[n].values(u, du), boundary)
    return np.asarray(total + np.einsum("ki,ikd->kd", functions[MODES + 1].values(u, du), remainder))


METHODS = (
    Method(
        "bloor-wilson-4",
        "Bloor-Wilson, fourth order",
        "references [14, 15] of the paper: position and tangent given",
        50,
        partial(blend_pde, 2),
    ),
    Method(
        "bloor-wilson-6",
        "Bloor-Wilson, sixth order",
        "references [14, 15] of the paper: position, tangent and second derivative given",
        51,
        partial(blend_pde, 3),
    ),
)
