"""Workers: what ends them, what is said of it, and that none outlives its parent."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from functools import partial
from pathlib import Path

import pytest

from helpers.processes import is_gone, wait_until
from helpers.sweeps import first_rows
from helpers.turning import hold_the_lock, print_and_return, work
from semispline import ComputationError, FileError
from semispline.solver.workers import End, WorkerError, call, in_pool

linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps these limits")
GENEROUS = {"seconds": 600, "megabytes": 4096}


def ask(what, *more, seconds=600, megabytes=4096):
    return call("helpers.turning", [what, *map(str, more)], seconds, megabytes)


def test_a_result_comes_back_whole_and_prints_are_dropped(capfd):
    assert ask("print") == print_and_return()
    capfd.readouterr()
    ask("print")
    assert capfd.readouterr() == ("", "")


def test_an_error_of_ours_comes_back():
    with pytest.raises(FileError, match=r"^bad file$"):
        ask("refuse")


LARGE_PARENT = """
import sys
sys.path.insert(0, {tests!r})
from semispline import SemisplineError
from semispline.solver.workers import call
held = bytearray(400 * 2**20)
for at in range(0, len(held), 4096):
    held[at] = 1
del held
try:
    call("helpers.turning", ["refuse"], 60, 300)
except SemisplineError as error:
    print(type(error).__name__, error)
"""


@pytest.mark.long
@linux
def test_memory_that_the_parent_had_is_not_the_workers():
    code = LARGE_PARENT.format(tests=str(Path(__file__).parents[1]))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("FileError bad file\n", "")


@linux
@pytest.mark.parametrize(
    ("what", "limits", "end", "said"),
    first_rows(
        2,
        [
            ("turn", {"seconds": 1}, End.TIME, "processor time"),
            ("fill", {"megabytes": 300}, End.MEMORY, "memory"),
            ("run out", {"megabytes": 300}, End.MEMORY, "memory"),
            ("segmentation fault", {}, End.CRASH, "SIGSEGV"),
            ("kill", {}, End.KILLED, "SIGKILL.*try again"),
            ("terminate", {}, End.KILLED, "SIGTERM"),
            ("fault", {}, End.FAULT, "ZeroDivisionError: division by zero.*report"),
            ("exit", {}, End.FAULT, "report"),
        ],
    ),
)
def test_every_end_has_its_own_name(what, limits, end, said):
    with pytest.raises(WorkerError, match=said) as caught:
        ask(what, **limits)
    assert caught.value.end is end
    assert isinstance(caught.value, ComputationError)


def test_the_error_can_be_handed_from_process_to_process():
    error = pickle.loads(pickle.dumps(WorkerError(End.KILLED, "SIGKILL")))
    assert (error.end, error.detail) == (End.KILLED, "SIGKILL")


PARENT = """
import os, sys, threading, time
from pathlib import Path
sys.path.insert(0, {tests!r})
from semispline.solver.workers import call

def hold_the_pipe():
    while not os.path.exists({pid!r}):
        time.sleep(0.05)
    child = os.fork()
    if child == 0:
        time.sleep(600)
        os._exit(0)
    Path({holder!r}).write_text(str(child))

def work():
    call("helpers.turning", ["turn", {pid!r}], 600, 4096)

if {held}:
    threading.Thread(target=hold_the_pipe, daemon=True).start()
if {main}:
    work()
else:
    threading.Thread(target=work).start()
"""


@linux
@pytest.mark.parametrize(
    ("main", "held"),
    [(True, False), (False, False), (True, True)],
    ids=["main thread", "pipe alone", "PR_SET_PDEATHSIG alone"],
)
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM], ids=["SIGKILL", "SIGTERM"])
def test_a_worker_inside_a_compiled_call_ends_with_its_parent(tmp_path, main, held, number):
    pid, holder = tmp_path / "pid", tmp_path / "holder"
    tests = next(p for p in sys.path if p.endswith("tests"))
    code = PARENT.format(tests=tests, pid=str(pid), holder=str(holder), main=main, held=held)
    parent = subprocess.Popen([sys.executable, "-W", "ignore", "-c", code])
    try:
        wait_until(lambda: pid.exists() and pid.read_text(), "the worker starts")
        if held:
            wait_until(lambda: holder.exists() and holder.read_text(), "the pipe is held")
        worker = int(pid.read_text())
        assert not is_gone(worker)
        parent.send_signal(number)
        parent.wait()
        wait_until(lambda: is_gone(worker), "the worker ends with its parent")
    finally:
        parent.kill()
        if holder.exists():
            os.kill(int(holder.read_text()), signal.SIGKILL)


@linux
def test_where_no_signal_comes_a_thread_ends_the_worker():
    code = (
        "import os, sys, time\nfrom semispline.solver import workers\nsys.platform = 'darwin'\n"
        "workers._end_with_parent(0, lambda: os.read(0, 1), True)\ntime.sleep(600)"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE)
    process.stdin.close()
    assert process.wait(60) == 0


@linux
def test_interrupted_a_call_leaves_no_worker(tmp_path):
    pid = tmp_path / "pid"
    # A shell that starts the tests in the background has them ignore it.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def interrupt():
        wait_until(lambda: pid.exists() and pid.read_text(), "the worker starts")
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            ask("turn", pid)
    finally:
        signal.signal(signal.SIGINT, before)
    thread.join()
    assert is_gone(int(pid.read_text()))


def test_a_pool_gives_each_result_with_its_number():
    found = dict(in_pool([partial(pow, 2, k) for k in range(5)], 2, **GENEROUS))
    assert found == {k: 2**k for k in range(5)}
    assert list(in_pool([], 2, **GENEROUS)) == []


@linux
@pytest.mark.parametrize(
    ("what", "limits", "end"),
    [("turn", {"seconds": 1}, End.TIME), ("kill", {}, End.KILLED), ("segmentation fault", {}, End.CRASH)],
)
def test_a_pool_says_how_its_worker_ended(what, limits, end):
    # While the first process sleeps the second one works: whose end it was is not guessed.
    tasks = [partial(time.sleep, 0.5), partial(work, what)]
    with pytest.raises(WorkerError) as caught:
        list(in_pool(tasks, 2, **GENEROUS | limits))
    assert caught.value.end is end


@linux
def test_a_pool_has_a_limit_of_memory():
    with pytest.raises(MemoryError):
        list(in_pool([partial(work, "fill")], 2, 600, 300))


@linux
def test_a_pool_that_is_closed_ends_what_still_works():
    results = in_pool([partial(pow, 2, 3), hold_the_lock], 2, **GENEROUS)
    assert next(results) == (0, 8)
    workers = [child.pid for child in multiprocessing.active_children()]
    assert workers
    results.close()
    assert all(map(is_gone, workers))
