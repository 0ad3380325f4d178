"""Section 2, the Bezier example: sums unrolled at some degrees, and the steps that carry them to all degrees."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

from semispline.derivations.bezier import blossom, de_casteljau, division_curve
from semispline.papers.checks import bernstein
from semispline.papers.ledger import (
    Claim,
    Formula,
    Meaning,
    given,
    interpret,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.subpatch_counts import DEGREE, row_count_cases
from semispline.papers.recheck import Draft, Statement, Text, different, identity, positive, text, total

DEGREES = ((1, 1, 1), (2, 2, 1), (1, 3, 2), (3, 3, 1), (2, 1, 3), (3, 3, 2))
UNROLLED = (
    "the sums are stated at degrees (m, n, k) up to (3, 3, 2) and (2, 1, 3); for all degrees by induction, with "
    "the steps that are stated"
)
BINOMIALS = "C(n, r) = n! / (r! (n - r)!), and that powers of one base multiply by adding exponents"
Net = list[list[Text]]


def net_of(m: int, n: int) -> Net:
    """Return letters for control points."""
    return [[Text(f"P_{i}_{j}") for j in range(n + 1)] for i in range(m + 1)]


def function_of(k: int) -> list[Text]:
    """Return letters for the control values of the dividing function."""
    return [Text(f"v_{r}") for r in range(k + 1)]


def bezier(points: Any, x: Any) -> Text:
    """Return a Bezier polynomial by its sum."""
    degree = len(points) - 1
    return total(point * bernstein(i, degree, x) for i, point in enumerate(points))


def by_triangle(points: Any, x: Any) -> Text:
    """Return the same by de Casteljau's triangle."""
    level = list(points)
    while len(level) > 1:
        level = [(1 - x) * a + x * b for a, b in pairwise(level)]
    return level[0]


def triangle_step() -> Iterator[Statement]:
    """Yield a step of de Casteljau's triangle on the factors of control points, for every degree, and degree 0."""
    # b stands for C(k-1, r-1); then C(k-1, r) = b (k - r) / r and C(k, r) = b k / r, powers of x and 1 - x apart.
    yield identity(
        "a step of the triangle, every degree k and index r", Text("b*k/r", 2), Text("b*(k - r)/r + b", 1), own=False
    )
    yield identity("degree 0", bernstein(0, 0, Text("x")), 1, own=False)
    for degree in range(1, 5):
        points = [Text(f"P_{i}") for i in range(degree + 1)]
        yield identity(
            f"degree {degree}: the derived triangle",
            de_casteljau(points, Text("x")),
            by_triangle(points, Text("x")),
            own=False,
        )


def lemmas() -> Iterator[Statement]:
    """Yield the identities that carry the division of a patch to every m, n, k."""
    v, w, x, y, p, q, r = map(Text, "vwxypqr")
    factorials = Text("fn/(fs*fns)", 2) * (Text("fs") / (Text("fj") * Text("fsj")))
    other = Text("fn/(fj*fnj)", 2) * (Text("fnj") / (Text("fsj") * Text("fns")))
    yield identity(
        "subdivision: C(n, s) C(s, j) = C(n, j) C(n-j, s-j), fn = n!, fns = (n-s)!, ..", factorials, other, own=False
    )
    product = Text("A*B/D", 2) * Text("D")
    yield identity(
        "product: the weight times B_(i+j)^(a+b) is B_i^a B_j^b, A = C(a, i), ..", product, Text("A*B", 2), own=False
    )
    yield identity("collect", (1 - w) + w * (1 - v), 1 - v * w, own=False)
    yield identity("mirror", 1 - (v + (1 - v) * w), (1 - v) * (1 - w), own=False)
    yield identity(
        "affine",
        blossom([p, q], [v * w + (1 - v) * x]),
        v * blossom([p, q], [w]) + (1 - v) * blossom([p, q], [x]),
        own=False,
    )
    yield identity("symmetric", blossom([p, q, r], [x, y]), blossom([p, q, r], [y, x]), own=False)


def patch(claim: Claim) -> Draft:
    """Return (4)."""
    return Draft([[*patch_cases(claim.formulas[0]), *triangle_step()]], believed=(UNROLLED, BINOMIALS))


def patch_cases(formula: Formula, *, equal: bool = True) -> Iterator[Statement]:
    """Yield the double sum, unrolled, against the triangle."""
    u, v = Text("u"), Text("v")
    for m, n, _ in DEGREES:
        net = net_of(m, n)
        meaning = Meaning(
            {pr.u: u, pr.v: v, pr.m: m, pr.n: n}, {"P": lambda i, j, net=net: net[int(i)][int(j)], "B": bernstein}
        )
        yield identity(
            f"degrees {m}, {n}",
            interpret(formula.relation.rhs, meaning),
            by_triangle([by_triangle(row, v) for row in net], u),
            own=m == n == 3,
            equal=equal,
        )


