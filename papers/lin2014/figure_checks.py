"""Deciding section 5: printed knots against Table 1, and the conditions as printed on bases like those of the figures.

The paper prints no control points. What can be decided is what its words say of them: planes, cylinders, cones.

For k = k_r = 4 and any rows: (3.1) as printed gives the blend the second derivative across the contact that the base
has, along the normal, times (w_{k_r+1} - w_s) / u_2. So curvature stays continuous where the base is straight across
the contact (zero times anything), or by accident.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import sympy as sp

from derivations.contact import A, contact_rows
from derivations.splines import end_derivatives
from papers.ledger import Case, Consequence, Counterexample
from papers.lin2014 import printed as pr
from papers.lin2014.blending_checks import WITH_MIDDLE_CURVE, inner_knots, merged
from papers.lin2014.exact import clamped, rational_points
from papers.lin2014.property_checks import contained

CUBIC = 4
# Table 1, second numbers of each model, against the contact curves whose knots the text prints.
CONTACTS = {
    "fig-5": ("fig-5.first", "fig-5.second"),
    "fig-6": ("fig-6.planar", "fig-6.curved"),
    "fig-8": ("fig-8.larger", "fig-8.smaller"),
    "fig-9": ("fig-8.larger", "fig-8.smaller"),
    "fig-10": ("fig-10.first", "fig-10.second"),
}


def knot_cases(figure: str, keys: tuple[str, ...] | None = None) -> Any:
    """Return the check of printed vectors: increasing, clamped for order 4, as many control points as Table 1 says."""

    def cases() -> Iterator[Case]:
        for key, size in zip(CONTACTS[figure], pr.SIZES[figure], strict=True):
            if keys and key not in keys:
                continue
            knots = pr.KNOTS[key]
            points = len(knots) - CUBIC
            yield Case(f"{key}: {points} control points, Table 1 has {size[1]}", points == size[1])
            yield Case(f"{key}: increasing", list(knots) == sorted(knots))
            ends = knots[:CUBIC] == (0,) * CUBIC and knots[-CUBIC:] == (1,) * CUBIC
            yield Case(f"{key}: clamped for order {CUBIC}", ends)

    return cases


def repaired_knot_cases() -> Iterator[Case]:
    """Yield the first vector of Fig. 10 with a fourth zero."""
    knots = (0, *pr.KNOTS["fig-10.first"])
    yield Case("control points", len(knots) - CUBIC == pr.SIZES["fig-10"][0][1])
    yield Case("clamped", knots[:CUBIC] == (0,) * CUBIC and knots[-CUBIC:] == (1,) * CUBIC)


def seventh_cases() -> Iterator[Case]:
    """Yield the decimals of Fig. 10: sevenths, rounded to six places."""
    for i, knot in enumerate(inner_knots("fig-10.first"), start=1):
        yield Case(f"{float(knot)}", knot == Fraction(round(Fraction(i, 7) * 10**6), 10**6))


def knot_10_counterexample() -> Counterexample:
    """Return the count that contradicts Table 1."""
    knots = pr.KNOTS["fig-10.first"]
    return Counterexample((("knots", str(len(knots))), ("order", "4")), f"{len(knots) - CUBIC} control points", "10")


def knot_10_consequence() -> Consequence:
    """Return what a curve over the vector as printed lacks: its domain starts at the fourth knot."""
    start = float(pr.KNOTS["fig-10.first"][CUBIC - 1])
    return Consequence(
        "The contact curve over the vector as printed: its functions sum to 1 from the fourth knot on",
        {"start of the domain": start, "share of the closed curve that is lost": start},
    )


def table_cases(*figures: str) -> Any:
    """Return the check of sizes in Table 1: enough rows for a cubic in either direction, and for R_0, R_1, R_2."""

    def cases() -> Iterator[Case]:
        for figure in figures or tuple(pr.SIZES):
            for rows, columns in pr.SIZES[figure]:
                yield Case(f"{figure}: {rows} x {columns}", min(rows, columns) >= CUBIC)

    return cases


def same_model_cases() -> Iterator[Case]:
    """Yield Figs. 8 and 9, which blend the same cylinders: their sizes agree."""
    yield Case("sizes", pr.SIZES["fig-8"] == pr.SIZES["fig-9"])


def cone_cases() -> Iterator[Case]:
    """Yield Fig. 11: 10 control points along the contact on the cone, 64 on the free-form surface."""
    yield Case("sizes", tuple(size[1] for size in pr.SIZES["fig-11"]) == (10, 64))


def middle_curve_cases() -> Iterator[Case]:
    """Yield the figures that have a middle curve: the list fits section 3, and its rule gives each some knots."""
    listed = {"Fig. 5", "Fig. 6", "Figs. 8 and 9"}
    yield Case("one of the two kinds of section 3 each", listed == set(WITH_MIDDLE_CURVE))
    for name in sorted(listed):
        yield Case(f"{name}: {len(merged(name)) // 2} averaged knots or more", len(merged(name)) >= 2)


def superfluous_cases() -> Iterator[Case]:
    """Yield figures: control points with rows on their own knots, and with all rows on the union of the knots."""
    for figure, (first, second) in CONTACTS.items():
        n_r, n_s = (size[1] for size in pr.SIZES[figure])
        shared = len({*inner_knots(first), *inner_knots(second)})
        middle = 0 if figure == "fig-10" else 1
        own = 3 * (n_r + n_s) + middle * (shared // 2 + CUBIC)
        union = (6 + middle) * (shared + CUBIC)
        yield Case(f"{figure}: {own} control points, {union} on the union", union > own)


def _printed_row(row: int, alpha: Any = 1) -> Any:
    formula = {1: pr.COND_2_1, 2: pr.COND_3_1}[row].relation.rhs
    return formula.subs({pr.k: CUBIC, pr.k_r: CUBIC, pr.alpha: alpha})


def _printed_derivatives(rows: tuple[sp.Matrix, ...], m: int, spans: tuple[Any, Any], alpha: Any = 1) -> Any:
    """Return P_u and P_uu at the contact when rows 1 and 2 are set as printed, k = k_r = 4, uniform u_i.

    `rows` are R_0, R_1, R_2 as vectors, `spans` the first two spans of the base across.
    """
    h = [sp.Rational(1, m - 2), sp.Rational(2, m - 2)]
    letters = {pr.R_0: 0, pr.R_1: 1, pr.R_2: 2}
    values = {pr.u_1: h[0], pr.w_kr: spans[0], pr.w_s: 0}
    coordinates = []
    for c in range(3):
        at = values | {symbol: rows[i][c] for symbol, i in letters.items()} | {pr.P_0: rows[0][c]}
        first = _printed_row(1, alpha).subs(at)
        second = _printed_row(2, alpha).subs(at | {pr.P_1: first})
        coordinates.append(end_derivatives(2, CUBIC - 1, h) * sp.Matrix([rows[0][c], first, second]))
    return tuple(sp.Matrix([column[d] for column in coordinates]) for d in (1, 2))


def _rows_across(kind: str) -> tuple[tuple[sp.Matrix, ...], sp.Matrix]:
    """Return R_0, R_1, R_2 at a point of the contact curve, symbolic, and the direction of the contact curve."""
    x = sp.symbols("x1 x2 y0 y1 y2 z2", real=True)
    along = sp.Matrix([0, 1, 0])
    if kind == "straight":  # planes, cylinders and cones along their rulings: all three on one line
        direction = sp.Matrix(sp.symbols("d_x d_y d_z", real=True))
        return (sp.zeros(3, 1), x[0] * direction, x[1] * direction), along
    if kind == "plane":
        return (sp.zeros(3, 1), sp.Matrix([x[0], x[3], 0]), sp.Matrix([x[1], x[4], 0])), along
    return (sp.zeros(3, 1), sp.Matrix([x[0], 0, 0]), sp.Matrix([x[1], 0, x[5]])), along


def curvature_cases(kind: str, m: int) -> Any:
    """Return the check of G2 with the conditions as printed: the parts of P_uu and alpha^4 R_ww along the normal."""

    def cases() -> Iterator[Case]:
        alpha = sp.Symbol("alpha", real=True, nonzero=True)
        h = sp.symbols("H1 H2", positive=True)
        rows, along = _rows_across(kind)
        _, second = _printed_derivatives(rows, m, h, alpha)
        r_first, r_second = _base_derivatives(rows, h)
        normal = r_first.cross(along)
        residual = sp.factor((second - alpha**4 * r_second).dot(normal))
        yield Case(f"any rows, {m + 1} curves", residual == 0, residual=residual)

    return cases


def parametric_cases(kind: str, m: int) -> Any:
    """Return the check of C2 with the conditions as printed and alpha = 1: P_uu - R_ww."""

    def cases() -> Iterator[Case]:
        h = sp.symbols("H1 H2", positive=True)
        rows, _ = _rows_across(kind)
        _, second = _printed_derivatives(rows, m, h)
        _, r_second = _base_derivatives(rows, h)
        residual = (second - r_second).applyfunc(sp.factor)
        shown = next((entry for entry in residual if entry != 0), sp.Integer(0))
        yield Case(f"any rows, {m + 1} curves", shown == 0, residual=shown)

    return cases


def _base_derivatives(rows: tuple[sp.Matrix, ...], spans: Any) -> tuple[sp.Matrix, sp.Matrix]:
    matrix = end_derivatives(2, CUBIC - 1, spans)
    return tuple(sum((matrix[d, i] * rows[i] for i in range(3)), sp.zeros(3, 1)) for d in (1, 2))


def true_rows_cases(kind: str, m: int) -> Any:
    """Return the check that the derived rows give P_uu = alpha^4 R_ww for the same bases."""

    def cases() -> Iterator[Case]:
        alpha = sp.Symbol("alpha", real=True, nonzero=True)
        H = sp.symbols("H1 H2", positive=True)
        h = [sp.Rational(1, m - 2), sp.Rational(2, m - 2)]
        rows, _ = _rows_across(kind)
        matrix = contact_rows(2, CUBIC - 1, h, CUBIC - 1, H).subs(A, alpha**2)
        blend = [sum((matrix[i, j] * rows[j] for j in range(3)), sp.zeros(3, 1)) for i in range(3)]
        ends = end_derivatives(2, CUBIC - 1, h)
        second = sum((ends[2, i] * blend[i] for i in range(3)), sp.zeros(3, 1))
        residual = (second - alpha**4 * _base_derivatives(rows, H)[1]).applyfunc(sp.cancel)
        yield Case("any rows", all(entry == 0 for entry in residual))

    return cases


def row_counterexample(kind: str, m: int, *, parametric: bool) -> Any:
    """Return a search for the smallest rows at which the printed conditions miss; unit spans of the base."""

    def search() -> Counterexample | None:
        from papers.search import smallest_assignment

        rows, along = _rows_across(kind)
        spans = (sp.Integer(1), sp.Integer(2))
        _, second = _printed_derivatives(rows, m, spans)
        r_first, r_second = _base_derivatives(rows, spans)
        symbols = sorted(set().union(*(row.free_symbols for row in rows)), key=str)

        def misses(at: dict[Any, Any]) -> bool:
            normal = r_first.subs(at).cross(along)
            difference = (second - r_second).subs(at)
            if normal.is_zero_matrix:
                return False
            return not difference.is_zero_matrix if parametric else difference.dot(normal) != 0

        found = smallest_assignment(symbols, misses)
        if found is None:
            return None
        spell = ", ".join(f"R_{i} = {tuple(row.subs(found))}" for i, row in enumerate(rows))
        wrong, true = (tuple(x.subs(found)) for x in (second, r_second))
        return Counterexample((("rows", spell), ("spans", "1, 2"), ("alpha", "1"), ("m", str(m))), f"P_uu = {wrong}",
                              f"R_ww = {true}")  # fmt: skip

    return search


def straight_counterexample(m: int) -> Any:
    """Return the search for rows on a straight line at which the printed C2 conditions miss, natural ones first.

    Rows at the Greville abscissae run along the line at constant speed; evenly spaced rows are what a user draws.
    """

    def search() -> Counterexample | None:
        missed = []
        for name, places in (("at the Greville abscissae, constant speed", (0, sp.Rational(1, 3), 1)),
                             ("evenly spaced", (0, 1, 2))):  # fmt: skip
            rows = tuple(sp.Matrix([place, 0, 0]) for place in places)
            spans = (sp.Integer(1), sp.Integer(2))
            printed, true = _printed_derivatives(rows, m, spans)[1][0], _base_derivatives(rows, spans)[1][0]
            if printed != true:
                missed.append((f"R_0, R_1, R_2 = {', '.join(map(str, places))} ({name})", printed, true))
        if not missed:
            return None
        (label, printed, true), *others = missed
        also = "; ".join(f"with {name} printed {wrong}, true {right}" for name, wrong, right in others)
        first = str(sp.Rational(1, m - 2))
        spans_of_r = ("knots of R after w_s", "w_s + 1, w_s + 2")
        values = (("rows on a line", label), spans_of_r, ("u_1", first), ("alpha", "1"))
        return Counterexample(values, f"P_uu = {printed}", f"R_ww = {true}", also=also)

    return search


def removable_cases() -> Iterator[Case]:
    """Yield coordinate functions over {1/3, 2/3}: can they be written over {1/2}? A spline space decides for all."""
    third, half = Fraction(1, 3), Fraction(1, 2)
    polynomial, own, wanted = clamped(CUBIC), clamped(CUBIC, third, 2 * third), clamped(CUBIC, half)
    yield Case("a plane with coordinates polynomial in v", contained(CUBIC, polynomial, wanted))
    yield Case("any plane patch over {1/3, 2/3}", contained(CUBIC, own, wanted), own=False, meets=False)


def hull_cases() -> Iterator[Case]:
    """Yield degrees n: f(t) of Hartmann's blend and 1 - f(t) are not negative on [0, 1] and sum to 1."""
    for n in (1, 2, 3):
        for mu in (Fraction(1, 2), Fraction(1, 3)):
            weights = [_hartmann(n, mu, t) for t in rational_points(0, 1, 9)]
            yield Case(f"n = {n}, mu = {mu}", all(0 <= w <= 1 for w in weights))


