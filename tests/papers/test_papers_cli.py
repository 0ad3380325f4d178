"""The commands verify and reproduce: exit statuses, files, and what is printed."""

import json
import subprocess
import sys
from dataclasses import replace

import pytest
from typer.testing import CliRunner

import semispline
from helpers.sweeps import first_rows
from semispline.papers.cli import app
from semispline.papers.ledger.records import Verdict
from semispline.papers.ledger.verification import verify

runner = CliRunner()


def run(*arguments):
    return runner.invoke(app, [str(argument) for argument in arguments])


def test_all_commands_are_mounted():
    result = run("--help")
    assert result.exit_code == 0
    for command in ("verify", "reproduce", "derive", "generate", "blend", "check", "list", "show", "convert"):
        assert f" {command} " in result.output


def test_version_is_that_of_the_package():
    result = run("--version")
    assert (result.exit_code, result.output) == (0, f"semispline {semispline.__version__}\n")


def test_help_loads_nothing_heavy():
    code = (
        "import sys\nfrom semispline.papers.cli import app\nfrom typer.testing import CliRunner\n"
        "assert CliRunner().invoke(app, ['--help']).exit_code == 0\n"
        "print([name for name in ('sympy', 'scipy', 'casadi', 'pyvista', 'OCP') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.long
def test_verify_a_folder_and_write_both_files(made_up_paper, tmp_path):
    result = run("verify", made_up_paper(), "--json", tmp_path / "l.json", "--markdown", tmp_path / "r.md")
    assert result.exit_code == 0, result.output
    assert "2 printed claims, 2 decided" in result.output
    record = json.loads((tmp_path / "l.json").read_text())
    assert (record["format"], record["kind"]) == ("semispline/1", "ledger")
    assert [claim["verdict"] for claim in record["claims"]] == ["holds", "fails"]
    wanted = {
        "id", "statement", "verdict", "evidence", "residual", "counterexample", "corrected", "consequence", "seconds",
    }  # fmt: skip
    assert all(wanted <= set(claim) for claim in record["claims"])
    assert record["counts"]["fails"] == 1
    assert "### eq-2" in (tmp_path / "r.md").read_text()


@pytest.mark.long
def test_checks_that_export_nothing_are_told(made_up_paper, tmp_path):
    result = run("verify", made_up_paper(), "--json", tmp_path / "l.json", "--certificates", tmp_path / "c")
    assert result.exit_code == 0, result.output
    assert "0 identities exported; 2 not expressible" in result.output
    record = json.loads((tmp_path / "l.json").read_text())
    wanted = {"identities_exported": 0, "identities_agreed": 0, "rechecked": 0, "not_expressible": 2}
    assert wanted.items() <= record["counts"].items()
    assert all("no certificate has been written" in claim["recheck"]["not_expressible"] for claim in record["claims"])
    assert (tmp_path / "c" / "check.gp").is_file()


@pytest.mark.coq
def test_the_kernel_of_coq_is_asked_and_what_it_says_is_told(tmp_path):
    assert run("new-paper", tmp_path / "p").exit_code == 0
    options = ("--json", tmp_path / "l.json", "--certificates", tmp_path / "c", "--recheck", "coq")
    result = run("verify", tmp_path / "p", *options)
    assert result.exit_code == 0, result.output
    record = json.loads((tmp_path / "l.json").read_text())
    found = [claim["recheck"]["kernel"] for claim in record["claims"]]
    counts = record["counts"]
    assert counts["kernel_checked"] == sum(one["whole"] for one in found) > 0
    assert counts["kernel_inexpressible"] == sum(bool(one["inexpressible"]) for one in found)
    said = next(line for line in result.output.splitlines() if line.startswith("Coq 8"))
    assert f"{counts['kernel_checked']} records checked as a whole by its kernel" in said
    done = subprocess.run(["sh", "check.sh"], cwd=tmp_path / "c/coq", capture_output=True, text=True, check=False)
    assert (done.returncode, set(done.stdout.splitlines())) == (0, {"Closed under the global context"})


def test_a_second_system_that_is_not_known(made_up_paper):
    result = run("verify", made_up_paper(), "--recheck", "maple")
    assert result.exit_code == 2
    assert "--recheck: found 'maple', expected one of pari" in result.output


def test_a_folder_for_certificates_that_is_a_file(made_up_paper, tmp_path):
    (tmp_path / "c").write_text("mine")
    result = run("verify", made_up_paper(), "--certificates", tmp_path / "c")
    assert (result.exit_code, (tmp_path / "c").read_text()) == (2, "mine")


@pytest.mark.parametrize(("refused", "status"), first_rows(1, [({}, 0), ({"eq-1": ("eq-1 #1: x",)}, 1)]))
def test_what_a_second_system_refuses_is_a_no(made_up_paper, monkeypatch, refused, status):
    import semispline.papers.recheck as room

    monkeypatch.setattr(room, "require_system", lambda _: None, raising=False)
    monkeypatch.setattr(room, "rechecked", lambda export, _: room.Recheck(export, refused, {}), raising=False)
    result = run("verify", made_up_paper(), "--recheck", "pari")
    assert result.exit_code == status
    assert ("recheck: found different: eq-1 #1: x" in result.output) == bool(status)


@pytest.mark.long
def test_a_report_written_anew_keeps_what_the_study_found(made_up_paper, tmp_path):
    folder, report = made_up_paper(), tmp_path / "r.md"
    assert run("verify", folder, "--markdown", report).exit_code == 0
    ledger = report.read_text()
    assert "What the study finds" not in ledger
    study = "# What the study finds: a sum\n\nIt is right.\n"
    report.write_text(f"# an older ledger\n\n{study}")
    for _ in range(2):
        assert run("verify", folder, "--markdown", report).exit_code == 0
        assert report.read_text() == f"{ledger}\n{study}"


@pytest.mark.long
def test_json_on_standard_output_is_nothing_but_json(made_up_paper):
    result = run("verify", made_up_paper(), "--json", "-")
    assert json.loads(result.stdout)["counts"]["printed"] == 2


@pytest.mark.long
def test_a_changed_claim_is_exit_status_1_and_names_it(made_up_paper):
    result = run("verify", made_up_paper(recorded="HOLDS"))
    assert result.exit_code == 1
    assert "eq-2: found fails, recorded holds" in result.stderr


@pytest.mark.long
def test_a_check_without_an_answer_is_exit_status_3_whatever_the_others_say(made_up_paper):
    claims = made_up_paper(recorded="HOLDS") / "claims.py"
    claims.write_text(claims.read_text().replace("(Reading((Part(CHECK, pr.RIGHT),)),)", "(Reading((Part(SILENT),)),)"))
    silent = 'SILENT = Check(lambda _: [Case("b", None)], Strength.RATIONAL, "nothing")\nCLAIMS = ('
    claims.write_text(claims.read_text().replace("CLAIMS = (", silent))
    result = run("verify", claims.parent)
    assert result.exit_code == 3
    assert "eq-1: found no answer, recorded holds" in result.stderr
    assert "eq-2: found fails, recorded holds" in result.stderr


@pytest.mark.long
def test_any_folder_is_reproduced_as_a_page_of_its_claims(made_up_paper, tmp_path):
    folder = made_up_paper()
    result = run("reproduce", folder, "--out", tmp_path / "report")
    assert result.exit_code == 0, result.output
    assert {path.name for path in (tmp_path / "report").iterdir()} == {
        "index.html", "numbers.json", "RECORDS.md", "report.md",
    }  # fmt: skip
    page = (tmp_path / "report" / "index.html").read_text()
    assert "The sum is n^2/2." in page
    assert "rival" not in page
    assert "### eq-2" in (tmp_path / "report" / "RECORDS.md").read_text()


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "text", "arguments", "message"),
    [
        ("study.py", "def study():\n    return 1\n", ("reproduce", "--out"), "study returned a int, expected a Study"),
        (
            "erratum.py",
            "def erratum(ledger, version):\n    return lodger\n",
            ("verify", "--erratum"),
            "erratum.py:2: found",
        ),
        ("certificates.py", "def export(paper):\n    return []\n", ("verify", "--certificates"), "expected an Export"),
    ],
)
def test_more_files_of_a_folder_are_used_and_their_mistakes_told(
    made_up_paper, tmp_path, name, text, arguments, message
):
    folder = made_up_paper()
    (folder / name).write_text(text)
    command, option = arguments
    result = run(command, folder, option, tmp_path / "out")
    assert result.exit_code == 2, result.output
    assert message in result.stderr


