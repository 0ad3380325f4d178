"""Names of faces and edges on a picture: where each is seen, and without one lying on another.

What is seen where is read from a second picture, in which each face has a colour of its own: a name never stands on a
part that hides what it names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont
from scipy.ndimage import distance_transform_edt, find_objects

from semispline.solver.arrays import FloatArray

# Where nothing is seen.
NOTHING = -1
# A face that is nowhere seen so many pixels to all sides is seen along itself: what is left are stray pixels.
_LEAST = 2.0
# Points along an edge; one is seen where its face is within so many pixels, and no more than so many in front of it: a
# face that closes round hides edges of its own.
_ALONG, _NEAR, _IN_FRONT = 101, 4, 8
# Around a text, pixels; steps outwards, in heights of the text, and directions in which room is sought.
_PAD, _RINGS, _WAYS = 3, (1.0, 1.6, 2.4, 3.4, 4.6, 6.0, 8.0), 16
_FACE_INK, _EDGE_INK = "black", "#0b3c8c"

Seen = NDArray[np.int64]
Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class Anchor:
    """What a name points at.

    Attributes
    ----------
    surface : int
        The number of what is named, or of the face whose edge it is.
    text : str
    at : (float, float)
        Pixel, from the upper left corner.
    room : float
        How far to all sides the face is seen, in half heights of the text: below 1 the name hides more than its face.
    towards : (float, float)
        Unit vector to where there is room; zero where the name may lie on the point itself.
    of_edge : bool
    nearby : bool
        Only where it points, without a line that leads to it.
    """

    surface: int
    text: str
    at: tuple[float, float]
    room: float
    towards: tuple[float, float] = (0.0, 0.0)
    of_edge: bool = False
    nearby: bool = False


@dataclass(frozen=True)
class Placed:
    """A name in its box: left, top, right, bottom; `leads` where a line leads from it to what it names."""

    anchor: Anchor
    box: Box
    leads: bool


@cache
def font(height: int) -> Any:
    """Return a font of a height in pixels."""
    return ImageFont.load_default(max(height, 6))


def face_anchors(seen: Seen, names: Sequence[str], height: int) -> dict[int, Anchor]:
    """Return, of each face that is seen and has a name, where it has most room for it.

    Parameters
    ----------
    seen : ndarray of int, shape (rows, columns)
        The number of the face at each pixel, -1 where there is none.
    names : sequence of str
        By number.
    height : int
        Of the text.

    Examples
    --------
    >>> seen = np.full((40, 60), -1)
    >>> seen[10:31, 20:51] = 0
    >>> face_anchors(seen, ["#7"], 10)[0].at
    (35.0, 20.0)
    """
    found = {}
    for number, place in enumerate(find_objects(seen + 1)):
        if place is None or number >= len(names) or not names[number]:
            continue
        # A margin of what is not the face: the border of the picture counts as its border.
        own = np.pad(seen[place] == number, 1)
        wide, high = _text_size(names[number], height)
        if distance_transform_edt(own).max() < _LEAST:
            continue
        room = distance_transform_edt(own, sampling=(2 / high, 2 / wide))
        most = float(room.max())
        # Of the many places of a long face the one nearest to its middle.
        rows, columns = np.nonzero(room >= 0.98 * most)
        k = int(np.argmin((rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2))
        at = float(place[1].start + columns[k] - 1), float(place[0].start + rows[k] - 1)
        found[number] = Anchor(number, names[number], at, most)
    return found


def edge_anchor(
    seen: Seen, heights: FloatArray, face: int, pixels: FloatArray, text: str, height: int
) -> Anchor | None:
    """Return where an edge of a face is named: beside the middle of its longest seen piece, on the face itself.

    Parameters
    ----------
    seen : ndarray of int, shape (rows, columns)
    heights : ndarray, shape (rows, columns)
        How near to the eye that is, in pixels.
    face : int
    pixels : ndarray, shape (K, 3)
        Points of the edge, the third coordinate towards the eye.
    text : str
    height : int
        Of the text.
    """
    rows, columns = seen.shape
    # A straight edge may have no points but its ends.
    along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(pixels, axis=0), axis=1)))
    even = np.linspace(0, along[-1], _ALONG)
    pixels = np.stack([np.interp(even, along, pixels[:, d]) for d in range(3)], axis=1)
    own_height = np.where(seen == face, heights, np.inf)
    is_seen = np.array(
        [bool((_window(own_height, round(x), round(y), _NEAR) <= z + _IN_FRONT).any()) for x, y, z in pixels.tolist()]
    )
    runs = np.split(np.arange(_ALONG), np.flatnonzero(np.diff(is_seen)) + 1)
    runs = [run for run in runs if is_seen[run[0]]]
    if not runs:
        return None
    best = max(runs, key=len)
    x, y, _ = pixels[best[len(best) // 2]].tolist()
    reach = 2 * height
    own = np.argwhere(_window(seen, round(x), round(y), reach) == face)
    corner = np.array([max(round(x) - reach, 0), max(round(y) - reach, 0)])
    way = (own[:, ::-1] + corner).mean(axis=0) - (x, y) if len(own) else np.zeros(2)
    long = float(np.linalg.norm(way))
    towards = (way / long).tolist() if long > 1 else [0.0, 0.0]
    inside = min(max(x, 0.0), columns - 1.0), min(max(y, 0.0), rows - 1.0)
    return Anchor(face, text, inside, 0.0, (towards[0], towards[1]), of_edge=True)


def _window(image: NDArray[Any], x: int, y: int, reach: int) -> NDArray[Any]:
    return image[max(y - reach, 0) : max(y + reach + 1, 0), max(x - reach, 0) : max(x + reach + 1, 0)]


def placed(anchors: Sequence[Anchor], size: tuple[int, int], height: int) -> list[Placed]:
    """Return each name for which there is room in a box of its own within the picture.

    The largest faces come first, then edges; a name goes where it points, or as near to that as there is room.
    """
    order = sorted(anchors, key=lambda anchor: (anchor.of_edge, -anchor.room))
    done: list[Placed] = []
    boxes = np.zeros((0, 4))
    for anchor in order:
        wide, high = _text_size(anchor.text, height)
        half = np.array([wide, high]) / 2
        tries = _tries(anchor, half)
        candidates = np.concatenate([tries - half, tries + half], axis=1)
        fits = np.all(candidates[:, :2] >= 0, axis=1) & np.all(candidates[:, 2:] <= np.array(size), axis=1)
        # Of two boxes one lies beside or above the other.
        apart = (candidates[:, None, :2] >= boxes[:, 2:]) | (candidates[:, None, 2:] <= boxes[:, :2])
        free = np.flatnonzero(fits & np.all(np.any(apart, axis=2), axis=1))
        if not len(free):
            continue
        k = int(free[0])
        left, top, right, bottom = candidates[k].tolist()
        x, y = anchor.at
        beside = max(left - x, x - right, top - y, y - bottom)
        done.append(Placed(anchor, (left, top, right, bottom), beside > high / 2))
        boxes = np.concatenate([boxes, candidates[k : k + 1]])
    return done


def _tries(anchor: Anchor, half: FloatArray) -> FloatArray:
    """Return middles of boxes, the best first, shape (K, 2)."""
    at, towards = np.array(anchor.at), np.array(anchor.towards)
    turns = np.arange(_WAYS) * 2 * np.pi / _WAYS
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    if towards.any():
        # The ways that lead into the face first.
        ways = ways[np.argsort(-(ways @ towards), kind="stable")]
        # So far that the box just leaves the point.
        first = [at + towards * (float(np.abs(towards) @ half) + gap) for gap in (1.0, half[1], 2 * half[1])]
    elif anchor.room >= 1 or anchor.of_edge:
        first = [at]
    else:
        first = []
    if anchor.nearby:
        return np.array(first or [at])
    around = [at + way * (half + ring * 2 * half[1]) for ring in _RINGS for way in ways]
    return np.array([*first, *around])


def _text_size(text: str, height: int) -> tuple[float, float]:
    return float(font(height).getlength(text)) + 2 * _PAD, 1.1 * height + 2 * _PAD


def draw_labels(image: Image.Image, labels: Sequence[Placed], height: int) -> None:
    """Draw names on a picture, each on a light ground, with a line where it stands apart from what it names."""
    draw = ImageDraw.Draw(image, "RGBA")
    for label in labels:
        left, top, right, bottom = label.box
        ink = _EDGE_INK if label.anchor.of_edge else _FACE_INK
        if label.leads:
            x, y = label.anchor.at
            draw.line((x, y, (left + right) / 2, (top + bottom) / 2), fill="white", width=4)
            draw.line((x, y, (left + right) / 2, (top + bottom) / 2), fill=ink, width=2)
            draw.ellipse((x - 4, y - 4, x + 4, y + 4), fill=ink, outline="white")
    for label in labels:
        left, top, right, bottom = label.box
        ink = _EDGE_INK if label.anchor.of_edge else _FACE_INK
        draw.rounded_rectangle((left, top, right - 1, bottom - 1), radius=4, fill=(255, 255, 255, 215))
        middle = (left + right) / 2, (top + bottom) / 2
        draw.text(middle, label.anchor.text, fill=ink, font=font(height), anchor="mm")
