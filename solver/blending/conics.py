"""Rims that are conics: recognised from the rows beside the edge, and put into a smooth homogeneous form.

Circles of seven or nine points, as CAD kernels hold them, are only continuous in homogeneous coordinates at their inner
knots. Where rows of one side have such knots and other rows do not, the blend is creased there. A rim that is one
conic is therefore run through by the square of a uniform complex spline instead: the same surface, by another
parameter along and another factor, C2 or smoother everywhere, at the seam of a full circle too.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi
from typing import Literal, TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Basis, affine_knots, basis_matrix, breakpoints, smooth_arc

# Rows are one conic to this, relative to their size; what coordinates far from the origin lose comes on top.
CONIC_TOLERANCE = 1e-10
# In units of the spacing of floats.
_ROUNDINGS = 16
# A third singular value below this fraction of the first is a straight rim, or a point.
_STRAIGHT = 1e-6
# Eigenvalues of the form whose ratio is below this make two lines, not a conic.
_DEGENERATE = 1e-6
# Angles nearer to a full turn are a full turn.
_FULL_TURN = 1e-9
# Curves of both sides that agree to this are the same arcs.
_SAME = 1e-9
# The weight of a rim's plane at infinity that is nearer to the conic than this makes it no ellipse.
_ELLIPSE = 1 - 1e-6
# Radii that agree to this part make a circle of an ellipse: files write coordinates with some ten digits.
_ROUND = 1e-8
ConicName: TypeAlias = Literal["circle", "ellipse", "parabola", "hyperbola"]
_LEAST_SAMPLES = 12
# Blends are smooth to second order inside, whatever the contact is.
_LEAST_ORDER = 2


@dataclass(frozen=True, eq=False)
class Conic:
    """Rows that all are images of one curve y(v) on the cone x^2 + y^2 = w^2: row k is y(v) times `frames[k]`.

    Attributes
    ----------
    along : Basis
    points : ndarray, shape (n, 3)
        Control points (x, y, w) of y(v), as the base has it: it begins at (1, 0, 1) and turns to positive angles.
    turn : float
        The angle at its end; 2 pi where the rim is closed.
    frames : ndarray, shape (K, 3, 4)
    """

    along: Basis
    points: FloatArray
    turn: float
    frames: FloatArray

    @property
    def kind(self) -> ConicName:
        """What the rim itself, row 0, is; a piece of it is named as the whole."""
        frame = self.frames[0]
        # The rim is where the weight is: a line that this plane curve does not meet, touches, or crosses.
        apart = float(np.hypot(*frame[:2, 3]))
        if not apart < _ELLIPSE * frame[2, 3]:
            return "hyperbola" if apart > frame[2, 3] / _ELLIPSE else "parabola"
        # The boost has made the weight constant: these are its conjugate radii.
        x, y = frame[:2, :3] / frame[2, 3]
        even = max(abs(float(x @ x - y @ y)), 2 * abs(float(x @ y))) <= _ROUND * float(x @ x + y @ y)
        return "circle" if even else "ellipse"

    def cured_rows(self, order: int) -> tuple[FloatArray, Basis] | None:
        """Return `smooth_rows`, or None where their weights are not positive."""
        smooth = self.smooth_rows(order)
        return smooth if (smooth[0][0, :, 3] > 0).all() else None

    def smooth_rows(self, order: int, times: int = 1) -> tuple[FloatArray, Basis]:
        """Return the same surface beside the edge, C^order (2 at least) along, over the same domain.

        With `times` as many spans as it takes its parameter is closer to the angle: of the full circle 1.2, .03 and
        .0009 degrees off for 1, 2 and 4.

        Returns
        -------
        rows : ndarray, shape (K, n', 4)
        along : Basis
            Of degree 2 (order + 1): the full circle has 11 points for order 2, 14 and 17 for 3 and 4.
        """
        half_turns = max(1, ceil(self.turn / pi - _FULL_TURN))
        basis, points = smooth_arc(self.turn, max(order, _LEAST_ORDER), times * half_turns)
        knots = affine_knots(basis.knots, float(self.along.knots[0]), float(self.along.knots[-1]))
        return np.asarray(np.einsum("nc,kcd->knd", points, self.frames)), Basis(basis.degree, knots)


def cured_conic(rows: FloatArray, along: Basis, order: int) -> tuple[FloatArray, Basis] | None:
    """Return rows of the same surface that are C^order along (2 at least), or None where they are not one conic.

    Parameters
    ----------
    rows : ndarray, shape (K, n, 4)
        Homogeneous rows 0 to the order of contact, from the edge inwards.
    along : Basis
    order : int
        Order of contact of the smoother side.

    Examples
    --------
    >>> arc = np.array([[[1, 0, 0, 1], [1, 1, 0, 1], [0, 2, 0, 2.0]]])
    >>> rows, basis = cured_conic(arc, Basis(2, np.array([0, 0, 0, 1.0, 1, 1])), 2)
    >>> basis.degree, rows.shape
    (6, (1, 7, 4))
    """
    conic = recognised_conic(rows, along)
    return None if conic is None else conic.cured_rows(order)


def same_arcs(a: Conic, b: Conic) -> bool:
    """Tell whether both sides run through their conics alike, up to a constant factor and an affine map of v.

    Rows that are images of one curve y(v) make a blend that has no crease at the knots of y, whatever they are.
    """
    if a.along.degree != b.along.degree or len(a.points) != len(b.points) or abs(a.turn - b.turn) > _SAME:
        return False
    knots = affine_knots(b.along.knots, float(a.along.knots[0]), float(a.along.knots[-1]))
    if np.abs(knots - a.along.knots).max() > _SAME * float(np.ptp(knots)):
        return False
    return bool(np.abs(a.points - b.points).max() <= _SAME * np.abs(a.points).max())


def recognised_conic(rows: FloatArray, along: Basis) -> Conic | None:
    """Return the conic that all rows are images of, or None.

    Parameters
    ----------
    rows : ndarray, shape (K, n, 4)
        Homogeneous rows 0 to the order of contact.
    along : Basis

    Notes
    -----
    The rows are R_k(v) = A_k c(v) with one plane homogeneous curve c where the matrix of all their coordinates has rank
    3. c lies on a conic where a quadratic form of signature (2, 1) vanishes on it; its eigenvectors take it to the cone
    x^2 + y^2 = w^2, and a boost of this cone makes w the weight of row 0: on a circle the angle is then the Euclidean
    one.
    """
    centre, size = _place(rows)
    local = np.concatenate([(rows[..., :3] - rows[..., 3:] * centre) / size, rows[..., 3:]], axis=-1)
    allowed = max(CONIC_TOLERANCE, _ROUNDINGS * float(np.finfo(float).eps * np.abs(rows[..., :3]).max()) / size)
    left, values, right = np.linalg.svd(local.transpose(1, 0, 2).reshape(along.size, -1), full_matrices=False)
    if len(values) < 3 or values[2] < max(_STRAIGHT, allowed) * values[0]:
        return None
    if (values[3:] > allowed * values[0]).any():
        return None
    plane, images = left[:, :3], values[:3, None] * right[:3]
    sampled = basis_matrix(along.degree, along.knots, _samples(along))
    to_cone = _to_cone(sampled @ plane, allowed * values[0] / values[2])
    if to_cone is None:
        return None
    to_cone = to_cone @ _boost(np.linalg.solve(to_cone, images[:, 3]))
    on_cone = sampled @ plane @ to_cone
    angles = np.unwrap(np.arctan2(on_cone[:, 1], on_cone[:, 0]))
    turn = float(angles[-1] - angles[0])
    if turn < 0:
        to_cone[:, 1] *= -1
        angles, turn = -angles, -turn
    if (np.diff(angles) < 0).any() or turn > 2 * pi + _FULL_TURN:
        return None
    cos, sin = np.cos(angles[0]), np.sin(angles[0])
    to_cone = to_cone @ np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]]) / on_cone[0, 2]
    frames = np.linalg.solve(to_cone, images).reshape(3, len(rows), 4).transpose(1, 0, 2)
    frames = np.concatenate([frames[..., :3] * size + frames[..., 3:] * centre, frames[..., 3:]], axis=-1)
    return Conic(along, plane @ to_cone, 2 * pi if abs(turn - 2 * pi) < _FULL_TURN else turn, frames)


def _place(rows: FloatArray) -> tuple[FloatArray, float]:
    """Return a point amid the points, and their size."""
    flat = (rows[..., :3] / rows[..., 3:]).reshape(-1, 3)
    centre = (flat.min(axis=0) + flat.max(axis=0)) / 2
    return centre, float(np.abs(flat - centre).max()) or 1.0


def _samples(along: Basis) -> FloatArray:
    """Return parameters enough to tell a form of degree 2 in the spline from zero, both ends of each span with them."""
    breaks = breakpoints(along.knots)
    count = max(_LEAST_SAMPLES, 2 * along.degree + 1)
    within = (1 - np.cos(np.linspace(0, pi, count + 1))) / 2
    inside = (breaks[:-1, None] + np.diff(breaks)[:, None] * within[:-1]).ravel()
    return np.append(inside, breaks[-1])


def _to_cone(curve: FloatArray, allowed: float) -> FloatArray | None:
    """Return the matrix, shape (3, 3), whose product with the curve's points lies on the cone, or None.

    `curve` are points of a plane homogeneous curve, shape (K, 3).
    """
    unit = curve / np.linalg.norm(curve, axis=1)[:, None]
    x, y, w = unit.T
    monomials = np.column_stack([x * x, y * y, w * w, 2 * x * y, 2 * x * w, 2 * y * w]) / np.sqrt(len(unit))
    _, values, right = np.linalg.svd(monomials, full_matrices=False)
    # More than one form would be a curve on fewer points than a conic has.
    if values[5] > allowed or values[4] <= max(allowed, _DEGENERATE):
        return None
    q = right[5]
    roots, vectors = np.linalg.eigh(np.array([[q[0], q[3], q[4]], [q[3], q[1], q[5]], [q[4], q[5], q[2]]]))
    if np.abs(roots).min() < _DEGENERATE * np.abs(roots).max():
        return None
    positive = roots > 0
    if positive.sum() not in (1, 2):
        return None
    alone = int(np.flatnonzero(positive == (positive.sum() == 1))[0])
    order = [i for i in range(3) if i != alone] + [alone]
    matrix = (vectors * np.sqrt(np.abs(roots)))[:, order]
    w = curve @ matrix[:, 2]
    if not ((w > 0).all() or (w < 0).all()):
        return None
    return np.asarray(matrix * np.sign(w[0]))


def _boost(weight: FloatArray) -> FloatArray:
    """Return the matrix, shape (3, 3), by which points of the cone get the last coordinate that `weight` gives them.

    It is a multiple of the value of the linear form `weight`. On a parabola or a hyperbola no boost can do that, and
    the identity is returned.
    """
    size = float(np.hypot(weight[0], weight[1]))
    if not size < _ELLIPSE * weight[2]:
        return np.eye(3)
    if size == 0:
        return np.eye(3)
    speed = size / weight[2]
    along = weight[:2] / size
    stretch = 1 / np.sqrt((1 - speed) * (1 + speed))
    matrix = np.empty((3, 3))
    matrix[:2, :2] = np.eye(2) + (stretch - 1) * np.outer(along, along)
    matrix[:2, 2] = matrix[2, :2] = stretch * speed * along
    matrix[2, 2] = stretch
    return matrix
