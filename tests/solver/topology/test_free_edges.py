"""Free edges of faces as bases: resolved, cut into parts, paired, blended, and measured on the faces themselves."""

from dataclasses import replace

import numpy as np
import pytest
import rhino3dm
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepClass import BRepClass_FaceClassifier
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_State

from helpers.angular import angular_face
from helpers.drilled import beyond, drilled_part, hole
from helpers.free_curves import bent_face, cubic, free_form
from helpers.occ import to_geom
from helpers.parts import polygon, written
from semispline import (
    BandError,
    Base,
    BSplineCurve,
    BSplineSurface,
    ContactError,
    EdgeError,
    blend,
    blend_edges,
    edge_bases,
    list_edges,
    measure_face_contact,
    plane,
    resolve_edge,
    write_surface,
)
from semispline.solver.io.occ import _faces
from semispline.solver.judge import exact_face_limits
from semispline.solver.options import BlendOptions
from semispline.solver.topology.bands import band_along
from semispline.solver.topology.bases import EdgeBase, bases_along, free_curves, paired_bases
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.face_curves import edge_on_face
from semispline.solver.topology.face_edges import is_of_a_face, split_part
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.free_contact import measure_free_contact
from semispline.solver.topology.resolving import resolve_edges
from semispline.solver.topology.trim_curves import TrimCurve, read_trim_curves

pytestmark = pytest.mark.usefixtures("reads_here")

# Small, and of no interest here: shapes are looked at elsewhere.
QUICK = {"alpha": "natural"}


@pytest.fixture(scope="module")
def cylinder(tmp_path_factory):
    """A drilled cylinder, the word of its hole, and a tube beyond."""
    folder = tmp_path_factory.mktemp("cylinder")
    path = written(drilled_part("cylinder"), folder / "part.brep")
    face, entry = hole(path, "cylinder")
    return f"{path}#{face}", entry, str(beyond(folder / "tube.json", entry, "cylinder"))


@pytest.fixture(scope="module")
def angular(tmp_path_factory):
    """Two flat faces, one above the other, each with an edge that has a corner; the number of that edge."""
    folder = tmp_path_factory.mktemp("angular")
    specs = []
    for name, height, grown in (("low", 0.0, 0.0), ("high", 3.0, 1.0)):
        path = written(angular_face(height, grown), folder / f"{name}.brep")
        (entry,) = (e for e in list_edges(path, 0).edges if e.kind == "free")
        specs.append((f"{path}#0", entry.name))
    return specs


def test_words():
    assert is_of_a_face("e3[0]")
    assert is_of_a_face(" e3 ")
    assert not is_of_a_face("e3[0,1]")
    assert not is_of_a_face("u1[0]")
    assert split_part("near=1,2,3") == ("near=1,2,3", None)


def test_a_free_edge_resolves_to_itself(cylinder):
    spec, entry, _ = cylinder
    found = resolve_edge(spec, entry.name)
    assert (found.edge, found.is_free, found.part, found.asked) == (entry.name, True, None, entry.name)
    assert found.said == f"{entry.name} of {spec} is a free curve"
    near = resolve_edge(spec, "near=" + ",".join(map(str, entry.middle)))
    assert (near.edge, near.is_free) == (entry.name, True)
    assert resolve_edge(spec, f"{entry.name}[0]").part == 0
    whole = next(e for e in list_edges(*split(spec)).edges if e.edge is not None)
    assert not resolve_edge(spec, whole.name).is_free
    with pytest.raises(EdgeError, match="only free curves are cut into parts"):
        resolve_edge(spec, f"{whole.name}[0]")


def split(spec):
    path, _, number = spec.rpartition("#")
    return path, int(number)


