"""What the runs on section 5 come to: sentences whose every number is computed from the measures of this run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from papers.baselines.comparison import Comparison
from papers.measures import Measures
from papers.study import Comparisons, Finding
from papers.tables import LIMIT, reached

AS_PRINTED, CORRECTED, LEAST = "paper-as-printed", "paper-corrected", "semistructured-reduced"
# Second derivatives across a contact agree up to rounding: a fraction of the larger of both.
C2_LIMIT = 1e-9


def findings(comparisons: Comparisons) -> tuple[Finding, ...]:
    """Return what was found; a rival that cannot be used on any example is left out."""
    makers: tuple[Callable[[Comparisons], Iterator[Finding]], ...] = (
        _corrected, _as_printed, _search, _same_knots, _tangent_only, _lower, _hartmann, _bloor_wilson, _tools,
    )  # fmt: skip
    return tuple(finding for make in makers for finding in make(comparisons))


def meets_demand(comparison: Comparison) -> bool:
    """Tell whether a result has the contact that its example asks for, up to rounding."""
    m = comparison.measures
    if m is None or reached(comparison.task, m) != "G2":
        return False
    residual = c2_residual(m)
    return comparison.task.continuity == "G2" or (residual is not None and residual <= C2_LIMIT)


def c2_residual(measures: Measures) -> float | None:
    """Return the larger second-derivative residual of both contacts, None where there is none."""
    found = [contact.c2_residual for contact in (measures.contact_a, measures.contact_b)]
    known = [residual for residual in found if residual is not None]
    return max(known) if len(known) == len(found) else None


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
    angle = max(m.angle_degrees for _, m in found.values())
    jump = max(m.curvature_jump_relative for _, m in found.values())
    folds = f" It folds in {_names(folded)}." if folded else " None of these blends folds."
    yield Finding(
        f"With derived contact rows the method keeps its promise in {_of(good, found)} examples",
        f"C2 or G2 contact, as each example asks, with both bases untouched: angles up to {angle:.1e} degrees, relative "
        f"curvature jumps up to {jump:.1e}.{folds}",
    )


def _as_printed(comparisons: Comparisons) -> Iterator[Finding]:
    found, true = by_method(comparisons, AS_PRINTED), by_method(comparisons, CORRECTED)
    if not found:
        return
    missed = [example for example, (c, _) in found.items() if not meets_demand(c)]
    jump = {example: m.curvature_jump_relative for example, (_, m) in found.items()}
    worst = max(jump, key=lambda example: jump[example])
    flat = [e for e in missed if jump[e] <= LIMIT]
    also = f" In {_names(flat)} both bases are flat at the contact, so only C2 is missed." if flat else ""
    ratio = {e: found[e][1].energy / true[e][1].energy for e in found if e in true}
    yield Finding(
        f"Run as printed, it misses the promised contact in {_of(missed, found)} examples",
        f"The printed third rows, (3.1) and (3.2), leave relative jumps of normal curvature up to {jump[worst]:.2g} "
        f"({_name(worst)}); the energy is {_range(ratio.values(), '.3g')} times that with derived rows.{also}",
    )


def _search(comparisons: Comparisons) -> Iterator[Finding]:
    least = by_method(comparisons, LEAST)
    for name, what in (("semistructured-bfgs", "The paper's search, BFGS from the C2 blend,"),):
        found = by_method(comparisons, name)
        excess = {e: m.energy / least[e][1].energy - 1 for e, (_, m) in found.items() if e in least}
        good = [e for e, value in excess.items() if value <= 1e-6]
        if excess:
            worst = max(excess, key=lambda e: excess[e])
            steps = _range((c.outcome.iterations or 0 for c, _ in found.values() if c.outcome), "d")
            yield Finding(
                f"{what} ends at the least energy in {_of(good, excess)} examples",
                f"In {steps} iterations; at most {excess[worst]:.1e} above the minimum over all admissible alpha and "
                f"beta ({_name(worst)}), which method reduced proves.",
            )


def _same_knots(comparisons: Comparisons) -> Iterator[Finding]:
    ours, theirs = by_method(comparisons, LEAST), by_method(comparisons, "same-knots-g2")
    both = [e for e in ours if e in theirs]
    if not both:
        return
    saved = {e: 1 - _count(ours[e][0]) / _count(theirs[e][0]) for e in both}
    more = {e: ours[e][1].energy / theirs[e][1].energy - 1 for e in both}
    yield Finding(
        f"Own knots for each row save {_range((100 * s for s in saved.values()), '.0f')} % of the control points",
        "against a tensor product over the union of knots with the same G2 contact, rows and energy; the energy is "
        f"{_range((100 * x for x in more.values()), '.2g')} % higher, since the space is smaller.",
    )


def _tangent_only(comparisons: Comparisons) -> Iterator[Finding]:
    found = by_method(comparisons, "same-knots-g1")
    if found:
        jump = [m.curvature_jump_relative for _, m in found.values()]
        ours = by_method(comparisons, LEAST)
        saved = [1 - m.energy / ours[e][1].energy for e, (_, m) in found.items() if e in ours]
        yield Finding(
            "Tangent contact over equal knots (standing for [13]) breaks curvature, as the paper says",
            f"Relative jumps of {_range(jump, '.2g')}. What it gets for that: {_range((100 * s for s in saved), '.0f')} % "
            "less energy.",
        )


def _lower(comparisons: Comparisons) -> Iterator[Finding]:
    """Tell which exact G2 rivals have less energy, with how many control points; the method's own are left out."""
    ours = by_method(comparisons, LEAST)
    own = {AS_PRINTED, CORRECTED}
    names = dict.fromkeys(c.method.name for found in comparisons.values() for c in found)
    for name in names:
        if name in own or name.startswith(("semistructured", "same-knots")):
            continue
        found = {
            e: (c, m)
            for e, (c, m) in by_method(comparisons, name).items()
            if e in ours and reached(c.task, m) == "G2" and not m.folds and c.outcome and c.outcome.control_points
        }
        better = [e for e, (_, m) in found.items() if m.energy < ours[e][1].energy * (1 - 1e-9)]
        if not better:
            continue
        change = [100 * (1 - found[e][1].energy / ours[e][1].energy) for e in better]
        size = [_count(found[e][0]) / _count(ours[e][0]) for e in better]
        title = found[better[0]][0].method.title
        yield Finding(
            f"A rival wins: {title} has G2 and less energy in {_of(better, found)} examples",
            f"{_range(change, '.2g')} % less in {_names(better)}, with {_range(size, '.2g')} times the control points.",
        )


