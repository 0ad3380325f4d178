"""Workers of `verify`: none outlives the command, and one that is ended is not an answer."""

import os
import signal
import subprocess
import sys

import pytest

from helpers.processes import descendants, is_gone, processor_seconds, wait_until

# Processes of whole runs: .ci/run has the time.
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for the workers"),
]

# Two groups of records, so two workers; a check holds the lock of the interpreter and never ends.
CLAIMS = """
import re

from semispline.papers.ledger.records import Check, Claim, Part, Reading, Strength, Verdict

from . import printed as pr


def cases(formula):
    re.match(r"(a+)+$", "a" * 64 + "b")
    yield


READING = Reading((Part(Check(cases, Strength.RATIONAL, "addition"), pr.RIGHT),))
CLAIMS = tuple(
    Claim(f"eq-{k}", "Section 1", "The sum is n(n+1)/2.", Verdict.HOLDS, (READING,)) for k in range(1, 9)
)
"""
# What a shell starts in the background ignores ctrl-C, and so would the command.
VERIFY = """
import signal, sys, threading
signal.signal(signal.SIGINT, signal.default_int_handler)
from semispline.papers.ledger import verify
from semispline.solver.exit_status import reports_errors
import typer
app = typer.Typer()

@app.command()
@reports_errors
def main():
    verify(sys.argv[1], workers=2)

def work():
    app([])

if sys.argv[2] == "main":
    work()
else:
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
"""


def started(folder, thread="main"):
    command = subprocess.Popen(
        [sys.executable, "-c", VERIFY, str(folder), thread], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    # Past the import of SymPy: both turn inside the call that does not end.
    wait_until(lambda: sum(processor_seconds(p) > 2 for p in descendants(command.pid)) >= 2, "both workers work")
    return command, descendants(command.pid)


@pytest.mark.parametrize("thread", ["main", "another"])
def test_killed_it_leaves_no_worker(made_up_paper, thread):
    command, workers = started(made_up_paper(claims=CLAIMS), thread)
    command.kill()
    command.wait()
    wait_until(lambda: all(map(is_gone, workers)), "the workers end with the command")
    command.communicate()


def test_ctrl_c_ends_it_with_130_and_no_traceback(made_up_paper):
    command, workers = started(made_up_paper(claims=CLAIMS))
    # A terminal sends it to the workers too.
    for process in (*workers, command.pid):
        os.kill(process, signal.SIGINT)
    assert command.communicate() == ("", "interrupted\n")
    assert command.returncode == 130
    wait_until(lambda: all(map(is_gone, workers)), "the workers end with the command")


def test_a_worker_that_is_killed_is_a_failed_computation(made_up_paper):
    command, workers = started(made_up_paper(claims=CLAIMS))
    os.kill(next(p for p in workers if processor_seconds(p) > 2), signal.SIGKILL)
    _, said = command.communicate()
    assert command.returncode == 3
    assert "killed from outside (SIGKILL)" in said
    assert said.count("\n") == 1
    wait_until(lambda: all(map(is_gone, workers)), "the workers end with the command")
