"""The energy (11), its minimum, the system (14), degrees after substitution."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.contact import contact_rows
from semispline.derivations.energy import ExactSurface, energy_matrix, gram_block, gram_matrix, thin_plate_density
from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import Claim, Formula, Meaning, as_fraction, given, interpret
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.appendix import PLANES, special_contact
from semispline.papers.lin2014.certificates.contact import INDUCTION, closed_derivative, induction
from semispline.papers.lin2014.certificates.surfaces import INDUCTION as RECURRENCE
from semispline.papers.lin2014.certificates.surfaces import SPACES, insertion, nested_pairs, sharp_continuity
from semispline.papers.lin2014.checks import energy, objective
from semispline.papers.lin2014.checks import fewer_control_points as fewer
from semispline.papers.lin2014.checks.printed_pairs import PRINTED_PAIRS, inner_knots
from semispline.papers.recheck import (
    Draft,
    Statement,
    Term,
    Text,
    as_text,
    different,
    identity,
    integral,
    integrals,
    minimum,
    positive,
    rank,
    text,
    total,
)

NO_ENERGY = "the integral of a square vanishes only where the function does; basis functions are independent"
LEAST = "the least energy of a strip is at the solution of its normal equation"
CURVATURES = "principal curvatures are the eigenvalues of [P_uu, P_uv; P_uv, P_vv] where lengths and angles are kept"
UNROLLED = "the sums are unrolled for three pairs of counts; more terms are alike"
FUBINI = "the integral of a function of u times one of v is a product of integrals"


def density(claim: Claim) -> Draft:
    """Return the integrand of (11), and where zero energy means no bend."""
    printed = claim.formulas[0].relation.rhs
    turned = (
        ("c", "(1 - t^2)/(1 + t^2)"),
        ("s", "2*t/(1 + t^2)"),
        ("A_uu", "c^2*P_uu - 2*c*s*P_uv + s^2*P_vv"),
        ("A_uv", "c*s*P_uu + (c^2 - s^2)*P_uv - c*s*P_vv"),
        ("A_vv", "s^2*P_uu + 2*c*s*P_uv + c^2*P_vv"),
    )
    there = printed.subs({s: sp.Symbol(f"A_{s.name[2:]}") for s in (pr.P_uu, pr.P_uv, pr.P_vv)}, simultaneous=True)
    cases: list[Statement] = [
        identity("the derived density", Text(f"({text(printed)})*1", 2), thin_plate_density()),
        *curvatures(Text("kappa_1^2 + kappa_2^2", 1), printed),
        identity("rotation by every angle, t the tangent of its half", there, printed, where=turned),
        *sharp_continuity(own=False),
        line(),
    ]
    half = Fraction(1, 2)
    for label, space, meets in (
        ("cubic, single knot 1/2", energy.basis(4, half), True),
        ("cubic, double knot 1/2", energy.basis(4, half, half), True),
        ("cubic, triple knot 1/2 (a crease is possible)", energy.basis(4, half, half, half), False),
        ("linear, knot 1/2 (a roof)", energy.basis(2, half), False),
    ):
        gram = gram_matrix(2, space, space)
        own: dict[str, Any] = {"own": meets, "meets": meets}
        cases += gram_entries(label, 2, space, own=False) if meets else ()
        cases.append(
            rank(f"{label}: what costs nothing has dimension {2 if meets else 3}", gram, affirmed=meets, **own)
        )
    return Draft([cases], believed=(RECURRENCE, NO_ENERGY, CURVATURES))


def gram_entries(label: str, d: int, space: Any, **flags: Any) -> Iterator[Statement]:
    """Yield entries of a derived Gram matrix against integrals of the recursion's polynomials."""
    gram = gram_matrix(d, space, space)
    knots = [as_fraction(knot) for knot in space.knots]
    order = len(knots) - space.size
    for i in range(space.size):
        for j in range(i, space.size):
            true = integral(order, (knots, i, d), (knots, j, d))
            yield identity(
                f"{label}: entry {i}, {j} by the recursion", Text(f"{text(gram[i, j])} + 0", 1), true, **flags
            )


