"""Certificates as a folder: statements as JSON, the same for PARI, one file that runs all, and a page that says how."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from semispline.papers.recheck.coq_folder import coq_folder, write_coq
from semispline.papers.recheck.gp import CHECKER, CONTROLS, check_lines
from semispline.papers.recheck.statements import (
    Certificate,
    Export,
    Statement,
    as_record,
    certificate_from,
    certificate_record,
    from_record,
)
from semispline.solver.errors import InputError


def require_folder(folder: str | Path) -> None:
    """Refuse a file where a folder is asked for.

    Raises
    ------
    InputError
    """
    if Path(folder).is_file():
        raise InputError(f"certificates: found the file {folder}, expected a folder, new or old")


def write_certificates(folder: str | Path, export: Export) -> list[Path]:
    """Write an export, and return what was written.

    Raises
    ------
    InputError
        The folder is a file, or cannot be made.
    """
    folder = Path(folder)
    try:
        for part in ("statements", "gp"):
            (folder / part).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"certificates: {folder} is no folder ({error.strerror}), expected one") from None
    files = {"README.md": _page(export), "check.gp": _check(export), "gp/checker.gp": CHECKER}
    for certificate in export.certificates:
        files[f"statements/{certificate.id}.json"] = _json(certificate_record(certificate))
        files[f"gp/{certificate.id}.gp"] = _lines(certificate.id, certificate.statements)
    controls = {"format": "semispline/1", "kind": "controls", "cases": [as_record(case) for case in export.controls]}
    files[f"statements/{CONTROLS}.json"] = _json(controls)
    files[f"gp/{CONTROLS}.gp"] = _lines(CONTROLS, export.controls)
    written = []
    for name, content in files.items():
        written.append(folder / name)
        written[-1].write_text(content, encoding="utf-8")
    return [*written, *write_coq(coq_folder(export), folder / "coq")]


def read_certificates(folder: str | Path) -> tuple[list[Certificate], list[Statement]]:
    """Return certificates and controls from a folder.

    Raises
    ------
    InputError
        There are none.
    """
    certificates: list[Certificate] = []
    controls: list[Statement] = []
    for path in sorted((Path(folder) / "statements").glob("*.json")):
        record = json.loads(path.read_text(encoding="utf-8"))
        if path.stem == CONTROLS:
            controls = list(map(from_record, record["cases"]))
        else:
            certificates.append(certificate_from(record))
    if not certificates:
        raise InputError(f"certificates: found none in {folder}, expected statements/*.json")
    return certificates, controls


def _json(record: dict[str, Any]) -> str:
    return json.dumps(record, indent=1) + "\n"


def _lines(identifier: str, statements: Iterable[Statement]) -> str:
    return "\n".join(check_lines(identifier, list(statements))) + "\n"


def _check(export: Export) -> str:
    names = [*(certificate.id for certificate in export.certificates), CONTROLS]
    expected = sum(len(certificate.statements) for certificate in export.certificates) + len(export.controls)
    files = ", ".join(f'"{name}"' for name in names)
    return (
        "\\\\ gp -q check.gp, in this folder: the last line counts, the status is 0 where PARI agrees on all.\n"
        "default(parisizemax, 2^30);\n"
        'read("gp/checker.gp");\n'
        f"files = [{files}];\n"
        f"expected = {expected};\n"
        'for(i = 1, #files, iferr(read(Str("gp/", files[i], ".gp")), e, print("FAILED ", files[i], ": ", e)));\n'
        'print(agreed, " of ", expected, " statements agree, in ", #files, " files");\n'
        "quit(if(asked == expected && agreed == expected, 0, 1));\n"
    )


_HEAD = """# {paper}: what the verdicts rest on, for a second system

Each file in `statements` holds what one verdict rests on, as plain text: both sides of every identity as they stand
before any simplification, what letters stand for (`where`), the factors of all denominators (`nonzero`), whether the
sides are equal, and rational numbers (`at`) at which they differ, or are the same. `gp` holds the same in the language
of PARI/GP.

To check all of it with PARI alone (Debian: `apt-get install pari-gp`), in this folder:

    gp -q check.gp

The last line counts, and the status is 0 if PARI agrees on everything. What PARI is asked stands in `gp/checker.gp`.
To check it with the kernel of Coq alone (Debian: `apt-get install coq`), in the folder `coq`:

    sh check.sh

It compiles the hand-written sources, then a lemma for each statement, named by the first record that has it. Each file
ends by printing the axioms that its lemmas rest on: those of `Statements_*.v` none ("Closed under the global context"),
theorems on B-splines those of Coq's own real numbers. `docs/what-has-to-be-believed.md` says what is then left.

With Python, `cypari` and this package, but without SymPy: `python -m semispline.papers.recheck.process .`. It decides
every instance with `fractions` too, and makes each verdict anew from its cases.

What remains to be believed: that the statements say what the paper says, the sentences under `believed`, and the
system. A case that is not `own` lies outside of the paper's own setting; one that does not meet (`meets`) the condition
of its reading must be false. `controls` are formulas with one change each, which must be refused.

| record | verdict | statements | left out |
|---|---|---|---|
"""


def _page(export: Export) -> str:
    rows = [f"| {c.id} | {c.verdict} | {len(c.statements)} | {c.left_out} |" for c in export.certificates]
    missing = [f"- {identifier}: {reason}" for identifier, reason in export.not_expressible.items()]
    tail = "\n\nDecided records of which nothing is here:\n\n" + "\n".join(missing) if missing else ""
    return _HEAD.format(paper=export.paper) + "\n".join(rows) + tail + "\n"
