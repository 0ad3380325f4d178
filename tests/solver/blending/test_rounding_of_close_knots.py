"""Knots that nearly agree: refused by name, or blended; and an energy that rounding makes is said, not proved."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from helpers.bases import tube, turned
from helpers.papers_set import blend
from helpers.sweeps import examples, first_ones
from semispline import (
    Base,
    BSplineCurve,
    BSplineSurface,
    ComputationError,
    EdgeError,
    FoldError,
    OptionError,
    SemisplineError,
    SemiStructuredSurface,
    insert_knots,
    read_surface,
)
from semispline.solver.blending.gram import EnergyForm, gram_matrix
from semispline.solver.blending.smooth_rows import without_close_knots
from semispline.solver.judge.creases import measure_creases
from semispline.solver.splines import Basis, clamped, greville, uniform_knots
from semispline.solver.splines.refinement import elevated_knots

CASES = Path(__file__).parents[2] / "cases"
LINE = [0.0, 0.0, 1.0, 1.0]
# Floor and wall below, G2, one middle curve: x'' and z'' are piecewise linear over four equal spans and 0 at both
# ends, with one moment given each, so that each has the energy 1 / (c' M^-1 c), c = (1, 2, 3) / 16 and M the Gram
# matrix of three hats: by hand 448/117.
KNOWN = 896 / 117


def strip(degree, inner, x=(0.0, 1.0), z=(0.0, 0.0), y=(0.0, 1.0)):
    """A flat strip along y, whose control points are where a straight line has them."""
    knots = clamped(inner, degree, *y)
    along = greville(knots, degree)
    net = [
        np.stack([np.full_like(along, px), along, np.full_like(along, pz)], axis=1) for px, pz in zip(x, z, strict=True)
    ]
    return BSplineSurface(1, degree, LINE, knots, net)


WALL = Base(strip(1, [], (2, 2), (1, 2)), "u0")


def floor(degree, inner):
    return Base(strip(degree, inner), "u1")


@pytest.mark.parametrize("continuity", ["C0", "C1", "C2", "G0", "G1", "G2"])
def test_the_case_that_crashed_is_refused_by_name(continuity):
    a, b = read_surface(CASES / "crash_near_equal_knots_1_1e-13.json"), read_surface(CASES / "wall.json")
    said = r"base a: knots_v: 4 knots from 0\.5 to 0\.5000000000003 .* count as one, expected at most 1 for degree 1"
    with pytest.raises(EdgeError, match=said):
        blend(Base(a, "u1"), Base(b, "u0"), continuity=continuity)
    with pytest.raises(EdgeError, match="base b: knots_v: 4 knots"):
        blend(Base(b, "u0"), Base(a, "u1"), continuity=continuity)


@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_as_many_as_the_degree_are_blended_and_one_more_is_refused(degree):
    near = 0.5 + 1e-13 * np.arange(degree + 1)
    result = blend(floor(degree, near[:-1]), WALL, continuity="G2")
    assert result.energy == pytest.approx(KNOWN, rel=1e-12)
    assert not result.warnings
    with pytest.raises(EdgeError, match=f"{degree + 1} knots from 0.5 .* at most {degree} for degree {degree}"):
        blend(floor(degree, near), WALL, continuity="G2")


def test_the_tolerance_is_1e_12_of_the_domain_from_both_sides():
    for end in (1.0, 400.0):
        for step, refused in ((0.9e-12, True), (1.1e-12, False)):
            base = Base(strip(1, end * (0.5 + step * np.arange(2)), y=(0.0, end)), "u1")
            wall = Base(strip(1, [], (2, 2), (1, 2), (0.0, end)), "u0")
            if refused:
                with pytest.raises(EdgeError, match="count as one"):
                    blend(base, wall)
            else:
                assert blend(base, wall).contact_a.gap < 1e-12 * end


@pytest.mark.parametrize(("knot", "said"), [(1e-13, "from 0.0 to 1e-13"), (1 - 1e-13, "to 1.0")])
def test_a_knot_at_an_end_of_the_domain_is_refused(knot, said):
    with pytest.raises(EdgeError, match=rf"5 knots .*{said}.*at most 4 for degree 3 at an end"):
        blend(floor(3, [knot]), WALL)


def test_given_knots_that_nearly_agree_are_refused():
    near = 0.5 + 1e-13 * np.arange(4)
    with pytest.raises(OptionError, match=r"middle_knots\[0\]: 2 knots"):
        blend(floor(1, []), WALL, middle_knots=[near[:2]])
    with pytest.raises(OptionError, match="u_knots: 4 knots"):
        blend(floor(1, []), WALL, u_knots=near, middle_curves=2)


def test_near_knots_of_both_bases_do_not_add_up():
    # Two of degree 2 on each side, all within the tolerance: one break for the integrals, full multiplicity on each.
    a, b = strip(2, [0.5, 0.5 + 2e-13]), strip(2, [0.5 + 1e-13, 0.5 + 3e-13], (2, 2), (1, 2))
    assert blend(Base(a, "u1"), Base(b, "u0")).energy == pytest.approx(KNOWN, rel=1e-12)


def test_elevated_rows_have_functions_without_a_span():
    # Elevated from 2 to 5, two near knots become eight: more than one function of degree 5 reaches over.
    a, b = Base(strip(2, [0.5, 0.5 + 5e-13]), "u1"), Base(strip(5, [], (2, 2), (1, 2)), "u0")
    assert blend(a, b).energy == pytest.approx(KNOWN, rel=1e-12)
    # Where such a row is free there is nothing that determines these points.
    with pytest.raises(SemisplineError, match="knots that are not so close"):
        blend(a, b, continuity="C0")


def test_gram_matrix_of_functions_without_a_span():
    basis = Basis(5, elevated_knots(clamped([0.5, 0.5 + 5e-13], 2, 0.0, 1.0), 3))
    gram = gram_matrix(basis, basis).toarray()
    empty = np.flatnonzero(basis.knots[6:] - basis.knots[:-6] < 1e-12)
    assert len(empty) == 2
    assert not gram[empty].any()
    assert not gram[:, empty].any()
    # The functions add up to 1.
    assert gram.sum() == pytest.approx(1, rel=1e-14)


@pytest.mark.parametrize(("step", "angles"), [(0.0, [90]), (1e-13, [90]), (2e-12, [])])
def test_near_knots_that_come_to_full_multiplicity_are_a_crease(step, angles):
    knots = clamped(0.5 + step * np.arange(2), 2, 0, 1)
    rows = [[[x, 0, 0], [x, 1, 0], [x, 2, 0], [x, 2, 1], [x, 2, 2]] for x in (0, 1)]
    creases = measure_creases(SemiStructuredSurface(1, LINE, [BSplineCurve(2, knots, row) for row in rows]))
    assert [(crease.parameter, crease.at) for crease in creases] == [("v", 0.5)] * len(angles)
    assert [crease.angle_degrees for crease in creases] == pytest.approx(angles, abs=1e-6)


def rounding_warnings(result):
    return [warning for warning in result.warnings if "control points round" in warning]


@pytest.mark.parametrize("v_scale", ["paper", "length"])
@pytest.mark.parametrize("degree", [2, 3, 5])
def test_an_energy_made_of_rounding_is_said_and_not_proved(degree, v_scale):
    a = floor(degree, 0.5 + 2e-12 * np.arange(degree + 1))
    result = blend(a, WALL, v_scale=v_scale)
    # The true energy is known: the base is flat.
    assert result.energy > 10 * KNOWN
    assert abs(result.energy - KNOWN) <= result.energy_rounding
    (warning,) = rounding_warnings(result)
    assert "at v = 0.5, is 2.0e-12 long" in warning
    assert result.certificate is None
    assert result.proven_gap is None
    with pytest.raises(FoldError, match="control points round"):
        blend(a, WALL, v_scale=v_scale, strict=True)


def test_the_share_of_rounding_that_is_said_is_a_thousandth():
    # Rounding grows with the inverse cube of the distance: these two are 0.0008 and 0.0016 of the energy.
    far, near = (blend(floor(3, 0.5 + step * np.arange(4)), WALL) for step in (7e-10, 5.5e-10))
    assert 5e-4 < far.energy_rounding / far.energy < 1e-3 < near.energy_rounding / near.energy < 2e-3
    assert not far.warnings
    assert far.proven_gap <= 1e-10
    assert far.certificate is not None
    assert rounding_warnings(near)
    assert near.proven_gap is None


def test_where_another_energy_is_minimised_its_rounding_counts_too():
    # Over a long domain what is bent along v weighs little in the energy, and more in the one that is minimised.
    inner = 0.5 + 1.5e-10 * np.arange(4)
    a, b = (
        Base(strip(3, inner * 50, *args, (0.0, 50.0)), edge)
        for args, edge in ((((0.0, 1.0), (0.0, 0.0)), "u1"), (((2.0, 2.0), (1.0, 2.0)), "u0"))
    )
    unit = blend(a, b, v_scale="unit")
    assert unit.energy_rounding < 1e-3 * unit.energy
    assert rounding_warnings(unit)
    assert unit.proven_gap is None
    assert not blend(a, b).warnings


@pytest.mark.long
@given(
    st.integers(1, 4),
    st.integers(-1, 2),
    st.floats(-11.6, -2.0),
    st.floats(0.2, 0.7),
    st.sampled_from([0.0, -3.0, 1e4]),
)
@example(3, 1, -11.6, 0.5, 0.0)
@examples(25)
def test_the_bound_holds_for_flat_bases(degree, more, digits, at, offset):
    inner = at + 10.0**digits * np.arange(max(1, degree + more))
    a, b = strip(degree, inner, y=(0.0, 1.0)), WALL.surface
    shift = np.array([offset, 0, -offset])
    a, b = (BSplineSurface(1, s.degree_v, LINE, s.knots_v, s.control_points + shift) for s in (a, b))
    try:
        result = blend(Base(a, "u1"), Base(b, "u0"))
    except SemisplineError:
        return
    assert abs(result.energy - KNOWN) <= result.energy_rounding + 1e-12
    if not rounding_warnings(result):
        assert result.energy == pytest.approx(KNOWN, rel=1e-3)


# By hand: row 2 of C1, and rows 1, 2 of C2, are known as well; G2 is `KNOWN`. The bases are straight along v.
STRAIGHT = {"C1": 8.0, "C2": 13.0, "G2": KNOWN}
NARROW = {
    "start": lambda g: [g],
    "end": lambda g: [1 - g],
    "both ends": lambda g: [g, 1 - g],
    "middle": lambda g: 0.5 + g * np.arange(4),
    "beside a crease": lambda g: [0.5, 0.5, 0.5, 0.5 + g],
}


# Over a domain of length 1 both scales are the same.
@pytest.mark.long
@pytest.mark.parametrize("v_scale", first_ones(1, ["paper", "unit"]))
@pytest.mark.parametrize("continuity", STRAIGHT)
@pytest.mark.parametrize("place", NARROW)
def test_a_narrow_span_hides_no_energy(place, continuity, v_scale, whole):
    """Narrow spans once hid all else from the solve: up to forty times the least energy, without a word."""
    true = STRAIGHT[continuity]
    for width in (1e-3, 1e-5, 1e-6) if whole else (1e-3, 1e-6):
        result = blend(floor(3, NARROW[place](width)), WALL, continuity=continuity, v_scale=v_scale)
        assert result.energy == pytest.approx(true, rel=1e-7), width
        assert abs(result.energy - true) <= result.energy_rounding + 1e-12
        assert not result.warnings
        assert (result.proven_gap is not None) is (continuity == "G2")
    # From here on the factorisation may meet a zero pivot, on some processors sooner than on others: right, or refused.
    widths = (1e-7, 3e-8, 1e-8, 5e-9, 3e-9, 1e-9, 3e-10, 1e-10, 1e-11)
    for width in widths if whole else widths[::4]:
        try:
            result = blend(floor(3, NARROW[place](width)), WALL, continuity=continuity, v_scale=v_scale)
        except ComputationError:
            continue
        assert abs(result.energy - true) <= result.energy_rounding
        assert rounding_warnings(result) or result.energy == pytest.approx(true, rel=1e-3)


def cut(degree, width, long=1.0):
    """The floor again, so `long` across the edge and with a knot `width` from it."""
    knots = clamped([1 - width], degree, 0.0, 1.0)
    net = [[[1 - long + long * x, y, 0.0] for y in (0.0, 1.0)] for x in greville(knots, degree)]
    return Base(BSplineSurface(degree, 1, knots, LINE, net), "u1")


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize(("continuity", "order"), [("C1", 1), ("C2", 2)])
def test_what_a_narrow_span_across_the_edge_rounds_is_said(continuity, order, degree):
    """Prescribed rows are differences of the base's rows, divided by its span beside the edge once or twice."""
    for width in (1e-2, 1e-3, 1e-4, 1e-5):
        result = blend(cut(degree, width), WALL, continuity=continuity)
        assert abs(result.energy - STRAIGHT[continuity]) <= result.energy_rounding
        # Spacings of floats over the span; three digits are the weights of the derivatives.
        assert 1 < result.energy_rounding / (2.2e-16 / width**order) < 2000


