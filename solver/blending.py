"""The whole solve, from two bases to a checked blend: stages with input and output, one after the other."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from solver.arrays import FloatArray
from solver.certificate import check_certificate
from solver.continuity import Base, Contact, Flip, corresponding_samples, measure_contact
from solver.errors import ContactError, OptionError
from solver.gram import thin_plate_energy
from solver.problem import BlendProblem, ProblemOptions, make_problem
from solver.regularity import Regularity, measure_regularity
from solver.shape_search import Certificate
from solver.sides import Continuity, Side, make_side
from solver.surfaces import BSplineCurve, SemiStructuredSurface

Method: TypeAlias = Literal["reduced", "casadi", "bfgs"]
Shape: TypeAlias = float | Literal["free", "natural"]

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
    regularity : Regularity
        How far the blend is from folding.
    iterations : int
        Of the nonlinear solver; 0 where there is none.
    kkt_residual : float or None
        Largest entry of the gradient of the Lagrangian, scaled; only for method casadi.
    certificate : Certificate or None
        Proof that no admissible alpha and beta have less energy, in coordinates of size 1; only for method reduced.
    proven_gap : float or None
        What the proof leaves open, as a fraction of the energy.
    seconds : float
        For the solve, without the final checks.
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
    regularity: Regularity
    iterations: int
    kkt_residual: float | None
    certificate: Certificate | None
    proven_gap: float | None
    seconds: float


def blend(
    a: Base,
    b: Base,
    *,
    continuity: Continuity | tuple[Continuity, Continuity] = "G2",
    middle_curves: int = 1,
    degree_u: int = 3,
    method: Method = "reduced",
    flip: Flip = "auto",
    alpha: Shape | tuple[Shape, Shape] = "free",
    box: tuple[float, float] = (1 / 8, 8.0),
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
    method : {"reduced", "casadi", "bfgs"}
        How alpha and beta are found where contact is geometric: the proved global minimum, the constrained problem in
        CasADi, or the paper's own search.
    flip : {"auto", "yes", "no"}
        Whether edge b runs against edge a; "auto" takes the way without a twist.
    alpha : "free", "natural", a number, or a pair of these for a and b
        Where contact is geometric: search alpha, take its natural size (mean gap over mean cross speed, for alpha^2),
        or set alpha itself.
    box : (float, float)
        Admissible alpha^2 and beta^2, in units of their natural sizes.

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
    >>> from solver.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> floor = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> wall = BSplineSurface(1, 1, k, k, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]])
    >>> result = blend(Base(floor, "u1"), Base(wall, "u0"), middle_curves=0)
    >>> result.surface.n_control_points, round(result.alpha2, 6), round(result.beta2, 6)
    (12, 1.6875, 1.6875)
    """
    started = time.perf_counter()
    pair: tuple[Continuity, Continuity] = (continuity, continuity) if isinstance(continuity, str) else continuity
    options = ProblemOptions(middle_curves, degree_u, _checked_shape(alpha), box)
    _check_choices(pair, method, box)
    side_a, side_b, flipped = _contacts(a, b, pair, flip)
    centre, size = _frame(side_a, side_b)
    problem = make_problem(side_a.moved(centre, size), side_b.moved(centre, size), options)
    found = _shape_parameters(problem, method)
    surface = _surface(problem, found, side_a, side_b, centre, size)
    energy = thin_plate_energy(surface)
    seconds = time.perf_counter() - started
    contact_a, contact_b = _checked_contacts(a, b, surface, pair, flipped)
    if found.certificate is not None:
        check_certificate(found.certificate)
    return BlendResult(
        surface=surface,
        continuity=pair,
        method=found.method,
        energy=energy,
        alpha2=None if side_a.order == 0 else found.a,
        beta2=None if side_b.order == 0 else found.b,
        alpha2_bounds=problem.bounds[0] if problem.free[0] else None,
        beta2_bounds=problem.bounds[1] if problem.free[1] else None,
        active_bounds=_active_bounds(problem, found),
        flipped=flipped,
        contact_a=contact_a,
        contact_b=contact_b,
        regularity=measure_regularity(surface),
        iterations=found.iterations,
        kkt_residual=found.kkt_residual,
        certificate=found.certificate,
        proven_gap=found.proven_gap,
        seconds=seconds,
    )


