"""Abstract, introduction, related work, conclusion."""

from __future__ import annotations

from collections.abc import Iterator

from semispline.papers.checks import count_check
from semispline.papers.ledger import (
    Case,
    Check,
    Claim,
    Correction,
    Formula,
    Reading,
    Strength,
    ambiguous,
    consistent,
    definition,
    holds,
    holds_if,
    not_checkable,
    part,
    proved,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import construction, hartmann, other_methods
from semispline.papers.lin2014.checks import converted_blends as converted
from semispline.papers.lin2014.checks import printed_numbers as numbers
from semispline.papers.lin2014.checks.contact_rows import row_check
from semispline.papers.lin2014.checks.counts import knot_count_instances
from semispline.papers.lin2014.checks.printed_pairs import PRINTED_PAIRS, printed_pair
from semispline.papers.lin2014.checks.rows_along_normal import along_normal
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_3_1

_RELATED = "Section 1.1"
_OTHERS = "a statement on other publications, which are not here"


def _different_counts() -> Iterator[Case]:
    """Yield layouts of the paper whose curves have different numbers of knots."""
    yield Case("Fig. 1", len(set(pr.FIGURE_1_COUNTS)) > 1)
    for figure, pair in numbers.CONTACTS.items():
        yield Case(figure, len({len(pr.KNOTS[name]) for name in pair}) == 2)


def _different_vectors(_: Formula | None) -> Iterator[Case]:
    """Yield the printed pairs of contact curves, true where their vectors differ."""
    for name in PRINTED_PAIRS:
        first, second = printed_pair(name)
        yield Case(name, first != second)


CLAIMS: tuple[Claim, ...] = (
    holds("sec-0.undisturbed", "Abstract", "Both bases are met exactly without changing them.",
          part(proved(construction.contact_curve_cases,
                      "the contact curve of a base and its first row, every order and knots; at instances")),
          part(proved(construction.three_row_cases, "the derived rows, over the base's own knots, every order"))),
    ambiguous("sec-0.reaches", "Abstract and section 6", "The continuity between bases and blend reaches G2 and C2.",
              Reading((part(row_check("start", 2), TRUE_3_1),),
                      label="what the representation can do, with the right conditions"),
              Reading((part(row_check("start", 2, "normal"), along_normal(pr.COND_3_1, "start")),),
                      label="G2 by the conditions as printed, for all knots of the bases"),
              Reading((part(row_check("start", 2, "normal"), along_normal(pr.COND_3_1_SQUARES, "start")),),
                      label="the same with both distances squared, if the scan lost that"),
              cause="second-derivative",
              remark="At R; for S see cond-3.2, for C2 by the printed conditions sec-3.parametric-c2: it fails too. "
              "With squares, G2 fails where the first two spans of the base across differ, with uniform u_i."),
    not_checkable("sec-0.validated", "Abstract", "The examples validate that the method is effective and efficient.",
                  "no measure of either is named, and the control points of the examples are not printed; what rivals "
                  "do on bases of our own is in the study's findings"),
    not_checkable("sec-1.standard", "Abstract, sections 1 and 6", "NURBS are the standard of CAD systems in industry.",
                  "a statement on an industry and its years, with no number"),
    definition("sec-1.terms", "Section 1", "What a blending surface, base surfaces and contact curves are.",
               "the surface that connects two or more others; these; the curves along which it meets them"),
    holds("sec-1.mismatched", "Sections 1 and 3", "The knot vectors of the two contact curves differ, in general.",
          part(consistent(_different_vectors, "the printed vectors of each pair: all that is printed, and no measure "
                          "of how general that is")),
          remark="Where the two vectors are equal the method is not needed: one classical surface carries both."),
    not_checkable("sec-1.processing", "Section 1", "Superfluous knots complicate what is done with a surface later.",
                  "no later step is named; how many knots and control points there are is decided in "
                  "sec-1.superfluous-knots and, for the method itself, in sec-1.after-conversion"),
    holds("sec-1.superfluous-knots", "Section 1",
          "Giving contact curves with different knots the same ones by knot insertion adds control points.",
          part(proved(numbers.added_cases, "multiplicities of any knot in both vectors and in their union")),
          part(proved(numbers.superfluous_cases, "rows on their own knots and on the union, all printed pairs",
                      Strength.RATIONAL)),
          remark="To each curve as many as the other one has knots that it lacks: none to a curve whose knots contain "
          "the other's. How many are lots is not said."),
    ambiguous("sec-1.after-conversion", "Sections 1 and 2",
              "The blend, which can be exchanged as a B-spline surface, does without the knots that direct insertion "
              "adds.",
              Reading((part(Check(converted.saved_cases, Strength.GENERAL, "control points counted for every "
                                  "order and number of knots", proof=True), converted.SAVED_OWN),),
                      label="a semi-structured surface, rows on their own knots"),
              Reading((part(Check(converted.no_more_cases, Strength.RATIONAL, "inner knots of all rows and of both "
                                  "contact curves, printed knots: one counterexample is enough", proof=True)),),
                      label="a classical surface, once it is converted"),
              correction=Correction("With a middle curve the converted blend has one inner knot more than both contact "
                                    "curves together for each pair of the rule: more as soon as there are two "
                                    "different inner knots, whether knots are shared or the vectors equal. Without one "
                                    "it has as many.",
                                    (part(converted.CONVERTED_CHECK, converted.CONVERTED),)),
              counterexample=converted.converted_counterexample, consequence=converted.saving_consequence,
              cause="knots-rule",
              remark="The paper says that conversion is easy, and never that it keeps the saving. Averages belong to "
              "neither base. What becomes of an unpaired knot decides for Figs. 5, 8 and 9: averaging all three gives "
              "a knot that is there already, and then the converted blend has as many knots as direct insertion."),
    holds("sec-1.knot-insertion", "Section 1", "Knot insertion makes the knots of both contact curves identical.",
          part(proved(construction.nested_space_cases,
                      "knot insertion by induction on the order, every order and knots; spline spaces over the "
                      "printed pairs, by exact rank"))),
    holds_if("sec-1.rolling-ball", _RELATED, "A rolling-ball blend meets its bases with G1 at the most.",
             "the curvature of the base across the contact is not that of the ball",
             part(Check(other_methods.jump_cases, Strength.GENERAL, "the curvature of a circle, every radius",
                        proof=True), other_methods.JUMP),
             part(proved(other_methods.g2_cases, "zeros of the jump, every radius and curvature of the base"))),
    ambiguous("sec-1.quintic", _RELATED, "For G2, a Bezier curve across must be quintic.",
              Reading((part(Check(other_methods.hermite_cases, Strength.GENERAL,
                                  "rank of the six end conditions, every degree", proof=True), pr.QUINTIC),),
                      label="for a method that prescribes two derivatives at both ends, as for C2"),
              Reading((part(proved(other_methods.quartic_cases, "points, tangents and curvatures at both ends, exactly",
                                   Strength.RATIONAL)),),
                      label="for G2 as such, which prescribes points, tangents and curvatures"),
              remark="G2 leaves the lengths of the end derivatives free: the quartic with the control points (0,0), "
              "(1/2,0), (5/3,1/3), (2,1/2), (2,1) has horizontal and vertical end tangents and curvature 1 at both "
              "ends."),
    holds("sec-1.cubic", _RELATED, "A cubic blend with inner knots does the same.",
          part(proved(other_methods.cubic_cases, "determinant of the end derivatives of a cubic, any inner knots"))),
    holds("sec-1.hartmann-contact", _RELATED, "Hartmann's combination of two bases is G^n.",
          part(proved(hartmann.hartmann_contact_cases,
                      "derivatives of X up to order n at both contacts, every n and mu")),
          remark="For f = mu (1-t)^(n+1) / (mu (1-t)^(n+1) + (1-mu) t^(n+1)), well known; [17] itself is not here. "
          "X is even C^n with its pieces, hence G^n where these are regular and join the bases so."),
    ambiguous("sec-1.hartmann-nurbs", _RELATED, "Such a blend can be written as NURBS only approximately.",
              Reading((part(proved(other_methods.sine_base_cases,
                                   "solving for a base with a sine, which is no quotient of polynomials")),),
                      label="for parametric bases in general"),
              Reading((part(proved(hartmann.hartmann_rational_cases, "numerator and denominator, every n and mu")),),
                      label="for B-spline bases with a common parameter"),
              remark="f is rational with a positive denominator: for spline bases the blend is exactly rational, of "
              "degree p + n + 1 across."),
    definition("sec-1.two-types", _RELATED, "Blending methods are of two types, by the number of base surfaces.",
               "methods for two base surfaces, and those for more"),
    not_checkable("sec-1.history", _RELATED, "Who published which method, and what it extends.",
                  "statements on other publications, which are not here"),
    not_checkable("sec-1.bezier-shapes", _RELATED, "[9, 10] reach C1 G2 by moving control points.", _OTHERS),
    not_checkable("sec-1.ref-13", _RELATED, "[13] needs equal knot vectors and reaches just G1 (or C1).", _OTHERS),
    not_checkable("sec-1.only-work", _RELATED, "Only [13] blends two B-spline surfaces with a B-spline surface.",
                  "what the authors knew. P. Kiciak's bicubic B-spline blending patches, CAD 43 (2011), do so too"),
    not_checkable("sec-1.few-g2-methods", _RELATED, "Few methods give G2 or higher parametric blends [1].", _OTHERS),
    not_checkable("sec-1.pde", _RELATED, "PDE blends [14, 15] are usually found by numerical approximation.", _OTHERS),
    not_checkable("sec-1.ref-16", _RELATED, "[16] needs derivatives that may be hard to compute exactly.", _OTHERS),
    not_checkable("sec-1.point-based", _RELATED, "T-splines and semi-regular splines are point-based.",
                  "a way to look at a representation, not a property of it"),
    not_checkable("sec-1.hayes", _RELATED, "Hayes' splines need equal numbers of knots in each vector.", _OTHERS),
    ambiguous("sec-1.ref-11", _RELATED,
              "Hermite blends with a Bezier curve or a C-curve [11] are hard to write as B-splines.",
              Reading((part(proved(other_methods.bezier_conversion_cases,
                                   "the six rows by the end conditions; spline spaces over the printed pairs, exact "
                                   "rank", Strength.RATIONAL)),),
                      label="with a Bezier curve across, between spline bases with C2 contact"),
              Reading((part(proved(other_methods.c_curve_cases,
                                   "y'' = -y among polynomials and quotients, every degree")),),
                      label="with a C-curve, whose functions are 1, t, cos t and sin t"),
              remark="The first has an exact form and it takes no effort: Bezier of degree 5 across is a B-spline, and "
              "along the contacts the rows need the knots of both bases, as those of the semi-structured surface do. "
              "The second has none. [11] itself is not here; G2 with shape parameters that vary along the contact "
              "raises the degree along it, and stays exact while they are splines."),
    not_checkable("sec-1.parametric-blends", "Section 1", "Parametric blends can hardly be made B-splines exactly.",
                  "which methods are meant is not said. Decided where a method is named: exact for Hermite blends with "
                  "Bezier curves, impossible with C-curves (sec-1.ref-11), exact and rational for Hartmann's between "
                  "spline bases (sec-1.hartmann-nurbs)"),
    holds("sec-1.ball-circular", _RELATED, "A rolling ball leaves a circular surface: its sections are circles.",
          part(Check(other_methods.canal_cases, Strength.GENERAL,
                     "the envelope of balls of radius r(t) around a spine, both conditions solved", proof=True),
               other_methods.SECTION_SQUARED),
          remark="For a ball of variable radius too, in the plane across the spine at -r r'/s along it, s the speed of "
          "the spine; for constant radius in the plane through the centre."),
    not_checkable("sec-1.knot-lines-end", _RELATED, "Knot lines of T-splines and semi-regular splines may end inside.",
                  "it is how those splines are defined, in publications which are not here; that the knots of a "
                  "semi-structured surface may differ from row to row is decided in sec-2.continuity-control"),
    holds("sec-1.different-counts", _RELATED, "In a semi-structured surface the knot vectors may differ in length.",
          part(proved(_different_counts, "counts of Fig. 1 and of the printed pairs of contact curves",
                      Strength.RATIONAL))),
    holds("sec-1.classical-grid", _RELATED, "In a classical grid all rows, and all columns, have equally many points.",
          part(count_check(knot_count_instances(pr.n_i, pr.ell), "counting knots and basis functions, orders 1 to 6"),
               pr.V_LAST),
          remark="Order and knot vector fix the number of control points, and a classical surface has one of each."),
    not_checkable("sec-6.applications", "Section 6", "The algorithm will have wide applications.",
                  "a statement on the future"),
    not_checkable("sec-6.knots", "Section 6", "The main difficulty is how to arrange the knots of U and along v.",
                  "no measure of difficulty is named. What the paper's own arrangement does is decided where it is "
                  "made: sec-3.averaging and its neighbours, sec-1.after-conversion, sec-3.fewer-better, "
                  "sec-3.minimum-over-rows"),
    not_checkable("sec-1.divided-patches", _RELATED, "[24, 25] did not note how divided patches are built.", _OTHERS),
)  # fmt: skip