@pytest.mark.parametrize("edge", ["u1", "u0", "v1", "v0"])
def test_next_to_no_span_across_the_edge_is_the_reason_that_is_given(edge):
    for width, said in ((0.9e-10, "9.0e-11"), (1e-12, "1.0e-12"), (1e-14, "1.0e-14")):
        base = Base(turned(turned(cut(3, width).surface, "u1", False), edge, False), edge)
        with pytest.raises(EdgeError, match=f"base a: knots_{edge[0]} leave a span of {said} beside the edge"):
            blend(base, WALL, continuity=("C1", "G0"))
        assert blend(base, WALL, continuity="G0").energy < 1e-12
    # (10 long, so that its size is not what counts.)
    assert blend(cut(3, 1.1e-10, 10.0), WALL, continuity=("C1", "G0")).contact_a.gap < 1e-12


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("long", [1.0, 0.1, 10.0])
def test_the_shape_parameter_makes_up_for_how_fast_the_base_is(degree, long):
    # (A narrower span leaves the proof too few digits.)
    result = blend(cut(degree, 0.03 / min(long, 1.0), long), WALL, continuity="G2")
    assert abs(result.energy - KNOWN) <= result.energy_rounding
    span = 0.03 * max(long, 1.0)
    assert 50 < result.energy_rounding / (2.2e-16 / span**2 * max(long, 1.0)) < 1000