def function(claim: Claim) -> Draft:
    """Return (5) and the abscissae of its control points."""
    t = Text("t")
    cases: list[Statement] = []
    for formula in claim.formulas:
        of_values = formula.relation.rhs.has(pr.v_c)
        for k in range(1, 6):
            values = function_of(k)
            meaning = Meaning({pr.t: t, pr.k: k}, {"v": lambda i, values=values: values[int(i)], "B": bernstein})
            true = by_triangle(values, t) if of_values else t
            name = "values" if of_values else "abscissae"
            cases.append(identity(f"degree {k}: {name}", interpret(formula.relation.rhs, meaning), true))
    # i/k C(k, i) = C(k-1, i-1), b the latter; so term i is t B_(i-1)^(k-1), and these sum to t.
    cases.append(identity("every k: term i of the abscissae", Text("i/k*(b*k/i)", 2), Text("b"), own=False))
    v = positive(
        "weights x^i (1-x)^(k-i) with x = a/(a+b) are not negative",
        Text("a/(a + b)", 2),
        positive=("a", "b"),
        own=False,
    )
    return Draft([[*cases, *triangle_step(), v]], believed=(UNROLLED, BINOMIALS))


def divided(part: str) -> Callable[[Formula], Iterator[Statement]]:
    """Return what decides (6) for a sub-patch."""

    def cases(formula: Formula) -> Iterator[Statement]:
        u, w = Text("u"), Text("v")
        for m, n, k in DEGREES:
            net, values = net_of(m, n), function_of(k)
            cut = bezier(values, u)

            def row(j: Any, s: Any, _: Any, net: Net = net, values: list[Text] = values) -> Text:
                return bezier(division_curve(net, values, int(j), int(s)), Text("u"))

            meaning = Meaning({pr.u: u, pr.v: w, pr.n: n}, {"B": bernstein, "Q": row})
            place = Text("x")
            where = [("c", str(cut)), ("x", "c*v" if part == "bottom" else "c + (1 - c)*v")]
            true = bezier([bezier(line, place) for line in net], u)
            yield identity(
                f"{part}, degrees {m}, {n}, {k}",
                interpret(formula.relation.rhs, meaning),
                true,
                where=where,
                own=m == n == 3,
            )

    return cases


def division(claim: Claim) -> Draft:
    """Return (6), both sub-patches."""
    bottom, top = claim.formulas
    return Draft([[*divided("bottom")(bottom), *divided("top")(top), *lemmas()]], believed=(UNROLLED, BINOMIALS))


def division_rows(claim: Claim) -> Draft:
    """Return the formula for Q_j^s, s = 1, 2, 3."""
    cases = [case for depth, formula in enumerate(claim.formulas, start=1) for case in row_formula(formula, depth)]
    step = identity(
        "from s - 1 to s: the weight, A = C(n, a), B = C(k, b), D = C(n+k, a+b)",
        Text("A*B/D*D/A", 2),
        Text("B"),
        own=False,
    )
    return Draft([[*cases, step, *lemmas()]], believed=(UNROLLED, BINOMIALS))


def row_formula(formula: Formula, depth: int) -> Iterator[Statement]:
    """Yield the printed sum over blossoms at v_r against the blossom at v(u)."""
    u = Text("u")
    for m, n, k in DEGREES:
        net, values = net_of(m, n), function_of(k)
        for j in range(n - depth + 1):

            def at(i: Any, j: Any, *r: Any, net: Net = net, values: list[Text] = values) -> Text:
                i, j = int(i), int(j)
                return polar(net[i][j : j + len(r) + 1], [values[int(x)] for x in r])

            meaning = Meaning({pr.j: j, pr.u: u, pr.m: m, pr.k: k}, {"B": bernstein, "F": at})
            line = [polar(row[j : j + depth + 1], [Text("c")] * depth) for row in net]
            yield identity(
                f"s = {depth}, degrees {m}, {n}, {k}, j = {j}",
                interpret(formula.relation.rhs, meaning),
                bezier(line, u),
                where=[("c", str(bezier(values, u)))],
                own=m == n == 3,
            )


def polar(points: list[Text], arguments: list[Text]) -> Text:
    """Return the polar form by its definition: a sum over all choices of arguments."""
    terms = []
    for choice in range(2 ** len(arguments)):
        ups = [choice >> r & 1 for r in range(len(arguments))]
        term = points[sum(ups)]
        for up, x in zip(ups, arguments, strict=True):
            term = term * (x if up else 1 - x)
        terms.append(term)
    return total(terms)


