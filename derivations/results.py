"""Derived results by name, for whoever wants to quote one: as equations, and as code where they are code."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from sympy import Add, Eq, Expr, Mul, Poly, Symbol, collect, expand, factor, latex, sstr, sympify

from semispline.derivations import chains, contact, energy, fairness, homogeneous, linear_alpha, shape, splines
from semispline.derivations.codegen import catalogue
from semispline.derivations.codegen.c_backend import c_function
from semispline.derivations.codegen.expressions import expression_text
from semispline.derivations.codegen.python_backends import CASADI, NUMPY, python_text
from semispline.derivations.codegen.routines import Argument, Routine, plain_symbols

Form = Literal["text", "latex", "numpy", "casadi", "c"]
FORMS: tuple[Form, ...] = ("text", "latex", "numpy", "casadi", "c")


@dataclass(frozen=True)
class Request:
    """What is asked of a result; each result uses what concerns it.

    Parameters
    ----------
    order : int
        Order of contact, or highest derivative, 0..4.
    degree, base_degree : int or None
        p and q; symbols where None (3 where a number is needed).
    knots, other_knots : tuple of str or None
        Knot vectors: numbers, fractions, names.
    other_degree : int or None
        Degree over `other_knots`.
    breakpoints : tuple of str or None
        Ascending order of all knots, where both vectors hold names.
    derivative : int
        Of the basis functions in Gram entries.
    end : {"start", "end"}
        Where derivatives are taken.
    """

    order: int = 2
    degree: int | None = None
    base_degree: int | None = None
    knots: tuple[str, ...] | None = None
    other_knots: tuple[str, ...] | None = None
    other_degree: int | None = None
    breakpoints: tuple[str, ...] | None = None
    derivative: int = 0
    end: str = "start"

    def __post_init__(self) -> None:
        if not 0 <= self.order <= catalogue.MAX_ORDER:
            raise ValueError(f"order: found {self.order}, expected 0..{catalogue.MAX_ORDER}")
        for name in ("degree", "base_degree", "other_degree"):
            value = getattr(self, name)
            if value is not None and value < 1:
                raise ValueError(f"{name}: found {value}, expected at least 1")
        if self.derivative < 0:
            raise ValueError(f"derivative: found {self.derivative}, expected at least 0")


@dataclass(frozen=True)
class Result:
    """Equations, and the routine that computes them where there is one."""

    equations: tuple[tuple[Expr, Expr], ...]
    routine: Routine | None = None


def show(name: str, request: Request, form: Form = "text") -> str:
    """Return a derived result as text that ends with a newline.

    Parameters
    ----------
    name : str
        One of `RESULTS`.
    request : Request
    form : str
        One of `FORMS`.

    Raises
    ------
    ValueError
        A name, form or request that cannot be met, saying what could be.

    Examples
    --------
    >>> print(show("special-conditions", Request(order=1)), end="")
    P = R
    P_u = -R_w * a
    """
    if name not in RESULTS:
        raise ValueError(f"{name}: no such result; there are {', '.join(RESULTS)}")
    if form not in FORMS:
        raise ValueError(f"form: found {form}, expected one of {', '.join(FORMS)}")
    result = RESULTS[name].build(request)
    if form == "text":
        return "".join(f"{_plain(left)} = {_plain(right)}\n" for left, right in result.equations)
    if form == "latex":
        return _latex(result.equations)
    if result.routine is None:
        raise ValueError(f"{name}: is a formula, not a function; expected form text or latex, found {form}")
    if form == "c":
        return c_function(result.routine)
    return python_text([result.routine], NUMPY if form == "numpy" else CASADI)


def _plain(expression: Expr) -> str:
    try:
        return expression_text(expression)
    except ValueError:
        return str(sstr(expression))


def _latex(equations: tuple[tuple[Expr, Expr], ...]) -> str:
    if len(equations) == 1:
        return f"{latex(Eq(*equations[0], evaluate=False))}\n"
    lines = [f"{latex(left)} &= {latex(right)}" for left, right in equations]
    return "\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}\n"


def _derivative_name(letter: str, by: str, order: int) -> Symbol:
    return Symbol(f"{letter}_{by * order}" if order else letter)


def _combination(row: Sequence[Expr], points: Sequence[Symbol], positive: int = 0) -> Expr:
    """Return sum_j row[j] points[j] as common factors times a combination.

    `positive` is 0 or -1: which of the coefficients that are not zero, the first or the last, is written positive.
    """
    value = factor(sum((entry * point for entry, point in zip(row, points, strict=True)), sympify(0)))
    common, combination = value.as_independent(*points, as_Add=False)
    poly = Poly(combination, *points)
    sign = -1 if poly.coeffs()[positive].could_extract_minus_sign() else 1
    terms = []
    for point in points:
        coefficient = factor(sign * poly.coeff_monomial(point))
        # Written out, so that a minus sign stands before the product and not inside its brackets.
        negative = coefficient.could_extract_minus_sign()
        terms.append(Mul(-1, point, -coefficient) if negative else point * coefficient)
    return sign * common * Add(*terms)


def _end_derivatives(request: Request) -> Result:
    routine = catalogue.end_derivative_routine(request.order, request.degree, request.end)
    rows = [f"P_{i}" if request.end == "start" else f"P_{{m-{i}}}" if i else "P_m" for i in range(request.order + 1)]
    points = [Symbol(name) for name in rows]
    # Differences are written forwards: P_1 - P_0.
    positive = -1 if request.end == "start" else 0
    equations = tuple(
        (_derivative_name("P", "u", d), _combination(row, points, positive)) for d, row in enumerate(routine.values)
    )
    return Result(equations, routine)


def _contact_conditions(request: Request) -> Result:
    conditions = contact.contact_conditions(request.order)
    equations = tuple((_derivative_name("P", "u", d), value) for d, value in enumerate(conditions))
    return Result(equations, catalogue.conditions_routine(request.order) if request.order else None)


def _special_conditions(request: Request) -> Result:
    conditions = plain_symbols(contact.special_conditions(request.order))
    return Result(tuple((_derivative_name("P", "u", d), value) for d, value in enumerate(conditions)))


def _shape_conditions(request: Request) -> Result:
    conditions = plain_symbols(contact.shape_conditions(request.order))
    return Result(tuple((_derivative_name("P", "u", d), value) for d, value in enumerate(conditions)))


def _homogeneous_conditions(request: Request) -> Result:
    order = request.order
    names = [tuple(_derivative_name(letter, "w", k) for k in range(order + 1)) for letter in ("X", "omega")]
    conditions = homogeneous.homogeneous_conditions(order, *names)
    return Result(
        tuple(
            (_derivative_name(letter, "u", k), value)
            for k, row in enumerate(conditions)
            for letter, value in zip(("Y", "W"), row, strict=True)
        )
    )


def _last_rung(request: Request) -> Result:
    jets, weights = homogeneous.last_rung(request.order)
    equations = [(Symbol(f"Y_{k}"), value) for k, value in enumerate(jets)]
    return Result((*equations, *((Symbol(f"W_{k}"), value) for k, value in enumerate(weights))))


def _strip_derivatives(request: Request) -> Result:
    return Result(tuple((Symbol(f"J_{j}"), value) for j, value in enumerate(chains.strip_derivatives(request.order))))


def _joint_values(request: Request) -> Result:
    return Result(tuple(chains.joint_values(request.order).items()))


def _joint_slopes(request: Request) -> Result:
    return Result(tuple(chains.joint_slopes(request.order).items()))


def _contact_rows(request: Request) -> Result:
    routine = catalogue.contact_routine(request.order, request.degree, request.base_degree)
    points = [Symbol(f"R_{j}") for j in range(request.order + 1)]
    a = Symbol("a")
    equations = []
    for i, row in enumerate(routine.values):
        # One summand for each power of a: a combination of differences of rows.
        powers = [Poly(entry, a, domain="EX").all_coeffs()[::-1] for entry in row]
        total = sympify(0)
        for k in range(i + 1):
            coefficients = [power[k] if k < len(power) else sympify(0) for power in powers]
            total += a**k * _combination(coefficients, points) if any(coefficients) else 0
        equations.append((Symbol(f"P_{i}"), total))
    return Result(tuple(equations), routine)


def _contact_jets(request: Request) -> Result:
    return _in_derivatives(catalogue.jets_routine(request.order, request.degree), "R", "w")


def _derivative_rows(request: Request) -> Result:
    return _in_derivatives(catalogue.derivative_rows_routine(request.order, request.degree), "P", "u")


def _in_derivatives(routine: Routine, letter: str, by: str) -> Result:
    derivatives = [_derivative_name(letter, by, d) for d in range(len(routine.values))]
    values = (sum((e * r for e, r in zip(row, derivatives, strict=True)), sympify(0)) for row in routine.values)
    return Result(tuple((Symbol(f"P_{i}"), value) for i, value in enumerate(values)), routine)


def _linear_power(request: Request) -> Result:
    s = linear_alpha.S
    terms = [row for row in linear_alpha.linear_powers(request.order) if row[0] == request.order]
    values = (c * linear_alpha.A0**i0 * linear_alpha.A1**i1 * (1 - s) ** i0 * s**i1 for _, i0, i1, c in terms)
    return Result(((Symbol("a") ** request.order, sum(plain_symbols(tuple(values)), sympify(0))),))


def _linear_product(request: Request) -> Result:
    basis = _basis(request)
    ends = Symbol("g0"), Symbol("g1")
    matrix = linear_alpha.linear_product(basis.degree, basis.knots, *ends)
    points = [Symbol(f"P_{i}") for i in range(matrix.cols)]
    equations = []
    for j in range(matrix.rows):
        row = (collect(expand(value), ends, factor) for value in matrix.row(j))
        equations.append((Symbol(f"Q_{j}"), sum((e * p for e, p in zip(row, points, strict=True)), sympify(0))))
    return Result(tuple(equations))


def _basis(request: Request) -> energy.Basis:
    return _as_basis(request.degree or 3, request.knots, "h")


def _as_basis(degree: int, knots: tuple[str, ...] | None, length: str) -> energy.Basis:
    return energy.Basis(degree, knots or ("0",) * (degree + 1) + (length,) * (degree + 1))


def _basis_pieces(request: Request) -> Result:
    basis = _basis(request)
    equations, rows = [], []
    for number, span in enumerate(basis.spans):
        values = [piece.as_expr() for piece in span.pieces]
        values = [factor(value) for value in values]
        rows.append(tuple(values))
        equations += [(Symbol(f"N_{span.first + r}^{number}"), value) for r, value in enumerate(values)]
    title = f"Pieces of the basis of degree {basis.degree}: entry [s, r] is function s' + r on span s, s' its first."
    return Result(tuple(equations), _knot_routine("basis_pieces", title, rows, first=splines.X))


def _gram(request: Request) -> Result:
    first = _basis(request)
    second = first
    if request.other_knots or request.other_degree:
        second = _as_basis(request.other_degree or first.degree, request.other_knots or request.knots, "h")
    matrix = energy.gram_matrix(request.derivative, first, second, request.breakpoints)
    equations = tuple((Symbol(f"G_{i},{j}"), matrix[i, j]) for i in range(matrix.rows) for j in range(matrix.cols))
    rows = [tuple(matrix.row(i)) for i in range(matrix.rows)]
    title = f"Integrals of products of derivatives of order {request.derivative} of two bases."
    return Result(equations, _knot_routine("gram_entries", title, rows))


def _knot_routine(name: str, title: str, rows: list[Any], first: Symbol | None = None) -> Routine:
    symbols = sorted({s.name for row in rows for value in row for s in value.free_symbols} - {str(first)})
    arguments = [Argument(symbol, "number", "Knot.") for symbol in symbols]
    if first is not None:
        arguments.insert(0, Argument(first.name, "number", "Parameter."))
    source = "Cox-de Boor, derivations/splines.py" if first is not None else "derivations/energy.py"
    return Routine(name, title, source, tuple(arguments), "matrix", tuple(rows), ("N" if first is not None else "G",))


def _energy_density(_: Request) -> Result:
    return Result(((Symbol("e"), energy.thin_plate_density()),), catalogue.density_routine())


def _fairness(_: Request) -> Result:
    return Result(fairness.fairness_formulas())


def _gram_block(_: Request) -> Result:
    return Result(((Symbol("K"), energy.gram_block()),), catalogue.gram_routine())


def _energy(_: Request) -> Result:
    return Result(((Symbol("E"), energy.quadratic_form()),))


def _stationarity(_: Request) -> Result:
    return Result(((energy.stationarity_condition(), sympify(0)),))


def _shape_polynomial(request: Request) -> Result:
    if not 1 <= request.order <= shape.MAX_POWER:
        raise ValueError(f"order: found {request.order}, expected 1..{shape.MAX_POWER} for the shape polynomial")
    routine = catalogue.shape_routine(request.order, request.order)
    x, y = Symbol("x"), Symbol("y")
    table = enumerate(routine.values)
    total = sum((entry * x**i * y**j for i, row in table for j, entry in enumerate(row)), sympify(0))
    return Result(((Symbol("E"), total),), routine)


@dataclass(frozen=True)
class _Entry:
    summary: str
    build: Callable[[Request], Result]


RESULTS: dict[str, _Entry] = {
    "basis-pieces": _Entry("B-spline basis over given knots, span by span", _basis_pieces),
    "contact-conditions": _Entry("G^n contact for general functions p_i, q_i", _contact_conditions),
    "contact-jets": _Entry("the same rows in derivatives of any base, spline or not", _contact_jets),
    "contact-rows": _Entry("rows P_0..P_n of a blend in G^n contact with a base", _contact_rows),
    "derivative-rows": _Entry("rows P_0..P_n of a blend with given u-derivatives at a contact", _derivative_rows),
    "end-derivatives": _Entry("derivatives at a clamped end in the first rows", _end_derivatives),
    "energy": _Entry("thin-plate energy as a quadratic form", _energy),
    "energy-density": _Entry("integrand of the thin-plate energy", _energy_density),
    "fairness": _Entry("mean curvature, and |grad H|^2 per du dv", _fairness),
    "gram-block": _Entry("block of the quadratic form in one-dimensional integrals", _gram_block),
    "gram-entries": _Entry("integrals of products of basis derivatives, of two bases", _gram),
    "homogeneous-conditions": _Entry(
        "contact of order n with a rational base (X, om): derivatives (Y, W) of the blend", _homogeneous_conditions
    ),
    "homogeneous-last": _Entry(
        "jets (Y, W) of a rational base whose weight is om^(n+1), and 0 beyond the contact", _last_rung
    ),
    "joint-slopes": _Entry(
        "chains: slopes of l, p, q behind a joint that close the strip's derivatives", _joint_slopes
    ),
    "joint-values": _Entry("chains: l and p behind a joint, where one side edge leaves the contact", _joint_values),
    "linear-power": _Entry("a^n for a linear along the contact, from a0 to a1", _linear_power),
    "linear-product": _Entry("a spline times a linear function, as a spline", _linear_product),
    "shape-conditions": _Entry("G^n contact for p1 = -a and p2, the rest zero", _shape_conditions),
    "shape-polynomial": _Entry("least energy in x = a - a0 and y = b - b0, G^n at both ends", _shape_polynomial),
    "special-conditions": _Entry("G^n contact for p1 = -a, the rest zero", _special_conditions),
    "stationarity": _Entry("what vanishes for each free control point at the least energy", _stationarity),
    "strip-derivatives": _Entry(
        "d^j/du^j of lambda R(w, v + q), in contact with R for all l, p, q", _strip_derivatives
    ),
}
