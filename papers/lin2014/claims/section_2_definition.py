"""Section 2, definition: (1) to (3), knot vectors, Fig. 1, properties, evaluation, conversion, derivatives."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import sympy as sp

from semispline.papers.checks import clamped, count_check, identity_cases, proof_check
from semispline.papers.ledger import (
    Case,
    Check,
    Claim,
    Correction,
    Counterexample,
    Formula,
    Numbers,
    Part,
    Reading,
    Strength,
    Verdict,
    consistent,
    data_formula,
    given,
    number_changes,
    premises,
    proved,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import order_of_evaluation, representation
from semispline.papers.lin2014.checks.counts import knot_count_instances
from semispline.papers.lin2014.checks.definitions import CURVE_CHECK, SURFACE_CHECK, curve_instances
from semispline.papers.lin2014.checks.measured_section_2 import one_function_for_all
from semispline.papers.lin2014.checks.printed_numbers import CONTACTS
from semispline.papers.lin2014.checks.samples import Sample
from semispline.papers.lin2014.printed_figures import MIDDLE_CURVES

_WHERE = "Section 2, definition"
_PROPERTIES = "Section 2, properties"
_COUNT = (
    "the number of functions by induction on the order, for every order and count; orders 1 to 6 by running the "
    "recurrence on distinct knots"
)
_EITHER_ORDER = "what multiplies one control point, summed in either order; triangles in either order at instances"


def _figure_1_cases(formula: Formula | None) -> Iterator[Case]:
    counts = tuple(given(formula).relation.rhs)
    yield Case("seven curves, m = 6", len(counts) == 7)
    yield Case("the first three agree, as (13) asks", len(set(counts[:3])) == 1)
    yield Case("the last three agree, as (13) asks", len(set(counts[-3:])) == 1)
    yield Case("each carries a cubic curve, order 4", bool(min(counts) >= 4))


def _figure_1() -> Formula:
    """Return the counts of Fig. 1 as a formula."""
    counts = Numbers(*pr.FIGURE_1_COUNTS)
    middle = [changed for changed in number_changes(counts) if changed[3] != counts[3]]
    reason = "the middle curve has a count of its own, which only the caption gives: its knots are not printed"
    return data_formula("N", counts, reason, middle)


def _wrong_basis_counterexample() -> Counterexample:
    """Search orders, curves and control points for the smallest at which the family B_{i,l} gives another curve."""
    for case in curve_instances(pr.BASIS_OF_CURVE):
        if not case.true:
            return Counterexample((("instance", case.label),), f"off by {case.residual}", "0")
    raise ValueError("the search found no counterexample")


# How many of the knot vectors V_0 .. V_m differ: each from each other, as the text after (2) has it.
COUNT_OF_VECTORS = Formula(sp.Eq(pr.last, pr.m + 1), (pr.last, pr.m), (pr.m >= 5,))


def _different_vector_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the number of different knot vectors against the blends of (13): three are V^r, three V^s."""
    printed = given(formula).relation.rhs
    counts = dict(zip(pr.SIZES, MIDDLE_CURVES.relation.rhs, strict=True))
    for figure, (first, second) in CONTACTS.items():
        middle = int(counts[figure])
        m = 5 + middle
        vectors = [pr.KNOTS[first]] * 3 + ["middle"] * middle + [pr.KNOTS[second]] * 3
        residual = printed.subs(pr.m, m) - len(set(vectors))
        yield Case(f"{figure}, m = {m}", bool(residual == 0), residual=residual)


def _vectors_may_differ_cases() -> Iterator[Case]:
    """Yield surfaces whose curves all have knot vectors of their own: defined on the whole domain, like any other."""
    for order in (2, 3, 4):
        vectors = [clamped(order, sp.Rational(i, 7)) for i in range(1, 6)]
        sample = Sample(4, order, clamped(4, sp.Rational(1, 2)), tuple(vectors))
        factors = sample.weights(Fraction(2, 7), Fraction(3, 7))
        different = len(set(vectors)) == sample.m + 1
        yield Case(f"order {order}, {sample.m + 1} vectors", different and sum(factors) == 1, own=order == pr.CUBIC)


def _domain_cases() -> Iterator[Case]:
    yield from premises(identity_cases("partition of unity"))
    yield from representation.common_domain_cases()


