"""Names of edges: they read back as they print, and what they cut off is exactly that part of the surface."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from helpers.closed import cylinder, torus
from helpers.splines import bspline_surfaces, exact_point, parameters, scale, surfaces
from helpers.sweeps import examples
from semispline import (
    BSplineSurface,
    EdgeError,
    EdgeName,
    cut_to_edge,
    parse_edge,
    split_u,
    split_v,
    swap_directions,
)
from semispline.solver.judge import surface_points

# As of all exact operations: short convex combinations of the control points.
TOLERANCE = 1e-12
SEEDS = st.integers(0, 2**32 - 1)
laws = examples(60)
K = [0, 0, 0, 1, 2, 2, 2]
# Every point a whole number: dyadic cuts are exact.
BOWL = BSplineSurface(2, 2, K, K, [[[8 * i, 8 * j, 4 * (i - 1) * (j - 2) ** 2] for j in range(4)] for i in range(4)])
finite = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def names(draw):
    part = draw(st.none() | st.tuples(finite, finite).filter(lambda x: x[0] != x[1]).map(sorted).map(tuple))
    return EdgeName(draw(st.sampled_from("uv")), draw(st.sampled_from((0, 1))), draw(st.none() | finite), part)


@st.composite
def edges_inside(draw, surface):
    """A name of an edge that a surface has, no cut nearer than a thousandth of the range to another or to an end."""
    direction, end = draw(st.sampled_from("uv")), draw(st.sampled_from((0, 1)))
    across, along = surface.domain if direction == "u" else surface.domain[::-1]

    def at(domain, fraction):
        return domain[0] + fraction * (domain[1] - domain[0])

    fractions = st.floats(0.001, 0.999)
    line = draw(st.none() | fractions)
    ends = sorted(draw(st.tuples(fractions, fractions)))
    assume(ends[1] - ends[0] > 0.001)
    part = draw(st.sampled_from((None, (at(along, ends[0]), at(along, ends[1])))))
    return EdgeName(direction, end, None if line is None else at(across, line), part)


@given(names())
def test_names_read_back_to_the_last_bit(name):
    assert parse_edge(str(name)) == name


@pytest.mark.parametrize(
    ("word", "printed"),
    [
        ("u1", "u1"),
        (" v0 [ 0.2 , 0.6 ] ", "v0[0.2,0.6]"),
        ("u=0.3+", "u=0.3+"),
        ("u=.5-", "u=0.5-"),
        ("v=-0.3-[1,2.0]", "v=-0.3-[1,2]"),
        ("u=1e-5+", "u=1e-05+"),
        ("u=-0-", "u=0-"),
        ("u=0.1000000000000000055511151231257827+", "u=0.1+"),
        ("u=0.30000000000000004+[-1e300,1e300]", "u=0.30000000000000004+[-1e+300,1e+300]"),
    ],
)
def test_known_words(word, printed):
    assert str(parse_edge(word)) == printed
    assert str(parse_edge(printed)) == printed


@pytest.mark.parametrize(
    ("word", "parts"),
    [
        ("u2", ["'u2'", "expected one of u0, u1, v0, v1"]),
        ("U1", ["'U1'", "u=0.3+"]),
        ("", ["''", "expected one of"]),
        (None, ["None", "expected one of"]),
        (1, ["found 1", "expected one of"]),
        ("u=0.3", ["which side", "u=0.3+ (where u is larger)", "u=0.3-"]),
        ("v=2[0,1]", ["which side", "v=2+[0,1]", "v=2-[0,1]"]),
        ("u=+", ["'u=+'", "expected one of"]),
        ("u=nan+", ["'u=nan+'", "expected one of"]),
        ("u=1_0+", ["'u=1_0+'", "expected one of"]),
        ("u=1e999+", ["inf", "finite"]),
        ("u1[0.2]", ["'u1[0.2]'", "u1[0.2,0.6]"]),
        ("u1[0.2,0.6", ["'u1[0.2,0.6'", "u1[0.2,0.6]"]),
        ("u1[0.2,inf]", ["'u1[0.2,inf]'", "expected one of"]),
        ("u1[0.6,0.2]", ["[0.6,0.2]", "runs backwards, expected [0.2,0.6]"]),
        ("u1[0.2,0.2]", ["[0.2,0.2]", "is empty"]),
        ("u1+", ["'u1+'", "expected one of"]),
        ("e3", ["'e3'", "an edge of a face in a file", "resolve_edge"]),
        ("near=1,2,3", ["'near=1,2,3'", "resolve_edge"]),
    ],
)
def test_bad_words(word, parts):
    with pytest.raises(EdgeError) as error:
        parse_edge(word, "--edge-a")
    for part in (*parts, "--edge-a"):
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("word", "parts"),
    [
        ("u=2.5+", ["u=2.5+", "2.5 lies outside of the range of u, [0,2]"]),
        ("v=-1-", ["-1 lies outside of the range of v, [0,2]"]),
        ("u=2+", ["nothing lies on the side +", "u ends at 2", "u1 or u=2- keeps the surface"]),
        ("u=0-", ["nothing lies on the side -", "u begins at 0", "u0 or u=0+ keeps the surface"]),
        ("u=1.9999999999999998+", ["nothing lies on the side +"]),
        ("u1[-0.5,1]", ["-0.5 lies outside of the range of v, [0,2]"]),
        ("v=1+[0.5,2.25]", ["beyond the range of u, [0,2]", "apart", "end the part at 2"]),
        ("u1[0.5,3]", ["beyond the range of v, [0,2]", "apart", "end the part at 2"]),
        ("u1[0,3]", ["3 lies outside of the range of v, [0,2]"]),
        ("u1[3,4]", ["3 lies outside of the range of v, [0,2]"]),
        ("u1[0.5,0.5000000000000001]", ["1.11e-16 long", "more than 2e-12 of v"]),
    ],
)
def test_edges_that_a_surface_does_not_have(word, parts):
    with pytest.raises(EdgeError) as error:
        cut_to_edge(BOWL, word)
    for part in (word, *parts):
        assert part in str(error.value)


def test_a_semistructured_surface_has_no_way_across_its_seam_in_u():
    pipe = torus(3, 1).to_semistructured()
    assert cut_to_edge(pipe, "u1[0.75,1.25]")[0].domain == ((0, 1), (0.75, 1.25))
    with pytest.raises(EdgeError, match=r"1.8 lies outside of the range of u, \[0.75,1.75\]"):
        cut_to_edge(torus(3, 1), "v0[0.75,1.8]")
    with pytest.raises(EdgeError, match=r"v0\[0.75,1.25\]: beyond the range of u.*to_bspline"):
        cut_to_edge(pipe, "v0[0.75,1.25]")


@pytest.mark.long
@laws
@given(surfaces(), SEEDS, st.data())
def test_what_is_cut_off_is_that_part_of_the_surface(surface, seed, data):
    name = data.draw(edges_inside(surface))
    part, natural = cut_to_edge(surface, name)
    # The ranges are what the name says, to the last bit.
    kept = dict(zip("uv", surface.domain, strict=True))
    if name.at is not None:
        kept[name.direction] = (
            (name.at, kept[name.direction][1]) if name.end == 0 else (kept[name.direction][0], name.at)
        )
    if name.part is not None:
        kept[name.along] = name.part
    assert part.domain == (kept["u"], kept["v"])
    assert natural == f"{name.direction}{name.end}"
    # Inner knots closer to a cut than 1e-12 of the range would move points: there are none here.
    u, v = (np.clip(parameters(np.random.default_rng(seed), x, count=8), *x) for x in part.domain)
    found, expected = part.evaluate(u, v), surface_points(surface, u, v)
    assert np.abs(found - expected).max() <= TOLERANCE * scale(surface)
    # A second cut by the same name finds nothing to cut off.
    again, _ = cut_to_edge(part, name)
    assert again is part


@pytest.mark.parametrize("word", ["u=0.5+", "u=1.25-[0.5,1.75]", "v=1+[0.125,1]", "v1[0.25,2]", "u=1.5-"])
@pytest.mark.parametrize("kind", ["polynomial", "rational", "semi-structured"])
def test_dyadic_cuts_are_exact(word, kind):
    """Referee: the definition in fractions. Whole numbers and halves: no operation rounds."""
    surface = (
        BOWL if kind == "polynomial" else replace(BOWL, weights=[[1, 2, 1, 1], [1, 1, 4, 1], [2, 1, 1, 1], [1] * 4])
    )
    surface = surface.to_semistructured() if kind == "semi-structured" else surface
    part, _ = cut_to_edge(surface, word)
    thirds = [[low + (high - low) * Fraction(k, 3) for k in range(4)] for low, high in _fractions(part.domain)]
    limit = 0 if kind == "polynomial" else Fraction(1, 2**44)
    for u in thirds[0]:
        for v in thirds[1]:
            off = [x - y for x, y in zip(exact_point(part, u, v), exact_point(surface, u, v), strict=True)]
            # Weighted points are divided by their weights when stored, and multiplied again: 32 is the size.
            assert max(map(abs, off)) <= 32 * limit


def _fractions(domain):
    return [[Fraction(x) for x in ends] for ends in domain]


@laws
@given(bspline_surfaces(), SEEDS, st.data())
def test_u_and_v_may_be_exchanged(surface, seed, data):
    name = data.draw(edges_inside(surface))
    swapped = replace(name, direction=name.along)
    part, _ = cut_to_edge(surface, name)
    other, natural = cut_to_edge(swap_directions(surface), swapped)
    assert natural[0] == name.along
    expected = swap_directions(part)
    assert np.array_equal(other.knots_u, expected.knots_u)
    assert np.array_equal(other.knots_v, expected.knots_v)
    assert np.abs(other.control_points - expected.control_points).max() <= TOLERANCE * scale(surface)


@pytest.mark.parametrize("word", ["u0", "v1", "u=0+", "v=2-", "u1[0,2]", "v=0+[0,2]", "u=1e-13+"])
def test_nothing_is_cut_off_where_all_is_kept(word):
    assert cut_to_edge(BOWL, word)[0] is BOWL


@pytest.mark.parametrize(
    "surface", [torus(3, 1), swap_directions(torus(3, 1)), cylinder(2, 5)], ids=["uv", "vu", "pipe"]
)
@pytest.mark.parametrize(("low", "high"), [(0.75, 1.25), (0.9, 1.05), (0.3, 1.3), (0.0, 1.0), (0.999, 1.5)])
def test_a_part_of_a_closed_direction_runs_across_the_seam(surface, low, high):
    part, natural = cut_to_edge(surface, f"v1[{low!r},{high!r}]")
    assert natural == "v1"
    assert part.domain == ((low, high), surface.domain[1])
    u = np.linspace(low, high, 41)
    v = np.linspace(0, 1, 41)
    expected = surface_points(surface, u % 1.0, v)
    assert np.abs(part.evaluate(u, v) - expected).max() <= 1e-12


def test_the_split_functions_make_the_same_parts():
    expected = split_v(split_v(split_u(BOWL, 0.75)[1], 1.5)[0], 0.5)[1]
    found, _ = cut_to_edge(BOWL, "u=0.75+[0.5,1.5]")
    # A few products of numbers up to 32.
    assert np.abs(found.control_points - expected.control_points).max() <= 1e-13
    assert np.array_equal(found.knots_v, expected.knots_v)


def test_values_that_name_no_edge():
    for bad in (("w", 0), ("u", 2), ("u", 0, "x"), ("u", 0, np.inf), ("u", 0, True), ("u", 0, None, (1.0, 0.0))):
        with pytest.raises(EdgeError):
            EdgeName(*bad)
    assert str(EdgeName("u", 0, np.float64(0.3))) == "u=0.3+"
