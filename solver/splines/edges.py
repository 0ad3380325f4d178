"""Names of the edges of a surface, and the surface cut so that what is named is a natural edge.

`u1`, where u ends; `u1[0.2,0.6]`, the part of it over that range of v; `u=0.3+`, the line inside on which u is 0.3, of
the part of the surface where u is larger (`-`: smaller); `u=0.3+[0.2,0.6]`, a part of that line; and so with u and v
exchanged. All parameters are the surface's own.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Literal, NoReturn, TypeAlias, TypeVar, cast

from semispline.solver.arrays import require
from semispline.solver.errors import EdgeError, InputError
from semispline.solver.scalars import real_number
from semispline.solver.splines.knots import MERGE_TOLERANCE
from semispline.solver.splines.operations import restrict_u, restrict_v
from semispline.solver.splines.refinement import snapped
from semispline.solver.splines.seam import move_seam
from semispline.solver.splines.surfaces import BSplineSurface, SemiStructuredSurface, Surface

NaturalEdge: TypeAlias = Literal["u0", "u1", "v0", "v1"]
S = TypeVar("S", bound=Surface)

_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_WORD = re.compile(
    rf"(?P<direction>[uv])(?:(?P<end>[01])|=\s*(?P<at>{_NUMBER})\s*(?P<sign>[+-]))"
    rf"(?:\s*\[\s*(?P<low>{_NUMBER})\s*,\s*(?P<high>{_NUMBER})\s*\])?"
)
_SIGNLESS = re.compile(rf"([uv])=\s*({_NUMBER})\s*(\[.*\])?")
# What edges of the faces of a file are called; their surfaces do not know them.
_OF_A_FACE = re.compile(r"e[0-9]+|near=.*")
_FORMS = "u0, u1, v0, v1, a part u1[0.2,0.6], a line inside u=0.3+ or u=0.3-, or a part of it u=0.3+[0.2,0.6]"


@dataclass(frozen=True)
class EdgeName:
    """The name of an edge; `str` prints it as `parse_edge` reads it, to the last digit.

    Parameters
    ----------
    direction : {"u", "v"}
        The parameter that is constant along the edge.
    end : {0, 1}
        At which end of its range the edge lies in the part of the surface that is kept: 0 is the sign +.
    at : float or None
        Its value on a line inside; None at the end of the surface itself.
    part : (float, float) or None
        The range of the other parameter, where it is not the whole one.

    Raises
    ------
    EdgeError
        Values that name no edge.

    Examples
    --------
    >>> str(EdgeName("u", 0, at=0.3, part=(0.2, 0.6)))
    'u=0.3+[0.2,0.6]'
    """

    direction: Literal["u", "v"]
    end: Literal[0, 1]
    at: float | None = None
    part: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if self.direction not in ("u", "v") or self.end not in (0, 1):
            raise EdgeError(f"edge: found direction {self.direction!r} and end {self.end!r}, expected u or v, 0 or 1")
        if self.at is not None:
            object.__setattr__(self, "at", _finite(self.at))
        if self.part is not None:
            low, high = self.part
            object.__setattr__(self, "part", (_finite(low), _finite(high)))
        if self.part is not None and not self.part[0] < self.part[1]:
            first, last = map(_shown, self.part)
            what = "is empty" if first == last else f"runs backwards, expected [{last},{first}]"
            raise EdgeError(f"edge {self}: the part [{first},{last}] {what}")

    def __str__(self) -> str:
        part = "" if self.part is None else "[{},{}]".format(*map(_shown, self.part))
        if self.at is None:
            return f"{self.direction}{self.end}{part}"
        return f"{self.direction}={_shown(self.at)}{'+-'[self.end]}{part}"

    @property
    def along(self) -> Literal["u", "v"]:
        """The parameter that runs along the edge."""
        return "v" if self.direction == "u" else "u"

    @property
    def natural(self) -> NaturalEdge:
        """What the edge is called on the part of the surface that is kept."""
        return cast(NaturalEdge, f"{self.direction}{self.end}")


def parse_edge(word: str | EdgeName, name: str = "edge") -> EdgeName:
    """Return the edge that a word names; messages call the word `name`.

    Raises
    ------
    EdgeError
        No name of an edge, or a part that is empty or runs backwards.

    Examples
    --------
    >>> parse_edge("v=2.5-")
    EdgeName(direction='v', end=1, at=2.5, part=None)
    """
    if isinstance(word, EdgeName):
        return word
    found = _WORD.fullmatch(word.strip()) if isinstance(word, str) else None
    if found is None:
        _refuse(word, name)
    part = None if found["low"] is None else (float(found["low"]), float(found["high"]))
    at = None if found["at"] is None else float(found["at"])
    end = int(found["end"]) if at is None else "+-".index(found["sign"])
    try:
        return EdgeName(cast(Literal["u", "v"], found["direction"]), cast(Literal[0, 1], end), at, part)
    except EdgeError as error:
        raise EdgeError(str(error).replace("edge", name, 1)) from None


def _refuse(word: object, name: str) -> NoReturn:
    text = word.strip() if isinstance(word, str) else ""
    if signless := _SIGNLESS.fullmatch(text):
        direction, at, part = signless[1], signless[2], signless[3] or ""
        raise EdgeError(
            f"{name}: found {word!r}, which does not say which side of the line is kept, expected "
            f"{direction}={at}+{part} (where {direction} is larger) or {direction}={at}-{part} (where it is smaller)"
        )
    if _OF_A_FACE.fullmatch(text):
        raise EdgeError(
            f"{name}: found {word!r}, an edge of a face in a file, which a surface alone does not know, expected "
            f"one of {_FORMS}; resolve_edge finds the name in this form"
        )
    raise EdgeError(f"{name}: found {word!r}, expected one of {_FORMS}")


def cut_to_edge(surface: S, edge: str | EdgeName) -> tuple[S, NaturalEdge]:
    """Return the part of a surface that an edge bounds, and the natural edge of the part that it is.

    Exact: knots are inserted. The part has the surface's own parameters. A value within 1e-12 of the range of a knot or
    an end means that one. In a closed direction a part may run across the seam, beyond the end of the range: there
    parameters go on.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
        Rational too.
    edge : str or EdgeName

    Returns
    -------
    BSplineSurface or SemiStructuredSurface
        `surface` itself where nothing is cut off.
    {"u0", "u1", "v0", "v1"}

    Raises
    ------
    EdgeError
        No name of an edge, or a parameter outside of the surface, a sign that keeps nothing of it, or a part beyond a
        seam where the surface is not closed.

    Source: W. Boehm, Inserting new knots into B-spline curves, 1980.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> part, natural = cut_to_edge(square, "u=0.25-[0.5,1]")
    >>> part.domain, natural
    (((0.0, 0.25), (0.5, 1.0)), 'u1')
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    name = parse_edge(edge)
    return _part(_side_of_line(surface, name), name), name.natural


