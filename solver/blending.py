"""The whole solve, from two bases to a checked blend: stages with input and output, one after the other."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from solver.arrays import FloatArray
from solver.continuity import Base, Contact, Flip, corresponding_samples, measure_contact
from solver.errors import ContactError, OptionError
from solver.gram import thin_plate_energy
from solver.problem import BlendProblem, make_problem
from solver.sides import Continuity, Side, make_side
from solver.surfaces import BSplineCurve, SemiStructuredSurface

Method: TypeAlias = Literal["casadi"]

# What the referee must confirm; rounding of the input is allowed on top (see `Contact.rounding`).
GAP_LIMIT = 1e-11  # of the size of the model
RESIDUAL_LIMIT = 1e-11  # of the largest derivative
ANGLE_LIMIT = 1e-9  # degrees
JUMP_LIMIT = 1e-9  # of the largest curvature across the edge
# The bound on rounding counts each control point once; a few operations follow before it is measured.
_ROUNDINGS = 8.0


@dataclass(frozen=True, eq=False)
class BlendResult:
    """A blend of two bases, with what was measured of it.

    Attributes
    ----------
    surface : SemiStructuredSurface
        u = 0 on a, u = 1 on b; the v-domain is that of a's edge.
    continuity : (str, str)
        Asked for and confirmed at a and at b.
    method : str
        "linear" where nothing but a linear solve was needed.
    energy : float
        Thin-plate energy (11) over [0, 1] x the v-domain.
    alpha2, beta2 : float or None
        Of (2.1) and (2.2), the bases in their own parameters; 1 for C1 and C2, None for C0 and G0.
    alpha2_bounds, beta2_bounds : (float, float) or None
        The admissible box; None where there is no such unknown.
    active_bounds : tuple of str
        Which bounds stopped the search, such as "alpha2 lower".
    flipped : bool
        Whether edge b runs against edge a.
    contact_a, contact_b : Contact
        Judged by the de Boor referee.
    iterations : int
        Of the nonlinear solver; 0 for a linear solve.
    kkt_residual : float or None
        Largest entry of the gradient of the Lagrangian, scaled; None for a linear solve.
    seconds : float
        For the solve, without the final check.
    """

    surface: SemiStructuredSurface
    continuity: tuple[Continuity, Continuity]
    method: str
    energy: float
    alpha2: float | None
    beta2: float | None
    alpha2_bounds: tuple[float, float] | None
    beta2_bounds: tuple[float, float] | None
    active_bounds: tuple[str, ...]
    flipped: bool
    contact_a: Contact
    contact_b: Contact
    iterations: int
    kkt_residual: float | None
    seconds: float


def blend(
    a: Base,
    b: Base,
    *,
    continuity: Continuity | tuple[Continuity, Continuity] = "G2",
    middle_curves: int = 1,
    degree_u: int = 3,
    method: Method = "casadi",
    flip: Flip = "auto",
) -> BlendResult:
    """Blend two B-spline surfaces with a semi-structured surface of least thin-plate energy.

    Parameters
    ----------
    a, b : Base
        Polynomial B-spline surfaces and the edges to be joined. Neither is changed.
    continuity : {"C0", "C1", "C2", "G0", "G1", "G2"} or a pair of them
        At a and at b.
    middle_curves : int
        Number of v-control curves between the three of each contact.
    degree_u : int
        Degree of the blend across, p = k - 1.
    method : {"casadi"}
        How alpha and beta are found where contact is geometric.
    flip : {"auto", "yes", "no"}
        Whether edge b runs against edge a; "auto" takes the way without a twist.

    Returns
    -------
    BlendResult

    Raises
    ------
    OptionError, EdgeError
        An option or a base that cannot be used.
    ComputationError
        The solver failed.
    ContactError
        The referee found the contact worse than its limits.

    Source: section 3 and equation (11) of the paper; contact conditions from `derivations.contact`.

    Examples
    --------
    >>> import numpy as np
    >>> k = [0, 0, 1, 1]
    >>> floor = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> wall = BSplineSurface(1, 1, k, k, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]])
    >>> result = blend(Base(floor, "u1"), Base(wall, "u0"), continuity="C2", middle_curves=0)
    >>> result.surface.n_control_points
    12
    """
    started = time.perf_counter()
    pair: tuple[Continuity, Continuity] = (continuity, continuity) if isinstance(continuity, str) else continuity
    _check_options(pair, method)
    side_a, side_b, flipped = _contacts(a, b, pair, flip)
    centre, size = _frame(side_a, side_b)
    problem = make_problem(side_a.moved(centre, size), side_b.moved(centre, size), degree_u, middle_curves)
    shape = _shape_parameters(problem, method)
    surface = _surface(problem, shape, side_a, side_b, centre, size)
    energy = thin_plate_energy(surface)
    seconds = time.perf_counter() - started
    contact_a, contact_b = _checked_contacts(a, b, surface, pair, flipped, shape)
    bounds = problem.bounds
    return BlendResult(
        surface=surface,
        continuity=pair,
        method=shape.method,
        energy=energy,
        alpha2=None if side_a.order == 0 else shape.a,
        beta2=None if side_b.order == 0 else shape.b,
        alpha2_bounds=bounds[0] if side_a.has_shape_parameter else None,
        beta2_bounds=bounds[1] if side_b.has_shape_parameter else None,
        active_bounds=_active_bounds(problem, shape),
        flipped=flipped,
        contact_a=contact_a,
        contact_b=contact_b,
        iterations=shape.iterations,
        kkt_residual=shape.kkt_residual,
        seconds=seconds,
    )


@dataclass(frozen=True)
class _Shape:
    a: float
    b: float
    method: str
    iterations: int = 0
    kkt_residual: float | None = None


def _check_options(continuity: tuple[Continuity, Continuity], method: Method) -> None:
    if len(continuity) != 2:
        raise OptionError(f"continuity: found {continuity!r}, expected one of C0..G2 or a pair of them")
    if method not in get_args(Method):
        raise OptionError(f"method: found {method!r}, expected one of {', '.join(get_args(Method))}")


def _contacts(a: Base, b: Base, continuity: tuple[Continuity, Continuity], flip: Flip) -> tuple[Side, Side, bool]:
    """Both contacts in the blend's parameter v, b turned round where its edge runs against a's."""
    side_a = make_side(a, continuity[0])
    make_side(b, continuity[1])  # refuses a bad base before its edge is looked at
    *_, flipped = corresponding_samples(a, b, flip)
    return side_a, make_side(b, continuity[1], a.range_along, flipped), flipped


def _frame(a: Side, b: Side) -> tuple[FloatArray, float]:
    """Centre and size of the control points that contact reads: the solve works in coordinates of size 1."""
    points = np.concatenate([a.rows.reshape(-1, 3), b.rows.reshape(-1, 3)])
    low, high = points.min(axis=0), points.max(axis=0)
    return (low + high) / 2, float((high - low).max()) or 1.0


def _shape_parameters(problem: BlendProblem, method: Method) -> _Shape:
    """Find alpha^2 and beta^2 of least energy; where contact is parametric there is nothing to find."""
    if not (problem.a.has_shape_parameter or problem.b.has_shape_parameter):
        return _Shape(*problem.start, method="linear")
    from solver.nlp import solve_constrained

    found = solve_constrained(problem)
    return _Shape(found.a, found.b, method, found.iterations, found.kkt_residual)


def _surface(
    problem: BlendProblem, shape: _Shape, a: Side, b: Side, centre: FloatArray, size: float
) -> SemiStructuredSurface:
    """Set the prescribed rows anew from alpha and beta, solve for the free ones, and go back to model units."""
    points = problem.control_points(shape.a, shape.b) * size + centre
    pieces = np.split(points, problem.form.offsets[1:-1])
    # The contact curves themselves are the bases' own, to the last bit.
    pieces[0], pieces[-1] = a.rows[0], b.rows[0]
    curves = [
        BSplineCurve(row.degree, row.knots, piece, name=f"control_curves[{i}]")
        for i, (row, piece) in enumerate(zip(problem.form.rows, pieces, strict=True))
    ]
    return SemiStructuredSurface(problem.form.u.degree, problem.form.u.knots, tuple(curves))


def _active_bounds(problem: BlendProblem, shape: _Shape) -> tuple[str, ...]:
    active = []
    for name, side, value, (low, high) in zip(
        ("alpha2", "beta2"), (problem.a, problem.b), (shape.a, shape.b), problem.bounds, strict=True
    ):
        if side.has_shape_parameter:
            # An interior-point method stops a little inside of a bound.
            active += [f"{name} lower"] * (value <= low * (1 + 1e-6)) + [f"{name} upper"] * (value >= high * (1 - 1e-6))
    return tuple(active)


def _checked_contacts(
    a: Base,
    b: Base,
    surface: SemiStructuredSurface,
    continuity: tuple[Continuity, Continuity],
    flipped: bool,
    shape: _Shape,
) -> tuple[Contact, Contact]:
    """Let the referee measure both contacts, and refuse a result that misses its limits."""
    contact_a = measure_contact(a, Base(surface, "u0"), flip="no")
    contact_b = measure_contact(Base(surface, "u1"), b, flip="yes" if flipped else "no")
    for name, contact, wanted in (("a", contact_a, continuity[0]), ("b", contact_b, continuity[1])):
        for measure, value, limit in required_limits(contact, wanted):
            if not value <= limit:
                raise ContactError(
                    f"contact {name}: {measure} is {value:.3g}, expected at most {limit:.3g} for {wanted}; "
                    "try fewer middle curves, or bases whose knots are not so close"
                )
    return contact_a, contact_b


def required_limits(contact: Contact, continuity: Continuity) -> list[tuple[str, float, float]]:
    """Return name, measured value and limit of each measure that `continuity` requires.

    Source: the measures of the design document; rounding of the input is allowed on top of each limit.
    """
    measures = {
        "C0": ("gap",),
        "C1": ("gap", "c1_residual"),
        "C2": ("gap", "c1_residual", "c2_residual"),
        "G0": ("gap",),
        "G1": ("gap", "angle_degrees"),
        "G2": ("gap", "angle_degrees", "curvature_jump_relative"),
    }[continuity]
    limits = {
        "gap": GAP_LIMIT * contact.size,
        "c1_residual": RESIDUAL_LIMIT,
        "c2_residual": RESIDUAL_LIMIT,
        "angle_degrees": ANGLE_LIMIT,
        "curvature_jump_relative": JUMP_LIMIT,
    }
    return [(m, getattr(contact, m), limits[m] + _ROUNDINGS * contact.rounding[m]) for m in measures]
