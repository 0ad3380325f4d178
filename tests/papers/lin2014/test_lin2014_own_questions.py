"""Checks without a formula, sections 1, 2 (Bezier) and 5: each sees its object changed; none is a constant truth."""

from fractions import Fraction

import pytest
import sympy as sp

from helpers.sweeps import first_ones
from semispline.papers.ledger import question
from semispline.papers.ledger.mutation import mutants
from semispline.papers.ledger.records import Strength, Verdict
from semispline.papers.ledger.verification import decide
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import (
    bezier_division,
    curvature_pictures,
    hartmann,
    other_methods,
    printed_numbers,
)
from semispline.papers.lin2014.claims import section_1 as claims_1_introduction
from semispline.papers.lin2014.claims import section_2_bezier as claims_2_bezier
from semispline.papers.lin2014.claims import section_5 as claims_5_results

CLAIMS = {
    claim.id: claim for module in (claims_1_introduction, claims_2_bezier, claims_5_results) for claim in module.CLAIMS
}

MU_NU = dict(zip(sp.symbols("mu nu", positive=True), (1, 2), strict=True))


def truths(cases):
    return [case.true for case in cases]


def hartmann_of_order(n, t, rest):
    """A weight whose contact is one order lower."""
    return hartmann.hartmann_weight(n - 1, t, rest)


def exchanged(n, t, rest):
    return 1 - hartmann.hartmann_weight(n, t, rest)


def straight(_n, _t, rest):
    return rest


def overshooting(n, t, rest):
    """1 and 0 at the ends, more than 1 between them."""
    return rest ** (n + 1) * (1 + 9 * t)


def rooted(_n, t, rest):
    return sp.sqrt(rest) / (sp.sqrt(rest) + sp.sqrt(t))


def test_hartmann_as_it_is():
    assert all(truths(hartmann.hull_cases()))
    assert all(truths(hartmann.hartmann_contact_cases()))
    for end, formula in enumerate(hartmann.DIRECTION):
        assert truths(hartmann.direction_cases(end)(formula)) == [True]
    assert truths(hartmann.hartmann_rational_cases()) == [False]
    assert truths(hartmann.turning_cases()) == [True, True, False]


@pytest.mark.parametrize("weight", [exchanged, overshooting])
def test_a_weight_that_leaves_the_hull_is_seen(weight):
    assert not all(truths(hartmann.hull_cases(weight)))


@pytest.mark.parametrize("weight", [hartmann_of_order, exchanged, straight, rooted])
def test_a_weight_without_contact_of_order_n_is_seen(weight):
    assert not all(truths(hartmann.hartmann_contact_cases(weight)))


@pytest.mark.parametrize("weight", [exchanged, straight, rooted])
@pytest.mark.parametrize("end", [0, 1])
def test_a_weight_that_turns_the_blend_is_seen(weight, end):
    assert not all(truths(hartmann.direction_cases(end, weight)(hartmann.DIRECTION[end])))


def test_the_direction_is_that_of_its_own_piece():
    first, second = hartmann.DIRECTION
    assert truths(hartmann.direction_cases(0)(second)) == [False]
    assert truths(hartmann.direction_cases(1)(first)) == [False]


def test_a_weight_with_roots_has_no_rational_form():
    assert truths(hartmann.hartmann_rational_cases(rooted)) == [True]


@pytest.mark.long
def test_hartmann_at_numbers():
    """n = 1 and 2, mu = 1/3, pieces t^2 + 1 and sin t: derivatives of the blend itself at both ends."""
    t = sp.Symbol("t")
    for n in (1, 2):
        f = hartmann.hartmann_weight(n, t, 1 - t).subs(MU_NU)
        blend = f * (t**2 + 1) + (1 - f) * sp.sin(t)
        for end, piece in ((0, t**2 + 1), (1, sp.sin(t))):
            difference = [sp.simplify((blend - piece).diff(t, d).subs(t, end)) for d in range(1, n + 2)]
            assert difference[:-1] == [0] * n
            assert difference[-1] != 0


def test_the_hull_turns_a_blend_around_an_edge_only():
    (where,) = dict(hartmann.inference_counterexample().values).values()
    assert "coplanar strips" in where
    # A base on the other side of the plane, a strip that ends before X does, one that is not coplanar.
    assert truths(hartmann.turning_cases(rounding=((-1, 0), (0, 0), (2, 1)))) == [True, False, False]
    assert truths(hartmann.turning_cases(facing=((-1, 0), (sp.Rational(1, 2), 0)))) == [True, True, True]
    assert truths(hartmann.turning_cases(facing=hartmann.ROUNDING)) == [True, True, True]


