"""The command: `python -m mutants [PATH ...] [--workers N] [--report]`."""

from __future__ import annotations

import argparse
from collections import defaultdict, deque
from pathlib import Path

from mutants.choice import Table, chosen_for, digest_of_test, measure
from mutants.records import Record, basis, read_accepted, read_records, report, still_to_show, write_record
from mutants.running import Job, Outcome, Slot, load_libraries, make_slots, run_all
from mutants.sites import Mutant, mutants_of

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build/mutants"
ROOMS = ("solver/judge", "solver/blending", "solver/proof")
SAMPLE = 400
# Processor time of the tests that one mutant is shown.
BOUND = 15.0
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


def decide(
    root: Path, mutants: list[Mutant], chosen: dict[str, list[str]], table: Table, slots: list[Slot], results: Path
) -> None:
    """Run the tests of each mutant whose verdict is not known: a few promising ones first, then all."""
    records = read_records(results)
    killers: dict[tuple[str, str], list[str]] = defaultdict(list)
    for m in mutants:
        if (known := records.get(m.key)) and "::" in known.by:
            killers[m.file, m.function].append(known.by)
    to_show = {m.key: still_to_show(root, m, records.get(m.key), chosen[m.key]) for m in mutants}
    waiting = iter([m for m in mutants if to_show[m.key] is not None])
    queue: deque[Job] = deque()

    def job(mutant: Mutant, tests: list[str], already: float) -> Job:
        limit = _MORE + _TIMES * sum(table.seconds[t] for t in tests)
        source = (root / mutant.file).read_bytes()
        return Job(tests, None, limit, (mutant, tests, already), (mutant.file, mutant.apply(source)))

    def next_one() -> None:
        for mutant in waiting:
            tests = to_show[mutant.key]
            if tests:
                queue.append(job(mutant, _first(tests, killers[mutant.file, mutant.function]), 0.0))
                return
            keep(mutant, "survived", "", 0.0)

    def keep(mutant: Mutant, verdict: str, by: str, seconds: float) -> None:
        tests = chosen[mutant.key]
        shown = tuple(digest_of_test(root, t) for t in tests) if verdict == "survived" else ()
        write_record(results, mutant, Record(verdict, by, len(tests), seconds, basis(root, mutant, by), shown))
        print(f"{verdict:9} {seconds:5.1f} s  {mutant.file}:{mutant.line}  {mutant.change}", flush=True)

    for _ in slots:
        next_one()
    for done, outcome in run_all(queue, slots):
        mutant, tests, already = done.subject
        seconds = already + outcome.seconds
        left = [t for t in to_show[mutant.key] or () if t not in tests] if not already else []
        if outcome.status == "passed" and left:
            queue.appendleft(job(mutant, left, seconds))
            continue
        verdict = {"passed": "survived", "failed": "killed", "timeout": "timeout", "stuck": "undecided"}[outcome.status]
        by = _killer(outcome, tests) if verdict in {"killed", "timeout"} else ""
        if "::" in by:
            killers[mutant.file, mutant.function].append(by)
        keep(mutant, verdict, by, seconds)
        next_one()


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
    results = FOLDER / "results.jsonl"
    if not words.report:
        load_libraries()
        slots = make_slots(ROOT, FOLDER, words.workers)
        table = measure(ROOT, FOLDER / "coverage", slots)
        for test in table.failed:
            print(f"left out, fails without any mutant: {test}")
        chosen = {m.key: chosen_for(m, table, ROOT, BOUND) for m in wanted}
        decide(ROOT, wanted, chosen, table, slots, results)
    return report(wanted, left_out, read_records(results), read_accepted(Path(__file__).parent / "accepted.toml"))


if __name__ == "__main__":
    raise SystemExit(main())
