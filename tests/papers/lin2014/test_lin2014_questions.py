"""Checks that have no formula to perturb: each turns when the object that it is about is perturbed."""

from fractions import Fraction

import pytest
import sympy as sp

from helpers.sweeps import first_ones
from semispline.derivations import counts as derivations_counts
from semispline.papers.checks import spline_facts, spline_spaces
from semispline.papers.checks.counts import count_check
from semispline.papers.checks.spline_values import spline_basis
from semispline.papers.ledger import exact
from semispline.papers.ledger.verification import decide
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import (
    construction,
    contact_rows,
    converted_blends,
    counts,
    definitions,
    energy,
    fewer_control_points,
    geometric_continuity,
    many_rows,
    objective,
    order_of_evaluation,
    printed_pairs,
    representation,
    rows_along_normal,
)
from semispline.papers.lin2014.checks import samples as spline_samples
from semispline.papers.lin2014.checks.samples import Sample
from semispline.papers.lin2014.claims import section_2_definition as claims_2_definition
from semispline.papers.lin2014.claims import section_3_blending as claims_3_blending
from semispline.papers.lin2014.claims import section_3_conditions as claims_3_conditions
from semispline.papers.lin2014.claims import section_4 as claims_4_implementation
from semispline.papers.lin2014.claims import section_a as claims_appendix

RECORDS = (claims_2_definition, claims_3_blending, claims_3_conditions, claims_4_implementation, claims_appendix)
# Whatever remembers what it has computed.
MODULES = (
    *(derivations_counts, exact, spline_facts, spline_spaces, construction, contact_rows, counts, definitions, energy),
    *(
        fewer_control_points,
        geometric_continuity,
        many_rows,
        objective,
        printed_pairs,
        representation,
        rows_along_normal,
    ),
)
CLAIMS = {claim.id: claim for module in RECORDS for claim in module.CLAIMS}


def questions(claim):
    """Return the parts without a formula, of readings and correction."""
    return [part for part in claim.parts + claim.correction_parts if part.formula is None]


def doubled_basis(knots):
    """Return twice the basis."""
    right = spline_basis(knots)
    return lambda *arguments: 2 * right(*arguments)


def basis_without_slope(knots):
    """Return the functions themselves for their derivatives."""
    right = spline_basis(knots)
    return lambda i, order, x, name, derivative=0: right(i, order, x, name)


def bent(order, knots, points, x):
    """Evaluate nothing that is linear in the points."""
    return points[0] * points[0] * x + points[-1]


def saddle():
    return sp.Symbol("P_uu") ** 2 - sp.Symbol("P_vv") ** 2


def first_of(order, *vectors):
    return vectors[0]


def repeated_last(order, knots, points, x):
    """Insert a knot and repeat the last control point, instead of cutting corners."""
    return sorted([*knots, x]), [*points, points[-1]]