@pytest.mark.long
def test_a_blend_is_measured_on_the_true_face_and_lies_beyond_the_edge(cylinder):
    spec, entry, tube = cylinder
    a, b = resolve_edges([(spec, entry.name), (tube, "v0")])
    (result,) = blend_edges(a, b, **QUICK)
    assert result.edges == (entry.name, "v0")
    assert result.band_b is None
    band = result.band_a
    assert (band.limits, band.source, result.options.limits) == ("cad", "foot", "cad")
    for name in ("gap", "off", "angle_degrees", "curvature"):
        assert 0 < getattr(band, name) <= band.allowed[name]
        assert np.isfinite(band.at[name].point).all()
    # The limits of the issue; the file has no unit, and an edge of the kernel is within 1e-7 to 1e-6.
    assert band.allowed["gap"] == pytest.approx(1e-5 * band.length)
    assert (band.allowed["angle_degrees"], band.allowed["curvature"]) == (0.01, 0.02)
    assert band.length == pytest.approx(entry.length, rel=1e-4)
    # What stands there is what the judge finds, and what the band itself is off by.
    (curve,) = free_curves([a])
    own = Base(result.surface, "u0")
    seen = measure_face_contact(own, curve.surface)
    assert (seen.gap, seen.angle_degrees) == (band.gap, pytest.approx(band.angle_degrees, abs=1e-12))
    (base,) = edge_bases([a])[0]
    assert band.gap == pytest.approx(measure_face_contact(base.base, curve.surface, same_side=True).gap, rel=0.1)
    # Into the face backwards from the blend, and out of it with the blend: by the kernel's classifier.
    _, number = split(spec)
    item = list(_faces(drilled_part("cylinder")))[number]
    v = np.linspace(*result.surface.domain[1], 13)[:-1]
    points, across = (result.surface.evaluate(np.zeros(12), v, order, 0) for order in (0, 1))
    step = 1e-3 * entry.length * across / np.linalg.norm(across, axis=1)[:, None]
    classifier = BRepClass_FaceClassifier()
    for moved, expected in ((points - step, TopAbs_State.TopAbs_IN), (points + step, TopAbs_State.TopAbs_OUT)):
        for point in moved:
            classifier.Perform(item, gp_Pnt(*map(float, point)), 1e-7)
            assert classifier.State() == expected


@pytest.mark.long
def test_a_reversed_direction_is_seen(cylinder):
    """The band of the other side of the edge, blended: contact figures are as good, and the blend folds back."""
    spec, entry, tube = cylinder
    a, b = resolve_edges([(spec, entry.name), (tube, "v0")])
    (curve,) = free_curves([a])
    wrong = replace(curve, keep="right" if curve.keep == "left" else "left")
    (base,) = bases_along(wrong)
    (other,) = edge_bases([b])[0]
    with pytest.raises(ContactError, match=r"contact a: on edge .*, angle_degrees is 1[78]\d"):
        blend_bases(replace(base, curve=curve), other, BlendOptions(**QUICK))


@pytest.mark.long
def test_limits_are_asked_for_and_kept(cylinder):
    spec, entry, tube = cylinder
    ends = resolve_edges([(spec, entry.name), (tube, "v0")])
    with pytest.raises(ContactError, match=r"on edge e\d+ of face \d+, gap is .*exact limits; .*leave out exact"):
        blend_edges(*ends, limits="exact", **QUICK)
    assert blend_edges(*ends, limits="cad", **QUICK)[0].band_a.limits == "cad"


@pytest.mark.long
def test_a_side_may_be_any_and_each_order(cylinder):
    """The free edge as b; G1 at it, G3 at the other."""
    spec, entry, tube = cylinder
    ends = resolve_edges([(tube, "v0"), (spec, entry.name)])
    (result,) = blend_edges(*ends, continuity=("G3", "G1"), **QUICK)
    assert (result.band_a, result.edges) == (None, ("v0", entry.name))
    assert result.band_b.rate is None
    (result,) = blend_edges(*ends[::-1], continuity=("C1", "G3"), **QUICK)
    assert result.band_a.angle_degrees <= 0.01
    (result,) = blend_edges(*ends[::-1], continuity="G3", **QUICK)
    assert 0 < result.band_a.rate <= 0.1


def test_a_corner_gives_two_blends(angular):
    ends = resolve_edges(angular)
    parts = edge_bases(ends)
    assert [[x.name for x in side] for side in parts] == [[f"{word}[0]", f"{word}[1]"] for _, word in angular]
    results = blend_edges(*ends)
    assert [r.edges for r in results] in (
        [(a.name, b.name) for a, b in zip(*parts, strict=True)],
        [(a.name, b.name) for a, b in zip(parts[0], parts[1][::-1], strict=True)],
    )
    for result in results:
        # Each lies between parts that run the same way, 3 apart and 1 away.
        ends_of = result.surface.evaluate([0.0, 0.0, 1.0, 1.0], [*result.surface.domain[1]] * 2)
        assert np.linalg.norm(ends_of[:2] - ends_of[2:], axis=1) == pytest.approx([np.sqrt(11)] * 2, abs=0.5)
        for band in (result.band_a, result.band_b):
            assert band.limits == "exact"
            assert band.angle_degrees <= band.allowed["angle_degrees"] <= 1e-7
    words = [(spec, f"{word}[1]") for spec, word in angular]
    (alone,) = blend_edges(*resolve_edges(words))
    assert alone.edges == tuple(word for _, word in words)
    assert alone.band_a.edge.startswith(f"{words[0][1]}, part of edge")


