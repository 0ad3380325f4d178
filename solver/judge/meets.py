"""Whether a finished surface meets itself or one of the bases that it joins: what is proved, and what is found.

First a certificate that needs no mesh (`seen_from`). Where it gives no answer, a mesh is searched for triangles that
cross, and each hit is confirmed on the true surfaces. A mesh alone never says that nothing meets.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from semispline.solver.judge.base import Base
from semispline.solver.judge.confirmed_meetings import Meeting, Places, What, search_base, search_itself
from semispline.solver.judge.continuation import Continuation, continuation
from semispline.solver.judge.mesh_search import grid_mesh
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import closed_directions, no_tangent_plane, spread, unit_normals
from semispline.solver.judge.seen_from import Direction, seen_from

# Cells of the mesh along u, along v (twice as many where closed) and into a base; the least in each span; all.
_CELLS_U, _CELLS_V, _CELLS_W, _LEAST, _MOST_CELLS = 120, 30, 40, 2, 40000


@dataclass(frozen=True)
class Meets:
    """Whether a surface meets itself or one of its bases.

    Attributes
    ----------
    seen_from : tuple of float or None
        A direction from which the surface covers itself nowhere: it cannot meet itself.
    seen_from_with_bases : tuple of float or None
        One from which it does not together with its bases either: it cannot meet them.
    asked : tuple of {"itself", "a", "b"}
        What was asked for: itself, and the bases that were given.
    searched : tuple of {"itself", "a", "b"}
        What a mesh was searched for, since the directions leave it open.
    found : tuple of Meeting
        One for each place that was found and confirmed.
    unconfirmed : int
        Places where triangles cross and the true surfaces were not found to: closer than the mesh can tell.
    deflection : float or None
        How far the mesh is from the surfaces, in model units: what meets less deeply may be missed. None where none was
        made.
    """

    seen_from: Direction | None
    seen_from_with_bases: Direction | None
    asked: tuple[What, ...]
    searched: tuple[What, ...]
    found: tuple[Meeting, ...]
    unconfirmed: int
    deflection: float | None

    def answer(self, what: What) -> bool | None:
        """Tell whether it meets itself or a base: True found, False impossible, None not known.

        A mesh alone never says "no": None also where it was searched in vain.
        """
        if any(meeting.what == what for meeting in self.found):
            return True
        shown = self.seen_from if what == "itself" else self.seen_from_with_bases
        return None if shown is None or what not in self.asked else False

    @property
    def sentences(self) -> tuple[str, ...]:
        """What is known, in words."""
        says = []
        if self.seen_from is not None:
            says.append(f"cannot meet itself: {_covers(self.seen_from)}")
        if self.seen_from_with_bases is not None:
            says.append(f"cannot meet its bases: together with them {_covers(self.seen_from_with_bases)}")
        says += [str(meeting) for meeting in self.found]
        names = {"itself": "itself", "a": "base a", "b": "base b"}
        unknown = [what for what in self.asked if self.answer(what) is None]
        says += [
            f"not found to meet {names[what]}; what meets by less than {self.deflection:.3g} may be missed"
            for what in unknown
            if what in self.searched
        ]
        if self.unconfirmed:
            says.append(f"comes closer than the mesh can tell ({self.deflection:.3g}) in {self.unconfirmed} place(s)")
        if left := [names[what] for what in unknown if what not in self.searched]:
            says.append(
                f"not known whether it meets {' or '.join(left)}: no direction shows it, and no mesh was searched"
            )
        return tuple(says)


def _covers(direction: Direction) -> str:
    x, y, z = direction
    return f"seen from direction ({x:.3f}, {y:.3f}, {z:.3f}) it covers itself nowhere"


def measure_meets(
    surface: ParametricSurface, a: Base | None = None, b: Base | None = None, *, search: bool = True
) -> Meets:
    """Return whether a surface can be seen not to meet itself and its bases, or where it is found to.

    Parameters
    ----------
    surface : BSplineSurface, SemiStructuredSurface or ParametricSurface
    a, b : Base, optional
        What it joins at the start and at the end of u.
    search : bool
        Whether to search a mesh where the certificate gives no answer.

    Raises
    ------
    EdgeError
        The edge of a base is not the surface's.
    InputError
        The surface has no tangent plane anywhere.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> flat = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> measure_meets(flat).sentences
    ('cannot meet itself: seen from direction (0.000, 0.000, 1.000) it covers itself nowhere',)
    """
    bases: dict[Literal["a", "b"], Continuation] = {}
    if a is not None:
        bases["a"] = continuation(surface, a, 0)
    if b is not None:
        bases["b"] = continuation(surface, b, 1)
    whole = seen_from(surface, bases.get("a"), bases.get("b")) if bases else None
    # Part of a disc that is one to one.
    alone = whole or seen_from(surface)
    asked: tuple[What, ...] = ("itself", *bases)
    searched: list[What] = []
    if search:
        if alone is None:
            searched.append("itself")
        if whole is None:
            searched += bases
    if not searched:
        return Meets(alone, whole, asked, (), (), 0, None)
    closed = closed_directions(surface)
    u_breaks, v_breaks = surface.breakpoints
    v = spread(v_breaks, _CELLS_V * (2 if closed[1] else 1), _LEAST)
    u = spread(u_breaks, min(_CELLS_U, max(24, _MOST_CELLS // len(v))), _LEAST)
    if np.isnan(unit_normals(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))).all():
        raise no_tangent_plane()
    own = grid_mesh(surface, u, v, closed)
    places: list[Places] = []
    deflection = own.deflection
    for what in searched:
        if what == "itself":
            places.append(search_itself(surface, own))
            continue
        base = bases[what]
        w = spread(base.breakpoints[0], min(_CELLS_W, max(12, _MOST_CELLS // len(v))), _LEAST)
        there, off = search_base(surface, own, base, w, what)
        places.append(there)
        deflection = max(deflection, off)
    found = tuple(meeting for there in places for meeting in there.found)
    return Meets(alone, whole, asked, tuple(searched), found, sum(there.unconfirmed for there in places), deflection)
