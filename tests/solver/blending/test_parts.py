"""Blends to parts of edges and to lines inside: the same as to surfaces that were cut before, with exact contact."""

import subprocess
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from helpers.bases import facing_pair
from helpers.closed import cylinder
from helpers.papers_set import blend
from helpers.sweeps import examples
from semispline import Base, EdgeError, map_domain, measure_contact, split_u, split_v, swap_directions, transform
from semispline.solver.c_export.files import write_c
from semispline.solver.cli import app
from semispline.solver.io.json_files import StoredProblem, load_json, read_problem, write_json_surface, write_problem


def cut_by_hand(surface, edge, line, part):
    """The same with the functions that split: contact is then at the natural edge."""
    (across, along), (split_across, split_along) = surface.domain, (split_u, split_v)
    if edge[0] == "v":
        (across, along), (split_across, split_along) = (along, across), (split_along, split_across)

    def at(domain, fraction):
        return domain[0] + fraction * (domain[1] - domain[0])

    low, high = (at(along, x) for x in part)
    natural = split_along(split_along(surface, low)[1], high)[0]
    if line is None:
        return natural, f"{edge}[{low!r},{high!r}]"
    value = at(across, line)
    kept = split_across(natural, value)[0 if edge[1] == "1" else 1]
    return kept, f"{edge[0]}={value!r}{'-' if edge[1] == '1' else '+'}[{low!r},{high!r}]"


@pytest.mark.long
@examples(30)
@given(
    st.integers(0, 10**6),
    st.sampled_from(("u0", "u1", "v0", "v1")),
    st.none() | st.floats(0.1, 0.4),
    st.floats(0.05, 0.3),
    st.floats(0.5, 0.95),
)
def test_a_blend_to_a_part_is_the_blend_to_the_surface_cut_before(seed, edge, line, low, high):
    a, b = facing_pair(np.random.default_rng(seed), edges=(edge, "u0"))
    line = 1 - line if line and edge[1] == "1" else line
    cut, word = cut_by_hand(a.surface, edge, line, (low, high))
    # A natural parametrisation apart, the order of the cuts is another: numbers of size 1 round alike to 1e-13, and
    # second derivatives of the blend amplify that.
    options = {"continuity": "G2", "alpha": (1.0, 1.0)}
    found, expected = blend(Base(a.surface, word), b, **options), blend(Base(cut, edge), b, **options)
    assert found.edges == (word, "u0")
    assert found.surface.domain == ((0.0, 1.0), cut.domain[1 if edge[0] == "u" else 0])
    v = np.linspace(*found.surface.domain[1], 9)
    u = np.linspace(0, 1, 7)
    off = found.surface.evaluate_grid(u, v) - expected.surface.evaluate_grid(u, v)
    assert np.abs(off).max() <= 1e-9
    for contact in (found.contact_a, found.contact_b):
        assert contact.gap <= 1e-14
        assert contact.angle_degrees < 1e-9
        assert contact.curvature_jump_relative < 1e-8
    # Against the whole surface, by points on the line itself.
    along = v
    across = np.full_like(
        v, a.surface.domain[0 if edge[0] == "u" else 1][int(edge[1])] if line is None else _line(word)
    )
    uv = (across, along) if edge[0] == "u" else (along, across)
    assert np.abs(found.surface.evaluate(np.zeros(9), v) - a.surface.evaluate(*uv)).max() <= 1e-13


def _line(word):
    return float(word[2 : word.index("[") - 1])


def test_exchanging_u_and_v_changes_nothing():
    a, b = facing_pair(np.random.default_rng(3), edges=("u0", "u0"))
    first = blend(Base(a.surface, "u=0.2+[0.1,0.7]"), b, alpha=(1.0, 1.0))
    second = blend(Base(swap_directions(a.surface), "v=0.2+[0.1,0.7]"), b, alpha=(1.0, 1.0))
    grid = np.linspace(0, 1, 5), np.linspace(0.1, 0.7, 9)
    assert np.abs(first.surface.evaluate_grid(*grid) - second.surface.evaluate_grid(*grid)).max() <= 1e-12


