"""What alpha^2 and p2 may be, and the weights that rational sides then have: windows and representation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast, overload

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.exits import Exits, measure_exits
from semispline.solver.blending.facing import VANISHING, measure_facing
from semispline.solver.blending.ladder import Window
from semispline.solver.blending.linear_alpha import LinearEnds, LinearInV
from semispline.solver.blending.representative import Representative, needs_constant_weights, tame_side
from semispline.solver.blending.sides import Side
from semispline.solver.errors import EdgeError
from semispline.solver.options import Alpha, BlendOptions
from semispline.solver.splines import Basis

# Admissible alpha^2: for least energy in units of its natural size; for the fairest shape in units of an arc's, wider
# where exits and chords disagree (a U-turn).
ENERGY_BOX, WINDOW, WIDE_WINDOW = (1 / 8, 8.0), (1 / 4, 4.0), (1 / 4, 16.0)
# For G3 and G4; above it lie loops that are fair.
LOW_WINDOW = (1 / 8, 2.0)
# Where a window's lower end stops the search it begins at this part of it: bases that bend much want little alpha.
LOWER = 1 / 2
# p2 = factor * p1 for G3 and G4: it lowers J by a quarter and by two fifths against zero.
P2_FACTORS = {3: 3.0, 4: 4.0}


@dataclass(frozen=True)
class SecondParameter:
    """What p2 of a side may be: a number plus a multiple of alpha^2, or searched.

    Attributes
    ----------
    value, per_a : float
        p2 = value + per_a * alpha^2.
    free : bool
        Searched from there on.
    """

    value: float = 0.0
    per_a: float = 0.0
    free: bool = False

    @overload
    def at(self, a: float) -> float: ...
    @overload
    def at(self, a: LinearInV) -> LinearInV: ...
    def at(self, a: LinearInV) -> LinearInV:
        """Return p2 for alpha^2, where it is not searched; linear in v where it goes with one that is."""
        if not self.per_a:
            return self.value
        if isinstance(a, tuple):
            return self.at(a[0]), self.at(a[1])
        return self.value + self.per_a * a


def alpha_window(
    natural: float, order: int, alpha: Alpha | None, box: tuple[float, float] | None, exits: Exits
) -> tuple[float, float]:
    """Return the admissible ends of alpha^2; they are equal where it is given."""
    if alpha == "energy":
        low, high = box or ENERGY_BOX
        return natural * low, natural * high
    if alpha == "fair":
        low, high = box or (LOW_WINDOW if order > 2 else WIDE_WINDOW if exits.u_turn else WINDOW)
        return natural * exits.arc * low, natural * exits.arc * high
    if isinstance(alpha, tuple):
        # `LinearEnds` has them.
        return 1.0, 1.0
    fixed = natural if alpha == "natural" else float(cast("float", alpha)) ** 2
    return fixed, fixed


def second_parameter(side: Side, index: int, options: BlendOptions) -> SecondParameter:
    """Return what p2 of a side may be: searched for G2 with a searched alpha, in step with p1 for G3 and G4."""
    if not side.has_shape_parameter or side.order < 2 or options.p2 == "zero":
        return SecondParameter()
    if options.p2 != "auto":
        return SecondParameter(value=float(options.p2[index]))
    if side.order == 2:
        return SecondParameter(free=options.alphas[index] == "fair")
    # p1 = -a.
    return SecondParameter(per_a=-P2_FACTORS[side.order])


def checked_speed(side: Side, speed: float, name: str) -> float:
    """Return the mean speed across the contact, refused where contact needs it and it vanishes."""
    if side.order > 0 and speed * side.spans[0] < VANISHING:
        raise EdgeError(f"base {name}: the cross derivative vanishes along the contact curve; choose another edge")
    return speed


def given_ends(alpha: Alpha | None) -> LinearEnds | None:
    """Return alpha^2 as given at both ends of v; none where it is not given so."""
    if not isinstance(alpha, tuple):
        return None
    first, last = (float(value) ** 2 for value in alpha)
    return LinearEnds(((first, first), (last, last)), (1.0, 1.0))


def second_weight(degree: int, spans: tuple[float, ...]) -> float:
    """Return by how much p2 moves the third row of a contact, in |R_w|."""
    return spans[0] * spans[1] / (degree * (degree - 1))


def first_spans(degree: int, distances: FloatArray, order: int) -> tuple[float, ...]:
    """Return the distances of the nearest knots of U, from those of all knots from the contact."""
    return tuple(distances[degree + 1 : degree + 1 + max(2, order)].tolist())


def represented(
    a: Side, b: Side, u: Basis, options: BlendOptions
) -> tuple[tuple[Side, Side], tuple[Representative, Representative]]:
    """Return rational sides with weights that are positive whatever alpha and p2 may be."""
    means, exits = measure_facing(a, b), measure_exits(a, b)
    found = []
    for index, side in enumerate((a, b)):
        distances = u.knots - u.knots[0] if index == 0 else u.knots[-1] - u.knots[::-1]
        spans = first_spans(u.degree, distances, side.order)
        if needs_constant_weights(options):
            window = None
        elif not side.has_shape_parameter:
            window = Window((1.0, 1.0))
        else:
            natural = means.gap / checked_speed(side, means.cross_speeds[index], "ab"[index])
            low, high = alpha_window(natural, side.order, options.alphas[index], options.box, exits)
            second, bulge = second_parameter(side, index, options), options.bulges[index]
            most = exits.arc / second_weight(u.degree, spans) * natural * max(1.0, bulge**2) if second.free else 0.0
            # Where it stops a search, a window is made to begin lower.
            ends = min(LOWER, bulge) * low if low < high else min(1.0, bulge) * low, max(1.0, bulge) * high
            window = Window(ends, (second.value - most, second.value + most), second.per_a)
        found.append(tame_side(side, u, spans, window))
    (tame_a, of_a), (tame_b, of_b) = found
    return (tame_a, tame_b), (of_a, of_b)
