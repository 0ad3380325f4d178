"""What a proof of a least energy says: the search writes it, the checker reads it, and they share nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

from semispline.solver.arrays import FloatArray

Box: TypeAlias = tuple[tuple[float, float], tuple[float, float]]
Gram: TypeAlias = tuple[tuple[Fraction, ...], ...]


@dataclass(frozen=True)
class Leaf:
    """A part of the box on which the bound is proved.

    Attributes
    ----------
    x, y : (int, int)
        Part i of 2^s equal parts, as (i, s), in each direction.
    tangent_at : (float, float) or None
        Where convex: the point of the tangent plane that proves the bound, in [0, 1] x [0, 1] over the part.
    squares : (Q0, Q1, Q2) or None
        Definite matrices of sums of squares that prove it, over [-1, 1] x [-1, 1] for the part; see `squares`.
        Where neither is given, the Bernstein coefficients prove the bound.
    """

    x: tuple[int, int]
    y: tuple[int, int]
    tangent_at: tuple[float, float] | None = None
    squares: tuple[Gram, Gram, Gram] | None = None


@dataclass(frozen=True, eq=False)
class Certificate:
    """A proof that a point is a global minimum over a box, up to a tolerance; `check_certificate` verifies it.

    Attributes
    ----------
    coefficients : ndarray, shape (n + 1, n' + 1)
        [i, j] multiplies x^i y^j; floats taken as exact.
    box : ((float, float), (float, float))
    point : (float, float)
        Where the polynomial is claimed to be least.
    tolerance : float
        How far the value there may be above the bound.
    bound : float
        What the polynomial nowhere falls below.
    leaves : tuple of Leaf
        They tile the box.
    objective : str
        What the polynomial is, in words.
    """

    coefficients: FloatArray
    box: Box
    point: tuple[float, float]
    tolerance: float
    bound: float
    leaves: tuple[Leaf, ...]
    objective: str = "a polynomial"
