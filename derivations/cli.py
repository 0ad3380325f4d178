"""`semispline derive` and `semispline generate`. What loads SymPy waits inside the functions until a command runs."""

from __future__ import annotations

import shlex
from contextlib import redirect_stdout
from enum import StrEnum
from io import StringIO
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(add_completion=False, no_args_is_help=True, help="Derived formulas and the code generated from them.")


# What `derive` knows, here so that help need not load SymPy.
NAMES = (
    "basis-pieces",
    "contact-conditions",
    "contact-jets",
    "contact-rows",
    "derivative-rows",
    "end-derivatives",
    "energy",
    "energy-density",
    "fairness",
    "gram-block",
    "gram-entries",
    "homogeneous-conditions",
    "homogeneous-last",
    "joint-slopes",
    "joint-values",
    "linear-power",
    "linear-product",
    "shape-conditions",
    "shape-polynomial",
    "special-conditions",
    "stationarity",
    "strip-derivatives",
)


class _Form(StrEnum):
    text = "text"
    latex = "latex"
    numpy = "numpy"
    casadi = "casadi"
    c = "c"


class _End(StrEnum):
    start = "start"
    end = "end"


_Knots = Annotated[str | None, typer.Option(metavar="K0,K1,...", help="Full knot vector: numbers, fractions, names.")]
_Number = Annotated[int | None, typer.Option(help="A number; a symbol where left out.")]


def _fail(error: Exception) -> typer.Exit:
    typer.echo(f"error: {' '.join(str(error).split())}", err=True)
    return typer.Exit(2)


def _split(knots: str | None) -> tuple[str, ...] | None:
    return tuple(knot.strip() for knot in knots.split(",")) if knots is not None else None


@app.command()
def derive(
    name: Annotated[str, typer.Argument(metavar="NAME", help=f"What to show: {', '.join(NAMES)}.")],
    form: Annotated[_Form, typer.Option(help="How to show it.")] = _Form.text,
    order: Annotated[int, typer.Option(help="Order of contact, or highest derivative: 0 to 4.")] = 2,
    degree: _Number = None,
    base_degree: _Number = None,
    end: Annotated[_End, typer.Option(help="The clamped end where derivatives are taken.")] = _End.start,
    derivative: Annotated[int, typer.Option(help="Order of the derivatives in Gram entries.")] = 0,
    knots: _Knots = None,
    other_degree: _Number = None,
    other_knots: _Knots = None,
    breakpoints: Annotated[
        str | None, typer.Option(metavar="B0,B1,...", help="All knots ascending, where both vectors hold names.")
    ] = None,
) -> None:
    """Show a derived result: contact rows, end derivatives, Gram entries, energy, general conditions.

    Degree and base degree are those of the blend in u and of the base across the contact; for knot vectors, of the
    spline (3 where left out).
    """
    from semispline.derivations.results import Request, show

    try:
        request = Request(
            order=order,
            degree=degree,
            base_degree=base_degree,
            knots=_split(knots),
            other_knots=_split(other_knots),
            other_degree=other_degree,
            breakpoints=_split(breakpoints),
            derivative=derivative,
            end=end.value,
        )
        typer.echo(show(name, request, form.value), nl=False)
    except ValueError as error:
        raise _fail(error) from None


def derived(call: str) -> str:
    r"""Return what `semispline derive` prints for arguments written on one line.

    Raises
    ------
    ValueError
        Arguments that `derive` refuses.

    Examples
    --------
    >>> derived("energy-density")
    'e = P_uu**2 + 2 * P_uv**2 + P_vv**2\n'
    """
    output = StringIO()
    with redirect_stdout(output):
        code = app(["derive", *shlex.split(call)], standalone_mode=False)
    if code:
        raise ValueError(f"derive {call}: refused")
    return output.getvalue()


@app.command()
def generate(
    check: Annotated[bool, typer.Option("--check", help="Write nothing: show differences, exit 1 if any.")] = False,
) -> None:
    """Write solver/generated and the formulas of docs/theory.md from the derivations (in a checkout only)."""
    from semispline.derivations.codegen.files import checkout_root, differences, expected_files, write_files

    try:
        root = checkout_root(Path(__file__).parent)
        expected = expected_files(root, derived)
        changed = [] if check else write_files(root, expected)
    except (ValueError, OSError) as error:
        raise _fail(error) from None
    if not check:
        for path in changed:
            typer.echo(f"{'wrote' if path in expected else 'removed'} {path}")
        if not changed:
            typer.echo("generated files are up to date")
        return
    difference = differences(root, expected)
    if difference:
        typer.echo(difference, nl=False)
        typer.echo("generated files differ from the derivations; run `semispline generate`", err=True)
        raise typer.Exit(1)


if __name__ == "__main__":
    app(prog_name="semispline")