def line() -> Statement:
    """Return that lines which meet at a knot with one slope are one."""
    return identity(
        "lines that meet with one slope are one",
        Text("a + b*x", 1),
        Text("c + d*x", 1),
        where=(("b", "d"), ("a", "c + d*h - b*h")),
        own=False,
    )


def strain(claim: Claim) -> Draft:
    """Return the integrand of the strain energy, without and with the area element."""

    def cases(formula: Formula, *, equal: bool) -> list[Statement]:
        printed = formula.relation.rhs
        scaled = as_text(printed.subs(pr.area, sp.Symbol("c") * pr.area))
        usual = printed.subs(pr.area, 1)
        return [
            identity("u replaced by u / c", scaled / Text("c"), printed, equal=equal),
            identity("unit area element", Text(f"({text(usual)})*1", 2), Text("kappa_1^2 + kappa_2^2", 1)),
        ]

    first, second = (given(reading.parts[0].formula) for reading in claim.readings)
    return Draft([cases(first, equal=False), cases(second, equal=True)], cases(claim.corrected_formulas[0], equal=True))


def curvatures(squares: Any, plate: Any, **flags: Any) -> list[Statement]:
    """Return the sum of squared curvatures by their sum and product, which are trace and determinant."""
    where = (("S", "P_uu + P_vv"), ("Q", "P_uu*P_vv - P_uv^2"))
    both = Text("(kappa_1 + kappa_2)^2 - 2*(kappa_1*kappa_2)", 1)
    return [
        identity("by sum and product of the curvatures", squares, both, **flags),
        identity("which are trace and determinant", Text("S^2 - 2*Q", 1), plate, where=where, **flags),
    ]


def thin_plate(claim: Claim) -> Draft:
    """Return (11) as the strain energy where lengths and angles are kept, and plane pieces where they are not."""
    relation = given(claim.readings[0].parts[0].formula).relation
    kept = curvatures(relation.lhs, relation.rhs)
    flat: list[Statement] = [
        different(
            "the square as (u + c u^2, v, 0): P_uu = 2 c",
            relation.rhs,
            0,
            where=(("P_uu", "2*c"), ("P_uv", "0"), ("P_vv", "0")),
        ),
        different(
            "the square as (u, v + c u v, 0): P_uv = c",
            relation.rhs,
            0,
            where=(("P_uu", "0"), ("P_uv", "c"), ("P_vv", "0")),
        ),
    ]
    return Draft([kept, flat], believed=(CURVATURES,))


def one_minimum(order: int) -> Iterator[Statement]:
    """Yield why the free rows have one minimum, and pivots of exact energy matrices."""
    yield positive(
        "(11) is a sum of squares",
        thin_plate_density(),
        strict=False,
        own=False,
        over=[Term(coefficient=c, squares=(s,)) for c, s in (("1", "P_uu"), ("2", "P_uv"), ("1", "P_vv"))],
    )
    ends = end_derivatives(1, pr.k - 1, span_symbols(1))
    determinant = as_text(ends[0, 0]) * as_text(ends[1, 1]) - as_text(ends[0, 1]) * as_text(ends[1, 0])
    yield positive(
        "P and P_u at u = 0 determine rows 0 and 1",
        determinant,
        where=(("k", "2 + r"),),
        positive=("h1",),
        nonnegative=("r",),
        own=False,
    )
    yield from induction()
    yield line()
    for m in (6, 7, 8):
        block = _free_block(m, order)
        yield minimum(f"C{order}, {m + 1} rows, {block.rows} unknown control points", block)


@cache
def _free_block(m: int, order: int) -> Any:
    rows = energy.layout().curves
    surface = ExactSurface(energy.u_basis(4, m), (*rows[:3], *[rows[3]] * (m - 5), *rows[-3:]))
    matrix = energy_matrix(surface)
    free = [n for n, (i, _) in enumerate(surface.index) if i in energy.free_rows(m, order)]
    return matrix.extract(free, free)


