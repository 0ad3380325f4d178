"""Figures 1 to 3: the surfaces behind them have the printed counts, and the pictures are drawn."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.image import imread

from helpers.sweeps import first_ones
from semispline.derivations.trimming import boundary_residual
from semispline.papers.lin2014.figures import bezier as figures
from semispline.solver.errors import FileError
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines.surfaces import BSplineSurface, SemiStructuredSurface


def test_figure_1_has_the_printed_counts():
    surface = figures.figure_1_surface()
    assert [len(curve.control_points) for curve in surface.control_curves] == [5, 5, 5, 7, 6, 6, 6]
    assert len({tuple(curve.knots) for curve in surface.control_curves}) == 7


def test_the_trimmed_patch_has_four_pieces_of_each_kind_on_the_patch():
    assert boundary_residual(figures.TRIMMING_CURVES) == {}
    pieces = figures.trimmed_patch()
    counts = {name: [len(c.control_points) for c in pieces[name].control_curves] for name in ("Q1", "Q2", "Q3", "Q4")}
    assert counts == {"Q1": [4, 6, 8, 10], "Q2": [7, 6, 5, 4], "Q3": [4, 7, 10, 13], "Q4": [13, 10, 7, 4]}
    assert all(isinstance(pieces[name], BSplineSurface) for name in ("P1", "P2", "P3", "P4"))
    # x / 2.4 and y / 2 of this patch are u and v, so the height tells whether a point lies on it.
    for piece in pieces.values():
        assert isinstance(piece, SemiStructuredSurface | BSplineSurface)
        (u0, u1), (v0, v1) = piece.domain
        points = piece.evaluate_grid(np.linspace(u0, u1, 9), np.linspace(v0, v1, 9)).reshape(-1, 3)
        u, v = np.clip(points[:, 0] / 2.4, 0, 1), np.clip(points[:, 1] / 2, 0, 1)
        np.testing.assert_allclose(surface_points(figures.bicubic_patch(), u, v), points, atol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("name", first_ones(2, ["draw_figure_1", "draw_trimmed_patch", "draw_figure_2"]))
def test_pictures_are_drawn_in_colour(name, tmp_path, monkeypatch):
    # Small renderings: software rendering takes most of the time.
    monkeypatch.setattr(figures, "_RENDERED", (480, 360))
    path = tmp_path / "figure.png"
    getattr(figures, name)(path)
    image = imread(path)[..., :3]
    assert min(image.shape[:2]) > 1000
    # Black text and lines, white paper, and colours that are far from grey.
    spread = np.ptp(image, axis=2)
    assert (image.max(axis=2) < 0.1).mean() > 0.001
    assert (image.min(axis=2) > 0.99).mean() > 0.2
    assert (spread > 0.3).mean() > 0.001


def test_a_folder_that_is_missing_is_refused(tmp_path):
    with pytest.raises(FileError):
        figures.draw_figure_1(tmp_path / "missing" / "figure.png")
