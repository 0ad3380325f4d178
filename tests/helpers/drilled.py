"""Parts with slanted round holes: closed free edges on every kind of elementary face; and tubes to blend them to."""

import numpy as np
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

from semispline import BSplineCurve, list_edges, list_surfaces, plane, revolve_polynomial, write_surface

TILT = (0.3, 0.2, 1.0)


def drilled(shape, radius=1.0, at=(0.0, 0.0), tilt=TILT):
    """A shape with a slanted round hole; its axis goes through (at, -50)."""
    axis = gp_Ax2(gp_Pnt(*at, -50), gp_Dir(*tilt))
    return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(axis, radius, 100).Shape()).Shape()


def lying():
    """A cylinder about the x-axis."""
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-20, 0, 0), gp_Dir(1, 0, 0)), 5.0, 40.0).Shape()


# By the kind of the face that is drilled: the whole part, and where the hole begins.
WHOLE = {
    "cylinder": (lying, (-15.0, -10.0)),
    "sphere": (lambda: BRepPrimAPI_MakeSphere(8.0).Shape(), (-13.0, -9.0)),
    "torus": (lambda: BRepPrimAPI_MakeTorus(10.0, 3.0).Shape(), (-22.0, -17.0)),
    "cone": (lambda: BRepPrimAPI_MakeCone(8.0, 3.0, 10.0).Shape(), (-11.5, -11.0)),
    "plane": (lambda: BRepPrimAPI_MakeBox(gp_Pnt(-4, -4, -4), gp_Pnt(4, 4, 4)).Shape(), (-15.0, -10.0)),
}


def drilled_part(kind):
    make, at = WHOLE[kind]
    return drilled(make(), at=at)


def hole(path, kind):
    """Face and entry of the longest free edge of a hole in a face of that kind, at the side where the tool comes out."""
    found = []
    for face in range(len(list_surfaces(path))):
        edges = list_edges(path, face)
        if edges.kind == kind:
            found += [(face, e) for e in edges.edges if e.kind == "free"]
    return max(found, key=lambda pair: (pair[1].middle[2] > 0, pair[1].length))


def beyond(path, entry, kind):
    """A file with what a hole is blended to, its edge v0 nearest: a tube about the axis, or a sheet for an open edge."""
    way = np.array(TILT) / np.linalg.norm(TILT)
    base = np.array([*WHOLE[kind][1], -50.0])
    start, end = np.array(entry.start), np.array(entry.end)
    if np.linalg.norm(end - start) > 1e-6:
        write_surface(path, plane(start + 3.0 * way, end - start, 2.0 * way))
        return path
    centre = base + ((np.array(entry.middle) - base) @ way) * way
    across = np.cross(way, [1.0, 0, 0])
    across /= np.linalg.norm(across)
    line = BSplineCurve(1, [0, 0, 1, 1], [centre + 0.8 * across + h * way for h in (3.0, 5.0)])
    write_surface(path, revolve_polynomial(line, centre, way).surface)
    return path
