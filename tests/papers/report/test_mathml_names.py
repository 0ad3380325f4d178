"""Names in formulas and sentences have their indices below, above, or both."""

from xml.etree import ElementTree

import pytest
import sympy as sp

from semispline.papers.ledger.number_lists import Knots
from semispline.papers.ledger.records import Places
from semispline.papers.report.formulas import latex, mathml, text_html


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("u_1", ["u", "1"]),
        ("h1", ["h", "1"]),
        ("H1", ["H", "1"]),
        ("alpha2", ["α", "2"]),
        ("w_{k_r+1}", ["w", "k", "r", "+", "1"]),
        ("f''_0", ["f′′", "0"]),
        ("a_{ij}'", ["a′", "ij"]),
    ],
)
def test_a_name_is_set_with_its_index(name, parts):
    tree = ElementTree.fromstring(mathml(sp.Symbol(name)))
    assert tree.find("msub") is not None
    assert [element.text for element in tree.iter() if element.text] == parts


def test_an_upper_index_and_a_difference():
    assert ElementTree.fromstring(mathml(sp.Symbol("V^r"))).find("msup") is not None
    tree = ElementTree.fromstring(mathml(sp.Symbol("(P_{m-1,j}-P_{m,j})")))
    assert len(tree.findall(".//msub")) == 2


def test_knots_are_printed_as_they_were():
    knots = sp.Eq(sp.Symbol("V"), Knots(0, sp.Rational(1, 3), sp.Rational("0.142857"), 1), evaluate=False)
    assert latex(knots) == r"V = (0, \frac{1}{3}, 0.142857, 1)"
    assert "<mn>0.142857</mn>" in mathml(knots)


def test_a_function_is_written_as_its_paper_does():
    i, n, x = sp.symbols("i n x")
    value = sp.Function("B")(i, n, x)
    own = {"B": lambda arguments: Places(arguments[:1], arguments[1:2], arguments[2:])}
    assert (latex(value, own), latex(value)) == ("B_{i}^{n}(x)", r"B{\left(i,n,x \right)}")
    assert "msubsup" in mathml(value, own)
    assert ElementTree.fromstring(mathml(value)).find(".//msubsup") is None
    assert [e.text for e in ElementTree.fromstring(mathml(value)).iter("mo")] == ["(", ",", ",", ")"]


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("h_1 and H_2", "<i>h</i><sub>1</sub> and <i>H</i><sub>2</sub>"),
        ("the H1 norm of C2 functions", "the H1 norm of C2 functions"),
        ("lambda_0 = omega^2", "<i>λ</i><sub>0</sub> = <i>ω</i><sup>2</sup>"),
        ("kappa_1^2 < 2", "<i>κ</i><sub>1</sub><sup>2</sup> &lt; 2"),
        ("G2 or C1 by fig-5.c2, f(t) = i/k", "G2 or C1 by fig-5.c2, f(t) = i/k"),
    ],
)
def test_a_sentence_has_indices_too(text, html):
    assert text_html(text) == html
