"""Everything that a run of a study has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from semispline.papers.ledger import Ledger
from semispline.papers.reproduction import Comparisons, Study, Table


@dataclass(frozen=True, eq=False)
class Results:
    """Everything that a run has found.

    Attributes
    ----------
    ledger : Ledger
    study : Study
    comparisons : mapping
        Every method on every example.
    blends : Table
        Blends of the pairs by our own solver, edge by edge.
    pictures : mapping
        Name of a drawing -> its PNG file.
    environment : mapping
        Versions and machine.
    command : str
        How to repeat it.
    """

    ledger: Ledger
    study: Study
    comparisons: Comparisons
    blends: Table
    pictures: Mapping[str, Path]
    environment: Mapping[str, str]
    command: str
