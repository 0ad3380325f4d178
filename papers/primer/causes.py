"""What is wrong in the text, each fault once, what weighs most first; and which displays have it."""

from __future__ import annotations

from semispline.papers.ledger import Cause

_WITH_RECORDS = (
    (
        Cause(
            "last-term",
            "Sums and loops that end one term too early or too late",
            "A curve of order n has n + 1 points, numbered from 0, and n points have the numbers 0 to n - 1. The code "
            "for the sum stops before its last term, so that every curve runs into the origin.",
        ),
        ("explanation.10", "control.3", "curvefitting.15", "bsplines.1", "bsplines.5", "bsplined.1", "bsplined.2"),
    ),
    (
        Cause(
            "curvature",
            "The exponent in the curvature",
            "The area of first and second derivative is divided by the cube of the speed, the power 3/2 of its square; "
            "printed is the power 2/3.",
        ),
        ("curvature.1", "curvature.2", "curvature.3"),
    ),
    (
        Cause(
            "tension",
            "Catmull-Rom splines: the tension, and an entry",
            "The tangents are divided by the tension, and what is printed multiplies by it; and the third point has "
            "lost its own share.",
        ),
        ("catmullconv.3", "catmullconv.5", "catmullconv.10", "catmullconv.11", "catmullconv.12"),
    ),
    (
        Cause(
            "lengths",
            "Lengths of vectors",
            "The length is the root of the squared coordinates, without bars round each, without an integral; and "
            "what is reflected onto a tangent must have its length.",
        ),
        ("pointvectors.3", "pointvectors3d.2", "offsetting.5"),
    ),
    (
        Cause(
            "matrices",
            "Products of matrices with a factor on the wrong side, or without one",
            "They are not the same in another order, and sizes have to fit.",
        ),
        ("matrixsplit.18", "curvefitting.3", "curvefitting.17"),
    ),
    (
        Cause(
            "moulding",
            "From where one goes on",
            "What is looked for lies beyond a point that is known; printed is the way from what is looked for.",
        ),
        ("moulding.2", "moulding.3"),
    ),
    (
        Cause(
            "splines",
            "What stands at the bottom of de Boor's triangle, and the derivative",
            "Control points stand at its bottom, not 0 and 1; and the derivative of a spline has one degree less.",
        ),
        ("bsplines.6", "bsplines.7", "bsplined.6"),
    ),
    (
        Cause(
            "misprints",
            "Single signs, factors and digits",
            "Each is right with one of them changed.",
            misprint=True,
        ),
        ("reordering.6", "aligning.3", "aligning.4", "inflections.6", "curvefitting.4", "circles_cubic.4"),
    ),
)

CAUSES = tuple(cause for cause, _ in _WITH_RECORDS)
_KEYS = {identifier: cause.key for cause, identifiers in _WITH_RECORDS for identifier in identifiers}


def cause_of(identifier: str) -> str:
    """Return the key of the cause of what is wrong in a display; empty where it has none.

    Examples
    --------
    >>> cause_of("curvature.1"), cause_of("whatis.1")
    ('curvature', '')
    """
    return _KEYS.get(identifier, "")
