"""LaTeX in: printed formulas, read against a paper's own table of names and kinds. Knows no paper."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
