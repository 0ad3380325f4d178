"""What makes a record well formed; one that is not is refused when it is loaded."""

from __future__ import annotations

import re
from collections.abc import Iterator

import sympy as sp

from semispline.papers.ledger.mutation import mutants
from semispline.papers.ledger.records import Cause, Check, Claim, Formula, LedgerError, Strength, Verdict
from semispline.papers.ledger.search import smallest_assignment

# The paper's own number, or a section, figure or table with a slug.
_ID = re.compile(r"(def|eq|app)-[A-Za-z0-9]+|cond-\d+\.\d+|(sec|fig|table)-[A-Za-z0-9]+\.[a-z0-9]+([.-][a-z0-9]+)*")


def check_record(claim: Claim) -> None:
    """Refuse a record that is not well formed.

    Raises
    ------
    LedgerError
        Naming the record, what was found, and what would be right.
    """
    for problem in _problems(claim):
        raise LedgerError(f"claim {claim.id}: {problem}")


def check_causes(claims: tuple[Claim, ...], causes: tuple[Cause, ...]) -> None:
    """Refuse a cause that no record has or that says nothing, and records without one where the paper has causes.

    Raises
    ------
    LedgerError
        Naming the record or the cause, what was found, and what would be right.
    """
    keys = [cause.key for cause in causes]
    for cause in causes:
        if keys.count(cause.key) > 1 or not cause.title.strip() or not cause.text.strip():
            raise LedgerError(
                f"cause {cause.key!r}: found twice, or without title or text, expected each once with both"
            )
        if all(claim.cause != cause.key for claim in claims):
            raise LedgerError(f"cause {cause.key!r}: no record has it, expected at least one")
    for claim in claims:
        if claim.cause and claim.cause not in keys:
            raise LedgerError(f"claim {claim.id}: cause {claim.cause!r}, expected one of {', '.join(keys) or 'none'}")
        if causes and claim.verdict is Verdict.FAILS and not claim.cause:
            raise LedgerError(f"claim {claim.id}: fails without a cause, expected one of {', '.join(keys)}")


def _problems(claim: Claim) -> Iterator[str]:
    if not _ID.fullmatch(claim.id):
        yield f"id {claim.id!r}, expected one such as eq-1, cond-2.1, fig-3.slug or sec-4.slug"
    if claim.verdict not in list(Verdict):
        yield f"verdict {claim.verdict!r}, expected one of {', '.join(Verdict)}"
    if not claim.statement.strip() or not claim.where.strip():
        yield "statement or place is empty, expected both"
    for formula in claim.formulas + claim.corrected_formulas:
        yield from _formula_problems(formula)
    for part in claim.parts + claim.correction_parts:
        yield from _check_problems(part.check)
    yield from _missing_evidence(claim)


def _check_problems(check: Check) -> Iterator[str]:
    if not check.method.strip():
        yield "a check without a method, expected what is compared with what"
    if check.strength not in list(Strength):
        yield f"strength {check.strength!r}, expected one of {', '.join(Strength.__members__)}"
    elif check.proof and check.strength is Strength.FLOAT:
        yield "a proof in floating point, expected an exact one, or a check that is none"
    elif check.proof and check.strength is Strength.CONSISTENT:
        yield "a proof by what is printed agreeing, expected a check that is none"


def _formula_problems(formula: Formula) -> Iterator[str]:
    relation = formula.relation
    if not isinstance(relation, sp.core.relational.Relational):
        yield f"formula is {relation!r} ({type(relation).__name__}), expected a relation such as Eq"
        return
    used = {s for part in (relation, *formula.assumptions) for s in part.free_symbols if isinstance(s, sp.Symbol)}
    declared = set(formula.variables)
    if used != declared:
        undeclared, unused = sorted(map(str, used - declared)), sorted(map(str, declared - used))
        yield f"free symbols do not match the declared variables: undeclared {undeclared}, unused {unused}"
    elif formula.assumptions and assumption_instance(formula) is None:
        yield f"no instance found that satisfies the assumptions {formula.assumptions}, expected at least one"
    else:
        yield from _reason_problems(formula)


def _reason_problems(formula: Formula) -> Iterator[str]:
    """Find reasons that say nothing, and those for a mutant that is never made, which may hide a stronger check."""
    if not formula.equivalent and not formula.undecidable:
        return
    made = {mutant.text for mutant in mutants(formula)}
    for text, reason in (*formula.equivalent.items(), *formula.undecidable.items()):
        if not reason.strip():
            yield f"mutant {text} without a reason, expected why no check can tell it from the formula"
        if text not in made:
            yield f"a reason for the mutant {text}, which is not made; expected one of the mutants of the formula"
    both = sorted(set(formula.equivalent) & set(formula.undecidable))
    if both:
        yield f"mutants {both} both equivalent and undecidable, expected one of the two"


def assumption_instance(formula: Formula) -> dict[sp.Symbol, sp.Rational] | None:
    """Return the smallest rational instance of the assumptions, or None where a bounded search finds none."""
    symbols = sorted({s for a in formula.assumptions for s in a.free_symbols}, key=str)
    tests = [(sorted(a.free_symbols, key=str), a) for a in formula.assumptions]
    compiled = [(used, sp.lambdify(used, a, "math")) for used, a in tests]
    return smallest_assignment(symbols, lambda at: all(test(*(at[s] for s in used)) for used, test in compiled))


def _missing_evidence(claim: Claim) -> Iterator[str]:
    verdict = claim.verdict
    if verdict in (Verdict.NOT_CHECKABLE, Verdict.DEFINITION):
        if not claim.reason.strip():
            yield f"{verdict} without " + ("a reason" if verdict is Verdict.NOT_CHECKABLE else "what it names")
        if claim.readings:
            yield f"{verdict} with readings, expected none"
        return
    if claim.reason:
        yield f"{verdict} with a reason for not being checkable"
    if not claim.readings or any(not reading.parts for reading in claim.readings):
        yield f"{verdict} without a check"
    if verdict is Verdict.AMBIGUOUS and len(claim.readings) < 2:
        yield f"ambiguous with {len(claim.readings)} reading, expected at least 2"
    if len(claim.readings) > 1 and not all(reading.label for reading in claim.readings):
        yield "several readings, one without a label"
    labels = [reading.label for reading in claim.readings]
    if len(set(labels)) < len(labels) and all(labels):
        yield f"several readings with one label: {labels}, expected different ones"
    if verdict in (Verdict.HOLDS, Verdict.FAILS) and any(reading.condition for reading in claim.readings):
        yield f"{verdict} with a condition, expected none, or holds-if"
    if verdict is Verdict.HOLDS_IF and not all(reading.condition for reading in claim.readings):
        yield "holds-if without its condition"
    if verdict is Verdict.FAILS:
        yield from _missing_correction(claim)


def _missing_correction(claim: Claim) -> Iterator[str]:
    missing = [name for name in ("correction", "counterexample", "consequence") if getattr(claim, name) is None]
    if missing:
        yield f"fails without {', '.join(missing)}"
    if claim.correction is None:
        return
    if not claim.correction_parts:
        yield "fails with a correction that has no proof"
    elif not claim.corrected_formulas:
        yield "fails with a correction that has no formula"
    if not claim.correction.statement.strip():
        yield "fails with a correction that says nothing, expected what is true instead"
