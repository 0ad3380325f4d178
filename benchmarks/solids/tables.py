"""docs/solids.md from the rows of replaced fillets."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

Row = dict[str, Any]

# What an error holds -> what it is called here; the first that fits.
REASONS = (
    ("is not sound", "the gate stopped it: {}"),
    ("degree", "{}"),
)
ASKED = 0.6
_NAMES = ("file", "fillets", "replaced", "alone", "in chains", "ends kept", "kept over", "crease", "tolerance", "was")
_NAMES += ("gap", "volume", "angle", "curvature")
_COLUMNS = f"| {' | '.join(_NAMES)} |\n| --- |{' ---: |' * (len(_NAMES) - 1)}"

_HEAD = f"""\
# Solids

Made by `make solids`; do not edit. How many fillets of real files `semispline blend FILE --replace FACE` replaces by a
blend with G2 contact, one valid solid (or shell) back, with nothing chosen. Every fillet that `--pairs` proposes is
tried, with the command that `--pairs` prints for it: with those into which it goes on (`--replace 12,13`), and with its
old end edges kept where it goes on into what is no fillet, a corner say (`--keep-ends`).

- *replaced*: the gate passed what was made and what was written and read again; *alone*: by itself; *in chains*:
  together with others
- *ends kept*: replaced fillets of which an old end edge was kept, alone or at the end of a chain: contact is G2, and
  falls to G1 at that corner; *kept over*: within which length of the edge, the largest, never longer than the edge
  itself; *crease*: the largest angle between the blend and the face beyond such an edge, in degrees
- *tolerance*, *was*, *gap*: the largest of the new edges, of the old ones there, and between faces, in the file's unit
- *volume*: the largest change, over what the gate allows (a quarter of the old face's area times its width)
- *angle* (degrees) and *curvature* (relative): the worst contact on the true faces of those with no end kept; where one
  is kept curvature jumps there by all of it, and is what it is elsewhere

{_COLUMNS}"""


def document(rows: Sequence[Row], ours: Sequence[str]) -> str:
    """Return docs/solids.md; `ours` are the files that count."""
    others = list(dict.fromkeys(row["file"] for row in rows if row["file"] not in ours))
    counted = [row for row in rows if row["file"] in ours]
    parts = [_HEAD, *_table(counted, ours), "", *_answer(counted), ""]
    if others:
        parts += ["Files of packages:", "", _COLUMNS, *_table([x for x in rows if x["file"] in others], others), ""]
    parts += ["## Why the rest was refused, file by file", ""]
    for name in (*ours, *others):
        parts += _reasons(name, [row for row in rows if row["file"] == name])
    if not any("error" in row for row in rows):
        parts.append("None was.")
    return "\n".join(parts).rstrip() + "\n"


def _table(rows: Sequence[Row], names: Sequence[str]) -> Iterator[str]:
    groups = [(name, [row for row in rows if row["file"] == name]) for name in names]
    for name, found in (*groups, ("sum", list(rows))):
        yield f"| {' | '.join(_cells(name, found))} |"


def _cells(name: str, rows: Sequence[Row]) -> list[str]:
    total = _fillets(rows)
    if not total:
        return [name, "0", *[""] * (len(_NAMES) - 2)]
    done = [row for row in rows if "error" not in row]
    kept, moved = [row for row in done if row["kept"]], [row for row in done if not row["kept"]]
    chained = [row for row in done if len(row["faces"]) > 1]
    return [
        name,
        f"{total}",
        f"{_fillets(done)} ({100 * _fillets(done) / total:.0f} %)",
        f"{_fillets(done) - _fillets(chained)}",
        f"{_fillets(chained)}",
        f"{_fillets(kept)}",
        _largest(kept, "length_kept", ".3g"),
        _largest(kept, "crease", ".1g"),
        *(_largest(done, key, ".0e") for key in ("tolerance", "was", "gap")),
        _largest(done, "share", ".2f"),
        *(_largest(moved, key, ".0e") for key in ("angle", "curvature")),
    ]


def _fillets(rows: Sequence[Row]) -> int:
    return sum(len(row["faces"]) for row in rows)


def _largest(rows: Sequence[Row], key: str, form: str) -> str:
    return f"{max(row[key] for row in rows):{form}}" if rows else ""


def _answer(rows: Sequence[Row]) -> Iterator[str]:
    done = [row for row in rows if "error" not in row]
    kept = [row for row in done if row["kept"]]
    share = _fillets(done) / max(_fillets(rows), 1)
    verdict = "yes" if share >= ASKED else "no"
    yield (
        f"- {_fillets(done)} of {_fillets(rows)} are replaced: {100 * share:.0f} %, asked {100 * ASKED:.0f} %: "
        f"{verdict}; {_fillets(kept)} of them with an old end edge kept"
    )


def _reasons(name: str, rows: Sequence[Row]) -> Iterator[str]:
    errors = Counter(_short(row["error"]) for row in rows if "error" in row for _ in row["faces"])
    if not errors:
        return
    yield f"- {name}"
    for reason, count in errors.most_common():
        yield f"  - {count}: {reason}"


def _short(text: str) -> str:
    """Return a reason without what differs from place to place."""
    _, _, said = text.partition(": ")
    return said.partition("; ")[0][:160]
