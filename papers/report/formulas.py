"""Formulas as MathML, which browsers set without a network, and as LaTeX: SymPy's printers, the paper's notation."""

from __future__ import annotations

import re
from html import escape
from types import MappingProxyType
from typing import Any

from sympy.printing.latex import LatexPrinter
from sympy.printing.mathml import MathMLPresentationPrinter

from semispline.papers.ledger import Notation, Places

# A letter with its own index, a number, or an operator, inside an index such as k_r+1 or m-k+1.
_TOKEN = re.compile(r"([A-Za-z]+)(?:_([A-Za-z0-9]+))?|(\d+)|([-+,'])")
_GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ", "eta": "η", "theta": "θ",
    "iota": "ι", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "omicron": "ο", "pi": "π", "rho": "ρ",
    "sigma": "σ", "tau": "τ", "upsilon": "υ", "phi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω",
}  # fmt: skip
# h1 and alpha2 are h_1 and alpha_2; primes stand before or after the index, and V^r has an upper one.
_NAME = re.compile(r"([A-Za-z]+)('*)(?:_?(\d+)|_(\w+|\{.*\}))?('*)(?:\^(\w+))?")
# The same inside a sentence: a letter or Greek name with a lower index, an upper one, or both.
_IN_TEXT = re.compile(
    rf"\b([A-Za-z]|{'|'.join(_GREEK)})(?:_(\{{(?:[^{{}}]|\{{[^{{}}]*\}})*\}}|[A-Za-z0-9]+))?('*)"
    r"(?:\^(\([^()]*\)|\w+))?(?![A-Za-z])"
)


def decimal(number: Any) -> str:
    """Return a printed number as a decimal; empty for halves, thirds and whatever has no finite one.

    Examples
    --------
    >>> from sympy import Rational
    >>> decimal(Rational("0.142857")), decimal(Rational(1, 2)), decimal(Rational(1, 3))
    ('0.142857', '', '')
    """
    if number.is_Integer:
        return str(number)
    if number.q == 2 or 10**6 % number.q:
        return ""
    return f"{number.p / number.q:.6f}".rstrip("0")


class _PositiveFirst:
    """Sums begin with a term that is not negative, where there is one: w - w_s rather than -w_s + w."""

    def _as_ordered_terms(self, expr: Any, order: Any = None) -> list[Any]:
        terms: list[Any] = super()._as_ordered_terms(expr, order)  # type: ignore[misc]
        return sorted(terms, key=lambda term: bool(term.could_extract_minus_sign()))


def _parts(e: Any, notation: Notation) -> Places | None:
    """Return where the arguments of a function stand; None where that is between brackets."""
    rule = notation.get(e.func.__name__)
    return rule(e.args) if rule is not None else None


class _Latex(_PositiveFirst, LatexPrinter):  # type: ignore[misc]
    """SymPy's LaTeX printer, but for functions of which a paper says how they are written."""

    notation: Notation = MappingProxyType({})

    def _print_Function(self, expr: Any, exp: Any = None) -> str:  # noqa: N802
        parts = _parts(expr, self.notation)
        if parts is None:
            return str(super()._print_Function(expr, exp))
        lower, upper, arguments = (
            [x if isinstance(x, str) else self._print(x) for x in part]
            for part in (parts.lower, parts.upper, parts.arguments)
        )
        below = f"_{{{','.join(lower)}}}" if lower else ""
        raised = f"^{{{','.join(upper)}}}" if upper else ""
        return f"{expr.func.__name__}{below}{raised}({'; '.join(arguments)})"

    def _print_Knots(self, expr: Any) -> str:  # noqa: N802
        return f"({', '.join(decimal(number) or self._print(number) for number in expr)})"

    _print_Numbers = _print_Knots  # noqa: N815


