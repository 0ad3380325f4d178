"""What is computed: B-spline surfaces, semi-structured blends, and independent checks. Never imports SymPy.

Exports are lazy: `scipy.interpolate` and CasADi load when they are first needed.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from solver.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

_EXPORTS = {
    "BSplineCurve": "solver.surfaces",
    "BSplineSurface": "solver.surfaces",
    "SemiStructuredSurface": "solver.surfaces",
}

__all__ = ["BSplineCurve", "BSplineSurface", "SemiStructuredSurface"]


def __getattr__(name: str) -> Any:
    if name in _EXPORTS:
        return getattr(import_module(_EXPORTS[name]), name)
    raise AttributeError(f"module 'solver' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
