"""Pieces of a chain that follow each other on one line or one conic, as one piece.

An arc that is cut in two is one circle, and run through as two it has a jump of curvature of its parametrisation in the
middle. Kernels cut half circles themselves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, cos, pi, sin

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_coefficients import JoinedPieces, Joint
from semispline.solver.blending.chain_joints import only_continuous
from semispline.solver.blending.chain_pieces import Piece, standard
from semispline.solver.blending.chain_rows import assembled, jets_of_rows, rows_of_jets
from semispline.solver.blending.conics import Conic, recognised_conic
from semispline.solver.splines import Basis, affine_knots

# Arcs up to a half circle are one piece where their weights are made flat at both ends, which keeps them positive.
_LONGEST, _LONGEST_AT_CORNERS = pi, 2 * pi / 3
_NEAR = 1e-9
_QUADRATIC = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
# Roundings of a piece that was recognised and written anew, in those of its parts.
_ROUNDINGS = 16


@dataclass(frozen=True, eq=False)
class MergedPieces:
    """Pieces of a chain, of which each may stand for several.

    Attributes
    ----------
    pieces : tuple of Piece
    first : int
        Which of the former ones the chain begins with: a run that goes on over the start of a ring is no end of it.
    inside : tuple of Joint
        Joints that lie inside of pieces now.
    """

    pieces: tuple[Piece, ...]
    first: int
    inside: tuple[Joint, ...]


def merged_pieces(pieces: list[Piece], joined: JoinedPieces, *, closed: bool) -> MergedPieces:
    """Return pieces of which those on one line, or one conic, are one.

    Parameters
    ----------
    pieces : list of Piece
    joined : JoinedPieces
        What is found at their joints.
    closed : bool
    """
    count = len(pieces)
    goes_on = [_goes_on(joined.joints[k], pieces[k - 1], pieces[k]) for k in range(count)]
    begins = [k for k in range(count) if not goes_on[k] and pieces[k].edge != pieces[k - 1].edge]
    first = begins[0] if closed and goes_on[0] and begins else 0
    order = [(first + k) % count for k in range(count)]
    found: list[Piece] = []
    inside: list[Joint] = []
    while order:
        run = [order.pop(0)]
        while order and goes_on[order[0]]:
            run.append(order.pop(0))
        for stretch, new in _stretches(run, pieces, joined, closed=closed):
            found += new
            inside += [joint for k in stretch[1:] if (joint := joined.joints[k]) is not None]
    # Where none is merged the chain begins as it did.
    return MergedPieces(tuple(found), first, tuple(inside)) if inside else MergedPieces(tuple(pieces), 0, ())


def _goes_on(joint: Joint | None, before: Piece, after: Piece) -> bool:
    return (
        joint is not None
        and joint.kind == "smooth"
        and joint.is_exact
        and not joint.bends
        and before.is_straight == after.is_straight
    )


def _stretches(
    run: list[int], pieces: list[Piece], joined: JoinedPieces, *, closed: bool
) -> list[tuple[list[int], list[Piece]]]:
    """Return the longest parts of a run that are one line or conic, one after the other, and what stands for each."""
    found = []
    while run:
        taken, best = run[:1], [pieces[run[0]]]
        for length in range(2, len(run) + 1):
            new = _as_one([pieces[k] for k in run[:length]], joined, _longest(run[:length], joined, closed=closed))
            if new is None:
                break
            taken, best = run[:length], new
        found.append((taken, best))
        run = run[len(taken) :]
    return found


def _longest(run: list[int], joined: JoinedPieces, *, closed: bool) -> float:
    ends = [joined.joints[run[0]], joined.joints[(run[-1] + 1) % len(joined.joints)]]
    smooth = [joint is None or joint.kind != "corner" for joint in ends]
    return _LONGEST if all(smooth) and (closed or any(joint is not None for joint in ends)) else _LONGEST_AT_CORNERS


def _as_one(run: list[Piece], joined: JoinedPieces, longest: float) -> list[Piece] | None:
    """Return pieces that follow each other as one, or an arc that is too long as few equal ones; None for others."""
    jets, along = assembled(only_continuous(run, replace(joined, joints=(None,) * len(run)), closed=False))
    rounding = _ROUNDINGS * np.max([piece.rounding for piece in run], axis=0)
    whole = replace(run[0], range=(run[0].range[0], run[-1].range[1]), rounding=rounding)
    if run[0].is_straight:
        line = standard(replace(whole, jets=jets, along=Basis(along.degree, affine_knots(along.knots, 0.0, 1.0))))
        return [line] if line.jets.shape[1] == 2 else None
    if jets.shape[2] == 3:
        return None
    conic = recognised_conic(rows_of_jets(jets, 1.0), along)
    if conic is None:
        return None
    count = ceil(conic.turn / longest - _NEAR)
    if count >= len(run):
        return None
    return [
        standard(replace(whole, jets=jets_of_rows(_arc(conic, k, count)), along=Basis(2, _QUADRATIC)))
        for k in range(count)
    ]


def _arc(conic: Conic, k: int, count: int) -> FloatArray:
    """Return rows of part k of a conic cut in equal ones: the square of a line in the complex plane, by its frames."""
    half = conic.turn / count / 2
    middle = (2 * k + 1) * half
    points = np.array(
        [
            [cos(middle - half), sin(middle - half), 1.0],
            [cos(middle), sin(middle), cos(half)],
            [cos(middle + half), sin(middle + half), 1.0],
        ]
    )
    return np.asarray(np.einsum("nc,kcd->knd", points, conic.frames))