def reverse_cases() -> Iterator[Case]:
    """Yield degrees n: at t = 0 the blend X = f S1 + (1 - f) S2 leaves along S1 itself, X_t = S1_t."""
    t = sp.Symbol("t")
    for n in (1, 2, 3):
        f = _hartmann(n, sp.Rational(1, 2), t)
        slope = sp.diff(f, t).subs(t, 0)
        yield Case(f"n = {n}", f.subs(t, 0) == 1 and slope == 0)


def hartmann_contact_cases() -> Iterator[Case]:
    """Yield degrees n: f is 1 at 0 and 0 at 1, and its derivatives up to order n vanish at both."""
    t = sp.Symbol("t")
    for n in (1, 2, 3):
        f = _hartmann(n, sp.Rational(1, 3), t)
        flat = all(sp.diff(f, t, d).subs(t, end) == 0 for d in range(1, n + 1) for end in (0, 1))
        yield Case(f"n = {n}", flat and f.subs(t, 0) == 1 and f.subs(t, 1) == 0)


def hartmann_rational_cases(*, splines: bool) -> Any:
    """Return the check that the blend has no exact NURBS form: for B-spline bases it is a quotient of splines."""

    def cases() -> Iterator[Case]:
        t = sp.Symbol("t")
        f = sp.together(_hartmann(2, sp.Rational(1, 2), t))
        one = 1 + 2 * t - t**3 if splines else sp.sin(t)
        other = 3 - t**2
        numerator, denominator = sp.fraction(sp.together(f * one + (1 - f) * other))
        is_rational = numerator.is_polynomial(t) and denominator.is_polynomial(t)
        # A positive denominator is a positive weight function.
        positive = all(denominator.subs(t, sp.Rational(r, 8)) > 0 for r in range(9)) if is_rational else False
        yield Case("cubic pieces" if splines else "a base with a sine", not (is_rational and positive))

    return cases