@pytest.mark.parametrize(
    ("degree", "inner", "kept"),
    [
        (3, [0.5], [0.5]),
        # Close to an end none stays.
        (3, [1e-6, 0.5, 1 - 1e-6], [0.5]),
        # As many as keep the slope continuous.
        (3, [0.5, 0.5 + 1e-6, 0.5 + 2e-6, 0.9], [0.5, 0.5 + 1e-6, 0.9]),
        (2, [0.5, 0.5 + 1e-6], [0.5]),
        # A crease stays one, wherever it is among its neighbours.
        (3, [0.5, *[0.5 + 1e-6] * 3, 0.9], [*[0.5 + 1e-6] * 3, 0.9]),
        # A thousandth of the longest span, 0.5, from both sides.
        (2, [0.5, 0.5 + 4.9e-4], [0.5]),
        (2, [0.5, 0.5 + 5.1e-4], [0.5, 0.5 + 5.1e-4]),
    ],
)
def test_knots_that_stay_in_the_smooth_rows(degree, inner, kept):
    found = without_close_knots(Basis(degree, clamped(inner, degree, 0.0, 1.0)))
    np.testing.assert_array_equal(found.knots, clamped(kept, degree, 0.0, 1.0))


@pytest.mark.long
def test_a_good_blend_has_no_such_warning():
    result = blend(floor(3, [0.2, 0.5, 0.51]), WALL)
    assert not result.warnings
    assert 0 < result.energy_rounding < 1e-10 * result.energy
    # Nor has a flat one, whose energy is nothing but rounding.
    flat = blend(floor(3, np.arange(1, 40) / 40), Base(strip(3, [], (2, 3)), "u0"))
    assert flat.energy < 1e-20
    assert not rounding_warnings(flat)


