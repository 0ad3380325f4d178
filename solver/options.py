"""What may be chosen about a blend: one value, checked when it is made, for library, command line, files and C."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields, replace
from math import isfinite
from typing import Any, Literal, TypeAlias, cast, get_args

from semispline.solver.errors import OptionError
from semispline.solver.scalars import real_number, whole_number

Continuity: TypeAlias = Literal["C0", "C1", "C2", "G0", "G1", "G2", "G3", "G4"]
Method: TypeAlias = Literal["reduced", "casadi", "bfgs"]
Flip: TypeAlias = Literal["auto", "yes", "no"]
# A pair has the values at both ends of v.
Alpha: TypeAlias = float | tuple[float, float] | Literal["fair", "energy", "natural"]
AlphaV: TypeAlias = Literal["auto", "constant", "linear"]
VScale: TypeAlias = Literal["paper", "unit", "length", "stretched", "straight"]
Auto: TypeAlias = Literal["auto"]
Limits: TypeAlias = Literal["exact", "cad"]

# Energies have the fourth power of alpha^2 and of the box: far from any blend, and far from where floats end.
_MOST_ALPHA = 1e15
_MOST_BOX = 1e20
# Bulges beyond it are no longer the same shape.
_MOST_BULGE = 100.0
# Rows that a side owns at least: position, first and second derivative.
ROWS_PER_SIDE = 3
# By the lower order of both sides: what it leaves free may not pull together what lies far apart.
_V_SCALES: dict[int, VScale] = {0: "straight", 1: "stretched"}


def _option(default: Any, form: str, metavar: str, text: str, *, sides: Literal["", "both", "each"] = "") -> Any:
    """Return a field; what the command line says of it and how it reads it stand beside its default.

    `form` is text, number-or-word, numbers-or-word, pairs-or-word, range, numbers, lists-or-word or flag. With
    `sides` it may differ at the two edges: "both" is said once for both unless B differs, "each" is said for one edge
    at a time.
    """
    return field(default=default, metadata={"form": form, "metavar": metavar, "help": text, "sides": sides})


@dataclass(frozen=True, kw_only=True)
class BlendOptions:
    """Everything that may be chosen about a blend beside its bases; `blend` takes each by its name, too.

    Parameters
    ----------
    continuity : {"C0", "C1", "C2", "G0", "G1", "G2", "G3", "G4"} or a pair of them
        At a and at b, in upper or lower case; kept as a pair.
    middle_curves : int or "auto"
        Number of v-control curves between those that the contacts prescribe.
    degree_u : int or "auto"
        Degree of the blend across, p = k - 1.
    method : {"reduced", "casadi", "bfgs"}
        How alpha and beta are found where contact is geometric: by one reduced problem in the few numbers that are not
        linear, by the constrained problem in CasADi, or by the paper's own search. The last two minimise (11).
    flip : {"auto", "yes", "no"}
        Whether edge b runs against edge a; "auto" takes the way without a twist. Where closeness cannot tell, both ways
        are blended and the one whose normal turns less is taken.
    alpha : "fair", "energy", "natural", a number, a pair of numbers; or a pair of these for a and b; optional
        Where contact is geometric: search alpha of the fairest shape (least area times integral of |grad H|^2) or that
        of least energy (11), take its natural size (mean gap over mean cross speed, for alpha^2), or set alpha itself;
        a pair of numbers on a side are its values at both ends of v, alpha^2 being linear between them.
    alpha_v : {"auto", "constant", "linear"}
        Whether a searched alpha^2 is one number or linear in v.
    p2 : "auto", "zero", or a pair of numbers
        The second shape parameter of each side, P_uu = alpha^4 R_ww + p2 R_w, where contact is geometric. "auto" is
        searched beside alpha for G2 and in step with alpha^2 for G3 and G4. For G2 it is zero where alpha is given or
        natural, where the ends of the box are equal, and where energy is minimised.
    bulge : float or a pair of floats
        Multiplies the alpha^2 that was chosen, and p2 by its square: above 1 the blend stays longer with the base.
    box : (float, float), optional
        Admissible alpha^2 and beta^2. For least energy in units of their natural sizes, 1/8 to 8 unless given; for the
        fairest shape in units of an arc's, 1/4 to 4, or to 16 where exits and chords disagree, 1/8 to 2 for G3 and G4.
    v_scale : {"paper", "unit", "length", "stretched", "straight"}, optional
        What (11) takes the length of the v-domain for: itself, 1, mean contact length over mean gap, 3.5 times that
        (on closed contacts at least 2 pi), with which the free rows of G1 do not pull pipes together, or 100, with
        which those of G0 and C0 run as straight as can be from one contact to the other. But for the first one the
        blend does not depend on the units of v nor on the order of the bases.
    u_knots : sequence of float, optional
        Inner knots of U instead of uniform ones.
    middle_knots : "fourth", "paper", or a sequence of sequences of float, optional
        Inner knots of each middle curve, in v of a's edge: every fourth of both contacts', the paper's rule, or given.
    strict : bool
        Refuse a blend with warnings.
    match : "affine", "length", or a sequence of pairs of numbers
        Which points of the contacts answer each other: parameters that correspond affinely, equal shares of arc length,
        or the named parameters along edge a and edge b, and monotone in between. Along a chain k + s is the share s of
        its edge k. All but "affine" cost three times the degree along.
    limits : {"auto", "exact", "cad"}
        What contact is held to: exact, or as checkers of CAD systems have it. "auto" is exact, but for what is measured
        on a face along a free curve of it, where that is no plane.
    search_meets : bool
        Search a mesh for places where the blend meets itself or a base, where no direction shows that there are none.

    Notes
    -----
    What is unsaid is decided by `decided`: all for the fairest shape, or all as the paper has it.

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
        "G2", "text", "C", "At both edges: C0, C1, C2, G0, G1, G2, G3 or G4.", sides="both"
    )
    middle_curves: int | Auto = _option("auto", "number-or-word", "N", "Free v-control curves in between, or auto.")
    degree_u: int | Auto = _option("auto", "number-or-word", "P", "Degree of the blend across, or auto.")
    method: Method = _option("reduced", "text", "METHOD", "How alpha and beta are found: reduced, casadi or bfgs.")
    flip: Flip = _option("auto", "text", "FLIP", "Whether edge B runs against edge A: auto, yes or no.")
    alpha: Alpha | tuple[Alpha | None, Alpha | None] | None = _option(
        None,
        "numbers-or-word",
        "ALPHA",
        "For G1 to G4: fair (the default) or energy (searched), natural, a number, or X:Y at the ends of v.",
        sides="both",
    )
    alpha_v: AlphaV = _option("auto", "text", "WAY", "A searched alpha² along v: auto, constant or linear.")
    p2: Literal["auto", "zero"] | tuple[float, float] = _option(
        "auto", "numbers-or-word", "P2", "Second shape parameters: auto, zero, or X:Y at A and B."
    )
    bulge: float | tuple[float, float] = _option(
        1.0, "number-or-word", "X", "Multiplies the alpha² that was chosen.", sides="each"
    )
    box: tuple[float, float] | None = _option(
        None, "range", "LOW HIGH", "Range of a searched alpha² and beta², times an arc's (energy: their natural sizes)."
    )
    v_scale: VScale | None = _option(
        None, "text", "SCALE", "Length of v in the energy: paper (as it is), unit, length, stretched or straight."
    )
    u_knots: Sequence[float] | None = _option(
        None, "numbers", "K1,K2,...", "Inner knots in u, in (0, 1); uniform if left out."
    )
    middle_knots: Literal["fourth", "paper"] | Sequence[Sequence[float]] | None = _option(
        None,
        "lists-or-word",
        "K1,K2,...",
        "Inner knots of a middle curve, in v of edge A; once for each curve. Or fourth, or paper: by that rule.",
    )
    match: Literal["affine", "length"] | Sequence[tuple[float, float]] = _option(
        "affine", "pairs-or-word", "X:Y,...", "What answers what along the edges: affine, length, or X on A for Y on B."
    )
    limits: Limits | Auto = _option(
        "auto", "text", "LIMITS", "What contact is held to: exact, cad, or auto: cad along free curves of curved faces."
    )
    strict: bool = _option(False, "flag", "", "Refuse a blend with any warning.")
    search_meets: bool = _option(
        False,
        "flag",
        "",
        "Search a mesh for places where the blend meets itself or a base, if nothing rules them out.",
    )

    def __post_init__(self) -> None:
        checked = {
            "continuity": tuple(map(continuity_name, _pair(self.continuity, "continuity"))),
            "middle_curves": _count(self.middle_curves, "middle_curves", 0),
            "degree_u": _count(self.degree_u, "degree_u", 1),
            "method": _word(self.method, "method", get_args(Method)),
            "flip": _word(self.flip, "flip", get_args(Flip)),
            "alpha": None if self.alpha is None else tuple(map(_alpha, _pair(self.alpha, "alpha"))),
            "alpha_v": _word(self.alpha_v, "alpha_v", get_args(AlphaV)),
            "p2": _p2(self.p2),
            "bulge": tuple(map(_bulge, _pair(self.bulge, "bulge"))),
            "box": None if self.box is None else _box(self.box),
            "match": _match(self.match),
            "limits": limits_name(self.limits),
            "v_scale": None if self.v_scale is None else _word(self.v_scale, "v_scale", get_args(VScale)),
            "u_knots": None if self.u_knots is None else _knots(self.u_knots, "u_knots"),
            "middle_knots": None if self.middle_knots is None else _middle_knots(self.middle_knots),
        }
        for name in ("strict", "search_meets"):
            if not isinstance(value := getattr(self, name), bool):
                raise OptionError(f"{name}: found {value!r}, expected True or False")
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        # What contradicts itself is refused here, before anything is done with it.
        self._is_papers_set()
        self._check_sides()

    @property
    def continuities(self) -> tuple[Continuity, Continuity]:
        """Continuity at a and at b."""
        return cast("tuple[Continuity, Continuity]", self.continuity)

    @property
    def orders(self) -> tuple[int, int]:
        """How many derivatives agree at a and at b."""
        return int(self.continuities[0][1]), int(self.continuities[1][1])

    @property
    def alphas(self) -> tuple[Alpha | None, Alpha | None]:
        """What is asked of alpha and of beta."""
        return cast("tuple[Alpha | None, Alpha | None]", self.alpha or (None, None))

    @property
    def bulges(self) -> tuple[float, float]:
        """Bulge at a and at b."""
        return cast("tuple[float, float]", self.bulge)

    def _is_papers_set(self, minimises_energy: str = "") -> bool:
        """Tell whether (11) is minimised, and refuse what asks for something else beside it."""
        why = minimises_energy or ("alpha energy" if "energy" in self.alphas else f"method {self.method}")
        if why == "method reduced":
            return False
        for name, found, expected in (
            ("alpha", "fair" if "fair" in self.alphas else None, "energy, natural or a number; give alpha energy"),
            ("alpha", next((x for x in self.alphas if isinstance(x, tuple)), None), "one number for each side"),
            ("alpha_v", "linear" if self.alpha_v == "linear" else None, "constant"),
            ("p2", self.p2 if self.p2 not in ("auto", "zero") else None, "zero"),
            ("bulge", self.bulge if self.bulge != (1.0, 1.0) else None, "1"),
            ("continuity", next((c for c in self.continuities if int(c[1]) > 2), None), "at most G2"),
        ):
            if found is not None:
                other = {"alpha energy": "; or leave out alpha energy"}.get(why, "; or method reduced")
                raise OptionError(
                    f"{name}: found {found} with {why}, which minimises (11), expected {expected}"
                    + ("" if why == minimises_energy else other)
                )
        return True

    def _check_sides(self) -> None:
        """Refuse what a contact has no use for."""
        for i, (side, name) in enumerate(zip("ab", self.continuities, strict=True)):
            has_alpha, order = name[0] == "G" and name != "G0", int(name[1])
            if self.bulges[i] != 1 and not has_alpha:
                raise OptionError(f"bulge: found {self.bulges[i]:g} at {side}, expected 1: {name} has no alpha")
            if not isinstance(self.p2, str) and self.p2[i] != 0 and not (has_alpha and order > 1):
                raise OptionError(f"p2: found {self.p2[i]:g} at {side}, expected 0: {name} has no p2")
        if self.alpha_v == "linear" and not self._wants_fair_alpha():
            raise OptionError("alpha_v: found linear, but no alpha is searched; give alpha as X:Y, or leave it out")

    def _wants_fair_alpha(self) -> bool:
        """Tell whether a side has an alpha and leaves it to the fairest shape."""
        return any(
            alpha in (None, "fair") and name[0] == "G" and name != "G0"
            for alpha, name in zip(self.alphas, self.continuities, strict=True)
        )

    def decided(self, minimises_energy: str = "") -> BlendOptions:
        """Return the options with nothing unsaid: the set of the fairest shape, or the paper's where (11) is minimised.

        Parameters
        ----------
        minimises_energy : str
            Who minimises (11) whatever the method, such as "generated C"; messages name it.

        Raises
        ------
        OptionError
            Something that the minimum of (11) does not have was asked for beside it.

        Examples
        --------
        >>> decided = BlendOptions().decided()
        >>> decided.alpha, decided.degree_u, decided.middle_curves, decided.v_scale
        (('fair', 'fair'), 5, 0, 'length')
        >>> decided = BlendOptions(method="casadi").decided()
        >>> decided.alpha, decided.degree_u, decided.middle_curves, decided.v_scale
        (('energy', 'energy'), 3, 1, 'paper')
        """
        papers = self._is_papers_set(minimises_energy)
        # A box with equal ends leaves nothing to search.
        nothing_searched = not self._wants_fair_alpha() or (self.box is not None and self.box[0] == self.box[1])
        # G3 and G4 have a p2 in step with alpha^2, however that was found.
        without_p2 = papers or (nothing_searched and max(self.orders) <= 2)
        # Without a middle curve and inner knots: all that the contacts prescribe, and no more.
        across = sum(max(ROWS_PER_SIDE, order + 1) for order in self.orders) - 1
        unsaid = {
            "alpha": tuple(("energy" if papers else "fair") if x is None else x for x in self.alphas),
            "middle_curves": int(papers) if self.middle_curves == "auto" else self.middle_curves,
            "degree_u": (3 if papers else across) if self.degree_u == "auto" else self.degree_u,
            "alpha_v": "constant" if papers or (self.alpha_v == "auto" and nothing_searched) else self.alpha_v,
            "p2": "zero" if self.p2 == "auto" and without_p2 else self.p2,
            "limits": "exact" if self.limits == "auto" else self.limits,
            "v_scale": self.v_scale or ("paper" if papers else _V_SCALES.get(min(self.orders), "length")),
            "middle_knots": ("paper" if papers else "fourth") if self.middle_knots is None else self.middle_knots,
        }
        return replace(self, **cast("dict[str, Any]", unsaid))

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


