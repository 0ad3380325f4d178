"""The rooms: who may import whom and by which door, one public name, and what loads when."""

import ast
import importlib
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

import semispline

ROOT = Path(__file__).parents[1]
HALLS = ("derivations", "papers", "solver")
# Not installed everywhere or not on every system, so their imports may stand where they are used.
EXTRAS = ("OCP", "cypari", "fcntl", "pyvista", "resource", "rhino3dm", "smlibpy", "vtkmodules")


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


@cache
def all_imports():
    """(importing module, module, imported name or None) of each import; not made at collection."""
    return [(name, *found) for name in FILES for found in imports(name)]


def within(name, room):
    return f"{name}.".startswith(f"{room}.")


# What a docstring says of all imports inside a function, or inside the functions of a file.
WAITS_INSIDE = re.compile(r"\bwaits?\s+inside\s+the\s+functions?\b")


def unexplained_imports(text):
    """Imports inside functions of what is always there, where no one says why they wait.

    It is said by a comment right above (or above the imports right above), or by a docstring: "wait inside the
    functions".
    """
    tree, lines = ast.parse(text), text.splitlines()
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        said = any(WAITS_INSIDE.search(ast.get_docstring(place) or "") for place in (tree, function))
        for node in ast.walk(function):
            if not isinstance(node, ast.Import | ast.ImportFrom) or said:
                continue
            above = node.lineno - 2
            while re.match(r"\s*(from|import)\b", lines[above]):
                above -= 1
            comment = ""
            while re.match(r"\s*#", lines[above]):
                comment = lines[above] + comment
                above -= 1
            top = (node.module if isinstance(node, ast.ImportFrom) else node.names[0].name).partition(".")[0]
            if top not in EXTRAS and not re.search(r"\bwaits?\b", comment, re.IGNORECASE):
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
    assert ("semispline.solver.blending.pipeline", "semispline.solver.judge", "Base") in all_imports()


@pytest.mark.long
def test_imports_inside_functions_say_why_they_wait():
    # None avoids a circle: the table counts them too.
    texts = {name: path.read_text("utf-8") for name, path in FILES.items()}
    assert {name: found for name, text in texts.items() if (found := list(unexplained_imports(text)))} == {}


def of_file(*, docstring="", of_function="", above="", between="", below=""):
    return f'"""A file. {docstring}"""\n\n\ndef f():\n    """Do it. {of_function}"""\n' + "".join(
        f"    {line}\n" for line in (above, "import os", between, "import scipy.linalg", below) if line
    )


@pytest.mark.parametrize(
    ("text", "unexplained"),
    [
        (of_file(), 2),
        (of_file(docstring="A worker waits for its parent."), 2),
        (of_file(of_function="`closed` waits for that."), 2),
        (of_file(docstring="Heavy imports wait inside the functions."), 0),
        (of_file(of_function="The kernel waits inside the function."), 0),
        (of_file(above="# SciPy waits until it is needed."), 0),
        (of_file(above="x = 1  # waits"), 2),
        (of_file(between="# SciPy waits until it is needed."), 1),
        (of_file(above="# SciPy waits until it is needed.", between="x = 1"), 1),
        (of_file(below="# Waits."), 2),
        (of_file().replace("os", "OCP"), 1),
    ],
)
def test_the_reason_stands_beside_the_import_or_speaks_of_imports(text, unexplained):
    assert len(list(unexplained_imports(text))) == unexplained


@pytest.mark.parametrize("face", FACES)
def test_other_rooms_enter_by_the_face_and_the_room_itself_does_not(face):
    modules = {name for name in FILES if within(name, face)} - {face}
    # What `from face import name` means would depend on what was loaded before.
    assert [what for _, what in stub_entries(face) if f"{face}.{what}" in modules] == [], "named like a module"
    past = [
        (name, source, what)
        for name, source, what in all_imports()
        if not within(name, face) and (source in modules or (source == face and f"{source}.{what}" in modules))
    ]
    assert past == [], "import from the face"
    round_about = [(name, what) for name, source, what in all_imports() if within(name, face) and source == face]
    assert round_about == [], "inside a room import the module"


def for_authors():
    """(room, name) of each name that the page for authors of papers tells them to import."""
    page = (ROOT / "docs" / "your-own-paper.md").read_text("utf-8")
    lines = re.findall(r"(?m)^    from (semispline\.[\w.]+) import (.*)$", page)
    return {(room, name.strip()) for room, names in lines for name in names.split(",")}


@pytest.mark.long
@pytest.mark.parametrize("face", FACES)
def test_each_name_of_a_face_exists_and_is_used(face):
    public = set(stub_entries("semispline"))
    asked_for = {what for name, source, what in all_imports() if source == face}
    asked_for |= {name for room, name in for_authors() if room == face}
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


@pytest.mark.long
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


@pytest.mark.long
def test_processes_that_read_files_load_no_scipy():
    """They start for every file; the kernel, which takes a second itself, is left out here."""
    workers = [path for path in (ROOT / "solver").rglob("*.py") if re.search(r"^def work\(", path.read_text(), re.M)]
    names = [module_name(path) for path in workers]
    assert len(names) >= 5
    modules = loaded(f"import sys, types\nsys.modules['OCP'] = types.ModuleType('OCP')\nimport {', '.join(names)}")
    assert modules & {"scipy", "casadi", "sympy"} == set()