@dataclass(frozen=True)
class _Found:
    """Shape parameters, and how they were found."""

    a: float
    b: float
    method: str
    iterations: int = 0
    kkt_residual: float | None = None
    certificate: Certificate | None = None
    proven_gap: float | None = None


def _check_choices(continuity: tuple[Continuity, Continuity], method: Method, box: tuple[float, float]) -> None:
    if len(continuity) != 2:
        raise OptionError(f"continuity: found {continuity!r}, expected one of C0..G2 or a pair of them")
    if method not in get_args(Method):
        raise OptionError(f"method: found {method!r}, expected one of {', '.join(get_args(Method))}")
    if len(box) != 2 or not 0 < box[0] <= box[1] < np.inf:
        raise OptionError(f"box: found {box!r}, expected (low, high) with 0 < low <= high")


def _checked_shape(alpha: Shape | tuple[Shape, Shape]) -> tuple[Shape, Shape]:
    """Return "free", "natural" or alpha^2 for both sides."""
    pair = alpha if isinstance(alpha, tuple) else (alpha, alpha)
    for value in pair:
        if value not in ("free", "natural") and not (isinstance(value, int | float) and 0 < value < np.inf):
            raise OptionError(f"alpha: found {value!r}, expected free, natural or a positive number")
    if len(pair) != 2:
        raise OptionError(f"alpha: found {len(pair)} values, expected one or a pair")
    first, second = (value if isinstance(value, str) else float(value) ** 2 for value in pair)
    return first, second


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


def _shape_parameters(problem: BlendProblem, method: Method) -> _Found:
    """Find alpha^2 and beta^2 of least energy; where both are fixed there is nothing to find."""
    if not any(problem.free):
        return _Found(*problem.start, method="linear")
    if method == "reduced":
        from solver.reduced import solve_reduced

        proved = solve_reduced(problem)
        return _Found(proved.a, proved.b, method, certificate=proved.certificate, proven_gap=proved.gap)
    if method == "casadi":
        from solver.nlp import solve_constrained

        local = solve_constrained(problem)
        return _Found(local.a, local.b, method, local.iterations, local.kkt_residual)
    from solver.quasi_newton import solve_quasi_newton

    rough = solve_quasi_newton(problem)
    return _Found(rough.a, rough.b, method, rough.iterations)


def _surface(
    problem: BlendProblem, found: _Found, a: Side, b: Side, centre: FloatArray, size: float
) -> SemiStructuredSurface:
    """Set the prescribed rows anew from alpha and beta, solve for the free ones, and go back to model units."""
    points = problem.control_points(found.a, found.b) * size + centre
    pieces = np.split(points, problem.form.offsets[1:-1])
    # The contact curves themselves are the bases' own, to the last bit.
    pieces[0], pieces[-1] = a.rows[0], b.rows[0]
    curves = [
        BSplineCurve(row.degree, row.knots, piece, name=f"control_curves[{i}]")
        for i, (row, piece) in enumerate(zip(problem.form.rows, pieces, strict=True))
    ]
    return SemiStructuredSurface(problem.form.u.degree, problem.form.u.knots, tuple(curves))


def _active_bounds(problem: BlendProblem, found: _Found) -> tuple[str, ...]:
    active = []
    for name, is_free, value, (low, high) in zip(
        ("alpha2", "beta2"), problem.free, (found.a, found.b), problem.bounds, strict=True
    ):
        if is_free:
            # An interior-point method stops a little inside of a bound.
            active += [f"{name} lower"] * (value <= low * (1 + 1e-6)) + [f"{name} upper"] * (value >= high * (1 - 1e-6))
    return tuple(active)


def _checked_contacts(
    a: Base,
    b: Base,
    surface: SemiStructuredSurface,
    continuity: tuple[Continuity, Continuity],
    flipped: bool,
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
