import os
import stat
import subprocess
import sys

import pytest

from semispline import FileError
from semispline.solver.io.disk import atomic_path, check_output, read_bytes, write_text
from semispline.solver.io.silence import silenced


def test_a_failing_writer_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "out.json"
    path.write_text("old")

    def fail_half_way():
        with atomic_path(path) as temporary:
            temporary.write_text("half of the ne")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail_half_way()
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["out.json"]


def test_a_disk_that_refuses_at_the_end_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "out.json"
    path.write_text("old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(FileError, match="No space left"):
        write_text(path, "new")
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["out.json"]


def test_a_writer_that_wrote_nothing_is_an_error(tmp_path):
    with pytest.raises(FileError, match="no file"), atomic_path(tmp_path / "out.json"):
        pass
    assert list(tmp_path.iterdir()) == []


def test_the_temporary_file_is_beside_the_target_and_keeps_its_suffix(tmp_path):
    with atomic_path(tmp_path / "out.step") as temporary:
        temporary.write_text("x")
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".step"
        assert not (tmp_path / "out.step").exists()
    assert (tmp_path / "out.step").read_text() == "x"


def test_links_are_followed_and_the_mode_is_kept(tmp_path):
    target, link = tmp_path / "target.json", tmp_path / "link.json"
    target.write_text("old")
    target.chmod(0o640)
    link.symlink_to(target)
    write_text(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_outputs_that_cannot_be(tmp_path):
    (tmp_path / "folder").mkdir()
    for path, word in (
        (tmp_path / "folder", "folder"),
        (tmp_path / "none" / "out.json", "does not exist"),
        (os.devnull, "regular"),
    ):
        with pytest.raises(FileError, match=word):
            check_output(path)


def test_inputs_that_cannot_be(tmp_path):
    for path, word in (
        (tmp_path / "none.json", "no such file"),
        (tmp_path, "regular"),
        (os.devnull, "regular"),
        ("a\0b", "cannot be read"),
        ("x" * 5000, "cannot be read: .*too long"),
    ):
        with pytest.raises(FileError, match=word):
            read_bytes(path)


def test_silence_stops_what_c_has_buffered():
    """In a process of its own, where C buffers what goes into a pipe."""
    code = """
import ctypes, os, subprocess, sys
from semispline.solver.io.silence import silenced
c = ctypes.CDLL(None)
c.printf(b"before\\n")
with silenced():
    os.write(1, b"system call\\n")
    c.printf(b"C library, not flushed\\n")
    print("Python")
    subprocess.run([sys.executable, "-c", "print('child')"], check=True)
print("after")
"""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert done.stdout == "before\nafter\n"


def test_silence_can_take_standard_error_too(capfd):
    with silenced(1, 2):
        os.write(2, b"noise\n")
    os.write(2, b"after\n")
    assert capfd.readouterr().err == "after\n"
