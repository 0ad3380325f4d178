"""Printed pseudo-code, run as it stands and compared with the formula that it is said to compute."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import Any, TypeAlias

import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError, Where, carried_out
from semispline.papers.checks.counterexamples import smallest_difference
from semispline.papers.checks.exports import equation_statement
from semispline.papers.checks.identities import ranges_text
from semispline.papers.checks.instances import Each, Meanings, as_letters, instances, label_of, meanings_at
from semispline.papers.checks.normal_form import difference
from semispline.papers.ledger import (
    Case,
    Check,
    CheckFailedError,
    Counterexample,
    EndlessError,
    Formula,
    Print,
    Strength,
    UndefinedError,
    given,
)
from semispline.papers.pseudocode import CodeFaultError, CodeLimitError, Limits, OpenConditionError, run_code
from semispline.papers.recheck import NotExpressibleError, Statement, as_text

# Name -> what printed code uses and does not define; or that of each instance.
Given: TypeAlias = Mapping[str, Any] | Callable[[Mapping[Any, Any]], Mapping[str, Any]]

# What is no number.
_TRUTH = (bool, str, type(None), sp.logic.boolalg.BooleanAtom)
# What a sign may be mistaken for, or a name printed for another one.
_MISTAKEN = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==",
    "===": "!==", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "·": "×",
}  # fmt: skip
_PIECE = re.compile(r"//[^\n]*|/\*.*?\*/|\d+\.\d+|(?<![\w.])\d+(?!\w)|===|[-+*/<>=!&|]=|&&|\|\||\+\+|--|->|[-+*/<>·]")


class Code(sp.Basic):
    """Pseudo-code as it is printed, and what calls it.

    Parameters
    ----------
    text : str
        The printed lines.
    call : str
        What is run after them, and whose last expression counts: "f(n, t)", or several lines.
    replace : mapping, optional
        Printed words that are no code -> code; a report shows them.

    Raises
    ------
    UnsuitableError
        What is to be replaced is not there, or more than once.
    """

    def __new__(cls, text: str, call: str = "", replace: Mapping[str, str] | None = None, note: str = "") -> Code:
        """Return the code."""
        pairs = sorted(dict(replace or {}).items())
        for old, _ in pairs:
            times = str(text).count(old)
            if times != 1:
                raise UnsuitableError(f"Code: found {old!r} {times} times in the printed lines, expected it once")
        words = [sp.core.symbol.Str(str(word)) for word in (text, call, note, *(w for pair in pairs for w in pair))]
        return super().__new__(cls, *words)

    def __getnewargs__(self) -> tuple[Any, ...]:
        """Return what it is made from, for a process that gets it from another one."""
        return self.text, self.call, self.replaced, self.note

    @property
    def text(self) -> str:
        """As printed."""
        return str(self.args[0])

    @property
    def call(self) -> str:
        """What is run after it."""
        return str(self.args[1])

    @property
    def note(self) -> str:
        """How it was changed; empty as printed."""
        return str(self.args[2])

    @property
    def replaced(self) -> dict[str, str]:
        """Words that are no code, and what stands for them."""
        words = [str(word) for word in self.args[3:]]
        return dict(zip(words[::2], words[1::2], strict=True))

    @property
    def printed(self) -> Print:
        """For a report: the lines, and what is run in the place of words that are no code."""
        instead = "; ".join(f"{old}: run as {new}" for old, new in self.replaced.items())
        return Print(self.text, by_hand=instead)

    def changes(self) -> Iterator[tuple[str, Code]]:
        """Yield code with one sign or number changed."""
        for match in _PIECE.finditer(self.text):
            piece = match[0]
            line = 1 + self.text[: match.start()].count("\n")
            if piece[:1].isdigit():
                changes = [("number", str(int(piece) + 1))] if "." not in piece else []
            else:
                changes = [("sign", _MISTAKEN[piece])] if piece in _MISTAKEN else []
            for kind, new in changes:
                text = self.text[: match.start()] + new + self.text[match.end() :]
                place = match.start() - self.text.rfind("\n", 0, match.start())
                note = f"line {line}, column {place}: {new} for {piece}"
                try:
                    yield kind, Code(text, self.call, self.replaced, note)
                except UnsuitableError:
                    # The change is in words that are replaced.
                    continue

    def _sympystr(self, _printer: Any) -> str:
        call = " ".join(self.call.split("\n")[-1].split())
        return f"code({', '.join(word for word in (call, self.note) if word)})"

    def _latex(self, printer: Any) -> str:
        return r"\texttt{" + self._sympystr(printer).replace("_", r"\_") + "}"

    def _mathml(self, printer: Any) -> Any:
        leaf = printer.dom.createElement("mtext")
        leaf.appendChild(printer.dom.createTextNode(self._sympystr(printer)))
        return leaf


def code(
    *,
    each: Each | None = None,
    given: Given | None = None,
    where: Meanings | None = None,
    complete: bool = False,
    limits: Limits | None = None,
    method: str = "",
) -> Check:
    r"""Return the check that printed code gives what a formula says.

    A formula is an equation between an expression and `Code`; a tuple of expressions stands for a list or a point.
    Letters of the formula that the code or its call names have the number of the instance, or stay letters: then
    the same run decides for all of them, as long as no condition depends on them.

    Parameters
    ----------
    each : mapping or iterable of mappings, optional
        Letter -> numbers that are tried.
    given : mapping, or callable of an instance, optional
        Name -> number, list, record or function that the code uses and does not define.
    where : mapping, or callable of an instance, optional
        What letters of the expression stand for.
    complete : bool
        Whether the instances are all that the claim speaks of.
    limits : Limits, optional
        How far a run may go.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> n, t = sp.symbols("n t")
    >>> loop = Code("f(n, t):\n  p = 1\n  for(i=0; i<n; i++):\n    p *= t\n  return p", "f(n, t)")
    >>> [case.true for case in code(each={n: range(4)}).cases(formula(sp.Eq(t**n, loop, evaluate=False)))]
    [True, True, True, True]
    """
    tried = None if each is None else list(instances(each))
    rules = _Rules(tried if tried is not None else [{}], given, where, limits or Limits())
    standard = "the printed code, run exactly, against the formula"
    return Check(
        rules.cases,
        Strength.GENERAL if tried is None or complete else Strength.EACH,
        method or (standard if tried is None else f"{standard}, for {ranges_text(tried)}"),
        proof=tried is None or complete,
        search=rules.search,
        export=rules.export,
    )


class _Rules:
    """What printed code is decided by, at each of its instances."""

    def __init__(
        self, tried: list[dict[Any, Any]], given: Given | None, where: Meanings | None, limits: Limits
    ) -> None:
        self.tried, self.given, self.where, self.limits = tried, given, where, limits

    def cases(self, formula: Formula | None) -> Iterator[Case]:
        """Run the code at each instance."""
        for instance in self.tried:
            yield self._case(given(formula), instance)

    def _case(self, formula: Formula, instance: Mapping[Any, Any]) -> Case:
        label = label_of(instance)
        found = self._first_difference(formula, instance)
        if found is None:
            return Case(label, True, residual=sp.Integer(0))
        place, residual = found
        return Case(f"{label}{place}", False, residual=residual)

    def _first_difference(self, formula: Formula, instance: Mapping[Any, Any]) -> tuple[str, Any] | None:
        """Return where a run first differs from the formula and what is left there; None where it never does."""
        expected, printed = _sides(formula)
        try:
            wanted = _flat(carried_out(expected.xreplace(instance), self._meanings(instance)))
            made = _flat(self._run(formula, printed, instance))
        except UndefinedError as error:
            return "", sp.Symbol(f"undefined: {error}")
        except (CodeLimitError, OpenConditionError) as error:
            kind = EndlessError if isinstance(error, CodeLimitError) else CheckFailedError
            raise kind(f"{label_of(instance)}: {error}") from None
        except CodeFaultError as error:
            return "", sp.Symbol(f"fault: {error}")
        if len(wanted) != len(made):
            return "", sp.Symbol(f"{len(made)} values for {len(wanted)}")
        for n, (one, other) in enumerate(zip(wanted, made, strict=True)):
            place = f", value {n + 1}" if len(made) > 1 else ""
            residual = _apart(one, other, formula, instance)
            if residual is not None:
                return place, residual
        return None

    def _meanings(self, instance: Mapping[Any, Any]) -> Where:
        return meanings_at(self.where, instance)

    def _run(
        self,
        formula: Formula,
        printed: Code,
        instance: Mapping[Any, Any],
        seen: Callable[[Any], Any] = lambda value: value,
    ) -> Any:
        """Return what a run gives; `seen` says how what it is given is shown to it."""
        letters = {str(letter): letter for letter in formula.variables}
        numbers = {str(letter): value for letter, value in instance.items()}
        more = self.given(instance) if callable(self.given) else self.given or {}
        names = {name: seen(value) for name, value in {**letters, **numbers, **more}.items()}
        return run_code(printed.text, printed.call, names, self.limits, printed.replaced).value

    def search(self, formula: Formula) -> Counterexample | None:
        """Return the first instance at which the run differs, with the smallest numbers for letters that are left."""
        expected, printed = _sides(formula)
        for instance in self.tried:
            found = self._first_difference(formula, instance)
            if found is None:
                continue
            named = tuple((str(letter), str(value)) for letter, value in instance.items())
            if isinstance(found[1], sp.Symbol) and found[1] not in formula.variables:
                return Counterexample(named or (("any letters", "any numbers"),), str(found[1]), str(expected))
            wanted = _flat(carried_out(expected.xreplace(instance), self._meanings(instance)))
            made = _flat(self._run(formula, printed, instance))
            for one, other in zip(wanted, made, strict=True):
                if _apart(one, other, formula, instance) is not None:
                    smallest = smallest_difference(sp.sympify(one), as_sympy(other), formula.assumptions, instance)
                    return smallest or Counterexample(named or (("values", "as given"),), str(other), str(one))
        return None

    def export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return what runs come to as texts that were put together and not worked out, against the formula."""
        formula = given(formula)
        expected, printed = _sides(formula)
        for instance in self.tried:
            case = self._case(formula, instance)
            where = self._meanings(instance)
            try:
                made = _flat(self._run(formula, printed, instance))
                told = _flat(self._run(formula, printed, instance, _as_told))
            except (CodeFaultError, TypeError, AttributeError, sp.SympifyError) as error:
                raise NotExpressibleError(f"{case.label}: {error}") from None
            wanted = list(expected) if isinstance(expected, sp.Tuple) else [expected]
            if len(wanted) != len(made) or any(isinstance(value, _TRUTH) for value in made):
                raise NotExpressibleError(f"{case.label}: found {made}, expected {len(wanted)} numbers")
            for n, one in enumerate(wanted):
                label = f"{label_of(instance)}{f', value {n + 1}' if len(made) > 1 else ''}"
                if case.true or label == case.label:
                    carried = carried_out(one.xreplace(instance), where), as_sympy(made[n])
                    yield equation_statement(
                        label, (one, as_text(told[n])), carried, where, formula.assumptions, instance
                    )


