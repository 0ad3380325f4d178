"""The Coq files of an export: hand-written sources, lemmas of its statements, theorems that its records cite."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.resources import files
from pathlib import Path

from semispline.papers.recheck.coq_lemmas import lemma, met
from semispline.papers.recheck.gp import CONTROLS, statement_id
from semispline.papers.recheck.roots import NotForCoqError
from semispline.papers.recheck.statements import Export, Statement

LIBRARY = "Semispline"
STATEMENTS, CITED = "Statements", "Cited"
# Characters of lemmas in one file, which then takes up to a minute.
_SIZE = 40_000


@dataclass(frozen=True)
class Block:
    """One lemma in a file.

    Attributes
    ----------
    ids : tuple of str
        The statements that it proves, which differ in nothing but their names.
    names : tuple of str
        Of the lemma, and of one that says that its premises can be fulfilled.
    title, proved : str
    """

    ids: tuple[str, ...]
    names: tuple[str, ...]
    title: str
    proved: str

    @property
    def text(self) -> str:
        """What stands in the file: the statements that it proves, and the lemmas."""
        also = ", ".join(identifier.partition(":")[0] for identifier in self.ids[1:])
        return f"(* {_comment(self.title)}{'; also ' if also else ''}{_comment(also)} *)\n{self.proved}\n\n"


@dataclass(frozen=True)
class CoqFile:
    """One generated file.

    Attributes
    ----------
    name : str
        Of the module.
    needed : tuple of str
        Modules that it imports.
    blocks : tuple of Block
    cited : tuple of str
        Theorems of hand-written sources.
    over_reals : bool
        Whether the axioms of the library's real numbers are allowed.
    """

    name: str
    needed: tuple[str, ...]
    blocks: tuple[Block, ...] = ()
    cited: tuple[str, ...] = ()
    over_reals: bool = False

    @property
    def asked(self) -> tuple[str, ...]:
        """Names whose assumptions are printed at the end, all at once."""
        return (*(name for block in self.blocks for name in block.names), *self.cited)

    @property
    def text(self) -> str:
        """What stands in the file."""
        uses = "\n".join(f"  pose proof {name}." for name in self.asked)
        end = f"Lemma everything : True.\nProof.\n{uses}\n  exact I.\nQed.\nPrint Assumptions everything.\n"
        return self._head + "".join(block.text for block in self.blocks) + (end if self.asked else "")

    @property
    def _head(self) -> str:
        scope = "" if self.over_reals else "Open Scope Q_scope.\n"
        return f"From {LIBRARY} Require Import {' '.join(self.needed)}.\n{scope}\n"

    def block_at(self, line: int) -> Block | None:
        """Return the block that a line stands in."""
        last = self._head.count("\n")
        for block in self.blocks:
            last += block.text.count("\n")
            if line <= last:
                return block
        return None


@dataclass(frozen=True)
class CoqFolder:
    """All generated files of an export, and what has no lemma.

    Attributes
    ----------
    files : tuple of CoqFile
    without : mapping
        Record -> why a statement of it has no lemma.
    """

    files: tuple[CoqFile, ...]
    without: Mapping[str, str] = field(default_factory=dict)


@cache
def hand_written() -> dict[str, str]:
    """Return the hand-written sources, by their modules."""
    folder = files("semispline.derivations") / "coq"
    found = {path.name[:-2]: path.read_text(encoding="utf-8") for path in folder.iterdir() if path.name.endswith(".v")}
    return dict(sorted(found.items()))


def imports(text: str) -> tuple[str, ...]:
    r"""Return the modules of ours that a source imports.

    Examples
    --------
    >>> imports("From Coq Require Import Reals.\nFrom Semispline Require Import Sums BSplines.")
    ('Sums', 'BSplines')
    """
    found = re.findall(rf"^From {LIBRARY} Require (?:Import|Export) ([^.]+)\.", text, re.MULTILINE)
    return tuple(name for line in found for name in line.split())


def needed_sources(folder: CoqFolder) -> dict[str, str]:
    """Return the hand-written sources that the files of a folder need, each after those that it imports.

    Where theorems of them are cited, all of them: those that none needs are instances and controls.
    """
    every, found = hand_written(), dict[str, str]()

    def add(name: str) -> None:
        if name in every and name not in found:
            for needed in imports(every[name]):
                add(needed)
            found[name] = every[name]

    for file in folder.files:
        for name in every if file.cited else file.needed:
            add(name)
    return found


def coq_folder(export: Export) -> CoqFolder:
    """Return the files of lemmas of an export.

    A statement that occurs more than once is proved once, by the name of the first record that has it.
    """
    cases = [(c.id, n, case) for c in export.certificates for n, case in enumerate(c.statements, start=1)]
    cases += [(CONTROLS, n, case) for n, case in enumerate(export.controls, start=1)]
    blocks: dict[str, Block] = {}
    without: dict[str, str] = {}
    for record, number, case in cases:
        try:
            text = lemma(case)
        except NotForCoqError as error:
            without.setdefault(record, str(error))
            continue
        name, identifier = lemma_name(record, number), statement_id(record, number, case)
        known = blocks.get(text)
        if known is not None:
            blocks[text] = replace(known, ids=(*known.ids, identifier))
        else:
            premises = met(case)
            names = (name,) if premises is None else (name, f"{name}_met")
            proved = [f"Lemma {name} : {text}", *([] if premises is None else [f"Lemma {name}_met : {premises}"])]
            blocks[text] = Block((identifier,), names, identifier + _flags(case), "\n".join(proved))
    return CoqFolder((*_grouped(blocks.values()), *_theories(export), *_citing(export)), without)


def _grouped(blocks: Iterable[Block]) -> Iterator[CoqFile]:
    """Yield files of lemmas, none of them long."""
    group: list[Block] = []
    size = number = 0
    for block in [*blocks, None]:
        if group and (block is None or size + len(block.text) > _SIZE):
            number += 1
            yield CoqFile(f"{STATEMENTS}_{number}", ("Rational", "Matrices"), tuple(group))
            group, size = [], 0
        if block is not None:
            group.append(block)
            size += len(block.text)


def _theories(export: Export) -> Iterator[CoqFile]:
    """Yield a file for each theorem that is generated as a whole."""
    for theory in export.theories:
        block = Block((theory.title,), (theory.name,), theory.title, theory.text)
        yield CoqFile(theory.name.capitalize(), theory.needed, (block,), over_reals=theory.over_reals)


def _citing(export: Export) -> Iterator[CoqFile]:
    """Yield the file that asks what the cited theorems rest on."""
    cited = tuple(dict.fromkeys(name for names in export.theorems.values() for name in names))
    if cited:
        yield CoqFile(CITED, tuple(dict.fromkeys(name.partition(".")[0] for name in cited)), (), cited, over_reals=True)


def write_coq(folder: CoqFolder, place: Path) -> list[Path]:
    """Write the files of a folder, the sources that they need, their order, and a script that checks all of them."""
    sources = needed_sources(folder) | {file.name: file.text for file in folder.files}
    texts = {f"{name}.v": text for name, text in sources.items()}
    texts["order"] = "".join(f"{name}\n" for name in sources)
    texts["check.sh"] = (
        f"# sh check.sh: silent but for what each file rests on; the status is 0 where Coq accepts all.\n{_LOOP}"
    )
    place.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (place / name).write_text(text, encoding="utf-8")
    return [place / name for name in texts]


_LOOP = f"""while read -r file; do
  coqc -q -Q . {LIBRARY} "$file.v" </dev/null || exit 1
done <order
"""


def lemma_name(record: str, number: int) -> str:
    """Return the name of a lemma.

    Examples
    --------
    >>> lemma_name("cond-3.1", 7)
    'cond_3_1__7'
    """
    return re.sub(r"\W", "_", record) + f"__{number}"


def _comment(text: str) -> str:
    return text.replace('"', "'").replace("(*", "( *").replace("*)", "* )")


def _flags(case: Statement) -> str:
    flags = ["" if case.true else "false", "" if case.own else "outside of the paper's setting"]
    found = ", ".join(flag for flag in flags if flag)
    return f" ({found})" if found else ""
