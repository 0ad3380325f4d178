"""Each form of a statement: what is right is agreed on, what is wrong refused, by PARI and by `fractions`."""

import json
from dataclasses import replace

import pytest

from helpers.statements import RIGHT, WRONG, X
from semispline.papers.recheck import (
    Export,
    different,
    identity,
    write_certificates,
)
from semispline.papers.recheck.by_fractions import agrees
from semispline.papers.recheck.files import read_certificates
from semispline.papers.recheck.statements import Certificate, Identity, Reading, as_record, from_record
from semispline.papers.recheck.verdicts import verdict_of


def pari_agrees(tmp_path, *statements):
    """Return which of some statements PARI and `fractions` agree with, as the process does."""
    pytest.importorskip("cypari")
    from semispline.papers.recheck.process import recheck

    certificates = tuple(
        Certificate(f"eq-{n}", "holds", (Reading((case,)),)) for n, case in enumerate(statements, start=1)
    )
    write_certificates(tmp_path, Export("p", certificates))
    refused = recheck(tmp_path)["refused"]
    return [not any("fractions" not in name for name in refused.get(c.id, ())) for c in certificates]


@pytest.mark.parametrize("name", RIGHT)
def test_fractions_agree(name):
    assert agrees(RIGHT[name])


@pytest.mark.parametrize("name", WRONG)
def test_fractions_refuse(name):
    assert not agrees(WRONG[name])


def test_pari_agrees(tmp_path):
    assert dict(zip(RIGHT, pari_agrees(tmp_path, *RIGHT.values()), strict=True)) == dict.fromkeys(RIGHT, True)


def test_pari_refuses(tmp_path):
    assert dict(zip(WRONG, pari_agrees(tmp_path, *WRONG.values()), strict=True)) == dict.fromkeys(WRONG, False)


def test_a_quotient_by_itself_is_one_only_where_it_does_not_vanish(tmp_path):
    bare = Identity(label="a", left="x/x", right="1", variables=("x",), at=(("x", "2"),))
    assert pari_agrees(tmp_path, bare, replace(bare, nonzero=("x",)), replace(bare, nonzero=("x - 1",))) == [
        False,
        True,
        False,
    ]


@pytest.mark.parametrize("name", RIGHT)
def test_statements_come_back_from_a_file(name):
    assert from_record(json.loads(json.dumps(as_record(RIGHT[name])))) == RIGHT[name]


def test_factors_of_all_denominators_are_found():
    found = identity("a", 1 / (X**2 - 4) + 3 / X, "1/(z*(z - 1))", where=(("z", "x + 5"),))
    assert set(found.nonzero) == {"x", "x - 2", "x + 2", "x + 5", "x + 4"}


TRUE, FALSE = identity("t", X + X, "x*2"), different("f", X, "x + 1")
OUTSIDE = replace(FALSE, own=False, meets=False)


@pytest.mark.parametrize(
    ("readings", "verdict"),
    [
        ([Reading((TRUE,))], "holds"),
        ([Reading((TRUE, FALSE))], "fails"),
        ([Reading((TRUE, OUTSIDE), condition="c")], "holds-if"),
        ([Reading((TRUE, OUTSIDE))], None),
        ([Reading((TRUE, replace(OUTSIDE, meets=True)), condition="c")], None),
        ([Reading((TRUE,)), Reading((FALSE,))], "ambiguous"),
        ([Reading((TRUE,)), Reading(())], None),
        ([], None),
    ],
)
def test_verdicts_from_cases(readings, verdict):
    assert verdict_of(Certificate("eq-1", "holds", tuple(readings))) == verdict


def test_a_correction_that_is_false_leaves_no_verdict():
    wrong = Certificate("eq-1", "fails", (Reading((FALSE,)),), Reading((FALSE,)))
    assert verdict_of(wrong) is None
    assert verdict_of(replace(wrong, correction=Reading((TRUE,)))) == "fails"


def test_certificates_come_back_from_a_folder(tmp_path):
    certificate = Certificate("eq-1", "fails", (Reading((FALSE,), "l", "c"),), Reading((TRUE,)), ("b",), "o")
    write_certificates(tmp_path, Export("p", (certificate,), (TRUE,)))
    assert read_certificates(tmp_path) == ([certificate], [TRUE])
