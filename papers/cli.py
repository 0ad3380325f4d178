"""The `semispline` script: verify and reproduce, with the commands of `solver` and `derivations` mounted beside them.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from semispline import __version__
from semispline.derivations import cli as derivations_cli
from semispline.solver import cli as solver_cli
from semispline.solver.exit_status import ANSWER_IS_NO, FAILED, WRONG_INPUT, reports_errors
from semispline.solver.reports import print_warnings

if TYPE_CHECKING:
    from semispline.papers.ledger import Ledger
    from semispline.papers.recheck import Recheck

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Verified blending of B-spline surfaces, and what the paper behind it claims.",
)


def _show_version(asked: bool) -> None:
    if asked:
        typer.echo(f"semispline {__version__}")
        raise typer.Exit


Name = Annotated[
    str,
    typer.Argument(
        metavar="PAPER",
        help="A paper of this package, or a folder with printed.py and claims.py, which are run as Python.",
    ),
]


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", is_eager=True, callback=_show_version, help="Show the version and exit.")
    ] = False,
) -> None:
    pass


@app.command("verify")
@reports_errors
def verify_command(
    paper: Name = "lin2014",
    json_file: Annotated[
        str | None, typer.Option("--json", metavar="FILE", help="Write the decided ledger; - is standard output.")
    ] = None,
    markdown: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Write all records; what a study found stays at the end of the file."),
    ] = None,
    erratum: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Write two pages for a reader of the paper, their picture beside them."),
    ] = None,
    recheck: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SYSTEM",
            help="Have pari, or the kernel of coq (minutes), repeat what verdicts rest on; twice for both.",
        ),
    ] = None,
    certificates: Annotated[
        str | None, typer.Option(metavar="DIR", help="Write what verdicts rest on, for PARI and for Coq alone.")
    ] = None,
    draft: Annotated[
        bool,
        typer.Option("--draft", help="Show what the checks of unfinished claims find and what they lack; exit 0."),
    ] = False,
) -> None:
    """Decide every claim of a paper anew; exit status 1 if a verdict is not the recorded one, 3 if one is missing."""
    from semispline.papers.ledger import paper_files
    from semispline.papers.recheck import require_folder, require_system
    from semispline.papers.report import ledger_markdown, ledger_record, require_erratum, with_study_kept, write_erratum
    from semispline.solver.io import check_outputs, to_text, write_text

    if draft:
        given = {
            "--json": json_file, "--markdown": markdown, "--erratum": erratum, "--recheck": recheck,
            "--certificates": certificates,
        }  # fmt: skip
        _show_drafts(paper, [option for option, value in given.items() if value is not None])
        return
    outputs = {"--json": None if json_file == "-" else json_file, "--markdown": markdown, "--erratum": erratum}
    check_outputs(outputs, paper_files(paper))
    if erratum is not None:
        require_erratum(paper)
    for system in recheck or ():
        require_system(system)
    if certificates is not None:
        require_folder(certificates)
    ledger = decided(paper)
    second = _second_systems(ledger, recheck or [], certificates) if recheck or certificates else None
    if json_file == "-":
        typer.echo(to_text(ledger_record(ledger, second)), nl=False)
    elif json_file is not None:
        write_text(json_file, to_text(ledger_record(ledger, second)))
    if markdown is not None:
        file = Path(markdown)
        before = file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""
        write_text(markdown, with_study_kept(ledger_markdown(ledger), before))
    if erratum is not None:
        write_erratum(ledger, erratum)
    if json_file != "-":
        print_ledger(ledger)
        if second is not None:
            typer.echo(recheck_text(second))
    if second is not None:
        for problem in second.problems:
            typer.echo(problem, err=True)
    _end_as(ledger, agrees=second is None or second.agrees)


def _show_drafts(paper: str, others: list[str]) -> None:
    """Show decided records as ever, and what the checks of the others find."""
    from semispline.papers.ledger import load_drafts, verify_drafts
    from semispline.papers.report import draft_text
    from semispline.solver.errors import OptionError

    if others:
        raise OptionError(f"--draft: found {others[0]} beside it, expected it alone")
    claims = {claim.id: claim for claim in load_drafts(paper).claims}
    with _progress("looking", len(claims)) as advance:
        ledger, drafts = verify_drafts(paper, workers=_workers(), progress=lambda found: advance(found.id))
    if ledger.decisions:
        print_ledger(ledger)
    for finding in drafts:
        typer.echo(f"\n{draft_text(claims[finding.id], finding)}")
    typer.echo(f"\n{len(drafts)} {'draft' if len(drafts) == 1 else 'drafts'}, {len(ledger.decisions)} complete")


def _workers() -> int:
    return min(os.cpu_count() or 1, 8)


def _second_systems(ledger: Ledger, systems: list[str], folder: str | None) -> Recheck:
    """Export what the verdicts of a ledger rest on, write it where asked, and have it repeated where asked."""
    from semispline.papers.recheck import Recheck, exported, kernel_checked, rechecked, write_certificates

    export = exported(ledger.paper)
    if folder is not None:
        write_certificates(folder, export)
    found = rechecked(export, folder) if "pari" in systems else Recheck(export)
    return replace(found, kernel=kernel_checked(export, folder)) if "coq" in systems else found


def recheck_text(second: Recheck) -> str:
    """Return what was exported and what the second system agrees on, and why records are not repeated as a whole."""
    counts = second.counts()
    done = (
        f", {counts['identities_agreed']} agreed; {counts['rechecked']} records rechecked as a whole"
        if second.refused is not None
        else ""
    )
    said = f"{counts['identities_exported']} identities exported{done}; {counts['not_expressible']} not expressible"
    same = f"{counts['identities_of_one_text']} identities are one text on both sides, and not counted"
    lines = [said, *([same] if counts["identities_of_one_text"] else []), *_by_reason(second.reasons())]
    if second.kernel is not None:
        lines += [
            f"Coq {second.kernel.version}: {counts['kernel_identities']} identities and {counts['kernel_statements']} "
            f"statements accepted; {counts['kernel_checked']} records checked as a whole by its kernel, "
            f"{counts['kernel_inexpressible']} not expressible",
            *_by_reason(second.kernel.reasons()),
        ]
    return "\n".join(lines)


def _by_reason(reasons: Mapping[str, str]) -> list[str]:
    """Return each reason with its records, or with their number."""
    named: dict[str, list[str]] = {}
    for identifier, reason in reasons.items():
        named.setdefault(reason, []).append(identifier)
    return [f"{', '.join(found) if len(found) < 4 else len(found)}: {why}" for why, found in named.items()]


@app.command("new-paper")
@reports_errors
def new_paper_command(
    folder: Annotated[str, typer.Argument(metavar="DIR", help="A new or empty folder.")],
    title: Annotated[str, typer.Option(metavar="TEXT", help="Title of the paper.")] = "",
    doi: Annotated[str, typer.Option(metavar="DOI", help="Where it is published.")] = "",
) -> None:
    """Write a small working paper of three claims to begin with: one holds, one fails, one is ambiguous."""
    from semispline.papers.new_paper import write_paper
    from semispline.solver.io import shown

    for path in write_paper(folder, title, doi):
        typer.echo(f"wrote {path}")
    typer.echo(f"next: semispline verify {shown(folder)}, then change printed.py and claims.py")


@app.command("reproduce")
@reports_errors
def reproduce_command(
    paper: Name,
    out: Annotated[str, typer.Option(metavar="DIR", help="Folder for index.html, pictures and numbers.")] = "report",
) -> None:
    """Verify the claims of a paper, run its examples if it has any, and write an HTML report, tables and pictures."""
    from semispline.papers.whole_study import reproduce

    ledger = reproduce(paper, out, decide=decided, show=print_ledger, echo=typer.echo, progress=_progress)
    _end_as(ledger)


@app.command("generate")
@reports_errors
def generate_command(
    check: Annotated[bool, typer.Option("--check", help="Write nothing: show differences, exit 1 if any.")] = False,
    c: Annotated[
        str | None, typer.Option("--c", metavar="DIR", help="Write C99 for the blend problem of --problem instead.")
    ] = None,
    problem: Annotated[str | None, typer.Option(metavar="FILE", help="A stored blend problem, for --c.")] = None,
) -> None:
    """Write solver/generated from the derivations (in a checkout), or C for one blend problem (anywhere)."""
    from semispline.solver.errors import OptionError

    if c is None and problem is None:
        derivations_cli.generate(check)
        return
    if c is None or problem is None:
        missing, given = ("--c DIR", "--problem") if c is None else ("--problem FILE", "--c")
        raise OptionError(f"generate: found {given} alone, expected {missing} with it")
    if check:
        raise OptionError("generate: found --check with --c, expected one of them")
    from semispline.solver.c_export import write_c

    paths, warnings = write_c(c, problem)
    for path in paths:
        typer.echo(f"wrote {path}")
    print_warnings(warnings)


def decided(name: str) -> Ledger:
    """Decide a paper, with a progress bar where standard error is a terminal."""
    from semispline.papers.ledger import collected, verify

    total = len(collected(name).claims)
    with _progress("deciding", total) as advance:
        return verify(name, workers=_workers(), progress=lambda decision: advance(decision.id))


def _end_as(ledger: Ledger, *, agrees: bool = True) -> None:
    """End with the exit status of a ledger: what gave no answer is a mistake or a failed check, and never a no."""
    if ledger.mistaken:
        raise typer.Exit(WRONG_INPUT)
    if ledger.unanswered:
        raise typer.Exit(FAILED)
    if not ledger.ok or not agrees:
        raise typer.Exit(ANSWER_IS_NO)


def print_ledger(ledger: Ledger) -> None:
    """Print the table, the counts, and what is not as recorded."""
    from rich.console import Console

    from semispline.papers.report import counts_text, ledger_table

    console = Console()
    if not console.is_terminal:
        console = Console(width=160)
    console.print(ledger_table(ledger))
    console.print(counts_text(ledger), highlight=False)
    for decision in ledger.decisions:
        if not decision.ok:
            found = decision.verdict or "no answer"
            survivors = "; ".join(decision.mutation.survivors)
            details = "; ".join(text for text in (decision.problem, survivors) if text)
            typer.echo(f"{decision.id}: found {found}, recorded {decision.recorded}. {details}".rstrip(), err=True)


@contextmanager
def _progress(doing: str, total: int) -> Iterator[Callable[[str], None]]:
    """Show a bar where standard error is a terminal; the function that is given is told of each step."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda step: None
        return
    columns = (TextColumn(doing), BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=total)
        yield lambda step: bar.update(task, advance=1, description=step)


app.registered_commands += solver_cli.app.registered_commands
# `derivations` may not know of `solver`: how its commands end is said here, and `generate` above stands for its own.
for _command in map(copy, derivations_cli.app.registered_commands):
    if _command.callback not in (None, derivations_cli.generate):
        _command.callback = reports_errors(_command.callback)
        app.registered_commands.append(_command)


def main() -> None:
    """Run the command line."""
    app(prog_name="semispline")


if __name__ == "__main__":
    main()
