"""What is printed stands in both reports beside what was read of it, or beside why it was read by hand."""

from dataclasses import replace

import pytest
import sympy as sp

from semispline.papers.checks.printed_code import Code, code
from semispline.papers.ledger.records import Print
from semispline.papers.ledger.verification import verify
from semispline.papers.ledger.writing import formula, holds, part
from semispline.papers.report.ledger_as_html import ledger_html
from semispline.papers.report.ledger_as_markdown import ledger_markdown
from semispline.papers.report.ledger_words import print_lines


@pytest.fixture(scope="module")
def ledger(made_up_paper_once):
    """The made-up paper, with the print of its first record read, and that of its second one not."""
    found = verify(str(made_up_paper_once), workers=1)
    right, wrong = found.paper.claims
    claims = (
        replace(right, printed=Print("T <\n n", r"T < n \cdot 1")),
        replace(wrong, printed=Print("n^(2)/2", by_hand="one-token script at p.md:3:3")),
    )
    return replace(found, paper=replace(found.paper, claims=claims))


def test_the_page_has_both(ledger):
    page = ledger_html(ledger)
    read = r"<th>as printed</th><td><pre>T &lt;\n n</pre></td></tr><tr><th>read as</th><td><pre>T &lt; n \cdot 1</pre>"
    assert read.replace(r"\n", "\n") in page
    assert "<pre>n^(2)/2</pre></td></tr><tr><th>read by hand</th><td><pre>one-token script at p.md:3:3</pre>" in page


def test_the_erratum_has_both(ledger):
    lines = ledger_markdown(ledger).splitlines()
    at = lines.index("- **As printed:** `n^(2)/2`")
    assert lines[at + 1] == "- **Read by hand:** `one-token script at p.md:3:3`"


def test_records_without_a_print_look_as_before(made_up_paper_once):
    text = ledger_html(verify(str(made_up_paper_once), workers=1))
    assert "<th>as printed</th>" not in text


def test_lines_of_code_are_shown_with_the_words_that_were_replaced():
    n = sp.Symbol("n")
    lines = Code("\nf(n):\n  return clone n\n", "f(n)", {"clone n": "n"})
    record = holds("alg-1", "Section 1", "It is n.", part(code(), formula(sp.Eq(n, lines, evaluate=False))))
    text = [("as printed", "f(n):\n  return clone n"), ("read by hand", "clone n: run as n")]
    assert print_lines(record) == text
    # What a record itself says is printed is shown alone.
    assert print_lines(replace(record, printed=Print("x"))) == [("as printed", "x")]
