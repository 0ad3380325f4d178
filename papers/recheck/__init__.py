"""Verdicts repeated by a second system, PARI, and by `fractions`: statements as text, files, and the process."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