def plates() -> Iterator[Statement]:
    """Yield the energy of strips between plates as a quadratic in a, b around its least point, and where that lies."""
    a, b = sp.symbols("a b", real=True)
    gap = sp.Symbol("d", positive=True)
    for label, distance, into, meets in (
        ("plates that face each other, over every gap", gap, 1, True),
        ("plates that face each other over a gap of 2", sp.Integer(2), 1, True),
        ("plates that face each other over a gap of 1", sp.Integer(1), 1, True),
        ("parallel plates, the blend turns round by 180 degrees", sp.Integer(0), -1, False),
    ):
        strip = energy.end_energy(4, 6, (0, a, 0, distance, into * b, 0))
        best = sp.solve([sp.diff(strip, a), sp.diff(strip, b)], [a, b], dict=True)[0]
        form = sp.hessian(strip, (a, b)) / 2
        moved = as_text(strip.subs({a: best[a] + sp.Symbol("x"), b: best[b] + sp.Symbol("y")}, simultaneous=True))
        least = as_text(strip.subs(best, simultaneous=True))
        square = Text(f"({text(form[0, 0])})*x^2 + 2*({text(form[0, 1])})*x*y + ({text(form[1, 1])})*y^2", 1)
        yield identity(f"{label}: the energy around its least point", moved - least, square, own=False)
        yield minimum(f"{label}: which is one", form, own=False)
        for letter in (a, b):
            if meets:
                yield positive(f"{label}: {letter} is positive there", best[letter], positive=("d",))
            else:
                yield identity(
                    f"{label}: {letter} is 0 there",
                    Text(f"{text(best[letter])} + 0", 1),
                    0,
                    wanted=False,
                    own=False,
                    meets=False,
                )


def problem(_: Claim) -> Draft:
    """Return both readings of the minimisation."""
    shape = [*special_contact(1), *plates()]
    return Draft([one_minimum(2), shape], believed=(INDUCTION, NO_ENERGY, PLANES))


def unconstrained(_: Claim) -> Draft:
    """Return where alpha, beta of the least energy lie."""
    return Draft([[*special_contact(1), *plates()]], believed=(PLANES,))


def normal_equation(order: int) -> Callable[[Claim], Draft]:
    """Return the draft of the linear system: the derivative of the quadratic form, unrolled for some counts."""

    def draft(claim: Claim) -> Draft:
        relation = claim.formulas[0].relation
        cases: list[Statement] = []
        for free, known in ((1, 1), (2, 1), (2, 3)):
            points = [f"x{i}" for i in range(free)] + [f"n{i}" for i in range(known)]

            def entry(i: int, j: int) -> str:
                return f"K_{min(i, j)}_{max(i, j)}"

            for r in range(free):

                def energy_at(shift: str, r: int = r, points: list[str] = points) -> str:
                    values = [f"({p} {shift})" if i == r else p for i, p in enumerate(points)]
                    return " + ".join(
                        f"{entry(i, j)}*{values[i]}*{values[j]}" for i in range(len(values)) for j in range(len(values))
                    )

                slope = Text(f"(({energy_at('+ e')}) - ({energy_at('- e')}))/(4*e)", 2)
                functions = {
                    "A": lambda i, j: Text(entry(int(i), int(j))),
                    "B": lambda i, j, free=free: Text(entry(int(i), free + int(j))),
                    "X": lambda j: Text(f"x{int(j)}"),
                    "N": lambda j: Text(f"n{int(j)}"),
                }
                numbers = {objective.ROW: r, objective.LAST_FREE: free - 1, objective.LAST_KNOWN: known - 1}
                left, right = (interpret(side, Meaning(numbers, functions)) for side in relation.args)
                label = f"{free} free and {known} known control points, row {r}: half the slope of the energy"
                cases.append(identity(label, slope, left - right))
        believed = (INDUCTION, NO_ENERGY, UNROLLED)
        return Draft([[*cases, *one_minimum(order)]], believed=believed)

    return draft


