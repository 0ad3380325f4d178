"""What is known of each mutant, which survivors are accepted, and the report."""

from __future__ import annotations

import json
import tomllib
from collections import Counter, defaultdict
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from mutants.choice import digest_of_test
from mutants.sites import Mutant

KILLED = {"killed", "timeout"}


@dataclass(frozen=True)
class Record:
    """A verdict and what it rests on.

    "killed", "timeout", "survived"; "alive" or "untouched" after a run in memory that a process of its own has not
    confirmed; "undecided".
    `rests_on` is a hash of the function (and of the test that killed); `shown` are those of the tests that passed.
    """

    verdict: str
    by: str
    tests: int
    seconds: float
    rests_on: str
    shown: tuple[str, ...] = ()


def read_records(path: Path) -> dict[str, Record]:
    """Return the last record of each key; a line that was cut off is left out."""
    found = {}
    for line in path.read_text().splitlines() if path.exists() else []:
        try:
            entry = json.loads(line)
        except json.JSONDecodeError:
            continue
        found[entry["key"]] = Record(**{name: entry[name] for name in Record.__annotations__ if name in entry})
    return found


def write_record(path: Path, mutant: Mutant, record: Record) -> None:
    """Add a line, with what a reader wants to see."""
    where = {name: getattr(mutant, name) for name in ("key", "file", "line", "function", "text", "change", "complete")}
    line = json.dumps(where | record.__dict__) + "\n"
    with path.open("a+b") as file:
        file.seek(max(file.seek(0, 2) - 1, 0))
        # A line that was cut off must not take the next one with it.
        file.write(b"\n" * (file.read(1) not in {b"", b"\n"}) + line.encode())


def basis(root: Path, mutant: Mutant, by: str) -> str:
    """Return the hash of what a verdict rests on: the broken function, and the test that killed."""
    test = digest_of_test(root, by) if by else ""
    return sha256(f"{mutant.around}\0{test}".encode()).hexdigest()[:16]


def is_to_confirm(record: Record | None, *, explained: bool) -> bool:
    """Say whether a process of its own decides: whom the quick way did not reach, and who is alive without a reason."""
    return record is not None and (record.verdict == "untouched" or (record.verdict == "alive" and not explained))


def still_to_show(root: Path, mutant: Mutant, record: Record | None, chosen: list[str]) -> list[str] | None:
    """Return the tests that a mutant has not passed yet, or None where its verdict holds."""
    if record is None or record.verdict == "undecided" or record.rests_on != basis(root, mutant, record.by):
        return chosen
    if record.verdict in {*KILLED, "untouched"}:
        return None
    return [test for test in chosen if digest_of_test(root, test) not in record.shown] or None


def reason(entries: list[dict[str, Any]], mutant: Mutant) -> dict[str, Any] | None:
    """Return the entry that explains a survivor; one without `change` explains all of its line."""
    for entry in entries:
        place = (entry["file"], entry["function"], entry["line"])
        changes = entry.get("change", mutant.change)
        if place == (mutant.file, mutant.function, mutant.text) and mutant.change in (
            changes if isinstance(changes, list) else [changes]
        ):
            return entry
    return None


def read_accepted(path: Path) -> list[dict[str, Any]]:
    """Return the entries of the file; each needs file, function, line and a reason."""
    entries: list[dict[str, Any]] = tomllib.loads(path.read_text()).get("accepted", []) if path.exists() else []
    for entry in entries:
        if missing := {"file", "function", "line", "reason"} - {k for k, v in entry.items() if v or k == "function"}:
            raise SystemExit(f"{path.name}: found {entry}, expected {', '.join(sorted(missing))} too")
    return entries


def report(
    mutants: list[Mutant], left_out: list[Mutant], records: dict[str, Record], accepted: list[dict[str, Any]]
) -> int:
    """Print what survived, and return the exit status; what is said of mutants that are left out is not stale."""
    used = [entry for mutant in left_out if (entry := reason(accepted, mutant))]
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    unexplained, undecided_files = 0, set()
    for mutant in mutants:
        record = records.get(mutant.key)
        verdict = record.verdict if record else "undecided"
        entry = reason(accepted, mutant) if verdict in {"survived", "alive"} else None
        if entry:
            used.append(entry)
            verdict = "accepted"
        elif record and verdict in {"survived", "alive"}:
            unexplained += verdict == "survived"
            shown = f"{mutant.function or 'module'}, {record.tests} tests" + ", to be confirmed" * (verdict == "alive")
            print(f"{mutant.file}:{mutant.line}: {mutant.change}   [{shown}]\n    {mutant.text}")
        if verdict in {"undecided", "alive", "untouched"}:
            undecided_files.add(mutant.file)
        counts["complete" if mutant.complete else "sample"][verdict] += 1
    stale = [e for e in accepted if e["file"] in {m.file for m in mutants} - undecided_files and e not in used]
    for entry in stale:
        print(f"accepted.toml: nothing of this survives any more: {entry['file']}, {entry['line']}")
    for kind, of_kind in counts.items():
        print(f"{kind}: {sum(of_kind.values())} mutants: " + ", ".join(f"{n} {v}" for v, n in sorted(of_kind.items())))
    if unexplained or stale:
        return 1
    return 3 if undecided_files else 0