def _hartmann(comparisons: Comparisons) -> Iterator[Finding]:
    inside, fair = by_method(comparisons, "hartmann-inside"), by_method(comparisons, "hartmann-extended")
    ours = by_method(comparisons, LEAST)
    if not inside or not fair:
        return
    back = [e for e, (_, m) in inside.items() if m.folds]
    good = [e for e, (c, m) in fair.items() if reached(c.task, m) == "G2" and not m.folds]
    ratio = [m.energy / ours[e][1].energy for e, (_, m) in fair.items() if e in ours]
    yield Finding(
        f"Hartmann's blend [17] runs backwards only because its pieces lie inside the bases: {_of(back, inside)} fold",
        f"With the bases continued past their contacts it is G2 without a fold in {_of(good, fair)} examples, at "
        f"{_range(ratio, '.3g')} times our energy, and no spline. Fig. 7 shows the unfair variant.",
    )


def _bloor_wilson(comparisons: Comparisons) -> Iterator[Finding]:
    four, six = by_method(comparisons, "bloor-wilson-4"), by_method(comparisons, "bloor-wilson-6")
    ours = by_method(comparisons, LEAST)
    for example, (_, m) in six.items():
        if example in four and example in ours:
            own, low = ours[example][1], four[example][1]
            yield Finding(
                f"Bloor-Wilson blends [14, 15] can be had for closed contacts ({_name(example)})",
                f"Sixth order: relative curvature jump {m.curvature_jump_relative:.1e}, energy "
                f"{m.energy / own.energy:.3g} times ours; fourth order: jump {low.curvature_jump_relative:.2g}, energy "
                f"{low.energy / own.energy:.3g} times ours. Neither is a spline.",
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
            f"{title}, which a user of Python would pick today, is exactly G2 in {_of(exact, found)} examples",
            f"Angles up to {angle:.2g} degrees, relative curvature jumps up to {jump:.2g}, "
            f"{_range(size, '.2g')} times the control points.",
        )


def _count(comparison: Comparison) -> int:
    outcome = comparison.outcome
    if outcome is None or outcome.control_points is None:
        raise ValueError(f"{comparison.method.name}: has no control points on {comparison.task.name}")
    return outcome.control_points


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
