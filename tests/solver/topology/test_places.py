"""What is said of places: repeats, scores, commands, words, JSON."""

import json
import shlex
from dataclasses import replace
from math import prod

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeSphere,
)
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from typer.testing import CliRunner

from helpers.parts import compound, graph_of, moved, rounded_box, without, written
from helpers.random_parts import known_part
from helpers.solids import cut
from semispline import FileError, find_places
from semispline.solver.cli import app
from semispline.solver.topology.clearance import clearance
from semispline.solver.topology.commands import two_faces
from semispline.solver.topology.listing import place_lines, places_record
from semispline.solver.topology.place import KINDS
from semispline.solver.topology.places import places_of


def prism(corners, height):
    """A prism over a polygon in z = 0."""
    polygon = BRepBuilderAPI_MakePolygon()
    for x, y in corners:
        polygon.Add(gp_Pnt(x, y, 0.0))
    polygon.Close()
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, 0, height)).Shape()


def test_places_of_a_box_with_rounds():
    places = places_of(graph_of(rounded_box()))
    assert [(x.kind, len(x.faces), 1 + len(x.repeats)) for x in places.found] == [
        ("fillet", 1, 2),
        ("fillet", 1, 2),
        ("fillet", 1, 4),
        ("fillet", 1, 4),
        ("chain", 8, 1),
        ("sharp edge", 0, 2),
        ("sharp edge", 0, 2),
        ("sharp edge", 0, 4),
    ]
    assert places.faces == 18
    assert (places.refused, places.counts, places.unwalked) == ({}, {}, ())
    (chain,) = places.of_kind("chain")
    assert len(chain.commands) == 1
    assert chain.measures["length"] == pytest.approx(2 * (34 + 24) + 2 * 3.1416 * (3 + 1.5) / 2, rel=0.01)


@pytest.mark.long
def test_a_part_twice_gives_its_places_once():
    shift = gp_Trsf()
    shift.SetTranslation(gp_Vec(100, 0, 0))
    one, two = rounded_box(), moved(rounded_box(), shift)
    single, double = places_of(graph_of(one)), places_of(graph_of(compound([one, two])))
    assert len(double.found) == len(single.found)
    assert [1 + len(x.repeats) for x in double.found] == [2 * (1 + len(x.repeats)) for x in single.found]


@pytest.mark.parametrize("make", [rounded_box, lambda: known_part(3).shape, lambda: without(rounded_box(), 2)])
def test_scores_are_products_and_the_best_comes_first(make):
    places = places_of(graph_of(make()))
    assert places.found
    for place in places.found:
        assert place.score == pytest.approx(prod(place.parts.values()))
        assert 0 < place.score <= 1
    ranks = [(KINDS.index(place.kind), -round(place.score, 6)) for place in places.found]
    assert ranks == sorted(ranks)


@pytest.mark.parametrize("name", ["part.brep", "my part.brep", "it's $HOME; `x`.brep", "-o.brep"])
def test_commands_name_file_and_edges_for_a_shell(name):
    graph = graph_of(without(rounded_box(), 2), path=name)
    places = places_of(graph)
    for place in places.found:
        for command in place.commands:
            words = shlex.split(command)
            assert words[:2] == ["semispline", "blend"]
            assert words[-2] == "-o"
            path = f"./{name}" if name.startswith("-") else name
            if place.faces and words[3] != "--replace":
                # A chain that ends where a face was taken out: between its edges, no solid comes back.
                assert words[2:4] == [path, path]
                continue
            if place.faces:
                if place.kind == "chain" and words[3] == path:
                    # It ends where no face is, and comes as a surface: words say the faces.
                    assert words[2:5:2] == [path, "--edge-a"]
                    continue
                assert words[2:4] == [path, "--replace"]
                numbers = {int(word) for word in words[4].split(",")}
                # The chain that a fillet belongs to goes with it.
                assert numbers >= set(place.faces)
                continue
            if "--round" in words:
                assert words[2:5] == [path, "--round", f"{place.a.face}:{place.a.edge}"]
                continue
            assert words[2:4] == [f"{path}#{place.a.face}", f"{path}#{place.b.face}"]
            for side, option in ((place.a, "--edge-a"), (place.b, "--edge-b")):
                edge = words[words.index(option) + 1]
                assert edge == side.edge
                assert int(edge[1:]) in graph.uses.number[graph.uses.of_face(side.face)]
    assert {place.kind for place in places.found} >= {"fillet", "gap", "sharp edge"}


