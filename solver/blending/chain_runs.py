"""Chains that have corners: which corner of one answers which of the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.chain_joints import CORNER
from semispline.solver.blending.chains import Chain
from semispline.solver.options import Flip


def facing_chains(a: Chain, b: Chain, flip: Flip) -> tuple[Chain, Chain] | None:
    """Return both chains run through alike, from corner to corner: the first begins at a corner where it is closed.

    Of all ways to let their corners answer each other in turn the one that brings them closest, both chains centred.
    None where they do not have as many corners, or none, or one of them is closed and the other is not.
    """
    corners = _corners(a), _corners(b)
    if len(corners[0]) != len(corners[1]) or not corners[0] or a.closed != b.closed:
        return None
    first = begun_at(a, corners[0][0]) if a.closed else a
    ways = [
        way
        for turned in (False, True)
        if flip == "auto" or (flip == "yes") == turned
        for way in _ways(run_back(b) if turned else b)
    ]
    wanted = _centred(_stations(first))
    return first, min(ways, key=lambda way: float(np.sum((_centred(_stations(way)) - wanted) ** 2)))


def _ways(b: Chain) -> list[Chain]:
    return [begun_at(b, k) for k in _corners(b)] if b.closed else [b]


def begun_at(chain: Chain, k: int) -> Chain:
    """Return a closed chain that begins at its edge k."""
    return replace(
        chain,
        edges=chain.edges[k:] + chain.edges[:k],
        turned=chain.turned[k:] + chain.turned[:k],
        names=chain.names[k:] + chain.names[:k],
    )


def run_back(chain: Chain) -> Chain:
    """Return the chain run through the other way."""
    turned = tuple(not back for back in chain.turned[::-1])
    return replace(chain, edges=chain.edges[::-1], turned=turned, names=chain.names[::-1], ends_on=chain.ends_on[::-1])


def _corners(chain: Chain) -> list[int]:
    """Return which edges begin at a corner."""
    ends = _ends(chain)
    found = []
    for k in range(0 if chain.closed else 1, len(ends)):
        before, after = ends[k - 1][1, 1], ends[k][1, 0]
        turn = np.degrees(np.arctan2(np.linalg.norm(np.cross(before, after)), before @ after))
        if turn > CORNER:
            found.append(k)
    return found


def _stations(chain: Chain) -> FloatArray:
    """Return where the chain begins, its corners, and where it ends."""
    ends = _ends(chain)
    return np.array([ends[0][0, 0], *(ends[k][0, 0] for k in _corners(chain) if k), ends[-1][0, 1]])


def _ends(chain: Chain) -> list[FloatArray]:
    """Return points and derivatives along at the start and the end of each edge, shape (2, 2, 3)."""
    found = []
    for base, back in zip(chain.edges, chain.turned, strict=True):
        at = np.array(base.range_along)
        points, slopes = base.derivative(at, 0, 0), base.derivative(at, 0, 1)
        found.append(np.stack([points[::-1], -slopes[::-1]] if back else [points, slopes]))
    return found


def _centred(points: FloatArray) -> FloatArray:
    return np.asarray(points - points.mean(axis=0))
