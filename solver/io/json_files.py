"""The `semispline/1` JSON format: surfaces and whole blend problems.

Numbers are written so that they read back as the same float64; files are written whole or not at all. What the
format adds to the design document: points of two coordinates lie in the plane z = 0; v-control curves may have weights;
where those of a surface differ in degree, a curve states its own `degree_v`; one that does not has that of the surface,
which is the highest.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, TypeAlias, TypeVar

from pydantic import AllowInfNan, BaseModel, ConfigDict, Field, Strict, ValidationError

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import ControlPointError, EdgeError, FileError, InputError, OptionError
from semispline.solver.io.disk import write_text
from semispline.solver.io.json_text import load_json, short, to_text
from semispline.solver.options import BlendOptions, named_options
from semispline.solver.splines import (
    BSplineCurve,
    BSplineSurface,
    SemiStructuredSurface,
    Surface,
    clamped_surface,
    parse_edge,
)

FORMAT = "semispline/1"

_Number: TypeAlias = Annotated[float, Strict(), AllowInfNan(False)]
_Degree: TypeAlias = Annotated[int, Strict(), Field(ge=1)]
_Text: TypeAlias = Annotated[str, Strict()]
_Points: TypeAlias = list[list[_Number]]


# A free curve of a face in a file, or a part of it; or edges that run end to end, of other faces with their number.
_ONE = r"e[0-9]{1,9}(\[[0-9]{1,9}\])?"
_FREE = re.compile(rf"{_ONE}(\+([0-9]{{1,9}}:)?{_ONE})*")
# Knots beyond it are for the surface to refuse.
_HUGE = 1e300


class _Record(BaseModel):
    model_config = ConfigDict(extra="forbid")


class _BSplineRecord(_Record):
    degree_u: _Degree
    degree_v: _Degree
    knots_u: list[_Number]
    knots_v: list[_Number]
    control_points: list[_Points]
    weights: list[list[_Number]] | None = None


class _CurveRecord(_Record):
    degree_v: _Degree | None = None
    knots_v: list[_Number]
    control_points: _Points
    weights: list[_Number] | None = None


class _SemiStructuredRecord(_Record):
    degree_u: _Degree
    degree_v: _Degree
    knots_u: list[_Number]
    control_curves: list[_CurveRecord]


class _ProblemRecord(_Record):
    a: _Text | dict[str, Any]
    edge_a: _Text
    b: _Text | dict[str, Any]
    edge_b: _Text
    asked_a: _Text | None = None
    asked_b: _Text | None = None
    options: dict[str, Any] = {}


@dataclass(frozen=True)
class StoredProblem:
    """A blend problem as a file holds it.

    Parameters
    ----------
    a, b : BSplineSurface, SemiStructuredSurface or str
        A surface, or "PATH#N" with PATH relative to the folder of the file.
    edge_a, edge_b : str
        As `Base` takes them: "u1", "u=0.3+[0.2,0.6]"; of "PATH#N" also "e3" or "e3[0]", a free curve of the face,
        and "e3+e4", "e3+13:e1", edges that run end to end.
    options : BlendOptions
    asked_a, asked_b : str, optional
        What was asked for where that is another word, "e3", "e3*" or "near=1,2,3": of the face in the file.

    Raises
    ------
    EdgeError
        No name of an edge.
    OptionError
        Options that are no BlendOptions.
    """

    a: Surface | str
    edge_a: str
    b: Surface | str
    edge_b: str
    options: BlendOptions = field(default_factory=BlendOptions)
    asked_a: str | None = None
    asked_b: str | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.options, BlendOptions):
            raise OptionError(f"options: found a {type(self.options).__name__}, expected a BlendOptions")
        for name in "ab":
            word, of_file = getattr(self, f"edge_{name}"), isinstance(getattr(self, name), str)
            object.__setattr__(self, f"edge_{name}", _edge_word(word, f"edge_{name}", of_file))


def _edge_word(word: str, name: str, of_file: bool) -> str:
    return word if of_file and _FREE.fullmatch(word) else str(parse_edge(word, name))


def read_json_surface(path: str | Path) -> Surface:
    """Read a surface of either kind; unclamped and periodic knots are clamped exactly.

    Raises
    ------
    FileError
        Missing, not JSON, of another kind, or with a value of a wrong type.
    KnotError, ControlPointError
        Values that make no surface.
    """
    return surface_from_record(load_json(path), str(path))


def write_json_surface(path: str | Path, surface: Surface) -> None:
    """Write a surface of either kind.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    write_text(path, to_text(surface_record(surface)))


