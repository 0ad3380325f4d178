"""Run the tests whose numbers depend on it under other kernels of OpenBLAS, in another order and with other hashes.

`python tests/kernels.py` takes each kernel that the processor has and that this OpenBLAS was built with, once, and
`python tests/kernels.py another` one that is not the default. The loops of NumPy and the functions of the C library are
held to what such a processor has.
A line at the start of each run repeats it.
"""

import json
import os
import secrets
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]

# All of what computes in floating point, and nothing that takes minutes: no ledger, no pictures of a report.
TESTS = (
    "tests/solver",
    "tests/papers/baselines",
    "tests/papers/lin2014/test_baselines_section5.py",
    "tests/papers/reproduction/test_measures.py",
)
LEFT_OUT = "compiler or browser or slow"

# What /proc/cpuinfo of Linux calls what a kernel's code needs.
NEEDS = {
    "Prescott": {"pni"},
    "Haswell": {"avx2", "fma"},
    "Zen": {"avx2", "fma"},
    "SkylakeX": {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"},
}

# What processors of a kind lack: as NumPy calls its loops for it (beginnings of names), and as the C library calls it,
# whose sin, exp or pow differ in the last bit without.
LOOPS = {"Prescott": ("",), "Haswell": ("X86_V4", "AVX512"), "Zen": ("X86_V4", "AVX512"), "SkylakeX": ()}
GLIBC = {"Prescott": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4"}

PROBE = """
import json, numpy, scipy.linalg
from numpy._core import _multiarray_umath as umath
from threadpoolctl import threadpool_info
blas = sorted({f"{pool['internal_api']} {pool.get('architecture')}" for pool in threadpool_info()})
print(json.dumps([blas, [name for name in umath.__cpu_dispatch__ if umath.__cpu_features__[name]]]))
"""


def supported(cpuinfo):
    """Return the names of the kernels whose instructions the first processor of /proc/cpuinfo has."""
    flags = next(
        (set(line.partition(":")[2].split()) for line in cpuinfo.splitlines() if line.startswith("flags")), set()
    )
    return [name for name, needs in NEEDS.items() if needs <= flags]


def probed(settings):
    """Return the kernels that NumPy and SciPy take in a process with these settings, and the loops that NumPy has."""
    command = [sys.executable, "-c", PROBE]
    said = subprocess.run(command, env=os.environ | settings, capture_output=True, text=True, check=True).stdout
    return json.loads(said)


def runs(names, probe=probed):
    """Return (settings, kernels) for the default, then for each name that is a kernel of its own to this OpenBLAS."""
    default, loops = probe({})
    found = [({}, default)]
    for name in names:
        without = " ".join(loop for loop in loops if loop.startswith(LOOPS[name]))
        all_settings = {
            "OPENBLAS_CORETYPE": name,
            "NPY_DISABLE_CPU_FEATURES": without,
            "GLIBC_TUNABLES": GLIBC.get(name),
        }
        settings = {variable: value for variable, value in all_settings.items() if value}
        kernels, _ = probe(settings)
        if kernels not in [known for _, known in found]:
            found.append((settings, kernels))
    return found


def run(settings, kernels):
    """Run the tests, and return the exit status of pytest."""
    seed = secrets.randbelow(2**16)
    settings = settings | {"PYTHONHASHSEED": str(seed)}
    arguments = ["-m", "pytest", "--quiet", "-n", "2", "-m", f"not ({LEFT_OUT})", f"--order-seed={seed}", *TESTS]
    setting = " ".join(f"{name}='{value}'" for name, value in settings.items())
    words = " ".join(f"'{word}'" if " " in word else word for word in arguments)
    print(f"{', '.join(kernels)}; again: {setting} python {words}", flush=True)
    return subprocess.run([sys.executable, *arguments], cwd=ROOT, env=os.environ | settings, check=False).returncode


def main(which=None):
    """Run all kernels, or any one that is not the default; where there is no other, the default is run."""
    cpuinfo = Path("/proc/cpuinfo")
    found = runs(supported(cpuinfo.read_text(encoding="utf-8")) if cpuinfo.exists() else [])
    chosen = [secrets.choice(found[1:] or found)] if which == "another" else found
    failed = [kernels for settings, kernels in chosen if run(settings, kernels) != 0]
    for kernels in failed:
        print(f"failed: {', '.join(kernels)}")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
