"""Errors: one base class, few narrow ones. A message names the value, what was found, what would be right."""

from __future__ import annotations


class SemisplineError(Exception):
    """Anything that this package refuses or fails to do."""


class InputError(SemisplineError, ValueError):
    """The input or the call is wrong; nothing was computed (exit status 2)."""


class KnotError(InputError):
    """A knot vector that is not a clamped, non-decreasing one of the right length and multiplicity."""


class ControlPointError(InputError):
    """Control points or weights of the wrong shape, or not finite."""


class EdgeError(InputError):
    """An edge or base that cannot be blended or measured as asked."""


class FileError(InputError):
    """A file that is missing, broken, or does not hold what was asked for."""


class OptionError(InputError):
    """An option outside the values that it may take."""


class ComputationError(SemisplineError):
    """The input was fine but the computation failed; the message says what to try (exit status 3)."""


class ContactError(ComputationError):
    """A finished blend whose measured contact misses its limits."""


class TrimError(ComputationError):
    """An edge outside of its trimmed face, or a face that is only approximated, where that was not allowed."""


class FoldError(ComputationError):
    """A finished blend that folds or is creased, where that was not allowed."""


class BandError(ComputationError):
    """A free curve of a face along which no band meets its limits."""


class SolidError(ComputationError):
    """A solid that was changed and is not sound; nothing is written of it."""
