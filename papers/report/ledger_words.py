"""What was decided of a claim, in words: evidence, correction, consequence, mutants, counts."""

from __future__ import annotations

from typing import Any

from sympy import preorder_traversal

from semispline.papers.ledger import Claim, Consequence, Decision, Ledger, Print, ReadingDecision, Strength, Verdict


def evidence_text(decision: Decision) -> str:
    """Return in words what the verdict stands on."""
    return "; ".join(reading_text(reading) for reading in decision.readings)


def reading_text(reading: ReadingDecision) -> str:
    """Return in words what the verdict of one reading stands on."""
    label = f"[{reading.label}: {reading.verdict}] " if reading.label else ""
    return label + evidence_words(reading)


def checked_text(reading: ReadingDecision) -> str:
    """Return whether the reading is proved, or how many cases were checked."""
    cases = f"{reading.cases} {'case' if reading.cases == 1 else 'cases'}"
    if reading.proof:
        return f"proof, {cases}"
    exact = f"{cases} in floating point" if reading.strength is Strength.FLOAT else f"{cases} checked exactly"
    return f"disproved, {exact}" if reading.proved else exact


def strength_text(decision: Decision) -> str:
    """Return the strength of the evidence in words, that of the weakest reading; empty where nothing was checked."""
    return max(reading.strength for reading in decision.readings).text if decision.readings else ""


def print_lines(claim: Claim) -> list[tuple[str, str]]:
    r"""Return what is printed as LaTeX or as code, beside it what was read of it, or why it was read by hand.

    Examples
    --------
    >>> from semispline.papers.ledger import Print
    >>> claim = Claim("eq-1", "Section 1", "..", Verdict.HOLDS, printed=Print("2at", r"2 \cdot a \cdot t"))
    >>> print_lines(claim)
    [('as printed', '2at'), ('read as', '2 \\cdot a \\cdot t')]
    """
    prints = [claim.printed] if claim.printed is not None else _code_lines(claim)
    lines = (("as printed", "text"), ("read as", "echo"), ("read by hand", "by_hand"))
    return [(heading, text) for one in prints for heading, name in lines if (text := getattr(one, name).strip("\n "))]


def _code_lines(claim: Claim) -> list[Print]:
    """Return the lines of code that formulas contain, each once."""
    nodes = (node for formula in claim.formulas for node in preorder_traversal(formula.relation))
    return list(dict.fromkeys(n.printed for n in nodes if isinstance(getattr(n, "printed", None), Print)))


def consequence_text(consequence: Consequence | None) -> str:
    """Return a measured consequence in one sentence."""
    if consequence is None:
        return ""

    def is_rounding(value: float) -> bool:
        # A whole number is a count, and 0 of something is no rounding.
        return abs(value) < consequence.rounding and not isinstance(value, int)

    measured, corrected = consequence.measured, consequence.corrected
    zero = [name for name, value in measured.items() if is_rounding(value)]
    seen = [f"{name} {value:.3g}" for name, value in measured.items() if name not in zero]
    left = [f"{name} with the corrected formula {x:.3g}" for name, x in corrected.items() if not is_rounding(x)]
    parts = [", ".join(seen + left)] if seen or left else []
    if zero:
        parts.append(f"nothing but rounding in {_listed([name.partition(' [')[0] for name in zero])}")
    if corrected and not left:
        what = ("this is" if len(corrected) == 1 else "all of these are") if seen else "it is"
        parts.append(f"with the corrected formula {what} rounding")
    says = "; ".join(parts)
    judges = "; ".join(f"{name}: {says}" for name, says in consequence.judges.items())
    return f"{consequence.text}: {says}." + (f" {judges}." if judges else "")


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def residual_of(decision: Decision) -> Any:
    """Return what the printed formula leaves, of the first reading that does not hold; None where there is nothing."""
    left = (r.residual for r in decision.readings if r.residual is not None and r.verdict is not Verdict.HOLDS)
    return next(left, None)


def correction_text(claim: Claim) -> str:
    """Return what is true instead, in words; empty where there is no correction."""
    return claim.correction.statement if claim.correction else ""


def mutants_text(decision: Decision) -> str:
    """Return how many mutants were noticed, of how many; empty where there is no formula."""
    mutation = decision.mutation
    if not mutation.tried:
        return ""
    explained = ((mutation.equivalent, "equivalent"), (mutation.undecidable, "undecidable"))
    rest = ", ".join(f"{len(found)} {name}" for found, name in explained if found)
    return f"{mutation.noticed}/{mutation.tried}" + (f" ({rest})" if rest else "")


def counts_text(ledger: Ledger) -> str:
    """Return the counts in two lines."""
    n = ledger.counts()
    verdicts = ", ".join(f"{n[verdict]} {verdict}" for verdict in Verdict)
    told = f", {n['consistent']} found consistent with what is printed and no more" if n["consistent"] else ""
    others = n[Verdict.HOLDS_IF] + n[Verdict.FAILS] + n[Verdict.AMBIGUOUS]
    caused = sum(len(decisions) for _, decisions in ledger.causes())
    causes = (
        f"of the {others} that do not hold as they stand {caused} have {n['causes']} causes; " if n["causes"] else ""
    )
    kinds = ", ".join(f"{number} {kind}" for kind, number in sorted(ledger.mutants_by_kind().items()))
    return (
        f"{n['printed']} printed claims, {n['decided']} decided, {n['proved']} of them proved or disproved exactly"
        f"{told}: {verdicts}; {causes}{n['vacuous']} vacuous, {n['changed']} changed.\n"
        f"{n['mutants']} mutants of printed and corrected formulas tried ({kinds}): {n['mutants_survived']} survived "
        f"without a reason, {n['mutants_equivalent']} say the same as the formula, {n['mutants_undecidable']} change "
        "printed data on which nothing else printed depends (each with its reason)."
    )


_PROVING = [strength for strength in Strength if strength is not Strength.CONSISTENT]


def words() -> list[str]:
    """Return what verdicts and strengths mean, one a line."""
    return [
        *(f"{verdict}: {verdict.text}." for verdict in Verdict),
        "Evidence, the strongest first: " + "; ".join(strength.text for strength in _PROVING) + ".",
        f"{Strength.CONSISTENT.text}: numbers agree, or something of the kind exists; that proves nothing, and counts "
        "apart.",
        "proof, disproved: the cases prove the claim, or one exact case is against it; otherwise cases were checked.",
        "vacuous: a check without a single instance, which is a failure of the check; changed: another verdict than "
        "the recorded one.",
    ]


def evidence_words(reading: ReadingDecision) -> str:
    """Return how strong the evidence of a reading is, what was checked, and how."""
    return f"{kind_text(reading)}, {checked_text(reading)}: {reading.method}"


def kind_text(reading: ReadingDecision) -> str:
    """Return the strength of the evidence in words; instances that are all there is are no sample."""
    complete = reading.proof and reading.strength is Strength.RATIONAL
    return "exact rational arithmetic" if complete else reading.strength.text
