"""The faces of the rooms. A name that is also a file gives the function or the file, by what was imported first."""

from pathlib import Path

import pytest

import semispline.papers

FACES = sorted(Path(semispline.papers.__file__).parent.rglob("__init__.pyi"))


@pytest.mark.parametrize("face", FACES, ids=lambda face: face.parent.name)
def test_no_name_of_a_face_is_that_of_a_file(face):
    names = {line.split()[-1] for line in face.read_text().splitlines() if line.startswith("from ")}
    assert names
    assert not names & {path.stem for path in face.parent.iterdir()}
