"""What rounding of the control points may do to the energy: across a span h it bends a surface by 1e-16 / h^2."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.shape_parameters import Found
from semispline.solver.splines import SemiStructuredSurface, breakpoints

# An energy that rounding may change by more than this fraction is said to be rounding, and nothing is proved of it.
ROUNDING_SHARE = 1e-3
# Energies below this fraction of that of a surface that bends by its own size count as zero, as for flat blends.
_ZERO_ENERGY = 1e-12


@dataclass(frozen=True, eq=False)
class EnergyRounding:
    """How much of the energy of a blend may be rounding of its control points.

    Attributes
    ----------
    energy : float
        By how much the thin-plate energy (11) may be off.
    share : float
        The same as a fraction, of that energy or of the one that was minimised, whichever is worse.
    """

    energy: float
    share: float

    @property
    def matters(self) -> bool:
        """Whether the energy is not to be believed."""
        return self.share > ROUNDING_SHARE


def measure_energy_rounding(
    problem: BlendProblem, found: Found, surface: SemiStructuredSurface, frame: tuple[FloatArray, float], energy: float
) -> EnergyRounding:
    """Bound what errors of 1e-16 of the largest coordinate, in all points of the blend and its bases, do to the energy.

    Parameters
    ----------
    problem : BlendProblem
    found : Found
        The shape parameters of the blend.
    surface : SemiStructuredSurface
        The blend, model units.
    frame : (ndarray of shape (3,), float)
        Centre and size of the coordinates of `problem`.
    energy : float
        Thin-plate energy (11) of the blend, model units.
    """
    centre, size = frame
    points = np.concatenate([curve.control_points for curve in surface.control_curves])
    sides = np.concatenate([side.points() for side in (problem.a, problem.b)]) * size + centre
    errors = np.finfo(float).eps * np.maximum(np.abs(points).max(axis=0), np.abs(sides).max(axis=0))
    own = problem.form if problem.form.rows is problem.rows else EnergyForm(problem.form.u, problem.rows)
    # Of the surface as it is, and with v stretched as in the energy that is minimised; vv, uv, uu stretch unlike.
    stretch = (_length(problem.form) / _length(own)) ** np.array([-3.0, -1.0, 1.0])
    largest = _error_factors(problem, found)
    parts = own.error_energies(largest) * float(np.sum(errors**2))
    least = energy * float(stretch.min())
    floor, minimised_floor = (_ZERO_ENERGY * _bent(form) * size**2 for form in (own, problem.form))
    change = _change(energy, float(parts.sum()))
    share = max(change / max(energy, floor), _change(least, float(parts @ stretch)) / max(least, minimised_floor))
    if share <= ROUNDING_SHARE:
        return EnergyRounding(change, share)
    # Only where that is not enough: place by place.
    change = own.change_by_errors(points - centre, errors, largest)
    share = change / max(energy, floor)
    if own is not problem.form:
        minimised = float(problem.form.products(points[None] - centre)[0, 0])
        change_there = problem.form.change_by_errors(points - centre, errors, largest)
        share = max(share, change_there / max(minimised, minimised_floor))
    return EnergyRounding(change, share)


def _error_factors(problem: BlendProblem, found: Found) -> FloatArray:
    """Return how much larger than in the bases errors are in each row, shape (m + 1,); 1 for free rows.

    Prescribed rows are combinations of rows of the bases, with large weights of both signs where these have a narrow
    span beside the edge.
    """
    factors = np.ones(len(problem.rows))
    for (side, rows, spans), a, p2 in zip(problem.contacts, (found.a, found.b), found.p2, strict=True):
        # The combinations themselves: of rows (1, 0, ..), (0, 1, ..) and so on.
        weights = replace(side, rows=np.eye(side.count)[:, None])
        # Where linear in v the weights are largest at an end.
        largest, second = float(np.max(a)), float(np.max(np.abs(p2)))
        sums = np.abs(weights.contact_rows(largest, problem.form.u.degree, spans, second)).sum(axis=(1, 2))
        factors[rows[: side.order + 1]] = np.maximum(sums, 1.0)
    return factors


def _change(energy: float, errors: float) -> float:
    """Bound the change of an energy by errors of an energy of their own: its root is a norm."""
    return float(2 * np.sqrt(energy * errors) + errors)


def _length(form: EnergyForm) -> float:
    return float(form.rows[0].knots[-1] - form.rows[0].knots[0])


def _bent(form: EnergyForm) -> float:
    """Return the energy of a surface all of whose second derivatives over the unit square are 1."""
    length = _length(form)
    return length + 2 / length + 1 / length**3


def rounding_warning(rounding: EnergyRounding, surface: SemiStructuredSurface, energy: float) -> tuple[str, ...]:
    """Return a warning where the energy is made of rounding."""
    if not rounding.matters:
        return ()
    rows = (breakpoints(curve.knots) for curve in surface.control_curves)
    fraction, width, place = min(
        (width / float(breaks[-1] - breaks[0]), width, f"{name} = {at:g}")
        for name, breaks in (("u", surface.breakpoints[0]), *(("v", row) for row in rows))
        for width, at in zip(np.diff(breaks).tolist(), breaks.tolist(), strict=False)
    )
    return (
        f"the energy {energy:.3g} may be off by {rounding.energy:.2g} where control points round, and is not proved: "
        f"the narrowest span, at {place}, is {width:.1e} long, {fraction:.1e} of the domain; take knots further apart, "
        "or work nearer to the origin",
    )
