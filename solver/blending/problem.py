"""The blend as a minimisation: energy, prescribed rows, free rows, admissible shape parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import comb
from typing import Any, cast

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import seam_order, with_least_size
from semispline.solver.blending.cures import Cure
from semispline.solver.blending.exits import Exits, measure_exits
from semispline.solver.blending.facing import measure_facing
from semispline.solver.blending.free_system import FreeSystem
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.held_ends import HeldSystem
from semispline.solver.blending.layout import blend_u_basis, middle_bases
from semispline.solver.blending.linear_alpha import LinearEnds, LinearInV, linear_rows, monomials_of_ends, raised_basis
from semispline.solver.blending.rational_energy import RationalForm, RationalSystem, free_weights
from semispline.solver.blending.representative import (
    Representative,
    smooth_along,
)
from semispline.solver.blending.sides import Side, of_one_degree
from semispline.solver.blending.windows import (
    SecondParameter,
    alpha_window,
    checked_speed,
    first_spans,
    given_ends,
    represented,
    second_parameter,
)
from semispline.solver.errors import OptionError
from semispline.solver.options import BlendOptions
from semispline.solver.splines import (
    Basis,
    affine_knots,
)

# The rows that G1 leaves free pull pipes together, by 4 to 7 %; stretched by this factor along v by less than 1 %.
# Random pairs are as fair in the median, and less by an eighth in the mean. However far apart, closed contacts are at
# least so long that v is the angle about a pipe: the pull grows with the fourth power of its inverse.
STRETCH, LEAST_AROUND = 3.5, 2 * np.pi
# So long that the second derivatives across alone count: what G0 and C0 leave free is straight.
STRAIGHT = 100.0


@dataclass(frozen=True, eq=False)
class BlendProblem:
    """A blend to be found, in coordinates of size 1 around the origin.

    Attributes
    ----------
    form : EnergyForm
        U and V_i of the m + 1 rows, the v-domain scaled to the length that the energy takes it for.
    rows : tuple of Basis, length m + 1
        V_i on the v-domain of the blend itself.
    a, b : Side
        Contact at u = 0 and u = 1.
    natural : (float, float)
        Natural sizes of alpha^2 and beta^2: mean gap between the contact curves over mean cross speed of the base.
    bounds : pair of (float, float)
        Boxes of alpha^2 and beta^2; low = high where the parameter is fixed.
    seam_order : int
        How many derivatives both bases keep across the seam of closed contact curves; -1 where these are open.
    exits : Exits
    p2 : (SecondParameter, SecondParameter)
    linear : pair of LinearEnds or None
        Where alpha^2 or beta^2 is linear in v; the rows of that contact then rise in degree.
    weights : pair of Representative or None
        Of rational sides, what their rows are built on.
    cures : pair of Cure or None
        What was done to make the rows of each side smooth along.
    """

    form: EnergyForm
    rows: tuple[Basis, ...]
    a: Side
    b: Side
    natural: tuple[float, float]
    bounds: tuple[tuple[float, float], tuple[float, float]]
    seam_order: int
    exits: Exits
    p2: tuple[SecondParameter, SecondParameter] = (SecondParameter(), SecondParameter())
    linear: tuple[LinearEnds | None, LinearEnds | None] = (None, None)
    weights: tuple[Representative | None, Representative | None] = (None, None)
    cures: tuple[Cure | None, Cure | None] = (None, None)

    @property
    def is_cured(self) -> bool:
        """Whether the rows of a side are not the base's own."""
        return any(cure is not None and cure.name != "none" for cure in self.cures)

    @property
    def has_constant_weights(self) -> bool:
        """Whether no weight depends on alpha: where there are none, too."""
        return all(found is None or found.constant for found in self.weights)

    @property
    def is_rational(self) -> bool:
        """Whether control points are homogeneous: (w x, w y, w z, w)."""
        return self.a.is_rational

    def check_polynomial(self, found: str) -> None:
        """Refuse rational blends where the solver knows polynomial ones only.

        Raises
        ------
        OptionError
            Beginning with what was found.
        """
        if self.is_rational:
            raise OptionError(f"{found} with a rational base, expected method reduced: the others are for polynomials")

    @property
    def dimension(self) -> int:
        """Columns of control points: 3, or 4 where they are homogeneous."""
        return int(self.a.rows.shape[2])

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether alpha^2 and beta^2 are unknowns."""
        (low_a, high_a), (low_b, high_b) = self.bounds
        return low_a < high_a, low_b < high_b

    @property
    def start(self) -> tuple[float, float]:
        """Natural alpha^2 and beta^2, or the nearest admissible ones."""
        a, b = (min(max(n, low), high) for n, (low, high) in zip(self.natural, self.bounds, strict=True))
        return a, b

    @property
    def given(self) -> tuple[LinearInV, LinearInV]:
        """What alpha^2 and beta^2 are where they are no unknowns: numbers, or pairs of end values."""
        a, b = (
            number if ends is None else (ends.bounds[0][0], ends.bounds[1][0])
            for number, ends in zip(self.start, self.linear, strict=True)
        )
        return a, b

    @property
    def contacts(self) -> tuple[tuple[Side, range, tuple[float, ...]], ...]:
        """For each contact the side, the rows counted from it, and the distances of the nearest knots of U."""
        U, p = self.form.u.knots, self.form.u.degree
        m = len(self.form.rows) - 1
        return tuple(
            (side, rows, first_spans(p, distances, side.order))
            for side, rows, distances in (
                (self.a, range(m + 1), U - U[0]),
                (self.b, range(m, -1, -1), U[-1] - U[::-1]),
            )
        )

    @property
    def free_rows(self) -> range:
        """Indices of the rows that no contact prescribes."""
        return range(self.a.order + 1, len(self.rows) - self.b.order - 1)

    @cached_property
    def seam_is_a_corner(self) -> bool:
        """Whether both bases are only continuous across their seam."""
        return all(_seam_order(side) == 0 for side in (self.a, self.b))

    def seam_order_of(self, row: int) -> int:
        """How many derivatives a free row keeps across the seam, if it has control points for as many.

        A middle curve is as smooth there as at its other knots: the blend does not show where the seam is, unless both
        bases have a corner there.
        """
        if self.seam_order < 0:
            return -1
        basis = self.form.rows[row]
        middle = self.a.count <= row < len(self.rows) - self.b.count
        if middle and not (self.seam_order == 0 and self.seam_is_a_corner):
            return min(basis.degree - 1, basis.size // 2 - 1)
        return min(self.seam_order, basis.size // 2 - 1)

    @cached_property
    def free_system(self) -> FreeSystem | RationalSystem | HeldSystem:
        """What has to be solved for the free rows."""
        plain = self.plain_system
        if plain.size == 0:
            return plain
        system = RationalSystem(self.rational_form, plain, self._seam_orders) if self.is_rational else plain
        return HeldSystem(system, self.form.offsets, self.free_rows, self.a.held) if self.a.held else system

    @cached_property
    def plain_system(self) -> FreeSystem:
        """The same for polynomial blends, and for the weights of rational ones."""
        return FreeSystem(self.form, self.free_rows, self._seam_orders)

    @property
    def _seam_orders(self) -> list[int]:
        return [self.seam_order_of(i) for i in self.free_rows]

    @cached_property
    def rational_form(self) -> RationalForm:
        """The energy of rational blends; where something is free their weights do not depend on alpha."""
        given = self.given
        points = self._contact_rows(*given, (self.p2[0].at(given[0]), self.p2[1].at(given[1])))
        form = self.form
        return RationalForm(form.u, form.rows, free_weights(self.plain_system, form.u, form.rows, points[:, 3]))

    def energy_products(self, points: FloatArray) -> FloatArray:
        """Return the energy products of blends, control points of shape (K, N, 3 or 4): shape (K, K).

        Of rational ones the weights are those of `rational_form`.
        """
        if not self.is_rational:
            return self.form.products(points)
        return self.rational_form.products(points[..., :3])

    def control_points(self, a: LinearInV, b: LinearInV, p2: tuple[LinearInV, LinearInV] | None = None) -> FloatArray:
        """Return p for alpha^2, beta^2 and p2, shape (N, 3 or 4): one linear solve for the free rows, of least energy.

        Where alpha^2 is linear in v, it and p2 may be pairs of end values.
        """
        return self.completed(self._contact_rows(a, b, p2 or (self.p2[0].at(a), self.p2[1].at(b))))

    def _contact_rows(self, a: LinearInV, b: LinearInV, p2: tuple[LinearInV, LinearInV]) -> FloatArray:
        """Return p with nothing but the prescribed rows."""
        points = np.zeros((self.form.offsets[-1], self.dimension))
        for index, (value, second) in enumerate(zip((a, b), p2, strict=True)):
            for row, prescribed in zip(self.contacts[index][1], self._prescribed(index, value, second), strict=False):
                points[self.form.offsets[row] : self.form.offsets[row + 1]] = prescribed
        return points

    def _prescribed(self, index: int, value: LinearInV, second: LinearInV) -> Sequence[FloatArray]:
        """Return the rows that a contact prescribes."""
        (side, _, spans), degree = self.contacts[index], self.form.u.degree
        if self.linear[index] is not None:
            return linear_rows(*side.monomial_rows(degree, spans), side.along, value, second)
        return list(side.contact_rows(cast("float", value), degree, spans, cast("float", second)))

    def shape_layers(self) -> tuple[FloatArray, list[FloatArray]]:
        """Return Z_k of P = sum_k m_k Z_k, shape (K, N, 3 or 4), with alpha^2 and p2 in units of their natural sizes.

        The monomials are 1, then those of side a without 1, then those of side b; their exponents come with them.
        """
        offsets, degree = self.form.offsets, self.form.u.degree
        layers = [np.zeros((offsets[-1], self.dimension))]
        exponents = []
        for index, (side, rows, spans) in enumerate(self.contacts):
            unit, linear, second = self.natural[index], self.linear[index], self.p2[index]
            monomials: Iterable[Iterable[FloatArray]]
            if not self.free[index]:
                fixed = self.given[index]
                powers, monomials = np.zeros((1, 2)), [self._prescribed(index, fixed, second.at(fixed))]
            elif linear is None:
                powers, monomials = _without_p2(*side.monomial_rows(degree, spans), second)
            else:
                constant = _without_p2(*side.monomial_rows(degree, spans), second)
                powers, monomials = monomials_of_ends(*constant, side.along)
            exponents.append(powers)
            for k, (power, monomial) in enumerate(zip(powers, monomials, strict=True)):
                if k:
                    layers.append(np.zeros((offsets[-1], self.dimension)))
                for row, values in zip(rows, monomial, strict=False):
                    layers[0 if k == 0 else -1][offsets[row] : offsets[row + 1]] = values * unit ** power.sum()
        completed = self.completed(np.concatenate(layers, axis=1))
        return np.stack(np.split(completed, len(layers), axis=1)), exponents

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), so that the energy is least.

        Raises
        ------
        ComputationError
            The stationarity system is singular or too ill-conditioned to be trusted.
        """
        return self.free_system.completed(points)


