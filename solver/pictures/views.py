"""From where a model is seen: the camera, named views, and several of them in one picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, sqrt
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import OptionError

ViewName: TypeAlias = Literal["iso", "front", "back", "left", "right", "top", "bottom"]

# Towards the eye, z upwards; from above and below y is.
_TOWARDS: dict[ViewName, tuple[int, int, int]] = {
    "iso": (1, -1, 1),
    "front": (0, -1, 0),
    "back": (0, 1, 0),
    "left": (-1, 0, 0),
    "right": (1, 0, 0),
    "top": (0, 0, 1),
    "bottom": (0, 0, -1),
}
_MARGIN = 1.06
# Height of the name of a view, of that of its picture.
TITLE = 0.036
# A direction whose horizontal part is smaller than this counts as vertical.
_STEEP = 1e-6


@dataclass(frozen=True, eq=False)
class View:
    """Where the camera looks from; unit vectors, and the eye that sees stripes, at infinity unless given."""

    towards_eye: FloatArray
    right: FloatArray
    up: FloatArray
    eye: FloatArray | None = None
    name: str = ""


@dataclass(frozen=True, eq=False)
class Frame:
    """What of space a picture shows, in parallel projection.

    Attributes
    ----------
    view : View
    middle : (float, float, float)
        Right, up and towards the eye, of the middle of the picture.
    depth : float
        Of what is seen.
    scale : float
        Half the height of the picture, model units.
    size : (int, int)
        Pixels.
    """

    view: View
    middle: tuple[float, float, float]
    depth: float
    scale: float
    size: tuple[int, int]

    def pixels(self, points: FloatArray) -> FloatArray:
        """Return where points are seen, from the upper left corner of the picture, and how near; shape (K, 3).

        The third coordinate is towards the eye, from the middle of what is seen, in pixels too.
        """
        width, height = self.size
        unit = height / 2 / self.scale
        x = (points @ self.view.right - self.middle[0]) * unit + width / 2
        y = height / 2 - (points @ self.view.up - self.middle[1]) * unit
        z = (points @ self.view.towards_eye - self.middle[2]) * unit
        return np.stack([x, y, z], axis=-1)

    def heights(self, plotter: Any) -> FloatArray:
        """Return the third coordinate of what a plotter, aimed and drawn, shows at each pixel; NaN where nothing."""
        away = -np.asarray(plotter.get_image_depth(), dtype=np.float64)
        return (self._distance - away) * self.size[1] / 2 / self.scale

    @property
    def _distance(self) -> float:
        """Of the camera from the middle."""
        return 4 * (self.scale + self.depth)

    def aim(self, plotter: Any) -> None:
        """Point the camera of a plotter."""
        view = self.view
        focus = self.middle[0] * view.right + self.middle[1] * view.up + self.middle[2] * view.towards_eye
        plotter.camera_position = [focus + self._distance * view.towards_eye, focus, view.up]
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = self.scale
        plotter.reset_camera_clipping_range()


def framed(points: FloatArray, view: View, size: tuple[int, int]) -> Frame:
    """Return the frame that points fill, below the name of the view."""
    share = 1 - 1.6 * TITLE if view.name else 1.0
    x, y, z = points @ view.right, points @ view.up, points @ view.towards_eye
    width, height = float(np.ptp(x)), float(np.ptp(y))
    scale = _MARGIN * max(width * size[1] / size[0], height / share, 1e-300) / 2
    across, upwards, towards = (float(c.min() + c.max()) / 2 for c in (x, y, z))
    return Frame(view, (across, upwards + (1 - share) * scale, towards), float(np.ptp(z)), scale, size)


def parsed_views(text: str) -> tuple[ViewName, ...]:
    """Return the views that a word names, joined by commas.

    Raises
    ------
    OptionError
        Another name, or one twice.

    Examples
    --------
    >>> parsed_views("iso, top")
    ('iso', 'top')
    """
    names = [name.strip() for name in text.split(",")]
    found: list[ViewName] = []
    for name in names:
        known = next((view for view in _TOWARDS if view == name), None)
        if known is None:
            raise OptionError(f"--views: found {name!r}, expected some of {', '.join(_TOWARDS)}, joined by commas")
        if known in found:
            raise OptionError(f"--views: found {name} twice, expected each view once")
        found.append(known)
    return tuple(found)


def named_view(name: ViewName) -> View:
    """Return a view by its name."""
    view = view_from(np.array(_TOWARDS[name], dtype=np.float64))
    return View(view.towards_eye, view.right, view.up, name=name)


def view_from(direction: ArrayLike) -> View:
    """Look from a direction, with z upwards, or y where the direction is that of z.

    Raises
    ------
    OptionError
        Not three numbers, or all of them zero.
    """
    towards = np.asarray(direction, dtype=np.float64)
    if towards.shape != (3,) or not 0 < np.linalg.norm(towards) < np.inf:
        raise OptionError(f"towards_eye: found {towards.tolist()}, expected three numbers that are not all zero")
    towards_eye = unit(towards)
    upwards = np.eye(3)[2 if np.hypot(*towards_eye[:2]) > _STEEP else 1]
    right = unit(np.cross(upwards, towards_eye))
    return View(towards_eye, right, np.cross(towards_eye, right))


def line_of_sight(surfaces: Sequence[tuple[FloatArray, FloatArray, FloatArray]]) -> FloatArray:
    """Return unit rows right, up, towards the eye, from where surfaces are seen well.

    The eye looks along the normal that most of the area shares, a little from above and from the right. The sign of a
    normal does not matter: the dominant eigenvector of the sum of n n^T over the area is taken.

    Parameters
    ----------
    surfaces : sequence of (points, normals, area elements)
        Samples of each surface, shapes (..., 3), (..., 3) and (...).
    """
    spread = np.zeros((3, 3))
    for _, normals, area in surfaces:
        share = area / max(float(area.sum()), np.finfo(np.float64).tiny)
        n = normals.reshape(-1, 3)
        spread += (share.reshape(-1, 1) * n).T @ n
    normal = _signed(np.linalg.eigh(spread)[1][:, -1])
    points = np.concatenate([p.reshape(-1, 3) for p, _, _ in surfaces])
    across = (points - points.mean(axis=0)) @ (np.eye(3) - np.outer(normal, normal))
    # The longest extent lies across the picture.
    right = _signed(np.linalg.eigh(across.T @ across)[1][:, -1])
    up = np.cross(normal, right)
    towards_eye = unit(normal - 0.55 * up + 0.35 * right)
    right = unit(np.cross(up, towards_eye))
    return np.stack([right, np.cross(towards_eye, right), towards_eye])


def cells(count: int) -> tuple[int, int]:
    """Return rows and columns for so many views.

    Examples
    --------
    >>> [cells(n) for n in (1, 2, 3, 4, 5, 7)]
    [(1, 1), (1, 2), (2, 2), (2, 2), (2, 3), (3, 3)]
    """
    columns = ceil(sqrt(count))
    return ceil(count / columns), columns


def _signed(vector: FloatArray) -> FloatArray:
    """Of the two directions of an eigenvector, the one whose largest component is positive."""
    return vector if vector[np.argmax(np.abs(vector))] > 0 else -vector


def unit(vector: FloatArray) -> FloatArray:
    """Return the vector in length 1."""
    return np.asarray(vector / np.linalg.norm(vector))
