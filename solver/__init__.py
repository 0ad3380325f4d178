"""What is computed: B-spline surfaces, semi-structured blends, and independent checks. Never imports SymPy.

Exports are lazy: `scipy.interpolate` and CasADi load when they are first needed.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from solver.bezier import BezierFunction, bezier_patch, divide_bezier, trim_bezier
    from solver.blending import BlendResult, blend
    from solver.continuity import Base, Contact, measure_contact
    from solver.errors import (
        ComputationError,
        ContactError,
        ControlPointError,
        EdgeError,
        FileError,
        InputError,
        KnotError,
        OptionError,
        SemisplineError,
    )
    from solver.gram import thin_plate_energy
    from solver.regularity import Regularity, measure_regularity
    from solver.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

_EXPORTS = {
    "BSplineCurve": "solver.surfaces",
    "BSplineSurface": "solver.surfaces",
    "Base": "solver.continuity",
    "BezierFunction": "solver.bezier",
    "BlendResult": "solver.blending",
    "ComputationError": "solver.errors",
    "Contact": "solver.continuity",
    "ContactError": "solver.errors",
    "ControlPointError": "solver.errors",
    "EdgeError": "solver.errors",
    "FileError": "solver.errors",
    "InputError": "solver.errors",
    "KnotError": "solver.errors",
    "OptionError": "solver.errors",
    "Regularity": "solver.regularity",
    "SemiStructuredSurface": "solver.surfaces",
    "SemisplineError": "solver.errors",
    "bezier_patch": "solver.bezier",
    "blend": "solver.blending",
    "divide_bezier": "solver.bezier",
    "measure_contact": "solver.continuity",
    "measure_regularity": "solver.regularity",
    "thin_plate_energy": "solver.gram",
    "trim_bezier": "solver.bezier",
}

__all__ = [
    "BSplineCurve",
    "BSplineSurface",
    "Base",
    "BezierFunction",
    "BlendResult",
    "ComputationError",
    "Contact",
    "ContactError",
    "ControlPointError",
    "EdgeError",
    "FileError",
    "InputError",
    "KnotError",
    "OptionError",
    "Regularity",
    "SemiStructuredSurface",
    "SemisplineError",
    "bezier_patch",
    "blend",
    "divide_bezier",
    "measure_contact",
    "measure_regularity",
    "thin_plate_energy",
    "trim_bezier",
]


def __getattr__(name: str) -> Any:
    if name in _EXPORTS:
        return getattr(import_module(_EXPORTS[name]), name)
    raise AttributeError(f"module 'solver' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