@pytest.mark.parametrize(("verdict", "status"), [("holds", 0), ("fails", 1), (None, 3)])
def test_reproduce_ends_as_verify_does(monkeypatch, made_up_paper_once, verdict, status):
    ledger = verify(str(made_up_paper_once), workers=1)
    first = replace(ledger.decisions[0], verdict=verdict and Verdict(verdict))
    ledger = replace(ledger, decisions=(first, *ledger.decisions[1:]))
    monkeypatch.setattr("semispline.papers.whole_study.reproduce", lambda *_, **__: ledger)
    assert run("reproduce", "lin2014").exit_code == status


@pytest.mark.parametrize("arguments", [("verify", "nowhere"), ("reproduce", "nowhere")])
def test_an_unknown_paper_is_exit_status_2_on_one_line(arguments):
    result = run(*arguments)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "nowhere" in result.stderr
    assert "lin2014" in result.stderr


def test_an_output_that_cannot_be_written_is_found_before_the_work(made_up_paper, tmp_path):
    result = run("verify", made_up_paper(), "--json", tmp_path / "no" / "l.json")
    assert result.exit_code == 2
    assert "does not exist" in result.stderr
    assert "printed claims" not in result.output


@pytest.mark.long
def test_drafts_are_shown_with_what_they_lack_and_the_others_are_decided(made_up_paper):
    claims = made_up_paper() / "claims.py"
    text = claims.read_text()
    claims.write_text(text.replace('Correction("n(n+1)/2", (Part(CHECK, pr.RIGHT),)),', "None,"))
    result = run("verify", claims.parent)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "eq-2: fails without a correction" in result.stderr
    result = run("verify", claims.parent, "--draft")
    assert result.exit_code == 0, result.output
    for line in (
        "1 printed claims, 1 decided",
        "eq-2 (Section 1): draft, recorded as fails",
        "    0 true, 9 false (exact rational instances, no proof)",
        "    residual of the first: -1/2",
        "  amounts to: fails",
        "  missing: fails without a correction, expected what is true instead, with its check",
        "1 draft, 1 complete",
    ):
        assert line in result.output


