"""What the runs on section 5 come to: sentences whose every number is computed from the measures of this run."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from semispline.papers.lin2014.exact_surfaces import exact_findings
from semispline.papers.reproduction import ROUNDING, Comparison, Comparisons, Finding, Measures, reached
from semispline.solver.splines import SemiStructuredSurface

AS_PRINTED, CORRECTED = "paper-as-printed", "paper-corrected"
LEAST, FAIR = "semistructured-reduced", "semistructured-fair"
# Second derivatives across a contact agree up to rounding: a fraction of the larger of both.
C2_LIMIT = 1e-9
# Energies count as the same within this fraction: a search by finite differences stops there.
SAME_ENERGY = 1e-6


def findings(comparisons: Comparisons) -> tuple[Finding, ...]:
    """Return what was found; a rival that cannot be used on any example is left out.

    Examples with exact surfaces, which few methods can take, have a finding of their own.
    """
    of_stand_ins = {name: found for name, found in comparisons.items() if not name.endswith("-exact")}
    makers: tuple[Callable[[Comparisons], Iterator[Finding]], ...] = (
        _corrected, _as_printed, _search, _same_knots, _tangent_only, _lower, _hartmann, _bloor_wilson, _tools,
        _fair, _real_pair,
    )  # fmt: skip
    found = [finding for make in makers for finding in make(of_stand_ins)]
    return (*found, *exact_findings(comparisons), *choice_of_alpha())


def choice_of_alpha() -> Iterator[Finding]:
    """Say what the choice of alpha by least energy comes to over the suite of shapes (docs/shapes.md)."""
    told = json.loads((Path(__file__).parent / "shapes.json").read_text(encoding="utf-8"))
    facing, turns, rims = (told[family] for family in ("facing", "u-turn", "closed rims"))
    wants, energy, fair = facing["wants"], facing["energy"], facing["fair"]
    median = facing["quotients"][1]
    count = wants["told"]
    yield Finding(
        f"Least energy is the wrong judge of alpha: of {count} random facing pairs {wants['not positive']} want "
        "alpha^2 <= 0",
        "There (11) is least where the blend would leave a base backwards. "
        f"{wants['below 1/8']} more want less than an eighth of the natural size, a crease at the seam; held within "
        f"1/8 to 8 of it, {energy['at_bound']} end at a bound, {energy['turns_30']} turn by more than 30 degrees "
        f"within a fiftieth of the length and {energy['folds']} fold. With the least area times integral of |grad H|^2 "
        f"instead "
        f"{fair['at_bound']} end at a bound, {fair['turns_30']} turn by more than 30 degrees and {fair['folds']} fold; "
        f"that measure is {median:.2g} times as large in the median. Of {turns['energy']['problems']} U-turns "
        f"{turns['energy']['folds']} fold with least energy, {turns['fair']['folds']} with the fairest shape; of "
        f"{rims['energy']['problems']} pairs of closed rims {rims['energy']['narrow']} are pinched to less than half "
        f"of the straight rulings, and {rims['fair']['narrow']}. Counted by the suite of shapes: docs/shapes.md.",
    )


def meets_demand(comparison: Comparison) -> bool:
    """Tell whether a result has the contact that its example asks for, up to rounding."""
    m = comparison.measures
    if m is None or reached(comparison.task, m) != "G2":
        return False
    residual = m.c2_residual
    return comparison.task.continuity == "G2" or (residual is not None and residual <= C2_LIMIT)


def by_method(comparisons: Comparisons, name: str) -> dict[str, tuple[Comparison, Measures]]:
    """Return what a method gave, by example; examples on which it cannot be used are missing."""
    return {
        example: (c, c.measures)
        for example, found in comparisons.items()
        for c in found
        if c.method.name == name and c.measures is not None
    }


def _corrected(comparisons: Comparisons) -> Iterator[Finding]:
    found = by_method(comparisons, CORRECTED)
    if not found:
        return
    good = [example for example, (c, _) in found.items() if meets_demand(c)]
    folded = [example for example, (_, m) in found.items() if m.folds]
    folds = f"It folds in {_names(folded)}." if folded else "None of these blends folds."
    yield Finding(
        f"With derived contact rows the method keeps its promise in {_of(good, found)} examples",
        "C2 or G2 contact, as each example asks, with both bases untouched: angles below 1e-9 degrees, curvature jumps "
        f"and C2 residuals below 1e-9 of the largest. {folds}",
    )


def _as_printed(comparisons: Comparisons) -> Iterator[Finding]:
    found, true = by_method(comparisons, AS_PRINTED), by_method(comparisons, CORRECTED)
    if not found:
        return
    missed = [example for example, (c, _) in found.items() if not meets_demand(c)]
    jump = {example: m.curvature_jump_relative for example, (_, m) in found.items()}
    worst = max(jump, key=lambda example: jump[example])
    straight = [e for e in found if jump[e] <= ROUNDING]
    ratio = {e: found[e][1].energy / true[e][1].energy for e in found if e in true}
    kept = f" The bases of {_names(straight)} are straight across the contact, where the error shows in C2 alone."
    yield Finding(
        f"Run as printed on our stand-ins, it misses the promised contact in {_of(missed, found)} examples",
        f"The printed third rows, (3.1) and (3.2), leave relative jumps of normal curvature up to {jump[worst]:.2g} "
        f"({_name(worst)}); the energy is {_range(ratio.values(), '.3g')} times that with derived rows."
        f"{kept if straight else ''}",
    )


def _search(comparisons: Comparisons) -> Iterator[Finding]:
    least, found = by_method(comparisons, LEAST), by_method(comparisons, "semistructured-bfgs")
    excess = {e: m.energy / least[e][1].energy - 1 for e, (_, m) in found.items() if e in least}
    if not excess:
        return
    good = [e for e, value in excess.items() if value <= SAME_ENERGY]
    more = [e for e in excess if e not in good]
    where = f"; in {_names(more)} it is up to {max(excess.values()):.1e} above it" if more else ""
    yield Finding(
        f"The paper's search, BFGS from the C2 blend, ends at the least energy in {_of(good, excess)} examples",
        f"It comes within 1e-6 of the minimum over all admissible alpha and beta, which method reduced proves{where}.",
    )


def _same_knots(comparisons: Comparisons) -> Iterator[Finding]:
    ours, theirs = by_method(comparisons, LEAST), by_method(comparisons, "same-knots-g2")
    both = [e for e in ours if e in theirs]
    if not both:
        return
    counts = {e: (_count(ours[e][0]), _count_converted(ours[e][0]), _count(theirs[e][0])) for e in both}
    saved = [100 * (1 - own / union) for own, _, union in counts.values()]
    added = [100 * (converted / union - 1) for _, converted, union in counts.values()]
    more = [ours[e][1].energy / theirs[e][1].energy - 1 for e in both]
    told = ", ".join(f"{_name(e)} {own}, {converted} and {union}" for e, (own, converted, union) in counts.items())
    yield Finding(
        f"Own knots for each row save {_range(saved, '.0f')} % of the control points; once converted a blend has "
        f"{_range(added, '.0f')} % more than direct insertion gives",
        "Against a tensor product over the union of knots, with the same G2 contact, number of rows and energy. A "
        "classical surface has the knots of all its rows, the averaged ones of the middle curve among them. Control "
        f"points as they are, converted, and over the union: {told}. The price: up to {100 * max(more):.2g} % more "
        "energy, since the space is smaller.",
    )


def _count_converted(comparison: Comparison) -> int:
    outcome = comparison.outcome
    if outcome is None or not isinstance(outcome.surface, SemiStructuredSurface):
        raise ValueError(f"{comparison.method.name}: no semi-structured surface on {comparison.task.name}")
    return outcome.surface.to_bspline().n_control_points


def _tangent_only(comparisons: Comparisons) -> Iterator[Finding]:
    found = by_method(comparisons, "same-knots-g1")
    if found:
        jump = [m.curvature_jump_relative for _, m in found.values()]
        ours = by_method(comparisons, LEAST)
        saved = [1 - m.energy / ours[e][1].energy for e, (_, m) in found.items() if e in ours]
        yield Finding(
            f"Tangent contact over equal knots (standing for [13]) leaves curvature jumps of {_range(jump, '.2g')}",
            f"As the paper says. What it gets for that: {_range((100 * s for s in saved), '.0f')} % less energy.",
        )


def _lower(comparisons: Comparisons) -> Iterator[Finding]:
    """Tell which exact G2 rivals have less energy, with how many control points; our own solver is left out."""
    ours = by_method(comparisons, LEAST)
    wins, details = [], []
    for name in dict.fromkeys(c.method.name for found in comparisons.values() for c in found):
        found = {e: (c, m) for e, (c, m) in by_method(comparisons, name).items() if e in ours}
        if name.startswith(("paper-", "semistructured-", "same-knots-")) or not found:
            continue
        better = [
            e
            for e, (c, m) in found.items()
            if reached(c.task, m) == "G2" and not m.folds and m.energy < ours[e][1].energy * (1 - SAME_ENERGY)
        ]
        if better:
            title = found[better[0]][0].method.title
            change = _range((100 * (1 - found[e][1].energy / ours[e][1].energy) for e in better), ".2g")
            size = [_count(found[e][0]) / _count(ours[e][0]) for e in better if _has_points(found[e][0])]
            points = f"{_range(size, '.2g')} times the control points" if size else "no spline"
            wins.append(title)
            details.append(f"{title}: {change} % less in {_names(better)} ({_of(better, found)}), {points}.")
    if wins:
        yield Finding(f"{len(wins)} rivals have exact G2, no fold and less energy somewhere", " ".join(details))


def _hartmann(comparisons: Comparisons) -> Iterator[Finding]:
    inside, fair = by_method(comparisons, "hartmann-inside"), by_method(comparisons, "hartmann-extended")
    ours = by_method(comparisons, LEAST)
    if not inside or not fair:
        return
    back = [e for e, (_, m) in inside.items() if m.folds]
    good = [e for e, (c, m) in fair.items() if reached(c.task, m) == "G2" and not m.folds]
    ratio = [m.energy / ours[e][1].energy for e, (_, m) in fair.items() if e in ours]
    yield Finding(
        f"Hartmann's blend [17] folds in {_of(back, inside)} examples only because its pieces lie inside the bases",
        f"With the bases continued past their contacts it is G2 without a fold in {_of(good, fair)} examples, at "
        f"{_range(ratio, '.3g')} times our energy, and no spline. Fig. 7 shows the variant whose pieces "
        "lie inside the bases.",
    )


def _bloor_wilson(comparisons: Comparisons) -> Iterator[Finding]:
    four, six = by_method(comparisons, "bloor-wilson-4"), by_method(comparisons, "bloor-wilson-6")
    ours = by_method(comparisons, LEAST)
    for example in (e for e in six if e in four and e in ours):
        own, (high_run, high), (low_run, low) = ours[example][1], six[example], four[example]
        yield Finding(
            f"Between closed contacts ({_name(example)}) a Bloor-Wilson blend [14, 15] of sixth order is "
            f"{reached(high_run.task, high)}",
            f"With {high.energy / own.energy:.3g} times our energy; that of fourth order is "
            f"{reached(low_run.task, low)} with {low.energy / own.energy:.3g} times our energy. Neither is a spline.",
        )


def _tools(comparisons: Comparisons) -> Iterator[Finding]:
    ours = by_method(comparisons, LEAST)
    for name in ("open-cascade-filling", "smlibpy"):
        found = by_method(comparisons, name)
        if not found:
            continue
        title = next(iter(found.values()))[0].method.title
        exact = [e for e, (c, m) in found.items() if reached(c.task, m) == "G2"]
        angle = max(m.angle_degrees for _, m in found.values())
        jump = max(m.curvature_jump_relative for _, m in found.values())
        size = [_count(c) / _count(ours[e][0]) for e, (c, _) in found.items() if e in ours]
        yield Finding(
            f"{title}, which a user of Python would pick today, is G2 up to rounding in {_of(exact, found)} examples",
            f"Angles up to {angle:.2g} degrees, relative curvature jumps up to {jump:.2g}, "
            f"{_range(size, '.2g')} times the control points.",
        )


def _fair(comparisons: Comparisons) -> Iterator[Finding]:
    """Set the fairest blends beside those of least energy, and name the exact rivals that are fairer still."""
    fair, least = by_method(comparisons, FAIR), by_method(comparisons, LEAST)
    both = [e for e in fair if e in least]
    if not both:
        return
    quotient = {e: value / ours for e in both if (ours := fair[e][1].fairness) and (value := least[e][1].fairness)}
    better = [e for e in both if not fair[e][1].folds and (least[e][1].folds or quotient.get(e, 0.0) > 1)]
    folded = [e for e in both if least[e][1].folds]
    turns = [_range((found[e][1].turn_degrees for e in both), ".0f") for found in (fair, least)]
    cost = [100 * (fair[e][1].energy / least[e][1].energy - 1) for e in both]
    points = [_count(fair[e][0]) / _count(least[e][0]) for e in both]
    yield Finding(
        f"The fairest blend, which is the default, beats that of least energy in {_of(better, both)} examples",
        f"Both have G2 contact. Area times the integral of |grad H|^2 is {_range(quotient.values(), '.3g')} times as "
        f"much where alpha, beta and a middle curve minimise (11), which folds in {_names(folded)}; the normal turns "
        f"by at most {turns[1]} degrees there within a fiftieth of the length, and by {turns[0]} on the fairest. That "
        f"changes (11) by {_range(cost, '+.2g')} % and takes {_range(points, '.2g')} times the control points. "
        f"{_fairer_rivals(comparisons, fair)}",
    )


def _fairer_rivals(comparisons: Comparisons, fair: dict[str, tuple[Comparison, Measures]]) -> str:
    """Return a sentence on the exact G2 rivals without a fold that are fairer somewhere."""
    named = []
    for name in dict.fromkeys(c.method.name for found in comparisons.values() for c in found):
        found = {} if name == FAIR else by_method(comparisons, name)
        where = [
            e
            for e, (c, m) in found.items()
            if e in fair and reached(c.task, m) == "G2" and not m.folds and _is_fairer(m, fair[e][1])
        ]
        if where:
            named.append(f"{found[where[0]][0].method.title} ({_names(where)})")
    return f"Of all other methods with exact G2 and no fold, fairer somewhere: {', '.join(named) or 'none'}."


def _is_fairer(one: Measures, other: Measures) -> bool:
    return one.fairness is not None and other.fairness is not None and one.fairness < other.fairness


def _real_pair(comparisons: Comparisons) -> Iterator[Finding]:
    """Say what least energy and the search for the fairest shape make of real CAD surfaces, beyond their contact."""
    titles = (("C2, least energy", "semistructured-c2"), ("G2, least energy", LEAST), ("G2, fairest shape", FAIR))
    for example in (name for name in comparisons if not name.startswith("figure-") and name != "made"):
        found = {title: by_method(comparisons, method).get(example) for title, method in titles}
        blends = {title: one for title, one in found.items() if one is not None}
        fair = blends.get("G2, fairest shape")
        if fair is None or len(blends) == 1:
            continue
        folded = [title for title, (_, m) in blends.items() if m.folds]
        words = "; ".join(
            f"{title}: the normal turns by up to {m.turn_degrees:.0f} degrees within a fiftieth of the length, the "
            f"least area element is {m.least_area_ratio:.2g} of the mean, {_count(c)} control points, energy "
            f"{m.energy:.4g}"
            for title, (c, m) in blends.items()
        )
        exact = all(reached(c.task, m) == "G2" for c, m in blends.values())
        yield Finding(
            f"On the real pair ({example}) {len(folded)} of {len(blends)} blends fold, and the fairest does "
            f"{'so too' if fair[1].folds else 'not'}",
            f"{'Each of them meets both bases exactly. ' * exact}The gap closes to a narrow corner at one end, and "
            f"there shapes differ. {words}.",
        )


def _count(comparison: Comparison) -> int:
    outcome = comparison.outcome
    if outcome is None or outcome.control_points is None:
        raise ValueError(f"{comparison.method.name}: has no control points on {comparison.task.name}")
    return outcome.control_points


def _has_points(comparison: Comparison) -> bool:
    return comparison.outcome is not None and comparison.outcome.control_points is not None


def _of(some: Iterable[object], everything: Iterable[object]) -> str:
    return f"{len(list(some))} of {len(list(everything))}"


def _range(values: Iterable[float], form: str) -> str:
    texts = [format(value, form) for value in sorted(values)]
    if not texts:
        return "no"
    return texts[0] if texts[0] == texts[-1] else f"{texts[0]} to {texts[-1]}"


def _name(example: str) -> str:
    kind, _, number = example.partition("-")
    return f"Fig. {number}" if kind == "figure" else f"the {example} pair"


def _names(examples: Iterable[str]) -> str:
    return ", ".join(map(_name, examples)) or "none"
