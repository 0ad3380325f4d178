"""Printed numbers of the figures and of Table 1."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

from semispline.derivations.trimming import areas, corners
from semispline.papers.ledger import Claim, Formula
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as printed
from semispline.papers.lin2014.checks import trimming
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.printed_pairs import WITH_MIDDLE_CURVE, inner_knots, merged
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import Draft, Statement, Text, identity, knots, positive, text

# Records of which something is left out, and what.
IN_PART = {
    "fig-3.curves": "that the curves meet in their ends alone: isolation of real roots",
    "fig-3.pieces": "that boundaries of the pieces add up, and lengths of rows: counts of edges and points",
}


def vector_cases(formula: Formula, key: str) -> Iterator[Statement]:
    """Yield a printed vector against Table 1: points, order, ends, single inner knots."""
    figure = key.partition(".")[0]
    _, wanted = pr.SIZES[figure][CONTACTS[figure].index(key)]
    vector = formula.relation.rhs
    holds = len(vector) - CUBIC == wanted
    yield knots(f"{key}: as many control points as Table 1", vector, f"points {wanted}", order=CUBIC, holds=holds)
    yield knots(f"{key}: increasing", vector, "increasing")
    ends = tuple(vector[:CUBIC]) == (0,) * CUBIC
    yield knots(f"{key}: clamped", vector, "clamped", order=CUBIC, holds=ends)
    if ends:
        yield knots(f"{key}: single inner knots", vector, "single", order=CUBIC)


def vectors(*keys: str) -> Callable[[Claim], Draft]:
    """Return the draft of printed vectors."""

    def draft(claim: Claim) -> Draft:
        pairs = zip(keys, claim.formulas, strict=True)
        return Draft([[case for key, formula in pairs for case in vector_cases(formula, key)]])

    return draft


def vectors_5(claim: Claim) -> Draft:
    """Return the vectors of Fig. 5, the first of which is printed twice."""
    again = printed.COMMON_VECTOR_5.relation.rhs
    twice = knots("the vector that both patches get for [13]", claim.formulas[0].relation.rhs, "equal", other=again)
    (cases,) = vectors("fig-5.first", "fig-5.second")(claim).readings
    return Draft([[*cases, twice]])


def first_of_10(claim: Claim) -> Draft:
    """Return the first vector of Fig. 10, as printed and with a fourth zero."""
    wrong, right = claim.formulas[0], claim.corrected_formulas[0]
    inner = [x for x in right.relation.rhs if 0 < x < 1]
    return Draft(
        [vector_cases(wrong, "fig-10.first")],
        [
            *vector_cases(right, "fig-10.first"),
            knots("the printed inner knots", inner, "equal", other=inner_knots("fig-10.first")),
        ],
    )


def sevenths(claim: Claim) -> Draft:
    """Return the inner knots of Fig. 10: sevenths, off by half a unit of the sixth place at the most."""
    found = claim.formulas[0].relation.rhs
    cases: list[Statement] = [knots("six of them", found, "points 6", order=0)]
    for i, knot in enumerate(found, start=1):
        cases.append(positive(f"{i}/7 from above", Text(f"1/2000000 + ({text(knot)} - {i}/7)", 1)))
        cases.append(positive(f"{i}/7 from below", Text(f"1/2000000 - ({text(knot)} - {i}/7)", 1)))
        cases.append(identity(f"{i}/7: six places", Text(f"{round(Fraction(i, 7) * 10**6)}/1000000", 2), knot))
    return Draft([cases])


def sizes(claim: Claim) -> Draft:
    """Return the sizes of Table 1 against knots, the text and each other."""
    cases: list[Statement] = []
    formulas = iter(claim.formulas)
    for figure in pr.SIZES:
        for model in range(2):
            size = next(formulas).relation.rhs
            label = f"{figure}, model {model + 1}"
            cases.append(knots(f"{label}: rows and columns", size, "points 2", order=0))
            cases.append(positive(f"{label}: enough rows for a cubic", Text(f"{text(size[0])} - {CUBIC} + 1", 1)))
            if figure in CONTACTS:
                vector = inner_knots(CONTACTS[figure][model])
                cases.append(
                    knots(f"{label}: columns by the printed inner knots", vector, f"points {size[1] - CUBIC}", order=0)
                )
            else:
                cases.append(
                    knots(f"{label}: columns by the text", [size[1]], "equal", other=[printed.CONE_COUNTS[model]])
                )
            for other in {"fig-8": ("fig-9",), "fig-9": ("fig-8",)}.get(figure, ()):
                cases.append(knots(f"{label}: as in {other}", size, "equal", other=pr.SIZES[other][model]))
    return Draft([cases])


def same_bases(claim: Claim) -> Draft:
    """Return the sizes of Fig. 9, which are those of Fig. 8."""
    pairs = zip(claim.formulas, pr.SIZES["fig-8"], strict=True)
    return Draft(
        [[knots(f"model {n}", f.relation.rhs, "equal", other=size) for n, (f, size) in enumerate(pairs, start=1)]]
    )


def cone_counts(claim: Claim) -> Draft:
    """Return the counts of Fig. 11 in the text, which are those of Table 1."""
    columns = [size[1] for size in pr.SIZES["fig-11"]]
    return Draft([[knots("Table 1", claim.formulas[0].relation.rhs, "equal", other=columns)]])


def bicubic(claim: Claim) -> Draft:
    """Return that all printed vectors end as cubics do, and that nets are large enough."""
    order = int(claim.formulas[0].relation.rhs)
    cases: list[Statement] = [
        knots(
            f"{key}: {order} ones at the end",
            list(vector)[-order - 1 :],
            "equal",
            other=[vector[-order - 1], *[1] * order],
        )
        for key, vector in pr.KNOTS.items()
    ]
    for figure, pair in pr.SIZES.items():
        for rows, columns in pair:
            cases.append(positive(f"{figure}: {rows} rows", Text(f"{rows} - {order} + 1", 1)))
            cases.append(positive(f"{figure}: {columns} columns", Text(f"{columns} - {order} + 1", 1)))
    return Draft([cases])


def middle_curves(claim: Claim) -> Draft:
    """Return how many middle curves figures have."""
    counts = dict(zip(pr.SIZES, claim.formulas[0].relation.rhs, strict=True))
    cases: list[Statement] = [
        identity(f"{figure}: {count}, of the two kinds", Text(f"{count}*({count} - 1)", 2), 0)
        for figure, count in counts.items()
    ]
    cases += [
        knots(f"{figure}: none, as its own paragraph says", [counts[figure]], "equal", other=[0])
        for figure in printed.NO_MIDDLE_CURVE_AGAIN
    ]
    cases += [
        positive(f"{name}: averaged knots", Text(f"{len(merged(name))} - 2 + 1", 1)) for name in WITH_MIDDLE_CURVE
    ]
    return Draft([cases])


def counts_of_figure_1(claim: Claim) -> Draft:
    """Return the seven counts of Fig. 1."""
    counts = tuple(claim.formulas[0].relation.rhs)
    cases: list[Statement] = [
        knots("seven curves, m = 6", counts, "points 7", order=0),
        knots("the first three agree", counts[:3], "equal", other=[counts[0]] * 3),
        knots("the last three agree", counts[-3:], "equal", other=[counts[-1]] * 3),
    ]
    cases += [positive(f"curve {i} carries a cubic", Text(f"{n} - 4 + 1", 1)) for i, n in enumerate(counts)]
    return Draft([cases])


def curves_of_figure_3(claim: Claim) -> Draft:
    """Return that the four curves end in common corners, inside the square."""
    cases: list[Statement] = []
    for name, (one, other) in corners(trimming.hole()).items():
        cases.append(knots(f"{name} corner", one, "equal", other=other))
    for name, formula in zip(printed.SIDE_CURVES, claim.formulas, strict=True):
        side = trimming.side_of(name, formula)
        if side is None:
            raise ValueError(f"side: found no Bezier function for {name}, expected one")
        for r, value in enumerate((*side.coefficients, side.start, side.end)):
            cases.append(positive(f"{name}: number {r} above 0", text(value)))
            cases.append(positive(f"{name}: number {r} below 1", Text(f"1 - {text(value)}", 1)))
    return Draft([cases], left_out=IN_PART["fig-3.curves"])


def parameters_of_figure_3(claim: Claim) -> Draft:
    """Return that local parameters run over [0, 1] on the printed intervals."""
    names = list(printed.SIDE_PARAMETERS)
    cases: list[Statement] = []
    for name, formula in zip(names, claim.formulas, strict=False):
        (letter,) = formula.relation.rhs.free_symbols
        interval = claim.formulas[len(names) + names.index(name)].relation.rhs
        for end, wanted in zip(interval, (0, 1), strict=True):
            cases.append(
                identity(f"{name}: at {end}", formula.relation.rhs, wanted, where=((text(letter), text(end)),))
            )
    return Draft([cases])


def pieces_of_figure_3(_: Claim) -> Draft:
    """Return that areas of the pieces and the hole are positive and sum to 1."""
    found = areas(trimming.hole())
    cases: list[Statement] = [positive(f"{name}: area", text(area)) for name, area in found.items()]
    cases.append(identity("areas sum to 1", " + ".join(text(area) for area in found.values()), 1))
    return Draft([cases], left_out=IN_PART["fig-3.pieces"])


def first_split(claim: Claim) -> Draft:
    """Return the strip that holds c1."""
    interval = printed.SIDE_INTERVALS["left"].relation.rhs
    cases: list[Statement] = [
        knots("c1 is defined over the strip", claim.formulas[0].relation.rhs, "equal", other=interval)
    ]
    for r, c in enumerate(trimming.hole().left.coefficients):
        cases += [
            positive(f"c1, value {r} above 0", text(c)),
            positive(f"c1, value {r} below 1", Text(f"1 - {text(c)}", 1)),
        ]
    return Draft([cases])


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "fig-1.counts": counts_of_figure_1,
    "fig-3.curves": curves_of_figure_3,
    "fig-3.parameters": parameters_of_figure_3,
    "fig-3.pieces": pieces_of_figure_3,
    "fig-3.first-split": first_split,
    "fig-5.knots": vectors_5,
    "fig-6.knots": vectors("fig-6.planar", "fig-6.curved"),
    "fig-8.knots": vectors("fig-8.larger", "fig-8.smaller"),
    "fig-9.same-bases": same_bases,
    "fig-10.first-knots": first_of_10,
    "fig-10.sevenths": sevenths,
    "fig-10.second-knots": vectors("fig-10.second"),
    "fig-11.counts": cone_counts,
    "table-1.sizes": sizes,
    "sec-5.bicubic": bicubic,
    "sec-5.middle-curves": middle_curves,
}
