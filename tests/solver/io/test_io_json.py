import json
import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from helpers.splines import surfaces
from semispline import (
    BlendOptions,
    BSplineCurve,
    BSplineSurface,
    EdgeError,
    FileError,
    InputError,
    KnotError,
    OptionError,
    SemiStructuredSurface,
)
from semispline.solver.io.json_files import (
    StoredProblem,
    read_json_surface,
    read_problem,
    surface_from_record,
    surface_record,
    write_json_surface,
    write_problem,
)
from semispline.solver.io.json_text import load_json, to_text

K = [0.0, 0.0, 1.0, 1.0]
SQUARE = BSplineSurface(1, 1, K, K, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0.1]]])


def mixed_degrees():
    rng = np.random.default_rng(5)
    knots = [K, [0, 0, 0, 0, 0.25, 1, 1, 1, 1], [0, 0, 0, 0.5, 1, 1, 1]]
    return SemiStructuredSurface(
        2,
        [0, 0, 0, 1, 1, 1],
        tuple(BSplineCurve(q, k, rng.normal(size=(len(k) - q - 1, 3))) for q, k in zip((1, 3, 2), knots, strict=True)),
    )


def same(a, b):
    if type(a) is not type(b) or a.degree_u != b.degree_u or not np.array_equal(a.knots_u, b.knots_u):
        return False
    if isinstance(a, SemiStructuredSurface):
        pairs = zip(a.control_curves, b.control_curves, strict=True)
        return all(
            x.degree == y.degree
            and np.array_equal(x.knots, y.knots)
            and x.control_points.tobytes() == y.control_points.tobytes()
            for x, y in pairs
        )
    return (
        a.degree_v == b.degree_v
        and np.array_equal(a.knots_v, b.knots_v)
        and a.control_points.tobytes() == b.control_points.tobytes()
        and (a.weights is None) == (b.weights is None)
        and (a.weights is None or np.array_equal(a.weights, b.weights))
    )


@given(surfaces())
def test_record_and_text_lose_no_bit(surface):
    text = to_text(surface_record(surface))
    assert same(surface_from_record(json.loads(text)), surface)


@given(st.lists(st.floats(-1e75, 1e75), min_size=12, max_size=12))
def test_every_double_survives(values):
    surface = BSplineSurface(1, 1, K, K, np.reshape(values, (2, 2, 3)))
    assert same(surface_from_record(json.loads(to_text(surface_record(surface)))), surface)


@pytest.mark.parametrize("surface", [SQUARE, mixed_degrees()], ids=["bspline", "semistructured"])
def test_file_round_trip(tmp_path, surface):
    path = tmp_path / "s.json"
    write_json_surface(path, surface)
    assert same(read_json_surface(path), surface)
    assert [p.name for p in tmp_path.iterdir()] == ["s.json"]


@pytest.mark.parametrize("whole", [np.int64, np.int32, np.uint8])
def test_whole_numbers_of_numpy_are_stored_as_plain_ones(tmp_path, whole):
    path = tmp_path / "s.json"
    plain = mixed_degrees()
    curves = (BSplineCurve(whole(c.degree), c.knots, c.control_points) for c in plain.control_curves)
    for surface, expected in (
        (BSplineSurface(whole(1), whole(1), K, K, SQUARE.control_points), SQUARE),
        (SemiStructuredSurface(whole(2), plain.knots_u, tuple(curves)), plain),
    ):
        write_json_surface(path, surface)
        assert same(read_json_surface(path), expected)
    options = BlendOptions(degree_u=whole(4), middle_curves=whole(2))
    write_problem(path, StoredProblem(SQUARE, "u1", SQUARE, "v0", options))
    assert read_problem(path).options == BlendOptions(degree_u=4, middle_curves=2)


def test_only_curves_of_another_degree_state_it():
    record = surface_record(mixed_degrees())
    assert record["degree_v"] == 3
    assert [curve.get("degree_v") for curve in record["control_curves"]] == [1, None, 2]


