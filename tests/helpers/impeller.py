"""The real pair of the first issue: two faces of the impeller that pyiges ships."""

from functools import cache
from pathlib import Path

import pyiges

from semispline import Base, read_surface

PATH = Path(pyiges.__file__).parent / "examples" / "impeller.igs"


@cache
def impeller_pair():
    """The edges u0 of the faces 102 and 131, read once for all tests: the file has hundreds of faces."""
    return Base(read_surface(f"{PATH}#102"), "u0"), Base(read_surface(f"{PATH}#131"), "u0")