_PAIRS = (((3, 0), (3, 0)), ((3, 1), (3, 1)), ((3, 2), (3, 2)), ((3, 1), (3, 3)), ((3, 2), (2, 1)), ((3, 3), (4, 2)))


@cache
def _true_entries() -> dict[tuple[tuple[int, int], tuple[int, int]], tuple[Any, dict[Any, Any]]]:
    """Return entries of the derived matrix, and the letters of (14) with values by the recursion."""
    surface = energy.layout()
    matrix = energy_matrix(surface)
    index = list(surface.index)
    u = [as_fraction(x) for x in surface.u.knots]
    vectors = [[as_fraction(x) for x in curve.knots] for curve in surface.curves]
    found = {}
    for one, other in _PAIRS:
        (i, j), (k, at) = one, other
        mine, theirs = vectors[i], vectors[k]
        values = {}
        for letter, d in zip((pr.A_0, pr.A_1, pr.A_2), range(3), strict=True):
            values[letter] = integral(4, (u, i, d), (u, k, d))
        values[pr.A_10] = integral(4, (u, i, 1), (u, k, 0))
        for letter, d in zip((pr.G_0, pr.G_1, pr.G_2), range(3), strict=True):
            values[letter] = integral(4, (mine, j, d), (theirs, at, d))
        values[pr.G_12] = integral(4, (mine, j, 1), (theirs, at, 2))
        for (row, point, knots), letters_ in (
            ((i, j, mine), (pr.a_1, pr.b_1, pr.c_1)),
            ((k, at, theirs), (pr.a_2, pr.b_2, pr.c_2)),
        ):
            across = [integral(4, (u, row, d)) for d in range(3)]
            along = [integral(4, (knots, point, d)) for d in range(3)]
            products = across[2] * along[0], across[0] * along[2], across[1] * along[1]
            values |= dict(zip(letters_, products, strict=True))
        found[one, other] = matrix[index.index(one), index.index(other)], values
    return found


def entry_cases(formula: Formula, *, equal: bool) -> Iterator[Statement]:
    """Yield entries over the knots of Fig. 5: by the formula, with integrals by the recursion, and as derived."""
    for (one, other), (true, values) in _true_entries().items():
        where = tuple((text(letter), text(number)) for letter, number in values.items())
        label = f"control points {one[0]},{one[1]} and {other[0]},{other[1]}"
        holds = (
            equal
            or formula.relation.rhs.subs({s: sp.Rational(x.numerator, x.denominator) for s, x in values.items()})
            == true
        )
        yield identity(label, formula.relation.rhs, true, where=where, equal=holds)


def gram_general(formula: Formula, *, equal: bool = True) -> Iterator[Statement]:
    """Yield an entry for any two control points: half the mixed difference of the density, which is quadratic."""
    products = (
        ("A_0", "N0*M0"),
        ("A_1", "N1*M1"),
        ("A_2", "N2*M2"),
        ("A_10", "N1*M0"),
        ("G_0", "B0*D0"),
        ("G_1", "B1*D1"),
        ("G_2", "B2*D2"),
        ("G_12", "B1*D2"),
    )
    mixed: Text | None = None
    for sign, x, y in ((1, "1", "1"), (-1, "1", "0"), (-1, "0", "1"), (1, "0", "0")):
        parts = {
            f"P_{name}": f"({x}*N{d}*B{e} + {y}*M{d}*D{e})" for name, d, e in (("uu", 2, 0), ("uv", 1, 1), ("vv", 0, 2))
        }
        value = text(thin_plate_density())
        for name, part in parts.items():
            value = value.replace(name, part)
        term = Text(f"({value})", 4)
        mixed = term if mixed is None else mixed + term if sign > 0 else mixed - term
    assert mixed is not None
    names = {"A0": pr.A_0, "A1": pr.A_1, "A2": pr.A_2, "G0": pr.G_0, "G1": pr.G_1, "G2": pr.G_2}
    block = gram_block().subs({sp.Symbol(name): letter for name, letter in names.items()})
    yield identity(
        "any two basis functions of any orders and knots", formula.relation.rhs, mixed / 2, where=products, equal=equal
    )
    yield identity("the derived entry", Text(f"({text(formula.relation.rhs)})*1", 2), block, equal=equal)


