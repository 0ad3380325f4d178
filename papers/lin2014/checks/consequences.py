"""What an error of the paper does to a surface: in which numbers it is measured, and what of them is rounding."""

from __future__ import annotations

from collections.abc import Mapping

from semispline.papers.ledger import Consequence

# The referee's own limits: degrees, and fractions of the curvature.
_ROUNDING = 1e-9


def on_surface(
    text: str,
    measured: Mapping[str, float],
    corrected: Mapping[str, float] | None = None,
    judges: Mapping[str, str] | None = None,
) -> Consequence:
    """Return what was measured on a surface, and the same with the corrected formula where that was measured too."""
    return Consequence(text, measured, corrected or {}, _ROUNDING, judges or {})
