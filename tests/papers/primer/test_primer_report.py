"""REPORT.md and RECORDS.md say what the records of the second document come to."""

import pytest

from semispline import __version__
from semispline.papers.ledger import verify
from semispline.papers.primer.erratum import erratum
from semispline.papers.report import ledger_markdown


@pytest.mark.slow
def test_the_stored_documents_are_what_is_decided():
    ledger = verify("primer")
    assert ledger.ok
    written = {"REPORT.md": erratum(ledger, __version__).text, "RECORDS.md": ledger_markdown(ledger)}
    for name, text in written.items():
        assert (ledger.paper.folder / name).read_text("utf-8") == text