def test_a_contact_inside_is_measured_on_the_side_that_is_kept():
    """A plane with a crease at u = 0.5: the two sides of the line have two normals."""
    a, _ = facing_pair(np.random.default_rng(0), edges=("u0", "u0"))
    k = [0, 0, 0.5, 1, 1]
    roof = replace(
        a.surface,
        degree_u=1,
        degree_v=1,
        knots_u=k,
        knots_v=[0, 0, 1, 1],
        control_points=[[[0, 0, 0], [0, 1, 0]], [[1, 0, 1], [1, 1, 1]], [[2, 0, 0], [2, 1, 0]]],
    )
    rising, falling = Base(roof, "u=0.5-"), Base(roof, "u=0.5+")
    assert (rising.side, falling.side) == ("u1", "u0")
    contact = measure_contact(rising, falling)
    assert contact.gap == 0
    assert contact.angle_degrees == pytest.approx(90, abs=1e-12)
    smooth = measure_contact(Base(roof, "u=0.25-"), Base(roof, "u=0.25+"), order=4)
    assert smooth.angle_degrees < 1e-13
    half = measure_contact(Base(roof, "u=0.25-[0,0.5]"), Base(roof, "u=0.25+[0,0.5]"))
    assert half.gap == 0
    assert measure_contact(Base(roof, "u=0.25-[0,0.5]"), Base(roof, "u=0.25+[0.5,1]"), flip="no").gap > 0.4


def test_a_part_across_the_seam_of_a_pipe():
    pipe = cylinder(1.0, 2.0)
    lid = transform(cylinder(0.6, 2.0), np.eye(3), [0, 0, 4])
    result = blend(Base(pipe, "v1[0.8,1.2]"), Base(lid, "v0[0.8,1.2]"), continuity="G2", alpha="energy")
    assert result.surface.domain[1] == (0.8, 1.2)
    assert result.contact_a.gap <= 1e-14
    assert result.contact_b.gap <= 1e-14
    middle = result.surface.evaluate([0.0, 1.0], [1.0, 1.0])
    assert np.abs(middle - [[1, 0, 2], [0.6, 0, 4]]).max() <= 1e-14


def test_words_that_the_surface_does_not_have_are_refused_by_base():
    a, _ = facing_pair(np.random.default_rng(0), edges=("u0", "u0"))
    with pytest.raises(EdgeError, match=r"u=7\+: 7 lies outside"):
        Base(a.surface, "u=7+")


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pair = facing_pair(np.random.default_rng(5), edges=("u0", "u0"))
    a, b = (Base(map_domain(base.surface, (0, 1), (0, 1)), "u0") for base in pair)
    write_json_surface("a.json", a.surface)
    write_json_surface("b.json", b.surface)
    return a, b


WORDS = ("u=0.2+[0.1,0.7]", "u0[0.25,0.75]")
NAMED = ["--edge-a", WORDS[0], "--edge-b", WORDS[1]]


@pytest.mark.long
@pytest.mark.usefixtures("files")
def test_the_command_line_takes_the_words():
    run = CliRunner().invoke(app, ["blend", "a.json", "b.json", *NAMED, "-o", "c.json", "--report", "r.json"])
    assert run.exit_code == 0, run.output
    report = load_json("r.json")
    assert (report["edge_a"], report["edge_b"]) == WORDS
    assert f"{WORDS[0]} of A, {WORDS[1]} of B" in run.output
    check = ["check", "a.json", "c.json", "--edge-a", WORDS[0], "--edge-b", "u0", "--require", "G2", "--json", "k.json"]
    assert CliRunner().invoke(app, check).exit_code == 0
    assert load_json("k.json")["edge_a"] == WORDS[0]
    check = ["check", "b.json", "c.json", "--edge-a", WORDS[1], "--edge-b", "u1", "--require", "G2"]
    assert CliRunner().invoke(app, check).exit_code == 0
    # The whole edge is another.
    check[4] = "u0"
    assert CliRunner().invoke(app, check).exit_code == 1


def test_problem_files_and_generated_c_take_the_words(files):
    a, b = files
    write_problem("p.json", StoredProblem(a.surface, WORDS[0], b.surface, WORDS[1], asked_a="e3"))
    stored = read_problem("p.json")
    assert (stored.edge_a, stored.edge_b, stored.asked_a, stored.asked_b) == (*WORDS, "e3", None)
    assert "asked_b" not in load_json("p.json")
    write_c("part", "p.json")
    write_problem("q.json", StoredProblem(Base(a.surface, WORDS[0]).surface, "u0", b.surface, WORDS[1]))
    write_c("whole", "q.json")
    assert subprocess.run(["diff", "part/blend.c", "whole/blend.c"], check=False).returncode == 0
    with pytest.raises(EdgeError, match="edge_b: found 'w1', expected one of u0"):
        write_problem("q.json", StoredProblem(a.surface, "u0", b.surface, "w1"))


def test_a_range_whose_end_is_not_its_start_and_its_length():
    """What is rounded beyond the end is outside of the curve."""
    start, end = -0.2, 1.9
    assert start + (end - start) > end
    a, b = facing_pair(np.random.default_rng(1), edges=("u0", "u0"))
    surface = map_domain(a.surface, v_range=(start, end))
    assert blend(Base(surface, "u0"), b).surface.domain[1] == (start, end)
