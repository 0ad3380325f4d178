"""What is no code, and what goes wrong while it runs. Each names the printed line."""

from __future__ import annotations

from semispline.solver.errors import ComputationError, InputError


class CodeError(InputError):
    """Code that cannot be read by the rules; the message names the printed line, what was found and expected."""


class CodeFaultError(ComputationError):
    """A program that did what it must not.

    Attributes
    ----------
    reason : str
        What was found, and expected.
    place : str
        The printed line, or the line of the call; empty until that is known.
    """

    def __init__(self, reason: str, place: str = "") -> None:
        self.reason, self.place = reason, place
        super().__init__(f"{place}: {reason}" if place else reason)


class CodeLimitError(CodeFaultError):
    """A program that was stopped at a limit of steps, depth or size: that it never ends is not known."""


class OpenConditionError(CodeFaultError):
    """A condition that letters leave open: the program runs with numbers only."""
