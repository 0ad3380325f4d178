"""Pseudo-code as it is printed: read by rules, and run exactly by an interpreter of its own. Knows no claim."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