def blossoms(first: bool) -> Callable[[Claim], Draft]:
    """Return the draft of the recursion, its first step or a further one."""

    def draft(claim: Claim) -> Draft:
        formula, cases = claim.formulas[0], []
        for n in range(1, 5):
            row, xs = [Text(f"P_{j}") for j in range(n + 1)], [Text(f"x_{r + 1}") for r in range(n)]
            for s in (1,) if first else range(2, n + 1):
                for j in range(n - s + 1):
                    functions = {
                        "P": lambda i, j, row=row: row[int(j)],
                        "v": lambda r, xs=xs: xs[int(r)],
                        "x": lambda r, xs=xs: xs[int(r) - 1],
                        "F": lambda s, i, j, row=row, xs=xs: polar(row[int(j) : int(j) + int(s) + 1], xs[: int(s)]),
                    }
                    numbers = {pr.i: 0, pr.j: j, pr.j_1: 0} if first else {pr.i: 0, pr.j: j, pr.s: s}
                    right = interpret(formula.relation.rhs, Meaning(numbers, functions))
                    label = f"n = {n}, s = {s}, j = {j}"
                    cases.append(identity(label, polar(row[j : j + s + 1], xs[:s]), right))
                    derived = blossom(row[j : j + s + 1], xs[:s])
                    cases.append(identity(f"{label}: the derived blossom", derived, right))
        # Choices with argument s among the c, and those without it.
        step = identity(
            "every s: choices split by the last argument",
            Text("(1 - x)*E + x*F", 1),
            Text("x*F + (1 - x)*E", 1),
            own=False,
        )
        return Draft([[*cases, step, *triangle_step()]], believed=(UNROLLED, BINOMIALS))

    return draft


def row_range(claim: Claim) -> Draft:
    """Return the range of s, which leaves out rows that (6) uses."""
    low = text(claim.formulas[0].relation.rhs)
    true = text(claim.corrected_formulas[0].relation.rhs)
    wrong: list[Statement] = [
        positive("Q_0^0 and Q_n^0: s = 0 is below the range", f"{low} - s", where=(("s", "0"),), affirmed=False),
        positive("Q_0^n: s = n = 1 + r is in it", f"s - {low} + 1", where=(("s", "1 + r"),), nonnegative=("r",)),
        positive("no row of degree m - k: s = -1 is below it", f"{low} - s", where=(("s", "0 - 1"),)),
    ]
    right: list[Statement] = [
        positive("Q_0^0 and Q_n^0: s = 0 is in the range", f"s - ({true}) + 1", where=(("s", "0"),)),
        positive("Q_0^n: s = n = 1 + r is in it", f"s - ({true}) + 1", where=(("s", "1 + r"),), nonnegative=("r",)),
        positive("no row of degree m - k: s = -1 is below it", f"{true} - s", where=(("s", "0 - 1"),)),
        *row_formula(claim.corrected_formulas[1], 0),
    ]
    return Draft([wrong], right, (UNROLLED,))


def elevation() -> Iterator[Statement]:
    """Yield that a Bezier curve of degree d is one of degree d + 1, for every d, and that degrees 1 to 4 are."""
    # b = C(d, r), C(d+1, r) = b (d+1)/(d+1-r), C(d+1, r+1) = b (d+1)/(r+1); powers x^r (1-x)^(d-r) apart.
    kept, raised = Text("(1 - r/(d + 1))*b*(d + 1)/(d + 1 - r)", 2), Text("(r + 1)/(d + 1)*b*(d + 1)/(r + 1)", 2)
    yield identity("every degree: one degree more", kept * Text("(1 - x)") + raised * Text("x"), Text("b"))
    for d in range(1, 5):
        points = [Text(f"P_{i}") for i in range(d + 1)]
        higher = [points[0]]
        higher += [
            Text(f"{i}/{d + 1}", 2) * points[i - 1] + Text(f"{d + 1 - i}/{d + 1}", 2) * points[i]
            for i in range(1, d + 1)
        ]
        yield identity(f"degree {d}", bezier(points, Text("x")), bezier([*higher, points[-1]], Text("x")))


def kind_of_subpatch(claim: Claim) -> Draft:
    """Return the three readings of what a sub-patch is."""
    count = pr.COUNT_BOTTOM.relation.rhs
    orders = [
        different(
            "degree of the last row and of the first",
            count.subs(pr.s, pr.n),
            count.subs(pr.s, 0),
            conditions=("n > 0", "k > 0"),
        )
    ]
    bottom, top, count_bottom, count_top = (given(part.formula) for part in claim.readings[2].parts)
    skins = [*divided("bottom")(bottom), *divided("top")(top), *lemmas()]
    skins += [*row_count_cases(count_bottom, "bottom"), *row_count_cases(count_top, "top")]
    return Draft([orders, [*elevation(), *lemmas()], skins], believed=(UNROLLED, BINOMIALS, DEGREE))


DRAFTS = {
    "eq-4": patch,
    "eq-5": function,
    "eq-6": division,
    "sec-2.q-formula": division_rows,
    "sec-2.q-range": row_range,
    "sec-2.blossom-1": blossoms(True),
    "sec-2.blossom-2": blossoms(False),
    "sec-2.subpatch-kind": kind_of_subpatch,
}
