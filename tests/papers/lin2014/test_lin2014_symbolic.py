"""Proofs for every order, knot vector and count: each kind turns red when its formula or its premise is wrong."""

import pytest
import sympy as sp

from helpers.sweeps import first_ones
from semispline.papers.checks import spline_spaces
from semispline.papers.checks.counts import count_check
from semispline.papers.checks.spline_spaces import contact_at_knot
from semispline.papers.ledger.records import Formula, Strength
from semispline.papers.ledger.verification import decide
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import construction, counts, definitions, objective, representation
from semispline.papers.lin2014.checks.contact_rows import mirror_check, row_check
from semispline.papers.lin2014.claims import section_2_definition as claims_2_definition
from semispline.papers.lin2014.claims import section_3_blending as claims_3_blending
from semispline.papers.lin2014.claims import section_3_conditions as claims_3_conditions
from semispline.papers.lin2014.claims import section_4 as claims_4_implementation
from semispline.papers.lin2014.claims import section_a as claims_appendix
from semispline.papers.lin2014.claims.section_4 import NORMAL_EQUATION, TRUE_14

CLAIMS = {
    claim.id: claim
    for module in (
        claims_2_definition,
        claims_3_blending,
        claims_3_conditions,
        claims_4_implementation,
        claims_appendix,
    )
    for claim in module.CLAIMS
}


def truths(cases):
    return [case.true for case in cases]


def changed(formula, old, new):
    return Formula(formula.relation.xreplace({old: new}), formula.variables)


def reading_holds(reading):
    return all(case.true for part in reading.parts for case in part.check.cases(part.formula) if case.meets)


# Decided at less than strength 2, and why that is enough, or that it is not a proof; it stands in the method.
BY_INSTANCES = {
    "fig-1.counts": ["seven printed numbers"],
    "sec-2.evaluation-order": ["one example is enough"],
    "sec-2.different-vectors": ["one counterexample is enough", "one example is enough"],
    "sec-3.fewer-better": ["least energy (11) of strips", "over the printed pairs"],
    "sec-3.minimum-over-rows": ["one counterexample is enough"],
    "sec-1.fairness": ["one counterexample is enough"],
    "sec-A.special-choice": ["one counterexample is enough"],
}
# A proof of a general claim is none of these.
ONLY_CHECKED = {"sec-1.fairness"}


def test_no_claim_of_sections_2_to_4_rests_on_instances_without_a_reason():
    for name, claim in CLAIMS.items():
        weak = [part.check for part in claim.parts if part.check.strength > Strength.EACH]
        reasons = BY_INSTANCES.get(name, [])
        assert len(weak) == len(reasons), name
        assert all(reason in check.method for reason, check in zip(reasons, weak, strict=True)), name
        if name in ONLY_CHECKED:
            assert not any(check.proof for check in weak), name
        if claim.correction:
            parts = claim.correction.parts
            assert all(p.check.proof and p.check.strength <= Strength.EACH for p in parts), name


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "holds"),
    [
        ("sec-2.derivatives-hard", [True, False]),
        ("sec-3.thin-plate", [True, False]),
        ("sec-3.strain-energy", [False, True]),
        ("eq-12", [True, True]),
        ("sec-3.u-numbering", [True, False]),
        ("sec-1.fairness", [True, False]),
        ("sec-3.averaging", [False, True, True]),
        ("sec-3.fewer-better", [False, True]),
        ("sec-3.minimum-over-rows", [True, False]),
        ("sec-3.averaging-direction", [False, True]),
        ("sec-3.parametric-c1", [False, True]),
        ("sec-2.evaluation-order", [True, False]),
        ("sec-2.different-vectors", [False, True]),
        ("cond-3.1", [False, False]),
        ("cond-3.2", [False, False]),
        ("sec-3.sufficient-g2", [False, False]),
        ("sec-3.parametric-c2", [False, False]),
        ("sec-4.initial-value", [False, False, True]),
        ("eq-17", [True, False]),
        ("sec-A.special-choice", [True, False]),
        ("sec-3.one-surface", [False, False, False]),
    ],
)
def test_each_reading_of_a_claim(name, holds):
    """Decided by hand: which reading is true, so that two errors cannot hide behind one verdict."""
    assert [reading_holds(reading) for reading in CLAIMS[name].readings] == holds