@pytest.mark.long
def test_parts_that_do_not_correspond_are_refused_with_the_words_to_ask_for(angular, tmp_path):
    sheet = tmp_path / "sheet.json"
    write_surface(sheet, plane([6, 0, 3], [2, 0, 0], [0, 4, 0]))
    (spec, word), _ = angular
    with pytest.raises(EdgeError) as error:
        blend_edges(*resolve_edges([(spec, word), (str(sheet), "u0")]))
    for text in (
        f"edge {word} of face 0 has 2 parts (a corner of 90 degrees)",
        "u0 is one piece",
        f"--edge-a {word}[0] to {word}[1] are its parts",
        "--edge-b u1[0,0.5]",
    ):
        assert text in str(error.value)
    with pytest.raises(EdgeError, match=rf"part: found 2, but edge {word} of face 0 has 2"):
        blend_edges(*resolve_edges([(spec, f"{word}[2]"), (str(sheet), "u0")]))
    assert len(blend_edges(*resolve_edges([(spec, f"{word}[1]"), (str(sheet), "u0")]))) == 1


def strips(corners, height=0.0):
    """A flat strip along each side of a closed polygon, inside of it."""
    made = []
    points = [np.array([*corner, height]) for corner in corners]
    for k, (a, b) in enumerate(zip(points, [*points[1:], points[0]], strict=True)):
        inwards = np.cross([0, 0, 1.0], b - a)
        made.append(EdgeBase(f"e0[{k}]", Base(plane(a, inwards, b - a), "u0")))
    return made


@given(st.integers(3, 6), st.integers(0, 5), st.booleans(), st.randoms(use_true_random=False))
def test_parts_of_closed_edges_meet_those_that_lie_nearest(count, shift, turned, random):
    angles = np.sort([random.uniform(k, k + 0.7) for k in range(count)]) * 2 * np.pi / count
    corners = [(float(np.cos(t)), float(np.sin(t))) for t in angles]
    a = strips(corners)
    moved = [corners[(shift + k) % count] for k in range(count)]
    b = strips(moved[::-1] if turned else moved, 0.3)
    for x, y in paired_bases(a, b):
        middles = [side.base.derivative(np.array([0.5]), 0, 0)[0] for side in (x, y)]
        assert middles[1] - middles[0] == pytest.approx([0, 0, 0.3])


def test_parts_of_open_edges_are_never_shifted():
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    a, b = strips(corners)[:3], strips(corners, 0.3)[:3]
    for order in (b, b[::-1]):
        assert [y.name for _, y in paired_bases(a, order)] == [x.name for x in a]
    # Of closed ones each could be the first.
    assert paired_bases(strips(corners), strips(corners[1:] + corners[:1], 0.3))[0][1].name == "e0[3]"


def test_parts_that_lie_equally_near_are_not_guessed():
    square = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    between = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    with pytest.raises(EdgeError, match="which of them meet cannot be told"):
        paired_bases(strips(square), strips(between, 1.0))


def test_one_part_of_a_curve_does_not_need_the_others():
    face = bent_face(0.07)
    curve = cubic((-0.8, 0.2), (-0.3, 0.8), (0.3, 0.3), (0.8, 0.7))
    both = band_along(face, curve)
    assert len(both) == 2
    for k in range(2):
        (band,) = band_along(face, curve, part=k)
        assert (band.surface.control_points == both[k].surface.control_points).all()
    with pytest.raises(EdgeError, match="part: found -1, but the curve has 2"):
        band_along(face, curve, part=-1)


def test_an_open_curve_whose_parameter_ends_at_zero_does_not_begin_again_there():
    """A parameter past the end by rounding is the end; a closed curve goes on."""
    floor = plane([0, 0, 0], [10, 0, 0], [0, 10, 0])
    arc = BSplineCurve(2, [-9.753, -9.753, -9.753, 0, 0, 0], [[1, 1, 0], [5, 4, 0], [9, 1, 0]])
    curve = edge_on_face(Face(floor), arc, None, 0.0)
    past = np.array([1e-300, 1e-13, -9.753 - 1e-14])
    assert curve.wrapped(past).tolist() == [0.0, 0.0, -9.753]
    assert curve.wrapped(np.array([1.0])) == pytest.approx([-8.753])
    (band,) = band_along(floor, None, edge=arc)
    assert band.gap <= 1e-12


