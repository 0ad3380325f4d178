"""Section 2, definition, and the bases of section 3: sums unrolled on spans, and properties of B-splines."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from semispline.papers.ledger import Claim, Formula, Meaning, Sample, clamped, given, interpret, samples, union
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as figures
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.printed_pairs import PRINTED_PAIRS, printed_pair
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Lets,
    Statement,
    Text,
    basis_jets,
    basis_number,
    contained,
    different,
    identity,
    knots,
    not_zero,
    positive,
    span_of,
    span_value,
    text,
    total,
    triangle,
)

UNROLLED = (
    "the sums are stated on spans of surfaces of orders (2, 2) to (4, 4), for all control points, u and v there; for "
    "every other order by the step of the triangle, which is stated"
)
INDUCTION = (
    "the recurrence carries what is stated of one order to the next one, and functions of order 1 are 1 on one span"
)
SPACES = "splines that agree at more points of each span than a polynomial of their order has coefficients are the same"
SLOPE = "((t + g)/g)^p has the slope p/g where t is 0"
U, V = Text("u"), Text("v")
_AT = ((Fraction(2, 7), Fraction(3, 7)), (Fraction(4, 5), Fraction(1, 9)))


def triangle_step() -> Iterator[Statement]:
    """Yield one step of the triangle and of the recurrence, for every order and knots."""
    weight = Text("(x - t_j)/(t_jk - t_j)", 2)
    left = Text("d_before") * (1 - weight) + Text("d_j") * weight
    right = Text("d_j*(x - t_j)/(t_jk - t_j) + d_before*(t_jk - x)/(t_jk - t_j)", 1)
    yield identity("one step of the triangle, every order and knots", left, right, own=False)


def _meaning(sample: Sample, lets: Lets, at: tuple[Fraction, Fraction]) -> Meaning:
    """Return what printed letters stand for on the spans of one point: functions by the recursion."""
    knots: dict[Any, Sequence[Fraction]] = {"U": sample.U} | dict(enumerate(sample.V))

    def basis(i: Any, order: Any, x: Any, name: Any) -> Text:
        vector = knots[name]
        return span_value(lets, int(order), vector, int(i), x, span_of(vector, at[0] if name == "U" else at[1]))

    def curve(i: Any, _: Any) -> Text:
        points = [Text(f"P_{int(i)}_{j}") for j in range(sample.sizes[int(i)])]
        return triangle(lets, sample.l, sample.V[int(i)], points, V, span_of(sample.V[int(i)], at[1]))

    numbers = {pr.u: U, pr.v: V, pr.U: "U", pr.k: sample.k, pr.ell: sample.l, pr.m: sample.m}
    functions = {
        "P": lambda i, j: Text(f"P_{int(i)}_{int(j)}"),
        "B": basis,
        "V": int,
        "n": lambda i: sample.sizes[int(i)] - 1,
        "C": curve,
    }
    return Meaning(numbers, functions)


def _surface(sample: Sample, lets: Lets, at: tuple[Fraction, Fraction]) -> Text:
    """Return the surface by triangles, first along v, then along u."""
    rows = []
    for i in range(sample.m + 1):
        points = [Text(f"P_{i}_{j}") for j in range(sample.sizes[i])]
        rows.append(triangle(lets, sample.l, sample.V[i], points, V, span_of(sample.V[i], at[1])))
    return triangle(lets, sample.k, sample.U, rows, U, span_of(sample.U, at[0]))


def surface_cases(formula: Formula) -> Iterator[Statement]:
    """Yield (1), (3) or (13) against the triangles."""
    yield from triangle_step()
    for sample in samples():
        for at in _AT:
            lets, other = Lets("c"), Lets("d")
            right = interpret(formula.relation.rhs, _meaning(sample, lets, at))
            true = _surface(sample, other, at)
            yield identity(
                f"orders {sample.k}, {sample.l}, the spans of {at[0]}, {at[1]}",
                true,
                right,
                where=[*lets.pairs, *other.pairs],
                own=sample.k == sample.l == CUBIC,
            )


def surface(claim: Claim) -> Draft:
    """Return a sum that is the surface."""
    return Draft([surface_cases(claim.formulas[0])], believed=(UNROLLED,))


def curve_cases(formula: Formula, *, equal: bool = True) -> Iterator[Statement]:
    """Yield (2), or another sum, against the triangle."""
    if equal:
        yield from triangle_step()
    for sample in samples():
        for i in (0, 1, sample.m):
            at = _AT[i % 2]
            lets, other = Lets("c"), Lets("d")
            meaning = _meaning(sample, lets, at)
            right = interpret(formula.relation.rhs, Meaning({**meaning.numbers, pr.i: i}, meaning.functions))
            true = _meaning(sample, other, at).functions["C"](i, V)
            yield identity(
                f"curve {i}, order {sample.l}, {sample.sizes[i]} points, the span of {at[1]}",
                true,
                right,
                equal=equal,
                where=[*lets.pairs, *other.pairs],
                own=sample.l == CUBIC,
            )


def curve(claim: Claim) -> Draft:
    """Return (2)."""
    return Draft([curve_cases(claim.formulas[0])], believed=(UNROLLED,))


def basis_index(claim: Claim) -> Draft:
    """Return the family B_(i,l), which is not the basis, and B_(j,l), which is."""
    return Draft([curve_cases(claim.formulas[0], equal=False)], curve_cases(claim.corrected_formulas[0]), (UNROLLED,))


def base(letter: str) -> Callable[[Claim], Draft]:
    """Return the draft of (7) or (9)."""
    x, knots_x, knots_v, order, last_x, last_v = (
        (pr.w, pr.W, pr.V_r, pr.k_r, pr.m_r, pr.n_r) if letter == "R" else (pr.t, pr.T, pr.V_s, pr.k_s, pr.m_s, pr.n_s)
    )

    def draft(claim: Claim) -> Draft:
        cases: list[Statement] = [*triangle_step()]
        for k, length in ((2, 3), (3, 2), (4, 4)):
            across, along = clamped(k, Fraction(1, 3), start=-1, end=2), clamped(length, Fraction(1, 4), Fraction(3, 5))
            vectors = {"across": across, "along": along}
            spans = {"across": span_of(across, Fraction(0)), "along": span_of(along, Fraction(2, 7))}
            lets, other = Lets("c"), Lets("d")

            def basis(i: Any, o: Any, at: Any, name: Any, lets: Lets = lets, v: Any = vectors, s: Any = spans) -> Text:
                return span_value(lets, int(o), v[name], int(i), at, s[name])

            numbers = {x: Text("w"), pr.v: V, knots_x: "across", knots_v: "along", order: k, pr.ell: length}
            numbers |= {last_x: len(across) - k - 1, last_v: len(along) - length - 1}
            functions = {letter: lambda i, j: Text(f"P_{int(i)}_{int(j)}"), "B": basis}
            right = interpret(claim.formulas[0].relation.rhs, Meaning(numbers, functions))
            rows = [
                triangle(
                    other, length, along, [Text(f"P_{i}_{j}") for j in range(len(along) - length)], V, spans["along"]
                )
                for i in range(len(across) - k)
            ]
            true = triangle(other, k, across, rows, Text("w"), spans["across"])
            cases.append(identity(f"orders {k}, {length}", true, right, where=[*lets.pairs, *other.pairs]))
        return Draft([cases], believed=(UNROLLED,))

    return draft


def either_order(_: Claim) -> Draft:
    """Return a surface with one knot vector for all curves: triangles first along v or first along u, and the sum."""
    cases: list[Statement] = [*triangle_step()]
    for k, length in ((2, 3), (3, 3), (4, 4)):
        across, along = clamped(k, Fraction(2, 5)), clamped(length, Fraction(1, 3))
        rows, columns = len(across) - k, len(along) - length
        s, t = span_of(across, Fraction(2, 7)), span_of(along, Fraction(3, 7))
        one, other, third = Lets("c"), Lets("d"), Lets("e")
        by_rows = [
            triangle(one, length, along, [Text(f"P_{i}_{j}") for j in range(columns)], V, t) for i in range(rows)
        ]
        by_columns = [
            triangle(other, k, across, [Text(f"P_{i}_{j}") for i in range(rows)], U, s) for j in range(columns)
        ]
        first, second = triangle(one, k, across, by_rows, U, s), triangle(other, length, along, by_columns, V, t)
        label = f"orders {k}, {length}"
        own: dict[str, Any] = {"own": k == length == CUBIC}
        cases.append(identity(f"{label}: either order", first, second, where=[*one.pairs, *other.pairs], **own))
        sample = Sample(k, length, across, (along,) * rows)
        right = interpret(pr.EQ_1.relation.rhs, _meaning(sample, third, _AT[0]))
        cases.append(
            identity(f"{label}: (1) with one knot vector", first, right, where=[*one.pairs, *third.pairs], **own)
        )
    return Draft([cases], believed=(UNROLLED,))


def partition() -> Iterator[Statement]:
    """Yield that functions sum to 1: the step for every order, and orders 2 to 5 over a symbolic inner knot."""
    yield identity(
        "partition of unity: the step", Text("(x - t_i)/(t_ip - t_i) + (t_ip - x)/(t_ip - t_i)", 1), 1, own=False
    )
    n, inner = [Text(f"N_{i}") for i in range(4)], [Text(f"S_{i}") for i in range(4)]
    where = [*((str(s), "1") for s in inner), ("N_3", "1 - N_0 - N_1 - N_2")]
    yield identity(
        "partition of unity: the surface",
        total(a * s for a, s in zip(n, inner, strict=True)),
        1,
        where=where,
        own=False,
    )
    for order in range(2, 6):
        vector = [*["0"] * order, "h", *["1"] * order]
        for span in (order - 1, order):
            lets = Lets("c")
            values = [span_value(lets, order, [Text(t) for t in vector], i, "x", span) for i in range(order + 1)]
            yield identity(
                f"order {order}, any inner knot h, span {span - order + 2}: sum of all functions",
                total(values),
                1,
                where=lets.pairs,
                own=order == CUBIC,
            )


def signs() -> Iterator[Statement]:
    """Yield that both factors of the recurrence are not negative inside the support."""
    where = [("t_ip", "t_i + a + b"), ("x", "t_i + a")]
    for name, factor in (("rising", "(x - t_i)/(t_ip - t_i)"), ("falling", "(t_ip - x)/(t_ip - t_i)")):
        yield positive(f"non-negative: {name}", factor, where=where, positive=("a", "b"), own=False)


def convex_hull(_: Claim) -> Draft:
    """Return that the weights are not negative and sum to 1."""
    weights = list(_weight_sums())
    return Draft([[*partition(), *signs(), *weights]], believed=(INDUCTION,))


def _weight_sums() -> Iterator[Statement]:
    for sample in samples():
        for u, v in _AT:
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
        at = _AT[0]
        true = _surface(sample, lets, at)
        letters = [(f"P_{i}_{j}", f"a*Q_{i}_{j} + b") for i in range(sample.m + 1) for j in range(sample.sizes[i])]
        plain = _surface(sample, other, at)
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


def insertion() -> Iterator[Statement]:
    """Yield the step of knot insertion, for every order, knots and place of the new knot z."""

    def rising(start: str, end: str) -> str:
        return f"(x - {start})/({end} - {start})"

    def falling(start: str, end: str) -> str:
        return f"({end} - x)/({end} - {start})"

    first = f"({rising('s0', 'before')}*A + {falling('s1', 'sk')}*B)"
    second = f"({rising('s1', 'sk')}*B + {falling('s2', 'after')}*C)"
    claimed = f"(z - s0)/(sk - s0)*{first} + (after - z)/(after - s1)*{second}"
    left = "((z - s0)/(before - s0)*A + (sk - z)/(sk - s1)*B)"
    right = "((z - s1)/(sk - s1)*B + (after - z)/(after - s2)*C)"
    for label, place, lower, start, end in (
        ("z inside", (), (left, right), "s1", "sk"),
        ("z right after the start", (("s1", "z"),), (left, "C"), "s2", "sk"),
        ("z right before the end", (("sk", "z"),), ("A", right), "s1", "before"),
    ):
        old = Text(f"{rising('s0', end)}*{lower[0]} + {falling(start, 'after')}*{lower[1]}", 1)
        yield identity(f"knot insertion, every order and knots, {label}", old, Text(claimed, 1), where=place, own=False)


def spaces(label: str, order: int, inner: Sequence[Fraction], outer: Sequence[Fraction], **flags: Any) -> Statement:
    """Return whether splines over one knot vector are splines over another, by values at points of each span."""
    knots = sorted({*inner, *outer})
    points = [a + (b - a) * Fraction(r, order + 1) for a, b in pairwise(knots) for r in range(order + 1)]
    values = [
        [[basis_number(order, vector, i, x) for i in range(len(vector) - order)] for x in points]
        for vector in (outer, inner)
    ]
    return contained(label, *values, **flags)


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


def nested_pairs() -> Iterator[Statement]:
    """Yield the printed pairs: both lie in the space of the union of their knots."""
    for name in PRINTED_PAIRS:
        pair = printed_pair(name)
        for n, vector in enumerate(pair, start=1):
            yield spaces(f"{name}, vector {n}", CUBIC, vector, union(CUBIC, *pair))


def derivative_steps() -> Iterator[Statement]:
    """Yield base and step of the derivative formula, and its sum over a curve's control points."""
    hat = "(x - t0)/(t1 - t0)", "(t2 - x)/(t2 - t1)"
    moved = "(x + e - t0)/(t1 - t0)", "(t2 - (x + e))/(t2 - t1)"
    for name, now, then, slope in zip(("rising", "falling"), hat, moved, ("1/(t1 - t0)", "-1/(t2 - t1)"), strict=True):
        yield identity(f"derivative, base, {name}: over e", Text(f"({then} - ({now}))/e", 2), Text(slope, 1), own=False)
    low, high = (
        "((x - t0)/(t_pm - t0)*A + (t_p - x)/(t_p - t1)*B)",
        "((x - t1)/(t_p - t1)*B + (t_pp - x)/(t_pp - t2)*C)",
    )
    low_slope = "((p - 1)*(A/(t_pm - t0) - B/(t_p - t1)))"
    high_slope = "((p - 1)*(B/(t_p - t1) - C/(t_pp - t2)))"
    left = (
        f"{low}/(t_p - t0) + (x - t0)/(t_p - t0)*{low_slope} - {high}/(t_pp - t1) + (t_pp - x)/(t_pp - t1)*{high_slope}"
    )
    yield identity(
        "derivative, step, every degree and knots",
        Text(left, 1),
        Text(f"p*({low}/(t_p - t0) - {high}/(t_pp - t1))", 2),
        own=False,
    )
    terms = [f"P_{i}*p*(N_{i}/d_{i} - N_{i + 1}/d_{i + 1})" for i in range(3)]
    claimed = [f"p*(P_{i} - P_{i - 1})/d_{i}*N_{i}" for i in (1, 2)]
    ends = "p*(P_0/d_0*N_0 - P_2/d_3*N_3)"
    yield identity(
        "derivative of a curve: summation by parts",
        Text(" + ".join(terms), 1),
        Text(" + ".join([*claimed, ends]), 1),
        own=False,
    )