def test_pieces_around_an_edge_run_back_and_a_forward_start_leaves_the_hull():
    """At numbers: X of pieces of both bases; and (s, 0) against the hull's edge x = y, by solving for its weights."""
    t = sp.Symbol("t")
    f = hartmann.hartmann_weight(1, t, 1 - t).subs(MU_NU)
    x = f * -t + (1 - f)
    assert sp.simplify(sp.diff(x, t).subs(t, 0)) == -1
    corners = sp.Matrix([*hartmann.ROUNDING]).T.col_join(sp.ones(1, 4))
    a, b, c, d = sp.symbols("a b c d")
    (weights,) = sp.linsolve((corners, sp.Matrix([sp.Rational(1, 10), 0, 1])), (a, b, c, d))
    # y = c + 2 d = 0 asks for c = d = 0, and then x = -a is not positive.
    assert sp.expand(weights[2] + 2 * weights[3]) == 0
    assert weights[0].subs({c: 0, d: 0}) < 0


def test_mean_curvature_must_see_the_normal_part():
    E, F, G, L, M, N = sp.symbols("E F G L M N", real=True)
    assert all(truths(curvature_pictures.mean_curvature_cases()))
    for wrong in ((E * N - 2 * F * M) / (2 * (E * G - F**2)), (E * N + F * L) / (2 * (E * G - F**2)), L**2):
        assert not all(truths(curvature_pictures.mean_curvature_cases(lambda wrong=wrong: wrong)))


def test_mean_curvature_of_graphs_is_that_of_the_coefficients():
    """Two formulas for H, at a paraboloid."""
    x, y = sp.symbols("x y", real=True)
    z = 2 * x**2 - 3 * x * y + y**2 + x
    surface = sp.Matrix([x, y, z])
    a, b = surface.diff(x), surface.diff(y)
    normal = curvature_pictures.unit_normal(z.diff(x), z.diff(y))
    assert sp.simplify(normal.dot(a)) == sp.simplify(normal.dot(b)) == 0
    E, F, G = a.dot(a), a.dot(b), b.dot(b)
    L, M, N = (surface.diff(*pair).dot(normal) for pair in ((x, x), (x, y), (y, y)))
    mean = (E * N - 2 * F * M + G * L) / (2 * (E * G - F**2))
    p, q = z.diff(x), z.diff(y)
    graph = ((1 + q**2) * 4 + 2 * p * q * 3 + (1 + p**2) * 2) / (2 * sp.sqrt(1 + p**2 + q**2) ** 3)
    assert sp.simplify((mean - graph).subs({x: Fraction(1, 3), y: 2})) == 0


@pytest.mark.long
def test_stripes_of_a_wrong_normal_are_seen():
    """A normal that does not turn with the surface, and one that is blind to the slope across."""
    assert all(truths(curvature_pictures.stripe_cases()))
    for wrong in (lambda p, q: sp.Matrix([0, 0, 1]), lambda p, q: sp.Matrix([0, -q, 1])):
        assert not all(truths(curvature_pictures.stripe_cases(wrong)))
        assert not all(truths(curvature_pictures.reflection_cases(wrong)))
        assert not any(truths(curvature_pictures.revealed_cases(wrong)))
    assert truths(curvature_pictures.revealed_cases()) == [True, True, False, False] * 2
    assert truths(curvature_pictures.reflection_cases()) == [True] * 4
    # Too long a normal has a derivative along itself.
    long = lambda p, q: sp.Matrix([-p, -q, 1])
    assert not all(truths(curvature_pictures.reflection_cases(long)))


def test_a_reflection_at_numbers():
    """On z = k x^2 / 2, eye (3/5, 0, 4/5): by hand (R . d)_x is -2 k (e_1 d_3 + e_3 d_1)."""
    x, k = sp.symbols("x k", real=True)
    normal = sp.Matrix([-k * x, 0, 1]) / sp.sqrt(1 + k**2 * x**2)
    eye = sp.Matrix([sp.Rational(3, 5), 0, sp.Rational(4, 5)])
    slope = (2 * normal.dot(eye) * normal - eye).diff(x).subs(x, 0)
    assert slope == sp.Matrix([-sp.Rational(8, 5) * k, 0, -sp.Rational(6, 5) * k])


