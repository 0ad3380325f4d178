"""A mixture of two values."""

from __future__ import annotations

from semispline.papers.primer.writing import definition

CLAIMS = (
    definition("extended.1", "A share a of one value and a share b of another.", "a mixture of two values"),
    definition(
        "extended.2",
        "The mixture whose shares are a and 1 - a, so that they add up to the whole.",
        "a mixture with one share to choose",
    ),
)
