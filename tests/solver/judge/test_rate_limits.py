"""The limits of G3 and G4, from both sides; what rounding is allowed on top, and where it hides the answer."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.bases import moved, patch
from helpers.high_order import SIZES, facing, hand_made, inwards
from helpers.sweeps import first_ones
from semispline import Base, BSplineSurface, InputError, measure_contact
from semispline.solver.judge import doubtful, required_limits, shortfalls, untold
from semispline.solver.splines.operations import split_u

K1, K4 = [0, 0, 1, 1], [0, 0, 0, 0, 0, 1, 1, 1, 1, 1]
RATES = ("rate_jump_relative", "second_rate_jump_relative")
BOTH_SIDES = [(0.5, True), (0.97, True), (1.3, False), (2.0, False)]


def graph(curvature, rate, quartic, bend=1.0):
    """X = (bend u, v, f(bend u)) with f'' = curvature, f''' = rate, f'''' = quartic at u = 0."""
    terms = bend**2 * curvature / 2, bend**3 * rate / 6, bend**4 * quartic / 24
    heights = 0, 0, terms[0] / 6, terms[0] / 2 + terms[1] / 4, sum(terms)
    net = [[[bend * i / 4, y, z] for y in (0.0, 1.0)] for i, z in enumerate(heights)]
    return BSplineSurface(4, 1, K4, K1, net)


def joined(of_a, of_b):
    return measure_contact(Base(graph(*of_a, bend=-1.0), "u0"), Base(graph(*of_b), "u0"), order=4)


def meets(contact, continuity):
    return not shortfalls(contact, continuity)


# The model is 2 long; f'''' less 3 f''^3 is the second rate. What is divided by: the largest rate itself, the square or
# the cube of the curvature, 1e-3 over the square or the cube of the size.
@pytest.mark.parametrize(
    ("curvature", "rate", "scale"), [(0.5, 4.0, 4.0), (2.0, 0.0, 4.0), (0.0, 0.0, 2.5e-4), (0.1, -0.5, 0.5)]
)
@pytest.mark.parametrize(("times", "expected"), BOTH_SIDES)
def test_the_limit_of_the_rate(curvature, rate, scale, times, expected):
    contact = joined((curvature, rate, 0.0), (curvature, rate + times * 1e-8 * scale, 0.0))
    assert contact.rate_jump_relative == pytest.approx(times * 1e-8, rel=1e-4)
    assert meets(contact, "G2")
    assert meets(contact, "G3") is expected


@pytest.mark.parametrize(
    ("curvature", "second", "scale"), [(0.5, 4.0, 4.0), (2.0, 0.0, 8.0), (0.0, 0.0, 1.25e-4), (0.1, -0.5, 0.5)]
)
@pytest.mark.parametrize(("times", "expected"), BOTH_SIDES)
def test_the_limit_of_the_second_rate(curvature, second, scale, times, expected):
    quartic = second + 3 * curvature**3
    contact = joined(
        (curvature, 0.1 * curvature, quartic), (curvature, 0.1 * curvature, quartic + times * 1e-7 * scale)
    )
    assert contact.second_rate_jump_relative == pytest.approx(times * 1e-7, rel=1e-4)
    assert meets(contact, "G3")
    assert meets(contact, "G4") is expected


@pytest.mark.parametrize("order", [3, 4])
@pytest.mark.parametrize("seed", range(4))
def test_blends_of_that_order_meet_it_and_their_limits_are_far_from_rounding(order, seed):
    rng = np.random.default_rng(seed)
    a, b, p_a, p_b = facing(rng, order, tuple(rng.choice(["u0", "u1", "v0", "v1"], 2)))
    for size in SIZES[order]:
        made = hand_made(a, b, order, p_a=p_a, p_b=p_b, size=size)
        for pair in ((a, Base(made, "u0")), (Base(made, "u1"), b)):
            contact = measure_contact(*pair, flip="no", order=order)
            assert meets(contact, f"G{order}")
            assert not doubtful(contact, f"G{order}")
            # A hundredth of the limit at most, and rounding a tenth of it.
            assert contact.rate_jump_relative < 1e-10
            assert contact.rounding["rate_jump_relative"] < 1e-9 * 2
            if order == 4:
                assert contact.second_rate_jump_relative < 1e-9
                assert contact.rounding["second_rate_jump_relative"] < 1e-8 * 2


