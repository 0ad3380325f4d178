"""Small semi-structured surfaces with exact knots, on which a check runs what it has decided in general."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from semispline.papers.checks import clamped, de_boor, spline_basis

_THIRD = Fraction(1, 3)


@dataclass(frozen=True)
class Sample:
    """A small semi-structured surface with generators for control points: orders k, l, knots U and V_i."""

    k: int
    l: int  # noqa: E741  # the usual letter
    U: tuple[Fraction, ...]
    V: tuple[tuple[Fraction, ...], ...]

    @property
    def m(self) -> int:
        """Index of the last v-control curve."""
        return len(self.V) - 1

    @property
    def sizes(self) -> tuple[int, ...]:
        """Number of control points of each curve."""
        return tuple(len(v) - self.l for v in self.V)

    def curve(self, net: dict[tuple[int, int], Any], i: int, v: Fraction) -> Any:
        """Return P_i(v) by the triangle."""
        return de_boor(self.l, self.V[i], [net[i, j] for j in range(self.sizes[i])], v)

    def value(self, net: dict[tuple[int, int], Any], u: Fraction, v: Fraction) -> Any:
        """Return P(u, v): first along v, then along u."""
        return de_boor(self.k, self.U, [self.curve(net, i, v) for i in range(self.m + 1)], u)

    def weights(self, u: Fraction, v: Fraction) -> list[Fraction]:
        """Return what each control point is multiplied by at (u, v): Cox-de Boor, function by function."""
        basis = spline_basis({"U": self.U} | dict(enumerate(self.V)))
        return [
            basis(i, self.k, u, "U") * basis(j, self.l, v, i) for i, size in enumerate(self.sizes) for j in range(size)
        ]


def samples() -> Iterator[Sample]:
    """Yield surfaces of several orders; the last one is a bicubic blend with one curve between three of each side."""
    for k, order in ((2, 2), (2, 3), (3, 2), (3, 4), (4, 3)):
        U = clamped(k, Fraction(2, 5))
        vectors = (clamped(order), clamped(order, _THIRD), clamped(order, Fraction(1, 4), Fraction(3, 5)))
        yield Sample(k, order, U, tuple(vectors[i % 3] for i in range(len(U) - k)))
    a, b, middle = clamped(4, Fraction(1, 2)), clamped(4, _THIRD, 2 * _THIRD), clamped(4, Fraction(5, 12))
    yield Sample(4, 4, clamped(4, *(Fraction(n, 4) for n in (1, 2, 3))), (a, a, a, middle, b, b, b))
