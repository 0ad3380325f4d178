"""Generated text: means what the expression means, is the same at every run, passes the linter, compiles as C."""

import ctypes
import os
import re
import shutil
import subprocess
import sys
from fractions import Fraction
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sympy import Function, Rational, Symbol, sqrt, symbols

from semispline.derivations.codegen.c_backend import c_function
from semispline.derivations.codegen.catalogue import (
    conditions_routine,
    contact_routine,
    density_routine,
    end_derivative_routine,
    gram_routine,
)
from semispline.derivations.codegen.expressions import expression_text, summands
from semispline.derivations.codegen.python_backends import CASADI, NUMPY, python_text
from semispline.derivations.codegen.routines import Argument, Routine, routine_steps
from semispline.solver.generated import contact_numpy, energy_numpy

ROOT = Path(__file__).parents[2]
LETTERS = symbols("a b h1 H1")


@st.composite
def rational_expressions(draw, depth=4):
    if depth == 0 or draw(st.integers(0, 4)) == 0:
        return draw(st.sampled_from([*LETTERS, Rational(-3), Rational(2, 3), Rational(-1, 7), Rational(5)]))
    left, right = draw(rational_expressions(depth - 1)), draw(rational_expressions(depth - 1))
    kind = draw(st.sampled_from("+-*/^"))
    if kind == "/" and right == 0:
        kind = "+"
    return {
        "+": lambda: left + right,
        "-": lambda: left - right,
        "*": lambda: left * right,
        "/": lambda: left / right,
        "^": lambda: left ** draw(st.integers(1, 3)),
    }[kind]()


@given(rational_expressions(), st.lists(st.fractions(1, 9, max_denominator=7), min_size=4, max_size=4))
def test_text_means_what_the_expression_means(expression, numbers):
    exact = expression.subs(dict(zip(LETTERS, map(Rational, numbers), strict=True)))
    if not exact.is_finite:
        return
    names = {symbol.name: number for symbol, number in zip(LETTERS, numbers, strict=True)}
    text = expression_text(expression)
    # Whole numbers divide exactly as Fractions do, so that the printed line is judged without rounding.
    exactly = eval(_as_fractions(text), {"Fraction": Fraction}, names)
    assert exactly == Fraction(int(exact.p), int(exact.q))
    if expression.is_Add:
        joined = " ".join(summands(expression))
        assert eval(_as_fractions(joined), {"Fraction": Fraction}, names) == exactly
    in_c = eval(expression_text(expression, "c"), {}, {name: float(number) for name, number in names.items()})
    # Floats: a few dozen roundings, on terms that may cancel down to a millionth of their size.
    magnitude = 1 + abs(float(exactly))
    assert in_c == pytest.approx(float(exactly), abs=1e-6 * magnitude, rel=1e-9)
    assert "**" not in expression_text(expression, "c")


def _as_fractions(text):
    return re.sub(r"(?<![\w.*])(\d+)(?!\w)", r"Fraction(\1)", text)


def test_what_is_not_rational_is_refused():
    a = Symbol("a")
    for expression in (sqrt(a), Function("f")(a), a ** Symbol("n")):
        with pytest.raises(ValueError, match="expected a rational expression"):
            expression_text(expression)


def test_a_routine_needs_an_argument_for_each_symbol():
    a, b = symbols("a b")
    with pytest.raises(ValueError, match="f: no argument for the symbol\\(s\\) b"):
        Routine("f", "F.", "none", (Argument("a", "number", "A."),), "block", ((a * b,),), ("r",))


def test_temporaries_never_hide_an_argument():
    x0, b = symbols("x0 b")
    common = (x0 + b) ** 2
    arguments = tuple(Argument(name, "number", "N.") for name in ("x0", "b"))
    routine = Routine("f", "F.", "none", arguments, "matrix", ((common, 1 / common),), ("r",))
    steps = routine_steps(routine)
    assert steps.temporaries
    assert "x0" not in [name for name, _ in steps.temporaries]


def test_committed_files_are_fresh(generated):
    for name, text in generated.items():
        assert (ROOT / "solver" / "generated" / name).read_text(encoding="utf-8") == text, (
            f"{name}: run semispline generate"
        )


