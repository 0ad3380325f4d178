"""Figures 4 to 11: the surfaces behind them are those that the captions name, and the pictures are drawn."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from semispline.papers.baselines.registry import method
from semispline.papers.lin2014.examples.section5 import FIGURES
from semispline.papers.lin2014.figures import blends as figures_blends
from semispline.solver.errors import FileError, OptionError
from semispline.solver.pictures.plotting import BASE_COLOR, BLEND_COLOR, Drawn, render
from semispline.solver.splines.surfaces import BSplineSurface, SemiStructuredSurface

NAMES = [*(f"figure-{i}" for i in range(4, 12)), "figure-10-exact", "figure-11-exact"]


@pytest.mark.parametrize("figure", FIGURES)
def test_blends_have_the_rows_and_the_contact_that_the_captions_name(figure):
    result = figures_blends.figure_blend(figure)
    assert len(result.surface.control_curves) == (6 if figure in (10, 11) else 7)
    assert result.continuity == (("C2", "C2") if figure in (5, 8, 9) else ("G2", "G2"))
    for contact in (result.contact_a, result.contact_b):
        assert contact.curvature_jump_relative < 1e-8
    counts = [len(curve.control_points) for curve in result.surface.control_curves]
    first, last = {5: (5, 6), 6: (10, 8), 8: (6, 5), 9: (6, 5), 10: (10, 8), 11: (10, 64)}[figure]
    assert counts[:3] == [first] * 3
    assert counts[-3:] == [last] * 3


def test_figure_5_d_to_f_has_one_knot_vector_and_only_tangent_contact():
    task = figures_blends.common_knots_task()
    surface = method("same-knots-g1").run(task).surface
    assert isinstance(surface, BSplineSurface)
    np.testing.assert_array_equal(surface.knots_v, [0, 0, 0, 0, 0.5, 1, 1, 1, 1])
    assert surface.control_points.shape == (7, 5, 3)


def near(image, color, amount):
    """Share of the pixels whose hue is that of a colour, shaded or not."""
    wanted = np.array(to_rgb(color))
    length = np.linalg.norm(image, axis=2)
    cosine = image @ wanted / np.maximum(length * np.linalg.norm(wanted), 1e-9)
    return float(((cosine > amount) & (length > 0.15)).mean())


# With curves alone, open and closed blends with their curvature; the others are drawn in the same ways.
@pytest.mark.long
@pytest.mark.parametrize(
    "drawing",
    [
        pytest.param(d, id=d.name, marks=[] if d.name in ("figure-4", "figure-5", "figure-10") else pytest.mark.slow)
        for d in figures_blends.drawings()
    ],
)
def test_pictures_show_green_bases_and_a_red_blend(drawing, tmp_path, monkeypatch):
    monkeypatch.setattr(figures_blends, "_RENDERED", (360, 270))
    path = tmp_path / "figure.png"
    drawing.draw(path)
    image = imread(path)[..., :3]
    assert min(image.shape[:2]) > 700
    assert near(image, BASE_COLOR, 0.985) > 0.01
    assert near(image, BLEND_COLOR, 0.985) > 0.005
    # White paper, and black words.
    assert (image.min(axis=2) > 0.99).mean() > 0.2
    assert (image.max(axis=2) < 0.1).mean() > 0.0005
    if drawing.name not in ("figure-4", "figure-7"):
        # The scale of mean curvature ends in blue and in red.
        assert ((image[..., 2] > image[..., 0] + 0.3) & (image[..., 2] > 0.6)).mean() > 0.0005


def test_drawings_are_named_in_order():
    drawings = figures_blends.drawings()
    assert [d.name for d in drawings] == NAMES
    assert all(d.caption.startswith(f"Fig. {i}:") for d, i in zip(drawings, (*range(4, 12), 10, 11), strict=True))


def test_a_folder_that_is_missing_is_refused(tmp_path):
    for drawing in figures_blends.drawings():
        with pytest.raises(FileError):
            drawing.draw(tmp_path / "missing" / "figure.png")


def flat(shift):
    k = [0.0, 0, 1, 1]
    return BSplineSurface(1, 1, k, k, [[[x + shift, y, 0] for y in (0, 1)] for x in (0, 1)])


@pytest.mark.long
def test_stripes_take_the_colours_of_their_surfaces_and_show_on_planes_from_near_by(tmp_path):
    path = tmp_path / "z.png"
    scene = [Drawn(flat(0), BASE_COLOR), Drawn(flat(1), BLEND_COLOR)]
    render(scene, path, eye_distance=0.6, field="zebra", towards_eye=(0, 0, 1), size=(400, 300))
    image = imread(path)[..., :3]
    inked = image.min(axis=2) < 0.99
    columns = np.flatnonzero(inked.any(axis=0))
    middle = (columns[0] + columns[-1]) // 2
    # Seen from above, x to the right: green on the left, red on the right, each with light stripes between.
    assert near(image[:, :middle], BASE_COLOR, 0.985) > 0.05 > near(image[:, :middle], BLEND_COLOR, 0.985)
    assert near(image[:, middle + 2 :], BLEND_COLOR, 0.985) > 0.05 > near(image[:, middle + 2 :], BASE_COLOR, 0.985)
    light = (image.min(axis=2) > 0.8) & inked
    assert light.mean() > 0.02
    with pytest.raises(OptionError, match="towards_eye"):
        render([flat(0)], path, towards_eye=(0, 0, 0))


@pytest.mark.long
def test_a_tube_is_red_outside_and_blue_inside(tmp_path):
    from semispline.papers.lin2014.examples.section5 import example

    tube = example(10).a.surface
    path = tmp_path / "tube.png"
    render([tube], path, field="curvature", towards_eye=(-0.8, -1, 0.3), size=(400, 300))
    image = imread(path)[..., :3][:220]
    red = image[..., 0] > image[..., 2] + 0.2
    blue = image[..., 2] > image[..., 0] + 0.2
    assert red.mean() > 0.1
    assert blue.mean() > 0.02


def test_the_blends_are_semi_structured():
    for figure in FIGURES:
        surface = figures_blends.figure_blend(figure).surface
        assert isinstance(surface, SemiStructuredSurface)
        assert len({tuple(curve.knots) for curve in surface.control_curves}) >= 2
