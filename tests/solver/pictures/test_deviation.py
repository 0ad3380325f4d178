"""Distances from a face, against those that are known."""

import numpy as np
import pytest
from matplotlib.image import imread
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.gp import gp_Pnt
from typer.testing import CliRunner

from helpers.circles import cylinder, full_circle
from helpers.drilled import drilled
from helpers.parts import written
from semispline import BSplineSurface, plane, write_surface
from semispline.solver.cli import app
from semispline.solver.pictures.deviation import TrueFace, measure_deviation
from semispline.solver.pictures.samples import sample
from semispline.solver.topology import read_drawn, read_true_face

pytestmark = pytest.mark.usefixtures("read_here")


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def true_face(path):
    return TrueFace(read_true_face(str(path)))


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    """A block of 8 with a round hole of radius 1 through its middle, upright; and the number of its top."""
    shape = drilled(BRepPrimAPI_MakeBox(gp_Pnt(-4, -4, -4), gp_Pnt(4, 4, 4)).Shape(), tilt=(0, 0, 1))
    path = written(shape, tmp_path_factory.mktemp("block") / "block.brep")
    faces, _ = read_drawn([str(path)])
    (top,) = (face.number for face in faces if all(np.allclose(edge.points[:, 2], 4) for edge in face.edges))
    return path, top


def test_distances_from_a_trimmed_face_end_at_its_border(block):
    path, top = block
    face = true_face(f"{path}#{top}")
    points = np.array([[3, 0, 5.5], [3, 0, 2], [0, 0, 4], [0.5, 0, 4], [0, 0, 6], [7, 0, 8], [0, 5, 4.0]])
    # Above and below the face; over its hole, at the distance of the rim; beyond an edge.
    expected = [1.5, 2, 1, 0.5, np.hypot(1, 2), 5, 1]
    # Cubic pieces of the rim keep to it within a millionth.
    np.testing.assert_allclose(face.distances(points), expected, atol=1e-5)
    assert face.name == f"block.brep#{top}"


def test_far_from_the_origin_nothing_is_lost(tmp_path):
    far = np.array([1e6, -2e6, 3e6])
    write_surface(tmp_path / "a.json", plane(far, [4, 0, 0], [0, 4, 0]))
    points = far + np.array([[1, 1, 1e-3], [2, 3, -2e-3], [2, 7, 0]])
    # Roundings of a coordinate of 3e6.
    np.testing.assert_allclose(true_face(tmp_path / "a.json").distances(points), [1e-3, 2e-3, 3], atol=5e-9)


@pytest.mark.long
def test_a_pipe_around_a_pipe(tmp_path):
    write_surface(tmp_path / "pipe.json", cylinder(full_circle(4)))
    face = true_face(tmp_path / "pipe.json")
    wide = cylinder(full_circle(3), radius=1.25, heights=(-0.5, 0.5))
    (samples,) = sample([wide], [None])
    found = measure_deviation([samples], [face.distances(samples.points)])
    assert found.largest == pytest.approx(np.hypot(0.25, 0.5), rel=1e-9)
    assert found.at[2] == pytest.approx(-0.5)
    h = np.linspace(0, 0.5, 20001)
    below = float(np.trapezoid(np.hypot(0.25, h), h)) / 0.5
    assert found.mean == pytest.approx((below + 0.25) / 2, rel=1e-3)


@pytest.fixture
def pair(tmp_path):
    """A square, and one that rises from it to 0.5."""
    k = [0, 0, 1, 1]
    for name, top in (("true", 0.0), ("blend", 0.5)):
        net = [[[x, y, x * top / 4] for y in (0.0, 4.0)] for x in (0.0, 4.0)]
        write_surface(tmp_path / f"{name}.step", BSplineSurface(1, 1, k, k, net), "mm")
    return tmp_path / "blend.step", tmp_path / "true.step"


@pytest.mark.long
def test_show_says_and_colors_the_distance(pair, tmp_path):
    blend, true = pair
    out = tmp_path / "p.png"
    done = run("show", blend, "--deviation-from", true, "-o", out)
    assert done.exit_code == 0
    assert done.stdout.startswith(f"distance from {true}: largest 0.5 mm at (4, ")
    assert "mean 0.25 mm" in done.stdout
    image = np.rint(imread(out)[..., :3] * 255).astype(int)
    dark, yellow = (
        (np.abs(image - np.array(color)) < 60).all(axis=2).mean() for color in ((68, 1, 84), (253, 231, 37))
    )
    assert min(dark, yellow) > 0.005
    # Beside another surface it is said whose distance that is.
    assert "surfaces" not in done.stdout
    write_surface(tmp_path / "flat.step", plane([0, 0, 0.1], [4, 0, 0], [0, 4, 0]), "mm")
    for order in ((blend, tmp_path / "flat.step"), (tmp_path / "flat.step", blend)):
        done = run("show", *order, "--deviation-from", true, "-o", out)
        assert f"; of 2 surfaces the largest is on {blend}\n" in done.stdout
    # With a view in units of its own: the same square in inches.
    write_surface(tmp_path / "inch.step", plane([0, 0, 0], [4 / 25.4, 0, 0], [0, 4 / 25.4, 0]), "in")
    done = run("show", blend, "--deviation-from", tmp_path / "inch.step", "-o", out)
    assert "largest 0.5 mm" in done.stdout


@pytest.mark.long
def test_the_file_of_the_true_face_stands_around(block, tmp_path):
    write_surface(tmp_path / "lid.step", plane([-2, -2, 5], [4, 0, 0], [0, 4, 0]), "mm")
    path, number = block
    top = f"{path}#{number}"
    done = run("show", path, tmp_path / "lid.step", "--deviation-from", top, "-o", tmp_path / "p.png")
    assert done.exit_code == 0
    # Over the middle of the hole.
    assert f"largest {np.sqrt(2):.3g}" in done.stdout
    # Of the file alone nothing is left to measure; another of its faces is.
    done = run("show", path, "--deviation-from", top, "-o", tmp_path / "q.png")
    assert done.exit_code == 2
    assert "found nothing but" in done.stderr
    done = run("show", f"{path}#{(number + 1) % 7}", "--deviation-from", top, "-o", tmp_path / "q.png")
    assert (done.exit_code, (tmp_path / "q.png").exists()) == (0, True)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--deviation-from", "true.step", "--color", "zebra"], "found it together with --deviation-from"),
        (["--deviation-from", "none.step"], "no such file"),
        (["--deviation-from", "true.step#3"], "no such surface"),
        (["--deviation-from", "true.step#x"], "expected the number of a surface"),
        (["--views", "iso,below"], "found 'below', expected some of iso"),
    ],
)
def test_wrong_calls_are_refused_and_nothing_is_written(pair, tmp_path, monkeypatch, options, message):
    monkeypatch.chdir(tmp_path)
    done = run("show", pair[0], "-o", "p.png", *options)
    assert (done.exit_code, done.stdout) == (2, "")
    assert message in done.stderr
    assert not (tmp_path / "p.png").exists()


def test_the_true_face_is_not_written_over(pair):
    blend, true = pair
    before = true.read_bytes()
    done = run("show", blend, "--deviation-from", true, "-o", true)
    assert done.exit_code == 2
    assert true.read_bytes() == before
