"""A working paper of three claims, written into a folder of the user's: what to begin with."""

from __future__ import annotations

import shutil
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from semispline.solver.errors import FileError
from semispline.solver.io import shown

_FILES = ("__init__.py", "printed.py", "claims.py")
_SAMPLE_TITLE = "Sums of powers, a sample."


def write_paper(folder: str | Path, title: str = "", doi: str = "") -> list[Path]:
    """Write a small paper that can be verified as it is, and return its files.

    Parameters
    ----------
    folder : str or Path
        New, or empty.
    title, doi : str
        Of the paper; the sample's where there is none.

    Raises
    ------
    FileError
        There is something in the folder, or it cannot be made.
    """
    folder = Path(folder)
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise FileError(f"{shown(folder)}: there is something already; give a new or an empty folder")
        folder.mkdir(parents=True, exist_ok=True)
        # Whole or not at all: what cannot be written fails here.
        with TemporaryDirectory(dir=folder.parent) as scratch:
            made = [Path(scratch) / name for name in _FILES]
            for path in made:
                path.write_text(_text(path.name, title, doi), encoding="utf-8")
            return [Path(shutil.move(path, folder / path.name)) for path in made]
    except (OSError, ValueError) as error:
        if isinstance(error, FileError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise FileError(f"{shown(folder)}: cannot be written: {reason}; give another folder") from None


def _text(name: str, title: str, doi: str) -> str:
    text = files("semispline.papers.new_paper").joinpath("template", name).read_text(encoding="utf-8")
    if name != "__init__.py" or not (title.strip() or doi.strip()):
        return text
    head = " ".join((title.strip() or _SAMPLE_TITLE).split()).rstrip(".")
    published = " ".join(doi.split())
    line = f"{head} (doi {published})." if published else f"{head}."
    return text.replace(_SAMPLE_TITLE, line.replace("\\", "\\\\").replace('"', '\\"'))
