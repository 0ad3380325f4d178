"""docs/shapes.md: how the families are spread, what both sets come to, which rows make the fairest blend."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, get_args

import numpy as np
from candidates import CANDIDATES, PAIR, Compared

from semispline.papers.reproduction.families.problems import Family
from semispline.papers.reproduction.shape_measures import ENERGY_SET, FAIR_SET, Refused, Shape
from semispline.papers.reproduction.shape_suite import INVISIBLE, STEEP, Row, quotients, summary, wants

FAMILIES: tuple[Family, ...] = get_args(Family)
_HEAD = """\
# Shapes

Made by `make shapes`; do not edit. Every pair of the families in `papers/reproduction/families/` is blended twice, with
G2 on both sides, and what comes out is measured by `solver/judge/` alone:

- the *fair* set, what a user gets: {fair}
- the *energy* set, the paper's choice (cubic, one middle curve, its scale of v): {energy}

What is counted:

- *turn*: the largest angle between the normals at two points of a section that lie 1/50 of the mean length of the
  blend's sections apart; a *fold* turns by more than 90 degrees, and is *silent* where no warning says so
- *at bound*: alpha² or beta² ends at the end of its range; for fairness the window about an arc's, for energy 1/8 to 8
  of the natural size
- *loop*: a section turns by more than 60 degrees more than the biarc between its exits
- *waist*: least distance of opposite points over that of the straight rulings; closed rims only
- *A · GH*: area times the integral of |grad H|², and the jumps of H; below {invisible:g} it is what the eye takes for
  flat or for a cylinder, and counts as {invisible:g}
- *time*: processor time of one thread for the whole of `blend`, all its checks included but the search for meetings
  on a mesh, which runs only where it is asked for
- *mesh search*: in how many pairs no direction shows that the fair blend meets nothing, so that a mesh was searched
  here; its time over that of the blend
