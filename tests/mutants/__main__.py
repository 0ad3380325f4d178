"""The command: `python -m mutants [PATH ...] [--workers N] [--report]`."""

from __future__ import annotations

import argparse
from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from mutants.choice import QUICK, Table, chosen_for, digest_of_test, measure
from mutants.in_memory import Host, run_in_memory
from mutants.records import (
    KILLED,
    Record,
    basis,
    is_to_confirm,
    read_accepted,
    read_records,
    reason,
    report,
    still_to_show,
    write_record,
)
from mutants.running import Job, Outcome, Slot, load_libraries, make_slots, run_all
from mutants.sites import Mutant, mutants_of

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build/mutants"
ROOMS = ("solver/judge", "solver/blending", "solver/proof")
SAMPLE = 400
# Processor time of the tests that one mutant is shown: in a process of its own, in memory, and in memory where a reason
# to survive is written down.
BOUND, BOUND_IN_MEMORY, BOUND_EXPLAINED = 15.0, 4.0, 1.5
# Who takes five times as long as usual, and ten seconds more for imports, never ends.
_TIMES, _MORE = 5.0, 10.0
_FIRST = 8


def all_mutants(root: Path, rooms: tuple[str, ...], sample: int) -> tuple[list[Mutant], list[Mutant]]:
    """Return the complete class with the sample of the rest, and what is left out."""
    found = []
    for path in sorted(p for room in rooms for p in (root / room).rglob("*.py")):
        found += mutants_of(path.relative_to(root).as_posix(), path.read_bytes())
    rest = sorted((m for m in found if not m.complete), key=lambda m: m.key)
    return [m for m in found if m.complete] + sorted(rest[:sample], key=lambda m: (m.file, m.start)), rest[sample:]


Run = Callable[[deque[Job]], Iterator[tuple[Job, Outcome]]]


@dataclass(frozen=True)
class Way:
    """A way of running jobs, how many at a time, and what is said of a mutant that all tests pass."""

    run: Run
    count: int
    passed: str


def decide(
    root: Path,
    to_show: dict[Mutant, list[str]],
    chosen: dict[str, list[str]],
    table: Table,
    way: Way,
    results: Path,
) -> None:
    """Show each mutant its tests: a few promising ones first, then all."""
    killers: dict[tuple[str, str], list[str]] = defaultdict(list)
    records = read_records(results)
    for m in to_show:
        if (known := records.get(m.key)) and "::" in known.by:
            killers[m.file, m.function].append(known.by)
    waiting = iter(to_show)
    queue: deque[Job] = deque()

    def job(mutant: Mutant, tests: list[str], already: float) -> Job:
        limit = _MORE + _TIMES * sum(table.seconds[t] for t in tests)
        source = (root / mutant.file).read_bytes()
        return Job(tests, None, limit, (mutant, tests, already), (mutant.file, mutant.apply(source)))

    def next_one() -> None:
        for mutant in waiting:
            tests = to_show[mutant]
            if tests:
                queue.append(job(mutant, _first(tests, killers[mutant.file, mutant.function]), 0.0))
                return
            keep(mutant, way.passed, "", 0.0)

    def keep(mutant: Mutant, verdict: str, by: str, seconds: float) -> None:
        tests = chosen[mutant.key]
        shown = tuple(digest_of_test(root, t) for t in tests) if verdict == way.passed else ()
        write_record(results, mutant, Record(verdict, by, len(tests), seconds, basis(root, mutant, by), shown))
        print(f"{verdict:9} {seconds:5.1f} s  {mutant.file}:{mutant.line}  {mutant.change}", flush=True)

    for _ in range(way.count):
        next_one()
    for done, outcome in way.run(queue):
        mutant, tests, already = done.subject
        seconds = already + outcome.seconds
        left = [t for t in to_show[mutant] if t not in tests] if not already else []
        if outcome.status == "passed" and left:
            queue.appendleft(job(mutant, left, seconds))
            continue
        words = {"passed": way.passed, "failed": "killed", "stuck": "undecided"}
        verdict = words.get(outcome.status, outcome.status)
        by = _killer(outcome, tests) if verdict in KILLED else ""
        if "::" in by:
            killers[mutant.file, mutant.function].append(by)
        keep(mutant, verdict, by, seconds)
        next_one()


def decide_all(root: Path, wanted: list[Mutant], accepted: Path, slots: list[Slot]) -> None:
    """Run in memory what is not known, and in a process of its own who is alive after that and not explained."""
    folder = slots[0].folder.parent
    results = folder / "results.jsonl"
    table = measure(root, folder / "coverage", slots)
    for test in table.failed:
        print(f"left out, fails without any mutant: {test}")
    explained = _explained(accepted, wanted)
    bounds = {m: BOUND_EXPLAINED if m.key in explained else BOUND_IN_MEMORY for m in wanted}
    chosen = {m.key: chosen_for(m, table, root, bounds[m]) for m in wanted}
    records = read_records(results)
    to_show = {m: still_to_show(root, m, records.get(m.key), chosen[m.key]) for m in wanted}
    # Who is not known at all comes before who passed other tests already.
    in_order = sorted(wanted, key=lambda m: m.key in records)
    if open_ones := {m: tests for m in in_order if (tests := to_show[m]) is not None}:
        files = sorted({test.partition("::")[0] for tests in open_ones.values() for test in tests})
        hosts = [Host(slot, files, ["-m", QUICK]) for slot in slots]
        way = Way(partial(run_in_memory, hosts=hosts), len(hosts), "alive")
        decide(root, open_ones, chosen, table, way, results)
        for host in hosts:
            host.end()
    # Meanwhile reasons may have been written down.
    records, explained = read_records(results), _explained(accepted, wanted)
    alive = [m for m in wanted if is_to_confirm(records.get(m.key), explained=m.key in explained)]
    chosen |= {m.key: chosen_for(m, table, root, BOUND) for m in alive}
    way = Way(partial(run_all, slots=slots), len(slots), "survived")
    decide(root, {m: chosen[m.key] for m in alive}, chosen, table, way, results)


def _explained(accepted: Path, mutants: list[Mutant]) -> set[str]:
    entries = read_accepted(accepted)
    return {m.key for m in mutants if reason(entries, m)}


def _first(tests: list[str], killers: list[str]) -> list[str]:
    """Return what killed other mutants of the function, latest first, and the head of the list."""
    known = [t for t in dict.fromkeys(reversed(killers)) if t in tests][:4]
    return list(dict.fromkeys([*known, *tests[: _FIRST - len(known)]]))


def _killer(outcome: Outcome, tests: list[str]) -> str:
    # Without a name: the import failed, or the time ran out; which of the tests it was is not known.
    return outcome.failed or (tests[0] if len(tests) == 1 else "unknown")


def main() -> int:
    """Run or report; return the exit status."""
    parser = argparse.ArgumentParser(prog="mutants", description=__doc__)
    parser.add_argument("paths", nargs="*", default=ROOMS, help="files or folders; default: " + ", ".join(ROOMS))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--report", action="store_true", help="show what is known, run nothing")
    words = parser.parse_args()
    taken, left_out = all_mutants(ROOT, ROOMS, SAMPLE)
    wanted = [m for m in taken if any(Path(m.file).is_relative_to(p) for p in words.paths)]
    accepted = Path(__file__).parent / "accepted.toml"
    if not words.report:
        load_libraries()
        decide_all(ROOT, wanted, accepted, make_slots(ROOT, FOLDER, words.workers))
    return report(wanted, left_out, read_records(FOLDER / "results.jsonl"), read_accepted(accepted))


if __name__ == "__main__":
    raise SystemExit(main())