def _without_p2(exponents: FloatArray, monomials: FloatArray, second: SecondParameter) -> tuple[FloatArray, FloatArray]:
    """Put what p2 is into monomials a^i p2^j; where it is searched they stay as they are."""
    if second.free:
        return exponents, monomials
    found: dict[int, FloatArray] = {}
    for (i, j), rows in zip(exponents.astype(int).tolist(), monomials, strict=True):
        # (value + per_a a)^j
        for k in range(j + 1):
            factor = comb(j, k) * second.value ** (j - k) * second.per_a**k
            if factor or i + k == 0:
                found[i + k] = found.get(i + k, np.zeros_like(rows)) + factor * rows
    powers = sorted(found)
    return np.array([[i, 0.0] for i in powers]), np.stack([found[i] for i in powers])


def make_problem(a: Side, b: Side, options: BlendOptions) -> BlendProblem:
    """Lay out the knots of the blend and its admissible shape parameters.

    Raises
    ------
    OptionError
        A number of middle curves or a degree out of range, or knots of U across which curvature jumps where the fairest
        shape is searched.
    EdgeError
        The contact curves coincide, one of them is a point, or a cross derivative that contact needs vanishes.
    """
    options = options.decided()
    middle_curves = cast("int", options.middle_curves)
    u = blend_u_basis(cast("int", options.degree_u), middle_curves, options.u_knots, (a.order, b.order))
    if any(side.has_shape_parameter and x == "fair" for side, x in zip((a, b), options.alphas, strict=True)):
        _check_bends_continuously(u)
    (a, cure_a), (b, cure_b) = smooth_along(a, b, options)
    weights: tuple[Representative | None, Representative | None] = (None, None)
    if a.is_rational:
        (a, b), weights = represented(a, b, u, options)
    elif any(cure is not None and cure.name != "none" for cure in (cure_a, cure_b)):
        a, b = of_one_degree(a, b)
    closed = min(_seam_order(side) for side in (a, b))
    given = cast("Any", options.middle_knots)
    middle = middle_bases(a.along, b.along, middle_curves, given, closed=closed >= 0)
    if closed >= 0 and isinstance(given, str):
        middle = [with_least_size(basis, 2 * basis.degree) for basis in middle]
    linear_a, linear_b = (
        given_ends(alpha) if side.has_shape_parameter else None
        for side, alpha in zip((a, b), options.alphas, strict=True)
    )
    if closed >= 0 and (linear_a or linear_b):
        raise OptionError(
            "alpha: found two values for the ends of v on closed contacts, where both are one place; expected one"
        )
    rows = (*side_bases(a, linear_a), *middle, *side_bases(b, linear_b)[::-1])
    means = measure_facing(a, b)
    natural_a, natural_b = (
        means.gap / speed if checked_speed(side, speed, name) else 1.0
        for name, side, speed in zip("ab", (a, b), means.cross_speeds, strict=True)
    )
    exits = measure_exits(a, b)
    bounds_a, bounds_b = (
        (1.0, 1.0) if not side.has_shape_parameter else alpha_window(size, side.order, alpha, options.box, exits)
        for side, size, alpha in zip((a, b), (natural_a, natural_b), options.alphas, strict=True)
    )
    p2_a, p2_b = (second_parameter(side, i, options) for i, side in enumerate((a, b)))
    form = EnergyForm(u, rows)
    if options.v_scale != "paper":
        length = _length_of_v(options.v_scale, sum(means.lengths) / 2 / means.gap, closed=closed >= 0)
        form = EnergyForm(u, tuple(Basis(row.degree, affine_knots(row.knots, 0.0, length)) for row in rows))
    return BlendProblem(
        form,
        rows,
        a,
        b,
        (natural_a, natural_b),
        (bounds_a, bounds_b),
        closed,
        exits,
        (p2_a, p2_b),
        (linear_a, linear_b),
        weights,
        (cure_a, cure_b),
    )


