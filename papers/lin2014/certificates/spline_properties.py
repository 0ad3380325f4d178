"""Section 2, properties: convex hull, affine maps, localness, continuity, knot insertion, derivatives."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

from semispline.papers.checks import clamped, union
from semispline.papers.ledger import Claim, Meaning, interpret
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.spline_steps import (
    INDUCTION,
    SPACES,
    derivative_steps,
    insertion,
    partition,
    sharp_continuity,
    signs,
    spaces,
)
from semispline.papers.lin2014.certificates.sums import AT, meaning_of, surface_by_triangles
from semispline.papers.lin2014.checks.samples import Sample, samples
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Lets,
    Statement,
    Text,
    basis_jets,
    basis_number,
    identity,
    not_zero,
    positive,
    span_of,
    span_value,
    text,
    total,
)

SLOPE = "((t + g)/g)^p has the slope p/g where t is 0"


def convex_hull(_: Claim) -> Draft:
    """Return that the weights are not negative and sum to 1."""
    weights = list(_weight_sums())
    return Draft([[*partition(), *signs(), *weights]], believed=(INDUCTION,))


def _weight_sums() -> Iterator[Statement]:
    for sample in samples():
        for u, v in AT:
            factors = [
                basis_number(sample.k, sample.U, i, u) * basis_number(sample.l, along, j, v)
                for i, along in enumerate(sample.V)
                for j in range(sample.sizes[i])
            ]
            label = f"orders {sample.k}, {sample.l} at {u}, {v}"
            own: dict[str, Any] = {"own": sample.k == sample.l == CUBIC}
            yield identity(f"{label}: weights sum to 1", total(x for x in factors if x), 1, **own)


def affine(_: Claim) -> Draft:
    """Return that an affine map of the control points is one of the surface."""
    f, c = [Text(f"f_{i}") for i in range(4)], [Text(f"c_{i}") for i in range(4)]
    a, b = Text("a"), Text("b")
    mapped = total(w * (a * p + b) for w, p in zip(f, c, strict=True))
    image = a * total(w * p for w, p in zip(f, c, strict=True)) + b
    cases: list[Statement] = [
        identity("the difference is b (sum of weights - 1)", mapped - image, b * (total(f) - 1)),
        identity("with weights that sum to one", mapped, image, where=[("f_3", "1 - f_0 - f_1 - f_2")]),
    ]
    for sample in samples():
        lets, other = Lets("c"), Lets("d")
        at = AT[0]
        true = surface_by_triangles(sample, lets, at)
        letters = [(f"P_{i}_{j}", f"a*Q_{i}_{j} + b") for i in range(sample.m + 1) for j in range(sample.sizes[i])]
        plain = surface_by_triangles(sample, other, at)
        renamed = [(name, meaning.replace("P_", "Q_")) for name, meaning in other.pairs]
        cases.append(
            identity(
                f"orders {sample.k}, {sample.l}",
                true,
                a * Text(str(plain).replace("P_", "Q_")) + b,
                where=[*letters, *lets.pairs, *renamed],
                own=sample.k == sample.l == CUBIC,
            )
        )
    return Draft([[*partition(), *cases]], believed=(INDUCTION,))


def localness(_: Claim) -> Draft:
    """Return that N_i,k vanishes on span c unless i <= c < i + k."""
    cases: list[Statement] = []
    # N_i,k is made of functions i and i + 1 of order k - 1, which live on spans j .. j + k - 2.
    for label, place in (("before its first knot", "i - 1 - d"), ("after its last knot", "i + k + d")):
        for j in ("i", "i + 1"):
            away = f"({j}) - c" if "before" in label else f"c - (({j}) + (k - 1) - 1)"
            cases.append(
                positive(
                    f"span {place}, {label}: function {j} of one order less vanishes",
                    Text(away, 1),
                    where=[("c", place)],
                    nonnegative=("d",),
                )
            )
    for order in range(2, 5):
        knots = [Fraction(t) for t in range(3 * order)]
        i = order
        for span in range(order - 1, 2 * order):
            lets = Lets("c")
            value = span_value(lets, order, knots, i, "x", span)
            if i <= span < i + order:
                cases.append(
                    not_zero(
                        f"order {order}: function {i} lives on span {span}", value, where=lets.pairs, own=order == CUBIC
                    )
                )
    return Draft([cases], believed=(INDUCTION,))


def transformation(_: Claim) -> Draft:
    """Return that inserting knots changes no spline, and that the curves of samples fit on the union of their knots."""
    cases: list[Statement] = [*insertion()]
    for sample in samples():
        common = union(sample.l, *sample.V)
        for n, vector in enumerate(sorted(set(sample.V))):
            cases.append(
                spaces(
                    f"orders {sample.k}, {sample.l}, vector {n}",
                    sample.l,
                    vector,
                    common,
                    own=sample.k == sample.l == CUBIC,
                )
            )
    return Draft([cases], believed=(INDUCTION, SPACES))


def derivatives_classical(_: Claim) -> Draft:
    """Return that a derivative is a spline of lower degree: base, step and sum, and curves of orders 2 to 5."""
    return Draft([[*derivative_steps(), *differentiated()]], believed=(INDUCTION,))


def differentiated() -> Iterator[Statement]:
    """Yield curves of orders 2 to 5 on a span: the coefficient of e at x + e is the spline of one order less at x."""
    for k in range(2, 6):
        knots = clamped(k, Fraction(2, 5), Fraction(3, 5))
        span, shifted = span_of(knots, Fraction(1, 2)), [Text(str(t), 2) - Text("x") for t in knots]
        lets, lower = Lets("c"), Lets("d")
        points = [Text(f"P_{i}") for i in range(len(knots) - k)]
        jets = basis_jets(lets, k - 1, shifted, span, 1)
        left = total(jet[1] * points[span - k + 1 + r] for r, jet in enumerate(jets) if jet[1] is not None)
        terms = []
        for r, jet in enumerate(basis_jets(lower, k - 2, shifted, span, 0)):
            i = span - k + 2 + r
            row = (points[i] - points[i - 1]) * Fraction(k - 1) / Text(text(knots[i + k - 1] - knots[i]), 2)
            terms.append(row * jet[0])
        yield identity(f"order {k}", left, total(terms), where=[*lets.pairs, *lower.pairs], own=k == CUBIC)


def continuity_control(_: Claim) -> Draft:
    """Return the smoothness at a knot of any multiplicity, and that the jump of one curve has a factor of its own."""
    cases: list[Statement] = [*sharp_continuity()]
    for position in (0, 3, 6):
        vectors = (clamped(CUBIC),) * 7
        sample = Sample(CUBIC, CUBIC, clamped(CUBIC, Fraction(1, 4), Fraction(1, 2), Fraction(3, 4)), vectors)
        lets, other = Lets("c"), Lets("d")
        meaning = meaning_of(sample, lets, AT[0])
        functions = {**meaning.functions, "C": lambda i, _, p=position: Text("J") if int(i) == p else Text("0")}
        right = interpret(pr.EQ_3.relation.rhs, Meaning(meaning.numbers, functions))
        factor = span_value(other, CUBIC, sample.U, position, "u", span_of(sample.U, AT[0][0]))
        cases.append(
            identity(
                f"the jump of curve {position} has the factor N_{position}",
                right,
                factor * Text("J"),
                where=[*lets.pairs, *other.pairs],
            )
        )
    return Draft([cases], believed=(INDUCTION, SLOPE))


def row_differences(_: Claim) -> Draft:
    """Return what becomes of the rows of a derivative: neither knot vector carries them, the union does."""
    half, third = Fraction(1, 2), Fraction(1, 3)
    lost: list[Statement] = [*sharp_continuity(own=False)]
    for order, a, b in (
        (3, clamped(3), clamped(3, half)),
        (4, clamped(4, half), clamped(4, third)),
        (4, clamped(4, half), clamped(4, third, 2 * third)),
    ):
        for n, (one, other) in enumerate(((a, b), (b, a)), start=1):
            nested = set(one) <= set(other)
            lost.append(
                spaces(
                    f"order {order}, {len(a)} and {len(b)} knots, way {n}",
                    order,
                    one,
                    other,
                    wanted=nested,
                    own=order == CUBIC,
                )
            )
    forms: list[Statement] = [*derivative_steps(), *insertion()]
    label = "every order and knots: a spline form exists, by this sum"
    terms = [f"P_{i}*p*(N_{i}/d_{i} - N_{i + 1}/d_{i + 1})" for i in range(3)]
    claimed = [f"p*(P_{i} - P_{i - 1})/d_{i}*N_{i}" for i in (1, 2)]
    ends = "p*(P_0/d_0*N_0 - P_2/d_3*N_3)"
    exists = identity(label, Text(" + ".join(terms), 1), Text(" + ".join([*claimed, ends]), 1), wanted=False)
    return Draft([lost, [*forms, exists]], believed=(INDUCTION, SPACES))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-2.convex-hull": convex_hull,
    "sec-2.affine-invariance": affine,
    "sec-2.localness": localness,
    "sec-2.continuity-control": continuity_control,
    "sec-2.transformation": transformation,
    "sec-2.derivatives-classical": derivatives_classical,
    "sec-2.derivatives-hard": row_differences,
}