def test_a_blend_that_bends_a_little_is_not_taken_for_a_flat_one():
    # A step of 1e-4 of the size has some 1e-7 of the energy of a bend: what rounding adds to it is not nothing.
    a, b = floor(3, 0.5 + 1e-7 * np.arange(4)), Base(strip(3, [], (2, 3), (1e-4, 1e-4)), "u0")
    result = blend(a, b)
    assert 1e-9 < result.energy < 1e-6
    assert 1e-3 * result.energy < result.energy_rounding < 0.1 * result.energy
    assert rounding_warnings(result)
    assert not rounding_warnings(blend(floor(3, [0.5]), b))


@given(st.integers(0, 2**32 - 1), st.integers(1, 3), st.floats(1e-16, 1e-2))
@examples(20)
def test_the_change_of_the_energy_by_errors_is_within_its_bound(seed, degree, width):
    rng = np.random.default_rng(seed)
    inner = np.sort(np.concatenate([rng.uniform(0.1, 0.4, 2), 0.5 + width * np.arange(1, degree + 1)]))
    rows = tuple(Basis(degree, clamped(inner if i % 2 else inner[:2], degree, 0.0, 1.0)) for i in range(6))
    form = EnergyForm(Basis(3, uniform_knots(3, 3)), rows)
    points, errors = rng.uniform(-1, 1, (form.offsets[-1], 3)), rng.uniform(0, 1e-3, 3)
    largest = 10 ** rng.uniform(-3, 3, 6)
    of_each = np.repeat(largest, [row.size for row in rows])[:, None] * errors
    moved = points + of_each * rng.choice([-1.0, 1.0], points.shape)
    before, after = (float(form.products(p[None])[0, 0]) for p in (points, moved))
    bound = form.change_by_errors(points, errors, largest)
    assert abs(after - before) <= bound * (1 + 1e-9)
    # Not out of proportion: errors as large as the points change about as much as there is.
    assert form.change_by_errors(points, np.ones(3), np.ones(6)) < 1e4 * before


