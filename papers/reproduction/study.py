"""What a paper's module `study` gives to `semispline reproduce`: examples, pictures, tables of its own, findings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from semispline.papers.baselines import BlendTask, Method
from semispline.papers.reproduction.comparison import Comparison

# Of each example, by its name: every method, in the order of tables.
Comparisons: TypeAlias = Mapping[str, Sequence[Comparison]]


@dataclass(frozen=True)
class Drawing:
    """A figure.

    Attributes
    ----------
    name, caption : str
        For the file, and for readers.
    draw : callable
        Draws into a PNG file; a function of a module, so that another process can run it.
    """

    name: str
    caption: str
    draw: Callable[[Path], None]


@dataclass(frozen=True, eq=False)
class Example:
    """A pair of bases on which all methods are run.

    Attributes
    ----------
    task : BlendTask
    notes : tuple of str
        What a reader has to know: where the bases come from, what could not be used as printed.
    pictures : tuple of str
        Names of the drawings that belong to it.
    """

    task: BlendTask
    notes: tuple[str, ...] = ()
    pictures: tuple[str, ...] = ()


@dataclass(frozen=True)
class Table:
    """A table as a reader sees it: every cell is text.

    Attributes
    ----------
    name, title, note : str
        For anchors; above the table; below it.
    head : tuple of str
    rows : tuple of tuples of str
    """

    name: str
    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


@dataclass(frozen=True)
class Finding:
    """A statement that the run has computed: one sentence in short, and the numbers behind it."""

    short: str
    detail: str


@dataclass(frozen=True, eq=False)
class Study:
    """A paper's examples and what is made of their results.

    Attributes
    ----------
    examples : tuple of Example
    drawings : tuple of Drawing
    tables : callable
        Comparisons -> tables that set the paper's own numbers beside ours.
    findings : callable
        Comparisons -> findings.
    methods : tuple of Method
        The paper's own, run beside all rivals.
    preface : str
        What a reader must know before any number.
    prior_art : tuple of str
        Works to cite beside the paper.
    """

    examples: tuple[Example, ...]
    drawings: tuple[Drawing, ...]
    tables: Callable[[Comparisons], tuple[Table, ...]]
    findings: Callable[[Comparisons], tuple[Finding, ...]]
    methods: tuple[Method, ...] = ()
    preface: str = ""
    prior_art: tuple[str, ...] = ()
