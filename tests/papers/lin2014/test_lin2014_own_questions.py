"""Checks without a formula, sections 1, 2 (Bezier) and 5: each sees its object changed; none is a constant truth."""

from fractions import Fraction

import pytest
import sympy as sp

from semispline.papers.ledger.mutation import mutants
from semispline.papers.ledger.records import Strength, Verdict
from semispline.papers.ledger.verification import decide
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import bezier as bezier_checks
from semispline.papers.lin2014.checks import figure as figure_checks
from semispline.papers.lin2014.checks import hartmann as hartmann_checks
from semispline.papers.lin2014.checks import picture as picture_checks
from semispline.papers.lin2014.checks import related as related_checks
from semispline.papers.lin2014.checks.property import question
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
    return hartmann_checks.hartmann_weight(n - 1, t, rest)


def exchanged(n, t, rest):
    return 1 - hartmann_checks.hartmann_weight(n, t, rest)


def straight(_n, _t, rest):
    return rest


def overshooting(n, t, rest):
    """1 and 0 at the ends, more than 1 between them."""
    return rest ** (n + 1) * (1 + 9 * t)


def rooted(_n, t, rest):
    return sp.sqrt(rest) / (sp.sqrt(rest) + sp.sqrt(t))


def test_hartmann_as_it_is():
    assert all(truths(hartmann_checks.hull_cases()))
    assert all(truths(hartmann_checks.hartmann_contact_cases()))
    for end, formula in enumerate(hartmann_checks.DIRECTION):
        assert truths(hartmann_checks.direction_cases(end)(formula)) == [True]
    assert truths(hartmann_checks.hartmann_rational_cases()) == [False]
    assert truths(hartmann_checks.turning_cases()) == [True, True, False]


@pytest.mark.parametrize("weight", [exchanged, overshooting])
def test_a_weight_that_leaves_the_hull_is_seen(weight):
    assert not all(truths(hartmann_checks.hull_cases(weight)))


@pytest.mark.parametrize("weight", [hartmann_of_order, exchanged, straight, rooted])
def test_a_weight_without_contact_of_order_n_is_seen(weight):
    assert not all(truths(hartmann_checks.hartmann_contact_cases(weight)))


@pytest.mark.parametrize("weight", [exchanged, straight, rooted])
@pytest.mark.parametrize("end", [0, 1])
def test_a_weight_that_turns_the_blend_is_seen(weight, end):
    assert not all(truths(hartmann_checks.direction_cases(end, weight)(hartmann_checks.DIRECTION[end])))


def test_the_direction_is_that_of_its_own_piece():
    first, second = hartmann_checks.DIRECTION
    assert truths(hartmann_checks.direction_cases(0)(second)) == [False]
    assert truths(hartmann_checks.direction_cases(1)(first)) == [False]


def test_a_weight_with_roots_has_no_rational_form():
    assert truths(hartmann_checks.hartmann_rational_cases(rooted)) == [True]


def test_hartmann_at_numbers():
    """n = 1 and 2, mu = 1/3, pieces t^2 + 1 and sin t: derivatives of the blend itself at both ends."""
    t = sp.Symbol("t")
    for n in (1, 2):
        f = hartmann_checks.hartmann_weight(n, t, 1 - t).subs(MU_NU)
        blend = f * (t**2 + 1) + (1 - f) * sp.sin(t)
        for end, piece in ((0, t**2 + 1), (1, sp.sin(t))):
            difference = [sp.simplify((blend - piece).diff(t, d).subs(t, end)) for d in range(1, n + 2)]
            assert difference[:-1] == [0] * n
            assert difference[-1] != 0


def test_the_hull_turns_a_blend_around_an_edge_only():
    (where,) = dict(hartmann_checks.inference_counterexample().values).values()
    assert "coplanar strips" in where
    # A base on the other side of the plane, a strip that ends before X does, one that is not coplanar.
    assert truths(hartmann_checks.turning_cases(rounding=((-1, 0), (0, 0), (2, 1)))) == [True, False, False]
    assert truths(hartmann_checks.turning_cases(facing=((-1, 0), (sp.Rational(1, 2), 0)))) == [True, True, True]
    assert truths(hartmann_checks.turning_cases(facing=hartmann_checks.ROUNDING)) == [True, True, True]


