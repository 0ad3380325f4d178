"""Rows of the strip that joined pieces make."""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_coefficients import Coefficients, JoinedPieces
from semispline.solver.blending.chain_pieces import Piece, normalised_jets
from semispline.solver.blending.reparametrisation import (
    Reparametrisation,
    bezier_derivatives,
    bezier_points,
    chebyshev_places,
    composed,
    elevation,
)
from semispline.solver.blending.spans import bezier_pieces, joined_spans
from semispline.solver.blending.weights import end_derivatives, rows_from_derivatives
from semispline.solver.errors import EdgeError
from semispline.solver.splines import Basis, basis_matrix

_MOST_DEGREE = 25
_INNER_ORDER = 2
# Of the contact: weights of the strip's other rows stay above it.
_LEAST_WEIGHT = 0.25
# A knot that is not needed changes no value by more than this, relative to its order.
_NO_KNOT = 1e-12
# Along a chain, at which its extent is seen.
_PLACES = 65


def positive_rows(jets: FloatArray, along: Basis, width: float) -> tuple[FloatArray, float]:
    """Return the control rows of a strip, and how wide it is in u: as asked, or less where weights would vanish.

    Raises
    ------
    EdgeError
        The weights of the contact itself are not positive.
    """
    if jets.shape[2] == 3:
        return rows_of_jets(jets, width), width
    jets = normalised_jets(jets, along)
    least = _LEAST_WEIGHT * float(jets[0, :, 3].min())
    if least <= 0:
        raise EdgeError(
            "chain: its weights cannot be made smooth and positive; use bases with more even weights along their "
            "edges, or blend the edges one by one"
        )
    while (rows := rows_of_jets(jets, width))[..., 3].min() < least:
        width /= 2
    return rows, width


def well_told_width(jets: FloatArray, along: Basis) -> float:
    """Return how wide a strip may be before it leaves the contact further than that is long.

    Rows of a strip of a width hold its derivatives of order k to some roundings of their points over width^k.
    """
    # Not of control points: those of half circles lie at infinity.
    points = basis_matrix(along.degree, along.knots, np.linspace(along.knots[0], along.knots[-1], _PLACES)) @ jets[0]
    points = points if jets.shape[2] == 3 else points[:, :3] / points[:, 3:]
    extent = float(np.ptp(points, axis=0).max()) / 2
    sizes = [float(np.linalg.norm(jet[:, :3], axis=1).max()) for jet in jets[1:]]
    return min(float((extent * factorial(k) / size) ** (1 / k)) for k, size in enumerate(sizes, start=1) if size > 0)


def rows_of_jets(jets: FloatArray, width: float) -> FloatArray:
    """Return control rows from the edge inwards, of a surface of the degree of the order over [0, width]."""
    order = len(jets) - 1
    return np.asarray(np.einsum("kd,dnc->knc", rows_from_derivatives(order, order, (width,) * order), jets))


def jets_of_rows(rows: FloatArray) -> FloatArray:
    """Return derivatives across at the edge, from control rows over [0, 1]."""
    order = len(rows) - 1
    return np.asarray(np.einsum("dk,knc->dnc", end_derivatives(order, order, (1.0,) * order), rows))