def _hartmann(n: int, mu: Any, t: Any) -> Any:
    up, down = mu * (1 - t) ** (n + 1), (1 - mu) * t ** (n + 1)
    return up / (up + down)


def mean_curvature_cases() -> Iterator[Case]:
    """Yield that for a tangent-continuous join equal mean curvature along the contact means equal curvatures.

    L = N . P_uu is the only second-order quantity that can differ, and H depends on it with the factor G / 2(EG - F^2).
    """
    E, F, G, L, M, N = sp.symbols("E F G L M N", real=True)
    mean = (E * N - 2 * F * M + G * L) / (2 * (E * G - F**2))
    factor = sp.diff(mean, L)
    yield Case("H is linear in L", sp.diff(factor, L) == 0)
    yield Case("with a factor that is not zero", sp.simplify(factor - G / (2 * (E * G - F**2))) == 0)


def invisible_cases() -> Iterator[Case]:
    """Yield joins of one plane that are not C2: true where a normal or the mean curvature shows it."""
    u, v = sp.symbols("u v", real=True)
    for label, surface in (
        ("(-u - u^2, v, 0) after (w, v, 0)", sp.Matrix([-u - u**2, v, 0])),
        ("(-u, v + u^2 v, 0) after (w, v, 0)", sp.Matrix([-u, v + u**2 * v, 0])),
    ):
        # The other side, (w, v, 0), has second derivatives zero, normal (0, 0, 1) and no curvature.
        parametric = surface.diff(u, 2).subs(u, 0).is_zero_matrix
        normal = surface.diff(u).cross(surface.diff(v))
        bends = any(x.diff(y) != 0 for x in normal[:2] for y in (u, v))
        yield Case(label, bool(parametric or bends))


