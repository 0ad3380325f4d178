"""Blend B-spline surfaces without touching them, and check every formula that claims to do so.

Exports are lazy, and listed in `__init__.pyi` alone: `scipy.interpolate` and CasADi load when they are first needed.
"""

import lazy_loader as _lazy

__version__ = "0.1.0"
__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
