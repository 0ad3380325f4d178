"""A checker of proofs: does a polynomial stay above a bound over a box? It shares no code with the search.

It trusts only the definition: the parts must tile the box; on each, the polynomial written in the part's own
parameters by Taylor shifts must have no Bernstein coefficient below the bound, or be convex and lie above a tangent
plane that stays above the bound, or be the bound plus sums of squares and multiples of them. Everything is rational
arithmetic.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from math import comb
from typing import TypeAlias

from semispline.solver.errors import ComputationError
from semispline.solver.proof.certificates import Certificate, Gram, Leaf

_Table: TypeAlias = list[list[Fraction]]


class CertificateError(ComputationError):
    """A certificate that does not prove what it claims."""


def check_certificate(certificate: Certificate) -> None:
    """Verify in exact arithmetic that the claimed point is a minimum over the box, up to the tolerance.

    Raises
    ------
    CertificateError
        The parts do not tile the box, one of them does not prove the bound, or the value at the point is further above
        the bound than the tolerance; the message names what is wrong.

    Source: J. Garloff, The Bernstein algorithm, Interval Computations 2 (1993), for range bounds.
    """
    try:
        _check(certificate)
    except (ArithmeticError, AttributeError, IndexError, TypeError, ValueError) as error:
        raise CertificateError(f"certificate: malformed ({error})") from None


def _check(certificate: Certificate) -> None:
    _check_tiling(certificate)
    table = [[Fraction(c) for c in row] for row in certificate.coefficients.tolist()]
    bound = Fraction(certificate.bound)
    point = [Fraction(x) for x in certificate.point]
    if not all(low <= x <= high for x, (low, high) in zip(point, certificate.box, strict=True)):
        raise CertificateError(f"certificate: the point {certificate.point} lies outside of the box")
    if not 0 <= _value(table, point) - bound <= Fraction(certificate.tolerance):
        raise CertificateError(
            f"certificate: the value at the point is not within {certificate.tolerance:.1e} above the bound"
        )
    for leaf in certificate.leaves:
        ends = [_ends(box, part) for box, part in zip(certificate.box, (leaf.x, leaf.y), strict=True)]
        if leaf.squares is not None:
            middles = [((low + high) / 2, high) for low, high in ends]
            _check_squares(_transposed(_local(_transposed(_local(table, *middles[0])), *middles[1])), leaf, bound)
            continue
        local = _transposed(_local(_transposed(_local(table, *ends[0])), *ends[1]))
        if leaf.tangent_at is None:
            if min(min(row) for row in _bernstein_table(local)) < bound:
                raise CertificateError(f"certificate: the Bernstein coefficients on {leaf} fall below the bound")
        else:
            _check_tangent(local, leaf, bound)


def _check_tiling(certificate: Certificate) -> None:
    parts = [
        tuple((Fraction(i, 2**s), Fraction(i + 1, 2**s)) for i, s in (leaf.x, leaf.y)) for leaf in certificate.leaves
    ]
    area = sum(((x1 - x0) * (y1 - y0) for (x0, x1), (y0, y1) in parts), Fraction(0))
    if area != 1 or any(not (low >= 0 and high <= 1) for part in parts for low, high in part):
        raise CertificateError(f"certificate: its parts have area {area} of the box, expected 1")
    for one, other in combinations(parts, 2):
        if all(max(a[0], b[0]) < min(a[1], b[1]) for a, b in zip(one, other, strict=True)):
            raise CertificateError("certificate: two of its parts overlap")


def _ends(box: tuple[float, float], part: tuple[int, int]) -> tuple[Fraction, Fraction]:
    low, width = Fraction(box[0]), Fraction(box[1]) - Fraction(box[0])
    return low + width * Fraction(part[0], 2 ** part[1]), low + width * Fraction(part[0] + 1, 2 ** part[1])


def _local(table: _Table, low: Fraction, high: Fraction) -> _Table:
    """Write a table of powers of x (rows) in powers of t, x = low + (high - low) t, by repeated Horner steps."""
    rows = [list(row) for row in table]
    n = len(rows)
    for k in range(n - 1):
        for i in range(n - 2, k - 1, -1):
            rows[i] = [a + low * b for a, b in zip(rows[i], rows[i + 1], strict=True)]
    width = high - low
    return [[c * width**i for c in row] for i, row in enumerate(rows)]


def _transposed(table: _Table) -> _Table:
    return [list(column) for column in zip(*table, strict=True)]


def _bernstein(values: list[Fraction]) -> list[Fraction]:
    n = len(values) - 1
    return [
        sum((Fraction(comb(i, k), comb(n, k)) * values[k] for k in range(i + 1)), Fraction(0)) for i in range(n + 1)
    ]


def _bernstein_table(table: _Table) -> _Table:
    along = [_bernstein(row) for row in table]
    return _transposed([_bernstein(column) for column in _transposed(along)])


def _derived(table: _Table) -> _Table:
    """Differentiate by the parameter of the rows."""
    return [[i * c for c in row] for i, row in enumerate(table)][1:] or [[Fraction(0)] * len(table[0])]


def _check_tangent(local: _Table, leaf: Leaf, bound: Fraction) -> None:
    """Require that the part is convex and that its tangent plane at the given point stays above the bound."""
    by_s = _derived(local)
    by_t = _transposed(_derived(_transposed(local)))
    ss, tt = _derived(by_s), _transposed(_derived(_transposed(by_t)))
    st = _transposed(_derived(_transposed(by_s)))
    least_ss, least_tt = (min(min(row) for row in _bernstein_table(t)) for t in (ss, tt))
    largest_st = max(max(abs(c) for c in row) for row in _bernstein_table(st))
    if least_ss < 0 or least_tt < 0 or least_ss * least_tt < largest_st**2:
        raise CertificateError(f"certificate: {leaf} is not proved convex")
    at = [Fraction(t) for t in leaf.tangent_at or ()]
    if not all(0 <= t <= 1 for t in at):
        raise CertificateError(f"certificate: the tangent point of {leaf} lies outside of it")
    least = _value(local, at)
    for slope, t in zip((_value(by_s, at), _value(by_t, at)), at, strict=True):
        least += min(-slope * t, slope * (1 - t))
    if least < bound:
        raise CertificateError(f"certificate: the tangent plane on {leaf} falls below the bound")


def _check_squares(local: _Table, leaf: Leaf, bound: Fraction) -> None:
    """Require f - bound = z'Q0z + (1 - x^2) l'Q1l + (1 - y^2) l'Q2l, x and y from -1 to 1, all Q semidefinite."""
    if leaf.squares is None or len(leaf.squares) != 3:
        raise ValueError("expected three matrices")
    first, second, third = leaf.squares
    where = f"certificate: part {leaf.x}, {leaf.y}"
    quadratic = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    left = {(i, j): c for i, row in enumerate(local) for j, c in enumerate(row)}
    left[0, 0] -= bound
    for gram, monomials, factor in (
        (first, quadratic, {(0, 0): 1}),
        (second, quadratic[:3], {(0, 0): 1, (2, 0): -1}),
        (third, quadratic[:3], {(0, 0): 1, (0, 2): -1}),
    ):
        if not _is_semidefinite(gram, len(monomials)):
            raise CertificateError(f"{where}: a matrix of its sums of squares is not positive semidefinite")
        for one, row in zip(monomials, gram, strict=True):
            for other, entry in zip(monomials, row, strict=True):
                for power, sign in factor.items():
                    exponents = one[0] + other[0] + power[0], one[1] + other[1] + power[1]
                    left[exponents] = left.get(exponents, Fraction(0)) - sign * entry
    if any(left.values()):
        raise CertificateError(f"{where}: its sums of squares are not the polynomial minus the bound")


def _is_semidefinite(gram: Gram, size: int) -> bool:
    """Eliminate symmetrically: no pivot may be negative, and where one is zero its whole row must be."""
    rows = [[Fraction(entry) for entry in row] for row in gram]
    if len(rows) != size or any(len(row) != size for row in rows):
        raise ValueError(f"a matrix of {len(rows)} rows, expected {size} x {size}")
    if any(rows[i][j] != rows[j][i] for i in range(size) for j in range(i)):
        return False
    while rows:
        (pivot, *top), *rest = rows
        if pivot < 0 or (pivot == 0 and any(top)):
            return False
        rows = [[e - (row[0] * t / pivot if pivot else 0) for e, t in zip(row[1:], top, strict=True)] for row in rest]
    return True


def _value(table: _Table, at: list[Fraction]) -> Fraction:
    return sum(
        (c * at[0] ** i * at[1] ** j for i, row in enumerate(table) for j, c in enumerate(row)),
        Fraction(0),
    )
