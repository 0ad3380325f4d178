import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import rhino3dm
from matplotlib.image import imread
from typer.testing import CliRunner

from semispline import BSplineCurve, BSplineSurface, FileError, OptionError, SemiStructuredSurface, revolve
from semispline.solver.cli import app
from semispline.solver.io.meshes import sampled
from semispline.solver.io.surface_files import write_surface
from semispline.solver.judge.curvature import zebra
from semispline.solver.pictures.fields import STRIPES, field_values
from semispline.solver.pictures.plotting import BASE_COLOR, BLEND_COLOR, CURVE_COLORS, Drawn, Picture, render
from semispline.solver.pictures.samples import Sampled
from semispline.solver.pictures.views import View, line_of_sight
from semispline.solver.topology.drawn_faces import natural_edges
from semispline.solver.topology.face_meshes import grid_within

pytestmark = pytest.mark.usefixtures("read_here")

SIZE = (320, 240)
K = [0.0, 0.0, 1.0, 1.0]
CUBE = [0.0, 0, 0, 0, 1, 1, 1, 1]


def flat(shift=0.0):
    return BSplineSurface(1, 1, K, K, [[[x + shift, y, 0] for y in (0, 1)] for x in (0, 1)])


def wave():
    x, y = np.meshgrid(np.linspace(0, 3, 4), np.linspace(0, 2, 4), indexing="ij")
    return BSplineSurface(3, 3, CUBE, CUBE, np.stack([x, y, np.sin(3 * x) * np.cos(2 * y)], axis=-1))


def quarter(radius=2.0):
    """A quarter of a cylinder about z, exactly."""
    net = radius * np.array([[[1, 0, 0], [1, 0, 2]], [[1, 1, 0], [1, 1, 2]], [[0, 1, 0], [0, 1, 2.0]]])
    half = np.sqrt(0.5)
    return BSplineSurface(2, 1, [0, 0, 0, 1, 1, 1], K, net, [[1, 1], [half, half], [1, 1]])


def semistructured():
    low = BSplineCurve(1, K, [[0, 0, 0], [0, 1, 0]])
    high = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[1, 0, 0], [1, 0.5, 0.5], [1, 1, 0]])
    return SemiStructuredSurface(1, K, (low, high))


def pixels(path):
    return np.rint(imread(path)[..., :3] * 255).astype(int)


def share(image, mask):
    return float(mask(*np.moveaxis(image, -1, 0)).mean())


def white(r, g, b):
    return (r > 250) & (g > 250) & (b > 250)


@pytest.mark.long
def test_bases_are_green_the_blend_red_on_white(tmp_path):
    path = tmp_path / "p.png"
    colors = BASE_COLOR, BLEND_COLOR, BASE_COLOR
    render([Drawn(flat(float(k)), color) for k, color in enumerate(colors)], path, size=SIZE)
    image = pixels(path)
    assert image.shape == (240, 320, 3)
    green = share(image, lambda r, g, b: (g > 1.5 * r) & (g > 1.3 * b))
    red = share(image, lambda r, g, b: (r > 2 * g) & (r > 2 * b))
    # Two squares against one, and a margin all around.
    assert 1.8 < green / red < 2.2
    assert green + red > 0.25
    edge = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
    assert white(*edge.T).all()
    # The longest extent fills the width.
    columns = np.flatnonzero((~white(*np.moveaxis(image, -1, 0))).any(axis=0))
    assert len(columns) > 0.85 * 320


@pytest.mark.long
def test_every_control_curve_is_seen_in_its_own_color(tmp_path):
    path = tmp_path / "p.png"
    render([Drawn(semistructured(), BLEND_COLOR, control_points=True)], path, size=(800, 600))
    image = pixels(path)
    for color in CURVE_COLORS[:2]:
        wanted = np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)])
        near = np.abs(image - wanted).max(axis=2) < 40
        assert near.sum() > 20, color


