"""How many control points the rows of a divided Bezier patch have."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from semispline.derivations.bezier import row_degrees
from semispline.papers.ledger import Claim, Formula
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.bezier_patch import DEGREES
from semispline.papers.recheck import Draft, Statement, Text, identity, text


def row_counts(part: str) -> Callable[[Claim], Draft]:
    """Return the draft of the number of control points of each row of a sub-patch."""

    def draft(claim: Claim) -> Draft:
        formula = claim.formulas[0]
        return Draft([row_count_cases(formula, part)], believed=(DEGREE,))

    return draft


DEGREE = "a sum of products of m + s k factors of degree 1 in u has degree m + s k at the most"


def row_count_cases(formula: Formula, part: str) -> Iterator[Statement]:
    """Yield degrees: the patch u^m v^s over v(u) = u^k needs as many points as printed, and the derived rows have."""
    printed = formula.relation.rhs
    powers = pr.s if part == "bottom" else pr.n - pr.s
    yield identity("every m, n, k, s", printed, Text(f"m + ({text(powers)})*k + 1", 1))
    for m, n, k in DEGREES:
        derived = row_degrees(m, n, k, "bottom" if part == "bottom" else "top")
        for r in range(n + 1):
            points = printed.subs({pr.s: r, pr.m: m, pr.n: n, pr.k: k})
            power = r if part == "bottom" else n - r
            label = f"degrees {m}, {n}, {k}, row {r}"
            yield identity(
                f"{label}: the patch u^m v^{power}", f"u^{m}*(u^{k})^{power}", f"u^{points - 1}", own=m == n == 3
            )
            yield identity(f"{label}: the derived row", points, Text(f"{derived[r]} + 1", 1), own=m == n == 3)


def last_row(claim: Claim) -> Draft:
    """Return the name of the last row of the top sub-patch."""

    def case(formula: Formula, *, equal: bool) -> Statement:
        j, s = formula.relation.lhs.args
        return identity(
            f"every m, n, k: Q_j^s with j = {j}, s = {s}",
            Text(f"m + ({text(s)})*k + 1", 1),
            formula.relation.rhs,
            equal=equal,
            conditions=("n > 0", "k > 0"),
        )

    return Draft([[case(claim.formulas[0], equal=False)]], [case(claim.corrected_formulas[0], equal=True)], (DEGREE,))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-2.bottom-counts": row_counts("bottom"),
    "sec-2.top-counts": row_counts("top"),
    "sec-2.top-last-row": last_row,
}