class _Printer(_PositiveFirst, MathMLPresentationPrinter):  # type: ignore[misc]  # SymPy is untyped
    """SymPy's presentation printer, but for names with indices and functions that a paper writes in its own way."""

    notation: Notation = MappingProxyType({})

    def _print_Symbol(self, sym: Any, style: str = "plain") -> Any:  # noqa: N802
        return self._name(str(sym))

    def _print_Indexed(self, e: Any) -> Any:  # noqa: N802
        return self._with_index(self._leaf("mi", str(e.base)), ",".join(map(str, e.indices)))

    def _print_AppliedUndef(self, e: Any) -> Any:  # noqa: N802
        """Set a function as a paper writes it, other functions as f(x, y)."""
        row = self.dom.createElement("mrow")
        parts = _parts(e, self.notation)
        head, arguments, between = self._leaf("mi", e.func.__name__), list(e.args), ","
        if parts is not None:
            lower, upper, arguments, between = [*parts.lower], [*parts.upper], [*parts.arguments], ";"
            head = self._with_index(head, ",".join(map(str, lower)))
            if upper:
                raised = self.dom.createElement("msubsup")
                for child in (*head.childNodes, self._list(upper)):
                    raised.appendChild(child.cloneNode(True))
                head = raised
        row.appendChild(head)
        row.appendChild(self._leaf("mo", "("))
        for n, argument in enumerate(arguments):
            if n:
                row.appendChild(self._leaf("mo", between))
            row.appendChild(self._print(argument))
        row.appendChild(self._leaf("mo", ")"))
        return row

    def _list(self, parts: list[Any]) -> Any:
        row = self.dom.createElement("mrow")
        for part in parts:
            row.appendChild(self._leaf("mi", part) if isinstance(part, str) else self._print(part))
        return row

    _print_Function = _print_AppliedUndef  # noqa: N815

    def _name(self, name: str) -> Any:
        if name.startswith("("):  # a difference that stands for one quantity
            return self._difference(name)
        found = _NAME.fullmatch(name)
        if found is None:
            return self._leaf("mi", _GREEK.get(name, name))
        base, primes, number, index, more, upper = found.groups()
        head = self._leaf("mi", _GREEK.get(base, base) + "′" * len(primes + more))
        lower = number or index
        head = self._with_index(head, lower) if lower else head
        return self._raised(head, upper) if upper else head

    def _difference(self, name: str) -> Any:
        left, _, right = name.strip("()").partition("}-")
        row = self.dom.createElement("mrow")
        parts = [self._leaf("mo", "("), self._name(left + "}"), self._leaf("mo", "−"), self._name(right)]
        for part in (*parts, self._leaf("mo", ")")):
            row.appendChild(part)
        return row

    def _raised(self, head: Any, upper: str) -> Any:
        element = self.dom.createElement("msup")
        element.appendChild(head)
        element.appendChild(self._leaf("mi", upper))
        return element

    def _print_Knots(self, e: Any) -> Any:  # noqa: N802
        row = self.dom.createElement("mrow")
        row.appendChild(self._leaf("mo", "("))
        for n, number in enumerate(e):
            if n:
                row.appendChild(self._leaf("mo", ","))
            row.appendChild(self._leaf("mn", decimal(number)) if decimal(number) else self._print(number))
        row.appendChild(self._leaf("mo", ")"))
        return row

    _print_Numbers = _print_Knots  # noqa: N815

    def _with_index(self, head: Any, index: str) -> Any:
        element = self.dom.createElement("msub")
        element.appendChild(head)
        row = self.dom.createElement("mrow")
        for letter, sub, number, operator in _TOKEN.findall(index.replace("{", "").replace("}", "")):
            if number:
                row.appendChild(self._leaf("mn", number))
            elif operator:
                row.appendChild(self._leaf("mo", "−" if operator == "-" else operator))
            else:
                row.appendChild(self._name(f"{letter}_{sub}" if sub else letter))
        element.appendChild(row)
        return element

    def _leaf(self, tag: str, text: str) -> Any:
        leaf = self.dom.createElement(tag)
        leaf.appendChild(self.dom.createTextNode(text))
        return leaf


def mathml(expression: Any, notation: Notation | None = None) -> str:
    """Return a `<math>` element.

    Parameters
    ----------
    expression : sympy.Basic
    notation : mapping, optional
        Name of a function -> where its arguments stand.

    Examples
    --------
    >>> from sympy import Symbol
    >>> mathml(Symbol("u_{m-3}"))
    '<math><msub><mi>u</mi><mrow><mi>m</mi><mo>&#8722;</mo><mn>3</mn></mrow></msub></math>'
    """
    printer = _Printer()
    printer.notation = notation or {}
    return f"<math>{printer.doprint(expression)}</math>".replace("&InvisibleTimes;", "&#8290;").replace(
        "&dd;", "&#8518;"
    )


def latex(expression: Any, notation: Notation | None = None) -> str:
    """Return LaTeX.

    Examples
    --------
    >>> from sympy import symbols
    >>> a, b = symbols("a b")
    >>> latex(b - a)
    'b - a'
    """
    printer = _Latex()
    printer.notation = notation or {}
    return str(printer.doprint(expression))


def text_html(text: str) -> str:
    """Return a sentence as HTML, where names such as u_1, w_{k_r+1} and alpha^4 have their indices below or above.

    Examples
    --------
    >>> text_html("u_1 < w_{k_r+1}")
    '<i>u</i><sub>1</sub> &lt; <i>w</i><sub><i>k</i><sub>r</sub>+1</sub>'
    >>> text_html("a blend of P_ij by alpha^4")
    'a blend of <i>P</i><sub>ij</sub> by <i>α</i><sup>4</sup>'
    """
    pieces, end = [], 0
    for found in _IN_TEXT.finditer(text):
        letter, index, primes, upper = found.groups()
        if index or upper:
            pieces += [escape(text[end : found.start()]), _name_html(letter, index, primes, upper)]
            end = found.end()
    return "".join(pieces) + escape(text[end:])


def _name_html(base: str, index: str | None, primes: str, upper: str | None) -> str:
    html = f"<i>{_GREEK.get(base, base)}</i>" + "′" * len(primes)
    lower = (index or "").removeprefix("{").removesuffix("}")
    if lower:
        html += f"<sub>{text_html(lower)}</sub>"
    return html + (f"<sup>{text_html(upper.strip('()'))}</sup>" if upper else "")
