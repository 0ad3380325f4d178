"""What `blend` and `check` say of contact that rounding hides, and of places without a normal; the cases of cases/."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.papers_set import blend
from semispline import (
    Base,
    BSplineCurve,
    BSplineSurface,
    ContactError,
    SemiStructuredSurface,
    measure_contact,
    read_surface,
    write_surface,
)
from semispline.solver.cli import app

CASES = Path(__file__).parents[1] / "cases"
K1, K2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def edges(a="u1", b="u0"):
    return "--edge-a", a, "--edge-b", b


def pair_of(name):
    a, b = (CASES / f"{name}_{side}.json" for side in "ab")
    return Base(read_surface(a), "v1"), Base(read_surface(b), "u1")


FAR = [
    ("vac2134", {"continuity": ("C1", "G2"), "middle_curves": 0, "v_scale": "unit"}, "b"),
    ("vac3066", {"continuity": ("G2", "C1"), "middle_curves": 1, "v_scale": "length"}, "a"),
]


@pytest.mark.parametrize(("name", "options", "side"), FAR)
def test_bases_a_millionth_as_large_as_far_away(name, options, side):
    a, b = pair_of(name)
    result = blend(a, b, **options)
    (warning,) = result.warnings
    assert warning.startswith(f"contact {side}: rounding alone may change curvature_jump_relative by 0.01")
    assert "times the size of the surfaces away" in warning
    contact = result.contact_a if side == "a" else result.contact_b
    assert 1e-3 < contact.rounding["curvature_jump_relative"] <= 0.02
    # What is measured is what the stored surfaces do: the same numbers counted from one of them, which is exact.
    base, blended = near(a if side == "a" else b, a), near(Base(result.surface, "u0" if side == "a" else "u1"), a)
    again = measure_contact(*((base, blended) if side == "a" else (blended, base)))
    # To what the worst lies above the worst sample: it is sought where it is more than rounding, and that is near only.
    assert contact.curvature_jump_relative == pytest.approx(again.curvature_jump_relative, rel=1e-5)
    assert 1e-4 < contact.curvature_jump_relative < 2e-3


@pytest.mark.parametrize(("name", "options", "side"), FAR)
def test_the_same_near_the_origin_is_exact(name, options, side):
    a, b = pair_of(name)
    result = blend(near(a, a), near(b, a), **options)
    assert not result.warnings
    contact = result.contact_a if side == "a" else result.contact_b
    assert contact.angle_degrees < 1e-9
    assert contact.curvature_jump_relative < 1e-8
    assert contact.rounding["curvature_jump_relative"] < 1e-7


def near(base, other):
    """Return a base whose control points are counted from one of another's."""
    origin, s = other.surface.control_points[0, 0], base.surface
    if isinstance(s, SemiStructuredSurface):
        curves = [BSplineCurve(c.degree, c.knots, c.control_points - origin) for c in s.control_curves]
        return Base(SemiStructuredSurface(s.degree_u, s.knots_u, curves), base.edge)
    moved = BSplineSurface(s.degree_u, s.degree_v, s.knots_u, s.knots_v, s.control_points - origin)
    return Base(moved, base.edge)


def readme_pair(offset=0.0):
    floor = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]
    wall = [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]]
    first, second = (BSplineSurface(1, 1, K1, K1, np.array(net) + offset) for net in (floor, wall))
    return Base(first, "u1"), Base(second, "u0")


@pytest.mark.parametrize("offset", [1e12, 1e14])
@pytest.mark.parametrize("continuity", ["C0", "C1", "C2", "G1", "G2"])
def test_far_away_nothing_is_promised(offset, continuity):
    with pytest.raises(ContactError, match=r"rounding alone may change .* times the size of the surfaces away"):
        blend(*readme_pair(offset), continuity=continuity)


@pytest.mark.long
def test_from_far_to_near_refused_warned_and_exact():
    ends = []
    for exponent in range(4, 13):
        try:
            ends.append(1 if blend(*readme_pair(10.0**exponent)).warnings else 0)
        except ContactError:
            ends.append(2)
    # Rounding of second derivatives: 1e-16 times the distance, over 1e-3 of the size, a thousandfold by short spans.
    assert ends == [0, 0, 0, 0, 1, 2, 2, 2, 2]


@pytest.mark.parametrize("options", [{"alpha": 3e-8}, {"box": (1e-15, 1e-14)}, {"alpha": ("natural", 1e-5)}])
def test_shape_parameters_that_leave_no_direction(options):
    with pytest.raises(ContactError, match="all but degenerate where it meets the base, its shape parameter is"):
        blend(*readme_pair(), **options)


def write_pair(folder, a, b):
    write_surface(folder / "a.json", a)
    write_surface(folder / "b.json", b)
    return folder / "a.json", folder / "b.json"