def test_integers_and_missing_weights_are_fine():
    record = {"format": "semispline/1", "kind": "bspline_surface", "degree_u": 1, "degree_v": 1}
    record |= {"knots_u": [0, 0, 1, 1], "knots_v": [0, 0, 1, 1], "control_points": SQUARE.control_points.tolist()}
    assert same(surface_from_record(record), SQUARE)
    assert same(surface_from_record(record | {"weights": None}), SQUARE)


def changed(*path, to):
    def change(record):
        for key in path[:-1]:
            record = record[key]
        if to is KeyError:
            del record[path[-1]]
        else:
            record[path[-1]] = to

    return change


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (changed("format", to="semispline/2"), ["format", "'semispline/2'", "'semispline/1'"]),
        (changed("format", to=KeyError), ["format", "None"]),
        (changed("kind", to="ledger"), ["kind", "'ledger'", "bspline_surface"]),
        (changed("kind", to=["bspline_surface"]), ["kind"]),
        (changed("colour", to="red"), ["colour", "no such key"]),
        (changed("knots_v", to=KeyError), ["knots_v", "missing"]),
        (changed("degree_u", to=0), ["degree_u", "0"]),
        (changed("degree_u", to=1.5), ["degree_u", "1.5"]),
        (changed("degree_u", to=True), ["degree_u", "True"]),
        (changed("degree_u", to="1"), ["degree_u", "'1'"]),
        (changed("degree_u", to=10**30), ["knots_u", "degree"]),
        (changed("knots_u", to="0 0 1 1"), ["knots_u", "list"]),
        (changed("knots_u", 1, to=None), ["knots_u[1]", "None"]),
        (changed("knots_u", 1, to=10**400), ["knots_u[1]"]),
        (changed("knots_u", to=[0, 0, 1]), ["knots_u", "3 knots", "expected 4"]),
        (changed("knots_u", to=[0, 1, 0, 1]), ["knots_u[2]", "non-decreasing"]),
        (changed("knots_u", to=[0, 1, 1, 2]), ["knots_u", "empty"]),
        (changed("knots_u", to=[1, 1, 1, 1]), ["knots_u", "empty"]),
        (changed("knots_u", 3, to=math.inf), ["knots_u[3]", "inf"]),
        (changed("control_points", 1, 0, 2, to="x"), ["control_points[1][0][2]", "'x'"]),
        (changed("control_points", 1, 0, 2, to=math.nan), ["control_points[1][0][2]", "nan"]),
        (changed("control_points", 1, 0, to=[1, 2]), ["control_points[1][0]", "2 coordinate", "3 as in the first"]),
        (changed("control_points", 1, 0, to=[1]), ["control_points[1][0]", "1 coordinate", "3, or 2 where z is 0"]),
        (changed("control_points", to=[[], []]), ["control_points"]),
        (changed("control_points", 1, to=[[0, 0, 0]]), ["control_points[1]", "1 points", "expected 2"]),
        (changed("control_points", to=[]), ["control_points"]),
        (changed("control_points", to={}), ["control_points"]),
        (changed("weights", to=[[1, 1]]), ["weights", "(1, 2)"]),
        (changed("weights", to=[[1, 1], [1, 0]]), ["weights[1, 1]", "positive"]),
    ],
)
def test_bad_surface_is_refused_in_one_line_that_names_it(change, words):
    record = json.loads(json.dumps(surface_record(SQUARE)))
    change(record)
    with pytest.raises(InputError) as caught:
        surface_from_record(record, "a.json")
    message = str(caught.value)
    assert message.startswith("a.json: ")
    assert "\n" not in message
    assert len(message) < 250
    for word in words:
        assert word in message


