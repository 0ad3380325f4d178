"""Every sentence of the paper has its records or a reason, and every record its sentence."""

from itertools import groupby

import pytest

from semispline.papers.ledger.loading import load_paper
from semispline.papers.ledger.records import Strength, Verdict
from semispline.papers.lin2014.claims import section_1
from semispline.papers.lin2014.sentences import SENTENCES

IDS = {claim.id for claim in load_paper("lin2014").claims}
NAMED = {name for records in SENTENCES.values() if not isinstance(records, str) for name in records}


def test_every_record_has_a_sentence_and_every_name_is_one_of_a_record():
    assert NAMED == IDS


def test_sentences_are_numbered_without_a_gap():
    numbers = [place.split(".") for place in SENTENCES if place[1] == "."]
    counts = {section: [int(n) for _, n in found] for section, found in groupby(numbers, key=lambda pair: pair[0])}
    assert list(counts) == ["0", "1", "R", "2", "3", "4", "5", "6", "A"]
    for section, found in counts.items():
        assert found == list(range(1, len(found) + 1)), section
    assert {f"Fig. {n}" for n in range(1, 12)} | {"Table 1"} <= set(SENTENCES)


@pytest.mark.parametrize("place", SENTENCES)
def test_a_sentence_has_records_or_a_reason(place):
    records = SENTENCES[place]
    assert records
    assert isinstance(records, str) or len(set(records)) == len(records)


@pytest.mark.long
def test_what_is_only_consistent_is_named_so():
    """Printed numbers that agree, and things of which one of the kind exists, are no proof of what is claimed."""
    found = {c.id for c in load_paper("lin2014").claims for p in c.parts if p.check.strength is Strength.CONSISTENT}
    assert {"fig-9.same-bases", "sec-5.bicubic", "sec-5.middle-curves", "sec-5.cone", "fig-11.counts"} <= found
    definitions = {c.id for c in load_paper("lin2014").claims if c.verdict is Verdict.DEFINITION}
    assert definitions == {"sec-3.sides", "sec-1.terms", "sec-1.two-types"}


def test_equal_vectors_would_be_seen(monkeypatch):
    assert all(case.true for case in section_1._different_vectors(None))
    monkeypatch.setattr(section_1, "printed_pair", lambda name: ((0, 1), (0, 1)))
    assert not any(case.true for case in section_1._different_vectors(None))
