"""The commands blend, problem, check, list, show and convert; `semispline.papers.cli` mounts them beside its own."""

from __future__ import annotations

import typer

from semispline.solver.cli.blending import blend_command, problem_command
from semispline.solver.cli.checking import check_command
from semispline.solver.cli.listing import list_command
from semispline.solver.cli.showing import convert_command, show_command

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)
app.command("blend")(blend_command)
app.command("problem")(problem_command)
app.command("check")(check_command)
app.command("list")(list_command)
app.command("show")(show_command)
app.command("convert")(convert_command)
