"""Section 5: figures, knot vectors, Table 1."""

from __future__ import annotations

from functools import partial
from typing import Any

from papers.ledger import Check, Claim, Correction, Part, Reading, Strength
from papers.lin2014 import figure_checks as figures
from papers.lin2014 import printed as pr
from papers.lin2014.consequences import measured_rows
from papers.lin2014.property_checks import proved, question
from papers.lin2014.records import ambiguous, fails, holds, holds_if, not_checkable, part
from papers.lin2014.stand_ins import cylinders, plane_and_curved, planes

_KNOTS = "printed vectors against Table 1"
_ROWS = "P_u and P_uu of the rows as printed, k = k_r = 4, any control points of this kind, any knots of the base"
_DERIVED = "P_uu of the derived rows"
_NO_DATA = "control points, program and machine of the examples are not printed"
_ITERATIONS = "iterations depend on data and program, which are not printed"
_CYLINDERS = "Cylinders with the knots and sizes of Fig. 8, contact along arcs"
_PRINTED_ROWS = {1: pr.COND_2_1, 2: pr.COND_3_1}


def _exact(cases: Any, method: str) -> Check:
    return proved(cases, method, Strength.RATIONAL)


def _run_as_printed(identifier: str, where: str, statement: str, kind: str, **more: Any) -> Claim:
    """Return a record of a claim of C2 contact for bases of a kind, run with the conditions as printed."""
    return fails(
        identifier, where, statement,
        part(_exact(figures.parametric_cases(kind, 6), _ROWS)),
        correction=Correction("With (3.1) corrected, by the formula at cond-3.1, the contact is C2.",
                              (Part(_exact(figures.true_rows_cases(kind, 6), _DERIVED)),)),
        counterexample=figures.straight_counterexample(6), **more)  # fmt: skip