def clusters(degree, start=0.0, end=1.0):
    """Inner knots, up to `degree` + 2 of them close together or close to an end, others elsewhere."""
    places = st.sampled_from([0.0, 0.3, 0.5, 0.77, 1.0])
    cluster = st.tuples(places, st.floats(-15.5, -2.0), st.integers(1, degree + 2), st.integers(1, degree))

    def knots(found):
        parts = []
        for place, digits, count, times in found:
            steps = 10.0**digits * np.arange(1, count + 1)
            parts.append(np.repeat(place - steps if place == 1 else place + steps, times if count == 1 else 1))
        return np.sort(start + (end - start) * np.concatenate([*parts, []]))

    return st.lists(cluster, max_size=2).map(knots)


@st.composite
def near_bases(draw, side):
    seed = draw(st.integers(0, 2**16))
    if draw(st.booleans()) if side is None else side:
        s = tube(np.random.default_rng(seed), 6, degree=draw(st.integers(1, 3)), noise=0.02)
        return insert_knots(s, [], draw(clusters(1)))
    p, q = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    knots_u, knots_v = clamped(draw(clusters(p)), p, 0, 1), clamped(draw(clusters(q)), q, 0, 1)
    x, y = np.meshgrid(greville(knots_u, p), greville(knots_v, q), indexing="ij")
    z = 0.2 * y**2 + draw(st.sampled_from([0.0, 0.1])) * np.random.default_rng(seed).uniform(-1, 1, x.shape)
    return BSplineSurface(p, q, knots_u, knots_v, np.stack([-x, y, z], axis=2))


@pytest.mark.long
@given(st.data())
@examples(60)
def test_near_knots_end_in_a_result_or_a_reason(data):
    """Of one base, of both, of given knots; at the ends of the domain; open and closed; all contacts and methods."""
    closed = data.draw(st.booleans())
    middle = data.draw(st.integers(0, 2))
    options = {
        "continuity": tuple(data.draw(st.sampled_from(["C0", "C1", "C2", "G0", "G1", "G2"])) for _ in range(2)),
        "middle_curves": middle,
        "method": data.draw(st.sampled_from(["reduced", "reduced", "casadi", "bfgs"])),
        "v_scale": data.draw(st.sampled_from(["paper", "unit", "length"])),
    }
    try:
        a, b = (data.draw(near_bases(closed)) for _ in range(2))
        edge = data.draw(st.sampled_from(["u0", "u1", "v0", "v1"]))
        matrix, offset = (np.eye(3), (0.0, 0.0, 2.0)) if closed else (np.diag([-1.0, 1, 1]), (1.0, 0.1, 0.4))
        b = BSplineSurface(b.degree_u, b.degree_v, b.knots_u, b.knots_v, b.control_points @ matrix + offset)
        bases = [Base(a, "u1"), Base(b, "u0")] if closed else [Base(turned(a, edge, False), edge), Base(b, "u0")]
        if data.draw(st.integers(0, 3)) == 0:
            degree = bases[0].surface.degree_v if edge[0] == "u" or closed else bases[0].surface.degree_u
            options["middle_knots"] = [data.draw(clusters(degree)) for _ in range(middle)]
        if data.draw(st.integers(0, 3)) == 0:
            options["u_knots"] = (0.5 + data.draw(st.floats(1e-16, 0.1)) * np.arange(2 + middle)).clip(0.0, 1.0)
        result = blend(*bases, **options)
    except SemisplineError:
        return
    assert np.isfinite(result.energy)


@pytest.mark.parametrize(("step", "said"), [(1e-5, 0), (1e-6, 1)])
def test_rounding_of_a_flat_blend_is_none_up_to_a_million_millionth_of_what_bends(step, said):
    # No energy but rounding: 2e-15 and 2e-12, where a surface that bends by its size has about ten.
    far = Base(strip(1, [], (2.0, 3.0)), "u0")
    result = blend(floor(3, 0.5 + step * np.arange(4)), far)
    assert result.energy < 1e-13
    assert len(rounding_warnings(result)) == said
