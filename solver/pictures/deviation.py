"""How far drawn surfaces are from a face of a file: a blend from the face that it replaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.io import distances, triangle_mesh
from semispline.solver.judge import local_origin, surface_feet, surface_points
from semispline.solver.pictures.samples import Sampled
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface, bounding_box, transform
from semispline.solver.topology import DrawnFace

# A foot this near to the triangles of a trimmed face, of its diagonal, is on it: as near as these keep to its border.
_ON_FACE = 1e-3


@dataclass(frozen=True)
class Deviation:
    """How far surfaces are from a face.

    Attributes
    ----------
    largest, mean : float
        Over the area that is drawn, model units.
    at : (float, float, float)
        Where it is largest.
    of : int
        The surface on which that lies, of those measured.
    """

    largest: float
    mean: float
    at: tuple[float, float, float]
    of: int


class TrueFace:
    """A face from which distances are measured: to its surface where the foot is on the face, else to its border.

    Parameters
    ----------
    face : DrawnFace
        Of whose border `loaded.boundary` knows, where it is trimmed.
    """

    def __init__(self, face: DrawnFace) -> None:
        surface = face.surface
        # The name of the file, without its folders.
        self.name, self.unit = Path(face.spec).name, face.loaded.unit
        whole = surface.to_bspline() if isinstance(surface, SemiStructuredSurface) else surface
        self.origin = local_origin(whole)
        self.surface: BSplineSurface = transform(whole, np.eye(3), -self.origin)
        self.mesh, self.boundary = face.mesh, face.loaded.boundary

    def distances(self, points: FloatArray) -> FloatArray:
        """Return the distance of each point, shape (K,)."""
        moved = points - self.origin
        at = surface_feet(self.surface, moved)
        feet = surface_points(self.surface, at[:, 0], at[:, 1])
        distance: FloatArray = np.linalg.norm(moved - feet, axis=1)
        if self.mesh is None or self.boundary is None or not len(self.boundary.pieces):
            return distance
        _, nearest = self._triangles.find_closest_cell(feet, return_closest_point=True)
        size = float(np.linalg.norm(np.ptp(self._triangles.points, axis=0)))
        off = np.linalg.norm(feet - nearest, axis=1) > _ON_FACE * size
        if off.any():
            distance[off] = distances(points[off], self.boundary)[0]
        return distance

    @cached_property
    def _triangles(self) -> Any:
        assert self.mesh is not None
        fine = self.mesh.finer(self.surface, 0.01 * float(np.ptp(bounding_box(self.surface), axis=0).max()), 100_000)
        points = self.surface.evaluate(*fine.within(self.surface))
        return triangle_mesh(points, np.zeros_like(points), fine.triangles)


def measure_deviation(samples: Sequence[Sampled], of_points: Sequence[FloatArray]) -> Deviation:
    """Return the largest distance and the mean over the area of what was sampled."""
    points = np.concatenate([item.points for item in samples])
    area, distance = np.concatenate([item.area for item in samples]), np.concatenate(of_points)
    k = int(distance.argmax())
    x, y, z = points[k].tolist()
    of = int(np.searchsorted(np.cumsum([len(item.points) for item in samples]), k, side="right"))
    return Deviation(float(distance[k]), float(area @ distance / area.sum()), (x, y, z), of)