def assembled(joined: JoinedPieces) -> tuple[FloatArray, Basis]:
    """Return derivatives by u along the whole chain, shape (order + 1, n, d), and their basis."""
    parts = [bezier_pieces(piece.jets, piece.along) for piece in joined.pieces]
    degree = max(_degree(piece, own) for piece, own in zip(joined.pieces, joined.coefficients, strict=True))
    if degree > _MOST_DEGREE:
        raise EdgeError(
            f"chain: degree {degree} along, expected at most {_MOST_DEGREE}; ask for a lower order of contact"
        )
    t = chebyshev_places(degree + 1)
    places: list[float] = [0.0]
    points: list[FloatArray] = []
    smooth: list[int] = []
    for piece, own, span, continuity, (breaks, spans) in zip(
        joined.pieces, joined.coefficients, joined.spans.tolist(), joined.continuity, parts, strict=True
    ):
        start = places[-1]
        if points:
            smooth.append(continuity)
        counts = [int(np.sum(piece.along.knots == x)) for x in breaks[1:-1]]
        smooth += [min(piece.along.degree - count, _INNER_ORDER) for count in counts]
        for low, high, bezier in zip(breaks[:-1].tolist(), breaks[1:].tolist(), spans, strict=True):
            places.append(start + span * high)
            if _is_plain(own):
                points.append(elevation(piece.along.degree, degree) @ bezier * own.values[0, 0, 0])
                continue
            by = Reparametrisation.of(own.at(low, high, t))
            values = composed(bezier_derivatives(bezier, high - low, t, len(bezier) - 1), by)
            points.append(bezier_points(values))
    if (seam := joined.joints[0]) is not None and not seam.is_exact:
        _close(points, np.diff(places), joined.continuity[0])
    found, along = joined_spans(points, np.array(places), smooth)
    for at in _cut_splines(joined, places):
        # Where one spline was cut it comes back as smooth as it was.
        for order in range(_INNER_ORDER, degree + 1):
            smoother = [order if k == at else x for k, x in enumerate(smooth)]
            fewer, basis = joined_spans(points, np.array(places), smoother)
            if _change(fewer, basis, found, along) > _NO_KNOT:
                break
            smooth, found, along = smoother, fewer, basis
    if seam is not None:
        # To the last bit: kernels make both ends of a closed surface one, and it would not be read as it was written.
        found[:, -1] = found[:, 0]
    return found, along


def _close(points: list[FloatArray], widths: FloatArray, continuity: int) -> None:
    """Let the last span end where the first one begins, faces that meet within a tolerance only: as at inner joints."""
    before, after = points[-1][:, -2], points[0][:, 1]
    if continuity:
        common = (widths[0] * before + widths[-1] * after) / (widths[0] + widths[-1])
    else:
        common = (points[-1][:, -1] + points[0][:, 0]) / 2
    points[-1], points[0] = points[-1].copy(), points[0].copy()
    points[-1][:, -1] = points[0][:, 0] = common


def _cut_splines(joined: JoinedPieces, places: Sequence[float]) -> list[int]:
    """Return which inner places are joints of which neither side is bent by what runs through it."""
    cuts = np.cumsum(joined.spans)[:-1]
    bent = [own.slopes.any() or (own.values[0] != own.values[1]).any() for own in joined.coefficients]
    inner = np.array(places[1:-1])
    return [
        int(np.abs(inner - cut).argmin())
        for k, cut in enumerate(cuts.tolist())
        if joined.continuity[k + 1] and not bent[k] and not bent[k + 1]
    ]


def _change(one: FloatArray, one_basis: Basis, other: FloatArray, other_basis: Basis) -> float:
    """Return by how much jets differ, relative to what each order may be."""
    t = np.linspace(one_basis.knots[0], one_basis.knots[-1], 8 * one_basis.size + 1)
    values = [
        np.stack([basis_matrix(basis.degree, basis.knots, t) @ row for row in jets])
        for jets, basis in ((one, one_basis), (other, other_basis))
    ]
    sizes = np.abs(values[1]).max(axis=(1, 2))
    extent = float(np.ptp(values[1][0], axis=0).max())
    expected = extent * (sizes[1] / extent) ** np.arange(len(sizes))
    return float((np.abs(values[0] - values[1]).max(axis=(1, 2)) / np.maximum(sizes, expected)).max())


def _is_plain(own: Coefficients) -> bool:
    """Tell whether nothing but a constant factor runs through a piece."""
    plain = np.zeros_like(own.values[0])
    plain[0, 0], plain[1, 1] = own.values[0, 0, 0], 1.0
    return not own.slopes.any() and bool((own.values == plain).all())


def _degree(piece: Piece, own: Coefficients) -> int:
    """Return the degree of the strip along a piece."""
    lam, w, q = own.degrees
    result = np.full(piece.order + 1, -np.inf)
    shifted = lam
    for b in range(piece.order + 1):
        power = shifted
        for degree in piece.degrees[: piece.order + 1 - b]:
            if b <= degree:
                result = np.maximum(result, power + degree - b)
            power = _degree_of_product(power, w)
        shifted = _degree_of_product(shifted, q)
    return int(result.max())


def _degree_of_product(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.array([max(a[i] + b[k - i] for i in range(k + 1)) for k in range(len(a))])
