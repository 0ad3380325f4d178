"""The rooms: who may import whom and by which door, one public name, and what loads when."""

import ast
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest
from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

import semispline

ROOT = Path(__file__).parents[1]
HALLS = ("derivations", "papers", "solver")
# Not installed everywhere or not on every system, so their imports may stand where they are used.
EXTRAS = ("OCP", "fcntl", "pyvista", "resource", "rhino3dm", "smlibpy", "vtkmodules")


def module_name(path):
    parts = ("semispline", *path.relative_to(ROOT).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_name(path): path for hall in HALLS for path in sorted((ROOT / hall).rglob("*.py"))}
# The rooms whose `__init__` is a lazy face.
FACES = [name for name, path in FILES.items() if path.match("__init__.py") and "lazy_loader" in path.read_text("utf-8")]


def imports(name):
    """(module, imported name or None) of each import of a module, wherever it stands."""
    package = name if FILES[name].name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(ast.parse(FILES[name].read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((alias.name, None) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            source = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            yield from ((source, alias.name) for alias in node.names)


IMPORTS = [(name, *found) for name in FILES for found in imports(name)]


def within(name, room):
    return f"{name}.".startswith(f"{room}.")


def unexplained_imports(name):
    """Imports inside functions of what is always there, where no one says why they wait."""
    text = FILES[name].read_text("utf-8")
    tree = ast.parse(text)
    if re.search(r"\bwaits?\b", ast.get_docstring(tree) or ""):
        return
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        said = re.search(r"# [^\n]*\bwaits?\b", ast.get_source_segment(text, function), re.IGNORECASE)
        for node in ast.walk(function):
            if isinstance(node, ast.Import | ast.ImportFrom) and not said:
                top = (node.module if isinstance(node, ast.ImportFrom) else node.names[0].name).partition(".")[0]
                if top not in EXTRAS:
                    yield ast.get_source_segment(text, node)


def stub_entries(package):
    """(module, name) of each line of a stub."""
    tree = ast.parse((ROOT.joinpath(*package.split(".")) / "__init__.pyi").read_text("utf-8"))
    lines = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    return [(f"{package}.{node.module}", alias.name) for node in lines for alias in node.names]


def test_imports_run_one_way(capsys):
    # The table is `[tool.importlinter]` in pyproject.toml.
    status = lint_imports(config_filename=str(ROOT / "pyproject.toml"), no_cache=True)
    assert status == EXIT_STATUS_SUCCESS, capsys.readouterr().out


def test_the_files_of_each_hall_are_seen():
    assert {name.split(".")[1] for name in FILES} == set(HALLS)
    assert {"semispline.solver.judge", "semispline.solver.blending", "semispline.papers.ledger"} <= set(FACES)
    assert ("semispline.solver.blending.pipeline", "semispline.solver.judge", "Base") in IMPORTS


def test_imports_inside_functions_say_why_they_wait():
    # None avoids a circle: the table counts them too.
    assert {name: found for name in FILES if (found := list(unexplained_imports(name)))} == {}


@pytest.mark.parametrize("face", FACES)
def test_other_rooms_enter_by_the_face_and_the_room_itself_does_not(face):
    modules = {name for name in FILES if within(name, face)} - {face}
    # What `from face import name` means would depend on what was loaded before.
    assert [what for _, what in stub_entries(face) if f"{face}.{what}" in modules] == [], "named like a module"
    past = [
        (name, source, what)
        for name, source, what in IMPORTS
        if not within(name, face) and (source in modules or (source == face and f"{source}.{what}" in modules))
    ]
    assert past == [], "import from the face"
    round_about = [(name, what) for name, source, what in IMPORTS if within(name, face) and source == face]
    assert round_about == [], "inside a room import the module"


@pytest.mark.parametrize("face", FACES)
def test_each_name_of_a_face_exists_and_is_used(face):
    public = set(stub_entries("semispline"))
    asked_for = {what for name, source, what in IMPORTS if source == face}
    entries = stub_entries(face)
    assert [e for e in entries if not hasattr(importlib.import_module(e[0]), e[1])] == []
    assert [e for e in entries if e[1] not in asked_for and e not in public] == [], "no other room asks for it"
    assert asked_for <= {what for _, what in entries}


def test_each_public_name_is_there():
    assert sorted(name for _, name in stub_entries("semispline")) == sorted(semispline.__all__)
    for module, name in stub_entries("semispline"):
        assert getattr(semispline, name) is getattr(importlib.import_module(module), name)


def loaded(script):
    code = f"{script}\nimport sys\nprint(*sorted({{'.'.join(name.split('.')[:2]) for name in sys.modules}}))"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_the_public_name_alone_loads_nothing_heavy():
    heavy = {"numpy", "scipy", "casadi", "sympy", "typer", "semispline.solver", "semispline.papers"}
    assert loaded("import semispline; semispline.__all__; dir(semispline)") & heavy == set()


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