def read_problem(path: str | Path) -> StoredProblem:
    """Read a blend problem; "PATH#N" in it comes back relative to the working folder, not yet opened.

    Raises
    ------
    FileError, EdgeError, KnotError, ControlPointError
        As `read_json_surface`.
    OptionError
        An option that `blend` does not have, or a value that it cannot take.
    """
    where = str(path)
    record = _validated(_ProblemRecord, _content(load_json(path), ("blend_problem",), where), where)
    folder = Path(path).parent

    def base(value: str | dict[str, Any], name: str) -> Surface | str:
        return str(folder / value) if isinstance(value, str) else surface_from_record(value, f"{where}: {name}")

    a, b = base(record.a, "a"), base(record.b, "b")
    options = _options(record.options, where)
    try:
        return StoredProblem(a, record.edge_a, b, record.edge_b, options, record.asked_a, record.asked_b)
    except EdgeError as error:
        raise EdgeError(f"{where}: {error}") from None


def _options(record: dict[str, Any], where: str) -> BlendOptions:
    try:
        return named_options(None, record)
    except OptionError as error:
        raise OptionError(f"{where}: options.{error}") from None


def write_problem(path: str | Path, problem: StoredProblem) -> None:
    """Write a blend problem.

    Raises
    ------
    FileError
        The file cannot be written.
    """

    def base(value: Surface | str) -> Any:
        return value if isinstance(value, str) else surface_record(value)

    record = {
        "format": FORMAT,
        "kind": "blend_problem",
        "a": base(problem.a),
        "edge_a": problem.edge_a,
        "b": base(problem.b),
        "edge_b": problem.edge_b,
    }
    asked = {"asked_a": problem.asked_a, "asked_b": problem.asked_b}
    record |= {name: word for name, word in asked.items() if word is not None}
    write_text(path, to_text(record | {"options": problem.options.said()}))


def surface_record(surface: Surface) -> dict[str, Any]:
    """Return what the file holds of a surface: plain lists and numbers.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> surface_record(square)["knots_u"]
    [0.0, 0.0, 1.0, 1.0]
    """
    if isinstance(surface, SemiStructuredSurface):
        curves = []
        for curve in surface.control_curves:
            own = {} if curve.degree == surface.degree_v else {"degree_v": curve.degree}
            points = {"knots_v": curve.knots.tolist(), "control_points": curve.control_points.tolist()}
            weights = {} if curve.weights is None else {"weights": curve.weights.tolist()}
            curves.append(own | points | weights)
        return {
            "format": FORMAT,
            "kind": "semistructured_surface",
            "degree_u": surface.degree_u,
            "degree_v": surface.degree_v,
            "knots_u": surface.knots_u.tolist(),
            "control_curves": curves,
        }
    record: dict[str, Any] = {
        "format": FORMAT,
        "kind": "bspline_surface",
        "degree_u": surface.degree_u,
        "degree_v": surface.degree_v,
        "knots_u": surface.knots_u.tolist(),
        "knots_v": surface.knots_v.tolist(),
        "control_points": surface.control_points.tolist(),
    }
    if surface.weights is not None:
        record["weights"] = surface.weights.tolist()
    return record


def surface_from_record(record: Any, where: str = "surface") -> Surface:
    """Return the surface that a record holds; `where` opens every message.

    Raises
    ------
    FileError, KnotError, ControlPointError
        As `read_json_surface`.
    """
    content = _content(record, ("bspline_surface", "semistructured_surface"), where)
    if record["kind"] == "bspline_surface":
        plain = _validated(_BSplineRecord, content, where)
        for i, row in enumerate(plain.control_points):
            if len(row) != len(plain.control_points[0]):
                wanted = len(plain.control_points[0])
                raise ControlPointError(
                    f"{where}: control_points[{i}]: {len(row)} points, expected {wanted} as in row 0"
                )
            _check_points(row, plain.control_points[0], f"{where}: control_points[{i}]")
        n_u, n_v = len(plain.control_points), len(plain.control_points[0]) if plain.control_points else 0
        both = ((plain.knots_u, plain.degree_u, n_u), (plain.knots_v, plain.degree_v, n_v))
        make = clamped_surface if any(_is_unclamped(*one) for one in both) else BSplineSurface
        return _made(
            where,
            lambda: make(
                plain.degree_u,
                plain.degree_v,
                _list(plain.knots_u),
                _list(plain.knots_v),
                _list(plain.control_points),
                None if plain.weights is None else _list(plain.weights),
            ),
        )
    semi = _validated(_SemiStructuredRecord, content, where)
    for i, found in enumerate(semi.control_curves):
        _check_points(found.control_points, found.control_points, f"{where}: control_curves[{i}].control_points")

    def curve(i: int, found: _CurveRecord) -> BSplineCurve:
        degree = semi.degree_v if found.degree_v is None else found.degree_v
        if degree > semi.degree_v:
            raise FileError(
                f"control_curves[{i}].degree_v: found {degree}, expected at most that of the surface, {semi.degree_v}"
            )
        weights = None if found.weights is None else _list(found.weights)
        points = _list(found.control_points)
        return BSplineCurve(degree, _list(found.knots_v), points, weights, name=f"control_curves[{i}]")

    return _made(
        where,
        lambda: SemiStructuredSurface(
            semi.degree_u, _list(semi.knots_u), tuple(curve(i, c) for i, c in enumerate(semi.control_curves))
        ),
    )