def test_refusal_ends_the_command_with_3(tmp_path):
    a, b = readme_pair(1e12)
    files = write_pair(tmp_path, a.surface, b.surface)
    done = run("blend", *files, *edges(), "-o", tmp_path / "c.json", "--report", tmp_path / "r.json")
    assert done.exit_code == 3
    assert "work in coordinates nearer to it" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.json", "b.json"]


def test_the_report_holds_what_was_allowed(tmp_path):
    out, report = tmp_path / "c.json", tmp_path / "r.json"
    files = CASES / "vac2134_a.json", CASES / "vac2134_b.json"
    options = (
        "--continuity",
        "C1",
        "--continuity-b",
        "G2",
        "--middle-curves",
        0,
        "--v-scale",
        "unit",
        "--alpha",
        "energy",
    )
    done = run("blend", *files, *edges("v1", "u1"), *options, "--alpha", "energy", "-o", out, "--report", report)
    assert done.exit_code == 0
    assert "warning: contact b: rounding alone" in done.stderr
    assert "relative curvature jump 0.0017 (0.013 allowed)" in done.stdout
    contact = json.loads(report.read_text())["contact_b"]
    # Less than what errors of first and second derivatives could do one by one, 0.017: they are of the same points.
    assert contact["allowed"]["curvature_jump_relative"] == pytest.approx(0.0130, rel=0.01)
    assert set(contact["allowed"]) == set(contact["rounding"]) <= set(contact)
    assert contact["no_normal"] == []
    done = run("check", out, files[1], *edges("u1", "u1"), "--require", "G2", "--json", "-")
    assert done.exit_code == 0
    record = json.loads(done.stdout)
    assert record["meets"] is True
    (doubt,) = record["doubts"]
    assert doubt.startswith("rounding alone may change curvature_jump_relative by 0.013")


def strip(start, end, offset=0.0, tilt=0.0):
    net = [[[x, y, tilt * (x - start)] for y in (0.0, 1.0)] for x in (start, end)]
    return BSplineSurface(1, 1, K1, K1, np.array(net) + offset)


# Strips 1 wide, from 0 to 1 and from 1 to 2, moved along all axes. Both control points of a cross derivative round by
# half a spacing of floats each way: 2 sqrt(3) 2^-53 times the distance on each side. The derivative along the edge is
# the same on both sides: what it rounds by makes no angle.
@pytest.mark.parametrize(
    ("offset", "require", "tilt", "status", "answer"),
    [
        (0, "G1", 0, 0, "G1: yes"),
        (2.0**30, "G1", 0, 0, "G1: yes"),  # 7e-5 degrees
        (2.0**35, "G1", 0, 0, "; rounding alone may change angle_degrees by 0.0015"),
        (2.0**40, "G1", 0, 3, "G1 cannot be told"),  # 0.07 degrees
        (2.0**40, "G1", 2.0**-5, 1, "G1: no"),  # 1.8 degrees
        (2.0**40, "G1", 2.0**-11, 3, "G1 cannot be told"),  # 0.03 degrees
        (2.0**40, "C0", 0, 3, "C0 cannot be told"),  # a gap of 4e-4 of the size, 2
    ],
)
def test_check_tells_what_can_be_told(tmp_path, offset, require, tilt, status, answer):
    files = write_pair(tmp_path, strip(0, 1, offset), strip(1, 2, offset, tilt))
    done = run("check", *files, *edges(), "--require", require, "--json", tmp_path / "k.json")
    assert done.exit_code == status
    assert answer in (done.stderr if status == 3 else done.stdout)
    if answer.endswith("yes"):
        assert done.stdout.splitlines()[-1] == answer
    assert (tmp_path / "k.json").exists() is (status != 3)
    # Without a question there are figures.
    done = run("check", *files, *edges())
    assert done.exit_code == 0
    assert done.stdout.split()[:5] == ["measure", "maximum", "mean", "limit", "unit"]


def cusp(at=0.44):
    """From the edge x = 0 along x by (v - at)^2: no normal at v = at, which no sample meets."""
    lengths = at**2, at**2 - at, (1 - at) ** 2
    net = [[[x * q, y, 0.0] for y, q in zip((0, 0.5, 1), lengths, strict=True)] for x in (0.0, 1.0)]
    return BSplineSurface(1, 2, K1, K2, net)