def sharp_continuity(**flags: Any) -> Iterator[Statement]:
    """Yield that across an r-fold knot splines of degree p are C^(p-r), some no smoother."""
    for label, left, right, where in (
        ("kept from the right", "(near - x)/(near - t_i)", 1, (("t_i", "x"),)),
        ("lost from the right", "(x - t_i)/(near - t_i)", 0, (("t_i", "x"),)),
        ("kept from the left", "(x - near)/(t_i - near)", 1, (("t_i", "x"),)),
        ("lost from the left", "(t_i - x)/(t_i - near)", 0, (("t_i", "x"),)),
    ):
        yield identity(f"continuity, base, {label}", Text(left, 2), right, where=where, **flags)
    yield from derivative_steps()
    yield positive(
        "full multiplicity: the slope jumps by minus this", Text("p/g + p/h", 1), positive=("p", "g", "h"), **flags
    )
    yield identity(
        "a spline of one degree more has it as derivative", Text("p*((P_i + d*Q_i/p) - P_i)/d", 2), Text("Q_i"), **flags
    )


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
        meaning = _meaning(sample, lets, _AT[0])
        functions = {**meaning.functions, "C": lambda i, _, p=position: Text("J") if int(i) == p else Text("0")}
        right = interpret(pr.EQ_3.relation.rhs, Meaning(meaning.numbers, functions))
        factor = span_value(other, CUBIC, sample.U, position, "u", span_of(sample.U, _AT[0][0]))
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


