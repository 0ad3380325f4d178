"""Reading whole files, and writing them whole or not at all."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator, Mapping
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
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise FileError(f"{path}: is a folder; give the name of a file")
    if target.exists() and not target.is_file():
        raise FileError(f"{path}: is not a regular file; give the name of a file")
    if not target.parent.is_dir():
        raise FileError(f"{path}: folder {target.parent} does not exist; create it first")
    if not os.access(target.parent, os.W_OK):
        raise FileError(f"{path}: folder {target.parent} may not be written to; choose another")
    return target


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
            raise FileError(f"{path}: the writer produced no file")
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, temporary)
        os.replace(temporary, target)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from error
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
    folder = Path(os.path.realpath(path))
    if folder.is_dir():
        if not os.access(folder, os.W_OK):
            raise FileError(f"{path}: may not be written to; choose another folder")
        return folder
    if folder.exists():
        raise FileError(f"{path}: is not a folder; give the name of a folder")
    return check_output(path)


def write_texts(path: str | Path, texts: Mapping[str, str]) -> list[Path]:
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
            # Every text lies in its temporary file before the first takes its place.
            for name, text in texts.items():
                stack.enter_context(atomic_path(folder / name)).write_bytes(text.encode())
    except (OSError, FileError) as error:
        if is_new:
            shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, FileError):
            raise
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from error
    return [folder / name for name in texts]


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
        raise FileError(f"{path}: cannot be read: {error.strerror or error}") from None


def require_file(path: str | Path) -> None:
    """Refuse a path that is no regular file.

    Raises
    ------
    FileError
        With the reason.
    """
    try:
        found, regular = Path(path).exists(), Path(path).is_file()
    except (OSError, ValueError) as error:
        raise FileError(f"{str(path)[:80]!r}: not a path: {error}") from None
    if not found:
        raise FileError(f"{path}: no such file; check the path")
    if not regular:
        raise FileError(f"{path}: not a regular file; give the name of a file")