def test_pieces_around_an_edge_run_back_and_a_forward_start_leaves_the_hull():
    """At numbers: X of pieces of both bases; and (s, 0) against the hull's edge x = y, by solving for its weights."""
    t = sp.Symbol("t")
    f = hartmann_checks.hartmann_weight(1, t, 1 - t).subs(MU_NU)
    x = f * -t + (1 - f)
    assert sp.simplify(sp.diff(x, t).subs(t, 0)) == -1
    corners = sp.Matrix([*hartmann_checks.ROUNDING]).T.col_join(sp.ones(1, 4))
    a, b, c, d = sp.symbols("a b c d")
    (weights,) = sp.linsolve((corners, sp.Matrix([sp.Rational(1, 10), 0, 1])), (a, b, c, d))
    # y = c + 2 d = 0 asks for c = d = 0, and then x = -a is not positive.
    assert sp.expand(weights[2] + 2 * weights[3]) == 0
    assert weights[0].subs({c: 0, d: 0}) < 0


def test_mean_curvature_must_see_the_normal_part():
    E, F, G, L, M, N = sp.symbols("E F G L M N", real=True)
    assert all(truths(picture_checks.mean_curvature_cases()))
    for wrong in ((E * N - 2 * F * M) / (2 * (E * G - F**2)), (E * N + F * L) / (2 * (E * G - F**2)), L**2):
        assert not all(truths(picture_checks.mean_curvature_cases(lambda wrong=wrong: wrong)))


def test_mean_curvature_of_graphs_is_that_of_the_coefficients():
    """Two formulas for H, at a paraboloid."""
    x, y = sp.symbols("x y", real=True)
    z = 2 * x**2 - 3 * x * y + y**2 + x
    surface = sp.Matrix([x, y, z])
    a, b = surface.diff(x), surface.diff(y)
    normal = picture_checks.unit_normal(z.diff(x), z.diff(y))
    assert sp.simplify(normal.dot(a)) == sp.simplify(normal.dot(b)) == 0
    E, F, G = a.dot(a), a.dot(b), b.dot(b)
    L, M, N = (surface.diff(*pair).dot(normal) for pair in ((x, x), (x, y), (y, y)))
    mean = (E * N - 2 * F * M + G * L) / (2 * (E * G - F**2))
    p, q = z.diff(x), z.diff(y)
    graph = ((1 + q**2) * 4 + 2 * p * q * 3 + (1 + p**2) * 2) / (2 * sp.sqrt(1 + p**2 + q**2) ** 3)
    assert sp.simplify((mean - graph).subs({x: Fraction(1, 3), y: 2})) == 0


def test_stripes_of_a_wrong_normal_are_seen():
    """A normal that does not turn with the surface, and one that is blind to the slope across."""
    assert all(truths(picture_checks.stripe_cases()))
    for wrong in (lambda p, q: sp.Matrix([0, 0, 1]), lambda p, q: sp.Matrix([0, -q, 1])):
        assert not all(truths(picture_checks.stripe_cases(wrong)))
        assert not all(truths(picture_checks.reflection_cases(wrong)))
        assert not any(truths(picture_checks.revealed_cases(wrong)))
    assert truths(picture_checks.revealed_cases()) == [True, True, False, False] * 2
    assert truths(picture_checks.reflection_cases()) == [True] * 4
    # Too long a normal has a derivative along itself.
    long = lambda p, q: sp.Matrix([-p, -q, 1])
    assert not all(truths(picture_checks.reflection_cases(long)))


def test_a_reflection_at_numbers():
    """On z = k x^2 / 2, eye (3/5, 0, 4/5): by hand (R . d)_x is -2 k (e_1 d_3 + e_3 d_1)."""
    x, k = sp.symbols("x k", real=True)
    normal = sp.Matrix([-k * x, 0, 1]) / sp.sqrt(1 + k**2 * x**2)
    eye = sp.Matrix([sp.Rational(3, 5), 0, sp.Rational(4, 5)])
    slope = (2 * normal.dot(eye) * normal - eye).diff(x).subs(x, 0)
    assert slope == sp.Matrix([-sp.Rational(8, 5) * k, 0, -sp.Rational(6, 5) * k])


