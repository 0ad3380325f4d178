"""Deciding how often the least energy over alpha and beta lies where a blend leaves a base at an angle, on strips.

Two bases face each other if the way out of each makes an acute angle with the chord from contact to contact. The
family: straight strips of unit speed in one plane, theta and phi the angles, with signs, that the way out of R and
the way into S make with the chord of length d; G2 by the corrected conditions, so that the blend has P_u = alpha^2
and beta^2 along these ways, and P_uu = 0. Its energy is quadratic in a = alpha^2 and b = beta^2.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp

from semispline.papers.ledger import Case, Check, Consequence, Counterexample, Formula, Strength, given
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.printed import CUBIC

COS_THETA, COS_PHI, COS_BETWEEN, BEST = sp.symbols("c_theta c_phi c_between a_best", real=True)
GAP = sp.Symbol("d", positive=True)
# Where the energy over alpha^2 is least, all real numbers allowed; one middle curve, as in the paper's examples.
BEST_ALPHA = Formula(
    sp.Eq(
        BEST,
        64 * GAP * (39 * COS_THETA - 25 * COS_PHI * COS_BETWEEN) / (1521 - 625 * COS_BETWEEN**2),
    ),
    (BEST, GAP, COS_THETA, COS_PHI, COS_BETWEEN),
)
# Pythagorean angles: cosine and sine.
_TO_4_3, _TO_7_24 = (sp.Rational(4, 5), sp.Rational(3, 5)), (sp.Rational(7, 25), sp.Rational(24, 25))
_ALONG = (sp.Integer(1), sp.Integer(0))
PLATES: dict[str, tuple[tuple[Any, Any], tuple[Any, Any]]] = {
    "both along the chord": (_ALONG, _ALONG),
    "an arch, 37 degrees at both": (_TO_4_3, (_TO_4_3[0], -_TO_4_3[1])),
    "an S, 37 degrees at both": (_TO_4_3, _TO_4_3),
    "an arch, 74 degrees at both": (_TO_7_24, (_TO_7_24[0], -_TO_7_24[1])),
    "74 degrees at one, 37 at the other, on one side": (_TO_7_24, _TO_4_3),
}


@cache
def strip_energy(m: int = 6) -> tuple[Any, Any, tuple[Any, ...]]:
    """Return the energy in a, b and the cosines, for m + 1 rows, and a and b where it is least."""
    p, q, r = sp.symbols("p q r")
    form = sp.Poly(energy.end_energy(CUBIC, m, (0, p, 0, q, r, 0)), p, q, r)
    a, b = sp.symbols("a b", real=True)
    products = {
        **{(2, 0, 0): a**2, (0, 0, 2): b**2, (0, 2, 0): GAP**2, (1, 0, 1): a * b * COS_BETWEEN},
        **{(1, 1, 0): a * GAP * COS_THETA, (0, 1, 1): b * GAP * COS_PHI},
    }
    total = sum(coefficient * products[powers] for powers, coefficient in form.terms())
    solved = sp.solve([total.diff(a), total.diff(b)], [a, b], dict=True)[0]
    return total, solved[a], (a, b)


def facing_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide where the energy over alpha^2 is least, for every pair of angles; then plates, true where both are G1."""
    relation = given(formula).relation
    total, best, unknowns = strip_energy()
    residual = sp.cancel(relation.rhs - relation.lhs + BEST - best)
    yield Case("every gap and pair of angles", bool(residual == 0), residual=residual)
    hessian = sp.hessian(total, unknowns)
    convex = bool(hessian[0, 0].is_positive) and sp.expand(hessian.det()) == sp.expand(
        169 - (sp.Rational(25, 3) * COS_BETWEEN) ** 2
    )
    yield Case("a minimum: the determinant is 169 - 625/9 cos^2", bool(convex))
    for label, angles in PLATES.items():
        positive = all(value > 0 for value in _best_of(relation, angles))
        meets = all(39 * one[0] > 25 * other[0] * _between(angles) for one, other in (angles, angles[::-1]))
        yield Case(f"plates that face each other, {label}", positive, own=meets, meets=meets)