def _side_of_line(surface: S, name: EdgeName) -> S:
    """Return the part of the surface on the side of a line that is kept."""
    if name.at is None:
        return surface
    d = name.direction
    start, end = surface.domain["uv".index(d)]
    at = _snapped(surface, d, name.at)
    if not start <= at <= end:
        raise EdgeError(
            f"edge {name}: {_shown(name.at)} lies outside of the range of {d}, [{_shown(start)},{_shown(end)}]"
        )
    low, high = (start, at) if name.end else (at, end)
    if low == high:
        sign, other = "+-"[name.end], "-+"[name.end]
        raise EdgeError(
            f"edge {name}: nothing lies on the side {sign} of it, {d} {'begins' if name.end else 'ends'} at "
            f"{_shown(at)}; {d}{1 - name.end} or {d}={_shown(name.at)}{other} keeps the surface"
        )
    return _restricted(surface, d, low, high)


def _part(surface: S, name: EdgeName) -> S:
    """Return the surface over a part of the parameter that runs along the edge."""
    if name.part is None:
        return surface
    d = name.along
    start, end = surface.domain["uv".index(d)]
    low, high = (_snapped(surface, d, value) for value in name.part)
    least = MERGE_TOLERANCE * (end - start)
    if high - low <= least:
        raise EdgeError(f"edge {name}: the part is {high - low:.3g} long, expected more than {least:.3g} of {d}")
    if start < low < end < high:
        surface = _across_the_seam(surface, name, low)
        start, end = surface.domain["uv".index(d)]
        low, high = start, _snapped(surface, d, name.part[1])
    if not (start <= low and high <= end):
        outside = name.part[0] if low < start or low > end else name.part[1]
        raise EdgeError(
            f"edge {name}: {_shown(outside)} lies outside of the range of {d}, [{_shown(start)},{_shown(end)}]"
        )
    return _restricted(surface, d, low, high)


def _across_the_seam(surface: S, name: EdgeName, low: float) -> S:
    """Return a closed surface that begins where the part does."""
    d = name.along
    start, end = surface.domain["uv".index(d)]
    try:
        return cast(S, move_seam(cast(Any, surface), **{d: low}))
    except InputError as error:
        raise EdgeError(
            f"edge {name}: beyond the range of {d}, [{_shown(start)},{_shown(end)}], there is no way across the seam "
            f"({error}); end the part at {_shown(end)}"
        ) from None


def _restricted(surface: S, direction: str, low: float, high: float) -> S:
    if (low, high) == surface.domain["uv".index(direction)]:
        return surface
    restrict = restrict_u if direction == "u" else restrict_v
    return cast(S, restrict(cast(Any, surface), low, high))


def _snapped(surface: S, direction: str, value: float) -> float:
    """Return the breakpoint that a value means, else the value."""
    return snapped(value, surface.breakpoints["uv".index(direction)])


def _finite(value: object) -> float:
    number = real_number(value, "edge: a parameter", EdgeError)
    if not abs(number) < float("inf"):
        raise EdgeError(f"edge: a parameter is {number}, expected a finite one")
    # Zero has no sign.
    return number + 0.0


def _shown(value: float) -> str:
    """Return a parameter in as few digits as read back as the same number."""
    return repr(float(value)).removesuffix(".0")
