"""What is computed: B-spline surfaces, semi-structured blends, and independent checks. Never imports SymPy.

Exports are lazy: `scipy.interpolate` and CasADi load when they are first needed.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from solver.base import Base
    from solver.bezier import BezierFunction, bezier_patch, divide_bezier, trim_bezier
    from solver.blend_result import BlendResult
    from solver.blending import blend
    from solver.compatible import Conversion, convert_to_bspline
    from solver.construction import (
        Approximation,
        extrude,
        interpolate_curve,
        interpolate_grid,
        plane,
        revolve,
        revolve_polynomial,
        ruled,
        skin,
    )
    from solver.continuity import Contact, measure_contact
    from solver.curvature import (
        LocalGeometry,
        gaussian_curvature,
        isophote_angle,
        local_geometry,
        local_geometry_grid,
        mean_curvature,
        normal_curvature,
        normals,
        principal_curvatures,
        zebra,
    )
    from solver.curves import elevate_curve, insert_curve_knots, reverse_curve, set_curve_continuity, split_curve
    from solver.derivatives import derivative_curve
    from solver.errors import (
        ComputationError,
        ContactError,
        ControlPointError,
        EdgeError,
        FileError,
        FoldError,
        InputError,
        KnotError,
        OptionError,
        SemisplineError,
    )
    from solver.gram import thin_plate_energy
    from solver.io.surface_files import list_surfaces, read_surface, write_surface
    from solver.operations import (
        bounding_box,
        clamped_surface,
        elevate_degree,
        insert_knots,
        map_domain,
        reverse_u,
        reverse_v,
        split_u,
        split_v,
        swap_directions,
        transform,
    )
    from solver.refinement import clamp_knots
    from solver.regularity import Regularity, measure_regularity
    from solver.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

_EXPORTS = {
    "Approximation": "solver.construction",
    "BSplineCurve": "solver.surfaces",
    "BSplineSurface": "solver.surfaces",
    "Base": "solver.base",
    "BezierFunction": "solver.bezier",
    "BlendResult": "solver.blend_result",
    "ComputationError": "solver.errors",
    "Contact": "solver.continuity",
    "ContactError": "solver.errors",
    "ControlPointError": "solver.errors",
    "Conversion": "solver.compatible",
    "EdgeError": "solver.errors",
    "FileError": "solver.errors",
    "FoldError": "solver.errors",
    "InputError": "solver.errors",
    "KnotError": "solver.errors",
    "LocalGeometry": "solver.curvature",
    "OptionError": "solver.errors",
    "Regularity": "solver.regularity",
    "SemiStructuredSurface": "solver.surfaces",
    "SemisplineError": "solver.errors",
    "bezier_patch": "solver.bezier",
    "blend": "solver.blending",
    "bounding_box": "solver.operations",
    "clamp_knots": "solver.refinement",
    "clamped_surface": "solver.operations",
    "convert_to_bspline": "solver.compatible",
    "derivative_curve": "solver.derivatives",
    "divide_bezier": "solver.bezier",
    "elevate_curve": "solver.curves",
    "elevate_degree": "solver.operations",
    "extrude": "solver.construction",
    "gaussian_curvature": "solver.curvature",
    "insert_curve_knots": "solver.curves",
    "insert_knots": "solver.operations",
    "interpolate_curve": "solver.construction",
    "interpolate_grid": "solver.construction",
    "isophote_angle": "solver.curvature",
    "list_surfaces": "solver.io.surface_files",
    "local_geometry": "solver.curvature",
    "local_geometry_grid": "solver.curvature",
    "map_domain": "solver.operations",
    "mean_curvature": "solver.curvature",
    "measure_contact": "solver.continuity",
    "measure_regularity": "solver.regularity",
    "normal_curvature": "solver.curvature",
    "normals": "solver.curvature",
    "plane": "solver.construction",
    "principal_curvatures": "solver.curvature",
    "read_surface": "solver.io.surface_files",
    "reverse_curve": "solver.curves",
    "reverse_u": "solver.operations",
    "reverse_v": "solver.operations",
    "revolve": "solver.construction",
    "revolve_polynomial": "solver.construction",
    "ruled": "solver.construction",
    "set_curve_continuity": "solver.curves",
    "skin": "solver.construction",
    "split_curve": "solver.curves",
    "split_u": "solver.operations",
    "split_v": "solver.operations",
    "swap_directions": "solver.operations",
    "thin_plate_energy": "solver.gram",
    "transform": "solver.operations",
    "trim_bezier": "solver.bezier",
    "write_surface": "solver.io.surface_files",
    "zebra": "solver.curvature",
}

__all__ = [
    "Approximation",
    "BSplineCurve",
    "BSplineSurface",
    "Base",
    "BezierFunction",
    "BlendResult",
    "ComputationError",
    "Contact",
    "ContactError",
    "ControlPointError",
    "Conversion",
    "EdgeError",
    "FileError",
    "FoldError",
    "InputError",
    "KnotError",
    "LocalGeometry",
    "OptionError",
    "Regularity",
    "SemiStructuredSurface",
    "SemisplineError",
    "bezier_patch",
    "blend",
    "bounding_box",
    "clamp_knots",
    "clamped_surface",
    "convert_to_bspline",
    "derivative_curve",
    "divide_bezier",
    "elevate_curve",
    "elevate_degree",
    "extrude",
    "gaussian_curvature",
    "insert_curve_knots",
    "insert_knots",
    "interpolate_curve",
    "interpolate_grid",
    "isophote_angle",
    "list_surfaces",
    "local_geometry",
    "local_geometry_grid",
    "map_domain",
    "mean_curvature",
    "measure_contact",
    "measure_regularity",
    "normal_curvature",
    "normals",
    "plane",
    "principal_curvatures",
    "read_surface",
    "reverse_curve",
    "reverse_u",
    "reverse_v",
    "revolve",
    "revolve_polynomial",
    "ruled",
    "set_curve_continuity",
    "skin",
    "split_curve",
    "split_u",
    "split_v",
    "swap_directions",
    "thin_plate_energy",
    "transform",
    "trim_bezier",
    "write_surface",
    "zebra",
]


def __getattr__(name: str) -> Any:
    if name in _EXPORTS:
        return getattr(import_module(_EXPORTS[name]), name)
    raise AttributeError(f"module 'solver' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