CLAIMS: tuple[Claim, ...] = (
    holds("sec-5.bicubic", "Section 5", "All bases are bicubic: four rows and columns at least.",
          part(question(figures.table_cases(), "sizes in Table 1"))),
    holds("sec-5.middle-curves", "Section 5", "Figs. 5, 6, 8, 9 have one middle curve, Figs. 10 and 11 none.",
          part(question(figures.middle_curve_cases, "the two kinds of section 3 and the printed inner knots"))),
    ambiguous("sec-5.validation", "Section 5",
              "Mean curvature and zebra stripes show the C2 or G2 continuity of the examples.",
              Reading((part(proved(figures.mean_curvature_cases, "H in the coefficients of both fundamental forms")),),
                      label="G2, for a join whose tangent planes agree"),
              Reading((part(question(figures.invisible_cases, "normals and curvatures of plane joins")),), label="C2"),
              remark="Parametric continuity leaves no trace in a picture; with the conditions as printed Figs. 5, 8 "
              "and 9 can be G2 without being C2, and would look the same."),
    ambiguous("sec-5.mean-curvature", "Section 5", "Mean curvature shows the bending energy of the blends.",
              Reading((part(proved(figures.bending_cases(saddle=False), "H in the principal curvatures")),),
                      label="where one principal curvature is zero, such as on planes, cylinders and cones"),
              Reading((part(proved(figures.bending_cases(saddle=True), "H in the principal curvatures")),),
                      label="on any surface"),
              remark="kappa_1^2 + kappa_2^2 = 4 H^2 - 2 K: on a saddle with kappa_2 = -kappa_1 the mean curvature is "
              "zero, and the energy of section 3 is not."),
    holds("fig-5.knots", "Fig. 5", "Contact curves over {1/2} and {1/3, 2/3}, in bases of 6 x 5 and 6 x 6 points.",
          part(question(figures.knot_cases("fig-5"), _KNOTS))),
    _run_as_printed("fig-5.c2", "Fig. 5", "By the printed conditions, two planar patches are blended C2.", "plane",
                    consequence=partial(measured_rows, "start", _PRINTED_ROWS, "Planes with the knots of Fig. 5",
                                        "C2", planes),
                    remark="G2 all the same: rows of a plane stay in the plane, whatever their weights. So the error "
                    "of (3.1) cannot be seen in this figure."),
    holds_if("fig-5.same-knots", "Fig. 5", "Both planar patches can be given the knots {1/2}.",
             "the patch over {1/3, 2/3} is polynomial across these knots",
             part(question(figures.removable_cases, "spline spaces by exact rank"))),
    not_checkable("fig-5.ref-13", "Fig. 5", "The method of [13] reaches just G1 there.",
                  "the method of [13] is not printed here"),
    holds("fig-6.knots", "Fig. 6", "Contact curves with 6 and 4 inner knots, in bases of 5 x 10 and 5 x 8 points.",
          part(question(figures.knot_cases("fig-6"), _KNOTS))),
    fails("fig-6.g2", "Fig. 6", "By the printed conditions, a planar and a curved patch are blended G2.",
          part(_exact(figures.curvature_cases("curved", 6), _ROWS)),
          correction=Correction("With (3.1) and (3.2) corrected, by the formulas at cond-3.1 and cond-3.2, it is G2.",
                                (Part(_exact(figures.true_rows_cases("curved", 6), _DERIVED)),)),
          counterexample=figures.row_counterexample("curved", 6, parametric=False),
          consequence=partial(measured_rows, "end", {1: pr.COND_2_2, 2: pr.COND_3_2},
                              "A plane and a curved patch with the knots and sizes of Fig. 6, at the curved side", "G2",
                              plane_and_curved),
          remark="As printed, the second derivative along the normal is that of the base times (t_{k_s+1} - t_s) / "
          "u_2, with u_2 = 1/2 here: twice as much for a base of five rows with a uniform knot."),
    not_checkable("fig-6.iterations", "Fig. 6", "fminunc needs 5 iterations.", _ITERATIONS),
    holds("fig-7.hull", "Fig. 7", "Hartmann's blend lies in the convex hull of the pieces that it combines.",
          part(question(figures.hull_cases, "f and 1 - f at rational t, n = 1 to 3"))),
    holds("fig-7.reverse", "Fig. 7", "Combining pieces of the bases themselves, the blend runs back over them.",
          part(proved(figures.reverse_cases, "X_t at the contact", Strength.EACH_ORDER)),
          remark="It follows from the pieces lying inside the bases, not from the convex hull; pieces that continue "
          "the bases past the contact do not run back."),
    holds("fig-8.knots", "Fig. 8", "Contact curves over {0.3, 0.7} and {0.5}, in bases of 6 x 6 and 6 x 5 points.",
          part(question(figures.knot_cases("fig-8"), _KNOTS))),
    _run_as_printed("fig-8.c2", "Fig. 8", "By the printed conditions, two part cylinders are blended C2.", "straight",
                    consequence=partial(measured_rows, "start", _PRINTED_ROWS,
                                        _CYLINDERS, "C2", cylinders),
                    remark="Decided for contact along arcs, where the base is straight across; then the contact is G2 "
                    "all the same. For contact along rulings it is not even that: see fig-6.g2."),
    _run_as_printed("fig-9.c2", "Fig. 9", "By the printed conditions, the same are blended C2 in another posture.",
                    "straight",
                    consequence=partial(measured_rows, "start", _PRINTED_ROWS,
                                        _CYLINDERS, "C2", cylinders),
                    remark="As fig-8.c2: the posture does not enter."),
    holds("fig-9.same-bases", "Fig. 9", "The bases are those of Fig. 8.",
          part(question(figures.same_model_cases, "sizes in Table 1"))),
    fails("fig-10.first-knots", "Fig. 10", "The first contact curve has the printed knots, three zeros to begin with.",
          part(question(figures.knot_cases("fig-10", ("fig-10.first",)), _KNOTS)),
          correction=Correction("Four zeros, as Bezier end conditions and Table 1 need.",
                                (Part(question(figures.repaired_knot_cases, _KNOTS)),)),
          counterexample=figures.knot_10_counterexample, consequence=figures.knot_10_consequence,
          remark="Misprinted, or lost by the scan: with a fourth zero all numbers agree."),
    holds("fig-10.sevenths", "Fig. 10", "Its inner knots are 0.142857, .., 0.857143.",
          part(question(figures.seventh_cases, "sevenths rounded to six places"))),
    holds("fig-10.second-knots", "Fig. 10", "The second contact curve has four inner knots, in a base of 8 x 8 points.",
          part(question(figures.knot_cases("fig-10", ("fig-10.second",)), _KNOTS))),
    holds("fig-10.g2", "Fig. 10", "By the printed conditions, two complete cylinders are blended G2, no middle curve.",
          part(_exact(figures.curvature_cases("straight", 5), _ROWS)),
          remark="True with (3.1) as printed, by accident: a complete cylinder is met along a closed curve and, with "
          "a parameter along its rulings, is straight across; only the second derivative along the normal matters, "
          "and it is zero."),
    not_checkable("fig-10.iterations", "Fig. 10", "fminunc needs 6 iterations.", _ITERATIONS),
    holds("fig-11.counts", "Fig. 11", "The contact curves have 10 control points on the cone, 64 on the free form.",
          part(question(figures.cone_cases, "Table 1, 4 x 10 and 5 x 64"))),
    fails("fig-11.g2", "Fig. 11", "By the printed conditions, a cone and a free form are blended G2, no middle curve.",
          part(_exact(figures.curvature_cases("curved", 5), _ROWS)),
          correction=Correction("With (3.1) and (3.2) corrected, by the formulas at cond-3.1 and cond-3.2, it is G2.",
                                (Part(_exact(figures.true_rows_cases("curved", 5), _DERIVED)),)),
          counterexample=figures.row_counterexample("curved", 5, parametric=False),
          consequence=partial(measured_rows, "end", {1: pr.COND_2_2, 2: pr.COND_3_2},
                              "The made pair, whose second base stands for the free-form surface"),
          remark="On the cone it holds by accident, as in Fig. 10; on the free-form side it does not."),
    holds("table-1.sizes", "Table 1", "Sizes of the control nets, across and along the contact.",
          part(question(figures.table_cases(), "rows for (3.1), order 4 in both directions")),
          part(question(figures.knot_cases("fig-5"), _KNOTS)), part(question(figures.knot_cases("fig-6"), _KNOTS)),
          part(question(figures.knot_cases("fig-8"), _KNOTS)),
          remark="For Fig. 10 they agree with four zeros: fig-10.first-knots."),
    not_checkable("fig-4.layout", "Fig. 4", "Layout of bases and blend; the knots of R and S along v differ.",
                  "the figure is not part of the text that we have; its layout is decided in sec-3.three-curves"),
    not_checkable("table-1.times", "Table 1", "Computational times, 0.43 to 5.54 seconds.", _NO_DATA),
    not_checkable("table-1.energies", "Table 1", "Energies by (11), 2.44e6 to 6.78e6.", _NO_DATA),
    not_checkable("table-1.curvatures", "Table 1", "Ranges of mean curvature, all from 0.0000.", _NO_DATA),
)  # fmt: skip