def sheets_with_broken_edges(cuts_a, cuts_b):
    """Two sheets 10 long that face each other over 2, their edges broken at cuts along y."""
    faces = []
    for x, far, cuts in ((0, -8, cuts_a), (2, 10, cuts_b)):
        polygon = BRepBuilderAPI_MakePolygon()
        for y in (0, *cuts, 10):
            polygon.Add(gp_Pnt(x, y, 0))
        polygon.Add(gp_Pnt(far, 10, 0))
        polygon.Add(gp_Pnt(far, 0, 0))
        polygon.Close()
        faces.append(BRepBuilderAPI_MakeFace(polygon.Wire()).Face())
    return compound(faces)


def facing(graph, command):
    """The middles along y of the edges that a command names, and the file that it writes."""
    words = shlex.split(command)
    found = []
    for spec, option in ((words[2], "--edge-a"), (words[3], "--edge-b")):
        rows = graph.uses.of_face(int(spec.partition("#")[2]))
        found.append(graph.uses.points[rows.start + int(words[words.index(option) + 1][1:]), 4, 1])
    return (*found, words[-1])


def test_of_a_gap_with_several_edges_each_is_named_with_the_one_that_faces_it():
    graph = graph_of(sheets_with_broken_edges((1, 6), (1.2, 5.8)))
    place = next(place for place in places_of(graph).of_kind("gap") if place.measures["length"] == pytest.approx(10))
    assert [word for word in shlex.split(place.commands[0]) if "*" in word] == ["0:e0*", "1:e0*"]
    # Where they are no chain each edge has its own command.
    found = [facing(graph, command) for command in two_faces("part.brep", place)]
    assert [(round(a, 6), round(b, 6)) for a, b, _ in found] in (
        [(3.5, 3.5), (8, 7.9), (0.5, 0.6)],
        [(3.5, 3.5), (7.9, 8), (0.6, 0.5)],
    )
    assert len({out for *_, out in found}) == 3
    assert not any("#" in line and "one edge of several" in line for line in place_lines(places_of(graph)))


def test_of_a_gap_with_other_numbers_of_edges_one_pair_is_named_and_the_rest_said():
    graph = graph_of(sheets_with_broken_edges((1, 6), (4.5,)))
    places = places_of(graph)
    place = next(place for place in places.of_kind("gap") if place.measures["length"] == pytest.approx(10))
    assert [word for word in shlex.split(place.commands[0]) if "*" in word] == ["0:e0*", "1:e0*"]
    assert not any("one edge of several" in line for line in place_lines(places))
    # Where they are no chain the longest of the three faces the shorter one of the two.
    plain = replace(place, commands=tuple(two_faces("part.brep", place)))
    ((a, b, _),) = (facing(graph, command) for command in plain.commands)
    assert sorted([round(a, 6), round(b, 6)]) == [2.25, 3.5]
    lines = place_lines(replace(places, found=(plain,)))
    said = [line for line in lines if line.startswith("    # one edge of several: side ")]
    assert len(said) == 2
    assert sum(line.count(" e") - line.count(" edge") for line in said) == 3


def test_a_sharp_edge_is_cut_by_less_than_the_face_has():
    for place in places_of(graph_of(BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape())).found:
        words = shlex.split(place.commands[0])
        distance = float(words[words.index("--distance") + 1])
        # A third of the nearest edge that does not touch it: of the smaller of two sides of the box.
        assert 0.3 * place.measures["clearance"] < distance <= place.measures["clearance"] / 3
        assert place.measures["clearance"] in (pytest.approx(2.0), pytest.approx(3.0))


@pytest.mark.long
@pytest.mark.parametrize(
    ("shape", "reached"),
    [
        # The rims of a tall pin: into the disc no further than its radius.
        (BRepPrimAPI_MakeCylinder(3.0, 60.0).Shape(), {3.0}),
        # A prism of triangles 6 wide and 4 high: from the base the two other sides leave nothing at 4, from these, of
        # length 5, at 24 / 5; the square sides are 20 long.
        (prism([(0, 0), (6, 0), (3, 4)], 20.0), {4.0, 4.8, 5.0, 6.0}),
    ],
    ids=["pin", "prism"],
)
def test_the_clearance_of_sharp_edges_is_that_within_their_faces(tmp_path, shape, reached):
    path = written(shape, tmp_path / "part.brep")
    for place in find_places(path).of_kind("sharp edge"):
        # Nine samples, 5 / 8 apart, stand beside the foot of the apex: they see it too near by 4.8 / 1.4 times that at
        # the most.
        assert any(x - 5 / 16 * 4.8 / 1.4 <= place.measures["clearance"] <= x * (1 + 1e-9) for x in reached)