CLAIMS = (
    Claim(
        "def-1",
        _WHERE,
        "A semi-structured surface: v-control curves, each with a knot vector V_i of its own, skinned over U; defined "
        "for u in [u_s, u_e] and v in [v_s, v_e].",
        Verdict.HOLDS_IF,
        (
            Reading(
                (
                    Part(
                        proved(
                            _domain_cases,
                            "partition of unity of every curve on its domain, every order and knots; outside of it a "
                            "counterexample is enough",
                        )
                    ),
                ),
                condition="the domain [v^i_{l-1}, v^i_{n_i+1}] of every curve contains [v_s, v_e]",
            ),
        ),
        remark="Definition 1 lets V_i be any knot vectors; (13) and the text on contact curves do ask for one domain.",
    ),
    Claim(
        "eq-1",
        _WHERE,
        "The double sum over control points and the skin of the v-control curves are one surface.",
        Verdict.HOLDS,
        (Reading((Part(SURFACE_CHECK, pr.EQ_1),)),),
    ),
    Claim(
        "sec-2.u-knots",
        _WHERE,
        "m + 1 basis functions of order k in u need the knots u_0, ..., u_{m+k}.",
        Verdict.HOLDS,
        (Reading((Part(count_check(knot_count_instances(pr.m, pr.k), _COUNT), pr.U_LAST),)),),
    ),
    Claim(
        "sec-2.v-knots",
        _WHERE,
        "n_i + 1 basis functions of order l of curve i need the knots v^i_0, ..., v^i_{n_i+l}.",
        Verdict.HOLDS,
        (Reading((Part(count_check(knot_count_instances(pr.n_i, pr.ell), _COUNT), pr.V_LAST),)),),
    ),
    Claim(
        "sec-2.basis-index",
        _WHERE,
        "The basis of curve i is the family B_{i,l}(v; V_i), j = 0, ..., n_i.",
        Verdict.FAILS,
        (Reading((Part(CURVE_CHECK, pr.BASIS_OF_CURVE),)),),
        Correction("The family is B_{j,l}(v; V_i), as in (1).", (Part(CURVE_CHECK, pr.EQ_2),)),
        _wrong_basis_counterexample,
        one_function_for_all,
        cause="misprints",
        remark="One index misprinted, or misread by the scan: with j for i it is right, as in (1) and (2).",
    ),
    Claim(
        "eq-2",
        _WHERE,
        "Each v-control curve is a B-spline curve over its own knots.",
        Verdict.HOLDS,
        (Reading((Part(CURVE_CHECK, pr.EQ_2),)),),
    ),
    Claim(
        "sec-2.different-vectors",
        _WHERE,
        "Each v-control curve has a different knot vector.",
        Verdict.AMBIGUOUS,
        (
            Reading(
                (
                    Part(
                        Check(
                            _different_vector_cases,
                            Strength.RATIONAL,
                            "counting the vectors of (13) over the printed knots of the figures: one counterexample "
                            "is enough",
                            proof=True,
                        ),
                        COUNT_OF_VECTORS,
                    ),
                ),
                label="no two of V_0 .. V_m are the same",
            ),
            Reading(
                (
                    Part(
                        proved(
                            _vectors_may_differ_cases,
                            "surfaces with as many vectors as curves: one example is enough",
                            Strength.RATIONAL,
                        )
                    ),
                ),
                label="they may differ, as the sentence before (2) has it",
            ),
        ),
        remark="(13) asks for equal vectors in the first three curves and in the last three, and Fig. 1 shows equal "
        "counts there; classical surfaces, which are said to be a special case, have one vector.",
    ),
    Claim(
        "eq-3",
        _WHERE,
        "The surface (1) is the skin of the curves (2).",
        Verdict.HOLDS,
        (Reading((Part(SURFACE_CHECK, pr.EQ_3),)),),
    ),
    Claim(
        "fig-1.counts",
        "Fig. 1",
        "Seven v-control curves with 5, 5, 5, 7, 6, 6, 6 control points.",
        Verdict.HOLDS,
        (
            Reading(
                (
                    Part(
                        consistent(
                            _figure_1_cases,
                            "counts against Definition 1 and (13) for a bicubic surface, all seven printed numbers",
                        ),
                        _figure_1(),
                    ),
                )
            ),
        ),
        remark="Laid out like (13) with one middle curve. With single inner knots, 1 and 2 of them, the rule of "
        "section 3 gives that curve 5 or 6 points, never 7, which the union of the knots gives. The caption does not "
        "say that the rule was used.",
    ),
    Claim(
        "sec-1.generalisation",
        "Section 1.1",
        "The semi-structured surface generalises the classical one: with equal knot vectors it is that.",
        Verdict.HOLDS,
        (Reading((Part(proved(representation.same_knots_cases, _EITHER_ORDER)),)),),
    ),
    Claim(
        "sec-2.evaluation",
        "Section 2, evaluation",
        "The surface is evaluated by de Boor's algorithm first along v on each curve, then along u.",
        Verdict.HOLDS,
        (Reading((Part(SURFACE_CHECK, pr.EQ_1),)),),
    ),
    Claim(
        "sec-2.evaluation-order",
        "Section 2, evaluation",
        "It has to be evaluated first along v: the other way is wrong.",
        Verdict.AMBIGUOUS,
        (
            Reading(
                (
                    Part(
                        proved(
                            order_of_evaluation.columns_first_cases,
                            "smoothness at a knot that one vector has more often, every order and knots; triangles "
                            "first along u on columns of control points, rows of equal length, any control points, "
                            "orders 2 to 4",
                        )
                    ),
                ),
                label="on the control points as they stand",
                condition="the knot vectors differ",
            ),
            Reading(
                (
                    Part(
                        proved(
                            order_of_evaluation.merged_first_cases,
                            "triangles first along u after knot insertion, any control points: one example is enough",
                            Strength.RATIONAL,
                        )
                    ),
                ),
                label="whatever is done before",
            ),
        ),
        remark="Rows of unequal length have no columns at all. After all rows have been given all knots, as the paper "
        "says they can be, either order gives the surface.",
    ),
    Claim(
        "sec-2.evaluation-classical",
        "Section 2, evaluation",
        "A classical surface may be evaluated in either order.",
        Verdict.HOLDS,
        (Reading((Part(proved(representation.same_knots_cases, _EITHER_ORDER)),)),),
    ),
    Claim(
        "sec-2.convex-hull",
        _PROPERTIES,
        "The surface lies in the convex hull of its control points.",
        Verdict.HOLDS,
        (Reading((Part(proof_check("convex hull", instances=representation.weight_cases)),)),),
    ),
    Claim(
        "sec-2.affine-invariance",
        _PROPERTIES,
        "An affine map of the control points maps the surface.",
        Verdict.HOLDS,
        (
            Reading(
                (Part(proof_check("affine invariance", "partition of unity", instances=representation.affine_cases)),)
            ),
        ),
    ),
    Claim(
        "sec-2.localness",
        _PROPERTIES,
        "A control point moves only a part of the surface.",
        Verdict.HOLDS,
        (
            Reading(
                (
                    Part(
                        proved(
                            representation.locality_cases,
                            "where the two functions of lower order in the recurrence vanish, by induction on the "
                            "order, every order and knots; the spans on which the functions of orders 2 to 8 live",
                        )
                    ),
                )
            ),
        ),
        remark="P_ij acts on [u_i, u_{i+k}] x [v^i_j, v^i_{j+l}].",
    ),
    Claim(
        "sec-2.continuity-control",
        _PROPERTIES,
        "The continuity at each knot of a v-control curve can be set independently of the other curves.",
        Verdict.HOLDS,
        (
            Reading(
                (
                    Part(
                        proved(
                            representation.continuity_control_cases,
                            "smoothness at a knot of each multiplicity by induction on the degree, every degree and "
                            "knots; at a symbolic knot for orders 2 to 5",
                        )
                    ),
                    Part(
                        proved(
                            representation.independent_control_cases,
                            "what multiplies the jump of one curve; the reach of its u-function by an example",
                        )
                    ),
                )
            ),
        ),
        remark="So a knot line of one curve ends inside the domain, where the u-function of that curve ends: what "
        "section 1.1 says of T-splines and semi-regular splines.",
    ),
    Claim(
        "sec-2.transformation",
        _PROPERTIES,
        "Knot insertion turns a semi-structured surface exactly into a classical one.",
        Verdict.HOLDS,
        (
            Reading(
                (
                    Part(
                        proved(
                            representation.conversion_cases,
                            "knot insertion by induction on the order, for every order, knots and place of the new "
                            "knot; spaces over the union of knots by rank",
                        )
                    ),
                )
            ),
        ),
    ),
    Claim(
        "sec-2.derivatives-classical",
        _PROPERTIES,
        "Partial derivatives of a classical surface are spline surfaces of lower degree.",
        Verdict.HOLDS,
        (
            Reading(
                (Part(proof_check("derivative", "u-derivative", instances=representation.classical_derivative_cases)),)
            ),
        ),
        remark="The text points at (1) for the classical surface; (1) is the semi-structured one.",
    ),
    Claim(
        "sec-2.derivatives-hard",
        _PROPERTIES,
        "u-derivatives of a semi-structured surface are hard to represent as spline forms.",
        Verdict.AMBIGUOUS,
        (
            Reading(
                (
                    Part(
                        proved(
                            representation.row_difference_cases,
                            "smoothness at a knot that one row alone has, by induction on the degree, every degree "
                            "and knots; spline spaces by rank",
                        )
                    ),
                ),
                label="their rows do not fit on the knot vectors V_i",
            ),
            Reading(
                (
                    Part(
                        proved(
                            representation.no_spline_form_cases,
                            "differenced rows over merged knots, for every order and knots; exactly at instances",
                        )
                    ),
                ),
                label="they have no spline form",
            ),
        ),
        remark="P_u is a semi-structured surface again: row i is (k-1)(P_{i+1}(v) - P_i(v))/(u_{i+k} - u_{i+1}), a "
        "curve over the merged knots of V_i and V_{i+1} (proved for every order in semispline.derivations.properties).",
    ),
)
