"""All certificates of the paper."""

from __future__ import annotations

from collections.abc import Callable

from semispline.papers.ledger import Claim, Paper
from semispline.papers.lin2014.certificates import (
    bezier,
    conditions,
    conditions_in_figures,
    contact,
    controls,
    converted,
    counts,
    degrees,
    densities,
    figures,
    general_contact,
    knot_vectors,
    least_energy_theorems,
    linear_system,
    many_rows,
    minima,
    others,
    printed_derivatives,
    set_rows,
    shape_minima,
    special_choice,
    spline_properties,
    subpatch_counts,
    sums,
    theorems,
    untouched_bases,
    written_anew,
)
from semispline.papers.recheck import Draft, Export, export_of

MODULES = (
    sums,
    spline_properties,
    knot_vectors,
    bezier,
    subpatch_counts,
    counts,
    set_rows,
    untouched_bases,
    contact,
    conditions,
    conditions_in_figures,
    general_contact,
    special_choice,
    printed_derivatives,
    densities,
    minima,
    linear_system,
    degrees,
    shape_minima,
    many_rows,
    figures,
    others,
    converted,
    written_anew,
)


def export(paper: Paper) -> Export:
    """Return the certificates of all decided records, reasons for those that have none, and theorems they cite."""
    return export_of(
        paper, drafts(), others.NOT_EXPRESSIBLE, controls.controls, theorems.THEOREMS, least_energy_theorems.theories
    )


def drafts() -> dict[str, Callable[[Claim], Draft]]:
    """Return the drafts of all records that have one."""
    return {identifier: draft for module in MODULES for identifier, draft in module.DRAFTS.items()}


def written_as_a_whole(paper: Paper) -> tuple[str, ...]:
    """Return the records of which nothing is left out: those that a second system repeats as a whole if it agrees."""
    written = drafts()
    return tuple(claim.id for claim in paper.claims if claim.id in written and claim.id not in figures.IN_PART)
