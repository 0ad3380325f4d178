"""What an installation brings: one public name, whole, with no claim on the names of a user's files."""

import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HALLS = ("derivations", "papers", "solver")
BUILD = "import sys, setuptools.build_meta as backend; print(getattr(backend, sys.argv[1])(sys.argv[2]))"
NOT_SOURCE = shutil.ignore_patterns(".*", "__pycache__", "build", "dist", "*.egg-info", "node_modules")


def run(*command, cwd, **variables):
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(cwd), **variables}
    done = subprocess.run([*map(str, command)], cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr + done.stdout
    return done.stdout


def build(hook, source, out):
    """Call a hook of the build backend, as pip does, without asking a registry for the backend."""
    return out / run(sys.executable, "-c", BUILD, hook, out, cwd=source).split()[-1]


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """Return a copy of the sources: a build leaves traces."""
    return shutil.copytree(ROOT, tmp_path_factory.mktemp("copy") / "checkout", symlinks=True, ignore=NOT_SOURCE)


@pytest.fixture(scope="module")
def wheel(checkout, tmp_path_factory):
    """Return the wheel that is made of the source distribution, where links have become folders."""
    out = tmp_path_factory.mktemp("built")
    with tarfile.open(build("build_sdist", checkout, out)) as sdist:
        sdist.extractall(out, filter="data")
    (unpacked,) = (path for path in out.iterdir() if path.is_dir())
    return build("build_wheel", unpacked, out)


@pytest.fixture(scope="module", params=["wheel", pytest.param("editable", marks=pytest.mark.slow)])
def programs(request, tmp_path_factory):
    """Return the folder of programs of an environment with this package alone, beside what it depends on."""
    folder = tmp_path_factory.mktemp(request.param)
    if request.param == "wheel":
        built = request.getfixturevalue("wheel")
    else:
        built = build("build_editable", request.getfixturevalue("checkout"), folder)
    venv.create(folder / "env", symlinks=True)
    (site,) = (folder / "env").glob("lib/*/site-packages")
    # A path in a .pth file adds the packages there, and not what their own .pth files add: no editable install of ours.
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib"))
    python = folder / "env" / "bin" / "python"
    pip = (sys.executable, "-m", "pip", "--python", python, "--disable-pip-version-check")
    run(*pip, "install", "--no-deps", "--no-index", "--quiet", built, cwd=folder)
    return python.parent


@pytest.mark.long
def test_a_wheel_from_the_source_distribution_is_whole_and_has_one_name_at_the_top(wheel, checkout):
    files = [path for hall in HALLS for path in (checkout / hall).rglob("*") if path.is_file()]
    expected = {f"semispline/{path.relative_to(checkout).as_posix()}" for path in files}
    expected |= {f"semispline/{name}" for name in ("__init__.py", "__init__.pyi", "py.typed")}
    with zipfile.ZipFile(wheel) as archive:
        found = {name for name in archive.namelist() if not name.partition("/")[0].endswith(".dist-info")}
    assert found == expected
    assert {Path(name).suffix for name in expected} >= {".py", ".pyi", ".json", ".md", ".css", ".js", ".typed"}


@pytest.mark.long
@pytest.mark.parametrize("hall", HALLS)
def test_no_hall_answers_to_its_bare_name(programs, hall, tmp_path):
    code = f"try: import {hall}\nexcept ModuleNotFoundError as error: print(error)"
    said = run(programs / "python", "-c", code, cwd=tmp_path)
    assert said.strip() == f"No module named '{hall}'"


@pytest.mark.slow
def test_beside_files_of_the_user_that_have_the_names_of_the_halls(programs, tmp_path):
    (tmp_path / "solver.py").write_text("OWNER = 'user'")
    for package in ("papers", "derivations"):
        (tmp_path / package).mkdir()
        (tmp_path / package / "__init__.py").write_text("OWNER = 'user'")
    (tmp_path / "script.py").write_text(
        "import solver, papers, derivations\n"
        "from semispline import plane, write_surface\n"
        "write_surface('floor.json', plane([0, 0, 0], [2, 0, 0], [0, 1, 0]))\n"
        "print(solver.OWNER, papers.OWNER, derivations.OWNER, solver.__file__)\n"
    )
    said = run(programs / "python", "script.py", cwd=tmp_path)
    assert said.split() == ["user", "user", "user", str(tmp_path / "solver.py")]

    beside = {"PYTHONPATH": str(tmp_path)}
    run(programs / "semispline", "convert", "floor.json", "floor.step", cwd=tmp_path, **beside)
    # STEP is read in a process of its own, which must find its module too.
    assert "2 x 2" in run(programs / "semispline", "list", "floor.step", cwd=tmp_path, **beside)
    assert "P_{u}" in run(
        programs / "semispline", "derive", "contact-conditions", "--form", "latex", cwd=tmp_path, **beside
    )
