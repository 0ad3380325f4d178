"""Which routines there are, and into which files they go."""

from __future__ import annotations

from collections.abc import Sequence

from sympy import Expr, Integer, Matrix, Symbol, diag

from semispline.derivations.codegen.program_backend import program_function, program_module, pullback_function
from semispline.derivations.codegen.python_backends import CASADI, NUMPY, python_module
from semispline.derivations.codegen.routines import Argument, Routine, plain_symbols
from semispline.derivations.contact import (
    chain_monomials,
    chain_table,
    contact_conditions,
    contact_jets,
    contact_rows,
    rows_from_derivatives,
)
from semispline.derivations.energy import SECOND_DERIVATIVES, gram_block, thin_plate_density
from semispline.derivations.fairness import fairness_program
from semispline.derivations.homogeneous import quotient_program
from semispline.derivations.linear_alpha import linear_powers
from semispline.derivations.shape import MAX_POWER, contact_row_powers, energy_polynomial, product_symbol
from semispline.derivations.splines import end_derivatives, span_symbols

MAX_ORDER = 4


def _spans(letter: str, order: int, whose: str, degree: str) -> list[Argument]:
    return [
        Argument(f"{letter}{r}", "span", f"U[{degree} + {r}] - U[{degree}] of {whose}.") for r in range(1, order + 1)
    ]


def _rows(matrix: Matrix) -> tuple[tuple[Expr, ...], ...]:
    return tuple(plain_symbols(list(matrix.row(i))) for i in range(matrix.rows))


def _degree(name: str, value: int | None, meaning: str, least: int = 1) -> tuple[int | Symbol, list[Argument]]:
    """Return a degree and the arguments it needs: none where it is a number."""
    if value is not None:
        return value, []
    return Symbol(name), [Argument(name, "degree", meaning, least)]


def end_derivative_routine(order: int, degree: int | None = None, end: str = "start") -> Routine:
    """Return `end_derivatives_n(p, h1, .., hn)`, without p where the degree is given."""
    p, arguments = _degree("p", degree, "Degree.")
    matrix = end_derivatives(order, p, span_symbols(order))
    if end == "end":
        matrix = diag(*((-1) ** d for d in range(order + 1))) * matrix
    counted = ", rows and spans counted from there" if end == "end" else ""
    return Routine(
        name=f"end_derivatives_{order}",
        summary=f"Derivatives of order 0..{order} at the clamped {end}{counted}; [d, i] multiplies row i in the d-th.",
        source="Cox-de Boor, derivations/splines.py",
        arguments=(*arguments, *_spans("h", order, "the knots", str(p))),
        form="matrix",
        values=_rows(matrix),
        names=("D",),
    )


def contact_routine(order: int, degree: int | None = None, base_degree: int | None = None) -> Routine:
    """Return `contact_rows_n(a, p, h1, .., hn, q, H1, .., Hn)`, without p or q where given, bare for order 0."""
    p, blend = _degree("p", degree, "Degree of the blend in u.", order)
    q, base = _degree("q", base_degree, "Degree of the base across the contact.")
    arguments: tuple[Argument, ...] = ()
    if order:
        arguments = (
            Argument("a", "number", "alpha^2: the blend leaves the base backwards, P_u = -a R_w."),
            *blend,
            *_spans("h", order, "the blend, counted from the contact", str(p)),
            *base,
            *_spans("H", order, "the base; any positive number where there is no such knot", str(q)),
        )
    return Routine(
        name=f"contact_rows_{order}",
        summary=f"Rows of a blend in G{order} contact: P_i = sum_j C[i, j] R_j, counted from the contact.",
        source=f"chain rule of order {order} with p1 = -a, the rest zero; derivations/contact.py",
        arguments=arguments,
        form="matrix",
        values=_rows(contact_rows(order, p, span_symbols(order), q, span_symbols(order, "H"))),
        names=("C",),
    )


def jets_routine(order: int, degree: int | None = None) -> Routine:
    """Return `contact_jets_n(a, p, h1, .., hn)`, without p where given."""
    p, blend = _degree("p", degree, "Degree of the blend in u.", order)
    spans = _spans("h", order, "the blend, counted from the contact", str(p))
    alpha = [Argument("a", "number", "alpha^2: the blend leaves the base backwards, P_u = -a R_w.")]
    return Routine(
        name=f"contact_jets_{order}",
        summary=f"Rows of a blend in G{order} contact: P_i = sum_d J[i, d] R^(d), derivatives of the base across.",
        source=f"chain rule of order {order} with p1 = -a, the rest zero; derivations/contact.py",
        arguments=(*alpha, *blend, *spans) if order else (),
        form="matrix",
        values=_rows(contact_jets(order, p, span_symbols(order))),
        names=("J",),
    )


