"""Sharp edges of a solid rounded: the faces on both sides trimmed back, new faces between, what meets them trimmed.

One edge, or several that go on in each other. The shape that is worked on is a copy. Runs in the process that read the
file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import occ_surface
from semispline.solver.splines import BSplineSurface, iso_curve, split_v
from semispline.solver.topology.gate_report import Change
from semispline.solver.topology.occ_edges import wires
from semispline.solver.topology.occ_faces import closed_face, evenly, new_face, rebuilt, seam_edge, with_faces
from semispline.solver.topology.occ_new_edges import add_by_feet, border_edge, end_edge, line_on, settle, trimmed
from semispline.solver.topology.occ_rims import Break, Run, Sharp, breaks_of_rim
from semispline.solver.topology.occ_shapes import (
    EdgeUsers,
    add_pcurve,
    forward,
    is_reversed,
    parameters_of,
    parts,
    point_of,
    points_of,
    range_of,
)
from semispline.solver.topology.solid_orders import Rounding

_SAMPLES = 65


@dataclass(frozen=True, eq=False)
class _Piece:
    """A new edge of a border, in the direction of the run.

    Attributes
    ----------
    edge : TopoDS_Edge
    face : int
        Which old face lies beside it.
    old : int
        Number of the old edge in whose place it comes.
    patch : int
        Which of the new faces.
    is_first : bool
        It begins where an edge meets the run.
    """

    edge: Any
    face: int
    old: int
    patch: int
    is_first: bool


@dataclass(frozen=True, eq=False)
class _Patch:
    """A new face: its surface, the face without a border, and between which w it lies."""

    surface: BSplineSurface
    face: Any
    geometry: Any
    start: float
    end: float
    along: bool

    def v(self, w: float, whole: tuple[float, float]) -> float:
        """Return v at w, the ends of the surface to the last bit."""
        low, high = self.surface.domain[1]
        at_start, at_end = (low, high) if self.along else (high, low)
        if w in (self.start, self.end):
            return at_start if w == self.start else at_end
        return _v(w, whole, along=self.along)


def rounded(shape: Any, edges: Sequence[tuple[int, int]], order: Rounding) -> tuple[Any, Callable[[Any], Any], Change]:
    """Return the shape with edges rounded, what each of its parts became, and what is meant to have happened.

    Parameters
    ----------
    shape : TopoDS_Shape
        A copy.
    edges : sequence of (int, int)
        Those of the order, by the numbers of faces in the shape.
    order : Rounding
        Its surface is that in the shape.

    Raises
    ------
    EdgeError
        The edges cannot be rounded so.
    """
    run = _run(shape, edges, closed=order.closed)
    surface, faces = order.surface, parts(shape, "FACE")
    along = _runs_along(run, surface)
    whole = surface.domain[1]
    patches = _patches(surface, order.cuts, along=along)
    cuts = [patch.start for patch in patches[1:]]
    rims = [breaks_of_rim(run, side, iso_curve(surface, u=surface.domain[0][side]), along, cuts) for side in (0, 1)]
    borders = [_border(run, side, rims[side], patches, whole, faces) for side in (0, 1)]
    trims = _trims(run, rims)
    across = _across(run, rims, patches, faces)
    made = [
        _whole_face(run, m, patch, [[x.edge for x in border if x.patch == m] for border in borders], rims, across)
        for m, patch in enumerate(patches)
    ]
    for piece in (x for border in borders for x in border):
        settle(piece.edge, [patches[piece.patch].face, faces[piece.face]])
    touched = {n for x in run.edges for n in x.faces} | {n for k in trims for n, _ in run.users.of(run.users.edge(k))}
    ends_on = [x for x in across if x.beyond is not None]
    touched |= {x.beyond for x in ends_on if x.beyond is not None}
    new_faces = {
        n: rebuilt(
            faces[n],
            {**{k: [(edge, False)] for k, edge in trims.items()}, **_in_place(run, borders, n)},
            run.users,
            [(x.vertex, x.edge, x.starts) for x in ends_on if x.beyond == n],
        )
        for n in sorted(touched)
    }
    after, image = with_faces(shape, run.edges[0].faces[0], new_faces, made)
    all_faces = parts(after, "FACE")
    places = tuple(next(n for n, face in enumerate(all_faces) if face.IsSame(one)) for one in made)
    return after, image, _change(run, borders, places, tuple(sorted(touched)), grows=order.grows)


def _run(shape: Any, edges: Sequence[tuple[int, int]], *, closed: bool) -> Run:
    users, faces = EdgeUsers(shape), parts(shape, "FACE")
    title = (
        "edge {}:e{}".format(*edges[0]) if len(edges) == 1 else "edges {}:e{} to {}:e{}".format(*edges[0], *edges[-1])
    )
    found = []
    for number, k in edges:
        walked = [edge for edges_of_wire, _ in wires(faces[number]) for edge in edges_of_wire]
        if not 0 <= k < len(walked):
            raise EdgeError(f"{title}: face {number} has no edge e{k}, they are e0 to e{len(walked) - 1}")
        uses = users.of(walked[k])
        if len(uses) != 2 or uses[0][0] == uses[1][0]:
            raise EdgeError(f"{title}: {len(uses)} uses of e{k} by faces, expected those of two faces")
        (other,) = (n for n, _ in uses if n != number)
        found.append(Sharp(forward(walked[k]), users.number(walked[k]), (number, other), is_reversed(walked[k])))
    return Run(users, tuple(found), closed, title)


def _runs_along(run: Run, surface: BSplineSurface) -> bool:
    """Tell whether v runs in the direction of the run."""
    points = evenly(np.concatenate([x.points(_SAMPLES) for x in run.edges]), 5)[[1, 3]]
    low, high = surface.domain[1]
    middle = surface.evaluate_grid(surface.domain[0], low + (high - low) * np.array([0.25, 0.75])).mean(axis=0)
    along, against = (float(np.linalg.norm(x - points, axis=1).sum()) for x in (middle, middle[::-1]))
    return along <= against


def _v(w: float, whole: tuple[float, float], *, along: bool) -> float:
    low, high = whole
    return low + w * (high - low) if along else high - w * (high - low)


def _patches(surface: BSplineSurface, cuts: Sequence[float], *, along: bool) -> list[_Patch]:
    """Return the surfaces of the new faces, in the order of the run."""
    low, high = surface.domain[1]
    pieces, rest = [], surface
    for v in sorted(cuts):
        piece, rest = split_v(rest, v)
        pieces.append(piece)
    pieces.append(rest)
    places = [0.0, *((v - low) / (high - low) for v in sorted(cuts)), 1.0]
    if not along:
        pieces, places = pieces[::-1], [1 - w for w in places[::-1]]
    return [
        _Patch(piece, new_face(piece), occ_surface(piece), start, end, along)
        for piece, start, end in zip(pieces, places[:-1], places[1:], strict=True)
    ]


def _border(
    run: Run,
    side: int,
    breaks: Sequence[Break],
    patches: Sequence[_Patch],
    whole: tuple[float, float],
    faces: Sequence[Any],
) -> list[_Piece]:
    """Return the new edges of one border, in the direction of the run from w = 0."""
    found = []
    stops = [*breaks, Break(1.0, breaks[0].vertex, breaks[0].station)] if run.closed else breaks
    # The last vertex before w = 0 at which an edge meets a closed run says between which it lies there.
    known = [x.station for x in breaks if x.station is not None]
    station = 0 if not run.closed or not known else known[-1]
    for start, end in pairwise(stops):
        station = station if start.station is None else start.station
        old = run.edges[station]
        m = max(k for k, patch in enumerate(patches) if patch.start <= (start.w + end.w) / 2)
        patch = patches[m]
        u = patch.surface.domain[0][side]
        limits = patch.v(start.w, whole), patch.v(end.w, whole)
        edge = border_edge(patch.geometry.UIso(u), *limits, (start.vertex, end.vertex))
        add_pcurve(edge, line_on(edge, (u, limits[0]), (u, limits[1])), patch.face)
        number = old.faces[side]
        add_by_feet(edge, faces[number], _start_on(run, side, station, start, faces[number]))
        found.append(_Piece(edge, number, old.number, m, start.station is not None))
    return found


def _start_on(run: Run, side: int, station: int, start: Break, face: Any) -> FloatArray:
    """Return where on a face a new edge begins, as far as it is known."""
    old = run.edges[station]
    number = old.faces[side]
    if start.side is not None:
        used = [edge for n, edge in run.users.of(start.side) if n == number]
        if len(used) == 1:
            return np.asarray(parameters_of(used[0], face, np.array([start.at]))[0])
    # Of a seam the one of its two curves is meant at which the old edge begins.
    candidates = [old] if start.station is not None else [x for x in run.edges if x.faces[side] == number]
    best: tuple[float, FloatArray] | None = None
    for x in candidates:
        t = x.parameters(_SAMPLES)
        away = np.linalg.norm(points_of(x.edge, t) - point_of(start.vertex), axis=1)
        k = (
            0
            if start.station is not None or (run.closed and start.w == 0 and len(run.edges) == 1)
            else int(away.argmin())
        )
        used = next(edge for n, edge in run.users.of(x.edge) if n == number)
        if best is None or away[k] < best[0]:
            best = float(away[k]), np.asarray(parameters_of(used, face, t[k : k + 1])[0])
    assert best is not None
    return best[1]


def _trims(run: Run, rims: Sequence[Sequence[Break]]) -> dict[int, Any]:
    """Return for the number of each edge that is cut off what is left of it."""
    wanted: dict[int, list[tuple[Any, Any, float]]] = {}
    for place in (x for rim in rims for x in rim):
        if place.side is not None and place.station is not None:
            number = run.users.number(place.side)
            wanted.setdefault(number, []).append((run.vertex(place.station), place.vertex, place.at))
    return {number: trimmed(run.users.edge(number), at) for number, at in wanted.items()}


@dataclass(frozen=True, eq=False)
class _Across:
    """An edge from the first border to the second, or the seam of a closed run.

    Attributes
    ----------
    edge : TopoDS_Edge
    patches : (int or None, int or None)
        The new faces that end there and that begin there, along the run.
    beyond : int or None
        The old face beyond, at the ends of a run.
    vertex : TopoDS_Vertex or None
        The old one at that end.
    starts : bool
        The run begins there.
    """

    edge: Any
    patches: tuple[int | None, int | None]
    beyond: int | None = None
    vertex: Any = None
    starts: bool = False


def _across(
    run: Run, rims: Sequence[Sequence[Break]], patches: Sequence[_Patch], faces: Sequence[Any]
) -> list[_Across]:
    count, found = len(patches), []
    if run.closed and count == 1:
        (patch,) = patches
        low, high = patch.surface.domain[1]
        # The walk of the new face ends the first border where the run begins.
        end, start = (low, high) if patch.along else (high, low)
        vertices = (rims[0][0].vertex, rims[1][0].vertex)
        return [_Across(seam_edge(patch.geometry, patch.surface.domain[0], end, start, vertices, patch.face), (0, 0))]
    stations = [*(patch.start for patch in patches), *([] if run.closed else [1.0])]
    for m, w in enumerate(stations):
        a, b = (next(x for x in rim if x.w == w) for rim in rims)
        before = m - 1 if m else (count - 1 if run.closed else None)
        after = m if m < count else None
        edge, on = None, []
        for k, is_end in ((after, False), (before, True)):
            if k is None:
                continue
            patch = patches[k]
            u0, u1 = patch.surface.domain[0]
            v = patch.surface.domain[1][int(patch.along == is_end)]
            if edge is None:
                edge = end_edge(patch.geometry.VIso(v), (a.vertex, b.vertex))
            add_pcurve(edge, line_on(edge, (u0, v), (u1, v)), patch.face)
            on.append(patch.face)
        if before is not None and after is not None:
            settle(edge, on)
            found.append(_Across(edge, (before, after)))
            continue
        beyond = _beyond(run, a, b)
        used = next(x for n, x in run.users.of(a.side) if n == beyond)
        add_by_feet(edge, faces[beyond], np.asarray(parameters_of(used, faces[beyond], np.array([a.at]))[0]))
        settle(edge, [*on, faces[beyond]])
        vertex = run.vertex(0 if before is None else len(run.edges))
        found.append(_Across(edge, (before, after), beyond, vertex, before is None))
    return found


def _beyond(run: Run, a: Break, b: Break) -> int:
    """Return the face beyond an end."""
    of_a, of_b = ({n for n, _ in run.users.of(x.side)} for x in (a, b))
    common = of_a & of_b
    if len(common) != 1:
        raise EdgeError(f"{run.title}: more than one face lies beyond its end, expected one that can be trimmed")
    return common.pop()


def _whole_face(
    run: Run,
    m: int,
    patch: _Patch,
    edges: Sequence[Sequence[Any]],
    rims: Sequence[Sequence[Break]],
    across: Sequence[_Across],
) -> Any:
    """Return a new face with its border: it walks the first side against the run."""
    first = next(x.edge for x in across if x.patches[1] == m)
    last = next(x.edge for x in across if x.patches[0] == m)
    walk = [
        *((edge, True) for edge in reversed(edges[0])),
        (first, False),
        *((edge, False) for edge in edges[1]),
        (last, True),
    ]
    # Seen from outside the parameters run round the face where its first border runs against v.
    return closed_face(patch.face, walk, inwards=not patch.along)


def _in_place(run: Run, borders: Sequence[Sequence[_Piece]], face: int) -> Mapping[int, list[tuple[Any, bool]]]:
    """Return for the numbers of old edges of a face what comes in their places, in their own directions."""
    found: dict[int, list[tuple[Any, bool]]] = {}
    for old in run.edges:
        if face not in old.faces:
            continue
        pieces = [x.edge for x in _in_order(borders[old.faces.index(face)], old.number)]
        found[old.number] = [(x, old.against) for x in (reversed(pieces) if old.against else pieces)]
    return found


def _in_order(border: Sequence[_Piece], old: int) -> Iterator[_Piece]:
    """Yield the new edges in the place of an old one, as the run walks them: also over w = 0 of a closed run."""
    own = [x for x in border if x.old == old]
    first = next((k for k, x in enumerate(own) if x.is_first), 0)
    yield from (*own[first:], *own[:first])


def _change(
    run: Run, borders: Sequence[Sequence[_Piece]], places: tuple[int, ...], touched: tuple[int, ...], *, grows: bool
) -> Change:
    t = np.linspace(0, 1, _SAMPLES)

    def line(edges: Sequence[Any]) -> FloatArray:
        pieces = [points_of(x, range_of(x)[0] + t * (range_of(x)[1] - range_of(x)[0])) for x in edges]
        return evenly(np.concatenate(pieces))

    edge = evenly(np.concatenate([x.points(_SAMPLES) for x in run.edges]))
    a, b = (line([x.edge for x in border]) for border in borders)
    length = float(np.linalg.norm(np.diff(edge, axis=0), axis=1).sum())
    across = [float(np.linalg.norm(one - other, axis=1).mean()) for one, other in ((edge, a), (edge, b), (a, b))]
    return Change(
        old=(),
        new=places,
        touched=touched,
        volume=length * (across[0] + across[1]) * min(across[2], length),
        contacts=tuple(dict.fromkeys(n for x in run.edges for n in x.faces)),
        grows=grows,
        like=tuple(next(x.face for x in borders[0] if x.patch == m) for m in range(len(places))),
    )
