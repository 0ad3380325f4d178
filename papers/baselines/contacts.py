"""The two contacts as every method sees them: both bases turned so that contact is at u = 0 and v runs along it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.papers.baselines.interface import BlendTask, NotApplicableError
from semispline.solver.arrays import FloatArray
from semispline.solver.splines import (
    Basis,
    BSplineCurve,
    BSplineSurface,
    basis_matrix,
    compatible_curves,
    derivative_points,
    map_domain,
    reverse_u,
    reverse_v,
    swap_directions,
)

# Admissible alpha^2 and beta^2 in units of their natural sizes, as in `semispline.solver.blend`.
BOX = (1 / 8, 8.0)
_SAMPLES = (np.arange(64) + 0.5) / 64


@dataclass(frozen=True, eq=False)
class ContactSide:
    """One contact: position and cross derivatives along it, as splines in the blend's v.

    Attributes
    ----------
    surface : BSplineSurface
        The base, contact at u = 0, over the v-domain of a's edge.
    along : Basis
    outwards : ndarray, shape (3, n, 3)
        Control points of the base's position and first and second derivative across the contact, in the base's own
        parameter, in the direction that leaves the base.
    natural : float
        Mean distance of the contact curves over the mean |R_w|: the natural size of alpha^2.
    """

    surface: BSplineSurface
    along: Basis
    outwards: FloatArray
    natural: float

    @property
    def bounds(self) -> tuple[float, float]:
        """The box for alpha^2."""
        return self.natural * BOX[0], self.natural * BOX[1]

    def derivatives(self, v: FloatArray, order: int, along: int = 0) -> FloatArray:
        """Return the derivative of order `order` across and `along` along the contact at v, shape (K, 3)."""
        degree, knots = self.along.degree, self.along.knots
        if along > degree:
            return np.zeros((len(v), 3))
        points = derivative_points(degree, knots, self.outwards[order], along)
        return np.asarray(basis_matrix(degree - along, knots[along : len(knots) - along], v) @ points)


def contact_sides(task: BlendTask) -> tuple[ContactSide, ContactSide]:
    """Return both contacts; b is turned round where its edge runs against a's.

    Raises
    ------
    NotApplicableError
        A base is rational or semi-structured.
    """
    surfaces = oriented_bases(task)
    bases = [Basis(s.degree_v, s.knots_v) for s in surfaces]
    outwards = [_outwards(s) for s in surfaces]
    start, end = surfaces[0].domain[1]
    v = start + (end - start) * _SAMPLES
    matrices = [basis_matrix(b.degree, b.knots, v) for b in bases]
    curves = [m @ d[0] for m, d in zip(matrices, outwards, strict=True)]
    gap = float(np.linalg.norm(curves[0] - curves[1], axis=1).mean())
    speeds = [float(np.linalg.norm(m @ d[1], axis=1).mean()) for m, d in zip(matrices, outwards, strict=True)]
    first, second = (
        ContactSide(s, b, d, gap / speed) for s, b, d, speed in zip(surfaces, bases, outwards, speeds, strict=True)
    )
    return first, second


def oriented_bases(task: BlendTask) -> tuple[BSplineSurface, BSplineSurface]:
    """Return both bases with contact at u = 0, over one v-domain, running the same way; exact.

    Raises
    ------
    NotApplicableError
        A base is rational or semi-structured.
    """
    turned = []
    for base in (task.a, task.b):
        surface = base.surface
        if not isinstance(surface, BSplineSurface) or surface.weights is not None:
            raise NotApplicableError("bases: expected B-spline surfaces without weights")
        if base.edge[0] == "v":
            surface = swap_directions(surface)
        turned.append(reverse_u(surface) if base.edge[1] == "1" else surface)
    first, second = turned
    second = map_domain(second, v_range=first.domain[1])
    v = first.domain[1][0] + _SAMPLES * np.diff(first.domain[1])
    curves = [s.evaluate(np.full_like(v, s.domain[0][0]), v) for s in (first, second)]
    a, b = (curve - curve.mean(axis=0) for curve in curves)
    return first, reverse_v(second) if np.sum((a - b[::-1]) ** 2) < np.sum((a - b) ** 2) * (1 - 1e-9) else second


def on_common_knots(a: ContactSide, b: ContactSide) -> tuple[ContactSide, ContactSide]:
    """Return both sides refined to the union of their knots along the contact, and to one degree; exact."""
    sides = (a, b)
    curves = [BSplineCurve(s.along.degree, s.along.knots, row) for s in sides for row in s.surface.control_points]
    same = compatible_curves(curves)
    basis = Basis(same.degree, same.knots)
    count = len(a.surface.control_points)
    refined = [
        replace(s.surface, degree_v=same.degree, knots_v=same.knots, control_points=net)
        for s, net in zip(sides, (same.homogeneous[:count], same.homogeneous[count:]), strict=True)
    ]
    first, second = (
        replace(s, surface=r, along=basis, outwards=_outwards(r)) for s, r in zip(sides, refined, strict=True)
    )
    return first, second


def _outwards(surface: BSplineSurface) -> FloatArray:
    net, knots, degree = surface.control_points, surface.knots_u, surface.degree_u
    rows = [
        # The first control point of a derivative is its value at the clamped start; odd derivatives turn their sign.
        (-1.0) ** d * derivative_points(degree, knots, net, d)[0] if d <= degree else np.zeros(net.shape[1:])
        for d in range(3)
    ]
    return np.stack(rows)
