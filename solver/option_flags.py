"""Flags of the command line for the fields of `BlendOptions`, so that an option is written once."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator
from dataclasses import Field, fields
from typing import Annotated, Any

import typer

from semispline.solver.errors import OptionError
from semispline.solver.options import BlendOptions

# How the command line reads each form of option. None is unsaid.
_READ_AS: dict[str, Any] = {
    "text": str | None,
    "number-or-word": str | None,
    "numbers-or-word": str | None,
    "pairs-or-word": str | None,
    "range": tuple[float, float] | None,
    "numbers": str | None,
    "lists-or-word": list[str] | None,
    "flag": bool | None,
}


def takes_blend_options(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command a flag for each field of `BlendOptions`; its parameter `options` gets what was said.

    A field that may differ at the two edges has a second flag, such as `--alpha-b`, or two of one kind, `--bulge-a`.
    """
    given = inspect.signature(command, eval_str=True)
    own = [p for p in given.parameters.values() if p.name != "options"]
    flags = [flag for option in fields(BlendOptions) for flag in _flags(option)]

    @functools.wraps(command)
    def run(**said: Any) -> None:
        options = {flag.name: said.pop(flag.name) for flag in flags}
        command(**said, options=BlendOptions(**dict(_said(options))))

    # Flags with defaults follow the arguments that have none.
    parameters = sorted([*own, *flags], key=lambda p: p.default is not inspect.Parameter.empty)
    run.__signature__ = given.replace(parameters=parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {p.name: p.annotation for p in parameters}
    return run


def _flags(option: Field[Any]) -> Iterator[inspect.Parameter]:
    form, metavar, text = (option.metadata[key] for key in ("form", "metavar", "help"))
    name = _flag(option)
    default = False if form == "flag" or option.default is None else _shown(option.default)
    words: dict[str, Any] = {"help": text, "show_default": default}
    if metavar:
        words["metavar"] = metavar
    yield _parameter(option.name, form, typer.Option(name, **words))
    if option.metadata["sides"]:
        differs = "where it differs" if option.metadata["sides"] == "both" else "alone"
        words |= {"help": f"The same at B, {differs}.", "show_default": False}
        yield _parameter(f"{option.name}_b", form, typer.Option(f"{name.removesuffix('-a')}-b", **words))


def _flag(option: Field[Any]) -> str:
    return "--" + option.name.replace("_", "-") + ("-a" if option.metadata["sides"] == "each" else "")


def _parameter(name: str, form: str, flag: Any) -> inspect.Parameter:
    kind = inspect.Parameter.KEYWORD_ONLY
    return inspect.Parameter(name, kind, default=None, annotation=Annotated[_READ_AS[form], flag])


def _shown(default: Any) -> str:
    return " ".join(f"{x:g}" for x in default) if isinstance(default, tuple) else str(default)


def _said(values: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield name and value of each option that was said, as `BlendOptions` takes it."""
    for option in fields(BlendOptions):
        first, second = values[option.name], values.get(f"{option.name}_b")
        if first is None and second is None:
            continue
        form, name, sides = option.metadata["form"], _flag(option), option.metadata["sides"]
        at_a = option.default if first is None else _value(form, name, first)
        at_b = option.default if sides == "each" else at_a
        if second is not None:
            at_b = _value(form, f"{name.removesuffix('-a')}-b", second)
        # A pair on a side is no pair of sides.
        is_pair = second is not None or sides == "each" or (sides and isinstance(at_a, tuple))
        yield option.name, (at_a, at_b) if is_pair else at_a


def _value(form: str, name: str, said: Any) -> Any:
    if form in ("number-or-word", "numbers-or-word"):
        if form == "numbers-or-word" and ":" in said:
            return tuple(_numbers(name, said, ":"))
        return _number_or_word(said)
    if form == "pairs-or-word":
        return said if said.isalpha() else [_numbers(name, part, ":") for part in said.split(",")]
    if form == "numbers":
        return _numbers(name, said, ",")
    if form == "lists-or-word":
        return said[0] if len(said) == 1 and said[0].isalpha() else [_numbers(name, text, ",") for text in said]
    return said


def _number_or_word(said: str) -> Any:
    for kind in (int, float):
        try:
            return kind(said)
        except ValueError:
            continue
    return said


def _numbers(name: str, text: str, between: str) -> list[float]:
    try:
        # A list may be empty; a pair with an end left out is none.
        return [float(part) for part in text.split(between) if between == ":" or part.strip()]
    except ValueError:
        word = {",": "commas", ":": "colons"}[between]
        raise OptionError(f"{name}: found {text!r}, expected numbers with {word} between them") from None