def hermite_cases() -> Iterator[Case]:
    """Yield degrees of a Bezier curve across: six conditions (value, two derivatives at both ends) need degree five."""
    for degree in range(2, 8):
        rows = sp.zeros(6, degree + 1)
        ones = (sp.Integer(1), sp.Integer(1))
        for d in range(3):
            for i in range(min(3, degree + 1)):
                entry = end_derivatives(2, degree, ones)[d, i]
                rows[d, i] += entry
                rows[3 + d, degree - i] += (-1) ** d * entry
        yield Case(f"degree {degree}", bool(rows.rank() == 6) == (degree >= 5))


def quartic_cases() -> Iterator[Case]:
    """Yield a Bezier curve of degree four: true where it misses points, tangents or curvatures that are prescribed.

    Prescribed: from (0, 0) along (1, 0) to (2, 1) along (0, 1), of curvature 1 at both ends.
    """
    points = [sp.Matrix(p) for p in ((0, 0), (sp.Rational(1, 2), 0), (sp.Rational(5, 3), sp.Rational(1, 3)),
                                     (2, sp.Rational(1, 2)), (2, 1))]  # fmt: skip
    t = sp.Symbol("t")
    curve = sum((sp.binomial(4, i) * t**i * (1 - t) ** (4 - i) * p for i, p in enumerate(points)), sp.zeros(2, 1))
    misses = []
    for end, place, tangent in ((0, (0, 0), (1, 0)), (1, (2, 1), (0, 1))):
        at, first, second = (curve.diff(t, d).subs(t, end) if d else curve.subs(t, end) for d in range(3))
        speed = sp.sqrt(first.dot(first))
        curvature = first.row_join(second).det() / speed**3
        misses += [*(at - sp.Matrix(place)), *(first / speed - sp.Matrix(tangent)), curvature - 1]
    label = "the quartic with points (0, 0), (1/2, 0), (5/3, 1/3), (2, 1/2), (2, 1) has all that G2 asks for"
    yield Case(label, any(sp.simplify(x) != 0 for x in misses))


