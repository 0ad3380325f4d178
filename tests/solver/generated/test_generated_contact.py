"""Generated contact code: NumPy against CasADi, exact substitution, SciPy's derivatives, SymPy's derivatives."""

import inspect
from fractions import Fraction

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from sympy import Float, Matrix, Rational, Symbol, diff

from helpers.sweeps import examples
from semispline.derivations.contact import A, base_derivative, contact_conditions, contact_rows
from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.solver.generated import contact_casadi, contact_numpy

ROUTINES = [name for name in dir(contact_numpy) if name.startswith(("end_derivatives", "contact_rows_"))]
VECTORS = ("r_w", "r_v", "r_ww", "r_wv", "r_vv")
FUNCTIONS = ("p1", "q1", "p2", "q2")

# Dyadic arguments are exact in floats, so a difference is rounding of the printed operations alone: fewer than 80 of
# them on entries whose terms are of the size of the entries' sum of magnitudes.
ROUNDING = 80 * np.finfo(float).eps


def exact_matrix(name, values):
    """The derivation itself at rational arguments."""
    kind, order = name.rsplit("_", 1)
    order = int(order)
    get = {key: Rational(Fraction(value)) for key, value in values.items()}
    h, H = ([get.get(f"{letter}{r}") for r in range(1, order + 1)] for letter in "hH")
    if kind == "end_derivatives":
        return end_derivatives(order, get["p"], h)
    if order == 0:
        return Matrix([[1]])
    return contact_rows(order, get["p"], h, get["q"], H, get["a"])


def arguments(name, rng):
    names = list(inspect.signature(getattr(contact_numpy, name)).parameters)
    order = int(name[-1])
    values = {}
    for argument in names:
        if argument in "pq":
            values[argument] = float(rng.integers(max(order, 1) if argument == "p" else 1, 8))
        else:
            values[argument] = float(rng.integers(1, 64)) / 16
    return values


@pytest.mark.long
@pytest.mark.parametrize("name", ROUTINES)
def test_numpy_casadi_and_exact_substitution_agree(name):
    rng = np.random.default_rng(7)
    for _ in range(20):
        values = arguments(name, rng)
        exact = np.array(exact_matrix(name, values), dtype=float)
        found = getattr(contact_numpy, name)(**values)
        assert found.dtype == np.float64
        # Sums such as 1 + a .. may cancel: compare with the largest entry of the row.
        size = np.abs(exact).max()
        np.testing.assert_allclose(found, exact, rtol=0, atol=ROUNDING * size)
        plain = getattr(contact_casadi, name)(**values)
        np.testing.assert_allclose(np.array(ca.DM(plain)), exact, rtol=0, atol=ROUNDING * size)
        for kind in (ca.SX, ca.MX):
            symbols = [kind.sym(argument) for argument in values]
            result = getattr(contact_casadi, name)(*symbols)
            if values:
                assert isinstance(result, kind)
            function = ca.Function("f", symbols, [result])
            np.testing.assert_allclose(
                np.array(function.call(list(values.values()))[0]), exact, rtol=0, atol=ROUNDING * size
            )


@st.composite
def contacts(draw):
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    order = draw(st.integers(1, 3))
    p, q = draw(st.integers(order, 7)), draw(st.integers(1, 7))

    def knots(degree):
        inner = np.sort(rng.uniform(0.1, 0.9, draw(st.integers(0, 3))))
        counts = rng.integers(1, degree + 1, len(inner))
        start, length = rng.uniform(-2, 2), rng.uniform(0.5, 2)
        unit = np.concatenate([np.zeros(degree + 1), np.repeat(inner, counts), np.ones(degree + 1)])
        return start + length * unit

    return order, p, knots(p), q, knots(q), rng, draw(st.booleans()), draw(st.booleans())


