"""How a command ends: whatever it raises is one line and a status, and never "the answer is no"."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from helpers.cases import CASES
from helpers.processes import descendants, processor_seconds, wait_until
from semispline import ComputationError, FileError, OptionError
from semispline.papers.cli import app as whole_app
from semispline.solver.exit_status import TRACEBACK, reports_errors

ENTRY = "from semispline.papers.cli import main; main()"


def ended(error, **environment):
    app = typer.Typer(pretty_exceptions_enable=False)

    @app.command()
    @reports_errors
    def command() -> None:
        raise error

    done = CliRunner().invoke(app, [], env=environment)
    # Nothing of the error came through but the status.
    assert done.exception is None or isinstance(done.exception, SystemExit)
    assert done.stdout == ""
    return done


@pytest.mark.parametrize(
    ("error", "status", "said"),
    [
        (FileError("x"), 2, "error: x\n"),
        (OptionError("x\ny"), 2, "error: x y\n"),
        (ComputationError("x"), 3, "error: x\n"),
        (ValueError("x\ny"), 3, "error: ValueError: x y; this is a fault of semispline"),
        (KeyError("x"), 3, "error: KeyError: 'x'; this"),
        (RecursionError(), 3, "error: RecursionError"),
        (OSError(28, "No space left on device"), 3, "error: OSError: [Errno 28] No space left"),
        (EOFError(), 3, "error: EOFError"),
        (AssertionError(), 3, "error: AssertionError"),
        (SystemExit(1), 3, "error: SystemExit"),
        (MemoryError(), 3, "error: out of memory; "),
        (KeyboardInterrupt(), 130, "interrupted\n"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, BaseException) else None,
)
def test_each_error_has_its_status_and_one_line(error, status, said):
    done = ended(error)
    assert done.exit_code == status
    assert done.stderr.startswith(said)
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("status", [0, 1, 2, 3])
def test_a_status_that_a_command_chose_stays(status):
    done = ended(typer.Exit(status))
    assert (done.exit_code, done.stderr) == (status, "")


def test_a_traceback_is_there_for_whoever_asks():
    assert "Traceback" not in ended(ValueError("x")).stderr
    done = ended(ValueError("x"), **{TRACEBACK: "1"})
    assert done.exit_code == 3
    assert "Traceback" in done.stderr
    assert "in command" in done.stderr


def test_every_command_reports_its_errors():
    wrapper = reports_errors(lambda: None).__code__
    assert len(whole_app.registered_commands) == 11
    for command in whole_app.registered_commands:
        assert command.callback.__code__ is wrapper, command.callback.__name__


def test_a_command_of_the_derivations_ends_the_same_way(monkeypatch):
    def fail(*_):
        raise RuntimeError("no")

    monkeypatch.setattr("semispline.derivations.results.show", fail)
    done = CliRunner().invoke(whole_app, ["derive", "energy"])
    assert done.exit_code == 3
    assert done.stderr.startswith("error: RuntimeError: no; ")


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for the reader")
def test_ctrl_c_ends_a_reading_command_with_130():
    # What a shell starts in the background ignores this signal, and so would the command.
    code = f"""
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {str(Path(__file__).parents[1])!r})
from semispline.solver.io import foreign
read = foreign.call
foreign.call = lambda *_: read("helpers.turning", ["turn"], 600, 4096)
{ENTRY}
"""
    command = subprocess.Popen(
        [sys.executable, "-c", code, "list", str(CASES / "loop28.brep")], stderr=subprocess.PIPE, text=True
    )
    wait_until(lambda: any(processor_seconds(p) > 0.3 for p in descendants(command.pid)), "the reader works")
    os.kill(command.pid, signal.SIGINT)
    assert command.communicate()[1] == "interrupted\n"
    assert command.returncode == 130


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="a pipe of POSIX")
def test_a_reader_of_the_output_that_left_is_no_answer():
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-c", ENTRY, "derive", "energy-density"], stdout=write, stderr=subprocess.PIPE, check=False
    )
    os.close(write)
    assert (done.returncode, done.stderr) == (141, b"")
