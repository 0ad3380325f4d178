"""The verdict of a record, made anew from its cases.

A reading holds where all cases are true and fails where one of the paper's own setting is false; it holds under its
condition where exactly the cases that meet it are true. Readings that differ are one ambiguous record.
"""

from __future__ import annotations

from collections.abc import Sequence

from semispline.papers.recheck.statements import Certificate, Reading, Statement


def verdict_of(certificate: Certificate) -> str | None:
    """Return the verdict that the cases of a record amount to; None where they amount to none."""
    verdicts = {_of_reading(reading) for reading in certificate.readings}
    correction = certificate.correction
    if None in verdicts or not verdicts or (correction and _of_reading(Reading(correction.cases)) != "holds"):
        return None
    return verdicts.pop() if len(verdicts) == 1 else "ambiguous"


def _of_reading(reading: Reading) -> str | None:
    cases = reading.cases
    if not cases:
        return None
    if all(case.true for case in cases):
        return "holds"
    if any(case.own and not case.true for case in cases):
        return "fails"
    return "holds-if" if reading.condition and _separates(cases) else None


def _separates(cases: Sequence[Statement]) -> bool:
    return all(case.true == case.meets for case in cases) and any(case.own and case.true for case in cases)
