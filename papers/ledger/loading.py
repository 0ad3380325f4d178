"""Finding a paper: a folder with `printed.py`, and records in the tuples `CLAIMS` of its `claims.py` or `claims/`.

What several records share as the cause of their faults stands in `CAUSES` of its `causes.py`, where it has one.
`printed.py` is the only module in which a printed formula can run.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
from pathlib import Path
from types import ModuleType

from semispline.papers.ledger.record_checks import check_causes, check_record
from semispline.papers.ledger.records import Cause, Claim, LedgerError, Paper


def paper_names() -> list[str]:
    """Return the papers that ship with the package: folders with a `printed.py`."""
    return sorted(path.parent.name for path in Path(__file__).parents[1].glob("*/printed.py"))


def paper_files(name: str) -> list[Path]:
    """Return the modules that a paper is read from; none where there is no such paper."""
    folder = Path(__file__).parents[1] / name if name in paper_names() else Path(name)
    try:
        return sorted(folder.rglob("*.py"))
    except (OSError, ValueError):
        return []


def load_paper(name: str) -> Paper:
    """Load a paper by its folder name under `papers/`, or by the path of a folder, and check every record.

    Raises
    ------
    LedgerError
        There is no such paper, a module has no CLAIMS, an id occurs twice, or a record is not well formed.
    """
    paper = collected(name)
    for claim in paper.claims:
        check_record(claim)
    check_causes(paper.claims, paper.causes)
    return paper


def collected(name: str) -> Paper:
    """Return a paper whose records are not checked: a worker decides what the process that started it has checked.

    Raises
    ------
    LedgerError
        There is no such paper, a module has no CLAIMS, or an id occurs twice.
    """
    package = _package(name)
    folder = Path(str(package.__file__)).parent
    claims: list[Claim] = []
    for path in sorted((*folder.glob("claims.py"), *folder.glob("claims/[!_]*.py"))):
        within = ".".join(path.relative_to(folder).with_suffix("").parts)
        module = importlib.import_module(f"{package.__name__}.{within}")
        found = getattr(module, "CLAIMS", None)
        if not isinstance(found, tuple) or not all(isinstance(c, Claim) for c in found):
            raise LedgerError(f"{path.name}: CLAIMS is {type(found).__name__}, expected a tuple of Claim")
        claims += found
    if not claims:
        raise LedgerError(f"{folder}: no claims.py and no claims/ with records, expected at least one")
    for i, claim in enumerate(claims):
        if claim.id in {c.id for c in claims[:i]}:
            raise LedgerError(f"claim {claim.id}: the id occurs twice, expected once")
    title, _, legend = inspect.cleandoc(package.__doc__ or folder.name).partition("\n\n")
    return Paper(name, title.rstrip("."), legend, tuple(claims), _causes(package, folder))


def _causes(package: ModuleType, folder: Path) -> tuple[Cause, ...]:
    if not _is_file(folder / "causes.py"):
        return ()
    found = getattr(importlib.import_module(f"{package.__name__}.causes"), "CAUSES", None)
    if not isinstance(found, tuple) or not all(isinstance(c, Cause) for c in found):
        raise LedgerError(f"causes.py: CAUSES is {type(found).__name__}, expected a tuple of Cause")
    return found


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _package(name: str) -> ModuleType:
    if name in paper_names():
        return importlib.import_module(f"semispline.papers.{name}")
    folder = Path(name)
    if not _is_file(folder / "printed.py"):
        known = ", ".join(paper_names())
        raise LedgerError(f"paper: found {name!r}, expected one of {known}, or a folder with printed.py and claims.py")
    folder = folder.resolve()
    alias = f"_semispline_paper_{folder.name}_{abs(hash(str(folder)))}"
    if alias not in sys.modules:
        # A folder is a package even without __init__.py, so that its modules can import `printed` from it.
        init = folder / "__init__.py"
        loader_path = init if init.is_file() else folder / "printed.py"
        spec = importlib.util.spec_from_file_location(alias, loader_path, submodule_search_locations=[str(folder)])
        if spec is None or spec.loader is None:
            raise LedgerError(f"paper: {folder} cannot be imported, expected Python modules")
        module = importlib.util.module_from_spec(spec)
        sys.modules[alias] = module
        spec.loader.exec_module(module)
    return sys.modules[alias]
