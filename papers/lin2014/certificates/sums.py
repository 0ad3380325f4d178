"""Sums over control points, section 2 and the bases of section 3, unrolled on spans, against de Boor's triangle."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Any

from semispline.papers.checks import clamped
from semispline.papers.ledger import Claim, Formula, Meaning, interpret
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.samples import Sample, samples
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import Draft, Lets, Statement, Text, identity, span_of, span_value, triangle

UNROLLED = (
    "the sums are stated on spans of surfaces of orders (2, 2) to (4, 4), for all control points, u and v there; for "
    "every other order by the step of the triangle, which is stated"
)
U, V = Text("u"), Text("v")
AT = ((Fraction(2, 7), Fraction(3, 7)), (Fraction(4, 5), Fraction(1, 9)))


def triangle_step() -> Iterator[Statement]:
    """Yield one step of the triangle and of the recurrence, for every order and knots."""
    weight = Text("(x - t_j)/(t_jk - t_j)", 2)
    left = Text("d_before") * (1 - weight) + Text("d_j") * weight
    right = Text("d_j*(x - t_j)/(t_jk - t_j) + d_before*(t_jk - x)/(t_jk - t_j)", 1)
    yield identity("one step of the triangle, every order and knots", left, right, own=False)


def meaning_of(sample: Sample, lets: Lets, at: tuple[Fraction, Fraction]) -> Meaning:
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


def surface_by_triangles(sample: Sample, lets: Lets, at: tuple[Fraction, Fraction]) -> Text:
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
        for at in AT:
            lets, other = Lets("c"), Lets("d")
            right = interpret(formula.relation.rhs, meaning_of(sample, lets, at))
            true = surface_by_triangles(sample, other, at)
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
            at = AT[i % 2]
            lets, other = Lets("c"), Lets("d")
            meaning = meaning_of(sample, lets, at)
            right = interpret(formula.relation.rhs, Meaning({**meaning.numbers, pr.i: i}, meaning.functions))
            true = meaning_of(sample, other, at).functions["C"](i, V)
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
        right = interpret(pr.EQ_1.relation.rhs, meaning_of(sample, third, AT[0]))
        cases.append(
            identity(f"{label}: (1) with one knot vector", first, right, where=[*one.pairs, *third.pairs], **own)
        )
    return Draft([cases], believed=(UNROLLED,))


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
}
