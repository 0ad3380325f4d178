"""What a curve is made of: a point between two points."""

from __future__ import annotations

from semispline.papers.primer.writing import definition

CLAIMS = (
    definition(
        "whatis.1",
        "The point at a percentage of the way from one point to another is the first point and that part of the "
        "difference of both.",
        "the point at a given percentage of the way between two points",
    ),
)