def common_domain(_: Claim) -> Draft:
    """Return that curves are defined where their functions sum to 1, and domains that lack a part of [0, 1]."""
    first = clamped(CUBIC, Fraction(1, 2))
    cases: list[Statement] = [*partition()]
    for label, second, meets in (
        ("V_1 over [0, 1]", clamped(CUBIC, Fraction(1, 3)), True),
        ("V_1 over [-1, 2], which contains [0, 1]", clamped(CUBIC, Fraction(1, 2), start=-1, end=2), True),
        ("V_1 over [0, 3/4]", clamped(CUBIC, Fraction(1, 3), end=Fraction(3, 4)), False),
        ("V_1 over [1/4, 1]", clamped(CUBIC, Fraction(1, 2), start=Fraction(1, 4)), False),
    ):
        for v in [Fraction(n, 8) for n in range(9)] if meets else [Fraction(0), Fraction(1)]:
            for n, vector in enumerate((first, second)):
                values = [basis_number(CUBIC, vector, i, v) for i in range(len(vector) - CUBIC)]
                inside = vector[0] <= v <= vector[-1]
                where = f"{label}: functions of V_{n} at v = {v}"
                total_ = total([Text("0"), *(x for x in values if x)])
                if meets:
                    cases.append(identity(where, total_, 1))
                elif not inside:
                    cases.append(different(where, total_, 1, own=False, meets=False))
    return Draft([cases], believed=(INDUCTION,))


