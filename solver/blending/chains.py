"""Edges that run end to end, each on its own face, as one base: a strip in exact contact with all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_joints import (
    Coefficients,
    EndFaces,
    JoinedPieces,
    Joint,
    joined_pieces,
    only_continuous,
)
from semispline.solver.blending.chain_pieces import Piece, normalised_jets, read_pieces
from semispline.solver.blending.conics import recognised_conic
from semispline.solver.blending.reparametrisation import (
    Reparametrisation,
    bezier_derivatives,
    bezier_points,
    chebyshev_places,
    composed,
    elevation,
)
from semispline.solver.blending.spans import bezier_pieces, joined_spans
from semispline.solver.blending.weights import rows_from_derivatives
from semispline.solver.errors import EdgeError, OptionError
from semispline.solver.judge import Base, edge_length, is_closed, local_origin, model_size
from semispline.solver.options import Continuity
from semispline.solver.splines import Basis, BSplineSurface, basis_matrix, boundary_curve, closest_point, euclidean

# Ends of edges nearer than this, of the size of the faces, are one point, unless a file says otherwise.
_MEET = 1e-7
_MOST_DEGREE = 25
_INNER_ORDER = 2
# Of the contact: weights of the strip's other rows stay above it.
_LEAST_WEIGHT = 0.25
# A knot that is not needed changes no value by more than this, relative to its order.
_NO_KNOT = 1e-12


@dataclass(frozen=True, eq=False)
class Chain:
    """Edges that run end to end.

    Attributes
    ----------
    edges : tuple of Base
        In the order in which they follow each other.
    turned : tuple of bool
        Which of them are run through against their own parameter.
    closed : bool
        The last one ends where the first one begins.
    names : tuple of str
        What each is called in what is said of it.
    tolerance : float
        How far apart ends that are one point may lie, model units.
    ends_on : pair of EndFace or None
        On which faces the lines across its two ends are to lie.
    """

    edges: tuple[Base, ...]
    turned: tuple[bool, ...]
    closed: bool
    names: tuple[str, ...]
    tolerance: float
    ends_on: EndFaces = (None, None)

    def strip(self, order: int, lengths: Sequence[float] | None = None) -> Strip:
        """Return the base that stands for the chain in a contact of the given order.

        Parameters
        ----------
        order : int
        lengths : sequence of float, optional
            In v, that the smooth runs between its corners are to have, where they are as many.

        Raises
        ------
        EdgeError
            Faces do not meet along one curve where edges meet.
        """
        pieces = self._pieces(order)
        joined = joined_pieces(pieces, closed=self.closed, tolerance=self.tolerance, ends_on=self.ends_on)
        if lengths is not None:
            joined = _with_lengths(joined, lengths)
        conic = None
        if self.ends_on == (None, None):
            # One conic is run through anew, its ends as they are: what is steered stays in pieces.
            conic = _as_conic(pieces, joined, closed=self.closed, tolerance=self.tolerance)
        return self._strip(joined, *(conic or _assembled(joined)))

    def rim_pieces(self, order: int) -> JoinedPieces:
        """Return the pieces with nothing but their values made to agree; errors as `strip`."""
        pieces = self._pieces(order)
        joined = joined_pieces(pieces, closed=self.closed, tolerance=self.tolerance)
        return only_continuous(pieces, joined, closed=self.closed, tolerance=self.tolerance)

    def rim(self, order: int, spans: FloatArray | None = None) -> Strip:
        """Return a base of which rows are only continuous at joints, with spans as given; errors as `strip`."""
        joined = self.rim_pieces(order)
        joined = joined if spans is None else replace(joined, spans=spans)
        return self._strip(joined, *_assembled(joined))

    @property
    def _origin(self) -> FloatArray:
        return local_origin(*(base.surface for base in self.edges))

    def _pieces(self, order: int) -> list[Piece]:
        return read_pieces(self.edges, self.turned, max(order, 1), self._origin)

    def _strip(self, joined: JoinedPieces, jets: FloatArray, along: Basis) -> Strip:
        first = self.edges[0]
        low, high = first.surface.domain["uv".index(first.side[0])]
        rows, width = _positive_rows(jets, along, high - low)
        points, weights = euclidean(rows)
        degree = len(jets) - 1
        knots = np.repeat([0.0, width], degree + 1)
        surface = BSplineSurface(degree, along.degree, knots, along.knots, points + self._origin, weights)
        cuts = np.concatenate([[0.0], np.cumsum(joined.spans)])
        joints = tuple(joint if joint is None else joint.moved_by(self._origin) for joint in joined.joints)
        return Strip(surface, self.edges, self.turned, joined.spans, tuple(cuts.tolist()), joints)


@dataclass(frozen=True, eq=False)
class Strip:
    """A chain as one base.

    Attributes
    ----------
    surface : BSplineSurface
        Met at u0.
    edges : tuple of Base
    turned : tuple of bool
        Of the chain.
    spans : ndarray
        How long each piece is.
    cuts : tuple of float
        Where the pieces begin along the base, and where the last one ends.
    joints : tuple of Joint or None
        At each but the last of `cuts`; None at the start of an open chain.
    """

    surface: BSplineSurface
    edges: tuple[Base, ...]
    turned: tuple[bool, ...]
    spans: FloatArray
    cuts: tuple[float, ...]
    joints: tuple[Joint | None, ...]

    def place(self, x: float) -> float:
        """Return the parameter along the strip of a place on the chain: x = k + s is the share s of edge k.

        Raises
        ------
        OptionError
            There is no such edge.
        """
        count = len(self.edges)
        if not 0 <= x <= count:
            raise OptionError(f"match: found {x:g} along a chain of {count} edges, expected 0 to {count}")
        k = min(int(x), count - 1)
        start, end = self.edges[k].range_along
        at = end - (x - k) * (end - start) if self.turned[k] else start + (x - k) * (end - start)
        if x in (0, count):
            return self.cuts[0] if x == 0 else self.cuts[-1]
        point = self.edges[k].derivative(np.array([at]), 0, 0)[0]
        return float(np.ravel(closest_point(boundary_curve(self.surface, "u0"), point).parameters)[0])

    @property
    def base(self) -> Base:
        """The surface and its edge."""
        return Base(self.surface, "u0")

    @property
    def lengths(self) -> tuple[float, ...]:
        """How long, in v, the smooth runs between corners are."""
        corners = [
            at
            for at, joint in zip(self.cuts, self.joints, strict=False)
            if joint is not None and joint.kind == "corner"
        ]
        return tuple(np.diff(np.unique([self.cuts[0], *corners, self.cuts[-1]])).tolist())


def order_of_contact(continuity: Continuity, name: str) -> int:
    """Return the order of a contact with a chain.

    Raises
    ------
    OptionError
        C1 or C2: the derivatives of one face are not those of the next.
    """
    if continuity in ("C1", "C2"):
        raise OptionError(
            f"continuity: found {continuity} at {name}, which is a chain, expected G{continuity[1]}: parameters of "
            "several faces are not one"
        )
    return int(continuity[1])


def chain(edges: Sequence[Base], *, tolerance: float | None = None, names: Sequence[str] | None = None) -> Chain:
    """Return edges that run end to end as one contact, to be blended like a base.

    Parameters
    ----------
    edges : sequence of Base
        In order; each may run either way.
    tolerance : float, optional
        How far apart, in model units, ends that are to be one point may lie; 1e-7 of the size of the faces. Edges that
        are shorter are left out.
    names : sequence of str, optional
        What each edge is called in what is said of it, as "12:e3" of a file; else what `Base` calls it.

    Raises
    ------
    EdgeError
        No edges; one that does not begin where the last one ends, or is closed by itself.
    """
    bases = tuple(edges)
    if not bases:
        raise EdgeError("chain: found no edges, expected one at least")
    called = tuple(base.edge for base in bases) if names is None else tuple(names)
    within = _MEET * model_size(*(base.surface for base in bases)) if tolerance is None else tolerance
    # An edge shorter than that is where its neighbours meet.
    kept = [k for k, base in enumerate(bases) if edge_length(base) > within] or [0]
    bases, called = tuple(bases[k] for k in kept), tuple(called[k] for k in kept)
    if len(bases) == 1:
        return Chain(bases, (False,), is_closed(bases[0]), called, within)
    for k, base in enumerate(bases):
        if is_closed(base):
            raise EdgeError(f"chain: edge {k} ({called[k]}) is closed by itself, expected edges that run end to end")
    ends = [base.derivative(np.array(base.range_along), 0, 0) for base in bases]
    turned: list[bool] = []
    place: FloatArray | None = None
    for k, (start, end) in enumerate(ends):
        if place is None:
            following = ends[1]
            apart = [np.linalg.norm(following - x, axis=1).min() for x in (start, end)]
            turned.append(bool(apart[0] < apart[1]))
        else:
            apart = [float(np.linalg.norm(place - x)) for x in (start, end)]
            if min(apart) > within:
                raise EdgeError(
                    f"chain: edge {k} ({called[k]}) begins {min(apart):.3g} away from where edge {k - 1} ends, "
                    f"expected at most {within:.3g}; name the edges in the order in which they follow each other"
                )
            turned.append(apart[1] < apart[0])
        place = start if turned[-1] else end
    first = ends[0][1] if turned[0] else ends[0][0]
    assert place is not None
    return Chain(bases, tuple(turned), bool(np.linalg.norm(place - first) <= within), called, within)


def _with_lengths(joined: JoinedPieces, lengths: Sequence[float]) -> JoinedPieces:
    """Return the pieces with spans such that each smooth run has its length."""
    runs = np.cumsum([k > 0 and joint is not None and joint.kind == "corner" for k, joint in enumerate(joined.joints)])
    if runs[-1] + 1 != len(lengths):
        return joined
    factors = np.asarray(lengths) / np.bincount(runs, weights=joined.spans)
    return replace(joined, spans=joined.spans * factors[runs])


def _as_conic(
    pieces: list[Piece], joined: JoinedPieces, *, closed: bool, tolerance: float
) -> tuple[FloatArray, Basis] | None:
    """Return pieces that are one conic together, joined continuously: `blend` runs through it by a smooth circle."""
    if pieces[0].jets.shape[2] == 3 or any(x is not None and x.kind != "smooth" for x in joined.joints):
        return None
    jets, along = _assembled(only_continuous(pieces, joined, closed=closed, tolerance=tolerance))
    return None if recognised_conic(_rows(jets, 1.0), along) is None else (jets, along)


def _positive_rows(jets: FloatArray, along: Basis, width: float) -> tuple[FloatArray, float]:
    """Return the control rows of a strip, and how wide it is in u: as asked, or less where weights would vanish.

    Raises
    ------
    EdgeError
        The weights of the contact itself are not positive.
    """
    if jets.shape[2] == 3:
        return _rows(jets, width), width
    jets = normalised_jets(jets, along)
    least = _LEAST_WEIGHT * float(jets[0, :, 3].min())
    if least <= 0:
        raise EdgeError(
            "chain: its weights cannot be made smooth and positive; use bases with more even weights along their "
            "edges, or blend the edges one by one"
        )
    while (rows := _rows(jets, width))[..., 3].min() < least:
        width /= 2
    return rows, width


def _rows(jets: FloatArray, width: float) -> FloatArray:
    """Return control rows from the edge inwards, of a surface of the degree of the order over [0, width]."""
    order = len(jets) - 1
    return np.asarray(np.einsum("kd,dnc->knc", rows_from_derivatives(order, order, (width,) * order), jets))


def _assembled(joined: JoinedPieces) -> tuple[FloatArray, Basis]:
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
