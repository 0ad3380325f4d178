"""Section 3 up to the continuity conditions: bases, energy, construction of the blend and of its middle curve."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
from sympy import Eq

from semispline.papers.checks import count_check
from semispline.papers.ledger import (
    Case,
    Check,
    Claim,
    Correction,
    Counterexample,
    Formula,
    Part,
    Reading,
    Strength,
    ambiguous,
    definition,
    holds,
    holds_if,
    not_checkable,
    part,
    proved,
    question,
    smallest_assignment,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import construction, energy, objective
from semispline.papers.lin2014.checks import converted_blends as converted
from semispline.papers.lin2014.checks import fewer_control_points as fewer
from semispline.papers.lin2014.checks import many_rows as many
from semispline.papers.lin2014.checks.contact_rows import row_check
from semispline.papers.lin2014.checks.counts import domain_instances, inner_knots_count, knot_count_instances
from semispline.papers.lin2014.checks.definitions import SURFACE_CHECK, base_check
from semispline.papers.lin2014.checks.measured_energy import (
    other_direction,
    parameter_dependence,
    union_knots,
)

_BASES = "Section 3, base surfaces"
_ENERGY = "Section 3, energy"
_BLEND = "Section 3, blending surface"
_MIDDLE = "Section 3, middle curve"
_COUNT = "the number of functions by induction on the order, every order and count; the recurrence on distinct knots"
_DOMAIN = (
    "where the first and the last function of the next lower order vanish, every order and count; where the recurrence "
    "gives all functions, on distinct knots"
)

TRUE_STRAIN = Formula(
    Eq(pr.strain, (pr.kappa_1**2 + pr.kappa_2**2) * pr.area), (pr.strain, pr.kappa_1, pr.kappa_2, pr.area)
)
# (2.1) with u_1 = 0.
ROW_1_AT_ZERO = Formula(Eq(pr.P_1, pr.P_0, evaluate=False), (pr.P_0, pr.P_1))
_STRAIN_CHECK = Check(energy.strain_cases, Strength.GENERAL, "scaling a parameter", proof=True)
# (11) for the strain energy: the integrands, where lengths and angles are kept.
PLATE_IS_STRAIN = Formula(
    Eq(pr.kappa_1**2 + pr.kappa_2**2, pr.P_uu**2 + 2 * pr.P_uv**2 + pr.P_vv**2),
    (pr.kappa_1, pr.kappa_2, pr.P_uu, pr.P_uv, pr.P_vv),
)
# The last of the first three rows, the first of the last three, the middle one, and m with none and with one.
FIRST_THREE, LAST_THREE = Formula(Eq(pr.last, 2), (pr.last,)), Formula(Eq(pr.first, pr.m - 2), (pr.first, pr.m))
MIDDLE_ROW, NO_MIDDLE, ONE_MIDDLE = (Formula(Eq(pr.last, number), (pr.last,)) for number in (3, 5, 6))
# How often v_s and v_e stand.
CLAMP = Formula(Eq(pr.last, pr.ell), (pr.last, pr.ell))


def _strain_counterexample() -> Counterexample | None:
    """Search for the smallest curvature, area element and scale at which the printed measure changes."""
    scale = sp.Symbol("c", positive=True)
    found = smallest_assignment([pr.kappa_1, scale], lambda at: at[scale] != 1 and at[pr.kappa_1] != 0)
    if found is None:
        return None
    curvature, stretch = found[pr.kappa_1], found[scale]
    values = (
        ("kappa_1", str(curvature)),
        ("kappa_2", "0"),
        ("area element", "1"),
        ("u replaced by u / c, c", str(stretch)),
    )
    return Counterexample(values, f"{curvature**2} becomes {curvature**2 / stretch}", f"{curvature**2} both times")


def _fairness_cases() -> Iterator[Case]:
    """Yield blends with the rule's middle knots and with all knots: true where the latter have more energy."""
    own, refined = energy.middle_knot_energies()
    yield Case("orders 4, 2, inner knots 1/2 and 1/3", bool(refined > own), residual=refined - own)