@pytest.mark.parametrize("field", ["curvature", "gaussian", "zebra", "isophotes"])
def test_fields_are_drawn(tmp_path, field):
    path = tmp_path / "p.png"
    render([wave()], path, field=field, size=SIZE)
    image = pixels(path)
    if field in ("curvature", "gaussian"):
        # Both ends of the scale.
        assert share(image, lambda r, g, b: r > b + 60) > 0.002
        assert share(image, lambda r, g, b: b > r + 60) > 0.002
    else:
        dark = share(image, lambda r, g, b: r < 80)
        assert 0.05 < dark < 0.5
        light = share(image, lambda r, g, b: (r > 150) & ~white(r, g, b))
        assert light > 0.05


def test_a_plane_shows_one_stripe(tmp_path):
    path = tmp_path / "p.png"
    render([flat()], path, field="zebra", size=SIZE)
    image = pixels(path)
    middle = image[90:150, 130:190].reshape(-1, 3)
    assert np.ptp(middle, axis=0).max() < 10


def view_of(item):
    right, up, towards_eye = line_of_sight([(item.geometry.point, item.normal, item.area)])
    return View(towards_eye, right, up)


def values(surface, field):
    item = Sampled(*sampled(surface, 16))
    view = view_of(item)
    return field_values(item, field, view), item, view


def test_the_stripes_of_a_picture_are_those_of_the_library():
    item = Sampled(*sampled(wave(), 16))
    view = replace(view_of(item), eye=np.array([1.0, 2.0, 9.0]))
    angle = field_values(item, "zebra", view)
    # The picture cuts 180 degrees into bands, dark and light by turns.
    light = np.floor(angle / (180 / STRIPES)) % 2
    stripes = zebra(item.geometry.point, item.normal, view.eye, axis=view.right + view.up)
    assert 0.2 < light.mean() < 0.8
    np.testing.assert_array_equal(light, stripes)


def test_curvature_is_exact_and_positive_where_it_bulges():
    found, item, view = values(quarter(2.0), "curvature")
    outwards = float(np.mean(item.geometry.point[..., :2] @ view.towards_eye[:2]))
    # The quarter is seen from outside or from inside, as the camera stands.
    np.testing.assert_allclose(found, np.sign(outwards) / 4, rtol=1e-12)
    np.testing.assert_allclose(values(quarter(2.0), "gaussian")[0], 0.0, atol=1e-14)


def test_orientation_does_not_change_the_colors():
    there = wave()
    back = BSplineSurface(3, 3, CUBE, CUBE, there.control_points[::-1])
    for field in ("curvature", "gaussian", "zebra", "isophotes"):
        a, b = values(there, field)[0], values(back, field)[0]
        np.testing.assert_allclose(a, b[::-1], rtol=1e-9, atol=1e-9)


def test_the_camera_looks_at_the_broad_side():
    for rotation in (
        np.eye(3),
        np.roll(np.eye(3), 1, axis=0),
        np.linalg.qr(np.arange(9.0).reshape(3, 3) + np.eye(3))[0],
    ):
        turned = BSplineSurface(1, 1, K, K, flat().control_points * (3, 1, 1) @ rotation.T)
        _, item, view = values(turned, "zebra")
        assert abs(item.normal[0, 0] @ view.towards_eye) > 0.7
        np.testing.assert_allclose([view.right @ view.up, view.right @ view.towards_eye], 0, atol=1e-15)
        # The longer side lies across the picture.
        long_side = np.ptp(item.geometry.point @ view.right)
        assert long_side > np.ptp(item.geometry.point @ view.up)


def test_a_picture_that_cannot_be_made_leaves_the_old_one(tmp_path, monkeypatch):
    path = tmp_path / "p.png"
    path.write_text("old")
    with pytest.raises(OptionError, match="expected one of curvature, gaussian"):
        render([flat()], path, field="rainbow")
    with pytest.raises(OptionError, match="none"):
        render([], path)
    with pytest.raises(OptionError, match="coincide"):
        render([BSplineSurface(1, 1, K, K, np.ones((2, 2, 3)))], path)
    with pytest.raises(OptionError, match=r"\.png"):
        render([flat()], tmp_path / "p.gif")
    with pytest.raises(FileError, match="does not exist"):
        render([flat()], tmp_path / "none" / "p.png", size=SIZE)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(FileError, match=r"semispline\[view\]"):
        render([flat()], path)
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["p.png"]