def limits_name(value: object, name: str = "limits") -> Limits | Auto:
    """Return auto, exact or cad; messages call it `name`.

    Raises
    ------
    OptionError
        It is none of the three.
    """
    return cast("Limits | Auto", _word(value, name, ("auto", *get_args(Limits))))


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


def _alpha(value: object) -> Alpha | None:
    if value is None:
        return None
    if isinstance(value, str):
        if value in ("fair", "energy", "natural"):
            return cast("Alpha", value)
        raise OptionError(f"alpha: found {value!r}, expected fair, energy, natural or a positive number")
    if isinstance(value, tuple | list):
        if len(value) != 2:
            raise OptionError(f"alpha: found {len(value)} values on one side, expected one, or two for the ends of v")
        return _alpha_number(value[0]), _alpha_number(value[1])
    return _alpha_number(value)


def _alpha_number(value: object) -> float:
    number = real_number(value, "alpha", OptionError)
    if not 1 / _MOST_ALPHA <= number <= _MOST_ALPHA:
        raise OptionError(f"alpha: found {number:g}, expected {1 / _MOST_ALPHA:g} to {_MOST_ALPHA:g}")
    return number


def _count(value: object, name: str, least: int) -> int | str:
    if value == "auto":
        return "auto"
    if isinstance(value, str):
        raise OptionError(f"{name}: found {value!r}, expected auto or a whole number")
    return whole_number(value, name, least, OptionError)


