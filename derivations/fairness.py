"""Fairness of a surface: |grad H|^2 dA from its derivatives, and its exact gradient, as programs of short steps.

A program is a list of assignments, each a short polynomial or quotient in what was assigned before; reverse
accumulation turns it into the program of its gradient, whose cost is a small multiple of its own whatever the number
of inputs.

Letters: a = P_u, b = P_v, aa = P_uu, ab, bb, aaa = P_uuu, .., m = a x b, W = |m|, H mean curvature.

    E = a.a,  F = a.b,  G = b.b;   Q = E (bb.m) - 2 F (ab.m) + G (aa.m);   H = Q / (2 W^3)
    |grad H|^2 dA = (G H_u^2 - 2 F H_u H_v + E H_v^2) / W du dv

H_u and H_v are derived from H by the chain rule: each derivative of the surface has its own derivative by u and by v.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sympy import Expr, Matrix, Symbol, factor, fraction, sign, sqrt, symbols, sympify

# The derivatives of the surface that enter, by their directions.
DERIVATIVES = ("u", "v", "uu", "uv", "vv", "uuu", "uuv", "uvv", "vvv")
COORDINATES = ("x", "y", "z")


@dataclass(frozen=True)
class Program:
    """Assignments in order.

    Attributes
    ----------
    inputs, outputs : tuple of Symbol
    steps : tuple of (Symbol, Expr)
        Each in symbols of the inputs and of steps before.
    """

    inputs: tuple[Symbol, ...]
    steps: tuple[tuple[Symbol, Expr], ...]
    outputs: tuple[Symbol, ...]


Vector = tuple[Expr, Expr, Expr]


def derivative_symbols(name: str) -> Vector:
    """Return the coordinates of a derivative of the surface.

    Examples
    --------
    >>> derivative_symbols("uv")
    (p_uv_x, p_uv_y, p_uv_z)
    """
    x, y, z = (Symbol(f"p_{name}_{coordinate}") for coordinate in COORDINATES)
    return x, y, z


class _Steps:
    """Steps that are collected; each is named when it is added."""

    def __init__(self) -> None:
        self.steps: list[tuple[Symbol, Expr]] = []

    def named(self, name: str, value: Expr) -> Symbol:
        symbol = Symbol(name)
        self.steps.append((symbol, value))
        return symbol

    def vector(self, name: str, value: Sequence[Expr]) -> Vector:
        x, y, z = (self.named(f"{name}_{c}", v) for c, v in zip(COORDINATES, value, strict=True))
        return x, y, z


def _dot(r: Vector, s: Vector) -> Expr:
    return sum((x * y for x, y in zip(r, s, strict=True)), sympify(0))


def _cross(r: Vector, s: Vector) -> Vector:
    return r[1] * s[2] - r[2] * s[1], r[2] * s[0] - r[0] * s[2], r[0] * s[1] - r[1] * s[0]


def _plus(r: Vector, s: Vector) -> Vector:
    return r[0] + s[0], r[1] + s[1], r[2] + s[2]


def fairness_program() -> Program:
    """Return the steps from nine derivatives of a surface to four outputs.

    |grad H|^2 per du dv, the area element, the mean curvature, the speed along u.

    Examples
    --------
    >>> program = fairness_program()
    >>> len(program.inputs), [symbol.name for symbol in program.outputs]
    (27, ['rough', 'area', 'mean', 'speed'])
    """
    p = {name: derivative_symbols(name) for name in DERIVATIVES}
    a, b, aa, ab, bb = (p[name] for name in DERIVATIVES[:5])
    s = _Steps()
    m = s.vector("m", _cross(a, b))
    e, f, g = s.named("e", _dot(a, a)), s.named("f", _dot(a, b)), s.named("g", _dot(b, b))
    w2 = s.named("w2", _dot(m, m))
    area = s.named("area", sqrt(w2))
    # One division: the rest are products, which cost less here and in the gradient.
    per_w2 = s.named("per_w2", 1 / w2)
    per_w = s.named("per_w", area * per_w2)
    per_cube = s.named("per_cube", per_w2 * per_w / 2)
    ll, k, n = s.named("ll", _dot(aa, m)), s.named("k", _dot(ab, m)), s.named("n", _dot(bb, m))
    f2 = s.named("f2", 2 * f)
    q = s.named("q", e * n - f2 * k + g * ll)
    mean = s.named("mean", q * per_cube)
    ratio = s.named("ratio", 3 * q * per_w2)
    slopes = []
    for t in "uv":
        at, bt, aat, abt, bbt = (p["".join(sorted(name + t))] for name in ("u", "v", "uu", "uv", "vv"))
        mt = s.vector(f"m{t}", _plus(_cross(at, b), _cross(a, bt)))
        e2, g2 = s.named(f"half_e{t}", _dot(a, at)), s.named(f"half_g{t}", _dot(b, bt))
        ft = s.named(f"f{t}", _dot(at, b) + _dot(a, bt))
        lt, kt = s.named(f"l{t}", _dot(aat, m) + _dot(aa, mt)), s.named(f"k{t}", _dot(abt, m) + _dot(ab, mt))
        nt = s.named(f"n{t}", _dot(bbt, m) + _dot(bb, mt))
        changed = s.named(f"changed_{t}", e2 * n - ft * k + g2 * ll)
        qt = s.named(f"q{t}", 2 * changed + e * nt - f2 * kt + g * lt)
        wt = s.named(f"w{t}", _dot(m, mt))
        slopes.append(s.named(f"h{t}", s.named(f"top_{t}", qt - ratio * wt) * per_cube))
    hu, hv = slopes
    along_u, along_v = s.named("along_u", g * hu - f * hv), s.named("along_v", e * hv - f * hu)
    rough = s.named("rough", s.named("form", along_u * hu + along_v * hv) * per_w)
    speed = s.named("speed", sqrt(e))
    inputs = tuple(symbol for name in DERIVATIVES for symbol in p[name])
    return Program(inputs, tuple(s.steps), (rough, area, mean, speed))


def fairness_formulas() -> tuple[tuple[Expr, Expr], ...]:
    """Return the mean curvature H and |grad H|^2 per du dv, in both fundamental forms and the derivatives of H.

    H is half the trace of the second form (L, M, N) by the first (E, F, G); the gradient of a function on the surface
    has the square length of its derivatives by the inverse of the first form.

    Examples
    --------
    >>> fairness_formulas()[0]
    (H, (E*N - 2*F*M + G*L)/(2*(E*G - F**2)))
    """
    e, f, g = symbols("E F G")
    inverse = Matrix([[e, f], [f, g]]).inv()
    second = Matrix([[Symbol("L"), Symbol("M")], [Symbol("M"), Symbol("N")]])
    slopes = Matrix([Symbol("H_u"), Symbol("H_v")])
    mean = factor((inverse * second).trace() / 2)
    square = factor((slopes.T * inverse * slopes)[0])
    numerator, denominator = fraction(square)
    return (Symbol("H"), mean), (Symbol("g_H"), numerator * sqrt(denominator) / denominator)


def reversed_program(program: Program) -> Program:
    """Return the program of the gradient: from the inputs and a seed for each output to the adjoint of each input.

    Seeds are called `seed_` and adjoints `d_` with the name of what they belong to. The steps of the program itself
    come first, since the gradient needs their values.

    Source: reverse accumulation; A. Griewank and A. Walther, Evaluating Derivatives, 2008, ch. 3.

    Examples
    --------
    >>> x, y = Symbol("x"), Symbol("y")
    >>> reversed_program(Program((x,), ((y, x**2),), (y,))).steps[-1]
    (d_x, 2*seed_y*x)
    """
    seeds = {output: Symbol(f"seed_{output.name}") for output in program.outputs}
    parts: dict[Symbol, list[Expr]] = {output: [seed] for output, seed in seeds.items()}
    steps = list(program.steps)
    for name, value in reversed(program.steps):
        if name not in parts:
            continue
        adjoint = sum(parts[name], sympify(0))
        if not adjoint.is_Symbol:
            steps.append((Symbol(f"d_{name.name}"), adjoint))
            adjoint = Symbol(f"d_{name.name}")
        slopes = [(used, _slope(name, value, used)) for used in sorted(value.free_symbols, key=str)]
        doubled = 2 * adjoint
        if sum(abs(slope.as_coeff_Mul()[0]) == 2 for _, slope in slopes) > 1:
            doubled = Symbol(f"d2_{name.name}")
            steps.append((doubled, 2 * adjoint))
        for used, slope in slopes:
            factor, rest = slope.as_coeff_Mul()
            product = sign(factor) * doubled * rest if abs(factor) == 2 else adjoint * slope
            parts.setdefault(used, []).append(product)
    gradient = []
    for name in program.inputs:
        gradient.append(Symbol(f"d_{name.name}"))
        steps.append((gradient[-1], sum(parts.get(name, []), sympify(0))))
    return Program((*program.inputs, *seeds.values()), _needed(steps, gradient), tuple(gradient))


def _needed(steps: Sequence[tuple[Symbol, Expr]], outputs: Sequence[Symbol]) -> tuple[tuple[Symbol, Expr], ...]:
    """Return the steps without those that no output needs."""
    needed, kept = set(outputs), []
    for name, value in reversed(steps):
        if name in needed:
            needed |= value.free_symbols
            kept.append((name, value))
    return tuple(reversed(kept))


def _slope(name: Symbol, value: Expr, used: Symbol) -> Expr:
    """Return the derivative of a step; square roots and reciprocals are known by their own names."""
    if value == sqrt(used):
        return 1 / (2 * name)
    if value == 1 / used:
        return -(name**2)
    return value.diff(used)
