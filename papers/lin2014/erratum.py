"""Two pages for a reader of the paper, `erratum.md`, with numbers from the decided ledger and formulas set."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from semispline.papers.ledger import Ledger, LedgerError, Verdict
from semispline.papers.lin2014 import erratum_strip as strip
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.export import written_as_a_whole
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_3_1, TRUE_3_2
from semispline.papers.lin2014.notation import NOTATION
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.report import Erratum, latex

# What the text has a section for.
_TOLD = {
    *("second-derivative", "linear-system", "sign-of-p1", "indices-for-cubics", "knots-rule", "energy-for-quality"),
    "misprints",
}
_GREEK = re.compile(r"\b(alpha|beta)\b")


def erratum(ledger: Ledger, version: str) -> Erratum:
    """Return the text, and the picture that stands beside it.

    Raises
    ------
    LedgerError
        The ledger has a cause of which the text says nothing, or none of one that it tells.
    """
    causes = {cause.key for cause, _ in ledger.causes()}
    if causes != _TOLD:
        raise LedgerError(f"erratum.md: found causes {', '.join(sorted(causes))}, expected {', '.join(sorted(_TOLD))}")
    text = (Path(__file__).parent / "erratum.md").read_text(encoding="utf-8")
    values = {**_of_the_ledger(ledger), **_measures(ledger), **_of_the_strip(), "version": version}
    text = re.sub(r"<<(\w+)>>", lambda found: str(values[found[1]]), text)
    return Erratum(re.sub(r"\[\[(.+?)\]\]", lambda found: _set(found[1]), text), {"one-strip.svg": strip.picture()})


def _set(formula: str) -> str:
    written = _GREEK.sub(r"\\\1 ", formula).replace(">=", r"\geq ").replace("<", r"\lt ")
    return f"$`{written.strip()}`$"


def _of_the_ledger(ledger: Ledger) -> dict[str, Any]:
    counts = ledger.counts()
    others = sum(counts[verdict] for verdict in (Verdict.HOLDS_IF, Verdict.FAILS, Verdict.AMBIGUOUS))
    caused = sum(len(decisions) for _, decisions in ledger.causes())
    changed = [d.id for d in ledger.decisions if d.verdict is not d.recorded]
    return {
        "title": ledger.paper.title,
        "changed": f"\n**Not as recorded in this run: {', '.join(changed)}.**\n" if changed else "",
        "printed": counts["printed"],
        "decided": counts["decided"],
        "repeated": len(written_as_a_whole(ledger.paper)),
        "holds": counts[Verdict.HOLDS],
        "others": others,
        "caused": caused,
        "alone": others - caused,
        "consistent": counts["consistent"],
    }


def _of_the_strip() -> dict[str, Any]:
    def bicubic(relation: Any) -> str:
        return f"$`{latex(relation.subs({pr.k: CUBIC, pr.k_r: CUBIC, pr.k_s: CUBIC}), NOTATION)}`$"

    return {
        "printed_ratio": strip.curvature_ratio("printed"),
        "squared_ratio": strip.curvature_ratio("squared"),
        "right_3_1": bicubic(TRUE_3_1.relation),
        "right_3_2": bicubic(TRUE_3_2.relation),
    }


def _measured(ledger: Ledger, identifier: str) -> Mapping[str, float]:
    found = next(d for d in ledger.decisions if d.id == identifier).consequence
    if found is None:
        raise LedgerError(f"{identifier}: found no measured consequence, expected one")
    return found.measured


def _measures(ledger: Ledger) -> dict[str, Any]:
    jump = "relative curvature jump"
    anew = _measured(ledger, "sec-3.one-surface")
    third = _measured(ledger, "sec-4.third-term")
    few = _measured(ledger, "sec-3.fewer-better")
    none, one = (next(v for key, v in few.items() if f"C2, {m} middle curves" in key) for m in (0, 1))
    turn = _measured(ledger, "sec-A.17-gives-2.1")["turn of the normal across the contact [degrees]"]
    facing = _measured(ledger, "sec-4.facing")
    spared = _measured(ledger, "sec-A.special-choice")
    numbers, functions = ([x for name, x in spared.items() if ("functions" in name) is free] for free in (False, True))
    share = facing["share of exit angles below 90 degrees, 1 middle curves"]
    crease = facing["crease at alpha = 0 between plates at 74 and 37 degrees [degrees]"]
    gap = _measured(ledger, "fig-10.seam")["gap at the seam, 1 middle curves [radius of the first cylinder]"]
    return {
        "jump": f"{100 * _measured(ledger, 'cond-3.1')[jump]:.0f}",
        "half": f"{100 * anew[f'{jump}, the base in units half as long']:.0f}",
        "inserted": f"{100 * anew[f'{jump}, the base with one knot inserted']:.0f}",
        "third": f"{third['energy (11) with the printed third term']:.3g}",
        "least": f"{third['least energy']:.3g}",
        "turn": f"{turn:.0f}",
        "share": f"{100 * share:.0f}",
        "crease": f"{crease:.0f}",
        "spared": f"{max(numbers):.1g}",
        "spared_by_functions": f"{min(functions):.0f} to {max(functions):.0f}",
        "none": f"{none:.3g}",
        "one": f"{one:.3g}",
        "gap": f"{gap:.1g}",
        "table": "\n".join(_saving(_measured(ledger, "sec-1.after-conversion"))),
    }


def _saving(counts: Mapping[str, float]) -> list[str]:
    """Return the rows of the table of control points, one for all figures with the same counts."""
    figures: dict[str, list[str]] = {}
    for figure in ("5", "6", "8", "9", "10"):
        cells = [_range(counts, f"Fig. {figure}, {what}") for what in ("own knots", "knots of both", "converted")]
        figures.setdefault(" | ".join(cells), []).append(figure)
    return [f"| {', '.join(names)} | {cells} |" for cells, names in figures.items()]


def _range(counts: Mapping[str, float], beginning: str) -> str:
    """Return the least and the largest of some counts, by how the rule for the middle curve is read."""
    found = sorted({int(number) for name, number in counts.items() if name.startswith(beginning)})
    return str(found[0]) if len(found) == 1 else f"{found[0]} to {found[-1]}"