@pytest.mark.long
def test_text_is_the_same_for_every_hash_seed(generated, whole):
    script = (
        "from hashlib import sha256; from semispline.derivations.codegen.catalogue import generated_files;"
        "print(sha256(repr(generated_files()).encode()).hexdigest())"
    )
    found = {
        subprocess.run(
            [sys.executable, "-c", script],
            env=os.environ | {"PYTHONHASHSEED": seed},
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in (("0", "1", "20141013") if whole else ("1",))
    }
    # This process has a seed of its own.
    assert found == {sha256(repr(generated).encode()).hexdigest() + "\n"}


def test_headers_name_source_writer_and_operations(generated):
    for name, text in generated.items():
        if name == "__init__.py":
            continue
        header = text.split('"""')[1]
        assert "Written by `semispline generate` from derivations/" in header
        assert "Do not edit" in header
        sources = [line for line in text.splitlines() if line.startswith("    Source: ")]
        counted = sum(int(line.split("Operations: ")[1].rstrip(".")) for line in sources)
        assert len(sources) == text.count("\ndef ") - text.count("\ndef _")
        assert f"Operations: {counted} in {len(sources)} functions." in header


def test_operations_are_counted_on_what_is_printed():
    a, b = symbols("a b")
    arguments = tuple(Argument(name, "number", "N.") for name in ("a", "b"))
    # (a + b) once, its square once, times a: 1 + 1 + 1 operations.
    routine = Routine("f", "F.", "none", arguments, "matrix", (((a + b) ** 2, a * (a + b) ** 2),), ("r",))
    assert routine_steps(routine).operations == 3


@pytest.mark.parametrize("command", [["check"], ["format", "--check"]])
def test_generated_files_pass_the_linter(command):
    run = subprocess.run(
        [sys.executable, "-m", "ruff", *command, "solver/generated"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.parametrize("backend", [NUMPY, CASADI])
def test_text_of_one_function_runs_on_its_own(backend):
    space = {}
    exec(python_text([contact_routine(2, degree=3)], backend), space)
    found = np.array(space["contact_rows_2"](1.25, 0.25, 0.5, 2, 0.5, 1.0))
    np.testing.assert_allclose(found, contact_numpy.contact_rows_2(1.25, 3, 0.25, 0.5, 2, 0.5, 1.0), rtol=1e-14)
    with pytest.raises(ValueError, match="h1"):
        space["contact_rows_2"](1.25, -1, 0.5, 2, 0.5, 1.0)


@pytest.mark.compiler
def test_c_compiles_strictly_and_agrees_with_numpy(tmp_path):
    routines = [
        end_derivative_routine(3),
        contact_routine(2),
        contact_routine(3),
        conditions_routine(),
        density_routine(),
        gram_routine(),
    ]
    source, library = tmp_path / "derived.c", tmp_path / "derived.so"
    prototypes = [c_function(routine).split("\n")[1] + ";" for routine in routines]
    source.write_text("\n".join(prototypes + [c_function(routine) for routine in routines]))
    compiler = shutil.which("cc") or shutil.which("gcc")
    assert compiler is not None, "no C compiler: leave out tests marked compiler"
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1", "-fPIC", "-shared"]
    subprocess.run([compiler, *flags, str(source), "-o", str(library)], check=True)
    code = ctypes.CDLL(str(library))

    # The same operations in the same order; a compiler may only fuse a multiplication with an addition.
    for name, numbers in (
        ("end_derivatives_3", (4.0, 0.25, 0.5, 0.875)),
        ("contact_rows_2", (1.25, 3.0, 0.25, 0.5, 2.0, 0.5, 1.0)),
        ("contact_rows_3", (1.25, 3.0, 0.25, 0.5, 0.75, 2.0, 0.5, 1.0, 1.0)),
    ):
        expected = getattr(contact_numpy, name)(*numbers)
        out = (ctypes.c_double * expected.size)()
        getattr(code, name)(*(ctypes.c_double(x) for x in numbers), out)
        np.testing.assert_allclose(np.array(out).reshape(expected.shape), expected, rtol=1e-13)

    vectors = np.random.default_rng(0).uniform(-1, 1, (5, 3))
    out = (ctypes.c_double * 6)()
    pointers = [(ctypes.c_double * 3)(*vector) for vector in vectors]
    code.contact_derivatives_2(*pointers, *(ctypes.c_double(x) for x in (-1.5, 0.5, 0.25, 2.0)), out)
    expected = contact_numpy.contact_derivatives_2(*vectors, -1.5, 0.5, 0.25, 2.0)
    np.testing.assert_allclose(np.array(out).reshape(2, 3), expected, rtol=1e-13)

    code.thin_plate_density.restype = code.gram_block.restype = ctypes.c_double
    assert code.thin_plate_density(*pointers[:3]) == pytest.approx(
        float(energy_numpy.thin_plate_density(*vectors[:3])), rel=1e-14
    )
    numbers = (2.0, 3.0, 5.0, 7.0, 11.0, 13.0)
    assert code.gram_block(*(ctypes.c_double(x) for x in numbers)) == energy_numpy.gram_block(*numbers)
