"""Exporting a paper, and handing it to the process that rechecks."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from semispline.papers.ledger import MistakeError, Paper, paper_module, placed
from semispline.papers.recheck.coqc import require_coqc
from semispline.papers.recheck.draft import export_of
from semispline.papers.recheck.files import write_certificates
from semispline.papers.recheck.kernel import KernelCheck
from semispline.papers.recheck.statements import Export, Identity
from semispline.solver.errors import ComputationError, OptionError
from semispline.solver.workers import WorkerError, call

SYSTEMS = ("pari", "coq")
# Of processor time and memory; no paper that ships takes a tenth of the former, or a half of the latter.
_SECONDS, _MEGABYTES = 600, 4096


@dataclass(frozen=True)
class Recheck:
    """What was exported, and what a second system said of it.

    Attributes
    ----------
    export : Export
    refused : mapping or None
        Record -> statements with which it disagrees; None where it was not asked.
    verdicts : mapping
        Record -> the verdict that was made anew from its cases.
    kernel : KernelCheck or None
        What the kernel of Coq said; None where it was not asked.
    """

    export: Export
    refused: Mapping[str, tuple[str, ...]] | None = None
    verdicts: Mapping[str, str | None] | None = None
    kernel: KernelCheck | None = None

    @property
    def agrees(self) -> bool:
        """Whether nothing was refused, and every verdict is the recorded one."""
        return not self.refused and not self.changed and not (self.kernel and self.kernel.problems)

    @property
    def changed(self) -> tuple[str, ...]:
        """Records whose cases amount to another verdict than the recorded one, where all of them are there."""
        verdicts = self.verdicts or {}
        return tuple(
            c.id
            for c in self.export.certificates
            if c.id in verdicts and not c.left_out and verdicts[c.id] != c.verdict
        )

    @property
    def problems(self) -> tuple[str, ...]:
        """What the second system disagrees with, one a line."""
        refused = [f"recheck: found different: {name}" for found in (self.refused or {}).values() for name in found]
        verdicts = self.verdicts or {}
        recorded = {c.id: c.verdict for c in self.export.certificates}
        return (
            *refused,
            *(self.kernel.problems if self.kernel else ()),
            *(f"recheck: {i}: the cases amount to {verdicts[i]}, recorded {recorded[i]}" for i in self.changed),
        )

    def is_whole(self, identifier: str) -> bool:
        """Tell whether the whole verdict of a record was repeated."""
        if self.verdicts is None or self.refused is None:
            return False
        found = next((c for c in self.export.certificates if c.id == identifier), None)
        return (
            found is not None
            and not found.left_out
            and not self.refused.get(identifier)
            and self.verdicts.get(identifier) == found.verdict
        )

    def counts(self) -> dict[str, int]:
        """Return how many identities were exported, and agreed on; records rechecked as a whole, and not expressible.

        Identities that several records share are counted once, and only those whose sides differ as text.
        """
        refused = self.refused or {}
        exported, disputed, same = set(), set(), set()
        for certificate in self.export.certificates:
            for number, case in enumerate(certificate.statements, start=1):
                if not isinstance(case, Identity):
                    continue
                key = (case.left, case.right, case.where, case.equal)
                if case.left == case.right:
                    same.add(key)
                else:
                    exported.add(key)
                    mark = f"{certificate.id} #{number}:"
                    if any(text.startswith(mark) for text in refused.get(certificate.id, ())):
                        disputed.add(key)
        asked = self.refused is not None
        return {
            "identities_exported": len(exported),
            "identities_agreed": len(exported - disputed) if asked else 0,
            "identities_of_one_text": len(same),
            "statements_exported": sum(len(c.statements) for c in self.export.certificates),
            "rechecked": sum(self.is_whole(c.id) for c in self.export.certificates),
            "not_expressible": len(self.export.not_expressible)
            + sum(bool(c.left_out) for c in self.export.certificates),
            **(self.kernel.counts() if self.kernel else {}),
        }

    def reasons(self) -> dict[str, str]:
        """Return why records are not rechecked as a whole."""
        return dict(self.export.not_expressible) | {c.id: c.left_out for c in self.export.certificates if c.left_out}

    def record(self, identifier: str) -> dict[str, Any] | None:
        """Return what a ledger says of one record; None where it is not decided."""
        found = next((c for c in self.export.certificates if c.id == identifier), None)
        reason = self.reasons().get(identifier, "")
        if found is None and not reason:
            return None
        return {
            "statements": len(found.statements) if found else 0,
            "refused": list((self.refused or {}).get(identifier, ())),
            "whole": self.is_whole(identifier),
            "not_expressible": reason,
            "believed": list(found.believed) if found else [],
            **({"kernel": self.kernel.record(identifier)} if self.kernel else {}),
        }


def exported(paper: Paper) -> Export:
    """Return the export of a paper: what its checks export, and certificates of its own where it has any.

    These come from the function `export` of its module `certificates`, or `certificates.export`.

    Raises
    ------
    LedgerError
        They do not fit the records.
    """
    module = paper_module(paper.name, "certificates.export") or paper_module(paper.name, "certificates")
    if module is None:
        return export_of(paper, {}, {})
    with placed(paper.folder):
        found = module.export(paper)
    if not isinstance(found, Export):
        raise MistakeError(f"{module.__file__}: export returned a {type(found).__name__}, expected an Export")
    return found


def require_system(system: str) -> None:
    """Refuse a system that is not known or not installed.

    Raises
    ------
    OptionError
    """
    if system not in SYSTEMS:
        raise OptionError(f"--recheck: found {system!r}, expected one of {', '.join(SYSTEMS)}")
    if system == "coq":
        require_coqc()
        return
    if importlib.util.find_spec("cypari") is None:
        raise OptionError("--recheck pari: found no cypari, expected it installed: pip install 'semispline[recheck]'")


def rechecked(export: Export, folder: str | Path | None = None) -> Recheck:
    """Have an export decided in a process of its own, which never imports SymPy.

    Parameters
    ----------
    export : Export
    folder : str or Path, optional
        Where it has been written; else it is written to a folder that is removed again.

    Raises
    ------
    ComputationError
        The process ended without an answer, as where it was out of processor time, or it did import SymPy.
    """
    if not export.certificates:
        return Recheck(export, {}, {})
    with TemporaryDirectory() as scratch:
        place = Path(folder) if folder is not None else Path(scratch)
        if folder is None:
            write_certificates(place, export)
        try:
            result = call("semispline.papers.recheck.process", [str(place)], _SECONDS, _MEGABYTES)
        except WorkerError as error:
            raise ComputationError(f"recheck: {error}") from None
    if result["sympy"]:
        raise ComputationError("recheck: found SymPy in the process that rechecks, expected it not to be imported")
    refused = {name: tuple(found) for name, found in result["refused"].items()}
    return Recheck(export, refused, result["verdicts"])
