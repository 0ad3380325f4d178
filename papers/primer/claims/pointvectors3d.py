"""Frames along a curve in space."""

from __future__ import annotations

from semispline.papers.primer.writing import definition

CLAIMS = (
    definition(
        "pointvectors3d.1",
        "A frame has the point of the curve, the tangent, the axis of rotation and the normal.",
        "the fields of a frame",
    ),
)
