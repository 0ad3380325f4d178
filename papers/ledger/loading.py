"""Finding a paper: a folder with `printed.py`, and records in the tuples `CLAIMS` of its `claims.py` or `claims/`.

What several records share as the cause of their faults stands in `CAUSES` of its `causes.py`, how it writes functions
in `NOTATION` of its `notation.py`, where it has these.
`printed.py` is the only module in which a printed formula can run. All of them are run as Python.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import re
import sys
from collections.abc import Callable, Iterable
from hashlib import sha256
from importlib.machinery import ModuleSpec
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

from semispline.papers.ledger.mistakes import MistakeError, place_of_text, placed
from semispline.papers.ledger.record_checks import check_causes, check_complete, check_record, same_ids
from semispline.papers.ledger.records import Cause, Claim, LedgerError, Paper, natural_key

# Where records stand.
RECORDS = ("claims.py", "claims/[!_]*.py")


def paper_names() -> list[str]:
    """Return the papers that ship with the package: folders with a `printed.py`."""
    return sorted(path.parent.name for path in Path(__file__).parents[1].glob("*/printed.py"))


def paper_folder(name: str) -> Path:
    """Return the folder of a paper, by its name under `papers/`, or by a path.

    Raises
    ------
    LedgerError
        There is neither a paper of this name nor such a folder with a `printed.py`.
    """
    if name in paper_names():
        return Path(__file__).parents[1] / name
    folder = Path(name)
    if not _is_file(folder / "printed.py"):
        known = ", ".join(paper_names())
        raise LedgerError(
            f"paper: found {name!r}, expected one of {known}, or a folder with printed.py and claims.py; "
            "semispline new-paper DIR writes one"
        )
    return folder.resolve()


def paper_files(name: str) -> list[Path]:
    """Return the modules that a paper is read from; none where there is no such paper."""
    try:
        return sorted(paper_folder(name).rglob("*.py"))
    except (OSError, ValueError):
        return []


def paper_module(name: str, within: str) -> ModuleType | None:
    """Return a module of a paper, such as `certificates`; None where it has none.

    Raises
    ------
    MistakeError
        It does not run.
    """
    folder = paper_folder(name)
    place = folder.joinpath(*within.split("."))
    if not _is_file(place.with_suffix(".py")) and not _is_file(place / "__init__.py"):
        return None
    with placed(folder):
        return importlib.import_module(f"{_package(name).__name__}.{within}")


def load_paper(name: str) -> Paper:
    """Load a paper by its name under `papers/`, or by the path of a folder, and check every record.

    Raises
    ------
    LedgerError
        There is no such paper, a module does not run or has no CLAIMS, an id occurs twice, or a record is not well
        formed or not complete. Where a file is at fault, the message begins with it and its line.
    """
    paper = load_drafts(name)
    _check(paper, check_complete, paper.claims)
    check_causes(paper.claims, paper.causes)
    return paper


def load_drafts(name: str) -> Paper:
    """Load a paper whose records are well formed, but need not be complete.

    Raises
    ------
    LedgerError
        As `load_paper`, but for what is missing.
    """
    paper = collected(name)
    _check(paper, check_record, paper.claims)
    return paper


def collected(name: str) -> Paper:
    """Return a paper whose records are not checked: a worker decides what the process that started it has checked.

    Raises
    ------
    LedgerError
        There is no such paper, a module does not run or has no CLAIMS, or an id occurs twice.
    """
    folder, package = paper_folder(name), _package(name)
    claims = [claim for file in record_files(name) for claim in claims_of(name, file)]
    if not claims:
        raise LedgerError(f"{folder}: no claims.py and no claims/ with records, expected at least one")
    twice = same_ids(claims)
    if twice:
        where = place_of_text(twice[0], folder, *RECORDS)
        what = "the id twice" if len(set(twice)) == 1 else f"the ids {twice[0]} and {twice[1]}, which sort as one"
        raise MistakeError(f"{where or folder}: claim {twice[0]}: found {what}; expected each once")
    title, _, legend = inspect.cleandoc(package.__doc__ or folder.name).partition("\n\n")
    causes = _named(name, folder, "causes", "CAUSES", _are_causes, "tuple of Cause")
    notation = _named(name, folder, "notation", "NOTATION", _is_notation, "dict of functions")
    title = " ".join(title.split()).rstrip(".")
    return Paper(name, title, legend, tuple(claims), causes or (), folder, notation or {})


def record_files(name: str) -> list[str]:
    """Return the files with records, within the folder of a paper, as they sort by name."""
    folder = paper_folder(name)
    files = [path.relative_to(folder).as_posix() for pattern in RECORDS for path in folder.glob(pattern)]
    return sorted(files, key=natural_key)


def claims_of(name: str, file: str) -> tuple[Claim, ...]:
    """Return the records of one file; they are not checked.

    Raises
    ------
    MistakeError
        It does not run, or has no CLAIMS.
    """
    folder, package = paper_folder(name), _package(name)
    path = folder / file
    with placed(folder):
        module = importlib.import_module(".".join((package.__name__, *_module_parts(path, folder))))
    found = getattr(module, "CLAIMS", None)
    if not isinstance(found, tuple) or not all(isinstance(c, Claim) for c in found):
        what = f"a {type(found).__name__}" if found is not None else "nothing"
        raise MistakeError(f"{path}: CLAIMS is {what}, expected a tuple of Claim")
    return found


def _check(paper: Paper, check: Callable[[Claim], None], claims: Iterable[Claim]) -> None:
    """Check records, and name the line where one stands that is refused."""
    for claim in claims:
        try:
            check(claim)
        except LedgerError as error:
            where = place_of_text(claim.id, paper.folder, *RECORDS)
            raise MistakeError(f"{where}: {error}" if where else str(error)) from None


def _named(name: str, folder: Path, within: str, what: str, fits: Callable[[Any], bool], expected: str) -> Any:
    """Return a name of a module that a paper may have; None where it has no such module."""
    module = paper_module(name, within)
    if module is None:
        return None
    found = getattr(module, what, None)
    if not fits(found):
        raise MistakeError(f"{folder / within}.py: {what} is a {type(found).__name__}, expected a {expected}")
    return found


def _are_causes(found: Any) -> bool:
    return isinstance(found, tuple) and all(isinstance(cause, Cause) for cause in found)


def _is_notation(found: Any) -> bool:
    return isinstance(found, dict) and all(callable(rule) for rule in found.values())


def _module_parts(path: Path, folder: Path) -> tuple[str, ...]:
    return path.relative_to(folder).with_suffix("").parts


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _package(name: str) -> ModuleType:
    if name in paper_names():
        return importlib.import_module(f"semispline.papers.{name}")
    folder = paper_folder(name)
    mark = sha256(str(folder).encode()).hexdigest()[:12]
    alias = f"_semispline_paper_{re.sub(r'[^0-9A-Za-z]', '_', folder.name)}_{mark}"
    if alias not in sys.modules:
        sys.modules[alias] = _new_package(alias, folder)
    return sys.modules[alias]


def _new_package(alias: str, folder: Path) -> ModuleType:
    """Return a folder as a package, even without `__init__.py`, so that its modules can import `printed` from it."""
    init = folder / "__init__.py"
    if not init.is_file():
        spec = ModuleSpec(alias, None, is_package=True)
        spec.submodule_search_locations = [str(folder)]
        module = module_from_spec(spec)
        with placed(folder):
            module.__doc__ = ast.get_docstring(ast.parse((folder / "printed.py").read_bytes(), folder / "printed.py"))
        return module
    found = spec_from_file_location(alias, init, submodule_search_locations=[str(folder)])
    assert found is not None
    assert found.loader is not None
    module = module_from_spec(found)
    sys.modules[alias] = module
    try:
        with placed(folder):
            found.loader.exec_module(module)
    except MistakeError:
        del sys.modules[alias]
        raise
    return module