@pytest.mark.long
def test_degenerate_surfaces_can_be_drawn(tmp_path):
    collapsed = wave().control_points.copy()
    collapsed[0] = collapsed[0, 0]
    line = BSplineSurface(1, 1, K, K, [[[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [1, 0, 0]]])
    for surface in (BSplineSurface(3, 3, CUBE, CUBE, collapsed), flat(1e6)):
        render([surface], tmp_path / "p.png", field="curvature", size=SIZE)
        assert share(pixels(tmp_path / "p.png"), white) < 0.95
    with pytest.raises(FileError, match="no area"):
        render([line], tmp_path / "q.png", size=SIZE)


@pytest.mark.long
def test_show_without_a_display_says_nothing(tmp_path):
    """In a process of its own: VTK warns on standard error when it looks for a display."""
    write_surface(tmp_path / "a.json", wave())
    write_surface(tmp_path / "b.json", semistructured())
    environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    words = ["show", "a.json", "b.json", "-o", "p.png", "--control-points"]
    done = subprocess.run(
        [sys.executable, "-c", "from semispline.papers.cli import main; main()", *words],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
        env=environment,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert pixels(tmp_path / "p.png").shape == (1200, 1600, 3)


def test_show_takes_every_surface_of_a_file(tmp_path, monkeypatch):
    drawn = []

    def instead(surfaces, out, **options):
        drawn.append((surfaces, options))
        return Picture((), 0, None)

    monkeypatch.setattr("semispline.solver.pictures.render", instead)
    file = rhino3dm.File3dm()
    for _ in range(3):
        file.Objects.AddSurface(rhino3dm.NurbsSurface.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 1.0)))
    assert file.Write(str(tmp_path / "s.3dm"), 0)
    out = ["-o", str(tmp_path / "p.png")]

    def shown(*words):
        assert CliRunner().invoke(app, ["show", *words, *out]).exit_code == 0
        return drawn[-1]

    whole, one = str(tmp_path / "s.3dm"), f"{tmp_path / 's.3dm'}#1"
    surfaces, options = shown(whole, "--color", "zebra")
    assert (len(surfaces), options["field"], options["views"]) == (3, "zebra", ())
    assert not any(item.label or item.name_edges for item in surfaces)
    surfaces, options = shown(one, "--views", "top,iso")
    assert (len(surfaces), options["field"], options["views"]) == (1, None, ("top", "iso"))
    # Edges are named of one face, or of each where that is asked for.
    assert [(item.label, item.name_edges) for item in shown(one, "--labels")[0]] == [("#1", True)]
    assert {item.name_edges for item in shown(whole, "--labels")[0]} == {False}
    surfaces, options = shown(whole, "--labels", "--edges")
    assert [(item.label, item.name_edges) for item in surfaces] == [(f"#{n}", True) for n in range(3)]
    assert options["heavy_edges"]
    # Of several files with the names of the files, and many surfaces are a part that stands upright.
    write_surface(tmp_path / "b.json", wave())
    surfaces, _ = shown(whole, str(tmp_path / "b.json"), "--labels")
    assert [item.label for item in surfaces] == ["s#0", "s#1", "s#2", "b"]
    copies = []
    for k in range(3):
        copies.append(tmp_path / f"c{k}.3dm")
        assert file.Write(str(copies[-1]), 0)
    assert shown(*map(str, copies))[1]["views"] == ("iso",)


def colored(path, color):
    """The pixels of a colour that is shaded, as columns and rows."""
    wanted = np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)])
    image = pixels(path)
    scaled = image @ wanted / (wanted @ wanted)
    near = np.abs(image - scaled[..., None] * wanted).max(axis=2) < 25
    rows, columns = np.nonzero(near & (image.max(axis=2) > 60) & ~white(*np.moveaxis(image, -1, 0)))
    return columns, rows


