"""What is no code, and what goes wrong while it runs. Each names the printed line."""

from __future__ import annotations

from semispline.solver.errors import ComputationError, InputError


class UnreadableCodeError(InputError):
    """A line that no rule translates."""


class FaultError(ComputationError):
    """Printed code that does not run to its end: a name without a value, an index outside, a condition undecided."""

    def __init__(self, reason: str, line: int = 0) -> None:
        self.reason, self.line = reason, line
        super().__init__(f"line {line}: {reason}" if line else reason)


class LimitError(FaultError):
    """Code that took more steps, calls in each other, or digits than it may."""
