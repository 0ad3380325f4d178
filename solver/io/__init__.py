"""Files: JSON, STEP, IGES, BREP, 3dm, meshes; foreign readers in a process of their own."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
