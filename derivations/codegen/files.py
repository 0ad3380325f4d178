"""The generated part of a checkout: what it should be, how it differs, how it is written."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from difflib import unified_diff
from pathlib import Path

from semispline.derivations.codegen.catalogue import generated_files

GENERATED = Path("solver", "generated")
THEORY = Path("docs", "theory.md")

# A block of docs/theory.md: the arguments of `semispline derive`, then what it printed.
_BLOCK = re.compile(r"(<!-- derive (?P<call>[^\n]*?) -->\n```(?P<fence>\w+)\n)(?P<body>.*?)(```\n)", re.DOTALL)


def checkout_root(start: Path) -> Path:
    """Return the checkout that holds `start`, the folder of the package `derivations`.

    Raises
    ------
    ValueError
        The package is installed without its checkout.
    """
    root = start.resolve().parent
    project = root / "pyproject.toml"
    if not (root / GENERATED).is_dir() or not project.is_file() or 'name = "semispline"' not in project.read_text():
        raise ValueError(
            f"{root}: not a checkout of semispline; run `semispline generate` in a clone of its repository"
        )
    return root


def expected_files(root: Path, derive: Callable[[str], str]) -> dict[Path, str]:
    """Return the text of each generated file, by its path relative to the checkout.

    Parameters
    ----------
    root : Path
    derive : callable
        Arguments of `semispline derive` to what it prints, for the formulas in docs/theory.md.
    """
    files = {GENERATED / name: text for name, text in generated_files().items()}
    if (root / THEORY).is_file():
        files[THEORY] = refreshed((root / THEORY).read_text(encoding="utf-8"), derive)
    return files


def refreshed(text: str, derive: Callable[[str], str]) -> str:
    r"""Return a Markdown text with the body of each `<!-- derive ... -->` block printed anew.

    Examples
    --------
    >>> refreshed("<!-- derive energy -->\n```math\nold\n```\n", lambda call: f"new {call}\n")
    '<!-- derive energy -->\n```math\nnew energy\n```\n'
    """
    return _BLOCK.sub(lambda match: match[1] + derive(match["call"]) + match[5], text)


def stale_files(root: Path, expected: dict[Path, str]) -> list[Path]:
    """Return files in solver/generated that nothing generates, relative to the checkout."""
    found = sorted(path for path in (root / GENERATED).rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return [path.relative_to(root) for path in found if path.relative_to(root) not in expected]


def differences(root: Path, expected: dict[Path, str]) -> str:
    """Return a unified diff from what is there to what should be; empty if nothing differs."""
    parts = []
    wanted: dict[Path, str | None] = dict(expected)
    wanted.update(dict.fromkeys(stale_files(root, expected)))
    for path, text in sorted(wanted.items()):
        target = root / path
        there = target.read_text(encoding="utf-8", errors="replace") if target.is_file() else ""
        if text is None or there != text or not target.is_file():
            sides = (
                f"{path} (found)",
                f"{path} (stale: nothing generates it)" if text is None else f"{path} (generated)",
            )
            lines = list(unified_diff(there.splitlines(True), (text or "").splitlines(True), *sides))
            # An empty file has no lines to show.
            parts += lines or [f"--- {sides[0]}\n+++ {sides[1]}\n"]
    return "".join(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in parts)


def write_files(root: Path, expected: dict[Path, str]) -> list[Path]:
    """Write what differs, remove what is stale; return the paths that changed, relative to the checkout.

    Each file is written beside its place and moved there, so that none is ever half written.
    """
    changed = []
    for path, text in expected.items():
        target = root / path
        if not target.is_file() or target.read_text(encoding="utf-8", errors="replace") != text:
            partial = target.with_name(f".{target.name}.partial")
            try:
                partial.write_text(text, encoding="utf-8", newline="\n")
                os.replace(partial, target)
            finally:
                partial.unlink(missing_ok=True)
            changed.append(path)
    for path in stale_files(root, expected):
        (root / path).unlink()
        changed.append(path)
    return changed
