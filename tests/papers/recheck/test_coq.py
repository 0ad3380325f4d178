"""Lemmas for the kernel of Coq: what stands in them, and, where Coq is, what it accepts and what it refuses."""

import re
import subprocess
from dataclasses import replace

import pytest

from helpers.statements import RIGHT, WRONG
from semispline.papers.recheck import Export, Identity, Theory, identity, kernel_checked, require_system
from semispline.papers.recheck.coq_folder import CoqFile, coq_folder, hand_written, imports, needed_sources, write_coq
from semispline.papers.recheck.coq_lemmas import lemma
from semispline.papers.recheck.coqc import REALS, Kernel, assumptions_in
from semispline.papers.recheck.kernel import KernelCheck
from semispline.papers.recheck.roots import NotForCoqError
from semispline.papers.recheck.statements import Certificate, Reading
from semispline.solver.errors import ComputationError, OptionError

WITHOUT = {"matrices", "number", "coefficient"}


def has_lemma(case):
    return case.form not in WITHOUT and not getattr(case, "roots", ())


# What is stated is true, and Coq gets another proof of it.
TRUE_ALL_THE_SAME = {"no kernel", "a minor that is zero", "a pivot", "another triangle"}


def is_refused(name):
    return has_lemma(WRONG[name]) and name not in TRUE_ALL_THE_SAME


def export_of_cases(cases, **rest):
    return Export("p", tuple(Certificate(i, "holds", (Reading((case,)),)) for i, case in cases.items()), **rest)


@pytest.mark.parametrize("name", RIGHT)
def test_each_form_has_a_lemma_or_a_reason(name):
    if has_lemma(RIGHT[name]):
        assert lemma(RIGHT[name]).endswith(" Qed.")
        return
    with pytest.raises(NotForCoqError, match=r"matrices|intervals|power series|a root"):
        lemma(RIGHT[name])


def test_what_differs_is_a_negation_that_its_instance_proves():
    found = lemma(Identity(label="a", left="x^2", right="x", equal=False, variables=("x",), at=(("x", "2"),)))
    stated, proof = found.split("Proof.")
    assert stated.startswith("~ (forall (x : number), x^2 == x)")
    assert "(H (2#1)" in proof


def test_a_statement_that_two_records_have_is_proved_once():
    case = identity("a", "(x + 1)^2", "x^2 + 2*x + 1")
    (file,) = coq_folder(export_of_cases({"eq-1": case, "eq-2": case})).files
    (block,) = file.blocks
    assert [i.partition(":")[0] for i in block.ids] == ["eq-1 #1", "eq-2 #1"]
    assert "; also eq-2 #1 *)" in file.text
    assert file.block_at(file.text.splitlines().index("Proof. rational. Qed.") + 1) is block
    assert file.block_at(len(file.text.splitlines())) is None


def test_an_identity_with_a_denominator_has_numbers_that_fulfil_its_premises():
    (file,) = coq_folder(export_of_cases({"eq-1": identity("a", "x/(x - 1)", "1 + 1/(x - 1)")})).files
    assert [len(block.names) for block in file.blocks] == [2]
    assert "exists (x : number), ~ (x - 1) == 0" in file.text
    assert "pose proof eq_1__1_met." in file.text


def test_counts_and_reasons_of_a_record_that_is_believed_refused_or_left_out():
    cases = {"eq-1": RIGHT["identity"], "eq-2": RIGHT["knots"], "eq-3": RIGHT["number"], "eq-4": RIGHT["a number"]}
    export = export_of_cases(cases, theorems={"proved": ("Sums.x",)}, not_expressible={"eq-5": "no reason"})
    first, second, *others = export.certificates
    export = replace(export, certificates=(replace(first, believed=("proved",)), second, *others))
    check = KernelCheck(export, Kernel("8"), coq_folder(export).without)
    assert check.counts() == {
        "kernel_identities": 1, "kernel_statements": 3, "kernel_checked": 3, "kernel_inexpressible": 2,
    }  # fmt: skip
    assert check.reasons() == {"eq-5": "no reason", "eq-4": "a number of elementary functions, enclosed by intervals"}
    assert check.record("eq-1") == {"whole": True, "inexpressible": "", "theorems": ["Sums.x"]}
    export = replace(export, certificates=(replace(first, believed=("not proved",)), *export.certificates[1:]))
    found = KernelCheck(export, Kernel("8", refused=("eq-2 #1: a",)), coq_folder(export).without)
    assert (found.is_whole("eq-1"), found.is_whole("eq-2"), found.is_whole("eq-3")) == (False, False, True)
    assert found.reasons()["eq-1"] == "believed: not proved"
    assert found.problems == ("recheck: refused by the kernel: eq-2 #1: a",)


