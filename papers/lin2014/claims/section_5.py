"""Section 5: figures, knot vectors, Table 1."""

from __future__ import annotations

from functools import partial
from typing import Any

from sympy import Eq, Symbol

from semispline.papers.ledger import (
    Check,
    Claim,
    Correction,
    Formula,
    Knots,
    Part,
    Reading,
    Strength,
    ambiguous,
    consistent,
    fails,
    holds,
    holds_if,
    not_checkable,
    of_data,
    part,
    proved,
    question,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as printed
from semispline.papers.lin2014.checks import closed_seam as seam
from semispline.papers.lin2014.checks import conditions_in_figures as conditions
from semispline.papers.lin2014.checks import curvature_pictures as pictures
from semispline.papers.lin2014.checks import hartmann
from semispline.papers.lin2014.checks import printed_numbers as numbers
from semispline.papers.lin2014.checks.contact_rows import Side
from semispline.papers.lin2014.checks.exact_blends import exact_contact
from semispline.papers.lin2014.checks.measured_rows import measured_rows
from semispline.papers.lin2014.checks.rows_along_normal import (
    EXCESS_3_1,
    EXCESS_3_1_SQUARES,
    EXCESS_3_2,
    EXCESS_3_2_SQUARES,
    along_normal,
    excess_check,
)
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_3_1, TRUE_3_2
from semispline.papers.lin2014.examples.stand_ins import cylinders, plane_and_curved, planes

_KNOTS = "the printed vector against Table 1, exactly"
_KNOTS10 = _KNOTS + "; its inner knots"
_SIZES = "printed sizes against printed knots, the text and each other, exactly"
_NO_DATA = "control points, program and machine of the examples are not printed"
_ITERATIONS = "iterations depend on data and program, which are not printed"
_CYLINDERS = "Cylinders with the knots and sizes of Fig. 8, contact along arcs"
_PRINTED_ROWS = {1: pr.COND_2_1, 2: pr.COND_3_1}
_VECTOR_10 = "V^r"
_DIRECTION = tuple(
    part(
        Check(
            hartmann.direction_cases(end),
            Strength.GENERAL,
            "X_t at the contacts by the product rule, every n and mu",
            proof=True,
        ),
        formula,
    )
    for end, formula in enumerate(hartmann.DIRECTION)
)
REPAIRED_VECTOR = Formula(
    Eq(Symbol(_VECTOR_10), Knots(0, *pr.KNOTS["fig-10.first"]), evaluate=False), (Symbol(_VECTOR_10),)
)


def _vector(key: str) -> Part:
    return part(consistent(numbers.knot_cases(key), _KNOTS), printed.VECTORS[key])


def _sizes(figure: str) -> tuple[Part, ...]:
    sizes = enumerate(printed.SIZE[figure])
    return tuple(part(consistent(numbers.size_cases(figure, model), _SIZES), formula) for model, formula in sizes)


_AS_PRINTED, _CORRECTED = "with the conditions as they are printed", "with the corrected ones"
_SQUARED = "with both distances in (3.1) and (3.2) squared, if the scan lost that"


def _c2(identifier: str, where: str, statement: str, **more: Any) -> Claim:
    """Return a record of a claim of C2 contact with one middle curve."""
    corrected = Part(conditions.row_2_check("start", 6, "any", parametric=True),
                     conditions.at_figure(TRUE_3_1, 6, parametric=True))  # fmt: skip
    printed = (
        Reading(
            (
                part(conditions.for_which_bases("start", 6, parametric=True, squares=squares),
                     conditions.at_figure(formula, 6, parametric=True)),
                part(conditions.excess_of_c2_check(6, squares=squares), conditions.excess_of_c2(6, squares=squares)),
            ),
            label=label, condition=conditions.STEPS[squares],
        )
        for label, formula, squares in (
            (_AS_PRINTED, pr.COND_3_1, False), (_SQUARED, pr.COND_3_1_SQUARES, True))
    )  # fmt: skip
    return ambiguous(
        identifier, where, statement, *printed, Reading((corrected,), label=_CORRECTED),
        correction=Correction("(3.1) as at cond-3.1, here with k = k_r = 4, u_1 = 1/4, u_2 = 1/2, alpha = 1: then C2.",
                              (corrected,)),
        counterexample=conditions.straight_counterexample(6), cause="second-derivative", **more)  # fmt: skip


_ROW_2: dict[Side, tuple[Formula, Formula, Formula]] = {
    "start": (pr.COND_3_1, pr.COND_3_1_SQUARES, TRUE_3_1),
    "end": (pr.COND_3_2, pr.COND_3_2_SQUARES, TRUE_3_2),
}
_EXCESS: dict[Side, tuple[Formula, Formula]] = {
    "start": (EXCESS_3_1, EXCESS_3_1_SQUARES),
    "end": (EXCESS_3_2, EXCESS_3_2_SQUARES),
}


def _g2(identifier: str, where: str, statement: str, m: int, side: Side = "end", **more: Any) -> Claim:
    """Return a record of a claim of G2 contact with a base that may be curved across."""
    *printed, true = _ROW_2[side]
    corrected = Part(conditions.row_2_check(side, m, "any", parametric=False),
                     conditions.at_figure(true, m, parametric=False))  # fmt: skip
    readings = (
        Reading(
            (
                part(conditions.for_which_bases(side, m, parametric=False, squares=squares),
                     along_normal(conditions.at_figure(formula, m, parametric=False), side)),
                part(excess_check(side, formula), _EXCESS[side][squares]),
            ),
            label=label, condition=conditions.SPANS[squares],
        )
        for label, formula, squares in zip((_AS_PRINTED, _SQUARED), printed, (False, True), strict=True)
    )  # fmt: skip
    name, shape, base = ("(3.1)", "alpha", "k_r") if side == "start" else ("(3.2)", "beta", "k_s")
    return ambiguous(
        identifier, where, statement, *readings, Reading((corrected,), label=_CORRECTED),
        correction=Correction(f"{name} as at cond-{name[1:-1]}, here with k = {base} = 4 and inner knots 1/{m - 2} "
                              f"apart: P_uu is {shape}^4 times that of the base, hence G2.", (corrected,)),
        counterexample=conditions.row_counterexample(side, "curved", m), cause="second-derivative",
        **more)  # fmt: skip


CLAIMS: tuple[Claim, ...] = (
    not_checkable("sec-5.machine", "Section 5", "In which languages the method was written, on which machine it ran.",
                  "the program and the machine are not here"),
    holds("sec-5.bicubic", "Section 5", "All bases are bicubic: four rows and columns at least.",
          part(consistent(numbers.bicubic_cases, "ends of the printed vectors, sizes in Table 1"), printed.BICUBIC)),
    ambiguous("sec-5.cylinders", "Section 5", "The bases of Figs. 8 to 10 are cylinders, and bicubic.",
              Reading((part(proved(numbers.circle_cases, "leading coefficients of x^2 + y^2, every degree")),),
                      label="circular cylinders"),
              Reading((part(consistent(lambda _: numbers.extrusion_cases(), "a cubic curve moved along a line, "
                                       "degree raised to 3: such cylinders exist")),),
                      label="cylinders over some other curve, which may be near a circle"),
              remark="No polynomial spline, which is what (7) is, runs along a circle; that takes weights. What is "
              "called radius is that of an approximation. The study runs Fig. 10 with exact, rational cylinders too."),
    holds("sec-5.cone", "Section 5", "The conical base of Fig. 11 is bicubic.",
          part(consistent(lambda _: numbers.cone_patch_cases(),
                          "a patch in the implicit equation of a circular cone: one of the kind exists")),
          remark="Possible on a circular cone too, between parabolas; between circles it is not, as for cylinders: "
          "that takes weights. The study runs Fig. 11 with such an exact cone too."),
    holds("sec-5.middle-curves", "Section 5", "Figs. 5, 6, 8, 9 have one middle curve, Figs. 10 and 11 none.",
          part(consistent(numbers.middle_curve_cases, "the two kinds of section 3, what the paragraphs repeat, and the "
                       "printed inner knots"), printed.MIDDLE_CURVES)),
    ambiguous("sec-5.validation", "Section 5",
              "Mean curvature and zebra stripes show the C2 or G2 continuity of the examples.",
              Reading((part(proved(pictures.mean_curvature_cases, "H in the coefficients of both fundamental forms")),
                       part(proved(pictures.graph_mean_cases, "H on both sides of a join of two graphs, any such "
                                   "graphs")),
                       part(proved(pictures.stripe_cases, "N . d across a join of two graphs, any such graphs and all "
                                   "directions d of light")),
                       part(proved(pictures.reflection_cases, "the mirrored ray across a join of two graphs, any such "
                                   "graphs and any eye from which the contact is seen"))),
                      label="G2, for a join whose tangent planes agree: H with its sign; stripes as isophotes, a "
                      "function of N . d, or as reflections to a distant eye e, a function of R = 2 (N . e) N - e; "
                      "under lights from all sides"),
              Reading((part(proved(pictures.revealed_cases, "the kink of N . d and of R . d at a contact whose "
                                   "curvature jumps")),),
                      label="G2, by stripes under one light d",
                      condition="with t across the contact in the tangent plane, d . t is not zero for isophotes, "
                      "(e . t)(d . N) + (e . N)(d . t) is not zero for reflections"),
              Reading((part(question(pictures.unsigned_cases, "|H| on both sides of joins of two graphs")),),
                      label="G2, by mean curvature without its sign"),
              Reading((part(question(pictures.invisible_cases, "normals and curvatures of plane joins")),), label="C2"),
              remark="Both kinds of stripes are functions of the normal: they run on where tangent planes agree, and "
              "without a kink where curvatures do. |H| does not see H jump to -H; ranges in Table 1 that start at "
              "zero leave open which is drawn. Parametric continuity leaves no trace in a picture; with the "
              "conditions as printed Figs. 5, 8 and 9 can be G2 without being C2, and would look the same."),
    ambiguous("sec-5.mean-curvature", "Section 5", "Mean curvature shows the bending energy of the blends.",
              Reading((part(proved(pictures.bending_cases(saddle=False), "H in the principal curvatures")),),
                      label="where one principal curvature is zero, such as on planes, cylinders and cones"),
              Reading((part(proved(pictures.bending_cases(saddle=True), "H in the principal curvatures")),),
                      label="on any surface"),
              remark="kappa_1^2 + kappa_2^2 = 4 H^2 - 2 K: on a saddle with kappa_2 = -kappa_1 the mean curvature is "
              "zero, and the energy of section 3 is not."),
    holds("fig-5.knots", "Fig. 5", "Contact curves over {1/2} and {1/3, 2/3}, in bases of 6 x 5 and 6 x 6 points.",
          part(consistent(numbers.first_vector_5_cases, _KNOTS + "; against its second print"),
               printed.VECTORS["fig-5.first"]),
          _vector("fig-5.second")),
    _c2("fig-5.c2", "Fig. 5", "Two planar patches are blended C2.",
        consequence=partial(measured_rows, "start", _PRINTED_ROWS, "Planes of constant speed with the knots of Fig. 5",
                            "C2", planes),
        remark="Neither speeds nor knots across are printed. With (3.1) as printed C2 is reached, for instance, by "
        "rows 0, 1, 11 on a line and knots 1/5 and 2/5 after the contact: P_u = -15 = -R_w, P_uu = 600 = R_ww. At "
        "constant speed, the usual parametrisation, it never is, in either reading and whatever the knots: then "
        "P_uu = 2 H_2 / (H_1 u_2) R_w as printed, and not zero. G2 all the same: rows of a plane stay in the plane, "
        "whatever their weights, so that the error of (3.1) cannot be seen in this figure."),
    holds_if("fig-5.same-knots", "Fig. 5", "Both planar patches can be given the knots {1/2}.",
             "the patch over {1/3, 2/3} is polynomial across these knots",
             part(of_data(numbers.removable_cases, "spline spaces by exact rank; the vector against its first print"),
                  printed.COMMON_VECTOR_5)),
    not_checkable("fig-5.revealed", "Fig. 5",
                  "Mean curvature and zebra stripes reveal that the curvature of the blend by [13] jumps.",
                  "the surface of [13] is not printed, and its pictures are not here; what such pictures can show is "
                  "decided in sec-5.validation"),
    not_checkable("fig-5.ref-13", "Fig. 5", "The method of [13] reaches just G1 there.",
                  "the method of [13] is not printed here"),
    holds("fig-6.knots", "Fig. 6", "Contact curves with 6 and 4 inner knots, in bases of 5 x 10 and 5 x 8 points.",
          _vector("fig-6.planar"), _vector("fig-6.curved")),
    _g2("fig-6.g2", "Fig. 6", "A planar and a curved patch are blended G2.", 6,
        consequence=partial(measured_rows, "end", {1: pr.COND_2_2, 2: pr.COND_3_2},
                            "A plane and a curved patch over [0, 1] with the knots and sizes of Fig. 6, at the curved "
                            "side", "G2", plane_and_curved),
        remark="As printed, the second derivative along the normal is that of the base times (t_{k_s+1} - t_s) / "
        "u_2, with u_2 = 1/2. A base of five rows has one knot across, so that t_{k_s+1} - t_s is its whole length: "
        "over [0, 1/2] it is met with G2, over [0, 1], the usual domain, with twice its curvature. With squares it is "
        "met with G2 exactly if that knot is in the middle. The planar side is G2 whatever its rows."),
    not_checkable("fig-6.iterations", "Fig. 6", "fminunc needs 5 iterations.", _ITERATIONS),
    holds("fig-7.hull", "Fig. 7", "Hartmann's blend lies in the convex hull of the pieces that it combines.",
          part(proved(hartmann.hull_cases, "signs and ends of f and 1 - f, every t, n and mu"))),
    holds("fig-7.reverse", "Fig. 7", "Combining pieces of the bases themselves, the blend runs back over them.",
          *_DIRECTION,
          remark="X_t is that of the piece: a piece that runs into its base takes the blend with it."),
    ambiguous("fig-7.inference", "Fig. 7",
              "As a convex combination of portions of the bases Hartmann's blend lies in their hull, and runs back.",
              Reading((part(proved(hartmann.hull_cases, "signs and ends of f and 1 - f, every t, n and mu")),
                       *_DIRECTION),
                      label="both follow from combining portions of the bases"),
              Reading((part(proved(hartmann.turning_cases, "signs of a convex combination on one side of a plane, any "
                                   "bases; two pairs of bases exactly")),),
                      label="the hull alone turns it, whatever surface lies there",
                      condition="a plane through the contact has both bases on one side and the continued tangent of "
                      "the base on the other"),
              counterexample=hartmann.inference_counterexample,
              remark="Around an edge the hull is reason enough; between coplanar strips it is not, and the blend runs "
              "back all the same, because X_t is that of its piece (fig-7.reverse)."),
    holds("fig-8.knots", "Fig. 8", "Contact curves over {0.3, 0.7} and {0.5}, in bases of 6 x 6 and 6 x 5 points.",
          _vector("fig-8.larger"), _vector("fig-8.smaller")),
    _c2("fig-8.c2", "Fig. 8", "Two part cylinders are blended C2.",
        consequence=partial(measured_rows, "start", _PRINTED_ROWS, _CYLINDERS, "C2", cylinders),
        remark="As fig-5.c2, for contact along arcs; along arcs the base is straight across and the contact is G2 all "
        "the same, in either reading. Met along its rulings a cylinder is curved across, and C2 takes straight rows: "
        "then it fails as printed and with squares, and G2 is decided as for fig-6.g2."),
    _c2("fig-9.c2", "Fig. 9", "The same are blended C2 in another posture.",
        consequence=partial(measured_rows, "start", _PRINTED_ROWS, _CYLINDERS, "C2", cylinders),
        remark="As fig-8.c2: the posture does not enter."),
    holds("fig-9.same-bases", "Fig. 9", "The bases are those of Fig. 8.",
          *(part(consistent(numbers.same_model_cases(model), "sizes in Table 1"), formula)
            for model, formula in enumerate(printed.SIZE["fig-9"]))),
    fails("fig-10.first-knots", "Fig. 10", "The first contact curve has the printed knots, three zeros to begin with.",
          part(consistent(numbers.first_vector_10_cases, _KNOTS10), printed.VECTORS["fig-10.first"]),
          correction=Correction("Four zeros, as Bezier end conditions and Table 1 need.",
                                (Part(consistent(numbers.first_vector_10_cases, _KNOTS10), REPAIRED_VECTOR),)),
          counterexample=numbers.knot_10_counterexample, consequence=numbers.knot_10_consequence,
          cause="misprints",
          remark="Misprinted, or lost by the scan: with a fourth zero all numbers agree."),
    holds("fig-10.sevenths", "Fig. 10", "Its inner knots are 0.142857, .., 0.857143.",
          part(consistent(numbers.seventh_cases, "sevenths rounded to six places"), printed.SEVENTHS)),
    holds("fig-10.second-knots", "Fig. 10", "The second contact curve has four inner knots, in a base of 8 x 8 points.",
          _vector("fig-10.second")),
    _g2("fig-10.g2", "Fig. 10", "Two complete cylinders are blended G2, without a middle curve.", 5, "start",
        consequence=partial(exact_contact, 10, "Exact, rational cylinders, not polynomial stand-ins, blended "
                            "with derived rows, worst of both contacts"),
        remark="A complete cylinder is met along a closed curve and, with a parameter along its rulings, which is not "
        "said to be so, is straight across: then either reading of (3.1) gives G2, since only the second derivative "
        "along the normal matters, and it is zero whatever multiple of the base's is taken. So this figure says "
        "nothing for or against (3.1)."),
    ambiguous("fig-10.seam", "Fig. 10", "Blended from complete cylinders, the surface closes where v_s and v_e meet.",
              Reading((part(Check(seam.closing_cases, Strength.GENERAL, "rows are combinations of the base's "
                                  "rows with factors that do not depend on v, every order and knots", proof=True),
                            seam.JUMP_OF_ROW_1),),
                      label="without a middle curve, as the figure has it, if both bases close"),
              Reading((part(proved(seam.free_middle_cases, "least energy between two curves that close with two "
                                   "derivatives, exactly: one counterexample is enough", Strength.RATIONAL)),),
                      label="with a middle curve over knots of its own, found by least (11) alone"),
              consequence=seam.seam_gap, cause="energy-for-quality",
              remark="Without a middle curve the blend closes with every derivative with which both bases do, for any "
              "alpha, beta. With one (11) closes nothing, not even the position: the ends of P_3 have to be held "
              "together. Whether the paper's bases close is not printed."),
    not_checkable("fig-10.iterations", "Fig. 10", "fminunc needs 6 iterations.", _ITERATIONS),
    holds("fig-11.counts", "Fig. 11", "The contact curves have 10 control points on the cone, 64 on the free form.",
          part(consistent(numbers.cone_cases, "Table 1, 4 x 10 and 5 x 64"), printed.CONE_COUNTS_11)),
    _g2("fig-11.g2", "Fig. 11", "A cone and a free form are blended G2, no middle curve.", 5,
        consequence=partial(measured_rows, "end", {1: pr.COND_2_2, 2: pr.COND_3_2},
                            "The made pair, whose second base stands for the free-form surface"),
        remark="The cone is straight across where it is met along a closed curve, as in Fig. 10. The free form has "
        "five rows, so that t_{k_s+1} - t_s is its whole length across: as printed G2 exactly if that is u_2 = 2/3, "
        "over [0, 1] it is met with 3/2 times its curvature; with squares exactly if its one knot across is in the "
        "middle. With an exact, rational cone instead of a stand-in derived rows are G2 as well, which the study "
        "measures."),
    holds("table-1.sizes", "Table 1", "Sizes of the control nets, across and along the contact.",
          *(size for figure in pr.SIZES for size in _sizes(figure)),
          remark="For Fig. 10 they agree with four zeros: fig-10.first-knots."),
    not_checkable("fig-4.layout", "Fig. 4", "Layout of bases and blend; the knots of R and S along v differ.",
                  "the figure is not part of the text that we have; its layout is decided in sec-3.three-curves"),
    not_checkable("table-1.times", "Table 1", "Computational times, 0.43 to 5.54 seconds.", _NO_DATA),
    not_checkable("table-1.energies", "Table 1", "Energies by (11), 2.44e6 to 6.78e6.", _NO_DATA),
    not_checkable("table-1.curvatures", "Table 1", "Ranges of mean curvature, all from 0.0000.", _NO_DATA),
)  # fmt: skip