def test_mean_curvature_without_its_sign_misses_a_jump():
    assert truths(picture_checks.unsigned_cases()) == [True, False]
    assert truths(picture_checks.unsigned_cases(lambda second: second + 3)) == [True, True]
    assert truths(picture_checks.unsigned_cases(lambda second: 1)) == [False, False]


def test_a_mean_curvature_that_does_not_see_the_jump_is_seen():
    assert truths(picture_checks.graph_mean_cases()) == [True]
    for wrong in (lambda second: 1, lambda second: picture_checks.graph_mean(0), lambda second: second**2):
        assert truths(picture_checks.graph_mean_cases(wrong)) == [False]


def test_what_no_picture_shows():
    assert truths(picture_checks.invisible_cases()) == [False, False]
    assert truths(picture_checks.bending_cases(saddle=False)()) == [True]
    assert truths(picture_checks.bending_cases(saddle=True)()) == [False]


def test_a_cubic_needs_its_two_inner_knots():
    assert all(truths(related_checks.cubic_cases()))
    assert not all(truths(related_checks.cubic_cases(inner=1)))
    assert not all(truths(related_checks.cubic_cases(degree=1, inner=4)))


def test_the_quartic_has_to_be_that_one():
    moved = ((0, 0), (sp.Rational(1, 2), 0), (sp.Rational(5, 3), sp.Rational(1, 2)), (2, sp.Rational(1, 2)), (2, 1))
    assert truths(related_checks.quartic_cases()) == [False]
    assert truths(related_checks.quartic_cases(moved)) == [True]


def test_another_jump_of_the_ball_is_seen():
    assert truths(related_checks.g2_cases()) == [True, False]
    for jump in (1 / related_checks.BALL_RADIUS + related_checks.BASE_CURVATURE, 1 / related_checks.BALL_RADIUS):
        assert truths(related_checks.g2_cases(jump)) != [True, False]


def test_a_blend_whose_rows_are_not_determined_has_no_form(monkeypatch):
    assert not any(truths(related_checks.bezier_conversion_cases()))
    monkeypatch.setattr(related_checks, "contained", lambda *_: False)
    assert all(truths(related_checks.bezier_conversion_cases()))


def test_an_exponential_is_no_sine(monkeypatch):
    """Were the second derivative of t^j not j (j - 1) t^(j-2), nothing would follow."""
    assert all(truths(related_checks.c_curve_cases()))
    assert all(truths(related_checks.sine_base_cases()))
    assert not all(truths(related_checks.sine_base_cases(lambda f, one, other: sp.exp(one) * f + other)))
    monkeypatch.setattr(related_checks.sp, "diff", lambda e, *_: e)
    assert not all(truths(related_checks.c_curve_cases()))


def test_knots_in_common_add_nothing():
    assert all(truths(figure_checks.added_cases()))
    assert not all(truths(figure_checks.added_cases(lambda a, b: 2 * sp.Min(a, b) - a - b)))
    assert not all(truths(figure_checks.added_cases(lambda a, b: a + b)))


def test_equal_vectors_have_nothing_superfluous(monkeypatch):
    assert all(truths(figure_checks.superfluous_cases()))
    monkeypatch.setattr(figure_checks, "inner_knots", lambda key: [])
    assert not any(truths(figure_checks.superfluous_cases()))


def test_equal_counts_are_seen(monkeypatch):
    assert all(truths(claims_1_introduction._different_counts()))
    monkeypatch.setattr(pr, "FIGURE_1_COUNTS", (5,) * 7)
    monkeypatch.setattr(pr, "KNOTS", dict.fromkeys(pr.KNOTS, (0, 1)))
    assert not any(truths(claims_1_introduction._different_counts()))


def test_a_hyperbola_has_polynomial_pieces_and_another_row_is_no_line():
    assert not any(truths(figure_checks.circle_cases()))
    assert any(truths(figure_checks.circle_cases(lambda x, y: x**2 - y**2)))
    assert truths(figure_checks.extrusion_cases()) == [True]
    assert truths(figure_checks.extrusion_cases([0, 0, 1, 1])) == [False]
    assert all(truths(figure_checks.cone_patch_cases()))
    for wrong in (
        lambda w, v: (w * (1 - v), 2 * w * v, w * (1 + v**2)),
        lambda w, v: (w * (1 - v**4), 2 * w * v**2, w * (1 + v**4)),
        lambda w, v: (w, 0 * v, w),
    ):
        assert not all(truths(figure_checks.cone_patch_cases(wrong)))