def test_unclamped_and_periodic_knots_are_clamped_exactly():
    # A closed quadratic over uniform knots: SciPy evaluates it as the file has it.
    rng = np.random.default_rng(0)
    net = rng.standard_normal((2, 7, 3))
    net[:, -2:] = net[:, :2]
    knots = np.arange(-2.0, 8)
    record = surface_record(SQUARE) | {"degree_v": 2, "knots_v": knots.tolist(), "control_points": net.tolist()}
    surface = surface_from_record(record)
    assert surface.knots_v.tolist() == [0, 0, 0, 1, 2, 3, 4, 5, 5, 5]
    v = np.linspace(0, 5, 41)
    for u in (0.0, 1.0):
        expected = BSpline(knots, net[int(u)], 2)(v)
        np.testing.assert_allclose(surface.evaluate(np.full(41, u), v), expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize("end", [0, -1])
def test_an_end_knot_too_many_goes_with_a_point_that_does_nothing(end):
    knots, net = [0, 0, 1, 2, 2], [[0, 0, 0], [1, 0, 2], [3, 0, 0]]
    more = ([knots[end], *knots], [[9, 9, 9], *net]) if end == 0 else ([*knots, knots[end]], [*net, [9, 9, 9]])
    record = surface_record(SQUARE) | {"knots_v": more[0], "control_points": [more[1], np.add(more[1], 1).tolist()]}
    surface = surface_from_record(record)
    assert surface.knots_v.tolist() == knots
    assert surface.control_points.tolist() == [net, np.add(net, 1).tolist()]


def test_points_of_the_plane_have_z_0():
    record = surface_record(SQUARE) | {"control_points": [[[0, 1], [2, 3]], [[4, 5], [6, 7]]]}
    assert surface_from_record(record).control_points[1].tolist() == [[4, 5, 0], [6, 7, 0]]
    record = surface_record(mixed_degrees())
    for curve in record["control_curves"]:
        curve["control_points"] = [point[:2] for point in curve["control_points"]]
    found = surface_from_record(record).control_curves[1].control_points
    np.testing.assert_array_equal(found[:, :2], mixed_degrees().control_curves[1].control_points[:, :2])
    assert not found[:, 2].any()


def test_an_inner_knot_of_too_high_multiplicity_says_what_to_do():
    record = surface_record(SQUARE) | {"knots_v": [0, 0, 0.5, 0.5, 1, 1]}
    record["control_points"] = np.zeros((2, 4, 3)).tolist()
    words = r"knots_v\[2\]: knot 0.5 has multiplicity 2, expected at most 1 \(split the spline there\)"
    with pytest.raises(KnotError, match=words):
        surface_from_record(record)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (changed("control_curves", to=[]), ["knots_u", "0 control point"]),
        (changed("control_curves", 1, "knots_v", 4, to=-1.0), ["control_curves[1].knots[4]", "non-decreasing"]),
        (changed("control_curves", 1, "knots_v", 8, to=2.0), ["control_curves[1].knots[8]"]),
        (changed("control_curves", 2, "degree_v", to=4), ["control_curves[2].degree_v", "4", "3"]),
        (changed("control_curves", 2, "weights", to=[1]), ["control_curves[2].weights", "(1,)", "(4,)"]),
        (
            changed("control_curves", 0, "control_points", 1, to=[0, 0, 0, 0]),
            ["control_curves[0].control_points[1]", "4"],
        ),
        (changed("control_curves", 0, "knots_v", to=[0, 0, 2, 2]), ["control_curves[1]", "v-domain"]),
    ],
)
def test_bad_semistructured_surface_names_the_curve(change, words):
    record = surface_record(mixed_degrees())
    change(record)
    with pytest.raises(InputError) as caught:
        surface_from_record(record, "a.json")
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["not JSON", "line 1"]),
        ('{"a": 1', ["not JSON"]),
        ('{"a": NaN}', ["a: found nan", "finite"]),
        ('{"a": [-Infinity]}', ["a[0]: found -inf", "finite"]),
        ('{"a": 1, "b": 2, "a": 3}', ["'a'", "twice"]),
        ("[" * 100_000, ["nested"]),
        ('{"a": 1' + "0" * 5000 + "}", ["digits"]),
        (b"\xff\xfe\x00", [""]),
        (b'{"a": "\xe4"}', [""]),
    ],
)
def test_what_is_not_json_is_refused(tmp_path, text, words):
    path = tmp_path / "broken.json"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(FileError) as caught:
        load_json(path)
    assert str(caught.value).startswith(str(path))
    for word in words:
        assert word in str(caught.value)


