"""A box whose fillet was replaced by a right blend, for tests of the gate that make one thing of it wrong."""

from functools import cache

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid

from helpers.parts import compound, graph_of
from semispline import Base, blend, plane
from semispline.solver.topology.occ_replacing import change_of, opening, put_in
from semispline.solver.topology.occ_rounding import rounded
from semispline.solver.topology.occ_shapes import copy_of, ends, parts
from semispline.solver.topology.solid_orders import NewFace, Rounding


@cache
def corner_blend(radius=5.0, height=40.0):
    """G2 from the plane y = 0 to the plane x = 0 along an upright edge."""
    a = Base(plane([radius, 0, 0], [0, 0, height], [20, 0, 0]), "v0")
    b = Base(plane([0, radius, 0], [0, 0, height], [0, 20, 0]), "v0")
    return blend(a, b, middle_curves=0).surface.to_bspline()


def the_fillet(shape):
    """The number of the round along the z-axis, and its upright edges."""
    graph = graph_of(shape)
    uses = graph.uses
    for number, kind in enumerate(graph.faces.kind):
        rows = uses.of_face(number)
        if kind == "cylinder" and np.abs(uses.points[rows].mean(axis=(0, 1))[:2] - 1.5).max() < 2.0:
            upright = [k for k in range(rows.stop - rows.start) if np.ptp(uses.points[rows][k, :, 2]) > 1.0]
            if len(upright) == 2 and rows.stop - rows.start == 4:
                return number, tuple((k,) for k in upright)
    raise AssertionError


def put(shape, surface, number, contacts):
    copy, _ = copy_of(shape)
    place = opening(copy, number, contacts)
    # u runs from the first contact: from the plane y = 0.
    after, _ = put_in(copy, [place], [NewFace(number, contacts, surface)])
    return after, change_of([place])


def placed(shape, surface):
    """The shape with a surface in the place of its fillet, and what is meant to have happened."""
    number, (one, two) = the_fillet(shape)
    graph = graph_of(shape)
    row = graph.uses.of_face(number).start + one[0]
    contacts = (one, two) if abs(graph.uses.points[row, 0, 1]) < 1e-6 else (two, one)
    return put(shape, surface, number, contacts)


def solid_of(faces, *voids):
    """A solid in a compound, of one shell and those of holes in it, put together from faces."""
    builder, solid = BRep_Builder(), TopoDS_Solid()
    builder.MakeSolid(solid)
    for own in (faces, *voids):
        shell = TopoDS_Shell()
        builder.MakeShell(shell)
        for face in own:
            builder.Add(shell, face)
        shell.Closed(True)
        builder.Add(solid, shell)
    return compound([solid])


def edge_rounded(shape, face, k, surface, *, grows):
    """The shape with one edge rounded, and what is meant to have happened."""
    vertices = ends(parts(parts(shape, "FACE")[face], "EDGE")[k])
    order = Rounding(face, ((face, k),), surface, (), vertices[0].IsSame(vertices[1]), grows)
    after, _, change = rounded(copy_of(shape)[0], order.edges, order)
    return after, change
