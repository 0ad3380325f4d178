"""What `make test-kernels` runs: kernels that the processor has, each once; tests in an order that can be repeated."""

import subprocess
import sys
from itertools import groupby
from pathlib import Path

import pytest

from kernels import NEEDS, runs, supported

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize(
    ("flags", "names"),
    [
        ("fpu sse2 pni ssse3 avx", ["Prescott"]),
        ("fpu pni avx avx2 fma", ["Prescott", "Haswell", "Zen"]),
        ("pni avx2 fma avx512f", ["Prescott", "Haswell", "Zen"]),
        ("pni avx2 fma avx512f avx512cd avx512bw avx512dq avx512vl", list(NEEDS)),
    ],
)
def test_kernels_that_a_processor_has(flags, names):
    assert supported(f"processor\t: 0\nflags\t\t: {flags}\nbugs\t: pni\n\nprocessor\t: 1\nflags\t: x\n") == names


def test_a_processor_that_says_nothing_has_only_the_default():
    assert supported("processor : 0\nFeatures : fp asimd\n") == []


def test_each_kernel_is_run_once_and_numpy_is_held_to_it():
    kernel_of = {None: "SkylakeX", "Prescott": "Katmai", "Haswell": "Haswell", "Zen": "Haswell", "SkylakeX": "SkylakeX"}

    def probe(settings):
        return [f"openblas {kernel_of[settings.get('OPENBLAS_CORETYPE')]}"], ["X86_V3", "X86_V4", "AVX512_ICL"]

    assert runs(list(NEEDS), probe) == [
        ({}, ["openblas SkylakeX"]),
        (
            {
                "OPENBLAS_CORETYPE": "Prescott",
                "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL",
                "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4",
            },
            ["openblas Katmai"],
        ),
        ({"OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL"}, ["openblas Haswell"]),
    ]


def collected(*options):
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", *options]
    files = [f"tests/solver/splines/test_{name}.py" for name in ("knots", "operations", "derivative_jumps")]
    run = subprocess.run([*command, *files], cwd=ROOT, capture_output=True, text=True, check=True)
    return [line for line in run.stdout.splitlines() if "::" in line]


@pytest.mark.slow
def test_the_order_of_tests_follows_from_its_seed():
    plain, one, again, other = (
        collected(*options) for options in ((), ("--order-seed=1",), ("--order-seed=1",), ("--order-seed=2",))
    )
    assert len(plain) > 10
    assert one == again
    assert sorted(one) == sorted(other) == sorted(plain)
    assert plain not in (one, other)
    assert one != other
    # Files in another order, each in one piece.
    files = [[file for file, _ in groupby(line.partition("::")[0] for line in lines)] for lines in (plain, one, other)]
    assert [len(each) for each in files] == [3, 3, 3]
    assert files[1] != files[0]
