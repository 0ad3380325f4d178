"""The process that rechecks, with PARI and `fractions` but without SymPy: run it as a module, with a folder."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from semispline.papers.recheck.by_fractions import agrees
from semispline.papers.recheck.files import read_certificates
from semispline.papers.recheck.gp import CONTROLS, statement_id
from semispline.papers.recheck.statements import Statement
from semispline.papers.recheck.verdicts import verdict_of

_BYTES = 2**30


def recheck(folder: str | Path) -> dict[str, Any]:
    """Return what PARI and `fractions` say of the certificates in a folder.

    Returns
    -------
    dict
        "pari" (version), "refused" (record -> statements on which one of both disagrees), "verdicts" (record -> the
        verdict made anew from its cases), "sympy" (whether it was imported, which it must not be).
    """
    from cypari import pari

    certificates, controls = read_certificates(folder)
    pari.allocatemem(_BYTES, silent=True)
    pari(f'read("{Path(folder) / "gp" / "checker.gp"}")')
    refused = {c.id: _refused(pari, folder, c.id, c.statements) for c in certificates}
    refused[CONTROLS] = _refused(pari, folder, CONTROLS, controls)
    return {
        "pari": str(pari("version()")),
        "statements": sum(len(c.statements) for c in certificates) + len(controls),
        "refused": {name: found for name, found in refused.items() if found},
        "verdicts": {c.id: verdict_of(c) for c in certificates},
        "sympy": "sympy" in sys.modules,
    }


def _refused(pari: Any, folder: str | Path, name: str, statements: Sequence[Statement]) -> list[str]:
    """Return the statements of a record with which PARI or `fractions` disagree."""
    pari("asked = 0; agreed = 0; refused = List();")
    try:
        pari(f'read("{Path(folder) / "gp" / name}.gp")')
    except Exception as error:  # PARI could not read it: nothing of it is agreed
        return [f"{name}: {error}"]
    found = [str(pari(f"refused[{i}]")).strip('"') for i in range(1, int(pari("#refused")) + 1)]
    if int(pari("asked")) != len(statements):
        found.append(f"{name}: PARI was asked {pari('asked')} statements, expected {len(statements)}")
    for number, statement in enumerate(statements, start=1):
        if not agrees(statement):
            found.append(f"{statement_id(name, number, statement)} (fractions)")
    return found


def work(folder: str) -> dict[str, Any]:
    """Return `recheck` of a folder to the process that started this one, which sets its limits."""
    return recheck(folder)


def main(arguments: Sequence[str]) -> int:
    """Recheck a folder, and say what was found."""
    result = recheck(arguments[0])
    for found in result["refused"].values():
        for name in found:
            sys.stderr.write(f"{name}\n")
    count = result["statements"]
    agreed = count - sum(map(len, result["refused"].values()))
    sys.stdout.write(f"{agreed} of {count} statements agree (PARI {result['pari']})\n")
    return int(bool(result["refused"]))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
