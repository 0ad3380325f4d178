"""What a band along a curve on a face must be, and what its errors do to contact, from first principles.

Along the curve C(v), v its arc length, T = C' is the unit tangent, N the unit normal of the face and D = N x T. Their
derivatives are those of the Darboux frame,

    T' = k_g D + k_n N,    D' = -k_g T + tau N,    N' = -k_n T - tau D,

with k_n = II(T, T) and tau = II(T, D). The band is B(w, v) = sum_k R_k(v) w^k / k!, with R_0 = C, R_1 = D and
R_k = h_k N, where h_k are the derivatives of the height of the face's section with the plane of D and N over its
tangent line. Only derivatives at w = 0 count for contact.

Source: M. do Carmo, Differential Geometry of Curves and Surfaces, ch. 3 and 4 (Darboux frame).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from sympy import Derivative, Expr, Function, Matrix, Symbol, diff, expand, factorial, simplify, sqrt, sympify

V = Symbol("v", real=True)
# Curvatures along the curve and of the section across it, as functions of v.
K_N, K_G, TAU, H_2 = (Function(name)(V) for name in ("k_n", "k_g", "tau", "h_2"))
_EPSILON, _W = Symbol("epsilon"), Symbol("w")

# A vector by its parts along T, D and N.
Frame = tuple[Expr, Expr, Expr]


def frame_derivative(vector: Frame) -> Frame:
    """Return the derivative by arc length of a vector that is given in the frame T, D, N.

    Examples
    --------
    >>> frame_derivative((sympify(0), sympify(1), sympify(0)))
    (-k_g(v), 0, tau(v))
    """
    a, b, c = map(sympify, vector)
    return (
        diff(a, V) - K_G * b - K_N * c,
        diff(b, V) + K_G * a - TAU * c,
        diff(c, V) + K_N * a + TAU * b,
    )


def row_conditions(direction: Frame) -> dict[str, Expr]:
    """Return what the normal parts of rows and of their derivatives must be, for any tangential R_1.

    Parameters
    ----------
    direction : (a, b, 0)
        R_1 = a T + b D, functions of v.

    Returns
    -------
    dict
        N.R_0', N.R_0'', N.R_1 and N.R_1'; II(R_1, R_1), which N.R_2 must be.

    Notes
    -----
    No derivative of the face's parameters is needed: all follow from N.T = 0 and N.R_1 = 0 by differentiation.

    Examples
    --------
    >>> row_conditions((sympify(0), sympify(1), sympify(0)))["N.R_1'"]
    tau(v)
    """
    tangent: Frame = (sympify(1), sympify(0), sympify(0))
    return {
        "N.R_0'": tangent[2],
        "N.R_0''": frame_derivative(tangent)[2],
        "N.R_1": direction[2],
        "N.R_1'": frame_derivative(direction)[2],
        "N.R_2": second_form(direction, direction),
    }


def second_form(x: Frame, y: Frame) -> Expr:
    """Return II(x, y) of two tangent vectors.

    Examples
    --------
    >>> second_form((1, 0, 0), (0, 1, 0))
    tau(v)
    """
    return expand(K_N * x[0] * y[0] + TAU * (x[0] * y[1] + x[1] * y[0]) + H_2 * x[1] * y[1])


def error_measures(leading: bool = False) -> dict[str, Expr]:
    """Return, to first order, what errors of the rows do to gap, angle and curvature.

    The errors are e_0 = c_0 N, as seen from the foot, and e_k = a_k T + b_k D + c_k N for k = 1, 2, functions of v. The
    band is compared with the face in the frame of the band's own edge.

    Parameters
    ----------
    leading : bool
        Leave out what is smaller by a span's length times a curvature: lower derivatives of the same errors.

    Returns
    -------
    dict
        "gap"; "angle_along", "angle_across", the parts by which the normal tilts towards -T and -D; "across", "mixed",
        "along", the errors of the second form.

    Examples
    --------
    >>> error_measures(leading=True)["along"]
    Derivative(c_0(v), (v, 2))
    """
    first = _first_order()
    return {name: _leading(value) for name, value in first.items()} if leading else first


@cache
def _first_order() -> dict[str, Expr]:
    e = {(name, k): Function(f"{name}_{k}")(V) for k in range(3) for name in "abc"}
    small = _EPSILON
    rows: list[Frame] = [
        (sympify(0), sympify(0), small * e["c", 0]),
        (small * e["a", 1], 1 + small * e["b", 1], small * e["c", 1]),
        (small * e["a", 2], small * e["b", 2], H_2 + small * e["c", 2]),
    ]
    b_v = _plus((sympify(1), sympify(0), sympify(0)), frame_derivative(rows[0]))
    b_vv, b_vw, b_w, b_ww = frame_derivative(b_v), frame_derivative(rows[1]), rows[1], rows[2]
    # Cut at every step: products of whole expressions take seconds to differentiate.
    cross = tuple(_cut(x) for x in Matrix(b_v).cross(Matrix(b_w)))
    area, speed = _cut(_length(cross)), _cut(_length(b_v))
    normal = tuple(_cut(x / area) for x in cross)
    tangent = tuple(_cut(x / speed) for x in b_v)
    # B_w = p D_b + q T_b in the band's own frame.
    p, q = _cut(area / speed), _cut(_dot(b_w, tangent))
    along = _cut(_dot(normal, b_vv) / speed**2)
    mixed = _cut((_dot(normal, b_vw) / speed - q * along) / p)
    across = _cut((_dot(normal, b_ww) - 2 * p * q * mixed - q**2 * along) / p**2)
    # The face's own form for the same directions.
    inward = tuple(_cut(x) for x in Matrix(normal).cross(Matrix(tangent)))
    found = {
        "gap": small * e["c", 0],
        "angle_along": -normal[0],
        "angle_across": -normal[1],
        "across": across - second_form(inward, inward),
        "mixed": mixed - second_form(tangent, inward),
        "along": along - second_form(tangent, tangent),
    }
    return {name: expand(diff(value, small).subs(small, 0).doit()) for name, value in found.items()}


def _cut(value: Expr) -> Expr:
    """Leave out what is of second order in the errors."""
    return expand(value.subs(_EPSILON, 0).doit() + _EPSILON * diff(value, _EPSILON).subs(_EPSILON, 0).doit())


def _leading(value: Expr) -> Expr:
    """Leave out terms that are smaller by a power of a span's length h than the largest ones.

    The error of a spline fit has derivatives of its own size over h, over h^2, ..; where c_2 is of size 1, c_1 is of
    size h and c_0 of size h^2.
    """
    powers = {"c_0": 2, "c_1": 1}

    def power(term: Expr) -> int:
        found = 0
        for function in term.atoms(Function):
            order = max(
                (sum(n for _, n in d.variable_count) for d in term.atoms(Derivative) if d.has(function)), default=0
            )
            found += max(powers.get(function.func.__name__, 0) - order, 0)
        return found

    terms = value.as_ordered_terms()
    least = min(map(power, terms))
    return sum((term for term in terms if power(term) == least), sympify(0))


def section_heights(
    surface: Sequence[Expr], parameters: Sequence[Symbol], at: Sequence[Expr], slope: Sequence[Expr], order: int
) -> list[Expr]:
    """Return h_2 .. h_order of the section of a surface square to a curve on it, by truncated power series.

    Parameters
    ----------
    surface : sequence of Expr, length 3
    parameters : (s, t)
    at : (s, t)
        The point.
    slope : (ds, dt)
        Of the curve: T is along S_s ds + S_t dt, N along S_s x S_t, D = N x T.
    order : int

    Returns
    -------
    list of Expr
        h_k = k! N.A_k with A_k = [w^k] S(c + x_1 w + .. + x_(k-1) w^(k-1)); x_1 goes along D, and x_k for k > 1 takes
        away the tangential part of A_k.

    Examples
    --------
    >>> s, t = Symbol("s"), Symbol("t")
    >>> section_heights([s, t, s**2 + 3 * t**2 + t**3], (s, t), (0, 0), (1, 0), 4)
    [6, 6, 0]
    """
    s, t = parameters
    shifted = Matrix([sympify(x).subs({s: at[0] + s, t: at[1] + t}, simultaneous=True) for x in surface])
    origin = {s: 0, t: 0}
    jacobian = shifted.jacobian([s, t]).subs(origin)
    normal = jacobian[:, 0].cross(jacobian[:, 1])
    normal = normal / sqrt(normal.dot(normal))
    tangent = jacobian * Matrix(slope)
    tangent = tangent / sqrt(tangent.dot(tangent))
    metric = jacobian.T * jacobian
    steps = [metric.inv() * jacobian.T * normal.cross(tangent)]
    taylor = shifted.applyfunc(lambda x: _taylor(x, s, t, order))
    heights = []
    for k in range(2, order + 1):
        path = [sum((step[d] * _W ** (m + 1) for m, step in enumerate(steps)), sympify(0)) for d in range(2)]
        known = taylor.subs({s: path[0], t: path[1]}, simultaneous=True)
        coefficient = known.applyfunc(lambda x, k=k: expand(x).coeff(_W, k))
        height = expand(factorial(k) * normal.dot(coefficient))
        heights.append(height if height.is_Rational else simplify(height))
        steps.append(-(metric.inv() * jacobian.T * coefficient))
    return heights


def _taylor(value: Expr, s: Symbol, t: Symbol, order: int) -> Expr:
    """Return the terms of a power series about the origin up to an order."""
    powers = [(i, k - i) for k in range(order + 1) for i in range(k + 1)]
    at = {s: 0, t: 0}
    return sum(
        (diff(value, s, i, t, j).subs(at) * s**i * t**j / (factorial(i) * factorial(j)) for i, j in powers), sympify(0)
    )


def _plus(a: Frame, b: Frame) -> Frame:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _dot(a: Sequence[Expr], b: Sequence[Expr]) -> Expr:
    return sum((x * y for x, y in zip(a, b, strict=True)), sympify(0))


def _length(a: Sequence[Expr]) -> Expr:
    return sqrt(_dot(a, a))