"""
# Time over that of energy, at most, as asked.
_MOST_TIME = 4
_COUNTS = {
    "refused": "refused",
    "at_bound": "at bound",
    "turns_30": "turn > 30",
    "turns_60": "turn > 60",
    "folds": "folds",
    "silent_folds": "silent",
    "loops": "loops",
    "meets": "meets itself or a base",
    "warned": "warned",
}


def document(rows: Sequence[Row], compared: Compared) -> str:
    """Return docs/shapes.md."""
    head = _HEAD.format(fair=_options(FAIR_SET), energy=_options(ENERGY_SET), invisible=INVISIBLE)
    parts = [head, "## The families\n", _spread(rows), "## What comes out\n", _outcomes(rows), _ratios(rows)]
    parts += ["## What least energy wants\n", _wants(rows), "## Refused, and worst\n", _refusals(rows)]
    parts += [_listed(rows), "## Degree and middle curves\n", _candidates(compared)]
    return "\n".join(parts)


def worst(rows: Sequence[Row]) -> list[str]:
    """Return a line for each problem whose fair blend turns by more than 30 degrees, ends at a bound, or loses."""
    lines = []
    for row in rows:
        found = _faults(row)
        if found:
            exits = " and ".join(f"{x:.0f}" for x in row.measures.exit_degrees)
            lines.append(f"{row.name} ({row.kind}; gap {row.measures.gap:.2f}, exits {exits}): {'; '.join(found)}")
    return lines


def _faults(row: Row) -> list[str]:
    if isinstance(row.fair, Refused):
        return ["refused"]
    found = []
    if row.fair.turn_degrees > 30:
        silent = ", silent" if row.fair.is_silent_fold else ""
        found.append(f"turns by {row.fair.turn_degrees:.0f} degrees{silent}")
    if row.fair.at_bound:
        found.append(" and ".join(row.fair.at_bound))
    if row.quotient is not None and row.quotient > 1:
        found.append(f"A · GH {row.quotient:.2f} times that of energy")
    if row.fair.waist is not None and row.fair.waist < 0.5:
        found.append(f"waist {row.fair.waist:.2f}")
    if row.fair.loop_degrees > 60:
        found.append(f"loops by {row.fair.loop_degrees:.0f} degrees")
    if row.fair.meets:
        found.append(f"meets {' and '.join(row.fair.meets)}")
    return found


def _options(options: Mapping[str, Any]) -> str:
    return f"`blend({', '.join(['a', 'b', *(f'{name}={value!r}' for name, value in options.items())])})`"


def _of(rows: Sequence[Row], family: Family) -> list[Row]:
    return [row for row in rows if row.family == family]


def _table(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    rule = ["---", *["---:"] * (len(head) - 1)]
    return "\n".join("| " + " | ".join(line) + " |" for line in (head, rule, *lines)) + "\n"


def _quantiles(values: Sequence[float]) -> str:
    return ", ".join(f"{x:.3g}" for x in np.quantile(values, [0, 0.1, 0.5, 0.9, 1]))


def _spread(rows: Sequence[Row]) -> str:
    lines = []
    for family in FAMILIES:
        of = _of(rows, family)
        if not of:
            continue
        measures = [row.measures for row in of]
        seeds = "files" if family == "real" else f"0 to {max(row.seed for row in of)}"
        lines.append(
            (
                family,
                str(len(of)),
                seeds,
                _quantiles([m.gap for m in measures]),
                _quantiles([x for m in measures for x in m.exit_degrees]),
                _quantiles([x for m in measures for x in m.speeds]),
                _quantiles([x for m in measures for x in m.domains]),
                _quantiles([x for m in measures for x in m.bends]),
                _quantiles([x for m in measures for x in m.edge_turn_degrees]),
            )
        )
    text = (
        "Least, 10 %, median, 90 %, largest. Gap: mean distance of corresponding points in mean contact lengths; "
        "exit: mean angle on each side between the way out and the straight way across; speed: across the contact, "
        "in contact lengths over the base's own parameter; domain: length of the parameter range along the contact; "
        "bend: largest curvature across the contact times the mean gap; turn along: of the normal in all, degrees.\n\n"
    )
    head = ("family", "pairs", "seeds", "gap", "exit, degrees", "speed", "domain", "bend", "turn along")
    kinds = {row.kind: 0 for row in _of(rows, "closed rims")}
    for row in _of(rows, "closed rims"):
        kinds[row.kind] += 1
    told = ", ".join(f"{kind} {number}" for kind, number in kinds.items())
    return text + _table(head, lines) + (f"\nClosed rims: {told}.\n" if told else "")


def _outcomes(rows: Sequence[Row]) -> str:
    lines = []
    for family in FAMILIES:
        of = _of(rows, family)
        for name, shapes in (("fair", [row.fair for row in of]), ("energy", [row.energy for row in of])):
            if any(isinstance(shape, Shape) for shape in shapes):
                found = summary(shapes)
                counts = [str(getattr(found, field)) for field in _COUNTS]
                narrow = "" if found.narrow is None else str(found.narrow)
                points = f"{found.stored:.0f} / {found.converted:.0f}"
                lines.append(
                    (f"{family}, {name}", str(found.problems), *counts, narrow, points, f"{found.milliseconds:.0f}")
                )
    head = ("", "pairs", *_COUNTS.values(), "waist < 0.5", "points stored / converted", "time, ms")
    return "Numbers of pairs; medians of points and time.\n\n" + _table(head, lines)


def _ratios(rows: Sequence[Row]) -> str:
    lines, slow = [], list[str]()
    for family in FAMILIES:
        of = [row for row in _of(rows, family) if row.quotient is not None]
        if not of:
            continue
        ratios = {
            f"{row.family}-{row.seed:03d}": row.fair.seconds / row.energy.seconds
            for row in of
            if isinstance(row.fair, Shape) and isinstance(row.energy, Shape)
        }
        times = list(ratios.values())
        slow += [f"{name} {ratio:.1f}" for name, ratio in ratios.items() if ratio > _MOST_TIME]
        searches = _searches(of)
        losing = sum((row.quotient or 0) > 1 for row in of)
        shown = [f"{x:.3g}" for x in quotients(of)]
        lines.append(
            (
                family,
                str(len(of)),
                shown[1],
                shown[0],
                shown[2],
                str(losing),
                f"{np.median(times):.2f}",
                f"{max(times):.2f}",
                str(len(searches)),
                *((f"{np.median(searches):.2f}", f"{max(searches):.2f}") if searches else ("–", "–")),
            )
        )
    head = ("fair over energy", "pairs", "A · GH, median", "10 %", "90 %", "above 1", "time, median", "time, most")
    table = _table((*head, "mesh searched in", "mesh search over blend, median", "mesh search, most"), lines)
    aims = f"Time is to be at most twice that of energy in the median and {_MOST_TIME} times anywhere"
    return f"{table}\n{aims}; above that: {', '.join(slow) or 'none'}.\n"


def _searches(rows: Sequence[Row]) -> list[float]:
    """Return the time of each search on a mesh over that of the fair blend; none where no mesh was searched."""
    return [
        row.fair.search_seconds / row.fair.seconds
        for row in rows
        if isinstance(row.fair, Shape) and row.fair.search_seconds is not None
    ]


def _wants(rows: Sequence[Row]) -> str:
    text = (
        "Energy (11), cubic, one middle curve, the paper's scale: its least point without any box, by the proved "
        "search over -1024 to 1024 natural sizes. Where alpha² or beta² is not positive the blend would leave its base "
        "backwards; below 1/8 of its natural size it has a crease at the seam. *Folds*: within 1/8 to 8, by turn.\n\n"
    )
    lines = []
    for family in FAMILIES:
        if of := _of(rows, family):
            found = wants(of)
            lines.append((family, *(str(x) for x in found.values())))
    return text + _table(("family", "told", *list(wants([]))[1:]), lines)


def _refusals(rows: Sequence[Row]) -> str:
    reasons: dict[tuple[str, str, str], list[str]] = {}
    for row in rows:
        for name, shape in (("fair", row.fair), ("energy", row.energy)):
            if isinstance(shape, Refused):
                reasons.setdefault((row.family, name, shape.reason), []).append(row.name)
    if not reasons:
        return "Nothing was refused.\n"
    lines = ((family, name, reason, ", ".join(names)) for (family, name, reason), names in reasons.items())
    return _table(("family", "set", "reason", "pairs"), lines)


def _listed(rows: Sequence[Row]) -> str:
    lines = "\n".join(f"- {line}" for line in worst(rows))
    return (
        "Fair blends that turn by more than 30 degrees, loop, meet something, end at a bound, or lose to energy:\n\n"
        + (lines or "none")
        + "\n"
    )


def _candidates(compared: Compared) -> str:
    text = (
        "alpha² constant unless said otherwise, by fairness with each; middle curves by thin plate with v scaled by "
        "length, on every fourth knot. In how many pairs it is the best of all; A · GH over that of the best (median, "
        "90 %, largest); how often refused, at a bound, and turning by more than 30 degrees; median of converted "
        "points. The last line takes the fairer of two.\n\n"
    )
    parts = []
    for family in FAMILIES:
        of = [one["shapes"] for one in compared if one["family"] == family]
        if not of:
            continue
        seen = [[_seen(shapes[name]) for shapes in of] for name in CANDIDATES]
        best = np.min(seen, axis=0)
        told = np.isfinite(best)
        lines = []
        columns = {name: [shapes[name] for shapes in of] for name in CANDIDATES}
        columns[f"fairer of {' and '.join(PAIR)}"] = [min((shapes[name] for name in PAIR), key=_seen) for shapes in of]
        for name, column in columns.items():
            found = [shape for shape in column if shape]
            over = np.array([_seen(shape) for shape in column])[told] / best[told]
            told_over = over[np.isfinite(over)]
            # Nothing of a family may have it, such as closed rims a linear alpha.
            if not len(told_over):
                lines.append((name, *["–"] * 4, str(len(of)), *["–"] * 3))
                continue
            shown = [f"{x:.3g}" for x in np.quantile(told_over, [0.5, 0.9, 1])]
            counts = len(of) - len(found), sum(x["at_bound"] for x in found), sum(x["turn"] > STEEP for x in found)
            points = float(np.median([shape["points"] for shape in found]))
            lines.append((name, str(int((over <= 1).sum())), *shown, *(str(x) for x in counts), f"{points:.0f}"))
        head = ("best in", "median", "90 %", "largest", "refused", "at bound", "turn > 30", "points")
        parts.append(_table((f"{family}, {len(of)} pairs", *head), lines))
    return text + "\n".join(parts)


def _seen(shape: dict[str, Any] | None) -> float:
    """Return the fairness that can be seen; infinite where there is no blend."""
    return np.inf if shape is None else max(shape["fairness"], INVISIBLE)