def cubic_cases() -> Iterator[Case]:
    """Yield a cubic with two inner knots or more: six conditions at its ends are independent."""
    for m in (5, 6, 7):
        h = [sp.Rational(1, m - 2), sp.Rational(2, m - 2)]
        yield Case(f"{m + 1} rows", end_derivatives(2, 3, h).det() != 0)


def bending_cases(*, saddle: bool) -> Any:
    """Return the check that kappa_1^2 + kappa_2^2 is 4 H^2: for kappa_2 = 0, or for any principal curvatures."""

    def cases() -> Iterator[Case]:
        first, second = sp.symbols("kappa_1 kappa_2", real=True)
        other = second if saddle else sp.Integer(0)
        residual = sp.expand(first**2 + other**2 - (first + other) ** 2)
        yield Case("any kappa_2" if saddle else "kappa_2 = 0", bool(residual == 0), residual=residual)

    return cases


def circle_cases() -> Iterator[Case]:
    """Yield rolling balls of radius r on bases of curvature c: the circle has curvature 1/r; jump |1/r - c|."""
    for radius, curvature in ((1, 0), (2, 0), (2, Fraction(1, 3)), (2, Fraction(1, 2))):
        jump = Fraction(1, radius) - Fraction(curvature)
        special = Fraction(curvature) == Fraction(1, radius)
        yield Case(f"r = {radius}, base curvature {curvature}", jump != 0, own=not special, meets=not special)