def not_classical(_: Claim) -> Draft:
    """Return the printed pairs, neither of which carries both curves, and a nested pair."""
    half = Fraction(1, 2)
    cases: list[Statement] = [*sharp_continuity(own=False)]
    for name in PRINTED_PAIRS:
        a, b = printed_pair(name)
        for n, (one, other) in enumerate(((a, b), (b, a)), start=1):
            cases.append(spaces(f"{name}, way {n}", CUBIC, one, other, wanted=False))
    nested = clamped(4, half), clamped(4, half / 2, half, 3 * half / 2)
    cases.append(spaces("{1/2} and {1/4, 1/2, 3/4}", CUBIC, *nested, wanted=False, own=False, meets=False))
    return Draft([cases], believed=(INDUCTION, SPACES))


def different_vectors(claim: Claim) -> Draft:
    """Return how many vectors of a blend differ, and a surface with as many as curves."""
    printed = given(claim.readings[0].parts[0].formula).relation.rhs
    counts = dict(zip(pr.SIZES, figures.MIDDLE_CURVES.relation.rhs, strict=True))
    same: list[Statement] = []
    for figure, (a, b) in CONTACTS.items():
        middle = int(counts[figure])
        vectors = [pr.KNOTS[a]] * 3 + ["middle"] * middle + [pr.KNOTS[b]] * 3
        same.append(
            different(
                f"{figure}: {len(set(vectors))} different vectors",
                printed,
                len(set(vectors)),
                where=((text(pr.m), str(5 + middle)),),
            )
        )
    own: list[Statement] = [*partition()]
    for order in (2, 3, 4):
        for i in range(1, 6):
            vector = clamped(order, Fraction(i, 7))
            values = [basis_number(order, vector, j, Fraction(3, 7)) for j in range(len(vector) - order)]
            own.append(
                identity(
                    f"order {order}, knot {i}/7: functions at 3/7", total(x for x in values if x), 1, own=order == CUBIC
                )
            )
    return Draft([same, own], believed=(INDUCTION,))


