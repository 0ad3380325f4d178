"""Deciding the printed numbers of section 5: knot vectors, sizes and counts against each other.

Printed data decide themselves only where they meet: a vector has as many knots as Table 1 has control points along the
contact, Figs. 8 and 9 share their bases, the text repeats two sizes of Fig. 11 and one vector of Fig. 5.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.papers.checks import clamped, contained
from semispline.papers.ledger import (
    Case,
    Consequence,
    Counterexample,
    Formula,
    as_fraction,
    given,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as printed
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.printed_pairs import WITH_MIDDLE_CURVE, inner_knots, merged
from semispline.papers.lin2014.printed import CUBIC

# Table 1, second numbers of each model, against the contact curves whose knots the text prints.
CONTACTS = {
    "fig-5": ("fig-5.first", "fig-5.second"),
    "fig-6": ("fig-6.planar", "fig-6.curved"),
    "fig-8": ("fig-8.larger", "fig-8.smaller"),
    "fig-9": ("fig-8.larger", "fig-8.smaller"),
    "fig-10": ("fig-10.first", "fig-10.second"),
}


def knot_cases(key: str) -> Any:
    """Return the check of a printed vector: as many control points as Table 1 says, increasing, clamped for order 4."""
    figure = key.partition(".")[0]
    _, wanted = pr.SIZES[figure][CONTACTS[figure].index(key)]

    def cases(formula: Formula | None) -> Iterator[Case]:
        knots = given(formula).relation.rhs
        points = len(knots) - CUBIC
        yield Case(
            f"{points} control points, Table 1 has {wanted}", points == wanted, residual=sp.Integer(points - wanted)
        )
        yield Case("increasing", list(knots) == sorted(knots))
        ends = tuple(knots[:CUBIC]) == (0,) * CUBIC and tuple(knots[-CUBIC:]) == (1,) * CUBIC
        yield Case(f"clamped for order {CUBIC}", ends)
        inner = list(knots[CUBIC:-CUBIC])
        yield Case("single inner knots inside", len(set(inner)) == len(inner) and all(0 < x < 1 for x in inner))

    return cases


def first_vector_5_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield what `knot_cases` does, and that the comparison with [13] keeps this vector: it is printed there again."""
    yield from knot_cases("fig-5.first")(formula)
    again = printed.COMMON_VECTOR_5.relation.rhs
    yield Case("the vector that both patches get for [13]", tuple(given(formula).relation.rhs) == tuple(again))


def first_vector_10_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield what `knot_cases` does for the first vector of Fig. 10, and that its inner knots are those printed."""
    yield from knot_cases("fig-10.first")(formula)
    inner = [as_fraction(x) for x in given(formula).relation.rhs if 0 < x < 1]
    yield Case("the printed inner knots", inner == inner_knots("fig-10.first"))


def seventh_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield the inner knots of Fig. 10: the six sevenths, rounded to six places."""
    knots = list(map(as_fraction, given(formula).relation.rhs))
    yield Case(f"{len(knots)} inner knots", len(knots) == 6)
    for i, knot in enumerate(knots, start=1):
        yield Case(f"{float(knot)}", knot == Fraction(round(Fraction(i, 7) * 10**6), 10**6))


def knot_10_counterexample() -> Counterexample:
    """Return the count that contradicts Table 1."""
    knots = pr.KNOTS["fig-10.first"]
    return Counterexample((("knots", str(len(knots))), ("order", "4")), f"{len(knots) - CUBIC} control points", "10")


def knot_10_consequence() -> Consequence:
    """Return what a curve over the vector as printed lacks: its domain starts at the fourth knot."""
    start = float(pr.KNOTS["fig-10.first"][CUBIC - 1])
    return on_surface(
        "The contact curve over the vector as printed: its functions sum to 1 from the fourth knot on",
        {"start of the domain": start, "share of the closed curve that is lost": start},
    )


def size_cases(figure: str, model: int) -> Any:
    """Return the check of a size in Table 1: rows for (3.1) and a cubic, columns as the text has them."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        size = given(formula).relation.rhs
        yield Case("rows and columns of control points", len(size) == 2 and all(x.is_Integer for x in size))
        rows, columns = size
        yield Case(f"{figure}: {rows} rows", bool(rows >= CUBIC))
        if figure in CONTACTS:
            along, where = len(inner_knots(CONTACTS[figure][model])) + CUBIC, "by the printed inner knots"
        else:
            along, where = printed.CONE_COUNTS[model], "by the text"
        yield Case(f"{figure}: {columns} columns, {along} {where}", bool(columns == along))
        for other in {"fig-8": ("fig-9",), "fig-9": ("fig-8",)}.get(figure, ()):
            yield Case(f"as in {other}", tuple(size) == pr.SIZES[other][model])

    return cases


def same_model_cases(model: int) -> Any:
    """Return the check of a size of Fig. 9, which blends the cylinders of Fig. 8."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield Case(f"model {model + 1}", tuple(given(formula).relation.rhs) == pr.SIZES["fig-8"][model])

    return cases


def cone_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield Fig. 11: as many control points along the contact as Table 1 has."""
    counts = tuple(size[1] for size in pr.SIZES["fig-11"])
    yield Case(f"{counts[0]} on the cone, {counts[1]} on the free form", tuple(given(formula).relation.rhs) == counts)


def bicubic_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield the printed vectors, which end in as many ones as the order, and the models of Table 1: enough rows."""
    order = given(formula).relation.rhs
    for key, knots in pr.KNOTS.items():
        yield Case(f"{key}: {list(knots).count(1)} ones", bool(order == list(knots).count(1)))
    for figure, pair in pr.SIZES.items():
        for rows, columns in pair:
            yield Case(f"{figure}: {rows} x {columns}", bool(min(rows, columns) >= order))