@pytest.mark.long
def test_each_view_has_its_place_and_its_side(tmp_path):
    # A red wall at the left of a green floor: from the front, from above.
    floor = BSplineSurface(1, 1, K, K, [[[x, y, 0] for y in (0, 4.0)] for x in (0, 4.0)])
    wall = BSplineSurface(1, 1, K, K, [[[x, 4.0, z] for z in (0, 3.0)] for x in (0, 1.0)])
    path = tmp_path / "p.png"
    found = render(
        [Drawn(floor, BASE_COLOR), Drawn(wall, BLEND_COLOR)], path, views=("front", "top", "left"), size=SIZE
    )
    assert found.unseen == ()
    assert pixels(path).shape == (480, 640, 3)
    columns, rows = colored(path, BLEND_COLOR)
    front = (columns < 320) & (rows < 240)
    # From the front it stands at the left; from above and from the side it is a line.
    assert front.mean() > 0.9
    assert columns[front].max() < 200
    columns, rows = colored(path, BASE_COLOR)
    assert ((columns >= 320) & (rows < 240)).mean() > 0.9


@pytest.mark.long
def test_names_stand_where_faces_are_seen(tmp_path):
    near = BSplineSurface(1, 1, K, K, [[[x, y, 1.0] for y in (0, 4.0)] for x in (0, 4.0)])
    # Hidden in part, and wholly.
    far = BSplineSurface(1, 1, K, K, [[[x, y, 0.0] for y in (0, 4.0)] for x in (2.0, 12.0)])
    under = BSplineSurface(1, 1, K, K, [[[x, y, -1.0] for y in (1, 2.0)] for x in (1.0, 2.0)])
    items = [
        Drawn(near, BASE_COLOR, label="#0"),
        Drawn(far, BLEND_COLOR, label="#1"),
        Drawn(under, "#0072b2", label="#2"),
    ]
    path, plain = tmp_path / "p.png", tmp_path / "q.png"
    found = render(items, path, views=("top",), size=SIZE)
    assert found.unseen == ("#2",)
    render([replace(item, label="") for item in items], plain, views=("top",), size=SIZE)
    changed = np.abs(pixels(path) - pixels(plain)).max(axis=2) > 40
    _, columns = np.nonzero(changed)
    # Of the model's 12 units: the names at 2 and at 8.
    middles = np.array([2.0, 8.0]) / 12 * 320 / 1.06 + 160 - 160 / 1.06
    for middle in middles:
        assert (np.abs(columns - middle) < 20).sum() > 20
    assert (np.abs(columns[:, None] - middles).min(axis=1) < 20).all()


@pytest.mark.long
def test_edges_of_one_face_are_all_named(tmp_path):
    lines = natural_edges(flat())
    found = render(
        [Drawn(flat(), label="a", edges=lines, name_edges=True)], tmp_path / "p.png", views=("top",), size=SIZE
    )
    assert (found.unseen, found.unnamed_edges) == ((), 0)
    # From the side neither the face nor an edge of it is seen.
    found = render(
        [Drawn(flat(), label="a", edges=lines, name_edges=True)], tmp_path / "p.png", views=("left",), size=SIZE
    )
    assert (found.unseen, found.unnamed_edges) == (("a",), 4)


@pytest.mark.long
def test_edges_behind_their_own_face_are_not_named(tmp_path):
    # Of a whole cylinder about z that begins at x = 1: from the left the seam is behind the face that it closes.
    wall = revolve(BSplineCurve(1, K, [[1.0, 0, 0], [1, 0, 2]]), [0, 0, 0], [0, 0, 1])
    item = Drawn(wall, label="#0", edges=natural_edges(wall), name_edges=True)
    hidden = {
        view: render([item], tmp_path / "p.png", views=(view,), size=SIZE).unnamed_edges for view in ("right", "left")
    }
    assert hidden == {"right": 0, "left": 2}


@pytest.mark.long
def test_what_is_trimmed_away_is_not_drawn(tmp_path):
    half = np.array([[0.0, 0], [0.5, 0], [0.5, 1], [0, 1]])
    mesh = grid_within(flat(), [half], [False, False])
    shares = []
    for part in (None, mesh):
        render([Drawn(flat(), BASE_COLOR, mesh=part), Drawn(flat(1.0), BLEND_COLOR)], tmp_path / "p.png", size=SIZE)
        shares.append(len(colored(tmp_path / "p.png", BASE_COLOR)[0]))
    assert shares[1] / shares[0] == pytest.approx(0.5, abs=0.05)
