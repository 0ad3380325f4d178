"""The interactive view's data: judged by the de Boor referee and by differences, after a round trip through base64."""

import json
from base64 import b64decode

import numpy as np
import pytest

from semispline import Base, BSplineSurface, blend
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.pictures.viewer import curvature_limit, model, packed, piece, viewer_html, viewer_script


def gutter(bend, width=1.0, turned=False):
    """z = bend x^2 / 2 for |x| <= width, exactly; 3 long."""
    x, z = np.array([-width, 0, width]), bend * width**2 / 2 * np.array([1, -1, 1])
    net = np.stack(np.broadcast_arrays(x, np.array([[0.0], [3.0]]), z), axis=2)
    return BSplineSurface(1, 2, [0, 0, 1, 1], [0, 0, 0, 1, 1, 1], net[::-1] if turned else net)


@pytest.fixture(scope="module")
def bases():
    knots_a, knots_b = [0, 0, 0, 0, 0.3, 1, 1, 1, 1], [0, 0, 0, 0, 0.5, 0.8, 1, 1, 1, 1]
    v_a, v_b = np.linspace(0, 1, 5), np.linspace(0, 1, 6)
    u = np.linspace(0, 1, 4)
    floor = np.stack(np.broadcast_arrays(-u[:, None], 2 * v_a, 0.2 * np.sin(3 * v_a) * u[:, None]), axis=2)
    wall = np.stack(np.broadcast_arrays(1 + 0.2 * u[:, None], 2 * v_b, 1 + u[:, None]), axis=2)
    flat = [0, 0, 0, 0, 1, 1, 1, 1]
    return BSplineSurface(3, 3, flat, knots_a, floor), BSplineSurface(3, 3, flat, knots_b, wall)


@pytest.fixture(scope="module")
def blended(bases):
    return blend(*(Base(base, "u0") for base in bases), continuity="G2").surface


def unpacked(record, whole):
    raw = np.frombuffer(b64decode(record["vertices"]), "<i2").reshape(record["rows"], record["columns"], 8)
    points = raw[..., :3].copy().view("<u2") / 65535 * np.array(whole["box"])
    return points, raw[..., 3] / 32767, raw[..., 4:7] / 32767


def test_vertices_lie_on_the_surface_and_normals_stand_on_it(bases, blended):
    made = model("x", "x", bases, [("ours", "", blended)])
    whole = packed(made)
    surfaces = (*bases, blended)
    scale = None
    for surface, record in zip(surfaces, [*whole["bases"], *whole["blends"]], strict=True):
        points, _, normals = unpacked(record, whole)
        # Corners are at the corners of the domain; the referee says where these are.
        (u0, u1), (v0, v1) = surface.domain
        corners = surface_points(surface, np.array([u0, u0, u1, u1]), np.array([v0, v1, v0, v1]))
        got = np.array([points[0, 0], points[0, -1], points[-1, 0], points[-1, -1]])
        size = np.linalg.norm(corners[1:] - corners[0], axis=1) / np.linalg.norm(got[1:] - got[0], axis=1)
        scale = size[0] if scale is None else scale
        # 16 bits of the box.
        np.testing.assert_allclose(size, scale, rtol=1e-3)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=2), 1, atol=1e-4)
        along = points[1:] - points[:-1], points[:, 1:] - points[:, :-1]
        middle = normals[1:] + normals[:-1], normals[:, 1:] + normals[:, :-1]
        for steps, n in zip(along, middle, strict=True):
            cosine = np.sum(steps * n, axis=2) / np.linalg.norm(steps, axis=2) / 2
            # A chord deviates from the mean tangent plane by far less than its length; 16 bits add some.
            assert np.abs(cosine).max() < 0.02


def test_the_contact_has_no_crack(bases, blended):
    whole = packed(model("x", "x", bases, [("ours", "", blended)]))
    edge, _, _ = unpacked(whole["blends"][0], whole)
    base, _, _ = unpacked(whole["bases"][0], whole)
    ends = edge[0, [0, -1]], base[0, [0, -1]]
    np.testing.assert_allclose(ends[0], ends[1], atol=2 / 65535 * max(whole["box"]))


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("bend", [0.3, -5.0])
def test_curvature_of_a_parabola(bend, turned):
    found = piece("", "", "#000000", gutter(bend, turned=turned))
    x = found.points[..., 0]
    # Half the curvature of the parabola; positive where it bends towards the normal, which is upwards or downwards.
    wanted = bend / (1 + (bend * x) ** 2) ** 1.5 / 2 * np.sign(found.normals[..., 2])
    np.testing.assert_allclose(found.mean, wanted, rtol=1e-12)


def test_the_scale_holds_nearly_all_of_the_area_and_is_never_zero(bases):
    # Nearly flat, so that the curvature is 0.1 / 2 nearly everywhere.
    assert curvature_limit([piece("", "", "#000000", gutter(0.1, width=0.1))]) == pytest.approx(0.05, rel=1e-3)
    plane = piece("", "", "#000000", bases[1])
    assert curvature_limit([plane]) > 0


def test_a_degenerate_surface_gives_finite_numbers():
    net = np.zeros((2, 2, 3))
    net[1] = [[1, 0, 0], [1, 1, 0]]
    cone = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], net)
    text = viewer_html(model("pole", "a pole", (cone, cone), [("same", "", cone)]))
    assert "NaN" not in text
    assert "Infinity" not in text


def test_markup_is_escaped_and_data_cannot_end_the_script(bases, blended):
    text = viewer_html(model("x", "a <b> title", bases, [("<i>", "</script><b>", blended)]))
    assert "<i>" not in text
    assert "<b>" not in text
    assert text.count("</script>") == 1
    data = text.split('<script type="application/json">')[1].split("</script>")[0]
    assert json.loads(data)["blends"][0]["caption"] == "</script><b>"


def test_control_points_are_those_of_each_curve(bases, blended):
    whole = packed(model("x", "x", bases, [("ours", "", blended)]))
    polygons = whole["blends"][0]["polygons"]
    assert polygons["counts"] == [len(curve.control_points) for curve in blended.control_curves]
    points = np.frombuffer(b64decode(polygons["points"]), "<f4").reshape(-1, 3)
    vertices, _, _ = unpacked(whole["blends"][0], whole)
    # First and last control points of the first curve are corners of the surface.
    np.testing.assert_allclose(points[[0, polygons["counts"][0] - 1]], vertices[0, [0, -1]], atol=1e-4)


def test_the_script_asks_for_nothing():
    script = viewer_script()
    for word in ("http", "fetch(", "import ", "XMLHttpRequest", "src="):
        assert word not in script
