"""The page: everything is inside it, everything that is linked is there, formulas are well formed, cells are right."""

import re
from base64 import b64decode
from html.parser import HTMLParser
from io import BytesIO
from xml.etree import ElementTree

import pytest
from PIL import Image

from helpers.small_report import METHODS
from semispline.papers.report.chart import energy_chart
from semispline.papers.report.html_page import page
from semispline.papers.report.measured_tables import methods_table
from semispline.papers.report.table_text import cell
from semispline.papers.reproduction.measures import reached


class Elements(HTMLParser):
    """All elements with their attributes, and the visible text."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.words, self.inside = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag in ("script", "style"):
            self.inside.append(tag)

    def handle_endtag(self, tag):
        if self.inside and self.inside[-1] == tag:
            self.inside.pop()

    def handle_data(self, data):
        if not self.inside:
            self.words.append(data)

    def values(self, name):
        return [a[name] for _, a in self.elements if name in a]


@pytest.fixture(scope="module")
def results(small_report):
    return small_report[0]


@pytest.fixture(scope="module")
def html(results):
    return page(results)


@pytest.fixture(scope="module")
def parsed(html):
    return Elements(html)


@pytest.mark.long
def test_nothing_is_outside_of_the_page(html, parsed):
    assert all(source.startswith("data:image/webp;base64,") for source in parsed.values("src"))
    assert all(link.startswith("#") for link in parsed.values("href"))
    assert not [tag for tag, _ in parsed.elements if tag in ("link", "iframe", "object", "base")]
    for word in ("url(", "@import", "http:", "https:"):
        assert word not in re.sub(r"data:image/webp;base64,[\w+/=]+", "", html)


def test_every_link_leads_somewhere_and_every_id_is_unique(parsed):
    ids = parsed.values("id")
    assert len(ids) == len(set(ids))
    assert {link[1:] for link in parsed.values("href")} <= set(ids)
    assert {"found", "table-1", "ledger", "claim-eq-1", "claim-eq-2", "figure-6", "figure-10", "made", "blends"} <= set(
        ids
    )


def test_pictures_are_those_that_were_drawn(parsed):
    images = [a for tag, a in parsed.elements if tag == "img"]
    assert [a["alt"] for a in images] == ["a wide <picture>", "another one"]
    for attributes, color, size in zip(images, ((200, 30, 30), (30, 30, 200)), ((1600, 533), (300, 400)), strict=True):
        picture = Image.open(BytesIO(b64decode(attributes["src"].split(",")[1])))
        assert picture.size == size == (int(attributes["width"]), int(attributes["height"]))
        # WebP is lossy, by a few steps of 255.
        assert max(abs(a - b) for a, b in zip(picture.getpixel((9, 9)), color, strict=True)) <= 6


def test_formulas_are_mathml(html):
    found = re.findall(r"<math>.*?</math>", html, flags=re.DOTALL)
    assert len(found) >= 4
    for formula in found:
        assert len(ElementTree.fromstring(formula)) > 0
    assert "<mi>n</mi>" in "".join(found)


def test_the_first_words_say_what_was_found(results, parsed):
    words = " ".join(" ".join(parsed.words).split())
    head = words[: words.index("Table 1, printed and measured")]
    assert "2 printed claims 1 holds 0 holds if 1 fails" in head
    assert "The sum is n^2/2." in head
    for finding in results.study.findings(results.comparisons):
        assert finding.short in head
    assert "A note with <angle> brackets & more." in words


def test_each_view_opens_with_the_fairest_blend(results, html):
    first = re.findall(r"<select><option value='0'>([^<]+)</option>", html)
    assert first == ["G2, fairest shape (the default)"] * len(results.comparisons)


def test_every_method_has_its_line_or_its_reason(results):
    for name, comparisons in results.comparisons.items():
        table = methods_table(comparisons)
        assert len(table.rows) == len([c for c in comparisons if c.outcome])
        assert all(len(row) == len(table.head) for row in table.rows)
        energies = [row[table.head.index("energy (11)")] for row in table.rows]
        assert energies == [cell(c.measures.energy) for c in comparisons if c.measures]
        fairness = [row[table.head.index("fairness")] for row in table.rows]
        assert fairness == [cell(c.measures.fairness) for c in comparisons if c.measures]
        assert ("Bloor-Wilson" in table.note) is (name != "figure-10")
    closed = methods_table(results.comparisons["figure-10"])
    assert all("seam" in row[-1] for row in closed.rows)


def test_contact_is_named_after_the_measures(results):
    found = {c.method.name: reached(c.task, c.measures) for c in results.comparisons["figure-6"] if c.measures}
    assert found["paper-as-printed"] == "G1"
    assert found["paper-corrected"] == "G2"
    moved = {c.method.name: c for c in results.comparisons["figure-10"]}["bloor-wilson-4"]
    assert reached(moved.task, moved.measures) == "G1"


def test_the_chart_has_every_usable_method_once(results):
    comparisons = results.comparisons["figure-6"]
    chart = energy_chart(comparisons)
    ElementTree.fromstring(chart)
    labels = re.findall(r"class='mark'>([\d, ]+)<", chart)
    numbers = sorted(int(n) for label in labels for n in label.split(","))
    assert numbers == [i for i, c in enumerate(comparisons, 1) if c.outcome and c.outcome.control_points]
    assert [METHODS[n - 1] for n in numbers] == list(METHODS[:5])
    assert energy_chart(comparisons[:1]) == ""


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (-2.5e-13, "-2.5e-13"), (1776543.2, "1776543"), (0.5, "0.5"), ((0.0, 0.0), "0 to 0"), ("G2", "G2")],
)
def test_cells(value, text):
    assert cell(value) == text