def test_curves_come_in_the_unit_of_their_surfaces():
    curve = TrimCurve("edge e0 of face 0", plane([0, 0, 0], [1, 0, 0], [0, 1, 0]), None, None, "left", 1e-3, 25.4)
    moved = curve.in_unit("mm")
    assert moved.surface.evaluate([1], [1])[0].tolist() == pytest.approx([25.4, 25.4, 0])
    assert (moved.tolerance, moved.millimetres) == (pytest.approx(0.0254), 1.0)
    assert curve.in_unit(None) is curve
    unknown = replace(curve, millimetres=None).in_unit("in")
    assert (unknown.surface.domain, unknown.tolerance, unknown.millimetres) == (curve.surface.domain, 1e-3, 25.4)


@pytest.mark.long
def test_a_free_edge_of_a_3dm_file(tmp_path):
    """The discs of a cylinder are planes cut by circles; rhino3dm shows the edge in space alone."""
    file = rhino3dm.File3dm()
    circle = rhino3dm.Circle(rhino3dm.Point3d(1, 2, 3), 2.0)
    file.Objects.AddBrep(rhino3dm.Cylinder(circle, 5.0).ToBrep(True, True))
    path = tmp_path / "part.3dm"
    assert file.Write(str(path), 7)
    found = 0
    for face in range(3):
        for entry in list_edges(path, face).edges:
            if entry.kind != "free":
                continue
            found += 1
            end = resolve_edge(f"{path}#{face}", entry.name)
            (side,) = edge_bases([end])
            for base in side:
                assert base.band.source == "foot"
                v = np.linspace(*base.base.range_along, 9)[:-1]
                points, into = base.base.derivative(v, 0, 0), base.base.derivative(v, 1, 0)
                # Towards the middle.
                assert (np.sum(into * (np.array([1, 2, points[0, 2]]) - points), axis=1) > 0).all()
    assert found == 2
    with pytest.raises(EdgeError, match="e9: the face has"):
        read_trim_curves(path, [(0, 9)])


@pytest.mark.long
def test_contacts_along_a_free_edge_are_measured_without_a_band(cylinder, tmp_path):
    spec, entry, tube = cylinder
    a, b = resolve_edges([(spec, entry.name), (tube, "v0")])
    (result,) = blend_edges(a, b, **QUICK)
    path = tmp_path / "blend.json"
    write_surface(path, result.surface)
    own = resolve_edge(str(path), "u0")
    for ends, along in (((a, own), "b"), ((own, a), "a")):
        found = measure_free_contact(*ends, order=2)
        assert (found.along, found.limits, found.face) == (along, "cad", result.band_a.edge)
        assert found.contact.gap == result.band_a.gap
        assert found.contact.off == result.band_a.off
        assert found.length == pytest.approx(entry.length, rel=1e-5)
        assert found.allowed["off"] == pytest.approx(result.band_a.allowed["off"], rel=1e-4)
    assert measure_free_contact(a, own, limits="exact").allowed["angle_degrees"] < 1e-8
    with pytest.raises(EdgeError, match=f"found {entry.name}\\[0\\], a part; .* name {entry.name}"):
        measure_free_contact(resolve_edge(spec, f"{entry.name}[0]"), own)
    with pytest.raises(EdgeError, match="expected a free curve"):
        measure_free_contact(own, own)
    far = resolve_edge(tube, "v0")
    with pytest.raises(EdgeError, match=rf"^edge v0 against {result.band_a.edge}: face: the edge is .* away"):
        measure_free_contact(far, a)


@pytest.mark.long
def test_both_faces_of_a_hole_meet_at_their_edge(cylinder):
    spec, entry, _ = cylinder
    path, face = split(spec)
    beside = next(e for e in list_edges(path, face).edges if e.name == entry.name)
    ends = resolve_edges([(spec, entry.name), (f"{path}#{beside.neighbour}", beside.neighbour_edge)])
    found = measure_free_contact(*ends, order=2)
    # The kernel's own edge is within its tolerance of both.
    assert found.contact.gap <= 2e-6
    assert found.contact.off <= 2e-6
    # A cylinder of radius 5 about x, drilled along (0.3, 0.2, 1) by one of radius 1: normals by hand.
    points = found.profile.points
    outside = points * [0, 1, 1] / 5.0
    axis = np.array([0.3, 0.2, 1.0]) / np.linalg.norm([0.3, 0.2, 1.0])
    start = np.array([-15.0, -10.0, -50.0])
    radial = points - start - ((points - start) @ axis)[:, None] * axis
    # Into the material of the hole's wall; the outer normal there is -radial.
    turn = np.degrees(np.arccos(np.clip(-np.sum(outside * radial, axis=1), -1, 1)))
    assert found.profile.values["angle_degrees"] == pytest.approx(turn, abs=1e-3)


