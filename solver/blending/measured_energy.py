"""The thin-plate energy of a finished surface: exact up to rounding where it is polynomial, else by quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.rational_energy import RationalForm
from semispline.solver.splines import Basis, BSplineSurface, Surface, euclidean, homogeneous_points, same_width


@dataclass(frozen=True)
class MeasuredEnergy:
    """The thin-plate energy (11) of a surface.

    Attributes
    ----------
    value : float
    quadrature_error : float or None
        In the unit of the value: how far a rule of half the nodes is off, so that the value is far better; None where
        the surface is polynomial and its integrals are exact.
    """

    value: float
    quadrature_error: float | None


def measure_energy(surface: Surface) -> MeasuredEnergy:
    """Measure the thin-plate energy (11), span by span.

    It is a sum of squares of second derivatives, which keeps its accuracy where the quadratic form p'Hp cancels.

    Source: equation (11).
    """
    u = Basis(surface.degree_u, surface.knots_u)
    if isinstance(surface, BSplineSurface):
        rows = (Basis(surface.degree_v, surface.knots_v),) * len(surface.control_points)
        points = list(surface.homogeneous)
    else:
        rows = tuple(Basis(c.degree, c.knots) for c in surface.control_curves)
        points = same_width(*(homogeneous_points(c.control_points, c.weights) for c in surface.control_curves))
    net = np.concatenate(points)
    if net.shape[1] == 3:
        return MeasuredEnergy(float(EnergyForm(u, rows).products(net[None])[0, 0]), None)
    # Far from the origin numerators would lose what the surface is: X - W c is the surface less c.
    centre = euclidean(net)[0].mean(axis=0)
    numerators = net[:, :3] - net[:, 3:] * centre
    coarse, fine = (float(RationalForm(u, rows, net[:, 3], finer).products(numerators[None])[0, 0]) for finer in (1, 2))
    return MeasuredEnergy(fine, abs(fine - coarse))


def thin_plate_energy(surface: Surface) -> float:
    """Return the thin-plate energy (11), span by span; exact up to rounding where the surface is polynomial.

    That of a rational surface is no polynomial integral: it is taken by a Gauss rule (`measure_energy` says how well).

    Source: equation (11).

    Examples
    --------
    >>> saddle = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]])
    >>> round(thin_plate_energy(saddle), 12)
    2.0
    """
    return measure_energy(surface).value
