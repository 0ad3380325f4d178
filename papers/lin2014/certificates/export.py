"""All certificates of the paper."""

from __future__ import annotations

from semispline.papers.ledger import Paper
from semispline.papers.lin2014.certificates import (
    appendix,
    bezier,
    conditions,
    contact,
    controls,
    converted,
    counts,
    energy,
    figures,
    least_energy,
    many_rows,
    others,
    surfaces,
    theorems,
    written_anew,
)
from semispline.papers.recheck import Export, export_of

MODULES = (
    surfaces,
    bezier,
    counts,
    contact,
    conditions,
    appendix,
    energy,
    figures,
    others,
    converted,
    many_rows,
    written_anew,
)


def export(paper: Paper) -> Export:
    """Return the certificates of all decided records, reasons for those that have none, and theorems they cite."""
    drafts = {identifier: draft for module in MODULES for identifier, draft in module.DRAFTS.items()}
    return export_of(paper, drafts, others.NOT_EXPRESSIBLE, controls.controls, theorems.THEOREMS, least_energy.theories)