SADDLE = (objective, "thin_plate_density", saddle)
# Least at a = gap - 3/2, so that plates that are close do not join.
PLATES = (
    energy,
    "end_energy",
    lambda k, m, data: (data[1] - data[3] + Fraction(3, 2)) ** 2 + (data[4] - 1) ** 2,
)
BENT = (representation, "de_boor", bent)
# Record, which of its questions -> what is replaced where, by what.
PERTURBED = {
    ("def-1", 0): [(representation, "spline_basis", doubled_basis)],
    ("sec-2.different-vectors", 0): [(Sample, "weights", lambda *_: [Fraction(2)])],
    ("sec-1.generalisation", 0): [BENT],
    ("sec-2.evaluation-classical", 0): [BENT],
    ("sec-2.evaluation-order", 0): [(order_of_evaluation, "de_boor", lambda *_: 0), (Sample, "value", lambda *_: 0)],
    ("sec-2.evaluation-order", 1): [(order_of_evaluation, "inserted", repeated_last)],
    ("sec-2.convex-hull", 0): [
        (spline_samples, "spline_basis", doubled_basis),
        (representation, "partition_residuals", lambda *_: [sp.Poly(1, sp.Symbol("x"))]),
        (representation, "least_bernstein_coefficient", lambda *_: -1),
    ],
    ("sec-2.affine-invariance", 0): [(spline_samples, "de_boor", bent)],
    ("sec-2.localness", 0): [
        (representation, "supports", lambda degree, knots: [tuple(range(degree, 9))] * (len(knots) - degree - 1)),
        (spline_facts, "_lower_function", lambda j, order, span: sp.Symbol(f"N_{j}")),
        (Sample, "weights", lambda sample, u, v: [Fraction(1)] * sum(sample.sizes)),
    ],
    ("sec-2.continuity-control", 0): [(spline_spaces, "contact_orders", lambda *_: [7])],
    ("sec-2.continuity-control", 1): [(representation, "_jump", lambda vector: sp.Integer(0))],
    ("sec-2.transformation", 0): [(representation, "union", first_of)],
    ("sec-2.derivatives-classical", 0): [(representation, "spline_basis", basis_without_slope)],
    ("sec-2.derivatives-hard", 0): [(representation, "contained", lambda *_: True)],
    ("sec-2.derivatives-hard", 1): [(representation, "union", first_of)],
    ("sec-3.contact-knots", 0): [
        (construction, "de_boor", bent),
        (construction, "end_derivatives", lambda *_: sp.ones(3)),
    ],
    ("sec-3.not-classical", 0): [(construction, "contained", lambda *_: True)],
    ("sec-3.thin-plate", 0): [(objective, "thin_plate_density", lambda: sp.Integer(0))],
    ("eq-11", 0): [(energy, "gram_matrix", lambda derivative, one, other: sp.eye(one.size))],
    ("eq-12", 0): [SADDLE],
    ("eq-12", 1): [PLATES],
    ("sec-3.three-curves", 0): [(construction, "contact_rows", lambda *_: sp.eye(3))],
    ("sec-3.fewer-better", 0): [(many_rows, "contained", lambda *_: True)],
    ("sec-3.minimum-over-rows", 0): [SADDLE],
    ("sec-3.minimum-over-rows", 1): [(many_rows, "_lacks", lambda data: (0, 0))],
    ("sec-1.fairness", 0): [(construction, "PRINTED_PAIRS", {"one": ("fig-5.first", "fig-5.first")})],
    ("sec-1.fairness", 1): [(energy, "middle_knot_energies", lambda: (sp.Integer(1), sp.Integer(2)))],
    ("sec-1.fairness", 2): [(construction, "union", first_of)],
    ("sec-3.averaging", 0): [(construction, "merged", lambda name: (Fraction(3, 4), Fraction(1, 2), Fraction(1, 4)))],
    ("sec-3.averaging-direction", 0): [(converted_blends, "_WEIGHTS", (sp.Rational(1, 3), sp.Rational(2, 3)))],
    ("sec-3.averaging-few", 0): [(converted_blends, "pair_means", list)],
    ("sec-3.sufficient-g1", 0): [
        (geometric_continuity, "tangent_coordinates", lambda vector: (1, 1)),
        (geometric_continuity, "_regular", lambda patch: True),
    ],
    ("sec-3.sufficient-g2", 1): [
        (geometric_continuity, "tangent_coordinates", lambda vector: (1, 1)),
        (geometric_continuity, "_slope_and_mixed", lambda: (sp.zeros(3, 1), sp.zeros(3, 1))),
        (geometric_continuity, "special_conditions", lambda order: (0, *[sp.Symbol("R_w")] * order)),
    ],
    ("sec-4.no-middle-curve", 0): [
        (construction, "contact_matrix", lambda *_: sp.ones(6)),
        (construction, "set_rows", lambda order: (1, pr.m - 1)),
    ],
    ("sec-4.normal-equation", 0): [SADDLE],
    ("sec-4.c1-similarly", 0): [SADDLE],
    ("eq-14", 0): [(energy, "printed_system", lambda: (sp.eye(5), sp.eye(5)))],
    ("eq-14", 1): [
        (energy, "_integral", lambda *_: sp.Integer(1)),
        (objective, "end_derivatives", lambda *_: sp.ones(3)),
    ],
    ("sec-4.unconstrained", 0): [PLATES],
}
PERTURBED |= {
    ("sec-A.special-choice", 0): [
        (geometric_continuity, "tangent_coordinates", lambda vector: (1, 1)),
        (geometric_continuity, "special_conditions", lambda order: (0, *[sp.Symbol("R_w")] * order)),
    ],
    ("sec-A.special-choice", 1): [(geometric_continuity, "_instances", lambda: iter(()))],
}
# Its object is the list of parts of its own record.
BY_HAND = {("sec-3.sufficient-g2", 0)}


def clear_caches():
    for module in MODULES:
        for value in vars(module).values():
            if hasattr(value, "cache_clear"):
                value.cache_clear()


@pytest.fixture
def fresh_caches():
    """Start from nothing, and leave nothing behind that was computed from a perturbed object."""
    clear_caches()
    yield
    clear_caches()


@pytest.fixture(scope="module")
def answers():
    """Return what each question comes to as it is."""
    return {(name, n): truths(part) for name, claim in CLAIMS.items() for n, part in enumerate(questions(claim))}


def truths(part):
    return [case.true for case in part.check.cases(None)]


def test_every_question_of_these_records_is_perturbed():
    asked = {(name, n) for name, claim in CLAIMS.items() for n, _ in enumerate(questions(claim))}
    assert asked == set(PERTURBED) | BY_HAND