@pytest.mark.parametrize(
    ("output", "found"),
    [
        ("Closed under the global context\n", set()),
        ("Axioms:\nA.b : forall x : R,\n  x = x\nc\n  : Prop\n", {"A.b", "c"}),
    ],
)
def test_assumptions_are_read_by_machine(output, found):
    assert assumptions_in(output, "F") == found


@pytest.mark.parametrize("output", ["", "Axioms:\n", "Error\nAxioms:\nc : Prop\n"])
def test_no_answer_to_the_question_for_assumptions_is_an_error(output):
    with pytest.raises(ComputationError, match=r"found no answer to Print Assumptions in F\.v"):
        assumptions_in(output, "F")


def test_without_coq_the_option_is_refused(monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(OptionError, match=r"--recheck coq: found no coqc, expected Coq installed"):
        require_system("coq")


# Sources that are written by hand.
CODE = {name: re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL) for name, text in hand_written().items()}


@pytest.mark.parametrize("name", CODE)
def test_no_source_believes_anything_of_its_own(name):
    assert not re.search(r"\b(Axioms?|Admitted|admit|Parameters?|Conjecture|Abort|give_up)\b", CODE[name])
    depth = 0
    for line in CODE[name].splitlines():
        depth += line.startswith("Section ") - bool(re.match(r"End \w+\.", line))
        # Outside of a section they would be axioms.
        assert depth or not re.match(r"\s*(Variables?|Hypothes[ie]s|Context)\b", line), line
    assert depth == 0


def test_each_theorem_with_hypotheses_has_an_instance():
    """Of sources over numbers each lemma of a statement is one."""
    of_numbers = {"Rational", "Matrices", "Squares"}
    missing = []
    for name in set(CODE) - {"Instances", "Refuted", *of_numbers}:
        for theorem, stated in re.findall(r"(?ms)^(?:Theorem|Corollary) (\w+)(.*?)^Proof", CODE[name]):
            outer = stated if not stated.lstrip().startswith(": ~") else ""
            if "->" in outer and not re.search(rf"\b{theorem}(_met)?\b", hand_written()["Instances"]):
                missing.append(theorem)
    assert missing == []


def test_sources_that_nothing_needs_are_checked_where_theorems_are_cited():
    cited = coq_folder(export_of_cases({}, theorems={"a": ("BSplines.local_support",)}))
    found = list(needed_sources(cited))
    assert set(found) == set(hand_written())
    assert all(found.index(needed) < found.index(name) for name in found for needed in imports(hand_written()[name]))


@pytest.fixture(scope="module")
def kernel(tmp_path_factory):
    """Ask the kernel for everything that is right, and for everything that is wrong, all at once."""
    wrong = {f"wrong {name}": case for name, case in WRONG.items() if is_refused(name)}
    cases = {name: case for name, case in RIGHT.items() if has_lemma(case)}
    export = export_of_cases(cases | wrong, theorems={"a": ("Printed.printed_3_1_refuted", "Surfaces.classical")})
    return kernel_checked(export, tmp_path_factory.mktemp("kernel"))


@pytest.mark.coq
def test_the_kernel_accepts_each_form_and_refuses_what_is_wrong(kernel):
    refused = {name.partition(" #")[0] for name in kernel.kernel.refused}
    assert refused == {f"wrong {name}" for name in WRONG if is_refused(name)}
    assert len(refused) >= 10


@pytest.mark.coq
def test_the_kernel_rests_on_the_axioms_of_the_real_numbers_alone(kernel):
    assert not [problem for problem in kernel.problems if "axiom" in problem]
    assert kernel.kernel.axioms
    assert kernel.kernel.axioms <= REALS


@pytest.mark.coq
@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Axiom trusted : 1 == 2.\nTheorem wrong : 1 == 2.\nProof. exact trusted. Qed.", "found the axiom trusted"),
        ("Theorem wrong : 1 == 2.\nProof. Admitted.", "found the axiom wrong"),
        ("Theorem wrong : 1 == 2.\nProof. reflexivity. Qed.", "refused by the kernel: a title"),
    ],
)
def test_an_axiom_or_a_proof_that_is_none_is_a_problem(text, said):
    theory = Theory("wrong", "a title", ("Rational",), text, over_reals=False)
    (problem,) = kernel_checked(Export("p", (), theories=(theory,))).problems
    assert said in problem


@pytest.mark.coq
def test_the_script_beside_the_files_checks_them_alone(tmp_path):
    file = CoqFile("One", ("Rational",))
    folder = coq_folder(export_of_cases({"eq-1": RIGHT["identity"]}))
    for files, status in ((folder.files, 0), ((*folder.files, replace(file, needed=("Nowhere",))), 1)):
        write_coq(replace(folder, files=files), tmp_path)
        done = subprocess.run(["sh", "check.sh"], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert (done.returncode, "Closed under the global context" in done.stdout) == (status, True)
