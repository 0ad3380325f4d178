"""What decides claims of most papers, and what is true of Bezier curves and B-splines. Knows no paper."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