def middle_curve_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield the figures and their numbers of middle curves: none or one, knots by the rule, and as said once more."""
    counts = dict(zip(pr.SIZES, given(formula).relation.rhs, strict=True))
    for figure, count in counts.items():
        yield Case(f"{figure}: {count}, of the two kinds of section 3", count in (0, 1))
    for figure in printed.NO_MIDDLE_CURVE_AGAIN:
        yield Case(f"{figure}: none, as its own paragraph says", counts[figure] == 0)
    for name in WITH_MIDDLE_CURVE:
        yield Case(f"{name}: {len(merged(name)) // 2} averaged knots or more", len(merged(name)) >= 2)


def _union_gain(times: Any, others: Any) -> Any:
    """Return how many knots both curves together get at a place where their knots have these multiplicities."""
    both = sp.Max(times, others)
    return (both - times) + (both - others)


def added_cases(gain: Callable[[Any, Any], Any] = _union_gain) -> Iterator[Case]:
    """Yield a knot of any multiplicities in two vectors: where these differ the union adds knots to one of both curves.

    Each knot more is a control point more, by every order; so curves whose vectors differ get one more at least.
    """
    shared, more = sp.Symbol("c", integer=True, nonnegative=True), sp.Symbol("d", integer=True, positive=True)
    yield Case("more often in the first vector", bool(gain(shared + more, shared).is_positive))
    yield Case("more often in the second", bool(gain(shared, shared + more).is_positive))
    yield Case("as often: none is added", bool(gain(shared, shared) == 0))


def superfluous_cases() -> Iterator[Case]:
    """Yield figures: control points with rows on their own knots, and with all rows on the union of the knots."""
    for figure, (first, second) in CONTACTS.items():
        n_r, n_s = (size[1] for size in pr.SIZES[figure])
        shared = len({*inner_knots(first), *inner_knots(second)})
        middle = int(dict(zip(pr.SIZES, printed.MIDDLE_CURVES.relation.rhs, strict=True))[figure])
        own = 3 * (n_r + n_s) + middle * (shared // 2 + CUBIC)
        union = (6 + middle) * (shared + CUBIC)
        yield Case(f"{figure}: {own} control points, {union} on the union", union > own)


def circle_cases(quadric: Callable[[Any, Any], Any] = lambda x, y: x**2 + y**2) -> Iterator[Case]:
    """Yield polynomial pieces of any degree, true where one runs along a circle x^2 + y^2 = r^2.

    With the leading coefficients a, b of x and y, that of x^2 + y^2 is a^2 + b^2, of degree 2 d: it vanishes for
    a = b = 0 alone, degree by degree down to a point. The same in each parameter of a surface.
    """
    a, b = sp.symbols("a b", real=True, nonzero=True)
    for label, leading in (("a and b not zero", (a, b)), ("a alone", (a, 0)), ("b alone", (0, b))):
        left = quadric(*leading)
        yield Case(f"leading coefficients: {label}", not left.is_positive, residual=left)


def extrusion_cases(across: Any = None) -> Iterator[Case]:
    """Yield that any cubic curve, moved along a line, is a cylinder of degrees (3, 3): cubic along, a line raised."""
    t = sp.Symbol("t")
    row = across or [sp.Rational(r, 3) for r in range(4)]
    line = sp.expand(sum(sp.binomial(3, r) * t**r * (1 - t) ** (3 - r) * x for r, x in enumerate(row)))
    residual = sp.expand(line - t)
    yield Case("a line with four rows", bool(residual == 0), residual=residual)


def cone_patch_cases(patch: Callable[[Any, Any], Any] | None = None) -> Iterator[Case]:
    """Yield that w (1 - v^2, 2 v, 1 + v^2), of degrees (1, 2), lies on the circular cone x^2 + y^2 = z^2, all of w, v.

    So do other pieces of it, of any degree that is no less. Its contact curves are parabolas and no circles.
    """
    w, v = sp.symbols("w v", real=True)
    x, y, z = (patch or (lambda w, v: (w * (1 - v**2), 2 * w * v, w * (1 + v**2))))(w, v)
    residual = sp.expand(x**2 + y**2 - z**2)
    yield Case("on the circular cone", bool(residual == 0), residual=residual)
    degrees = [max(sp.degree(part, letter) for part in (x, y, z)) for letter in (w, v)]
    yield Case("of degrees 3, 3 at the most", bool(max(degrees) <= CUBIC - 1 and min(degrees) >= 1))
    normal = sp.Matrix([x, y, z]).diff(w).cross(sp.Matrix([x, y, z]).diff(v)).subs({w: 1, v: 0})
    yield Case("regular away from its tip", not normal.is_zero_matrix)


def removable_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield coordinate functions over {1/3, 2/3}: can they be written over {1/2}? A spline space decides for all."""
    knots = tuple(map(as_fraction, given(formula).relation.rhs))
    yield Case("the vector of the first patch", knots == tuple(map(Fraction, map(str, pr.KNOTS["fig-5.first"]))))
    third = Fraction(1, 3)
    polynomial, own, wanted = clamped(CUBIC), clamped(CUBIC, third, 2 * third), clamped(CUBIC, Fraction(1, 2))
    yield Case("a plane with coordinates polynomial in v", contained(CUBIC, polynomial, wanted))
    yield Case("any plane patch over {1/3, 2/3}", contained(CUBIC, own, wanted), own=False, meets=False)
