"""Every method on every example: results, measures, or the reason why there are none."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from semispline.papers.baselines import BlendTask, Method, NotApplicableError, Outcome, methods
from semispline.papers.reproduction.measures import Measures, measure


@dataclass(frozen=True, eq=False)
class Comparison:
    """One method on one example.

    Attributes
    ----------
    task : BlendTask
    method : Method
    outcome : Outcome or None
    measures : Measures or None
    reason : str
        Why there is no result; empty where there is one.
    """

    task: BlendTask
    method: Method
    outcome: Outcome | None
    measures: Measures | None
    reason: str

    def record(self) -> dict[str, Any]:
        """Return what a table or a JSON file holds of it: plain numbers and strings."""
        head = {"example": self.task.name, "method": self.method.name, "title": self.method.title}
        if self.outcome is None or self.measures is None:
            return head | {"reason": self.reason}
        m = self.measures
        worst = {
            "gap": m.gap,
            "angle_degrees": m.angle_degrees,
            "curvature_jump_relative": m.curvature_jump_relative,
            "folds": m.folds,
        }
        shape = {"alpha2": self.outcome.alpha2, "beta2": self.outcome.beta2, "note": self.outcome.note}
        return head | worst | asdict(m) | shape


def compare(task: BlendTask, chosen: Iterable[Method] | None = None) -> list[Comparison]:
    """Run methods on one example and measure what they make; all methods unless some are chosen.

    Each runs twice, and the second one counts: the first loads libraries.
    """
    return [run(task, method, warm_up=True) for method in (methods() if chosen is None else chosen)]


def run(task: BlendTask, method: Method, *, warm_up: bool = False) -> Comparison:
    """Run one method on one example and measure what it makes."""
    try:
        if warm_up:
            method.run(task)
        outcome = method.run(task)
    except NotApplicableError as error:
        return Comparison(task, method, None, None, str(error))
    return Comparison(task, method, outcome, measure(task, outcome), "")
