"""Reading whole files, and writing them whole or not at all."""

from __future__ import annotations

import os
import secrets
import shutil
import stat
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

from semispline.solver.errors import FileError


def check_output(path: str | Path) -> Path:
    """Return the real path (symbolic links followed) if a file can be written there.

    Long work calls this first, so that a mistyped folder costs no computing time.

    Raises
    ------
    FileError
        No such folder, no right to write, or a folder or device of that name.
    """
    try:
        target = Path(os.path.realpath(path))
        mode = _mode(target)
    except (OSError, ValueError) as error:
        raise FileError(f"{shown(path)}: cannot be written: {_reason(error)}; give another name") from None
    if mode is not None and stat.S_ISDIR(mode):
        raise FileError(f"{shown(path)}: is a folder; give the name of a file")
    if mode is not None and not stat.S_ISREG(mode):
        raise FileError(f"{shown(path)}: is not a regular file; give the name of a file")
    if not target.parent.is_dir():
        problem = "is not a folder; choose one" if target.parent.exists() else "does not exist; create it first"
        raise FileError(f"{shown(path)}: folder {shown(target.parent)} {problem}")
    if not os.access(target.parent, os.W_OK):
        raise FileError(f"{shown(path)}: folder {shown(target.parent)} may not be written to; choose another")
    return target


def check_outputs(outputs: Mapping[str, str | Path | None], inputs: Iterable[str | Path]) -> None:
    """Refuse an output that cannot be written, is one of the inputs, or is another output.

    What counts is the file: links of both kinds are followed, and `./` before a name changes nothing.

    Parameters
    ----------
    outputs : mapping
        Option -> path; None where it was not given.
    inputs : iterable of str or Path

    Raises
    ------
    FileError
        With the option.
    """
    taken = [(f"the input {shown(path)}", path) for path in inputs]
    for option, path in outputs.items():
        if path is None:
            continue
        check_output(path)
        same = next((what for what, other in taken if _same_file(path, other)), None)
        if same is not None:
            raise FileError(f"{option}: {shown(path)} is {same}; give another name")
        taken.append((f"the file of {option}", path))


def shown(path: str | Path) -> str:
    """Return a path as a message can hold it."""
    text = str(path)
    text = text if len(text) <= 300 else f"{text[:140]}...{text[-140:]}"
    return text if text and text.isprintable() else repr(text)


def _same_file(a: str | Path, b: str | Path) -> bool:
    try:
        return os.path.realpath(a) == os.path.realpath(b) or os.path.samefile(a, b)
    except (OSError, ValueError):
        # One of them does not exist, or cannot.
        return False


def _mode(path: Path) -> int | None:
    """Return kind and rights of a file; None where there is none."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None


def _reason(error: OSError | ValueError) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """Give a temporary path in the folder of `path`; what is written there replaces `path` at the end.

    If the body raises, `path` is as it was and the temporary file is gone.

    Raises
    ------
    FileError
        As `check_output`, or the system refused to write.
    """
    target = check_output(path)
    # The suffix is kept: some writers choose the format by it.
    temporary = target.with_name(f".semispline-{secrets.token_hex(8)}{target.suffix}")
    try:
        yield temporary
        if not temporary.is_file():
            raise FileError(f"{shown(path)}: the writer produced no file")
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, temporary)
        os.replace(temporary, target)
    except OSError as error:
        raise FileError(f"{shown(path)}: cannot be written: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write `data` to `path`, whole or not at all.

    Raises
    ------
    FileError
        As `atomic_path`.
    """
    with atomic_path(path) as temporary:
        temporary.write_bytes(data)


def write_text(path: str | Path, text: str) -> None:
    """Write `text` to `path` in UTF-8, whole or not at all.

    Raises
    ------
    FileError
        As `atomic_path`.
    """
    write_bytes(path, text.encode())


def check_folder(path: str | Path) -> Path:
    """Return the real path of a folder if files can be written there, or if it can be made.

    Raises
    ------
    FileError
        A file of that name, no such parent folder, or no right to write.
    """
    try:
        folder = Path(os.path.realpath(path))
        mode = _mode(folder)
    except (OSError, ValueError) as error:
        raise FileError(f"{shown(path)}: cannot be a folder: {_reason(error)}; give another name") from None
    if mode is None:
        return check_output(path)
    if not stat.S_ISDIR(mode):
        raise FileError(f"{shown(path)}: is not a folder; give the name of a folder")
    if not os.access(folder, os.W_OK):
        raise FileError(f"{shown(path)}: may not be written to; choose another folder")
    return folder


def write_texts(path: str | Path, texts: Mapping[str, str]) -> list[Path]:
    """Write texts in UTF-8 as `write_files` does.

    Raises
    ------
    FileError
        As `write_files`.
    """
    return write_files(path, {name: text.encode() for name, text in texts.items()})


def write_files(path: str | Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write files by name into a folder, made if missing; all of them or none.

    Raises
    ------
    FileError
        As `check_folder`, or the system refused to write.
    """
    folder = check_folder(path)
    is_new = not folder.is_dir()
    try:
        folder.mkdir(exist_ok=True)
        with ExitStack() as stack:
            # Each lies in its temporary file before the first takes its place.
            for name, data in files.items():
                stack.enter_context(atomic_path(folder / name)).write_bytes(data)
    except (OSError, FileError) as error:
        if is_new:
            shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, FileError):
            raise
        raise FileError(f"{shown(path)}: cannot be written: {error.strerror or error}") from error
    return [folder / name for name in files]


def read_bytes(path: str | Path) -> bytes:
    """Return the content of a regular file.

    Raises
    ------
    FileError
        Missing, a folder or device, or not readable.
    """
    require_file(path)
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise FileError(f"{shown(path)}: cannot be read: {error.strerror or error}") from None


def require_file(path: str | Path) -> None:
    """Refuse a path that is no regular file.

    Raises
    ------
    FileError
        With the reason.
    """
    try:
        mode = _mode(Path(path))
    except (OSError, ValueError) as error:
        raise FileError(f"{shown(path)}: cannot be read: {_reason(error)}; check the path") from None
    if mode is None:
        raise FileError(f"{shown(path)}: no such file; check the path")
    if not stat.S_ISREG(mode):
        raise FileError(f"{shown(path)}: not a regular file; give the name of a file")
    if not os.access(path, os.R_OK):
        raise FileError(f"{shown(path)}: may not be read; change its rights")
