"""Random solids with fillets or chamfers, made by Open CASCADE, which names the faces that it made: the truth."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepFilletAPI import BRepFilletAPI_MakeChamfer, BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone, BRepPrimAPI_MakeCylinder
from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TopExp import TopExp

from helpers.parts import edges_of_shape
from semispline.solver.io.occ import _faces


@dataclass(frozen=True)
class KnownPart:
    """A solid and the numbers of the faces that its rounding or chamfering made."""

    shape: Any
    made: frozenset[int]


def random_solid(rng):
    """A box of about 40 x 30 x 20 with a boss, a hole, a pocket or a cone, well apart."""
    a, b, c = rng.uniform(36, 44), rng.uniform(26, 34), rng.uniform(16, 24)
    shape = BRepPrimAPI_MakeBox(a, b, c).Shape()
    places = rng.permutation([0.25, 0.75])
    for x, kind in zip(places, rng.choice(["boss", "hole", "pocket", "cone"], 2, replace=False), strict=True):
        at = gp_Ax2(gp_Pnt(a * float(x), b * rng.uniform(0.45, 0.55), c), gp_Dir(0, 0, 1))
        r = rng.uniform(4, 6)
        if kind == "boss":
            shape = BRepAlgoAPI_Fuse(shape, BRepPrimAPI_MakeCylinder(at, r, rng.uniform(8, 12)).Shape()).Shape()
        elif kind == "cone":
            cone = BRepPrimAPI_MakeCone(at, r, 0.6 * r, rng.uniform(8, 12)).Shape()
            shape = BRepAlgoAPI_Fuse(shape, cone).Shape()
        elif kind == "hole":
            down = gp_Ax2(at.Location(), gp_Dir(0, 0, -1))
            shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(down, r, 0.6 * c).Shape()).Shape()
        else:
            corner = gp_Pnt(a * float(x) - r, b / 2 - 1.4 * r, 0.5 * c)
            shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeBox(corner, 2 * r, 2.8 * r, c).Shape()).Shape()
    unify = ShapeUpgrade_UnifySameDomain(shape)
    unify.Build()
    return unify.Shape()


def known_part(seed, chamfer=False):
    """Round or chamfer a few edges that do not touch; None where the kernel cannot."""
    rng = np.random.default_rng(seed)
    shape = random_solid(rng)
    edges = edges_of_shape(shape)
    lengths = [GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge)) for edge in edges]
    maker = (BRepFilletAPI_MakeChamfer if chamfer else BRepFilletAPI_MakeFillet)(shape)
    taken, ends = [], set()
    for i in rng.permutation(len(edges)).tolist():
        corners = {corner_of(vertex) for vertex in (TopExp.FirstVertex_s(edges[i]), TopExp.LastVertex_s(edges[i]))}
        if lengths[i] < 5 or corners & ends or is_seam(shape, edges[i]):
            continue
        maker.Add(float(rng.uniform(0.8, 2.2)), edges[i])
        taken.append(edges[i])
        ends |= corners
        if len(taken) == 4:
            break
    try:
        maker.Build()
    except Exception:
        return None
    if not maker.IsDone():
        return None
    made = IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher()
    for edge in taken:
        for face in maker.Generated(edge):
            made.Add(face)
    faces = list(_faces(maker.Shape()))
    return KnownPart(maker.Shape(), frozenset(n for n, face in enumerate(faces) if made.FindIndex(face)))


def corner_of(vertex):
    point = BRep_Tool.Pnt_s(vertex)
    return tuple(round(x, 6) for x in (point.X(), point.Y(), point.Z()))


def is_seam(shape, edge):
    return any(BRep_Tool.IsClosed_s(edge, face) for face in _faces(shape))
