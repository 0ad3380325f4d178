"""What colours surfaces: curvature, stripes, bands of light, distance from a true face; and the scale beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from PIL import Image, ImageDraw

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import isophote_angle, mirror_angle
from semispline.solver.pictures.labels import font
from semispline.solver.pictures.samples import Sampled, extent_of
from semispline.solver.pictures.views import View, unit

Field: TypeAlias = Literal["curvature", "gaussian", "zebra", "isophotes"]

# Bands over 180 (light and dark ones of `zebra`) and over 90 degrees; even numbers.
STRIPES, _ISOPHOTES = 40, 18
_DISTANCES, _CURVATURES = "viridis", "coolwarm"
_NUMBERS = 5


@dataclass(frozen=True, eq=False)
class Scale:
    """Colours for values from `low` to `high`, and what they are of."""

    title: str
    low: float
    high: float
    colors: str

    def strip(self, size: tuple[int, int]) -> Image.Image:
        """Return a picture of the scale, with numbers."""
        # Matplotlib waits for a scale.
        from matplotlib import colormaps

        width, height = size
        image = Image.new("RGB", size, "white")
        left, right = width // 5, width - width // 5
        top, bottom = round(0.42 * height), round(0.62 * height)
        row = np.rint(255 * colormaps[self.colors](np.linspace(0, 1, right - left))[:, :3]).astype(np.uint8)
        image.paste(Image.fromarray(np.repeat(row[None], bottom - top, axis=0)), (left, top))
        draw = ImageDraw.Draw(image)
        draw.rectangle((left, top, right, bottom), outline="black")
        text = font(round(0.22 * height))
        draw.text((width / 2, round(0.2 * height)), self.title, fill="black", font=text, anchor="mm")
        for share in np.linspace(0, 1, _NUMBERS).tolist():
            x = left + share * (right - left)
            draw.line((x, bottom, x, bottom + 0.06 * height), fill="black", width=2)
            number = f"{self.low + share * (self.high - self.low):.3g}"
            draw.text((x, round(0.82 * height)), number, fill="black", font=text, anchor="mm")
        return image


def curvature_scale(field: Field, samples: Sequence[Sampled]) -> Scale | None:
    """Return the scale of a field that has one."""
    if field not in ("curvature", "gaussian"):
        return None
    power = 1 if field == "curvature" else 2
    values = [
        np.abs(item.geometry.mean if field == "curvature" else item.geometry.gaussian).ravel() for item in samples
    ]
    limit = _color_limit(values, samples, extent_of(samples) ** -power)
    title = "mean curvature, 1/length" if power == 1 else "Gaussian curvature, 1/length\u00b2"
    return Scale(title, -limit, limit, _CURVATURES)


def distance_scale(name: str, unit_of_length: str | None, largest: float) -> Scale:
    """Return the scale of distances from a face."""
    return Scale(f"distance from {name}, {unit_of_length or 'model units'}", 0.0, largest or 1.0, _DISTANCES)


def mesh_options(field: Field | None, scale: Scale | None, dark: str | None) -> dict[str, Any]:
    """Return what pyvista is told of the colours of a mesh; `dark` is that of the dark stripes."""
    options: dict[str, Any] = {"interpolate_before_map": True, "ambient": 0.6, "diffuse": 0.4, "show_scalar_bar": False}
    if scale is not None:
        return options | {"cmap": scale.colors, "clim": (scale.low, scale.high)}
    bands = STRIPES if field == "zebra" else _ISOPHOTES
    usual, light = ("#101010", "#ffffff") if field == "zebra" else ("#1f4e79", "#f2f2f2")
    end = 180 if field == "zebra" else 90
    return options | {"n_colors": bands, "clim": (0, end), "cmap": [dark or usual, light] * (bands // 2)}


def field_values(item: Sampled, field: Field, view: View) -> FloatArray:
    """Return the values of a field as they are seen from somewhere, in the shape of the samples."""
    if field == "gaussian":
        return item.geometry.gaussian
    if field == "curvature":
        # Towards the normal is positive in `curvature`; bulging towards the eye is what a reader sees, point by point:
        # of a whole tube the outside of one part is seen, and the inside of another.
        return item.geometry.mean * np.where(item.normal @ view.towards_eye >= 0, -1.0, 1.0)
    if field == "isophotes":
        angle = isophote_angle(item.normal, unit(view.towards_eye + view.up))
        # Either side of a surface may be the outer one.
        return np.minimum(angle, 180 - angle)
    # The pattern of `zebra` about an axis across the picture, so that stripes cross edges of either direction.
    seen_from = view.towards_eye if view.eye is None else view.eye - item.geometry.point
    return mirror_angle(item.normal, seen_from, view.right + view.up)


def _color_limit(values: Sequence[FloatArray], samples: Sequence[Sampled], natural: float) -> float:
    """Return the end of a symmetric scale that holds 98 % of the area; not below rounding."""
    found = np.concatenate(values)
    # Each surface counts as much as any other, however large.
    shares = [item.area / max(float(item.area.sum()), np.finfo(np.float64).tiny) for item in samples]
    area = np.concatenate(shares)
    kept = np.isfinite(found)
    order = np.argsort(found[kept])
    share = np.cumsum(area[kept][order])
    if not len(share) or share[-1] <= 0:
        return natural
    limit = float(found[kept][order][np.searchsorted(share, 0.98 * share[-1])])
    return limit if limit > 1e-9 * natural else natural