def test_polynomials_that_are_not_bernsteins_are_seen():
    right = bezier_checks.polynomial
    assert all(truths(bezier_checks.triangle_cases()))
    for wrong in (
        lambda i, n, x, rest: x**i * rest ** (n - i),
        lambda i, n, x, rest: right(i, n, rest, x),
        lambda i, n, x, rest: 2 * right(i, n, x, rest),
    ):
        assert not all(truths(bezier_checks.triangle_cases(wrong)))


def test_a_wrong_weight_or_share_is_seen():
    assert truths(bezier_checks.row_step_cases()) == [True]
    wrong = lambda low, at, k, b: sp.binomial(low, at) / sp.binomial(low + k, at + b)
    assert truths(bezier_checks.row_step_cases(wrong)) == [False]
    assert truths(bezier_checks.elevation_cases()) == [True]
    assert truths(bezier_checks.elevation_cases(lambda r, d: (r + 1) / (d + 2))) == [False]


def test_orders_that_agree_are_seen(monkeypatch):
    assert not any(truths(bezier_checks.same_order_cases(None)))
    monkeypatch.setattr(pr, "COUNT_BOTTOM", pr.Formula(sp.Eq(pr.F(0, pr.s), pr.m + 1), (pr.s, pr.m)))
    monkeypatch.setattr(bezier_checks, "row_degrees", lambda m, n, k, part: (m,) * (n + 1))
    assert all(truths(bezier_checks.same_order_cases(None)))


def test_a_lemma_that_does_not_hold_is_seen(monkeypatch):
    assert all(truths(bezier_checks.lemma_cases(None)))
    monkeypatch.setattr(bezier_checks, "division_lemmas", lambda: {"product": sp.Symbol("x")})
    assert truths(bezier_checks.lemma_cases(None)) == [False]


@pytest.mark.parametrize(
    "name", ["eq-4", "eq-5", "eq-6", "sec-2.q-formula", "sec-2.blossom-1", "sec-2.blossom-2", "sec-2.top-counts"]
)
def test_the_first_case_is_for_every_degree_and_tells_each_mutant(name):
    """Instances aside: what multiplies one control point decides alone."""
    for part in CLAIMS[name].parts:
        if part.formula is None:
            continue
        assert part.check.strength is Strength.SYMBOLIC_ORDER
        first = next(iter(part.check.cases(part.formula)))
        assert "every" in first.label
        assert first.true
        for mutant in mutants(part.formula):
            changed = pr.Formula(mutant.relation, part.formula.variables)
            if mutant.text not in part.formula.equivalent:
                assert not next(iter(part.check.cases(changed))).true, mutant.text


def test_each_figure_is_decided_with_both_kinds_of_conditions():
    for name in ("fig-5.c2", "fig-6.g2", "fig-8.c2", "fig-9.c2", "fig-11.g2"):
        decision = decide(CLAIMS[name])
        assert decision.verdict is Verdict.AMBIGUOUS
        # With squares equal spans give G2, and not C2.
        squared = Verdict.HOLDS_IF if name.endswith(".g2") else Verdict.FAILS
        assert [(r.label, r.verdict) for r in decision.readings] == [
            ("with the conditions as they are printed", Verdict.FAILS),
            ("with both distances in (3.1) and (3.2) squared, if the scan lost that", squared),
            ("with the corrected ones", Verdict.HOLDS),
        ]
        assert decision.counterexample
        assert decision.consequence.measured
        letter = "S_0" if name in ("fig-6.g2", "fig-11.g2") else "R_0"
        assert letter in decision.counterexample
    straight = decide(CLAIMS["fig-10.g2"])
    assert straight.verdict is Verdict.AMBIGUOUS
    assert [r.verdict for r in straight.readings] == [Verdict.HOLDS_IF, Verdict.HOLDS]
    assert straight.readings[0].false_case.endswith("base curved across")


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
