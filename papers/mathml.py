"""Formulas as MathML, which browsers set without a network, and as LaTeX: SymPy's printers, the paper's letters."""

from __future__ import annotations

import re
from typing import Any

from sympy.printing.latex import LatexPrinter
from sympy.printing.mathml import MathMLPresentationPrinter

# A letter with its own index, a number, or an operator, inside an index such as k_r+1 or m-k+1.
_TOKEN = re.compile(r"([A-Za-z]+)(?:_([A-Za-z0-9]+))?|(\d+)|([-+,'])")
_GREEK = {"alpha": "α", "beta": "β", "delta": "δ", "kappa": "κ"}


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
            return self._leaf("mi", name.replace("{", "").replace("}", ""))
        base, _, index = name.partition("_")
        head = self._leaf("mi", _GREEK.get(base, base))
        return self._with_index(head, index) if index else head

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
