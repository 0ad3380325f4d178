"""The whole solve, from two bases to a checked blend: stages with input and output, one after the other."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray, require
from semispline.solver.blending.candidates import Candidate, Layout, find_layout
from semispline.solver.blending.chain_bases import StatedBases, as_bases, on_chains
from semispline.solver.blending.chain_contact import told_apart
from semispline.solver.blending.chains import Chain
from semispline.solver.blending.matching import directions_to_try
from semispline.solver.blending.measured_energy import MeasuredEnergy, measure_energy
from semispline.solver.blending.placing import PlacedSides, place_sides
from semispline.solver.blending.problem import BlendProblem, make_problem
from semispline.solver.blending.result import BlendResult, Objective
from semispline.solver.blending.rounding import measure_energy_rounding, rounding_warning
from semispline.solver.blending.shape_parameters import Found, active_bounds, admissible, bulged
from semispline.solver.blending.shape_warnings import shape_warnings
from semispline.solver.blending.sides import Side
from semispline.solver.blending.warnings import (
    bare_places,
    bound_warnings,
    contact_warnings,
    fairness_warning,
    remedy,
    seam_warning,
    stopped_warning,
    strained_by,
)
from semispline.solver.errors import ComputationError, ContactError, FoldError, InputError
from semispline.solver.judge import (
    Base,
    Contact,
    Correspondence,
    ShapeReport,
    check_regular_edge,
    edge_length,
    in_cad_limits,
    measure_contact,
    measure_creases,
    measure_regularity,
    measure_shape,
    measure_turn,
    required_limits,
    rounding_causes,
    untold,
)
from semispline.solver.options import BlendOptions, Flip, named_options
from semispline.solver.proof import check_certificate
from semispline.solver.splines import BSplineCurve, SemiStructuredSurface, euclidean

# Blends in two directions whose normals turn alike to this many degrees turn equally.
_EQUAL_TURNS = 1e-3


def blend(
    a: Base | Chain,
    b: Base | Chain,
    options: BlendOptions | None = None,
    **named: Any,
) -> BlendResult:
    """Blend two B-spline surfaces with a semi-structured surface: of fairest shape, or as the paper has it.

    Parameters
    ----------
    a, b : Base or Chain
        B-spline surfaces, rational or not, and the edges to be joined; or edges end to end, as `chain` returns them.
        Neither is changed.
    options : BlendOptions, optional
        Or its fields by name: ``blend(a, b, continuity="G1", middle_curves=0)``.

    Returns
    -------
    BlendResult

    Raises
    ------
    OptionError, EdgeError
        An option or a base that cannot be used: a chain knows contact of surfaces only, C0 or G0 to G4.
    ComputationError
        The solver failed.
    ContactError
        The referee found the contact worse than its limits, or rounding hides whether it is.
    FoldError
        With `strict`: the blend has warnings.

    Source: section 3 and equation (11) of the paper; contact conditions from `semispline.derivations.contact`.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> floor = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> wall = BSplineSurface(1, 1, k, k, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]])
    >>> result = blend(Base(floor, "u1"), Base(wall, "u0"))
    >>> result.surface.n_control_points, round(result.alpha2, 2), round(result.beta2, 2)
    (12, 1.79, 1.79)
    """
    said = named_options(options, named)
    stated = as_bases(a, b, said)
    return _strictly(on_chains(_blended(stated), stated), said.strict)


def _blended(stated: StatedBases) -> BlendResult:
    """Blend two bases, in each direction that is left open."""
    a, b, said, matched = stated.a, stated.b, stated.options, stated.matched
    started = time.perf_counter()
    directions = _tied(a, b, said.flip) if matched is None else ("no",)
    solved: list[_Solved] = []
    failures: dict[Flip, ComputationError] = {}
    for flip in directions:
        try:
            solved.append(_solved(stated, flip))
        except ComputationError as failure:
            failures[flip] = failure
    seconds = time.perf_counter() - started
    while solved:
        least = solved[0] if len(solved) == 1 else _least_turning(solved)
        try:
            result = _judged(stated, least, seconds)
        except ComputationError as failure:
            failures[least.flip] = failure
            solved.remove(least)
        else:
            return _unwarned(stated, result)
    raise next(failures[flip] for flip in directions if flip in failures)


@dataclass(frozen=True, eq=False)
class _Solved:
    """A blend in one direction of b, before anything is said of it."""

    flip: Flip
    placed: PlacedSides
    layout: Layout
    candidates: tuple[Candidate, ...]
    found: Found
    surface: SemiStructuredSurface
    energy: MeasuredEnergy


def _solved(stated: StatedBases, flip: Flip) -> _Solved:
    """Solve for the blend: the few numbers that are not linear, then everything that is."""
    said = stated.options
    placed = place_sides(
        stated.a,
        stated.b,
        said,
        flip,
        stated.matched,
        lines_answer=stated.lines_answer,
        held=stated.held,
        joints=stated.cuts,
    )
    layout, candidates = find_layout(*placed.scaled, said)
    found = bulged(layout.found, layout.options.bulges)
    surface = _surface(layout.problem, found, placed.sides, placed.frame)
    return _Solved(flip, placed, layout, candidates, found, surface, measure_energy(surface))


def _least_turning(solved: list[_Solved]) -> _Solved:
    """Return the blend whose normal turns least; of equals the first."""
    turns = []
    for one in solved:
        try:
            turns.append(measure_turn(one.surface).degrees)
        except InputError:
            # No surface: that is said when it is judged.
            turns.append(np.inf)
    return next(one for one, turn in zip(solved, turns, strict=True) if turn <= min(turns) + _EQUAL_TURNS)


def _judged(stated: StatedBases, solved: _Solved, seconds: float) -> BlendResult:
    """Let the judge measure a blend, and refuse what misses its limits."""
    a, b = stated.a, stated.b
    placed, layout, found, surface = solved.placed, solved.layout, solved.found, solved.surface
    sides, frame, matched = placed.sides, placed.frame, placed.matched
    chosen, problem, energy = layout.options, layout.problem, solved.energy.value
    rounding = measure_energy_rounding(problem, found, surface, frame, energy)
    # What came out, judged by code that knows nothing of the above.
    contact_a, contact_b = _checked_contacts(stated, surface, chosen, matched, found)
    if found.certificate is not None:
        check_certificate(found.certificate)
    seam = _seam(surface, problem)
    regularity = measure_regularity(surface)
    # Cures leave rows that are C1: there curvature may jump.
    creases = measure_creases(surface, c1_lines=problem.is_cured or problem.is_rational)
    own, inherited = told_apart(creases, surface, stated.joints)
    shape = _measured_shape(surface, *stated.shown, chosen)
    warnings = (
        shape_warnings(shape, regularity, own, options=chosen, cures=problem.cures, inherited=inherited)
        + bound_warnings(problem, layout.found)
        + stopped_warning(layout.found, chosen)
        + (fairness_warning(found.fairness, shape.fairness.value) if chosen.bulges == (1.0, 1.0) else ())
        + rounding_warning(rounding, surface, energy)
        + seam_warning(a, b)
        + contact_warnings((a, b), surface, (contact_a, contact_b), chosen, found)
    )
    return BlendResult(
        surface=surface,
        edges=(a.edge, b.edge),
        continuity=chosen.continuities,
        options=chosen,
        candidates=solved.candidates,
        objective=_objective(layout, energy, frame[1]),
        method=found.method,
        energy=energy,
        energy_rounding=rounding.energy,
        quadrature_error=solved.energy.quadrature_error,
        weights=problem.weights,
        cures=problem.cures,
        alpha2=None if sides[0].order == 0 else found.a,
        beta2=None if sides[1].order == 0 else found.b,
        alpha2_bounds=admissible(problem, 0),
        beta2_bounds=admissible(problem, 1),
        active_bounds=active_bounds(problem, layout.found),
        flipped=matched.flipped,
        seam_shift=matched.shift,
        contact_a=contact_a,
        contact_b=contact_b,
        seam=seam,
        regularity=regularity,
        creases=creases,
        shape=shape,
        warnings=warnings,
        iterations=found.iterations,
        status=found.status,
        search_excess=found.search_excess,
        kkt_residual=found.kkt_residual,
        # What rounding made is not proved to be least.
        certificate=None if rounding.matters else found.certificate,
        proven_gap=None if rounding.matters else found.proven_gap,
        p2=found.p2,
        constraint_rank=found.constraint_rank,
        seconds=seconds,
    )


@dataclass(frozen=True, eq=False)
class StatedProblem:
    """A blend to be found, and the way back to the bases.

    Attributes
    ----------
    problem : BlendProblem
    sides : (Side, Side)
        Both contacts in one parameter v, in model units.
    frame : (ndarray of shape (3,), float)
        Centre and size: the problem has coordinates (x - centre) / size.
    matched : Correspondence
        How edge b runs along edge a.
    """

    problem: BlendProblem
    sides: tuple[Side, Side]
    frame: tuple[FloatArray, float]
    matched: Correspondence


def state_problem(a: Base, b: Base, options: BlendOptions | None = None, **named: Any) -> StatedProblem:
    """State the first problem that `blend` solves; arguments and errors are those of `blend`."""
    said = named_options(options, named)
    if len(tied := _tied(a, b, said.flip)) > 1:
        less_turning = blend(a, b, replace(said, method="reduced", strict=False))
        tied = ("yes" if less_turning.flipped else "no",)
    placed = place_sides(a, b, said, tied[0])
    return StatedProblem(make_problem(*placed.scaled, said), placed.sides, placed.frame, placed.matched)


def _objective(layout: Layout, energy: float, size: float) -> Objective:
    """Say what was minimised, and what is known of it."""
    problem, found, options = layout.problem, layout.found, layout.options
    points = problem.control_points(found.a, found.b, found.p2)
    excess = problem.free_system.excess(points)
    if excess is None:
        rows = "none are free: the contacts prescribe all"
    else:
        rows = f"thin plate, v_scale {options.v_scale}, within {excess:.0e} of the least for these shape parameters"
    if found.fairness is not None:
        return Objective("fairness", found.fairness, found.known, rows)
    if found.proven_gap is not None:
        known = f"proved least over the box to {found.proven_gap:.1e} of itself"
        if problem.is_rational:
            known += ", as a quadrature form"
    elif any(problem.free):
        known = f"a local minimum that method {found.method} found"
    elif excess is None:
        return Objective("nothing", None, "contacts and options prescribe all", rows)
    else:
        known = "nothing but the rows was free"
    value = energy if options.v_scale == "paper" else float(problem.energy_products(points[None])[0, 0]) * size**2
    return Objective("thin plate", value, known, rows)


def _tied(a: Base, b: Base, flip: Flip) -> tuple[Flip, ...]:
    """Return the directions of b to be tried: more than one only where closeness is to decide, and cannot."""
    require(a, "a", Base)
    require(b, "b", Base)
    return directions_to_try(a, b) if flip == "auto" else (flip,)


def _strictly(result: BlendResult, strict: bool) -> BlendResult:
    """Return the result, refused if it has warnings and is to have none."""
    if strict and result.warnings:
        raise FoldError(f"{'; '.join(result.warnings)}; look at the warnings, or blend without strict")
    return result


def _surface(
    problem: BlendProblem, found: Found, sides: tuple[Side, Side], frame: tuple[FloatArray, float]
) -> SemiStructuredSurface:
    """Set the prescribed rows anew from alpha and beta, solve for the free ones, and go back to model units."""
    centre, size = frame
    points = problem.control_points(found.a, found.b, found.p2)
    if problem.is_rational:
        points[:, :3] = points[:, :3] * size + points[:, 3:] * centre
    else:
        points = points * size + centre
    if problem.is_rational and not (np.isfinite(points).all() and (points[:, 3] > 0).all()):
        shape = ", ".join(f"{float(np.max(x)):.1e}" for x in (found.a, found.b))
        raise ComputationError(
            f"the blend has no proper control points for the shape parameters {shape}: numbers overflow, or weights "
            "are not positive there; try an alpha nearer to the natural one, or other bases"
        )
    pieces = np.split(points, problem.form.offsets[1:-1])
    if not (problem.is_rational or problem.is_cured):
        # The contact curves themselves are the bases' own, to the last bit.
        pieces[0], pieces[-1] = sides[0].rows[0], sides[1].rows[0]
    curves = [
        BSplineCurve(row.degree, row.knots, *euclidean(piece), name=f"control_curves[{i}]")
        for i, (row, piece) in enumerate(zip(problem.rows, pieces, strict=True))
    ]
    return SemiStructuredSurface(problem.form.u.degree, problem.form.u.knots, tuple(curves))


def _checked_contacts(
    stated: StatedBases,
    surface: SemiStructuredSurface,
    options: BlendOptions,
    matched: Correspondence,
    found: Found,
) -> tuple[Contact, Contact]:
    """Let the referee measure both contacts, and refuse a result that misses its limits.

    A chain is refused by its faces, each over its own range: a short face beside a long chain rounds as it does alone.
    """
    a, b, continuity = stated.a, stated.b, options.continuities
    order = max(2, *options.orders)
    contact_a = measure_contact(a, Base(surface, "u0"), correspondence=Correspondence(flipped=False), order=order)
    contact_b = measure_contact(Base(surface, "u1"), b, correspondence=matched, order=order)
    if options.limits == "cad":
        contact_a, contact_b = (
            in_cad_limits(contact, edge_length(base)) for contact, base in ((contact_a, a), (contact_b, b))
        )
    for index, (name, base, contact, wanted, shape) in enumerate(
        (
            ("a", a, contact_a, continuity[0], float(np.min(found.a))),
            ("b", b, contact_b, continuity[1], float(np.min(found.b))),
        )
    ):
        strained = strained_by(options, found, index)
        measured = required_limits(contact, wanted)
        # Measures are those away from poles: a blend has to meet its base there too.
        ends = base.breakpoints_along()
        in_pole = any(place.is_none and place.parameter in ends for place in contact.no_normal)
        if (in_pole and wanted[0] == "G" and wanted != "G0") or any(np.isnan(value) for _, value, _ in measured):
            check_regular_edge(base)
            raise ContactError(
                f"contact {name}: the blend is degenerate where it meets the base, its shape parameter is "
                f"{shape:.1e}; {strained or 'try a larger alpha, or a box that begins higher'}"
            )
        if stated.chains[index] is not None:
            continue
        hidden = untold(contact, wanted)
        if hidden:
            shown = shape if wanted[0] == "G" else None
            causes = rounding_causes(base, Base(surface, "u1" if index else "u0"), int(wanted[1]))
            said = remedy(base, causes, bare_places(contact, name), shown, int(wanted[1]), strained)
            raise ContactError(f"contact {name}: {'; '.join(hidden)} for {wanted}; {said}")
        for measure, value, limit in measured:
            if not value <= limit:
                raise ContactError(
                    f"contact {name}: {measure} is {value:.3g}, expected at most {limit:.3g} for {wanted}; "
                    + (strained or "try fewer middle curves, or bases whose knots are not so close")
                )
    return contact_a, contact_b


def _unwarned(stated: StatedBases, result: BlendResult) -> BlendResult:
    """Return the blend without the middle curve that was chosen, where that leaves nothing to be warned of.

    A little fairness is not worth a warning. A U-turn keeps one.
    """
    said = stated.options
    left = next((one for one in result.candidates if one.verdict == "chosen" and one.middle_curves), None)
    if left is None or said.middle_curves != "auto" or not result.warnings or result.shape.exits.is_u_turn:
        return result
    try:
        flip: Flip = "yes" if result.flipped else "no"
        plain = _blended(replace(stated, options=replace(said, middle_curves=0, flip=flip)))
    except ComputationError:
        return result
    if plain.warnings:
        return result
    left = replace(left, verdict=f"fairness {left.fairness:.4g} is less, but {result.warnings[0]}")
    return replace(plain, candidates=(*plain.candidates, left), seconds=result.seconds + plain.seconds)


def _seam(surface: SemiStructuredSurface, problem: BlendProblem) -> Contact | None:
    if problem.seam_order < 0:
        return None
    return measure_contact(Base(surface, "v1"), Base(surface, "v0"), flip="no")


def _measured_shape(surface: SemiStructuredSurface, a: Base, b: Base, options: BlendOptions) -> ShapeReport:
    try:
        return measure_shape(surface, a, b, search_meets=options.search_meets)
    except InputError as error:
        raise ComputationError(f"the blend is no surface: {error}; try other edges, or a higher continuity") from error