def _p2(value: object) -> str | tuple[float, float]:
    if isinstance(value, str):
        return _word(value, "p2", ("auto", "zero"))
    ends = _items(value, "p2", "auto, zero or a pair of numbers")
    if len(ends) != 2:
        raise OptionError(f"p2: found {reprlib.repr(value)}, expected auto, zero or a pair of numbers, for a and b")
    first, second = (real_number(end, f"p2[{i}]", OptionError) for i, end in enumerate(ends))
    for i, number in enumerate((first, second)):
        if not abs(number) <= _MOST_BOX:
            raise OptionError(f"p2[{i}]: found {number:g}, expected {-_MOST_BOX:g} to {_MOST_BOX:g}")
    return first, second


def _bulge(value: object) -> float:
    number = real_number(value, "bulge", OptionError)
    if not 1 / _MOST_BULGE <= number <= _MOST_BULGE:
        raise OptionError(f"bulge: found {number:g}, expected {1 / _MOST_BULGE:g} to {_MOST_BULGE:g}")
    return number


def _middle_knots(value: object) -> str | tuple[tuple[float, ...], ...]:
    return _word(value, "middle_knots", ("fourth", "paper")) if isinstance(value, str) else _knot_lists(value)


def _match(value: object) -> str | tuple[tuple[float, float], ...]:
    if isinstance(value, str):
        return _word(value, "match", ("affine", "length"))
    found = []
    for i, pair in enumerate(_items(value, "match", "affine, length, or pairs of numbers")):
        ends = _items(pair, f"match[{i}]", "a pair of numbers")
        if len(ends) != 2:
            raise OptionError(f"match[{i}]: found {reprlib.repr(pair)}, expected a pair of numbers")
        found.append(tuple(real_number(x, f"match[{i}]", OptionError) for x in ends))
    if not found:
        raise OptionError("match: found no pairs, expected affine, length, or one pair at least")
    return tuple(found)  # type: ignore[arg-type]


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


def _knot_lists(values: object) -> tuple[tuple[float, ...], ...]:
    lists = _items(values, "middle_knots", "fourth, paper, or sequences of numbers")
    return tuple(_knots(inner, f"middle_knots[{i}]") for i, inner in enumerate(lists))


def _items(values: object, name: str, expected: str) -> list[Any]:
    if not isinstance(values, Iterable) or isinstance(values, str):
        raise OptionError(f"{name}: found {reprlib.repr(values)}, expected {expected}")
    return list(values)
