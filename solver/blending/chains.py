"""Edges that run end to end, each on its own face, as one base: a strip in exact contact with all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_coefficients import JoinedPieces, Joint
from semispline.solver.blending.chain_joints import EndFaces, joined_pieces, only_continuous
from semispline.solver.blending.chain_merging import merged_pieces
from semispline.solver.blending.chain_pieces import Piece, read_pieces
from semispline.solver.blending.chain_rows import assembled, positive_rows, rows_of_jets, well_told_width
from semispline.solver.blending.conics import recognised_conic
from semispline.solver.errors import EdgeError, OptionError
from semispline.solver.judge import Base, edge_length, is_closed, local_origin, model_size
from semispline.solver.options import Continuity
from semispline.solver.splines import Basis, BSplineSurface, boundary_curve, closest_point, euclidean

# Ends of edges nearer than this, of the size of the faces, are one point, unless a file says otherwise.
_MEET = 1e-7
# Less than this, of q over the length of a span, is rounding: lines across do not lean.
_LEANS = 1e-12
# Times its width a face could be wider before its rows are taken further apart than it has them.
_SMALL = 4.0


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
        # A circle run through anew would leave the faces at its ends.
        conic = None
        if not _is_steered(joined):
            conic = _as_conic(pieces, joined, closed=self.closed, tolerance=self.tolerance)
        if conic:
            return self._strip(joined if lengths is None else _with_lengths(joined, lengths), *conic)
        merged = merged_pieces(pieces, joined, closed=self.closed)
        if merged.inside:
            joined = joined_pieces(
                list(merged.pieces), closed=self.closed, tolerance=self.tolerance, ends_on=self.ends_on
            )
        if lengths is not None:
            joined = _with_lengths(joined, lengths)
        strip = self._strip(joined, *assembled(joined))
        return replace(strip, begins=pieces[merged.first].edge).with_joints(merged.inside, self.origin)

    def rim_pieces(self, order: int) -> JoinedPieces:
        """Return the pieces with nothing but their values made to agree; errors as `strip`."""
        pieces = self._pieces(order)
        joined = joined_pieces(pieces, closed=self.closed, tolerance=self.tolerance)
        return only_continuous(pieces, joined, closed=self.closed, tolerance=self.tolerance)

    def rim(self, order: int, spans: FloatArray | None = None) -> Strip:
        """Return a base of which rows are only continuous at joints, with spans as given; errors as `strip`."""
        joined = self.rim_pieces(order)
        joined = joined if spans is None else replace(joined, spans=spans)
        return self._strip(joined, *assembled(joined))

    def is_steered(self, order: int) -> bool:
        """Tell whether its lines across have to be bent at its ends, to lie on the faces there; errors as `strip`."""
        if self.closed or self.ends_on == (None, None):
            return False
        return _is_steered(
            joined_pieces(self._pieces(order), closed=False, tolerance=self.tolerance, ends_on=self.ends_on)
        )

    @property
    def origin(self) -> FloatArray:
        """The point that is subtracted from all others while its strip is made."""
        return local_origin(*(base.surface for base in self.edges))

    def _pieces(self, order: int) -> list[Piece]:
        return read_pieces(self.edges, self.turned, max(order, 1), self.origin)

    def _strip(self, joined: JoinedPieces, jets: FloatArray, along: Basis) -> Strip:
        first = self.edges[0]
        low, high = first.surface.domain["uv".index(first.side[0])]
        wide = high - low
        # To second order narrow rows tell enough.
        if len(jets) > 3 and (told := well_told_width(jets, along)) > _SMALL * wide:
            wide = told
        shown, surface = (self._surface(jets, along, width) for width in (high - low, wide))
        cuts = np.concatenate([[0.0], np.cumsum(joined.spans)])
        joints = tuple(joint if joint is None else joint.moved_by(self.origin) for joint in joined.joints)
        return Strip(surface, shown, self.edges, self.turned, joined.spans, tuple(cuts.tolist()), joints)

    def _surface(self, jets: FloatArray, along: Basis, width: float) -> BSplineSurface:
        rows, width = positive_rows(jets, along, width)
        points, weights = euclidean(rows)
        degree = len(jets) - 1
        knots = np.repeat([0.0, width], degree + 1)
        return BSplineSurface(degree, along.degree, knots, along.knots, points + self.origin, weights)


@dataclass(frozen=True, eq=False)
class Strip:
    """A chain as one base.

    Attributes
    ----------
    surface : BSplineSurface
        Met at u0. It may reach further than the faces: rows that lie close together would lose derivatives by rounding.
    shown : BSplineSurface
        The part of it that is about as wide as the first face.
    edges : tuple of Base
    turned : tuple of bool
        Of the chain.
    spans : ndarray
        How long each piece is.
    cuts : tuple of float
        Where the pieces begin along the base, and where the last one ends.
    joints : tuple of Joint or None
        At each but the last of `cuts`; None at the start of an open chain.
    begins : int
        The edge with which it begins.
    """

    surface: BSplineSurface
    shown: BSplineSurface
    edges: tuple[Base, ...]
    turned: tuple[bool, ...]
    spans: FloatArray
    cuts: tuple[float, ...]
    joints: tuple[Joint | None, ...]
    begins: int = 0

    def with_joints(self, joints: Sequence[Joint], origin: FloatArray) -> Strip:
        """Return the strip with joints more, that lie inside of its pieces; counted from `origin`."""
        if not joints:
            return self
        moved = [joint.moved_by(origin) for joint in joints]
        edge = boundary_curve(self.surface, "u0")
        places = [float(np.ravel(closest_point(edge, joint.point).parameters)[0]) for joint in moved]
        known = [*zip(self.cuts, self.joints, strict=False), *zip(places, moved, strict=True)]
        found = sorted(known, key=lambda one: one[0])
        return replace(self, cuts=(*(at for at, _ in found), self.cuts[-1]), joints=tuple(joint for _, joint in found))

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
        if x in (0, count) and self.begins == 0:
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


def _is_steered(joined: JoinedPieces) -> bool:
    """Tell whether the lines across a free end lean along the contact, so that they lie on an end face."""
    ends = (joined.coefficients[0].values[0], joined.coefficients[-1].values[1])
    is_open = joined.joints[0] is None
    return is_open and any(float(np.abs(values[2, 1:]).max(initial=0.0)) > _LEANS for values in ends)


def _as_conic(
    pieces: list[Piece], joined: JoinedPieces, *, closed: bool, tolerance: float
) -> tuple[FloatArray, Basis] | None:
    """Return pieces that are one conic together, joined continuously: `blend` runs through it by a smooth circle."""
    if pieces[0].jets.shape[2] == 3 or any(x is not None and x.kind != "smooth" for x in joined.joints):
        return None
    jets, along = assembled(only_continuous(pieces, joined, closed=closed, tolerance=tolerance))
    return None if recognised_conic(rows_of_jets(jets, 1.0), along) is None else (jets, along)
