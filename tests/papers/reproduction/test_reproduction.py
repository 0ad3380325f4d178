"""Running a study: the same numbers at every run, files whole or not at all, findings that follow the measures."""

import re
import sys
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from helpers.small_report import METHODS, fails, small_results, small_study
from semispline.papers.cli import app
from semispline.papers.lin2014.findings import findings, meets_demand
from semispline.papers.lin2014.study import study
from semispline.papers.report.documents import markdown, numbers, write_report
from semispline.papers.report.ledger_as_markdown import STUDY_HEADING, ledger_markdown, with_study_kept
from semispline.papers.report.table_text import cell
from semispline.papers.report.versions import environment
from semispline.papers.reproduction.study import Drawing
from semispline.solver.io.json_text import load_json


@pytest.fixture(scope="module")
def results(small_report):
    return small_report[0]


@pytest.fixture(scope="module")
def folder(results, tmp_path_factory):
    made = tmp_path_factory.mktemp("written")
    write_report(results, made)
    return made


def timeless(value):
    """Leave out times, and tables, which show them."""
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in ("seconds", "tables")}
    return [timeless(v) for v in value] if isinstance(value, list) else value


@pytest.mark.long
def test_a_second_run_gives_the_same_numbers(results, made_up_paper_once, tmp_path):
    first, *_ = small_study().examples
    again = small_results(made_up_paper_once, tmp_path, study=replace(small_study(), examples=(first,), drawings=()))
    assert timeless(again.comparisons[first.task.name][0].record())["energy"] > 0
    for found, before in zip(again.comparisons["figure-6"], results.comparisons["figure-6"], strict=True):
        assert timeless(found.record()) == timeless(before.record())
    assert timeless(numbers(again)["ledger"]) == timeless(numbers(results)["ledger"])


@pytest.mark.long
def test_every_step_is_told(small_report):
    assert small_report[1] == {"blending": (3 * len(METHODS), 3 * len(METHODS)), "drawing": (2, 2)}


def test_numbers_hold_every_measure(results, folder):
    record = load_json(folder / "numbers.json")
    assert (record["format"], record["kind"]) == ("semispline/1", "reproduction")
    assert len(record["comparisons"]) == 3 * len(METHODS)
    by_name = {(r["example"], r["method"]): r for r in record["comparisons"]}
    for name, found in results.comparisons.items():
        for c in found:
            stored = by_name[name, c.method.name]
            if c.measures is None:
                assert stored["reason"]
            else:
                assert stored["energy"] == c.measures.energy
                assert stored["contact_b"]["angle_degrees"] == c.measures.contact_b.angle_degrees
    assert [c["verdict"] for c in record["ledger"]["claims"]] == ["holds", "fails"]
    assert record["environment"]["numpy"]
    assert {t["name"] for t in record["tables"]} == {"table-1"}


@pytest.mark.long
def test_markdown_has_the_same_tables(results, folder):
    text = (folder / "report.md").read_text()
    assert text == "\n".join(markdown(results))
    for title in ("Table 1, printed and measured", "two complete cylinders: every method", "Blends, measured"):
        assert title in text
    rows = [line for line in text.splitlines() if line.startswith("| ")]
    widths = {len(re.findall(r"(?<!\\)\|", line)) for line in rows}
    assert len(widths) == 4  # Table 1, methods, pairs, ledger


def test_the_records_have_the_ledger_first_and_verify_keeps_the_rest(results, folder):
    text = (folder / "RECORDS.md").read_text()
    ledger = ledger_markdown(results.ledger)
    assert text.startswith(ledger)
    assert text.index("## Erratum") < text.index(STUDY_HEADING) < text.index("Prior art:")
    assert with_study_kept(ledger, text) == text
    # A paper without a text of its own gets no REPORT.md.
    assert not (folder / "REPORT.md").exists()


def test_the_page_is_written(folder):
    assert (folder / "index.html").read_text().startswith("<!DOCTYPE html>")