@pytest.mark.parametrize("seam", [180.0, 25.0])
def test_the_clearance_of_a_hole_does_not_end_at_a_seam(seam):
    """A hole of radius 1 in a pin of radius 5: half way round to itself, less than half of its height."""
    t = np.radians(seam)
    axes = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), gp_Dir(np.cos(t), np.sin(t), 0))
    drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 30), gp_Dir(1, 0, 0)), 1.0, 50.0).Shape()
    graph = graph_of(cut(BRepPrimAPI_MakeCylinder(axes, 5.0, 60.0).Shape(), drill))
    uses = graph.uses
    row = next(x for x in range(len(uses)) if uses.wire[x] and graph.faces.kind[uses.face[x]] == "cylinder")
    # Of 33 samples round the hole two need not be its outermost ones.
    assert clearance(graph, row) == pytest.approx(5 * np.pi - 5 * np.arcsin(0.2), abs=0.05)


@pytest.mark.long
def test_the_command_of_the_rim_of_a_tall_pin_stays_within_its_disc(tmp_path):
    place = find_places(written(BRepPrimAPI_MakeCylinder(3.0, 60.0).Shape(), tmp_path / "pin.brep")).found[0]
    words = shlex.split(place.commands[0])
    distance = float(words[words.index("--distance") + 1])
    # A third of the radius, rounded down to two digits.
    assert 0.9 < distance <= 1.0


@pytest.mark.long
def test_nothing_found_says_what_was_refused(tmp_path):
    path = written(BRepPrimAPI_MakeSphere(2.0).Shape(), tmp_path / "ball.brep")
    done = CliRunner().invoke(app, ["list", str(path), "--pairs"])
    assert done.exit_code == 0
    assert done.output == (
        "no place found in 1 faces (3 edges): 1 no smooth opposite sides; "
        "`semispline list FILE --edges K` lists the edges of a face\n"
    )


@pytest.mark.long
def test_the_command_prints_and_writes_all_of_it(tmp_path):
    path, target = written(rounded_box(), tmp_path / "part.brep"), tmp_path / "places.json"
    done = CliRunner().invoke(app, ["list", str(path), "--pairs", "--json", str(target)])
    assert done.exit_code == 0
    places = find_places(path)
    assert done.output.splitlines() == list(place_lines(places))
    for place in places.found:
        assert all(f"    {command}" in done.output.splitlines() for command in place.commands)
    record = json.loads(target.read_text())
    assert record.pop("format") == "semispline/1"
    assert record.pop("kind") == "place_list"
    assert record == json.loads(json.dumps(places_record(places)))
    first = record["places"][0]
    assert first["kind"] == "fillet"
    assert first["times"] == 2
    assert first["score"] == pytest.approx(prod(first["parts"].values()))
    assert first["command"] == first["commands"][0]
    alone = CliRunner().invoke(app, ["list", str(path), "--pairs", "--json", "-"])
    assert json.loads(alone.output)["places"] == record["places"]


@pytest.mark.long
def test_faces_that_are_refused_say_why(shared):
    places = find_places(shared / "data/cad/demos_as1_pe_203.stp")
    assert set(places.refused.values()) == {"turns by 180 degrees: a round end"}
    assert sum(1 + len(place.repeats) for place in places.of_kind("round end")) == 70
    assert any("70 round ends" in line for line in place_lines(places))


def test_other_formats_are_refused(tmp_path):
    path = tmp_path / "part.stl"
    path.write_text("")
    with pytest.raises(FileError, match=r"'\.stl', expected one of \.step .* \.3dm"):
        find_places(path)


@pytest.mark.long
def test_a_file_without_faces_says_what_it_holds(tmp_path):
    from helpers.parts import edges_of_shape

    path = written(edges_of_shape(rounded_box())[0], tmp_path / "edge.brep")
    assert list(place_lines(find_places(path))) == [
        "no surfaces: 1 edge; only surfaces, faces of Breps and extrusions can be used"
    ]
