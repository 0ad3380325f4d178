"""How the paper writes its functions."""

from __future__ import annotations

from typing import Any

from semispline.papers.ledger import Places


def _basis(arguments: tuple[Any, ...]) -> Places | None:
    """Return the indices of a basis function: B(i, n, x) is a Bernstein polynomial, B(i, k, x, knots) a B-spline.

    A fifth argument is the order of a derivative.
    """
    if len(arguments) < 3:
        return None
    if len(arguments) == 3:
        return Places(arguments[:1], arguments[1:2], arguments[2:])
    derivative = (f"({arguments[4]})",) if len(arguments) > 4 and arguments[4] != 0 else ()
    return Places(arguments[:2], derivative, arguments[2:4])


NOTATION = {"B": _basis}
