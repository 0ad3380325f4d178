"""The formulas of the second document: all of them there, read or marked, and compared with the print by a reader."""

import re
from collections import Counter

import pytest

from semispline.papers.latex import NamesTable, UnreadableError, read_formula, read_names
from semispline.papers.latex.echoing import echo
from semispline.papers.latex.errors import Trouble
from semispline.papers.latex.page import COMPARED, NOT_COMPARED, echo_page
from semispline.papers.latex.trees import Named, walk
from semispline.papers.primer import echoes
from semispline.papers.primer.printed import blocks, code, formula, names, steps
from semispline.papers.pseudocode import CodeError

MATH = [block.id for block in blocks().values() if block.kind == "math"]
# Transcribed by hand, each with the class of what stands in the way.
BY_HAND = {
    "whatis.1": Trouble.LAYOUT,
    "matrix.4": Trouble.LAYOUT,
    "reordering.6": Trouble.SCRIPT,
    "reordering.9": Trouble.TEX,
    "derivatives.8": Trouble.ELLIPSIS,
    "derivatives.9": Trouble.ELLIPSIS,
    "derivatives.10": Trouble.ELLIPSIS,
    "derivatives.11": Trouble.ELLIPSIS,
    "extremities.3": Trouble.TEX,
    "extremities.6": Trouble.WORD,
    "canonical.4": Trouble.NUMERAL,
    "canonical.5": Trouble.NUMERAL,
    "canonical.11": Trouble.SLASH,
    "curvefitting.15": Trouble.ELLIPSIS,
    "offsetting.4": Trouble.OPERATOR,
    "offsetting.5": Trouble.OPERATOR,
    "circles_cubic.4": Trouble.KINDS,
    "circles_cubic.8": Trouble.SCRIPT,
    "circles_cubic.10": Trouble.UNDECLARED,
    "bsplines.7": Trouble.TEX,
}
READ = [identifier for identifier in MATH if identifier not in BY_HAND]


def test_what_is_printed_is_the_list_as_it_was_given(shared):
    listed = (shared / "primer" / "claims.md").read_text("utf-8")
    found = re.findall(r"^### (\S+)\n```(\w+)\n(.*?)^```$", listed, re.MULTILINE | re.DOTALL)
    assert [(block.id, block.kind, block.text) for block in blocks().values()] == found


def test_at_least_eighty_five_of_a_hundred_are_read_and_the_others_are_marked_with_their_class():
    refused = {}
    for identifier in MATH:
        try:
            formula(identifier)
        except UnreadableError as error:
            refused[identifier] = error.trouble
    assert refused == BY_HAND
    assert Counter(block.kind for block in blocks().values()) == {"math": 208, "text": 18}
    assert len(READ) >= 0.85 * len(MATH)


def test_each_echo_is_the_one_that_was_compared_with_the_print():
    page = echoes.PAGE.read_text("utf-8")
    entries = {entry.split()[0]: entry for entry in re.split(r"(?m)^## ", page)[1:]}
    anew = {entry.split()[0]: entry for entry in re.split(r"(?m)^## ", echoes.page(page))[1:]}
    assert list(entries) == list(blocks())
    stale = [identifier for identifier in anew if entries[identifier] != anew[identifier]]
    assert stale == [], "run python -m semispline.papers.primer.echoes, and compare these with the print"
    assert [identifier for identifier, entry in entries.items() if NOT_COMPARED in entry] == []


def test_an_echo_that_changes_is_not_compared_any_more():
    table = read_names("x, y : real")
    block, other = (blocks()[identifier] for identifier in ("explanation.1", "explanation.5"))
    shown = [type(block)("eq-1", "math", "x = y", "p.md", 1), type(other)("eq-2", "math", "y = x", "p.md", 5)]
    first = echo_page("# Head", shown, table, "", {})
    assert first.count(NOT_COMPARED) == 2
    compared = first.replace(NOT_COMPARED, COMPARED)
    assert echo_page("# Head", shown, table, compared, {}) == compared
    changed = [shown[0], type(other)("eq-2", "math", "y = -x", "p.md", 5)]
    again = echo_page("# Head", changed, table, compared, {})
    assert again.count(COMPARED) == again.count(NOT_COMPARED) == 1


@pytest.mark.parametrize("identifier", READ)
def test_an_echo_read_again_says_the_same(identifier):
    printed = formula(identifier)
    again = read_formula(echo(printed.statements, printed.names), printed.names)
    assert again.statements == printed.statements


def test_no_formula_is_read_without_one_of_its_names():
    tried = otherwise = 0
    for identifier in READ[::8]:
        printed = formula(identifier)
        used = {node.name for s in printed.statements for node in walk(s) if isinstance(node, Named)}
        for pattern in sorted(used):
            tried += 1
            removed = read_names(f"[{identifier}]\n- {pattern}").lines
            try:
                again = read_formula(printed.latex, NamesTable(names().lines + removed).of(identifier))
            except UnreadableError:
                continue
            # Without an integer i the index of `p_i` is a label, and p_i a name of its own.
            assert again.statements != printed.statements
            assert names().of(identifier).by_pattern[pattern].value == "integer"
            otherwise += 1
    assert tried > 80 > 20 * otherwise


@pytest.mark.long
def test_every_step_has_its_two_sides_in_sympy():
    # Where the display before is not read, the left side is not known.
    unknown = [identifier for identifier in READ for step in steps(identifier) if step.left is None]
    assert unknown == ["matrix.5", "canonical.12"]
    assert sum(len(steps(identifier)) for identifier in READ) > 340


def test_a_name_that_a_formula_gives_is_put_in_from_its_line_on():
    first, second, *_, last = steps("reordering.7")
    n = next(s for s in first.right.free_symbols if s.name == "n")
    assert not {s.name for s in second.right.free_symbols} & {"k", "s"}
    assert last.right.limits[0][2] == n + 1
    assert "s" not in {s.name for s in last.right.function.free_symbols}


def test_all_code_but_a_list_of_words_is_read():
    texts = [block.id for block in blocks().values() if block.kind == "text"]
    refused = []
    for identifier in texts:
        try:
            code(identifier)
        except CodeError:
            refused.append(identifier)
    assert (len(texts), refused) == (18, ["pointvectors3d.1"])


def test_every_section_of_the_table_is_that_of_a_chapter_or_a_formula():
    chapters = {identifier.rpartition(".")[0] for identifier in blocks()}
    assert set(names().sections) <= chapters | set(blocks())