def insertion_of_pairs(_: Claim) -> Draft:
    """Return that knot insertion makes the printed pairs identical."""
    return Draft([[*insertion(), *nested_pairs()]], believed=(INDUCTION, SPACES))


def same_knots(claim: Claim) -> Draft:
    """Return the patches of Fig. 5 over {1/2}: a polynomial one can be, others cannot."""
    third = Fraction(1, 3)
    polynomial, own, wanted = clamped(CUBIC), clamped(CUBIC, third, 2 * third), clamped(CUBIC, Fraction(1, 2))
    vector = claim.formulas[0].relation.rhs
    return Draft(
        [
            [
                knots("the vector of the first patch", vector, "equal", other=pr.KNOTS["fig-5.first"]),
                spaces("a plane with coordinates polynomial in v", CUBIC, polynomial, wanted),
                spaces("any plane patch over {1/3, 2/3}", CUBIC, own, wanted, own=False, meets=False),
            ]
        ],
        believed=(SPACES,),
    )


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-1": surface,
    "eq-2": curve,
    "eq-3": surface,
    "eq-13": surface,
    "sec-2.evaluation": surface,
    "eq-7": base("R"),
    "eq-9": base("S"),
    "sec-2.basis-index": basis_index,
    "sec-1.generalisation": either_order,
    "sec-2.evaluation-classical": either_order,
    "sec-2.convex-hull": convex_hull,
    "sec-2.affine-invariance": affine,
    "sec-2.localness": localness,
    "sec-2.continuity-control": continuity_control,
    "sec-2.transformation": transformation,
    "sec-1.knot-insertion": insertion_of_pairs,
    "sec-2.derivatives-classical": derivatives_classical,
    "sec-2.derivatives-hard": row_differences,
    "def-1": common_domain,
    "sec-3.not-classical": not_classical,
    "sec-2.different-vectors": different_vectors,
    "fig-5.same-knots": same_knots,
}