def derivative_rows_routine(order: int, degree: int | None = None) -> Routine:
    """Return `rows_from_derivatives_n(p, h1, .., hn)`, without p where given."""
    p, blend = _degree("p", degree, "Degree of the blend in u.", order)
    return Routine(
        name=f"rows_from_derivatives_{order}",
        summary=f"Rows P_i = sum_k W[i, k] D_k of a blend with u-derivatives D_0..D_{order} at the contact.",
        source="Cox-de Boor, derivations/splines.py; derivations/contact.py",
        arguments=(*blend, *_spans("h", order, "the blend, counted from the contact", str(p))),
        form="matrix",
        values=_rows(rows_from_derivatives(order, p, span_symbols(order))),
        names=("W",),
    )


def chain_monomials_routine(order: int) -> Routine:
    """Return `chain_monomials_n()`: the exponents of a and p2."""
    return Routine(
        name=f"chain_monomials_{order}",
        summary=f"Exponents of a and p2 in the monomials of the conditions of order 0..{order}.",
        source="chain rule with p1 = -a, p2, the rest zero; derivations/contact.py",
        arguments=(),
        form="matrix",
        values=tuple(tuple(map(Integer, exponents)) for exponents in chain_monomials(order)),
        names=("exponents",),
    )


def chain_table_routine(order: int) -> Routine:
    """Return `chain_table_n()`: what multiplies each monomial, matrices below each other."""
    tables = chain_table(order)
    return Routine(
        name=f"chain_table_{order}",
        summary=f"D_k = sum over monomials m of m sum_d T_m[k, d] R^(d), k = 0..{order}; the T_m below each other.",
        source="chain rule with p1 = -a, p2, the rest zero; derivations/contact.py",
        arguments=(),
        form="matrix",
        values=tuple(row for exponents in chain_monomials(order) for row in _rows(tables[exponents])),
        names=("T",),
    )


def linear_powers_routine(order: int) -> Routine:
    """Return `linear_powers_n()`: powers of a linear function by its end values."""
    return Routine(
        name=f"linear_powers_{order}",
        summary=f"Rows (i, i0, i1, c): (a0 (1 - s) + a1 s)^i sums c a0^i0 a1^i1 (1 - s)^i0 s^i1; i <= {order}.",
        source="derivations/linear_alpha.py",
        arguments=(),
        form="matrix",
        values=tuple(tuple(map(Integer, row)) for row in linear_powers(order)),
        names=("powers",),
    )


def row_powers_routine(order: int) -> Routine:
    """Return `contact_row_powers_n(a0, p, h1, .., q, H1, ..)`: the contact rows as a polynomial in a - a0."""
    p, blend = _degree("p", None, "Degree of the blend in u.", order)
    q, base = _degree("q", None, "Degree of the base across the contact.")
    a0 = Symbol("a0")
    powers = contact_row_powers(order, p, span_symbols(order), q, span_symbols(order, "H"), a0)
    return Routine(
        name=f"contact_row_powers_{order}",
        summary=f"Rows of a blend in G{order} contact, C_0 + x C_1 + .. + x^{order} C_{order}, C_k below each other.",
        source="derivations/shape.py, x = a - a0",
        arguments=(
            Argument("a0", "number", "The value of a = alpha^2 about which the rows are expanded."),
            *blend,
            *_spans("h", order, "the blend, counted from the contact", "p"),
            *base,
            *_spans("H", order, "the base; any positive number where there is no such knot", "q"),
        ),
        form="matrix",
        values=tuple(row for power in powers for row in _rows(power)),
        names=("C",),
    )


def shape_routine(power_a: int, power_b: int) -> Routine:
    """Return `shape_polynomial_ab(S00, S01, ..)`: the energy as a polynomial in both shape parameters."""
    size = power_a + power_b + 1
    return Routine(
        name=f"shape_polynomial_{power_a}{power_b}",
        summary="Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.",
        source="derivations/shape.py",
        arguments=tuple(
            Argument(product_symbol(k, n).name, "number", f"Energy product of Z_{k} and Z_{n}.")
            for k in range(size)
            for n in range(k, size)
        ),
        form="matrix",
        values=_rows(energy_polynomial(power_a, power_b)),
        names=("E",),
    )


