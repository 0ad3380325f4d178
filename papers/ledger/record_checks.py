"""What makes a record well formed and what makes it complete.

One that is not well formed is refused when it is loaded. One that is not complete is a draft: it runs, but is not
decided.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import sympy as sp

from semispline.papers.ledger.mutation import mutants
from semispline.papers.ledger.records import (
    Cause,
    Check,
    Claim,
    Formula,
    LedgerError,
    Strength,
    Verdict,
    natural_key,
)
from semispline.papers.ledger.search import smallest_assignment

# It names files and anchors of pages too.
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]{0,79}(?<!\.)")


def check_record(claim: Claim) -> None:
    """Refuse a record that is not well formed, whether it is complete or not.

    Raises
    ------
    LedgerError
        Naming the record, what was found, and what would be right.
    """
    for problem in _problems(claim):
        raise LedgerError(f"claim {claim.id}: {problem}")


def check_complete(claim: Claim) -> None:
    """Refuse a record that lacks something: only one that is complete is decided.

    Raises
    ------
    LedgerError
        Naming the record, and the first thing that is missing.
    """
    for problem in missing(claim):
        raise LedgerError(f"claim {claim.id}: {problem}; `semispline verify --draft` shows what its checks find")


def same_ids(claims: Sequence[Claim]) -> tuple[str, str] | None:
    """Return two ids that are the same, or so much alike that they sort as one; None where there are none."""
    seen: dict[tuple[tuple[int, str], ...], str] = {}
    for claim in claims:
        key = natural_key(claim.id)
        if key in seen:
            return claim.id, seen[key]
        seen[key] = claim.id
    return None


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
        yield (
            f"id {claim.id!r}, expected letters, digits and . - _ +, such as eq-2.3, thm-1, lemma-2, eq-A.1 or "
            "table-2.weights"
        )
    if claim.verdict is not None and claim.verdict not in list(Verdict):
        yield f"verdict {claim.verdict!r}, expected one of {', '.join(Verdict)}, or none for a draft"
    for formula in claim.formulas + claim.corrected_formulas:
        yield from _formula_problems(formula)
    for part in claim.parts + claim.correction_parts:
        yield from _check_problems(part.check)
    labels = [reading.label for reading in claim.readings]
    if len(labels) > 1 and not all(labels):
        yield "several readings, one without a label"
    if len(set(labels)) < len(labels) and all(labels):
        yield f"several readings with one label: {labels}, expected different ones"


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


def missing(claim: Claim) -> Iterator[str]:
    """Yield what a record lacks to be decided, or has too much for its verdict."""
    verdict = claim.verdict
    if not claim.statement.strip() or not claim.where.strip():
        yield "statement or place is empty, expected both"
    if verdict is None:
        yield f"no verdict, expected one of {', '.join(Verdict)}"
        return
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
    if verdict in (Verdict.HOLDS, Verdict.FAILS) and any(reading.condition for reading in claim.readings):
        yield f"{verdict} with a condition, expected none, or holds-if"
    if verdict is Verdict.HOLDS_IF and not all(reading.condition for reading in claim.readings):
        yield "holds-if without its condition"
    if verdict is Verdict.FAILS:
        yield from _missing_correction(claim)


def _missing_correction(claim: Claim) -> Iterator[str]:
    if claim.counterexample is None and not any(part.check.search for part in claim.parts):
        yield "fails without a counterexample, expected a search"
    if claim.correction is None:
        yield "fails without a correction, expected what is true instead, with its check"
        return
    if not claim.correction_parts:
        yield "fails with a correction that has no proof"
    elif not claim.corrected_formulas:
        yield "fails with a correction that has no formula"
    if not claim.correction.statement.strip():
        yield "fails with a correction that says nothing, expected what is true instead"