def cross_direction(base, s):
    """w-derivatives of order 2..4 along the normal over the powers of the speed across, as the library evaluates."""
    surface = inwards(base)
    w = np.full_like(s, surface.domain[0][0])
    x_w, x_s = surface.evaluate(w, s, 1, 0), surface.evaluate(w, s, 0, 1)
    t = x_s / np.linalg.norm(x_s, axis=1)[:, None]
    normal = np.cross(x_w, x_s)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    speed = np.linalg.norm(x_w - np.sum(x_w * t, axis=1)[:, None] * t, axis=1)
    return {k: np.sum(surface.evaluate(w, s, k, 0) * normal, axis=1) / speed**k for k in (2, 3, 4)}


@pytest.mark.parametrize(("order", "limit"), [(3, 1e-8), (4, 1e-7)])
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("times", "expected"), BOTH_SIDES)
def test_blends_whose_last_derivative_is_a_little_wrong(order, limit, seed, times, expected):
    """p1^n R_w..w in D_n too large by a fraction: the jump is that fraction of R_w..w . N / speed^n, whatever p is."""
    a, b, p_a, p_b = facing(np.random.default_rng(seed), order)
    name = RATES[order - 3]

    def contact_with(fraction):
        made = hand_made(a, b, order, p_a=p_a, p_b=p_b, faults={(order, order): 1 + fraction})
        return measure_contact(a, Base(made, "u0"), flip="no", order=order)

    coarse = contact_with(1e-2)
    absolute = name.removesuffix("_relative")
    place = getattr(coarse, name.replace("jump_relative", "at")).parameter
    expected_jump = 1e-2 * abs(cross_direction(a, np.array([place]))[order][0])
    assert getattr(coarse, absolute) == pytest.approx(expected_jump, rel=1e-9)
    fraction = 1e-2 * times * limit / getattr(coarse, name)
    contact = contact_with(fraction)
    assert getattr(contact, name) == pytest.approx(times * limit, rel=1e-2)
    assert meets(contact, f"G{order - 1}")
    assert meets(contact, f"G{order}") is expected


# (k, j): the factor of R_j in D_k. What is of order n times R_w is no error of order n: it is tangential.
CONTROLS = [
    (3, (3, 3), "G2"),
    (3, (3, 2), "G2"),
    (3, (2, 1), "G2"),
    (3, (2, 2), "G1"),
    (3, (3, 1), "G3"),
    (4, (3, 3), "G2"),
    (4, (3, 1), "G3"),
    (4, (4, 4), "G3"),
    (4, (4, 3), "G3"),
    (4, (4, 2), "G3"),
    (4, (4, 1), "G4"),
]


@pytest.mark.parametrize(("order", "place", "reached"), CONTROLS)
def test_one_wrong_term_of_the_chain_rule(order, place, reached):
    a, b, p_a, p_b = facing(np.random.default_rng(7), order)
    made = hand_made(a, b, order, p_a=p_a, p_b=p_b, faults={place: 1.01})
    contact = measure_contact(a, Base(made, "u0"), flip="no", order=4)
    meeting = [name for name in ("G0", "G1", "G2", "G3", "G4") if meets(contact, name)]
    # An order more than was made is never reached by chance.
    assert meeting[-1] == reached


def test_a_cubic_blend_of_cubics_is_g3_at_its_seam_by_no_merit():
    # Neither side has fourth derivatives across: G4 there, while the first inner knot of the blend has G2 only.
    rng = np.random.default_rng(0)
    a = Base(patch(rng, degrees=(3, 3), counts=(5, 6)), "u0")
    b = Base(moved(patch(rng, degrees=(3, 3), counts=(5, 6)), np.diag([-1.0, 1, 1]), (-1.0, 0, 0)), "u0")
    made = hand_made(a, b, 3, p_a=[-1.0, 0, 0], p_b=[-1.0, 0, 0], size=(3, 4))
    assert meets(measure_contact(a, Base(made, "u0"), flip="no", order=4), "G4")
    before, after = split_u(made, 0.2)
    inside = measure_contact(Base(before, "u1"), Base(after, "u0"), flip="no", order=4)
    assert meets(inside, "G2")
    assert inside.rate_jump_relative > 0.1


@pytest.mark.parametrize("rational", first_ones(1, [False, True]))
def test_what_rounding_does_is_allowed_and_not_a_thousand_times_more(rational):
    # A smooth surface cut in two, near the origin or far away: the parts meet but for their control points' rounding.
    worst = dict.fromkeys(RATES, 0.0)
    for seed in range(60):
        rng = np.random.default_rng(seed)
        whole = patch(rng, degrees=(int(rng.integers(3, 6)), 3), counts=(6, 6))
        whole = moved(whole, offset=10 ** rng.uniform(0, 5) * rng.uniform(0.3, 1, 3))
        if rational:
            weights = rng.uniform(0.5, 2, (6, 6))
            whole = BSplineSurface(whole.degree_u, 3, whole.knots_u, whole.knots_v, whole.control_points, weights)
        # Within a span, where the surface is smooth.
        breaks = whole.breakpoints[0]
        at = int(np.diff(breaks).argmax())
        parts = split_u(whole, breaks[at] + 0.4 * (breaks[at + 1] - breaks[at]))
        contact = measure_contact(Base(parts[0], "u1"), Base(parts[1], "u0"), flip="no", order=4)
        for name in RATES:
            part = getattr(contact, name) / contact.rounding[name]
            assert part <= 1
            worst[name] = max(worst[name], part)
    assert min(worst.values()) > 1e-3, worst


