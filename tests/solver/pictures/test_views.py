"""Named views, what a picture shows of space, and several views in one picture."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from semispline import OptionError
from semispline.solver.pictures.views import cells, framed, named_view, parsed_views, view_from

pytestmark = pytest.mark.usefixtures("read_here")

UNIT = st.floats(-1, 1)


@pytest.mark.parametrize(
    ("name", "right", "up"),
    [
        ("front", (1, 0, 0), (0, 0, 1)),
        ("back", (-1, 0, 0), (0, 0, 1)),
        ("left", (0, -1, 0), (0, 0, 1)),
        ("right", (0, 1, 0), (0, 0, 1)),
        ("top", (1, 0, 0), (0, 1, 0)),
        ("bottom", (-1, 0, 0), (0, 1, 0)),
    ],
)
def test_views_lie_as_in_a_drawing(name, right, up):
    view = named_view(name)
    np.testing.assert_allclose(view.right, right, atol=1e-15)
    np.testing.assert_allclose(view.up, up, atol=1e-15)
    # The three are a right-handed frame.
    np.testing.assert_allclose(np.cross(view.right, view.up), view.towards_eye, atol=1e-15)


def test_iso_shows_front_right_and_top():
    view = named_view("iso")
    assert min(view.towards_eye @ named_view(name).towards_eye for name in ("front", "right", "top")) > 0.5
    assert view.up[2] > 0.8


@given(st.lists(st.tuples(UNIT, UNIT, UNIT), min_size=2, max_size=6), st.sampled_from([(400, 300), (300, 500)]))
def test_all_points_are_inside_of_the_frame(points, size):
    frame = framed(np.array(points), view_from((1, 2, 0.5)), size)
    x, y, _ = frame.pixels(np.array(points)).T
    # Rounding of a pixel's coordinates.
    assert min(x.min(), y.min()) > -1e-6
    assert x.max() < size[0] + 1e-6
    assert y.max() < size[1] + 1e-6


def test_a_frame_is_filled_and_its_name_stands_above():
    points = np.array([[0, 0, 0], [4, 0, 1.0]])
    plain = framed(points, view_from((0, -1, 0)), (400, 100))
    np.testing.assert_allclose(
        plain.pixels(points), [[200 - 200 / 1.06, 50 + 50 / 1.06, 0], [200 + 200 / 1.06, 50 - 50 / 1.06, 0]]
    )
    named = framed(points, named_view("front"), (400, 100)).pixels(points)
    assert named[:, 1].min() > 5.5
    assert named[:, 1].max() < 100


def test_cells_hold_all_views():
    for count in range(1, 8):
        rows, columns = cells(count)
        assert rows * columns >= count > (rows - 1) * columns


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "found ''"),
        ("iso,,top", "found ''"),
        ("ISO", "found 'ISO', expected some of iso, front, back, left, right, top, bottom"),
        ("top,iso,top", "found top twice"),
    ],
)
def test_other_words_are_refused(text, message):
    with pytest.raises(OptionError, match=message):
        parsed_views(text)


def test_views_keep_their_order():
    assert parsed_views(" top,iso ,left") == ("top", "iso", "left")