def _between(angles: tuple[tuple[Any, Any], tuple[Any, Any]]) -> Any:
    (c, s), (c_2, s_2) = angles
    return c * c_2 + s * s_2


def _best_of(relation: Any, angles: tuple[tuple[Any, Any], tuple[Any, Any]]) -> list[Any]:
    """Return alpha^2 and beta^2 of least energy by a formula, which is one for both."""
    values = []
    for one, other in (angles, angles[::-1]):
        at = {COS_THETA: one[0], COS_PHI: other[0], COS_BETWEEN: _between(angles), GAP: 1}
        values.append((relation.rhs - relation.lhs + BEST).subs(at))
    return values


FACING_CHECK = Check(
    facing_cases,
    Strength.GENERAL,
    "the exact energy of strips between straight plates of unit speed, for every gap and pair of exit angles, k = 4 "
    "and one middle curve",
    proof=True,
)


def facing_counterexample() -> Counterexample:
    """Return plates that face each other and want alpha^2 < 0."""
    label, angles = list(PLATES.items())[-1]
    best = _best_of(BEST_ALPHA.relation, angles)
    values = (("exits", label), ("cosines", f"{angles[0][0]}, {angles[1][0]}"), ("gap", "1"))
    return Counterexample(values, "alpha^2 > 0", f"the energy is least at alpha^2 = {best[0]}, beta^2 = {best[1]}")


def facing_shares() -> Consequence:
    """Tell for how many pairs of exit angles the energy is least at alpha^2 <= 0 or beta^2 <= 0, and of the suite."""
    measured: dict[str, float] = {}
    for m in (5, 6):
        measured[f"share of exit angles below 90 degrees, {m - 5} middle curves"] = _share(m)
    measured["crease at alpha = 0 between plates at 74 and 37 degrees [degrees]"] = _crease(*list(PLATES.values())[-1])
    wants = json.loads((Path(__file__).parents[1] / "shapes.json").read_text(encoding="utf-8"))["facing"]["wants"]
    measured |= {"random facing pairs of the suite": wants["told"], "of these": wants["not positive"]}
    return on_surface(
        "Pairs for which (11) is least at alpha^2 <= 0 or beta^2 <= 0: the family, and docs/shapes.md", measured
    )


def _crease(theta: tuple[Any, Any], phi: tuple[Any, Any]) -> float:
    """Return the angle between the way out of R and the blend of least energy with alpha = 0, gap 1, one middle curve.

    Rows 0 to 2 are one then, and the blend leaves them towards row 3.
    """
    b = sp.Symbol("b", real=True)
    data = [(0, 0, 0, end, b * into, 0) for end, into in zip((1, 0), phi, strict=True)]
    (best,) = sp.solve(sum(energy.end_energy(CUBIC, 6, along) for along in data).diff(b), b)
    x, y = (float(energy.middle_row(along).subs(b, best)) for along in data)
    return math.degrees(math.acos((x * theta[0] + y * theta[1]) / math.hypot(x, y)))


def _share(m: int, steps: int = 400) -> float:
    """Return the share of pairs of angles, each even between -90 and 90 degrees, on a grid of midpoints."""
    _, best, _ = strip_energy(m)
    function = sp.lambdify((COS_THETA, COS_PHI, COS_BETWEEN), best.subs(GAP, 1), "numpy")
    angles = np.pi * ((np.arange(steps) + 0.5) / steps - 0.5)
    theta, phi = np.meshgrid(angles, angles, indexing="ij")
    cosines = np.cos(theta), np.cos(phi), np.cos(theta - phi)
    alpha, beta = function(*cosines), function(cosines[1], cosines[0], cosines[2])
    return float(np.mean((alpha <= 0) | (beta <= 0)))