def _fairness_counterexample() -> Counterexample:
    own, refined = energy.middle_knot_energies()
    values = (("V^r", "0, 0, 1/2, 1, 1"), ("V^s", "0, 0, 1/3, 1, 1"), ("middle", "5/12, or 1/3 and 1/2"))
    return Counterexample(values, f"energy above {own} on the refined knots", f"{refined}, less")


_INSIDE = "the domain by the supports of functions, every order and count; knots strictly inside clamped vectors"
_AVERAGED = "the rule for every n and i, indices against v_1 .. v_n; on the printed knot vectors as well"

_MIRRORED = "the rule for v_1 .. v_n and for 1 - v_n .. 1 - v_1, every n and i"
_STRIPS = "least energy (11) of strips with C2 contact, exactly"

CLAIMS: tuple[Claim, ...] = (
    holds("eq-7", _BASES, "The base R is a B-spline surface over W and V^r.",
          part(base_check("R"), pr.EQ_7)),
    holds("eq-8", _BASES, "W has the knots w_0, .., w_{m_r+k_r}, V^r the knots v_0, .., v_{n_r+l}.",
          part(count_check(knot_count_instances(pr.m_r, pr.k_r), _COUNT), pr.EQ_8[0]),
          part(count_check(knot_count_instances(pr.n_r, pr.ell), _COUNT), pr.EQ_8[1])),
    holds("eq-9", _BASES, "The base S is a B-spline surface over T and V^s.",
          part(base_check("S"), pr.EQ_9)),
    holds("eq-10", _BASES, "T has the knots t_0, .., t_{m_s+k_s}, V^s the knots v_0, .., v_{n_s+l}.",
          part(count_check(knot_count_instances(pr.m_s, pr.k_s), _COUNT), pr.EQ_10[0]),
          part(count_check(knot_count_instances(pr.n_s, pr.ell), _COUNT), pr.EQ_10[1])),
    holds("sec-3.bezier-ends", _BASES,
          "Bezier end conditions: the runs of equal knots are those up to index order - 1 and from index (last control "
          "point) + 1 on, for W, V^r, T, V^s.",
          *(part(count_check(domain_instances(count, order), _DOMAIN), formula)
            for (count, order), pair in zip(
                ((pr.m_r, pr.k_r), (pr.n_r, pr.ell), (pr.m_s, pr.k_s), (pr.n_s, pr.ell)),
                zip(pr.RUN_ENDS, pr.RUN_STARTS, strict=True), strict=True)
            for formula in pair)),
    holds("sec-3.contact-domain", _BASES,
          "Both contact curves run from v_{l-1} = v_s to v_{n_r+1} = v_{n_s+1} = v_e.",
          part(count_check(domain_instances(pr.n_r, pr.ell), _DOMAIN), pr.RUN_STARTS[1]),
          part(count_check(domain_instances(pr.n_s, pr.ell), _DOMAIN), pr.RUN_STARTS[3])),
    holds("sec-3.contact-knots", _BASES, "The knot vector of R(w_s, v) is V^r, that of S(t_s, v) is V^s.",
          part(proved(construction.contact_curve_cases,
                      "values at a clamped end for every order and knots, by induction; the surface there and its "
                      "first row at instances"))),
    holds_if("sec-3.not-classical", _BASES,
             "Knot vectors that differ cannot both be carried by one classical surface, without inserting knots.",
             "neither knot vector contains the other",
             part(proved(construction.mismatch_cases,
                         "smoothness at a knot that one vector has more often, by induction on the order, every order "
                         "and knots; spline spaces over the printed pairs by exact rank; for nested vectors an example "
                         "is enough")),
             remark="Where V^r is part of V^s, a classical surface over V^s carries both contact curves as they are."),
    not_checkable("sec-3.quality", _ENERGY, "The smaller the strain energy, the better the surface.",
                  "a convention: which surface is better is not defined apart from it. What can be decided is decided: "
                  "the measure over du dv depends on the parametrisation (sec-3.strain-energy), and (11), by which it "
                  "is replaced, may be large where it is zero (sec-3.thin-plate)"),
    not_checkable("sec-3.strain-cost", _ENERGY, "Computing the strain energy is considerable work.",
                  "no machine, program or size is named"),
    ambiguous("sec-3.strain-energy", _ENERGY,
              "The quality of a surface is the integral of its squared principal curvatures over the parameter space.",
              Reading((part(_STRAIN_CHECK, pr.STRAIN),), label="over du dv, as the words have it"),
              Reading((part(_STRAIN_CHECK, TRUE_STRAIN),),
                      label="over the surface, pulled back to the parameters with the area element"),
              correction=Correction("The integral is over the surface: the area element |P_u x P_v| belongs to it.",
                                    (Part(_STRAIN_CHECK, TRUE_STRAIN),)),
              counterexample=_strain_counterexample, consequence=parameter_dependence,
              cause="energy-for-quality",
              remark="(11) itself does depend on the parametrisation, and so does the blend of least energy."),
    ambiguous("sec-3.thin-plate", _ENERGY, "The thin-plate energy (11) approximates the strain energy.",
              Reading((part(Check(objective.isometric_cases, Strength.GENERAL,
                                  "first and second fundamental form", proof=True), PLATE_IS_STRAIN),),
                      label="for a parametrisation that keeps lengths and angles"),
              Reading((part(proved(objective.planar_cases, "(11) of plane pieces, whose strain energy is zero")),),
                      label="for any parametrisation"),
              cause="energy-for-quality",
              remark="No bound holds in general: the ratio is unbounded for plane pieces whose nets are not affine."),
    holds_if("eq-11", _ENERGY, "The thin-plate energy as the integral of |P_uu|^2 + 2|P_uv|^2 + |P_vv|^2.",
             "the surface is C1, that is, no inner knot has the full multiplicity of its degree",
             part(Check(objective.density_cases, Strength.GENERAL, "the sum of squared principal curvatures "
                        "of surfaces that keep lengths and angles; rotation of (u, v)", proof=True), pr.EQ_11),
             part(proved(objective.crease_cases,
                         "C1 splines that are lines on each span, every order and knots; null space of exact Gram "
                         "matrices; for a crease an example is enough")),
             remark="As the name of an energy (11) could not be false. What can be: that it is the strain energy where "
             "lengths and angles are kept, that turning (u, v) does not change it, and that zero energy means no "
             "bend. Across a knot of full multiplicity a crease costs nothing, taken span by span."),
    ambiguous("eq-12", _ENERGY, "Minimise E over the control points under the continuity condition.",
              Reading((part(objective.minimum_check(2)),),
                      label="alpha and beta given: there is exactly one minimum"),
              Reading((part(objective.SHAPE_CHECK),),
                      label="alpha and beta unknown too, as G1 and G2 need: the minimum is a G1 blend",
                      condition="the energy over alpha^2, beta^2 is not least at zero"),
              cause="energy-for-quality",
              remark="The printed problem lists the control points alone as unknowns."),
    holds("eq-13", _BLEND, "The blend is the surface (1) over [0, 1] x [v_s, v_e].",
          part(SURFACE_CHECK, pr.EQ_13)),
    holds("sec-3.u-vector", _BLEND, "U has k zeros, m - k + 1 inner knots and k ones.",
          part(count_check(construction.u_length(), _COUNT), pr.U_LENGTH)),
    ambiguous("sec-3.u-numbering", _BLEND, "u_1 in (2.1) and (3.1) is a knot of U.",
              Reading((part(row_check("start", 1), pr.COND_2_1),), label="the first inner knot, as (13) numbers them"),
              Reading((part(row_check("start", 1), ROW_1_AT_ZERO),),
                      label="the second knot, as Definition 1 numbers them, which is 0"),
              remark="One letter, two numberings: Definition 1 counts all knots from u_0, (13) only the inner ones."),
    holds_if("sec-3.m-bound", _BLEND, "With m >= k + 1 the layout of (13) is possible.", "k >= 4",
             part(Check(construction.layout_cases, Strength.GENERAL,
                        "rows of the first and last curves for every k >= 4 and every m admitted, and for k = 2 to 7; "
                        "for smaller k an example is enough", proof=True), pr.M_BOUND),
             cause="indices-for-cubics",
             remark="Six different rows need m >= 5, whatever k is. For k = 3 the bound admits m = 4, where curve 2 "
             "would need both knot vectors; for k > 4 it asks for more than is needed."),
    holds("sec-3.uniform-knots", _BLEND, "u_i = i / (m - k + 2) spaces the inner knots uniformly.",
          part(Check(construction.uniform_knot_cases, Strength.GENERAL,
                     "equal spans from 0 to 1 by as many knots as there are, for every m and k; instances", proof=True),
               pr.UNIFORM_KNOT)),
    holds("sec-3.three-curves", _BLEND, "The first three curves have the knots of R's contact curve, the last of S.",
          part(proved(construction.three_row_cases, "the derived rows: combinations of R_0 .. R_2, with R_2 in row 2")),
          part(construction.row_check_of(lambda at_start, _: at_start), FIRST_THREE),
          part(construction.row_check_of(lambda _, at_end: at_end), LAST_THREE)),
    ambiguous("sec-3.fewer-better", _BLEND,
              "In general, the fewer control points the blend has, the better its quality.",
              Reading((part(Check(fewer.fewer_cases, Strength.RATIONAL, _STRIPS), pr.FEWER_IS_BETTER),),
                      label="no middle curve against one, the paper's two kinds, by the energy that measures quality"),
              Reading((part(many.TO_ZERO_CHECK, many.TO_ZERO),
                       part(proved(many.outside_cases, "spline spaces over the printed pairs and over their averages, "
                                   "exact rank", Strength.RATIONAL))),
                      label="ever more middle curves, all of them over the averaged knots"),
              correction=Correction(
                  "For strips, whose rows do not vary along v, a blend without middle curve costs more than one with "
                  "it by a sum of two squares in the contact data, so that it is never the better one; and wherever "
                  "one space of surfaces contains another, each control point more can only lower (11). Spaces with "
                  "more rows over averaged knots contain no other: there the least energy is 3 d^2 / (3 h)^3 at least, "
                  "h the span of U and d the part of a contact curve that splines over the averages leave out, and "
                  "grows beyond every bound.",
                  (Part(Check(fewer.difference_cases, Strength.GENERAL, _STRIPS + ", all contact data",
                              proof=True), fewer.FEWER_COSTS_MORE),
                   Part(Check(fewer.nested_cases, Strength.GENERAL, "the minimum of a quadratic energy over "
                              "one more control point", proof=True), fewer.NESTED))),
              counterexample=fewer.fewer_counterexample, consequence=many.rows_over_averages,
              cause="energy-for-quality",
              remark="By the measure of the paper itself a surface without a middle curve is the worse one; but a "
              "reader who adds rows by the rule comes to the paper's sentence in the end."),
    ambiguous("sec-3.minimum-over-rows", _ENERGY,
              "Problem (12) has a solution: a blend of least energy among those that meet the C2 condition.",
              Reading((part(objective.minimum_check(2)),), label="for a given number of v-control curves"),
              Reading((part(proved(many.attained_cases, "least energies of strips, exactly, against their limit: one "
                                   "counterexample is enough", Strength.RATIONAL)),),
                      label="whatever their number"),
              correction=Correction(
                  "As rows are added the least energy of a strip tends to that of the cubic with the prescribed values "
                  "and slopes, the C1 solution: it exceeds it by h / 2 times the sum of the squares of what that "
                  "cubic lacks of the prescribed second derivatives, at the most, and reaches it for no number of "
                  "rows.",
                  (part(many.EXTRA_CHECK, many.EXTRA_ENERGY),)),
              consequence=many.curvature_is_lost, cause="energy-for-quality",
              remark="The prescribed curvature is left in a layer of three spans of U: refined, a C2 blend by (11) "
              "looks like a C1 blend. With none or one middle curve, as in the paper, cubic in u, U has just three or "
              "four spans. On surfaces it is measured."),
    ambiguous("sec-1.fairness", "Section 1",
              "Inserting knots until both contact curves share theirs worsens the fairness.",
              Reading((part(proved(construction.knot_line_cases, "multiplicities of any knot in two vectors and in "
                                   "their union; knot lines counted in the printed pairs")),),
                      label="if fairness means few knot lines, across which a cubic is C2 only, then by definition"),
              Reading((part(question(_fairness_cases, "least energy (11), exactly; one counterexample is enough")),
                       part(proved(construction.nested_space_cases,
                                   "knot insertion by induction on the order, every order and knots: the larger space "
                                   "holds the smaller one; spline spaces over the printed pairs"))),
                      label="fairness as the least energy (11), the paper's measure of quality"),
              counterexample=_fairness_counterexample, consequence=union_knots,
              cause="energy-for-quality",
              remark="No measure of fairness is named. Inserting a knot alone changes no surface; by (11) the best "
              "surface over more knots is never worse."),
    holds("sec-3.two-kinds", _BLEND, "With k = 4 the blend has no middle curve (m = 5), or just P_3 (m = 6).",
          part(construction.middle_count_check(0), NO_MIDDLE), part(construction.middle_count_check(1), ONE_MIDDLE),
          part(construction.row_check_of(lambda at_start, _: at_start + 1), MIDDLE_ROW)),
    holds("sec-3.inner-knots", _MIDDLE, "The inner knots of V^r are v_l, .., v_{n_r}.",
          part(count_check(inner_knots_count(), _INSIDE), pr.INNER_FIRST),
          part(count_check(inner_knots_count(), _INSIDE), pr.INNER_LAST)),
    ambiguous("sec-3.averaging", _MIDDLE,
              "The inner knots of P_3 are the averages (v_{2i-1} + v_{2i})/2 of adjacent knots of V_n.",
              Reading((part(Check(construction.paired_cases(lambda n: (n + 1) // 2), Strength.GENERAL, _AVERAGED,
                                  proof=True),
                            pr.AVERAGED_KNOT),), label="pairs until V_n is used up, as printed"),
              Reading((part(Check(construction.paired_cases(lambda n: n // 2), Strength.GENERAL, _AVERAGED,
                                  proof=True),
                            pr.AVERAGED_KNOT),), label="complete pairs, the last knot dropped where n is odd"),
              Reading((part(Check(construction.sliding_cases, Strength.GENERAL, _AVERAGED, proof=True)),),
                      label="each knot with the next one"),
              cause="knots-rule",
              remark="No range of i is printed. For Figs. 5, 8 and 9 n = 3: v_4 does not exist. Dropping the last knot "
              "makes the blend depend on the direction of v."),
    ambiguous("sec-3.averaging-direction", _MIDDLE,
              "The knots of P_3 follow from those of the two contact curves, whichever way v runs.",
              Reading((part(Check(converted.mirrored_pair_cases, Strength.GENERAL, _MIRRORED, proof=True),
                            pr.AVERAGED_KNOT),),
                      label="pairs from v_1 on, and the last knot of an odd number dropped, kept or averaged with v_e"),
              Reading((part(proved(lambda: converted.mirrored_neighbour_cases(None), _MIRRORED)),),
                      label="each knot with the next one"),
              counterexample=converted.mirrored_counterexample, consequence=other_direction, cause="knots-rule",
              remark="Pairs agree exactly where n is even. In Figs. 5, 8 and 9 n = 3: read from the other end the "
              "blend is another one. Our own examples pair from both ends, so that the middle three make one mean."),
    holds_if("sec-3.averaging-few", _MIDDLE, "The rule gives P_3 inner knots.", "V_n has two knots or more",
             part(proved(converted.few_knots_cases, "the first pair of every number of knots; the rule on vectors with "
                         "no, one and more knots, shared ones and equal vectors among them")),
             cause="knots-rule",
             remark="With n = 0 or 1 there are no adjacent knots, and P_3 is one polynomial piece whatever the bases "
             "do. For equal vectors the averages are still new: the blend of two bases that one classical surface "
             "could join directly gets knots that neither has."),
    holds("sec-3.middle-ends", _MIDDLE, "l-fold v_s and v_e complete the averages to a clamped knot vector.",
          part(Check(construction.bezier_end_cases, Strength.GENERAL,
                     "where the domain starts and ends and values there, every order and count; end points by de "
                     "Boor's triangle", proof=True), CLAMP)),
    definition("sec-3.sides", "Section 3, continuity conditions",
               "(1.1), (2.1), (3.1) concern R and P, (1.2), (2.2), (3.2) concern S and P.",
               "the conditions at R and those at S; whether each of them is right is decided in cond-1.1 to cond-3.2"),
)  # fmt: skip
