"""The kernel of Coq on the files of an export: what it accepts, and on which axioms that rests."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from semispline.papers.recheck.coq_folder import (
    LIBRARY,
    Block,
    CoqFile,
    CoqFolder,
    imports,
    needed_sources,
    write_coq,
)
from semispline.solver.errors import ComputationError, OptionError

# Of processor time; a file takes up to a minute.
_SECONDS = 600
# Each takes up to a gigabyte.
_AT_ONCE = 4
# What Coq's own real numbers rest on, and its theorems on continuous functions.
REALS = frozenset(
    {
        "ClassicalDedekindReals.sig_forall_dec",
        "ClassicalDedekindReals.sig_not_dec",
        "FunctionalExtensionality.functional_extensionality_dep",
        "Classical_Prop.classic",
    }
)


@dataclass(frozen=True)
class Kernel:
    """What the kernel said.

    Attributes
    ----------
    version : str
    refused : tuple of str
        Statements that it refused.
    problems : tuple of str
        Axioms that are not allowed.
    axioms : frozenset of str
        Those of the library that the cited theorems rest on.
    """

    version: str
    refused: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()
    axioms: frozenset[str] = frozenset()


@dataclass(frozen=True)
class _Settled:
    """A file as it was accepted, what was taken out of it, and what `Print Assumptions` said."""

    file: CoqFile
    refused: tuple[str, ...]
    output: str


def require_coqc() -> str:
    """Return the path of coqc.

    Raises
    ------
    OptionError
        It is not installed.
    """
    found = shutil.which("coqc")
    if found is None:
        raise OptionError("--recheck coq: found no coqc, expected Coq installed, such as Debian's package coq")
    return found


def kernel_of(folder: CoqFolder, place: str | Path) -> Kernel:
    """Compile the files of an export in a folder, and return what the kernel accepts.

    A lemma that is refused is taken out, until the rest of its file is accepted.

    Raises
    ------
    ComputationError
        A hand-written source is refused, a file takes too long, or is refused at no lemma.
    """
    place = Path(place)
    write_coq(folder, place)
    sources = needed_sources(folder)
    with ThreadPoolExecutor(min(os.cpu_count() or 1, _AT_ONCE)) as pool:
        for level in _levels(sources):
            for name, done in zip(level, pool.map(lambda n: _run(place, n), level), strict=True):
                if done.returncode:
                    raise ComputationError(f"recheck: derivations/coq/{name}.v is refused: {_error(done)}")
        settled = list(pool.map(lambda file: _settled(place, file), folder.files))
    problems: list[str] = []
    axioms: set[str] = set()
    for one in settled:
        found = assumptions_in(one.output, one.file.name) if one.file.asked else set()
        allowed = REALS if one.file.over_reals else frozenset[str]()
        problems += [f"{one.file.name}.v: found the axiom {name}, expected none" for name in sorted(found - allowed)]
        axioms |= found
    refused = tuple(name for one in settled for name in one.refused)
    if refused:
        write_coq(folder, place)
    return Kernel(coq_version(), refused, tuple(problems), frozenset(axioms))


def coq_version() -> str:
    """Return the version of Coq."""
    done = subprocess.run([require_coqc(), "--print-version"], capture_output=True, text=True, check=True)
    return done.stdout.split()[0]


def _levels(sources: Mapping[str, str]) -> Iterator[list[str]]:
    """Yield modules that import only those of levels before."""
    done: set[str] = set()
    while len(done) < len(sources):
        level = [name for name in sources if name not in done and done.issuperset(imports(sources[name]))]
        if not level:
            raise ComputationError("recheck: found Coq sources that import each other in a circle")
        yield level
        done.update(level)


def _run(place: Path, name: str) -> subprocess.CompletedProcess[str]:
    """Compile one file; its processor time is limited."""
    command = [
        "sh",
        "-c",
        f'ulimit -t {_SECONDS}; exec "$0" "$@"',
        require_coqc(),
        "-q",
        "-Q",
        ".",
        LIBRARY,
        f"{name}.v",
    ]
    done = subprocess.run(command, cwd=place, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    if done.returncode < 0:
        raise ComputationError(
            f"recheck: coqc ended with signal {-done.returncode} on {name}.v, expected an answer within {_SECONDS} s"
        )
    return done


def _settled(place: Path, file: CoqFile) -> _Settled:
    """Compile a file without the lemmas that are refused."""
    refused: list[str] = []
    accepted: list[Block] = []
    left, done = file, _compiled(place, file)
    while done.returncode:
        wrong = _refused_block(left, done)
        at = left.blocks.index(wrong)
        refused += wrong.ids
        accepted += left.blocks[:at]
        # What stands before is accepted: only the rest is asked again.
        left = replace(file, blocks=left.blocks[at + 1 :])
        done = _compiled(place, left)
    if refused:
        file = replace(file, blocks=(*accepted, *left.blocks))
        done = _compiled(place, file)
    return _Settled(file, tuple(refused), done.stdout)


def _compiled(place: Path, file: CoqFile) -> subprocess.CompletedProcess[str]:
    (place / f"{file.name}.v").write_text(file.text, encoding="utf-8")
    return _run(place, file.name)


def _refused_block(file: CoqFile, done: subprocess.CompletedProcess[str]) -> Block:
    """Return the block at which Coq stopped.

    Raises
    ------
    ComputationError
        It stopped elsewhere.
    """
    line = re.search(r"line (\d+), characters", done.stderr)
    found = file.block_at(int(line[1])) if line else None
    if found is None:
        raise ComputationError(f"recheck: {file.name}.v is refused: {_error(done)}")
    return found


def _error(done: subprocess.CompletedProcess[str]) -> str:
    """Return where and why Coq stopped, in one line."""
    return " ".join(done.stderr.split())[:400] or f"status {done.returncode}"


def assumptions_in(output: str, name: str) -> set[str]:
    """Return the axioms that `Print Assumptions` named at the end of a file.

    Raises
    ------
    ComputationError
        It did not answer.
    """
    if output.strip() == "Closed under the global context":
        return set()
    head, _, listed = output.partition("Axioms:\n")
    found = set(re.findall(r"^([^\s:]+)\s*:", listed, re.MULTILINE))
    if head.strip() or not found:
        raise ComputationError(f"recheck: found no answer to Print Assumptions in {name}.v, expected one")
    return found