@pytest.mark.parametrize(
    ("check", "formula", "old", "new"),
    [
        (definitions.SURFACE_CHECK, pr.EQ_1, pr.m, pr.m - 1),
        (definitions.SURFACE_CHECK, pr.EQ_3, pr.k, pr.k + 1),
        (definitions.CURVE_CHECK, pr.EQ_2, pr.B(pr.j, pr.ell, pr.v, pr.V(pr.i)), pr.B(pr.i, pr.ell, pr.v, pr.V(pr.j))),
        (definitions.base_check("R"), pr.EQ_7, pr.n_r, pr.m_r),
        (count_check(counts.knot_count_instances(pr.m, pr.k), "-"), pr.U_LAST, pr.k, pr.k - 1),
        (count_check(counts.domain_instances(pr.m_r, pr.k_r), "-"), pr.RUN_ENDS[0], pr.k_r, pr.k_r + 1),
        (count_check(counts.domain_instances(pr.m_r, pr.k_r), "-"), pr.RUN_STARTS[0], pr.m_r, pr.m_r + 1),
        (count_check(counts.inner_knots_count(), "-"), pr.INNER_LAST, pr.n_r, pr.n_r + 1),
        (count_check(construction.u_length(), "-"), pr.U_LENGTH, pr.m, pr.m + 1),
        (construction.middle_count_check(1), claims_3_blending.ONE_MIDDLE, sp.Integer(6), sp.Integer(7)),
        (objective.GRAM_CHECK, TRUE_14, pr.A_1, pr.A_2),
        (objective.NORMAL_EQUATION_CHECK, NORMAL_EQUATION, objective.LAST_FREE, objective.LAST_KNOWN),
        (objective.degree_check(2, geometric=True), pr.DEGREE_G2, sp.Integer(8), sp.Integer(6)),
        (objective.direction_check(-1), claims_3_conditions.PARAMETRIC_2_1, pr.k, pr.k + 1),
        (mirror_check(0), pr.COND_1_2, pr.S_0, pr.S_1),
    ],
)
def test_the_first_case_alone_tells_a_wrong_formula(check, formula, old, new):
    """The first case is the one for every order: no instance is needed to see the error."""
    first = next(iter(check.cases(formula)))
    assert first.true
    assert first.residual == 0
    wrong = next(iter(check.cases(changed(formula, old, new))))
    assert not wrong.true
    assert wrong.residual != 0


def test_the_inner_knot_of_a_cubic_with_five_points_is_knot_4():
    counting = counts.inner_knots_count()
    at = {pr.n_r: 4, pr.ell: 4}
    assert [sp.sympify(counting.exact[letter]).subs(at) for letter in (pr.first, pr.last)] == [4, 4]


def test_the_gram_integrand_against_integrals_of_two_bumps():
    """A pair of functions with known integrals: u^2 and u^3 over [0, 1], v and v^2 over [0, 1]."""
    u, v = sp.symbols("u v")
    of_u, of_v = (u**2, u**3), (v, v**2)
    x, y = sp.symbols("x y")
    P = x * of_u[0] * of_v[0] + y * of_u[1] * of_v[1]
    density = P.diff(u, 2) ** 2 + 2 * P.diff(u, v) ** 2 + P.diff(v, 2) ** 2
    energy = sp.integrate(sp.expand(density), (u, 0, 1), (v, 0, 1))
    values = {}
    for d, (across, along) in enumerate(((pr.A_0, pr.G_0), (pr.A_1, pr.G_1), (pr.A_2, pr.G_2))):
        values[across] = sp.integrate(of_u[0].diff((u, d)) * of_u[1].diff((u, d)) if d else u**5, (u, 0, 1))
        values[along] = sp.integrate(of_v[0].diff((v, d)) * of_v[1].diff((v, d)) if d else v**3, (v, 0, 1))
    assert TRUE_14.relation.rhs.subs(values) == sp.diff(energy, x, y) / 2


@pytest.mark.long
def test_a_premise_that_fails_makes_the_proof_red(monkeypatch):
    """A saddle for the plate, a row of contact that is missing, a knot of full multiplicity: each is noticed."""
    saddle = sp.Symbol("P_uu") ** 2 - sp.Symbol("P_vv") ** 2
    monkeypatch.setattr(objective, "thin_plate_density", lambda: saddle)
    assert truths(objective.unique_minimum_cases(2))[0] is False
    monkeypatch.undo()
    monkeypatch.setattr(objective, "end_derivatives", lambda *_: sp.Matrix([[1, 0], [1, 0]]))
    assert truths(objective.unique_minimum_cases(2))[1] is False
    monkeypatch.setattr(objective, "end_derivatives", lambda *_: sp.ones(3))
    assert truths(objective.integrals_vanish_cases())[0] is False
    monkeypatch.undo()
    monkeypatch.setattr(spline_spaces, "contact_orders", lambda *_: [7])
    contact_at_knot.cache_clear()
    found = [case.true for case in representation.continuity_control_cases() if "multiplicity" in case.label]
    assert found
    assert not any(found)
    contact_at_knot.cache_clear()


@pytest.mark.parametrize("name", first_ones(1, ["eq-12", "sec-4.normal-equation", "sec-4.c1-similarly"]))
def test_an_argument_without_its_premise_gives_no_verdict(name, monkeypatch):
    """Where it would otherwise turn into `fails`, or hide behind `ambiguous`."""
    monkeypatch.setattr(objective, "thin_plate_density", lambda: sp.Symbol("P_uu") ** 2 - sp.Symbol("P_vv") ** 2)
    decision = decide(CLAIMS[name])
    assert decision.verdict is None
    assert "(11) is a sum of squares" in decision.problem


def test_end_rows_hold_for_every_order_of_the_base():
    """(2.2) for symbolic orders as if u_{m-3} were the last inner knot; (3.2) not even then."""
    assert [next(iter(row_check("end", 1).cases(pr.COND_2_2))).true] == [True]
    first = next(iter(row_check("end", 2).cases(pr.COND_3_2)))
    assert not first.true
    assert "every order" in first.label
