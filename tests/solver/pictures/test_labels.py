"""Where names stand on a picture."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from semispline.solver.pictures.labels import (
    NOTHING,
    Anchor,
    draw_labels,
    edge_anchor,
    face_anchors,
    font,
    placed,
)

HEIGHT = 20
SIZE = (400, 300)


def blank():
    return np.full((SIZE[1], SIZE[0]), NOTHING)


def test_a_face_is_named_where_it_has_most_room():
    seen = blank()
    # An L: a narrow arm and a broad foot.
    seen[20:240, 20:40] = 0
    seen[200:280, 20:220] = 0
    anchor = face_anchors(seen, ["#7"], HEIGHT)[0]
    x, y = anchor.at
    assert abs(y - 240) <= 2
    assert 60 < x < 180
    assert anchor.room > 1
    assert (anchor.surface, anchor.text) == (0, "#7")


def test_what_hides_a_face_moves_its_name():
    seen = blank()
    seen[50:250, 50:350] = 0
    assert face_anchors(seen, ["#0"], HEIGHT)[0].at == (199.0, 149.0)
    seen[50:250, 50:250] = 1
    (x, _), other = face_anchors(seen, ["#0", "#1"], HEIGHT)[0].at, face_anchors(seen, ["#0", "#1"], HEIGHT)[1]
    assert x > 270
    assert other.at[0] < 230


def test_faces_seen_along_themselves_and_unnamed_ones_are_not_named():
    seen = blank()
    seen[50:250, 100:102] = 0
    seen[50:250, 110:310] = 1
    assert set(face_anchors(seen, ["#0", "#1"], HEIGHT)) == {1}
    seen[50:250, 100:108] = 0
    assert set(face_anchors(seen, ["#0", "#1"], HEIGHT)) == {0, 1}
    assert set(face_anchors(seen, ["#0", ""], HEIGHT)) == {0}
    assert face_anchors(blank(), ["#0", "#1"], HEIGHT) == {}


def test_an_edge_is_named_on_its_own_face_beside_its_seen_middle():
    seen = blank()
    flat = np.zeros(seen.shape)
    seen[50:250, 100:300] = 0
    seen[50:250, 300:390] = 1
    line = np.stack([np.full(41, 300.0), np.linspace(50, 250, 41), np.zeros(41)], axis=1)
    left, right = (edge_anchor(seen, flat, face, line, "e3", HEIGHT) for face in (0, 1))
    assert left.at == right.at == (300.0, 150.0)
    assert edge_anchor(seen, flat, 0, line[[0, -1]], "e3", HEIGHT) == left
    assert left.towards[0] < -0.9
    assert right.towards[0] > 0.9
    # Half of it is hidden: the middle of the rest.
    seen[50:170, :] = 2
    _, y = edge_anchor(seen, flat, 0, line, "e3", HEIGHT).at
    assert 200 < y < 220
    assert edge_anchor(seen, flat, 5, line, "e3", HEIGHT) is None
    # Out of the picture.
    out = np.array([1000, 1000, 0])
    assert edge_anchor(seen, flat, 0, line + out, "e3", HEIGHT) is None
    assert edge_anchor(seen, flat, 0, line - out, "e3", HEIGHT) is None


def test_an_edge_behind_a_part_of_its_own_face_is_hidden():
    seen = blank()
    seen[50:250, 100:300] = 0
    line = np.stack([np.full(41, 200.0), np.linspace(50, 250, 41), np.zeros(41)], axis=1)
    in_front = np.full(seen.shape, 100.0)
    assert edge_anchor(seen, in_front, 0, line, "e3", HEIGHT) is None
    # The upper half of the face closes round in front of it.
    in_front[150:] = 0.0
    _, y = edge_anchor(seen, in_front, 0, line, "e3", HEIGHT).at
    assert 195 < y < 205


def boxes(labels):
    return np.array([label.box for label in labels]).reshape(-1, 4)


ANCHORS = st.lists(
    st.tuples(
        st.floats(0, SIZE[0]),
        st.floats(0, SIZE[1]),
        st.floats(0, 4),
        st.sampled_from([(0.0, 0.0), (1.0, 0.0), (0.6, -0.8)]),
        st.booleans(),
        st.booleans(),
    ),
    max_size=40,
)


@given(ANCHORS)
def test_no_name_lies_on_another_or_leaves_the_picture(found):
    anchors = [Anchor(k, f"#{k}", (x, y), *rest) for k, (x, y, *rest) in enumerate(found)]
    labels = placed(anchors, SIZE, HEIGHT)
    assert len({label.anchor.surface for label in labels}) == len(labels) <= len(anchors)
    box = boxes(labels)
    assert (box[:, :2] >= 0).all()
    assert (box[:, 2:] <= np.array(SIZE)).all()
    for k in range(len(box)):
        overlap = np.minimum(box[k, 2:], box[:, 2:]) - np.maximum(box[k, :2], box[:, :2])
        assert (np.flatnonzero((overlap > 1e-9).all(axis=1)) == [k]).all()
    for label in labels:
        x, y = label.anchor.at
        left, top, right, bottom = label.box
        away = max(left - x, x - right, top - y, y - bottom)
        # A line leads from each name that is not at what it names.
        assert label.leads or away <= HEIGHT
        assert not (label.leads and label.anchor.nearby and away > 3 * HEIGHT)


def test_where_there_is_room_a_name_stands_on_its_point():
    (label,) = placed([Anchor(0, "#12", (200.0, 100.0), 3.0)], SIZE, HEIGHT)
    left, top, right, bottom = label.box
    assert ((left + right) / 2, (top + bottom) / 2) == (200.0, 100.0)
    assert not label.leads
    # The text fits.
    assert right - left > font(HEIGHT).getlength("#12")


def test_a_narrow_face_is_named_beside_itself():
    (label,) = placed([Anchor(0, "#12", (200.0, 100.0), 0.3)], SIZE, HEIGHT)
    left, top, right, bottom = label.box
    assert not (left < 200 < right and top < 100 < bottom)


def test_large_faces_come_first():
    first, second = Anchor(0, "#0", (200.0, 100.0), 1.5), Anchor(1, "#1", (201.0, 100.0), 5.0)
    labels = {label.anchor.surface: label for label in placed([first, second], SIZE, HEIGHT)}
    assert not labels[1].leads
    assert labels[0].box[0] >= labels[1].box[2] or labels[0].box[1] != labels[1].box[1]


def test_names_of_edges_lie_on_the_side_of_their_face():
    edges = [Anchor(k, "e1", (200.0, 150.0), 0.0, (-1.0, 0.0), of_edge=True) for k in range(4)]
    found = [label.box for label in placed(edges, SIZE, HEIGHT)]
    assert len(found) == 4
    # The first beside the point, the others around it, none beyond.
    assert found[0][2] <= 200
    assert all((left + right) / 2 <= 200 for left, _, right, _ in found)


def test_names_are_drawn_in_their_boxes():
    image = Image.new("RGB", SIZE, "#404040")
    near, far = Anchor(0, "#888", (60.0, 50.0), 3.0), Anchor(1, "e8", (300.0, 200.0), 0.0, of_edge=True)
    labels = placed([near, far], SIZE, HEIGHT)
    draw_labels(image, labels, HEIGHT)
    pixels = np.asarray(image).astype(int)
    changed = (pixels != 64).any(axis=2)
    inside = np.zeros_like(changed)
    for label in labels:
        left, top, right, bottom = (round(x) for x in label.box)
        inside[top : bottom + 1, left : right + 1] = True
        part = pixels[top:bottom, left:right]
        assert (part > 200).all(axis=2).mean() > 0.3
        assert (part < 120).all(axis=2).any() or label.anchor.of_edge
    assert not changed[~inside].any()