@pytest.mark.long
def test_a_picture_that_fails_leaves_no_page(made_up_paper_once, tmp_path):
    study = replace(small_study(), examples=(), drawings=(Drawing("broken", "", fails),))
    with pytest.raises(RuntimeError, match="cannot draw broken"):
        small_results(made_up_paper_once, tmp_path, study=study)
    assert not (tmp_path / "index.html").exists()


def test_a_folder_that_cannot_be_made_is_exit_status_2(tmp_path):
    (tmp_path / "file").write_text("")
    done = CliRunner().invoke(app, ["reproduce", "lin2014", "--out", str(tmp_path / "file" / "report")])
    assert done.exit_code == 2
    assert "cannot be made" in done.stderr


def test_findings_follow_the_measures(results):
    found = {f.short.split(" ")[0]: f for f in findings(results.comparisons)}
    assert "3 of 3 examples" in found["With"].short
    assert "2 of 3 examples" in found["Run"].short
    assert "Fig. 10" in found["Run"].detail
    jumps = [
        c.measures.curvature_jump_relative
        for example in results.comparisons.values()
        for c in example
        if c.method.name == "paper-as-printed"
    ]
    assert f"up to {max(jumps):.2g} " in found["Run"].detail


def test_the_fairest_blend_is_the_first_column_of_the_pairs(results):
    by_name = {c.method.name: c for c in results.comparisons["made"]}
    rows = {row[0]: row[1:] for row in results.blends.rows}
    assert rows["blend"] == ("G2, fairest", "G2, least energy", "C2, least energy")
    shown = [by_name[f"semistructured-{name}"].measures for name in ("fair", "reduced", "c2")]
    assert rows["fairness"] == tuple(cell(m.fairness) for m in shown)
    assert rows["largest turn inside [°]"] == tuple(cell(m.turn_degrees) for m in shown)
    assert shown[0].fairness < min(m.fairness for m in shown[1:])


def test_findings_say_what_fairness_wins_and_whom_it_loses_to(results):
    short = "The fairest blend, which is the default, beats that of least energy in"
    found = next(f for f in findings(results.comparisons) if f.short.startswith(short))
    assert found.short.endswith("3 of 3 examples")
    quotients = [
        rows["semistructured-reduced"].measures.fairness / rows["semistructured-fair"].measures.fairness
        for rows in ({c.method.name: c for c in found} for found in results.comparisons.values())
    ]
    assert f"is {min(quotients):.3g} to {max(quotients):.3g} times as much" in found.detail
    assert "folds in none" in found.detail
    assert "fairer somewhere: none." in found.detail
    # A rival that becomes fairer is named, one that folds is not; a blend that becomes unfair loses.
    changed = {
        name: [
            altered(c, fairness=1e-3, turn_degrees=5.0 if name == "made" else 100.0)
            if c.method.name == "paper-corrected"
            else altered(c, fairness=1e9)
            if c.method.name == "semistructured-fair" and name == "figure-6"
            else c
            for c in rows
        ]
        for name, rows in results.comparisons.items()
    }
    lost = next(f for f in findings(changed) if f.short.startswith(short))
    assert lost.short.endswith("2 of 3 examples")
    assert "the paper corrected (the made pair)" in lost.detail


def altered(comparison, **measures):
    return replace(comparison, measures=replace(comparison.measures, **measures))