def test_mean_curvature_without_its_sign_misses_a_jump():
    assert truths(curvature_pictures.unsigned_cases()) == [True, False]
    assert truths(curvature_pictures.unsigned_cases(lambda second: second + 3)) == [True, True]
    assert truths(curvature_pictures.unsigned_cases(lambda second: 1)) == [False, False]


def test_a_mean_curvature_that_does_not_see_the_jump_is_seen():
    assert truths(curvature_pictures.graph_mean_cases()) == [True]
    for wrong in (lambda second: 1, lambda second: curvature_pictures.graph_mean(0), lambda second: second**2):
        assert truths(curvature_pictures.graph_mean_cases(wrong)) == [False]


def test_what_no_picture_shows():
    assert truths(curvature_pictures.invisible_cases()) == [False, False]
    assert truths(curvature_pictures.bending_cases(saddle=False)()) == [True]
    assert truths(curvature_pictures.bending_cases(saddle=True)()) == [False]


def test_a_cubic_needs_its_two_inner_knots():
    assert all(truths(other_methods.cubic_cases()))
    assert not all(truths(other_methods.cubic_cases(inner=1)))
    assert not all(truths(other_methods.cubic_cases(degree=1, inner=4)))


def test_the_quartic_has_to_be_that_one():
    moved = ((0, 0), (sp.Rational(1, 2), 0), (sp.Rational(5, 3), sp.Rational(1, 2)), (2, sp.Rational(1, 2)), (2, 1))
    assert truths(other_methods.quartic_cases()) == [False]
    assert truths(other_methods.quartic_cases(moved)) == [True]


def test_another_jump_of_the_ball_is_seen():
    assert truths(other_methods.g2_cases()) == [True, False]
    for jump in (1 / other_methods.BALL_RADIUS + other_methods.BASE_CURVATURE, 1 / other_methods.BALL_RADIUS):
        assert truths(other_methods.g2_cases(jump)) != [True, False]


def test_a_blend_whose_rows_are_not_determined_has_no_form(monkeypatch):
    assert not any(truths(other_methods.bezier_conversion_cases()))
    monkeypatch.setattr(other_methods, "contained", lambda *_: False)
    assert all(truths(other_methods.bezier_conversion_cases()))


def test_an_exponential_is_no_sine(monkeypatch):
    """Were the second derivative of t^j not j (j - 1) t^(j-2), nothing would follow."""
    assert all(truths(other_methods.c_curve_cases()))
    assert all(truths(other_methods.sine_base_cases()))
    assert not all(truths(other_methods.sine_base_cases(lambda f, one, other: sp.exp(one) * f + other)))
    monkeypatch.setattr(other_methods.sp, "diff", lambda e, *_: e)
    assert not all(truths(other_methods.c_curve_cases()))


def test_knots_in_common_add_nothing():
    assert all(truths(printed_numbers.added_cases()))
    assert not all(truths(printed_numbers.added_cases(lambda a, b: 2 * sp.Min(a, b) - a - b)))
    assert not all(truths(printed_numbers.added_cases(lambda a, b: a + b)))


def test_equal_vectors_have_nothing_superfluous(monkeypatch):
    assert all(truths(printed_numbers.superfluous_cases()))
    monkeypatch.setattr(printed_numbers, "inner_knots", lambda key: [])
    assert not any(truths(printed_numbers.superfluous_cases()))


def test_equal_counts_are_seen(monkeypatch):
    assert all(truths(claims_1_introduction._different_counts()))
    monkeypatch.setattr(pr, "FIGURE_1_COUNTS", (5,) * 7)
    monkeypatch.setattr(pr, "KNOTS", dict.fromkeys(pr.KNOTS, (0, 1)))
    assert not any(truths(claims_1_introduction._different_counts()))


def test_a_hyperbola_has_polynomial_pieces_and_another_row_is_no_line():
    assert not any(truths(printed_numbers.circle_cases()))
    assert any(truths(printed_numbers.circle_cases(lambda x, y: x**2 - y**2)))
    assert truths(printed_numbers.extrusion_cases()) == [True]
    assert truths(printed_numbers.extrusion_cases([0, 0, 1, 1])) == [False]
    assert all(truths(printed_numbers.cone_patch_cases()))
    for wrong in (
        lambda w, v: (w * (1 - v), 2 * w * v, w * (1 + v**2)),
        lambda w, v: (w * (1 - v**4), 2 * w * v**2, w * (1 + v**4)),
        lambda w, v: (w, 0 * v, w),
    ):
        assert not all(truths(printed_numbers.cone_patch_cases(wrong)))