def test_text_refuses_what_json_cannot_hold():
    with pytest.raises(FileError, match="finite"):
        to_text({"energy": math.nan})


def test_a_problem_keeps_surfaces_paths_and_options(tmp_path):
    folder = tmp_path / "problems"
    folder.mkdir()
    options = BlendOptions(continuity=("G2", "C1"), middle_curves=0)
    write_problem(folder / "p.json", StoredProblem(mixed_degrees(), "u1", "../parts.step#3", "v0", options))
    problem = read_problem(folder / "p.json")
    assert same(problem.a, mixed_degrees())
    assert (problem.edge_a, problem.edge_b) == ("u1", "v0")
    assert problem.b == str(folder / "../parts.step#3")
    assert problem.options == options


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (changed("edge_a", to="w0"), ["edge_a", "'w0'", "u0"]),
        (changed("a", to=5), ["a", "5"]),
        (changed("a", "degree_u", to=0), ["a", "degree_u"]),
        (changed("options", "tension", to=1), ["options.tension", "no such option"]),
        (changed("options", "middle_curves", to=1.5), ["options.middle_curves", "1.5"]),
        (changed("options", "continuity", to=["G2"]), ["options.continuity"]),
        (changed("c", to=1), ["c", "no such key"]),
    ],
)
def test_bad_problem_is_refused(tmp_path, change, words):
    path = tmp_path / "p.json"
    write_problem(path, StoredProblem(SQUARE, "u1", "b.json", "v0", BlendOptions(middle_curves=2)))
    record = json.loads(path.read_text())
    change(record)
    path.write_text(json.dumps(record))
    with pytest.raises(InputError) as caught:
        read_problem(path)
    for word in words:
        assert word in str(caught.value)


# Some go only with the fairest shape, some only without it.
STORED_OPTIONS = (
    BlendOptions(
        continuity=("G1", "C2"),
        middle_curves=2,
        degree_u=4,
        method="casadi",
        flip="yes",
        alpha=("natural", 0.5),
        box=(0.5, 2.0),
        v_scale="unit",
        u_knots=[0.25, 0.5],
        middle_knots=[[0.5], []],
        strict=True,
        limits="cad",
    ),
    BlendOptions(
        alpha=((0.5, 0.25), None),
        alpha_v="linear",
        p2=(0.5, -0.25),
        bulge=(2.0, 1.0),
        middle_knots="paper",
        match=((0.25, 0.5), (0.5, 0.75)),
        search_meets=True,
    ),
)


def test_every_option_is_stored_here():
    default = BlendOptions()
    assert all(any(getattr(o, f.name) != getattr(default, f.name) for o in STORED_OPTIONS) for f in fields(default))


@pytest.mark.parametrize("options", STORED_OPTIONS)
def test_options_come_back_as_they_were(tmp_path, options):
    write_problem(tmp_path / "p.json", StoredProblem(SQUARE, "u1", SQUARE, "v0", options))
    assert read_problem(tmp_path / "p.json").options == options


def test_bad_problem_is_not_written(tmp_path):
    path = tmp_path / "p.json"
    with pytest.raises(EdgeError, match="edge_b"):
        StoredProblem(SQUARE, "u1", SQUARE, "w")
    with pytest.raises(OptionError, match="options: found a dict, expected a BlendOptions"):
        StoredProblem(SQUARE, "u1", SQUARE, "v0", {"middle_curves": 1})
    assert not path.exists()