def test_the_finding_on_a_real_pair_says_which_blends_fold(results):
    real = {"blades": results.comparisons["made"]}
    (none,) = (f for f in findings(real) if f.short.startswith("On the real pair (blades)"))
    assert none.short.endswith("0 of 3 blends fold, and the fairest does not")
    assert none.detail.startswith("Each of them meets both bases exactly.")
    for name in ("semistructured-c2", "semistructured-fair"):
        turned = [altered(c, turn_degrees=171.0) if c.method.name == name else c for c in real["blades"]]
        (found,) = (f for f in findings({"blades": turned}) if f.short.startswith("On the real pair"))
        assert found.short.endswith(
            "1 of 3 blends fold, and the fairest does " + ("so too" if name == "semistructured-fair" else "not")
        )
        assert "turns by up to 171 degrees" in found.detail
    # Nothing to compare with: nothing is said.
    alone = {"blades": [c for c in real["blades"] if c.method.name == "semistructured-fair"]}
    assert not [f for f in findings(alone) if "real pair" in f.short]


def test_findings_change_when_a_result_does(results):
    """Rows as printed under the name of the corrected ones: no promise is kept where they miss."""
    swapped = {}
    for name, found in results.comparisons.items():
        as_printed = next(c for c in found if c.method.name == "paper-as-printed")
        others = [c for c in found if c.method.name != "paper-corrected"]
        corrected = next(c for c in found if c.method.name == "paper-corrected").method
        swapped[name] = [*others, replace(as_printed, method=corrected)]
    assert "1 of 3 examples" in next(f.short for f in findings(swapped) if f.short.startswith("With"))


def test_c2_is_demanded_where_the_example_asks_for_it(results):
    g2 = next(c for c in results.comparisons["figure-6"] if c.method.name == "paper-corrected")
    assert meets_demand(g2)
    assert not meets_demand(replace(g2, task=replace(g2.task, continuity="C2")))
    c2 = next(c for c in results.comparisons["figure-6"] if c.method.name == "semistructured-c2")
    assert meets_demand(replace(c2, task=replace(c2.task, continuity="C2")))


def test_the_study_names_every_figure_once_and_only_its_own_pictures():
    whole = study()
    names = [drawing.name for drawing in whole.drawings]
    assert len(names) == len(set(names))
    assert {f"figure-{i}" for i in range(1, 12)} <= set(names)
    assert {name for example in whole.examples for name in example.pictures} <= set(names)
    # Pictures of the pairs are of one blend, the fairest.
    assert {name for name in names if "made" in name} == {"made-shaded", "made-zebra"}
    tasks = [example.task.name for example in whole.examples]
    figures = [f"figure-{i}" for i in (5, 6, 8, 9, 10, 11)]
    assert tasks[:9] == [*figures, "figure-10-exact", "figure-11-exact", "made"]


def test_versions_are_those_of_what_is_installed():
    import numpy as np

    found = environment()
    assert found["numpy"] == np.__version__
    assert {"semispline", "Python", "sympy", "casadi", "python-flint"} <= set(found)
    assert "cores" in found["processor"]


def test_without_pyvista_it_says_so_before_any_work(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    done = CliRunner().invoke(app, ["reproduce", "lin2014", "--out", str(tmp_path)])
    assert done.exit_code == 2
    assert "semispline[view]" in done.stderr
    assert "printed claims" not in done.output


def test_table_1_shows_the_printed_digits_beside_ours(results):
    (table,) = results.study.tables(results.comparisons)
    rows = {(row[0], row[1]): row[2:] for row in table.rows}
    assert rows["Fig. 5", "printed"] == (
        "6 × 5",
        "6 × 6",
        "C2 (claimed)",
        "–",
        "–",
        "–",
        "0.4515",
        "3.09e6",
        "0.0000 to 0.0817",
    )
    assert rows["Fig. 6", "printed"][5:] == ("5", "1.4599", "3.15e6", "0.0000 to 0.2581")
    assert rows["Fig. 11", "printed"][:2] == ("4 × 10", "5 × 64")
    assert rows["Fig. 6", "ours, formulas as printed"][:3] == ("5 × 10", "5 × 8", "G2: no")
    assert rows["Fig. 6", "ours, formulas corrected"][2] == "G2: yes"
    # Figures that were not run have no row of ours.
    assert {name for name, what in rows if what != "printed"} == {"Fig. 6", "Fig. 10"}