def corrected_entry(claim: Claim) -> list[Statement]:
    """Return the entry of A and B that is right."""
    formula = claim.corrected_formulas[0]
    return [*gram_general(formula), *entry_cases(formula, equal=True)]


def equation_14(claim: Claim) -> Draft:
    """Return (14) as printed: entries, what is left of them where a_ij = c_ij = 0, and why that is so."""
    formula = claim.formulas[0]
    zero = tuple((text(letter), "0") for letter in (pr.a_1, pr.a_2, pr.c_1, pr.c_2))
    cases: list[Statement] = [*entry_cases(formula, equal=False)]
    cases.append(identity("every entry of A where a_ij = c_ij = 0", formula.relation.rhs, 0, where=zero, wanted=False))
    size = len([1 for i, _ in energy.layout().index if i == 3])
    cases.append(rank(f"{size} unknown control points, rank 0", sp.zeros(size, size), affirmed=False))
    u = [as_fraction(x) for x in energy.layout().u.knots]
    for d in (1, 2):
        spans = total(x for x in integrals(4, (u, 3, d)) if x)
        cases.append(identity(f"derivative {d} of function 3 integrates to zero, span by span", spans, 0, own=False))
    return Draft([[*cases, *induction()]], corrected_entry(claim), (INDUCTION, FUBINI))


def printed_entries(*, general: bool) -> Callable[[Claim], Draft]:
    """Return the draft of another reading of (14)."""

    def draft(claim: Claim) -> Draft:
        formula = claim.formulas[0]
        cases: list[Statement] = [*entry_cases(formula, equal=False)]
        if general:
            cases += gram_general(formula, equal=False)
        return Draft([cases], corrected_entry(claim), (FUBINI,))

    return draft


def top_terms(order: int) -> Iterator[Statement]:
    """Yield rows 1 (and 2) as polynomials in a, their top coefficient a multiple of R_w (of R_ww)."""
    yield from induction()
    h, base = span_symbols(order), span_symbols(2, "H")
    rows = contact_rows(order, pr.k - 1, h, pr.k_r - 1, base[:order])
    where = (("R_w", str(closed_derivative("start", "base", 1))), ("R_ww", str(closed_derivative("start", "base", 2))))
    first = "R_0j - a*h1/(k - 1)*R_w"
    second = "R_0j - a*(h1 + h2)/(k - 1)*R_w + a^2*h1*h2/((k - 1)*(k - 2))*R_ww"
    for row, polynomial in list(enumerate((first, second), start=1))[:order]:
        derived = total(
            as_text(rows[row, j]) * as_text(letter) for j, letter in enumerate((pr.R_0, pr.R_1, pr.R_2)[: order + 1])
        )
        yield identity(
            f"row {row} as a polynomial in a = alpha^2, every order", derived, Text(polynomial, 1), where=where
        )


