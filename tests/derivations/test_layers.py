"""Who may import whom: the oracle shares no code with what it judges, and the solver does not pay for SymPy."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def imported(package):
    """Top-level names that the modules of a package import, wherever in the file."""
    names = {}
    for path in sorted((ROOT / package).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                found = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{path}: relative import"
                found = [node.module]
            else:
                continue
            for name in found:
                names.setdefault(name.split(".")[0], []).append(str(path.relative_to(ROOT)))
    return names


@pytest.mark.parametrize(
    ("package", "forbidden"),
    [("derivations", {"solver", "papers", "casadi"}), ("solver", {"derivations", "papers", "sympy"})],
)
def test_no_module_imports_what_its_layer_may_not(package, forbidden):
    names = imported(package)
    assert {name: names[name] for name in forbidden & set(names)} == {}


def loaded(script):
    code = f"{script}\nimport sys\nprint(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_solver_with_all_its_generated_code_loads_no_sympy():
    modules = loaded(
        "import pkgutil, importlib, solver, solver.generated as generated\n"
        "for m in pkgutil.iter_modules(generated.__path__): importlib.import_module(f'solver.generated.{m.name}')\n"
        "for name in solver.__all__: getattr(solver, name)"
    )
    assert {"solver", "casadi", "numpy"} <= modules
    assert modules & {"sympy", "derivations", "papers"} == set()


def test_help_of_the_commands_loads_no_sympy():
    modules = loaded("import derivations.cli")
    assert "typer" in modules
    assert modules & {"sympy", "numpy", "casadi"} == set()
