"""The blend of a chain as faces of a file: cut where it is only continuous, or wherever faces of a chain meet."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Literal

import numpy as np

from semispline.solver.blending.chain_contact import ChainContact
from semispline.solver.blending.result import BlendResult
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface, split_v

# Of the range of v: a joint that is nearer to a knot lies on it, and two that are nearer are one.
_SAME_PLACE = 1e-6

Split = Literal["corners", "joints"]


def faces_of_blend(result: BlendResult, split: Split = "corners") -> tuple[SemiStructuredSurface | BSplineSurface, ...]:
    """Return a blend as the surfaces that a file of faces is to hold.

    Parameters
    ----------
    result : BlendResult
    split : {"corners", "joints"}
        "corners": cut where a joint is no smooth one, or its rows are only continuous: what lies inside of a face has
        to be smooth. "joints": wherever two faces of a chain meet, too.

    Returns
    -------
    tuple of BSplineSurface
        Neighbours have the same control points along the edge that they share. The blend itself where it is not cut.
    """
    surface = result.surface
    places = split_places(result, split)
    if not places:
        return (surface,)
    rest = surface.to_bspline()
    pieces = []
    for place in places:
        piece, rest = split_v(rest, place)
        pieces.append(piece)
    return (*pieces, rest)


def split_places(result: BlendResult, split: Split = "corners") -> tuple[float, ...]:
    """Return the parameters v at which a blend is cut, as `faces_of_blend` does."""
    surface = result.surface
    start, end = surface.domain[1]
    within = _SAME_PLACE * (end - start)
    knots = np.unique(np.concatenate([curve.knots for curve in surface.control_curves]))
    places: list[float] = []
    for chain in (result.chain_a, result.chain_b):
        for at, is_cut in () if chain is None else _joints(chain, split):
            k = int(np.abs(knots - at).argmin())
            on_knot = abs(knots[k] - at) <= within
            place = float(knots[k]) if on_knot else at
            if is_cut or (on_knot and _only_continuous(surface, place)):
                places.append(place)
    found: list[float] = []
    for place in sorted(places):
        if place - start > within and end - place > within and not (found and place - found[-1] <= within):
            found.append(place)
    return tuple(found)


def _joints(chain: ChainContact, split: Split) -> Iterator[tuple[float, bool]]:
    """Yield where joints lie along the blend, and whether it is cut there whatever its rows are."""
    for joint, at in zip(chain.joints, chain.places, strict=True):
        yield at, joint.kind != "smooth"
    if split == "joints":
        for before, after in pairwise(chain.faces):
            yield after.range[0], before.edge != after.edge


def _only_continuous(surface: SemiStructuredSurface, at: float) -> bool:
    return any(int(np.sum(curve.knots == at)) >= curve.degree for curve in surface.control_curves)