def degree_draft(order: int, *, geometric: bool) -> Callable[[Claim], Draft]:
    """Return the draft of the degree of the objective."""

    def draft(claim: Claim) -> Draft:
        printed = claim.formulas[0].relation.rhs
        seconds = Text("(z*P_uu)^2 + 2*(z*P_uv)^2 + (z*P_vv)^2", 1)
        cases: list[Statement] = [
            identity("(11) is quadratic", seconds, Text("z^2", 3) * as_text(thin_plate_density()), own=False)
        ]
        if not geometric:
            cases += [
                identity("quadratic in points that enter linearly", f.relation.rhs, Text("2*1", 2))
                for f in claim.formulas
            ]
            return Draft([cases])
        cases += top_terms(order)
        cases.append(identity("twice the power of alpha in the rows", printed, Text(f"2*(2*{order})", 2)))
        if order == 2:
            flat = ("R_2j", "R_1j + (R_1j - R_0j)*H2/H1")
            cases.append(
                identity("a base with R_ww = 0", closed_derivative("start", "base", 2), 0, where=(flat,), own=False)
            )
            cases.append(
                different("then the power in the rows is lower", printed, Text("2*(2*1)", 2), own=False, meets=False)
            )
        return Draft([cases], believed=(INDUCTION, NO_ENERGY))

    return draft


def fewer_rows(claim: Claim) -> Draft:
    """Return least energies without and with a middle curve, and their difference as a sum of two squares."""
    cases: list[Statement] = []
    for label, data in (
        ("a step at rest", (0, 0, 0, 1, 0, 0)),
        ("a slope that stops", (0, 1, 0, 0, 0, 0)),
        ("curvature at both ends", (0, 0, 1, 0, 0, 1)),
    ):
        few, more = fewer.least_energies(*map(sp.Integer, data)).values()
        if few > more:
            cases.append(
                positive(f"{label}: 6 rows cost more than 7", Text(f"{text(few)} - {text(more)}", 1), affirmed=False)
            )
        else:
            cases.append(positive(f"{label}: 6 rows cost no more than 7", Text(f"{text(more)} - {text(few)} + 1", 1)))
    squares, nested = claim.corrected_formulas
    few, more = fewer.least_energies(*fewer.DATA).values()
    correction: list[Statement] = [
        identity("any contact data", squares.relation.rhs, as_text(few) - as_text(more)),
        positive("which is never negative", squares.relation.rhs, over=_squares(squares.relation.rhs), strict=False),
    ]
    value = "c + 2*g*x + h*x^2"
    correction.append(
        identity(
            "one control point more: value at 0 less value at -g/h",
            nested.relation.rhs,
            Text(f"c - ({value})", 1),
            where=(("x", "-g/h"),),
        )
    )
    return Draft([cases], correction, (LEAST,))


def _squares(expression: Any) -> list[Term]:
    return [
        Term(coefficient=text(c), squares=(text(sp.Mul(*rest).base),))
        for c, rest in (term.as_coeff_mul() for term in sp.Add.make_args(expression))
    ]


def fairness(_: Claim) -> Draft:
    """Return knot lines in the printed pairs, and least energies over the rule's knots and over all."""
    lines: list[Statement] = []
    for name, keys in PRINTED_PAIRS.items():
        vectors = [set(inner_knots(key)) for key in keys]
        both = len(set.union(*vectors))
        lines += [
            positive(f"{name}: {both} inner knots against {len(v)}", Text(f"{both} - {len(v)}", 1)) for v in vectors
        ]
    own, refined = energy.middle_knot_energies()
    less = positive(
        "orders 4, 2, inner knots 1/2 and 1/3: less energy on all knots",
        Text(f"{text(own)} - {text(refined)}", 1),
        affirmed=False,
    )
    return Draft([lines, [less, *insertion(), *nested_pairs()]], believed=(RECURRENCE, SPACES))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "eq-11": density,
    "eq-12": problem,
    "sec-3.strain-energy": strain,
    "sec-3.thin-plate": thin_plate,
    "sec-1.fairness": fairness,
    "sec-4.quadratic": degree_draft(2, geometric=False),
    "sec-4.normal-equation": normal_equation(2),
    "sec-4.c1-similarly": normal_equation(1),
    "sec-4.g1-degree": degree_draft(1, geometric=True),
    "sec-4.g2-degree": degree_draft(2, geometric=True),
    "sec-4.unconstrained": unconstrained,
    "eq-14": equation_14,
    "sec-4.single-integrals": printed_entries(general=False),
    "sec-4.third-term": printed_entries(general=True),
}
