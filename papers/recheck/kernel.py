"""What the kernel of Coq accepted of a paper: its statements, and which records are checked as a whole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from semispline.papers.recheck.coq_folder import coq_folder
from semispline.papers.recheck.coqc import Kernel, kernel_of
from semispline.papers.recheck.gp import statement_id
from semispline.papers.recheck.statements import Certificate, Export, Identity
from semispline.papers.recheck.verdicts import verdict_of


@dataclass(frozen=True)
class KernelCheck:
    """What the kernel said of an export.

    Attributes
    ----------
    export : Export
    kernel : Kernel
    without : mapping
        Record -> why a statement of it has no lemma.
    """

    export: Export
    kernel: Kernel
    without: Mapping[str, str]

    @property
    def version(self) -> str:
        """Of Coq."""
        return self.kernel.version

    @property
    def problems(self) -> tuple[str, ...]:
        """What the kernel disagrees with, one a line."""
        refused = (f"recheck: refused by the kernel: {name}" for name in self.kernel.refused)
        return (*refused, *(f"recheck: {text}" for text in self.kernel.problems))

    def reasons(self) -> dict[str, str]:
        """Return why decided records are not checked as a whole, what the kernel refused apart."""
        found = dict(self.export.not_expressible)
        for certificate in self.export.certificates:
            reason = self._reason(certificate)
            if reason:
                found[certificate.id] = reason
        return found

    def _reason(self, certificate: Certificate) -> str:
        believed = (f"believed: {text}" for text in certificate.believed if text not in self.export.theorems)
        return certificate.left_out or self.without.get(certificate.id, "") or next(believed, "")

    def is_whole(self, identifier: str) -> bool:
        """Tell whether all that a verdict rests on was accepted: its statements, and what is believed as theorems."""
        found = next((c for c in self.export.certificates if c.id == identifier), None)
        refused = set(self.kernel.refused)
        return (
            found is not None
            and not self._reason(found)
            and verdict_of(found) == found.verdict
            and not any(statement_id(found.id, n, case) in refused for n, case in enumerate(found.statements, start=1))
        )

    def counts(self) -> dict[str, int]:
        """Return how many identities and statements the kernel accepted, and records as a whole."""
        refused, accepted, identities = set(self.kernel.refused), 0, set()
        for certificate in self.export.certificates:
            for number, case in enumerate(certificate.statements, start=1):
                if certificate.id in self.without or statement_id(certificate.id, number, case) in refused:
                    continue
                accepted += 1
                if isinstance(case, Identity) and case.left != case.right:
                    identities.add((case.left, case.right, case.where, case.equal))
        return {
            "kernel_identities": len(identities),
            "kernel_statements": accepted,
            "kernel_checked": sum(self.is_whole(c.id) for c in self.export.certificates),
            "kernel_inexpressible": len(self.reasons()),
        }

    def record(self, identifier: str) -> dict[str, Any]:
        """Return what a ledger says of one record."""
        found = next((c for c in self.export.certificates if c.id == identifier), None)
        believed = found.believed if found else ()
        theorems = dict.fromkeys(t for key in (identifier, *believed) for t in self.export.theorems.get(key, ()))
        return {
            "whole": self.is_whole(identifier),
            "inexpressible": self.reasons().get(identifier, ""),
            "theorems": list(theorems),
        }


def kernel_checked(export: Export, folder: str | Path | None = None) -> KernelCheck:
    """Have the kernel of Coq decide an export.

    Parameters
    ----------
    export : Export
    folder : str or Path, optional
        Where its certificates are written; its files for Coq are compiled there, else in a folder that is removed.

    Raises
    ------
    OptionError
        Coq is not installed.
    ComputationError
        It gave no answer.
    """
    files = coq_folder(export)
    with TemporaryDirectory() as scratch:
        kernel = kernel_of(files, Path(folder or scratch) / "coq")
    return KernelCheck(export, kernel, files.without)
