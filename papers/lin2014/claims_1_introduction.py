"""Abstract, introduction, related work, conclusion."""

from __future__ import annotations

from papers.ledger import Claim, Reading, Strength
from papers.lin2014 import blending_checks as blending
from papers.lin2014 import figure_checks as figures
from papers.lin2014 import printed as pr
from papers.lin2014.claims_3_conditions import TRUE_3_1
from papers.lin2014.contact_checks import row_check
from papers.lin2014.property_checks import proved, question
from papers.lin2014.records import ambiguous, holds, holds_if, not_checkable, part

_RELATED = "Section 1.1"
_OTHERS = "a statement on other publications, which are not here"

CLAIMS: tuple[Claim, ...] = (
    holds("sec-0.undisturbed", "Abstract", "Both bases are met exactly without changing them.",
          part(question(blending.contact_curve_cases, "the contact curve of a base and its first row")),
          part(proved(blending.three_row_cases, "the derived rows, over the base's own knots", Strength.EACH_ORDER))),
    ambiguous("sec-0.reaches", "Abstract and section 6", "The continuity between bases and blend reaches G2 and C2.",
              Reading((part(row_check("start", 2), TRUE_3_1),),
                      label="what the representation can do, with the right conditions"),
              Reading((part(row_check("start", 2), pr.COND_3_1),),
                      label="what the conditions as printed do")),
    holds("sec-1.superfluous-knots", "Section 1", "Giving both contact curves the same knots adds control points.",
          part(question(figures.superfluous_cases, "rows on their own knots and on the union, as printed"))),
    holds("sec-1.knot-insertion", "Section 1", "Knot insertion makes the knots of both contact curves identical.",
          part(question(blending.nested_space_cases, "spline spaces over the printed pairs, by exact rank"))),
    holds_if("sec-1.rolling-ball", _RELATED, "A rolling-ball blend meets its bases with G1 at the most.",
             "the curvature of the base across the contact is not that of the ball",
             part(question(figures.circle_cases, "curvature of a circle and of the base"))),
    holds("sec-1.quintic", _RELATED, "A Bezier curve across that meets both bases with two derivatives is quintic.",
          part(proved(figures.hermite_cases, "rank of the six end conditions, degrees 2 to 7", Strength.EACH_ORDER))),
    holds("sec-1.cubic", _RELATED, "A cubic blend with inner knots does the same.",
          part(proved(figures.cubic_cases, "determinant of the end derivatives", Strength.EACH_ORDER))),
    holds("sec-1.hartmann-contact", _RELATED, "Hartmann's combination of two bases is G^n.",
          part(proved(figures.hartmann_contact_cases, "derivatives of f at the ends, n = 1 to 3", Strength.EACH_ORDER)),
          remark="For f = mu (1-t)^(n+1) / (mu (1-t)^(n+1) + (1-mu) t^(n+1)), well known; [17] itself is not here."),
    ambiguous("sec-1.hartmann-nurbs", _RELATED, "Such a blend can be written as NURBS only approximately.",
              Reading((part(question(figures.hartmann_rational_cases(splines=False), "numerator and denominator")),),
                      label="for parametric bases in general"),
              Reading((part(question(figures.hartmann_rational_cases(splines=True), "numerator and denominator")),),
                      label="for B-spline bases with a common parameter"),
              remark="f is rational with a positive denominator: for spline bases the blend is exactly rational, of "
              "degree p + n + 1 across."),
    not_checkable("sec-1.bezier-shapes", _RELATED, "[9, 10] reach C1 G2 by moving control points.", _OTHERS),
    not_checkable("sec-1.ref-13", _RELATED, "[13] needs equal knot vectors and reaches just G1 (or C1).", _OTHERS),
    not_checkable("sec-1.few-g2-methods", _RELATED, "Few methods give G2 or higher parametric blends [1].", _OTHERS),
    not_checkable("sec-1.pde", _RELATED, "PDE blends [14, 15] are usually found by numerical approximation.", _OTHERS),
    not_checkable("sec-1.ref-16", _RELATED, "[16] needs derivatives that may be hard to compute exactly.", _OTHERS),
    not_checkable("sec-1.point-based", _RELATED, "T-splines and semi-regular splines are point-based.",
                  "a way to look at a representation, not a property of it"),
    not_checkable("sec-1.hayes", _RELATED, "Hayes' splines need equal numbers of knots in each vector.", _OTHERS),
    not_checkable("sec-1.divided-patches", _RELATED, "[24, 25] did not note how divided patches are built.", _OTHERS),
)  # fmt: skip
