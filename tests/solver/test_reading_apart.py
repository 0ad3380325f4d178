"""Each reader of files of other programs in a process of its own; elsewhere in the tests sound files are read here."""

import pickle
import re
from pathlib import Path

import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

import semispline.solver
from helpers.drilled import drilled_part, hole
from helpers.parts import written
from helpers.reading_here import called_here
from semispline import list_edges, list_surfaces, plane, read_surface, resolve_edge, round_edge, write_surface
from semispline.solver.io import foreign, with_surfaces
from semispline.solver.topology import find_places, read_drawn

ROOM = Path(semispline.solver.__file__).parent
CALLED = re.compile(r'"(semispline\.solver\.[\w.]+)"')


def readers():
    """The modules that are called by name."""
    texts = (file.read_text() for room in ("io", "topology") for file in (ROOM / room).glob("*.py"))
    return {name for text in texts if "read_apart" in text for name in CALLED.findall(text)}


@pytest.mark.long
def test_what_a_process_sends_is_what_its_reader_finds(tmp_path, monkeypatch):
    real, called = foreign.call, []

    def both(module, *rest):
        called.append(module)
        apart = real(module, *rest)
        # A 3dm file holds when it was written.
        assert isinstance(apart, bytes) or pickle.dumps(apart) == pickle.dumps(called_here(module, *rest))
        return apart

    monkeypatch.setattr(foreign, "call", both)
    drilled = written(drilled_part("cone"), tmp_path / "drilled.brep")
    box = written(BRepPrimAPI_MakeBox(4, 3, 2).Shape(), tmp_path / "box.brep")
    face, entry = hole(drilled, "cone")
    resolve_edge(f"{drilled}#{face}", entry.name)
    list_edges(drilled, face)
    find_places(box)
    read_drawn([str(drilled)])
    round_edge(box, 0, "e0", distance=0.5, out=tmp_path / "round.brep")
    model = tmp_path / "plane.3dm"
    write_surface(model, plane((0, 0, 0), (1, 0, 0), (0, 1, 0)))
    (tmp_path / "two.3dm").write_bytes(with_surfaces(model, 0, [read_surface(model)]))
    assert len(list_surfaces(tmp_path / "two.3dm")) == 2
    assert set(called) == readers()