def test_rounding_of_rates_by_hand():
    # A plane from x = 0 to 1 whose parameters run evenly: nothing is sheared or bent, and of all derivatives but the
    # first ones only errors are left: those across of order 3 and 4 over their speed, 1.
    net = [[[i / 4, y, 0.0] for y in (0.0, 1.0)] for i in range(5)]
    b = Base(BSplineSurface(4, 1, K4, K1, net), "u0")
    a = Base(moved(b.surface, np.diag([-1.0, 1, 1])), "u0")
    found = measure_contact(a, b, flip="no", order=4).rounding
    # The farthest corner is (1, 1, 0); the model is 2 long.
    one = 2 * (8 + 2**0.5 / 2) * 2.0**-52
    assert found["rate_jump_relative"] == pytest.approx(one * 8 * 6 * 4 / (1e-3 / 4), rel=1e-12)
    assert found["second_rate_jump_relative"] == pytest.approx(one * 8 * 6 * 4 * 2 / (1e-3 / 8), rel=1e-12)


@pytest.mark.parametrize("name", RATES)
@pytest.mark.parametrize(
    ("rounding", "warned", "refused"),
    [(0.95e-4, False, False), (1.05e-4, True, False), (0.95e-3, True, False), (1.05e-3, False, True)],
)
def test_ceilings_of_rounding(name, rounding, warned, refused):
    sound = joined((1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
    contact = replace(sound, rounding=dict.fromkeys(sound.rounding, 0.0) | {name: rounding})
    for continuity in ("C0", "C1", "C2", "G0", "G1", "G2", "G3", "G4"):
        needed = name in [measure for measure, _, _ in required_limits(contact, continuity)]
        assert needed is (continuity == "G4" or (continuity == "G3" and name == RATES[0]))
        assert bool(doubtful(contact, continuity)) is (warned and needed)
        assert bool(untold(contact, continuity)) is (refused and needed)


def test_from_near_to_far_known_warned_and_hidden():
    """A blend with a third derivative 5 % wrong, carried away: "no" until rounding hides it, never "yes"."""
    a, b, p_a, p_b = facing(np.random.default_rng(1), 3)
    made = hand_made(a, b, 3, p_a=p_a, p_b=p_b, faults={(3, 3): 1.05}).to_bspline()
    answers = []
    for exponent in range(2, 13):
        offset = 10.0**exponent * np.array([1.0, -0.7, 0.4])
        pair = [Base(moved(s, offset=offset), "u0") for s in (a.surface, made)]
        contact = measure_contact(*pair, flip="no", order=4)
        short = shortfalls(contact, "G3")
        answers.append("no" if short else "untold" if untold(contact, "G3") else "yes")
    assert "yes" not in answers
    assert answers[:4] == ["no"] * 4
    assert answers[-1] == "untold"


def test_orders_count_only_where_all_lower_ones_hold():
    contact = joined((1.0, 2.0, 3.0), (1.1, 2.5, 4.0))
    assert [name for name, _, _ in shortfalls(contact, "G4")] == ["curvature_jump_relative"]
    contact = joined((1.0, 2.0, 3.0), (1.0, 2.5, 4.0))
    assert [name for name, _, _ in shortfalls(contact, "G4")] == ["rate_jump_relative"]
    # A second rate that agrees does not help a rate that does not.
    contact = joined((1.0, 2.0, 3.0), (1.0, 2.5, 3.0))
    assert contact.second_rate_jump_relative < 1e-7
    assert not meets(contact, "G4")


@pytest.mark.parametrize(("order", "continuity"), [(2, "G3"), (2, "G4"), (3, "G4")])
def test_a_contact_that_was_not_measured_so_far_gives_no_answer(order, continuity):
    surface = graph(1.0, 1.0, 1.0)
    contact = measure_contact(Base(surface, "u0"), Base(graph(1.0, 1.0, 1.0, bend=-1.0), "u0"), order=order)
    for ask in (required_limits, shortfalls, untold, doubtful):
        with pytest.raises(InputError, match=f"expected order={continuity[1]} for {continuity}"):
            ask(contact, continuity)