def test_a_wrong_weight_is_seen():
    assert truths(bezier_division.row_step_cases()) == [True]
    wrong = lambda low, at, k, b: sp.binomial(low, at) / sp.binomial(low + k, at + b)
    assert truths(bezier_division.row_step_cases(wrong)) == [False]


def test_orders_that_agree_are_seen(monkeypatch):
    assert not any(truths(bezier_division.same_order_cases(None)))
    monkeypatch.setattr(pr, "COUNT_BOTTOM", pr.Formula(sp.Eq(pr.F(0, pr.s), pr.m + 1), (pr.s, pr.m)))
    monkeypatch.setattr(bezier_division, "row_degrees", lambda m, n, k, part: (m,) * (n + 1))
    assert all(truths(bezier_division.same_order_cases(None)))


def test_a_lemma_that_does_not_hold_is_seen(monkeypatch):
    assert all(truths(bezier_division.lemma_cases(None)))
    monkeypatch.setattr(bezier_division, "division_lemmas", lambda: {"product": sp.Symbol("x")})
    assert truths(bezier_division.lemma_cases(None)) == [False]


@pytest.mark.parametrize(
    "name",
    first_ones(
        1, ["eq-4", "eq-5", "eq-6", "sec-2.q-formula", "sec-2.blossom-1", "sec-2.blossom-2", "sec-2.top-counts"]
    ),
)
def test_the_first_case_is_for_every_degree_and_tells_each_mutant(name):
    """Instances aside: what multiplies one control point decides alone."""
    for part in CLAIMS[name].parts:
        if part.formula is None:
            continue
        assert part.check.strength is Strength.GENERAL
        first = next(iter(part.check.cases(part.formula)))
        assert "every" in first.label
        assert first.true
        for mutant in mutants(part.formula):
            changed = pr.Formula(mutant.relation, part.formula.variables)
            if mutant.text not in part.formula.equivalent:
                assert not next(iter(part.check.cases(changed))).true, mutant.text


@pytest.mark.long
def test_each_figure_is_decided_with_both_kinds_of_conditions(whole):
    for name in ("fig-5.c2", "fig-6.g2", *(("fig-8.c2", "fig-9.c2", "fig-11.g2") if whole else ())):
        decision = decide(CLAIMS[name])
        assert decision.verdict is Verdict.AMBIGUOUS
        assert [(r.label, r.verdict) for r in decision.readings] == [
            ("with the conditions as they are printed", Verdict.HOLDS_IF),
            ("with both distances in (3.1) and (3.2) squared, if the scan lost that", Verdict.HOLDS_IF),
            ("with the corrected ones", Verdict.HOLDS),
        ]
        assert decision.counterexample
        assert decision.consequence.measured
        letter = "S_0" if name in ("fig-6.g2", "fig-11.g2") else "R_0"
        assert letter in decision.counterexample
    assert [r.verdict for r in decide(CLAIMS["fig-10.g2"]).readings] == [
        Verdict.HOLDS_IF,
        Verdict.HOLDS_IF,
        Verdict.HOLDS,
    ]


@pytest.mark.long
def test_the_readings_of_section_5_by_hand():
    validation, inference = (decide(CLAIMS[name]).readings for name in ("sec-5.validation", "fig-7.inference"))
    assert [r.verdict for r in validation] == [Verdict.HOLDS, Verdict.HOLDS_IF, Verdict.FAILS, Verdict.FAILS]
    assert [r.verdict for r in inference] == [Verdict.HOLDS, Verdict.HOLDS_IF]


def test_nothing_without_a_proof_is_called_one():
    """Instances count as proof where they are all there is: printed data, or one that disproves."""
    sampled = question(lambda: iter(()), "x")
    assert not sampled.proof
    for claim in CLAIMS.values():
        for part in claim.parts:
            if part.check.proof and part.check.strength is Strength.RATIONAL:
                assert claim.id.startswith(("fig-", "table-", "sec-5.", "sec-1.", "sec-2.q-range")), claim.id
