"""What a method of blending gets and gives. A new method is one file in this folder with a tuple METHODS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import SemisplineError
from semispline.solver.judge import Base, ParametricSurface


class NotApplicableError(SemisplineError):
    """A method cannot be used on this pair, or what it needs is not installed; the message says why."""


@dataclass(frozen=True, eq=False)
class BlendTask:
    """Two bases to be blended.

    Attributes
    ----------
    name, title : str
        For files, and for readers.
    a, b : Base
    continuity : {"C2", "G2"}
        What the paper asks for.
    middle_curves : int
        Rows of control points between the three of each contact, for the methods that have such rows.
    """

    name: str
    title: str
    a: Base
    b: Base
    continuity: Literal["C2", "G2"] = "G2"
    middle_curves: int = 1

    @property
    def closed(self) -> bool:
        """Whether both contact curves are closed: their end points agree to the last bit."""
        ends = [base.derivative(np.array(base.range_along), 0, 0) for base in (self.a, self.b)]
        return all(np.array_equal(first, last) for first, last in ends)


@dataclass(frozen=True, eq=False)
class FormulaSurface:
    """A surface that is no spline, given by its formula and those of its derivatives.

    Attributes
    ----------
    at : callable
        (u, v, du, dv) -> shape (K, 3), for arrays u, v of shape (K,) and du + dv <= 3.
    breakpoints_u, breakpoints_v : ndarray
        Their ends are the domain.
    """

    at: Callable[[FloatArray, FloatArray, int, int], FloatArray]
    breakpoints_u: FloatArray
    breakpoints_v: FloatArray

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and v."""
        u, v = self.breakpoints
        return (float(u[0]), float(u[-1])), (float(v[0]), float(v[-1]))

    @property
    def breakpoints(self) -> tuple[FloatArray, FloatArray]:
        """Between neighbouring ones the surface is smooth."""
        return self.breakpoints_u, self.breakpoints_v

    def evaluate(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Return the point or a derivative at (u[k], v[k]), shape (K, 3)."""
        uu, vv = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
        return self.at(uu, vv, du, dv)

    def evaluate_grid(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Return the point or a derivative on the grid u x v, shape (len(u), len(v), 3)."""
        uu, vv = np.meshgrid(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64), indexing="ij")
        return self.at(uu.ravel(), vv.ravel(), du, dv).reshape(*uu.shape, 3)


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a method made of a task.

    Attributes
    ----------
    surface : ParametricSurface
    control_points : int or None
        None where the surface is no spline.
    iterations : int or None
        Of a nonlinear search; None where there is none.
    seconds : float
        For the method alone, imports and measures aside.
    alpha2, beta2 : float, (float, float) or None
        How far the cross derivatives of the bases are scaled, where the method has such numbers: a pair at both ends of
        v, linear between them.
    aligned : bool
        Whether (0, v) and (1, v) lie where the bases have the corresponding parameter; else measures look for the
        closest point of the edge.
    note : str
        What a reader has to know about this result.
    """

    surface: ParametricSurface
    control_points: int | None
    iterations: int | None
    seconds: float
    alpha2: float | tuple[float, float] | None = None
    beta2: float | tuple[float, float] | None = None
    aligned: bool = True
    note: str = ""


@dataclass(frozen=True)
class Method:
    """One way to blend.

    Attributes
    ----------
    name : str
        For files and code.
    title, source : str
        For readers: what it is, and where it comes from.
    place : int
        Where it stands in tables.
    run : callable
        BlendTask -> Outcome; raises NotApplicableError.
    """

    name: str
    title: str
    source: str
    place: int
    run: Callable[[BlendTask], Outcome]
