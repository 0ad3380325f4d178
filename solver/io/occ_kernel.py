"""What reading and writing through Open CASCADE share: its presence, its unit of length, its silence."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from semispline.solver.errors import FileError
from semispline.solver.io.silence import silenced

__all__ = ["UNIT_NAMES", "first_line", "require_kernel", "silenced", "system_unit"]

UNIT_NAMES = {
    "in": "INCH",
    "mm": "MM",
    "ft": "FT",
    "mi": "MI",
    "m": "M",
    "km": "KM",
    "mil": "MIL",
    "um": "UM",
    "cm": "CM",
    "uin": "UIN",
}


def require_kernel(what: str | Path) -> None:
    """Refuse `what` if Open CASCADE is not installed.

    Raises
    ------
    FileError
        With the command that installs it.
    """
    if find_spec("OCP") is None:
        raise FileError(f"{what}: STEP, IGES and BREP need Open CASCADE; run: pip install 'semispline[cad]'")


@contextmanager
def system_unit(unit: str) -> Iterator[None]:
    """Make `unit` the kernel's unit of length in STEP, so that nothing is scaled, and put the old one back."""
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_Controller

    STEPControl_Controller.Init_s()
    keys = ("xstep.cascade.unit", "write.step.unit")
    before = {key: Interface_Static.CVal_s(key) for key in keys}
    try:
        for key in keys:
            Interface_Static.SetCVal_s(key, UNIT_NAMES[unit])
        yield
    finally:
        for key in keys:
            Interface_Static.SetCVal_s(key, before[key])


def first_line(error: Exception) -> str:
    """Return the first line of the kernel's message, or the name of its class."""
    lines = str(error).splitlines()
    return lines[0] if lines else type(error).__name__
