"""What a reader of a paper wants to know in ten minutes: a text of the paper's own, made from its decided ledger."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from semispline import __version__
from semispline.papers.ledger import Ledger, LedgerError, MistakeError, paper_module, placed
from semispline.solver.io import write_text


@dataclass(frozen=True)
class Erratum:
    """A document in Markdown, and the pictures that it shows.

    Attributes
    ----------
    text : str
    pictures : mapping
        Name of an SVG file beside it -> its text.
    """

    text: str
    pictures: Mapping[str, str] = field(default_factory=dict)


def has_erratum(paper: str) -> bool:
    """Tell whether a paper has such a document: a module `erratum` with a function of that name."""
    return paper_module(paper, "erratum") is not None


def require_erratum(paper: str) -> None:
    """Refuse a paper that has no such document.

    Raises
    ------
    LedgerError
    """
    if not has_erratum(paper):
        raise LedgerError(f"--erratum: found no module erratum in {paper!r}, expected one with a function of that name")


def erratum_of(ledger: Ledger) -> Erratum:
    """Return the document of a decided paper that has one."""
    require_erratum(ledger.paper.name)
    module = paper_module(ledger.paper.name, "erratum")
    assert module is not None
    with placed(ledger.paper.folder):
        found = module.erratum(ledger, __version__)
    if not isinstance(found, Erratum):
        raise MistakeError(f"{module.__file__}: erratum returned a {type(found).__name__}, expected an Erratum")
    return found


def write_erratum(ledger: Ledger, path: str | Path) -> None:
    """Write the document of a decided paper, and its pictures into the same folder."""
    found = erratum_of(ledger)
    for name, picture in found.pictures.items():
        write_text(Path(path).parent / name, picture)
    write_text(path, found.text)
