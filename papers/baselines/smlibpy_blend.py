"""`blend` of the package smlibpy (the extra `bench`): what a user of Python can install today, G2 asked for."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from semispline.papers.baselines.contacts import oriented_bases
from semispline.papers.baselines.interface import BlendTask, Method, NotApplicableError, Outcome
from semispline.solver.splines import BSplineSurface, map_domain, reverse_u, reverse_v, swap_directions


def blend_smlibpy(task: BlendTask) -> Outcome:
    """Blend with `smlibpy.blend` and take its faces as B-spline surfaces.

    Raises
    ------
    NotApplicableError
        smlibpy is not installed, or it refuses the pair.
    """
    try:
        # An extra, which need not be installed.
        import smlibpy
    except ImportError:
        raise NotApplicableError("smlibpy is not installed; try: pip install 'semispline[bench]'") from None
    bases = oriented_bases(task)
    edges = [_contact_edge(smlibpy, base) for base in bases]
    started = time.perf_counter()
    try:
        sheet = smlibpy.blend(*edges, continuity="G2")
    except (smlibpy.ModelingError, smlibpy.KernelError, ValueError) as error:
        raise NotApplicableError(f"smlibpy refuses: {str(error).splitlines()[0]}") from None
    seconds = time.perf_counter() - started
    pieces = [_oriented(_surface(face.nurbs()), bases[0]) for face in sheet.faces()]
    count = sum(piece.n_control_points for piece in pieces)
    surface = map_domain(_one(pieces), (0.0, 1.0), bases[0].domain[1])
    return Outcome(surface, count, None, seconds, aligned=False, note="its own parameters along v")


def _contact_edge(smlibpy: Any, base: BSplineSurface) -> Any:
    """Return the edge of a sheet that lies on the contact: the one closest to points of it."""
    net, knots = base.control_points.tolist(), (base.knots_u.tolist(), base.knots_v.tolist())
    sheet = smlibpy.nurbs_surface(net, knots=knots, degrees=(base.degree_u, base.degree_v))
    v = np.linspace(*base.domain[1], 7)
    points = base.evaluate(np.full_like(v, base.domain[0][0]), v)

    def distance(edge: Any) -> float:
        closest = [np.array(tuple(edge.closest_point(tuple(p)))) for p in points.tolist()]
        return float(np.linalg.norm(np.array(closest) - points, axis=1).max())

    return min(sheet.edges(), key=distance)


def _surface(nurbs: Any) -> BSplineSurface:
    net = np.array([[tuple(point) for point in row] for row in nurbs.points])
    weights = None if nurbs.weights is None else np.array(nurbs.weights)
    knots_u, knots_v = (np.array(k) for k in nurbs.knots)
    degree_u, degree_v = nurbs.degrees
    return BSplineSurface(degree_u, degree_v, knots_u, knots_v, net, weights)


def _one(pieces: list[BSplineSurface]) -> BSplineSurface:
    """Return the faces as one surface: between closed contacts there are two, one after the other along v."""
    if len(pieces) == 1:
        return pieces[0]
    first, second = sorted(pieces, key=lambda piece: piece.knots_v[0])
    if first.knots_v[-1] != second.knots_v[0] or not np.array_equal(first.knots_u, second.knots_u):
        raise NotApplicableError("smlibpy gave faces that do not follow each other along v")
    if first.is_rational or second.is_rational:
        raise NotApplicableError("smlibpy gave rational faces, expected polynomial ones to put together")
    # Continuous only, as far as the knots tell: what the faces are in fact is measured.
    knots = np.concatenate([first.knots_v[:-1], second.knots_v[second.degree_v + 1 :]])
    net = np.concatenate([first.control_points, second.control_points[:, 1:]], axis=1)
    return BSplineSurface(first.degree_u, first.degree_v, first.knots_u, knots, net)


def _oriented(surface: BSplineSurface, first: BSplineSurface) -> BSplineSurface:
    """Return the surface with u = 0 on the contact with a, and v running as there."""
    v = np.linspace(*first.domain[1], 65)
    contact = first.evaluate(np.full_like(v, first.domain[0][0]), v)

    def away(candidate: BSplineSurface) -> float:
        w = np.linspace(*candidate.domain[1], 17)
        edge = candidate.evaluate(np.full_like(w, candidate.domain[0][0]), w)
        distance = np.linalg.norm(edge[:, None] - contact, axis=2)
        # Far from the contact costs most; among edges on it, the one that runs along with it wins.
        along = np.diff(np.argmin(distance, axis=1))
        return float(np.max(np.min(distance, axis=1)) + 1e-6 * np.ptp(contact) * np.sum(along < 0))

    turns = [surface, swap_directions(surface)]
    turns += [reverse_u(s) for s in turns]
    turns += [reverse_v(s) for s in turns]
    return min(turns, key=away)


METHODS = (
    Method("smlibpy", "smlibpy blend, G2", "package smlibpy, `blend` with its defaults", 71, blend_smlibpy),
)  # fmt: skip
