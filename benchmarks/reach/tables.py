"""docs/reach.md from the rows of places."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

Row = dict[str, Any]

# What an error or a warning holds -> what it is called here; the first that fits.
ERRORS = (
    ("no proper normal", "a base has no normal at an end of its edge, as in a pole"),
    ("no normal at", "a base has no normal at an end of its edge, as in a pole"),
    ("gap is", "gap to the face"),
    ("parts", "the edges are cut into parts that do not correspond"),
    ("BandError", "no band meets the limits"),
)
WARNINGS = (
    ("U-turn that has to loop", "U-turn that has to loop: exits to opposite sides"),
    ("is a U-turn", "U-turn with a sharp tip"),
    ("the blend folds", "folds"),
    ("turns steeply", "turns steeply"),
    ("loops or waves", "loops or waves"),
    ("pinched between its rims", "pinched between its rims"),
    ("pinched", "pinched to nothing"),
    ("no proper normal", "a base has no normal at a place of its edge"),
    ("creased", "creased"),
    ("G1 inside", "G1 inside"),
    ("bound", "shape parameter at its bound"),
    ("p2 of side", "p2 at its end"),
    ("fairest shape was not reached", "the fairest shape was not reached"),
    ("fairness that was minimised", "fairness cannot be told"),
    ("rounding", "rounding"),
)
ASKED = {"without an error": 0.75, "without a warning": 0.55, "proposed": 0.95}


def document(rows: Sequence[Row], ours: Sequence[str]) -> str:
    """Return docs/reach.md; `ours` are the files that count."""
    others = list(dict.fromkeys(row["file"] for row in rows if row["file"] not in ours))
    parts = [_HEAD, *_table(rows, ours), "", *_answer([row for row in rows if row["file"] in ours]), ""]
    if others:
        parts += ["Files of packages:", "", _COLUMNS, *_table(rows, others), ""]
    parts += ["## Why the rest does not, file by file", "", "Of several warnings the gravest.", ""]
    for name in (*ours, *others):
        parts += _reasons(name, [row for row in rows if row["file"] == name])
    return "\n".join(parts)


def _table(rows: Sequence[Row], names: Sequence[str]) -> Iterator[str]:
    groups = [(name, [row for row in rows if row["file"] == name]) for name in names]
    for name, found in (*groups, ("sum", [row for _, group in groups for row in group])):
        yield f"| {' | '.join(_cells(name, found))} |"


def _cells(name: str, rows: Sequence[Row]) -> list[str]:
    if not rows:
        return [name, "0", *[""] * (len(_NAMES) - 2)]
    blends, clean = [row for row in rows if "error" not in row], [row for row in rows if is_clean(row)]
    proposed = [row for row in rows if row["fillet"]]
    turns = sorted(row["turn_of_blend"] for row in blends)
    counts = [sum(row[key] for row in rows) for key in ("half_hole", "hull")]
    bands = sum("free" in row.get("bases", ()) for row in rows)
    fillets = f"{sum(map(is_clean, proposed))} of {len(proposed)}" if proposed else ""
    return [
        name,
        f"{len(rows)}",
        *(f"{count}" for count in (*counts, bands)),
        *(f"{len(found)} ({100 * len(found) / len(rows):.0f} %)" for found in (blends, clean)),
        fillets,
        f"{sum(row['folds'] for row in blends)}",
        f"{turns[len(turns) // 2]:.0f}, {turns[-1]:.0f}" if turns else "",
        *_contacts(clean),
    ]


def is_clean(row: Row) -> bool:
    """Tell whether a place was blended without a warning."""
    return "error" not in row and not row["warnings"]


def _contacts(rows: Sequence[Row]) -> list[str]:
    """Return the worst gap, in parts of the length, angle and jump of curvature on the true faces."""
    contacts = [contact for row in rows for contact in row["contacts"]]
    if not contacts:
        return ["", "", ""]
    gap = max(contact["gap"] for contact in contacts)
    angle, curvature = (max(x[key] for x in contacts) for key in ("angle_degrees", "curvature"))
    return [f"{gap:.0e}", f"{angle:.0e}", f"{curvature:.0e}"]


def _answer(rows: Sequence[Row]) -> Iterator[str]:
    blends, clean = [row for row in rows if "error" not in row], [row for row in rows if is_clean(row)]
    proposed = [row for row in rows if row["fillet"]]
    for words, found, all_of, asked in (
        ("blend without an error", blends, rows, ASKED["without an error"]),
        ("blend without a warning", clean, rows, ASKED["without a warning"]),
        ("of those that `--pairs` proposes as fillets blend without a warning", [x for x in proposed if is_clean(x)],
         proposed, ASKED["proposed"]),
    ):  # fmt: skip
        share = len(found) / len(all_of)
        verdict = "yes" if share >= asked else "no"
        yield f"- {len(found)} of {len(all_of)} {words}: {100 * share:.0f} %, asked {100 * asked:.0f} %: {verdict}"


def _reasons(name: str, rows: Sequence[Row]) -> Iterator[str]:
    errors = Counter(_short(row["error"], ERRORS) for row in rows if "error" in row)
    warnings = Counter(_of_warnings(row) for row in rows if row.get("warnings"))
    if not errors and not warnings:
        return
    yield f"- {name}"
    for title, counts in (("error", errors), ("warning", warnings)):
        for reason, count in counts.most_common():
            yield f"  - {title}, {count}: {reason}"


def _of_warnings(row: Row) -> str:
    """Return the gravest of what is said of a place."""
    order = [short for _, short in WARNINGS]
    found = {_short(warning, WARNINGS) for warning in row["warnings"]}
    return min(found, key=lambda x: (order.index(x) if x in order else len(order), x))


def _short(text: str, known: Sequence[tuple[str, str]]) -> str:
    return next((short for needle, short in known if needle in text), text.partition("; ")[0][:100])


_NAMES = ("file", "places", "half holes", "hull", "free", "no error", "no warning", "fillets", "folds", "turn")
_NAMES += ("gap", "angle", "curvature")
_COLUMNS = f"| {' | '.join(_NAMES)} |\n| --- |{' ---: |' * (len(_NAMES) - 1)}"

_HEAD = f"""\
# Reach

Made by `make reach`; do not edit. How many places of real files `semispline blend FILE --replace FACE` blends, with
nothing chosen. A *place* is a face that is no plane, with one wire of four edges, and a pair of opposite ones beyond
which lie two other faces; a face may be two places, and none is left out for being hard.

- *half holes*: places whose face turns by more than 150 degrees along its contacts, as the wall of half a hole or of a
  pin between parallel planes: the two sides look straight at each other
- *hull*: places whose face goes on in both faces beyond without a jump of curvature: patches of one smooth hull, and
  pieces of a chain of fillets from end to end
- *free*: at least one contact is a free curve, and is met through a band
- *no error*, *no warning*: blended; blended and nothing to be looked at
- *fillets*: of the places that `--pairs` proposes as fillets those without a warning
- *folds*: blends whose normal turns by more than 90 degrees within a fiftieth of their length; *turn*: median and
  largest of that angle, in degrees
- *gap* (in parts of the length), *angle* (degrees), *curvature* (relative): the worst contact of the blends without a
  warning, measured on the true faces

{_COLUMNS}"""
