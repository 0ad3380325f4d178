"""Deciding what pictures of a blend show: mean curvature and zebra stripes across a contact, bending energy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case


def mean_curvature_cases(mean: Callable[..., Any] | None = None) -> Iterator[Case]:
    """Yield that for a tangent-continuous join equal mean curvature along the contact means equal curvatures.

    L = N . P_uu is the only second-order quantity that can differ, and H depends on it with the factor G / 2(EG - F^2).
    """
    E, F, G, L, M, N = sp.symbols("E F G L M N", real=True)
    mean = mean or (lambda: (E * N - 2 * F * M + G * L) / (2 * (E * G - F**2)))
    factor = sp.diff(mean(), L)
    yield Case("H is linear in L", bool(sp.diff(factor, L) == 0))
    # G is the square of a length, and so is E G - F^2 of an area.
    length, area = sp.symbols("l A", positive=True)
    value = sp.cancel(factor.subs(E, (area**2 + F**2) / G)).subs(G, length**2)
    yield Case("with a factor that is not zero", bool(value.is_nonzero))


# A join as two graphs z(x, y) over one plane, with the contact along x = 0 and the same z, z_x there; hence the same
# z_y, z_xy, z_yy. They are G2 if z_xx agrees too; a and b are the two values.
_P, _Q, _SHEAR, _ALONG, _ONE, _OTHER = sp.symbols("p q s c a b", real=True)
Light = tuple[Any, Any, Any]


def unit_normal(p: Any, q: Any) -> Any:
    """Return the normal of a graph with z_x = p, z_y = q."""
    return sp.Matrix([-p, -q, 1]) / sp.sqrt(1 + p**2 + q**2)


def _kink(light: Light, normal: Callable[[Any, Any], Any] = unit_normal) -> Any:
    """Return the jump across the contact of the derivative of N . light, of which zebra stripes are a function."""
    shade = normal(_P, _Q).dot(sp.Matrix(light))

    def across(second: Any) -> Any:
        return shade.diff(_P) * second + shade.diff(_Q) * _SHEAR

    return sp.simplify(across(_OTHER) - across(_ONE))


def stripe_cases(normal: Callable[[Any, Any], Any] = unit_normal) -> Iterator[Case]:
    """Yield that stripes run on where tangent planes agree, without a kink for every light just where curvatures do."""
    lights = sp.symbols("d_1 d_2 d_3", real=True)
    shade = normal(_P, _Q).dot(sp.Matrix(lights))
    yield Case("stripes depend on z_x and z_y alone", not shade.has(_ONE, _OTHER, _SHEAR, _ALONG))
    kink = _kink(lights, normal)
    yield Case("no kink where z_xx agrees", bool(sp.simplify(kink.subs(_OTHER, _ONE)) == 0))
    # Coefficients of the three directions of light, over the jump of z_xx: N_p, which is not zero.
    parts = [sp.cancel(sp.diff(kink, d) / (_OTHER - _ONE)) for d in lights]
    length = sp.simplify(sum(part**2 for part in parts))
    yield Case("a kink for some light where it does not", bool(length.is_positive))


def graph_mean(second: Any) -> Any:
    """Return H of a graph with z_xx = `second`."""
    top = (1 + _Q**2) * second - 2 * _P * _Q * _SHEAR + (1 + _P**2) * _ALONG
    return top / (2 * sp.sqrt(1 + _P**2 + _Q**2) ** 3)


def graph_mean_cases(mean: Callable[[Any], Any] = graph_mean) -> Iterator[Case]:
    """Yield that H of a graph jumps wherever z_xx does, the rest being the same."""
    jump = sp.cancel((mean(_OTHER) - mean(_ONE)) / (_OTHER - _ONE))
    yield Case("the jump of H over that of z_xx", bool(sp.simplify(jump).is_positive))


def reflection_cases(normal: Callable[[Any, Any], Any] = unit_normal) -> Iterator[Case]:
    """Yield what reflected stripes show to a distant eye e: they are a function of the ray R = 2 (N . e) N - e.

    R depends on the normal alone. Its derivative across jumps by R' = 2 (N' . e) N + 2 (N . e) N', N' being the jump of
    that of the normal, at right angles to N: |R'|^2 = 4 (N' . e)^2 + 4 (N . e)^2 |N'|^2 is zero only where N' is, if
    N . e is not zero, that is if the eye sees the contact from above or below.
    """
    unit = normal(_P, _Q)
    jump = (unit.diff(_P) * (_OTHER - _ONE)).applyfunc(sp.simplify)
    yield Case("N' is at right angles to N", bool(sp.simplify(jump.dot(unit)) == 0))
    yield Case("N' is zero where z_xx agrees", jump.subs(_OTHER, _ONE).is_zero_matrix is True)
    gap = sp.Symbol("b - a", real=True, nonzero=True)
    size = sp.factor(sp.simplify(jump.dot(jump) / (_OTHER - _ONE) ** 2)) * gap**2
    yield Case("and only there", bool(size.is_positive))
    seen, aside = sp.Symbol("N . e", real=True, nonzero=True), sp.Symbol("N' . e", real=True)
    # |N|^2 = 1 and N . N' = 0.
    square = sp.expand((2 * aside) ** 2 + (2 * seen) ** 2 * size)
    yield Case("R has a kink wherever N has one", bool(square.is_positive))


def revealed_cases(normal: Callable[[Any, Any], Any] = unit_normal) -> Iterator[Case]:
    """Yield directions d at a contact with p = q = 0 whose curvature jumps: true where the stripes have a kink.

    The contact runs along y, its normal along z. Isophotes are a function of N . d, reflections to the eye e of R . d.
    """
    for label, light, meets in (
        ("isophotes, d across the contact", (1, 0, 0), True),
        ("isophotes, d oblique to it", (1, 2, 3), True),
        ("isophotes, d along the contact", (0, 1, 0), False),
        ("isophotes, d along the normal", (0, 0, 1), False),
    ):
        seen = _kink(light, normal).subs({_P: 0, _Q: 0}) != 0
        yield Case(label, bool(seen), own=meets, meets=meets)
    slanted, above = (sp.Rational(3, 5), 0, sp.Rational(4, 5)), (0, 0, 1)
    for label, light, eye, meets in (
        ("reflections, e = (3/5, 0, 4/5), d along the normal", (0, 0, 1), slanted, True),
        ("reflections, e along the normal, d across", (1, 0, 0), above, True),
        ("reflections, e along the normal, d along the contact", (0, 1, 0), above, False),
        (
            "reflections, e = (3/5, 0, 4/5), d = (-3/5, 0, 4/5)",
            (-sp.Rational(3, 5), 0, sp.Rational(4, 5)),
            slanted,
            False,
        ),
    ):
        seen = _mirrored_kink(light, eye, normal) != 0
        yield Case(label, bool(seen), own=meets, meets=meets)


def _mirrored_kink(light: Light, eye: Light, normal: Callable[[Any, Any], Any]) -> Any:
    """Return the jump of the derivative of R . light across a contact with p = q = 0."""
    unit = normal(_P, _Q)
    shade = (2 * unit.dot(sp.Matrix(eye)) * unit - sp.Matrix(eye)).dot(sp.Matrix(light))
    slope = shade.diff(_P) * (_OTHER - _ONE)
    return sp.simplify(slope.subs({_P: 0, _Q: 0}))


def unsigned_cases(mean: Callable[[Any], Any] = graph_mean) -> Iterator[Case]:
    """Yield joins with p = q = 0, straight along the contact, whose z_xx jumps: true where |H| jumps as well."""
    for one, other in ((0, 1), (-1, 1)):
        flat = dict.fromkeys((_P, _Q, _SHEAR, _ALONG), 0)
        sides = [sp.Abs(sp.sympify(mean(sp.Integer(second))).subs(flat)) for second in (one, other)]
        yield Case(f"z_xx from {one} to {other}", bool(sides[0] != sides[1]))


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


def bending_cases(*, saddle: bool) -> Any:
    """Return the check that kappa_1^2 + kappa_2^2 is 4 H^2: for kappa_2 = 0, or for any principal curvatures."""

    def cases() -> Iterator[Case]:
        first, second = sp.symbols("kappa_1 kappa_2", real=True)
        other = second if saddle else sp.Integer(0)
        residual = sp.expand(first**2 + other**2 - (first + other) ** 2)
        yield Case("any kappa_2" if saddle else "kappa_2 = 0", bool(residual == 0), residual=residual)

    return cases
