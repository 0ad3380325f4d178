"""Blossoms, and a Bezier patch divided by a Bezier function: exact control points of both sub-patches.

A patch P(u, v) of degrees (m, n) over the unit square is cut along v = v(u), v(t) a Bezier function of degree k. With
w running over [0, 1] across each sub-patch and u along it,

    bottom(u, w) = P(u, v(u) w) = sum_s Q_0^s(u) B_s^n(w),
    top(u, w)    = P(u, v(u) + (1 - v(u)) w) = sum_s Q_s^(n-s)(u) B_s^n(w),

where Q_j^s(u) has degree m + s k. `division_rows` gives the control points by blossoms; `expanded_rows` gives them by
substitution and change of basis alone. `division_residuals` compares the two over symbols, `division_lemmas` proves the
closed form for every m, n, k.

Numbers are exact: SymPy expressions, `Fraction`s, or elements of a SymPy polynomial ring. Control points are scalars
here; apply a function to each coordinate.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise, product
from math import comb, prod
from typing import Any, Literal

import sympy as sp

Exact = Any  # Fraction, SymPy expression, or ring element
Part = Literal["bottom", "top"]
PARTS: tuple[Part, Part] = ("bottom", "top")


def blossom(points: Sequence[Exact], arguments: Sequence[Exact]) -> Exact:
    """Return the polar form of the Bezier polynomial with these control points.

    Parameters
    ----------
    points : sequence of s + 1 exact numbers
        For the column i of a patch and a start j: P_ij, ..., P_i,j+s.
    arguments : sequence of s exact numbers
        One for each step of the de Casteljau triangle; their order does not matter (`blossom_swap`).

    Raises
    ------
    ValueError
        The number of arguments is not one less than that of the points, or a number is a float.

    Source: the recursion below equation (6) of the paper; L. Ramshaw, Blossoms are polar forms, CAGD 6 (1989).

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> sp.expand(blossom([0, 0, 1], [x, y]))
    x*y
    """
    if len(arguments) != len(points) - 1:
        raise ValueError(f"arguments: found {len(arguments)}, expected {len(points) - 1} for {len(points)} points")
    level = [_exact(p) for p in points]
    for x in map(_exact, arguments):
        level = [(1 - x) * low + x * high for low, high in pairwise(level)]
    return level[0]


def de_casteljau(points: Sequence[Exact], x: Exact) -> Exact:
    """Return a Bezier polynomial at x: its blossom with equal arguments."""
    return blossom(points, [x] * (len(points) - 1))


def division_curve(points: Sequence[Sequence[Exact]], function: Sequence[Exact], j: int, s: int) -> tuple[Exact, ...]:
    """Return the m + s k + 1 Bezier control points of Q_j^s(u), for s = 0 those of the row j itself.

    Parameters
    ----------
    points : nested sequences, (m + 1) x (n + 1)
        P_ij of the patch.
    function : sequence of k + 1 exact numbers
        v_0, ..., v_k.
    j, s : int
        0 <= s, 0 <= j, j + s <= n.

    Raises
    ------
    ValueError
        j or s out of range, or a number is a float.

    Source: the formula below equation (6) of the paper, proved by `division_lemmas`.

    Examples
    --------
    >>> division_curve([[0, 1], [0, 1]], [Fraction(1, 4), Fraction(3, 4)], 0, 1)
    (Fraction(1, 4), Fraction(1, 2), Fraction(3, 4))
    """
    m, n, k = len(points) - 1, len(points[0]) - 1, len(function) - 1
    if j < 0 or s < 0 or j + s > n:
        raise ValueError(f"(j, s): found ({j}, {s}), expected 0 <= j, 0 <= s and j + s <= {n}")
    rows = [[_exact(p) for p in row] for row in points]
    totals: list[list[Exact]] = [[] for _ in range(m + s * k + 1)]
    for i in range(m + 1):
        for indices in product(range(k + 1), repeat=s):
            degree_index = i + sum(indices)
            weight = comb(m, i) * prod(comb(k, r) for r in indices)
            value = blossom(rows[i][j : j + s + 1], [function[r] for r in indices])
            totals[degree_index].append(value * Fraction(weight, comb(m + s * k, degree_index)))
    return tuple(_total(terms) for terms in totals)


def division_rows(
    points: Sequence[Sequence[Exact]], function: Sequence[Exact], part: Part
) -> tuple[tuple[Exact, ...], ...]:
    """Return the control points of one sub-patch: n + 1 rows across, each a Bezier curve in u of its own degree.

    Row s of the bottom has degree m + s k, row s of the top degree m + (n - s) k.

    Parameters
    ----------
    points : nested sequences, (m + 1) x (n + 1)
        P_ij of the patch.
    function : sequence of k + 1 exact numbers
        v_0, ..., v_k.
    part : {"bottom", "top"}

    Raises
    ------
    ValueError
        A ragged net, an empty function, an unknown part, or a float.

    Source: equation (6) of the paper, re-derived.

    Examples
    --------
    >>> [len(row) for row in division_rows([[0, 0], [0, 1]], [0, 1], "bottom")]
    [2, 3]
    """
    _check_net(points, function, part)
    n = len(points[0]) - 1
    curves = [(0, s) for s in range(n + 1)] if part == "bottom" else [(s, n - s) for s in range(n + 1)]
    return tuple(division_curve(points, function, j, s) for j, s in curves)


def row_degrees(m: int, n: int, k: int, part: Part) -> tuple[int, ...]:
    """Return the degree in u of each row of a sub-patch.

    Examples
    --------
    >>> row_degrees(3, 3, 2, "top")
    (9, 7, 5, 3)
    """
    degrees = tuple(m + s * k for s in range(n + 1))
    return degrees if part == "bottom" else degrees[::-1]


def generic_patch(m: int, n: int, k: int) -> tuple[Any, Any, list[list[Any]], list[Any]]:
    """Return ring generators u, w, the symbolic net P_ij and the symbolic v_0..v_k, all in one ring over Q."""
    names = ["u", "w", *(f"v_{r}" for r in range(k + 1))]
    names += [f"P_{i}_{j}" for i in range(m + 1) for j in range(n + 1)]
    _, *symbols = sp.ring(names, sp.QQ)
    u, w, *rest = symbols
    net = [rest[k + 1 + i * (n + 1) : k + 1 + (i + 1) * (n + 1)] for i in range(m + 1)]
    return u, w, net, rest[: k + 1]


def expanded_rows(m: int, n: int, k: int, part: Part) -> tuple[tuple[Any, ...], ...]:
    """Return the rows of a sub-patch of the symbolic patch, found without blossoms.

    The Bezier function is substituted into the patch, the polynomial is expanded, and monomials are turned into
    Bernstein polynomials, of degree n across and of the least degree that holds the row along.

    Raises
    ------
    ValueError
        The row needs another degree than `row_degrees` says.
    """
    u, w, net, function = generic_patch(m, n, k)
    cut = sum((v * b for v, b in zip(function, _bernstein_all(k, u), strict=True)), 0 * u)
    x = cut * w if part == "bottom" else cut + (1 - cut) * w
    along, across = _bernstein_all(m, u), _bernstein_all(n, x)
    patch = sum((net[i][j] * along[i] * across[j] for i in range(m + 1) for j in range(n + 1)), 0 * u)
    by_w = _to_bernstein(_coefficients(patch, 1), n)
    rows = []
    for row, degree in zip(by_w, row_degrees(m, n, k, part), strict=True):
        monomials = _coefficients(row, 0)
        if max(monomials) != degree:
            raise ValueError(f"the row has degree {max(monomials)} in u, expected {degree}")
        rows.append(_to_bernstein(monomials, degree))
    return tuple(rows)


def division_residuals(m: int, n: int, k: int, part: Part) -> tuple[Any, ...]:
    """Return all differences between the closed form and the expansion, over symbolic P_ij and v_r: all zero.

    Examples
    --------
    >>> set(division_residuals(1, 2, 1, "top"))
    {0}
    """
    _, _, net, function = generic_patch(m, n, k)
    closed = division_rows(net, function, part)
    expanded = expanded_rows(m, n, k, part)
    return tuple(a - b for one, other in zip(closed, expanded, strict=True) for a, b in zip(one, other, strict=True))


def blossom_swap() -> sp.Expr:
    """Return two neighbouring steps of the blossom minus the same in the other order: zero, so order never matters."""
    x, y, p, q, r = sp.symbols("x y p q r")
    return sp.expand(blossom([p, q, r], [x, y]) - blossom([p, q, r], [y, x]))


def division_lemmas() -> dict[str, sp.Expr]:
    """Return the identities that prove `division_rows` for all m, n, k; each value must be zero.

    With v fixed, the sub-patch below v has the control points P_ij^s[v, ..., v] (`subdivision`, then the binomial
    theorem, whose base is checked by `collect`); the one above follows by `mirror`. Now v = sum_r v_r B_r^k(u), and
    each blossom argument is affine (`affine`; the weights B_r^k(u) sum to one), so the blossom is the sum of
    blossoms at v_r, weighted by a product of Bernstein polynomials, and B_i^m(u) is one more factor (`product`).

    Examples
    --------
    >>> set(division_lemmas().values())
    {0}
    """
    u, v, w, x, p, q = sp.symbols("u v w x p q", positive=True)
    a, b, i, j, n, s = sp.symbols("a b i j n s", integer=True, nonnegative=True)
    weight = sp.binomial(a, i) * sp.binomial(b, j) / sp.binomial(a + b, i + j)
    both = weight * _bernstein(a + b, i + j, u) / (_bernstein(a, i, u) * _bernstein(b, j, u))
    revision = (sp.binomial(n, s) * sp.binomial(s, j)) / (sp.binomial(n, j) * sp.binomial(n - j, s - j))
    powers = (w**s * (1 - w) ** (n - s) * v**j * (1 - v) ** (s - j)) / (
        (v * w) ** j * (w * (1 - v)) ** (s - j) * (1 - w) ** (n - s)
    )
    step = blossom([p, q], [v * w + (1 - v) * x]) - v * blossom([p, q], [w]) - (1 - v) * blossom([p, q], [x])
    return {
        "product": sp.powsimp(sp.gammasimp(both.rewrite(sp.gamma)), force=True) - 1,
        "subdivision": sp.gammasimp(revision.rewrite(sp.gamma)) * sp.powsimp(sp.expand_power_base(powers)) - 1,
        "collect": sp.expand((1 - w) + w * (1 - v) - (1 - v * w)),
        "mirror": sp.expand(1 - (v + (1 - v) * w) - (1 - v) * (1 - w)),
        "affine": sp.expand(step),
        "symmetric": blossom_swap(),
    }


def _exact(value: Exact) -> Exact:
    if isinstance(value, float | sp.Float):
        raise ValueError(f"found the float {value}, expected an exact number: write it as a Fraction")
    return Fraction(value) if isinstance(value, int) else value


def _total(terms: list[Exact]) -> Exact:
    return sum(terms[1:], terms[0])


def _check_net(points: Sequence[Sequence[Exact]], function: Sequence[Exact], part: str) -> None:
    if part not in PARTS:
        raise ValueError(f"part: found {part!r}, expected 'bottom' or 'top'")
    if not points or not points[0] or not function:
        raise ValueError("points and function: expected at least one control point each")
    for i, row in enumerate(points):
        if len(row) != len(points[0]):
            raise ValueError(f"points[{i}]: found {len(row)} points, expected {len(points[0])} as in points[0]")


def _bernstein(n: Any, i: Any, t: Any) -> sp.Expr:
    return sp.binomial(n, i) * t**i * (1 - t) ** (n - i)


def _bernstein_all(n: int, t: Any) -> list[Any]:
    """Return all Bernstein polynomials of degree n at a ring element t."""
    return [comb(n, i) * t**i * (1 - t) ** (n - i) for i in range(n + 1)]


def _coefficients(polynomial: Any, generator: int) -> dict[int, Any]:
    """Split a ring element by the powers of one generator: {power: coefficient}."""
    parts: dict[int, dict[tuple[int, ...], Any]] = defaultdict(dict)
    for exponents, coefficient in polynomial.terms():
        rest = (*exponents[:generator], 0, *exponents[generator + 1 :])
        parts[exponents[generator]][rest] = coefficient
    return {power: polynomial.ring.from_dict(terms) for power, terms in parts.items()}


def _to_bernstein(monomials: dict[int, Any], degree: int) -> tuple[Any, ...]:
    """Return Bernstein coefficients: t^r = sum over s >= r of [C(s, r) / C(degree, r)] B_s."""
    zero = 0 * next(iter(monomials.values()))
    return tuple(
        sum((a * Fraction(comb(s, r), comb(degree, r)) for r, a in monomials.items() if r <= s), zero)
        for s in range(degree + 1)
    )