def _seam_order(side: Side) -> int:
    return seam_order(side.along, side.rows[: side.order + 1], side.largest)


def _length_of_v(v_scale: str | None, length: float, *, closed: bool) -> float:
    """Return what the energy takes the length of v for; contacts are `length` gaps long."""
    if v_scale == "stretched":
        return max(STRETCH * length, LEAST_AROUND if closed else 0.0)
    return {"unit": 1.0, "straight": STRAIGHT}.get(str(v_scale), length)


def _check_bends_continuously(u: Basis) -> None:
    """Refuse inner knots of U across which curvature jumps: the search would not see it."""
    inner = u.knots[u.degree + 1 : -u.degree - 1]
    most = max((int(np.sum(inner == knot)) for knot in inner), default=0)
    if most and u.degree - most < 2:
        name = "u_knots" if most > 1 and u.degree > 2 else "degree_u"
        raise OptionError(
            f"{name}: the fairest shape needs curvature that is continuous across: found degree_u {u.degree} with "
            f"inner u_knots of multiplicity {most}, expected degree 3 or more and simple inner knots; or alpha energy"
        )


def side_bases(side: Side, linear: LinearEnds | None) -> list[Basis]:
    """Return the bases of the rows that are a side's own, from the contact on."""
    return [
        raised_basis(side.along, r) if linear is not None and r <= side.order else side.along for r in range(side.count)
    ]