@pytest.mark.parametrize("option", ["--json", "--recheck"])
def test_drafts_are_shown_and_nothing_else(made_up_paper_once, option):
    result = run("verify", made_up_paper_once, "--draft", option, "pari")
    assert result.exit_code == 2
    assert f"--draft: found {option} beside it" in result.stderr


@pytest.mark.long
def test_a_mistake_in_a_check_is_exit_status_2_and_no_verdict(made_up_paper):
    claims = made_up_paper() / "claims.py"
    claims.write_text(claims.read_text().replace("residual = (formula", "residual = (formola"))
    result = run("verify", claims.parent)
    assert result.exit_code == 2
    assert f"{claims}:17: found NameError" in result.stderr
    assert "eq-1: found no answer, recorded holds" in result.stderr


def test_the_help_says_that_a_folder_is_run():
    assert "run as Python" in " ".join(run("verify", "--help").output.replace("│", " ").split())


def test_a_broken_record_is_exit_status_2(made_up_paper):
    folder = made_up_paper()
    text = (folder / "claims.py").read_text()
    (folder / "claims.py").write_text(text.replace('"The sum is n^2/2."', '" "'))
    result = run("verify", folder)
    assert result.exit_code == 2
    assert "eq-2" in result.stderr


@pytest.mark.parametrize("name", ["printed.py", "claims.py"])
def test_no_module_of_the_paper_is_overwritten(made_up_paper, tmp_path, name):
    folder = made_up_paper()
    before = (folder / name).read_text()
    (tmp_path / "link").symlink_to(folder / name)
    for option in ("--json", "--markdown"):
        for path in (folder / name, tmp_path / "link"):
            result = run("verify", folder, option, path)
            assert result.exit_code == 2
            assert result.stderr.startswith(f"error: {option}: ")
            assert "give another name" in result.stderr
    assert (folder / name).read_text() == before


def test_a_paper_without_a_text_for_its_reader_is_told_before_it_is_decided(made_up_paper, tmp_path):
    result = run("verify", made_up_paper(), "--erratum", tmp_path / "REPORT.md")
    assert result.exit_code == 2
    assert "found no module erratum" in result.stderr
    assert "n = 1" not in result.stdout
    assert not (tmp_path / "REPORT.md").exists()


def test_record_and_report_are_two_files(made_up_paper, tmp_path):
    result = run("verify", made_up_paper(), "--json", tmp_path / "x", "--markdown", tmp_path / "." / "x")
    assert result.exit_code == 2
    assert "--markdown" in result.stderr
    assert not (tmp_path / "x").exists()
