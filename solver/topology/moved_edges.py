"""Two edges whose contacts are moved into their faces, as along a sharp edge between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.errors import EdgeError, FileError
from semispline.solver.io import LoadedSurface, read_surfaces, split_spec
from semispline.solver.splines import BSplineSurface, parse_edge
from semispline.solver.topology.band_search import Continuity
from semispline.solver.topology.cuts import Cut, moved_contact, parse_cut
from semispline.solver.topology.edge_names import LINE, line_tolerance
from semispline.solver.topology.face_edges import (
    ResolvedEdge,
    check_face,
    is_of_a_face,
    resolve_edges,
    row_of,
)
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.outlines import border, outline_of
from semispline.solver.topology.relations import relate


def moved_edges(
    specs: tuple[str, str],
    edges: tuple[str | None, str | None],
    cuts: tuple[str | None, str | None],
    continuity: tuple[Continuity, Continuity] = ("G2", "G2"),
) -> list[ResolvedEdge]:
    """Return the edges of a blend whose contacts are moved into the faces.

    Parameters
    ----------
    specs : (str, str)
        "PATH#N" of both surfaces.
    edges : (str or None, str or None)
        As `resolve_edge` takes them; both None for the one edge that two faces of one file share.
    cuts : (str or None, str or None)
        A distance in model units, "2.5": along the surface, square to the edge; a parameter, "u=0.3"; None where the
        contact stays.
    continuity : (str, str)
        That contacts along free curves are to be met with.

    Raises
    ------
    EdgeError
        The faces share no edge, or several; a cut reaches beyond the face: the largest possible one is said.
    FileError, ComputationError
        As `resolve_edge`.
    """
