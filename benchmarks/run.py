"""All benchmarks: `make bench`, or python benchmarks/run.py.

Times depend on the machine, so what is compared is compared within one run: ratios, exponents, and limits with room to
spare. Nothing in the tests reads a clock.
"""

from __future__ import annotations

import platform

import casadi
import long_contacts
import numpy as np
import paper_sizes
import scipy
import surfaces
from rich.console import Console
from rich.table import Table


def table(*columns: str) -> Table:
    """Return an empty table; all columns but the first hold numbers."""
    result = Table()
    for i, column in enumerate(columns):
        result.add_column(column, justify="left" if i == 0 else "right")
    return result


def verdict(is_met: bool) -> str:
    """Return how an aim and what was measured compare."""
    return "[green]met[/green]" if is_met else "[red]missed[/red]"


def paper_sizes_table() -> tuple[str, Table]:
    """Show times for the sizes of the paper's Table 1."""
    reduced, casadi_ = (1e3 * x for x in (paper_sizes.REDUCED_LIMIT, paper_sizes.CASADI_LIMIT))
    title = f"Sizes of the paper's Table 1, G2 on both sides: reduced under {reduced:g} ms, casadi under {casadi_:g} ms"
    result = table("figure", "nets", "middle curves", "reduced, ms", "casadi, ms", "")
    for figure in paper_sizes.FIGURES:
        times = paper_sizes.size_times(figure)
        nets = ", ".join(f"{n_u} x {n_v}" for n_u, n_v in times.sizes)
        is_met = times.reduced < paper_sizes.REDUCED_LIMIT and times.casadi < paper_sizes.CASADI_LIMIT
        milliseconds = (f"{1e3 * x:.1f}" for x in (times.reduced, times.casadi))
        result.add_row(f"Fig. {figure}", nets, str(times.middle_curves), *milliseconds, verdict(is_met))
    return title, result


def fair_table() -> tuple[str, Table]:
    """Show the fairest blend against that of least energy."""
    median, most = paper_sizes.FAIR_LIMITS
    title = (
        f"The whole default blend (fairest shape) over that of least energy, checks included: {median:g} times in the "
        f"median, {most:g} at most"
    )
    ratios = paper_sizes.fair_ratios()
    result = table("pair", "times", "")
    for name, ratio in ratios.items():
        result.add_row(name, f"{ratio:.2f}", verdict(ratio < most))
    middle = float(np.median(list(ratios.values())))
    result.add_row("median", f"{middle:.2f}", verdict(middle < median))
    return title, result


def race_table() -> tuple[str, Table]:
    """Show casadi against bfgs."""
    race = paper_sizes.race()
    title = (
        f"10 x 64 control points, one middle curve: casadi at least {paper_sizes.SPEED_UP} times faster than bfgs, "
        "energy no higher"
    )
    result = table("method", "seconds", "energy", "")
    result.add_row("casadi", f"{race.casadi_seconds:.3f}", f"{race.casadi_energy:.10g}")
    result.add_row("bfgs", f"{race.bfgs_seconds:.3f}", f"{race.bfgs_energy:.10g}")
    # Both energies are rounded sums of some 10^5 squares.
    is_met = race.ratio >= paper_sizes.SPEED_UP and race.casadi_energy <= race.bfgs_energy * (1 + 1e-10)
    result.add_row("", f"{race.ratio:.0f} times faster", "", verdict(is_met))
    return title, result


def growth_table() -> tuple[str, Table]:
    """Show how C2 blends grow with the length of their contact."""
    runs = long_contacts.growth()
    title = (
        f"C2, one middle curve, mean span 1: exponents below {long_contacts.EXPONENT_LIMIT}, "
        f"{long_contacts.SIZES[-1]} under {long_contacts.SECONDS_LIMIT:g} s; the check after the solve beside it"
    )
    result = table("control points", "seconds", "megabytes", "check, seconds", "check / solve", "MB with check", "")
    for run in runs:
        solved = f"{run.seconds:.3f}", f"{run.bytes / 1e6:.0f}"
        checked = f"{run.check_seconds:.3f}", f"{run.check_ratio:.1f}", f"{run.checked_bytes / 1e6:.0f}"
        result.add_row(str(run.n), *solved, *checked)
    sizes = [run.n for run in runs]
    names = ("seconds", "bytes", "check_seconds", "checked_bytes")
    slopes = [long_contacts.exponent(sizes, [getattr(run, name) for run in runs]) for name in names]
    is_met = max(slopes) < long_contacts.EXPONENT_LIMIT and runs[-1].seconds < long_contacts.SECONDS_LIMIT
    shown = [f"{slope:.2f}" for slope in slopes]
    result.add_row("exponent", *shown[:3], "", shown[3], verdict(is_met))
    return title, result


def main() -> None:
    """Print every table."""
    console = Console()
    # Piped output keeps its lines whole.
    console = console if console.is_terminal else Console(width=120)
    console.print(
        f"Python {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__}, "
        f"CasADi {casadi.__version__}, {platform.machine()}; each time is the least of several runs"
    )
    for make in (paper_sizes_table, fair_table, race_table, growth_table):
        console.print("", *make(), sep="\n")
    largest, refused, message = long_contacts.trusted_sizes()
    beyond = f"refused with {refused}: {message}" if refused else "refused with none that was tried"
    console.print(f"\nC2 on the fixed domain [0, 1]: trusted with {largest} control points, {beyond}")
    console.print("\nEvaluation, against the bare SciPy products for the same work")
    surfaces.main()


if __name__ == "__main__":
    main()
