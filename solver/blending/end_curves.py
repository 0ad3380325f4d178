"""An end curve of a blend brought onto a curved face: its free points are moved, and what contacts prescribe is not.

To second order the ends of a contact follow the face by construction (`end_faces`); what is left in between falls with
each degree that is added across. The points that are moved are those that neither contact reads; the move fades out
into the blend with (1 - v)^3, so that it is smooth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.end_faces import EndFace
from semispline.solver.errors import EdgeError
from semispline.solver.judge import surface_feet
from semispline.solver.splines import (
    Basis,
    BSplineSurface,
    basis_matrix,
    combined,
    elevated_knots,
    elevation_matrix,
    euclidean,
    surface_jet,
)

# Degrees that are added across at the most; each takes a digit off the distance.
_MOST_RAISED = 4
_STEPS = 6
_FADE = 3
# Distances are taken at so many points for each row that is moved, and so many more: of fewer than two in the middle,
# where they are widest apart, rows would swing between them.
_PER_ROW, _MORE = 4, 7


@dataclass(frozen=True, eq=False)
class EndOnFace:
    """A blend one end of which lies on a face.

    Attributes
    ----------
    surface : BSplineSurface
    distance : float
        Of the end curve from the face, the largest at twice as many points as were used.
    raised : int
        By how many degrees across.
    """

    surface: BSplineSurface
    distance: float
    raised: int


def face_at(face: BSplineSurface, point: FloatArray) -> EndFace:
    """Return a face near the foot of a point, to second order."""
    u, v = surface_feet(face, point[None]).T
    jets = {order: values[0] for order, values in surface_jet(face, u, v, 2).items()}
    normal = np.cross(jets[1, 0], jets[0, 1])
    normal /= np.linalg.norm(normal)
    tangents = np.stack([jets[1, 0], jets[0, 1]], axis=1)
    form = np.array([[jets[2, 0] @ normal, jets[1, 1] @ normal], [jets[1, 1] @ normal, jets[0, 2] @ normal]])
    to_parameters = np.linalg.pinv(tangents)
    return EndFace(normal, to_parameters.T @ form @ to_parameters)


def end_on_face(
    surface: BSplineSurface, end: int, face: BSplineSurface, orders: tuple[int, int], within: float
) -> EndOnFace:
    """Return a blend with its end v = 0 or v = 1 of the domain on a face.

    Parameters
    ----------
    surface : BSplineSurface
        Whose two contacts are at u = 0 and u = 1.
    end : {0, 1}
    face : BSplineSurface
        Untrimmed.
    orders : (int, int)
        Of the contacts: so many rows and one more are left as they are.
    within : float
        Distance that is sought, model units.

    Raises
    ------
    EdgeError
        The end curve stays further off.
    """
    best: EndOnFace | None = None
    for raised in range(_MOST_RAISED + 1):
        # A fade needs a degree of its own along.
        higher = elevated(surface, raised, max(0, _FADE - surface.degree_v))
        found = _moved_end(higher, end, face, orders, raised)
        if best is None or found.distance < best.distance:
            best = found
        if best.distance <= within:
            return best
    assert best is not None
    raise EdgeError(
        f"end curve: it stays {best.distance:.2g} off its end face, expected at most {within:.2g}; keep the end as it "
        "is, or blend to another face there"
    )


def elevated(surface: BSplineSurface, across: int, along: int = 0) -> BSplineSurface:
    """Return the same surface with its degrees across and along raised by so much."""
    net, knots = surface.homogeneous, [surface.knots_u, surface.knots_v]
    degrees = [surface.degree_u, surface.degree_v]
    for axis, by in ((0, across), (1, along)):
        if by:
            matrix = elevation_matrix(degrees[axis], knots[axis], degrees[axis] + by)
            net = np.moveaxis(combined(matrix, np.moveaxis(net, axis, 0)), 0, axis)
            knots[axis], degrees[axis] = elevated_knots(knots[axis], by), degrees[axis] + by
    return BSplineSurface(degrees[0], degrees[1], knots[0], knots[1], *euclidean(net))


def _moved_end(
    surface: BSplineSurface, end: int, face: BSplineSurface, orders: tuple[int, int], raised: int
) -> EndOnFace:
    """Move the end points of the rows that no contact reads along the face's normals, by Gauss-Newton steps."""
    low, high = surface.domain[0]
    rows = np.arange(orders[0] + 1, len(surface.control_points) - orders[1] - 1)
    u = low + (high - low) * (1 - np.cos(np.linspace(0, np.pi, _PER_ROW * len(rows) + _MORE))) / 2
    v = surface.domain[1][end]
    fade = _fade(Basis(surface.degree_v, surface.knots_v), end)
    across = basis_matrix(surface.degree_u, surface.knots_u, u).toarray()
    net = surface.control_points.copy()
    column = 0 if end == 0 else -1
    weights = np.ones(net.shape[:2]) if surface.weights is None else surface.weights
    shares = across * weights[:, column] / (across @ weights[:, column])[:, None]
    current = surface
    for _ in range(_STEPS if len(rows) else 0):
        off, normals = _distances(face, current.evaluate(u, np.full_like(u, v)))
        _, at_rows = _distances(face, net[rows, column])
        matrix = shares[:, rows] * (normals @ at_rows.T)
        move = np.linalg.lstsq(matrix, -off, rcond=None)[0]
        net[rows] += (move[:, None] * at_rows)[:, None] * fade[:, None]
        current = replace(surface, control_points=net.copy())
    finer = np.linspace(low, high, 2 * len(u))
    off, _ = _distances(face, current.evaluate(finer, np.full_like(finer, v)))
    return EndOnFace(current, float(np.abs(off).max()), raised)


def _distances(face: BSplineSurface, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return signed distances of points from a face, and its unit normals at their feet."""
    u, v = surface_feet(face, points).T
    jets = surface_jet(face, u, v, 1)
    normals = np.cross(jets[1, 0], jets[0, 1])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return np.einsum("kd,kd->k", points - jets[0, 0], normals), normals


def _fade(along: Basis, end: int) -> FloatArray:
    """Return the control points of the polynomial that falls from 1 at an end to 0 at the other, with its slopes."""
    start, stop = float(along.knots[0]), float(along.knots[-1])
    t = (along.knots - start) / (stop - start)
    inner = np.lib.stride_tricks.sliding_window_view(t[1:-1], along.degree)
    factors = 1 - inner if end == 0 else inner
    # The blossom: a mean of products of three.
    total = np.array([np.poly(-row)[_FADE] for row in factors])
    return np.asarray(total / comb(along.degree, _FADE))
