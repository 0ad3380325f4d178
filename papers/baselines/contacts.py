"""The two contacts as every method sees them: both bases turned so that contact is at u = 0 and v runs along it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

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
_POLYNOMIAL = "bases: found a rational one, but this method takes polynomial B-spline surfaces only"
_SAMPLES = (np.arange(64) + 0.5) / 64


@dataclass(frozen=True, eq=False)
class ContactSide:
    """One contact: position and cross derivatives along it, in the blend's v.

    Attributes
    ----------
    surface : BSplineSurface
        The base, contact at u = 0, over the v-domain of a's edge; rational ones too.
    natural : float
        Mean distance of the contact curves over the mean |R_w|: the natural size of alpha^2.
    """

    surface: BSplineSurface
    natural: float

    @property
    def along(self) -> Basis:
        """Of the base along the contact."""
        return Basis(self.surface.degree_v, self.surface.knots_v)

    @cached_property
    def outwards(self) -> FloatArray:
        """Control points of the base's position and first and second derivative across the contact, shape (3, n, 3).

        In the base's own parameter, in the direction that leaves the base; of polynomial bases only.
        """
        if self.surface.weights is not None:
            raise NotApplicableError(_POLYNOMIAL)
        return _outwards(self.surface)

    @property
    def bounds(self) -> tuple[float, float]:
        """The box for alpha^2."""
        return self.natural * BOX[0], self.natural * BOX[1]

    def derivatives(self, v: FloatArray, order: int, along: int = 0) -> FloatArray:
        """Return the derivative of order `order` across and `along` along the contact at v, shape (K, 3)."""
        if self.surface.weights is not None:
            contact = np.full_like(v, self.surface.domain[0][0])
            return (-1.0) ** order * self.surface.evaluate(contact, v, order, along)
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
        A base is semi-structured.
    """
    sides = [ContactSide(surface, 1.0) for surface in oriented_bases(task)]
    start, end = sides[0].surface.domain[1]
    v = start + (end - start) * _SAMPLES
    curves = [side.derivatives(v, 0) for side in sides]
    gap = float(np.linalg.norm(curves[0] - curves[1], axis=1).mean())
    speeds = [float(np.linalg.norm(side.derivatives(v, 1), axis=1).mean()) for side in sides]
    first, second = (replace(side, natural=gap / speed) for side, speed in zip(sides, speeds, strict=True))
    return first, second


def polynomial_sides(task: BlendTask) -> tuple[ContactSide, ContactSide]:
    """Return both contacts for a method that works on control points.

    Raises
    ------
    NotApplicableError
        A base is rational or semi-structured.
    """
    require_polynomial(task)
    return contact_sides(task)


def require_polynomial(task: BlendTask) -> None:
    """Refuse rational bases for a method that does not know weights.

    Raises
    ------
    NotApplicableError
        A base is rational.
    """
    if any(isinstance(b.surface, BSplineSurface) and b.surface.weights is not None for b in (task.a, task.b)):
        raise NotApplicableError(_POLYNOMIAL)


def oriented_bases(task: BlendTask) -> tuple[BSplineSurface, BSplineSurface]:
    """Return both bases with contact at u = 0, over one v-domain, running the same way; exact.

    Raises
    ------
    NotApplicableError
        A base is semi-structured.
    """
    turned = []
    for base in (task.a, task.b):
        surface = base.surface
        if not isinstance(surface, BSplineSurface):
            raise NotApplicableError("bases: found a semi-structured one, expected B-spline surfaces")
        if base.side[0] == "v":
            surface = swap_directions(surface)
        turned.append(reverse_u(surface) if base.side[1] == "1" else surface)
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
    count = len(a.surface.control_points)
    refined = [
        replace(s.surface, degree_v=same.degree, knots_v=same.knots, control_points=net)
        for s, net in zip(sides, (same.homogeneous[:count], same.homogeneous[count:]), strict=True)
    ]
    first, second = (replace(s, surface=r) for s, r in zip(sides, refined, strict=True))
    return first, second


def _outwards(surface: BSplineSurface) -> FloatArray:
    net, knots, degree = surface.control_points, surface.knots_u, surface.degree_u
    rows = [
        # The first control point of a derivative is its value at the clamped start; odd derivatives turn their sign.
        (-1.0) ** d * derivative_points(degree, knots, net, d)[0] if d <= degree else np.zeros(net.shape[1:])
        for d in range(3)
    ]
    return np.stack(rows)