@pytest.mark.long
def test_what_cannot_be_met_says_why(tmp_path):
    """Between knot lines of a bicubic face a rate jumps, which a band for G3 cannot follow; one for G2 can."""
    face = polygon(to_geom(free_form(np.random.default_rng(5))), [(0.2, 0.2), (0.8, 0.3), (0.4, 0.8)])
    path = written(face, tmp_path / "free.brep")
    end = resolve_edge(f"{path}#0", "e0")
    assert end.is_free
    assert len(edge_bases([end])[0]) == 1
    with pytest.raises(BandError, match=r"edge e0 of face 0: a band of .* points reaches .* rate .*; ask for G2"):
        edge_bases([end], "G3")


def test_corners_of_a_pcurve_are_kept_where_it_is_taken_over_to_other_parameters(angular):
    """A smooth curve through the points of a corner would swing about it."""
    ((_, word), _), (spec, _) = angular, angular[0]
    (curve,) = read_trim_curves(split(spec)[0], [(0, int(word[1:]))])
    x = np.linspace(0, 2, 401)
    points = curve.surface.evaluate(*curve.pcurve.evaluate(x)[:, :2].T)
    # The feet of a plane are exact up to rounding; both run evenly.
    assert np.linalg.norm(points - curve.edge.evaluate(x), axis=1).max() <= 1e-12


def test_without_a_band_limits_are_those_of_both_contacts():
    a, b = Base(plane([0, 0, 0], [2, 0, 0], [0, 3, 0]), "u1"), Base(plane([4, 0, 1], [2, 0, 0], [0, 3, 0]), "u0")
    for limits, angle, chosen in (("auto", 1e-9, "exact"), ("exact", 1e-9, "exact"), ("cad", 0.01, "cad")):
        result = blend(a, b, limits=limits, **QUICK)
        assert result.options.limits == chosen
        for contact in (result.contact_a, result.contact_b):
            assert contact.allowed["angle_degrees"] == pytest.approx(angle, rel=0.5)
            assert contact.angle_degrees <= 1e-9


def test_rounding_along_a_short_first_span_does_not_bend_what_lies_in_a_plane():
    """Where a seam was moved the first span is short; rounding there is curvature along, which is no jump of a face."""
    knots = np.array([0.0] * 6 + [0.02, 4.0, 8.0] + [12.0] * 6)
    along = np.array([np.mean(knots[k + 1 : k + 6]) for k in range(9)])
    noise = 2e-14 * np.where(np.arange(9) % 2, 1.0, -1.0)
    net = np.stack([np.column_stack([np.full(9, x), along, noise]) for x in (0.0, 0.5, 1.0)])
    strip = Base(BSplineSurface(2, 5, [0, 0, 0, 1, 1, 1], knots, net), "u0")
    floor = plane([-20, -20, 0], [40, 0, 0], [0, 40, 0])
    found = measure_face_contact(strip, floor)
    limit = exact_face_limits(strip, floor)["curvature_jump_relative"]
    assert 1e-7 < found.curvature_jump_relative <= limit < 1e-2


def test_cad_limits_of_edges_that_are_their_surfaces_know_the_unit(tmp_path):
    """0.001 mm of a unit of 25.4 mm, along an edge whose length would allow 10 times as much."""
    for name, height in (("low", 0.0), ("high", 20.0)):
        write_surface(
            tmp_path / f"{name}.step", plane([0, height, height], [100, 0, 0], [0, 10, height / 2]), unit="in"
        )
    ends = [resolve_edge(tmp_path / "low.step", "v1"), resolve_edge(tmp_path / "high.step", "v0")]
    (result,) = blend_edges(*ends, limits="cad", **QUICK)
    assert result.contact_a.allowed["gap"] == pytest.approx(0.001 / 25.4)
    assert result.contact_a.allowed["angle_degrees"] == 0.01
