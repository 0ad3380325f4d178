"""Formulas as MathML, which browsers set without a network, and as LaTeX: SymPy's printers, the paper's letters."""

from __future__ import annotations

import re
from html import escape
from typing import Any

from sympy.printing.latex import LatexPrinter
from sympy.printing.mathml import MathMLPresentationPrinter

# A letter with its own index, a number, or an operator, inside an index such as k_r+1 or m-k+1.
_TOKEN = re.compile(r"([A-Za-z]+)(?:_([A-Za-z0-9]+))?|(\d+)|([-+,'])")
_GREEK = {"alpha": "α", "beta": "β", "delta": "δ", "kappa": "κ", "rho": "ρ", "mu": "μ", "theta": "θ"}
# h1 and alpha2 are h_1 and alpha_2; primes stand before or after the index, and V^r has an upper one.
_NAME = re.compile(r"([A-Za-z]+)('*)(?:_?(\d+)|_(\w+|\{.*\}))?('*)(?:\^(\w+))?")
# The same inside a sentence: a letter or Greek name with a lower index, an upper one, or both. G2 and C2 are no letters
# with an index, h1 and H1 are.
_IN_TEXT = re.compile(
    r"\b(?:([hH])(\d)\b|([A-Za-z]|alpha|beta|kappa|rho|mu)(?:_(\{(?:[^{}]|\{[^{}]*\})*\}|[A-Za-z0-9]+))?)('*)"
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


def _basis_parts(e: Any) -> tuple[list[Any], list[Any], list[Any]] | None:
    """Return lower indices, upper indices and arguments of a basis function; None for other functions.

    B(i, n, x) is a Bernstein polynomial, B(i, k, x, knots) a B-spline, a fifth argument the order of a derivative.
    """
    arguments = list(e.args)
    if e.func.__name__ != "B" or len(arguments) < 3:
        return None
    if len(arguments) == 3:
        return arguments[:1], arguments[1:2], arguments[2:]
    derivative = [f"({arguments[4]})"] if len(arguments) > 4 and arguments[4] != 0 else []
    return arguments[:2], derivative, arguments[2:4]


class _Latex(_PositiveFirst, LatexPrinter):  # type: ignore[misc]
    """SymPy's LaTeX printer, but for basis functions."""

    def _print_Function(self, expr: Any, exp: Any = None) -> str:  # noqa: N802
        parts = _basis_parts(expr)
        if parts is None:
            return str(super()._print_Function(expr, exp))
        lower, upper, arguments = ([x if isinstance(x, str) else self._print(x) for x in part] for part in parts)
        raised = f"^{{{','.join(upper)}}}" if upper else ""
        return f"B_{{{','.join(lower)}}}{raised}({'; '.join(arguments)})"

    def _print_Knots(self, expr: Any) -> str:  # noqa: N802
        return f"({', '.join(decimal(number) or self._print(number) for number in expr)})"

    _print_Numbers = _print_Knots  # noqa: N815


class _Printer(_PositiveFirst, MathMLPresentationPrinter):  # type: ignore[misc]  # SymPy is untyped
    """SymPy's presentation printer, but for names with indices and for basis functions."""

    def _print_Symbol(self, sym: Any, style: str = "plain") -> Any:  # noqa: N802
        return self._name(str(sym))

    def _print_Indexed(self, e: Any) -> Any:  # noqa: N802
        return self._with_index(self._leaf("mi", str(e.base)), ",".join(map(str, e.indices)))

    def _print_AppliedUndef(self, e: Any) -> Any:  # noqa: N802
        """Set a basis function with its indices, other functions as f(x; y)."""
        row = self.dom.createElement("mrow")
        parts = _basis_parts(e)
        head, arguments = self._leaf("mi", e.func.__name__), list(e.args)
        if parts is not None:
            lower, upper, arguments = parts
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
                row.appendChild(self._leaf("mo", ";"))
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


def mathml(expression: Any) -> str:
    """Return a `<math>` element.

    Examples
    --------
    >>> from sympy import Symbol
    >>> mathml(Symbol("u_{m-3}"))
    '<math><msub><mi>u</mi><mrow><mi>m</mi><mo>&#8722;</mo><mn>3</mn></mrow></msub></math>'
    """
    text = _Printer().doprint(expression)
    return f"<math>{text}</math>".replace("&InvisibleTimes;", "&#8290;").replace("&dd;", "&#8518;")


def latex(expression: Any) -> str:
    """Return LaTeX.

    Examples
    --------
    >>> from sympy import symbols
    >>> a, b = symbols("a b")
    >>> latex(b - a)
    'b - a'
    """
    return str(_Latex().doprint(expression))


def text_html(text: str) -> str:
    """Return a sentence as HTML, where names such as u_1, w_{k_r+1}, alpha^4 and H1 have their indices below or above.

    Examples
    --------
    >>> text_html("u_1 < w_{k_r+1}")
    '<i>u</i><sub>1</sub> &lt; <i>w</i><sub><i>k</i><sub>r</sub>+1</sub>'
    >>> text_html("a blend of P_ij by alpha^4")
    'a blend of <i>P</i><sub>ij</sub> by <i>α</i><sup>4</sup>'
    """
    pieces, end = [], 0
    for found in _IN_TEXT.finditer(text):
        short, number, letter, index, primes, upper = found.groups()
        if index or short or upper:
            pieces += [escape(text[end : found.start()]), _name_html(letter or short, index or number, primes, upper)]
            end = found.end()
    return "".join(pieces) + escape(text[end:])


def _name_html(base: str, index: str | None, primes: str, upper: str | None) -> str:
    html = f"<i>{_GREEK.get(base, base)}</i>" + "′" * len(primes)
    lower = (index or "").removeprefix("{").removesuffix("}")
    if lower:
        html += f"<sub>{text_html(lower)}</sub>"
    return html + (f"<sup>{text_html(upper.strip('()'))}</sup>" if upper else "")