def test_yes_is_qualified_by_a_place_without_a_normal(tmp_path):
    flat = BSplineSurface(1, 2, K1, K2, [[[x, y, 0.0] for y in (0, 0.5, 1)] for x in (-1.0, 0.0)])
    files = write_pair(tmp_path, flat, cusp())
    done = run("check", *files, *edges(), "--require", "G2")
    assert done.exit_code == 0
    place = "no proper normal at parameter 0.44, (0, 0.44, 0): the derivative across the edge vanishes"
    assert done.stdout.splitlines()[-2:] == [f"B: {place}", f"G2: yes, but B has {place}"]
    done = run("check", *files, *edges(), "--require", "G2", "--json", "-")
    record = json.loads(done.stdout)
    assert record["doubts"] == [f"B has {place}"]
    (found,) = record["no_normal"]
    assert (found["surface"], found["reason"]) == ("b", "the derivative across the edge vanishes")
    assert found["parameter"] == pytest.approx(0.44)
    # Contact of points and derivatives needs no normal.
    done = run("check", *files, *edges(), "--require", "C0")
    assert done.stdout.splitlines()[-1] == "C0: yes"


def test_a_place_without_a_normal_is_left_out_whether_a_sample_meets_it_or_not(tmp_path):
    flat = BSplineSurface(1, 2, K1, K2, [[[x, y, 0.0] for y in (0, 0.5, 1)] for x in (-1.0, 0.0)])
    files = write_pair(tmp_path, flat, cusp(0.5))
    done = run("check", *files, *edges(), "--require", "G1", "--json", "-")
    assert done.exit_code == 0
    record = json.loads(done.stdout)
    assert record["angle_degrees"] == 0
    assert record["misses"] == []
    assert record["doubts"][0].startswith("B has no proper normal at parameter 0.5,")


def fan(*corner):
    """A flat triangle: the origin, (3, 0, 0) and a corner; the edge u0 runs from the first to the second."""
    return BSplineSurface(1, 1, K1, K1, [[[0, 0, 0], [3, 0, 0]], [[0, 0, 0], corner]])


def test_along_an_edge_from_a_pole_measures_are_those_away_from_it(tmp_path):
    t = np.radians(30)
    files = write_pair(tmp_path, fan(0, 3, 0), fan(0, -3 * np.cos(t), 3 * np.sin(t)))
    done = run("check", *files, "--edge-a", "u0", "--edge-b", "u0", "--require", "G1", "--json", "-")
    assert done.exit_code == 1
    record = json.loads(done.stdout)
    # That in the pole, and that just inside of the edge; the next is a four hundredth of it away.
    assert record["left_out"] == sum(s < 5e-4 for s in record["profile"]["parameter"]) == 2
    assert record["angle_degrees"] == pytest.approx(30)
    assert record["mean"]["angle_degrees"] == pytest.approx(30)
    assert record["curvature_jump_relative"] == pytest.approx(0, abs=1e-9)
    assert record["profile"]["angle_degrees"][:3] == [None, None, pytest.approx(30)]
    assert None not in record["profile"]["gap"]
    assert [place["parameter"] for place in record["no_normal"]] == [0, 0]
    done = run("check", *files, "--edge-a", "u0", "--edge-b", "u0")
    said = f"left out: 2 of {len(record['profile']['gap'])} places, where a side has no proper normal"
    assert said in done.stdout.splitlines()


def wedge(first, last):
    """Of a ball of radius 3, from a quarter's meridian at one angle to that at another; v runs to the pole."""
    half = (last - first) / 2
    turns = ((first, 1.0), (first + half, np.cos(half)), (last, 1.0))
    arc, weights = np.array([[3.0, 0], [3, 3], [0, 3]]), np.array([1, np.sqrt(0.5), 1])
    net = [[[r / w * np.cos(t), r / w * np.sin(t), z] for r, z in arc] for t, w in turns]
    return BSplineSurface(2, 2, K2, K2, net, np.outer([w for _, w in turns], weights))


def test_beside_a_pole_rounding_is_no_jump(tmp_path):
    files = write_pair(tmp_path, wedge(0.0, 1.0), wedge(1.0, 2.2))
    done = run("check", *files, "--edge-a", "u1", "--edge-b", "u0", "--require", "G2", "--json", "-")
    record = json.loads(done.stdout)
    assert record["misses"] == []
    assert done.exit_code == 0
    assert record["left_out"] == 1
    assert all(place["parameter"] == pytest.approx(1) for place in record["no_normal"])


def test_where_no_place_has_a_normal_nothing_is_said(tmp_path):
    """An edge that is a point has none anywhere."""
    files = write_pair(tmp_path, fan(0, 3, 0), fan(0, -3, 0))
    done = run("check", *files, "--edge-a", "v0", "--edge-b", "v0", "--require", "G1")
    assert done.exit_code == 1
    assert "angle degrees does not exist where there is no normal" in done.stdout


def test_a_blend_of_a_base_without_a_normal_somewhere_says_so():
    far = BSplineSurface(1, 2, K1, K2, [[[x, y, 1.0] for y in (0, 0.5, 1)] for x in (-3.0, -2.0)])
    result = blend(Base(cusp(), "u0"), Base(far, "u1"), continuity=("G1", "C1"))
    assert any(text.startswith("base a: no proper normal at parameter 0.44") for text in result.warnings)
