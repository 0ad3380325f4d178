"""Edges of trimmed faces and who is whose neighbour; places to blend; `places` shows the whole way to them."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