def _as_told(value: Any) -> Any:
    """Return what code is given with letters as texts, so that what is made of them is put together as it runs."""
    if isinstance(value, list | tuple | sp.Tuple):
        return [_as_told(item) for item in value]
    if isinstance(value, Mapping):
        return {name: _as_told(item) for name, item in value.items()}
    if isinstance(value, sp.Expr) and not value.is_number:
        return as_text(as_letters(value))
    return value


def as_sympy(value: Any) -> Any:
    """Return a value of running code as SymPy has it."""
    return sp.Rational(value.numerator, value.denominator) if isinstance(value, Fraction) else value


def _sides(formula: Formula) -> tuple[Any, Code]:
    one, other = formula.relation.args
    if isinstance(one, Code):
        one, other = other, one
    if not isinstance(other, Code) or not isinstance(formula.relation, sp.Equality):
        raise UnsuitableError(f"{formula.relation}: found no code, expected an equation between an expression and Code")
    return one, other


def _flat(value: Any) -> list[Any]:
    """Return the numbers and truths that a value is made of, in their order."""
    if isinstance(value, list | tuple | sp.Tuple):
        return [part for item in value for part in _flat(item)]
    if isinstance(value, Mapping):
        return [part for item in value.values() for part in _flat(item)]
    return [value]


def _apart(one: Any, other: Any, formula: Formula, instance: Mapping[Any, Any]) -> Any:
    """Return what is left of two values; None where they are the same."""
    if isinstance(one, _TRUTH) or isinstance(other, _TRUTH):
        return None if str(one).lower() == str(other).lower() else sp.Symbol(f"{other} for {one}")
    one, other = sp.sympify(one), as_sympy(other)
    found = difference(one, other)
    if found.zero:
        return None
    if not found.decided and smallest_difference(one, other, formula.assumptions, instance) is None:
        raise CheckFailedError(f"{label_of(instance)}: neither proved nor refuted; what is left is {found.residual}")
    return -found.residual