def _is_unclamped(knots: list[float], degree: int, n_control: int) -> bool:
    """Tell whether knots describe a spline that has to be clamped; what describes none is for the surface to refuse."""
    if not degree < n_control == len(knots) - degree - 1 or knots != sorted(knots):
        return False
    if not abs(knots[0]) + abs(knots[-1]) < _HUGE:
        return False
    if not knots[degree] < knots[-degree - 1]:
        return False
    # An end that is repeated more often goes with a point that acts nowhere.
    ends = (knots[: degree + 1], knots[degree + 1]), (knots[-degree - 1 :], knots[-degree - 2])
    return any(len(set(end)) > 1 or next_knot == end[0] for end, next_knot in ends)


def _content(record: Any, kinds: Sequence[str], where: str) -> dict[str, Any]:
    """Return the record without `format` and `kind`, both checked."""
    if not isinstance(record, dict):
        raise FileError(f"{where}: found {short(record)}, expected an object with keys format, kind, ...")
    if record.get("format") != FORMAT:
        raise FileError(f"{where}: format is {short(record.get('format'))}, expected {FORMAT!r}")
    if record.get("kind") not in kinds:
        expected = " or ".join(map(repr, kinds))
        raise FileError(f"{where}: kind is {short(record.get('kind'))}, expected {expected}")
    return {key: value for key, value in record.items() if key not in ("format", "kind")}


_R = TypeVar("_R", bound=_Record)
_T = TypeVar("_T")


def _validated(model: type[_R], content: dict[str, Any], where: str) -> _R:
    try:
        return model.model_validate(content)
    except ValidationError as error:
        raise FileError(f"{where}: {_first_fault(error).lstrip('.')}") from None


def _first_fault(error: ValidationError) -> str:
    fault = error.errors(include_url=False, include_context=False)[0]
    # Unions put the name of their member into the place; only keys and indices belong there.
    place = "".join(
        f"[{part}]" if isinstance(part, int) else f".{part}"
        for part in fault["loc"]
        if isinstance(part, int) or (part.isidentifier() and part not in ("str", "float"))
    )
    if fault["type"] == "missing":
        return f"{place}: missing, expected a value"
    if fault["type"] == "extra_forbidden":
        return f"{place}: no such key in this kind; leave it out"
    # pydantic says "Input should be a valid number".
    expected = fault["msg"].removeprefix("Input should be ")
    return f"{place}: found {short(fault['input'])}, expected {expected}"


def _check_points(points: list[list[float]], first_row: list[list[float]], where: str) -> None:
    """Refuse points unless all have as many coordinates as the first one: 3, or 2 in the plane z = 0."""
    for j, point in enumerate(points):
        if len(point) not in (2, 3):
            raise ControlPointError(f"{where}[{j}]: {len(point)} coordinate(s), expected 3, or 2 where z is 0")
        if len(point) != len(first_row[0]):
            wanted = len(first_row[0])
            raise ControlPointError(
                f"{where}[{j}]: {len(point)} coordinate(s), expected {wanted} as in the first point"
            )


def _made(where: str, make: Callable[[], _T]) -> _T:
    try:
        return make()
    except InputError as error:
        raise type(error)(f"{where}: {error}") from None


def _list(values: list[Any]) -> FloatArray:
    # The surface classes turn nested lists into arrays, and say which index is at fault.
    return values  # type: ignore[return-value]