@given(contacts())
@examples(60)
def test_a_blend_with_generated_rows_follows_the_base_in_scipy(contact):
    order, p, U, q, W, rng, blend_end, base_end = contact
    a = rng.uniform(0.25, 4)
    base = BSpline(W, rng.uniform(-1, 1, (len(W) - q - 1, 3)), q)

    def spans(knots, degree, from_end):
        counted = knots[-1] - knots[::-1] if from_end else knots - knots[0]
        return [counted[min(degree + r, len(knots) - 1)] for r in range(1, order + 1)]

    h, H = spans(U, p, blend_end), spans(W, q, base_end)
    matrix = getattr(contact_numpy, f"contact_rows_{order}")(a, p, *h, q, *H)
    near = base.c[::-1] if base_end else base.c
    near = np.concatenate([near, np.full((order + 1, 3), np.nan)])[: order + 1]
    # Rows that the base does not have must not matter, whatever stands there.
    used = np.abs(matrix).max(axis=0) > 0
    control = rng.uniform(-1, 1, (len(U) - p - 1, 3))
    control[: order + 1] = matrix[:, used] @ near[used]
    blend = BSpline(U, control[::-1] if blend_end else control, p)
    at_blend, at_base = U[-1] if blend_end else U[0], W[-1] if base_end else W[0]
    sign = (-1 if blend_end else 1) * (-1 if base_end else 1)
    for d in range(order + 1):
        expected = (-sign * a) ** d * base(at_base, d)
        # A derivative is d differences over spans of at least 0.05: rounding of the control points grows by 2 p / h
        # for each of them.
        growth = np.prod([2 * max(p, q) / min(*h, *(width / max(a, 1 / a) for width in H))] * d)
        np.testing.assert_allclose(blend(at_blend, d), expected, rtol=0, atol=1e-14 * growth * np.abs(control).max())


@pytest.mark.long
@pytest.mark.parametrize("order", [1, 2, 3])
def test_casadi_derivatives_of_rows_are_those_of_sympy(order):
    h, H = span_symbols(order), span_symbols(order, "H")
    p, q = 4, 3
    rows = contact_rows(order, p, h, q, H)
    variables = [A, *h, *H]
    point = [1.25, *(0.5 * r + 0.25 for r in range(1, order + 1)), *(0.75 * r for r in range(1, order + 1))]
    values = dict(zip(variables, (Rational(Fraction(x)) for x in point), strict=True))
    x = ca.SX.sym("x", len(variables))
    a, *rest = ca.vertsplit(x)
    matrix = getattr(contact_casadi, f"contact_rows_{order}")(a, p, *rest[:order], q, *rest[order:])
    for i in range(order + 1):
        for j in range(i + 1):
            hessian, gradient = ca.hessian(matrix[i, j], x)
            function = ca.Function("f", [x], [gradient, hessian])
            found = [np.array(value) for value in function(point)]
            first = [diff(rows[i, j], s) for s in variables]
            second = [[diff(entry, s) for s in variables] for entry in first]
            for numbers, exact in ((found[0].ravel(), first), (found[1], second)):
                expected = np.array(Matrix(exact).subs(values).applyfunc(Float).tolist(), dtype=float)
                expected = expected.reshape(numbers.shape)
                # Differentiation about doubles the operations, twice.
                size = max(1.0, np.abs(expected).max())
                np.testing.assert_allclose(numbers, expected, rtol=0, atol=8 * ROUNDING * size)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_taylor_remainders_of_the_rows_have_slopes_two_and_three(order):
    rng = np.random.default_rng(order)
    x = ca.SX.sym("x", 1 + 2 * order)
    a, *rest = ca.vertsplit(x)
    matrix = getattr(contact_casadi, f"contact_rows_{order}")(a, 5, *rest[:order], 4, *rest[order:])
    f = ca.dot(ca.DM(rng.uniform(-1, 1, matrix.shape)), matrix)
    hessian, gradient = ca.hessian(f, x)
    function = ca.Function("f", [x], [f, gradient, hessian])
    point, direction = rng.uniform(1, 2, x.shape[0]), rng.uniform(-1, 1, x.shape[0])
    value, slope, curvature = (np.array(v) for v in function(point))
    steps = 2.0 ** -np.arange(4, 10)
    linear, quadratic = [], []
    for step in steps:
        difference = float(function(point + step * direction)[0] - value) - step * float(slope.ravel() @ direction)
        linear.append(abs(difference))
        quadratic.append(abs(difference - step**2 / 2 * float(direction @ curvature @ direction)))
    # The next term of the series is 2^-9 of the leading one at the smallest step.
    assert np.polyfit(np.log(steps), np.log(linear), 1)[0] == pytest.approx(2, abs=0.1)
    assert np.polyfit(np.log(steps), np.log(quadratic), 1)[0] == pytest.approx(3, abs=0.1)


