"""What may be chosen about a blend: one value, checked when it is made, for library, command line, files and C."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields
from math import isfinite
from typing import Any, Literal, TypeAlias, cast, get_args

from semispline.solver.errors import OptionError
from semispline.solver.scalars import real_number, whole_number

Continuity: TypeAlias = Literal["C0", "C1", "C2", "G0", "G1", "G2", "G3", "G4"]
Method: TypeAlias = Literal["reduced", "casadi", "bfgs"]
Flip: TypeAlias = Literal["auto", "yes", "no"]
Shape: TypeAlias = float | Literal["fair", "energy", "natural"]
VScale: TypeAlias = Literal["paper", "unit", "length"]

# Energies have the fourth power of alpha^2 and of the box: far from any blend, and far from where floats end.
_MOST_ALPHA = 1e15
_MOST_BOX = 1e20


def _option(default: Any, form: str, metavar: str, text: str, *, sides: bool = False) -> Any:
    """Return a field; what the command line says of it and how it reads it stand beside its default.

    `form` is text, whole, number-or-word, range, numbers, lists or flag; with `sides` it may differ at the two edges.
    """
    return field(default=default, metadata={"form": form, "metavar": metavar, "help": text, "sides": sides})


@dataclass(frozen=True, kw_only=True)
class BlendOptions:
    """Everything that may be chosen about a blend beside its bases; `blend` takes each by its name, too.

    Parameters
    ----------
    continuity : {"C0", "C1", "C2", "G0", "G1", "G2"} or a pair of them
        At a and at b, in upper or lower case; kept as a pair.
    middle_curves : int
        Number of v-control curves between the three of each contact.
    degree_u : int
        Degree of the blend across, p = k - 1.
    method : {"reduced", "casadi", "bfgs"}
        How alpha and beta are found where contact is geometric: the proved global minimum, the constrained problem in
        CasADi, or the paper's own search.
    flip : {"auto", "yes", "no"}
        Whether edge b runs against edge a; "auto" takes the way without a twist. Where closeness cannot tell, both ways
        are blended and the one whose normal turns less is taken.
    alpha : "energy", "fair", "natural", a number, or a pair of these for a and b
        Where contact is geometric: search alpha of least energy, or that of the fairest shape (least area times
        integral of |grad H|^2, and with it a second parameter p2 on each side), take its natural size (mean gap over
        mean cross speed, for alpha^2), or set alpha itself; kept as a pair.
    box : (float, float), optional
        Admissible alpha^2 and beta^2. For least energy in units of their natural sizes, 1/8 to 8 unless given; for the
        fairest shape in units of an arc's, 1/4 to 4, or to 16 where exits and chords disagree.
    v_scale : {"paper", "unit", "length"}
        What (11) takes the length of the v-domain for: itself, 1, or mean contact length over mean gap. With the last
        two the blend does not depend on the units of v nor on the order of the bases.
    u_knots : sequence of float, optional
        Inner knots of U instead of uniform ones.
    middle_knots : sequence of sequences of float, optional
        Inner knots of each middle curve, in v of a's edge, instead of the paper's rule.
    strict : bool
        Refuse a blend with warnings.

    Raises
    ------
    OptionError
        A value that an option cannot take.

    Examples
    --------
    >>> BlendOptions(continuity=("g2", "C1"), alpha=0.5).continuity
    ('G2', 'C1')
    """

    continuity: Continuity | tuple[Continuity, Continuity] = _option(
        "G2", "text", "C", "At both edges: C0, C1, C2, G0, G1 or G2.", sides=True
    )
    middle_curves: int = _option(1, "whole", "N", "v-control curves between the contacts.")
    degree_u: int = _option(3, "whole", "P", "Degree of the blend across.")
    method: Method = _option("reduced", "text", "METHOD", "How alpha and beta are found: reduced, casadi or bfgs.")
    flip: Flip = _option("auto", "text", "FLIP", "Whether edge B runs against edge A: auto, yes or no.")
    alpha: Shape | tuple[Shape, Shape] = _option(
        "energy",
        "number-or-word",
        "ALPHA",
        "For G1 and G2: energy or fair (searched), natural, or a number.",
        sides=True,
    )
    box: tuple[float, float] | None = _option(
        None, "range", "LOW HIGH", "Range of a searched alpha² and beta², times their natural sizes (fair: an arc's)."
    )
    v_scale: VScale = _option("paper", "text", "SCALE", "Length of v in the energy: paper (as it is), unit or length.")
    u_knots: Sequence[float] | None = _option(
        None, "numbers", "K1,K2,...", "Inner knots in u, in (0, 1); uniform if left out."
    )
    middle_knots: Sequence[Sequence[float]] | None = _option(
        None, "lists", "K1,K2,...", "Inner knots of a middle curve, in v of edge A; once for each curve."
    )
    strict: bool = _option(False, "flag", "", "Refuse a blend with any warning.")

    def __post_init__(self) -> None:
        checked = {
            "continuity": tuple(map(continuity_name, _pair(self.continuity, "continuity"))),
            "middle_curves": whole_number(self.middle_curves, "middle_curves", 0, OptionError),
            "degree_u": whole_number(self.degree_u, "degree_u", 1, OptionError),
            "method": _word(self.method, "method", get_args(Method)),
            "flip": _word(self.flip, "flip", get_args(Flip)),
            "alpha": tuple(map(_alpha, _pair(self.alpha, "alpha"))),
            "box": None if self.box is None else _box(self.box),
            "v_scale": _word(self.v_scale, "v_scale", get_args(VScale)),
            "u_knots": None if self.u_knots is None else _knots(self.u_knots, "u_knots"),
            "middle_knots": None if self.middle_knots is None else _knot_lists(self.middle_knots, "middle_knots"),
        }
        if not isinstance(self.strict, bool):
            raise OptionError(f"strict: found {self.strict!r}, expected True or False")
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        if "fair" in self.alphas and (self.method != "reduced" or "energy" in self.alphas):
            found = f"method {self.method}" if self.method != "reduced" else "energy on the other side"
            raise OptionError(
                f"alpha: found fair with {found}, expected method reduced and no energy; try alpha energy"
            )

    @property
    def continuities(self) -> tuple[Continuity, Continuity]:
        """Continuity at a and at b."""
        return cast("tuple[Continuity, Continuity]", self.continuity)

    @property
    def alphas(self) -> tuple[Shape, Shape]:
        """What is asked of alpha and of beta."""
        return cast("tuple[Shape, Shape]", self.alpha)

    def said(self) -> dict[str, Any]:
        """Return the options that are not at their defaults: what a file has to hold."""
        default = BlendOptions()
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        return {name: value for name, value in values.items() if value != getattr(default, name)}


def named_options(options: BlendOptions | None, named: dict[str, Any]) -> BlendOptions:
    """Return the options that a function was given as one value or by their names.

    Raises
    ------
    OptionError
        Both, a name that no option has, or a value that it cannot take.
    """
    if options is not None:
        if not isinstance(options, BlendOptions):
            raise OptionError(f"options: found a {type(options).__name__}, expected a BlendOptions")
        if named:
            raise OptionError(f"options: found {', '.join(named)} beside it, expected one or the other")
        return options
    known = [f.name for f in fields(BlendOptions)]
    for name in named:
        if name not in known:
            raise OptionError(f"{name}: no such option, expected one of {', '.join(known)}")
    return BlendOptions(**named)


def continuity_name(value: object, name: str = "continuity") -> Continuity:
    """Return a name of continuity in upper case; messages call it `name`.

    Raises
    ------
    OptionError
        It is none of the eight.
    """
    upper = value.upper() if isinstance(value, str) else ""
    return cast("Continuity", upper if upper in get_args(Continuity) else _word(value, name, get_args(Continuity)))


def _word(value: object, name: str, words: Sequence[str]) -> str:
    if not isinstance(value, str) or value not in words:
        raise OptionError(f"{name}: found {reprlib.repr(value)}, expected one of {', '.join(words)}")
    return value


def _pair(value: Any, name: str) -> tuple[Any, Any]:
    """Return what is asked for at a and at b: one value stands for both."""
    if not isinstance(value, tuple | list) and getattr(value, "ndim", 0) != 1:
        return value, value
    if len(value) != 2:
        raise OptionError(f"{name}: found {len(value)} values, expected one or a pair")
    return value[0], value[1]


def _alpha(value: object) -> Shape:
    if isinstance(value, str):
        if value in ("fair", "energy", "natural"):
            return cast("Shape", value)
        raise OptionError(f"alpha: found {value!r}, expected fair, energy, natural or a positive number")
    number = real_number(value, "alpha", OptionError)
    if not 1 / _MOST_ALPHA <= number <= _MOST_ALPHA:
        raise OptionError(f"alpha: found {number:g}, expected {1 / _MOST_ALPHA:g} to {_MOST_ALPHA:g}")
    return number


def _box(box: object) -> tuple[float, float]:
    ends = _items(box, "box", "(low, high)")
    if len(ends) != 2:
        raise OptionError(f"box: found {reprlib.repr(box)}, expected (low, high)")
    low, high = (real_number(end, f"box[{i}]", OptionError) for i, end in enumerate(ends))
    if not 1 / _MOST_BOX <= low <= high <= _MOST_BOX:
        raise OptionError(f"box: found ({low:g}, {high:g}), expected {1 / _MOST_BOX:g} <= low <= high <= {_MOST_BOX:g}")
    return low, high


def _knots(values: object, name: str) -> tuple[float, ...]:
    found = [real_number(x, f"{name}[{i}]", OptionError) for i, x in enumerate(_items(values, name, "numbers"))]
    for i, x in enumerate(found):
        if not isfinite(x):
            raise OptionError(f"{name}[{i}]: found {x}, expected a finite number")
    return tuple(found)


def _knot_lists(values: object, name: str) -> tuple[tuple[float, ...], ...]:
    lists = _items(values, name, "sequences of numbers")
    return tuple(_knots(inner, f"{name}[{i}]") for i, inner in enumerate(lists))


def _items(values: object, name: str, expected: str) -> list[Any]:
    if not isinstance(values, Iterable) or isinstance(values, str):
        raise OptionError(f"{name}: found {reprlib.repr(values)}, expected {expected}")
    return list(values)