def conditions_routine(order: int = 2) -> Routine:
    """Return `contact_derivatives_n`: the general conditions of order 1..n."""
    conditions = contact_conditions(order)[1:]
    vectors = ["w" * i + "v" * (d - i) for d in range(1, order + 1) for i in range(d, -1, -1)]
    values = plain_symbols(conditions, {f"R_{name}": f"r_{name}" for name in vectors})
    functions = [
        (f"{name}{d}", f"{of}_{'u' * d}") for d in range(1, order + 1) for name, of in (("p", "w"), ("q", "v~"))
    ]
    names = [f"p_{'u' * d}" for d in range(1, order + 1)]
    return Routine(
        name=f"contact_derivatives_{order}",
        summary=f"{', '.join(names)} along the contact for general p_i, q_i, where P(u, v) = R(w(u, v), v~(u, v)).",
        source="chain rule, derivations/contact.py; equations (15) and (16)",
        arguments=(
            *(Argument(f"r_{name}", "vector", f"R_{name} along the contact.") for name in vectors),
            *(Argument(name, "function", f"{meaning} along the contact.") for name, meaning in functions),
        ),
        form="vectors",
        values=tuple((value,) for value in values),
        names=tuple(names),
    )


def density_routine() -> Routine:
    """Return `thin_plate_density(p_uu, p_uv, p_vv)`."""
    names = {symbol.name: symbol.name.lower() for symbol in SECOND_DERIVATIVES}
    return Routine(
        name="thin_plate_density",
        summary="Integrand of the thin-plate energy.",
        source="equation (11), derivations/energy.py",
        arguments=tuple(Argument(names[s.name], "vector", f"{s.name}.") for s in SECOND_DERIVATIVES),
        form="density",
        values=(plain_symbols((thin_plate_density(),), names),),
        names=("density",),
    )


def gram_routine() -> Routine:
    """Return `gram_block(A0, A1, A2, G0, G1, G2)`."""
    return Routine(
        name="gram_block",
        summary="Block of the quadratic form of the energy that couples v-control curves i and i'.",
        source="equation (11), derivations/energy.py",
        arguments=(
            *(Argument(f"A{d}", "number", f"Integral of N_i^({d}) N_i'^({d}) du.") for d in range(3)),
            *(Argument(f"G{d}", "block", f"Integrals of B_j^({d}) B_j'^({d}) dv over V_i and V_i'.") for d in range(3)),
        ),
        form="block",
        values=((gram_block(),),),
        names=("K",),
    )


def generated_files() -> dict[str, str]:
    """Return the name and text of each file of `solver/generated`, sorted by name."""
    contact: Sequence[Routine] = (
        *(end_derivative_routine(order) for order in range(1, MAX_ORDER + 1)),
        *(contact_routine(order) for order in range(MAX_ORDER + 1)),
        conditions_routine(),
    )
    energy = (density_routine(), gram_routine())
    contact_sources = ("derivations/splines.py", "derivations/contact.py")
    files = {"__init__.py": '"""What `semispline generate` wrote; never edited by hand."""\n'}
    for backend in (CASADI, NUMPY):
        suffix = backend.title.lower()
        title = "Contact of a blend with a base: end derivatives, rows P_0..P_n, general conditions"
        files[f"contact_{suffix}.py"] = python_module(title, contact_sources, contact, backend)
        title = "Thin-plate energy: integrand and blocks of its quadratic form"
        files[f"energy_{suffix}.py"] = python_module(title, ("derivations/energy.py",), energy, backend)
    shape = (
        *(row_powers_routine(order) for order in range(1, MAX_POWER + 1)),
        *(shape_routine(a, b) for a in range(MAX_POWER + 1) for b in range(MAX_POWER + 1) if a + b),
    )
    title = "The least energy as a polynomial in the shape parameters"
    files["shape_numpy.py"] = python_module(title, ("derivations/shape.py",), shape, NUMPY)
    rows = tuple(
        routine(order)
        for order in range(1, MAX_ORDER + 1)
        for routine in (derivative_rows_routine, chain_monomials_routine, chain_table_routine)
    )
    title = "Rows of a blend from its derivatives at a contact, and these from the chain rule"
    files["rows_numpy.py"] = python_module(
        title, (*contact_sources, "derivations/linear_alpha.py"), (*rows, linear_powers_routine(MAX_ORDER)), NUMPY
    )
    source, program = "derivations/fairness.py", fairness_program()
    summary = "|grad H|^2 per du dv, area element, mean curvature, speed along u"
    files["fairness_numpy.py"] = program_module(
        "Fairness: |grad H|^2 dA of a surface from its derivatives, and the gradient of what is made of it",
        source,
        (
            program_function("fairness", f"{summary}.", source, program),
            pullback_function("fairness_pullback", f"{summary}; and the adjoints of the derivatives.", source, program),
        ),
    )
    source, program = "derivations/homogeneous.py", quotient_program()
    summary = "Derivatives of order 1 to 3 of a surface X / W"
    files["quotient_numpy.py"] = program_module(
        "Derivatives of a rational surface from its homogeneous ones, and their adjoints",
        source,
        (
            program_function("quotient", f"{summary}.", source, program),
            pullback_function("quotient_pullback", f"{summary}; and the adjoints of those of (X, W).", source, program),
        ),
    )
    return dict(sorted(files.items()))
