"""The rooms: who may import whom, one public name, and what loads when."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def loaded(script):
    code = f"{script}\nimport sys\nprint(*sorted({{'.'.join(name.split('.')[:2]) for name in sys.modules}}))"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_solver_with_all_its_generated_code_loads_no_sympy():
    modules = loaded(
        "import pkgutil, importlib, semispline, semispline.solver.generated as generated\n"
        "for m in pkgutil.iter_modules(generated.__path__): importlib.import_module(f'{generated.__name__}.{m.name}')\n"
        "for name in semispline.__all__: getattr(semispline, name)"
    )
    assert {"semispline.solver", "casadi", "numpy"} <= modules
    assert modules & {"sympy", "semispline.derivations", "semispline.papers"} == set()


def test_help_of_the_commands_loads_no_sympy():
    modules = loaded("import semispline.derivations.cli")
    assert "typer" in modules
    assert modules & {"sympy", "numpy", "casadi"} == set()
