"""Parameters of the kernel on the converted surface: the same point, and to the last bit at ends of spans."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.Geom import (
    Geom_Circle,
    Geom_ConicalSurface,
    Geom_CylindricalSurface,
    Geom_Ellipse,
    Geom_Hyperbola,
    Geom_Parabola,
    Geom_Plane,
    Geom_SphericalSurface,
    Geom_SurfaceOfLinearExtrusion,
    Geom_SurfaceOfRevolution,
    Geom_ToroidalSurface,
    Geom_TrimmedCurve,
)
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Dir, gp_Pnt

from helpers.sweeps import examples
from semispline.solver.io.occ_conversion import converted, snapped_ends
from semispline.solver.io.occ_parameters import converted_parameters, parameter_kinds
from semispline.solver.judge import surface_points

TURN = 2 * math.pi
PLACE = gp_Ax3(gp_Pnt(0.1, -0.2, 0.3), gp_Dir(0.36, 0.48, 0.8))
FLAT = gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
UPRIGHT = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
# Upright conics beside the axis.
BESIDE = gp_Ax2(gp_Pnt(3.0, 0.0, 0.0), gp_Dir(0.0, 1.0, 0.0))
SLANTED = gp_Dir(0.0, 0.6, 0.8)


def revolved(curve):
    return Geom_SurfaceOfRevolution(curve, UPRIGHT)


def extruded(curve):
    return Geom_SurfaceOfLinearExtrusion(curve, SLANTED)


ARC = Geom_TrimmedCurve(Geom_Circle(BESIDE, 1.0), 0.5, 2.5)
# Surface, kinds of u and v, ranges within which parts of u and v are drawn.
SURFACES = {
    "plane": (Geom_Plane(PLACE), ("same", "same"), (-2, 3), (-1, 1)),
    "cylinder": (Geom_CylindricalSurface(PLACE, 1.0), ("angle", "same"), (-1, 8), (-1, 3)),
    "cone": (Geom_ConicalSurface(PLACE, 0.3, 1.0), ("angle", "same"), (0, TURN), (-1, 3)),
    "sphere": (Geom_SphericalSurface(PLACE, 1.0), ("angle", "angle"), (0, TURN), (-TURN / 4, TURN / 4)),
    "torus": (Geom_ToroidalSurface(PLACE, 2.0, 0.5), ("angle", "angle"), (0, TURN), (-3, 9)),
    "revolved circle": (revolved(Geom_Circle(BESIDE, 1.0)), ("angle", "angle"), (0, TURN), (0, TURN)),
    "revolved arc": (revolved(ARC), ("angle", "angle"), (0, TURN), (0.5, 2.5)),
    "revolved hyperbola": (revolved(Geom_Hyperbola(BESIDE, 1.0, 0.5)), ("angle", "hyperbolic angle"), (0, 6), (-1, 2)),
    "revolved parabola": (revolved(Geom_Parabola(BESIDE, 0.7)), ("angle", "same"), (0, TURN), (-1, 2)),
    "extruded ellipse": (extruded(Geom_Ellipse(FLAT, 2.0, 0.7)), ("angle", "same"), (0, TURN), (0, 2)),
    "extruded arc": (extruded(ARC), ("angle", "same"), (0.5, 2.5), (0, 2)),
    "extruded hyperbola": (extruded(Geom_Hyperbola(FLAT, 1.0, 0.5)), ("hyperbolic angle", "same"), (-1, 2), (0, 2)),
}


def part(low, high, fractions):
    return low + (high - low) * fractions[0], low + (high - low) * fractions[1]


@pytest.mark.parametrize("name", SURFACES)
@examples(40)
@given(
    st.tuples(st.floats(0, 0.7), st.floats(0.75, 1)),
    st.tuples(st.floats(0, 0.7), st.floats(0.75, 1)),
    st.booleans(),
    st.floats(0, 1),
    st.floats(0, 1),
)
def test_the_same_point_at_the_converted_parameter(name, part_u, part_v, whole, s, t):
    """Referee: Open CASCADE at the kernel's parameters, de Boor at the converted ones."""
    geometry, kinds, range_u, range_v = SURFACES[name]
    assert parameter_kinds(geometry) == kinds
    ends = (*part(*range_u, part_u), *part(*range_v, part_v))
    if whole and geometry.IsUPeriodic():
        ends = (ends[0], ends[0] + TURN, *ends[2:])
    if ends[1] - ends[0] > TURN and geometry.IsUPeriodic():
        ends = (ends[0], ends[0] + TURN, *ends[2:])
    if ends[3] - ends[2] > TURN and geometry.IsVPeriodic():
        ends = (*ends[:2], ends[2], ends[2] + TURN)
    ends = snapped_ends(geometry, ends)
    surface = converted(geometry, ends).surface
    at = [low + (high - low) * x for low, high, x in zip(ends[::2], ends[1::2], (s, t), strict=True)]
    own = [
        converted_parameters(kind, breaks, np.array([x - low + breaks[0], *breaks]))
        for kind, breaks, x, low in zip(kinds, surface.breakpoints, at, ends[::2], strict=True)
    ]
    for found, breaks in zip(own, surface.breakpoints, strict=True):
        assert np.array_equal(found[1:], breaks)
    point = geometry.Value(float(at[0]), float(at[1]))
    u, v = (np.clip(x[:1], breaks[0], breaks[-1]) for x, breaks in zip(own, surface.breakpoints, strict=True))
    off = surface_points(surface, u, v)[0] - [point.X(), point.Y(), point.Z()]
    # Coordinates of size 10, made by some ten operations; ten times of air.
    assert np.abs(off).max() <= 1e-13


def test_a_turn_of_a_tube_begins_anywhere():
    """One in ten was refused: it had rounded up to more than a turn."""
    geometry = Geom_ToroidalSurface(PLACE, 2.0, 0.5)
    for low in (-3 + 12e-13, *np.random.default_rng(0).uniform(-3, 5, 40).tolist()):
        surface = converted(geometry, snapped_ends(geometry, (0.0, TURN, low, low + TURN))).surface
        start, end = surface.evaluate_grid([0.3], surface.domain[1])[0]
        assert np.abs(start - end).max() <= 1e-13


def test_equal_parameters_are_other_points():
    """What the conversion is for: without it a cylinder of radius 2 is off by 0.078."""
    geometry = Geom_CylindricalSurface(PLACE, 2.0)
    surface = converted(geometry, (0.0, TURN, 0.0, 1.0)).surface
    angle = np.linspace(0, TURN, 721)
    points = np.array([[p.X(), p.Y(), p.Z()] for p in (geometry.Value(float(x), 0.0) for x in angle)])
    away = np.linalg.norm(surface.evaluate(angle, np.zeros(721)) - points, axis=1)
    assert away.max() == pytest.approx(0.078, abs=1e-4)
    own = np.minimum(converted_parameters("angle", surface.breakpoints[0], angle), surface.domain[0][1])
    assert np.linalg.norm(surface.evaluate(own, np.zeros(721)) - points, axis=1).max() <= 4e-14