@pytest.mark.long
@pytest.mark.parametrize(
    ("place", "module", "name", "wrong"),
    [(place, *change) for place, changes in PERTURBED.items() for change in changes],
    ids=lambda value: value if isinstance(value, str) else None,
)
def test_a_question_turns_when_its_object_is_perturbed(place, module, name, wrong, answers, monkeypatch, fresh_caches):
    identifier, n = place
    monkeypatch.setattr(module, name, wrong)
    assert truths(questions(CLAIMS[identifier])[n]) != answers[place]


def test_a_missing_part_of_the_corrected_g2_conditions_is_noticed():
    parts = CLAIMS["sec-3.sufficient-g2"].correction_parts
    formulas = tuple(part.formula for part in parts if part.formula is not None)
    assert all(case.true for case in claims_3_conditions.set_rows_cases(formulas))
    for missing in formulas:
        left = tuple(formula for formula in formulas if formula is not missing)
        assert [case.true for case in claims_3_conditions.set_rows_cases(left)].count(False) == 1
    # The check of the record sees just the formulas that stand beside it.
    assert len(formulas) == 6
    (question, _) = questions(CLAIMS["sec-3.sufficient-g2"])
    assert question.check.cases.__closure__[0].cell_contents.args[0] == formulas


@pytest.mark.parametrize(("order", "formula"), [(1, pr.EQ_15), (2, pr.EQ_16)])
def test_necessity_is_proved_for_any_surfaces(order, formula, monkeypatch):
    """Without the part on necessity, or with wrong coordinates in the tangent plane, this is red."""
    check = geometric_continuity.general_check(order)
    name = f"necessity, any R and P: some p_{order}, q_{order}"

    def found():
        return next(case.true for case in check.cases(formula) if case.label.startswith(name))

    assert found()
    right = geometric_continuity.tangent_coordinates
    monkeypatch.setattr(geometric_continuity, "tangent_coordinates", lambda vector: right(vector)[::-1])
    assert not found()


@pytest.mark.parametrize(("order", "formula", "name"), [(1, pr.EQ_15, "P_u x P_v"), (2, pr.EQ_16, "the forms agree")])
def test_sufficiency_is_proved_for_any_surfaces(order, formula, name):
    """A condition that asks for something else does not suffice."""
    check = geometric_continuity.general_check(order)

    def found(given):
        return next(c.true for c in check.cases(given) if c.label.startswith("sufficiency") and name in c.label)

    wrong = pr.Formula(formula.relation.xreplace({pr.R_ww: pr.R_wv, pr.R_w: 2 * pr.R_w}), formula.variables)
    assert (found(formula), found(wrong)) == (True, False)


def test_tangent_coordinates_at_numbers():
    """By hand: 3 R_w - 2 R_v + 5 N for R_w = (1, 2, 0), R_v = (0, 1, 1)."""
    r_w, r_v = sp.Matrix([1, 2, 0]), sp.Matrix([0, 1, 1])
    vector = 3 * r_w - 2 * r_v + 5 * r_w.cross(r_v)
    at = {}
    for letter, value in ((pr.R_w, r_w), (pr.R_v, r_v)):
        at |= dict(zip(sp.symbols(f"{letter}_x:z"), value, strict=True))
    assert [x.subs(at) for x in geometric_continuity.tangent_coordinates(vector)] == [3, -2]


@pytest.mark.parametrize("name", first_ones(1, ["eq-12", "sec-4.unconstrained", "sec-1.fairness"]))
def test_what_was_only_checked_once_is_proved(name):
    decision = decide(CLAIMS[name])
    assert decision.ok
    assert decision.proved


@pytest.mark.long
def test_a_layout_with_other_rows_would_be_counted():
    """Rows that enter the contact are counted, not set: for first-order contact they are 0, 1 and m - 1, m."""
    assert {(m, ends) for _, m, ends, _ in construction.counted_rows(1)} >= {(5, (1, 4)), (6, (1, 5))}
    assert construction.set_rows(1) == (1, pr.m - 1)
    assert construction.set_rows(3) == (3, pr.m - 3)


def test_the_end_of_the_domain_follows_from_the_number_of_functions(monkeypatch, fresh_caches):
    """Where each step of the recurrence lost two functions the domain would end elsewhere."""

    def first_case():
        counting = counts.domain_instances(pr.m_r, pr.k_r)
        return next(iter(count_check(counting, "-").cases(pr.RUN_STARTS[0])))

    assert first_case().true
    clear_caches()
    monkeypatch.setattr(derivations_counts, "functions_of_order", lambda last, order: last - 2 * order)
    assert not first_case().true