def test_general_conditions_agree_with_exact_substitution_and_each_other():
    rng = np.random.default_rng(3)
    vectors = {name: rng.integers(-9, 9, (4, 3)) / 4 for name in VECTORS}
    functions = {name: rng.integers(-9, 9, 4) / 4 for name in FUNCTIONS}
    found = contact_numpy.contact_derivatives_2(**vectors, **functions)
    conditions = contact_conditions(2)[1:]
    for k in range(4):
        single = contact_casadi.contact_derivatives_2(
            *(ca.DM(vectors[name][k]) for name in VECTORS), *(functions[name][k] for name in FUNCTIONS)
        )
        for c in range(3):
            values = {Symbol(name): Rational(functions[name][k]) for name in FUNCTIONS}
            for i, j in ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)):
                values[base_derivative(i, j)] = Rational(vectors[f"r_{'w' * i}{'v' * j}"][k, c])
            for number, condition in enumerate(conditions):
                # Quarters times quarters times quarters: exact in floats.
                assert found[number][k, c] == float(condition.subs(values)) == float(single[number][c])


def test_functions_may_be_numbers_for_all_vectors():
    vectors = [np.full((2, 5, 3), x) for x in (1.0, 2.0, 3.0, 4.0, 5.0)]
    p_u, p_uu = contact_numpy.contact_derivatives_2(*vectors, -2, 1, 0, 0)
    assert p_u.shape == p_uu.shape == (2, 5, 3)
    assert (p_u == 0).all()
    assert (p_uu == 4 * 3 - 4 * 4 + 5).all()


@pytest.mark.parametrize("module", [contact_numpy, contact_casadi])
@pytest.mark.parametrize(
    ("name", "values", "words"),
    [
        ("contact_rows_2", {"p": 1}, "p: found 1, expected a degree of at least 2"),
        ("contact_rows_2", {"q": 0}, "q: found 0, expected a degree of at least 1"),
        ("contact_rows_2", {"h1": 0.0}, "h1: found 0.0, expected a positive distance of knots"),
        ("contact_rows_2", {"H2": float("nan")}, "H2: found nan, expected a positive distance"),
        ("contact_rows_2", {"a": np.ones(2)}, r"a: shape \(2,\), expected a single number of shape \(\)"),
        ("contact_rows_1", {"h1": np.ones((1, 2))}, r"h1: shape \(1, 2\), expected a single number"),
        ("end_derivatives_3", {"p": 0}, "p: found 0"),
    ],
)
def test_arguments_are_checked(module, name, values, words):
    parameters = inspect.signature(getattr(module, name)).parameters
    with pytest.raises(ValueError, match=words):
        getattr(module, name)(**(dict.fromkeys(parameters, 3.0) | values))


def test_shapes_of_vectors_are_checked():
    good = np.ones((4, 3))
    with pytest.raises(ValueError, match=r"r_w: shape \(4, 2\), expected \(\.\.\., 3\)"):
        contact_numpy.contact_derivatives_2(good[:, :2], *[good] * 4, 1, 1, 1, 1)
    with pytest.raises(ValueError, match=r"r_wv: shape \(3,\), expected \(4, 3\)"):
        contact_numpy.contact_derivatives_2(good, good, good, good[0], good, 1, 1, 1, 1)
    with pytest.raises(ValueError, match=r"q1: shape \(3,\), expected \(\) or \(4,\)"):
        contact_numpy.contact_derivatives_2(*[good] * 5, 1, np.ones(3), 1, 1)
    with pytest.raises(ValueError, match=r"r_ww: shape \(4, 3\), expected \(3, 1\)"):
        contact_casadi.contact_derivatives_2(good[0], good[0], ca.DM(good), good[0], good[0], 1, 1, 1, 1)
    with pytest.raises(ValueError, match=r"p2: shape \(3, 1\), expected a single number"):
        contact_casadi.contact_derivatives_2(*[good[0]] * 5, 1, 1, ca.SX.sym("p", 3), 1)
